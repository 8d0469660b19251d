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
    assert!(caught * 10 >= harmful * 7, "{caught} of {harmful} seeded mistakes are caught");
}
