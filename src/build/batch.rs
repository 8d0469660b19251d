//! One run over many tables: what `umbrage build` and a build script both do.
//!
//! All mistakes of all tables are collected, not only the first, and so are the
//! files that were read, whether or not the run succeeds: whoever watches files
//! has to know both. Nothing is printed and nothing is written here.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::{
    Artifact, Built, Choices, NamedProfile, Options, beside, find_tables, misplaced, orphans, profile_of, programs,
    weigh,
};
use crate::analyse::{self, LintLevels};
use crate::diag::{Diagnostic, Failure, Severity, codes};
use crate::profile;
use crate::program::Program;
use crate::prove::is_unsuitable;
use crate::skeleton;
use crate::table::Table;
use crate::text::file::shown;

/// The order for a run.
#[derive(Debug, Clone, Default)]
pub struct Request {
    /// Tables, or directories of tables.
    pub paths: Vec<PathBuf>,
    /// The files to make of each table. Choices of the tuner are read from files, not taken from here.
    pub options: Options,
    /// Profiles to plan for, each for the table that it counts. A table that none of them counts is planned for
    /// `profiles/TABLE.ron` beside the directory of the tables, if there is one.
    pub profiles: Vec<PathBuf>,
    /// Directory of what was tuned; without, `tuned` beside the directory of the tables, if there is one.
    pub tuned: Option<PathBuf>,
    /// Of what was tuned, only what was chosen on this device.
    pub device: Option<String>,
    /// The levels of findings.
    pub levels: LintLevels,
    /// Names of [skeletons](crate::skeleton) to write beside the tables.
    pub skeletons: Vec<String>,
    /// Inputs that are decided, as `input=level`: each table is made without them, with a name of its own.
    pub fix: Vec<String>,
}

/// The result of a run.
#[derive(Debug, Clone, Default)]
pub struct Batch {
    /// The tables that could be built, each with its programs.
    pub tables: Vec<(Vec<Program>, Built)>,
    /// Errors and warnings, in the order found.
    pub messages: Vec<Failure>,
    /// The files and directories that the run depends on, as far as they exist.
    pub inputs: BTreeSet<PathBuf>,
    /// The directories that it would have looked into if they were there.
    pub absent: BTreeSet<PathBuf>,
    /// The skeletons that were asked for.
    pub skeletons: Vec<Artifact>,
}

impl Batch {
    /// Returns whether there are errors. Nothing should be written then.
    pub fn failed(&self) -> bool {
        self.has(Severity::Error)
    }

    /// Returns whether there are warnings.
    pub fn warned(&self) -> bool {
        self.has(Severity::Warning)
    }

    /// The files of all tables, and the skeletons.
    pub fn files(&self) -> Vec<Artifact> {
        let built = self.tables.iter().flat_map(|(_, built)| &built.files);
        built.chain(&self.skeletons).cloned().collect()
    }

    fn has(&self, severity: Severity) -> bool {
        self.messages.iter().flat_map(|failure| &failure.diagnostics).any(|found| found.severity == severity)
    }

    fn reads(&mut self, path: &Path) {
        if path.exists() {
            self.inputs.insert(path.to_owned());
        }
    }

    /// Notes a directory that is read if it exists.
    fn looks_into(&mut self, directory: Option<&Path>) {
        let Some(directory) = directory else { return };
        let set = if directory.exists() { &mut self.inputs } else { &mut self.absent };
        set.insert(directory.to_owned());
    }

    /// Notes what went wrong, and the file that it is about.
    fn fails(&mut self, failure: Failure) {
        self.reads(Path::new(&failure.source.name));
        self.messages.push(failure);
    }

    fn keep<T>(&mut self, result: Result<T, Failure>) -> Option<T> {
        result.map_err(|failure| self.fails(failure)).ok()
    }
}

/// Stack for the work. Expressions are nested as deep as the parser allows, and
/// a build script is compiled without optimisation, with frames several times as large.
const STACK: usize = 256 << 20;

