//! What findings say of points, and of all points: it must hold there.
//!
//! Findings speak of real numbers. A claim about a point holds if it holds in hundreds of bits,
//! or as the interpreters round it; a claim that something never happens is refuted by a point
//! at which it happens over the reals and in `f32` alike.

use umbrage::analyse::Findings;
use umbrage::diag::{Diagnostic, Span, codes};
use umbrage::eval::{Interpreter, Precise};
use umbrage::points::Point;
use umbrage::program::{BinaryOp, Comparison, Cond, CondId, ExprId, Input, Node, Program, TernaryOp};
use umbrage::table::HitPolicy;

use super::Court;
use super::points::{Known, read, words};

/// Looks at everything that was found about a program.
pub(crate) fn judge(court: &mut Court<'_>, program: &Program, findings: &Findings, known: &[Known]) {
    let Some(precise) = Precise::new(program) else { return };
    let mut claims = Claims { court, program, known, precise };
    for finding in findings.open.iter().chain(findings.acknowledged.iter().map(|(finding, _)| finding)) {
        claims.finding(finding);
    }
}

struct Claims<'c, 'd, 'p> {
    court: &'c mut Court<'d>,
    program: &'p Program,
    known: &'c [Known],
    precise: Precise<'p>,
}

impl<'p> Claims<'_, '_, 'p> {
    fn finding(&mut self, finding: &Diagnostic) {
        self.court.count(&format!("findings {}", finding.code), 1);
        match finding.code {
            codes::DEAD_CASE => self.never_taken(finding, false),
            codes::NOT_REACHED => self.never_taken(finding, true),
            codes::NOT_UNIQUE => self.both_hold(finding, "such as at "),
            codes::ORDER_MATTERS => self.both_hold(finding, " hold at "),
            codes::NO_LINE => self.no_line(finding),
            codes::LINES_CROSS => self.lines_cross(finding),
            codes::DEAD_LINE => self.dead_line(finding),
            codes::UNUSED_INPUT => self.unused(finding),
            codes::OUT_OF_RANGE => self.clamped(finding),
            codes::NOT_A_NUMBER => self.no_number(finding),
            codes::SYMMETRY_BROKEN => self.broken(finding),
            codes::JUMP => self.jump(finding),
            codes::UNCOVERED => self.uncovered(finding),
            codes::REMOVABLE | codes::POLE | codes::CANCELS | codes::OVERFLOW | codes::BUDGET_EXCEEDED => {
                self.numbers(finding);
            }
            // About the text, or said without a point.
            _ => {}
        }
    }

    fn false_claim(&mut self, finding: &Diagnostic, why: impl Into<String>) {
        let kind = format!("finding {}: is not true", finding.code);
        let notes = finding.notes.join("\n  ");
        self.court.fault(kind, format!("{}\n  {notes}\n{}", finding.message, why.into()));
    }

    /// The row that a place belongs to.
    fn row(&self, span: Span) -> Option<usize> {
        self.program.rows.iter().position(|row| row.span.start <= span.start && span.end <= row.span.end)
    }

    /// The cases that a message names, in its order: `case 3`, `cases 4 and 7`.
    fn rows_of(&self, message: &str) -> Vec<usize> {
        let from = message.find("case").unwrap_or(message.len());
        message[from..].split(' ').filter_map(|word| self.row_of_id(word)).collect()
    }

    /// The lines that a message names before the case.
    fn lines_of(message: &str) -> Vec<usize> {
        let before = message.split(" of case").next().unwrap_or("");
        before.split(' ').filter_map(|word| word.parse::<usize>().ok()?.checked_sub(1)).collect()
    }

    fn row_of_id(&self, word: &str) -> Option<usize> {
        let id: u32 = word.trim_matches(|c: char| !c.is_ascii_digit()).parse().ok()?;
        self.program.rows.iter().position(|row| row.id == id)
    }

