//! Changes of a table's text that acknowledge a finding, or stop to acknowledge what there is not.
//!
//! Only where something is put in or taken out is decided here; [`super::lints`] knows what.

use crate::diag::{Diagnostic, Span};
use crate::program::Program;
use crate::table::Allow;
use crate::text::layout::{Bracket, Layout};

/// The text of a table, taken apart once for all of its findings.
pub(super) struct Text<'p> {
    program: &'p Program,
    layout: std::cell::OnceCell<Layout<'p>>,
}

impl<'p> Text<'p> {
    pub(super) fn new(program: &'p Program) -> Self {
        Self { program, layout: std::cell::OnceCell::new() }
    }

    fn layout(&self) -> &Layout<'p> {
        self.layout.get_or_init(|| Layout::new(&self.program.source.text))
    }

    /// The brackets of a case, given by its row, or of the table.
    fn bracket(&self, row: Option<usize>) -> Option<Bracket> {
        match row {
            Some(row) => self.layout().bracket(self.program.rows[row].span),
            None => self.layout().outermost(),
        }
    }

    /// Offers to write an `allow` into a case or the table: at the end of those that there are, or as a field.
    pub(super) fn offer(&self, finding: Diagnostic, row: Option<usize>, allow: &str) -> Diagnostic {
        let place = self.bracket(row).and_then(|bracket| match self.layout().field(&bracket, "allow") {
            Some(field) => Some((self.layout().bracket(field.value)?, allow.to_owned())),
            None => Some((bracket, format!("allow: [{allow}]"))),
        });
        let Some((bracket, written)) = place else { return finding };
        let (at, text) = self.behind_last(&bracket, &written);
        let whose = row.map_or_else(|| "the table".to_owned(), |row| format!("case {}", self.program.rows[row].id));
        finding.mend(format!("acknowledge it in {whose}, with a reason"), Span::new(at, at), text)
    }

    /// Offers to name further things in an `allow`.
    pub(super) fn offer_more(&self, finding: Diagnostic, allow: &Allow, things: &[&str]) -> Diagnostic {
        let field = self.field(allow, "with").and_then(|field| self.layout().bracket(field));
        let Some(bracket) = field else { return finding };
        let things: Vec<String> = things.iter().map(|thing| format!("{thing:?}")).collect();
        let (at, text) = self.behind_last(&bracket, &things.join(", "));
        finding.mend("acknowledge it as well", Span::new(at, at), text)
    }

    /// Offers to let an `allow` say what it acknowledges.
    pub(super) fn offer_with(&self, finding: Diagnostic, allow: &Allow, things: &str) -> Diagnostic {
        let at = allow.code.span.end;
        finding.mend("acknowledge no more than this", Span::new(at, at), format!(", with: {things}"))
    }

    /// Offers to take out an `allow`, and the field, if nothing else is in it.
    pub(super) fn offer_without(&self, finding: Diagnostic, row: Option<usize>, allow: &Allow) -> Diagnostic {
        let whole = self.bracket(row).and_then(|bracket| {
            let field = self.layout().field(&bracket, "allow")?;
            let all = self.layout().bracket(field.value)?;
            match all.items.len() {
                1 => Some(field.whole),
                _ => all.items.iter().find(|item| item.value == allow.span).map(|item| item.whole),
            }
        });
        match whole {
            Some(whole) => finding.mend("remove it", whole, ""),
            None => finding,
        }
    }

    /// Offers to take one of the things out that an `allow` names.
    pub(super) fn offer_fewer(&self, finding: Diagnostic, allow: &Allow, thing: Span) -> Diagnostic {
        let all = self.field(allow, "with").and_then(|field| self.layout().bracket(field));
        match all.as_ref().and_then(|all| all.items.iter().find(|item| item.value == thing)) {
            Some(item) => finding.mend("remove it", item.whole, ""),
            None => finding,
        }
    }

    fn field(&self, allow: &Allow, name: &str) -> Option<Span> {
        let bracket = self.layout().bracket(allow.span)?;
        self.layout().field(&bracket, name).map(|field| field.value)
    }

    /// The place behind the last item of a bracket, and what is to be written there for one more.
    fn behind_last(&self, bracket: &Bracket, item: &str) -> (usize, String) {
        let Some(last) = bracket.items.last() else { return (bracket.open, item.to_owned()) };
        match last.whole.end > last.value.end {
            true => (last.whole.end, format!(" {item},")),
            false => (last.whole.end, format!(", {item}")),
        }
    }
}
