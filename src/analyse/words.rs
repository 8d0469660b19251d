//! The words of findings: inputs as `explain` takes them, sets of inputs as
//! conditions, formulas, lists.

use super::sets::Set;
use super::sets::space::Space;
use super::values::point::{Point, Witness};
use crate::eval::Interpreter;
use crate::program::normal::{Affine, Term};
use crate::program::print::Printer;
use crate::program::rational::Rational;
use crate::program::{Domain, ExprId, Input, InputId, InputSet, LevelSet, Node, Program, TernaryOp, Value};

/// Inputs in the form that `explain --at` takes. Numbers and fetched inputs are
/// left out unless they are among the `relevant` ones, or have to be given so that
/// there is a result. `None` if nothing is known of numbers that matter.
pub(super) fn at(program: &Program, witness: &Witness, relevant: InputSet) -> Option<String> {
    let relevant = relevant.or(asked_for(program, witness, relevant));
    let mut parts = Vec::new();
    for (id, input) in program.input_ids() {
        let needed = relevant.contains(id) || (input.default.is_none() && input.fetched.is_none());
        let value = match &input.domain {
            Domain::Discrete(_) => match witness.levels[id.index()] {
                Some(level) if needed || input.fetched.is_none() => Some(Value::Level(level)),
                // Any will do.
                None if needed => Some(input.default.unwrap_or(Value::Level(0))),
                Some(_) | None => None,
            },
            Domain::Continuous { .. } | Domain::Word => {
                if needed && !witness.certain {
                    return None;
                }
                needed.then(|| Value::Number(witness.numbers[id.index()].unwrap_or_else(|| input.least())))
            }
        };
        match value {
            Some(value) if input.default != Some(value) || matches!(value, Value::Number(_)) => {
                parts.push(format!("{}={}", input.name, input.show(value)))
            }
            _ => {}
        }
    }
    Some(if parts.is_empty() { "the defaults of all inputs".to_owned() } else { parts.join(",") })
}

/// The inputs without which `explain` would not come to the case and line that a point leads to: what is fetched on
/// the way, and numbers, if with their defaults the way were another one.
fn asked_for(program: &Program, witness: &Witness, relevant: InputSet) -> InputSet {
    let Point { levels, numbers } = Point::of(program, witness);
    let value = |(id, input): (InputId, &Input)| match input.domain {
        Domain::Discrete(_) => Some(Value::Level(levels[id.index()])),
        Domain::Continuous { .. } | Domain::Word => Some(Value::Number(numbers[id.index()])),
    };
    let point: Vec<Option<Value>> = program.input_ids().map(value).collect();
    let mut interpreter = Interpreter::<f64>::new(program);
    let mut way = |point: &[Option<Value>]| interpreter.evaluate(point).map(|o| (o.row, o.line, o.fetched)).ok();
    let here = way(&point);
    let fetched = here.map_or(InputSet::default(), |(_, _, fetched)| fetched);
    // What is fetched is given, and has no default any more.
    let given = relevant.or(fetched);
    let plain = |(id, input): (InputId, &Input)| match input.domain {
        Domain::Continuous { .. } | Domain::Word if !given.contains(id) => input.default.or(point[id.index()]),
        Domain::Continuous { .. } | Domain::Word | Domain::Discrete(_) => point[id.index()],
    };
    let plain: Vec<Option<Value>> = program.input_ids().map(plain).collect();
    if here == way(&plain) || !witness.certain {
        return fetched;
    }
    let numbers = program.input_ids().filter(|(id, input)| input.fetched.is_none() && program.levels(*id).is_none());
    numbers.fold(fetched, |all, (id, _)| all.or(InputSet::one(id)))
}

/// The inputs that a row mentions.
pub(super) fn mentioned(program: &Program, row: usize) -> InputSet {
    let (row, pool) = (&program.rows[row], &program.pool);
    row.lines.iter().fold(pool.cond_facts(row.guard).inputs, |all, line| {
        let values = line.values.iter().fold(all, |all, value| all.or(pool.expr_facts(*value).inputs));
        values.or(pool.cond_facts(line.condition).inputs)
    })
}

/// A set of states as conditions, at most `most` of them; `None` for more than
/// that. The last part says how many states are left over.
pub(super) fn conditions(space: &mut Space<'_>, set: Set, most: usize) -> Vec<String> {
    let patterns = space.sets.patterns(set, most);
    patterns.iter().map(|pattern| condition(space, pattern)).collect()
}

/// Levels of digits as a condition in table notation.
pub(super) fn condition(space: &mut Space<'_>, pattern: &[(usize, LevelSet)]) -> String {
    let program = space.program;
    let parts = pattern.iter().filter_map(|(digit, levels)| {
        let Some(input) = space.input_of(*digit) else {
            let form = space.form_of(*digit)?;
            return Some(comparison(program, form, *levels));
        };
        let count = program.levels(input)?.count();
        let condition = space.pool.level(input, *levels, count);
        let printer = Printer { pool: &space.pool, inputs: &program.inputs };
        Some(if pattern.len() == 1 { printer.cond(condition) } else { printer.part(condition) })
    });
    let parts: Vec<String> = parts.collect();
    match parts.is_empty() {
        true => "true".to_owned(),
        false => parts.join(" && "),
    }
}

/// Signs of a form as a comparison: `px > dV`.
fn comparison(program: &Program, form: &Affine, signs: LevelSet) -> String {
    let symbol = ["", ">", "==", ">=", "<", "!=", "<=", ""][(signs.0 & 7) as usize];
    let (mut left, mut right) = (form.clone(), form.clone());
    left.terms.retain(|_, factor| factor.is_positive());
    right.terms.retain(|_, factor| factor.is_negative());
    right.terms.values_mut().for_each(|factor| *factor = -*factor);
    match form.constant.is_positive() {
        true => right.constant = Rational::ZERO,
        false => (left.constant, right.constant) = (Rational::ZERO, -form.constant),
    }
    format!("{} {symbol} {}", affine(program, &left), affine(program, &right))
}

