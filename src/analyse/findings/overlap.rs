//! U0502, U0509: cases that hold together.
//!
//! Two guards may hold together as long as both cases give the same value. With
//! hit policy `First` overlaps are how a table is written: that their order
//! matters is a note, with the conditions that would make it not matter. With
//! `Unique` it is an error.

use super::{Analysis, Run};
use crate::analyse::sets::Set;
use crate::analyse::sets::space::Space;
use crate::analyse::sets::study::Study;
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};
use crate::program::{InputSet, LevelSet, Program, Row};
use crate::table::HitPolicy;

/// Two cases whose guards can hold together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Overlap {
    /// The earlier case, as an index into [`Program::rows`].
    pub first: usize,
    /// The later case.
    pub second: usize,
    /// States in which both guards can hold, and the values are then equal.
    pub states_equal: usize,
    /// States in which both guards can hold with different values.
    pub states_different: usize,
    /// Of both, the states in which the earlier case is the first of all whose
    /// guard can hold: where it is order that decides between these two.
    pub states_first: (usize, usize),
    /// True if some inputs are known to give different values. Otherwise this
    /// depends on comparisons that are not linear, and is not decided here.
    pub certain: bool,
    /// One such input, in the form that `explain --at` takes, with different
    /// values if there is any; `None` if none was found.
    pub example_state: Option<String>,
}

/// Every pair of cases whose guards can hold together, in the order of rows.
///
/// Values are compared over the reals, for all fetched and continuous inputs.
pub fn overlaps(program: &Program) -> Vec<Overlap> {
    let mut study = Study::new(program);
    let mut found = Vec::new();
    let mut earlier = Set::EMPTY;
    for first in 0..program.rows.len() {
        for second in study.later(first) {
            found.extend(overlap(&mut study, first, second, earlier));
        }
        let guard = study.space.states(study.rows.guards[first]);
        earlier = study.space.sets.or(earlier, guard);
    }
    found
}

/// The overlap of two cases, if there is any; `earlier` are the states that cases before both can claim.
fn overlap(study: &mut Study<'_>, first: usize, second: usize, earlier: Set) -> Option<Overlap> {
    let guards = &study.rows.guards;
    if !study.space.sets.meets(guards[first], guards[second]) {
        return None;
    }
    let both = study.space.sets.and(guards[first], guards[second]);
    if study.space.is_void(both) {
        return None;
    }
    let different = different(study, first, second, Set::ALL);
    let (all, differ) = (study.space.states(both), study.space.states(different));
    let equal = study.space.sets.minus(all, differ);
    let [equal_first, differ_first] = [equal, differ].map(|states| study.space.sets.minus(states, earlier));
    let witness = study.space.witness(if differ.is_empty() { both } else { different })?;
    let relevant = relevant(study, first, second);
    Some(Overlap {
        first,
        second,
        states_equal: study.space.count(equal),
        states_different: study.space.count(differ),
        states_first: (study.space.count(equal_first), study.space.count(differ_first)),
        certain: witness.certain && !differ.is_empty(),
        example_state: words::at(study.program, &witness, relevant),
    })
}

fn relevant(study: &Study<'_>, first: usize, second: usize) -> InputSet {
    words::mentioned(study.program, first).or(words::mentioned(study.program, second))
}

/// Returns whether both cases can hold, within a set, with different values.
fn differ(study: &mut Study<'_>, first: usize, second: usize, within: Set) -> bool {
    if let ([a], [b]) = (study.rows.own[first].as_slice(), study.rows.own[second].as_slice()) {
        // One value each: mostly they are the same everywhere or nowhere.
        match study.space.different(&a.values, &b.values) {
            Set::EMPTY => return false,
            Set::ALL if within == Set::ALL => return study.space.can_meet(a.set, b.set),
            _ => {}
        }
    }
    let different = different(study, first, second, within);
    !study.space.is_void(different)
}

/// The part of a set in which both cases hold with different values.
fn different(study: &mut Study<'_>, first: usize, second: usize, within: Set) -> Set {
    let mut result = Set::EMPTY;
    for a in &study.rows.own[first] {
        let here = study.space.sets.and(a.set, within);
        for b in &study.rows.own[second] {
            if !study.space.sets.meets(here, b.set) {
                continue;
            }
            let both = study.space.sets.and(here, b.set);
            let different = study.space.different(&a.values, &b.values);
            let different = study.space.sets.and(both, different);
            result = study.space.sets.or(result, different);
        }
    }
    result
}

/// Most pairs of overlapping cases for which disjoint guards are looked for.
const MAX_PAIRS: usize = 2000;

/// The codes that are found here, and how.
pub(in crate::analyse) const ANALYSIS: Analysis =
    Analysis { codes: &[codes::NOT_UNIQUE, codes::ORDER_MATTERS], run: Run::Sets(findings) };

