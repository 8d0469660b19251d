//! The tokens of a RON text, comments included.
//!
//! Reading a table throws comments and white space away; a formatter needs
//! them. It needs no values, so this knows brackets, strings and separators
//! only, and whatever else stands between them is an atom.

/// The kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Kind {
    /// `(`, `[` or `{`.
    Open,
    /// `)`, `]` or `}`.
    Close,
    /// A comma.
    Comma,
    /// A colon.
    Colon,
    /// A text in quotes, raw or not.
    Text,
    /// A word, a number, or an attribute such as `#![enable(implicit_some)]`.
    Atom,
    /// A comment to the end of the line.
    LineComment,
    /// A comment between `/*` and `*/`.
    BlockComment,
}

impl Kind {
    /// Returns whether a token of this kind is a comment.
    pub(crate) fn is_comment(self) -> bool {
        matches!(self, Kind::LineComment | Kind::BlockComment)
    }
}

/// A token and how it stood in the source.
#[derive(Debug, Clone)]
pub(crate) struct Token<'a> {
    /// Its kind.
    pub(crate) kind: Kind,
    /// It itself.
    pub(crate) text: &'a str,
    /// Line breaks between it and the token before.
    pub(crate) breaks: usize,
    /// Its column, in characters, from 0.
    pub(crate) column: usize,
    /// Blanks between it and the token before, if that is on the same line.
    pub(crate) gap: usize,
    /// The start of its line, in characters.
    pub(crate) indent: usize,
}

impl Token<'_> {
    /// Returns whether it is a comment.
    pub(crate) fn is_comment(&self) -> bool {
        self.kind.is_comment()
    }
}

/// The tokens of a text that was read as RON before; what never ends, ends with the text.
pub(crate) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut out: Vec<Token<'_>> = Vec::new();
    let (mut at, mut column, mut indent) = (0, 0, None);
    let (mut breaks, mut gap) = (0, 0);
    while let Some(first) = text[at..].chars().next() {
        if first == '\n' {
            (breaks, column, indent, gap) = (breaks + 1, 0, None, 0);
            at += 1;
            continue;
        }
        if first.is_whitespace() || first == '\u{feff}' {
            (column, gap) = (column + 1, gap + 1);
            at += first.len_utf8();
            continue;
        }
        let (kind, length) = token(&text[at..], first);
        let piece = &text[at..at + length];
        let text = if kind == Kind::LineComment { piece.trim_end() } else { piece };
        let indent_here = *indent.get_or_insert(column);
        out.push(Token { kind, text, breaks, column, gap, indent: indent_here });
        match piece.rfind('\n') {
            // What follows a text of several lines stands at the end of the last of them.
            Some(newline) => {
                let last = &piece[newline + 1..];
                column = last.chars().count();
                indent = Some(last.chars().take_while(|c| c.is_whitespace()).count());
            }
            None => column += piece.chars().count(),
        }
        (breaks, gap) = (0, 0);
        at += length;
    }
    out
}

/// A text from its first token on that is no comment.
pub(crate) fn skip_blank(text: &str) -> &str {
    let mut rest = text.trim_start();
    while let Some(first @ '/') = rest.chars().next() {
        let (kind, length) = token(rest, first);
        if !kind.is_comment() {
            break;
        }
        rest = rest[length..].trim_start();
    }
    rest
}

/// The end of the last token of a text that is no comment.
pub(crate) fn significant(text: &str) -> usize {
    let (mut at, mut end) = (0, 0);
    while let Some(first) = text[at..].chars().next() {
        if first.is_whitespace() {
            at += first.len_utf8();
            continue;
        }
        let (kind, length) = token(&text[at..], first);
        at += length;
        if !kind.is_comment() {
            end = at;
        }
    }
    end
}

/// The kind and length of the token that a text begins with.
fn token(rest: &str, first: char) -> (Kind, usize) {
    match first {
        '(' | '[' | '{' => (Kind::Open, 1),
        ')' | ']' | '}' => (Kind::Close, 1),
        ',' => (Kind::Comma, 1),
        ':' => (Kind::Colon, 1),
        '/' if rest.starts_with("//") => (Kind::LineComment, rest.find('\n').unwrap_or(rest.len())),
        '/' if rest.starts_with("/*") => (Kind::BlockComment, block_comment_end(rest).unwrap_or(rest.len())),
        '"' => (Kind::Text, text_end(rest)),
        '\'' => (Kind::Text, rest[1..].find('\'').map_or(rest.len(), |end| end + 2)),
        '#' if rest.starts_with("#![") => (Kind::Atom, rest.find(']').map_or(rest.len(), |end| end + 1)),
        'r' if raw_hashes(rest).is_some() => (Kind::Text, raw_end(rest)),
        _ => {
            let end = rest.find(|c: char| c.is_whitespace() || "()[]{},:\"/".contains(c));
            (Kind::Atom, end.unwrap_or(rest.len()).max(first.len_utf8()))
        }
    }
}

/// The length of the block comment that a text begins with; they nest.
fn block_comment_end(text: &str) -> Option<usize> {
    let mut depth = 0_usize;
    let mut at = 0;
    loop {
        if text[at..].starts_with("/*") {
            depth += 1;
            at += 2;
        } else if text[at..].starts_with("*/") {
            depth -= 1;
            at += 2;
        } else {
            at += text[at..].chars().next()?.len_utf8();
        }
        if depth == 0 {
            return Some(at);
        }
    }
}

/// The end of a text in quotes; a backslash takes what follows it along.
fn text_end(rest: &str) -> usize {
    let mut escaped = false;
    for (at, c) in rest.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return at + 1,
            _ => {}
        }
    }
    rest.len()
}

/// The number of `#` of a raw text, if this is one.
fn raw_hashes(rest: &str) -> Option<usize> {
    let after = rest.strip_prefix('r')?;
    let hashes = after.bytes().take_while(|b| *b == b'#').count();
    after[hashes..].starts_with('"').then_some(hashes)
}

fn raw_end(rest: &str) -> usize {
    let hashes = raw_hashes(rest).unwrap_or(0);
    let end = format!("\"{}", "#".repeat(hashes));
    let start = 2 + hashes;
    rest[start..].find(&end).map_or(rest.len(), |at| start + at + end.len())
}

/// The parts of a text in quotes: what opens it, what is in it, what closes it.
pub(crate) fn quoted(text: &str) -> (&str, &str, &str) {
    let hashes = raw_hashes(text).unwrap_or(0);
    let open = text.find('"').map_or(0, |at| at + 1);
    let close = text.len().saturating_sub(1 + hashes).max(open);
    (&text[..open], &text[open..close], &text[close..])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn brackets_in_texts_and_comments_are_none() {
        let text = "A(/* ( /* ) */ */ b: \"\\\")\", // ]\n c: r#\"\"(\"#, d: -1.5e-3)";
        let found: Vec<_> = tokens(text).iter().map(|t| t.text).collect();
        let expected = [
            "A",
            "(",
            "/* ( /* ) */ */",
            "b",
            ":",
            "\"\\\")\"",
            ",",
            "// ]",
            "c",
            ":",
            "r#\"\"(\"#",
            ",",
            "d",
            ":",
            "-1.5e-3",
            ")",
        ];
        assert_eq!(found, expected);
        assert_eq!(significant("\"a // b\" /* c */ // d\n"), 8);
        assert_eq!(quoted("r#\"\"(\"#"), ("r#\"", "\"(", "\"#"));
        assert_eq!(quoted("\"a\""), ("\"", "a", "\""));
    }
}
