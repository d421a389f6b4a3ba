//! Solid shapes of forms: what bodies hit of an object, measured on its nearest mesh.
//!
//! Stems that rise from the ground (trunks, stalks, tendrils) are rods, section by section; see `stem`. Stones,
//! crystals, cacti, caps and other bodies are convex hulls, one for each connected part of the mesh, or balls. Leaves,
//! blades, needles, fronds and boughs are passed through.

use super::hull::{Hull, Sized};
use super::rod::Rod;
use super::stem;
use crate::life::form::{self, Mesh};
use crate::life::model;
use crate::planet::{Form, Population};
use crate::terrain::ground::convex::{self, Axis, Convex, Nearest};
use glam::DVec3;
use std::collections::HashMap;

/// Parts of a mesh with fewer triangles are leaves and spines.
const LEAST_TRIANGLES: usize = 8;
/// Corners of a hull.
const MOST_CORNERS: usize = 48;
/// A hull leaves points outside by no more than this share of its greatest width, if it has corners enough.
const TOLERANCE: f64 = 0.01;
/// A part is a ball if its corners are at distances from its middle that differ by less than this share.
const BALL: f64 = 0.12;

/// Corners of all triangles of a ball of a file, at least.
const BALL_CORNERS: usize = 240;
/// Height in heights up to which the corners of a stem in a file are its foot, which goes as far into the ground: few
/// have roots.
const FOOT: f32 = 0.02;

/// What bodies hit of an object of height 1: z up, the foot at the origin.
#[derive(Clone, Debug, Default)]
pub(super) struct Shape {
    pub(super) parts: Vec<Part>,
    /// A ball around all parts.
    pub(super) ball: Ball,
    /// Greatest distance of a part's surface from the foot.
    pub(super) reach: f64,
    /// Greatest distance of the mesh's corners, or of a stem's sections, from the surface of their part.
    pub(super) deviation: f64,
}

/// A ball around a thing.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Ball {
    pub(super) middle: DVec3,
    pub(super) radius: f64,
}

/// A convex part of a shape.
#[derive(Clone, Debug)]
pub(super) struct Part {
    pub(super) ball: Ball,
    piece: Piece,
}

#[derive(Clone, Debug)]
enum Piece {
    Rod(Rod),
    Hull(Hull),
}

/// What counts of a form.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Counts {
    Nothing,
    /// Parts that reach into the ground, as stems.
    Stems,
    /// All parts.
    Bodies,
    /// All parts of a file, where a box has few corners at one distance from its middle, as a ball has many.
    Boxes,
    /// Those that reach into the ground as stems, the others as bodies.
    Both,
}

impl Counts {
    fn of(form: &Form) -> Self {
        match form {
            Form::Tree(_) | Form::Conifer(_) | Form::Palm(_) | Form::Fans(_) | Form::Tendrils(_) => Self::Stems,
            Form::Cactus(_) | Form::Mushroom(_) | Form::Cushion(_) => Self::Bodies,
            Form::Wood(_) | Form::Stone(_) | Form::Crystal(_) => Self::Bodies,
            Form::Bulbs(_) => Self::Both,
            Form::Tuft(_) => Self::Nothing,
            Form::Mesh(_) => Self::Boxes,
            Form::Game(_) => Self::Bodies,
        }
    }
}

impl Shape {
    /// The shape of a variant of a population.
    pub(super) fn new(population: &Population, variant: u32) -> Self {
        let counts = Counts::of(&population.form);
        if counts == Counts::Nothing {
            return Self::default();
        }
        let mesh = form::mesh(&population.form, model::seed(population, variant), 0);
        if matches!(population.form, Form::Mesh(_)) { Self::of_file(mesh) } else { Self::measured(&mesh, counts) }
    }

    /// The shape of a mesh of a file: stems if leaves or open ground are around them, bodies otherwise.
    fn of_file(mut mesh: Mesh) -> Self {
        let counts = if form::is_open(&mesh) { Counts::Stems } else { Counts::Boxes };
        mesh.triangles.retain(|triangle| triangle.iter().all(|&at| mesh.vertices[usize::from(at)].part < 0.5));
        for vertex in mesh.vertices.iter_mut().filter(|vertex| counts == Counts::Stems && vertex.position.z < FOOT) {
            vertex.position.z = vertex.position.z.min(-FOOT);
        }
        Self::measured(&mesh, counts)
    }

