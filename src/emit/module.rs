//! What a generated module consists of, in every language.
//!
//! One function decides, on the packed key: `…_key_case`. The other entry
//! points wrap it: with levels as `f32` for code that carries them so, and
//! without the case. A level that arrives as `f32` is the one whose code is
//! nearest, so that no test relies on float equality.

use std::collections::BTreeSet;

use super::body::Body;
use super::dialect::{Dialect, Prefix, Type};
use super::text::{Text, fingerprint};
use crate::plan::{KeyLayout, LookupPlace, Plan, Proved, Shape, Step};
use crate::program::{BinaryOp, Domain, InputId, LevelKind, Levels, Node, Program};

/// Names of generated things that depend on the whole table.
pub(super) struct Names {
    /// File name of the table, for comments.
    pub(super) file: String,
    /// What names of temporaries start with; nothing that the table names looks like one.
    pub(super) temporary: String,
    /// Names that a local must not have: they mean something else where locals stand.
    hidden: BTreeSet<String>,
    /// The number that stands for no case.
    default: u32,
    /// Every set of named or integer levels.
    sets: Vec<Set>,
}

/// A set of levels in generated code.
#[derive(Clone)]
struct Set {
    /// The name of the first input that has it.
    name: String,
    /// The constants of its levels.
    constants: Vec<String>,
    levels: Levels,
}

impl Names {
    pub(super) fn new(program: &Program) -> Self {
        let prefix = Prefix::new(&program.name);
        let mut sets: Vec<Set> = Vec::new();
        let mut taken = BTreeSet::from([format!("{}_DEFAULT", prefix.upper)]);
        let mut functions: BTreeSet<String> =
            fetches(program).into_iter().map(|(ident, _)| format!("fetch_{ident}")).collect();
        for input in &program.inputs {
            if let Domain::Discrete(levels) = &input.domain
                && levels.kind != LevelKind::Bool
                && !sets.iter().any(|known| known.levels == *levels)
            {
                // Constants are upper case, while inputs may differ in case only, and where
                // set and level meet in a constant is not to be seen: `a_b` and `c`, `a` and `b_c`.
                let mut name = input.ident.clone();
                loop {
                    let constants = level_constants(&prefix, &name, levels);
                    if !constants.iter().any(|constant| taken.contains(constant))
                        && functions.insert(format!("{name}_level"))
                    {
                        taken.extend(constants.iter().cloned());
                        sets.push(Set { name, constants, levels: levels.clone() });
                        break;
                    }
                    name.push_str("_other");
                }
            }
        }
        let mut hidden: BTreeSet<String> = program.inputs.iter().map(|input| input.ident.clone()).collect();
        hidden.extend(["key".to_owned(), "site".to_owned(), prefix.result(), prefix.site()]);
        hidden.extend(taken);
        let mut temporary = "t".to_owned();
        let looks_so = |name: &str, start: &str| {
            let number = name.strip_prefix(start).and_then(|rest| rest.strip_suffix('t'));
            number.is_some_and(|number| number.chars().all(|c| c.is_ascii_digit()))
        };
        let labels = || program.pool.labels().map(|label| label.replace('.', "_"));
        while hidden.iter().any(|name| looks_so(name, &temporary)) || labels().any(|name| looks_so(&name, &temporary)) {
            temporary.push('t');
        }
        let file = program.source.name.rsplit('/').next().unwrap_or_default().to_owned();
        let used: BTreeSet<u32> = program.rows.iter().map(|row| row.id).collect();
        let default = (0..=u32::MAX).rev().find(|id| !used.contains(id)).unwrap_or(u32::MAX);
        Self { file, temporary, hidden, default, sets }
    }

    /// Whether a local of this name would hide something.
    pub(super) fn hides(&self, name: &str) -> bool {
        self.hidden.contains(name)
    }

    fn set(&self, levels: &Levels) -> Option<&Set> {
        self.sets.iter().find(|known| known.levels == *levels)
    }

    /// The constant of a level.
    pub(super) fn level(&self, program: &Program, input: InputId, level: u8) -> String {
        let set = program.levels(input).and_then(|levels| self.set(levels));
        set.map(|set| set.constants[usize::from(level)].clone()).unwrap_or_default()
    }

