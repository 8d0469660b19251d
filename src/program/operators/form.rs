//! The forms of operators: as tables write them, and as generated code spells them.

use crate::table::expr as ast;

/// An operator's form in a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Notation {
    /// A call of a function: its name and the names of its arguments.
    Function(&'static str, &'static str),
    /// A function whose name another operator has, or a function of the language that stands for several.
    Shared(&'static str),
    /// A symbol before the operand.
    Prefix(ast::UnaryOp),
    /// A symbol between the operands.
    Infix(ast::BinaryOp),
}

impl Notation {
    /// The name of the function, or the symbol.
    pub fn name(self) -> &'static str {
        match self {
            Notation::Function(name, _) | Notation::Shared(name) => name,
            Notation::Prefix(op) => op.symbol(),
            Notation::Infix(op) => op.symbol(),
        }
    }
}

/// An operator's form in generated code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spelling {
    /// A call of a function with the name that it has in tables.
    Same,
    /// A call of a function with another name.
    Call(&'static str),
    /// The symbol that it has in tables; in parentheses, as some front ends refuse what others accept without.
    Symbol,
    /// A template: `{a}`, `{b}` and `{c}` are operands, `{a:bare}` one without its outer parentheses.
    Text(&'static str),
    /// Rust only: a method of `f64`, rounded once; for functions that are not correctly rounded in `f32`.
    Wide(&'static str),
    /// A call of a function that the generated module defines.
    Own(&'static str),
    /// The first or the second of the two numbers that the module's function for sine and cosine returns.
    OfSincos {
        /// The cosine rather than the sine.
        second: bool,
    },
}

/// An operator's form in each language that is printed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Spellings {
    /// WGSL.
    pub wgsl: Spelling,
    /// GLSL, every version.
    pub glsl: Spelling,
    /// Rust.
    pub rust: Spelling,
}

impl Spellings {
    /// The symbols of the table's language in every language.
    pub(super) const SYMBOL: Self = Self { wgsl: Spelling::Symbol, glsl: Spelling::Symbol, rust: Spelling::Symbol };

    /// A function of the generated module in shading languages.
    pub(super) const fn own(name: &'static str, rust: Spelling) -> Self {
        Self { wgsl: Spelling::Own(name), glsl: Spelling::Own(name), rust }
    }

    /// The name of the table's language in shading languages.
    pub(super) const fn shared(rust: Spelling) -> Self {
        Self { wgsl: Spelling::Same, glsl: Spelling::Same, rust }
    }
}
