//! Values in hundreds of bits, to judge those in `f32`.
//!
//! [`Precise`] evaluates a program as the reference interpreter does, with
//! numbers of a multi-precision library. It can also stand *beside* a point:
//! every continuous input is moved by a different multiple of 2^-[`SHIFT`], and
//! every constant zero too, since a divisor such as `1 - s` has become one
//! where a table passes `s = 1`. The numbers have five times as many
//! bits, so that a quotient of two vanishing terms keeps its leading digits, and
//! what comes out is the limit that a formula with a removable singularity
//! leaves to the reader. If two such steps in different directions disagree,
//! there is no limit.

use std::collections::HashMap;

use astro_float_num::{BigFloat, Consts, RoundingMode, Sign};

use super::walk::Walk;
use crate::program::{
    BinaryOp, Comparison, CondId, Domain, ExprId, InputId, LevelSet, Node, Program, TernaryOp, UnaryOp, Value,
};

/// Bits of every number.
const BITS: usize = 384;

/// A step beside a point is a multiple of 2^-SHIFT.
const SHIFT: u32 = 72;

/// Two steps agree if they differ by no more than this, relative to the value.
const AGREE: f64 = 1e-14;

/// Or if they differ by no more than this: as far as the steps themselves can move a value that is zero.
pub(crate) const NOTHING: f64 = 1e-18;

/// Nothing needs directed rounding: the spare bits are many.
const ROUND: RoundingMode = RoundingMode::None;

/// An obstacle to the evaluation of a point.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Unknown {
    /// An input that is needed has no value.
    Absent(InputId),
    /// The values beside the point differ from each other, or are not finite.
    NoLimit,
}

/// Evaluates a program in hundreds of bits, at single points.
#[derive(Debug)]
pub struct Precise<'p> {
    program: &'p Program,
    consts: Consts,
    point: Vec<Option<Value>>,
    /// The direction of the step, if the point is stood beside.
    beside: Option<i32>,
    known: HashMap<ExprId, BigFloat>,
}

impl<'p> Precise<'p> {
    /// An evaluator of `program`; `None` if there is no memory for it.
    pub fn new(program: &'p Program) -> Option<Self> {
        let consts = Consts::new().ok()?;
        Some(Self { program, consts, point: Vec::new(), beside: None, known: HashMap::new() })
    }

    /// The value at a point, rounded to `f64`; where the formula divides by zero it is not finite.
    ///
    /// # Errors
    /// With the first input that is needed but absent.
    pub fn value(&mut self, point: &[Option<Value>]) -> Result<Vec<f64>, Unknown> {
        self.place(point, None);
        self.evaluate()
    }

    /// The limit of the value towards a point; where it is continuous, the value.
    ///
    /// # Errors
    /// If there is none, or if an input is needed but absent.
    pub fn limit(&mut self, point: &[Option<Value>]) -> Result<Vec<f64>, Unknown> {
        let here = self.value(point)?;
        if here.iter().all(|v| v.is_finite()) {
            return Ok(here);
        }
        self.place(point, Some(1));
        let one = self.evaluate()?;
        self.place(point, Some(-1));
        let other = self.evaluate()?;
        let agree = |(a, b): (&f64, &f64)| {
            a.is_finite() && b.is_finite() && (a - b).abs() <= (AGREE * a.abs().max(b.abs())).max(NOTHING)
        };
        if one.iter().zip(&other).all(agree) { Ok(one) } else { Err(Unknown::NoLimit) }
    }

    /// The value of an expression at the point of the last call.
    ///
    /// # Errors
    /// With the first input that is needed but absent.
    pub fn expression(&mut self, expr: ExprId) -> Result<f64, Unknown> {
        self.number(expr).map(|value| to_f64(&value))
    }

    fn place(&mut self, point: &[Option<Value>], beside: Option<i32>) {
        self.point.clear();
        self.point.extend_from_slice(point);
        self.point.resize(self.program.inputs.len(), None);
        self.beside = beside;
        self.known.clear();
    }

    /// The row that is taken at a point and the line of it that applies, over the reals.
    ///
    /// # Errors
    /// With the first input that is needed but absent.
    #[cfg(feature = "trial")]
    pub fn way(&mut self, point: &[Option<Value>]) -> Result<(Option<usize>, Option<usize>), Unknown> {
        self.place(point, None);
        let taken = self.taken()?;
        Ok((taken.row, taken.line))
    }

