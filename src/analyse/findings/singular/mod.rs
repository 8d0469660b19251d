//! U0551 to U0554: where a formula fails and the quantity it stands for does not.
//!
//! A finding is a point at which the reference interpreter was seen to fail,
//! judged by the value in hundreds of bits:
//!
//! - U0551: a divisor is zero and the whole has a limit, a *removable* singularity;
//! - U0552: a divisor is zero and there is no limit;
//! - U0553: equal terms on both sides of a difference are divided by something
//!   small; they cancel on paper only;
//! - U0554: an intermediate result overflows and the exact value does not.
//!
//! Divisors are solved for their zeros where they are products of affine forms
//! and searched elsewhere; overflow is looked for at corners of the domain and
//! at points inside. So every finding is real, but there may be others.

mod cancel;
mod points;
#[cfg(test)]
mod tests;
mod trace;
mod zeros;

use std::collections::BTreeMap;

use super::{Analysis, Run};
use crate::analyse::sets::budget::Budget;
use crate::analyse::values::real::Laid;
use crate::diag::{Diagnostic, codes};
use crate::eval::{Precise, Unknown};
use crate::program::normal::Normaliser;
use crate::program::print::Printer;
use crate::program::{BinaryOp, CondId, ExprId, InputId, Node, Program, Scalar, Value};
use crate::show::{Precision, sentence};
pub use points::inside as domain_points;
use trace::Trace;
use zeros::{Zero, zeros};

/// Longest term that is quoted in full.
const QUOTED: usize = 60;

/// A result this far from the exact one, relative to it, has lost its digits.
const LOST: f64 = 1e-3;

/// A point at which a formula fails.
#[derive(Debug, Clone)]
pub struct Singularity {
    /// In words, where: `k = 0.5`, or which divisor is zero.
    pub place: String,
    /// The divisor that is zero.
    pub divisor: ExprId,
    /// One value per input.
    pub point: Vec<Value>,
    /// The result there in `f32`.
    pub result: Vec<f64>,
    /// The limit, if there is one.
    pub limit: Option<Vec<f64>>,
    /// The input and value that the place fixes, if it is of this simple kind.
    pub fixed: Option<(InputId, f64)>,
}

/// Operations that one takes as long as in a trace, which keeps all values by what they are values of.
const TRACED: usize = 8;

/// The same in hundreds of bits, at a point and beside it.
const PRECISE: usize = 1000;

/// Every singularity that was found, each place once.
pub fn singularities(program: &Program) -> Vec<Singularity> {
    within(program, &Budget::new(u64::MAX))
}

/// The same, as far as the work allows.
fn within(program: &Program, budget: &Budget) -> Vec<Singularity> {
    let divisors = divisors(program);
    let Some(mut judge) = (!divisors.is_empty()).then(|| Precise::new(program)).flatten() else { return Vec::new() };
    let mut normaliser = Normaliser::default();
    let mut found: BTreeMap<String, Singularity> = BTreeMap::new();
    for divisor in divisors {
        for zero in zeros(program, &mut normaliser, divisor) {
            let place = place(program, &zero);
            if found.contains_key(&place) {
                continue;
            }
            // Moving an input to the zero may leave the domain, so what is declared is asked afterwards.
            let bases = points::drawn(program, tries(&zero)).take_while(|_| !budget.is_spent());
            let candidates = bases.flat_map(|base| zero.near(program, &base, budget));
            let size = Laid::new(&program.pool, divisor).work();
            let zero_at =
                |point: &Vec<Value>| budget.compute(TRACED * size) && Trace::<f32>::of(program, point, divisor) == 0.0;
            let inside = candidates.filter(|point| zero_at(point) && points::holds(program, point));
            // Where a guard keeps the division away, it does so at most points.
            let Some(point) = inside.take(points::BASES).find(|point| fails_at(program, divisor, point, budget)) else {
                continue;
            };
            let trace = Trace::<f32>::run(program, &point);
            if !budget.compute(PRECISE * trace.order.len()) {
                return Vec::new();
            }
            let result = program.output.numbers(&trace.result);
            let limit = match judge.limit(&given(&point)) {
                Ok(limit) => Some(limit),
                Err(Unknown::NoLimit) => None,
                Err(Unknown::Absent(_)) => continue,
            };
            let fixed = if let Zero::Fixed(input, value) = zero { Some((input, value)) } else { None };
            found.insert(place.clone(), Singularity { place, divisor, point, result, limit, fixed });
        }
    }
    found.into_values().collect()
}

/// The number of points to begin with: a search along every input is expensive.
fn tries(zero: &Zero) -> usize {
    if matches!(zero, Zero::Somewhere(_)) { points::BASES } else { 100 * points::BASES }
}

/// Returns whether the program divides by this expression there, and it is zero.
fn fails_at(program: &Program, divisor: ExprId, point: &[Value], budget: &Budget) -> bool {
    let trace = Trace::<f32>::run(program, point);
    budget.compute(TRACED * trace.order.len());
    let divides = |expr: &ExprId| {
        let node = program.pool.node(*expr);
        matches!(node, Node::Binary(BinaryOp::Divide | BinaryOp::Remainder, _, b) if b == divisor)
    };
    trace.value(divisor) == Some(0.0) && trace.order.iter().any(divides)
}

