//! Drawings: panels of the atlas, and the matrix of coverage.

use serde_json::json;
use umbrage::atlas::{Atlas, PANEL_WIDTH, Shown};
use umbrage::diag::Failure;
use umbrage::program::{InputId, Program};
use umbrage::report;

use crate::decision;
use crate::message::Message;

/// The panel of a row.
pub(crate) fn panel(program: &Program, message: &Message) -> Result<Message, Failure> {
    let row = message.number("row");
    if row >= program.rows.len() {
        return Ok(Message::error("there is no such case"));
    }
    let panel = Atlas::panel(program, row, None)?;
    let name = |input: InputId| program.inputs[input.index()].name.as_str();
    let shown = panel.shown.as_ref().map(|Shown { point, across, down, place }| {
        json!({
            "point": decision::words(program, point), "place": place,
            "across": across.map(name), "down": down.map(name),
        })
    });
    Ok(Message::of(json!({ "svg": panel.svg(), "width": PANEL_WIDTH, "shown": shown })))
}

/// Every state in the colour of its case.
pub(crate) fn matrix(program: &Program) -> Message {
    Message::of(json!({ "html": report::matrix(program).into_string() }))
}
