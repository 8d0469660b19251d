//! The defining integrals, by quadrature in `f64`, and how much their inputs' rounding matters.
//!
//! Nothing here is a closed form and nothing subtracts: both integrals over a
//! cell are Gauss sums of the integrand itself, so their relative error is some
//! roundings of `f64`, 2^-29 of those that are allowed to `f32`. The test
//! compares them with the closed forms in hundreds of bits as well.

use std::f64::consts::PI;

/// Half a unit in the last place of 1 in `f32`.
pub(crate) const EPSILON: f64 = 1.0 / 16_777_216.0;

/// Nodes and weights of a Gauss-Legendre rule on [-1, 1].
#[derive(Debug, Clone)]
pub(crate) struct Rule(Vec<(f64, f64)>);

impl Rule {
    /// The rule with `count` nodes, by Newton's method on the Legendre polynomial.
    pub(crate) fn new(count: usize) -> Self {
        let n = count as f64;
        let node = |i: usize| {
            let mut x = (PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..100 {
                let (mut last, mut here) = (1.0, x);
                for j in 2..=count {
                    let j = j as f64;
                    (last, here) = (here, ((2.0 * j - 1.0) * x * here - (j - 1.0) * last) / j);
                }
                slope = n * (x * here - last) / (x * x - 1.0);
                let move_by = here / slope;
                x -= move_by;
                if move_by.abs() < 1e-16 {
                    break;
                }
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        };
        Self((0..count).map(node).collect())
    }

    /// The integral of `f` from `lo` to `hi`.
    pub(crate) fn integrate(&self, lo: f64, hi: f64, mut f: impl FnMut(f64) -> f64) -> f64 {
        let half = 0.5 * (hi - lo);
        self.0.iter().map(|(x, weight)| weight * f(lo + half * (1.0 + x))).sum::<f64>() * half
    }
}

/// Both rules that a cell needs, and one for an oscillating integrand.
#[derive(Debug, Clone)]
pub(crate) struct Rules {
    outer: Rule,
    inner: Rule,
    fast: Rule,
}

/// The parts of A and B, and what they are measured by.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Moments {
    /// ∫∫ ω
    pub(crate) first: [f64; 3],
    /// ∫∫ ω ω: xx, xy, yy, xz, yz, zz
    pub(crate) second: [f64; 6],
    /// ∫∫ |sin θ|: the solid angle
    pub(crate) solid: f64,
}

impl Rules {
    pub(crate) fn new() -> Self {
        Self { outer: Rule::new(36), inner: Rule::new(20), fast: Rule::new(80) }
    }

    /// The integrals over φ0 ≤ φ ≤ φ1, θ0 ≤ θ ≤ `upper(φ)`.
    pub(crate) fn moments(&self, phi: (f64, f64), theta: f64, upper: impl Fn(f64) -> f64) -> Moments {
        let mut all = Moments::default();
        let half = 0.5 * (phi.1 - phi.0);
        for (x, weight) in &self.outer.0 {
            let at = phi.0 + half * (1.0 + x);
            let (sin_phi, cos_phi) = at.sin_cos();
            let reach = 0.5 * (upper(at) - theta);
            let mut strip = [0.0; 6];
            for (x, weight) in &self.inner.0 {
                let (sin, cos) = (theta + reach * (1.0 + x)).sin_cos();
                let w = weight * reach;
                let terms = [sin, sin * sin, sin * cos, sin * sin * sin, sin * sin * cos, sin * cos * cos];
                for (sum, term) in strip.iter_mut().zip(terms) {
                    *sum += w * term;
                }
            }
            let w = weight * half;
            let [one, s, c, ss, sc, cc] = strip.map(|strip| strip * w);
            all.solid += one.abs();
            let (x, y) = (cos_phi, sin_phi);
            for (sum, term) in all.first.iter_mut().zip([x * s, y * s, c]) {
                *sum += term;
            }
            for (sum, term) in all.second.iter_mut().zip([x * x * ss, x * y * ss, y * y * ss, x * sc, y * sc, cc]) {
                *sum += term;
            }
        }
        all
    }

