//! Blurs: unit kernels of `tables/kernels.ron`, stretched for a light, as lists of whole pixels and weights.

use super::functions::Function;
use crate::diag::{Diagnostic, Failure, codes};
use crate::technique::tables::{ELLIPSE, KERNELS};

/// A kernel: the level of the set `family` of `tables/kernels.ron`, and how many samples it has where that is open.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kernel {
    /// The family's name.
    pub family: &'static str,
    /// The samples of a ring.
    pub samples: u32,
}

/// The blur of a light: its mean, and an ellipse, in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Blur {
    /// The mean offset.
    pub mean: [f64; 2],
    /// Variances along the axes of the light.
    pub variances: [f64; 2],
    /// Cosine and sine of the angle from x to the first axis.
    pub axis: [f64; 2],
}

/// A sample: where it is, relative to the receiver, and its weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Pixels to the right, and down.
    pub at: [f64; 2],
    /// Its weight; all of a kernel add up to 1.
    pub weight: f64,
}

impl Blur {
    /// An offset from the mean, given along the axes of the light.
    fn place(&self, along: [f64; 2]) -> [f64; 2] {
        let [c, s] = self.axis;
        [self.mean[0] + c * along[0] - s * along[1], self.mean[1] + s * along[0] + c * along[1]]
    }

    /// Returns whether it is no blur at all.
    pub fn is_sharp(&self) -> bool {
        self.variances == [0.0; 2]
    }
}

impl Kernel {
    /// The samples of a blur at a phase, which is a share of the kernel's period.
    ///
    /// # Errors
    /// When a kernel of whole pixels is asked for a blur that it is not made for.
    pub fn samples(&self, blur: &Blur, phase: f64) -> Result<Vec<Sample>, Failure> {
        if blur.is_sharp() && !self.is_whole() {
            return Ok(vec![Sample { at: blur.mean, weight: 1.0 }]);
        }
        let deviations = blur.variances.map(f64::sqrt);
        let stretched = |[x, y]: [f64; 2]| blur.place([x * deviations[0], y * deviations[1]]);
        let mut all = Vec::new();
        match self.family {
            "ring_affine" | "ring_arc" => {
                let arc = self.family == "ring_arc";
                let function = Function::of(&KERNELS, self.family)?;
                let axes = Function::of(&ELLIPSE, "axes")?;
                let [x, y] = blur.variances;
                let [a, b] = axes.call(&[("var_x", x.into()), ("var_y", y.into())])?.numbers(["a", "b"])?;
                for k in 0..self.samples {
                    let mut given = vec![
                        ("N", f64::from(self.samples).into()),
                        ("k", f64::from(k).into()),
                        ("phase", phase.into()),
                    ];
                    if arc {
                        given.extend([("a", a.into()), ("b", b.into())]);
                    }
                    let [x, y, weight] = function.call(&given)?.numbers(["x", "y", "w"])?;
                    all.push(Sample { at: if arc { blur.place([x, y]) } else { stretched([x, y]) }, weight });
                }
            }
            "poisson8" | "poisson16" => {
                let function = Function::of(&KERNELS, self.family)?;
                let (which, count) = if self.family == "poisson8" { ("which", 8) } else { ("which_16", 16) };
                for k in 0..count {
                    let answer = function.call(&[(which, f64::from(k).into()), ("phase", phase.into())])?;
                    let [x, y, weight] = answer.numbers(["x", "y", "w"])?;
                    all.push(Sample { at: stretched([x, y]), weight });
                }
            }
            "gauss19x19" => {
                let function = Function::of(&KERNELS, "gauss19")?;
                let line = (0..19).map(|k| function.call(&[("which_19", f64::from(k).into())])?.numbers(["x", "w"]));
                let line = line.collect::<Result<Vec<_>, _>>()?;
                let pair = |[x, u]: [f64; 2], [y, v]: [f64; 2]| Sample { at: stretched([x, y]), weight: u * v };
                all.extend(line.iter().flat_map(|a| line.iter().map(move |b| pair(*a, *b))));
            }
            "frac_box" | "binomial3" => {
                let lines = [self.line(blur, 0)?, self.line(blur, 1)?];
                let mean = blur.mean.map(|mean| (mean + 0.5).floor());
                let pair =
                    |[x, u]: [f64; 2], [y, v]: [f64; 2]| Sample { at: [mean[0] + x, mean[1] + y], weight: u * v };
                all.extend(lines[0].iter().flat_map(|a| lines[1].iter().map(move |b| pair(*a, *b))));
            }
            other => return Err(wrong(format!("there is no kernel `{other}`"))),
        }
        Ok(all)
    }

    /// Returns whether its samples can move along a curve.
    pub fn has_phase(&self) -> bool {
        matches!(self.family, "ring_affine" | "ring_arc" | "poisson8" | "poisson16")
    }

    /// Returns whether its samples lie on pixels, so that nothing is interpolated.
    pub fn is_whole(&self) -> bool {
        matches!(self.family, "frac_box" | "binomial3")
    }

    /// The whole offsets along one axis of the picture, with their weights.
    fn line(&self, blur: &Blur, axis: usize) -> Result<Vec<[f64; 2]>, Failure> {
        let function = Function::of(&KERNELS, self.family)?;
        let [c, s] = blur.axis;
        let turned = [[c * c, s * s], [s * s, c * c]][axis];
        let variance = turned[0] * blur.variances[0] + turned[1] * blur.variances[1];
        if variance > 300.0 {
            let message = format!("`{}` is made for variances up to 300 square pixels, not {variance}", self.family);
            return Err(wrong(message));
        }
        let mut all = Vec::new();
        for tap in -31..=31 {
            let tap = f64::from(tap);
            let mut given = vec![("tap", tap.into())];
            if self.family == "frac_box" {
                given.push(("variance", variance.into()));
            }
            let weight = function.call(&given)?.number("value")?;
            if weight > 0.0 {
                all.push([tap, weight]);
            }
        }
        Ok(all)
    }
}

fn wrong(message: String) -> Failure {
    let error = Diagnostic::error(codes::RENDER, message);
    Failure::bare("", error.help("choose another kernel, or thinner slabs: `--set slabs=...`"))
}
