//! The generated pipeline for wgpu, compiled here and run on an adapter, and
//! the generated Rust beside it, give what the interpreter gives.

use std::path::Path;

use umbrage::build::{self, Options, Request};
use umbrage::emit::Target;
use umbrage::eval::Interpreter;
use umbrage::plan::Shape;
use umbrage::program::{Domain, Program, Value};

use crate::table;

include!("../generated/smsr/switch.wgpu.rs");
include!("../generated/rsmss/switch_buffer.wgpu.rs");

/// Answers fetches from a row.
struct Row<'r>(&'r rsmss::RsmssFetched);

macro_rules! fetches {
    ($($name:ident)*) => {
        impl rsmss::RsmssSite for Row<'_> {
            $(fn $name(&mut self) -> u32 {
                self.0.$name
            })*
        }
    };
}

fetches!(n_top n_bottom n_left n_right d_cb_h d_cb_v d_cb_top d_cb_bottom d_cb_left d_cb_right);

fn rsmss_lookup(word: u32) -> u32 {
    let bytes = include_bytes!("../generated/rsmss/switch_buffer.lookup.bin");
    let at = 4 * word as usize;
    u32::from_le_bytes([bytes[at], bytes[at + 1], bytes[at + 2], bytes[at + 3]])
}

#[test]
fn the_generated_modules_are_up_to_date() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    for (name, shape) in [("smsr", Shape::Switch), ("rsmss", Shape::SwitchBuffer)] {
        let options =
            Options { shapes: vec![shape], targets: vec![Target::RustWgpu], auto: false, ..Options::default() };
        let paths = vec![root.join(format!("../tables/{name}.ron"))];
        let batch = build::run(&Request { paths, options, ..Request::default() });
        assert!(!batch.failed(), "{:?}", batch.messages);
        for file in batch.files() {
            let path = root.join("tests/generated").join(file.path);
            let same = std::fs::read(&path).is_ok_and(|old| old == file.contents);
            assert!(same, "{} is out of date: run `cargo xtask bless`", path.display());
        }
    }
}

/// Any adapter; none is a failure where the variable says so.
fn device() -> Option<(wgpu::Device, wgpu::Queue)> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    let adapter = pollster::block_on(instance.request_adapter(&wgpu::RequestAdapterOptions::default()));
    let Ok(adapter) = adapter else {
        assert!(std::env::var_os("UMBRAGE_REQUIRE_ADAPTER").is_none(), "there is no adapter");
        println!("skipped: there is no adapter");
        return None;
    };
    Some(pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).unwrap())
}

/// Points in every state, with numbers in quarters and elsewhere.
fn points(program: &Program) -> Vec<Vec<Option<Value>>> {
    let mut levels = vec![0; program.inputs.len()];
    let mut points = Vec::new();
    for state in 0..program.states.count() {
        program.states.write(state, &mut levels);
        for turn in 0..3_usize {
            let value = |(index, input): (usize, &umbrage::program::Input)| match (&input.domain, input.fetched) {
                (Domain::Discrete(_), None) => Value::Level(levels[index]),
                (Domain::Discrete(known), Some(_)) => Value::Level(((state + index * turn) % known.count()) as u8),
                (Domain::Word, _) => Value::Number((state * 7 + index * 3 + turn * 5) as f64),
                (Domain::Continuous { .. }, _) => {
                    let eighths = (state * 7 + index * 3 + turn * 5) % 9;
                    Value::Number(eighths as f64 / 8.0 + if turn == 2 { 1.0 / 64.0 } else { 0.0 })
                }
            };
            points.push(program.inputs.iter().enumerate().map(value).map(Some).collect());
        }
    }
    points
}

fn number(program: &Program, point: &[Option<Value>], name: &str) -> f32 {
    match point[program.input(name).unwrap().index()] {
        Some(Value::Number(number)) => number as f32,
        other => panic!("{name}: {other:?}"),
    }
}

fn level(program: &Program, point: &[Option<Value>], name: &str) -> usize {
    match point[program.input(name).unwrap().index()] {
        Some(Value::Level(level)) => usize::from(level),
        other => panic!("{name}: {other:?}"),
    }
}

/// Value and case by the interpreter.
fn expected(program: &Program, points: &[Vec<Option<Value>>], default: u32) -> Vec<(f32, u32)> {
    let mut interpreter = Interpreter::<f32>::new(program);
    let one = |point: &Vec<Option<Value>>| {
        let outcome = interpreter.evaluate(point).unwrap();
        (outcome.values[0], outcome.row.map_or(default, |row| program.rows[row].id))
    };
    points.iter().map(one).collect()
}

