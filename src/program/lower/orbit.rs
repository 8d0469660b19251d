//! A case that stands for all its images: one row for each image under the group that some
//! symmetries generate.
//!
//! The group is found by applying one symmetry after the other until nothing new is met. What
//! is met is told apart by what becomes of the inputs, in a form that is the same for the same
//! map: levels renamed one by one, numbers as normal forms over the reals. An image with the
//! guard and the value of one before adds no row.

use std::collections::{HashMap, HashSet};

use super::scope::Env;
use super::terms::Term;
use super::{Lowering, Result};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::bits::LevelSet;
use crate::program::normal::{NormalId, Normaliser};
use crate::program::pool::{Cond, CondId};
use crate::program::turn;
use crate::program::{InputId, Row};
use crate::table::{self, Case, CaseBody, ResultMap};

/// Most elements of a group.
const MAX_IMAGES: usize = 4096;

/// The thing that an input is the image of.
#[derive(Clone, PartialEq, Eq, Hash)]
enum Source {
    /// An input, and what becomes of each of its levels.
    Levels(InputId, Vec<u8>),
    /// A number.
    Number(NormalId),
}

/// An element of the group.
struct Element<'t> {
    env: Env,
    /// The maps of the result, in order.
    maps: Vec<&'t ResultMap>,
    /// The symmetries, the first one first.
    under: Vec<&'t str>,
}

impl<'t> Lowering<'t> {
    /// The row of a case, or the rows of all its images, itself first.
    pub(super) fn rows(&mut self, case: &'t Case) -> Result<Vec<Row>> {
        let first = self.row(case)?;
        let CaseBody::Rows { images, .. } = &case.body else { return Ok(vec![first]) };
        let Some(named) = images.first() else { return Ok(vec![first]) };
        let span = images.iter().fold(named.span, |all, name| Span::new(all.start, name.span.end));
        self.table.since(2, span, "`images`")?;
        let symmetries = images.iter().map(|name| self.find_symmetry(name)).collect::<Result<Vec<_>>>()?;
        let mut rows = vec![first];
        let mut seen = HashSet::from([self.shape(&rows[0])]);
        for element in self.group(case, &symmetries, span)? {
            let row = self.image(case, &element)?;
            if self.pool.truth(row.guard) != Some(false) && seen.insert(self.shape(&row)) {
                rows.push(row);
            }
        }
        Ok(rows)
    }

