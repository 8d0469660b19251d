//! The drawing in a panel: a cell with its value, its neighbours, and the marks
//! that the table's hints ask for.

use maud::{Markup, html};

use crate::program::draw::Draw;
use crate::program::{InputId, Program, Value};
use crate::table::draw::Side;

/// Side of the cell.
pub(super) const CELL: i32 = 104;
/// The visible part of each neighbour.
pub(super) const STUB: i32 = 46;

const INK: &str = "#1d1f23";
const LIGHT: &str = "#fbf0c8";
const DARK: &str = "#4a5364";
const MARK: &str = "#d9480f";

const SIDES: [Side; 4] = [Side::Left, Side::Right, Side::Top, Side::Bottom];

/// A point as the hints draw it.
pub(super) struct Cell<'p> {
    program: &'p Program,
    point: &'p [Option<Value>],
}

/// A rectangle: left, top, width, height.
#[derive(Clone, Copy)]
struct Rect(i32, i32, i32, i32);

impl Rect {
    /// The middle of a side, and the direction outwards.
    fn side(self, side: Side) -> ((i32, i32), (i32, i32)) {
        let Rect(x, y, w, h) = self;
        match side {
            Side::Left => ((x, y + h / 2), (-1, 0)),
            Side::Right => ((x + w, y + h / 2), (1, 0)),
            Side::Top => ((x + w / 2, y), (0, -1)),
            Side::Bottom => ((x + w / 2, y + h), (0, 1)),
        }
    }

    /// The visible part of the neighbour at a side.
    fn neighbour(self, side: Side) -> Self {
        let Rect(x, y, w, h) = self;
        match side {
            Side::Left => Rect(x - STUB, y, STUB, h),
            Side::Right => Rect(x + w, y, STUB, h),
            Side::Top => Rect(x, y - STUB, w, STUB),
            Side::Bottom => Rect(x, y + h, w, STUB),
        }
    }
}

impl<'p> Cell<'p> {
    pub(super) fn new(program: &'p Program, point: &'p [Option<Value>]) -> Self {
        Self { program, point }
    }

    /// Returns whether the table has runs, which need room beside the cell.
    pub(super) fn has_runs(program: &Program) -> bool {
        program.draw.iter().any(|(_, draw)| matches!(draw, Draw::Run { .. }))
    }

    /// Returns whether anything is said of the sides, so that there are neighbours to be seen.
    pub(super) fn has_sides(program: &Program) -> bool {
        program.draw.iter().any(|(_, draw)| matches!(draw, Draw::Sides { .. }))
    }

    fn level(&self, input: InputId) -> Option<usize> {
        match self.point[input.index()] {
            Some(Value::Level(level)) => Some(usize::from(level)),
            _ => None,
        }
    }

