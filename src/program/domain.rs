//! Inputs and the values they can take.

use super::InputId;
use super::classes::Classes;
use super::pool::Pool;
use crate::diag::Span;

/// Most levels of one discrete input.
pub const MAX_LEVELS: usize = 64;

/// An input of a program.
#[derive(Debug, Clone)]
pub struct Input {
    /// Its name in the table.
    pub name: String,
    /// Its name in generated code.
    pub ident: String,
    /// The values it can take.
    pub domain: Domain,
    /// Its description.
    pub doc: String,
    /// Cost in texture reads, for inputs that the host produces on demand.
    pub fetched: Option<f64>,
    /// The call that fetches it, where the host's function takes arguments.
    pub call: Option<FetchCall>,
    /// The value that examples and `explain` assume when they leave the input out.
    pub default: Option<Value>,
    /// The place of its declaration.
    pub span: Span,
}

/// A call of a function of the host that takes arguments. Each tuple of arguments that occurs
/// is an input of its own, so that every later stage knows nothing but inputs.
#[derive(Debug, Clone, PartialEq)]
pub struct FetchCall {
    /// The name of the function in the table.
    pub function: String,
    /// The name of the function in generated code.
    pub ident: String,
    /// The names of its arguments.
    pub parameters: Vec<String>,
    /// The arguments, as `f32` has them.
    pub arguments: Vec<f32>,
}

impl FetchCall {
    /// The call as it is written, which is the name of the input.
    pub fn name(&self) -> String {
        let arguments: Vec<String> = self.arguments.iter().map(f32::to_string).collect();
        format!("{}({})", self.function, arguments.join(","))
    }

    /// Returns whether a word is this call, blanks and the spelling of numbers aside.
    fn is_written(&self, word: &str) -> bool {
        let Some((function, rest)) = word.split_once('(') else { return false };
        let Some(list) = rest.trim_end().strip_suffix(')') else { return false };
        let arguments: Option<Vec<f32>> = list.split(',').map(|number| number.trim().parse().ok()).collect();
        function.trim_end() == self.function && arguments.as_ref() == Some(&self.arguments)
    }
}

/// The values an input can take.
#[derive(Debug, Clone, PartialEq)]
pub enum Domain {
    /// One of finitely many levels.
    Discrete(Levels),
    /// A real number of a closed interval.
    Continuous {
        /// Smallest value.
        lo: f64,
        /// Largest value.
        hi: f64,
        /// Unit, for messages and comments; may be empty.
        unit: String,
    },
    /// A word: an unsigned integer of 32 bits.
    Word,
}

impl Domain {
    /// The numbers that an input, or the index of its level, lies between.
    pub fn span(&self) -> (f64, f64) {
        match self {
            Domain::Discrete(levels) => (0.0, (levels.count() - 1) as f64),
            Domain::Continuous { lo, hi, .. } => (*lo, *hi),
            Domain::Word => (0.0, f64::from(u32::MAX)),
        }
    }

    /// Tells a pool what an input of this domain can be, before it is mentioned.
    pub(super) fn declare(&self, input: InputId, pool: &mut Pool) {
        pool.declare(input, self.span());
        if *self == Domain::Word {
            pool.declare_word(input);
        }
    }

    /// The ends of a range, of real numbers or of words; nothing for levels.
    pub fn range(&self) -> Option<(f64, f64)> {
        match self {
            Domain::Discrete(_) => None,
            Domain::Continuous { .. } | Domain::Word => Some(self.span()),
        }
    }

    /// A number as all executors are given it: rounded to `f32`, or, of a word, the whole part.
    pub fn given(&self, number: f64) -> f64 {
        match self {
            Domain::Discrete(_) | Domain::Continuous { .. } => f64::from(number as f32),
            Domain::Word => self.point(number),
        }
    }

    /// A number as a point of the domain: itself, or, of a word, the whole part.
    pub fn point(&self, number: f64) -> f64 {
        match self {
            Domain::Discrete(_) | Domain::Continuous { .. } => number,
            Domain::Word => number.clamp(0.0, f64::from(u32::MAX)).floor(),
        }
    }
}

/// The levels of a discrete input.
#[derive(Debug, Clone, PartialEq)]
pub struct Levels {
    /// Their names, in the order declared; a level's index is its place in this list.
    pub names: Vec<String>,
    /// The numbers that stand for them where levels are carried as `f32`.
    pub codes: Vec<f64>,
    /// The kind of input that they belong to.
    pub kind: LevelKind,
    /// Of integers that are numbers, how they are cut into levels; the codes are the smallest of each.
    pub classes: Option<Classes>,
}

/// The kind of a discrete input.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LevelKind {
    /// Named levels.
    Named,
    /// `false`, `true`.
    Bool,
    /// Consecutive integers.
    Int,
}

impl Levels {
    /// The number of levels.
    pub fn count(&self) -> usize {
        self.names.len()
    }

    /// Bits that hold the index of a level.
    pub fn bits(&self) -> u32 {
        usize::BITS - (self.count() - 1).leading_zeros()
    }

    /// The level with a name, or with a code written as a number.
    pub fn find(&self, word: &str) -> Option<u8> {
        if let Some(classes) = &self.classes {
            let number = word.parse::<f64>().ok().filter(|number| number.fract() == 0.0 && number.abs() < 1e15)?;
            return classes.find(number as i64);
        }
        let by_name = self.names.iter().position(|name| name == word);
        let by_code = || {
            let number: f64 = word.parse().ok()?;
            self.codes.iter().position(|code| *code == number)
        };
        by_name.or_else(by_code).map(|index| index as u8)
    }

