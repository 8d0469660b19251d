//! Gathers as sums over pixels: samples between pixels are interpolated by hand, and what falls on one pixel is added up.

use std::collections::BTreeMap;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, Mul, Sub};

use super::kernel::Sample;

/// The numbers that light is kept in.
pub trait Real:
    Copy
    + Debug
    + Default
    + PartialEq
    + Send
    + Sync
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + AddAssign
{
    /// The nearest number of this kind.
    fn of(number: f64) -> Self;
    /// The number in double precision.
    fn wide(self) -> f64;
}

impl Real for f32 {
    fn of(number: f64) -> Self {
        number as f32
    }

    fn wide(self) -> f64 {
        f64::from(self)
    }
}

impl Real for f64 {
    fn of(number: f64) -> Self {
        number
    }

    fn wide(self) -> f64 {
        self
    }
}

/// Light beside the picture: a level of the set `border` of `tables/policies.ron`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Border {
    /// As it comes from the light.
    Unoccluded,
    /// That of the nearest pixel.
    Clamp,
}

/// Whole offsets with weights: the offset down, then to the right, then the weight.
#[derive(Debug, Clone, PartialEq)]
pub struct Stencil<T>(Vec<(i64, i64, T)>);

/// Offsets farther than this are beyond every picture.
const FAR: f64 = 1e9;

impl<T: Real> Stencil<T> {
    /// The stencil of samples, linear between pixels.
    pub fn new(samples: &[Sample]) -> Self {
        let mut all: BTreeMap<(i64, i64), f64> = BTreeMap::new();
        for sample in samples {
            let [x, y] = sample.at.map(|at| at.clamp(-FAR, FAR));
            let (left, top) = (x.floor(), y.floor());
            for (dy, v) in [(0, 1.0 - (y - top)), (1, y - top)] {
                for (dx, u) in [(0, 1.0 - (x - left)), (1, x - left)] {
                    let weight = sample.weight * u * v;
                    if weight > 0.0 {
                        *all.entry((top as i64 + dy, left as i64 + dx)).or_default() += weight;
                    }
                }
            }
        }
        Self(all.into_iter().map(|((y, x), weight)| (y, x, T::of(weight))).collect())
    }

    /// Light stays where it is.
    pub fn nothing() -> Self {
        Self(vec![(0, 0, T::of(1.0))])
    }

    /// The offset down, to the right and the weight of each pixel that is read.
    pub fn taps(&self) -> &[(i64, i64, T)] {
        &self.0
    }

    /// The number of pixels that are read.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns whether nothing is read.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Gathers a row of one image: `row` gives the rows of the image, `light` is beside it.
    pub fn gather<'i>(
        &self,
        out: &mut [T],
        y: usize,
        height: usize,
        border: Border,
        light: T,
        row: impl Fn(usize) -> &'i [T],
    ) where
        T: 'i,
    {
        out.fill(T::default());
        let width = out.len() as i64;
        for (dy, dx, weight) in &self.0 {
            let at = y as i64 + dy;
            let inside = (0..height as i64).contains(&at);
            let source = match border {
                Border::Unoccluded if !inside => None,
                Border::Unoccluded | Border::Clamp => Some(row(at.clamp(0, height as i64 - 1) as usize)),
            };
            let Some(source) = source else {
                out.iter_mut().for_each(|sum| *sum += *weight * light);
                continue;
            };
            // Pixels from `lo` to `hi` read the image, those before and after what is beside it.
            let (lo, hi) = ((-dx).clamp(0, width), (width - dx).clamp(0, width));
            let (lo, hi) = (lo.min(hi) as usize, hi.max(lo) as usize);
            let beside = |end: T| if border == Border::Clamp { end } else { light };
            let (first, last) = (beside(source[0]), beside(source[source.len() - 1]));
            if (lo as i64 + dx) < width && hi > lo && *dx > -width && *dx < width {
                let from = (lo as i64 + dx) as usize;
                out[lo..hi].iter_mut().zip(&source[from..]).for_each(|(sum, value)| *sum += *weight * *value);
                out[..lo].iter_mut().for_each(|sum| *sum += *weight * first);
                out[hi..].iter_mut().for_each(|sum| *sum += *weight * last);
            } else {
                let value = if *dx > 0 { last } else { first };
                out.iter_mut().for_each(|sum| *sum += *weight * value);
            }
        }
    }
}