    fn measured(mesh: &Mesh, counts: Counts) -> Self {
        let mut shape = Self::default();
        for part in connected(mesh) {
            let [lowest, highest] = part
                .iter()
                .flatten()
                .fold([f64::MAX, f64::MIN], |[lowest, highest], corner| [lowest.min(corner.z), highest.max(corner.z)]);
            let is_stem = lowest < 0.0 && matches!(counts, Counts::Stems | Counts::Both);
            if highest <= 0.0 || (counts == Counts::Stems && !is_stem) {
                continue;
            }
            if is_stem {
                let rods = stem::rods(&part);
                shape.deviation = shape.deviation.max(stem::deviation(&part, &rods));
                shape.parts.extend(rods.into_iter().map(Part::rod));
            } else {
                let corners: Vec<DVec3> = part.into_iter().flatten().collect();
                let may_be_ball = counts != Counts::Boxes || corners.len() >= BALL_CORNERS;
                let Some(body) = Part::body(&corners, may_be_ball) else { continue };
                shape.deviation = corners.iter().fold(shape.deviation, |most, corner| most.max(body.over(*corner)));
                shape.parts.push(body);
            }
        }
        shape.ball = Ball::around(shape.parts.iter().map(|part| part.ball));
        let reaches = shape.parts.iter().map(|part| part.ball.middle.length() + part.ball.radius);
        shape.reach = reaches.fold(0.0, f64::max);
        shape
    }
}

impl Shape {
    /// The parts, `size_m` times as large, that may be within a distance of a segment.
    pub(super) fn near_parts(&self, size_m: f64, segment: &Axis, within_m: f64) -> impl Iterator<Item = &Part> {
        self.parts.iter().filter(move |part| {
            let (middle_m, most_m) = (part.ball.middle * size_m, within_m + part.ball.radius * size_m);
            segment.nearest_to(middle_m).distance_squared(middle_m) <= most_m * most_m
        })
    }
}

impl Ball {
    /// A ball around balls, and around the box of their middles.
    pub(super) fn around(balls: impl Iterator<Item = Ball> + Clone) -> Self {
        let box_of = balls.clone().map(|ball| [ball.middle, ball.middle]);
        let Some([low, high]) = box_of.reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]) else { return Self::default() };
        let middle = 0.5 * (low + high);
        let radius = balls.map(|ball| ball.middle.distance(middle) + ball.radius).fold(0.0, f64::max);
        Self { middle, radius }
    }
}

impl Part {
    fn rod(rod: Rod) -> Self {
        let [foot, top] = rod.ends;
        let ball = Ball { middle: 0.5 * (foot + top), radius: 0.5 * foot.distance(top) + rod.radius };
        Self { ball, piece: Piece::Rod(rod) }
    }

    /// A ball or a hull of corners.
    fn body(corners: &[DVec3], may_be_ball: bool) -> Option<Self> {
        let ball = Ball::around(corners.iter().map(|corner| Ball { middle: *corner, radius: 0.0 }));
        let least = corners.iter().map(|corner| corner.distance(ball.middle)).fold(f64::MAX, f64::min);
        if may_be_ball && least > (1.0 - BALL) * ball.radius {
            let radius = 0.5 * (least + ball.radius);
            return Some(Self::rod(Rod { ends: [ball.middle; 2], radius }));
        }
        let hull = Hull::new(corners, 2.0 * TOLERANCE * ball.radius, MOST_CORNERS)?;
        let ball = Ball::around(
            hull.corners().map(|corner| Ball { middle: corner, radius: 0.0 }).collect::<Vec<_>>().into_iter(),
        );
        Some(Self { ball, piece: Piece::Hull(hull) })
    }

    /// How far a point is from the surface, outside or inside.
    fn over(&self, point: DVec3) -> f64 {
        match &self.piece {
            Piece::Rod(rod) => rod.over(point).abs(),
            Piece::Hull(hull) => hull.over(point).abs(),
        }
    }

