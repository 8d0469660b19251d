//! `umbrage build --certificates`: the files, and what the summary says of them.

use crate::support::Place;

#[test]
fn certificates_lie_beside_the_plans() {
    let place = Place::new();
    place.file(
        "bend.ron",
        r#"Table(language: 1, name: "bend", hit_policy: First,
            inputs: {"d": Bool(), "x": Range(from: 0, to: 1)}, output: Number(),
            cases: [Case(id: 1, when: "d", value: "sqrt(x)")], default: "2 * x")"#,
    );
    let said = place.run("build bend.ron --plan ladder,coefficients --target wgsl --certificates -o out");
    assert_eq!(said.code, Some(0), "{}", said.all());
    let beyond =
        "                 certificate, beyond linear arithmetic: `sqrt` is an unknown function of its operands\n";
    assert_eq!(said.out.matches(beyond).count(), 2, "{}", said.out);
    let file = place.read("out/bend/coefficients.smt2");
    let head = "; Table bend, plan coefficients: do they differ? `unsat` says that they do not.\n; Made by umbrage ";
    assert!(file.starts_with(head), "{file}");
    assert!(file.contains(";   `sqrt` is an unknown function of its operands\n"), "{file}");
    assert!(file.ends_with("(check-sat)\n"), "{file}");
    let said = place.run("build bend.ron --plan ladder --target wgsl -o plain");
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert!(!place.path("plain/bend/ladder.smt2").exists() && !said.out.contains("certificate"));
}

#[test]
fn functions_have_a_certificate_each() {
    let place = Place::new();
    place.file(
        "two.ron",
        r#"Table(language: 1, name: "two",
            inputs: {"x": Range(from: 0, to: 1), "y": Range(from: 0, to: 1)},
            functions: {
                "half": Function(parameters: ["x"], value: "x / 2"),
                "least": Function(parameters: ["x", "y"], value: "min(x, y)"),
            },
        )"#,
    );
    let said = place.run("build two.ron --target wgsl --certificates -o out");
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert!(said.out.contains("                 certificate: linear\n"), "{}", said.out);
    for function in ["half", "least"] {
        assert!(place.path(&format!("out/two/{function}.smt2")).exists(), "{function}");
    }
}
