//! The tuner: every plan of a table, checked, measured on this device, ranked.
//!
//! Plans are made for a profile and proved; what the device makes of them is
//! compared with the interpreter, since a proof says nothing about drivers;
//! then all of them and the floor are measured in turn, over inputs of three
//! kinds. What is chosen is the fastest plan on captured inputs, and among
//! those that cannot be told from it the simplest, so that noise alone never
//! makes a choice.

mod graph;
mod inputs;
mod page;
pub mod whole;

use std::time::Duration;

use crate::diag::{Diagnostic, Failure, codes};
use crate::diff;
use crate::eval::Columns;
use crate::gpu::Gpu;
use crate::gpu::bench::{Timed, Workload};
use crate::gpu::timing::{Clock, Protocol, Stopwatch, Times, interleaved};
use crate::plan::{Plan, PlanOptions, Shape, Weights};
use crate::profile::Fitted;
use crate::program::Program;
use crate::prove::Proved;
use crate::tuned::{Choice, Evidence};

pub use inputs::Kind;
pub use page::page;

/// Rows that results are compared at, at most.
const CHECKED: usize = 1 << 16;

/// The extent of a tuning.
#[derive(Debug, Clone)]
pub struct Options {
    /// The plans to try.
    pub shapes: Vec<Shape>,
    /// True if plans that rely on the table's assumptions are tried, too.
    pub assume: bool,
    /// Rows of inputs of each kind.
    pub rows: usize,
    /// Rows that a thread evaluates; of the first it reads all inputs, of the others the key. 1 is a pass over
    /// memory, more show what plans cost where the inputs are at hand.
    pub rows_of_thread: u32,
    /// Repetitions of all of it in one measurement.
    pub repeats: u32,
    /// The number of measurements.
    pub protocol: Protocol,
    /// True if to use the wall clock even if the device has timestamps.
    pub wall_clock: bool,
    /// Longest time for all measurements. If a first one says that they would take longer, there are fewer rounds.
    pub time: Duration,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            shapes: Shape::ALL.to_vec(),
            assume: false,
            rows: 1 << 17,
            rows_of_thread: 8,
            repeats: 1,
            protocol: Protocol { warm_up: 3, rounds: 15 },
            wall_clock: false,
            time: Duration::from_secs(300),
        }
    }
}

/// A way to make a plan.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Candidate {
    /// The code shape.
    pub shape: Shape,
    /// True if the profile is used.
    pub weighted: bool,
    /// True if the table's assumptions are used.
    pub assume: bool,
}

impl Candidate {
    /// The ladder as written: what everything is compared with.
    pub const WRITTEN: Self = Self { shape: Shape::Ladder, weighted: false, assume: false };

    /// The way to make a plan of a shape, for the profile unless it is the ladder, which no profile changes.
    pub fn of(shape: Shape, assume: bool) -> Self {
        Self { shape, weighted: assume || shape != Shape::Ladder, assume }
    }

    /// The name in reports.
    pub fn name(self) -> String {
        let shape = self.shape.name();
        if self.assume { format!("{shape}+assume") } else { shape.to_owned() }
    }

    /// The options that make the plan.
    pub fn options(self, weights: &Weights) -> PlanOptions<'_> {
        PlanOptions { shape: self.shape, weights: self.weighted.then_some(weights), assume: self.assume }
    }

    /// The ladder as written, then every shape for the profile, the simplest first.
    fn all(options: &Options) -> Vec<Self> {
        let mut all = vec![Self::WRITTEN];
        for assume in [false, true] {
            if assume && !options.assume {
                break;
            }
            // The ladder as written is there already, and no profile changes it.
            let others = options.shapes.iter().filter(|shape| **shape != Shape::Ladder);
            all.extend(others.map(|shape| Self::of(*shape, assume)));
        }
        all
    }
}

/// A plan that was measured.
#[derive(Debug)]
pub struct Measured<'p> {
    /// The way it was made.
    pub candidate: Candidate,
    /// The plan, proved.
    pub proved: Proved<'p>,
    /// The comparison of its results with the interpreter's, at captured inputs.
    pub check: diff::Run,
    /// Times by kind of input, in the order of [`Kind::ALL`].
    pub times: Vec<Times>,
}

