//! Hits: how often each line of a table gave the result, and the form in which tools for coverage read them.
//!
//! LCOV is a text of records, one for each run and file: functions, which here are the cases;
//! branches, which are the lines that a case has; and hits of lines of the text. Where more of the
//! table stands on one line of the text, the larger number of hits is that of the line.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::eval::{Batch, Columns, Missing};
use crate::program::{Outcome, Program};

/// The number of times that each outcome of a table occurred in one scene.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Hits {
    /// Name of the scene.
    pub scene: String,
    /// Counts by outcome; those that did not occur are left out.
    counts: BTreeMap<Outcome, u64>,
}

impl Hits {
    /// Counts what a table comes to at points.
    ///
    /// # Errors
    /// With the first point that needs an absent input.
    pub fn of_columns(program: &Program, scene: &str, columns: &Columns<f32>) -> Result<Self, Missing> {
        let mut counts: BTreeMap<Outcome, u64> = BTreeMap::new();
        for (path, count) in Batch::<f32>::new(program).evaluate(columns)?.histogram() {
            *counts.entry(Outcome { row: path.row, line: path.line }).or_default() += count as u64;
        }
        Ok(Self { scene: scene.to_owned(), counts })
    }

    /// The counts that a counting shader has made, by the numbers that it counts by: those of
    /// [`Program::outcomes`]. `None` if there are not as many.
    pub fn of_counts(program: &Program, scene: &str, counts: &[u64]) -> Option<Self> {
        let outcomes = program.outcomes();
        if outcomes.len() != counts.len() {
            return None;
        }
        let counts = outcomes.into_iter().zip(counts.iter().copied()).filter(|(_, count)| *count > 0).collect();
        Some(Self { scene: scene.to_owned(), counts })
    }

    /// The number of results that a line of a case gave, whatever image of the case was taken.
    pub fn of_line(&self, program: &Program, case: Option<u32>, line: Option<usize>) -> u64 {
        let is_it = |outcome: &Outcome| outcome.row.map(|row| program.rows[row].id) == case && outcome.line == line;
        self.counts.iter().filter(|(outcome, _)| is_it(outcome)).map(|(_, count)| count).sum()
    }

    /// The number of times that a case was taken; `None` is the default.
    pub fn of_case(&self, program: &Program, case: Option<u32>) -> u64 {
        let is_it = |outcome: &Outcome| outcome.row.map(|row| program.rows[row].id) == case;
        self.counts.iter().filter(|(outcome, _)| is_it(outcome)).map(|(_, count)| count).sum()
    }
}

/// The cases with the outcomes that each of them has, images counted as the case they are of; the default last.
fn cases(program: &Program) -> Vec<(Option<u32>, Vec<Option<usize>>)> {
    let mut cases: Vec<(Option<u32>, Vec<Option<usize>>)> = Vec::new();
    for outcome in program.outcomes() {
        let id = outcome.row.map(|row| program.rows[row].id);
        match cases.iter_mut().find(|(case, _)| *case == id) {
            Some((_, lines)) if lines.contains(&outcome.line) => {}
            Some((_, lines)) => lines.push(outcome.line),
            None => cases.push((id, vec![outcome.line])),
        }
    }
    cases
}

/// Hits as LCOV reads them, a record for each scene.
///
/// ```
/// use umbrage::profile::{Hits, lcov};
/// use umbrage::program::Program;
///
/// let program = Program::read("tables/smsr.ron")?;
/// let counts = vec![1; program.outcomes().len()];
/// let hits = Hits::of_counts(&program, "fence", &counts).expect("a count for each outcome");
/// let text = lcov(&program, &[hits]);
/// assert!(text.starts_with("TN:fence\nSF:tables/smsr.ron\n") && text.ends_with("end_of_record\n"));
/// # Ok::<(), umbrage::diag::Failure>(())
/// ```
pub fn lcov(program: &Program, all: &[Hits]) -> String {
    let cases = cases(program);
    all.iter().fold(String::new(), |out, hits| out + &record(program, &cases, hits))
}

