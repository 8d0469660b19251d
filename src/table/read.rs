//! RON text → [`Table`].
//!
//! One `…Ron` struct per construct says which fields it has; serde refuses the
//! rest. Independent parts (inputs, cases, …) are read one by one, so that a
//! mistake in one does not hide the mistakes in the others.

pub(super) mod conditions;
pub(super) mod maps;

use serde::Deserialize;

use super::expr::{Expr, ExprKind};
use super::{
    Allow, Assumption, Case, CaseBody, Domain, Erratum, Example, Group, HitPolicy, Input, LANGUAGE, Level, Line, Named,
    Output, Table,
};
use crate::diag::{Diagnostic, Source, Span, Spanned, codes};
use crate::text::raw::{Raw, RawMap, Reader, Shape};
use std::sync::Arc;

type Result<T> = std::result::Result<T, Diagnostic>;

#[derive(Deserialize)]
#[serde(rename = "Table", deny_unknown_fields)]
pub(super) struct TableRon<'a> {
    #[serde(borrow)]
    language: Raw<'a>,
    name: Raw<'a>,
    #[serde(default)]
    title: String,
    #[serde(default)]
    source: String,
    #[serde(default)]
    hit_policy: Option<Raw<'a>>,
    #[serde(default = "RawMap::empty")]
    levels: RawMap<'a>,
    #[serde(default)]
    inputs: Option<RawMap<'a>>,
    #[serde(default = "RawMap::empty")]
    groups: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    names: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    symmetries: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    assume: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    draw: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    continuity: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    claims: RawMap<'a>,
    #[serde(default)]
    allow: Vec<Raw<'a>>,
    #[serde(default)]
    exhibit: Option<String>,
    #[serde(default)]
    output: Option<Raw<'a>>,
    #[serde(default)]
    cases: Option<Vec<Raw<'a>>>,
    #[serde(default)]
    default: Option<Raw<'a>>,
    #[serde(default = "RawMap::empty")]
    imports: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    constants: RawMap<'a>,
    #[serde(default = "RawMap::empty")]
    helpers: RawMap<'a>,
    #[serde(default)]
    functions: Option<RawMap<'a>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) enum InputRon<'a> {
    Levels {
        #[serde(borrow, default)]
        values: Option<RawMap<'a>>,
        #[serde(default)]
        of: Option<Raw<'a>>,
        #[serde(default)]
        doc: String,
        #[serde(default)]
        fetched: Option<Raw<'a>>,
        #[serde(default)]
        default: Option<Raw<'a>>,
    },
    Bool {
        #[serde(default)]
        doc: String,
        #[serde(default)]
        fetched: Option<Raw<'a>>,
        #[serde(default)]
        default: Option<Raw<'a>>,
    },
    Int {
        #[serde(default = "least")]
        from: i64,
        #[serde(default = "most")]
        to: i64,
        #[serde(default)]
        doc: String,
        #[serde(default)]
        fetched: Option<Raw<'a>>,
        #[serde(default)]
        default: Option<Raw<'a>>,
    },
    U32 {
        #[serde(default)]
        doc: String,
        #[serde(default)]
        fetched: Option<Raw<'a>>,
        #[serde(default)]
        default: Option<Raw<'a>>,
    },
    Range {
        from: f64,
        to: f64,
        #[serde(default)]
        unit: String,
        #[serde(default)]
        doc: String,
        #[serde(default)]
        fetched: Option<Raw<'a>>,
        #[serde(default)]
        default: Option<Raw<'a>>,
    },
}

/// The bounds of integers that are not bounded.
fn least() -> i64 {
    i32::MIN.into()
}

fn most() -> i64 {
    i32::MAX.into()
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct FetchedRon {
    cost: f64,
}

#[derive(Deserialize)]
#[serde(rename = "Allow", deny_unknown_fields)]
pub(super) struct AllowRon<'a> {
    #[serde(borrow)]
    code: Raw<'a>,
    #[serde(default)]
    with: Option<Vec<Raw<'a>>>,
    reason: String,
}

