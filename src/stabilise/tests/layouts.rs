//! Valid tables in odd layouts: words of the language in comments and texts, maps on one line, fields in any order,
//! names that additions would have. All of them become what the plain layout becomes.

use super::super::{Added, edit, rewrite, stabilise};
use super::{GAUSSIAN, INTEGRALS, SIDES};
use crate::diag::Source;
use crate::eval::Interpreter;
use crate::points::random::Random;
use crate::program::{Domain, Program, Value};
use crate::table::{Function, Table};
use crate::text::layout::{Item, Layout};
use crate::text::tokens::{Kind, tokens};

/// A table with everything that is edited, short enough to be read a thousand times.
const WAVES: &str = r#"Table(
    language: 1, name: "waves_printed", title: "Table( of functions: {", exhibit: "let: { // as printed", source: "helpers: {",
    inputs: {"x0": Range(from: -10, to: 10), "x1": Range(from: -10, to: 10), "s": Range(from: -20, to: 20, doc: "let: {")},
    constants: {"two": 2},
    helpers: {"twice(a)": "two * a"},
    functions: {
        "f": Function(doc: "functions: { value: Table(", parameters: ["x0", "x1", "s"], let: {"k": "twice(s)"},
            value: "sin(k * x) / k | x = x0 .. x1", limits: [(at: {"s": 0}, value: "x1 - x0")]),
        "let": Function(parameters: ["s"], value: "2 * s", doc: "title: helpers: {"),
    },
)"#;

const COMMENTS: [&str; 8] = [
    "// A Table(...) of functions.\n",
    "// functions: {\n",
    "// \"let: {\n",
    "/* helpers: { /* nested: { */ let: */",
    "/* constants: {\n */",
    "/* title: \" */",
    "// exhibit: name: \"\n",
    "/*)*/",
];

/// Lays tables out in other ways.
struct Layouter {
    random: Random,
    /// The rarity of comments between tokens; zero for everything on one line.
    loose: usize,
}

impl Layouter {
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        Self { loose: [0, 3, 6][random.below(3)], random }
    }

    fn one_in(&mut self, count: usize) -> bool {
        self.random.below(count) == 0
    }

    /// The same table in another layout.
    fn table(&mut self, text: &str) -> String {
        let layout = Layout::new(text);
        let fields = layout.outermost().expect("a table");
        let functions = layout.field(&fields, "functions").map(|field| field.value).expect("functions");
        let of = |place: crate::diag::Span| tokens(&text[place.start..place.end]).into_iter().map(|t| (t.kind, t.text));
        let mut out = vec![(Kind::Atom, "Table"), (Kind::Open, "(")];
        for field in self.shuffled(&fields.items) {
            out.extend(field.key.into_iter().flat_map(of).chain([(Kind::Colon, ":")]));
            if field.value != functions {
                out.extend(of(field.value));
            } else {
                out.push((Kind::Open, "{"));
                for entry in layout.bracket(functions).expect("a map").items {
                    out.extend(entry.key.into_iter().flat_map(of).chain([(Kind::Colon, ":")]));
                    out.extend([(Kind::Atom, "Function"), (Kind::Open, "(")]);
                    for part in self.shuffled(&layout.bracket(entry.value).expect("a function").items) {
                        out.extend(of(part.value.to(part.key.unwrap_or(part.value))).chain([(Kind::Comma, ",")]));
                    }
                    out.extend([(Kind::Close, ")"), (Kind::Comma, ",")]);
                }
                out.push((Kind::Close, "}"));
            }
            out.push((Kind::Comma, ","));
        }
        out.push((Kind::Close, ")"));
        let text = self.written(&out);
        if self.one_in(4) { text.replace('\n', "\r\n") } else { text }
    }

    fn shuffled(&mut self, items: &[Item]) -> Vec<Item> {
        let mut rest = items.to_vec();
        if self.one_in(2) {
            return rest;
        }
        (0..items.len()).map(|_| rest.swap_remove(self.random.below(rest.len()))).collect()
    }

    fn written(&mut self, tokens: &[(Kind, &str)]) -> String {
        let mut text = if self.one_in(8) { "#![enable(implicit_some)]\n".to_owned() } else { String::new() };
        for (at, (kind, token)) in tokens.iter().enumerate() {
            let before = at.checked_sub(1).map(|before| tokens[before].0);
            let closes = tokens.get(at + 1).is_some_and(|(kind, _)| *kind == Kind::Close);
            let left_out = match kind {
                Kind::Atom => matches!(*token, "Table" | "Function") && self.one_in(3),
                Kind::Comma => closes && self.one_in(2),
                _ => false,
            };
            if left_out {
                continue;
            }
            if *kind == Kind::Close && !matches!(before, Some(Kind::Open | Kind::Comma)) && self.one_in(4) {
                text.push(',');
            }
            self.gap(&mut text);
            match kind {
                Kind::Text if !token.starts_with('r') && self.one_in(6) => text.push_str(&format!("r#{token}#")),
                Kind::Text if self.loose > 0 && self.one_in(6) => text.push_str(&token.replace(' ', "\n  ")),
                _ => text.push_str(token),
            }
        }
        text
    }

    fn gap(&mut self, text: &mut String) {
        if self.loose == 0 {
            text.push_str(if self.one_in(3) { "" } else { " " });
            return;
        }
        for _ in 0..self.random.below(3) {
            if self.one_in(self.loose) {
                text.push_str(COMMENTS[self.random.below(COMMENTS.len())]);
            }
            text.push_str(["", " ", "\n", "\t", "\n    ", "  "][self.random.below(6)]);
        }
    }
}

