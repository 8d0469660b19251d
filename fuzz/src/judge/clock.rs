//! How long something took, and what was being done when it ended badly.
//!
//! Other programs run on the same cores, so what counts is time of the processor where the
//! system tells it, and time of the clock where it does not.

use std::panic;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The part of the work that is being done, and since when.
static DOING: Mutex<Option<(String, Clock)>> = Mutex::new(None);

/// Where the last panic was, and what it said.
static PANIC: Mutex<(String, String)> = Mutex::new((String::new(), String::new()));

/// The beginning of something.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Clock {
    wall: Instant,
    processor: Option<Duration>,
}

impl Clock {
    /// Starts now.
    pub(crate) fn start() -> Self {
        Self { wall: Instant::now(), processor: processor() }
    }

    /// The time spent since; not looked up exactly where it cannot be more than a limit.
    pub(crate) fn spent(&self, limit: Duration) -> Duration {
        let wall = self.wall.elapsed();
        if wall <= limit {
            return wall;
        }
        self.processor.zip(processor()).map_or(wall, |(before, now)| now.saturating_sub(before))
    }
}

/// The time of the processor that this process has used, by Linux.
fn processor() -> Option<Duration> {
    // Hundredths of a second in user and system mode are fields 14 and 15; the name, field 2, may contain blanks.
    let text = std::fs::read_to_string("/proc/self/stat").ok()?;
    let fields: Vec<&str> = text.rsplit_once(')')?.1.split_whitespace().collect();
    let ticks: u64 = fields.get(11)?.parse::<u64>().ok()? + fields.get(12)?.parse::<u64>().ok()?;
    Some(Duration::from_millis(ticks * 10))
}

/// Says what is done next.
pub(crate) fn enter(name: &str) {
    if let Ok(mut doing) = DOING.lock() {
        *doing = Some((name.to_owned(), Clock::start()));
    }
}

/// Says that nothing is done.
pub(crate) fn leave() {
    if let Ok(mut doing) = DOING.lock() {
        *doing = None;
    }
}

/// What has been done for longer than a limit.
pub(crate) fn stuck(limit: Duration) -> Option<String> {
    let doing = DOING.lock().ok()?;
    let (name, clock) = doing.as_ref()?;
    (clock.spent(limit) > limit).then(|| name.clone())
}

/// Keeps what panics say, instead of printing it.
pub(crate) fn catch_panics() {
    panic::set_hook(Box::new(|info| {
        let place = info.location().map_or_else(String::new, |at| {
            // Of libraries only what does not depend on the machine.
            let file = at.file();
            let file = file
                .split_once("/registry/src/")
                .map_or(file, |(_, rest)| rest.split_once('/').map_or(rest, |(_, rest)| rest));
            format!("{}:{}", file.trim_start_matches("../"), at.line())
        });
        let payload = info.payload();
        let text = payload.downcast_ref::<&str>().copied();
        let text = text.or_else(|| payload.downcast_ref::<String>().map(String::as_str));
        let message = text.unwrap_or("no message").to_owned();
        if let Ok(mut last) = PANIC.lock() {
            *last = (place, message);
        }
    }));
}

/// Where the last panic was, and its message.
pub(crate) fn last_panic() -> (String, String) {
    PANIC.lock().map(|last| last.clone()).unwrap_or_default()
}
