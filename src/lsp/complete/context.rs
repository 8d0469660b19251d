//! The surroundings of a place in a table, told from the tokens before it: the text need be no table yet.

use crate::diag::Span;
use crate::table::fields::{Form, Part, forms};
use crate::text::tokens::{Kind, quoted, tokens};

/// A bracket that is open at a place.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Frame<'a> {
    /// The bracket.
    pub(super) bracket: char,
    /// The word before it, such as `Case`.
    pub(super) word: Option<&'a str>,
    /// The key of the item that the place is in, without quotes, if that is behind its colon.
    pub(super) key: Option<&'a str>,
    /// The keys of items that are complete.
    pub(super) before: Vec<&'a str>,
}

/// The surroundings of a place.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Context<'a> {
    /// The brackets around it, the outermost first.
    pub(super) frames: Vec<Frame<'a>>,
    /// The part of a text in quotes that stands before the place, if that is in one.
    pub(super) text: Option<&'a str>,
    /// The part of a word that stands before it, if that is not in quotes.
    pub(super) word: &'a str,
    /// True if it is in a comment.
    pub(super) is_comment: bool,
}

/// The context of a place.
pub(super) fn context(text: &str, offset: usize) -> Context<'_> {
    let mut end = offset.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let all = tokens(before);
    let mut context = Context { frames: Vec::new(), text: None, word: "", is_comment: false };
    let mut last: Option<(Kind, &str)> = None;
    for (index, token) in all.iter().enumerate() {
        let at_end = index + 1 == all.len() && before.ends_with(token.text);
        match token.kind {
            Kind::Open => {
                let word = last.filter(|(kind, _)| *kind == Kind::Atom).map(|(_, text)| text);
                let bracket = token.text.chars().next().unwrap_or('(');
                context.frames.push(Frame { bracket, word, key: None, before: Vec::new() });
            }
            Kind::Close => {
                context.frames.pop();
            }
            Kind::Comma => {
                if let Some(frame) = context.frames.last_mut() {
                    frame.before.extend(frame.key.take());
                }
            }
            Kind::Colon => {
                if let (Some(frame), Some((kind, word))) = (context.frames.last_mut(), last) {
                    frame.key = Some(if kind == Kind::Text { quoted(word).1 } else { word });
                }
            }
            Kind::Text if at_end && is_open(token.text) => {
                context.text = Some(&token.text[token.text.find('"').map_or(0, |at| at + 1)..]);
            }
            Kind::Atom if at_end => context.word = token.text,
            Kind::LineComment | Kind::BlockComment => {
                context.is_comment |= at_end && !(token.kind == Kind::BlockComment && token.text.ends_with("*/"));
            }
            Kind::Text | Kind::Atom => {}
        }
        if !token.is_comment() {
            last = Some((token.kind, token.text));
        }
    }
    context
}

/// Returns whether a text in quotes has no end yet.
fn is_open(text: &str) -> bool {
    let (open, _, close) = quoted(text);
    close.is_empty() || !close.starts_with('"') || open.len() + close.len() > text.len()
}

impl Frame<'_> {
    /// The parts that stand in a field or map of this part, by its key.
    fn part_of_field(part: Part, key: &str) -> Option<Part> {
        Some(match (part, key) {
            (Part::Table, "cases") | (Part::Function, "cases") => Part::Case,
            (Part::Table, "inputs") => Part::Input,
            (Part::Table, "symmetries") => Part::Symmetry,
            (Part::Table, "functions") => Part::Function,
            (Part::Table, "output") => Part::Output,
            (Part::Table, "continuity") => Part::Continuity,
            (Part::Table, "claims") => Part::Claim,
            (Part::Table, "draw") => Part::Draw,
            (Part::Table, "constants") => Part::Constant,
            (Part::Table | Part::Case, "allow") => Part::Allow,
            (Part::Case | Part::Function, "errata") => Part::Erratum,
            (Part::Case, "is") => Part::Image,
            (Part::Case | Part::Continuity, "when") | (Part::Table, "names" | "assume") => Part::Condition,
            (Part::Case, "lines") => Part::Condition,
            (Part::Function, "limits") => Part::Limit,
            (Part::Function, "error") => Part::Accuracy,
            (Part::Input, "fetched") => Part::Fetched,
            _ => return None,
        })
    }
}

