//! What a plan should cost where threads run in step.
//!
//! A group of threads goes through every step that one of its threads takes,
//! and the others wait. So the price of a group is the sum over the distinct
//! steps of its threads, each counted once: neighbours that agree share theirs,
//! neighbours that do not pay for each other. A step costs the operations that
//! it is written with. No device is asked; what a measurement says instead is
//! shown beside it.

use std::collections::{HashMap, HashSet};

use crate::eval::Columns;
use crate::plan::{Leaf, Plan, Step, StepId};
use crate::profile::Profile;
use crate::program::claims::decide;
use crate::program::{Cond, CondId, ExprId, Node, Pool};

/// Threads that run in step on most devices.
const GROUP: usize = 32;

/// Rows that are looked at, at most: the mean over them does not change with more.
const LOOKED_AT: usize = 1 << 13;

/// What a read of memory that is at hand counts for, in operations. A convention: devices differ,
/// and most plans read nothing or one word.
const READ: f64 = 8.0;

/// What a plan should cost, in operations.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Estimate {
    /// Of a group of threads, by kind of input, in the order of [`Kind::ALL`](super::Kind::ALL).
    pub of_kind: Vec<f64>,
    /// Of every step of the plan: for devices that run both sides of every branch.
    pub everything: f64,
    /// Of a thread by itself, where states occur as the profile says.
    pub alone: f64,
    /// Of a group that covers a tile of a picture; `None` if the profile has no tiles.
    pub tile: Option<f64>,
}

impl Estimate {
    /// Of a plan, at the inputs that it is measured with, and where states occur as a profile says.
    pub(super) fn new(plan: &Plan<'_>, kinds: &[Columns<f32>], profile: &Profile) -> Self {
        let mut model = Model::new(plan);
        let of_kind = kinds.iter().map(|columns| model.columns(columns)).collect();
        let (alone, tile) = model.profile(profile);
        // In the order of steps: sums of floating-point numbers depend on it.
        let items = plan.reachable().into_iter().flat_map(|step| [(step, false), (step, true)]);
        let everything = items.map(|item| model.costs[&item]).sum();
        Self { of_kind, everything, alone, tile }
    }
}

/// What is paid for: a step, or, if told so, the fetch that it makes.
type Item = (StepId, bool);

/// The steps of a plan, by state.
struct Model<'a, 'p> {
    plan: &'a Plan<'p>,
    costs: HashMap<Item, f64>,
    paths: HashMap<usize, Vec<Item>>,
}

impl<'a, 'p> Model<'a, 'p> {
    fn new(plan: &'a Plan<'p>) -> Self {
        let items = plan.reachable().into_iter().flat_map(|step| [(step, false), (step, true)]);
        let costs = items.map(|item| (item, cost(plan, item))).collect();
        Self { plan, costs, paths: HashMap::new() }
    }

    /// What a group costs whose threads are in these states.
    fn group(&mut self, states: impl IntoIterator<Item = usize>) -> f64 {
        let mut taken = HashSet::new();
        let mut sum = 0.0;
        for state in states {
            let plan = self.plan;
            let path = self.paths.entry(state).or_insert_with(|| path(plan, state));
            sum += path.iter().filter(|item| taken.insert(**item)).map(|item| self.costs[item]).sum::<f64>();
        }
        sum
    }

    /// The mean over groups of consecutive rows.
    fn columns(&mut self, columns: &Columns<f32>) -> f64 {
        let states = &self.plan.program.states;
        let state = |row: usize| states.index(|input| columns.levels(input)[row]);
        let starts = (0..columns.len().min(LOOKED_AT)).step_by(GROUP);
        let groups = starts.len().max(1) as f64;
        starts.map(|start| self.group((start..columns.len().min(start + GROUP)).map(state))).sum::<f64>() / groups
    }

    /// The means that a profile says: of a thread by itself, and of a tile.
    fn profile(&mut self, profile: &Profile) -> (f64, Option<f64>) {
        let (mut alone, mut tiles) = (Mean::default(), Mean::default());
        for scene in &profile.scenes {
            for (state, count) in &scene.states {
                alone.add(scene.weight * *count as f64, self.group([*state]));
            }
            for (set, count) in scene.tiles.iter().flat_map(|tiles| &tiles.sets) {
                tiles.add(scene.weight * *count as f64, self.group(set.iter().copied()));
            }
        }
        (alone.value().unwrap_or(f64::NAN), tiles.value())
    }
}

#[derive(Default)]
struct Mean {
    weight: f64,
    sum: f64,
}

