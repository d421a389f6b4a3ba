//! Finds the pictures of a set and reads them: from files, or from their bytes.

use super::compose::Maps;
use super::decode::{Numbers, texels};
use super::names::{Role, beside};
use super::set::TextureSet;
use super::shrink::Pixel;
use crate::planet::open::{Opened, open};
use crate::planet::picture::{Budget, MAX_BYTES, MAX_WORK_BYTES};
use std::io::{self, BufRead, BufReader, Cursor, Seek};
use std::path::Path;
use std::sync::Arc;

trait Source: BufRead + Seek {}
impl<S: BufRead + Seek> Source for S {}

/// Reads the set whose colour picture is this file. Its memory and work are taken from the budget of the planet.
pub(in crate::planet) fn load(color: &Path, budget: &mut Budget) -> Result<Arc<TextureSet>, String> {
    read(color, budget, |path| Ok(opened(path)?.map(|file| Box::new(file) as Box<dyn Source>)))
}

/// Reads a set from the bytes of its colour picture; `fetch` gives those of the pictures beside it.
pub(in crate::planet) fn decoded(
    color: &Path,
    bytes: &[u8],
    mut fetch: impl FnMut(&Path) -> Result<Vec<u8>, String>,
    budget: &mut Budget,
) -> Result<Arc<TextureSet>, String> {
    read(color, budget, |path| {
        Ok(if path == color {
            Some(Box::new(Cursor::new(bytes)))
        } else {
            fetch(path).ok().map(|bytes| Box::new(Cursor::new(bytes)) as Box<dyn Source>)
        })
    })
}

/// Opens the file of a picture. None: there is none.
fn opened(path: &Path) -> Result<Option<BufReader<std::fs::File>>, String> {
    let shown = path.display();
    let file = match open(path) {
        Ok(Opened::File(file)) => file,
        Ok(Opened::Folder) => return Err(format!("{shown} is a folder; name the colour picture of a set in it")),
        Ok(Opened::Special) => return Err(format!("{shown} is a device or a pipe, not a file; name a picture")),
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(format!("{shown} cannot be read: {error}")),
    };
    // No picture within the budget has so long a file.
    if file.metadata().is_ok_and(|data| data.len() > MAX_WORK_BYTES) {
        return Err(format!("{shown} is longer than {} MiB; use a smaller picture", MAX_WORK_BYTES >> 20));
    }
    Ok(Some(BufReader::new(file)))
}

/// `open` gives the content of a picture; None if there is none.
fn read<'a>(
    color: &Path,
    budget: &mut Budget,
    mut open: impl FnMut(&Path) -> Result<Option<Box<dyn Source + 'a>>, String>,
) -> Result<Arc<TextureSet>, String> {
    let mut read = |path: &Path, numbers: Numbers| -> Result<Option<Vec<Pixel>>, String> {
        let Some(file) = open(path)? else { return Ok(None) };
        texels(file, numbers, budget).map(Some).map_err(|why| format!("{} {why}", path.display()))
    };
    let colors = read(color, Numbers::Colors)?
        .ok_or_else(|| format!("there is no file {}; put the picture there or correct the path", color.display()))?;
    let mut maps = Maps::new(colors);
    let mut others = Vec::new();
    for places in beside(color) {
        for (path, role) in places {
            let numbers = if matches!(role, Role::Normal { .. }) { Numbers::Plain } else { Numbers::Grey };
            let Some(texels) = read(&path, numbers)? else { continue };
            let greys = || texels.iter().map(|texel| texel[0]).collect::<Vec<_>>();
            match role {
                Role::Normal { is_directx } => maps.normals = Some((texels, is_directx)),
                Role::Roughness => maps.roughness = Some(greys()),
                Role::Height => maps.heights = Some(greys()),
                Role::Occlusion => maps.occlusion = Some(greys()),
            }
            others.push(path);
            break;
        }
    }
    let set = maps.composed(others);
    // Smaller pictures would not help: all sets take as much.
    budget.keep_layer(set.hash(), set.bytes()).map_err(|_| {
        format!(
            "{} finds no room: the planet's pictures and texture sets keep {} MiB together; use smaller height maps, or \
             one set in several biomes",
            color.display(),
            MAX_BYTES >> 20
        )
    })?;
    Ok(Arc::new(set))
}
