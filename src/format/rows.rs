//! From tokens to lines of pieces: where a table breaks, and what each piece
//! is part of.
//!
//! Lines break where the author broke them, and in front of every field of the
//! table and every case. Commas and colons move to what they follow, and there
//! is a comma behind the last item exactly if its bracket is closed on a line
//! of its own.

use super::expression;
use crate::text::tokens::{Kind, Token, quoted};

/// A token in its place.
#[derive(Debug)]
pub(super) struct Piece<'a> {
    /// The token.
    pub(super) token: Token<'a>,
    /// Its spelling.
    pub(super) written: Written<'a>,
    /// Blanks in front of it, unless it is the first of its line.
    pub(super) gap: usize,
    /// The pair of brackets that it stands in; of a bracket, what it opens or closes.
    pub(super) pair: usize,
    /// True if an item of that pair begins here.
    pub(super) begins: bool,
    /// True if a rule for columns decides about the gap.
    pub(super) ruled: bool,
}

/// The spelling of a token.
#[derive(Debug)]
pub(super) enum Written<'a> {
    /// As it was, on however many lines.
    Same(&'a str),
    /// An expression: what opens it, its lines, each with the blanks it had in front, what closes it.
    Expression(&'a str, Vec<(usize, String)>, &'a str),
}

impl Written<'_> {
    /// The width, if it ends on the line that it begins on.
    pub(super) fn width(&self) -> Option<usize> {
        match self {
            Written::Same(text) => (!text.contains('\n')).then(|| text.chars().count()),
            Written::Expression(open, lines, close) => match lines.as_slice() {
                [(_, line)] => Some([*open, line, *close].iter().map(|part| part.chars().count()).sum()),
                _ => None,
            },
        }
    }
}

/// A pair of brackets.
#[derive(Debug)]
pub(super) struct Pair {
    /// The bracket that opens it.
    pub(super) open: char,
    /// The pair around it.
    pub(super) parent: usize,
    /// The name or key of the field that it is the value of, without quotes.
    pub(super) field: String,
}

/// The pair around everything.
pub(super) const OUTSIDE: usize = 0;
/// The pair of the table itself.
const TABLE: usize = 1;

/// A line.
#[derive(Debug, Default)]
pub(super) struct Line<'a> {
    /// Its pieces; at least one.
    pub(super) pieces: Vec<Piece<'a>>,
    /// True if an empty line stands in front of it.
    pub(super) blank: bool,
}

/// A table in lines.
#[derive(Debug)]
pub(super) struct Rows<'a> {
    /// The lines.
    pub(super) lines: Vec<Line<'a>>,
    /// The pairs of brackets.
    pub(super) pairs: Vec<Pair>,
}

/// Breaks tokens into lines.
pub(super) fn rows<'a>(tokens: Vec<Token<'a>>) -> Rows<'a> {
    let mut tokens = attached(tokens);
    break_lines(&mut tokens);
    let tokens = with_last_commas(tokens);
    let (pieces, pairs) = place(tokens);
    let mut lines: Vec<Line<'a>> = Vec::new();
    let mut opened = true;
    for piece in pieces {
        if piece.token.breaks > 0 || lines.is_empty() {
            let blank = piece.token.breaks > 1 && !opened && piece.token.kind != Kind::Close;
            lines.push(Line { pieces: Vec::new(), blank });
        }
        opened = piece.token.kind == Kind::Open;
        if let Some(line) = lines.last_mut() {
            line.pieces.push(piece);
        }
    }
    Rows { lines, pairs }
}

/// Commas and colons directly behind what they follow, brackets behind their names.
fn attached<'a>(tokens: Vec<Token<'a>>) -> Vec<Token<'a>> {
    let mut out: Vec<Token<'a>> = Vec::with_capacity(tokens.len());
    let mut last = 0;
    for mut token in tokens {
        match token.kind {
            Kind::Comma | Kind::Colon if !out.is_empty() => {
                // A comment that would come between the two now comes after both.
                (token.breaks, token.gap) = (0, 0);
                last += 1;
                out.insert(last, token);
                continue;
            }
            Kind::Open
                if out.last().is_some_and(|before| before.kind == Kind::Atom && !before.text.starts_with('#')) =>
            {
                token.breaks = 0;
            }
            Kind::Close if out.last().is_some_and(|before| before.kind == Kind::Open) => token.breaks = 0,
            _ => {}
        }
        if !token.is_comment() {
            last = out.len();
        }
        out.push(token);
    }
    for index in 1..out.len() {
        if out[index - 1].kind == Kind::LineComment {
            out[index].breaks = out[index].breaks.max(1);
        }
    }
    out
}

