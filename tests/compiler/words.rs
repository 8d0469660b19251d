//! Documentation opens with nouns and verbs, as CONTRIBUTING.md asks.

use std::path::{Path, PathBuf};

/// Words that open a question, or a clause that stands for a noun.
const OPENINGS: [&str; 6] = ["What", "Whether", "How", "Where", "Which", "Who"];

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut all = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(files(&path));
        } else if path.extension().is_some_and(|end| end == "rs") {
            all.push(path);
        }
    }
    all.sort();
    all
}

/// The text of a line of documentation.
fn documentation(line: &str) -> Option<&str> {
    let line = line.trim_start();
    ["///", "//!"].into_iter().find_map(|mark| line.strip_prefix(mark)).map(str::trim_start)
}

#[test]
fn no_documentation_opens_with_a_question() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (mut wrong, mut blocks) = (Vec::new(), 0);
    for path in files(&root.join("src")) {
        let text = std::fs::read_to_string(&path).unwrap();
        let mut before = None;
        for (line, number) in text.lines().zip(1..) {
            let here = documentation(line);
            if let (None, Some(text)) = (before, here) {
                blocks += 1;
                if text.split_whitespace().next().is_some_and(|first| OPENINGS.contains(&first)) {
                    wrong.push(format!("{}:{number}: {text}", path.strip_prefix(root).unwrap().display()));
                }
            }
            before = here;
        }
    }
    assert!(blocks > 1000, "only {blocks} blocks of documentation were found");
    assert!(wrong.is_empty(), "say it with a noun, or with a verb in the third person:\n{}", wrong.join("\n"));
}
