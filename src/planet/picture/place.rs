//! Paths of pictures as a preset writes them.

use std::path::{Component, Path, PathBuf};

/// The path to a file as a preset in a folder writes it: relative if the two share more than the root, with `/` on
/// every system; otherwise absolute.
pub(in crate::planet) fn written_from(file: &Path, folder: &Path) -> String {
    // Links in either path would break `..`.
    let (real_file, real_folder) = (real(file), real(folder));
    let (file_steps, folder_steps): (Vec<_>, Vec<_>) =
        (real_file.components().collect(), real_folder.components().collect());
    let common = file_steps.iter().zip(&folder_steps).take_while(|(a, b)| a == b).count();
    let shares_folder = file_steps[..common].iter().any(|step| matches!(step, Component::Normal(_)));
    if !shares_folder {
        return tidy(file).to_string_lossy().into_owned();
    }
    let up = folder_steps[common..].iter().map(|_| "..".into());
    let down = file_steps[common..].iter().map(|step| step.as_os_str().to_string_lossy());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// The path without links, as far as it exists.
fn real(path: &Path) -> PathBuf {
    let path = tidy(path);
    let mut rest = PathBuf::new();
    for ancestor in path.ancestors() {
        if let Ok(real) = std::fs::canonicalize(ancestor) {
            return if rest.as_os_str().is_empty() { real } else { real.join(rest) };
        }
        if let Some(name) = ancestor.file_name() {
            rest = if rest.as_os_str().is_empty() { name.into() } else { Path::new(name).join(rest) };
        }
    }
    path
}

/// The path without `.` and `a/..`.
pub(in crate::planet) fn tidy(path: &Path) -> PathBuf {
    let mut tidy = PathBuf::new();
    for step in path.components() {
        match step {
            Component::CurDir => {}
            Component::ParentDir if matches!(tidy.components().next_back(), Some(Component::Normal(_))) => {
                tidy.pop();
            }
            step => tidy.push(step),
        }
    }
    tidy
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    #[test]
    fn paths_are_relative_where_folders_are_shared() {
        let written = |file: &str, folder: &str| written_from(Path::new(file), Path::new(folder));
        assert_eq!(written("/no/where/maps/a.png", "/no/where"), "maps/a.png");
        assert_eq!(written("/no/where/../maps/a.png", "/no/where/x"), "../../maps/a.png");
        assert_eq!(written("/elsewhere/a.png", "/no/where"), "/elsewhere/a.png");
    }
}
