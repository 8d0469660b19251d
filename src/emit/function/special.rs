//! Plans that compute: coefficients from the lookup, inputs turned by symmetries.

use super::body::Body;
use super::lookup::{key_words, piece, stride};
use crate::emit::inputs::input_type;
use crate::emit::language::{Type, bare, value};
use crate::plan::{StepId, renamed};
use crate::program::{BinaryOp, InputId, InputSet, LevelKind, Scalar, TernaryOp};

impl Body<'_, '_> {
    fn named(&mut self, ty: &Type, value: &str) -> String {
        let name = self.temporary();
        let local = self.dialect.local(ty, &name, bare(value), self.prefix);
        self.text.line(local);
        name
    }

    fn entry(&mut self) -> String {
        let call = format!("{}(key)", self.dialect.global(self.prefix, "arm"));
        self.named(&Type::UINT, &call)
    }

    /// A minimum of sums whose coefficients the lookup holds, or one of the ways of `rest`.
    pub(in crate::emit) fn coefficients(&mut self, rest: &[StepId], level: usize) {
        let count = self.plan.coefficients.fits.len();
        let entry = self.entry();
        if rest.is_empty() {
            return self.fitted(&entry);
        }
        let open = self.dialect.if_open(&format!("{entry} < {}", self.dialect.uint(count as u32)));
        self.block(open, |me| me.fitted(&entry));
        self.arms(&entry, count, rest, level + 1);
    }

    /// The sums of a set of coefficients.
    fn fitted(&mut self, entry: &str) {
        let plan = self.plan;
        let coefficients = &plan.coefficients;
        let data = plan.program.output.data_type();
        let components = data.components().len();
        let (first, stride) = (key_words(plan), stride(coefficients, components));
        let uint = |value: usize| self.dialect.uint(value as u32);
        let at = format!("{} + {entry} * {}", uint(first), self.dialect.uint(stride));
        let at = self.named(&Type::UINT, &at);
        let word = |me: &Self, offset: usize| {
            me.dialect.lookup_call(me.prefix, &format!("{at} + {}", me.dialect.uint(offset as u32)))
        };
        let mut values = Vec::new();
        for component in 0..components {
            let mut offset = 1 + component * piece(coefficients);
            let sign = self.dialect.float_from_bits(&word(self, offset));
            let sign = self.named(&Type::FLOAT, &sign);
            offset += 1;
            let mut least: Option<String> = None;
            for _ in 0..coefficients.width {
                let mut sum = self.dialect.float_from_bits(&word(self, offset));
                for (place, input) in coefficients.inputs.iter().enumerate() {
                    let factor = self.dialect.float_from_bits(&word(self, offset + 1 + place));
                    let input = &plan.program.inputs[input.index()].ident;
                    let product = self.dialect.binary(self.prefix, BinaryOp::Multiply, &factor, input);
                    sum = self.dialect.binary(self.prefix, BinaryOp::Add, &sum, &product);
                }
                offset += 1 + coefficients.inputs.len();
                let sum = self.named(&Type::FLOAT, &sum);
                least = Some(match least {
                    None => sum,
                    Some(least) => self.dialect.binary(self.prefix, BinaryOp::Min, &least, &sum),
                });
            }
            let least = least.unwrap_or_default();
            let value = self.dialect.binary(self.prefix, BinaryOp::Multiply, &sign, &least);
            values.push(match coefficients.clamp {
                None => bare(&value).to_owned(),
                Some((lo, hi)) => {
                    let (lo, hi) = (self.dialect.number(lo), self.dialect.number(hi));
                    self.dialect.ternary(self.prefix, TernaryOp::Clamp, &value, &lo, &hi)
                }
            });
        }
        let value = value(self.dialect, self.prefix, &data, values);
        let result = self.dialect.result(self.prefix, &value, &word(self, 0));
        self.text.line(format!("return {result};"));
    }

