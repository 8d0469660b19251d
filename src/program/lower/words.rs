//! Words: unsigned integers of 32 bits, which wrap.
//!
//! A word is an expression of its own kind. A constant that is whole goes with words as it goes
//! with numbers; nothing else does without a conversion. What languages leave undefined is settled
//! here once for all of them: a divisor is never zero, a word is shifted by less than 32 places,
//! and what becomes a word is limited to what has one.

use super::scope::Env;
use super::terms::{Expected, Term, type_error};
use super::{Lowering, Result};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::operators::{BinaryOp, Comparison, TernaryOp, UnaryOp};
use crate::program::pool::{CondId, ExprId, MAX_WHOLE};
use crate::table::expr::Expr;

/// The largest word.
const MOST: f64 = u32::MAX as f64;

/// The largest `f32` below 2^32, to which real numbers are limited before they become words.
const LARGEST: f64 = 4_294_967_040.0;

/// Places that a word has.
const PLACES: u32 = 32;

impl Lowering<'_> {
    /// Operands as words, if one of them is one, or if the operation has no other ones; then all have to be.
    pub(super) fn words<const N: usize>(
        &mut self,
        terms: [&Term; N],
        required: bool,
        span: Span,
    ) -> Result<Option<[ExprId; N]>> {
        if !required && !terms.iter().any(|term| matches!(term, Term::Word(_))) {
            return Ok(None);
        }
        let mut found = [ExprId::default(); N];
        for (place, term) in found.iter_mut().zip(terms) {
            *place = self.word_of(term, span)?;
        }
        Ok(Some(found))
    }

    /// The word that a term is: of constants, those that are one.
    pub(super) fn word_of(&mut self, term: &Term, span: Span) -> Result<ExprId> {
        if let Term::Word(word) = term {
            return Ok(*word);
        }
        if let Term::Number(number) | Term::Whole(number) = term
            && let Some(value) = self.pool.constant(*number)
        {
            return match value.fract() == 0.0 && (0.0..=MOST).contains(&value) {
                true => Ok(self.pool.constant_word(value as u32)),
                false => Err(Diagnostic::error(codes::DOMAIN, format!("{value} is no U32"))
                    .at(span, format!("a whole number from 0 to {MOST} is expected"))
                    .help("constants are numbers until they meet a U32: `u32(...)` makes one, and what is made of it wraps")),
            };
        }
        let found = self.describe(term);
        let error = Diagnostic::error(codes::TYPE, format!("a U32 and {found} do not go together"));
        let error = error.at(span, "in this operation");
        Err(match term {
            Term::Number(_) => error.help("`u32(...)` is the whole part of a number, `f32(...)` a U32 as a number"),
            Term::Whole(_) => error.help("`u32(...)` makes a U32 of a whole number, `i32(...)` the opposite"),
            Term::Level(set, _) if self.is_integer(*set) => error.help("`u32(...)` makes a U32 of a whole number"),
            Term::Level(..) => error.help("`u32(index(...))` is the place of a level among the others"),
            Term::Bool(_) => error.help("conditions are joined by `&&` and `||`; `u32(...)` of one is 1 or 0"),
            Term::Word(_) | Term::Vector(_) | Term::List(_) | Term::Record(_) => error,
        })
    }

    /// An operation on one operand that is a word, or has to be one.
    pub(super) fn word_unary(&mut self, op: UnaryOp, a: &Term, span: Span) -> Result<Option<Term>> {
        let Some([a]) = self.words([a], op == UnaryOp::WordNot, span)? else { return Ok(None) };
        if op == UnaryOp::WordNot {
            return Ok(Some(Term::Word(self.pool.unary(op, a))));
        }
        let error = no_operation(op.row().notation.name(), span);
        Err(if op == UnaryOp::Negate { error.help("`0 - a` wraps, `~a` inverts the bits") } else { error })
    }

    /// An operation on two operands of which one is a word, or both have to be.
    pub(super) fn word_binary(&mut self, op: BinaryOp, a: &Term, b: &Term, span: Span) -> Result<Option<Term>> {
        let Some([a, b]) = self.words([a, b], op.row().is_on_words, span)? else { return Ok(None) };
        let op = match op {
            BinaryOp::Add => BinaryOp::WordAdd,
            BinaryOp::Subtract => BinaryOp::WordSubtract,
            BinaryOp::Multiply => BinaryOp::WordMultiply,
            BinaryOp::Divide => BinaryOp::WordQuotient,
            BinaryOp::Remainder => BinaryOp::WordRemainder,
            BinaryOp::Max => BinaryOp::WordMax,
            BinaryOp::Min => BinaryOp::WordMin,
            BinaryOp::WordAdd
            | BinaryOp::WordSubtract
            | BinaryOp::WordMultiply
            | BinaryOp::WordQuotient
            | BinaryOp::WordRemainder
            | BinaryOp::WordAnd
            | BinaryOp::WordOr
            | BinaryOp::WordXor
            | BinaryOp::ShiftLeft
            | BinaryOp::ShiftRight
            | BinaryOp::WordMax
            | BinaryOp::WordMin => op,
            BinaryOp::WholeQuotient | BinaryOp::WholeRemainder | BinaryOp::Atan2 | BinaryOp::Pow | BinaryOp::Step => {
                return Err(no_operation(op.row().notation.name(), span));
            }
        };
        let b = if matches!(op, BinaryOp::WordQuotient | BinaryOp::WordRemainder) {
            self.divisor(b, span)?
        } else if matches!(op, BinaryOp::ShiftLeft | BinaryOp::ShiftRight) {
            self.places(b, span)?
        } else {
            b
        };
        Ok(Some(Term::Word(self.pool.binary(op, a, b))))
    }

    /// An operation on three operands of which one is a word.
    pub(super) fn word_ternary(&mut self, op: TernaryOp, terms: [&Term; 3], span: Span) -> Result<Option<Term>> {
        let Some([a, lo, hi]) = self.words(terms, false, span)? else { return Ok(None) };
        if op != TernaryOp::Clamp {
            return Err(no_operation(op.row().notation.name(), span));
        }
        if let (Some(lo), Some(hi)) = (self.pool.word(lo), self.pool.word(hi))
            && lo > hi
        {
            let message = format!("the lower bound {lo} is not below the upper bound {hi}");
            return Err(Diagnostic::error(codes::DOMAIN, message).at(span, "bounds in the wrong order"));
        }
        let raised = self.pool.binary(BinaryOp::WordMax, a, lo);
        Ok(Some(Term::Word(self.pool.binary(BinaryOp::WordMin, raised, hi))))
    }

    /// A divisor, which is not zero.
    fn divisor(&self, divisor: ExprId, span: Span) -> Result<ExprId> {
        let error = || Diagnostic::error(codes::DIVISION_BY_ZERO, "division by zero");
        match (self.pool.word(divisor), self.pool.expr_facts(divisor).range.0 > 0.0) {
            (Some(0), _) => Err(error().at(span, "the divisor is always zero")),
            (_, true) => Ok(divisor),
            (_, false) => Err(error()
                .at(span, "not seen to be different from zero")
                .help("keep it away from zero where it is calculated, as `max(d, 1)` does")),
        }
    }

    /// The places by which a word is shifted, modulo 32 as in WGSL; a constant is less.
    fn places(&mut self, places: ExprId, span: Span) -> Result<ExprId> {
        if let Some(constant) = self.pool.word(places).filter(|places| *places >= PLACES) {
            return Err(Diagnostic::error(codes::DOMAIN, format!("a U32 is shifted by {constant} places"))
                .at(span, format!("it has {PLACES}"))
                .help("calculated places count modulo 32; constant ones are 0 to 31"));
        }
        if self.pool.expr_facts(places).range.1 < f64::from(PLACES) {
            return Ok(places);
        }
        let mask = self.pool.constant_word(PLACES - 1);
        Ok(self.pool.binary(BinaryOp::WordAnd, places, mask))
    }

    /// The condition that a word is one of some.
    pub(super) fn word_among(&mut self, word: ExprId, numbers: &[Spanned<String>]) -> Result<CondId> {
        let mut any = Vec::new();
        for number in numbers {
            let Some(value) = number.value.parse::<f64>().ok() else {
                return Err(type_error(number.span, &format!("`{}`", number.value), "expected a U32"));
            };
            let constant = Term::Number(self.pool.number(value));
            let constant = self.word_of(&constant, number.span)?;
            any.push(self.pool.compare(Comparison::Equal, word, constant));
        }
        Ok(self.pool.or(any))
    }

    /// `u32(number)`, `u32(condition)`.
    pub(super) fn made_word(&mut self, argument: &Expr, env: &Env) -> Result<Term> {
        let term = self.term(argument, env, Expected::Anything)?;
        if let Some(whole) = self.whole_of(&term).filter(|_| self.is_whole(&term)) {
            return Ok(Term::Word(self.pool.unary(UnaryOp::WordOfWhole, whole)));
        }
        match term {
            Term::Word(word) => Ok(Term::Word(word)),
            Term::Number(number) => self.word_of_number(number, argument.span).map(Term::Word),
            Term::Bool(condition) => {
                let (one, zero) = (self.pool.constant_word(1), self.pool.constant_word(0));
                Ok(Term::Word(self.pool.select(condition, one, zero)))
            }
            Term::Level(..) => {
                Err(type_error(argument.span, &self.describe(&term), "expected a number or a condition")
                    .help("`u32(index(...))` is the place of a level among the others"))
            }
            Term::Whole(_) | Term::Vector(_) | Term::List(_) | Term::Record(_) => {
                Err(type_error(argument.span, &self.describe(&term), "expected a number or a condition"))
            }
        }
    }

    /// The whole part of a number, which is limited to the range of words unless it is known to stay there.
    fn word_of_number(&mut self, number: ExprId, span: Span) -> Result<ExprId> {
        if let Some(value) = self.pool.constant(number) {
            return match value > -1.0 && value.trunc() <= MOST {
                true => Ok(self.pool.constant_word(value as u32)),
                false => Err(Diagnostic::error(codes::DOMAIN, format!("{value} is no U32"))
                    .at(span, format!("a number from 0 to {MOST} is expected"))),
            };
        }
        let (lo, hi) = self.pool.expr_facts(number).range;
        let number = match lo >= 0.0 && hi <= LARGEST {
            true => number,
            false => {
                let (least, most) = (self.pool.number(0.0), self.pool.number(LARGEST));
                self.pool.ternary(TernaryOp::Clamp, number, least, most)
            }
        };
        Ok(self.pool.rebuild(crate::program::Node::Unary(UnaryOp::WordOfNumber, number)))
    }

    /// A word as a number, which may be rounded.
    pub(super) fn number_of_word(&mut self, word: ExprId) -> ExprId {
        self.pool.unary(UnaryOp::NumberOfWord, word)
    }

    /// `i32(word)`: a whole number, if it is small enough for one.
    pub(super) fn made_whole(&mut self, argument: &Expr, env: &Env) -> Result<Term> {
        let term = self.term(argument, env, Expected::Anything)?;
        match (&term, self.whole_of(&term)) {
            (Term::Word(word), _) => {
                let number = self.number_of_word(*word);
                match self.pool.expr_facts(*word).range.1 {
                    most if most > MAX_WHOLE => Err(Diagnostic::error(
                        codes::DOMAIN,
                        format!("a U32 that can be {most} is no whole number of a table"),
                    )
                    .at(argument.span, format!("those are at most {MAX_WHOLE}"))
                    .help("limit it, as `i32(v & 0xffff)` does; `f32(v)` is the number, rounded")),
                    _ => Ok(Term::Whole(number)),
                }
            }
            (_, Some(whole)) => Ok(Term::Whole(whole)),
            (_, None) => Err(type_error(argument.span, &self.describe(&term), "expected a U32 or a whole number")),
        }
    }
}

fn no_operation(name: &str, span: Span) -> Diagnostic {
    Diagnostic::error(codes::TYPE, format!("`{name}` is no operation on U32"))
        .at(span, "of a U32 here")
        .help("they have + - * / %, & | ^ ~ << >>, min, max, clamp and comparisons; `f32(...)` makes a number of one")
}
