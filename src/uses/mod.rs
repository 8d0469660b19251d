//! Declarations of a table and where each of them is used: what an editor asks for.
//!
//! This follows the table as written, by the rules of scope in `docs/language.md`, and needs
//! no program: it works while a table is being written and means nothing yet. Of a level
//! whose set only types could tell, all sets that have it are candidates. Whoever changes a
//! text by what is found here checks the result like any other table.

mod expressions;
mod levels;
mod rows;
mod tables;

use std::collections::HashMap;
use std::sync::Arc;

use crate::diag::{Source, Span, Spanned};
use crate::table::Table;

/// The kind of a declaration.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// An input, or a fetch with arguments.
    Input,
    /// A level set.
    Set,
    /// A level of a set, or of an input with levels of its own.
    Level,
    /// A named condition or value.
    Name,
    /// A group of inputs.
    Group,
    /// Constant data.
    Constant,
    /// A function for use inside the table.
    Helper,
    /// A function that generated code offers.
    Function,
    /// A parameter of a helper.
    Parameter,
    /// A value named within an expression or a function, or what is counted in one.
    Local,
    /// A case.
    Case,
    /// A symmetry.
    Symmetry,
    /// An imported table.
    Import,
    /// An assumption.
    Assumption,
    /// A place where the value does not jump.
    Continuity,
    /// A claim.
    Claim,
}

impl Kind {
    /// The kind in words, with an article.
    pub fn words(self) -> &'static str {
        match self {
            Kind::Input => "an input",
            Kind::Set => "a level set",
            Kind::Level => "a level",
            Kind::Name => "a name",
            Kind::Group => "a group of inputs",
            Kind::Constant => "constant data",
            Kind::Helper => "a helper",
            Kind::Function => "a function",
            Kind::Parameter => "a parameter",
            Kind::Local => "a local value",
            Kind::Case => "a case",
            Kind::Symmetry => "a symmetry",
            Kind::Import => "an imported table",
            Kind::Assumption => "an assumption",
            Kind::Continuity => "a place without jumps",
            Kind::Claim => "a claim",
        }
    }
}

/// Number of a declaration among [`Uses::symbols`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct SymbolId(usize);

/// A declaration.
#[derive(Debug, Clone)]
pub struct Symbol {
    /// Its kind.
    pub kind: Kind,
    /// Its name; of a case its number.
    pub name: String,
    /// The text that it stands in: that of the table, or of one that is imported.
    pub source: Arc<Source>,
    /// The place of its name.
    pub place: Span,
    /// The whole declaration.
    pub whole: Span,
    /// The set or input that a level belongs to, the helper or function of a parameter, the function of a case.
    pub of: Option<SymbolId>,
    /// The set that it is a level of, where it stands for one.
    pub set: Option<SymbolId>,
    /// Its description.
    pub doc: String,
}

/// A word that stands for something declared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Occurrence {
    /// The place of the word, without quotes.
    pub span: Span,
    /// Its declaration.
    pub symbol: SymbolId,
    /// True if it is the declaration itself.
    pub declares: bool,
}

/// The declarations of a table and their uses.
#[derive(Debug)]
pub struct Uses {
    symbols: Vec<Symbol>,
    occurrences: Vec<Occurrence>,
    /// The set of the levels that results, or items of them, are.
    pub output: Option<SymbolId>,
}

impl Uses {
    /// Looks through a table.
    ///
    /// ```
    /// use umbrage::table::Table;
    /// use umbrage::uses::{Kind, Uses};
    ///
    /// let uses = Uses::of(&Table::read("tables/smsr.ron")?);
    /// let (corner, _) = uses.symbols().find(|(_, symbol)| symbol.name == "corner").expect("is declared");
    /// assert_eq!((uses[corner].kind, uses.occurrences(corner).count()), (Kind::Name, 6));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn of(table: &Table) -> Self {
        let mut finder = Finder::new(table);
        finder.table();
        let output = finder.set_of_output(&table.output.value);
        let Finder { symbols, mut occurrences, .. } = finder;
        occurrences.sort_by_key(|occurrence| (occurrence.span.start, occurrence.span.end, occurrence.symbol));
        occurrences.dedup();
        Self { symbols, occurrences, output }
    }

    /// Gives a declaration another name in the text of its table: the places that change, in order. Levels that are
    /// given by their codes stay as they are.
    pub fn renamed(&self, symbol: SymbolId) -> Vec<Span> {
        let Symbol { name, source, .. } = &self[symbol];
        let places = self.occurrences(symbol).map(|occurrence| occurrence.span);
        let mut places: Vec<Span> = places.filter(|span| source.text.get(span.start..span.end) == Some(name)).collect();
        places.dedup();
        places
    }

    /// All declarations.
    pub fn symbols(&self) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        self.symbols.iter().enumerate().map(|(index, symbol)| (SymbolId(index), symbol))
    }

    /// The places where something is declared or used, in the order of the text.
    pub fn occurrences(&self, symbol: SymbolId) -> impl Iterator<Item = &Occurrence> {
        self.occurrences.iter().filter(move |occurrence| occurrence.symbol == symbol)
    }

    /// The declarations that the word at a place may stand for: mostly one.
    pub fn at(&self, offset: usize) -> impl Iterator<Item = &Occurrence> {
        self.occurrences
            .iter()
            .filter(move |occurrence| occurrence.span.start <= offset && offset <= occurrence.span.end)
    }

    /// The levels of a set, or of an input that has levels of its own.
    pub fn levels(&self, set: SymbolId) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        self.symbols().filter(move |(_, symbol)| symbol.kind == Kind::Level && symbol.of == Some(set))
    }
}