    /// The integrals C0 to C5.
    pub(crate) fn c(&self, index: usize, [phi0, phi1, p, q, s, t]: [f64; 6]) -> f64 {
        self.fast.integrate(phi0, phi1, |phi| match index {
            0 => 1.0,
            1 => (phi + p).sin(),
            2 => (s * phi + t).cos(),
            3 => phi * (phi + p).sin(),
            4 => (phi + p).sin() * (s * phi + t).sin(),
            _ => (phi + p).sin() * (phi + q).sin() * (s * phi + t).cos(),
        })
    }
}

impl Moments {
    /// A0, A1, A, B0, B1, B2, B3, B, Lo for a normal, a lobe vector and α*.
    pub(crate) fn parts(&self, n: [f64; 3], p: [f64; 3], alpha: f64) -> [f64; 9] {
        let [mx, my, mz] = self.first;
        let [xx, xy, yy, xz, yz, zz] = self.second;
        let unit = |x: f64, y: f64| {
            let size = x.hypot(y);
            if size == 0.0 { (0.0, 1.0) } else { (x / size, y / size) }
        };
        // (sin, cos) of the phases τ of the normal and γ of the lobe.
        let ((st, ct), (sg, cg)) = (unit(n[0], n[1]), unit(p[0], p[1]));
        let a0 = ct * my + st * mx;
        let a = n[0] * mx + n[1] * my + n[2] * mz;
        let b0 = sg * st * xx + (sg * ct + cg * st) * xy + cg * ct * yy;
        let (b1, b2) = (cg * yz + sg * xz, ct * yz + st * xz);
        let mn =
            [xx * n[0] + xy * n[1] + xz * n[2], xy * n[0] + yy * n[1] + yz * n[2], xz * n[0] + yz * n[1] + zz * n[2]];
        let b = p[0] * mn[0] + p[1] * mn[1] + p[2] * mn[2];
        [a0, mz, a, b0, b1, b2, zz, b, alpha * a + b]
    }
}

/// r0, r1, alpha, beta of the linear approximation of μ e^(λ(x-1)) on [a, b].
pub(crate) fn linear([mu, lambda, a, b]: [f64; 4]) -> [f64; 4] {
    let z = lambda * (b - a);
    let top = mu * (lambda * (b - 1.0)).exp();
    let series = |first: f64, ratio: &dyn Fn(f64) -> f64| {
        let (mut term, mut sum) = (first, first);
        for j in 0..60 {
            term *= -z * ratio(f64::from(j));
            sum += term;
        }
        sum
    };
    let (f1, f2) = if z < 2.0 {
        (series(1.0, &|j| 1.0 / (j + 2.0)), series(1.0, &|j| (j + 2.0) / ((j + 1.0) * (j + 4.0))))
    } else {
        let fall = (-z).exp();
        ((1.0 - fall) / z, 6.0 * (z * (1.0 + fall) - 2.0 * (1.0 - fall)) / (z * z * z))
    };
    let (r0, beta) = (top * f1, lambda * top * f2);
    [r0, beta * 0.5 * (b - a), r0 - beta * 0.5 * (a + b), beta]
}

/// e1 and e2: the error of that approximation in the mean and in the mean square.
pub(crate) fn error(rules: &Rules, input: [f64; 4]) -> [f64; 2] {
    let [mu, lambda, a, b] = input;
    let q = 0.5 * (b - a);
    let y = lambda * q;
    let top = mu * (lambda * (b - 1.0)).exp();
    if y < 1e-3 {
        // The leading terms; the next ones are below 1e-12 of them.
        let (c, u) = (top * (-y).exp(), y * y);
        let e1 = q * c * u * (4.0 / (9.0 * 3.0_f64.sqrt()) + 0.019_387_564_6 * u);
        return [e1, (q * (2.0 / 45.0 + 0.007_619_047_6 * u)).sqrt() * c * u];
    }
    // In t from -1 to 1, relative to the value at the upper end.
    let [r0, r1, ..] = linear([1.0, y, -1.0, 1.0]).map(|r| r * 1.0);
    let difference = |t: f64| (y * (t - 1.0)).exp() - r0 - r1 * t;
    let lowest = 1.0 + (r1 / y).ln() / y;
    let root = |mut outside: f64, mut inside: f64| {
        for _ in 0..200 {
            let middle = 0.5 * (outside + inside);
            if difference(middle) > 0.0 { outside = middle } else { inside = middle }
        }
        outside
    };
    let (left, right) = (root(-1.0, lowest), root(1.0, lowest));
    if y < 2.0 {
        let pieces = [(-1.0, left), (left, right), (right, 1.0)];
        let e1: f64 = pieces.iter().map(|(lo, hi)| rules.inner.integrate(*lo, *hi, difference).abs()).sum();
        let e2 = rules.fast.integrate(-1.0, 1.0, |t| difference(t).powi(2));
        return [q * top * e1, top * (q * e2).sqrt()];
    }
    let whole = |t: f64| (y * (t - 1.0)).exp() / y - r0 * t - 0.5 * r1 * t * t;
    let square = (1.0 - (-4.0 * y).exp()) / (2.0 * y) - 2.0 * r0 * r0 - 2.0 / 3.0 * r1 * r1;
    [2.0 * q * top * (whole(left) - whole(right)).abs(), top * (q * square).sqrt()]
}

/// The summed change of a result for a change of each input by half a unit in its last place.
pub(crate) fn sensitivity<const N: usize, const M: usize>(
    input: [f32; N],
    exact: [f64; M],
    f: impl Fn([f64; N]) -> [f64; M],
) -> [f64; M] {
    let mut total = [0.0; M];
    for i in 0..N {
        let mut worst = [0.0_f64; M];
        let half = 0.5 * (f64::from(input[i].abs().next_up()) - f64::from(input[i].abs()));
        for sign in [-1.0, 1.0] {
            let mut moved = input.map(f64::from);
            moved[i] += sign * half;
            for ((worst, there), here) in worst.iter_mut().zip(f(moved)).zip(exact) {
                *worst = worst.max((there - here).abs());
            }
        }
        for (total, worst) in total.iter_mut().zip(worst) {
            *total += worst;
        }
    }
    total
}
