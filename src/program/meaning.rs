//! The fingerprint of what a program means: what profiles, captures and tuned choices know
//! a table by.
//!
//! It is a hash of the typed program, not of a text. Comments, layout, line ends, titles,
//! descriptions, the names of values and functions, acknowledgements and examples are no
//! part of it. Inputs with their levels and ranges, conditions, values, the output,
//! assumptions and symmetries are: whatever changes a result, or a plan.
//!
//! A term is hashed by its form, not by its number in the pool, so that what else is in the
//! pool, and in which order it came there, does not matter. The version stands in front:
//! what another version left cannot be compared, and is known as such.

use std::collections::HashMap;

use super::{Comparison, Cond, CondId, Domain, ExprId, LevelKind, LevelTerm, Levels, Node, Output, Program, Symmetry};
use crate::diag::fnv1a;
use crate::table::HitPolicy;

/// Counts the ways in which fingerprints were made: what is hashed, and what tables are lowered to.
const VERSION: u32 = 1;

/// The relation of a fingerprint that stands in a file to a program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kinship {
    /// It was made when the table meant the same.
    Same,
    /// It was made when the table meant something else.
    Other,
    /// It was made by a version of Umbrage whose fingerprints cannot be compared with these.
    Unknown,
}

impl Program {
    /// Names the meaning of this program: `meaning`, the version of the fingerprint, and 16 hexadecimal digits.
    ///
    /// ```
    /// use umbrage::diag::Source;
    /// use umbrage::program::Program;
    /// use umbrage::table::Table;
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// let commented = Source::new("smsr.ron", format!("// Edges.\n{}", program.source.text));
    /// assert_eq!(Program::check(&Table::parse(commented)?)?.fingerprint(), program.fingerprint());
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn fingerprint(&self) -> String {
        format!("{}{:016x}", prefix(), Meaning { program: self, exprs: HashMap::new(), conds: HashMap::new() }.all())
    }

    /// The relation of a fingerprint to this program.
    pub fn kinship(&self, fingerprint: &str) -> Kinship {
        match fingerprint.starts_with(&prefix()) {
            true if fingerprint == self.fingerprint() => Kinship::Same,
            true => Kinship::Other,
            false => Kinship::Unknown,
        }
    }
}

fn prefix() -> String {
    format!("meaning {VERSION} ")
}

/// The bytes that are hashed of one thing: a word for its kind, and words and hashes for its parts.
struct Words(Vec<u8>);

impl Words {
    fn of(kind: &str) -> Self {
        Self(Vec::new()).text(kind)
    }

    fn word(mut self, word: u64) -> Self {
        self.0.extend(word.to_le_bytes());
        self
    }

    /// A text, with its length, so that two texts in a row are not one.
    fn text(self, text: &str) -> Self {
        let mut words = self.word(text.len() as u64);
        words.0.extend(text.bytes());
        words
    }

    /// A number; both zeros are one.
    fn number(self, number: f64) -> Self {
        self.word((number + 0.0).to_bits())
    }

    /// Parts, with their number.
    fn list(self, parts: Vec<u64>) -> Self {
        let words = self.word(parts.len() as u64);
        parts.into_iter().fold(words, Self::word)
    }

    fn hash(self) -> u64 {
        fnv1a(self.0)
    }
}

struct Meaning<'p> {
    program: &'p Program,
    exprs: HashMap<ExprId, u64>,
    conds: HashMap<CondId, u64>,
}

