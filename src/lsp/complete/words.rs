//! Names, levels and functions that could stand within a text in quotes.

use lsp_types::CompletionItemKind;

use super::context::Context;
use super::{Item, finding_codes};
use crate::lsp::document::{Document, Known};
use crate::program::signatures;
use crate::table::lex::{Token, tokens};
use crate::uses::{Kind, Symbol, SymbolId};

/// Words of expressions.
const KEYWORDS: [&str; 7] = ["if", "else", "let", "in", "case", "true", "false"];

/// Candidates for the end of a text in quotes as far as it is there, and how much of them is there already.
pub(super) fn in_text(document: &Document, context: &Context<'_>, text: &str) -> (Vec<Item>, usize) {
    let fields = context.fields();
    let Some(known) = document.known() else { return (expression(None, None, text), partial(text).len()) };
    let inner = context.frames.last();
    let whole = text.len();
    // A key of a map, or a value behind one, or an item of a list behind one.
    let is_key = inner.is_some_and(|frame| frame.bracket == '{' && frame.key.is_none());
    let map = context.frames.iter().rev().find(|frame| frame.bracket == '{');
    match fields.as_slice() {
        ["inputs", "of"] | ["output", ..] | ["constants", "of"] => {
            return (of_kinds(known, &[Kind::Set, Kind::Input]), whole);
        }
        [.., "under" | "images"] => return (of_kinds(known, &[Kind::Symmetry]), whole),
        [.., "allow", "code"] => return (finding_codes(), whole),
        // Names of what is declared here, and words for people.
        [
            "inputs" | "levels" | "groups" | "symmetries" | "functions" | "imports" | "constants" | "helpers"
            | "claims",
        ] if is_key => {
            return (Vec::new(), whole);
        }
        [.., "parameters" | "free" | "for"] | ["groups"] | ["continuity", "of"] => {
            return (of_kinds(known, &[Kind::Input]), whole);
        }
        ["names" | "assume"] if is_key && context.frames.len() == 2 => return (Vec::new(), whole),
        [.., "doc" | "title" | "source" | "section" | "reason" | "unit" | "printed" | "meant" | "exhibit" | "name"] => {
            return (Vec::new(), whole);
        }
        ["draw"] if is_key && context.frames.len() == 2 => return (of_kinds(known, &[Kind::Input]), whole),
        _ => {}
    }
    // Conditions as data, examples, maps: inputs and what they are.
    if let Some(map) = map.filter(|_| inner.is_some_and(|frame| frame.bracket != '(')) {
        if is_key {
            let of_map = context.frames.iter().rev().filter(|frame| frame.bracket == '{').nth(1);
            // In the map of a symmetry an input has a map of its levels.
            return match of_map.and_then(|outer| outer.key).and_then(|key| levels_of(known, key)) {
                Some(levels) => (levels, whole),
                None => (of_kinds(known, &[Kind::Input, Kind::Name, Kind::Group]), whole),
            };
        }
        if let Some(levels) = map.key.and_then(|key| levels_of(known, key)) {
            let mut items = levels;
            // The map of a symmetry and an example have expressions as well.
            items.extend(expression(Some(known), None, text));
            return (items, partial(text).len());
        }
    }
    let result = match fields.as_slice() {
        [.., "value" | "default"] | ["cases", "lines"] => known.uses.output,
        _ => None,
    };
    (expression(Some(known), result, text), partial(text).len())
}

/// Levels and names that may stand without quotes.
pub(super) fn bare(document: &Document, context: &Context<'_>, key: &str) -> Vec<Item> {
    let Some(known) = document.known() else { return Vec::new() };
    match (key, context.fields().as_slice()) {
        ("of", _) => of_kinds(known, &[Kind::Set, Kind::Input]),
        ("under", _) => of_kinds(known, &[Kind::Symmetry]),
        // The default of an input is one of its levels; that of the table is a result.
        ("default", ["inputs", ..]) => {
            let map = context.frames.iter().find(|frame| frame.bracket == '{');
            map.and_then(|map| map.key).and_then(|input| levels_of(known, input)).unwrap_or_default()
        }
        ("default", _) => known.uses.output.map(|set| of_set(known, set)).unwrap_or_default(),
        _ => Vec::new(),
    }
}

