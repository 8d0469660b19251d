//! The accuracy of a formula in `f32`, measured against hundreds of bits.
//!
//! The reference is the *original* formula, evaluated beside each point so that
//! its removable singularities have their limits ([`Precise::limit`]); nothing
//! about the rewriting is trusted. Points are spread over the domain, on and
//! around every singularity that the analysis finds in the original, and where
//! the declared scale is least: where little is left of what is subtracted.
//!
//! At the same points the new form is evaluated in intervals. What they admit
//! bounds the error of every executor that keeps WGSL's accuracy rules.

use crate::analyse::{domain_points, singularities};
use crate::diag::Failure;
use crate::eval::{Interpreter, IntervalInterpreter, NOTHING, Precise};
use crate::program::{Domain, Program, Value};

/// Points spread over the domain, for each function.
const SPREAD: usize = 80;

/// Points from which the least scale is looked for.
const THIN: usize = 16;

/// Distances from a singularity at which a function is tried.
const DISTANCES: [f64; 5] = [0.0, 1e-7, 1e-5, 1e-4, 1e-2];

/// Half a unit in the last place of 1 in `f32`.
const UNIT: f64 = 1.0 / 16_777_216.0;

/// The accuracy of one form of a function over its domain.
#[derive(Debug, Clone, Default)]
pub struct Measured {
    /// Points without a finite result.
    pub not_finite: usize,
    /// Largest error, absolute, where the result is finite.
    pub error: f64,
    /// Largest error in units of what the inputs' rounding can change, plus half a unit in the last place.
    pub units: f64,
}

/// The accuracy of a function before and after.
#[derive(Debug, Clone)]
pub struct Certificate {
    /// The function.
    pub name: String,
    /// Points with a limit, at which both were measured.
    pub points: usize,
    /// Points without one, left out.
    pub left_out: usize,
    /// The original.
    pub before: Measured,
    /// The new form.
    pub after: Measured,
    /// Largest error that WGSL admits of the new form at these points, in the same units; without one, the reason.
    pub admitted: Result<f64, String>,
    /// The declared allowance, in the same units.
    pub claimed: Option<f64>,
}

impl Certificate {
    /// Returns whether the new form is as accurate as declared; without a claim, whether it is finite.
    pub fn is_met(&self) -> bool {
        self.after.not_finite == 0 && self.claimed.is_none_or(|claimed| self.after.units <= claimed)
    }
}

impl super::Stabilised {
    /// Measures every function of the new table against the old one.
    ///
    /// # Errors
    /// If a table cannot be lowered.
    pub fn certify(&self, old: &crate::table::Table) -> Result<Vec<Certificate>, Failure> {
        let source = crate::diag::Source::new(old.source.name.clone(), self.text.clone());
        let new = Program::check_all(&crate::table::Table::parse(source)?)?;
        let old = Program::check_all(old)?;
        Ok(old.iter().zip(&new).filter_map(|(old, new)| certificate(old, new)).collect())
    }
}

/// Points spread over the domain and around the singularities of a program.
fn points(program: &Program) -> Vec<Vec<Value>> {
    let inside = |input: usize, value: f64| match program.inputs[input].domain {
        Domain::Continuous { lo, hi, .. } => (lo..=hi).contains(&value),
        Domain::Discrete(_) | Domain::Word => false,
    };
    let mut all = domain_points(program, SPREAD);
    for singularity in singularities(program) {
        // The singular input is moved; which one of several does not matter.
        let fixed = singularity.fixed.map(|(input, _)| input.index());
        let Some(input) =
            fixed.or_else(|| program.pool.expr_facts(singularity.divisor).inputs.iter().next().map(|i| i.index()))
        else {
            all.push(singularity.point);
            continue;
        };
        let Value::Number(centre) = singularity.point[input] else { continue };
        for distance in DISTANCES.into_iter().flat_map(|d| [d, -d]) {
            let value = f64::from((centre + distance) as f32);
            if inside(input, value) {
                let mut point = singularity.point.clone();
                point[input] = Value::Number(value);
                all.push(point);
            }
        }
    }
    all.extend(thin(program));
    let assumed = |point: &Vec<Value>| {
        let given: Vec<Option<Value>> = point.iter().copied().map(Some).collect();
        let mut interpreter = Interpreter::<f64>::new(program);
        interpreter.place(&given).is_ok()
            && program.assumptions.iter().all(|a| interpreter.holds(a.condition).unwrap_or(false))
    };
    all.retain(assumed);
    all
}

/// Points at and around the least scale along one input; the inputs take turns.
fn thin(program: &Program) -> Vec<Vec<Value>> {
    let Some(accuracy) = program.function.as_ref().and_then(|function| function.accuracy.as_ref()) else {
        return Vec::new();
    };
    let inputs: Vec<usize> = program.pool.expr_facts(accuracy.scale).inputs.iter().map(|input| input.index()).collect();
    let mut interpreter = Interpreter::<f64>::new(program);
    let mut scale = |point: &[Value]| {
        let given: Vec<Option<Value>> = point.iter().copied().map(Some).collect();
        let found = interpreter.place(&given).ok().and_then(|()| interpreter.number(accuracy.scale).ok());
        found.map_or(f64::INFINITY, f64::abs)
    };
    let mut all = Vec::new();
    for (mut point, input) in domain_points(program, THIN).into_iter().zip(inputs.into_iter().cycle()) {
        let (Value::Number(mut centre), Domain::Continuous { lo, hi, .. }) =
            (point[input], &program.inputs[input].domain)
        else {
            continue;
        };
        let mut width = (hi - lo).min(8.0);
        for _ in 0..32 {
            let values = (-8..=8).map(|step| (centre + width * f64::from(step) / 8.0).clamp(*lo, *hi));
            let measured = values.map(|value| {
                point[input] = Value::Number(value);
                (scale(&point), value)
            });
            let Some((_, least)) = measured.min_by(|a, b| a.0.total_cmp(&b.0)) else { break };
            centre = least;
            width *= 0.4;
        }
        for distance in DISTANCES.into_iter().flat_map(|d| [d, -d]) {
            point[input] = Value::Number(f64::from((centre + distance).clamp(*lo, *hi) as f32).clamp(*lo, *hi));
            all.push(point.clone());
        }
    }
    all
}

