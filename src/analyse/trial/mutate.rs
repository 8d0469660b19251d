//! Seeded mistakes: a table with one small change, of the kinds that are made
//! when a table is copied by hand, and how many of them the analyses notice
//! without knowing the right table.

use crate::analyse::lints::LintLevels;
use crate::analyse::sets::study::Study;
use crate::analyse::values::point::Point;
use crate::diag::{Diagnostic, Failure, Severity};
use crate::points::random::Random;
use crate::program::Program;
use crate::table::expr::{BinaryOp, Expr, ExprKind, UnaryOp};
use crate::table::{Case, CaseBody, Domain, Level, Table};

/// A kind of mistake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mistake {
    /// A level is another one of its set.
    Level,
    /// A condition, or a part of one, is negated.
    Negation,
    /// Two formulas have changed places.
    Exchange,
    /// A case is missing.
    Missing,
    /// A plus is a minus, or the other way round.
    Sign,
    /// A number is another input.
    Input,
}

impl Mistake {
    /// All kinds.
    pub const ALL: [Mistake; 6] =
        [Mistake::Level, Mistake::Negation, Mistake::Exchange, Mistake::Missing, Mistake::Sign, Mistake::Input];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Mistake::Level => "another level",
            Mistake::Negation => "a negated condition",
            Mistake::Exchange => "two formulas exchanged",
            Mistake::Missing => "a missing case",
            Mistake::Sign => "a flipped sign",
            Mistake::Input => "another input",
        }
    }
}

/// The fate of mistakes of one kind.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Tally {
    /// The number that was made.
    pub made: usize,
    /// Changes after which the table gives the same where the assumptions hold.
    pub harmless: usize,
    /// Mistakes that leave no meaningful table.
    pub refused: usize,
    /// Mistakes that raise a warning or an error.
    pub warned: usize,
    /// Mistakes that raise no more than a note.
    pub noted: usize,
    /// Mistakes that only the examples of the table notice.
    pub only_examples: usize,
}

impl Tally {
    /// The mistakes that change something.
    pub fn harmful(&self) -> usize {
        self.made - self.harmless
    }

    /// The mistakes that the analyses notice.
    pub fn caught(&self) -> usize {
        self.refused + self.warned + self.noted
    }
}

/// The number of points of each piece of a table by which a change is judged harmless.
const SAMPLES: usize = 24;

/// Makes `count` mistakes, of each kind as often as of any other, and checks what is said of each.
///
/// # Errors
/// When the table itself has no meaning.
pub fn survey(
    table: &Table,
    count: usize,
    seed: u64,
    mut progress: impl FnMut(usize),
) -> Result<Vec<(Mistake, Tally)>, Failure> {
    let program = Program::check(table)?;
    let mut random = Random::new(seed);
    let points = samples(&program, &mut random);
    let before: Vec<Vec<f64>> = points.iter().map(|point| point.outcome(&program).values).collect();
    let known = said(&program);
    let mut tallies: Vec<(Mistake, Tally)> = Mistake::ALL.into_iter().map(|kind| (kind, Tally::default())).collect();
    for number in 0..count {
        progress(number);
        let (kind, tally) = &mut tallies[number % Mistake::ALL.len()];
        let Some(mutant) = mutant(table, *kind, &mut random) else { continue };
        tally.made += 1;
        let Ok(changed) = Program::check(&mutant) else {
            tally.refused += 1;
            continue;
        };
        let same = |(point, before): (&Point, &Vec<f64>)| {
            let after = point.outcome(&changed).values;
            before.iter().zip(&after).all(|(a, b)| (a - b).abs() < 1e-9)
        };
        if points.iter().zip(&before).all(same) {
            tally.harmless += 1;
            continue;
        }
        let fresh = said(&changed).into_iter().filter(|(_, what)| !known.iter().any(|(_, old)| old == what));
        match fresh.map(|(severity, _)| severity).max() {
            Some(Severity::Warning | Severity::Error) => tally.warned += 1,
            Some(Severity::Note) => tally.noted += 1,
            None if !crate::analyse::findings::examples::findings(&changed).is_empty() => tally.only_examples += 1,
            None => {}
        }
    }
    Ok(tallies)
}

