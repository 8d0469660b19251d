//! The table over columns of inputs where there are no compute shaders: a fragment shader in GLSL ES 300, for WebGL 2.
//!
//! A fragment is a row. The words of the columns ([`Layout`]) come from textures of one unsigned
//! channel, [`TEXELS`] wide, word after word; each pass gives four words of the results, as a texel
//! of four unsigned channels. The words of the fragment's own row are copied into arrays first, so
//! that all else is said as in the compute shaders.

use std::fmt::Write;

use super::columns::{
    Entry, Layout, arguments, count_fetch, fetch_body, fetched_word, glsl_fetch, name_buffers, store,
};
use crate::emit::inputs::fetches;
use crate::emit::language::glsl::{Glsl, GlslVersion};
use crate::emit::language::{Dialect, Prefix};
use crate::emit::module;
use crate::prove::Proved;

/// Width of the textures that hold words.
pub const TEXELS: u32 = 2048;

/// Words of results that one pass gives.
pub const WORDS_PER_PASS: usize = 4;

/// A complete fragment shader that runs the table over columns and gives the words of results from `first` on.
///
/// Its uniforms are `plain`, `fetched` and `lookup` (samplers; the latter two only where the layout and the plan have
/// them) and `width` (an unsigned integer, the width of the target), each called as
/// [`buffer_name`](super::columns::buffer_name) says. Row `y * width + x` is the fragment at `x`, `y`.
pub fn glsl_es_columns(proved: &Proved<'_>, entry: Entry, first: usize) -> String {
    let program = proved.plan().program;
    let prefix = Prefix::new(&program.name);
    let glsl = Glsl { version: GlslVersion::Es300 };
    let layout = Layout::new(program, entry);
    let fetches = fetches(program);
    let reads_lookup = proved.plan().reads_lookup();
    let mut out = format!("{}\nprecision highp float;\nprecision highp int;\n", glsl.version.version_line());
    out += "precision highp usampler2D;\n\nuniform uint $width;\nuniform usampler2D $plain;\n";
    if !fetches.is_empty() {
        out += "uniform usampler2D $fetched;\n";
    }
    if reads_lookup {
        out += "uniform usampler2D $lookup;\n";
    }
    out += "layout(location = 0) out uvec4 $texel;\n\n";
    let _ = writeln!(
        out,
        "uint $word(usampler2D words, uint word) {{\n    return texelFetch(words, ivec2(int(word % {TEXELS}u), int(word / {TEXELS}u)), 0).r;\n}}"
    );
    // An array has at least one element, and the words of a row may be none.
    let _ = writeln!(out, "uint $own_plain[{}];\nuint $out[{}];", layout.plain.max(1), layout.out);
    if reads_lookup {
        let _ = writeln!(out, "uint {}_lookup(uint word) {{ return $word($lookup, word); }}", prefix.lower);
    }
    if !fetches.is_empty() {
        let _ = writeln!(out, "uint $own_fetched[{}];\nstruct {} {{ uint row; }};", layout.fetched, prefix.site());
    }
    for fetch in &fetches {
        let body = fetch_body(fetch, &glsl, |place| {
            let word = fetched_word(&layout, place).replace("$fetched", "$own_fetched");
            let value = glsl.scalar_of_word(fetch.scalar, &word);
            format!("{}\n    return {value};", count_fetch(&layout, place))
        });
        let _ = writeln!(out, "{} {{\n{body}\n}}", glsl_fetch(fetch, &prefix, &glsl));
    }
    let before = name_buffers(program, &prefix, &out) + &module::write(proved, &glsl);
    let mut out = String::from("void main() {\n    uvec2 pixel = uvec2(gl_FragCoord.xy);\n");
    out += "    uint number = pixel.y * $width + pixel.x;\n    $texel = uvec4(0u);\n";
    out += "    if (number >= $word($plain, 0u)) {\n        return;\n    }\n";
    let mut copy = |own: &str, words: &str, first: usize, count: usize| {
        let _ = writeln!(
            out,
            "    for (uint i = 0u; i < {count}u; i++) {{\n        {own}[i] = $word({words}, {first}u + number * {count}u + i);\n    }}"
        );
    };
    copy("$own_plain", "$plain", 1, layout.plain);
    if !fetches.is_empty() {
        copy("$own_fetched", "$fetched", 0, layout.fetched);
    }
    let _ = writeln!(out, "    for (uint i = 0u; i < {}u; i++) {{\n        $out[i] = 0u;\n    }}", layout.out);
    // The arrays hold one row, which begins where they do.
    out += "    uint row = 0u;\n    uint at = 0u;\n";
    let mut arguments: Vec<String> = arguments(program, entry, &glsl);
    arguments.iter_mut().for_each(|argument| *argument = argument.replace("$plain", "$own_plain"));
    if !fetches.is_empty() {
        arguments.push(format!("{}(row)", prefix.site()));
    }
    let [.., levels_case, key_case] = glsl.entry_names(&prefix);
    let function = if entry == Entry::Key { key_case } else { levels_case };
    let _ = writeln!(out, "    {} result = {function}({});", prefix.result(), arguments.join(", "));
    store(&mut out, program, &layout, &glsl);
    let words = (first..first + WORDS_PER_PASS)
        .map(|word| if word < layout.out { format!("$out[{word}]") } else { "0u".to_owned() });
    let _ = writeln!(out, "    $texel = uvec4({});\n}}", words.collect::<Vec<_>>().join(", "));
    before + &name_buffers(program, &prefix, &out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::plan::{Plan, Shape};
    use crate::program::Program;

    #[test]
    fn each_pass_gives_its_words() {
        let program = Program::read("tables/rsmss.ron").unwrap_or_else(|e| panic!("{e}"));
        let proved = Plan::proved(&program, Shape::SwitchBuffer).unwrap_or_else(|e| panic!("{e}"));
        let text = glsl_es_columns(&proved, Entry::Key, 0);
        assert!(text.starts_with("#version 300 es\n") && !text.contains('$'));
        assert!(
            text.contains("umbrage_texel = uvec4(umbrage_out[0], umbrage_out[1], umbrage_out[2], umbrage_out[3]);")
        );
        assert!(text.contains("uint rsmss_lookup(uint word) { return umbrage_word(umbrage_lookup, word); }"));
        let text = glsl_es_columns(&proved, Entry::Key, WORDS_PER_PASS);
        assert!(text.contains("umbrage_texel = uvec4(0u, 0u, 0u, 0u);"));
    }
}