    /// Returns whether these are integers of which one level may stand for many.
    pub fn is_wide(&self) -> bool {
        self.classes.as_ref().is_some_and(|classes| !classes.is_each())
    }

    /// A level as it is given: its name, or an integer that it stands for.
    pub fn shown(&self, level: u8) -> String {
        match self.classes {
            Some(_) => self.codes[usize::from(level)].to_string(),
            None => self.names[usize::from(level)].clone(),
        }
    }

    /// The levels in words, for messages.
    pub fn describe(&self) -> String {
        if let Some((least, most)) = self.classes.as_ref().map(Classes::range) {
            return format!("whole numbers from {least} to {most}");
        }
        let named = |(name, code): (&String, &f64)| match self.kind {
            LevelKind::Named => format!("{name} ({code})"),
            LevelKind::Bool | LevelKind::Int => name.clone(),
        };
        self.names.iter().zip(&self.codes).map(named).collect::<Vec<_>>().join(", ")
    }
}

/// A value of an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// The index of a level.
    Level(u8),
    /// A number, or a word.
    Number(f64),
}

/// The combinations of all discrete inputs that are not fetched, in a fixed order:
/// the last input varies fastest.
#[derive(Debug, Clone)]
pub struct StateSpace {
    digits: Vec<(InputId, usize)>,
    count: usize,
}

impl StateSpace {
    /// Most states that are enumerated.
    pub const MAX: u64 = 1 << 22;

    /// The states of these inputs, or their number if there are too many.
    pub(super) fn new(inputs: &[Input]) -> Result<Self, f64> {
        let mut digits = Vec::new();
        let mut product = 1.0_f64;
        for (index, input) in inputs.iter().enumerate() {
            if let (Domain::Discrete(levels), None) = (&input.domain, input.fetched) {
                digits.push((InputId::new(index), levels.count()));
                product *= levels.count() as f64;
            }
        }
        if product > Self::MAX as f64 {
            return Err(product);
        }
        Ok(Self { digits, count: product as usize })
    }

    /// The number of states; at least one.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The inputs that make up a state, with their numbers of levels.
    pub fn digits(&self) -> &[(InputId, usize)] {
        &self.digits
    }

    /// Writes the levels of state number `index` into `levels`, indexed by input.
    pub fn write(&self, index: usize, levels: &mut [u8]) {
        let mut rest = index;
        for (input, count) in self.digits.iter().rev() {
            levels[input.index()] = (rest % count) as u8;
            rest /= count;
        }
    }

    /// The number of the state with these levels, indexed by input.
    pub fn index(&self, levels: impl Fn(InputId) -> u8) -> usize {
        self.digits.iter().fold(0, |index, (input, count)| index * count + usize::from(levels(*input)))
    }
}

/// A word as it is written: a whole number, also with an exponent, or hexadecimal digits behind `0x`.
fn word(text: &str) -> Option<u32> {
    match text.strip_prefix("0x").or_else(|| text.strip_prefix("0X")) {
        Some(digits) => u32::from_str_radix(digits, 16).ok(),
        None => {
            let number = text.parse::<f64>().ok()?;
            (number.fract() == 0.0 && (0.0..=f64::from(u32::MAX)).contains(&number)).then_some(number as u32)
        }
    }
}

impl Input {
    /// Returns whether a word in data means this input.
    pub fn is_called(&self, word: &str) -> bool {
        self.name == word || self.call.as_ref().is_some_and(|call| call.is_written(word))
    }

    /// The value in place of an input that is not fetched: the least number, or the number of the first level.
    pub fn least(&self) -> f64 {
        match self.domain {
            Domain::Continuous { lo, .. } => lo,
            Domain::Discrete(_) | Domain::Word => 0.0,
        }
    }

    /// Reads a value of this input: a level by name or code, a number in the range, or a word.
    ///
    /// # Errors
    /// With a message that says what is expected.
    pub fn parse(&self, word: &str) -> Result<Value, String> {
        match &self.domain {
            Domain::Discrete(levels) => {
                levels.find(word).map(Value::Level).ok_or_else(|| match levels.classes.is_some() {
                    true => format!("`{word}` is no value of `{}`, which has {}", self.name, levels.describe()),
                    false => {
                        format!("`{word}` is not a level of `{}`; the levels are: {}", self.name, levels.describe())
                    }
                })
            }
            Domain::Continuous { lo, hi, .. } => match word.parse::<f64>() {
                Ok(number) if (*lo..=*hi).contains(&number) => Ok(Value::Number(number)),
                Ok(number) => Err(format!("{number} is not in the range {lo} to {hi} of `{}`", self.name)),
                Err(_) => Err(format!("`{word}` is not a number; `{}` ranges from {lo} to {hi}", self.name)),
            },
            Domain::Word => match self::word(word) {
                Some(number) => Ok(Value::Number(f64::from(number))),
                None => Err(format!(
                    "`{word}` is no value of `{}`, which is a whole number from 0 to {}",
                    self.name,
                    u32::MAX
                )),
            },
        }
    }

    /// A value in words.
    pub fn show(&self, value: Value) -> String {
        match (value, &self.domain) {
            (Value::Level(level), Domain::Discrete(levels)) => levels.shown(level),
            (Value::Level(level), _) => level.to_string(),
            (Value::Number(number), _) => number.to_string(),
        }
    }
}