/// Breaks lines in front of the fields of the table, its cases, and what closes an open block.
fn break_lines(tokens: &mut [Token<'_>]) {
    let mut stack: Vec<(bool, bool)> = Vec::new();
    let mut pending = false;
    for index in 0..tokens.len() {
        let depth = stack.len();
        match tokens[index].kind {
            Kind::Open => {
                if pending {
                    tokens[index].breaks = tokens[index].breaks.max(1);
                }
                let empty = tokens.get(index + 1).is_some_and(|next| next.kind == Kind::Close);
                let field =
                    if index > 1 && tokens[index - 1].kind == Kind::Colon { tokens[index - 2].text } else { "" };
                let itemwise = !empty && (depth == 0 || depth == 1 && field == "cases");
                let listed = depth == 1 && field != "output" || field == "lines";
                let block = !empty && (itemwise || opens_block(&tokens[index + 1..], listed));
                stack.push((itemwise, block));
                pending = block;
                continue;
            }
            Kind::Close => {
                if stack.pop().is_some_and(|(_, block)| block) {
                    tokens[index].breaks = tokens[index].breaks.max(1);
                }
                pending = false;
            }
            Kind::Comma => {
                pending = stack.last().is_some_and(|(itemwise, _)| *itemwise);
                continue;
            }
            // A comment behind an item on its line stays there.
            Kind::LineComment | Kind::BlockComment if tokens[index].breaks == 0 => continue,
            _ => {
                if pending {
                    tokens[index].breaks = tokens[index].breaks.max(1);
                }
                pending = false;
            }
        }
    }
}

/// Returns whether a bracket, given what follows it, is the last thing on its line. One
/// whose items are a list of the table is, as soon as they take more than one line.
fn opens_block(inside: &[Token<'_>], listed: bool) -> bool {
    let first = inside.iter().position(|token| !token.is_comment()).unwrap_or(0);
    let behind = inside.iter().take(first + 1);
    if behind.clone().any(|token| token.breaks > 0) || behind.clone().any(|token| token.kind == Kind::LineComment) {
        return true;
    }
    let mut depth = 0_usize;
    for token in inside.iter().filter(|_| listed) {
        if depth == 0 && token.breaks > 0 {
            return true;
        }
        match token.kind {
            Kind::Open => depth += 1,
            Kind::Close if depth == 0 => return false,
            Kind::Close => depth -= 1,
            _ => {}
        }
    }
    false
}

/// A comma behind the last item where its bracket is closed on the next line, and else none.
fn with_last_commas<'a>(tokens: Vec<Token<'a>>) -> Vec<Token<'a>> {
    let mut out: Vec<Token<'a>> = Vec::with_capacity(tokens.len());
    for token in tokens {
        if token.kind == Kind::Close
            && let Some(last) = out.iter().rposition(|before| !before.is_comment())
        {
            let comma = Token { kind: Kind::Comma, text: ",", breaks: 0, column: 0, gap: 0, indent: out[last].indent };
            match out[last].kind {
                Kind::Comma if token.breaks == 0 => {
                    out.remove(last);
                }
                Kind::Comma | Kind::Open => {}
                _ if token.breaks > 0 => out.insert(last + 1, comma),
                _ => {}
            }
        }
        out.push(token);
    }
    out
}

/// The state of the pair of brackets that is being read.
struct Frame {
    pair: usize,
    /// The number of the item, from 0.
    item: usize,
    /// The name or key of the item, and whether it stands in quotes.
    key: Option<(String, bool)>,
    /// True if something of the item was read.
    begun: bool,
}

