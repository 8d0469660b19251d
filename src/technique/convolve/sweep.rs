//! The sweep: from front to back each slab gathers light, shades what it holds with it, and lets through the rest.
//!
//! It knows nothing of scenes: what a slab holds is asked of a [`Matter`], how light spreads is in the [`Step`]s.

use rayon::prelude::*;

use super::stencil::{Around, Border, Gather, Real};
use super::surface::{Surface, Surfaces};

/// Matter of a slab at a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matter {
    /// Its opacity.
    pub alpha: f64,
    /// The share of light that goes on, by colour.
    pub through: [f64; 3],
    /// The light that it sends to the viewer where light of strength 1 arrives, by colour.
    pub colour: [f64; 3],
    /// The surface that is seen in the slab, if any.
    pub surface: Option<Surface>,
}

/// The contents of slabs. Pixels are asked for once a slab, slabs in order.
pub trait Slabs: Sync {
    /// The state of a pixel's row between slabs.
    type Row: Send;

    /// The state before the first slab.
    fn row(&self, y: usize) -> Self::Row;

    /// The matter of a slab in the pixels of a row.
    fn matter(&self, slab: usize, y: usize, row: &mut Self::Row, out: &mut [Option<Matter>]);
}

/// A slab with matter, and what light does on the way to it.
#[derive(Debug, Clone, PartialEq)]
pub struct Step<T> {
    /// The slab.
    pub slab: usize,
    /// The gather of each light from the step before.
    pub gathers: Vec<Gather<T>>,
}

impl<T> Step<T> {
    /// Returns whether its gathers ask for phases of pixels.
    pub fn is_dithered(&self) -> bool {
        self.gathers.iter().any(|gather| matches!(gather, Gather::Dithered(_)))
    }
}

/// The light of all lights at the pixels of a slab: row by row, in a row light by light, of a light colour by colour.
#[derive(Debug, Clone)]
pub struct LightImages<T> {
    /// Pixels per row, and rows.
    pub size: (usize, usize),
    lights: usize,
    data: Vec<T>,
}

impl<T: Real> LightImages<T> {
    /// Images of light that nothing has hindered.
    pub fn new(size: (usize, usize), colours: &[[f64; 3]]) -> Self {
        let (width, height) = size;
        let mut row = Vec::with_capacity(colours.len() * 3 * width);
        for channel in colours.iter().flatten() {
            row.extend(std::iter::repeat_n(T::of(*channel), width));
        }
        Self { size, lights: colours.len(), data: row.repeat(height) }
    }

    /// The numbers of a row of pixels.
    fn row_len(&self) -> usize {
        self.lights * 3 * self.size.0
    }

    /// One colour of a light in a row.
    pub fn row(&self, y: usize, light: usize, channel: usize) -> &[T] {
        let start = y * self.row_len() + (3 * light + channel) * self.size.0;
        &self.data[start..start + self.size.0]
    }
}

/// The picture so far.
#[derive(Debug, Clone)]
pub struct Seen<T> {
    /// Colours times opacity, row by row.
    pub colour: Vec<[T; 3]>,
    /// Opacities.
    pub opacity: Vec<T>,
}

/// A sweep under way.
#[derive(Debug)]
pub struct Sweep<'m, S: Slabs, T> {
    slabs: &'m S,
    rows: Vec<S::Row>,
    colours: Vec<[f64; 3]>,
    border: Border,
    surfaces: Option<&'m Surfaces>,
    /// Light behind the last slab.
    pub light: LightImages<T>,
    next: LightImages<T>,
    /// The picture of the slabs so far.
    pub seen: Seen<T>,
}

impl<'m, S: Slabs, T: Real> Sweep<'m, S, T> {
    /// A sweep before the first slab; without `surfaces` light is scattered alike everywhere.
    pub fn new(
        slabs: &'m S,
        size: (usize, usize),
        colours: Vec<[f64; 3]>,
        border: Border,
        surfaces: Option<&'m Surfaces>,
    ) -> Self {
        let light = LightImages::new(size, &colours);
        let pixels = size.0 * size.1;
        Self {
            slabs,
            rows: (0..size.1).map(|y| slabs.row(y)).collect(),
            border,
            surfaces,
            next: light.clone(),
            light,
            colours,
            seen: Seen { colour: vec![[T::default(); 3]; pixels], opacity: vec![T::default(); pixels] },
        }
    }

    /// Goes on by a step; `phases` are those of all pixels, where gathers ask for them.
    pub fn step(&mut self, step: &Step<T>, phases: &[u8]) {
        let (width, height) = self.size();
        let Self { slabs, rows, colours, border, surfaces, light, next, seen } = self;
        let (slabs, light, colours, border, surfaces) = (*slabs, &*light, &*colours, *border, *surfaces);
        let row_len = light.row_len();
        // Without lights there is still matter to be seen.
        let outs: Vec<&mut [T]> = match row_len {
            0 => (0..height).map(|_| &mut [] as &mut [T]).collect(),
            _ => next.data.chunks_mut(row_len).collect(),
        };
        let all = outs.into_par_iter().zip(rows.par_iter_mut());
        let all = all.zip(seen.colour.par_chunks_mut(width).zip(seen.opacity.par_chunks_mut(width)));
        all.enumerate().for_each(|(y, ((out, row), (colour, opacity)))| {
            for (light_index, gather) in step.gathers.iter().enumerate() {
                for (channel, bright) in colours[light_index].iter().enumerate() {
                    let start = (3 * light_index + channel) * width;
                    let around = Around { height, border, light: T::of(*bright) };
                    let phases = phases.get(y * width..(y + 1) * width).unwrap_or_default();
                    let row = |y| light.row(y, light_index, channel);
                    gather.gather(&mut out[start..start + width], y, around, phases, row);
                }
            }
            let mut matter = vec![None; width];
            slabs.matter(step.slab, y, row, &mut matter);
            for (x, matter) in matter.iter().enumerate() {
                let Some(Matter { alpha, through, colour: own, surface }) = matter else { continue };
                let alpha = T::of(*alpha);
                let open = (T::of(1.0) - opacity[x]) * alpha;
                let changed = surface.as_ref().zip(surfaces).filter(|(surface, of)| of.changes(surface.object));
                let lit = changed.map(|(surface, of)| (0..colours.len()).map(|light| of.lit(light, surface)));
                let lit: Option<Vec<(f64, f64)>> = lit.map(Iterator::collect);
                for channel in 0..3 {
                    let mut arrived = T::default();
                    for (light_index, bright) in colours.iter().enumerate() {
                        let place = &mut out[(3 * light_index + channel) * width + x];
                        arrived += match &lit {
                            None => *place,
                            Some(lit) => {
                                let (factor, reflected) = lit[light_index];
                                let value = *place * T::of(factor);
                                let most = T::of(bright[channel]);
                                let value = if value.wide() > most.wide() { most } else { value };
                                value * (T::of(own[channel]) + T::of(reflected))
                            }
                        };
                        *place = *place * T::of(through[channel]);
                    }
                    let sent = if lit.is_some() { arrived } else { arrived * T::of(own[channel]) };
                    colour[x][channel] += open * sent;
                }
                opacity[x] += open;
            }
        });
        std::mem::swap(&mut self.light, &mut self.next);
    }

    fn size(&self) -> (usize, usize) {
        self.light.size
    }
}
