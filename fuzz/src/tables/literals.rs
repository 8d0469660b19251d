//! Numbers as they are written: whole, dyadic, decimal, large, small, and as constant expressions.

use super::Maker;

/// The ranges of inputs, usual ones first.
const RANGES: [(&str, &str); 12] = [
    ("0", "1"),
    ("-1", "1"),
    ("0", "0.9"),
    ("-2.4", "0.25"),
    ("1", "2"),
    ("-2", "3"),
    ("0", "7"),
    ("0.1", "0.7"),
    ("-1000", "1000"),
    ("0", "1e-3"),
    ("-16777216", "16777216"),
    ("-1e30", "1e30"),
];

impl Maker<'_, '_> {
    /// A number that is at least zero, as one token.
    pub(super) fn literal(&mut self) -> String {
        match self.choices.weighted([6, 6, 6, 2, 1].into_iter()) {
            0 => self.choices.within(0, 4).to_string(),
            1 => format!("{}", self.choices.within(1, 16) as f64 / 8.0),
            2 => format!("{}", self.choices.within(1, 30) as f64 / 10.0),
            3 => (*self.choices.pick(&[".5", "2.", "1e-3", "0.333", "1.5E1", "0.10", "1.193", "7e+0", "3.14159265"]))
                .to_owned(),
            _ => (*self.choices.pick(&[
                "1e6",
                "16777217",
                "1e-7",
                "1e20",
                "1e-30",
                "1e30",
                "1e-46",
                "3.4e38",
                "0.1000000001",
            ]))
            .to_owned(),
        }
    }

    /// The bounds of a range.
    pub(super) fn bounds(&mut self) -> (&'static str, &'static str) {
        let usual = if self.choices.one_in(12) { RANGES.len() } else { 8 };
        *self.choices.pick(&RANGES[..usual])
    }

    /// A number of a range, as a table would have it.
    pub(super) fn inside(&mut self, (lo, hi): (&str, &str)) -> String {
        let [a, b] = [lo, hi].map(|word| word.parse::<f64>().unwrap_or(0.0));
        match self.choices.below(5) {
            0 => lo.to_owned(),
            1 => hi.to_owned(),
            eighths => format!("{}", a + (b - a) * eighths as f64 / 8.0),
        }
    }
}
