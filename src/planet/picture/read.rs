//! Opens the file of a picture, or takes its bytes, and chooses the decoder by the first of them.

use super::budget::{Budget, MAX_WORK_BYTES};
use super::pixels::{Picture, PictureExtent};
use super::{from_exr, from_png};
use crate::planet::open::{Opened, open};
use std::io::{self, BufRead, BufReader, Cursor, Seek};
use std::path::Path;

/// Reads a picture that covers this. An error says what is wrong with the file and what would be right.
pub(super) fn read(path: &Path, extent: PictureExtent, budget: &mut Budget) -> Result<Picture, String> {
    let shown = path.display();
    let file = match open(path) {
        Ok(Opened::File(file)) => BufReader::new(file),
        Ok(Opened::Folder) => return Err(format!("{shown} is a folder; name a PNG or EXR picture in it")),
        Ok(Opened::Special) => {
            return Err(format!("{shown} is a device or a pipe, not a file; name a PNG or EXR picture"));
        }
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(format!("there is no file {shown}; put the picture there or correct the path"));
        }
        Err(error) => return Err(format!("{shown} cannot be read: {error}")),
    };
    // No picture within the budget has so long a file.
    if file.get_ref().metadata().is_ok_and(|data| data.len() > MAX_WORK_BYTES) {
        return Err(format!("{shown} is longer than {} MiB; use a smaller picture", MAX_WORK_BYTES >> 20));
    }
    decoded(file, extent, budget).map_err(|problem| format!("{shown} {problem}"))
}

/// As [`read`], of the bytes of a file.
pub(super) fn read_bytes(bytes: &[u8], extent: PictureExtent, budget: &mut Budget) -> Result<Picture, String> {
    decoded(Cursor::new(bytes), extent, budget)
}

fn decoded(mut file: impl BufRead + Seek, extent: PictureExtent, budget: &mut Budget) -> Result<Picture, String> {
    let mut start = [0; 4];
    let known = file.read_exact(&mut start).and_then(|()| file.rewind()).is_ok();
    match start {
        [0x89, b'P', b'N', b'G'] if known => from_png::read(file, extent, budget),
        [0x76, 0x2f, 0x31, 0x01] if known => from_exr::read(file, extent, budget),
        _ => Err("is neither PNG nor OpenEXR; save the picture as one of them".to_owned()),
    }
}
