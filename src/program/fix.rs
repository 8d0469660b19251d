//! A table decided in part: the program with some inputs decided, for each of which a shader of its
//! own is wanted.
//!
//! It is a program like any other, with its own name, and is checked, proved and emitted as such. What
//! is decided is no input of it any more; what depended on nothing else is gone. Inputs that nothing
//! depends on then are kept, so that what is generated is called as before, without the decided ones.

use std::collections::HashMap;
use std::sync::Arc;

use super::bits::{InputSet, LevelSet};
use super::domain::{Domain, Input, StateSpace, Value};
use super::draw::Draw;
use super::pool::{CondId, ExprId, Pool};
use super::substitute::{Meanings, Substitution};
use super::{
    Assumption, Continuity, ContinuityKind, Example, InputId, LevelTerm, Line, Program, Row, Symmetry, Written,
};
use crate::diag::{Diagnostic, Failure, Source, Span, codes};
use crate::text::closest::nearest;

/// Most characters of the name of what is made.
const MAX_NAME: usize = 128;

/// The inputs of a program with some decided.
struct Decided<'p> {
    pool: Pool,
    from: &'p Program,
    /// The values of those that are decided.
    values: Vec<Option<Value>>,
    /// The new numbers of the others.
    kept: Vec<Option<InputId>>,
}

impl Meanings for Decided<'_> {
    fn pool(&mut self) -> &mut Pool {
        &mut self.pool
    }

    fn number(&mut self, input: InputId) -> ExprId {
        match (self.values[input.index()], self.kept[input.index()]) {
            (Some(Value::Number(word)), _) if self.from.inputs[input.index()].domain == Domain::Word => {
                self.pool.constant_word(word as u32)
            }
            (Some(Value::Number(number)), _) => self.pool.number(number),
            (_, Some(kept)) => self.pool.input(kept),
            (Some(Value::Level(_)) | None, None) => unreachable!("a continuous input is a number"),
        }
    }

    fn index(&mut self, input: InputId) -> ExprId {
        match (self.values[input.index()], self.kept[input.index()]) {
            (Some(Value::Level(level)), _) => self.pool.number(f64::from(level)),
            (_, Some(kept)) => self.pool.index(kept),
            (Some(Value::Number(_)) | None, None) => unreachable!("a discrete input has a level"),
        }
    }

    fn level(&mut self, input: InputId, levels: LevelSet) -> CondId {
        let count = self.from.levels(input).map_or(2, super::Levels::count);
        match (self.values[input.index()], self.kept[input.index()]) {
            (Some(Value::Level(level)), _) => self.pool.always(levels.contains(level)),
            (_, Some(kept)) => self.pool.level(kept, levels, count),
            (Some(Value::Number(_)) | None, None) => unreachable!("a discrete input has a level"),
        }
    }
}

impl Program {
    /// The program with some inputs decided, each as `input=level` or `input=number`. Its name is that of
    /// this one and of what is decided: `rsmss_b_entering`. Of numbers, a point is written `p`, a minus `m`.
    ///
    /// # Errors
    /// When an input is unknown or decided twice, when it has no such level or number, when this is a
    /// function, and when an assumption excludes what is decided.
    ///
    /// ```
    /// use umbrage::program::Program;
    ///
    /// let program = Program::read("tables/rsmss.ron")?.fix(&["b=entering"])?;
    /// assert_eq!((program.name.as_str(), program.input("b")), ("rsmss_b_entering", None));
    /// assert!(Program::read("tables/rsmss.ron")?.fix(&["b=entered"]).is_err());
    /// # Ok::<(), umbrage::diag::Failure>(())
    /// ```
    pub fn fix(&self, decided: &[impl AsRef<str>]) -> Result<Self, Failure> {
        if decided.is_empty() {
            return Ok(self.clone());
        }
        let words: Vec<&str> = decided.iter().map(AsRef::as_ref).collect();
        let source = Source::new("--fix", words.join(","));
        let fail = |diagnostic| Failure::new(source.clone(), diagnostic);
        if self.function.is_some() {
            let error = Diagnostic::error(codes::NOT_APPLICABLE, format!("`{}` is a function", self.name));
            return Err(fail(
                error
                    .at(Span::new(0, source.text.len()), "only a table of cases has inputs to decide")
                    .help("a function is called with what is decided: write another one that does so"),
            ));
        }
        let mut values: Vec<Option<Value>> = vec![None; self.inputs.len()];
        let mut start = 0;
        for word in words {
            let span = Span::new(start, start + word.len());
            start += word.len() + 1;
            let (input, value) = self.decision(word, span).map_err(fail)?;
            if values[input.index()].replace(value).is_some() {
                let message = format!("`{}` is decided twice", self.inputs[input.index()].name);
                return Err(fail(Diagnostic::error(codes::DUPLICATE, message).at(span, "again")));
            }
        }
        self.with(&values).map_err(fail)
    }

