//! Results in the words of a table: numbers that read back exactly, and the
//! names of levels.

use crate::program::{Output, Reading};

/// The floating-point type that a table is evaluated in.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Single, as on the GPU.
    #[default]
    F32,
    /// Double.
    F64,
}

impl Precision {
    /// The shortest decimal that reads back as the same number of this precision.
    pub fn show(self, value: f64) -> String {
        match self {
            Precision::F32 => (value as f32).to_string(),
            Precision::F64 => value.to_string(),
        }
    }
}

/// The parts of a result in words: numbers, and names of levels.
pub fn words(output: &Output, values: &[f64], precision: Precision) -> Vec<String> {
    parts(&output.read(values), precision)
}

fn parts(reading: &Reading<'_>, precision: Precision) -> Vec<String> {
    match reading {
        Reading::Number(value) => vec![precision.show(*value)],
        Reading::Bool(value) => vec![value.to_string()],
        Reading::Int(value) => vec![value.to_string()],
        Reading::Level(_, name) => vec![(*name).to_owned()],
        Reading::Vector(values) => values.iter().map(|value| precision.show(*value)).collect(),
        Reading::Record(fields) => fields.iter().flat_map(|(_, field)| parts(field, precision)).collect(),
        Reading::List(items) => items.iter().flat_map(|item| parts(item, precision)).collect(),
    }
}

/// The result on one line: `0.5`, `(0.5, 1)`, `left`, `left right`, `a = 0.5, b = left`.
pub fn sentence(output: &Output, values: &[f64], precision: Precision) -> String {
    spoken(&output.read(values), precision)
}

fn spoken(reading: &Reading<'_>, precision: Precision) -> String {
    match reading {
        Reading::Number(_) | Reading::Bool(_) | Reading::Int(_) | Reading::Level(..) => {
            parts(reading, precision).concat()
        }
        Reading::Vector(_) => format!("({})", parts(reading, precision).join(", ")),
        Reading::Record(fields) => {
            let fields = fields.iter().map(|(name, field)| format!("{name} = {}", inner(field, precision)));
            fields.collect::<Vec<_>>().join(", ")
        }
        Reading::List(items) if items.is_empty() => "an empty list".to_owned(),
        Reading::List(items) => items.iter().map(|item| inner(item, precision)).collect::<Vec<_>>().join(" "),
    }
}

/// The result as an expression of the table language: `0.5`, `vec2(0.5, 1)`, `[left, right]`, `{a: 1, b: left}`.
pub fn expression(output: &Output, values: &[f64], precision: Precision) -> String {
    expressed(&output.read(values), precision)
}

fn expressed(reading: &Reading<'_>, precision: Precision) -> String {
    match reading {
        Reading::Number(_) | Reading::Bool(_) | Reading::Int(_) | Reading::Level(..) => spoken(reading, precision),
        Reading::Vector(values) => format!("vec{}({})", values.len(), parts(reading, precision).join(", ")),
        Reading::Record(fields) => {
            let fields = fields.iter().map(|(name, field)| format!("{name}: {}", expressed(field, precision)));
            format!("{{{}}}", fields.collect::<Vec<_>>().join(", "))
        }
        Reading::List(items) => {
            format!("[{}]", items.iter().map(|item| expressed(item, precision)).collect::<Vec<_>>().join(", "))
        }
    }
}

/// A part of a result. What is made of several words is held together.
fn inner(reading: &Reading<'_>, precision: Precision) -> String {
    match reading {
        Reading::Number(_) | Reading::Bool(_) | Reading::Int(_) | Reading::Level(..) | Reading::Vector(_) => {
            spoken(reading, precision)
        }
        Reading::Record(_) => format!("{{{}}}", spoken(reading, precision)),
        Reading::List(items) => {
            format!("[{}]", items.iter().map(|item| inner(item, precision)).collect::<Vec<_>>().join(" "))
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::{LevelKind, Levels};
    use crate::table::Same;

    #[test]
    fn results_in_words() {
        let levels = Levels {
            names: ["no", "yes"].map(str::to_owned).into(),
            codes: vec![0.0, 1.0],
            kind: LevelKind::Named,
            classes: None,
        };
        let third = 1.0_f32 / 3.0;
        let (number, vector) = (Output::Number(None), Output::Vector(2, None));
        assert_eq!(sentence(&number, &[f64::from(third)], Precision::F32), "0.33333334");
        assert_eq!(sentence(&number, &[1.0 / 3.0], Precision::F64), "0.3333333333333333");
        assert_eq!(sentence(&vector, &[1.0, 0.5], Precision::F32), "(1, 0.5)");
        assert_eq!(sentence(&Output::Enumeration(levels.clone()), &[1.0], Precision::F32), "yes");
        let list = Output::List { of: Box::new(Output::Enumeration(levels)), max: 3, same: Same::Exactly };
        assert_eq!(sentence(&list, &[2.0, 1.0, 0.0, 0.0], Precision::F32), "yes no");
        assert_eq!(sentence(&list, &[0.0; 4], Precision::F32), "an empty list");
        assert_eq!(words(&list, &[0.0; 4], Precision::F32), [""; 0]);
        let record = |fields: [(&str, &Output); 2]| {
            Output::Record(fields.map(|(name, of)| (name.to_owned(), of.clone())).to_vec())
        };
        let both = record([("edges", &list), ("at", &vector)]);
        let values = [2.0, 1.0, 0.0, 0.0, 0.5, 1.0];
        assert_eq!(sentence(&both, &values, Precision::F32), "edges = [yes no], at = (0.5, 1)");
        assert_eq!(words(&both, &values, Precision::F32), ["yes", "no", "0.5", "1"]);
        assert_eq!(expression(&both, &values, Precision::F32), "{edges: [yes, no], at: vec2(0.5, 1)}");
        assert_eq!(sentence(&both, &[0.0; 6], Precision::F32), "edges = [], at = (0, 0)");
        let loops = Output::List { of: Box::new(list.clone()), max: 2, same: Same::Exactly };
        let values = [2.0, 1.0, 1.0, 0.0, 0.0, 2.0, 0.0, 1.0, 0.0];
        assert_eq!(sentence(&loops, &values, Precision::F32), "[yes] [no yes]");
        assert_eq!(expression(&loops, &values, Precision::F32), "[[yes], [no, yes]]");
        let counted = record([("lit", &Output::Bool), ("turns", &Output::Int(-1, 1))]);
        assert_eq!(sentence(&counted, &[1.0, -1.0], Precision::F32), "lit = true, turns = -1");
        let nested = record([("n", &number), ("both", &both)]);
        let values = [7.0, 1.0, 1.0, 0.0, 0.0, 0.5, 1.0];
        assert_eq!(sentence(&nested, &values, Precision::F32), "n = 7, both = {edges = [yes], at = (0.5, 1)}");
    }
}
