//! From table files to generated files: what `umbrage build` does, and what a
//! build script calls.
//!
//! Everything is made in memory first. Files are written only when every table
//! of the run was checked, proved, emitted and validated, each through a
//! temporary file beside its place, so that a failure leaves nothing behind.

use std::collections::BTreeMap;
use std::io::Write as _;
use std::path::{Path, PathBuf};

use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::{self, Target};
use crate::plan::{LookupPlace, Plan, PlanOptions, Proof, Shape, Weights, is_unsuitable};
use crate::program::Program;
use crate::table::io_reason;

/// What to make of each table.
#[derive(Debug, Clone)]
pub struct Options {
    /// The code shapes.
    pub shapes: Vec<Shape>,
    /// The languages.
    pub targets: Vec<Target>,
    /// Whether plans may do anything where a table's assumptions do not hold.
    pub assume: bool,
    /// How often the states of each table occur, by its name.
    pub weights: BTreeMap<String, Weights>,
}

impl Default for Options {
    /// The plans whose code stands alone, in every language.
    fn default() -> Self {
        Self {
            shapes: vec![Shape::Ladder, Shape::Switch(LookupPlace::Constants)],
            targets: Target::ALL.to_vec(),
            assume: false,
            weights: BTreeMap::new(),
        }
    }
}

/// A generated file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Artifact {
    /// Where it goes, relative to the output directory: `table/plan.extension`.
    pub path: PathBuf,
    /// What it contains.
    pub contents: Vec<u8>,
}

/// Everything made of one table.
#[derive(Debug, Clone)]
pub struct Built {
    /// Name of the table.
    pub table: String,
    /// The plans, with their proofs.
    pub plans: Vec<(Shape, Proof)>,
    /// The plans that do not suit the table, with the reason.
    pub skipped: Vec<(Shape, Failure)>,
    /// The files.
    pub files: Vec<Artifact>,
}

/// Proves, emits and validates what [`Program::read_all`] reads from a table
/// file: a table of cases, or the functions of a table, which share their files.
///
/// # Errors
/// As [`table`].
pub fn programs(programs: &[Program], options: &Options) -> Result<Built, Failure> {
    match programs {
        [program] if program.function.is_none() => table(program, options),
        functions => library(functions, options),
    }
}

/// The functions of a table. They have no states to choose by, so there is one plan.
fn library(functions: &[Program], options: &Options) -> Result<Built, Failure> {
    let proved = functions.iter().map(|f| Plan::proved(f, Shape::Ladder)).collect::<Result<Vec<_>, _>>()?;
    let table = functions.first().map_or(String::new(), |function| function.table().to_owned());
    let mut built = Built { table, plans: Vec::new(), skipped: Vec::new(), files: Vec::new() };
    for target in &options.targets {
        let path = Path::new(&built.table).join(format!("functions.{}", target.extension()));
        built.files.push(Artifact { path, contents: emit::emit_all(&proved, *target)? });
    }
    built.plans.extend(proved.iter().map(|p| p.proof().clone()).reduce(Proof::and).map(|proof| (Shape::Ladder, proof)));
    Ok(built)
}

/// Proves, emits and validates one checked table.
///
/// # Errors
/// When a plan cannot be proved or its output is not valid, or when no plan suits the table.
pub fn table(program: &Program, options: &Options) -> Result<Built, Failure> {
    let mut built = Built { table: program.name.clone(), plans: Vec::new(), skipped: Vec::new(), files: Vec::new() };
    for shape in &options.shapes {
        let plan = PlanOptions { shape: *shape, weights: options.weights.get(&program.name), assume: options.assume };
        let proved = match Plan::proved(program, plan) {
            Ok(proved) => proved,
            Err(reason) if is_unsuitable(&reason) => {
                built.skipped.push((*shape, reason));
                continue;
            }
            Err(failure) => return Err(failure),
        };
        built.plans.push((*shape, proved.proof().clone()));
        let stem = if options.assume { format!("{shape}_assuming") } else { shape.to_string() };
        let path = |extension: &str| Path::new(&program.name).join(format!("{stem}.{extension}"));
        for target in &options.targets {
            built.files.push(Artifact { path: path(target.extension()), contents: emit::emit(&proved, *target)? });
        }
        if shape.reads_buffer() {
            let words = emit::lookup_words(proved.plan());
            let contents = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            built.files.push(Artifact { path: path("lookup.bin"), contents });
        }
    }
    match built.skipped.first() {
        Some((_, reason)) if built.plans.is_empty() => Err(reason.clone()),
        _ => Ok(built),
    }
}

