//! The one table of the functions of the language that are not operators.
//!
//! An entry says everything about a function: its name, its parameters and their kinds,
//! its line of documentation, and what a call of it is expanded to, by WGSL's
//! definitions. Lowering, messages, the names that a table may not take and
//! `docs/language.md` read it. Operators that are called by a name, such as `min`, stand
//! in the [table of operators](crate::program::operators); [`signatures`] lists both.

use super::scope::Env;
use super::terms::{Call, Expected, Term, type_error};
use super::{Lowering, Result, SINCE};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::operators::{BinaryOp, Notation, Operator, UnaryOp};
use crate::program::pool::ExprId;
use crate::table::expr::Expr;

/// The kind of an argument.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A number or a vector.
    Numbers,
    /// One of two values of any one type.
    Alternative,
    /// A condition.
    Condition,
    /// A number, vector or record, or what else can be made a number.
    Value,
    /// A list of constants, or its name.
    Constants,
    /// No expression: a form of its own.
    Form,
}

/// An expansion of the components of arguments.
type Expand = fn(&mut Lowering<'_>, &[Vec<ExprId>], Span) -> Result<Term>;

/// The meaning of a call.
enum Meaning {
    /// An expansion of the components of its arguments.
    Expansion(Expand),
    /// A term made of the arguments as they are written.
    Written(fn(&mut Lowering<'_>, Call<'_>) -> Result<Term>),
}

/// A function of the language.
pub(super) struct BuiltIn {
    /// Its name.
    pub(super) name: &'static str,
    /// Its parameters, as documents show them, with their kinds.
    pub(super) parameters: &'static [(&'static str, Kind)],
    /// Takes any number of arguments of the kind of its one parameter.
    repeats: bool,
    /// The version of the language that it came with.
    pub(super) since: u32,
    /// Its meaning in a few words.
    doc: &'static str,
    meaning: Meaning,
}

/// The table: an entry per function.
static ALL: &[BuiltIn] = &[
    BuiltIn {
        name: "select",
        parameters: &[("f", Kind::Alternative), ("t", Kind::Alternative), ("c", Kind::Condition)],
        repeats: false,
        since: 1,
        doc: "`if c { t } else { f }`: note the order",
        meaning: Meaning::Written(select),
    },
    BuiltIn {
        name: "f32",
        parameters: &[("a", Kind::Value)],
        repeats: false,
        since: 1,
        doc: "of a level its code; of a condition 1 or 0; of a number itself; of a U32 that number, rounded",
        meaning: Meaning::Written(|lowering, call| lowering.number_of(&call.arguments[0], call.env)),
    },
    BuiltIn {
        name: "u32",
        parameters: &[("a", Kind::Value)],
        repeats: false,
        since: SINCE,
        doc: "of a number its whole part, limited to U32; of a whole number that number modulo 2^32; of a condition 1 or 0",
        meaning: Meaning::Written(|lowering, call| lowering.made_word(&call.arguments[0], call.env)),
    },
    BuiltIn {
        name: "i32",
        parameters: &[("a", Kind::Value)],
        repeats: false,
        since: SINCE,
        doc: "of a U32 that is at most 2^24 the whole number",
        meaning: Meaning::Written(|lowering, call| lowering.made_whole(&call.arguments[0], call.env)),
    },
    BuiltIn {
        name: "index",
        parameters: &[("a", Kind::Value)],
        repeats: false,
        since: SINCE,
        doc: "of a level its place among the others, counted from 0; of a condition 1 or 0",
        meaning: Meaning::Written(|lowering, call| lowering.index_of(&call.arguments[0], call.env)),
    },
    BuiltIn {
        name: "count",
        parameters: &[("...", Kind::Condition)],
        repeats: true,
        since: SINCE,
        doc: "the number of conditions that hold",
        meaning: Meaning::Written(|lowering, call| {
            let conditions = call.arguments.iter().map(|argument| lowering.condition(argument, call.env));
            let conditions = conditions.collect::<Result<Vec<_>>>()?;
            lowering.count(&conditions, call.span)
        }),
    },
    BuiltIn::vector("vec2", "numbers and vectors joined to a vector of 2; a single number is repeated", |_, a, at| {
        joined("vec2", 2, a, at)
    }),
    BuiltIn::vector("vec3", "the same, a vector of 3", |_, a, at| joined("vec3", 3, a, at)),
    BuiltIn::vector("vec4", "the same, a vector of 4", |_, a, at| joined("vec4", 4, a, at)),
    BuiltIn::of_two("dot", "sum of the products", |lowering, parts, at| {
        Ok(Term::Number(lowering.dot(&parts[0], &parts[1], at)?))
    }),
    BuiltIn::of_one("length", "square root of dot(a, a); of a number its abs", |lowering, parts, at| {
        Ok(Term::Number(lowering.length(&parts[0], at)?))
    }),
    BuiltIn::of_two("distance", "length(a - b)", |lowering, parts, at| {
        let difference = lowering.pairwise(BinaryOp::Subtract, &parts[0], &parts[1], at)?;
        Ok(Term::Number(lowering.length(&difference, at)?))
    }),
    BuiltIn::of_one("normalize", "a / length(a), for a vector", |lowering, parts, at| {
        let length = vec![lowering.length(&parts[0], at)?; parts[0].len()];
        Ok(Term::Vector(lowering.pairwise(BinaryOp::Divide, &parts[0], &length, at)?))
    }),
    BuiltIn::of_two("cross", "of two vectors of 3", |lowering, parts, at| lowering.cross(&parts[0], &parts[1], at)),
    BuiltIn {
        name: "poly",
        parameters: &[("a", Kind::Value), ("[c0, c1, c2]", Kind::Constants)],
        repeats: false,
        since: 1,
        doc: "c0 + a (c1 + a c2), in this order; the list may be a constant's name",
        meaning: Meaning::Written(|lowering, call| lowering.polynomial(call)),
    },
    BuiltIn {
        name: "lookup",
        parameters: &[("list", Kind::Form), ("x", Kind::Form)],
        repeats: false,
        since: 2,
        doc: "the list at x, from 0 at its first item to 1 at its last, interpolated and clamped; of two dimensions `lookup(list, x, y)`",
        meaning: Meaning::Written(|lowering, call| lowering.lookup(call)),
    },
    BuiltIn {
        name: "sum",
        parameters: &[("n in list", Kind::Form), ("F", Kind::Value)],
        repeats: false,
        since: 1,
        doc: "the sum of F over a list of constants or, as `sum(i in 1 .. 8, F)`, over whole numbers",
        meaning: Meaning::Written(|_, call| {
            let error = Diagnostic::error(codes::CALL, "`sum` needs a name that runs over something");
            Err(error
                .at(call.span, "nothing runs here")
                .help("`sum(n in nodes, n.y * x)` or `sum(i in 0 .. 3, i * x)`"))
        }),
    },
    BuiltIn {
        name: "iterate",
        parameters: &[("n", Kind::Form), ("x = a", Kind::Form), ("F", Kind::Form)],
        repeats: false,
        since: 2,
        doc: "F done n times, where x is a at first, then what F gave; n is a constant",
        meaning: Meaning::Written(|_, call| {
            let error = Diagnostic::error(codes::CALL, "`iterate` needs a value that changes with each step");
            Err(error.at(call.span, "nothing changes here").help("`iterate(3, x = 1, 0.5 * (x + a / x))`"))
        }),
    },
];

