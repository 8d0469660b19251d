//! Rust: plain functions that need nothing but `core` arithmetic and the
//! floating-point functions of `std`. What else is in the module, and its end,
//! is added by [`host`](crate::emit::host).

use super::{Dialect, Prefix, Type, bare, call};
use crate::emit::inputs::{Fetch, fetch_ident};
use crate::program::operators::{Spelling, Spellings};
use crate::program::{Input, Scalar};

/// Rust.
pub(in crate::emit) struct Rust;

impl Dialect for Rust {
    fn scalar(&self, scalar: Scalar) -> &'static str {
        match scalar {
            Scalar::Float => "f32",
            Scalar::Uint | Scalar::Word => "u32",
            Scalar::Int => "i32",
            Scalar::Bool => "bool",
        }
    }

    fn vector(&self, size: usize) -> String {
        self.array(self.scalar(Scalar::Float), size)
    }

    fn array(&self, of: &str, length: usize) -> String {
        format!("[{of}; {length}]")
    }

    /// Written in place, in `f64`.
    fn smoothstep(&self, _: &Prefix) -> String {
        String::new()
    }

    fn site(&self, prefix: &Prefix) -> String {
        format!("&mut impl {}", prefix.site())
    }

    fn prologue(&self, prefix: &Prefix, fetches: &[Fetch]) -> String {
        let mut out = format!(
            "#[allow(non_camel_case_types, non_snake_case, clippy::all, dead_code, missing_docs, unreachable_pub)]\n#[allow(unused_parens, unused_variables)]\n#[rustfmt::skip]\npub mod {} {{\n",
            prefix.lower
        );
        if !fetches.is_empty() {
            out += "/// Produces fetched inputs on demand; levels as their index.\n";
            out += &format!("pub trait {} {{\n", prefix.site());
            for fetch in fetches {
                let arguments = fetch.parameters(|name| format!("{name}: f32"));
                out += &format!("    fn {}(&mut self{arguments}) -> {};\n", fetch.ident, self.scalar(fetch.scalar));
            }
            out += "}\n";
        }
        out
    }

    fn constant(&self, name: &str, value: u32) -> String {
        format!("pub const {name}: u32 = {value};")
    }

    fn structure(&self, name: &str, fields: &[(&str, String)]) -> String {
        let fields: String = fields.iter().map(|(name, ty)| format!("    pub {name}: {ty},\n")).collect();
        format!("#[derive(Debug, Clone, Copy, PartialEq)]\npub struct {name} {{\n{fields}}}")
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

    fn later(&self, scalar: Scalar, name: &str) -> String {
        format!("let {name}: {};", self.scalar(scalar))
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

    fn word(&self, value: u32) -> String {
        format!("{value}u32")
    }

    fn select(&self, condition: &str, then: &str, other: &str) -> String {
        format!("(if {condition} {{ {then} }} else {{ {other} }})")
    }

    fn bool_to_uint(&self, condition: &str) -> String {
        format!("u32::from({condition})")
    }

    fn fetch(&self, _: &Prefix, input: &Input) -> String {
        format!("site.{}({})", fetch_ident(input), self.arguments(input).join(", "))
    }

    fn converted(&self, from: Scalar, to: Scalar, value: &str) -> String {
        if from == to { value.to_owned() } else { format!("({value} as {})", self.scalar(to)) }
    }

    fn int_function(&self, name: &str, operands: &[&str]) -> String {
        call(&format!("i32::{name}"), operands)
    }

    fn has_bit(&self, word: &str, at: &str) -> String {
        format!("((u32::wrapping_shr({}, {}) & 1) != 0)", bare(word), bare(at))
    }

    fn float_from_bits(&self, word: &str) -> String {
        format!("f32::from_bits({word})")
    }

    fn bits_of_float(&self, number: &str) -> String {
        format!("f32::to_bits({number})")
    }

    fn spelling(&self, of: Spellings) -> Spelling {
        of.rust
    }

    fn int_from_bits(&self, word: &str) -> String {
        format!("({word} as i32)")
    }

    fn bits_of_int(&self, number: &str) -> String {
        format!("({number} as u32)")
    }

    fn collection(&self, _: &str, parts: &[String]) -> String {
        format!("[{}]", parts.join(", "))
    }

    fn structure_of(&self, name: &str, fields: &[(&str, String)]) -> String {
        let fields: Vec<String> = fields.iter().map(|(name, value)| format!("{name}: {value}")).collect();
        format!("{name} {{ {} }}", fields.join(", "))
    }

    fn lookup_import(&self, prefix: &Prefix) -> String {
        format!("use super::{}_lookup;", prefix.lower)
    }
}
