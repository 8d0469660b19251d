//! Compute shaders to measure plans with.
//!
//! As lean as a table in a renderer: inputs are read, the table evaluated, its
//! value written. Buffers are laid out as for
//! [`wgsl_columns`](super::columns::wgsl_columns) with [`Entry::Key`], but
//! fetches are not counted and of the result only the value is kept. The
//! floor reads and writes the same words and computes nothing: no plan can be
//! faster, whatever its shape.
//!
//! A renderer has the inputs in registers, and reading them from memory would
//! hide what a plan costs. So a thread evaluates several rows: of each it reads
//! the key, and the numbers of the first one move on from one to the next.
//! With one row per thread it is a pass over memory, and has no loop: there are
//! drivers that compile a table in a loop for minutes, and without in a second.

use std::fmt::Write;

use super::columns::{Entry, Layout, WORKGROUP, fetch_body, fetched_word, name_buffers, wgsl_fetch};
use crate::emit::inputs::{beside_the_key, fetches, input_type};
use crate::emit::language::wgsl::Wgsl;
use crate::emit::language::{Dialect, Prefix, words};
use crate::emit::module;
use crate::program::{Domain, Program, Scalar};
use crate::prove::Proved;

/// The shader that evaluates a plan once per row, a thread so many of them.
pub fn wgsl_timed(proved: &Proved<'_>, rows: u32) -> String {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let layout = Layout::new(program, Entry::Key);
    let fetches = fetches(program);
    let mut out = buffers(program);
    if proved.plan().reads_lookup() {
        out += "@group(0) @binding(3) var<storage, read> $lookup: array<u32>;\n";
        let _ = writeln!(out, "fn {}_lookup(word: u32) -> u32 {{ return $lookup[word]; }}", prefix.lower);
    }
    if !fetches.is_empty() {
        let _ = writeln!(out, "struct {} {{ row: u32, }}", prefix.site());
    }
    for fetch in &fetches {
        let body = fetch_body(fetch, &Wgsl::Plain, |place| {
            format!("return {};", Wgsl::Plain.scalar_of_word(fetch.scalar, &fetched_word(&layout, place)))
        });
        let _ = writeln!(out, "{} {{\n{body}\n}}", wgsl_fetch(fetch, &prefix));
    }
    let numbers = (1..layout.plain).map(|index| format!("number_{index}"));
    let mut arguments: Vec<String> = ["key".to_owned()].into_iter().chain(numbers).collect();
    if !fetches.is_empty() {
        arguments.push(format!("{}(row)", prefix.site()));
    }
    let [_, key, ..] = Wgsl::Plain.entry_names(&prefix);
    let evaluation = format!("let value = {key}({});", arguments.join(", "));
    kernel(&mut out, program, &layout, rows, &evaluation, &words(&Wgsl::Plain, &program.output.data_type(), "value"));
    module::write(proved, &Wgsl::Plain) + &name_buffers(program, &prefix, &out)
}

/// The shader that reads and writes the same data and computes nothing.
pub fn wgsl_floor(program: &Program, rows: u32) -> String {
    let layout = Layout::new(program, Entry::Key);
    let mut out = buffers(program);
    // Folded into one word, or what is read would not be needed.
    let numbers = beside_the_key(program).zip(1..).map(|(input, index)| {
        Wgsl::Plain.word_of_scalar(input_type(&input.domain, Scalar::Float), &format!("number_{index}"))
    });
    let words: Vec<String> = ["key".to_owned()].into_iter().chain(numbers).collect();
    let evaluation = format!("let word = {};", words.join(" ^ "));
    kernel(&mut out, program, &layout, rows, &evaluation, &vec!["word".to_owned(); layout.values]);
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

fn kernel(out: &mut String, program: &Program, layout: &Layout, rows: u32, evaluation: &str, words: &[String]) {
    let prefix = Prefix::new(&program.name);
    let mut line = |text: String| {
        let _ = writeln!(out, "{text}");
    };
    line(format!("\n@compute @workgroup_size({WORKGROUP})"));
    line(format!("fn {}_timed(@builtin(global_invocation_id) id: vec3<u32>) {{", prefix.lower));
    line(format!("    let threads = $plain[0] / {rows}u;\n    if (id.x >= threads) {{\n        return;\n    }}"));
    for (input, index) in beside_the_key(program).zip(1..) {
        let word = format!("$plain[1u + id.x * {}u + {index}u]", layout.plain);
        let number = Wgsl::Plain.scalar_of_word(input_type(&input.domain, Scalar::Float), &word);
        line(format!("    var number_{index} = {number};"));
    }
    for index in 0..words.len() {
        line(format!("    var word_{index} = 0u;"));
    }
    if rows > 1 {
        line(format!("    for (var step = 0u; step < {rows}u; step++) {{"));
        line("        let row = step * threads + id.x;".to_owned());
    } else {
        line("    {".to_owned());
        line("        let row = id.x;".to_owned());
    }
    line(format!("        let key = $plain[1u + row * {}u];", layout.plain));
    line(format!("        {evaluation}"));
    for (index, word) in words.iter().enumerate() {
        line(format!("        word_{index} ^= {word};"));
    }
    // By the golden ratio, which comes by everywhere without repeating itself.
    for (input, index) in beside_the_key(program).zip(1..).filter(|_| rows > 1) {
        let number = format!("number_{index}");
        line(match input.domain {
            Domain::Continuous { lo, hi, .. } => {
                let (lo, width) = (Wgsl::Plain.number(lo), Wgsl::Plain.number(hi - lo));
                format!("        {number} = {lo} + fract(({number} - {lo}) / {width} + 0.618034) * {width};")
            }
            Domain::Word | Domain::Discrete(_) => format!("        {number} = {number} + 2654435769u;"),
        });
    }
    line("    }".to_owned());
    for index in 0..words.len() {
        line(format!("    $out[id.x * {}u + {index}u] = word_{index};", words.len()));
    }
    line("}".to_owned());
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
            for rows in [1, 4] {
                let floor = wgsl_floor(&program, rows);
                assert_eq!(floor.contains("for ("), rows > 1);
                wgsl_module(&program, &floor).unwrap_or_else(|e| panic!("{e}"));
            }
            for shape in Shape::ALL {
                let Ok(plan) = Plan::new(&program, shape) else { continue };
                let proved = plan.prove().unwrap_or_else(|e| panic!("{e}"));
                for rows in [1, 4] {
                    wgsl_module(&program, &wgsl_timed(&proved, rows)).unwrap_or_else(|e| panic!("{e}"));
                }
            }
        }
    }
}
