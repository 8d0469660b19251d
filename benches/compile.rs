//! How long a table takes from text to validated shader, stage by stage.
//!
//! `cargo xtask bench` runs it optimised and unoptimised. `whole` is what a
//! build script does for one table, one plan and one language: read, check,
//! plan, prove, emit, and validate with naga.

mod synthetic;

use divan::Bencher;
use umbrage::emit::{self, Target};
use umbrage::plan::{Plan, Shape};
use umbrage::program::Program;
use umbrage::prove::Proved;
use umbrage::table::Table;

const TABLES: [&str; 2] = ["tables/smsr.ron", "tables/rsmss.ron"];
const SHAPES: [Shape; 2] = [Shape::Ladder, Shape::Switch];

fn program(path: &str) -> Program {
    Program::read(path).unwrap_or_else(|error| panic!("{error}"))
}

fn proved(program: &Program, shape: Shape) -> Proved<'_> {
    Plan::proved(program, shape).unwrap_or_else(|error| panic!("{error}"))
}

#[divan::bench(args = TABLES)]
fn read(path: &str) -> Table {
    Table::read(path).unwrap_or_else(|error| panic!("{error}"))
}

#[divan::bench(args = TABLES)]
fn check(bencher: Bencher<'_, '_>, path: &str) {
    let table = Table::read(path).unwrap_or_else(|error| panic!("{error}"));
    bencher.bench(|| Program::check(&table).unwrap_or_else(|error| panic!("{error}")));
}

#[divan::bench(args = TABLES, consts = [0, 1])]
fn plan_and_prove<const SHAPE: usize>(bencher: Bencher<'_, '_>, path: &str) {
    let program = program(path);
    bencher.bench(|| proved(&program, SHAPES[SHAPE]).proof().paths);
}

/// The proof of every plan of the larger table, and before it the making of the plan.
#[divan::bench(args = Shape::ALL, sample_count = 20)]
fn plan(bencher: Bencher<'_, '_>, shape: Shape) {
    let program = program(TABLES[1]);
    bencher.bench(|| Plan::new(&program, shape).unwrap_or_else(|error| panic!("{error}")).root());
}

#[divan::bench(args = Shape::ALL, sample_count = 20)]
fn prove(bencher: Bencher<'_, '_>, shape: Shape) {
    let program = program(TABLES[1]);
    let plan = Plan::new(&program, shape).unwrap_or_else(|error| panic!("{error}"));
    bencher.bench(|| umbrage::prove::prove(&plan).unwrap_or_else(|error| panic!("{error:?}")).paths);
}

#[divan::bench(args = TABLES, consts = [0, 1])]
fn emit_and_validate_wgsl<const SHAPE: usize>(bencher: Bencher<'_, '_>, path: &str) {
    let program = program(path);
    let proved = proved(&program, SHAPES[SHAPE]);
    bencher.bench(|| emit::emit(&proved, Target::Wgsl).unwrap_or_else(|error| panic!("{error}")));
}

#[divan::bench(args = TABLES, consts = [0, 1])]
fn whole<const SHAPE: usize>(path: &str) -> Vec<u8> {
    let program = program(path);
    let proved = proved(&program, SHAPES[SHAPE]);
    emit::emit(&proved, Target::Wgsl).unwrap_or_else(|error| panic!("{error}"))
}

/// Every analysis of `umbrage check`.
#[divan::bench(args = TABLES)]
fn analyse(bencher: Bencher<'_, '_>, path: &str) {
    let program = program(path);
    bencher.bench(|| umbrage::analyse::findings(&program).len());
}

/// The same for 1,000 cases over 4^10 states. Each case asks for one or two
/// levels of three to five inputs, drawn by a fixed rule.
#[divan::bench(sample_count = 3)]
fn analyse_large(bencher: Bencher<'_, '_>) {
    let mut seed = 1_u64;
    let mut draw = |end: u64| {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) % end
    };
    let inputs: Vec<String> =
        (0..10).map(|i| format!("\"i{i}\": Levels(values: {{\"a\": 0, \"b\": 1, \"c\": 2, \"d\": 3}})")).collect();
    let cases: Vec<String> = (1..=1000)
        .map(|id| {
            let parts: Vec<String> = (0..3 + draw(3))
                .map(|_| {
                    format!("i{} in {{{}, {}}}", draw(10), ["a", "b"][draw(2) as usize], ["c", "d"][draw(2) as usize])
                })
                .collect();
            format!("Case(id: {id}, when: \"{}\", value: {})", parts.join(" && "), draw(4))
        })
        .collect();
    let text = format!(
        "Table(language: 1, name: \"large\", hit_policy: First, inputs: {{{}}}, output: Number(), cases: [{}], default: 0)",
        inputs.join(", "),
        cases.join(", ")
    );
    let table = Table::parse(umbrage::diag::Source::new("large", text)).unwrap_or_else(|error| panic!("{error}"));
    let program = Program::check(&table).unwrap_or_else(|error| panic!("{error}"));
    bencher.bench(|| umbrage::analyse::findings(&program).len());
}

/// From text to source, without naga and without analyses, as tables grow.
#[divan::bench(args = [100, 1_000, 10_000], sample_count = 3)]
fn grow(bencher: Bencher<'_, '_>, cases: usize) {
    let text = synthetic::table(cases);
    bencher.bench(|| source(&text, |_| ()));
}

/// The same with all that `umbrage check` looks at, which is what a large table takes from text to source.
#[divan::bench(args = [100, 1_000, 10_000], sample_count = 3)]
fn grow_analysed(bencher: Bencher<'_, '_>, cases: usize) {
    let text = synthetic::table(cases);
    bencher.bench(|| source(&text, |program| drop(umbrage::analyse::findings(program))));
}

fn source(text: &str, look: impl FnOnce(&Program)) -> usize {
    let table = Table::parse(umbrage::diag::Source::new("synthetic", text));
    let program = table.and_then(|table| Program::check(&table)).unwrap_or_else(|error| panic!("{error}"));
    look(&program);
    emit::wgsl(&proved(&program, Shape::Ladder)).len()
}

fn main() {
    divan::main();
}
