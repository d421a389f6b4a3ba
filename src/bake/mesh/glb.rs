//! Binary glTF 2.0 (Khronos 2021, "glTF 2.0 specification"): one file with the meshes and their textures. Levels of
//! detail follow MSFT_lod: a reader that does not know it shows the finest level. Quantised vertices follow
//! KHR_mesh_quantization: a reader must know it.

use super::chunks::{self, ARRAY_BUFFER, BYTE, ELEMENT_ARRAY_BUFFER, FLOAT, UNSIGNED_INT, UNSIGNED_SHORT};
use super::chunks::{floats, padded, share_shorts, shorts};
use super::geometry::Geometry;
use super::quantize;
use super::surface::{WATER_OPACITY, WATER_ROUGHNESS};
use super::textures::Textures;
use super::{Piece, Steps, level_name};
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
const LINEAR: u32 = 9729;
const LINEAR_MIPMAP_LINEAR: u32 = 9987;
const CLAMP_TO_EDGE: u32 = 33_071;
const QUANTIZATION: &str = "KHR_mesh_quantization";

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
    /// The same as whole numbers of fewer bits.
    ShortVectors(&'a [Vec3]),
    ByteNormals(&'a [Vec3]),
    ByteTangents(&'a [Vec3]),
    ShortPlaces(&'a [Vec2]),
    ShortTriangles(&'a Geometry),
    File(&'a [u8]),
}

/// How the elements of a part are told to a reader.
struct Layout {
    /// What the specification calls an element.
    kind: &'static str,
    /// The type of its numbers.
    component: u32,
    /// Whether whole numbers stand for 0 to 1, or -1 to 1.
    is_normalized: bool,
    /// Bytes from one element to the next.
    stride: usize,
    /// Whether the last of these bytes are none of the element.
    is_padded: bool,
}

impl Part<'_> {
    /// Elements.
    fn count(&self) -> usize {
        match self {
            Part::Vectors(vectors)
            | Part::Tangents(vectors)
            | Part::Colors(vectors)
            | Part::ShortVectors(vectors)
            | Part::ByteNormals(vectors)
            | Part::ByteTangents(vectors) => vectors.len(),
            Part::Places(places) | Part::ShortPlaces(places) => places.len(),
            Part::Triangles(geometry) | Part::ShortTriangles(geometry) => geometry.triangle_count() * 3,
            Part::File(file) => file.len(),
        }
    }

    fn layout(&self) -> Layout {
        let layout = |kind, component, is_normalized, stride, is_padded| Layout {
            kind,
            component,
            is_normalized,
            stride,
            is_padded,
        };
        match self {
            Part::Vectors(_) => layout("VEC3", FLOAT, false, 12, false),
            Part::Places(_) => layout("VEC2", FLOAT, false, 8, false),
            Part::Tangents(_) => layout("VEC4", FLOAT, false, 16, false),
            Part::Colors(_) => layout("VEC4", UNSIGNED_SHORT, true, 8, false),
            Part::Triangles(_) => layout("SCALAR", UNSIGNED_INT, false, 4, false),
            // Whole numbers as they are: floats of 32 bits hold them exactly, which is not so of 65535ths.
            Part::ShortVectors(_) => layout("VEC3", UNSIGNED_SHORT, false, 8, true),
            Part::ByteNormals(_) => layout("VEC3", BYTE, true, 4, true),
            Part::ByteTangents(_) => layout("VEC4", BYTE, true, 4, false),
            Part::ShortPlaces(_) => layout("VEC2", UNSIGNED_SHORT, true, 4, false),
            Part::ShortTriangles(_) => layout("SCALAR", UNSIGNED_SHORT, false, 2, false),
            // No element of an accessor.
            Part::File(_) => layout("SCALAR", BYTE, false, 1, false),
        }
    }

    /// Length in bytes.
    fn length(&self) -> usize {
        self.count() * self.layout().stride
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        match self {
            Part::Vectors(vectors) => vectors.iter().try_for_each(|vector| floats(out, &vector.to_array())),
            Part::Places(places) => places.iter().try_for_each(|place| floats(out, &place.to_array())),
            Part::Tangents(tangents) => {
                tangents.iter().try_for_each(|tangent| floats(out, &tangent.extend(1.0).to_array()))
            }
            Part::Colors(colors) => {
                colors.iter().try_for_each(|color| shorts(out, &share_shorts(color.extend(1.0).to_array())))
            }
            Part::Triangles(geometry) => {
                geometry.triangles().flatten().try_for_each(|index| out.write_all(&index.to_le_bytes()))
            }
            Part::ShortVectors(vectors) => {
                vectors.iter().try_for_each(|vector| shorts(out, &quantize::position(*vector)))
            }
            Part::ByteNormals(normals) => {
                normals.iter().try_for_each(|normal| bytes(out, quantize::unit(*normal, 0.0)))
            }
            Part::ByteTangents(tangents) => {
                tangents.iter().try_for_each(|tangent| bytes(out, quantize::unit(*tangent, 1.0)))
            }
            Part::ShortPlaces(places) => places.iter().try_for_each(|place| shorts(out, &quantize::place(*place))),
            Part::ShortTriangles(geometry) => {
                geometry.triangles().flatten().try_for_each(|index| shorts(out, &[index as u16]))
            }
            Part::File(file) => out.write_all(file),
        }
    }
}

fn bytes(out: &mut impl Write, values: [i8; 4]) -> io::Result<()> {
    out.write_all(&values.map(i8::cast_unsigned))
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
    /// Whether vertices of a piece are whole numbers.
    is_quantized: bool,
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
            is_quantized: false,
            water_material: water_material(planet.water.as_ref()),
        }
    }

    fn add(&mut self, piece: &'a Piece) {
        let material = self.ground_material(piece);
        self.is_quantized |= piece.steps.is_some();
        self.add_levels(piece.name, &piece.levels, material, (piece.textures.is_some(), piece.steps.as_ref()));
        if !piece.water.is_empty() {
            let material = self.push_material(self.water_material.clone());
            self.add_levels(&format!("{}_water", piece.name), &piece.water, material, (false, piece.steps.as_ref()));
        }
    }

    /// A node for each level of detail. The first refers to the others. `is_textured`: whether there are tangents.
    fn add_levels(
        &mut self,
        name: &str,
        levels: &'a [Geometry],
        material: usize,
        (is_textured, steps): (bool, Option<&Steps>),
    ) {
        let first = self.nodes.len();
        for (level, geometry) in levels.iter().enumerate() {
            let name = level_name(name, level, levels.len());
            let primitive = self.primitive(geometry, material, (is_textured, steps.is_some()));
            let mut node = json!({ "name": name, "mesh": self.meshes.len() });
            if let Some(Steps { step, corner }) = steps {
                node["scale"] = json!([step, step, step]);
                if *corner != DVec3::ZERO {
                    node["translation"] = json!(corner.to_array());
                }
            }
            self.nodes.push(node);
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

    fn primitive(
        &mut self,
        geometry: &'a Geometry,
        material: usize,
        (is_textured, is_quantized): (bool, bool),
    ) -> Value {
        let Geometry { positions, normals, uvs, tangents, colors, .. } = geometry;
        let mut parts = if is_quantized {
            vec![
                ("POSITION", Part::ShortVectors(positions)),
                ("NORMAL", Part::ByteNormals(normals)),
                ("TEXCOORD_0", Part::ShortPlaces(uvs)),
            ]
        } else {
            vec![
                ("POSITION", Part::Vectors(positions)),
                ("NORMAL", Part::Vectors(normals)),
                ("TEXCOORD_0", Part::Places(uvs)),
            ]
        };
        if is_textured {
            let part = if is_quantized { Part::ByteTangents(tangents) } else { Part::Tangents(tangents) };
            parts.push(("TANGENT", part));
        } else if !colors.is_empty() {
            parts.push(("COLOR_0", Part::Colors(colors)));
        }
        let first = self.accessors.len();
        let mut attributes = json!({});
        for (name, part) in parts {
            attributes[name] = json!(self.accessor(part, ARRAY_BUFFER));
        }
        let corners = geometry.bounds().map(|corner| if is_quantized { corner.round() } else { corner });
        let [min, max] = corners.map(|corner| corner.to_array());
        self.accessors[first]["min"] = json!(min);
        self.accessors[first]["max"] = json!(max);
        // The greatest number is none of an index.
        let are_short = is_quantized && positions.len() <= usize::from(u16::MAX);
        let triangles = if are_short { Part::ShortTriangles(geometry) } else { Part::Triangles(geometry) };
        let indices = self.accessor(triangles, ELEMENT_ARRAY_BUFFER);
        json!({ "attributes": attributes, "indices": indices, "material": material })
    }

    fn accessor(&mut self, part: Part<'a>, target: u32) -> usize {
        let (count, layout) = (part.count(), part.layout());
        let view = self.view(part);
        self.views[view]["target"] = json!(target);
        if layout.is_padded {
            self.views[view]["byteStride"] = json!(layout.stride);
        }
        let mut accessor = json!({
            "bufferView": view,
            "componentType": layout.component,
            "count": count,
            "type": layout.kind,
        });
        if layout.is_normalized {
            accessor["normalized"] = json!(true);
        }
        self.accessors.push(accessor);
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
        let mut extensions = Vec::new();
        if self.has_levels {
            extensions.push("MSFT_lod");
        }
        if self.is_quantized {
            extensions.push(QUANTIZATION);
            document["extensionsRequired"] = json!([QUANTIZATION]);
        }
        if !extensions.is_empty() {
            document["extensionsUsed"] = json!(extensions);
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

    fn encode(&self, out: impl Write) -> io::Result<()> {
        chunks::encode(out, &self.json(), self.length, "a wider spacing or smaller textures", |out| {
            self.parts.iter().try_for_each(|part| {
                part.write(out)?;
                chunks::padding(out, part.length())
            })
        })
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