/// The word that is being written at the end of a text, dots included.
fn partial(text: &str) -> &str {
    let start = text.rfind(|c: char| !(c.is_ascii_alphanumeric() || c == '_' || c == '.')).map_or(0, |at| at + 1);
    text.get(start..).unwrap_or_default()
}

/// Candidates for the end of an expression; of results that are levels, those of a set.
fn expression(known: Option<&Known>, result: Option<SymbolId>, text: &str) -> Vec<Item> {
    let before = &text[..text.len() - partial(text).len()];
    let words: Vec<Token<'_>> =
        tokens(before, 0).map(|all| all.into_iter().map(|(_, token)| token).collect()).unwrap_or_default();
    let words = words.strip_suffix(&[Token::End]).unwrap_or(&words);
    let mut items = Vec::new();
    if let Some(known) = known {
        match words {
            [.., Token::Word("case"), Token::Symbol("(")] => return of_kinds(known, &[Kind::Case]),
            [.., Token::Word(set), Token::Symbol("::")] => {
                return set_named(known, set).map(|set| of_set(known, set)).unwrap_or_default();
            }
            [.., Token::Word(input), Token::Symbol("==" | "!=" | "=")] => {
                items.extend(levels_of(known, input).unwrap_or_default());
            }
            _ => {}
        }
        if let Some(input) = member_of(words) {
            return levels_of(known, input).unwrap_or_default();
        }
        items.extend(result.map(|set| of_set(known, set)).unwrap_or_default());
        items.extend(locals(words));
        items.extend(of_kinds(
            known,
            &[Kind::Input, Kind::Name, Kind::Constant, Kind::Helper, Kind::Function, Kind::Local],
        ));
        items.extend(imported(known));
    }
    items.extend(signatures().map(|function| {
        let item = Item::new(
            function.name,
            CompletionItemKind::FUNCTION,
            format!("{}({})", function.name, function.parameters),
        );
        item.about(Some(function.doc)).writing(format!("{}($0)", function.name))
    }));
    items.extend(KEYWORDS.map(|word| Item::new(word, CompletionItemKind::KEYWORD, "")));
    items
}

/// The word before `in {`, if the place is in these braces.
fn member_of<'t>(words: &[Token<'t>]) -> Option<&'t str> {
    let open = words.iter().rposition(|token| *token == Token::Symbol("{"))?;
    let closed = words[open..].contains(&Token::Symbol("}"));
    match (&words[..open], closed) {
        ([.., Token::Word(input), Token::Word("in")], false) => Some(input),
        _ => None,
    }
}

