//! Binary glTF 2.0 (Khronos 2021, "glTF 2.0 specification"): one file with the meshes and their textures. Levels of
//! detail follow MSFT_lod: a reader that does not know it shows the finest level.

use super::geometry::Geometry;
use super::surface::{WATER_OPACITY, WATER_ROUGHNESS};
use super::textures::Textures;
use super::{Piece, level_name};
use crate::bake::BakeError;
use crate::bake::sidecar::MADE_BY;
use crate::planet::file::write_atomically_with;
use crate::planet::{Planet, Water};
use glam::{DVec3, Vec2, Vec3};
use serde_json::{Value, json};
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Numbers of the specification.
const FLOAT: u32 = 5126;
const UNSIGNED_INT: u32 = 5125;
const UNSIGNED_SHORT: u32 = 5123;
const ARRAY_BUFFER: u32 = 34_962;
const ELEMENT_ARRAY_BUFFER: u32 = 34_963;
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33_071;
const HEAD: usize = 12;
const CHUNK_HEAD: usize = 8;

/// Share of the picture's height below which a coarser level of detail does, for each halving.
const COVERAGE: f64 = 0.5;

/// Writes the file. `about`: what the root tells; `origin`: where the origin of the pieces is, in the frame and the
/// units of the file.
pub(super) fn write(
    planet: &Planet,
    about: &Value,
    path: &Path,
    pieces: &[Piece],
    origin: DVec3,
) -> Result<(), BakeError> {
    let mut document = Document::new(planet, about);
    if origin != DVec3::ZERO {
        document.nodes[0]["translation"] = json!(origin.to_array());
    }
    for piece in pieces {
        document.add(piece);
    }
    let write = &mut |file: &mut File| document.encode(BufWriter::new(file));
    write_atomically_with(path, None, write).map_err(|error| BakeError::file(path, error))
}

