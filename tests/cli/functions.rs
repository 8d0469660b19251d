//! Functions of tables, from the table to every executor. Those that are refused stand in `tests/tables/refused`.

use std::fmt::Write as _;
use std::path::Path;
use std::process::Command;

use crate::support::{OrPanic as _, Place};
use umbrage::analyse::{agrees, allowance};
use umbrage::emit;
use umbrage::eval::{Batch, Columns, Interpreter};
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Program, Value};

const TABLES: [&str; 2] = ["tables/double_product.ron", "tables/spherical_gaussian.ron"];

fn programs() -> Vec<Program> {
    TABLES.into_iter().flat_map(|table| Program::read_all(table).or_panic()).collect()
}

/// Whether results are what an example expects, as accurately as the function claims.
fn right(program: &Program, example: usize, got: &[f32]) -> bool {
    let example = &program.examples[example];
    let allowed = allowance(program, &mut Interpreter::new(program), &example.inputs);
    let pairs = got.iter().map(|got| f64::from(*got)).zip(&example.expected);
    match allowed {
        Some(allowed) => pairs.zip(allowed).all(|((got, expected), allowed)| (got - expected).abs() <= allowed),
        None => pairs.into_iter().all(|(got, expected)| agrees(*expected, got)),
    }
}

/// The worked examples of the specification stand in the tables, from fifty
/// digits. Both interpreters reproduce them, in `f32` within what is claimed, in `f64` much better.
#[test]
fn worked_examples_in_the_interpreters() {
    let mut count = 0;
    for program in programs() {
        let mut columns = Columns::<f32>::new(&program);
        program.examples.iter().for_each(|example| columns.push(&example.inputs).unwrap());
        let all_at_once = Batch::<f32>::new(&program).evaluate(&columns).unwrap();
        let (mut narrow, mut wide) = (Interpreter::<f32>::new(&program), Interpreter::<f64>::new(&program));
        for (index, example) in program.examples.iter().enumerate() {
            let got = narrow.evaluate(&example.inputs).unwrap();
            assert!(right(&program, index, &got.values), "{} example {index}: {:?}", program.name, got.values);
            assert_eq!(all_at_once.outcome(index).values, got.values, "{} example {index}", program.name);
            let exact = wide.evaluate(&example.inputs).unwrap().values;
            for (exact, expected) in exact.iter().zip(&example.expected) {
                let error = (exact - expected).abs();
                // A quadrature is good for single precision, not for double.
                assert!(error <= 2e-8 * expected.abs().max(1e-3), "{} example {index}: {error:e}", program.name);
            }
            count += 1;
        }
    }
    assert!(count > 80, "{count}");
}

#[cfg(feature = "gpu")]
#[test]
fn worked_examples_on_the_gpu() {
    use crate::support::adapter;
    use umbrage::emit::kernel::columns::Entry;
    use umbrage::gpu::{Kernel, Language};
    let Some(gpu) = adapter() else { return };
    for program in programs() {
        let proved = Plan::proved(&program, Shape::Ladder).or_panic();
        let mut columns = Columns::<f32>::new(&program);
        program.examples.iter().for_each(|example| columns.push(&example.inputs).unwrap());
        for language in Language::ALL {
            let kernel = Kernel::new(&gpu, &proved, Entry::Levels, language).or_panic();
            let outputs = kernel.run(&columns).or_panic();
            for index in 0..program.examples.len() {
                let got: Vec<f32> = outputs.values.iter().map(|component| component[index]).collect();
                assert!(right(&program, index, &got), "{} {language:?} example {index}: {got:?}", program.name);
            }
        }
    }
}