    /// The point that a note names after some words.
    fn place(&mut self, finding: &Diagnostic, before: &str) -> Option<Point> {
        let note = finding.notes.iter().find(|note| note.contains(before))?.clone();
        let text = note.split(before).nth(1)?.lines().next()?.to_owned();
        match read(self.program, &text) {
            Ok(point) => {
                self.court.count("witnesses", 1);
                Some(point)
            }
            Err(why) => {
                let kind = format!("finding {}: names no point", finding.code);
                self.court.fault(kind, format!("{}\n  {note}\n{why}", finding.message));
                None
            }
        }
    }

    /// Whether a condition can hold at a point, in any way of computing; `None` if an input is missing.
    fn holds(&mut self, condition: CondId, point: &Point) -> Option<bool> {
        let mut narrow = Interpreter::<f32>::new(self.program);
        let mut wide = Interpreter::<f64>::new(self.program);
        narrow.place(point).ok()?;
        wide.place(point).ok()?;
        let exact = self.precise.holds_at(point, condition).ok()?
            || narrow.holds(condition).ok()?
            || wide.holds(condition).ok()?;
        Some(exact || self.ways_of(&mut wide, condition)?.0)
    }

    /// Whether a condition can hold, and can fail, if equal numbers need be equal only as far as a point can be written down.
    fn ways_of(&self, wide: &mut Interpreter<'_, f64>, condition: CondId) -> Option<(bool, bool)> {
        let pool = &self.program.pool;
        Some(match pool.cond(condition) {
            Cond::Const(_) | Cond::Level(..) => {
                let holds = wide.holds(condition).ok()?;
                (holds, !holds)
            }
            Cond::Compare(op, a, b) => {
                let (a, b) = (wide.number(*a).ok()?, wide.number(*b).ok()?);
                let holds = op.holds(a, b);
                let near = (a - b).abs() <= 4.0 * f64::EPSILON * a.abs().max(b.abs()).max(1.0);
                (holds || near && *op != Comparison::Less, !holds || near)
            }
            Cond::Not(part) => {
                let (holds, fails) = self.ways_of(wide, *part)?;
                (fails, holds)
            }
            Cond::And(parts) => {
                let parts = parts.iter().map(|part| self.ways_of(wide, *part)).collect::<Option<Vec<_>>>()?;
                (parts.iter().all(|part| part.0), parts.iter().any(|part| part.1))
            }
            Cond::Or(parts) => {
                let parts = parts.iter().map(|part| self.ways_of(wide, *part)).collect::<Option<Vec<_>>>()?;
                (parts.iter().any(|part| part.0), parts.iter().all(|part| part.1))
            }
            Cond::If(condition, then, other) => {
                let [c, t, o] = [*condition, *then, *other].map(|part| self.ways_of(wide, part));
                let (c, t, o) = (c?, t?, o?);
                (c.0 && t.0 || c.1 && o.0, c.0 && t.1 || c.1 && o.1)
            }
        })
    }

    fn never_taken(&mut self, finding: &Diagnostic, assumed: bool) {
        let Some(row) = finding.labels.first().and_then(|label| self.row(label.span)) else {
            return self.false_claim(finding, "it names no case");
        };
        let taken = self
            .known
            .iter()
            .filter(|known| known.assumed || !assumed)
            .find(|known| known.narrow.row == Some(row) && known.real.is_some_and(|(real, _)| real == Some(row)));
        if let Some(known) = taken {
            let why = format!("case {} is taken at {}", self.program.rows[row].id, words(self.program, &known.point));
            self.false_claim(finding, why);
        }
    }

