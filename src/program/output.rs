//! The kinds of output: the type that each has in generated code, and what its
//! components mean.
//!
//! Nothing but this file, the declaration ([`crate::table::Output`]) and the lowering of
//! values tells one kind from another. Emitters go by the [`DataType`], interpreters by the
//! number of components, and whatever shows a result by its [`Reading`].

use super::Real;
use super::data_type::{Component, DataType, Scalar};
use super::domain::Levels;

/// The kind of a program's result.
pub type Output = crate::table::Output<Levels>;

/// A result, read as what its components stand for.
#[derive(Debug, Clone, PartialEq)]
pub enum Reading<'o> {
    /// A number.
    Number(f64),
    /// True or false.
    Bool(bool),
    /// A whole number, or a word.
    Int(i64),
    /// A level, by its index and its name; `?` where there is no such level.
    Level(usize, &'o str),
    /// The numbers of a vector.
    Vector(Vec<f64>),
    /// Results with names.
    Record(Vec<(&'o str, Reading<'o>)>),
    /// Items, as many as there are.
    List(Vec<Reading<'o>>),
}

impl<Set> crate::table::Output<Set> {
    /// The type in generated code.
    pub fn data_type(&self) -> DataType {
        use crate::table::Output;
        match self {
            Output::Number(_) => DataType::Scalar(Scalar::Float),
            Output::Vector(size, _) => DataType::Vector(*size),
            Output::Bool => DataType::Scalar(Scalar::Bool),
            Output::Int(..) => DataType::Scalar(Scalar::Int),
            Output::U32 => DataType::Scalar(Scalar::Word),
            Output::Record(fields) => {
                DataType::Structure(fields.iter().map(|(name, of)| (name.clone(), of.data_type())).collect())
            }
            Output::Enumeration(_) => DataType::Scalar(Scalar::Uint),
            Output::List { of, max, .. } => {
                // Codes stand behind their length, and a list after the other, each filled up with zeros.
                let array = |of: DataType, length| DataType::Array(Box::new(of), length);
                let item = of.data_type();
                match item.leaf() {
                    scalar @ (Scalar::Uint | Scalar::Int) => array(DataType::Scalar(scalar), self.size()),
                    Scalar::Float | Scalar::Bool | Scalar::Word => DataType::Structure(vec![
                        ("count".to_owned(), DataType::Scalar(Scalar::Uint)),
                        ("items".to_owned(), array(item, *max)),
                    ]),
                }
            }
        }
    }

    /// The components, in the order of the values of a line.
    pub fn components(&self) -> Vec<Component> {
        self.data_type().components()
    }

    /// Returns whether it is one real number.
    pub fn is_number(&self) -> bool {
        self.data_type() == DataType::Scalar(Scalar::Float)
    }

    /// Returns whether all components are real numbers.
    pub fn is_real(&self) -> bool {
        self.components().iter().all(|component| component.scalar == Scalar::Float)
    }

    /// The names of the columns that results fill, for headings: `value`, or `value_x` and so on.
    /// A list fills one.
    pub fn columns(&self) -> Vec<String> {
        let mut all = Vec::new();
        self.columns_of("", &mut all);
        all
    }

    fn columns_of(&self, name: &str, all: &mut Vec<String>) {
        use crate::table::Output;
        let named = if name.is_empty() { "value" } else { name };
        match self {
            Output::Number(_)
            | Output::Bool
            | Output::Int(..)
            | Output::U32
            | Output::Enumeration(_)
            | Output::List { .. } => {
                all.push(named.to_owned());
            }
            Output::Vector(size, _) => {
                all.extend(DataType::LETTERS.iter().take(*size).map(|letter| format!("{named}_{letter}")));
            }
            Output::Record(fields) => {
                for (field, of) in fields {
                    let name = if name.is_empty() { field.clone() } else { format!("{name}_{field}") };
                    of.columns_of(&name, all);
                }
            }
        }
    }
}

impl Output {
    /// The numbers that the components of a result stand for, of the type that carries them.
    pub fn numbers<T: Real>(&self, carried: &[T]) -> Vec<f64> {
        self.components().iter().zip(carried).map(|(component, value)| component.scalar.read(*value)).collect()
    }

    /// Reads the components of a result, one number each.
    pub fn read<'o>(&'o self, values: &[f64]) -> Reading<'o> {
        self.read_from(&mut values.iter().copied())
    }

    fn read_from<'o>(&'o self, values: &mut dyn Iterator<Item = f64>) -> Reading<'o> {
        let mut next = || values.next().unwrap_or_default();
        match self {
            Output::Number(_) => Reading::Number(next()),
            Output::Vector(size, _) => Reading::Vector((0..*size).map(|_| next()).collect()),
            Output::Record(fields) => {
                Reading::Record(fields.iter().map(|(name, of)| (name.as_str(), of.read_from(values))).collect())
            }
            Output::Bool => Reading::Bool(next() != 0.0),
            Output::Int(..) | Output::U32 => Reading::Int(next() as i64),
            Output::Enumeration(levels) => level(levels, next()),
            Output::List { of, max, .. } => {
                let length = next() as usize;
                // What fills the list up is read as well, for what comes after it.
                let items: Vec<Reading<'o>> = (0..*max).map(|_| of.read_from(values)).collect();
                Reading::List(items.into_iter().take(length).collect())
            }
        }
    }

    /// The kind in words, for messages: `a number`, `a vector of 2`.
    pub fn describe(&self) -> String {
        match self {
            Output::Number(_) => "a number".to_owned(),
            Output::Vector(size, _) => format!("a vector of {size}"),
            Output::Bool => "a condition".to_owned(),
            Output::Int(from, to) => format!("a whole number from {from} to {to}"),
            Output::Record(fields) => {
                format!("a record of {}", fields.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>().join(", "))
            }
            Output::U32 => "a U32".to_owned(),
            Output::Enumeration(levels) => format!("one of the levels {}", levels.names.join(", ")),
            Output::List { .. } => "a list, written [a, b]".to_owned(),
        }
    }
}

