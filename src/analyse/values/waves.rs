//! Polynomials in inputs and in waves of them, to decide that two formulas are equal.
//!
//! A sum of terms, each a number times powers of inputs and at most one cosine or sine of a
//! linear form of inputs. Products of waves are sums of waves, so polynomials in such things
//! are such sums again, and sums that are equal have the same terms. Coefficients are `f64`;
//! `size` bounds all that was added up on the way, and so what rounding can have done.

use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;

use crate::program::operators::{BinaryAlgebra, TernaryAlgebra, UnaryAlgebra};
use crate::program::{BinaryOp, Domain, ExprId, InputId, Node, Program, UnaryOp};

/// Most terms of a sum; beyond it the form is given up.
const MAX_TERMS: usize = 2048;

/// Most operands that are looked at.
const MAX_STEPS: usize = 20_000;

/// The largest exponent of a power that is multiplied out.
const MAX_POWER: f64 = 16.0;

/// The share of the size that rounding can come to, generously.
const ROUNDING: f64 = 1e-14;

/// A product of powers of inputs and of a wave.
#[derive(Debug, Clone, Default, PartialEq, Eq, PartialOrd, Ord)]
struct Product {
    powers: BTreeMap<InputId, u32>,
    /// The frequencies of the wave, as bits; none for the number 1.
    angle: BTreeMap<InputId, u64>,
    /// True for a sine.
    sine: bool,
}

/// A sum of products.
#[derive(Debug, Clone, Default)]
struct Sum {
    terms: BTreeMap<Product, f64>,
    size: f64,
}

impl Sum {
    fn constant(value: f64) -> Self {
        Self { terms: BTreeMap::from([(Product::default(), value)]), size: value.abs() }
    }

    /// The number that this is, if nothing else is in it.
    fn number(&self) -> Option<f64> {
        let others = self.terms.iter().any(|(product, factor)| *product != Product::default() && *factor != 0.0);
        (!others).then(|| self.terms.get(&Product::default()).copied().unwrap_or_default())
    }

    fn add(&mut self, product: Product, factor: f64) {
        *self.terms.entry(product).or_default() += factor;
    }

    fn plus(mut self, other: &Self, factor: f64) -> Self {
        for (product, value) in &other.terms {
            self.add(product.clone(), factor * value);
        }
        self.size += factor.abs() * other.size;
        self
    }

    fn times(&self, other: &Self) -> Option<Self> {
        if self.terms.len() * other.terms.len() > MAX_TERMS {
            return None;
        }
        let mut out = Self { terms: BTreeMap::new(), size: self.size * other.size };
        for (a, x) in &self.terms {
            for (b, y) in &other.terms {
                for (product, factor) in a.times(b)? {
                    out.add(product, factor * x * y);
                }
            }
        }
        Some(out)
    }
}

impl Product {
    fn times(&self, other: &Self) -> Option<Vec<(Self, f64)>> {
        let mut powers = self.powers.clone();
        for (input, power) in &other.powers {
            let all = powers.entry(*input).or_default();
            *all = all.checked_add(*power)?;
        }
        let wave = |angle: BTreeMap<InputId, f64>, sine: bool, factor: f64| {
            // One of the two signs of an angle stands for both: cosines are even, sines odd.
            let flips = angle.values().next().is_some_and(|first| *first < 0.0);
            let sign = if flips { -1.0 } else { 1.0 };
            let angle: BTreeMap<InputId, u64> = angle.into_iter().map(|(i, f)| (i, (sign * f).to_bits())).collect();
            match (angle.is_empty(), sine) {
                (true, true) => None,
                (true, false) => Some((Self { powers: powers.clone(), ..Self::default() }, factor)),
                (false, _) => {
                    let factor = if sine { sign * factor } else { factor };
                    Some((Self { powers: powers.clone(), angle, sine }, factor))
                }
            }
        };
        if self.angle.is_empty() || other.angle.is_empty() {
            let with = if self.angle.is_empty() { other } else { self };
            return Some(vec![(Self { powers, ..with.clone() }, 1.0)]);
        }
        let joined = |sign: f64| {
            let mut angle: BTreeMap<InputId, f64> =
                self.angle.iter().map(|(input, bits)| (*input, f64::from_bits(*bits))).collect();
            for (input, bits) in &other.angle {
                *angle.entry(*input).or_default() += sign * f64::from_bits(*bits);
            }
            angle.retain(|_, frequency| *frequency != 0.0);
            angle
        };
        let (sum, difference) = (joined(1.0), joined(-1.0));
        let both = match (self.sine, other.sine) {
            (false, false) => [wave(difference, false, 0.5), wave(sum, false, 0.5)],
            (true, true) => [wave(difference, false, 0.5), wave(sum, false, -0.5)],
            (true, false) => [wave(sum, true, 0.5), wave(difference, true, 0.5)],
            (false, true) => [wave(sum, true, 0.5), wave(difference, true, -0.5)],
        };
        Some(both.into_iter().flatten().collect())
    }
}

