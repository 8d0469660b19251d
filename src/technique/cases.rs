//! The cases that were taken in a frame: how often, in which colours, and in words.

use std::collections::BTreeMap;

use super::rendered::{DEFAULT, NONE};
use crate::picture::sheet::{Legend, case_colour};
use crate::program::Program;

/// The number of pixels that took a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct CaseCount<'p> {
    /// Its id; `None` for the default.
    pub id: Option<u32>,
    /// The number of pixels.
    pub pixels: usize,
    /// Its description in the table.
    pub doc: Option<&'p str>,
}

/// The numbers of pixels by case, in the order of ids, without cases that no pixel took; the default comes last.
pub fn counts<'p>(program: &'p Program, cases: &[u32]) -> Vec<CaseCount<'p>> {
    let mut pixels = BTreeMap::<u32, usize>::new();
    for case in cases.iter().filter(|case| **case != NONE) {
        *pixels.entry(*case).or_default() += 1;
    }
    // The default has the largest number.
    let count = |(case, pixels)| {
        let id = (case != DEFAULT).then_some(case);
        let row = program.rows.iter().find(|row| Some(row.id) == id);
        CaseCount { id, pixels, doc: row.map(|row| row.doc.as_str()) }
    };
    pixels.into_iter().map(count).collect()
}

/// The colours of cases over a picture, `None` where no table was evaluated, and what each of them means.
pub fn legend(program: &Program, cases: &[u32]) -> Legend {
    let colour = |case: u32| match case {
        NONE => None,
        DEFAULT => Some(case_colour(None)),
        case => Some(case_colour(Some(case))),
    };
    let entry = |count: CaseCount<'_>| {
        let name = count.id.map_or("default".to_owned(), |id| format!("case {id}"));
        let text = format!("{name}: {} px  {}", count.pixels, count.doc.unwrap_or_default());
        (case_colour(count.id), text)
    };
    let asked = cases.iter().filter(|case| **case != NONE).count();
    Legend {
        head: format!("{}: {asked} of {} pixels asked the table", program.name, cases.len()),
        colours: cases.iter().map(|case| colour(*case)).collect(),
        entries: counts(program, cases).into_iter().map(entry).collect(),
    }
}
