//! The computation of a value, one operation at a time, operands first.

use std::collections::{HashMap, HashSet};

use super::Witness;
use crate::eval::NeedsFetch;
use crate::program::operators::Notation;
use crate::program::{ExprId, Node, Real, Scalar, print};

/// One operation of a computation.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Step {
    /// The name of its result: one of the table, `#1` and so on, or `value` at the end.
    pub name: String,
    /// The operation on names, such as `1 + px`.
    pub formula: String,
    /// The operation on numbers, such as `1 + 0.25`; absent where it says no more than the formula.
    pub numbers: Option<String>,
    /// Why this side of a choice is taken.
    pub because: Option<String>,
    /// The result.
    pub value: String,
}

/// The steps that compute the components of a result.
pub(super) fn of<T: Real>(witness: &mut Witness<'_, T>, values: &[ExprId]) -> Result<Vec<Step>, NeedsFetch> {
    let components = witness.program.output.components();
    let inputs = witness.program.inputs.iter().map(|input| input.name.clone());
    let taken = inputs.chain(components.iter().map(|component| component.name.clone()));
    let mut steps = Steps { taken: taken.collect(), witness, done: HashMap::new(), list: Vec::new(), anonymous: 0 };
    // Levels are numbered inside; only the numbers themselves are worth deriving.
    let numbers = values
        .iter()
        .zip(&components)
        .filter(|(_, component)| matches!(component.scalar, Scalar::Float | Scalar::Word));
    for (root, component) in numbers {
        steps.root(*root, &component.name)?;
    }
    Ok(steps.list)
}

struct Steps<'w, 'p, T> {
    witness: &'w mut Witness<'p, T>,
    /// Names that mean something already.
    taken: HashSet<String>,
    /// The names of the results of earlier steps.
    done: HashMap<ExprId, String>,
    list: Vec<Step>,
    anonymous: usize,
}

impl<T: Real> Steps<'_, '_, T> {
    fn root(&mut self, expr: ExprId, name: &str) -> Result<(), NeedsFetch> {
        let before = self.list.len();
        let operand = self.operand(expr)?;
        match self.list[before..].last_mut() {
            // The last step is the result, so it needs no number of its own.
            Some(last) if operand.starts_with('#') => {
                name.clone_into(&mut last.name);
                self.anonymous -= 1;
                self.done.insert(expr, name.to_owned());
            }
            _ => {
                let value = self.witness.value(expr)?;
                self.list.push(Step { name: name.to_owned(), formula: operand, numbers: None, because: None, value });
            }
        }
        Ok(())
    }

    /// The name of an expression, after the steps that compute it.
    fn operand(&mut self, expr: ExprId) -> Result<String, NeedsFetch> {
        if let Some(name) = self.done.get(&expr) {
            return Ok(name.clone());
        }
        let node = self.witness.node(expr);
        let operands: Vec<ExprId> = match node {
            Node::Const(number) => return Ok(number.get().to_string()),
            Node::Word(word) => return Ok(word.to_string()),
            Node::Input(input) => return Ok(self.witness.program.inputs[input.index()].name.clone()),
            Node::Index(input) => return Ok(print::index(&self.witness.program.inputs[input.index()])),
            Node::Result(_) => return Ok("value".to_owned()),
            Node::Unary(..) | Node::Binary(..) | Node::Ternary(..) => node.children().collect(),
            Node::Select(condition, then, other) => {
                let holds = self.witness.interpreter.holds(condition)?;
                let chosen = if holds { then } else { other };
                let before = self.list.len();
                let formula = self.operand(chosen)?;
                let tested = self.witness.tested(condition)?;
                let because = match holds {
                    true => format!("as {}", tested.condition),
                    false => format!("as {} fails ({})", tested.condition, tested.facts.join(", ")),
                };
                // A side that was computed just for this choice is the choice's own step.
                if self.list.len() > before
                    && formula.starts_with('#')
                    && let Some(last) = self.list.pop()
                {
                    self.anonymous -= 1;
                    let because = last.because.map_or(because.clone(), |inner| format!("{because}, {inner}"));
                    let name = self.push(expr, last.formula, last.numbers, Some(because))?;
                    self.done.insert(chosen, name.clone());
                    return Ok(name);
                }
                return self.push(expr, formula, None, Some(because));
            }
        };
        let mut names = Vec::new();
        let mut numbers = Vec::new();
        for operand in operands {
            names.push(self.operand(operand)?);
            numbers.push(self.witness.value(operand)?);
        }
        self.push(expr, written(node, &names), Some(written(node, &numbers)), None)
    }

    fn push(
        &mut self,
        expr: ExprId,
        formula: String,
        numbers: Option<String>,
        because: Option<String>,
    ) -> Result<String, NeedsFetch> {
        let label = self.witness.program.pool.label(expr).filter(|label| !self.taken.contains(*label));
        let name = match label {
            Some(label) => label.to_owned(),
            None => {
                self.anonymous += 1;
                format!("#{}", self.anonymous)
            }
        };
        self.taken.insert(name.clone());
        self.done.insert(expr, name.clone());
        let numbers = numbers.filter(|numbers| *numbers != formula);
        let value = self.witness.value(expr)?;
        self.list.push(Step { name: name.clone(), formula, numbers, because, value });
        Ok(name)
    }
}

/// An operation on operands that are single words.
fn written(node: Node, operands: &[String]) -> String {
    let infix = |symbol: &str| operands.join(&format!(" {symbol} "));
    let form = |notation: Notation| match notation {
        Notation::Function(..) | Notation::Shared(_) => format!("{}({})", notation.name(), operands.join(", ")),
        // In parentheses, as the operand may be a negative number.
        Notation::Prefix(symbol) => format!("{}({})", symbol.symbol(), operands.join(", ")),
        Notation::Infix(symbol) => infix(symbol.symbol()),
    };
    match node {
        Node::Unary(op, _) => form(op.row().notation),
        Node::Binary(op, ..) => form(op.row().notation),
        Node::Ternary(op, ..) => form(op.row().notation),
        Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => {
            infix(",")
        }
    }
}