    /// The part `size_m` times as large: where its surface is nearest to an axis, how far away, and the direction from
    /// it to the axis. Negative: how far the axis must go that way to be out.
    pub(super) fn nearest(&self, size_m: f64, axis: &Axis) -> Near {
        match &self.piece {
            Piece::Rod(rod) => Near::of_rod(rod, size_m, axis, rod.core(size_m).nearest(axis)),
            Piece::Hull(hull) => Near::of_hull(&hull.scaled(size_m), axis, hull.scaled(size_m).nearest(axis)),
        }
    }

    /// How far a capsule goes until it touches the part; see [`convex::impact`].
    pub(super) fn impact(
        &self,
        size_m: f64,
        axis: &Axis,
        dir: DVec3,
        most_m: f64,
        radius_m: f64,
    ) -> Option<(f64, Near)> {
        match &self.piece {
            Piece::Rod(rod) => {
                let wide_m = radius_m + rod.radius * size_m;
                let (gone_m, near) = convex::impact(&rod.core(size_m), axis, dir, most_m, wide_m)?;
                Some((gone_m, Near::of_rod(rod, size_m, &axis.moved(dir * gone_m), near)))
            }
            Piece::Hull(hull) => {
                let sized = hull.scaled(size_m);
                let (gone_m, near) = convex::impact(&sized, axis, dir, most_m, radius_m)?;
                Some((gone_m, Near::of_hull(&sized, &axis.moved(dir * gone_m), near)))
            }
        }
    }

    /// Where a ray enters it, or begins in it, between two distances: the distance, and the normal there.
    pub(super) fn ray(&self, size_m: f64, origin_m: DVec3, dir: DVec3, limits_m: [f64; 2]) -> Option<(f64, DVec3)> {
        match &self.piece {
            Piece::Rod(rod) => rod.ray(size_m, origin_m, dir, limits_m),
            Piece::Hull(hull) => hull.scaled(size_m).ray(origin_m, dir, limits_m),
        }
    }
}

/// Where an axis and the surface of a part are nearest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Near {
    /// Distance of the axis; negative inside.
    pub(super) away_m: f64,
    pub(super) on_part_m: DVec3,
    /// From the part to the axis, or the way out.
    pub(super) normal: DVec3,
}

impl Near {
    fn of_rod(rod: &Rod, size_m: f64, axis: &Axis, near: Nearest) -> Self {
        let [foot, top] = rod.ends;
        // An axis that crosses the middle gets out square to both.
        let aside = (top - foot).cross(axis.to_m - axis.from_m);
        let aside =
            aside.try_normalize().unwrap_or_else(|| (top - foot).normalize_or(DVec3::Z).any_orthonormal_vector());
        let radius_m = rod.radius * size_m;
        let normal = match near.away_m > convex::PRECISE_M {
            true => (near.on_axis_m - near.on_piece_m) / near.away_m,
            false => aside,
        };
        Self { away_m: near.away_m - radius_m, on_part_m: near.on_piece_m + normal * radius_m, normal }
    }

    fn of_hull(sized: &Sized<'_>, axis: &Axis, near: Nearest) -> Self {
        if near.away_m > convex::PRECISE_M {
            let normal = (near.on_axis_m - near.on_piece_m) / near.away_m;
            return Self { away_m: near.away_m, on_part_m: near.on_piece_m, normal };
        }
        let (depth_m, normal, on_part_m) = sized.way_out(axis);
        Self { away_m: -depth_m, on_part_m, normal }
    }
}

/// The triangles of each connected part of a mesh, in the order of the mesh. Corners at one place are connected.
fn connected(mesh: &Mesh) -> Vec<Vec<[DVec3; 3]>> {
    let mut places: HashMap<[u32; 3], usize> = HashMap::new();
    let place_of: Vec<usize> = mesh
        .vertices
        .iter()
        .map(|vertex| {
            let next = places.len();
            // Adding 0 makes -0 the same place as 0.
            *places.entry(vertex.position.to_array().map(|part| (part + 0.0).to_bits())).or_insert(next)
        })
        .collect();
    let mut parent: Vec<usize> = (0..places.len()).collect();
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| root(&mut parent, place_of[usize::from(vertex)]));
        let least = a.min(b).min(c);
        [a, b, c].into_iter().for_each(|place| parent[place] = least);
    }
    let mut parts: Vec<Vec<[DVec3; 3]>> = vec![Vec::new(); parent.len()];
    for triangle in &mesh.triangles {
        let part = root(&mut parent, place_of[usize::from(triangle[0])]);
        parts[part].push(triangle.map(|vertex| mesh.vertices[usize::from(vertex)].position.as_dvec3()));
    }
    parts.retain(|part| part.len() >= LEAST_TRIANGLES);
    parts
}

