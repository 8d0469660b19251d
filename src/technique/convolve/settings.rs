//! The choices of the technique. Words are names of levels of `tables/policies.ron` and `tables/kernels.ron`.

use super::inside::InsideRule;
use super::kernel::Kernel;
use super::light::Split;
use super::matter::SlabPolicies;
use super::stencil::Border;
use super::steps::{Phase, Spread};
use super::view::Projection;
use crate::technique::Setting;
use crate::technique::setting::{SEED, Settings};

/// The number of slabs.
pub const SLABS: Setting = Setting::whole("slabs", "slabs from the nearest surface to the farthest", 400, (1, 1 << 20));
/// The distance at which penumbras are right.
pub const DISTANCE: Setting =
    Setting::number("distance", "distance at which penumbras are right; 0 is half of the depth", 0.0, (0.0, 1e6));
/// The kernel.
pub const KERNEL: Setting = Setting::word(
    "kernel",
    "the blur of a slab",
    &["ring_affine", "ring_arc", "poisson8", "poisson16", "gauss19x19", "frac_box", "binomial3"],
);
/// The samples of a ring.
pub const SAMPLES: Setting = Setting::whole("samples", "samples of a ring", 3, (2, 64));
/// The sequence of phases.
pub const PHASE: Setting =
    Setting::word("phase", "how samples move along their curve", &["golden", "steady", "random", "pixel"]);
/// The answer to the blur of interpolation.
pub const SMEAR: Setting = Setting::word(
    "smear",
    "what is done about the blur of interpolation",
    &["advised", "none", "subtract", "stride", "snap"],
);
/// Matter of slabs that are not inside from front to back.
pub const COVERAGE: Setting =
    Setting::word("coverage", "how much matter a slab holds at a surface", &["full", "exact"]);
/// The crossing that is shaded.
pub const HIT: Setting = Setting::word("hit", "which of several surfaces in a slab is seen", &["first", "last"]);
/// The rule that separates inside from outside.
pub const RULE: Setting = Setting::word("rule", "what separates inside from outside", &["parity", "winding"]);
/// The fate of lists that end inside.
pub const ODD: Setting = Setting::word(
    "odd",
    "what becomes of a pixel whose ray goes into matter and never comes out",
    &["drop_last", "close_at_end", "error"],
);
/// Light beside the picture.
pub const BORDER: Setting = Setting::word("border", "the light beside the picture", &["unoccluded", "clamp"]);
/// The projection.
pub const PROJECTION: Setting =
    Setting::word("projection", "how slabs are seen", &["orthographic", "perspective_world", "perspective_follow"]);
/// The lights that each light is split into.
pub const SPLIT: Setting = Setting::whole("split", "lights that each light is split into, but not 2", 1, (1, 1024));
/// The share of its covariance that they keep.
pub const RHO: Setting =
    Setting::number("rho", "share of a light's covariance that each of its parts keeps", 0.15, (0.0, 1.0));
/// Light on slopes.
pub const SLOPES: Setting = Setting::word(
    "slopes",
    "what is done about light on opaque slopes, which iterating makes too dark",
    &["none", "compensate"],
);
/// Matter with detail between two values.
pub const DETAIL: Setting = Setting::word(
    "detail",
    "how patterns inside of slabs are taken: at a place, or from front to back",
    &["sampled", "integrated"],
);
/// Frames that are accumulated.
pub const FRAMES: Setting = Setting::whole(
    "frames",
    "frames that are averaged, each with the next part of every light; 0 is all parts in one",
    0,
    (0, 1 << 16),
);
/// Steps through empty slabs.
pub const SKIP: Setting =
    Setting::whole("skip", "most steps through a run of empty slabs; 0 is one a slab", 16, (0, 1 << 20));
/// The numbers that light is kept in.
pub const PRECISION: Setting = Setting::word("precision", "the numbers that light is kept in", &["f32", "f64"]);
/// The lights of the reference.
pub const SHARP_LIGHTS: Setting =
    Setting::whole("sharp_lights", "sharp lights that stand for each light", 256, (3, 1 << 16));

