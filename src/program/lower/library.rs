//! A table of functions → programs, one for each function.
//!
//! The program of a function has the table's name and its own. Its
//! inputs are the parameters, its rows its cases; a function without cases has
//! a single row, number 0, that is always taken.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use super::tables::Programs;
use super::terms::Expected;
use super::wide::{AllCuts, refined};
use super::{Lowering, Result, built_in, claims, functions::Callee, keep, once, written};
use crate::diag::{Diagnostic, Failure, Spanned, codes};
use crate::program::domain::StateSpace;
use crate::program::{Accuracy, Assumption, Function, Limit, Line, Program, Row};
use crate::table::{self, FunctionBody, HitPolicy, Table, names};
use crate::text::closest::nearest;

/// Checks a table of functions.
pub(in crate::program) fn functions(table: &Table) -> std::result::Result<Vec<Program>, Failure> {
    let mut imported = Imported::default();
    check_imports(table, &mut imported)?;
    own_functions(table, &imported)
}

/// The imported tables that were checked.
#[derive(Default)]
pub(super) struct Imported {
    checked: HashSet<*const Table>,
    /// The programs of those that have cases.
    pub(super) programs: Programs,
}

/// Checks a table of functions whose imports are checked.
fn own_functions(table: &Table, imported: &Imported) -> std::result::Result<Vec<Program>, Failure> {
    let fail = |diagnostics| Failure { source: table.source.clone(), diagnostics };
    let mut errors = Vec::new();
    // Declarations are judged once, with all inputs; without sound ones nothing else could be.
    let mut all = Lowering::new(table, imported.programs.clone(), &AllCuts::new());
    let inputs: Vec<&table::Input> = table.inputs.iter().collect();
    all.declare(&inputs, &mut errors);
    all.declare_functions(&mut errors);
    if !errors.is_empty() {
        return Err(fail(errors));
    }
    let mut programs = Vec::new();
    for function in &table.functions {
        let (program, found) = refined(|cuts| {
            let (mut found, mut wanted) = (Vec::new(), AllCuts::new());
            let program = one(table, function, imported, cuts, &mut wanted, &mut found);
            ((program, found), wanted)
        });
        programs.extend(program);
        errors.extend(found);
    }
    // A mistake in a name or helper that nothing uses is a mistake too.
    errors.extend(refined(|cuts| {
        let mut found = Vec::new();
        let mut all = Lowering::new(table, imported.programs.clone(), cuts);
        all.declare(&inputs, &mut found);
        for named in &table.names {
            let _ = keep(all.term_of_name(&named.name.value), &mut found);
            if found.last().is_some_and(|e| e.code == codes::TOO_DEEP) {
                break;
            }
        }
        (found, all.wanted)
    }));
    let claims = claims::claims(table, imported.programs.clone(), &mut errors);
    if let Some(first) = programs.first_mut() {
        first.claims = claims;
    }
    once(&mut errors);
    if errors.is_empty() { Ok(programs) } else { Err(fail(errors)) }
}

/// Checks the tables that a table imports, each once, by however many ways it is imported.
/// What is wrong with one is said of it.
pub(super) fn check_imports(table: &Table, imported: &mut Imported) -> std::result::Result<(), Failure> {
    for import in &table.imports {
        let Some(other) = &import.table else { continue };
        if other.functions.is_empty() {
            table
                .since(2, import.path.span, "importing a table without functions")
                .map_err(|error| Failure::new(table.source.clone(), error))?;
        }
        if !imported.checked.insert(Arc::as_ptr(other)) {
            continue;
        }
        if !other.functions.is_empty() {
            check_imports(other, imported)?;
            own_functions(other, imported)?;
        } else if other.declares_only {
            declarations(other)?;
        } else {
            let program = super::program_with(other, imported)?;
            imported.programs.insert(Arc::as_ptr(other), Arc::new(program));
        }
    }
    Ok(())
}

