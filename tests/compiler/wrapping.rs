//! U32: every operation as Rust's `u32` has it, bit for bit, in every interpreter and in the code that is
//! made; the hash that comes with Umbrage; tables of cases over words.

use umbrage::diag::Source;
use umbrage::emit::kernel::columns::{Entry, glsl_columns, wgsl_columns};
use umbrage::emit::{GlslVersion, glsl, glsl_module, rust, wgsl, wgsl_module};
use umbrage::eval::{Batch, Columns, Interpreter, IntervalInterpreter};
use umbrage::plan::{Plan, Shape};
use umbrage::program::{Program, Real, Scalar, Value};
use umbrage::table::Table;

#[allow(unreachable_pub, missing_docs)]
mod emitted {
    include!("../../generated/pcg/functions.rs");
}

fn program(text: &str) -> Program {
    let table = Table::parse(Source::new("t.ron", text)).unwrap_or_else(|e| panic!("{e}"));
    Program::check(&table).unwrap_or_else(|e| panic!("{e}"))
}

/// A value of two words, as an expression and as what it comes to.
type Operation = (&'static str, fn(u32, u32) -> u32);

const OPERATIONS: &[Operation] = &[
    ("a + b", u32::wrapping_add),
    ("a - b", u32::wrapping_sub),
    ("a * b", u32::wrapping_mul),
    ("a / max(b, 1)", |a, b| a / b.max(1)),
    ("a % (b | 1)", |a, b| a % (b | 1)),
    ("a & b", |a, b| a & b),
    ("a | b", |a, b| a | b),
    ("a ^ b", |a, b| a ^ b),
    ("~a ^ 0xF0F0F0F0", |a, _| !a ^ 0xF0F0_F0F0),
    ("a << b", u32::wrapping_shl),
    ("a >> (b & 31)", |a, b| a >> (b & 31)),
    ("(a << 7) | (a >> 25)", |a, _| a.rotate_left(7)),
    ("min(a, b) ^ max(a, 3)", |a, b| a.min(b) ^ a.max(3)),
    ("clamp(a, 10, 4000000000)", |a, _| a.clamp(10, 4_000_000_000)),
    ("if a < b { a - 1 } else { b * 3 }", |a, b| if a < b { a.wrapping_sub(1) } else { b.wrapping_mul(3) }),
    ("u32(f32(a >> 8) * 0.5) + u32(a == b)", |a, b| ((a >> 8) as f32 * 0.5) as u32 + u32::from(a == b)),
    ("u32(i32(a & 15) - 8) * 3", |a, _| ((a & 15) as i32 - 8).cast_unsigned().wrapping_mul(3)),
    ("u32(count(a >= b, a in {0, 4294967295}, a != 1))", |a, b| {
        u32::from(a >= b) + u32::from(a == 0 || a == u32::MAX) + u32::from(a != 1)
    }),
    ("u32(4294967295) + b * 0 + 7 - a % 3", |a, _| 6_u32.wrapping_sub(a % 3)),
];

fn table(value: &str) -> Program {
    program(&format!(
        r#"Table(language: 2, name: "t", hit_policy: First, inputs: {{"a": U32(), "b": U32(), "c": Bool()}},
            output: Record({{"word": U32(), "share": Number()}}),
            cases: [Case(id: 1, when: "c || a > 7", value: "{{word: {value}, share: f32(b) / 2}}")],
            default: "{{word: ~a, share: 0}}")"#
    ))
}

/// Words at which something can go wrong, those that are no number as an `f32` among them, and others.
fn words() -> Vec<u32> {
    let mut all = vec![0, 1, 2, 7, 8, 31, 32, 33, 0xff, 0x00ff_ffff, 0x0100_0001, 0x7f80_0000, 0x7f80_0001];
    all.extend([0x7fff_ffff, 0x8000_0000, 0x8000_0001, 0xff80_0001, 0xffc0_0000, u32::MAX - 1, u32::MAX]);
    let mut state = 1_u32;
    all.extend((0..12).map(|_| {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        state
    }));
    all
}

fn point(a: u32, b: u32, c: bool) -> [Option<Value>; 3] {
    let word = |word| Some(Value::Number(f64::from(word)));
    [word(a), word(b), Some(Value::Level(u8::from(c)))]
}

