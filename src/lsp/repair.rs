//! Code actions: the repairs that diagnostics know.

use std::collections::HashMap;

use lsp_types::{CodeAction, CodeActionKind, CodeActionOrCommand, CodeActionParams, TextEdit, Uri, WorkspaceEdit};

use super::diagnose::shown;
use super::document::Document;
use super::place;
use super::settings::Settings;
use crate::diag::Diagnostic;

/// The repairs of what was found at a place.
pub(super) fn actions(
    document: &Document,
    found: &[Diagnostic],
    params: &CodeActionParams,
    settings: &Settings,
) -> Vec<CodeActionOrCommand> {
    let asked = place::span(&document.source.text, params.range, settings.encoding);
    let wanted = |kind: &CodeActionKind| {
        let kinds = params.context.only.as_ref();
        kinds.is_none_or(|kinds| kinds.iter().any(|of| kind.as_str().starts_with(of.as_str())))
    };
    if !wanted(&CodeActionKind::QUICKFIX) {
        return Vec::new();
    }
    let touched = found.iter().filter(|diagnostic| {
        diagnostic.labels.iter().any(|label| label.span.start <= asked.end && asked.start <= label.span.end)
    });
    let mut actions = Vec::new();
    for diagnostic in touched {
        for repair in diagnostic.repairs() {
            let edit = TextEdit::new(document.range(repair.span), repair.replacement.clone());
            actions.push(CodeActionOrCommand::CodeAction(CodeAction {
                title: repair.title.clone(),
                kind: Some(CodeActionKind::QUICKFIX),
                diagnostics: Some(vec![shown(&document.uri, &document.source, diagnostic, settings)]),
                edit: Some(edits(&document.uri, vec![edit])),
                is_preferred: Some(diagnostic.repairs().len() == 1),
                ..CodeAction::default()
            }));
        }
    }
    actions
}

/// Edits of one text.
// The keys of the protocol's map are URIs, which cache nothing that could change their hash.
#[allow(clippy::mutable_key_type)]
pub(super) fn edits(uri: &Uri, edits: Vec<TextEdit>) -> WorkspaceEdit {
    WorkspaceEdit { changes: Some(HashMap::from([(uri.clone(), edits)])), ..WorkspaceEdit::default() }
}
