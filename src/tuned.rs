//! The choices for a device, as a file.
//!
//! One file per device holds the choice for every table that was tuned on it,
//! with the evidence. Reading it needs no device, so that a build can use what
//! was measured elsewhere.

use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::plan::{Plan, Shape};
use crate::program::Program;
use crate::text::file::{read_text, shown};

const VERSION: u32 = 1;
const MAX_BYTES: u64 = 16 << 20;

/// The choices for a device.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tuned {
    version: u32,
    /// The device, in words.
    pub device: String,
    /// One choice per table.
    pub tables: Vec<Choice>,
}

/// The plan chosen for a table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Choice {
    /// Name of the table.
    pub table: String,
    /// Fingerprint of its text when it was measured.
    pub fingerprint: String,
    /// The plan, as `--plan` takes it.
    pub plan: String,
    /// True if the plan relies on the table's assumptions.
    pub assume: bool,
    /// The profile that it was planned for.
    pub profile: String,
    /// The version of umbrage that measured.
    pub umbrage: String,
    /// The method of measurement.
    pub method: String,
    /// The measurements.
    pub evidence: Vec<Evidence>,
}

/// A measurement.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Evidence {
    /// The plan.
    pub plan: String,
    /// The kind of inputs.
    pub input: String,
    /// Median time, in microseconds.
    pub us: f64,
    /// The same relative to the ladder as written.
    pub vs_ladder: f64,
    /// The same relative to reading and writing the data.
    pub vs_floor: f64,
}

impl Tuned {
    /// Nothing yet.
    pub fn new(device: &str) -> Self {
        Self { version: VERSION, device: device.to_owned(), tables: Vec::new() }
    }

    /// The file of a device's choices in a directory.
    pub fn path(directory: &Path, device: &str) -> PathBuf {
        directory.join(format!("{}.ron", slug(device)))
    }

    /// Reads what was tuned; `None` if there is no such file.
    ///
    /// # Errors
    /// When there is one, but it cannot be read.
    pub fn read(path: &Path) -> Result<Option<Self>, Failure> {
        if !path.exists() {
            return Ok(None);
        }
        let name = shown(path);
        let source = Source::new(name, read_text(path, MAX_BYTES)?);
        let tuned: Self = ron::from_str(&source.text).map_err(|error| {
            let at = |p: ron::error::Position| Source::offset(&source.text, p.line, p.col).min(source.text.len());
            let (start, end) = (at(error.span.start), at(error.span.end));
            let diagnostic = Diagnostic::error(codes::BAD_TUNED, format!("this is no tuned choice: {}", error.code));
            let diagnostic = diagnostic.at(Span::new(start, end.max(start)), "here");
            Failure::new(source.clone(), diagnostic.help("such files are written by `umbrage tune`; tune again"))
        })?;
        if tuned.version != VERSION {
            let message = format!("was written by another umbrage (version {} of the format)", tuned.version);
            let error = Diagnostic::error(codes::BAD_TUNED, message).help("tune again");
            return Err(Failure::bare(source.name.clone(), error));
        }
        Ok(Some(tuned))
    }

    /// The choice for a table, if it was made with this very text of it.
    pub fn choice(&self, program: &Program) -> Option<&Choice> {
        self.tables.iter().find(|choice| choice.table == program.name && choice.fingerprint == program.fingerprint())
    }

    /// Puts a choice in, instead of an older one for the same table.
    pub fn set(&mut self, choice: Choice) {
        self.tables.retain(|old| old.table != choice.table);
        self.tables.push(choice);
        self.tables.sort_by(|a, b| a.table.cmp(&b.table));
    }

    /// The text of the file.
    pub fn to_ron(&self) -> String {
        let pretty = ron::ser::PrettyConfig::new().struct_names(true).depth_limit(5);
        let text = ron::ser::to_string_pretty(self, pretty);
        // Texts and finite numbers can always be written.
        text.unwrap_or_default() + "\n"
    }
}

