//! An explanation as text, to be read from top to bottom: the point, the cases
//! that were passed over, the one that was taken, and the sum done by hand.

use std::fmt::Write;

use super::{Explanation, Step, Tested};
use crate::analyse;
use crate::program::{InputId, Program};
use crate::show::{Precision, sentence};

/// Inputs that were filled in with their declared defaults.
pub type Assumed<'a> = &'a [InputId];

/// The whole explanation.
pub fn render(program: &Program, explanation: &Explanation, assumed: Assumed<'_>) -> String {
    let mut out = format!("{}: {}\n", program.name, program.title);
    inputs(&mut out, program, explanation, assumed);
    cases(&mut out, program, explanation);
    taken(&mut out, program, explanation);
    value(&mut out, program, explanation);
    claims(&mut out, program);
    out
}

fn inputs(out: &mut String, program: &Program, explanation: &Explanation, assumed: Assumed<'_>) {
    let given = |id: InputId| explanation.point[id.index()].map(|value| (id, value));
    let given: Vec<_> = program.input_ids().filter_map(|(id, _)| given(id)).collect();
    let width = given.iter().map(|(id, _)| program.inputs[id.index()].name.len()).max().unwrap_or(0);
    let shown: Vec<_> = given.iter().map(|(id, value)| program.inputs[id.index()].show(*value)).collect();
    let value_width = shown.iter().map(String::len).max().unwrap_or(0);
    out.push_str("\ninputs\n");
    for ((id, _), value) in given.iter().zip(&shown) {
        let input = &program.inputs[id.index()];
        let remark = match (assumed.contains(id), input.fetched, explanation.fetched.contains(*id)) {
            (true, ..) => "by default".to_owned(),
            (false, Some(cost), true) => format!("fetched, {cost} texture reads"),
            (false, Some(_), false) => "given, but not needed".to_owned(),
            (false, None, _) => String::new(),
        };
        line(out, &format!("{:width$} = {value:value_width$}  {remark}", input.name));
    }
    let absent = program.input_ids().filter(|(id, _)| explanation.point[id.index()].is_none());
    let absent: Vec<_> = absent.map(|(_, input)| input.name.as_str()).collect();
    if !absent.is_empty() {
        line(out, &format!("not given, and not needed: {}", absent.join(", ")));
    }
}

fn cases(out: &mut String, program: &Program, explanation: &Explanation) {
    out.push_str("\ncases, in order\n");
    let width = program.rows.iter().map(|row| row.id.to_string().len()).max().unwrap_or(0);
    for (row, tested) in program.rows.iter().zip(&explanation.refused) {
        line(out, &format!("case {:width$}: no, {}", row.id, fails(tested)));
    }
    match explanation.row {
        Some(row) => line(out, &format!("case {:width$}: yes", program.rows[row].id)),
        None => line(out, "none matches: the default counts"),
    }
    for row in &explanation.also {
        line(out, &format!("case {:width$}: yes, its items come next", program.rows[*row].id));
    }
}

fn taken(out: &mut String, program: &Program, explanation: &Explanation) {
    let Some(row) = explanation.row.map(|row| &program.rows[row]) else { return };
    let _ = writeln!(out, "\ncase {}{}", row.id, separated(": ", &row.doc));
    line(out, &format!("{}:{}{}", program.source.name, program.line(row.span), separated(", section ", &row.section)));
    for tested in &explanation.guard {
        line(out, &holds(tested));
    }
    for erratum in &row.errata {
        line(out, &format!("erratum {}: printed {:?}, meant {:?}", erratum.number, erratum.printed, erratum.meant));
    }
    if row.lines.len() > 1 || !explanation.refused_lines.is_empty() || !explanation.line_condition.is_empty() {
        out.push_str("\nits lines, in order\n");
        for (number, tested) in explanation.refused_lines.iter().enumerate() {
            line(out, &format!("line {}: no, {}", number + 1, fails(tested)));
        }
        match explanation.line {
            Some(number) => {
                let reasons: Vec<_> = explanation.line_condition.iter().map(holds).collect();
                let why = if reasons.is_empty() { "it has no condition".to_owned() } else { reasons.join(" && ") };
                line(out, &format!("line {}: yes, {why}", number + 1));
                line(out, &format!("{}:{}", program.source.name, program.line(row.lines[number].span)));
            }
            None => line(out, "none applies: the default counts"),
        }
    }
}

