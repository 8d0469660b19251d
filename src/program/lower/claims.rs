//! Claims → pairs of expressions, in a program of their own.
//!
//! They are about constants, helpers and functions, and hold for all values of some inputs. So
//! what they are made of has every input of the table, whichever of them a function takes, and
//! no rows: nothing is built of it.

use super::scope::Env;
use super::terms::{Expected, Term};
use super::wide::{AllCuts, refined};
use super::{Lowering, Programs, Result, keep, once};
use crate::diag::{Diagnostic, Span, codes};
use crate::program::bits::InputSet;
use crate::program::domain::StateSpace;
use crate::program::pool::ExprId;
use crate::program::{Claim, ClaimedPair, Claims, InputId, Output, Program, Written};
use crate::table::{self, HitPolicy, Table, names};

/// The claims of a table whose declarations are sound; none if it makes none.
pub(super) fn claims(table: &Table, programs: Programs, errors: &mut Vec<Diagnostic>) -> Option<Box<Claims>> {
    if table.claims.is_empty() {
        return None;
    }
    let (claims, found) = refined(|cuts| lowered(table, programs.clone(), cuts));
    errors.extend(found);
    claims
}

/// The claims with the mistakes in them, and the cuts of wide integers that they still need.
fn lowered(table: &Table, programs: Programs, cuts: &AllCuts) -> ((Option<Box<Claims>>, Vec<Diagnostic>), AllCuts) {
    let mut lowering = Lowering::new(table, programs, cuts);
    let inputs: Vec<&table::Input> = table.inputs.iter().collect();
    // What is wrong with the declarations was said before.
    lowering.declare(&inputs, &mut Vec::new());
    let mut found = Vec::new();
    let mut all: Vec<Claim> = Vec::new();
    for (index, claim) in table.claims.iter().enumerate() {
        let name = &claim.name;
        if let Some(first) = table.claims[..index].iter().find(|other| other.name.value == name.value) {
            let error = Diagnostic::error(codes::DUPLICATE, format!("two claims are called `{}`", name.value));
            found.push(error.at(name.span, "again").at(first.name.span, "first here"));
        }
        all.extend(keep(lowering.claim(claim), &mut found));
    }
    once(&mut found);
    let wanted = std::mem::take(&mut lowering.wanted);
    let Ok(states) = StateSpace::new(&[]) else { return ((None, found), wanted) };
    let nothing = lowering.pool.number(0.0);
    let program = Program {
        source: table.source.clone(),
        imported: lowering.imported(),
        name: table.name.value.clone(),
        title: table.title.clone(),
        origin: table.origin.clone(),
        hit_policy: HitPolicy::First,
        hit_policy_span: table.name.span,
        fetched: lowering.fetched(),
        output: Output::Number(None),
        inputs: lowering.inputs,
        states,
        pool: lowering.pool,
        rows: Vec::new(),
        default: vec![nothing],
        default_span: table.name.span,
        assumptions: Vec::new(),
        draw: Vec::new(),
        symmetries: Vec::new(),
        examples: Vec::new(),
        function: None,
        continuity: Vec::new(),
        claims: None,
        allow: Vec::new(),
        exhibit: None,
        written: Written::default(),
        decided: Vec::new(),
    };
    ((Some(Box::new(Claims { program, all })), found), wanted)
}

impl Lowering<'_> {
    fn claim(&mut self, claim: &table::Claim) -> Result<Claim> {
        names::check_inner(&claim.name.value, "a claim", claim.name.span)?;
        let mut inputs = Vec::new();
        for name in &claim.inputs {
            let Some(input) = self.input_named(&name.value) else {
                return Err(self.unknown_input(name, "claimed for all values of this"));
            };
            if self.inputs[input.index()].fetched.is_some() {
                let message = format!("a claim for all values of `{}`, which is fetched", name.value);
                return Err(Diagnostic::error(codes::PARAMETER, message)
                    .at(name.span, "claims are about constants, helpers and functions"));
            }
            inputs.push(input);
        }
        let env = Env::default();
        let (left, right) = self.alternatives(&claim.left, &claim.right, &env, Expected::Anything)?;
        let (mut a, mut b) = (Vec::new(), Vec::new());
        self.claimed(left.clone(), "", claim.left.span, &mut a)?;
        self.claimed(right.clone(), "", claim.right.span, &mut b)?;
        if !a.iter().map(|(part, _)| part).eq(b.iter().map(|(part, _)| part)) {
            let message = format!("{} and {} do not go together", self.describe(&left), self.describe(&right));
            return Err(Diagnostic::error(codes::TYPE, message).at(claim.span, "in this claim"));
        }
        let by = claim.by.as_ref().map(|by| self.numeric(by, &env)).transpose()?;
        if let (Some(by), Some(written)) = (by.and_then(|by| self.pool.constant(by)), &claim.by)
            && by < 0.0
        {
            let error = Diagnostic::error(codes::DOMAIN, "two values cannot differ by less than nothing");
            return Err(error.at(written.span, "a tolerance is zero or more"));
        }
        let all = inputs.iter().fold(InputSet::default(), |all, input| all.or(InputSet::one(*input)));
        let parts = a.iter().chain(&b).map(|(_, part)| *part).chain(by);
        let needed = parts.map(|part| self.pool.expr_facts(part).inputs).fold(InputSet::default(), InputSet::or);
        if let Some(input) = needed.minus(all).iter().next() {
            return Err(self.unclaimed(claim, input));
        }
        let pairs = a.into_iter().zip(b).map(|((part, left), (_, right))| ClaimedPair { part, left, right });
        Ok(Claim {
            name: claim.name.value.clone(),
            doc: claim.doc.clone(),
            span: claim.span,
            pairs: pairs.collect(),
            by,
            inputs,
        })
    }

    fn unclaimed(&self, claim: &table::Claim, input: InputId) -> Diagnostic {
        let name = &self.inputs[input.index()].name;
        let error =
            Diagnostic::error(codes::NOT_CONSTANT, format!("the claim depends on `{name}`")).at(claim.span, "here");
        match self.inputs[input.index()].fetched {
            None => error.help(format!("claim it for all values: `for: [\"{name}\"]`")),
            Some(_) => error.help("claims are about constants, helpers and functions"),
        }
    }

    /// The numbers that a value consists of, each with what it is called in it; a condition is 1 or 0.
    fn claimed(&mut self, term: Term, part: &str, span: Span, all: &mut Vec<(String, ExprId)>) -> Result<()> {
        match term {
            Term::Number(number) | Term::Whole(number) => all.push((part.to_owned(), number)),
            // Claims are decided in `f64`, which has all words as numbers.
            Term::Word(word) => all.push((part.to_owned(), self.number_of_word(word))),
            Term::Bool(condition) => {
                let (one, zero) = (self.pool.number(1.0), self.pool.number(0.0));
                all.push((part.to_owned(), self.pool.select(condition, one, zero)));
            }
            Term::Level(set, level) => {
                let number = self.level_number(set, &level, |_, level| f64::from(level));
                all.push((part.to_owned(), number));
            }
            Term::Vector(parts) => {
                all.extend(
                    parts
                        .into_iter()
                        .zip(["x", "y", "z", "w"])
                        .map(|(number, letter)| (format!("{part}.{letter}"), number)),
                );
            }
            Term::Record(parts) => {
                for (name, term) in parts {
                    self.claimed(term, &format!("{part}.{name}"), span, all)?;
                }
            }
            Term::List(_) => {
                return Err(super::terms::type_error(span, "a list", "expected numbers, conditions or levels"));
            }
        }
        Ok(())
    }
}
