//! Tables of cases: outputs, cases in all their forms, and the table around them.

use super::expression::{Scope, Type, Visible};
use super::{Field, Maker, Written, examples, fields, layout, list, map};
use crate::choices::Choices;

/// A case in the making: its fields, and the examples that it is given later.
pub(super) struct Case {
    pub(super) id: u32,
    pub(super) fields: Vec<Field>,
    pub(super) examples: Vec<String>,
}

/// A table of cases in the making.
pub(super) struct Draft {
    /// The fields of the table but its cases.
    pub(super) fields: Vec<Field>,
    pub(super) cases: Vec<Case>,
    pub(super) beside: Vec<(String, String)>,
}

impl Draft {
    /// The text, in one line.
    pub(super) fn plain(&self) -> String {
        let case = |case: &Case| {
            let mut list = case.fields.clone();
            if !case.examples.is_empty() {
                list.push(("examples", super::list(&case.examples)));
            }
            format!("Case({})", fields(&list))
        };
        let mut list = self.fields.clone();
        list.push(("cases", super::list(&self.cases.iter().map(case).collect::<Vec<_>>())));
        format!("Table({})", fields(&list))
    }
}

/// Makes a table of cases.
pub(super) fn table(choices: &mut Choices<'_>) -> Written {
    let mut maker = Maker::new(choices);
    let mut draft = maker.draft(true);
    if maker.choices.either() {
        examples::add(&mut maker, &mut draft);
    }
    let text = layout::spread(maker.choices, &draft.plain());
    Written { text, beside: draft.beside }
}

impl Maker<'_, '_> {
    pub(super) fn draft(&mut self, imports: bool) -> Draft {
        let mut list: Vec<Field> = vec![("name", "\"t\"".to_owned())];
        self.modern = self.choices.either();
        self.put(&mut list, "levels", Self::level_sets);
        let inputs = self.declare_inputs(true);
        list.push(("inputs", inputs));
        self.put(&mut list, "title", Self::doc);
        self.put(&mut list, "source", Self::doc);
        let mut beside = Vec::new();
        if self.choices.one_in(3) {
            self.put(&mut list, "constants", Self::constants);
            self.put(&mut list, "helpers", |maker| maker.helpers(3));
        }
        if imports && self.choices.one_in(12) {
            let (imports, file) = match self.modern && self.choices.either() {
                true => self.import_of_cases(),
                false => self.imports(),
            };
            list.push(("imports", imports));
            beside.push(file);
        }
        let output = self.output();
        self.put(&mut list, "names", |maker| maker.names(3));
        let later =
            ["Record(", "Bool(", "Int(", "List(of: Vector", "List(of: List"].iter().any(|word| output.contains(word));
        let claims = if self.choices.one_in(8) { self.claimed() } else { String::new() };
        self.later |= later || !claims.is_empty() || self.inputs.iter().any(|input| input.name.contains('('));
        list.push(("output", output));
        if !claims.is_empty() {
            list.push(("claims", claims));
        }
        let mut symmetries = Vec::new();
        if self.choices.either() {
            symmetries = self.symmetries();
            if !symmetries.is_empty() {
                list.push(("symmetries", map(&symmetries)));
            }
        }
        self.put(&mut list, "assume", Self::assumptions);
        self.put(&mut list, "draw", Self::drawing);
        self.put(&mut list, "continuity", Self::continuity);
        if self.choices.one_in(6) {
            list.push(("allow", self.allowances()));
        }
        if self.choices.one_in(24) {
            list.push(("exhibit", self.doc()));
        }
        let unique = self.choices.one_in(3);
        let collect = self.modern && matches!(self.output, Type::List(..)) && self.choices.either();
        let policy = if collect {
            "Collect"
        } else if unique {
            "Unique"
        } else {
            "First"
        };
        list.push(("hit_policy", policy.to_owned()));
        let names: Vec<String> = symmetries.into_iter().map(|(name, _)| name).collect();
        let cases = self.cases(unique && !collect, collect, &names);
        let (scope, ty) = (self.scope.clone(), self.output.clone());
        let default = self.quoted(&scope, &ty, 1);
        list.push(("default", default));
        list.push(("language", self.language()));
        Draft { fields: self.choices.shuffled(list), cases, beside }
    }

    /// Adds a field now and then, unless it comes out empty.
    fn put(&mut self, list: &mut Vec<Field>, name: &'static str, make: impl FnOnce(&mut Self) -> String) {
        if self.choices.one_in(3) {
            let value = make(self);
            if !value.is_empty() {
                list.push((name, value));
            }
        }
    }

