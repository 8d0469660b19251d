//! Profiles as files: RON, readable, one state per line.
//!
//! A file is read by serde into the shapes below, whose texts are slices of the
//! source, so that a level that does not exist is shown where it stands. Then
//! everything is checked: a profile that could be read makes sense.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::path::Path;
use std::sync::Arc;

use serde::de::{self, Deserialize, Deserializer, Visitor};

use super::{Profile, Scene, StateInput, Tiles};
use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::program::MAX_LEVELS;
use crate::text::file::{read_text, shown};

const VERSION: u32 = 1;
/// Largest accepted file.
const MAX_BYTES: u64 = 64 << 20;

/// A text and, if it stands in the source as it is, its place.
#[derive(Debug, Clone, Copy)]
struct Text<'a>(&'a str);

impl<'de: 'a, 'a> Deserialize<'de> for Text<'a> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Borrowed;
        impl<'de> Visitor<'de> for Borrowed {
            type Value = Text<'de>;

            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a text without escapes")
            }

            fn visit_borrowed_str<E: de::Error>(self, text: &'de str) -> Result<Self::Value, E> {
                Ok(Text(text))
            }
        }
        deserializer.deserialize_str(Borrowed)
    }
}

#[derive(serde::Deserialize)]
#[serde(rename = "Profile", deny_unknown_fields, bound(deserialize = "'de: 'a"))]
struct File<'a> {
    version: u32,
    table: Text<'a>,
    fingerprint: Text<'a>,
    inputs: Vec<(Text<'a>, Vec<Text<'a>>)>,
    scenes: Vec<FileScene<'a>>,
}

#[derive(serde::Deserialize)]
#[serde(rename = "Scene", deny_unknown_fields, bound(deserialize = "'de: 'a"))]
struct FileScene<'a> {
    name: Text<'a>,
    technique: Text<'a>,
    setting: Text<'a>,
    #[serde(default = "one")]
    weight: f64,
    states: Vec<(Text<'a>, u64)>,
    cases: Vec<(u32, u64)>,
    #[serde(default)]
    default: u64,
    tiles: Option<FileTiles>,
}

#[derive(serde::Deserialize)]
#[serde(rename = "Tiles", deny_unknown_fields)]
struct FileTiles {
    width: u32,
    height: u32,
    /// States by their place in the scene's list.
    sets: Vec<(Vec<usize>, u64)>,
    others: u64,
}

fn one() -> f64 {
    1.0
}

/// Reads a profile.
///
/// # Errors
/// When the file cannot be read or is no profile; with the place.
///
/// ```
/// let profile = umbrage::profile::read("profiles/smsr.ron".as_ref())?;
/// assert!(profile.total() > 1000 && profile.table == "smsr");
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn read(path: &Path) -> Result<Profile, Failure> {
    let name = shown(path);
    parse(&Source::new(name, read_text(path, MAX_BYTES)?))
}

fn parse(source: &Arc<Source>) -> Result<Profile, Failure> {
    let options = ron::Options::default().with_default_extension(ron::extensions::Extensions::IMPLICIT_SOME);
    let file: File<'_> = options.from_str(&source.text).map_err(|error| {
        let at = |p: ron::error::Position| Source::offset(&source.text, p.line, p.col).min(source.text.len());
        let (start, end) = (at(error.span.start), at(error.span.end));
        let message = format!("this is not a profile: {}", error.code);
        let diagnostic = Diagnostic::error(codes::BAD_PROFILE, message)
            .at(Span::new(start, end.max(start)), "here")
            .help("profiles are written by `umbrage profile`; make it again");
        Failure::new(source.clone(), diagnostic)
    })?;
    Checker { source }.profile(file).map_err(|diagnostic| Failure::new(source.clone(), diagnostic))
}

struct Checker<'a> {
    source: &'a Source,
}

impl<'a> Checker<'a> {
    fn error(&self, at: Text<'a>, message: impl Into<String>, label: &str) -> Diagnostic {
        // A text is a slice of the source, so the difference of the addresses is its place.
        let start = (at.0.as_ptr() as usize).saturating_sub(self.source.text.as_ptr() as usize);
        Diagnostic::error(codes::BAD_PROFILE, message).at(Span::new(start, start + at.0.len()), label)
    }

