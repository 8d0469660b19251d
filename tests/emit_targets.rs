//! Every table in every plan for every target: what is emitted is accepted by
//! naga and, where it is installed, by glslang, and is the same every time.
//!
//! `UMBRAGE_REQUIRE_GLSLANG=1` makes it a failure that glslang is missing.
#![allow(clippy::unwrap_used)]

#[path = "support/tables.rs"]
mod tables;

use std::path::Path;
use std::process::Command;

use umbrage::emit::harness::{Entry, glsl_columns, glsl_library, wgsl_columns};
use umbrage::emit::{GlslVersion, Target, emit, glsl, glsl_module, wgsl_module};

const SPIRV_MAGIC: [u8; 4] = [0x03, 0x02, 0x23, 0x07];

#[test]
fn every_target_is_emitted_and_the_same_every_time() {
    for program in tables::all() {
        let again = tables::plans(&program);
        for (proved, other) in tables::plans(&program).iter().zip(&again) {
            for target in Target::ALL {
                let name = format!("{} {} {}", program.name, proved.plan().shape, target.name());
                let bytes = emit(proved, target).unwrap_or_else(|failure| panic!("{name}: {failure}"));
                assert!(!bytes.is_empty(), "{name}");
                if target == Target::SpirV {
                    assert_eq!(bytes[..4], SPIRV_MAGIC, "{name}");
                    assert_eq!(bytes.len() % 4, 0, "{name}");
                } else {
                    let text = std::str::from_utf8(&bytes).unwrap_or_else(|e| panic!("{name}: {e}"));
                    assert!(text.is_ascii(), "{name}: a description could hide something");
                    assert!(!text.contains(env!("CARGO_MANIFEST_DIR")), "{name} contains a local path");
                    assert!(!text.contains("inf") && !text.contains("NaN"), "{name} contains what is no number");
                }
                assert!(bytes == emit(other, target).unwrap_or_else(|failure| panic!("{name}: {failure}")), "{name}");
            }
        }
    }
}

#[test]
fn the_compute_shaders_are_valid() {
    for program in tables::all() {
        for proved in &tables::plans(&program) {
            for entry in Entry::ALL {
                wgsl_module(&program, &wgsl_columns(proved, entry)).unwrap_or_else(|e| panic!("{e}"));
                glsl_module(&program, &glsl_columns(proved, entry)).unwrap_or_else(|e| panic!("{e}"));
            }
        }
    }
}

/// Whether glslang can be run.
fn glslang() -> bool {
    let found = Command::new("glslangValidator").arg("--version").output().is_ok_and(|output| output.status.success());
    let required = std::env::var_os("UMBRAGE_REQUIRE_GLSLANG").is_some_and(|value| value == "1");
    assert!(found || !required, "glslangValidator is missing; on Debian: apt-get install glslang-tools");
    if !found {
        println!("skipped: glslangValidator is not installed (Debian: glslang-tools)");
    }
    found
}

#[test]
fn glslang_accepts_every_version() {
    if !glslang() {
        return;
    }
    let directory = tempfile::tempdir().unwrap();
    let mut files = Vec::new();
    for program in tables::all() {
        for proved in &tables::plans(&program) {
            for (version, suffix) in
                [(GlslVersion::V450, "450.comp"), (GlslVersion::V330, "330.frag"), (GlslVersion::Es300, "es300.frag")]
            {
                let source = glsl_library(proved, &glsl(proved, version), version);
                let path = directory.path().join(format!("{}.{}.{suffix}", program.name, proved.plan().shape));
                std::fs::write(&path, source).unwrap();
                files.push(path);
            }
            let path = directory.path().join(format!("{}.{}.columns.comp", program.name, proved.plan().shape));
            std::fs::write(&path, glsl_columns(proved, Entry::Levels)).unwrap();
            vulkan(&path);
        }
    }
    // One process for all: each file is a program of its own all the same.
    for path in &files {
        validate(Command::new("glslangValidator").arg(path), path);
    }
}

/// The compute shader uses descriptor sets, which only Vulkan has.
fn vulkan(path: &Path) {
    let out = path.with_extension("spv");
    validate(Command::new("glslangValidator").arg("-V").arg(path).arg("-o").arg(out), path);
}

fn validate(command: &mut Command, path: &Path) {
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}: {}", path.display(), String::from_utf8_lossy(&output.stdout));
}

/// Comments of generated code hold what a table says about itself; none of it may become code.
#[test]
fn descriptions_stay_comments() {
    let program = tables::synthetic().into_iter().find(|program| program.name == "hostile").unwrap();
    let proved = &tables::plans(&program)[0];
    for target in [Target::Wgsl, Target::Glsl(GlslVersion::V450), Target::Rust] {
        let text = String::from_utf8(emit(proved, target).unwrap()).unwrap();
        for line in text.lines().filter(|line| line.contains("evil") || line.contains("#endif")) {
            assert!(line.trim_start().starts_with("//"), "{line}");
        }
        assert!(text.contains("evil"), "the title is shown");
        assert!(!text.contains('\\'), "a backslash continues a comment in GLSL");
    }
}
