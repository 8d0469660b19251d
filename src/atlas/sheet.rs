//! Panels put together: one drawing, or the parts of a page.

use maud::{Markup, PreEscaped, html};

use super::values::Scale;
use super::{Atlas, PANEL_WIDTH, cell, panel, text};
use crate::diag::visible;
use crate::picture;
use crate::program::Program;
use crate::table::HitPolicy;

/// Space between panels and around them.
const GAP: i32 = 16;
/// Panels side by side in a drawing.
const COLUMNS: usize = 4;

const STYLE: &str = "\
.a-n{font:600 24px sans-serif;fill:#1d1f23}.a-t{font:13.5px sans-serif;fill:#1d1f23}\
.a-m{font:11px monospace;fill:#1d1f23}.a-c{font:10.5px monospace;fill:#5d6470}\
.a-p{font:10px monospace;fill:#0b62a8}.a-s{font:11px sans-serif;fill:#5d6470}\
.a-h{font:600 26px sans-serif;fill:#1d1f23}";

/// A drawing with what every drawing of an atlas refers to.
pub(super) fn document(width: i32, height: i32, body: &str) -> String {
    let markup = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height) viewBox=(format!("0 0 {width} {height}")) {
            style { (PreEscaped(STYLE)) }
            defs {
                pattern id="a-else" width="6" height="6" patternUnits="userSpaceOnUse" {
                    rect width="6" height="6" fill="#f4f6f9" {}
                    path d="M0 6 L6 0" stroke="#b9c0cb" stroke-width="1" {}
                }
                linearGradient id="a-ramp" {
                    stop offset="0" stop-color="#000" {}
                    stop offset="1" stop-color="#fff" {}
                }
            }
            (PreEscaped(body))
        }
    };
    visible(&markup.into_string()).into_owned() + "\n"
}

/// The whole atlas as one drawing: the legend, then the panels in rows.
pub fn svg(program: &Program, atlas: &Atlas) -> String {
    let columns = COLUMNS.min(atlas.panels.len()).max(2) as i32;
    let width = columns * (PANEL_WIDTH + GAP) + GAP;
    let (head, mut y) = head(program, width);
    let mut body = html! { rect width="100%" height="100%" fill="#f6f6f3" {} (head) }.into_string();
    for row in atlas.panels.chunks(columns as usize) {
        let height = row.iter().map(|panel| panel.height).max().unwrap_or(0);
        for (column, panel) in row.iter().enumerate() {
            let x = GAP + column as i32 * (PANEL_WIDTH + GAP);
            let placed = html! {
                g transform=(format!("translate({x} {y})")) {
                    rect width=(PANEL_WIDTH) height=(height) rx="8" fill="#fff" stroke="#dcdcd6" {}
                    (PreEscaped(&panel.body))
                }
            };
            body.push_str(&placed.into_string());
        }
        y += height + GAP;
    }
    document(width, y, &body)
}

/// Title and legend of a drawing, and where the panels begin.
fn head(program: &Program, width: i32) -> (Markup, i32) {
    let title = if program.title.is_empty() { &program.name } else { &program.title };
    let (legend, height) = self::legend_at(program, width);
    let markup = html! {
        text.a-h x=(GAP + 2) y="42" { (title) }
        text.a-t x=(GAP + 2) y="66" fill="#5d6470" { (subtitle(program)) }
        g transform="translate(0 80)" { (legend) }
    };
    (markup, 80 + height + GAP)
}

fn subtitle(program: &Program) -> String {
    let policy = match program.hit_policy {
        HitPolicy::First => "the first that matches counts",
        HitPolicy::Unique => "no two of them contradict",
        HitPolicy::Collect => "the items of all that match",
    };
    let source = if program.origin.is_empty() { String::new() } else { format!("  ({})", program.origin) };
    format!("{} cases, {policy}; {} states{source}", program.rows.len(), program.states.count())
}

/// The meaning of the marks in the panels, as a drawing of its own.
fn legend(program: &Program) -> String {
    let width = COLUMNS as i32 * (PANEL_WIDTH + GAP) + GAP;
    let (markup, height) = legend_at(program, width);
    document(width, height, &markup.into_string())
}

/// An entry of the legend: its drawing, its name, what it is.
struct Entry {
    drawing: Markup,
    name: String,
    doc: String,
}

fn legend_at(program: &Program, width: i32) -> (Markup, i32) {
    let entries = entries(program);
    let columns = ((width - GAP) / (PANEL_WIDTH + GAP)).max(1) as usize;
    let rows = entries.len().div_ceil(columns) as i32;
    const ROW: i32 = 52;
    let height = rows * ROW + 10;
    let markup = html! {
        rect x=(GAP) y="0" width=(width - 2 * GAP) height=(height) rx="8" fill="#fff" stroke="#dcdcd6" {}
        @for (number, entry) in entries.iter().enumerate() {
            @let (row, column) = ((number / columns) as i32, (number % columns) as i32);
            g transform=(format!("translate({} {})", 2 * GAP + column * (PANEL_WIDTH + GAP), 8 + row * ROW)) {
                (entry.drawing)
                text.a-m x="70" y="15" { (entry.name) }
                @for (line, words) in text::wrap_at_most(&entry.doc, 38, 2).iter().enumerate() {
                    text.a-s x="70" y=(29 + 13 * line as i32) { (words) }
                }
            }
        }
    };
    (markup, height)
}

fn entries(program: &Program) -> Vec<Entry> {
    let mut entries = Vec::new();
    if panel::is_grey(program) {
        let scale = Scale::of(program);
        entries.push(Entry {
            drawing: html! { rect x="6" y="14" width="48" height="16" fill="url(#a-ramp)" stroke="#1d1f23" {} },
            name: "value".to_owned(),
            doc: format!("black is {}, white is {}", scale.black, scale.white),
        });
    }
    // Inputs that look alike share an entry; neighbours above all.
    let mut seen: Vec<(Markup, usize)> = Vec::new();
    for (input, draw) in &program.draw {
        let drawing = cell::sample(draw);
        let input = &program.inputs[input.index()];
        if let Some((_, place)) = seen.iter().find(|(other, _)| other.0 == drawing.0) {
            let entry: &mut Entry = &mut entries[*place];
            entry.name = format!("{}, {}", entry.name, input.name);
            continue;
        }
        seen.push((drawing.clone(), entries.len()));
        entries.push(Entry { drawing, name: input.name.clone(), doc: input.doc.clone() });
    }
    entries.push(Entry {
        drawing: html! { rect x="6" y="8" width="28" height="28" fill="url(#a-else)" stroke="#9aa1ad" {} },
        name: "hatched".to_owned(),
        doc: "other cases are taken here".to_owned(),
    });
    entries
}

/// The legend and the panels as parts of a page; each panel can be linked to as `#case-19`.
pub fn html(program: &Program, atlas: &Atlas) -> Markup {
    html! {
        p.soft { (subtitle(program)) }
        figure { (PreEscaped(legend(program))) }
        div style=(format!("display:grid;grid-template-columns:repeat(auto-fill,minmax({}px,1fr));gap:1rem", PANEL_WIDTH + 34)) {
            @for panel in &atlas.panels {
                figure id=(format!("case-{}", panel.id)) style="margin:0;padding:0 1rem" { (PreEscaped(panel.svg())) }
            }
        }
    }
}

/// A page with nothing but the atlas.
pub fn page(program: &Program, atlas: &Atlas) -> String {
    let title = if program.title.is_empty() { &program.name } else { &program.title };
    picture::page(title, html(program, atlas))
}
