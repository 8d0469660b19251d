//! Methods for points: what each answers, and how that is written.

use clap::ValueEnum;
use serde_json::{Value, json};

use super::read::Row;
use crate::diag::{Diagnostic, Failure, codes};
use crate::technique::area::search::Options;
use crate::technique::area::search::point::{Finder, Found};
use crate::technique::area::{Answer, Peeler, Scalar};

type Result<T> = std::result::Result<T, Failure>;

/// Ways to the visible part of a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub(super) enum Method {
    /// Cut out exactly
    #[default]
    Exact,
    /// Searched for by tests of visibility
    Search,
}

/// The method and what it was asked for.
#[derive(Debug, Clone, Copy, clap::Args)]
pub(super) struct Choice {
    /// The way to the visible part of the light
    #[arg(long, value_enum, default_value = "exact", value_name = "METHOD")]
    method: Method,
    /// Points of each curve of a shadow's border, 0 to 5, for `--method search`; 0 looks for closest points, as the
    /// paper does [default: 3]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(0..=i64::from(Options::MOST_RAYS)))]
    rays: Option<u32>,
    /// Number that random places depend on, for `--method search` [default: 0]
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
}

/// A method with its tables, in one precision.
pub(super) enum Machine<T> {
    Exact(Peeler<T>),
    Search(Finder<T>, u32),
}

/// The light at a point, as a method found it.
pub(super) enum Answered {
    Exact(Answer),
    Search(Found),
}

impl Choice {
    /// The machine in a precision.
    ///
    /// # Errors
    /// When an option belongs to another method.
    pub(super) fn machine<T: Scalar>(self) -> Result<Machine<T>> {
        let Self { method, rays, seed } = self;
        match method {
            Method::Exact => match (rays, seed) {
                (None, None) => Ok(Machine::Exact(Peeler::new()?)),
                (rays, _) => {
                    let option = if rays.is_some() { "--rays" } else { "--seed" };
                    let message = format!("`{option}` is for `--method search`: the exact method casts no rays");
                    Err(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message)))
                }
            },
            Method::Search => {
                let defaults = Options::default();
                let options = Options { rays: rays.unwrap_or(defaults.rays), ..defaults };
                Ok(Machine::Search(Finder::new(options)?, seed.unwrap_or_default()))
            }
        }
    }
}

impl<T: Scalar> Machine<T> {
    /// The answers for some points, each with its number.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    pub(super) fn answers(&mut self, rows: &[(u32, &Row)]) -> Result<Vec<Answered>> {
        let queries = rows.iter().map(|(number, row)| (*number, row.question.query()));
        Ok(match self {
            Machine::Exact(peeler) => {
                peeler.answers(queries.map(|(_, query)| query))?.into_iter().map(Answered::Exact).collect()
            }
            Machine::Search(finder, seed) => finder.find(queries, *seed)?.into_iter().map(Answered::Search).collect(),
        })
    }
}

impl Answered {
    fn answer(&self) -> &Answer {
        match self {
            Answered::Exact(answer) | Answered::Search(Found { answer, .. }) => answer,
        }
    }

    /// Returns whether nothing was too large or too small for the precision that it was computed in.
    pub(super) fn is_finite(&self) -> bool {
        self.answer().is_finite()
    }

    /// The line of output.
    pub(super) fn object(&self, row: &Row) -> Value {
        let answer = self.answer();
        let mut object = json!({
            "id": row.id,
            "fraction": answer.fraction,
            "fraction_above_horizon": answer.fraction_above_horizon,
            "form_factor": answer.form_factor,
            "form_factor_unshadowed": answer.form_factor_unshadowed,
        });
        if let Some((with, without)) = answer.shaped {
            object["ltc"] = with.into();
            object["ltc_unshadowed"] = without.into();
        }
        object["pieces"] = answer.work.pieces.into();
        object["clips"] = answer.work.clips.into();
        object["overflow"] = answer.work.overflow.into();
        if let Answered::Search(found) = self {
            let mut names = found.configurations.iter().map(|(_, name)| *name);
            object["configuration"] = match found.discontinuities.len() {
                // A triangle is not cut.
                3 => names.next().into(),
                _ => names.collect::<Value>(),
            };
            object["tests"] = found.tests.into();
            object["discontinuities"] = found.discontinuities.clone().into();
        }
        object
    }
}
