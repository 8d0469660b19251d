//! The differential test: every plan × entry point × language on a device,
//! against the interpreter.
//!
//! A [`jury`](crate::jury) judges; here plans are chosen, points made and kernels run.

use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::kernel::columns::Entry;
use crate::eval::{Batch, Columns};
use crate::gpu::{Gpu, Kernel, Language};
use crate::jury::{Judge, Leeway};
use crate::plan::{Plan, PlanOptions, Shape, Weights};
use crate::program::{Program, reachable};
use crate::prove::{Proved, is_of_one_plan, is_unsuitable};

pub use crate::jury::{Jury, Offender, Run};
pub use crate::points::Point;
pub use crate::points::comparison::{Effort, Points};

/// Points that are evaluated together.
const BATCH: usize = 100_000;

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
