//! The compiler as WebAssembly: one function, from a message to a message.
//!
//! A message is a length, as many bytes of JSON, and then bytes that JSON would only blow up:
//! pictures and words. The page reserves room for one, writes it, and calls [`answer`]; the answer
//! lies in the same room. There are no bindings to generate, and nothing here is unsafe but the
//! names of what is exported.

mod checked;
mod code;
mod decision;
mod message;
mod panel;
mod places;
mod run;
mod session;

use std::cell::RefCell;
use std::panic;

use message::Message;
use session::Session;

thread_local! {
    /// The message that is being written or read. There is one thread.
    static ROOM: RefCell<Vec<u8>> = const { RefCell::new(Vec::new()) };
    static SESSION: RefCell<Session> = RefCell::new(Session::default());
    /// The last words of a panic, which ends the module but leaves its memory to be read.
    static LAST_WORDS: RefCell<String> = const { RefCell::new(String::new()) };
}

/// Makes room for a message and returns its place.
// The names of exports are unsafe, as another library could export the same; no other is linked that exports any.
#[unsafe(no_mangle)]
pub extern "C" fn reserve(bytes: usize) -> *mut u8 {
    ROOM.with_borrow_mut(|room| {
        room.clear();
        room.resize(bytes, 0);
        room.as_mut_ptr()
    })
}

/// Answers the message in the room and returns the place of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer() -> *const u8 {
    panic::set_hook(Box::new(|panic| {
        LAST_WORDS.with_borrow_mut(|words| *words = panic.to_string());
    }));
    let asked = ROOM.take();
    let answer = match Message::read(&asked) {
        Ok(message) => SESSION.with_borrow_mut(|session| session.answer(&message)),
        Err(reason) => Message::error(&reason),
    };
    ROOM.with_borrow_mut(|room| {
        *room = answer.bytes();
        room.as_ptr()
    })
}

/// The bytes of the answer.
#[unsafe(no_mangle)]
pub extern "C" fn answer_bytes() -> usize {
    ROOM.with_borrow(Vec::len)
}

/// The place of the last words, after a trap.
#[unsafe(no_mangle)]
pub extern "C" fn last_words() -> *const u8 {
    LAST_WORDS.with_borrow(|words| words.as_ptr())
}

/// Their bytes; none, unless there was a panic.
#[unsafe(no_mangle)]
pub extern "C" fn last_words_bytes() -> usize {
    LAST_WORDS.with_borrow(String::len)
}