/// Both divide by the same rules in their own precision, so cells at a threshold may differ, and little else.
#[cfg(all(feature = "gpu", feature = "render"))]
#[test]
fn light_on_the_gpu_is_that_of_the_interpreter() {
    use crate::support::adapter;
    use std::sync::Arc;
    use umbrage::scene::Scene;
    use umbrage::technique::difference::of_light;
    use umbrage::technique::integrals::{CELLS, INTEGRALS};
    use umbrage::technique::rendered::LIGHT;
    use umbrage::technique::{Executor, Frame};
    let Some(gpu) = adapter() else { return };
    let scene = Scene::open("studio").unwrap();
    let executors = [Executor::Gpu(Arc::new(gpu)), Executor::Cpu];
    let [got, expected] = executors.each_ref().map(|on| {
        let frame = Frame::new(&scene, (24, 14), on);
        frame.prepare(&INTEGRALS).and_then(|mut prepared| prepared.render(&|_| {})).or_panic()
    });
    let surfaces = Frame::new(&scene, (24, 14), &executors[1]).surfaces;
    let relative = of_light(&surfaces, got.colours(LIGHT).unwrap(), expected.colours(LIGHT).unwrap());
    assert!(relative < 2e-3, "{relative}");
    let [got, expected] =
        [got, expected].map(|rendered| f64::from(rendered.counts(CELLS).unwrap().iter().sum::<u32>()));
    assert!((got / expected - 1.0).abs() < 0.1, "{got} cells, {expected}");
}

/// The emitted Rust, compiled by itself.
#[test]
fn worked_examples_in_emitted_rust() {
    let folder = tempfile::tempdir().unwrap();
    let programs = programs();
    let mut source = String::new();
    let mut main = String::from("fn main() {\n");
    for program in &programs {
        let proved = Plan::proved(program, Shape::Ladder).or_panic();
        source += &emit::rust(&proved);
        for example in &program.examples {
            let inputs: Vec<String> = example
                .inputs
                .iter()
                .map(|value| match value {
                    Some(Value::Number(number)) => format!("{:?}_f32", *number as f32),
                    other => panic!("{other:?} is no number"),
                })
                .collect();
            let name = &program.name;
            let _ = writeln!(main, "    println!(\"{{:?}}\", {name}::{name}({}));", inputs.join(", "));
        }
    }
    let file = folder.path().join("main.rs");
    std::fs::write(&file, source + &main + "}\n").unwrap();
    let binary = folder.path().join("main");
    let built = Command::new("rustc").args(["--edition", "2021", "-o"]).arg(&binary).arg(&file).output().unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let said = Command::new(&binary).output().unwrap();
    let said = String::from_utf8(said.stdout).unwrap();
    let mut lines = said.lines();
    for program in &programs {
        for index in 0..program.examples.len() {
            // `0.5`, or `DoubleProductMomentsValue { mx: 0.5, ... }`
            let line = lines.next().unwrap();
            let words = line.split([' ', ',', '}']).filter_map(|word| word.parse::<f32>().ok());
            let got: Vec<f32> = words.collect();
            assert_eq!(got.len(), program.output.components().len(), "{line}");
            assert!(right(program, index, &got), "{} example {index}: {line}", program.name);
        }
    }
}

/// Calls of sine and cosine on the longest way through a function, and on the
/// longest that small cells take, counted in the generated WGSL.
#[test]
fn trigonometric_calls_are_few() {
    for program in Program::read_all(TABLES[0]).unwrap() {
        let name = program.function.as_ref().unwrap().name.clone();
        if !["moments", "A", "B", "Lo", "Lo_ends"].contains(&name.as_str()) {
            continue;
        }
        let proved = Plan::proved(&program, Shape::Ladder).or_panic();
        let source = emit::wgsl(&proved);
        let start = source.find(&format!("fn {}_key_case(", program.name)).unwrap();
        let body: Vec<&str> = source[start..].lines().take_while(|line| *line != "}").collect();
        assert!(!body.iter().any(|line| line.contains(" sin(") || line.contains(" cos(")), "{name}");
        // A call gives a sine and a cosine.
        let most = 2 * longest(&mut body.iter().copied().skip(1), false);
        let small = 2 * longest(&mut body.iter().copied().skip(1), true);
        assert!(most <= 10, "{name}: {most}");
        assert!(small <= 6, "{name}: {small}");
        println!("{name}: {most} calls at most, {small} for small cells");
    }
}

