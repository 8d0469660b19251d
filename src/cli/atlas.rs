//! `umbrage atlas`: every case of a table as a picture.

use std::io::Write;
use std::path::{Path, PathBuf};

use super::messages::Report;
use super::output::Sink;
use super::{Outcome, Result, profiled};
use crate::atlas::{self, Atlas};
use crate::diag::{Diagnostic, Failure, codes};
use crate::picture;
use crate::profile;
use crate::program::Program;
use crate::text::file::shown;

/// Arguments of `umbrage atlas`.
#[derive(clap::Args)]
pub(super) struct Arguments {
    /// The table
    table: PathBuf,
    /// The function of a table of functions
    #[arg(long, value_name = "NAME")]
    function: Option<String>,
    /// The file to write; the extension (svg, png, html) says in which form
    #[arg(long, short, value_name = "FILE")]
    output: PathBuf,
    /// Profile: how often each case is taken
    #[arg(long, value_name = "FILE")]
    profile: Option<PathBuf>,
    /// Pixels per unit of the drawing, for PNG
    #[arg(long, default_value_t = 1.5, value_name = "FACTOR")]
    scale: f32,
}

/// Draws the atlas.
pub(super) fn run(arguments: &Arguments, report: &Report) -> Result<Outcome> {
    let form = Form::of(&arguments.output)?;
    let program = Program::read_function(&arguments.table, arguments.function.as_deref())?;
    let mut sink = Sink::create(&arguments.output)?;
    let fitted = profiled::read(&program, arguments.profile.as_deref(), report)?;
    let shares = fitted.map(|fitted| profile::shares(&fitted.profile, &program));
    let atlas = Atlas::new(&program, shares.as_deref())?;
    let bytes = match form {
        Form::Svg => atlas::svg(&program, &atlas).into_bytes(),
        Form::Html => atlas::page(&program, &atlas).into_bytes(),
        Form::Png => picture::png(&picture::raster(&atlas::svg(&program, &atlas), arguments.scale)?)?,
    };
    sink.write_all(&bytes).map_err(|error| sink.failure(&error))?;
    sink.finish()?;
    Ok(Outcome::Clean)
}

/// The form of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Form {
    Svg,
    Png,
    Html,
}

impl Form {
    fn of(path: &Path) -> std::result::Result<Self, Failure> {
        match path.extension().and_then(|extension| extension.to_str()) {
            Some("svg") => Ok(Form::Svg),
            Some("png") => Ok(Form::Png),
            Some("html") => Ok(Form::Html),
            _ => {
                let error =
                    Diagnostic::error(codes::UNWRITABLE, "the name does not say which form the atlas is to have")
                        .help("let it end in .svg, .png or .html");
                Err(Failure::bare(shown(path), error))
            }
        }
    }
}
