//! A plan as a drawn graph: what is tested in which order, and where it leads.
//!
//! Drawn as programs are read. What follows a test that does not hold stands below it, what
//! follows one that holds to the right, so that a chain runs straight down, nothing crosses and
//! any size can be scrolled through. A step that several others lead to has a number, and is
//! drawn where it is first come to.

use std::collections::{BTreeSet, HashMap, HashSet};

use maud::{Markup, html};

use crate::plan::{Plan, Step, StepId};
use crate::program::print::Printer;

/// Most steps that can still be looked at as a picture.
const MAX_STEPS: usize = 600;
/// Longest line of a node, in characters.
const LINE: usize = 38;
/// Sizes in pixels: of a character, of a line, between steps side by side and one below the other.
const CHARACTER: f64 = 7.6;
const LINE_HEIGHT: f64 = 15.0;
const BESIDE: f64 = 44.0;
const BELOW: f64 = 22.0;
/// From a corner of a step to where lines begin and end.
const CORNER: f64 = 13.0;

/// A drawn plan.
pub(super) struct Graph {
    /// The SVG element.
    pub(super) svg: String,
    /// True if everything is drawn; else the steps that are farthest from the start are left out.
    pub(super) complete: bool,
}

/// Draws the steps of a plan, from the first one on as far as they can be looked at.
pub(super) fn graph(plan: &Plan<'_>) -> Graph {
    let (steps, complete) = steps(plan);
    let mut led_to: HashMap<StepId, usize> = HashMap::new();
    for next in steps.iter().flat_map(|step| next(plan, *step)) {
        *led_to.entry(next).or_default() += 1;
    }
    let shared = steps.iter().filter(|step| led_to.get(step) > Some(&1) && !matches!(plan.step(**step), Step::Leaf(_)));
    let mut drawing = Drawing {
        plan,
        numbers: shared.enumerate().map(|(number, step)| (*step, number + 1)).collect(),
        drawn: steps.into_iter().collect(),
        done: HashSet::new(),
        parts: Vec::new(),
        width: 0.0,
    };
    let height = drawing.place(plan.root(), 1.0, 1.0) + 1.0;
    let size = format!("0 0 {} {height}", drawing.width + 1.0);
    let svg = html! {
        svg xmlns="http://www.w3.org/2000/svg" width=(drawing.width + 1.0) height=(height) viewBox=(size)
            font-family="sans-serif" font-size="12" fill="none" stroke="#5d6470" {
            defs {
                marker id="arrow" viewBox="0 0 8 8" refX="8" refY="4" markerWidth="8" markerHeight="8" orient="auto" {
                    path d="M0 0 L8 4 L0 8 z" fill="#5d6470" stroke="none" {}
                }
            }
            @for part in &drawing.parts { (part) }
        }
    };
    Graph { svg: svg.into_string(), complete }
}

struct Drawing<'a, 'p> {
    plan: &'a Plan<'p>,
    /// The steps to be drawn.
    drawn: HashSet<StepId>,
    /// Numbers of those that several others lead to.
    numbers: HashMap<StepId, usize>,
    done: HashSet<StepId>,
    parts: Vec<Markup>,
    width: f64,
}

impl Drawing<'_, '_> {
    /// Draws a step with its corner at a place, and all that follows. Returns how far down that reaches.
    fn place(&mut self, id: StepId, x: f64, y: f64) -> f64 {
        let number = self.numbers.get(&id).copied();
        if !self.drawn.contains(&id) {
            return self.cell("...", "#ffffff", None, x, y).1;
        }
        if let Some(number) = number
            && !self.done.insert(id)
        {
            return self.cell(&format!("to [{number}]"), "#ffffff", Some(number), x, y).1;
        }
        let (label, fill) = node(self.plan, id);
        let label = number.map_or(label.clone(), |number| format!("[{number}] {label}"));
        let (right, mut bottom) = self.cell(&label, fill, None, x, y);
        if let Some(number) = number
            && let Some(cell) = self.parts.pop()
        {
            self.parts.push(html! { g id=(format!("step-{number}")) { (cell) } });
        }
        let from = bottom;
        match self.plan.step(id) {
            Step::Test { then, other, .. } => {
                self.arrow(&format!("M{right} {} H{}", y + CORNER, right + BESIDE), "yes", (right + 8.0, y + 9.0));
                bottom = self.place(*then, right + BESIDE, y).max(bottom) + BELOW;
                self.arrow(&format!("M{} {from} V{bottom}", x + CORNER), "no", (x + CORNER + 5.0, from + 14.0));
                self.place(*other, x, bottom)
            }
            Step::Fetch { next, .. } | Step::Gather { next, .. } => {
                bottom += BELOW;
                self.arrow(&format!("M{} {from} V{bottom}", x + CORNER), "", (x, y));
                self.place(*next, x, bottom)
            }
            Step::Switch { .. } | Step::Coefficients { .. } | Step::Orbit { .. } => {
                for next in next(self.plan, id) {
                    let at = bottom + BELOW;
                    let line = format!("M{} {from} V{} H{}", x + CORNER, at + CORNER, x + CORNER + BESIDE);
                    self.arrow(&line, "", (x, y));
                    bottom = self.place(next, x + CORNER + BESIDE, at);
                }
                bottom
            }
            Step::Leaf(_) => bottom,
        }
    }

