//! Tables of any size, for measuring and testing how everything grows with it.

use std::fmt::Write;

/// Levels of each discrete input.
const LEVELS: usize = 8;

/// A table with so many cases: fifteen of sixteen claim two states each, the
/// others are broad and come last, so that they take what is left.
pub(crate) fn table(cases: usize) -> String {
    let mut digits = 3;
    while LEVELS.pow(digits) < 3 * cases {
        digits += 1;
    }
    let pairs = LEVELS.pow(digits) / 2;
    let mut out = format!(
        "Table(language: 1, name: \"synthetic_{cases}\", hit_policy: First,\n  levels: {{\"level\": {{{}}}}},\n  inputs: {{\n",
        (0..LEVELS).map(|level| format!("\"l{level}\": {level}")).collect::<Vec<_>>().join(", ")
    );
    for digit in 0..digits {
        let _ = writeln!(out, "    \"d{digit}\": Levels(of: \"level\"),");
    }
    out += "    \"x\": Range(from: 0, to: 1),\n    \"y\": Range(from: 0, to: 1),\n  },\n  output: Number(clamp: (0, 1)),\n  cases: [\n";
    let broad = cases / 16;
    for case in 0..cases {
        // A multiple that is prime to the number of pairs spreads the cases and repeats none.
        let pair = case * 7919 % pairs;
        let mut rest = pair / (LEVELS / 2);
        let last = pair % (LEVELS / 2) * 2;
        let kept = if case >= cases - broad { digits - 2 } else { digits - 1 };
        let mut guard = Vec::new();
        for digit in 0..digits - 1 {
            if digit < kept {
                guard.push(format!("d{digit} == l{}", rest % LEVELS));
            }
            rest /= LEVELS;
        }
        if kept == digits - 1 {
            guard.push(format!("d{} in {{l{last}, l{}}}", digits - 1, last + 1));
        }
        let (a, b) = (case % 7, case % 5);
        let value = format!("{} + {a} * x - {b} * y", case % 3);
        let _ = writeln!(out, "    Case(id: {}, when: \"{}\", value: \"{value}\"),", case + 1, guard.join(" && "));
    }
    out + "  ],\n  default: 0.5,\n)\n"
}
