//! The batch interpreter: many points at once, equal to the reference bit for bit.
//!
//! Each discrete state that occurs is specialised once (see `residual`); most
//! states share their tree with others. A run takes the points in chunks, finds
//! the state and so the tree of each row, sorts the rows by tree, and takes
//! each group through its tree: tests split the group, leaves run as
//! straight-line code over columns (see `code`) and scatter their results.

use std::collections::HashMap;
use std::ops::{Add, Mul};

use super::code::{Argument, BLOCK, Code, Registers};
use super::columns::{Columns, Path, Results};
use super::residual::{Paths, Residual, Tree, TreeId};
use super::{Interpreter, NeedsFetch};
use crate::program::{InputId, InputSet, Program, Real};

/// Rows per chunk. Large enough that the rows of a tree fill a few vectors, small enough for the cache.
const CHUNK: usize = 8192;

/// A fetched input was needed that is absent.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Missing {
    /// The first row that fails.
    pub row: usize,
    /// The first input that it lacks.
    pub input: InputId,
}

/// Evaluates a program at many points.
#[derive(Debug)]
pub struct Batch<'p, T> {
    program: &'p Program,
    residual: Residual<'p, T>,
    /// Number of the tree of each state, as an index into `roots`.
    arms: Vec<u32>,
    roots: Vec<TreeId>,
    root_index: HashMap<TreeId, u32>,
    machine: Machine<'p, T>,
    sorter: Sorter,
}

const UNSEEN: u32 = u32::MAX;

impl<'p, T: Real> Batch<'p, T> {
    /// A batch interpreter of `program`. States are specialised when they first occur.
    pub fn new(program: &'p Program) -> Self {
        Self {
            program,
            residual: Residual::new(program),
            arms: vec![UNSEEN; program.states.count()],
            roots: Vec::new(),
            root_index: HashMap::new(),
            machine: Machine::new(program),
            sorter: Sorter::default(),
        }
    }

    /// Specialises every state now.
    pub fn prepare(&mut self) {
        for state in 0..self.arms.len() {
            self.arm(state);
        }
    }

    /// The number of different trees of the states seen so far.
    pub fn arms(&self) -> usize {
        self.roots.len()
    }

