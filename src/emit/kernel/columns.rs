//! The surroundings of an emitted library: a stub of the host's functions, so
//! that the library can be validated by itself, and a compute shader that runs
//! the table over columns of inputs, which is also what SPIR-V, HLSL and MSL
//! are made of.
//!
//! The columns are rows of `u32` words ([`Layout`]). Each fetch of the compute
//! shader counts itself, so that a test can see that fetching is lazy.

use std::fmt::Write;

use crate::emit::inputs::{Fetch, beside_the_key, fetches, input_type};
use crate::emit::language::glsl::{Glsl, GlslVersion};
use crate::emit::language::wgsl::Wgsl;
use crate::emit::language::{Dialect, Prefix, words};
use crate::emit::module;
use crate::program::{Program, Scalar};
use crate::prove::Proved;

/// Threads of a workgroup.
pub const WORKGROUP: u32 = 64;

/// The entry point that a compute shader calls.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Entry {
    /// Levels as their `f32` codes.
    Levels,
    /// One packed key.
    Key,
}

impl Entry {
    /// Both.
    pub const ALL: [Entry; 2] = [Entry::Levels, Entry::Key];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Entry::Levels => "levels",
            Entry::Key => "key",
        }
    }
}

/// The layout of the words of the columns.
///
/// Binding 0 holds the number of rows and then the plain inputs, row by row:
/// for [`Entry::Key`] the key and the continuous inputs, for [`Entry::Levels`]
/// all inputs in order (codes and numbers as the bits of an `f32`, booleans as
/// 0 or 1). Binding 1 holds the fetched inputs, row by row (levels as their
/// index, numbers as bits). Binding 2 receives case, components and counts of
/// fetches. Binding 3 holds the lookup of a plan that reads one from a buffer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    /// Words of plain inputs in a row.
    pub plain: usize,
    /// Fetched inputs in a row.
    pub fetched: usize,
    /// Components of the output.
    pub values: usize,
    /// Words of a row of results: the case, the components, the counts.
    pub out: usize,
}

/// Fetches whose counts share a word: four bits each.
pub const COUNTS_PER_WORD: usize = 8;

impl Layout {
    /// The layout for a program and an entry point.
    pub fn new(program: &Program, entry: Entry) -> Self {
        let fetched = program.inputs.iter().filter(|input| input.fetched.is_some()).count();
        let plain = program.inputs.len() - fetched;
        let plain = match entry {
            Entry::Levels => plain,
            Entry::Key => 1 + plain - program.states.digits().len(),
        };
        let values = program.output.components().len();
        Self { plain, fetched, values, out: 1 + values + fetched.div_ceil(COUNTS_PER_WORD) }
    }
}

/// Appends a stub of the host's functions to a WGSL library.
pub fn wgsl_library(proved: &Proved<'_>, library: &str) -> String {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let mut out = library.to_owned();
    let fetches = fetches(program);
    if !fetches.is_empty() {
        let _ = writeln!(out, "struct {} {{ unused: u32, }}", prefix.site());
    }
    for fetch in &fetches {
        let zero = Wgsl::Plain.zero(fetch.scalar);
        let _ = writeln!(out, "{} {{ return {zero}; }}", wgsl_fetch(fetch, &prefix));
    }
    if proved.plan().reads_lookup() {
        let _ = writeln!(out, "fn {}_lookup(word: u32) -> u32 {{ return 0u; }}", prefix.lower);
    }
    out
}

/// The statements that end a function in place of the host's; `answer` gives those for an
/// input, by its place among the fetched ones.
pub(in crate::emit) fn fetch_body(fetch: &Fetch, dialect: &dyn Dialect, answer: impl Fn(usize) -> String) -> String {
    let Some(((last, _), others)) = fetch.calls.split_last() else { return String::new() };
    let mut out = String::new();
    for (place, arguments) in others {
        let same: Vec<String> = (fetch.parameters.iter().zip(arguments))
            .map(|(name, value)| format!("{name} == {}", dialect.number(f64::from(*value))))
            .collect();
        let inner = answer(*place).replace('\n', "\n    ");
        let _ = writeln!(out, "    if ({}) {{\n        {inner}\n    }}", same.join(" && "));
    }
    out + "    " + &answer(*last)
}

/// The first line of a function in place of the host's, in WGSL.
pub(in crate::emit) fn wgsl_fetch(fetch: &Fetch, prefix: &Prefix) -> String {
    let arguments = fetch.parameters(|name| format!("{name}: f32"));
    let (ident, ty) = (&fetch.ident, Wgsl::Plain.scalar(fetch.scalar));
    format!("fn {}_fetch_{ident}(site: {}{arguments}) -> {ty}", prefix.lower, prefix.site())
}

