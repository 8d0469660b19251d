//! Linear constraints that can, or cannot, hold together over the reals: elimination
//! after Fourier and Motzkin, with exact rationals.
//!
//! A table has few continuous inputs and a path few comparisons, so the
//! method's bad worst case does not matter. What is not linear (a product of
//! inputs, a square root) is a variable of its own that could be anything: an
//! answer "cannot hold" is always right, "can hold" is then not certain.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap};

use super::normal::{Affine, Term};
use super::rational::Rational;
use super::{InputId, Program};

/// Most constraints that one elimination may leave; beyond it "can hold" is the answer.
const MAX_CONSTRAINTS: usize = 512;
/// So many constraints are eliminated as they are.
const FEW: usize = 12;
/// Most pairs of constraints that one elimination may look at.
const MAX_PAIRS: usize = 1 << 14;

/// The sign of a form.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Sign {
    Positive,
    Zero,
    Negative,
}

impl Sign {
    pub(crate) const ALL: [Sign; 3] = [Sign::Positive, Sign::Zero, Sign::Negative];

    /// The sign of what has this order to zero.
    pub(crate) fn of(order: Ordering) -> Self {
        match order {
            Ordering::Greater => Sign::Positive,
            Ordering::Equal => Sign::Zero,
            Ordering::Less => Sign::Negative,
        }
    }

    pub(crate) fn flip(self) -> Self {
        match self {
            Sign::Positive => Sign::Negative,
            Sign::Zero => Sign::Zero,
            Sign::Negative => Sign::Positive,
        }
    }
}

/// `form > 0` if strict, else `form >= 0`.
struct Constraint {
    form: Affine,
    strict: bool,
}

/// Steps of an operation on sets that looking at a constraint, or at a pair of them, takes as long as.
const STEPS: usize = 20;

/// Returns whether the forms can have these signs at one point of the program's domain. Adds to `work` what
/// that took, in steps of an operation on sets.
pub(crate) fn can_hold<'a>(program: &Program, signs: impl Iterator<Item = (&'a Affine, Sign)>, work: &mut u64) -> bool {
    feasible(program, signs, &mut Vec::new(), work).unwrap_or(true)
}

/// A point of the program's domain at which the forms have these signs, by
/// input; inputs that no form mentions are left out. `None` if there is none or
/// none was found, and if the forms are not linear in the inputs.
pub(crate) fn point<'a>(
    program: &Program,
    signs: impl Iterator<Item = (&'a Affine, Sign)>,
) -> Option<BTreeMap<InputId, Rational>> {
    let mut steps = Vec::new();
    if feasible(program, signs, &mut steps, &mut 0) != Some(true) {
        return None;
    }
    let mut point: BTreeMap<Term, Rational> = BTreeMap::new();
    while let Some((variable, bounds)) = steps.pop() {
        let (mut lo, mut hi): (Option<Rational>, Option<Rational>) = (None, None);
        for bound in &bounds {
            let factor = *bound.form.terms.get(&variable)?;
            let mut rest = bound.form.constant;
            for (term, factor) in bound.form.terms.iter().filter(|(term, _)| **term != variable) {
                rest = rest.plus(point.get(term)?.times(*factor)?)?;
            }
            let limit = (-rest).times(factor.reciprocal()?)?;
            if factor.is_positive() {
                lo = Some(lo.map_or(limit, |lo| lo.max(limit)));
            } else {
                hi = Some(hi.map_or(limit, |hi| hi.min(limit)));
            }
        }
        let salt = if let Term::Input(input) = &variable { input.index() } else { 0 };
        let value = between(lo?, hi?, salt)?;
        point.insert(variable, value);
    }
    point
        .into_iter()
        .map(|(term, value)| if let Term::Input(input) = term { Some((input, value)) } else { None })
        .collect()
}

/// A number between two others that is short in binary and, for a different
/// `salt`, at a different place: points that mean nothing in particular.
pub(crate) fn between(lo: Rational, hi: Rational, salt: usize) -> Option<Rational> {
    // No sum, difference or complement of two of these is another one.
    let places = [41, 89, 55, 71, 37, 83];
    let step = hi.minus(lo)?.times(Rational::fraction(places[salt % places.len()], 128)?)?;
    let inside = lo.plus(step)?;
    let rounded = (inside.times(Rational::whole(1024))?.round()).times(Rational::fraction(1, 1024)?)?;
    Some(if lo < rounded && rounded < hi { rounded } else { inside })
}

/// A variable that was eliminated, with what bounds it.
type Step = (Term, Vec<Constraint>);

