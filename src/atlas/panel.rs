//! One panel: the drawing of a case above its text.

use image::RgbaImage;
use maud::{Markup, html};

use super::cell::{CELL, Cell, STUB};
use super::text::{self, LineText};
use super::values::{self, Axes, Scale};
use super::{PANEL_WIDTH, Shown};
use crate::diag::Failure;
use crate::explain::reach::{self, Arrival, Reach};
use crate::program::draw::Draw;
use crate::program::{Domain, Program, Value};
use crate::show::{Precision, sentence};

/// Left and right margin.
const MARGIN: i32 = 18;
/// Characters of formulas that fit on a line, beside a small picture and without.
const NARROW: usize = 36;
const WIDE: usize = 43;
/// Resolution of the large pictures and of the small ones.
const LARGE: u32 = 96;
const SMALL: u32 = 24;

/// Draws the panel of a row; returns the drawing, its height, and what its picture shows.
pub(super) fn draw(
    program: &Program,
    index: usize,
    share: Option<f64>,
    scale: &Scale,
) -> Result<(String, i32, Option<Shown>), Failure> {
    let row = &program.rows[index];
    let reached = reach::reach(program, index);
    let shown = reach::example(program, index).or_else(|| reached.smallest.clone());
    let mut y = 0;
    let heading = heading(row.id, &row.doc, &mut y);
    let mut picture = None;
    let drawing = match &shown {
        Some(arrival) => {
            let (drawing, shown) = self::drawing(program, index, arrival, scale, &mut y)?;
            picture = Some(shown);
            drawing
        }
        None => {
            y += 26;
            html! { text.a-s x=(MARGIN) y=(y - 8) { "no input that leads here was found" } }
        }
    };
    let guard = guard(&text::guard(program, row), &mut y);
    let lines = lines(program, index, &reached, shown.as_ref(), scale, &mut y)?;
    let footing = footing(program, index, &reached, share, &mut y);
    let body = html! { (heading) (drawing) (guard) (lines) (footing) };
    Ok((body.into_string(), y, picture))
}

/// The number of the case and what it is.
fn heading(id: u32, doc: &str, y: &mut i32) -> Markup {
    let left = MARGIN + 14 * id.to_string().len() as i32 + 12;
    let words = text::wrap_at_most(doc, ((PANEL_WIDTH - MARGIN - left) as f64 / 6.3) as usize, 2);
    let first = if words.len() > 1 { 25 } else { 33 };
    *y = 56;
    html! {
        text.a-n x=(MARGIN) y="36" { (id) }
        @for (number, line) in words.iter().enumerate() {
            text.a-t x=(left) y=(first + 17 * number as i32) { (line) }
        }
    }
}

fn drawing(
    program: &Program,
    index: usize,
    arrival: &Arrival,
    scale: &Scale,
    y: &mut i32,
) -> Result<(Markup, Shown), Failure> {
    let axes = Axes::of(program, index);
    let large = values::picture(program, index, &arrival.point, axes, scale, LARGE);
    let image = values::address(&large)?;
    let (sides, runs) = (Cell::has_sides(program), Cell::has_runs(program));
    let stub = if sides { STUB } else { 0 };
    let beside = if runs { 34 } else { 0 };
    let left = (PANEL_WIDTH - CELL - 2 * stub - beside) / 2 + stub;
    let top = *y + stub;
    *y = top + CELL + stub + if runs { 40 } else { 6 };
    let hinted =
        |id| program.draw.iter().any(|(input, draw)| *input == id && matches!(draw, Draw::Across | Draw::Down));
    // Axes that no hint explains are named.
    let named = |id: crate::program::InputId| (!hinted(id)).then(|| program.inputs[id.index()].name.as_str());
    let point = point(program, arrival, axes);
    let constant = axes == Axes { across: None, down: None };
    let across = axes.across.and_then(named);
    if across.is_some() {
        *y += 14;
    }
    let mut at = *y;
    let markup = html! {
        (Cell::new(program, &arrival.point).draw(left, top, &image))
        @if let Some(name) = across {
            text.a-s x=(left + CELL / 2) y=(top + CELL + stub + 15) text-anchor="middle" { (name) }
        }
        @if let Some(name) = axes.down.and_then(named) {
            text.a-s x=(left - stub - 7) y=(top + CELL / 2) text-anchor="end" { (name) }
        }
        @if constant {
            text.a-s x=(left + CELL + stub + 8) y=(top + CELL / 2) {
                (sentence(&program.output, &arrival.values, Precision::F32))
            }
        }
        @for line in text::wrap(&point, 49) {
            text.a-p x=(MARGIN) y=({ at += 14; at }) { (line) }
        }
    };
    *y = at + 4;
    let Axes { across, down } = axes;
    Ok((markup, Shown { point: arrival.point.clone(), across, down, place: [left, top, CELL, CELL] }))
}

/// The point shown, as `--at` takes it, without what is spread out in the picture.
fn point(program: &Program, arrival: &Arrival, axes: Axes) -> String {
    let given = program.input_ids().filter_map(|(id, input)| {
        let value = arrival.point[id.index()]?;
        let spread = [axes.across, axes.down].contains(&Some(id));
        (!spread && input.default != Some(value)).then(|| format!("{}={}", input.name, input.show(value)))
    });
    let given: Vec<String> = given.collect();
    if given.is_empty() { "everything at its default".to_owned() } else { format!("at {}", given.join(", ")) }
}

