//! The outline of a table: its inputs, names, cases and functions.

use lsp_types::{DocumentSymbol, SymbolKind};

use super::document::{Document, Known};
use crate::diag::Span;
use crate::uses::{Kind, Symbol, SymbolId};

/// The declarations of a table as a tree: levels in their sets, cases in their functions.
pub(super) fn outline(document: &Document) -> Vec<DocumentSymbol> {
    let Some(known) = document.known() else { return Vec::new() };
    within(document, known, None)
}

fn within(document: &Document, known: &Known, of: Option<SymbolId>) -> Vec<DocumentSymbol> {
    let here = known.uses.symbols().filter(|(_, symbol)| symbol.of == of && is_shown(symbol.kind, of));
    let own = here.filter(|(_, symbol)| symbol.source.name == document.source.name);
    let item = |(id, symbol): (SymbolId, &Symbol)| {
        let (place, whole) = (document.forth(symbol.place)?, document.forth(symbol.whole)?);
        let inner = within(document, known, Some(id));
        // Deprecated in the protocol, and not optional in its types.
        #[allow(deprecated)]
        Some(DocumentSymbol {
            name: match symbol.kind {
                Kind::Case => format!("case {}", symbol.name),
                _ => symbol.name.clone(),
            },
            detail: (!symbol.doc.is_empty()).then(|| symbol.doc.clone()),
            kind: kind(symbol.kind),
            tags: None,
            deprecated: None,
            range: document.range(Span::new(whole.start.min(place.start), whole.end.max(place.end))),
            selection_range: document.range(place),
            children: (!inner.is_empty()).then_some(inner),
        })
    };
    own.filter_map(item).collect()
}

/// Returns whether an outline shows declarations of a kind: not what is local to an expression.
fn is_shown(kind: Kind, of: Option<SymbolId>) -> bool {
    match kind {
        Kind::Local => of.is_some(),
        Kind::Parameter => false,
        Kind::Input
        | Kind::Set
        | Kind::Level
        | Kind::Name
        | Kind::Group
        | Kind::Constant
        | Kind::Helper
        | Kind::Function
        | Kind::Case
        | Kind::Symmetry
        | Kind::Import
        | Kind::Assumption
        | Kind::Continuity
        | Kind::Claim => true,
    }
}

/// The nearest of the kinds that the protocol knows.
pub(super) fn kind(kind: Kind) -> SymbolKind {
    match kind {
        Kind::Input | Kind::Parameter | Kind::Local => SymbolKind::VARIABLE,
        Kind::Set | Kind::Group => SymbolKind::ENUM,
        Kind::Level => SymbolKind::ENUM_MEMBER,
        Kind::Name => SymbolKind::PROPERTY,
        Kind::Constant => SymbolKind::CONSTANT,
        Kind::Helper | Kind::Function => SymbolKind::FUNCTION,
        Kind::Case => SymbolKind::OBJECT,
        Kind::Symmetry => SymbolKind::OPERATOR,
        Kind::Import => SymbolKind::MODULE,
        Kind::Assumption | Kind::Continuity | Kind::Claim => SymbolKind::BOOLEAN,
    }
}
