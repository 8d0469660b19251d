//! The examples that stand in the tables, run by the interpreter.

use umbrage::eval::Interpreter;
use umbrage::program::Program;

fn run(table: &str) {
    let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
    assert!(!program.examples.is_empty());
    let mut interpreter = Interpreter::<f32>::new(&program);
    let mut wide = Interpreter::<f64>::new(&program);
    for example in &program.examples {
        let place = format!("{table}:{}", program.line(example.span));
        let got = interpreter.evaluate(&example.inputs).unwrap_or_else(|n| panic!("{place}: {n:?}"));
        assert_eq!(got.row, Some(example.row), "{place}: another case is taken");
        let values: Vec<f64> = got.values.iter().map(|v| f64::from(*v)).collect();
        assert_eq!(values, example.expected, "{place}");
        assert_eq!(wide.evaluate(&example.inputs).map(|o| o.values), Ok(example.expected.clone()), "{place}");
    }
    for (row, case) in program.rows.iter().enumerate() {
        assert!(program.examples.iter().any(|e| e.row == row), "case {} of {table} has no example", case.id);
    }
}

#[test]
fn smsr() {
    run("tables/smsr.ron");
}

#[test]
fn rsmss() {
    run("tables/rsmss.ron");
}
