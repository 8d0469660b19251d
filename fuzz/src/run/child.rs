//! Processes from outside: started within bounds, read line by line, started again when they end badly.

use std::io::{BufRead, BufReader, Read};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use serde_json::Value;

use super::{Result, kept};
use crate::command::this_executable;
use crate::judge::{Fault, Tally};
use crate::targets::{Case, Target};

/// The most memory that a process may use, in KiB.
const MEMORY: u64 = 3 << 20;

/// How far to go.
#[derive(Debug, Clone, Copy)]
pub(super) enum Extent {
    Time(Duration),
    Cases(u64),
}

/// A fault with the case in which it was found.
#[derive(Clone)]
pub(super) struct Found {
    pub(super) target: &'static Target,
    pub(super) seed: u64,
    pub(super) number: u64,
    pub(super) fault: Fault,
    /// How often it was found.
    pub(super) times: u64,
}

/// This executable with arguments, with bounded memory where the system's shell can do that.
fn bounded(arguments: &[String]) -> Result<Command> {
    let failed = |error: std::io::Error| format!("this executable cannot be found: {error}");
    let mut command = if cfg!(unix) {
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("ulimit -v {MEMORY} 2>/dev/null; exec \"$0\" \"$@\"")]);
        shell.arg(std::env::current_exe().map_err(failed)?);
        shell
    } else {
        this_executable("umbrage-fuzz").map_err(failed)?
    };
    command.args(arguments).stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped());
    Ok(command)
}

/// What a process said, and how it ended.
struct Ended {
    /// The number of the case that it was at.
    at: Option<u64>,
    faults: Vec<(u64, Fault)>,
    tally: Tally,
    /// The fault that ended it.
    badly: Option<Fault>,
}

fn follow(mut command: Command) -> Result<Ended> {
    let mut child = command.spawn().map_err(|error| format!("no process can be started: {error}"))?;
    let mut ended = Ended { at: None, faults: Vec::new(), tally: Tally::new(), badly: None };
    let errors = child.stderr.take();
    // Read beside, so that neither pipe is full while the other is waited for.
    let errors = std::thread::spawn(move || {
        let mut text = Vec::new();
        let _ = errors.map(|errors| errors.take(1 << 16).read_to_end(&mut text));
        String::from_utf8_lossy(&text).into_owned()
    });
    for line in child.stdout.take().into_iter().flat_map(|out| BufReader::new(out).lines()) {
        let Ok(line) = line else { break };
        let Ok(Value::Array(parts)) = serde_json::from_str::<Value>(&line) else { continue };
        let text = |place: usize| parts.get(place).and_then(Value::as_str).unwrap_or("").to_owned();
        let number = |place: usize| parts.get(place).and_then(Value::as_u64).unwrap_or(0);
        match text(0).as_str() {
            "case" => ended.at = Some(number(1)),
            "fault" => ended.faults.push((number(1), Fault { kind: text(2), detail: text(3) })),
            "count" => *ended.tally.entry(text(1)).or_default() += number(2),
            "stuck" => {
                ended.badly = Some(Fault { kind: format!("no end: {}", text(2)), detail: "was given up".to_owned() });
            }
            _ => {}
        }
    }
    let status = child.wait().map_err(|error| format!("a process was lost: {error}"))?;
    let said = errors.join().unwrap_or_default();
    if !status.success() && ended.badly.is_none() {
        let first = said.lines().find(|line| !line.trim().is_empty()).unwrap_or("").to_owned();
        let first = crate::judge::plans::alike(&first);
        ended.badly = Some(Fault { kind: format!("ends the process: {status}: {first}"), detail: said });
    }
    Ok(ended)
}

/// Runs the cases of one of several processes.
pub(super) fn run(
    target: &'static Target,
    seed: u64,
    (job, jobs): (u64, u64),
    extent: Extent,
) -> Result<(Tally, Vec<Found>)> {
    let start = Instant::now();
    let (mut tally, mut found) = (Tally::new(), Vec::new());
    let mut from = job;
    loop {
        let mut arguments = [
            "worker",
            target.name,
            "--seed",
            &seed.to_string(),
            "--from",
            &from.to_string(),
            "--step",
            &jobs.to_string(),
        ]
        .map(str::to_owned)
        .to_vec();
        match extent {
            Extent::Time(time) => {
                let left = time.saturating_sub(start.elapsed());
                if left.is_zero() {
                    break;
                }
                arguments.extend(["--time".to_owned(), left.as_millis().to_string()]);
            }
            Extent::Cases(cases) => arguments.extend(["--until".to_owned(), cases.to_string()]),
        }
        let ended = follow(bounded(&arguments)?)?;
        for (what, count) in ended.tally {
            *tally.entry(what).or_default() += count;
        }
        let of = |(number, fault)| Found { target, seed, number, fault, times: 0 };
        found.extend(ended.faults.into_iter().map(of));
        match (ended.badly, ended.at) {
            (Some(fault), Some(number)) => {
                found.push(of((number, fault)));
                from = number + jobs;
            }
            (Some(fault), None) => return Err(format!("{}\n{}", fault.kind, fault.detail)),
            (None, _) => break,
        }
    }
    Ok((tally, found))
}

/// Judges a case in a process of its own.
pub(super) fn attempt(target: &'static Target, case: &Case) -> Result<Vec<Fault>> {
    let place = tempfile::tempdir().map_err(|error| format!("no temporary directory: {error}"))?;
    kept::write(place.path(), target, case)?;
    let ended = follow(bounded(&["attempt".to_owned(), place.path().to_string_lossy().into_owned()])?)?;
    let faults = ended.faults.into_iter().map(|(_, fault)| fault);
    Ok(faults.chain(ended.badly).collect())
}