fn certificate(old: &Program, new: &Program) -> Option<Certificate> {
    let mut judge = Precise::new(old)?;
    let (mut before, mut after) = (Measured::default(), Measured::default());
    let (mut count, mut left_out) = (0, 0);
    let mut intervals = IntervalInterpreter::new(new);
    let mut admitted = Ok(0.0_f64);
    for point in points(old) {
        let given: Vec<Option<Value>> = point.iter().copied().map(Some).collect();
        let Ok(exact) = judge.limit(&given) else {
            left_out += 1;
            continue;
        };
        count += 1;
        let allowed = allowed(old, new, &mut judge, &point, &exact);
        for (program, measured) in [(old, &mut before), (new, &mut after)] {
            let mut interpreter = Interpreter::<f32>::new(program);
            let Ok(outcome) = interpreter.evaluate(&given) else { continue };
            for ((got, exact), allowed) in outcome.values.iter().zip(&exact).zip(&allowed) {
                if got.is_finite() {
                    // The limit at a singular point is known no better than this.
                    let error = ((f64::from(*got) - exact).abs() - NOTHING).max(0.0);
                    measured.error = measured.error.max(error);
                    measured.units = measured.units.max(error / allowed);
                } else {
                    measured.not_finite += 1;
                }
            }
        }
        if let Ok(worst) = admitted {
            admitted = admissible(new, &mut intervals, &given, &exact, &allowed).map(|units| worst.max(units));
        }
    }
    let claimed = old.function.as_ref().and_then(|function| function.accuracy.as_ref()).map(|claim| claim.times);
    let name = old.function.as_ref().map_or_else(|| old.name.clone(), |function| function.name.clone());
    Some(Certificate { name, points: count, left_out, before, after, admitted, claimed })
}

/// The largest error that is admissible at a point; an error says why there is none.
fn admissible(
    new: &Program,
    intervals: &mut IntervalInterpreter<'_>,
    point: &[Option<Value>],
    exact: &[f64],
    allowed: &[f64],
) -> Result<f64, String> {
    let place = || {
        let values = new.inputs.iter().zip(point);
        let shown = values.filter_map(|(input, value)| Some(format!("{} = {}", input.name, input.show((*value)?))));
        shown.collect::<Vec<_>>().join(", ")
    };
    let found = intervals.admissible(point).map_err(|_| "an input is missing".to_owned())?;
    if found.everything {
        return Err(format!("too many choices are open at {}", place()));
    }
    let mut worst = 0.0_f64;
    for outcome in &found.outcomes {
        for ((value, exact), allowed) in outcome.values.iter().zip(exact).zip(allowed) {
            if value.is_any() {
                return Err(format!("WGSL promises nothing of an operation at {}", place()));
            }
            worst = worst.max((value.hi() - exact).max(exact - value.lo()) / allowed);
        }
    }
    Ok(worst)
}

/// The changes by half a unit in the last place of each input, summed, and half a unit of the scale: the
/// declared one, or else the value. The changes are those of the new form in `f64`, whose own error is 2^-29 of
/// what matters here.
fn allowed(old: &Program, new: &Program, judge: &mut Precise<'_>, point: &[Value], exact: &[f64]) -> Vec<f64> {
    let scale = old.function.as_ref().and_then(|function| function.accuracy.as_ref()).and_then(|accuracy| {
        let scale = judge.expression(accuracy.scale).ok()?;
        scale.is_finite().then_some(scale.abs())
    });
    let mut allowed: Vec<f64> = exact.iter().map(|exact| UNIT * scale.unwrap_or(exact.abs())).collect();
    let mut given: Vec<Option<Value>> = point.iter().copied().map(Some).collect();
    let mut interpreter = Interpreter::<f64>::new(new);
    let Ok(here) = interpreter.evaluate(&given) else { return allowed };
    for (input, value) in point.iter().enumerate() {
        let Value::Number(number) = *value else { continue };
        let half = 0.5 * (f64::from((number as f32).abs().next_up()) - f64::from((number as f32).abs()));
        given[input] = Some(Value::Number(number + half));
        if let Ok(moved) = interpreter.evaluate(&given) {
            for ((allowed, moved), here) in allowed.iter_mut().zip(&moved.values).zip(&here.values) {
                *allowed += (moved - here).abs();
            }
        }
        given[input] = Some(*value);
    }
    // A quantity that is zero everywhere may be off by the smallest normal number.
    allowed.iter_mut().for_each(|allowed| *allowed = allowed.max(f64::from(f32::MIN_POSITIVE)));
    allowed
}
