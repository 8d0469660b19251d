//! Named values in generated code: computed once where they are in sight, declared once in
//! each block, in every plan and every language.

use std::collections::BTreeSet;

use proptest::prelude::*;

use crate::support::{OrPanic as _, parsed};
use umbrage::emit::{self, GlslVersion, Target};
use umbrage::plan::{Plan, Shape};
use umbrage::program::Program;
use umbrage::prove::is_unsuitable;

/// Emits every plan that suits a program, for every target; what can be read by naga is.
fn emit_all(program: &Program, text: &str) -> BTreeSet<Shape> {
    let mut emitted = BTreeSet::new();
    for shape in Shape::ALL {
        let proved = match Plan::proved(program, shape) {
            Ok(proved) => proved,
            Err(failure) if is_unsuitable(&failure) => continue,
            Err(failure) => panic!("{shape}: {failure}\n{text}"),
        };
        for target in Target::ALL {
            if let Err(failure) = emit::emit(&proved, target)
                && !is_unsuitable(&failure)
            {
                panic!("{shape}, {}: {failure}\n{text}\n{}", target.name(), emit::wgsl(&proved));
            }
        }
        for text in [emit::wgsl(&proved), emit::glsl(&proved, GlslVersion::Es300), emit::rust(&proved)] {
            assert_declared_once(&text);
        }
        emitted.insert(shape);
    }
    emitted
}

/// Fails if a local has the name of another one that is in sight. naga says so of WGSL and of GLSL 450; here it is said
/// of the others as well, and of names that hide those of a block around them.
fn assert_declared_once(text: &str) {
    let mut blocks: Vec<BTreeSet<&str>> = vec![BTreeSet::new()];
    for line in text.lines().map(str::trim).filter(|line| !line.starts_with("//")) {
        if line.starts_with('}') {
            blocks.pop();
        }
        let rest = line
            .strip_prefix("let ")
            .or_else(|| line.strip_prefix("var "))
            .or_else(|| ["float ", "uint ", "bool ", "vec2 "].iter().find_map(|ty| line.strip_prefix(ty)));
        let is_local = line.ends_with(';');
        let name =
            rest.filter(|_| is_local).and_then(|rest| rest.split(|c: char| !c.is_alphanumeric() && c != '_').next());
        if let Some(name) = name.filter(|name| *name != "mut") {
            assert!(blocks.iter().all(|block| !block.contains(name)), "`{name}` is declared twice:\n{text}");
            blocks.last_mut().expect("a block is open").insert(name);
        }
        if line.ends_with('{') {
            blocks.push(BTreeSet::new());
        }
    }
}

/// The times that a text occurs in another.
fn count(text: &str, part: &str) -> usize {
    text.matches(part).count()
}

const RING: &str = r#"Table(language: 1, name: "ring", hit_policy: First,
    inputs: {"x": Range(from: -1, to: 1), "y": Range(from: -1, to: 1), "z": Range(from: -1, to: 1)},
    names: {"away": "length(vec3(x * x - 0.5, y * y - 0.5, z * z - 0.5))", "far": "away * 0.5 + x"},
    output: Number(),
    cases: [
        Case(id: 1, when: "0.25 < away && away < 0.5 && far + 0.5 < 1", value: "1 - away"),
        Case(id: 2, when: "0.75 < away && away < 1 && far + 0.5 < 1.5", value: "far"),
    ],
    default: "smoothstep(0.5, 1, away) * far")"#;

/// A value that two guards and the default ask for is computed before the first of them, and nowhere else.
#[test]
fn guards_and_values_share_what_they_name() {
    let program = parsed(RING);
    assert!(emit_all(&program, RING).len() >= 5);
    let proved = Plan::proved(&program, Shape::Ladder).or_panic();
    let wgsl = emit::wgsl(&proved);
    assert_eq!((count(&wgsl, "let away ="), count(&wgsl, "sqrt(")), (1, 1), "{wgsl}");
    assert_eq!(count(&wgsl, "let far ="), 1, "{wgsl}");
}

/// The other side of a choice computes for itself what only the first one has computed.
#[test]
fn what_a_block_computes_is_not_in_sight_behind_it() {
    let text = r#"Table(language: 1, name: "t", hit_policy: First,
        inputs: {"x": Range(from: 1, to: 2), "y": Range(from: 1, to: 2), "d": Bool()},
        names: {"root": "sqrt(x * y + x / y)"},
        output: Number(),
        cases: [Case(id: 1, when: "d", value: "root * root + 1")],
        default: "if x < y { root * root } else { 1 / root + root }")"#;
    let program = parsed(text);
    emit_all(&program, text);
    let wgsl = emit::wgsl(&Plan::proved(&program, Shape::Ladder).or_panic());
    assert_eq!(count(&wgsl, "let root ="), 3, "{wgsl}");
}

