//! The search for a point at which an operation fails: in smaller and smaller parts of the domain.

use super::orbit::chosen;
use super::point::Point;
use super::real::{Laid, Trouble};
use crate::analyse::sets::Set;
use crate::analyse::sets::study::Study;
use crate::diag::{Diagnostic, Span, codes};
use crate::program::{Domain, ExprId, Node, Pool, Program, Real};

/// Most boxes that are looked at.
const MAX_BOXES: usize = 1024;

/// The extent of a box in which nothing more will be told apart.
const SMALL: f64 = 1e-6;

/// The end of a search for trouble.
pub(in crate::analyse) enum Search {
    /// An operation fails at a point, or, if that is not known of the point itself, beside it.
    Found {
        /// The operation.
        trouble: Trouble,
        /// The point.
        point: Point,
        /// It fails at this very point.
        exact: bool,
    },
    /// No operation fails.
    Nothing,
    /// Out of patience.
    Unknown,
}

/// The place of a value in a program.
pub(in crate::analyse) struct Asked<'a> {
    /// The value as it is written, with its selections.
    pub(in crate::analyse) written: ExprId,
    /// The row that it belongs to; none for the default.
    pub(in crate::analyse) row: Option<usize>,
    /// Returns whether the program comes to it at a point.
    pub(in crate::analyse) reached: &'a dyn Fn(&Point) -> bool,
}

/// A point of a set at which an operation in `value` fails, which is `asked.written` without its selections there.
pub(in crate::analyse) fn search(study: &mut Study<'_>, set: Set, value: ExprId, asked: &Asked<'_>) -> Search {
    let program = study.program;
    let inputs = study.space.pool.expr_facts(value).inputs;
    let laid = Laid::new(&study.space.pool, value);
    // What it takes to ask at one point: the way there, and both forms of the value.
    let asking = study.work_to(asked.row) + laid.work() + study.space.pool.expr_facts(asked.written).size as usize;
    let Some(whole) = study.space.around(set) else { return Search::Nothing };
    let mut pending = std::collections::VecDeque::from([whole]);
    let mut looked = 0;
    while let Some(part) = pending.pop_front() {
        if !study.space.sets.budget().compute(laid.work()) {
            return Search::Unknown;
        }
        let (_, Some(trouble)) = laid.over(&part) else { continue };
        if !study.space.can_be_in(set, &part) {
            continue;
        }
        let mut beside = Vec::new();
        let mut corners = 0;
        for numbers in part.corners(inputs) {
            if !study.space.sets.budget().compute(asking) {
                return Search::Unknown;
            }
            corners += 1;
            let Some(witness) = study.space.with_numbers(set, &numbers) else { continue };
            // What is not linear was taken to be possible, so the program itself is asked.
            let point = Point::of(program, &witness);
            if !(asked.reached)(&point) {
                continue;
            }
            let taken = chosen(&mut study.space.pool, asked.written, &point);
            if taken == value && laid.fails_at(&point.numbers) {
                return Search::Found { trouble, point, exact: true };
            }
            beside.push((point, taken == value));
        }
        looked += 1;
        if part.width(inputs) < SMALL {
            // All around lies in the set, and no smaller box will tell.
            if beside.len() == corners && beside.iter().all(|(_, taken)| *taken) {
                let rounded =
                    beside.iter().find_map(|(point, _)| fails_nearby(program, &study.space.pool, value, point));
                let exact = rounded.as_ref().filter(|point| (asked.reached)(point)).cloned();
                let middle = beside.swap_remove(0).0;
                let exactly = exact.is_some();
                return Search::Found { trouble, point: exact.unwrap_or(middle), exact: exactly };
            }
            continue;
        }
        if looked >= MAX_BOXES {
            return Search::Unknown;
        }
        pending.extend(part.halves(inputs));
    }
    Search::Nothing
}

/// The note on a search that ran out of patience, about something that can leave the numbers.
pub(in crate::analyse) fn undecided(name: &str, span: Span) -> Diagnostic {
    let message = format!("whether {name} can leave the numbers was not decided");
    Diagnostic::note(codes::NOT_ANALYSED, message)
        .at(span, "")
        .help(format!("it depends on too many inputs at once: {MAX_BOXES} parts of the domain were looked at"))
}

/// A point beside another one, with numbers that an `f32` is, at which the value is not finite in `f32`.
fn fails_nearby(program: &Program, pool: &Pool, value: ExprId, point: &Point) -> Option<Point> {
    [f32::next_down as fn(f32) -> f32, |number| number, f32::next_up].into_iter().find_map(|beside| {
        let mut near = point.clone();
        for (id, input) in program.input_ids() {
            // A word has no neighbour that is nearer than another word.
            if let Domain::Continuous { lo, hi, .. } = input.domain {
                let number = &mut near.numbers[id.index()];
                *number = f64::from(beside(*number as f32)).clamp(lo, hi);
            }
        }
        fails(pool, value, &near).is_none().then_some(near)
    })
}

/// The value in `f32`, unless something on the way is not finite.
fn fails(pool: &Pool, value: ExprId, point: &Point) -> Option<f32> {
    let at = |part| fails(pool, part, point);
    let result = match pool.node(value) {
        Node::Const(number) => number.get() as f32,
        Node::Word(word) => f32::from_word(word),
        Node::Input(input) if pool.is_word(value) => f32::from_word(point.numbers[input.index()] as u32),
        Node::Input(input) => point.numbers[input.index()] as f32,
        Node::Index(input) => f32::from(point.levels[input.index()]),
        Node::Result(_) => return None,
        Node::Unary(op, a) => f32::unary(op, at(a)?),
        Node::Binary(op, a, b) => f32::binary(op, at(a)?, at(b)?),
        Node::Ternary(op, a, b, c) => f32::ternary(op, at(a)?, at(b)?, at(c)?),
        Node::Select(condition, a, b) => at(if point.holds(pool, condition) { a } else { b })?,
    };
    (pool.is_word(value) || result.is_finite()).then_some(result)
}
