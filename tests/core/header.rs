//! The C header is that of the functions. Run with `TELLUS_BLESS=1` to write it anew.

use cbindgen::{Builder, Config, Language, Style};
use std::path::Path;

const HEADER: &str = "/* Tellus: planets from one small file. Made from src/capi; docs/embedding.md tells more. */";

#[test]
fn the_c_header_is_that_of_the_functions() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let bindings = Builder::new()
        .with_config(Config { usize_is_size_t: true, ..Config::default() })
        .with_src(root.join("src/capi/mod.rs"))
        .with_language(Language::C)
        .with_style(Style::Both)
        .with_cpp_compat(true)
        .with_documentation(true)
        .with_include_guard("TELLUS_H")
        .with_header(HEADER)
        .generate()
        .unwrap();
    let mut header = Vec::new();
    bindings.write(&mut header);
    let (header, file) = (String::from_utf8(header).unwrap(), root.join("include/tellus.h"));
    if std::env::var_os("TELLUS_BLESS").is_some() {
        std::fs::write(&file, &header).unwrap();
    }
    let kept = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(kept == header, "include/tellus.h is old; TELLUS_BLESS=1 cargo test --test core header writes it anew");
}
