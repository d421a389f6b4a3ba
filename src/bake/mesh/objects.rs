//! Objects of a region in a binary glTF 2.0 file: a mesh for each population and variant, and its instances
//! (EXT_mesh_gpu_instancing, Khronos 2022).
//!
//! The frame is that of the mesh of the same region, so that both can be put together.

use super::chunks::{self, ARRAY_BUFFER, ELEMENT_ARRAY_BUFFER, FLOAT, UNSIGNED_SHORT};
use super::chunks::{floats, padded, share_shorts, shorts};
use super::square::Square;
use super::{Area, BakeError, Region};
use crate::bake::sidecar::{MADE_BY, of_planet};
use crate::life::form::{Mesh, Vertex};
use crate::life::{Instance, Model};
use crate::planet::file::write_atomically_with;
use crate::planet::{Form, Planet, Population};
use glam::{DMat3, DQuat, DVec3, Vec3};
use serde_json::{Map, Value, json};
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// Roughness of plants and stones.
const ROUGHNESS: f32 = 0.9;

/// Objects of a region that are to be written to a file, each as an instance of a mesh: metres about the region's
/// centre on the reference sphere, +X to the east, +Y up, -Z to the north.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct ObjectBake {
    /// The region, whose centre is the origin.
    pub region: Region,
}

impl ObjectBake {
    /// Longest side of a region: farther from its centre numbers of 32 bits tell no millimetres.
    pub const MOST_SIDE_KM: f64 = 20.0;

    /// A bake of a region.
    pub fn new(region: Region) -> Self {
        Self { region }
    }

    /// Whether the objects of the region can be written.
    ///
    /// # Errors
    /// What is wrong with the region, and what would be right.
    pub fn check(&self, planet: &Planet) -> Result<(), String> {
        self.region.check(planet)?;
        if self.region.side_km > Self::MOST_SIDE_KM {
            return Err(format!(
                "objects {} km apart cannot be told to a millimetre by the 32-bit numbers of a GLB; use at most {} km, \
                and several files",
                self.region.side_km,
                Self::MOST_SIDE_KM
            ));
        }
        Ok(())
    }

    /// Writes objects of a planet; see [`Terrain::instances`](crate::terrain::Terrain::instances). Each population and
    /// variant among them is a node with instances in the order in which they are given. A file that is there is
    /// replaced when the new one is complete.
    ///
    /// # Errors
    /// What is wrong with the region, or with the file.
    pub fn write(&self, planet: &Planet, instances: &[Instance], path: &Path) -> Result<(), BakeError> {
        self.check(planet).map_err(BakeError::Asked)?;
        let mut kinds: BTreeMap<(u16, u8), Vec<&Instance>> = BTreeMap::new();
        for instance in instances {
            kinds.entry((instance.population, instance.variant)).or_default().push(instance);
        }
        let kinds = kinds.into_iter().filter_map(|((index, variant), instances)| {
            let population = planet.life.get(usize::from(index))?;
            Some(Kind { population, index, variant, mesh: Model::nearest(population, variant), instances })
        });
        let kinds: Vec<Kind<'_>> = kinds.collect();
        // A region has one square.
        let Some(square) = Square::all(&Area::Region(self.region), planet.radius_m()).pop() else { return Ok(()) };
        let mut about = of_planet(planet);
        about["lat_deg"] = json!(self.region.lat_deg);
        about["lon_deg"] = json!(self.region.lon_deg);
        about["side_km"] = json!(self.region.side_km);
        let mut document = Document::new(json!({ "name": planet.name, "extras": about }));
        kinds.iter().for_each(|kind| document.add(kind));
        let write = &mut |file: &mut File| document.encode(BufWriter::new(file), &square);
        write_atomically_with(path, None, write).map_err(|error| BakeError::file(path, error))
    }
}

/// The objects of one population and variant.
struct Kind<'a> {
    population: &'a Population,
    index: u16,
    variant: u8,
    mesh: Mesh,
    instances: Vec<&'a Instance>,
}

impl Kind<'_> {
    /// Colour of a vertex, linear sRGB.
    fn color(&self, vertex: &Vertex) -> Vec3 {
        let [first, second] = self.population.colors().map(|color| DVec3::from_array(color).as_vec3());
        (first.lerp(second, vertex.part) * vertex.tint).clamp(Vec3::ZERO, Vec3::ONE)
    }
}

