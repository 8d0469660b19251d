//! Cases as directories: their files, what judges them, and what was found.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};

use super::child::Found;
use super::{Result, worker};
use crate::targets::{self, Case, Target};

/// The file that says what the others are.
const ABOUT: &str = "case.json";

/// Writes a case.
pub(super) fn write(directory: &Path, target: &Target, case: &Case) -> Result<()> {
    let failed = |error: std::io::Error| format!("{} cannot be written: {error}", directory.display());
    std::fs::create_dir_all(directory).map_err(failed)?;
    let names: Vec<&str> = case.files.iter().map(|(name, _)| name.as_str()).collect();
    let about = json!({"target": target.name, "seed": case.seed.to_string(), "files": names});
    std::fs::write(directory.join(ABOUT), format!("{about}\n")).map_err(failed)?;
    case.files.iter().try_for_each(|(name, bytes)| std::fs::write(directory.join(name), bytes)).map_err(failed)
}

/// Reads a case.
pub(super) fn read(directory: &Path) -> Result<(&'static Target, Case)> {
    let wrong = |what: &str| format!("{}: {what}", directory.display());
    let text = std::fs::read_to_string(directory.join(ABOUT)).map_err(|error| wrong(&format!("no case: {error}")))?;
    let about: Value = serde_json::from_str(&text).map_err(|error| wrong(&error.to_string()))?;
    let target = about["target"].as_str().and_then(targets::named).ok_or_else(|| wrong("of no target"))?;
    let seed = about["seed"].as_str().and_then(|seed| seed.parse().ok()).ok_or_else(|| wrong("without a seed"))?;
    let names = about["files"].as_array().ok_or_else(|| wrong("without files"))?;
    let mut files = Vec::new();
    for name in names.iter().filter_map(Value::as_str) {
        let bytes = std::fs::read(directory.join(name)).map_err(|error| wrong(&format!("{name}: {error}")))?;
        files.push((name.to_owned(), bytes));
    }
    Ok((target, Case { files, seed }))
}

/// Keeps the case of a fault, made small if it could be.
pub(super) fn keep(directory: &Path, found: &Found, small: Option<&Case>) -> Result<PathBuf> {
    let word = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
    let mut slug: String = format!("{}-{}", found.target.name, found.fault.kind).chars().map(word).take(80).collect();
    while slug.contains("--") {
        slug = slug.replace("--", "-");
    }
    let place = directory.join(slug.trim_matches('-'));
    let whole = worker::case(found.target, found.seed, found.number);
    write(&place, found.target, small.unwrap_or(&whole))?;
    let text = format!(
        "{}\n\nfound {} times, first in case {} of seed {}\n\n{}\n\ncargo xtask fuzz replay {}\ncargo xtask fuzz show {} --seed {} --number {}\n",
        found.fault.kind,
        found.times,
        found.number,
        found.seed,
        found.fault.detail,
        place.display(),
        found.target.name,
        found.seed,
        found.number
    );
    std::fs::write(place.join("fault.txt"), text)
        .map_err(|error| format!("{} cannot be written: {error}", place.display()))?;
    Ok(place)
}
