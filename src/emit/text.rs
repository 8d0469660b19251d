//! Indented lines of generated text, and comments that cannot break out.

/// Collects lines.
#[derive(Debug, Default)]
pub(super) struct Text {
    out: String,
    indent: usize,
}

impl Text {
    /// The text so far.
    pub(super) fn finish(self) -> String {
        self.out
    }

    /// A line at the current depth. Several lines keep their own indentation.
    pub(super) fn line(&mut self, line: impl AsRef<str>) {
        for part in line.as_ref().lines() {
            if !part.is_empty() {
                self.out.extend(std::iter::repeat_n("    ", self.indent));
                self.out.push_str(part);
            }
            self.out.push('\n');
        }
    }

    /// An empty line.
    pub(super) fn gap(&mut self) {
        self.out.push('\n');
    }

    /// A comment line.
    pub(super) fn comment(&mut self, text: &str) {
        self.line(format!("// {}", harmless(text)).trim_end());
    }

    /// A line of documentation, in Rust.
    pub(super) fn doc(&mut self, text: &str) {
        self.line(format!("/// {}", harmless(text)));
    }

    /// A line that opens a block.
    pub(super) fn open(&mut self, line: impl AsRef<str>) {
        self.line(line);
        self.indent += 1;
    }

    /// Closes a block and opens that of the other case.
    pub(super) fn otherwise(&mut self) {
        self.indent = self.indent.saturating_sub(1);
        self.open("} else {");
    }

    /// Closes a block.
    pub(super) fn close(&mut self) {
        self.close_with("}");
    }

    /// Closes a block that ends in something else than a brace.
    pub(super) fn close_with(&mut self, end: &str) {
        self.indent = self.indent.saturating_sub(1);
        self.line(end);
    }
}

/// Text for a comment: one line of printable ASCII. Line breaks (WGSL knows
/// several in Unicode) and backslashes (which continue a line in GLSL and
/// HLSL) would otherwise let a description end its comment or swallow code.
pub(super) fn harmless(text: &str) -> String {
    text.chars()
        .map(|c| match c {
            '\\' => '/',
            ' '..='~' => c,
            c if c.is_whitespace() || c.is_control() => ' ',
            _ => '?',
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_stay_comments() {
        assert_eq!(harmless("a\nfn evil() {}\u{2028}b\\"), "a fn evil() {} b/");
    }
}