    /// The elements of the group but the identity, those of fewest symmetries first.
    fn group(&mut self, case: &Case, symmetries: &[&'t table::Symmetry], span: Span) -> Result<Vec<Element<'t>>> {
        let mut forms = Normaliser::default();
        let start = Element { env: Env::of_case(case.id.value), maps: Vec::new(), under: Vec::new() };
        let mut seen = HashSet::from([self.action(&start.env, &mut forms, span)?]);
        let mut elements = vec![start];
        let mut next = 0;
        while next < elements.len() {
            for symmetry in symmetries {
                let from = &elements[next];
                let (env, mut maps, mut under) = (from.env.clone(), from.maps.clone(), from.under.clone());
                let images = self.images(&symmetry.map, &env)?;
                let env = self.mapped_env(images, &env);
                // This symmetry is applied first: the images that it makes are those that the others map.
                maps.splice(0..0, symmetry.result.as_ref());
                under.insert(0, &symmetry.name.value);
                if !seen.insert(self.action(&env, &mut forms, span)?) {
                    continue;
                }
                if elements.len() == MAX_IMAGES {
                    let message = format!("these symmetries have more than {MAX_IMAGES} combinations");
                    return Err(Diagnostic::error(codes::SYMMETRY, message)
                        .at(span, "one applied after the other leads to ever more images")
                        .help("a symmetry that is applied again and again leads back, as a turn or a mirror does"));
                }
                elements.push(Element { env, maps, under });
            }
            next += 1;
        }
        Ok(elements.into_iter().skip(1).collect())
    }

    /// The map of all inputs, in a form that is the same for the same map.
    fn action(&mut self, env: &Env, forms: &mut Normaliser, span: Span) -> Result<Vec<Source>> {
        let unsuited = |me: &Self, input: InputId| {
            let message = format!("`{}` is mapped in a way that has no group", me.inputs[input.index()].name);
            Err(Diagnostic::error(codes::SYMMETRY, message)
                .at(span, "under these symmetries")
                .help("for `images`, levels are renamed one by one and numbers are mapped without conditions"))
        };
        let mut all = Vec::new();
        for input in (0..self.inputs.len()).map(InputId::new) {
            all.push(match self.input_term(input, env) {
                Term::Level(_, term) => match turn::renamed(&term) {
                    None => return unsuited(self, input),
                    Some((source, renaming)) => {
                        let count = self.input_sets[source.index()].map_or(2, |set| self.sets[set.0].count());
                        Source::Levels(source, renaming.unwrap_or_else(|| (0..count as u8).collect()))
                    }
                },
                Term::Bool(condition) => match self.bool_source(condition) {
                    None => return unsuited(self, input),
                    Some((source, negated)) => Source::Levels(source, if negated { vec![1, 0] } else { vec![0, 1] }),
                },
                Term::Number(expr) | Term::Word(expr) => {
                    let selects = self.pool.expr_facts(expr).selects;
                    match forms.normal(&self.pool, expr).filter(|_| !selects) {
                        None => return unsuited(self, input),
                        Some(form) => Source::Number(form),
                    }
                }
                Term::Whole(_) | Term::Vector(_) | Term::List(_) | Term::Record(_) => return unsuited(self, input),
            });
        }
        Ok(all)
    }

    /// The Bool that a condition is, and whether it is negated.
    fn bool_source(&self, condition: CondId) -> Option<(InputId, bool)> {
        match self.pool.cond(condition) {
            Cond::Level(input, levels) => Some((*input, *levels == LevelSet::one(0))),
            Cond::Not(inner) => self.bool_source(*inner).map(|(input, negated)| (input, !negated)),
            Cond::Const(_) | Cond::Compare(..) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => None,
        }
    }

    /// The row of an image.
    fn image(&mut self, case: &'t Case, element: &Element<'t>) -> Result<Row> {
        let (guard, lines, _) = self.row_parts(&case.id, &element.env)?;
        let under = element.under.iter().map(|name| (*name).to_owned()).collect();
        self.row_of(case, guard, lines, &element.maps, &element.env, under)
    }

    /// Guard, conditions and values, without the order in which conditions are tested: rows that differ in no more
    /// are one.
    fn shape(&mut self, row: &Row) -> Vec<u32> {
        let mut known = HashMap::new();
        let mut shape = vec![self.sorted(row.guard, &mut known).index() as u32];
        for line in &row.lines {
            shape.push(self.sorted(line.condition, &mut known).index() as u32);
            let mut values = line.values.clone();
            self.output.sort(&mut values, &|value| self.pool.constant(*value));
            shape.extend(values.iter().map(|value| value.index() as u32));
        }
        shape
    }

    fn sorted(&mut self, condition: CondId, known: &mut HashMap<CondId, CondId>) -> CondId {
        if let Some(done) = known.get(&condition) {
            return *done;
        }
        let mut all = |me: &mut Self, parts: &[CondId]| {
            let mut parts: Vec<CondId> = parts.iter().map(|part| me.sorted(*part, known)).collect();
            parts.sort_unstable();
            parts
        };
        let sorted = match self.pool.cond(condition).clone() {
            Cond::Const(_) | Cond::Level(..) | Cond::Compare(..) | Cond::If(..) => condition,
            Cond::Not(inner) => {
                let inner = all(self, &[inner])[0];
                self.pool.not(inner)
            }
            Cond::And(parts) => {
                let parts = all(self, &parts);
                self.pool.and(parts)
            }
            Cond::Or(parts) => {
                let parts = all(self, &parts);
                self.pool.or(parts)
            }
        };
        known.insert(condition, sorted);
        sorted
    }
}
