//! The steps of a sweep: for each slab that is visited, how every light is gathered from the one before.

use std::marker::PhantomData;

use super::dither::PHASES;
use super::functions::Function;
use super::kernel::{Blur, Kernel, Sample};
use super::light::SlopeLight;
use super::stack::Stack;
use super::stencil::{Gather, Real, Stencil};
use super::sweep::Step;
use super::view::{Projection, SlabView};
use crate::diag::{Diagnostic, Failure, codes};
use crate::technique::tables::{KERNELS, LIGHT_KERNEL, NOISE, POLICIES};

/// The sequence in which samples move along their curve: a level of the set `phases` of `tables/kernels.ron`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Phase {
    /// From slab to slab by the golden ratio.
    Golden,
    /// Not at all.
    Steady,
    /// Drawn for each slab and light.
    Random,
    /// Drawn for each pixel of each slab.
    Pixel,
}

/// The way from blurs to samples.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// The kernel.
    pub kernel: Kernel,
    /// The sequence of its phases.
    pub phase: Phase,
    /// The number that drawn phases depend on.
    pub seed: u32,
    /// A level of the set `smear` of `tables/policies.ron`; `None` for what the table advises.
    pub smear: Option<&'static str>,
    /// The distance at which penumbras are right.
    pub d1: f64,
    /// The most steps through a run of empty slabs, so many that samples still make a Gaussian; 0 for a step each.
    pub skip: usize,
}

/// The functions that steps are made with.
#[derive(Debug)]
struct Tables {
    kernel_of_light: Function,
    smear_of: Function,
    sharpened: Function,
    golden: Function,
    hash: Function,
}

/// The answer to the blur of interpolation: a level of `smear`, and once in how many slabs the blur is applied.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Policy {
    smear: &'static str,
    every: usize,
}

/// A light on its way through the slabs.
#[derive(Debug)]
struct Walk<'l> {
    light: &'l SlopeLight,
    /// Its number, which drawn phases depend on.
    number: usize,
    policy: Policy,
    /// Slabs since the blur was last applied.
    waiting: usize,
    /// The distance that the picture lags behind the light's mean, in pixels.
    behind: [f64; 2],
}

/// The steps through a stack of slabs, one after the other: there may be more than there is memory for.
#[derive(Debug)]
pub struct Steps<'l, T> {
    tables: Tables,
    walks: Vec<Walk<'l>>,
    stack: &'l Stack,
    spread: Spread,
    view: &'l SlabView,
    visited: std::vec::IntoIter<usize>,
    last: Option<usize>,
    kind: PhantomData<T>,
}

impl<'l, T: Real> Steps<'l, T> {
    /// The steps of lights through a stack of slabs, of which some hold matter.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub fn new(
        lights: &'l [SlopeLight],
        stack: &'l Stack,
        occupied: &[bool],
        spread: &Spread,
        view: &'l SlabView,
    ) -> Result<Self, Failure> {
        let tables = Tables {
            kernel_of_light: Function::of(&LIGHT_KERNEL, "kernel_of_light")?,
            smear_of: Function::of(&POLICIES, "smear_of")?,
            sharpened: Function::of(&POLICIES, "sharpened")?,
            golden: Function::of(&KERNELS, "golden")?,
            hash: Function::of(&NOISE, "hash")?,
        };
        let scale = view.scale_at(stack.depth(stack.count() / 2).max(view.near()));
        let walk = |(number, light): (usize, &'l SlopeLight)| {
            let policy = tables.policy(light, stack.thickness, scale, spread)?;
            Ok(Walk { light, number, policy, waiting: 0, behind: [0.0; 2] })
        };
        let walks = lights.iter().enumerate().map(walk).collect::<Result<_, Failure>>()?;
        let visited = visited(occupied, spread.skip).into_iter();
        Ok(Self { tables, walks, stack, spread: *spread, view, visited, last: None, kind: PhantomData })
    }

    fn step(&mut self, slab: usize) -> Result<Step<T>, Failure> {
        let Self { tables, walks, stack, spread, view, .. } = self;
        let gathers = match self.last {
            // Before the first slab light is the same everywhere.
            None => walks.iter().map(|_| Gather::Same(Stencil::nothing())).collect(),
            Some(last) => {
                let way = Way { slab, slabs: slab - last, before: stack.depth(last), stack, spread, view };
                walks.iter_mut().map(|walk| walk.gather(tables, &way)).collect::<Result<_, _>>()?
            }
        };
        self.last = Some(slab);
        Ok(Step { slab, gathers })
    }
}

