//! U0516: jumps of the value where the table declares that there are none.
//!
//! At a border the two sides are different points, so the program is studied
//! once more with further inputs for what can be anything on the other side.
//! At a switch they are the same point, reached from both sides of a comparison.

use std::collections::BTreeMap;

use super::{Analysis, Run};
use crate::analyse::sets::Set;
use crate::analyse::sets::space::{Space, View};
use crate::analyse::sets::study::{Piece, Study};
use crate::analyse::values::point::{Point, Witness};
use crate::analyse::values::real::range;
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};
use crate::program::{Continuity, ContinuityKind, ExprId, InputId, InputSet, LevelSet, LevelTerm, Program, Symmetry};

/// The case and line on either side.
type Sides = [(Option<usize>, Option<usize>); 2];

/// The precision to which a jump is measured, in halvings of the output's range.
const HALVINGS: usize = 11;

/// A jump.
struct Jump {
    sides: Sides,
    set: Set,
    values: [Vec<ExprId>; 2],
}

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::JUMP, codes::NOT_ANALYSED], run: Run::Sets(findings) };

/// Looks at every declaration of continuity.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let mut found = Vec::new();
    // Each border is a study of its own, with its share of the work.
    let share = study.space.sets.budget().left() / program.continuity.len().max(1) as u64;
    for continuity in &program.continuity {
        match &continuity.kind {
            ContinuityKind::Border(..) => found.extend(border(program, continuity, share)),
            ContinuityKind::Switch(inputs) => {
                let jumps = switches(study, inputs);
                found.extend(report(study, continuity, jumps, &|space, set| {
                    let witness = space.witness(set)?;
                    Some((words::at(program, &witness, program.continuous())?, None))
                }));
            }
        }
    }
    found
}

/// Finds the places at a border where the value is not that of the image across it, in so many steps.
fn border(program: &Program, continuity: &Continuity, steps: u64) -> Vec<Diagnostic> {
    let ContinuityKind::Border(when, free) = &continuity.kind else { return Vec::new() };
    let Some((wide, other)) = doubled(program, free) else {
        return vec![left_out(continuity, "the table has too many inputs; list fewer under `free`")];
    };
    let mut study = Study::within(&wide, steps);
    let (mut levels, mut numbers) = (continuity.map.levels.clone(), continuity.map.numbers.clone());
    for (input, stand_in) in &other {
        match wide.levels(*input) {
            Some(_) => levels.push((*input, LevelTerm::Input(*stand_in))),
            None => numbers.push((*input, study.space.pool.input(*stand_in))),
        }
    }
    let view = study.space.view(&levels, &numbers, View::PLAIN);
    let (images, image_assumed) = study.seen(view);
    let when = study.space.condition(*when, View::PLAIN);
    let admitted = study.space.sets.and(study.assumed, image_assumed);
    let admitted = study.space.sets.and(admitted, when);
    let inside = study.inside(&continuity.map.numbers);
    let admitted = study.space.sets.and(admitted, inside);
    let mut jumps = Vec::new();
    for piece in study.pieces.clone() {
        let here = study.space.sets.and(piece.set, admitted);
        if study.space.is_void(here) {
            continue;
        }
        for image in &images {
            if study.space.is_too_large() {
                break;
            }
            let both = study.space.sets.and(here, image.set);
            jumps.extend(jump(&mut study, both, &piece, image));
        }
    }
    if study.space.is_too_large() {
        return vec![left_out(
            continuity,
            "its sides take more work than the limit; split the table, or list fewer under `free`",
        )];
    }
    // Inputs of the other side are told by comparing with this one.
    let map = Symmetry { levels, numbers, ..continuity.map.clone() };
    let tell = |space: &mut Space<'_>, set: Set| {
        let witness = space.witness(set)?;
        let here = Point::of(&wide, &witness);
        let there = here.image(&space.pool, &map);
        let known: Vec<bool> = wide
            .input_ids()
            .map(|(id, input)| input.fetched.is_none() || witness.levels[id.index()].is_some())
            .collect();
        let read: Vec<bool> = wide
            .input_ids()
            .map(|(id, input)| {
                let stand_in =
                    other.iter().find(|(own, _)| *own == id).is_some_and(|(_, s)| witness.levels[s.index()].is_some());
                let mapped = map.levels.iter().any(|(own, _)| *own == id) && !other.iter().any(|(own, _)| *own == id);
                input.fetched.is_none() || stand_in || mapped || known[id.index()]
            })
            .collect();
        let numbers = program.continuous();
        let shorten = |mut witness: Witness| {
            witness.levels.truncate(program.inputs.len());
            witness.numbers.truncate(program.inputs.len());
            witness
        };
        if !witness.certain {
            return None;
        }
        let here = words::at(program, &shorten(here.witness(&wide, &known)), numbers)?;
        let there = words::at(program, &shorten(there.witness(&wide, &read)), numbers)?;
        Some((here, Some(there)))
    };
    let found = report(&mut study, continuity, jumps, &tell);
    match study.space.is_too_large() {
        true => vec![left_out(
            continuity,
            "its jumps take more work than the limit; split the table, or list fewer under `free`",
        )],
        false => found,
    }
}

