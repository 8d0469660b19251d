//! Uses that are found are judged by the compiler: a table in which a declaration has another name everywhere
//! is a table still, and means the same.

use super::{Kind, Uses};
use crate::diag::{Failure, Label, Source, codes};
use crate::program::Program;
use crate::table::Table;

fn tables() -> Vec<std::path::PathBuf> {
    let folders = ["tables", "tables/published", "docs/examples", "docs", "tests/tables/pass", "tests/tables/finding"];
    let files = folders.iter().flat_map(|folder| std::fs::read_dir(folder).unwrap_or_else(|e| panic!("{folder}: {e}")));
    let mut files: Vec<_> = files.map(|entry| entry.unwrap_or_else(|e| panic!("{e}")).path()).collect();
    files.retain(|path| path.extension().is_some_and(|extension| extension == "ron"));
    files.sort();
    files
}

/// Another name of the same form that nothing has.
fn other(kind: Kind, name: &str) -> String {
    match kind {
        Kind::Case => "4000000000".to_owned(),
        _ => format!("q{}zz", name.replace('.', "q")),
    }
}

#[test]
fn every_declaration_of_every_table_can_have_another_name() {
    let mut count = 0;
    for path in tables() {
        let Ok(table) = Table::read(&path) else { continue };
        if Program::check_all(&table).is_err() {
            continue;
        }
        let uses = Uses::of(&table);
        let mut wrong = Vec::new();
        // All declarations of a table take long one by one; every name, and of the rest some of each kind.
        let mut tried = std::collections::HashMap::new();
        for (id, symbol) in uses.symbols().filter(|(_, symbol)| std::sync::Arc::ptr_eq(&symbol.source, &table.source)) {
            let of_kind: &mut usize = tried.entry(symbol.kind).or_default();
            *of_kind += 1;
            let numeral = symbol.name.starts_with(|c: char| c.is_ascii_digit() || c == '-');
            if *of_kind > 6 || (numeral && symbol.kind != Kind::Case) {
                continue;
            }
            let mut text = table.source.text.clone();
            for span in uses.renamed(id).into_iter().rev() {
                text.replace_range(span.start..span.end, &other(symbol.kind, &symbol.name));
            }
            let renamed = Source::new(table.source.name.as_str(), text);
            let checked = Table::parse(renamed).and_then(|table| Program::check_all(&table));
            count += 1;
            // A call that leaves parameters out means what has their names where it stands.
            // So does a level that a symmetry does not mention, and the one of its name in another set.
            let implied = |failure: &Failure| {
                let text = |label: &Label| failure.source.text[label.span.start..label.span.end].trim_matches('"');
                failure.diagnostics.iter().all(|d| {
                    let elsewhere = d.labels.first().is_some_and(|label| text(label) != symbol.name);
                    d.code == codes::PARAMETER || (d.code == codes::UNKNOWN_LEVEL && elsewhere)
                })
            };
            if let Err(failure) = checked
                && !implied(&failure)
            {
                wrong.push(format!("{:?} `{}`:\n{failure}", symbol.kind, symbol.name));
            }
        }
        assert!(wrong.is_empty(), "{}\n{}", path.display(), wrong.join("\n"));
    }
    assert!(count > 500, "{count}");
}

#[test]
fn a_level_is_of_the_set_that_its_surroundings_say() {
    let table = "Table(language: 2, name: \"t\", hit_policy: First,
        levels: {\"a\": {\"one\": 0, \"two\": 1}, \"b\": {\"one\": 0, \"two\": 1}},
        inputs: {\"x\": Levels(of: \"a\"), \"y\": Levels(of: \"b\")},
        output: Enumeration(of: \"b\"),
        cases: [Case(id: 1, when: \"x == one && (if y == two { y } else { two }) != one\", value: \"if x in {two} { one } else { a_b }\")],
        names: {\"a_b\": \"b::two\"},
        default: one)";
    let table = Table::parse(Source::new("t", table)).unwrap_or_else(|e| panic!("{e}"));
    let uses = Uses::of(&table);
    let count = |set: &str, level: &str| {
        let (id, _) = (uses.symbols())
            .find(|(_, symbol)| symbol.name == level && symbol.of.is_some_and(|of| uses[of].name == set))
            .unwrap_or_else(|| panic!("{set}::{level}"));
        uses.occurrences(id).count() - 1
    };
    assert_eq!((count("a", "one"), count("a", "two"), count("b", "one"), count("b", "two")), (1, 1, 3, 3));
}