/// Checks a table of nothing but level sets and constants.
pub(in crate::program) fn declarations(table: &Table) -> std::result::Result<(), Failure> {
    let mut imported = Imported::default();
    check_imports(table, &mut imported)?;
    let mut errors = Vec::new();
    let mut lowering = Lowering::new(table, imported.programs, &AllCuts::new());
    lowering.declare(&[], &mut errors);
    if let Some(claim) = table.claims.first() {
        let error = Diagnostic::error(codes::FUNCTION_SHAPE, "claims stand in a table with cases or functions");
        let error = error.at(claim.name.span, "this table has neither");
        errors.push(error.help("move them into a table that imports this one"));
    }
    for (index, constant) in table.constants.iter().enumerate() {
        keep(lowering.check_constant(index, &constant.name), &mut errors);
    }
    once(&mut errors);
    match errors.is_empty() {
        true => Ok(()),
        false => Err(Failure { source: table.source.clone(), diagnostics: errors }),
    }
}

/// The refusal when a table has no function of that name.
pub(in crate::program) fn no_function(table: &Table, name: Option<&str>) -> Failure {
    let known: Vec<&str> = table.functions.iter().map(|function| function.name.value.as_str()).collect();
    let listed = format!("the functions are: {}", known.join(", "));
    let error = match (name, known.is_empty()) {
        (_, true) if table.declares_only => {
            Diagnostic::error(codes::NO_FUNCTION, format!("`{}` has neither cases nor functions", table.name.value))
                .help("it declares level sets and constants for tables that import it")
        }
        (None, _) => Diagnostic::error(codes::NO_FUNCTION, format!("`{}` is a table of functions", table.name.value))
            .help("name one of them, as in `--function ...`")
            .help(listed),
        (Some(name), true) => {
            Diagnostic::error(codes::NO_FUNCTION, format!("`{}` has no function `{name}`", table.name.value))
                .help("it is a table of cases, which is used without naming a function")
        }
        (Some(name), false) => {
            let error =
                Diagnostic::error(codes::NO_FUNCTION, format!("`{}` has no function `{name}`", table.name.value));
            match nearest(name, known.iter().copied()) {
                Some(close) => error.did_you_mean(name, close),
                None => error,
            }
            .help(listed)
        }
    };
    Failure::new(table.source.clone(), error.at(table.name.span, "this table"))
}

/// Checks one function.
fn one(
    table: &Table,
    function: &table::Function,
    imported: &Imported,
    cuts: &AllCuts,
    wanted: &mut AllCuts,
    errors: &mut Vec<Diagnostic>,
) -> Option<Program> {
    let mut lowering = Lowering::new(table, imported.programs.clone(), cuts);
    let mut inputs: Vec<&table::Input> = Vec::new();
    for name in &function.parameters {
        match table.inputs.iter().find(|input| input.name.value == name.value) {
            Some(input) if inputs.iter().any(|other| other.name.value == name.value) => {
                let message = format!("`{}` is a parameter twice", name.value);
                errors.push(
                    Diagnostic::error(codes::DUPLICATE, message)
                        .at(name.span, "again")
                        .at(input.name.span, "declared here"),
                );
                return None;
            }
            Some(input) if input.fetched.is_some() => {
                let message = format!("the parameter `{}` is fetched", name.value);
                errors.push(
                    Diagnostic::error(codes::PARAMETER, message).at(name.span, "functions are given what they need"),
                );
                return None;
            }
            Some(input) => inputs.push(input),
            None => {
                let known = || table.inputs.iter().map(|input| input.name.value.as_str());
                let error =
                    Diagnostic::error(codes::PARAMETER, format!("the parameter `{}` is not declared", name.value))
                        .at(name.span, "not under `inputs`");
                errors.push(match nearest(&name.value, known()) {
                    Some(close) => error.did_you_mean(&name.value, close),
                    None => error.help("declare it: inputs: {\"x\": Range(from: 0, to: 1)}"),
                });
                return None;
            }
        }
    }
    lowering.of_function = true;
    lowering.declare(&inputs, errors);
    // An exhibit states its accuracy for those who mend it; its sines are what they are.
    lowering.portable = function.accuracy.is_some() && table.exhibit.is_none();
    let states = keep(StateSpace::new(&lowering.inputs).map_err(|product| lowering.too_many_states(product)), errors)?;
    keep(lowering.function(function, states, wanted), errors)
}

