//! The `tellus` program: the editor, and the command line for scripts and CI. `tellus::cli` is all of it.

fn main() -> std::process::ExitCode {
    tellus::cli::run()
}
