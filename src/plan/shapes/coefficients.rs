//! Values without a branch: the key selects the coefficients of sums of
//! multiples of the inputs, and the result is their minimum or maximum.
//!
//! A maximum is the negative of the minimum of the negatives, so that one
//! formula serves both. Negation is exact, so that nothing is lost by it.

use std::collections::{HashMap, HashSet};

use super::Definition;
use crate::plan::arms::Arms;
use crate::plan::builder::{Builder, Result};
use crate::plan::key::{KeyLayout, MAX_BUFFER_BITS};
use crate::plan::knowledge::Knowledge;
use crate::plan::setting::Setting;
use crate::plan::{Coefficients, Fit, Form, Leaf, Piece, Plan, Step, StepId};
use crate::program::normal::{Affine, Normaliser, Term};
use crate::program::rational::Rational;
use crate::program::{ExprId, InputId, LevelSet, Node, Pool, Program, TernaryOp};

/// Most sums of one value.
const MAX_FORMS: usize = 4;

pub(super) static SHAPE: Definition = Definition {
    name: "coefficients",
    summary: "the key selects coefficients of a minimum or maximum of sums, in a buffer; no branch",
    reads_buffer: true,
    needs_key: true,
    holds_data: true,
    plan,
};

/// Coefficients where they can be had, the arms of a `switch` elsewhere.
fn plan<'p>(setting: &Setting<'p, '_>) -> Result<Plan<'p>> {
    let program = setting.program;
    let key = KeyLayout::new(program)?;
    key.fits(MAX_BUFFER_BITS, "use `ladder`")?;
    if !program.output.is_real() {
        return Err("its output is no number; use `switch` or `ladder`".to_owned());
    }
    let mut builder = Builder::new(program);
    let mut fitter = Fitter { normaliser: Normaliser::default(), clamp: common_clamp(program), first: None };
    let arms = Arms::new(&mut builder, setting)?;
    let mut of: Vec<Option<Leaf>> = Vec::with_capacity(setting.states.len());
    let claims = setting.claims()?;
    let mut levels = vec![0; program.inputs.len()];
    for state in &setting.states {
        program.states.write(*state, &mut levels);
        let mut known = Knowledge::none(program);
        for (input, _) in program.states.digits() {
            known.restrict(*input, LevelSet::one(levels[input.index()]));
        }
        let rows = builder.rows_of_state(claims, *state, &levels);
        let step = builder.rows(&rows, &known)?;
        of.push(fitter.leaf(&builder, step));
    }
    let mut raw: Vec<(Leaf, Vec<Raw>)> = Vec::new();
    let mut index: HashMap<Leaf, Option<usize>> = HashMap::new();
    let mut fit_of = Vec::with_capacity(of.len());
    for leaf in of {
        fit_of.push(leaf.and_then(|leaf| {
            *index.entry(leaf).or_insert_with_key(|leaf| {
                raw.push((leaf.clone(), fitter.pieces(&builder.pool, leaf)?));
                Some(raw.len() - 1)
            })
        }));
    }
    if raw.is_empty() {
        return Err(match fitter.first {
            Some(row) => format!(
                "no value is the minimum or the maximum of up to {MAX_FORMS} sums of multiples of inputs (case {} is not, for instance); use `switch` or `ladder`",
                program.rows[row].id
            ),
            None => "no state decides for a case by itself; use `ladder`".to_owned(),
        });
    }
    let coefficients = padded(&raw, fitter.clamp);
    // The ways of the other states, numbered behind the coefficients.
    let mut rest: Vec<u16> = Vec::new();
    let mut lookup = vec![0_u16; program.states.count()];
    let mut without = 0.0;
    for (place, state) in setting.states.iter().enumerate() {
        let number = match fit_of[place] {
            Some(fit) => fit,
            None => {
                without += setting.shares[place];
                let arm = arms.of[place];
                let known = rest.iter().position(|known| *known == arm);
                coefficients.fits.len()
                    + known.unwrap_or_else(|| {
                        rest.push(arm);
                        rest.len() - 1
                    })
            }
        };
        lookup[*state] = u16::try_from(number).map_err(|_| "it has more than 65535 ways to go".to_owned())?;
    }
    let steps = arms.steps(&mut builder)?;
    let rest: Vec<StepId> = rest.into_iter().map(|arm| steps[usize::from(arm)]).collect();
    let branches = rest.len();
    let root = builder.push(Step::Coefficients { rest })?;
    let mut plan = builder.finish(setting, key, lookup, root);
    plan.notes.push(match branches {
        0 => format!("{} sets of coefficients, no branch", coefficients.fits.len()),
        _ => format!(
            "{} sets of coefficients; {branches} ways with branches where a case fetches, compares or is no minimum or maximum of sums, {:.1} % of the weight",
            coefficients.fits.len(),
            100.0 * without
        ),
    });
    plan.coefficients = coefficients;
    Ok(plan)
}

