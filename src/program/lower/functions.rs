//! Calls of the table's own functions, and what else functions are written
//! with: values between bounds, sums, polynomials, constant data.
//!
//! A call is lowered by *substitution*, as a reference to a case is: the body
//! is lowered again in an environment in which the parameters mean the
//! arguments. Arguments are terms by then, so each is evaluated once, and what
//! several calls have in common is one term of the pool.

use std::rc::Rc;

use super::calls::check_given;
use super::memo::{CallKey, Items};
use super::scope::Env;
use super::terms::{Call, Expected, Term, type_error};
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Span, Spanned, codes};
use crate::program::operators::BinaryOp;
use crate::program::pool::ExprId;
use crate::table::expr::{Expr, ExprKind, SumOver};
use crate::table::{self, CaseBody, ConstantValue, Function, FunctionBody, Helper, MAX_FIELDS, Output, names};
use crate::text::closest::nearest;

/// Most terms of a sum, and most coefficients of a polynomial.
const MAX_TERMS: usize = 256;

/// A function of the table or of an imported one.
#[derive(Clone, Copy)]
pub(super) enum Callee<'t> {
    Helper(&'t Helper),
    Function(&'t Function),
}

impl<'t> Callee<'t> {
    fn parameters(self) -> &'t [Spanned<String>] {
        match self {
            Callee::Helper(helper) => &helper.parameters,
            Callee::Function(function) => &function.parameters,
        }
    }

    fn name(self) -> &'t Spanned<String> {
        match self {
            Callee::Helper(helper) => &helper.name,
            Callee::Function(function) => &function.name,
        }
    }
}

impl<'t> Lowering<'t> {
    /// The function that a name calls in a scope, and the scope that it belongs to.
    pub(super) fn callee(&self, name: &str, scope: usize) -> Option<(Callee<'t>, usize)> {
        if let Some((alias, name)) = name.split_once('.') {
            // Helpers of an imported table are its own affair.
            let scope = *self.import_index.get(&(scope, alias))?;
            let found = self.scopes[scope].functions.iter().find(|f| f.name.value == name);
            return found.map(|function| (Callee::Function(function), scope));
        }
        let table = self.scopes[scope];
        let helper = table.helpers.iter().find(|h| h.name.value == name).map(Callee::Helper);
        let function = || table.functions.iter().find(|f| f.name.value == name).map(Callee::Function);
        helper.or_else(function).map(|callee| (callee, scope))
    }

    /// The names of all functions of the table that can be called in a scope.
    pub(super) fn callable(&self, scope: usize) -> Vec<String> {
        let table = self.scopes[scope];
        let own = table.helpers.iter().map(|h| h.name.value.clone());
        let own = own.chain(table.functions.iter().map(|f| f.name.value.clone()));
        let imported = table.imports.iter().flat_map(|import| {
            let functions = import.table.iter().flat_map(|table| &table.functions);
            let own = functions.map(|f| format!("{}.{}", import.alias.value, f.name.value));
            let table = import.table.iter().filter(|table| !table.cases.is_empty()).map(|_| import.alias.value.clone());
            own.chain(table)
        });
        own.chain(imported).collect()
    }

