//! Every plan of the published tables on an adapter, against the interpreter.

use std::path::Path;

use umbrage::build::find_tables;
use umbrage::diag::Source;
use umbrage::diff::{self, Effort, Options};
use umbrage::gpu::{AdapterChoice, Gpu, Language};
use umbrage::plan::Shape;
use umbrage::program::{Output, Program};
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
                // Where nothing is fetched, there is nothing to gather; some plans are of numbers only.
                let fit = Shape::ALL.len() - usize::from(program.fetched.is_empty());
                let mut shapes: Vec<Shape> = report.runs.iter().map(|run| run.shape).collect();
                shapes.dedup();
                let shapes = shapes.len();
                let is_number = matches!(program.output, Output::Number(_));
                // Data has one plan, which reads it from a buffer.
                let few = if program.is_data() { 1..=1 } else { 4..=fit };
                assert!(if is_number { shapes == fit } else { few.contains(&shapes) }, "{}: {shapes}", program.name);
                let languages = Language::ALL.iter().filter(|language| language.runs(&program)).count();
                assert_eq!(report.runs.len(), shapes * 2 * languages, "plans, entry points, languages");
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

/// U32 are exact: not one bit may differ, whatever wraps, in either language and for every plan.
#[test]
fn words_are_the_same_bits_on_a_device() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|error| panic!("{error}"));
    let operations = [
        "a + b",
        "a - b",
        "a * b",
        "a / max(b, 1)",
        "a % (b | 1)",
        "a & b",
        "a | b",
        "a ^ ~b",
        "a << b",
        "a >> b",
        "(a << 7) | (a >> 25)",
        "min(a, b) ^ max(a, 3)",
        "clamp(a, 10, 4000000000)",
        "if a < b { a - 1 } else { b * 3 }",
        "u32(f32(a >> 8) * 0.5)",
        "u32(i32(a & 15) - 8) * 3",
        "u32(a == b) + u32(k)",
        "a ^ (b >> 1)",
    ];
    let fields: Vec<String> = (0..operations.len()).map(|i| format!("\"w{i}\": U32()")).collect();
    let record = |of: &dyn Fn(usize) -> String| {
        (0..operations.len()).map(|i| format!("w{i}: {}", of(i))).collect::<Vec<_>>().join(", ")
    };
    let text = format!(
        r#"Table(language: 2, name: "bits", hit_policy: First,
            inputs: {{"a": U32(), "b": U32(), "f": U32(fetched: (cost: 1)), "k": Int(from: 0, to: 3), "c": Bool()}},
            output: Record({{{}}}),
            cases: [Case(id: 1, when: "c && a != 5 || a > b", value: "{{{}}}"), Case(id: 2, when: "f < b", value: "{{{}}}")],
            default: "{{{}}}")"#,
        fields.join(", "),
        record(&|i| operations[i].to_owned()),
        record(&|i| format!("f + {i}")),
        record(&|i| format!("f * {i}")),
    );
    let table = Table::parse(Source::new("bits.ron", text)).unwrap_or_else(|error| panic!("{error}"));
    let program = Program::check(&table).unwrap_or_else(|error| panic!("{error}"));
    let options = Options { effort: Effort { grid: 25, random: 60, lines: 4 }, ..Options::default() };
    let report = diff::table(&program, &gpu, &options, |_| {}).unwrap_or_else(|error| panic!("{error}"));
    assert!(report.points > 500 && report.runs.len() >= 16, "{} points, {} runs", report.points, report.runs.len());
    for run in &report.runs {
        assert_eq!(run.bit_equal, report.points, "{} {:?}: {:?}", run.shape, run.language, run.offenders);
    }
}
