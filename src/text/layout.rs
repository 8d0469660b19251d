//! The brackets of a RON text, with the places of the items in them.
//!
//! Reading gives values; a tool that changes a text and leaves the rest as it is written
//! needs to know where the items stand that it changes, with their keys and commas. It
//! works on tokens, so that words in comments and texts are no items.

use super::tokens::{Kind, quoted, tokens};
use crate::diag::Span;

/// The tokens of a text that was read as RON before, without comments.
pub(crate) struct Layout<'a> {
    text: &'a str,
    tokens: Vec<(Kind, Span)>,
}

/// A pair of brackets.
#[derive(Debug, PartialEq)]
pub(crate) struct Bracket {
    /// Behind the bracket that opens it.
    pub(crate) open: usize,
    /// The items, in the order written.
    pub(crate) items: Vec<Item>,
}

/// An item of a list, an entry of a map, a field.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Item {
    /// The key or the name.
    pub(crate) key: Option<Span>,
    /// The value.
    pub(crate) value: Span,
    /// All of it, with the comma behind it, if there is one.
    pub(crate) whole: Span,
}

impl<'a> Layout<'a> {
    pub(crate) fn new(text: &'a str) -> Self {
        let place = |piece: &str| {
            // A token is a slice of the text, so the difference of the addresses is its offset.
            let start = (piece.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
            Span::new(start, start + piece.len())
        };
        let all = tokens(text);
        let tokens = all.iter().filter(|token| !token.is_comment()).map(|token| (token.kind, place(token.text)));
        Self { text, tokens: tokens.collect() }
    }

    /// The place of the first token.
    #[cfg(any(feature = "precise", test))]
    pub(crate) fn start(&self) -> usize {
        self.tokens.first().map_or(0, |(_, span)| span.start)
    }

    /// The first bracket that opens within a place, such as that of `Function(..)`.
    pub(crate) fn bracket(&self, within: Span) -> Option<Bracket> {
        let first = self.tokens.partition_point(|(_, span)| span.start < within.start);
        let inside = |(_, span): &&(Kind, Span)| span.end <= within.end;
        let open = self.tokens[first..].iter().take_while(inside).position(|(kind, _)| *kind == Kind::Open)?;
        let (_, opening) = self.tokens[first + open];
        let mut items = Vec::new();
        let (mut depth, mut item) = (0, Vec::new());
        for (kind, span) in &self.tokens[first + open + 1..] {
            match kind {
                Kind::Close if depth == 0 => {
                    items.extend(self.item(&item, None));
                    return Some(Bracket { open: opening.end, items });
                }
                Kind::Comma if depth == 0 => {
                    items.extend(self.item(&item, Some(*span)));
                    item.clear();
                    continue;
                }
                Kind::Open => depth += 1,
                Kind::Close => depth -= 1,
                Kind::Comma | Kind::Colon | Kind::Text | Kind::Atom | Kind::LineComment | Kind::BlockComment => {}
            }
            item.push((*kind, *span));
        }
        None
    }

    /// The outermost bracket.
    pub(crate) fn outermost(&self) -> Option<Bracket> {
        self.bracket(Span::new(0, self.text.len()))
    }

    fn item(&self, tokens: &[(Kind, Span)], comma: Option<Span>) -> Option<Item> {
        let ((_, first), (_, last)) = (tokens.first()?, tokens.last()?);
        let keyed = tokens.get(1).is_some_and(|(kind, _)| *kind == Kind::Colon);
        let (key, value) = if keyed { (Some(*first), tokens.get(2)?.1) } else { (None, *first) };
        Some(Item { key, value: value.to(*last), whole: first.to(comma.unwrap_or(*last)) })
    }

    /// The item of a bracket that has a name.
    pub(crate) fn field<'b>(&self, bracket: &'b Bracket, name: &str) -> Option<&'b Item> {
        let named = |key: Span| {
            let text = &self.text[key.start..key.end];
            quoted(text).1 == name && text.contains('"') || text.trim_start_matches("r#") == name
        };
        bracket.items.iter().find(|item| item.key.is_some_and(named))
    }
}

impl Bracket {
    /// The item whose key stands at a place.
    #[cfg(any(feature = "precise", test))]
    pub(crate) fn keyed(&self, at: Span) -> Option<&Item> {
        self.items.iter().find(|item| item.key.is_some_and(|key| key.start <= at.start && at.end <= key.end))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_are_found_by_tokens() {
        let text = "/* a: ( */ T(a: \"b: (1,\", // c: 2,\n r#\"c\"#: f(x: [1, 2], y: {}), \"d\": 3 /* , */)";
        let layout = Layout::new(text);
        assert_eq!(layout.start(), 11);
        let all = layout.outermost().expect("brackets");
        let of = |span: Span| &text[span.start..span.end];
        let items = |bracket: &Bracket| -> Vec<(&str, &str)> {
            bracket.items.iter().map(|item| (item.key.map_or("", of), of(item.value))).collect()
        };
        assert_eq!(items(&all), [("a", "\"b: (1,\""), ("r#\"c\"#", "f(x: [1, 2], y: {})"), ("\"d\"", "3")]);
        assert_eq!(of(all.items[0].whole), "a: \"b: (1,\",");
        assert_eq!(of(all.items[2].whole), "\"d\": 3");
        let c = layout.field(&all, "c").expect("a field");
        let inner = layout.bracket(c.value).expect("brackets");
        assert_eq!(items(&inner), [("x", "[1, 2]"), ("y", "{}")]);
        let list = layout.bracket(layout.field(&inner, "x").expect("a field").value).expect("brackets");
        assert_eq!(items(&list), [("", "1"), ("", "2")]);
        assert_eq!((layout.field(&all, "b"), layout.bracket(all.items[2].value)), (None, None));
        assert_eq!(all.keyed(all.items[1].key.expect("a key")), Some(c));
    }
}
