//! `umbrage eval`: rows of inputs in, the case and the value of each row out.

use std::path::PathBuf;

use super::answers::{Answers, Writer};
use super::args::{Backend, Machine};
use super::fix::FixArguments;
use super::input;
use super::input::{Columns, Points, Problems};
use super::messages::Report;
use super::output::Sink;
use super::{Outcome, PrecisionArgument, Result, parse_shape};
use crate::diag::{Diagnostic, Failure, Span, codes};
#[cfg(feature = "gpu")]
use crate::diff::Jury;
#[cfg(feature = "gpu")]
use crate::emit::kernel::columns::Entry;
use crate::eval::{self, Batch, Interpreter, NeedsFetch};
use crate::explain::explain;
#[cfg(feature = "gpu")]
use crate::gpu::{Kernel, Language};
#[cfg(feature = "gpu")]
use crate::plan::Plan;
use crate::plan::Shape;
use crate::program::print::Printer;
use crate::program::{InputId, Program, Real, Value};
use crate::show::Precision;
use crate::technique;

/// Arguments of `umbrage eval`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table
    table: PathBuf,
    /// The function of a table of functions
    #[arg(long, value_name = "NAME")]
    function: Option<String>,
    /// Rows of inputs: CSV with a header, *.json with an array of objects, or *.bin, a capture; `-` is standard input
    #[arg(long, default_value = "-", value_name = "FILE")]
    input: PathBuf,
    /// The file for the answers, one per row: CSV, or *.json; `-` is standard output
    #[arg(long, default_value = "-", value_name = "FILE")]
    output: PathBuf,
    /// Floating-point type
    #[arg(long, value_enum, default_value = "f32", value_name = "TYPE")]
    precision: PrecisionArgument,
    /// Code shape to run on the GPU: ladder, ordered, nested, gathered, tree, switch, switch_buffer, coefficients, orbit [default: ladder]
    #[arg(long, value_name = "PLAN", value_parser = parse_shape)]
    plan: Option<Shape>,
    #[command(flatten)]
    machine: Machine,
    #[command(flatten)]
    fix: FixArguments,
}

/// The executor that computes the answers.
enum Executor<'a> {
    Interpreter,
    #[cfg(feature = "gpu")]
    Gpu(Box<Kernel<'a, 'a>>),
    /// Keeps the lifetime in builds without GPU support.
    #[cfg(not(feature = "gpu"))]
    #[expect(dead_code, reason = "is never made")]
    Never(&'a std::convert::Infallible),
}

/// Reads, evaluates and writes, a chunk of rows at a time.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let program = Program::read_function(&arguments.table, arguments.function.as_deref())?;
    let program = arguments.fix.apply(program)?;
    refuse_double(arguments)?;
    let machine = arguments.machine.executor(Backend::Cpu, report)?;
    #[cfg(feature = "gpu")]
    let proved = match &machine {
        technique::Executor::Gpu(_) => Some(Plan::proved(&program, arguments.plan.unwrap_or(Shape::Ladder))?),
        technique::Executor::Cpu => None,
    };
    let executor = match &machine {
        #[cfg(feature = "gpu")]
        technique::Executor::Gpu(gpu) => match &proved {
            Some(proved) => Executor::Gpu(Box::new(Kernel::new(gpu, proved, Entry::Key, Language::Wgsl)?)),
            None => Executor::Interpreter,
        },
        technique::Executor::Cpu => Executor::Interpreter,
    };
    if matches!(machine, technique::Executor::Cpu)
        && let Some(plan) = &arguments.plan
    {
        let message = format!("the interpreter follows the table itself, so `--plan {plan}` changes nothing");
        let note = Diagnostic::note(codes::NOT_APPLICABLE, message).help("plans are run with `--backend gpu`");
        report.failure(&Failure::bare("", note));
    }
    #[cfg(feature = "gpu")]
    let mut jury = proved.as_ref().map(Jury::new);
    let precision = arguments.precision.into();
    let rows = input::read(&program, &arguments.input)?;
    let source = &rows.source;
    let fail = |diagnostics| Failure { source: source.clone(), diagnostics };
    let mut columns = Columns::open(&program, &rows).map_err(fail)?;
    let json = input::has_extension(&arguments.output, "json");
    let sink = Sink::create(&arguments.output)?;
    let mut writer = Writer::start(&program, precision, json, sink)?;
    let mut points = Points::new(&program);
    let mut problems = Problems::default();
    while columns.next(&mut points, &mut problems) {
        // Rows that cannot be read have no answer; the others are judged nevertheless, to report all that is wrong.
        let answers = match &executor {
            #[cfg(feature = "gpu")]
            Executor::Gpu(kernel) => dispatch(&program, &points, kernel, jury.as_mut())?,
            _ => evaluate(&program, &points, precision),
        };
        if program.function.is_some() {
            outside(&program, &points, |place| columns.locate(source, place), &mut problems);
        }
        for (index, input) in &answers.needed {
            let place = columns.locate(source, points.place(*index));
            problems.push(|| needs(&program, points.point(*index), place, *input));
        }
        if problems.is_empty() {
            writer.write(&answers)?;
        }
    }
    if !problems.is_empty() {
        return Err(problems.into_failure(source.clone()).into());
    }
    writer.end()?.finish()?;
    #[cfg(feature = "gpu")]
    if let (Some(jury), technique::Executor::Gpu(gpu)) = (&jury, &machine)
        && let Some(first) = jury.run.offenders.first()
    {
        let (count, device) = (jury.run.offending, gpu.name());
        let message = format!("{device} gave {count} answers that WGSL does not admit, such as at {}", first.inputs);
        let table = &program.source.name;
        let function = program.function.as_ref().map_or(String::new(), |f| format!(" --function {}", f.name));
        let warning = Diagnostic::warning(codes::INADMISSIBLE, message)
            .help(first.reason.clone())
            .help(format!("to see what should happen: `umbrage explain {table}{function} --at {}`", first.inputs));
        report.failure(&Failure::bare("", warning));
        return Ok(Outcome::Findings);
    }
    Ok(Outcome::Clean)
}

