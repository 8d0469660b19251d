//! The differential test: every plan × entry point × language on a device,
//! against the interpreter.
//!
//! A result that equals the `f32` interpreter's in case and every bit is right.
//! One that does not may still be legal: WGSL fixes no rounding mode, so near
//! the line where a comparison switches, and in the last bits, more than one
//! answer is admissible. Then the interval interpreter judges, which knows
//! WGSL's accuracy rules: inside what it admits is legal, outside is a bug. What is
//! legal only since WGSL admits sums and products in another order is counted by itself.
//! Fetches have no such leeway: one that the interpreter did not make, or made
//! twice, is a bug, unless another case or line was legally taken.
//!
//! A plan that was proved equal over the reals, but computes otherwise, is
//! judged by its proof: a value that is no further off than the proof allows is
//! legal, and so is one that the table has at inputs that far off. One that
//! makes use of assumptions is compared where these hold.

use std::fmt::Write as _;

use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::kernel::columns::Entry;
use crate::eval::{Batch, Columns, Interpreter, IntervalInterpreter, Results};
use crate::gpu::{Gpu, Kernel, Language, Outputs};
use crate::plan::{Plan, PlanOptions, Shape, Weights};
use crate::program::reachable;
use crate::program::{Domain, Program, Scalar};
use crate::prove::{Proved, is_of_one_plan, is_unsuitable};
use crate::show::{Precision, sentence};

pub use crate::points::Point;
pub use crate::points::comparison::{Effort, Points};

/// Points that are evaluated together.
const BATCH: usize = 100_000;
/// Offenders that are kept for the report.
const KEPT: usize = 5;

/// The plans to compare, and the points.
#[derive(Debug, Clone)]
pub struct Options {
    /// The plans; those that do not suit a table are left out.
    pub shapes: Vec<Shape>,
    /// The number of points.
    pub effort: Effort,
    /// True if plans may make use of the table's assumptions.
    pub assume: bool,
    /// The frequency of each state, for plans that are made for that.
    pub weights: Option<Weights>,
}

impl Default for Options {
    fn default() -> Self {
        Self { shapes: Shape::ALL.to_vec(), effort: Effort::default(), assume: false, weights: None }
    }
}

/// The comparison of one table.
#[derive(Debug, Clone)]
pub struct Report {
    /// Name of the table.
    pub table: String,
    /// Discrete states gone through, all of them; `None` if the points were given.
    pub states: Option<usize>,
    /// Points compared, per run.
    pub points: usize,
    /// One per plan, entry point and language.
    pub runs: Vec<Run>,
    /// The plans that were refused as not equal to the table, which would be a bug of the planner.
    pub refused: Vec<Failure>,
}

/// One executor against the interpreter.
#[derive(Debug, Clone)]
pub struct Run {
    /// The plan.
    pub shape: Shape,
    /// The entry point.
    pub entry: Entry,
    /// The language.
    pub language: Language,
    /// Points with the same case and the same bits.
    pub bit_equal: usize,
    /// Points that differ, but as WGSL admits for the operations as they are written.
    pub admissible: usize,
    /// Points that differ as WGSL admits only if sums and products are computed in another order.
    pub reordered: usize,
    /// Points that differ otherwise.
    pub offending: usize,
    /// Points at which an assumption does not hold that the plan makes use of.
    pub excluded: usize,
    /// Largest difference of a value where the same case was taken.
    pub worst: f64,
    /// The first offenders.
    pub offenders: Vec<Offender>,
}

/// A point at which an executor is wrong.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Offender {
    /// The inputs, as `umbrage explain --at` takes them.
    pub inputs: String,
    /// The result, and the one that was expected.
    pub reason: String,
}

impl Run {
    fn new(shape: Shape, entry: Entry, language: Language) -> Self {
        let (bit_equal, admissible, reordered, offending, excluded) = (0, 0, 0, 0, 0);
        let offenders = Vec::new();
        Self { shape, entry, language, bit_equal, admissible, reordered, offending, excluded, worst: 0.0, offenders }
    }
}

impl Report {
    /// Points that differ without excuse, over all runs.
    pub fn offending(&self) -> usize {
        self.runs.iter().map(|run| run.offending).sum()
    }
}

/// Compares every plan of a program on a device with the interpreter.
/// `progress` is told how many states are done.
///
/// # Errors
/// When a plan cannot be proved, or the device fails.
///
/// ```no_run
/// use umbrage::diff;
/// use umbrage::gpu::{AdapterChoice, Gpu};
/// use umbrage::program::Program;
///
/// let program = Program::read("tables/smsr.ron")?;
/// let gpu = Gpu::open(&AdapterChoice::Any)?;
/// let report = diff::table(&program, &gpu, &diff::Options::default(), |_| {})?;
/// assert_eq!(report.offending(), 0);
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn table(program: &Program, gpu: &Gpu, options: &Options, progress: impl FnMut(usize)) -> Result<Report, Failure> {
    let (proved, refused) = suitable(program, options)?;
    let report = plans(program, &proved, gpu, options.effort, progress)?;
    Ok(Report { refused, ..report })
}

