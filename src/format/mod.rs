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

/// Most times that a table is laid out before it is given up; nearly all need two.
const MOST_LAYOUTS: usize = 16;

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
    let refuse = |what: &str| {
        let error = Diagnostic::error(codes::FORMAT, format!("formatting {what}; it is left alone"));
        Err(Failure::bare(source.name.as_str(), error.help("this is a mistake in Umbrage: please report it")))
    };
    let Some(text) = settled(&source.text) else { return refuse("this table would never end") };
    let formatted = Source::new(source.name.as_str(), text.as_str());
    // The table is a function of these tokens, so where they are equal the tables are.
    let same = essence(&tokens::tokens(&text)) == essence(&tokens::tokens(&source.text));
    if !same || Table::well_formed(&formatted).is_err() {
        return refuse("would change what this table means");
    }
    Ok(text)
}

/// Lays a text out until that changes nothing more.
///
/// Columns of the author's are kept, and what was laid out may have columns that nobody made: cells that came to stand
/// below each other. Should layouts lead in a circle, the least of them is taken, to which each of the others leads.
fn settled(text: &str) -> Option<String> {
    let mut seen = vec![laid_out(text)];
    while seen.len() < MOST_LAYOUTS {
        let next = laid_out(seen.last()?);
        if let Some(first) = seen.iter().position(|text| *text == next) {
            return seen.drain(first..).min();
        }
        seen.push(next);
    }
    None
}

/// Lays a text out once.
fn laid_out(text: &str) -> String {
    let mut rows = rows::rows(tokens::tokens(text));
    align::align(&mut rows);
    print::print(&rows)
}

/// The part of a text that must stay: tokens without the blanks of expressions and without commas
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
