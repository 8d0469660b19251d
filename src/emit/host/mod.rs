//! The Rust side of a table: what a program needs around the functions to call
//! them, and to hand their inputs to a shader.
//!
//! Levels as enumerations, the key made of them, inputs as a structure with the
//! layout of shaders, the cases in words, and the shaders that lie beside the
//! file as constants. Nothing here computes a result: that is the functions'.

pub(crate) mod wgpu;

use super::inputs::{beside_the_key, fetched_type, fetches};
use super::language::rust::Rust;
use super::language::{Dialect, Prefix, Type, structures};
use super::module;
use super::names::Names;
use super::text::{Text, harmless};
use crate::plan::KeyLayout;
use crate::program::{Domain, Input, LevelKind, Program, Scalar};
use crate::prove::Proved;

/// The extras of a Rust module besides its functions. Each has all that the one before it has.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Host {
    /// Needs no other crate.
    Plain,
    /// Inputs that are bytes, by the crate `bytemuck`.
    Bytemuck,
    /// A pipeline, by the crate `wgpu`.
    Wgpu,
}

/// The Rust modules of plans, one after the other, with the constants that embed the shaders beside them.
pub(super) fn modules(plans: &[Proved<'_>], host: Host, embedded: &[String]) -> String {
    let mut out = String::new();
    for (index, proved) in plans.iter().enumerate() {
        if index > 0 {
            out.push('\n');
        }
        out += &module::write(proved, &Rust);
        let mut text = Text::default();
        let program = proved.plan().program;
        let side = Side { proved, program, prefix: Prefix::new(&program.name), names: Names::new(program), host };
        side.write(&mut text);
        if program.function.is_none() {
            sources(&mut text, embedded);
        }
        out += &text.finish();
        out += "}\n";
    }
    let table = plans.first().map(|proved| proved.plan().program).filter(|program| program.function.is_some());
    if let Some(table) = table.filter(|_| !embedded.is_empty()) {
        // The functions share their files.
        let mut text = Text::default();
        text.gap();
        text.open(format!("#[allow(dead_code, missing_docs, unreachable_pub)]\npub mod {} {{", table.table()));
        sources(&mut text, embedded);
        text.close();
        out += &text.finish();
    }
    out
}

fn sources(text: &mut Text, embedded: &[String]) {
    if embedded.is_empty() {
        return;
    }
    text.comment("The shaders, made from the same table.");
    text.open("pub mod source {");
    for constant in embedded {
        text.line(constant);
    }
    text.close();
}

/// The module that is being written.
pub(super) struct Side<'a, 'p> {
    pub(super) proved: &'a Proved<'p>,
    pub(super) program: &'p Program,
    pub(super) prefix: Prefix,
    names: Names,
    host: Host,
}

impl Side<'_, '_> {
    fn write(&self, text: &mut Text) {
        self.cases(text);
        let enumerations = self.enumerations();
        for (index, enumeration) in enumerations.iter().enumerate() {
            self.enumeration(text, index, enumeration);
        }
        self.key_of(text, &enumerations);
        self.inputs(text);
        if self.host == Host::Wgpu {
            wgpu::write(self, text);
        }
    }

    /// The numbers of cases, in words.
    fn cases(&self, text: &mut Text) {
        let (upper, lower) = (&self.prefix.upper, &self.prefix.lower);
        text.doc("The cases, as the table describes them.");
        text.open(format!("pub const {upper}_CASES: [(u32, &str); {}] = [", self.program.rows.len()));
        for row in &self.program.rows {
            text.line(format!("({}, {}),", row.id, literal(&row.doc)));
        }
        text.close_with("];");
        text.gap();
        text.doc("What a case is; nothing where none matched.");
        text.open(format!("pub fn {lower}_case_name(case_id: u32) -> Option<&'static str> {{"));
        text.line(format!("{upper}_CASES.iter().find(|(id, _)| *id == case_id).map(|(_, name)| *name)"));
        text.close();
        text.gap();
    }

    /// The names of the enumerations, one per set of levels.
    fn enumerations(&self) -> Vec<String> {
        let camel = &self.prefix.camel;
        let own = ["Result", "Value", "Site", "Inputs", "Fetched", "Pipeline"].map(|name| format!("{camel}{name}"));
        let parts = structures(&Rust, &self.prefix, &self.program.output.data_type());
        let mut taken: Vec<String> = own.into_iter().chain(parts.into_iter().map(|(name, _)| name)).collect();
        let own = taken.len();
        for set in &self.names.sets {
            let mut name = format!("{camel}{}", capitals(&set.name));
            while taken.contains(&name) {
                name.push_str("Level");
            }
            taken.push(name);
        }
        taken.split_off(own)
    }

    fn enumeration(&self, text: &mut Text, index: usize, name: &str) {
        let set = &self.names.sets[index];
        let mut variants: Vec<String> = Vec::new();
        for level in &set.levels.names {
            let mut variant = match set.levels.kind {
                LevelKind::Int if set.levels.is_wide() => format!("Level{}", capitals(level)),
                LevelKind::Int => format!("Level{}", level.replace('-', "Minus")),
                LevelKind::Named | LevelKind::Bool => capitals(level),
            };
            while variants.contains(&variant) || variant == "Self" {
                variant.push('_');
            }
            variants.push(variant);
        }
        text.doc(&format!("Levels of {}.", set.name));
        text.line("#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]\n#[repr(u32)]");
        text.open(format!("pub enum {name} {{"));
        for (index, variant) in variants.iter().enumerate() {
            text.line(format!("{variant} = {index},"));
        }
        text.close();
        text.open(format!("impl {name} {{"));
        let all: Vec<String> = variants.iter().map(|variant| format!("Self::{variant}")).collect();
        text.doc("In the order of their numbers.");
        text.line(format!("pub const ALL: [Self; {}] = [{}];", all.len(), all.join(", ")));
        text.doc("Its name in the table.");
        text.open("pub fn name(self) -> &'static str {\n    match self {");
        for (variant, name) in all.iter().zip(&set.levels.names) {
            text.line(format!("    {variant} => {},", literal(name)));
        }
        text.close_with("    }\n}");
        if set.levels.classes.is_some() {
            text.doc("The integer that it is, or the smallest one of its class.");
            text.open("pub fn integer(self) -> i32 {\n    match self {");
            for (variant, code) in all.iter().zip(&set.levels.codes) {
                text.line(format!("    {variant} => {},", *code as i64));
            }
            text.close_with("    }\n}");
            text.doc("The one that an integer is, or is one of.");
            text.open("pub fn of(integer: i32) -> Self {");
            let function = Rust.global(&self.prefix, &format!("{}_level", set.name));
            text.line(format!("Self::ALL[{function}(integer) as usize]"));
            text.close();
            text.close();
            text.gap();
            return;
        }
        text.doc("The number that stands for it where levels are passed as `f32`.");
        text.open("pub fn code(self) -> f32 {\n    match self {");
        for (variant, code) in all.iter().zip(&set.levels.codes) {
            text.line(format!("    {variant} => {},", Rust.number(*code)));
        }
        text.close_with("    }\n}");
        text.doc("The level whose code is nearest.");
        text.open("pub fn from_code(code: f32) -> Self {");
        text.line(format!("Self::ALL[{}(code) as usize]", Rust.global(&self.prefix, &format!("{}_level", set.name))));
        text.close();
        text.close();
        text.gap();
    }

    /// The key of a state, made of levels as enumerations.
    fn key_of(&self, text: &mut Text, enumerations: &[String]) {
        let key: &KeyLayout = &self.proved.plan().key;
        let mut parameters = Vec::new();
        let mut parts = Vec::new();
        for field in key.fields() {
            let input = &self.program.inputs[field.input.index()];
            let Domain::Discrete(levels) = &input.domain else { continue };
            let set = self.names.sets.iter().position(|known| known.levels == *levels);
            let (ty, value) = match set {
                Some(index) if levels.kind != LevelKind::Bool => {
                    (enumerations[index].clone(), format!("{} as u32", input.ident))
                }
                _ => ("bool".to_owned(), format!("u32::from({})", input.ident)),
            };
            parameters.push(format!("{}: {ty}", input.ident));
            parts.push(format!("(({value}) << {})", field.shift));
        }
        text.doc("The key of a state.");
        text.open(format!("pub fn {}_key_of({}) -> u32 {{", self.prefix.lower, parameters.join(", ")));
        text.line(if parts.is_empty() { "0".to_owned() } else { parts.join(" | ") });
        text.close();
        text.gap();
    }

    /// The parts of [`Self::inputs`] besides the key.
    fn continuous(&self) -> impl Iterator<Item = &Input> {
        beside_the_key(self.program)
    }

    fn inputs(&self, text: &mut Text) {
        let camel = &self.prefix.camel;
        text.doc("What one evaluation is given, in words of four bytes without gaps, as an array in a buffer.");
        self.structure(text, "Inputs", &self.fields());
        let (parameter, argument) = match fetches(self.program).is_empty() {
            true => (String::new(), String::new()),
            false => (format!(", site: {}", Rust.ty(&Type::Site, &self.prefix)), ", site".to_owned()),
        };
        let [.., key_case] = Rust.entry_names(&self.prefix);
        let numbers: String = self.continuous().map(|input| format!(", self.{}", input.ident)).collect();
        text.open(format!("impl {camel}Inputs {{"));
        text.doc("The result and the case.");
        text.open(format!("pub fn evaluate(self{parameter}) -> {} {{", self.prefix.result()));
        text.line(format!("{key_case}(self.key{numbers}{argument})"));
        text.close();
        text.close();
        text.gap();
    }

    fn fields(&self) -> Vec<(String, &'static str)> {
        let numbers = self
            .continuous()
            .map(|input| (input.ident.clone(), if input.domain == Domain::Word { "u32" } else { "f32" }));
        [("key".to_owned(), "u32")].into_iter().chain(numbers).collect()
    }

    /// The fetched inputs as fields.
    pub(super) fn fetched_fields(&self) -> Vec<(String, &'static str)> {
        let fetched = self.program.inputs.iter().filter(|input| input.fetched.is_some());
        let ty = |input: &Input| match fetched_type(&input.domain) {
            Scalar::Float => "f32",
            Scalar::Uint | Scalar::Bool | Scalar::Word => "u32",
            Scalar::Int => "i32",
        };
        fetched.map(|input| (input.ident.clone(), ty(input))).collect()
    }

    /// A structure with the layout of shaders.
    pub(super) fn structure(&self, text: &mut Text, name: &str, fields: &[(String, &'static str)]) {
        let bytes = if self.host >= Host::Bytemuck { ", bytemuck::Pod, bytemuck::Zeroable" } else { "" };
        text.line(format!("#[derive(Debug, Clone, Copy, PartialEq{bytes})]\n#[repr(C)]"));
        text.open(format!("pub struct {}{name} {{", self.prefix.camel));
        for (field, ty) in fields {
            text.line(format!("pub {field}: {ty},"));
        }
        text.close();
    }

    /// Returns whether the shader reads a lookup.
    pub(super) fn has_lookup(&self) -> bool {
        self.proved.plan().reads_lookup()
    }
}

/// A word of the table as the name of a type or variant.
fn capitals(word: &str) -> String {
    Prefix::new(word).camel
}

/// A text as a literal of Rust.
fn literal(text: &str) -> String {
    format!("\"{}\"", harmless(text).replace('"', "\\\""))
}