    /// Name and type of a fetched input.
    pub(super) fn fetched(&self, program: &Program, input: InputId) -> (String, Type) {
        let input = &program.inputs[input.index()];
        (input.ident.clone(), input_type(&input.domain, Type::Uint))
    }
}

fn level_constant(prefix: &Prefix, set: &str, level: &str) -> String {
    let level = level.replace('-', "minus_");
    format!("{}_{}_{}", prefix.upper, set.to_ascii_uppercase(), level.to_ascii_uppercase())
}

/// The constants of a set's levels; levels may differ in case only.
fn level_constants(prefix: &Prefix, set: &str, levels: &Levels) -> Vec<String> {
    let mut constants: Vec<String> = Vec::new();
    for level in &levels.names {
        let mut name = level_constant(prefix, set, level);
        while constants.contains(&name) {
            name.push_str("_OTHER");
        }
        constants.push(name);
    }
    constants
}

/// The type of an input; `levels` is that of named and integer levels.
fn input_type(domain: &Domain, levels: Type) -> Type {
    match domain {
        Domain::Discrete(l) if l.kind == LevelKind::Bool => Type::Bool,
        Domain::Discrete(_) => levels,
        Domain::Continuous { .. } => Type::Float,
    }
}

/// The inputs that are fetched, by identifier, in the order declared.
pub(super) fn fetches(program: &Program) -> Vec<(String, Type)> {
    let fetched = program.inputs.iter().filter(|input| input.fetched.is_some());
    fetched.map(|input| (input.ident.clone(), input_type(&input.domain, Type::Uint))).collect()
}

/// Writes the module of a plan.
pub(super) fn write(proved: &Proved<'_>, dialect: &dyn Dialect) -> String {
    let plan = proved.plan();
    let program = plan.program;
    let prefix = Prefix::new(&program.name);
    let names = Names::new(program);
    let mut writer = Writer { plan, dialect, prefix, names, text: Text::default() };
    writer.header(proved);
    writer.declarations();
    if !plan.lookup.is_empty() {
        writer.lookup();
    }
    writer.decision();
    writer.wrappers();
    writer.text.line(dialect.epilogue());
    writer.text.finish()
}

struct Writer<'a, 'p> {
    plan: &'a Plan<'p>,
    dialect: &'a dyn Dialect,
    prefix: Prefix,
    names: Names,
    text: Text,
}

impl Writer<'_, '_> {
    fn header(&mut self, proved: &Proved<'_>) {
        let program = self.plan.program;
        let text = &mut self.text;
        let table = fingerprint(program.source.text.as_bytes());
        text.comment(&format!("Generated by umbrage {} from {}; do not edit.", env!("CARGO_PKG_VERSION"), self.names.file));
        text.comment(&program.title);
        if !program.origin.is_empty() {
            text.comment(&format!("Source: {}", program.origin));
        }
        text.comment(&format!("Table:  fnv1a {table:016x}, {} cases", program.rows.len()));
        text.comment(&format!("Plan:   {}", self.plan.shape));
        text.comment(&format!("Proof:  {}", proved.proof()));
        text.gap();
    }

    fn declarations(&mut self) {
        let program = self.plan.program;
        let prologue = self.dialect.prologue(&self.prefix, &fetches(program));
        if !prologue.is_empty() {
            self.text.line(prologue);
            self.text.gap();
        }
        self.text.comment("Levels, as they stand in a key and as a fetch returns them.");
        for set in &self.names.sets {
            for (index, name) in set.constants.iter().enumerate() {
                self.text.line(self.dialect.constant(name, index as u32));
            }
        }
        self.text.comment("The case where none matches.");
        let name = self.dialect.global_constant(&self.prefix, "DEFAULT");
        self.text.line(self.dialect.constant(&name, self.names.default));
        self.text.gap();
        self.text.comment("The result and the number of the case that gave it.");
        self.text.line(self.dialect.result_struct(&self.prefix, &program.output));
        self.text.gap();
        if uses_remainder(self.plan) {
            let helper = self.dialect.remainder(&self.prefix);
            if !helper.is_empty() {
                self.text.line(helper);
                self.text.gap();
            }
        }
        for set in self.names.sets.clone() {
            self.level_function(&set.name, &set.levels);
        }
        self.pack_function();
    }

