//! Diagnostic codes at length.
//!
//! The texts are those of `docs/codes.md`, which is part of the program: there
//! is one place to write them and one to read them. Their headings are those of
//! the registry, [`codes::ALL`].

use crate::diag::codes;

const TEXTS: &str = include_str!("../../docs/codes.md");

/// The explanation of one code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The code, such as `U0203`.
    pub code: &'static str,
    /// Its meaning in a line.
    pub meaning: &'static str,
    /// The explanation, in Markdown.
    pub text: &'static str,
}

/// The explanations of all codes, ascending.
pub fn entries() -> impl Iterator<Item = Entry> {
    codes::ALL.iter().filter_map(explained)
}

/// The explanation of a code; capitals do not matter.
pub fn entry(code: &str) -> Option<Entry> {
    codes::entry(code).and_then(explained)
}

fn explained(entry: &'static codes::Entry) -> Option<Entry> {
    let (_, rest) = TEXTS.split_once(&format!("\n## {}\n", entry.heading()))?;
    let text = rest.split("\n## ").next().unwrap_or(rest).trim();
    Some(Entry { code: entry.code.0, meaning: entry.meaning, text })
}

/// Returns whether a word looks like a code.
pub fn is_code(word: &str) -> bool {
    word.strip_prefix(['U', 'u']).is_some_and(|digits| digits.len() == 4 && digits.bytes().all(|b| b.is_ascii_digit()))
}

impl Entry {
    /// The explanation for a terminal: examples indented and named.
    pub fn plain(&self) -> String {
        let mut out = format!("{}: {}\n\n", self.code, self.meaning);
        let mut inside = false;
        for line in self.text.lines() {
            match line.strip_prefix("```") {
                Some(kind) => {
                    inside = !inside;
                    match kind {
                        "ron wrong" => out.push_str("For instance:\n\n"),
                        "ron right" => out.push_str("Better:\n\n"),
                        _ => {}
                    }
                }
                None if inside => {
                    out.push_str("    ");
                    out.push_str(line);
                    out.push('\n');
                }
                None => {
                    out.push_str(line);
                    out.push('\n');
                }
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::program::Program;
    use crate::table::Table;

    /// The fields that an example of `docs/codes.md` leaves out.
    const FRAME: [(&str, &str); 7] = [
        ("language", "1"),
        ("name", "\"example\""),
        ("hit_policy", "First"),
        (
            "inputs",
            r#"{"x": Range(from: 0, to: 1, default: 0.5), "wet": Bool(default: false),
                "side": Levels(values: {"none": 0, "left": 1, "right": 2}, default: none)}"#,
        ),
        ("output", "Number()"),
        ("cases", r#"[Case(id: 1, when: "wet", value: "x")]"#),
        ("default", "0"),
    ];

    /// The codes that a table raises of which an example is a part.
    fn raised(fields: &str) -> Vec<&'static str> {
        let mut text = format!("Table(\n{fields}\n");
        for (field, value) in FRAME {
            if !fields.lines().any(|line| line.starts_with(&format!("{field}:"))) {
                text.push_str(&format!("{field}: {value},\n"));
            }
        }
        text.push(')');
        let found = match Table::parse(Source::new("example.ron", text)).and_then(|table| Program::check(&table)) {
            Ok(program) => crate::analyse::findings(&program),
            Err(failure) => failure.diagnostics,
        };
        found.iter().map(|diagnostic| diagnostic.code.0).collect()
    }

    #[test]
    fn examples_are_true() {
        let mut count = 0;
        for entry in entries() {
            for block in entry.text.split("```ron ").skip(1) {
                let (kind, rest) = block.split_once('\n').unwrap_or_default();
                let (fields, _) = rest.split_once("```").unwrap_or_default();
                let raised = raised(fields);
                assert_eq!(raised.contains(&entry.code), kind == "wrong", "{}, {kind}: {raised:?}", entry.code);
                count += 1;
            }
        }
        assert!(count > 50, "{count} examples");
    }

    /// Every code is explained, in order, in the words of the registry.
    #[test]
    fn every_code_is_explained() {
        let headings: Vec<&str> = TEXTS.lines().filter_map(|line| line.strip_prefix("## ")).collect();
        let registered: Vec<String> = codes::ALL.iter().map(codes::Entry::heading).collect();
        assert_eq!(headings, registered, "the headings of docs/codes.md are those of src/diag/codes.rs");
        let reference = include_str!("../../docs/language.md");
        let rows: Vec<&str> = reference.lines().filter(|line| line.starts_with("| U")).collect();
        let registered = codes::ALL.iter().map(|entry| format!("| {} | {} |", entry.code, entry.meaning));
        assert_eq!(rows, registered.collect::<Vec<_>>(), "the table in docs/language.md is that of src/diag/codes.rs");
        for entry in entries() {
            assert!(entry.text.len() > 80, "{} says too little", entry.code);
        }
    }

    #[test]
    fn codes_are_found_and_read_well() {
        assert!(is_code("U0203") && is_code("u0203") && !is_code("U02034") && !is_code("tables/U0203"));
        assert_eq!(entry("u0401").map(|entry| entry.code), Some("U0401"));
        assert_eq!(entry("U9999"), None);
        let text = entry("U0401").map(|entry| entry.plain()).unwrap_or_default();
        assert_eq!(
            text,
            "U0401: a table without cases\n\nA table needs at least one case. What holds everywhere is the `default`.\n\n\
             For instance:\n\n    cases: [],\n\nBetter:\n\n    cases: [Case(id: 1, when: \"wet\", value: \"x\")],\n"
        );
    }
}
