//! Results in the words of a table: numbers that read back exactly, and the
//! names of levels.

use crate::program::Output;

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

/// The names of the components of an output, for headings: `value`, or `value_x` and so on.
pub fn component_names(output: &Output) -> Vec<&str> {
    const NAMES: [&str; 4] = ["value_x", "value_y", "value_z", "value_w"];
    match output {
        Output::Vector(size) => NAMES[..*size].to_vec(),
        Output::Record(names) => names.iter().map(String::as_str).collect(),
        _ => vec!["value"],
    }
}

/// The result in words: one number per component, or names of levels.
pub fn words(output: &Output, values: &[f64], precision: Precision) -> Vec<String> {
    let name = |levels: &[String], value: f64| levels.get(value as usize).cloned().unwrap_or_else(|| "?".to_owned());
    match (output, values) {
        (Output::Number | Output::Vector(_) | Output::Record(_), _) => {
            values.iter().map(|v| precision.show(*v)).collect()
        }
        (Output::Enumeration(levels), _) => values.iter().map(|v| name(&levels.names, *v)).collect(),
        (Output::List { levels, .. }, [length, items @ ..]) => {
            items.iter().take(*length as usize).map(|v| name(&levels.names, *v)).collect()
        }
        (Output::List { .. }, []) => Vec::new(),
    }
}

/// The result on one line: `0.5`, `(0.5, 1)`, `left`, `left right`.
pub fn sentence(output: &Output, values: &[f64], precision: Precision) -> String {
    let words = words(output, values, precision);
    match output {
        Output::Vector(_) => format!("({})", words.join(", ")),
        Output::Record(names) => {
            let parts: Vec<String> = names.iter().zip(words).map(|(name, word)| format!("{name} = {word}")).collect();
            parts.join(", ")
        }
        Output::List { .. } if words.is_empty() => "an empty list".to_owned(),
        _ => words.join(" "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::{LevelKind, Levels};

    #[test]
    fn results_in_words() {
        let levels =
            Levels { names: ["no", "yes"].map(str::to_owned).into(), codes: vec![0.0, 1.0], kind: LevelKind::Named };
        let third = 1.0_f32 / 3.0;
        assert_eq!(sentence(&Output::Number, &[f64::from(third)], Precision::F32), "0.33333334");
        assert_eq!(sentence(&Output::Number, &[1.0 / 3.0], Precision::F64), "0.3333333333333333");
        assert_eq!(sentence(&Output::Vector(2), &[1.0, 0.5], Precision::F32), "(1, 0.5)");
        assert_eq!(sentence(&Output::Enumeration(levels.clone()), &[1.0], Precision::F32), "yes");
        let list = Output::List { levels, max: 3 };
        assert_eq!(sentence(&list, &[2.0, 1.0, 0.0, 0.0], Precision::F32), "yes no");
        assert_eq!(words(&list, &[0.0; 4], Precision::F32), [""; 0]);
    }
}
