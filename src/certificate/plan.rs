//! The meaning of a plan, step by step.

use std::collections::HashMap;

use super::Meaning;
use super::program::way;
use super::script::{Script, real};
use super::terms::Terms;
use crate::plan::{Coefficients, Fit, Form, Piece, Plan, Step, StepId};
use crate::program::{Domain, InputId, Program};

/// The case, the result and the fetches of a plan.
pub(super) fn meaning(plan: &Plan<'_>, script: &mut Script) -> Meaning {
    let program = plan.program;
    script.comment(&format!("The plan {}.", plan.shape));
    let mut inputs = script.inputs.clone();
    // What is gathered, before everything else: where an input is not needed, its first level or least number
    // stands in for it.
    let mut gathered: Vec<(InputId, String)> = Vec::new();
    let mut at = plan.root();
    while let Step::Gather { input, condition, next } = plan.step(at) {
        let needed = Terms::new(&plan.pool, inputs.clone()).cond(script, *condition);
        let (sort, least) = match program.inputs[input.index()].domain {
            Domain::Discrete(_) => ("Int", "0".to_owned()),
            Domain::Continuous { lo, .. } => ("Real", real(lo)),
            Domain::Word => ("Real", real(0.0)),
        };
        inputs[input.index()] = script.define(sort, &format!("(ite {needed} {} {least})", inputs[input.index()]));
        gathered.push((*input, needed));
        at = *next;
    }
    // What symmetries do to inputs, each in its turn, where the lookup says so.
    let mut turns = Vec::new();
    if let Step::Orbit { .. } = plan.step(at) {
        for (bit, index) in plan.symmetries.iter().enumerate() {
            let turned = lookup(plan, script, "Bool", &|entry| (entry >> bit & 1 == 1).to_string());
            inputs = images(plan, script, &inputs, *index, &turned);
            turns.push(turned);
        }
    }
    let mut steps = Steps {
        plan,
        terms: Terms::new(&plan.pool, inputs),
        fetched: program.fetched.iter().collect(),
        known: HashMap::new(),
    };
    for step in plan.reachable() {
        if !matches!(plan.step(step), Step::Gather { .. }) {
            let meaning = steps.step(script, step);
            steps.known.insert(step, meaning);
        }
    }
    let mut meaning = steps.known.remove(&at).unwrap_or_else(|| steps.nothing());
    // The result is turned back, the last symmetry first.
    for (turned, index) in turns.iter().zip(&plan.symmetries).rev() {
        if let Some(map) = &program.symmetries[*index].result {
            let mut terms = Terms::of_result(&plan.pool, script.inputs.clone(), &meaning.values);
            for (value, component) in meaning.values.iter_mut().zip(map) {
                let image = terms.expr(script, *component);
                *value = script.define("Real", &format!("(ite {turned} {image} {value})"));
            }
        }
    }
    for (input, fetches) in &mut meaning.fetches {
        let also: Vec<&str> =
            gathered.iter().filter(|(gathered, _)| gathered == input).map(|(_, needed)| needed.as_str()).collect();
        *fetches = format!("(or {fetches} {})", also.join(" "));
    }
    meaning
}

/// The inputs as a symmetry turns them where a condition holds.
fn images(plan: &Plan<'_>, script: &mut Script, inputs: &[String], symmetry: usize, turned: &str) -> Vec<String> {
    let symmetry = &plan.program.symmetries[symmetry];
    let mut terms = Terms::new(&plan.pool, inputs.to_vec());
    let mut images = inputs.to_vec();
    for (input, image) in &symmetry.levels {
        let image = terms.level(script, image);
        images[input.index()] = script.define("Int", &format!("(ite {turned} {image} {})", inputs[input.index()]));
    }
    for (input, image) in &symmetry.numbers {
        let image = terms.expr(script, *image);
        images[input.index()] = script.define("Real", &format!("(ite {turned} {image} {})", inputs[input.index()]));
    }
    images
}

