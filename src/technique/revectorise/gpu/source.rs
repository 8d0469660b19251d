//! The WGSL of a visibility pass: skeleton, table and entry points, put together.
//!
//! The [`skeleton`](crate::skeleton) is written by hand; the meaning of an edge comes
//! from the emitted module of a proved plan, the entry points from `wgsl/`.

use std::fmt::Write;

use crate::diag::{Diagnostic, Failure, codes};
use crate::emit;
use crate::plan::Plan;
use crate::prove::Proved;
use crate::skeleton::{Reads, Revectorised};
use crate::technique::revectorise::Variant;

const COMPUTE: &str = include_str!("wgsl/compute.wgsl");
const FRAGMENT: &str = include_str!("wgsl/fragment.wgsl");
const RECORD: &str = include_str!("wgsl/record.wgsl");
const COUNT: &str = include_str!("wgsl/count.wgsl");
const GLANCE: &str = include_str!("wgsl/glance.wgsl");
const COMPUTE_TWO: &str = include_str!("wgsl/compute_two.wgsl");
const FRAGMENT_TWO: &str = include_str!("wgsl/fragment_two.wgsl");

/// The passes that a picture takes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Passes {
    /// One over all pixels.
    One,
    /// A glance at every pixel, then the pixels at silhouettes, packed together.
    Two,
}

/// Choices that cost time and change no value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Skeleton {
    /// The choices of the skeleton around the table.
    pub around: Revectorised,
    /// The passes, for the outputs that are values only.
    pub passes: Passes,
}

impl Skeleton {
    /// The cases as published, in one pass.
    pub const EXACT: Skeleton = Skeleton { around: Revectorised::EXACT, passes: Passes::One };
    /// The collapsed form, in which corners cost no further reads, in two passes.
    pub const FAST: Skeleton =
        Skeleton { around: Revectorised { reads: Reads::Gathered, dominance: false }, passes: Passes::Two };
    /// As the authors' shaders of 2015 go about it.
    pub const PUBLISHED: Skeleton =
        Skeleton { around: Revectorised { reads: Reads::Single, dominance: true }, passes: Passes::One };
}

/// The result of a visibility pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Output {
    /// The visibility of each pixel, by a compute pass.
    Compute,
    /// The visibility of each pixel, by a fragment shader that covers the picture.
    Fragment,
    /// Value, case, state and cost of each pixel, by a compute pass.
    Record,
    /// The number of pixels in each state, by a compute pass.
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
    let mut out = around(technique, proved, skeleton.around)?;
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

/// The skeleton of a variant and the module of its table.
fn around(technique: Variant, proved: Option<&Proved<'_>>, choices: Revectorised) -> Result<String, Failure> {
    let skeleton = |choices: Revectorised, key: &str| {
        choices.with_key(technique.name(), key).ok_or_else(|| {
            let message = format!("the technique `{technique}` has no skeleton");
            Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message))
        })
    };
    let Some(table) = technique.table().map(|table| table.name) else { return skeleton(choices, "") };
    let Some(proved) = proved.filter(|proved| proved.plan().program.name == table) else {
        let message = format!("the technique `{technique}` needs a plan of the table `{table}`");
        return Err(Failure::bare("", Diagnostic::error(codes::NOT_APPLICABLE, message)));
    };
    let plan = proved.plan();
    // A plan that was made under assumptions may not ask for dominance at all.
    let asked = plan.key.fields().iter().any(|field| plan.program.inputs[field.input.index()].name.starts_with("dom"));
    let choices = Revectorised { dominance: choices.dominance && asked, ..choices };
    let mut out = skeleton(choices, &key_function(plan)?)?;
    out.push_str(&emit::wgsl(proved));
    // A lookup in constants is part of the module.
    if plan.reads_lookup() {
        out.push_str("@group(0) @binding(5) var<storage, read> lookup_words: array<u32>;\n");
        let _ = writeln!(out, "fn {table}_lookup(word: u32) -> u32 {{ return lookup_words[word]; }}");
    }
    Ok(out)
}

/// The passes that a technique takes: only one that searches silhouettes can defer work.
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

/// A function that packs the levels that the skeleton finds into a key of the plan.
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