    fn output(&mut self) -> String {
        let (ty, text) = match self.choices.one_in(4) {
            false => self.simple_output(&[8, 2, 2, 2, 0, 0]),
            true => {
                let fields: Vec<(String, (Type, String))> = (0..self.choices.within(1, 4))
                    .map(|_| (self.plain_name("f"), self.simple_output(&[3, 1, 2, 2, 2, 2])))
                    .collect();
                let texts: Vec<(String, String)> =
                    fields.iter().map(|(name, (_, text))| (name.clone(), text.clone())).collect();
                let types = fields.into_iter().map(|(name, (ty, _))| (name, ty)).collect();
                (Type::Record(types), format!("Record({})", map(&texts)))
            }
        };
        self.one_number = ty == Type::Number;
        self.output = ty;
        text
    }

    /// A number, vector, level, list, condition or whole number, with these weights.
    fn simple_output(&mut self, weights: &[usize; 6]) -> (Type, String) {
        let clamp = match self.choices.one_in(3) {
            true => Some(*self.choices.pick(&["(0, 1)", "(-1, 1)", "(0.1, 0.7)", "(-2, 1e6)", "(0.25, 0.5)"])),
            false => None,
        };
        let sets: Vec<usize> = (0..self.sets.len()).filter(|set| self.sets[*set].name.is_some()).collect();
        let mut weights = *weights;
        if sets.is_empty() {
            (weights[2], weights[3]) = (0, 0);
        }
        match self.choices.weighted(weights.into_iter()) {
            0 => (Type::Number, format!("Number({})", clamp.map_or(String::new(), |clamp| format!("clamp: {clamp}")))),
            1 => {
                let size = self.choices.within(2, 4);
                let clamp = clamp.map_or(String::new(), |clamp| format!(", clamp: {clamp}"));
                (Type::Vector(size), format!("Vector(size: {size}{clamp})"))
            }
            4 => (Type::Condition, "Bool()".to_owned()),
            5 => {
                let from = self.choices.below(9) as i32 - 4;
                let to = from + self.choices.within(1, 5) as i32;
                (Type::Whole(from, to), format!("Int(from: {from}, to: {to})"))
            }
            form => {
                let set = *self.choices.pick(&sets);
                let of = self.sets[set].name.clone().unwrap_or_default();
                if form == 2 {
                    return (Type::Level(set), format!("Enumeration(of: \"{of}\")"));
                }
                let most = self.choices.within(1, 4);
                let list =
                    |ty: Type, of: String| (Type::List(Box::new(ty), most), format!("List(of: {of}, max: {most})"));
                match self.choices.below(5) {
                    0 => list(Type::Vector(2), "Vector(size: 2)".to_owned()),
                    1 => list(Type::Whole(-2, 1), "Int(from: -2, to: 1)".to_owned()),
                    2 => {
                        let inner = Type::List(Box::new(Type::Level(set)), 2);
                        list(inner, format!("List(of: \"{of}\", max: 2)"))
                    }
                    _ => list(Type::Level(set), format!("\"{of}\"")),
                }
            }
        }
    }

    /// Names for conditions and values; a later one may use earlier ones.
    pub(super) fn names(&mut self, depth: usize) -> String {
        let mut written = Vec::new();
        for _ in 0..self.choices.within(1, 4) {
            let ty = match self.choices.below(6) {
                0 | 1 => Type::Number,
                2 | 3 => Type::Condition,
                4 => Type::Vector(self.choices.within(2, 4)),
                _ => {
                    let levels: Vec<Type> = self
                        .scope
                        .visible
                        .iter()
                        .map(|v| v.ty.clone())
                        .filter(|ty| matches!(ty, Type::Level(_)))
                        .collect();
                    if levels.is_empty() { Type::Number } else { self.choices.pick(&levels).clone() }
                }
            };
            let ty = match &self.output {
                Type::List(of, most) if self.modern && matches!(**of, Type::Level(_)) && self.choices.either() => {
                    Type::List(of.clone(), *most)
                }
                _ => ty,
            };
            let scope = self.scope.clone();
            self.alone = matches!(ty, Type::List(..));
            let value = match ty {
                Type::Condition => self.guard(&scope, depth),
                // A bare level has no set by itself.
                Type::Level(set) => {
                    let condition = self.operand(&scope, &Type::Condition, 1, super::expression::OR);
                    let known = scope.of(&ty).first().map_or(String::new(), |visible| visible.text.clone());
                    format!("\"if {condition} {{ {known} }} else {{ {} }}\"", self.level_of(set))
                }
                _ => self.quoted(&scope, &ty, depth),
            };
            self.alone = false;
            let name = self.name("n");
            written.push((name.clone(), value));
            self.scope.add(Visible { text: name, ty, input: false });
        }
        map(&self.choices.shuffled(written))
    }