    /// `f(a, b)`: every parameter in order, or none, and then each means what it means here.
    pub(super) fn call_in_order(
        &mut self,
        callee: (Callee<'t>, usize),
        arguments: &[Expr],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        let parameters = callee.0.parameters();
        if arguments.is_empty() && !parameters.is_empty() {
            return self.call_with(callee, &[], span, env);
        }
        if arguments.len() != parameters.len() {
            let (name, count) = (&callee.0.name().value, parameters.len());
            let plural = if count == 1 { "" } else { "s" };
            let message = format!("`{name}` takes {count} argument{plural}, not {}", arguments.len());
            let listed = parameters.iter().map(|p| p.value.as_str()).collect::<Vec<_>>().join(", ");
            return Err(Diagnostic::error(codes::CALL, message).at(span, "wrong number of arguments").help(
                match parameters.first() {
                    Some(first) => {
                        format!("`{name}({listed})`, or only some by name, as in `{name}({} = ...)`", first.value)
                    }
                    None => format!("it is called as `{name}()`"),
                },
            ));
        }
        let terms = arguments.iter().map(|a| self.term(a, env, Expected::Anything)).collect::<Result<Vec<_>>>()?;
        let spans: Vec<Span> = arguments.iter().map(|a| a.span).collect();
        self.apply(callee, terms, &spans, span, env)
    }

    /// `f(p = a)`: what is not given means what it means here.
    pub(super) fn call_with(
        &mut self,
        callee: (Callee<'t>, usize),
        given: &[(Spanned<String>, Expr)],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        let parameters = callee.0.parameters();
        let function = &callee.0.name().value;
        let known: Vec<&str> = parameters.iter().map(|parameter| parameter.value.as_str()).collect();
        check_given(function, "parameter", &known, given)?;
        let (mut terms, mut spans) = (Vec::new(), Vec::new());
        for parameter in parameters {
            match given.iter().find(|(name, _)| name.value == parameter.value) {
                Some((_, value)) => {
                    terms.push(self.term(value, env, Expected::Anything)?);
                    spans.push(value.span);
                }
                None => match self.resolve(&parameter.value, env)? {
                    Some(term) => {
                        terms.push(term);
                        spans.push(span);
                    }
                    None => {
                        let message = format!("`{function}` needs `{}`, which is not given", parameter.value);
                        return Err(Diagnostic::error(codes::PARAMETER, message)
                            .at(span, format!("and nothing is called `{}` here", parameter.value))
                            .help(format!("give it a value: `{function}({} = ...)`", parameter.value)));
                    }
                },
            }
        }
        self.apply(callee, terms, &spans, span, env)
    }

    fn apply(
        &mut self,
        (callee, scope): (Callee<'t>, usize),
        mut terms: Vec<Term>,
        spans: &[Span],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        let name = &callee.name().value;
        if let Some(start) = self.calling.iter().position(|open| *open == (scope, name.as_str())) {
            let chain = self.calling[start..].iter().map(|(_, name)| *name).chain([name.as_str()]);
            let chain = chain.collect::<Vec<_>>().join(" -> ");
            return Err(Diagnostic::error(codes::RECURSION, format!("the function `{name}` calls itself"))
                .at(span, format!("closes the circle {chain}"))
                .help("functions are written out where they are called; write a fixed number of steps as a `sum`, or step by step"));
        }
        if let Callee::Function(_) = callee {
            let table = self.scopes[scope];
            for ((term, parameter), at) in terms.iter_mut().zip(callee.parameters()).zip(spans) {
                self.check_argument(table, parameter, term, *at)?;
            }
        }
        let key = CallKey::new(scope, name, &terms);
        if let Some(term) = self.memo.call(&key) {
            return Ok(term);
        }
        let parameters = callee.parameters().iter().map(|p| p.value.clone()).zip(terms).collect();
        let inner = Env { parameters: Some(Rc::new(parameters)), scope, ..Env::default() };
        self.calling.push((scope, name));
        let term = match callee {
            Callee::Helper(helper) => self.lines(&helper.lines, &inner, Expected::Anything).and_then(|lines| {
                let mut lines = lines.into_iter().rev();
                let last = lines.next().map(|line| line.value);
                last.map_or_else(
                    || Err(type_error(span, "nothing", "this function returns nothing")),
                    |last| {
                        lines.try_fold(last, |other, line| self.choose(line.condition, line.value, other, line.span))
                    },
                )
            }),
            Callee::Function(function) => self.function_term(function, &inner),
        };
        self.calling.pop();
        if let Ok(term) = &term {
            self.memo.remember(key, term);
        }
        term.map_err(|error| match scope == env.scope {
            true => error,
            // Places in another file cannot be shown here.
            false => Diagnostic::error(error.code, format!("in the imported `{name}`: {}", error.message))
                .at(span, "called here"),
        })
    }

    /// Refuses an argument that the parameter's domain does not allow. A constant that is given as a word becomes one.
    fn check_argument(
        &mut self,
        table: &table::Table,
        parameter: &Spanned<String>,
        term: &mut Term,
        at: Span,
    ) -> Result<()> {
        let Some(input) = table.inputs.iter().find(|input| input.name.value == parameter.value) else { return Ok(()) };
        match (&input.domain.value, &*term) {
            (table::Domain::U32, given) => {
                *term = Term::Word(self.word_of(given, at)?);
                Ok(())
            }
            (table::Domain::Range(lo, hi, _), Term::Number(number)) => match self.pool.constant(*number) {
                Some(value) if !(*lo..=*hi).contains(&value) => {
                    let message = format!("{value} is not in the range {lo} to {hi} of `{}`", parameter.value);
                    Err(Diagnostic::error(codes::DOMAIN, message).at(at, format!("is given as `{}`", parameter.value)))
                }
                _ => Ok(()),
            },
            (table::Domain::Range(..), other) => Err(self.no_number(other, at)),
            (table::Domain::Bool, Term::Bool(_)) | (_, Term::Level(..)) => Ok(()),
            (_, other) => {
                let message = format!("`{}` is not a number", parameter.value);
                Err(type_error(at, &self.describe(other), &message))
            }
        }
    }

    /// The value of a function whose parameters the environment gives.
    fn function_term(&mut self, function: &'t Function, env: &Env) -> Result<Term> {
        let env = self.bind(function, env)?;
        match &function.body {
            FunctionBody::Value(value) => self.term(value, &env, Expected::Anything),
            FunctionBody::Cases { cases, default } => {
                let place = default.span;
                let default = self.term(default, &env, Expected::Anything)?;
                let expected = Expected::of(&self.inferred(&default, place)?);
                let mut term = default.clone();
                for case in cases.iter().rev() {
                    let (guard, lines) = self.function_case(case, &env, expected.clone())?;
                    let value = lines.into_iter().rev().try_fold(default.clone(), |other, line| {
                        self.choose(line.condition, line.value, other, line.span)
                    })?;
                    term = self.choose(guard, value, term, case.span)?;
                }
                Ok(term)
            }
        }
    }

    /// The environment with the values that a function names.
    pub(super) fn bind(&mut self, function: &Function, env: &Env) -> Result<Env> {
        let mut env = env.clone();
        for binding in &function.bindings {
            self.check_local(&binding.name, &env)?;
            let term = self.term(&binding.value, &env, Expected::Anything)?;
            self.label(&term, &binding.name.value);
            env = env.with_local(&binding.name, term);
        }
        Ok(env)
    }

    /// Guard and lines of a case of a function.
    pub(super) fn function_case(
        &mut self,
        case: &table::Case,
        env: &Env,
        expected: Expected,
    ) -> Result<(crate::program::CondId, Vec<super::rows::LoweredLine>)> {
        match &case.body {
            CaseBody::Rows { when, lines, .. } => Ok((self.condition(when, env)?, self.lines(lines, env, expected)?)),
            CaseBody::Image { span, .. } => {
                let message = "a case of a function is written out";
                Err(Diagnostic::error(codes::CASE_SHAPE, message).at(*span, "functions have no symmetries"))
            }
        }
    }

    /// `F | x = lo .. hi`
    pub(super) fn between(
        &mut self,
        body: &Expr,
        variable: &Spanned<String>,
        bounds: [&Expr; 2],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        self.check_local(variable, env)?;
        let at = |me: &mut Self, bound: &Expr| {
            let value = Term::Number(me.numeric(bound, env)?);
            me.term(body, &env.with_local(variable, value), Expected::Anything)
        };
        let (lo, hi) = (at(self, bounds[0])?, at(self, bounds[1])?);
        self.map2(BinaryOp::Subtract, hi, lo, span)
    }

    /// `sum(n in nodes, term)`
    pub(super) fn sum(
        &mut self,
        variable: &Spanned<String>,
        over: &SumOver,
        term: &Expr,
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        self.check_local(variable, env)?;
        let items: Vec<Term> = match over {
            SumOver::Items(list) => {
                let items = self.constant_list(list, env)?;
                let mut item = |numbers: &Vec<f64>| match numbers.as_slice() {
                    [one] => Term::Number(self.pool.number(*one)),
                    several => Term::Vector(several.iter().map(|n| self.pool.number(*n)).collect()),
                };
                items.iter().map(&mut item).collect()
            }
            SumOver::Range(lo, hi) => {
                let [lo, hi] = [self.whole(lo, env)?, self.whole(hi, env)?];
                let count = hi - lo + 1.0;
                if count > MAX_TERMS as f64 || count < 1.0 {
                    let message = format!("a sum of {} terms", if count < 1.0 { 0.0 } else { count });
                    return Err(Diagnostic::error(codes::TOO_MANY_TERMS, message)
                        .at(span, "every term is written out")
                        .help(format!("a sum has 1 to {MAX_TERMS} terms")));
                }
                (0..count as usize).map(|step| Term::Number(self.pool.number(lo + step as f64))).collect()
            }
        };
        self.follow(items.len(), span)?;
        let mut total: Option<Term> = None;
        for item in items {
            let value = self.term(term, &env.with_local(variable, item), Expected::Anything)?;
            total = Some(match total {
                Some(sum) => self.map2(BinaryOp::Add, sum, value, span)?,
                None => value,
            });
        }
        total.ok_or_else(|| Diagnostic::error(codes::TOO_MANY_TERMS, "a sum of no terms").at(span, "this sum"))
    }

    /// `iterate(n, x = start, step)`: written out, as often as it says.
    pub(super) fn iterate(
        &mut self,
        count: &Expr,
        variable: &Spanned<String>,
        [start, step]: [&Expr; 2],
        span: Span,
        env: &Env,
    ) -> Result<Term> {
        self.scopes[env.scope].since(2, span, "`iterate`")?;
        self.check_local(variable, env)?;
        let number = self.numeric(count, env)?;
        let steps = match self.pool.constant(number) {
            Some(steps) if steps.fract() == 0.0 && (0.0..=MAX_TERMS as f64).contains(&steps) => steps as usize,
            Some(steps) => {
                let error = Diagnostic::error(codes::TOO_MANY_TERMS, format!("{steps} steps of an iteration"));
                return Err(error.at(count.span, format!("a whole number, 0 to {MAX_TERMS}")));
            }
            None => {
                return Err(Diagnostic::error(codes::NOT_CONSTANT, "an iteration has a constant number of steps")
                    .at(count.span, "depends on something")
                    .help(
                        "how many steps are enough for all inputs is known beforehand, or no shader could be proved",
                    ));
            }
        };
        self.follow(steps, span)?;
        let mut value = self.term(start, env, Expected::Anything)?;
        for _ in 0..steps {
            let next = self.term(step, &env.with_local(variable, value.clone()), Expected::Anything)?;
            if self.describe(&next) != self.describe(&value) {
                let message = format!("`{}` begins as {}", variable.value, self.describe(&value));
                return Err(type_error(step.span, &self.describe(&next), &message).at(start.span, "begins here"));
            }
            value = next;
        }
        Ok(value)
    }

    /// A constant whole number.
    fn whole(&mut self, expr: &Expr, env: &Env) -> Result<f64> {
        let number = self.numeric(expr, env)?;
        match self.pool.constant(number) {
            Some(value) if value.fract() == 0.0 => Ok(value),
            _ => Err(Diagnostic::error(codes::NOT_CONSTANT, "a sum runs between constant whole numbers")
                .at(expr.span, "not a constant whole number")),
        }
    }

    /// `poly(x, [c0, c1, c2])`: c0 + x (c1 + x c2)
    pub(super) fn polynomial(&mut self, Call { arguments, span, env, .. }: Call<'_>) -> Result<Term> {
        let (x, coefficients) = (&arguments[0], &arguments[1]);
        let x = self.term(x, env, Expected::Anything)?;
        let coefficients: Vec<ExprId> = if let ExprKind::List(items) = &coefficients.kind {
            // Coefficients are constants as written, also where the function is called with constants.
            let calling = std::mem::take(&mut self.calling);
            let lowered: Result<_> = items.iter().map(|item| self.numeric(item, env)).collect();
            self.calling = calling;
            lowered?
        } else if let Some(name) = coefficients.name() {
            let list = self.constant_list(&Spanned::new(coefficients.span, name.to_owned()), env)?;
            if list.iter().any(|item| item.len() > 1) {
                return Err(type_error(coefficients.span, "a list of several numbers each", "expected coefficients"));
            }
            list.iter().flatten().map(|number| self.pool.number(*number)).collect()
        } else {
            let expected = "expected a list of coefficients, [c0, c1]";
            return Err(type_error(coefficients.span, "something else", expected));
        };
        let terms = coefficients.len();
        self.follow(terms, span)?;
        if terms > MAX_TERMS {
            let message = format!("a polynomial of {terms} terms");
            return Err(Diagnostic::error(codes::TOO_MANY_TERMS, message).at(span, format!("at most {MAX_TERMS}")));
        }
        let mut rest = coefficients.into_iter().rev().map(Term::Number);
        let Some(last) = rest.next() else {
            return Err(Diagnostic::error(codes::TOO_MANY_TERMS, "a polynomial of no terms").at(span, "this list"));
        };
        rest.try_fold(last, |sum, coefficient| {
            let product = self.map2(BinaryOp::Multiply, x.clone(), sum, span)?;
            self.map2(BinaryOp::Add, coefficient, product, span)
        })
    }

    /// `{x: a, y: b}`
    pub(super) fn record(
        &mut self,
        fields: &[(Spanned<String>, Expr)],
        span: Span,
        env: &Env,
        expected: &Expected,
    ) -> Result<Term> {
        if fields.len() > MAX_FIELDS {
            let message = format!("a record of {} values", fields.len());
            return Err(Diagnostic::error(codes::TYPE, message).at(span, format!("at most {MAX_FIELDS}")));
        }
        let declared: &[(String, Output<SetId>)] = match expected {
            Expected::Result(output) => output.fields(),
            Expected::Anything | Expected::Level(_) => &[],
        };
        let mut parts: Vec<(String, Term)> = Vec::new();
        for (index, (name, value)) in fields.iter().enumerate() {
            names::check_field(name, fields[..index].iter().map(|(other, _)| other))?;
            let of = declared.iter().find(|(field, _)| *field == name.value);
            let expected = of.map_or(Expected::Anything, |(_, of)| Expected::of(of));
            let term = self.term(value, env, expected)?;
            if let Some((field, of)) = of {
                // Tied again with the whole record, this tells a mistake where it stands.
                self.tie(of, term.clone(), value.span, &format!("`{field}`"), &mut Vec::new())?;
            }
            parts.push((name.value.clone(), term));
        }
        // In the order declared, so that records of one output go together.
        parts.sort_by_key(|(name, _)| declared.iter().position(|(field, _)| field == name));
        Ok(Term::Record(parts))
    }

    /// A named constant, if it is one number.
    pub(super) fn named_constant(&mut self, name: &str, env: &Env) -> Result<Option<Term>> {
        let constants = &self.scopes[env.scope].constants;
        let Some(index) = constants.iter().position(|c| c.name.value == name) else { return Ok(None) };
        if env.constants.is_some_and(|known| index >= known) {
            return Ok(None);
        }
        match &constants[index].value {
            ConstantValue::Number(expr) => {
                // In the order written, so that a long chain of constants nests no deeper than a short one.
                for (earlier, constant) in constants[..index].iter().enumerate() {
                    if let ConstantValue::Number(expr) = &constant.value {
                        // A mistake in it is reported where it is used.
                        let _ = self.known_constant(expr, earlier, env.scope);
                    }
                }
                let value = self.known_constant(expr, index, env.scope)?;
                Ok(Some(Term::Number(self.pool.number(value))))
            }
            ConstantValue::List(_) | ConstantValue::Levels { .. } | ConstantValue::File(..) => Ok(None),
        }
    }

    /// Checks a constant by itself, used or not.
    pub(super) fn check_constant(&mut self, index: usize, name: &Spanned<String>) -> Result<()> {
        match &self.scopes[0].constants[index].value {
            ConstantValue::Number(expr) => self.known_constant(expr, index, 0).map(drop),
            ConstantValue::List(_) | ConstantValue::File(..) => {
                self.rows_of_constant(index, name, name.span, 0).map(drop)
            }
            ConstantValue::Levels { of, items } => self.levels_of_constant(of, items).map(drop),
        }
    }

    /// The value of a named constant, computed once.
    fn known_constant(&mut self, expr: &Expr, index: usize, scope: usize) -> Result<f64> {
        if let Some(known) = self.memo.constants.get(&(scope, index)) {
            return known.clone();
        }
        let value = self.constant_number(expr, index, scope);
        self.memo.constants.insert((scope, index), value.clone());
        value
    }

    /// The value of a constant expression, which may use the constants declared before it.
    pub(super) fn constant_number(&mut self, expr: &Expr, index: usize, scope: usize) -> Result<f64> {
        let parameters = Some(Rc::default());
        let env = Env { parameters, scope, constants: Some(index), ..Env::default() };
        let calling = std::mem::take(&mut self.calling);
        let number = self.numeric(expr, &env);
        self.calling = calling;
        let number = number?;
        self.pool.constant(number).ok_or_else(|| {
            Diagnostic::error(codes::NOT_CONSTANT, "constant data is constant").at(expr.span, "depends on something")
        })
    }

    /// The items of a list of constants.
    fn constant_list(&mut self, list: &Spanned<String>, env: &Env) -> Result<Items> {
        let (scope, name) = self.in_import(&list.value, env.scope).unwrap_or((env.scope, &list.value));
        let constants = &self.scopes[scope].constants;
        let lists = || {
            let lists =
                constants.iter().filter(|c| matches!(c.value, ConstantValue::List(_) | ConstantValue::File(..)));
            lists.map(|c| c.name.value.as_str())
        };
        let found = constants.iter().position(|c| c.name.value == name);
        let of_numbers = |index: &usize| lists().any(|name| name == constants[*index].name.value);
        let Some(index) = found.filter(of_numbers) else {
            let message = format!("`{}` is not a list of constants", list.value);
            let error = Diagnostic::error(codes::UNKNOWN_NAME, message).at(list.span, "expected a list of `constants`");
            return Err(match nearest(name, lists()) {
                Some(close) => error.did_you_mean(&list.value, &list.value.replace(name, close)),
                None if lists().next().is_none() => {
                    error.help("declare one: constants: {\"nodes\": [(0.25, 1), (0.75, 1)]}")
                }
                None => error.help(format!("the lists are: {}", lists().collect::<Vec<_>>().join(", "))),
            });
        };
        let too_many = |count: usize| {
            let message = format!("`{}` has {count} items", list.value);
            Err(Diagnostic::error(codes::TOO_MANY_TERMS, message)
                .at(list.span, format!("used here, at most {MAX_TERMS}")))
        };
        if let ConstantValue::List(items) = &constants[index].value
            && items.len() > MAX_TERMS
        {
            return too_many(items.len());
        }
        let rows = self.rows_of_constant(index, list, list.span, scope)?;
        let width = rows.first().map_or(0, Vec::len);
        if rows.len() > MAX_TERMS {
            return too_many(rows.len());
        }
        if width > 4 {
            let message = format!("the items of `{}` have {width} numbers each", list.value);
            return Err(Diagnostic::error(codes::TYPE, message)
                .at(list.span, "an item here is a number, or a vector of two to four"));
        }
        Ok(rows)
    }
}
