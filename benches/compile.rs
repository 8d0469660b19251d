//! How long a table takes from text to validated shader, stage by stage.
//!
//! `cargo xtask bench` runs it optimised and unoptimised. `whole` is what a
//! build script does for one table, one plan and one language: read, check,
//! plan, prove, emit, and validate with naga.

use divan::Bencher;
use umbrage::emit::{self, Target};
use umbrage::plan::{LookupPlace, Plan, Proved, Shape};
use umbrage::program::Program;
use umbrage::table::Table;

const TABLES: [&str; 2] = ["tables/smsr.ron", "tables/rsmss.ron"];
const SHAPES: [Shape; 2] = [Shape::Ladder, Shape::Switch(LookupPlace::Constants)];

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

fn main() {
    divan::main();
}