    /// Evaluates the program at all points.
    ///
    /// # Errors
    /// With the first point that needs an absent input, and the first one it needs.
    ///
    /// # Panics
    /// If the columns were made for a program with other inputs.
    ///
    /// ```
    /// use umbrage::eval::{Batch, Columns};
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// let points = program.examples.iter().map(|example| &example.inputs);
    /// let columns = Columns::<f32>::from_rows(&program, points).unwrap();
    /// let results = Batch::new(&program).evaluate(&columns).unwrap();
    /// assert_eq!(results.row(0), Some(program.examples[0].row));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn evaluate(&mut self, columns: &Columns<T>) -> Result<Results<T>, Missing> {
        let mut results = Results::default();
        self.evaluate_into(columns, &mut results)?;
        Ok(results)
    }

    /// Evaluates the program at all points and reuses the memory of earlier results.
    ///
    /// # Errors
    /// As [`Self::evaluate`]; the results are then unspecified.
    ///
    /// # Panics
    /// As [`Self::evaluate`].
    pub fn evaluate_into(&mut self, columns: &Columns<T>, results: &mut Results<T>) -> Result<(), Missing> {
        assert!(columns.fit(self.program), "columns of another program");
        let components = self.program.output.components().len();
        results.values.resize_with(components, Vec::new);
        results.values.iter_mut().for_each(|column| column.resize(columns.len(), T::from_f64(0.0)));
        results.path.resize(columns.len(), 0);
        for start in (0..columns.len()).step_by(CHUNK) {
            self.chunk(columns, start, CHUNK.min(columns.len() - start), results)?;
        }
        results.paths.clone_from(self.residual.paths());
        Ok(())
    }

    fn chunk(
        &mut self,
        columns: &Columns<T>,
        start: usize,
        len: usize,
        results: &mut Results<T>,
    ) -> Result<(), Missing> {
        let mut sorter = std::mem::take(&mut self.sorter);
        sorter.tickets.resize(len, 0);
        // Sixteen bits do for most programs, and twice as many fit a vector.
        if self.arms.len() <= 1 << 16 {
            self.states(columns, start, &mut sorter.narrow, len);
            for (ticket, state) in sorter.tickets.iter_mut().zip(&sorter.narrow) {
                *ticket = self.arms[usize::from(*state)];
            }
        } else {
            self.states(columns, start, &mut sorter.wide, len);
            for (ticket, state) in sorter.tickets.iter_mut().zip(&sorter.wide) {
                *ticket = self.arms[*state as usize];
            }
        }
        if sorter.tickets.iter().fold(false, |any, ticket| any | (*ticket == UNSEEN)) {
            for row in 0..len {
                if sorter.tickets[row] == UNSEEN {
                    let state = self.program.states.index(|input| columns.levels(input)[start + row]);
                    sorter.tickets[row] = self.arm(state);
                }
            }
        }
        sorter.sort(self.roots.len());
        let place = Place { columns, start };
        let (trees, paths) = self.residual.parts();
        let mut from = 0;
        for (arm, to) in &sorter.groups {
            let rows = &mut sorter.order[from..*to];
            from = *to;
            self.machine.run(trees, self.roots[*arm], place, rows, paths, results);
        }
        self.sorter = sorter;
        self.machine.missing.take().map_or(Ok(()), Err)
    }

    /// Computes [`StateSpace::index`](crate::program::StateSpace::index) for a chunk, one input after the other.
    fn states<S>(&self, columns: &Columns<T>, start: usize, states: &mut Vec<S>, len: usize)
    where
        S: Copy + From<u8> + Mul<Output = S> + Add<Output = S>,
    {
        states.clear();
        states.resize(len, S::from(0));
        for (input, count) in self.program.states.digits() {
            // At most `MAX_LEVELS`.
            let count = S::from(*count as u8);
            for (state, level) in states.iter_mut().zip(&columns.levels(*input)[start..start + len]) {
                *state = *state * count + S::from(*level);
            }
        }
    }

    /// The number of the tree of a state, which is specialised if it was not yet.
    fn arm(&mut self, state: usize) -> u32 {
        if self.arms[state] == UNSEEN {
            let mut levels = vec![0; self.program.inputs.len()];
            self.program.states.write(state, &mut levels);
            let root = self.residual.specialise(&levels);
            self.machine.compile(&self.residual);
            self.arms[state] = *self.root_index.entry(root).or_insert_with(|| {
                self.roots.push(root);
                self.roots.len() as u32 - 1
            });
        }
        self.arms[state]
    }
}

/// Groups the rows of a chunk by tree.
#[derive(Debug, Default)]
struct Sorter {
    narrow: Vec<u16>,
    wide: Vec<u32>,
    /// The tree of each row.
    tickets: Vec<u32>,
    /// Per tree: first the number of its rows, then where the next one goes.
    offsets: Vec<u32>,
    /// The trees that occur, each with the end of its rows in `order`.
    groups: Vec<(usize, usize)>,
    order: Vec<u16>,
}

impl Sorter {
    fn sort(&mut self, arms: usize) {
        self.offsets.resize(arms, 0);
        self.groups.clear();
        for ticket in &self.tickets {
            let arm = *ticket as usize;
            if self.offsets[arm] == 0 {
                self.groups.push((arm, 0));
            }
            self.offsets[arm] += 1;
        }
        let mut end = 0;
        for (arm, group_end) in &mut self.groups {
            let start = end;
            end += self.offsets[*arm] as usize;
            *group_end = end;
            self.offsets[*arm] = start as u32;
        }
        self.order.resize(self.tickets.len(), 0);
        if self.groups.len() == 1 {
            self.order.iter_mut().zip(0..).for_each(|(row, number)| *row = number);
        } else {
            for (row, ticket) in self.tickets.iter().enumerate() {
                let next = &mut self.offsets[*ticket as usize];
                self.order[*next as usize] = row as u16;
                *next += 1;
            }
        }
        for (arm, _) in &self.groups {
            self.offsets[*arm] = 0;
        }
    }
}

