//! Shadows of simple occluders against the closed forms of `tables/light_kernel.ron`.

use glam::DVec2;

use super::super::functions::Function;
use super::super::kernel::Kernel;
use super::super::light::{SlopeLight, nodes};
use super::super::stack::Stack;
use super::super::stencil::Border;
use super::super::steps::{Phase, Spread, Steps};
use super::super::sweep::{Matter, Slabs, Sweep};
use super::super::view::{Projection, SlabView};
use crate::scene::Scene;
use crate::technique::tables::LIGHT_KERNEL;

/// Opaque in the first slab where a function of the pixel says so.
struct Occluder<F>(F);

impl<F: Fn(usize, usize) -> bool + Sync> Slabs for Occluder<F> {
    type Row = ();

    fn row(&self, _: usize) {}

    fn matter(&self, slab: usize, y: usize, (): &mut (), out: &mut [Option<Matter>]) {
        for (x, out) in out.iter_mut().enumerate() {
            let opaque = Matter { alpha: 1.0, through: [0.0; 3], colour: [1.0; 3], surface: None };
            *out = (slab == 0 && (self.0)(x, y)).then_some(opaque);
        }
    }
}

/// Slabs up to the distance at which the penumbra is right.
const RIGHT: usize = 16;

/// The way in which the tests sweep: slabs are as thick as a pixel is wide.
struct Case {
    size: (usize, usize),
    kernel: Kernel,
    smear: Option<&'static str>,
    golden: bool,
    /// Deviation of the blur per slab, in pixels.
    deviation: f64,
    mean: [f64; 2],
    /// Parts of the light, and the share of its covariance that they keep.
    split: (u32, f64),
}

impl Case {
    const RING3: Self = Self {
        size: (256, 96),
        kernel: Kernel { family: "ring_affine", samples: 3 },
        smear: Some("subtract"),
        golden: true,
        deviation: 1.0,
        mean: [0.0; 2],
        split: (1, 1.0),
    };

    /// The deviation of the light's slope.
    fn slope(&self) -> f64 {
        self.deviation / (RIGHT as f64).sqrt()
    }

    /// The light that arrives in each slab, as a picture.
    fn light(&self, slabs: usize, opaque: impl Fn(usize, usize) -> bool + Sync) -> Vec<Vec<f64>> {
        let scene = Scene::open("disk").expect("built in");
        let (width, height) = self.size;
        let view = SlabView::new(&scene, (width as u32, height as u32), Projection::Orthographic);
        let unit = 1.0 / view.scale_at(0.0);
        let stack = Stack::new(0.0, 0.0, unit, slabs);
        let whole = SlopeLight {
            mean: DVec2::from_array(self.mean),
            deviations: [self.slope(); 2],
            angle: 0.0,
            colour: [1.0; 3],
        };
        let lights = whole.split(&nodes(self.split.0).expect("nodes"), self.split.1);
        let spread = Spread {
            kernel: self.kernel,
            phase: if self.golden { Phase::Golden } else { Phase::Steady },
            seed: 0,
            smear: self.smear,
            d1: RIGHT as f64 * unit,
            skip: 0,
        };
        let steps = Steps::<f64>::new(&lights, &stack, &vec![true; slabs], &spread, &view).expect("steps");
        let matter = Occluder(opaque);
        let colours = lights.iter().map(|light| light.colour).collect();
        let mut sweep = Sweep::<_, f64>::new(&matter, self.size, colours, Border::Unoccluded, None);
        let mut all = Vec::new();
        for step in steps {
            sweep.step(&step.expect("steps"), &[]);
            let mut sum = vec![0.0; width * height];
            for light in 0..lights.len() {
                for y in 0..height {
                    let row = &mut sum[y * width..(y + 1) * width];
                    row.iter_mut().zip(sweep.light.row(y, light, 0)).for_each(|(sum, light)| *sum += light);
                }
            }
            all.push(sum);
        }
        all
    }

