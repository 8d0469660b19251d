//! The conversation: who asks for what, and in which order that may be.

use std::collections::BTreeMap;
use std::io::BufRead;

use lsp_server::{ErrorCode, Message, Notification, Request, RequestId, Response};
use lsp_types::notification::{
    DidChangeTextDocument, DidCloseTextDocument, DidOpenTextDocument, DidSaveTextDocument, LogMessage,
    Notification as _, ShowMessage,
};
use lsp_types::request::{
    CodeActionRequest, Completion, DocumentHighlightRequest, DocumentSymbolRequest, Formatting, GotoDefinition,
    HoverRequest, Initialize, PrepareRenameRequest, References, Rename, Request as _,
};
use lsp_types::{
    CodeActionKind, CodeActionOptions, CodeActionProviderCapability, CompletionOptions, DocumentSymbolResponse,
    GotoDefinitionResponse, HoverProviderCapability, InitializeParams, InitializeResult, LogMessageParams, MessageType,
    OneOf, PositionEncodingKind, PrepareRenameResponse, RenameOptions, ServerCapabilities, ServerInfo,
    ShowMessageParams, TextDocumentPositionParams, TextDocumentSyncCapability, TextDocumentSyncKind,
    TextDocumentSyncOptions, TextDocumentSyncSaveOptions, TextEdit, Uri,
};
use serde::de::DeserializeOwned;

use super::diagnose::Checker;
use super::document::Document;
use super::place::Encoding;
use super::settings::Settings;
use super::transport::{self, Frame, Outlet};
use super::{End, complete, hover, navigate, outline, rename, repair};
use crate::diag::Span;
use crate::format;

/// Malformed messages one after the other, after which nothing sensible is expected any more.
const MOST_MALFORMED: usize = 16;

/// One conversation.
pub(super) struct Server {
    outlet: Outlet,
    settings: Settings,
    /// The thread that checks, once the client has introduced itself.
    checker: Option<Checker>,
    documents: BTreeMap<String, Document>,
    shut_down: bool,
}

/// Why a request has no result.
struct Refusal(ErrorCode, String);

type Answer = Result<serde_json::Value, Refusal>;

impl Server {
    pub(super) fn new(outlet: Outlet) -> Self {
        Self { outlet, settings: Settings::default(), checker: None, documents: BTreeMap::new(), shut_down: false }
    }

    /// Answers until the client says goodbye, goes away, or sends what nobody can read.
    pub(super) fn run(&mut self, mut input: impl BufRead) -> End {
        let mut malformed = 0;
        loop {
            let message = match transport::read(&mut input) {
                Ok(Frame::Message(message)) => message,
                Ok(Frame::Malformed(reason)) => {
                    malformed += 1;
                    if malformed > MOST_MALFORMED {
                        return End::Nonsense(reason);
                    }
                    self.complain(&format!("a message that is none: {reason}"));
                    continue;
                }
                Ok(Frame::End) => return End::Early,
                Err(reason) => return End::Nonsense(reason),
            };
            malformed = 0;
            match message {
                Message::Request(request) => {
                    let response = self.answer(request);
                    if self.outlet.send(response).is_err() {
                        return End::Early;
                    }
                }
                Message::Notification(notification) if notification.method == "exit" => {
                    return if self.shut_down { End::Orderly } else { End::Early };
                }
                Message::Notification(notification) => self.hear(notification),
                // Nothing is asked of the client.
                Message::Response(_) => {}
            }
        }
    }

    fn complain(&self, message: &str) {
        let params = LogMessageParams { typ: MessageType::WARNING, message: message.to_owned() };
        self.outlet.notify::<LogMessage>(&params);
    }

    /// Answers a request.
    fn answer(&mut self, request: Request) -> Response {
        let Request { id, method, params } = request;
        let answer = match (method.as_str(), &self.checker) {
            (Initialize::METHOD, None) => read(params).and_then(|params| self.initialize(&params)),
            (Initialize::METHOD, Some(_)) => Err(Refusal(ErrorCode::InvalidRequest, "introduced already".to_owned())),
            (_, None) => Err(Refusal(ErrorCode::ServerNotInitialized, "expected `initialize`".to_owned())),
            _ if self.shut_down => Err(Refusal(ErrorCode::InvalidRequest, "shut down already".to_owned())),
            ("shutdown", _) => {
                self.shut_down = true;
                Ok(serde_json::Value::Null)
            }
            (method, _) => self.of_document(method, params),
        };
        respond(id, answer)
    }

