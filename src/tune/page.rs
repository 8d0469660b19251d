//! The result of a tuning as a page: frequencies, times, and the chosen decision drawn.

use maud::{Markup, PreEscaped, html};

use super::graph::graph;
use super::{Kind, Tuning};
use crate::picture;
use crate::picture::plot::{Axis, Bars, Frame, Scale, bars};
use crate::plan::Weights;
use crate::profile::chart;
use crate::program::Program;

/// The report of a tuning as one self-contained HTML file.
pub fn page(program: &Program, tuning: &Tuning<'_>, weights: &Weights) -> String {
    let chosen = &tuning.plans[tuning.chosen];
    let name = chosen.candidate.name();
    let drawn = graph(chosen.proved.plan());
    let body = html! {
        p.lead { (program.title) }
        table {
            (row("device", &tuning.device))
            (row("table", &format!("{}, {}, {} cases", program.source.name, program.fingerprint(), program.rows.len())))
            (row("profile", weights.origin()))
            (row("measured", &tuning.method()))
            (row("chosen", &name))
            (row("proof", &chosen.proved.proof().to_string()))
            @for plan in &tuning.plans {
                @if let Some(certificate) = &plan.proved.plan().certificate {
                    (row(&plan.candidate.name(), &certificate.to_string()))
                }
            }
        }
        p {
            "A plan is a way to reach the cases of the table; each one listed here was proved equal to the table and "
            "compared with the interpreter on this device. Chosen is the fastest on captured inputs, and among those "
            "that noise does not tell from it the simplest."
            @if !tuning.is_clear() { " The choice does not differ from the ladder as written by more than noise." }
        }
        h2 { "Times" }
        figure { (PreEscaped(times(tuning))) }
        @for (kind, floor) in Kind::ALL.into_iter().zip(&tuning.floor) { (ranking(tuning, kind, floor.median())) }
        (whole_shaders(tuning))
        @if !tuning.skipped.is_empty() || !tuning.wrong.is_empty() {
            h2 { "Left out" }
            ul {
                @for (candidate, reason) in &tuning.skipped { li { code { (candidate.name()) } ": " (reason) } }
                @for (candidate, reason) in &tuning.wrong {
                    li.bad { code { (candidate.name()) } " gives wrong results on this device: " (reason) }
                }
            }
        }
        h2 { "Frequencies" }
        figure { (PreEscaped(chart(&tuning.profile.profile))) }
        h2 { "The decision" }
        p { "The plan " code { (name) } ": tests are white, fetches yellow, cases blue. Where a test holds it goes on to the right, else below; a number in brackets is a step that several others lead to."
            @if !drawn.complete { " It is too large to be drawn as a whole; this is how it begins." } }
        figure.large { (PreEscaped(&drawn.svg)) }
    };
    picture::page(&format!("Tuning of {}", program.name), body)
}

fn row(name: &str, value: &str) -> Markup {
    html! { tr { th { (name) } td { (value) } } }
}

fn ranking(tuning: &Tuning<'_>, kind: Kind, floor: f64) -> Markup {
    html! {
        h3 { (kind.name()) " inputs" }
        p.soft { "Reading and writing them alone, the floor, takes " (format!("{:.1}", 1e6 * floor)) " µs." }
        table {
            tr { th { "plan" } th.n { "µs" } th.n { "± µs" } th.n { "to the ladder" } th.n { "to the floor" } th { "" } }
            @for line in tuning.ranking(kind) {
                tr {
                    td { code { (tuning.plans[line.plan].candidate.name()) } @if line.plan == tuning.chosen { " (chosen)" } }
                    td.n { (format!("{:.1}", line.us)) }
                    td.n { (format!("{:.1}", line.uncertainty)) }
                    td.n { (format!("{:.3}", line.vs_ladder)) }
                    td.n { (format!("{:.2}", line.vs_floor)) }
                    td.soft { @if !line.differs && line.plan != 0 { "within noise of the ladder" } }
                }
            }
        }
    }
}

/// The plans in whole shaders, if that was measured.
fn whole_shaders(tuning: &Tuning<'_>) -> Markup {
    let name = |plan: usize| tuning.plans[plan].candidate.name();
    html! {
        @if !tuning.whole.is_empty() {
            h2 { "In whole shaders" }
            p { "The time of the whole shadow pass relative to that with the ladder as written." }
            table {
                tr {
                    th { "frame" } th { "pass" }
                    @for plan in &tuning.plans { th.n { code { (plan.candidate.name()) } } }
                }
                @for whole in &tuning.whole {
                    tr {
                        td { (whole.frame) }
                        td { (whole.pass) }
                        @for plan in 0..whole.times.len() { td.n { (format!("{:.3}", whole.vs_ladder(plan))) } }
                    }
                }
            }
            @for whole in &tuning.whole {
                @let faster: Vec<String> = whole.faster_than(tuning.chosen).into_iter().map(name).collect();
                @if !faster.is_empty() {
                    p.bad { (whole.frame) ", " (whole.pass) ": faster than the chosen plan: " (faster.join(", ")) }
                }
            }
            @if tuning.whole.iter().all(|whole| whole.faster_than(tuning.chosen).is_empty()) {
                p { "Nowhere is a plan faster than the chosen one by more than noise." }
            }
        }
    }
}

/// Times relative to the ladder as written, by plan and kind of input.
fn times(tuning: &Tuning<'_>) -> String {
    let categories: Vec<String> = tuning.plans.iter().map(|plan| plan.candidate.name()).collect();
    let series = Kind::ALL.map(|kind| {
        let mut lines = tuning.ranking(kind);
        lines.sort_by_key(|line| line.plan);
        let ladder = lines.first().map_or(f64::NAN, |line| line.us);
        Bars {
            name: kind.name().to_owned(),
            values: lines.iter().map(|line| line.vs_ladder).collect(),
            spread: lines
                .iter()
                .map(|line| ((line.us - line.uncertainty) / ladder, (line.us + line.uncertainty) / ladder))
                .collect(),
        }
    });
    let axis = |label: &str| Axis { label: label.to_owned(), scale: Scale::Linear };
    let frame = Frame {
        title: "Time relative to the ladder as written (lower is better)".to_owned(),
        x: axis("plan"),
        y: axis("time / ladder"),
        size: (980, 420),
    };
    bars(&frame, &categories, &series)
}
