//! A second opinion on the proof: solvers find that plans and tables agree, and that wrong plans do not.
//!
//! Without the solvers there is nothing to ask; `UMBRAGE_REQUIRE_SOLVERS=1`, which the test command sets once it
//! has installed them, makes that a failure.

use std::process::Command;

use crate::support::OrPanic as _;
use umbrage::certificate::Certificate;
use umbrage::plan::{Leaf, Plan, PlanOptions, Shape, Step};
use umbrage::program::Program;
use umbrage::prove::is_unsuitable;
use umbrage::table::Table;

/// The time that a solver has, in seconds; it needs a few at most.
const PATIENCE: u32 = 240;

/// A solver of SMT-LIB.
#[derive(Debug, Clone, Copy)]
enum Solver {
    Z3,
    Cvc5,
}

impl Solver {
    /// The solvers that are installed.
    fn all() -> Vec<Self> {
        if std::env::var_os("UMBRAGE_NO_SOLVERS").is_some() {
            println!("not asked: UMBRAGE_NO_SOLVERS is set");
            return Vec::new();
        }
        let found = |solver: &Self| Command::new(solver.name()).arg("--version").output().is_ok();
        let all: Vec<Self> = [Self::Z3, Self::Cvc5].into_iter().filter(found).collect();
        if all.len() < 2 {
            assert!(std::env::var_os("UMBRAGE_REQUIRE_SOLVERS").is_none(), "z3 or cvc5 is missing, there is {all:?}");
            println!("not asked: {} of z3 and cvc5", 2 - all.len());
        }
        all
    }

    fn name(self) -> &'static str {
        match self {
            Self::Z3 => "z3",
            Self::Cvc5 => "cvc5",
        }
    }

    /// The answer to a certificate: `unsat`, `sat`, or what else it says.
    fn answer(self, certificate: &Certificate) -> String {
        let folder = tempfile::tempdir().expect("a temporary directory");
        let file = folder.path().join("plan.smt2");
        std::fs::write(&file, &certificate.text).expect("written");
        let mut command = Command::new(self.name());
        match self {
            Self::Z3 => command.arg(format!("-T:{PATIENCE}")),
            Self::Cvc5 => command.arg(format!("--tlimit={PATIENCE}000")),
        };
        let output = command.arg(&file).output().expect("it runs");
        String::from_utf8_lossy(&output.stdout).trim().to_owned()
    }
}

/// Every plan that suits the program, not proved.
fn plans(program: &Program) -> Vec<Plan<'_>> {
    let options = Shape::ALL.into_iter().flat_map(|shape| [false, true].map(|assume| (shape, assume)));
    let plan = |(shape, assume)| match Plan::new(program, PlanOptions { shape, weights: None, assume }) {
        Ok(plan) => Some(plan),
        Err(failure) if is_unsuitable(&failure) => None,
        Err(failure) => panic!("{failure}"),
    };
    options.filter_map(plan).collect()
}

#[test]
fn plans_of_the_published_tables_are_certified() {
    let solvers = Solver::all();
    for (table, least) in [("tables/smsr.ron", 16), ("tables/rsmss.ron", 10)] {
        let program = Program::read(table).or_panic();
        let mut plans = plans(&program);
        // Of the large table only the one that makes most of the assumptions.
        let large = program.states.count() > 1000;
        plans.retain(|plan| !large || !plan.assumed || plan.shape == Shape::Orbit);
        let shapes: std::collections::BTreeSet<Shape> = plans.iter().map(|plan| plan.shape).collect();
        let fetchless = usize::from(program.fetched.is_empty());
        assert!(plans.len() >= least && shapes.len() == Shape::ALL.len() - fetchless, "{table}: {shapes:?}");
        each(&plans, |plan| {
            let certificate = Certificate::new(plan);
            assert_eq!(certificate.beyond, Vec::<String>::new(), "{table} {}", plan.shape);
            // The other one takes longer for tables such as the large one.
            let both = !large || plan.shape == Shape::Gathered;
            for solver in solvers.iter().take(if both { 2 } else { 1 }) {
                let answer = solver.answer(&certificate);
                assert_eq!(answer, "unsat", "{table} {} (assumed: {}): {solver:?}", plan.shape, plan.assumed);
            }
        });
    }
}

