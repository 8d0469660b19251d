//! Techniques that are ready to render.

#[cfg(feature = "gpu")]
use std::time::{Duration, Instant};

#[cfg(feature = "gpu")]
use super::Executor;
use super::{Frame, Rendered, Technique};
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Columns;
#[cfg(feature = "gpu")]
use crate::gpu::timing::{Clock, Stopwatch};
use crate::program::Program;

/// Is told of every row of pixels that is finished; a frame has as many as its picture has rows.
pub type Progress<'a> = dyn Fn(u64) + Sync + 'a;

/// A technique with everything planned, proved and compiled that its frame needs.
///
/// It may keep state from one call to the next.
pub trait Prepared<'s> {
    /// Renders the frame.
    ///
    /// # Errors
    /// When the device fails.
    fn render(&mut self, progress: &Progress<'_>) -> Result<Rendered, Failure>;

    /// Goes on to another frame, with what was compiled already where that fits.
    ///
    /// # Errors
    /// As [`Technique::prepare`].
    fn set_frame(&mut self, frame: &Frame<'s>) -> Result<(), Failure>;

    /// The table that the layers of cases and states refer to.
    fn table(&self) -> Option<&'s Program> {
        None
    }

    /// The inputs at which the frame's tables are evaluated.
    ///
    /// # Errors
    /// When there are none, or they cannot be found.
    fn inputs(&mut self) -> Result<Vec<Inputs<'s>>, Failure> {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, "the technique has no inputs that can be captured");
        Err(Failure::bare("", error))
    }

    /// The numbers of pixels by state of the table, from counters of the device; `None` where it has none.
    ///
    /// # Errors
    /// When the device fails.
    fn counts(&mut self) -> Result<Option<Vec<u64>>, Failure> {
        Ok(None)
    }

    /// The passes that render the frame, or its stages on the CPU, each to be measured by itself.
    ///
    /// # Errors
    /// When the device refuses a shader, or fails.
    #[cfg(feature = "gpu")]
    fn passes(&mut self, detail: Detail) -> Result<Vec<Pass<'_>>, Failure> {
        let _ = detail;
        Ok(Vec::new())
    }
}

impl<'s> Frame<'s> {
    /// Prepares a technique, if it takes a light of the scene.
    ///
    /// # Errors
    /// When it takes none, when the frame is beyond the device's limits, or the device fails.
    pub fn prepare(&self, technique: &dyn Technique) -> Result<Box<dyn Prepared<'s> + 's>, Failure> {
        technique.lights().of_scene(self.scene, technique.name())?;
        technique.prepare(self)
    }
}

/// The inputs of every evaluation of a table in a frame.
#[derive(Debug)]
pub struct Inputs<'p> {
    /// The table.
    pub program: &'p Program,
    /// One row per evaluation, in the order of the pixels; fetched inputs where they were needed.
    pub columns: Columns<f32>,
    /// The pixel of each row, counted row by row from the top left.
    pub pixels: Vec<u32>,
}

/// The passes that are asked for.
#[cfg(feature = "gpu")]
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// The technique as it is used.
    Plain,
    /// The technique, other ways to compute the same, and counts of what each costs.
    Variants,
}

/// The instrument that passes are measured with.
#[cfg(feature = "gpu")]
#[derive(Debug)]
pub enum Watch<'g> {
    /// The stopwatch of a device.
    Device(Stopwatch<'g>),
    /// The computer's clock, for stages on the CPU.
    Cpu,
}

#[cfg(feature = "gpu")]
impl<'g> Watch<'g> {
    /// The watch for a machine.
    pub fn new(on: &'g Executor) -> Self {
        match on {
            Executor::Cpu => Watch::Cpu,
            Executor::Gpu(gpu) => Watch::Device(Stopwatch::new(gpu)),
        }
    }

    /// The clock that times are taken with.
    pub fn clock(&self) -> Clock {
        match self {
            Watch::Device(stopwatch) => stopwatch.clock(),
            Watch::Cpu => Clock::Wall,
        }
    }
}

/// A run on a device, which measures it.
#[cfg(feature = "gpu")]
type OnDevice<'p> = dyn Fn(&Stopwatch<'_>) -> Result<Duration, Failure> + 'p;

