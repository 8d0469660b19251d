//! Symmetries: what each mapped input becomes, and what becomes of the result.

use std::collections::HashMap;
use std::rc::Rc;

use super::scope::Env;
use super::terms::Term;
use super::{Lowering, Result};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::{self, Continuity, ExprId, InputId, LevelTerm, Symmetry};
use crate::table::{self, ContinuityKind, Image, names};

/// The images of discrete and of continuous inputs.
type MappedInputs = (Vec<(InputId, LevelTerm)>, Vec<(InputId, ExprId)>);

impl<'t> Lowering<'t> {
    /// The term that each mapped input becomes under a symmetry.
    pub(super) fn images(&mut self, map: &'t [(Spanned<String>, Image)], env: &Env) -> Result<HashMap<InputId, Term>> {
        let mut images = HashMap::new();
        for (name, image) in map {
            let Some(input) = self.input_written(name)? else {
                return Err(self.unknown_input(name, "only inputs are mapped"));
            };
            let term = match image {
                Image::Expr(expr) => self.term_for_input(input, expr, env)?,
                Image::Levels { from, map } => self.renamed(input, name, from.as_ref(), map, env)?,
            };
            if images.insert(input, term).is_some() {
                return Err(Diagnostic::error(codes::DUPLICATE, format!("`{}` is mapped twice", name.value))
                    .at(name.span, "again"));
            }
        }
        Ok(images)
    }

    pub(super) fn renamed(
        &mut self,
        input: InputId,
        name: &Spanned<String>,
        from: Option<&Spanned<String>>,
        map: &[(Spanned<String>, Spanned<String>)],
        env: &Env,
    ) -> Result<Term> {
        let no_levels =
            |at: Span| Diagnostic::error(codes::SYMMETRY, "only named levels can be renamed").at(at, "has none");
        let origin = match from {
            None => input,
            Some(from) => {
                self.input_written(from)?.ok_or_else(|| self.unknown_input(from, "only inputs are mapped"))?
            }
        };
        let to_set = self.input_sets[input.index()].ok_or_else(|| no_levels(name.span))?;
        if self.is_wide(to_set) {
            return Err(Diagnostic::error(codes::SYMMETRY, "integers of any range are not renamed")
                .at(name.span, "more than 64 integers"));
        }
        let Term::Level(from_set, term) = self.input_term(origin, env) else { return Err(no_levels(name.span)) };
        let mut renaming = Vec::new();
        for (index, level) in self.sets[from_set.0].names.iter().enumerate() {
            let new = map.iter().find(|(old, _)| self.sets[from_set.0].find(&old.value) == Some(index as u8));
            let (target, span) = new.map_or((level.as_str(), name.span), |(_, new)| (new.value.as_str(), new.span));
            match self.sets[to_set.0].find(target) {
                Some(index) => renaming.push(index),
                None => return Err(self.unknown_level(to_set, target, span)),
            }
        }
        let mut seen = HashMap::new();
        for (old, _) in map {
            let Some(level) = self.sets[from_set.0].find(&old.value) else {
                return Err(self.unknown_level(from_set, &old.value, old.span));
            };
            if let Some(first) = seen.insert(level, old.span) {
                let message =
                    format!("the level `{}` is renamed twice", self.sets[from_set.0].names[usize::from(level)]);
                return Err(Diagnostic::error(codes::DUPLICATE, message).at(old.span, "again").at(first, "first here"));
            }
        }
        Ok(self.level_of(to_set, LevelTerm::Map(term, renaming.into())))
    }

    pub(super) fn symmetry(&mut self, symmetry: &'t table::Symmetry) -> Result<Symmetry> {
        names::check_inner(&symmetry.name.value, "a symmetry", symmetry.name.span)?;
        let (levels, numbers) = self.mapped_inputs(&symmetry.map, symmetry.name.span)?;
        let result = symmetry.result.as_ref().map(|map| self.result_map(map)).transpose()?;
        let (name, doc) = (symmetry.name.value.clone(), symmetry.doc.clone());
        Ok(Symmetry { name, doc, levels, numbers, result, span: symmetry.name.span })
    }

    /// Places without jumps: a border is a map of the inputs with a condition.
    pub(super) fn continuity(&mut self, continuity: &'t table::Continuity) -> Result<Continuity> {
        let (name, span) = (&continuity.name.value, continuity.name.span);
        names::check_inner(name, "a border or switch", span)?;
        let (mut levels, mut numbers) = (Vec::new(), Vec::new());
        let kind = match &continuity.kind {
            ContinuityKind::Border { when, map, free } => {
                let free = self.listed(free)?;
                let condition = self.condition(when, &Env::default())?;
                (levels, numbers) = self.mapped_inputs(map, span)?;
                let mapped = levels.iter().map(|(input, _)| *input).chain(numbers.iter().map(|(input, _)| *input));
                if let Some(both) = mapped.into_iter().find(|input| free.contains(input)) {
                    let message = format!("`{}` is mapped and free", self.inputs[both.index()].name);
                    return Err(Diagnostic::error(codes::SYMMETRY, message)
                        .at(span, "here")
                        .help("a free input can be anything on the other side; name it in `map` or in `free`"));
                }
                program::ContinuityKind::Border(condition, free)
            }
            ContinuityKind::Switch(of) => {
                let inputs = self.listed(of)?;
                for (input, name) in inputs.iter().zip(of) {
                    if self.input_sets[input.index()].is_some() {
                        let message = format!("`{}` cannot stand here", name.value);
                        return Err(
                            Diagnostic::error(codes::SYMMETRY, message).at(name.span, "only a range can be compared")
                        );
                    }
                }
                program::ContinuityKind::Switch(inputs)
            }
        };
        let (name, doc) = (name.clone(), continuity.doc.clone());
        Ok(Continuity { map: Symmetry { name, doc, levels, numbers, result: None, span }, kind })
    }

    /// The inputs of a list.
    fn listed(&mut self, names: &[Spanned<String>]) -> Result<Vec<InputId>> {
        let find = |name: &Spanned<String>| match self.input_written(name)? {
            Some(input) => Ok(input),
            None => Err(self.unknown_input(name, "only inputs are listed here")),
        };
        names.iter().map(find).collect()
    }

    /// The images of inputs, ready for a program.
    fn mapped_inputs(&mut self, map: &'t [(Spanned<String>, Image)], span: Span) -> Result<MappedInputs> {
        let mut images: Vec<_> = self.images(map, &Env::default())?.into_iter().collect();
        images.sort_by_key(|(input, _)| *input);
        let (mut levels, mut numbers) = (Vec::new(), Vec::new());
        for (input, term) in images {
            match term {
                Term::Number(expr) | Term::Word(expr) => numbers.push((input, expr)),
                Term::Level(_, term) => levels.push((input, (*term).clone())),
                Term::Bool(condition) => {
                    levels.push((input, self.truth_as_level(condition)));
                }
                Term::Whole(_) | Term::Vector(_) | Term::List(_) | Term::Record(_) => {
                    return Err(Diagnostic::error(codes::SYMMETRY, "an input has a single value").at(span, "here"));
                }
            }
        }
        Ok((levels, numbers))
    }

    /// An environment in which inputs mean their images under a symmetry.
    pub(super) fn mapped_env(&self, images: HashMap<InputId, Term>, env: &Env) -> Env {
        let mut overrides = (*env.overrides).clone();
        overrides.extend(images);
        Env { overrides: Rc::new(overrides), names: Rc::default(), ..env.clone() }
    }
}
