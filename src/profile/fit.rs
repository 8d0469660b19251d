//! The fit of a profile to a table: as it is, mapped, or not at all.
//!
//! A table changes more often than a scene is counted. While the discrete
//! inputs stay the same, the states mean what they meant, and every count of a
//! state stands, which is all that plans depend on. If they changed, all that is left is how often each case occurred:
//! its count is spread over the states in which the table takes it now, and
//! what belonged to cases that are gone is lost, which is said.

use std::collections::BTreeMap;

use super::{Profile, Scene, state_inputs};
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Interpreter;
use crate::plan::Weights;
use crate::program::symbolic::Machine;
use crate::program::{Assumption, Domain, Kinship, Program, Value, can_occur, reachable};

/// A profile that fits a table.
#[derive(Debug, Clone)]
pub struct Fitted {
    /// The profile, of this table.
    pub profile: Profile,
    /// The loss on the way, if the inputs of the table have changed: a warning.
    pub lost: Option<Diagnostic>,
    /// Set if only the counts of cases, which no plan depends on, may be those of an older table: a warning for whoever
    /// looks at them.
    pub aged: Option<Diagnostic>,
}

/// A state that occurs although an assumption excludes it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Excluded {
    /// The scene.
    pub scene: String,
    /// The state, in words.
    pub state: String,
    /// The number of its evaluations.
    pub count: u64,
    /// The assumption that it contradicts; `None` if they only do together.
    pub assumption: Option<String>,
}

/// Fits a profile to a table.
///
/// # Errors
/// When it is the profile of another table, or nothing of it is left, or it counts nothing.
pub fn fit(program: &Program, profile: Profile, name: &str) -> Result<Fitted, Failure> {
    let refuse =
        |code, message: String, help: &str| Err(Failure::bare(name, Diagnostic::error(code, message).help(help)));
    if profile.table != program.name {
        let message = format!("is a profile of the table `{}`, not of `{}`", profile.table, program.name);
        return refuse(codes::OTHER_PROFILE, message, "give the profile of this table");
    }
    let counts_nothing = |profile: &Profile| profile.state_weights().iter().sum::<f64>() <= 0.0;
    if counts_nothing(&profile) {
        let message = "counts nothing: every count, or every weight, is zero".to_owned();
        return refuse(codes::EMPTY_PROFILE, message, "count scenes in which the table is evaluated");
    }
    let same_inputs = profile.inputs == state_inputs(program);
    let kinship = program.kinship(&profile.fingerprint);
    if kinship == Kinship::Same {
        return match same_inputs {
            true => Ok(Fitted { profile, lost: None, aged: None }),
            false => {
                let message = format!("is damaged: these are not the inputs of `{}`", program.name);
                refuse(codes::BAD_PROFILE, message, &again(program, &profile, name))
            }
        };
    }
    let again = again(program, &profile, name);
    if same_inputs {
        let aged = match kinship {
            Kinship::Same => None,
            Kinship::Other => Some("when the table meant something else"),
            Kinship::Unknown => Some("by another version of umbrage, perhaps when the table meant something else"),
        };
        let aged = aged.map(|when| {
            let message = format!("{name}: was counted {when}");
            let aged = Diagnostic::warning(codes::OLD_PROFILE, message);
            aged.help("the counts of states stand, those of cases are of that time").help(again)
        });
        let profile = Profile { fingerprint: program.fingerprint(), ..profile };
        return Ok(Fitted { profile, lost: None, aged });
    }
    let (mapped, lost) = by_case(program, &profile);
    if counts_nothing(&mapped) {
        let message =
            format!("was counted with other inputs of the table `{}`, and nothing of it is left", program.name);
        return refuse(codes::OTHER_PROFILE, message, &again);
    }
    let total = profile.total();
    let gone: u64 = lost.values().sum();
    let message = format!("{name}: was counted with other inputs of the table `{}`, and is used in part", program.name);
    let mut warning = Diagnostic::warning(codes::OLD_PROFILE, message).help(format!(
        "{} of {total} counts were mapped by the number of their case, {gone} ({:.1} %) were lost",
        total - gone,
        100.0 * gone as f64 / total as f64
    ));
    if !lost.is_empty() {
        let cases: Vec<String> = lost.iter().map(|(case, count)| format!("{} ({count})", case_name(*case))).collect();
        warning = warning.help(format!("never taken any more: {}", cases.join(", ")));
    }
    Ok(Fitted { profile: mapped, lost: Some(warning.help(again)), aged: None })
}

