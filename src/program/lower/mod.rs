//! Table → program: declarations first, then rows, collecting every mistake.

mod arithmetic;
mod built_in;
mod calls;
mod claims;
mod collect;
mod data;
mod declare;
mod draw;
mod examples;
mod fetches;
mod functions;
mod groups;
mod images;
mod known;
mod levels;
mod library;
mod lists;
mod memo;
mod orbit;
mod output;
mod results;
mod rows;
mod scope;
mod sets;
mod tables;
mod terms;
#[cfg(test)]
mod tests;
mod whole;
mod wide;
mod words;
mod written;

use std::collections::{HashMap, HashSet};
use std::rc::Rc;
use std::sync::Arc;

use super::bits::InputSet;
use super::domain::{Input, LevelKind, Levels, StateSpace};
use super::pool::Pool;
use super::{Assumption, InputId, Program, Written};
use crate::diag::{Diagnostic, Failure, Source, codes};
use crate::table::{self, Table, names};
use library::Imported;
use memo::Memo;
use scope::Env;
use tables::Programs;
use terms::Term;
use wide::{AllCuts, refined};

pub use built_in::{Signature, signatures};
pub use levels::LevelTerm;
pub(super) use library::{declarations, functions, no_function};

type Result<T> = std::result::Result<T, Diagnostic>;

/// The version of the language from which on integers are numbers.
const SINCE: u32 = 2;

/// Number of a level set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
struct SetId(usize);

impl SetId {
    /// The levels of booleans.
    const BOOL: SetId = SetId(0);
}

