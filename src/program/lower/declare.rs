//! The declarations of a table: level sets, inputs, names and the output. Each name
//! is checked to be free in the table and in generated code.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::{Lowering, Result, SINCE, SetId, examples, keep};
use crate::diag::{Code, Diagnostic, Span, Spanned, codes};
use crate::program::InputId;
use crate::program::bits::InputSet;
use crate::program::domain::{Domain, Input, LevelKind, Levels, MAX_LEVELS, StateSpace};
use crate::table::{self, names};

impl<'t> Lowering<'t> {
    pub(super) fn declare(&mut self, inputs: &[&'t table::Input], errors: &mut Vec<Diagnostic>) {
        let table = self.table;
        if let Err(error) = names::check(&table.name.value, "a table", table.name.span) {
            errors.push(error);
        }
        if table.name.value.contains('.') {
            errors.push(
                Diagnostic::error(codes::BAD_NAME, "the name of a table contains no dot").at(table.name.span, "here"),
            );
        }
        let mut taken: BTreeMap<String, (Span, &'static str)> = BTreeMap::new();
        for (name, levels) in &table.levels {
            self.take_name(name, "a level set", &mut taken, errors);
            if let Some(levels) = keep(self.level_set(levels, name.span), errors) {
                self.set_index.insert(&name.value, SetId(self.sets.len()));
                self.sets.push(levels);
            }
        }
        if inputs.len() > InputSet::CAPACITY {
            let message = format!("{} inputs, at most {} are possible", inputs.len(), InputSet::CAPACITY);
            errors.push(
                Diagnostic::error(codes::DOMAIN, message).at(inputs[InputSet::CAPACITY].name.span, "one too many"),
            );
            return;
        }
        taken.clear();
        for input in inputs {
            self.take_name(&input.name, "an input", &mut taken, errors);
            if !input.parameters.is_empty() {
                keep(self.declare_fetch(input), errors);
                continue;
            }
            if let Some(checked) = keep(self.input(input), errors) {
                let id = InputId::new(self.inputs.len());
                checked.domain.declare(id, &mut self.pool);
                self.input_index.insert(&input.name.value, id);
                self.inputs.push(checked);
            }
        }
        for group in &table.groups {
            self.take_name(&group.name, "a group", &mut taken, errors);
            keep(self.check_group(group), errors);
        }
        for (index, named) in table.names.iter().enumerate() {
            self.take_name(&named.name, "a named value", &mut taken, errors);
            self.named_index.insert(&named.name.value, index);
        }
        for constant in &table.constants {
            self.take_name(&constant.name, "a constant", &mut taken, errors);
        }
        for (index, case) in table.cases.iter().enumerate() {
            if let Some(first) = self.case_index.insert(case.id.value, index) {
                let message = format!("case {} is defined twice", case.id.value);
                errors.push(
                    Diagnostic::error(codes::DUPLICATE_CASE, message)
                        .at(case.id.span, "defined again here")
                        .at(table.cases[first].id.span, "first defined here"),
                );
            }
        }
        if table.cases.is_empty() && table.functions.is_empty() && !table.declares_only {
            errors.push(
                Diagnostic::error(codes::EMPTY, "the table has no cases")
                    .at(table.name.span, "this table")
                    .help("a table needs at least one `Case(...)` in `cases`"),
            );
        }
        if let Err(error) = self.declare_output() {
            errors.push(error);
        }
    }

    /// Checks a name and that nothing else has it, in the table or in generated code.
    pub(super) fn take_name(
        &self,
        name: &'t Spanned<String>,
        what: &'static str,
        taken: &mut BTreeMap<String, (Span, &'static str)>,
        errors: &mut Vec<Diagnostic>,
    ) {
        if let Err(error) = names::check(&name.value, what, name.span) {
            errors.push(error);
        }
        let identifier = names::identifier(&name.value);
        let prefix = format!("{}_", self.table.name.value);
        // Generated constants are the same in capitals, structures in camel case.
        let table = self.table.name.value.to_ascii_lowercase();
        let lower = identifier.to_ascii_lowercase();
        let structure = ["result", "site", "value"].iter().any(|what| lower == table.replace('_', "") + what);
        if identifier == self.table.name.value || lower.starts_with(&format!("{table}_")) || structure {
            let message = format!("`{}` would hide what is generated for the table", name.value);
            errors.push(
                Diagnostic::error(codes::RESERVED_NAME, message).at(
                    name.span,
                    format!("`{}` and names that begin with `{prefix}` are taken", self.table.name.value),
                ),
            );
        }
        if let Some((first, as_what)) = taken.insert(identifier, (name.span, what)) {
            errors.push(
                Diagnostic::error(codes::DUPLICATE, format!("the name `{}` is taken", name.value))
                    .at(name.span, format!("{what} of the same name in generated code"))
                    .at(first, format!("first used for {as_what} here")),
            );
        }
    }

    pub(super) fn level_set(&self, levels: &[table::Level], span: Span) -> Result<Levels> {
        let error =
            |code: Code, message: String, at: Span, label: &str| Err(Diagnostic::error(code, message).at(at, label));
        if !(2..=MAX_LEVELS).contains(&levels.len()) {
            let message = format!("a discrete input has 2 to {MAX_LEVELS} levels, this one has {}", levels.len());
            return error(codes::DOMAIN, message, span, "these levels");
        }
        let mut codes_seen = HashMap::new();
        let mut names_seen = HashSet::new();
        for level in levels {
            names::check_level(&level.name.value, level.name.span)?;
            if !names_seen.insert(&level.name.value) {
                return error(
                    codes::DUPLICATE,
                    format!("the level `{}` is given twice", level.name.value),
                    level.name.span,
                    "again",
                );
            }
            let code = level.code.value;
            if !code.is_finite() || f64::from(code as f32) != code {
                let message = format!("the code {code} of `{}` is not exact in f32", level.name.value);
                return error(codes::DOMAIN, message, level.code.span, "choose a multiple of a power of two");
            }
            if let Some(other) = codes_seen.insert((code + 0.0).to_bits(), &level.name.value) {
                let message = format!("`{}` and `{other}` have the same code {code}", level.name.value);
                return error(codes::DUPLICATE, message, level.code.span, "codes must differ");
            }
        }
        Ok(Levels {
            names: levels.iter().map(|l| l.name.value.clone()).collect(),
            codes: levels.iter().map(|l| l.code.value).collect(),
            kind: LevelKind::Named,
            classes: None,
        })
    }

    /// The levels of an input, a set that it is the first to have or one that others have, too; none of a range.
    pub(super) fn set_of_input(&mut self, input: &'t table::Input) -> Result<Option<SetId>> {
        if let Some(known) = self.own_sets.get(input.name.value.as_str()) {
            return Ok(Some(*known));
        }
        let span = input.domain.span;
        let levels = match &input.domain.value {
            table::Domain::Levels(levels) => self.level_set(levels, span)?,
            table::Domain::LevelsOf(name) => return self.find_set(name).map(Some),
            table::Domain::Bool => return Ok(Some(SetId::BOOL)),
            table::Domain::Int(from, to) if self.table.language.value >= SINCE => self.integers(input, *from, *to)?,
            table::Domain::Int(from, to) => {
                let count = to.checked_sub(*from).and_then(|n| n.checked_add(1)).unwrap_or(0);
                if !(2..=MAX_LEVELS as i64).contains(&count) || from.unsigned_abs().max(to.unsigned_abs()) > 1 << 24 {
                    let message = format!("an integer input spans 2 to {MAX_LEVELS} values of at most 2^24");
                    return Err(Diagnostic::error(codes::DOMAIN, message)
                        .at(span, "in this domain")
                        .help("from version 2 of the language on it has any range: write `language: 2`"));
                }
                Levels {
                    names: (*from..=*to).map(|i| i.to_string()).collect(),
                    codes: (*from..=*to).map(|i| i as f64).collect(),
                    kind: LevelKind::Int,
                    classes: None,
                }
            }
            table::Domain::Range(..) => return Ok(None),
            table::Domain::U32 => {
                self.table.since(SINCE, span, "`U32` as an input")?;
                return Ok(None);
            }
        };
        if levels.is_wide() {
            self.wide.insert(self.sets.len(), input.name.value.clone());
        }
        self.sets.push(levels);
        let set = SetId(self.sets.len() - 1);
        self.own_sets.insert(&input.name.value, set);
        Ok(Some(set))
    }

    fn input(&mut self, input: &'t table::Input) -> Result<Input> {
        let (checked, set) = self.checked_input(input)?;
        self.input_sets.push(set);
        Ok(checked)
    }

    /// An input, with its level set, that has no number yet.
    pub(super) fn checked_input(&mut self, input: &'t table::Input) -> Result<(Input, Option<SetId>)> {
        let set = self.set_of_input(input)?;
        let domain = match (set, &input.domain.value) {
            (Some(set), _) => Domain::Discrete(self.sets[set.0].clone()),
            (None, table::Domain::Range(lo, hi, unit)) => {
                let (least, most) = (*lo as f32, *hi as f32);
                if !(least.is_finite() && most.is_finite() && least < most) {
                    let message = "a range goes from a smaller to a larger number, both finite in f32";
                    let error = Diagnostic::error(codes::DOMAIN, message);
                    return Err(error.at(input.domain.span, "in this domain"));
                }
                Domain::Continuous { lo: *lo, hi: *hi, unit: unit.clone() }
            }
            (None, table::Domain::U32) => Domain::Word,
            (
                None,
                table::Domain::Levels(_) | table::Domain::LevelsOf(_) | table::Domain::Bool | table::Domain::Int(..),
            ) => unreachable!("only ranges and words have no levels"),
        };
        if let Some(cost) = &input.fetched
            && !(cost.value.is_finite() && cost.value >= 0.0)
        {
            return Err(Diagnostic::error(codes::DOMAIN, "a cost is a number of texture reads, zero or more")
                .at(cost.span, "not a cost"));
        }
        let mut checked = Input {
            name: input.name.value.clone(),
            ident: names::identifier(&input.name.value),
            domain,
            doc: input.doc.clone(),
            fetched: input.fetched.as_ref().map(|cost| cost.value),
            call: None,
            default: None,
            span: input.name.span,
        };
        if let Some(default) = &input.default {
            checked.default = Some(examples::literal(&checked, default)?);
        }
        Ok((checked, set))
    }

    pub(super) fn too_many_states(&self, product: f64) -> Diagnostic {
        let mut error = Diagnostic::error(
            codes::TOO_MANY_STATES,
            format!("the discrete inputs have {} combined states", approximate(product)),
        );
        let discrete = self.inputs.iter().filter_map(|input| match (&input.domain, input.fetched) {
            (Domain::Discrete(levels), None) => Some((input, levels.count())),
            _ => None,
        });
        let mut discrete: Vec<_> = discrete.collect();
        // The sort is stable: of equally large inputs the first ones are shown.
        discrete.sort_by_key(|(_, count)| std::cmp::Reverse(*count));
        for (input, count) in discrete.iter().take(8) {
            error = error.at(input.span, format!("{count} levels"));
        }
        if discrete.len() > 8 {
            error = error.help(format!("these are the largest of {} discrete inputs", discrete.len()));
        }
        error
            .help(format!("every state is proved one by one, so there can be at most {}", StateSpace::MAX))
            .help("declare inputs that few cases need as `fetched`, or split the table")
    }
}

/// A count in words that stay short: `1152`, `about 10^12`.
fn approximate(count: f64) -> String {
    if count < 1e7 { format!("{count}") } else { format!("about 10^{:.0}", count.log10()) }
}
