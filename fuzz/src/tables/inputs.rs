//! Level sets and inputs: every kind, with or without default, unit, comment and cost.

use super::expression::{Type, Visible};
use super::{Field, Maker, fields, map};

/// Levels that are compared with each other.
pub(super) struct Set {
    /// Its name, if inputs and outputs can refer to it.
    pub(super) name: Option<String>,
    /// The names of its levels; of integers their digits.
    pub(super) levels: Vec<String>,
    /// The codes of its levels.
    pub(super) codes: Vec<String>,
    /// True if its levels are integers, which can be compared with levels only.
    pub(super) integers: bool,
}

/// An input.
pub(super) struct Input {
    /// Its name; of a fetch with arguments a call of it.
    pub(super) name: String,
    pub(super) kind: Kind,
    pub(super) fetched: bool,
    /// The entry that declares it; the further calls of a fetch have none.
    pub(super) written: Option<(String, String)>,
}

/// The values that an input takes.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Kind {
    Levels(usize),
    Bool,
    Range(&'static str, &'static str),
    /// Integers from this one on.
    Wide(Option<i32>),
}

impl Kind {
    pub(super) fn ty(self) -> Type {
        match self {
            Kind::Levels(set) => Type::Level(set),
            Kind::Bool => Type::Condition,
            Kind::Range(..) => Type::Number,
            Kind::Wide(_) => Type::Wide,
        }
    }
}

/// Most states of a table, so that all of them can be gone through for every plan.
const STATES: usize = 192;

impl Maker<'_, '_> {
    /// Levels with their codes.
    fn levels(&mut self, most: usize) -> (Vec<String>, Vec<String>) {
        let words =
            ["none", "left", "right", "top", "both", "case_of", "north", "south", "over", "under", "none_at_all"];
        let most = most.clamp(2, if self.choices.one_in(8) { 9 } else { 4 });
        let count = self.choices.within(2, most);
        let first = self.choices.below(words.len() - count);
        let names: Vec<String> = words[first..first + count].iter().map(|word| (*word).to_owned()).collect();
        // Codes are exact in `f32` and differ.
        let (from, step) = *self.choices.pick(&[(0.0, 1.0), (0.0, 0.25), (-1.0, 1.0), (3.0, -1.5), (0.5, 4.0)]);
        let codes = (0..count).map(|place| format!("{}", from + step * place as f64)).collect();
        (names, codes)
    }

    /// The declaration of level sets; empty if there are none.
    pub(super) fn level_sets(&mut self) -> String {
        let mut written = Vec::new();
        for _ in 0..*self.choices.pick(&[0, 0, 1, 1, 2]) {
            let name = self.plain_name("set");
            let (levels, codes) = self.levels(5);
            let entries: Vec<_> = levels.iter().cloned().zip(codes.iter().cloned()).collect();
            written.push((name.clone(), map(&entries)));
            self.sets.push(Set { name: Some(name), levels, codes, integers: false });
        }
        if written.is_empty() { String::new() } else { map(&written) }
    }

    /// Some inputs, of all kinds.
    pub(super) fn declare_inputs(&mut self, may_fetch: bool) -> String {
        let count = self.choices.within(1, 7);
        let mut states = 1;
        for number in 0..count {
            let fetched = may_fetch && number > 0 && self.choices.one_in(4);
            let room = STATES / states;
            let (kind, mut list, name, size) = self.input(room.min(16), fetched || room < 2);
            if !fetched {
                states *= size;
            }
            let value = match kind {
                Kind::Levels(set) => {
                    let place = self.choices.below(self.sets[set].levels.len());
                    // By name, by name without quotes, or by code.
                    let Set { levels, codes, integers, .. } = &self.sets[set];
                    match self.choices.below(3) {
                        0 if !integers => format!("\"{}\"", levels[place]),
                        1 if !integers => levels[place].clone(),
                        _ => codes[place].clone(),
                    }
                }
                Kind::Bool => (*self.choices.pick(&["false", "true"])).to_owned(),
                Kind::Range(lo, hi) => self.inside((lo, hi)),
                Kind::Wide(_) => self.choices.pick(&["0", "2", "17", "1000000"]).to_string(),
            };
            if self.choices.either() {
                list.push(("default", value));
            }
            if fetched {
                list.push(("fetched", format!("(cost: {})", self.choices.pick(&["1", "0", "2.5", "8"]))));
            }
            if self.choices.one_in(4) {
                list.push(("doc", self.doc()));
            }
            let list = self.choices.shuffled(list);
            let word = match kind {
                Kind::Bool => "Bool",
                Kind::Range(..) => "Range",
                Kind::Wide(_) => "Int",
                Kind::Levels(set) if self.sets[set].integers && list.iter().any(|(name, _)| *name == "from") => "Int",
                Kind::Levels(_) => "Levels",
            };
            let written = format!("{word}({})", fields(&list));
            let (declared, names) = match fetched && self.choices.one_in(3) {
                true => self.calls(&name),
                false => (name.clone(), vec![name]),
            };
            let mut written = Some((declared, written));
            for name in names {
                self.scope.add(Visible { text: name.clone(), ty: kind.ty(), input: true });
                self.inputs.push(Input { name, kind, fetched, written: written.take() });
            }
        }
        let entries: Vec<_> = self.inputs.iter().filter_map(|input| input.written.clone()).collect();
        map(&entries)
    }