/// Says of each token what it is part of.
fn place<'a>(tokens: Vec<Token<'a>>) -> (Vec<Piece<'a>>, Vec<Pair>) {
    let mut pairs = vec![Pair { open: ' ', parent: OUTSIDE, field: String::new() }];
    let mut stack = vec![Frame { pair: OUTSIDE, item: 0, key: None, begun: false }];
    let mut pieces: Vec<Piece<'a>> = Vec::with_capacity(tokens.len());
    let followed_by_colon: Vec<bool> =
        (0..tokens.len()).map(|i| tokens.get(i + 1).is_some_and(|next| next.kind == Kind::Colon)).collect();
    for (token, is_key) in tokens.into_iter().zip(followed_by_colon) {
        let gap = gap(pieces.last().map(|before| &before.token), &token);
        let Some(frame) = stack.last_mut() else { break };
        let mut pair = frame.pair;
        let begins = !frame.begun && !token.is_comment() && !matches!(token.kind, Kind::Close | Kind::Comma);
        frame.begun |= begins;
        let mut written = Written::Same(token.text);
        match token.kind {
            Kind::Open => {
                pairs.push(Pair {
                    open: token.text.chars().next().unwrap_or('('),
                    parent: pair,
                    field: frame.key.as_ref().map_or(String::new(), |(key, _)| key.clone()),
                });
                stack.push(Frame { pair: pairs.len() - 1, item: 0, key: None, begun: false });
            }
            Kind::Close if pair != OUTSIDE => {
                stack.pop();
            }
            Kind::Comma => (frame.item, frame.key, frame.begun) = (frame.item + 1, None, false),
            Kind::Text if is_key => {
                let (open, name, close) = quoted(token.text);
                frame.key = Some((name.to_owned(), true));
                // Helpers are declared as they are called.
                if pairs[pair].field == "helpers" {
                    written = expression(open, name, close).unwrap_or(written);
                }
            }
            Kind::Text if !is_prose(frame, &pairs) => {
                let (open, inner, close) = quoted(token.text);
                written = expression(open, inner, close).unwrap_or(written);
            }
            Kind::Atom if is_key => frame.key = Some((token.text.to_owned(), false)),
            _ => {}
        }
        // Brackets belong to what they open or close; that is how the two find each other.
        if token.kind == Kind::Open {
            pair = pairs.len() - 1;
        }
        pieces.push(Piece { token, written, gap, pair, begins, ruled: false });
    }
    (pieces, pairs)
}

fn expression<'a>(open: &'a str, inner: &str, close: &'a str) -> Option<Written<'a>> {
    let escapes = inner.contains('\\');
    // Where a group is asked; it would be another pattern with blanks in it.
    let pattern = inner.bytes().all(|letter| b"01-".contains(&letter));
    let lines = expression::lines(inner).filter(|_| !escapes && !pattern)?;
    Some(Written::Expression(open, lines, close))
}

/// Returns whether a text is meant for readers: no expression.
fn is_prose(frame: &Frame, pairs: &[Pair]) -> bool {
    let pair = &pairs[frame.pair];
    let of_readers =
        ["name", "title", "source", "exhibit", "section", "doc", "unit", "reason", "printed", "meant", "code"];
    match &frame.key {
        Some((key, false)) => of_readers.contains(&key.as_str()),
        // The reasons of assumptions and domains: the second of a pair.
        None if pair.open == '(' && frame.item > 0 => matches!(pairs[pair.parent].field.as_str(), "assume" | "domain"),
        _ => pair.field == "imports",
    }
}

/// The blanks between two tokens of a line.
fn gap(before: Option<&Token<'_>>, token: &Token<'_>) -> usize {
    let Some(before) = before else { return 0 };
    match (before.kind, token.kind) {
        (_, Kind::LineComment) => token.gap.max(1),
        (_, Kind::Comma | Kind::Colon) => 0,
        (_, Kind::BlockComment) | (Kind::BlockComment, _) => 1,
        (Kind::Open, _) | (_, Kind::Close) | (Kind::Atom, Kind::Open) => 0,
        _ => 1,
    }
}

/// Returns whether a pair is a field of the table itself.
pub(super) fn is_section(pairs: &[Pair], pair: usize) -> bool {
    pair != OUTSIDE && pairs[pair].parent == TABLE
}