    /// `input=level`
    fn decision(&self, word: &str, span: Span) -> Result<(InputId, Value), Diagnostic> {
        let Some((name, value)) = word.split_once('=') else {
            return Err(Diagnostic::error(codes::EXPRESSION, format!("`{word}` decides nothing"))
                .at(span, "expected an input and its level, as in b=entering"));
        };
        let (name, value) = (name.trim(), value.trim());
        let Some(input) = self.input(name) else {
            let known = || self.inputs.iter().map(|input| input.name.as_str());
            let error = Diagnostic::error(codes::UNKNOWN_NAME, format!("`{}` has no input `{name}`", self.name));
            let error = error.at(span, "unknown input");
            return Err(match nearest(name, known()) {
                Some(close) => error.did_you_mean(name, close),
                None => error.help(format!("the inputs are: {}", known().collect::<Vec<_>>().join(", "))),
            });
        };
        match self.inputs[input.index()].parse(value) {
            Ok(value) => Ok((input, value)),
            Err(message) => Err(Diagnostic::error(codes::BAD_VALUE, message).at(span, "cannot be decided so")),
        }
    }

    /// The program with the inputs that have values decided.
    fn with(&self, values: &[Option<Value>]) -> Result<Self, Diagnostic> {
        let mut inputs: Vec<Input> = Vec::new();
        let mut kept = vec![None; self.inputs.len()];
        let mut pool = Pool::of_results(&self.pool);
        let (mut name, mut said) = (self.name.clone(), Vec::new());
        for (id, input) in self.input_ids() {
            match values[id.index()] {
                Some(value) => {
                    let shown = input.show(value);
                    name = format!("{name}_{}_{}", input.ident, plain(&shown));
                    said.push(format!("{} = {shown}", input.name));
                }
                None => {
                    let new = InputId::new(inputs.len());
                    input.domain.declare(new, &mut pool);
                    kept[id.index()] = Some(new);
                    inputs.push(input.clone());
                }
            }
        }
        if name.len() > MAX_NAME {
            let message = format!("the name of what is made has {} characters", name.len());
            return Err(Diagnostic::error(codes::BAD_NAME, message).help(format!("at most {MAX_NAME}: {name}")));
        }
        let (values, kept) = (values.to_vec(), kept);
        let mut way = Substitution::new(self, Decided { pool, from: self, values: values.clone(), kept: kept.clone() });
        let mut places = HashMap::new();
        let mut rows: Vec<Row> = Vec::new();
        for (index, row) in self.rows.iter().enumerate() {
            let guard = way.cond(row.guard);
            if way.truth(guard) == Some(false) {
                continue;
            }
            places.insert(index, rows.len());
            let line = |line: &Line| {
                let (condition, values) = (way.cond(line.condition), way.exprs(&line.values));
                Line { condition, values, ..line.clone() }
            };
            let lines = row.lines.iter().map(line).collect();
            rows.push(Row { guard, lines, ..row.clone() });
        }
        let default = way.exprs(&self.default);
        let mut assumptions = Vec::new();
        for assumption in &self.assumptions {
            let condition = way.cond(assumption.condition);
            match way.truth(condition) {
                Some(true) => {}
                Some(false) => {
                    let message = format!("the assumption `{}` excludes {}", assumption.name, said.join(", "));
                    let error = Diagnostic::error(codes::DOMAIN, message).help("nothing would be left to decide");
                    return Err(match assumption.doc.is_empty() {
                        true => error,
                        false => error.help(format!("it says: {}", assumption.doc)),
                    });
                }
                None => assumptions.push(Assumption { condition, ..assumption.clone() }),
            }
        }
        let mut symmetries = Vec::new();
        for symmetry in &self.symmetries {
            symmetries.extend(way.symmetry(symmetry, &values, &kept));
        }
        let mut continuity = Vec::new();
        for one in &self.continuity {
            continuity.extend(way.continuity(one, &values, &kept));
        }
        let examples = self.examples.iter().filter_map(|example| {
            let agrees = values
                .iter()
                .zip(&example.inputs)
                .all(|(decided, given)| decided.is_none_or(|decided| given.is_none_or(|given| given == decided)));
            let row = *places.get(&example.row).filter(|_| agrees)?;
            let left = example.inputs.iter().zip(&kept).filter(|(_, kept)| kept.is_some());
            Some(Example { row, inputs: left.map(|(value, _)| *value).collect(), ..example.clone() })
        });
        let examples = examples.collect();
        let draw = self.draw.iter().filter_map(|(input, draw)| {
            let of = |input: InputId| kept[input.index()];
            let draw = match draw {
                Draw::Across | Draw::Down | Draw::Sides { .. } | Draw::Dark(_) => draw.clone(),
                Draw::Run { along, ends } => Draw::Run { along: of(*along)?, ends: ends.clone() },
                Draw::Position(other) => Draw::Position(of(*other)?),
                Draw::Strong(other) => Draw::Strong(of(*other)?),
            };
            Some((of(*input)?, draw))
        });
        let draw = draw.collect();
        let fetched = inputs.iter().enumerate().filter(|(_, input)| input.fetched.is_some());
        let fetched = fetched.fold(InputSet::default(), |all, (index, _)| all.or(InputSet::one(InputId::new(index))));
        let states = StateSpace::new(&inputs).map_err(|product| {
            Diagnostic::error(codes::TOO_MANY_STATES, format!("the discrete inputs have {product} combined states"))
        })?;
        Ok(Self {
            source: self.source.clone(),
            imported: self.imported.clone(),
            name,
            title: match self.title.is_empty() {
                true => said.join(", "),
                false => format!("{}; {}", self.title, said.join(", ")),
            },
            origin: self.origin.clone(),
            hit_policy: self.hit_policy,
            hit_policy_span: self.hit_policy_span,
            inputs,
            fetched,
            states,
            pool: way.into_pool(),
            rows,
            default,
            default_span: self.default_span,
            output: self.output.clone(),
            assumptions,
            draw,
            symmetries,
            examples,
            function: None,
            continuity,
            claims: self.claims.clone(),
            allow: self.allow.clone(),
            exhibit: self.exhibit.clone(),
            written: Written::default(),
            decided: said,
        })
    }
}

