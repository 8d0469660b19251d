//! The techniques in plain Rust: shadow map and receivers → visibility.
//!
//! The reference that every other executor is compared with. Tables are
//! evaluated by the interpreter, which asks for fetched inputs one by one.

use rayon::prelude::*;

use super::case_free;
use super::inputs::{Facts, Point, Vocabulary};
use super::probe::Probe;
use super::{Receiver, ReceiverKind, Receivers, Settings, ShadowMap, Variant, Visibility};
use crate::diag::Failure;
use crate::eval::{Columns, Interpreter, NeedsFetch};
use crate::program::{Program, Value};

/// A shadow map, the points that ask it, and how it is searched.
#[derive(Debug, Clone, Copy)]
pub struct Query<'a> {
    /// The shadow map.
    pub map: &'a ShadowMap,
    /// The receivers, made for a map of this size.
    pub receivers: &'a Receivers,
    /// The settings of search and filter.
    pub settings: &'a Settings,
}

/// The inputs of every evaluation of a table in a query.
#[derive(Debug)]
pub struct Evaluations {
    /// One row per evaluation, in the order of the pixels; fetched inputs where they were needed.
    pub columns: Columns<f32>,
    /// The pixel of each row, counted row by row from the top left.
    pub pixels: Vec<u32>,
}

/// The decision about one fragment.
struct Decision {
    value: f32,
    case: u32,
    state: u32,
}

impl Decision {
    fn plain(value: f32) -> Self {
        Self { value, case: Visibility::NONE, state: Visibility::NONE }
    }
}

/// The visibility of every pixel by a variant. One with a table takes it as `program`.
///
/// # Errors
/// When the table asks for inputs that a shadow map does not have.
///
/// ```
/// use umbrage::technique::revectorise::cpu::{self, Query};
/// use umbrage::technique::revectorise::stage::{Bias, Stage};
/// use umbrage::scene::Scene;
/// use umbrage::technique::revectorise::{Settings, Variant};
/// use umbrage::technique::tables;
///
/// let scene = Scene::open("slope")?;
/// let stage = Stage::new(&scene, "smsr")?;
/// let map = stage.shadow_map(64, Bias::default());
/// let receivers = stage.receivers(&stage.surfaces(32, 18), map.size);
/// let query = Query { map: &map, receivers: &receivers, settings: &Settings::default() };
/// let visibility = cpu::visibility(Variant::Smsr, Some(tables::SMSR.program()?), query, &|_| {})?;
/// assert_eq!(visibility.value.len(), 32 * 18);
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn visibility(
    variant: Variant,
    program: Option<&Program>,
    query: Query<'_>,
    done: &(dyn Fn(u64) + Sync),
) -> Result<Visibility, Failure> {
    let vocabulary = program.map(Vocabulary::new).transpose()?;
    let width = query.receivers.width.max(1) as usize;
    let rows: Vec<Vec<Decision>> = query
        .receivers
        .points
        .par_chunks(width)
        .map_init(
            || vocabulary.as_ref().map(Evaluator::new),
            |evaluator, row| {
                let decisions = row.iter().map(|receiver| decide(variant, evaluator, query, receiver)).collect();
                done(1);
                decisions
            },
        )
        .collect();
    let mut visibility = Visibility { value: Vec::new(), case: Vec::new(), state: Vec::new() };
    for decision in rows.into_iter().flatten() {
        visibility.value.push(decision.value);
        visibility.case.push(decision.case);
        visibility.state.push(decision.state);
    }
    Ok(visibility)
}

/// The inputs of a table in every pixel of a frame that asks it, as a capture stores them.
///
/// # Errors
/// When the table asks for inputs that a shadow map does not have.
pub fn evaluations(program: &Program, query: Query<'_>) -> Result<Evaluations, Failure> {
    let vocabulary = Vocabulary::new(program)?;
    let found: Vec<Option<Point>> = query
        .receivers
        .points
        .par_iter()
        .map_init(
            || Evaluator::new(&vocabulary),
            |evaluator, receiver| {
                if receiver.kind != ReceiverKind::Facing {
                    return None;
                }
                let facts = evaluator.facts(Probe::new(query.map, receiver, query.settings), query.settings)?;
                Some(evaluator.evaluate(&facts).1)
            },
        )
        .collect();
    let mut evaluations = Evaluations { columns: Columns::new(program), pixels: Vec::new() };
    for (pixel, point) in found.into_iter().enumerate() {
        // Points are made from the table's own inputs, so they fit.
        if let Some(point) = point
            && evaluations.columns.push(&point).is_ok()
        {
            evaluations.pixels.push(pixel as u32);
        }
    }
    Ok(evaluations)
}

