//! What README.md, the documents and the front page of the library promise: the program compiles, the preset loads,
//! links lead to packed files, files that are named exist, modules keep their order.

use std::path::{Path, PathBuf};
use std::process::Command;
use tellus::planet::Planet;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");
/// Documents that are not in `docs`.
const GUIDES: [&str; 7] = [
    "README.md",
    "ARCHITECTURE.md",
    "CHANGELOG.md",
    "CONTRIBUTING.md",
    "SECURITY.md",
    "examples/README.md",
    "planets/LICENSE.md",
];

fn read(file: &str) -> String {
    std::fs::read_to_string(Path::new(ROOT).join(file)).unwrap()
}

/// The code blocks of a language.
fn blocks(language: &str) -> Vec<String> {
    let (text, begin) = (read("README.md"), format!("\n```{language}\n"));
    text.split(&begin).skip(1).map(|block| block.split_once("```").unwrap().0.to_owned()).collect()
}

/// The program in the README is the example, which is compiled and run with all others.
#[test]
fn the_program_is_an_example() {
    let example = read("examples/in_a_game.rs");
    let code = example.lines().skip_while(|line| !line.starts_with("use "));
    let code: String = code.flat_map(|line| [line, "\n"]).collect();
    assert_eq!(blocks("rust"), [code]);
}

#[test]
fn the_preset_loads() {
    for preset in blocks("ron") {
        Planet::from_text("README.md", &preset).unwrap_or_else(|error| panic!("{error}"));
    }
}

#[test]
fn the_package_is_named_as_it_is_depended_on() {
    assert_eq!(env!("CARGO_PKG_NAME"), "tellus-planet");
    for line in blocks("toml").concat().lines().filter(|line| line.contains('{')) {
        assert!(line.starts_with("tellus-planet = {"), "{line}");
    }
}

/// All Markdown files of a folder and below it.
fn documents(folder: &Path) -> Vec<PathBuf> {
    files(folder).into_iter().filter(|file| file.extension().is_some_and(|extension| extension == "md")).collect()
}

/// All files of a folder and below it.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// Relative links and pictures lead to files, and those are part of the package.
#[test]
fn links_lead_to_packed_files() {
    let root = Path::new(ROOT).canonicalize().unwrap();
    let listed = Command::new(env!("CARGO"))
        .args(["package", "--list", "--allow-dirty", "--offline"])
        .current_dir(&root)
        .output()
        .unwrap();
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    let packed = String::from_utf8(listed.stdout).unwrap();
    let mut documents = documents(&root.join("docs"));
    documents.extend(GUIDES.map(|guide| root.join(guide)));
    let mut count = 0;
    for document in &documents {
        let text = std::fs::read_to_string(document).unwrap();
        let links = text.split("](").skip(1).map(|rest| rest.split_once(')').unwrap().0);
        for link in links.filter(|link| !link.contains("://") && !link.starts_with('#')) {
            let file = document.parent().unwrap().join(link.split('#').next().unwrap_or(link));
            let shown = format!("{} links to {link}", document.display());
            let file = file.canonicalize().unwrap_or_else(|error| panic!("{shown}: {error}"));
            let path = file.strip_prefix(&root).unwrap().to_str().unwrap();
            assert!(packed.lines().any(|line| line == path), "{shown}: the package leaves it out");
            count += 1;
        }
    }
    assert!(count > 20, "{count} links");
}

/// Files and folders that the guides name in code, such as those of a recipe, exist.
#[test]
fn files_that_the_guides_name_exist() {
    const FOLDERS: [&str; 9] =
        ["docs/", "examples/", "include/", "planets/", "scripts/", "shaders/", "src/", "systems/", "tests/"];
    let mut count = 0;
    for guide in GUIDES {
        let text = read(guide);
        let in_code = text.lines().flat_map(|line| line.split('`').skip(1).step_by(2));
        let is_path = |code: &&str| FOLDERS.iter().any(|folder| code.starts_with(folder)) && !code.contains(['*', ' ']);
        for path in in_code.filter(is_path) {
            assert!(Path::new(ROOT).join(path).exists(), "{guide} names {path}");
            count += 1;
        }
    }
    assert!(count > 100, "{count} files");
}

#[test]
fn the_readme_is_short() {
    assert!(read("README.md").lines().count() <= 200);
}

/// The front page of the library says that a module uses only modules before it in its list.
#[test]
fn modules_use_only_modules_before_them() {
    let front = read("src/lib.rs");
    let names: Vec<&str> = front
        .lines()
        .filter_map(|line| line.strip_prefix("//! - ")?.trim_start_matches('[').strip_prefix('`')?.split('`').next())
        .collect();
    assert!(names.len() >= 9, "{names:?}");
    for (rank, name) in names.iter().enumerate() {
        let module = Path::new(ROOT).join("src").join(name);
        let files = if module.is_dir() { files(&module) } else { vec![module.with_extension("rs")] };
        for file in files {
            assert!(file.exists(), "{} is not there", file.display());
            let Ok(text) = std::fs::read_to_string(&file) else { continue };
            let code: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            for later in &names[rank + 1..] {
                let path = format!("crate::{later}::");
                assert!(!code.iter().any(|line| line.contains(&path)), "{} uses {later}", file.display());
            }
        }
    }
}
