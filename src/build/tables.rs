//! The interface for build scripts.
//!
//! ```no_run
//! // build.rs
//! fn main() -> Result<(), umbrage::build::Errors> {
//!     umbrage::build::Tables::new("tables").wgsl().glsl(450).rust().compile()?;
//!     Ok(())
//! }
//! ```
//!
//! Files go to `OUT_DIR`, one folder per table, and are included from there:
//! `include_str!(concat!(env!("OUT_DIR"), "/smsr/ordered.wgsl"))`.

use std::collections::BTreeSet;
use std::fmt;
use std::path::{Path, PathBuf};

use super::stamp::{Made, Stamp};
use super::{Batch, Options, Request, absent, run, write};
use crate::analyse::LintLevel;
use crate::diag::{Diagnostic, Failure, Severity, codes, visible};
use crate::emit::Target;
use crate::plan::Shape;
use crate::text::file::shown;
use crate::text::reach;

/// The variable that names a directory for copies that people can read.
const COPIES: &str = "UMBRAGE_OUT_DIR";

/// Tables to be compiled by a build script. Each method is an option of `umbrage build`.
#[derive(Debug, Clone)]
#[must_use = "nothing happens before `compile`"]
pub struct Tables {
    request: Request,
    output: Option<PathBuf>,
    problems: Vec<Failure>,
}

impl Tables {
    /// The table in a file, or all tables in a directory. Paths are relative to the directory of `Cargo.toml`.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        let options = Options { shapes: Vec::new(), targets: Vec::new(), auto: false, ..Options::default() };
        let request = Request { paths: vec![path.into()], options, ..Request::default() };
        Self { request, output: None, problems: Vec::new() }
    }

    /// Another table, or another directory of tables.
    pub fn also(mut self, path: impl Into<PathBuf>) -> Self {
        self.request.paths.push(path.into());
        self
    }

    /// Emits WGSL.
    pub fn wgsl(self) -> Self {
        self.target(Target::Wgsl)
    }

    /// Emits GLSL of a version: 450, 330, or 300 for ES 3.0. There are no others, as [`Self::compile`] will say.
    pub fn glsl(mut self, version: u32) -> Self {
        let target = match version {
            450 => Target::Glsl450,
            330 => Target::Glsl330,
            300 => Target::GlslEs300,
            _ => {
                let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("GLSL {version} is no target"));
                let error = error.help("the versions are: 450, 330, and 300 for ES 3.0");
                self.problems.push(Failure::bare("", error));
                return self;
            }
        };
        self.target(target)
    }

    /// Emits a module of WESL.
    pub fn wesl(self) -> Self {
        self.target(Target::Wesl)
    }

    /// Emits a module of naga_oil.
    pub fn naga_oil(self) -> Self {
        self.target(Target::NagaOil)
    }

    /// Emits a Rust module, which needs no other crate.
    pub fn rust(self) -> Self {
        self.target(Target::Rust)
    }

    /// Emits a language; without any, WGSL.
    pub fn target(mut self, target: Target) -> Self {
        self.request.options.targets.push(target);
        self
    }

    /// Also writes the WGSL around the tables of a technique to `skeletons/NAME.wgsl`. The names are those of
    /// [`skeleton::NAMES`](crate::skeleton::NAMES); there are no others, as [`Self::compile`] will say.
    pub fn skeleton(mut self, name: impl Into<String>) -> Self {
        self.request.skeletons.push(name.into());
        self
    }

    /// Decides an input, as in `b=entering`: each table is made without it, with a name of its own, `NAME_b_entering`.
    /// Several inputs are decided one by one; for several permutations, compile several times.
    pub fn fix(mut self, decision: impl Into<String>) -> Self {
        self.request.fix.push(decision.into());
        self
    }

    /// Makes a plan of this shape; without any, `ordered`.
    pub fn plan(mut self, shape: Shape) -> Self {
        self.request.options.shapes.push(shape);
        self
    }

    /// Makes what `umbrage tune` chose; where it chose nothing, `switch`, or `ladder` where the key is too large.
    pub fn auto(mut self) -> Self {
        self.request.options.auto = true;
        self
    }

    /// The directory of what `umbrage tune` chose; without, `tuned` beside the directory of the tables.
    pub fn tuned(mut self, directory: impl Into<PathBuf>) -> Self {
        self.request.tuned = Some(directory.into());
        self
    }

    /// For [`Self::auto`], only what was chosen on this device.
    pub fn device(mut self, name: impl Into<String>) -> Self {
        self.request.device = Some(name.into());
        self
    }

    /// Plans for what this profile counted; each table takes the profiles of its own name. A table that is in none
    /// of them takes `profiles/TABLE.ron` beside the directory of the tables, if there is one.
    pub fn profile(mut self, path: impl Into<PathBuf>) -> Self {
        self.request.profiles.push(path.into());
        self
    }

    /// Also writes what each plan and its table mean as SMT-LIB 2, for a solver to compare: `TABLE/PLAN.smt2`.
    pub fn certificates(mut self) -> Self {
        self.request.options.certificates = true;
        self
    }

    /// Lets plans do anything where a table's assumptions do not hold.
    pub fn assume(mut self) -> Self {
        self.request.options.assume = true;
        self
    }

    /// Shows findings of this code as warnings, whatever they are by themselves.
    pub fn warn(self, code: &str) -> Self {
        self.level(code, LintLevel::Warn)
    }

    /// Fails if there are findings of this code.
    pub fn deny(self, code: &str) -> Self {
        self.level(code, LintLevel::Deny)
    }

    /// Does not show findings of this code.
    pub fn allow(self, code: &str) -> Self {
        self.level(code, LintLevel::Allow)
    }

    /// Lets tables import files outside of their own directories, in this and every later build of the process.
    pub fn allow_outside(self) -> Self {
        reach::allow_outside();
        self
    }

    fn level(mut self, code: &str, level: LintLevel) -> Self {
        if let Err(message) = self.request.levels.set(code, level) {
            self.problems.push(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message)));
        }
        self
    }

    /// Puts the files elsewhere than into `OUT_DIR`.
    pub fn output(mut self, directory: impl Into<PathBuf>) -> Self {
        self.output = Some(directory.into());
        self
    }

    /// Checks, proves, emits and validates every table, and writes the files,
    /// those that say something new; what an earlier run made and this one does
    /// not is removed. Tells Cargo what to watch, and shows findings as warnings. Returns the directory of the files.
    ///
    /// If the variable `UMBRAGE_OUT_DIR` is set, a copy goes there, into a
    /// folder with the name of the package.
    ///
    /// # Errors
    /// When anything is wrong with any table or profile; then nothing is written.
    pub fn compile(mut self) -> Result<PathBuf, Errors> {
        let own = std::env::var_os("OUT_DIR").map(PathBuf::from);
        let Some(output) = self.output.take().or_else(|| own.clone()) else {
            let error = Diagnostic::error(codes::UNWRITABLE, "there is no place for the generated files");
            let error = error.help("call this from a build script, or name a directory: `output`");
            self.problems.push(Failure::bare("", error));
            return Err(Errors(self.problems));
        };
        if !self.problems.is_empty() {
            return Err(Errors(self.problems));
        }
        let options = &mut self.request.options;
        if options.shapes.is_empty() && !options.auto {
            options.shapes.push(Shape::Ordered);
        }
        if options.targets.is_empty() {
            options.targets.push(Target::Wgsl);
        }
        let (copies, stamp) = (copies(), own.as_deref().map(Stamp::next));
        println!("cargo::rerun-if-env-changed={COPIES}");
        if copies.is_none()
            && let Some(fresh) = stamp.as_ref().and_then(|stamp| stamp.fresh(&self.request, &output))
        {
            fresh.inputs.iter().for_each(|input| watch(input));
            watch_absent(stamp.as_ref(), &fresh.absent);
            fresh.warnings.iter().for_each(|warning| warn(warning));
            return Ok(output);
        }
        let batch = run(&self.request);
        batch.inputs.iter().for_each(|input| watch(input));
        watch_absent(stamp.as_ref(), &batch.absent);
        let warnings = warnings(&batch);
        warnings.iter().for_each(|warning| warn(warning));
        if batch.failed() {
            return Err(Errors::of(batch));
        }
        let files = batch.files();
        for directory in [Some(&output), copies.as_ref()].into_iter().flatten() {
            write(directory, &files).map_err(|failure| Errors(vec![failure]))?;
        }
        if let Some(stamp) = stamp {
            let (inputs, absent) = (&batch.inputs, &batch.absent);
            let made =
                Made { request: &self.request, output: &output, warnings: &warnings, inputs, absent, files: &files };
            stamp.sweep(&made, copies.as_deref());
            stamp.leave(&made);
        }
        Ok(output)
    }
}

