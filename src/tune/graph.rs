//! A plan as a drawn graph: what is tested in which order, and where it leads.

use std::collections::{BTreeSet, HashMap};

use layout::backends::svg::SVGWriter;
use layout::core::base::Orientation;
use layout::core::color::Color;
use layout::core::geometry::Point;
use layout::core::style::StyleAttr;
use layout::std_shapes::shapes::{Arrow, Element, ShapeKind};
use layout::topo::layout::VisualGraph;

use crate::plan::{Plan, Step, StepId};
use crate::program::print::Printer;

/// Most steps that can still be looked at as a picture.
const MAX_STEPS: usize = 120;
/// Longest line of a node, in characters.
const LINE: usize = 38;

/// A drawn plan.
pub(super) struct Graph {
    /// The SVG document.
    pub(super) svg: String,
    /// Whether everything is drawn; else the steps that are farthest from the start are left out.
    pub(super) complete: bool,
}

/// Draws the steps of a plan, from the first one on as far as they can be looked at.
pub(super) fn graph(plan: &Plan<'_>) -> Graph {
    let (steps, complete) = steps(plan);
    let mut drawn = VisualGraph::new(Orientation::TopToBottom);
    let mut handles = HashMap::new();
    for id in &steps {
        let (label, fill) = node(plan, *id);
        let lines = label.split('\n').count() as f64;
        let width = label.split('\n').map(|line| line.chars().count()).max().unwrap_or(1) as f64;
        let look = StyleAttr::new(Color::fast("#5d6470ff"), 1, Some(Color::fast(fill)), 4, 12);
        let size = Point::new(7.2 * width + 18.0, 15.0 * lines + 14.0);
        let element = Element::create(ShapeKind::new_box(&label), look, Orientation::TopToBottom, size);
        handles.insert(*id, drawn.add_node(element));
    }
    for id in &steps {
        for (next, label) in edges(plan, *id) {
            let mut arrow = Arrow::simple(&label);
            arrow.look = StyleAttr::new(Color::fast("#5d6470ff"), 1, None, 0, 11);
            if let Some(next) = handles.get(&next) {
                drawn.add_edge(arrow, handles[id], *next);
            }
        }
    }
    let mut svg = SVGWriter::new();
    drawn.do_it(false, false, false, &mut svg);
    Graph { svg: svg.finalize().replace("Times, serif", "sans-serif"), complete }
}

/// The steps from the root on, nearest first, and whether these are all.
fn steps(plan: &Plan<'_>) -> (Vec<StepId>, bool) {
    let mut found = vec![plan.root()];
    let mut at = 0;
    while let Some(id) = found.get(at).copied() {
        at += 1;
        for (next, _) in edges(plan, id) {
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

fn edges(plan: &Plan<'_>, id: StepId) -> Vec<(StepId, String)> {
    match plan.step(id) {
        Step::Test { then, other, .. } => vec![(*then, "yes".to_owned()), (*other, "no".to_owned())],
        Step::Fetch { next, .. } | Step::Gather { next, .. } => vec![(*next, String::new())],
        Step::Switch { arms } | Step::Coefficients { rest: arms } | Step::Orbit { arms } => {
            let ways: BTreeSet<StepId> = arms.iter().copied().collect();
            ways.into_iter().map(|arm| (arm, String::new())).collect()
        }
        Step::Leaf(_) => Vec::new(),
    }
}

/// What is written on a step, and the colour of its ground.
fn node(plan: &Plan<'_>, id: StepId) -> (String, &'static str) {
    let program = plan.program;
    let printer = Printer { pool: &plan.pool, inputs: &program.inputs };
    match plan.step(id) {
        Step::Test { condition, .. } => (wrap(&printer.cond(*condition)), "#ffffffff"),
        Step::Fetch { input, .. } => (format!("fetch {}", program.inputs[input.index()].name), "#fff0b8ff"),
        Step::Gather { input, condition, .. } => {
            let name = &program.inputs[input.index()].name;
            (format!("fetch {name} if\n{}", wrap(&printer.cond(*condition))), "#fff0b8ff")
        }
        Step::Switch { arms } => (format!("lookup by key:\n{} ways", arms.len()), "#ffffffff"),
        Step::Coefficients { rest } => {
            let sets = plan.coefficients.fits.len();
            (format!("lookup by key:\n{sets} sets of coefficients,\n{} other ways", rest.len()), "#ffffffff")
        }
        Step::Orbit { arms } => {
            (format!("lookup by key:\n{} symmetries,\n{} ways", plan.symmetries.len(), arms.len()), "#ffffffff")
        }
        Step::Leaf(leaf) => {
            let case = leaf.row.map_or("default".to_owned(), |row| format!("case {}", program.rows[row].id));
            let values: Vec<String> = leaf.values.iter().map(|value| printer.expr(*value)).collect();
            (format!("{case}\n{}", wrap(&values.join(", "))), "#e3eef8ff")
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
        assert_eq!(wrap("a b"), "a b");
        assert_eq!(wrap(&"word ".repeat(9)), "word word word word word word word\nword word ");
    }
}
