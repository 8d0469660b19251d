//! Names in expressions: levels where they are expected, then locals, inputs, constants and named values.

use super::levels::Expected;
use super::{Finder, Kind, SymbolId};
use crate::diag::{Span, Spanned};
use crate::table::expr::{BinaryOp, Expr, ExprKind, SumOver};
use crate::table::{Output, Table};

impl<'t> Finder<'t> {
    /// Looks through an expression.
    pub(super) fn expr(&mut self, expr: &'t Expr, expected: Expected<'t>) {
        match &expr.kind {
            ExprKind::Number(_) => {}
            ExprKind::Name(name) => self.name(name, expr.span, expected),
            ExprKind::Level(set, level) => {
                let of = self.mention_set(set);
                self.mention_level(level.span, &level.value, of);
            }
            ExprKind::Unary(_, a) | ExprKind::Swizzle(a, _) => self.expr(a, Expected::Anything),
            ExprKind::Binary(BinaryOp::Equal | BinaryOp::NotEqual, a, b) => {
                // Of two sides that are compared, either one says which set the other is of.
                let set = self.set_of(a).or_else(|| self.set_of(b));
                let expected = set.map_or(Expected::Anything, Expected::Level);
                self.expr(a, expected);
                self.expr(b, expected);
            }
            ExprKind::Binary(op, a, b) => {
                // What lists are joined of is of the same kind as the whole.
                let expected = if *op == BinaryOp::Join { expected } else { Expected::Anything };
                self.expr(a, expected);
                self.expr(b, expected);
            }
            ExprKind::In(a, levels) => {
                if let Some(group) = a.name().and_then(|name| self.values.get(name).copied())
                    && self.symbols[group.0].kind == Kind::Group
                {
                    return self.mention(a.span, a.name().unwrap_or_default(), group);
                }
                let set = self.set_of(a);
                self.expr(a, Expected::Anything);
                levels.iter().for_each(|level| self.mention_spelt(level, set));
            }
            ExprKind::Call(function, arguments) => self.call(function, arguments, expected),
            ExprKind::With(function, given) => self.call_with(function, given),
            ExprKind::Case(id, given) => {
                if let Some(case) = self.cases.get(&id.value).copied() {
                    self.mention(id.span, &id.value.to_string(), case);
                }
                self.given(given);
            }
            ExprKind::If(condition, then, other) => {
                self.expr(condition, Expected::Anything);
                // Either branch says which set the other is of.
                let expected = match expected {
                    Expected::Anything => {
                        let set = self.set_of(then).or_else(|| self.set_of(other));
                        set.map_or(Expected::Anything, Expected::Level)
                    }
                    Expected::Level(_) | Expected::Result(_) => expected,
                };
                self.expr(then, expected);
                self.expr(other, expected);
            }
            ExprKind::Let(name, value, body) => {
                self.expr(value, Expected::Anything);
                let set = self.set_of(value);
                self.bind(name, value.span, set, |me| me.expr(body, expected));
            }
            ExprKind::List(items) => items.iter().for_each(|item| self.expr(item, item_of(expected))),
            ExprKind::Optional(item, condition) => {
                self.expr(item, expected);
                self.expr(condition, Expected::Anything);
            }
            ExprKind::Between(body, name, lo, hi) => {
                self.expr(lo, Expected::Anything);
                self.expr(hi, Expected::Anything);
                self.bind(name, hi.span, None, |me| me.expr(body, Expected::Anything));
            }
            ExprKind::Sum(name, over, term) => {
                match over {
                    SumOver::Items(list) => self.name(&list.value, list.span, Expected::Anything),
                    SumOver::Range(lo, hi) => {
                        self.expr(lo, Expected::Anything);
                        self.expr(hi, Expected::Anything);
                    }
                }
                self.bind(name, name.span, None, |me| me.expr(term, Expected::Anything));
            }
            ExprKind::Iterate(count, name, first, step) => {
                self.expr(count, Expected::Anything);
                self.expr(first, expected);
                let set = self.set_of(first);
                self.bind(name, first.span, set, |me| me.expr(step, expected));
            }
            ExprKind::Index(list, indices) => {
                self.expr(list, Expected::Anything);
                indices.iter().for_each(|index| self.expr(index, Expected::Anything));
            }
            ExprKind::Record(fields) => {
                for (name, value) in fields {
                    self.expr(value, field_of(expected, &name.value));
                }
            }
        }
    }

    /// Looks through something with one more name.
    fn bind(&mut self, name: &Spanned<String>, whole: Span, set: Option<SymbolId>, inner: impl FnOnce(&mut Self)) {
        let local = self.declare(Kind::Local, name, whole, "");
        self.locals.push((name.value.clone(), local, set));
        inner(self);
        self.locals.pop();
    }

    fn name(&mut self, name: &str, span: Span, expected: Expected<'t>) {
        let set = match expected {
            Expected::Level(set) => Some(set),
            Expected::Result(output) => self.set_of_output(output),
            Expected::Anything => None,
        };
        // Where a level is expected, its name wins over everything else of that name.
        if set.is_some_and(|set| self.levels.contains_key(&(set, name.to_owned()))) {
            return self.mention_level(span, name, set);
        }
        // `d_c.r` may be a name, or a part of something that has one: the longest that means something.
        let ends = std::iter::once(name.len()).chain(name.rmatch_indices('.').map(|(dot, _)| dot));
        for end in ends {
            if let Some(symbol) = self.resolve(&name[..end]) {
                return self.mention(span, &name[..end], symbol);
            }
        }
        if let Some((alias, rest)) = name.split_once('.')
            && let Some(import) = self.imports.get(alias).copied()
        {
            self.mention(span, alias, import);
            return self.mention_foreign(alias, rest, span.start + alias.len() + 1);
        }
        self.mention_level(span, name, set);
    }

