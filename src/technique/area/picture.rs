//! Pictures by peeling: every pixel of every tile, behind the occluders that can matter to it.

use rayon::prelude::*;

use super::lit::Lit;
use super::occluder::Occluder;
use super::peel::Work;
use super::point::{Answer, Peeler, Query};
use super::received::Received;
use super::scalar::Scalar;
use super::tiles::{SIDE, candidates, pixels};
use crate::diag::Failure;
use crate::scene::rays::SurfacePoint;
use crate::technique::Progress;

/// The results for the pixels of a picture, row by row from the top.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Pixels {
    /// The light that arrives.
    pub(super) received: Vec<Received>,
    /// The same without occluders.
    pub(super) unshadowed: Vec<Received>,
    /// The work for all lights together.
    pub(super) work: Vec<Work>,
}

impl Pixels {
    pub(super) fn new(count: usize) -> Self {
        let none = vec![Received::default(); count];
        Self { received: none.clone(), unshadowed: none, work: vec![Work::default(); count] }
    }
}

/// The results for a tile: each pixel with its light, with and without occluders, and its work.
type Tile = Vec<(usize, Received, Received, Work)>;

/// Computes the light at every pixel.
///
/// # Errors
/// Never for the tables that come with Umbrage.
pub(super) fn peeled<T: Scalar>(lit: &Lit, progress: &Progress<'_>) -> Result<Pixels, Failure> {
    let (width, height) = (lit.surfaces.width as usize, lit.surfaces.height as usize);
    let rows = (0..height.div_ceil(SIDE)).into_par_iter().map_init(Peeler::<T>::new, |peeler, row| {
        let peeler = peeler.as_mut().map_err(|failure| failure.clone())?;
        let tiles = (0..width.div_ceil(SIDE)).map(|column| tile(lit, peeler, column, row));
        let tiles = tiles.collect::<Result<Vec<Tile>, Failure>>()?;
        progress((height - row * SIDE).min(SIDE) as u64);
        Ok(tiles)
    });
    let mut all = Pixels::new(width * height);
    for (pixel, received, unshadowed, work) in
        rows.collect::<Result<Vec<_>, Failure>>()?.into_iter().flatten().flatten()
    {
        (all.received[pixel], all.unshadowed[pixel], all.work[pixel]) = (received, unshadowed, work);
    }
    Ok(all)
}

/// The mean of the lights' visible fractions at every pixel, exactly; 1 where no light is seen at all.
///
/// # Errors
/// Never for the tables that come with Umbrage.
pub(super) fn fractions(lit: &Lit) -> Result<Vec<f64>, Failure> {
    let width = lit.surfaces.width as usize;
    let row = |peeler: &mut Result<Peeler<f64>, Failure>, points: &[Option<SurfacePoint>]| {
        let peeler = peeler.as_mut().map_err(|failure| failure.clone())?;
        let mut fractions = vec![1.0; points.len()];
        for (fraction, point) in fractions.iter_mut().zip(points) {
            let Some(point) = point else { continue };
            let occluders: Vec<Vec<&Occluder>> = lit
                .lights
                .iter()
                .map(|light| {
                    let near = candidates(lit, light, std::iter::once(point.place));
                    near.into_iter().map(|index| &lit.occluders[index]).collect()
                })
                .collect();
            let queries = lit.lights.iter().zip(&occluders).map(|(light, occluders)| Query {
                light: &light.corners,
                two_sided: light.two_sided,
                point: point.place,
                blur: lit.blur,
                normal: point.smooth_normal,
                fraction: true,
                occluders: occluders.as_slice().into(),
                shape: None,
            });
            let seen: Vec<f64> = peeler.answers(queries)?.iter().filter_map(|answer| answer.fraction).collect();
            if !seen.is_empty() {
                *fraction = seen.iter().sum::<f64>() / seen.len() as f64;
            }
        }
        Ok(fractions)
    };
    let rows = lit.surfaces.points.par_chunks(width.max(1)).map_init(Peeler::<f64>::new, row);
    Ok(rows.collect::<Result<Vec<Vec<f64>>, Failure>>()?.concat())
}

fn tile<T: Scalar>(lit: &Lit, peeler: &mut Peeler<T>, column: usize, row: usize) -> Result<Tile, Failure> {
    let seen: Vec<(usize, &SurfacePoint)> = pixels(lit, column, row).collect();
    together(lit, peeler, &seen)
}

/// Pixels that are near to each other.
fn together<T: Scalar>(lit: &Lit, peeler: &mut Peeler<T>, seen: &[(usize, &SurfacePoint)]) -> Result<Tile, Failure> {
    let none = Received::default();
    let mut tile: Tile = seen.iter().map(|(pixel, _)| (*pixel, none, none, Work::default())).collect();
    if seen.is_empty() {
        return Ok(tile);
    }
    for light in &lit.lights {
        let occluders = candidates(lit, light, seen.iter().map(|(_, point)| point.place));
        let occluders: Vec<&Occluder> = occluders.into_iter().map(|index| &lit.occluders[index]).collect();
        let query = |(pixel, point): &(usize, &SurfacePoint)| Query {
            light: &light.corners,
            two_sided: light.two_sided,
            point: point.place,
            blur: lit.blur,
            normal: point.smooth_normal,
            fraction: false,
            occluders: occluders.as_slice().into(),
            shape: lit.sheen(*pixel).map(|sheen| sheen.shape),
        };
        let answers: Vec<Answer> = peeler.answers(seen.iter().map(query))?;
        for ((_, received, unshadowed, work), answer) in tile.iter_mut().zip(answers) {
            let (with, without) = answer.shaped.unwrap_or_default();
            *received += Received::of(light.colour, [answer.form_factor, with]);
            *unshadowed += Received::of(light.colour, [answer.form_factor_unshadowed, without]);
            work.pieces += answer.work.pieces;
            work.clips += answer.work.clips;
            work.overflow |= answer.work.overflow;
        }
    }
    Ok(tile)
}

/// Computes the light at some pixels again, one by one; that they overflow stays.
///
/// # Errors
/// Never for the tables that come with Umbrage.
#[cfg(feature = "gpu")]
pub(super) fn peeled_at<T: Scalar>(lit: &Lit, some: &[usize], all: &mut Pixels) -> Result<(), Failure> {
    let one = |peeler: &mut Result<Peeler<T>, Failure>, pixel: &usize| {
        let peeler = peeler.as_mut().map_err(|failure| failure.clone())?;
        let point = lit.surfaces.points[*pixel].as_ref().map(|point| (*pixel, point));
        together(lit, peeler, point.as_slice())
    };
    let found = some.par_iter().map_init(Peeler::<T>::new, one).collect::<Result<Vec<Tile>, Failure>>()?;
    for (pixel, received, _, work) in found.into_iter().flatten() {
        (all.received[pixel], all.work[pixel]) = (received, Work { overflow: true, ..work });
    }
    Ok(())
}
