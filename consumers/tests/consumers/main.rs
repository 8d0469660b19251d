//! What is generated is accepted where it is meant to be used.
#![allow(clippy::unwrap_used)]

mod modules;
mod pipeline;
mod tools;

use umbrage::program::{Domain, Input, LevelKind, Program};

/// A table that comes with Umbrage.
fn table(name: &str) -> Program {
    let path = format!("{}/../tables/{name}.ron", env!("CARGO_MANIFEST_DIR"));
    Program::read(path).unwrap_or_else(|error| panic!("{error}"))
}

/// The WGSL that a host supplies for fetched inputs.
fn host(program: &Program) -> String {
    let fetched: Vec<&Input> = program.inputs.iter().filter(|input| input.fetched.is_some()).collect();
    if fetched.is_empty() {
        return String::new();
    }
    let (lower, camel) = (&program.name, camel(program));
    let mut out = format!("struct {camel}Site {{ texel: u32, }}\n");
    for input in fetched {
        let (ty, value) = match &input.domain {
            Domain::Discrete(levels) if levels.kind == LevelKind::Bool => ("bool", "site.texel == 1u"),
            Domain::Discrete(_) => ("u32", "site.texel & 1u"),
            Domain::Continuous { .. } => ("f32", "f32(site.texel)"),
            Domain::Word => ("u32", "site.texel"),
        };
        out += &format!("fn {lower}_fetch_{}(site: {camel}Site) -> {ty} {{ return {value}; }}\n", input.ident);
    }
    out
}

fn camel(program: &Program) -> String {
    program.name[..1].to_uppercase() + &program.name[1..]
}

/// The arguments of `…_key`, all the same number, and a site if there is one.
fn arguments(program: &Program, number: &str, site: &str) -> String {
    let plain = program.inputs.iter().filter(|input| input.fetched.is_none());
    let count = plain.filter(|input| matches!(input.domain, Domain::Continuous { .. })).count();
    let site = if host(program).is_empty() { String::new() } else { format!(", {site}") };
    format!("{}{site}", vec![number; count].join(", "))
}