/// Reads, checks, proves, emits and validates the tables of a request.
///
/// ```
/// use umbrage::build::{self, Request};
///
/// let batch = build::run(&Request { paths: vec!["tables/smsr.ron".into()], ..Request::default() });
/// assert!(!batch.failed());
/// assert!(batch.files().iter().any(|file| file.path.ends_with("smsr/ladder.wgsl")));
/// assert!(batch.inputs.iter().any(|path| path.ends_with("tables/smsr.ron")));
/// ```
pub fn run(request: &Request) -> Batch {
    std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, || collect(request));
        match thread.map(std::thread::ScopedJoinHandle::join) {
            Ok(Ok(batch)) => batch,
            Ok(Err(panic)) => std::panic::resume_unwind(panic),
            // Where no such thread can be had, the stack at hand may still do.
            Err(_) => collect(request),
        }
    })
}

/// Warnings of the plans that were left out as not equal to the table. The others are none the worse.
fn refused(built: &Built) -> impl Iterator<Item = Failure> {
    let refused = built.skipped.iter().filter(|(_, reason)| !is_unsuitable(reason));
    refused.map(|(_, reason)| {
        let mut warning = reason.clone();
        warning.diagnostics.iter_mut().for_each(|found| found.severity = Severity::Warning);
        warning
    })
}

/// The file of a skeleton.
fn skeleton_of(name: &str) -> Result<Artifact, Failure> {
    let text = skeleton::wgsl(name).ok_or_else(|| {
        let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("there is no skeleton `{name}`"));
        Failure::bare("", error.help(format!("the skeletons are: {}", skeleton::NAMES.join(", "))))
    })?;
    Ok(Artifact { path: PathBuf::from("skeletons").join(name).with_extension("wgsl"), contents: text.into_bytes() })
}

fn collect(request: &Request) -> Batch {
    let mut batch = Batch::default();
    for name in &request.skeletons {
        let file = batch.keep(skeleton_of(name));
        batch.skeletons.extend(file);
    }
    let mut given: Vec<NamedProfile> = Vec::new();
    for path in &request.profiles {
        batch.reads(path);
        let read = batch.keep(profile::read(path));
        given.extend(read.map(|profile| (path.clone(), profile)));
    }
    for path in &request.paths {
        let mut options = request.options.clone();
        batch.reads(path);
        let profiles = beside(path, "profiles");
        batch.looks_into(profiles.as_deref());
        let mut evidence = Evidence { given: &given, directory: profiles, choices: None };
        if options.auto {
            let directory = request.tuned.clone().or_else(|| beside(path, "tuned"));
            batch.looks_into(directory.as_deref());
            let directory = directory.unwrap_or_else(|| PathBuf::from("tuned"));
            evidence.choices = batch.keep(Choices::read(&directory, request.device.as_deref()));
            options.tuned = evidence.choices.iter().flat_map(Choices::followed).cloned().collect();
        }
        let mut names = BTreeSet::new();
        for file in batch.keep(find_tables(path)).unwrap_or_default() {
            batch.reads(&file);
            let Some(table) = batch.keep(Table::read(&file)) else { continue };
            names.insert(table.name.value.clone());
            // An exhibit is built only if it was named.
            if path.is_dir() && table.exhibit.is_some() {
                continue;
            }
            read_imports(&table, &mut batch);
            // What a table declares for others is built with those.
            if table.declares_only {
                batch.keep(Program::check_all(&table));
                continue;
            }
            let built = one(&table, &evidence, &mut options, request, &mut batch);
            let built = batch.keep(built);
            batch.messages.extend(built.iter().flat_map(|(_, built)| refused(built)));
            batch.tables.extend(built);
        }
        // The table of a profile may be one that could not be read, or one that was not asked for.
        if let Some(directory) = evidence.directory.filter(|_| path.is_dir() && !batch.failed()) {
            let orphans = batch.keep(orphans(&directory, &names)).unwrap_or_default();
            batch.messages.extend(orphans.into_iter().map(|warning| Failure::bare("", warning)));
        }
    }
    // A table that could not be read may be the one that a profile is about.
    for (path, profile) in given.iter().filter(|_| !batch.failed()) {
        if !batch.tables.iter().any(|(_, built)| built.table == profile.table) {
            let message = format!("is a profile of the table `{}`, which is not among those built", profile.table);
            let error = Diagnostic::error(codes::OTHER_PROFILE, message).help("name its table, too, or leave it out");
            batch.messages.push(Failure::bare(shown(path), error));
            break;
        }
    }
    batch
}

