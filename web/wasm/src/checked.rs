//! A text checked: what is wrong with it or odd, and the table that it is.

use std::sync::Arc;

use serde_json::{Value as Json, json};
use umbrage::analyse::{self, LintLevels};
use umbrage::diag::{Diagnostic, Source};
use umbrage::program::{Domain, Input, LevelKind, Program, Row};
use umbrage::table::{Table, seen_from};

use crate::places::Places;
use crate::session::Library;

/// Most bytes of a table, as everywhere.
const MAX_BYTES: usize = 16 << 20;

/// A table that means something.
pub(crate) struct Checked {
    /// Its program, or one for each of its functions; none, if it only declares something for others.
    pub(crate) programs: Vec<Program>,
}

/// Checks a text. Findings are those of `umbrage check`.
pub(crate) fn check(name: &str, text: &str, library: Library) -> (Option<Checked>, Json) {
    if text.len() > MAX_BYTES {
        return (None, json!({ "error": format!("a table has at most {} MiB", MAX_BYTES >> 20) }));
    }
    let source = Source::new(name, text);
    let places = Places::new(&source);
    let read = Table::parse_among(source.clone(), library);
    let programs = read.and_then(|table| Ok((Program::check_all(&table)?, table)));
    let (programs, table) = match programs {
        Ok(read) => read,
        Err(failure) => return (None, json!({ "diagnostics": shown(&places, &seen_from(&source, failure)) })),
    };
    let found = analyse::report_all(&programs, &LintLevels::default());
    let acknowledged = found.acknowledged.iter().map(|(finding, reason)| {
        let mut object = places.diagnostic(finding);
        object["acknowledged"] = json!(reason);
        object
    });
    let acknowledged: Vec<_> = acknowledged.collect();
    let answer = json!({
        "name": table.name.value,
        "title": table.title,
        "origin": table.origin,
        "diagnostics": shown(&places, &found.open),
        "acknowledged": acknowledged,
        "programs": programs.iter().map(|program| described(&source, &places, program)).collect::<Vec<_>>(),
    });
    (Some(Checked { programs }), answer)
}

fn shown(places: &Places<'_>, diagnostics: &[Diagnostic]) -> Vec<Json> {
    diagnostics.iter().map(|one| places.diagnostic(one)).collect()
}

/// A program as the page needs to know it.
fn described(source: &Arc<Source>, places: &Places<'_>, program: &Program) -> Json {
    let row = |row: &Row| {
        json!({
            "id": row.id, "doc": row.doc, "lines": row.lines.len(), "section": row.section, "under": row.under,
            "at": places.span(row.span), "line": source.line(row.span.start),
        })
    };
    let example = |example: &umbrage::program::Example| json!({ "row": example.row, "at": places.span(example.span), "point": crate::decision::words(program, &example.inputs) });
    json!({
        "name": program.name,
        "function": program.function.as_ref().map(|function| function.name.as_str()),
        "states": program.states.count(),
        "inputs": program.inputs.iter().map(input).collect::<Vec<_>>(),
        "output": program.output.describe(),
        "cases": program.rows.iter().map(row).collect::<Vec<_>>(),
        "examples": program.examples.iter().map(example).collect::<Vec<_>>(),
        "count": program.case_count(),
    })
}

fn input(input: &Input) -> Json {
    let domain = match &input.domain {
        Domain::Discrete(levels) if levels.is_wide() => {
            let (lo, hi) = levels.classes.as_ref().map_or((0, 0), umbrage::program::Classes::range);
            json!({ "kind": "integer", "lo": lo, "hi": hi })
        }
        Domain::Discrete(levels) => {
            let all: Vec<_> = (0..levels.count()).map(|level| levels.shown(level as u8)).collect();
            json!({ "kind": if levels.kind == LevelKind::Bool { "bool" } else { "levels" }, "levels": all })
        }
        Domain::Continuous { lo, hi, unit } => json!({ "kind": "number", "lo": lo, "hi": hi, "unit": unit }),
        Domain::Word => json!({ "kind": "word", "lo": 0, "hi": u32::MAX }),
    };
    json!({
        "name": input.name,
        "doc": input.doc,
        "domain": domain,
        "fetched": input.fetched,
        "default": input.default.map(|value| input.show(value)),
        "least": input.show(crate::decision::least(input)),
    })
}