/// Notes rows at which a function is not meant to be used.
fn outside(
    program: &Program,
    points: &Points,
    locate: impl Fn(Span) -> (String, Option<Span>),
    problems: &mut Problems,
) {
    if program.assumptions.is_empty() {
        return;
    }
    let mut interpreter = Interpreter::<f64>::new(program);
    for index in 0..points.len() {
        if interpreter.place(points.point(index)).is_err() {
            continue;
        }
        for condition in &program.assumptions {
            if interpreter.holds(condition.condition) == Ok(false) {
                let (row, place) = locate(points.place(index));
                problems.push(|| {
                    let printer = Printer { pool: &program.pool, inputs: &program.inputs };
                    let message = format!(
                        "{row}: outside of the domain of `{}`: {} does not hold",
                        program.function.as_ref().map_or("", |f| f.name.as_str()),
                        printer.cond(condition.condition)
                    );
                    let error = Diagnostic::error(codes::OUTSIDE_DOMAIN, message);
                    let error = match place {
                        Some(place) => error.at(place, "in this row"),
                        None => error,
                    };
                    match condition.doc.is_empty() {
                        true => error.help("leave out the row, or mend its values"),
                        false => error.help(condition.doc.clone()),
                    }
                });
            }
        }
    }
}

/// A row that leaves out what it needs.
fn needs(program: &Program, point: &[Option<Value>], place: (String, Option<Span>), input: InputId) -> Diagnostic {
    let input = &program.inputs[input.index()];
    let row = explain(program, point, Precision::F32).err().and_then(|needed| needed.row);
    let who = row.map_or("this row".to_owned(), |row| format!("case {}", program.rows[row].id));
    let (place, span) = place;
    let mut error =
        Diagnostic::error(codes::NEEDS_FETCH, format!("{place}: {who} needs `{}`, which is absent", input.name));
    if let Some(span) = span {
        error = error.at(span, format!("no value of `{}`", input.name));
    }
    error.help(format!("give `{}` a value in this row: {}", input.name, input.doc))
}

/// Answers some points with the interpreter.
fn evaluate(program: &Program, points: &Points, precision: Precision) -> Answers {
    match precision {
        Precision::F32 => interpret::<f32>(program, points),
        Precision::F64 => interpret::<f64>(program, points),
    }
}

/// The points as columns. They were checked when they were read.
fn columns_of<T: Real>(program: &Program, points: &Points) -> eval::Columns<T> {
    let rows = (0..points.len()).map(|index| points.point(index));
    eval::Columns::from_rows(program, rows).unwrap_or_else(|_| eval::Columns::new(program))
}

/// Answers points with the interpreter: all at once, or, if some cannot be answered, one by one.
fn interpret<T: Real>(program: &Program, points: &Points) -> Answers {
    let mut answers = Answers::default();
    if let Ok(results) = Batch::<T>::new(program).evaluate(&columns_of(program, points)) {
        for point in 0..results.len() {
            answers.rows.push(results.row(point));
            let values = (0..results.components()).map(|c| results.values(c)[point]).collect::<Vec<T>>();
            answers.values.extend(program.output.numbers(&values));
        }
        return answers;
    }
    let mut interpreter = Interpreter::<T>::new(program);
    for index in 0..points.len() {
        match interpreter.evaluate(points.point(index)) {
            Ok(outcome) => {
                answers.rows.push(outcome.row);
                answers.values.extend(program.output.numbers(&outcome.values));
            }
            Err(NeedsFetch(input)) => answers.needed.push((index, input)),
        }
    }
    answers
}

/// Answers points on the GPU. What it fetched tells which points lack an input.
#[cfg(feature = "gpu")]
fn dispatch(
    program: &Program,
    points: &Points,
    kernel: &Kernel<'_, '_>,
    jury: Option<&mut Jury<'_>>,
) -> std::result::Result<Answers, Failure> {
    let columns = columns_of(program, points);
    let outputs = kernel.run(&columns)?;
    if let Some(jury) = jury {
        jury.hear(&columns, &outputs);
    }
    let mut answers = Answers::default();
    for (point, row) in outputs.rows.iter().enumerate() {
        match outputs.fetched[point].iter().find(|input| !columns.is_present(point, *input)) {
            Some(input) => answers.needed.push((point, input)),
            None => {
                answers.rows.push(*row);
                let values: Vec<f32> = outputs.values.iter().map(|component| component[point]).collect();
                answers.values.extend(program.output.numbers(&values));
            }
        }
    }
    Ok(answers)
}

/// Refuses double precision on a GPU.
fn refuse_double(arguments: &Arguments) -> std::result::Result<(), Failure> {
    let may_be_gpu = arguments.machine.backend.is_some_and(|backend| backend != Backend::Cpu);
    if may_be_gpu && matches!(arguments.precision, PrecisionArgument::F64) {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, "the GPU computes in f32 only");
        return Err(Failure::bare("", error.help("leave out `--precision f64`, or use `--backend cpu`")));
    }
    Ok(())
}
