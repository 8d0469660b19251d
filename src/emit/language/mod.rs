//! The differences between the languages that Umbrage prints itself.

mod composite;
pub(crate) mod glsl;
pub(crate) mod rust;
pub(crate) mod wgsl;

use super::inputs::{Fetch, fetch_ident};
use crate::program::operators::{Notation, Spelling, Spellings};
use crate::program::{BinaryOp, DataType, Input, Scalar, TernaryOp, UnaryOp};

pub(super) use composite::{structures, value, words};

/// A type in generated code.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Type {
    /// The type of an input, of the output, or of something in between.
    Data(DataType),
    /// The output together with the case taken.
    Result,
    /// The argument of the host's fetch functions.
    Site,
}

impl Type {
    pub(super) const FLOAT: Type = Type::Data(DataType::Scalar(Scalar::Float));
    pub(super) const UINT: Type = Type::Data(DataType::Scalar(Scalar::Uint));
    pub(super) const BOOL: Type = Type::Data(DataType::Scalar(Scalar::Bool));
    /// A sine and a cosine.
    pub(super) const PAIR: Type = Type::Data(DataType::Vector(2));
}

impl From<Scalar> for Type {
    fn from(scalar: Scalar) -> Self {
        Type::Data(DataType::Scalar(scalar))
    }
}

/// Names that a table contributes to generated code.
#[derive(Debug, Clone)]
pub(super) struct Prefix {
    /// `rsmss`
    pub(super) lower: String,
    /// `RSMSS`
    pub(super) upper: String,
    /// `Rsmss`
    pub(super) camel: String,
}

impl Prefix {
    pub(super) fn new(name: &str) -> Self {
        let capital = |word: &str| {
            let mut chars = word.chars();
            chars.next().map(|first| first.to_ascii_uppercase().to_string() + chars.as_str()).unwrap_or_default()
        };
        Self { lower: name.to_owned(), upper: name.to_ascii_uppercase(), camel: name.split('_').map(capital).collect() }
    }

    /// The structure of value and case.
    pub(super) fn result(&self) -> String {
        format!("{}Result", self.camel)
    }

    /// The structure of a value that consists of several numbers with names.
    pub(super) fn value(&self) -> String {
        format!("{}Value", self.camel)
    }

    /// The structure that the host defines.
    pub(super) fn site(&self) -> String {
        format!("{}Site", self.camel)
    }
}