/// The most by which two formulas can differ over the domains of all inputs, and what of it rounding may have
/// done; nothing if they are no such sums.
pub(crate) fn difference(program: &Program, left: ExprId, right: ExprId) -> Option<(f64, f64)> {
    let mut reader = Reader { program, known: BTreeMap::new(), steps: 0 };
    let (a, b) = (reader.sum(left)?, reader.sum(right)?);
    let all = a.plus(&b, -1.0);
    let most = |product: &Product| {
        product.powers.iter().map(|(input, power)| reader.most(*input).powi(*power as i32)).product::<f64>()
    };
    let bound: f64 = all.terms.iter().filter(|(_, f)| **f != 0.0).map(|(product, f)| f.abs() * most(product)).sum();
    let rounding = ROUNDING * all.size;
    (bound.is_finite() && rounding.is_finite()).then_some((bound, rounding))
}

struct Reader<'p> {
    program: &'p Program,
    known: BTreeMap<ExprId, Option<Sum>>,
    steps: usize,
}

impl Reader<'_> {
    /// The largest magnitude of an input.
    fn most(&self, input: InputId) -> f64 {
        match self.program.inputs[input.index()].domain {
            Domain::Continuous { lo, hi, .. } => lo.abs().max(hi.abs()),
            Domain::Word => f64::from(u32::MAX),
            Domain::Discrete(_) => f64::INFINITY,
        }
    }

    fn sum(&mut self, expr: ExprId) -> Option<Sum> {
        if let Some(known) = self.known.get(&expr) {
            return known.clone();
        }
        self.steps += 1;
        let sum = if self.steps > MAX_STEPS { None } else { self.read(expr) };
        self.known.insert(expr, sum.clone());
        sum
    }

    fn read(&mut self, expr: ExprId) -> Option<Sum> {
        let program = self.program;
        match program.pool.node(expr) {
            Node::Const(number) => Some(Sum::constant(number.get())),
            Node::Input(input) => {
                let powers = BTreeMap::from([(input, 1)]);
                let terms = BTreeMap::from([(Product { powers, ..Product::default() }, 1.0)]);
                Some(Sum { terms, size: self.most(input) })
            }
            Node::Word(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => None,
            Node::Unary(op, a) => {
                let a = self.sum(a)?;
                match (op, op.row().algebra, a.number()) {
                    (_, UnaryAlgebra::Negate, _) => Some(Sum::default().plus(&a, -1.0)),
                    (_, _, Some(number)) => Some(Sum::constant(op.apply(number))),
                    (UnaryOp::Cos, ..) => self.wave(&a, false),
                    (UnaryOp::Sin, ..) => self.wave(&a, true),
                    _ => None,
                }
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.sum(a)?, self.sum(b)?);
                let power = b.number().filter(|power| (0.0..=MAX_POWER).contains(power) && power.fract() == 0.0);
                if let (BinaryOp::Pow, Some(power)) = (op, power) {
                    return (0..power as u32).try_fold(Sum::constant(1.0), |product, _| product.times(&a));
                }
                match op.row().algebra {
                    BinaryAlgebra::Sum => Some(a.plus(&b, 1.0)),
                    BinaryAlgebra::Difference => Some(a.plus(&b, -1.0)),
                    BinaryAlgebra::Product => a.times(&b),
                    BinaryAlgebra::Quotient => {
                        let divisor = b.number().filter(|divisor| *divisor != 0.0)?;
                        Some(Sum::default().plus(&a, 1.0 / divisor))
                    }
                    BinaryAlgebra::Minimum | BinaryAlgebra::Maximum | BinaryAlgebra::Opaque => {
                        Some(Sum::constant(op.apply(a.number()?, b.number()?)))
                    }
                }
            }
            Node::Ternary(op, a, b, c) => {
                let (a, b, c) = (self.sum(a)?, self.sum(b)?, self.sum(c)?);
                match op.row().algebra {
                    TernaryAlgebra::ProductAndSum => Some(a.times(&b)?.plus(&c, 1.0)),
                    TernaryAlgebra::Mix => {
                        let change = b.plus(&a, -1.0).times(&c)?;
                        Some(a.plus(&change, 1.0))
                    }
                    TernaryAlgebra::Clamp | TernaryAlgebra::Opaque => {
                        Some(Sum::constant(op.apply(a.number()?, b.number()?, c.number()?)))
                    }
                }
            }
        }
    }

    /// The cosine or sine of a linear form: what is constant in the angle becomes two factors.
    fn wave(&self, angle: &Sum, sine: bool) -> Option<Sum> {
        let mut frequencies: BTreeMap<InputId, f64> = BTreeMap::new();
        let mut shift = 0.0;
        for (product, factor) in &angle.terms {
            if !product.angle.is_empty() {
                return None;
            }
            match product.powers.iter().next() {
                None => shift = *factor,
                Some((input, 1)) if product.powers.len() == 1 => {
                    frequencies.insert(*input, *factor);
                }
                Some(_) => return None,
            }
        }
        frequencies.retain(|_, frequency| *frequency != 0.0);
        if sine {
            shift -= FRAC_PI_2;
        }
        // cos(a + c) = cos a cos c - sin a sin c, where the first frequency of a is positive.
        let sign = if frequencies.values().next().is_some_and(|first| *first < 0.0) { -1.0 } else { 1.0 };
        let angle_of: BTreeMap<InputId, u64> =
            frequencies.into_iter().map(|(input, frequency)| (input, (sign * frequency).to_bits())).collect();
        let product = |sine: bool| Product { powers: BTreeMap::new(), angle: angle_of.clone(), sine };
        let terms = [(product(false), shift.cos()), (product(true), -sign * shift.sin())];
        Some(Sum { terms: terms.into_iter().collect(), size: 1.0 + angle.size })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    /// The two numbers for the claim that `left` is `right` for all `x` of -4 to 4 and `y` of 0 to 1.
    fn of(left: &str, right: &str) -> Option<(f64, f64)> {
        let text = format!(
            r#"Table(language: 2, name: "t", hit_policy: First,
                inputs: {{"x": Range(from: -4, to: 4), "y": Range(from: 0, to: 1)}},
                claims: {{"c": Equal(left: "{left}", right: "{right}", for: ["x", "y"])}},
                output: Number(), cases: [Case(id: 1, when: "x < y", value: 1)], default: 0)"#
        );
        let table = Table::parse(Source::new("t.ron", text)).unwrap_or_else(|e| panic!("{e}"));
        let program = Program::check(&table).unwrap_or_else(|e| panic!("{e}"));
        let claims = program.claims.unwrap_or_else(|| panic!("no claims"));
        let pair = &claims.all[0].pairs[0];
        difference(&claims.program, pair.left, pair.right)
    }

    #[test]
    fn equal_sums_have_the_same_terms() {
        for (left, right) in [
            ("(x + y) * (x - y)", "x * x - y * y"),
            ("pow(cos(x), 2) + sin(x) * sin(x)", "1"),
            ("sin(x + y)", "sin(x) * cos(y) + cos(x) * sin(y)"),
            ("cos(-2 * x + 1) * sin(x)", "0.5 * (sin(3 * x - 1) - sin(x - 1))"),
            ("mix(x, y, y)", "fma(y, y - x, x)"),
            ("sum(k in 0 .. 2, cos(2 * (x + k * 2.0943951023931953)))", "0"),
        ] {
            let (bound, rounding) = of(left, right).unwrap_or_else(|| panic!("{left}"));
            assert!(bound <= rounding, "{left} = {right}: {bound} of {rounding}");
        }
    }

    #[test]
    fn what_differs_is_bounded() {
        let (bound, _) = of("x * y + 0.25 * sin(x)", "y * x").unwrap_or_else(|| panic!("a polynomial"));
        assert_eq!(bound, 0.25);
        assert!(of("sqrt(x + 5)", "x").is_none() && of("min(x, y)", "y").is_none());
    }
}
