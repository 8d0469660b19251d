//! Sums and products that a driver computes in another order, and `smoothstep` with any bounds.

use umbrage::diag::Source;
use umbrage::diff::{self, Effort, Jury, Options};
use umbrage::emit::kernel::columns::Entry;
use umbrage::eval::Columns;
use umbrage::gpu::{AdapterChoice, Gpu, Kernel, Language};
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Program, Value};
use umbrage::table::Table;

fn program(value: &str) -> Program {
    let text = format!(
        "Table(language: 1, name: \"t\", hit_policy: First, inputs: {{\"x\": Range(from: -3, to: 7), \
         \"y\": Range(from: 0.1, to: 2.4), \"z\": Range(from: -2, to: 2)}}, output: Number(), \
         cases: [Case(id: 1, when: \"x + y < z + 1.1\", value: \"{value}\")], default: \"({value}) * 0.3\")"
    );
    let table = Table::parse(Source::new("t.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    Program::check(&table).unwrap_or_else(|error| panic!("{error}"))
}

/// Formulas that Mesa's compiler is known to rearrange, and others of their kind.
#[test]
fn whatever_the_order_no_result_offends() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    let effort = Effort { grid: 200, random: 300, lines: 3 };
    for value in [
        "x * y + x * z",
        "(x + 1234567.1) - 1234567.1",
        "dot(vec3(x, y, z), vec3(x, 0.7, x))",
        "mix(x, 1000 * y, z)",
        "mix(x, x, y) - x",
        "x - (x - y) - (y - z)",
        "0.3 + (x + 0.6)",
        "0.3 * (x * 1.7) - x * z",
        "(x * y) / y - x",
        "length(vec3(x, y, z) - vec3(x, x, 0.4))",
        "x % 0.3 + 0.1",
        "(x % y) - x",
        "step(x, z) - 0.3 * 0.7",
        "fract(x) + z - x",
        "smoothstep(x, z, y)",
        "smoothstep(y, y, x) + smoothstep(1.1, y, x)",
    ] {
        let program = program(value);
        let options = Options { shapes: vec![Shape::Ladder], effort, ..Options::default() };
        let report = diff::table(&program, &gpu, &options, |_| {}).unwrap_or_else(|error| panic!("{error}"));
        for run in &report.runs {
            assert_eq!(run.offending, 0, "{value}: {:?}", run.offenders);
            assert_eq!(run.bit_equal + run.admissible + run.reordered, report.points, "{value}");
        }
    }
}

/// Bounds that descend give what the interpreter gives, not what a driver makes of an undefined call.
#[test]
fn smoothstep_is_its_formula_for_bounds_that_descend() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    let program = program("smoothstep(y + 3, y, x)");
    let effort = Effort { grid: 400, random: 400, lines: 0 };
    let options = Options { shapes: vec![Shape::Ladder], effort, ..Options::default() };
    let report = diff::table(&program, &gpu, &options, |_| {}).unwrap_or_else(|error| panic!("{error}"));
    for run in &report.runs {
        assert!(run.offending == 0 && run.worst < 1e-5, "{}: {:?}", run.worst, run.offenders);
    }
}

/// An answer that no order explains is found, and its place is told.
#[test]
fn a_jury_finds_answers_that_are_not_admitted() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    let program = program("x * y + x * z");
    let proved = Plan::proved(&program, Shape::Ladder).unwrap_or_else(|error| panic!("{error}"));
    let points: Vec<Vec<Option<Value>>> =
        [0.25, 0.5, 1.5].map(|x| [x, 0.7, -0.3].map(|number| Some(Value::Number(number))).to_vec()).to_vec();
    let columns = Columns::<f32>::from_rows(&program, &points).unwrap_or_else(|error| panic!("{error}"));
    let kernel = Kernel::new(&gpu, &proved, Entry::Key, Language::Wgsl).unwrap_or_else(|error| panic!("{error}"));
    let mut outputs = kernel.run(&columns).unwrap_or_else(|error| panic!("{error}"));
    let mut jury = Jury::new(&proved);
    jury.hear(&columns, &outputs);
    assert_eq!((jury.run.offending, jury.run.bit_equal + jury.run.admissible + jury.run.reordered), (0, 3));
    outputs.values[0][1] += 1e-4;
    jury.hear(&columns, &outputs);
    assert_eq!(jury.run.offending, 1);
    assert_eq!(jury.run.offenders[0].inputs, "x=0.5,y=0.699999988079071,z=-0.30000001192092896");
}
