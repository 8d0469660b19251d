//! The value of a case around a point, as a picture.

use image::{Rgba, RgbaImage};

use crate::diag::Failure;
use crate::eval::Interpreter;
use crate::picture;
use crate::program::draw::Draw;
use crate::program::{Domain, InputId, Program, Reading, Value};

/// Colours of levels, for results that are no numbers.
const LEVELS: [[u8; 3]; 8] = [
    [240, 240, 240],
    [0, 114, 178],
    [213, 94, 0],
    [0, 158, 115],
    [204, 121, 167],
    [230, 190, 60],
    [90, 170, 225],
    [90, 90, 90],
];

/// The numbers that are black and white.
#[derive(Debug, Clone, Copy)]
pub struct Scale {
    /// The number that is black.
    pub black: f64,
    /// The number that is white.
    pub white: f64,
}

impl Scale {
    /// From 0 to 1, unless the examples of a table go beyond that.
    pub fn of(program: &Program) -> Self {
        let expected = program.examples.iter().flat_map(|example| example.expected.iter().copied());
        let (black, white) = expected.fold((0.0_f64, 1.0_f64), |(lo, hi), value| (lo.min(value), hi.max(value)));
        Scale { black, white }
    }
}

/// The axes of pictures: the inputs across and down.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Axes {
    pub(super) across: Option<InputId>,
    pub(super) down: Option<InputId>,
}

impl Axes {
    /// As hinted, or else the first two numbers that the row's value depends on.
    pub(super) fn of(program: &Program, row: usize) -> Self {
        let hinted = |wanted: &Draw| program.draw.iter().find(|(_, draw)| draw == wanted).map(|(input, _)| *input);
        let (across, down) = (hinted(&Draw::Across), hinted(&Draw::Down));
        if across.is_some() || down.is_some() {
            return Axes { across, down };
        }
        let lines = program.rows[row].lines.iter();
        let inputs = lines.fold(program.pool.cond_facts(program.rows[row].guard).inputs, |all, line| {
            let values = line.values.iter().map(|value| program.pool.expr_facts(*value).inputs);
            values.fold(all.or(program.pool.cond_facts(line.condition).inputs), |all, inputs| all.or(inputs))
        });
        let is_number =
            |id: &InputId| matches!(program.inputs[id.index()].domain, Domain::Continuous { .. } | Domain::Word);
        let mut numbers = inputs.minus(program.fetched).iter().filter(is_number);
        Axes { across: numbers.next(), down: numbers.next() }
    }
}

/// A point with the inputs on the axes as they are in a pixel of a picture of `size` by `size`; other inputs stay.
pub fn spread(
    program: &Program,
    point: &[Option<Value>],
    axes: [(Option<InputId>, u32); 2],
    size: u32,
) -> Vec<Option<Value>> {
    let mut point = point.to_vec();
    for (axis, place) in axes {
        let Some(input) = axis else { continue };
        let domain = &program.inputs[input.index()].domain;
        if let Some((lo, hi)) = domain.range() {
            let share = (f64::from(place) + 0.5) / f64::from(size);
            point[input.index()] = Some(Value::Number(domain.point(lo * (1.0 - share) + hi * share)));
        }
    }
    point
}

/// The value of a row over the axes, other inputs as at `point`. Where the row
/// is not taken the picture is transparent.
pub(super) fn picture(
    program: &Program,
    row: usize,
    point: &[Option<Value>],
    axes: Axes,
    scale: &Scale,
    size: u32,
) -> RgbaImage {
    let mut interpreter = Interpreter::<f32>::new(program);
    RgbaImage::from_fn(size, size, |x, y| {
        let point = spread(program, point, [(axes.across, x), (axes.down, y)], size);
        match interpreter.evaluate(&point) {
            Ok(outcome) if outcome.row == Some(row) => {
                let values = program.output.numbers(&outcome.values);
                let [r, g, b] = colour(&program.output.read(&values), scale);
                Rgba([r, g, b, 255])
            }
            _ => Rgba([0; 4]),
        }
    })
}

/// The colour of a result: grey for a number, colours for more or for levels. A list has that of its length.
pub fn colour(reading: &Reading<'_>, scale: &Scale) -> [u8; 3] {
    let grey = |value: f64| {
        let share = (value - scale.black) / (scale.white - scale.black);
        (share.clamp(0.0, 1.0) * 255.0).round() as u8
    };
    match reading {
        Reading::Number(value) => [grey(*value); 3],
        Reading::Vector(values) => [0, 1, 2].map(|channel| values.get(channel).map_or(0, |value| grey(*value))),
        Reading::Bool(value) => LEVELS[usize::from(*value)],
        Reading::Int(value) => LEVELS[value.rem_euclid(LEVELS.len() as i64) as usize],
        Reading::Level(index, _) => LEVELS[index % LEVELS.len()],
        Reading::List(items) => LEVELS[items.len() % LEVELS.len()],
        Reading::Record(fields) => fields.first().map_or([0; 3], |(_, first)| colour(first, scale)),
    }
}

/// A picture as the address of an image element.
pub(super) fn address(picture: &RgbaImage) -> Result<String, Failure> {
    picture::data_uri(picture)
}