/// The result of a tuning.
#[derive(Debug)]
pub struct Tuning<'p> {
    /// The device, in words.
    pub device: String,
    /// The clock that times were taken with.
    pub clock: Clock,
    /// The extent of the tuning.
    pub options: Options,
    /// True if captured inputs were given; otherwise they were drawn as the profile says.
    pub frames: bool,
    /// The origin of the weights.
    pub profile: Fitted,
    /// Times of reading and writing the data, by kind of input.
    pub floor: Vec<Times>,
    /// The plans, the ladder as written first.
    pub plans: Vec<Measured<'p>>,
    /// Plans that were left out, with the reason.
    pub skipped: Vec<(Candidate, String)>,
    /// Plans whose results on this device are wrong, with an example.
    pub wrong: Vec<(Candidate, String)>,
    /// The chosen plan, as an index into `plans`.
    pub chosen: usize,
    /// The plans in whole shaders, if that was measured.
    pub whole: Vec<whole::Whole>,
    /// The changes to what was asked for, which would have taken too long.
    pub shortened: Vec<String>,
}

/// Says whether a device compiles a plan, with so many rows for each thread, in reasonable time; else the reason.
pub type Compiles<'c> = dyn FnMut(Candidate, u32) -> Result<(), String> + 'c;

/// Fewest rounds that say anything about noise.
const LEAST_ROUNDS: usize = 3;

/// Compiles a plan and runs it once, as tuning does: on a device that takes forever, this does.
///
/// # Errors
/// When the plan does not suit the table, or the device fails.
pub fn compile(
    program: &Program,
    profile: &Fitted,
    weights: &Weights,
    candidate: Candidate,
    gpu: &Gpu,
    rows_of_thread: u32,
) -> Result<(), Failure> {
    let proved = Plan::new(program, candidate.options(weights))?.prove()?;
    let columns = inputs::Source::new(program).rows(Kind::Random, rows_of_thread as usize, None, &profile.profile);
    diff::at(program, std::slice::from_ref(&proved), gpu, &columns)?;
    let timed = Timed::plan(gpu, &proved, rows_of_thread)?;
    timed.time(gpu, &Stopwatch::wall(gpu), &Workload::new(gpu, program, &columns)?, 1).map(drop)
}

/// The plans of a table that a device compiles in reasonable time; and those that it does not, with the reason.
fn compiled<'p>(
    program: &Program,
    (proved, mut skipped): Plans<'p>,
    options: &mut Options,
    shortened: &mut Vec<String>,
    compiles: &mut Compiles<'_>,
    progress: &mut impl FnMut(&str),
) -> Result<Plans<'p>, Failure> {
    let mut kept = Vec::new();
    for (candidate, proved) in proved {
        progress(&format!("compiling {}", candidate.name()));
        let mut found = compiles(candidate, options.rows_of_thread);
        // A loop is what some drivers cannot cope with; then no plan gets one.
        if candidate == Candidate::WRITTEN && options.rows_of_thread > 1 && found.is_err() {
            let rows = options.rows_of_thread;
            found = compiles(candidate, 1);
            if found.is_ok() {
                shortened.push(format!(
                    "threads evaluate one row instead of {rows}, since the device takes too long to compile a loop"
                ));
                options.rows_of_thread = 1;
            }
        }
        match found {
            Ok(()) => kept.push((candidate, proved)),
            Err(reason) if candidate == Candidate::WRITTEN => {
                let message = format!("the ladder itself cannot be measured: {reason}");
                let error = Diagnostic::error(codes::DEVICE, message);
                let error = error.help("everything is compared with it; allow more time: `--compile-limit`");
                return Err(Failure::new(program.source.clone(), error));
            }
            Err(reason) => skipped.push((candidate, reason)),
        }
    }
    Ok((kept, skipped))
}

