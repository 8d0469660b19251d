//! From table files to generated files: what `umbrage build` does, and what a
//! build script calls.
//!
//! Everything is made in memory first. Files are written only when every table
//! of the run was checked, proved, emitted and validated, and all of them appear
//! together, so that a failure leaves nothing behind.

mod absent;
mod batch;
mod evidence;
mod stamp;
mod tables;

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use crate::certificate::Certificate;
use crate::diag::{Diagnostic, Failure, codes};
use crate::emit::{self, SiblingFile, Target};
use crate::plan::{Plan, PlanOptions, Shape, Weights};
use crate::program::Program;
use crate::prove::{Proof, is_of_one_plan};
use crate::text::file::{Home, PendingFile, io_reason, read_bytes, shown, unwritable};
use crate::tuned::{Auto, Fallback, Tuned};

pub use batch::{Batch, Request, run};
pub use evidence::{Choices, NamedProfile, beside, misplaced, orphans, profile_of, tuned_in, weigh};
pub use tables::{Errors, Tables};

/// The files to make of each table.
#[derive(Debug, Clone)]
pub struct Options {
    /// The code shapes.
    pub shapes: Vec<Shape>,
    /// The languages.
    pub targets: Vec<Target>,
    /// True if the tuned plan is made, too, or else the default of [`Auto`].
    pub auto: bool,
    /// The choices for each device.
    pub tuned: Vec<Tuned>,
    /// True if plans may do anything where a table's assumptions do not hold.
    /// A tuned plan does as it was tuned.
    pub assume: bool,
    /// The frequency of each table's states, by its name.
    pub weights: BTreeMap<String, Weights>,
    /// True if a [`Certificate`] of each plan lies beside its files: `table/plan.smt2`, of a function
    /// `table/function.smt2`.
    pub certificates: bool,
}

impl Default for Options {
    /// The table as written, the published technique, what does best on most
    /// graphics processors, and what was tuned; in every language, each in one form.
    fn default() -> Self {
        Self {
            shapes: vec![Shape::Ladder, Shape::Ordered, Shape::Switch],
            targets: Target::defaults(),
            auto: true,
            tuned: Vec::new(),
            assume: false,
            weights: BTreeMap::new(),
            certificates: false,
        }
    }
}

/// A generated file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Artifact {
    /// Its place in the output directory: `table/plan.extension`.
    pub path: PathBuf,
    /// Its bytes.
    pub contents: Vec<u8>,
}

/// Everything made of one table.
#[derive(Debug, Clone)]
pub struct Built {
    /// Name of the table.
    pub table: String,
    /// The plans.
    pub plans: Vec<BuiltPlan>,
    /// The plans that do not suit the table, by name, with the reason.
    pub skipped: Vec<(String, Failure)>,
    /// The files.
    pub files: Vec<Artifact>,
}

/// A plan that was proved and emitted.
#[derive(Debug, Clone)]
pub struct BuiltPlan {
    /// The name of its files.
    pub name: String,
    /// The findings of the proof.
    pub proof: Proof,
    /// The devices on which it was chosen.
    pub chosen_on: Vec<String>,
    /// The operations that linear arithmetic does not reach in its certificate, in words; `None` without certificates.
    pub beyond: Option<Vec<String>>,
    /// Set if `auto` is this plan since nothing that was tuned can be used, with the reason.
    pub fallback: Option<String>,
}

/// A plan to make.
struct Wanted {
    shape: Shape,
    assume: bool,
    chosen_on: Vec<String>,
    fallback: Option<String>,
}

impl Wanted {
    fn name(&self) -> String {
        if self.assume { format!("{}_assuming", self.shape) } else { self.shape.to_string() }
    }
}

/// The plans to make of a table, each once.
fn wanted(program: &Program, options: &Options) -> Vec<Wanted> {
    let mut wanted = Vec::new();
    for shape in &options.shapes {
        want(&mut wanted, *shape, options.assume);
    }
    if options.auto {
        let tuned = options.tuned.iter().map(|tuned| (Auto::of(program, Some(tuned)), tuned.device.as_str()));
        let (chosen, not): (Vec<_>, Vec<_>) = tuned.partition(|(auto, _)| auto.fallback.is_none());
        for (auto, device) in &chosen {
            want(&mut wanted, auto.shape, auto.assume).chosen_on.push((*device).to_owned());
        }
        if chosen.is_empty() {
            let mut reasons: Vec<String> =
                not.iter().filter_map(|(auto, _)| auto.fallback.as_ref()).map(Fallback::to_string).collect();
            reasons.dedup();
            if reasons.is_empty() {
                reasons.push(Fallback::Untuned.to_string());
            }
            want(&mut wanted, Auto::of(program, None).shape, options.assume).fallback = Some(reasons.join("; "));
        }
    }
    wanted
}