fn decide(variant: Variant, evaluator: &mut Option<Evaluator<'_>>, query: Query<'_>, receiver: &Receiver) -> Decision {
    match receiver.kind {
        ReceiverKind::Background => return Decision::plain(1.0),
        ReceiverKind::Away => return Decision::plain(0.0),
        ReceiverKind::Facing => {}
    }
    let settings = query.settings;
    let probe = Probe::new(query.map, receiver, settings);
    let by_table = |evaluator: &mut Option<Evaluator<'_>>, probe: Probe<'_>| match evaluator {
        Some(evaluator) => evaluator.decide(probe, settings),
        None => Decision::plain(hard(&probe)),
    };
    match variant {
        Variant::Hard => Decision::plain(hard(&probe)),
        Variant::Pcf => Decision::plain(mean(&probe, settings.pcf, |probe| hard(&probe))),
        Variant::CaseFree => Decision::plain(case_free::filtered(&probe, settings)),
        Variant::Smsr | Variant::Rsmss => by_table(evaluator, probe),
        Variant::Rpcf => {
            let value = mean(&probe, settings.pcf, |probe| by_table(evaluator, probe).value);
            // The case that is shown is that of the texel itself.
            Decision { value, ..by_table(evaluator, probe) }
        }
    }
}

fn hard(probe: &Probe<'_>) -> f32 {
    f32::from(u8::from(probe.lit))
}

/// The mean of a technique over a square of texels around the fragment's.
fn mean(probe: &Probe<'_>, side: u32, mut value: impl FnMut(Probe<'_>) -> f32) -> f32 {
    let radius = (side / 2) as i32;
    let mut sum = 0.0;
    for y in -radius..=radius {
        for x in -radius..=radius {
            sum += value(probe.shifted([x, y]));
        }
    }
    let side = (2 * radius + 1) as f32;
    sum / (side * side)
}

/// Asks a table about fragments.
struct Evaluator<'v> {
    vocabulary: &'v Vocabulary<'v>,
    interpreter: Interpreter<'v, f32>,
}

impl<'v> Evaluator<'v> {
    fn new(vocabulary: &'v Vocabulary<'v>) -> Self {
        Self { vocabulary, interpreter: Interpreter::new(vocabulary.program()) }
    }

    /// The facts about a fragment that the table is asked with, if it is asked.
    fn facts<'a>(&self, probe: Probe<'a>, settings: &Settings) -> Option<Facts<'a>> {
        if !probe.lit && !self.vocabulary.has_kind() {
            return None;
        }
        self.vocabulary.facts(probe, settings)
    }

    fn decide(&mut self, probe: Probe<'_>, settings: &Settings) -> Decision {
        match self.facts(probe, settings) {
            Some(facts) => self.evaluate(&facts).0,
            None => Decision::plain(hard(&probe)),
        }
    }

    /// The table's answer, and the point it was given at, with what was fetched.
    fn evaluate(&mut self, facts: &Facts<'_>) -> (Decision, Point) {
        let program = self.vocabulary.program();
        let mut point = self.vocabulary.point(facts);
        let outcome = loop {
            match self.interpreter.evaluate(&point) {
                Ok(outcome) => break outcome,
                Err(NeedsFetch(input)) => point[input.index()] = Some(self.vocabulary.fetch(facts, input)),
            }
        };
        let level = |input: crate::program::InputId| match point[input.index()] {
            Some(Value::Level(level)) => level,
            _ => 0,
        };
        let decision = Decision {
            value: outcome.values[0].clamp(0.0, 1.0),
            case: outcome.row.map_or(Visibility::DEFAULT, |row| program.rows[row].id),
            state: program.states.index(level) as u32,
        };
        (decision, point)
    }
}
