//! The registry of diagnostic codes: each with its name here, its level and its meaning in a line.
//!
//! The list of findings, the headings of `docs/codes.md`, the table in
//! `docs/language.md` and what `umbrage explain` prints all follow it; tests
//! compare the two documents with it. A new code is a line here, a row of the
//! table and an article.

use std::fmt;

use super::Severity;

/// A stable name for a kind of diagnostic, such as `U0203`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Code(pub &'static str);

impl fmt::Display for Code {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.0)
    }
}

/// The stage that raises a code.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// Something cannot be done: a table has no meaning, a file cannot be read.
    Failure,
    /// An analysis has found something in a table that has a meaning. Users may
    /// change its level, and tables may acknowledge it.
    Finding,
}

/// A code as it is registered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Entry {
    /// The code.
    pub code: Code,
    /// Its name in the source of Umbrage.
    pub name: &'static str,
    /// The stage that raises it.
    pub kind: Kind,
    /// Its usual level; some findings are errors or notes where more, or less, is known.
    pub severity: Severity,
    /// Its meaning in a line.
    pub meaning: &'static str,
}

impl Entry {
    /// The heading of its article in `docs/codes.md`.
    pub fn heading(&self) -> String {
        format!("{}: {}", self.code, self.meaning)
    }
}

/// The entry of a code; capitals do not matter.
pub fn entry(code: &str) -> Option<&'static Entry> {
    ALL.iter().find(|entry| entry.code.0.eq_ignore_ascii_case(code))
}

/// The entries of findings, ascending.
pub fn findings() -> impl Iterator<Item = &'static Entry> {
    ALL.iter().filter(|entry| entry.kind == Kind::Finding)
}

