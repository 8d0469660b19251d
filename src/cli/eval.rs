//! `umbrage eval`: rows of inputs in, the case and the value of each row out.

use std::path::PathBuf;

use clap::ValueEnum;

use super::answers::{Answers, Writer};
use super::columns::{self, Columns, Points, Problems};
use super::output::Sink;
use super::report::Report;
use super::{Outcome, PrecisionArgument, Result};
use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::eval::{Interpreter, NeedsFetch};
use crate::explain::explain;
use crate::program::{InputId, Program, Real, Value};
use crate::show::Precision;

/// Arguments of `umbrage eval`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table
    table: PathBuf,
    /// Rows of inputs: CSV with a header, or *.json with an array of objects; `-` is standard input
    #[arg(long, default_value = "-", value_name = "FILE")]
    input: PathBuf,
    /// Where the answers go, one per row: CSV, or *.json; `-` is standard output
    #[arg(long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
    /// Floating-point type
    #[arg(long, value_enum, default_value = "f32", value_name = "TYPE")]
    precision: PrecisionArgument,
    /// What computes the answers
    #[arg(long, value_enum, default_value = "interpreter", value_name = "WHAT")]
    executor: Executor,
    /// Code shape to run on the GPU; the interpreter follows the table itself
    #[arg(long, value_name = "NAME")]
    plan: Option<String>,
}

/// What computes the answers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
enum Executor {
    /// The reference interpreter
    Interpreter,
    /// A shader made from the table
    Gpu,
}

/// How points are evaluated.
struct Settings<'a> {
    executor: Executor,
    precision: Precision,
    #[cfg_attr(not(feature = "gpu"), expect(dead_code, reason = "only the GPU runs plans"))]
    plan: Option<&'a str>,
}

/// Reads, evaluates and writes, a chunk of rows at a time.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    #[cfg(not(feature = "gpu"))]
    if arguments.executor == Executor::Gpu {
        return Err(no_gpu().into());
    }
    let program = Program::read(&arguments.table)?;
    let settings = Settings {
        executor: arguments.executor,
        precision: arguments.precision.into(),
        plan: arguments.plan.as_deref(),
    };
    if settings.executor == Executor::Interpreter
        && let Some(plan) = &arguments.plan
    {
        let message = format!("the interpreter follows the table itself, so `--plan {plan}` changes nothing");
        let note = Diagnostic::note(codes::NOT_APPLICABLE, message).help("plans are run with `--executor gpu`");
        report.failure(&Failure::bare("", note));
    }
    let source = columns::read(&arguments.input)?;
    let fail = |diagnostics| Failure { source: source.clone(), diagnostics };
    let mut columns = Columns::open(&program, &source).map_err(fail)?;
    let json = columns::has_extension(&arguments.output, "json");
    let sink = Sink::create(&arguments.output)?;
    let mut writer = Writer::start(&program, settings.precision, json, sink)?;
    let mut points = Points::new(program.inputs.len());
    let mut problems = Problems::default();
    while columns.next(&mut points, &mut problems) {
        // Rows that cannot be read have no answer; the others are judged nevertheless, to report all that is wrong.
        let answers = evaluate(&program, &points, &settings)?;
        for (index, input) in &answers.needed {
            problems.push(|| needs(&program, &source, points.point(*index), points.place(*index), *input));
        }
        if problems.is_empty() {
            writer.write(&answers)?;
        }
    }
    if !problems.is_empty() {
        return Err(problems.into_failure(source.clone()).into());
    }
    writer.end()?.finish()?;
    Ok(Outcome::Clean)
}

/// A row that leaves out what it needs.
fn needs(program: &Program, source: &Source, point: &[Option<Value>], place: Span, input: InputId) -> Diagnostic {
    let input = &program.inputs[input.index()];
    let row = explain(program, point, Precision::F32).err().and_then(|needed| needed.row);
    let who = row.map_or("this row".to_owned(), |row| format!("case {}", program.rows[row].id));
    let message = format!("line {}: {who} needs `{}`, which is absent", source.line(place.start), input.name);
    Diagnostic::error(codes::NEEDS_FETCH, message)
        .at(columns::first_line(&source.text, place), format!("no value of `{}`", input.name))
        .help(format!("give `{}` a value in this row: {}", input.name, input.doc))
}

/// Answers some points. This is the place where executors are plugged in.
fn evaluate(program: &Program, points: &Points, settings: &Settings<'_>) -> Result<Answers> {
    match (settings.executor, settings.precision) {
        (Executor::Interpreter, Precision::F32) => Ok(interpret::<f32>(program, points)),
        (Executor::Interpreter, Precision::F64) => Ok(interpret::<f64>(program, points)),
        (Executor::Gpu, _) => Ok(on_gpu(program, points, settings)?),
    }
}

/// Answers points one by one.
fn interpret<T: Real>(program: &Program, points: &Points) -> Answers {
    let mut interpreter = Interpreter::<T>::new(program);
    let mut answers = Answers::default();
    for index in 0..points.len() {
        match interpreter.evaluate(points.point(index)) {
            Ok(outcome) => {
                answers.rows.push(outcome.row);
                answers.values.extend(outcome.values.into_iter().map(T::to_f64));
            }
            Err(NeedsFetch(input)) => answers.needed.push((index, input)),
        }
    }
    answers
}

/// Answers points with a shader. PLUG IN HERE: the one place that `--executor gpu` reaches.
#[cfg(feature = "gpu")]
fn on_gpu(_program: &Program, _points: &Points, settings: &Settings<'_>) -> std::result::Result<Answers, Failure> {
    let plan = settings.plan.unwrap_or("auto");
    let message = format!("running the plan `{plan}` on the GPU is not implemented yet");
    Err(Failure::bare("", Diagnostic::error(codes::NO_ADAPTER, message).help("use `--executor interpreter`")))
}

#[cfg(not(feature = "gpu"))]
fn on_gpu(_program: &Program, _points: &Points, _settings: &Settings<'_>) -> std::result::Result<Answers, Failure> {
    Err(no_gpu())
}

#[cfg(not(feature = "gpu"))]
fn no_gpu() -> Failure {
    let error = Diagnostic::error(codes::NO_ADAPTER, "this build has no GPU support");
    Failure::bare("", error.help("use `--executor interpreter`, or build umbrage with the feature `gpu`"))
}
