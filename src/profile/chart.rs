//! A profile as a picture: how frequent each case is, and how much that varies
//! between scenes, as the supplement of the published technique shows it.

use super::{Profile, frequencies};
use crate::picture::plot::{Axis, Bars, Frame, Scale, bars};

/// The frequencies of the cases as an SVG document.
pub fn chart(profile: &Profile) -> String {
    let found = frequencies(profile);
    let categories: Vec<String> =
        found.iter().map(|f| f.case.map_or("default".to_owned(), |case| case.to_string())).collect();
    let percent = |share: f64| 100.0 * share;
    let several = profile.scenes.len() > 1;
    let spread = |f: &super::Frequency| (percent(f.mean - f.deviation).max(0.0), percent(f.mean + f.deviation));
    let series = Bars {
        name: "share".to_owned(),
        values: found.iter().map(|f| percent(f.mean)).collect(),
        spread: if several { found.iter().map(spread).collect() } else { Vec::new() },
    };
    let scenes = match profile.scenes.as_slice() {
        [one] => format!("in {}", one.name),
        all => format!("mean and standard deviation over {} scenes", all.len()),
    };
    let axis = |label: &str| Axis { label: label.to_owned(), scale: Scale::Linear };
    let frame = Frame {
        title: format!("{}: frequency of the cases, {scenes}", profile.table),
        x: axis("case"),
        y: axis("share of evaluations (%)"),
        size: (980, 420),
    };
    bars(&frame, &categories, &[series])
}