fn parsed(text: &str) -> Table {
    Table::parse(Source::new("odd.ron", text)).unwrap_or_else(|e| panic!("{e}\n{text}"))
}

/// The fingerprints of the functions of a table, by their names.
fn meanings(text: &str) -> Vec<(String, String)> {
    let programs = Program::check_all(&parsed(text)).unwrap_or_else(|e| panic!("{e}\n{text}"));
    programs.iter().map(|program| (program.name.clone(), program.fingerprint())).collect()
}

/// The table with the edits that were found for another layout of it.
fn edited(text: &str, values: &[(&Function, String)], added: &Added) -> String {
    let table = parsed(text);
    let own = |name: &str| table.functions.iter().find(|own| own.name.value == name).expect("the same functions");
    let values: Vec<_> = values.iter().map(|(of, value)| (own(&of.name.value), value.clone())).collect();
    edit::apply(&table, &values, added).unwrap_or_else(|| panic!("no layout\n{text}"))
}

#[test]
fn a_layout_changes_nothing() {
    for (base, count) in [(WAVES, 1100), (GAUSSIAN, 60), (INTEGRALS, 30), (SIDES, 30)] {
        let table = parsed(base);
        let mut added = Added::to(&table);
        let (values, _) = rewrite(&table, &mut added);
        let expected = meanings(&edited(base, &values, &added));
        for seed in 0..count {
            let odd = Layouter::new(seed).table(base);
            let text = edited(&odd, &values, &added);
            assert_eq!(meanings(&text), expected, "{seed}\n{odd}\n{text}");
            assert_eq!(odd.contains('\r'), text.contains("\r\n"), "{seed}");
            assert!(!text.replace("\r\n", "").contains('\r'), "{seed}");
            // Nothing of a comment is lost but what stands in front of an exhibit, or in what is removed.
            let comments = |text: &str| tokens(text).iter().filter(|token| token.is_comment()).count();
            assert!(parsed(&text).exhibit.is_none(), "{seed}");
            assert!(base != INTEGRALS || comments(&text) >= comments(&odd), "{seed}");
        }
    }
}

