//! The reference interpreter: one point at a time, by the book.

use super::walk::{Taken, Walk};
use crate::program::{Comparison, CondId, Domain, ExprId, InputId, InputSet, LevelSet, Node, Program, Real, Value};

/// The result at one point.
#[derive(Debug, Clone, PartialEq)]
pub struct Outcome<T> {
    /// The row taken, as an index into [`Program::rows`]; `None` for the default.
    pub row: Option<usize>,
    /// The line of that row that applied; `None` where the default gave the value.
    pub line: Option<usize>,
    /// The result, one number per component of the output; of words, what carries them
    /// ([`Output::numbers`](crate::program::Output::numbers) gives the numbers).
    pub values: Vec<T>,
    /// The inputs that were fetched, each once.
    pub fetched: InputSet,
}

/// A fetched input was needed that the caller did not provide.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct NeedsFetch(pub InputId);

/// Evaluates a program at single points.
///
/// A point has one value per input, in the order of [`Program::inputs`];
/// fetched inputs may be absent and are looked at only when needed.
#[derive(Debug)]
pub struct Interpreter<'p, T> {
    program: &'p Program,
    levels: Vec<u8>,
    numbers: Vec<T>,
    fetched: InputSet,
    point: Vec<Option<Value>>,
    /// The result that the result map of a symmetry is about, while one is computed.
    mapped: Vec<T>,
    /// The results of operations at this point, so that what is shared is computed
    /// once; none for programs that are small when written out.
    known: Vec<Option<T>>,
}

/// Programs whose expressions are no larger than this, written out, are evaluated without remembering results.
const SMALL: u32 = 2_000;

impl<'p, T: Real> Interpreter<'p, T> {
    /// An interpreter of `program`.
    pub fn new(program: &'p Program) -> Self {
        let count = program.inputs.len();
        Self {
            program,
            levels: vec![0; count],
            numbers: vec![T::from_f64(0.0); count],
            fetched: InputSet::default(),
            point: Vec::with_capacity(count),
            mapped: Vec::new(),
            known: match program.pool.largest() > SMALL {
                true => vec![None; program.pool.len()],
                false => Vec::new(),
            },
        }
    }

    /// Puts the interpreter at a point, with nothing fetched yet.
    ///
    /// # Errors
    /// With the first input that is neither given nor fetched.
    pub fn place(&mut self, point: &[Option<Value>]) -> Result<(), NeedsFetch> {
        self.point.clear();
        self.point.extend_from_slice(point);
        self.fetched = InputSet::default();
        self.known.fill(None);
        for (id, input) in self.program.input_ids() {
            if input.fetched.is_none() {
                self.load(id)?;
            }
        }
        Ok(())
    }

    /// Evaluates the program at a point.
    ///
    /// # Errors
    /// With the first input that is needed but absent.
    ///
    /// ```
    /// use umbrage::eval::Interpreter;
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/smsr.ron")?;
    /// let example = &program.examples[0];
    /// let outcome = Interpreter::<f32>::new(&program).evaluate(&example.inputs).unwrap();
    /// assert_eq!(outcome.row, Some(example.row));
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn evaluate(&mut self, point: &[Option<Value>]) -> Result<Outcome<T>, NeedsFetch> {
        self.place(point)?;
        let Taken { row, line, values } = self.taken()?;
        let values = values.iter().map(|value| self.number(*value)).collect::<Result<_, _>>()?;
        Ok(Outcome { row, line, values, fetched: self.fetched })
    }

    fn load(&mut self, input: InputId) -> Result<(), NeedsFetch> {
        match self.point.get(input.index()).copied().flatten() {
            Some(Value::Level(level)) => self.levels[input.index()] = level,
            Some(Value::Number(number)) => {
                self.numbers[input.index()] = match self.program.inputs[input.index()].domain {
                    Domain::Word => T::from_word(number as u32),
                    Domain::Continuous { .. } | Domain::Discrete(_) => T::from_f64(number),
                }
            }
            None => return Err(NeedsFetch(input)),
        }
        Ok(())
    }

    /// Makes sure a fetched input is there, fetching it at most once.
    fn need(&mut self, input: InputId) -> Result<(), NeedsFetch> {
        if self.program.fetched.contains(input) && !self.fetched.contains(input) {
            self.load(input)?;
            self.fetched = self.fetched.or(InputSet::one(input));
        }
        Ok(())
    }

    /// Returns whether a condition holds at the current point.
    ///
    /// # Errors
    /// With the first input that is needed but absent.
    pub fn holds(&mut self, condition: CondId) -> Result<bool, NeedsFetch> {
        self.decide(condition)
    }