/// Data of the binary chunk, encoded when it is written.
enum Part<'a> {
    Vectors(&'a [Vec3]),
    Places(&'a [Vec2]),
    /// Unit vectors, with 1 as the sign of the bitangent.
    Tangents(&'a [Vec3]),
    /// Colours as whole numbers of 16 bits, opaque.
    Colors(&'a [Vec3]),
    Triangles(&'a Geometry),
    File(&'a [u8]),
}

impl Part<'_> {
    /// Length in bytes.
    fn length(&self) -> usize {
        match self {
            Part::Vectors(vectors) => vectors.len() * 12,
            Part::Places(places) => places.len() * 8,
            Part::Tangents(tangents) => tangents.len() * 16,
            Part::Colors(colors) => colors.len() * 8,
            Part::Triangles(geometry) => geometry.triangle_count() * 12,
            Part::File(file) => file.len(),
        }
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        let mut floats = |values: &[f32]| values.iter().try_for_each(|value| out.write_all(&value.to_le_bytes()));
        match self {
            Part::Vectors(vectors) => vectors.iter().try_for_each(|vector| floats(&vector.to_array())),
            Part::Places(places) => places.iter().try_for_each(|place| floats(&place.to_array())),
            Part::Tangents(tangents) => tangents.iter().try_for_each(|tangent| floats(&tangent.extend(1.0).to_array())),
            Part::Colors(colors) => colors.iter().try_for_each(|color| {
                let numbers = color.extend(1.0).to_array().map(|value| (value * 65_535.0).round() as u16);
                numbers.iter().try_for_each(|number| out.write_all(&number.to_le_bytes()))
            }),
            Part::Triangles(geometry) => {
                geometry.triangles().flatten().try_for_each(|index| out.write_all(&index.to_le_bytes()))
            }
            Part::File(file) => out.write_all(file),
        }
    }
}

/// A document that grows by pieces.
struct Document<'a> {
    parts: Vec<Part<'a>>,
    /// Bytes of the binary chunk so far.
    length: usize,
    views: Vec<Value>,
    accessors: Vec<Value>,
    images: Vec<Value>,
    materials: Vec<Value>,
    meshes: Vec<Value>,
    /// The first is the root of the scene.
    nodes: Vec<Value>,
    /// The nodes under the root.
    children: Vec<usize>,
    has_levels: bool,
    water_material: Value,
}

impl<'a> Document<'a> {
    fn new(planet: &Planet, about: &Value) -> Self {
        Self {
            parts: Vec::new(),
            length: 0,
            views: Vec::new(),
            accessors: Vec::new(),
            images: Vec::new(),
            materials: Vec::new(),
            meshes: Vec::new(),
            nodes: vec![json!({ "name": planet.name, "extras": about })],
            children: Vec::new(),
            has_levels: false,
            water_material: water_material(planet.water.as_ref()),
        }
    }

    fn add(&mut self, piece: &'a Piece) {
        let material = self.ground_material(piece);
        self.add_levels(piece.name, &piece.levels, material, piece.textures.is_some());
        if !piece.water.is_empty() {
            let material = self.push_material(self.water_material.clone());
            self.add_levels(&format!("{}_water", piece.name), &piece.water, material, false);
        }
    }

    /// A node for each level of detail. The first refers to the others.
    fn add_levels(&mut self, name: &str, levels: &'a [Geometry], material: usize, is_textured: bool) {
        let first = self.nodes.len();
        for (level, geometry) in levels.iter().enumerate() {
            let name = level_name(name, level, levels.len());
            let primitive = self.primitive(geometry, material, is_textured);
            self.nodes.push(json!({ "name": name, "mesh": self.meshes.len() }));
            self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
        }
        self.children.push(first);
        let coarser: Vec<_> = (first + 1..self.nodes.len()).collect();
        if !coarser.is_empty() {
            self.has_levels = true;
            let coverage: Vec<_> = (1..=levels.len() as i32).map(|level| COVERAGE.powi(level)).collect();
            self.nodes[first]["extensions"] = json!({ "MSFT_lod": { "ids": coarser } });
            self.nodes[first]["extras"] = json!({ "MSFT_screencoverage": coverage });
        }
    }

    fn primitive(&mut self, geometry: &'a Geometry, material: usize, is_textured: bool) -> Value {
        let count = geometry.positions.len();
        let mut attributes = json!({});
        let mut add = |name: &str, part: Part<'a>, kind: &str, component: u32| {
            let accessor = self.accessor(part, count, kind, component, ARRAY_BUFFER);
            attributes[name] = json!(accessor);
            accessor
        };
        let positions = add("POSITION", Part::Vectors(&geometry.positions), "VEC3", FLOAT);
        add("NORMAL", Part::Vectors(&geometry.normals), "VEC3", FLOAT);
        add("TEXCOORD_0", Part::Places(&geometry.uvs), "VEC2", FLOAT);
        if is_textured {
            add("TANGENT", Part::Tangents(&geometry.tangents), "VEC4", FLOAT);
        } else if !geometry.colors.is_empty() {
            let colors = add("COLOR_0", Part::Colors(&geometry.colors), "VEC4", UNSIGNED_SHORT);
            self.accessors[colors]["normalized"] = json!(true);
        }
        let [min, max] = geometry.bounds().map(|corner| corner.to_array());
        self.accessors[positions]["min"] = json!(min);
        self.accessors[positions]["max"] = json!(max);
        let triangles = Part::Triangles(geometry);
        let count = geometry.triangle_count() * 3;
        let indices = self.accessor(triangles, count, "SCALAR", UNSIGNED_INT, ELEMENT_ARRAY_BUFFER);
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    fn accessor(&mut self, part: Part<'a>, count: usize, kind: &str, component: u32, target: u32) -> usize {
        let view = self.view(part);
        self.views[view]["target"] = json!(target);
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": kind }));
        self.accessors.len() - 1
    }

    fn view(&mut self, part: Part<'a>) -> usize {
        self.views.push(json!({ "buffer": 0, "byteOffset": self.length, "byteLength": part.length() }));
        self.length += padded(part.length());
        self.parts.push(part);
        self.views.len() - 1
    }

    fn ground_material(&mut self, piece: &'a Piece) -> usize {
        let name = piece.name;
        let Some(Textures { albedo, normal, roughness }) = &piece.textures else {
            return self.push_material(json!({
                "name": name,
                "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": 0.9 },
            }));
        };
        let mut texture = |kind: &str, file: &'a [u8]| {
            let view = self.view(Part::File(file));
            let image = json!({ "name": format!("{name}_{kind}"), "mimeType": "image/png", "bufferView": view });
            self.images.push(image);
            json!({ "index": self.images.len() - 1 })
        };
        let [albedo, normal, roughness] =
            [texture("albedo", albedo), texture("normal", normal), texture("roughness", roughness)];
        self.push_material(json!({
            "name": name,
            "pbrMetallicRoughness": { "baseColorTexture": albedo, "metallicRoughnessTexture": roughness },
            "normalTexture": normal,
        }))
    }

    fn push_material(&mut self, material: Value) -> usize {
        self.materials.push(material);
        self.materials.len() - 1
    }

    fn json(&self) -> Value {
        let mut nodes = self.nodes.clone();
        nodes[0]["children"] = json!(self.children);
        let mut document = json!({
            "asset": { "version": "2.0", "generator": MADE_BY },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": nodes,
            "meshes": self.meshes,
            "materials": self.materials,
            "accessors": self.accessors,
            "bufferViews": self.views,
            "buffers": [{ "byteLength": self.length }],
        });
        if self.has_levels {
            document["extensionsUsed"] = json!(["MSFT_lod"]);
        }
        // Empty arrays are not allowed.
        if !self.images.is_empty() {
            document["images"] = json!(self.images);
            let texture = |source: usize| json!({ "source": source, "sampler": 0 });
            document["textures"] = (0..self.images.len()).map(texture).collect();
            document["samplers"] = json!([{
                "magFilter": LINEAR,
                "minFilter": LINEAR_MIPMAP_LINEAR,
                "wrapS": CLAMP_TO_EDGE,
                "wrapT": CLAMP_TO_EDGE,
            }]);
        }
        document
    }

    fn encode(&self, mut out: impl Write) -> io::Result<()> {
        let mut json = serde_json::to_vec(&self.json())?;
        json.resize(padded(json.len()), b' ');
        let total = HEAD + 2 * CHUNK_HEAD + json.len() + self.length;
        let number = |length: usize| {
            u32::try_from(length).map(u32::to_le_bytes).map_err(|_| {
                io::Error::new(
                    io::ErrorKind::InvalidInput,
                    "a GLB holds 4 GiB; use a wider spacing or smaller textures",
                )
            })
        };
        out.write_all(b"glTF")?;
        out.write_all(&2_u32.to_le_bytes())?;
        out.write_all(&number(total)?)?;
        out.write_all(&number(json.len())?)?;
        out.write_all(b"JSON")?;
        out.write_all(&json)?;
        out.write_all(&number(self.length)?)?;
        out.write_all(b"BIN\0")?;
        for part in &self.parts {
            part.write(&mut out)?;
            let padding = padded(part.length()) - part.length();
            out.write_all(&[0; 3][..padding])?;
        }
        out.flush()
    }
}

/// A transparent material. Lakes have the water of the sea, or common water.
fn water_material(water: Option<&Water>) -> Value {
    let common = Water::default();
    let Water { color: [red, green, blue], absorption_per_m, .. } = water.unwrap_or(&common);
    json!({
        "name": "water",
        "alphaMode": "BLEND",
        "pbrMetallicRoughness": {
            "baseColorFactor": [red, green, blue, WATER_OPACITY],
            "metallicFactor": 0.0,
            "roughnessFactor": WATER_ROUGHNESS,
        },
        "extras": { "absorption_per_m": absorption_per_m },
    })
}

/// The next multiple of four: chunks and numbers begin there.
fn padded(length: usize) -> usize {
    length.next_multiple_of(4)
}