    /// Returns whether a condition holds at a point, over the reals.
    ///
    /// # Errors
    /// With the first input that is needed but absent.
    #[cfg(feature = "trial")]
    pub fn holds_at(&mut self, point: &[Option<Value>], condition: CondId) -> Result<bool, Unknown> {
        self.place(point, None);
        self.decide(condition)
    }

    fn evaluate(&mut self) -> Result<Vec<f64>, Unknown> {
        let taken = self.taken()?;
        taken.values.iter().map(|value| self.expression(*value)).collect()
    }

    fn number(&mut self, expr: ExprId) -> Result<BigFloat, Unknown> {
        if let Some(known) = self.known.get(&expr) {
            return Ok(known.clone());
        }
        let value = match self.program.pool.node(expr) {
            Node::Const(number) => self.constant(number.get()),
            Node::Word(word) => number(f64::from(word)),
            Node::Input(input) => self.input(input)?,
            Node::Index(input) => match self.point[input.index()] {
                Some(Value::Level(level)) => self.constant(f64::from(level)),
                _ => return Err(Unknown::Absent(input)),
            },
            // Occurs in the result map of a symmetry only, which is never evaluated at a point.
            Node::Result(_) => astro_float_num::NAN,
            Node::Unary(op, a) => {
                let a = self.number(a)?;
                self.unary(op, &a)
            }
            Node::Binary(op, a, b) => {
                let (a, b) = (self.number(a)?, self.number(b)?);
                self.binary(op, &a, &b)
            }
            Node::Ternary(op, a, b, c) => {
                let (a, b, c) = (self.number(a)?, self.number(b)?, self.number(c)?);
                ternary(op, &a, &b, &c)
            }
            Node::Select(condition, then, other) => match self.decide(condition)? {
                true => self.number(then)?,
                false => self.number(other)?,
            },
        };
        self.known.insert(expr, value.clone());
        Ok(value)
    }

    fn constant(&self, value: f64) -> BigFloat {
        match self.beside {
            Some(direction) if value == 0.0 => step(direction, 0),
            _ => number(value),
        }
    }

    fn input(&self, input: InputId) -> Result<BigFloat, Unknown> {
        let value = match self.point[input.index()] {
            Some(Value::Number(value)) => number(value),
            // A level where a number is wanted does not occur in a checked program.
            Some(Value::Level(_)) | None => return Err(Unknown::Absent(input)),
        };
        Ok(match self.beside.filter(|_| self.program.inputs[input.index()].domain != Domain::Word) {
            Some(direction) => add(&value, &step(direction, input.index() + 1)),
            None => value,
        })
    }

    fn unary(&mut self, op: UnaryOp, a: &BigFloat) -> BigFloat {
        use UnaryOp as Op;
        let one = number(1.0);
        let cc = &mut self.consts;
        match op {
            Op::Negate => a.neg(),
            Op::Abs => a.abs(),
            Op::Acos => a.acos(BITS, ROUND, cc),
            Op::Acosh => a.acosh(BITS, ROUND, cc),
            Op::Asin => a.asin(BITS, ROUND, cc),
            Op::Asinh => a.asinh(BITS, ROUND, cc),
            Op::Atan => a.atan(BITS, ROUND, cc),
            Op::Atanh => a.atanh(BITS, ROUND, cc),
            Op::Ceil => a.ceil(),
            Op::Cos | Op::PortableCos => a.cos(BITS, ROUND, cc),
            Op::Cosh => a.cosh(BITS, ROUND, cc),
            Op::Degrees => {
                let pi = cc.pi(BITS, ROUND);
                divide(&multiply(a, &number(180.0)), &pi)
            }
            Op::Exp => a.exp(BITS, ROUND, cc),
            Op::Exp2 => number(2.0).pow(a, BITS, ROUND, cc),
            Op::Floor => a.floor(),
            Op::Fract => subtract(a, &a.floor()),
            Op::InverseSqrt => divide(&one, &a.sqrt(BITS, ROUND)),
            Op::Log => a.ln(BITS, ROUND, cc),
            Op::Log2 => a.log2(BITS, ROUND, cc),
            Op::Radians => {
                let pi = cc.pi(BITS, ROUND);
                divide(&multiply(a, &pi), &number(180.0))
            }
            Op::Round => a.round(0, RoundingMode::ToEven),
            Op::Saturate => a.max(&number(0.0)).min(&one),
            Op::Sign if a.is_zero() => number(0.0),
            Op::Sign => a.signum(),
            Op::Sin | Op::PortableSin => a.sin(BITS, ROUND, cc),
            Op::Sinh => a.sinh(BITS, ROUND, cc),
            Op::Sqrt => a.sqrt(BITS, ROUND),
            Op::Tan => a.tan(BITS, ROUND, cc),
            Op::Tanh => a.tanh(BITS, ROUND, cc),
            Op::Trunc => a.int(),
            // Words are exact in `f64`.
            Op::WordNot | Op::WordOfNumber | Op::WordOfWhole | Op::NumberOfWord => number(op.apply(to_f64(a))),
        }
    }

