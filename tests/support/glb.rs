//! Small meshes in glTF, made by hand.
#![allow(dead_code, unreachable_pub)]

use std::fmt::Write as _;

/// A part of a mesh: a node with triangles of one material.
#[derive(Clone)]
pub struct Part {
    pub name: &'static str,
    /// Place of the node; y is up.
    pub at: [f32; 3],
    pub positions: Vec<[f32; 3]>,
    pub triangles: Vec<[u16; 3]>,
    /// Linear sRGB.
    pub color: [f32; 3],
    /// Alpha mode of the material.
    pub alpha: &'static str,
}

/// A box on the ground, closed, with the front outside.
pub fn block(size: [f32; 3], foot_m: f32, color: [f32; 3]) -> Part {
    let [x, y, z] = [0.5 * size[0], size[1], 0.5 * size[2]];
    let corner = |i: u16| {
        [[-x, x][usize::from(i & 1)], foot_m + [0.0, y][usize::from(i >> 1 & 1)], [-z, z][usize::from(i >> 2)]]
    };
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3]];
    Part {
        name: "block",
        at: [0.0; 3],
        positions: (0..8).map(corner).collect(),
        triangles: faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect(),
        color,
        alpha: "OPAQUE",
    }
}

/// A trunk and a crown: boxes, 5 high.
pub fn tree() -> Vec<Part> {
    let trunk = Part { name: "trunk", ..block([0.6, 2.2, 0.6], -0.2, [0.3, 0.1, 0.05]) };
    let crown = Part { name: "crown", alpha: "MASK", ..block([3.0, 3.0, 3.0], 2.0, [0.05, 0.4, 0.1]) };
    vec![trunk, crown]
}

/// The document and its buffer. `uri`: where the buffer is; none is the binary part of a GLB.
pub fn document(parts: &[Part], uri: Option<&str>) -> (String, Vec<u8>) {
    let (mut bytes, mut views, mut accessors) = (Vec::new(), String::new(), String::new());
    let (mut meshes, mut nodes, mut materials) = (String::new(), String::new(), String::new());
    let mut add = |data: &[u8], kind: &str, count: usize| {
        let comma = if views.is_empty() { "" } else { "," };
        write!(views, "{comma}{{\"buffer\":0,\"byteOffset\":{},\"byteLength\":{}}}", bytes.len(), data.len()).unwrap();
        let index = accessors.matches("bufferView").count();
        write!(accessors, "{comma}{{\"bufferView\":{index},\"count\":{count},{kind}}}").unwrap();
        bytes.extend_from_slice(data);
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        index
    };
    for (i, part) in parts.iter().enumerate() {
        let comma = if i == 0 { "" } else { "," };
        let floats: Vec<u8> = part.positions.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let order: Vec<u8> = part.triangles.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
        let places = "\"componentType\":5126,\"type\":\"VEC3\",\"min\":[-9,-9,-9],\"max\":[9,9,9]";
        let positions = add(&floats, places, part.positions.len());
        let indices = add(&order, "\"componentType\":5123,\"type\":\"SCALAR\"", 3 * part.triangles.len());
        let ([x, y, z], [r, g, b], name, alpha) = (part.at, part.color, part.name, part.alpha);
        write!(
            meshes,
            "{comma}{{\"primitives\":[{{\"attributes\":{{\"POSITION\":{positions}}},\"indices\":{indices},\
             \"material\":{i}}}]}}"
        )
        .unwrap();
        write!(nodes, "{comma}{{\"name\":\"{name}\",\"mesh\":{i},\"translation\":[{x},{y},{z}]}}").unwrap();
        write!(
            materials,
            "{comma}{{\"alphaMode\":\"{alpha}\",\"pbrMetallicRoughness\":{{\"baseColorFactor\":[{r},{g},{b},1]}}}}"
        )
        .unwrap();
    }
    let tops: Vec<String> = (0..parts.len()).map(|i| i.to_string()).collect();
    let uri = uri.map(|uri| format!(",\"uri\":\"{uri}\"")).unwrap_or_default();
    let text = format!(
        "{{\"asset\":{{\"version\":\"2.0\"}},\"scene\":0,\"scenes\":[{{\"nodes\":[{}]}}],\"nodes\":[{nodes}],\
         \"meshes\":[{meshes}],\"materials\":[{materials}],\"accessors\":[{accessors}],\"bufferViews\":[{views}],\
         \"buffers\":[{{\"byteLength\":{}{uri}}}]}}",
        tops.join(","),
        bytes.len()
    );
    (text, bytes)
}

/// A document with its buffer in one file.
pub fn packed(mut text: String, bytes: &[u8]) -> Vec<u8> {
    while !text.len().is_multiple_of(4) {
        text.push(' ');
    }
    let words = |value: usize| (value as u32).to_le_bytes();
    let mut out = [b"glTF".as_slice(), &words(2), &words(12 + 8 + text.len() + 8 + bytes.len())].concat();
    out.extend([&words(text.len()), b"JSON".as_slice(), text.as_bytes()].concat());
    out.extend([&words(bytes.len()), b"BIN\0".as_slice(), bytes].concat());
    out
}

/// A binary glTF file of parts.
pub fn glb(parts: &[Part]) -> Vec<u8> {
    let (text, bytes) = document(parts, None);
    packed(text, &bytes)
}