#[derive(Deserialize)]
#[serde(rename = "Case", deny_unknown_fields)]
pub(super) struct CaseRon<'a> {
    #[serde(borrow)]
    id: Raw<'a>,
    #[serde(default)]
    section: String,
    #[serde(default)]
    doc: String,
    #[serde(default)]
    when: Option<Raw<'a>>,
    #[serde(default)]
    value: Option<Raw<'a>>,
    #[serde(default)]
    lines: Option<Vec<Raw<'a>>>,
    #[serde(default)]
    is: Option<Raw<'a>>,
    #[serde(default)]
    images: Vec<Raw<'a>>,
    #[serde(default)]
    errata: Vec<ErratumRon>,
    #[serde(default)]
    examples: Vec<Raw<'a>>,
    #[serde(default)]
    allow: Vec<Raw<'a>>,
}

#[derive(Deserialize)]
#[serde(rename = "Erratum", deny_unknown_fields)]
pub(super) struct ErratumRon {
    no: u32,
    printed: String,
    meant: String,
}

#[derive(Deserialize)]
#[serde(rename = "Image", deny_unknown_fields)]
pub(super) struct ImageOfRon<'a> {
    #[serde(borrow)]
    case: Raw<'a>,
    under: Raw<'a>,
}

/// Reads a whole table, collecting as many mistakes as possible.
pub(super) fn table(source: &Arc<Source>) -> std::result::Result<Table, Vec<Diagnostic>> {
    let read = Reader::new(source);
    let start = read.first();
    let rest = &source.text[start..];
    // The name may be left out in RON; an attribute enables extensions.
    if !["Table", "(", "#"].iter().any(|opening| rest.starts_with(opening)) {
        let end = start + rest.chars().next().map_or(0, char::len_utf8);
        return Err(vec![
            Diagnostic::error(codes::STRUCTURE, "this file contains no table")
                .at(Span::new(start, end), "expected `Table(`")
                .help("a table is written: Table(language: 1, name: \"...\", hit_policy: First, inputs: {...}, ...)"),
        ]);
    }
    let ron: TableRon<'_> = read.get(read.whole()).map_err(|d| vec![d])?;
    let language = read.spanned::<u32>(ron.language).map_err(|d| vec![d])?;
    if !(1..=LANGUAGE).contains(&language.value) {
        let message =
            format!("this compiler reads versions 1 to {LANGUAGE} of the table language, not {}", language.value);
        return Err(vec![
            Diagnostic::error(codes::LANGUAGE_VERSION, message).at(language.span, "version of this table"),
        ]);
    }
    let mut errors = Errors(Vec::new());
    if let Some((group, _)) = ron.groups.0.first() {
        errors.take(since(2, &language, read.span(*group), "`groups`"));
    }
    if let Some((claim, _)) = ron.claims.0.first() {
        errors.take(since(2, &language, read.span(*claim), "`claims`"));
    }
    let name = errors.take(read.spanned::<String>(ron.name));
    let decision = errors.take(read.decision(&ron, &language));
    let levels = errors.each(ron.levels.0, |(n, v)| Ok((read.word(n)?, read.levels(&read.get(v)?)?)));
    let inputs = errors.each(ron.inputs.map_or_else(Vec::new, |map| map.0), |(n, v)| {
        let input = read.input(n, v)?;
        if !input.parameters.is_empty() {
            since(2, &language, input.name.span, "a fetch with arguments")?;
        }
        Ok(input)
    });
    let groups = errors.each(ron.groups.0, |(n, v)| read.group(n, v));
    let names = errors.each(ron.names.0, |(n, v)| Ok(Named { name: read.word(n)?, value: read.condition(v)? }));
    let symmetries = errors.each(ron.symmetries.0, |(n, v)| read.symmetry(n, v));
    let assumptions = errors.each(ron.assume.0, |(n, v)| read.assumption(n, v));
    let draw = errors.each(ron.draw.0, |(n, v)| read.draw(n, v));
    let continuity = errors.each(ron.continuity.0, |(n, v)| read.continuity(n, v));
    let claims = errors.each(ron.claims.0, |(n, v)| read.claim(n, v));
    let allow = errors.each(ron.allow, |raw| read.allow(raw));
    let cases = errors.each(ron.cases.unwrap_or_default(), |raw| read.case(raw));
    let imports = errors.each(ron.imports.0, |(n, v)| read.import(n, v));
    let constants = errors.each(ron.constants.0, |(n, v)| {
        let (constant, is_early) = read.constant(n, v)?;
        if !is_early {
            since(2, &language, read.span(v), "such data")?;
        }
        Ok(constant)
    });
    let helpers = errors.each(ron.helpers.0, |(n, v)| read.helper(n, v));
    let functions = errors.each(ron.functions.map_or_else(Vec::new, |map| map.0), |(n, v)| read.function(n, v));
    match (name, decision) {
        (Some(name), Some(Decision { hit_policy, output, default, declares_only })) if errors.0.is_empty() => {
            Ok(Table {
                source: source.clone(),
                language,
                name,
                title: ron.title,
                origin: ron.source,
                hit_policy,
                levels,
                inputs,
                groups,
                names,
                symmetries,
                assumptions,
                draw,
                output,
                cases,
                default,
                imports,
                constants,
                helpers,
                functions,
                continuity,
                claims,
                allow,
                exhibit: ron.exhibit,
                declares_only,
            })
        }
        _ => Err(errors.0),
    }
}