/// The names that `let` gives further up in an expression.
fn locals(words: &[Token<'_>]) -> Vec<Item> {
    let pairs = words.windows(2).filter_map(|pair| match pair {
        [Token::Word("let"), Token::Word(name)] => Some(*name),
        _ => None,
    });
    pairs.map(|name| Item::new(name, CompletionItemKind::VARIABLE, "a local value")).collect()
}

/// Everything of some kinds that the table declares.
fn of_kinds(known: &Known, kinds: &[Kind]) -> Vec<Item> {
    let mut items: Vec<Item> = Vec::new();
    for kind in kinds {
        let own = known.uses.symbols().filter(|(_, symbol)| symbol.source.name == known.table.source.name);
        for (_, symbol) in own.filter(|(_, symbol)| symbol.kind == *kind) {
            // Locals of one expression mean nothing in another; those of functions do, in theirs.
            if *kind == Kind::Local && symbol.of.is_none() {
                continue;
            }
            items.push(item(known, symbol));
        }
    }
    items.dedup_by(|a, b| a.label == b.label);
    items
}

fn item(known: &Known, symbol: &Symbol) -> Item {
    let detail = match symbol.kind {
        Kind::Case => symbol.doc.clone(),
        kind => kind.words().to_owned(),
    };
    let kind = match symbol.kind {
        Kind::Helper | Kind::Function => CompletionItemKind::FUNCTION,
        Kind::Level => CompletionItemKind::ENUM_MEMBER,
        Kind::Constant => CompletionItemKind::CONSTANT,
        Kind::Set | Kind::Group => CompletionItemKind::ENUM,
        Kind::Case => CompletionItemKind::REFERENCE,
        Kind::Symmetry => CompletionItemKind::OPERATOR,
        Kind::Import => CompletionItemKind::MODULE,
        Kind::Name => CompletionItemKind::PROPERTY,
        Kind::Input | Kind::Parameter | Kind::Local | Kind::Assumption | Kind::Continuity | Kind::Claim => {
            CompletionItemKind::VARIABLE
        }
    };
    let called = matches!(symbol.kind, Kind::Helper | Kind::Function)
        || known.table.inputs.iter().any(|input| input.name.value == symbol.name && !input.parameters.is_empty());
    let item = Item::new(symbol.name.as_str(), kind, detail).about(Some(&symbol.doc));
    if called { item.writing(format!("{}($0)", symbol.name)) } else { item }
}

/// The levels of an input or of a name that stands for a level, or the truths of one that is a condition.
fn levels_of(known: &Known, name: &str) -> Option<Vec<Item>> {
    let word = name.split('(').next().unwrap_or(name).trim();
    let named =
        known.uses.symbols().find(|(_, symbol)| symbol.name == word && matches!(symbol.kind, Kind::Input | Kind::Name));
    if let Some(set) = named.and_then(|(_, symbol)| symbol.set) {
        return Some(of_set(known, set));
    }
    let is_bool = known
        .table
        .inputs
        .iter()
        .any(|input| input.name.value == word && input.domain.value == crate::table::Domain::Bool);
    is_bool.then(|| ["false", "true"].map(|word| Item::new(word, CompletionItemKind::VALUE, "")).into())
}

/// The set with a name: a level set, or an input that has levels.
fn set_named(known: &Known, name: &str) -> Option<SymbolId> {
    let found =
        known.uses.symbols().find(|(_, symbol)| symbol.name == name && matches!(symbol.kind, Kind::Set | Kind::Input));
    found.map(|(id, symbol)| symbol.set.unwrap_or(id))
}

fn of_set(known: &Known, set: SymbolId) -> Vec<Item> {
    let detail = format!("a level of {}", known.uses[set].name);
    let levels = known.uses.levels(set);
    levels.map(|(_, level)| Item::new(level.name.as_str(), CompletionItemKind::ENUM_MEMBER, detail.as_str())).collect()
}

/// The functions and constants of imported tables, and the tables of cases themselves.
fn imported(known: &Known) -> Vec<Item> {
    let mut items = Vec::new();
    for import in &known.table.imports {
        let (alias, Some(table)) = (&import.alias.value, &import.table) else { continue };
        if !table.cases.is_empty() {
            let item = Item::new(alias.as_str(), CompletionItemKind::FUNCTION, table.title.as_str());
            items.push(item.writing(format!("{alias}($0)")));
        }
        for function in &table.functions {
            let label = format!("{alias}.{}", function.name.value);
            let parameters: Vec<&str> = function.parameters.iter().map(|name| name.value.as_str()).collect();
            let item =
                Item::new(label.as_str(), CompletionItemKind::FUNCTION, format!("{label}({})", parameters.join(", ")));
            items.push(item.about(Some(&function.doc)).writing(format!("{label}($0)")));
        }
        for constant in &table.constants {
            let label = format!("{alias}.{}", constant.name.value);
            items.push(Item::new(label, CompletionItemKind::CONSTANT, "constant data"));
        }
    }
    items
}
