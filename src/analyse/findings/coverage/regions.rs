//! Numbers that no case claims although its state is claimed, and rows that would claim something.

use std::collections::HashSet;

use crate::analyse::findings::{Analysis, Run};
use crate::analyse::sets::Set;
use crate::analyse::sets::space::{Space, View};
use crate::analyse::sets::study;
use crate::analyse::values::point::Point;
use crate::analyse::words;
use crate::diag::{Diagnostic, codes};
use crate::program::{InputSet, LevelSet, Program};
use crate::table::HitPolicy;

/// Most conditions that a set is described by.
pub(super) const MOST: usize = 5;

/// Longest condition of which parts are left out.
const MOST_PARTS: usize = 64;

/// The same of functions with cases. Their values are looked at elsewhere; here only the guards are.
pub(in crate::analyse) const IN_FUNCTIONS: Analysis =
    Analysis { codes: &[codes::UNCOVERED], run: Run::Program(in_functions) };

fn in_functions(program: &Program) -> Vec<Diagnostic> {
    let decided = |guard| program.pool.truth(guard).is_some();
    if program.function.is_none() || program.rows.iter().all(|row| decided(row.guard)) {
        return Vec::new();
    }
    let mut space = Space::new(program);
    let mut unclaimed = Set::ALL;
    for row in &program.rows {
        let guard = space.condition(row.guard, View::PLAIN);
        unclaimed = space.sets.minus(unclaimed, guard);
    }
    let assumed = study::assumed(&mut space, View::PLAIN);
    let found = finding(&mut space, unclaimed, assumed);
    if space.is_too_large() { Vec::new() } else { found.into_iter().collect() }
}

/// The note on numbers that no case claims, beside others of the same state that some case does.
pub(super) fn finding(space: &mut Space<'_>, unclaimed: Set, assumed: Set) -> Option<Diagnostic> {
    let program = space.program;
    // With all levels known, also those that are fetched: something is left there, and something is not.
    let (left, claimed) = (space.prune(unclaimed), space.sets.not(unclaimed));
    let claimed = space.prune(claimed);
    let end = space.discrete_digits();
    let (some_left, some_claimed) = (space.sets.shadow(left, end), space.sets.shadow(claimed, end));
    let torn = space.sets.and(some_left, some_claimed);
    let gap = space.sets.and(unclaimed, torn);
    let gap = space.sets.and(gap, assumed);
    let gap = space.prune(gap);
    let witness = space.witness(gap)?;
    let point = Point::of(program, &witness);
    // What is not linear was taken to be possible, so the guards themselves are asked.
    if !witness.certain || program.rows.iter().any(|row| point.holds(&program.pool, row.guard)) {
        return None;
    }
    let claim = claim(space, gap);
    let region = match &claim {
        Some(claim) if claim.len() <= 2 => {
            claim.iter().map(|part| format!("`{part}`")).collect::<Vec<_>>().join(", or ")
        }
        Some(_) | None => "some numbers".to_owned(),
    };
    let message = format!("no case claims {region}; the default decides there");
    let about = claim.clone().unwrap_or_else(|| vec!["some numbers".to_owned()]);
    let mut note = Diagnostic::note(codes::UNCOVERED, message).at(program.hit_policy_span, "").about(about);
    if let Some(claim) = claim.as_ref().filter(|claim| claim.len() > 2) {
        note = note.help(format!("these are the inputs with {}", claim.join(", or ")));
    }
    let pool = &program.pool;
    let asked = program.rows.iter().fold(InputSet::default(), |all, row| all.or(pool.cond_facts(row.guard).inputs));
    if let Some(place) = words::at(program, &witness, asked) {
        note = note.help(format!("for instance {place}"));
    }
    Some(note.help(row(program, claim.as_deref())))
}

/// Conditions that together describe a set in full, as a table would write them; nothing if it takes too many, or if
/// something in them has no name.
pub(super) fn claim(space: &mut Space<'_>, set: Set) -> Option<Vec<String>> {
    let mut patterns = space.sets.patterns(set, MOST);
    let mut covered = Set::EMPTY;
    for pattern in &mut patterns {
        let part = space.sets.pattern(pattern);
        covered = space.sets.or(covered, part);
        shorten(space, set, pattern);
    }
    let sayable = |space: &Space<'_>, digit: usize| {
        space.input_of(digit).is_some()
            || space.form_of(digit).is_some_and(|form| form.terms.keys().all(words::has_name))
    };
    let complete = space.sets.within(set, covered);
    let all = patterns.iter().flatten().all(|(digit, _)| sayable(space, *digit));
    (complete && all).then(|| patterns.iter().map(|pattern| words::condition(space, pattern)).collect())
}