impl std::ops::Index<SymbolId> for Uses {
    type Output = Symbol;

    fn index(&self, symbol: SymbolId) -> &Symbol {
        &self.symbols[symbol.0]
    }
}

/// The state of the way through a table.
struct Finder<'t> {
    table: &'t Table,
    symbols: Vec<Symbol>,
    occurrences: Vec<Occurrence>,
    /// Declarations of the table by their names; functions, cases, levels and symmetries have name spaces of their own.
    inputs: HashMap<&'t str, SymbolId>,
    sets: HashMap<&'t str, SymbolId>,
    values: HashMap<&'t str, SymbolId>,
    callables: HashMap<&'t str, SymbolId>,
    symmetries: HashMap<&'t str, SymbolId>,
    imports: HashMap<&'t str, SymbolId>,
    /// The cases of the table or of the function that is looked through.
    cases: HashMap<u32, SymbolId>,
    /// Declarations of imported tables that are used here, by the table and the place of the name there.
    foreign: HashMap<(*const Table, Span), SymbolId>,
    /// The levels by their sets and names, and the sets that have a level of a name.
    levels: HashMap<(SymbolId, String), SymbolId>,
    having: HashMap<String, Vec<SymbolId>>,
    /// Names bound within what is looked through, the innermost last, with the sets of those that are levels.
    locals: Vec<(String, SymbolId, Option<SymbolId>)>,
    /// True in a helper, which sees its parameters and constants only.
    in_helper: bool,
}

impl<'t> Finder<'t> {
    fn new(table: &'t Table) -> Self {
        Self {
            table,
            symbols: Vec::new(),
            occurrences: Vec::new(),
            inputs: HashMap::new(),
            sets: HashMap::new(),
            values: HashMap::new(),
            callables: HashMap::new(),
            symmetries: HashMap::new(),
            imports: HashMap::new(),
            cases: HashMap::new(),
            foreign: HashMap::new(),
            levels: HashMap::new(),
            having: HashMap::new(),
            locals: Vec::new(),
            in_helper: false,
        }
    }

    /// Enters a declaration of this table, which is the first place of its name.
    fn declare(&mut self, kind: Kind, name: &Spanned<String>, whole: Span, doc: &str) -> SymbolId {
        let place = self.word(name.span, &name.value);
        let symbol = Symbol {
            kind,
            name: name.value.clone(),
            source: self.table.source.clone(),
            place,
            whole: name.span.to(whole),
            of: None,
            set: None,
            doc: doc.to_owned(),
        };
        let id = SymbolId(self.symbols.len());
        self.symbols.push(symbol);
        self.occurrences.push(Occurrence { span: place, symbol: id, declares: true });
        id
    }

    /// Enters a declaration that belongs to another one.
    fn declare_in(&mut self, of: SymbolId, kind: Kind, name: &Spanned<String>, whole: Span) -> SymbolId {
        let id = self.declare(kind, name, whole, "");
        self.symbols[id.0].of = Some(of);
        id
    }

    /// Notes that a word is used.
    fn mention(&mut self, span: Span, word: &str, symbol: SymbolId) {
        let span = self.word(span, word);
        self.occurrences.push(Occurrence { span, symbol, declares: false });
    }

    /// The place of a word within a place of this table.
    fn word(&self, span: Span, word: &str) -> Span {
        Self::word_in(self.table, span, word)
    }

    /// The place of a word within a place that may have quotes around it, or more of a name behind it.
    fn word_in(table: &Table, span: Span, word: &str) -> Span {
        let text = table.source.text.get(span.start..span.end).unwrap_or_default();
        let quotes =
            text.find('"').filter(|at| text[..*at].chars().all(|c| c == 'r' || c == '#')).map_or(0, |at| at + 1);
        match text.get(quotes..).is_some_and(|rest| rest.starts_with(word)) {
            true => Span::new(span.start + quotes, span.start + quotes + word.len()),
            // A level may be given by its code.
            false => Span::new(span.start + quotes, span.end.saturating_sub(quotes).max(span.start + quotes)),
        }
    }
}

#[cfg(test)]
mod tests;
