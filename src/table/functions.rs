//! Functions of a table, as written: what they are called with, what they
//! return, and what is claimed of them.

use std::sync::Arc;

use serde::Deserialize;

use super::expr::{Expr, ExprKind};
use super::{Assumption, Case, DataFile, Erratum, Example, Line, Named, Table};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::text::raw::{Raw, RawMap, Reader, Shape};

type Result<T> = std::result::Result<T, Diagnostic>;

/// A function that generated code offers.
#[derive(Debug, Clone)]
pub struct Function {
    /// Its name.
    pub name: Spanned<String>,
    /// Section of the source that defines it.
    pub section: String,
    /// One line on what it is.
    pub doc: String,
    /// The inputs of the table that are its parameters, in the order of the generated ones.
    pub parameters: Vec<Spanned<String>>,
    /// Values that it names, each evaluated once.
    pub bindings: Vec<Named>,
    /// Its body.
    pub body: FunctionBody,
    /// Conditions on its parameters; outside of them it is not meant to be used.
    pub domain: Vec<Assumption>,
    /// The claims on its values at particular places.
    pub limits: Vec<Limit>,
    /// The claim on its accuracy.
    pub accuracy: Option<Accuracy>,
    /// Misprints of the source that were mended here, or that are kept.
    pub errata: Vec<Erratum>,
    /// Parameters with the expected result; every executor runs them.
    pub examples: Vec<Example>,
}

/// The body of a function.
#[derive(Debug, Clone)]
pub enum FunctionBody {
    /// One expression.
    Value(Expr),
    /// Cases, like those of a table.
    Cases {
        /// The rows, in the order written.
        cases: Vec<Case>,
        /// The result where no case matches.
        default: Expr,
    },
}

/// A function for use inside the table.
#[derive(Debug, Clone)]
pub struct Helper {
    /// Its name.
    pub name: Spanned<String>,
    /// The names of its arguments.
    pub parameters: Vec<Spanned<String>>,
    /// The lines of its value, of which the first that applies counts; the last one always applies.
    pub lines: Vec<Line>,
}

/// A claim on the value of a function at particular places.
#[derive(Debug, Clone)]
pub struct Limit {
    /// The whole claim.
    pub span: Span,
    /// The parameters that are fixed.
    pub at: Vec<(Spanned<String>, Expr)>,
    /// The value there.
    pub value: Expr,
}

/// A claim on the accuracy of a function in `f32`: the error is at most
/// `times` what half a unit in the last place of each parameter can change,
/// and half a unit in the last place of `scale`.
#[derive(Debug, Clone)]
pub struct Accuracy {
    /// The factor.
    pub times: Spanned<f64>,
    /// The natural size of the result.
    pub scale: Expr,
}

/// Constant data.
#[derive(Debug, Clone)]
pub struct Constant {
    /// Its name.
    pub name: Spanned<String>,
    /// Its value.
    pub value: ConstantValue,
}

/// The value of a constant.
#[derive(Debug, Clone)]
pub enum ConstantValue {
    /// One number.
    Number(Expr),
    /// A list of numbers, or of several numbers each.
    List(Vec<Vec<Expr>>),
    /// A list of levels of a set, or of several levels each.
    Levels {
        /// The set, or an input that has it.
        of: Spanned<String>,
        /// The levels, item by item.
        items: Vec<Vec<Spanned<String>>>,
    },
    /// Numbers in a file, relative to that of the table, and what is in it, once it is read.
    File(Spanned<String>, Option<Arc<DataFile>>),
}

/// Another table whose functions are called in this one.
#[derive(Debug, Clone)]
pub struct Import {
    /// Its name here.
    pub alias: Spanned<String>,
    /// The file, relative to that of this table.
    pub path: Spanned<String>,
    /// The table, once it is read.
    pub table: Option<Arc<Table>>,
}

#[derive(Deserialize)]
#[serde(rename = "Function", deny_unknown_fields)]
pub(super) struct FunctionRon<'a> {
    #[serde(default)]
    section: String,
    #[serde(default)]
    doc: String,
    #[serde(borrow)]
    parameters: Vec<Raw<'a>>,
    #[serde(default = "RawMap::empty", rename = "let")]
    bindings: RawMap<'a>,
    #[serde(default)]
    value: Option<Raw<'a>>,
    #[serde(default)]
    cases: Option<Vec<Raw<'a>>>,
    #[serde(default)]
    default: Option<Raw<'a>>,
    #[serde(default = "RawMap::empty")]
    domain: RawMap<'a>,
    #[serde(default)]
    limits: Vec<Raw<'a>>,
    #[serde(default)]
    error: Option<Raw<'a>>,
    #[serde(default)]
    errata: Vec<Raw<'a>>,
    #[serde(default)]
    examples: Vec<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Limit", deny_unknown_fields)]
