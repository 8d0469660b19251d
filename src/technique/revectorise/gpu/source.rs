//! The WGSL of a visibility pass: skeleton and table, put together.
//!
//! The skeleton is written by hand (`wgsl/`), once for all techniques; what an
//! edge means comes from the emitted module of a proved plan.

use std::fmt::Write;

use crate::diag::{Diagnostic, Failure, codes};
use crate::emit;
use crate::plan::Plan;
use crate::prove::Proved;
use crate::technique::revectorise::Variant;

const FRAME: &str = include_str!("wgsl/frame.wgsl");
const EDGES: &str = include_str!("wgsl/edges.wgsl");
const SINGLE_READS: &str = include_str!("wgsl/reads_single.wgsl");
const GATHERED_READS: &str = include_str!("wgsl/reads_gathered.wgsl");
const DOMINANCE: &str = include_str!("wgsl/dominance.wgsl");
const HARD: &str = include_str!("wgsl/hard.wgsl");
const PCF: &str = include_str!("wgsl/pcf.wgsl");
const SMSR: &str = include_str!("wgsl/smsr.wgsl");
const RSMSS: &str = include_str!("wgsl/rsmss.wgsl");
const CASE_FREE: &str = include_str!("wgsl/casefree.wgsl");
const ONE_SAMPLE: &str = include_str!("wgsl/single.wgsl");
const MEAN: &str = include_str!("wgsl/rpcf.wgsl");
const COMPUTE: &str = include_str!("wgsl/compute.wgsl");
const FRAGMENT: &str = include_str!("wgsl/fragment.wgsl");
const RECORD: &str = include_str!("wgsl/record.wgsl");
const COUNT: &str = include_str!("wgsl/count.wgsl");
const GLANCE: &str = include_str!("wgsl/glance.wgsl");
const COMPUTE_TWO: &str = include_str!("wgsl/compute_two.wgsl");
const FRAGMENT_TWO: &str = include_str!("wgsl/fragment_two.wgsl");

/// How the skeleton reads the map.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Reads {
    /// One texel at a time, as the authors' shaders do.
    Single,
    /// Four texels at a time: two gathers see a texel with its neighbours, one more two steps of a walk.
    Gathered,
}

/// In how many goes a picture is treated.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Passes {
    /// All at once.
    One,
    /// First a glance at every pixel, then the pixels at silhouettes, packed together.
    Two,
}

/// What a skeleton does that costs time and changes no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Skeleton {
    /// How it reads the map.
    pub reads: Reads,
    /// Whether it reads which discontinuity dominates at corners, and so takes the very case of the
    /// table. Otherwise both are said to dominate, which is another case of the same value.
    pub dominance: bool,
    /// In how many goes, for the outputs that are values only.
    pub passes: Passes,
}

impl Skeleton {
    /// The cases as published, in one pass.
    pub const EXACT: Skeleton = Skeleton { reads: Reads::Gathered, dominance: true, passes: Passes::One };
    /// The collapsed form, in which corners cost no further reads, in two passes.
    pub const FAST: Skeleton = Skeleton { reads: Reads::Gathered, dominance: false, passes: Passes::Two };
    /// As the authors' shaders of 2015 go about it.
    pub const PUBLISHED: Skeleton = Skeleton { reads: Reads::Single, dominance: true, passes: Passes::One };
}

/// What a visibility pass gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Output {
    /// The visibility of each pixel, by a compute pass.
    Compute,
    /// The visibility of each pixel, by a fragment shader that covers the picture.
    Fragment,
    /// Value, case, state and cost of each pixel, by a compute pass.
    Record,
    /// How often each state occurs, by a compute pass.
    Count,
}

impl Output {
    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Output::Compute => "compute",
            Output::Fragment => "fragment",
            Output::Record => "record",
            Output::Count => "count",
        }
    }
}

