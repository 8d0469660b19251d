//! What the documentation shows is true: every table in it is a table.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use umbrage::diag::Source;
use umbrage::eval::Interpreter;
use umbrage::program::Program;
use umbrage::program::{Signature, Value, signatures};
use umbrage::table::Table;

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn read(path: &Path) -> String {
    std::fs::read_to_string(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The files of `docs/` with an extension, in order.
fn docs(folder: &str, extension: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(root().join(folder)).unwrap_or_else(|e| panic!("{folder}: {e}"));
    let paths = entries.map(|entry| entry.unwrap_or_else(|e| panic!("{folder}: {e}")).path());
    let mut paths: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|e| e == extension)).collect();
    paths.sort();
    paths
}

/// The fenced blocks of a language, with the line each begins on.
fn blocks<'t>(text: &'t str, language: &str) -> Vec<(usize, &'t str)> {
    let open = format!("```{language}");
    let mut found = Vec::new();
    let (mut offset, mut inside) = (0, None);
    for (number, line) in text.split_inclusive('\n').enumerate() {
        match inside {
            None if line.trim_end() == open => inside = Some((number + 2, offset + line.len())),
            Some((first, start)) if line.trim_end() == "```" => {
                found.push((first, &text[start..offset]));
                inside = None;
            }
            _ => {}
        }
        offset += line.len();
    }
    assert!(inside.is_none(), "a code block is not closed");
    found
}

/// Checks a table and runs its examples; returns how many there are.
fn check(name: &str, text: &str) -> usize {
    let programs = Table::parse(Source::new(name, text)).and_then(|table| Program::check_all(&table));
    let programs = programs.unwrap_or_else(|failure| panic!("{failure}"));
    programs.iter().map(|program| run(name, program)).sum()
}

fn run(name: &str, program: &Program) -> usize {
    let mut interpreter = Interpreter::<f32>::new(program);
    for example in &program.examples {
        let place = format!("{name}:{}", program.line(example.span));
        let got = interpreter.evaluate(&example.inputs).unwrap_or_else(|n| panic!("{place}: {n:?}"));
        // Of a case that stands for its images any of them may be taken.
        let case = |row: usize| program.rows[row].id;
        assert_eq!(got.row.map(case), Some(case(example.row)), "{place}: another case is taken");
        let values: Vec<f64> = got.values.iter().map(|value| f64::from(*value)).collect();
        assert_eq!(values, example.expected, "{place}");
    }
    program.examples.len()
}

#[test]
fn tables_in_the_text_are_tables() {
    let mut texts = docs("docs", "md");
    texts.push(root().join("README.md"));
    for path in texts {
        let text = read(&path);
        for (line, block) in blocks(&text, "ron") {
            if block.starts_with("Table(") {
                check(&format!("{}, block at line {line}", path.display()), block);
            }
        }
    }
}

#[test]
fn example_tables_are_tables() {
    let paths = docs("docs/examples", "ron");
    assert!(!paths.is_empty());
    for path in paths {
        let examples = check(&path.to_string_lossy(), &read(&path));
        assert!(examples > 0, "{} has no examples", path.display());
    }
}

/// The tutorial shows its tables piece by piece; each piece is in one of them, word for word.
#[test]
fn the_tutorial_shows_its_tables() {
    let plain = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let tables: Vec<String> = docs("docs/examples", "ron").iter().map(|path| plain(&read(path))).collect();
    let text = read(&root().join("docs/language.md"));
    let (tutorial, _) = text.split_once("\n## 2").expect("the tutorial is the first chapter");
    let pieces = blocks(tutorial, "ron");
    assert!(pieces.len() > 8, "the tutorial shows pieces of its tables");
    for (line, piece) in pieces {
        let is_there = tables.iter().any(|table| table.contains(&plain(piece)));
        assert!(is_there, "docs/language.md:{line} is in none of docs/examples");
    }
}

/// 256 neighbourhoods need 47 tiles, as the table says of itself.
#[test]
fn blob_tiles_are_47() {
    let program = Program::read(root().join("docs/examples/blob_tiles.ron")).unwrap_or_else(|e| panic!("{e}"));
    let mut interpreter = Interpreter::<f64>::new(&program);
    let tile = |state: u32| {
        let point: Vec<Option<Value>> = (0..8).map(|bit| Some(Value::Level((state >> bit & 1) as u8))).collect();
        interpreter.evaluate(&point).expect("nothing is fetched").values[0] as u32
    };
    let tiles: BTreeSet<u32> = (0..256).map(tile).collect();
    assert_eq!(tiles.len(), 47);
    assert!(tiles.contains(&0) && tiles.contains(&255));
}

/// The reference lists the functions of the language as the compiler has them.
#[test]
fn the_reference_lists_the_functions() {
    let row = |function: Signature| format!("| `{}({})` | {} |\n", function.name, function.parameters, function.doc);
    let rows: String = signatures().map(row).collect();
    let text = read(&root().join("docs/language.md"));
    assert!(text.contains(&rows), "the table of functions in docs/language.md must have these rows:\n{rows}");
}

/// The reference names every diagnostic code and every word it reserves.
#[test]
fn the_reference_is_complete() {
    let text = read(&root().join("docs/language.md"));
    for entry in umbrage::diag::codes::ALL {
        let row = format!("| {} | {} |", entry.code, entry.meaning);
        assert!(text.contains(&row), "the table of codes lacks: {row}");
    }
}