/// The note that a border was not looked at.
fn left_out(continuity: &Continuity, help: &str) -> Diagnostic {
    let message = format!("the border `{}` was not looked at", continuity.map.name);
    Diagnostic::note(codes::NOT_ANALYSED, message).at(continuity.map.span, "").help(help)
}

/// The program with one more input for each that is free on the other side.
fn doubled(program: &Program, free: &[InputId]) -> Option<(Program, Vec<(InputId, InputId)>)> {
    let mut wide = program.clone();
    let mut other = Vec::new();
    for input in free {
        if wide.inputs.len() >= InputSet::CAPACITY {
            return None;
        }
        let mut copy = wide.inputs[input.index()].clone();
        copy.name.push('\'');
        copy.fetched = Some(0.0);
        other.push((*input, InputId::new(wide.inputs.len())));
        wide.inputs.push(copy);
    }
    Some((wide, other))
}

/// Finds the places where comparisons of some inputs switch between different values.
fn switches(study: &mut Study<'_>, inputs: &[InputId]) -> Vec<Jump> {
    let mut jumps = Vec::new();
    let pieces = study.pieces.clone();
    for digit in study.space.switches(inputs) {
        // The line belongs to one side; from the other, look across it. Few pieces touch it at all.
        let sides = [(0, 2), (2, 1)].map(|(own, across)| {
            let assumed = study.assumed;
            (touching(study, digit, own, assumed), touching(study, digit, across, Set::ALL))
        });
        for (number, piece) in pieces.iter().enumerate() {
            for (here, there) in &sides {
                let Some((_, beside)) = here.iter().find(|(own, _)| *own == number) else { continue };
                for (other, across) in there {
                    if study.space.is_too_large() {
                        return jumps;
                    }
                    let both = study.space.sets.and(*beside, *across);
                    jumps.extend(jump(study, both, piece, &pieces[*other]));
                }
            }
        }
    }
    jumps
}

/// The pieces, by number, that come to a line from the side where a comparison has some outcome: each with the part
/// of it on the line itself.
fn touching(study: &mut Study<'_>, digit: usize, side: usize, within: Set) -> Vec<(usize, Set)> {
    let line = study.space.sets.atom(digit, LevelSet::one(1));
    let pieces: Vec<Set> = study.pieces.iter().map(|piece| piece.set).collect();
    let mut touching = Vec::new();
    for (number, piece) in pieces.into_iter().enumerate() {
        let piece = study.space.sets.and(piece, within);
        let beside = study.space.sets.fix(piece, digit, side);
        let beside = study.space.sets.and(beside, line);
        if !study.space.is_void(beside) {
            touching.push((number, beside));
        }
    }
    touching
}

fn jump(study: &mut Study<'_>, both: Set, here: &Piece, there: &Piece) -> Option<Jump> {
    if both.is_empty() {
        return None;
    }
    let different = study.space.different(&here.values, &there.values);
    let set = study.space.sets.and(both, different);
    if study.space.is_void(set) {
        return None;
    }
    let sides = [(here.row, here.line), (there.row, there.line)];
    Some(Jump { sides, set, values: [here.values.clone(), there.values.clone()] })
}

/// The largest jump of the value in a set, and the part of the set that has it.
fn size(study: &mut Study<'_>, jump: &Jump) -> (f64, Set) {
    let (mut best, mut place) = (0.0, jump.set);
    for (a, b) in jump.values[0].iter().zip(&jump.values[1]) {
        for (low, high) in [(*a, *b), (*b, *a)] {
            let budget = study.space.sets.budget();
            let ranges = [low, high].map(|value| range(study.program, &study.space.pool, value, 1e-2, budget));
            let most = ranges[1].1 - ranges[0].0;
            if !(most > 0.0 && most < 1e9) {
                continue;
            }
            // From a power of two halving is exact, and so is a size that is short in binary.
            let (mut from, mut to) = (0.0, libm::exp2(libm::ceil(libm::log2(most))));
            for _ in 0..HALVINGS {
                let middle: f64 = f64::midpoint(from, to);
                let far = study.space.exceeds(low, high, middle);
                let far = study.space.sets.and(far, jump.set);
                if study.space.is_void(far) {
                    to = middle;
                } else {
                    from = middle;
                    if middle > best {
                        (best, place) = (middle, far);
                    }
                }
            }
            // The last step was not exceeded and the one before was.
            if from > 0.0 && from >= best {
                best = to;
            }
        }
    }
    (best, place)
}