    fn cases(&mut self, unique: bool, collect: bool, symmetries: &[String]) -> Vec<Case> {
        let count = self.choices.within(1, 7);
        let ids = self.ids(count);
        let mut cases: Vec<Case> = Vec::new();
        // Cases that are written out, and those of them that refer to no other.
        let (mut plain, mut final_ones): (Vec<u32>, Vec<u32>) = (Vec::new(), Vec::new());
        for (number, id) in ids.into_iter().enumerate() {
            let mut list: Vec<Field> = vec![("id", id.to_string())];
            if !symmetries.is_empty() && !plain.is_empty() && self.choices.one_in(4) {
                let (of, under) = (*self.choices.pick(&plain), self.choices.pick(symmetries).clone());
                list.push(("is", format!("(case: {of}, under: \"{under}\")")));
            } else {
                let mut scope = self.scope.clone();
                let refers = !final_ones.is_empty() && self.choices.one_in(3);
                if refers {
                    scope.cases.clone_from(&final_ones);
                } else {
                    final_ones.push(id);
                }
                plain.push(id);
                self.written_out(&mut list, &scope, (unique, collect), number, count);
            }
            self.remarks(&mut list);
            cases.push(Case { id, fields: list, examples: Vec::new() });
        }
        // A case may be an image of one further down.
        if self.choices.one_in(4) { self.choices.shuffled(cases) } else { cases }
    }

    fn ids(&mut self, count: usize) -> Vec<u32> {
        let step = *self.choices.pick(&[1, 1, 3]);
        let first = *self.choices.pick(&[1, 0, 7, u32::MAX - 30]);
        (0..count as u32).map(|number| first + step * number).collect()
    }

    /// Guard and value, or guard and lines.
    fn written_out(
        &mut self,
        list: &mut Vec<Field>,
        scope: &Scope,
        (unique, collect): (bool, bool),
        number: usize,
        count: usize,
    ) {
        let guards = Scope { cases: Vec::new(), ..scope.clone() };
        let depth = self.choices.within(0, 3);
        let guard = match unique && !self.choices.one_in(3) {
            true => self.apart(&guards, number, count),
            false => self.guard(&guards, depth),
        };
        list.push(("when", guard));
        let ty = self.output.clone();
        let depth = self.choices.within(0, 4);
        if !self.choices.one_in(3) {
            let value = self.quoted(scope, &ty, depth);
            list.push(("value", value));
            return;
        }
        let mut lines = self.lines(scope, &guards, &ty, depth);
        if collect && lines.last().is_some_and(|last| last.starts_with('(')) {
            lines.push("\"[]\"".to_owned());
        }
        list.push(("lines", super::list(&lines)));
    }

    /// Values with conditions; the last one may go without.
    pub(super) fn lines(&mut self, scope: &Scope, guards: &Scope, ty: &Type, depth: usize) -> Vec<String> {
        let count = self.choices.within(1, 4);
        let closed = self.choices.either();
        let mut lines = Vec::new();
        for line in 0..count {
            let value = self.quoted(scope, ty, depth);
            let bare = closed && line + 1 == count;
            let condition = if bare { String::new() } else { self.guard(guards, depth.min(2)) };
            lines.push(if bare { value } else { format!("({value}, {condition})") });
        }
        lines
    }

    /// A guard that excludes those of other cases.
    fn apart(&mut self, scope: &Scope, number: usize, count: usize) -> String {
        let part = |name: &str| {
            let level = |share: usize| share as f64 / count as f64;
            format!("{} <= {name} && {name} < {}", level(number), level(number + 1))
        };
        let visible =
            scope.visible.iter().find(|visible| visible.input && matches!(visible.ty, Type::Level(_) | Type::Number));
        let own = match visible.map(|visible| (visible.text.clone(), visible.ty.clone())) {
            Some((name, Type::Level(set))) => {
                let levels = &self.sets[set].levels;
                format!("{name} == {}", levels[number % levels.len()])
            }
            Some((name, _)) => part(&name),
            None => return self.guard(scope, 1),
        };
        let more = self.expression(scope, &Type::Condition, 1);
        let needless = self.choices.one_in(6);
        let more = self.held(more, super::expression::AND + 1, needless);
        format!("\"{own} && {more}\"")
    }

    /// What is said about a case for people, and of its findings.
    fn remarks(&mut self, list: &mut Vec<Field>) {
        if self.choices.one_in(5) {
            list.push(("section", "\"3.1, case 4\"".to_owned()));
        }
        if self.choices.one_in(5) {
            list.push(("doc", self.doc()));
        }
        if self.choices.one_in(8) {
            list.push(("errata", "[(no: 5, printed: \"2 - py - dV\", meant: \"2 - px - dV\")]".to_owned()));
        }
        if self.choices.one_in(6) {
            list.push(("allow", self.allowances()));
        }
    }

    pub(super) fn allowances(&mut self) -> String {
        let codes = ["U0504", "U0505", "U0507", "U0508", "U0509", "U0511", "U0514", "U0520"];
        let one = format!("(code: \"{}\", reason: {})", self.choices.pick(&codes), self.doc());
        list(&[one])
    }
}
