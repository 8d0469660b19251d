//! Plots of measurements as files.

use std::path::Path;

use crate::cli::input::has_extension;
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture;
use crate::text::file::shown;

/// Width and height of a plot.
pub(super) const PLOT: (u32, u32) = (420, 320);

/// Refuses the name of a file that is no plot.
pub(super) fn is_plot(path: Option<&Path>) -> std::result::Result<(), Failure> {
    match path {
        Some(path) if !has_extension(path, "svg") && !has_extension(path, "png") => {
            let message = format!("`{}` is no kind of plot that can be written", shown(path));
            let error = Diagnostic::error(codes::RENDER, message).help("name it *.svg or *.png");
            Err(Failure::bare("", error))
        }
        _ => Ok(()),
    }
}

/// Plots of the size of [`PLOT`] in rows of three, as the bytes of a file of this name.
pub(super) fn file(path: &Path, plots: Vec<String>) -> std::result::Result<Vec<u8>, Failure> {
    let (width, height) = PLOT;
    let count = plots.len() as u32;
    let place = |(index, plot): (usize, String)| {
        let (x, y) = (index as u32 % 3 * width, index as u32 / 3 * height);
        plot.replacen("<svg ", &format!("<svg x=\"{x}\" y=\"{y}\" "), 1)
    };
    let placed: String = plots.into_iter().enumerate().map(place).collect();
    let (width, height) = (count.min(3) * width, count.div_ceil(3) * height);
    let svg = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\">\
         <rect width=\"100%\" height=\"100%\" fill=\"white\"/>{placed}</svg>\n"
    );
    if has_extension(path, "png") { picture::png(&picture::raster(&svg, 1.0)?) } else { Ok(svg.into_bytes()) }
}
