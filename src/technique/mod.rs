//! Techniques: ways to turn a scene into a picture, all behind one interface.
//!
//! ```text
//! scene ──▶ Frame ──Technique::prepare──▶ Prepared ──render──▶ Rendered: named layers
//!           surfaces, settings            planned, proved,     value or light, case, state, …
//!                                         compiled: once
//! ```
//!
//! Commands, the tuner and profiles know this interface and the registry [`ALL`]
//! only: a technique is a module here with an entry in the registry.

pub mod area;
pub mod capture;
pub mod cases;
pub mod convolve;
pub mod count;
pub mod difference;
pub mod executor;
pub mod frame;
pub mod integrals;
pub mod prepared;
pub mod reference;
pub mod rendered;
pub mod revectorise;
pub mod setting;
pub mod shade;
pub mod tables;

use std::fmt;

use crate::diag::{Diagnostic, Failure, codes};
use crate::scene::light::Lights;

use crate::text::closest::nearest;
pub use executor::Executor;
pub use frame::Frame;
pub use prepared::{Inputs, Prepared, Progress};
pub use rendered::{Layer, Rendered, Samples};
pub use setting::{Setting, Settings};
use tables::BuiltIn;

/// The techniques, by family and within a family the cheapest first.
pub static ALL: &[&dyn Technique] = &[
    &revectorise::HARD,
    &revectorise::PCF,
    &revectorise::SMSR,
    &revectorise::RSMSS,
    &revectorise::RPCF,
    &revectorise::CASE_FREE,
    &reference::REFERENCE,
    &integrals::INTEGRALS,
    &integrals::BRUTE_FORCE,
    &area::AREA_UNSHADOWED,
    &area::AREA_SAMPLES,
    &area::AREA_RATIO,
    &area::search::DISCONTINUITY,
    &area::PEEL,
    &area::EXACT,
    &convolve::CONVOLVE,
    &convolve::REFERENCE,
];

/// A way to turn a scene into a picture.
pub trait Technique: Sync {
    /// Its name on the command line and in files.
    fn name(&self) -> &'static str;

    /// One line about it.
    fn doc(&self) -> &'static str;

    /// The tables that it evaluates.
    fn tables(&self) -> &'static [&'static BuiltIn];

    /// The kinds of lights that it takes.
    fn lights(&self) -> Lights;

    /// The settings that it reads.
    fn settings(&self) -> &'static [Setting];

    /// Its abilities besides its picture.
    fn abilities(&self) -> &'static [Ability];

    /// The technique whose picture is the true one for this technique.
    fn truth(&self) -> Option<&'static str>;

    /// Returns whether it runs elsewhere on a GPU than on the CPU.
    fn needs_device(&self) -> bool {
        true
    }

    /// Plans, proves and compiles what a frame needs.
    ///
    /// # Errors
    /// When the frame is beyond the device's limits, or the device fails.
    fn prepare<'s>(&self, frame: &Frame<'s>) -> Result<Box<dyn Prepared<'s> + 's>, Failure>;
}

/// A thing that a technique can be asked for besides its picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ability {
    /// The layer [`VALUE`](rendered::VALUE).
    Visibility,
    /// The layer [`FACTOR`](area::FACTOR).
    FormFactors,
    /// The layers [`CASE`](rendered::CASE) and [`STATE`](rendered::STATE).
    Cases,
    /// [`Prepared::inputs`].
    Inputs,
    /// `Prepared::passes`.
    Passes,
    /// Passes with any plan of its table, as [`Frame::plans`] gives it.
    Plans,
}

impl fmt::Display for Ability {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Ability::Visibility => "visibility of a light",
            Ability::FormFactors => "form factors of lights",
            Ability::Cases => "a table of cases",
            Ability::Inputs => "inputs that can be captured",
            Ability::Passes => "passes that can be measured",
            Ability::Plans => "passes that take any plan of a table",
        })
    }
}

impl fmt::Debug for dyn Technique + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl fmt::Display for dyn Technique + '_ {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl PartialEq for dyn Technique + '_ {
    fn eq(&self, other: &Self) -> bool {
        self.name() == other.name()
    }
}

