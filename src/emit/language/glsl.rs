//! GLSL. One text serves 450, 330 core and ES 300: it uses unsigned integers
//! and `switch`, which all of them have, and no `fma`, which ES 300 lacks.

use super::{Dialect, Prefix, Type, call};
use crate::emit::inputs::Fetch;
use crate::program::Scalar;
use crate::program::operators::{Spelling, Spellings};

/// A version of GLSL.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum GlslVersion {
    /// OpenGL 4.5 and Vulkan.
    V450,
    /// OpenGL 3.3 core.
    V330,
    /// OpenGL ES 3.0 and WebGL 2.
    Es300,
}

impl GlslVersion {
    /// The first line of a shader that includes the library.
    pub fn version_line(self) -> &'static str {
        match self {
            GlslVersion::V450 => "#version 450",
            GlslVersion::V330 => "#version 330 core",
            GlslVersion::Es300 => "#version 300 es",
        }
    }
}

/// GLSL of some version.
pub(in crate::emit) struct Glsl {
    pub(in crate::emit) version: GlslVersion,
}

impl Dialect for Glsl {
    fn scalar(&self, scalar: Scalar) -> &'static str {
        match scalar {
            Scalar::Float => "float",
            Scalar::Uint | Scalar::Word => "uint",
            Scalar::Int => "int",
            Scalar::Bool => "bool",
        }
    }

    fn vector(&self, size: usize) -> String {
        format!("vec{size}")
    }

    fn array(&self, of: &str, length: usize) -> String {
        format!("{of}[{length}]")
    }

    fn prologue(&self, prefix: &Prefix, fetches: &[Fetch]) -> String {
        let mut out = format!("// Include it after `{}`", self.version.version_line());
        if fetches.is_empty() {
            out += ".\n";
        } else {
            out += " and after what the host supplies:\n";
            out += &format!(
                "//   struct {} {{ ... }};  what a fetch needs to know, a texel for instance\n",
                prefix.site()
            );
            for fetch in fetches {
                let (ident, ty) = (&fetch.ident, self.scalar(fetch.scalar));
                let arguments = fetch.parameters(|name| format!("float {name}"));
                out += &format!("//   {ty} {}_fetch_{ident}({} site{arguments})\n", prefix.lower, prefix.site());
            }
        }
        if self.version == GlslVersion::Es300 {
            out += "precision highp float;\nprecision highp int;\n";
        }
        out
    }

    fn remainder(&self, prefix: &Prefix) -> String {
        // A function, because written in place it would double its operands, and nested ones exponentially.
        format!(
            "// WGSL's `%`: `mod` rounds down, this towards zero.\nfloat {}_remainder(float a, float b) {{\n    return a - b * trunc(a / b);\n}}",
            prefix.lower
        )
    }

    fn signed_remainder(&self, prefix: &Prefix, [a, b]: [&str; 2]) -> String {
        call(&self.global(prefix, "whole_remainder"), &[a, b])
    }

    fn signed_remainder_function(&self, prefix: &Prefix) -> String {
        format!(
            "// The language leaves its own `%` undefined for negative numbers.\nint {}_whole_remainder(int a, int b) {{\n    return a - a / b * b;\n}}",
            prefix.lower
        )
    }

    fn constant(&self, name: &str, value: u32) -> String {
        format!("const uint {name} = {value}u;")
    }

    fn structure(&self, name: &str, fields: &[(&str, String)]) -> String {
        let fields: String = fields.iter().map(|(name, ty)| format!("    {ty} {name};\n")).collect();
        format!("struct {name} {{\n{fields}}};")
    }

    fn function(&self, name: &str, parameters: &[(String, Type)], result: &Type, prefix: &Prefix) -> String {
        let list: Vec<String> = parameters.iter().map(|(n, t)| format!("{} {n}", self.ty(t, prefix))).collect();
        format!("{} {name}({}) {{", self.ty(result, prefix), list.join(", "))
    }

    fn local(&self, ty: &Type, name: &str, value: &str, prefix: &Prefix) -> String {
        format!("{} {name} = {value};", self.ty(ty, prefix))
    }

    fn case_open(&self, values: &[u32]) -> String {
        let values: Vec<String> = values.iter().map(|v| format!("case {v}u:")).collect();
        format!("{} {{", values.join(" "))
    }

    fn case_default(&self) -> &'static str {
        "default: { break; }"
    }

    fn select(&self, condition: &str, then: &str, other: &str) -> String {
        // A condition that is itself a choice would take what follows for its own.
        match condition.contains('?') {
            true => format!("(({condition}) ? {then} : {other})"),
            false => format!("({condition} ? {then} : {other})"),
        }
    }

    fn bool_to_uint(&self, condition: &str) -> String {
        format!("uint({condition})")
    }

    fn float_from_bits(&self, word: &str) -> String {
        format!("uintBitsToFloat({word})")
    }

    fn bits_of_float(&self, number: &str) -> String {
        format!("floatBitsToUint({number})")
    }

    fn spelling(&self, of: Spellings) -> Spelling {
        of.glsl
    }
}
