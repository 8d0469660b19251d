//! U0221: claims about constants, helpers and functions that do not hold.
//!
//! A claim without inputs is decided by computing both sides, one for all levels of a few discrete
//! inputs by going through them. One for all values of numbers is proved where both sides are
//! polynomials in inputs and in waves of them; else it is tried out, and whoever reads the verdict
//! is told which it was.

use super::{Analysis, Run};
use crate::analyse::values::waves;
use crate::diag::{Diagnostic, codes};
use crate::eval::Interpreter;
use crate::points::{Point, Samples};
use crate::program::{Claim, ClaimedPair, Claims, Domain, Program, Value};

/// Points at which a claim is tried out that is not proved.
const POINTS: usize = 512;

/// Most combinations of levels that are gone through.
const MAX_STATES: usize = 4096;

/// The difference, of the larger side, that a claim without a tolerance leaves to rounding in `f64`.
const ROUNDING: f64 = 1e-12;

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::CLAIM_BROKEN], run: Run::Program(findings) };

/// The verdict on a claim.
#[derive(Debug, Clone, PartialEq)]
pub enum Verdict {
    /// Both sides were computed, for so many combinations of levels.
    Computed(usize),
    /// It holds for all values.
    Proved,
    /// It holds at so many points.
    Tried(usize),
    /// It does not hold at this point.
    Broken(Counterexample),
}

/// A point at which a claim does not hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Counterexample {
    point: Point,
    part: String,
    left: f64,
    right: f64,
    by: Option<f64>,
}

impl Verdict {
    /// The verdict in words.
    pub fn words(&self) -> String {
        match self {
            Verdict::Computed(1) => "computed".to_owned(),
            Verdict::Computed(states) => format!("computed for all {states} combinations of levels"),
            Verdict::Proved => "proved for all values".to_owned(),
            Verdict::Tried(points) => format!("tried at {points} points, not proved"),
            Verdict::Broken(_) => "does not hold".to_owned(),
        }
    }
}

/// Every claim of a program, with what is known of it.
pub fn verdicts(program: &Program) -> Vec<(&Claim, Verdict)> {
    let Some(claims) = &program.claims else { return Vec::new() };
    claims.all.iter().map(|claim| (claim, verdict(claims, claim))).collect()
}

fn findings(program: &Program) -> Vec<Diagnostic> {
    let Some(claims) = &program.claims else { return Vec::new() };
    let broken = verdicts(program).into_iter().filter_map(|(claim, verdict)| match verdict {
        Verdict::Broken(counter) => Some(broken(claims, claim, &counter)),
        Verdict::Computed(_) | Verdict::Proved | Verdict::Tried(_) => None,
    });
    broken.collect()
}

fn broken(claims: &Claims, claim: &Claim, counter: &Counterexample) -> Diagnostic {
    let Counterexample { part, left, right, by, .. } = counter;
    let of = if part.is_empty() { String::new() } else { format!(" in `{part}`") };
    let allowed = match by {
        Some(by) => format!("; they may differ by {by:e}"),
        None => String::new(),
    };
    let label = format!("the left side is {left}, the right side {right}{of}{allowed}");
    let error = Diagnostic::error(codes::CLAIM_BROKEN, format!("the claim `{}` does not hold", claim.name));
    let error = error.at(claim.span, label);
    let inputs = claim.inputs.iter().filter_map(|input| {
        let value = counter.point[input.index()]?;
        let input = &claims.program.inputs[input.index()];
        Some(format!("{} = {}", input.name, input.show(value)))
    });
    let place: Vec<String> = inputs.collect();
    match place.is_empty() {
        true => error.help(format!("they differ by {:e}", (left - right).abs())),
        false => error.help(format!("at {} they differ by {:e}", place.join(", "), (left - right).abs())),
    }
}

