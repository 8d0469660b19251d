//! Results that consist of several components: taken apart, put together, their structures declared.
//!
//! The languages share this; a [`Dialect`] says how each of them writes a vector, an array or a
//! structure.

use super::{Dialect, Prefix};
use crate::program::DataType;

/// The result of a table, made of its components.
pub(in crate::emit) fn value(
    dialect: &dyn Dialect,
    prefix: &Prefix,
    data: &DataType,
    components: impl IntoIterator<Item = String>,
) -> String {
    compose(dialect, data, &prefix.value(), &mut components.into_iter())
}

fn compose(
    dialect: &dyn Dialect,
    data: &DataType,
    structure: &str,
    components: &mut dyn Iterator<Item = String>,
) -> String {
    match data {
        DataType::Scalar(_) => components.next().unwrap_or_default(),
        DataType::Vector(count) => {
            let parts: Vec<String> = components.take(*count).collect();
            dialect.collection(&dialect.data(data, structure), &parts)
        }
        DataType::Array(of, count) => {
            let parts: Vec<String> = (0..*count).map(|_| compose(dialect, of, structure, components)).collect();
            dialect.collection(&dialect.data(data, structure), &parts)
        }
        DataType::Structure(fields) => {
            let fields = fields
                .iter()
                .map(|(name, of)| (name.as_str(), compose(dialect, of, &of_field(structure, name), components)));
            dialect.structure_of(structure, &fields.collect::<Vec<_>>())
        }
    }
}

/// The components of a result, each as a word.
pub(in crate::emit) fn words(dialect: &dyn Dialect, data: &DataType, value: &str) -> Vec<String> {
    let components = data.components().into_iter();
    components.map(|of| dialect.word_of_scalar(of.scalar, &format!("{value}{}", of.place))).collect()
}

/// The structures that a result consists of, by name and declaration, each before it is used.
pub(in crate::emit) fn structures(dialect: &dyn Dialect, prefix: &Prefix, data: &DataType) -> Vec<(String, String)> {
    let mut all = Vec::new();
    declare(dialect, data, &prefix.value(), &mut all);
    all
}

fn declare(dialect: &dyn Dialect, data: &DataType, structure: &str, all: &mut Vec<(String, String)>) {
    let DataType::Structure(fields) = data else { return };
    for (name, of) in fields {
        declare(dialect, of, &of_field(structure, name), all);
    }
    let fields = fields.iter().map(|(name, of)| (name.as_str(), dialect.data(of, &of_field(structure, name))));
    all.push((structure.to_owned(), dialect.structure(structure, &fields.collect::<Vec<_>>())));
}

/// The name that the structure of a field has, if it is one.
fn of_field(structure: &str, field: &str) -> String {
    structure.to_owned() + &Prefix::new(field).camel
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::language::glsl::{Glsl, GlslVersion};
    use crate::emit::language::rust::Rust;
    use crate::emit::language::wgsl::Wgsl;
    use crate::program::Scalar;

    /// A structure with a field of every type, a structure among them.
    fn everything() -> DataType {
        let inner = DataType::Structure(vec![
            ("edges".to_owned(), DataType::Array(Box::new(DataType::Scalar(Scalar::Uint)), 3)),
            ("points".to_owned(), DataType::Array(Box::new(DataType::Vector(2)), 2)),
            ("turns".to_owned(), DataType::Scalar(Scalar::Int)),
            ("lit".to_owned(), DataType::Scalar(Scalar::Bool)),
        ]);
        DataType::Structure(vec![
            ("level".to_owned(), DataType::Scalar(Scalar::Uint)),
            ("at".to_owned(), DataType::Vector(2)),
            ("both_sides".to_owned(), inner),
            ("n".to_owned(), DataType::Scalar(Scalar::Float)),
        ])
    }

    /// Structures, a value made of words, and its words again, as a language writes them.
    fn written(dialect: &dyn Dialect) -> String {
        let (prefix, data) = (Prefix::new("t"), everything());
        let made = data.components().into_iter().zip(0..);
        let made = made.map(|(of, index)| dialect.scalar_of_word(of.scalar, &format!("w[{index}]")));
        let value = value(dialect, &prefix, &data, made);
        let structures: Vec<String> = structures(dialect, &prefix, &data).into_iter().map(|(_, text)| text).collect();
        format!("{}\n{value}\n{}", structures.join("\n"), words(dialect, &data, "v").join("\n"))
    }

    #[test]
    fn composite_results_in_wgsl() {
        insta::assert_snapshot!(written(&Wgsl::Plain));
        let (prefix, data) = (Prefix::new("t"), everything());
        let declared: String =
            structures(&Wgsl::Plain, &prefix, &data).into_iter().map(|(_, text)| text + "\n").collect();
        let made = data.components().into_iter().zip(0..);
        let made = made.map(|(of, index)| Wgsl::Plain.scalar_of_word(of.scalar, &format!("w[{index}]")));
        let made = value(&Wgsl::Plain, &prefix, &data, made);
        let stores = words(&Wgsl::Plain, &data, "v").into_iter().zip(0..);
        let stores: String = stores.map(|(word, index)| format!("w[{index}] = {word};\n")).collect();
        let text = format!(
            "{declared}@group(0) @binding(0) var<storage, read_write> w: array<u32>;\n\
             @compute @workgroup_size(1) fn main() {{\nlet v = {made};\n{stores}}}\n"
        );
        crate::emit::wgsl_text("test", &text).unwrap_or_else(|e| panic!("{e}"));
    }

    #[test]
    fn composite_results_in_glsl() {
        insta::assert_snapshot!(written(&Glsl { version: GlslVersion::V450 }));
    }

    #[test]
    fn composite_results_in_rust() {
        insta::assert_snapshot!(written(&Rust));
    }
}
