//! Columns of inputs as the words of a shader over columns, and its results from them, as
//! [`Layout`] says.

use std::ops::Range;

use super::Outputs;
use crate::emit::kernel::columns::{COUNTS_PER_WORD, Entry, Layout};
use crate::eval::{ABSENT, Columns};
use crate::plan::KeyLayout;
use crate::program::{Domain, InputId, InputSet, LevelKind, Levels, Program};

/// The number of rows, then the inputs that are not fetched, as [`Layout`] says.
pub fn plain_words(
    program: &Program,
    key: &KeyLayout,
    entry: Entry,
    columns: &Columns<f32>,
    rows: Range<usize>,
) -> Vec<u32> {
    let plain = program.input_ids().filter(|(_, input)| input.fetched.is_none());
    let inputs: Vec<(InputId, &Domain)> = plain.map(|(id, input)| (id, &input.domain)).collect();
    let mut words = Vec::with_capacity(1 + rows.len() * (1 + inputs.len()));
    words.push(rows.len() as u32);
    for row in rows {
        if entry == Entry::Key {
            words.push(key.pack(|input| columns.levels(input)[row]));
        }
        for (input, domain) in &inputs {
            match domain {
                // A word by its bits, as a number.
                Domain::Continuous { .. } | Domain::Word => words.push(columns.numbers(*input)[row].to_bits()),
                Domain::Discrete(_) if entry == Entry::Key => {}
                Domain::Discrete(levels) => {
                    let level = columns.levels(*input)[row];
                    words.push(match levels.kind {
                        LevelKind::Bool => u32::from(level),
                        LevelKind::Int if levels.classes.is_some() => integer_word(levels, level),
                        _ => (levels.codes[usize::from(level)] as f32).to_bits(),
                    });
                }
            }
        }
    }
    words
}

/// An integer that a level stands for.
fn integer_word(levels: &Levels, level: u8) -> u32 {
    (levels.codes[usize::from(level)] as i32).cast_unsigned()
}

/// The fetched inputs, as [`Layout`] says.
pub fn fetched_words(program: &Program, columns: &Columns<f32>, rows: Range<usize>) -> Vec<u32> {
    let inputs: Vec<(InputId, Option<&Levels>)> =
        program.fetched.iter().map(|input| (input, program.levels(input))).collect();
    let mut words = Vec::with_capacity(rows.len() * inputs.len());
    for row in rows {
        words.extend(inputs.iter().map(|(input, levels)| {
            if let Some(levels) = levels {
                let level = columns.levels(*input)[row];
                let is_integer = levels.classes.is_some() && level != ABSENT;
                if is_integer { integer_word(levels, level) } else { u32::from(level) }
            } else if columns.is_present(row, *input) {
                columns.numbers(*input)[row].to_bits()
            } else {
                f32::NAN.to_bits()
            }
        }));
    }
    words
}

/// Appends the results of rows to those read before.
pub fn read(program: &Program, layout: &Layout, words: &[u32], outputs: &mut Outputs) {
    let rows: std::collections::HashMap<u32, usize> =
        program.rows.iter().enumerate().map(|(index, row)| (row.id, index)).collect();
    let fetched: Vec<InputId> = program.fetched.iter().collect();
    let components = program.output.components();
    for result in words.chunks_exact(layout.out) {
        outputs.rows.push(rows.get(&result[0]).copied());
        for ((column, component), word) in outputs.values.iter_mut().zip(&components).zip(&result[1..]) {
            column.push(component.scalar.number(*word));
        }
        let (mut once, mut repeated) = (InputSet::default(), InputSet::default());
        for (index, input) in fetched.iter().enumerate() {
            let word = result[1 + layout.values + index / COUNTS_PER_WORD];
            match word >> (4 * (index % COUNTS_PER_WORD)) & 15 {
                0 => {}
                1 => once = once.or(InputSet::one(*input)),
                _ => repeated = repeated.or(InputSet::one(*input)),
            }
        }
        outputs.fetched.push(once.or(repeated));
        outputs.repeated.push(repeated);
    }
}