/// The directory for copies that people can read.
fn copies() -> Option<PathBuf> {
    let directory = PathBuf::from(std::env::var_os(COPIES).filter(|directory| !directory.is_empty())?);
    Some(match std::env::var_os("CARGO_PKG_NAME") {
        Some(package) => directory.join(package),
        None => directory,
    })
}

/// The warnings of a run, each with its place, on one line.
fn warnings(batch: &Batch) -> Vec<String> {
    let mut warnings = Vec::new();
    for failure in &batch.messages {
        for finding in failure.diagnostics.iter().filter(|finding| finding.severity == Severity::Warning) {
            let place = finding.labels.first().map_or(String::new(), |label| {
                let (line, column) = failure.source.line_column(label.span.start);
                format!("{}:{line}:{column}: ", failure.source.name)
            });
            warnings.push(format!("{place}{} [{}]", finding.message, finding.code).replace('\n', " "));
        }
    }
    warnings
}

fn warn(warning: &str) {
    println!("cargo::warning={}", visible(warning));
}

fn watch(path: &Path) {
    println!("cargo::rerun-if-changed={}", path.display());
}

/// Watches what would be read if it were there. Where that is not possible it is seen when the script runs for another
/// reason.
fn watch_absent(stamp: Option<&Stamp>, places: &BTreeSet<PathBuf>) {
    let watched = stamp.and_then(|stamp| absent::links(&stamp.absent(), places).ok().flatten());
    watched.iter().for_each(|directory| watch(directory));
}