/// Does something with each of a list, two at a time.
fn each<T: Sync>(list: &[T], work: impl Fn(&T) + Sync) {
    let next = std::sync::atomic::AtomicUsize::new(0);
    let run = || {
        while let Some(one) = list.get(next.fetch_add(1, std::sync::atomic::Ordering::Relaxed)) {
            work(one);
        }
    };
    std::thread::scope(|scope| {
        let other = scope.spawn(run);
        run();
        other.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
    });
}

/// Plans with one thing changed, each with what was changed.
fn wrong<'p>(plan: &Plan<'p>) -> Vec<(&'static str, Plan<'p>)> {
    let mut all = Vec::new();
    let leaves: Vec<_> =
        plan.reachable().into_iter().filter(|step| matches!(plan.step(*step), Step::Leaf(_))).collect();
    if let [.., first, second] = leaves.as_slice() {
        let (a, b) = (plan.step(*first).clone(), plan.step(*second).clone());
        all.push(("two leaves are exchanged", plan.clone().replaced(*first, b).replaced(*second, a)));
    }
    for step in plan.reachable() {
        match plan.step(step).clone() {
            Step::Test { condition, then, other } => {
                all.push(("a test is dropped", plan.clone().replaced(step, plan.step(then).clone())));
                let exchanged = Step::Test { condition, then: other, other: then };
                all.push(("a test goes the other way", plan.clone().replaced(step, exchanged)));
            }
            Step::Leaf(leaf) => {
                let mut changed = plan.clone();
                let values = vec![changed.pool.number(0.437_5)];
                all.push(("another constant", changed.replaced(step, Step::Leaf(Leaf { values, ..leaf }))));
            }
            Step::Gather { input, next, .. } => {
                let mut always = plan.clone();
                let condition = always.pool.always(true);
                all.push(("more is gathered", always.replaced(step, Step::Gather { input, condition, next })));
                let mut never = plan.clone();
                let condition = never.pool.always(false);
                all.push(("less is gathered", never.replaced(step, Step::Gather { input, condition, next })));
            }
            Step::Fetch { .. } | Step::Switch { .. } | Step::Coefficients { .. } | Step::Orbit { .. } => {}
        }
    }
    if let Some(last) = plan.lookup.last() {
        let mut changed = plan.clone();
        let other = plan.lookup.iter().find(|entry| *entry != last).copied().unwrap_or_default();
        if let Some(entry) = changed.lookup.last_mut() {
            *entry = other;
        }
        all.push(("another entry of the lookup", changed));
    }
    if let Some(fit) = plan.coefficients.fits.len().checked_sub(1) {
        let mut changed = plan.clone();
        for form in changed.coefficients.fits[fit].pieces.iter_mut().flat_map(|piece| &mut piece.forms) {
            form.constant += 0.125;
        }
        all.push(("another coefficient", changed));
    }
    all
}

