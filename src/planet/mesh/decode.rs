//! The scene of a glTF document: what it needs, its nodes and their materials.

use super::data::{MeshData, MeshNode};
use super::surface::{self, Left, Paint, z_up};
use super::texture::Texture;
use crate::planet::key::fnv1a;
use glam::{Mat4, Vec3, Vec4};
use gltf::material::AlphaMode;
use gltf::{Document, Gltf, Material, Node, buffer, image};
use std::collections::HashMap;
use std::path::PathBuf;

/// Most nodes that are visited: nodes may be named many times.
const MOST_NODES: usize = 20_000;
/// Most nodes one within another.
const MOST_DEPTH: usize = 64;
/// Greatest distance of a node's corners from its foot, in heights of the mesh.
const MOST_WIDE: f32 = 50.0;
/// Most objects of a document: each takes more memory than text.
const MOST_OBJECTS: usize = 300_000;
/// Most pixels of all pictures of a file.
const MOST_PIXELS: usize = 1 << 28;
/// Most bytes of all buffers and pictures that a document names in files: one file may be named many times.
const MOST_BYTES: usize = 512 << 20;
/// Parts of names of materials of leaves.
const LEAVES: [&str; 4] = ["leaf", "leaves", "foliage", "needle"];
/// Extensions that a file may need: those that change no triangle, or that are read.
const READ: [&str; 5] =
    ["KHR_mesh_quantization", "KHR_texture_transform", "KHR_lights_punctual", "KHR_node_visibility", "KHR_xmp_json_ld"];

/// Gives the bytes of a file by its path from the folder of the document.
pub(super) type Fetch<'a> = dyn FnMut(&str) -> Result<Vec<u8>, String> + 'a;

/// Reads a document and the files that it names. The paths of [`MeshData`] are from its folder.
pub(super) fn decode(bytes: &[u8], fetch: &mut Fetch<'_>) -> Result<MeshData, String> {
    let (document, blob) = parsed(bytes)?;
    let mut files = Files { fetch, others: Vec::new(), hash: fnv1a(bytes), left: MOST_BYTES };
    let mut buffers = Vec::new();
    let mut blob = blob;
    for buffer in document.buffers() {
        let bytes = match buffer.source() {
            buffer::Source::Bin => blob.take().ok_or("is broken: its binary part is missing; export it anew")?,
            buffer::Source::Uri(uri) => files.read(uri)?,
        };
        buffers.push(bytes);
    }
    let textures = textures(&document, &buffers, &mut files)?;
    let Some(scene) = document.default_scene().or_else(|| document.scenes().next()) else {
        return Err("has no scene; export one with the mesh in it".to_owned());
    };
    let mut walk =
        Walk { textures: &textures, buffers: &buffers, left: Left::all(), visited: 0, mixes: mixes(&document) };
    let nodes = scene.nodes().map(|top| walk.top(&top)).collect::<Result<Vec<_>, _>>()?;
    let nodes: Vec<MeshNode> = nodes.into_iter().filter(|node| !node.triangles.is_empty()).collect();
    check(&nodes)?;
    Ok(MeshData::new(nodes, files.others, files.hash))
}

