//! Methods for points: what each answers, and how that is written.

use clap::ValueEnum;
use serde_json::{Value, json};

use super::read::Row;
use crate::diag::{Diagnostic, Failure, codes};
use crate::show::Precision;
use crate::technique::Executor;
#[cfg(feature = "gpu")]
use crate::technique::area::PointPeeler;
use crate::technique::area::search::Options;
use crate::technique::area::search::point::{Finder, Found};
use crate::technique::area::{Answer, Peeler, Query, SinglePeeler};

type Result<T> = std::result::Result<T, Failure>;

/// Ways to the visible part of a light.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
enum Way {
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
    method: Way,
    /// Points of each curve of a shadow's border, 0 to 5, for `--method search`; 0 looks for closest points, as the
    /// paper does [default: 3]
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u32).range(0..=i64::from(Options::MOST_RAYS)))]
    rays: Option<u32>,
    /// Number that random places depend on, for `--method search` [default: 0]
    #[arg(long, value_name = "N")]
    seed: Option<u32>,
}

/// A method with its tables, on the machine and in the precision that were asked for.
pub(super) enum Method<'g> {
    Double(Box<Peeler<f64>>),
    Single(Box<SinglePeeler>),
    #[cfg(feature = "gpu")]
    Gpu(Box<PointPeeler<'g>>),
    #[cfg(not(feature = "gpu"))]
    #[expect(dead_code, reason = "keeps the lifetime in builds without GPU support")]
    Never(&'g std::convert::Infallible),
    Search {
        double: Box<Finder<f64>>,
        single: Option<Box<Finder<f32>>>,
        seed: u32,
    },
}

/// The light at a point, as a method found it.
pub(super) enum Answered {
    Exact(Answer),
    Search(Found),
}

impl Choice {
    /// The options of a search and its seed, if a search was asked for.
    ///
    /// # Errors
    /// When an option belongs to another method.
    pub(super) fn search(self) -> Result<Option<(Options, u32)>> {
        let Self { method, rays, seed } = self;
        match (method, rays, seed) {
            (Way::Exact, None, None) => Ok(None),
            (Way::Exact, rays, _) => {
                let option = if rays.is_some() { "--rays" } else { "--seed" };
                let message = format!("`{option}` is for `--method search`: the exact method casts no rays");
                Err(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message)))
            }
            (Way::Search, rays, seed) => {
                let defaults = Options::default();
                Ok(Some((Options { rays: rays.unwrap_or(defaults.rays), ..defaults }, seed.unwrap_or_default())))
            }
        }
    }
}

impl<'g> Method<'g> {
    /// The method on a machine, in a precision.
    ///
    /// # Errors
    /// When a device refuses the shader.
    pub(super) fn new(precision: Precision, executor: &'g Executor, search: Option<(Options, u32)>) -> Result<Self> {
        if let Some((options, seed)) = search {
            let single = match precision {
                Precision::F32 => Some(Box::new(Finder::new(options)?)),
                Precision::F64 => None,
            };
            return Ok(Self::Search { double: Box::new(Finder::new(options)?), single, seed });
        }
        match (executor, precision) {
            (Executor::Cpu, Precision::F64) => Ok(Self::Double(Box::new(Peeler::new()?))),
            (Executor::Cpu, Precision::F32) => Ok(Self::Single(Box::new(SinglePeeler::new()?))),
            #[cfg(feature = "gpu")]
            (Executor::Gpu(gpu), _) => Ok(Self::Gpu(Box::new(PointPeeler::new(gpu)?))),
        }
    }

    /// The answers for some points, each with its number.
    ///
    /// # Errors
    /// When a device fails.
    pub(super) fn answers(&mut self, rows: &[(u32, &Row)]) -> Result<Vec<Answered>> {
        let queries = || rows.iter().map(|(_, row)| row.question.query());
        let exact = |answers: Vec<Answer>| answers.into_iter().map(Answered::Exact).collect();
        Ok(match self {
            Self::Double(peeler) => exact(peeler.answers(queries())?),
            Self::Single(peeler) => exact(peeler.answers(&queries().collect::<Vec<Query<'_>>>())?),
            #[cfg(feature = "gpu")]
            Self::Gpu(peeler) => exact(peeler.answers(&queries().collect::<Vec<Query<'_>>>())?),
            #[cfg(not(feature = "gpu"))]
            Self::Never(never) => match **never {},
            Self::Search { double, single, seed } => {
                let found = match single {
                    Some(single) => searched(single, double, rows, *seed)?,
                    None => double.find(numbered(rows), *seed)?,
                };
                found.into_iter().map(Answered::Search).collect()
            }
        })
    }
}

fn numbered<'q>(rows: &'q [(u32, &'q Row)]) -> impl Iterator<Item = (u32, Query<'q>)> {
    rows.iter().map(|(number, row)| (*number, row.question.query()))
}

/// The findings in single precision; in double where that is beyond its range.
fn searched(single: &mut Finder<f32>, double: &mut Finder<f64>, rows: &[(u32, &Row)], seed: u32) -> Result<Vec<Found>> {
    let mut all = single.find(numbered(rows), seed)?;
    let beyond: Vec<usize> = (0..all.len()).filter(|index| !all[*index].answer.is_finite()).collect();
    let again: Vec<(u32, &Row)> = beyond.iter().map(|index| rows[*index]).collect();
    for (index, found) in beyond.into_iter().zip(double.find(numbered(&again), seed)?) {
        all[index] = found;
    }
    Ok(all)
}

impl Answered {
    fn answer(&self) -> &Answer {
        match self {
            Answered::Exact(answer) | Answered::Search(Found { answer, .. }) => answer,
        }
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
