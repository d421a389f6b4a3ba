//! Opens files that a person names, and nothing that is not a file.

use std::io;
use std::path::Path;

/// The kind of thing at a path. Links are followed.
pub(crate) enum Opened {
    /// A file, open for reading.
    File(std::fs::File),
    /// A folder.
    Folder,
    /// A pipe, a device or a socket. It is not opened: reading it may block for ever.
    Special,
}

/// Opens a path for reading if it is a file.
pub(crate) fn open(path: &Path) -> io::Result<Opened> {
    let metadata = std::fs::metadata(path)?;
    Ok(match metadata.file_type() {
        kind if kind.is_file() => Opened::File(std::fs::File::open(path)?),
        kind if kind.is_dir() => Opened::Folder,
        _ => Opened::Special,
    })
}
