//! Pieces of RON that hold an expression of the table language.

use super::expr::Expr;
use super::parse;
use crate::diag::{Diagnostic, Span, codes};
use crate::text::raw::{Raw, Reader, Shape};

impl<'a> Reader<'a> {
    /// The expression in a piece: a string, or a bare number or boolean.
    pub(crate) fn expr(&self, raw: Raw<'a>) -> Result<Expr, Diagnostic> {
        let span = self.span(raw);
        match self.shape(raw) {
            Shape::Text => {
                let text = raw.text();
                let hashes = text.trim_start_matches('r').bytes().take_while(|b| *b == b'#').count();
                let quote = usize::from(text.starts_with('r')) + hashes + 1;
                if !text.starts_with('r')
                    && let Some(escape) = text.find('\\')
                {
                    let at = span.start + escape;
                    return Err(Diagnostic::error(codes::EXPRESSION, "an expression contains no escapes")
                        .at(Span::new(at, at + 1), "unexpected `\\`"));
                }
                parse::expression(&text[quote..text.len() - 1 - hashes], span.start + quote)
            }
            Shape::Word("true" | "false") | Shape::Other => parse::expression(raw.text(), span.start),
            _ => Err(Diagnostic::error(codes::STRUCTURE, "expected an expression")
                .at(span, "neither a string nor a number")
                .help("write it as a string, for instance \"min(px, 1 - py)\"")),
        }
    }
}