impl<T: Real> Iterator for Steps<'_, T> {
    type Item = Result<Step<T>, Failure>;

    /// The next step; an error when a kernel is asked for a blur that it is not made for.
    fn next(&mut self) -> Option<Self::Item> {
        let slab = self.visited.next()?;
        Some(self.step(slab))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        self.visited.size_hint()
    }
}

impl<T: Real> ExactSizeIterator for Steps<'_, T> {}

/// The way from one visited slab to the next.
struct Way<'w> {
    slab: usize,
    /// The number of slabs that it leads through.
    slabs: usize,
    /// The depth at which it begins.
    before: f64,
    stack: &'w Stack,
    spread: &'w Spread,
    view: &'w SlabView,
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

    /// The phase of a light's samples in a slab.
    fn phase(&self, slab: usize, light: usize, spread: &Spread) -> Result<f64, Failure> {
        match spread.phase {
            Phase::Golden => self.golden.call(&[("slab", ((slab % (1 << 20)) as f64).into())])?.number("value"),
            Phase::Steady | Phase::Pixel => Ok(0.0),
            Phase::Random => {
                let given = [("x", 0.0), ("y", light as f64), ("slab", slab as f64), ("seed", spread.seed.into())];
                self.hash.call(&given.map(|(name, number)| (name, number.into())))?.number("unit")
            }
        }
    }
}

impl Walk<'_> {
    fn gather<T: Real>(&mut self, tables: &Tables, way: &Way<'_>) -> Result<Gather<T>, Failure> {
        let Way { slab, slabs, before, stack, spread, view } = *way;
        let depth = slabs as f64 * stack.thickness;
        let scale = view.scale_at(before.max(view.near()));
        let blur = self.light.blur(tables.kernel_of_light, spread.d1, depth, scale)?;
        self.waiting += slabs;
        let wanted = [self.behind[0] + blur.mean[0], self.behind[1] + blur.mean[1]];
        let whole = || wanted.map(|wanted| (wanted + 0.5).floor());
        let lag = || [wanted[0] - whole()[0], wanted[1] - whole()[1]];
        let sharp = self.policy.smear == "snap" || self.policy.smear == "stride" && self.waiting < self.policy.every;
        let beyond = match view.projection {
            Projection::PerspectiveWorld => scale / view.scale_at(before + depth) - 1.0,
            Projection::Orthographic | Projection::PerspectiveFollow => 0.0,
        };
        let gathered = |samples: Vec<Sample>| match beyond {
            0.0 => Gather::Same(Stencil::new(&samples)),
            _ => Gather::Magnified { samples, beyond },
        };
        if sharp {
            self.behind = lag();
            if self.policy.smear == "snap" {
                self.waiting = 0;
            }
            return Ok(gathered(vec![Sample { at: whole(), weight: 1.0 }]));
        }
        let mut blur =
            self.light.blur(tables.kernel_of_light, spread.d1, self.waiting as f64 * stack.thickness, scale)?;
        blur.mean = wanted;
        if self.policy.smear != "none" && !spread.kernel.is_whole() {
            tables.sharpen(&mut blur)?;
        }
        self.waiting = 0;
        self.behind = if spread.kernel.is_whole() { lag() } else { [0.0; 2] };
        if spread.phase == Phase::Pixel && spread.kernel.has_phase() {
            if beyond != 0.0 {
                let error =
                    Diagnostic::error(codes::RENDER, "phases drawn for each pixel are for views without magnification");
                return Err(Failure::bare("", error.help("choose `--set phase=random`, or another projection")));
            }
            let one = |phase: usize| Ok(Stencil::new(&spread.kernel.samples(&blur, phase as f64 / PHASES as f64)?));
            return Ok(Gather::Dithered((0..PHASES).map(one).collect::<Result<_, Failure>>()?));
        }
        Ok(gathered(spread.kernel.samples(&blur, tables.phase(slab, self.number, spread)?)?))
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