impl<'t> Lowering<'t> {
    fn function(mut self, function: &'t table::Function, states: StateSpace, wanted: &mut AllCuts) -> Result<Program> {
        let program = self.function_program(function, states);
        *wanted = std::mem::take(&mut self.wanted);
        program
    }

    fn function_program(&mut self, function: &'t table::Function, states: StateSpace) -> Result<Program> {
        // Open as a call is, so that a function that leads back to itself is found here.
        let env = self.bind(function, &super::Env::default())?;
        let always = self.pool.always(true);
        let (mut rows, mut examples) = (Vec::new(), Vec::new());
        let default = match &function.body {
            FunctionBody::Value(value) => {
                let term = self.term(value, &env, Expected::Anything)?;
                self.infer_output(&term, value.span)?;
                let values = self.result(term, value.span)?;
                rows.push(Row {
                    id: 0,
                    span: value.span,
                    guard: always,
                    guard_span: function.name.span,
                    under: Vec::new(),
                    lines: vec![Line {
                        condition: always,
                        condition_span: None,
                        values: values.clone(),
                        span: value.span,
                    }],
                    section: function.section.clone(),
                    doc: function.doc.clone(),
                    errata: function.errata.clone(),
                    allow: Vec::new(),
                });
                for example in &function.examples {
                    examples.push(self.example(0, example)?);
                }
                values
            }
            FunctionBody::Cases { cases, default } => {
                let term = self.term(default, &env, Expected::Anything)?;
                self.infer_output(&term, default.span)?;
                let mut seen = HashMap::new();
                for case in cases {
                    if let Some(first) = seen.insert(case.id.value, case.id.span) {
                        let message = format!("case {} is defined twice", case.id.value);
                        let error = Diagnostic::error(codes::DUPLICATE_CASE, message);
                        return Err(error.at(case.id.span, "defined again here").at(first, "first defined here"));
                    }
                    let expected = self.expected_output();
                    let (guard, lines) = self.function_case(case, &env, expected)?;
                    let lines = lines.into_iter().map(|line| {
                        let values = self.result(line.value, line.span)?;
                        Ok(Line {
                            condition: line.condition,
                            condition_span: line.condition_span,
                            values,
                            span: line.span,
                        })
                    });
                    let lines = lines.collect::<Result<Vec<_>>>()?;
                    rows.push(Row {
                        id: case.id.value,
                        span: case.span,
                        guard,
                        guard_span: case.span,
                        under: Vec::new(),
                        lines,
                        section: case.section.clone(),
                        doc: case.doc.clone(),
                        errata: case.errata.clone(),
                        allow: case.allow.clone(),
                    });
                }
                for (row, case) in cases.iter().enumerate() {
                    for example in &case.examples {
                        examples.push(self.example(row, example)?);
                    }
                }
                self.result(term, default.span)?
            }
        };
        let assumptions = function.domain.iter().map(|condition| {
            names::check_inner(&condition.name.value, "a condition of the domain", condition.name.span)?;
            Ok(Assumption {
                name: condition.name.value.clone(),
                condition: self.condition(&condition.condition, &env)?,
                doc: condition.doc.clone(),
                span: condition.condition.span,
            })
        });
        let assumptions = assumptions.collect::<Result<Vec<_>>>()?;
        let limits = function.limits.iter().map(|limit| self.limit(limit, &env)).collect::<Result<Vec<_>>>()?;
        let accuracy = match &function.accuracy {
            Some(claim) => Some(Accuracy {
                times: claim.times.value,
                scale: self.numeric(&claim.scale, &env)?,
                span: claim.times.span,
            }),
            None => None,
        };
        let table = self.table;
        let title = match function.doc.is_empty() {
            true => table.title.clone(),
            false => function.doc.clone(),
        };
        Ok(Program {
            source: table.source.clone(),
            imported: self.imported(),
            name: format!("{}_{}", table.name.value, function.name.value),
            title,
            origin: table.origin.clone(),
            hit_policy: HitPolicy::First,
            hit_policy_span: function.name.span,
            fetched: self.fetched(),
            output: self.resolved(&self.output),
            inputs: std::mem::take(&mut self.inputs),
            states,
            pool: std::mem::take(&mut self.pool),
            rows,
            default,
            default_span: match &function.body {
                FunctionBody::Value(value) => value.span,
                FunctionBody::Cases { default, .. } => default.span,
            },
            assumptions,
            draw: Vec::new(),
            symmetries: Vec::new(),
            examples,
            function: Some(Function {
                table: table.name.value.clone(),
                name: function.name.value.clone(),
                span: function.name.span,
                limits,
                accuracy,
            }),
            continuity: Vec::new(),
            claims: None,
            allow: table.allow.clone(),
            exhibit: table.exhibit.clone(),
            written: written::shared(table, &function.name.value),
            decided: Vec::new(),
        })
    }

