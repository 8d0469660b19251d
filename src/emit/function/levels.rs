//! Conditions on discrete inputs: the level that a key holds, compared with those that are asked for.

use super::body::Body;
use crate::program::{Domain, InputId, LevelKind, LevelSet};

/// Most levels that are compared one by one.
const FEW: usize = 4;

impl Body<'_, '_> {
    /// The condition that an input has one of some levels.
    pub(super) fn level(&self, input: InputId, levels: LevelSet) -> String {
        let declared = &self.plan.program.inputs[input.index()];
        let name = &declared.ident;
        let Domain::Discrete(known) = &declared.domain else { return "false".to_owned() };
        if known.kind == LevelKind::Bool {
            return if levels.contains(1) { name.clone() } else { format!("!{name}") };
        }
        let constant = |level: u8| {
            let constant = self.names.level(self.plan.program, input, level).map(str::to_owned);
            constant.unwrap_or_else(|| self.dialect.uint(u32::from(level)))
        };
        let inside: Vec<u8> = levels.iter().collect();
        let outside: Vec<u8> = (0..known.count() as u8).filter(|l| !levels.contains(*l)).collect();
        let all = |levels: &[u8], symbol: &str, joint: &str| {
            let parts: Vec<String> = levels.iter().map(|l| format!("{name} {symbol} {}", constant(*l))).collect();
            if let [one] = parts.as_slice() {
                return format!("({one})");
            }
            let parts: Vec<String> = parts.iter().map(|p| format!("({p})")).collect();
            format!("({})", parts.join(joint))
        };
        match (inside.as_slice(), outside.as_slice()) {
            (inside, outside) if inside.len() <= outside.len().min(FEW) => all(inside, "==", " || "),
            (inside, outside) if outside.len() <= inside.len().min(FEW) => all(outside, "!=", " && "),
            ([first, .., last], _) if usize::from(last - first) + 1 == inside.len() => {
                let ends = [(*first > 0, ">=", *first), (usize::from(*last) + 1 < known.count(), "<=", *last)];
                let parts = ends.into_iter().filter(|(counts, ..)| *counts);
                let parts: Vec<String> =
                    parts.map(|(_, symbol, l)| format!("{name} {symbol} {}", constant(l))).collect();
                if let [one] = parts.as_slice() {
                    return format!("({one})");
                }
                let parts: Vec<String> = parts.iter().map(|p| format!("({p})")).collect();
                format!("({})", parts.join(" && "))
            }
            _ => self.among(name, levels),
        }
    }

    /// A bit for each level, of which that of the input is looked at.
    fn among(&self, name: &str, levels: LevelSet) -> String {
        let uint = |value: u32| self.dialect.uint(value);
        let (low, high) = (levels.0 as u32, (levels.0 >> 32) as u32);
        let (word, at) = match (low, high) {
            (low, 0) if low < 1 << 31 => (uint(low), name.to_owned()),
            (low, high) => {
                let is_high = format!("{name} >= {}", uint(32));
                (self.dialect.select(&is_high, &uint(high), &uint(low)), format!("({name} & {})", uint(31)))
            }
        };
        self.dialect.has_bit(&word, &at)
    }
}