/// The phrases of a language. Methods that are not overridden speak like the C family.
pub(super) trait Dialect {
    /// The name of a scalar type.
    fn scalar(&self, scalar: Scalar) -> &'static str;
    /// The name of the type of a vector of numbers.
    fn vector(&self, size: usize) -> String;
    /// The name of the type of an array, given that of its items.
    fn array(&self, of: &str, length: usize) -> String;
    /// The name of a type of data, in which structures begin with `structure`.
    fn data(&self, data: &DataType, structure: &str) -> String {
        match data {
            DataType::Scalar(scalar) => self.scalar(*scalar).to_owned(),
            DataType::Vector(size) => self.vector(*size),
            DataType::Array(of, length) => self.array(&self.data(of, structure), *length),
            DataType::Structure(_) => structure.to_owned(),
        }
    }
    /// The name of a type.
    fn ty(&self, ty: &Type, prefix: &Prefix) -> String {
        match ty {
            Type::Data(data) => self.data(data, &prefix.value()),
            Type::Result => prefix.result(),
            Type::Site => self.site(prefix),
        }
    }
    /// The type of the argument of the host's fetch functions.
    fn site(&self, prefix: &Prefix) -> String {
        prefix.site()
    }
    /// The first lines of a file, after the comment.
    fn prologue(&self, prefix: &Prefix, fetches: &[Fetch]) -> String;
    /// The first line of the host's function that counts results.
    fn hit(&self, prefix: &Prefix) -> String {
        format!("void {}(uint number)", self.global(prefix, "hit"))
    }
    /// Functions that the language lacks, for a table that needs remainders.
    fn remainder(&self, _: &Prefix) -> String {
        String::new()
    }
    /// The function `smoothstep` by its formula, which means something for any bounds.
    fn smoothstep(&self, prefix: &Prefix) -> String {
        let name = self.global(prefix, "smoothstep");
        let parameters = ["lo", "hi", "a"].map(|name| (name.to_owned(), Type::FLOAT));
        format!(
            "// `smoothstep` by its formula: the language leaves its own undefined for bounds that do not ascend.\n{}\n    {}\n    return t * t * (3.0 - 2.0 * t);\n}}",
            self.function(&name, &parameters, &Type::FLOAT, prefix),
            self.local(&Type::FLOAT, "t", "clamp((a - lo) / (hi - lo), 0.0, 1.0)", prefix)
        )
    }
    /// A function for sine and cosine from additions, products and a rounding.
    fn sincos(&self, prefix: &Prefix) -> String {
        let name = self.global(prefix, "sincos");
        let round = self.unary(prefix, UnaryOp::Round, "(x * 0.63661975)");
        let lines = [
            ("quarters", round.as_str()),
            ("r", "((x - quarters * 1.5703125) - quarters * 0.0004837513) - quarters * 7.54979e-8"),
            ("z", "r * r"),
            ("s", "r + r * z * (-0.16666655 + z * (0.008332161 - z * 0.00019515296))"),
            ("c", "(1.0 - 0.5 * z) + z * z * (0.041666646 + z * (-0.0013887316 + z * 0.000024433157))"),
            ("halves", &self.unary(prefix, UnaryOp::Floor, "(quarters * 0.5)")),
            ("odd", "quarters - 2.0 * halves"),
            ("even", "1.0 - odd"),
            ("next", &self.unary(prefix, UnaryOp::Floor, "(quarters * 0.5 + 0.5)")),
            (
                "sign_s",
                &format!("1.0 - 2.0 * (halves - 2.0 * {})", self.unary(prefix, UnaryOp::Floor, "(halves * 0.5)")),
            ),
            ("sign_c", &format!("1.0 - 2.0 * (next - 2.0 * {})", self.unary(prefix, UnaryOp::Floor, "(next * 0.5)"))),
        ];
        let x = [("x".to_owned(), Type::FLOAT)];
        let mut out = format!(
            "// Sine and cosine, as accurate on every device; the language promises too little for its own.\n{}\n",
            self.function(&name, &x, &Type::PAIR, prefix)
        );
        for (name, value) in lines {
            out += &format!("    {}\n", self.local(&Type::FLOAT, name, value, prefix));
        }
        let pair = ["(s * even + c * odd) * sign_s", "(c * even + s * odd) * sign_c"].map(str::to_owned);
        out + &format!("    return {};\n}}", self.collection(&self.vector(2), &pair))
    }
    /// One of a pair of numbers.
    fn of_pair(&self, pair: &str, second: bool) -> String {
        format!("{pair}.{}", if second { "y" } else { "x" })
    }
    /// A constant of the module.
    fn constant(&self, name: &str, value: u32) -> String;
    /// The declaration of a structure.
    fn structure(&self, name: &str, fields: &[(&str, String)]) -> String;
    /// The first line of a function.
    fn function(&self, name: &str, parameters: &[(String, Type)], result: &Type, prefix: &Prefix) -> String;
    /// Declares a local constant.
    fn local(&self, ty: &Type, name: &str, value: &str, prefix: &Prefix) -> String;
    /// Declares a number or a word that is assigned later.
    fn later(&self, scalar: Scalar, name: &str) -> String {
        format!("{} {name};", self.scalar(scalar))
    }
    /// Declares a local that may be assigned again.
    fn variable(&self, ty: &Type, name: &str, value: &str, prefix: &Prefix) -> String {
        self.local(ty, name, value, prefix)
    }
    /// The first line of a conditional.
    fn if_open(&self, condition: &str) -> String {
        format!("if ({condition}) {{")
    }
    /// The first line of a choice by number.
    fn switch_open(&self, selector: &str) -> String {
        format!("switch ({selector}) {{")
    }
    /// The first line of a way of the choice.
    fn case_open(&self, values: &[u32]) -> String;
    /// The way of all other numbers, which leads behind the choice.
    fn case_default(&self) -> &'static str;
    /// A real number.
    fn number(&self, value: f64) -> String {
        decimal(value)
    }
    /// A whole number.
    fn uint(&self, value: u32) -> String {
        format!("{value}u")
    }
    /// A word of a table.
    fn word(&self, value: u32) -> String {
        self.uint(value)
    }
    /// A whole number with a sign. The least one is no literal in all languages: its magnitude is no `int`.
    fn int(&self, value: i32) -> String {
        match value {
            i32::MIN => format!("({} - {})", self.plain_int(i32::MIN + 1), self.plain_int(1)),
            _ => self.plain_int(value),
        }
    }
    /// A whole number with a sign, whose magnitude is one, too.
    fn plain_int(&self, value: i32) -> String {
        value.to_string()
    }
    /// One of two values.
    fn select(&self, condition: &str, then: &str, other: &str) -> String;
    /// 0 or 1.
    fn bool_to_uint(&self, condition: &str) -> String;
    /// The number whose bits a word holds.
    fn float_from_bits(&self, word: &str) -> String;
    /// The word that holds the bits of a number.
    fn bits_of_float(&self, number: &str) -> String;
    /// The whole number whose bits a word holds.
    fn int_from_bits(&self, word: &str) -> String {
        format!("int({word})")
    }
    /// The word that holds the bits of a whole number.
    fn bits_of_int(&self, number: &str) -> String {
        format!("uint({number})")
    }
    /// The scalar that a word holds.
    fn scalar_of_word(&self, scalar: Scalar, word: &str) -> String {
        match scalar {
            Scalar::Float => self.float_from_bits(word),
            Scalar::Uint | Scalar::Word => word.to_owned(),
            Scalar::Int => self.int_from_bits(word),
            Scalar::Bool => format!("{word} != {}", self.uint(0)),
        }
    }
    /// The word that holds a scalar.
    fn word_of_scalar(&self, scalar: Scalar, value: &str) -> String {
        match scalar {
            Scalar::Float => self.bits_of_float(value),
            Scalar::Uint | Scalar::Word => value.to_owned(),
            Scalar::Int => self.bits_of_int(value),
            Scalar::Bool => self.bool_to_uint(value),
        }
    }
    /// Nothing, as a scalar.
    fn zero(&self, scalar: Scalar) -> String {
        match scalar {
            Scalar::Float => self.number(0.0),
            Scalar::Uint | Scalar::Word => self.uint(0),
            Scalar::Int => self.int(0),
            Scalar::Bool => "false".to_owned(),
        }
    }
    /// A number of one kind as one of another.
    fn converted(&self, from: Scalar, to: Scalar, value: &str) -> String {
        match from == to {
            true => value.to_owned(),
            false => format!("{}({})", self.scalar(to), bare(value)),
        }
    }
    /// A function of whole numbers: `abs`, `min` or `max`.
    fn int_function(&self, name: &str, operands: &[&str]) -> String {
        call(name, operands)
    }
    /// The remainder of whole numbers, of which the first may be negative.
    fn signed_remainder(&self, _: &Prefix, [a, b]: [&str; 2]) -> String {
        format!("({a} % {b})")
    }
    /// A function for that, where the language has none.
    fn signed_remainder_function(&self, _: &Prefix) -> String {
        String::new()
    }
    /// The condition that a word has a bit.
    fn has_bit(&self, word: &str, at: &str) -> String {
        format!("((({word} >> {at}) & {}) != {})", self.uint(1), self.uint(0))
    }
    /// Calls the host for a fetched input.
    fn fetch(&self, prefix: &Prefix, input: &Input) -> String {
        let arguments: String = self.arguments(input).iter().map(|argument| format!(", {argument}")).collect();
        format!("{}_fetch_{}(site{arguments})", prefix.lower, fetch_ident(input))
    }
    /// The arguments of a fetch, besides the site.
    fn arguments(&self, input: &Input) -> Vec<String> {
        let arguments = input.call.iter().flat_map(|call| &call.arguments);
        arguments.map(|argument| bare(&self.number(f64::from(*argument))).to_owned()).collect()
    }
    /// The argument that passes the site on.
    fn site_argument(&self) -> &'static str {
        "site"
    }
    /// This language's spelling, of those that an operator has.
    fn spelling(&self, of: Spellings) -> Spelling;
    /// An operation on one number.
    fn unary(&self, prefix: &Prefix, op: UnaryOp, a: &str) -> String {
        self.operation(prefix, op.row().notation, op.row().spellings, &[a])
    }
    /// An operation on two numbers.
    fn binary(&self, prefix: &Prefix, op: BinaryOp, a: &str, b: &str) -> String {
        self.operation(prefix, op.row().notation, op.row().spellings, &[a, b])
    }
    /// An operation on three numbers.
    fn ternary(&self, prefix: &Prefix, op: TernaryOp, a: &str, b: &str, c: &str) -> String {
        self.operation(prefix, op.row().notation, op.row().spellings, &[a, b, c])
    }
    /// An operation, as the table of operators spells it.
    fn operation(&self, prefix: &Prefix, notation: Notation, spellings: Spellings, operands: &[&str]) -> String {
        match self.spelling(spellings) {
            Spelling::Same => call(notation.name(), operands),
            Spelling::Call(name) => call(name, operands),
            Spelling::Symbol => match operands {
                [a] => format!("({}{a})", notation.name()),
                _ => format!("({})", operands.join(&format!(" {} ", notation.name()))),
            },
            Spelling::Text(template) => fill(template, operands),
            Spelling::Wide(method) => {
                let wide: Vec<String> = operands.iter().map(|a| format!("f64::from({a} as f32)")).collect();
                format!("(f64::{method}({}) as f32)", wide.join(", "))
            }
            Spelling::Own(name) => call(&self.global(prefix, name), operands),
            Spelling::OfSincos { second } => self.of_pair(&call(&self.global(prefix, "sincos"), operands), second),
        }
    }
    /// A vector or an array, made of its parts.
    fn collection(&self, ty: &str, parts: &[String]) -> String {
        format!("{ty}({})", parts.join(", "))
    }
    /// A structure, made of its fields.
    fn structure_of(&self, name: &str, fields: &[(&str, String)]) -> String {
        let values: Vec<&str> = fields.iter().map(|(_, value)| value.as_str()).collect();
        format!("{name}({})", values.join(", "))
    }
    /// Value and case together.
    fn result(&self, prefix: &Prefix, value: &str, case: &str) -> String {
        self.structure_of(&prefix.result(), &[("value", value.to_owned()), ("case_id", case.to_owned())])
    }
    /// The function of the host that reads a word of the lookup, where it is one.
    fn lookup_call(&self, prefix: &Prefix, word: &str) -> String {
        format!("{}_lookup({word})", prefix.lower)
    }
    /// The statement that makes the host's reader of the lookup visible, where the module cannot see it by itself.
    fn lookup_import(&self, _: &Prefix) -> String {
        String::new()
    }
    /// Names of the entry points in this language: with f32 levels, with a key, and both with the case.
    fn entry_names(&self, prefix: &Prefix) -> [String; 4] {
        let p = &prefix.lower;
        [p.clone(), format!("{p}_key"), format!("{p}_case"), format!("{p}_key_case")]
    }
    /// A name of the module, such as a helper or a constant.
    fn global(&self, prefix: &Prefix, name: &str) -> String {
        format!("{}_{name}", prefix.lower)
    }
    /// A constant of the module.
    fn global_constant(&self, prefix: &Prefix, name: &str) -> String {
        format!("{}_{name}", prefix.upper)
    }
}

