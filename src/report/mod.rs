//! Everything about one table as a page that stands alone: what is written,
//! what is found, what is proved, what comes out.
//!
//! The page is put together from what other modules say; it decides nothing.

mod code;
mod matrix;

use maud::{Markup, PreEscaped, html};

pub use matrix::matrix;

use crate::analyse::{self, LintLevels};
use crate::atlas::text::{self, LineText};
use crate::atlas::{self, Atlas};
use crate::diag::{Diagnostic, Failure, Severity};
use crate::explain::code as codes;
use crate::picture;
use crate::profile::{self, Profile};
use crate::program::{Domain, Program};
use crate::table::HitPolicy;
use crate::tuned::Choice;

/// Knowledge about a table beyond its text.
#[derive(Debug, Clone, Copy, Default)]
pub struct Known<'a> {
    /// The frequencies of its states.
    pub profile: Option<&'a Profile>,
    /// The device it was tuned on, and what was chosen.
    pub tuned: Option<(&'a str, &'a Choice)>,
}

/// The page about a table.
///
/// # Errors
/// When a picture cannot be encoded.
///
/// ```
/// use umbrage::program::Program;
/// use umbrage::report::{Known, page};
///
/// let program = Program::read("tables/smsr.ron")?;
/// let html = page(&program, Known { profile: None, tuned: None })?;
/// assert!(html.contains("</html>"));
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn page(program: &Program, known: Known<'_>) -> Result<String, Failure> {
    let shares = known.profile.map(|profile| profile::shares(profile, program));
    let atlas = Atlas::new(program, shares.as_deref())?;
    let title = if program.title.is_empty() { &program.name } else { &program.title };
    let body = html! {
        p.lead { (lead(program)) }
        (contents(known))
        h2 id="inputs" { "Inputs" }
        (inputs(program))
        h2 id="cases" { "Cases" }
        (cases(program, shares.as_deref()))
        h2 id="findings" { "Findings" }
        (findings(program))
        h2 id="coverage" { "Coverage" }
        (matrix(program))
        h2 id="atlas" { "Atlas" }
        (atlas::html(program, &atlas))
        @if let Some(profile) = known.profile {
            h2 id="profile" { "Profile" }
            p { (profile.describe()) }
            figure { (PreEscaped(document(&profile::chart(profile)))) }
        }
        h2 id="plans" { "Plans" }
        p { "A plan is a way to find the case. Code is made only of plans that are proved equal to the table." }
        (code::plans(program))
        @if let Some((device, choice)) = known.tuned { (tuning(device, choice)) }
        @if program.claims.is_some() {
            h2 id="claims" { "Claims" }
            (claims(program))
        }
        h2 id="code" { "Generated code" }
        (code::code(program))
        h2 id="source" { "The table as written" }
        (source(program))
    };
    Ok(picture::page(title, body))
}

fn lead(program: &Program) -> String {
    let policy = match program.hit_policy {
        HitPolicy::First => "the first case that matches counts",
        HitPolicy::Unique => "no two cases contradict each other",
        HitPolicy::Collect => "the items of all cases that match, in order",
    };
    let source = if program.origin.is_empty() { String::new() } else { format!(" Source: {}.", program.origin) };
    format!(
        "{}, {}: {} cases, {policy}; {} inputs, {} states.{source}",
        program.source.name,
        program.fingerprint(),
        program.case_count(),
        program.inputs.len(),
        program.states.count(),
    )
}

fn contents(known: Known<'_>) -> Markup {
    let profile = known.profile.map(|_| ("profile", "Profile"));
    let parts = [("inputs", "Inputs"), ("cases", "Cases"), ("findings", "Findings"), ("coverage", "Coverage")];
    let more = [("plans", "Plans"), ("code", "Generated code"), ("source", "Source")];
    let parts = parts.into_iter().chain([("atlas", "Atlas")]).chain(profile).chain(more);
    html! { nav { @for (id, name) in parts { a href=(format!("#{id}")) { (name) } } } }
}

fn inputs(program: &Program) -> Markup {
    html! {
        div.wide {
            table {
                tr { th { "input" } th { "values" } th { "default" } th { "fetched" } th { "what it is" } }
                @for input in &program.inputs {
                    tr {
                        td { code { (input.name) } }
                        td {
                            @match &input.domain {
                                Domain::Discrete(levels) => { (levels.describe()) }
                                Domain::Word => { "U32" }
                                Domain::Continuous { lo, hi, unit } => { (lo) " to " (hi) " " (unit) }
                            }
                        }
                        td { (input.default.map(|value| input.show(value)).unwrap_or_default()) }
                        td { @if let Some(cost) = input.fetched { (cost) " reads" } }
                        td { (input.doc) }
                    }
                }
            }
        }
    }
}

