//! The integrand of a function, read from its closed form.
//!
//! `F | x = lo .. hi` is the integral of the derivative of F. Functions that add
//! multiples of such integrals between the same bounds integrate the sum of the
//! derivatives, and that is what this reads: a sum in one variable, with one
//! factor that stands for the integral sign.

use std::collections::BTreeSet;

use super::poly::{Atom, Mono, Poly, multiply};
use super::read::{Env, Reader, Result};
use super::trig::{derivative, products, substitute};
use crate::table::expr::{Expr, ExprKind};
use crate::table::{Function, FunctionBody, Table};

/// The integral sign of the pair of bounds with this number, as a factor. No table can use such a name.
fn sign(number: usize) -> Atom {
    Atom::Var(format!("'{number}"))
}

/// The variable of the integral with this number.
fn variable(number: usize) -> String {
    format!("x'{number}")
}

fn no_integral() -> String {
    "it is no integral of sines and cosines".to_owned()
}

/// The integrand of a function in the variable `name`, and the names of mean and half difference of the bounds.
pub(super) fn integrand(reader: &mut Reader<'_>, function: &Function, name: &str) -> Result<(Poly, usize)> {
    reader.integrands = true;
    let sum = reader.function(function)?;
    let mut found = BTreeSet::new();
    let mut plain = Poly::default();
    for (mono, factor) in &sum.0 {
        let number = (0..reader.bounds.len()).find(|n| mono.get(&sign(*n)) == Some(&1)).ok_or_else(no_integral)?;
        found.insert(number);
        let without = multiply(mono, &Mono::from([(sign(number), -1)]));
        plain.add_term(without, *factor).ok_or_else(no_integral)?;
    }
    let mut found = found.into_iter();
    let (Some(number), None) = (found.next(), found.next()) else { return Err(no_integral()) };
    if (0..reader.bounds.len()).any(|n| plain.0.keys().any(|mono| mono.contains_key(&sign(n)))) {
        return Err(no_integral());
    }
    let named = substitute(&plain, &Env::from([(variable(number), Poly::var(name))])).ok_or_else(no_integral)?;
    Ok((named, number))
}

impl Reader<'_> {
    /// `body | free = lo .. hi` as an integral of the derivative.
    pub(super) fn integral(&mut self, body: &Expr, free: &str, lo: Poly, hi: Poly, env: &Env) -> Result<Poly> {
        let number = self.bounds_number(lo, hi);
        let mut inner = env.clone();
        inner.insert(free.to_owned(), Poly::var(&variable(number)));
        let body = self.expr(body, &inner)?;
        if (0..self.bounds.len()).any(|n| body.0.keys().any(|mono| mono.contains_key(&sign(n)))) {
            return Err(no_integral());
        }
        let slope = derivative(&body, &variable(number)).and_then(|d| products(&d)).ok_or_else(no_integral)?;
        slope.times(&Poly::atom(sign(number))).ok_or_else(no_integral)
    }

    /// A function with its parameters replaced afterwards: at parameters where its closed form divides by zero the
    /// integral is what it tends to.
    pub(super) fn integral_of(&mut self, function: &Function, set: Env) -> Result<Poly> {
        let used = names_use(self.table);
        let keeps = |(parameter, value): (&String, &Poly)| *value == Poly::var(parameter) || !used.contains(parameter);
        if !set.iter().all(keeps) {
            return Err("a call changes what names of the table are made of".to_owned());
        }
        let plain = function.parameters.iter().map(|p| (p.value.clone(), Poly::var(&p.value))).collect();
        let value = self.body(function, plain)?;
        let mut by = set.clone();
        for number in 0..self.bounds.len() {
            if value.mentions(&variable(number)) || value.0.keys().any(|mono| mono.contains_key(&sign(number))) {
                let (lo, hi) = (self.bounds[number].lo.clone(), self.bounds[number].hi.clone());
                let lo = substitute(&lo, &set).ok_or_else(no_integral)?;
                let hi = substitute(&hi, &set).ok_or_else(no_integral)?;
                let moved = self.bounds_number(lo, hi);
                by.insert(variable(number), Poly::var(&variable(moved)));
                by.insert(format!("'{number}"), Poly::atom(sign(moved)));
            }
        }
        substitute(&value, &by).ok_or_else(no_integral)
    }
}

/// Everything that the named values of a table mention.
fn names_use(table: &Table) -> BTreeSet<String> {
    let mut all = BTreeSet::new();
    let mut open: Vec<&Expr> = table.names.iter().map(|named| &named.value).collect();
    while let Some(expr) = open.pop() {
        open.extend(expr.parts());
        if let ExprKind::Name(name) = &expr.kind {
            all.insert(name.clone());
        }
    }
    all
}

/// The functions of the table that a function calls in its own formula.
pub(super) fn callees<'t>(table: &'t Table, function: &'t Function) -> Vec<&'t str> {
    let FunctionBody::Value(value) = &function.body else { return Vec::new() };
    let mut open: Vec<&Expr> = function.bindings.iter().map(|binding| &binding.value).chain([value]).collect();
    let mut all = Vec::new();
    while let Some(expr) = open.pop() {
        open.extend(expr.parts());
        if let ExprKind::Call(name, _) | ExprKind::With(name, _) = &expr.kind
            && table.functions.iter().any(|f| f.name.value == name.value)
        {
            all.push(name.value.as_str());
        }
    }
    all
}
