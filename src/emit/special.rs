//! Plans that compute: coefficients from the lookup, inputs turned by symmetries.

use super::body::Body;
use super::dialect::{Type, bare, infix};
use super::lookup::{key_words, piece, stride};
use super::names::input_type;
use super::terms::Locals;
use crate::plan::{StepId, Turn};
use crate::program::{BinaryOp, InputId, InputSet, Node, TernaryOp};

/// Where a turned input comes from: the input fetched, its levels renamed, and the turns that ask for it so.
type Way = (InputId, Option<Vec<u8>>, Vec<u32>);

impl Body<'_, '_> {
    fn named(&mut self, ty: &Type, value: &str) -> String {
        let name = self.temporary();
        let local = self.dialect.local(ty, &name, bare(value), self.prefix);
        self.text.line(local);
        name
    }

    fn entry(&mut self) -> String {
        let call = format!("{}(key)", self.dialect.global(self.prefix, "arm"));
        self.named(&Type::Uint, &call)
    }

    /// A minimum of sums whose coefficients the lookup holds, or one of the ways of `rest`.
    pub(super) fn coefficients(&mut self, rest: &[StepId], level: usize) {
        let plan = self.plan;
        let coefficients = &plan.coefficients;
        let count = coefficients.fits.len();
        let entry = self.entry();
        if !rest.is_empty() {
            let open = self.dialect.if_open(&format!("{entry} < {}", self.dialect.uint(count as u32)));
            self.text.open(open);
        }
        let components = plan.program.output.components();
        let (first, stride) = (key_words(plan), stride(coefficients, components));
        let uint = |value: usize| self.dialect.uint(value as u32);
        let at = format!("{} + {entry} * {}", uint(first), self.dialect.uint(stride));
        let at = self.named(&Type::Uint, &at);
        let word = |me: &Self, offset: usize| {
            me.dialect.lookup_call(me.prefix, &format!("{at} + {}", me.dialect.uint(offset as u32)))
        };
        let mut values = Vec::new();
        for component in 0..components {
            let mut offset = 1 + component * piece(coefficients);
            let sign = self.dialect.float_from_bits(&word(self, offset));
            let sign = self.named(&Type::Float, &sign);
            offset += 1;
            let mut least: Option<String> = None;
            for _ in 0..coefficients.width {
                let mut sum = self.dialect.float_from_bits(&word(self, offset));
                for (place, input) in coefficients.inputs.iter().enumerate() {
                    let factor = self.dialect.float_from_bits(&word(self, offset + 1 + place));
                    let input = &plan.program.inputs[input.index()].ident;
                    let product = infix(BinaryOp::Multiply, &factor, input).unwrap_or_default();
                    sum = infix(BinaryOp::Add, &sum, &product).unwrap_or_default();
                }
                offset += 1 + coefficients.inputs.len();
                let sum = self.named(&Type::Float, &sum);
                least = Some(match least {
                    None => sum,
                    Some(least) => self.dialect.binary(self.prefix, BinaryOp::Min, &least, &sum),
                });
            }
            let least = least.unwrap_or_default();
            let value = infix(BinaryOp::Multiply, &sign, &least).unwrap_or_default();
            values.push(match coefficients.clamp {
                None => bare(&value).to_owned(),
                Some((lo, hi)) => {
                    let (lo, hi) = (self.dialect.number(lo), self.dialect.number(hi));
                    self.dialect.ternary(TernaryOp::Clamp, &value, &lo, &hi)
                }
            });
        }
        let value = self.dialect.value(self.prefix, &plan.program.output, &values);
        let result = self.dialect.result(self.prefix, &value, &word(self, 0));
        self.text.line(format!("return {result};"));
        if !rest.is_empty() {
            self.text.close();
            self.arms(&entry, count, rest, level + 1);
        }
    }

    /// Turns the inputs, calls the function of the representatives, turns the result back.
    pub(super) fn orbit(&mut self, arms: &[StepId]) {
        let plan = self.plan;
        let program = plan.program;
        let entry = self.entry();
        let bits = plan.symmetries.len();
        let names: Vec<&str> = plan.symmetries.iter().map(|i| program.symmetries[*i].name.as_str()).collect();
        self.text.comment(&format!("The lowest bits say which symmetries turn the inputs: {}.", names.join(", ")));
        let mask = self.dialect.uint((1 << bits) - 1);
        let turn = self.named(&Type::Uint, &format!("{entry} & {mask}"));
        let way = self.named(&Type::Uint, &format!("{entry} >> {}", self.dialect.uint(bits as u32)));

        let mut about = (InputSet::default(), false);
        for arm in arms {
            about.0 = about.0.or(self.outline.needs(*arm));
            about.1 |= self.outline.fetches(*arm);
        }
        let needed = self.turned_numbers(about.0);
        let mut flags = Vec::new();
        for (bit, index) in plan.symmetries.iter().enumerate() {
            let flag = format!("({turn} & {}) != {}", self.dialect.uint(1 << bit), self.dialect.uint(0));
            let flag = self.named(&Type::Bool, &flag);
            let mut images = Vec::new();
            for (input, image) in &program.symmetries[*index].numbers {
                let ident = &program.inputs[input.index()].ident;
                if needed.contains(*input) {
                    let old = self.renamed.get(ident).unwrap_or(ident).clone();
                    let image = self.expr(*image, &Locals::default());
                    images.push((ident.clone(), self.dialect.select(&flag, bare(&image), &old)));
                }
            }
            // All images are of the old inputs.
            for (ident, image) in images {
                let name = self.named(&Type::Float, &image);
                self.renamed.insert(ident, name);
            }
            flags.push(flag);
        }

        self.turn = about.1.then(|| turn.clone());
        if about.1 {
            self.turned_fetches(&turn);
        }
        let comment = "The representatives, at the inputs as they are turned.";
        let call = self.function("representative", Some(&way), about, comment, |me| me.arms(&way, 0, arms, 1));
        self.turn = None;
        self.renamed.clear();
        let result = self.named(&Type::Result, &call);
        let mut value = format!("{result}.value");
        for (flag, index) in flags.iter().zip(&plan.symmetries).rev() {
            if let Some(map) = program.symmetries[*index].result {
                self.result.clone_from(&value);
                let image = self.expr(map, &Locals::default());
                let back = self.dialect.select(flag, bare(&image), &value);
                value = self.named(&Type::Value(program.output.clone()), &back);
            }
        }
        let result = self.dialect.result(self.prefix, &value, &format!("{result}.case_id"));
        self.text.line(format!("return {result};"));
    }