fn verdict(claims: &Claims, claim: &Claim) -> Verdict {
    let program = &claims.program;
    let mut interpreter = Interpreter::<f64>::new(program);
    let mut levels = claim.inputs.iter().map(|input| match &program.inputs[input.index()].domain {
        Domain::Discrete(levels) => Some(levels.count()),
        Domain::Continuous { .. } | Domain::Word => None,
    });
    let states = levels.try_fold(1, |all: usize, count| all.checked_mul(count?));
    if let Some(states) = states.filter(|states| *states <= MAX_STATES) {
        for state in 0..states {
            let point = in_state(program, claim, state);
            if let Some(counter) = contradicted(&mut interpreter, claim, &point) {
                return Verdict::Broken(counter);
            }
        }
        return Verdict::Computed(states);
    }
    let points = Samples::new(program).take(POINTS);
    let points: Vec<Point> = corners(program, claim).into_iter().chain(points).collect();
    for point in &points {
        if let Some(counter) = contradicted(&mut interpreter, claim, point) {
            return Verdict::Broken(counter);
        }
    }
    let by = claim.by.map(|by| program.pool.constant(by));
    match claim.pairs.iter().all(|pair| proved(program, pair, by)) {
        true => Verdict::Proved,
        false => Verdict::Tried(points.len()),
    }
}

/// Returns whether two sides differ by no more than is allowed, by their normal forms. `by` is nothing where
/// only rounding may differ, and holds nothing where what is allowed is no constant.
fn proved(program: &Program, pair: &ClaimedPair, by: Option<Option<f64>>) -> bool {
    if pair.left == pair.right {
        return true;
    }
    let Some((most, rounding)) = waves::difference(program, pair.left, pair.right) else { return false };
    match by {
        None | Some(None) => most <= rounding,
        // Coefficients that cancel are zero but for their rounding.
        Some(Some(by)) => most <= by.max(rounding),
    }
}

/// The point of a combination of levels of the inputs of a claim; all others have their first.
fn in_state(program: &Program, claim: &Claim, mut state: usize) -> Point {
    let mut point = anywhere(program);
    for input in &claim.inputs {
        if let Domain::Discrete(levels) = &program.inputs[input.index()].domain {
            point[input.index()] = Some(Value::Level((state % levels.count()) as u8));
            state /= levels.count();
        }
    }
    point
}

/// A point to change.
fn anywhere(program: &Program) -> Point {
    let first = |domain: &Domain| match domain {
        Domain::Discrete(_) => Value::Level(0),
        Domain::Continuous { lo, .. } => Value::Number(*lo),
        Domain::Word => Value::Number(0.0),
    };
    program.inputs.iter().map(|input| Some(first(&input.domain))).collect()
}

/// The points at which the numbers of a claim are at one of their bounds, or in the middle; few inputs only.
fn corners(program: &Program, claim: &Claim) -> Vec<Point> {
    let mut points = vec![anywhere(program)];
    for input in claim.inputs.iter().take(4) {
        let domain = &program.inputs[input.index()].domain;
        if let Some((lo, hi)) = domain.range() {
            let at = |value: f64| {
                points.iter().map(move |point| {
                    let mut point = point.clone();
                    point[input.index()] = Some(Value::Number(value));
                    point
                })
            };
            points = [lo, domain.point(f64::midpoint(lo, hi)), hi].into_iter().flat_map(at).collect();
        }
    }
    points
}

/// The first pair of a claim that differs at a point by more than is allowed.
fn contradicted(interpreter: &mut Interpreter<'_, f64>, claim: &Claim, point: &Point) -> Option<Counterexample> {
    interpreter.place(point).ok()?;
    let by = claim.by.map(|by| interpreter.number(by)).transpose().ok()?;
    for ClaimedPair { part, left, right } in &claim.pairs {
        let (left, right) = (interpreter.number(*left).ok()?, interpreter.number(*right).ok()?);
        let size = left.abs().max(right.abs());
        let allowed = by.unwrap_or_else(|| ROUNDING * size.max(1.0));
        // A difference that is no number is none that is allowed.
        let holds = left == right || (left - right).abs() <= allowed;
        if !holds {
            return Some(Counterexample { point: point.clone(), part: part.clone(), left, right, by });
        }
    }
    None
}