/// Tunes a table for a device. `compiles` is asked for each plan, `progress` is told what is being done.
///
/// # Errors
/// When a plan cannot be proved, a captured row lacks an input, or the device fails.
#[allow(clippy::too_many_arguments)]
pub fn tune<'p>(
    program: &'p Program,
    profile: Fitted,
    weights: &Weights,
    frames: Option<&Columns<f32>>,
    gpu: &Gpu,
    options: &Options,
    compiles: &mut Compiles<'_>,
    mut progress: impl FnMut(&str),
) -> Result<Tuning<'p>, Failure> {
    let frames = frames.filter(|frames| !frames.is_empty());
    let mut source = inputs::Source::new(program);
    let (mut options, mut shortened) = (options.clone(), Vec::new());
    let all = plans(program, weights, &options, &mut progress)?;
    let (mut proved, mut skipped) = compiled(program, all, &mut options, &mut shortened, compiles, &mut progress)?;

    let captured = source.rows(Kind::Captured, options.rows, frames, &profile.profile);
    let rows: Vec<usize> = (0..captured.len().min(CHECKED)).collect();
    progress("comparing results with the interpreter");
    let all: Vec<Proved<'p>> = proved.iter().map(|(_, proved)| proved.clone()).collect();
    let checks = diff::at(program, &all, gpu, &captured.select(&rows))?;
    let mut wrong = Vec::new();
    let mut plans = Vec::new();
    for ((candidate, proved), check) in proved.drain(..).zip(checks) {
        match check.offenders.first() {
            Some(offender) => wrong.push((candidate, format!("{} at {}", offender.reason, offender.inputs))),
            None => plans.push(Measured { candidate, proved, check, times: Vec::new() }),
        }
    }
    if plans.first().is_none_or(|plan| plan.candidate != Candidate::WRITTEN) {
        let reason = wrong.first().map_or("", |(_, reason)| reason.as_str());
        let message = format!("the ladder itself is wrong on this device: {reason}");
        return Err(Failure::new(
            program.source.clone(),
            Diagnostic::error(codes::DEVICE, message).help("nothing can be compared with it; update the driver"),
        ));
    }

    progress("compiling");
    let watch = if options.wall_clock { Stopwatch::wall(gpu) } else { Stopwatch::new(gpu) };
    let mut subjects = vec![Timed::floor(gpu, program, options.rows_of_thread)?];
    for plan in &plans {
        subjects.push(Timed::plan(gpu, &plan.proved, options.rows_of_thread)?);
    }
    progress("measuring for the first time");
    let load = Workload::new(gpu, program, &captured)?;
    let mut first = Vec::new();
    for subject in &subjects {
        // Drivers compile when a pass is first run.
        subject.time(gpu, &watch, &load, 1)?;
        first.push(subject.time(gpu, &watch, &load, options.repeats)? * options.repeats);
    }
    // Warm-up rounds are of a quarter of the rows.
    let passes = |rounds: usize| (Kind::ALL.len() * (rounds + 1 + options.protocol.warm_up.div_ceil(4))) as u32;
    let share = options.time / passes(LEAST_ROUNDS) / 4;
    let slow: Vec<usize> = (1..plans.len()).rev().filter(|index| first[index + 1] > share).collect();
    for index in slow {
        let reason = format!("a measurement takes {:.1} s", first[index + 1].as_secs_f64());
        skipped.push((plans.remove(index).candidate, reason));
        subjects.remove(index + 1);
        first.remove(index + 1);
    }
    let round: Duration = first.iter().sum();
    let (asked, most) = (options.protocol.rounds, options.time.as_secs_f64() / round.as_secs_f64().max(1e-9));
    let fitting = (most as usize / Kind::ALL.len()).saturating_sub(passes(0) as usize / Kind::ALL.len());
    if fitting < asked {
        options.protocol.rounds = fitting.clamp(LEAST_ROUNDS.min(asked), asked);
        let (rounds, seconds) = (options.protocol.rounds, round.as_secs_f64());
        shortened.push(format!(
            "{rounds} rounds instead of {asked}, since one takes {seconds:.1} s for each kind of inputs"
        ));
    }
    drop(load);
    let mut floor = Vec::new();
    for kind in Kind::ALL {
        progress(&format!("measuring {kind} inputs"));
        let columns = match kind {
            Kind::Captured => captured.clone(),
            _ => source.rows(kind, options.rows, frames, &profile.profile),
        };
        // Clocks rise and code is compiled on other rows than those that count, so that no cache is prepared.
        for _ in 0..options.protocol.warm_up {
            let some = source.subset(&columns, (options.rows / 4).max(1));
            let load = Workload::new(gpu, program, &some)?;
            for subject in &subjects {
                subject.time(gpu, &watch, &load, options.repeats)?;
            }
        }
        let load = Workload::new(gpu, program, &columns)?;
        let protocol = Protocol { warm_up: 1, ..options.protocol };
        let times =
            interleaved(protocol, subjects.len(), |index| subjects[index].time(gpu, &watch, &load, options.repeats))?;
        let mut times = times.into_iter();
        floor.extend(times.next());
        for (plan, times) in plans.iter_mut().zip(times) {
            plan.times.push(times);
        }
    }
    let chosen = choose(&plans);
    Ok(Tuning {
        device: gpu.describe(),
        clock: watch.clock(),
        options,
        frames: frames.is_some(),
        profile,
        floor,
        plans,
        skipped,
        wrong,
        chosen,
        whole: Vec::new(),
        shortened,
    })
}

type Plans<'p> = (Vec<(Candidate, Proved<'p>)>, Vec<(Candidate, String)>);

