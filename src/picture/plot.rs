//! Plots as SVG: lines over a number, bars over names.
//!
//! Axes are laid out here, on transformed numbers with ticks of our own choice;
//! the library draws. Series are named where they end, not in a legend.

use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::diag::visible;

/// Colours that also those can tell apart who do not see all of them (after Okabe and Ito).
const COLOURS: [RGBColor; 7] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(150, 110, 0),
    RGBColor(70, 160, 215),
    RGBColor(90, 90, 90),
];
const INK: RGBColor = RGBColor(29, 31, 35);
const SOFT: RGBColor = RGBColor(93, 100, 112);
const GRID: RGBColor = RGBColor(228, 228, 224);

/// The spacing of numbers along an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Evenly; from zero, if nothing is below it.
    Linear,
    /// By factors of ten. Numbers that are not positive are left out.
    Log10,
    /// By factors of two, such as the sizes of images.
    Log2,
}

/// One axis of a plot.
#[derive(Debug, Clone)]
pub struct Axis {
    /// The quantity, with its unit.
    pub label: String,
    /// The spacing.
    pub scale: Scale,
}

/// The surroundings of the data.
#[derive(Debug, Clone)]
pub struct Frame {
    /// Headline; may be empty.
    pub title: String,
    /// The axis to the right; bars use its label only.
    pub x: Axis,
    /// The axis upwards.
    pub y: Axis,
    /// Width and height in pixels.
    pub size: (u32, u32),
}

/// Points to be joined by a line.
#[derive(Debug, Clone)]
pub struct Series {
    /// The name in the legend.
    pub name: String,
    /// Ascending in x. What is not finite is left out.
    pub points: Vec<(f64, f64)>,
}

/// One bar per category.
#[derive(Debug, Clone)]
pub struct Bars {
    /// The name in the legend.
    pub name: String,
    /// The heights, in the order of the categories. What is not finite is left out.
    pub values: Vec<f64>,
    /// The lower and upper end of a mark of deviation on each bar; empty for none.
    pub spread: Vec<(f64, f64)>,
}

/// A plot of lines.
pub fn lines(frame: &Frame, series: &[Series]) -> String {
    let x = Ticks::of(frame.x.scale, series.iter().flat_map(|s| &s.points).map(|p| p.0), false);
    let y = Ticks::of(frame.y.scale, series.iter().flat_map(|s| &s.points).map(|p| p.1), true);
    let longest = series.iter().map(|s| s.name.chars().count()).max().unwrap_or(0) as u32;
    let mut svg = String::new();
    let draw = |svg: &mut String| -> Result<(), Box<dyn std::error::Error>> {
        let root = SVGBackend::with_string(svg, frame.size).into_drawing_area();
        let mut chart = ChartBuilder::on(&root)
            .margin_top(title(&root, frame)?)
            .margin_right(longest * 7 + 18)
            .margin_left(8)
            .margin_bottom(4)
            .x_label_area_size(40)
            .y_label_area_size(58)
            .build_cartesian_2d(x.clone(), y.clone())?;
        mesh(&mut chart, frame, &x, &y)?;
        let mut names = Vec::new();
        for (number, one) in series.iter().enumerate() {
            let colour = COLOURS[number % COLOURS.len()];
            let points = one.points.iter().filter_map(|p| Some((x.place(p.0)?, y.place(p.1)?)));
            let points: Vec<(f64, f64)> = points.collect();
            chart.draw_series(LineSeries::new(points.iter().copied(), colour.stroke_width(2)))?;
            chart.draw_series(points.iter().map(|p| Circle::new(*p, 3, colour.filled())))?;
            names.extend(points.last().map(|last| (chart.backend_coord(last), one.name.as_str(), colour)));
        }
        for ((at_x, at_y), name, colour) in apart(names, frame.size.1 as i32 - 50) {
            let style = text(13.0, colour).pos(Pos::new(HPos::Left, VPos::Center));
            root.draw(&Text::new(name, (at_x + 9, at_y), style))?;
        }
        root.present()?;
        Ok(())
    };
    finish(draw(&mut svg), svg, frame)
}