/// The findings of the analyses, examples aside.
fn said(program: &Program) -> Vec<(Severity, String)> {
    let mut without = program.clone();
    without.examples.clear();
    let what = |finding: &Diagnostic| (finding.severity, format!("{} {}", finding.code, finding.message));
    crate::analyse::report(&without, &LintLevels::default()).open.iter().map(what).collect()
}

/// Points where the assumptions hold, some in each piece of the program.
fn samples(program: &Program, random: &mut Random) -> Vec<Point> {
    let mut study = Study::new(program);
    let mut points = Vec::new();
    for piece in study.pieces.clone() {
        let set = study.space.sets.and(piece.set, study.assumed);
        for _ in 0..SAMPLES {
            points.extend(study.space.sample(set, random));
        }
    }
    points
}

/// The table with one mistake, unless there is nowhere to make it.
fn mutant(table: &Table, kind: Mistake, random: &mut Random) -> Option<Table> {
    let mut table = table.clone();
    match kind {
        Mistake::Missing => {
            if table.cases.len() < 2 {
                return None;
            }
            let gone = random.below(table.cases.len());
            table.cases.remove(gone);
        }
        Mistake::Exchange => {
            let places = lines(&table);
            let (a, b) = (places[random.below(places.len())], places[random.below(places.len())]);
            let (first, second) = (value(&table, a)?.clone(), value(&table, b)?.clone());
            if first.kind == second.kind {
                return None;
            }
            *value_mut(&mut table, a)? = second;
            *value_mut(&mut table, b)? = first;
        }
        Mistake::Level | Mistake::Negation | Mistake::Sign | Mistake::Input => {
            let vocabulary = Vocabulary::of(&table);
            let mut count = 0;
            each_site(&mut table, kind, &vocabulary, &mut |_| count += 1);
            if count == 0 {
                return None;
            }
            let chosen = random.below(count);
            let mut number = 0;
            each_site(&mut table, kind, &vocabulary, &mut |expr| {
                if number == chosen {
                    change(expr, kind, &vocabulary, random);
                }
                number += 1;
            });
        }
    }
    Some(table)
}

/// Every line that is written out: case and line.
fn lines(table: &Table) -> Vec<(usize, usize)> {
    let of = |(number, case): (usize, &Case)| match &case.body {
        CaseBody::Rows { lines, .. } => (0..lines.len()).map(|line| (number, line)).collect(),
        CaseBody::Image { .. } => Vec::new(),
    };
    table.cases.iter().enumerate().flat_map(of).collect()
}

fn value(table: &Table, (case, line): (usize, usize)) -> Option<&Expr> {
    match &table.cases[case].body {
        CaseBody::Rows { lines, .. } => lines.get(line).map(|line| &line.value),
        CaseBody::Image { .. } => None,
    }
}

fn value_mut(table: &mut Table, (case, line): (usize, usize)) -> Option<&mut Expr> {
    match &mut table.cases[case].body {
        CaseBody::Rows { lines, .. } => lines.get_mut(line).map(|line| &mut line.value),
        CaseBody::Image { .. } => None,
    }
}

/// The words that can stand for each other.
struct Vocabulary {
    /// The levels of each discrete input.
    levels: Vec<(String, Vec<String>)>,
    /// The continuous inputs.
    numbers: Vec<String>,
}

impl Vocabulary {
    fn of(table: &Table) -> Self {
        let names = |levels: &[Level]| levels.iter().map(|level| level.name.value.clone()).collect::<Vec<_>>();
        let mut levels: Vec<(String, Vec<String>)> =
            table.levels.iter().map(|(name, list)| (name.value.clone(), names(list))).collect();
        for input in &table.inputs {
            let known = match &input.domain.value {
                Domain::Levels(list) => names(list),
                Domain::LevelsOf(of) => {
                    levels.iter().find(|(name, _)| *name == of.value).map_or_else(Vec::new, |(_, list)| list.clone())
                }
                Domain::Bool | Domain::Int(..) | Domain::Range(..) | Domain::U32 => continue,
            };
            levels.push((input.name.value.clone(), known));
        }
        let numbers = table.inputs.iter().filter(|input| matches!(input.domain.value, Domain::Range(..)));
        Self { levels, numbers: numbers.map(|input| input.name.value.clone()).collect() }
    }