/// The most calls on a way through a block, which ends with its closing brace.
/// A small cell takes the series wherever there is one.
fn longest<'a>(lines: &mut impl Iterator<Item = &'a str>, small: bool) -> usize {
    let mut calls = 0;
    while let Some(line) = lines.next() {
        let line = line.trim();
        calls += line.matches("_sincos(").count();
        if line.starts_with("if (") {
            let series = line.contains("abs(") && line.contains("< 1.0)");
            let (yes, no) = (longest(lines, small), longest(lines, small));
            calls += if small && series { yes } else { yes.max(no) };
        } else if line.starts_with('}') {
            return calls;
        }
    }
    calls
}

#[test]
fn values_and_errors_at_the_edges() {
    let place = Place::new();
    place.table("double_product.ron").table("spherical_gaussian.ron");
    let eval = |table: &str, function: &str, rows: &str| {
        place.file("rows.csv", rows);
        place.run(&format!("eval {table}.ron --function {function} --input rows.csv"))
    };
    let cell = "phi0,phi1,theta0,k,b,nx,ny,nz,px,py,pz,alpha_star\n";
    let row = |row: &str| format!("{cell}{row},0.25,-0.5,0.75,0.5,0.25,0.75,0.125\n");
    // Empty cells are exactly nothing; reversed ones count negative.
    assert_eq!(eval("double_product", "Lo", &row("0.5,0.5,0.25,0.75,0.5")).out, "case,value\n0,0\n");
    assert_eq!(eval("double_product", "Lo", &row("0.5,1.25,0.25,0,0.25")).out, "case,value\n0,0\n");
    let forwards = eval("double_product", "B", &row("0.5,1.25,0.25,0.75,0.5")).out;
    let backwards = eval("double_product", "B", &row("1.25,0.5,0.25,0.75,0.5")).out;
    assert_eq!(forwards.replace("0,", "0,-"), backwards);
    // At the pole, and around the whole sphere.
    assert_eq!(eval("double_product", "A1", &row("0,1,0,0,0")).out, "case,value\n0,0\n");
    let sphere = eval(
        "double_product",
        "moments",
        "phi0,phi1,theta0,theta_a,theta_b\n-3.1415927,3.1415927,0,3.1415927,3.1415927\n",
    );
    let omega: f64 = sphere.out.trim().rsplit(',').next().unwrap().parse().unwrap();
    assert!((omega - 4.0 * std::f64::consts::PI).abs() < 3e-6, "{}", sphere.all());
    // No slope, no number: refused, as is a boundary off the sphere.
    for (bad, message) in [
        ("0.5,1.25,0.25,inf,0.5", "inf is not in the range -1000000 to 1000000 of `k`"),
        ("0.5,1.25,0.25,NaN,0.5", "NaN is not in the range -1000000 to 1000000 of `k`"),
        ("0.5,1.25,0.25,10,0.5", "line 2: outside of the domain of `B`"),
    ] {
        let said = eval("double_product", "B", &row(bad));
        assert_eq!((said.code, said.out.as_str()), (Some(2), ""), "{}", said.all());
        assert!(said.err.contains(message), "{}", said.all());
    }
    // Gaussians without width, without sharpness, and very sharp ones; intervals that descend are refused.
    let rows = "mu,lambda,a,b\n2,0,-1,1\n2,0,0.5,0.5\n1,1e6,-1,1\n1,1e6,1,1\n0,1e6,-1,-1\n";
    for function in ["r0", "r1", "alpha", "beta", "e1", "e2"] {
        let said = eval("spherical_gaussian", function, rows);
        assert_eq!(said.code, Some(0), "{}", said.all());
        for line in said.out.lines().skip(1) {
            let value: f64 = line.trim_start_matches("0,").parse().unwrap();
            assert!(value.is_finite(), "{function}: {}", said.all());
        }
    }
    assert_eq!(eval("spherical_gaussian", "r0", rows).out, "case,value\n0,2\n0,2\n0,0.0000005\n0,1\n0,0\n");
    let said = eval("spherical_gaussian", "r0", "mu,lambda,a,b\n1,1,0.5,0.25\n");
    assert!(said.code == Some(2) && said.err.contains("a <= b does not hold"), "{}", said.all());
}

