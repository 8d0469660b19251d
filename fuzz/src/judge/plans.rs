//! Every plan of a program: proved and right, or refused with a reason that is true.

use umbrage::diag::{Failure, codes};
use umbrage::emit::{self, Target};
use umbrage::plan::walk::Walker;
use umbrage::plan::{Plan, PlanOptions, Shape, Weights};
use umbrage::points::random::Random;
use umbrage::program::{Cond, Domain, ExprId, InputId, LevelTerm, Node, Program, Symmetry};
use umbrage::prove::{Proved, is_unsuitable};

use super::points::{Known, bits, words};
use super::{Court, failures};

/// Files that are emitted and validated of one program, of all its plans and targets.
const EMITTED: usize = 3;

/// Plans, proves, walks and prints a program in every shape.
pub(crate) fn judge(court: &mut Court<'_>, program: &Program, known: &[Known], random: &mut Random) {
    let weights: Vec<f64> = (0..program.states.count()).map(|_| random.below(5) as f64).collect();
    let weights = Weights::new(program, weights, "random").ok().filter(|_| random.below(3) == 0);
    let mut proved = Vec::new();
    for shape in Shape::ALL {
        let assume = !program.assumptions.is_empty() && random.below(3) == 0;
        let options = PlanOptions { shape, weights: weights.as_ref(), assume };
        let name = format!("plan {shape}");
        let plan = court.part(&name, |_| Plan::new(program, options));
        let plan = match plan {
            Some(Ok(plan)) => plan,
            Some(Err(failure)) => {
                court.part("reasons", |court| unsuitable(court, program, shape, &failure));
                continue;
            }
            None => continue,
        };
        match court.part(&format!("prove {shape}"), |_| plan.prove()) {
            Some(Ok(plan)) => {
                court.count("plans proved", 1);
                court.part(&format!("walk {shape}"), |court| walk(court, &plan, known));
                proved.push(plan);
            }
            Some(Err(failure)) => not_proved(court, program, shape, &failure),
            None => {}
        }
    }
    for _ in 0..EMITTED.min(proved.len() * Target::ALL.len()) {
        let plan = &proved[random.below(proved.len())];
        let target = Target::ALL[random.below(Target::ALL.len())];
        let name = target.name();
        // Not every plan can count the lines of its table.
        if let Some(Err(failure)) = court.part(&format!("emit {name}"), |_| emit::emit(plan, target))
            && !is_unsuitable(&failure)
        {
            court.fault(format!("emit: {}", reason(&failure)), format!("{name} of {}\n{failure}", plan.plan().shape));
        }
        court.count("files emitted", 1);
    }
}

/// The reason of a refusal without names and numbers, so that equal ones are alike.
fn reason(failure: &Failure) -> String {
    let text = failure.diagnostics.first().map_or(String::new(), |one| {
        let note = one.notes.first().map_or("", |note| note.lines().next().unwrap_or(""));
        format!("{}: {}: {note}", one.message, one.code.0)
    });
    alike(&text)
}

/// A text with what is quoted, names of random tables and numbers left out.
pub(crate) fn alike(text: &str) -> String {
    let mut out = String::new();
    for (place, part) in text.split(['`', '\'']).enumerate() {
        out += if place % 2 == 0 { part } else { "`_`" };
    }
    let words = out.split(' ').map(|word| if word.contains('_') { "`_`" } else { word });
    let mut plain = String::new();
    for c in words.collect::<Vec<_>>().join(" ").chars() {
        match c {
            '0'..='9' if plain.ends_with('#') => {}
            '0'..='9' => plain.push('#'),
            c => plain.push(c),
        }
    }
    plain.chars().take(120).collect()
}

/// A plan does at every point what the reference does.
fn walk(court: &mut Court<'_>, proved: &Proved<'_>, known: &[Known]) {
    let (plan, proof) = (proved.plan(), proved.proof());
    let shape = plan.shape;
    let walker = Walker::new(plan);
    for known in known.iter().filter(|known| !plan.assumed || known.assumed) {
        let want = &known.narrow;
        let got = match walker.run(&known.point) {
            Ok(got) => got,
            Err(needed) => {
                court.fault(format!("plan {shape}: lacks an input"), format!("{needed:?}"));
                continue;
            }
        };
        court.count("plan runs", 1);
        let at = || format!("{want:?}, not {got:?}, at {}\n{proof}", words(plan.program, &known.point));
        let same_way = !plan.reports_case() || (got.row, got.line) == (want.row, want.line);
        court.expect(same_way, &format!("plan {shape}: takes another case"), at);
        let economical = got.repeated.is_none() && got.fetched.minus(want.fetched).is_empty();
        court.expect(economical, &format!("plan {shape}: fetches more"), at);
        for (a, b) in got.values.iter().zip(&want.values) {
            let close = match (proof.identical == proof.paths, proof.rounding) {
                (true, _) => bits(*a) == bits(*b),
                (false, Some(bound)) => bits(*a) == bits(*b) || (f64::from(*a) - f64::from(*b)).abs() <= bound,
                // Without a bound nothing is promised.
                (false, None) => true,
            };
            court.expect(close, &format!("plan {shape}: gives another value than its proof says"), at);
        }
        court.expect(got.values.len() == want.values.len(), &format!("plan {shape}: gives too few values"), at);
    }
}

