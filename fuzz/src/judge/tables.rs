//! A table: what is said of it is true, and whatever is made of it means the same.

use std::sync::Arc;

use umbrage::analyse::{LintLevels, report};
use umbrage::diag::{Code, Source, codes};
use umbrage::emit;
use umbrage::plan::{Plan, Shape};
use umbrage::points::random::Random;
use umbrage::program::Program;
use umbrage::table::Table;

use super::{Court, claims, failures, plans, points};

/// What a random table may be refused for: constants that only show when it is checked.
const CONSTANTS: [Code; 5] =
    [codes::DIVISION_BY_ZERO, codes::NOT_FINITE, codes::DOMAIN, codes::TOO_DEEP, codes::CASE_SHAPE];

/// The kind of fault that a table is which should be none.
pub(crate) const WELL_FORMED: &str = "well-formed, but refused";

/// How thoroughly a table is looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Depth {
    /// It was made to be a table: a refusal is looked at as closely as what is made of it.
    WellFormed,
    /// It may be anything.
    Anything,
}

/// Judges the text of a table.
pub(crate) fn judge(court: &mut Court<'_>, text: &str, depth: Depth, seed: u64) {
    // In the directory of what it imports.
    let name = court.directory.join("t.ron").to_string_lossy().into_owned();
    let source = Source::new(name, text.to_owned());
    let read = court.part("read", |_| Table::parse(source.clone()).and_then(|table| Program::check_all(&table)));
    let programs = match read {
        Some(Ok(programs)) => programs,
        Some(Err(failure)) => {
            failures::refusal(court, "table", &failure);
            if depth == Depth::WellFormed {
                for one in failure.diagnostics.iter().filter(|one| !CONSTANTS.contains(&one.code)) {
                    let kind = format!("{WELL_FORMED}: {} {}", one.code, plans::alike(&one.message));
                    court.fault(kind, failure.to_string());
                }
                let first = failure.diagnostics.first().map_or("", |one| one.code.0);
                court.count(&format!("tables refused: {first}"), 1);
            }
            return;
        }
        None => return,
    };
    court.count("tables", 1);
    court.part("format", |court| laid_out(court, &source, &programs));
    let mut random = Random::new(seed);
    for program in &programs {
        let chosen = court.part("choose points", |_| points::choose(program, &mut random)).unwrap_or_default();
        let known = points::evaluate(court, program, chosen);
        let found = court.part("check", |_| report(program, &LintLevels::default()));
        if let Some(findings) = found {
            court.part("messages", |court| {
                failures::diagnostics(court, "check", &program.source, &findings.open);
                claims::judge(court, program, &findings, &known);
            });
        }
        plans::judge(court, program, &known, &mut random);
    }
    if depth == Depth::WellFormed {
        court.part("rarely", |court| rarely(court, &source, &programs, &mut random));
    }
}

/// Laid out, a table means the same, and laying it out again changes nothing.
fn laid_out(court: &mut Court<'_>, source: &Arc<Source>, programs: &[Program]) {
    let once = match umbrage::format::format(source) {
        Ok(once) => once,
        Err(failure) => return court.fault("fmt: fails on a table", failure.to_string()),
    };
    let again = Source::new(source.name.clone(), once.clone());
    match umbrage::format::format(&again) {
        Ok(twice) => court.expect(twice == once, "fmt: is not idempotent", || format!("{once}\n----\n{twice}")),
        Err(failure) => court.fault("fmt: fails on what it wrote", failure.to_string()),
    }
    match Table::parse(again).and_then(|table| Program::check_all(&table)) {
        Ok(others) => {
            court.expect(programs.len() == others.len(), "fmt: changes the number of programs", || once.clone());
            for (program, other) in programs.iter().zip(&others) {
                // The source names lines, which stay, and everything that the table means.
                let text = |program: &Program| Plan::proved(program, Shape::Ladder).map(|proved| emit::rust(&proved));
                if let (Ok(before), Ok(after)) = (text(program), text(other)) {
                    let same = without_places(&before) == without_places(&after);
                    court.expect(same, "fmt: changes what the table means", || once.clone());
                }
            }
        }
        Err(failure) => court.fault("fmt: makes a table that is refused", format!("{failure}\n{once}")),
    }
}

/// Generated text without what tells texts of tables apart: their hashes, and the lines that cases stand in.
fn without_places(text: &str) -> String {
    let mut kept = String::new();
    for line in text.lines().filter(|line| !line.contains("fnv1a")) {
        kept += line.split_once("t.ron:").map_or(line, |(before, _)| before);
        kept.push('\n');
    }
    kept
}

/// What takes long, for some tables: pictures, pages, words about cases, formulas rewritten.
fn rarely(court: &mut Court<'_>, source: &Arc<Source>, programs: &[Program], random: &mut Random) {
    let Some(program) = programs.first() else { return };
    if program.function.is_some() {
        if random.below(4) == 0 {
            court.part("stabilise", |court| stabilised(court, source));
        }
        return;
    }
    if random.below(16) == 0 {
        court.part("atlas", |court| {
            if let Ok(atlas) = umbrage::atlas::Atlas::new(program, None) {
                let svg = umbrage::atlas::svg(program, &atlas);
                court.expect(svg.starts_with("<svg") || svg.starts_with("<?xml"), "atlas: is no picture", || {
                    svg.clone()
                });
            }
        });
        court.part("why", |_| {
            for row in 0..program.rows.len() {
                let why = umbrage::explain::why::why(program, row, None);
                umbrage::explain::why::render(program, &why, None);
            }
        });
    }
}

/// A rewritten table is one.
fn stabilised(court: &mut Court<'_>, source: &Arc<Source>) {
    let Ok(table) = Table::parse(source.clone()) else { return };
    if let Ok(done) = umbrage::stabilise::stabilise(&table) {
        let again = Source::new(source.name.clone(), done.text.clone());
        let read = Table::parse(again).and_then(|table| Program::check_all(&table));
        court.expect(read.is_ok(), "stabilise: writes a table that is refused", || {
            format!("{}\n{}", read.err().map_or(String::new(), |failure| failure.to_string()), done.text)
        });
    }
}