/// A gather of one light: the same in all pixels, by a phase that is drawn for each, or from a picture of another size, as
/// perspective has it.
#[derive(Debug, Clone, PartialEq)]
pub enum Gather<T> {
    /// At the same offsets from every pixel.
    Same(Stencil<T>),
    /// At the offsets of one of these, which the phase of the pixel says.
    Dithered(Vec<Stencil<T>>),
    /// At these offsets from where the pixel was in the picture before: its distance from the middle times a factor.
    Magnified {
        /// The offsets there.
        samples: Vec<Sample>,
        /// The factor, less 1.
        beyond: f64,
    },
}

/// The rows of an image, and what is beside it.
#[derive(Debug, Clone, Copy)]
pub struct Around<T> {
    /// The number of rows.
    pub height: usize,
    /// The values that are read beside the image.
    pub border: Border,
    /// Light that nothing has hindered.
    pub light: T,
}

impl<T: Real> Gather<T> {
    /// Gathers a row of one image: `row` gives the rows of the image, `phases` are those of the row's pixels.
    pub fn gather<'i>(&self, out: &mut [T], y: usize, around: Around<T>, phases: &[u8], row: impl Fn(usize) -> &'i [T])
    where
        T: 'i,
    {
        let Around { height, border, light } = around;
        let width = out.len();
        let read = |x: i64, y: i64| {
            let inside = (0..width as i64).contains(&x) && (0..height as i64).contains(&y);
            match border {
                Border::Unoccluded if !inside => light,
                Border::Unoccluded | Border::Clamp => {
                    row(y.clamp(0, height as i64 - 1) as usize)[x.clamp(0, width as i64 - 1) as usize]
                }
            }
        };
        match self {
            Gather::Same(stencil) => stencil.gather(out, y, height, border, light, row),
            Gather::Dithered(stencils) => {
                for (x, (sum, phase)) in out.iter_mut().zip(phases).enumerate() {
                    *sum = T::default();
                    for (dy, dx, weight) in &stencils[usize::from(*phase)].0 {
                        *sum += *weight * read(x as i64 + dx, y as i64 + dy);
                    }
                }
            }
            Gather::Magnified { samples, beyond, .. } => {
                let beyond = T::of(*beyond);
                let moved = |pixel: usize, pixels: usize| T::of(pixel as f64 + 0.5 - 0.5 * pixels as f64) * beyond;
                let down = moved(y, height);
                for (x, sum) in out.iter_mut().enumerate() {
                    *sum = T::default();
                    let right = moved(x, width);
                    for Sample { at, weight } in samples {
                        let ([left, u], [top, v]) = (split(right + T::of(at[0])), split(down + T::of(at[1])));
                        for (dy, v) in [(0, T::of(1.0) - v), (1, v)] {
                            for (dx, u) in [(0, T::of(1.0) - u), (1, u)] {
                                let weight = T::of(*weight) * (u * v);
                                let at = (x as i64 + left.wide() as i64 + dx, y as i64 + top.wide() as i64 + dy);
                                *sum += weight * read(at.0, at.1);
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A distance as whole pixels and a part.
fn split<T: Real>(distance: T) -> [T; 2] {
    let near = T::of(distance.wide().clamp(-FAR, FAR));
    let whole = T::of(near.wide().floor());
    [whole, near - whole]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_between_and_beside() {
        let image = [1.0, 2.0, 4.0, 8.0];
        let gather = |x: f64, border: Border| {
            let stencil = Stencil::<f64>::new(&[Sample { at: [x, 0.0], weight: 1.0 }]);
            let mut out = [0.0; 4];
            stencil.gather(&mut out, 0, 1, border, 16.0, |_| &image);
            out
        };
        assert_eq!(gather(0.0, Border::Unoccluded), image);
        assert_eq!(gather(0.5, Border::Unoccluded), [1.5, 3.0, 6.0, 12.0]);
        assert_eq!(gather(-1.0, Border::Unoccluded), [16.0, 1.0, 2.0, 4.0]);
        assert_eq!(gather(-1.0, Border::Clamp), [1.0, 1.0, 2.0, 4.0]);
        assert_eq!(gather(2.0, Border::Clamp), [4.0, 8.0, 8.0, 8.0]);
        for far in [4.0, 5.0, -4.0, 1e30] {
            assert_eq!(gather(far, Border::Unoccluded), [16.0; 4], "{far}");
        }
        assert_eq!(gather(-1e30, Border::Clamp), [1.0; 4]);
        assert_eq!(Stencil::<f64>::new(&[Sample { at: [0.25, 0.5], weight: 1.0 }]).len(), 4);
    }
}
