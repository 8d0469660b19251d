//! The result that a symmetry says a program has, and several symmetries applied one after the other.
//!
//! All of this is the equation that [`Symmetry`] states. For two symmetries in turn it reads
//! `V(x) = R1(R2(V(m2(m1(x)))))`: the images are taken in order, the results mapped back in reverse.

use std::sync::Arc;

use super::claims::decide;
use super::symbolic::{Machine, View};
use super::{ExprId, InputId, InputSet, LevelTerm, Node, Pool, Program, Symmetry};

/// Returns whether a symmetry maps inputs in ways that can be applied one after the
/// other: levels of a state by the state alone, fetched inputs to fetched
/// inputs with their levels renamed, numbers without selections.
pub(crate) fn is_usable(program: &Program, symmetry: &Symmetry) -> bool {
    let fetched = |input: InputId| program.fetched.contains(input);
    let levels = symmetry.levels.iter().all(|(input, image)| match fetched(*input) {
        true => renamed(image).is_some_and(|(source, _)| fetched(source)),
        false => true,
    });
    let numbers = symmetry.numbers.iter().all(|(input, image)| match fetched(*input) {
        true => matches!(program.pool.node(*image), Node::Input(source) if fetched(source)),
        false => {
            let facts = program.pool.expr_facts(*image);
            !facts.selects && facts.inputs.and(program.fetched).is_empty()
        }
    });
    let result = symmetry.result.iter().flatten().all(|component| {
        let facts = program.pool.expr_facts(*component);
        !facts.selects && facts.inputs.is_empty()
    });
    levels && numbers && result && image_of_state(program, symmetry, 0).is_some()
}

/// The result that a program has on the machine's path if it has a symmetry there, and the row that this
/// comes from: the result at the image, mapped.
pub(crate) fn said(machine: &mut Machine<'_>, symmetry: &Symmetry) -> (Option<usize>, Vec<ExprId>) {
    let (row, values) = machine.run(View { symmetry: Some(symmetry), result: None });
    (row, mapped(machine, symmetry.result.iter().map(Vec::as_slice), values))
}

/// Results, mapped one map after the other.
fn mapped<'m>(
    machine: &mut Machine<'_>,
    maps: impl IntoIterator<Item = &'m [ExprId]>,
    values: Vec<ExprId>,
) -> Vec<ExprId> {
    maps.into_iter().fold(values, |values, map| {
        let view = View { symmetry: None, result: Some(&values) };
        map.iter().map(|component| machine.resolve(*component, view)).collect()
    })
}

/// The state that a symmetry turns a state into; `None` if that depends on other inputs.
pub(crate) fn image_of_state(program: &Program, symmetry: &Symmetry, state: usize) -> Option<usize> {
    let mut levels = vec![0; program.inputs.len()];
    program.states.write(state, &mut levels);
    let mut image = levels.clone();
    for (input, term) in &symmetry.levels {
        if !program.fetched.contains(*input) {
            image[input.index()] = level(program, term, &levels)?;
        }
    }
    Some(program.states.index(|input| image[input.index()]))
}

fn level(program: &Program, term: &LevelTerm, levels: &[u8]) -> Option<u8> {
    match term {
        LevelTerm::Const(level) => Some(*level),
        LevelTerm::Input(input) if program.fetched.contains(*input) => None,
        LevelTerm::Input(input) => Some(levels[input.index()]),
        LevelTerm::If(condition, then, other) => match decide(program, &program.pool, *condition, levels)? {
            true => level(program, then, levels),
            false => level(program, other, levels),
        },
        LevelTerm::Map(inner, renaming) => renaming.get(usize::from(level(program, inner, levels)?)).copied(),
    }
}

/// The one input that a level is made of, and what becomes of each of its
/// levels; `None` for the renaming if nothing does.
pub(crate) fn renamed(term: &LevelTerm) -> Option<(InputId, Option<Vec<u8>>)> {
    match term {
        LevelTerm::Input(input) => Some((*input, None)),
        LevelTerm::Map(inner, renaming) => {
            let (input, before) = renamed(inner)?;
            Some((
                input,
                Some(match before {
                    None => renaming.to_vec(),
                    Some(before) => {
                        before.iter().map(|level| renaming.get(usize::from(*level)).copied()).collect::<Option<_>>()?
                    }
                }),
            ))
        }
        LevelTerm::Const(_) | LevelTerm::If(..) => None,
    }
}

/// The symmetries of a word, one after the other, on the inputs of one state, as one symmetry.
#[derive(Debug, Clone)]
pub(crate) struct Turn {
    /// The images of the inputs.
    pub(crate) symmetry: Symmetry,
    /// The maps that turn the result back, the last symmetry first.
    results: Vec<Vec<ExprId>>,
    identity: bool,
}

