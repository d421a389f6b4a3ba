//! Triangles of a primitive: places, normals and colours.

use super::accessor::{floats, indices};
use super::data::{MAX_TRIANGLES, MeshCorner, MeshNode};
use super::texture::Texture;
use glam::{Mat3, Mat4, Vec2, Vec3};
use gltf::mesh::Mode;
use gltf::{Primitive, Semantic};

/// Share of a picture's opaque pixels above which a triangle keeps its size, and below which it is left out.
const OPAQUE: [f32; 2] = [0.95, 0.02];

/// The look of a material.
pub(super) struct Paint<'a> {
    /// Factor on all colours, linear sRGB.
    pub(super) factor: Vec3,
    /// Picture of colours, and the number of its set of places.
    pub(super) texture: Option<(&'a Texture, u32)>,
    /// Whether the picture cuts holes.
    pub(super) has_holes: bool,
    /// Whether it is that of leaves.
    pub(super) is_leaf: bool,
}

/// A direction or a place of a file, whose y axis points up, as one of a form, whose z axis does.
pub(super) fn z_up(v: Vec3) -> Vec3 {
    Vec3::new(v.x, -v.z, v.y)
}

/// Budget that is left to a file.
pub(super) struct Left {
    triangles: usize,
    corners: usize,
}

impl Left {
    /// Budget of a whole file. Corners that no triangle has count, too.
    pub(super) fn all() -> Self {
        Self { triangles: MAX_TRIANGLES, corners: 4 * MAX_TRIANGLES }
    }

    fn take_corners(&mut self, count: usize) -> Result<(), String> {
        self.corners = self
            .corners
            .checked_sub(count)
            .ok_or_else(|| format!("has more than {} corners; export a mesh with fewer", 4 * MAX_TRIANGLES))?;
        Ok(())
    }

    fn take_triangles(&mut self, count: usize) -> Result<(), String> {
        self.triangles = self.triangles.checked_sub(count).ok_or_else(|| {
            format!("has more than {MAX_TRIANGLES} triangles, the limit of a mesh; export one with fewer")
        })?;
        Ok(())
    }
}

/// Adds the triangles of a primitive to a node. Points and lines have none.
pub(super) fn add(
    out: &mut MeshNode,
    primitive: &Primitive<'_>,
    world: Mat4,
    paint: &Paint<'_>,
    buffers: &[Vec<u8>],
    left: &mut Left,
) -> Result<(), String> {
    if !matches!(primitive.mode(), Mode::Triangles | Mode::TriangleStrip | Mode::TriangleFan) {
        return Ok(());
    }
    let most = 3 * MAX_TRIANGLES;
    let Some(places) = primitive.get(&Semantic::Positions) else { return Ok(()) };
    left.take_corners(places.count())?;
    let places = floats::<3>(&places, buffers, most, 0.0)?;
    let order = match primitive.indices() {
        Some(order) => indices(&order, buffers, most)?,
        None => (0..places.len() as u32).collect(),
    };
    let triangles = triangles(primitive.mode(), &order);
    left.take_triangles(triangles.len())?;
    if triangles.iter().flatten().any(|&at| at as usize >= places.len()) {
        return Err("is broken: an index leads to no corner; export it anew".to_owned());
    }
    let with = |semantic: Semantic| primitive.get(&semantic).filter(|found| found.count() == places.len());
    let normals = with(Semantic::Normals).map(|found| floats::<3>(&found, buffers, most, 0.0)).transpose()?;
    let colors = with(Semantic::Colors(0)).map(|found| floats::<4>(&found, buffers, most, 1.0)).transpose()?;
    let set = paint.texture.map_or(0, |(_, set)| set);
    let on_picture = with(Semantic::TexCoords(set)).filter(|_| paint.texture.is_some());
    let on_picture = on_picture.map(|found| floats::<2>(&found, buffers, most, 0.0)).transpose()?;
    let turn = Mat3::from_mat4(world);
    let mirrors = turn.determinant() < 0.0;
    // A normal keeps square to its surface where axes are stretched; cofactors need no inverse.
    let cofactors =
        Mat3::from_cols(turn.y_axis.cross(turn.z_axis), turn.z_axis.cross(turn.x_axis), turn.x_axis.cross(turn.y_axis));
    let sign = if mirrors { -1.0 } else { 1.0 };
    let corner = |at: usize| {
        let color = colors.as_ref().map_or(Vec3::ONE, |colors| Vec3::from_slice(&colors[at]));
        MeshCorner {
            position: z_up(world.transform_point3(Vec3::from_array(places[at]))),
            normal: normals.as_ref().map_or(Vec3::ZERO, |normals| {
                (z_up(cofactors * Vec3::from_array(normals[at])) * sign).normalize_or_zero()
            }),
            color: (paint.factor * color).clamp(Vec3::ZERO, Vec3::ONE),
            is_leaf: paint.is_leaf,
        }
    };
    let corners: Vec<MeshCorner> = (0..places.len()).map(corner).collect();
    if corners.iter().any(|corner| !(corner.position.is_finite() && corner.color.is_finite())) {
        return Err("has corners that are no finite numbers; export it anew".to_owned());
    }
    let mut shared = Shared { out, corners, places: vec![None; places.len()], tints: Vec::new() };
    for [a, b, c] in triangles {
        let [a, b, c] = if mirrors { [a, c, b] } else { [a, b, c] }.map(|at| at as usize);
        let seen = paint
            .texture
            .zip(on_picture.as_ref())
            .map(|((texture, _), on_picture)| texture.mean([a, b, c].map(|at| Vec2::from_array(on_picture[at]))));
        let (tint, alpha) = seen.unwrap_or((Vec3::ONE, 1.0));
        shared.triangle([a, b, c], tint, if paint.has_holes { alpha } else { 1.0 });
    }
    shared.finish();
    Ok(())
}