/// The way to count again what a profile counted.
///
/// Scenes that come with Umbrage are rendered again by a command; what else was counted, only its owner has.
fn again(program: &Program, profile: &Profile, name: &str) -> String {
    let table = &program.source.name;
    let first = profile.scenes.first();
    let alike =
        |scene: &Scene| first.is_some_and(|one| (&one.technique, &one.setting) == (&scene.technique, &scene.setting));
    // `480x270, map 512, search limit 128`
    let mut parts = first.map_or("", |scene| scene.setting.as_str()).split(", ");
    let size = parts.next().filter(|size| size.contains('x'));
    let map = parts.next().and_then(|map| map.strip_prefix("map "));
    let (Some(scene), Some(size), Some(map)) = (first.filter(|_| profile.scenes.iter().all(alike)), size, map) else {
        return format!(
            "to count again: capture its inputs again, and `umbrage profile --table {table} --frames FILE`"
        );
    };
    let names: Vec<&str> = profile.scenes.iter().map(|scene| scene.name.as_str()).collect();
    format!(
        "to count again: `umbrage profile --scene {} --technique {} --table {table} --size {size} --shadow-map {map} -o {name}`",
        names.join(","),
        scene.technique
    )
}

/// A case in words.
pub(super) fn case_name(case: Option<u32>) -> String {
    case.map_or("the default".to_owned(), |case| format!("case {case}"))
}

/// The counts of each case, spread over the states in which it is taken now; and what is lost.
fn by_case(program: &Program, profile: &Profile) -> (Profile, BTreeMap<Option<u32>, u64>) {
    let mut states_of: BTreeMap<Option<u32>, Vec<usize>> = BTreeMap::new();
    for (state, case) in typical_cases(program) {
        states_of.entry(case).or_default().push(state);
    }
    let mut lost = BTreeMap::new();
    let mut mapped = Profile { scenes: Vec::new(), ..Profile::new(program) };
    for scene in &profile.scenes {
        let mut states: BTreeMap<usize, u64> = BTreeMap::new();
        let mut cases = BTreeMap::new();
        for (case, count) in scene.cases.iter().filter(|(_, count)| **count > 0) {
            let Some(targets) = states_of.get(case) else {
                *lost.entry(*case).or_default() += *count;
                continue;
            };
            let (each, more) = (*count / targets.len() as u64, *count % targets.len() as u64);
            for (index, state) in targets.iter().enumerate() {
                *states.entry(*state).or_default() += each + u64::from((index as u64) < more);
            }
            cases.insert(*case, *count);
        }
        mapped.scenes.push(Scene { states, cases, tiles: None, ..scene.clone() });
    }
    (mapped, lost)
}

/// The case taken in each state that can occur, in the middle of the continuous inputs.
fn typical_cases(program: &Program) -> Vec<(usize, Option<u32>)> {
    let middle = |domain: &Domain| match domain {
        Domain::Discrete(_) => Value::Level(0),
        Domain::Continuous { lo, hi, .. } => Value::Number(f64::midpoint(*lo, *hi)),
        Domain::Word => Value::Number(0.0),
    };
    let mut point: Vec<Option<Value>> = program.inputs.iter().map(|input| Some(middle(&input.domain))).collect();
    let mut levels = vec![0; program.inputs.len()];
    let mut interpreter = Interpreter::<f64>::new(program);
    let mut cases = Vec::new();
    for state in reachable(program) {
        program.states.write(state, &mut levels);
        for (input, _) in program.states.digits() {
            point[input.index()] = Some(Value::Level(levels[input.index()]));
        }
        if let Ok(outcome) = interpreter.evaluate(&point) {
            cases.push((state, outcome.row.map(|row| program.rows[row].id)));
        }
    }
    cases
}

