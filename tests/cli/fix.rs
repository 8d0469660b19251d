//! `--fix`: tables with inputs decided, in every command that takes it.

use crate::support::Place;

/// What is built has a folder, a prefix and parameters of its own, and gives what the whole table gives.
#[test]
fn a_table_decided_in_part_is_a_table_of_its_own() {
    let place = Place::new();
    place.table("smsr.ron");
    let said = place.run("build smsr.ron --fix domH=true,dominant=false -o out");
    assert_eq!(said.code, Some(2), "{}", said.all());
    let said = place.run("build smsr.ron --fix domH=true -o out --plan switch --target wgsl,rust");
    assert_eq!(said.code, Some(0), "{}", said.all());
    let text = place.read("out/smsr_domH_true/switch.wgsl");
    assert!(text.contains("fn smsr_domH_true(") && !text.contains("smsr_key("), "{text}");
    let inputs = "H,V,tH,tV,px,py,dH,dV,domV\nleft,top,dual_negative,dual_negative,0.25,0.75,0.5,0.25,false\n";
    let whole = inputs.lines().zip(["domH", "true"]).map(|(line, more)| format!("{line},{more}\n")).collect::<String>();
    place.file("part.csv", inputs).file("whole.csv", whole);
    let part = place.run("eval smsr.ron --fix domH=true --input part.csv");
    let whole = place.run("eval smsr.ron --input whole.csv");
    assert_eq!(part.all(), whole.all());
}

#[test]
fn every_command_says_what_it_was_given() {
    let place = Place::new();
    place.file(
        "demo.ron",
        r#"Table(language: 2, name: "demo", title: "A demonstration", hit_policy: First,
    inputs: {"a": Levels(values: {"up": 0, "down": 1}), "b": Bool(default: false), "n": Int(from: -1, to: 1, default: 0), "x": Range(from: 0, to: 1, default: 0.5)},
    assume: {"never": ("a == up || !b", "b is of what goes up")},
    output: Number(),
    cases: [
        Case(id: 1, when: "a == up && b", value: "x * 2", examples: [({"a": up, "b": true}, 1)]),
        Case(id: 2, when: "a == down && n != -1", value: "x", examples: [({"a": down, "x": 0.25}, 0.25)]),
    ],
    default: 0)
"#,
    );
    let mut said = String::new();
    for command in [
        "check demo.ron --fix a=down",
        "check demo.ron --fix n=-1,x=0.25",
        "explain demo.ron --fix a=down,n=-1 --at x=0.75",
        "check demo.ron --fix a=sideways",
        "check demo.ron --fix c=1",
        "check demo.ron --fix x=2",
        "check demo.ron --fix a=up --fix a=down",
        "check demo.ron --fix a=down,b=true",
        "build demo.ron --fix a -o out",
    ] {
        said += &format!("$ umbrage {command}\n{}\n", place.run(command).all());
    }
    assert_eq!(place.files(), ["demo.ron"]);
    insta::assert_snapshot!(said);
}

/// A function is called with what is decided.
#[test]
fn functions_have_nothing_to_decide() {
    let place = Place::new();
    place.table("spherical_gaussian.ron");
    let said = place.run("check spherical_gaussian.ron --fix lambda=1");
    assert!(said.code == Some(2) && said.err.contains("is a function"), "{}", said.all());
}