/// The document, and the binary part of a GLB.
fn parsed(bytes: &[u8]) -> Result<(Document, Option<Vec<u8>>), String> {
    let is_text = bytes.iter().find(|byte| !byte.is_ascii_whitespace()) == Some(&b'{');
    if !bytes.starts_with(b"glTF") && !is_text {
        return Err("is no glTF 2.0 file; export the mesh as .glb or .gltf".to_owned());
    }
    let text = gltf::Glb::from_slice(bytes).map(|glb| glb.json);
    if text.as_deref().unwrap_or(bytes).iter().filter(|byte| **byte == b'{').count() > MOST_OBJECTS {
        return Err(format!("has more than {MOST_OBJECTS} nodes, accessors and others; export a mesh with fewer"));
    }
    let read = Gltf::from_slice_without_validation(bytes).map_err(|error| match error {
        gltf::Error::Deserialize(at) => {
            format!("is no glTF 2.0 document from line {}, column {} on; export it anew", at.line(), at.column())
        }
        _ => "is broken: its parts are not as long as it says; export it anew".to_owned(),
    })?;
    let mut json = read.document.into_json();
    if !json.asset.version.starts_with("2.") {
        return Err(format!("is glTF {:?}; export it as glTF 2.0", json.asset.version));
    }
    if let Some(needed) = json.extensions_required.iter().find(|needed| !is_read(needed)) {
        return Err(match needed.as_str() {
            "KHR_draco_mesh_compression" => "is compressed with Draco; export it without compression".to_owned(),
            "EXT_meshopt_compression" | "KHR_meshopt_compression" => {
                "is compressed with meshopt; export it without compression".to_owned()
            }
            other => format!("needs the extension {other:?}, which is not read; export it without"),
        });
    }
    json.extensions_required.clear();
    let document = Document::from_json(json).map_err(|error| match error {
        gltf::Error::Validation(all) => {
            let place = all.first().map(|(path, _)| path.to_string()).unwrap_or_default();
            format!("is no valid glTF 2.0: see {place}; export it anew")
        }
        _ => "is no valid glTF 2.0; export it anew".to_owned(),
    })?;
    Ok((document, read.blob))
}

/// Whether a file may need this extension. Materials give more than the colours that are read.
fn is_read(extension: &str) -> bool {
    READ.contains(&extension) || extension.starts_with("KHR_materials_")
}

/// The files that a document names.
struct Files<'a, 'b> {
    fetch: &'a mut Fetch<'b>,
    others: Vec<PathBuf>,
    hash: u64,
    /// Bytes that further files may have.
    left: usize,
}

impl Files<'_, '_> {
    /// The bytes at an address: within the document, or of a file in its folder.
    fn read(&mut self, uri: &str) -> Result<Vec<u8>, String> {
        if let Some(data) = uri.strip_prefix("data:") {
            use base64::Engine as _;
            let (_, text) = data.split_once(";base64,").ok_or("has data that is not in base64; export it anew")?;
            let decoded = base64::engine::general_purpose::STANDARD.decode(text);
            return decoded.map_err(|_| "has data that is no base64; export it anew".to_owned());
        }
        let name = percent_encoding::percent_decode_str(uri).decode_utf8_lossy().into_owned();
        let is_out = name.starts_with('/')
            || name.contains([':', '\\'])
            || name.chars().any(char::is_control)
            || name.split('/').any(|step| step == "..");
        if is_out {
            return Err(format!("names the file {name:?}, which is not in its folder; put it there"));
        }
        let bytes = (self.fetch)(&name)?;
        self.left = self
            .left
            .checked_sub(bytes.len())
            .ok_or_else(|| format!("names more than {} MiB of files; use fewer or smaller ones", MOST_BYTES >> 20))?;
        self.others.push(PathBuf::from(&name));
        self.hash = fnv1a(&[self.hash.to_le_bytes(), fnv1a(&bytes).to_le_bytes()].concat());
        Ok(bytes)
    }
}

/// The pictures of colours of all materials, by the numbers of their images.
fn textures(
    document: &Document,
    buffers: &[Vec<u8>],
    files: &mut Files<'_, '_>,
) -> Result<HashMap<usize, Texture>, String> {
    let (mut found, mut left) = (HashMap::new(), MOST_PIXELS);
    let of_colors = |material: Material<'_>| {
        Some(material.pbr_metallic_roughness().base_color_texture()?.texture().source().index())
    };
    let wanted: Vec<usize> = document.materials().filter_map(of_colors).collect();
    for image in document.images().filter(|image| wanted.contains(&image.index())) {
        let at = image.index();
        let bytes = match image.source() {
            image::Source::Uri { uri, .. } => files.read(uri)?,
            image::Source::View { view, .. } => {
                let end = view.offset().checked_add(view.length());
                let within = |buffer: &Vec<u8>| buffer.get(view.offset()..end?).map(<[u8]>::to_vec);
                let bytes = buffers.get(view.buffer().index()).and_then(within);
                bytes.ok_or_else(|| format!("is broken: picture {at} lies outside its buffer; export it anew"))?
            }
        };
        found.insert(at, Texture::new(&bytes, &mut left).map_err(|why| format!("has picture {at}, which {why}"))?);
    }
    Ok(found)
}

