//! Points at which a program is looked at, and what all interpreters say there.

use umbrage::eval::{Batch, Columns, Interpreter, IntervalInterpreter, Outcome, Precise};
use umbrage::explain::explain;
use umbrage::points::Point;
use umbrage::points::comparison::{Effort, Points};
use umbrage::points::random::Random;
use umbrage::program::{Domain, InputId, Program, Real, Value};
use umbrage::show::Precision;

use super::Court;

/// Most points of a program, and states that they are in.
const POINTS: usize = 96;
const STATES: usize = 8;
/// Points that are looked at in hundreds of bits.
const PRECISE: usize = 12;

/// A point and what the reference says of it.
pub(crate) struct Known {
    pub(crate) point: Point,
    pub(crate) narrow: Outcome<f32>,
    pub(crate) wide: Outcome<f64>,
    /// The case and line over the reals, where that was looked at.
    pub(crate) real: Option<(Option<usize>, Option<usize>)>,
    /// True if all assumptions hold there, by the interpreter in `f64`.
    pub(crate) assumed: bool,
}

/// Points of a program: random ones, and those beside the lines of its comparisons.
pub(crate) fn choose(program: &Program, random: &mut Random) -> Vec<Point> {
    let effort = Effort { grid: 2, random: 2, lines: 1 };
    let mut source = Points::new(program, effort);
    let mut all = Vec::new();
    let states = program.states.count();
    for number in 0..states.min(STATES) {
        let state = if states <= STATES { number } else { random.below(states) };
        let mut found = source.of_state(state);
        for place in (1..found.len()).rev() {
            found.swap(place, random.below(place + 1));
        }
        found.truncate(POINTS / states.min(STATES));
        all.extend(found);
    }
    for _ in 0..8 {
        all.push(program.inputs.iter().map(|input| Some(anywhere(&input.domain, random))).collect());
    }
    all
}

fn anywhere(domain: &Domain, random: &mut Random) -> Value {
    match domain {
        Domain::Discrete(levels) => Value::Level(random.below(levels.count()) as u8),
        Domain::Word => Value::Number((f64::from(u32::MAX >> random.below(32)) * random.unit()).floor()),
        Domain::Continuous { lo, hi, .. } => {
            let share = if random.below(2) == 0 { random.unit() } else { random.below(9) as f64 / 8.0 };
            // As every executor gets it, and inside of the range all the same.
            let value = f64::from((lo + (hi - lo) * share) as f32);
            Value::Number(if (*lo..=*hi).contains(&value) { value } else { f64::from((lo + (hi - lo) * 0.5) as f32) })
        }
    }
}

/// A number as a string of bits; all NaN are one.
pub(crate) fn bits(value: f32) -> u32 {
    if value.is_nan() { f32::NAN.to_bits() } else { value.to_bits() }
}

fn same<T: Real>(a: &Outcome<T>, b: &Outcome<T>) -> bool {
    let bits = |value: &T| if value.to_f64().is_nan() { u64::MAX } else { value.to_f64().to_bits() };
    (a.row, a.line, a.fetched) == (b.row, b.line, b.fetched) && a.values.iter().map(bits).eq(b.values.iter().map(bits))
}

/// A point in the words of `explain --at`.
pub(crate) fn words(program: &Program, point: &Point) -> String {
    let values = program.inputs.iter().zip(point);
    let shown = values.filter_map(|(input, value)| Some(format!("{}={}", input.name, input.show((*value)?))));
    shown.collect::<Vec<_>>().join(",")
}

/// Evaluates a program at points by the reference, and by everything else that must say the same.
pub(crate) fn evaluate(court: &mut Court<'_>, program: &Program, points: Vec<Point>) -> Vec<Known> {
    court.count("points", points.len());
    let (mut narrow, mut wide) = (Interpreter::<f32>::new(program), Interpreter::<f64>::new(program));
    let mut known: Vec<Known> = Vec::new();
    for point in points {
        let (one, two) = match (narrow.evaluate(&point), wide.evaluate(&point)) {
            (Ok(one), Ok(two)) => (one, two),
            (one, two) => {
                court.fault(
                    "reference: a point that gives every input lacks one",
                    format!("{one:?} {two:?} {}", words(program, &point)),
                );
                continue;
            }
        };
        // An assumption is about the inputs as real numbers.
        let assumed = wide.place(&point).is_ok()
            && program.assumptions.iter().all(|assumption| wide.holds(assumption.condition) == Ok(true));
        known.push(Known { point, narrow: one, wide: two, real: None, assumed });
    }
    court.part("interpreters: batch", |court| batch(court, program, &known));
    court.part("interpreters: explain", |court| explained(court, program, &known));
    court.part("interpreters: intervals", |court| intervals(court, program, &known));
    court.part("interpreters: precise", |court| precise(court, program, &mut known));
    known
}

