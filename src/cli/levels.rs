//! `-W`, `-D` and `-A`: the levels of findings.

use crate::analyse::{LintLevel, LintLevels};

/// Arguments of commands that report findings.
#[derive(clap::Args)]
pub(super) struct LevelArguments {
    /// Report these findings as warnings (exit code 1), whatever they are by themselves
    #[arg(long = "warn", short = 'W', value_name = "CODE", value_delimiter = ',', value_parser = parse(LintLevel::Warn))]
    warn: Vec<String>,
    /// Report these findings as errors (exit code 2)
    #[arg(long = "deny", short = 'D', value_name = "CODE", value_delimiter = ',', value_parser = parse(LintLevel::Deny))]
    deny: Vec<String>,
    /// Do not report these findings
    #[arg(long = "allow", short = 'A', value_name = "CODE", value_delimiter = ',', value_parser = parse(LintLevel::Allow))]
    allow: Vec<String>,
}

/// Accepts the codes that can have this level.
fn parse(level: LintLevel) -> impl Fn(&str) -> Result<String, String> + Clone {
    move |code| LintLevels::default().set(code, level).map(|()| code.to_ascii_uppercase())
}

impl LevelArguments {
    /// The levels asked for. Of several for one code the strictest counts.
    pub(super) fn levels(&self) -> LintLevels {
        let mut levels = LintLevels::default();
        for (codes, level) in
            [(&self.allow, LintLevel::Allow), (&self.warn, LintLevel::Warn), (&self.deny, LintLevel::Deny)]
        {
            for code in codes {
                // They were accepted one by one when the arguments were read.
                let _ = levels.set(code, level);
            }
        }
        levels
    }
}
