//! The words of a plan's lookup: what it says of every key, then coefficients.

use crate::plan::{Coefficients, Plan};

/// Words of a set of coefficients: the case, and for each component its sign and its sums.
pub(in crate::emit) fn stride(coefficients: &Coefficients, components: usize) -> u32 {
    (1 + components * piece(coefficients)) as u32
}

/// Words of the coefficients of one component.
pub(in crate::emit) fn piece(coefficients: &Coefficients) -> usize {
    1 + coefficients.width * (1 + coefficients.inputs.len())
}

/// Entries of the lookup per word: they are stored in 8 or 16 bits.
pub(in crate::emit) fn entries_per_word(plan: &Plan<'_>) -> u32 {
    if plan.lookup.iter().all(|entry| *entry < 256) { 4 } else { 2 }
}

/// Words before the coefficients.
pub(in crate::emit) fn key_words(plan: &Plan<'_>) -> usize {
    let per_word = entries_per_word(plan) as usize;
    (1_usize << plan.key.bits()).div_ceil(per_word)
}

/// The words of a plan's lookup, by key: the entries of consecutive keys, the
/// lowest key in the lowest bits. Keys that are no state hold the commonest
/// entry. Behind them stand the coefficients of a plan that has some: `default`
/// is the number that stands for no case. Empty for plans without a lookup.
pub(in crate::emit) fn words(plan: &Plan<'_>, default: u32) -> Vec<u32> {
    if plan.lookup.is_empty() {
        return Vec::new();
    }
    let mut counts = vec![0_usize; plan.lookup.iter().copied().max().map_or(0, usize::from) + 1];
    plan.lookup.iter().for_each(|entry| counts[usize::from(*entry)] += 1);
    let commonest = (0..counts.len()).max_by_key(|entry| counts[*entry]).unwrap_or_default() as u32;
    let per_word = entries_per_word(plan);
    let bits = 32 / per_word;
    let mut entries = vec![commonest; key_words(plan) * per_word as usize];
    let program = plan.program;
    let mut levels = vec![0; program.inputs.len()];
    for (state, entry) in plan.lookup.iter().enumerate() {
        program.states.write(state, &mut levels);
        entries[plan.key.pack(|input| levels[input.index()]) as usize] = u32::from(*entry);
    }
    let chunks = entries.chunks(per_word as usize);
    let mut words: Vec<u32> =
        chunks.map(|chunk| chunk.iter().rev().fold(0, |word, entry| word << bits | entry)).collect();
    for fit in &plan.coefficients.fits {
        words.push(fit.row.map_or(default, |row| program.rows[row].id));
        for piece in &fit.pieces {
            words.push((piece.sign as f32).to_bits());
            for form in &piece.forms {
                words.push((form.constant as f32).to_bits());
                words.extend(form.factors.iter().map(|factor| (*factor as f32).to_bits()));
            }
        }
    }
    words
}
