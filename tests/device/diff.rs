//! Every plan of the published tables on an adapter, against the interpreter.

use std::path::Path;

use umbrage::build::find_tables;
use umbrage::diag::Source;
use umbrage::diff::{self, Effort, Options};
use umbrage::gpu::{AdapterChoice, Gpu};
use umbrage::plan::Shape;
use umbrage::program::Program;
use umbrage::table::Table;

/// All states; fewer points in each than `umbrage diff` takes.
#[test]
fn no_result_is_outside_of_what_wgsl_admits() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    let options = Options { effort: Effort { grid: 16, random: 2, lines: 1 }, ..Options::default() };
    for path in find_tables(Path::new("tables")).unwrap_or_else(|error| panic!("{error}")) {
        for program in Program::read_all(&path).unwrap_or_else(|error| panic!("{error}")) {
            if program.exhibit.is_some() {
                continue;
            }
            let report = diff::table(&program, &gpu, &options, |_| {}).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(report.states, Some(program.states.count()));
            if program.function.is_none() {
                // Where nothing is fetched, there is nothing to gather.
                let shapes = Shape::ALL.len() - usize::from(program.fetched.is_empty());
                assert_eq!(report.runs.len(), shapes * 2 * 2, "plans, entry points, languages");
            }
            for run in &report.runs {
                assert_eq!(run.offending, 0, "{} {}: {:?}", report.table, run.shape, run.offenders);
                assert_eq!(run.bit_equal + run.admissible + run.reordered, report.points);
            }
        }
    }
}

/// Mesa's software rasteriser silently ignores what is nested deeper than eighty
/// levels, and drivers nest chains; so long chains are cut into functions.
#[test]
fn long_chains_take_the_right_case() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    let cases: String = (0..120)
        .map(|i| format!("Case(id: {}, when: \"a == {} && b == {}\", value: \"{i} + x\"),", i + 1, i / 20, i % 20))
        .collect();
    let text = format!(
        "Table(language: 1, name: \"many\", hit_policy: First, inputs: {{\"a\": Int(from: 0, to: 6), \"b\": Int(from: 0, to: 19), \"x\": Range(from: 0, to: 1)}}, output: Number(), cases: [{cases}], default: \"-1\")"
    );
    let table = Table::parse(Source::new("many.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let program = Program::check(&table).unwrap_or_else(|error| panic!("{error}"));
    let shapes = vec![Shape::Ladder, Shape::Switch];
    let options = Options { shapes, effort: Effort { grid: 2, random: 1, lines: 0 }, ..Options::default() };
    let report = diff::table(&program, &gpu, &options, |_| {}).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(report.states, Some(140));
    for run in &report.runs {
        assert_eq!(run.offending, 0, "{}: {:?}", run.shape, run.offenders);
    }
}
