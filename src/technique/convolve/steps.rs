//! The steps of a sweep: for each slab that is visited, how every light is gathered from the one before.

use super::functions::Function;
use super::kernel::{Blur, Kernel, Sample};
use super::light::SlopeLight;
use super::matter::Stack;
use super::stencil::{Gather, Real, Stencil};
use super::sweep::Step;
use super::view::{Projection, SlabView};
use crate::diag::Failure;
use crate::technique::tables::{KERNELS, LIGHT_KERNEL, POLICIES};

/// The way from blurs to samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// The kernel.
    pub kernel: Kernel,
    /// Set if samples move along their curve from slab to slab, by the golden ratio.
    pub golden: bool,
    /// A level of the set `smear` of `tables/policies.ron`; `None` for what the table advises.
    pub smear: Option<&'static str>,
    /// The distance at which penumbras are right.
    pub d1: f64,
    /// The most steps through a run of empty slabs, so many that samples still make a Gaussian; 0 for a step each.
    pub skip: usize,
}

/// The functions that steps are made with.
struct Tables {
    kernel_of_light: Function,
    smear_of: Function,
    sharpened: Function,
    golden: Function,
}

/// The answer to the blur of interpolation: a level of `smear`, and once in how many slabs the blur is applied.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Policy {
    smear: &'static str,
    every: usize,
}

/// A light on its way through the slabs.
struct Walk<'l> {
    light: &'l SlopeLight,
    policy: Policy,
    /// Slabs since the blur was last applied.
    waiting: usize,
    /// The distance that the picture lags behind the light's mean, in pixels.
    behind: [f64; 2],
}

/// The steps through a stack of slabs, of which some hold matter.
///
/// # Errors
/// When a kernel is asked for a blur that it is not made for.
pub fn steps<T: Real>(
    lights: &[SlopeLight],
    stack: Stack,
    occupied: &[bool],
    spread: &Spread,
    view: &SlabView,
) -> Result<Vec<Step<T>>, Failure> {
    let tables = Tables {
        kernel_of_light: Function::of(&LIGHT_KERNEL, "kernel_of_light")?,
        smear_of: Function::of(&POLICIES, "smear_of")?,
        sharpened: Function::of(&POLICIES, "sharpened")?,
        golden: Function::of(&KERNELS, "golden")?,
    };
    let mut walks = Vec::new();
    for light in lights {
        let scale = view.scale_at(stack.slab(stack.count / 2).0.max(view.near()));
        let policy = tables.policy(light, stack.thickness, scale, spread)?;
        walks.push(Walk { light, policy, waiting: 0, behind: [0.0; 2] });
    }
    let mut steps = Vec::new();
    let mut last: Option<usize> = None;
    for slab in visited(occupied, spread.skip) {
        let gathers = match last {
            // Before the first slab light is the same everywhere.
            None => walks.iter().map(|_| Gather::Same(Stencil::nothing())).collect(),
            Some(last) => {
                let (slabs, before) = (slab - last, stack.slab(last).0);
                let gather = |walk: &mut Walk<'_>| walk.gather(&tables, slab, slabs, before, &stack, spread, view);
                walks.iter_mut().map(gather).collect::<Result<_, _>>()?
            }
        };
        steps.push(Step { slab, gathers });
        last = Some(slab);
    }
    Ok(steps)
}

/// The slabs that are visited: those with matter, and of a run between them some that divide it evenly.
fn visited(occupied: &[bool], most: usize) -> Vec<usize> {
    let mut all: Vec<usize> = Vec::new();
    for (slab, _) in occupied.iter().enumerate().filter(|(_, holds)| **holds || most == 0) {
        if let Some(last) = all.last().copied() {
            let parts = (slab - last).min(most.max(1));
            all.extend((1..parts).map(|part| last + (slab - last) * part / parts));
        }
        all.push(slab);
    }
    all
}