    /// The other levels that can stand where `level` of `of` does.
    fn others(&self, of: &Expr, level: &str) -> Vec<String> {
        let named = of.name().and_then(|name| self.levels.iter().find(|(input, _)| input == name));
        let has = |(_, list): &&(String, Vec<String>)| list.iter().any(|known| known == level);
        let found = named.filter(|set| has(set)).or_else(|| self.levels.iter().find(has));
        found.map_or_else(Vec::new, |(_, list)| list.iter().filter(|other| *other != level).cloned().collect())
    }
}

/// Goes through the places where a mistake can be made.
fn each_site(table: &mut Table, kind: Mistake, vocabulary: &Vocabulary, act: &mut dyn FnMut(&mut Expr)) {
    for case in &mut table.cases {
        let CaseBody::Rows { when, lines, .. } = &mut case.body else { continue };
        each(when, true, kind, vocabulary, act);
        for line in lines {
            each(&mut line.value, false, kind, vocabulary, act);
            if let Some(condition) = &mut line.condition {
                each(condition, true, kind, vocabulary, act);
            }
        }
    }
}

fn each(expr: &mut Expr, condition: bool, kind: Mistake, vocabulary: &Vocabulary, act: &mut dyn FnMut(&mut Expr)) {
    let fits = match (kind, &expr.kind) {
        (Mistake::Level, ExprKind::In(of, levels)) => {
            levels.iter().any(|level| !vocabulary.others(of, &level.value).is_empty())
        }
        (Mistake::Level, ExprKind::Binary(BinaryOp::Equal | BinaryOp::NotEqual, of, level)) => {
            level.name().is_some_and(|level| !vocabulary.others(of, level).is_empty())
        }
        (Mistake::Negation, _) => condition,
        (Mistake::Sign, ExprKind::Binary(BinaryOp::Add | BinaryOp::Subtract, ..)) => !condition,
        (Mistake::Input, ExprKind::Name(name)) => vocabulary.numbers.len() > 1 && vocabulary.numbers.contains(name),
        _ => false,
    };
    let logical =
        matches!(expr.kind, ExprKind::Binary(BinaryOp::And | BinaryOp::Or, ..) | ExprKind::Unary(UnaryOp::Not, _));
    if kind != Mistake::Negation || logical {
        for part in expr.parts_mut() {
            each(part, condition, kind, vocabulary, act);
        }
    }
    if fits {
        act(expr);
    }
}

fn change(expr: &mut Expr, kind: Mistake, vocabulary: &Vocabulary, random: &mut Random) {
    let mut pick = |list: &[String]| list[random.below(list.len())].clone();
    match (&mut expr.kind, kind) {
        (ExprKind::In(of, levels), Mistake::Level) => {
            let choices: Vec<(usize, Vec<String>)> = levels
                .iter()
                .enumerate()
                .map(|(place, level)| (place, vocabulary.others(of, &level.value)))
                .filter(|(_, others)| !others.is_empty())
                .collect();
            let places: Vec<String> = choices.iter().map(|(place, _)| place.to_string()).collect();
            let chosen = pick(&places);
            if let Some((place, others)) = choices.iter().find(|(place, _)| place.to_string() == chosen) {
                levels[*place].value = pick(others);
            }
        }
        (ExprKind::Binary(_, of, level), Mistake::Level) => {
            if let ExprKind::Name(name) = &mut level.kind {
                *name = pick(&vocabulary.others(of, name));
            }
        }
        (ExprKind::Binary(op, ..), Mistake::Sign) => {
            *op = if *op == BinaryOp::Add { BinaryOp::Subtract } else { BinaryOp::Add };
        }
        (ExprKind::Name(name), Mistake::Input) => {
            let others: Vec<String> = vocabulary.numbers.iter().filter(|other| *other != name).cloned().collect();
            *name = pick(&others);
        }
        _ => {
            let span = expr.span;
            let inner = std::mem::replace(expr, Expr { span, kind: ExprKind::Number(0.0) });
            *expr = Expr { span, kind: ExprKind::Unary(UnaryOp::Not, Box::new(inner)) };
        }
    }
}