/// A value without the clamp of the output.
pub(super) fn bare(space: &Space<'_>, value: ExprId) -> ExprId {
    let Node::Ternary(TernaryOp::Clamp, inner, lo, hi) = space.pool.node(value) else { return value };
    let bounded = space.pool.constant(lo).is_some() && space.pool.constant(hi).is_some();
    if bounded { inner } else { value }
}

/// Values simplified, as one writes them by hand; for what came about by replacing inputs.
pub(super) fn simplified(space: &mut Space<'_>, values: &[ExprId]) -> String {
    let parts: Vec<String> = values
        .iter()
        .map(|value| {
            let value = bare(space, *value);
            let sayable = |form: &Affine| form.terms.keys().all(has_name);
            let lattice = space.lattice(value).filter(|clauses| {
                clauses.iter().map(Vec::len).sum::<usize>() <= 6 && clauses.iter().flatten().all(sayable)
            });
            match lattice {
                Some(clauses) => {
                    let clause = |parts: &Vec<Affine>| {
                        call("max", parts.iter().map(|part| affine(space.program, part)).collect())
                    };
                    call("min", clauses.iter().map(clause).collect())
                }
                None => Printer { pool: &space.pool, inputs: &space.program.inputs }.expr(value),
            }
        })
        .collect();
    joined(&parts)
}

fn joined(parts: &[String]) -> String {
    match parts {
        [one] => one.clone(),
        several => format!("({})", several.join(", ")),
    }
}

fn call(name: &str, arguments: Vec<String>) -> String {
    let nested = |all: String, next: String| format!("{name}({all}, {next})");
    arguments.into_iter().reduce(nested).unwrap_or_default()
}

/// Returns whether a term of a form can be written as a name.
pub(super) fn has_name(term: &Term) -> bool {
    matches!(term, Term::Input(_))
}

/// `1 + px - dV`
fn affine(program: &Program, form: &Affine) -> String {
    let mut parts: Vec<(bool, String)> = Vec::new();
    let name = |term: &Term| match term {
        Term::Input(input) => program.inputs[input.index()].name.clone(),
        Term::Constant(_) | Term::Unary(..) | Term::Binary(..) | Term::Ternary(..) => "...".to_owned(),
    };
    let constant = (form.constant.is_negative(), number(form.constant.abs()));
    if form.constant.is_positive() {
        parts.push(constant.clone());
    }
    for negative in [false, true] {
        for (term, factor) in form.terms.iter().filter(|(_, factor)| factor.is_negative() == negative) {
            let factor = factor.abs();
            let text = match factor == Rational::ONE {
                true => name(term),
                false => format!("{} * {}", number(factor), name(term)),
            };
            parts.push((negative, text));
        }
    }
    if form.constant.is_negative() || (parts.is_empty() && form.constant.is_zero()) {
        parts.push(constant);
    }
    let mut text = String::new();
    for (negative, part) in parts {
        match (text.is_empty(), negative) {
            (true, false) => {}
            (true, true) => text.push('-'),
            (false, false) => text.push_str(" + "),
            (false, true) => text.push_str(" - "),
        }
        text.push_str(&part);
    }
    text
}

fn number(value: Rational) -> String {
    value.to_f64().to_string()
}

/// `case 4`, `cases 4 and 6`, `cases 4, 5 and 3 more`; `the default` for none.
pub(super) fn cases(program: &Program, rows: &[Option<usize>]) -> String {
    let ids: Vec<String> = rows.iter().flatten().map(|row| program.rows[*row].id.to_string()).collect();
    match (ids.len(), rows.contains(&None)) {
        (0, _) => "the default".to_owned(),
        (1, false) => format!("case {}", ids[0]),
        (_, false) => format!("cases {}", list(&ids)),
        (1, true) => format!("case {} and the default", ids[0]),
        (_, true) => format!("cases {} and the default", list(&ids)),
    }
}

/// A line of a case, or what stands in for one, as an `allow` names it.
pub(super) fn named(program: &Program, place: (Option<usize>, Option<usize>)) -> String {
    match place {
        (Some(row), None) => format!("case {} without a line", program.rows[row].id),
        (Some(_), Some(_)) | (None, _) => called(program, place),
    }
}

/// The same, as it is called in sentences.
pub(super) fn called(program: &Program, (row, line): (Option<usize>, Option<usize>)) -> String {
    match (row.map(|row| &program.rows[row]), line) {
        (Some(row), Some(line)) if row.lines.len() > 1 => format!("line {} of case {}", line + 1, row.id),
        (Some(row), Some(_)) => format!("case {}", row.id),
        (Some(row), None) => format!("case {}, which has no line for this,", row.id),
        (None, _) => "the default".to_owned(),
    }
}

/// `a`, `a and b`, `a, b and c`; of many only the first.
pub(super) fn list(items: &[String]) -> String {
    const SHOWN: usize = 12;
    match items {
        [] => String::new(),
        [one] => one.clone(),
        many if many.len() > SHOWN => format!("{} and {} more", many[..SHOWN].join(", "), many.len() - SHOWN),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}

/// `1 state`, `2 states`.
pub(super) fn states(count: usize) -> String {
    format!("{count} state{}", if count == 1 { "" } else { "s" })
}

/// A number for people: at most four digits after the point.
pub(super) fn short(value: f64) -> String {
    let rounded = (value * 1e4).round() / 1e4;
    (if rounded == 0.0 { 0.0 } else { rounded }).to_string()
}
