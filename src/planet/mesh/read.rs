//! Opens the file of a mesh and the files that it names, or takes their bytes.

use super::data::MeshData;
use super::decode;
use crate::planet::open::{Opened, open};
use crate::planet::picture::Budget;
use crate::planet::picture::contain::contained;
use std::io::{self, Read as _};
use std::path::Path;
use std::sync::Arc;

/// Longest file of a mesh, and of a buffer or a picture beside it.
pub const MAX_FILE_BYTES: u64 = 128 << 20;

/// Reads a mesh. Its triangles are taken from the budget of the planet.
pub(in crate::planet) fn load(file: &Path, budget: &mut Budget) -> Result<Arc<MeshData>, String> {
    let bytes = whole(file, "mesh")?;
    decoded(file, &bytes, |path| whole(path, "file"), budget)
}

/// Reads a mesh from the bytes of its file; `fetch` gives those of the files beside it.
pub(in crate::planet) fn decoded(
    file: &Path,
    bytes: &[u8],
    mut fetch: impl FnMut(&Path) -> Result<Vec<u8>, String>,
    budget: &mut Budget,
) -> Result<Arc<MeshData>, String> {
    let folder = file.parent().map(Path::to_owned).unwrap_or_default();
    let problem = |why: String| format!("{} {why}", file.display());
    let read = contained(|| {
        decode::decode(bytes, &mut |name| {
            fetch(&folder.join(name)).map_err(|why| format!("needs {name:?} beside it: {why}"))
        })
    });
    let mut mesh = read.map_err(problem)?;
    mesh.others.iter_mut().for_each(|other| *other = folder.join(std::mem::take(other)));
    budget.keep_mesh(mesh.hash, mesh.triangles()).map_err(problem)?;
    Ok(Arc::new(mesh))
}

/// The bytes of a file.
fn whole(path: &Path, what: &str) -> Result<Vec<u8>, String> {
    let shown = path.display();
    let file = match open(path) {
        Ok(Opened::File(file)) => file,
        Ok(Opened::Folder) => return Err(format!("{shown} is a folder; name a file in it")),
        Ok(Opened::Special) => return Err(format!("{shown} is a device or a pipe, not a file; name a file")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            return Err(format!("there is no file {shown}; put the {what} there or correct the path"));
        }
        Err(error) => return Err(format!("{shown} cannot be read: {error}")),
    };
    let mut bytes = Vec::new();
    let read = file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes);
    read.map_err(|error| format!("{shown} cannot be read: {error}"))?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(format!("{shown} is longer than {} MiB; use a smaller {what}", MAX_FILE_BYTES >> 20));
    }
    Ok(bytes)
}