    /// The level whose code is nearest; the first one for NaN.
    fn level_function(&mut self, set: &str, levels: &Levels) {
        let parameter = ("code".to_owned(), Type::Float);
        let name = self.dialect.global(&self.prefix, &format!("{set}_level"));
        self.text.comment(&format!("Levels of {set} from their codes: {}.", levels.describe()));
        self.text.open(self.dialect.function(&name, &[parameter], &Type::Uint, &self.prefix));
        let mut sorted: Vec<(f64, usize)> = levels.codes.iter().copied().zip(0..).collect();
        sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
        let above = |i: usize| {
            let (below, code) = (sorted[i - 1].0, sorted[i].0);
            let middle = f64::from(f64::midpoint(below, code) as f32);
            // Between neighbours in f32 there is no middle.
            format!("code >= {}", self.dialect.number(if middle > below { middle } else { code }))
        };
        let value = if sorted.iter().enumerate().all(|(i, (_, index))| i == *index) {
            let steps: Vec<String> = (1..sorted.len()).map(|i| self.dialect.bool_to_uint(&above(i))).collect();
            steps.join(" + ")
        } else {
            let first = self.dialect.uint(sorted[0].1 as u32);
            (1..sorted.len()).fold(first, |below, i| {
                self.dialect.select(&above(i), &self.dialect.uint(sorted[i].1 as u32), &below)
            })
        };
        self.text.line(format!("return {value};"));
        self.text.close();
        self.text.gap();
    }

    fn discrete(&self) -> Vec<(String, Type)> {
        let program = self.plan.program;
        let digits = program.states.digits().iter();
        digits
            .map(|(input, _)| {
                let input = &program.inputs[input.index()];
                (input.ident.clone(), input_type(&input.domain, Type::Float))
            })
            .collect()
    }

    fn pack_function(&mut self) {
        let program = self.plan.program;
        let name = self.dialect.global(&self.prefix, "pack");
        self.text.comment(&format!("The key of a state: {}.", describe_key(program, &self.plan.key)));
        self.text.open(self.dialect.function(&name, &self.discrete(), &Type::Uint, &self.prefix));
        let mut parts = Vec::new();
        for field in self.plan.key.fields() {
            let input = &program.inputs[field.input.index()];
            let Domain::Discrete(levels) = &input.domain else { continue };
            let level = match self.names.set(levels) {
                Some(set) => format!("{}({})", self.dialect.global(&self.prefix, &format!("{}_level", set.name)), input.ident),
                None => self.dialect.bool_to_uint(&input.ident),
            };
            parts.push(match field.shift {
                0 => level,
                shift => format!("({level} << {})", self.dialect.uint(shift)),
            });
        }
        let value = if parts.is_empty() { self.dialect.uint(0) } else { parts.join(" | ") };
        self.text.line(format!("return {value};"));
        self.text.close();
        self.text.gap();
    }