/// For hit policy `Unique`, every pair with different values; else a note for
/// each case that comes before others with different values.
fn findings(study: &mut Study<'_>) -> Vec<Diagnostic> {
    let program = study.program;
    // Cases that all count are meant to hold together.
    if program.hit_policy == HitPolicy::Collect {
        return Vec::new();
    }
    let unique = program.hit_policy == HitPolicy::Unique;
    let within = if unique { Set::ALL } else { study.assumed };
    let mut conflicts: Vec<(usize, Vec<usize>)> = Vec::new();
    for first in 0..program.rows.len() {
        let later: Vec<usize> =
            study.later(first).into_iter().filter(|second| differ(study, first, *second, within)).collect();
        if !later.is_empty() {
            conflicts.push((first, later));
        }
    }
    let images = images_that_differ(program, &mut conflicts);
    let mut found: Vec<Diagnostic> =
        images.into_iter().filter_map(|(first, second)| contradiction(study, first, second)).collect();
    if unique {
        let pairs = conflicts.iter().flat_map(|(first, later)| later.iter().map(|second| (*first, *second)));
        found.extend(pairs.filter_map(|(first, second)| contradiction(study, first, second)));
        return found;
    }
    let suggest = conflicts.iter().map(|(_, later)| later.len()).sum::<usize>() <= MAX_PAIRS;
    found.extend(conflicts.iter().map(|(first, later)| order_matters(study, *first, later, suggest)));
    found
}

/// Takes the pairs of images of one case out of what conflicts, and returns one pair of each such case.
/// The images are written once, so none of them comes first on purpose.
fn images_that_differ(program: &Program, conflicts: &mut Vec<(usize, Vec<usize>)>) -> Vec<(usize, usize)> {
    let mut images: Vec<(usize, usize)> = Vec::new();
    for (first, later) in conflicts.iter_mut() {
        let id = program.rows[*first].id;
        if images.iter().all(|(other, _)| program.rows[*other].id != id) {
            images.extend(later.iter().find(|second| program.rows[**second].id == id).map(|second| (*first, *second)));
        }
        later.retain(|second| program.rows[*second].id != id);
    }
    conflicts.retain(|(_, later)| !later.is_empty());
    images
}

fn order_matters(study: &mut Study<'_>, first: usize, later: &[usize], suggest: bool) -> Diagnostic {
    let program = study.program;
    let case = &program.rows[first];
    let all: Vec<Option<usize>> = later.iter().copied().map(Some).collect();
    let message =
        format!("case {} must come before {}: they hold together and differ", case.id, words::cases(program, &all));
    let mut note = Diagnostic::note(codes::ORDER_MATTERS, message).at(case.guard_span, "");
    for second in later.iter().take(3) {
        note = note.at(program.rows[*second].guard_span, "");
    }
    let different = different(study, first, later[0], study.assumed);
    let relevant = relevant(study, first, later[0]);
    if let Some(place) = study.space.witness(different).and_then(|found| words::at(program, &found, relevant)) {
        note = note.help(format!("cases {} and {} hold at {place}", case.id, program.rows[later[0]].id));
    }
    let ids = later.iter().map(|second| program.rows[*second].id);
    if !suggest {
        return note.about(ids.map(|id| format!("case {id}")));
    }
    let mut extra = Vec::new();
    let mut about = Vec::new();
    for (second, id) in later.iter().zip(ids) {
        match disjoint(study, *second) {
            Some(condition) => {
                extra.push(format!("{id}: `{condition}`"));
                about.push(format!("case {id} but for {condition}"));
            }
            None => about.push(format!("case {id}")),
        }
    }
    let note = note.about(about);
    match extra.is_empty() {
        true => note,
        false => note.help(format!("the order would not matter with these further conditions: {}", extra.join(", "))),
    }
}

