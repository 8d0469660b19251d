//! From lines to text: how far each is indented, and where its comment stands.
//!
//! A bracket at the end of a line opens a block, four blanks further in. What
//! follows a bracket on its line gives the column for the lines below, unless
//! the author chose four blanks here, too.

use super::rows::{Line, OUTSIDE, Piece, Rows, Written};
use crate::text::tokens::Kind;

/// One level of a block.
const STEP: usize = 4;

/// A bracket that is open.
struct Open {
    pair: usize,
    /// The indentation of its line, now and before.
    indent: usize,
    was: usize,
    /// The column of what follows it on its line.
    content: Option<usize>,
    /// The column of the lines below, once it is decided.
    inner: Option<usize>,
}

/// A line, nearly finished.
struct Printed<'a> {
    text: String,
    comment: Option<&'a Piece<'a>>,
    blank: bool,
}

/// Writes lines.
pub(super) fn print(rows: &Rows<'_>) -> String {
    let mut printed: Vec<Printed<'_>> = Vec::new();
    let mut open: Vec<Open> = Vec::new();
    let (mut indent, mut after_colon) = (0, false);
    for line in &rows.lines {
        let Some(first) = line.pieces.first() else { continue };
        if first.token.kind == Kind::Close {
            indent = open.iter().rfind(|bracket| bracket.pair == first.pair).map_or(0, |bracket| bracket.indent);
        } else if after_colon {
            // The value of a field, on a line of its own.
            indent += STEP;
        } else {
            indent = open.last_mut().map_or(0, |bracket| bracket.inner(first));
        }
        let text = one(line, indent, &mut open);
        after_colon = match line.pieces.iter().rfind(|piece| !piece.token.is_comment()) {
            Some(last) => last.token.kind == Kind::Colon,
            None => after_colon,
        };
        if after_colon && first.token.is_comment() {
            indent = indent.saturating_sub(STEP);
        }
        let comment = line.pieces.last().filter(|last| line.pieces.len() > 1 && last.token.kind == Kind::LineComment);
        printed.push(Printed { text, comment, blank: line.blank });
    }
    finish(&printed)
}

impl Open {
    /// The column of a line that begins with a piece in this bracket.
    fn inner(&mut self, first: &Piece<'_>) -> usize {
        let block = self.indent + STEP;
        let chosen = first.token.indent == self.was + STEP;
        *self.inner.get_or_insert(match self.content {
            Some(content) if !chosen => content,
            _ => block,
        })
    }
}

/// The text of one line, without a comment at its end. Keeps account of brackets.
fn one(line: &Line<'_>, indent: usize, open: &mut Vec<Open>) -> String {
    let mut text = " ".repeat(indent);
    let mut column = indent;
    let count = line.pieces.len();
    for (index, piece) in line.pieces.iter().enumerate() {
        if index > 0 && index + 1 == count && piece.token.kind == Kind::LineComment {
            break;
        }
        if index > 0 {
            text.push_str(&" ".repeat(piece.gap));
            column += piece.gap;
        }
        let start = column;
        match &piece.written {
            Written::Same(same) => text.push_str(same),
            Written::Expression(before, lines, after) => {
                text.push_str(before);
                expression(&mut text, lines, indent, (start, piece.token.column));
                text.push_str(after);
            }
        }
        column = text.rsplit('\n').next().map_or(0, |last| last.chars().count());
        match piece.token.kind {
            Kind::Open => {
                let next = line.pieces.get(index + 1).filter(|next| !next.token.is_comment());
                let content = next.map(|_| column);
                open.push(Open { pair: piece.pair, indent, was: piece.token.indent, content, inner: None });
            }
            Kind::Close if piece.pair != OUTSIDE => {
                open.pop();
            }
            _ => {}
        }
    }
    text
}

/// The lines of an expression: as a block below its field, or moved along with its first line.
fn expression(text: &mut String, lines: &[(usize, String)], indent: usize, (start, was): (usize, usize)) {
    let block = lines.first().is_some_and(|(_, line)| line.is_empty());
    let rest = || lines.iter().skip(1).filter(|(_, line)| !line.is_empty());
    let least = rest().map(|(blanks, _)| *blanks).min().unwrap_or(0);
    for (index, (blanks, line)) in lines.iter().enumerate() {
        if index > 0 {
            text.push('\n');
            if !line.is_empty() {
                let blanks = if block { blanks - least + indent + STEP } else { (blanks + start).saturating_sub(was) };
                text.push_str(&" ".repeat(blanks));
            }
        }
        text.push_str(line);
    }
}

/// Joins lines, with comments that stood below each other below each other.
fn finish(lines: &[Printed<'_>]) -> String {
    let mut out = String::new();
    let mut start = 0;
    for end in 1..=lines.len() {
        if lines.get(end).is_some_and(|line| !line.blank) {
            continue;
        }
        let paragraph = &lines[start..end];
        for (index, line) in paragraph.iter().enumerate() {
            if line.blank && index == 0 && start > 0 {
                out.push('\n');
            }
            out.push_str(&line.text);
            if let Some(comment) = line.comment {
                let gap = comment_column(paragraph, comment).saturating_sub(width(&line.text)).max(1);
                out.push_str(&" ".repeat(gap));
                out.push_str(comment.token.text);
            }
            out.push('\n');
        }
        start = end;
    }
    out
}

fn width(text: &str) -> usize {
    text.rsplit('\n').next().map_or(0, |last| last.chars().count())
}

/// The column of a comment: as far from the longest line as the nearest of its companions stood.
fn comment_column(paragraph: &[Printed<'_>], comment: &Piece<'_>) -> usize {
    let companions = || {
        paragraph.iter().filter_map(|line| {
            let other = line.comment.filter(|other| other.token.column == comment.token.column)?;
            Some((width(&line.text), other.gap))
        })
    };
    let widest = companions().map(|(width, _)| width).max().unwrap_or(0);
    widest + companions().map(|(_, gap)| gap).min().unwrap_or(1)
}
