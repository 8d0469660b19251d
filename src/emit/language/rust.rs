//! Rust: plain functions that need nothing but `core` arithmetic and the
//! floating-point functions of `std`. What else is in the module, and its end,
//! is added by [`host`](crate::emit::host).

use super::{Dialect, Prefix, Type};
use crate::program::Output;
use crate::program::operators::{Spelling, Spellings};

/// Rust.
pub(in crate::emit) struct Rust;

impl Dialect for Rust {
    fn ty(&self, ty: &Type, prefix: &Prefix) -> String {
        match ty {
            Type::Float => "f32".to_owned(),
            Type::Uint => "u32".to_owned(),
            Type::Bool => "bool".to_owned(),
            Type::Value(Output::Number) => "f32".to_owned(),
            Type::Pair => "[f32; 2]".to_owned(),
            Type::Value(Output::Record(_)) => prefix.value(),
            Type::Value(Output::Vector(size)) => format!("[f32; {size}]"),
            Type::Value(Output::Enumeration(_)) => "u32".to_owned(),
            Type::Value(Output::List { max, .. }) => format!("[u32; {}]", max + 1),
            Type::Result => prefix.result(),
            Type::Site => format!("&mut impl {}", prefix.site()),
        }
    }

    fn prologue(&self, prefix: &Prefix, fetches: &[(String, Type)]) -> String {
        let mut out = format!(
            "#[allow(non_camel_case_types, non_snake_case, clippy::all, dead_code, missing_docs, unreachable_pub)]\n#[allow(unused_parens, unused_variables)]\n#[rustfmt::skip]\npub mod {} {{\n",
            prefix.lower
        );
        if !fetches.is_empty() {
            out += "/// Produces fetched inputs on demand; levels as their index.\n";
            out += &format!("pub trait {} {{\n", prefix.site());
            for (ident, ty) in fetches {
                out += &format!("    fn {ident}(&mut self) -> {};\n", self.ty(ty, prefix));
            }
            out += "}\n";
        }
        out
    }

    fn constant(&self, name: &str, value: u32) -> String {
        format!("pub const {name}: u32 = {value};")
    }

    fn result_struct(&self, prefix: &Prefix, output: &Output) -> String {
        let ty = self.ty(&Type::Value(output.clone()), prefix);
        format!(
            "#[derive(Debug, Clone, Copy, PartialEq)]\npub struct {} {{\n    pub value: {ty},\n    pub case_id: u32,\n}}",
            prefix.result()
        )
    }

    fn value_struct(&self, prefix: &Prefix, names: &[String]) -> String {
        let fields: String = names.iter().map(|name| format!("    pub {name}: f32,\n")).collect();
        format!("#[derive(Debug, Clone, Copy, PartialEq)]\npub struct {} {{\n{fields}}}", prefix.value())
    }

    fn make_pair(&self, first: &str, second: &str) -> String {
        format!("[{first}, {second}]")
    }

    fn of_pair(&self, pair: &str, second: bool) -> String {
        format!("{pair}[{}]", u8::from(second))
    }

    fn function(&self, name: &str, parameters: &[(String, Type)], result: &Type, prefix: &Prefix) -> String {
        let list: Vec<String> = parameters.iter().map(|(n, t)| format!("{n}: {}", self.ty(t, prefix))).collect();
        format!("pub fn {name}({}) -> {} {{", list.join(", "), self.ty(result, prefix))
    }

    fn local(&self, ty: &Type, name: &str, value: &str, prefix: &Prefix) -> String {
        format!("let {name}: {} = {value};", self.ty(ty, prefix))
    }

    fn variable(&self, ty: &Type, name: &str, value: &str, prefix: &Prefix) -> String {
        format!("let mut {name}: {} = {value};", self.ty(ty, prefix))
    }

    fn number_later(&self, name: &str) -> String {
        format!("let {name}: f32;")
    }

    fn if_open(&self, condition: &str) -> String {
        format!("if {condition} {{")
    }

    fn switch_open(&self, selector: &str) -> String {
        format!("match {selector} {{")
    }

    fn case_open(&self, values: &[u32]) -> String {
        let values: Vec<String> = values.iter().map(u32::to_string).collect();
        format!("{} => {{", values.join(" | "))
    }

    fn case_default(&self) -> &'static str {
        "_ => {}"
    }

    fn uint(&self, value: u32) -> String {
        value.to_string()
    }

    fn select(&self, condition: &str, then: &str, other: &str) -> String {
        format!("(if {condition} {{ {then} }} else {{ {other} }})")
    }

    fn bool_to_uint(&self, condition: &str) -> String {
        format!("u32::from({condition})")
    }

    fn fetch(&self, _: &Prefix, ident: &str) -> String {
        format!("site.{ident}()")
    }

    fn float_from_bits(&self, word: &str) -> String {
        format!("f32::from_bits({word})")
    }

    fn spelling(&self, of: Spellings) -> Spelling {
        of.rust
    }

    fn value(&self, prefix: &Prefix, output: &Output, components: &[String]) -> String {
        match output {
            Output::Number | Output::Enumeration(_) => components.concat(),
            Output::Record(names) => {
                let fields: Vec<String> = names.iter().zip(components).map(|(n, c)| format!("{n}: {c}")).collect();
                format!("{} {{ {} }}", prefix.value(), fields.join(", "))
            }
            Output::Vector(_) | Output::List { .. } => format!("[{}]", components.join(", ")),
        }
    }

    fn result(&self, prefix: &Prefix, value: &str, case: &str) -> String {
        format!("{} {{ value: {value}, case_id: {case} }}", prefix.result())
    }

    fn lookup_import(&self, prefix: &Prefix) -> String {
        format!("use super::{}_lookup;", prefix.lower)
    }
}