/// The state of lowering one table.
struct Lowering<'t> {
    table: &'t Table,
    pool: Pool,
    sets: Vec<Levels>,
    /// The level set of each input; `None` for continuous ones.
    input_sets: Vec<Option<SetId>>,
    inputs: Vec<Input>,
    named_index: HashMap<&'t str, usize>,
    named_terms: Vec<Option<Term>>,
    /// The named values being lowered, with their scopes.
    resolving: Vec<(usize, usize)>,
    /// This table, and those that it imports, directly or not.
    scopes: Vec<&'t Table>,
    /// The scope that an imported table has, by the scope that imports it and the name there.
    import_index: HashMap<(usize, &'t str), usize>,
    /// The programs of the tables of cases that are imported, directly or not.
    programs: Programs,
    /// The functions being called, outermost first, with their scopes.
    calling: Vec<(usize, &'t str)>,
    /// True if sine and cosine mean the portable ones.
    portable: bool,
    /// The calls written out before, and how much work that was.
    memo: Memo<'t>,
    /// The depth to which [`Lowering::term`] is nested in itself.
    depth: u32,
    input_index: HashMap<&'t str, InputId>,
    /// The fetches with arguments.
    fetches: Vec<fetches::Fetch<'t>>,
    set_index: HashMap<&'t str, SetId>,
    /// The sets that inputs are the first to have, by their names.
    own_sets: HashMap<&'t str, SetId>,
    /// The sets of imported tables that are asked for, by their scopes and their names there.
    foreign_sets: HashMap<(usize, String), SetId>,
    /// True if the inputs are those of a function, some of those of the table.
    of_function: bool,
    case_index: HashMap<u32, usize>,
    /// The names of inputs of any integers, by their sets.
    wide: HashMap<usize, String>,
    /// The cuts of these, and those that were missing.
    cuts: AllCuts,
    wanted: AllCuts,
    output: Rc<table::Output<SetId>>,
}

/// Checks a table.
pub(super) fn program(table: &Table) -> std::result::Result<Program, Failure> {
    program_with(table, &mut Imported::default())
}

/// Checks a table, with the tables that were checked before.
fn program_with(table: &Table, imported: &mut Imported) -> std::result::Result<Program, Failure> {
    library::check_imports(table, imported)?;
    refined(|cuts| lowered(table, &imported.programs, cuts))
}

/// Checks a table with integers cut in some way, and returns the cuts that were missing.
fn lowered(table: &Table, programs: &Programs, cuts: &AllCuts) -> (std::result::Result<Program, Failure>, AllCuts) {
    let fail = |diagnostics| Failure { source: table.source.clone(), diagnostics };
    let mut errors = Vec::new();
    let mut lowering = Lowering::new(table, programs.clone(), cuts);
    // Without sound declarations nothing that follows could be judged.
    let inputs: Vec<&table::Input> = table.inputs.iter().collect();
    lowering.declare(&inputs, &mut errors);
    lowering.declare_functions(&mut errors);
    if !errors.is_empty() {
        return (Err(fail(errors)), AllCuts::new());
    }
    let states = match StateSpace::new(&lowering.inputs) {
        Ok(states) => states,
        Err(product) => return (Err(fail(vec![lowering.too_many_states(product)])), AllCuts::new()),
    };
    let (program, wanted) = lowering.finish(states, &mut errors);
    match program {
        Some(program) if errors.is_empty() => (Ok(program), wanted),
        _ => (Err(fail(errors)), wanted),
    }
}

impl<'t> Lowering<'t> {
    fn new(table: &'t Table, programs: Programs, cuts: &AllCuts) -> Self {
        let mut lowering = Lowering {
            table,
            pool: Pool::default(),
            sets: vec![Levels {
                names: vec!["false".to_owned(), "true".to_owned()],
                codes: vec![0.0, 1.0],
                kind: LevelKind::Bool,
                classes: None,
            }],
            input_sets: Vec::new(),
            inputs: Vec::new(),
            named_index: HashMap::new(),
            named_terms: vec![None; table.names.len()],
            resolving: Vec::new(),
            scopes: Vec::new(),
            import_index: HashMap::new(),
            programs,
            calling: Vec::new(),
            portable: false,
            memo: Memo::default(),
            depth: 0,
            input_index: HashMap::new(),
            fetches: Vec::new(),
            set_index: HashMap::new(),
            own_sets: HashMap::new(),
            foreign_sets: HashMap::new(),
            of_function: false,
            case_index: HashMap::new(),
            wide: HashMap::new(),
            cuts: cuts.clone(),
            wanted: AllCuts::new(),
            output: Rc::new(table::Output::Number(None)),
        };
        lowering.open_scope(table);
        lowering
    }

    /// Gives a table and those that it imports a scope each, by whatever way they are imported.
    fn open_scope(&mut self, table: &'t Table) -> usize {
        if let Some(known) = self.scopes.iter().position(|open| std::ptr::eq(*open, table)) {
            return known;
        }
        let scope = self.scopes.len();
        self.scopes.push(table);
        for import in &table.imports {
            if let Some(imported) = &import.table {
                let inner = self.open_scope(imported);
                self.import_index.insert((scope, &import.alias.value), inner);
            }
        }
        scope
    }

    /// The texts of the tables that this one imports, directly or not, and of the files of data that they name.
    fn imported(&self) -> Vec<Arc<Source>> {
        let tables = self.scopes.iter().skip(1).map(|table| table.source.clone());
        let data = self.scopes.iter().flat_map(|table| table.data_files()).map(|file| file.source.clone());
        tables.chain(data).collect()
    }

    /// The inputs that are fetched.
    fn fetched(&self) -> InputSet {
        let fetched = self.inputs.iter().enumerate().filter(|(_, i)| i.fetched.is_some());
        fetched.fold(InputSet::default(), |set, (i, _)| set.or(InputSet::one(InputId::new(i))))
    }

    fn finish(mut self, states: StateSpace, errors: &mut Vec<Diagnostic>) -> (Option<Program>, AllCuts) {
        let table = self.table;
        for named in &table.names {
            // Lowered where used, but a mistake in an unused one is a mistake too.
            let _ = keep(self.term_of_name(&named.name.value), errors);
            // A chain of names that is too long would be reported once per link.
            if errors.last().is_some_and(|e| e.code == codes::TOO_DEEP) {
                break;
            }
        }
        let mut rows = Vec::new();
        // Where the rows of each case begin.
        let mut begins = Vec::new();
        for case in &table.cases {
            begins.push(rows.len());
            rows.extend(keep(self.rows(case), errors).unwrap_or_default());
        }
        if self.collects() {
            let _ = keep(self.collect(&mut rows), errors);
        }
        let is_sound = errors.is_empty();
        if is_sound {
            self.check_rows(&rows, errors);
        }
        let env = Env::default();
        let default = keep(self.default_term(&env).and_then(|t| self.result(t, table.default.span)), errors);
        if is_sound && let Some(default) = &default {
            self.check_default(&rows, default, errors);
        }
        let assumptions = table.assumptions.iter().filter_map(|assumption| {
            keep(names::check_inner(&assumption.name.value, "an assumption", assumption.name.span), errors)?;
            let condition = keep(self.condition(&assumption.condition, &env), errors)?;
            let (name, doc) = (assumption.name.value.clone(), assumption.doc.clone());
            Some(Assumption { name, condition, doc, span: assumption.condition.span })
        });
        let assumptions = assumptions.collect();
        let draw = self.draw(errors);
        let symmetries = table.symmetries.iter().filter_map(|s| keep(self.symmetry(s), errors)).collect();
        let continuity = table.continuity.iter().filter_map(|c| keep(self.continuity(c), errors)).collect();
        let mut examples = Vec::new();
        for (row, case) in begins.into_iter().zip(&table.cases) {
            for example in &case.examples {
                examples.extend(keep(self.example(row, example), errors));
            }
        }
        once(errors);
        // What was called after an example was read is left out there.
        for example in &mut examples {
            let rest = self.inputs.iter().skip(example.inputs.len());
            example.inputs.extend(rest.map(|input| input.default));
        }
        let unused_fetches = self.unused_fetches();
        let fetched = self.fetched();
        let choices = self.choices();
        let wanted = std::mem::take(&mut self.wanted);
        let Some(default) = default else { return (None, wanted) };
        let written = written::written(table, &self.pool);
        let program = Program {
            source: table.source.clone(),
            imported: self.imported(),
            name: table.name.value.clone(),
            title: table.title.clone(),
            origin: table.origin.clone(),
            hit_policy: table.hit_policy.value,
            hit_policy_span: table.hit_policy.span,
            output: self.resolved(&self.output),
            inputs: self.inputs,
            fetched,
            states,
            pool: self.pool,
            rows,
            default,
            default_span: table.default.span,
            assumptions,
            draw,
            symmetries,
            examples,
            function: None,
            continuity,
            claims: claims::claims(table, self.programs, errors),
            allow: table.allow.clone(),
            exhibit: table.exhibit.clone(),
            written: Written { choices, unused_fetches, ..written },
            decided: Vec::new(),
        };
        (Some(program), wanted)
    }
}

/// The same mistake in a shared name or function is found once per use.
fn once(errors: &mut Vec<Diagnostic>) {
    let mut seen = HashSet::new();
    errors.retain(|e| seen.insert((e.code, e.labels.first().map(|l| (l.span, l.message.clone())))));
}

fn keep<T>(result: Result<T>, errors: &mut Vec<Diagnostic>) -> Option<T> {
    result.map_err(|error| errors.push(error)).ok()
}