/// The stabilised tables under `docs/` are what the command makes of the printed ones, certificates included.
#[test]
fn stabilised_tables_are_what_the_command_makes() {
    for (name, count) in [("double_product", 15), ("spherical_gaussian", 4)] {
        let place = Place::new();
        place.table(&format!("{name}_printed.ron"));
        let said = place.run(&format!("stabilise {name}_printed.ron -o stable.ron --message-format json"));
        assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{}", said.all());
        let kept = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("docs/{name}_stable.ron"));
        assert_eq!(place.read("stable.ron"), std::fs::read_to_string(kept).unwrap());
        let report: serde_json::Value = serde_json::from_str(&said.out).unwrap();
        let functions = report["functions"].as_array().unwrap();
        assert_eq!(functions.len(), count);
        for function in functions {
            let certificate = &function["certificate"];
            assert_eq!(certificate["met"], true, "{function}");
            assert!(certificate["points"].as_u64() >= Some(90) && certificate["admitted"].is_f64(), "{function}");
        }
        let said = place.run("check stable.ron");
        assert_eq!(said.code, Some(0), "{}", said.all());
    }
}

/// What has no formula to rewrite, or nowhere to go, leaves nothing behind.
#[test]
fn what_cannot_be_stabilised() {
    let place = Place::new();
    place.table("smsr.ron").table("double_product_printed.ron");
    for (arguments, message) in [
        ("stabilise smsr.ron -o new.ron", "the table has no functions to stabilise"),
        ("stabilise missing.ron -o new.ron", "missing.ron"),
        ("stabilise double_product_printed.ron -o no/such/folder.ron", "no/such/folder.ron"),
    ] {
        let said = place.run(arguments);
        assert!(said.code == Some(2) && said.out.is_empty() && said.err.contains(message), "{}", said.all());
        assert!(!place.path("new.ron").exists());
    }
    // Choices are left alone, and the command says so.
    place.file(
        "t.ron",
        r#"Table(language: 1, name: "t", inputs: {"x": Range(from: -1, to: 1)},
            functions: {"f": Function(parameters: ["x"], value: "if x < 0 { 1 / x } else { x }")})"#,
    );
    let said = place.run("stabilise t.ron -o new.ron --no-certificate");
    assert!(said.code == Some(1) && said.out.contains("left alone: it is a choice"), "{}", said.all());
}