/// A template of the table of operators with its operands put in.
fn fill(template: &str, operands: &[&str]) -> String {
    let mut out = String::new();
    let mut rest = template;
    while let Some((before, after)) = rest.split_once('{') {
        out.push_str(before);
        let place = ["a", "b", "c"].iter().zip(operands).find_map(|(name, operand)| {
            let after = after.strip_prefix(name)?;
            let plain = after.strip_prefix('}').map(|rest| (*operand, rest));
            plain.or_else(|| after.strip_prefix(":bare}").map(|rest| (bare(operand), rest)))
        });
        match place {
            Some((operand, after)) => {
                out.push_str(operand);
                rest = after;
            }
            // A block of the language itself.
            None => {
                out.push('{');
                rest = after;
            }
        }
    }
    out + rest
}

/// A call; arguments need no parentheses of their own.
pub(super) fn call(name: &str, arguments: &[&str]) -> String {
    let arguments: Vec<&str> = arguments.iter().map(|argument| bare(argument)).collect();
    format!("{name}({})", arguments.join(", "))
}

/// The shortest decimal that reads back as the same `f32`.
pub(super) fn decimal(value: f64) -> String {
    let text = format!("{:?}", value as f32);
    if text.starts_with('-') { format!("({text})") } else { text }
}

/// Removes the parentheses around a whole expression.
pub(super) fn bare(text: &str) -> &str {
    let Some(inner) = text.strip_prefix('(').and_then(|t| t.strip_suffix(')')) else { return text };
    let mut depth = 0_i32;
    for c in inner.chars() {
        depth += i32::from(c == '(') - i32::from(c == ')');
        if depth < 0 {
            return text;
        }
    }
    inner
}
