//! Power series of functions of one variable, with exact coefficients.

use num_traits::{CheckedAdd, CheckedMul, One, Zero};

use super::kernel::Term;
use crate::program::normal::Rational;

/// Terms that are kept.
pub(super) const ORDER: usize = 26;

type Series = Vec<Rational>;

/// The series of a sum of terms, each with a power that is not negative.
pub(super) fn series(terms: &[Term]) -> Option<Series> {
    let mut total = vec![Rational::zero(); ORDER];
    for term in terms {
        let mut product = vec![Rational::zero(); ORDER];
        *product.get_mut(usize::try_from(term.power).ok()?)? = term.factor;
        for (name, rate) in &term.functions {
            product = multiply(&product, &function(name, *rate)?)?;
        }
        for (sum, term) in total.iter_mut().zip(product) {
            *sum = sum.checked_add(&term)?;
        }
    }
    Some(total)
}

fn multiply(a: &Series, b: &Series) -> Option<Series> {
    let mut product = vec![Rational::zero(); ORDER];
    for (i, x) in a.iter().enumerate().filter(|(_, x)| !x.is_zero()) {
        for (j, y) in b.iter().enumerate().take(ORDER - i).filter(|(_, y)| !y.is_zero()) {
            product[i + j] = product[i + j].checked_add(&x.checked_mul(y)?)?;
        }
    }
    Some(product)
}

/// The series of `name(rate x)`.
fn function(name: &str, rate: Rational) -> Option<Series> {
    let sign = |j: usize| Rational::from_integer(if (j / 2).is_multiple_of(2) { 1 } else { -1 });
    let mut power = Rational::one();
    let mut factorial = Rational::one();
    let mut all = Vec::with_capacity(ORDER);
    for j in 0..ORDER {
        if j > 0 {
            power = power.checked_mul(&rate)?;
            factorial = factorial.checked_mul(&Rational::from_integer(j as i128))?;
        }
        let even = j % 2 == 0;
        let coefficient = match name {
            "exp" => Rational::one(),
            "cosh" if even => Rational::one(),
            "sinh" if !even => Rational::one(),
            "cos" if even => sign(j),
            "sin" if !even => sign(j),
            "cosh" | "sinh" | "cos" | "sin" => Rational::zero(),
            _ => return None,
        };
        all.push(coefficient.checked_mul(&power)?.checked_mul(&factorial.recip())?);
    }
    Some(all)
}