impl BuiltIn {
    /// A vector made of any number of components.
    const fn vector(name: &'static str, doc: &'static str, expand: Expand) -> Self {
        Self {
            name,
            parameters: &[("...", Kind::Numbers)],
            repeats: true,
            since: 1,
            doc,
            meaning: Meaning::Expansion(expand),
        }
    }

    /// A function of one number or vector.
    const fn of_one(name: &'static str, doc: &'static str, expand: Expand) -> Self {
        Self {
            name,
            parameters: &[("a", Kind::Numbers)],
            repeats: false,
            since: 1,
            doc,
            meaning: Meaning::Expansion(expand),
        }
    }

    /// A function of two numbers, or of two vectors of one size.
    const fn of_two(name: &'static str, doc: &'static str, expand: Expand) -> Self {
        let parameters = &[("a", Kind::Numbers), ("b", Kind::Numbers)];
        Self { name, parameters, repeats: false, since: 1, doc, meaning: Meaning::Expansion(expand) }
    }
}

/// Functions of the language as they are called: name, parameters, meaning in a few words.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Signature {
    /// The name of the function.
    pub name: &'static str,
    /// Its parameters, as documents show them.
    pub parameters: String,
    /// Its meaning in a few words.
    pub doc: &'static str,
}

/// All functions of the language, those that are operators first.
///
/// ```
/// use umbrage::program::signatures;
///
/// let dot = signatures().find(|function| function.name == "dot").unwrap();
/// assert_eq!((dot.parameters.as_str(), dot.doc), ("a, b", "sum of the products"));
/// ```
pub fn signatures() -> impl Iterator<Item = Signature> {
    let operators = Operator::all().filter_map(|op| match op.notation() {
        Notation::Function(name, parameters) => {
            Some(Signature { name, parameters: parameters.to_owned(), doc: op.doc() })
        }
        Notation::Shared(_) | Notation::Prefix(_) | Notation::Infix(_) => None,
    });
    operators.chain(ALL.iter().map(|function| {
        let parameters: Vec<&str> = function.parameters.iter().map(|(name, _)| *name).collect();
        Signature { name: function.name, parameters: parameters.join(", "), doc: function.doc }
    }))
}

/// The function with a name.
pub(super) fn named(name: &str) -> Option<&'static BuiltIn> {
    ALL.iter().find(|function| function.name == name)
}

/// Returns whether a version of the language has a function of this name.
pub(super) fn is_taken(name: &str, language: u32) -> bool {
    Operator::named(name).is_some() || named(name).is_some_and(|function| function.since <= language)
}

