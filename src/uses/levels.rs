//! Level sets, and which set a word that may be a level belongs to.

use super::{Finder, Kind, Symbol, SymbolId};
use crate::diag::{Span, Spanned};
use crate::table::expr::{Expr, ExprKind};
use crate::table::{ConstantValue, Domain, Input, Level, Output, Table};

/// A table, and the name of a set or input that it declares.
type Declared<'t> = (&'t Table, &'t Spanned<String>);

/// Names that lead to names lead to a set within so many steps, or in a circle.
const LONGEST: usize = 16;

/// The part of an expression's surroundings that says of which set a bare level is.
#[derive(Clone, Copy)]
pub(super) enum Expected<'t> {
    /// Nothing does.
    Anything,
    /// A level of this set.
    Level(SymbolId),
    /// A result of the table.
    Result(&'t Output<Spanned<String>>),
}

impl<'t> Finder<'t> {
    /// Enters the levels of a set.
    pub(super) fn declare_levels(&mut self, set: SymbolId, levels: &[Level]) {
        for level in levels {
            let id = self.declare_in(set, Kind::Level, &level.name, level.code.span);
            self.enter_level(set, &level.name.value, id);
        }
    }

    fn enter_level(&mut self, set: SymbolId, name: &str, level: SymbolId) {
        self.levels.entry((set, name.to_owned())).or_insert(level);
        self.having.entry(name.to_owned()).or_default().push(set);
    }

    /// The set of an input of the table: one that it shares, or the input itself.
    pub(super) fn set_of_input(&self, name: &str) -> Option<SymbolId> {
        let input = self.table.inputs.iter().find(|input| input.name.value == name)?;
        self.set_of_domain(input, LONGEST)
    }

    fn set_of_domain(&self, input: &Input, steps: usize) -> Option<SymbolId> {
        match &input.domain.value {
            Domain::Levels(_) => self.inputs.get(input.name.value.as_str()).copied(),
            Domain::LevelsOf(name) => self.set_named(&name.value, steps.checked_sub(1)?),
            Domain::Bool | Domain::Int(..) | Domain::U32 | Domain::Range(..) => None,
        }
    }

    /// The set that a word stands for: a set, an input, or one of an imported table.
    fn set_named(&self, name: &str, steps: usize) -> Option<SymbolId> {
        if let Some(set) = self.sets.get(name) {
            return Some(*set);
        }
        match self.table.inputs.iter().find(|input| input.name.value == name) {
            Some(input) => self.set_of_domain(input, steps),
            None => {
                let (table, set) = self.foreign_set(self.table, name, steps)?;
                self.foreign.get(&(std::ptr::from_ref(table), set.span)).copied()
            }
        }
    }