fn given(point: &[Value]) -> Vec<Option<Value>> {
    point.iter().copied().map(Some).collect()
}

/// The divisors that any result or condition contains and that are not a nonzero constant.
fn divisors(program: &Program) -> Vec<ExprId> {
    let mut all: Vec<ExprId> = Vec::new();
    for expr in expressions(program) {
        if let Node::Binary(BinaryOp::Divide | BinaryOp::Remainder, _, b) = program.pool.node(expr)
            && program.pool.constant(b).is_none_or(|b| b == 0.0)
            && !all.contains(&b)
        {
            all.push(b);
        }
    }
    all
}

/// Everything that a result or a condition is made of, operands first.
fn expressions(program: &Program) -> Vec<ExprId> {
    let mut walk = Walk::default();
    for row in &program.rows {
        walk.cond(program, row.guard);
        for line in &row.lines {
            walk.cond(program, line.condition);
            line.values.iter().for_each(|value| walk.expr(program, *value));
        }
    }
    program.default.iter().for_each(|value| walk.expr(program, *value));
    walk.order
}

#[derive(Default)]
struct Walk {
    order: Vec<ExprId>,
    seen: std::collections::HashSet<ExprId>,
    conditions: std::collections::HashSet<CondId>,
}

impl Walk {
    fn cond(&mut self, program: &Program, condition: CondId) {
        if !self.conditions.insert(condition) {
            return;
        }
        let cond = program.pool.cond(condition);
        cond.compared().for_each(|part| self.expr(program, part));
        cond.children().for_each(|part| self.cond(program, part));
    }

    fn expr(&mut self, program: &Program, expr: ExprId) {
        if !self.seen.insert(expr) {
            return;
        }
        let node = program.pool.node(expr);
        if let Some(condition) = node.condition() {
            self.cond(program, condition);
        }
        node.children().for_each(|part| self.expr(program, part));
        self.order.push(expr);
    }
}

fn place(program: &Program, zero: &Zero) -> String {
    match zero {
        Zero::Everywhere => "every point".to_owned(),
        Zero::Fixed(input, value) => {
            format!("`{} = {}`", program.inputs[input.index()].name, Precision::F32.show(*value))
        }
        Zero::Plane { factor, .. } | Zero::Somewhere(factor) => format!("`{} = 0`", quote(program, *factor)),
    }
}

fn quote(program: &Program, expr: ExprId) -> String {
    let text = Printer { pool: &program.pool, inputs: &program.inputs }.expr(expr);
    match text.char_indices().nth(QUOTED) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// The point in words: `k = 0, b = 1`.
fn at(program: &Program, point: &[Value]) -> String {
    let mentioned = program.inputs.iter().zip(point).map(|(input, value)| match value {
        Value::Number(number) => format!("{} = {}", input.name, Precision::F32.show(*number)),
        Value::Level(_) => format!("{} = {}", input.name, input.show(*value)),
    });
    mentioned.collect::<Vec<_>>().join(", ")
}

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::REMOVABLE, codes::POLE, codes::CANCELS, codes::OVERFLOW], run: Run::Bounded(findings) };

/// Everything that is wrong with the numbers of a program.
fn findings(program: &Program, budget: &Budget) -> Vec<Diagnostic> {
    if !program.output.components().iter().any(|component| component.scalar == Scalar::Float) {
        return Vec::new();
    }
    let singularities = within(program, budget);
    let (removable, poles): (Vec<_>, Vec<_>) = singularities.iter().partition(|s| s.limit.is_some());
    let mut all: Vec<Diagnostic> =
        [removable, poles].iter().filter_map(|group| describe(program, group, budget)).collect();
    all.extend(cancel::findings(program, &singularities, budget));
    all.extend(overflows(program, budget));
    all
}

/// One finding for all places of a kind: a formula has many, and they have one cause.
fn describe(program: &Program, places: &[&Singularity], budget: &Budget) -> Option<Diagnostic> {
    let first = places.first()?;
    let shown = |values: &[f64]| sentence(&program.output, values, Precision::F32);
    let name = called(program);
    let listed = places.iter().map(|s| s.place.as_str()).collect::<Vec<_>>().join(", ");
    let mut diagnostic = match first.limit {
        Some(_) => {
            let message = format!("`{name}` divides by zero at {listed}, where its value is finite");
            Diagnostic::warning(codes::REMOVABLE, message)
        }
        None => {
            Diagnostic::warning(codes::POLE, format!("`{name}` divides by zero at {listed}, and has no limit there"))
        }
    };
    let mut divisors: Vec<String> = Vec::new();
    for singularity in places {
        let divisor = format!("`{}`", quote(program, singularity.divisor));
        if !divisors.contains(&divisor) {
            divisors.push(divisor);
        }
    }
    if let Some(span) = Trace::<f32>::place(program, &first.point, first.divisor) {
        diagnostic = diagnostic.at(span, format!("divides by {}", divisors.join(", ")));
    }
    for singularity in places {
        let Singularity { place, point, result, limit, .. } = singularity;
        let result = shown(result);
        let fate = match limit {
            Some(limit) => format!("f32 gives {result}, the limit is {}", shown(limit)),
            None => format!("f32 gives {result}, and beside it the values differ or are not finite"),
        };
        diagnostic = diagnostic.help(format!("{place}: {fate}, at {}", at(program, point)));
    }
    let lost = places.iter().filter(|s| s.limit.is_some()).find_map(|s| loss(program, s, budget));
    if let Some(loss) = lost {
        diagnostic = diagnostic.help(format!(
            "digits are lost nearby as well: at {} f32 gives {}, exact is {}",
            loss.place,
            shown(&loss.got),
            shown(&loss.exact)
        ));
    }
    Some(match first.limit {
        Some(_) => diagnostic.help("`umbrage stabilise` looks for a form without this division"),
        None => diagnostic.help("exclude the place from the domain, or give it a case of its own"),
    })
}

