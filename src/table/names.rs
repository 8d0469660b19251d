//! The names that a table may use.
//!
//! Names of tables, inputs and levels appear verbatim in every generated
//! language, so that shader and table read alike. That is only safe if a name
//! is a plain identifier and means nothing yet in any of those languages.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use crate::diag::{Diagnostic, Span, Spanned, codes};

/// Longest accepted name, in characters.
pub(crate) const MAX_LENGTH: usize = 64;

/// The words of WGSL, GLSL, Rust and of the expression language itself, each
/// with the languages that claim it. HLSL and MSL are written by naga, which
/// renames what collides there.
fn reserved() -> &'static BTreeMap<&'static str, &'static str> {
    static WORDS: OnceLock<BTreeMap<&'static str, &'static str>> = OnceLock::new();
    WORDS.get_or_init(|| include_str!("reserved.txt").lines().filter_map(|line| line.split_once(' ')).collect())
}

/// Checks the name of a table, input or named value.
/// Dots group inputs (`d_c.r`): each part is checked by itself.
pub(crate) fn check(name: &str, what: &str, span: Span) -> Result<(), Diagnostic> {
    well_formed(name, what, span)?;
    // GLSL and WebGL keep everything that begins so, macros in capitals; generated names begin with that of the table.
    for start in ["gl", "webgl"] {
        let begins = name.get(..start.len()).is_some_and(|first| first.eq_ignore_ascii_case(start));
        let rest = name.get(start.len()..).filter(|_| begins);
        if rest.is_some_and(|rest| rest.starts_with(['_', '.']) || (rest.is_empty() && what == "a table")) {
            return Err(Diagnostic::error(
                codes::RESERVED_NAME,
                format!("names that begin with `{start}_` are reserved"),
            )
            .at(span, format!("cannot be the name of {what}"))
            .help("the names are taken in: GLSL"));
        }
    }
    if what == "a table" && is_device(name) {
        return Err(Diagnostic::error(codes::RESERVED_NAME, format!("`{name}` is the name of a device on Windows"))
            .at(span, format!("cannot be the name of {what}"))
            .help("the files of a table lie in a directory of its name, which could not be made there"));
    }
    for part in name.split('.') {
        if let Some(languages) = reserved().get(part) {
            return Err(Diagnostic::error(codes::RESERVED_NAME, format!("`{part}` is a reserved word"))
                .at(span, format!("cannot be the name of {what}"))
                .help(format!("the word is taken in: {}", languages.replace(' ', ", ")))
                .help(format!("choose another name, for instance `{part}_in`")));
        }
    }
    Ok(())
}

/// Returns whether Windows takes a name for a device, in whatever directory.
fn is_device(name: &str) -> bool {
    let lower = name.to_ascii_lowercase();
    let numbered = |port: &str| lower.strip_prefix(port).is_some_and(|rest| matches!(rest.as_bytes(), [b'0'..=b'9']));
    matches!(lower.as_str(), "aux" | "con" | "nul" | "prn" | "conin" | "conout") || numbered("com") || numbered("lpt")
}

/// Checks a name that appears in generated code only inside longer names or
/// comments (a level, a symmetry, an assumption), where reserved words are harmless.
pub(crate) fn check_inner(name: &str, what: &str, span: Span) -> Result<(), Diagnostic> {
    if name.contains('.') {
        return Err(malformed(name, what, span));
    }
    well_formed(name, what, span)
}

/// Checks the name of a field of a record, which differs from those before it.
pub(crate) fn check_field<'n>(
    name: &Spanned<String>,
    mut before: impl Iterator<Item = &'n Spanned<String>>,
) -> Result<(), Diagnostic> {
    check(&name.value, "a field of a record", name.span)?;
    if name.value.contains('.') {
        return Err(Diagnostic::error(codes::BAD_NAME, "the name of a field contains no dot")
            .at(name.span, "dots group inputs"));
    }
    match before.find(|other| other.value == name.value) {
        None => Ok(()),
        Some(first) => Err(Diagnostic::error(codes::DUPLICATE, format!("`{}` is given twice", name.value))
            .at(name.span, "again")
            .at(first.span, "first here")),
    }
}

/// Words of the expression language that can never be read as the name of a level.
const KEYWORDS: [&str; 7] = ["case", "else", "false", "if", "in", "let", "true"];

/// Checks the name of a level: it must also be possible to write it in an expression.
pub(crate) fn check_level(name: &str, span: Span) -> Result<(), Diagnostic> {
    check_inner(name, "a level", span)?;
    match KEYWORDS.contains(&name) {
        false => Ok(()),
        true => Err(Diagnostic::error(codes::RESERVED_NAME, format!("`{name}` is a word of the expression language"))
            .at(span, "cannot be the name of a level")
            .help(format!(
                "an expression could not mention the level; choose another name, for instance `{name}_level`"
            ))),
    }
}

fn well_formed(name: &str, what: &str, span: Span) -> Result<(), Diagnostic> {
    let part_ok = |part: &str| {
        part.starts_with(|c: char| c.is_ascii_alphabetic())
            && part.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
            && !part.ends_with('_')
            && !part.contains("__")
    };
    if name.chars().count() > MAX_LENGTH || !name.split('.').all(part_ok) {
        return Err(malformed(name, what, span));
    }
    Ok(())
}

fn malformed(name: &str, what: &str, span: Span) -> Diagnostic {
    let mut shown: String = name.chars().take(24).collect();
    if shown.len() < name.len() {
        shown.push_str("...");
    }
    Diagnostic::error(codes::BAD_NAME, format!("`{}` cannot be the name of {what}", shown.escape_debug()))
        .at(span, "not a plain identifier")
        .help(format!(
            "a name starts with a letter and goes on with letters, digits and single underscores, \
             does not end in an underscore, and has at most {MAX_LENGTH} characters"
        ))
}

/// The identifier that a table name becomes in generated code.
pub(crate) fn identifier(name: &str) -> String {
    name.replace('.', "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn accepts_the_names_of_the_papers() {
        for name in ["H", "tV", "d_c.r", "n_top", "px", "C0"] {
            assert!(check(name, "an input", Span::default()).is_ok(), "{name}");
        }
    }

    #[test]
    fn refuses_macros_and_devices() {
        for name in ["GL_ES", "GL_core_profile", "gl_x", "Gl.x", "WEBGL_x", "VULKAN"] {
            assert!(check(name, "an input", Span::default()).is_err(), "{name}");
        }
        for name in ["con", "NUL", "Com1", "lpt9", "GL"] {
            assert!(check(name, "a table", Span::default()).is_err(), "{name}");
        }
        for name in ["con", "com1", "GLx", "glory", "webglue"] {
            assert!(check(name, "an input", Span::default()).is_ok(), "{name}");
        }
        for name in ["com", "com10", "console"] {
            assert!(check(name, "a table", Span::default()).is_ok(), "{name}");
        }
    }

    #[test]
    fn refuses_code_and_reserved_words() {
        for name in ["", "1a", "a b", "a;}fn f(", "a__b", "_a", "a_", "é", "a.", "fn", "uniform", "self", "d.float"] {
            assert!(check(name, "an input", Span::default()).is_err(), "{name}");
        }
        assert!(check_level("default", Span::default()).is_ok());
        for word in KEYWORDS {
            assert!(check_level(word, Span::default()).is_err(), "{word}");
            assert!(check_inner(word, "a symmetry", Span::default()).is_ok(), "{word}");
        }
    }
}
