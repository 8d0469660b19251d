//! The light that a surface receives, in the two ways in which it sends it on, and the bare form factor.

use std::ops::{Add, AddAssign, Mul, Sub};

use glam::DVec3;

/// Sums over lights.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Received {
    /// Of form factors.
    pub(super) factor: f64,
    /// Of form factors, each times the light's radiance.
    pub(super) diffuse: DVec3,
    /// Of form factors of the lights as the gloss of the surface transforms them, each times the light's radiance; zero
    /// where it has none.
    pub(super) glossy: DVec3,
}

impl Received {
    /// A light of some radiance, by its two form factors.
    pub(super) fn of(radiance: [f64; 3], factors: [f64; 2]) -> Self {
        let [diffuse, glossy] = factors.map(|factor| factor * DVec3::from_array(radiance));
        Self { factor: factors[0], diffuse, glossy }
    }

    /// The same with each of its numbers changed by that of another, channel by channel.
    pub(super) fn with(self, other: Self, change: impl Fn(DVec3, DVec3) -> DVec3) -> Self {
        Self {
            factor: change(DVec3::splat(self.factor), DVec3::splat(other.factor)).x,
            diffuse: change(self.diffuse, other.diffuse),
            glossy: change(self.glossy, other.glossy),
        }
    }
}

impl Add for Received {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.with(other, |a, b| a + b)
    }
}

impl Sub for Received {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        self.with(other, |a, b| a - b)
    }
}

impl AddAssign for Received {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul<Received> for f64 {
    type Output = Received;

    fn mul(self, received: Received) -> Received {
        received.with(received, |a, _| self * a)
    }
}
