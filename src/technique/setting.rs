//! Settings of techniques: declared with name, default and range; chosen by name.

use std::fmt;

use crate::plan::Shape;

/// A setting that a technique declares.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Setting {
    /// Its name, as in `--set NAME=VALUE`.
    pub name: &'static str,
    /// Its meaning, in one line.
    pub doc: &'static str,
    /// The value that is used where none is chosen.
    pub default: Value,
    /// The values that it takes.
    pub range: Range,
    /// Its name in descriptions of what a profile was counted with; empty where it changes no count.
    pub label: &'static str,
}

/// The number of a frame, which random streams depend on.
pub const SEED: Setting = Setting {
    name: "seed",
    doc: "number of the frame, which random places depend on",
    default: Value::Whole(0),
    range: Range::Whole(0, u32::MAX),
    label: "",
};

/// The values that a setting takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Range {
    /// Whole numbers between these, both included.
    Whole(u32, u32),
    /// Odd numbers between these, both included.
    Odd(u32, u32),
    /// Numbers between these, both included.
    Number(f64, f64),
    /// Code shapes of tables.
    Plan,
    /// One of these words.
    Word(&'static [&'static str]),
}

/// A value of a setting.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// Of [`Range::Whole`] and [`Range::Odd`].
    Whole(u32),
    /// Of [`Range::Number`].
    Number(f64),
    /// Of [`Range::Plan`].
    Plan(Shape),
    /// Of [`Range::Word`].
    Word(&'static str),
}

impl Setting {
    /// A setting that is a whole number within a range and changes no count.
    pub const fn whole(name: &'static str, doc: &'static str, default: u32, range: (u32, u32)) -> Self {
        Self { name, doc, default: Value::Whole(default), range: Range::Whole(range.0, range.1), label: "" }
    }

    /// A setting that is a number within a range and changes no count.
    pub const fn number(name: &'static str, doc: &'static str, default: f64, range: (f64, f64)) -> Self {
        Self { name, doc, default: Value::Number(default), range: Range::Number(range.0, range.1), label: "" }
    }

    /// A setting that is one of some words, the first if nothing is said, and changes no count.
    pub const fn word(name: &'static str, doc: &'static str, words: &'static [&'static str]) -> Self {
        Self { name, doc, default: Value::Word(words[0]), range: Range::Word(words), label: "" }
    }

    /// Reads a value.
    ///
    /// # Errors
    /// With the values that would be accepted.
    pub fn parse(&self, text: &str) -> Result<Value, String> {
        let whole = || text.parse::<u32>().ok();
        let value = match self.range {
            Range::Whole(from, to) => whole().filter(|n| (from..=to).contains(n)).map(Value::Whole),
            Range::Odd(from, to) => whole().filter(|n| (from..=to).contains(n) && n % 2 == 1).map(Value::Whole),
            Range::Number(from, to) => text.parse::<f64>().ok().filter(|n| (from..=to).contains(n)).map(Value::Number),
            Range::Plan => Shape::from_name(text).map(Value::Plan),
            Range::Word(words) => words.iter().find(|word| **word == text).map(|word| Value::Word(word)),
        };
        value.ok_or_else(|| format!("expected {}", self.range))
    }
}

impl fmt::Display for Range {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Range::Whole(from, to) => write!(f, "a whole number from {from} to {to}"),
            Range::Odd(from, to) => write!(f, "an odd number from {from} to {to}"),
            Range::Number(from, to) => write!(f, "a number from {from} to {to}"),
            Range::Plan => {
                let names: Vec<&str> = Shape::ALL.iter().map(|shape| shape.name()).collect();
                write!(f, "a plan: {}", names.join(", "))
            }
            Range::Word(words) => write!(f, "one of {}", words.join(", ")),
        }
    }
}

impl fmt::Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Value::Whole(value) => value.fmt(f),
            Value::Number(value) => value.fmt(f),
            Value::Plan(value) => value.fmt(f),
            Value::Word(value) => value.fmt(f),
        }
    }
}

/// The values that were chosen; every other setting has its default.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Settings {
    chosen: Vec<(&'static str, Value)>,
}

impl Settings {
    /// Chooses a value. It must be of the kind that the setting takes, as [`Setting::parse`] gives it; a value of
    /// another kind is as good as none.
    pub fn set(&mut self, setting: &Setting, value: Value) {
        self.chosen.retain(|(name, _)| *name != setting.name);
        self.chosen.push((setting.name, value));
    }

    /// The same with one more value chosen.
    #[must_use]
    pub fn with(&self, setting: &Setting, value: Value) -> Self {
        let mut settings = self.clone();
        settings.set(setting, value);
        settings
    }

    /// The value of a setting.
    pub fn value(&self, setting: &Setting) -> Value {
        self.chosen.iter().find(|(name, _)| *name == setting.name).map_or(setting.default, |(_, value)| *value)
    }

    /// The value of a setting that is a whole number.
    pub fn whole(&self, setting: &Setting) -> u32 {
        match (self.value(setting), setting.default) {
            (Value::Whole(value), _) | (_, Value::Whole(value)) => value,
            (Value::Number(_) | Value::Plan(_) | Value::Word(_), _) => 0,
        }
    }

    /// The value of a setting that is a number.
    pub fn number(&self, setting: &Setting) -> f64 {
        match (self.value(setting), setting.default) {
            (Value::Number(value), _) | (_, Value::Number(value)) => value,
            (Value::Whole(_) | Value::Plan(_) | Value::Word(_), _) => 0.0,
        }
    }

    /// The value of a setting that is a word.
    pub fn word(&self, setting: &Setting) -> &'static str {
        match (self.value(setting), setting.default) {
            (Value::Word(value), _) | (_, Value::Word(value)) => value,
            (Value::Whole(_) | Value::Number(_) | Value::Plan(_), _) => "",
        }
    }

    /// The value of a setting that is a code shape.
    pub fn plan(&self, setting: &Setting) -> Shape {
        match (self.value(setting), setting.default) {
            (Value::Plan(value), _) | (_, Value::Plan(value)) => value,
            (Value::Whole(_) | Value::Number(_) | Value::Word(_), _) => Shape::Ladder,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const KERNEL: Setting =
        Setting { name: "kernel", doc: "", default: Value::Whole(3), range: Range::Odd(1, 31), label: "" };

    #[test]
    fn values_are_read_within_their_range() {
        assert_eq!(KERNEL.parse("5"), Ok(Value::Whole(5)));
        for wrong in ["4", "33", "-1", "x", "5.0", ""] {
            assert_eq!(KERNEL.parse(wrong), Err("expected an odd number from 1 to 31".to_owned()), "{wrong}");
        }
        let share = Setting { default: Value::Number(0.5), range: Range::Number(0.0, 1.0), ..KERNEL };
        assert_eq!(share.parse("0.25"), Ok(Value::Number(0.25)));
        assert_eq!(share.parse("NaN"), Err("expected a number from 0 to 1".to_owned()));
        let side = Setting { default: Value::Word("left"), range: Range::Word(&["left", "right"]), ..KERNEL };
        assert_eq!(side.parse("right"), Ok(Value::Word("right")));
        assert_eq!(side.parse("top"), Err("expected one of left, right".to_owned()));
    }

    #[test]
    fn what_is_not_chosen_has_its_default() {
        let settings = Settings::default();
        assert_eq!(settings.whole(&KERNEL), 3);
        let chosen = settings.with(&KERNEL, Value::Whole(7)).with(&KERNEL, Value::Whole(9));
        assert_eq!((chosen.whole(&KERNEL), settings.whole(&KERNEL)), (9, 3));
    }
}