/// A chunk of the columns.
#[derive(Debug, Clone, Copy)]
struct Place<'a, T> {
    columns: &'a Columns<T>,
    start: usize,
}

/// Takes groups of rows through trees.
#[derive(Debug)]
struct Machine<'p, T> {
    /// Per tree, the code of its comparison or leaf.
    code: Vec<Option<Code<T>>>,
    registers: Registers<T>,
    /// The rows of a group for which a test fails.
    rest: Vec<u16>,
    scalar: Interpreter<'p, T>,
    /// The first failure in the chunk.
    missing: Option<Missing>,
}

impl<'p, T: Real> Machine<'p, T> {
    fn new(program: &'p Program) -> Self {
        Self {
            code: Vec::new(),
            registers: Registers::new(),
            rest: vec![0; CHUNK],
            scalar: Interpreter::new(program),
            missing: None,
        }
    }

    /// Makes code for the trees that are new.
    fn compile(&mut self, residual: &Residual<'p, T>) {
        for tree in &residual.trees()[self.code.len()..] {
            self.code.push(match tree {
                Tree::Compare(_, a, b, _) => Some(Code::new(residual.terms(), &[*a, *b])),
                Tree::Leaf(_, terms) => Some(Code::new(residual.terms(), terms)),
                Tree::Need(..) | Tree::Level(..) | Tree::Scalar => None,
            });
        }
    }

    fn run(
        &mut self,
        trees: &[Tree],
        tree: TreeId,
        place: Place<'_, T>,
        rows: &mut [u16],
        paths: &mut Paths,
        results: &mut Results<T>,
    ) {
        if rows.is_empty() {
            return;
        }
        match &trees[tree.index()] {
            Tree::Need(input, next) => {
                let there = match place.columns.gaps().and(InputSet::one(*input)).is_empty() {
                    true => rows.len(),
                    false => self.keep_present(*input, place, rows),
                };
                self.run(trees, *next, place, &mut rows[..there], paths, results);
            }
            Tree::Level(input, set, [yes, no]) => {
                let levels = &place.columns.levels(*input)[place.start..];
                let mut split = Split::default();
                // Present levels are below 64; what absent ones do here does not matter, they are gone.
                split.add(rows, 0..rows.len(), &mut self.rest, |row, _| set.0 >> (levels[usize::from(row)] & 63) & 1);
                let (first, second) = split.finish(rows, &self.rest);
                self.run(trees, *yes, place, first, paths, results);
                self.run(trees, *no, place, second, paths, results);
            }
            Tree::Compare(test, _, _, [yes, no]) => {
                if let Some(code) = &self.code[tree.index()] {
                    let mut split = Split::default();
                    for from in (0..rows.len()).step_by(BLOCK) {
                        let to = rows.len().min(from + BLOCK);
                        code.run(place.columns, place.start, &rows[from..to], &mut self.registers);
                        let [a, b] = [0, 1].map(|i| self.registers.argument(code.outputs[i], to - from));
                        split.add(rows, from..to, &mut self.rest, |_, k| u64::from(test.holds(a.at(k), b.at(k))));
                    }
                    let (first, second) = split.finish(rows, &self.rest);
                    self.run(trees, *yes, place, first, paths, results);
                    self.run(trees, *no, place, second, paths, results);
                }
            }
            Tree::Leaf(path, _) => {
                if let Some(code) = &self.code[tree.index()] {
                    for block in rows.chunks(BLOCK) {
                        code.run(place.columns, place.start, block, &mut self.registers);
                        let numbers = &mut results.path[place.start..];
                        block.iter().for_each(|row| numbers[usize::from(*row)] = *path);
                        for (column, output) in results.values.iter_mut().zip(&code.outputs) {
                            let column = &mut column[place.start..];
                            match self.registers.argument(*output, block.len()) {
                                Argument::Each(values) => {
                                    block.iter().zip(values).for_each(|(row, v)| column[usize::from(*row)] = *v);
                                }
                                Argument::Same(value) => {
                                    block.iter().for_each(|row| column[usize::from(*row)] = value);
                                }
                            }
                        }
                    }
                }
            }
            Tree::Scalar => self.run_scalar(place, rows, paths, results),
        }
    }

