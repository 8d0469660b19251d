//! Groups of inputs that are `false` or `true`, asked together by patterns such as `01-1`.
//!
//! A pattern has a letter for each input of the group, the first letter for the first
//! input: `0` asks for `false`, `1` for `true`, `-` for nothing. It means the
//! conjunction of what its letters ask, in this order; of several patterns one must match.

use super::scope::Env;
use super::{Lowering, Result, SetId};
use crate::diag::{Diagnostic, Spanned, codes};
use crate::program::pool::CondId;
use crate::table::Group;
use crate::table::expr::{Expr, ExprKind};

impl<'t> Lowering<'t> {
    /// Checks that a group consists of inputs that are `false` or `true`, each once.
    pub(super) fn check_group(&self, group: &Group) -> Result<()> {
        for (index, member) in group.members.iter().enumerate() {
            // Functions have some of the inputs of their table each.
            let declared = self.table.inputs.iter().any(|input| input.name.value == member.value);
            match self.input_named(&member.value) {
                None if !declared => return Err(self.unknown_input(member, "not an input of the table")),
                Some(input) if self.input_sets[input.index()] != Some(SetId::BOOL) => {
                    return Err(Diagnostic::error(codes::DOMAIN, format!("`{}` is no condition", member.value))
                        .at(member.span, "a group consists of inputs that are false or true")
                        .at(self.inputs[input.index()].span, "declared here")
                        .help("ask for the levels of this input beside the group"));
                }
                _ => {}
            }
            if let Some(first) = group.members[..index].iter().find(|other| other.value == member.value) {
                let message = format!("`{}` is twice in the group `{}`", member.value, group.name.value);
                let error = Diagnostic::error(codes::DUPLICATE, message);
                return Err(error.at(member.span, "again").at(first.span, "first here"));
            }
        }
        Ok(())
    }

    /// The group that an expression names.
    pub(super) fn group_named(&self, expr: &Expr, env: &Env) -> Option<&'t Group> {
        let name = expr.name()?;
        self.scopes[env.scope].groups.iter().find(|group| group.name.value == name)
    }

    /// The condition that the inputs of a group match one of some patterns.
    pub(super) fn matches(&mut self, group: &Group, patterns: &[Spanned<String>], env: &Env) -> Result<CondId> {
        let mut any = Vec::with_capacity(patterns.len());
        for pattern in patterns {
            let letters = pattern.value.as_bytes();
            if letters.len() != group.members.len() || !letters.iter().all(|letter| b"01-".contains(letter)) {
                let names = group.members.iter().map(|member| member.value.as_str()).collect::<Vec<_>>().join(", ");
                let example = "01-1".chars().cycle().take(group.members.len()).collect::<String>();
                return Err(Diagnostic::error(codes::UNKNOWN_LEVEL, format!("`{}` is no pattern", pattern.value))
                    .at(pattern.span, format!("expected {} letters, each 0, 1 or -", group.members.len()))
                    .help(format!("one letter for each of {names}: \"{example}\", where - stands for either")));
            }
            if letters.iter().all(|letter| *letter == b'-') {
                return Err(Diagnostic::error(codes::UNKNOWN_LEVEL, "this pattern asks for nothing")
                    .at(pattern.span, "every letter is -")
                    .help("leave the group out of the condition"));
            }
            let mut all = Vec::with_capacity(letters.len());
            for (member, letter) in group.members.iter().zip(letters) {
                if *letter == b'-' {
                    continue;
                }
                let name = Expr { span: pattern.span, kind: ExprKind::Name(member.value.clone()) };
                let holds = self.condition(&name, env)?;
                all.push(if *letter == b'1' { holds } else { self.pool.not(holds) });
            }
            any.push(self.pool.and(all));
        }
        Ok(self.pool.or(any))
    }
}
