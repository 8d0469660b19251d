//! Pictures by search: every pixel with what a neighbour has found, so that most searches begin where they end.

use glam::DVec3;
use rayon::prelude::*;

use super::super::lit::Lit;
use super::super::point::Query;
use super::super::received::Received;
use super::super::sampling::Stream;
use super::point::{Batch, Finder, Found};
use super::{Edge, Options};
use crate::diag::Failure;
use crate::scene::rays::{Rays, SurfacePoint, Tests};
use crate::technique::Progress;

/// The order in which pixels learn from their neighbours. No result depends on how work is spread over threads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Coherence {
    /// In lines of alternating direction, each pixel from the one before it, through bands of [`BAND`] rows.
    Lines,
    /// Every other pixel from its left neighbour, as a GPU does.
    Checkerboard,
    /// Every pixel for itself.
    None,
}

/// Rows of a band, whose first pixel has no neighbour.
const BAND: usize = 16;

/// The results for the pixels of a picture, row by row from the top.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Pixels {
    /// The light that arrives.
    pub(super) received: Vec<Received>,
    /// The mean of the lights' visible fractions; 1 where no light is seen at all.
    pub(super) fraction: Vec<f64>,
    /// The configuration of the first triangle of the first light, by its number in `triangle_configuration`.
    pub(super) configuration: Vec<Option<u32>>,
    /// Tests of visibility.
    pub(super) tests: Vec<u64>,
}

impl Pixels {
    /// Pixels where nothing is seen.
    pub(super) fn new(count: usize) -> Self {
        Self {
            received: vec![Received::default(); count],
            fraction: vec![1.0; count],
            configuration: vec![None; count],
            tests: vec![0; count],
        }
    }
}

/// The search of a picture.
pub(super) struct Picture<'p> {
    pub(super) lit: &'p Lit,
    pub(super) rays: &'p Rays,
    pub(super) options: Options,
    pub(super) seed: u32,
}

/// For each light, the edges that were found at a pixel.
type Known = Vec<Vec<Edge>>;

/// The neighbour that a pixel learns from.
#[derive(Clone, Copy)]
enum Neighbour<'k> {
    None,
    /// The one before it in the order.
    Before,
    /// The one to its left, or, in the first column, to its right.
    Beside(&'k [Option<Known>]),
}

/// The findings at some pixels.
struct Part {
    pixels: Vec<usize>,
    /// For every pixel all lights, one after the other.
    found: Vec<Found>,
    known: Vec<Known>,
}

