//! Files that are opened for reading, and nothing that is not a file: a pipe may block for ever, and a device may never
//! end. This is the one place where the library opens files that others may have put there.

use std::fs::{File, FileType};
use std::io::{self, Read as _};
use std::path::{Path, PathBuf};

/// Most links from a path to a file.
const MOST_LINKS: usize = 40;

/// The kind of thing at a path. Links are followed.
pub(crate) enum Opened {
    /// A file, open for reading.
    File(File),
    /// A folder.
    Folder,
    /// A pipe, a device or a socket. It is not opened: reading it may block for ever.
    Special,
}

/// Opens a path for reading if it is a file.
pub(crate) fn open(path: &Path) -> io::Result<Opened> {
    let other = |kind: FileType| if kind.is_dir() { Opened::Folder } else { Opened::Special };
    let kind = std::fs::metadata(path)?.file_type();
    if !kind.is_file() {
        return Ok(other(kind));
    }
    let file = File::open(path)?;
    // Something else may have taken its place meanwhile.
    let kind = file.metadata()?.file_type();
    Ok(if kind.is_file() { Opened::File(file) } else { other(kind) })
}

/// A file, open for reading. An error says what is there instead.
pub(crate) fn open_file(path: &Path) -> io::Result<File> {
    match open(path)? {
        Opened::File(file) => Ok(file),
        Opened::Folder => Err(io::Error::new(io::ErrorKind::IsADirectory, "is a folder; name a file")),
        Opened::Special => {
            Err(io::Error::new(io::ErrorKind::InvalidInput, "is a device or a pipe, not a file; name a file"))
        }
    }
}

/// The bytes of a file: all of them, or `most` and one more of a longer file.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_file(path)?.take(most + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// The bytes of a file that has at most `most` of them. A longer one is an error.
pub(crate) fn read_whole(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let bytes = read(path, most)?;
    if bytes.len() as u64 > most {
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, format!("is longer than {most} bytes")));
    }
    Ok(bytes)
}

/// As [`read_whole`], of a text in UTF-8.
#[cfg(feature = "editor")]
pub(crate) fn read_whole_text(path: &Path, most: u64) -> io::Result<String> {
    String::from_utf8(read_whole(path, most)?).map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}

/// The file to which a link leads, be it there or not; the path itself if it is no link.
pub(crate) fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    // More links than this are a circle, which the system refuses.
    for _ in 0..MOST_LINKS {
        let Ok(target) = std::fs::read_link(&path) else { break };
        path = path.parent().map_or_else(|| target.clone(), |folder| folder.join(&target));
    }
    path
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_up_to_its_limit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("five");
        std::fs::write(&path, "12345").unwrap();
        assert_eq!(read(&path, 3).unwrap(), b"1234");
        assert_eq!(read_whole(&path, 5).unwrap(), b"12345");
        assert_eq!(read_whole(&path, 4).unwrap_err().to_string(), "is longer than 4 bytes");
        assert_eq!(read_whole(folder.path(), 4).unwrap_err().to_string(), "is a folder; name a file");
    }

    #[cfg(unix)]
    #[test]
    fn a_pipe_is_not_opened_and_a_device_not_read() {
        let folder = tempfile::tempdir().unwrap();
        let [pipe, link] = ["pipe", "link"].map(|name| folder.path().join(name));
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        std::os::unix::fs::symlink("/dev/zero", &link).unwrap();
        for path in [pipe, link] {
            assert!(read(&path, 9).unwrap_err().to_string().contains("a device or a pipe"), "{}", path.display());
        }
    }
}
