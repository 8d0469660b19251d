//! Convolution shadows against closed forms, and to the last bit where kernels are whole.

use super::super::kernel::{Blur, Kernel, Sample};
use super::super::stencil::{Border, Gather, Real, Stencil};
use super::super::sweep::{Matter, Slabs, Step, Sweep};

/// Opaque where a function of slab and pixel says so.
struct Opaque<F>(F);

impl<F: Fn(usize, usize, usize) -> bool + Sync> Slabs for Opaque<F> {
    type Row = ();

    fn row(&self, _: usize) {}

    fn matter(&self, slab: usize, y: usize, (): &mut (), out: &mut [Option<Matter>]) {
        for (x, out) in out.iter_mut().enumerate() {
            let opaque = Matter { alpha: 1.0, through: [0.0; 3], colour: [1.0; 3], surface: None };
            *out = (self.0)(slab, x, y).then_some(opaque);
        }
    }
}

const WIDTH: usize = 256;

/// Light behind each of some slabs in the middle row, with the same gather everywhere.
fn light<T: Real>(
    size: (usize, usize),
    slabs: usize,
    samples: &[Sample],
    opaque: impl Fn(usize, usize, usize) -> bool + Sync,
) -> Vec<Vec<f64>> {
    let matter = Opaque(opaque);
    let mut sweep = Sweep::<_, T>::new(&matter, size, vec![[1.0; 3]], Border::Unoccluded, None);
    let gather = Gather::Same(Stencil::new(samples));
    let mut all = Vec::new();
    for slab in 0..slabs {
        sweep.step(&Step { slab, gathers: vec![gather.clone()] }, &[]);
        all.push(sweep.light.row(size.1 / 2, 0, 0).iter().map(|value| value.wide()).collect());
    }
    all
}

/// Whole samples of one line from their weights, the middle one at 0.
fn line(weights: &[f64]) -> Vec<Sample> {
    let middle = (weights.len() / 2) as f64;
    let sample = |(place, weight): (usize, &f64)| Sample { at: [place as f64 - middle, 0.0], weight: *weight };
    weights.iter().enumerate().map(sample).collect()
}

/// The line of `binomial3` as the table has it: of the plane, what a row of equal rows sees.
fn binomial() -> Vec<Sample> {
    let kernel = Kernel { family: "binomial3", samples: 3 };
    let plane = kernel.samples(&Blur { mean: [0.0; 2], variances: [0.5; 2], axis: [1.0, 0.0] }, 0.0).expect("whole");
    assert_eq!(plane.len(), 9);
    let along = |x: f64| plane.iter().filter(|sample| sample.at[0] == x).map(|sample| sample.weight).sum();
    line(&[-1.0, 0.0, 1.0].map(along))
}

fn in_both(
    check: impl Fn(fn((usize, usize), usize, &[Sample], &(dyn Fn(usize, usize, usize) -> bool + Sync)) -> Vec<Vec<f64>>),
) {
    check(|size, slabs, samples, opaque| light::<f64>(size, slabs, samples, opaque));
    check(|size, slabs, samples, opaque| light::<f32>(size, slabs, samples, opaque));
}

#[test]
fn a_half_plane_under_binomials_is_exact() {
    in_both(|light| {
        let all = light((WIDTH, 1), 5, &binomial(), &|slab, x, _| slab == 0 && x >= WIDTH / 2);
        let shadow = |n: usize, at: i64| 1.0 - all[n][(WIDTH as i64 / 2 + at) as usize];
        for (n, over, expected) in [
            (1, 4.0, [0.0, 0.0, 1.0, 3.0, 4.0, 4.0]),
            (2, 16.0, [0.0, 1.0, 5.0, 11.0, 15.0, 16.0]),
            (4, 256.0, [9.0, 37.0, 93.0, 163.0, 219.0, 247.0]),
        ] {
            for (at, expected) in (-3..).zip(expected) {
                assert_eq!(shadow(n, at), expected / over, "slab {n} pixel {at}");
            }
        }
    });
}

