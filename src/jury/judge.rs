//! The judge: right, legal, or a bug, point by point.

use std::fmt::Write as _;

use super::{Offender, Outputs, Run, Verdict};
use crate::eval::{Columns, Interpreter, IntervalInterpreter, Results};
use crate::points::Point;
use crate::program::{Domain, Program, Scalar};
use crate::prove::Proved;
use crate::show::{Precision, sentence};

/// Offenders that are kept for the report.
const KEPT: usize = 5;

/// The differences from the table that a plan may have.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Leeway {
    /// The case it reports need not be the one that the table takes.
    other_case: bool,
    /// It may do anything where an assumption does not hold.
    assumed: bool,
    /// The error that a value, and an input, may have; zero for a plan that computes as the table does.
    slack: f64,
}

impl Leeway {
    pub(crate) fn of(proved: &Proved<'_>) -> Self {
        let (plan, proof) = (proved.plan(), proved.proof());
        let largest = plan.program.inputs.iter().map(|input| match input.domain {
            Domain::Continuous { lo, hi, .. } => lo.abs().max(hi.abs()),
            Domain::Discrete(_) | Domain::Word => 0.0,
        });
        // Where the proof knows no bound, a few roundings of the inputs. The
        // proof's is for rounding to nearest, and WGSL lets an error be twice that.
        let least = largest.fold(1.0, f64::max) * 4.0 * f64::from(f32::EPSILON);
        let slack = match proof.identical == proof.paths {
            true => 0.0,
            false => least.max(2.0 * proof.rounding.unwrap_or(0.0)),
        };
        Self { other_case: !plan.reports_case(), assumed: plan.assumed, slack }
    }
}

/// Judges executors of a program by its interpreters.
pub(crate) struct Judge<'p> {
    pub(crate) program: &'p Program,
    intervals: IntervalInterpreter<'p>,
    interpreter: Interpreter<'p, f32>,
}

impl<'p> Judge<'p> {
    pub(crate) fn new(program: &'p Program) -> Self {
        Self { program, intervals: IntervalInterpreter::new(program), interpreter: Interpreter::new(program) }
    }

    /// Judges one point, and counts the verdict.
    pub(crate) fn compare(
        &mut self,
        columns: &Columns<f32>,
        point: usize,
        expected: &Results<f32>,
        outputs: &Outputs,
        leeway: Leeway,
        run: &mut Run,
    ) -> Verdict {
        if leeway.assumed && !self.assumptions_hold(&columns.point(point)) {
            run.excluded += 1;
            return Verdict::Excluded;
        }
        let want = expected.path(point);
        // A device tells a case by its number, which its images share.
        let number = |row: Option<usize>| row.map(|row| self.program.rows[row].id);
        let told = outputs.rows[point];
        let is_same = leeway.other_case || number(told) == number(want.row);
        let got_row = if is_same { want.row } else { told };
        let same_case = want.row == got_row;
        let (mut same_bits, mut worst) = (same_case, 0.0_f64);
        for ((component, values), of) in outputs.values.iter().enumerate().zip(self.program.output.components()) {
            let (a, b) = (expected.values(component)[point], values[point]);
            same_bits &= a.to_bits() == b.to_bits();
            if same_case && a.to_bits() != b.to_bits() {
                let difference = (of.scalar.read(a) - of.scalar.read(b)).abs();
                // A NaN on one side only is as far off as can be; two are no difference.
                // Of words, neither is the case: what carries them may be anything.
                let is_same = of.scalar != Scalar::Word && (a.is_nan() && b.is_nan() || a == b);
                let difference = if is_same { 0.0 } else { difference };
                worst = worst.max(if difference.is_nan() { f64::INFINITY } else { difference });
            }
        }
        run.worst = run.worst.max(worst);
        let fetched = outputs.fetched[point];
        let again = outputs.repeated[point].iter().next();
        let needless = fetched.minus(want.fetched).iter().next();
        let mut reason = String::new();
        if let Some(input) = again {
            let _ = write!(reason, "`{}` is fetched more than once", self.program.inputs[input.index()].name);
        } else if same_bits && needless.is_none() {
            run.bit_equal += 1;
            return Verdict::Equal;
        } else if same_case && needless.is_none() && worst <= leeway.slack {
            run.admissible += 1;
            return Verdict::Admissible;
        } else {
            let values: Vec<f32> = outputs.values.iter().map(|component| component[point]).collect();
            let mut legal = |reordering: bool| {
                self.intervals.reordering(reordering);
                let near = self.intervals.admissible_near(&columns.point(point), leeway.slack);
                // An absent input may be needed by what was legally done otherwise.
                near.is_ok_and(|near| match needless {
                    Some(_) if same_case => near.contains_fetching(got_row, &values, fetched),
                    _ if leeway.other_case => near.contains_values(&values),
                    _ => self.program.rows_like(got_row).any(|row| near.contains(row, &values)),
                })
            };
            if legal(false) {
                run.admissible += 1;
                return Verdict::Admissible;
            }
            if legal(true) {
                run.reordered += 1;
                return Verdict::Reordered;
            }
            let _ = match needless {
                Some(input) if same_case => {
                    write!(reason, "`{}` is fetched without need", self.program.inputs[input.index()].name)
                }
                _ => write!(
                    reason,
                    "expected {}, got {}",
                    self.describe(want.row, &expected.outcome(point).values),
                    self.describe(got_row, &values)
                ),
            };
        }
        run.offending += 1;
        if run.offenders.len() < KEPT {
            run.offenders.push(Offender { inputs: self.inputs(columns, point), reason });
        }
        Verdict::Offending
    }

    fn assumptions_hold(&mut self, point: &Point) -> bool {
        let mut assumptions = self.program.assumptions.iter();
        self.interpreter.place(point).is_ok()
            && assumptions.all(|assumption| self.interpreter.holds(assumption.condition).unwrap_or(true))
    }

    fn describe(&self, row: Option<usize>, values: &[f32]) -> String {
        let values = self.program.output.numbers(values);
        let case = row.map_or_else(|| "the default".to_owned(), |row| format!("case {}", self.program.rows[row].id));
        format!("{case} with {}", sentence(&self.program.output, &values, Precision::F32))
    }

    fn inputs(&self, columns: &Columns<f32>, point: usize) -> String {
        let values = self.program.inputs.iter().zip(columns.point(point));
        let shown = values.filter_map(|(input, value)| Some(format!("{}={}", input.name, input.show(value?))));
        shown.collect::<Vec<_>>().join(",")
    }
}
