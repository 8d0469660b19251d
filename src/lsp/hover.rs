//! The text that is shown of a word: its declaration, its levels, how often a case is taken, and its picture.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use lsp_types::{Hover, HoverContents, MarkupContent, MarkupKind};

use super::complete::{field_at, function_at};
use super::document::{Document, Known};
use super::navigate::symbols;
use super::settings::Settings;
use crate::atlas::Atlas;
use crate::diag::{Failure, Span, visible};
use crate::explain::{self, code, text};
use crate::picture;
use crate::profile::{self, Profile};
use crate::program::Program;
use crate::show::Precision;
use crate::uses::{Kind, Symbol, SymbolId};

/// Pixels per unit of the drawing of a case.
const SCALE: f32 = 1.0;

/// The text that is shown of a place; nothing, if nothing is known of it.
pub(super) fn hover(document: &Document, offset: usize, settings: &Settings) -> Option<Hover> {
    let (markdown, place) = of_word(document, offset, settings)
        .or_else(|| of_code(document, offset))
        .or_else(|| of_language(document, offset))
        .or_else(|| of_example(document, offset))?;
    let contents = MarkupContent { kind: MarkupKind::Markdown, value: visible(&markdown).into_owned() };
    Some(Hover { contents: HoverContents::Markup(contents), range: Some(document.range(place)) })
}

/// A word that is declared in the table.
fn of_word(document: &Document, offset: usize, settings: &Settings) -> Option<(String, Span)> {
    let (known, place, found) = symbols(document, offset)?;
    let parts: Vec<String> = found.iter().map(|symbol| of_symbol(document, known, *symbol, settings)).collect();
    Some((parts.join("\n\n---\n\n"), document.forth(place)?))
}

fn of_symbol(document: &Document, known: &Known, id: SymbolId, settings: &Settings) -> String {
    let symbol = &known.uses[id];
    let mut out = match symbol.kind {
        Kind::Case => format!("**case {}**", symbol.name),
        kind => format!("**{}**, {}", symbol.name, kind.words()),
    };
    if let Some(of) = symbol.of {
        let _ = write!(out, " of `{}`", known.uses[of].name);
    }
    if symbol.source.name != document.source.name {
        let _ = write!(out, " in `{}`", file(&symbol.source.name));
    }
    if !symbol.doc.is_empty() {
        let _ = write!(out, "\n\n{}", escaped(&symbol.doc));
    }
    match symbol.kind {
        Kind::Case => of_case(&mut out, document, known, symbol, settings),
        Kind::Level => {}
        Kind::Input
        | Kind::Set
        | Kind::Name
        | Kind::Group
        | Kind::Constant
        | Kind::Helper
        | Kind::Function
        | Kind::Parameter
        | Kind::Local
        | Kind::Symmetry
        | Kind::Import
        | Kind::Assumption
        | Kind::Continuity
        | Kind::Claim => {
            let written = &symbol.source.text[symbol.whole.start..symbol.whole.end];
            let _ = write!(out, "\n\n```ron\n{}\n```", unindented(written));
        }
    }
    levels(&mut out, known, id);
    out
}

/// The levels of a set or input, with their codes.
fn levels(out: &mut String, known: &Known, id: SymbolId) {
    let symbol = &known.uses[id];
    let set = match symbol.kind {
        Kind::Level => symbol.of,
        Kind::Set => None,
        Kind::Input | Kind::Name => symbol.set.filter(|set| *set != id),
        Kind::Group
        | Kind::Constant
        | Kind::Helper
        | Kind::Function
        | Kind::Parameter
        | Kind::Local
        | Kind::Case
        | Kind::Symmetry
        | Kind::Import
        | Kind::Assumption
        | Kind::Continuity
        | Kind::Claim => None,
    };
    let Some(set) = set else { return };
    let all: Vec<String> = known
        .uses
        .levels(set)
        .map(|(level, found)| {
            let mark = if level == id { "**" } else { "" };
            format!("{mark}`{}`{mark}", found.name)
        })
        .collect();
    let _ = write!(out, "\n\nLevels of `{}`: {}", known.uses[set].name, all.join(", "));
}

