//! What a visibility pass costs: time on the device, and where it goes.
//!
//! All subjects are measured in one run, in turn, on the same frame. Beside the
//! times stand counts that do not depend on the device: reads of the map, and
//! steps of walks, per pixel and per group of 32 neighbouring pixels. A group
//! waits for its slowest pixel, so that the quotient of the two is the price of
//! divergence.

use super::frame::GpuFrame;
use super::shader::{Costs, Shader};
use super::source::{Output, Passes, Skeleton};
use crate::diag::Failure;
use crate::gpu::Gpu;
use crate::gpu::timing::{Clock, Protocol, Stopwatch, Times, interleaved};
use crate::prove::Proved;
use crate::technique::revectorise::{Settings, Technique};

/// Pixels that go together on common GPUs: a block of this size.
const GROUP: [usize; 2] = [8, 4];

/// Something to measure.
#[derive(Debug, Clone, Copy)]
pub struct Subject<'a, 'p> {
    /// Its name in reports.
    pub name: &'static str,
    /// The technique.
    pub technique: Technique,
    /// The plan of its table, if it has one.
    pub proved: Option<&'a Proved<'p>>,
    /// How it reads.
    pub skeleton: Skeleton,
}

/// The techniques with what they are compared with, given plans of both tables: the plain depth test, the
/// authors' case-free shader, and the search of their shader of 2015 in front of the table `rsmss`.
pub fn subjects<'a, 'p>(smsr: &'a Proved<'p>, rsmss: &'a Proved<'p>) -> Vec<Subject<'a, 'p>> {
    let one_pass = Skeleton { passes: Passes::One, ..Skeleton::FAST };
    [
        ("hard", Technique::Hard, None, one_pass),
        ("pcf", Technique::Pcf, None, one_pass),
        ("smsr", Technique::Smsr, Some(smsr), Skeleton::FAST),
        ("rsmss", Technique::Rsmss, Some(rsmss), Skeleton::FAST),
        ("rsmss_one_pass", Technique::Rsmss, Some(rsmss), one_pass),
        ("casefree", Technique::CaseFree, None, Skeleton::PUBLISHED),
        ("rsmss_2015", Technique::Rsmss, Some(rsmss), Skeleton::PUBLISHED),
    ]
    .map(|(name, technique, proved, skeleton)| Subject { name, technique, proved, skeleton })
    .to_vec()
}

/// What was measured of a subject.
#[derive(Debug, Clone)]
pub struct Measured {
    /// The subject's name.
    pub name: &'static str,
    /// Whether it ran as a compute or as a fragment pass.
    pub output: Output,
    /// Times of the whole pass.
    pub times: Times,
    /// Reads of the map and steps of loops.
    pub costs: Summary,
}

/// Mean costs of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Reads of the shadow map per pixel; a gather counts as one.
    pub reads: f64,
    /// Most reads of one pixel.
    pub most_reads: u32,
    /// Steps of loops per pixel.
    pub steps: f64,
    /// Steps of a group's slowest pixel, per group.
    pub group_steps: f64,
    /// The share of pixels that walk.
    pub walking: f64,
}

impl Summary {
    fn new(costs: &Costs, width: usize) -> Self {
        let pixels = costs.reads.len().max(1) as f64;
        let height = costs.reads.len() / width.max(1);
        let mut groups = 0_usize;
        let mut slowest = 0_u64;
        for top in (0..height).step_by(GROUP[1]) {
            for left in (0..width).step_by(GROUP[0]) {
                let rows = top..height.min(top + GROUP[1]);
                let steps = rows.flat_map(|y| &costs.steps[y * width + left..y * width + width.min(left + GROUP[0])]);
                groups += 1;
                slowest += u64::from(steps.copied().max().unwrap_or_default());
            }
        }
        let sum = |counts: &[u32]| counts.iter().map(|count| f64::from(*count)).sum::<f64>();
        Self {
            reads: sum(&costs.reads) / pixels,
            most_reads: costs.reads.iter().copied().max().unwrap_or_default(),
            steps: sum(&costs.steps) / pixels,
            group_steps: slowest as f64 / groups.max(1) as f64,
            walking: costs.steps.iter().filter(|steps| **steps > 0).count() as f64 / pixels,
        }
    }
}

/// Measures subjects on a frame, as compute and as fragment passes, and says what the times were taken with.
///
/// # Errors
/// When the device fails.
pub fn measure(
    gpu: &Gpu,
    subjects: &[Subject<'_, '_>],
    frame: &GpuFrame,
    settings: &Settings,
    protocol: Protocol,
    mut done: impl FnMut(),
) -> Result<(Clock, Vec<Measured>), Failure> {
    let stopwatch = Stopwatch::new(gpu);
    let mut shaders = Vec::new();
    let mut costs = Vec::new();
    for subject in subjects {
        let shader = |output| Shader::new(gpu, subject.technique, subject.proved, subject.skeleton, output);
        let (_, found) = shader(Output::Record)?.record(frame, settings)?;
        costs.push(Summary::new(&found, frame.pixels[0] as usize));
        shaders.push([shader(Output::Compute)?, shader(Output::Fragment)?]);
    }
    let mut bound = Vec::new();
    for shader in shaders.iter().flatten() {
        bound.push(shader.bind(frame, settings)?);
    }
    let times = interleaved(protocol, bound.len(), |index| {
        done();
        bound[index].time(&stopwatch)
    })?;
    let measured = times.into_iter().enumerate().map(|(index, times)| Measured {
        name: subjects[index / 2].name,
        output: [Output::Compute, Output::Fragment][index % 2],
        times,
        costs: costs[index / 2],
    });
    Ok((stopwatch.clock(), measured.collect()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_wait_for_their_slowest_pixel() {
        let mut steps = vec![1; 9 * 5];
        steps[0] = 7;
        let summary = Summary::new(&Costs { reads: vec![2; 9 * 5], steps }, 9);
        assert_eq!((summary.reads, summary.most_reads, summary.walking), (2.0, 2, 1.0));
        assert_eq!(summary.group_steps, (7 + 1 + 1 + 1) as f64 / 4.0);
    }
}
