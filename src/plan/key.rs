//! The packed key: all discrete inputs that are not fetched, in one `u32`.

use crate::program::{InputId, LevelSet, Program};

/// Most bits of a key whose lookup lies in a buffer.
pub(super) const MAX_BUFFER_BITS: u32 = 24;

/// The places of the discrete inputs in the key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct KeyLayout {
    fields: Vec<KeyField>,
    bits: u32,
}

/// Some bits of a key that hold the index of a level.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct KeyField {
    /// The input.
    pub input: InputId,
    /// Lowest bit.
    pub shift: u32,
    /// Number of bits.
    pub bits: u32,
}

impl KeyField {
    /// The bits of the field, shifted down.
    pub fn mask(self) -> u32 {
        LevelSet::all(self.bits as usize).0 as u32
    }
}

impl KeyLayout {
    /// Packs the inputs in the order declared, the first one lowest.
    ///
    /// # Errors
    /// When they need more than 32 bits.
    pub fn new(program: &Program) -> Result<Self, String> {
        let mut fields = Vec::new();
        let mut shift = 0;
        for (input, _) in program.states.digits() {
            let bits = program.levels(*input).map_or(0, |levels| levels.bits());
            fields.push(KeyField { input: *input, shift, bits });
            shift += bits;
        }
        if shift > 32 {
            return Err(format!("the discrete inputs need {shift} bits, a key has 32"));
        }
        Ok(Self { fields, bits: shift })
    }

    /// The fields, lowest first.
    pub fn fields(&self) -> &[KeyField] {
        &self.fields
    }

    /// Bits in use.
    pub fn bits(&self) -> u32 {
        self.bits
    }

    /// Refuses a key that has more bits than a lookup has room for; `advice` says what to use instead.
    pub(super) fn fits(&self, limit: u32, advice: &str) -> Result<(), String> {
        if self.bits <= limit {
            return Ok(());
        }
        Err(format!("its key has {} bits, and the lookup of this plan has room for {limit}; {advice}", self.bits))
    }

    /// The key of a state.
    pub fn pack(&self, level: impl Fn(InputId) -> u8) -> u32 {
        self.fields.iter().fold(0, |key, field| key | u32::from(level(field.input)) << field.shift)
    }
}
