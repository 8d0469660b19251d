//! The WGSL around the tables of techniques: loops and walks, written by hand,
//! that find a table's inputs and call the module that is emitted for it.
//!
//! A renderer puts three texts together: a skeleton, the WGSL of a plan of its
//! table, and entry points of its own. These are texts only, without any feature,
//! so that a build script has them: [`Tables::skeleton`](crate::build::Tables::skeleton).
//!
//! ```
//! use umbrage::plan::{Plan, Shape};
//! use umbrage::program::Program;
//!
//! let program = Program::read("tables/rsmss.ron")?;
//! let table = umbrage::emit::wgsl(&Plan::proved(&program, Shape::Ladder)?);
//! let skeleton = umbrage::skeleton::wgsl("rsmss").expect("a name of NAMES");
//! let entry = "
//!     @fragment fn shadows(@builtin(position) at: vec4<f32>) -> @location(0) f32 {
//!         return visibility(vec2<u32>(at.xy)).value;
//!     }";
//! let text = [&skeleton, &table, entry].concat();
//! umbrage::emit::wgsl_text("shadows", &text)?;
//! # Ok::<(), umbrage::diag::Failure>(())
//! ```
//!
//! **Revectorised shadows** (`hard`, `pcf`, `smsr`, `rsmss`, `rpcf`, `casefree`) give
//! `fn visibility(pixel: vec2<u32>) -> Sample`: value, case and key of a pixel. They
//! declare their resources as bindings 0 to 4 of group 0, which `frame.wgsl`, at the
//! start of the text, describes: the uniform `frame` (eight words), the shadow map
//! `map` with a border of one texel at infinity, the sampler `nearest`, and for each
//! pixel `points` (place in the map, depth, kind) and `slopes`. `smsr` needs a module of
//! the table `smsr`; `rsmss` and `rpcf` of `rsmss`, whose fetches they provide. A plan
//! that reads its lookup from a buffer also needs `fn TABLE_lookup(word: u32) -> u32`.
//!
//! **Integrals** (`integrals`) is a whole compute shader, `light`. Its host says in
//! constants `BALLS`, `PLATES`, `CORNERS` and `LOBES` how many of each there are, and adds
//! the modules of the functions that it calls.
//!
//! **Area lights** (`peel`) is a whole compute shader, `area_light`, around modules of the tables
//! `clip_step`, `box_silhouette` and `edge_silhouette` and of the functions `term` and `small` of
//! `edge_integral`.
//!
//! **Area lights by search** (`discontinuity`) is a whole compute shader, `area_search`, around modules of the tables
//! `search_plan`, `quad_diagonal`, `triangle_configuration`, `triangle_region`, `triangle_rays`, `closest_point_setup`,
//! `closest_point_start`, `closest_point_step` and `clip_step`, and of the functions `term` and `small` of
//! `edge_integral` and `hash`, `unit` and `jitter` of `pcg`. It provides what these fetch.
//!
//! **Convolution shadows** are two compute shaders. `convolve_layers` makes layered depth images
//! (`count`, `scan_blocks`, `scan_sums`, `add_sums`, `scatter`, `arrange`, `mark`) with the function
//! `crossed` of `policies`; `convolve` sweeps light through slabs (`begin`, `sweep`) with the table
//! `slab` and the functions `opacity`, `transmittance`, `specular`, `piece_of_ramp` and `preintegrated` of
//! `shade`, `hash`, `fbm_octave`, `ridged_octave` and `brick` of `noise`.

/// The names of the skeletons.
pub const NAMES: [&str; 11] = [
    "hard",
    "pcf",
    "smsr",
    "rsmss",
    "rpcf",
    "casefree",
    "integrals",
    "peel",
    "discontinuity",
    "convolve_layers",
    "convolve",
];

/// The text around the modules of a technique's tables, as exact as the technique was published.
pub fn wgsl(name: &str) -> Option<String> {
    match name {
        "integrals" => Some(INTEGRALS.to_owned()),
        "peel" => Some(AREA.to_owned()),
        "discontinuity" => Some(SEARCH.to_owned()),
        "convolve_layers" => Some(CONVOLVE_LAYERS.to_owned()),
        "convolve" => Some(convolve(true)),
        _ => Revectorised::EXACT.wgsl(name),
    }
}

/// The directions at a surface, divided and added up.
pub(crate) const INTEGRALS: &str = include_str!("integrals.wgsl");

/// Polygons of light at the surfaces of a picture, cut and added up.
pub(crate) const AREA: &str = concat!(include_str!("area/peel.wgsl"), include_str!("area/picture.wgsl"));

/// The same at points, each with a light and bodies of its own.
#[cfg(all(feature = "gpu", feature = "render"))]
pub(crate) const AREA_POINTS: &str = concat!(include_str!("area/peel.wgsl"), include_str!("area/points.wgsl"));