    /// Turns the inputs, calls the function of the representatives, turns the result back.
    pub(in crate::emit) fn orbit(&mut self, arms: &[StepId]) {
        let plan = self.plan;
        let program = plan.program;
        let entry = self.entry();
        let bits = plan.symmetries.len();
        let names: Vec<&str> = plan.symmetries.iter().map(|i| program.symmetries[*i].name.as_str()).collect();
        self.text.comment(&format!("The lowest bits say which symmetries turn the inputs: {}.", names.join(", ")));
        let mask = self.dialect.uint((1 << bits) - 1);
        let turn = self.named(&Type::UINT, &format!("{entry} & {mask}"));
        let way = self.named(&Type::UINT, &format!("{entry} >> {}", self.dialect.uint(bits as u32)));

        let needs = arms.iter().fold(InputSet::default(), |needs, arm| needs.or(self.outline.needs(*arm)));
        let flags = self.turn_inputs(&turn, self.turned(needs));
        let comment = "The representatives, at the inputs as they are turned.";
        let call = self.function("representative", Some(&way), (needs, false), comment, |me| me.arms(&way, 0, arms, 1));
        self.renamed.clear();
        let result = self.named(&Type::Result, &call);
        let mut result_value = format!("{result}.value");
        let data = program.output.data_type();
        for (flag, index) in flags.iter().zip(&plan.symmetries).rev() {
            if let Some(map) = &program.symmetries[*index].result {
                let places = data.components().into_iter().map(|of| format!("{result_value}{}", of.place));
                self.result = places.collect();
                let images = map.iter().zip(&self.result).map(|(component, old)| {
                    let image = self.expr(*component);
                    if image == *old { image } else { self.dialect.select(flag, bare(&image), old) }
                });
                let back = value(self.dialect, self.prefix, &data, images.collect::<Vec<_>>());
                result_value = self.named(&Type::Data(data.clone()), &back);
            }
        }
        let value = result_value;
        let result = self.dialect.result(self.prefix, &value, &format!("{result}.case_id"));
        self.text.line(format!("return {result};"));
    }

    /// Locals for the inputs as symmetries turn them, one symmetry after the other. Returns which of them do.
    fn turn_inputs(&mut self, turn: &str, needed: InputSet) -> Vec<String> {
        let (plan, program) = (self.plan, self.plan.program);
        let mut flags = Vec::new();
        for (bit, index) in plan.symmetries.iter().enumerate() {
            let flag = format!("({turn} & {}) != {}", self.dialect.uint(1 << bit), self.dialect.uint(0));
            let flag = self.named(&Type::BOOL, &flag);
            let symmetry = &program.symmetries[*index];
            let mut images: Vec<(InputId, String)> = Vec::new();
            for (input, image) in symmetry.numbers.iter().filter(|(input, _)| needed.contains(*input)) {
                images.push((*input, self.expr(*image)));
            }
            let fetched = symmetry.levels.iter().filter(|(input, _)| program.fetched.contains(*input));
            for (input, image) in fetched.filter(|(input, _)| needed.contains(*input)) {
                let Some((source, renaming)) = renamed(image) else { continue };
                let source = self.current(source);
                images.push((*input, self.renaming(*input, &source, renaming.as_deref())));
            }
            // All images are of the old inputs.
            let turned: Vec<(InputId, String)> = images
                .into_iter()
                .map(|(input, image)| (input, self.dialect.select(&flag, bare(&image), &self.current(input))))
                .collect();
            for (input, value) in turned {
                let declared = &program.inputs[input.index()];
                let name = self.named(&input_type(&declared.domain, Scalar::Uint).into(), &value);
                self.renamed.insert(declared.ident.clone(), name);
            }
            flags.push(flag);
        }
        flags
    }

    /// The name of an input here.
    fn current(&self, input: InputId) -> String {
        let ident = &self.plan.program.inputs[input.index()].ident;
        self.renamed.get(ident).unwrap_or(ident).clone()
    }

    /// The level of an input with some levels renamed.
    fn renaming(&self, input: InputId, level: &str, renaming: Option<&[u8]>) -> String {
        if self.plan.program.levels(input).is_some_and(|levels| levels.kind == LevelKind::Bool) {
            return match renaming {
                None | Some([0, 1]) => level.to_owned(),
                Some([0, 0]) => "false".to_owned(),
                Some([1, 1]) => "true".to_owned(),
                Some(_) => format!("!{level}"),
            };
        }
        let changed = renaming.unwrap_or_default().iter().zip(0_u8..).filter(|(to, from)| *to != from);
        changed.fold(level.to_owned(), |other, (to, from)| {
            let condition = format!("{level} == {}", self.dialect.uint(u32::from(from)));
            self.dialect.select(&condition, &self.dialect.uint(u32::from(*to)), &other)
        })
    }

    /// The inputs that these are made of by symmetries, as far as the key does not hold them.
    fn turned(&self, needs: InputSet) -> InputSet {
        let program = self.plan.program;
        let mut all = needs;
        for _ in &self.plan.symmetries {
            for symmetry in self.plan.symmetries.iter().map(|index| &program.symmetries[*index]) {
                for (input, image) in &symmetry.numbers {
                    if all.contains(*input) {
                        all = all.or(program.pool.expr_facts(*image).inputs);
                    }
                }
                for (input, image) in &symmetry.levels {
                    if let Some((source, _)) = renamed(image).filter(|_| all.contains(*input)) {
                        all = all.or(InputSet::one(source));
                    }
                }
            }
        }
        all
    }
}
