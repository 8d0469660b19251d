//! WGSL.

use super::{Dialect, Prefix, Type};
use crate::program::Output;
use crate::program::operators::{Spelling, Spellings};

/// WGSL, with nothing but functions, constants and one structure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::emit) enum Wgsl {
    /// Text that becomes part of a module.
    Plain,
    /// A module, which imports what the host supplies.
    Module,
}

impl Dialect for Wgsl {
    fn ty(&self, ty: &Type, prefix: &Prefix) -> String {
        match ty {
            Type::Float => "f32".to_owned(),
            Type::Uint => "u32".to_owned(),
            Type::Bool => "bool".to_owned(),
            Type::Value(Output::Number) => "f32".to_owned(),
            Type::Pair => "vec2<f32>".to_owned(),
            Type::Value(Output::Record(_)) => prefix.value(),
            Type::Value(Output::Vector(size)) => format!("vec{size}<f32>"),
            Type::Value(Output::Enumeration(_)) => "u32".to_owned(),
            Type::Value(Output::List { max, .. }) => format!("array<u32, {}>", max + 1),
            Type::Result => prefix.result(),
            Type::Site => prefix.site(),
        }
    }

    fn prologue(&self, prefix: &Prefix, fetches: &[(String, Type)]) -> String {
        if fetches.is_empty() {
            return String::new();
        }
        let mut out = String::from(match self {
            Wgsl::Plain => "// To be supplied by the host, anywhere in the same module:\n",
            Wgsl::Module => "// To be supplied by the host, in the module that is imported above:\n",
        });
        out += &format!("//   struct {} {{ ... }}  what a fetch needs to know, a texel for instance\n", prefix.site());
        for (ident, ty) in fetches {
            let ty = self.ty(ty, prefix);
            out += &format!("//   fn {}_fetch_{ident}(site: {}) -> {ty}\n", prefix.lower, prefix.site());
        }
        out
    }

    fn constant(&self, name: &str, value: u32) -> String {
        format!("const {name}: u32 = {value}u;")
    }

    fn result_struct(&self, prefix: &Prefix, output: &Output) -> String {
        let ty = self.ty(&Type::Value(output.clone()), prefix);
        format!("struct {} {{\n    value: {ty},\n    case_id: u32,\n}}", prefix.result())
    }

    fn value_struct(&self, prefix: &Prefix, names: &[String]) -> String {
        let fields: String = names.iter().map(|name| format!("    {name}: f32,\n")).collect();
        format!("struct {} {{\n{fields}}}", prefix.value())
    }

    fn make_pair(&self, first: &str, second: &str) -> String {
        format!("vec2<f32>({first}, {second})")
    }

    fn function(&self, name: &str, parameters: &[(String, Type)], result: &Type, prefix: &Prefix) -> String {
        let list: Vec<String> = parameters.iter().map(|(n, t)| format!("{n}: {}", self.ty(t, prefix))).collect();
        format!("fn {name}({}) -> {} {{", list.join(", "), self.ty(result, prefix))
    }

    fn local(&self, _: &Type, name: &str, value: &str, _: &Prefix) -> String {
        format!("let {name} = {value};")
    }

    fn variable(&self, _: &Type, name: &str, value: &str, _: &Prefix) -> String {
        format!("var {name} = {value};")
    }

    fn number_later(&self, name: &str) -> String {
        format!("var {name}: f32;")
    }

    fn case_open(&self, values: &[u32]) -> String {
        let values: Vec<String> = values.iter().map(|v| self.uint(*v)).collect();
        format!("case {}: {{", values.join(", "))
    }

    fn case_default(&self) -> &'static str {
        "default: {}"
    }

    fn select(&self, condition: &str, then: &str, other: &str) -> String {
        format!("select({other}, {then}, {condition})")
    }

    fn bool_to_uint(&self, condition: &str) -> String {
        format!("u32({condition})")
    }

    fn float_from_bits(&self, word: &str) -> String {
        format!("bitcast<f32>({word})")
    }

    fn spelling(&self, of: Spellings) -> Spelling {
        of.wgsl
    }

    fn value(&self, prefix: &Prefix, output: &Output, components: &[String]) -> String {
        match output {
            Output::Number | Output::Enumeration(_) => components.concat(),
            Output::Record(_) => format!("{}({})", prefix.value(), components.join(", ")),
            Output::Vector(size) => format!("vec{size}<f32>({})", components.join(", ")),
            Output::List { max, .. } => format!("array<u32, {}>({})", max + 1, components.join(", ")),
        }
    }
}
