//! The `umbrage` command: everything it does is in [`umbrage::cli`].

fn main() -> std::process::ExitCode {
    umbrage::cli::main()
}
