//! The tables of the search, as the search asks them.

use super::super::tabulated::{Tabulated, lists};
use super::options::Rule;
use crate::diag::{Diagnostic, Failure, codes};
use crate::eval::Interpreter;
use crate::program::{Domain, Output, Program, Value};
use crate::technique::tables::{
    BuiltIn, CLOSEST_POINT_SETUP, CLOSEST_POINT_START, CLOSEST_POINT_STEP, QUAD_DIAGONAL, SEARCH_PLAN,
    TRIANGLE_CONFIGURATION, TRIANGLE_RAYS, TRIANGLE_REGION,
};

/// Points of a triangle by their labels, the levels of the sets `point` in `triangle_region` and `triangle_rays`, which
/// agree up to H.
pub(super) mod label {
    /// The first vertex.
    pub(in super::super) const V: usize = 0;
    /// The first discontinuity of edge 0.
    pub(in super::super) const A: usize = 3;
    /// The second discontinuity of edge 0.
    pub(in super::super) const B: usize = 6;
    /// The middle of the discontinuities of an edge.
    pub(in super::super) const K: usize = 9;
    /// The discontinuity between K and the opposite vertex.
    pub(in super::super) const H: usize = 10;
    /// The closest point, or the first of a curve.
    pub(in super::super) const X: usize = 11;
    /// The other closest point.
    pub(in super::super) const Y: usize = 12;
    /// The first point of the other curve.
    pub(in super::super) const Y_OF_RAYS: usize = 16;
    /// Points.
    pub(in super::super) const COUNT: usize = 21;
}

/// Most loops of a triangle's region.
const LOOPS: usize = 3;

/// A table that is asked point by point, by the interpreter.
#[derive(Debug)]
struct Asked {
    interpreter: Interpreter<'static, f64>,
    /// The place of the first input that is fetched.
    fetched: usize,
}

/// The way to look for the discontinuities of an edge.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Plan {
    pub(super) method: Method,
    /// The place that [`Method::Probe`] tests first.
    pub(super) at: f64,
    pub(super) from: f64,
    pub(super) to: f64,
}

/// The level set `method` of `search_plan`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Method {
    Bisect,
    Search,
    Probe,
}

/// The level set `method` of `quad_diagonal`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Across {
    Search,
    Bisect,
    BisectHalves,
}

/// The labels that a search for a closest point is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Setup {
    /// True if Y is looked for, and not X.
    pub(super) is_y: bool,
    pub(super) apex: usize,
    pub(super) far: [usize; 2],
    pub(super) chord: [usize; 2],
}

/// The tables of the search.
#[derive(Debug)]
pub(super) struct Tables {
    plans: Asked,
    configurations: Tabulated,
    regions: Tabulated,
    rays: Tabulated,
    setups: Tabulated,
    starts: Asked,
    steps: Asked,
    diagonals: Asked,
    /// Numbers of the loops in a result of `triangle_region`; its triangles follow.
    loops: usize,
    names: Vec<&'static str>,
}

impl Asked {
    /// The table with these inputs, in this order.
    fn new(table: &'static BuiltIn, inputs: &[&str]) -> Result<Self, Failure> {
        let program = table.program()?;
        if program.inputs.iter().map(|input| &*input.name).ne(inputs.iter().copied()) {
            let message = format!("`{}` has other inputs than {}", table.name, inputs.join(", "));
            return Err(Failure::bare(table.name, Diagnostic::error(codes::NOT_APPLICABLE, message)));
        }
        let fetched = program.inputs.iter().position(|input| input.fetched.is_some()).unwrap_or(inputs.len());
        Ok(Self { interpreter: Interpreter::new(program), fetched })
    }

    /// The result at a point, or the fetched input that it needs, counted from the first.
    fn at(&mut self, point: &[Option<Value>]) -> Result<Vec<f64>, usize> {
        match self.interpreter.evaluate(point) {
            Ok(outcome) => Ok(outcome.values),
            Err(needed) => Err(needed.0.index() - self.fetched),
        }
    }

    /// The result at a point of a table that fetches nothing.
    fn known(&mut self, point: &[Option<Value>]) -> Vec<f64> {
        self.at(point).unwrap_or_default()
    }
}

fn yes(holds: bool) -> Option<Value> {
    Some(Value::Level(u8::from(holds)))
}

fn level(level: usize) -> Option<Value> {
    Some(Value::Level(level as u8))
}

fn number(number: f64) -> Option<Value> {
    Some(Value::Number(number))
}

impl Tables {
    /// The tables that come with Umbrage.
    ///
    /// # Errors
    /// Never for those tables, which are tested.
    pub(super) fn new() -> Result<Self, Failure> {
        let states = ["configuration", "rotation", "lit"];
        let region = TRIANGLE_REGION.program()?;
        Ok(Self {
            plans: Asked::new(&SEARCH_PLAN, &["differ", "neighbour", "start_changed", "p1", "p2"])?,
            configurations: Tabulated::new(&TRIANGLE_CONFIGURATION, &["b0", "b1", "b2", "t0", "t1", "t2"])?,
            regions: Tabulated::new(&TRIANGLE_REGION, &[&states[..], &["x", "y"]].concat())?,
            rays: Tabulated::new(&TRIANGLE_RAYS, &[&states[..], &["k"]].concat())?,
            setups: Tabulated::new(&CLOSEST_POINT_SETUP, &["configuration", "rotation", "side"])?,
            starts: Asked::new(&CLOSEST_POINT_START, &["bulges", "mid", "d_lo", "d_mid", "d_hi", "rule"])?,
            steps: Asked::new(&CLOSEST_POINT_STEP, &["lo", "mid", "hi", "d_lo", "d_mid", "d_hi", "d_low", "d_high"])?,
            diagonals: Asked::new(&QUAD_DIAGONAL, &["b0", "b1", "b2", "b3", "drawn", "middle"])?,
            loops: first_field(region),
            names: level_names(region),
        })
    }

