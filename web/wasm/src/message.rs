//! Messages: JSON, and bytes beside it.

use serde_json::{Value as Json, json};

/// A message in either direction.
pub(crate) struct Message {
    /// The part that is JSON.
    pub(crate) json: Json,
    /// The other bytes: in an answer, pieces that the JSON names by their place.
    pub(crate) bytes: Vec<u8>,
}

impl Message {
    /// Reads a message.
    pub(crate) fn read(bytes: &[u8]) -> Result<Self, String> {
        let (length, rest) = bytes.split_first_chunk::<4>().ok_or("the message is cut off")?;
        let length = u32::from_le_bytes(*length) as usize;
        let (json, bytes) = rest.split_at_checked(length).ok_or("the message is cut off")?;
        let json = serde_json::from_slice(json).map_err(|error| error.to_string())?;
        Ok(Self { json, bytes: bytes.to_vec() })
    }

    /// An answer that is all JSON.
    pub(crate) fn of(json: Json) -> Self {
        Self { json, bytes: Vec::new() }
    }

    /// An answer that says why there is none.
    pub(crate) fn error(reason: &str) -> Self {
        Self::of(json!({ "error": reason }))
    }

    /// Adds bytes to an answer, under a name.
    pub(crate) fn with(mut self, name: &str, bytes: &[u8]) -> Self {
        self.json[name] = json!([self.bytes.len(), bytes.len()]);
        self.bytes.extend(bytes);
        self
    }

    /// Adds words to an answer, under a name.
    pub(crate) fn with_words(self, name: &str, words: &[u32]) -> Self {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_le_bytes()).collect();
        self.with(name, &bytes)
    }

    /// The bytes as words.
    pub(crate) fn words(&self) -> Vec<u32> {
        self.bytes.as_chunks::<4>().0.iter().map(|word| u32::from_le_bytes(*word)).collect()
    }

    /// The message as it is handed over.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let json = self.json.to_string();
        let mut out = Vec::with_capacity(4 + json.len() + self.bytes.len());
        // Memory ends at 4 GiB, and so does what a message can hold.
        out.extend((json.len() as u32).to_le_bytes());
        out.extend(json.as_bytes());
        out.extend(&self.bytes);
        out
    }

    /// A text of a request; empty, if it has none of that name.
    pub(crate) fn text(&self, name: &str) -> &str {
        self.json[name].as_str().unwrap_or_default()
    }

    /// A number of a request; zero, if it has none of that name.
    pub(crate) fn number(&self, name: &str) -> usize {
        self.json[name].as_u64().map_or(0, |number| number as usize)
    }
}