/// A plot of bars, side by side for each category.
pub fn bars(frame: &Frame, categories: &[String], series: &[Bars]) -> String {
    let spread = series.iter().flat_map(|s| &s.spread).flat_map(|(low, high)| [*low, *high]);
    let y = Ticks::of(frame.y.scale, series.iter().flat_map(|s| &s.values).copied().chain(spread), true);
    let count = categories.len().max(1);
    let longest = categories.iter().map(|c| c.chars().count()).max().unwrap_or(0) as u32;
    // Names that do not fit side by side are turned.
    let turned = longest * 7 * count as u32 > frame.size.0.saturating_sub(90);
    let below = if turned { longest * 7 + 30 } else { 44 };
    let mut svg = String::new();
    let draw = |svg: &mut String| -> Result<(), Box<dyn std::error::Error>> {
        let root = SVGBackend::with_string(svg, frame.size).into_drawing_area();
        let mut top = title(&root, frame)?;
        if series.len() > 1 {
            let mut left = 66;
            for (number, one) in series.iter().enumerate() {
                let colour = COLOURS[number % COLOURS.len()];
                root.draw(&Rectangle::new([(left, top + 1), (left + 11, top + 12)], colour.filled()))?;
                let style = text(13.0, INK).pos(Pos::new(HPos::Left, VPos::Center));
                root.draw(&Text::new(one.name.as_str(), (left + 17, top + 7), style))?;
                left += one.name.chars().count() as i32 * 7 + 44;
            }
            top += 26;
        }
        let x = Ticks { range: (-0.5, count as f64 - 0.5), marks: Vec::new(), scale: Scale::Linear };
        let mut chart = ChartBuilder::on(&root)
            .margin_top(top)
            .margin_right(16)
            .margin_left(8)
            .margin_bottom(4)
            .x_label_area_size(below)
            .y_label_area_size(58)
            .build_cartesian_2d(x.clone(), y.clone())?;
        mesh(&mut chart, frame, &x, &y)?;
        let (floor, _) = y.range;
        let zero = y.place(0.0).unwrap_or(floor).max(floor);
        let width = 0.78 / series.len().max(1) as f64;
        for (number, one) in series.iter().enumerate() {
            let colour = COLOURS[number % COLOURS.len()];
            for (category, value) in one.values.iter().enumerate().take(count) {
                let Some(height) = y.place(*value) else { continue };
                let left = category as f64 - 0.39 + width * number as f64;
                let corners = [(left, zero), (left + width * 0.94, height)];
                chart.draw_series([Rectangle::new(corners, colour.filled())])?;
                let Some((low, high)) = one.spread.get(category) else { continue };
                if let (Some(low), Some(high)) = (y.place(*low), y.place(*high)) {
                    let middle = left + width * 0.47;
                    chart.draw_series(LineSeries::new([(middle, low), (middle, high)], INK.stroke_width(1)))?;
                    for end in [low, high] {
                        let cap = [(middle - width * 0.14, end), (middle + width * 0.14, end)];
                        chart.draw_series(LineSeries::new(cap, INK.stroke_width(1)))?;
                    }
                }
            }
        }
        for (category, name) in categories.iter().enumerate() {
            let (at_x, at_y) = chart.backend_coord(&(category as f64, floor));
            let style = text(12.5, INK);
            let style = match turned {
                true => style.transform(FontTransform::Rotate90).pos(Pos::new(HPos::Left, VPos::Center)),
                false => style.pos(Pos::new(HPos::Center, VPos::Top)),
            };
            root.draw(&Text::new(name.as_str(), (at_x, at_y + 7), style))?;
        }
        root.present()?;
        Ok(())
    };
    finish(draw(&mut svg), svg, frame)
}

/// The drawing. Drawing into memory fails only on a frame without room for its axes.
fn finish(drawn: Result<(), Box<dyn std::error::Error>>, svg: String, frame: &Frame) -> String {
    match drawn {
        Ok(()) => visible(&svg).into_owned(),
        Err(_) => {
            let (width, height) = frame.size;
            format!("<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\"></svg>\n")
        }
    }
}

type Area<'a> = DrawingArea<SVGBackend<'a>, plotters::coord::Shift>;
type Chart<'a, 'b> = ChartContext<'a, SVGBackend<'b>, Cartesian2d<Ticks, Ticks>>;

/// Writes the title; returns the height that it takes.
fn title(root: &Area<'_>, frame: &Frame) -> Result<i32, Box<dyn std::error::Error>> {
    if frame.title.is_empty() {
        return Ok(12);
    }
    let style = text(17.0, INK).pos(Pos::new(HPos::Left, VPos::Top));
    root.draw(&Text::new(frame.title.as_str(), (12, 10), style))?;
    Ok(38)
}

