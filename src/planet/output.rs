//! Files that are written whole or not at all: a reader finds the old file or the new one, never a part of either,
//! whatever fails in between.

use super::open::followed;
use std::collections::BTreeSet;
use std::fs::{File, Permissions};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// How names of unfinished files begin and end. Between them are [`RANDOM`] letters and digits.
const UNFINISHED: &str = ".tellus-";
const UNFINISHED_END: &str = ".tmp";
const RANDOM: usize = 6;
/// Age from which an unfinished file is one that a killed writer left.
const ABANDONED: Duration = Duration::from_secs(3600);

/// Writes a file beside the target, syncs it to disk, then renames it to the target. A link stays a link: the file to
/// which it leads is replaced.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), String> {
    write_atomically_with(path, None, &mut |file| file.write_all(bytes))
}

/// As [`write_atomically`], for a file that is written piece by piece. `beside`: the folder for the unfinished file, on
/// the disk of the target; the folder of the target unless one is given.
pub(crate) fn write_atomically_with(
    path: &Path,
    beside: Option<&Path>,
    write: &mut dyn FnMut(&mut File) -> io::Result<()>,
) -> Result<(), String> {
    stage(path, beside, write)?.commit()
}

/// The first part of [`write_atomically_with`]: all of it but the rename.
pub(crate) fn stage(
    path: &Path,
    beside: Option<&Path>,
    write: &mut dyn FnMut(&mut File) -> io::Result<()>,
) -> Result<Staged, String> {
    Target::checked(path)?.stage(beside, write)
}

/// A file that is complete and on the disk, but not in its place yet. Files of a set are staged first and then
/// committed together: a disk that is full changes none of them. Dropped, it is removed.
pub(crate) struct Staged {
    unfinished: tempfile::TempPath,
    target: Target,
}

impl Staged {
    /// Where its bytes are until it is committed.
    #[cfg(feature = "bake")]
    pub(crate) fn unfinished(&self) -> &Path {
        &self.unfinished
    }

    /// Moves it to its place.
    pub(crate) fn commit(self) -> Result<(), String> {
        let Self { unfinished, target } = self;
        let state = target.state();
        unfinished.persist(&target.path).map_err(|e| format!("cannot replace the file: {}; {state}", e.error))?;
        // The rename must reach the disk, too. Not every system can open folders, and the file is complete already.
        #[cfg(unix)]
        if let Ok(folder) = File::open(&target.folder) {
            let _ = folder.sync_all();
        }
        Ok(())
    }
}

/// As [`write_atomically`], for a file whose name this program has made up: a link in its place was put there by
/// somebody else, and is replaced, not followed.
pub(crate) fn write_over_links(path: &Path, bytes: &[u8]) -> Result<(), String> {
    Target::checked_itself(path)?.stage(None, &mut |file| file.write_all(bytes))?.commit()
}

/// A place where a file can be written.
pub(crate) struct Target {
    pub(super) path: PathBuf,
    pub(super) folder: PathBuf,
    /// Permissions of the file that is replaced; None for a new file.
    permissions: Option<Permissions>,
}

impl Target {
    /// Checks that a file can be written or replaced here, as far as that is known before.
    pub(crate) fn checked(path: &Path) -> Result<Self, String> {
        // A link stays a link; its target is replaced, or made.
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| followed(path));
        if std::fs::symlink_metadata(&target).is_ok_and(|metadata| metadata.is_symlink()) {
            return Err("is a link that leads around in a circle; name a file".to_owned());
        }
        Self::at(path, target)
    }

    /// The same for the path itself, even if it is a link.
    fn checked_itself(path: &Path) -> Result<Self, String> {
        let is_link = std::fs::symlink_metadata(path).is_ok_and(|metadata| metadata.is_symlink());
        if !is_link {
            return Self::at(path, path.to_owned());
        }
        Ok(Self { path: path.to_owned(), folder: folder_of(path).to_owned(), permissions: None })
    }

    fn at(path: &Path, target: PathBuf) -> Result<Self, String> {
        check_address(path)?;
        let folder = folder_of(&target);
        if !folder.is_dir() {
            return Err(format!("there is no folder {}; make it first or save elsewhere", folder.display()));
        }
        if target.is_dir() {
            return Err("is a folder; name a file in it".to_owned());
        }
        if path.file_name().is_none() {
            return Err("is not a file's name; name a file".to_owned());
        }
        if std::fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
            return Err("is a device or a pipe, not a file; name a file".to_owned());
        }
        let permissions = std::fs::metadata(&target).ok().map(|metadata| metadata.permissions());
        if permissions.as_ref().is_some_and(Permissions::readonly) {
            return Err("is read-only; change its permissions or save elsewhere".to_owned());
        }
        Ok(Self { folder: folder.to_owned(), path: target, permissions })
    }

    /// Checks that the disk takes a file here, by making an empty one that goes away again.
    #[cfg(feature = "cli")]
    pub(crate) fn probe(&self) -> Result<(), String> {
        unfinished_in(&self.folder).map(drop)
    }

    /// What a failure leaves.
    fn state(&self) -> &'static str {
        if self.permissions.is_some() { "the old file is as it was" } else { "no file was written" }
    }

    fn stage(
        self,
        beside: Option<&Path>,
        write: &mut dyn FnMut(&mut File) -> io::Result<()>,
    ) -> Result<Staged, String> {
        let unfinished = beside.unwrap_or(&self.folder);
        let state = self.state();
        sweep(unfinished);
        let mut file = unfinished_in(unfinished).map_err(|error| format!("{error}; {state}"))?;
        write(file.as_file_mut()).map_err(|error| format!("cannot write: {error}; {state}"))?;
        if let Some(permissions) = &self.permissions {
            // Not every file system has permissions.
            let _ = file.as_file().set_permissions(permissions.clone());
        }
        file.as_file().sync_all().map_err(|error| format!("cannot write: {error}; {state}"))?;
        Ok(Staged { unfinished: file.into_temp_path(), target: self })
    }
}