    /// Two functions: the word of the lookup that holds a key's arm, and the arm.
    fn lookup(&mut self) {
        let words = lookup_words(self.plan);
        let per_word = entries_per_word(self.plan);
        let bits = 32 / per_word;
        if self.plan.shape == Shape::Switch(LookupPlace::Constants) {
            let name = self.dialect.global(&self.prefix, "lookup");
            self.text.comment("The lookup, packed; the commonest word stands last.");
            let parameter = ("word".to_owned(), Type::Uint);
            self.text.open(self.dialect.function(&name, &[parameter], &Type::Uint, &self.prefix));
            let mut groups: Vec<(u32, Vec<u32>)> = Vec::new();
            for (index, word) in words.iter().enumerate() {
                match groups.iter_mut().find(|(w, _)| w == word) {
                    Some((_, indices)) => indices.push(index as u32),
                    None => groups.push((*word, vec![index as u32])),
                }
            }
            let commonest = (0..groups.len()).max_by_key(|i| (groups[*i].1.len(), usize::MAX - i)).unwrap_or_default();
            let last = groups.remove(commonest);
            if !groups.is_empty() {
                self.text.open(self.dialect.switch_open("word"));
                for (word, indices) in &groups {
                    self.text.line(format!("{} return {}; }}", self.dialect.case_open(indices), self.dialect.uint(*word)));
                }
                self.text.line(self.dialect.case_default());
                self.text.close();
            }
            self.text.line(format!("return {};", self.dialect.uint(last.0)));
            self.text.close();
        } else {
            self.text.comment(&format!(
                "The lookup is a buffer of {} words, of which the host supplies a reader `{}`.",
                words.len(),
                self.dialect.lookup_call(&self.prefix, "word")
            ));
            let import = self.dialect.lookup_import(&self.prefix);
            if !import.is_empty() {
                self.text.line(import);
            }
        }
        self.text.gap();
        self.text.comment("Which way to go for a key.");
        let name = self.dialect.global(&self.prefix, "arm");
        let parameter = ("key".to_owned(), Type::Uint);
        self.text.open(self.dialect.function(&name, &[parameter], &Type::Uint, &self.prefix));
        let uint = |value: u32| self.dialect.uint(value);
        let word = self.dialect.lookup_call(&self.prefix, &format!("key >> {}", uint(per_word.trailing_zeros())));
        let local = self.dialect.local(&Type::Uint, "word", &word, &self.prefix);
        self.text.line(local);
        let shift = format!("((key & {}) * {})", uint(per_word - 1), uint(bits));
        self.text.line(format!("return (word >> {shift}) & {};", uint((1_u64 << bits) as u32 - 1)));
        self.text.close();
        self.text.gap();
    }

    fn continuous(&self) -> Vec<(String, Type)> {
        let inputs = self.plan.program.inputs.iter().filter(|input| input.fetched.is_none());
        inputs.filter(|i| matches!(i.domain, Domain::Continuous { .. })).map(|i| (i.ident.clone(), Type::Float)).collect()
    }

    fn site(&self) -> Vec<(String, Type)> {
        let needed = !fetches(self.plan.program).is_empty();
        needed.then(|| ("site".to_owned(), Type::Site)).into_iter().collect()
    }

    fn decision(&mut self) {
        let program = self.plan.program;
        let [.., name] = self.dialect.entry_names(&self.prefix);
        let mut parameters = vec![("key".to_owned(), Type::Uint)];
        parameters.extend(self.continuous());
        parameters.extend(self.site());
        self.text.comment("The table, on a packed key.");
        self.text.open(self.dialect.function(&name, &parameters, &Type::Result, &self.prefix));
        let used = used_inputs(self.plan);
        for field in self.plan.key.fields().iter().filter(|field| used.contains(&field.input)) {
            let input = &program.inputs[field.input.index()];
            let Domain::Discrete(levels) = &input.domain else { continue };
            let shifted = match field.shift {
                0 => "key".to_owned(),
                shift => format!("(key >> {})", self.dialect.uint(shift)),
            };
            let level = format!("{shifted} & {}", self.dialect.uint(field.mask()));
            let (ty, value) = match levels.kind {
                LevelKind::Bool => (Type::Bool, format!("({level}) != {}", self.dialect.uint(0))),
                _ => (Type::Uint, level),
            };
            let local = self.dialect.local(&ty, &input.ident, &value, &self.prefix);
            self.text.line(local);
        }
        let mut body = Body {
            plan: self.plan,
            dialect: self.dialect,
            prefix: &self.prefix,
            names: &self.names,
            text: &mut self.text,
            temporaries: 0,
        };
        body.step(self.plan.root());
        self.text.close();
        self.text.gap();
    }

