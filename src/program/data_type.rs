//! The types of results in generated code, and the components that they consist of.
//!
//! A language spells these types and knows nothing of the kinds of output that they carry.

use super::Real;

/// The type of an input, or of one component of a result, in generated code.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Scalar {
    /// A real number, `f32`.
    Float,
    /// A code, `u32`: the index of a level, a length.
    Uint,
    /// A whole number, `i32`, within 2^24 of zero.
    Int,
    /// True or false; a component of a result is then 1 or 0.
    Bool,
    /// A word, `u32`: any number of 32 bits.
    Word,
}

impl Scalar {
    /// The component that 32 bits hold, as `f32` carries it.
    pub fn number(self, word: u32) -> f32 {
        match self {
            Scalar::Float | Scalar::Word => f32::from_bits(word),
            Scalar::Uint => word as f32,
            Scalar::Int => word.cast_signed() as f32,
            Scalar::Bool => f32::from(u8::from(word != 0)),
        }
    }

    /// The number that a component stands for, of the type that carries it.
    pub fn read<T: Real>(self, carried: T) -> f64 {
        match self {
            Scalar::Float | Scalar::Uint | Scalar::Int | Scalar::Bool => carried.to_f64(),
            Scalar::Word => f64::from(carried.to_word()),
        }
    }
}

/// The type of a result in generated code.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DataType {
    /// A single component.
    Scalar(Scalar),
    /// Two to four numbers.
    Vector(usize),
    /// Scalars or vectors of one type, by their index.
    Array(Box<DataType>, usize),
    /// Fields with names.
    Structure(Vec<(String, DataType)>),
}

/// A component of a result.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Component {
    /// Its name where components stand side by side: `value`, `value_x`, `value_3`, `field`, `field_x`.
    pub name: String,
    /// Its place within the result, as all languages write it: nothing, `[1]`, `.field`, `.field[1]`.
    pub place: String,
    /// Its type.
    pub scalar: Scalar,
}

impl DataType {
    /// The names of a vector's components.
    pub const LETTERS: [&str; 4] = ["x", "y", "z", "w"];

    /// The components, in the order in which a program holds them.
    pub fn components(&self) -> Vec<Component> {
        let mut all = Vec::new();
        self.collect("", "", &mut all);
        all
    }

    fn collect(&self, name: &str, place: &str, all: &mut Vec<Component>) {
        let named = if name.is_empty() { "value" } else { name };
        match self {
            DataType::Scalar(scalar) => {
                all.push(Component { name: named.to_owned(), place: place.to_owned(), scalar: *scalar });
            }
            DataType::Vector(size) => {
                all.extend(Self::LETTERS.iter().take(*size).enumerate().map(|(index, letter)| Component {
                    name: format!("{named}_{letter}"),
                    place: format!("{place}[{index}]"),
                    scalar: Scalar::Float,
                }))
            }
            DataType::Array(of, length) => {
                for index in 0..*length {
                    of.collect(&format!("{named}_{index}"), &format!("{place}[{index}]"), all);
                }
            }
            DataType::Structure(fields) => {
                for (field, of) in fields {
                    let name = if name.is_empty() { field.clone() } else { format!("{name}_{field}") };
                    of.collect(&name, &format!("{place}.{field}"), all);
                }
            }
        }
    }

    /// The type of the last component: that of all, but in a structure.
    pub(crate) fn leaf(&self) -> Scalar {
        match self {
            DataType::Scalar(scalar) => *scalar,
            DataType::Vector(_) => Scalar::Float,
            DataType::Array(of, _) => of.leaf(),
            DataType::Structure(fields) => fields.last().map_or(Scalar::Float, |(_, of)| of.leaf()),
        }
    }

    /// Returns whether an array occurs in it.
    pub fn has_array(&self) -> bool {
        match self {
            DataType::Scalar(_) | DataType::Vector(_) => false,
            DataType::Array(..) => true,
            DataType::Structure(fields) => fields.iter().any(|(_, of)| of.has_array()),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn components_have_names_and_places() {
        let inner = DataType::Structure(vec![
            ("c".to_owned(), DataType::Scalar(Scalar::Bool)),
            ("d".to_owned(), DataType::Array(Box::new(DataType::Scalar(Scalar::Uint)), 2)),
        ]);
        let outer =
            DataType::Structure(vec![("a".to_owned(), DataType::Vector(2)), ("b".to_owned(), inner)]).components();
        let shown: Vec<String> = outer.iter().map(|c| format!("{} {} {:?}", c.name, c.place, c.scalar)).collect();
        assert_eq!(
            shown,
            ["a_x .a[0] Float", "a_y .a[1] Float", "b_c .b.c Bool", "b_d_0 .b.d[0] Uint", "b_d_1 .b.d[1] Uint"]
        );
        let names = |of: DataType| of.components().into_iter().map(|c| c.name + &c.place).collect::<Vec<_>>();
        assert_eq!(names(DataType::Scalar(Scalar::Float)), ["value"]);
        assert_eq!(names(DataType::Vector(3)), ["value_x[0]", "value_y[1]", "value_z[2]"]);
    }
}