    /// A box with text; returns its right and lower ends.
    fn cell(&mut self, label: &str, fill: &str, to: Option<usize>, x: f64, y: f64) -> (f64, f64) {
        let lines: Vec<&str> = label.split('\n').collect();
        let longest = lines.iter().map(|line| line.chars().count()).max().unwrap_or(1);
        let (width, height) = (CHARACTER * longest as f64 + 16.0, LINE_HEIGHT * lines.len() as f64 + 11.0);
        let inside = html! {
            rect x=(x) y=(y) width=(width) height=(height) rx="4" fill=(fill) stroke-dasharray=[to.map(|_| "3 3")] {}
            @for (number, line) in lines.iter().enumerate() {
                text x=(x + 8.0) y=(y + 17.0 + LINE_HEIGHT * number as f64) fill="#1d1f23" stroke="none" { (line) }
            }
        };
        self.parts.push(match to {
            Some(number) => html! { a href=(format!("#step-{number}")) { (inside) } },
            None => inside,
        });
        self.width = self.width.max(x + width);
        (x + width, y + height)
    }

    fn arrow(&mut self, path: &str, label: &str, (x, y): (f64, f64)) {
        self.parts.push(html! {
            path d=(path) marker-end="url(#arrow)" {}
            @if !label.is_empty() {
                text x=(x) y=(y) font-size="11" fill="#5d6470" stroke="none" { (label) }
            }
        });
    }
}

/// The steps from the root on, nearest first, and whether these are all.
fn steps(plan: &Plan<'_>) -> (Vec<StepId>, bool) {
    let mut found = vec![plan.root()];
    let mut at = 0;
    while let Some(id) = found.get(at).copied() {
        at += 1;
        for next in next(plan, id) {
            if found.contains(&next) {
                continue;
            }
            if found.len() >= MAX_STEPS {
                return (found, false);
            }
            found.push(next);
        }
    }
    (found, true)
}

/// The steps that come next, each once.
fn next(plan: &Plan<'_>, id: StepId) -> BTreeSet<StepId> {
    plan.step(id).next().into_iter().collect()
}

/// The text on a step, and the colour of its ground.
fn node(plan: &Plan<'_>, id: StepId) -> (String, &'static str) {
    let program = plan.program;
    let printer = Printer { pool: &plan.pool, inputs: &program.inputs };
    match plan.step(id) {
        Step::Test { condition, .. } => (wrap(&printer.cond(*condition)), "#ffffff"),
        Step::Fetch { input, .. } => (format!("fetch {}", program.inputs[input.index()].name), "#fff0b8"),
        Step::Gather { input, condition, .. } => {
            let name = &program.inputs[input.index()].name;
            (format!("fetch {name} if\n{}", wrap(&printer.cond(*condition))), "#fff0b8")
        }
        Step::Switch { arms } => (format!("lookup by key:\n{} ways", arms.len()), "#ffffff"),
        Step::Coefficients { rest } => {
            let sets = plan.coefficients.fits.len();
            (format!("lookup by key:\n{sets} sets of coefficients,\n{} other ways", rest.len()), "#ffffff")
        }
        Step::Orbit { arms } => {
            (format!("lookup by key:\n{} symmetries,\n{} ways", plan.symmetries.len(), arms.len()), "#ffffff")
        }
        Step::Leaf(leaf) => {
            let case = leaf.row.map_or("default".to_owned(), |row| format!("case {}", program.rows[row].id));
            let values: Vec<String> = leaf.values.iter().map(|value| printer.expr(*value)).collect();
            (format!("{case}\n{}", wrap(&values.join(", "))), "#e3eef8")
        }
    }
}

/// Breaks a text into few lines at blanks.
fn wrap(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.len() - 1;
        if !lines[last].is_empty() && lines[last].len() + word.len() >= LINE {
            if lines.len() == 4 {
                lines[last].push_str(" ...");
                break;
            }
            lines.push(word.to_owned());
        } else {
            if !lines[last].is_empty() {
                lines[last].push(' ');
            }
            lines[last].push_str(word);
        }
    }
    lines.join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Shape;
    use crate::program::Program;

    #[test]
    fn plans_are_drawn_with_their_tests_and_cases() {
        let program = Program::read("tables/smsr.ron").unwrap_or_else(|e| panic!("{e}"));
        let plan = Plan::new(&program, Shape::Ladder).unwrap_or_else(|e| panic!("{e}"));
        let Graph { svg, complete } = graph(&plan);
        assert!(complete && svg.contains("<svg") && svg.contains("case 12"), "{svg}");
        let program = Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"));
        for shape in Shape::ALL {
            let plan = Plan::new(&program, shape).unwrap_or_else(|e| panic!("{e}"));
            let Graph { svg, .. } = graph(&plan);
            // Every step that another place refers to is there.
            for reference in svg.split("href=\"#").skip(1).filter_map(|rest| rest.split('"').next()) {
                assert!(svg.contains(&format!("id=\"{reference}\"")), "{shape}: {reference}");
            }
        }
        assert_eq!(wrap("a b"), "a b");
        assert_eq!(wrap(&"word ".repeat(9)), "word word word word word word word\nword word ");
    }
}