fn record(program: &Program, cases: &[(Option<u32>, Vec<Option<usize>>)], hits: &Hits) -> String {
    let text_line = |outcome: Outcome| program.line(program.place(outcome));
    // By line of the text, its hits.
    let mut lines: BTreeMap<usize, u64> = BTreeMap::new();
    let mut hit = |line: usize, count: u64| {
        let known = lines.entry(line).or_default();
        *known = count.max(*known);
    };
    let (mut functions, mut branches) = (String::new(), String::new());
    let (mut called, mut taken, mut of_branches) = (0, 0, 0);
    for (block, (case, of_case)) in cases.iter().enumerate() {
        let count = hits.of_case(program, *case);
        let row = case.and_then(|case| program.rows.iter().position(|row| row.id == case));
        let (place, name) = match row.map(|row| &program.rows[row]) {
            Some(row) => {
                hit(program.line(row.guard_span), count);
                (program.line(row.span), format!("case {}", row.id))
            }
            None => (text_line(Outcome { row: None, line: None }), "default".to_owned()),
        };
        hit(place, count);
        // Writing to a string cannot fail.
        let _ = writeln!(functions, "FN:{place},{name}\nFNDA:{count},{name}");
        called += usize::from(count > 0);
        for (branch, line) in of_case.iter().enumerate() {
            let of_line = hits.of_line(program, *case, *line);
            let place = text_line(Outcome { row, line: *line });
            if line.is_some() {
                hit(place, of_line);
            }
            if of_case.len() > 1 {
                let shown = if count > 0 { of_line.to_string() } else { "-".to_owned() };
                let _ = writeln!(branches, "BRDA:{place},{block},{branch},{shown}");
                of_branches += 1;
                taken += usize::from(of_line > 0);
            }
        }
    }
    let mut out = format!("TN:{}\nSF:{}\n{functions}", test_name(&hits.scene), program.source.name);
    let _ = writeln!(out, "FNF:{}\nFNH:{called}", cases.len());
    out += &branches;
    let _ = writeln!(out, "BRF:{of_branches}\nBRH:{taken}");
    for (line, count) in &lines {
        let _ = writeln!(out, "DA:{line},{count}");
    }
    let _ = writeln!(out, "LF:{}\nLH:{}", lines.len(), lines.values().filter(|count| **count > 0).count());
    out + "end_of_record\n"
}

/// The name of a scene as LCOV admits names of tests: letters, digits and underscores.
fn test_name(scene: &str) -> String {
    scene.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::program::Value;
    use crate::table::Table;

    const TABLE: &str = "Table(language: 2, name: \"t\", hit_policy: First,
        inputs: {\"b\": Bool(), \"x\": Range(from: 0, to: 1)},
        symmetries: {\"m\": Symmetry(map: {\"b\": \"!b\"})},
        output: Number(),
        cases: [
            Case(id: 4,
                when: \"b && x < 0.5\",
                lines: [
                    (\"x\", \"x < 0.25\"),
                    (\"1\", \"x > 0.375\"),
                ],
                images: [\"m\"]),
            Case(id: 9, when: \"b\", value: 2),
        ],
        default: 0)";

    #[test]
    fn rows_and_lines_are_counted_where_they_stand() {
        let table = Table::parse(Source::new("tables/t.ron", TABLE));
        let program = table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"));
        let points = [(1, 0.125), (0, 0.4), (1, 0.4), (1, 0.3), (1, 0.75), (0, 0.75)];
        let points = points.map(|(b, x)| vec![Some(Value::Level(b)), Some(Value::Number(x))]);
        let columns = Columns::<f32>::from_rows(&program, &points).unwrap_or_else(|e| panic!("{e:?}"));
        let hits = Hits::of_columns(&program, "a scene", &columns).unwrap_or_else(|e| panic!("{e:?}"));
        let expected = "TN:a_scene
SF:tables/t.ron
FN:6,case 4
FNDA:4,case 4
FN:13,case 9
FNDA:1,case 9
FN:15,default
FNDA:1,default
FNF:3
FNH:3
BRDA:9,0,0,1
BRDA:10,0,1,2
BRDA:6,0,2,1
BRF:3
BRH:3
DA:6,4
DA:7,4
DA:9,1
DA:10,2
DA:13,1
DA:15,1
LF:6
LH:6
end_of_record
";
        assert_eq!(lcov(&program, &[hits]), expected);
        let outcomes = program.outcomes().len();
        assert_eq!(outcomes, 8);
        assert_eq!(Hits::of_counts(&program, "s", &[0; 3]), None);
        let nothing = Hits::of_counts(&program, "s", &vec![0; outcomes]).expect("a count for each");
        let text = lcov(&program, &[nothing]);
        assert!(text.contains("BRDA:10,0,1,-") && text.contains("FNH:0") && text.contains("LH:0"), "{text}");
    }
}
