//! The known word that a misspelt one was meant to be.

/// Longer words are no names, and comparing them takes long.
const LONGEST: usize = 64;

/// The known name closest to a misspelt one, if any is close. Wrong capitals are the smallest mistake.
pub(crate) fn nearest<'n>(found: &str, known: impl IntoIterator<Item = &'n str>) -> Option<&'n str> {
    if found.len() > LONGEST {
        return None;
    }
    let limit = (found.chars().count() / 3).max(1);
    let folded = found.to_lowercase();
    known
        .into_iter()
        .map(|k| (strsim::levenshtein(&folded, &k.to_lowercase()), strsim::levenshtein(found, k), k))
        .filter(|(d, ..)| *d <= limit)
        .min()
        .map(|(_, _, k)| k)
}

#[cfg(test)]
mod tests {
    use super::nearest;

    #[test]
    fn a_name_in_the_wrong_capitals_is_the_nearest() {
        assert_eq!(nearest("b", ["A", "B", "b1"]), Some("B"));
        assert_eq!(nearest("LO_ENDS", ["Lo", "Lo_ends"]), Some("Lo_ends"));
        assert_eq!(nearest("sine", ["sin", "cos"]), Some("sin"));
        assert_eq!(nearest("tangent", ["sin", "cos"]), None);
    }
}