/// Refuses a call with another number of arguments.
pub(super) fn check_arity(name: &str, takes: usize, call: Call<'_>) -> Result<()> {
    if call.arguments.len() == takes {
        return Ok(());
    }
    let plural = if takes == 1 { "" } else { "s" };
    let message = format!("`{name}` takes {takes} argument{plural}, not {}", call.arguments.len());
    let error = Diagnostic::error(codes::CALL, message).at(call.span, "wrong number of arguments");
    Err(match signatures().find(|function| function.name == name) {
        Some(Signature { name, parameters, doc }) => error.help(format!("`{name}({parameters})`: {doc}")),
        None => error,
    })
}

impl Lowering<'_> {
    /// A call of a function of the language.
    pub(super) fn built_in(&mut self, function: &BuiltIn, call: Call<'_>) -> Result<Term> {
        self.scopes[call.env.scope].since(function.since, call.span, &format!("`{}`", function.name))?;
        let form = function.parameters.iter().any(|(_, kind)| *kind == Kind::Form);
        if !function.repeats && !form {
            check_arity(function.name, function.parameters.len(), call)?;
        }
        match &function.meaning {
            Meaning::Written(lower) => lower(self, call),
            Meaning::Expansion(expand) => {
                let parts = call.arguments.iter().map(|argument| self.parts(argument, call.env));
                let parts = parts.collect::<Result<Vec<_>>>()?;
                if let [a, b] = parts.as_slice()
                    && !function.repeats
                    && a.len() != b.len()
                {
                    return Err(type_error(
                        call.span,
                        "vectors of different sizes",
                        "operands must have the same size",
                    ));
                }
                expand(self, &parts, call.span)
            }
        }
    }

    /// The components of a number or vector.
    fn parts(&mut self, argument: &Expr, env: &Env) -> Result<Vec<ExprId>> {
        match self.term(argument, env, Expected::Anything)? {
            Term::Number(number) => Ok(vec![number]),
            Term::Vector(parts) => Ok(parts),
            other @ (Term::Whole(_)
            | Term::Word(_)
            | Term::Bool(_)
            | Term::Level(..)
            | Term::List(_)
            | Term::Record(_)) => Err(self.no_number(&other, argument.span)),
        }
    }

    fn pairwise(&mut self, op: BinaryOp, a: &[ExprId], b: &[ExprId], at: Span) -> Result<Vec<ExprId>> {
        a.iter().zip(b).map(|(a, b)| self.binary_number(op, *a, *b, at)).collect()
    }

    fn dot(&mut self, a: &[ExprId], b: &[ExprId], at: Span) -> Result<ExprId> {
        let mut sum = self.binary_number(BinaryOp::Multiply, a[0], b[0], at)?;
        for (x, y) in a.iter().zip(b).skip(1) {
            let product = self.binary_number(BinaryOp::Multiply, *x, *y, at)?;
            sum = self.binary_number(BinaryOp::Add, sum, product, at)?;
        }
        Ok(sum)
    }

    fn length(&mut self, a: &[ExprId], at: Span) -> Result<ExprId> {
        if let [only] = a {
            return self.unary_number(UnaryOp::Abs, *only, at);
        }
        let square = self.dot(a, a, at)?;
        self.unary_number(UnaryOp::Sqrt, square, at)
    }

    fn cross(&mut self, a: &[ExprId], b: &[ExprId], at: Span) -> Result<Term> {
        if a.len() != 3 {
            return Err(type_error(at, "a vector of another size", "`cross` needs vectors of 3"));
        }
        let mut part = |i: usize, j: usize| {
            let x = self.binary_number(BinaryOp::Multiply, a[i], b[j], at)?;
            let y = self.binary_number(BinaryOp::Multiply, a[j], b[i], at)?;
            self.binary_number(BinaryOp::Subtract, x, y, at)
        };
        Ok(Term::Vector(vec![part(1, 2)?, part(2, 0)?, part(0, 1)?]))
    }
}

fn select(lowering: &mut Lowering<'_>, call: Call<'_>) -> Result<Term> {
    let condition = lowering.condition(&call.arguments[2], call.env)?;
    let (other, then) =
        lowering.alternatives(&call.arguments[0], &call.arguments[1], call.env, call.expected.clone())?;
    let term = lowering.choose(condition, then, other, call.span)?;
    if call.env.scope == 0 {
        lowering.note_choice(call.span, condition, &term);
    }
    Ok(term)
}

/// A vector of a size, of components joined.
fn joined(name: &str, size: usize, arguments: &[Vec<ExprId>], at: Span) -> Result<Term> {
    let mut parts: Vec<ExprId> = arguments.concat();
    if parts.len() == 1 {
        parts = vec![parts[0]; size];
    }
    if parts.len() == size {
        return Ok(Term::Vector(parts));
    }
    let message = format!("`{name}` needs {size} components, not {}", parts.len());
    Err(Diagnostic::error(codes::CALL, message).at(at, "wrong number of components"))
}
