//! The declaration of a result: its kinds, and how a table writes them.
//!
//! A kind is the same before and after names are resolved, but for the way in which it
//! says its level sets: by name in a table, by their levels in a
//! [`Program`](crate::program::Program).

use std::cmp::Ordering;

use serde::Deserialize;

use super::names;
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::text::raw::{Raw, RawMap, Reader, Shape};

/// Most items of a list.
const MAX_ITEMS: usize = 64;
/// Most fields of a record.
pub(crate) const MAX_FIELDS: usize = 32;
/// Most components of a result: what its items and fields have at most, and the lengths of lists.
const MAX_COMPONENTS: usize = 512;
/// Whole numbers of a result are at most this far from zero: `f32` holds them exactly.
const MAX_WHOLE: i64 = 1 << 24;

/// The kind of a result. `Set` is a level set, as far as it is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Output<Set> {
    /// One number, clamped to the bounds once, at the end, if there are any.
    Number(Option<(f64, f64)>),
    /// Two to four numbers, each clamped like a single one.
    Vector(usize, Option<(f64, f64)>),
    /// True or false.
    Bool,
    /// A whole number from the first to the second, both within 2^24 of zero.
    Int(i32, i32),
    /// A word: an unsigned integer of 32 bits.
    U32,
    /// One to 32 results, each with a name.
    Record(Vec<(String, Output<Set>)>),
    /// One level of a set.
    Enumeration(Set),
    /// At most `max` results of one kind, in order. Items are no records, and where they are
    /// lists, these hold levels or whole numbers.
    List {
        /// The kind of the items.
        of: Box<Output<Set>>,
        /// Most items, 1 to 64.
        max: usize,
        /// When two such lists mean the same.
        same: Same,
    },
}

/// When two lists mean the same. Checks ask for it; what a table returns does not depend on it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
pub enum Same {
    /// If their items are equal one by one.
    #[default]
    Exactly,
    /// If they consist of the same groups of so many items, which are turned and stand in any
    /// order: triangles, for instance.
    Groups(usize),
    /// If one is the other, turned: a closed polygon.
    Cyclic,
    /// If they have the same items in any order.
    Any,
}

impl Same {
    /// Brings a list into the form that all lists of the same meaning have.
    fn sort<T: Clone>(self, items: &mut [T], order: &impl Fn(&T, &T) -> Ordering) {
        let lists = |a: &[T], b: &[T]| {
            let differ = a.iter().zip(b).map(|(a, b)| order(a, b)).find(|order| order.is_ne());
            differ.unwrap_or_else(|| a.len().cmp(&b.len()))
        };
        match self {
            Same::Exactly => {}
            Same::Any => items.sort_by(order),
            Same::Cyclic => {
                let turned = |by: usize| [&items[by..], &items[..by]].concat();
                let least = (0..items.len()).map(turned).min_by(|a, b| lists(a, b));
                least.iter().for_each(|least| items.clone_from_slice(least));
            }
            Same::Groups(size) => {
                let mut groups: Vec<Vec<T>> = items.chunks(size.max(1)).map(<[T]>::to_vec).collect();
                groups.iter_mut().for_each(|group| Same::Cyclic.sort(group, order));
                groups.sort_by(|a, b| lists(a, b));
                items.clone_from_slice(&groups.concat());
            }
        }
    }
}

