//! Tables in the layout of this project: what `umbrage fmt` does.
//!
//! The author decides where lines break. Indentation, the columns of rows that
//! follow each other, and the spaces of expressions are decided here. Comments
//! stay, formatting twice changes nothing more, and the result is compared
//! with the source token by token before anybody gets to see it.

mod align;
mod expression;
mod print;
mod rows;

use std::sync::Arc;

use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::table::Table;
use crate::text::tokens;
use crate::text::tokens::{Kind, Token};

/// A table as it should be laid out.
///
/// ```
/// use umbrage::diag::Source;
///
/// let table = "(language:1, name:\"dim\", hit_policy:First, inputs:{\"x\":Range(from:0,to:1)},
///     output:Number(), cases:[(id:1, when:true, value:\"x/2\")], default:0)";
/// let formatted = umbrage::format::format(&Source::new("dim.ron", table)).expect("a table");
/// assert!(formatted.contains("        (id: 1, when: true, value: \"x / 2\"),\n"));
/// ```
///
/// # Errors
/// When the source is no table.
pub fn format(source: &Arc<Source>) -> Result<String, Failure> {
    Table::well_formed(source)?;
    let tokens = tokens::tokens(&source.text);
    let before = essence(&tokens);
    let mut rows = rows::rows(tokens);
    align::align(&mut rows);
    let text = print::print(&rows);
    let formatted = Source::new(source.name.as_str(), text.as_str());
    // The table is a function of these tokens, so where they are equal the tables are.
    if essence(&tokens::tokens(&text)) != before || Table::well_formed(&formatted).is_err() {
        let error = Diagnostic::error(codes::FORMAT, "formatting would change what this table means; it is left alone");
        return Err(Failure::bare(source.name.as_str(), error.help("this is a mistake in Umbrage: please report it")));
    }
    Ok(text)
}

/// What must stay: tokens without the blanks of expressions and without commas
/// that nothing follows, and then the comments.
fn essence<'a>(tokens: &[Token<'a>]) -> (Vec<String>, Vec<&'a str>) {
    let significant: Vec<&Token<'_>> = tokens.iter().filter(|token| !token.is_comment()).collect();
    let last_comma = |index: usize| {
        significant[index].kind == Kind::Comma
            && significant.get(index + 1).is_some_and(|next| next.kind == Kind::Close)
    };
    let plain = |token: &Token<'_>| match token.kind {
        Kind::Text => {
            let (open, inner, close) = tokens::quoted(token.text);
            let words = crate::table::lex::tokens(inner, 0);
            let words = words.map(|words| words.iter().map(|(at, _)| &inner[at.start..at.end]).collect::<Vec<_>>());
            format!("{open}{}{close}", words.map_or_else(|_| inner.to_owned(), |words| words.join("\n")))
        }
        _ => token.text.to_owned(),
    };
    let kept = (0..significant.len()).filter(|index| !last_comma(*index)).map(|index| plain(significant[index]));
    (kept.collect(), tokens.iter().filter(|token| token.is_comment()).map(|token| token.text).collect())
}

#[cfg(test)]
mod tests;