/// The same; `None` if numbers or their count grow too large.
fn feasible<'a>(
    program: &Program,
    signs: impl Iterator<Item = (&'a Affine, Sign)>,
    steps: &mut Vec<Step>,
    work: &mut u64,
) -> Option<bool> {
    let minus = Rational::whole(-1);
    let mut constraints = Vec::new();
    for (form, sign) in signs {
        let strict = sign != Sign::Zero;
        if sign != Sign::Negative {
            constraints.push(Constraint { form: form.clone(), strict });
        }
        if sign != Sign::Positive {
            constraints.push(Constraint { form: form.times(minus)?, strict });
        }
    }
    let mut variables: Vec<Term> = constraints.iter().flat_map(|c| c.form.terms.keys().cloned()).collect();
    variables.sort();
    variables.dedup();
    for variable in &variables {
        let Term::Input(input) = variable else { continue };
        if let Some((lo, hi)) = program.inputs[input.index()].domain.range() {
            let one = Rational::whole(1);
            let bound = |factor: Rational, constant: Rational| Constraint {
                form: Affine { terms: [(variable.clone(), factor)].into(), constant },
                strict: false,
            };
            constraints.extend(Rational::exact(lo).map(|lo| bound(one, -lo)));
            constraints.extend(Rational::exact(hi).map(|hi| bound(minus, hi)));
        }
    }
    constraints = tightest(constraints);
    for variable in &variables {
        let (mut above, mut below, mut kept) = (Vec::new(), Vec::new(), Vec::new());
        for constraint in constraints {
            match constraint.form.terms.get(variable) {
                Some(factor) if factor.is_positive() => above.push(constraint),
                Some(_) => below.push(constraint),
                None if !constraint.form.terms.is_empty() => kept.push(constraint),
                None if constraint.violated() => return Some(false),
                None => {}
            }
        }
        let pairs = above.len() * below.len();
        if pairs > MAX_PAIRS {
            return None;
        }
        *work += ((pairs + kept.len() + above.len() + below.len()) * STEPS) as u64;
        for a in &above {
            for b in &below {
                kept.push(a.without(variable, b)?);
            }
        }
        // Where nothing is put together nothing follows that did not before.
        constraints = if pairs == 0 { kept } else { tightest(kept) };
        if constraints.len() > MAX_CONSTRAINTS {
            return None;
        }
        above.append(&mut below);
        steps.push((variable.clone(), above));
    }
    Some(!constraints.iter().any(Constraint::violated))
}

/// Of constraints that bound the same multiple of the same terms, the one from which the others follow.
/// Many constants that one number is compared with leave two constraints, whatever their number.
fn tightest(constraints: Vec<Constraint>) -> Vec<Constraint> {
    if constraints.len() <= FEW {
        return constraints;
    }
    let mut places: HashMap<BTreeMap<Term, Rational>, usize> = HashMap::new();
    let mut kept: Vec<Constraint> = Vec::new();
    for Constraint { form, strict } in constraints {
        let form = match scaled(form) {
            Ok(form) => form,
            Err(form) => {
                kept.push(Constraint { form, strict });
                continue;
            }
        };
        match places.get(&form.terms) {
            Some(place) => {
                let known = &mut kept[*place];
                if form.constant < known.form.constant || form.constant == known.form.constant && strict {
                    *known = Constraint { form, strict };
                }
            }
            None => {
                places.insert(form.terms.clone(), kept.len());
                kept.push(Constraint { form, strict });
            }
        }
    }
    kept
}

/// The form divided by the magnitude of its first factor; the form itself if it has none, or numbers grow too large.
fn scaled(form: Affine) -> Result<Affine, Affine> {
    let Some(leading) = form.terms.values().next().map(|leading| leading.abs()) else { return Err(form) };
    if leading == Rational::ONE {
        return Ok(form);
    }
    leading.reciprocal().and_then(|scale| form.times(scale)).ok_or(form)
}

impl Constraint {
    /// Returns whether this constraint, which has no variable left, does not hold.
    fn violated(&self) -> bool {
        self.form.constant.is_negative() || self.strict && self.form.constant.is_zero()
    }

    /// The consequence, without the variable, of two constraints that bound it from either side.
    fn without(&self, variable: &Term, other: &Self) -> Option<Self> {
        let (a, b) = (self.form.terms[variable], other.form.terms[variable].abs());
        debug_assert!(a.times(b).is_none_or(|product| product.is_positive()));
        let form = self.form.times(b)?.plus(&other.form.times(a)?)?;
        Some(Self { form, strict: self.strict || other.strict })
    }
}

#[cfg(test)]
mod tests {
    use super::super::InputId;
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    fn affine(x: i64, y: i64, constant: i64) -> Affine {
        let terms = [(0, x), (1, y)].into_iter().filter(|(_, factor)| *factor != 0);
        Affine {
            terms: terms.map(|(i, f)| (Term::Input(InputId::new(i)), Rational::whole(f))).collect(),
            constant: Rational::whole(constant),
        }
    }

    #[test]
    fn constraints_and_the_domain_are_put_together() {
        let text = r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)},
            output: Number(), cases: [Case(id: 1, when: "x < y", value: 1)], default: 0)"#;
        let table = Table::parse(Source::new("t", text)).unwrap_or_else(|e| panic!("{e}"));
        let program = Program::check(&table).unwrap_or_else(|e| panic!("{e}"));
        let can = |signs: &[(Affine, Sign)]| can_hold(&program, signs.iter().map(|(form, sign)| (form, *sign)), &mut 0);
        use Sign::{Negative, Positive, Zero};
        assert!(can(&[(affine(1, 1, -2), Zero)]));
        assert!(!can(&[(affine(1, 1, -2), Positive)]));
        assert!(!can(&[(affine(1, 0, 0), Negative)]));
        // x > y and y > x; x > y, y = 1; x + y = 1, x - y = 0, x > 0 (the middle).
        assert!(!can(&[(affine(1, -1, 0), Positive), (affine(1, -1, 0), Negative)]));
        assert!(!can(&[(affine(1, -1, 0), Positive), (affine(0, 1, -1), Zero)]));
        assert!(can(&[(affine(1, 1, -1), Zero), (affine(1, -1, 0), Zero), (affine(1, 0, 0), Positive)]));
        assert!(!can(&[(affine(1, 1, -1), Zero), (affine(1, -1, 0), Zero), (affine(2, 0, -1), Positive)]));
    }
}