/// An output as it is declared, and the place and name of what came with version 2 of the language.
pub(super) type DeclaredOutput = (Spanned<Output<Spanned<String>>>, Option<(Span, &'static str)>);

impl<Set> Output<Set> {
    /// The number of components.
    pub fn size(&self) -> usize {
        match self {
            Output::Number(_) | Output::Bool | Output::Int(..) | Output::U32 | Output::Enumeration(_) => 1,
            Output::Vector(size, _) => *size,
            Output::Record(fields) => fields.iter().map(|(_, of)| of.size()).sum(),
            Output::List { of, max, .. } => 1 + max * of.size(),
        }
    }

    /// Brings a result into the form that all results of the same meaning have, as far as the
    /// lengths and the items of its lists are known as numbers.
    pub(crate) fn sort<T: Clone>(&self, components: &mut [T], number: &impl Fn(&T) -> Option<f64>) {
        match self {
            Output::Number(_)
            | Output::Vector(..)
            | Output::Bool
            | Output::Int(..)
            | Output::U32
            | Output::Enumeration(_) => {}
            Output::Record(fields) => {
                let mut rest = components;
                for (_, of) in fields {
                    let (own, others) = rest.split_at_mut(of.size());
                    of.sort(own, number);
                    rest = others;
                }
            }
            Output::List { of, same, .. } => {
                let Some((length, items)) = components.split_first_mut() else { return };
                let known = |items: &[T]| items.iter().map(number).collect::<Option<Vec<f64>>>();
                let Some(length) = number(length).map(|length| length as usize) else { return };
                let Some(taken) = items.get_mut(..length * of.size()) else { return };
                taken.chunks_mut(of.size()).for_each(|item| of.sort(item, number));
                if *same == Same::Exactly || known(taken).is_none() {
                    return;
                }
                let mut list: Vec<Vec<T>> = taken.chunks(of.size()).map(<[T]>::to_vec).collect();
                same.sort(&mut list, &|a, b| known(a).partial_cmp(&known(b)).unwrap_or(Ordering::Equal));
                taken.clone_from_slice(&list.concat());
            }
        }
    }

    /// The fields of a record; none of anything else.
    pub(crate) fn fields(&self) -> &[(String, Output<Set>)] {
        if let Output::Record(fields) = self { fields } else { &[] }
    }

    /// Returns whether a list occurs in it.
    pub fn has_list(&self) -> bool {
        match self {
            Output::Number(_)
            | Output::Vector(..)
            | Output::Bool
            | Output::Int(..)
            | Output::U32
            | Output::Enumeration(_) => false,
            Output::Record(fields) => fields.iter().any(|(_, of)| of.has_list()),
            Output::List { .. } => true,
        }
    }

    /// The same kind with its level sets said in another way.
    ///
    /// # Errors
    /// The first one of `set`.
    pub fn try_map<Other, E>(&self, set: &mut impl FnMut(&Set) -> Result<Other, E>) -> Result<Output<Other>, E> {
        Ok(match self {
            Output::Number(clamp) => Output::Number(*clamp),
            Output::Vector(size, clamp) => Output::Vector(*size, *clamp),
            Output::Bool => Output::Bool,
            Output::Int(from, to) => Output::Int(*from, *to),
            Output::U32 => Output::U32,
            Output::Record(fields) => {
                let field = |(name, of): &(String, Self)| Ok((name.clone(), of.try_map(set)?));
                Output::Record(fields.iter().map(field).collect::<Result<_, E>>()?)
            }
            Output::Enumeration(of) => Output::Enumeration(set(of)?),
            Output::List { of, max, same } => Output::List { of: Box::new(of.try_map(set)?), max: *max, same: *same },
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum OutputRon<'a> {
    Number {
        #[serde(default)]
        clamp: Option<(f64, f64)>,
    },
    Vector {
        size: usize,
        #[serde(default)]
        clamp: Option<(f64, f64)>,
    },
    Bool {},
    Int {
        from: i64,
        to: i64,
    },
    U32 {},
    Enumeration {
        #[serde(borrow)]
        of: Raw<'a>,
    },
    List {
        of: Raw<'a>,
        max: usize,
        #[serde(default)]
        same: Same,
    },
    Record(RawMap<'a>),
}

/// The place of an output within another.
#[derive(Clone, Copy, PartialEq)]
enum Within {
    Nothing,
    Record,
    List,
    ListOfLists,
}

impl<'a> Reader<'a> {
    /// The declared output, and the first thing in it that came with version 2 of the language.
    pub(super) fn output(&self, raw: Raw<'a>) -> Result<DeclaredOutput, Diagnostic> {
        let mut later = None;
        let output = self.output_within(raw, Within::Nothing, &mut later)?;
        let components = output.size();
        if components > MAX_COMPONENTS {
            let message = format!("a result of {components} components");
            return Err(Diagnostic::error(codes::DOMAIN, message)
                .at(self.span(raw), format!("at most {MAX_COMPONENTS}"))
                .help("a list has as many components as its items have at most, and one for its length"));
        }
        Ok((Spanned::new(self.span(raw), output), later))
    }

    fn output_within(
        &self,
        raw: Raw<'a>,
        within: Within,
        later: &mut Option<(Span, &'static str)>,
    ) -> Result<Output<Spanned<String>>, Diagnostic> {
        let span = self.span(raw);
        let domain = |message: &str, label: String| Err(Diagnostic::error(codes::DOMAIN, message).at(span, label));
        let mut since = |what| {
            later.get_or_insert((span, what));
        };
        let (clamp, output) = match self.get::<OutputRon<'a>>(raw)? {
            OutputRon::Number { clamp } => (clamp, Output::Number(clamp)),
            OutputRon::Vector { size, clamp } if (2..=4).contains(&size) => (clamp, Output::Vector(size, clamp)),
            OutputRon::Vector { .. } => {
                return domain("impossible size of the output", "a vector has 2 to 4 components".to_owned());
            }
            OutputRon::Bool {} => {
                since("`Bool` as an output");
                (None, Output::Bool)
            }
            OutputRon::Int { from, to } => {
                since("`Int` as an output");
                match (i32::try_from(from), i32::try_from(to)) {
                    (Ok(from), Ok(to)) if from < to && i64::from(from) >= -MAX_WHOLE && i64::from(to) <= MAX_WHOLE => {
                        (None, Output::Int(from, to))
                    }
                    _ => {
                        return domain(
                            "impossible range of whole numbers",
                            format!("`from` is less than `to`, and both are within {MAX_WHOLE} of zero"),
                        );
                    }
                }
            }
            OutputRon::U32 {} => {
                since("`U32` as an output");
                (None, Output::U32)
            }
            OutputRon::Enumeration { of } => (None, Output::Enumeration(self.word(of)?)),
            OutputRon::List { max, .. } if !(1..=MAX_ITEMS).contains(&max) => {
                return domain("impossible size of the output", format!("a list has 1 to {MAX_ITEMS} items at most"));
            }
            OutputRon::List { .. } if within == Within::ListOfLists => {
                return domain("lists are nested too deeply", "a list in a list in a list".to_owned());
            }
            OutputRon::List { same: Same::Groups(0), .. } => {
                return domain("groups of no items", "expected `same: Groups(3)`, for instance".to_owned());
            }
            OutputRon::List { of, max, same } => {
                if same != Same::Exactly {
                    since("`same`");
                }
                let of = match self.shape(of) {
                    Shape::Variant(_) => {
                        since("a list of other things than levels");
                        let inside = if within == Within::List { Within::ListOfLists } else { Within::List };
                        self.output_within(of, inside, later)?
                    }
                    Shape::Text | Shape::Map | Shape::List | Shape::Tuple | Shape::Word(_) | Shape::Other => {
                        Output::Enumeration(self.word(of)?)
                    }
                };
                (None, Output::List { of: Box::new(of), max, same })
            }
            OutputRon::Record(_) if within != Within::Nothing => {
                return Err(Diagnostic::error(codes::DOMAIN, "a record stands in a record or a list")
                    .at(span, "only the whole result is a record")
                    .help("give the parts of this record a field each, or make a list of each of its fields"));
            }
            OutputRon::Record(fields) => {
                since("`Record` as an output");
                (None, self.fields(&fields, span, later)?)
            }
        };
        let finite = |bound: f64| (bound as f32).is_finite();
        if clamp.is_some_and(|(lo, hi)| !(finite(lo) && finite(hi) && lo <= hi)) {
            let message = "`clamp` needs two bounds in ascending order that are finite in f32";
            return domain(message, "in this output".to_owned());
        }
        match (within, &output) {
            (Within::ListOfLists, Output::Number(_) | Output::Vector(..) | Output::Bool | Output::U32) => {
                Err(Diagnostic::error(codes::DOMAIN, "a list of lists holds levels or whole numbers")
                    .at(span, "of another kind")
                    .help("expected the name of a level set, or `Int(from: ..., to: ...)`"))
            }
            _ => Ok(output),
        }
    }

    /// The fields of a record, in the order written.
    fn fields(
        &self,
        fields: &RawMap<'a>,
        span: Span,
        later: &mut Option<(Span, &'static str)>,
    ) -> Result<Output<Spanned<String>>, Diagnostic> {
        if fields.0.is_empty() || fields.0.len() > MAX_FIELDS {
            let message = format!("a record of {} results", fields.0.len());
            return Err(Diagnostic::error(codes::DOMAIN, message)
                .at(span, format!("expected 1 to {MAX_FIELDS}"))
                .help("write the results with their names: Record({\"angle\": Number(), \"side\": Enumeration(of: side)})"));
        }
        let mut read: Vec<(Spanned<String>, Output<Spanned<String>>)> = Vec::new();
        for (name, of) in &fields.0 {
            let name = self.word(*name)?;
            names::check_field(&name, read.iter().map(|(other, _)| other))?;
            read.push((name, self.output_within(*of, Within::Record, later)?));
        }
        Ok(Output::Record(read.into_iter().map(|(name, of)| (name.value, of)).collect()))
    }
}