/// Names of the table that the module has as well are not used for locals: a call behind them would mean the local.
#[test]
fn locals_hide_nothing_of_the_module() {
    let text = r#"Table(language: 1, name: "t", hit_policy: First,
        inputs: {"x": Range(from: -9, to: 9), "y": Range(from: 1, to: 2), "d": Bool(), "e": Bool()},
        output: Number(),
        cases: [
            Case(id: 1, when: "let t_remainder = x * y; t_remainder * t_remainder + t_remainder % y < 1 && d", value: "x % y"),
            Case(id: 2, when: "e", value: "let T_ARM = x / y; T_ARM * T_ARM + x % T_ARM"),
        ],
        default: "let t_remainder = x * y; t_remainder * t_remainder + t_remainder % y")"#;
    let program = parsed(text);
    emit_all(&program, text);
    let proved = Plan::proved(&program, Shape::Ladder).or_panic();
    for said in [emit::wgsl(&proved), emit::glsl(&proved, GlslVersion::V450), emit::rust(&proved)] {
        assert!(["let t_", "float t_remainder =", "float T_ARM ="].iter().all(|local| !said.contains(local)), "{said}");
    }
}

fn pick(list: &'static [&'static str]) -> impl Strategy<Value = String> {
    prop::sample::select(list).prop_map(str::to_owned)
}

/// An expression over inputs and some names.
fn part(names: Vec<String>) -> impl Strategy<Value = String> {
    let leaf = prop_oneof![
        2 => prop::sample::select(names),
        1 => pick(&["x", "y", "f32(s)", "n", "0.5", "2"]),
    ];
    leaf.prop_recursive(2, 5, 2, |inner| {
        prop_oneof![
            (inner.clone(), pick(&["+", "-", "*", "/ y +"]), inner.clone())
                .prop_map(|(a, op, b)| format!("({a} {op} {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("max({a}, {b})")),
            (inner.clone(), inner.clone()).prop_map(|(a, b)| format!("(if d {{ {a} }} else {{ {b} / y }})")),
            (pick(&["abs", "sqrt", "sin", "floor"]), inner).prop_map(|(f, a)| format!("{f}({a})")),
        ]
    })
}

/// One of more than 40 operations.
fn large(names: Vec<String>) -> impl Strategy<Value = String> {
    prop::collection::vec(part(names), 6..8).prop_map(|parts| {
        // Whatever the parts are, the sum of such products is large enough.
        parts.iter().map(|part| format!("({part}) * ({part} + 0.25)")).collect::<Vec<_>>().join(" + ")
    })
}

/// Tables whose guards are large, mention named values twice, and are followed by guards and values that mention them
/// again; with a fetched input, a symmetry, and levels. A named value may be a constant zero, which nothing is divided by.
fn table() -> impl Strategy<Value = String> {
    let names = || vec!["a".to_owned(), "b".to_owned(), "c".to_owned()];
    let sized = (part(vec!["x".to_owned()]), part(vec!["y".to_owned()]))
        .prop_map(|(x, y)| format!("length(vec3({x}, {y}, 0.5))"));
    let named = (sized, part(vec!["a".to_owned()]), part(vec!["a".to_owned(), "b".to_owned()]));
    let guard =
        (pick(&["a", "b", "c"]), large(names()), pick(&["", " && d", " && s == 1", " && f", " || s == 2 && n < a"]))
            .prop_map(|(name, value, rest)| format!("{name} < 0.5 && {name} < {value}{rest}"));
    let value = prop_oneof![
        large(names()),
        pick(&["a", "b * c", "if a < b { c } else { a / (y + b * b) }", "mix(a, b, c) + n"]),
        (pick(&["a", "b"]), large(names()))
            .prop_map(|(a, v)| format!("if {a} < y {{ {v} }} else {{ {a} / (y + {a} * {a}) }}")),
    ];
    let case = (guard, value.clone(), prop::option::of(value.clone()), any::<bool>());
    (named, prop::collection::vec(case, 1..5), value).prop_map(|((a, b, c), cases, default)| {
        let mut text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
    inputs: {{"x": Range(from: 0, to: 1), "y": Range(from: 1, to: 2), "d": Bool(), "s": Int(from: 0, to: 2),
        "f": Bool(fetched: (cost: 1)), "n": Range(from: 0, to: 1, fetched: (cost: 2))}},
    names: {{"a": "{a}", "b": "{b}", "c": "{c}"}},
    symmetries: {{"turn": Symmetry(map: {{"d": "!d"}})}},
    output: Number(),
    cases: [
"#
        );
        for (number, (guard, value, second, is_image)) in cases.into_iter().enumerate() {
            let id = 2 * number + 1;
            text += &match second {
                None => format!("Case(id: {id}, when: \"{guard}\", value: \"{value}\"),\n"),
                Some(other) => format!(
                    "Case(id: {id}, when: \"{guard}\", lines: [(\"{value}\", \"a < b && a < c\"), \"{other}\"]),\n"
                ),
            };
            if is_image {
                text += &format!("Case(id: {}, is: (case: {id}, under: \"turn\")),\n", id + 1);
            }
        }
        text + &format!("], default: \"{default}\")")
    })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, failure_persistence: None, max_shrink_iters: 40, ..ProptestConfig::default() })]

    #[test]
    fn every_name_is_declared_once_in_a_block(text in table()) {
        emit_all(&parsed(text.as_str()), &text);
    }
}