    fn initialize(&mut self, params: &InitializeParams) -> Answer {
        let (settings, wrong) = Settings::of(params);
        let checker = Checker::start(settings.clone(), self.outlet.clone());
        self.checker = Some(checker.map_err(|error| Refusal(ErrorCode::InternalError, error.to_string()))?);
        self.settings = settings;
        if !wrong.is_empty() {
            let params = ShowMessageParams { typ: MessageType::WARNING, message: wrong.join("\n") };
            self.outlet.notify::<ShowMessage>(&params);
        }
        written(InitializeResult {
            capabilities: capabilities(self.settings.encoding),
            server_info: Some(ServerInfo {
                name: "umbrage".to_owned(),
                version: Some(env!("CARGO_PKG_VERSION").to_owned()),
            }),
        })
    }

    /// Answers what is asked of a text.
    fn of_document(&self, method: &str, params: serde_json::Value) -> Answer {
        let settings = &self.settings;
        match method {
            HoverRequest::METHOD => {
                let (document, offset) = self.place(&params)?;
                written(hover::hover(document, offset, settings))
            }
            Completion::METHOD => {
                let (document, offset) = self.place(&params)?;
                written(complete::complete(document, offset, settings))
            }
            GotoDefinition::METHOD => {
                let (document, offset) = self.place(&params)?;
                written(GotoDefinitionResponse::Array(navigate::definitions(document, offset, settings)))
            }
            References::METHOD => {
                let (document, offset) = self.place(&params)?;
                let params: lsp_types::ReferenceParams = read(params)?;
                written(navigate::references(document, offset, params.context.include_declaration))
            }
            DocumentHighlightRequest::METHOD => {
                let (document, offset) = self.place(&params)?;
                written(navigate::highlights(document, offset))
            }
            PrepareRenameRequest::METHOD => {
                let (document, offset) = self.place(&params)?;
                let (range, placeholder) = rename::prepare(document, offset).map_err(refused)?;
                written(PrepareRenameResponse::RangeWithPlaceholder { range, placeholder })
            }
            Rename::METHOD => {
                let (document, offset) = self.place(&params)?;
                let params: lsp_types::RenameParams = read(params)?;
                written(rename::rename(document, offset, &params.new_name).map_err(refused)?)
            }
            DocumentSymbolRequest::METHOD => {
                let params: lsp_types::DocumentSymbolParams = read(params)?;
                let document = self.document(&params.text_document.uri)?;
                written(DocumentSymbolResponse::Nested(outline::outline(document)))
            }
            Formatting::METHOD => {
                let params: lsp_types::DocumentFormattingParams = read(params)?;
                written(formatted(self.document(&params.text_document.uri)?)?)
            }
            CodeActionRequest::METHOD => {
                let params: lsp_types::CodeActionParams = read(params)?;
                let document = self.document(&params.text_document.uri)?;
                let found = self.checker.as_ref().and_then(|checker| checker.found.lock().ok());
                let found = found.as_ref().and_then(|found| found.get(document.uri.as_str()));
                // Of an older text the places would be wrong.
                let found =
                    found.filter(|(version, _)| *version == document.version).map(|(_, found)| found.as_slice());
                written(repair::actions(document, found.unwrap_or_default(), &params, settings))
            }
            method => Err(Refusal(ErrorCode::MethodNotFound, format!("`{method}` is not offered"))),
        }
    }

    /// The text and place that a request is about.
    fn place(&self, params: &serde_json::Value) -> Result<(&Document, usize), Refusal> {
        let params: TextDocumentPositionParams = read(params.clone())?;
        let document = self.document(&params.text_document.uri)?;
        Ok((document, document.offset(params.position)))
    }

    fn document(&self, uri: &Uri) -> Result<&Document, Refusal> {
        let missing = || Refusal(ErrorCode::InvalidParams, format!("`{}` is not open", uri.as_str()));
        self.documents.get(uri.as_str()).ok_or_else(missing)
    }