    /// Both of two cases hold at a point, and say different things.
    fn both_hold(&mut self, finding: &Diagnostic, before: &str) {
        let Some(point) = self.place(finding, before) else { return };
        let (mut first, mut second) = (None, None);
        if finding.code == codes::NOT_UNIQUE {
            second = finding.labels.first().and_then(|label| self.row(label.span));
            first = finding.labels.get(1).and_then(|label| self.row(label.span));
        } else if let Some(note) = finding.notes.iter().find(|note| note.contains(before)) {
            let mut ids = note.split(before).next().unwrap_or("").split(' ').filter_map(|word| self.row_of_id(word));
            (first, second) = (ids.next(), ids.next());
        }
        let (Some(first), Some(second)) = (first, second) else {
            return self.false_claim(finding, "it does not name two cases");
        };
        for row in [first, second] {
            let case = self.program.rows[row].id;
            match self.holds(self.program.rows[row].guard, &point) {
                Some(true) => {}
                Some(false) => {
                    return self.false_claim(finding, format!("the guard of case {case} does not hold there"));
                }
                None => return self.false_claim(finding, "the point lacks an input that is needed"),
            }
        }
        let [firsts, seconds] = [first, second].map(|row| self.values_of(row, &point).unwrap_or_default());
        let mut pairs = firsts.iter().flat_map(|a| seconds.iter().map(move |b| (*a, *b)));
        let same = |(a, b): (&[ExprId], &[ExprId])| {
            self.numbers_of(a, &point) == self.numbers_of(b, &point) && self.are_equal(a, b, &point)
        };
        if !firsts.is_empty() && !seconds.is_empty() && pairs.all(same) {
            self.false_claim(finding, format!("both give {:?} there", self.numbers_of(firsts[0], &point)));
        }
    }

