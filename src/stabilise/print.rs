//! Sums of products in the notation of the table language, as a person would
//! write them: common factors in front, fractions as divisions.

use super::kernel::{Kernel, SINC, Term};
use super::poly::{Atom, Mono, Poly};
use crate::program::rational::{Rational, gcd};

/// Prints sums; terms that share one of these variables are grouped by it.
pub(super) struct Printer<'a> {
    pub(super) group_by: &'a [String],
    /// The name of sin(x)/x in the table.
    pub(super) sinc: &'a str,
}

impl Printer<'_> {
    /// A sum.
    pub(super) fn sum(&self, sum: &Poly) -> String {
        self.write(sum, false)
    }

    /// A sum, in parentheses if it is an operand of a product.
    fn write(&self, sum: &Poly, operand: bool) -> String {
        let Some((shared, lead, rest)) = sum.content() else { return "0".to_owned() };
        if rest.constant().is_some() {
            return self.product(&shared, lead, None, operand);
        }
        // Whole numbers inside, if possible; the sign stays with the terms.
        let Some(rest) = rest.times_number(lead) else { return self.product(&shared, lead, Some(&rest), operand) };
        let factor = rest.0.values().try_fold(Rational::ZERO, |all, f| common(all, *f));
        let inner = factor.and_then(|factor| Some((factor, rest.times_number(factor.reciprocal()?)?)));
        let (factor, inner) = inner.unwrap_or((Rational::ONE, rest));
        if shared.is_empty() && factor == Rational::ONE {
            let text = self.terms(&inner);
            return if operand { format!("({text})") } else { text };
        }
        self.product(&shared, factor, Some(&inner), operand)
    }

    /// Terms with their signs.
    fn terms(&self, sum: &Poly) -> String {
        for name in self.group_by {
            if let Some((slope, rest)) = sum.linear_in(name)
                && slope.0.len() > 1
            {
                let product = format!("{} * {name}", self.write(&slope, true));
                return if rest.is_zero() { product } else { join(&product, &self.terms(&rest)) };
            }
        }
        // Positive terms first, so that no sum begins with a sign without need.
        let (minus, plus): (Vec<_>, Vec<_>) = sum.0.iter().partition(|(_, factor)| factor.is_negative());
        let mut text = String::new();
        for (mono, factor) in plus.into_iter().chain(minus) {
            let term = self.product(mono, *factor, None, false);
            text = if text.is_empty() { term } else { join(&text, &term) };
        }
        text
    }

    /// A number times atoms times a sum.
    fn product(&self, mono: &Mono, factor: Rational, sum: Option<&Poly>, operand: bool) -> String {
        let (mut over, mut under) = (Vec::new(), Vec::new());
        for (atom, power) in mono {
            let (text, power) = match atom {
                Atom::Over(sum) => (self.write(sum, true), -power),
                Atom::Var(name) => (name.clone(), *power),
                Atom::Fun(name, arguments) => {
                    let arguments: Vec<String> = arguments.iter().map(|a| self.sum(a)).collect();
                    let name = if name == SINC { self.sinc } else { name };
                    (format!("{name}({})", arguments.join(", ")), *power)
                }
            };
            let side = if power > 0 { &mut over } else { &mut under };
            (0..power.unsigned_abs()).for_each(|_| side.push(text.clone()));
        }
        over.extend(sum.map(|sum| self.write(sum, true)));
        let size = factor.abs();
        let denominator = size.denominator();
        // Fractions that are short decimals are written so.
        let decimal = matches!(denominator, 1 | 2 | 4 | 8);
        let number = if decimal { size.to_f64() } else { size.numerator() as f64 };
        if number != 1.0 || over.is_empty() {
            over.insert(0, format!("{number}"));
        }
        if !decimal {
            under.insert(0, denominator.to_string());
        }
        let mut text = over.join(" * ");
        match under.as_slice() {
            [] => {}
            [one] => text = format!("{text} / {one}"),
            several => text = format!("{text} / ({})", several.join(" * ")),
        }
        match (factor.is_negative(), operand) {
            (true, true) => format!("(-{text})"),
            (true, false) => format!("-{text}"),
            (false, true) if !under.is_empty() => format!("({text})"),
            (false, _) => text,
        }
    }
}

/// The largest number of which both are whole multiples.
fn common(a: Rational, b: Rational) -> Option<Rational> {
    if a.is_zero() {
        return Some(b.abs());
    }
    let [x, y] = [(a, b), (b, a)].map(|(over, under)| over.numerator().checked_mul(under.denominator()));
    let divisor = i128::try_from(gcd(x?.unsigned_abs(), y?.unsigned_abs())).ok()?;
    Rational::fraction(divisor, a.denominator().checked_mul(b.denominator())?)
}

fn join(left: &str, right: &str) -> String {
    match right.strip_prefix('-') {
        Some(rest) => format!("{left} - {rest}"),
        None => format!("{left} + {right}"),
    }
}

/// A kernel's two lines as a helper of the table with the parameter `x`: its declaration and what is said about it.
pub(super) fn helper(kernel: &Kernel, x: &str, indent: &str) -> String {
    let Kernel { name, terms, divisor, series, threshold, bounds } = kernel;
    let even = series.iter().skip(1).step_by(2).all(|c| c.is_zero());
    let step = if even { 2 } else { 1 };
    let coefficients: Vec<String> = series.iter().step_by(step).map(fraction).collect();
    let argument = if even { format!("{x} * {x}") } else { x.to_owned() };
    let closed = closed(terms, *divisor, x);
    format!(
        "{indent}// 1 at {x} = 0. Relative error in f32: series at most {:.0e}, closed form from {threshold} on at most {:.0e}.\n\
         {indent}\"{name}({x})\": [\n\
         {indent}    (\"poly({argument}, [{}])\", \"abs({x}) < {threshold}\"),\n\
         {indent}    \"{closed}\",\n\
         {indent}],\n",
        bounds.0,
        bounds.1,
        coefficients.join(", "),
    )
}

fn fraction(value: &Rational) -> String {
    match value.integer() {
        Some(whole) => whole.to_string(),
        None => format!("{} / {}", value.numerator(), value.denominator()),
    }
}

/// The closed form in `x`.
fn closed(terms: &[Term], divisor: i32, x: &str) -> String {
    let mut sum = Poly::default();
    for term in terms {
        let mut mono = Mono::new();
        if term.power > 0 {
            mono.insert(Atom::Var(x.to_owned()), term.power);
        }
        for (name, rate) in &term.functions {
            let argument = Poly::var(x).times_number(*rate).unwrap_or_default();
            *mono.entry(Atom::Fun(name.clone(), vec![argument])).or_insert(0) += 1;
        }
        let _ = sum.add_term(mono, term.factor);
    }
    // Closed forms are made of sines and powers.
    let printer = Printer { group_by: &[], sinc: SINC };
    let power = vec![x; divisor.unsigned_abs() as usize].join(" * ");
    let power = if divisor == 1 { power } else { format!("({power})") };
    let top = printer.write(&sum, true);
    format!("{top} / {power}")
}