fn mesh(chart: &mut Chart<'_, '_>, frame: &Frame, x: &Ticks, y: &Ticks) -> Result<(), Box<dyn std::error::Error>> {
    chart
        .configure_mesh()
        .bold_line_style(GRID)
        .light_line_style(TRANSPARENT)
        .axis_style(SOFT)
        .label_style(text(12.5, SOFT))
        .axis_desc_style(text(13.0, INK))
        .x_desc(frame.x.label.as_str())
        .y_desc(frame.y.label.as_str())
        .x_label_formatter(&|value| x.show(*value))
        .y_label_formatter(&|value| y.show(*value))
        .draw()?;
    Ok(())
}

/// A style of text, in the size that it has on the page.
fn text(size: f64, colour: RGBColor) -> TextStyle<'static> {
    // The backend divides by this factor.
    let mut style = ("sans-serif", size * 1.24).into_text_style(&(1, 1));
    style.color = colour.to_backend_color();
    style
}

/// Moves names apart that would overlap, and keeps them above `lowest`.
fn apart<T>(mut names: Vec<((i32, i32), T, RGBColor)>, lowest: i32) -> Vec<((i32, i32), T, RGBColor)> {
    const HEIGHT: i32 = 15;
    names.sort_by_key(|((_, y), ..)| *y);
    for next in 1..names.len() {
        names[next].0.1 = names[next].0.1.max(names[next - 1].0.1 + HEIGHT);
    }
    let mut limit = lowest;
    for name in names.iter_mut().rev() {
        name.0.1 = name.0.1.min(limit);
        limit = name.0.1 - HEIGHT;
    }
    names
}

/// An axis with its marks, in the numbers that are drawn: on a logarithmic axis, exponents.
#[derive(Debug, Clone)]
struct Ticks {
    range: (f64, f64),
    marks: Vec<f64>,
    scale: Scale,
}

impl Ticks {
    /// An axis that shows all of these numbers.
    fn of(scale: Scale, values: impl Iterator<Item = f64>, up: bool) -> Self {
        let mut ticks = Ticks { range: (0.0, 1.0), marks: Vec::new(), scale };
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for value in values.filter_map(|value| ticks.place(value)) {
            (low, high) = (low.min(value), high.max(value));
        }
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if scale == Scale::Linear && up && low >= 0.0 {
            low = 0.0;
        }
        if high - low < 1e-9 * high.abs().max(1e-9) {
            (low, high) = (low - 0.5, high + 0.5);
        }
        let step = match scale {
            Scale::Linear => nice((high - low) / 6.0),
            Scale::Log10 | Scale::Log2 => ((high - low) / 8.0).ceil().max(1.0),
        };
        // Upwards an axis ends at marks; to the right at the data.
        ticks.range = match up {
            true => ((low / step).floor() * step, (high / step).ceil() * step),
            false => (low, high),
        };
        let first = (ticks.range.0 / step - 1e-9).ceil();
        let marks = (0..64).map(|n| (first + f64::from(n)) * step);
        ticks.marks = marks.take_while(|mark| *mark <= ticks.range.1 + step * 1e-9).collect();
        ticks
    }

    /// The place of a number.
    fn place(&self, value: f64) -> Option<f64> {
        let place = match self.scale {
            Scale::Linear => value,
            Scale::Log10 => libm::log10(value),
            Scale::Log2 => libm::log2(value),
        };
        place.is_finite().then_some(place)
    }

    fn show(&self, mark: f64) -> String {
        match self.scale {
            // Marks are multiples of a round step, up to rounding.
            Scale::Linear => ((mark * 1e9).round() / 1e9).to_string(),
            Scale::Log2 => libm::exp2(mark).to_string(),
            Scale::Log10 if (-3.0..=4.0).contains(&mark) => {
                let decimals = (-mark).max(0.0) as usize;
                format!("{:.decimals$}", libm::pow(10.0, mark))
            }
            Scale::Log10 => format!("1e{mark}"),
        }
    }
}

/// The smallest of 1, 2, 5, 10, ... (times a power of ten) that is not below `step`.
fn nice(step: f64) -> f64 {
    let power = libm::pow(10.0, libm::log10(step).floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= step * (1.0 - 1e-9));
    factor.unwrap_or(10.0) * power
}

