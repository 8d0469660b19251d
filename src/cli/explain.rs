//! `umbrage explain`: why a table has the value it has at one point, or what a code means.

use std::io::Write;
use std::path::PathBuf;
use std::sync::Arc;

use serde_json::{Map, Value as Json, json};

use super::fix::FixArguments;
use super::input;
use super::messages::{Format, Report};
use super::{Outcome, PrecisionArgument, Result};
use crate::analyse;
use crate::cli::output::stdout;
use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::explain::{self, Explanation, Needed, Tested, code, text};
use crate::points;
use crate::program::{InputId, Program, Value};
use crate::show;

/// Arguments of `umbrage explain`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table, or a diagnostic code such as U0203
    #[arg(value_name = "TABLE|CODE")]
    table: PathBuf,
    /// The function of a table of functions
    #[arg(long, value_name = "NAME")]
    function: Option<String>,
    /// The point, as in H=left,dV=0.5; inputs that are left out have their default
    #[arg(long, value_name = "INPUT=VALUE,...", default_value = "")]
    at: String,
    /// Floating-point type
    #[arg(long, value_enum, default_value = "f32", value_name = "TYPE")]
    precision: PrecisionArgument,
    #[command(flatten)]
    fix: FixArguments,
}

/// Explains one point, or one code.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    if let Some(word) = arguments.table.to_str()
        && code::is_code(word)
        && !arguments.table.exists()
    {
        return explain_code(word, report);
    }
    let program = Program::read_function(&arguments.table, arguments.function.as_deref())?;
    let program = arguments.fix.apply(program)?;
    let source = Source::new("--at", arguments.at.as_str());
    let (point, assumed) = point(&program, &source)?;
    let explanation = explain::explain(&program, &point, arguments.precision.into())
        .map_err(|needed| needs(&program, &source, needed))?;
    let text = match report.format {
        Format::Human => text::render(&program, &explanation, &assumed),
        Format::Json => format!("{}\n", object(&program, &explanation, &assumed)),
    };
    let mut out = stdout();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(Outcome::Clean)
}

/// Prints what a diagnostic code means.
fn explain_code(word: &str, report: &Report) -> Result<Outcome> {
    let Some(entry) = code::entry(word) else {
        let error = Diagnostic::error(codes::UNKNOWN_NAME, "there is no such diagnostic code")
            .help("the codes are listed in docs/language.md, chapter 8, and explained in docs/codes.md");
        return Err(Failure::bare(word, error).into());
    };
    let text = match report.format {
        Format::Human => entry.plain(),
        Format::Json => {
            format!("{}\n", json!({"code": entry.code, "meaning": entry.meaning, "text": entry.text}))
        }
    };
    let mut out = stdout();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(Outcome::Clean)
}

/// Reads `H=left,dV=0.5` and fills in defaults; returns which inputs those are.
fn point(program: &Program, source: &Arc<Source>) -> std::result::Result<(Vec<Option<Value>>, Vec<InputId>), Failure> {
    let mut point: Vec<Option<Value>> = vec![None; program.inputs.len()];
    let mut places: Vec<Option<Span>> = vec![None; program.inputs.len()];
    let mut errors = Vec::new();
    let mut start = 0;
    for part in points::parts(&source.text) {
        let span = Span::new(start, start + part.len());
        start = span.end + 1;
        if part.trim().is_empty() {
            continue;
        }
        let Some((name, word)) = part.split_once('=') else {
            errors.push(
                Diagnostic::error(codes::BAD_VALUE, format!("`{}` gives no value", input::shorten(part.trim())))
                    .at(span, "expected INPUT=VALUE")
                    .help("write, for instance, --at H=left,dV=0.5"),
            );
            continue;
        };
        let input = match input::column(program, name.trim(), Span::new(span.start, span.start + name.len())) {
            Ok(input) => input,
            Err(error) => {
                errors.push(error);
                continue;
            }
        };
        if let Some(first) = places[input.index()].replace(span) {
            let message = format!("`{}` is given twice", name.trim());
            errors.push(
                Diagnostic::error(codes::BAD_VALUE, message).at(span, "given again here").at(first, "first given here"),
            );
            continue;
        }
        match input::cell(&program.inputs[input.index()], word.trim()) {
            Ok(value) => point[input.index()] = value,
            Err(message) => errors.push(
                Diagnostic::error(codes::BAD_VALUE, message)
                    .at(Span::new(span.start + name.len() + 1, span.end), "here"),
            ),
        }
    }
    // What was misspelt would be missing too.
    let bad = !errors.is_empty();
    let mut assumed = Vec::new();
    for (id, input) in program.input_ids() {
        // A fetched input that is not given is absent; that is the point of it.
        if places[id.index()].is_some() || input.fetched.is_some() {
            continue;
        }
        point[id.index()] = input.default;
        assumed.push(id);
        if input.default.is_none() && !bad {
            errors.push(
                Diagnostic::error(codes::BAD_VALUE, format!("`{}` is not given and has no default", input.name))
                    .help(format!("give it a value, as in --at {}={}", input.name, sample(input))),
            );
        }
    }
    if errors.is_empty() { Ok((point, assumed)) } else { Err(Failure { source: source.clone(), diagnostics: errors }) }
}