/// The visible part of polygons of light, searched for by rays.
pub(crate) const SEARCH: &str = include_str!("search.wgsl");

/// Surfaces at pixels, counted, listed and sorted.
pub(crate) const CONVOLVE_LAYERS: &str = include_str!("convolve_layers.wgsl");

/// Light through slabs, with patterns inside of objects or without.
pub(crate) fn convolve(detailed: bool) -> String {
    let matter = if detailed { include_str!("convolve_detail.wgsl") } else { include_str!("convolve_plain.wgsl") };
    [include_str!("convolve.wgsl"), "\n", matter].concat()
}

/// The reads of a shadow map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reads {
    /// One texel at a time, as the authors' shaders do.
    Single,
    /// Four texels at a time: two gathers see a texel with its neighbours, one more two steps of a walk.
    Gathered,
}

/// Choices in a skeleton of revectorised shadows that cost time and change no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Revectorised {
    /// The reads of the map. The case-free shader reads single texels.
    pub reads: Reads,
    /// True if it reads which discontinuity dominates at corners, and so takes the very case of the
    /// table. Otherwise both are said to dominate, which is another case of the same value.
    pub dominance: bool,
}

impl Revectorised {
    /// The cases as published.
    pub const EXACT: Revectorised = Revectorised { reads: Reads::Gathered, dominance: true };

    /// The text around a module of any plan of the variant's table, if there is a variant of this name.
    pub fn wgsl(self, variant: &str) -> Option<String> {
        let key = match variant {
            "smsr" => include_str!("revectorise/smsr_key.wgsl"),
            "rsmss" | "rpcf" => include_str!("revectorise/rsmss_key.wgsl"),
            _ => "",
        };
        self.with_key(variant, key)
    }

    /// The same with another function `table_key`, which makes a key of the plan from levels.
    pub(crate) fn with_key(self, variant: &str, key: &str) -> Option<String> {
        const FRAME: &str = include_str!("revectorise/frame.wgsl");
        const EDGES: &str = include_str!("revectorise/edges.wgsl");
        const SINGLE_READS: &str = include_str!("revectorise/reads_single.wgsl");
        const DOMINANCE: &str = include_str!("revectorise/dominance.wgsl");
        const RSMSS: &str = include_str!("revectorise/rsmss.wgsl");
        const ONE_SAMPLE: &str = include_str!("revectorise/single.wgsl");
        let reads = match self.reads {
            Reads::Single => SINGLE_READS,
            Reads::Gathered => include_str!("revectorise/reads_gathered.wgsl"),
        };
        let dominance = format!("const READ_DOMINANCE: bool = {};\n", self.dominance);
        let around = |own, samples| [FRAME, &dominance, reads, EDGES, DOMINANCE, own, key, samples].concat();
        Some(match variant {
            "hard" => [FRAME, include_str!("revectorise/hard.wgsl")].concat(),
            "pcf" => [FRAME, include_str!("revectorise/pcf.wgsl")].concat(),
            "smsr" => around(include_str!("revectorise/smsr.wgsl"), ONE_SAMPLE),
            "rsmss" => around(RSMSS, ONE_SAMPLE),
            "rpcf" => around(RSMSS, include_str!("revectorise/rpcf.wgsl")),
            "casefree" => {
                let none = "const READ_DOMINANCE: bool = false;\n";
                [FRAME, none, EDGES, SINGLE_READS, include_str!("revectorise/casefree.wgsl"), ONE_SAMPLE].concat()
            }
            _ => return None,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::{self, wgsl_text};
    use crate::plan::{Plan, Shape};
    use crate::program::Program;

    #[test]
    fn every_skeleton_of_a_picture_is_whole_with_its_table() {
        // Others are whole shaders.
        let is_part = |name: &&str| wgsl(name).is_some_and(|text| !text.contains("@compute"));
        for name in NAMES.into_iter().filter(is_part) {
            let table = match name {
                "smsr" => Some("tables/smsr.ron"),
                "rsmss" | "rpcf" => Some("tables/rsmss.ron"),
                _ => None,
            };
            let module = table.map(|path| {
                let program = Program::read(path).unwrap_or_else(|e| panic!("{e}"));
                emit::wgsl(&Plan::proved(&program, Shape::Ladder).unwrap_or_else(|e| panic!("{e}")))
            });
            let entry = "@group(1) @binding(0) var<storage, read_write> lit: f32;
                @compute @workgroup_size(1) fn one() { lit = visibility(vec2<u32>(0u)).value; }";
            let skeleton = wgsl(name).unwrap_or_else(|| panic!("{name}"));
            let text = [&skeleton, module.as_deref().unwrap_or_default(), entry].concat();
            wgsl_text(name, &text).unwrap_or_else(|e| panic!("{name}: {e}"));
        }
        assert!(wgsl("integrals").is_some_and(|text| text.contains("fn light(")) && wgsl("reference").is_none());
    }
}