    /// The declaration that a name by itself stands for.
    pub(super) fn resolve(&self, name: &str) -> Option<SymbolId> {
        if let Some((_, local, _)) = self.locals.iter().rev().find(|(local, ..)| local == name) {
            return Some(*local);
        }
        let value = self.values.get(name).copied();
        if self.in_helper {
            return value.filter(|value| self.symbols[value.0].kind == Kind::Constant);
        }
        self.inputs.get(name).copied().or(value)
    }

    /// Notes a constant or function of an imported table.
    fn mention_foreign(&mut self, alias: &str, name: &str, start: usize) {
        let Some(table) = self.imported(alias) else { return };
        let word = name.split('.').next().unwrap_or_default();
        let constant = table.constants.iter().find(|constant| constant.name.value == word).map(|c| &c.name);
        let function = table.functions.iter().find(|function| function.name.value == word);
        let found = constant.map(|name| (Kind::Constant, name));
        if let Some((kind, name)) = found.or(function.map(|function| (Kind::Function, &function.name))) {
            let symbol = self.foreign_symbol(table, kind, name);
            if let Some(function) = function {
                self.symbols[symbol.0].doc = function.doc.clone();
            }
            self.mention(Span::new(start, start + word.len()), word, symbol);
        }
    }

    fn imported(&self, alias: &str) -> Option<&'t Table> {
        self.table.imports.iter().find(|import| import.alias.value == alias)?.table.as_deref()
    }

    /// Notes whom a call is for.
    fn callee(&mut self, function: &Spanned<String>) {
        if let Some(symbol) = self.callables.get(function.value.as_str()).copied() {
            return self.mention(function.span, &function.value, symbol);
        }
        let (alias, rest) = function.value.split_once('.').unwrap_or((&function.value, ""));
        if let Some(import) = self.imports.get(alias).copied() {
            self.mention(function.span, alias, import);
            self.mention_foreign(alias, rest, function.span.start + alias.len() + 1);
        }
    }

    fn call(&mut self, function: &'t Spanned<String>, arguments: &'t [Expr], expected: Expected<'t>) {
        self.callee(function);
        let of_table = self.imported(&function.value).map(|table| table.inputs.as_slice()).unwrap_or_default();
        for (index, argument) in arguments.iter().enumerate() {
            let chosen = function.value == "select" && index < 2;
            let set = of_table.get(index).and_then(|input| self.foreign_input_set(&function.value, &input.name.value));
            let expected = match set {
                Some(set) => Expected::Level(set),
                None if chosen => expected,
                None => Expected::Anything,
            };
            self.expr(argument, expected);
        }
    }

    fn call_with(&mut self, function: &'t Spanned<String>, given: &'t [(Spanned<String>, Expr)]) {
        self.callee(function);
        if let Some(table) = self.imported(&function.value) {
            for (name, value) in given {
                if let Some(input) = table.inputs.iter().find(|input| input.name.value == name.value) {
                    let symbol = self.foreign_symbol(table, Kind::Input, &input.name);
                    self.mention(name.span, &name.value, symbol);
                }
                let set = self.foreign_input_set(&function.value, &name.value);
                self.expr(value, set.map_or(Expected::Anything, Expected::Level));
            }
            return;
        }
        match self.callables.get(function.value.as_str()).copied() {
            Some(helper) if self.symbols[helper.0].kind == Kind::Helper => {
                for (name, value) in given {
                    let parameter = self.symbols.iter().position(|symbol| {
                        symbol.kind == Kind::Parameter && symbol.of == Some(helper) && symbol.name == name.value
                    });
                    if let Some(parameter) = parameter {
                        self.mention(name.span, &name.value, SymbolId(parameter));
                    }
                    self.expr(value, Expected::Anything);
                }
            }
            _ => self.given(given),
        }
    }

    /// The set of an input of an imported table.
    fn foreign_input_set(&mut self, alias: &str, input: &str) -> Option<SymbolId> {
        self.enter_foreign_set(&format!("{alias}::{input}"))
    }

    /// Inputs with what takes their place.
    pub(super) fn given(&mut self, given: &'t [(Spanned<String>, Expr)]) {
        for (name, value) in given {
            self.mention_input(name);
            let set = self.set_of_input(&name.value);
            self.expr(value, set.map_or(Expected::Anything, Expected::Level));
        }
    }

    /// Notes an input; of a fetch with arguments, `light(0,1)`, its name.
    pub(super) fn mention_input(&mut self, name: &Spanned<String>) {
        let word = name.value.split('(').next().unwrap_or_default().trim();
        if let Some(input) = self.inputs.get(word).copied() {
            self.mention(name.span, word, input);
        }
    }
}

/// The surroundings of an item of a list.
fn item_of(expected: Expected<'_>) -> Expected<'_> {
    match expected {
        Expected::Result(Output::List { of, .. }) => Expected::Result(of),
        Expected::Result(_) | Expected::Anything | Expected::Level(_) => expected,
    }
}

/// The surroundings of a field of a record.
fn field_of<'t>(expected: Expected<'t>, name: &str) -> Expected<'t> {
    match expected {
        Expected::Result(Output::Record(fields)) => {
            fields.iter().find(|(field, _)| field == name).map_or(Expected::Anything, |(_, of)| Expected::Result(of))
        }
        Expected::Result(_) | Expected::Anything | Expected::Level(_) => Expected::Anything,
    }
}
