//! The wishes of a client, and its abilities, as it introduces itself.

use std::path::PathBuf;

use lsp_types::InitializeParams;
use serde::Deserialize;

use super::place::{self, Encoding};
use crate::analyse::{LintLevel, LintLevels};

/// The options that editors pass on to this server; all of them may be left out.
#[derive(Debug, Default, Deserialize)]
#[serde(default)]
struct Options {
    /// True to show pictures of cases: by default where the client is known to show them.
    pictures: Option<bool>,
    /// Levels of findings by their codes: `allow`, `warn` or `deny`.
    levels: std::collections::BTreeMap<String, String>,
    /// The directory of profiles: by default `profiles` beside or above a table.
    profiles: Option<PathBuf>,
}

/// The settings that all answers depend on.
#[derive(Debug, Clone)]
pub(super) struct Settings {
    pub(super) encoding: Encoding,
    /// True if pictures are put into what is shown of cases.
    pub(super) pictures: bool,
    /// True if what is completed may have places to go on at.
    pub(super) snippets: bool,
    pub(super) levels: LintLevels,
    /// The directory of profiles, if it was named.
    pub(super) profiles: Option<PathBuf>,
    /// The directories that the editor has open.
    pub(super) roots: Vec<PathBuf>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            encoding: Encoding::Utf16,
            pictures: false,
            snippets: false,
            levels: LintLevels::default(),
            profiles: None,
            roots: Vec::new(),
        }
    }
}

/// Editors that show pictures in Markdown, by the beginning of the names that they give themselves.
const SHOW_PICTURES: [&str; 4] = ["Visual Studio Code", "VSCodium", "Code - OSS", "Cursor"];

impl Settings {
    /// Reads what a client says, and returns what of it is wrong, in words.
    pub(super) fn of(params: &InitializeParams) -> (Self, Vec<String>) {
        let mut wrong = Vec::new();
        let options = params.initialization_options.clone().map(serde_json::from_value::<Option<Options>>);
        let options = options.and_then(|read| read.map_err(|error| wrong.push(format!("options: {error}"))).ok());
        let options = options.flatten().unwrap_or_default();
        let general = params.capabilities.general.as_ref();
        let encodings = general.and_then(|general| general.position_encodings.as_deref()).unwrap_or_default();
        let editor = params.client_info.as_ref().map_or("", |client| client.name.as_str());
        let completion = params.capabilities.text_document.as_ref().and_then(|text| text.completion.as_ref());
        let item = completion.and_then(|completion| completion.completion_item.as_ref());
        let mut levels = LintLevels::default();
        for (code, level) in &options.levels {
            let level = match level.as_str() {
                "allow" => LintLevel::Allow,
                "warn" => LintLevel::Warn,
                "deny" => LintLevel::Deny,
                _ => {
                    wrong.push(format!("options: the level of {code} is allow, warn or deny, not `{level}`"));
                    continue;
                }
            };
            if let Err(reason) = levels.set(code, level) {
                wrong.push(format!("options: {reason}"));
            }
        }
        let folders = params.workspace_folders.iter().flatten().filter_map(|folder| place::path(&folder.uri));
        let settings = Self {
            encoding: match encodings.contains(&lsp_types::PositionEncodingKind::UTF8) {
                true => Encoding::Utf8,
                false => Encoding::Utf16,
            },
            pictures: options.pictures.unwrap_or_else(|| SHOW_PICTURES.iter().any(|name| editor.starts_with(name))),
            snippets: item.and_then(|item| item.snippet_support).unwrap_or(false),
            levels,
            profiles: options.profiles,
            roots: folders.collect(),
        };
        (settings, wrong)
    }
}
