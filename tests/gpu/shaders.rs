//! Every shader through the resolver and naga, and the resolver itself.

use std::borrow::Cow;
use std::collections::BTreeSet;
use tellus::render::shaders::{self, entries};

#[test]
fn every_entry_parses_and_validates() {
    for entry in entries().into_iter().chain(["air_api.wgsl", "caster_api.wgsl"]) {
        if let Err(error) = shaders::check(entry) {
            panic!("{error}");
        }
    }
}

#[test]
fn every_file_is_an_entry_or_included() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/shaders");
    let files: BTreeSet<String> = std::fs::read_dir(folder)
        .expect("the shaders folder")
        .map(|file| file.expect("a file").file_name().into_string().expect("a plain name"))
        .collect();
    let resolved =
        entries().into_iter().chain(["air_api.wgsl"]).map(|entry| shaders::resolve(entry).expect("resolves"));
    let mut used: BTreeSet<String> = resolved.flat_map(|resolved| resolved.files).collect();
    // Generated from Rust definitions.
    assert!(used.remove("shared.wgsl"));
    assert_eq!(files, used);
}

fn files<'a>(files: &'a [(&'static str, &'static str)]) -> impl Fn(&str) -> Option<Cow<'static, str>> + 'a {
    move |name| files.iter().find(|(n, _)| *n == name).map(|(_, text)| Cow::Borrowed(*text))
}

#[test]
fn a_file_is_included_once_and_lines_keep_their_origin() {
    let read = files(&[
        ("a.wgsl", "// a\n#include \"b.wgsl\"\n#include \"c.wgsl\"\nfn last() {}\n"),
        ("b.wgsl", "#include \"c.wgsl\"\nconst B: f32 = C;\n"),
        ("c.wgsl", "const C: f32 = 1.0;\n"),
    ]);
    let resolved = shaders::resolve_with("a.wgsl", &read).expect("resolves");
    assert_eq!(resolved.text, "// a\nconst C: f32 = 1.0;\nconst B: f32 = C;\nfn last() {}\n");
    assert_eq!(resolved.origin(2), "shaders/c.wgsl:1");
    assert_eq!(resolved.origin(4), "shaders/a.wgsl:4");
    shaders::check_resolved(&resolved).expect("valid");
}

#[test]
fn errors_name_file_and_line() {
    let message = |texts: &[(&'static str, &'static str)]| match shaders::resolve_with("a.wgsl", &files(texts)) {
        Ok(resolved) => shaders::check_resolved(&resolved).expect_err("is wrong").to_string(),
        Err(error) => error.to_string(),
    };
    let parse = message(&[("a.wgsl", "#include \"b.wgsl\"\n"), ("b.wgsl", "\nfn f() { let x = ; }\n")]);
    assert!(parse.starts_with("shaders/b.wgsl:2: "), "{parse}");
    let valid = message(&[("a.wgsl", "\n\nfn f() -> f32 { return 1u; }\n")]);
    assert!(valid.starts_with("shaders/a.wgsl:3: "), "{valid}");
    let missing = message(&[("a.wgsl", "\n#include \"b.wgsl\"\n")]);
    assert!(missing.starts_with("shaders/a.wgsl:2: ") && missing.contains("b.wgsl"), "{missing}");
    let circle = message(&[("a.wgsl", "#include \"b.wgsl\"\n"), ("b.wgsl", "#include \"a.wgsl\"\n")]);
    assert!(circle.starts_with("shaders/b.wgsl:1: ") && circle.contains("include each other"), "{circle}");
}