fn level(levels: &Levels, index: f64) -> Reading<'_> {
    let index = index as usize;
    Reading::Level(index, levels.names.get(index).map_or("?", String::as_str))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::LevelKind;
    use crate::table::Same;

    fn levels() -> Levels {
        Levels {
            names: ["no", "yes"].map(str::to_owned).into(),
            codes: vec![0.0, 1.0],
            kind: LevelKind::Named,
            classes: None,
        }
    }

    /// A record with a field of every kind, a record among them.
    fn everything() -> Output {
        let list = Output::List { of: Box::new(Output::Enumeration(levels())), max: 3, same: Same::Exactly };
        let inner = Output::Record(vec![("list".to_owned(), list), ("number".to_owned(), Output::Number(None))]);
        Output::Record(vec![
            ("level".to_owned(), Output::Enumeration(levels())),
            ("vector".to_owned(), Output::Vector(2, None)),
            ("record".to_owned(), inner),
        ])
    }

    #[test]
    fn a_result_of_any_kind_is_read_as_what_it_means() {
        let output = everything();
        let values = [1.0, 0.25, 0.5, 2.0, 1.0, 0.0, 0.0, 7.0];
        assert_eq!(output.components().len(), values.len());
        assert_eq!(output.columns(), ["level", "vector_x", "vector_y", "record_list", "record_number"]);
        assert!(!output.is_real() && Output::Vector(3, None).is_real());
        let list = Reading::List(vec![Reading::Level(1, "yes"), Reading::Level(0, "no")]);
        let expected = Reading::Record(vec![
            ("level", Reading::Level(1, "yes")),
            ("vector", Reading::Vector(vec![0.25, 0.5])),
            ("record", Reading::Record(vec![("list", list), ("number", Reading::Number(7.0))])),
        ]);
        assert_eq!(output.read(&values), expected);
        assert_eq!(Output::Enumeration(levels()).read(&[2.0]), Reading::Level(2, "?"));
    }
}