/// A level or number as a part of a name.
fn plain(value: &str) -> String {
    let letter = |letter: char| match letter {
        '-' => 'm',
        '.' => 'p',
        other => other,
    };
    value.chars().filter(|letter| *letter != '+').map(letter).collect()
}

impl Substitution<'_, Decided<'_>> {
    fn truth(&mut self, condition: CondId) -> Option<bool> {
        self.to().pool.truth(condition)
    }

    fn into_pool(self) -> Pool {
        self.into_to().pool
    }

    /// A symmetry, if it leaves what is decided as it is.
    fn symmetry(
        &mut self,
        symmetry: &Symmetry,
        values: &[Option<Value>],
        kept: &[Option<InputId>],
    ) -> Option<Symmetry> {
        let (mut levels, mut numbers) = (Vec::new(), Vec::new());
        for (input, image) in &symmetry.levels {
            let image = self.level_term(image, values, kept)?;
            match (kept[input.index()], values[input.index()], &image) {
                (Some(input), ..) => levels.push((input, image)),
                (None, Some(Value::Level(own)), LevelTerm::Const(level)) if own == *level => {}
                (None, ..) => return None,
            }
        }
        for (input, image) in &symmetry.numbers {
            let image = self.expr(*image);
            match (kept[input.index()], values[input.index()]) {
                (Some(input), _) => numbers.push((input, image)),
                (None, Some(Value::Number(own))) if self.to().pool.constant(image) == Some(own) => {}
                (None, _) => return None,
            }
        }
        let result = symmetry.result.as_ref().map(|result| self.exprs(result));
        Some(Symmetry { levels, numbers, result, ..symmetry.clone() })
    }

