//! Rows: guards, lines and values, tied to the output, and references to the
//! value of another row.
//!
//! References and symmetric images are lowered by *substitution*: the other
//! row is lowered again in an environment in which some inputs mean something
//! else. That is the whole treatment of `case(…)` and of `is:`.

use std::rc::Rc;

use super::scope::Env;
use super::terms::{Expected, Term};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::domain::Domain;
use crate::program::pool::{CondId, ExprId};
use crate::program::{InputId, LevelTerm, Line, Row};
use crate::table::expr::Expr;
use crate::table::{self, Case, CaseBody, ResultMap};
use crate::text::closest::nearest;

/// A line of a row, its value not yet tied to the output.
pub(super) struct LoweredLine {
    pub(super) condition: CondId,
    pub(super) condition_span: Option<Span>,
    pub(super) value: Term,
    pub(super) span: Span,
}

impl<'t> Lowering<'t> {
    pub(super) fn row(&mut self, case: &'t Case) -> Result<Row> {
        let env = Env::of_case(case.id.value);
        let (guard, lines, maps) = self.row_parts(&case.id, &env)?;
        self.row_of(case, guard, lines, &maps, &env, Vec::new())
    }

    /// A row, its results mapped and tied to the output.
    pub(super) fn row_of(
        &mut self,
        case: &'t Case,
        guard: CondId,
        lines: Vec<LoweredLine>,
        maps: &[&ResultMap],
        env: &Env,
        under: Vec<String>,
    ) -> Result<Row> {
        let guard_span = match &case.body {
            CaseBody::Rows { when, .. } => when.span,
            CaseBody::Image { span, .. } => *span,
        };
        let lines = lines.into_iter().map(|line| {
            let value = self.apply_results(maps, line.value, line.span, env)?;
            let values = self.result(value, line.span)?;
            let (condition, condition_span) = (line.condition, line.condition_span);
            Ok(Line { condition, condition_span, values, span: line.span })
        });
        let lines = lines.collect::<Result<Vec<_>>>()?;
        Ok(Row {
            id: case.id.value,
            span: case.span,
            guard,
            guard_span,
            under,
            lines,
            section: case.section.clone(),
            doc: case.doc.clone(),
            errata: case.errata.clone(),
            allow: case.allow.clone(),
        })
    }

    /// Applies the result maps of symmetries, one after the other.
    fn apply_results(&mut self, maps: &[&ResultMap], value: Term, span: Span, env: &Env) -> Result<Term> {
        maps.iter().try_fold(value, |value, map| self.apply_result(map, value, span, env))
    }

    /// Guard and lines of a case in an environment, and the maps that its results still need, in order.
    pub(super) fn row_parts(
        &mut self,
        id: &Spanned<u32>,
        env: &Env,
    ) -> Result<(CondId, Vec<LoweredLine>, Vec<&'t ResultMap>)> {
        let case = self.find_case(id)?;
        match &case.body {
            CaseBody::Rows { when, lines, .. } => {
                let expected = self.expected_output();
                Ok((self.condition(when, env)?, self.lines(lines, env, expected)?, Vec::new()))
            }
            CaseBody::Image { case: base, under, .. } => {
                if let [_, second, ..] = under.as_slice() {
                    self.table.since(2, second.span, "an image under several symmetries")?;
                }
                let base_case = self.find_case(base)?;
                if matches!(base_case.body, CaseBody::Image { .. }) {
                    self.check_image_of_image(case, base)?;
                }
                // The last symmetry is the outermost: what it maps is the image under those before.
                let (mut inner, mut maps) = (env.clone(), Vec::new());
                for name in under.iter().rev() {
                    let symmetry = self.find_symmetry(name)?;
                    let images = self.images(&symmetry.map, &inner)?;
                    inner = self.mapped_env(images, &inner);
                    maps.splice(0..0, symmetry.result.as_ref());
                }
                let (guard, lines, mut before) = self.row_parts(base, &inner)?;
                before.extend(maps);
                Ok((guard, lines, before))
            }
        }
    }

    /// Follows images of images: version 1 of the language has none, and no version lets them lead in a circle.
    fn check_image_of_image(&self, case: &Case, base: &Spanned<u32>) -> Result<()> {
        if self.table.language.value < 2 {
            let message = format!("case {} is itself an image", base.value);
            return Err(Diagnostic::error(codes::REFERENCE_DEPTH, message)
                .at(base.span, "an image is taken of a case that is written out")
                .help("name the case that has a guard and a value, or write `language: 2`"));
        }
        let (mut chain, mut next) = (vec![case.id.value], base);
        while let CaseBody::Image { case: further, .. } = &self.find_case(next)?.body {
            chain.push(next.value);
            if chain.iter().filter(|id| **id == next.value).count() > 1 {
                let chain = chain.iter().map(u32::to_string).collect::<Vec<_>>().join(" -> ");
                return Err(Diagnostic::error(codes::CIRCULAR_CASE, format!("case {} is its own image", next.value))
                    .at(next.span, format!("closes the circle {chain}"))
                    .help("write out the guard and the value of one of these cases"));
            }
            next = further;
        }
        Ok(())
    }

