//! Files made wrong: a few changes, of bytes, of words, of numbers, of what stands in brackets.

use crate::choices::Choices;

/// Numbers that are special to someone.
const NUMBERS: &[&str] = &[
    "0",
    "-1",
    "1",
    "2",
    "255",
    "65536",
    "2147483647",
    "-2147483648",
    "4294967295",
    "9223372036854775807",
    "18446744073709551615",
    "18446744073709551616",
    "1e308",
    "1e309",
    "-1e999",
    "1e-400",
    "0.1",
    "NaN",
    "inf",
    "-0",
    "16777217",
    "3.4028235e38",
    "3.4028236e38",
    "1e-46",
    "00",
    "1.",
    ".5",
    "0x10",
    "1_000",
    "-",
];

/// Words of the formats that are read.
const WORDS: &[&str] = &[
    "true",
    "false",
    "none",
    "None",
    "null",
    "Table",
    "Case",
    "Levels",
    "Bool()",
    "Int(from: 0, to: 3)",
    "Range(from: 0, to: 1)",
    "fetched: (cost: 1)",
    "default",
    "is: (case: 1, under: \"m\")",
    "case(1)",
    "x",
    "let a = x;",
    "if x < 1 { 1 } else { 2 }",
    "sum(n in 1 .. 256, x)",
    "poly(x, [1, 2])",
    "x | x = 0 .. 1",
    "{a: 1}",
    "vec4(1)",
    ".xyzw",
    " in {a}",
    "&&",
    "||",
    "..",
    "%",
    "All([",
    "Any([",
    "Not(",
    "From(\"a\", {})",
    "Some(",
    "r#\"",
    "\"#",
    "/*",
    "*/",
    "//",
    "\\u{1b}",
    "\u{feff}",
    "\u{202e}",
    "\u{0}",
    "é",
    "\u{1f600}",
    "\r\n",
    "\n",
    "\t",
    " ",
    ",",
    ";",
    ":",
    "\"",
    "'",
    "\\",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "-",
    "+",
    "e",
    "bufferView",
    "byteOffset",
    "count",
    "componentType",
    "VEC3",
    "sparse",
    "data:application/octet-stream;base64,AAAA",
    "../x",
    "%2e%2e",
    "mode",
    "5126",
    "indices",
    "children",
    "matrix",
    "f 1 2 3",
    "f 1/1/1 2/2/2 3/3/3",
    "f -1 -2 -3",
    "v 0 0 0",
    "vn 0 0 1",
    "usemtl a",
    "l 1 2",
];

/// A file with a few changes; `others` are further files of its kind.
pub(crate) fn mutated(choices: &mut Choices<'_>, file: &[u8], others: &[Vec<u8>]) -> Vec<u8> {
    let mut bytes = file.to_vec();
    // Without choices the file stays as it is.
    let count = *choices.pick(&[0, 1, 1, 1, 2, 2, 3, 5, 9]);
    for _ in 0..count {
        change(choices, &mut bytes, others);
        if bytes.len() > 200_000 {
            bytes.truncate(200_000);
        }
    }
    bytes
}

