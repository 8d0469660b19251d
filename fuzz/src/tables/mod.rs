//! Random tables that are well formed, with every construct of the language.
//!
//! `docs/language.md` lists the constructs; here each is an entry of a registry, a weight and
//! a function, in the file of what it makes: [`numbers`], [`conditions`], [`levels`],
//! [`vectors`], [`records`], [`whole`] for expressions, [`inputs`], [`cases`], [`declarations`],
//! [`functions`] for the parts of a table. A new construct is a function there and its line in
//! the registry; `every_construct_is_made` below fails until it is also looked for in what comes
//! out. What a table means plays no part here: only that it is a table.

mod cases;
mod conditions;
mod declarations;
mod examples;
mod expression;
mod functions;
mod inputs;
mod layout;
mod levels;
mod literals;
mod numbers;
mod records;
mod vectors;
mod whole;

use crate::choices::Choices;
use expression::{Scope, Type};
use inputs::{Input, Set};

/// A field of a table or of one of its parts, and its value in RON.
type Field = (&'static str, String);

/// A table in the making.
pub(crate) struct Maker<'c, 'b> {
    choices: &'c mut Choices<'b>,
    /// Operations that may still be made, so that no table grows without end.
    fuel: usize,
    /// The number of names made so far, each of which is another one.
    names: usize,
    sets: Vec<Set>,
    inputs: Vec<Input>,
    /// What expressions anywhere in the table may mention.
    scope: Scope,
    output: Type,
    /// True if the output is a number and a symmetry may change it.
    one_number: bool,
    /// True if what came with version 2 of the language may occur in expressions.
    modern: bool,
    /// True where nothing says of which set a level is.
    alone: bool,
    /// True if something in the table came with version 2 of the language.
    later: bool,
}

/// A table as text, with the tables that it imports.
pub(crate) struct Written {
    /// The text of the table.
    pub(crate) text: String,
    /// Names and texts of further files in the same directory.
    pub(crate) beside: Vec<(String, String)>,
}

/// Makes a table.
pub(crate) fn table(choices: &mut Choices<'_>) -> Written {
    match choices.one_in(6) {
        false => cases::table(choices),
        true => functions::table(choices),
    }
}

impl<'c, 'b> Maker<'c, 'b> {
    fn new(choices: &'c mut Choices<'b>) -> Self {
        let fuel = *choices.pick(&[12, 40, 120, 300]);
        Self {
            choices,
            fuel,
            names: 0,
            sets: Vec::new(),
            inputs: Vec::new(),
            scope: Scope::default(),
            output: Type::Number,
            one_number: true,
            modern: false,
            alone: false,
            later: false,
        }
    }

    /// A name that was not given before, beginning with some letters.
    fn name(&mut self, kind: &str) -> String {
        self.names += 1;
        // Some letters, so that no name is the beginning of a word of a shading language.
        let mut rest = self.names;
        let mut name = format!("{kind}_");
        while rest > 0 {
            name.push(char::from(b'a' + (rest % 26) as u8));
            rest /= 26;
        }
        name.push('q');
        if self.choices.one_in(24) { name.replacen('_', ".", 1) } else { name }
    }

    /// The same without a dot, for what is no input and no value.
    fn plain_name(&mut self, kind: &str) -> String {
        self.name(kind).replace('.', "_")
    }

    /// A comment for people.
    fn doc(&mut self) -> String {
        let texts = [
            "said once",
            "the shadow's edge",
            "a = b, \\\"so to say\\\"",
            "50 % of it",
            "größer als α",
            "a // b",
            "{x}",
        ];
        format!("\"{}\"", self.choices.pick(&texts))
    }
}

/// Fields as they stand in a struct.
fn fields(list: &[Field]) -> String {
    let parts: Vec<String> = list.iter().map(|(name, value)| format!("{name}: {value}")).collect();
    parts.join(", ")
}

/// A map of texts.
fn map(entries: &[(String, String)]) -> String {
    let parts: Vec<String> = entries.iter().map(|(name, value)| format!("\"{name}\": {value}")).collect();
    format!("{{{}}}", parts.join(", "))
}

/// A list.
fn list(items: &[String]) -> String {
    format!("[{}]", items.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choices::bytes_of;
    use umbrage::diag::Source;
    use umbrage::program::Program;
    use umbrage::program::operators::Operator;
    use umbrage::table::Table;

    fn some(count: u64) -> impl Iterator<Item = Written> {
        (0..count).map(|number| table(&mut Choices::new(&bytes_of(7, "tables", number))))
    }

    /// What a construct looks like; the names of all functions are added.
    const LOOKS: &[&str] = &[
        "source:",
        "title:",
        "First",
        "Unique",
        "Collect",
        "levels:",
        "Levels(of",
        "Levels(values",
        "Bool(",
        "Int(",
        "Range(",
        "default:",
        "unit:",
        "doc:",
        "fetched:",
        "iterate(",
        "lookup(",
        "[[",
        "claims:",
        "Equal(",
        "Within(",
        "(dx, dy)\":",
        "names:",
        "symmetries:",
        "From(",
        "result:",
        "assume:",
        "draw:",
        "Across",
        "Down",
        "Sides(",
        "of: left",
        "Strong(",
        "Dark(",
        "Run(",
        "Position(",
        "continuity:",
        "Border(",
        "Switch(",
        "free:",
        "allow:",
        "exhibit:",
        "Number(",
        "Vector(",
        "Enumeration(",
        "List(",
        "Record(",
        ": Bool()",
        ": Int(",
        "List(of: Vector",
        "List(of: List",
        "::",
        "++",
        ") if ",
        "im(",
        "clamp:",
        "section:",
        "when:",
        "value:",
        "lines:",
        "is:",
        "errata:",
        "examples:",
        "All(",
        "Any(",
        "Not(",
        "case(",
        "let ",
        "if ",
        "select(",
        " in {",
        "sum(",
        "poly(",
        "vec2(",
        "vec3(",
        "vec4(",
        "dot(",
        "length(",
        "distance(",
        "normalize(",
        "cross(",
        "f32(",
        "index(",
        "count(",
        "f32(index",
        " / (1 + abs(",
        "Int(from: 0)",
        "Int()",
        ".x",
        ".rg",
        "==",
        "!=",
        "<",
        "<=",
        ">",
        ">=",
        "&&",
        "||",
        "!",
        "%",
        "..",
        " | ",
        "functions:",
        "Function(",
        "parameters:",
        "constants:",
        "helpers:",
        "imports:",
        "limits:",
        "error:",
        "domain:",
        "let:",
        "r\"",
        "//",
        "/*",
        "Symmetry(",
    ];

    #[test]
    fn every_construct_is_made() {
        let all: String = some(6000).map(|written| written.text).collect();
        let functions = Operator::functions().map(|(name, _)| format!("{name}("));
        let missing: Vec<String> = LOOKS
            .iter()
            .map(|look| (*look).to_owned())
            .chain(functions)
            .filter(|look| !all.contains(look.as_str()))
            .collect();
        assert!(missing.is_empty(), "never made: {missing:?}");
    }

    #[test]
    fn without_choices_a_small_table_is_made() {
        let written = table(&mut Choices::new(&[]));
        assert!(written.text.len() < 400, "{}", written.text);
        let table = Table::parse(Source::new("t.ron", written.text)).unwrap_or_else(|e| panic!("{e}"));
        Program::check(&table).unwrap_or_else(|e| panic!("{e}"));
    }
}