/// A term for the entry that the lookup has for a state, as choices by one input after the other. Equal parts
/// are written once.
fn lookup(plan: &Plan<'_>, script: &mut Script, sort: &str, of: &dyn Fn(usize) -> String) -> String {
    let mut leaves: Vec<String> = Vec::new();
    let mut leaf_of: HashMap<u16, usize> = HashMap::new();
    let mut number = |entry: &u16| {
        *leaf_of.entry(*entry).or_insert_with(|| {
            let leaf = of(usize::from(*entry));
            leaves.iter().position(|known| *known == leaf).unwrap_or_else(|| {
                leaves.push(leaf);
                leaves.len() - 1
            })
        })
    };
    let entries: Vec<usize> = plan.lookup.iter().map(&mut number).collect();
    let choices = Choices { program: plan.program, sort, leaves: &leaves };
    choices.among(script, 0, &entries, &mut HashMap::new())
}

/// Terms to choose between by the inputs of a state.
struct Choices<'a> {
    program: &'a Program,
    sort: &'a str,
    leaves: &'a [String],
}

impl Choices<'_> {
    /// The choice between the leaves that the states of some inputs have, from input number `digit` on.
    fn among(
        &self,
        script: &mut Script,
        digit: usize,
        entries: &[usize],
        known: &mut HashMap<Vec<usize>, String>,
    ) -> String {
        let first = entries.first().copied().unwrap_or_default();
        let Some((input, count)) = self.program.states.digits().get(digit).copied() else {
            return self.leaves[first].clone();
        };
        if entries.iter().all(|entry| *entry == first) {
            return self.leaves[first].clone();
        }
        if let Some(known) = known.get(entries) {
            return known.clone();
        }
        let mut rest = String::new();
        for (level, part) in entries.chunks(entries.len() / count).enumerate().rev() {
            let part = self.among(script, digit + 1, part, known);
            rest = match rest.is_empty() {
                true => part,
                false if part == rest => part,
                false => format!("(ite (= {} {level}) {part} {rest})", script.inputs[input.index()]),
            };
        }
        let name = script.define(self.sort, &rest);
        known.insert(entries.to_vec(), name.clone());
        name
    }
}

/// The meanings of steps, each made of those that may come next.
struct Steps<'a, 'p> {
    plan: &'a Plan<'p>,
    terms: Terms<'a>,
    fetched: Vec<InputId>,
    known: HashMap<StepId, Meaning>,
}

impl Steps<'_, '_> {
    fn step(&mut self, script: &mut Script, step: StepId) -> Meaning {
        let plan = self.plan;
        match plan.step(step) {
            Step::Leaf(leaf) => Meaning {
                way: way(leaf.row, leaf.line).to_string(),
                values: leaf.values.iter().map(|value| self.terms.expr(script, *value)).collect(),
                fetches: self.no_fetch(),
            },
            Step::Test { condition, then, other } => {
                let holds = self.terms.cond(script, *condition);
                self.chosen(script, &[(holds, *then)], *other)
            }
            Step::Fetch { input, next } => {
                let mut meaning = self.copy(*next);
                let fetch = meaning.fetches.iter_mut().find(|(fetched, _)| fetched == input);
                if let Some((_, fetches)) = fetch {
                    *fetches = "true".to_owned();
                }
                meaning
            }
            Step::Switch { arms } => self.arms(script, &|entry| Some(self.copy(*arms.get(entry)?))),
            Step::Orbit { arms } => {
                let count = plan.symmetries.len();
                self.arms(script, &|entry| Some(self.copy(*arms.get(entry >> count)?)))
            }
            Step::Coefficients { rest } => {
                let fits: Vec<Meaning> = plan.coefficients.fits.iter().map(|fit| self.fit(script, fit)).collect();
                self.arms(script, &|entry| match fits.get(entry) {
                    Some(fit) => Some(fit.clone()),
                    None => Some(self.copy(*rest.get(entry - fits.len())?)),
                })
            }
            // They come first, and were looked at before.
            Step::Gather { next, .. } => self.copy(*next),
        }
    }