    /// The sides that an input marks here.
    fn sides(&self, input: InputId) -> &'p [Side] {
        let hint = self.program.draw.iter().find(|(other, _)| *other == input);
        match (hint, self.level(input)) {
            (Some((_, Draw::Sides { levels, .. })), Some(level)) => &levels[level],
            _ => &[],
        }
    }

    /// All sides of the cell that are marked, and whether strongly.
    fn marked(&self) -> Vec<(Side, bool)> {
        let mut marked = Vec::new();
        for (input, draw) in &self.program.draw {
            if !matches!(draw, Draw::Sides { of: None, .. }) {
                continue;
            }
            let strong = self
                .program
                .draw
                .iter()
                .any(|(condition, draw)| *draw == Draw::Strong(*input) && self.level(*condition) == Some(1));
            marked.extend(self.sides(*input).iter().map(|side| (*side, strong)));
        }
        marked
    }

    fn dark(&self) -> bool {
        self.program.draw.iter().any(|(input, draw)| match (draw, self.level(*input)) {
            (Draw::Dark(levels), Some(level)) => levels.contains(level as u8),
            _ => false,
        })
    }

    /// The drawing, with the cell's upper left corner at a place. `image` is the address of its value.
    pub(super) fn draw(&self, x: i32, y: i32, image: &str) -> Markup {
        let cell = Rect(x, y, CELL, CELL);
        let marked = self.marked();
        let tone = |dark: bool| if dark { DARK } else { LIGHT };
        html! {
            @if Self::has_sides(self.program) {
                @for side in SIDES {
                    @let Rect(x, y, w, h) = cell.neighbour(side);
                    @let opposite = marked.iter().any(|(other, _)| *other == side);
                    rect x=(x) y=(y) width=(w) height=(h) fill=(tone(self.dark() != opposite)) stroke="#9aa1ad" {}
                }
            }
            rect x=(x) y=(y) width=(CELL) height=(CELL) fill="url(#a-else)" {}
            image x=(x) y=(y) width=(CELL) height=(CELL) preserveAspectRatio="none" href=(image) {}
            rect x=(x) y=(y) width=(CELL) height=(CELL) fill="none" stroke=(INK) stroke-width="2" {}
            @for (side, strong) in &marked { (arrow(cell, *side, if *strong { 2 } else { 1 })) }
            @for (input, draw) in &self.program.draw {
                @if let Draw::Sides { of: Some(of), .. } = draw {
                    @for side in self.sides(*input) { (arrow(cell.neighbour(*of), *side, 0)) }
                }
            }
            (self.runs(cell))
        }
    }

    /// Runs along marked sides: a line with its ends, and the position in it.
    fn runs(&self, cell: Rect) -> Markup {
        let Rect(x, y, ..) = cell;
        html! {
            @for (input, draw) in &self.program.draw {
                @if let Draw::Run { along, ends } = draw {
                    @if let Some(first) = self.sides(*along).first() {
                        @if let Some(closed) = self.level(*input).and_then(|level| ends[level]) {
                            @let horizontal = matches!(first, Side::Top | Side::Bottom);
                            @let (x, y) = match horizontal {
                                true => (x - STUB + 6, y + CELL + STUB + 18),
                                false => (x + CELL + STUB + 18, y - STUB + 6),
                            };
                            (self.run(*input, closed, (x, y), horizontal))
                        }
                    }
                }
            }
        }
    }

    fn run(&self, run: InputId, closed: u8, (x, y): (i32, i32), horizontal: bool) -> Markup {
        const LENGTH: i32 = CELL + 2 * STUB - 12;
        let at = |along: i32, across: i32| if horizontal { (x + along, y + across) } else { (x + across, y + along) };
        let (end_x, end_y) = at(LENGTH, 0);
        let position = self.program.draw.iter().find(|(_, draw)| *draw == Draw::Position(run));
        let position = position.and_then(|(input, _)| match self.point[input.index()] {
            Some(Value::Number(value)) => Some((&self.program.inputs[input.index()], value)),
            _ => None,
        });
        html! {
            line x1=(x) y1=(y) x2=(end_x) y2=(end_y) stroke=(INK) stroke-width="2" {}
            @for (along, closed) in [(0, closed >= 2), (LENGTH, closed >= 1)] {
                @let (x, y) = at(along, 0);
                @if closed {
                    rect x=(x - 5) y=(y - 5) width="10" height="10" fill=(INK) {}
                } @else {
                    circle cx=(x) cy=(y) r="4.5" fill="#fff" stroke=(INK) stroke-width="1.8" {}
                }
            }
            @if let Some((input, value)) = position {
                @let along = (f64::from(LENGTH) * value.clamp(0.0, 1.0)).round() as i32;
                @let (tip, left, right) = (at(along, -3), at(along - 5, -12), at(along + 5, -12));
                polygon points=(format!("{},{} {},{} {},{}", tip.0, tip.1, left.0, left.1, right.0, right.1)) fill="#0b62a8" {}
                @let label = format!("{} = {}", input.name, (value * 1e4).round() / 1e4);
                @if horizontal {
                    text.a-s x=(x + along) y=(y + 17) text-anchor=(anchor(along, LENGTH)) { (label) }
                } @else {
                    // Beside a vertical run there is room for one word a line.
                    @for (number, word) in label.split(" = ").enumerate() {
                        text.a-s x=(x + 9) y=(y + along.clamp(8, LENGTH - 10) + 12 * number as i32) { (word) }
                    }
                }
            }
        }
    }
}

/// Keeps a label between the ends of its run.
fn anchor(along: i32, length: i32) -> &'static str {
    match along {
        _ if along < 30 => "start",
        _ if along > length - 30 => "end",
        _ => "middle",
    }
}

