//! Kills commands at random moments and looks at what they leave behind.
//!
//! A command that writes files has an old set of them and a new one. However it ends, its
//! files are the old set or the new one, and the next command in that directory leaves
//! nothing else beside them. Each trial puts the old set in place, starts the command,
//! kills it (`SIGKILL`) at a moment drawn from the time that it takes, and runs it once
//! more to its end, in every second trial as it was for the old set.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::thread;
use std::time::Instant;

use super::Result;

/// The files that a journal names are being put in place: the next command does the rest.
const COMPLETE: &str = ".umbrage-complete";

/// What a directory holds: names and contents.
type Files = BTreeMap<PathBuf, Vec<u8>>;

/// A command that writes files, in two versions with different results.
struct Subject {
    name: &'static str,
    /// The arguments for the old files and for the new ones.
    arguments: [&'static [&'static str]; 2],
    /// Files that are put in place before, for the old files and for the new ones: paths in the
    /// directory of the trial, with their contents.
    before: [Vec<(&'static str, String)>; 2],
}

/// How the trials of a command ended.
#[derive(Default)]
struct Tally {
    finished: usize,
    old: usize,
    new: usize,
    in_between: usize,
    mixed: usize,
    litter: usize,
    not_mended: usize,
}

/// Kills each command `times` times.
///
/// # Errors
/// With 1 where a command left a mixed set, or litter that its next run did not remove.
pub(super) fn run(root: &Path, program: &Path, times: usize, seed: u64) -> Result {
    let mut random = seed | 1;
    let mut bad = false;
    println!(
        "{:<8} {:>8} {:>9} {:>6} {:>6} {:>11} {:>6} {:>7} {:>11}",
        "command", "kills", "too late", "old", "new", "to be ended", "mixed", "litter", "not mended"
    );
    for subject in subjects(root).map_err(|error| failed("the tables cannot be read", &error))? {
        let tally = subject
            .trials(program, times, &mut random)
            .map_err(|error| failed(&format!("`{}` cannot be tried", subject.name), &error))?;
        let Tally { finished, old, new, in_between, mixed, litter, not_mended } = tally;
        println!(
            "{:<8} {times:>8} {finished:>9} {old:>6} {new:>6} {in_between:>11} {mixed:>6} {litter:>7} {not_mended:>11}",
            subject.name
        );
        bad |= mixed + litter + not_mended > 0;
    }
    if bad { Err(1) } else { Ok(()) }
}

fn failed(what: &str, error: &io::Error) -> u8 {
    eprintln!("error: {what}: {error}");
    1
}

/// The commands that write, with what they need.
fn subjects(root: &Path) -> io::Result<Vec<Subject>> {
    let table = fs::read_to_string(root.join("tables/smsr.ron"))?;
    // Another table of the same name: its default is another number.
    let changed = table.replacen("\n    default: 1,", "\n    default: 0.5,", 1);
    let scene = fs::read_to_string(root.join("scenes/slope.ron"))?;
    let profile = fs::read_to_string(root.join("profiles/smsr.ron"))?;
    let tables = |text: &str| vec![("tables/smsr.ron", text.to_owned())];
    let profiled = |text: &str| vec![("tables/smsr.ron", text.to_owned()), ("smsr.ron", profile.clone())];
    Ok(vec![
        Subject { name: "build", arguments: [&["build"], &["build"]], before: [tables(&table), tables(&changed)] },
        Subject {
            name: "fmt",
            arguments: [&["fmt"], &["fmt"]],
            before: [tables(&table), tables(&changed.replace(", ", ","))],
        },
        Subject {
            name: "render",
            arguments: [
                &[
                    "render",
                    "--scene",
                    "s.ron",
                    "--size",
                    "32x18",
                    "--backend",
                    "cpu",
                    "-o",
                    "p.png",
                    "--capture",
                    "c.bin",
                ],
                &[
                    "render",
                    "--scene",
                    "s.ron",
                    "--size",
                    "48x27",
                    "--backend",
                    "cpu",
                    "-o",
                    "p.png",
                    "--capture",
                    "c.bin",
                ],
            ],
            before: [vec![("s.ron", scene.clone())], vec![("s.ron", scene)]],
        },
        Subject {
            name: "tune",
            arguments: [
                &["tune", "tables/smsr.ron", "--profile", "smsr.ron", "--rows", "256", "--rounds", "1"],
                &["tune", "tables/smsr.ron", "--profile", "smsr.ron", "--rows", "512", "--rounds", "1"],
            ],
            before: [profiled(&table), profiled(&table)],
        },
    ])
}

impl Subject {
    fn trials(&self, program: &Path, times: usize, random: &mut u64) -> io::Result<Tally> {
        let place = std::env::temp_dir().join(format!("umbrage-kill-{}-{}", self.name, std::process::id()));
        let result = self.trials_in(&place, program, times, random);
        fs::remove_dir_all(&place)?;
        result
    }

    fn trials_in(&self, place: &Path, program: &Path, times: usize, random: &mut u64) -> io::Result<Tally> {
        let old = self.result(place, program, &Files::new(), 0)?;
        let start = Instant::now();
        let new = self.result(place, program, &old, 1)?;
        let takes = start.elapsed();
        let mut tally = Tally::default();
        for trial in 0..times {
            restore(place, &old)?;
            self.prepare(place, 1)?;
            let before = files(place)?;
            let mut child = self.command(place, program, 1).stderr(Stdio::null()).spawn()?;
            // Also a little after its usual end.
            thread::sleep(takes.mul_f64(1.1 * uniform(random)));
            tally.finished += usize::from(child.try_wait()?.is_some());
            child.kill()?;
            child.wait()?;
            let found = files(place)?;
            let visible = without_hidden(&found);
            if self.same(&visible, &new) {
                tally.new += 1;
            } else if self.same(&visible, &before) {
                tally.old += 1;
            } else if found.keys().any(|path| path.ends_with(COMPLETE)) {
                tally.in_between += 1;
            } else {
                tally.mixed += 1;
            }
            let version = trial % 2;
            self.prepare(place, version)?;
            self.command(place, program, version).stderr(Stdio::null()).status()?;
            let after = files(place)?;
            tally.litter += usize::from(without_hidden(&after).len() != after.len());
            tally.not_mended += usize::from(!self.same(&after, [&old, &new][version]));
        }
        Ok(tally)
    }

    /// Compares what a directory holds. Tuned choices contain times, so of them only that they are there and whole.
    fn same(&self, found: &Files, expected: &Files) -> bool {
        let equal = |(path, bytes): (&PathBuf, &Vec<u8>)| match path.starts_with("tuned") {
            true => bytes.ends_with(b")\n"),
            false => expected.get(path) == Some(bytes),
        };
        found.keys().eq(expected.keys()) && found.iter().all(equal)
    }

    /// The files after a run to its end.
    fn result(&self, place: &Path, program: &Path, before: &Files, version: usize) -> io::Result<Files> {
        restore(place, before)?;
        self.prepare(place, version)?;
        let output = self.command(place, program, version).output()?;
        if !output.status.success() {
            return Err(io::Error::other(String::from_utf8_lossy(&output.stderr).into_owned()));
        }
        files(place)
    }

    fn prepare(&self, place: &Path, version: usize) -> io::Result<()> {
        for (name, contents) in &self.before[version] {
            let path = place.join(name);
            fs::create_dir_all(path.parent().unwrap_or(place))?;
            fs::write(path, contents)?;
        }
        Ok(())
    }

    fn command(&self, place: &Path, program: &Path, version: usize) -> Command {
        let mut command = Command::new(program);
        command.args(self.arguments[version]).current_dir(place);
        command.stdin(Stdio::null()).stdout(Stdio::null());
        command
    }
}

/// The files that have no hidden name.
fn without_hidden(files: &Files) -> Files {
    let hidden = |path: &Path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.'));
    files.iter().filter(|(path, _)| !hidden(path)).map(|(path, bytes)| (path.clone(), bytes.clone())).collect()
}

/// All files below a directory.
fn files(place: &Path) -> io::Result<Files> {
    let (mut found, mut open) = (Files::new(), vec![place.to_owned()]);
    while let Some(directory) = open.pop() {
        for entry in fs::read_dir(directory)? {
            let path = entry?.path();
            if path.is_dir() {
                open.push(path);
            } else {
                let name = path.strip_prefix(place).unwrap_or(&path).to_owned();
                found.insert(name, fs::read(&path)?);
            }
        }
    }
    Ok(found)
}

/// Makes a directory hold these files and no others.
fn restore(place: &Path, files: &Files) -> io::Result<()> {
    if place.exists() {
        fs::remove_dir_all(place)?;
    }
    fs::create_dir_all(place)?;
    for (name, contents) in files {
        let path = place.join(name);
        fs::create_dir_all(path.parent().unwrap_or(place))?;
        fs::write(path, contents)?;
    }
    Ok(())
}

/// A number from 0 to 1; xorshift, as moments need not be any better than that.
fn uniform(state: &mut u64) -> f64 {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    (*state >> 11) as f64 / (1_u64 << 53) as f64
}
