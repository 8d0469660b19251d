//! Inputs in generated code: their types, and the functions of the host that fetch them.

use crate::program::{Domain, Input, LevelKind, Program, Scalar};

/// The type of an input; `levels` is that of named and integer levels.
pub(super) fn input_type(domain: &Domain, levels: Scalar) -> Scalar {
    match domain {
        Domain::Discrete(l) if l.kind == LevelKind::Bool => Scalar::Bool,
        // What comes in is the integer itself.
        Domain::Discrete(l) if l.classes.is_some() && levels == Scalar::Float => Scalar::Int,
        Domain::Discrete(_) => levels,
        Domain::Continuous { .. } => Scalar::Float,
        Domain::Word => Scalar::Word,
    }
}

/// The type in which the host gives a fetched input: integers as they are, other levels as their index.
pub(super) fn fetched_type(domain: &Domain) -> Scalar {
    match domain {
        Domain::Discrete(levels) if levels.classes.is_some() => Scalar::Int,
        Domain::Discrete(_) | Domain::Continuous { .. } | Domain::Word => input_type(domain, Scalar::Uint),
    }
}

/// A function of the host.
pub(super) struct Fetch {
    /// Its name, without what all of them begin with.
    pub(super) ident: String,
    /// The type of what it returns.
    pub(super) scalar: Scalar,
    /// The arguments that it takes, besides the site.
    pub(super) parameters: Vec<String>,
    /// The calls of it: the place of each among all inputs that are fetched, and its arguments.
    pub(super) calls: Vec<(usize, Vec<f32>)>,
}

impl Fetch {
    /// The arguments as the end of a list of parameters, such as `, dx: f32`; `declare` says one.
    pub(super) fn parameters(&self, declare: impl Fn(&str) -> String) -> String {
        self.parameters.iter().map(|name| format!(", {}", declare(name))).collect()
    }
}

/// The name of the function that fetches an input, without what all of them begin with.
pub(super) fn fetch_ident(input: &Input) -> &str {
    input.call.as_ref().map_or(&input.ident, |call| &call.ident)
}

/// The functions of the host, in the order declared.
pub(super) fn fetches(program: &Program) -> Vec<Fetch> {
    let mut all: Vec<Fetch> = Vec::new();
    for (place, input) in program.inputs.iter().filter(|input| input.fetched.is_some()).enumerate() {
        let arguments = input.call.as_ref().map_or(Vec::new(), |call| call.arguments.clone());
        match all.iter_mut().find(|fetch| fetch.ident == fetch_ident(input)) {
            Some(known) => known.calls.push((place, arguments)),
            None => all.push(Fetch {
                ident: fetch_ident(input).to_owned(),
                scalar: fetched_type(&input.domain),
                parameters: input.call.as_ref().map_or(Vec::new(), |call| call.parameters.clone()),
                calls: vec![(place, arguments)],
            }),
        }
    }
    all
}

/// The inputs that are passed beside the key: those without levels that are not fetched, in the order declared.
pub(super) fn beside_the_key(program: &Program) -> impl Iterator<Item = &Input> {
    program.inputs.iter().filter(|input| input.fetched.is_none() && input.domain.range().is_some())
}
