//! GLSL. One text serves 450, 330 core and ES 300: it uses unsigned integers
//! and `switch`, which all of them have, and no `fma`, which ES 300 lacks.

use super::{Dialect, Prefix, Type};
use crate::program::Output;
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
    fn ty(&self, ty: &Type, prefix: &Prefix) -> String {
        match ty {
            Type::Float => "float".to_owned(),
            Type::Uint => "uint".to_owned(),
            Type::Bool => "bool".to_owned(),
            Type::Value(Output::Number) => "float".to_owned(),
            Type::Pair => "vec2".to_owned(),
            Type::Value(Output::Record(_)) => prefix.value(),
            Type::Value(Output::Vector(size)) => format!("vec{size}"),
            Type::Value(Output::Enumeration(_)) => "uint".to_owned(),
            Type::Value(Output::List { max, .. }) => format!("uint[{}]", max + 1),
            Type::Result => prefix.result(),
            Type::Site => prefix.site(),
        }
    }

    fn prologue(&self, prefix: &Prefix, fetches: &[(String, Type)]) -> String {
        let mut out = format!("// Include it after `{}`", self.version.version_line());
        if fetches.is_empty() {
            out += ".\n";
        } else {
            out += " and after what the host supplies:\n";
            out += &format!(
                "//   struct {} {{ ... }};  what a fetch needs to know, a texel for instance\n",
                prefix.site()
            );
            for (ident, ty) in fetches {
                let ty = self.ty(ty, prefix);
                out += &format!("//   {ty} {}_fetch_{ident}({} site)\n", prefix.lower, prefix.site());
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

    fn constant(&self, name: &str, value: u32) -> String {
        format!("const uint {name} = {value}u;")
    }

    fn result_struct(&self, prefix: &Prefix, output: &Output) -> String {
        let ty = self.ty(&Type::Value(output.clone()), prefix);
        format!("struct {} {{\n    {ty} value;\n    uint case_id;\n}};", prefix.result())
    }

    fn value_struct(&self, prefix: &Prefix, names: &[String]) -> String {
        let fields: String = names.iter().map(|name| format!("    float {name};\n")).collect();
        format!("struct {} {{\n{fields}}};", prefix.value())
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

    fn spelling(&self, of: Spellings) -> Spelling {
        of.glsl
    }

    fn value(&self, prefix: &Prefix, output: &Output, components: &[String]) -> String {
        match output {
            Output::Number | Output::Enumeration(_) => components.concat(),
            Output::Record(_) => format!("{}({})", prefix.value(), components.join(", ")),
            Output::Vector(size) => format!("vec{size}({})", components.join(", ")),
            Output::List { max, .. } => format!("uint[{}]({})", max + 1, components.join(", ")),
        }
    }
}