impl Fitted {
    /// The weights of the states, for the planner.
    ///
    /// # Errors
    /// Never for a profile that was fitted to this program.
    pub fn weights(&self, program: &Program, name: &str) -> Result<Weights, Failure> {
        let origin = format!("{name}, {}", self.profile.describe());
        Weights::new(program, self.profile.state_weights(), origin)
            .map_err(|reason| Failure::bare(name, Diagnostic::error(codes::BAD_PROFILE, reason).help("make it again")))
    }

    /// The states that occur although assumptions exclude them, in any scene: that
    /// is how assumptions are checked.
    pub fn excluded(&self, program: &Program) -> Vec<Excluded> {
        let mut machine = Machine::new(program);
        let all: Vec<&Assumption> = program.assumptions.iter().collect();
        let mut reasons: BTreeMap<usize, Option<Option<String>>> = BTreeMap::new();
        let mut found = Vec::new();
        for scene in &self.profile.scenes {
            for (state, count) in scene.states.iter().filter(|(_, count)| **count > 0) {
                let reason = reasons.entry(*state).or_insert_with(|| {
                    (!can_occur(&mut machine, *state, &all)).then(|| {
                        let alone = all.iter().find(|one| !can_occur(&mut machine, *state, &[one]));
                        alone.map(|assumption| assumption.name.clone())
                    })
                });
                if let Some(assumption) = reason {
                    found.push(Excluded {
                        scene: scene.name.clone(),
                        state: self.profile.words(*state),
                        count: *count,
                        assumption: assumption.clone(),
                    });
                }
            }
        }
        found
    }
}

