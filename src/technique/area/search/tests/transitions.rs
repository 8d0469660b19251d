//! An ellipse that moves over a triangle: the configurations it leads to, and the mean of what is found.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use super::super::super::sampling::Stream;
use super::super::{Options, Searcher, Seen};
use super::share;

const TRIANGLE: [DVec3; 3] = [DVec3::new(0.0, 0.0, 0.0), DVec3::new(1.0, 0.1, 0.0), DVec3::new(0.2, 1.0, 0.0)];

/// An ellipse, turned by an angle.
struct Ellipse {
    centre: DVec2,
    half_axes: DVec2,
    angle: f64,
}

impl Ellipse {
    fn hides(&self, place: DVec3) -> bool {
        let own = DVec2::from_angle(-self.angle).rotate(place.truncate() - self.centre) / self.half_axes;
        own.length_squared() < 1.0
    }
}

fn search(searcher: &mut Searcher, ellipse: &Ellipse, number: u32, seed: u32) -> Seen {
    searcher.search(&TRIANGLE, None, &mut Stream::new([number, 0], 0, seed), &mut |place| !ellipse.hides(place))
}

#[test]
fn an_ellipse_leads_from_one_configuration_to_nine_kinds_of_neighbours() {
    const PAIRS: [(&str, &str); 9] = [
        ("C000", "C002"),
        ("C000", "C011"),
        ("C002", "C011"),
        ("C002", "C022"),
        ("C011", "C022"),
        ("C011", "C112"),
        ("C022", "C112"),
        ("C022", "C222"),
        ("C112", "C222"),
    ];
    let fine = Options { rays: 1, tolerance: 0.01, gap: 0.01, ..Options::default() };
    let mut searcher = Searcher::new(fine).unwrap_or_else(|e| panic!("{e}"));
    let mut random = Stream::new([5, 6], 7, 8);
    let mut counts: BTreeMap<(&str, &str), u32> = BTreeMap::new();
    for path in 0..60 {
        let mut between = |lo: f64, hi: f64| lo + (hi - lo) * random.uniform();
        let (from, angle) = (between(0.0, std::f64::consts::TAU), between(0.0, std::f64::consts::PI));
        let half_axes = DVec2::new(between(0.1, 0.6), between(0.05, 0.4));
        let (middle, aside) = (DVec2::new(0.4, 0.37), between(-0.5, 0.5));
        let direction = DVec2::from_angle(from);
        let mut before = "C000";
        for step in 0..=240 {
            let along = -1.2 + 2.4 * f64::from(step) / 240.0;
            let ellipse = Ellipse { centre: middle + direction * along + direction.perp() * aside, half_axes, angle };
            let now = search(&mut searcher, &ellipse, path, 0).regions[0].configuration.1;
            if now != before {
                *counts.entry((before.min(now), before.max(now))).or_default() += 1;
            }
            before = now;
        }
    }
    let total: u32 = counts.values().sum();
    for pair in PAIRS {
        assert!(counts.contains_key(&pair), "{pair:?} is missing: {counts:?}");
    }
    // Others are two transitions within one step.
    let other: u32 = counts.iter().filter(|(pair, _)| !PAIRS.contains(pair)).map(|(_, count)| count).sum();
    assert!(total > 200 && 25 * other <= total, "{counts:?}");
}

#[test]
fn the_mean_of_what_is_found_does_not_jump_from_one_configuration_to_the_next() {
    const SEEDS: u32 = 96;
    // The largest true step along this path is 0.0128.
    for (rays, most) in [(0, 0.028), (3, 0.021)] {
        let mut searcher = Searcher::new(Options { rays, ..Options::default() }).unwrap_or_else(|e| panic!("{e}"));
        let mut means = Vec::new();
        for step in 0..160 {
            let along = f64::from(step) / 159.0;
            let centre = DVec2::new(-0.5, 0.3).lerp(DVec2::new(1.2, 0.6), along);
            let ellipse = Ellipse { centre, half_axes: DVec2::new(0.35, 0.25), angle: 0.0 };
            let found = |seed| share(&search(&mut searcher, &ellipse, step, seed), &TRIANGLE);
            means.push((0..SEEDS).map(found).sum::<f64>() / f64::from(SEEDS));
        }
        let largest = means.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(largest < most, "{rays} rays: {largest}");
    }
}
