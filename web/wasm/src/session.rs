//! A session: the texts that came with the page, the table as it was last checked, and who answers what.

use serde_json::{Value as Json, json};
use umbrage::diag::{Failure, Source};
use umbrage::emit::Target;
use umbrage::explain::code;
use umbrage::format;
use umbrage::plan::Shape;
use umbrage::program::Program;

use crate::checked::{self, Checked};
use crate::message::Message;
use crate::places::Places;
use crate::{code as generated, decision, panel, run};

/// Texts that tables may import, by path. They stay as long as the module.
pub(crate) type Library = &'static [(&'static str, &'static str)];

/// All that is remembered between messages.
#[derive(Default)]
pub(crate) struct Session {
    library: Library,
    checked: Option<Checked>,
}

impl Session {
    /// Answers a message. What it asks for is named by `do`.
    pub(crate) fn answer(&mut self, message: &Message) -> Message {
        match message.text("do") {
            "begin" => self.begin(message),
            "check" => {
                let (checked, answer) = checked::check(message.text("name"), message.text("text"), self.library);
                self.checked = checked;
                Message::of(answer)
            }
            "format" => Message::of(formatted(message.text("name"), message.text("text"))),
            "article" => Message::of(article(message.text("code"))),
            "panel" => self.of_program(message, panel::panel),
            "matrix" => self.of_program(message, |program, _| Ok(panel::matrix(program))),
            "explain" => {
                self.of_program(message, |program, message| decision::explain(program, &message.json["point"]))
            }
            "state" => self.of_program(message, |program, message| decision::state(program, message.number("state"))),
            "code" => self.of_table(|checked| generated::code(&checked.programs, message)),
            "run" => self.of_program(message, run::run),
            "judge" => self.of_program(message, run::judge),
            other => Message::error(&format!("nobody answers `{other}`")),
        }
    }

    /// Takes the texts, and says which plans and targets there are.
    fn begin(&mut self, message: &Message) -> Message {
        let keep = |text: &str| -> &'static str { String::leak(text.to_owned()) };
        let pair = |pair: &Json| Some((keep(pair[0].as_str()?), keep(pair[1].as_str()?)));
        let texts: Vec<_> = message.json["texts"].as_array().into_iter().flatten().filter_map(pair).collect();
        self.library = Vec::leak(texts);
        let plans = Shape::ALL.map(|shape| json!({ "name": shape.name(), "summary": shape.summary() }));
        let targets = Target::ALL.map(|target| json!({ "name": target.name(), "extension": target.extension() }));
        Message::of(json!({ "version": env!("CARGO_PKG_VERSION"), "plans": plans, "targets": targets }))
    }

    fn of_table(&self, answer: impl FnOnce(&Checked) -> Result<Message, Failure>) -> Message {
        let Some(checked) = &self.checked else { return Message::error("there is no table that means anything") };
        answer(checked).unwrap_or_else(|failure| {
            let places = Places::new(&failure.source);
            let all: Vec<_> = failure.diagnostics.iter().map(|one| places.diagnostic(one)).collect();
            Message::of(json!({ "diagnostics": all }))
        })
    }

    /// Asks about the program that the message names by its number.
    fn of_program(
        &self,
        message: &Message,
        answer: impl FnOnce(&Program, &Message) -> Result<Message, Failure>,
    ) -> Message {
        self.of_table(|checked| match checked.programs.get(message.number("program")) {
            Some(program) => answer(program, message),
            None => Ok(Message::error("there is no such function")),
        })
    }
}

/// A table laid out, or why it is none.
fn formatted(name: &str, text: &str) -> Json {
    let source = Source::new(name, text);
    match format::format(&source) {
        Ok(text) => json!({ "text": text }),
        Err(failure) => {
            let places = Places::new(&source);
            json!({ "diagnostics": failure.diagnostics.iter().map(|one| places.diagnostic(one)).collect::<Vec<_>>() })
        }
    }
}

/// A code at length.
fn article(word: &str) -> Json {
    code::entry(word).map_or_else(
        || json!({ "error": "there is no such code" }),
        |entry| json!({ "code": entry.code, "meaning": entry.meaning, "text": entry.text }),
    )
}
