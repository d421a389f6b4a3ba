//! File names: extensions, names for people, and whether two paths are of one file.

use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// The extension of presets.
pub const PRESET_EXTENSION: &str = "ron";

/// A planet's name from its file name: "ice-moon.ron" is "Ice moon".
pub fn readable_stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or_default().to_string_lossy().replace(['-', '_'], " ");
    let mut chars = stem.trim().chars().filter(|c| !c.is_control()).take(64);
    chars.next().map_or_else(|| "Unnamed".to_owned(), |first| first.to_uppercase().chain(chars).collect())
}

/// A file name for what has a name: "Ice moon" is "ice-moon.ron". `or`: the stem for a name without letters.
pub fn file_name_of(name: &str, or: &str) -> String {
    let stem: String = name.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
    let stem = stem.trim_matches('-');
    format!("{}.{PRESET_EXTENSION}", if stem.is_empty() { or } else { stem })
}

/// Whether two paths, relative or not, are of one file.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    let whole = |path: &Path| std::fs::canonicalize(path).or_else(|_| std::path::absolute(path)).ok();
    a == b || whole(a).is_some_and(|a| Some(a) == whole(b))
}

/// Whether the path has this extension, in small or capital letters.
pub fn has_extension(path: &Path, extension: &str) -> bool {
    path.extension().is_some_and(|found| found.eq_ignore_ascii_case(extension))
}

/// The path with the extension appended to the whole name, unless the path has it.
pub fn with_extension(path: &Path, extension: &str) -> PathBuf {
    if has_extension(path, extension) {
        return path.to_owned();
    }
    let mut whole = OsString::from(path);
    whole.push(".");
    whole.push(extension);
    whole.into()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_extension_is_put_behind_the_whole_name() {
        let named = |name: &str| with_extension(Path::new(name), "ron");
        assert_eq!(named("a/foo"), Path::new("a/foo.ron"));
        assert_eq!(named("earth 2.0"), Path::new("earth 2.0.ron"));
        assert_eq!(named("foo.RON"), Path::new("foo.RON"));
        assert_eq!(readable_stem(Path::new("x/ice-moon_2.ron")), "Ice moon 2");
    }
}
