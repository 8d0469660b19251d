//! WGSL.

use super::{Dialect, Prefix, Type};
use crate::emit::inputs::Fetch;
use crate::program::Scalar;
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
    fn scalar(&self, scalar: Scalar) -> &'static str {
        match scalar {
            Scalar::Float => "f32",
            Scalar::Uint | Scalar::Word => "u32",
            Scalar::Int => "i32",
            Scalar::Bool => "bool",
        }
    }

    fn vector(&self, size: usize) -> String {
        format!("vec{size}<f32>")
    }

    fn array(&self, of: &str, length: usize) -> String {
        format!("array<{of}, {length}>")
    }

    fn prologue(&self, prefix: &Prefix, fetches: &[Fetch]) -> String {
        if fetches.is_empty() {
            return String::new();
        }
        let mut out = String::from(match self {
            Wgsl::Plain => "// To be supplied by the host, anywhere in the same module:\n",
            Wgsl::Module => "// To be supplied by the host, in the module that is imported above:\n",
        });
        out += &format!("//   struct {} {{ ... }}  what a fetch needs to know, a texel for instance\n", prefix.site());
        for fetch in fetches {
            let (ident, ty) = (&fetch.ident, self.scalar(fetch.scalar));
            let arguments = fetch.parameters(|name| format!("{name}: f32"));
            out += &format!("//   fn {}_fetch_{ident}(site: {}{arguments}) -> {ty}\n", prefix.lower, prefix.site());
        }
        out
    }

    fn hit(&self, prefix: &Prefix) -> String {
        format!("fn {}(number: u32)", self.global(prefix, "hit"))
    }

    fn constant(&self, name: &str, value: u32) -> String {
        format!("const {name}: u32 = {value}u;")
    }

    fn structure(&self, name: &str, fields: &[(&str, String)]) -> String {
        let fields: String = fields.iter().map(|(name, ty)| format!("    {name}: {ty},\n")).collect();
        format!("struct {name} {{\n{fields}}}")
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

    fn later(&self, scalar: Scalar, name: &str) -> String {
        format!("var {name}: {};", self.scalar(scalar))
    }

    fn case_open(&self, values: &[u32]) -> String {
        let values: Vec<String> = values.iter().map(|v| self.uint(*v)).collect();
        format!("case {}: {{", values.join(", "))
    }

    fn case_default(&self) -> &'static str {
        "default: {}"
    }

    fn plain_int(&self, value: i32) -> String {
        format!("{value}i")
    }

    fn int_from_bits(&self, word: &str) -> String {
        format!("bitcast<i32>({word})")
    }

    fn bits_of_int(&self, number: &str) -> String {
        format!("bitcast<u32>({number})")
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

    fn bits_of_float(&self, number: &str) -> String {
        format!("bitcast<u32>({number})")
    }

    fn spelling(&self, of: Spellings) -> Spelling {
        of.wgsl
    }
}