/// The same in GLSL.
pub(super) fn glsl_fetch(fetch: &Fetch, prefix: &Prefix, glsl: &Glsl) -> String {
    let arguments = fetch.parameters(|name| format!("float {name}"));
    let (ident, ty) = (&fetch.ident, glsl.scalar(fetch.scalar));
    format!("{ty} {}_fetch_{ident}({} site{arguments})", prefix.lower, prefix.site())
}

/// Puts a GLSL library between a stub of the host's functions and an empty `main`.
pub fn glsl_library(proved: &Proved<'_>, library: &str, version: GlslVersion) -> String {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let glsl = Glsl { version };
    let mut out = format!("{}\n", version.version_line());
    if version == GlslVersion::V450 {
        out += "layout(local_size_x = 1) in;\n";
    }
    if version == GlslVersion::Es300 {
        out += "precision highp float;\nprecision highp int;\n";
    }
    let fetches = fetches(program);
    if !fetches.is_empty() {
        let _ = writeln!(out, "struct {} {{ uint unused; }};", prefix.site());
    }
    for fetch in &fetches {
        let zero = glsl.zero(fetch.scalar);
        let _ = writeln!(out, "{} {{ return {zero}; }}", glsl_fetch(fetch, &prefix, &glsl));
    }
    if proved.plan().reads_lookup() {
        let _ = writeln!(out, "uint {}_lookup(uint word) {{ return 0u; }}", prefix.lower);
    }
    out + library + "\nvoid main() {}\n"
}

/// A complete WGSL compute shader that runs the table over columns.
pub fn wgsl_columns(proved: &Proved<'_>, entry: Entry) -> String {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let layout = Layout::new(program, entry);
    let fetches = fetches(program);
    let mut out = String::from("// ---- the table over columns of inputs ----\n\n");
    out += "@group(0) @binding(0) var<storage, read> $plain: array<u32>;\n";
    if !fetches.is_empty() {
        out += "@group(0) @binding(1) var<storage, read> $fetched: array<u32>;\n";
    }
    out += "@group(0) @binding(2) var<storage, read_write> $out: array<u32>;\n";
    if proved.plan().reads_lookup() {
        out += "@group(0) @binding(3) var<storage, read> $lookup: array<u32>;\n\n";
        let _ = writeln!(out, "fn {}_lookup(word: u32) -> u32 {{ return $lookup[word]; }}", prefix.lower);
    }
    if !fetches.is_empty() {
        let _ = writeln!(out, "\nstruct {} {{ row: u32, }}", prefix.site());
    }
    for fetch in &fetches {
        let body = fetch_body(fetch, &Wgsl::Plain, |place| {
            let value = Wgsl::Plain.scalar_of_word(fetch.scalar, &fetched_word(&layout, place));
            format!("{}\n    return {value};", count_fetch(&layout, place))
        });
        let _ = writeln!(out, "{} {{\n{body}\n}}", wgsl_fetch(fetch, &prefix));
    }
    let _ = writeln!(
        out,
        "\n@compute @workgroup_size({WORKGROUP})\nfn {}_columns(@builtin(global_invocation_id) id: vec3<u32>) {{",
        prefix.lower
    );
    out += "    let row = id.x;\n    if (row >= $plain[0]) {\n        return;\n    }\n";
    let _ = writeln!(out, "    let at = 1u + row * {}u;", layout.plain);
    let mut arguments = arguments(program, entry, &Wgsl::Plain);
    if !fetches.is_empty() {
        arguments.push(format!("{}(row)", prefix.site()));
    }
    let [.., levels_case, key_case] = Wgsl::Plain.entry_names(&prefix);
    let function = if entry == Entry::Key { key_case } else { levels_case };
    let _ = writeln!(out, "    let result = {function}({});", arguments.join(", "));
    store(&mut out, program, &layout, &Wgsl::Plain);
    out += "}\n";
    module::write(proved, &Wgsl::Plain) + &name_buffers(program, &prefix, &out)
}

