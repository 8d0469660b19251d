//! Paths against enumeration: they are those that points go, and say what the interpreter says there.

use std::ops::ControlFlow;

use super::super::enumerated::{Point, at, level, points, table};
use super::*;
use crate::points::random::Random;

impl Machine<'_> {
    /// Returns whether a point of the state goes the path that the machine is on, as far as it was followed.
    pub(in crate::program) fn is_at(&self, point: &Point) -> bool {
        let numbers: Vec<f64> =
            point.iter().map(|value| if let Some(Value::Number(n)) = value { *n } else { 0.0 }).collect();
        self.choices.iter().all(|choice| match choice.question {
            Question::Level(input) => level(point, input) == choice.answer,
            Question::Sign(form) => {
                let value = self.normaliser.value(&self.forms[form], &numbers).0;
                Sign::ALL[usize::from(choice.answer)] == Sign::of(value.total_cmp(&0.0))
            }
            Question::Compare(..) => panic!("all comparisons of these tables have forms"),
        })
    }

    /// The value of a resolved expression at a point.
    pub(in crate::program) fn value_at(&self, expr: ExprId, point: &Point) -> f64 {
        let of = |part| self.value_at(part, point);
        match self.pool.node(expr) {
            Node::Const(number) => number.get(),
            Node::Input(input) => match point[input.index()] {
                Some(Value::Number(number)) => number,
                _ => panic!("a level is no number"),
            },
            Node::Unary(op, a) => op.apply(of(a)),
            Node::Binary(op, a, b) => op.apply(of(a), of(b)),
            Node::Ternary(op, a, b, c) => op.apply(of(a), of(b), of(c)),
            Node::Word(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => panic!("not resolved"),
        }
    }
}

/// Every point goes exactly one path, which takes its row, gives its value and fetches what it fetches; every path
/// is gone by some point.
#[test]
fn paths_are_those_of_enumeration() {
    let mut random = Random::new(31);
    let mut paths = 0;
    for _ in 0..30 {
        let program = table(&mut random);
        let mut machine = Machine::new(&program);
        for state in 0..program.states.count() {
            let points = points(&program, state, 16);
            let mut ways = vec![0; points.len()];
            machine.any_path(state, |machine| {
                machine.take_fetched();
                let (row, values) = machine.run(View::PLAIN);
                let fetched = machine.take_fetched();
                paths += 1;
                let mut gone = false;
                for (way, point) in ways.iter_mut().zip(&points).filter(|(_, point)| machine.is_at(point)) {
                    *way += 1;
                    gone = true;
                    let want = at(&program, point).evaluate(point).unwrap_or_else(|e| panic!("{e:?}"));
                    let got = (row, machine.value_at(values[0], point), fetched);
                    assert_eq!(got, (want.row, want.values[0], want.fetched), "{}", machine.describe());
                }
                assert!(gone, "no point goes {}", machine.describe());
                ControlFlow::Continue(())
            });
            assert!(!machine.gave_up() && ways.iter().all(|way| *way == 1), "state {state}");
        }
    }
    assert!(paths > 1000, "{paths}");
}

/// Results are equal on a path if and only if they are at its points.
#[test]
fn equal_results_are_those_of_enumeration() {
    let mut random = Random::new(32);
    let (mut equal, mut different) = (0, 0);
    for _ in 0..40 {
        let program = table(&mut random);
        let mut machine = Machine::new(&program);
        for state in 0..program.states.count() {
            let points = points(&program, state, 32);
            let other = random.below(program.rows.len() + 1);
            machine.any_path(state, |machine| {
                let (_, values) = machine.run(View::PLAIN);
                let others = match other.checked_sub(1) {
                    Some(row) => machine.row_values(row, View::PLAIN),
                    None => program.default.iter().map(|value| machine.resolve(*value, View::PLAIN)).collect(),
                };
                let said = machine.equal(&values, &others);
                let mut here = points.iter().filter(|point| machine.is_at(point)).peekable();
                assert!(here.peek().is_some(), "no point goes {}", machine.describe());
                let same = |point: &Point| machine.value_at(values[0], point) == machine.value_at(others[0], point);
                assert_eq!(here.all(same), said, "{}", machine.describe());
                *(if said { &mut equal } else { &mut different }) += 1;
                ControlFlow::Continue(())
            });
        }
    }
    assert!(equal > 500 && different > 500, "{equal} {different}");
}