    /// The shadow of a half plane behind each slab, in the middle row, from the left border of the picture on.
    fn half_plane(&self, slabs: usize) -> Vec<Vec<f64>> {
        let (width, height) = self.size;
        let all = self.light(slabs, |x, _| x >= width / 2);
        let row =
            |light: &Vec<f64>| light[height / 2 * width..(height / 2 + 1) * width].iter().map(|l| 1.0 - l).collect();
        all.iter().map(row).collect()
    }
}

/// The shadow of a half plane at a place and distance in pixels: right, and iterated.
fn expected(function: Function, at: f64, distance: usize, case: &Case) -> [f64; 2] {
    let given = [
        ("at", at.into()),
        ("d", (distance as f64).into()),
        ("mu", case.mean[0].into()),
        ("sigma", case.slope().into()),
        ("d1", (RIGHT as f64).into()),
    ];
    function.call(&given).and_then(|answer| answer.numbers(["correct", "iterated"])).expect("a shadow")
}

#[test]
fn half_planes_have_the_iterated_shadow_and_the_right_one_at_the_right_distance() {
    let function = Function::of(&LIGHT_KERNEL, "half_plane").expect("built in");
    let case = Case::RING3;
    let all = case.half_plane(4 * RIGHT + 1);
    // At a quarter of the distance four slabs have not yet made a Gaussian of three samples.
    for (distance, allowed, apart) in
        [(4, 0.03, 0.161), (8, 0.012, 0.083), (16, 0.006, 0.0), (32, 0.003, 0.083), (64, 0.002, 0.161)]
    {
        let (mut from_iterated, mut from_right) = (0.0_f64, 0.0_f64);
        for (x, shadow) in all[distance].iter().enumerate().take(192).skip(64) {
            let at = x as f64 + 0.5 - case.size.0 as f64 / 2.0;
            let [correct, iterated] = expected(function, at, distance, &case);
            from_iterated = from_iterated.max((shadow - iterated).abs());
            from_right = from_right.max((shadow - correct).abs());
        }
        assert!(from_iterated < allowed, "{distance}: {from_iterated}");
        assert!((from_right - apart).abs() < allowed + 0.01, "{distance}: {from_right}");
    }
}

#[test]
fn half_shadows_go_straight_under_any_light() {
    let case = Case { mean: [-0.8, 0.3], ..Case::RING3 };
    let all = case.half_plane(4 * RIGHT + 1);
    for (distance, row) in all.iter().enumerate().skip(1) {
        let crossing = row.windows(2).position(|pair| pair[0] < 0.5 && pair[1] >= 0.5).expect("an edge");
        let part = (0.5 - row[crossing]) / (row[crossing + 1] - row[crossing]);
        let at = crossing as f64 + 0.5 + part - case.size.0 as f64 / 2.0;
        assert!((at - 0.8 * distance as f64).abs() < 0.5, "{distance}: {at}");
    }
}

#[test]
fn disks_and_rectangles_on_their_axes() {
    let case = Case { size: (160, 160), ..Case::RING3 };
    let middle = 80 * 160 + 80;
    let [disk, rectangle] =
        ["disk_centre", "rectangle"].map(|name| Function::of(&LIGHT_KERNEL, name).expect("built in"));
    let round = case.light(4 * RIGHT + 1, |x, y| {
        let (x, y) = (x as f64 - 80.0, y as f64 - 80.0);
        x * x + y * y <= 12.0 * 12.0
    });
    let square = case.light(4 * RIGHT + 1, |x, y| (68..93).contains(&x) && (74..87).contains(&y));
    for distance in [4, 8, 16, 32, 64] {
        let s = (distance as f64).sqrt() * case.deviation;
        let at =
            disk.call(&[("radius", 12.0.into()), ("s", s.into())]).and_then(|a| a.number("value")).expect("a shadow");
        assert!(
            (1.0 - round[distance][middle] - at).abs() < 0.02,
            "{distance}: {} {at}",
            1.0 - round[distance][middle]
        );
        let given = [("x0", -12.5), ("x1", 12.5), ("y0", -6.5), ("y1", 6.5), ("x", 0.0), ("y", 0.0), ("s", s)];
        let given = given.map(|(name, value)| (name, value.into()));
        let at = rectangle.call(&given).and_then(|a| a.number("value")).expect("a shadow");
        assert!(
            (1.0 - square[distance][middle] - at).abs() < 0.02,
            "{distance}: {} {at}",
            1.0 - square[distance][middle]
        );
    }
}

