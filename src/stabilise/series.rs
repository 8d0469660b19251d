//! Power series of functions of one variable, with exact coefficients.

use super::kernel::Term;
use crate::program::rational::Rational;

/// Terms that are kept.
pub(super) const ORDER: usize = 26;

type Series = Vec<Rational>;

/// The series of a sum of terms, each with a power that is not negative.
pub(super) fn series(terms: &[Term]) -> Option<Series> {
    let mut total = vec![Rational::ZERO; ORDER];
    for term in terms {
        let mut product = vec![Rational::ZERO; ORDER];
        *product.get_mut(usize::try_from(term.power).ok()?)? = term.factor;
        for (name, rate) in &term.functions {
            product = multiply(&product, &function(name, *rate)?)?;
        }
        for (sum, term) in total.iter_mut().zip(product) {
            *sum = sum.plus(term)?;
        }
    }
    Some(total)
}

fn multiply(a: &Series, b: &Series) -> Option<Series> {
    let mut product = vec![Rational::ZERO; ORDER];
    for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        for (j, y) in b.iter().enumerate().take(ORDER - i).filter(|(_, y)| !y.is_zero()) {
            product[i + j] = product[i + j].plus(x.times(*y)?)?;
        }
    }
    Some(product)
}

/// The series of `name(rate x)`.
fn function(name: &str, rate: Rational) -> Option<Series> {
    let sign = |j: usize| Rational::whole(if (j / 2).is_multiple_of(2) { 1 } else { -1 });
    let mut power = Rational::ONE;
    let mut factorial = Rational::ONE;
    let mut all = Vec::with_capacity(ORDER);
    for j in 0..ORDER {
        if j > 0 {
            power = power.times(rate)?;
            factorial = factorial.times(Rational::whole(j as i64))?;
        }
        let even = j % 2 == 0;
        let coefficient = match name {
            "exp" => Rational::ONE,
            "cosh" if even => Rational::ONE,
            "sinh" if !even => Rational::ONE,
            "cos" if even => sign(j),
            "sin" if !even => sign(j),
            "cosh" | "sinh" | "cos" | "sin" => Rational::ZERO,
            _ => return None,
        };
        all.push(coefficient.times(power)?.times(factorial.reciprocal()?)?);
    }
    Some(all)
}