/// The row of a case, how often it is taken, and its picture.
fn of_case(out: &mut String, document: &Document, known: &Known, symbol: &Symbol, settings: &Settings) {
    let function = symbol.of.map(|of| known.uses[of].name.as_str());
    let of = |program: &&Program| program.function.as_ref().map(|function| function.name.as_str()) == function;
    let Some(program) = known.programs().iter().find(of) else { return };
    let Some(index) = program.rows.iter().position(|row| row.id.to_string() == symbol.name) else { return };
    let row = &program.rows[index];
    if !row.section.is_empty() {
        let _ = write!(out, "\n\nSection {}", escaped(&row.section));
    }
    let text = |span: Span| unindented(&program.source.text[span.start..span.end]);
    let mut rows = format!("when  {}", text(row.guard_span));
    for line in &row.lines {
        let condition = line.condition_span.map_or(String::new(), |span| format!("   where {}", text(span)));
        let _ = write!(rows, "\nvalue {}{condition}", text(line.span));
    }
    let _ = write!(out, "\n\n```\n{rows}\n```");
    let shares = match counted(document, program, settings) {
        Some((name, Ok(profile))) => {
            share(out, &name, &profile, row.id);
            Some(profile::shares(&profile, program))
        }
        Some((name, Err(failure))) => {
            let reason = failure.diagnostics.first().map_or("", |first| first.message.as_str());
            let _ = write!(out, "\n\nThe profile `{name}` is not used: {}", escaped(reason));
            None
        }
        None => None,
    };
    if settings.pictures
        && let Ok(panel) = Atlas::panel(program, index, shares.as_deref())
        && let Ok(picture) = picture::raster(&panel.svg(), SCALE)
        && let Ok(address) = picture::data_uri(&picture)
    {
        let _ = write!(out, "\n\n![case {}]({address})", row.id);
    }
}

/// The share of a case, by a profile.
fn share(out: &mut String, name: &str, profile: &Profile, case: u32) {
    let found = profile::frequencies(profile).into_iter().find(|frequency| frequency.case == Some(case));
    let Some(found) = found else {
        let _ = write!(out, "\n\nIt does not occur in `{name}`.");
        return;
    };
    let _ = write!(out, "\n\nTaken in {:.2} % of `{name}`", 100.0 * found.share);
    let scenes = profile.scenes.iter().zip(&found.scenes);
    let scenes: Vec<String> = scenes.map(|(scene, share)| format!("{} {:.2} %", scene.name, 100.0 * share)).collect();
    if scenes.len() > 1 {
        let _ = write!(out, ": {}", scenes.join(", "));
    }
}

/// The profile of a table: the file of its name in the directory that the editor names, or in `profiles`
/// beside the table or above, up to what the editor has open.
fn counted(document: &Document, program: &Program, settings: &Settings) -> Option<(String, Result<Profile, Failure>)> {
    let name = format!("{}.ron", program.name);
    let table = Path::new(&document.source.name);
    let mut places: Vec<PathBuf> = settings.profiles.iter().map(|directory| directory.join(&name)).collect();
    for above in table.ancestors().skip(1) {
        places.push(above.join("profiles").join(&name));
        if settings.roots.iter().any(|root| root == above) {
            break;
        }
    }
    let path = places.into_iter().find(|path| path.is_file())?;
    let fitted = profile::read(&path).and_then(|read| profile::fit(program, read, &name));
    Some((format!("profiles/{name}"), fitted.map(|fitted| fitted.profile)))
}

/// A code of a finding, as in an `allow`.
fn of_code(document: &Document, offset: usize) -> Option<(String, Span)> {
    let source = &document.source.text;
    let inside = |c: char| c.is_ascii_alphanumeric();
    let start = source.get(..offset)?.rfind(|c| !inside(c)).map_or(0, |at| at + 1);
    let end = offset + source[offset..].find(|c| !inside(c)).unwrap_or(source.len() - offset);
    let word = source.get(start..end).filter(|word| code::is_code(word))?;
    let entry = code::entry(word)?;
    Some((format!("**{}**: {}\n\n{}", entry.code, entry.meaning, entry.text), Span::new(start, end)))
}

/// A field of the language, or a function of it.
fn of_language(document: &Document, offset: usize) -> Option<(String, Span)> {
    function_at(&document.source.text, offset).or_else(|| field_at(&document.source.text, offset))
}

/// An example: the case that it leads to, and how its value comes about.
fn of_example(document: &Document, offset: usize) -> Option<(String, Span)> {
    let known = document.known()?;
    let before = document.back(offset)?;
    let found = known.programs().iter().find_map(|program| {
        let here = |span: Span| span.start <= before && before <= span.end;
        Some((program, program.examples.iter().find(|example| here(example.span))?))
    });
    let (program, example) = found?;
    let explained = explain::explain(program, &example.inputs, Precision::F32).ok()?;
    let shown = text::render(program, &explained, &[]);
    Some((format!("```text\n{}\n```", shown.trim_end()), document.forth(example.span)?))
}

/// The last part of a path.
fn file(name: &str) -> &str {
    name.rsplit('/').next().unwrap_or(name)
}

/// A text as Markdown that shows it as it is.
fn escaped(text: &str) -> String {
    let special = |c: char| "\\`*_{}[]<>#|~".contains(c);
    text.chars().flat_map(|c| special(c).then_some('\\').into_iter().chain([c])).collect()
}

/// A piece of a table whose further lines stood indented as far as its surroundings.
fn unindented(text: &str) -> String {
    let blanks = |line: &str| line.len() - line.trim_start().len();
    let least = text.lines().skip(1).filter(|line| !line.trim().is_empty()).map(blanks).min().unwrap_or(0);
    let mut lines = text.lines();
    let first = lines.next().unwrap_or_default().to_owned();
    lines.fold(first, |all, line| all + "\n" + line.get(least.saturating_sub(4)..).unwrap_or_default())
}
