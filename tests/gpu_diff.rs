//! The differential test on a device: every table, plan, entry point and
//! language against the interpreter; the examples of every table; and that a
//! wrong shader would be found.
#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used)]

#[path = "support/tables.rs"]
mod tables;

use umbrage::analyse::agrees;
use umbrage::diag::Source;
use umbrage::diff::{self, Effort, Options, Points};
use umbrage::emit::harness::Entry;
use umbrage::eval::{Columns, Interpreter};
use umbrage::gpu::{AdapterChoice, Gpu, Kernel, Language};
use umbrage::program::{InputSet, Program};
use umbrage::table::Table;

fn gpu() -> Gpu {
    Gpu::open(&AdapterChoice::Any).unwrap_or_else(|failure| panic!("{failure}"))
}

/// About as many points for a table with thousands of states as for one with a single state.
fn effort(program: &Program) -> Effort {
    match program.states.count() {
        0..=99 => Effort { grid: 125, random: 24, lines: 2 },
        100..=599 => Effort { grid: 16, random: 6, lines: 1 },
        _ => Effort { grid: 16, random: 2, lines: 0 },
    }
}

fn compare(program: &Program, gpu: &Gpu, effort: Effort) {
    let options = Options { effort, ..Options::default() };
    let report = diff::table(program, gpu, &options, |_| {}).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(report.states, program.states.count());
    assert!(report.points >= report.states);
    for run in &report.runs {
        let name = format!("{} {} {} {}", report.table, run.shape, run.entry.name(), run.language.name());
        assert_eq!(run.offending, 0, "{name}: {:#?}", run.offenders);
        assert_eq!(run.bit_equal + run.admissible, report.points, "{name}");
    }
    assert_eq!(report.runs.len(), 4 * tables::plans(program).len(), "plans, entry points and languages");
    let worst = report.runs.iter().map(|run| run.worst).fold(0.0, f64::max);
    println!("{}: {} runs of {} points, worst difference {worst:e}", report.table, report.runs.len(), report.points);
}

#[test]
fn the_published_tables_agree_in_every_state() {
    let gpu = gpu();
    println!("adapter: {}", gpu.describe());
    for program in tables::published() {
        compare(&program, &gpu, Effort { grid: 16, random: 4, lines: 1 });
    }
}

#[test]
fn the_synthetic_tables_agree() {
    let gpu = gpu();
    for program in tables::synthetic() {
        compare(&program, &gpu, effort(&program));
    }
}

#[test]
fn examples_come_out_on_the_device() {
    let gpu = gpu();
    for program in tables::all() {
        if program.examples.is_empty() {
            continue;
        }
        let columns = Columns::from_rows(&program, program.examples.iter().map(|example| &example.inputs)).unwrap();
        for proved in &tables::plans(&program) {
            for (entry, language) in [(Entry::Levels, Language::Glsl), (Entry::Key, Language::Wgsl)] {
                let kernel = Kernel::new(&gpu, proved, entry, language).unwrap_or_else(|e| panic!("{e}"));
                let outputs = kernel.run(&columns).unwrap_or_else(|e| panic!("{e}"));
                for (index, example) in program.examples.iter().enumerate() {
                    let place = format!("{}:{}", program.source.name, program.line(example.span));
                    assert_eq!(outputs.rows[index], Some(example.row), "{place}: another case is taken");
                    for (component, expected) in outputs.values.iter().zip(&example.expected) {
                        assert!(agrees(*expected, f64::from(component[index])), "{place}: {}", component[index]);
                    }
                }
            }
        }
    }
}

/// A table with something in its text replaced.
fn altered(program: &Program, from: &str, to: &str) -> Program {
    assert!(program.source.text.contains(from), "{from} is not in {}", program.source.name);
    let source = Source::new(program.source.name.clone(), program.source.text.replacen(from, to, 1));
    let table = Table::parse(source).unwrap_or_else(|e| panic!("{e}"));
    Program::check(&table).unwrap_or_else(|e| panic!("{e}"))
}

#[test]
fn a_wrong_shader_is_found() {
    let gpu = gpu();
    // A constant in a value, a comparison that differs on its line only, a level, a fetch too many, a clamp.
    let cases = [
        ("rsmss", "\"1 + px - dV\", \"d_cb_top", "\"1.125 + px - dV\", \"d_cb_top", "expected case 9 with"),
        ("smsr", "(0, \"px < dV\")", "(0, \"px <= dV\")", "expected case 11 with 1, got case 11 with 0"),
        ("smsr", "H == none && V == bottom && single", "H == none && V == top && single", "expected case 9"),
        (
            "rsmss",
            "(\"1 - dH\",             \"d_cb_v == none\")",
            "(\"1 - dH\", \"n_left == none || d_cb_v == none\")",
            "`n_left` is fetched without need",
        ),
        ("rsmss", "clamp: (0, 1)", "clamp: (0, 2)", "got case"),
    ];
    let published = tables::published();
    for (table, from, to, reason) in cases {
        let right = published.iter().find(|program| program.name == table).unwrap();
        let wrong = altered(right, from, to);
        let plans = tables::plans(&wrong);
        let effort = Effort { grid: 81, random: 2, lines: 2 };
        let report = diff::plans(right, &plans[..1], &gpu, effort, |_| {}).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(report.runs.len(), 4);
        for run in &report.runs {
            assert!(run.offending > 0, "{table} with {to} passes");
            assert!(run.bit_equal > run.offending, "most points of {table} are not concerned");
            let reasons: Vec<&str> = run.offenders.iter().map(|offender| offender.reason.as_str()).collect();
            assert!(reasons.iter().any(|text| text.contains(reason)), "{table} with {to}: {reasons:?}");
        }
    }
}

#[test]
fn fetches_are_counted_and_lazy() {
    let gpu = gpu();
    for program in tables::all().iter().filter(|program| !program.fetched.is_empty()) {
        let mut points = Points::new(program, Effort { grid: 4, random: 1, lines: 0 });
        let all: Vec<_> = (0..program.states.count()).step_by(7).flat_map(|state| points.of_state(state)).collect();
        let columns = Columns::from_rows(program, &all).unwrap();
        let mut interpreter = Interpreter::<f32>::new(program);
        let want: Vec<InputSet> = all.iter().map(|point| interpreter.evaluate(point).unwrap().fetched).collect();
        let ever = want.iter().fold(InputSet::default(), |all, set| all.or(*set));
        for proved in &tables::plans(program) {
            let kernel = Kernel::new(&gpu, proved, Entry::Key, Language::Wgsl).unwrap_or_else(|e| panic!("{e}"));
            let outputs = kernel.run(&columns).unwrap_or_else(|e| panic!("{e}"));
            let mut seen = InputSet::default();
            for (row, want) in want.iter().enumerate() {
                assert!(outputs.repeated[row].is_empty(), "{}: fetched twice at {:?}", program.name, all[row]);
                assert!(outputs.fetched[row].minus(*want).is_empty(), "{}: needless at {:?}", program.name, all[row]);
                seen = seen.or(outputs.fetched[row]);
            }
            assert_eq!(seen, ever, "{}: every input that is needed somewhere is fetched somewhere", program.name);
        }
    }
}