impl Mean {
    fn add(&mut self, weight: f64, value: f64) {
        self.weight += weight;
        self.sum += weight * value;
    }

    fn value(&self) -> Option<f64> {
        (self.weight > 0.0).then(|| self.sum / self.weight)
    }
}

/// The steps that a thread in a state may take. Where numbers or fetched inputs
/// decide, both ways count: among many threads some take either.
fn path(plan: &Plan<'_>, state: usize) -> Vec<Item> {
    let program = plan.program;
    let mut levels = vec![0; program.inputs.len()];
    program.states.write(state, &mut levels);
    let found = plan.lookup.get(state).map_or(0, |found| usize::from(*found));
    // Behind turned inputs the state is another one.
    let mut turned = false;
    let (mut path, mut seen, mut open) = (Vec::new(), HashSet::new(), vec![plan.root()]);
    while let Some(at) = open.pop() {
        if !seen.insert(at) {
            continue;
        }
        path.push((at, false));
        match plan.step(at) {
            Step::Test { condition, then, other } => {
                let holds = if turned { None } else { decide(program, &plan.pool, *condition, &levels) };
                open.extend((holds != Some(true)).then_some(*other));
                open.extend((holds != Some(false)).then_some(*then));
            }
            Step::Fetch { next, .. } => {
                path.push((at, true));
                open.push(*next);
            }
            Step::Gather { condition, next, .. } => {
                let needed = decide(program, &plan.pool, *condition, &levels) != Some(false);
                path.extend(needed.then_some((at, true)));
                open.push(*next);
            }
            Step::Switch { arms } => open.extend(arms.get(found)),
            Step::Coefficients { rest } => {
                open.extend(found.checked_sub(plan.coefficients.fits.len()).and_then(|way| rest.get(way)));
            }
            Step::Orbit { arms } => {
                turned = true;
                open.extend(arms.get(found >> plan.symmetries.len()));
            }
            Step::Leaf(_) => {}
        }
    }
    path
}

/// The operations of a step, or of the fetch that it makes.
fn cost(plan: &Plan<'_>, (step, fetch): Item) -> f64 {
    if fetch {
        return match plan.step(step) {
            Step::Fetch { input, .. } | Step::Gather { input, .. } => {
                READ * plan.program.inputs[input.index()].fetched.unwrap_or(1.0)
            }
            _ => 0.0,
        };
    }
    let mut operations = Operations { pool: &plan.pool, seen: HashSet::new(), count: 0 };
    let fixed = match plan.step(step) {
        Step::Test { condition, .. } | Step::Gather { condition, .. } => {
            operations.condition(*condition);
            1.0
        }
        Step::Fetch { .. } => 0.0,
        Step::Switch { .. } => READ,
        Step::Coefficients { .. } => {
            let factors = plan.coefficients.inputs.len() * plan.coefficients.width * plan.program.output.components();
            // Each factor is read, multiplied and added.
            READ + 3.0 * factors as f64
        }
        Step::Orbit { .. } => READ + 2.0 * (plan.symmetries.len() * plan.program.inputs.len()) as f64,
        Step::Leaf(Leaf { values, .. }) => {
            values.iter().for_each(|value| operations.value(*value));
            0.0
        }
    };
    fixed + operations.count as f64
}

/// Counts operations, those that are shared once.
struct Operations<'a> {
    pool: &'a Pool,
    seen: HashSet<ExprId>,
    count: usize,
}

impl Operations<'_> {
    fn condition(&mut self, condition: CondId) {
        match self.pool.cond(condition) {
            Cond::Const(_) => {}
            Cond::Level(..) => self.count += 1,
            Cond::Compare(_, a, b) => {
                self.count += 1;
                [*a, *b].into_iter().for_each(|part| self.value(part));
            }
            Cond::Not(a) => self.condition(*a),
            Cond::And(parts) | Cond::Or(parts) => parts.iter().for_each(|part| self.condition(*part)),
            Cond::If(c, a, b) => {
                self.count += 1;
                [*c, *a, *b].into_iter().for_each(|part| self.condition(part));
            }
        }
    }

    fn value(&mut self, value: ExprId) {
        let node = self.pool.node(value);
        if matches!(node, Node::Const(_) | Node::Input(_) | Node::Result) || !self.seen.insert(value) {
            return;
        }
        self.count += 1;
        match node {
            Node::Const(_) | Node::Input(_) | Node::Result => {}
            Node::Unary(_, a) => self.value(a),
            Node::Binary(_, a, b) => [a, b].into_iter().for_each(|part| self.value(part)),
            Node::Ternary(_, a, b, c) => [a, b, c].into_iter().for_each(|part| self.value(part)),
            Node::Select(condition, a, b) => {
                self.condition(condition);
                [a, b].into_iter().for_each(|part| self.value(part));
            }
        }
    }
}

