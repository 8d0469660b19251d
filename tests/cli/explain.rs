//! What `umbrage explain` prints.

use crate::support::Place;

fn explain(at: &str) -> String {
    let place = Place::new();
    place.table("rsmss.ron");
    let said = place.run(&format!("explain rsmss.ron {at}"));
    assert_eq!(said.code, Some(0), "{}", said.all());
    assert_eq!(said.err, "");
    said.out
}

/// Two edges meet: everything depends on everything, nothing is fetched.
#[test]
fn corner() {
    let at = "--at H=left,V=top,domH=true,domV=true,dH=0.75,dV=0.5,px=0.25,py=0.125,n_top=none";
    insta::assert_snapshot!(explain(at));
}

/// A piecewise value, found in its fifth line after two fetches.
#[test]
fn fetched() {
    let at = "--at H=both,V=top,b=exiting,tH=dual_positive,dV=0.7,n_bottom=both,d_cb_h=left,px=0.3,py=0.75";
    insta::assert_snapshot!(explain(at));
}

#[test]
fn double_precision() {
    let at = "--precision f64 --at H=left,dV=0.7,px=0.3";
    let text = explain(at);
    let value = text.split("value, step by step").nth(1).unwrap();
    insta::assert_snapshot!(value);
}

#[test]
fn nothing_given() {
    insta::assert_snapshot!(explain(""));
}

#[test]
fn as_json() {
    let text = explain("--message-format json --at H=left,dV=0.75,px=0.25");
    assert_eq!(text.lines().count(), 1);
    let all: serde_json::Value = serde_json::from_str(&text).unwrap();
    assert_eq!(all["case"], 23);
    assert_eq!(all["value"][0], "0.5");
    assert_eq!(all["refused"][1]["fails"]["condition"], "H == both");
    assert_eq!(all["steps"][0]["formula"], "1 + px");
}
