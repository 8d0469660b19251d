//! The evidence that plans are made with: profiles, and the choices of `umbrage tune`.
//!
//! Unless something else is asked for, both lie beside the directory of the
//! tables: `profiles/smsr.ron` and `tuned/*.ron` for `tables/smsr.ron`.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::{Options, wanted};
use crate::diag::{Diagnostic, Failure, codes};
use crate::profile::{self, Profile};
use crate::program::Program;
use crate::text::file::{io_reason, shown};
use crate::tuned::{Auto, Fallback, Tuned, slug, tune};

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
    let read: Result<Vec<_>, _> = ron_files(directory)?.iter().map(|path| Tuned::read(path)).collect();
    Ok(read?.into_iter().flatten().collect())
}

/// The files of a directory that are named *.ron, sorted; none, if it is no directory.
fn ron_files(directory: &Path) -> Result<Vec<PathBuf>, Failure> {
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
    Ok(paths)
}

/// The choices that `auto` may follow.
#[derive(Debug, Clone)]
pub struct Choices {
    directory: PathBuf,
    device: Option<String>,
    all: Vec<Tuned>,
}

impl Choices {
    /// Reads a directory of choices. If a device is named, only those that were made there are followed.
    ///
    /// # Errors
    /// As [`tuned_in`].
    pub fn read(directory: &Path, device: Option<&str>) -> Result<Self, Failure> {
        let all = tuned_in(directory)?;
        Ok(Self { directory: directory.to_owned(), device: device.map(str::to_owned), all })
    }

    /// Those that are followed.
    pub fn followed(&self) -> impl Iterator<Item = &Tuned> {
        let here = |tuned: &&Tuned| self.device.as_ref().is_none_or(|device| slug(device) == slug(&tuned.device));
        self.all.iter().filter(here)
    }

    /// The warnings about a table: choices that are not used, and a device on which nothing was tuned.
    pub fn unused(&self, program: &Program) -> Vec<Diagnostic> {
        let instead = Auto::of(program, None).shape;
        let unused = |tuned: &Tuned| tuned.choice(program).err()?.diagnostic(program, instead, &self.directory);
        let mut said: Vec<Diagnostic> = self.followed().filter_map(unused).collect();
        let untuned = |tuned: &Tuned| tuned.choice(program) == Err(Fallback::Untuned);
        if let (Some(device), true) = (&self.device, self.followed().all(untuned)) {
            let message = format!("nothing was tuned for `{}` on `{device}`; `auto` is `{instead}`", program.name);
            let others = self.all.iter().filter(|tuned| tuned.choice(program).is_ok()).map(|tuned| slug(&tuned.device));
            let others: Vec<String> = others.collect();
            let mut warning =
                Diagnostic::warning(codes::OLD_TUNED, message).help(tune(program, device, &self.directory));
            if !others.is_empty() {
                warning = warning.help(format!("it was tuned on: {}", others.join(", ")));
            }
            said.push(warning);
        }
        said
    }
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
            Failure::bare(name.clone(), error.help("count both with the same table"))
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
    Ok(fitted.lost.into_iter().collect())
}

/// The warning about a profile that lies where that of a table is looked for, and counts another one.
pub fn misplaced(table: &str, (path, profile): &NamedProfile) -> Option<Diagnostic> {
    if profile.table == table {
        return None;
    }
    let right = path.with_file_name(format!("{}.ron", profile.table));
    let (name, other) = (shown(path), &profile.table);
    let message = format!("{name}: is a profile of the table `{other}`, not of `{table}`, and is not used");
    let warning = Diagnostic::warning(codes::OLD_PROFILE, message);
    Some(match right.exists() {
        true => warning.help(format!("remove it, `rm {name}`: `{other}` has {}", shown(&right))),
        false => warning.help(format!("name it like its table: `mv {name} {}`", shown(&right))),
    })
}

/// The warnings about profiles in a directory that are called like none of the tables.
///
/// # Errors
/// When the directory cannot be read.
pub fn orphans(directory: &Path, tables: &BTreeSet<String>) -> Result<Vec<Diagnostic>, Failure> {
    let orphan = |path: PathBuf| {
        let table = path.file_stem()?.to_str()?;
        (!tables.contains(table)).then(|| {
            let name = shown(&path);
            let warning =
                Diagnostic::warning(codes::OLD_PROFILE, format!("{name}: there is no table `{table}`; it is not used"));
            warning.help(format!("name it like the table that it counts, or remove it: `rm {name}`"))
        })
    };
    Ok(ron_files(directory)?.into_iter().filter_map(orphan).collect())
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
