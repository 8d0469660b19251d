//! There is an adapter, and it computes. Nothing that needs one is skipped
//! where there is none: this test and all others fail and say what to install.
#![cfg(feature = "gpu")]
#![allow(clippy::unwrap_used)]

use umbrage::emit::harness::Entry;
use umbrage::eval::Columns;
use umbrage::gpu::{AdapterChoice, Gpu, Kernel, Language};
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Program, Value};

#[test]
fn an_adapter_can_be_used() {
    let gpu = Gpu::open(&AdapterChoice::Any).unwrap_or_else(|failure| panic!("{failure}"));
    println!("adapter: {}", gpu.describe());
    let program = Program::read("tests/tables/single.ron").unwrap_or_else(|failure| panic!("{failure}"));
    let proved = Plan::proved(&program, Shape::Ladder).unwrap_or_else(|failure| panic!("{failure}"));
    let kernel = Kernel::new(&gpu, &proved, Entry::Key, Language::Wgsl).unwrap_or_else(|failure| panic!("{failure}"));
    let rows = [[0.5, 1.0], [1.0, 0.25]].map(|row| row.map(|x| Some(Value::Number(x))));
    let outputs =
        kernel.run(&Columns::from_rows(&program, rows).unwrap()).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!(outputs.rows, [Some(0), None]);
    assert_eq!(outputs.values, [[1.0, 0.75]]);
}