/// The WGSL of a technique. `proved` is the plan of its table, if it has one.
///
/// # Errors
/// When the table is not the one that the variant needs.
pub fn source(
    technique: Variant,
    proved: Option<&Proved<'_>>,
    skeleton: Skeleton,
    output: Output,
) -> Result<String, Failure> {
    let mut out = String::from(FRAME);
    let table = |out: &mut String, own: &str| -> Result<(), Failure> {
        let proved = proved
            .filter(|proved| Some(proved.plan().program.name.as_str()) == technique.table().map(|table| table.name));
        let Some(proved) = proved else {
            let table = technique.table().map_or("no table", |table| table.name);
            let message = format!("the technique `{technique}` needs a plan of the table `{table}`");
            return Err(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message)));
        };
        let plan = proved.plan();
        // A plan that was made under assumptions may not ask for dominance at all.
        let asked =
            plan.key.fields().iter().any(|field| plan.program.inputs[field.input.index()].name.starts_with("dom"));
        let _ = writeln!(out, "const READ_DOMINANCE: bool = {};", skeleton.dominance && asked);
        out.push_str(match skeleton.reads {
            Reads::Single => SINGLE_READS,
            Reads::Gathered => GATHERED_READS,
        });
        let module = emit::wgsl(proved);
        for part in [EDGES, DOMINANCE, own, &module, &key_function(plan)?] {
            out.push_str(part);
        }
        let name = &plan.program.name;
        // A lookup in constants is part of the module.
        if proved.plan().reads_lookup() {
            out.push_str("@group(0) @binding(5) var<storage, read> lookup_words: array<u32>;\n");
            let _ = writeln!(out, "fn {name}_lookup(word: u32) -> u32 {{ return lookup_words[word]; }}");
        }
        Ok(())
    };
    match technique {
        Variant::Hard => out.push_str(HARD),
        Variant::Pcf => out.push_str(PCF),
        Variant::Smsr => table(&mut out, SMSR)?,
        Variant::Rsmss | Variant::Rpcf => table(&mut out, RSMSS)?,
        Variant::CaseFree => {
            out.push_str("const READ_DOMINANCE: bool = false;\n");
            [EDGES, SINGLE_READS, CASE_FREE].into_iter().for_each(|part| out.push_str(part));
        }
    }
    match technique {
        Variant::Smsr | Variant::Rsmss | Variant::CaseFree => out.push_str(ONE_SAMPLE),
        Variant::Rpcf => out.push_str(MEAN),
        Variant::Hard | Variant::Pcf => {}
    }
    match (output, passes(technique, skeleton)) {
        (Output::Compute, Passes::One) => out.push_str(COMPUTE),
        (Output::Fragment, Passes::One) => out.push_str(FRAGMENT),
        (Output::Record, _) => out.push_str(RECORD),
        (Output::Count, _) => out.push_str(COUNT),
        (Output::Compute, Passes::Two) => [GLANCE, COMPUTE_TWO].into_iter().for_each(|part| out.push_str(part)),
        (Output::Fragment, Passes::Two) => [GLANCE, FRAGMENT_TWO].into_iter().for_each(|part| out.push_str(part)),
    }
    Ok(out)
}

/// In how many goes a technique is evaluated: only what searches silhouettes has something to put off.
pub(super) fn passes(technique: Variant, skeleton: Skeleton) -> Passes {
    match technique {
        Variant::Smsr | Variant::Rsmss => skeleton.passes,
        Variant::Hard | Variant::Pcf | Variant::Rpcf | Variant::CaseFree => Passes::One,
    }
}

/// The levels of an input as the skeleton numbers them.
const LEVELS: [(&str, &[&str]); 7] = [
    ("H", &["none", "right", "left", "both"]),
    ("V", &["none", "top", "bottom", "both"]),
    ("b", &["entering", "exiting"]),
    ("tH", &["dual_negative", "positive_negative", "dual_positive"]),
    ("tV", &["dual_negative", "positive_negative", "dual_positive"]),
    ("domH", &["false", "true"]),
    ("domV", &["false", "true"]),
];

/// A function that packs what the skeleton knows into a key of the plan.
fn key_function(plan: &Plan<'_>) -> Result<String, Failure> {
    let mut parts = Vec::new();
    for field in plan.key.fields() {
        let program = plan.program;
        let name = &program.inputs[field.input.index()].name;
        let known = LEVELS.iter().find(|(input, _)| input == name);
        let fits = known.is_some_and(|(_, words)| {
            program
                .levels(field.input)
                .is_some_and(|levels| levels.names.iter().map(String::as_str).eq(words.iter().copied()))
        });
        if !fits {
            let inputs: Vec<String> =
                LEVELS.iter().map(|(name, words)| format!("{name} ({})", words.join(", "))).collect();
            let error = Diagnostic::error(
                codes::NOT_APPLICABLE,
                format!("the renderer does not provide the input `{name}`, or has other levels of it"),
            )
            .help(format!("it provides, in this order: {}", inputs.join("; ")));
            return Err(Failure::new(program.source.clone(), error));
        }
        parts.push(format!("(u32({name}) << {}u)", field.shift));
    }
    let sum = if parts.is_empty() { "0u".to_owned() } else { parts.join(" | ") };
    Ok(format!(
        "fn table_key(H: u32, V: u32, b: u32, tH: u32, tV: u32, domH: bool, domV: bool) -> u32 {{\n    return {sum};\n}}\n"
    ))
}