/// Refuses what a later version of the language brings.
pub(super) fn since(version: u32, language: &Spanned<u32>, span: Span, what: &str) -> Result<()> {
    if language.value >= version {
        return Ok(());
    }
    Err(Diagnostic::error(codes::LANGUAGE_VERSION, format!("{what} came with version {version} of the table language"))
        .at(span, format!("not in version {}", language.value))
        .at(language.span, "version of this table")
        .help(format!("write `language: {version}`; whatever the table says already keeps its meaning"))
        .mend(format!("write `language: {version}`"), language.span, version.to_string()))
}

struct Errors(Vec<Diagnostic>);

impl Errors {
    fn take<T>(&mut self, result: Result<T>) -> Option<T> {
        result.map_err(|error| self.0.push(error)).ok()
    }

    fn each<I, T>(&mut self, items: Vec<I>, mut read: impl FnMut(I) -> Result<T>) -> Vec<T> {
        items.into_iter().filter_map(|item| self.take(read(item))).collect()
    }
}

/// The parts of a table of cases besides its cases.
struct Decision {
    hit_policy: Spanned<HitPolicy>,
    output: Spanned<Output<Spanned<String>>>,
    default: Expr,
    declares_only: bool,
}

impl<'a> Reader<'a> {
    /// A table has cases, with what belongs to them, or functions. Those that only have functions
    /// get what stands for nothing.
    fn decision(&self, ron: &TableRon<'a>, language: &Spanned<u32>) -> Result<Decision> {
        let missing = |field: &str| {
            Diagnostic::error(codes::STRUCTURE, format!("the field `{field}` is missing in `Table`"))
                .at(self.first_word(), "here")
        };
        let nothing = |at: Span, declares_only: bool| Decision {
            hit_policy: Spanned::new(at, HitPolicy::First),
            output: Spanned::new(at, Output::Number(None)),
            default: Expr { span: at, kind: ExprKind::Number(0.0) },
            declares_only,
        };
        if self.declares_only(ron) {
            since(2, language, self.first_word(), "a table without cases and functions")?;
            return Ok(nothing(self.first_word(), true));
        }
        ron.inputs.as_ref().ok_or_else(|| missing("inputs"))?;
        let Some(functions) = &ron.functions else {
            let hit_policy = self.hit_policy(ron.hit_policy.ok_or_else(|| missing("hit_policy"))?)?;
            if hit_policy.value == HitPolicy::Collect {
                since(2, language, hit_policy.span, "`Collect`")?;
            }
            let (output, later) = self.output(ron.output.ok_or_else(|| missing("output"))?)?;
            if let Some((place, what)) = later {
                since(2, language, place, what)?;
            }
            return Ok(Decision {
                hit_policy,
                default: {
                    ron.cases.as_ref().ok_or_else(|| missing("cases"))?;
                    let default = ron.default.ok_or_else(|| missing("default"))?;
                    // Where a level is expected, quotes are optional.
                    match &output.value {
                        Output::Enumeration(_) => self.level_or_expr(default)?,
                        Output::Number(_)
                        | Output::Vector(..)
                        | Output::Bool
                        | Output::Int(..)
                        | Output::U32
                        | Output::List { .. }
                        | Output::Record(_) => self.expr(default)?,
                    }
                },
                output,
                declares_only: false,
            });
        };
        let odd =
            [ron.hit_policy, ron.output, ron.default, ron.cases.as_ref().and_then(|cases| cases.first().copied())];
        if let Some(odd) = odd.into_iter().flatten().next() {
            return Err(Diagnostic::error(codes::FUNCTION_SHAPE, "a table has cases or functions, not both")
                .at(self.span(odd), "belongs to a table of cases")
                .help("put the functions into a table of their own and import it")
                .help("what only this table calls stands under `helpers`, also in a table of cases"));
        }
        let at = self.first_word();
        if functions.0.is_empty() {
            return Err(Diagnostic::error(codes::FUNCTION_SHAPE, "the table has no functions").at(at, "this table"));
        }
        Ok(nothing(at, false))
    }