    /// No way at all, which no table goes.
    fn nothing(&self) -> Meaning {
        let values = vec![real(0.0); self.plan.program.default.len()];
        Meaning { way: "(- 1)".to_owned(), values, fetches: self.no_fetch() }
    }

    fn no_fetch(&self) -> Vec<(InputId, String)> {
        self.fetched.iter().map(|input| (*input, "false".to_owned())).collect()
    }

    fn copy(&self, step: StepId) -> Meaning {
        self.known.get(&step).cloned().unwrap_or_else(|| self.nothing())
    }

    fn fit(&self, script: &mut Script, fit: &Fit) -> Meaning {
        let pieces = fit.pieces.iter();
        let values = pieces.map(|piece| value(&self.plan.coefficients, piece, &self.terms.inputs, script));
        Meaning { values: values.collect(), way: way(fit.row, fit.line).to_string(), fetches: self.no_fetch() }
    }

    /// The meaning that the lookup chooses, which is made of its entry.
    fn arms(&self, script: &mut Script, of: &dyn Fn(usize) -> Option<Meaning>) -> Meaning {
        let of = |entry| of(entry).unwrap_or_else(|| self.nothing());
        let components = 0..self.plan.program.default.len();
        let value = |entry: usize, place: usize| of(entry).values.get(place).cloned().unwrap_or_else(|| real(0.0));
        Meaning {
            way: lookup(self.plan, script, "Int", &|entry| of(entry).way),
            values: components.map(|place| lookup(self.plan, script, "Real", &|entry| value(entry, place))).collect(),
            fetches: (self.fetched.iter().enumerate())
                .map(|(place, input)| {
                    (*input, lookup(self.plan, script, "Bool", &|entry| of(entry).fetches[place].1.clone()))
                })
                .collect(),
        }
    }

    /// The first of some steps whose condition holds, or another one.
    fn chosen(&mut self, script: &mut Script, ways: &[(String, StepId)], other: StepId) -> Meaning {
        let mut meaning = self.copy(other);
        for (holds, step) in ways.iter().rev() {
            let own = self.copy(*step);
            let choice = |script: &mut Script, sort: &str, own: &str, rest: &str| match own == rest {
                true => rest.to_owned(),
                false => script.define(sort, &format!("(ite {holds} {own} {rest})")),
            };
            meaning.way = choice(script, "Int", &own.way, &meaning.way);
            for (rest, own) in meaning.values.iter_mut().zip(&own.values) {
                *rest = choice(script, "Real", own, rest);
            }
            for ((_, rest), (_, own)) in meaning.fetches.iter_mut().zip(&own.fetches) {
                *rest = choice(script, "Bool", own, rest);
            }
        }
        meaning
    }
}

/// The value of a set of coefficients: the least of its sums, or its negative, within the bounds.
fn value(coefficients: &Coefficients, piece: &Piece, inputs: &[String], script: &mut Script) -> String {
    let sum = |form: &Form| {
        let products = coefficients.inputs.iter().zip(&form.factors);
        let products = products.map(|(input, factor)| format!("(* {} {})", real(*factor), inputs[input.index()]));
        format!("(+ {} 0.0 {})", real(form.constant), products.collect::<Vec<_>>().join(" "))
    };
    let mut sums = piece.forms.iter().map(sum).map(|sum| script.define("Real", &sum)).collect::<Vec<_>>().into_iter();
    let first = sums.next().unwrap_or_else(|| real(0.0));
    let least = sums.fold(first, |least, sum| script.define("Real", &format!("(ite (< {sum} {least}) {sum} {least})")));
    let value = script.define("Real", &format!("(* {} {least})", real(piece.sign)));
    match coefficients.clamp {
        None => value,
        Some((lo, hi)) => {
            let (lo, hi) = (real(lo), real(hi));
            script.define("Real", &format!("(ite (< {value} {lo}) {lo} (ite (< {hi} {value}) {hi} {value}))"))
        }
    }
}