/// The place that stands for all that are connected with one.
fn root(parent: &mut [usize], mut place: usize) -> usize {
    while parent[place] != place {
        parent[place] = parent[parent[place]];
        place = parent[place];
    }
    place
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::life::READY_POPULATIONS;

    #[test]
    fn ready_populations_have_shapes_that_follow_their_mesh() {
        for ready in READY_POPULATIONS {
            let population = ready.population();
            for variant in 0..Form::VARIANTS {
                let shape = Shape::new(&population, variant);
                let name = ready.name;
                assert_eq!(shape.parts.is_empty(), matches!(population.form, Form::Tuft(_)), "{name}");
                // Roots bulge, and hulls close grooves.
                let most = match Counts::of(&population.form) {
                    // The tips of tendrils hang down beside their stems, and are passed through.
                    Counts::Stems if matches!(population.form, Form::Tendrils(_)) => 0.2,
                    Counts::Stems | Counts::Both => 0.03,
                    _ => 0.12 * shape.reach,
                };
                assert!(shape.deviation <= most, "{name} {variant}: {}", shape.deviation);
                // What lies is longer than it is high.
                let most = if matches!(population.form, Form::Wood(_)) { 24.0 } else { 3.0 };
                assert!(shape.parts.len() < 130 && shape.reach < most, "{name}: {}", shape.reach);
            }
        }
    }

    /// A column of eight sides, as a node of a file.
    fn column(radius: f32, [low, high]: [f32; 2], is_leaf: bool) -> crate::planet::mesh::MeshNode {
        use crate::planet::mesh::{MeshCorner, MeshNode};
        use glam::{Vec2, Vec3};
        let corner = |i: u32, z: f32| {
            let (sin, cos) = (i as f32 * std::f32::consts::FRAC_PI_4).sin_cos();
            let normal = Vec3::new(cos, sin, 0.0);
            MeshCorner { position: (normal * radius).with_z(z), normal, color: Vec3::ONE, is_leaf }
        };
        let corners = (0..8).flat_map(|i| [corner(i, low), corner(i, high)]).collect();
        let sides = (0..8).map(|i| (2 * i, 2 * ((i + 1) % 8)));
        let walls = sides.flat_map(|(a, b)| [[a, b, b + 1], [a, b + 1, a + 1]]);
        let ends = (1..7).flat_map(|i| [[0, 2 * i + 2, 2 * i], [1, 2 * i + 1, 2 * i + 3]]);
        MeshNode { name: String::new(), foot: Vec2::ZERO, corners, triangles: walls.chain(ends).collect() }
    }

    #[test]
    fn of_a_tree_of_a_file_the_trunk_is_hit_and_of_a_stone_all() {
        use crate::planet::life::FileMesh;
        use crate::planet::mesh::MeshFile;
        let shape = |nodes| {
            let form = Form::Mesh(FileMesh { file: MeshFile::holding(nodes), ..FileMesh::default() });
            Shape::new(&Population { form, ..Population::default() }, 0)
        };
        // It stands on the ground without roots.
        let tree = shape(vec![column(0.3, [0.0, 5.0], false), column(3.0, [4.0, 10.0], true)]);
        assert!(!tree.parts.is_empty() && tree.reach < 0.6, "{} {}", tree.parts.len(), tree.reach);
        assert!(tree.parts.iter().all(|part| matches!(part.piece, Piece::Rod(_))));
        let stone = shape(vec![column(3.0, [0.0, 4.0], false)]);
        assert!(stone.parts.len() == 1 && stone.reach > 1.0, "{} {}", stone.parts.len(), stone.reach);
        assert!(matches!(stone.parts[0].piece, Piece::Hull(_)));
    }
}