/// The name in the table.
fn called(program: &Program) -> &str {
    program.function.as_ref().map_or(&program.name, |function| &function.name)
}

/// A point near a singularity where the digits of the result are gone.
pub(super) struct Loss {
    place: String,
    got: Vec<f64>,
    exact: Vec<f64>,
}

/// Looks for lost digits beside a singularity, far away first: the farther, the worse.
pub(super) fn loss(program: &Program, singularity: &Singularity, budget: &Budget) -> Option<Loss> {
    let (input, value) = singularity.fixed?;
    let mut judge = Precise::new(program)?;
    let mut point = singularity.point.clone();
    for distance in [1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
        for beside in [value + distance, value - distance] {
            let beside = f64::from(beside as f32);
            let outside = match program.inputs[input.index()].domain {
                crate::program::Domain::Continuous { lo, hi, .. } => !(lo..=hi).contains(&beside),
                crate::program::Domain::Discrete(_) | crate::program::Domain::Word => true,
            };
            if outside || beside == value {
                continue;
            }
            point[input.index()] = Value::Number(beside);
            let trace = Trace::<f32>::run(program, &point);
            if !budget.compute(PRECISE * trace.order.len()) {
                return None;
            }
            let got = program.output.numbers(&trace.result);
            let Ok(exact) = judge.value(&given(&point)) else { continue };
            let lost = got.iter().zip(&exact).any(|(got, exact)| {
                got.is_finite() && exact.is_finite() && exact.abs() > 1e-6 && (got - exact).abs() > LOST * exact.abs()
            });
            if lost {
                let name = &program.inputs[input.index()].name;
                return Some(Loss { place: format!("{name} = {}", Precision::F32.show(beside)), got, exact });
            }
        }
    }
    None
}

/// U0554: one finding for each kind of operation that overflows, at the first point that shows it.
fn overflows(program: &Program, budget: &Budget) -> Vec<Diagnostic> {
    let risky = |expr: &ExprId| match program.pool.node(*expr) {
        Node::Unary(op, _) => op.row().is_exponential,
        Node::Binary(op, ..) => op.row().is_exponential,
        Node::Const(_)
        | Node::Word(_)
        | Node::Input(_)
        | Node::Index(_)
        | Node::Result(_)
        | Node::Ternary(..)
        | Node::Select(..) => false,
    };
    if !expressions(program).iter().any(risky) {
        return Vec::new();
    }
    let Some(mut judge) = Precise::new(program) else { return Vec::new() };
    let mut found: BTreeMap<ExprId, Diagnostic> = BTreeMap::new();
    for point in points::corners(program).into_iter().chain(points::inside(program, points::BASES)) {
        let trace = Trace::<f32>::run(program, &point);
        if !budget.compute(TRACED * trace.order.len()) {
            break;
        }
        let got = program.output.numbers(&trace.result);
        if got.iter().all(|v| v.is_finite()) {
            continue;
        }
        let is_number = |expr: &&ExprId| !program.pool.is_word(**expr);
        let fails = |expr: &&ExprId| trace.value(**expr).is_some_and(|v| !v.is_finite());
        let first = trace.order.iter().filter(is_number).find(fails);
        let Some(first) = first.filter(|expr| risky(expr) && !found.contains_key(expr)) else { continue };
        budget.compute(PRECISE * trace.order.len());
        let Ok(exact) = judge.limit(&given(&point)) else { continue };
        if exact.iter().any(|v| (*v as f32).is_infinite()) {
            continue;
        }
        let shown = |values: &[f64]| sentence(&program.output, values, Precision::F32);
        let message = format!("`{}` overflows on the way to a value that is finite", called(program));
        let mut diagnostic = Diagnostic::warning(codes::OVERFLOW, message);
        if let Some(span) = Trace::<f32>::place(program, &point, *first) {
            diagnostic = diagnostic.at(span, format!("`{}` is infinite in f32", quote(program, *first)));
        }
        let fate = format!("at {}: f32 gives {}, exact is {}", at(program, &point), shown(&got), shown(&exact));
        found.insert(
            *first,
            diagnostic.help(fate).help("combine the factors, so that large and small ones meet in one exponent"),
        );
    }
    found.into_values().collect()
}