#[test]
fn smsr_on_the_device_and_in_rust() {
    let program = table("smsr");
    let points = points(&program);
    let row = |point: &Vec<Option<Value>>| {
        let level = |name: &str| level(&program, point, name);
        let number = |name: &str| number(&program, point, name);
        let key = smsr::smsr_key_of(
            smsr::SmsrH::ALL[level("H")],
            smsr::SmsrV::ALL[level("V")],
            smsr::SmsrTH::ALL[level("tH")],
            smsr::SmsrTH::ALL[level("tV")],
            level("domH") == 1,
            level("domV") == 1,
        );
        smsr::SmsrInputs { key, dH: number("dH"), dV: number("dV"), px: number("px"), py: number("py") }
    };
    let inputs: Vec<smsr::SmsrInputs> = points.iter().map(row).collect();
    let expected = expected(&program, &points, smsr::SMSR_DEFAULT);
    for (inputs, expected) in inputs.iter().zip(&expected) {
        let result = inputs.evaluate();
        assert_eq!((result.value, result.case_id), *expected, "{inputs:?}");
    }
    assert_eq!(smsr::smsr_case_name(9), Some("shadow below"));
    assert_eq!(smsr::smsr_case_name(smsr::SMSR_DEFAULT), None);
    assert_eq!(smsr::SmsrH::from_code(0.3), smsr::SmsrH::Right);
    assert_eq!((smsr::SmsrTH::DualNegative.code(), smsr::SmsrTH::DualNegative.name()), (-1.0, "dual_negative"));

    let Some((device, queue)) = device() else { return };
    let pipeline = smsr::SmsrPipeline::new(&device);
    let results = pipeline.run(&device, &queue, &inputs).unwrap();
    let results: Vec<(f32, u32)> = results.into_iter().map(|result| (result.value, result.case_id)).collect();
    assert_eq!(results, expected);
    assert!(pipeline.run(&device, &queue, &[]).unwrap().is_empty());
}

#[test]
fn rsmss_on_the_device_and_in_rust() {
    let program = table("rsmss");
    let points = points(&program);
    let row = |point: &Vec<Option<Value>>| {
        let level = |name: &str| level(&program, point, name);
        let fetched = |name: &str| level(name) as u32;
        let number = |name: &str| number(&program, point, name);
        let key = rsmss::rsmss_key_of(
            rsmss::RsmssH::ALL[level("H")],
            rsmss::RsmssV::ALL[level("V")],
            rsmss::RsmssB::ALL[level("b")],
            rsmss::RsmssTH::ALL[level("tH")],
            rsmss::RsmssTH::ALL[level("tV")],
            level("domH") == 1,
            level("domV") == 1,
        );
        let inputs = rsmss::RsmssInputs { key, dH: number("dH"), dV: number("dV"), px: number("px"), py: number("py") };
        let fetched = rsmss::RsmssFetched {
            n_top: fetched("n_top"),
            n_bottom: fetched("n_bottom"),
            n_left: fetched("n_left"),
            n_right: fetched("n_right"),
            d_cb_h: fetched("d_cb_h"),
            d_cb_v: fetched("d_cb_v"),
            d_cb_top: fetched("d_cb_top"),
            d_cb_bottom: fetched("d_cb_bottom"),
            d_cb_left: fetched("d_cb_left"),
            d_cb_right: fetched("d_cb_right"),
        };
        (inputs, fetched)
    };
    let (inputs, fetched): (Vec<_>, Vec<_>) = points.iter().map(row).unzip();
    let expected = expected(&program, &points, rsmss::RSMSS_DEFAULT);
    for ((inputs, fetched), expected) in inputs.iter().zip(&fetched).zip(&expected) {
        let result = inputs.evaluate(&mut Row(fetched));
        assert_eq!((result.value, result.case_id), *expected, "{inputs:?} {fetched:?}");
    }

    let Some((device, queue)) = device() else { return };
    let pipeline = rsmss::RsmssPipeline::new(&device);
    let results = pipeline.run(&device, &queue, &inputs, &fetched).unwrap();
    assert_eq!(results.len(), expected.len());
    for (((value, case), result), inputs) in expected.into_iter().zip(&results).zip(&inputs) {
        // WGSL admits more than one rounding.
        assert!((result.value - value).abs() <= 1e-6 && result.case_id == case, "{inputs:?}: {result:?}, {value}");
    }
}
