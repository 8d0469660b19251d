//! The plans in the pass that they are for: whole shaders, on frames of scenes.
//!
//! A table is a small part of a shader that also walks and reads. Whether the
//! plan that was chosen by itself is a good choice there is measured on the real
//! passes of the technique that the table is for.

use super::Measured;
use crate::diag::{Diagnostic, Failure, codes};
use crate::gpu::timing::{Protocol, Times, interleaved};
use crate::program::Program;
use crate::technique::prepared::{Detail, Pass, Watch};
use crate::technique::{self, Ability, Frame, Prepared, Technique};

/// The measurements of a frame, in one kind of pass.
#[derive(Debug, Clone)]
pub struct Whole {
    /// The scene, and its sizes, in words.
    pub frame: String,
    /// The kind of pass.
    pub pass: &'static str,
    /// Times of the whole pass, in the order of the plans.
    pub times: Vec<Times>,
}

impl Whole {
    /// The time with a plan relative to the ladder as written.
    pub fn vs_ladder(&self, plan: usize) -> f64 {
        self.times[plan].median() / self.times[0].median()
    }

    /// Returns whether the time with a plan differs from that with another by more than noise.
    pub fn differs(&self, plan: usize, other: usize) -> bool {
        self.times[plan].differs_from(&self.times[other])
    }

    /// The plans with which the pass is faster than with the chosen one by more than noise.
    pub fn faster_than(&self, chosen: usize) -> Vec<usize> {
        let better =
            |plan: &usize| self.times[*plan].median() < self.times[chosen].median() && self.differs(*plan, chosen);
        (0..self.times.len()).filter(better).collect()
    }
}

/// The technique that a table is for.
///
/// # Errors
/// When no technique has a pass that evaluates the table.
pub fn technique(program: &Program) -> Result<&'static dyn Technique, Failure> {
    let takes_plans = |technique: &&dyn Technique| technique.abilities().contains(&Ability::Plans);
    let tables = |technique: &dyn Technique| technique.tables().iter().map(|table| table.name);
    let mut found = technique::ALL.iter().copied().filter(takes_plans);
    found.find(|technique| tables(*technique).any(|name| name == program.name)).ok_or_else(|| {
        let message = format!("no technique has a pass that evaluates the table `{}`", program.name);
        let error = Diagnostic::error(codes::NOT_APPLICABLE, message);
        let known: Vec<&str> = technique::ALL.iter().copied().filter(takes_plans).flat_map(tables).collect();
        let help = format!("whole shaders are measured of the tables {}", technique::and(&known));
        Failure::new(program.source.clone(), error.help(help))
    })
}

/// Measures the passes of frames with every plan in turn. What is made for a plan is made once for all frames, each of
/// which comes with its name.
///
/// # Errors
/// When the device refuses a shader, or fails.
pub fn whole<'s>(
    technique: &dyn Technique,
    frames: &[(String, Frame<'s>)],
    plans: &'s [Measured<'s>],
    watch: &Watch<'_>,
    protocol: Protocol,
) -> Result<Vec<Whole>, Failure> {
    let mut prepared: Vec<Box<dyn Prepared<'s> + 's>> = Vec::new();
    let mut measured = Vec::new();
    for (name, frame) in frames {
        for (index, plan) in plans.iter().enumerate() {
            let mut frame = frame.clone();
            frame.plans = vec![&plan.proved];
            match prepared.get_mut(index) {
                Some(prepared) => prepared.set_frame(&frame)?,
                None => prepared.push(frame.prepare(technique)?),
            }
        }
        measured.extend(in_frame(name, &mut prepared, watch, protocol)?);
    }
    Ok(measured)
}

/// Measures the passes of a frame that was prepared with every plan.
fn in_frame<'s>(
    name: &str,
    prepared: &mut [Box<dyn Prepared<'s> + 's>],
    watch: &Watch<'_>,
    protocol: Protocol,
) -> Result<Vec<Whole>, Failure> {
    let plans = prepared.len();
    let passes: Result<Vec<Vec<Pass<'_>>>, Failure> =
        prepared.iter_mut().map(|prepared| prepared.passes(Detail::Plain)).collect();
    let passes = passes?;
    // Every plan has the same passes: first all plans in one of them, then all in the next.
    let kinds = passes.first().map_or(0, Vec::len);
    let all: Vec<&Pass<'_>> =
        (0..kinds).flat_map(|kind| passes.iter().filter_map(move |passes| passes.get(kind))).collect();
    let mut times = interleaved(protocol, all.len(), |index| all[index].time(watch))?.into_iter();
    let whole = |kind: &Pass<'_>| Whole {
        frame: name.to_owned(),
        pass: kind.name,
        times: times.by_ref().take(plans).collect(),
    };
    Ok(passes.first().into_iter().flatten().map(whole).collect())
}
