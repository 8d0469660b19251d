//! The fields that the parts of a table may have, asked of those who read them.
//!
//! An editor offers them. Which there are is said once, by the structs that `table::read` and
//! its like read into: a deserialiser that answers nothing is told what they ask for. What a
//! field means is said once as well, in `docs/language.md`.

use serde::de::value::{Error, StrDeserializer};
use serde::de::{
    Deserialize, DeserializeSeed, Deserializer, EnumAccess, Error as _, IntoDeserializer, VariantAccess, Visitor,
};
use serde::forward_to_deserialize_any;

use super::{claims, draw, functions, output, read};

const REFERENCE: &str = include_str!("../../docs/language.md");

/// A part of a table in parentheses, such as a case, or one of the ways to write one, such as `Range(...)`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Form {
    /// The word before the parenthesis; empty where there need be none, and none is usual.
    pub word: &'static str,
    /// Its fields; none if something else stands in the parentheses, or there are none.
    pub fields: Vec<&'static str>,
    /// True if it is nothing but the word.
    pub is_bare: bool,
}

/// A kind of parts of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Part {
    Table,
    Case,
    Input,
    Symmetry,
    Function,
    Output,
    Continuity,
    Claim,
    Draw,
    Constant,
    Condition,
    Allow,
    Erratum,
    Image,
    Limit,
    Accuracy,
    Fetched,
}

/// The ways to write a part of a table.
///
/// ```
/// use umbrage::table::fields::{Part, forms};
///
/// let range = forms(Part::Input).into_iter().find(|form| form.word == "Range").expect("an input may be a range");
/// assert_eq!(range.fields, ["from", "to", "unit", "doc", "fetched", "default"]);
/// ```
pub fn forms(part: Part) -> Vec<Form> {
    match part {
        Part::Table => fields::<read::TableRon<'static>>("Table"),
        Part::Case => fields::<read::CaseRon<'static>>("Case"),
        Part::Input => variants::<read::InputRon<'static>>(),
        Part::Symmetry => fields::<read::maps::SymmetryRon<'static>>("Symmetry"),
        Part::Function => fields::<functions::FunctionRon<'static>>("Function"),
        Part::Output => variants::<output::OutputRon<'static>>(),
        Part::Continuity => variants::<read::maps::ContinuityRon<'static>>(),
        Part::Claim => variants::<claims::ClaimRon<'static>>(),
        Part::Draw => variants::<draw::DrawRon<'static>>(),
        Part::Constant => variants::<functions::DataRon<'static>>(),
        Part::Condition => variants::<read::conditions::CombinedRon<'static>>(),
        Part::Allow => fields::<read::AllowRon<'static>>(""),
        Part::Erratum => fields::<read::ErratumRon>(""),
        Part::Image => fields::<read::ImageOfRon<'static>>(""),
        Part::Limit => fields::<functions::LimitRon<'static>>(""),
        Part::Accuracy => fields::<functions::AccuracyRon<'static>>(""),
        Part::Fetched => fields::<read::FetchedRon>(""),
    }
}

/// The meaning of a field of a part, from the reference, as Markdown; nothing where that has no row for it.
pub fn meaning(part: Part, field: &str) -> Option<&'static str> {
    let sections: &[&str] = match part {
        Part::Table => &["## 2. The parts of a table", "| field of the table |"],
        Part::Case => &["### Cases"],
        Part::Input | Part::Fetched => &["### Inputs"],
        Part::Function => &["| field of a `Function` |"],
        Part::Symmetry
        | Part::Output
        | Part::Continuity
        | Part::Claim
        | Part::Draw
        | Part::Constant
        | Part::Condition
        | Part::Allow
        | Part::Erratum
        | Part::Image
        | Part::Limit
        | Part::Accuracy => return None,
    };
    sections.iter().find_map(|section| meaning_in(section, field))
}

/// The meaning of a field in the table that follows some words of the reference.
fn meaning_in(section: &str, field: &str) -> Option<&'static str> {
    let rest = &REFERENCE[REFERENCE.find(&format!("\n{section}"))? + 1..];
    // A section ends with the next heading.
    let end = rest[1..].find("\n#").map_or(rest.len(), |end| end + 1);
    let row = rest[..end].lines().find(|line| {
        let names = line.strip_prefix("| ").and_then(|line| line.split('|').next()).unwrap_or_default();
        names.split(", ").any(|name| name.trim().trim_matches('`').split('(').next() == Some(field))
    })?;
    row.trim_end_matches('|').rsplit('|').next().map(str::trim)
}

