//! Points of the domain at which things are tried out: the same in every run.

use crate::program::{Domain, Program, Value};

/// Points inside that a search starts from.
pub(super) const BASES: usize = 24;

/// Most corners of the domain that are looked at.
const CORNERS: usize = 256;

/// Beyond this a range is sampled by magnitude.
const MODEST: f64 = 8.0;

/// Points inside the domain, spread evenly; wide ranges are sampled where people work, near zero.
pub fn inside(program: &Program, count: usize) -> Vec<Vec<Value>> {
    (0..count)
        .map(|i| {
            let values = program.inputs.iter().enumerate().map(|(place, input)| {
                // Multiples of an irrational number, another one for each input, fill the unit interval evenly.
                let irrational = 0.618_033_988_75 + 0.414_213_562_37 * place as f64;
                let part = (irrational * (i + 1) as f64 + 0.31 * place as f64).fract();
                match &input.domain {
                    Domain::Discrete(levels) => Value::Level((part * levels.count() as f64) as u8),
                    Domain::Continuous { lo, hi, .. } => Value::Number(number(*lo, *hi, part)),
                }
            });
            values.collect()
        })
        .collect()
}

fn number(lo: f64, hi: f64, part: f64) -> f64 {
    let (inner_lo, inner_hi) = (lo.max(-MODEST), hi.min(MODEST));
    let (from, to) = if inner_lo < inner_hi { (inner_lo, inner_hi) } else { (lo, hi) };
    // Rounded as an input is, and never outside.
    f64::from((from + (to - from) * part) as f32).clamp(lo, hi)
}

/// Combinations of the ends of all ranges and their middles.
pub(super) fn corners(program: &Program) -> Vec<Vec<Value>> {
    let choices: Vec<Vec<Value>> = program
        .inputs
        .iter()
        .map(|input| match &input.domain {
            Domain::Discrete(levels) => (0..levels.count() as u8).map(Value::Level).collect(),
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
        .collect()
}
