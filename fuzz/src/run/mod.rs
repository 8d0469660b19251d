//! A run: targets in turn, on all cores, each case in a process that may end badly.

mod child;
mod kept;
mod shrink;
pub(crate) mod worker;

use std::collections::BTreeMap;
use std::path::PathBuf;
use std::sync::Mutex;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::Options;
use crate::corpus::{Family, package, paths};
use crate::judge::{Fault, Tally};
use crate::targets::{self, ALL, Case, Target};
use child::{Extent, Found};

/// Most kinds of faults of which reproducers are made small.
const KINDS: usize = 40;

type Result<T> = std::result::Result<T, String>;

/// Tries targets; true if there were no faults.
pub(crate) fn run(options: &Options) -> Result<bool> {
    let clock = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let seed = options.seed.unwrap_or(clock.as_secs() ^ u64::from(clock.subsec_nanos()));
    let jobs = options.jobs.unwrap_or_else(|| std::thread::available_parallelism().map_or(1, usize::from)).max(1);
    let chosen = chosen(&options.targets)?;
    let shares: u32 = chosen.iter().map(|target| target.share).sum();
    println!("seed {seed}, {jobs} processes at once");
    let mut found: BTreeMap<String, Found> = BTreeMap::new();
    for target in chosen {
        let share = f64::from(target.share) / f64::from(shares);
        let extent = match options.cases {
            Some(cases) => Extent::Cases(((cases as f64 * share).ceil() as u64).max(1)),
            None => Extent::Time(Duration::from_secs_f64((options.minutes * 60.0 * share).max(0.5))),
        };
        let start = Instant::now();
        let (tally, faults) = in_parallel(target, seed, jobs, extent)?;
        report(target, &tally, start.elapsed());
        for one in faults {
            let known = found.entry(format!("{}: {}", target.name, one.fault.kind)).or_insert_with(|| one.clone());
            known.times += 1;
        }
    }
    if found.is_empty() {
        println!("\nno faults");
        return Ok(true);
    }
    let directory = options.faults.clone().unwrap_or_else(|| package().join("faults"));
    println!("\n{} kinds of faults:", found.len());
    for (place, one) in found.values().enumerate() {
        let small = (!options.no_shrink && place < KINDS).then(|| shrink::shrink(one)).flatten();
        let kept = kept::keep(&directory, one, small.as_ref())?;
        println!("  {} times in {}: {}", one.times, one.target.name, one.fault.kind);
        println!("    case {} of seed {seed}, kept in {}", one.number, kept.display());
    }
    Ok(false)
}

/// The targets with these names; all of them if there are none.
fn chosen(names: &[String]) -> Result<Vec<&'static Target>> {
    if names.is_empty() {
        return Ok(ALL.iter().collect());
    }
    let known = || ALL.iter().map(|target| target.name).collect::<Vec<_>>().join(", ");
    names
        .iter()
        .map(|name| targets::named(name).ok_or_else(|| format!("there is no target `{name}`; there are: {}", known())))
        .collect()
}

/// Runs a target in several processes.
fn in_parallel(target: &'static Target, seed: u64, jobs: usize, extent: Extent) -> Result<(Tally, Vec<Found>)> {
    let all: Mutex<(Tally, Vec<Found>, Option<String>)> = Mutex::default();
    std::thread::scope(|scope| {
        for job in 0..jobs {
            let all = &all;
            scope.spawn(move || {
                let done = child::run(target, seed, (job as u64, jobs as u64), extent);
                let Ok(mut all) = all.lock() else { return };
                match done {
                    Ok((tally, mut faults)) => {
                        for (what, count) in tally {
                            *all.0.entry(what).or_default() += count;
                        }
                        all.1.append(&mut faults);
                    }
                    Err(message) => all.2 = Some(message),
                }
            });
        }
    });
    let (tally, mut faults, failed) = all.into_inner().unwrap_or_default();
    faults.sort_by_key(|found| found.number);
    failed.map_or(Ok((tally, faults)), Err)
}

fn report(target: &Target, tally: &Tally, time: Duration) {
    let cases = tally.get(worker::CASES).copied().unwrap_or(0);
    let each = if cases == 0 { 0.0 } else { cases as f64 / time.as_secs_f64() };
    println!("{:<12} {cases} {} in {:.0} s, {each:.1} a second", target.name, target.cases, time.as_secs_f64());
    let parts: Vec<String> = tally
        .iter()
        .filter(|(what, _)| *what != worker::CASES)
        .map(|(what, count)| format!("{count} {what}"))
        .collect();
    for line in parts.chunks(6) {
        println!("             {}", line.join(", "));
    }
}

/// Prints a case as it was made.
pub(crate) fn show(target: &str, seed: u64, number: u64) -> Result<bool> {
    let target = targets::named(target).ok_or("there is no such target")?;
    let case = worker::case(target, seed, number);
    for (name, bytes) in &case.files {
        println!("// {name}\n{}", String::from_utf8_lossy(bytes));
    }
    Ok(true)
}

/// Judges kept cases again; true if nothing is wrong with them any more.
pub(crate) fn replay(directories: &[PathBuf]) -> Result<bool> {
    let mut clean = true;
    for directory in directories {
        let (target, case) = kept::read(directory)?;
        let faults = child::attempt(target, &case)?;
        println!("{}: {} faults", directory.display(), faults.len());
        clean &= say(&faults);
    }
    Ok(clean)
}

fn say(faults: &[Fault]) -> bool {
    for fault in faults {
        println!("  {}\n    {}", fault.kind, fault.detail.replace('\n', "\n    "));
    }
    faults.is_empty()
}

/// Judges the files of the corpus as they are.
pub(crate) fn corpus() -> Result<bool> {
    let mut clean = true;
    let mut count = 0;
    for family in Family::ALL {
        let Some((target, name)) = judged_by(family) else { continue };
        for path in paths(family) {
            let bytes = std::fs::read(&path).map_err(|error| format!("{}: {error}", path.display()))?;
            let mut case = (target.make)(&mut crate::choices::Choices::new(&[]));
            let files = case.files.iter_mut().find(|(known, _)| known == name);
            if let Some((_, contents)) = files {
                *contents = bytes;
            }
            let faults = child::attempt(target, &Case { seed: 1, ..case })?;
            count += 1;
            if !faults.is_empty() {
                println!("{}:", path.display());
                clean &= say(&faults);
            }
        }
    }
    println!("{count} files of the corpus");
    Ok(clean)
}

/// The target that reads files of a kind, and the name that it gives them.
fn judged_by(family: Family) -> Option<(&'static Target, &'static str)> {
    let (target, name) = match family {
        Family::Ron => ("ron", "t.ron"),
        Family::Csv => ("csv", "rows.csv"),
        Family::Json => ("json", "rows.json"),
        Family::Capture => ("captures", "rows.bin"),
        Family::Profile => ("profiles", "p.ron"),
        Family::Tuned => ("tuned", "tuned.ron"),
        Family::Scene => ("scenes", "s.ron"),
        Family::Obj => ("obj", "m.obj"),
        Family::Gltf => ("gltf", "m.gltf"),
        Family::Glb => ("glb", "m.glb"),
        // Of an expression a table is made first; the target does that for each of them in turn.
        Family::Expression => return None,
    };
    targets::named(target).map(|target| (target, name))
}
