//! Tokens of the expression language.

use crate::diag::{Diagnostic, Span, codes};

/// A token.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Token<'a> {
    Number(f64),
    Word(&'a str),
    Symbol(&'static str),
    End,
}

impl Token<'_> {
    /// The token as it is shown in a message.
    pub(super) fn describe(&self) -> String {
        match self {
            Token::Number(_) => "a number".to_owned(),
            Token::Word(word) => format!("`{word}`"),
            Token::Symbol(symbol) => format!("`{symbol}`"),
            Token::End => "the end of the expression".to_owned(),
        }
    }
}

/// Two-character symbols come first, so that the longest one wins.
const SYMBOLS: [&str; 34] = [
    "||", "&&", "==", "!=", "<=", ">=", "..", "::", "++", "<<", ">>", "<", ">", "+", "-", "*", "/", "%", "!", "&", "^",
    "~", "(", ")", "{", "}", "[", "]", ",", ";", "=", ".", ":", "|",
];

/// Splits `text` into tokens; `base` is where the text starts in its source.
pub(crate) fn tokens(text: &str, base: usize) -> Result<Vec<(Span, Token<'_>)>, Diagnostic> {
    let bytes = text.as_bytes();
    let mut out = Vec::new();
    let mut at = 0;
    while let Some(&byte) = bytes.get(at) {
        let start = at;
        let token = if byte.is_ascii_whitespace() {
            at += 1;
            continue;
        } else if byte.is_ascii_digit() || (byte == b'.' && bytes.get(at + 1).is_some_and(u8::is_ascii_digit)) {
            at = number_end(bytes, at);
            let literal = &text[start..at];
            let number = match hexadecimal(literal) {
                Some(digits) => u32::from_str_radix(digits, 16).map(f64::from).ok(),
                None => literal.parse::<f64>().ok(),
            };
            match number {
                Some(number) if number.is_finite() => Token::Number(number),
                _ => {
                    return Err(Diagnostic::error(codes::EXPRESSION, format!("`{literal}` is not a usable number"))
                        .at(Span::new(base + start, base + at), "malformed or too large"));
                }
            }
        } else if byte.is_ascii_alphabetic() || byte == b'_' {
            // A dotted name is one token: `d_c.r`.
            while bytes.get(at).is_some_and(|b| {
                b.is_ascii_alphanumeric()
                    || *b == b'_'
                    || (*b == b'.' && bytes.get(at + 1).is_some_and(u8::is_ascii_alphabetic))
            }) {
                at += 1;
            }
            Token::Word(&text[start..at])
        } else if let Some(symbol) = SYMBOLS.iter().find(|s| text[start..].starts_with(**s)) {
            at += symbol.len();
            Token::Symbol(symbol)
        } else {
            let found = text[start..].chars().next().unwrap_or('?');
            let help = "an expression consists of numbers, names, + - * / % & | ^ ~ << >> ! && || == != < <= > >= ( ) { } [ ] and if, else, let, in, case";
            return Err(Diagnostic::error(
                codes::EXPRESSION,
                format!("`{}` has no meaning here", found.escape_debug()),
            )
            .at(Span::new(base + start, base + start + found.len_utf8()), "unexpected character")
            .help(help));
        };
        out.push((Span::new(base + start, base + at), token));
    }
    out.push((Span::new(base + text.len(), base + text.len()), Token::End));
    Ok(out)
}

/// The digits of a number that is written as those of a word: `0x9E3779B9`.
fn hexadecimal(literal: &str) -> Option<&str> {
    literal.strip_prefix("0x").or_else(|| literal.strip_prefix("0X"))
}

fn number_end(bytes: &[u8], mut at: usize) -> usize {
    if bytes[at] == b'0' && matches!(bytes.get(at + 1), Some(b'x' | b'X')) {
        at += 2;
        while bytes.get(at).is_some_and(u8::is_ascii_hexdigit) {
            at += 1;
        }
        return at;
    }
    let digits = |mut at: usize| {
        while bytes.get(at).is_some_and(u8::is_ascii_digit) {
            at += 1;
        }
        at
    };
    at = digits(at);
    // In `0..1` the point belongs to what follows.
    if bytes.get(at) == Some(&b'.') && bytes.get(at + 1) != Some(&b'.') {
        at = digits(at + 1);
    }
    if matches!(bytes.get(at), Some(b'e' | b'E')) {
        let sign = usize::from(matches!(bytes.get(at + 1), Some(b'+' | b'-')));
        if bytes.get(at + 1 + sign).is_some_and(u8::is_ascii_digit) {
            at = digits(at + 1 + sign);
        }
    }
    at
}