/// What a part of the binary chunk holds.
#[derive(Clone, Copy)]
enum What {
    Positions,
    Normals,
    Colors,
    Light,
    Sway,
    Triangles,
    Feet,
    Turns,
    Sizes,
    Ids,
    Brightness,
}

impl What {
    /// The attributes of vertices, by their names in a file.
    const VERTICES: [(&'static str, What); 5] = [
        ("POSITION", What::Positions),
        ("NORMAL", What::Normals),
        ("COLOR_0", What::Colors),
        ("_LIGHT", What::Light),
        ("_SWAY", What::Sway),
    ];
    /// The attributes of instances.
    const INSTANCES: [(&'static str, What); 5] = [
        ("TRANSLATION", What::Feet),
        ("ROTATION", What::Turns),
        ("SCALE", What::Sizes),
        ("_ID", What::Ids),
        ("_BRIGHTNESS", What::Brightness),
    ];

    /// What the specification calls an element, the type of its numbers, and its bytes.
    fn layout(self) -> (&'static str, u32, usize) {
        match self {
            What::Positions | What::Normals | What::Feet | What::Sizes => ("VEC3", FLOAT, 12),
            What::Turns => ("VEC4", FLOAT, 16),
            What::Colors | What::Ids => ("VEC4", UNSIGNED_SHORT, 8),
            What::Light | What::Sway | What::Brightness => ("SCALAR", FLOAT, 4),
            What::Triangles => ("SCALAR", UNSIGNED_SHORT, 2),
        }
    }
}

/// A part of the binary chunk.
struct Part<'a> {
    what: What,
    kind: &'a Kind<'a>,
}

impl Part<'_> {
    fn count(&self) -> usize {
        match self.what {
            What::Positions | What::Normals | What::Colors | What::Light | What::Sway => self.kind.mesh.vertices.len(),
            What::Triangles => 3 * self.kind.mesh.triangles.len(),
            What::Feet | What::Turns | What::Sizes | What::Ids | What::Brightness => self.kind.instances.len(),
        }
    }

    fn length(&self) -> usize {
        self.count() * self.what.layout().2
    }

    fn write(&self, out: &mut impl Write, square: &Square) -> io::Result<()> {
        let (mut vertices, mut instances) = (self.kind.mesh.vertices.iter(), self.kind.instances.iter());
        match self.what {
            What::Positions => vertices.try_for_each(|vertex| floats(out, &y_up(vertex.position).to_array())),
            What::Normals => vertices.try_for_each(|vertex| floats(out, &y_up(vertex.normal).to_array())),
            What::Colors => vertices
                .try_for_each(|vertex| shorts(out, &share_shorts(self.kind.color(vertex).extend(1.0).to_array()))),
            What::Light => vertices.try_for_each(|vertex| floats(out, &[vertex.light])),
            What::Sway => vertices.try_for_each(|vertex| floats(out, &[vertex.sway])),
            What::Triangles => self.kind.mesh.triangles.iter().try_for_each(|triangle| shorts(out, triangle)),
            What::Feet => instances.try_for_each(|instance| {
                let foot_m = square.position_m(instance.dir_planet, instance.base_m);
                floats(out, &foot_m.as_vec3().to_array())
            }),
            What::Turns => instances.try_for_each(|instance| {
                let form = instance.planet_from_form();
                let [x, y, z] = [form.x_axis, form.z_axis, -form.y_axis].map(|axis| square.turned(axis));
                let turn = DQuat::from_mat3(&DMat3::from_cols(x, y, z)).normalize();
                floats(out, &turn.as_quat().to_array())
            }),
            What::Sizes => instances.try_for_each(|instance| floats(out, &[instance.size_m as f32; 3])),
            // Numbers of 32 bits are not allowed there.
            What::Ids => instances.try_for_each(|instance| out.write_all(&instance.id.to_le_bytes())),
            What::Brightness => instances.try_for_each(|instance| floats(out, &[instance.brightness as f32])),
        }
    }
}

/// A vector of a form, whose z axis points up, in a file, whose y axis does.
fn y_up(vector: Vec3) -> Vec3 {
    Vec3::new(vector.x, vector.z, -vector.y)
}