/// The plan that `auto` stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Auto {
    /// Its shape.
    pub shape: Shape,
    /// True if it relies on the table's assumptions.
    pub assume: bool,
    /// True if it was tuned, rather than being the default.
    pub tuned: bool,
}

impl Auto {
    /// The tuned plan if there is one for this very text of the table, else the
    /// default: `switch`, where the key is small enough for it, which does best
    /// on most graphics processors, else `ladder`.
    pub fn of(program: &Program, tuned: Option<&Tuned>) -> Self {
        let choice = tuned.and_then(|tuned| tuned.choice(program));
        if let Some(choice) = choice
            && let Some(shape) = Shape::from_name(choice.plan.trim_end_matches("+assume"))
        {
            return Self { shape, assume: choice.assume, tuned: true };
        }
        let switch = Shape::Switch;
        let shape = if Plan::new(program, switch).is_ok() { switch } else { Shape::Ladder };
        Self { shape, assume: false, tuned: false }
    }
}

/// A device's name as the name of a file: what stands before any detail in brackets.
pub fn slug(device: &str) -> String {
    let plain = device.split('(').next().unwrap_or(device);
    let words = plain.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
    let slug = words.collect::<Vec<_>>().join("-").to_ascii_lowercase();
    if slug.is_empty() { "device".to_owned() } else { slug }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn choice(table: &str, plan: &str) -> Choice {
        Choice {
            table: table.to_owned(),
            fingerprint: "fnv1a 0".to_owned(),
            plan: plan.to_owned(),
            assume: false,
            profile: String::new(),
            umbrage: "0".to_owned(),
            method: String::new(),
            evidence: vec![Evidence {
                plan: plan.to_owned(),
                input: "random".to_owned(),
                us: 1.5,
                vs_ladder: 1.0,
                vs_floor: 2.0,
            }],
        }
    }

    #[test]
    fn choices_are_kept_by_table_and_read_back() {
        let mut tuned = Tuned::new("A device (of some kind)");
        tuned.set(choice("b", "ladder"));
        tuned.set(choice("a", "ladder"));
        tuned.set(choice("b", "switch"));
        assert_eq!(
            tuned.tables.iter().map(|c| (&*c.table, &*c.plan)).collect::<Vec<_>>(),
            [("a", "ladder"), ("b", "switch")]
        );
        let directory = tempfile::tempdir().expect("a directory");
        let path = Tuned::path(directory.path(), &tuned.device);
        assert!(path.ends_with("a-device.ron"));
        assert_eq!(Tuned::read(&path).expect("no file is no error"), None);
        std::fs::write(&path, tuned.to_ron()).expect("written");
        assert_eq!(Tuned::read(&path).unwrap_or_else(|e| panic!("{e}")), Some(tuned.clone()));
        std::fs::write(&path, &tuned.to_ron()[..100]).expect("written");
        let failure = Tuned::read(&path).expect_err("cut off");
        assert!(failure.diagnostics[0].message.starts_with("this is no tuned choice: "));
    }

    #[test]
    fn auto_is_what_was_tuned_or_else_the_default() {
        let program = Program::read("tables/smsr.ron").unwrap_or_else(|e| panic!("{e}"));
        let default = Auto { shape: Shape::Switch, assume: false, tuned: false };
        assert_eq!(Auto::of(&program, None), default);
        let mut tuned = Tuned::new("d");
        tuned.set(Choice { assume: true, ..choice("smsr", "switch_buffer+assume") });
        assert_eq!(Auto::of(&program, Some(&tuned)), default, "another text of the table");
        tuned.tables[0].fingerprint = program.fingerprint();
        let expected = Auto { shape: Shape::SwitchBuffer, assume: true, tuned: true };
        assert_eq!(Auto::of(&program, Some(&tuned)), expected);
    }

    #[test]
    fn devices_have_plain_names() {
        assert_eq!(slug("llvmpipe (LLVM 19.1.7, 256 bits)"), "llvmpipe");
        assert_eq!(slug("NVIDIA H100 80GB HBM3"), "nvidia-h100-80gb-hbm3");
        assert_eq!(slug("../(x)"), "device");
    }
}
