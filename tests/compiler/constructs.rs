//! Constructs that were lowered to what programs had before: every plan of them is proved, emitted and validated.

use std::path::Path;

use umbrage::emit::{self, GlslVersion, Target};
use umbrage::plan::{Plan, Shape};
use umbrage::program::Program;
use umbrage::prove::is_unsuitable;

fn program(name: &str) -> Program {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tables/pass").join(name);
    Program::read(path).unwrap()
}

fn emit_all(program: &Program) -> usize {
    let mut plans = 0;
    for shape in Shape::ALL {
        let proved = match Plan::proved(program, shape) {
            Ok(proved) => proved,
            Err(failure) if is_unsuitable(&failure) => continue,
            Err(failure) => panic!("{shape}: {failure}"),
        };
        for target in Target::ALL {
            match emit::emit(&proved, target) {
                Err(failure) if !is_unsuitable(&failure) => panic!("{shape}, {}: {failure}", target.name()),
                _ => {}
            }
        }
        plans += 1;
    }
    plans
}

#[test]
fn calls_of_a_fetch_share_a_function_of_the_host() {
    let program = program("fetches.ron");
    assert!(emit_all(&program) >= 3);
    let proved = Plan::proved(&program, Shape::Ladder).unwrap();
    let wgsl = emit::wgsl(&proved);
    assert!(wgsl.contains("//   fn fetches_fetch_light(site: FetchesSite, dx: f32, dy: f32) -> f32\n"), "{wgsl}");
    assert_eq!(wgsl.matches("//   fn fetches_fetch_").count(), 2, "{wgsl}");
    assert!(wgsl.contains("let light_at_m1_0 = fetches_fetch_light(site, -1.0, 0.0);"), "{wgsl}");
    assert!(wgsl.contains("let kind_at_0 = fetches_fetch_kind(site, 0.0);"), "{wgsl}");
    let glsl = emit::glsl(&proved, GlslVersion::Es300);
    assert!(glsl.contains("float light_at_m1_0 = fetches_fetch_light(site, -1.0, 0.0);"), "{glsl}");
    let rust = emit::rust(&proved);
    assert!(rust.contains("    fn light(&mut self, dx: f32, dy: f32) -> f32;\n"), "{rust}");
    assert!(rust.contains("let light_at_m1_0: f32 = site.light(-1.0, 0.0);"), "{rust}");
}

#[test]
fn claims_and_data_are_emitted_in_every_plan() {
    assert!(emit_all(&program("claims.ron")) >= 3);
    assert!(emit_all(&program("indexed.ron")) >= 3);
}
