//! Cases, lines and examples.

use super::levels::Expected;
use super::{Finder, Kind};
use crate::diag::Spanned;
use crate::table::expr::Expr;
use crate::table::{Case, CaseBody, Example, Line, Output};

impl<'t> Finder<'t> {
    /// Enters cases, so that those further up can refer to those further down.
    pub(super) fn declare_cases(&mut self, cases: &'t [Case]) {
        self.cases.clear();
        for case in cases {
            let name = Spanned::new(case.id.span, case.id.value.to_string());
            let symbol = self.declare(Kind::Case, &name, case.span, &case.doc);
            self.symbols[symbol.0].whole = case.span;
            self.cases.entry(case.id.value).or_insert(symbol);
        }
    }

    /// Looks through the cases of a table or a function, and what is the result where none applies.
    pub(super) fn rows(&mut self, cases: &'t [Case], default: &'t Expr, result: Expected<'t>) {
        for case in cases {
            match &case.body {
                CaseBody::Rows { when, lines, images } => {
                    self.expr(when, Expected::Anything);
                    self.lines(lines, result);
                    images.iter().for_each(|name| self.mention_symmetry(name));
                }
                CaseBody::Image { case, under, .. } => {
                    if let Some(symbol) = self.cases.get(&case.value).copied() {
                        self.mention(case.span, &case.value.to_string(), symbol);
                    }
                    under.iter().for_each(|name| self.mention_symmetry(name));
                }
            }
            case.examples.iter().for_each(|example| self.example(example, result));
        }
        self.expr(default, result);
    }

    pub(super) fn lines(&mut self, lines: &'t [Line], result: Expected<'t>) {
        for line in lines {
            self.expr(&line.value, result);
            if let Some(condition) = &line.condition {
                self.expr(condition, Expected::Anything);
            }
        }
    }

    pub(super) fn example(&mut self, example: &'t Example, result: Expected<'t>) {
        self.given(&example.inputs);
        self.expr(&example.value, result);
    }

    fn mention_symmetry(&mut self, name: &Spanned<String>) {
        if let Some(symmetry) = self.symmetries.get(name.value.as_str()).copied() {
            self.mention(name.span, &name.value, symmetry);
        }
    }

    /// The surroundings of a result of the table.
    pub(super) fn result(output: &'t Output<Spanned<String>>) -> Expected<'t> {
        Expected::Result(output)
    }
}