/// Some value of an input, to show how one is written.
fn sample(input: &crate::program::Input) -> String {
    match &input.domain {
        crate::program::Domain::Discrete(levels) => {
            if levels.classes.is_some() {
                levels.shown(0)
            } else {
                levels.names.join("|")
            }
        }
        crate::program::Domain::Continuous { lo, .. } => lo.to_string(),
        crate::program::Domain::Word => "0".to_owned(),
    }
}

fn needs(program: &Program, source: &Arc<Source>, needed: Needed) -> Failure {
    let input = &program.inputs[needed.input.index()];
    let who = match needed.row.map(|row| &program.rows[row]) {
        Some(row) => format!("case {} ({}:{})", row.id, program.source.name, program.line(row.guard_span)),
        None => "the default".to_owned(),
    };
    let error = Diagnostic::error(codes::NEEDS_FETCH, format!("{who} needs `{}` at this point", input.name))
        .at(Span::new(0, source.text.len()), format!("`{}` is not given", input.name))
        .help(format!("add {}={}: {}", input.name, sample(input), input.doc));
    Failure::new(source.clone(), error)
}

fn object(program: &Program, explanation: &Explanation, assumed: &[InputId]) -> Json {
    let tested = |t: &Tested| json!({"condition": t.condition, "facts": t.facts});
    let all = |tests: &[Tested]| tests.iter().map(tested).collect::<Vec<_>>();
    let mut inputs = Map::new();
    for (id, input) in program.input_ids() {
        if let Some(value) = explanation.point[id.index()] {
            inputs.insert(input.name.clone(), Json::from(input.show(value)));
        }
    }
    let names = |ids: &mut dyn Iterator<Item = InputId>| {
        ids.map(|id| program.inputs[id.index()].name.clone()).collect::<Vec<_>>()
    };
    let refused = program.rows.iter().zip(&explanation.refused);
    let steps = explanation.steps.iter().map(|step| {
        json!({
            "name": step.name, "formula": step.formula, "numbers": step.numbers,
            "because": step.because, "value": step.value,
        })
    });
    let row = explanation.row.map(|row| &program.rows[row]);
    let claims = analyse::claims(program);
    json!({
        "table": program.name,
        "inputs": inputs,
        "defaults": names(&mut assumed.iter().copied()),
        "refused": refused.map(|(row, t)| json!({"case": row.id, "fails": tested(t)})).collect::<Vec<_>>(),
        "case": row.map_or(json!("default"), |row| json!(row.id)),
        "file": program.source.name,
        "line": row.map(|row| program.line(row.span)),
        "section": row.map(|row| &row.section),
        "doc": row.map(|row| &row.doc),
        "also": explanation.also.iter().map(|row| program.rows[*row].id).collect::<Vec<_>>(),
        "guard": all(&explanation.guard),
        "refused_lines": all(&explanation.refused_lines),
        "value_line": explanation.line.map(|line| line + 1),
        "value_condition": all(&explanation.line_condition),
        "steps": steps.collect::<Vec<_>>(),
        "fetched": names(&mut explanation.fetched.iter()),
        "claims": claims.iter().map(|(claim, verdict)| json!({"name": claim.name, "verdict": verdict.words()})).collect::<Vec<_>>(),
        "value": show::words(&program.output, &explanation.values, explanation.precision),
    })
}