#[test]
fn a_wall_along_the_view_darkens_as_spitzer_says() {
    in_both(|light| {
        let all = light((WIDTH, 1), 5, &binomial(), &|_, x, _| x < WIDTH / 2);
        let beside: Vec<f64> = all.iter().map(|row| row[WIDTH / 2]).collect();
        assert_eq!(beside, [1.0, 3.0 / 4.0, 5.0 / 8.0, 35.0 / 64.0, 63.0 / 128.0]);
        // Two samples, three equal ones (which are not exact).
        let two = light((WIDTH, 1), 6, &line(&[0.5, 0.0, 0.5]), &|_, x, _| x < WIDTH / 2);
        let beside: Vec<f64> = two.iter().map(|row| row[WIDTH / 2]).collect();
        assert_eq!(beside, [1.0, 0.5, 0.5, 0.375, 0.375, 0.3125]);
    });
    let three = light::<f64>((WIDTH, 1), 6, &line(&[1.0 / 3.0; 3]), |_, x, _| x < WIDTH / 2);
    for (row, expected) in three.iter().zip([1.0, 2.0 / 3.0, 5.0 / 9.0, 13.0 / 27.0, 35.0 / 81.0, 32.0 / 81.0]) {
        assert!((row[WIDTH / 2] - expected).abs() < 1e-15, "{} {expected}", row[WIDTH / 2]);
    }
}

#[test]
fn a_slope_of_pixels_is_exact() {
    in_both(|light| {
        let samples = line(&[1.0, 4.0, 6.0, 4.0, 1.0].map(|w| w / 16.0));
        let first = WIDTH / 4;
        let all = light((WIDTH, 1), 5, &samples, &|slab, x, _| x < first + slab);
        let at: Vec<f64> = (0..5).map(|slab| all[slab][first + slab]).collect();
        assert_eq!(at, [1.0, 15.0 / 16.0, 59.0 / 64.0, 1877.0 / 2048.0, 14981.0 / 16384.0]);
    });
    let samples = line(&[1.0, 4.0, 6.0, 4.0, 1.0].map(|w| w / 16.0));
    let all = light::<f64>((WIDTH, 1), 120, &samples, |slab, x, _| x < 8 + slab);
    assert!((all[119][8 + 119] - 0.91262).abs() < 5e-6, "{}", all[119][8 + 119]);
}

#[test]
fn a_whole_tilt_moves_an_edge_exactly() {
    in_both(|light| {
        let samples = [Sample { at: [3.0, 0.0], weight: 1.0 }];
        let all = light((WIDTH, 1), 20, &samples, &|slab, x, _| slab == 0 && x >= WIDTH / 2);
        for (n, row) in all.iter().enumerate() {
            // Light from the right moves the shadow to the left.
            let edge = WIDTH / 2 - 3 * n;
            assert!(
                row.iter()
                    .enumerate()
                    .all(|(x, light)| *light == if x < edge { 1.0 } else { 0.0 } || x + 3 * n >= WIDTH),
                "{n}"
            );
        }
    });
}

#[test]
fn interpolation_adds_the_smear_that_the_table_says() {
    let samples = [Sample { at: [0.5, 0.0], weight: 1.0 }];
    let all = light::<f64>((WIDTH, 1), 33, &samples, |slab, x, _| slab == 0 && x == WIDTH / 2);
    let row: Vec<f64> = all[32].iter().map(|light| 1.0 - light).collect();
    let of =
        |power: i32| row.iter().enumerate().map(|(x, s)| s * (x as f64 - WIDTH as f64 / 2.0).powi(power)).sum::<f64>();
    let (sum, mean, square) = (of(0), of(1), of(2));
    assert!((sum - 1.0).abs() < 1e-12 && (mean + 16.0).abs() < 1e-12);
    assert!((square - mean * mean - 32.0 / 4.0).abs() < 1e-12, "{}", square - mean * mean);
}