    /// The terms that a row can give at a point, taken by itself: of several lines, if `f64` cannot tell which applies.
    fn values_of(&self, row: usize, point: &Point) -> Option<Vec<&'p [ExprId]>> {
        let (program, lines) = (self.program, self.lines_at(row, point)?);
        let of = |line: Option<usize>| line.map_or(&program.default, |line| &program.rows[row].lines[line].values);
        Some(lines.into_iter().map(|line| of(line).as_slice()).collect())
    }

    /// The lines of a row that can apply first at a point; none where no line may.
    fn lines_at(&self, row: usize, point: &Point) -> Option<Vec<Option<usize>>> {
        let mut wide = Interpreter::<f64>::new(self.program);
        wide.place(point).ok()?;
        let mut possible = Vec::new();
        for (number, line) in self.program.rows[row].lines.iter().enumerate() {
            let (applies, fails) = self.ways_of(&mut wide, line.condition)?;
            if applies {
                possible.push(Some(number));
            }
            if !fails {
                return Some(possible);
            }
        }
        possible.push(None);
        Some(possible)
    }

    /// Whether a row can be taken at a point: its guard can hold, and those before it can fail.
    fn can_be_taken(&self, row: usize, point: &Point) -> Option<bool> {
        let mut wide = Interpreter::<f64>::new(self.program);
        wide.place(point).ok()?;
        for other in &self.program.rows[..row] {
            if !self.ways_of(&mut wide, other.guard)?.1 {
                return Some(false);
            }
        }
        Some(self.ways_of(&mut wide, self.program.rows[row].guard)?.0)
    }

    fn numbers_of(&self, values: &[ExprId], point: &Point) -> Option<Vec<f64>> {
        let mut wide = Interpreter::<f64>::new(self.program);
        wide.place(point).ok()?;
        values.iter().map(|value| wide.number(*value).ok()).collect()
    }

    /// Whether terms are equal at a point over the reals: `f64` takes what is nearly equal for equal.
    fn are_equal(&self, a: &[ExprId], b: &[ExprId], point: &Point) -> bool {
        let mut program = self.program.clone();
        let pairs = a.iter().zip(b);
        let same: Vec<CondId> = pairs.map(|(a, b)| program.pool.compare(Comparison::Equal, *a, *b)).collect();
        let Some(mut precise) = Precise::new(&program) else { return true };
        same.iter().all(|same| precise.holds_at(point, *same) == Ok(true))
    }

    fn no_line(&mut self, finding: &Diagnostic) {
        let Some(point) = self.place(finding, "for instance at ") else { return };
        let row = self.rows_of(&finding.message).first().copied();
        let ways = self.ways(&point);
        let nearly = row.is_some_and(|row| {
            let without = self.lines_at(row, &point).is_some_and(|lines| lines.contains(&None));
            without && self.can_be_taken(row, &point) == Some(true)
        });
        if !ways.contains(&(row, None)) && !nearly {
            self.false_claim(finding, format!("there a case and line are taken: {ways:?}"));
        }
    }

    /// The cases and lines that are taken at a point, in all ways of computing.
    fn ways(&mut self, point: &Point) -> Vec<(Option<usize>, Option<usize>)> {
        let narrow = Interpreter::<f32>::new(self.program).evaluate(point).map(|outcome| (outcome.row, outcome.line));
        let wide = Interpreter::<f64>::new(self.program).evaluate(point).map(|outcome| (outcome.row, outcome.line));
        let real = self.precise.way(point);
        narrow.into_iter().chain(wide).chain(real).collect()
    }

    fn lines_cross(&mut self, finding: &Diagnostic) {
        let Some(point) = self.place(finding, "for instance at ") else { return };
        let (Some(row), lines) = (self.rows_of(&finding.message).first().copied(), Self::lines_of(&finding.message))
        else {
            return self.false_claim(finding, "it names no case");
        };
        for line in lines {
            let Some(condition) = self.program.rows[row].lines.get(line).map(|line| line.condition) else {
                return self.false_claim(finding, "it names a line that is not there");
            };
            match self.holds(condition, &point) {
                Some(true) => {}
                Some(false) => return self.false_claim(finding, format!("line {} does not apply there", line + 1)),
                None => return self.false_claim(finding, "the point lacks an input that is needed"),
            }
        }
        let ways = self.ways(&point);
        let counts = match self.program.hit_policy {
            HitPolicy::First | HitPolicy::Unique => {
                ways.iter().any(|(taken, _)| *taken == Some(row)) || self.can_be_taken(row, &point) == Some(true)
            }
            HitPolicy::Collect => self.holds(self.program.rows[row].guard, &point) == Some(true),
        };
        if !counts {
            self.false_claim(finding, format!("the case is not taken there: {ways:?}"));
        }
    }

    fn dead_line(&mut self, finding: &Diagnostic) {
        if !finding.message.starts_with("line ") {
            return;
        }
        let (row, line) =
            (self.rows_of(&finding.message).first().copied(), Self::lines_of(&finding.message).first().copied());
        let counts = self
            .known
            .iter()
            .filter(|known| known.assumed)
            .find(|known| (known.narrow.row, known.narrow.line) == (row, line) && known.real == Some((row, line)));
        if let Some(known) = counts {
            let why = format!("it counts at {}", words(self.program, &known.point));
            self.false_claim(finding, why);
        }
    }

    /// Nothing depends on an input: other values of it change nothing.
    fn unused(&mut self, finding: &Diagnostic) {
        let Some(label) = finding.labels.first() else { return };
        // The calls of a fetch are declared at one place.
        let is_meant =
            |input: &Input| input.span == label.span && finding.message.contains(&format!("`{}`", input.name));
        let Some((id, _)) = self.program.input_ids().find(|(_, input)| is_meant(input)) else { return };
        let mut narrow = Interpreter::<f32>::new(self.program);
        for pair in self.known.windows(2) {
            let mut changed = pair[0].point.clone();
            changed[id.index()] = pair[1].point[id.index()];
            let Ok(outcome) = narrow.evaluate(&changed) else { continue };
            let want = &pair[0].narrow;
            let same = (outcome.row, outcome.line, outcome.fetched) == (want.row, want.line, want.fetched)
                && outcome.values.iter().zip(&want.values).all(|(a, b)| a == b || a.is_nan() && b.is_nan());
            if !same {
                let why = format!("it matters at {}", words(self.program, &pair[0].point));
                return self.false_claim(finding, why);
            }
        }
    }

    fn clamped(&mut self, finding: &Diagnostic) {
        let Some(row) = self.rows_of(&finding.message).first().copied() else { return };
        // The line it is about is known by its place, but not if the case is an image of another.
        let line = finding
            .labels
            .first()
            .and_then(|label| self.program.rows[row].lines.iter().position(|line| line.span == label.span));
        let bound = finding.message.rsplit(' ').next().and_then(|word| word.parse::<f64>().ok());
        let (Some(line), Some(bound)) = (line, bound) else { return };
        let way = (Some(row), Some(line));
        // All components, unless some are named.
        let named: Vec<&str> = finding.message.split('`').skip(1).step_by(2).collect();
        let components = self.program.output.components();
        let is_meant = |number: usize| named.is_empty() || named.contains(&components[number].name.as_str());
        let inside = self.known.iter().filter(|known| known.assumed).find(|known| {
            (known.wide.row, known.wide.line) == way
                && known.real == Some(way)
                && known.wide.values.iter().enumerate().any(|(number, value)| {
                    is_meant(number) && !value.is_nan() && (value - bound).abs() > 1e-9 * bound.abs().max(1.0)
                })
        });
        if let Some(known) = inside {
            let why = format!("it is {:?} at {}", known.wide.values, words(self.program, &known.point));
            self.false_claim(finding, why);
        }
    }

    /// On the way to the result something is infinite or no number.
    fn no_number(&mut self, finding: &Diagnostic) {
        let Some(point) = self.place(finding, "for instance at ") else { return };
        let mut trace = Trace {
            program: self.program,
            narrow: Interpreter::new(self.program),
            wide: Interpreter::new(self.program),
            found: false,
        };
        match trace.run(&point) {
            Some(()) if trace.found => {}
            Some(()) => self.false_claim(finding, "every operation on the way to the result gives a number there"),
            None => self.false_claim(finding, "the point lacks an input that is needed"),
        }
    }

    /// `at P it gives V, its images under S say W`
    fn broken(&mut self, finding: &Diagnostic) {
        let Some(note) = finding.notes.iter().find(|note| note.starts_with("at ") && note.contains(" it gives "))
        else {
            return;
        };
        let Some((place, rest)) = note["at ".len()..].split_once(" it gives ") else { return };
        let claimed = rest.split(", its image").next().unwrap_or("");
        let point = match read(self.program, place) {
            Ok(point) => point,
            Err(why) => return self.false_claim(finding, why),
        };
        self.court.count("witnesses", 1);
        let Ok(got) = Interpreter::<f64>::new(self.program).evaluate(&point) else {
            return self.false_claim(finding, "the point lacks an input that is needed");
        };
        let claimed: Vec<f64> = claimed.split(", ").filter_map(|word| word.parse().ok()).collect();
        let close =
            |(a, b): (&f64, &f64)| (a - b).abs() <= 1e-3 * a.abs().max(1.0) || a.is_nan() && b.is_nan() || a == b;
        if claimed.len() == got.values.len() && !claimed.iter().zip(&got.values).all(close) {
            self.false_claim(finding, format!("there it gives {:?}", got.values));
        }
    }

    /// The values on both sides of a border differ.
    fn jump(&mut self, finding: &Diagnostic) {
        let Some(note) = finding.notes.iter().find(|note| note.contains("\n touches ")) else { return };
        let Some((here, there)) = note.trim_start_matches("for instance ").split_once("\n touches ") else { return };
        let mut values = Vec::new();
        for place in [here, there] {
            let point = match read(self.program, place) {
                Ok(point) => point,
                Err(why) => return self.false_claim(finding, format!("{place}: {why}")),
            };
            self.court.count("witnesses", 1);
            match Interpreter::<f64>::new(self.program).evaluate(&point) {
                Ok(outcome) => values.push(outcome.values),
                Err(_) => return self.false_claim(finding, format!("{place} lacks an input that is needed")),
            }
        }
        if values[0] == values[1] {
            self.false_claim(finding, format!("both sides give {:?}", values[0]));
        }
    }

    fn uncovered(&mut self, finding: &Diagnostic) {
        if !finding.notes.iter().any(|note| note == "these are all states") {
            return;
        }
        let taken = self
            .known
            .iter()
            .find(|known| known.narrow.row.is_some() && known.real.is_some_and(|(row, _)| row.is_some()));
        if let Some(known) = taken {
            let why = format!("a case is taken at {}", words(self.program, &known.point));
            self.false_claim(finding, why);
        }
    }

    /// `at P f32 gives V`
    fn numbers(&mut self, finding: &Diagnostic) {
        for note in &finding.notes {
            let Some((before, after)) = note.split_once("f32 gives ") else { continue };
            let Some(place) = before.rsplit("at ").next().map(|place| place.trim_end_matches([' ', ':'])) else {
                continue;
            };
            let Ok(point) = read(self.program, place) else { continue };
            self.court.count("witnesses", 1);
            let claimed: Option<f64> = after.split([',', ' ']).next().and_then(|word| word.parse().ok());
            let Ok(got) = Interpreter::<f32>::new(self.program).evaluate(&point) else {
                return self.false_claim(finding, "the point lacks an input that is needed");
            };
            let [one] = got.values.as_slice() else { continue };
            let one = f64::from(*one);
            if let Some(claimed) = claimed
                && (claimed - one).abs() > 1e-5 * one.abs().max(1e-30)
            {
                return self.false_claim(finding, format!("there f32 gives {one}"));
            }
        }
    }
}

