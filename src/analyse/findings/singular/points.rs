//! Points of the domain at which things are tried out: the same in every run.

use super::trace::Trace;
use crate::program::{Domain, Program, Value};

/// Points inside that a search starts from.
pub(super) const BASES: usize = 24;

/// Most corners of the domain that are looked at.
const CORNERS: usize = 256;

/// Beyond this a range is sampled by magnitude.
const MODEST: f64 = 8.0;

/// Points that are drawn for each one that is wanted: conditions on a domain may leave few of them.
const DRAWS: usize = 200;

/// Points inside the domain, spread evenly, at which the declared conditions hold; wide ranges are sampled
/// where people work, near zero.
pub fn inside(program: &Program, count: usize) -> Vec<Vec<Value>> {
    drawn(program, count * DRAWS).filter(|point| holds(program, point)).take(count).collect()
}

/// Returns whether the declared conditions hold at a point.
pub(super) fn holds(program: &Program, point: &[Value]) -> bool {
    program.assumptions.iter().all(|assumption| Trace::<f64>::condition(program, point, assumption.condition))
}

/// Points of the ranges of all inputs, whatever else is declared of them.
pub(super) fn drawn(program: &Program, count: usize) -> impl Iterator<Item = Vec<Value>> + '_ {
    (0..count).map(|i| {
        let values = program.inputs.iter().enumerate().map(|(place, input)| {
            // Multiples of an irrational number, another one for each input, fill the unit interval evenly.
            let irrational = 0.618_033_988_75 + 0.414_213_562_37 * place as f64;
            let part = (irrational * (i + 1) as f64 + 0.31 * place as f64).fract();
            match &input.domain {
                Domain::Discrete(levels) => Value::Level((part * levels.count() as f64) as u8),
                // By size: small words are as usual as large ones.
                Domain::Word => {
                    let (lo, hi) = input.domain.span();
                    Value::Number(input.domain.point(if i % 2 == 0 {
                        lo + (hi - lo) * part
                    } else {
                        by_size(lo, hi, part)
                    }))
                }
                Domain::Continuous { lo, hi, .. } if i % 4 == 3 => Value::Number(by_size(*lo, *hi, part)),
                Domain::Continuous { lo, hi, .. } => Value::Number(number(*lo, *hi, part)),
            }
        });
        values.collect()
    })
}

fn number(lo: f64, hi: f64, part: f64) -> f64 {
    let (inner_lo, inner_hi) = (lo.max(-MODEST), hi.min(MODEST));
    let (from, to) = if inner_lo < inner_hi { (inner_lo, inner_hi) } else { (lo, hi) };
    // Rounded as an input is, and never outside.
    f64::from((from + (to - from) * part) as f32).clamp(lo, hi)
}

/// As many in each decade of a wide range.
fn by_size(lo: f64, hi: f64, part: f64) -> f64 {
    let largest = lo.abs().max(hi.abs());
    if largest <= MODEST || lo.max(-MODEST) >= hi.min(MODEST) {
        return number(lo, hi, part);
    }
    // The parts below and above one half have opposite signs where the range has both.
    let (sign, part) = match lo < 0.0 && hi > 0.0 {
        true => (if part < 0.5 { -1.0 } else { 1.0 }, (2.0 * part).fract()),
        false => (if hi > 0.0 { 1.0 } else { -1.0 }, part),
    };
    let size = libm::exp(libm::log(1e-3) + (libm::log(largest) - libm::log(1e-3)) * part);
    f64::from((sign * size) as f32).clamp(lo, hi)
}

/// Combinations of the ends of all ranges and their middles.
pub(super) fn corners(program: &Program) -> Vec<Vec<Value>> {
    let choices: Vec<Vec<Value>> = program
        .inputs
        .iter()
        .map(|input| match &input.domain {
            Domain::Discrete(levels) => (0..levels.count() as u8).map(Value::Level).collect(),
            Domain::Word => [0.0, f64::from(u32::MAX), f64::from(1_u32 << 31)].map(Value::Number).to_vec(),
            Domain::Continuous { lo, hi, .. } => [*lo, *hi, 0.5 * (lo + hi)]
                .into_iter()
                .map(|v| Value::Number(f64::from(v as f32).clamp(*lo, *hi)))
                .collect(),
        })
        .collect();
    let total: f64 = choices.iter().map(|c| c.len() as f64).product();
    // With too many of them, as many as allowed, evenly spread over their numbers.
    let step = (total / CORNERS as f64).max(1.0);
    let count = total.min(CORNERS as f64) as usize;
    (0..count)
        .map(|i| {
            let mut rest = (i as f64 * step) as u64;
            let pick = |c: &Vec<Value>| {
                let value = c[(rest % c.len() as u64) as usize];
                rest /= c.len() as u64;
                value
            };
            choices.iter().map(pick).collect()
        })
        .filter(|point: &Vec<Value>| holds(program, point))
        .collect()
}