/// A value before it is known how many sums and which inputs all of them need.
struct Raw {
    sign: f64,
    forms: Vec<(f64, HashMap<InputId, f64>)>,
}

/// Makes all pieces alike: the same inputs, as many sums, the last one repeated.
fn padded(raw: &[(Leaf, Vec<Raw>)], clamp: Option<(f64, f64)>) -> Coefficients {
    let pieces = || raw.iter().flat_map(|(_, pieces)| pieces);
    let width = pieces().map(|piece| piece.forms.len()).max().unwrap_or(1);
    let mut inputs: Vec<InputId> =
        pieces().flat_map(|piece| &piece.forms).flat_map(|(_, factors)| factors.keys().copied()).collect();
    inputs.sort_unstable();
    inputs.dedup();
    let pad = |piece: &Raw| {
        let forms = piece.forms.iter().map(|(constant, factors)| Form {
            constant: *constant,
            factors: inputs.iter().map(|input| factors.get(input).copied().unwrap_or(0.0)).collect(),
        });
        let mut forms: Vec<Form> = forms.collect();
        while let (true, Some(last)) = (forms.len() < width, forms.last().cloned()) {
            forms.push(last);
        }
        Piece { sign: piece.sign, forms }
    };
    let fits = raw.iter().map(|(leaf, pieces)| Fit {
        row: leaf.row,
        line: leaf.line,
        pieces: pieces.iter().map(pad).collect(),
    });
    let fits = fits.collect();
    Coefficients { inputs, width, clamp, fits }
}

struct Fitter {
    normaliser: Normaliser,
    clamp: Option<(f64, f64)>,
    /// A case that has no coefficients.
    first: Option<usize>,
}

impl Fitter {
    /// A result that needs no test, no fetch and no selection, and no operation on constants that comes out
    /// otherwise in `f32` than over the reals.
    fn leaf(&self, builder: &Builder<'_>, step: StepId) -> Option<Leaf> {
        let Step::Leaf(leaf) = builder.step(step) else { return None };
        let pool = &builder.pool;
        let plain = |value: &ExprId| !pool.expr_facts(*value).selects && folds(pool, *value, &mut HashSet::new());
        leaf.values.iter().all(plain).then(|| leaf.clone())
    }

    /// The pieces of a result, if it has any.
    fn pieces(&mut self, pool: &Pool, leaf: &Leaf) -> Option<Vec<Raw>> {
        let pieces: Option<Vec<Raw>> = leaf.values.iter().map(|value| self.piece(pool, *value)).collect();
        if pieces.is_none() {
            self.first = self.first.or(leaf.row);
        }
        pieces
    }

