//! What `umbrage why` and `umbrage explain CODE` print.

use crate::support::Place;

fn said(arguments: &str) -> String {
    let place = Place::new();
    place.table("rsmss.ron");
    let said = place.run(arguments);
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert_eq!(said.err, "");
    said.out
}

/// A corner, decided by the state alone.
#[test]
fn corner() {
    insta::assert_snapshot!(said("why rsmss.ron --case 19"));
}

/// Five lines, told apart by what is fetched.
#[test]
fn fetched_lines() {
    insta::assert_snapshot!(said("why rsmss.ron --case 12"));
}

#[test]
fn as_json() {
    let text = said("why rsmss.ron --case 19 --message-format json");
    let all: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&all["case"], &all["states"], &all["of_states"]), (&19.into(), &16.into(), &1152.into()));
    // What is said to lead there does.
    let at = all["smallest"]["at"].as_str().unwrap();
    let there: serde_json::Value =
        serde_json::from_str(&said(&format!("explain rsmss.ron --message-format json --at {at}"))).unwrap();
    assert_eq!((&there["case"], &there["value"]), (&19.into(), &all["smallest"]["value"]));
}

#[test]
fn codes() {
    insta::assert_snapshot!(said("explain U0209"));
    let entry: serde_json::Value = serde_json::from_str(&said("explain u0209 --message-format json")).unwrap();
    assert_eq!(entry["code"], "U0209");
}

#[test]
fn bad_input() {
    let place = Place::new();
    place.table("smsr.ron");
    let mut all = String::new();
    for arguments in [
        "explain U9999",
        "why smsr.ron --case 13",
        "why smsr.ron",
        "why none.ron --case 1",
        "why smsr.ron --case 1 --profile none.ron",
    ] {
        all.push_str(&format!("$ umbrage {arguments}\n{}\n", place.run(arguments).all()));
    }
    insta::assert_snapshot!(all);
}