impl Excluded {
    /// As an error about the table.
    pub fn diagnostic(&self, program: &Program) -> Diagnostic {
        let Excluded { scene, state, count, assumption } = self;
        let inputs: Vec<String> = program
            .states
            .digits()
            .iter()
            .zip(state.split(' '))
            .map(|((input, _), level)| format!("{}={level}", program.inputs[input.index()].name))
            .collect();
        let who = assumption
            .as_ref()
            .map_or("the assumptions together exclude".to_owned(), |name| format!("the assumption `{name}` excludes"));
        let message = format!("{who} a state that occurs {count} times in the scene `{scene}`");
        let mut error = Diagnostic::error(codes::EXCLUDED_STATE, message);
        if let Some(declared) = program.assumptions.iter().find(|a| Some(&a.name) == assumption.as_ref()) {
            error = error.at(declared.span, "does not hold there");
        }
        error
            .help(format!("the state: {}", inputs.join(",")))
            .help("mend the assumption, or what computes the inputs; plans that use it would be wrong there")
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::{scene, smsr};
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    fn parsed(text: String) -> Program {
        let table = Table::parse(Source::new("tables/smsr.ron", text));
        table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"))
    }

    fn some() -> Profile {
        let program = smsr();
        let mut profile = Profile::new(&program);
        // V = bottom with a horizontal run: case 9; and a state that assumptions exclude.
        let bottom = profile.state("none bottom positive_negative positive_negative false false").expect("a state");
        profile.scenes.push(scene("fence", &[(bottom, 90), (0, 10)], &[(Some(9), 90), (Some(1), 10)]));
        profile
    }

    fn help(fitted: &Fitted) -> Vec<String> {
        fitted.lost.as_ref().expect("a warning").notes.clone()
    }

    #[test]
    fn the_same_table_and_another_one() {
        let fitted = fit(&smsr(), some(), "p.ron").expect("fits");
        assert_eq!((fitted.lost.is_none(), fitted.aged.is_none(), &fitted.profile), (true, true, &some()));
        let mut other = some();
        other.table = "rsmss".to_owned();
        let failure = fit(&smsr(), other, "p.ron").expect_err("refused");
        assert_eq!(failure.diagnostics[0].message, "is a profile of the table `rsmss`, not of `smsr`");
        let mut empty = some();
        empty.scenes[0].weight = 0.0;
        let failure = fit(&smsr(), empty, "p.ron").expect_err("refused");
        assert_eq!(failure.diagnostics[0].message, "counts nothing: every count, or every weight, is zero");
    }

    #[test]
    fn counts_stand_while_the_inputs_are_the_same() {
        let counted = smsr().source.text.clone();
        let program = parsed(counted.clone() + "// One comment more.\n");
        let fitted = fit(&program, some(), "p.ron").expect("fits");
        assert_eq!((fitted.lost.is_none(), fitted.aged.is_none()), (true, true));

        let program = parsed(counted.replace("id: 1,", "id: 101,"));
        let older = Profile { fingerprint: "fnv1a 3e82e40ab73226cb".to_owned(), ..some() };
        for (profile, when) in [
            (some(), "when the table meant something else"),
            (older, "by another version of umbrage, perhaps when the table meant something else"),
        ] {
            let fitted = fit(&program, profile, "p.ron").expect("fits");
            assert_eq!((fitted.lost.is_none(), &fitted.profile.scenes), (true, &some().scenes));
            assert_eq!(fitted.profile.fingerprint, program.fingerprint());
            let aged = fitted.aged.expect("a warning");
            assert_eq!(aged.message, format!("p.ron: was counted {when}"));
            assert_eq!(aged.notes[0], "the counts of states stand, those of cases are of that time");
        }
    }

    /// The command that counts again is the one that counted, as far as it is known.
    #[test]
    fn what_was_rendered_can_be_counted_again() {
        let program = smsr();
        let mut profile = some();
        let frames =
            "to count again: capture its inputs again, and `umbrage profile --table tables/smsr.ron --frames FILE`";
        assert_eq!(again(&program, &profile, "p.ron"), frames);
        profile.scenes.push(scene("slope", &[(1, 1)], &[(Some(1), 1)]));
        profile.scenes.iter_mut().for_each(|scene| scene.setting = "480x270, map 512, search limit 128".to_owned());
        let command = "umbrage profile --scene fence,slope --technique smsr --table tables/smsr.ron --size 480x270 \
                       --shadow-map 512 -o p.ron";
        assert_eq!(again(&program, &profile, "p.ron"), format!("to count again: `{command}`"));
        profile.scenes[1].setting = "96x54, map 512, search limit 128".to_owned();
        assert_eq!(again(&program, &profile, "p.ron"), frames);
    }

    #[test]
    fn counts_are_mapped_by_case_when_inputs_changed() {
        // A level more in H and V, and case 1 is now case 101.
        let text = smsr().source.text.replace("\"both\": 0.75}", "\"both\": 0.75, \"odd\": 1}");
        assert_ne!(text, smsr().source.text);
        let text = text.replace("id: 1,", "id: 101,");
        let program = parsed(text);
        let fitted = fit(&program, some(), "p.ron").expect("fits");
        assert_eq!(fitted.profile.total(), 90);
        assert_eq!(
            help(&fitted),
            [
                "90 of 100 counts were mapped by the number of their case, 10 (10.0 %) were lost",
                "never taken any more: case 1 (10)",
                &again(&program, &some(), "p.ron"),
            ]
        );
    }

    #[test]
    fn states_that_assumptions_exclude_are_found() {
        let program = smsr();
        let excluded = fit(&program, some(), "p.ron").expect("fits").excluded(&program);
        assert_eq!(excluded.len(), 1);
        assert_eq!((excluded[0].count, excluded[0].scene.as_str()), (10, "fence"));
        let message = excluded[0].diagnostic(&program).message;
        assert_eq!(message, "the assumption `I1_h` excludes a state that occurs 10 times in the scene `fence`");
    }

    /// A state that has too many paths may occur: its cases are fitted, and it is not called excluded.
    #[test]
    fn states_with_too_many_paths_are_fitted() {
        let program = crate::program::with_too_many_paths();
        assert_eq!(typical_cases(&program), [(0, Some(2)), (1, Some(1))]);
        let mut profile = Profile::new(&program);
        profile.scenes.push(scene("one", &[(0, 90), (1, 10)], &[(Some(2), 90), (Some(1), 10)]));
        assert_eq!(fit(&program, profile, "p.ron").expect("fits").excluded(&program), []);
    }
}