    /// The name of a configuration.
    pub(super) fn name(&self, configuration: usize) -> &'static str {
        self.names[configuration]
    }

    /// The way to look for the discontinuities of an edge (`search_plan`).
    ///
    /// Of the neighbouring pixel, if there is one, the visibility of the start is known, and up to two discontinuities.
    pub(super) fn plan(&mut self, ends: [bool; 2], neighbour: Option<(bool, &[f64])>) -> Plan {
        let (history, start_changed, places) = match neighbour {
            None => (0, false, &[][..]),
            Some((start, places)) => (1 + places.len(), start != ends[0], places),
        };
        let (first, last) = (places.first().copied().unwrap_or(0.0), places.last().copied().unwrap_or(1.0));
        let point = [yes(ends[0] != ends[1]), level(history), yes(start_changed), number(first), number(last)];
        let [method, at, from, to] = self.plans.known(&point)[..] else { unreachable!("a record of four") };
        let method = match method as usize {
            0 => Method::Bisect,
            1 => Method::Search,
            _ => Method::Probe,
        };
        Plan { method, at, from, to }
    }

    /// The configuration of a triangle, and the vertex that comes first in it (`triangle_configuration`).
    pub(super) fn configuration(&self, seen: [bool; 3], twice: [bool; 3]) -> (usize, usize) {
        let levels: Vec<usize> = seen.iter().chain(&twice).map(|holds| usize::from(*holds)).collect();
        match self.configurations.at(&levels) {
            [configuration, rotation, ..] => (usize::from(*configuration), usize::from(*rotation)),
            _ => (0, 0),
        }
    }

    /// The visible loops and triangles with closest points (`triangle_region`).
    pub(super) fn region(&self, state: [usize; 3], found: [bool; 2]) -> (Vec<Vec<usize>>, Vec<[usize; 3]>) {
        let levels: Vec<usize> = state.into_iter().chain(found.map(usize::from)).collect();
        let (loops, triangles) = self.regions.at(&levels).split_at(self.loops);
        let triangles = triangles[1..=usize::from(triangles[0])].chunks_exact(3);
        (lists(loops, LOOPS), triangles.map(|three| [0, 1, 2].map(|corner| usize::from(three[corner]))).collect())
    }

    /// The visible loops with curves of some points (`triangle_rays`).
    pub(super) fn loops(&self, state: [usize; 3], points: usize) -> Vec<Vec<usize>> {
        let levels: Vec<usize> = state.into_iter().chain([points]).collect();
        lists(self.rays.at(&levels), LOOPS)
    }

    /// The search for a closest point, in the half of a triangle near v1, or in the other one (`closest_point_setup`).
    pub(super) fn setup(&self, configuration: usize, rotation: usize, other_half: bool) -> Option<Setup> {
        let result = self.setups.at(&[configuration, rotation, usize::from(other_half)]);
        let result: Vec<usize> = result.iter().map(|label| usize::from(*label)).collect();
        let [found, apex, e1, e2, d1, d2] = result[..] else { return None };
        (found > 0).then_some(Setup { is_y: found == 2, apex, far: [e1, e2], chord: [d1, d2] })
    }

    /// Returns whether a search for a closest point has something to look for (`closest_point_start`).
    pub(super) fn is_worth_beginning(&mut self, bulges: bool, at: f64, distances: [f64; 3], rule: Rule) -> bool {
        let [lo, mid, hi] = distances.map(number);
        let rule = level(match rule {
            Rule::Line => 0,
            Rule::Chord => 1,
        });
        self.starts.known(&[yes(bulges), number(at), lo, mid, hi, rule]) == [1.0]
    }

    /// The next three places of a search for a closest point, or the half, 0 or 1, in whose middle the distance is
    /// needed (`closest_point_step`).
    pub(super) fn step(
        &mut self,
        places: [f64; 3],
        distances: [f64; 3],
        halves: [Option<f64>; 2],
    ) -> Result<[f64; 3], usize> {
        let [lo, mid, hi] = places.map(number);
        let [d_lo, d_mid, d_hi] = distances.map(number);
        let [d_low, d_high] = halves.map(|half| half.map(Value::Number));
        let next = self.steps.at(&[lo, mid, hi, d_lo, d_mid, d_hi, d_low, d_high])?;
        Ok([next[0], next[1], next[2]])
    }

    /// The diagonal of a quadrilateral, 0 from its first corner or 1 from its second one, and the way to look for its
    /// discontinuities (`quad_diagonal`); `None` if that depends on the place where the diagonals cross.
    pub(super) fn diagonal(&mut self, seen: [bool; 4], drawn: usize, middle: Option<bool>) -> Option<(usize, Across)> {
        let [b0, b1, b2, b3] = seen.map(yes);
        let result = self.diagonals.at(&[b0, b1, b2, b3, level(drawn), middle.and_then(yes)]).ok()?;
        let across = match result[1] as usize {
            0 => Across::Search,
            1 => Across::Bisect,
            _ => Across::BisectHalves,
        };
        Some((result[0] as usize, across))
    }
}

/// The components of a record's first field.
fn first_field(program: &Program) -> usize {
    match &program.output {
        Output::Record(fields) => fields.first().map_or(0, |(_, of)| of.size()),
        _ => 0,
    }
}

/// The names of the levels of the first input.
fn level_names(program: &'static Program) -> Vec<&'static str> {
    match &program.inputs[0].domain {
        Domain::Discrete(levels) => levels.names.iter().map(String::as_str).collect(),
        Domain::Continuous { .. } | Domain::Word => Vec::new(),
    }
}