/// How well one list of numbers puts things in the order of another: 1 if alike,
/// -1 if the other way round (Spearman's rank correlation). `None` where there is no order.
pub(super) fn rank_correlation(a: &[f64], b: &[f64]) -> Option<f64> {
    // The place of each in the order; equal ones share theirs.
    let ranks = |list: &[f64]| -> Vec<f64> {
        let rank = |value: &f64| {
            let below = list.iter().filter(|other| *other < value).count();
            let equal = list.iter().filter(|other| *other == value).count();
            below as f64 + equal as f64 / 2.0
        };
        list.iter().map(rank).collect()
    };
    let (a, b) = (ranks(a), ranks(b));
    let mean = |list: &[f64]| list.iter().sum::<f64>() / list.len() as f64;
    let (mean_a, mean_b) = (mean(&a), mean(&b));
    let product = |a: &[f64], b: &[f64], (mean_a, mean_b): (f64, f64)| -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - mean_a) * (b - mean_b)).sum()
    };
    let norm = (product(&a, &a, (mean_a, mean_a)) * product(&b, &b, (mean_b, mean_b))).sqrt();
    (norm > 0.0).then(|| product(&a, &b, (mean_a, mean_b)) / norm)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::plan::Shape;
    use crate::program::Program;
    use crate::table::Table;

    fn program() -> Program {
        let text = r#"Table(language: 1, name: "t", hit_policy: First,
            inputs: {"s": Int(from: 0, to: 2), "x": Range(from: 0, to: 1)},
            output: Number(),
            cases: [
                Case(id: 1, when: "s == 0", value: "x + 1"),
                Case(id: 2, when: "s == 1", value: "(x + 2) * x"),
            ],
            default: 0)"#;
        let table = Table::parse(Source::new("t.ron", text));
        table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn a_group_pays_for_every_way_that_one_of_its_threads_goes() {
        let program = program();
        let ladder = Plan::new(&program, Shape::Ladder).unwrap_or_else(|e| panic!("{e}"));
        let mut model = Model::new(&ladder);
        // A test is a comparison and a branch.
        assert_eq!([0, 1, 2].map(|state| model.group([state])), [3.0, 6.0, 4.0]);
        assert_eq!(model.group([0, 0, 0]), 3.0);
        assert_eq!(model.group([0, 1]), 7.0);
        assert_eq!(model.group([2, 1, 0, 1]), 7.0);
        let switch = Plan::new(&program, Shape::Switch).unwrap_or_else(|e| panic!("{e}"));
        let mut model = Model::new(&switch);
        assert_eq!([0, 1, 2].map(|state| model.group([state])), [READ + 1.0, READ + 2.0, READ]);
        assert_eq!(model.group([0, 1]), READ + 3.0);
    }

    #[test]
    fn tiles_are_weighed_by_how_often_they_occur() {
        let program = program();
        let plan = Plan::new(&program, Shape::Ladder).unwrap_or_else(|e| panic!("{e}"));
        let mut profile = Profile::new(&program);
        profile.scenes.push(crate::profile::Scene {
            name: "s".to_owned(),
            technique: "t".to_owned(),
            setting: String::new(),
            weight: 1.0,
            states: [(0, 3), (1, 1)].into(),
            cases: [(Some(1), 3), (Some(2), 1)].into(),
            tiles: None,
        });
        assert_eq!(Model::new(&plan).profile(&profile), ((3.0 * 3.0 + 6.0) / 4.0, None));
        let sets = [(vec![0], 1), (vec![0, 1], 1)].into();
        profile.scenes[0].tiles = Some(crate::profile::Tiles { width: 8, height: 4, sets, others: 0 });
        assert_eq!(Model::new(&plan).profile(&profile).1, Some((3.0 + 7.0) / 2.0));
    }

    #[test]
    fn orders_are_compared_by_rank() {
        assert_eq!(rank_correlation(&[1.0, 2.0, 30.0], &[4.0, 5.0, 6.0]), Some(1.0));
        assert_eq!(rank_correlation(&[1.0, 2.0, 3.0], &[3.0, 2.0, 1.0]), Some(-1.0));
        assert_eq!(rank_correlation(&[1.0, 1.0], &[1.0, 2.0]), None);
    }
}