/// Compares plans of a program on a device with the interpreter at given points,
/// which must have every fetched input that is needed.
///
/// # Errors
/// When a plan cannot be proved, an input is missing, or the device fails.
pub fn frames(program: &Program, gpu: &Gpu, options: &Options, frames: &[Columns<f32>]) -> Result<Report, Failure> {
    let (proved, refused) = suitable(program, options)?;
    let mut comparison = Comparison::new(program, &proved, gpu)?;
    for columns in frames {
        comparison.points(columns)?;
    }
    Ok(Report { refused, ..comparison.report })
}

/// Compares the WGSL of proved plans with the interpreter at given points: one run per plan.
///
/// # Errors
/// When an input is missing, or the device fails.
pub fn at(program: &Program, proved: &[Proved<'_>], gpu: &Gpu, columns: &Columns<f32>) -> Result<Vec<Run>, Failure> {
    let mut comparison = Comparison::of(program, proved, gpu, &[Entry::Key], &[Language::Wgsl])?;
    comparison.points(columns)?;
    Ok(comparison.report.runs)
}

/// The plans that suit a table, proved, at least one; and those that were refused.
fn suitable<'p>(program: &'p Program, options: &Options) -> Result<(Vec<Proved<'p>>, Vec<Failure>), Failure> {
    let (mut proved, mut refused) = (Vec::new(), Vec::new());
    let mut unsuitable = None;
    for shape in &options.shapes {
        // The ladder is the order as written, whatever occurs.
        let weights = options.weights.as_ref().filter(|_| *shape != Shape::Ladder);
        let options = PlanOptions { shape: *shape, weights, assume: options.assume };
        match Plan::proved(program, options) {
            Ok(plan) => proved.push(plan),
            Err(failure) if is_unsuitable(&failure) => unsuitable = unsuitable.or(Some(failure)),
            Err(failure) if is_of_one_plan(&failure) => refused.push(failure),
            Err(failure) => return Err(failure),
        }
    }
    match refused.first().cloned().or(unsuitable) {
        Some(failure) if proved.is_empty() => Err(failure),
        _ => Ok((proved, refused)),
    }
}

/// Compares plans with the interpreter of a program: normally their own. With
/// plans of another program, which has the same inputs and cases but means
/// something else, it shows that a wrong shader would be found.
///
/// # Errors
/// When the device fails.
pub fn plans(
    program: &Program,
    proved: &[Proved<'_>],
    gpu: &Gpu,
    effort: Effort,
    mut progress: impl FnMut(usize),
) -> Result<Report, Failure> {
    let mut comparison = Comparison::new(program, proved, gpu)?;
    let assumed = proved.iter().any(|proved| proved.plan().assumed);
    let mut points = if assumed { Points::assuming(program, effort) } else { Points::new(program, effort) };
    let states = if assumed { reachable(program) } else { (0..program.states.count()).collect() };
    comparison.report.states = Some(states.len());
    let mut rest = states.iter().enumerate();
    while rest.len() > 0 {
        let mut columns = Columns::<f32>::new(program);
        let mut done = 0;
        for (number, state) in rest.by_ref() {
            for point in points.of_state(*state) {
                columns.push(&point).map_err(|error| internal(program, &error.to_string()))?;
            }
            done = number + 1;
            if columns.len() >= BATCH {
                break;
            }
        }
        comparison.points(&columns)?;
        progress(done);
    }
    Ok(comparison.report)
}

/// Judges the answers of one executor as they come.
pub struct Jury<'p> {
    interpreter: Batch<'p, f32>,
    judge: Judge<'p>,
    leeway: Leeway,
    /// The findings so far.
    pub run: Run,
}

impl<'p> Jury<'p> {
    /// A jury for the WGSL of a plan.
    pub fn new(proved: &Proved<'p>) -> Self {
        let program = proved.plan().program;
        Self {
            interpreter: Batch::new(program),
            judge: Judge::new(program),
            leeway: Leeway::of(proved),
            run: Run::new(proved.plan().shape, Entry::Key, Language::Wgsl),
        }
    }

    /// Judges the answers at some points. Points at which an input is missing that is needed have none.
    pub fn hear(&mut self, columns: &Columns<f32>, outputs: &Outputs) {
        let Ok(expected) = self.interpreter.evaluate(columns) else { return };
        for point in 0..columns.len() {
            self.judge.compare(columns, point, &expected, outputs, self.leeway, &mut self.run);
        }
    }
}

/// A comparison under way.
struct Comparison<'a, 'p> {
    kernels: Vec<(Kernel<'a, 'p>, Leeway)>,
    interpreter: Batch<'p, f32>,
    judge: Judge<'p>,
    report: Report,
}

