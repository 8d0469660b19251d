//! The Rust side of a table on a device: a pipeline that evaluates columns.
//!
//! The generated text goes with wgpu 30. It takes a device and a queue as they
//! are, so it fits into any program that has them.

use super::Side;
use crate::emit::kernel::columns;
use crate::emit::kernel::columns::{Entry, Layout, WORKGROUP};
use crate::emit::language::rust::Rust;
use crate::emit::language::{self, Dialect};
use crate::emit::lookup_words;
use crate::emit::text::Text;

/// The pipeline, with `$` for what depends on the table. Lines that end in `//F` are for
/// tables that fetch, those in `//L` for plans that read a lookup.
const PIPELINE: &str = include_str!("wgpu.rs.in");

/// Writes the structure of fetched inputs, if any, and the pipeline.
pub(in crate::emit) fn write(side: &Side<'_, '_>, text: &mut Text) {
    let layout = Layout::new(side.program, Entry::Key);
    let fetched = side.fetched_fields();
    if !fetched.is_empty() {
        text.doc("The fetched inputs of one evaluation, levels as their numbers, in words of four bytes without gaps.");
        side.structure(text, "Fetched", &fetched);
        text.gap();
    }
    let shader = columns::wgsl_columns(side.proved, Entry::Key);
    let hashes = "#".repeat(longest_run(&shader) + 1);
    let words = lookup_words(side.proved.plan()).unwrap_or_default();
    let lookup = words.iter().map(u32::to_string).collect::<Vec<_>>().join(", ");
    let keep = |line: &&str| {
        let (has_fetched, has_lookup) = (!fetched.is_empty(), side.has_lookup());
        (has_fetched || !line.contains("//F")) && (has_lookup || !line.contains("//L"))
    };
    let source: String = PIPELINE.lines().filter(keep).fold(String::new(), |mut all, line| {
        let line = line.trim_end_matches("//F").trim_end_matches("//L").trim_end();
        all.push_str(line);
        all.push('\n');
        all
    });
    let source = source
        .replace("$Camel", &side.prefix.camel)
        .replace("$lower", &side.prefix.lower)
        .replace("$result", &side.prefix.result())
        .replace("$value", &value(side))
        .replace("$workgroup", &WORKGROUP.to_string())
        .replace("$words", &layout.out.to_string())
        .replace("$row", &(4 * layout.plain.max(layout.fetched).max(layout.out)).to_string())
        .replace("$lookup", &lookup)
        .replace("$hashes", &hashes)
        // Last, because a table may say anything.
        .replace("$shader", &shader);
    text.line(source);
}

/// The value made of the words of a row of results, of which the first is the case.
fn value(side: &Side<'_, '_>) -> String {
    let data = side.program.output.data_type();
    let components = data.components().into_iter().zip(1..);
    let components = components.map(|(of, index)| Rust.scalar_of_word(of.scalar, &format!("row[{index}]")));
    language::value(&Rust, &side.prefix, &data, components)
}

/// The longest run of `#` in a text: a raw string needs one more.
fn longest_run(text: &str) -> usize {
    text.split(|c| c != '#').map(str::len).max().unwrap_or_default()
}
