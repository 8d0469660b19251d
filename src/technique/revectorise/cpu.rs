//! The techniques in plain Rust: shadow map and receivers → visibility.
//!
//! The reference that every other executor is compared with. Tables are
//! evaluated by the interpreter, which asks for fetched inputs one by one.

use rayon::prelude::*;

use super::case_free;
use super::inputs::{Facts, Point, Vocabulary};
use super::probe::Probe;
use super::{Receiver, ReceiverKind, Receivers, Settings, ShadowMap, Technique, Visibility};
use crate::diag::{Failure, Source};
use crate::eval::{Columns, Interpreter, NeedsFetch};
use crate::program::{Program, Value};
use crate::table::Table;

/// The table of a technique, as it comes with Umbrage; `None` if the technique needs none.
///
/// # Errors
/// Never for the tables that come with Umbrage, which are tested.
pub fn table(technique: Technique) -> Result<Option<Program>, Failure> {
    let (name, text) = match technique.table() {
        None => return Ok(None),
        Some("smsr") => ("tables/smsr.ron", include_str!("../../../tables/smsr.ron")),
        Some(_) => ("tables/rsmss.ron", include_str!("../../../tables/rsmss.ron")),
    };
    Program::check(&Table::parse(Source::new(name, text))?).map(Some)
}

/// What the executor needs of a frame.
#[derive(Debug, Clone, Copy)]
pub struct Frame<'a> {
    /// The shadow map.
    pub map: &'a ShadowMap,
    /// The receivers, made for a map of this size.
    pub receivers: &'a Receivers,
    /// How to search and filter.
    pub settings: &'a Settings,
}

/// The inputs of every evaluation of a table in a frame.
#[derive(Debug)]
pub struct Evaluations {
    /// One row per evaluation, in the order of the pixels; fetched inputs where they were needed.
    pub columns: Columns<f32>,
    /// The pixel of each row, counted row by row from the top left.
    pub pixels: Vec<u32>,
}

/// How one fragment was decided.
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

/// The visibility of every pixel by a technique.
///
/// A technique with a table takes it as `program`. [`Technique::Reference`]
/// needs the scene itself and is not evaluated here: it gives the plain test.
///
/// # Errors
/// When the table asks for inputs that a shadow map does not have.
///
/// ```
/// use umbrage::technique::revectorise::cpu::{self, Frame};
/// use umbrage::technique::revectorise::stage::{Bias, Stage};
/// use umbrage::scene::Scene;
/// use umbrage::technique::revectorise::{Settings, Technique};
///
/// let scene = Scene::open("slope")?;
/// let stage = Stage::new(&scene)?;
/// let map = stage.shadow_map(64, Bias::default());
/// let receivers = stage.receivers(&stage.surfaces(32, 18), map.size);
/// let frame = Frame { map: &map, receivers: &receivers, settings: &Settings::default() };
/// let program = cpu::table(Technique::Smsr)?;
/// let visibility = cpu::visibility(Technique::Smsr, program.as_ref(), frame, &|_| {})?;
/// assert_eq!(visibility.value.len(), 32 * 18);
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn visibility(
    technique: Technique,
    program: Option<&Program>,
    frame: Frame<'_>,
    done: &(dyn Fn(u64) + Sync),
) -> Result<Visibility, Failure> {
    let vocabulary = program.map(Vocabulary::new).transpose()?;
    let width = frame.receivers.width.max(1) as usize;
    let rows: Vec<Vec<Decision>> = frame
        .receivers
        .points
        .par_chunks(width)
        .map_init(
            || vocabulary.as_ref().map(Evaluator::new),
            |evaluator, row| {
                let decisions = row.iter().map(|receiver| decide(technique, evaluator, frame, receiver)).collect();
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
pub fn evaluations(program: &Program, frame: Frame<'_>) -> Result<Evaluations, Failure> {
    let vocabulary = Vocabulary::new(program)?;
    let found: Vec<Option<Point>> = frame
        .receivers
        .points
        .par_iter()
        .map_init(
            || Evaluator::new(&vocabulary),
            |evaluator, receiver| {
                if receiver.kind != ReceiverKind::Facing {
                    return None;
                }
                let facts = evaluator.facts(Probe::new(frame.map, receiver, frame.settings), frame.settings)?;
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

fn decide(
    technique: Technique,
    evaluator: &mut Option<Evaluator<'_>>,
    frame: Frame<'_>,
    receiver: &Receiver,
) -> Decision {
    match receiver.kind {
        ReceiverKind::Background => return Decision::plain(1.0),
        ReceiverKind::Away => return Decision::plain(0.0),
        ReceiverKind::Facing => {}
    }
    let settings = frame.settings;
    let probe = Probe::new(frame.map, receiver, settings);
    let by_table = |evaluator: &mut Option<Evaluator<'_>>, probe: Probe<'_>| match evaluator {
        Some(evaluator) => evaluator.decide(probe, settings),
        None => Decision::plain(hard(&probe)),
    };
    match technique {
        Technique::Hard | Technique::Reference => Decision::plain(hard(&probe)),
        Technique::Pcf => Decision::plain(mean(&probe, settings.pcf, |probe| hard(&probe))),
        Technique::CaseFree => Decision::plain(case_free::filtered(&probe, settings)),
        Technique::Smsr | Technique::Rsmss => by_table(evaluator, probe),
        Technique::Rpcf => {
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

    /// What the table is asked about a fragment, if it is asked.
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
