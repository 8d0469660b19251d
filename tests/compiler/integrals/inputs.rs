//! Inputs to try the integrals at: random ones of every size, and all the places where formulas fail.

use super::oracle::Rules;

/// Random numbers, the same in every run (splitmix64).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    pub(crate) fn part(&mut self) -> f64 {
        (self.bits() >> 11) as f64 / (1_u64 << 53) as f64
    }

    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.part()
    }

    /// Between two positive numbers, as many in each decade.
    pub(crate) fn by_size(&mut self, lo: f64, hi: f64) -> f64 {
        self.between(lo.ln(), hi.ln()).exp()
    }

    pub(crate) fn pick<T: Copy>(&mut self, items: &[T]) -> T {
        items[(self.bits() % items.len() as u64) as usize]
    }

    /// A value at or beside one of these: exactly, its `f32` neighbours, or up to 1e-2 away.
    pub(crate) fn near(&mut self, places: &[f64]) -> f32 {
        let place = self.pick(places) as f32;
        match self.pick(&[0, 1, 2, 3, 3, 3]) {
            0 => place,
            1 => place.next_up(),
            2 => place.next_down(),
            _ => {
                let distance = self.by_size(1e-7, 1e-2);
                (f64::from(place) + self.pick(&[-1.0, 1.0]) * distance) as f32
            }
        }
    }

    /// A vector of length up to 1; at times with zeros, or straight up or down.
    pub(crate) fn vector(&mut self) -> [f32; 3] {
        match self.pick(&[0, 1, 2, 3, 4, 5]) {
            0 => [0.0, 0.0, self.pick(&[1.0, -1.0])],
            1 => [self.between(-1.0, 1.0) as f32, 0.0, self.between(-1.0, 1.0) as f32],
            _ => {
                let (z, phi) = (self.between(-1.0, 1.0), self.between(-3.2, 3.2));
                let flat = (1.0 - z * z).sqrt();
                [(flat * phi.cos()) as f32, (flat * phi.sin()) as f32, z as f32]
            }
        }
    }
}

/// The slopes at which printed formulas divide by zero.
pub(crate) const SLOPES: [f64; 11] =
    [0.0, 0.5, -0.5, 1.0, -1.0, 1.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0, -2.0 / 3.0, 2.0, -2.0];

/// A cell with a linear upper side.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Cell {
    pub(crate) phi0: f32,
    pub(crate) phi1: f32,
    pub(crate) theta0: f32,
    pub(crate) k: f32,
    pub(crate) b: f32,
}

/// A cell whose upper side stays between 0 and π.
pub(crate) fn cell(random: &mut Random) -> Cell {
    loop {
        let width = match random.pick(&[0, 1, 1, 1, 2]) {
            0 => 0.0,
            1 => random.by_size(1e-4, 1.55),
            _ => random.between(0.1, 1.55),
        };
        let phi0 = random.between(0.0, 6.25 - width) as f32;
        let phi1 = (f64::from(phi0) + width) as f32;
        let k = match random.pick(&[0, 1, 1]) {
            0 => random.between(-4.0, 4.0) as f32,
            _ => random.near(&SLOPES),
        };
        let middle = 0.5 * (f64::from(phi0) + f64::from(phi1));
        let thickness = random.pick(&[0.0, 1.0, 1.0, 1.0]) * random.by_size(1e-4, 3.0);
        // At times at a pole, or close to it.
        let theta0 = match random.pick(&[0, 1, 2, 2, 2, 2]) {
            0 => 0.0,
            1 => random.by_size(1e-3, 0.3),
            _ => random.between(0.0, 3.1),
        } as f32;
        let b = (f64::from(theta0) + thickness - f64::from(k) * middle) as f32;
        let ends = [phi0, phi1].map(|phi| f64::from(k) * f64::from(phi) + f64::from(b));
        if ends.iter().all(|theta| (0.0..=std::f64::consts::PI).contains(theta)) {
            return Cell { phi0, phi1, theta0, k, b };
        }
    }
}

impl Cell {
    /// Its integrals.
    pub(crate) fn moments(rules: &Rules, [phi0, phi1, theta0, k, b]: [f64; 5]) -> super::oracle::Moments {
        rules.moments((phi0, phi1), theta0, |phi| k * phi + b)
    }
}
