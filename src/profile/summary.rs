//! Profiles in few numbers: frequencies of cases, and their changes.

use std::collections::BTreeSet;

use super::Profile;
use crate::program::Program;

/// The frequency of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct Frequency {
    /// The case; `None` is the default.
    pub case: Option<u32>,
    /// Its share of all evaluations, by the weights of the scenes.
    pub share: f64,
    /// The mean of its shares in the scenes, each scene counting alike.
    pub mean: f64,
    /// The standard deviation of those shares; 0 for a single scene.
    pub deviation: f64,
    /// Its share in each scene.
    pub scenes: Vec<f64>,
}

/// The cases of a profile, in their order, the default last.
pub fn frequencies(profile: &Profile) -> Vec<Frequency> {
    let mut cases: BTreeSet<Option<u32>> = profile.scenes.iter().flat_map(|s| s.cases.keys().copied()).collect();
    let default = cases.remove(&None).then_some(None);
    let totals: Vec<f64> = profile.scenes.iter().map(|scene| scene.total() as f64).collect();
    let weighted_total: f64 = profile.scenes.iter().zip(&totals).map(|(scene, total)| scene.weight * total).sum();
    let of = |case: Option<u32>| {
        let counts: Vec<f64> =
            profile.scenes.iter().map(|scene| scene.cases.get(&case).copied().unwrap_or(0) as f64).collect();
        let weighted: f64 = profile.scenes.iter().zip(&counts).map(|(scene, count)| scene.weight * count).sum();
        let scenes: Vec<f64> = counts.iter().zip(&totals).map(|(count, total)| ratio(*count, *total)).collect();
        let mean = ratio(scenes.iter().sum(), scenes.len() as f64);
        let squares: f64 = scenes.iter().map(|share| (share - mean).powi(2)).sum();
        let deviation = if scenes.len() > 1 { (squares / (scenes.len() - 1) as f64).sqrt() } else { 0.0 };
        Frequency { case, share: ratio(weighted, weighted_total), mean, deviation, scenes }
    };
    cases.into_iter().chain(default).map(of).collect()
}

/// The share of all evaluations that takes each row of a program.
pub fn shares(profile: &Profile, program: &Program) -> Vec<f64> {
    let found = frequencies(profile);
    let of = |id: u32| found.iter().find(|frequency| frequency.case == Some(id)).map_or(0.0, |f| f.share);
    program.rows.iter().map(|row| of(row.id)).collect()
}

fn ratio(part: f64, whole: f64) -> f64 {
    if whole > 0.0 { part / whole } else { 0.0 }
}

/// The share of a case in two profiles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// The case; `None` is the default.
    pub case: Option<u32>,
    /// Its share in the first profile.
    pub before: f64,
    /// Its share in the second one.
    pub after: f64,
}

/// The cases of two profiles, in their order, the default last.
pub fn changes(before: &Profile, after: &Profile) -> Vec<Change> {
    let (before, after) = (frequencies(before), frequencies(after));
    let share = |all: &[Frequency], case| all.iter().find(|f| f.case == case).map_or(0.0, |f| f.share);
    let cases: BTreeSet<(bool, Option<u32>)> =
        before.iter().chain(&after).map(|frequency| (frequency.case.is_none(), frequency.case)).collect();
    let change = |(_, case)| Change { case, before: share(&before, case), after: share(&after, case) };
    cases.into_iter().map(change).collect()
}

/// The distance between the distributions of states of two profiles: the share of
/// evaluations that would have to be others, 0 to 1. `None` if the inputs differ.
pub fn total_variation(a: &Profile, b: &Profile) -> Option<f64> {
    if a.inputs != b.inputs {
        return None;
    }
    let (a, b) = (a.state_weights(), b.state_weights());
    let (sum_a, sum_b) = (a.iter().sum(), b.iter().sum());
    Some(a.iter().zip(&b).map(|(a, b)| (ratio(*a, sum_a) - ratio(*b, sum_b)).abs()).sum::<f64>() / 2.0)
}

#[cfg(test)]
mod tests {
    use super::super::tests::{scene, smsr};
    use super::*;

    #[test]
    fn shares_means_and_deviations() {
        let mut profile = Profile::new(&smsr());
        profile.scenes.push(scene("a", &[(1, 100)], &[(Some(1), 75), (None, 25)]));
        profile.scenes.push(scene("b", &[(2, 300)], &[(Some(1), 75), (Some(2), 225)]));
        let found = frequencies(&profile);
        assert_eq!(found.iter().map(|f| f.case).collect::<Vec<_>>(), [Some(1), Some(2), None]);
        assert_eq!((found[0].share, found[0].mean), (0.375, 0.5));
        assert!((found[0].deviation - 0.125_f64.sqrt()).abs() < 1e-12);
        assert_eq!(found[1].scenes, [0.0, 0.75]);

        let mut other = profile.clone();
        other.scenes.remove(0);
        assert_eq!(changes(&profile, &other)[0], Change { case: Some(1), before: 0.375, after: 0.25 });
        assert_eq!(total_variation(&profile, &other), Some(0.25));
        assert_eq!(total_variation(&profile, &profile), Some(0.0));
    }
}