    fn limit(&mut self, limit: &table::Limit, env: &super::Env) -> Result<Limit> {
        let mut at = Vec::new();
        for (name, value) in &limit.at {
            let Some(input) = self.input_named(&name.value) else {
                return Err(self.unknown_input(name, "not a parameter"));
            };
            let number =
                self.numeric(value, &super::Env { parameters: Some(std::rc::Rc::default()), ..super::Env::default() })?;
            match self.pool.constant(number) {
                Some(number) => at.push((input, number)),
                None => {
                    let error = Diagnostic::error(codes::NOT_CONSTANT, "a limit is taken at constants");
                    return Err(error.at(value.span, "depends on something"));
                }
            }
        }
        let term = self.term(&limit.value, env, Expected::Anything)?;
        Ok(Limit {
            span: limit.span,
            at,
            values: self.components(term, limit.value.span)?.into_iter().map(|part| part.value).collect(),
        })
    }

    /// Checks the names of functions, helpers and their parameters.
    pub(super) fn declare_functions(&mut self, errors: &mut Vec<Diagnostic>) {
        let table = self.table;
        let callees = table.helpers.iter().map(Callee::Helper).chain(table.functions.iter().map(Callee::Function));
        let mut seen: HashMap<String, &Spanned<String>> = HashMap::new();
        for callee in callees {
            let (name, what) = match callee {
                Callee::Helper(helper) => (&helper.name, "a helper"),
                Callee::Function(function) => (&function.name, "a function"),
            };
            let checked = names::check_inner(&name.value, what, name.span).and_then(|()| {
                if built_in::is_taken(&name.value, self.table.language.value) {
                    let message = format!("`{}` is a function of the language", name.value);
                    return Err(Diagnostic::error(codes::RESERVED_NAME, message).at(name.span, "choose another name"));
                }
                // Generated names are also written in capitals.
                match seen.insert(name.value.to_ascii_lowercase(), name) {
                    None => Ok(()),
                    Some(first) => {
                        let message = format!("two functions are called `{}`", name.value);
                        Err(Diagnostic::error(codes::DUPLICATE, message)
                            .at(name.span, "differs in capitals at most")
                            .at(first.span, "first here"))
                    }
                }
            });
            keep(checked, errors);
            if let Callee::Helper(helper) = callee {
                for (index, parameter) in helper.parameters.iter().enumerate() {
                    let twice = helper.parameters[..index].iter().find(|other| other.value == parameter.value);
                    let taken = table.constants.iter().map(|c| &c.name).find(|other| other.value == parameter.value);
                    let checked = names::check(&parameter.value, "a parameter", parameter.span).and_then(|()| {
                        match twice.or(taken) {
                            None => Ok(()),
                            Some(first) => {
                                let message = format!("the name `{}` is taken", parameter.value);
                                let error = Diagnostic::error(codes::DUPLICATE, message);
                                Err(error.at(parameter.span, "again").at(first.span, "first here"))
                            }
                        }
                    });
                    keep(checked, errors);
                }
            }
        }
    }
}
