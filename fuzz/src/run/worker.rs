//! The process in which cases are judged: says each by its number before it begins.
//!
//! It writes a JSON array a line: `["case", 7]`, `["fault", 7, kind, detail]`, `["stuck", 7, part]`,
//! `["count", what, number]`. Whoever started it reads them, and knows what it was at if it ends badly.

use std::collections::BTreeSet;
use std::io::{self, Write};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};

use serde_json::json;

use super::kept;
use crate::choices::{Choices, bytes_of};
use crate::judge::{Court, Fault, LIMIT, Tally, clock};
use crate::targets::{self, Case, Target};

/// What cases are counted as.
pub(crate) const CASES: &str = "cases";

/// The time of the processor after which a part of a case is given up.
const GIVEN_UP: Duration = Duration::from_secs(5 * LIMIT.as_secs());

/// Arguments of a process.
#[derive(clap::Args)]
pub(crate) struct Arguments {
    /// The target
    target: String,
    #[arg(long)]
    seed: u64,
    /// The first number
    #[arg(long)]
    from: u64,
    /// The distance to the next one
    #[arg(long)]
    step: u64,
    /// The number to stop before
    #[arg(long, default_value_t = u64::MAX)]
    until: u64,
    /// Milliseconds after which no further case begins
    #[arg(long)]
    time: Option<u64>,
}

/// The case that is judged.
static NUMBER: AtomicU64 = AtomicU64::new(0);

/// Makes a case.
pub(crate) fn case(target: &Target, seed: u64, number: u64) -> Case {
    (target.make)(&mut Choices::new(&bytes_of(seed, target.name, number)))
}

fn line(value: &serde_json::Value) {
    // Whoever reads it has gone if this fails, and nobody is left to be told.
    let _ = writeln!(io::stdout().lock(), "{value}");
}

/// Ends the process if a part of a case does not end.
fn watch() {
    std::thread::spawn(|| {
        loop {
            std::thread::sleep(Duration::from_millis(250));
            if let Some(part) = clock::stuck(GIVEN_UP) {
                line(&json!(["stuck", NUMBER.load(Ordering::Relaxed), part]));
                std::process::exit(3);
            }
        }
    });
}

/// Judges cases one after the other.
pub(crate) fn run(arguments: &Arguments) -> super::Result<bool> {
    let target = targets::named(&arguments.target).ok_or("there is no such target")?;
    clock::catch_panics();
    watch();
    let start = Instant::now();
    let mut tally = Tally::new();
    let mut told: BTreeSet<String> = BTreeSet::new();
    let mut number = arguments.from;
    let place = Place::new()?;
    while number < arguments.until && arguments.time.is_none_or(|time| start.elapsed() < Duration::from_millis(time)) {
        NUMBER.store(number, Ordering::Relaxed);
        line(&json!(["case", number]));
        let mut court = Court::new(place.path());
        let made = court.part("make", |_| case(target, arguments.seed, number));
        if let Some(case) = made {
            judge(&mut court, target, &case, &place);
        }
        *tally.entry(CASES.to_owned()).or_default() += 1;
        for (what, count) in std::mem::take(&mut court.tally) {
            *tally.entry(what).or_default() += count;
        }
        for Fault { kind, detail } in court.faults {
            *tally.entry("faults".to_owned()).or_default() += 1;
            // Details of the first of a kind are enough.
            let detail = if told.insert(kind.clone()) { detail } else { String::new() };
            line(&json!(["fault", number, kind, detail]));
        }
        number = number.saturating_add(arguments.step);
        if tally.get(CASES).is_some_and(|cases| cases % 64 == 0) {
            tell(&mut tally);
        }
    }
    tell(&mut tally);
    Ok(true)
}

fn tell(tally: &mut Tally) {
    for (what, count) in std::mem::take(tally) {
        line(&json!(["count", what, count]));
    }
}

/// Judges one case that lies in a directory.
pub(crate) fn attempt(directory: &Path) -> super::Result<bool> {
    let (target, case) = kept::read(directory)?;
    clock::catch_panics();
    watch();
    let place = Place::new()?;
    let mut court = Court::new(place.path());
    judge(&mut court, target, &case, &place);
    for Fault { kind, detail } in court.faults {
        line(&json!(["fault", 0, kind, detail]));
    }
    Ok(true)
}

/// Judges a case in an empty directory that holds its files.
fn judge(court: &mut Court<'_>, target: &Target, case: &Case, place: &Place) {
    match place.fill(case) {
        Ok(()) => (target.judge)(court, case),
        Err(error) => court.fault("the files of the case cannot be written", error.to_string()),
    }
    clock::leave();
}

/// A directory of this process, emptied for each case.
struct Place(tempfile::TempDir);

impl Place {
    fn new() -> super::Result<Self> {
        // In memory where the system has such a place.
        let memory = Path::new("/dev/shm");
        let made = if memory.is_dir() { tempfile::tempdir_in(memory) } else { tempfile::tempdir() };
        made.or_else(|_| tempfile::tempdir()).map(Self).map_err(|error| format!("no temporary directory: {error}"))
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn fill(&self, case: &Case) -> io::Result<()> {
        for entry in self.path().read_dir()? {
            let path = entry?.path();
            if path.is_dir() { std::fs::remove_dir_all(path)? } else { std::fs::remove_file(path)? }
        }
        case.files.iter().try_for_each(|(name, bytes)| std::fs::write(self.path().join(name), bytes))
    }
}
