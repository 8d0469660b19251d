//! The coverage matrix: every state as a small square in the colour of the case
//! that it leads to.

use maud::{Markup, html};

use crate::explain::reach;
use crate::program::claims::Claim;
use crate::program::{InputId, Program};

/// Most states that are drawn.
const MAX_STATES: usize = 4096;
/// Side of a square.
const SIDE: usize = 17;

/// The matrix, or why there is none.
pub fn matrix(program: &Program) -> Markup {
    let states = program.states.count();
    if states > MAX_STATES {
        return html! {
            p { "The table has " (states) " states; a matrix is drawn of at most " (MAX_STATES) "." }
        };
    }
    if program.states.digits().is_empty() {
        return html! { p { "No input is discrete, so there is one state." } };
    }
    let claims = reach::claims(program);
    let (down, across) = split(program);
    let columns: usize = across.iter().map(|(_, count)| count).product();
    let (row_labels, column_labels) = (labels(program, &down), labels(program, &across));
    let widest = |labels: &[String]| labels.iter().map(|label| label.len()).max().unwrap_or(0) * 6 + 12;
    let (left, top) = (widest(&row_labels), widest(&column_labels));
    let (width, height) = (left + columns * SIDE + 8, top + row_labels.len() * SIDE + 8);
    let names = |digits: &[(InputId, usize)]| {
        digits.iter().map(|(id, _)| program.inputs[id.index()].name.as_str()).collect::<Vec<_>>().join(", ")
    };
    html! {
        p {
            "Down: " code { (names(&down)) } ". Across: " code { (names(&across)) } ". "
            "A number is the case that the state leads to; a dot is the default. "
            "Pale squares also depend on inputs that are continuous or fetched."
        }
        figure {
            svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height)
                viewBox=(format!("0 0 {width} {height}")) font-family="ui-monospace, monospace" font-size="10" {
                @for (row, label) in row_labels.iter().enumerate() {
                    text x=(left - 6) y=(top + row * SIDE + 12) text-anchor="end" { (label) }
                }
                @for (column, label) in column_labels.iter().enumerate() {
                    @let (x, y) = (left + column * SIDE + 12, top - 6);
                    text transform=(format!("translate({x} {y}) rotate(-90)")) { (label) }
                }
                @for (state, claim) in claims.iter().enumerate() {
                    g data-state=(state) {
                        (square(program, *claim, left + state % columns * SIDE, top + state / columns * SIDE))
                    }
                }
            }
        }
    }
}

fn square(program: &Program, claim: Option<Claim>, x: usize, y: usize) -> Markup {
    let side = SIDE - 1;
    let Some(Claim { row: index, always }) = claim else {
        return html! {
            rect x=(x) y=(y) width=(side) height=(side) fill="#f4f4f0" {}
            circle cx=(x + side / 2) cy=(y + side / 2) r="1.5" fill="#9aa1ad" {}
        };
    };
    // Steps of the golden angle keep neighbouring cases apart.
    let hue = index * 137 % 360;
    let lightness = if always { 76 } else { 91 };
    let id = program.rows[index].id;
    html! {
        a href=(format!("#row-{id}")) {
            rect x=(x) y=(y) width=(side) height=(side) fill=(format!("hsl({hue} 62% {lightness}%)")) {}
            text x=(x + side / 2) y=(y + 11) text-anchor="middle" font-size="9" fill="#1d1f23" { (id) }
        }
    }
}

/// Discrete inputs, with their number of levels.
type Digits = Vec<(InputId, usize)>;

/// The inputs of a state, in two parts of about as many combinations.
fn split(program: &Program) -> (Digits, Digits) {
    let digits = program.states.digits();
    let mut product = 1;
    let mut at = 0;
    for (_, count) in digits {
        if product * count * product * count > program.states.count() {
            break;
        }
        product *= count;
        at += 1;
    }
    (digits[..at].to_vec(), digits[at..].to_vec())
}

/// The levels of each combination, the last input varying fastest.
fn labels(program: &Program, digits: &[(InputId, usize)]) -> Vec<String> {
    let mut labels = vec![String::new()];
    for (id, count) in digits {
        let input = &program.inputs[id.index()];
        let level = |level: usize| input.show(crate::program::Value::Level(level as u8));
        // `true` and `false` say nothing without the name.
        let word = |number: usize| match level(number).as_str() {
            "true" => input.name.clone(),
            "false" => "-".to_owned(),
            other => other.to_owned(),
        };
        let longer = labels.iter().flat_map(|label| (0..*count).map(move |number| (label, number)));
        labels = longer.map(|(label, number)| format!("{label} {}", word(number)).trim_start().to_owned()).collect();
    }
    labels
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_state_has_its_square() {
        let program = Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"));
        let (down, across) = split(&program);
        assert_eq!((labels(&program, &down).len(), labels(&program, &across).len()), (32, 36));
        assert_eq!(labels(&program, &down)[1], "none none exiting");
        let text = matrix(&program).into_string();
        let squares = text.matches("<a href=\"#row-").count() + text.matches("<circle").count();
        assert_eq!(squares, 1152);
        let svg = &text[text.find("<svg").unwrap_or(0)..text.find("</figure>").unwrap_or(0)];
        let drawn = crate::picture::raster(svg, 1.5).and_then(|picture| crate::picture::png(&picture));
        let drawn = drawn.unwrap_or_else(|e| panic!("{e}"));
        if let Some(folder) = std::env::var_os("UMBRAGE_PICTURES") {
            std::fs::write(std::path::PathBuf::from(folder).join("matrix.png"), drawn).expect("written");
        }
    }
}
