//! Table → program: declarations first, then rows, collecting every mistake.

use std::collections::{BTreeMap, HashMap, HashSet};
use std::sync::Arc;

use super::domain::{Domain, Input, LevelKind, Levels, MAX_LEVELS, StateSpace, Value};
use super::pool::{CondId, ExprId, InputSet, Pool, TernaryOp};
use super::terms::{Env, Expected, LevelTerm, Result, Term};
use super::{Assumption, Example, InputId, Line, Output, Program, Row, Symmetry};
use crate::diag::{Code, Diagnostic, Failure, Span, Spanned, codes};
use crate::table::expr::{Expr, ExprKind, UnaryOp};
use crate::table::{self, Case, CaseBody, Image, Table, names};

/// Number of a level set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) struct SetId(pub(super) usize);

impl SetId {
    /// The levels of booleans.
    pub(super) const BOOL: SetId = SetId(0);
}

/// The state of lowering one table.
pub(super) struct Lowering<'t> {
    pub(super) table: &'t Table,
    pub(super) pool: Pool,
    pub(super) sets: Vec<Levels>,
    /// The level set of each input; `None` for continuous ones.
    pub(super) input_sets: Vec<Option<SetId>>,
    pub(super) inputs: Vec<Input>,
    pub(super) named_index: HashMap<&'t str, usize>,
    pub(super) named_terms: Vec<Option<Term>>,
    pub(super) resolving: Vec<usize>,
    /// How deep [`Lowering::term`] is nested in itself.
    pub(super) depth: u32,
    input_index: HashMap<&'t str, InputId>,
    set_index: HashMap<&'t str, SetId>,
    case_index: HashMap<u32, usize>,
    output: Output,
    output_set: SetId,
}

/// A line of a row, its value not yet tied to the output.
pub(super) struct LoweredLine {
    pub(super) condition: CondId,
    pub(super) value: Term,
    pub(super) span: Span,
}

/// Checks a table.
pub(super) fn program(table: &Table) -> std::result::Result<Program, Failure> {
    let fail = |diagnostics| Failure { source: table.source.clone(), diagnostics };
    let mut errors = Vec::new();
    let mut lowering = Lowering {
        table,
        pool: Pool::default(),
        sets: vec![Levels {
            names: vec!["false".to_owned(), "true".to_owned()],
            codes: vec![0.0, 1.0],
            kind: LevelKind::Bool,
        }],
        input_sets: Vec::new(),
        inputs: Vec::new(),
        named_index: HashMap::new(),
        named_terms: vec![None; table.names.len()],
        resolving: Vec::new(),
        depth: 0,
        input_index: HashMap::new(),
        set_index: HashMap::new(),
        case_index: HashMap::new(),
        output: Output::Number,
        output_set: SetId::BOOL,
    };
    // Without sound declarations nothing that follows could be judged.
    lowering.declare(&mut errors);
    if !errors.is_empty() {
        return Err(fail(errors));
    }
    let states = match StateSpace::new(&lowering.inputs) {
        Ok(states) => states,
        Err(product) => return Err(fail(vec![lowering.too_many_states(product)])),
    };
    let program = lowering.finish(states, &mut errors);
    match program {
        Some(program) if errors.is_empty() => Ok(program),
        _ => Err(fail(errors)),
    }
}