/// The cases on both sides of a jump, the smaller first; `None` is the default.
type Pair = (Option<usize>, Option<usize>);

/// The words for a place: inputs on this side, and on the other if they are not the same.
type Tell<'a> = &'a dyn Fn(&mut Space<'_>, Set) -> Option<(String, Option<String>)>;

/// One warning for each pair of cases between which the value jumps, the largest jump first.
fn report(study: &mut Study<'_>, continuity: &Continuity, jumps: Vec<Jump>, tell: Tell<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    let mut largest: BTreeMap<Pair, (f64, Set, Sides)> = BTreeMap::new();
    let mut all: BTreeMap<Pair, BTreeMap<Sides, f64>> = BTreeMap::new();
    for jump in &jumps {
        if study.space.is_too_large() {
            return Vec::new();
        }
        let (size, set) = size(study, jump);
        let (a, b) = (jump.sides[0].0, jump.sides[1].0);
        let of_lines = all.entry((a.min(b), a.max(b))).or_default().entry(jump.sides).or_insert(size);
        *of_lines = of_lines.max(size);
        let entry = largest.entry((a.min(b), a.max(b))).or_insert((size, set, jump.sides));
        if size > entry.0 {
            *entry = (size, set, jump.sides);
        }
    }
    let mut largest: Vec<_> = largest.into_iter().collect();
    largest.sort_by(|a, b| b.1.0.total_cmp(&a.1.0));
    let numbers = program.output.is_real();
    let describe = |((a, b), (size, set, sides)): (Pair, (f64, Set, Sides))| {
        let mut rows = vec![a, b];
        rows.dedup();
        let far = if numbers { format!(" by up to {}", words::short(size)) } else { String::new() };
        let between = match rows.len() {
            1 => format!("within {}", words::cases(program, &rows)),
            _ => format!("between {} and {}", words::cases(program, &[a]), words::cases(program, &[b])),
        };
        let message = format!("the value jumps{far} {between} across `{}`", continuity.map.name);
        let about = all[&(a, b)].iter().map(|([here, there], size)| {
            let (here, there) = (words::named(program, *here), words::named(program, *there));
            let far = if numbers { format!(" by {}", words::short(*size)) } else { String::new() };
            format!("{here} to {there}{far}")
        });
        let mut warning = Diagnostic::warning(codes::JUMP, message).about([continuity.map.name.clone()]).about(about);
        for (row, line) in sides {
            let span = match (row.map(|row| &program.rows[row]), line) {
                (Some(row), Some(line)) => row.lines[line].span,
                (Some(row), None) => row.span,
                (None, _) => continue,
            };
            if !warning.labels.iter().any(|label| label.span == span) {
                let side = if warning.labels.is_empty() { "on this side" } else { "on the other side" };
                warning = warning.at(span, side);
            }
        }
        warning = warning.at(continuity.map.span, "declared to be continuous");
        match tell(&mut study.space, set) {
            Some((here, Some(there))) => warning.help(format!("for instance {here}\n touches {there}")),
            Some((here, None)) => warning.help(format!("for instance at {here}")),
            None => warning,
        }
    };
    largest.into_iter().map(describe).collect()
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn jumps(low: &str, high: &str) -> Vec<String> {
        let found = found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"x": Range(from: 0, to: 1), "s": Bool()}},
                continuity: {{
                    "cut": Switch(of: ["x"]),
                    "wrap": Border(when: "x == 1", map: {{"x": "0"}}, free: ["s"]),
                }},
                output: Number(),
                cases: [Case(id: 1, when: "x < 0.5", value: "{low}"), Case(id: 2, when: "x >= 0.5", value: "{high}")],
                default: 0)"#
        ));
        found.into_iter().filter(|message| message.starts_with("U0516")).collect()
    }

    #[test]
    fn jumps_are_measured() {
        assert_eq!(jumps("x", "1 - x"), [""; 0]);
        assert_eq!(
            jumps("x", "1.25 - x"),
            [
                "U0516 the value jumps by up to 0.25 between case 1 and case 2 across `cut`",
                "U0516 the value jumps by up to 0.25 between case 1 and case 2 across `wrap`"
            ]
        );
        let border = jumps("if s { x } else { 0.75 * x + 0.125 }", "1 - x");
        assert_eq!(border, ["U0516 the value jumps by up to 0.125 between case 1 and case 2 across `wrap`"]);
    }
}