/// The places of the profiles of tables, and the choices for them.
struct Evidence<'a> {
    given: &'a [NamedProfile],
    directory: Option<PathBuf>,
    choices: Option<Choices>,
}

impl Evidence<'_> {
    /// The profiles of a table: those given, or else the one that lies beside it.
    fn of(&self, table: &str) -> Result<Vec<NamedProfile>, Failure> {
        let given: Vec<_> = self.given.iter().filter(|(_, profile)| profile.table == table).cloned().collect();
        match &self.directory {
            Some(directory) if given.is_empty() => Ok(profile_of(table, directory)?.into_iter().collect()),
            _ => Ok(given),
        }
    }
}

fn one(
    table: &Table,
    evidence: &Evidence<'_>,
    options: &mut Options,
    request: &Request,
    batch: &mut Batch,
) -> Result<(Vec<Program>, Built), Failure> {
    let source = table.source.clone();
    let checked = Program::check_all(table)?;
    let checked = match request.fix.as_slice() {
        [] => checked,
        decided => checked.iter().map(|program| program.fix(decided)).collect::<Result<_, _>>()?,
    };
    let name = checked.first().map_or(table.name.value.as_str(), Program::table);
    // Not every file system tells capitals apart.
    if let Some((other, built)) = batch.tables.iter().find(|(_, built)| built.table.eq_ignore_ascii_case(name)) {
        let other = other.first().map_or("", |program| program.source.name.as_str());
        let (message, help) = match built.table == name {
            true => (
                format!("`{other}` and this file both define the table `{name}`"),
                "their output would go to the same folder; rename one",
            ),
            false => (
                format!(
                    "the tables `{}` of `{other}` and `{name}` of this file differ in their capitals only",
                    built.table
                ),
                "on some systems their output would go to the same folder; rename one",
            ),
        };
        return Err(Failure::new(source, Diagnostic::error(codes::DUPLICATE, message).help(help)));
    }
    // Notes are for `check`: here they would hide what was built.
    let findings: Vec<Diagnostic> =
        checked.iter().flat_map(|program| analyse::problems(program, &request.levels)).collect();
    let failed = findings.iter().any(|finding| finding.severity == Severity::Error);
    let findings = Failure { source, diagnostics: findings };
    if failed {
        return Err(findings);
    }
    if !findings.diagnostics.is_empty() {
        batch.messages.push(findings);
    }
    for program in checked.iter().filter(|program| program.function.is_none()) {
        let profiles = evidence.of(&program.name)?;
        for (path, _) in &profiles {
            batch.reads(path);
        }
        let misplaced = profiles.iter().filter_map(|profile| misplaced(&program.name, profile));
        let unused = evidence.choices.iter().flat_map(|choices| choices.unused(program));
        let warnings: Vec<Diagnostic> = misplaced.chain(unused).chain(weigh(program, &profiles, options)?).collect();
        batch.messages.extend(warnings.into_iter().map(|warning| Failure::bare("", warning)));
    }
    let built = programs(&checked, options)?;
    Ok((checked, built))
}

/// Notes what a table imports, which may lie elsewhere.
fn read_imports(table: &Table, batch: &mut Batch) {
    for file in table.data_files() {
        batch.reads(Path::new(&file.source.name));
    }
    for imported in table.imports.iter().filter_map(|import| import.table.as_deref()) {
        batch.reads(Path::new(&imported.source.name));
        read_imports(imported, batch);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A plan that were not equal to its table is said as a warning: the others are built.
    #[test]
    fn refused_plans_are_warnings() {
        let failure = |code| Failure::bare("t.ron", Diagnostic::error(code, "the plan `tree`"));
        let skipped = vec![
            ("tree".to_owned(), failure(codes::NOT_PROVED)),
            ("orbit".to_owned(), failure(codes::NOT_APPLICABLE)),
            ("nested".to_owned(), failure(codes::PROOF_TOO_LONG)),
        ];
        let built = Built { table: "t".to_owned(), plans: Vec::new(), skipped, files: Vec::new() };
        let batch = Batch { messages: refused(&built).collect(), ..Batch::default() };
        assert!(batch.messages.len() == 1 && batch.warned() && !batch.failed());
    }
}