/// Everything, from text to text, with the formulas read in the odd layout.
#[test]
fn odd_layouts_are_stabilised_like_plain_ones() {
    for (base, count) in [(WAVES, 60), (GAUSSIAN, 8), (SIDES, 4)] {
        let plain = stabilise(&parsed(base)).unwrap_or_else(|e| panic!("{e}"));
        let expected = meanings(&plain.text);
        for seed in 5000..5000 + count {
            let odd = Layouter::new(seed).table(base);
            let stable = stabilise(&parsed(&odd)).unwrap_or_else(|e| panic!("{e}\n{odd}"));
            assert_eq!(meanings(&stable.text), expected, "{seed}\n{odd}");
            assert_eq!((&stable.functions, &stable.kernels), (&plain.functions, &plain.kernels));
        }
    }
}

/// Compares all functions of a table with those of the same names in another one, at random points.
fn close(table: &str, other: &str, what: &str) {
    let programs = |text: &str| Program::check_all(&parsed(text)).unwrap_or_else(|e| panic!("{e}"));
    let others = programs(other);
    for program in programs(table) {
        let other = others.iter().find(|other| other.name == program.name).expect("the same functions");
        let mut random = Random::new(1);
        for _ in 0..20 {
            let point: Vec<Option<Value>> = (program.inputs.iter())
                .map(|input| match input.domain {
                    Domain::Continuous { lo, hi, .. } => Some(Value::Number(lo + (hi - lo) * random.unit())),
                    Domain::Discrete(_) | Domain::Word => None,
                })
                .collect();
            let value = |program: &Program| {
                let outcome = Interpreter::<f64>::new(program).evaluate(&point);
                outcome.map(|outcome| outcome.values[0]).expect("nothing is fetched")
            };
            let (a, b) = (value(&program), value(other));
            assert!(
                (a - b).abs() <= 1e-9 * (1.0 + a.abs()),
                "{what}: {} is {a} or {b}\n{}",
                program.name,
                other.source.text
            );
        }
    }
}

/// A table with an entry more at the start of a map.
fn inserted(text: &str, field: &str, entry: &str) -> String {
    let layout = Layout::new(text);
    let fields = layout.outermost().expect("a table");
    let map = layout.field(&fields, field).and_then(|field| layout.bracket(field.value));
    let (at, entry) = match map {
        Some(map) => (map.open, entry.to_owned()),
        None => (fields.open, format!("{field}: {{{entry}}}, ")),
    };
    format!("{}{entry}{}", &text[..at], &text[at..])
}

/// Names that additions would have, used for something else by the table.
#[test]
fn additions_have_names_of_their_own() {
    let names = ["sinc", "kernel_a", "area_density", "x", "n", "m", "h", "y", "turn", "sigma", "delta", "gauss_4"];
    let mut tried = 0;
    for base in [WAVES, GAUSSIAN, SIDES] {
        let plain = stabilise(&parsed(base)).unwrap_or_else(|e| panic!("{e}")).text;
        let expected = meanings(&plain);
        let first = parsed(base).inputs[0].name.value.clone();
        for name in names {
            let fields = [
                ("helpers", format!("\"{name}(q)\": \"q * 3\""), format!("{name}({first})")),
                ("constants", format!("\"{name}\": 3"), format!("{name} * {first}")),
                ("names", format!("\"{name}\": \"3 * {first}\""), name.to_owned()),
            ];
            for (field, entry, used) in fields {
                let user = format!("\"user\": Function(parameters: [\"{first}\"], value: \"{used}\"), ");
                let with = inserted(base, "functions", &user);
                let with = inserted(&with, field, &format!("{entry}, "));
                let table = parsed(&with);
                // A local value of the table itself may have the name, which is then no name for anything else.
                if Program::check_all(&table).is_err() {
                    continue;
                }
                tried += 1;
                let stable = stabilise(&table).unwrap_or_else(|e| panic!("{e}\n{with}"));
                let found = meanings(&stable.text);
                if found[1..] != expected {
                    // Another name may stand in another place of a sum.
                    close(&plain, &stable.text, &format!("{field} {name}"));
                }
                assert_eq!(found[0].1, meanings(&with)[0].1, "{field} {name}");
            }
        }
    }
    assert!(tried > 90, "{tried}");
}