fn claims(program: &Program) -> Markup {
    html! {
        div.wide {
            table {
                tr { th { "claim" } th { "what it is" } th { "verdict" } }
                @for (claim, verdict) in analyse::claims(program) {
                    tr { td { code { (claim.name) } } td { (claim.doc) } td { (verdict.words()) } }
                }
            }
        }
    }
}

fn cases(program: &Program, shares: Option<&[f64]>) -> Markup {
    html! {
        div.wide {
            table {
                tr {
                    th.n { "case" } th { "when" } th { "value" } th { "what it is" }
                    @if shares.is_some() { th.n { "share" } }
                    th { "see" }
                }
                @for (index, row) in program.rows.iter().enumerate() {
                    @let line = program.line(row.span);
                    tr id=(format!("row-{}", row.id)) {
                        td.n { (row.id) }
                        td { code { (text::guard(program, row)) } }
                        td {
                            @for LineText { value, condition } in text::lines(program, row) {
                                div {
                                    code { (value) }
                                    @if !condition.is_empty() { span.soft { " if " code { (condition) } } }
                                }
                            }
                        }
                        td {
                            (row.doc)
                            @if !row.section.is_empty() { span.soft { " (" (row.section) ")" } }
                            @for erratum in &row.errata {
                                div.soft { "erratum " (erratum.number) ": printed “" (erratum.printed) "”, meant “" (erratum.meant) "”" }
                            }
                        }
                        @if let Some(share) = shares.and_then(|shares| shares.get(index)) {
                            td.n { (format!("{:.2} %", share * 100.0)) }
                        }
                        td {
                            a href=(format!("#case-{}", row.id)) { "picture" } " "
                            a href=(format!("#{}", code::anchor(row.id))) { "code" } " "
                            a href=(format!("#L{line}")) { "line " (line) }
                        }
                    }
                }
            }
        }
    }
}

fn findings(program: &Program) -> Markup {
    let found = analyse::report(program, &LintLevels::default());
    html! {
        @if found.open.is_empty() { p.good { "Nothing was found." } }
        @for finding in &found.open { (finding_of(program, finding)) }
        @if !found.acknowledged.is_empty() {
            h3 { "Acknowledged in the table" }
            ul {
                @for (finding, reason) in &found.acknowledged {
                    li { (finding.code) ": " (finding.message) ". " span.soft { "Reason: " (reason) } }
                }
            }
        }
    }
}

fn finding_of(program: &Program, finding: &Diagnostic) -> Markup {
    let (word, class) = match finding.severity {
        Severity::Error => ("error", "bad"),
        Severity::Warning => ("warning", "warn"),
        Severity::Note => ("note", "soft"),
    };
    html! {
        h3 { span class=(class) { (word) } " " (finding.code) ": " (finding.message) }
        ul {
            @for label in &finding.labels {
                @let line = program.line(label.span);
                li {
                    a href=(format!("#L{line}")) { "line " (line) }
                    @if !label.message.is_empty() { ": " (label.message) }
                }
            }
            @for note in &finding.notes { li { (note) } }
        }
        @if let Some(entry) = codes::entry(finding.code.0) {
            details { summary { "what " (entry.code) " means" } pre { (entry.plain()) } }
        }
    }
}

fn tuning(device: &str, choice: &Choice) -> Markup {
    html! {
        h3 { "Tuned" }
        p {
            "On " (device) " the plan " code { (choice.plan) } " was chosen"
            @if choice.assume { ", under the table's assumptions" }
            ". Profile: " (choice.profile) ". Measured by umbrage " (choice.umbrage) ", " (choice.method) "."
        }
        table {
            tr { th { "plan" } th { "inputs" } th.n { "µs" } th.n { "to the ladder" } th.n { "to the floor" } }
            @for evidence in &choice.evidence {
                tr {
                    td { code { (evidence.plan) } }
                    td { (evidence.input) }
                    td.n { (format!("{:.1}", evidence.us)) }
                    td.n { (format!("{:.3}", evidence.vs_ladder)) }
                    td.n { (format!("{:.3}", evidence.vs_floor)) }
                }
            }
        }
    }
}

fn source(program: &Program) -> Markup {
    html! {
        pre.code {
            @for (number, line) in program.source.text.lines().enumerate() {
                span id=(format!("L{}", number + 1)) { span.soft { (format!("{:4}  ", number + 1)) } (line) } "\n"
            }
        }
    }
}

/// An SVG document as part of a page: without what may stand before its first element.
fn document(svg: &str) -> String {
    svg.find("<svg").map_or_else(String::new, |start| svg[start..].to_owned())
}
