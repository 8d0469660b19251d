//! Why a case exists: which inputs reach it, and what lies around them.

use std::fmt::Write;

use super::reach::{self, Arrival, Reach};
use crate::eval::Interpreter;
use crate::plan::Weights;
use crate::program::{Domain, Program, Value};
use crate::show::{Precision, sentence};

/// Inputs that reach a case, and the cases that others reach instead.
#[derive(Debug, Clone)]
pub struct Why {
    /// The case, as an index into [`Program::rows`].
    pub row: usize,
    /// States, the smallest input, and the smallest for each line.
    pub reach: Reach,
    /// A typical input, and in what sense it is one.
    pub typical: Option<(Arrival, String)>,
    /// Earlier rows that take states in which the guard could hold, with their number.
    pub earlier: Vec<(usize, usize)>,
    /// The cases that the smallest input reaches with one level changed.
    pub neighbours: Vec<Neighbour>,
}

/// A point that differs from another in one level.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Neighbour {
    /// The change, such as `H=none`.
    pub change: String,
    /// The row taken there; `None` for the default.
    pub row: Option<usize>,
}

/// Finds out about a case, given as an index into [`Program::rows`]. With weights,
/// the typical input is in the most frequent of its states.
pub fn why(program: &Program, row: usize, weights: Option<&Weights>) -> Why {
    let reach = reach::reach(program, row);
    let frequent = weights.and_then(|weights| {
        let mut states = reach.states.clone();
        states.retain(|state| weights.of(*state) > 0.0);
        states.sort_by(|a, b| weights.of(*b).total_cmp(&weights.of(*a)));
        let found = states.iter().take(8).find_map(|state| reach::in_state(program, row, *state))?;
        Some((found, "in the most frequent of its states".to_owned()))
    });
    let typical = frequent.or_else(|| Some((reach::example(program, row)?, "its first example".to_owned())));
    let neighbours = reach.smallest.as_ref().map(|smallest| neighbours(program, smallest)).unwrap_or_default();
    Why { row, earlier: reach::earlier(program, row), typical, neighbours, reach }
}

/// Changes each level of a point in turn.
fn neighbours(program: &Program, arrival: &Arrival) -> Vec<Neighbour> {
    let mut interpreter = Interpreter::<f32>::new(program);
    let mut found = Vec::new();
    for (id, input) in program.input_ids() {
        let (Some(Value::Level(old)), Domain::Discrete(levels)) = (arrival.point[id.index()], &input.domain) else {
            continue;
        };
        for level in (0..levels.count()).map(|level| level as u8).filter(|level| *level != old) {
            let mut point = arrival.point.clone();
            point[id.index()] = Some(Value::Level(level));
            // Which row is taken may depend on something that is fetched; then nothing is said.
            let Some(row) = interpreter.place(&point).ok().and_then(|()| taken(&mut interpreter, program)) else {
                continue;
            };
            let change = format!("{}={}", input.name, levels.shown(level));
            found.push(Neighbour { change, row });
        }
    }
    found
}

/// The row taken where the interpreter stands, unless that needs a fetch.
fn taken(interpreter: &mut Interpreter<'_, f32>, program: &Program) -> Option<Option<usize>> {
    for (index, row) in program.rows.iter().enumerate() {
        if interpreter.holds(row.guard).ok()? {
            return Some(Some(index));
        }
    }
    Some(None)
}

/// A point as `--at` takes it: what differs from the defaults, and what is fetched.
pub fn at(program: &Program, arrival: &Arrival) -> String {
    let given = program.input_ids().filter_map(|(id, input)| {
        let value = arrival.point[id.index()]?;
        (input.default != Some(value)).then(|| format!("{}={}", input.name, input.show(value)))
    });
    given.collect::<Vec<_>>().join(",")
}

/// The answer as text. `shares` is how often the case is taken: over all, and by scene.
pub fn render(program: &Program, why: &Why, shares: Option<&[(String, f64)]>) -> String {
    let row = &program.rows[why.row];
    let doc = if row.doc.is_empty() { String::new() } else { format!(": {}", row.doc) };
    let section = if row.section.is_empty() { String::new() } else { format!(", section {}", row.section) };
    let mut out = format!("{}, case {}{doc}\n", program.name, row.id);
    line(&mut out, &format!("{}:{}{section}", program.source.name, program.line(row.span)));
    let states = program.states.count();
    let count = why.reach.states.len();
    let bound = if why.reach.exact { "" } else { "at most " };
    let _ = writeln!(out, "\nreached in {bound}{count} of {states} states");
    for (earlier, count) in &why.earlier {
        let earlier = &program.rows[*earlier];
        line(&mut out, &format!("case {} comes first in {count} more{}", earlier.id, colon(&earlier.doc)));
    }
    out.push_str("\nsmallest input\n");
    match &why.reach.smallest {
        Some(arrival) => point(&mut out, program, arrival),
        None => line(&mut out, "none found among the points that were tried"),
    }
    if let Some((arrival, sense)) = &why.typical {
        let _ = writeln!(out, "\ntypical input: {sense}");
        point(&mut out, program, arrival);
    }
    if why.reach.lines.len() > 1 {
        out.push_str("\nsmallest input for each line\n");
        for (number, arrival) in why.reach.lines.iter().enumerate() {
            match arrival {
                Some(arrival) => {
                    let value = sentence(&program.output, &arrival.values, Precision::F32);
                    line(&mut out, &format!("line {}: --at {}  gives {value}", number + 1, at(program, arrival)));
                }
                None => line(&mut out, &format!("line {}: none found among the points that were tried", number + 1)),
            }
        }
    }
    if !why.neighbours.is_empty() {
        out.push_str("\nthe smallest input with one level changed\n");
        let (same, others): (Vec<_>, Vec<_>) = why.neighbours.iter().partition(|n| n.row == Some(why.row));
        let width = others.iter().map(|n| n.change.len()).max().unwrap_or(0);
        for Neighbour { change, row } in others {
            let to = match row.map(|row| &program.rows[row]) {
                Some(row) => format!("case {}{}", row.id, colon(&row.doc)),
                None => "the default".to_owned(),
            };
            line(&mut out, &format!("{change:width$}  {to}"));
        }
        if !same.is_empty() {
            let same: Vec<&str> = same.iter().map(|n| n.change.as_str()).collect();
            line(&mut out, &format!("the same case: {}", same.join(", ")));
        }
    }
    if let Some(shares) = shares {
        out.push_str("\nfrequency\n");
        let width = shares.iter().map(|(scene, _)| scene.len()).max().unwrap_or(0);
        for (scene, share) in shares {
            line(&mut out, &format!("{scene:width$}  {:7.3} %", share * 100.0));
        }
    }
    out
}

fn point(out: &mut String, program: &Program, arrival: &Arrival) {
    let at = at(program, arrival);
    line(out, &if at.is_empty() { "everything at its default".to_owned() } else { format!("--at {at}") });
    let value = sentence(&program.output, &arrival.values, Precision::F32);
    let by =
        arrival.line.map_or("by the default, as no line applies".to_owned(), |line| format!("by line {}", line + 1));
    line(out, &format!("gives {value}, {by}"));
    if !arrival.assumed {
        line(out, "though an assumption of the table does not hold there");
    }
}

fn colon(doc: &str) -> String {
    if doc.is_empty() { String::new() } else { format!(": {doc}") }
}

fn line(out: &mut String, text: &str) {
    let _ = writeln!(out, "    {}", text.trim_end());
}