/// Every plan that suits the table, proved; and those that do not, with the reason.
fn plans<'p>(
    program: &'p Program,
    weights: &Weights,
    options: &Options,
    progress: &mut impl FnMut(&str),
) -> Result<Plans<'p>, Failure> {
    let (mut proved, mut skipped): Plans<'p> = (Vec::new(), Vec::new());
    for candidate in Candidate::all(options) {
        progress(&format!("planning {}", candidate.name()));
        match Plan::proved(program, candidate.options(weights)) {
            Ok(plan) => proved.push((candidate, plan)),
            Err(failure) => {
                let notes = failure.diagnostics.into_iter().flat_map(|d| d.notes).collect::<Vec<_>>();
                skipped.push((candidate, notes.join("; ")));
            }
        }
    }
    Ok((proved, skipped))
}

/// The simplest of the plans that cannot be told from the fastest on captured inputs.
fn choose(plans: &[Measured<'_>]) -> usize {
    let captured = |plan: &Measured<'_>| plan.times.first().cloned().unwrap_or_else(|| Times::new([]));
    let median = |index: &usize| captured(&plans[*index]).median();
    let Some(fastest) = (0..plans.len()).min_by(|a, b| median(a).total_cmp(&median(b))) else { return 0 };
    let best = captured(&plans[fastest]);
    (0..plans.len()).find(|index| !captured(&plans[*index]).differs_from(&best)).unwrap_or(fastest)
}

/// A measurement in the terms of reports.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// The plan, as an index into [`Tuning::plans`].
    pub plan: usize,
    /// The kind of input.
    pub input: Kind,
    /// Median time of one evaluation of all rows, in microseconds.
    pub us: f64,
    /// The uncertainty of that, in microseconds.
    pub uncertainty: f64,
    /// The same relative to the ladder as written.
    pub vs_ladder: f64,
    /// The same relative to reading and writing the data.
    pub vs_floor: f64,
    /// True if it differs from the ladder as written by more than noise.
    pub differs: bool,
}

impl Tuning<'_> {
    /// The measurements of a kind of input, the fastest first.
    pub fn ranking(&self, kind: Kind) -> Vec<Line> {
        let Some(place) = Kind::ALL.iter().position(|k| *k == kind) else { return Vec::new() };
        let (floor, ladder) = (&self.floor[place], &self.plans[0].times[place]);
        let line = |(plan, measured): (usize, &Measured<'_>)| {
            let times = &measured.times[place];
            Line {
                plan,
                input: kind,
                us: 1e6 * times.median(),
                uncertainty: 1e6 * times.uncertainty(),
                vs_ladder: times.median() / ladder.median(),
                vs_floor: times.median() / floor.median(),
                differs: times.differs_from(ladder),
            }
        };
        let mut lines: Vec<Line> = self.plans.iter().enumerate().map(line).collect();
        lines.sort_by(|a, b| a.us.total_cmp(&b.us));
        lines
    }

    /// Returns whether the chosen plan differs from the ladder as written by more than noise, on captured inputs.
    pub fn is_clear(&self) -> bool {
        self.chosen == 0 || self.plans[self.chosen].times[0].differs_from(&self.plans[0].times[0])
    }

    /// The choice, with the evidence, to be kept.
    pub fn choice(&self, program: &Program, weights: &Weights) -> Choice {
        let round = |number: f64| (number * 1000.0).round() / 1000.0;
        let evidence = Kind::ALL.into_iter().flat_map(|kind| self.ranking(kind)).map(|line| Evidence {
            plan: self.plans[line.plan].candidate.name(),
            input: line.input.name().to_owned(),
            us: round(line.us),
            vs_ladder: round(line.vs_ladder),
            vs_floor: round(line.vs_floor),
        });
        let candidate = self.plans[self.chosen].candidate;
        Choice {
            table: program.name.clone(),
            fingerprint: program.fingerprint(),
            plan: candidate.name(),
            assume: candidate.assume,
            profile: weights.origin().to_owned(),
            umbrage: env!("CARGO_PKG_VERSION").to_owned(),
            method: self.method(),
            evidence: evidence.collect(),
        }
    }

    /// The method of measurement, in words.
    pub fn method(&self) -> String {
        let captured = if self.frames { "captured frames" } else { "states drawn as the profile says" };
        format!(
            "{}, {} rows, {} per thread, medians of {} interleaved measurements; captured: {captured}",
            self.clock, self.options.rows, self.options.rows_of_thread, self.options.protocol.rounds
        )
    }
}