impl<'a, 'p> Comparison<'a, 'p> {
    fn new(program: &'p Program, proved: &[Proved<'p>], gpu: &'a Gpu) -> Result<Self, Failure> {
        Self::of(program, proved, gpu, &Entry::ALL, &Language::ALL)
    }

    fn of(
        program: &'p Program,
        proved: &[Proved<'p>],
        gpu: &'a Gpu,
        entries: &[Entry],
        languages: &[Language],
    ) -> Result<Self, Failure> {
        let mut wanted = Vec::new();
        for proved in proved {
            for entry in entries {
                let languages = languages.iter().filter(|language| language.runs(program));
                wanted.extend(languages.map(|language| (proved, *entry, *language)));
            }
        }
        let runs = wanted.iter().map(|(proved, entry, language)| Run::new(proved.plan().shape, *entry, *language));
        let runs = runs.collect();
        let kernels = compiled(gpu, &wanted)?;
        Ok(Self {
            kernels,
            interpreter: Batch::new(program),
            judge: Judge::new(program),
            report: Report { table: program.name.clone(), states: None, points: 0, runs, refused: Vec::new() },
        })
    }

    fn points(&mut self, columns: &Columns<f32>) -> Result<(), Failure> {
        let program = self.judge.program;
        let expected = self.interpreter.evaluate(columns).map_err(|missing| {
            let input = &program.inputs[missing.input.index()].name;
            let message = format!("row {} needs `{input}`, which is absent", missing.row + 1);
            let error = Diagnostic::error(codes::NEEDS_FETCH, message);
            Failure::new(program.source.clone(), error.help("a capture holds what the frame fetched; make it again"))
        })?;
        self.report.points += columns.len();
        for ((kernel, leeway), run) in self.kernels.iter().zip(&mut self.report.runs) {
            let outputs = kernel.run(columns)?;
            for point in 0..columns.len() {
                self.judge.compare(columns, point, &expected, &outputs, *leeway, run);
            }
        }
        Ok(())
    }
}

/// Compiles plans, several at the same time: for some drivers it is the most that there is to do.
fn compiled<'a, 'p>(
    gpu: &'a Gpu,
    wanted: &[(&Proved<'p>, Entry, Language)],
) -> Result<Vec<(Kernel<'a, 'p>, Leeway)>, Failure> {
    let threads = std::thread::available_parallelism().map_or(1, usize::from);
    let compile = |(proved, entry, language): &(&Proved<'p>, Entry, Language)| {
        Ok((Kernel::new(gpu, proved, *entry, *language)?, Leeway::of(proved)))
    };
    let parts: Vec<Vec<Result<_, Failure>>> = std::thread::scope(|scope| {
        let part = |part| scope.spawn(move || wanted.iter().skip(part).step_by(threads).map(compile).collect());
        let parts: Vec<_> = (0..threads).map(part).collect();
        let joined = parts.into_iter().map(std::thread::ScopedJoinHandle::join);
        joined.map(|part| part.unwrap_or_else(|panic| std::panic::resume_unwind(panic))).collect()
    });
    let mut parts: Vec<_> = parts.into_iter().map(Vec::into_iter).collect();
    (0..wanted.len()).filter_map(|index| parts[index % threads].next()).collect()
}

fn internal(program: &Program, message: &str) -> Failure {
    let error =
        Diagnostic::error(codes::BAD_VALUE, format!("the points of `{}` do not fit it: {message}", program.name));
    Failure::new(program.source.clone(), error.help("please report this: points are made from the table itself"))
}

/// The differences from the table that a plan may have.
#[derive(Debug, Clone, Copy)]
struct Leeway {
    /// The case it reports need not be the one that the table takes.
    other_case: bool,
    /// It may do anything where an assumption does not hold.
    assumed: bool,
    /// The error that a value, and an input, may have; zero for a plan that computes as the table does.
    slack: f64,
}

impl Leeway {
    fn of(proved: &Proved<'_>) -> Self {
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

struct Judge<'p> {
    program: &'p Program,
    intervals: IntervalInterpreter<'p>,
    interpreter: Interpreter<'p, f32>,
}

impl<'p> Judge<'p> {
    fn new(program: &'p Program) -> Self {
        Self { program, intervals: IntervalInterpreter::new(program), interpreter: Interpreter::new(program) }
    }

    fn compare(
        &mut self,
        columns: &Columns<f32>,
        point: usize,
        expected: &Results<f32>,
        outputs: &Outputs,
        leeway: Leeway,
        run: &mut Run,
    ) {
        if leeway.assumed && !self.assumptions_hold(&columns.point(point)) {
            run.excluded += 1;
            return;
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
            return;
        } else if same_case && needless.is_none() && worst <= leeway.slack {
            run.admissible += 1;
            return;
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
                return;
            }
            if legal(true) {
                run.reordered += 1;
                return;
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
