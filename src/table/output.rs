//! The declaration of a result: its kinds, and how a table writes them.
//!
//! A kind is the same before and after names are resolved, but for the way in which it
//! says its level sets: by name in a table, by their levels in a
//! [`Program`](crate::program::Program).

use serde::Deserialize;

use crate::diag::{Diagnostic, Spanned, codes};
use crate::text::raw::{Raw, Reader};

/// Most items of a list.
const MAX_ITEMS: usize = 64;

/// The kind of a result. `Set` is a level set, as far as it is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Output<Set> {
    /// One number, clamped to the bounds once, at the end, if there are any.
    Number(Option<(f64, f64)>),
    /// Two to four numbers, each clamped like a single one.
    Vector(usize, Option<(f64, f64)>),
    /// Several results, each with a name; of functions only.
    Record(Vec<(String, Output<Set>)>),
    /// One level of a set.
    Enumeration(Set),
    /// At most `max` levels of a set, in order.
    List {
        /// The set.
        of: Set,
        /// Most items, 1 to 64.
        max: usize,
    },
}

impl<Set> Output<Set> {
    /// The same kind with its level sets said in another way.
    ///
    /// # Errors
    /// The first one of `set`.
    pub fn try_map<Other, E>(&self, set: &mut impl FnMut(&Set) -> Result<Other, E>) -> Result<Output<Other>, E> {
        Ok(match self {
            Output::Number(clamp) => Output::Number(*clamp),
            Output::Vector(size, clamp) => Output::Vector(*size, *clamp),
            Output::Record(fields) => {
                let field = |(name, of): &(String, Self)| Ok((name.clone(), of.try_map(set)?));
                Output::Record(fields.iter().map(field).collect::<Result<_, E>>()?)
            }
            Output::Enumeration(of) => Output::Enumeration(set(of)?),
            Output::List { of, max } => Output::List { of: set(of)?, max: *max },
        })
    }
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
enum OutputRon<'a> {
    Number {
        #[serde(default)]
        clamp: Option<(f64, f64)>,
    },
    Vector {
        size: usize,
        #[serde(default)]
        clamp: Option<(f64, f64)>,
    },
    Enumeration {
        #[serde(borrow)]
        of: Raw<'a>,
    },
    List {
        of: Raw<'a>,
        max: usize,
    },
}

impl<'a> Reader<'a> {
    pub(super) fn output(&self, raw: Raw<'a>) -> Result<Spanned<Output<Spanned<String>>>, Diagnostic> {
        let span = self.span(raw);
        let domain = |message: &str, label: &str| Err(Diagnostic::error(codes::DOMAIN, message).at(span, label));
        let (size_ok, clamp, output) = match self.get::<OutputRon<'a>>(raw)? {
            OutputRon::Number { clamp } => (true, clamp, Output::Number(clamp)),
            OutputRon::Vector { size, clamp } => ((2..=4).contains(&size), clamp, Output::Vector(size, clamp)),
            OutputRon::Enumeration { of } => (true, None, Output::Enumeration(self.word(of)?)),
            OutputRon::List { of, max } => {
                ((1..=MAX_ITEMS).contains(&max), None, Output::List { of: self.word(of)?, max })
            }
        };
        if !size_ok {
            return domain(
                "impossible size of the output",
                &format!("a vector has 2 to 4 components, a list at most {MAX_ITEMS} items"),
            );
        }
        if clamp.is_some_and(|(lo, hi)| !(lo.is_finite() && hi.is_finite() && lo <= hi)) {
            return domain("`clamp` needs two finite bounds in ascending order", "in this output");
        }
        Ok(Spanned::new(span, output))
    }
}
