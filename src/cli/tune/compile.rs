//! Compiling a plan in a process of its own, which is ended if it takes too long.
//!
//! What a driver compiles cannot be interrupted, and takes more and more memory while it
//! does not come to an end. So before a plan is measured, this program is called to compile
//! it; only what it did in time is then compiled here.

use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use super::Arguments;
use crate::tune::Candidate;

/// Time between two looks at the other process.
const PAUSE: Duration = Duration::from_millis(10);

/// Tries to compile a plan, with so many rows for each thread.
///
/// # Errors
/// With the reason, if it takes too long, or the driver fails at it. If no process can be started, the plan is taken
/// for one that compiles.
pub(super) fn within_limit(arguments: &Arguments, candidate: Candidate, rows_of_thread: u32) -> Result<(), String> {
    let Ok(program) = std::env::current_exe() else { return Ok(()) };
    let mut command = Command::new(program);
    // The table was read already, from wherever it comes.
    command.args(["tune", "--allow-outside", "--only-compile"]).arg(&arguments.table);
    for profile in &arguments.profile {
        command.arg("--profile").arg(profile);
    }
    command.args(["--adapter", &arguments.adapter.to_string(), "--plan", candidate.shape.name()]);
    command.args(["--rows-of-thread", &rows_of_thread.to_string()]);
    if candidate.assume {
        command.arg("--assume");
    }
    let quiet = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    let Ok(mut child) = quiet.spawn() else { return Ok(()) };
    let (start, limit) = (Instant::now(), Duration::from_secs_f64(arguments.compile_limit));
    loop {
        match child.try_wait() {
            // A failure shows here, too, and is then told in full. But what ends the process must not end this one.
            Ok(Some(status)) if status.code().is_some() => return Ok(()),
            Ok(Some(status)) => return Err(format!("the driver ends the process that compiles it ({status})")),
            Ok(None) if start.elapsed() < limit => std::thread::sleep(PAUSE),
            Ok(None) | Err(_) => {
                // It has ended, or is ended; there is nothing else to be done about it.
                let _ = child.kill();
                let _ = child.wait();
                return Err(format!("compiling takes longer than {} s", arguments.compile_limit));
            }
        }
    }
}