fn agree<T: Real>(program: &Program, text: &str, of: fn(u32, u32) -> u32) {
    let (mut interpreter, mut batch) = (Interpreter::<T>::new(program), Batch::<T>::new(program));
    let all = words();
    let pairs: Vec<(u32, u32)> = all.iter().flat_map(|a| all.iter().map(move |b| (*a, *b))).collect();
    let points: Vec<_> = pairs.iter().map(|(a, b)| point(*a, *b, b % 3 == 0)).collect();
    let columns = Columns::from_rows(program, &points).unwrap();
    let results = batch.evaluate(&columns).unwrap();
    for (row, (a, b)) in pairs.iter().enumerate() {
        let is_case = b % 3 == 0 || *a > 7;
        let expected = if is_case { of(*a, *b) } else { !a };
        let one = interpreter.evaluate(&points[row]).unwrap();
        assert_eq!(one.values[0].to_word(), expected, "{text} of {a} and {b}");
        assert_eq!(program.output.numbers(&one.values)[0], f64::from(expected));
        let all_at_once = results.outcome(row);
        assert_eq!(all_at_once.values[0].to_word(), expected, "{text} of {a} and {b}, all at once");
        assert_eq!((all_at_once.row, columns.point(row)), (one.row, points[row].to_vec()));
    }
}

#[test]
fn interpreters_calculate_as_u32_does() {
    for (text, of) in OPERATIONS {
        let program = table(text);
        agree::<f32>(&program, text, *of);
        agree::<f64>(&program, text, *of);
        let mut intervals = IntervalInterpreter::new(&program);
        for (a, b) in words().into_iter().zip(words().into_iter().rev()) {
            let admitted = intervals.admissible(&point(a, b, true)).unwrap();
            let carried = |word: u32| [f32::from_word(word), b as f32 / 2.0];
            assert!(admitted.contains(Some(0), &carried(of(a, b))), "{text} of {a} and {b}: {admitted:?}");
            assert!(!admitted.contains(Some(0), &carried(of(a, b) ^ 1)), "{text} of {a} and {b}: {admitted:?}");
        }
    }
}

#[cfg(feature = "precise")]
#[test]
fn many_bits_hold_the_same_words() {
    for (text, of) in OPERATIONS {
        let program = table(text);
        let mut precise = umbrage::eval::Precise::new(&program).unwrap();
        for (a, b) in words().into_iter().zip(words().into_iter().rev()) {
            assert_eq!(precise.value(&point(a, b, true)).unwrap()[0], f64::from(of(a, b)), "{text} of {a} and {b}");
        }
    }
}

#[test]
fn every_plan_of_words_is_proved_emitted_and_valid() {
    for (text, _) in OPERATIONS {
        let program = table(text);
        for shape in [Shape::Ladder, Shape::Switch, Shape::Tree] {
            let proved = Plan::proved(&program, shape).unwrap_or_else(|e| panic!("{text}: {e}"));
            for entry in Entry::ALL {
                let (wgsl, glsl) = (wgsl_columns(&proved, entry), glsl_columns(&proved, entry));
                wgsl_module(&program, &wgsl).unwrap_or_else(|e| panic!("{text}: {e}"));
                glsl_module(&program, &glsl).unwrap_or_else(|e| panic!("{text}: {e}"));
            }
            assert!(glsl(&proved, GlslVersion::Es300).contains("uint word;"));
            assert!(rust(&proved).contains("pub word: u32"));
        }
    }
}

#[test]
fn code_is_as_one_would_write_it() {
    let program = table("((a >> b) ^ a) * 277803737 + u32(i32(a & 15) - 8)");
    assert_eq!(program.output.components()[0].scalar, Scalar::Word);
    let proved = Plan::proved(&program, Shape::Ladder).unwrap_or_else(|e| panic!("{e}"));
    let wgsl = wgsl(&proved);
    for part in [
        "fn t_key_case(key: u32, a: u32, b: u32) -> TResult",
        // By as many places as WGSL says, which other languages leave open.
        "(((a >> (b & 31u)) ^ a) * 277803737u) + u32(i32(a & 15u) - 8i)",
        "c || (7u < a)",
        "~a",
    ] {
        assert!(wgsl.contains(part), "{part} is not in:\n{wgsl}");
    }
    let rust = rust(&proved);
    let part = "u32::wrapping_add(u32::wrapping_mul((a >> (b & 31u32)) ^ a, 277803737u32), ";
    assert!(rust.contains(part), "{part} is not in:\n{rust}");
}

