//! Checks of README.md: its program is compiled, its preset loads, its pictures exist and are packed.

use std::path::Path;
use std::process::Command;
use tellus::planet::Planet;

const ROOT: &str = env!("CARGO_MANIFEST_DIR");

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

/// Relative links and pictures lead to files of the package.
#[test]
fn links_lead_to_packed_files() {
    let text = read("README.md");
    let links: Vec<&str> = text.split("](").skip(1).map(|rest| rest.split_once(')').unwrap().0).collect();
    let files: Vec<&str> = links.into_iter().filter(|link| !link.contains("://") && !link.starts_with('#')).collect();
    assert!(files.len() > 10, "{files:?}");
    let listed = Command::new(env!("CARGO"))
        .args(["package", "--list", "--allow-dirty", "--offline"])
        .current_dir(ROOT)
        .output()
        .unwrap();
    assert!(listed.status.success(), "{}", String::from_utf8_lossy(&listed.stderr));
    let packed = String::from_utf8(listed.stdout).unwrap();
    for file in files {
        let file = file.split('#').next().unwrap_or(file);
        assert!(Path::new(ROOT).join(file).is_file(), "README.md shows {file}, and there is no such file");
        assert!(packed.lines().any(|line| line == file), "README.md shows {file}, and the package leaves it out");
    }
}
