//! Every plan of the published tables on an adapter, against the interpreter.

use std::path::Path;

use umbrage::build::find_tables;
use umbrage::diff::{self, Effort, Options};
use umbrage::gpu::{AdapterChoice, Gpu};
use umbrage::plan::Shape;
use umbrage::program::Program;

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
                assert_eq!(run.bit_equal + run.admissible, report.points);
            }
        }
    }
}
