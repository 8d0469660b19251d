//! What a build script calls.
//!
//! ```no_run
//! # fn main() -> Result<(), umbrage::diag::Failure> {
//! // build.rs
//! umbrage::build::Tables::new("tables").profile("profiles/smsr.ron").wgsl().glsl(450).compile()?;
//! # Ok(())
//! # }
//! ```
//!
//! Files go to `OUT_DIR`, one folder per table, and are included from there:
//! `include_str!(concat!(env!("OUT_DIR"), "/smsr/ordered.wgsl"))`.

use std::path::{Path, PathBuf};

use super::{NamedProfile, Options, find_tables, weigh, write};
use crate::analyse::{self, Levels};
use crate::diag::{Diagnostic, Failure, Severity, codes};
use crate::emit::{GlslVersion, Target};
use crate::plan::Shape;
use crate::profile;
use crate::program::Program;
use crate::table::Table;

/// Tables to be compiled by a build script.
#[derive(Debug, Clone)]
pub struct Tables {
    path: PathBuf,
    tuned: Option<PathBuf>,
    profiles: Vec<PathBuf>,
    options: Options,
    output: Option<PathBuf>,
    problem: Option<Failure>,
}

impl Tables {
    /// The table in a file, or all tables in a directory.
    pub fn new(path: impl Into<PathBuf>) -> Self {
        let options = Options { shapes: Vec::new(), targets: Vec::new(), auto: false, ..Options::default() };
        Self { path: path.into(), tuned: None, profiles: Vec::new(), options, output: None, problem: None }
    }

    /// Plans for what this profile counted; each table takes the profiles of its own name.
    #[must_use]
    pub fn profile(mut self, path: impl Into<PathBuf>) -> Self {
        self.profiles.push(path.into());
        self
    }

    /// Emits WGSL.
    #[must_use]
    pub fn wgsl(self) -> Self {
        self.target(Target::Wgsl)
    }

    /// Emits GLSL of a version: 450, 330, or 300 for ES 3.0. There are no others, as [`Self::compile`] will say.
    #[must_use]
    pub fn glsl(mut self, version: u32) -> Self {
        let version = match version {
            450 => GlslVersion::V450,
            330 => GlslVersion::V330,
            300 => GlslVersion::Es300,
            _ => {
                let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("GLSL {version} is no target"));
                let error = error.help("the versions are: 450, 330, and 300 for ES 3.0");
                self.problem.get_or_insert_with(|| Failure::bare("", error));
                return self;
            }
        };
        self.target(Target::Glsl(version))
    }

    /// Emits a language; without any, WGSL.
    #[must_use]
    pub fn target(mut self, target: Target) -> Self {
        self.options.targets.push(target);
        self
    }

    /// Makes a plan of this shape; without any, `ordered`.
    #[must_use]
    pub fn plan(mut self, shape: Shape) -> Self {
        self.options.shapes.push(shape);
        self
    }

    /// Makes what `umbrage tune` chose, by the files in a directory; where it chose nothing, `switch`, or `ladder`
    /// where the key is too large.
    #[must_use]
    pub fn auto(mut self, tuned: impl Into<PathBuf>) -> Self {
        self.options.auto = true;
        self.tuned = Some(tuned.into());
        self
    }

    /// Lets plans do anything where a table's assumptions do not hold.
    #[must_use]
    pub fn assume(mut self) -> Self {
        self.options.assume = true;
        self
    }

    /// Puts the files elsewhere than into `OUT_DIR`.
    #[must_use]
    pub fn output(mut self, directory: impl Into<PathBuf>) -> Self {
        self.output = Some(directory.into());
        self
    }

    /// Checks, proves, emits and validates every table, and writes the files.
    /// Tells Cargo what to watch, and shows findings as warnings. Returns where the files are.
    ///
    /// # Errors
    /// When anything is wrong with a table or a profile; then nothing is written.
    pub fn compile(self) -> Result<PathBuf, Failure> {
        if let Some(problem) = self.problem {
            return Err(problem);
        }
        let output = self.output.clone().or_else(|| std::env::var_os("OUT_DIR").map(PathBuf::from));
        let Some(output) = output else {
            let error = Diagnostic::error(codes::UNWRITABLE, "there is no place for the generated files");
            return Err(Failure::bare("", error.help("call this from a build script, or name a directory: `output`")));
        };
        let mut options = self.options;
        if options.shapes.is_empty() && !options.auto {
            options.shapes.push(Shape::Ordered);
        }
        if options.targets.is_empty() {
            options.targets.push(Target::Wgsl);
        }
        watch(&self.path);
        if let Some(tuned) = &self.tuned {
            watch(tuned);
            options.tuned = super::tuned_in(tuned)?;
        }
        let mut profiles: Vec<NamedProfile> = Vec::new();
        for path in &self.profiles {
            watch(path);
            profiles.push((path.clone(), profile::read(path)?));
        }
        let mut files = Vec::new();
        for path in find_tables(&self.path)? {
            watch(&path);
            let table = Table::read(&path)?;
            // An exhibit is built only if it was named.
            if self.path.is_dir() && table.exhibit.is_some() {
                continue;
            }
            watch_imports(&table);
            let programs = Program::check_all(&table)?;
            for program in &programs {
                warn(program)?;
            }
            for program in programs.iter().filter(|program| program.function.is_none()) {
                for warning in weigh(program, &profiles, &mut options)? {
                    println!("cargo::warning={}", warning.message);
                }
            }
            files.extend(super::programs(&programs, &options)?.files);
        }
        write(&output, &files)?;
        Ok(output)
    }
}

/// Fails if a table contradicts itself, and shows Cargo what is questionable.
fn warn(program: &Program) -> Result<(), Failure> {
    let findings = analyse::problems(program, &Levels::default());
    if findings.iter().any(|finding| finding.severity == Severity::Error) {
        return Err(Failure { source: program.source.clone(), diagnostics: findings });
    }
    for finding in findings {
        let place = finding.labels.first().map_or(String::new(), |label| {
            let (line, column) = program.source.line_column(label.span.start);
            format!(":{line}:{column}")
        });
        println!("cargo::warning={}{place}: {} [{}]", program.source.name, finding.message, finding.code);
    }
    Ok(())
}

/// Has Cargo watch what a table imports, which may lie elsewhere.
fn watch_imports(table: &Table) {
    for imported in table.imports.iter().filter_map(|import| import.table.as_deref()) {
        watch(Path::new(&imported.source.name));
        watch_imports(imported);
    }
}

fn watch(path: &Path) {
    println!("cargo::rerun-if-changed={}", path.display());
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_build_script_gets_what_it_asks_for() {
        let place = tempfile::tempdir().unwrap_or_else(|e| panic!("{e}"));
        let tables = Tables::new("tables/smsr.ron").wgsl().glsl(450);
        let output = tables.output(place.path()).compile().unwrap_or_else(|e| panic!("{e}"));
        let wgsl = std::fs::read_to_string(output.join("smsr/ordered.wgsl")).unwrap_or_else(|e| panic!("{e}"));
        assert!(wgsl.contains("fn smsr_key("));
        assert!(output.join("smsr/ordered.450.glsl").exists() && !output.join("smsr/ladder.wgsl").exists());
        let failure = Tables::new("tables").glsl(110).compile().expect_err("no such version");
        assert_eq!(failure.diagnostics[0].message, "GLSL 110 is no target");
        let other = Tables::new("tables/smsr.ron").profile("tables/smsr.ron").output(place.path()).compile();
        let message = &other.expect_err("not a profile").diagnostics[0].message;
        assert!(message.starts_with("this is not a profile"), "{message}");
    }
}
