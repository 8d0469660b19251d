//! The choices for a device, as a file.
//!
//! One file per device holds the choice for every table that was tuned on it,
//! with the evidence. Reading it needs no device, so that a build can use what
//! was measured elsewhere.

use std::fmt;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};

use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::plan::{Plan, Shape};
use crate::program::{Kinship, Program};
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
    /// Fingerprint of its meaning when it was measured.
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

    /// The plan chosen for a table, if the table means what it meant then.
    ///
    /// # Errors
    /// With the reason why there is none.
    pub fn choice(&self, program: &Program) -> Result<(&Choice, Shape), Fallback> {
        let device = || self.device.clone();
        let choice = self.tables.iter().find(|choice| choice.table == program.name).ok_or(Fallback::Untuned)?;
        match program.kinship(&choice.fingerprint) {
            Kinship::Same => {}
            Kinship::Other => return Err(Fallback::Changed { device: device() }),
            Kinship::Unknown => return Err(Fallback::Unknown { device: device() }),
        }
        match Shape::from_name(choice.plan.trim_end_matches("+assume")) {
            Some(shape) => Ok((choice, shape)),
            None => Err(Fallback::NoSuchPlan { device: device(), plan: choice.plan.clone() }),
        }
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

/// Why nothing that was tuned is used.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Fallback {
    /// Nothing was tuned for the table.
    Untuned,
    /// The table has changed since.
    Changed {
        /// The device on which it was tuned.
        device: String,
    },
    /// It cannot be told if the table has changed since.
    Unknown {
        /// The device on which it was tuned.
        device: String,
    },
    /// The plan that was chosen is none of this version.
    NoSuchPlan {
        /// The device on which it was tuned.
        device: String,
        /// The plan.
        plan: String,
    },
}

impl fmt::Display for Fallback {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Untuned => f.write_str("nothing was tuned for it"),
            Self::Changed { device } => write!(f, "it has changed since it was tuned on {device}"),
            Self::Unknown { device } => write!(f, "it was tuned on {device} by another version of umbrage"),
            Self::NoSuchPlan { device, plan } => write!(f, "`{plan}`, chosen on {device}, is no plan of this umbrage"),
        }
    }
}

impl Fallback {
    /// A choice that exists and is not used, as a warning about a table: what is used instead, and how to tune again.
    /// Nothing, if there is no choice.
    pub fn diagnostic(&self, program: &Program, instead: Shape, directory: &Path) -> Option<Diagnostic> {
        let device = match self {
            Self::Untuned => return None,
            Self::Changed { device } | Self::Unknown { device } | Self::NoSuchPlan { device, .. } => device,
        };
        let message = format!("what was tuned for `{}` is not used: {self}; `auto` is `{instead}` there", program.name);
        Some(Diagnostic::warning(codes::OLD_TUNED, message).help(tune(program, device, directory)))
    }
}

/// The way to tune a table on a device, with the profile that lies beside the directory of choices.
pub fn tune(program: &Program, device: &str, directory: &Path) -> String {
    let table = &program.source.name;
    let profile = directory.with_file_name("profiles").join(format!("{}.ron", program.name));
    let (exists, profile) = (profile.exists(), shown(&profile));
    let tune =
        format!("`umbrage tune {table} --profile {profile} --adapter {} --output {}`", plain(device), shown(directory));
    match exists {
        true => format!("to tune it: {tune}"),
        false => format!(
            "to tune it: count what occurs, `umbrage profile --table {table} --frames FILE -o {profile}`, then {tune}"
        ),
    }
}

/// The plan that `auto` stands for.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Auto {
    /// Its shape.
    pub shape: Shape,
    /// True if it relies on the table's assumptions.
    pub assume: bool,
    /// Set if it is the default, with the reason why it was not tuned.
    pub fallback: Option<Fallback>,
}

impl Auto {
    /// The tuned plan if there is one for what the table means, else the
    /// default: `switch`, where the key is small enough for it, which does best
    /// on most graphics processors, else `ladder`; of data `coefficients`, which
    /// reads them from a buffer.
    pub fn of(program: &Program, tuned: Option<&Tuned>) -> Self {
        match tuned.map_or(Err(Fallback::Untuned), |tuned| tuned.choice(program)) {
            Ok((choice, shape)) => Self { shape, assume: choice.assume, fallback: None },
            Err(fallback) => {
                let shape = match program.is_data() {
                    true => Shape::Coefficients,
                    false if Plan::new(program, Shape::Switch).is_ok() => Shape::Switch,
                    false => Shape::Ladder,
                };
                Self { shape, assume: false, fallback: Some(fallback) }
            }
        }
    }
}

/// The part of a device's name that stands before any detail in brackets, as one word of a command.
fn plain(device: &str) -> String {
    let plain = device.split('(').next().unwrap_or(device).trim();
    let one = !plain.is_empty() && plain.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c));
    if one { plain.to_owned() } else { format!("'{}'", plain.replace('\'', "")) }
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
        let default = |fallback| Auto { shape: Shape::Switch, assume: false, fallback: Some(fallback) };
        assert_eq!(Auto::of(&program, None), default(Fallback::Untuned));
        let device = || "Some device (of a kind)".to_owned();
        let mut tuned = Tuned::new(&device());
        assert_eq!(Auto::of(&program, Some(&tuned)), default(Fallback::Untuned));
        tuned.set(Choice { assume: true, ..choice("smsr", "switch_buffer+assume") });
        let unknown = Fallback::Unknown { device: device() };
        assert_eq!(Auto::of(&program, Some(&tuned)), default(unknown));
        tuned.tables[0].fingerprint = program.fingerprint();
        let expected = Auto { shape: Shape::SwitchBuffer, assume: true, fallback: None };
        assert_eq!(Auto::of(&program, Some(&tuned)), expected);
        let mut changed = program.clone();
        changed.rows.pop();
        let fallback = Fallback::Changed { device: device() };
        assert_eq!(Auto::of(&changed, Some(&tuned)), default(fallback.clone()));
        tuned.tables[0].plan = "spiral".to_owned();
        let no_plan = Fallback::NoSuchPlan { device: device(), plan: "spiral".to_owned() };
        assert_eq!(Auto::of(&program, Some(&tuned)), default(no_plan));

        let said = fallback.diagnostic(&program, Shape::Switch, Path::new("tuned")).expect("said");
        let message = "what was tuned for `smsr` is not used: it has changed since it was tuned on Some device (of a kind); \
                       `auto` is `switch` there";
        assert_eq!(said.message, message);
        let command = "umbrage tune tables/smsr.ron --profile profiles/smsr.ron --adapter 'Some device' --output tuned";
        assert_eq!(said.notes, [format!("to tune it: `{command}`")]);
        assert_eq!(Fallback::Untuned.diagnostic(&program, Shape::Switch, Path::new("tuned")), None);
    }

    #[test]
    fn devices_have_plain_names() {
        assert_eq!(slug("llvmpipe (LLVM 19.1.7, 256 bits)"), "llvmpipe");
        assert_eq!(slug("NVIDIA H100 80GB HBM3"), "nvidia-h100-80gb-hbm3");
        assert_eq!(slug("../(x)"), "device");
    }
}