    fn binary(&mut self, op: BinaryOp, a: &BigFloat, b: &BigFloat) -> BigFloat {
        match op {
            BinaryOp::Add => add(a, b),
            BinaryOp::Subtract => subtract(a, b),
            BinaryOp::Multiply => multiply(a, b),
            BinaryOp::Divide => divide(a, b),
            BinaryOp::Remainder => subtract(a, &multiply(b, &divide(a, b).int())),
            BinaryOp::WholeQuotient
            | BinaryOp::WholeRemainder
            | BinaryOp::WordAdd
            | BinaryOp::WordSubtract
            | BinaryOp::WordMultiply
            | BinaryOp::WordQuotient
            | BinaryOp::WordRemainder
            | BinaryOp::WordAnd
            | BinaryOp::WordOr
            | BinaryOp::WordXor
            | BinaryOp::ShiftLeft
            | BinaryOp::ShiftRight
            | BinaryOp::WordMax
            | BinaryOp::WordMin => number(op.apply(to_f64(a), to_f64(b))),
            BinaryOp::Atan2 => self.angle(a, b),
            BinaryOp::Max => a.max(b),
            BinaryOp::Min => a.min(b),
            BinaryOp::Pow => a.pow(b, BITS, ROUND, &mut self.consts),
            BinaryOp::Step => number(f64::from(u8::from(compare(Comparison::LessEqual, a, b)))),
        }
    }

    fn angle(&mut self, y: &BigFloat, x: &BigFloat) -> BigFloat {
        let pi = self.consts.pi(BITS, ROUND);
        if x.is_zero() {
            let half = divide(&pi, &number(2.0));
            return if y.is_zero() { number(0.0) } else { multiply(&half, &y.signum()) };
        }
        let inner = divide(y, x).atan(BITS, ROUND, &mut self.consts);
        match (x.is_negative(), y.is_negative()) {
            (false, _) => inner,
            (true, false) => add(&inner, &pi),
            (true, true) => subtract(&inner, &pi),
        }
    }
}

impl<'p> Walk<'p> for Precise<'p> {
    type Stop = Unknown;

    fn program(&self) -> &'p Program {
        self.program
    }

    fn has_level(&mut self, input: InputId, levels: LevelSet) -> Result<bool, Unknown> {
        match self.point[input.index()] {
            Some(Value::Level(level)) => Ok(levels.contains(level)),
            Some(Value::Number(_)) | None => Err(Unknown::Absent(input)),
        }
    }

    fn compare(&mut self, _: CondId, op: Comparison, a: ExprId, b: ExprId) -> Result<bool, Unknown> {
        let (a, b) = (self.number(a)?, self.number(b)?);
        Ok(compare(op, &a, &b))
    }
}

fn number(value: f64) -> BigFloat {
    BigFloat::from_f64(value, BITS)
}

/// A tiny number, another one for each place.
fn step(direction: i32, place: usize) -> BigFloat {
    // Not multiples of one another, so that combinations of inputs do not stay zero.
    let length = f64::from(direction) * (1.0 + (place as f64 * 0.754_877_666).fract());
    number(length * 0.5_f64.powi(SHIFT as i32))
}

fn add(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.add(b, BITS, ROUND)
}

fn subtract(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.sub(b, BITS, ROUND)
}

fn multiply(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.mul(b, BITS, ROUND)
}

fn divide(a: &BigFloat, b: &BigFloat) -> BigFloat {
    a.div(b, BITS, ROUND)
}

fn ternary(op: TernaryOp, a: &BigFloat, b: &BigFloat, c: &BigFloat) -> BigFloat {
    let one = number(1.0);
    match op {
        TernaryOp::Clamp => a.max(b).min(c),
        TernaryOp::Fma => add(&multiply(a, b), c),
        TernaryOp::Mix => add(&multiply(a, &subtract(&one, c)), &multiply(b, c)),
        TernaryOp::Smoothstep => {
            let t = divide(&subtract(c, a), &subtract(b, a)).max(&number(0.0)).min(&one);
            multiply(&multiply(&t, &t), &subtract(&number(3.0), &multiply(&number(2.0), &t)))
        }
    }
}