    /// The symmetry with a name.
    pub(super) fn find_symmetry(&self, name: &Spanned<String>) -> Result<&'t table::Symmetry> {
        let table = self.table;
        table.symmetries.iter().find(|symmetry| symmetry.name.value == name.value).ok_or_else(|| {
            let known = table.symmetries.iter().map(|symmetry| symmetry.name.value.as_str());
            let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("there is no symmetry `{}`", name.value))
                .at(name.span, "not under `symmetries`");
            match nearest(&name.value, known) {
                Some(close) => error.did_you_mean(&name.value, close),
                None => error,
            }
        })
    }

    pub(super) fn find_case(&self, id: &Spanned<u32>) -> Result<&'t Case> {
        match self.case_index.get(&id.value) {
            Some(index) => Ok(&self.table.cases[*index]),
            None => {
                let mut known: Vec<u32> = self.case_index.keys().copied().collect();
                known.sort_unstable();
                let shown: Vec<String> = known.iter().take(40).map(u32::to_string).collect();
                Err(Diagnostic::error(codes::MISSING_CASE, format!("there is no case {}", id.value))
                    .at(id.span, "refers to a case that is missing")
                    .help(format!(
                        "the cases are: {}{}",
                        shown.join(", "),
                        if known.len() > 40 { ", ..." } else { "" }
                    )))
            }
        }
    }

    pub(super) fn lines(&mut self, lines: &[table::Line], env: &Env, expected: Expected) -> Result<Vec<LoweredLine>> {
        let lines = lines.iter().map(|line| {
            let condition = match &line.condition {
                Some(condition) => self.condition(condition, env)?,
                None => self.pool.always(true),
            };
            let value = self.term(&line.value, env, expected.clone())?;
            let condition_span = line.condition.as_ref().map(|condition| condition.span);
            Ok(LoweredLine { condition, condition_span, value, span: line.value.span })
        });
        lines.collect()
    }

    /// `case(11, V = none)`: the value of another row, its guard not tested.
    pub(super) fn case_value(&mut self, id: &Spanned<u32>, set: &[(Spanned<String>, Expr)], env: &Env) -> Result<Term> {
        if env.cases.contains(&id.value) {
            let chain = env.cases.iter().chain([&id.value]).map(u32::to_string).collect::<Vec<_>>().join(" -> ");
            return Err(Diagnostic::error(codes::CIRCULAR_CASE, format!("case {} refers to itself", id.value))
                .at(id.span, format!("closes the circle {chain}"))
                .help("write out the value of one of these cases"));
        }
        if env.referenced {
            let from = env.cases.last().copied().unwrap_or_default();
            return Err(Diagnostic::error(
                codes::REFERENCE_DEPTH,
                format!("case {from} is referred to and refers to case {}", id.value),
            )
            .at(id.span, "references are one deep")
            .help("write out the value of one of the two"));
        }
        let mut overrides = (*env.overrides).clone();
        for (name, value) in set {
            let Some(input) = self.input_named(&name.value) else {
                return Err(self.unknown_input(name, "only inputs can be replaced"));
            };
            let term = self.term_for_input(input, value, env)?;
            overrides.insert(input, term);
        }
        let mut inner =
            Env { overrides: Rc::new(overrides), cases: env.cases.clone(), referenced: true, ..Env::default() };
        inner.cases.push(id.value);
        let (_, lines, maps) = self.row_parts(id, &inner)?;
        // The default applies where no line does; the guard is not part of the value.
        let mut term = self.default_term(&inner)?;
        for line in lines.iter().rev() {
            let span = line.span;
            let value = self.apply_results(&maps, line.value.clone(), span, &inner)?;
            term = match self.pool.truth(line.condition) {
                Some(true) => value,
                _ => self.choose(line.condition, value, term, span)?,
            };
        }
        Ok(term)
    }

    /// Lowers an expression that replaces an input.
    pub(super) fn term_for_input(&mut self, input: InputId, value: &Expr, env: &Env) -> Result<Term> {
        match self.input_sets[input.index()] {
            None if self.inputs[input.index()].domain == Domain::Word => {
                let term = self.term(value, env, Expected::Anything)?;
                self.word_of(&term, value.span).map(Term::Word)
            }
            None => {
                let number = self.numeric(value, env)?;
                self.check_range(input, number, value.span, env)?;
                Ok(Term::Number(number))
            }
            Some(SetId::BOOL) => Ok(Term::Bool(self.condition(value, env)?)),
            Some(set) => {
                if let Some(level) = self.literal_level(set, value, env)? {
                    return Ok(self.level_of(set, LevelTerm::Const(level)));
                }
                Ok(Term::Level(set, self.level_term(set, value, env, "this input has other levels")?))
            }
        }
    }

    /// Refuses a constant that its input cannot be. What is constant only because
    /// inputs are replaced may be out of reach there, so it is left alone.
    fn check_range(&self, input: InputId, number: ExprId, span: Span, env: &Env) -> Result<()> {
        let input = &self.inputs[input.index()];
        match (&input.domain, self.pool.constant(number)) {
            (Domain::Continuous { lo, hi, .. }, Some(value))
                if env.overrides.is_empty() && !(*lo..=*hi).contains(&value) =>
            {
                let message = format!("{value} is not in the range {lo} to {hi} of `{}`", input.name);
                Err(Diagnostic::error(codes::DOMAIN, message)
                    .at(span, format!("replaces `{}`", input.name))
                    .at(input.span, "declared here"))
            }
            _ => Ok(()),
        }
    }

    /// The default, as a value in an environment.
    pub(super) fn default_term(&mut self, env: &Env) -> Result<Term> {
        let expected = self.expected_output();
        self.term(&self.table.default, env, expected)
    }
}