/// Each kind of change is found in some plan; where a solver finds no difference, the gate finds none either, or
/// does not know that it makes none.
#[test]
fn wrong_plans_are_not_certified() {
    let solvers = Solver::all();
    let Some(solver) = solvers.first() else { return };
    let found = std::sync::Mutex::new((std::collections::BTreeMap::<&str, usize>::new(), 0));
    // Of the large table only what the small one has not: fetches, gathered or not.
    for (table, shapes) in [("tables/smsr.ron", Shape::ALL.as_slice()), ("tables/rsmss.ron", &[Shape::Gathered])] {
        let program = Program::read(table).or_panic();
        let mut tried: Vec<(&str, Plan<'_>)> = Vec::new();
        for plan in plans(&program).iter().filter(|plan| !plan.assumed && shapes.contains(&plan.shape)) {
            let mut seen = std::collections::BTreeMap::new();
            for (change, wrong) in wrong(plan) {
                // Of each kind some.
                let count = seen.entry(change).or_insert(0);
                *count += 1;
                if *count <= if program.fetched.is_empty() { 2 } else { 1 } {
                    tried.push((change, wrong));
                }
            }
        }
        each(&tried, |(change, wrong)| {
            let answer = solver.answer(&Certificate::new(wrong));
            let proved = wrong.clone().prove();
            let mut found = found.lock().expect("whole");
            match answer.as_str() {
                "sat" => {
                    let shape = wrong.shape;
                    assert!(proved.is_err(), "{table} {shape}, {change}: proved, and {solver:?} finds a difference");
                    *found.0.entry(change).or_default() += 1;
                }
                "unsat" => found.1 += 1,
                other => panic!("{table} {}, {change}: {other}", wrong.shape),
            }
        });
    }
    let (refused, accepted) = found.into_inner().expect("whole");
    println!("refused: {refused:?}; no difference: {accepted}");
    assert!(refused.len() == 8 && refused.values().all(|count| *count > 0), "{refused:?}");
    assert!(refused.values().sum::<usize>() > 4 * accepted, "{refused:?}, and {accepted} accepted");
}

fn program(text: &str) -> Program {
    let table = Table::parse(umbrage::diag::Source::new("test.ron", text)).and_then(|table| Program::check(&table));
    table.unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// What linear arithmetic does not reach is said, in the file and beside it.
#[test]
fn what_is_beyond_linear_arithmetic_is_said() {
    let program = program(
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"d": Levels(values: {"a": 1, "b": 2}), "x": Range(from: 0.5, to: 1), "y": Range(from: 0, to: 1)},
            output: Number(),
            cases: [Case(id: 1, when: "x < y", value: "sqrt(x) * y"), Case(id: 2, when: "y == 0", value: "x / y")],
            default: "x * f32(d) + floor(3 * y) / f32(d)")"#,
    );
    let beyond = [
        "`quotient` is an unknown function of its operands",
        "`sqrt` is an unknown function of its operands",
        "products of which no factor is a constant",
    ];
    for plan in plans(&program) {
        let certificate = Certificate::new(&plan);
        assert_eq!(certificate.beyond, beyond, "{}", plan.shape);
        for line in beyond {
            assert!(certificate.text.contains(&format!(";   {line}\n")), "{}", certificate.text);
        }
        for solver in Solver::all() {
            assert_eq!(solver.answer(&certificate), "unsat", "{} {solver:?}", plan.shape);
        }
    }
}

/// Symmetries that are no involutions, numbers that no fraction of 127 bits is, fetches that hang on each other.
#[test]
fn tables_with_corners_are_certified() {
    let texts = [
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"d": Levels(values: {"a": 0, "b": 1, "c": 2}), "x": Range(from: -1, to: 1)},
            symmetries: {"round": Symmetry(map: {"d": {"a": "b", "b": "c", "c": "a"}, "x": "-x"}, result: "2 * value")},
            output: Number(), cases: [Case(id: 1, when: "d == a", value: "x"), Case(id: 2, is: (case: 1, under: "round"))],
            default: "4 * abs(x) * sign(x)")"#,
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"d": Bool(), "x": Range(from: 0, to: 1)}, output: Number(clamp: (-1e30, 1e30)),
            cases: [Case(id: 1, when: "d", value: "0.5")], default: "x")"#,
        r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"d": Bool(), "f": Bool(fetched: (cost: 1)), "g": Range(from: 0, to: 1, fetched: (cost: 1)), "x": Range(from: 0, to: 1)},
            output: Number(),
            cases: [Case(id: 1, when: "d && f && g < x", value: "g"), Case(id: 2, when: "x < 0.5 || f", value: "if f { g } else { x }")],
            default: "mix(x, 2, 0.25)")"#,
    ];
    for text in texts {
        let program = program(text);
        for plan in plans(&program) {
            let certificate = Certificate::new(&plan);
            for solver in Solver::all() {
                assert_eq!(solver.answer(&certificate), "unsat", "{} {solver:?}\n{text}", plan.shape);
            }
            plan.prove().unwrap_or_else(|e| panic!("{e}\n{text}"));
        }
    }
}
