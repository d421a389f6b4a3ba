//! Room on a disk, asked for before work that would fill it.

use std::path::Path;

/// Checks that the disk of a folder, which may have to be made, has room for more bytes. `there`: what an earlier run
/// of the same work has written already.
///
/// # Errors
/// How much the work takes, and how much is free.
pub(crate) fn check_room(folder: &Path, least_bytes: u64, there: u64) -> Result<(), String> {
    let needed = least_bytes.saturating_sub(there);
    match folder
        .ancestors()
        .find_map(|folder| free_bytes(if folder == Path::new("") { Path::new(".") } else { folder }))
    {
        Some(free) if free < needed => Err(format!(
            "No space left on device for this work: it takes at least {}, and {} are free; free some, write to another \
             disk or ask for less",
            mebibytes(needed),
            mebibytes(free)
        )),
        _ => Ok(()),
    }
}

/// Bytes of the files in a folder and its folders, down to a depth, of which `is_ours` knows the names.
pub(crate) fn bytes_in(folder: &Path, is_ours: &dyn Fn(&Path) -> bool, depth: usize) -> u64 {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let sizes = entries.map(|entry| match entry.metadata() {
        Ok(data) if data.is_dir() && depth > 0 => bytes_in(&entry.path(), is_ours, depth - 1),
        Ok(data) if data.is_file() && is_ours(&entry.path()) => data.len(),
        _ => 0,
    });
    sizes.sum()
}

fn mebibytes(bytes: u64) -> String {
    const MIB: f64 = 1048576.0;
    let mib = bytes as f64 / MIB;
    if mib >= 1024.0 { format!("{:.1} GiB", mib / 1024.0) } else { format!("{mib:.1} MiB") }
}

/// Bytes that are free for this user on the disk of a folder; None if the system does not say, or there is no folder.
#[cfg(unix)]
fn free_bytes(folder: &Path) -> Option<u64> {
    use std::os::unix::ffi::OsStrExt as _;
    let path = std::ffi::CString::new(folder.as_os_str().as_bytes()).ok()?;
    let mut about = std::mem::MaybeUninit::<libc::statvfs>::uninit();
    // SAFETY: the path ends with a zero, and the structure is read only after the call has filled it.
    let about = unsafe {
        match libc::statvfs(path.as_ptr(), about.as_mut_ptr()) {
            0 => about.assume_init(),
            _ => return None,
        }
    };
    // The counts have 32 bits on some systems. A file system that counts nothing says 0 blocks.
    #[allow(clippy::useless_conversion)]
    (about.f_blocks > 0).then(|| u64::from(about.f_bavail).saturating_mul(u64::from(about.f_frsize)))
}

#[cfg(not(unix))]
fn free_bytes(_: &Path) -> Option<u64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_does_not_fit_is_refused_with_both_numbers() {
        let folder = tempfile::tempdir().unwrap();
        let new = folder.path().join("not/made/yet");
        assert_eq!(check_room(&new, 1, 0), Ok(()));
        #[cfg(unix)]
        {
            let why = check_room(&new, 1 << 60, 0).unwrap_err();
            assert!(why.contains("at least 1073741824.0 GiB, and ") && why.contains("are free"), "{why}");
            assert_eq!(check_room(&new, 1 << 60, 1 << 60), Ok(()), "an earlier run has written all");
        }
    }

    #[test]
    fn bytes_of_an_earlier_run_are_counted() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("a")).unwrap();
        for (name, bytes) in [("a/1.strip", 10), ("a/2.strip", 20), ("a/x.png", 400), ("3.strip", 3)] {
            std::fs::write(folder.path().join(name), vec![0; bytes]).unwrap();
        }
        let is_strip = |path: &Path| path.extension().is_some_and(|ending| ending == "strip");
        assert_eq!([0, 1].map(|depth| bytes_in(folder.path(), &is_strip, depth)), [3, 33]);
    }
}