/// Why tables could not be compiled: everything that is wrong with all of them.
///
/// A build script that returns them from `main` shows them as they are meant to be read.
#[derive(Clone)]
pub struct Errors(Vec<Failure>);

impl Errors {
    /// The errors of a run. Its warnings have been shown.
    fn of(batch: Batch) -> Self {
        let mut failures = batch.messages;
        for failure in &mut failures {
            failure.diagnostics.retain(|found| found.severity == Severity::Error);
        }
        failures.retain(|failure| !failure.diagnostics.is_empty());
        Self(failures)
    }

    /// The errors, by what they are about.
    pub fn failures(&self) -> &[Failure] {
        &self.0
    }
}

impl fmt::Display for Errors {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for failure in &self.0 {
            writeln!(f, "{failure}\n")?;
        }
        let first = self.0.iter().find_map(|failure| Some((failure, failure.diagnostics.first()?)));
        let Some((failure, first)) = first else { return Ok(()) };
        let name = &failure.source.name;
        let looks = match first.code {
            _ if !name.ends_with(".ron") => None,
            codes::BAD_PROFILE | codes::EMPTY_PROFILE => Some("profile show"),
            // No other command reads only these.
            codes::OTHER_PROFILE | codes::BAD_TUNED => None,
            _ => Some("check"),
        };
        if let Some(command) = looks {
            write!(f, "`umbrage {command} {}` checks without building; ", typed(name))?;
        }
        write!(f, "`umbrage explain {}` says at length what {} means", first.code, first.code)
    }
}

/// A path as it is typed where Cargo was started, which need not be the directory of the package.
fn typed(name: &str) -> String {
    let started = std::env::var_os("PWD").map(PathBuf::from).filter(|place| place.is_dir());
    let elsewhere = started.zip(std::env::current_dir().ok()).is_some_and(|(started, here)| {
        let same = |place: PathBuf| std::fs::canonicalize(&place).unwrap_or(place);
        same(started) != same(here)
    });
    let path = if elsewhere { std::path::absolute(name).unwrap_or_else(|_| name.into()) } else { name.into() };
    match shown(&path) {
        path if path.contains(char::is_whitespace) => format!("'{path}'"),
        path => path,
    }
}

impl fmt::Debug for Errors {
    /// As they are displayed: this is what Rust prints when `main` returns them.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "the tables cannot be compiled\n\n{self}")
    }
}

impl std::error::Error for Errors {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_script_gets_what_it_asks_for() {
        let place = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
        let tables = Tables::new("tables/smsr.ron").wgsl().glsl(450).skeleton("smsr");
        let output = tables.output(place.path()).compile().unwrap_or_else(|e| panic!("{e}"));
        let wgsl = std::fs::read_to_string(output.join("smsr/ordered.wgsl")).unwrap_or_else(|e| panic!("{e}"));
        assert!(wgsl.contains("fn smsr_key("));
        let skeleton = std::fs::read_to_string(output.join("skeletons/smsr.wgsl")).unwrap_or_else(|e| panic!("{e}"));
        assert!(skeleton.contains("smsr_key_case("));
        assert!(output.join("smsr/ordered.450.glsl").exists() && !output.join("smsr/ladder.wgsl").exists());
    }

    /// The messages, one line each.
    fn errors(tables: Tables, place: &Path) -> Vec<String> {
        let errors = tables.output(place).compile().expect_err("wrong");
        assert!(std::fs::read_dir(place).is_ok_and(|mut files| files.next().is_none()), "nothing was written");
        let found = errors.failures().iter().flat_map(|failure| &failure.diagnostics);
        found.map(|diagnostic| diagnostic.message.clone()).collect()
    }

    #[test]
    fn all_errors_are_told() {
        let place = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
        let found = errors(Tables::new("tables").glsl(110).deny("U9999"), place.path());
        assert_eq!(found[0], "GLSL 110 is no target");
        assert!(found[1].starts_with("there is no finding `U9999`; the findings are: "), "{found:?}");
        let found = errors(Tables::new("tables/smsr.ron").skeleton("smrs"), place.path());
        assert_eq!(found, ["there is no skeleton `smrs`"]);
        let tables = Tables::new("tables/smsr.ron").profile("tables/smsr.ron").also("none.ron").also("README.md");
        let found = errors(tables, place.path());
        assert!(found[0].starts_with("this is not a profile"), "{found:?}");
        assert!(found[1].starts_with("cannot be read"), "{found:?}");
        assert_eq!(found.len(), 3, "{found:?}");
        let errors = Tables::new("none.ron").output(place.path()).compile().expect_err("wrong");
        let text = format!("{errors:?}");
        assert!(text.starts_with("the tables cannot be compiled\n\nerror[U0001]: none.ron: "), "{text}");
        let last =
            "`umbrage check none.ron` checks without building; `umbrage explain U0001` says at length what U0001 means";
        assert!(text.ends_with(last), "{text}");
    }
}
