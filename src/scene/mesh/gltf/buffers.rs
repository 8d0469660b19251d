//! The bytes of a glTF file: its JSON, and its buffers wherever they are.

use std::path::Path;

use base64::Engine as _;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::broken;
use super::document::Document;
use crate::scene::mesh::{Broken, MAX_BYTES, Result, bytes, named};

/// Base64, with or without the characters that fill it up.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Splits a file into its JSON and, in GLB, the buffer that comes with it.
pub(super) fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>)> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        return Ok((bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes), None));
    };
    let short = || broken("is cut off: it is shorter than its head says");
    let (version, rest) = word(rest).ok_or_else(short)?;
    if version != 2 {
        return Err(Broken::new(format!("is GLB of version {version}"), "export it as glTF 2.0"));
    }
    let (length, rest) = word(rest).ok_or_else(short)?;
    let mut rest = length.checked_sub(12).and_then(|length| rest.get(..length)).ok_or_else(short)?;
    let (mut json, mut blob) = (None, None);
    while !rest.is_empty() {
        let (length, after) = word(rest).ok_or_else(short)?;
        let (kind, after) = after.split_at_checked(4).ok_or_else(short)?;
        let (chunk, after) = after.split_at_checked(length).ok_or_else(short)?;
        match kind {
            b"JSON" if json.is_none() => json = Some(chunk),
            b"BIN\0" if blob.is_none() => blob = Some(chunk),
            // The standard lets others be passed over.
            _ => {}
        }
        rest = after;
    }
    Ok((json.ok_or_else(|| broken("is GLB without JSON"))?, blob))
}

fn word(bytes: &[u8]) -> Option<(usize, &[u8])> {
    let (word, rest) = bytes.split_first_chunk::<4>()?;
    Some((u32::from_le_bytes(*word) as usize, rest))
}

/// Reads all buffers.
pub(super) fn read(document: &Document, blob: Option<&[u8]>, directory: &Path) -> Result<Vec<Vec<u8>>> {
    let mut left = MAX_BYTES;
    let read = |(index, buffer): (usize, &super::document::Buffer)| {
        let mut data = match &buffer.uri {
            Some(uri) => resolve(uri, directory, left)?,
            None if index == 0 => blob.ok_or_else(|| broken("has no data for buffer 0"))?.to_vec(),
            None => return Err(broken(format!("has no data for buffer {index}"))),
        };
        if data.len() < buffer.byte_length {
            let what =
                format!("has a buffer of {} bytes in place of {} (buffer {index})", data.len(), buffer.byte_length);
            return Err(broken(what));
        }
        data.truncate(buffer.byte_length);
        left = left.saturating_sub(data.len() as u64);
        Ok(data)
    };
    document.buffers.iter().enumerate().map(read).collect()
}

/// The bytes that a URI stands for: data, or a file beside the mesh.
fn resolve(uri: &str, directory: &Path, most: u64) -> Result<Vec<u8>> {
    let shown: String = uri.chars().take(60).flat_map(char::escape_default).collect();
    if let Some(rest) = uri.strip_prefix("data:") {
        let (head, data) = rest.split_once(',').ok_or_else(|| broken("has a buffer of data without a comma"))?;
        return match head.ends_with(";base64") {
            true => BASE64.decode(data).map_err(|error| broken(format!("has a buffer that is no base64: {error}"))),
            false => Ok(decoded(data)),
        };
    }
    let scheme = uri.split_once(':').map_or("", |(scheme, _)| scheme);
    if !scheme.is_empty() && scheme.bytes().all(|byte| byte.is_ascii_alphanumeric() || b"+-.".contains(&byte)) {
        let help = "place the buffer beside the mesh, under a relative path";
        return Err(Broken::new(format!("has a buffer at `{shown}`, which is no file"), help));
    }
    let name = String::from_utf8(decoded(uri)).map_err(|_| broken(format!("names a buffer `{shown}` not in UTF-8")))?;
    named(directory, &name).and_then(|path| bytes(&path, most)).map_err(|reason| {
        let what = format!("names the buffer `{}`, which {}", name.escape_debug(), reason.what);
        Broken { what, ..reason }
    })
}

/// Text with `%20` and the like put back.
fn decoded(text: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((first, after)) = rest.split_first() {
        let digits = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        let code = digits.filter(|d| d.bytes().all(|b| b.is_ascii_hexdigit())).map(|d| u8::from_str_radix(d, 16));
        match (first, code) {
            (b'%', Some(Ok(byte))) => {
                bytes.push(byte);
                rest = &after[2..];
            }
            _ => {
                bytes.push(*first);
                rest = after;
            }
        }
    }
    bytes
}
