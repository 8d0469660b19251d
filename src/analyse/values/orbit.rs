//! The say of a point's images under the declared symmetries about the value
//! there, and which of them is the odd one out.

use super::point::{Outcome, Point};
use crate::analyse::sets::space::View;
use crate::analyse::sets::study::Study;
use crate::eval::Interpreter;
use crate::program::{ExprId, Node, Pool, Program};

/// Most images of one point that are looked at.
const MAX_MEMBERS: usize = 128;

/// The result that a point has if it has some symmetries one after the other, and its image this result.
fn said(program: &Program, path: &[usize], image: &[f64]) -> Vec<f64> {
    let maps = path.iter().rev().filter_map(|number| program.symmetries[*number].result.as_ref());
    let mut interpreter = Interpreter::<f64>::new(program);
    maps.fold(image.to_vec(), |values, map| interpreter.mapped(map, &values))
}

/// An image of a point.
pub(in crate::analyse) struct Member {
    pub(in crate::analyse) point: Point,
    pub(in crate::analyse) outcome: Outcome,
    /// The values that the first point must have for this one to be right.
    pub(in crate::analyse) says: Vec<f64>,
    /// The symmetries that lead here, as indices into [`Program::symmetries`].
    path: Vec<usize>,
}

/// A point with its images.
pub(in crate::analyse) struct Orbit {
    pub(in crate::analyse) members: Vec<Member>,
    /// The members that agree, most first.
    pub(in crate::analyse) camps: Vec<Vec<usize>>,
}

impl Orbit {
    /// Follows some symmetries from a point, to wherever the assumptions hold.
    pub(in crate::analyse) fn new(program: &Program, start: Point, along: &[usize]) -> Self {
        let pool = &program.pool;
        let outcome = start.outcome(program);
        let first = Member { says: outcome.values.clone(), point: start, outcome, path: Vec::new() };
        let mut members = vec![first];
        let mut next = 0;
        while next < members.len() && members.len() < MAX_MEMBERS {
            for number in along {
                let from = &members[next];
                let point = from.point.image(pool, &program.symmetries[*number]);
                if !point.is_admitted(program) {
                    continue;
                }
                let outcome = point.outcome(program);
                let path: Vec<usize> = from.path.iter().copied().chain([*number]).collect();
                let says = said(program, &path, &outcome.values);
                // A point that is its own image has a say if it contradicts itself.
                let known =
                    |member: &Member| member.point == point && (path.len() > 1 || agree(program, &member.says, &says));
                if members.iter().any(known) {
                    continue;
                }
                members.push(Member { point, outcome, says, path });
            }
            next += 1;
        }
        let mut camps: Vec<Vec<usize>> = Vec::new();
        for (number, member) in members.iter().enumerate() {
            let same = |camp: &&mut Vec<usize>| agree(program, &members[camp[0]].says, &member.says);
            match camps.iter_mut().find(same) {
                Some(camp) => camp.push(number),
                None => camps.push(vec![number]),
            }
        }
        camps.sort_by_key(|camp| std::cmp::Reverse(camp.len()));
        Self { members, camps }
    }

    /// Returns whether all agree.
    pub(in crate::analyse) fn is_unanimous(&self) -> bool {
        self.camps.len() == 1
    }

    /// Returns whether one camp is larger than any other and at least half of all, counted without
    /// the default: nobody wrote it for these inputs.
    pub(in crate::analyse) fn has_majority(&self) -> bool {
        let written =
            |camp: &[usize]| camp.iter().filter(|member| self.members[**member].outcome.row.is_some()).count();
        let first = written(&self.camps[0]);
        let others = || self.camps[1..].iter().map(|camp| written(camp));
        first > 0 && first >= others().sum() && others().all(|other| first > other)
    }

    /// The nearest member that disagrees with the first, of the largest camp if that is not the first's own.
    pub(in crate::analyse) fn opponent(&self) -> Option<&Member> {
        let own = self.camps.iter().position(|camp| camp.contains(&0))?;
        let other = if own == 0 { self.camps.get(1)? } else { &self.camps[0] };
        other.iter().min().map(|number| &self.members[*number])
    }

    /// The cases and lines in a camp, each once.
    pub(in crate::analyse) fn places(&self, camp: usize) -> Vec<(Option<usize>, Option<usize>)> {
        let members = self.camps[camp].iter().map(|member| &self.members[*member].outcome);
        let mut places: Vec<_> = members.map(|outcome| (outcome.row, outcome.line)).collect();
        places.sort_unstable();
        places.dedup();
        places
    }
}

/// Returns whether two results mean the same.
pub(in crate::analyse) fn agree(program: &Program, a: &[f64], b: &[f64]) -> bool {
    let [a, b] = [a, b].map(|values| {
        let mut values = values.to_vec();
        program.output.sort(&mut values, &|value| Some(*value));
        values
    });
    a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9)
}

/// The value that the first point of an orbit would need to agree with one of its
/// images: the value there, in terms of the first point.
pub(in crate::analyse) fn expected(study: &mut Study<'_>, member: &Member) -> Option<Vec<ExprId>> {
    let program = study.program;
    let mut view = View::PLAIN;
    for number in &member.path {
        let symmetry = &program.symmetries[*number];
        view = study.space.view(&symmetry.levels, &symmetry.numbers, view);
    }
    let row = member.outcome.row.map(|row| &program.rows[row]);
    let line = row.zip(member.outcome.line).map(|(row, line)| &row.lines[line]);
    let values = line.map_or(&program.default, |line| &line.values);
    let images = values.iter().map(|value| {
        let chosen = chosen(&mut study.space.pool, *value, &member.point);
        let parts = study.space.parts(chosen, view);
        let (_, image) = parts.first()?;
        Some(crate::analyse::words::bare(&study.space, *image))
    });
    let images: Vec<ExprId> = images.collect::<Option<_>>()?;
    let maps = member.path.iter().rev().filter_map(|number| program.symmetries[*number].result.as_ref());
    Some(maps.fold(images, |values, map| study.space.with_result(map, &values)))
}

/// A value with its selections decided at a point.
pub(in crate::analyse) fn chosen(pool: &mut Pool, value: ExprId, point: &Point) -> ExprId {
    if !pool.expr_facts(value).selects {
        return value;
    }
    match pool.node(value) {
        Node::Const(_) | Node::Word(_) | Node::Input(_) | Node::Result(_) => value,
        Node::Index(input) => pool.number(f64::from(point.levels[input.index()])),
        node @ (Node::Unary(..) | Node::Binary(..) | Node::Ternary(..)) => {
            let node = node.map(|part| chosen(pool, part, point));
            pool.fold(node)
        }
        Node::Select(condition, a, b) => {
            let taken = if point.holds(pool, condition) { a } else { b };
            chosen(pool, taken, point)
        }
    }
}