    /// A fetch with arguments: its declaration, and some calls, all of them different.
    fn calls(&mut self, name: &str) -> (String, Vec<String>) {
        let all = match self.choices.either() {
            true => ["(0)", "(-1)", "(0.3)", "(1)"].map(|arguments| format!("{name}{arguments}")),
            false => ["(0,0)", "(-1,0.5)", "(0,1e6)", "(1,1)"].map(|arguments| format!("{name}{arguments}")),
        };
        let parameters = if all[0].contains(',') { "(dx, dy)" } else { "(at)" };
        (format!("{name}{parameters}"), self.choices.some(&all))
    }

    /// The kind of an input with at most so many levels, what makes it that, its name, and how many levels it has.
    fn input(&mut self, room: usize, crowded: bool) -> (Kind, Vec<Field>, String, usize) {
        let wide = self.modern && !crowded && room >= 12;
        match self.choices.weighted([4, 6, 4, if crowded { 0 } else { 2 }, usize::from(wide) * 2].into_iter()) {
            0 => (Kind::Bool, Vec::new(), self.name("b"), 2),
            1 => {
                let (lo, hi) = self.bounds();
                let mut list = vec![("from", lo.to_owned()), ("to", hi.to_owned())];
                if self.choices.one_in(4) {
                    list.push(("unit", "\"texel\"".to_owned()));
                }
                (Kind::Range(lo, hi), list, self.name("x"), 1)
            }
            2 => {
                let name = self.name("l");
                let known: Vec<usize> = (0..self.sets.len())
                    .filter(|set| self.sets[*set].name.is_some() && self.sets[*set].levels.len() <= room.max(2))
                    .collect();
                if !known.is_empty() && self.choices.one_in(2) {
                    let set = *self.choices.pick(&known);
                    let of = self.sets[set].name.clone().unwrap_or_default();
                    let of = if self.choices.either() && !of.contains('.') { of } else { format!("\"{of}\"") };
                    return (Kind::Levels(set), vec![("of", of)], name, self.sets[set].levels.len());
                }
                let (levels, codes) = self.levels(room);
                let entries: Vec<_> = levels.iter().cloned().zip(codes.iter().cloned()).collect();
                let size = levels.len();
                self.sets.push(Set { name: Some(name.clone()), levels, codes, integers: false });
                (Kind::Levels(self.sets.len() - 1), vec![("values", map(&entries))], name, size)
            }
            4 => {
                let from = if self.choices.either() { Some(0) } else { None };
                let list = from.map(|from: i32| ("from", from.to_string())).into_iter().collect();
                (Kind::Wide(from), list, self.name("n"), 12)
            }
            _ => {
                let name = self.name("i");
                let size = self.choices.within(2, room.clamp(2, 7));
                let from = self.choices.within(0, 6) as i64 - 3;
                let levels: Vec<String> = (from..from + size as i64).map(|level| level.to_string()).collect();
                let list = vec![("from", from.to_string()), ("to", (from + size as i64 - 1).to_string())];
                let set = Set { name: Some(name.clone()), codes: levels.clone(), levels, integers: true };
                self.sets.push(set);
                (Kind::Levels(self.sets.len() - 1), list, name, size)
            }
        }
    }
}
