//! Compute shaders to measure plans with.
//!
//! As lean as a table in a renderer: a row of inputs is read, the table
//! evaluated once, its value written. Buffers are laid out as for
//! [`wgsl_columns`](super::harness::wgsl_columns) with [`Entry::Key`], but
//! fetches are not counted and of the result only the value is kept. The
//! floor reads and writes the same words and computes nothing: no plan can be
//! faster, whatever its shape.

use std::fmt::Write;

use super::dialect::{Dialect, Prefix, Type};
use super::harness::{Entry, Layout, WORKGROUP, arguments, name_buffers, reads_lookup, value_words};
use super::module;
use super::names::fetches;
use super::wgsl::Wgsl;
use crate::plan::Proved;
use crate::program::Program;

/// The shader that evaluates a plan once per row.
pub fn wgsl_timed(proved: &Proved<'_>) -> String {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let layout = Layout::new(program, Entry::Key);
    let fetches = fetches(program);
    let mut out = buffers(program);
    if reads_lookup(proved) {
        out += "@group(0) @binding(3) var<storage, read> $lookup: array<u32>;\n";
        let _ = writeln!(out, "fn {}_lookup(word: u32) -> u32 {{ return $lookup[word]; }}", prefix.lower);
    }
    if !fetches.is_empty() {
        let _ = writeln!(out, "struct {} {{ row: u32, }}", prefix.site());
    }
    for (index, (ident, ty)) in fetches.iter().enumerate() {
        let word = format!("$fetched[site.row * {}u + {index}u]", layout.fetched);
        let value = match ty {
            Type::Float => format!("bitcast<f32>({word})"),
            Type::Bool => format!("{word} != 0u"),
            _ => word,
        };
        let (site, ty) = (prefix.site(), Wgsl.ty(ty, &prefix));
        let _ = writeln!(out, "fn {}_fetch_{ident}(site: {site}) -> {ty} {{ return {value}; }}", prefix.lower);
    }
    open_kernel(&mut out, program, &layout);
    let mut arguments = arguments(program, Entry::Key, "bitcast<f32>");
    if !fetches.is_empty() {
        arguments.push(format!("{}(row)", prefix.site()));
    }
    let [_, key, ..] = Wgsl.entry_names(&prefix);
    let _ = writeln!(out, "    let value = {key}({});", arguments.join(", "));
    for (index, word) in value_words(&program.output, "value", "bitcast<u32>").into_iter().enumerate() {
        let _ = writeln!(out, "    $out[row * {}u + {index}u] = {word};", layout.values);
    }
    out += "}\n";
    module::write(proved, &Wgsl) + &name_buffers(program, &prefix, &out)
}

/// The shader that reads and writes the same data and computes nothing.
pub fn wgsl_floor(program: &Program) -> String {
    let layout = Layout::new(program, Entry::Key);
    let mut out = buffers(program);
    open_kernel(&mut out, program, &layout);
    // Folded into one word, or what is read would not be needed.
    let words: Vec<String> = (0..layout.plain).map(|index| format!("$plain[at + {index}u]")).collect();
    let _ = writeln!(out, "    let word = {};", words.join(" ^ "));
    for index in 0..layout.values {
        let _ = writeln!(out, "    $out[row * {}u + {index}u] = word;", layout.values);
    }
    out += "}\n";
    name_buffers(program, &Prefix::new(&program.name), &out)
}

fn buffers(program: &Program) -> String {
    let mut out = String::from("// ---- the table, timed ----\n\n");
    out += "@group(0) @binding(0) var<storage, read> $plain: array<u32>;\n";
    if !program.fetched.is_empty() {
        out += "@group(0) @binding(1) var<storage, read> $fetched: array<u32>;\n";
    }
    out += "@group(0) @binding(2) var<storage, read_write> $out: array<u32>;\n";
    out
}

fn open_kernel(out: &mut String, program: &Program, layout: &Layout) {
    let prefix = Prefix::new(&program.name);
    let _ = writeln!(
        out,
        "\n@compute @workgroup_size({WORKGROUP})\nfn {}_timed(@builtin(global_invocation_id) id: vec3<u32>) {{",
        prefix.lower
    );
    out.push_str("    let row = id.x;\n    if (row >= $plain[0]) {\n        return;\n    }\n");
    let _ = writeln!(out, "    let at = 1u + row * {}u;", layout.plain);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::emit::wgsl_module;
    use crate::plan::{Plan, Shape};

    #[test]
    fn both_shaders_are_valid() {
        for table in ["tables/smsr.ron", "tables/rsmss.ron"] {
            let program = Program::read(table).unwrap_or_else(|e| panic!("{e}"));
            wgsl_module(&program, &wgsl_floor(&program)).unwrap_or_else(|e| panic!("{e}"));
            for shape in Shape::ALL {
                let Ok(plan) = Plan::new(&program, shape) else { continue };
                let proved = plan.prove().unwrap_or_else(|e| panic!("{e}"));
                wgsl_module(&program, &wgsl_timed(&proved)).unwrap_or_else(|e| panic!("{e}"));
            }
        }
    }
}
