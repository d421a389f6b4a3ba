//! The `tellus` program: the editor, and the tool for scripts and CI. All of it is in `tellus::cli`.

fn main() -> std::process::ExitCode {
    tellus::cli::run()
}