    fn profile(&self, file: File<'a>) -> Result<Profile, Diagnostic> {
        if file.version != VERSION {
            let message = format!("is a profile of version {}, and this umbrage reads version {VERSION}", file.version);
            return Err(Diagnostic::error(codes::BAD_PROFILE, message).help("make it again with this umbrage"));
        }
        let mut inputs = Vec::with_capacity(file.inputs.len());
        for (name, levels) in &file.inputs {
            if levels.is_empty() || levels.len() > MAX_LEVELS {
                let message = format!("an input has 1 to {MAX_LEVELS} levels, and `{}` has {}", name.0, levels.len());
                return Err(self.error(*name, message, "this input"));
            }
            let levels = levels.iter().map(|level| level.0.to_owned()).collect();
            inputs.push(StateInput { name: name.0.to_owned(), levels });
        }
        let mut profile = Profile {
            table: file.table.0.to_owned(),
            fingerprint: file.fingerprint.0.to_owned(),
            inputs,
            scenes: Vec::new(),
        };
        if profile.state_count().is_none() {
            return Err(self.error(file.table, "the inputs have more combinations than any table", "of this table"));
        }
        for scene in file.scenes {
            let scene = self.scene(&profile, scene)?;
            profile.scenes.push(scene);
        }
        Ok(profile)
    }

    fn scene(&self, profile: &Profile, file: FileScene<'a>) -> Result<Scene, Diagnostic> {
        let name = file.name.0;
        if !(file.weight.is_finite() && file.weight >= 0.0) {
            let message = format!("the weight of `{name}` is {}, a number from 0 on was expected", file.weight);
            return Err(self.error(file.name, message, "this scene"));
        }
        let mut states = BTreeMap::new();
        let mut listed = Vec::with_capacity(file.states.len());
        for (words, count) in &file.states {
            let state = profile.state(words.0).map_err(|reason| {
                let inputs: Vec<&str> = profile.inputs.iter().map(|input| input.name.as_str()).collect();
                self.error(*words, format!("this is no state: {reason}"), "here")
                    .help(format!("a state has one level for each of {}", inputs.join(", ")))
            })?;
            if states.insert(state, *count).is_some() {
                return Err(self.error(*words, "this state is counted twice", "again here").help("add the counts"));
            }
            listed.push(state);
        }
        let mut cases: BTreeMap<Option<u32>, u64> = BTreeMap::new();
        for (case, count) in &file.cases {
            if cases.insert(Some(*case), *count).is_some() {
                let message = format!("case {case} is counted twice in `{name}`");
                return Err(self.error(file.name, message, "in this scene").help("add the counts"));
            }
        }
        if file.default > 0 {
            cases.insert(None, file.default);
        }
        let by_state = states.values().try_fold(0_u64, |sum, count| sum.checked_add(*count));
        let by_case = cases.values().try_fold(0_u64, |sum, count| sum.checked_add(*count));
        match (by_state, by_case) {
            (Some(by_state), Some(by_case)) if by_state == by_case => {}
            (Some(by_state), Some(by_case)) => {
                let message = format!("the states of `{name}` count {by_state} evaluations, its cases {by_case}");
                return Err(self.error(file.name, message, "in this scene").help("the file is damaged; make it again"));
            }
            _ => return Err(self.error(file.name, "the counts are impossibly large", "in this scene")),
        }
        let tiles = file.tiles.map(|tiles| {
            let mut sets = BTreeMap::new();
            for (places, count) in tiles.sets {
                let set: Option<Vec<usize>> = places.iter().map(|place| listed.get(*place).copied()).collect();
                let mut set = set
                    .ok_or_else(|| self.error(file.name, "a tile names a state that is not listed", "in this scene"))?;
                set.sort_unstable();
                set.dedup();
                sets.insert(set, count);
            }
            Ok(Tiles { width: tiles.width, height: tiles.height, sets, others: tiles.others })
        });
        Ok(Scene {
            name: name.to_owned(),
            technique: file.technique.0.to_owned(),
            setting: file.setting.0.to_owned(),
            weight: file.weight,
            states,
            cases,
            tiles: tiles.transpose()?,
        })
    }
}

/// A profile as the text of a file.
pub fn to_ron(profile: &Profile) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write(profile, &mut out);
    out
}