/// Triples of indices.
fn triangles(mode: Mode, order: &[u32]) -> Vec<[u32; 3]> {
    let triples = || order.windows(3).enumerate();
    match mode {
        Mode::Triangles => order.chunks_exact(3).map(|t| [t[0], t[1], t[2]]).collect(),
        Mode::TriangleStrip => {
            triples().map(|(i, t)| if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] }).collect()
        }
        _ => triples().skip(1).map(|(_, t)| [order[0], t[1], t[2]]).chain(first(order)).collect(),
    }
}

/// First triangle of a fan.
fn first(order: &[u32]) -> Option<[u32; 3]> {
    order.get(..3).map(|t| [t[0], t[1], t[2]])
}

/// Corners of a primitive on their way into a node: those with a normal are shared by their triangles, those of faces
/// without one are not.
struct Shared<'a> {
    out: &'a mut MeshNode,
    corners: Vec<MeshCorner>,
    /// Where each corner is in the node.
    places: Vec<Option<u32>>,
    /// For each shared corner its place in the node, and the sum and number of the colours of pictures around it.
    tints: Vec<(u32, Vec3, f32)>,
}

impl Shared<'_> {
    fn triangle(&mut self, at: [usize; 3], tint: Vec3, alpha: f32) {
        let [a, b, c] = at.map(|at| self.corners[at]);
        let face = (b.position - a.position).cross(c.position - a.position);
        let Some(face) = face.try_normalize() else { return };
        if alpha < OPAQUE[1] {
            return;
        }
        let has_normals = [a, b, c].iter().all(|corner| corner.normal != Vec3::ZERO);
        if has_normals && alpha > OPAQUE[0] {
            let triangle = at.map(|at| self.shared(at, tint));
            self.out.triangles.push(triangle);
            return;
        }
        // A face with holes is as large as what is left of it.
        let (middle, scale) = ((a.position + b.position + c.position) / 3.0, alpha.sqrt());
        let first = self.out.corners.len() as u32;
        self.out.corners.extend([a, b, c].map(|corner| MeshCorner {
            position: if alpha > OPAQUE[0] { corner.position } else { middle + (corner.position - middle) * scale },
            normal: if has_normals { corner.normal } else { face },
            color: corner.color * tint,
            ..corner
        }));
        self.out.triangles.push([first, first + 1, first + 2]);
    }

    /// Place of a shared corner in the node.
    fn shared(&mut self, at: usize, tint: Vec3) -> u32 {
        let slot = match self.places[at] {
            Some(slot) => slot,
            None => {
                let slot = self.tints.len() as u32;
                self.tints.push((self.out.corners.len() as u32, Vec3::ZERO, 0.0));
                self.out.corners.push(self.corners[at]);
                self.places[at] = Some(slot);
                slot
            }
        };
        let (place, sum, count) = &mut self.tints[slot as usize];
        *sum += tint;
        *count += 1.0;
        *place
    }

    fn finish(self) {
        for (place, sum, count) in self.tints {
            self.out.corners[place as usize].color *= sum / count.max(1.0);
        }
    }
}