impl Turn {
    /// The symmetries that `word` has bits for, in order, in one state; `None` if one does not apply in this way.
    pub(crate) fn new(
        program: &Program,
        pool: &mut Pool,
        symmetries: &[usize],
        word: usize,
        state: usize,
    ) -> Option<Self> {
        let mut turn = Self::of_word(program, pool, symmetries, word)?;
        let mut at = state;
        for (_, index) in symmetries.iter().enumerate().filter(|(bit, _)| word >> bit & 1 == 1) {
            at = image_of_state(program, &program.symmetries[*index], at)?;
        }
        let mut levels = vec![0; program.inputs.len()];
        program.states.write(at, &mut levels);
        for (input, _) in program.states.digits() {
            turn.symmetry.levels.push((*input, LevelTerm::Const(levels[input.index()])));
        }
        Some(turn)
    }

    /// The same without the levels of a state: what becomes of numbers and of fetched inputs.
    pub(crate) fn of_word(program: &Program, pool: &mut Pool, symmetries: &[usize], word: usize) -> Option<Self> {
        let first = &program.symmetries[*symmetries.first()?];
        let mut turn = Self {
            symmetry: Symmetry {
                name: String::new(),
                doc: String::new(),
                levels: Vec::new(),
                numbers: Vec::new(),
                result: None,
                span: first.span,
            },
            results: Vec::new(),
            identity: word == 0,
        };
        for (_, index) in symmetries.iter().enumerate().filter(|(bit, _)| word >> bit & 1 == 1) {
            let next = &program.symmetries[*index];
            let levels = next.levels.iter().filter(|(input, _)| program.fetched.contains(*input));
            let levels: Vec<(InputId, LevelTerm)> =
                levels.map(|(input, image)| Some((*input, turn.level(image)?))).collect::<Option<_>>()?;
            let numbers: Vec<(InputId, ExprId)> =
                next.numbers.iter().map(|(input, image)| (*input, turn.number(pool, *image))).collect();
            for (input, image) in levels {
                turn.symmetry.levels.retain(|(known, _)| *known != input);
                turn.symmetry.levels.push((input, image));
            }
            for (input, image) in numbers {
                turn.symmetry.numbers.retain(|(known, _)| *known != input);
                turn.symmetry.numbers.push((input, image));
            }
            turn.results.splice(0..0, next.result.clone());
        }
        Some(turn)
    }

    /// The image of an image.
    fn level(&self, term: &LevelTerm) -> Option<LevelTerm> {
        match term {
            LevelTerm::Input(input) => {
                let known = self.symmetry.levels.iter().find(|(known, _)| known == input);
                Some(known.map_or_else(|| term.clone(), |(_, image)| image.clone()))
            }
            LevelTerm::Map(inner, renaming) => Some(LevelTerm::Map(Arc::new(self.level(inner)?), renaming.clone())),
            LevelTerm::Const(_) | LevelTerm::If(..) => None,
        }
    }

    fn number(&self, pool: &mut Pool, expr: ExprId) -> ExprId {
        match pool.node(expr) {
            Node::Const(_) | Node::Word(_) | Node::Index(_) | Node::Result(_) | Node::Select(..) => expr,
            Node::Input(input) => {
                let known = self.symmetry.numbers.iter().find(|(known, _)| *known == input);
                known.map_or(expr, |(_, image)| *image)
            }
            node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
                let node = node.map(|part| self.number(pool, part));
                pool.settle(node)
            }
        }
    }

    /// Returns whether no symmetry is applied.
    pub(crate) fn is_identity(&self) -> bool {
        self.identity
    }

    /// The view of the inputs.
    pub(crate) fn view(&self) -> View<'_> {
        View { symmetry: Some(&self.symmetry), result: None }
    }

    /// Values at the turned inputs, turned back.
    pub(crate) fn back(&self, machine: &mut Machine<'_>, values: &[ExprId]) -> Vec<ExprId> {
        let turned = values.iter().map(|value| machine.resolve(*value, self.view())).collect();
        mapped(machine, self.results.iter().map(Vec::as_slice), turned)
    }

    /// The result that the program has on the machine's path if it has the symmetries of the word one
    /// after the other.
    pub(crate) fn said(&self, machine: &mut Machine<'_>) -> Vec<ExprId> {
        let (_, values) = machine.run(self.view());
        mapped(machine, self.results.iter().map(Vec::as_slice), values)
    }

    /// The fetched inputs that stand behind one.
    pub(crate) fn sources(&self, pool: &Pool, input: InputId) -> InputSet {
        if let Some((_, image)) = self.symmetry.levels.iter().find(|(known, _)| *known == input) {
            return renamed(image).map_or(InputSet::default(), |(source, _)| InputSet::one(source));
        }
        match self.symmetry.numbers.iter().find(|(known, _)| *known == input) {
            Some((_, image)) => pool.expr_facts(*image).inputs,
            None => InputSet::one(input),
        }
    }
}