fn write(profile: &Profile, out: &mut String) -> std::fmt::Result {
    writeln!(out, "Profile(\n    version: {VERSION},\n    table: {},", quoted(&profile.table))?;
    writeln!(out, "    fingerprint: {},\n    inputs: [", quoted(&profile.fingerprint))?;
    for input in &profile.inputs {
        let levels: Vec<String> = input.levels.iter().map(|level| quoted(level)).collect();
        writeln!(out, "        ({}, [{}]),", quoted(&input.name), levels.join(", "))?;
    }
    out.push_str("    ],\n    scenes: [\n");
    for scene in &profile.scenes {
        writeln!(out, "        Scene(\n            name: {},", quoted(&scene.name))?;
        writeln!(out, "            technique: {},", quoted(&scene.technique))?;
        writeln!(out, "            setting: {},", quoted(&scene.setting))?;
        writeln!(out, "            weight: {:?},\n            states: [", scene.weight)?;
        for (state, count) in &scene.states {
            writeln!(out, "                ({}, {count}),", quoted(&profile.words(*state)))?;
        }
        out.push_str("            ],\n            cases: [");
        let cases = scene.cases.iter().filter_map(|(case, count)| Some(format!("({}, {count})", (*case)?)));
        out.push_str(&cases.collect::<Vec<_>>().join(", "));
        let default = scene.cases.get(&None).copied().unwrap_or(0);
        writeln!(out, "],\n            default: {default},")?;
        if let Some(tiles) = &scene.tiles {
            let place: BTreeMap<usize, usize> = scene.states.keys().copied().zip(0..).collect();
            out.push_str("            // Sets of states (by their place above) that occur together in a tile.\n");
            let (width, height) = (tiles.width, tiles.height);
            write!(
                out,
                "            tiles: Tiles(width: {width}, height: {height}, others: {}, sets: [",
                tiles.others
            )?;
            let set = |(set, count): (&Vec<usize>, &u64)| {
                let places = set.iter().filter_map(|state| place.get(state)).map(ToString::to_string);
                format!("([{}], {count})", places.collect::<Vec<_>>().join(","))
            };
            let sets: Vec<String> = tiles.sets.iter().map(set).collect();
            for line in sets.chunks(8) {
                write!(out, "\n                {},", line.join(", "))?;
            }
            out.push_str("\n            ]),\n");
        }
        out.push_str("        ),\n");
    }
    out.push_str("    ],\n)\n");
    Ok(())
}

/// A text as RON without escapes; what would need one is replaced.
fn quoted(text: &str) -> String {
    let plain = text.chars().map(|c| if c.is_control() || matches!(c, '"' | '\\') { '_' } else { c });
    format!("\"{}\"", plain.collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::super::Frame;
    use super::super::tests::{scene, smsr};
    use super::*;

    fn some() -> Profile {
        let mut profile = Profile::new(&smsr());
        profile.scenes.push(scene("fence", &[(1, 10), (200, 30)], &[(Some(1), 35), (None, 5)]));
        let states = [Some(4), Some(5), None, Some(4)];
        let cases = [Some(1), Some(2), None, Some(1)];
        let frame = Frame { width: 2, states: &states, cases: &cases };
        profile.scenes.push(Scene::of_frame("lattice", "smsr", "2x2", frame));
        profile.scenes[1].weight = 0.5;
        profile
    }

    fn message(text: &str) -> String {
        let failure = parse(&Source::new("p.ron", text)).expect_err("wrong");
        let diagnostic = &failure.diagnostics[0];
        let place = diagnostic.labels.first().map_or(String::new(), |label| {
            let (line, column) = failure.source.line_column(label.span.start);
            format!("{line}:{column}: ")
        });
        format!("{place}{}", diagnostic.message)
    }

    #[test]
    fn what_is_written_is_read_back() {
        let text = to_ron(&some());
        let back = parse(&Source::new("p.ron", &*text)).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(back, some());
        assert_eq!(to_ron(&back), text);
    }

    #[test]
    fn what_is_cut_off_is_refused() {
        let text = to_ron(&some());
        for end in (0..text.len() - 2).step_by(7) {
            assert!(parse(&Source::new("p.ron", &text[..end])).is_err(), "cut after {end} bytes");
        }
    }

    #[test]
    fn mistakes_are_shown_where_they_stand() {
        let text = to_ron(&some());
        assert_eq!(
            message(&text.replacen("(\"none none", "(\"none nothing", 1)),
            "20:19: this is no state: not a level of `V`: none, top, bottom, both"
        );
        assert_eq!(
            message(&text.replacen(", 30)", ", 31)", 1)),
            "15:20: the states of `fence` count 41 evaluations, its cases 40"
        );
        assert_eq!(
            message(&text.replacen(", 30)", ", 18446744073709551615)", 1)),
            "15:20: the counts are impossibly large"
        );
        assert_eq!(
            message(&text.replacen("weight: 1.0", "weight: -1.0", 1)),
            "15:20: the weight of `fence` is -1, a number from 0 on was expected"
        );
        assert_eq!(
            message(&text.replacen("version: 1", "version: 7", 1)),
            "is a profile of version 7, and this umbrage reads version 1"
        );
        assert_eq!(message("Table()"), "1:1: this is not a profile: Expected struct `Profile` but found `Table`");
        let many = format!("(\"H\", [{}]),", "\"a\", ".repeat(60)).repeat(8);
        let hostile = format!("Profile(version: 1, table: \"t\", fingerprint: \"\", inputs: [{many}], scenes: [])");
        assert_eq!(message(&hostile), "1:29: the inputs have more combinations than any table");
        let deep = "[".repeat(100_000);
        assert!(message(&format!("Profile(version: 1, table: {deep}")).contains("this is not a profile"));
    }
}
