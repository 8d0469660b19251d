//! The trial of the analyses: its report is current, and seeded mistakes are found.

use crate::support::OrPanic as _;
use umbrage::analyse::trial;
use umbrage::program::Program;
use umbrage::table::Table;

/// `docs/errata.md` says what the code says; what takes long, the seeded mistakes, is only sampled here.
#[test]
fn the_report_on_errata_is_current() {
    let read = |path: &str| Program::read(path).or_panic();
    let report = |printed: &str, mended: &str| trial::errata(&read(printed), &read(mended));
    let now = [
        report("tables/published/rsmss_as_printed.ron", "tables/rsmss.ron"),
        report("tables/published/smsr_as_printed.ron", "tables/smsr.ron"),
    ];
    let document = std::fs::read_to_string("docs/errata.md").unwrap();
    for section in now {
        assert!(document.contains(section.trim_end()), "docs/errata.md is out of date: run `cargo xtask errata`");
    }
    let table = Table::read("tables/smsr.ron").or_panic();
    let tallies = trial::survey(&table, 60, 7, |_| {}).or_panic();
    let (harmful, caught) = tallies.iter().fold((0, 0), |(h, c), (_, t)| (h + t.harmful(), c + t.caught()));
    assert!(caught * 100 >= harmful * 97, "{caught} of {harmful} seeded mistakes are caught");
}

/// What a table acknowledges of itself hides nothing that is put into it later: mistakes in cases whose
/// findings of the same code are acknowledged.
#[test]
fn acknowledgements_hide_no_new_mistakes() {
    let text = std::fs::read_to_string("tables/rsmss.ron").unwrap();
    for (case, was, is) in [
        (1, "tV == dual_negative", "tH == dual_negative"),
        (4, "\"py - px\"", "\"px - px\""),
        (5, "\"px + py - 1\"", "\"px + py + 1\""),
        (9, "tV == positive_negative", "tH == positive_negative"),
    ] {
        let start = text.find(&format!("Case(id: {case},")).unwrap();
        let place = start + text[start..].find(was).unwrap();
        let mutant = format!("{}{is}{}", &text[..place], &text[place + was.len()..]);
        let source = umbrage::diag::Source::new("rsmss.ron", &mutant);
        let program = Table::parse(source).and_then(|table| Program::check(&table)).or_panic();
        let found = umbrage::analyse::findings(&program);
        let told = found.iter().filter(|finding| finding.code.0 != "U0501" && finding.code.0 != "U0531");
        assert!(told.count() > 0, "case {case} with {is}: {found:?}");
    }
}