    /// Returns whether a table has nothing but level sets and constants.
    fn declares_only(&self, ron: &TableRon<'a>) -> bool {
        let maps = [&ron.groups, &ron.names, &ron.symmetries, &ron.assume, &ron.draw, &ron.continuity, &ron.helpers];
        let decides = [ron.hit_policy, ron.output, ron.default].iter().any(Option::is_some)
            || ron.cases.is_some()
            || ron.functions.is_some()
            || ron.inputs.is_some();
        let declares = [&ron.levels, &ron.constants].iter().any(|map| !map.0.is_empty());
        declares && !decides && maps.iter().all(|map| map.0.is_empty())
    }

    /// The place of what the source begins with.
    fn first_word(&self) -> Span {
        let start = self.first();
        Span::new(start, start + 1)
    }

    pub(super) fn erratum(&self, raw: Raw<'a>) -> Result<Erratum> {
        let ron: ErratumRon = self.get(raw)?;
        Ok(Erratum { number: ron.no, printed: ron.printed, meant: ron.meant })
    }

    fn hit_policy(&self, raw: Raw<'a>) -> Result<Spanned<HitPolicy>> {
        let value = match self.shape(raw) {
            Shape::Word("First") => HitPolicy::First,
            Shape::Word("Unique") => HitPolicy::Unique,
            Shape::Word("Collect") => HitPolicy::Collect,
            _ => {
                return Err(Diagnostic::error(codes::STRUCTURE, "unknown hit policy")
                    .at(self.span(raw), "expected `First`, `Unique` or `Collect`")
                    .help("First: the first matching case decides. Unique: no two cases match, or they agree")
                    .help("Collect: the items of all matching cases, in order"));
            }
        };
        Ok(Spanned::new(self.span(raw), value))
    }

    fn levels(&self, map: &RawMap<'a>) -> Result<Vec<Level>> {
        map.0.iter().map(|(name, code)| Ok(Level { name: self.word(*name)?, code: self.spanned(*code)? })).collect()
    }