    /// The other entry points.
    fn wrappers(&mut self) {
        let program = self.plan.program;
        let [levels, key, levels_case, key_case] = self.dialect.entry_names(&self.prefix);
        let value = Type::Value(program.output.clone());
        let site = self.site();
        let with_levels: Vec<(String, Type)> = program
            .inputs
            .iter()
            .filter(|input| input.fetched.is_none())
            .map(|input| (input.ident.clone(), input_type(&input.domain, Type::Float)))
            .chain(site.clone())
            .collect();
        let with_key: Vec<(String, Type)> =
            [("key".to_owned(), Type::Uint)].into_iter().chain(self.continuous()).chain(site.clone()).collect();
        let pass = |parameters: &[(String, Type)]| {
            let names = parameters.iter().map(|(name, ty)| match ty {
                Type::Site => self.dialect.site_argument().to_owned(),
                _ => name.clone(),
            });
            names.collect::<Vec<_>>().join(", ")
        };
        let discrete: Vec<String> = self.discrete().into_iter().map(|(name, _)| name).collect();
        let pack = format!("{}({})", self.dialect.global(&self.prefix, "pack"), discrete.join(", "));
        let rest: String = [self.continuous(), site].concat().iter().map(|p| format!(", {}", pass(&[p.clone()]))).collect();
        let functions = [
            ("The result, on a packed key.", key, &with_key, &value, format!("{key_case}({}).value", pass(&with_key))),
            ("The result and the case, levels as their codes.", levels_case.clone(), &with_levels, &Type::Result, format!("{key_case}({pack}{rest})")),
            ("The result, levels as their codes.", levels, &with_levels, &value, format!("{levels_case}({}).value", pass(&with_levels))),
        ];
        for (comment, name, parameters, ty, call) in functions {
            self.text.comment(comment);
            self.text.open(self.dialect.function(&name, parameters, ty, &self.prefix));
            self.text.line(format!("return {call};"));
            self.text.close();
            self.text.gap();
        }
    }
}

fn describe_key(program: &Program, key: &KeyLayout) -> String {
    let fields = key.fields().iter().map(|field| {
        let name = &program.inputs[field.input.index()].ident;
        match field.bits {
            1 => format!("{name} in bit {}", field.shift),
            bits => format!("{name} in bits {} to {}", field.shift, field.shift + bits - 1),
        }
    });
    fields.collect::<Vec<_>>().join(", ")
}

/// The inputs that the steps of a plan look at.
fn used_inputs(plan: &Plan<'_>) -> BTreeSet<InputId> {
    let mut used = BTreeSet::new();
    let mut seen = BTreeSet::new();
    let mut open = vec![plan.root()];
    while let Some(at) = open.pop() {
        if !seen.insert(at) {
            continue;
        }
        match plan.step(at) {
            Step::Test { condition, then, other } => {
                used.extend(plan.pool.cond_facts(*condition).inputs.iter());
                open.extend([*then, *other]);
            }
            Step::Fetch { next, .. } => open.push(*next),
            Step::Switch { arms } => open.extend(arms),
            Step::Leaf(leaf) => used.extend(leaf.values.iter().flat_map(|v| plan.pool.expr_facts(*v).inputs.iter())),
        }
    }
    used
}

/// Whether a remainder is computed anywhere.
fn uses_remainder(plan: &Plan<'_>) -> bool {
    plan.pool.nodes().any(|node| matches!(node, Node::Binary(BinaryOp::Remainder, ..)))
}

/// Entries of the lookup per word: arms are stored in 8 or 16 bits.
fn entries_per_word(plan: &Plan<'_>) -> u32 {
    if plan.lookup.iter().all(|arm| *arm < 256) { 4 } else { 2 }
}

/// The words of a plan's lookup, by key: the arms of consecutive keys, the
/// lowest key in the lowest bits. Keys that are no state hold the commonest
/// arm. Empty for plans without a lookup.
pub fn lookup_words(plan: &Plan<'_>) -> Vec<u32> {
    if plan.lookup.is_empty() {
        return Vec::new();
    }
    let mut counts = vec![0_usize; plan.lookup.iter().copied().max().map_or(0, usize::from) + 1];
    plan.lookup.iter().for_each(|arm| counts[usize::from(*arm)] += 1);
    let commonest = (0..counts.len()).max_by_key(|arm| counts[*arm]).unwrap_or_default() as u32;
    let per_word = entries_per_word(plan);
    let bits = 32 / per_word;
    let entries = 1_usize << plan.key.bits();
    let mut arms = vec![commonest; entries.max(per_word as usize)];
    let program = plan.program;
    let mut levels = vec![0; program.inputs.len()];
    for (state, arm) in plan.lookup.iter().enumerate() {
        program.states.write(state, &mut levels);
        arms[plan.key.pack(|input| levels[input.index()]) as usize] = u32::from(*arm);
    }
    arms.chunks(per_word as usize).map(|chunk| chunk.iter().rev().fold(0, |word, arm| word << bits | arm)).collect()
}
