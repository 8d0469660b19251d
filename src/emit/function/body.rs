//! Steps → the functions that decide, in some language.

use std::collections::HashMap;

use super::outline::{FAN_OUT, MAX_LEVELS, Outline};
use super::scope::Scope;
use crate::emit::inputs::input_type;
use crate::emit::language::{Dialect, Prefix, Type, bare, value};
use crate::emit::names::Names;
use crate::emit::text::Text;
use crate::plan::{Plan, Step, StepId};
use crate::program::{CondId, Domain, InputId, InputSet, LevelKind, Outcome, Scalar};

/// Prints steps: one function, and before it those that it calls.
pub(in crate::emit) struct Body<'a, 'p> {
    pub(in crate::emit) plan: &'a Plan<'p>,
    pub(in crate::emit) dialect: &'a dyn Dialect,
    pub(in crate::emit) prefix: &'a Prefix,
    pub(in crate::emit) names: &'a Names,
    pub(in crate::emit) outline: Outline,
    /// The function that is being printed.
    pub(in crate::emit) text: Text,
    /// The names in sight where its text ends.
    pub(super) scope: Scope,
    /// Functions that are complete, in the order in which languages want them.
    pub(in crate::emit) functions: String,
    /// The functions of shared steps.
    shared: HashMap<StepId, String>,
    /// Numbers the functions.
    count: usize,
    /// Numbers the locals that have no name in the table.
    pub(in crate::emit) temporaries: usize,
    /// The names of inputs that do not go by their own.
    pub(in crate::emit) renamed: HashMap<String, String>,
    /// The name of the result in the result map of a symmetry.
    pub(in crate::emit) result: Vec<String>,
    /// The numbers by which results are counted; none where they are not.
    pub(in crate::emit) hits: HashMap<Outcome, u32>,
}

impl<'a, 'p> Body<'a, 'p> {
    pub(in crate::emit) fn new(
        plan: &'a Plan<'p>,
        dialect: &'a dyn Dialect,
        prefix: &'a Prefix,
        names: &'a Names,
    ) -> Self {
        Self {
            plan,
            dialect,
            prefix,
            names,
            outline: Outline::new(plan),
            text: Text::default(),
            scope: Scope::default(),
            functions: String::new(),
            shared: HashMap::new(),
            count: 0,
            temporaries: 0,
            renamed: HashMap::new(),
            result: Vec::new(),
            hits: HashMap::new(),
        }
    }

    /// The function on the packed key, after all that it calls.
    pub(in crate::emit) fn decision(mut self, name: &str, parameters: &[(String, Type)]) -> String {
        let root = self.plan.root();
        self.text.comment("The table, on a packed key.");
        self.open(name, parameters, self.outline.needs(root));
        self.step(root, 0);
        self.text.close();
        self.text.gap();
        self.functions + &self.text.finish()
    }

    /// Opens a function and takes from the key what it needs.
    fn open(&mut self, name: &str, parameters: &[(String, Type)], needs: InputSet) {
        self.text.open(self.dialect.function(name, parameters, &Type::Result, self.prefix));
        for field in self.plan.key.fields().iter().filter(|field| needs.contains(field.input)) {
            let input = &self.plan.program.inputs[field.input.index()];
            let Domain::Discrete(levels) = &input.domain else { continue };
            let shifted = match field.shift {
                0 => "key".to_owned(),
                shift => format!("(key >> {})", self.dialect.uint(shift)),
            };
            let level = format!("{shifted} & {}", self.dialect.uint(field.mask()));
            let (ty, value) = match levels.kind {
                LevelKind::Bool => (Type::BOOL, format!("({level}) != {}", self.dialect.uint(0))),
                LevelKind::Named | LevelKind::Int => (Type::UINT, level),
            };
            self.text.line(self.dialect.local(&ty, &input.ident, &value, self.prefix));
        }
    }

    /// The parameters of a function that needs these inputs.
    fn parameters(&self, needs: InputSet, fetches: bool) -> Vec<(String, Type)> {
        let program = self.plan.program;
        let mut parameters = Vec::new();
        if self.plan.key.fields().iter().any(|field| needs.contains(field.input)) {
            parameters.push(("key".to_owned(), Type::UINT));
        }
        for input in needs.iter() {
            let declared = &program.inputs[input.index()];
            if declared.fetched.is_some() || declared.domain.range().is_some() {
                parameters.push((declared.ident.clone(), input_type(&declared.domain, Scalar::Uint).into()));
            }
        }
        if fetches {
            parameters.push(("site".to_owned(), Type::Site));
        }
        parameters
    }