    /// `"corners": ["c0", "c1", "c2", "c3"]`
    fn group(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<Group> {
        let members = self.get::<Vec<Raw<'a>>>(raw)?.into_iter().map(|member| self.word(member));
        let (name, members) = (self.word(name)?, members.collect::<Result<Vec<_>>>()?);
        if members.is_empty() {
            return Err(Diagnostic::error(codes::STRUCTURE, format!("the group `{}` is empty", name.value))
                .at(self.span(raw), "expected the names of inputs")
                .help("write the inputs in the order of the letters of a pattern, as in [\"c0\", \"c1\", \"c2\"]"));
        }
        Ok(Group { name, members })
    }

    fn input(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<Input> {
        let span = self.span(raw);
        let (domain, doc, fetched, default) = match self.get::<InputRon<'a>>(raw)? {
            InputRon::Levels { values, of, doc, fetched, default } => {
                let domain = match (values, of) {
                    (Some(values), None) => Domain::Levels(self.levels(&values)?),
                    (None, Some(of)) => Domain::LevelsOf(self.word(of)?),
                    _ => {
                        return Err(Diagnostic::error(codes::STRUCTURE, "`Levels` needs either `values` or `of`")
                            .at(span, "give exactly one of the two")
                            .help("Levels(values: {\"off\": 0, \"on\": 1}) or Levels(of: \"name of a level set or input\")"));
                    }
                };
                (domain, doc, fetched, default)
            }
            InputRon::Bool { doc, fetched, default } => (Domain::Bool, doc, fetched, default),
            InputRon::Int { from, to, doc, fetched, default } => (Domain::Int(from, to), doc, fetched, default),
            InputRon::U32 { doc, fetched, default } => (Domain::U32, doc, fetched, default),
            InputRon::Range { from, to, unit, doc, fetched, default } => {
                (Domain::Range(from, to, unit), doc, fetched, default)
            }
        };
        let fetched =
            fetched.map(|raw| Ok(Spanned::new(self.span(raw), self.get::<FetchedRon>(raw)?.cost))).transpose()?;
        let default = default.map(|raw| self.level_or_expr(raw)).transpose()?;
        let (name, parameters) = match self.word(name)? {
            word if word.value.contains('(') => self.called(name, "a fetch with arguments", "\"light(dx, dy)\"")?,
            word => (word, Vec::new()),
        };
        Ok(Input { name, domain: Spanned::new(span, domain), doc, fetched, parameters, default })
    }

    /// A level by its quoted or bare name, or an expression.
    fn level_or_expr(&self, raw: Raw<'a>) -> Result<Expr> {
        match self.shape(raw) {
            Shape::Word(word) => Ok(Expr { span: self.span(raw), kind: ExprKind::Name(word.to_owned()) }),
            Shape::Variant(word) => {
                Err(Diagnostic::error(codes::STRUCTURE, "expected a level, a constant or an expression")
                    .at(self.span(raw), format!("more than the word `{word}`"))
                    .help("a bare word stands alone, an expression stands in quotes"))
            }
            _ => self.expr(raw),
        }
    }

    pub(super) fn assumption(&self, name: Raw<'a>, raw: Raw<'a>) -> Result<Assumption> {
        let name = self.word(name)?;
        let (condition, doc) = match self.shape(raw) {
            Shape::Tuple => {
                let (condition, doc): (Raw<'a>, String) = self.get(raw)?;
                (condition, doc)
            }
            _ => (raw, String::new()),
        };
        Ok(Assumption { name, condition: self.condition(condition)?, doc })
    }

    /// `(code: "U0508", with: ["lines 1 and 2"], reason: "the text orders them so")`
    fn allow(&self, raw: Raw<'a>) -> Result<Allow> {
        let ron: AllowRon<'a> = self.get(raw)?;
        let with = ron.with.map(|with| with.into_iter().map(|thing| self.spanned(thing)).collect::<Result<_>>());
        let code = self.spanned(ron.code)?;
        let allow = Allow { span: self.span(raw), code, with: with.transpose()?, reason: ron.reason };
        if allow.reason.trim().is_empty() {
            return Err(Diagnostic::error(codes::STRUCTURE, "`allow` without a reason")
                .at(allow.span, "the reason is empty")
                .help("say why the finding stays: (code: \"U0508\", reason: \"the source orders them so\")"));
        }
        Ok(allow)
    }

    pub(super) fn case(&self, raw: Raw<'a>) -> Result<Case> {
        let span = self.span(raw);
        let ron: CaseRon<'a> = self.get(raw)?;
        let id = self.spanned::<u32>(ron.id)?;
        let shape = |message: &str| {
            Err(Diagnostic::error(codes::CASE_SHAPE, format!("case {}: {message}", id.value))
                .at(span, "this case")
                .help("a case has `when` with `value` or `lines`, or it has `is` alone"))
        };
        let images = ron.images.into_iter().map(|name| self.word(name)).collect::<Result<Vec<_>>>()?;
        if let (Some(image), Some(_)) = (images.first(), ron.is) {
            return Err(Diagnostic::error(
                codes::CASE_SHAPE,
                format!("case {}: an image has no images of its own", id.value),
            )
            .at(image.span, "`images` stand with a guard and a value")
            .help("name all symmetries in the `images` of the case that is written out"));
        }
        let body = match (ron.when, ron.value, ron.lines, ron.is) {
            (Some(when), Some(value), None, None) => CaseBody::Rows {
                when: self.condition(when)?,
                lines: vec![Line { value: self.expr(value)?, condition: None }],
                images,
            },
            (Some(when), None, Some(lines), None) => {
                let lines = lines.into_iter().map(|line| self.line(line)).collect::<Result<Vec<_>>>()?;
                if lines.is_empty() {
                    return shape("`lines` is empty");
                }
                let always = |line: &Line| match &line.condition {
                    None => true,
                    Some(condition) => condition.kind == ExprKind::Name("true".to_owned()),
                };
                if let Some([last, beyond, ..]) = lines.iter().position(always).map(|at| &lines[at..]) {
                    let message = format!("case {}: a line that is never reached", id.value);
                    return Err(Diagnostic::error(codes::CASE_SHAPE, message)
                        .at(beyond.value.span, "this line")
                        .at(last.value.span, "this one always applies")
                        .help("the first line that applies counts; a line without a condition comes last"));
                }
                CaseBody::Rows { when: self.condition(when)?, lines, images }
            }
            (None, None, None, Some(is)) => {
                let image: ImageOfRon<'a> = self.get(is)?;
                let names = match self.shape(image.under) {
                    Shape::List => self.get::<Vec<Raw<'a>>>(image.under)?,
                    _ => vec![image.under],
                };
                if names.is_empty() {
                    return Err(Diagnostic::error(
                        codes::CASE_SHAPE,
                        format!("case {} is an image under nothing", id.value),
                    )
                    .at(self.span(image.under), "expected the name of a symmetry, or several in a list"));
                }
                let under = names.into_iter().map(|name| self.word(name)).collect::<Result<_>>()?;
                CaseBody::Image { case: self.spanned(image.case)?, under, span: self.span(image.under) }
            }
            (None, None, None, None) => return shape("has neither guard nor value"),
            (None, ..) => return shape("has no guard (`when`)"),
            (Some(_), None, None, None) => return shape("has no value"),
            _ => return shape("fields that exclude each other"),
        };
        let errata = ron.errata.into_iter().map(|e| Erratum { number: e.no, printed: e.printed, meant: e.meant });
        let examples = ron.examples.into_iter().map(|e| self.example(e)).collect::<Result<_>>()?;
        let allow = ron.allow.into_iter().map(|a| self.allow(a)).collect::<Result<_>>()?;
        Ok(Case { id, span, section: ron.section, doc: ron.doc, body, errata: errata.collect(), examples, allow })
    }

    /// `("px + py - 1", "NB == left")`: a value and when it applies.
    pub(super) fn line(&self, raw: Raw<'a>) -> Result<Line> {
        match self.shape(raw) {
            Shape::Tuple => {
                let (value, condition): (Raw<'a>, Raw<'a>) = self.get(raw)?;
                Ok(Line { value: self.expr(value)?, condition: Some(self.condition(condition)?) })
            }
            _ => Ok(Line { value: self.expr(raw)?, condition: None }),
        }
    }

    /// `({"dH": 0.75, "V": "top"}, 0.5)`: inputs and the expected value.
    pub(super) fn example(&self, raw: Raw<'a>) -> Result<Example> {
        let (inputs, value): (RawMap<'a>, Raw<'a>) = self.get(raw)?;
        let inputs =
            inputs.0.iter().map(|(n, v)| Ok((self.word(*n)?, self.level_or_expr(*v)?))).collect::<Result<_>>()?;
        Ok(Example { span: self.span(raw), inputs, value: self.level_or_expr(value)? })
    }
}