impl Meaning<'_> {
    fn all(&mut self) -> u64 {
        let program = self.program;
        let policy = match program.hit_policy {
            HitPolicy::First => "first",
            HitPolicy::Unique => "unique",
            HitPolicy::Collect => "collect",
        };
        let inputs = program.inputs.iter().map(|input| {
            let words = Words::of("input").text(&input.name).word(domain(&input.domain));
            // Where a result is the same, the cost of its fetches decides between plans.
            input.fetched.map_or(words.0.clone(), |cost| words.text("fetched").number(cost).0)
        });
        let inputs = inputs.map(fnv1a).collect();
        let mut rows = Vec::new();
        for row in &program.rows {
            let lines = row
                .lines
                .iter()
                .map(|line| Words::of("line").word(self.cond(line.condition)).list(self.values(&line.values)).hash());
            let lines = lines.collect();
            rows.push(Words::of("row").word(u64::from(row.id)).word(self.cond(row.guard)).list(lines).hash());
        }
        let assumptions = program.assumptions.iter().map(|assumption| self.cond(assumption.condition)).collect();
        let symmetries = program.symmetries.iter().map(|symmetry| self.symmetry(symmetry)).collect();
        let default = self.values(&program.default);
        let words = Words::of("program").text(policy).word(output(&program.output)).list(inputs).list(rows);
        words.list(default).list(assumptions).list(symmetries).hash()
    }

    fn values(&mut self, values: &[ExprId]) -> Vec<u64> {
        values.iter().map(|value| self.expr(*value)).collect()
    }

    fn symmetry(&mut self, symmetry: &Symmetry) -> u64 {
        let name = |input: super::InputId| self.program.inputs[input.index()].name.as_str();
        let mut words = Words::of("symmetry").word(symmetry.levels.len() as u64);
        for (input, to) in &symmetry.levels {
            words = words.text(name(*input)).word(self.level(to));
        }
        words = words.word(symmetry.numbers.len() as u64);
        for (input, to) in &symmetry.numbers {
            words = words.text(name(*input)).word(self.expr(*to));
        }
        let result = symmetry.result.iter().flatten().map(|component| self.expr(*component)).collect();
        words.list(result).hash()
    }

    fn level(&mut self, level: &LevelTerm) -> u64 {
        match level {
            LevelTerm::Const(level) => Words::of("level").word(u64::from(*level)),
            LevelTerm::Input(input) => Words::of("level of").word(input.index() as u64),
            LevelTerm::If(condition, a, b) => {
                Words::of("level if").word(self.cond(*condition)).word(self.level(a)).word(self.level(b))
            }
            LevelTerm::Map(of, to) => {
                Words::of("level map").word(self.level(of)).list(to.iter().map(|level| u64::from(*level)).collect())
            }
        }
        .hash()
    }

    fn expr(&mut self, id: ExprId) -> u64 {
        if let Some(hash) = self.exprs.get(&id) {
            return *hash;
        }
        let node = self.program.pool.node(id);
        let words = match node {
            Node::Const(number) => Words::of("number").number(number.get()),
            Node::Word(word) => Words::of("word").word(u64::from(word)),
            Node::Input(input) => Words::of("input").word(input.index() as u64),
            Node::Index(input) => Words::of("index").word(input.index() as u64),
            Node::Result(0) => Words::of("result"),
            Node::Result(component) => Words::of("result").word(u64::from(component)),
            Node::Unary(op, _) => Words::of("unary").text(&format!("{op:?}")),
            Node::Binary(op, ..) => Words::of("binary").text(&format!("{op:?}")),
            Node::Ternary(op, ..) => Words::of("ternary").text(&format!("{op:?}")),
            Node::Select(condition, ..) => Words::of("select").word(self.cond(condition)),
        };
        let hash = words.list(node.children().map(|part| self.expr(part)).collect()).hash();
        self.exprs.insert(id, hash);
        hash
    }

    fn cond(&mut self, id: CondId) -> u64 {
        if let Some(hash) = self.conds.get(&id) {
            return *hash;
        }
        let cond = self.program.pool.cond(id);
        let words = match cond {
            Cond::Const(value) => Words::of("truth").word(u64::from(*value)),
            Cond::Level(input, levels) => Words::of("levels").word(input.index() as u64).word(levels.0),
            Cond::Compare(Comparison::Less, ..) => Words::of("less"),
            Cond::Compare(Comparison::LessEqual, ..) => Words::of("less or equal"),
            Cond::Compare(Comparison::Equal, ..) => Words::of("equal"),
            Cond::Not(_) => Words::of("not"),
            Cond::And(_) => Words::of("and"),
            Cond::Or(_) => Words::of("or"),
            Cond::If(..) => Words::of("if"),
        };
        let words = words.list(cond.compared().map(|part| self.expr(part)).collect());
        let hash = words.list(cond.children().map(|part| self.cond(part)).collect()).hash();
        self.conds.insert(id, hash);
        hash
    }
}

fn domain(domain: &Domain) -> u64 {
    match domain {
        Domain::Discrete(of) => Words::of("discrete").word(levels(of)),
        Domain::Continuous { lo, hi, unit: _ } => Words::of("continuous").number(*lo).number(*hi),
        Domain::Word => Words::of("u32"),
    }
    .hash()
}

fn levels(levels: &Levels) -> u64 {
    let kind = match levels.kind {
        LevelKind::Named => "named",
        LevelKind::Bool => "bool",
        LevelKind::Int => "int",
    };
    let words = Words::of(kind).word(levels.names.len() as u64);
    let words =
        levels.names.iter().zip(&levels.codes).fold(words, |words, (name, code)| words.text(name).number(*code));
    match levels.classes.as_ref().map(|classes| classes.range()) {
        Some((least, most)) => words.number(least as f64).number(most as f64).hash(),
        None => words.hash(),
    }
}