    /// Moves the rows that have the input to the front and counts them; the others fail.
    fn keep_present(&mut self, input: InputId, place: Place<'_, T>, rows: &mut [u16]) -> usize {
        let mut there = 0;
        for k in 0..rows.len() {
            let row = place.start + usize::from(rows[k]);
            if place.columns.is_present(row, input) {
                rows[there] = rows[k];
                there += 1;
            } else {
                self.fail(Missing { row, input });
            }
        }
        there
    }

    fn fail(&mut self, missing: Missing) {
        if self.missing.is_none_or(|first| missing.row < first.row) {
            self.missing = Some(missing);
        }
    }

    fn run_scalar(&mut self, place: Place<'_, T>, rows: &[u16], paths: &mut Paths, results: &mut Results<T>) {
        for row in rows {
            let row = place.start + usize::from(*row);
            match self.scalar.evaluate(&place.columns.point(row)) {
                Ok(outcome) => {
                    let path = Path { row: outcome.row, line: outcome.line, fetched: outcome.fetched };
                    results.path[row] = paths.number(path);
                    for (column, value) in results.values.iter_mut().zip(outcome.values) {
                        column[row] = value;
                    }
                }
                Err(NeedsFetch(input)) => self.fail(Missing { row, input }),
            }
        }
    }
}

/// Splits rows by a test, without branching on its outcome; both parts keep their order.
#[derive(Debug, Default)]
struct Split {
    yes: usize,
    no: usize,
}

impl Split {
    /// Tests `rows[range]`, which follows the rows tested before, with `test(row, place in the range)`.
    #[inline(always)]
    fn add(
        &mut self,
        rows: &mut [u16],
        range: std::ops::Range<usize>,
        rest: &mut [u16],
        test: impl Fn(u16, usize) -> u64,
    ) {
        let start = range.start;
        for at in range {
            let row = rows[at];
            let holds = test(row, at - start) as usize;
            // Never overtakes `at`.
            rows[self.yes] = row;
            rest[self.no] = row;
            self.yes += holds;
            self.no += 1 - holds;
        }
    }