    /// Prints a function and returns the call of it. `selector` is a parameter beside the inputs.
    pub(in crate::emit) fn function(
        &mut self,
        kind: &str,
        selector: Option<&str>,
        (needs, fetches): (InputSet, bool),
        comment: &str,
        fill: impl FnOnce(&mut Self),
    ) -> String {
        self.count += 1;
        let name = self.dialect.global(self.prefix, &format!("{kind}_{}", self.count));
        let mut parameters = self.parameters(needs, fetches);
        parameters.splice(0..0, selector.map(|selector| (selector.to_owned(), Type::UINT)));
        let (outer, renamed) = (std::mem::take(&mut self.text), std::mem::take(&mut self.renamed));
        let scope = std::mem::take(&mut self.scope);
        self.text.comment(comment);
        self.open(&name, &parameters, needs);
        fill(self);
        self.text.close();
        self.text.gap();
        self.functions += &std::mem::replace(&mut self.text, outer).finish();
        (self.renamed, self.scope) = (renamed, scope);
        let named = |name: &'_ String| self.renamed.get(name).unwrap_or(name).clone();
        let arguments: Vec<String> = parameters
            .iter()
            .map(|(name, ty)| if *ty == Type::Site { self.dialect.site_argument().to_owned() } else { named(name) })
            .collect();
        format!("{name}({})", arguments.join(", "))
    }

    /// Prints a step and everything after it, inside of so many conditionals. Every path ends in a return.
    fn step(&mut self, at: StepId, level: usize) {
        if !self.outline.is_function(at) {
            return self.step_here(at, level);
        }
        let call = match self.shared.get(&at) {
            Some(call) => call.clone(),
            None => {
                let about = (self.outline.needs(at), self.outline.fetches(at));
                let comment = "What several ways lead to.";
                let call = self.function("from", None, about, comment, |me| me.step_here(at, level));
                self.shared.insert(at, call.clone());
                call
            }
        };
        self.text.line(format!("return {call};"));
    }

    fn step_here(&mut self, mut at: StepId, mut level: usize) {
        loop {
            match self.plan.step(at).clone() {
                Step::Test { condition, then, other } => {
                    let mut chain = vec![(condition, then)];
                    at = other;
                    while let (false, Step::Test { condition, then, other }) =
                        (self.outline.is_function(at), self.plan.step(at))
                    {
                        chain.push((*condition, *then));
                        at = *other;
                    }
                    level += self.chain(&chain, level);
                    if self.outline.is_function(at) {
                        return self.step(at, level);
                    }
                }
                Step::Fetch { input, next } => {
                    let (ident, ty) = self.names.fetched(self.plan.program, input);
                    let call = self.fetched(input);
                    let line = self.dialect.local(&ty.into(), &ident, &call, self.prefix);
                    self.text.line(line);
                    if self.outline.is_function(next) {
                        return self.step(next, level);
                    }
                    at = next;
                }
                Step::Gather { input, condition, next } => {
                    self.gather(input, condition);
                    at = next;
                }
                Step::Switch { arms } => {
                    let selector = format!("{}(key)", self.dialect.global(self.prefix, "arm"));
                    return self.arms(&selector, 0, &arms, level);
                }
                Step::Coefficients { rest } => return self.coefficients(&rest, level),
                Step::Orbit { arms } => return self.orbit(&arms),
                Step::Leaf(leaf) => return self.leaf(&leaf),
            }
        }
    }

    /// A call of the host for an input; of an integer, the level that it is.
    fn fetched(&self, input: InputId) -> String {
        let call = self.dialect.fetch(self.prefix, &self.plan.program.inputs[input.index()]);
        match self.plan.program.levels(input).filter(|levels| levels.classes.is_some()) {
            Some(levels) => {
                let set = self.names.set(levels).map_or("", |set| &set.name);
                format!("{}({call})", self.dialect.global(self.prefix, &format!("{set}_level")))
            }
            None => call,
        }
    }

    /// A fetch that is made where a condition holds, in sight of all that follows.
    fn gather(&mut self, input: InputId, condition: CondId) {
        let (ident, ty) = self.names.fetched(self.plan.program, input);
        let nothing = match ty {
            Scalar::Float => self.dialect.number(self.plan.program.inputs[input.index()].least()),
            Scalar::Uint | Scalar::Int | Scalar::Bool | Scalar::Word => self.dialect.zero(ty),
        };
        self.text.line(self.dialect.variable(&ty.into(), &ident, &nothing, self.prefix));
        if self.plan.pool.truth(condition) == Some(false) {
            return;
        }
        let open = self.test(condition);
        self.block(open, |me| me.text.line(format!("{ident} = {};", me.fetched(input))));
    }