/// The plan of a shape among those wanted, which it may be already.
fn want(wanted: &mut Vec<Wanted>, shape: Shape, assume: bool) -> &mut Wanted {
    let place = wanted.iter().position(|plan| plan.shape == shape && plan.assume == assume).unwrap_or(wanted.len());
    if place == wanted.len() {
        wanted.push(Wanted { shape, assume, chosen_on: Vec::new(), fallback: None });
    }
    &mut wanted[place]
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
    let siblings = sibling_files(options, "functions", false);
    for target in &options.targets {
        let path = Path::new(&built.table).join(format!("functions.{}", target.extension()));
        built.files.push(Artifact { path, contents: emit::emit_all(&proved, *target, &siblings)? });
    }
    let mut beyond = options.certificates.then(Vec::new);
    for proved in &proved {
        let name = proved.plan().program.function.as_ref().map_or("", |function| function.name.as_str());
        let own = certificate(&mut built, proved.plan(), name, options);
        if let (Some(all), Some(own)) = (&mut beyond, own) {
            all.extend(own);
        }
    }
    if let Some(all) = &mut beyond {
        all.sort_unstable();
        all.dedup();
    }
    let proof = proved.iter().map(|proved| proved.proof().clone()).reduce(Proof::and);
    let plan =
        |proof| BuiltPlan { name: Shape::Ladder.to_string(), proof, chosen_on: Vec::new(), fallback: None, beyond };
    built.plans.extend(proof.map(plan));
    Ok(built)
}

/// Adds the certificate of a plan, if such files are asked for, and returns what linear arithmetic does not reach in it.
fn certificate(built: &mut Built, plan: &Plan<'_>, name: &str, options: &Options) -> Option<Vec<String>> {
    let certificate = options.certificates.then(|| Certificate::new(plan))?;
    let path = Path::new(&built.table).join(format!("{name}.smt2"));
    built.files.push(Artifact { path, contents: certificate.text.into_bytes() });
    Some(certificate.beyond)
}

/// The files of a plan, which lie in one directory.
fn sibling_files(options: &Options, name: &str, lookup: bool) -> Vec<SiblingFile> {
    let file = |extension: &str| format!("{name}.{extension}");
    let targets = options.targets.iter().map(|target| (Some(*target), file(target.extension())));
    let lookup = lookup.then(|| (None, file("lookup.bin")));
    targets.chain(lookup).map(|(target, file)| SiblingFile { target, file }).collect()
}

/// Proves, emits and validates one checked table.
///
/// # Errors
/// When a plan cannot be proved or its output is not valid, or when no plan suits the table.
pub fn table(program: &Program, options: &Options) -> Result<Built, Failure> {
    let mut built = Built { table: program.name.clone(), plans: Vec::new(), skipped: Vec::new(), files: Vec::new() };
    for wanted in wanted(program, options) {
        let (shape, name) = (wanted.shape, wanted.name());
        // The table as written is the same whatever occurs.
        let weights = options.weights.get(&program.name).filter(|_| shape != Shape::Ladder);
        let plan = Plan::new(program, PlanOptions { shape, weights, assume: wanted.assume });
        let proved = plan.and_then(|mut plan| {
            plan.notes.extend(wanted.chosen_on.iter().map(|device| format!("chosen by `umbrage tune` on {device}")));
            plan.prove()
        });
        let proved = match proved {
            Ok(proved) => proved,
            Err(reason) if is_of_one_plan(&reason) => {
                built.skipped.push((name, reason));
                continue;
            }
            Err(failure) => return Err(failure),
        };
        let path = |extension: &str| Path::new(&program.name).join(format!("{name}.{extension}"));
        let siblings = sibling_files(options, &name, shape.reads_buffer());
        for target in &options.targets {
            match emit::emit_all(std::slice::from_ref(&proved), *target, &siblings) {
                Ok(contents) => built.files.push(Artifact { path: path(target.extension()), contents }),
                // What suits no such plan is had of the others.
                Err(reason) if is_of_one_plan(&reason) => {
                    built.skipped.push((format!("{name} as {}", target.name()), reason));
                }
                Err(failure) => return Err(failure),
            }
        }
        if let Some(words) = emit::lookup_words(proved.plan()) {
            let contents = words.iter().flat_map(|word| word.to_le_bytes()).collect();
            built.files.push(Artifact { path: path("lookup.bin"), contents });
        }
        let beyond = certificate(&mut built, proved.plan(), &name, options);
        let Wanted { chosen_on, fallback, .. } = wanted;
        built.plans.push(BuiltPlan { name, proof: proved.proof().clone(), chosen_on, fallback, beyond });
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

/// Writes files below a directory, all or none, and leaves alone those that already say the same. Returns how many
/// were written.
///
/// # Errors
/// When a directory or file cannot be written; the message names it.
pub fn write(directory: &Path, files: &[Artifact]) -> Result<usize, Failure> {
    if files.is_empty() {
        // No directory for nothing.
        return Ok(0);
    }
    let home = Home::lock(directory)?;
    let mut pending = Vec::new();
    for file in files {
        let path = directory.join(&file.path);
        let most = file.contents.len() as u64;
        if read_bytes(&path, most).is_ok_and(|old| old == file.contents) {
            continue;
        }
        let parent = path.parent().unwrap_or(directory);
        std::fs::create_dir_all(parent).map_err(|error| unwritable(parent, &error))?;
        pending.push(PendingFile::whole(&path, file.contents.clone())?);
    }
    let count = pending.len();
    home.commit(pending)?;
    Ok(count)
}
