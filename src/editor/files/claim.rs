//! Whether another window has the same file open. Each window holds a lock in the folder of the working copies, on a
//! file named after the document's path. The system releases the lock when the window ends, also after a crash. The
//! lock blocks nothing: it only informs.

use crate::planet::key::fnv1a;
use crate::planet::open::followed;
use crate::planet::picture::folder_of;
use std::fs::{self, File, TryLockError};
use std::io::{Seek as _, Write as _};
use std::path::{Path, PathBuf};

/// Most windows on one file that can have a lock.
const SLOTS: u32 = 8;
const PREFIX: &str = "open-";

/// The lock of this window for a file.
pub struct Claim {
    stem: PathBuf,
    slot: u32,
    lock: File,
}

impl Claim {
    /// Takes a lock in `folder` for a file that this window has open.
    pub fn take(folder: &Path, file: &Path) -> Option<Self> {
        // A file that does not exist yet has no canonical path, but its folder has.
        let whole = fs::canonicalize(file).or_else(|_| {
            let file = followed(file);
            fs::canonicalize(folder_of(&file)).map(|parent| parent.join(file.file_name().unwrap_or_default()))
        });
        let stem = folder.join(format!("{PREFIX}{:016x}", fnv1a(whole.ok()?.as_os_str().as_encoded_bytes())));
        fs::create_dir_all(folder).ok()?;
        (0..SLOTS).find_map(|slot| {
            let lock = File::options().create(true).truncate(false).write(true).open(lock_path(&stem, slot)).ok()?;
            lock.try_lock().ok()?;
            let claim = Self { stem: stem.clone(), slot, lock };
            claim.tell();
            Some(claim)
        })
    }

    /// Whether another window has the file open too.
    pub fn is_shared(&self) -> bool {
        (0..SLOTS).filter(|slot| *slot != self.slot).any(|slot| {
            // A shared lock: two windows that look at the same time do not take each other for owners.
            let other = File::open(lock_path(&self.stem, slot));
            other.is_ok_and(|other| matches!(other.try_lock_shared(), Err(TryLockError::WouldBlock)))
        })
    }

    /// Writes to the file. Other windows watch its folder for writes; they cannot watch locks.
    fn tell(&self) {
        let mut file = &self.lock;
        // If the write fails, other windows notice at their next look.
        let _ = file.rewind().and_then(|()| file.write_all(b"\n"));
    }
}

impl Drop for Claim {
    fn drop(&mut self) {
        // The file stays: another window may hold it open, and would not see a lock on a new file of the same name.
        self.tell();
    }
}

/// Whether a file name is that of a lock.
pub fn is_claim(name: &std::ffi::OsStr) -> bool {
    name.as_encoded_bytes().starts_with(PREFIX.as_bytes())
}

fn lock_path(stem: &Path, slot: u32) -> PathBuf {
    stem.with_extension(format!("{slot}.lock"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn windows_on_one_file_know_of_each_other_and_what_a_crash_leaves_counts_for_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let (locks, file) = (folder.path().join("locks"), folder.path().join("a.ron"));
        let first = Claim::take(&locks, &file).unwrap();
        assert!(!first.is_shared());
        fs::write(&file, "").unwrap();
        let second = Claim::take(&locks, &folder.path().join(".").join("a.ron")).unwrap();
        assert!(first.is_shared() && second.is_shared());
        let other = Claim::take(&locks, &folder.path().join("b.ron")).unwrap();
        assert!(!other.is_shared());
        drop(second);
        assert!(!first.is_shared());
        let third = Claim::take(&locks, &file).unwrap();
        assert!(first.is_shared() && third.is_shared(), "a slot is used again");
        drop(third);
        // Two windows that look at once.
        let looking = File::open(lock_path(&first.stem, 1)).unwrap();
        looking.try_lock_shared().unwrap();
        assert!(!first.is_shared());
        // A lock file without a lock.
        fs::write(lock_path(&first.stem, 3), "").unwrap();
        assert!(!first.is_shared());
    }
}