/// Words of the language in remarks, and a name that an addition would have.
#[test]
fn stabilised_tables_check_whatever_their_layout() {
    let waves = |remark: &str, helpers: &str| {
        format!(
            "{remark}Table(language: 1, name: \"waves\", title: \"functions: Table(\", {helpers}
            inputs: {{\"x0\": Range(from: -10, to: 10), \"x1\": Range(from: -10, to: 10), \"s\": Range(from: -20, to: 20)}},
            functions: {{\"printed\": Function(parameters: [\"x0\", \"x1\", \"s\"],
                value: \"sin(s * x) / s | x = x0 .. x1\")}})"
        )
    };
    for (remark, helpers, kept) in [
        ("// A Table(...) of functions.\n", "", "\n// A Table(...) of functions.\nTable("),
        ("/* let: { */ ", "helpers: {\"sinc(a)\": \"a * 2\"},", "\"sinc(a)\": \"a * 2\""),
        ("", "helpers: {},", "\"sinc(x)\": ["),
    ] {
        let place = Place::new();
        place.file("waves.ron", waves(remark, helpers));
        let said = place.run("stabilise waves.ron -o stable.ron");
        assert_eq!((said.code, said.err.as_str()), (Some(0), ""), "{}", said.all());
        assert!(place.read("stable.ron").contains(kept), "{}", place.read("stable.ron"));
        assert_eq!(place.run("check stable.ron").code, Some(0), "{}", place.run("check stable.ron").all());
        place.file("rows.csv", "x0,x1,s\n0.25,1,0\n");
        let said = place.run("eval stable.ron --function printed --input rows.csv");
        assert_eq!(said.out, "case,value\n0,0.75\n", "{}", said.all());
    }
    // A table that means nothing is not made into one that does.
    let place = Place::new();
    place.file("waves.ron", waves("", "").replace("sin(s * x) / s", "sinc(s * x) / s"));
    let said = place.run("stabilise waves.ron -o stable.ron");
    assert!(said.code == Some(2) && said.err.contains("error[U0206]: "), "{}", said.all());
}

#[test]
fn columns_of_functions() {
    let place = Place::new();
    place.table("double_product.ron").table("spherical_gaussian.ron");
    place.file("rows.json", r#"[{"phi0": 0, "phi1": 1, "theta0": 0.5, "theta1": 1, "ax": 0, "ay": 0, "az": 1}]"#);
    let said = place.run("eval spherical_gaussian.ron --function interval_printed --input rows.json --output out.json");
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert_eq!(place.read("out.json"), "[\n{\"case\":0,\"a\":0.5403023,\"b\":0.87758255}\n]\n");
    // What a function shares with others but has no use for may be left out.
    place.file("rows.csv", "phi0,phi1,theta0,k,b\n0.5,1.25,0.25,0.75,0.5\n");
    let said = place.run("eval double_product.ron --function A1 --input rows.csv");
    assert_eq!((said.code, said.out.as_str()), (Some(0), "case,value\n0,0.2846367\n"), "{}", said.all());
    let said = place.run("eval double_product.ron --function A --input rows.csv");
    assert!(said.err.contains("the inputs `nx`, `ny`, `nz` are missing"), "{}", said.all());
    for (arguments, message) in [
        ("eval double_product.ron --input rows.csv", "`double_product` is a table of functions"),
        ("eval double_product.ron --function B4 --input rows.csv", "did you mean `B`?"),
        ("explain double_product.ron --function D --at phi0=0", "`double_product` has no function `D`"),
    ] {
        let said = place.run(arguments);
        assert!(said.code == Some(2) && said.err.contains(message), "{}", said.all());
    }
}

#[test]
fn functions_of_other_tables() {
    let place = Place::new();
    place.file(
        "waves.ron",
        r#"Table(language: 1, name: "waves", inputs: {"x": Range(from: -9, to: 9), "k": Range(from: 1, to: 4)},
            constants: {"third": "1 / 3"},
            helpers: {"bend(t)": "1.5 * third * sin(t)"},
            functions: {"wave": Function(parameters: ["x", "k"], value: "bend(k * x)")})"#,
    );
    // Also a table of cases calls functions, and helpers of its own.
    place.file(
        "beach.ron",
        r#"Table(language: 1, name: "beach", hit_policy: First, imports: {"sea": "waves.ron"},
            inputs: {"wet": Bool(), "x": Range(from: 0, to: 1)},
            helpers: {"twice(t)": "2 * t"},
            output: Number(),
            cases: [Case(id: 1, when: "wet", value: "twice(sea.wave(x, 2))")],
            default: 0)"#,
    );
    place.file("rows.csv", "wet,x\ntrue,0.25\nfalse,0.25\n");
    let said = place.run("eval beach.ron --input rows.csv");
    assert_eq!(said.out, "case,value\n1,0.47942555\ndefault,0\n", "{}", said.all());
    assert_eq!(place.run("build beach.ron waves.ron").code, Some(0));
    assert!(place.path("generated/waves/functions.wgsl").exists());
    // A mistake in the imported table is shown there, one in the call here.
    place.file(
        "waves.ron",
        r#"Table(language: 1, name: "waves", inputs: {}, functions: {"wave": Function(parameters: [], value: "1 +")})"#,
    );
    let said = place.run("check beach.ron");
    assert!(said.code == Some(2) && said.err.contains("waves.ron:1:"), "{}", said.all());
}

#[test]
fn generated_functions_are_files_of_their_table() {
    let place = Place::new();
    place.table("spherical_gaussian.ron");
    let said = place.run("build spherical_gaussian.ron");
    assert_eq!(said.code, Some(0), "{}", said.all());
    for extension in ["wgsl", "450.glsl", "330.glsl", "es300.glsl", "rs", "spv", "hlsl", "metal"] {
        assert!(place.path(&format!("generated/spherical_gaussian/functions.{extension}")).exists(), "{extension}");
    }
    assert!(Path::new(env!("CARGO_MANIFEST_DIR")).join("tables/spherical_gaussian.ron").exists());
}
