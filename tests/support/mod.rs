//! Shared by all tests: the built command in a directory of its own, and the library's programs.
#![allow(dead_code, unused_imports, clippy::unwrap_used, unreachable_pub)]

mod library;

use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

pub use library::*;

/// A directory that is removed with this value; commands run in it.
pub struct Place {
    directory: tempfile::TempDir,
}

/// What a command said.
pub struct Said {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Said {
    /// Everything, for a snapshot.
    pub fn all(&self) -> String {
        let mut all = format!("exit code: {}\n", self.code.map_or("none".to_owned(), |code| code.to_string()));
        for (name, text) in [("stdout", &self.out), ("stderr", &self.err)] {
            if !text.is_empty() {
                all.push_str(&format!("{name}:\n{text}"));
            }
        }
        all
    }
}

impl Place {
    pub fn new() -> Self {
        Self { directory: tempfile::tempdir().unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.directory.path().join(name)
    }

    pub fn file(&self, name: &str, bytes: impl AsRef<[u8]>) -> &Self {
        std::fs::write(self.path(name), bytes).unwrap();
        self
    }

    /// A copy of a table of this repository.
    pub fn table(&self, name: &str) -> &Self {
        let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("tables").join(name);
        self.file(name, std::fs::read(from).unwrap())
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    /// Runs `umbrage` with arguments separated by blanks.
    pub fn run(&self, arguments: &str) -> Said {
        self.run_with(arguments, "")
    }

    /// The same, with something on standard input.
    pub fn run_with(&self, arguments: &str, input: &str) -> Said {
        said_in(self.directory.path(), umbrage().args(arguments.split_whitespace()), input)
    }

    /// Runs `umbrage` in a shell with another umask.
    #[cfg(unix)]
    pub fn run_under(&self, umask: &str, arguments: &str) -> Said {
        let command = format!("umask {umask} && exec {} {arguments}", env!("CARGO_BIN_EXE_umbrage"));
        said_in(self.directory.path(), Command::new("sh").args(["-c", &command]), "")
    }

    /// The names of all files, sorted.
    pub fn files(&self) -> Vec<String> {
        let entries = std::fs::read_dir(self.directory.path()).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name().to_string_lossy().into_owned()).collect();
        names.sort();
        names
    }
}

/// The built command.
pub fn umbrage() -> Command {
    Command::new(env!("CARGO_BIN_EXE_umbrage"))
}

/// Runs a command in a directory, with something on standard input.
pub fn said_in(directory: &Path, command: &mut Command, input: &str) -> Said {
    let mut child = command
        .current_dir(directory)
        .env_remove("RUST_BACKTRACE")
        // Without it Mesa complains on standard error, where only the command should speak.
        .env("XDG_RUNTIME_DIR", std::env::temp_dir())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    // A command that does not want its input may close it.
    let _ = child.stdin.take().unwrap().write_all(input.as_bytes());
    let output = child.wait_with_output().unwrap();
    let text = |bytes| String::from_utf8(bytes).unwrap();
    Said { code: output.status.code(), out: text(output.stdout), err: text(output.stderr) }
}
