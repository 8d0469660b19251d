//! What `umbrage report` puts on its page.

use std::collections::HashSet;

use crate::support::Place;

/// The values of an attribute.
fn values<'t>(page: &'t str, attribute: &str) -> Vec<&'t str> {
    let open = format!(" {attribute}=\"");
    page.split(open.as_str()).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

#[test]
fn everything_is_there_and_linked() {
    let place = Place::new();
    place.table("rsmss.ron");
    assert_eq!(place.run("report rsmss.ron -o a.html").all(), "exit code: 0\n");
    let page = place.read("a.html");
    for part in ["inputs", "cases", "findings", "coverage", "atlas", "plans", "code", "source"] {
        assert!(page.contains(&format!("<h2 id=\"{part}\">")), "{part}");
    }
    let ids: HashSet<&str> = values(&page, "id").into_iter().collect();
    for link in values(&page, "href") {
        match link.strip_prefix('#') {
            Some(id) => assert!(ids.contains(id), "{link} leads nowhere"),
            None => assert!(link.starts_with("data:image/png;base64,"), "{link} is on another page"),
        }
    }
    // Rows lead to their pictures and their code, and code leads back.
    for case in 1..=31 {
        for id in [format!("row-{case}"), format!("case-{case}"), format!("ladder.wgsl-{case}")] {
            assert!(ids.contains(id.as_str()), "{id}");
        }
        assert!(page.contains(&format!("<a href=\"#row-{case}\" id=\"ladder.wgsl-{case}\">")), "case {case}");
    }
    for text in ["proved", "equal to the table on 1152 states", "fn rsmss_key(", "<summary>ladder, msl</summary>"] {
        assert!(page.contains(text), "{text}");
    }
    for outside in ["<script", "<link", " src=", "@import", "url(http"] {
        assert!(!page.contains(outside), "{outside}");
    }
    place.run("report rsmss.ron -o b.html");
    assert!(page == place.read("b.html"), "the same bytes each time");
}

/// What a profile and a tuning say is on the page.
#[test]
fn with_a_profile() {
    let place = Place::new();
    place.table("smsr.ron");
    place.file("points.csv", "H,V,tH,tV,dH,dV,px,py,domH,domV\nleft,none,0,0,0,0.5,0.5,0.5,false,false\nnone,top,-1,0,0,0,0.5,0.5,false,false\n");
    let said = place.run("profile --table smsr.ron --frames points.csv -o p.ron");
    assert_eq!(said.code, Some(0), "{}", said.all());
    let said = place.run("report smsr.ron -o a.html --profile p.ron");
    assert_eq!(said.code, Some(0), "{}", said.all());
    let page = place.read("a.html");
    assert!(page.contains("<h2 id=\"profile\">"));
    assert_eq!(page.matches("50.00 %").count(), 4, "two cases, in their rows and in their pictures");
    assert!(place.run("why smsr.ron --case 11 --profile p.ron").out.contains(" 50.000 %"));
}

#[test]
fn functions_have_pages() {
    let place = Place::new();
    place.file("first.ron", std::fs::read("docs/examples/first.ron").unwrap());
    assert_eq!(place.run("report first.ron -o a.html").all(), "exit code: 0\n");
    assert!(place.read("a.html").contains("id=\"case-5\""));
}

#[test]
fn bad_input() {
    let place = Place::new();
    place.table("smsr.ron").file("broken.ron", "Table(");
    let mut all = String::new();
    for arguments in [
        "none.ron -o a.html",
        "broken.ron -o a.html",
        "smsr.ron",
        "smsr.ron -o no/a.html",
        "smsr.ron -o a.html --profile none.ron",
        "smsr.ron -o a.html --tuned none.ron",
        "smsr.ron -o a.html --function f",
    ] {
        all.push_str(&format!("$ umbrage report {arguments}\n{}\n", place.run(&format!("report {arguments}")).all()));
    }
    insta::assert_snapshot!(all);
    assert_eq!(place.files(), ["broken.ron", "smsr.ron"], "nothing is left behind");
}