/// A run on the CPU.
#[cfg(feature = "gpu")]
type OnCpu<'p> = dyn Fn() -> Result<(), Failure> + 'p;

/// A run of a pass.
#[cfg(feature = "gpu")]
enum Run<'p> {
    Device(Box<OnDevice<'p>>),
    Cpu(Box<OnCpu<'p>>),
}

/// A pass on a device, or a stage on the CPU, that can be run again and again.
#[cfg(feature = "gpu")]
pub struct Pass<'p> {
    /// The technique, or the variant of it.
    pub variant: &'static str,
    /// The name of the pass.
    pub name: &'static str,
    /// The costs of the pass, by counts that do not depend on the device; where they were asked for.
    pub costs: Option<Costs>,
    run: Run<'p>,
}

#[cfg(feature = "gpu")]
impl<'p> Pass<'p> {
    /// A pass on a device that `run` runs and measures.
    pub fn new(
        variant: &'static str,
        name: &'static str,
        costs: Option<Costs>,
        run: impl Fn(&Stopwatch<'_>) -> Result<Duration, Failure> + 'p,
    ) -> Self {
        Self { variant, name, costs, run: Run::Device(Box::new(run)) }
    }

    /// A stage on the CPU that `run` runs.
    pub fn on_cpu(variant: &'static str, name: &'static str, run: impl Fn() -> Result<(), Failure> + 'p) -> Self {
        Self { variant, name, costs: None, run: Run::Cpu(Box::new(run)) }
    }

    /// Runs the pass and measures it.
    ///
    /// # Errors
    /// When the device fails, or the watch is not that of the machine that the pass was made for.
    pub fn time(&self, watch: &Watch<'_>) -> Result<Duration, Failure> {
        match (&self.run, watch) {
            (Run::Device(run), Watch::Device(stopwatch)) => run(stopwatch),
            (Run::Cpu(run), Watch::Device(_) | Watch::Cpu) => {
                let start = Instant::now();
                run()?;
                Ok(start.elapsed())
            }
            (Run::Device(_), Watch::Cpu) => {
                let message = format!("the pass `{}` runs on a device and is measured by it", self.name);
                Err(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message)))
            }
        }
    }
}

#[cfg(feature = "gpu")]
impl std::fmt::Debug for Pass<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} {}", self.variant, self.name)
    }
}

/// Mean costs of a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Costs {
    /// Reads of a shadow map per pixel; a gather counts as one.
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

/// Pixels that go together on common GPUs: a block of this size. A group waits for its slowest pixel, so that steps
/// per group over steps per pixel is the price of divergence.
const GROUP: [usize; 2] = [8, 4];

impl Costs {
    /// The means over a picture of some width.
    pub fn new(reads: &[u32], steps: &[u32], width: usize) -> Self {
        let pixels = reads.len().max(1) as f64;
        let height = steps.len() / width.max(1);
        let mut groups = 0_usize;
        let mut slowest = 0_u64;
        for top in (0..height).step_by(GROUP[1]) {
            for left in (0..width).step_by(GROUP[0]) {
                let rows = top..height.min(top + GROUP[1]);
                let steps = rows.flat_map(|y| &steps[y * width + left..y * width + width.min(left + GROUP[0])]);
                groups += 1;
                slowest += u64::from(steps.copied().max().unwrap_or_default());
            }
        }
        let sum = |counts: &[u32]| counts.iter().map(|count| f64::from(*count)).sum::<f64>();
        Self {
            reads: sum(reads) / pixels,
            most_reads: reads.iter().copied().max().unwrap_or_default(),
            steps: sum(steps) / pixels,
            group_steps: slowest as f64 / groups.max(1) as f64,
            walking: steps.iter().filter(|steps| **steps > 0).count() as f64 / pixels,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_wait_for_their_slowest_pixel() {
        let mut steps = vec![1; 9 * 5];
        steps[0] = 7;
        let costs = Costs::new(&[2; 9 * 5], &steps, 9);
        assert_eq!((costs.reads, costs.most_reads, costs.walking), (2.0, 2, 1.0));
        assert_eq!(costs.group_steps, (7 + 1 + 1 + 1) as f64 / 4.0);
    }
}
