//! `umbrage new`: a table to start from, and the build script that compiles it.

use std::io::Write;
use std::path::PathBuf;

use super::messages::{Format, Report};
use super::{Outcome, Result};
use crate::build::{self, Artifact};
use crate::cli::output::stdout;
use crate::diag::{Diagnostic, Failure, Span, codes};
use crate::table::names;
use crate::text::file::shown;

const TABLE: &str = include_str!("new/starter.ron");
const SCRIPT: &str = include_str!("new/build.rs.txt");
/// The placeholder for the name of the table in both.
const PLACEHOLDER: &str = "STARTER";

/// Arguments of `umbrage new`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// Name of the table: a plain identifier. Its file will be tables/NAME.ron
    #[arg(value_name = "NAME")]
    name: String,
    /// Directory of the crate, the one with Cargo.toml
    #[arg(long, value_name = "DIR", default_value = ".")]
    directory: PathBuf,
    /// Only the table, no build.rs
    #[arg(long)]
    table_only: bool,
}

/// Writes both files, or none if one of them exists.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let name = arguments.name.as_str();
    let place = Span::new(0, 0);
    // A table, unlike an input, has no dot in its name.
    names::check_inner(name, "a table", place).and_then(|()| names::check(name, "a table", place)).map_err(
        |mut error| {
            // The name comes from the command line: there is no text to point into.
            error.labels.clear();
            Failure::bare(name, error)
        },
    )?;
    let table = Artifact {
        path: ["tables", &format!("{name}.ron")].iter().collect(),
        contents: TABLE.replace(PLACEHOLDER, name).into_bytes(),
    };
    let script = Artifact { path: "build.rs".into(), contents: SCRIPT.replace(PLACEHOLDER, name).into_bytes() };
    let files: Vec<Artifact> =
        [Some(table), Some(script).filter(|_| !arguments.table_only)].into_iter().flatten().collect();
    for file in &files {
        let path = arguments.directory.join(&file.path);
        // A link that leads nowhere is something, too.
        if path.symlink_metadata().is_ok() {
            let help = match file.path.starts_with("tables") {
                true => "choose another name, or remove it",
                false => "add its line to that script yourself, and use `--table-only`",
            };
            let error = Diagnostic::error(codes::EXISTS, "exists already; nothing was written").help(help);
            return Err(Failure::bare(shown(&path), error).into());
        }
    }
    build::write(&arguments.directory, &files)?;
    if report.format == Format::Human {
        let mut out = stdout();
        for file in &files {
            writeln!(out, "wrote {}", arguments.directory.join(&file.path).display())?;
        }
        if !arguments.table_only {
            writeln!(out, "\nAdd to Cargo.toml:\n\n  [build-dependencies]")?;
            writeln!(out, "  umbrage = {{ version = \"{}\", default-features = false }}", env!("CARGO_PKG_VERSION"))?;
            writeln!(out, "\n(or `path = \"../umbrage\"` for a copy of its repository), and to the program:\n")?;
            writeln!(
                out,
                "  const SHADER: &str = include_str!(concat!(env!(\"OUT_DIR\"), \"/{name}/ordered.wgsl\"));"
            )?;
        }
        out.flush()?;
    }
    Ok(Outcome::Clean)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::program::Program;
    use crate::table::Table;

    #[test]
    fn the_starter_is_a_table_without_findings_and_formatted() {
        let source = Source::new("tables/paint.ron", TABLE.replace(PLACEHOLDER, "paint"));
        assert_eq!(crate::format::format(&source).unwrap_or_else(|e| panic!("{e}")), source.text);
        let table = Table::parse(source).unwrap_or_else(|e| panic!("{e}"));
        let programs = Program::check_all(&table).unwrap_or_else(|e| panic!("{e}"));
        let report = crate::analyse::report(&programs[0], &crate::analyse::LintLevels::default());
        assert_eq!(report.open, []);
        let built = build::table(&programs[0], &build::Options::default()).unwrap_or_else(|e| panic!("{e}"));
        assert!(built.files.iter().any(|file| file.path.ends_with("paint/ordered.wgsl")));
    }
}
