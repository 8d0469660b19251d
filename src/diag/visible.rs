//! Characters that do something rather than stand there, made visible.
//!
//! Texts of tables may come from anybody. An escape sequence in one could rewrite what
//! a terminal shows, a mark of direction could turn code around, and XML admits neither.
//! So every way out passes through here: messages, excerpts, standard output, pictures
//! and pages.

use std::borrow::Cow;
use std::fmt::Write as _;

/// Returns whether a character acts on the text around it, or is none at all.
fn acts(c: char) -> bool {
    match c {
        '\n' | '\t' => false,
        // Separators of lines, marks of direction, and what is no character of XML.
        '\u{061c}' | '\u{200e}'..='\u{200f}' | '\u{2028}'..='\u{202e}' | '\u{2066}'..='\u{2069}' => true,
        '\u{fffe}'..='\u{ffff}' => true,
        c => c.is_control(),
    }
}

/// A text with such characters written as `\u001b`, which JSON reads back.
pub(crate) fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(acts) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        if acts(c) {
            // Writing to a string cannot fail.
            let _ = write!(shown, "\\u{:04x}", u32::from(c));
        } else {
            shown.push(c);
        }
    }
    Cow::Owned(shown)
}

/// Returns whether nothing in a text acts. The end of a line on some systems is no harm: excerpts are cut before it.
pub(super) fn is_inert(text: &str) -> bool {
    !text.contains(|c| c != '\r' && acts(c)) && text.split('\r').skip(1).all(|rest| rest.starts_with('\n'))
}

/// A text with a stand-in of as many bytes for each such character, so that places in it stay what they are.
pub(super) fn in_place(text: &str) -> Cow<'_, str> {
    if is_inert(text) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len());
    let mut characters = text.chars().peekable();
    while let Some(c) = characters.next() {
        shown.push(match c.len_utf8() {
            _ if !acts(c) || (c == '\r' && characters.peek() == Some(&'\n')) => c,
            1 => '?',
            2 => '\u{bf}',
            _ => char::REPLACEMENT_CHARACTER,
        });
    }
    Cow::Owned(shown)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_acts_is_written_out() {
        assert_eq!(
            visible("a\u{1b}[2J\u{0}b\u{202e}c\u{9b}\u{7f}\r"),
            "a\\u001b[2J\\u0000b\\u202ec\\u009b\\u007f\\u000d"
        );
        assert!(matches!(visible("ä\tb\n🙂"), Cow::Borrowed(_)));
    }

    #[test]
    fn places_stay_what_they_are() {
        let text = "a\u{1b}b\u{9b}c\u{202e}d\r\ne\rf";
        assert_eq!(in_place(text), "a?b¿c\u{fffd}d\r\ne?f");
        assert_eq!(in_place(text).len(), text.len());
        assert!(matches!(in_place("a\r\nb"), Cow::Borrowed(_)));
    }
}
