//! Modules of WESL and of naga_oil, imported by a shader.

use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor};
use umbrage::emit::{self, Target};
use umbrage::plan::{Plan, Shape};
use umbrage::program::Program;
use wesl::{ModulePath, VirtualResolver, Wesl};

use crate::{arguments, camel, host, table};

fn module(program: &Program, shape: Shape, target: Target) -> String {
    let proved = Plan::proved(program, shape).unwrap_or_else(|error| panic!("{error}"));
    String::from_utf8(emit::emit(&proved, target).unwrap_or_else(|error| panic!("{error}"))).unwrap()
}

/// A fragment shader that calls the table.
fn shader(program: &Program) -> String {
    let name = &program.name;
    let (site, host) = (camel(program), !host(program).is_empty());
    let site = if host { format!("let site = {site}Site(2u);") } else { String::new() };
    let arguments = arguments(program, "at.x", "site");
    format!(
        "@fragment\nfn main(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {{\n    {site}\n    \
         return vec4<f32>({name}_key(u32(at.y), {arguments}));\n}}\n"
    )
}

#[test]
fn wesl_imports_the_module() {
    for name in ["smsr", "rsmss"] {
        let program = table(name);
        for shape in [Shape::Ladder, Shape::Ordered, Shape::Switch] {
            let mut resolver = VirtualResolver::new();
            let path = |text: &str| text.parse::<ModulePath>().unwrap();
            resolver.add_module(path(&format!("package::{name}")), module(&program, shape, Target::Wesl).into());
            let mut main = format!("import package::{name}::{name}_key;\n");
            if !host(&program).is_empty() {
                resolver.add_module(path(&format!("package::{name}_host")), host(&program).into());
                main += &format!("import package::{name}_host::{}Site;\n", camel(&program));
            }
            resolver.add_module(path("package::main"), (main + &shader(&program)).into());
            let compiled = Wesl::new("").set_custom_resolver(resolver).compile(&path("package::main"));
            let compiled = compiled.unwrap_or_else(|error| panic!("{name} {shape}: {error}")).to_string();
            let checked = emit::wgsl_module(&program, &compiled).unwrap_or_else(|error| panic!("{error}\n{compiled}"));
            assert_eq!(checked.module.entry_points.len(), 1);
        }
    }
}

#[test]
fn naga_oil_imports_the_module() {
    for name in ["smsr", "rsmss"] {
        let program = table(name);
        for shape in [Shape::Ladder, Shape::Ordered, Shape::Switch] {
            let mut composer = Composer::default();
            let mut add = |source: &str| {
                let descriptor = ComposableModuleDescriptor { source, file_path: name, ..Default::default() };
                if let Err(error) = composer.add_composable_module(descriptor) {
                    panic!("{name} {shape}: {}", error.emit_to_string(&composer));
                }
            };
            let mut main = format!("#import umbrage::{name}::{name}_key\n");
            if !host(&program).is_empty() {
                add(&format!("#define_import_path umbrage::{name}_host\n{}", host(&program)));
                main += &format!("#import umbrage::{name}_host::{}Site\n", camel(&program));
            }
            add(&module(&program, shape, Target::NagaOil));
            main += &shader(&program);
            let descriptor = NagaModuleDescriptor { source: &main, file_path: "main", ..Default::default() };
            match composer.make_naga_module(descriptor) {
                Ok(made) => assert_eq!(made.entry_points.len(), 1),
                Err(error) => panic!("{name} {shape}: {}", error.emit_to_string(&composer)),
            }
        }
    }
}
