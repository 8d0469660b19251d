//! Conditions and expressions in the notation of the table language.

use std::fmt::Write;

use super::operators::Notation;
use super::{Comparison, Cond, CondId, Domain, ExprId, Input, LevelKind, Node, Pool};
use crate::table::expr as ast;

/// Longest text, in bytes; what is longer is broken off.
const MAX_LENGTH: usize = 4_000;

/// The index of the level of an input; where that is the code, too, as the code, which every version of the language has.
pub(crate) fn index(input: &Input) -> String {
    let is_code = match &input.domain {
        Domain::Discrete(levels) => levels.codes.iter().enumerate().all(|(index, code)| index as f64 == *code),
        Domain::Continuous { .. } | Domain::Word => false,
    };
    format!("{}({})", if is_code { "f32" } else { "index" }, input.name)
}

/// Prints terms of one pool.
#[derive(Clone, Copy)]
pub struct Printer<'a> {
    /// The pool of the terms.
    pub pool: &'a Pool,
    /// The inputs, for their names.
    pub inputs: &'a [Input],
}

impl Printer<'_> {
    /// An expression.
    pub fn expr(&self, id: ExprId) -> String {
        let mut out = String::new();
        self.write_expr(&mut out, id, 0);
        out
    }

    /// A condition.
    pub fn cond(&self, id: CondId) -> String {
        let mut out = String::new();
        self.write_cond(&mut out, id, 0);
        out
    }

    /// A condition that stands beside others, all of which hold.
    pub fn part(&self, id: CondId) -> String {
        let mut out = String::new();
        self.write_cond(&mut out, id, 2);
        out
    }

    fn call(&self, out: &mut String, name: &str, arguments: &[ExprId]) {
        out.push_str(name);
        out.push('(');
        for (i, argument) in arguments.iter().enumerate() {
            if i > 0 {
                out.push_str(", ");
            }
            self.write_expr(out, *argument, 0);
        }
        out.push(')');
    }

    fn infix(&self, out: &mut String, symbol: ast::BinaryOp, outer: u8, a: ExprId, b: ExprId) {
        let (binds, is_on_bits) = (symbol.strength(), symbol.is_on_bits());
        let parenthesise = binds < outer || is_on_bits && outer > 0;
        if parenthesise {
            out.push('(');
        }
        self.write_expr(out, a, binds);
        let _ = write!(out, " {} ", symbol.symbol());
        self.write_expr(out, b, binds + 1);
        if parenthesise {
            out.push(')');
        }
    }

    fn write_expr(&self, out: &mut String, id: ExprId, outer: u8) {
        // What functions share is written out where it is used, and may be endless.
        if out.len() > MAX_LENGTH {
            if !out.ends_with("...") {
                out.push_str("...");
            }
            return;
        }
        match self.pool.node(id) {
            Node::Const(number) => {
                let _ = write!(out, "{}", number.get());
            }
            Node::Word(word) => {
                let _ = write!(out, "{word}");
            }
            Node::Input(input) => out.push_str(&self.inputs[input.index()].name),
            Node::Index(input) => out.push_str(&index(&self.inputs[input.index()])),
            Node::Result(_) => out.push_str("value"),
            Node::Unary(op, a) => match op.row().notation {
                Notation::Function(name, _) | Notation::Shared(name) => self.call(out, name, &[a]),
                symbol @ (Notation::Prefix(_) | Notation::Infix(_)) => {
                    out.push_str(symbol.name());
                    self.write_expr(out, a, 6);
                }
            },
            Node::Binary(op, a, b) => match op.row().notation {
                Notation::Infix(symbol) => self.infix(out, symbol, outer, a, b),
                function @ (Notation::Function(..) | Notation::Shared(_) | Notation::Prefix(_)) => {
                    self.call(out, function.name(), &[a, b])
                }
            },
            Node::Ternary(op, a, b, c) => self.call(out, op.row().notation.name(), &[a, b, c]),
            Node::Select(condition, then, other) => {
                out.push_str("if ");
                self.write_cond(out, condition, 0);
                out.push_str(" { ");
                self.write_expr(out, then, 0);
                out.push_str(" } else { ");
                self.write_expr(out, other, 0);
                out.push_str(" }");
            }
        }
    }

    fn junction(&self, out: &mut String, symbol: &str, binds: u8, outer: u8, parts: &[CondId]) {
        if binds < outer {
            out.push('(');
        }
        for (i, part) in parts.iter().enumerate() {
            if i > 0 {
                let _ = write!(out, " {symbol} ");
            }
            self.write_cond(out, *part, binds + 1);
        }
        if binds < outer {
            out.push(')');
        }
    }

    /// `!domV`, `H != both`: denials that are written without parentheses.
    fn write_denial(&self, out: &mut String, id: CondId) -> bool {
        let Cond::Level(input, levels) = self.pool.cond(id) else { return false };
        let input = &self.inputs[input.index()];
        let Domain::Discrete(known) = &input.domain else { return false };
        if known.is_wide() {
            return false;
        }
        let mut members = levels.iter().filter_map(|l| known.names.get(usize::from(l)));
        let (Some(only), None) = (members.next(), members.next()) else { return false };
        let _ = match (known.kind, only.as_str()) {
            (LevelKind::Bool, "true") => write!(out, "!{}", input.name),
            (LevelKind::Bool, _) => write!(out, "{}", input.name),
            (_, level) => write!(out, "{} != {level}", input.name),
        };
        true
    }

    fn write_cond(&self, out: &mut String, id: CondId, outer: u8) {
        match self.pool.cond(id) {
            Cond::Const(value) => {
                let _ = write!(out, "{value}");
            }
            Cond::Level(input, levels) => {
                let input = &self.inputs[input.index()];
                let Domain::Discrete(known) = &input.domain else { return };
                if let Some(classes) = known.classes.as_ref().filter(|_| known.is_wide()) {
                    let (text, binds) = classes.condition(&input.name, *levels);
                    let _ = if binds < outer { write!(out, "({text})") } else { write!(out, "{text}") };
                    return;
                }
                let names: Vec<&str> =
                    levels.iter().filter_map(|l| known.names.get(usize::from(l)).map(String::as_str)).collect();
                let _ = match (known.kind, names.as_slice()) {
                    (LevelKind::Bool, ["true"]) => write!(out, "{}", input.name),
                    (LevelKind::Bool, _) => write!(out, "!{}", input.name),
                    (_, [one]) => write!(out, "{} == {one}", input.name),
                    (_, several) if several.len() + 1 == known.count() && known.count() > 2 => {
                        let missing = (0..known.count()).find(|l| !levels.contains(*l as u8)).unwrap_or_default();
                        write!(out, "{} != {}", input.name, known.names[missing])
                    }
                    (_, several) => write!(out, "{} in {{{}}}", input.name, several.join(", ")),
                };
            }
            Cond::Compare(op, a, b) => {
                self.write_expr(out, *a, 4);
                out.push_str(match op {
                    Comparison::Less => " < ",
                    Comparison::LessEqual => " <= ",
                    Comparison::Equal => " == ",
                });
                self.write_expr(out, *b, 4);
            }
            Cond::Not(a) if self.write_denial(out, *a) => {}
            Cond::Not(a) => {
                out.push_str("!(");
                self.write_cond(out, *a, 0);
                out.push(')');
            }
            Cond::And(parts) => self.junction(out, "&&", 2, outer, parts),
            Cond::Or(parts) => self.junction(out, "||", 1, outer, parts),
            Cond::If(c, a, b) => {
                out.push_str("if ");
                self.write_cond(out, *c, 0);
                out.push_str(" { ");
                self.write_cond(out, *a, 0);
                out.push_str(" } else { ");
                self.write_cond(out, *b, 0);
                out.push_str(" }");
            }
        }
    }
}