    fn finish<'r>(self, rows: &'r mut [u16], rest: &[u16]) -> (&'r mut [u16], &'r mut [u16]) {
        let (yes, no) = rows.split_at_mut(self.yes);
        no.copy_from_slice(&rest[..self.no]);
        (yes, no)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Outcome;
    use super::*;
    use crate::diag::Source;
    use crate::program::Value;
    use crate::table::Table;

    fn program(text: &str) -> Program {
        Table::parse(Source::new("test.ron", text))
            .and_then(|table| Program::check(&table))
            .unwrap_or_else(|e| panic!("{e}"))
    }

    const LAZY: &str = r#"Table(language: 1, name: "t", hit_policy: First,
        inputs: {
            "s": Bool(),
            "f": Levels(values: {"lo": 0, "mid": 1, "hi": 2}, fetched: (cost: 1)),
            "g": Range(from: 0, to: 1, fetched: (cost: 1)),
            "x": Range(from: 0, to: 1),
        },
        output: Number(),
        cases: [
            Case(id: 1, when: "s && x < 0.25", value: "0.5"),
            Case(id: 2, when: "f == hi && g > x", value: "g * 2"),
            Case(id: 3, when: "f == hi || x > 0.9", lines: [("g", "x > 0.5 && g < 0.5"), ("x", "f == lo")]),
        ],
        default: "if x < 0.75 && f == mid { g } else { 0.1 + 0.2 }")"#;

    #[test]
    fn laziness_errors_and_paths_are_those_of_the_reference() {
        let program = program(LAZY);
        let mut scalar = Interpreter::<f32>::new(&program);
        let mut batch = Batch::<f32>::new(&program);
        let numbers = [0.0, 0.1, 0.25, 0.5, 0.75, 0.95, 1.0];
        let mut good = Vec::new();
        for s in 0..2 {
            for f in [None, Some(0), Some(1), Some(2)] {
                for g in std::iter::once(None).chain(numbers.map(Some)) {
                    for x in numbers {
                        let point =
                            [Some(Value::Level(s)), f.map(Value::Level), g.map(Value::Number), Some(Value::Number(x))];
                        let columns = Columns::from_rows(&program, [point]).expect("fits");
                        assert_eq!(columns.point(0).len(), 4);
                        let one = batch.evaluate(&columns).map(|results| results.outcome(0));
                        let reference: Result<Outcome<f32>, NeedsFetch> = scalar.evaluate(&point);
                        assert_eq!(one, reference.clone().map_err(|NeedsFetch(input)| Missing { row: 0, input }));
                        if let Ok(outcome) = reference {
                            good.push((point, outcome));
                        }
                    }
                }
            }
        }
        let columns = Columns::from_rows(&program, good.iter().map(|(point, _)| point)).expect("fits");
        let results = batch.evaluate(&columns).expect("nothing is missing that is needed");
        for (row, (_, outcome)) in good.iter().enumerate() {
            assert_eq!(&results.outcome(row), outcome);
        }
        assert_eq!(results.histogram().iter().map(|(_, count)| count).sum::<usize>(), good.len());
    }

    #[test]
    fn the_first_failing_row_is_reported() {
        let program = program(LAZY);
        let ok = [Some(Value::Level(1)), None, None, Some(Value::Number(0.0))];
        let no_f = [Some(Value::Level(0)), None, None, Some(Value::Number(0.0))];
        let no_g = [Some(Value::Level(1)), Some(Value::Level(2)), None, Some(Value::Number(0.5))];
        let columns = Columns::<f64>::from_rows(&program, [ok, ok, no_g, ok, no_f]).expect("fits");
        let missing = Batch::new(&program).evaluate(&columns).map(|_| ());
        assert_eq!(missing, Err(Missing { row: 2, input: InputId::new(2) }));
    }

    #[test]
    fn trees_that_grow_too_large_are_left_to_the_reference() {
        // Selections by what is fetched are branches, since a side that is not taken must not fetch.
        let inputs: String = (0..13)
            .map(|k| format!("\"f{k}\": Levels(values: {{\"a\": 0, \"b\": 1}}, fetched: (cost: 1)), "))
            .collect();
        let terms: Vec<String> = (0..13).map(|k| format!("(if f{k} == a {{ {}.1 }} else {{ x }})", 1 << k)).collect();
        let program = program(&format!(
            r#"Table(language: 1, name: "t", hit_policy: First, inputs: {{ "x": Range(from: 0, to: 1), {inputs} }},
                output: Number(), cases: [Case(id: 1, when: "x > 0.1", value: "{}")], default: 0)"#,
            terms.join(" + ")
        ));
        let point = |bits: u32| {
            let x = Value::Number(f64::from(bits % 8) / 8.0);
            let levels = (0..13).map(move |k| Value::Level((bits >> k & 1) as u8));
            std::iter::once(x).chain(levels).map(Some)
        };
        let points: Vec<Vec<_>> = (0..64).map(|k| point(k * 127).collect()).collect();
        let columns = Columns::from_rows(&program, &points).expect("fits");
        let mut batch = Batch::<f32>::new(&program);
        let results = batch.evaluate(&columns).expect("everything is given");
        assert!(matches!(batch.residual.trees()[batch.roots[0].index()], Tree::Scalar));
        let mut scalar = Interpreter::<f32>::new(&program);
        for (row, point) in points.iter().enumerate() {
            assert_eq!(scalar.evaluate(point), Ok(results.outcome(row)));
        }
    }
}
