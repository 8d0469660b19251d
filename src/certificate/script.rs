//! A file as it grows: declarations, definitions, and what was met that is not linear.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::Certificate;
use crate::plan::Plan;
use crate::program::{Domain, Input, Program};

/// The text so far.
pub(super) struct Script {
    body: String,
    /// The functions that were declared.
    functions: BTreeSet<String>,
    /// The operations beyond linear arithmetic, in words.
    beyond: BTreeSet<String>,
    definitions: usize,
    /// The symbol of each input.
    pub(super) inputs: Vec<String>,
}

impl Script {
    /// The inputs: levels are integers that count from 0, numbers are real.
    pub(super) fn new(program: &Program) -> Self {
        let symbol = |input: &Input| match input.call {
            // A name with parentheses is no symbol of the language unless it stands between bars.
            Some(_) => format!("|in.{}|", input.name),
            None => format!("in.{}", input.name),
        };
        let inputs = program.inputs.iter().map(symbol).collect();
        let mut script =
            Self { body: String::new(), functions: BTreeSet::new(), beyond: BTreeSet::new(), definitions: 0, inputs };
        for (input, symbol) in program.inputs.iter().zip(script.inputs.clone()) {
            let fetched = if input.fetched.is_some() { "; fetched" } else { "" };
            match &input.domain {
                Domain::Discrete(levels) => {
                    let names = levels.names.iter().enumerate().map(|(number, name)| format!("{number} {name}"));
                    script.comment(&format!("levels: {}{fetched}", names.collect::<Vec<_>>().join(", ")));
                    script.line(&format!("(declare-const {symbol} Int)"));
                    script.line(&format!("(assert (and (<= 0 {symbol}) (< {symbol} {})))", levels.count()));
                }
                // A whole one, but what holds of all numbers holds of them.
                Domain::Word => {
                    script.comment(&format!("a U32{fetched}"));
                    script.line(&format!("(declare-const {symbol} Real)"));
                    script
                        .line(&format!("(assert (and (<= 0.0 {symbol}) (<= {symbol} {})))", real(f64::from(u32::MAX))));
                }
                Domain::Continuous { lo, hi, .. } => {
                    script.comment(&format!("a number{fetched}"));
                    script.line(&format!("(declare-const {symbol} Real)"));
                    script.line(&format!("(assert (and (<= {} {symbol}) (<= {symbol} {})))", real(*lo), real(*hi)));
                }
            }
        }
        script
    }

    pub(super) fn line(&mut self, line: &str) {
        self.body += line;
        self.body.push('\n');
    }

    /// A comment; what would end it is left out.
    pub(super) fn comment(&mut self, text: &str) {
        let text: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
        self.line(&format!("; {text}"));
    }

    /// Names a term, so that what is shared is written once.
    pub(super) fn define(&mut self, sort: &str, term: &str) -> String {
        let name = format!("{}{}", sort.to_lowercase().chars().next().unwrap_or('t'), self.definitions);
        self.definitions += 1;
        self.line(&format!("(define-fun {name} () {sort} {term})"));
        name
    }

    /// A function of numbers of which nothing is known but that equal operands give equal results.
    pub(super) fn function(&mut self, name: &str, arity: usize) -> String {
        let symbol = format!("fn.{name}");
        if self.functions.insert(symbol.clone()) {
            self.beyond(&format!("`{name}` is an unknown function of its operands"));
            let operands = vec!["Real"; arity].join(" ");
            self.line(&format!("(declare-fun {symbol} ({operands}) Real)"));
        }
        symbol
    }

    /// Notes what linear arithmetic does not reach.
    pub(super) fn beyond(&mut self, what: &str) {
        self.beyond.insert(what.to_owned());
    }

    /// The whole file, which says that one of the differences occurs.
    pub(super) fn finish(mut self, plan: &Plan<'_>, differences: &[String]) -> Certificate {
        self.comment("The difference.");
        self.line(&format!("(assert (or false {}))", differences.join(" ")));
        self.line("(check-sat)");
        let program = plan.program;
        let mut text = String::new();
        let mut say = |line: &str| {
            let _ = writeln!(text, "; {line}");
        };
        say(&format!("Table {}, plan {}: do they differ? `unsat` says that they do not.", program.name, plan.shape));
        say(&format!("Made by umbrage {} from {}.", env!("CARGO_PKG_VERSION"), program.fingerprint()));
        say("Compared in every state, for all numbers of their ranges, as real numbers: the case and its line,");
        say("the value, and that nothing is fetched that the table does not need. Not compared: rounding, and");
        say("that code reads no fetched input before it is fetched.");
        if !plan.reports_case() {
            say("This plan reports another case than the table's; cases are not compared.");
        }
        if plan.assumed {
            say("Only where the assumptions of the table hold.");
        }
        match self.beyond.is_empty() {
            true => say("All of it is linear."),
            false => {
                say("Beyond linear arithmetic:");
                self.beyond.iter().for_each(|what| say(&format!("  {what}")));
            }
        }
        text += "(set-logic ALL)\n";
        text += &self.body;
        Certificate { text, beyond: self.beyond.into_iter().collect() }
    }
}

/// A number, exactly: every double is a decimal with enough places.
pub(super) fn real(value: f64) -> String {
    let digits = format!("{:.1074}", value.abs());
    let digits = digits.trim_end_matches('0');
    let digits = if digits.ends_with('.') { format!("{digits}0") } else { digits.to_owned() };
    if value < 0.0 { format!("(- {digits})") } else { digits }
}

#[cfg(test)]
mod tests {
    use super::real;

    #[test]
    fn numbers_are_exact() {
        assert_eq!(real(0.0), "0.0");
        assert_eq!(real(-2.5), "(- 2.5)");
        assert_eq!(real(0.1), "0.1000000000000000055511151231257827021181583404541015625");
        assert_eq!(real(1e30), "1000000000000000019884624838656.0");
    }
}