fn compare(op: Comparison, a: &BigFloat, b: &BigFloat) -> bool {
    match (op, a.cmp(b)) {
        (_, None) => false,
        (Comparison::Less, Some(order)) => order < 0,
        (Comparison::LessEqual, Some(order)) => order <= 0,
        (Comparison::Equal, Some(order)) => order == 0,
    }
}

/// The nearest `f64`, or one next to it.
fn to_f64(value: &BigFloat) -> f64 {
    if value.is_nan() {
        return f64::NAN;
    }
    let signed = |size: f64| if value.is_negative() { -size } else { size };
    if value.is_inf() {
        return signed(f64::INFINITY);
    }
    let Some((words, _, sign, exponent, _)) = value.as_raw_parts() else { return f64::NAN };
    let Some(top) = words.last() else { return 0.0 };
    let below = words.iter().rev().nth(1).copied().unwrap_or(0);
    // The mantissa is a fraction below one with its highest bit set.
    let fraction = *top as f64 * 2_f64.powi(-64) + below as f64 * 2_f64.powi(-128);
    let size = match exponent {
        ..-1100 => 0.0,
        -1100..-900 => fraction * 2_f64.powi(exponent + 500) * 2_f64.powi(-500),
        -900..=1000 => fraction * 2_f64.powi(exponent),
        1001..=1024 => fraction * 2_f64.powi(exponent - 500) * 2_f64.powi(500),
        _ => f64::INFINITY,
    };
    if sign == Sign::Neg { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::diag::Source;
    use crate::table::Table;

    fn program(value: &str) -> Program {
        let text = format!(
            r#"Table(language: 1, name: "t", hit_policy: First,
                inputs: {{"x": Range(from: -10, to: 10), "s": Range(from: -10, to: 10)}},
                output: Number(), cases: [Case(id: 1, when: "true", value: "{value}")], default: 0)"#
        );
        Table::parse(Source::new("test.ron", text))
            .and_then(|table| Program::check(&table))
            .unwrap_or_else(|e| panic!("{e}"))
    }

    fn at(x: f64, s: f64) -> [Option<Value>; 2] {
        [Some(Value::Number(x)), Some(Value::Number(s))]
    }

    #[test]
    fn digits_beyond_double_precision() {
        let program = program("(1 - cos(s * 1e-12)) * 1e24 + x * 0");
        let mut precise = Precise::new(&program).expect("memory");
        let got = precise.value(&at(0.0, 1.0)).expect("all given")[0];
        assert!((got - 0.5).abs() < 1e-15, "{got}");
        let program = self::program("atan2(x, s) + x % 3 + round(s)");
        let mut precise = Precise::new(&program).expect("memory");
        for (x, s) in [(1.0_f64, -2.5), (-4.0, -0.5), (5.5, 3.5), (0.0, 2.0), (-1.0, 0.0)] {
            let expected = x.atan2(s) + x % 3.0 + s.round_ties_even();
            let got = precise.value(&at(x, s)).expect("all given")[0];
            assert!((got - expected).abs() < 1e-14, "{x} {s}: {got} {expected}");
        }
    }

    #[test]
    fn limits_at_removable_singularities() {
        let removable = program("(sin(s * (x + 0.5)) - sin(s * x)) / s");
        let mut precise = Precise::new(&removable).expect("memory");
        let singular = precise.value(&at(0.5, 0.0)).expect("all given");
        assert!(singular[0].is_nan());
        let limit = precise.limit(&at(0.5, 0.0)).expect("a limit");
        assert!((limit[0] - 0.5_f64).abs() < 1e-15, "{limit:?}");

        // A divisor that is zero at every point.
        let mut always = program("x");
        let (zero, x) = (always.pool.number(0.0), always.rows[0].lines[0].values[0]);
        let product = always.pool.binary(BinaryOp::Multiply, zero, x);
        let sine = always.pool.unary(UnaryOp::Sin, product);
        always.rows[0].lines[0].values[0] = always.pool.binary(BinaryOp::Divide, sine, zero);
        let mut precise = Precise::new(&always).expect("memory");
        let limit = precise.limit(&at(0.5, 0.0)).expect("a limit");
        assert!((limit[0] - 0.5).abs() < 1e-15, "{limit:?}");

        let pole = program("x / s");
        let mut precise = Precise::new(&pole).expect("memory");
        assert_eq!(precise.limit(&at(0.5, 0.0)), Err(Unknown::NoLimit));
        assert_eq!(precise.limit(&at(0.5, 2.0)), Ok(vec![0.25]));
    }
}