    fn piece(&mut self, pool: &Pool, value: ExprId) -> Option<Raw> {
        let value = match (self.clamp, pool.node(value)) {
            (Some(_), Node::Ternary(TernaryOp::Clamp, inner, ..)) => inner,
            _ => value,
        };
        // A constant is its own sum, whether or not it is a rational of few digits.
        if let Some(constant) = pool.constant(value) {
            return Some(Raw { sign: 1.0, forms: vec![(constant, HashMap::new())] });
        }
        let clauses = self.normaliser.forms(pool, value)?;
        let (sign, forms): (f64, Vec<&Affine>) = match clauses {
            [clause] if clause.len() > 1 => (-1.0, clause.iter().collect()),
            clauses if clauses.iter().all(|clause| clause.len() == 1) => (1.0, clauses.iter().flatten().collect()),
            _ => return None,
        };
        if forms.len() > MAX_FORMS {
            return None;
        }
        let forms = forms.into_iter().map(|form| {
            let constant = exact(form.constant)? * sign;
            let factors = form.terms.iter().map(|(term, factor)| match term {
                Term::Input(input) => Some((*input, exact(*factor)? * sign)),
                Term::Constant(_) | Term::Unary(..) | Term::Binary(..) | Term::Ternary(..) => None,
            });
            Some((constant, factors.collect::<Option<HashMap<_, _>>>()?))
        });
        Some(Raw { sign, forms: forms.collect::<Option<_>>()? })
    }
}

/// Returns whether operations on constants, anywhere in an expression, are in `f32` what they are in `f64`.
fn folds(pool: &Pool, expr: ExprId, seen: &mut HashSet<ExprId>) -> bool {
    if !seen.insert(expr) {
        return true;
    }
    let node = pool.node(expr);
    pool.folds(node) && node.children().all(|part| folds(pool, part, seen))
}

/// A rational as the double that it is, if it is one.
fn exact(number: Rational) -> Option<f64> {
    let value = number.to_f64();
    (Rational::exact(value) == Some(number)).then_some(value)
}

/// The bounds that every value of a table is clamped to.
fn common_clamp(program: &Program) -> Option<(f64, f64)> {
    let pool = &program.pool;
    let lines = program.rows.iter().flat_map(|row| &row.lines).flat_map(|line| &line.values);
    let mut values = lines.chain(&program.default);
    let bounds = |value: &ExprId| {
        let Node::Ternary(TernaryOp::Clamp, _, lo, hi) = pool.node(*value) else { return None };
        Some((pool.constant(lo)?, pool.constant(hi)?))
    };
    let clamp = values.clone().find_map(bounds)?;
    let inside = |value: &ExprId| pool.constant(*value).is_some_and(|value| (clamp.0..=clamp.1).contains(&value));
    values.all(|value| inside(value) || bounds(value) == Some(clamp)).then_some(clamp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::Shape;

    #[test]
    fn most_of_rsmss_needs_no_branch() {
        let program = Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"));
        let plan = Plan::new(&program, Shape::Coefficients).unwrap_or_else(|e| panic!("{e}"));
        let coefficients = &plan.coefficients;
        assert_eq!((coefficients.clamp, coefficients.width), (Some((0.0, 1.0)), 2));
        let cases = coefficients.fits.iter().filter_map(|fit| Some(program.rows[fit.row?].id));
        let cases: std::collections::BTreeSet<u32> = cases.collect();
        // What is missing looks at neighbours or breaks.
        assert_eq!(cases.into_iter().collect::<Vec<_>>(), [vec![1, 2, 3], (16..=31).collect()].concat());
    }

    #[test]
    fn data_needs_no_branch_and_has_no_other_plan() {
        let program = Program::read("tables/ltc_matrix.ron").unwrap_or_else(|e| panic!("{e}"));
        assert!(program.is_data() && program.states.count() == 4096);
        for shape in Shape::ALL {
            match Plan::new(&program, shape) {
                Ok(plan) => assert_eq!(plan.notes, ["4096 sets of coefficients, no branch"], "{shape}"),
                Err(failure) => assert!(failure.to_string().contains("would all be written out"), "{shape}: {failure}"),
            }
        }
        assert!(Plan::new(&program, Shape::Coefficients).is_ok());
    }

    #[test]
    fn steps_are_no_sums() {
        let program = Program::read("tables/smsr.ron").unwrap_or_else(|e| panic!("{e}"));
        let plan = Plan::new(&program, Shape::Coefficients).unwrap_or_else(|e| panic!("{e}"));
        assert!(plan.notes[0].contains("ways with branches"), "{:?}", plan.notes);
    }
}