/// Checks that files can be written to a folder, which may have to be made.
#[cfg(feature = "cli")]
pub(crate) fn check_folder(folder: &Path) -> Result<(), String> {
    check_address(folder)?;
    let mut ancestors =
        folder.ancestors().map(|folder| if folder.as_os_str().is_empty() { Path::new(".") } else { folder });
    let there = ancestors.find(|folder| folder.symlink_metadata().is_ok()).unwrap_or(Path::new("."));
    if there.is_dir() {
        return unfinished_in(there).map(drop);
    }
    Err(if there == folder {
        "is a file; name a folder".to_owned()
    } else {
        format!("{} is no folder", there.display())
    })
}

/// Refuses `s3://bucket/x`, which would become a folder called `s3:`.
pub(crate) fn check_address(path: &Path) -> Result<(), String> {
    let text = path.to_string_lossy();
    // One letter is the drive of a path of Windows.
    let is_scheme =
        |scheme: &str| scheme.len() > 1 && scheme.bytes().all(|c| c.is_ascii_alphanumeric() || b"+-.".contains(&c));
    match text.split_once("://") {
        Some((scheme, _)) if is_scheme(scheme) => {
            Err("is an address, not a place on this computer; name a path, and copy what was written from there"
                .to_owned())
        }
        _ => Ok(()),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

fn unfinished_in(folder: &Path) -> Result<tempfile::NamedTempFile, String> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED).suffix(UNFINISHED_END).rand_bytes(RANDOM);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    builder.tempfile_in(folder).map_err(|error| format!("cannot write to the folder {}: {error}", folder.display()))
}

/// Removes the unfinished files that killed writers left in a folder; each process looks once. A writer that is at work
/// has touched its file lately.
fn sweep(folder: &Path) {
    static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    if !SWEPT.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
        return;
    }
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let about = || entry.metadata().ok().filter(std::fs::Metadata::is_file);
        let age = || about()?.modified().ok()?.elapsed().ok();
        if is_unfinished(&entry.file_name().to_string_lossy()) && age().is_some_and(|age| age > ABANDONED) {
            // It may belong to somebody else.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Whether a name is one that this program gives to unfinished files.
pub(crate) fn is_unfinished(name: &str) -> bool {
    let middle = name.strip_prefix(UNFINISHED).and_then(|rest| rest.strip_suffix(UNFINISHED_END));
    middle.is_some_and(|middle| middle.len() == RANDOM && middle.bytes().all(|c| c.is_ascii_alphanumeric()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_are_no_files() {
        for address in ["s3://bucket/x", "file:///tmp/x", "https://a/b.png", "git+ssh://a"] {
            assert!(check_address(Path::new(address)).is_err(), "{address}");
            assert!(write_atomically(Path::new(address), b"").unwrap_err().contains("is an address"), "{address}");
        }
        for path in ["C://x", "a/b://c", "s3:/x", "://x", "x"] {
            assert_eq!(check_address(Path::new(path)), Ok(()), "{path}");
        }
    }

    #[test]
    fn a_failure_says_whether_there_was_a_file_before() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        let fail = || write_atomically_with(&path, None, &mut |_| Err(io::Error::other("a reason"))).unwrap_err();
        assert_eq!(fail(), "cannot write: a reason; no file was written");
        write_atomically(&path, b"old").unwrap();
        assert_eq!(fail(), "cannot write: a reason; the old file is as it was");
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_where_a_person_names_them_alone() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let read = |name: &str| std::fs::read(at(name)).unwrap();
        std::fs::write(at("target"), "old").unwrap();
        std::os::unix::fs::symlink("target", at("link")).unwrap();
        write_over_links(&at("link"), b"made up").unwrap();
        assert_eq!((read("target"), read("link")), (b"old".to_vec(), b"made up".to_vec()));
        std::os::unix::fs::symlink("target", at("named")).unwrap();
        write_atomically(&at("named"), b"new").unwrap();
        assert!(at("named").is_symlink() && read("target") == b"new");
    }

    #[test]
    fn only_names_of_this_program_are_swept() {
        assert!(is_unfinished(".tellus-aB3dE9.tmp"));
        for other in [".tellus-notes.tmp", ".tellus-.tmp", ".tellus-a.b.c1.tmp", "tellus-aB3dE9.tmp", ".tellus-aB3dE9"]
        {
            assert!(!is_unfinished(other), "{other}");
        }
    }
}