fn batch(court: &mut Court<'_>, program: &Program, known: &[Known]) {
    one_batch::<f32>(court, program, known, |known| &known.narrow);
    one_batch::<f64>(court, program, known, |known| &known.wide);
}

/// With every input, and with those only that are needed.
fn one_batch<T: Real>(court: &mut Court<'_>, program: &Program, known: &[Known], want: impl Fn(&Known) -> &Outcome<T>) {
    let least = |known: &Known| -> Point {
        let fetched = want(known).fetched;
        let kept = program
            .input_ids()
            .map(|(id, input)| known.point[id.index()].filter(|_| input.fetched.is_none() || fetched.contains(id)));
        kept.collect()
    };
    for lazy in [false, true] {
        let points = known.iter().map(|known| if lazy { least(known) } else { known.point.clone() });
        let columns = match Columns::<T>::from_rows(program, points) {
            Ok(columns) => columns,
            Err(error) => return court.fault("batch: points do not fit", error.to_string()),
        };
        let results = match Batch::<T>::new(program).evaluate(&columns) {
            Ok(results) => results,
            Err(missing) => return court.fault("batch: an input is missed that is not needed", format!("{missing:?}")),
        };
        let differs = (0..known.len()).find(|row| !same(&results.outcome(*row), want(&known[*row])));
        if let Some(row) = differs {
            let (want, got) = (want(&known[row]), results.outcome(row));
            court.fault(
                "batch: differs from the reference",
                format!("{want:?}, not {got:?}, at {}", words(program, &known[row].point)),
            );
        }
    }
}

fn explained(court: &mut Court<'_>, program: &Program, known: &[Known]) {
    for known in known.iter().take(24) {
        let want = &known.narrow;
        match explain(program, &known.point, Precision::F32) {
            Ok(got) => {
                let values =
                    got.values.iter().map(|value| bits(*value as f32)).eq(want.values.iter().map(|value| bits(*value)));
                let agrees = values && (got.row, got.line, got.fetched) == (want.row, want.line, want.fetched);
                court.expect(agrees, "explain: differs from the reference", || {
                    format!("{want:?}, not {got:?}, at {}", words(program, &known.point))
                });
            }
            Err(needed) => court.fault("explain: lacks an input", format!("{needed:?}")),
        }
    }
}

/// The intervals contain what f32 and f64 say.
fn intervals(court: &mut Court<'_>, program: &Program, known: &[Known]) {
    let mut interpreter = IntervalInterpreter::new(program);
    for known in known.iter().take(48) {
        let all = match interpreter.admissible(&known.point) {
            Ok(all) => all,
            Err(needed) => {
                court.fault("intervals: lack an input", format!("{needed:?}"));
                continue;
            }
        };
        let narrow: Vec<f32> = known.wide.values.iter().map(|value| *value as f32).collect();
        for (name, row, values) in [("f32", known.narrow.row, &known.narrow.values), ("f64", known.wide.row, &narrow)] {
            court.expect(all.contains(row, values), &format!("intervals: do not contain the value in {name}"), || {
                format!("{row:?} {values:?} not in {all:?}, at {}", words(program, &known.point))
            });
        }
    }
}

/// The intervals contain what hundreds of bits say.
fn precise(court: &mut Court<'_>, program: &Program, known: &mut [Known]) {
    let Some(mut precise) = Precise::new(program) else { return };
    let mut intervals = IntervalInterpreter::new(program);
    for known in known.iter_mut().take(PRECISE) {
        let (Ok(way), Ok(values)) = (precise.way(&known.point), precise.value(&known.point)) else {
            court.fault("precise: lacks an input", words(program, &known.point));
            continue;
        };
        known.real = Some(way);
        let values: Vec<f32> = values.iter().map(|value| *value as f32).collect();
        let Ok(all) = intervals.admissible(&known.point) else { continue };
        court.expect(all.contains(way.0, &values), "intervals: do not contain the precise value", || {
            format!("{way:?} {values:?} not in {all:?}, at {}", words(program, &known.point))
        });
    }
}

/// The value of an input that a text gives, as `explain --at` reads it.
pub(crate) fn read(program: &Program, text: &str) -> Result<Point, String> {
    let mut point: Point = program.inputs.iter().map(|input| input.default).collect();
    if text.trim() == "the defaults of all inputs" {
        return Ok(point);
    }
    for part in umbrage::points::parts(text) {
        let (name, value) = part.trim().split_once('=').ok_or_else(|| format!("`{part}` is no input with a value"))?;
        let input: InputId = program.input(name).ok_or_else(|| format!("there is no input `{name}`"))?;
        point[input.index()] = Some(program.inputs[input.index()].parse(value)?);
    }
    Ok(point)
}
