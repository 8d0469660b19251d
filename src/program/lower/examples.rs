//! Examples: constant inputs and the result that they must lead to.

use super::scope::Env;
use super::{Lowering, Result};
use crate::diag::{Diagnostic, codes};
use crate::program::Example;
use crate::program::domain::{Input, Value};
use crate::table;
use crate::table::expr::{Expr, ExprKind};

impl Lowering<'_> {
    pub(super) fn example(&mut self, row: usize, example: &table::Example) -> Result<Example> {
        let mut inputs: Vec<Option<Value>> = self.inputs.iter().map(|i| i.default).collect();
        for (name, value) in &example.inputs {
            let Some(input) = self.input_or_call(&name.value) else {
                return Err(self.unknown_input(name, "unknown input"));
            };
            inputs[input.index()] = Some(literal(&self.inputs[input.index()], value)?);
        }
        for (input, value) in self.inputs.iter().zip(&inputs) {
            if value.is_none() && input.fetched.is_none() {
                return Err(Diagnostic::error(codes::BAD_EXAMPLE, format!("the example leaves out `{}`", input.name))
                    .at(example.span, "this example")
                    .at(input.span, "declared here, without a `default`")
                    .help("give it a value in the example, or a `default` where it is declared"));
            }
        }
        let expected = self.expected_output();
        let term = self.term(&example.value, &Env::default(), expected)?;
        let parts = self.components(term, example.value.span)?;
        let mut expected = Vec::with_capacity(parts.len());
        for part in parts {
            let Some(value) = self.pool.known(part.value) else {
                return Err(Diagnostic::error(codes::BAD_EXAMPLE, "an expected value is a constant")
                    .at(example.value.span, "depends on inputs"));
            };
            if let Some((lo, hi)) = part.clamp.filter(|(lo, hi)| !(*lo..=*hi).contains(&value)) {
                let message =
                    format!("the expected value {value} is not between the bounds {lo} and {hi} of the output");
                return Err(Diagnostic::error(codes::BAD_EXAMPLE, message)
                    .at(example.value.span, "no result is ever this")
                    .at(self.table.output.span, "clamped here"));
            }
            expected.push(value);
        }
        Ok(Example { row, span: example.span, inputs, expected })
    }
}

/// A constant value of an input: a level by name or code, or a number.
pub(super) fn literal(input: &Input, expr: &Expr) -> Result<Value> {
    let word = match (&expr.kind, expr.literal()) {
        (_, Some(n)) => format!("{n}"),
        (ExprKind::Name(name), None) => name.clone(),
        _ => {
            return Err(Diagnostic::error(codes::TYPE, "expected a constant").at(expr.span, "a level or a number"));
        }
    };
    input
        .parse(&word)
        .map_err(|message| Diagnostic::error(codes::BAD_VALUE, message).at(expr.span, format!("for `{}`", input.name)))
}