    /// A level, folded where what is decided decides it.
    fn level_term(
        &mut self,
        term: &LevelTerm,
        values: &[Option<Value>],
        kept: &[Option<InputId>],
    ) -> Option<LevelTerm> {
        Some(match term {
            LevelTerm::Const(level) => LevelTerm::Const(*level),
            LevelTerm::Input(input) => match (kept[input.index()], values[input.index()]) {
                (Some(input), _) => LevelTerm::Input(input),
                (None, Some(Value::Level(level))) => LevelTerm::Const(level),
                (None, Some(Value::Number(_)) | None) => return None,
            },
            LevelTerm::If(condition, then, other) => {
                let condition = self.cond(*condition);
                match self.truth(condition) {
                    Some(true) => self.level_term(then, values, kept)?,
                    Some(false) => self.level_term(other, values, kept)?,
                    None => {
                        let then = self.level_term(then, values, kept)?;
                        let other = self.level_term(other, values, kept)?;
                        LevelTerm::If(condition, Arc::new(then), Arc::new(other))
                    }
                }
            }
            LevelTerm::Map(inner, map) => match self.level_term(inner, values, kept)? {
                LevelTerm::Const(level) => LevelTerm::Const(*map.get(usize::from(level))?),
                inner @ (LevelTerm::Input(_) | LevelTerm::If(..) | LevelTerm::Map(..)) => {
                    LevelTerm::Map(Arc::new(inner), map.clone())
                }
            },
        })
    }

    /// Places without jumps, as far as they are places between inputs that are left.
    fn continuity(
        &mut self,
        continuity: &Continuity,
        values: &[Option<Value>],
        kept: &[Option<InputId>],
    ) -> Option<Continuity> {
        let map = self.symmetry(&continuity.map, values, kept)?;
        let left = |inputs: &[InputId]| inputs.iter().filter_map(|input| kept[input.index()]).collect::<Vec<_>>();
        let kind = match &continuity.kind {
            ContinuityKind::Border(when, free) => {
                let when = self.cond(*when);
                if self.truth(when) == Some(false) {
                    return None;
                }
                ContinuityKind::Border(when, left(free))
            }
            ContinuityKind::Switch(of) => match left(of) {
                of if of.is_empty() => return None,
                of => ContinuityKind::Switch(of),
            },
        };
        Some(Continuity { map, kind })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::eval::Interpreter;
    use crate::program::Real;
    use crate::table::Table;

    fn program(text: &str) -> Program {
        let table = Table::parse(Source::new("t.ron", text));
        table.and_then(|table| Program::check(&table)).unwrap_or_else(|e| panic!("{e}"))
    }

    const TABLE: &str = r#"Table(language: 2, name: "t", title: "A title", hit_policy: First,
        inputs: {"b": Levels(values: {"one": -1.5, "two": 0}), "x": Range(from: 0, to: 1), "n": Int(from: -2, to: 1), "f": Bool(fetched: (cost: 1))},
        symmetries: {
            "turn": Symmetry(map: {"b": {"one": "two", "two": "one"}}, result: "1 - value"),
            "flip": Symmetry(map: {"x": "1 - x"}),
        },
        assume: {"calm": ("n != -2 || b == two", "said so"), "low": "x < 0.75 || b == one"},
        continuity: {"at": Switch(of: ["x"])},
        output: Number(),
        cases: [
            Case(id: 1, when: "b == one && f", value: "x * f32(n)", examples: [({"b": one, "x": 0.5, "n": 1, "f": true}, 0.5)]),
            Case(id: 2, when: "n in {-1, 0} && x < 0.5", lines: [("f32(b)", "f"), "x"], examples: [({"b": two, "x": 0.25, "n": 0, "f": true}, 0)]),
        ],
        default: "if b == two { 7 } else { 8 }")"#;