/// The same in GLSL 450.
pub fn glsl_columns(proved: &Proved<'_>, entry: Entry) -> String {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let glsl = Glsl { version: GlslVersion::V450 };
    let layout = Layout::new(program, entry);
    let fetches = fetches(program);
    let mut out = format!("#version 450\nlayout(local_size_x = {WORKGROUP}) in;\n");
    let buffer = |out: &mut String, binding: u32, access: &str, name: &str| {
        let _ = writeln!(
            out,
            "layout(std430, set = 0, binding = {binding}) {access}buffer {name}_block {{ uint {name}[]; }};"
        );
    };
    buffer(&mut out, 0, "readonly ", "$plain");
    if !fetches.is_empty() {
        buffer(&mut out, 1, "readonly ", "$fetched");
    }
    buffer(&mut out, 2, "", "$out");
    if proved.plan().reads_lookup() {
        buffer(&mut out, 3, "readonly ", "$lookup");
        let _ = writeln!(out, "uint {}_lookup(uint word) {{ return $lookup[word]; }}", prefix.lower);
    }
    if !fetches.is_empty() {
        let _ = writeln!(out, "struct {} {{ uint row; }};", prefix.site());
    }
    for fetch in &fetches {
        let body = fetch_body(fetch, &glsl, |place| {
            let value = glsl.scalar_of_word(fetch.scalar, &fetched_word(&layout, place));
            format!("{}\n    return {value};", count_fetch(&layout, place))
        });
        let _ = writeln!(out, "{} {{\n{body}\n}}", glsl_fetch(fetch, &prefix, &glsl));
    }
    let before = name_buffers(program, &prefix, &out) + &module::write(proved, &glsl);
    let mut out = String::from(
        "void main() {\n    uint row = gl_GlobalInvocationID.x;\n    if (row >= $plain[0]) {\n        return;\n    }\n",
    );
    let _ = writeln!(out, "    uint at = 1u + row * {}u;", layout.plain);
    let mut arguments = arguments(program, entry, &glsl);
    if !fetches.is_empty() {
        arguments.push(format!("{}(row)", prefix.site()));
    }
    let [.., levels_case, key_case] = glsl.entry_names(&prefix);
    let function = if entry == Entry::Key { key_case } else { levels_case };
    let _ = writeln!(out, "    {} result = {function}({});", prefix.result(), arguments.join(", "));
    store(&mut out, program, &layout, &glsl);
    out += "}\n";
    before + &name_buffers(program, &prefix, &out)
}

/// Names the buffers, which stand as `$plain` and so on, other than anything of the table.
/// Those of functions, several of which share a module, are also told apart by its name.
pub(in crate::emit) fn name_buffers(program: &Program, prefix: &Prefix, text: &str) -> String {
    let start = if prefix.lower.starts_with("umbrage") { "columns_" } else { "umbrage_" };
    match &program.function {
        Some(function) => text.replace('$', &format!("{start}{}_", function.name)),
        None => text.replace('$', start),
    }
}

/// The name of a buffer in the shaders over columns: `plain`, `fetched`, `out` or `lookup`.
pub fn buffer_name(program: &Program, buffer: &str) -> String {
    name_buffers(program, &Prefix::new(&program.name), &format!("${buffer}"))
}

pub(super) fn count_fetch(layout: &Layout, index: usize) -> String {
    let word = 1 + layout.values + index / COUNTS_PER_WORD;
    let place = format!("$out[site.row * {}u + {word}u]", layout.out);
    format!("{place} = {place} + {}u;", 1_u32 << (4 * (index % COUNTS_PER_WORD)))
}

/// The word that holds a fetched input of the row of a site.
pub(in crate::emit) fn fetched_word(layout: &Layout, index: usize) -> String {
    format!("$fetched[site.row * {}u + {index}u]", layout.fetched)
}

pub(super) fn arguments(program: &Program, entry: Entry, dialect: &dyn Dialect) -> Vec<String> {
    let word = |index: usize| format!("$plain[at + {index}u]");
    match entry {
        Entry::Key => {
            let numbers = beside_the_key(program).zip(1..);
            let numbers = numbers
                .map(|(input, index)| dialect.scalar_of_word(input_type(&input.domain, Scalar::Float), &word(index)));
            [word(0)].into_iter().chain(numbers).collect()
        }
        Entry::Levels => {
            let plain = program.inputs.iter().filter(|input| input.fetched.is_none()).enumerate();
            plain.map(|(i, input)| dialect.scalar_of_word(input_type(&input.domain, Scalar::Float), &word(i))).collect()
        }
    }
}

pub(super) fn store(out: &mut String, program: &Program, layout: &Layout, dialect: &dyn Dialect) {
    let value = words(dialect, &program.output.data_type(), "result.value");
    for (index, word) in ["result.case_id".to_owned()].into_iter().chain(value).enumerate() {
        let _ = writeln!(out, "    $out[row * {}u + {index}u] = {word};", layout.out);
    }
}
