//! Matter with detail: patterns at the places that a row of pixels samples, and what they stand for there.

use super::detail::{Integrals, Numbers, Patterns, PixelSize, Placement, meant, numbers};
use super::material::{Material, Ways, ways};
use super::stack::Stack;
use super::surface::Surface;
use super::sweep::Matter;
use super::view::SlabView;
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Batch;
use crate::scene::matter::{Matter as Contents, Pattern};
use crate::technique::tables::{NOISE, columns};

/// The part of an object that a slab takes at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Taken {
    /// The object.
    pub(super) object: usize,
    /// The length of the way through its matter.
    pub(super) path: f64,
    /// The ends of that way, or of its longest part; both at the hit where a whole slab is taken for it.
    pub(super) ends: [f32; 2],
    /// The place between them that is sampled, unless that is drawn at random.
    pub(super) at: f32,
    /// Set if the place is drawn at random.
    pub(super) jittered: bool,
    /// The surface that is seen.
    pub(super) surface: Option<Surface>,
}

/// The detail of an object, as it is placed in a picture.
#[derive(Debug, Clone)]
pub(super) struct Placed {
    /// The pattern.
    pub(super) pattern: Pattern,
    /// The way to its space.
    pub(super) placement: Placement,
    /// The transfer function.
    pub(super) knots: Vec<Numbers>,
}

/// The details of all objects of a picture.
#[derive(Debug)]
pub(super) struct Fine {
    placed: Vec<Option<Placed>>,
    /// The units of a pixel.
    pixel: PixelSize,
    size: (usize, usize),
    seed: u32,
    /// Set if matter is integrated between its values in front and behind.
    integrates: bool,
    integrals: Integrals,
    ways: Ways,
}

/// The things that a row of pixels needs to sample details.
#[derive(Debug)]
pub(super) struct FineRow {
    patterns: Patterns,
    hash: Batch<'static, f64>,
}

/// The component of `hash` that is a number from 0 to 1, after its bits.
const UNIT: usize = 1;

impl Placed {
    /// The detail of a material, if it has any.
    pub(super) fn new(material: &Material, view: &SlabView, base: f64) -> Option<Self> {
        let detail = material.detail.as_ref()?;
        let knots = detail.knots.iter().map(|knot| numbers(knot, material.matter.length)).collect();
        Some(Self { pattern: detail.pattern, placement: Placement::new(detail, view, base), knots })
    }
}

impl Fine {
    /// The details of a picture; `None` without any.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub(super) fn new(
        materials: &[Material],
        view: &SlabView,
        base: f64,
        seed: u32,
        integrates: bool,
    ) -> Result<Option<Self>, Failure> {
        let placed: Vec<Option<Placed>> = materials.iter().map(|material| Placed::new(material, view, base)).collect();
        if placed.iter().all(Option::is_none) {
            return Ok(None);
        }
        let size = (view.size.0 as usize, view.size.1 as usize);
        let pixel = PixelSize::new(view, base);
        Ok(Some(Self { placed, pixel, size, seed, integrates, integrals: Integrals::new()?, ways: ways()? }))
    }

    /// Returns whether an object has detail.
    pub(super) fn has(&self, object: usize) -> bool {
        self.placed[object].is_some()
    }

    /// The things that a row of pixels needs.
    pub(super) fn row(&self) -> Result<FineRow, Failure> {
        Ok(FineRow { patterns: Patterns::new()?, hash: Batch::new(NOISE.function("hash")?) })
    }

    /// Fills in the matter of a slab in the pixels of a row that take some with detail.
    ///
    /// # Errors
    /// Never with the tables that come with Umbrage.
    pub(super) fn fill(
        &self,
        row: &mut FineRow,
        (slab, y): (usize, usize),
        stack: &Stack,
        taken: &[(usize, Taken)],
        materials: &[Material],
        out: &mut [Option<Matter>],
    ) -> Result<(), Failure> {
        for (object, placed) in self.placed.iter().enumerate() {
            let Some(placed) = placed else { continue };
            let own: Vec<&(usize, Taken)> = taken.iter().filter(|(_, taken)| taken.object == object).collect();
            if own.is_empty() {
                continue;
            }
            let place = |x: usize, depth: f32| {
                let centre = |at: usize, pixels: usize| at as f32 + 0.5 - 0.5 * pixels as f32;
                let from_middle = [centre(x, self.size.0), centre(y, self.size.1)];
                placed.placement.at(from_middle, depth, self.pixel)
            };
            let values = if self.integrates {
                let ends = |end: usize| own.iter().map(|(x, taken)| place(*x, taken.ends[end])).collect::<Vec<_>>();
                let [front, back] = [ends(0), ends(1)];
                let front = row.patterns.values(&placed.pattern, &front)?;
                front.into_iter().zip(row.patterns.values(&placed.pattern, &back)?).map(|(a, b)| [a, b]).collect()
            } else {
                let units = self.units(row, &own, (slab, y))?;
                let thickness = stack.thickness as f32;
                let at = own.iter().zip(units).map(|((x, taken), unit)| {
                    let depth = if taken.jittered { taken.ends[0] + unit * thickness } else { taken.at };
                    place(*x, depth)
                });
                let values = row.patterns.values(&placed.pattern, &at.collect::<Vec<_>>())?;
                values.into_iter().map(|value| [value; 2]).collect::<Vec<_>>()
            };
            for ((x, taken), values) in own.into_iter().zip(values) {
                out[*x] = self.matter(placed, &materials[object], taken, values)?;
            }
        }
        Ok(())
    }

    /// Numbers from 0 to 1, drawn for pixels of a slab.
    fn units(
        &self,
        row: &mut FineRow,
        own: &[&(usize, Taken)],
        (slab, y): (usize, usize),
    ) -> Result<Vec<f32>, Failure> {
        let same = |number: usize| vec![number as f64; own.len()];
        let given = [own.iter().map(|(x, _)| *x as f64).collect(), same(y), same(slab), same(self.seed as usize)];
        let given = columns(NOISE.function("hash")?, ["x", "y", "slab", "seed"], given)?;
        let lacks = |_| {
            let message = "the function `hash` needs an input that was not given";
            Failure::bare("noise", Diagnostic::error(codes::NOT_APPLICABLE, message))
        };
        let hashes = row.hash.evaluate(&given).map_err(lacks)?;
        Ok(hashes.values(UNIT).iter().map(|unit| *unit as f32).collect())
    }

    fn matter(
        &self,
        placed: &Placed,
        material: &Material,
        taken: &Taken,
        [front, back]: [f32; 2],
    ) -> Result<Option<Matter>, Failure> {
        let meant = meant(&placed.knots, 0.5 * (front + back));
        let transport = meant.transport.map(f64::from);
        let length = material.matter.length;
        let surface = taken.surface;
        if self.integrates {
            let (alpha, colour) = self.integrals.between(&placed.knots, [front, back], taken.path)?;
            let through = transport.map(|transport| 1.0 - alpha * (1.0 - transport));
            return Ok((alpha > 0.0).then_some(Matter { alpha, through, colour, surface }));
        }
        let matter = Contents { opacity: meant.opacity.into(), length, transport };
        let (alpha, through) = self.ways.of(&matter, taken.path);
        let colour = meant.colour.map(f64::from);
        Ok((alpha > 0.0).then_some(Matter { alpha, through, colour, surface }))
    }
}
