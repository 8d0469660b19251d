//! Reproducers made small: first the bytes that a case was made of, then its files.

use std::time::{Duration, Instant};

use super::child::{Found, attempt};
use super::worker;
use crate::choices::{Choices, bytes_of};
use crate::judge::tables::WELL_FORMED;
use crate::mutate::brackets;
use crate::targets::Case;

/// The time that is spent on one.
const TIME: Duration = Duration::from_secs(40);

struct Shrinking<'f> {
    found: &'f Found,
    until: Instant,
}

/// A smaller case with the same fault; nothing if the fault does not come again.
pub(super) fn shrink(found: &Found) -> Option<Case> {
    let mut shrinking = Shrinking { found, until: Instant::now() + TIME };
    let whole = worker::case(found.target, found.seed, found.number);
    if !shrinking.fails(&whole) {
        return None;
    }
    let bytes = shrinking.bytes(bytes_of(found.seed, found.target.name, found.number));
    let mut case = (found.target.make)(&mut Choices::new(&bytes));
    // With parts left out it would be refused for that.
    if found.fault.kind.starts_with(WELL_FORMED) {
        return Some(case);
    }
    for file in 0..case.files.len() {
        case = shrinking.file(case, file);
    }
    Some(case)
}

impl Shrinking<'_> {
    /// Returns whether a case has the fault that is looked for.
    fn fails(&self, case: &Case) -> bool {
        attempt(self.found.target, case)
            .is_ok_and(|faults| faults.iter().any(|fault| fault.kind == self.found.fault.kind))
    }

    fn is_over(&self) -> bool {
        Instant::now() > self.until
    }

    /// Fewer and smaller bytes that make a case with the same fault.
    fn bytes(&mut self, mut bytes: Vec<u8>) -> Vec<u8> {
        let fails = |me: &Self, bytes: &[u8]| me.fails(&(me.found.target.make)(&mut Choices::new(bytes)));
        // The end first, half by half: where bytes run out, the simplest is chosen.
        let mut cut = bytes.len() / 2;
        while cut > 0 && !self.is_over() {
            let shorter = &bytes[..bytes.len().saturating_sub(cut)];
            if fails(self, shorter) {
                bytes.truncate(shorter.len());
            } else {
                cut /= 2;
            }
        }
        for size in [64, 16, 4, 1] {
            let mut at = 0;
            while at < bytes.len() && !self.is_over() && bytes.len() / size < 600 {
                let end = (at + size).min(bytes.len());
                let without = [&bytes[..at], &bytes[end..]].concat();
                let mut zero = bytes.clone();
                zero[at..end].fill(0);
                if fails(self, &without) {
                    bytes = without;
                } else if bytes[at..end].iter().any(|byte| *byte != 0) && fails(self, &zero) {
                    bytes = zero;
                    at = end;
                } else {
                    at = end;
                }
            }
        }
        bytes
    }

    /// A file with parts left out.
    fn file(&mut self, mut case: Case, file: usize) -> Case {
        let mut smaller = true;
        while smaller && !self.is_over() {
            smaller = false;
            let bytes = case.files[file].1.clone();
            let mut parts = parts(&bytes);
            parts.sort_by_key(|(start, end)| std::cmp::Reverse(end - start));
            for (start, end) in parts {
                if self.is_over() {
                    break;
                }
                let mut tried = case.clone();
                tried.files[file].1.drain(start..end);
                if self.fails(&tried) {
                    case = tried;
                    smaller = true;
                    break;
                }
            }
        }
        case
    }
}

/// What can be left out of a text: what stands between two commas of one bracket, and lines.
fn parts(bytes: &[u8]) -> Vec<(usize, usize)> {
    let mut parts = Vec::new();
    let mut at = 0;
    while let Some((start, end)) = brackets(bytes, at) {
        if bytes[start] != b'"' {
            parts.extend(items(bytes, start + 1, end - 1));
        }
        at = start + 1;
    }
    let mut line = 0;
    for (place, byte) in bytes.iter().enumerate() {
        if *byte == b'\n' {
            parts.push((line, place + 1));
            line = place + 1;
        }
    }
    // Of what has no such parts, runs of bytes.
    if parts.len() < 8 {
        let size = (bytes.len() / 32).max(1);
        parts.extend((0..bytes.len()).step_by(size).map(|start| (start, (start + size).min(bytes.len()))));
    }
    parts.retain(|(start, end)| start < end);
    parts
}

/// The items of a list with the comma behind each.
fn items(bytes: &[u8], from: usize, to: usize) -> Vec<(usize, usize)> {
    let (mut items, mut start, mut depth, mut quoted) = (Vec::new(), from, 0_i32, false);
    for (place, byte) in bytes.iter().enumerate().take(to).skip(from) {
        match byte {
            b'"' => quoted = !quoted,
            b'(' | b'[' | b'{' if !quoted => depth += 1,
            b')' | b']' | b'}' if !quoted => depth -= 1,
            b',' if !quoted && depth == 0 => {
                items.push((start, place + 1));
                start = place + 1;
            }
            _ => {}
        }
    }
    items.push((start, to));
    items
}