/// Whether something on the way to a result is infinite or no number.
struct Trace<'p> {
    program: &'p Program,
    narrow: Interpreter<'p, f32>,
    wide: Interpreter<'p, f64>,
    found: bool,
}

impl Trace<'_> {
    /// Follows the reference at a point; nothing if it lacks an input.
    fn run(&mut self, point: &Point) -> Option<()> {
        self.narrow.place(point).ok()?;
        self.wide.place(point).ok()?;
        for row in &self.program.rows {
            if !self.condition(row.guard)? {
                continue;
            }
            for line in &row.lines {
                if self.condition(line.condition)? {
                    return line.values.iter().try_for_each(|value| self.value(*value));
                }
            }
            break;
        }
        self.program.default.iter().try_for_each(|value| self.value(*value))
    }

    fn condition(&mut self, condition: CondId) -> Option<bool> {
        match self.program.pool.cond(condition) {
            Cond::Compare(_, a, b) => {
                self.value(*a)?;
                self.value(*b)?;
            }
            Cond::Const(_) | Cond::Level(..) => {}
            Cond::Not(_) | Cond::And(_) | Cond::Or(_) | Cond::If(..) => {
                for part in self.program.pool.cond(condition).children().collect::<Vec<_>>() {
                    self.condition(part);
                }
            }
        }
        self.wide.holds(condition).ok()
    }

    fn value(&mut self, value: ExprId) -> Option<()> {
        let number = self.wide.number(value).ok()?;
        self.found |= !number.is_finite() || !self.narrow.number(value).ok()?.is_finite();
        match self.program.pool.node(value) {
            Node::Select(condition, then, other) => {
                let holds = self.condition(condition)?;
                self.value(if holds { then } else { other })
            }
            // What it divides by is zero where its edges meet.
            Node::Ternary(TernaryOp::Smoothstep, lo, hi, at) => {
                self.found |= self.wide.number(lo).ok()? == self.wide.number(hi).ok()?;
                [lo, hi, at].into_iter().try_for_each(|part| self.value(part))
            }
            // Undefined for shaders, whatever the interpreter makes of it.
            Node::Binary(BinaryOp::Pow, base, exponent) => {
                let (from, to) = (self.wide.number(base).ok()?, self.wide.number(exponent).ok()?);
                self.found |= from < 0.0 || from == 0.0 && to <= 0.0;
                [base, exponent].into_iter().try_for_each(|part| self.value(part))
            }
            node @ (Node::Const(_)
            | Node::Word(_)
            | Node::Input(_)
            | Node::Index(_)
            | Node::Result(_)
            | Node::Unary(..)
            | Node::Binary(..)
            | Node::Ternary(..)) => {
                node.children().collect::<Vec<_>>().into_iter().try_for_each(|part| self.value(part))
            }
        }
    }
}
