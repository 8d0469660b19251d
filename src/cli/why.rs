//! `umbrage why`: what reaches a case.

use std::io::Write;
use std::path::PathBuf;

use serde_json::{Value as Json, json};

use super::messages::{Format, Report};
use super::{Outcome, Result, profiled};
use crate::cli::output::stdout;
use crate::diag::{Diagnostic, Failure, codes};
use crate::explain::reach::Arrival;
use crate::explain::why::{self, Why};
use crate::profile::{self, Profile};
use crate::program::Program;
use crate::show::{self, Precision};
use crate::text::file::shown;

/// Arguments of `umbrage why`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table
    table: PathBuf,
    /// The function of a table of functions
    #[arg(long, value_name = "NAME")]
    function: Option<String>,
    /// Number of the case
    #[arg(long, value_name = "NUMBER")]
    case: u32,
    /// Profile, for frequencies and a typical input
    #[arg(long, value_name = "FILE")]
    profile: Option<PathBuf>,
}

/// Says what reaches a case.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let program = Program::read_function(&arguments.table, arguments.function.as_deref())?;
    let Some(row) = program.rows.iter().position(|row| row.id == arguments.case) else {
        return Err(missing(&program, arguments.case).into());
    };
    let fitted = profiled::read(&program, arguments.profile.as_deref(), report)?;
    let name = arguments.profile.as_ref().map(|path| shown(path)).unwrap_or_default();
    let weights = fitted.as_ref().map(|fitted| fitted.weights(&program, &name)).transpose()?;
    let why = why::why(&program, row, weights.as_ref());
    let shares = fitted.as_ref().map(|fitted| shares(&fitted.profile, arguments.case));
    let text = match report.format {
        Format::Human => why::render(&program, &why, shares.as_deref()),
        Format::Json => format!("{}\n", object(&program, &why, shares.as_deref())),
    };
    let mut out = stdout();
    out.write_all(text.as_bytes())?;
    out.flush()?;
    Ok(Outcome::Clean)
}

/// The share of a case: over all, then in each scene.
fn shares(profile: &Profile, case: u32) -> Vec<(String, f64)> {
    let found = profile::frequencies(profile).into_iter().find(|frequency| frequency.case == Some(case));
    let scenes = profile.scenes.iter().enumerate().map(|(number, scene)| {
        let share = found.as_ref().and_then(|found| found.scenes.get(number)).copied().unwrap_or(0.0);
        (format!("{} ({})", scene.name, scene.technique), share)
    });
    let all = ("all".to_owned(), found.as_ref().map_or(0.0, |found| found.share));
    std::iter::once(all).chain(scenes).collect()
}

/// The refusal of a case that a table does not have.
pub(super) fn missing(program: &Program, case: u32) -> Failure {
    let known: Vec<String> = program.rows.iter().take(60).map(|row| row.id.to_string()).collect();
    let more = if program.rows.len() > known.len() { ", ..." } else { "" };
    let error = Diagnostic::error(codes::MISSING_CASE, format!("there is no case {case}"))
        .help(format!("the cases are: {}{more}", known.join(", ")));
    Failure::bare(program.source.name.clone(), error)
}

fn object(program: &Program, why: &Why, shares: Option<&[(String, f64)]>) -> Json {
    let arrival = |arrival: &Arrival| {
        json!({
            "at": why::at(program, arrival),
            "line": arrival.line.map(|line| line + 1),
            "value": show::words(&program.output, &arrival.values, Precision::F32),
            "assumptions_hold": arrival.assumed,
        })
    };
    let case = |row: Option<usize>| row.map_or(json!("default"), |row| json!(program.rows[row].id));
    let row = &program.rows[why.row];
    json!({
        "table": program.name,
        "case": row.id,
        "file": program.source.name,
        "line": program.line(row.span),
        "section": row.section,
        "doc": row.doc,
        "states": why.reach.states.len(),
        "of_states": program.states.count(),
        "exact": why.reach.exact,
        "earlier": why.earlier.iter()
            .map(|(row, states)| json!({"case": case(Some(*row)), "states": states})).collect::<Vec<_>>(),
        "smallest": why.reach.smallest.as_ref().map(arrival),
        "typical": why.typical.as_ref().map(|(point, _)| arrival(point)),
        "lines": why.reach.lines.iter().map(|line| line.as_ref().map(arrival)).collect::<Vec<_>>(),
        "neighbours": why.neighbours.iter()
            .map(|neighbour| json!({"change": neighbour.change, "case": case(neighbour.row)})).collect::<Vec<_>>(),
        "frequency": shares.map(|shares| {
            shares.iter().map(|(scene, share)| json!({"scene": scene, "share": share})).collect::<Vec<_>>()
        }),
    })
}
