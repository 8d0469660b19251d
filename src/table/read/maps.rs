//! Maps of inputs and results: symmetries, and the places where values do not jump.

use serde::Deserialize;

use super::Result;
use crate::table::{Continuity, ContinuityKind, Image, ResultMap, Symmetry};
use crate::text::raw::{Raw, RawMap, Reader, Shape};

#[derive(Deserialize)]
#[serde(rename = "Symmetry", deny_unknown_fields)]
pub(in crate::table) struct SymmetryRon<'a> {
    #[serde(borrow)]
    map: RawMap<'a>,
    #[serde(default)]
    result: Option<Raw<'a>>,
    #[serde(default)]
    doc: String,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(in crate::table) enum ContinuityRon<'a> {
    Border {
        #[serde(borrow)]
        when: Raw<'a>,
        map: RawMap<'a>,
        #[serde(default)]
        free: Vec<Raw<'a>>,
        #[serde(default)]
        doc: String,
    },
    Switch {
        of: Vec<Raw<'a>>,
        #[serde(default)]
        doc: String,
    },
}

#[derive(Deserialize)]
enum FromRon<'a> {
    From(#[serde(borrow)] Raw<'a>, RawMap<'a>),
}

impl<'a> Reader<'a> {
    pub(super) fn symmetry(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<Symmetry> {
        let ron: SymmetryRon<'a> = self.get(raw)?;
        let map = ron.map.0.iter().map(|(n, i)| Ok((self.word(*n)?, self.image(*i)?))).collect::<Result<_>>()?;
        let result = ron.result.map(|r| self.result_map(r)).transpose()?;
        Ok(Symmetry { name: self.word(name)?, map, result, doc: ron.doc })
    }

    fn result_map(&self, raw: Raw<'a>) -> Result<ResultMap> {
        match self.shape(raw) {
            Shape::Map => {
                let parts: RawMap<'a> = self.get(raw)?;
                let parts = parts.0.iter().map(|(name, part)| Ok((self.word(*name)?, self.result_map(*part)?)));
                Ok(ResultMap::Parts(self.span(raw), parts.collect::<Result<_>>()?))
            }
            _ => self.level_or_expr(raw).map(ResultMap::Expr),
        }
    }

    fn image(&self, raw: Raw<'a>) -> Result<Image> {
        let renaming = |map: RawMap<'a>| {
            map.0.iter().map(|(a, b)| Ok((self.word(*a)?, self.word(*b)?))).collect::<Result<Vec<_>>>()
        };
        match self.shape(raw) {
            Shape::Map => Ok(Image::Levels { from: None, map: renaming(self.get(raw)?)? }),
            Shape::Variant("From") => {
                let FromRon::From(input, map) = self.get(raw)?;
                Ok(Image::Levels { from: Some(self.word(input)?), map: renaming(map)? })
            }
            _ => self.expr(raw).map(Image::Expr),
        }
    }

    pub(super) fn continuity(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<Continuity> {
        let words = |list: Vec<Raw<'a>>| list.into_iter().map(|w| self.word(w)).collect::<Result<Vec<_>>>();
        let (kind, doc) = match self.get::<ContinuityRon<'a>>(raw)? {
            ContinuityRon::Border { when, map, free, doc } => {
                let map = map.0.iter().map(|(n, i)| Ok((self.word(*n)?, self.image(*i)?))).collect::<Result<_>>()?;
                (ContinuityKind::Border { when: self.condition(when)?, map, free: words(free)? }, doc)
            }
            ContinuityRon::Switch { of, doc } => (ContinuityKind::Switch(words(of)?), doc),
        };
        Ok(Continuity { name: self.word(name)?, kind, doc })
    }
}