    /// Takes note of what a client tells.
    fn hear(&mut self, notification: Notification) {
        let Some(checker) = &self.checker else { return };
        let Notification { method, params } = notification;
        let heard = match method.as_str() {
            DidOpenTextDocument::METHOD => read(params).map(|params: lsp_types::DidOpenTextDocumentParams| {
                let text = params.text_document;
                let document = Document::new(text.uri, text.version, text.text, self.settings.encoding);
                checker.check(&document.uri, document.version, &document.source);
                self.documents.insert(document.uri.as_str().to_owned(), document);
            }),
            DidChangeTextDocument::METHOD => read(params).map(|params: lsp_types::DidChangeTextDocumentParams| {
                if let Some(document) = self.documents.get_mut(params.text_document.uri.as_str()) {
                    document.change(params.text_document.version, params.content_changes);
                    checker.check(&document.uri, document.version, &document.source);
                }
            }),
            // What others import has changed.
            DidSaveTextDocument::METHOD => {
                for document in self.documents.values_mut() {
                    document.read();
                    checker.check(&document.uri, document.version, &document.source);
                }
                Ok(())
            }
            DidCloseTextDocument::METHOD => read(params).map(|params: lsp_types::DidCloseTextDocumentParams| {
                if let Some(document) = self.documents.remove(params.text_document.uri.as_str()) {
                    checker.close(&document.uri);
                }
            }),
            _ => Ok(()),
        };
        if let Err(Refusal(_, reason)) = heard {
            self.complain(&format!("`{method}` that cannot be read: {reason}"));
        }
    }
}

/// The abilities of this server.
fn capabilities(encoding: Encoding) -> ServerCapabilities {
    ServerCapabilities {
        position_encoding: Some(match encoding {
            Encoding::Utf8 => PositionEncodingKind::UTF8,
            Encoding::Utf16 => PositionEncodingKind::UTF16,
        }),
        text_document_sync: Some(TextDocumentSyncCapability::Options(TextDocumentSyncOptions {
            open_close: Some(true),
            change: Some(TextDocumentSyncKind::INCREMENTAL),
            save: Some(TextDocumentSyncSaveOptions::Supported(true)),
            ..TextDocumentSyncOptions::default()
        })),
        hover_provider: Some(HoverProviderCapability::Simple(true)),
        completion_provider: Some(CompletionOptions {
            trigger_characters: Some(["\"", ".", ":", "("].map(str::to_owned).into()),
            ..CompletionOptions::default()
        }),
        definition_provider: Some(OneOf::Left(true)),
        references_provider: Some(OneOf::Left(true)),
        document_highlight_provider: Some(OneOf::Left(true)),
        document_symbol_provider: Some(OneOf::Left(true)),
        document_formatting_provider: Some(OneOf::Left(true)),
        rename_provider: Some(OneOf::Right(RenameOptions {
            prepare_provider: Some(true),
            work_done_progress_options: lsp_types::WorkDoneProgressOptions::default(),
        })),
        code_action_provider: Some(CodeActionProviderCapability::Options(CodeActionOptions {
            code_action_kinds: Some(vec![CodeActionKind::QUICKFIX]),
            ..CodeActionOptions::default()
        })),
        ..ServerCapabilities::default()
    }
}

/// The edit that lays a table out: from the first byte that changes to the last.
fn formatted(document: &Document) -> Result<Vec<TextEdit>, Refusal> {
    let before = &document.source.text;
    let after = format::format(&document.source).map_err(|failure| {
        let reason = failure.diagnostics.first().map_or(String::new(), |first| first.message.clone());
        Refusal(ErrorCode::RequestFailed, format!("not formatted: {reason}"))
    })?;
    if *before == after {
        return Ok(Vec::new());
    }
    let mut start = before.bytes().zip(after.bytes()).take_while(|(a, b)| a == b).count();
    while !before.is_char_boundary(start) || !after.is_char_boundary(start) {
        start -= 1;
    }
    let most = before.len().min(after.len()) - start;
    let same = before.bytes().rev().zip(after.bytes().rev()).take(most).take_while(|(a, b)| a == b).count();
    let mut behind = same;
    while !before.is_char_boundary(before.len() - behind) || !after.is_char_boundary(after.len() - behind) {
        behind -= 1;
    }
    let range = document.range(Span::new(start, before.len() - behind));
    Ok(vec![TextEdit::new(range, after[start..after.len() - behind].to_owned())])
}

fn read<T: DeserializeOwned>(params: serde_json::Value) -> Result<T, Refusal> {
    serde_json::from_value(params).map_err(|error| Refusal(ErrorCode::InvalidParams, error.to_string()))
}

fn written(result: impl serde::Serialize) -> Answer {
    serde_json::to_value(result).map_err(|error| Refusal(ErrorCode::InternalError, error.to_string()))
}

fn refused(reason: String) -> Refusal {
    Refusal(ErrorCode::RequestFailed, reason)
}

fn respond(id: RequestId, answer: Answer) -> Response {
    match answer {
        Ok(result) => Response::new_ok(id, result),
        Err(Refusal(code, message)) => Response::new_err(id, code as i32, message),
    }
}