    /// A result as the result map of a symmetry has it; the map mentions nothing else.
    pub fn mapped(&mut self, map: &[ExprId], result: &[T]) -> Vec<T> {
        self.known.fill(None);
        self.mapped = result.to_vec();
        let none = T::from_f64(f64::NAN);
        let mapped = map.iter().map(|component| self.number(*component).unwrap_or(none)).collect();
        self.mapped.clear();
        self.known.fill(None);
        mapped
    }

    /// The value of an expression at the current point.
    ///
    /// # Errors
    /// With the first input that is needed but absent.
    pub fn number(&mut self, expr: ExprId) -> Result<T, NeedsFetch> {
        if let Some(Some(known)) = self.known.get(expr.index()) {
            return Ok(*known);
        }
        let value = match self.program.pool.node(expr) {
            Node::Const(number) => T::from_f64(number.get()),
            Node::Word(word) => T::from_word(word),
            Node::Input(input) => {
                self.need(input)?;
                self.numbers[input.index()]
            }
            Node::Index(input) => {
                self.need(input)?;
                T::from_f64(f64::from(self.levels[input.index()]))
            }
            // Occurs in the result map of a symmetry only, which is about no point.
            Node::Result(component) => {
                self.mapped.get(usize::from(component)).copied().unwrap_or_else(|| T::from_f64(f64::NAN))
            }
            Node::Unary(op, a) => T::unary(op, self.number(a)?),
            Node::Binary(op, a, b) => T::binary(op, self.number(a)?, self.number(b)?),
            Node::Ternary(op, a, b, c) => T::ternary(op, self.number(a)?, self.number(b)?, self.number(c)?),
            Node::Select(condition, then, other) => match self.decide(condition)? {
                true => self.number(then)?,
                false => self.number(other)?,
            },
        };
        if let Some(place) = self.known.get_mut(expr.index()) {
            *place = Some(value);
        }
        Ok(value)
    }
}

impl<'p, T: Real> Walk<'p> for Interpreter<'p, T> {
    type Stop = NeedsFetch;

    fn program(&self) -> &'p Program {
        self.program
    }

    fn has_level(&mut self, input: InputId, levels: LevelSet) -> Result<bool, NeedsFetch> {
        self.need(input)?;
        Ok(levels.contains(self.levels[input.index()]))
    }

    fn compare(&mut self, _: CondId, op: Comparison, a: ExprId, b: ExprId) -> Result<bool, NeedsFetch> {
        let words = self.program.pool.is_word(a);
        let (a, b) = (self.number(a)?, self.number(b)?);
        Ok(op.holds_of(words, a, b))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    fn program(text: &str) -> Program {
        Table::parse(Source::new("test.ron", text))
            .and_then(|table| Program::check(&table))
            .unwrap_or_else(|e| panic!("{e}"))
    }

    #[test]
    fn fetched_inputs_are_fetched_when_needed_and_once() {
        let program = program(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {
                    "s": Bool(),
                    "f": Levels(values: {"lo": 0, "hi": 1}, fetched: (cost: 1)),
                    "g": Range(from: 0, to: 1, fetched: (cost: 1)),
                },
                output: Number(),
                cases: [
                    Case(id: 1, when: "s", value: "0.5"),
                    Case(id: 2, when: "f == hi && g > 0.5", value: "g * 2"),
                    Case(id: 3, when: "f == hi", value: "g"),
                ],
                default: 0)"#,
        );
        let mut interpreter = Interpreter::<f32>::new(&program);
        let run = |i: &mut Interpreter<'_, f32>, point: [Option<Value>; 3]| i.evaluate(&point);
        let bool_ = |b: bool| Some(Value::Level(u8::from(b)));

        let first = run(&mut interpreter, [bool_(true), None, None]).expect("nothing fetched");
        assert_eq!((first.row, first.fetched.iter().count()), (Some(0), 0));
        assert_eq!(run(&mut interpreter, [bool_(false), None, None]), Err(NeedsFetch(InputId::new(1))));
        let none = run(&mut interpreter, [bool_(false), Some(Value::Level(0)), None]).expect("`g` is not needed");
        assert_eq!((none.row, none.fetched.iter().count()), (None, 1));
        let third = run(&mut interpreter, [bool_(false), Some(Value::Level(1)), Some(Value::Number(0.25))]);
        let third = third.expect("all given");
        assert_eq!((third.row, third.values[0], third.fetched.iter().count()), (Some(2), 0.25, 2));
    }
}
