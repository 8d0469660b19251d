//! What editors are given by hand agrees with the compiler: the grammar for highlighting knows its words.

use std::collections::BTreeSet;
use std::path::Path;

use serde_json::Value;
use umbrage::program::signatures;
use umbrage::table::fields::{Part, forms};

fn json(path: &str) -> Value {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    let text = std::fs::read_to_string(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
    serde_json::from_str(&text).unwrap_or_else(|e| panic!("{}: {e}", path.display()))
}

/// The words of the alternatives of a pattern, `\b(a|b|c)...`.
fn words(pattern: &Value) -> BTreeSet<String> {
    let pattern = pattern["match"].as_str().expect("a pattern");
    let inner = pattern.split_once('(').and_then(|(_, rest)| rest.split_once(')')).expect("alternatives").0;
    inner.split('|').map(str::to_owned).collect()
}

#[test]
fn the_grammar_for_highlighting_knows_the_words_of_the_language() {
    let grammar = json("editors/vscode/syntaxes/umbrage.tmLanguage.json");
    let patterns = grammar["repository"]["expression"]["patterns"].as_array().expect("patterns").clone();
    let functions = patterns.iter().find(|pattern| pattern["name"] == "support.function.umbrage").expect("functions");
    assert_eq!(words(functions), signatures().map(|function| function.name.to_owned()).collect());
    let patterns = grammar["repository"]["word"]["patterns"].as_array().expect("patterns").clone();
    let known = words(&patterns[0]);
    let parts = [
        Part::Table,
        Part::Case,
        Part::Input,
        Part::Symmetry,
        Part::Function,
        Part::Output,
        Part::Continuity,
        Part::Claim,
        Part::Draw,
        Part::Constant,
        Part::Condition,
    ];
    for form in parts.into_iter().flat_map(forms).filter(|form| !form.is_bare && !form.word.is_empty()) {
        assert!(known.contains(form.word), "the grammar does not know `{}`", form.word);
    }
}

#[test]
fn the_options_of_the_extension_are_documented() {
    let package = json("editors/vscode/package.json");
    let settings = package["contributes"]["configuration"]["properties"].as_object().expect("settings").clone();
    let document = include_str!("../../docs/editors.md");
    for setting in settings.keys() {
        assert!(document.contains(&format!("`{setting}`")), "docs/editors.md does not mention `{setting}`");
    }
}