/// An arrow outwards over a side. Strength 0 is for neighbours.
fn arrow(rect: Rect, side: Side, strength: i32) -> Markup {
    let ((x, y), (dx, dy)) = rect.side(side);
    let (inside, outside, half, width) = [(6, 9, 4, "2"), (10, 22, 7, "3"), (12, 28, 9, "6")][strength as usize];
    let (from_x, from_y) = (x - dx * inside, y - dy * inside);
    let (to_x, to_y) = (x + dx * outside, y + dy * outside);
    // The head begins where the shaft ends.
    let back = half + half / 2;
    let (neck_x, neck_y) = (to_x - dx * back, to_y - dy * back);
    let points = format!(
        "{to_x},{to_y} {},{} {},{}",
        neck_x + dy * half,
        neck_y + dx * half,
        neck_x - dy * half,
        neck_y - dx * half
    );
    html! {
        g stroke="#fff" stroke-width="2" paint-order="stroke" {
            line x1=(from_x) y1=(from_y) x2=(neck_x) y2=(neck_y) stroke="#fff" stroke-width=(format!("{}", strength * 2 + 4)) {}
            polygon points=(points) fill=(MARK) {}
            line x1=(from_x) y1=(from_y) x2=(neck_x) y2=(neck_y) stroke=(MARK) stroke-width=(width) {}
        }
    }
}

/// A small drawing of what a hint looks like, 60 wide and 44 high, for the legend.
pub(super) fn sample(draw: &Draw) -> Markup {
    let cell = Rect(8, 8, 28, 28);
    html! {
        @match draw {
            Draw::Across => { (axis(cell, true)) }
            Draw::Down => { (axis(cell, false)) }
            Draw::Sides { of: None, levels } => {
                @let side = levels.iter().flatten().next().copied().unwrap_or(Side::Right);
                // Room for the arrow.
                @let cell = match side {
                    Side::Left => Rect(26, 8, 28, 28),
                    Side::Top => Rect(8, 24, 24, 18),
                    Side::Right => cell,
                    Side::Bottom => Rect(8, 2, 24, 18),
                };
                @let Rect(x, y, w, h) = cell;
                rect x=(x) y=(y) width=(w) height=(h) fill=(LIGHT) stroke=(INK) stroke-width="1.5" {}
                (arrow(cell, side, 1))
            }
            Draw::Sides { of: Some(_), levels } => {
                rect x="8" y="14" width="28" height="18" fill=(LIGHT) stroke="#9aa1ad" {}
                @let side = levels.iter().flatten().next().copied().unwrap_or(Side::Right);
                (arrow(Rect(8, 14, 28, 18), side, 0))
            }
            Draw::Dark(_) => {
                rect x="4" y="10" width="22" height="24" fill=(LIGHT) stroke="#9aa1ad" {}
                rect x="28" y="10" width="22" height="24" fill=(DARK) stroke="#9aa1ad" {}
            }
            Draw::Run { .. } => {
                line x1="8" y1="22" x2="50" y2="22" stroke=(INK) stroke-width="2" {}
                circle cx="8" cy="22" r="4.5" fill="#fff" stroke=(INK) stroke-width="1.8" {}
                rect x="45" y="17" width="10" height="10" fill=(INK) {}
            }
            Draw::Position(_) => {
                line x1="6" y1="30" x2="52" y2="30" stroke=(INK) stroke-width="2" {}
                polygon points="32,27 27,18 37,18" fill="#0b62a8" {}
            }
            Draw::Strong(_) => {
                rect x="8" y="8" width="28" height="28" fill=(LIGHT) stroke=(INK) stroke-width="1.5" {}
                (arrow(cell, Side::Right, 2))
            }
        }
    }
}

fn axis(Rect(x, y, w, h): Rect, across: bool) -> Markup {
    html! {
        rect x=(x) y=(y) width=(w) height=(h) fill="url(#a-ramp)" stroke=(INK) stroke-width="1.5" {}
        @if across {
            path d=(format!("M{x} {} h{} m-5 -4 l5 4 l-5 4", y + h + 5, w + 8)) fill="none" stroke=(INK) {}
        } @else {
            path d=(format!("M{} {y} v{} m-4 -5 l4 5 l4 -5", x + w + 6, h + 4)) fill="none" stroke=(INK) {}
        }
    }
}