impl<'t> Lowering<'t> {
    fn declare(&mut self, errors: &mut Vec<Diagnostic>) {
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
        if table.inputs.len() > InputSet::CAPACITY {
            let message = format!("{} inputs, at most {} are possible", table.inputs.len(), InputSet::CAPACITY);
            errors.push(
                Diagnostic::error(codes::DOMAIN, message)
                    .at(table.inputs[InputSet::CAPACITY].name.span, "one too many"),
            );
            return;
        }
        taken.clear();
        for input in &table.inputs {
            self.take_name(&input.name, "an input", &mut taken, errors);
            if let Some(checked) = keep(self.input(input), errors) {
                self.input_index.insert(&input.name.value, InputId::new(self.inputs.len()));
                self.inputs.push(checked);
            }
        }
        for (index, named) in table.names.iter().enumerate() {
            self.take_name(&named.name, "a named value", &mut taken, errors);
            self.named_index.insert(&named.name.value, index);
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
        if table.cases.is_empty() {
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
    fn take_name(
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
        let structure = ["result", "site"].iter().any(|what| lower == table.replace('_', "") + what);
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

    fn level_set(&self, levels: &[table::Level], span: Span) -> Result<Levels> {
        let error =
            |code: Code, message: String, at: Span, label: &str| Err(Diagnostic::error(code, message).at(at, label));
        if !(2..=MAX_LEVELS).contains(&levels.len()) {
            let message = format!("a discrete input has 2 to {MAX_LEVELS} levels, this one has {}", levels.len());
            return error(codes::DOMAIN, message, span, "these levels");
        }
        let mut codes_seen = HashMap::new();
        let mut names_seen = HashSet::new();
        for level in levels {
            names::check_inner(&level.name.value, "a level", level.name.span)?;
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
        })
    }

    fn input(&mut self, input: &'t table::Input) -> Result<Input> {
        let span = input.domain.span;
        let bad = |message: String| Diagnostic::error(codes::DOMAIN, message).at(span, "in this domain");
        let (domain, set) = match &input.domain.value {
            table::Domain::Levels(levels) => {
                let levels = self.level_set(levels, span)?;
                self.sets.push(levels.clone());
                (Domain::Discrete(levels), Some(SetId(self.sets.len() - 1)))
            }
            table::Domain::LevelsOf(name) => {
                let set = self.find_set(name)?;
                (Domain::Discrete(self.sets[set.0].clone()), Some(set))
            }
            table::Domain::Bool => (Domain::Discrete(self.sets[SetId::BOOL.0].clone()), Some(SetId::BOOL)),
            table::Domain::Int(from, to) => {
                let count = to.checked_sub(*from).and_then(|n| n.checked_add(1)).unwrap_or(0);
                if !(2..=MAX_LEVELS as i64).contains(&count) || from.unsigned_abs().max(to.unsigned_abs()) > 1 << 24 {
                    return Err(bad(format!("an integer input spans 2 to {MAX_LEVELS} values of at most 2^24")));
                }
                let levels = Levels {
                    names: (*from..=*to).map(|i| i.to_string()).collect(),
                    codes: (*from..=*to).map(|i| i as f64).collect(),
                    kind: LevelKind::Int,
                };
                self.sets.push(levels.clone());
                (Domain::Discrete(levels), Some(SetId(self.sets.len() - 1)))
            }
            table::Domain::Range(lo, hi, unit) => {
                if !((*lo as f32).is_finite() && (*hi as f32).is_finite() && lo < hi) {
                    return Err(bad("a range goes from a smaller to a larger finite number".to_owned()));
                }
                (Domain::Continuous { lo: *lo, hi: *hi, unit: unit.clone() }, None)
            }
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
            default: None,
            span: input.name.span,
        };
        if let Some(default) = &input.default {
            checked.default = Some(literal(&checked, default)?);
        }
        self.input_sets.push(set);
        Ok(checked)
    }

    fn find_set(&self, name: &Spanned<String>) -> Result<SetId> {
        if let Some(set) = self.set_index.get(name.value.as_str()) {
            return Ok(*set);
        }
        if let Some(input) = self.input_index.get(name.value.as_str())
            && let Some(set) = self.input_sets[input.index()]
        {
            return Ok(set);
        }
        let known = self.set_index.keys().chain(self.input_index.keys()).copied();
        let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("there is no level set `{}`", name.value))
            .at(name.span, "neither under `levels` nor a discrete input declared above");
        Err(match table::nearest(&name.value, known) {
            Some(close) => error.help(format!("did you mean `{close}`?")),
            None => error,
        })
    }

    fn too_many_states(&self, product: f64) -> Diagnostic {
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

    fn declare_output(&mut self) -> Result<()> {
        self.output = match &self.table.output.value {
            table::Output::Number(_) => Output::Number,
            table::Output::Vector(size, _) => Output::Vector(*size),
            table::Output::Enumeration(of) => {
                self.output_set = self.find_set(of)?;
                Output::Enumeration(self.sets[self.output_set.0].clone())
            }
            table::Output::List { of, max } => {
                self.output_set = self.find_set(of)?;
                Output::List { levels: self.sets[self.output_set.0].clone(), max: *max }
            }
        };
        Ok(())
    }

    fn finish(mut self, states: StateSpace, errors: &mut Vec<Diagnostic>) -> Option<Program> {
        let table = self.table;
        for named in &table.names {
            // Lowered where used, but a mistake in an unused one is a mistake too.
            let _ = keep(self.term_of_name(&named.name.value), errors);
            // A chain of names that is too long would be reported once per link.
            if errors.last().is_some_and(|e| e.code == codes::TOO_DEEP) {
                break;
            }
        }
        let mut rows = Vec::new();
        for case in &table.cases {
            if let Some(row) = keep(self.row(case), errors) {
                rows.push(row);
            }
        }
        let env = Env::default();
        let default = keep(self.default_term(&env).and_then(|t| self.result(t, table.default.span)), errors);
        let assumptions = table.assumptions.iter().filter_map(|assumption| {
            keep(names::check_inner(&assumption.name.value, "an assumption", assumption.name.span), errors)?;
            let condition = keep(self.condition(&assumption.condition, &env), errors)?;
            let (name, doc) = (assumption.name.value.clone(), assumption.doc.clone());
            Some(Assumption { name, condition, doc, span: assumption.condition.span })
        });
        let assumptions = assumptions.collect();
        let symmetries = table.symmetries.iter().filter_map(|s| keep(self.symmetry(s), errors)).collect();
        let mut examples = Vec::new();
        for (row, case) in table.cases.iter().enumerate() {
            for example in &case.examples {
                examples.extend(keep(self.example(row, example), errors));
            }
        }
        // The same mistake in a shared name is found once per use.
        let mut seen = HashSet::new();
        errors.retain(|e| seen.insert((e.code, e.labels.first().map(|l| (l.span, l.message.clone())))));
        let fetched = self.inputs.iter().enumerate().filter(|(_, i)| i.fetched.is_some());
        let fetched = fetched.fold(InputSet::default(), |set, (i, _)| set.or(InputSet::one(InputId::new(i))));
        Some(Program {
            source: table.source.clone(),
            name: table.name.value.clone(),
            title: table.title.clone(),
            origin: table.origin.clone(),
            hit_policy: table.hit_policy.value,
            hit_policy_span: table.hit_policy.span,
            inputs: self.inputs,
            fetched,
            states,
            pool: self.pool,
            rows,
            default: default?,
            output: self.output,
            assumptions,
            symmetries,
            examples,
        })
    }

    pub(super) fn input_named(&self, name: &str) -> Option<InputId> {
        self.input_index.get(name).copied()
    }

    pub(super) fn unknown_input(&self, name: &Spanned<String>, label: &str) -> Diagnostic {
        let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("`{}` is not an input", name.value));
        let known = || self.inputs.iter().map(|i| i.name.as_str());
        error.at(name.span, label).help(match table::nearest(&name.value, known()) {
            Some(close) => format!("did you mean `{close}`?"),
            None => format!("the inputs are: {}", known().collect::<Vec<_>>().join(", ")),
        })
    }

    fn term_of_name(&mut self, name: &str) -> Result<Term> {
        let expr = Expr { span: Span::default(), kind: ExprKind::Name(name.to_owned()) };
        self.term(&expr, &Env::default(), Expected::Anything)
    }

    /// The default, as a value in an environment.
    pub(super) fn default_term(&mut self, env: &Env) -> Result<Term> {
        let expected = self.expected_output();
        self.term(&self.table.default, env, expected)
    }

    fn expected_output(&self) -> Expected {
        match &self.output {
            Output::Number | Output::Vector(_) => Expected::Anything,
            Output::Enumeration(_) => Expected::Level(self.output_set),
            Output::List { max, .. } => Expected::List(self.output_set, *max),
        }
    }

    /// Ties a value to the output: the components, clamped.
    fn result(&mut self, term: Term, span: Span) -> Result<Vec<ExprId>> {
        let wrong = |found: &str, wanted: &str| {
            Err(Diagnostic::error(codes::TYPE, format!("the output is {wanted}, but this is {found}"))
                .at(span, format!("this is {found}"))
                .help("what the table returns is declared under `output`"))
        };
        let clamp = match &self.table.output.value {
            table::Output::Number(clamp) | table::Output::Vector(_, clamp) => *clamp,
            _ => None,
        };
        let parts = match (&self.output, term) {
            (Output::Number, Term::Number(number)) => vec![number],
            (Output::Vector(size), Term::Vector(parts)) if parts.len() == *size => parts,
            (Output::Enumeration(_), Term::Level(set, term)) if set == self.output_set => {
                vec![self.level_number(set, &term, |_, level| f64::from(level))]
            }
            (Output::List { .. }, Term::List(parts)) => parts,
            (Output::Number, Term::Bool(_)) => return wrong("a condition", "a number"),
            (Output::Number, _) => return wrong("not a number", "a number"),
            (Output::Vector(size), _) => return wrong("something else", &format!("a vector of {size}")),
            (Output::Enumeration(levels), _) => {
                return wrong("something else", &format!("one of the levels {}", levels.names.join(", ")));
            }
            (Output::List { .. }, _) => return wrong("not a list", "a list, written [a, b]"),
        };
        Ok(match clamp {
            None => parts,
            Some((lo, hi)) => {
                let (lo, hi) = (self.pool.number(lo), self.pool.number(hi));
                parts.into_iter().map(|part| self.pool.ternary(TernaryOp::Clamp, part, lo, hi)).collect()
            }
        })
    }

    fn row(&mut self, case: &'t Case) -> Result<Row> {
        let env = Env::of_case(case.id.value);
        let (guard, lines, result) = self.row_parts(&case.id, &env)?;
        let guard_span = match &case.body {
            CaseBody::Rows { when, .. } => when.span,
            CaseBody::Image { under, .. } => under.span,
        };
        let lines = lines.into_iter().map(|line| {
            let value = match &result {
                Some(map) => self.apply_result(map, line.value, &env)?,
                None => line.value,
            };
            Ok(Line { condition: line.condition, values: self.result(value, line.span)?, span: line.span })
        });
        let lines = lines.collect::<Result<Vec<_>>>()?;
        Ok(Row {
            id: case.id.value,
            span: case.span,
            guard,
            guard_span,
            lines,
            section: case.section.clone(),
            doc: case.doc.clone(),
            errata: case.errata.clone(),
        })
    }

    /// Guard and lines of a case in an environment, and the map that its results still need.
    pub(super) fn row_parts(
        &mut self,
        id: &Spanned<u32>,
        env: &Env,
    ) -> Result<(CondId, Vec<LoweredLine>, Option<Expr>)> {
        let case = self.find_case(id)?;
        match &case.body {
            CaseBody::Rows { when, lines } => Ok((self.condition(when, env)?, self.lines(lines, env)?, None)),
            CaseBody::Image { case: base, under } => {
                let base_case = self.find_case(base)?;
                let CaseBody::Rows { when, lines } = &base_case.body else {
                    let message = format!("case {} is itself an image", base.value);
                    return Err(Diagnostic::error(codes::REFERENCE_DEPTH, message)
                        .at(base.span, "an image is taken of a case that is written out")
                        .help("name the case that has a guard and a value"));
                };
                let table = self.table;
                let Some(symmetry) = table.symmetries.iter().find(|s| s.name.value == under.value) else {
                    let known = table.symmetries.iter().map(|s| s.name.value.as_str());
                    let error =
                        Diagnostic::error(codes::UNKNOWN_NAME, format!("there is no symmetry `{}`", under.value))
                            .at(under.span, "not under `symmetries`");
                    return Err(match table::nearest(&under.value, known) {
                        Some(close) => error.help(format!("did you mean `{close}`?")),
                        None => error,
                    });
                };
                let images = self.images(symmetry, env)?;
                let inner = self.mapped_env(images, env);
                Ok((self.condition(when, &inner)?, self.lines(lines, &inner)?, symmetry.result.clone()))
            }
        }
    }

    fn find_case(&self, id: &Spanned<u32>) -> Result<&'t Case> {
        match self.case_index.get(&id.value) {
            Some(index) => Ok(&self.table.cases[*index]),
            None => {
                let mut known: Vec<u32> = self.case_index.keys().copied().collect();
                known.sort_unstable();
                let shown: Vec<String> = known.iter().take(40).map(u32::to_string).collect();
                Err(Diagnostic::error(codes::MISSING_CASE, format!("there is no case {}", id.value))
                    .at(id.span, "refers to a case that is missing")
                    .help(format!(
                        "the cases are: {}{}",
                        shown.join(", "),
                        if known.len() > 40 { ", ..." } else { "" }
                    )))
            }
        }
    }

    fn lines(&mut self, lines: &[table::Line], env: &Env) -> Result<Vec<LoweredLine>> {
        let expected = self.expected_output();
        let lines = lines.iter().map(|line| {
            let condition = match &line.condition {
                Some(condition) => self.condition(condition, env)?,
                None => self.pool.always(true),
            };
            let value = self.term(&line.value, env, expected)?;
            Ok(LoweredLine { condition, value, span: line.value.span })
        });
        lines.collect()
    }

    /// What each mapped input becomes under a symmetry.
    fn images(&mut self, symmetry: &'t table::Symmetry, env: &Env) -> Result<HashMap<InputId, Term>> {
        let mut images = HashMap::new();
        for (name, image) in &symmetry.map {
            let Some(input) = self.input_named(&name.value) else {
                return Err(self.unknown_input(name, "only inputs are mapped"));
            };
            let term = match image {
                Image::Expr(expr) => self.term_for_input(input, expr, env)?,
                Image::Levels { from, map } => self.renamed(input, name, from.as_ref(), map, env)?,
            };
            if images.insert(input, term).is_some() {
                return Err(Diagnostic::error(codes::DUPLICATE, format!("`{}` is mapped twice", name.value))
                    .at(name.span, "again"));
            }
        }
        Ok(images)
    }

    fn renamed(
        &mut self,
        input: InputId,
        name: &Spanned<String>,
        from: Option<&Spanned<String>>,
        map: &[(Spanned<String>, Spanned<String>)],
        env: &Env,
    ) -> Result<Term> {
        let no_levels =
            |at: Span| Diagnostic::error(codes::SYMMETRY, "only named levels can be renamed").at(at, "has none");
        let origin = match from {
            None => input,
            Some(from) => self.input_named(&from.value).ok_or_else(|| self.unknown_input(from, "unknown input"))?,
        };
        let to_set = self.input_sets[input.index()].ok_or_else(|| no_levels(name.span))?;
        let Term::Level(from_set, term) = self.input_term(origin, env) else { return Err(no_levels(name.span)) };
        let mut renaming = Vec::new();
        for (index, level) in self.sets[from_set.0].names.iter().enumerate() {
            let new = map.iter().find(|(old, _)| self.sets[from_set.0].find(&old.value) == Some(index as u8));
            let (target, span) = new.map_or((level.as_str(), name.span), |(_, new)| (new.value.as_str(), new.span));
            match self.sets[to_set.0].find(target) {
                Some(index) => renaming.push(index),
                None => return Err(self.unknown_level(to_set, target, span)),
            }
        }
        for (old, _) in map {
            if self.sets[from_set.0].find(&old.value).is_none() {
                return Err(self.unknown_level(from_set, &old.value, old.span));
            }
        }
        Ok(Term::Level(to_set, Arc::new(LevelTerm::Map(term, renaming.into()))))
    }

    fn symmetry(&mut self, symmetry: &'t table::Symmetry) -> Result<Symmetry> {
        names::check_inner(&symmetry.name.value, "a symmetry", symmetry.name.span)?;
        let env = Env::default();
        let mut images: Vec<_> = self.images(symmetry, &env)?.into_iter().collect();
        images.sort_by_key(|(input, _)| *input);
        let (mut levels, mut numbers) = (Vec::new(), Vec::new());
        for (input, term) in images {
            match term {
                Term::Number(expr) => numbers.push((input, expr)),
                Term::Level(_, term) => levels.push((input, (*term).clone())),
                Term::Bool(condition) => {
                    let (one, zero) = (Arc::new(LevelTerm::Const(1)), Arc::new(LevelTerm::Const(0)));
                    levels.push((input, LevelTerm::If(condition, one, zero)));
                }
                Term::Vector(_) | Term::List(_) => {
                    return Err(Diagnostic::error(codes::SYMMETRY, "an input has a single value")
                        .at(symmetry.name.span, "here"));
                }
            }
        }
        let result = match &symmetry.result {
            None => None,
            Some(expr) => {
                let placeholder = self.pool.result();
                Some(self.numeric(expr, &env.with_local("value", Term::Number(placeholder)))?)
            }
        };
        let (name, doc) = (symmetry.name.value.clone(), symmetry.doc.clone());
        Ok(Symmetry { name, doc, levels, numbers, result, span: symmetry.name.span })
    }

    fn example(&mut self, row: usize, example: &table::Example) -> Result<Example> {
        let mut inputs: Vec<Option<Value>> = self.inputs.iter().map(|i| i.default).collect();
        for (name, value) in &example.inputs {
            let Some(input) = self.input_named(&name.value) else {
                return Err(self.unknown_input(name, "unknown input"));
            };
            inputs[input.index()] = Some(literal(&self.inputs[input.index()], value)?);
        }
        for (input, value) in self.inputs.iter().zip(&inputs) {
            if value.is_none() && input.fetched.is_none() {
                return Err(Diagnostic::error(codes::BAD_EXAMPLE, format!("the example leaves out `{}`", input.name))
                    .at(example.span, "this example")
                    .at(input.span, "declared here, without a `default`")
                    .help("give it a value in the example, or a `default` where it is declared"));
            }
        }
        let expected = self.expected_output();
        let unclamped = self.term(&example.value, &Env::default(), expected)?;
        let parts = self.result(unclamped, example.value.span)?;
        let values = parts.iter().map(|part| {
            self.pool.constant(*part).ok_or_else(|| {
                Diagnostic::error(codes::BAD_EXAMPLE, "an expected value is a constant")
                    .at(example.value.span, "depends on inputs")
            })
        });
        Ok(Example { row, span: example.span, inputs, expected: values.collect::<Result<_>>()? })
    }
}

fn keep<T>(result: Result<T>, errors: &mut Vec<Diagnostic>) -> Option<T> {
    result.map_err(|error| errors.push(error)).ok()
}

/// A constant value of an input: a level by name or code, or a number.
fn literal(input: &Input, expr: &Expr) -> Result<Value> {
    let number = |expr: &Expr| match &expr.kind {
        ExprKind::Number(n) => Some(*n),
        ExprKind::Unary(UnaryOp::Negate, inner) => match inner.kind {
            ExprKind::Number(n) => Some(-n),
            _ => None,
        },
        _ => None,
    };
    let word = match (&expr.kind, number(expr)) {
        (_, Some(n)) => format!("{n}"),
        (ExprKind::Name(name), None) => name.clone(),
        _ => {
            return Err(Diagnostic::error(codes::TYPE, "expected a constant").at(expr.span, "a level or a number"));
        }
    };
    input
        .parse(&word)
        .map_err(|message| Diagnostic::error(codes::BAD_VALUE, message).at(expr.span, format!("for `{}`", input.name)))
}

/// A count in words that stay short: `1152`, `about 10^12`.
fn approximate(count: f64) -> String {
    if count < 1e7 { format!("{count}") } else { format!("about 10^{:.0}", count.log10()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;

    /// A table with some inputs; `rest` are its other fields.
    fn check(names: &str, rest: &str) -> std::result::Result<Program, Failure> {
        let text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"a": Bool(), "H": Levels(values: {{"none": 0, "right": 0.25, "left": 0.5}}),
                          "x": Range(from: 0, to: 1), "n": Int(from: 0, to: 3)}},
                names: {{{names}}}, default: 0, {rest})"#
        );
        Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table))
    }

    fn first_error(result: std::result::Result<Program, Failure>) -> String {
        result.map_or_else(|f| f.diagnostics[0].message.clone(), |_| "none".to_owned())
    }

    const PLAIN: &str = r#"output: Number(), cases: [Case(id: 1, when: "a", value: "x")]"#;

    #[test]
    fn chains_of_names_do_not_overflow_the_stack() {
        let forms = [
            "N",
            "-N",
            "N + 1",
            "min(N, 1)",
            "mix(0, 1, N)",
            "if a { N } else { 1 }",
            "select(1, N, a)",
            "let q = N; q",
            "f32(N < 1)",
            "f32((if N < 1 { H } else { left }) == H)",
            "vec3(N).x",
            "f32(H in {left} && !(N == 1))",
        ];
        for form in forms {
            let links: String =
                (0..2_000).map(|i| format!("\"n{i}\": \"{}\",\n", form.replace('N', &format!("n{}", i + 1)))).collect();
            let found = first_error(check(&format!("{links} \"n2000\": \"x\""), PLAIN));
            assert_eq!(found, "names and references are nested too deeply", "{form}");
        }
    }

    #[test]
    fn shared_names_cost_no_exponential_time() {
        let doubling = |first: &str, next: fn(usize) -> String| {
            let rest: String = (0..30).map(|i| format!(", \"n{}\": \"{}\"", i + 1, next(i))).collect();
            format!("\"n0\": \"{first}\"{rest}")
        };
        // Levels that share parts.
        let names = doubling("if a { H } else { left }", |i| format!("if x < 0.{i}1 {{ n{i} }} else {{ n{i} }}"));
        let rest = r#"output: Number(), cases: [Case(id: 1, when: "n30 == left", value: "x")]"#;
        assert_eq!(first_error(check(&names, rest)), "none");
        // Names that are lowered again for a reference.
        let names = doubling("x < 0.5", |i| format!("n{i} && n{i}"));
        let rest = r#"output: Number(), cases: [
            Case(id: 1, when: "a", value: "case(2, x = 0.25)"), Case(id: 2, when: "n30", lines: [(1, "n30")])]"#;
        assert_eq!(first_error(check(&names, rest)), "none");
        // Vectors are bounded like numbers.
        let names = doubling("vec2(x, x)", |i| format!("n{i} * n{i}"));
        assert_eq!(
            first_error(check(&names, PLAIN)),
            "the value is too large once names and references are written out"
        );
    }

    #[test]
    fn levels_are_named_by_code_as_well() {
        let symmetric = r#"output: Number(), symmetries: {"m": Symmetry(map: {"H": {0.5: 0.25, "right": "left"}})},
            cases: [Case(id: 1, when: {"H": 0.5}, value: 1), Case(id: 2, is: (case: 1, under: "m"))]"#;
        let program = check("", symmetric).unwrap_or_else(|e| panic!("{e}"));
        let printer = super::super::print::Printer { pool: &program.pool, inputs: &program.inputs };
        assert_eq!(printer.cond(program.rows[1].guard), "H == right");

        let named = r#"output: List(of: "n", max: 2), cases: [Case(id: 1, when: "a", value: "[0, n]")]"#;
        let failure = check("", named).expect_err("the default is a number");
        assert_eq!(failure.diagnostics.len(), 1, "{failure}");
    }

    #[test]
    fn the_result_map_sees_the_replaced_inputs() {
        let rest = r#"output: Number(), symmetries: {"m": Symmetry(map: {"a": "!a"}, result: "value + x")}, cases: [
            Case(id: 1, when: "a", value: 1), Case(id: 2, is: (case: 1, under: "m")),
            Case(id: 3, when: "n == 1", value: "case(2, x = 0.5)")]"#;
        let program = check("", rest).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(program.pool.constant(program.rows[2].lines[0].values[0]), Some(1.5));
    }

    #[test]
    fn extreme_declarations_are_refused() {
        let with = |input: &str| {
            let text = format!(
                r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{"a": Bool(), "i": {input}}},
                   output: Number(), cases: [Case(id: 1, when: "a", value: 1)], default: 0)"#
            );
            first_error(Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table)))
        };
        assert!(with("Int(from: -9223372036854775808, to: -9223372036854775807)").starts_with("an integer input"));
        assert_eq!(with(r#"Levels(values: {"p": inf, "q": 0})"#), "the code inf of `p` is not exact in f32");
        assert_eq!(with(r#"Levels(values: {"p": -0.0, "q": 0})"#), "`q` and `p` have the same code 0");
    }

    /// The deepest accepted nesting, and one beyond any bound.
    #[test]
    fn long_chains_of_names_are_refused_in_time() {
        let nested = format!("{}x{}", "if s { ".repeat(20), " } else { 0 }".repeat(20));
        let chain = |length: usize| -> String {
            (0..length).map(|i| format!("\"n{i}\": \"{}\",", nested.replace('x', &format!("n{}", i + 1)))).collect()
        };
        for (length, fits) in [(3, true), (1_000, false)] {
            let text = format!(
                r#"Table(language: 1, name: "t", hit_policy: First,
                    inputs: {{"s": Bool(), "x": Range(from: 0, to: 1)}},
                    names: {{{} "n{length}": "x"}},
                    output: Number(), cases: [Case(id: 1, when: "s", value: "n0")], default: 0)"#,
                chain(length)
            );
            let program = Table::parse(Source::new("t", text)).and_then(|table| Program::check(&table));
            assert_eq!(program.is_ok(), fits, "{:?}", program.err().map(|e| e.diagnostics[0].message.clone()));
        }
    }
}