impl Tables {
    fn policy(&self, light: &SlopeLight, thickness: f64, scale: f64, spread: &Spread) -> Result<Policy, Failure> {
        let blur = light.blur(self.kernel_of_light, spread.d1, thickness, scale)?;
        // What is narrow in one direction is cut there at nothing: the wide one says how often a blur is worth a sample.
        let widest = blur.variances[0].max(blur.variances[1]).sqrt();
        let answer = self.smear_of.call(&[("deviation", widest.into())])?;
        let smear = match spread.smear {
            Some(smear) => smear,
            None => answer.level("policy")?,
        };
        let every = if smear == "stride" { answer.number("every")?.max(1.0) as usize } else { 1 };
        Ok(Policy { smear, every })
    }

    /// The blur with narrower variances, as interpolation will widen them.
    fn sharpen(&self, blur: &mut Blur) -> Result<(), Failure> {
        let [x, y] = blur.variances;
        let answer = self.sharpened.call(&[("c11", x.into()), ("c12", 0.0.into()), ("c22", y.into())])?;
        let [a11, a22] = answer.numbers(["a11", "a22"])?;
        blur.variances = [a11 * a11, a22 * a22];
        Ok(())
    }
}

impl Walk<'_> {
    #[expect(clippy::too_many_arguments, reason = "a step is where everything comes together")]
    fn gather<T: Real>(
        &mut self,
        tables: &Tables,
        slab: usize,
        slabs: usize,
        before: f64,
        stack: &Stack,
        spread: &Spread,
        view: &SlabView,
    ) -> Result<Gather<T>, Failure> {
        let depth = slabs as f64 * stack.thickness;
        let scale = view.scale_at(before.max(view.near()));
        let way = self.light.blur(tables.kernel_of_light, spread.d1, depth, scale)?;
        self.waiting += slabs;
        let wanted = [self.behind[0] + way.mean[0], self.behind[1] + way.mean[1]];
        let sharp = self.policy.smear == "snap" || self.policy.smear == "stride" && self.waiting < self.policy.every;
        let samples = if sharp {
            let at = wanted.map(|wanted| (wanted + 0.5).floor());
            self.behind = [wanted[0] - at[0], wanted[1] - at[1]];
            if self.policy.smear == "snap" {
                self.waiting = 0;
            }
            vec![Sample { at, weight: 1.0 }]
        } else {
            let depth = self.waiting as f64 * stack.thickness;
            let mut blur = self.light.blur(tables.kernel_of_light, spread.d1, depth, scale)?;
            blur.mean = wanted;
            if self.policy.smear != "none" && !spread.kernel.is_whole() {
                tables.sharpen(&mut blur)?;
            }
            self.waiting = 0;
            let phase = if spread.golden {
                tables.golden.call(&[("slab", ((slab % (1 << 20)) as f64).into())])?.number("value")?
            } else {
                0.0
            };
            let samples = spread.kernel.samples(&blur, phase)?;
            self.behind = if spread.kernel.is_whole() {
                let at = wanted.map(|wanted| (wanted + 0.5).floor());
                [wanted[0] - at[0], wanted[1] - at[1]]
            } else {
                [0.0; 2]
            };
            samples
        };
        let factor = match view.projection {
            Projection::PerspectiveWorld => scale / view.scale_at(before + depth),
            Projection::Orthographic | Projection::PerspectiveFollow => 1.0,
        };
        Ok(if factor == 1.0 {
            Gather::Same(Stencil::new(&samples))
        } else {
            Gather::Magnified { samples, factor, middle: view.middle().to_array() }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::visited;

    #[test]
    fn runs_are_divided_evenly() {
        let holds = |slab: usize| [3, 4, 24, 27].contains(&slab);
        let occupied: Vec<bool> = (0..30).map(holds).collect();
        assert_eq!(visited(&occupied, 0), (0..30).collect::<Vec<_>>());
        assert_eq!(visited(&occupied, 1), [3, 4, 24, 27]);
        assert_eq!(visited(&occupied, 4), [3, 4, 9, 14, 19, 24, 25, 26, 27]);
        assert_eq!(visited(&[false; 4], 4), [0; 0]);
    }
}