    /// The table that declares the set `t3::set`, and its name there.
    fn foreign_set(&self, within: &'t Table, name: &str, steps: usize) -> Option<Declared<'t>> {
        let (alias, rest) = name.split_once("::")?;
        let import = within.imports.iter().find(|import| import.alias.value == alias)?;
        own_set(import.table.as_deref()?, rest, steps.checked_sub(1)?)
    }

    /// Notes the use of a set by its name, and enters it, if it is that of an imported table.
    pub(super) fn mention_set(&mut self, name: &Spanned<String>) -> Option<SymbolId> {
        if let Some((alias, rest)) = name.value.split_once("::") {
            if let Some(import) = self.imports.get(alias).copied() {
                self.mention(name.span, alias, import);
            }
            let set = self.enter_foreign_set(&name.value)?;
            let start = self.word(name.span, &name.value).start + alias.len() + 2;
            self.mention(Span::new(start, start + rest.len()), rest, set);
            return Some(set);
        }
        let named = self.sets.get(name.value.as_str()).or_else(|| self.inputs.get(name.value.as_str())).copied()?;
        self.mention(name.span, &name.value, named);
        self.set_named(&name.value, LONGEST)
    }

    /// The set `t3::set` of an imported table, which is entered.
    pub(super) fn enter_foreign_set(&mut self, name: &str) -> Option<SymbolId> {
        let (table, set) = self.foreign_set(self.table, name, LONGEST)?;
        Some(self.foreign_symbol(table, Kind::Set, set))
    }

    /// A declaration of an imported table; of a set its levels come with it.
    pub(super) fn foreign_symbol(&mut self, table: &'t Table, kind: Kind, name: &Spanned<String>) -> SymbolId {
        let place = name.span;
        let key = (std::ptr::from_ref(table), place);
        if let Some(known) = self.foreign.get(&key) {
            return *known;
        }
        let id = SymbolId(self.symbols.len());
        let symbol = |kind, name: &str, place: Span, of| Symbol {
            kind,
            name: name.to_owned(),
            source: table.source.clone(),
            place: Self::word_in(table, place, name),
            whole: place,
            of,
            set: None,
            doc: String::new(),
        };
        self.symbols.push(symbol(kind, &name.value, place, None));
        self.foreign.insert(key, id);
        let sets = table.levels.iter().find(|(set, _)| set.span == place).map(|(_, levels)| levels);
        let input = table.inputs.iter().find(|input| input.name.span == place);
        if let Some(input) = input {
            self.symbols[id.0].doc = input.doc.clone();
            self.symbols[id.0].whole = place.to(input.domain.span);
        }
        let levels = sets.or_else(|| match input.map(|input| &input.domain.value) {
            Some(Domain::Levels(levels)) => Some(levels),
            Some(Domain::LevelsOf(_) | Domain::Bool | Domain::Int(..) | Domain::U32 | Domain::Range(..)) | None => None,
        });
        for level in levels.into_iter().flatten() {
            let inner = SymbolId(self.symbols.len());
            self.symbols.push(symbol(Kind::Level, &level.name.value, level.name.span, Some(id)));
            self.enter_level(id, &level.name.value, inner);
        }
        id
    }

    /// The set of the levels that an expression stands for, as far as its form tells.
    pub(super) fn set_of(&self, expr: &Expr) -> Option<SymbolId> {
        self.set_within(expr, LONGEST)
    }

    fn set_within(&self, expr: &Expr, steps: usize) -> Option<SymbolId> {
        let steps = steps.checked_sub(1)?;
        match &expr.kind {
            ExprKind::Name(name) => {
                if let Some((.., set)) = self.locals.iter().rev().find(|(local, ..)| local == name) {
                    return *set;
                }
                if let Some(set) = self.set_of_input(name) {
                    return Some(set);
                }
                let named = self.table.names.iter().find(|named| named.name.value == *name)?;
                self.set_within(&named.value, steps)
            }
            ExprKind::Level(set, _) => self.set_named(&set.value, steps),
            ExprKind::If(_, then, other) => self.set_within(then, steps).or_else(|| self.set_within(other, steps)),
            ExprKind::Let(_, _, body) => self.set_within(body, steps),
            ExprKind::Index(list, _) => {
                let name = list.name()?;
                let constant = self.table.constants.iter().find(|constant| constant.name.value == name)?;
                match &constant.value {
                    ConstantValue::Levels { of, .. } => self.set_named(&of.value, steps),
                    ConstantValue::Number(_) | ConstantValue::List(_) | ConstantValue::File(..) => None,
                }
            }
            ExprKind::Call(function, arguments) => match (function.value.as_str(), arguments.as_slice()) {
                ("select", [a, b, _]) => self.set_within(a, steps).or_else(|| self.set_within(b, steps)),
                (name, _) => self.set_of_call(name),
            },
            ExprKind::With(function, _) => self.set_of_call(&function.value),
            ExprKind::Number(_)
            | ExprKind::Unary(..)
            | ExprKind::Binary(..)
            | ExprKind::In(..)
            | ExprKind::Swizzle(..)
            | ExprKind::Case(..)
            | ExprKind::List(_)
            | ExprKind::Optional(..)
            | ExprKind::Between(..)
            | ExprKind::Sum(..)
            | ExprKind::Iterate(..)
            | ExprKind::Record(_) => None,
        }
    }

    /// The set of the levels that a call gives: of a fetch with arguments, or of an imported table.
    fn set_of_call(&self, name: &str) -> Option<SymbolId> {
        if let Some(set) = self.set_of_input(name) {
            return Some(set);
        }
        let import = self.table.imports.iter().find(|import| import.alias.value == name)?;
        let table = import.table.as_deref()?;
        match &table.output.value {
            Output::Enumeration(set) => {
                let (table, set) = own_set(table, &set.value, LONGEST)?;
                self.foreign.get(&(std::ptr::from_ref(table), set.span)).copied()
            }
            Output::Number(_)
            | Output::Vector(..)
            | Output::Bool
            | Output::Int(..)
            | Output::U32
            | Output::Record(_)
            | Output::List { .. } => None,
        }
    }

    /// The set of the levels that results, or items of them, are of.
    pub(super) fn set_of_output(&self, output: &Output<Spanned<String>>) -> Option<SymbolId> {
        match output {
            Output::Enumeration(set) => self.set_named(&set.value, LONGEST),
            Output::List { of, .. } => self.set_of_output(of),
            Output::Number(_)
            | Output::Vector(..)
            | Output::Bool
            | Output::Int(..)
            | Output::U32
            | Output::Record(_) => None,
        }
    }

    /// Notes a word that is a level, of the set that is known, or of each that has it.
    pub(super) fn mention_level(&mut self, span: Span, word: &str, set: Option<SymbolId>) {
        let sets = match set {
            Some(set) => vec![set],
            None => self.having.get(word).cloned().unwrap_or_default(),
        };
        for set in sets {
            if let Some(level) = self.levels.get(&(set, word.to_owned())).copied() {
                self.mention(span, word, level);
            }
        }
    }

    /// Notes a level as data and memberships name it: alone, or with its set.
    pub(super) fn mention_spelt(&mut self, level: &Spanned<String>, set: Option<SymbolId>) {
        let Some((of, word)) = level.value.rsplit_once("::") else {
            return self.mention_level(level.span, &level.value, set);
        };
        let start = self.word(level.span, &level.value).start;
        let of = Spanned::new(Span::new(start, start + of.len()), of.to_owned());
        let word_start = start + of.value.len() + 2;
        let set = self.mention_set(&of).or(set);
        self.mention_level(Span::new(word_start, word_start + word.len()), word, set);
    }
}

/// The set that a name stands for in a table.
fn own_set<'t>(table: &'t Table, name: &str, steps: usize) -> Option<Declared<'t>> {
    if let Some((set, _)) = table.levels.iter().find(|(set, _)| set.value == name) {
        return Some((table, set));
    }
    let steps = steps.checked_sub(1)?;
    if let Some((alias, rest)) = name.split_once("::") {
        let import = table.imports.iter().find(|import| import.alias.value == alias)?;
        return own_set(import.table.as_deref()?, rest, steps);
    }
    let input = table.inputs.iter().find(|input| input.name.value == name)?;
    match &input.domain.value {
        Domain::Levels(_) => Some((table, &input.name)),
        Domain::LevelsOf(of) => own_set(table, &of.value, steps),
        Domain::Bool | Domain::Int(..) | Domain::U32 | Domain::Range(..) => None,
    }
}
