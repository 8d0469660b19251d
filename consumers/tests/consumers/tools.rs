//! Reference tools: glslang for GLSL and HLSL, `spirv-val` for SPIR-V.
//!
//! Where a tool is not installed there is nothing to test; the variables that
//! the test command sets once it has installed them make that a failure.

use std::path::Path;
use std::process::Command;

use umbrage::emit::{self, GlslVersion, Target};
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Domain, LevelKind, Program};
use umbrage::prove::Proved;

use crate::{arguments, camel, table};

/// Whether a tool is there; it must be where the variable is set.
fn installed(tool: &str, variable: &str) -> bool {
    let found = Command::new(tool).arg("--version").output().is_ok();
    assert!(found || std::env::var_os(variable).is_none(), "{tool} is missing");
    if !found {
        println!("skipped: {tool} is not installed");
    }
    found
}

fn accepts(tool: &str, arguments: &[&str], file: &Path) {
    let output = Command::new(tool).args(arguments).arg(file).output().unwrap();
    let said = String::from_utf8_lossy(&output.stdout) + String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{tool} {arguments:?} {}: {said}", file.display());
}

fn every_plan(test: impl Fn(&Proved<'_>, Shape)) {
    for name in ["smsr", "rsmss"] {
        let program = table(name);
        for shape in [Shape::Ladder, Shape::Ordered, Shape::Nested, Shape::Switch] {
            test(&Plan::proved(&program, shape).unwrap_or_else(|error| panic!("{error}")), shape);
        }
    }
}

/// What a host supplies in GLSL, and a shader that calls the table.
fn glsl(proved: &Proved<'_>, version: GlslVersion, vertex: bool) -> String {
    let program: &Program = proved.plan().program;
    let (name, site) = (&program.name, camel(program) + "Site");
    let mut out = format!("{}\n", version.version_line());
    if version == GlslVersion::Es300 {
        // The library says how precise it is; what stands before it has to say so itself.
        out += "precision highp float;\nprecision highp int;\n";
    }
    let fetched: Vec<_> = program.inputs.iter().filter(|input| input.fetched.is_some()).collect();
    if !fetched.is_empty() {
        out += &format!("struct {site} {{ uint texel; }};\n");
    }
    for input in fetched {
        let (ty, value) = match &input.domain {
            Domain::Discrete(levels) if levels.kind == LevelKind::Bool => ("bool", "site.texel == 1u"),
            Domain::Discrete(_) => ("uint", "site.texel & 1u"),
            Domain::Continuous { .. } => ("float", "float(site.texel)"),
            Domain::Word => ("uint", "site.texel"),
        };
        out += &format!("{ty} {name}_fetch_{}({site} site) {{ return {value}; }}\n", input.ident);
    }
    out += &emit::glsl(proved, version);
    let call =
        |number: &str| format!("{name}_key(uint({number}), {})", arguments(program, number, &format!("{site}(2u)")));
    let location = if version == GlslVersion::V450 { "layout(location = 0) " } else { "" };
    out + &match vertex {
        true => format!("in float at;\nvoid main() {{ gl_Position = vec4({}); }}\n", call("at"))
            .replace("in float", &format!("{location}in float")),
        false => format!("{location}out vec4 colour;\nvoid main() {{ colour = vec4({}); }}\n", call("gl_FragCoord.x")),
    }
}

#[test]
fn glslang_accepts_the_libraries_in_vertex_and_fragment_shaders() {
    if !installed("glslangValidator", "UMBRAGE_REQUIRE_GLSLANG") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    every_plan(|proved, shape| {
        for version in [GlslVersion::V450, GlslVersion::V330, GlslVersion::Es300] {
            for (vertex, stage) in [(true, "vert"), (false, "frag")] {
                let file = folder.path().join(format!("{}.{shape}.{version:?}.{stage}", proved.plan().program.name));
                std::fs::write(&file, glsl(proved, version, vertex)).unwrap();
                accepts("glslangValidator", &[], &file);
            }
        }
    });
}

#[test]
fn glslang_accepts_the_hlsl() {
    if !installed("glslangValidator", "UMBRAGE_REQUIRE_GLSLANG") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    every_plan(|proved, shape| {
        let hlsl = String::from_utf8(emit::emit(proved, Target::Hlsl).unwrap()).unwrap();
        // What shader model 6 brought, and spaces of registers, which 5.1 brought.
        for newer in ["Wave", "space", "int64", "float16", "globallycoherent"] {
            assert!(!hlsl.lines().any(|line| !line.starts_with("//") && line.contains(newer)), "{shape}: {newer}");
        }
        let name = &proved.plan().program.name;
        let file = folder.path().join(format!("{name}.{shape}.hlsl"));
        std::fs::write(&file, hlsl).unwrap();
        let entry = format!("{name}_columns");
        let made = folder.path().join("made.spv");
        let made = made.to_str().unwrap();
        accepts("glslangValidator", &["-D", "-V", "-S", "comp", "-e", &entry, "-o", made], &file);
    });
}

#[test]
fn spirv_val_accepts_the_spirv() {
    if !installed("spirv-val", "UMBRAGE_REQUIRE_SPIRV_VAL") {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    every_plan(|proved, shape| {
        let file = folder.path().join(format!("{}.{shape}.spv", proved.plan().program.name));
        std::fs::write(&file, emit::emit(proved, Target::SpirV).unwrap()).unwrap();
        accepts("spirv-val", &["--target-env", "vulkan1.1"], &file);
    });
}