/// Leaves out what follows from the rest of a pattern: of `x >= 1 && x >= 2` the first.
fn shorten(space: &mut Space<'_>, set: Set, pattern: &mut Vec<(usize, LevelSet)>) {
    let mut place = 0;
    while place < pattern.len() && pattern.len() <= MOST_PARTS {
        let rest: Vec<_> =
            pattern.iter().copied().enumerate().filter(|(at, _)| *at != place).map(|(_, part)| part).collect();
        let wider = space.sets.pattern(&rest);
        let beyond = space.sets.minus(wider, set);
        if space.is_void(beyond) {
            pattern.remove(place);
        } else {
            place += 1
        }
    }
}

/// A case that claims what is described, or, if it is not, all that is left.
pub(super) fn row(program: &Program, claim: Option<&[String]>) -> String {
    let taken: HashSet<u32> = program.rows.iter().map(|row| row.id).collect();
    let id = (1..).find(|id| !taken.contains(id)).unwrap_or_default();
    match (claim, program.hit_policy) {
        (Some([one]), _) => format!("to claim them: Case(id: {id}, when: \"{one}\", value: ...)"),
        (Some(several), _) => {
            let parts: Vec<String> = several.iter().map(|part| format!("\"{part}\"")).collect();
            format!("to claim them: Case(id: {id}, when: Any([{}]), value: ...)", parts.join(", "))
        }
        (None, HitPolicy::First) => format!("to claim them: Case(id: {id}, when: true, value: ...) as the last case"),
        (None, HitPolicy::Unique | HitPolicy::Collect) => {
            "`umbrage explain` says for each of them why no case is taken".to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::analyse::found;

    fn gaps(policy: &str, cases: &str) -> Vec<String> {
        let found = found(&format!(
            r#"Table(language: 1, name: "t", hit_policy: {policy},
                inputs: {{"x": Range(from: 0, to: 20), "y": Range(from: 0, to: 20), "b": Bool(), "f": Bool(fetched: (cost: 1))}},
                output: Number(), cases: [{cases}], default: "if b && f {{ y }} else {{ 0 }}")"#
        ));
        found.into_iter().filter(|message| message.starts_with("U0503")).collect()
    }

    #[test]
    fn gaps_between_numbers_are_found() {
        let wide = r#"Case(id: 1, when: "x < 10", value: 1), Case(id: 2, when: "x >= 11", value: 2)"#;
        assert_eq!(gaps("Unique", wide), ["U0503 no case claims `x >= 10 && x < 11`; the default decides there"]);
        let point = r#"Case(id: 1, when: "x < 10", value: 1), Case(id: 2, when: "x > 10", value: 2)"#;
        assert_eq!(gaps("First", point), ["U0503 no case claims `x == 10`; the default decides there"]);
        let hole = r#"Case(id: 1, when: "x < 10 || y < 5", value: 1), Case(id: 2, when: "x > 12 || y > 7", value: 2)"#;
        assert_eq!(
            gaps("First", hole),
            ["U0503 no case claims `x >= 10 && y >= 5 && x <= 12 && y <= 7`; the default decides there"]
        );
        let rows = r#"Case(id: 1, when: "x < 5", value: 1), Case(id: 2, when: "5 <= x && x < 10", value: 2)"#;
        assert_eq!(gaps("First", rows), ["U0503 no case claims `x >= 10`; the default decides there"]);
        let state = r#"Case(id: 1, when: "b", value: 1), Case(id: 2, when: "!b && (x < 3 || x > 4)", value: 2)"#;
        assert_eq!(gaps("First", state), ["U0503 no case claims `!b && x >= 3 && x <= 4`; the default decides there"]);
    }

    #[test]
    fn numbers_that_are_claimed_are_not_missed() {
        for cases in [
            r#"Case(id: 1, when: "x < 10", value: 1), Case(id: 2, when: "x >= 10", value: 2)"#,
            r#"Case(id: 1, when: "x + y < 10", value: 1), Case(id: 2, when: "10 <= y + x", value: 2)"#,
            r#"Case(id: 1, when: "x * y < 10", value: 1), Case(id: 2, when: "x * y >= 10", value: 2)"#,
            r#"Case(id: 1, when: "x < 30", value: 1)"#,
            r#"Case(id: 1, when: "f", value: 1), Case(id: 2, when: "x > 7", value: 2), Case(id: 3, when: "7 >= x", value: 3)"#,
        ] {
            assert_eq!(gaps("First", cases), [""; 0], "{cases}");
        }
    }
}