    /// The continuous inputs that these are made of, once turned.
    fn turned_numbers(&self, needs: InputSet) -> InputSet {
        let program = self.plan.program;
        let mut all = needs;
        for _ in &self.plan.symmetries {
            for index in &self.plan.symmetries {
                for (input, image) in &program.symmetries[*index].numbers {
                    if all.contains(*input) {
                        all = all.or(program.pool.expr_facts(*image).inputs);
                    }
                }
            }
        }
        all.minus(program.fetched)
    }

    /// For each fetched input a function that fetches what it is turned from.
    fn turned_fetches(&mut self, turn: &str) {
        let plan = self.plan;
        let mut words: Vec<usize> =
            plan.lookup.iter().map(|e| usize::from(*e) & ((1 << plan.symmetries.len()) - 1)).collect();
        words.sort_unstable();
        words.dedup();
        let fetched: Vec<InputId> = plan.reachable().into_iter().filter_map(|step| plan.fetch_of(step)).collect();
        let mut fetched_once = fetched;
        fetched_once.sort_unstable();
        fetched_once.dedup();
        for input in fetched_once {
            // The words that lead to the same source, with the same levels renamed, share a way.
            let mut ways: Vec<(InputId, Option<Vec<u8>>, Vec<u32>)> = Vec::new();
            for word in &words {
                let mut pool = plan.pool.clone();
                let Some(way) = Turn::of_word(plan.program, &mut pool, &plan.symmetries, *word) else { continue };
                let source = way.source(&pool, input);
                let (source, renaming) = source.unwrap_or((input, None));
                match ways.iter_mut().find(|(s, r, _)| (*s, r) == (source, &renaming)) {
                    Some((.., words)) => words.push(*word as u32),
                    None => ways.push((source, renaming, vec![*word as u32])),
                }
            }
            self.turned_fetch(turn, input, &ways);
        }
    }

    fn turned_fetch(&mut self, turn: &str, input: InputId, ways: &[Way]) {
        let program = self.plan.program;
        let declared = &program.inputs[input.index()];
        let ty = input_type(&declared.domain, Type::Uint);
        let name = self.dialect.global(self.prefix, &format!("turned_{}", declared.ident));
        let parameters = [(turn.to_owned(), Type::Uint), ("site".to_owned(), Type::Site)];
        let outer = std::mem::take(&mut self.text);
        self.text.comment(&format!("{} as it is behind symmetries.", declared.ident));
        self.text.open(self.dialect.function(&name, &parameters, &ty, self.prefix));
        let Some((last, others)) = ways.split_last() else {
            self.text = outer;
            return;
        };
        if !others.is_empty() {
            self.text.open(self.dialect.switch_open(turn));
            for (source, renaming, words) in others {
                let open = self.dialect.case_open(words);
                self.text.open(open);
                self.renamed_fetch(*source, renaming.as_deref(), &ty);
                self.text.close();
            }
            self.text.line(self.dialect.case_default());
            self.text.close();
        }
        self.renamed_fetch(last.0, last.1.as_deref(), &ty);
        self.text.close();
        self.text.gap();
        self.functions += &std::mem::replace(&mut self.text, outer).finish();
    }

    fn renamed_fetch(&mut self, source: InputId, renaming: Option<&[u8]>, ty: &Type) {
        let ident = &self.plan.program.inputs[source.index()].ident;
        let fetch = self.dialect.fetch(self.prefix, ident);
        let Some(renaming) = renaming else {
            self.text.line(format!("return {fetch};"));
            return;
        };
        let level = self.named(ty, &fetch);
        let changed = renaming.iter().zip(0_u8..).filter(|(to, from)| *to != from);
        let value = changed.fold(level.clone(), |other, (to, from)| {
            let condition = format!("{level} == {}", self.dialect.uint(u32::from(from)));
            self.dialect.select(&condition, &self.dialect.uint(u32::from(*to)), &other)
        });
        self.text.line(format!("return {};", bare(&value)));
    }
}

impl Turn {
    /// The fetched input that stands behind one, and what becomes of its levels.
    fn source(&self, pool: &crate::program::Pool, input: InputId) -> Option<(InputId, Option<Vec<u8>>)> {
        if let Some((_, image)) = self.symmetry.levels.iter().find(|(known, _)| *known == input) {
            return crate::plan::renamed(image);
        }
        let (_, image) = self.symmetry.numbers.iter().find(|(known, _)| *known == input)?;
        match pool.node(*image) {
            Node::Input(source) => Some((source, None)),
            _ => None,
        }
    }
}
