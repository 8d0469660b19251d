//! Messages on their way in and out: frames of bounded size, read and written one by one.

use std::io::{self, BufRead, Read, Write};
use std::sync::{Arc, Mutex};

use lsp_server::Message;
use lsp_types::notification::Notification;

/// Largest message, in bytes: a table of 16 MiB in which every character is escaped.
const MAX_BYTES: usize = 128 << 20;

/// Longest line of a header, in bytes.
const MAX_HEADER: u64 = 4096;

/// One thing that came.
pub(super) enum Frame {
    /// A message.
    Message(Message),
    /// A frame that holds none: the reason. What follows it may be one.
    Malformed(String),
    /// The end of what comes.
    End,
}

/// Reads a frame.
///
/// # Errors
/// When the header is none, so that nobody can tell where the next frame begins.
pub(super) fn read(input: &mut impl BufRead) -> Result<Frame, String> {
    let Some(length) = header(input)? else { return Ok(Frame::End) };
    if length > MAX_BYTES {
        return Err(format!("a message of {length} bytes, more than {MAX_BYTES}"));
    }
    let mut bytes = Vec::new();
    // Memory is taken as bytes come, not as the header promises.
    match input.take(length as u64).read_to_end(&mut bytes) {
        Ok(read) if read == length => {}
        Ok(_) | Err(_) => return Ok(Frame::End),
    }
    Ok(match serde_json::from_slice(&bytes) {
        Ok(message) => Frame::Message(message),
        Err(error) => Frame::Malformed(error.to_string()),
    })
}

/// The length that a header gives; nothing where the input ends.
fn header(input: &mut impl BufRead) -> Result<Option<usize>, String> {
    let mut length = None;
    loop {
        let mut line = Vec::new();
        match input.take(MAX_HEADER).read_until(b'\n', &mut line) {
            Ok(0) | Err(_) => return Ok(None),
            Ok(_) => {}
        }
        let text = String::from_utf8_lossy(&line);
        let text = text.trim_end();
        if text.is_empty() {
            return length.map(Some).ok_or_else(|| "a header without Content-Length".to_owned());
        }
        let shown: String = text.chars().take(60).flat_map(char::escape_debug).collect();
        let Some((name, value)) = text.split_once(':') else { return Err(format!("`{shown}` is no header")) };
        if name.trim().eq_ignore_ascii_case("content-length") {
            let bytes = value.trim().parse().map_err(|_| format!("`{shown}` gives no length"))?;
            length = Some(bytes);
        }
    }
}

/// The way out for messages; those of several threads go one after the other.
#[derive(Clone)]
pub(super) struct Outlet(Arc<Mutex<Box<dyn Write + Send>>>);

impl Outlet {
    pub(super) fn new(output: impl Write + Send + 'static) -> Self {
        Self(Arc::new(Mutex::new(Box::new(output))))
    }

    /// Writes a message.
    ///
    /// # Errors
    /// When nobody reads any more.
    pub(super) fn send(&self, message: impl Into<Message>) -> io::Result<()> {
        let mut output = self.0.lock().map_err(|_| io::Error::other("the output is broken"))?;
        message.into().write(&mut *output)?;
        output.flush()
    }

    /// Tells the client something. That it has gone is noticed where it is read from.
    pub(super) fn notify<N: Notification>(&self, params: &N::Params) {
        if let Ok(params) = serde_json::to_value(params) {
            let _ = self.send(lsp_server::Notification { method: N::METHOD.to_owned(), params });
        }
    }
}