/// Everything that the technique is told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chosen {
    /// Slabs.
    pub slabs: usize,
    /// The rule that separates inside from outside.
    pub inside: InsideRule,
    /// Policies of slabs.
    pub policies: SlabPolicies,
    /// Light beside the picture.
    pub border: Border,
    /// The projection.
    pub projection: Projection,
    /// The way from blurs to samples; a distance of 0 stands for half of the depth.
    pub spread: Spread,
    /// The parts of each light.
    pub split: Split,
    /// Frames that are averaged, each with one part of every light; 0 for all parts at once.
    pub frames: u32,
    /// Set if light on opaque slopes is put right.
    pub compensates: bool,
    /// Set if matter with detail is integrated from front to back of a slab.
    pub integrates: bool,
    /// Set if light is kept in double precision.
    pub wide: bool,
}

impl Chosen {
    /// The choices for the technique.
    pub fn of(settings: &Settings) -> Self {
        let word = |setting: &Setting| settings.word(setting);
        let lights = settings.whole(&SPLIT);
        Self {
            slabs: settings.whole(&SLABS) as usize,
            inside: InsideRule { rule: word(&RULE), odd_list: word(&ODD) },
            policies: SlabPolicies { coverage: word(&COVERAGE), hit: word(&HIT) },
            border: if word(&BORDER) == "clamp" { Border::Clamp } else { Border::Unoccluded },
            projection: match word(&PROJECTION) {
                "perspective_world" => Projection::PerspectiveWorld,
                "perspective_follow" => Projection::PerspectiveFollow,
                _ => Projection::Orthographic,
            },
            spread: Spread {
                kernel: Kernel { family: word(&KERNEL), samples: settings.whole(&SAMPLES) },
                phase: match word(&PHASE) {
                    "steady" => Phase::Steady,
                    "random" => Phase::Random,
                    "pixel" => Phase::Pixel,
                    _ => Phase::Golden,
                },
                seed: settings.whole(&SEED),
                smear: Some(word(&SMEAR)).filter(|smear| *smear != "advised"),
                d1: settings.number(&DISTANCE),
                skip: settings.whole(&SKIP) as usize,
            },
            split: Split { lights, rho: if lights == 1 { 1.0 } else { settings.number(&RHO) } },
            frames: settings.whole(&FRAMES),
            integrates: word(&DETAIL) == "integrated",
            compensates: word(&SLOPES) == "compensate",
            wide: word(&PRECISION) == "f64",
        }
    }

    /// The choices for its reference: many sharp lights, in double precision where asked.
    pub fn of_reference(settings: &Settings) -> Self {
        let chosen = Self::of(settings);
        Self {
            spread: Spread { smear: Some("snap"), skip: 1, ..chosen.spread },
            split: Split { lights: settings.whole(&SHARP_LIGHTS), rho: 0.0 },
            frames: 0,
            compensates: false,
            ..chosen
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::program::Domain;
    use crate::technique::setting::Range;
    use crate::technique::tables::{BuiltIn, KERNELS, POLICIES, SLAB};

    /// The levels of an input of a table or one of its functions.
    fn levels(table: &'static BuiltIn, input: &str) -> Vec<String> {
        let all = table.programs().expect("built in").iter().flat_map(|program| &program.inputs);
        let found = all.filter(|of| of.name == input).find_map(|of| match &of.domain {
            Domain::Discrete(levels) => Some(levels.names.clone()),
            Domain::Continuous { .. } | Domain::Word => None,
        });
        found.unwrap_or_else(|| panic!("no input `{input}`"))
    }

    #[test]
    fn words_are_those_of_the_tables() {
        for (setting, table, input) in [(RULE, &POLICIES, "inside_rule"), (COVERAGE, &SLAB, "coverage")] {
            let Range::Word(words) = setting.range else { panic!("{input}: words") };
            assert_eq!(words, levels(table, input), "{input}");
        }
        let Range::Word(kernels) = KERNEL.range else { panic!("words") };
        let programs = KERNELS.programs().expect("built in").iter();
        let functions: Vec<&str> = programs.filter_map(|p| p.function.as_ref()).map(|f| f.name.as_str()).collect();
        for kernel in kernels.iter().filter(|kernel| **kernel != "gauss19x19") {
            assert!(functions.contains(kernel), "{kernel}");
        }
    }
}