/// Whether some of the materials have two sides and some have one.
fn mixes(document: &Document) -> bool {
    document.materials().any(|material| material.double_sided())
        && document.materials().any(|material| !material.double_sided())
}

/// The way through a scene.
struct Walk<'a> {
    textures: &'a HashMap<usize, Texture>,
    buffers: &'a [Vec<u8>],
    left: Left,
    visited: usize,
    /// See [`mixes`].
    mixes: bool,
}

impl<'a> Walk<'a> {
    /// A node at the top of the scene, with all below it.
    fn top(&mut self, top: &Node<'_>) -> Result<MeshNode, String> {
        let place = Mat4::from_cols_array_2d(&top.transform().matrix()).w_axis.truncate();
        let name = top.name().unwrap_or_default().to_owned();
        let mut out = MeshNode { name, foot: z_up(place).truncate(), corners: Vec::new(), triangles: Vec::new() };
        let mut waiting = vec![(top.clone(), Mat4::IDENTITY, 0)];
        while let Some((node, above, depth)) = waiting.pop() {
            self.visited += 1;
            if depth > MOST_DEPTH || self.visited > MOST_NODES {
                return Err(format!(
                    "has more than {MOST_NODES} nodes, or more than {MOST_DEPTH} one within another; join them"
                ));
            }
            let world = above * Mat4::from_cols_array_2d(&node.transform().matrix());
            // Joints place what has a skin, not the node: as it was modelled, it stands in the frame of the scene.
            let place = if node.skin().is_some() { Mat4::IDENTITY } else { world };
            for primitive in node.mesh().iter().flat_map(gltf::Mesh::primitives) {
                let paint = self.paint(&primitive.material());
                surface::add(&mut out, &primitive, place, &paint, self.buffers, &mut self.left)?;
            }
            waiting.extend(node.children().map(|child| (child, world, depth + 1)));
        }
        Ok(out)
    }

    fn paint(&self, material: &Material<'_>) -> Paint<'a> {
        let color = material.pbr_metallic_roughness();
        let has_holes = material.alpha_mode() != AlphaMode::Opaque;
        let name = material.name().unwrap_or_default().to_lowercase();
        let texture = color.base_color_texture();
        let texture =
            texture.and_then(|info| Some((self.textures.get(&info.texture().source().index())?, info.tex_coord())));
        Paint {
            factor: Vec4::from_array(color.base_color_factor()).truncate(),
            texture,
            has_holes,
            is_leaf: has_holes
                || LEAVES.iter().any(|leaf| name.contains(leaf))
                || self.mixes && material.double_sided(),
        }
    }
}

/// Whether nodes have the size of an object.
fn check(nodes: &[MeshNode]) -> Result<(), String> {
    if nodes.is_empty() {
        return Err("has no triangles in its scene; export the mesh with them".to_owned());
    }
    let corners = || nodes.iter().flat_map(|node| &node.corners);
    let top = corners().fold(0.0_f32, |top, corner| top.max(corner.position.z));
    if top < 1e-6 {
        return Err("has nothing above its ground, which is at y = 0 in the file; move it up".to_owned());
    }
    for node in nodes {
        let wide =
            |foot: Vec3| node.corners.iter().fold(0.0_f32, |most, corner| most.max((corner.position - foot).length()));
        let wide = wide(Vec3::ZERO).min(wide(node.foot.extend(0.0))) / top;
        if wide > MOST_WIDE {
            return Err(format!(
                "reaches {wide:.0} times as far from its foot as it is high; use at most {MOST_WIDE} times"
            ));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_that_are_named_many_times_are_refused_before_they_fill_the_memory() {
        let mut fetch = |_: &str| Ok(vec![0; 100]);
        let mut files = Files { fetch: &mut fetch, others: Vec::new(), hash: 0, left: 250 };
        assert!(files.read("a.bin").is_ok() && files.read("a.bin").is_ok());
        let why = files.read("a.bin").unwrap_err();
        assert!(why.contains("more than 512 MiB of files"), "{why}");
    }
}
