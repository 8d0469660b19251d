//! Generated code.

use serde_json::json;
use umbrage::diag::{Diagnostic, Failure, codes};
use umbrage::emit::{self, Target};
use umbrage::plan::{Plan, Shape};
use umbrage::program::Program;
use umbrage::prove::Proved;

use crate::message::Message;

/// The plan that a message names.
pub(crate) fn proved<'p>(program: &'p Program, message: &Message) -> Result<Proved<'p>, Failure> {
    let name = message.text("plan");
    let unknown = || {
        Failure::new(program.source.clone(), Diagnostic::error(codes::NOT_APPLICABLE, format!("`{name}` is no plan")))
    };
    Plan::proved(program, Shape::from_name(name).ok_or_else(unknown)?)
}

/// The file of a plan in a language, validated: text, or bytes of what is none.
pub(crate) fn code(programs: &[Program], message: &Message) -> Result<Message, Failure> {
    let Some(target) = Target::from_name(message.text("target")) else {
        return Ok(Message::error("there is no such target"));
    };
    let plans = programs.iter().map(|program| proved(program, message)).collect::<Result<Vec<_>, _>>()?;
    let bytes = emit::emit_all(&plans, target, &[])?;
    Ok(match String::from_utf8(bytes) {
        Ok(text) if target != Target::SpirV => Message::of(json!({ "text": text })),
        Ok(text) => Message::of(json!({})).with("bytes", text.as_bytes()),
        Err(error) => Message::of(json!({})).with("bytes", error.as_bytes()),
    })
}