/// A document that grows kind by kind.
struct Document<'a> {
    parts: Vec<Part<'a>>,
    /// Bytes of the binary chunk so far.
    length: usize,
    views: Vec<Value>,
    accessors: Vec<Value>,
    meshes: Vec<Value>,
    /// The first is the root of the scene.
    nodes: Vec<Value>,
}

impl<'a> Document<'a> {
    fn new(root: Value) -> Self {
        Self {
            parts: Vec::new(),
            length: 0,
            views: Vec::new(),
            accessors: Vec::new(),
            meshes: Vec::new(),
            nodes: vec![root],
        }
    }

    fn add(&mut self, kind: &'a Kind<'a>) {
        let name = format!("{} {}", kind.population.name, kind.variant);
        let attributes = self.attributes(&What::VERTICES, kind, Some(ARRAY_BUFFER));
        let positions = kind.mesh.vertices.iter().map(|vertex| y_up(vertex.position));
        let bounds = positions.fold([Vec3::MAX, Vec3::MIN], |[min, max], at| [min.min(at), max.max(at)]);
        if let Some(accessor) = attributes["POSITION"].as_u64().and_then(|at| self.accessors.get_mut(at as usize)) {
            accessor["min"] = json!(bounds[0].to_array());
            accessor["max"] = json!(bounds[1].to_array());
        }
        let indices = self.accessor(Part { what: What::Triangles, kind }, Some(ELEMENT_ARRAY_BUFFER));
        let primitive = json!({ "attributes": attributes, "indices": indices, "material": 0 });
        let instances = self.attributes(&What::INSTANCES, kind, None);
        let mut about = json!({ "kind": kind.population.name, "population": kind.index, "variant": kind.variant });
        if let Form::Game(form) = &kind.population.form {
            about["asset"] = json!(form.asset);
        }
        self.nodes.push(json!({
            "name": name,
            "mesh": self.meshes.len(),
            "extensions": { INSTANCING: { "attributes": instances } },
            "extras": about,
        }));
        self.meshes.push(json!({ "name": name, "primitives": [primitive] }));
    }

    fn attributes(&mut self, all: &[(&str, What)], kind: &'a Kind<'a>, target: Option<u32>) -> Value {
        let accessors = all.iter().map(|(name, what)| {
            let part = Part { what: *what, kind };
            ((*name).to_owned(), json!(self.accessor(part, target)))
        });
        Value::Object(accessors.collect::<Map<_, _>>())
    }

    fn accessor(&mut self, part: Part<'a>, target: Option<u32>) -> usize {
        let (shape, component, _) = part.what.layout();
        let mut view = json!({ "buffer": 0, "byteOffset": self.length, "byteLength": part.length() });
        if let Some(target) = target {
            view["target"] = json!(target);
        }
        let mut accessor = json!({
            "bufferView": self.views.len(),
            "componentType": component,
            "count": part.count(),
            "type": shape,
        });
        if matches!(part.what, What::Colors) {
            accessor["normalized"] = json!(true);
        }
        self.views.push(view);
        self.accessors.push(accessor);
        self.length += padded(part.length());
        self.parts.push(part);
        self.accessors.len() - 1
    }

    fn json(&self) -> Value {
        let mut document = json!({
            "asset": { "version": "2.0", "generator": MADE_BY },
            "scene": 0,
            "scenes": [{ "nodes": [0] }],
            "nodes": self.nodes,
        });
        // Empty arrays are not allowed.
        if !self.meshes.is_empty() {
            document["nodes"][0]["children"] = (1..self.nodes.len()).collect();
            document["meshes"] = json!(self.meshes);
            document["materials"] = json!([{
                "name": "objects",
                // Blades and leaves have no back of their own.
                "doubleSided": true,
                "pbrMetallicRoughness": { "metallicFactor": 0.0, "roughnessFactor": ROUGHNESS },
            }]);
            document["accessors"] = json!(self.accessors);
            document["bufferViews"] = json!(self.views);
            document["buffers"] = json!([{ "byteLength": self.length }]);
            document["extensionsUsed"] = json!([INSTANCING]);
            document["extensionsRequired"] = json!([INSTANCING]);
        }
        document
    }

    fn encode(&self, out: impl Write, square: &Square) -> io::Result<()> {
        chunks::encode(out, &self.json(), self.length, "a smaller region", |out| {
            self.parts.iter().try_for_each(|part| {
                part.write(out, square)?;
                chunks::padding(out, part.length())
            })
        })
    }
}
