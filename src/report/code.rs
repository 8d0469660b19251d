//! Generated code in the page: linked from the rows and back to them.

use std::collections::HashSet;

use maud::{Markup, html};

use crate::emit::{self, Target};
use crate::plan::{Plan, Shape};
use crate::program::Program;

/// The plan whose code is shown in every language, and the language shown of every plan.
const SHOWN: (Shape, Target) = (Shape::Ladder, Target::Wgsl);

/// The anchor of a row's code, in the plan and language that are shown first.
pub(super) fn anchor(id: u32) -> String {
    format!("{}.{}-{id}", SHOWN.0, SHOWN.1.name())
}

/// Every plan with the state of its proof.
pub(super) fn plans(program: &Program) -> Markup {
    html! {
        table {
            tr { th { "plan" } th { "proof" } }
            @for shape in Shape::ALL {
                tr {
                    td { code { (shape.name()) } }
                    @match Plan::new(program, shape).and_then(Plan::prove) {
                        Ok(proved) => {
                            td { span.good { "proved" } " " (proved.proof()) }
                        }
                        Err(failure) => {
                            td { span.warn { "left out" } " " (reason(&failure)) }
                        }
                    }
                }
            }
        }
    }
}

fn reason(failure: &crate::diag::Failure) -> String {
    let first = failure.diagnostics.first();
    let notes = first.map(|first| first.notes.join("; ")).unwrap_or_default();
    let message = first.map(|first| first.message.clone()).unwrap_or_default();
    if notes.is_empty() { message } else { format!("{message}: {notes}") }
}

/// The code of one plan in every language, and of every plan in one.
pub(super) fn code(program: &Program) -> Markup {
    let shapes = Shape::ALL.into_iter().flat_map(|shape| Target::ALL.into_iter().map(move |target| (shape, target)));
    let wanted = shapes.filter(|(shape, target)| *shape == SHOWN.0 || *target == SHOWN.1);
    html! {
        @for (shape, target) in wanted {
            @if let Ok(proved) = Plan::proved(program, shape) {
                details open[(shape, target) == SHOWN] {
                    summary { (shape.name()) ", " (target.name()) }
                    @match emit::emit(&proved, target).map(String::from_utf8) {
                        Ok(Ok(text)) => { (listing(&text, &format!("{shape}.{}", target.name()))) }
                        Ok(Err(binary)) => { p.soft { (binary.as_bytes().len()) " bytes; not a text." } }
                        Err(failure) => { p.warn { "not emitted: " (reason(&failure)) } }
                    }
                }
            }
        }
    }
}

fn listing(text: &str, prefix: &str) -> Markup {
    let mut seen = HashSet::new();
    html! {
        pre.code {
            @for line in text.lines() {
                @match case_of(line) {
                    Some(id) => {
                        @let name = seen.insert(id).then(|| format!("{prefix}-{id}"));
                        a href=(format!("#row-{id}")) id=[name] { (line) }
                    }
                    None => { (line) }
                }
                "\n"
            }
        }
    }
}

/// The case that a comment speaks of, as in `// case 19: ...`.
fn case_of(line: &str) -> Option<u32> {
    let rest = line.trim_start().strip_prefix("// case ")?;
    let end = rest.find(|c: char| !c.is_ascii_digit()).unwrap_or(rest.len());
    rest[..end].parse().ok()
}