impl ValueFormatter<f64> for Ticks {
    fn format(value: &f64) -> String {
        value.to_string()
    }
}

impl Ranged for Ticks {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, (first, last): (i32, i32)) -> i32 {
        let share = (value - self.range.0) / (self.range.1 - self.range.0);
        first + (share * f64::from(last - first)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, _: Hint) -> Vec<f64> {
        self.marks.clone()
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.range.0..self.range.1
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_round() {
        let ticks = |scale, values: &[f64]| {
            let ticks = Ticks::of(scale, values.iter().copied(), true);
            ticks.marks.iter().map(|mark| ticks.show(*mark)).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(ticks(Scale::Linear, &[0.1, 0.73]), "0 0.2 0.4 0.6 0.8");
        assert_eq!(ticks(Scale::Linear, &[-3.0, 40.0]), "-10 0 10 20 30 40");
        assert_eq!(ticks(Scale::Log2, &[256.0, 4096.0]), "256 512 1024 2048 4096");
        assert_eq!(ticks(Scale::Log10, &[0.002, 7.0, 0.0, -1.0, f64::NAN]), "0.001 0.01 0.1 1 10");
        assert_eq!(ticks(Scale::Linear, &[]), "0 0.2 0.4 0.6 0.8 1");
        assert_eq!(ticks(Scale::Linear, &[0.0]), "-0.6 -0.4 -0.2 0 0.2 0.4 0.6");
    }

    /// Lines and bars end up as text of the right size and in their place; what is drawn is looked at by hand.
    #[test]
    fn plots_are_pictures() {
        let axis = |label: &str, scale| Axis { label: label.to_owned(), scale };
        let sizes = [256.0, 512.0, 1024.0, 2048.0];
        let series = |name: &str, values: [f64; 4]| Series {
            name: name.to_owned(),
            points: sizes.into_iter().zip(values).collect(),
        };
        let frame = Frame {
            title: "Error by size".to_owned(),
            x: axis("shadow map size", Scale::Log2),
            y: axis("RMSE", Scale::Log10),
            size: (640, 360),
        };
        let all = [
            series("hard", [0.222, 0.152, 0.105, 0.077]),
            series("pcf", [0.258, 0.16, 0.105, 0.068]),
            series("rsmss", [0.17, 0.074, 0.047, 0.038]),
        ];
        let drawn = lines(&frame, &all);
        assert_eq!(drawn, lines(&frame, &all));
        for text in ["Error by size", "shadow map size", "RMSE", "2048", "0.1", "rsmss"] {
            assert!(drawn.contains(&format!(">\n{text}\n<")), "{text} is not in {drawn}");
        }
        let categories: Vec<String> = (1..=31).map(|case| case.to_string()).collect();
        let values: Vec<f64> = (0..31).map(|case| f64::from(case * 7 % 13)).collect();
        let spread = values.iter().map(|value| (value * 0.8, value * 1.3)).collect();
        let bar = Bars { name: "fence".to_owned(), values: values.clone(), spread };
        let other = Bars { name: "leaves".to_owned(), values, spread: Vec::new() };
        let frame = Frame { y: axis("share of the pixels, %", Scale::Linear), size: (900, 320), ..frame };
        let barred = bars(&frame, &categories, &[bar, other]);
        if let Some(folder) = std::env::var_os("UMBRAGE_PICTURES") {
            let folder = std::path::PathBuf::from(folder);
            for (name, svg) in [("lines", &drawn), ("bars", &barred)] {
                let png = super::super::raster(svg, 2.0).and_then(|picture| super::super::png(&picture));
                std::fs::write(folder.join(name).with_extension("png"), png.expect("drawn")).expect("written");
            }
        }
        assert!(super::super::raster(&drawn, 1.0).is_ok() && super::super::raster(&barred, 1.0).is_ok());
        let none = Frame { size: (0, 0), ..frame };
        assert!(bars(&none, &categories, &[]).starts_with("<svg"));
    }

    #[test]
    fn names_keep_their_distance() {
        let names = vec![((0, 50), 'a', INK), ((0, 52), 'b', INK), ((0, 58), 'c', INK)];
        let moved: Vec<_> = apart(names, 70).into_iter().map(|((_, y), name, _)| (name, y)).collect();
        assert_eq!(moved, [('a', 40), ('b', 55), ('c', 70)]);
    }
}