pub(super) struct LimitRon<'a> {
    #[serde(borrow)]
    at: RawMap<'a>,
    value: Raw<'a>,
}

#[derive(Deserialize)]
#[serde(rename = "Error", deny_unknown_fields)]
pub(super) struct AccuracyRon<'a> {
    #[serde(borrow)]
    times: Raw<'a>,
    scale: Raw<'a>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum DataRon<'a> {
    File(#[serde(borrow)] Raw<'a>),
    Levels { of: Raw<'a>, values: Vec<Raw<'a>> },
}

impl<'a> Reader<'a> {
    pub(super) fn function(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<Function> {
        let ron: FunctionRon<'a> = self.get(raw)?;
        let name = self.word(name)?;
        let shape = |message: &str| {
            Err(Diagnostic::error(codes::FUNCTION_SHAPE, format!("function `{}`: {message}", name.value))
                .at(name.span, "this function")
                .help("a function has a `value`, or it has `cases` and a `default`"))
        };
        let body = match (ron.value, ron.cases, ron.default) {
            (Some(value), None, None) => FunctionBody::Value(self.expr(value)?),
            (None, Some(cases), Some(default)) => {
                let cases = cases.into_iter().map(|case| self.case(case)).collect::<Result<Vec<_>>>()?;
                if cases.is_empty() {
                    return shape("`cases` is empty");
                }
                if !ron.examples.is_empty() {
                    return shape("`examples` stand in the cases that they are examples of");
                }
                FunctionBody::Cases { cases, default: self.expr(default)? }
            }
            (None, Some(_), None) => return shape("has cases, but no `default`"),
            (None, None, _) => return shape("returns nothing"),
            _ => return shape("fields that exclude each other"),
        };
        let bindings = ron.bindings.0.iter().map(|(n, v)| Ok(Named { name: self.word(*n)?, value: self.expr(*v)? }));
        let limits = ron.limits.into_iter().map(|limit| {
            let span = self.span(limit);
            let limit: LimitRon<'a> = self.get(limit)?;
            let at = limit.at.0.iter().map(|(n, v)| Ok((self.word(*n)?, self.expr(*v)?))).collect::<Result<_>>()?;
            Ok(Limit { span, at, value: self.expr(limit.value)? })
        });
        let accuracy = ron.error.map(|raw| {
            let ron: AccuracyRon<'a> = self.get(raw)?;
            let times = self.spanned::<f64>(ron.times)?;
            if !(times.value > 0.0 && times.value.is_finite()) {
                let error = Diagnostic::error(codes::DOMAIN, "`times` is a positive number");
                return Err(error.at(times.span, "in this claim of accuracy"));
            }
            Ok(Accuracy { times, scale: self.expr(ron.scale)? })
        });
        Ok(Function {
            section: ron.section,
            doc: ron.doc,
            parameters: ron.parameters.into_iter().map(|p| self.word(p)).collect::<Result<_>>()?,
            bindings: bindings.collect::<Result<_>>()?,
            body,
            domain: ron.domain.0.iter().map(|(n, v)| self.assumption(*n, *v)).collect::<Result<_>>()?,
            limits: limits.collect::<Result<_>>()?,
            accuracy: accuracy.transpose()?,
            errata: ron.errata.into_iter().map(|e| self.erratum(e)).collect::<Result<_>>()?,
            examples: ron.examples.into_iter().map(|e| self.example(e)).collect::<Result<_>>()?,
            name,
        })
    }

    /// `"sinc(x)": "..."` or `"sinc(x)": [("...", "abs(x) < 1"), "sin(x) / x"]`
    pub(super) fn helper(&self, signature: Raw<'a>, raw: Raw<'a>) -> Result<Helper> {
        let (name, parameters) = self.called(signature, "a helper", "\"sinc(x)\"")?;
        let lines = match self.shape(raw) {
            Shape::List => {
                self.get::<Vec<Raw<'a>>>(raw)?.into_iter().map(|line| self.line(line)).collect::<Result<Vec<_>>>()?
            }
            _ => vec![Line { value: self.expr(raw)?, condition: None }],
        };
        let shape = |message: String, at: Span, label: &str| {
            Err(Diagnostic::error(codes::FUNCTION_SHAPE, message)
                .at(at, label)
                .help("the first line that applies counts; the last one, and only that, has no condition"))
        };
        let always = lines.iter().position(|line| line.condition.is_none());
        match always {
            None => shape(format!("`{}` may come to no value", name.value), self.span(raw), "no line always applies"),
            Some(at) if at + 1 < lines.len() => {
                shape(format!("`{}`: a line that is never reached", name.value), lines[at + 1].value.span, "this line")
            }
            Some(_) => Ok(Helper { name, parameters, lines }),
        }
    }

    /// A name with parameters, declared as it is called.
    pub(super) fn called(
        &self,
        raw: Raw<'a>,
        what: &str,
        such_as: &str,
    ) -> Result<(Spanned<String>, Vec<Spanned<String>>)> {
        let malformed = || {
            Diagnostic::error(codes::FUNCTION_SHAPE, format!("this is not how {what} is declared"))
                .at(self.span(raw), "expected a name and its parameters")
                .help(format!("write it as it is called, for instance {such_as}"))
        };
        let ExprKind::Call(name, arguments) = self.expr(raw).map_err(|_| malformed())?.kind else {
            return Err(malformed());
        };
        let parameters = arguments.into_iter().map(|argument| match argument.kind {
            ExprKind::Name(name) => Ok(Spanned::new(argument.span, name)),
            _ => Err(malformed()),
        });
        Ok((name, parameters.collect::<Result<_>>()?))
    }

    /// Constant data, and whether version 1 of the language has it.
    pub(super) fn constant(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<(Constant, bool)> {
        let mut is_early = true;
        let value = match self.shape(raw) {
            Shape::List => {
                let items = self.get::<Vec<Raw<'a>>>(raw)?.into_iter().map(|item| match self.shape(item) {
                    Shape::Tuple => self.numbers(item),
                    Shape::List => {
                        is_early = false;
                        self.get::<Vec<Raw<'a>>>(item)?.into_iter().map(|number| self.expr(number)).collect()
                    }
                    _ => Ok(vec![self.expr(item)?]),
                });
                ConstantValue::List(items.collect::<Result<_>>()?)
            }
            Shape::Variant("Levels" | "File") => match self.get(raw)? {
                DataRon::File(path) => {
                    is_early = false;
                    ConstantValue::File(self.spanned(path)?, None)
                }
                DataRon::Levels { of, values } => {
                    is_early = false;
                    let items = values.into_iter().map(|item| match self.shape(item) {
                        Shape::List => {
                            self.get::<Vec<Raw<'a>>>(item)?.into_iter().map(|level| self.word(level)).collect()
                        }
                        _ => Ok(vec![self.word(item)?]),
                    });
                    let items = items.collect::<Result<Vec<Vec<_>>>>()?;
                    let width = items.first().map_or(0, Vec::len);
                    if let Some(odd) = items.iter().find(|item| item.len() != width || width == 0) {
                        let at = odd.first().map_or(self.span(raw), |level| level.span);
                        return Err(Diagnostic::error(codes::STRUCTURE, "items that differ in length")
                            .at(at, format!("not {width} levels")));
                    }
                    ConstantValue::Levels { of: self.word(of)?, items }
                }
            },
            _ => ConstantValue::Number(self.expr(raw)?),
        };
        Ok((Constant { name: self.word(name)?, value }, is_early))
    }

    /// `(0.5, "1 / 3")`: two to four numbers.
    fn numbers(&self, raw: Raw<'a>) -> Result<Vec<Expr>> {
        let parts: Vec<Raw<'a>> = match self.get::<(Raw<'a>, Raw<'a>)>(raw) {
            Ok((a, b)) => vec![a, b],
            Err(_) => match self.get::<(Raw<'a>, Raw<'a>, Raw<'a>)>(raw) {
                Ok((a, b, c)) => vec![a, b, c],
                Err(_) => {
                    let (a, b, c, d) = self.get::<(Raw<'a>, Raw<'a>, Raw<'a>, Raw<'a>)>(raw).map_err(|_| {
                        Diagnostic::error(codes::STRUCTURE, "an item of constant data has one to four numbers")
                            .at(self.span(raw), "this item")
                    })?;
                    vec![a, b, c, d]
                }
            },
        };
        parts.into_iter().map(|part| self.expr(part)).collect()
    }

    pub(super) fn import(&self, alias: Raw<'a>, path: Raw<'a>) -> Result<Import> {
        Ok(Import { alias: self.word(alias)?, path: self.spanned::<String>(path)?, table: None })
    }
}