/// The largest error against an exact Gaussian blur, as the table of kernels and phases in the specification has it.
fn error(case: &Case) -> f64 {
    let (size, radius) = (192, 32.0);
    let inside = |x: usize, y: usize| {
        let (x, y) = (x as f64 + 0.5 - 96.0, y as f64 + 0.5 - 96.0);
        x * x + y * y < radius * radius
    };
    let case = Case { size: (size, size), ..*case };
    let steps = 64;
    let all = case.light(steps + 1, inside);
    // Exactly, by the discrete transform of the Gaussian along both axes, far enough from the border.
    let spread = case.deviation * case.deviation * steps as f64;
    let reach = (6.0 * spread.sqrt()) as i64;
    let weight: Vec<f64> = (-reach..=reach).map(|i| libm::exp(-0.5 * (i * i) as f64 / spread)).collect();
    let sum: f64 = weight.iter().sum();
    let blurred = |image: &[f64], along: usize| -> Vec<f64> {
        (0..size * size)
            .map(|pixel| {
                let place = [pixel % size, pixel / size];
                let value = |i: i64| {
                    let mut at = place.map(|p| p as i64);
                    at[along] += i;
                    let inside = (0..size as i64).contains(&at[along]);
                    if inside { image[at[1] as usize * size + at[0] as usize] } else { 0.0 }
                };
                weight.iter().zip(-reach..).map(|(w, i)| w * value(i)).sum::<f64>() / sum
            })
            .collect()
    };
    let occluder: Vec<f64> = (0..size * size).map(|pixel| f64::from(inside(pixel % size, pixel / size))).collect();
    let exact = blurred(&blurred(&occluder, 0), 1);
    let differences = all[steps].iter().zip(exact).map(|(light, shadow)| (1.0 - light - shadow).abs());
    differences.fold(0.0, f64::max)
}

#[test]
fn kernels_and_phases_rank_as_the_specification_has_them() {
    let ring2 = Kernel { family: "ring_affine", samples: 2 };
    let disk = |family| Kernel { family, samples: 0 };
    // A ring of two whose samples stay where they are blurs along a line only.
    let steady = error(&Case { kernel: ring2, golden: false, ..Case::RING3 });
    assert!(steady > 0.18, "{steady}");
    for (case, deviation, least, most) in [
        (Case { kernel: ring2, ..Case::RING3 }, 1.0, 0.0027, 1.5),
        (Case::RING3, 1.0, 0.0013, 1.5),
        (Case { kernel: disk("poisson8"), ..Case::RING3 }, 1.0, 0.0015, 1.5),
        (Case { kernel: disk("poisson16"), ..Case::RING3 }, 1.0, 0.0003, 1.5),
        (Case { smear: Some("none"), ..Case::RING3 }, 1.0, 0.024, 1.5),
        (Case::RING3, 2.0, 0.0012, 1.5),
    ] {
        let got = error(&Case { deviation, ..case });
        assert!(got < least * most && got > least / most, "{:?} {deviation}: {got}, expected {least}", case.kernel);
    }
}

#[test]
fn split_lights_are_nearer_to_what_is_right() {
    let function = Function::of(&LIGHT_KERNEL, "half_plane").expect("built in");
    let worst = |case: &Case| {
        let all = case.half_plane(4 * RIGHT + 1);
        let mut worst = 0.0_f64;
        for distance in [4, 8, 16, 32, 64] {
            for (x, shadow) in all[distance].iter().enumerate().take(192).skip(64) {
                let at = x as f64 + 0.5 - case.size.0 as f64 / 2.0;
                worst = worst.max((shadow - expected(function, at, distance, case)[0]).abs());
            }
        }
        worst
    };
    let [one, many] = [(1, 1.0), (16, 0.15)].map(|split| worst(&Case { split, smear: None, ..Case::RING3 }));
    assert!(many < 0.5 * one, "{one} {many}");
}