    fn error(decided: &[&str]) -> String {
        match program(TABLE).fix(decided) {
            Ok(program) => program.name,
            Err(failure) => failure.diagnostics[0].message.clone(),
        }
    }

    /// The values of the program with decided inputs are those of the program at points with these inputs.
    #[test]
    fn what_is_decided_is_as_if_it_were_given() {
        let whole = program(TABLE);
        for (decided, given) in [
            (vec!["b=two"], vec![(0, Value::Level(1))]),
            (vec!["f=true", "x=0.25"], vec![(3, Value::Level(1)), (1, Value::Number(0.25))]),
            (vec!["n=-1", "b=one"], vec![(2, Value::Level(1)), (0, Value::Level(0))]),
        ] {
            let part = whole.fix(&decided).unwrap_or_else(|e| panic!("{e}"));
            let (mut here, mut there) = (Interpreter::<f32>::new(&part), Interpreter::<f32>::new(&whole));
            for case in 0..64_u8 {
                let all = [
                    Value::Level(case & 1),
                    Value::Number(f64::from(case >> 1 & 3) / 4.0),
                    Value::Level(case >> 3 & 3),
                    Value::Level(case >> 5 & 1),
                ];
                if given.iter().any(|(input, value)| all[*input] != *value) {
                    continue;
                }
                let left = (0..4).filter(|input| given.iter().all(|(known, _)| known != input));
                let left: Vec<Option<Value>> = left.map(|input| Some(all[input])).collect();
                let a = here.evaluate(&left).unwrap_or_else(|e| panic!("{e:?}"));
                let b = there.evaluate(&all.map(Some)).unwrap_or_else(|e| panic!("{e:?}"));
                let id = |program: &Program, row: Option<usize>| row.map(|row| program.rows[row].id);
                assert_eq!(
                    (id(&part, a.row), a.values[0].to_f64()),
                    (id(&whole, b.row), b.values[0].to_f64()),
                    "{all:?}"
                );
            }
        }
    }

    #[test]
    fn what_is_left_is_a_program_of_its_own() {
        let whole = program(TABLE);
        let two = whole.fix(&["b=two"]).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((two.name.as_str(), two.title.as_str()), ("t_b_two", "A title; b = two"));
        assert_eq!((two.rows.len(), two.examples.len(), two.states.count()), (1, 1, 4));
        let names = |program: &Program| program.symmetries.iter().map(|s| s.name.clone()).collect::<Vec<_>>();
        assert_eq!((names(&two), two.assumptions.len(), two.continuity.len()), (vec!["flip".to_owned()], 1, 1));
        let at = whole.fix(&["x=0.5", "n=-1"]).unwrap_or_else(|e| panic!("{e}"));
        assert_eq!((at.name.as_str(), at.continuity.len()), ("t_x_0p5_n_m1", 0));
        assert_eq!(names(&at), ["turn", "flip"], "the middle stays where it is");
        assert_ne!(two.fingerprint(), whole.fingerprint());
    }

    #[test]
    fn what_cannot_be_decided_is_refused() {
        assert_eq!(error(&["c=one"]), "`t` has no input `c`");
        assert_eq!(error(&["b=three"]), "`three` is not a level of `b`; the levels are: one (-1.5), two (0)");
        assert_eq!(error(&["x=2"]), "2 is not in the range 0 to 1 of `x`");
        assert_eq!(error(&["b=one", "b=one"]), "`b` is decided twice");
        assert_eq!(error(&["b"]), "`b` decides nothing");
        assert_eq!(error(&["b=one", "n=-2"]), "the assumption `calm` excludes b = one, n = -2");
    }
}