    /// The first line of a conditional, after the locals that its condition needs.
    fn test(&mut self, condition: CondId) -> String {
        self.computed_constants(&[], &[condition]);
        self.operands(condition);
        self.dialect.if_open(bare(&self.condition(condition)))
    }

    /// A block: what it declares ends with it.
    pub(in crate::emit) fn block(&mut self, open: impl AsRef<str>, fill: impl FnOnce(&mut Self)) {
        let begins = self.scope.mark();
        self.text.open(open);
        fill(self);
        self.text.close();
        self.scope.forget(begins);
    }

    /// Tests one after the other. Returns how many conditionals what follows is inside of.
    fn chain(&mut self, tests: &[(CondId, StepId)], level: usize) -> usize {
        if tests.len() <= FAN_OUT || level + tests.len() <= MAX_LEVELS {
            for (nested, (condition, then)) in tests.iter().enumerate() {
                let open = self.test(*condition);
                self.block(open, |me| me.step(*then, level + nested + 1));
            }
            return tests.len();
        }
        let parts = tests.chunks(tests.len().div_ceil(FAN_OUT));
        let count = parts.len();
        for (nested, part) in parts.enumerate() {
            let mut about = (InputSet::default(), false);
            for (condition, then) in part {
                about.0 = about.0.or(self.plan.pool.cond_facts(*condition).inputs).or(self.outline.needs(*then));
                about.1 |= self.outline.fetches(*then);
            }
            let miss = self.names.miss(self.dialect);
            let call = self.function("part", None, about, "Some of the tests; no case if none holds.", |me| {
                me.chain(part, level + nested + 1);
                let data = me.plan.program.output.data_type();
                let zeros = data.components().into_iter().map(|component| me.dialect.zero(component.scalar));
                let value = value(me.dialect, me.prefix, &data, zeros);
                let result = me.dialect.result(me.prefix, &value, &miss);
                me.text.line(format!("return {result};"));
            });
            let name = self.temporary();
            let local = self.dialect.local(&Type::Result, &name, &call, self.prefix);
            self.text.line(local);
            let open = self.dialect.if_open(&format!("{name}.case_id != {miss}"));
            self.block(open, |me| me.text.line(format!("return {name};")));
        }
        count
    }

    /// A choice by number; the first of the arms has the number `first`.
    pub(in crate::emit) fn arms(&mut self, selector: &str, first: usize, arms: &[StepId], level: usize) {
        if level + arms.len() <= MAX_LEVELS || arms.len() <= FAN_OUT {
            // The last way stands behind the choice, so that every
            // language sees that all paths return.
            let Some((last, others)) = arms.split_last() else { return };
            if !others.is_empty() {
                self.block(self.dialect.switch_open(selector), |me| {
                    for (number, arm) in (first..).zip(others) {
                        let open = me.dialect.case_open(&[number as u32]);
                        me.block(open, |me| me.step(*arm, level + number - first + 1));
                    }
                    me.text.line(me.dialect.case_default());
                });
            }
            return self.step(*last, level + others.len());
        }
        // Only a call is worth a name.
        let name = if selector.ends_with(')') { self.temporary() } else { selector.to_owned() };
        if name != selector {
            let local = self.dialect.local(&Type::UINT, &name, selector, self.prefix);
            self.text.line(local);
        }
        let (low, high) = arms.split_at(arms.len() / 2);
        let calls = [(first, low), (first + low.len(), high)].map(|(first, arms)| {
            let mut about = (InputSet::default(), false);
            for arm in arms {
                about.0 = about.0.or(self.outline.needs(*arm));
                about.1 |= self.outline.fetches(*arm);
            }
            let comment = format!("Ways {first} to {}.", first + arms.len() - 1);
            self.function("arms", Some(&name), about, &comment, |me| me.arms(&name, first, arms, level + 1))
        });
        let middle = self.dialect.uint((first + low.len()) as u32);
        let open = self.dialect.if_open(&format!("{name} < {middle}"));
        self.block(open, |me| me.text.line(format!("return {};", calls[0])));
        self.text.line(format!("return {};", calls[1]));
    }
}
