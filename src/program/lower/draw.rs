//! Drawing hints: their names resolved, and whether they suit their inputs.

use std::collections::HashSet;

use super::{Lowering, Result, SetId, keep};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::bits::LevelSet;
use crate::program::draw::Draw;
use crate::program::{Domain, InputId};
use crate::table::draw as written;

impl Lowering<'_> {
    /// The hints, in the order of the inputs.
    pub(super) fn draw(&mut self, errors: &mut Vec<Diagnostic>) -> Vec<(InputId, Draw)> {
        let table = self.table;
        for (name, _) in &table.draw {
            keep(self.input_written(name), errors);
        }
        let mut seen = HashSet::new();
        let mut hints = Vec::new();
        for (name, hint) in &self.table.draw {
            match self.hint(name, hint) {
                Ok((input, _)) if !seen.insert(input) => errors.push(
                    Diagnostic::error(codes::DUPLICATE, format!("`{}` is drawn twice", name.value))
                        .at(name.span, "again"),
                ),
                Ok(hint) => hints.push(hint),
                Err(error) => errors.push(error),
            }
        }
        hints.sort_by_key(|(input, _)| *input);
        hints
    }

    fn hint(&self, name: &Spanned<String>, hint: &written::Draw) -> Result<(InputId, Draw)> {
        let input = self.drawn(name)?;
        let draw = match hint {
            written::Draw::Across | written::Draw::Down | written::Draw::Position(_)
                if !matches!(self.inputs[input.index()].domain, Domain::Continuous { .. }) =>
            {
                return Err(unsuited(name.span, &format!("`{}` is no number", name.value), "expected a `Range`"));
            }
            written::Draw::Across => Draw::Across,
            written::Draw::Down => Draw::Down,
            written::Draw::Position(run) => {
                let run = self.hinted(run, "a run", |draw| matches!(draw, written::Draw::Run { .. }))?;
                Draw::Position(run)
            }
            written::Draw::Sides { of, levels } => {
                let set = self.levels_of(input, name)?;
                let mut sides = vec![Vec::new(); self.sets[set.0].count()];
                for (level, marked) in levels {
                    sides[self.level(set, level)?].clone_from(marked);
                }
                Draw::Sides { of: *of, levels: sides }
            }
            written::Draw::Dark(levels) => {
                let set = self.levels_of(input, name)?;
                let mut dark = LevelSet(0);
                for level in levels {
                    dark.0 |= 1 << self.level(set, level)?;
                }
                Draw::Dark(dark)
            }
            written::Draw::Run { along, ends } => {
                let set = self.levels_of(input, name)?;
                let along =
                    self.hinted(along, "sides", |draw| matches!(draw, written::Draw::Sides { of: None, .. }))?;
                let mut closed = vec![None; self.sets[set.0].count()];
                for (level, count) in ends {
                    closed[self.level(set, level)?] = Some(*count);
                }
                Draw::Run { along, ends: closed }
            }
            written::Draw::Strong(_) if self.input_sets[input.index()] != Some(SetId::BOOL) => {
                let message = format!("`{}` is no condition", name.value);
                return Err(unsuited(name.span, &message, "expected a `Bool`"));
            }
            written::Draw::Strong(of) => {
                Draw::Strong(self.hinted(of, "sides", |draw| matches!(draw, written::Draw::Sides { of: None, .. }))?)
            }
        };
        Ok((input, draw))
    }

    fn drawn(&self, name: &Spanned<String>) -> Result<InputId> {
        self.input_or_call(&name.value).ok_or_else(|| self.unknown_input(name, "only inputs are drawn"))
    }

    /// An input that is itself drawn in a certain way.
    fn hinted(&self, name: &Spanned<String>, what: &str, suits: fn(&written::Draw) -> bool) -> Result<InputId> {
        let input = self.drawn(name)?;
        match self.table.draw.iter().any(|(other, draw)| self.input_or_call(&other.value) == Some(input) && suits(draw))
        {
            true => Ok(input),
            false => {
                let message = format!("`{}` is not drawn as {what}", name.value);
                Err(unsuited(name.span, &message, &format!("expected an input that is drawn as {what}")))
            }
        }
    }

    fn levels_of(&self, input: InputId, name: &Spanned<String>) -> Result<SetId> {
        self.input_sets[input.index()]
            .ok_or_else(|| unsuited(name.span, &format!("`{}` has no levels", name.value), "expected a discrete input"))
    }

    fn level(&self, set: SetId, level: &Spanned<String>) -> Result<usize> {
        let found = self.sets[set.0].find(&level.value).map(usize::from);
        found.ok_or_else(|| self.unknown_level(set, &level.value, level.span))
    }
}

fn unsuited(span: Span, message: &str, label: &str) -> Diagnostic {
    Diagnostic::error(codes::TYPE, message)
        .at(span, label)
        .help("how inputs are drawn is described in docs/language.md, drawing hints")
}