/// The values of the specification, of which a test of the table itself has some more.
#[test]
fn the_hash_is_the_published_one_in_interpreters_and_in_rust() {
    let hash = Program::read_function("tables/pcg.ron", Some("hash")).unwrap_or_else(|e| panic!("{e}"));
    let jitter = Program::read_function("tables/pcg.ron", Some("jitter")).unwrap_or_else(|e| panic!("{e}"));
    let unit = Program::read_function("tables/pcg.ron", Some("unit")).unwrap_or_else(|e| panic!("{e}"));
    let published = [(0, 0x07bb_2fe2), (1, 0xa8be_ea3c), (2, 0x7a7e_cc88), (12345, 0xf45e_ad0e)];
    let (mut narrow, mut wide) = (Interpreter::<f32>::new(&hash), Interpreter::<f64>::new(&hash));
    let mut numbers = Interpreter::<f32>::new(&unit);
    let others = words().into_iter().map(|word| (word, emitted::pcg_hash::pcg_hash_key(0, word)));
    for (word, expected) in published.into_iter().chain(others) {
        let point = [Some(Value::Number(f64::from(word)))];
        assert_eq!(narrow.evaluate(&point).unwrap().values[0].to_word(), expected, "{word}");
        assert_eq!(wide.evaluate(&point).unwrap().values[0], f64::from(expected), "{word}");
        assert_eq!(emitted::pcg_hash::pcg_hash_key(0, word), expected, "{word}");
        let number = (expected >> 8) as f32 / 16_777_216.0;
        assert_eq!(numbers.evaluate(&point).unwrap().values, [number]);
        assert_eq!(emitted::pcg_unit::pcg_unit_key(0, word), number);
    }
    let mut interpreter = Interpreter::<f32>::new(&jitter);
    for ([x, y, slab, seed], expected) in [([0, 0, 0, 1], 555_269_243), ([17, 5, 3, 1], 611_497_148)] {
        let point = [x, y, slab, seed].map(|word: u32| Some(Value::Number(f64::from(word))));
        assert_eq!(interpreter.evaluate(&point).unwrap().values[0].to_word(), expected);
        assert_eq!(emitted::pcg_jitter::pcg_jitter_key(0, x, y, slab, seed), expected);
    }
}

/// No numbers lie between two words: neither a gap nor a case that only they could reach.
#[test]
fn cases_of_words_are_told_apart_exactly() {
    let claimed = |guards: [&str; 3]| {
        let cases: String = (guards.iter().zip(1..))
            .map(|(guard, id)| format!("Case(id: {id}, when: \"{guard}\", value: {id}),"))
            .collect();
        let program = program(&format!(
            r#"Table(language: 2, name: "t", hit_policy: Unique, inputs: {{"v": U32()}}, output: U32(),
                cases: [{cases}], default: 0)"#
        ));
        umbrage::analyse::findings(&program)
            .iter()
            .map(|found| format!("{} {}", found.code, found.message))
            .collect::<Vec<_>>()
    };
    assert_eq!(claimed(["v <= 9", "v == 10", "v >= 11"]), [""; 0]);
    assert_eq!(claimed(["v < 10", "!(v < 10 || v > 11)", "v > 11"]), [""; 0]);
    assert_eq!(claimed(["(v & 3) < 2", "(v & 3) == 2", "(v & 3) > 2"]), [""; 0]);
    assert_eq!(
        claimed(["v < 10", "v > 10 && v < 4294967295", "v == 4294967295"]),
        ["U0503 no case claims `v >= 10 && v < 11`; the default decides there"]
    );
    let dead = claimed(["v <= 9", "v > 9 && v < 10", "v >= 10"]);
    assert!(dead.iter().any(|found| found == "U0504 case 2 is never taken"), "{dead:?}");
}