/// The technique with a name.
///
/// # Errors
/// When there is none, with the closest name.
///
/// ```
/// assert_eq!(umbrage::technique::from_name("rsmss")?.name(), "rsmss");
/// let error = umbrage::technique::from_name("rsms").unwrap_err();
/// assert!(error.to_string().contains("did you mean `rsmss`?"));
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn from_name(name: &str) -> Result<&'static dyn Technique, Failure> {
    let found = ALL.iter().find(|technique| technique.name() == name);
    found.copied().ok_or_else(|| {
        let error = Diagnostic::error(codes::RENDER, format!("there is no technique `{name}`"));
        let error = suggest(error, name, ALL.iter().map(|technique| technique.name()));
        Failure::bare("", error.help(format!("the techniques are: {}", names(|_| true).join(", "))))
    })
}

/// The setting with a name, of the first technique that declares it.
pub fn setting(name: &str) -> Option<&'static Setting> {
    ALL.iter().flat_map(|technique| technique.settings()).find(|setting| setting.name == name)
}

/// Reads `NAME=VALUE` pairs for techniques that are used together: each setting has to be declared by one of them.
///
/// # Errors
/// When no technique declares a setting, or the value is out of its range.
pub fn read_settings<'a>(
    techniques: &[&dyn Technique],
    pairs: impl IntoIterator<Item = &'a str>,
) -> Result<Settings, Failure> {
    let declared = || techniques.iter().flat_map(|technique| technique.settings());
    let refuse = |message: String| Diagnostic::error(codes::RENDER, message);
    let mut settings = Settings::default();
    for pair in pairs {
        let Some((name, value)) = pair.split_once('=') else {
            let error = refuse(format!("`{pair}` sets nothing")).help("write NAME=VALUE");
            return Err(Failure::bare("", error));
        };
        let Some(setting) = declared().find(|setting| setting.name == name) else {
            let who: Vec<&str> = techniques.iter().map(|technique| technique.name()).collect();
            let mut known: Vec<&str> = declared().map(|setting| setting.name).collect();
            known.sort_unstable();
            known.dedup();
            let error = refuse(format!("{} has no setting `{name}`", and(&who)));
            let error = suggest(error, name, known.iter().copied());
            let known = if known.is_empty() { "there are none".to_owned() } else { known.join(", ") };
            return Err(Failure::bare("", error.help(format!("settings: {known}"))));
        };
        let value = setting.parse(value).map_err(|expected| {
            let error = refuse(format!("`{value}` is no value of the setting `{name}`: {expected}"));
            Failure::bare("", error.help(setting.doc))
        })?;
        settings.set(setting, value);
    }
    Ok(settings)
}

/// Refuses a technique that lacks an ability.
///
/// # Errors
/// When it does; `what` is what needs the ability. The message names the techniques that have it.
pub fn require(technique: &dyn Technique, ability: Ability, what: &str) -> Result<(), Failure> {
    if technique.abilities().contains(&ability) {
        return Ok(());
    }
    let message = format!("`{what}` needs a technique with {ability}, and {technique} has none");
    let with = names(|technique| technique.abilities().contains(&ability));
    let error = Diagnostic::error(codes::RENDER, message);
    Err(Failure::bare("", error.help(format!("the techniques with {ability} are {}", and(&with)))))
}

/// The names of the techniques of which something holds.
pub fn names(holds: impl Fn(&dyn Technique) -> bool) -> Vec<&'static str> {
    ALL.iter().filter(|technique| holds(**technique)).map(|technique| technique.name()).collect()
}

/// Words as an enumeration in a sentence.
pub(crate) fn and(words: &[&str]) -> String {
    match words {
        [] => "none".to_owned(),
        [word] => (*word).to_owned(),
        [words @ .., last] => format!("{} and {last}", words.join(", ")),
    }
}

fn suggest<'a>(error: Diagnostic, name: &str, known: impl Iterator<Item = &'a str>) -> Diagnostic {
    match nearest(name, known) {
        Some(close) => error.did_you_mean(name, close),
        None => error,
    }
}

#[cfg(test)]
mod tests;