fn change(choices: &mut Choices<'_>, bytes: &mut Vec<u8>, others: &[Vec<u8>]) {
    let at = choices.below(bytes.len() + 1);
    match choices.weighted([3, 4, 4, 3, 2, 4, 2, 2, 1, 2, 1].into_iter()) {
        // A word or number for another one.
        0 => {
            let (start, end) = word(bytes, at);
            let new = if choices.either() { *choices.pick(NUMBERS) } else { *choices.pick(WORDS) };
            bytes.splice(start..end, new.bytes());
        }
        // A number changed.
        1 => {
            if let Some((start, end)) = number(bytes, at) {
                bytes.splice(start..end, choices.pick(NUMBERS).bytes());
            }
        }
        // A word for one that stands elsewhere.
        2 => {
            let (start, end) = word(bytes, at);
            let from = choices.below(bytes.len() + 1);
            let (from, to) = word(bytes, from);
            let new = bytes[from..to].to_vec();
            bytes.splice(start..end, new);
        }
        // Left out: a word, what stands in brackets, or some bytes.
        3 => {
            let (start, end) = word(bytes, at);
            bytes.drain(start..end);
        }
        4 => {
            if let Some((start, end)) = brackets(bytes, at) {
                bytes.drain(start..end);
            }
        }
        // Twice: what stands in brackets.
        5 => {
            if let Some((start, end)) = brackets(bytes, at) {
                let mut again = b", ".to_vec();
                again.extend_from_slice(&bytes[start..end]);
                if choices.either() {
                    again = bytes[start..end].to_vec();
                }
                let to = choices.below(bytes.len() + 1);
                let to = if choices.either() { end } else { to };
                bytes.splice(to..to, again);
            }
        }
        // Bits.
        6 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << choices.below(8);
            }
        }
        7 => {
            let new: Vec<u8> = (0..choices.within(1, 4)).map(|_| choices.byte()).collect();
            let end = (at + if choices.either() { new.len() } else { 0 }).min(bytes.len());
            bytes.splice(at..end, new);
        }
        // The end missing.
        8 => bytes.truncate(at),
        // A part of another file.
        9 => {
            if !others.is_empty() {
                let other = choices.pick(others);
                let from = choices.below(other.len() + 1);
                let part = brackets(other, from).unwrap_or_else(|| word(other, from));
                let end = brackets(bytes, at).map_or(at, |(_, end)| end.max(at));
                let end = if choices.either() { at } else { end };
                bytes.splice(at..end, other[part.0..part.1].to_vec());
            }
        }
        // The same again and again.
        _ => {
            let (start, end) = word(bytes, at);
            let times = *choices.pick(&[2, 30, 130, 3000]);
            let part = bytes[start..end].to_vec();
            if part.len() * times < 100_000 {
                bytes.splice(start..end, part.repeat(times));
            }
        }
    }
}

fn is_of_word(byte: u8) -> bool {
    byte.is_ascii_alphanumeric() || matches!(byte, b'_' | b'.') || byte >= 0x80
}

/// The word, or the sign, around a place.
fn word(bytes: &[u8], at: usize) -> (usize, usize) {
    let Some(first) = bytes.get(at) else { return (bytes.len(), bytes.len()) };
    if !is_of_word(*first) {
        return (at, at + 1);
    }
    let start = bytes[..at].iter().rposition(|byte| !is_of_word(*byte)).map_or(0, |before| before + 1);
    let end = bytes[at..].iter().position(|byte| !is_of_word(*byte)).map_or(bytes.len(), |behind| at + behind);
    (start, end)
}

/// The next number from a place on.
fn number(bytes: &[u8], at: usize) -> Option<(usize, usize)> {
    let start = at + bytes[at..].iter().position(u8::is_ascii_digit)?;
    let ends = |byte: &u8| !byte.is_ascii_digit() && *byte != b'.';
    Some((start, bytes[start..].iter().position(ends).map_or(bytes.len(), |length| start + length)))
}

/// What stands in brackets from a place on, the brackets included.
pub(crate) fn brackets(bytes: &[u8], at: usize) -> Option<(usize, usize)> {
    let start = at + bytes[at..].iter().position(|byte| matches!(byte, b'(' | b'[' | b'{' | b'"'))?;
    if bytes[start] == b'"' {
        let end = bytes[start + 1..].iter().position(|byte| *byte == b'"')?;
        return Some((start, start + end + 2));
    }
    let mut depth = 0_usize;
    for (place, byte) in bytes.iter().enumerate().skip(start) {
        match byte {
            b'(' | b'[' | b'{' => depth += 1,
            b')' | b']' | b'}' => {
                depth -= 1;
                if depth == 0 {
                    return Some((start, place + 1));
                }
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choices::bytes_of;

    #[test]
    fn words_and_brackets_are_found() {
        let text = b"a: [b1, (c)], \"d e\" 12.5";
        assert_eq!(word(text, 4), (4, 6));
        assert_eq!(brackets(text, 0), Some((3, 12)));
        assert_eq!(brackets(text, 12), Some((14, 19)));
        assert_eq!(number(text, 8), Some((20, 24)));
    }

    #[test]
    fn a_file_stays_as_it_is_without_choices() {
        assert_eq!(mutated(&mut Choices::new(&[]), b"abc", &[]), b"abc");
        let changed = (0..50).filter(|number| {
            mutated(&mut Choices::new(&bytes_of(3, "m", *number)), b"a: [1, 2]", &[b"(x)".to_vec()]) != b"a: [1, 2]"
        });
        assert!(changed.count() > 30);
    }
}
