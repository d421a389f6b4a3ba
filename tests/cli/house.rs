//! The rules of this repository for its own sources: short files, comments of at most 120 columns, no half-done merge.

use std::fs;
use std::path::{Path, PathBuf};

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// Folders with sources.
const FOLDERS: [&str; 7] = [".ci", "benches", "examples", "scripts", "shaders", "src", "tests"];
/// Most lines of a Rust or WGSL file: it should be read in one sitting.
const MOST_LINES: usize = 500;
/// Most columns of a comment line; rustfmt limits the code.
const MOST_COLUMNS: usize = 120;
/// Markers that Git leaves where both sides of a merge have changed a line.
const MARKERS: [&str; 2] = ["<<<<<<< ", ">>>>>>> "];

/// The language of a file, by its name.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Language {
    /// Rust or WGSL: comments begin with `//`.
    Code,
    /// Scripts and settings: comments begin with `#`.
    Script,
}

fn language(path: &Path, text: &str) -> Option<Language> {
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("rs" | "wgsl") => Some(Language::Code),
        Some("sh" | "toml" | "py") => Some(Language::Script),
        None if text.starts_with("#!") => Some(Language::Script),
        _ => None,
    }
}

/// All files below a folder.
fn files(folder: &Path, found: &mut Vec<PathBuf>) {
    let Ok(entries) = fs::read_dir(folder) else { return };
    for path in entries.map(|entry| entry.unwrap().path()) {
        if path.is_dir() {
            files(&path, found);
        } else {
            found.push(path);
        }
    }
}

/// What is wrong with a file, a line for each offence.
fn offences(name: &str, text: &str, language: Language) -> Vec<String> {
    let mark = if language == Language::Code { "//" } else { "#" };
    let long = text.lines().enumerate().filter(|(_, line)| {
        line.trim_start().starts_with(mark) && !line.starts_with("#!") && line.chars().count() > MOST_COLUMNS
    });
    let mut wrong: Vec<String> =
        long.map(|(i, line)| format!("{name}:{}: a comment of {} columns", i + 1, line.chars().count())).collect();
    let markers = text.lines().enumerate().filter(|(_, line)| MARKERS.iter().any(|marker| line.starts_with(marker)));
    wrong.extend(markers.map(|(i, _)| format!("{name}:{}: a marker of a merge", i + 1)));
    let lines = text.lines().count();
    if language == Language::Code && lines > MOST_LINES {
        wrong.push(format!("{name}: {lines} lines"));
    }
    wrong
}

#[test]
fn files_are_short_and_comments_fit_the_window() {
    let mut paths = vec![Path::new(ROOT).join("Cargo.toml")];
    FOLDERS.iter().for_each(|folder| files(&Path::new(ROOT).join(folder), &mut paths));
    let mut wrong = Vec::new();
    let mut read = 0;
    for path in paths {
        let name = path.strip_prefix(ROOT).unwrap().to_string_lossy().replace('\\', "/");
        let Ok(text) = fs::read_to_string(&path) else { continue };
        if let Some(language) = language(&path, &text) {
            read += 1;
            wrong.extend(offences(&name, &text, language));
        }
    }
    assert!(read > 50, "only {read} files were found");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Files that others may have put there are opened in one place, which refuses pipes and devices. A file that opens
/// others itself is listed with the reason.
#[test]
fn files_are_opened_for_reading_in_one_place() {
    const OPENERS: [&str; 8] = [
        "src/planet/open.rs",
        // A folder, to sync it.
        "src/planet/output.rs",
        // Locks that this program makes.
        "src/editor/files/claim.rs",
        // Its own log and reports.
        "src/cli/logging.rs",
        "src/editor/files/crash.rs",
        // The shaders of this repository, and figures of the kernel.
        "src/render/shaders.rs",
        "src/cli/bench/mod.rs",
        "src/cli/bench/sculpt.rs",
    ];
    const CALLS: [&str; 4] = ["File::open(", "fs::read(", "read_to_string(", "image::open("];
    let mut paths = Vec::new();
    files(&Path::new(ROOT).join("src"), &mut paths);
    let mut wrong = Vec::new();
    for path in paths {
        let name = path.strip_prefix(ROOT).unwrap().to_string_lossy().replace('\\', "/");
        let text = fs::read_to_string(&path).unwrap_or_default();
        // Tests read what they have written.
        let code = text.split("\nmod tests {").next().unwrap_or_default();
        if OPENERS.contains(&name.as_str()) || name.contains("tests") {
            continue;
        }
        let lines = code.lines().enumerate().filter(|(_, line)| !line.trim_start().starts_with("//"));
        let opens = lines.filter(|(_, line)| CALLS.iter().any(|call| line.contains(call)));
        wrong.extend(opens.map(|(i, line)| format!("{name}:{}: {}", i + 1, line.trim())));
    }
    assert!(wrong.is_empty(), "use crate::planet::open:\n{}", wrong.join("\n"));
}

#[test]
fn an_offence_is_named_with_its_line() {
    let long = format!("fn f() {{}}\n    // {}\n", "x".repeat(MOST_COLUMNS));
    assert_eq!(offences("a.rs", &long, Language::Code), ["a.rs:2: a comment of 127 columns"]);
    assert_eq!(offences("a.sh", &long, Language::Script), Vec::<String>::new());
    let tall = "\n".repeat(MOST_LINES + 1);
    assert_eq!(offences("a.rs", "a\n>>>>>>> b\n", Language::Code), ["a.rs:2: a marker of a merge"]);
    assert_eq!(offences("a.rs", &tall, Language::Code), ["a.rs: 501 lines"]);
}