fn fields<T: Deserialize<'static>>(word: &'static str) -> Vec<Form> {
    let mut asked = Asked::default();
    // It is answered nothing, so it always fails; by then it has asked.
    let _ = T::deserialize(Ask { asked: &mut asked, variant: None });
    vec![Form { word, fields: asked.fields, is_bare: false }]
}

fn variants<T: Deserialize<'static>>() -> Vec<Form> {
    let mut all = Asked::default();
    let _ = T::deserialize(Ask { asked: &mut all, variant: None });
    let variant = |word: &'static str| {
        let mut asked = Asked::default();
        let _ = T::deserialize(Ask { asked: &mut asked, variant: Some(word) });
        Form { word, fields: asked.fields, is_bare: asked.is_bare }
    };
    all.variants.into_iter().map(variant).collect()
}

/// The fields and variants that were asked for.
#[derive(Default)]
struct Asked {
    fields: Vec<&'static str>,
    variants: Vec<&'static str>,
    is_bare: bool,
}

/// A deserialiser that answers nothing but the variant that it is told.
struct Ask<'a> {
    asked: &'a mut Asked,
    variant: Option<&'static str>,
}

fn nothing<T>() -> Result<T, Error> {
    Err(Error::custom("nothing is read here"))
}

impl<'de> Deserializer<'de> for Ask<'_> {
    type Error = Error;

    fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Error> {
        nothing()
    }

    fn deserialize_struct<V: Visitor<'de>>(
        self,
        _: &'static str,
        fields: &'static [&'static str],
        _: V,
    ) -> Result<V::Value, Error> {
        self.asked.fields = fields.to_vec();
        nothing()
    }

    fn deserialize_enum<V: Visitor<'de>>(
        self,
        _: &'static str,
        variants: &'static [&'static str],
        visitor: V,
    ) -> Result<V::Value, Error> {
        self.asked.variants = variants.to_vec();
        match self.variant {
            Some(_) => visitor.visit_enum(self),
            None => nothing(),
        }
    }

    forward_to_deserialize_any! {
        bool i8 i16 i32 i64 i128 u8 u16 u32 u64 u128 f32 f64 char str string bytes byte_buf option unit unit_struct
        newtype_struct seq tuple tuple_struct map identifier ignored_any
    }
}

impl<'de> EnumAccess<'de> for Ask<'_> {
    type Error = Error;
    type Variant = Self;

    fn variant_seed<V: DeserializeSeed<'de>>(self, seed: V) -> Result<(V::Value, Self), Error> {
        let word: StrDeserializer<'static, Error> = self.variant.unwrap_or_default().into_deserializer();
        Ok((seed.deserialize(word)?, self))
    }
}

impl<'de> VariantAccess<'de> for Ask<'_> {
    type Error = Error;

    fn unit_variant(self) -> Result<(), Error> {
        self.asked.is_bare = true;
        nothing()
    }

    fn newtype_variant_seed<T: DeserializeSeed<'de>>(self, _: T) -> Result<T::Value, Error> {
        nothing()
    }

    fn tuple_variant<V: Visitor<'de>>(self, _: usize, _: V) -> Result<V::Value, Error> {
        nothing()
    }

    fn struct_variant<V: Visitor<'de>>(self, fields: &'static [&'static str], _: V) -> Result<V::Value, Error> {
        self.asked.fields = fields.to_vec();
        nothing()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn readers_say_their_fields() {
        let words = |part| forms(part).iter().map(|form| form.word).collect::<Vec<_>>();
        assert_eq!(words(Part::Input), ["Levels", "Bool", "Int", "U32", "Range"]);
        assert_eq!(words(Part::Continuity), ["Border", "Switch"]);
        assert_eq!(forms(Part::Fetched)[0].fields, ["cost"]);
        assert!(forms(Part::Draw).iter().any(|form| form.word == "Across" && form.is_bare));
        assert!(forms(Part::Table)[0].fields.contains(&"hit_policy"));
    }

    /// The reference has a row for every field of a table, a case and a function.
    #[test]
    fn every_field_has_a_meaning() {
        for part in [Part::Table, Part::Case, Part::Function] {
            for field in &forms(part)[0].fields {
                let meaning = meaning(part, field);
                assert!(meaning.is_some_and(|meaning| meaning.len() > 8), "{part:?} {field}: {meaning:?}");
            }
        }
    }
}
