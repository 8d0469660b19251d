//! The evidence that plans are made with: profiles, and the choices of `umbrage tune`.
//!
//! Unless something else is asked for, both lie beside the directory of the
//! tables: `profiles/smsr.ron` and `tuned/*.ron` for `tables/smsr.ron`.

use std::path::{Path, PathBuf};

use super::{Options, wanted};
use crate::diag::{Diagnostic, Failure, codes};
use crate::profile::{self, Profile};
use crate::program::Program;
use crate::text::file::{io_reason, shown};
use crate::tuned::Tuned;

/// A profile and the name of its file.
pub type NamedProfile = (PathBuf, Profile);

/// The directory with a name beside a directory of tables, or beside that of a
/// table file. `None` for a place without a name, such as `.`.
pub fn beside(tables: &Path, name: &str) -> Option<PathBuf> {
    let directory = if tables.is_dir() { tables } else { tables.parent()? };
    directory.file_name()?;
    Some(directory.parent()?.join(name))
}

/// The profile of a table in a directory: `<table>.ron`, if there is one.
///
/// # Errors
/// When there is one, but it cannot be read.
pub fn profile_of(table: &str, directory: &Path) -> Result<Option<NamedProfile>, Failure> {
    let path = directory.join(format!("{table}.ron"));
    if !path.exists() {
        return Ok(None);
    }
    let profile = profile::read(&path)?;
    Ok(Some((path, profile)))
}

/// The choices for every device that has a file in a directory, sorted by file name.
///
/// # Errors
/// When the directory or a file in it cannot be read.
pub fn tuned_in(directory: &Path) -> Result<Vec<Tuned>, Failure> {
    if !directory.is_dir() {
        return Ok(Vec::new());
    }
    let unreadable = |error: std::io::Error| {
        let message = format!("cannot be read: {}", io_reason(&error));
        let error = Diagnostic::error(codes::UNREADABLE, message).help("check its permissions");
        Failure::bare(shown(directory), error)
    };
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(directory).map_err(unreadable)? {
        let path = entry.map_err(unreadable)?.path();
        if path.extension().is_some_and(|extension| extension == "ron") {
            paths.push(path);
        }
    }
    paths.sort();
    let read: Result<Vec<_>, _> = paths.iter().map(|path| Tuned::read(path)).collect();
    Ok(read?.into_iter().flatten().collect())
}

/// Plans a table for its profiles, those of its own name, if there are any.
/// Returns what is to be said about them: warnings.
///
/// # Errors
/// When a profile does not fit the table, or has states that an assumption
/// excludes which a plan is to rely on.
pub fn weigh(program: &Program, profiles: &[NamedProfile], options: &mut Options) -> Result<Vec<Diagnostic>, Failure> {
    let mut merged: Option<(Vec<String>, Profile)> = None;
    for (path, profile) in profiles.iter().filter(|(_, profile)| profile.table == program.name) {
        let name = shown(path);
        let Some((names, all)) = &mut merged else {
            merged = Some((vec![name], profile.clone()));
            continue;
        };
        all.merge(profile, 1.0).map_err(|reason| {
            let message = format!("does not go with {}: {reason}", names.join(", "));
            let error = Diagnostic::error(codes::OTHER_PROFILE, message);
            Failure::bare(name.clone(), error.help("count both with the same text of the table"))
        })?;
        names.push(name);
    }
    let Some((names, profile)) = merged else { return Ok(Vec::new()) };
    let fitted = profile::fit(program, profile, &names.join(", "))?;
    // Generated files say where weights come from, but not on which machine.
    let files: Vec<&str> = names.iter().map(|name| name.rsplit('/').next().unwrap_or(name)).collect();
    let weights = fitted.weights(program, &format!("profile {}", files.join(", ")))?;
    options.weights.insert(program.name.clone(), weights);
    if wanted(program, options).iter().any(|plan| plan.assume) {
        let excluded: Vec<Diagnostic> =
            fitted.excluded(program).iter().map(|excluded| excluded.diagnostic(program)).collect();
        if !excluded.is_empty() {
            return Err(Failure { source: program.source.clone(), diagnostics: excluded });
        }
    }
    Ok(fitted.warning.into_iter().collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build;
    use crate::plan::Shape;
    use crate::tuned::Choice;

    fn smsr() -> Program {
        Program::read("tables/smsr.ron").unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn directories_lie_beside_the_tables() {
        let expected = Some(PathBuf::from("profiles"));
        assert_eq!(beside(Path::new("tables"), "profiles"), expected);
        assert_eq!(beside(Path::new("tables/smsr.ron"), "profiles"), expected);
        assert_eq!(beside(Path::new("."), "profiles"), None);
        assert_eq!(beside(Path::new("smsr.ron"), "profiles"), None);
    }

    #[test]
    fn a_profile_is_used_and_named() {
        let program = smsr();
        let mut options = Options { targets: vec![crate::emit::Target::Wgsl], ..Options::default() };
        let profile = profile_of("smsr", Path::new("profiles")).unwrap_or_else(|e| panic!("{e}"));
        let profiles: Vec<_> = profile.into_iter().collect();
        weigh(&program, &profiles, &mut options).unwrap_or_else(|e| panic!("{e}"));
        let built = build::table(&program, &options).unwrap_or_else(|e| panic!("{e}"));
        let text = |name: &str| {
            let file = built.files.iter().find(|file| file.path.ends_with(name)).expect("made");
            String::from_utf8_lossy(&file.contents).into_owned()
        };
        assert!(text("ordered.wgsl").contains("// Weight: profile smsr.ron, "));
        assert!(!text("ladder.wgsl").contains("// Weight:"), "nothing was weighed");
        assert!(profile_of("none", Path::new("profiles")).is_ok_and(|none| none.is_none()));
    }

    #[test]
    fn what_was_tuned_is_built_and_named() {
        let program = smsr();
        let mut tuned = Tuned::new("A device");
        tuned.set(Choice {
            table: "smsr".to_owned(),
            fingerprint: program.fingerprint(),
            plan: "tree".to_owned(),
            assume: false,
            profile: String::new(),
            umbrage: "0".to_owned(),
            method: String::new(),
            evidence: Vec::new(),
        });
        let directory = tempfile::tempdir().expect("a directory");
        std::fs::write(Tuned::path(directory.path(), "A device"), tuned.to_ron()).expect("written");
        let read = tuned_in(directory.path()).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!(read, [tuned]);
        let targets = vec![crate::emit::Target::Wgsl];
        let mut options = Options { shapes: vec![Shape::Ladder], targets, tuned: read, ..Options::default() };
        let plans = |options: &Options| -> Vec<String> {
            let built = build::table(&program, options).unwrap_or_else(|e| panic!("{e}"));
            assert!(
                built.files.iter().any(|file| String::from_utf8_lossy(&file.contents).contains("// Plan:   ladder"))
            );
            built.plans.into_iter().map(|plan| plan.name).collect()
        };
        assert_eq!(plans(&options), ["ladder", "tree"]);
        options.tuned.clear();
        assert_eq!(plans(&options), ["ladder", "switch"], "the default");
        assert!(tuned_in(Path::new("no/such/directory")).is_ok_and(|none| none.is_empty()));
    }
}
