//! What tests of the library ask for again and again: programs, results that must be there, an adapter.

use std::fmt::Display;
use std::path::Path;

use umbrage::diag::Source;
use umbrage::program::Program;
use umbrage::table::Table;

/// Results of what must not fail here.
pub trait OrPanic<T> {
    /// The value; an error fails the test with its message as a user would read it.
    fn or_panic(self) -> T;
}

impl<T, E: Display> OrPanic<T> for Result<T, E> {
    #[track_caller]
    fn or_panic(self) -> T {
        match self {
            Ok(value) => value,
            Err(error) => panic!("{error}"),
        }
    }
}

/// The program of a table of this repository: `smsr`, `rsmss`.
#[track_caller]
pub fn published(name: &str) -> Program {
    Program::read(Path::new("tables").join(name).with_extension("ron")).or_panic()
}

/// The program of a table that is written out.
#[track_caller]
pub fn parsed(text: impl Into<String>) -> Program {
    Table::parse(Source::new("test.ron", text)).and_then(|table| Program::check(&table)).or_panic()
}

/// An adapter for tests that do without if there is none. `UMBRAGE_NO_ADAPTER` hides it, for quick runs;
/// `UMBRAGE_REQUIRE_ADAPTER` makes its absence a failure, so that nothing is skipped unseen.
#[cfg(feature = "gpu")]
pub fn adapter() -> Option<umbrage::gpu::Gpu> {
    if std::env::var_os("UMBRAGE_NO_ADAPTER").is_some() {
        return None;
    }
    let gpu = umbrage::gpu::Gpu::open(&umbrage::gpu::AdapterChoice::Any).ok();
    assert!(gpu.is_some() || std::env::var_os("UMBRAGE_REQUIRE_ADAPTER").is_none(), "no adapter");
    gpu
}