/// The kind of the output. Its clamp is a part of every value.
fn output(of: &Output) -> u64 {
    match of {
        Output::Number(_) => Words::of("number"),
        Output::Vector(size, _) => Words::of("vector").word(*size as u64),
        Output::Bool => Words::of("bool"),
        Output::Int(lo, hi) => Words::of("int").number(f64::from(*lo)).number(f64::from(*hi)),
        Output::U32 => Words::of("u32"),
        Output::Record(fields) => {
            let words = Words::of("record").word(fields.len() as u64);
            fields.iter().fold(words, |words, (name, field)| words.text(name).word(output(field)))
        }
        Output::Enumeration(of) => Words::of("enumeration").word(levels(of)),
        // What `same` says concerns checks, not results.
        Output::List { of, max, same: _ } => Words::of("list").word(output(of)).word(*max as u64),
    }
    .hash()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    const TABLE: &str = r#"Table(
    language: 1, name: "t", title: "A title", source: "A book", hit_policy: First,
    levels: {"L": {"a": 0, "b": 0.5, "c": 1}},
    inputs: {"l": Levels(of: "L", doc: "A level."), "b": Bool(default: false), "x": Range(from: 0, to: 1), "f": Bool(fetched: (cost: 2))},
    names: {"share": "0.5 * x"},
    helpers: {"twice(a)": "a + a"},
    symmetries: {"turned": Symmetry(map: {"b": "!b"}, result: "1 - value")},
    assume: {"calm": ("l != c || !b", "no storm")},
    output: Number(clamp: (0, 2)),
    cases: [
        Case(id: 1, section: "1", doc: "First.", when: "l == a && b", value: "twice(share)"),
        Case(id: 2, when: "x < 0.25 && f", value: "min(x, 0.5)"),
    ],
    default: 0.125,
)
"#;

    fn program(text: &str) -> Program {
        let table = Table::parse(Source::new("t.ron", text));
        table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn what_means_the_same_has_the_same_fingerprint() {
        let meant = program(TABLE).fingerprint();
        assert!(meant.starts_with("meaning 1 ") && meant.len() == 26, "{meant}");
        for (what, of, by) in [
            ("a comment", "cases: [", "/* which? */ cases: [ // these"),
            ("a line end", "\n", "\r\n"),
            ("layout", ", ", ",\n\n      "),
            ("layout of an expression", "l == a && b", "((l==a)   &&b)"),
            ("a title", "A title", "Another title"),
            ("an origin", "A book", "A paper"),
            ("a section", "section: \"1\"", "section: \"2\""),
            ("a description", "First.", "The first one."),
            ("a description of an input", "A level.", "One of three."),
            ("a default", "Bool(default: false)", "Bool(default: true)"),
            ("a name", "share", "part"),
            ("a helper", "twice", "doubled"),
            ("the name of a symmetry", "turned", "mirrored"),
            ("the name of an assumption", "calm", "quiet"),
            ("a reason", "no storm", "no wind"),
            ("a spelling of a number", "0.25", "2.5e-1"),
            ("a name that nothing uses", "\"share\":", "\"unused\": \"x + 7\", \"share\":"),
            ("a condition as data", "when: \"l == a && b\"", "when: {\"l\": [\"a\"], \"b\": [\"true\"]}"),
        ] {
            let text = TABLE.replace(of, by);
            assert_ne!(text, TABLE, "{what}");
            assert_eq!(program(&text).fingerprint(), meant, "{what}");
            assert_eq!(program(&text).kinship(&meant), Kinship::Same, "{what}");
        }
    }

    #[test]
    fn what_means_something_else_has_another_one() {
        let meant = program(TABLE).fingerprint();
        let mut all = std::collections::BTreeSet::from([meant.clone()]);
        for (what, of, by) in [
            ("a hit policy", "First,", "Unique,"),
            ("a code", "0.5, \"c\"", "0.75, \"c\""),
            ("the name of a level", "\"c\": 1", "\"d\": 1"),
            ("a range", "to: 1)", "to: 2)"),
            ("the cost of a fetch", "cost: 2", "cost: 3"),
            ("a fetch", "Bool(fetched: (cost: 2))", "Bool()"),
            ("a named value", "0.5 * x", "0.25 * x"),
            ("a helper", "a + a", "a * a"),
            ("a symmetry", "1 - value", "0.5 - value"),
            ("an assumption", "!b\", \"no", "b\", \"no"),
            ("the bounds of the output", "(0, 2)", "(0, 1)"),
            ("the number of a case", "id: 2", "id: 3"),
            ("a guard", "l == a &&", "l == b &&"),
            ("a comparison", "x < 0.25", "x <= 0.25"),
            ("the order of a guard", "x < 0.25 && f", "f && x < 0.25"),
            ("a value", "min(x, 0.5)", "max(x, 0.5)"),
            ("the default", "0.125", "0.25"),
        ] {
            let text = TABLE
                .replace(of, by)
                .replace("l != c", if what.contains("name of a level") { "l != d" } else { "l != c" });
            assert_ne!(text, TABLE, "{what}");
            let program = program(&text);
            assert!(all.insert(program.fingerprint()), "{what}");
            assert_eq!(program.kinship(&meant), Kinship::Other, "{what}");
        }
        for old in ["fnv1a 3e82e40ab73226cb", "meaning 0 0123456789abcdef", ""] {
            assert_eq!(program(TABLE).kinship(old), Kinship::Unknown, "{old}");
        }
    }
}