fn value(out: &mut String, program: &Program, explanation: &Explanation) {
    if !explanation.steps.is_empty() {
        out.push_str("\nvalue, step by step\n");
        let width = |of: fn(&Step) -> usize, most: usize| explanation.steps.iter().map(of).max().unwrap_or(0).min(most);
        let name_width = width(|s| s.name.chars().count(), 24);
        let formula_width = width(|s| s.formula.chars().count(), 40);
        let numbers_width = width(|s| s.numbers.as_ref().map_or(0, |n| n.chars().count()), 40);
        for step in &explanation.steps {
            let mut text = format!("{:name_width$} = {:formula_width$}", step.name, step.formula);
            match &step.numbers {
                Some(numbers) => {
                    let _ = write!(text, " = {numbers:numbers_width$}");
                }
                None if numbers_width > 0 => {
                    let _ = write!(text, "   {:numbers_width$}", "");
                }
                None => {}
            }
            // A constant or an input by itself needs no second equals sign.
            if step.value != step.formula {
                let _ = write!(text, " = {}", step.value);
            }
            if let Some(because) = &step.because {
                let _ = write!(text, "   {because}");
            }
            line(out, &text);
        }
    }
    let fetched: Vec<_> = explanation.fetched.iter().map(|id| &program.inputs[id.index()]).collect();
    if !program.fetched.is_empty() {
        let names: Vec<_> = fetched.iter().map(|input| input.name.as_str()).collect();
        let cost: f64 = fetched.iter().filter_map(|input| input.fetched).sum();
        let _ = match names.is_empty() {
            true => writeln!(out, "\nfetched: nothing"),
            false => writeln!(out, "\nfetched: {} ({cost} texture reads)", names.join(", ")),
        };
    } else {
        out.push('\n');
    }
    let precision = match explanation.precision {
        Precision::F32 => "f32",
        Precision::F64 => "f64",
    };
    let by = explanation.row.map_or("default".to_owned(), |row| format!("case {}", program.rows[row].id));
    let result = sentence(&program.output, &explanation.values, explanation.precision);
    let _ = writeln!(out, "result:  {result} ({by}, {precision})");
}

/// The claims that are made of what the table computes with, and whether they hold.
fn claims(out: &mut String, program: &Program) {
    let verdicts = analyse::claims(program);
    if verdicts.is_empty() {
        return;
    }
    out.push_str("\nclaims\n");
    let width = verdicts.iter().map(|(claim, _)| claim.name.len()).max().unwrap_or(0);
    for (claim, verdict) in verdicts {
        line(out, &format!("{:width$}: {}{}", claim.name, verdict.words(), separated("; ", &claim.doc)));
    }
}

/// A condition that holds, with the facts unless they only repeat it.
fn holds(tested: &Tested) -> String {
    let facts = tested.facts.join(", ");
    let repeats = |fact: &str| {
        fact == tested.condition.replace(" == ", " is ")
            || fact.strip_suffix(" is true") == Some(&tested.condition)
            || fact.strip_suffix(" is false").is_some_and(|name| tested.condition.strip_prefix('!') == Some(name))
    };
    match facts.is_empty() || (tested.facts.len() == 1 && repeats(&facts)) {
        true => tested.condition.clone(),
        false => format!("{} ({facts})", tested.condition),
    }
}

fn fails(tested: &Tested) -> String {
    match tested.facts.is_empty() {
        true => format!("{} fails", tested.condition),
        false => format!("{} fails ({})", tested.condition, tested.facts.join(", ")),
    }
}

fn separated(separator: &str, text: &str) -> String {
    if text.is_empty() { String::new() } else { format!("{separator}{text}") }
}

fn line(out: &mut String, text: &str) {
    let _ = writeln!(out, "    {}", text.trim_end());
}