/// Conditions on single inputs that, added to the guard of a case, exclude all
/// earlier cases and leave it where it is taken, as far as the assumptions hold.
fn disjoint(study: &mut Study<'_>, row: usize) -> Option<String> {
    let guard = study.space.sets.and(study.rows.guards[row], study.assumed);
    let guard = study.space.prune(guard);
    let taken = study.space.sets.and(guard, study.rows.taken[row]);
    let taken = study.space.prune(taken);
    if taken.is_empty() {
        return None;
    }
    let mut masked = study.space.sets.minus(guard, study.rows.taken[row]);
    let mut chosen: Vec<(usize, LevelSet)> = Vec::new();
    while !study.space.is_void(masked) {
        let mut best: Option<(f64, usize, LevelSet, Set)> = None;
        for digit in 0..study.space.state_digits() {
            let (mut kept, mut lost) = (0_u64, 0_u64);
            for level in 0..study.space.sets.levels(digit) as u8 {
                let atom = study.space.sets.atom(digit, LevelSet::one(level));
                if study.space.can_meet(taken, atom) {
                    kept |= 1 << level;
                }
                if study.space.can_meet(masked, atom) {
                    lost |= 1 << level;
                }
            }
            let excluded = lost & !kept;
            if excluded == 0 {
                continue;
            }
            // Levels that the guard never meets anyway may be in or out, whichever is shorter to say.
            let allowed = LevelSet(LevelSet::all(study.space.sets.levels(digit)).0 & !excluded);
            let length = |space: &mut Space<'_>, levels| words::condition(space, &[(digit, levels)]).len();
            let shorter = length(&mut study.space, LevelSet(kept)) < length(&mut study.space, allowed);
            let allowed = if shorter { LevelSet(kept) } else { allowed };
            let atom = study.space.sets.atom(digit, allowed);
            let rest = study.space.sets.and(masked, atom);
            let left = study.space.count(rest) as f64;
            if best.as_ref().is_none_or(|(least, ..)| left < *least) {
                best = Some((left, digit, allowed, rest));
            }
        }
        let (_, digit, allowed, rest) = best?;
        chosen.push((digit, allowed));
        masked = rest;
    }
    (!chosen.is_empty()).then(|| words::condition(&mut study.space, &chosen))
}

fn contradiction(study: &mut Study<'_>, first: usize, second: usize) -> Option<Diagnostic> {
    let overlap = overlap(study, first, second, Set::EMPTY)?;
    let program = study.program;
    let (first, second) = (&program.rows[first], &program.rows[second]);
    let what = if overlap.certain { "both hold" } else { "may both hold" };
    let images = first.id == second.id;
    let message = match images {
        true => format!("two images of case {} {what}, with different values", first.id),
        false => format!("cases {} and {} {what}, with different values", first.id, second.id),
    };
    let diagnostic = match overlap.certain {
        true => Diagnostic::error(codes::NOT_UNIQUE, message),
        // What is not linear cannot be decided here, and no table is refused for that.
        false => Diagnostic::warning(codes::NOT_UNIQUE, message),
    };
    let states = match overlap.example_state {
        Some(place) => format!("in {}, such as at {place}", words::states(overlap.states_different)),
        None => format!("in {}", words::states(overlap.states_different)),
    };
    if images {
        let named = |row: &Row| match row.under.is_empty() {
            true => "as it is written".to_owned(),
            false => format!("under {}", row.under.join(", then ")),
        };
        return Some(
            diagnostic
                .at(first.guard_span, "the guard of this case")
                .help(format!("one is the case {}, the other {}", named(first), named(second)))
                .help(states)
                .help("where images meet they must agree; `same` in the output says which lists mean the same"),
        );
    }
    let finding = diagnostic
        .at(second.guard_span, format!("the guard of case {}", second.id))
        .at(first.guard_span, format!("the guard of case {}", first.id))
        .at(program.hit_policy_span, "but at most one case may decide")
        .help(states)
        .about([format!("case {}", first.id), words::states(overlap.states_different)])
        .help("make the guards exclude each other, or say `hit_policy: First`");
    Some(finding)
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    /// The findings about two cases that hold together.
    fn unique(first: &str, second: &str) -> Vec<String> {
        let found = found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: Unique,
                inputs: {{"s": Bool(), "x": Range(from: 0, to: 1), "f": Bool(fetched: (cost: 1))}},
                output: Number(),
                cases: [Case(id: 1, when: {first}), Case(id: 2, when: {second})],
                default: "if s && f {{ x }} else {{ 0 }}")"#
        ));
        found.into_iter().filter(|message| message.starts_with("U0502")).collect()
    }

    #[test]
    fn contradictions_are_errors() {
        let different = ["U0502 cases 1 and 2 both hold, with different values"];
        assert_eq!(unique(r#""s", value: "x""#, r#""x > 0.5 && f", value: "2 * x""#), different);
        assert_eq!(unique(r#""x < 0.75", value: "x""#, r#""x > 0.5", value: 1"#), different);
    }

    #[test]
    fn guards_that_exclude_each_other_and_equal_values_are_not() {
        let fine = |first, second| assert_eq!(unique(first, second), [""; 0]);
        fine(r#""x < 0.5", value: 1"#, r#""x >= 0.5", value: 2"#);
        fine(r#""x < 0.5", value: 1"#, r#""2 * x - 1 > 0.25", value: 2"#);
        fine(r#""s", value: "2 * x - x""#, r#""s && f", value: "max(x, 0)""#);
        fine(r#""x <= 0.5 && f", value: "x""#, r#""x >= 0.5", value: "0.5""#);
    }

    #[test]
    fn what_is_not_linear_is_a_warning() {
        let maybe = unique(r#""x * x < 0.25", value: 1"#, r#""x > 0.75", value: 2"#);
        assert_eq!(maybe, ["U0502 cases 1 and 2 may both hold, with different values"]);
    }
}
