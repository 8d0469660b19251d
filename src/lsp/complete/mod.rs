//! Completion: fields where a field can stand, and in texts the names, levels and functions.

mod context;
mod words;

use lsp_types::{
    CompletionItem, CompletionItemKind, CompletionResponse, CompletionTextEdit, Documentation, InsertTextFormat,
    MarkupContent, MarkupKind, TextEdit,
};

use super::document::Document;
use super::settings::Settings;
use crate::diag::{Span, codes};
use crate::program::signatures;
use crate::table::fields::{Form, Part, forms, meaning};
use context::{Context, context};

/// Something that could stand here, as an editor shows it.
pub(super) struct Item {
    label: String,
    kind: CompletionItemKind,
    detail: String,
    doc: Option<String>,
    /// The text that is written, if it is not the label; `$0` is where to go on.
    written: Option<String>,
}

impl Item {
    pub(super) fn new(label: impl Into<String>, kind: CompletionItemKind, detail: impl Into<String>) -> Self {
        Self { label: label.into(), kind, detail: detail.into(), doc: None, written: None }
    }

    pub(super) fn writing(mut self, text: impl Into<String>) -> Self {
        self.written = Some(text.into());
        self
    }

    pub(super) fn about(mut self, doc: Option<&str>) -> Self {
        self.doc = doc.filter(|doc| !doc.is_empty()).map(str::to_owned);
        self
    }
}

/// Everything that could stand at a place.
pub(super) fn complete(document: &Document, offset: usize, settings: &Settings) -> CompletionResponse {
    let text = &document.source.text;
    let context = context(text, offset);
    if context.is_comment {
        return CompletionResponse::Array(Vec::new());
    }
    let (items, begun) = match context.text {
        Some(text) => words::in_text(document, &context, text),
        None => (outside(document, &context), context.word.len()),
    };
    let place = document.range(Span::new(offset.saturating_sub(begun), offset));
    let item = |(order, item): (usize, Item)| {
        let written = item.written.as_ref().unwrap_or(&item.label);
        let snippet = written.contains("$0") && settings.snippets;
        CompletionItem {
            text_edit: Some(CompletionTextEdit::Edit(TextEdit::new(
                place,
                if snippet { written.clone() } else { written.replace("$0", "") },
            ))),
            insert_text_format: snippet.then_some(InsertTextFormat::SNIPPET),
            // In the order that they are thought of: what this place asks for before what may stand anywhere.
            sort_text: Some(format!("{order:05}")),
            filter_text: Some(item.label.clone()),
            label: item.label,
            kind: Some(item.kind),
            detail: (!item.detail.is_empty()).then_some(item.detail),
            documentation: item
                .doc
                .map(|value| Documentation::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value })),
            ..CompletionItem::default()
        }
    };
    CompletionResponse::Array(items.into_iter().enumerate().map(item).collect())
}

/// Candidates for a place outside of quotes: fields, the words of parts, values that are bare words.
fn outside(document: &Document, context: &Context<'_>) -> Vec<Item> {
    let (expected, open) = context.part();
    let inner = context.frames.last();
    if let (Some((part, form)), Some(frame)) = (&open, inner)
        && frame.bracket == '('
        && frame.key.is_none()
    {
        return fields(*part, form, &frame.before);
    }
    let Some((depth, key)) = context.innermost_key() else {
        return if context.frames.is_empty() { parts(Part::Table) } else { Vec::new() };
    };
    // A key of a map has no part of its own.
    let behind_key = inner.is_some_and(|frame| frame.key.is_some() || frame.bracket == '[');
    match (expected, key) {
        (Some(part), _) if behind_key => parts(part),
        (_, "hit_policy") if depth == 0 => {
            ["First", "Unique", "Collect"].map(|word| Item::new(word, CompletionItemKind::ENUM_MEMBER, "")).into()
        }
        (_, "default" | "of" | "under") => words::bare(document, context, key),
        _ => Vec::new(),
    }
}

/// The fields of a part that are not there yet.
fn fields(part: Part, form: &Form, before: &[&str]) -> Vec<Item> {
    let missing = form.fields.iter().filter(|field| !before.contains(field));
    let item = |field: &&'static str| {
        let item = Item::new(*field, CompletionItemKind::FIELD, "").about(meaning(part, field));
        item.writing(format!("{field}: $0"))
    };
    missing.map(item).collect()
}

/// The ways to write a part.
fn parts(part: Part) -> Vec<Item> {
    let item = |form: Form| {
        let detail = form.fields.join(", ");
        let item = Item::new(form.word, CompletionItemKind::STRUCT, detail);
        if form.is_bare { item } else { item.writing(format!("{}($0)", form.word)) }
    };
    forms(part).into_iter().filter(|form| !form.word.is_empty()).map(item).collect()
}

/// The codes of findings.
pub(super) fn finding_codes() -> Vec<Item> {
    codes::findings().map(|entry| Item::new(entry.code.0, CompletionItemKind::VALUE, entry.meaning)).collect()
}

/// A function of the language at a place: its call and what it is, as Markdown.
pub(super) fn function_at(text: &str, offset: usize) -> Option<(String, Span)> {
    let inside = |c: char| c.is_ascii_alphanumeric();
    let start = text.get(..offset)?.rfind(|c| !inside(c)).map_or(0, |at| at + 1);
    let end = offset + text[offset..].find(|c| !inside(c)).unwrap_or(text.len() - offset);
    let word = text.get(start..end)?;
    // Only in a text in quotes is it one, and only where it is called.
    if !text[end..].trim_start().starts_with('(') || context(text, offset).text.is_none() {
        return None;
    }
    let function = signatures().find(|function| function.name == word)?;
    Some((format!("`{}({})`: {}", function.name, function.parameters, function.doc), Span::new(start, end)))
}

/// A field at a place: its meaning, as Markdown.
pub(super) fn field_at(text: &str, offset: usize) -> Option<(String, Span)> {
    let (part, field, span) = context::field(text, offset)?;
    Some((format!("`{field}`: {}", meaning(part, field)?), span))
}
