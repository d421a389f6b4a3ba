//! Wavefront OBJ with a material file (MTL) and textures beside it. Each level of detail is an object; colours at
//! vertices follow their positions, as many readers expect.
//!
//! All files are completed before the first takes its place, the OBJ last. Its comments name the files that belong to
//! it with their CRC-32.

use super::geometry::Geometry;
use super::surface::{WATER_OPACITY, WATER_ROUGHNESS};
use super::{MeshBake, Piece, beside, level_name};
use crate::bake::BakeError;
use crate::bake::format::srgb_from_linear;
use crate::bake::sidecar::MADE_BY;
use crate::planet::file::{Staged, stage};
use crate::planet::{Planet, Water};
use serde_json::{Value, json};
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

/// The kinds of texture of a piece.
pub(super) const TEXTURES: [&str; 3] = ["albedo", "normal", "roughness"];

/// The file of a texture.
pub(super) fn texture_path(path: &Path, piece: &str, kind: &str) -> PathBuf {
    beside(path, &format!("_{piece}_{kind}.png"))
}

/// Writes the file and those beside it, all of them or none.
pub(super) fn write(
    mesh: &MeshBake,
    planet: &Planet,
    path: &Path,
    pieces: &[Piece],
) -> Result<Vec<PathBuf>, BakeError> {
    let mut set: Vec<(PathBuf, Staged)> = Vec::new();
    let mut about = mesh.about(planet);
    let mut write = |path: PathBuf, bytes: &[u8]| -> Result<String, BakeError> {
        let staged = stage(&path, None, &mut |file| file.write_all(bytes));
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        about[format!("crc32 of {name}")] = json!(format!("{:08x}", crc32fast::hash(bytes)));
        set.push((path.clone(), staged.map_err(|error| BakeError::file(&path, error))?));
        Ok(name)
    };
    let mut materials = format!("# {MADE_BY}\n");
    for piece in pieces {
        materials.push_str(&format!("\nnewmtl {}\nKs 0 0 0\nPr 0.9\n", piece.name));
        if let Some(textures) = &piece.textures {
            let [albedo, normal, roughness] = TEXTURES.map(|kind| texture_path(path, piece.name, kind));
            let albedo = write(albedo, &textures.albedo)?;
            let normal = write(normal, &textures.normal)?;
            let roughness = write(roughness, &textures.roughness)?;
            materials.push_str(&format!("Kd 1 1 1\nmap_Kd {albedo}\nnorm {normal}\nmap_Pr {roughness}\n"));
        }
    }
    if pieces.iter().any(|piece| !piece.water.is_empty()) {
        materials.push_str(&water_material(planet.water.as_ref()));
    }
    let library = write(beside(path, ".mtl"), materials.as_bytes())?;
    let encode = &mut |file: &mut File| encode(&about, pieces, &library, BufWriter::new(file));
    let staged = stage(path, None, encode).map_err(|error| BakeError::file(path, error))?;
    set.push((path.to_owned(), staged));
    let mut files = Vec::with_capacity(set.len());
    for (path, staged) in set {
        staged.commit().map_err(|error| BakeError::file(&path, error))?;
        files.push(path);
    }
    files.rotate_right(1);
    Ok(files)
}

fn encode(about: &Value, pieces: &[Piece], library: &str, mut out: impl Write) -> io::Result<()> {
    writeln!(out, "# {MADE_BY}")?;
    for (key, value) in about.as_object().into_iter().flatten() {
        writeln!(out, "# {key}: {value}")?;
    }
    writeln!(out, "mtllib {library}")?;
    let mut first = 1;
    for piece in pieces {
        for (level, geometry) in piece.levels.iter().enumerate() {
            let name = level_name(piece.name, level, piece.levels.len());
            object(&mut out, &name, piece.name, geometry, piece.textures.is_none(), &mut first)?;
        }
        for (level, geometry) in piece.water.iter().enumerate() {
            let name = level_name(&format!("{}_water", piece.name), level, piece.water.len());
            object(&mut out, &name, "water", geometry, false, &mut first)?;
        }
    }
    out.flush()
}

/// `first`: number of the object's first vertex in the file.
fn object(
    out: &mut impl Write,
    name: &str,
    material: &str,
    geometry: &Geometry,
    has_colors: bool,
    first: &mut usize,
) -> io::Result<()> {
    writeln!(out, "o {name}\nusemtl {material}")?;
    let mut line = String::new();
    for (i, position) in geometry.positions.iter().enumerate() {
        line.clear();
        let _ = write!(line, "v {} {} {}", position.x, position.y, position.z);
        if let Some(color) = geometry.colors.get(i).filter(|_| has_colors) {
            let [red, green, blue] = color.to_array().map(|value| srgb_from_linear(value.into()));
            let _ = write!(line, " {red:.4} {green:.4} {blue:.4}");
        }
        writeln!(out, "{line}")?;
    }
    for normal in &geometry.normals {
        writeln!(out, "vn {:.5} {:.5} {:.5}", normal.x, normal.y, normal.z)?;
    }
    // Pictures begin at the lower left here.
    for uv in &geometry.uvs {
        writeln!(out, "vt {} {}", uv.x, 1.0 - uv.y)?;
    }
    for triangle in geometry.triangles() {
        let [a, b, c] = triangle.map(|index| index as usize + *first);
        writeln!(out, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}")?;
    }
    *first += geometry.positions.len();
    Ok(())
}

fn water_material(water: Option<&Water>) -> String {
    let common = Water::default();
    let [red, green, blue] = water.unwrap_or(&common).color.map(srgb_from_linear);
    format!("\nnewmtl water\nKd {red:.4} {green:.4} {blue:.4}\nKs 0 0 0\nd {WATER_OPACITY}\nPr {WATER_ROUGHNESS}\n")
}