impl<'a> Context<'a> {
    /// The part that may be written here, and, if its parentheses are open already, that and the way it is written.
    ///
    /// Of the brackets around the place, the outermost are those of the table. Lists and maps are passed
    /// through: a case stands in the list of cases, an input in the map of inputs.
    pub(super) fn part(&self) -> (Option<Part>, Option<(Part, Form)>) {
        let Some((outermost, inner)) = self.frames.split_first() else { return (Some(Part::Table), None) };
        let table = forms(Part::Table).into_iter().next();
        let mut open = table.map(|form| (Part::Table, form));
        let mut expected = outermost.key.and_then(|key| Frame::part_of_field(Part::Table, key));
        for frame in inner {
            // Within maps and lists of a field no further field is opened.
            let Some(part) = expected.filter(|_| frame.bracket == '(') else {
                open = None;
                continue;
            };
            let all = forms(part);
            let form = match frame.word {
                Some(word) => all.into_iter().find(|form| form.word == word),
                None => all.into_iter().next().filter(|form| !form.fields.is_empty()),
            };
            expected = match part {
                // Of these the same stands within them.
                Part::Output | Part::Condition => Some(part),
                part => frame.key.and_then(|key| Frame::part_of_field(part, key)),
            };
            open = form.map(|form| (part, form));
        }
        (expected, open)
    }

    /// The key of the innermost item that has one, with the brackets it is in.
    pub(super) fn innermost_key(&self) -> Option<(usize, &'a str)> {
        self.frames.iter().enumerate().rev().find_map(|(depth, frame)| Some((depth, frame.key?)))
    }

    /// The fields of parts, from the outermost in, such as `cases`, `when`.
    pub(super) fn fields(&self) -> Vec<&'a str> {
        self.frames.iter().filter(|frame| frame.bracket == '(').filter_map(|frame| frame.key).collect()
    }
}

/// The name of a field at a place, and the part that it is a field of.
pub(super) fn field(text: &str, offset: usize) -> Option<(Part, &str, Span)> {
    let all = tokens(text);
    let place = |piece: &str| {
        let start = (piece.as_ptr() as usize).saturating_sub(text.as_ptr() as usize);
        Span::new(start, start + piece.len())
    };
    let index = all.iter().position(|token| {
        let span = place(token.text);
        token.kind == Kind::Atom && span.start <= offset && offset <= span.end
    })?;
    let token = &all[index];
    all[index + 1..].iter().find(|token| !token.is_comment()).filter(|next| next.kind == Kind::Colon)?;
    let span = place(token.text);
    let (_, open) = context(text, span.start).part();
    let (part, form) = open?;
    form.fields.contains(&token.text).then_some((part, token.text, span))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at_mark(text: &str) -> (String, Option<String>, String) {
        let offset = text.find('@').expect("a mark");
        let text = text.replace('@', "");
        let context = context(&text, offset);
        let (expected, open) = context.part();
        let shown = format!("{:?} in {:?}", expected, open.map(|(part, form)| (part, form.word)));
        (shown, context.text.map(str::to_owned), context.word.to_owned())
    }

    #[test]
    fn tokens_before_a_place_say_where_it_is() {
        let said = |text: &str| at_mark(text).0;
        assert_eq!(said("Table(na@"), "None in Some((Table, \"Table\"))");
        assert_eq!(said("Table(cases: [Case(id: 1, wh@"), "None in Some((Case, \"Case\"))");
        assert_eq!(said("Table(cases: [@"), "Some(Case) in None");
        assert_eq!(said("Table(cases: [(id: 1, @"), "None in Some((Case, \"Case\"))");
        assert_eq!(said("Table(inputs: {\"x\": Range(@"), "None in Some((Input, \"Range\"))");
        assert_eq!(said("Table(inputs: {\"x\": R@"), "Some(Input) in None");
        assert_eq!(said("Table(inputs: {\"x\": Range(from: 0, fetched: (@"), "None in Some((Fetched, \"\"))");
        assert_eq!(said("Table(output: Record({\"a\": @"), "Some(Output) in None");
        assert_eq!(said("Table(cases: [Case(id: 1, when: All([@"), "Some(Condition) in None");
        assert_eq!(said("(symmetries: {\"m\": Symmetry(map: {@"), "None in None");
        assert_eq!(said("Table(inputs: {}, @"), "None in Some((Table, \"Table\"))");
        let (_, text, word) = at_mark("Table(cases: [Case(id: 1, when: \"H == le@");
        assert_eq!((text.as_deref(), word.as_str()), (Some("H == le"), ""));
        assert_eq!(at_mark("Table(name: \"t\"@").1, None);
        assert!(context("Table( // a", 11).is_comment);
    }
}
