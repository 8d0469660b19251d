//! The reference compiler of GLSL accepts what is emitted, in every version.
//!
//! naga reads GLSL 450 only. Without glslang installed there is nothing to
//! test; `UMBRAGE_REQUIRE_GLSLANG=1`, which the test command sets once it has
//! installed it, makes that a failure.

use std::process::Command;

use crate::support::OrPanic as _;
use umbrage::emit;
use umbrage::emit::GlslVersion;
use umbrage::emit::kernel::columns;
use umbrage::plan::{Plan, Shape};
use umbrage::program::Program;

#[test]
fn glslang_accepts_every_version() {
    if Command::new("glslangValidator").arg("--version").output().is_err() {
        assert!(std::env::var_os("UMBRAGE_REQUIRE_GLSLANG").is_none(), "glslangValidator is missing");
        println!("skipped: glslangValidator is not installed");
        return;
    }
    let folder = tempfile::tempdir().expect("a temporary directory");
    for table in ["tables/smsr.ron", "tables/rsmss.ron"] {
        let program = Program::read(table).or_panic();
        for shape in Shape::ALL {
            if shape == Shape::Gathered && program.fetched.is_empty() {
                continue;
            }
            let proved = Plan::proved(&program, shape).or_panic();
            for (version, stage) in
                [(GlslVersion::V450, "comp"), (GlslVersion::V330, "frag"), (GlslVersion::Es300, "frag")]
            {
                let source = columns::glsl_library(&proved, &emit::glsl(&proved, version), version);
                let file = folder.path().join(format!("{}.{shape}.{stage}", program.name));
                std::fs::write(&file, source).expect("written");
                let output = Command::new("glslangValidator").arg(&file).output().expect("it runs");
                let said = String::from_utf8_lossy(&output.stdout);
                assert!(output.status.success(), "{table} {shape} {version:?}: {said}");
            }
        }
    }
}