fn guard(guard: &str, y: &mut i32) -> Markup {
    *y += 8;
    let words = text::wrap_at_most(guard, WIDE - 5, 5);
    let top = *y;
    *y += 15 * words.len() as i32;
    html! {
        text.a-s x=(MARGIN) y=(top + 11) { "when" }
        @for (number, line) in words.iter().enumerate() {
            text.a-m x=(MARGIN + 34) y=(top + 11 + 15 * number as i32) { (line) }
        }
    }
}

fn lines(
    program: &Program,
    index: usize,
    reached: &Reach,
    shown: Option<&Arrival>,
    scale: &Scale,
    y: &mut i32,
) -> Result<Markup, Failure> {
    let texts = text::lines(program, &program.rows[index]);
    let pictures = small_pictures(program, index, reached, shown, scale)?;
    *y += 10;
    let mut parts = Vec::new();
    for (number, LineText { value, condition }) in texts.iter().enumerate() {
        let picture = pictures.get(number).and_then(Option::as_deref);
        let (left, width) = if pictures.is_empty() { (MARGIN, WIDE) } else { (MARGIN + 36, NARROW) };
        let values = text::wrap_at_most(value, width, 4);
        let conditions = match condition.is_empty() {
            true => Vec::new(),
            false => text::wrap_at_most(&format!("if {condition}"), width, 3),
        };
        let top = *y;
        let height = 15 * (values.len() + conditions.len()) as i32;
        *y += height.max(if pictures.is_empty() { 0 } else { 30 }) + 6;
        parts.push(html! {
            @if let Some(address) = picture {
                rect x=(MARGIN) y=(top) width="28" height="28" fill="url(#a-else)" {}
                image x=(MARGIN) y=(top) width="28" height="28" preserveAspectRatio="none" href=(address) {}
                rect x=(MARGIN) y=(top) width="28" height="28" fill="none" stroke="#9aa1ad" {}
            }
            @for (number, line) in values.iter().enumerate() {
                text.a-m x=(left) y=(top + 11 + 15 * number as i32) { (line) }
            }
            @for (number, line) in conditions.iter().enumerate() {
                text.a-c x=(left) y=(top + 11 + 15 * (values.len() + number) as i32) { (line) }
            }
        });
    }
    Ok(html! { @for part in &parts { (part) } })
}

/// A small picture for each line, where lines do not share one anyway.
fn small_pictures(
    program: &Program,
    index: usize,
    reached: &Reach,
    shown: Option<&Arrival>,
    scale: &Scale,
) -> Result<Vec<Option<String>>, Failure> {
    let row = &program.rows[index];
    // Lines that are told apart by the axes are parts of one picture.
    let open = row.lines.iter().any(|line| {
        let inputs = program.pool.cond_facts(line.condition).inputs;
        inputs.iter().any(|input| matches!(program.inputs[input.index()].domain, Domain::Discrete(_)))
    });
    if row.lines.len() < 2 || !open {
        return Ok(Vec::new());
    }
    let axes = Axes::of(program, index);
    let small = |arrival: &Option<Arrival>| -> Result<Option<String>, Failure> {
        let Some(arrival) = arrival else { return Ok(None) };
        let point = like(program, arrival, shown);
        let picture: RgbaImage = values::picture(program, index, &point, axes, scale, SMALL);
        values::address(&picture).map(Some)
    };
    reached.lines.iter().map(small).collect()
}

/// The point of a line, with the numbers of the point that the panel shows.
fn like(program: &Program, arrival: &Arrival, shown: Option<&Arrival>) -> Vec<Option<Value>> {
    let mut point = arrival.point.clone();
    if let Some(shown) = shown {
        for (id, input) in program.input_ids() {
            if matches!(input.domain, Domain::Continuous { .. } | Domain::Word) && input.fetched.is_none() {
                point[id.index()] = shown.point[id.index()];
            }
        }
    }
    point
}

/// The section of the case, and its share.
fn footing(program: &Program, index: usize, reached: &Reach, share: Option<f64>, y: &mut i32) -> Markup {
    let row = &program.rows[index];
    // A line number would change with every line above it; the section says the same.
    let place = match row.section.is_empty() {
        true => format!("line {}", program.line(row.span)),
        false => format!("section {}", row.section),
    };
    let states = match (reached.states.len(), program.states.count()) {
        (1, all) => format!("1 of {all} states"),
        (some, all) => format!("{some} of {all} states"),
    };
    let top = *y + 4;
    *y = top + 24 + if share.is_some() { 16 } else { 0 };
    let width = PANEL_WIDTH - 2 * MARGIN;
    html! {
        line x1=(MARGIN) y1=(top) x2=(PANEL_WIDTH - MARGIN) y2=(top) stroke="#e4e4de" {}
        text.a-s x=(MARGIN) y=(top + 15) { (place) }
        text.a-s x=(PANEL_WIDTH - MARGIN) y=(top + 15) text-anchor="end" { (states) }
        @if let Some(share) = share {
            rect x=(MARGIN) y=(top + 23) width=(width - 60) height="6" rx="3" fill="#ecece6" {}
            rect x=(MARGIN) y=(top + 23) width=((share * f64::from(width - 60)).round() as i32) height="6" rx="3" fill="#0072b2" {}
            text.a-s x=(PANEL_WIDTH - MARGIN) y=(top + 30) text-anchor="end" { (format!("{:.2} %", share * 100.0)) }
        }
    }
}

/// Returns whether results are greys between black and white, so that a scale can be shown.
pub(super) fn is_grey(program: &Program) -> bool {
    program.output.is_number()
}