impl Picture<'_> {
    /// Searches all lights from every pixel.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    pub(super) fn pixels(&self, coherence: Coherence, progress: &Progress<'_>) -> Result<Pixels, Failure> {
        let (width, height) = (self.lit.surfaces.width as usize, self.lit.surfaces.height as usize);
        let mut all = Pixels::new(width * height);
        let rows = |count: usize| (0..height).step_by(count).map(move |row| row..height.min(row + count));
        let line = |row: usize| row * width..(row + 1) * width;
        match coherence {
            Coherence::Lines => {
                let columns = |row: usize| {
                    line(row).map(move |at| if row.is_multiple_of(2) { at } else { 2 * row * width + width - 1 - at })
                };
                let bands = rows(BAND).map(|rows| rows.flat_map(columns).collect()).collect();
                self.search(bands, Neighbour::Before, progress)?.iter().for_each(|part| self.take(&mut all, part));
            }
            Coherence::Checkerboard => {
                let colour = |parity: usize| -> Vec<Vec<usize>> {
                    let own = move |row: usize| move |at: &usize| (at % width + row) % 2 == parity;
                    (0..height).map(|row| line(row).filter(own(row)).collect()).collect()
                };
                let first = self.search(colour(0), Neighbour::None, &|_| {})?;
                let mut known: Vec<Option<Known>> = vec![None; width * height];
                for part in &first {
                    self.take(&mut all, part);
                    part.pixels.iter().zip(&part.known).for_each(|(pixel, edges)| known[*pixel] = Some(edges.clone()));
                }
                let second = self.search(colour(1), Neighbour::Beside(&known), progress)?;
                second.iter().for_each(|part| self.take(&mut all, part));
            }
            Coherence::None => {
                let lines = (0..height).map(|row| line(row).collect()).collect();
                self.search(lines, Neighbour::None, progress)?.iter().for_each(|part| self.take(&mut all, part));
            }
        }
        Ok(all)
    }

    /// Searches some pixels again, each for itself.
    ///
    /// # Errors
    /// Never for the tables that come with Umbrage.
    #[cfg(feature = "gpu")]
    pub(super) fn search_again(&self, some: &[usize], all: &mut Pixels) -> Result<(), Failure> {
        let portions = some.chunks(64).map(<[usize]>::to_vec).collect();
        for part in self.search(portions, Neighbour::None, &|_| {})? {
            part.pixels.iter().for_each(|pixel| all.received[*pixel] = Received::default());
            self.take(all, &part);
        }
        Ok(())
    }

    /// Searches some sequences of pixels.
    fn search(
        &self,
        orders: Vec<Vec<usize>>,
        from: Neighbour<'_>,
        progress: &Progress<'_>,
    ) -> Result<Vec<Part>, Failure> {
        let rows = (self.lit.surfaces.height as usize).div_ceil(orders.len().max(1));
        let one = |finder: &mut Result<Finder<f64>, Failure>, (index, order): (usize, Vec<usize>)| {
            let finder = finder.as_mut().map_err(|failure| failure.clone())?;
            let part = self.part(finder, &order, from)?;
            progress((self.lit.surfaces.height as usize).saturating_sub(index * rows).min(rows) as u64);
            Ok(part)
        };
        let new = || Finder::<f64>::new(self.options);
        orders.into_par_iter().enumerate().map_init(new, one).collect()
    }

    fn part(&self, finder: &mut Finder<f64>, order: &[usize], from: Neighbour<'_>) -> Result<Part, Failure> {
        let width = self.lit.surfaces.width as usize;
        let tests = self.rays.tests(None);
        let mut batch = Batch::default();
        let mut part = Part { pixels: Vec::new(), found: Vec::new(), known: Vec::new() };
        for pixel in order {
            let Some(point) = &self.lit.surfaces.points[*pixel] else { continue };
            let neighbour = match from {
                Neighbour::None => None,
                Neighbour::Before => part.known.last(),
                Neighbour::Beside(known) => {
                    let beside = if pixel.is_multiple_of(width) { pixel + 1 } else { pixel - 1 };
                    known.get(beside).and_then(Option::as_ref)
                }
            };
            let place = [(pixel % width) as u32, (pixel / width) as u32];
            let edges = (0..self.lit.lights.len()).map(|light| {
                let neighbour = neighbour.map(|known| &*known[light]);
                self.light(finder, &mut batch, (light, place), point, neighbour, &tests)
            });
            let edges = edges.collect();
            part.known.push(edges);
            part.pixels.push(*pixel);
        }
        part.found = finder.finish(batch)?;
        Ok(part)
    }

    /// Searches a light from a pixel and returns its edges.
    fn light(
        &self,
        finder: &mut Finder<f64>,
        batch: &mut Batch<f64>,
        (light, pixel): (usize, [u32; 2]),
        point: &SurfacePoint,
        neighbour: Option<&[Edge]>,
        tests: &Tests<'_>,
    ) -> Vec<Edge> {
        let polygon = &self.lit.lights[light];
        let at = (pixel[1] * self.lit.surfaces.width + pixel[0]) as usize;
        let query = Query {
            light: &polygon.corners,
            two_sided: polygon.two_sided,
            point: point.place,
            blur: self.lit.blur,
            normal: point.smooth_normal,
            fraction: true,
            occluders: Vec::new().into(),
            shape: self.lit.sheen(at).map(|sheen| sheen.shape),
        };
        let scene = finder.seen(&query);
        let mut stream = Stream::new(pixel, light as u32, self.seed);
        let mut visibility = |place: DVec3| tests.is_open(point.place, place);
        finder.add(batch, &query, scene.as_ref(), neighbour, (&mut stream, &mut visibility))
    }

    fn take(&self, all: &mut Pixels, part: &Part) {
        let lights = self.lit.lights.len();
        for (pixel, found) in part.pixels.iter().zip(part.found.chunks(lights.max(1))) {
            let seen = found.iter().filter_map(|found| found.answer.fraction);
            let (count, sum) = seen.fold((0, 0.0), |(count, sum), fraction| (count + 1, sum + fraction));
            all.fraction[*pixel] = if count == 0 { 1.0 } else { sum / f64::from(count) };
            all.configuration[*pixel] = found.first().and_then(Found::first_configuration);
            all.tests[*pixel] = found.iter().map(|found| found.tests).sum();
            for (found, light) in found.iter().zip(&self.lit.lights) {
                let (glossy, _) = found.answer.shaped.unwrap_or_default();
                all.received[*pixel] += Received::of(light.colour, [found.answer.form_factor, glossy]);
            }
        }
    }
}
