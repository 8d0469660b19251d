//! A table in whatever layout RON allows: blanks, lines, comments, words left out, raw strings.

use crate::choices::Choices;

/// Spreads a table that stands in one line.
pub(super) fn spread(choices: &mut Choices<'_>, plain: &str) -> String {
    let style = choices.below(4);
    if style == 0 {
        // One field a line, as most people begin.
        return plain.replace("Case(", "\n    Case(").replace("), \"", "),\n    \"");
    }
    let comments = style == 3;
    let mut text = String::new();
    if choices.one_in(6) {
        text += "// What it is for\n\n";
    }
    let tokens = tokens(plain);
    for (place, token) in tokens.iter().enumerate() {
        let word = matches!(*token, "Table" | "Case" | "Symmetry" | "Function");
        if word && tokens.get(place + 1) == Some(&"(") && choices.one_in(4) {
            // The word may be left out, the parentheses may not. `Function` is one of these, too.
            continue;
        }
        let comma_last = *token == "," && choices.one_in(40);
        match token.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
            Some(inner) if !inner.contains('\\') && choices.one_in(30) => text += &format!("r\"{inner}\""),
            _ => text += token,
        }
        let closing = matches!(tokens.get(place + 1), Some(&(")" | "]" | "}")));
        let opens = matches!(*token, "(" | "[" | "{");
        if closing && !opens && *token != "," && choices.one_in(20) {
            text.push(',');
        }
        if comments && choices.one_in(20) {
            text += *choices.pick(&[" // why\n", " /* so */ ", " /* a /* b */ */", "//\n", " // ) \" {\n"]);
        }
        let blank = *choices.pick(&["", "", " ", " ", "\n", "\n    ", "\t", "  ", "\r\n", "\n\n"]);
        let needs = token.ends_with(|c: char| c.is_alphanumeric());
        text += if blank.is_empty() && needs { " " } else { blank };
        if comma_last {
            text.push('\n');
        }
    }
    text
}

/// The tokens of RON, strings whole.
fn tokens(text: &str) -> Vec<&str> {
    let mut tokens = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let end = match first {
            ' ' => {
                rest = &rest[1..];
                continue;
            }
            '"' => {
                let mut escaped = false;
                let close = rest[1..].find(|c| {
                    let closes = c == '"' && !escaped;
                    escaped = c == '\\' && !escaped;
                    closes
                });
                close.map_or(rest.len(), |close| close + 2)
            }
            c if is_of_word(c) => rest.find(|c| !is_of_word(c)).unwrap_or(rest.len()),
            c => c.len_utf8(),
        };
        tokens.push(&rest[..end]);
        rest = &rest[end..];
    }
    tokens
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || matches!(c, '_' | '.' | '-' | '+')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strings_are_whole() {
        assert_eq!(tokens(r#"a: "b \" c", (-1e-3)"#), ["a", ":", r#""b \" c""#, ",", "(", "-1e-3", ")"]);
    }
}