macro_rules! registry {
    ($($name:ident = $code:literal, $kind:ident, $severity:ident, $meaning:literal;)*) => {
        $(#[doc = $meaning] pub const $name: Code = Code($code);)*

        /// Every code, ascending.
        pub const ALL: &[Entry] = &[$(Entry {
            code: $name,
            name: stringify!($name),
            kind: Kind::$kind,
            severity: Severity::$severity,
            meaning: $meaning,
        }),*];
    };
}

registry! {
    // Reading and writing files.
    UNREADABLE = "U0001", Failure, Error, "a file cannot be read, is a directory, too large, or not UTF-8";
    UNWRITABLE = "U0002", Failure, Error, "a file cannot be written";
    // Reading RON.
    RON = "U0101", Failure, Error, "the text is not RON";
    LANGUAGE_VERSION = "U0102", Failure, Error, "the table is written in another version of the language";
    STRUCTURE = "U0103", Failure, Error, "RON, but not of the shape of a table: a field is unknown, missing, given twice, or of the wrong kind";
    // Expressions and functions.
    EXPRESSION = "U0201", Failure, Error, "an expression is malformed";
    TOO_DEEP = "U0202", Failure, Error, "an expression is nested too deep or is too large";
    UNKNOWN_NAME = "U0203", Failure, Error, "a name is not defined";
    UNKNOWN_LEVEL = "U0204", Failure, Error, "an input has no such level";
    TYPE = "U0205", Failure, Error, "types do not go together";
    CALL = "U0206", Failure, Error, "unknown function, or wrong number of arguments";
    DIVISION_BY_ZERO = "U0207", Failure, Error, "division by a constant zero";
    NOT_FINITE = "U0208", Failure, Error, "a constant is not finite";
    CIRCULAR_NAME = "U0209", Failure, Error, "a named value is defined by itself";
    RECURSION = "U0210", Failure, Error, "a function calls itself";
    TOO_MANY_TERMS = "U0211", Failure, Error, "a sum or polynomial of no terms, or of too many";
    NOT_CONSTANT = "U0212", Failure, Error, "constant data, or a bound of a sum, that is not constant";
    IMPORT = "U0213", Failure, Error, "an imported table that cannot be read, or leads back";
    FUNCTION_SHAPE = "U0214", Failure, Error, "a function or helper whose fields do not make one; a table with cases and functions";
    PARAMETER = "U0215", Failure, Error, "a parameter that is not declared, not known, or not given";
    NO_FUNCTION = "U0216", Failure, Error, "a table of functions of which none was named, or one that it does not have";
    OUTPUTS = "U0217", Failure, Error, "a function that returns what no function can";
    OUTSIDE_DOMAIN = "U0218", Failure, Error, "a row of data outside of the domain of the function";
    LIMIT_BROKEN = "U0219", Finding, Error, "a function is not what a limit claims";
    BUDGET_EXCEEDED = "U0220", Finding, Error, "a function is less accurate than it claims";
    CLAIM_BROKEN = "U0221", Finding, Error, "a claim about constants or functions that does not hold";
    DATA_FILE = "U0222", Failure, Error, "a file of constant data that cannot be read, or holds no numbers";
    // Names and declarations.
    BAD_NAME = "U0301", Failure, Error, "a name is not a plain identifier";
    RESERVED_NAME = "U0302", Failure, Error, "a name is reserved or would hide generated code";
    DUPLICATE = "U0303", Failure, Error, "a name, level or code is used twice, or a local name hides another";
    DOMAIN = "U0304", Failure, Error, "a domain, an output, bounds or a replaced input that are impossible";
    TOO_MANY_STATES = "U0305", Failure, Error, "the discrete inputs have too many combined states";
    SYMMETRY = "U0306", Failure, Error, "a symmetry maps something that cannot be mapped so";
    // Cases.
    EMPTY = "U0401", Failure, Error, "a table without cases";
    DUPLICATE_CASE = "U0402", Failure, Error, "two cases with one number";
    MISSING_CASE = "U0403", Failure, Error, "reference to a case that does not exist";
    CIRCULAR_CASE = "U0404", Failure, Error, "a case refers to itself";
    REFERENCE_DEPTH = "U0405", Failure, Error, "a reference or an image of a case that is one itself";
    CASE_SHAPE = "U0406", Failure, Error, "a case whose fields do not make a case, or a line that is never reached";
    BAD_EXAMPLE = "U0407", Failure, Error, "an example that is incomplete, or whose expected value is not constant or beyond the clamp";
    // Findings about a program that has a meaning.
    EXAMPLE_FAILS = "U0501", Finding, Error, "an example leads to another case or another value";
    NOT_UNIQUE = "U0502", Finding, Warning, "`Unique`, but two cases match and differ";
    UNCOVERED = "U0503", Finding, Note, "states, or numbers, that no case claims (a note: the default is theirs)";
    DEAD_CASE = "U0504", Finding, Warning, "a case that is never taken";
    UNUSED_INPUT = "U0505", Finding, Warning, "an input that nothing depends on";
    SYMMETRY_BROKEN = "U0506", Finding, Warning, "cases that contradict their images under a declared symmetry; where most images agree, the odd one out";
    NO_LINE = "U0507", Finding, Warning, "a case that can match without a line that applies: the default decides";
    LINES_CROSS = "U0508", Finding, Warning, "lines of one case that can apply together with different values";
    ORDER_MATTERS = "U0509", Finding, Note, "cases that can match together with different values: their order matters (a note)";
    NOT_REACHED = "U0510", Finding, Warning, "a case that is never taken where the assumptions hold";
    DEAD_LINE = "U0511", Finding, Warning, "a line, or a part of its value, that never counts";
    SYMMETRY_ASSUMED = "U0512", Finding, Note, "cases that are images of each other only because an assumption holds (a note)";
    OUT_OF_RANGE = "U0513", Finding, Warning, "a value that is beyond the clamp wherever it counts";
    NOT_A_NUMBER = "U0514", Finding, Warning, "an operation that can yield infinity or NaN";
    FLOAT_EQUALITY = "U0515", Finding, Warning, "numbers that are compared for equality";
    JUMP = "U0516", Finding, Warning, "the value jumps at a border or switch where it is declared not to";
    SETTLED = "U0517", Finding, Warning, "a formula that is one number wherever it counts";
    OVERLONG = "U0518", Finding, Error, "a list that can have more items than its output allows";
    INEXACT = "U0520", Finding, Note, "a constant that no `f32` equals (a note), or an integer that `f32` takes for another one";
    MERGEABLE = "U0521", Finding, Note, "cases that could be one (a note)";
    RENAMED = "U0522", Finding, Note, "a name that a target language has to change (a note)";
    REPEATED = "U0523", Finding, Warning, "a condition that asks for the same thing twice";
    NOT_ANALYSED = "U0530", Finding, Note, "an analysis that could not be done, with the reason (a note)";
    UNUSED_ALLOW = "U0531", Finding, Warning, "an `allow` that acknowledges nothing";
    WIDE_ALLOW = "U0532", Finding, Note, "an `allow` that does not say what it acknowledges (a note)";
    REMOVABLE = "U0551", Finding, Warning, "a divisor is zero at a point of the domain where the whole has a limit";
    POLE = "U0552", Finding, Warning, "a divisor is zero at a point of the domain, and there is no limit";
    CANCELS = "U0553", Finding, Warning, "equal terms on both sides of a difference are divided by something small";
    OVERFLOW = "U0554", Finding, Warning, "an intermediate result overflows where the exact value does not";
    NO_FUNCTIONS = "U0555", Failure, Error, "`stabilise` was given a table without functions";
    // Plans, output, profiles and tuning.
    NOT_PROVED = "U0601", Failure, Error, "a plan is not equal to the table; refused, with a counterexample";
    NOT_APPLICABLE = "U0602", Failure, Error, "a plan cannot express this table";
    INVALID_OUTPUT = "U0603", Failure, Error, "generated code was refused by a validator";
    PROOF_TOO_LONG = "U0604", Failure, Error, "a plan has too many paths to be proved";
    BAD_PROFILE = "U0611", Failure, Error, "a profile that is damaged, or no profile at all";
    OTHER_PROFILE = "U0612", Failure, Error, "a profile of another table, or one of which nothing is left";
    EMPTY_PROFILE = "U0613", Failure, Error, "a profile that counts nothing";
    OLD_PROFILE = "U0614", Failure, Warning, "a profile that is used in part, or not at all (a warning: what was lost, and why)";
    EXCLUDED_STATE = "U0615", Failure, Error, "a state that occurs in a profile although an assumption excludes it";
    BAD_TUNED = "U0616", Failure, Error, "a file of tuned choices that is damaged or of another version";
    OLD_TUNED = "U0617", Failure, Warning, "a tuned choice that is not used (a warning: why, and what is used instead)";
    // Values given to a table, and what tools do to one.
    BAD_COLUMN = "U0701", Failure, Error, "a column of data is unknown, missing or given twice";
    BAD_VALUE = "U0702", Failure, Error, "a value of data is no level or number of its input";
    NEEDS_FETCH = "U0703", Failure, Error, "a row of data needs a fetched input that it does not give";
    BAD_CAPTURE = "U0704", Failure, Error, "a capture is damaged, or holds other inputs than the table's";
    BAD_POINT = "U0705", Failure, Error, "a point, light or occluder that `area` was given is malformed or impossible";
    FORMAT = "U0721", Failure, Error, "a table that `fmt` would have changed in more than its layout; it is left alone";
    EXISTS = "U0722", Failure, Error, "something that `new` would have replaced";
    // Devices.
    NO_ADAPTER = "U0801", Failure, Error, "no graphics adapter was found";
    DEVICE = "U0802", Failure, Error, "the graphics device failed";
    INADMISSIBLE = "U0803", Failure, Warning, "answers of a device that WGSL does not admit (a warning: where, and what was expected)";
    // Scenes and renderers.
    SCENE = "U0901", Failure, Error, "a scene has no meaning: a light without a direction, a shape without a size, …";
    MESH = "U0902", Failure, Error, "a mesh cannot be read, or nothing can be done with it";
    RENDER = "U0903", Failure, Error, "a picture cannot be rendered as asked";
    FOREIGN_INPUT = "U0904", Failure, Error, "a table needs an input that a shadow map does not have";
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_ascend_and_are_found() {
        assert!(ALL.windows(2).all(|pair| pair[0].code < pair[1].code));
        assert_eq!(entry("u0203").map(|entry| entry.name), Some("UNKNOWN_NAME"));
        assert_eq!(entry("U9999"), None);
    }
}