/// The table files at a path: the file itself, or every `.ron` file of a
/// directory and of the directories in it, sorted.
///
/// # Errors
/// When a directory cannot be read or holds no table.
pub fn find_tables(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !path.is_dir() {
        return Ok(vec![path.to_owned()]);
    }
    let mut found = Vec::new();
    let mut pending = vec![path.to_owned()];
    while let Some(directory) = pending.pop() {
        let unreadable = |error: std::io::Error| {
            let message = format!("cannot be read: {}", io_reason(&error));
            let diagnostic = Diagnostic::error(codes::UNREADABLE, message).help("check its permissions");
            Failure::bare(shown(&directory), diagnostic)
        };
        for entry in std::fs::read_dir(&directory).map_err(unreadable)? {
            let entry = entry.map_err(unreadable)?;
            // Links to directories are not followed: they may form a circle.
            if entry.file_type().map_err(unreadable)?.is_dir() {
                pending.push(entry.path());
            } else if entry.path().extension().is_some_and(|extension| extension == "ron") {
                found.push(entry.path());
            }
        }
    }
    if found.is_empty() {
        let diagnostic =
            Diagnostic::error(codes::UNREADABLE, "contains no tables").help("tables are files named *.ron");
        return Err(Failure::bare(shown(path), diagnostic));
    }
    found.sort();
    Ok(found)
}

/// A path as it is shown in messages.
fn shown(path: &Path) -> String {
    path.to_string_lossy().replace('\\', "/")
}

/// Writes files below a directory, all or none as far as the file system
/// allows, and leaves alone those that already say the same. Returns how many
/// were written.
///
/// # Errors
/// When a directory or file cannot be written; the message names it.
pub fn write(directory: &Path, files: &[Artifact]) -> Result<usize, Failure> {
    let fail = |path: &Path, error: &std::io::Error| {
        let message = format!("cannot be written: {}", io_reason(error));
        let help = "choose another place, or mend its permissions";
        Failure::bare(shown(path), Diagnostic::error(codes::UNWRITABLE, message).help(help))
    };
    let mut pending = Vec::new();
    for file in files {
        let path = directory.join(&file.path);
        if std::fs::read(&path).is_ok_and(|old| old == file.contents) {
            continue;
        }
        let parent = path.parent().unwrap_or(directory);
        std::fs::create_dir_all(parent).map_err(|e| fail(parent, &e))?;
        let mut temporary = tempfile::NamedTempFile::new_in(parent).map_err(|e| fail(parent, &e))?;
        temporary.write_all(&file.contents).map_err(|e| fail(&path, &e))?;
        if path.is_dir() {
            return Err(fail(&path, &std::io::Error::from(std::io::ErrorKind::IsADirectory)));
        }
        pending.push((temporary, path));
    }
    let count = pending.len();
    for (temporary, path) in pending {
        set_readable(&temporary);
        temporary.persist(&path).map_err(|e| fail(&path, &e.error))?;
    }
    Ok(count)
}

/// Temporary files are private; what they become is not.
#[cfg(unix)]
fn set_readable(file: &tempfile::NamedTempFile) {
    use std::os::unix::fs::PermissionsExt;
    // If it fails the file stays private, which is no reason not to write it.
    let _ = file.as_file().set_permissions(std::fs::Permissions::from_mode(0o644));
}

#[cfg(not(unix))]
fn set_readable(_: &tempfile::NamedTempFile) {}