/// A plan that was made must be equal to its table, or have too many paths.
fn not_proved(court: &mut Court<'_>, program: &Program, shape: Shape, failure: &Failure) {
    if failure.diagnostics.first().is_some_and(|one| one.code == codes::NOT_APPLICABLE) {
        // Numbers that no exact fraction is: a limit of work.
        return court.count(&format!("undecided: {shape}"), 1);
    }
    if failure.diagnostics.first().is_none_or(|one| one.code != codes::PROOF_TOO_LONG) {
        return court.fault(format!("plan {shape}: is not proved"), failure.to_string());
    }
    court.count("plans with too many paths", 1);
    let most = program.states.count() as f64 * decisions(program);
    court.expect(most > 65_536.0, &format!("plan {shape}: has few paths, and is refused for their number"), || {
        format!("at most {most} paths\n{failure}")
    });
}

/// The outcomes of comparisons and fetches that a program can tell apart at most.
fn decisions(program: &Program) -> f64 {
    let pool = &program.pool;
    let mut ways = 1.0;
    let (mut conditions, mut values) = (std::collections::BTreeSet::new(), std::collections::BTreeSet::new());
    let mut open: Vec<Result<_, _>> = program.default.iter().map(|value| Err(*value)).collect();
    for row in &program.rows {
        open.push(Ok(row.guard));
        for line in &row.lines {
            open.push(Ok(line.condition));
            open.extend(line.values.iter().map(|value| Err(*value)));
        }
    }
    while let Some(next) = open.pop() {
        match next {
            Ok(condition) if conditions.insert(condition) => {
                if let Cond::Compare(_, a, b) = pool.cond(condition) {
                    ways *= 2.0;
                    open.extend([Err(*a), Err(*b)]);
                }
                open.extend(pool.cond(condition).children().map(Ok));
            }
            Err(value) if values.insert(value) => {
                let node = pool.node(value);
                if let Node::Select(condition, ..) = node {
                    open.push(Ok(condition));
                }
                open.extend(node.children().map(Err));
            }
            Ok(_) | Err(_) => {}
        }
    }
    for (id, input) in program.input_ids() {
        if program.fetched.contains(id) {
            ways *= match &input.domain {
                Domain::Discrete(levels) => levels.count() as f64,
                Domain::Continuous { .. } | Domain::Word => 1.0,
            };
        }
    }
    ways
}

/// The reason for which a shape does not suit a program must be true.
fn unsuitable(court: &mut Court<'_>, program: &Program, shape: Shape, failure: &Failure) {
    failures::diagnostics(court, "plan", &failure.source, &failure.diagnostics);
    let first = failure.diagnostics.first();
    let reason = first.and_then(|one| one.notes.first()).cloned().unwrap_or_default();
    let suits = first.is_some_and(|one| one.code == codes::NOT_APPLICABLE);
    court.expect(suits, &format!("plan {shape}: is refused"), || failure.to_string());
    let is = |text: &str| reason.contains(text);
    let true_reason = if is("it fetches nothing") {
        program.fetched.is_empty()
    } else if is("its output is no number") {
        !program.output.is_real()
    } else if is("it has no discrete inputs") {
        program.states.digits().is_empty()
    } else if is("makes no assumptions") {
        program.assumptions.is_empty()
    } else if is("declares no symmetries") {
        program.symmetries.is_empty()
    } else if is("none of its symmetries turns a state into another one") {
        !symmetric(program)
    } else if is("no state that the assumptions allow") {
        true
    } else {
        // Limits of work, and what a shape cannot express: each names what there is too much of.
        court.count(&format!("unsuited: {shape}: {}", alike(&reason)), 1);
        !reason.is_empty()
    };
    court.expect(true_reason, &format!("plan {shape}: is refused with a reason that is not true"), || {
        failure.to_string()
    });
    court.count("plans that do not suit", 1);
}

/// Returns whether a symmetry that changes states plainly holds, since all results are one and the same.
fn symmetric(program: &Program) -> bool {
    let constants =
        |values: &[ExprId]| values.iter().map(|value| program.pool.constant(*value)).collect::<Option<Vec<_>>>();
    let Some(first) = constants(&program.default) else { return false };
    let all =
        program.rows.iter().flat_map(|row| &row.lines).all(|line| constants(&line.values).as_ref() == Some(&first));
    let changes = |term: &LevelTerm| match term {
        LevelTerm::Map(_, renaming) => renaming.iter().enumerate().any(|(level, new)| level != usize::from(*new)),
        LevelTerm::If(..) => true,
        LevelTerm::Const(_) | LevelTerm::Input(_) => false,
    };
    let of_states = |input: InputId| program.states.digits().iter().any(|(digit, _)| *digit == input);
    let turns = |(input, term): &(InputId, LevelTerm)| of_states(*input) && changes(term);
    let plain = |symmetry: &Symmetry| symmetry.result.is_none() && symmetry.levels.iter().any(turns);
    all && program.symmetries.iter().any(plain)
}
