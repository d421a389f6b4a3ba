//! Cover of a form: how much of the ground and of a view it hides, and the mean light of what is seen of it.

use super::build::Mesh;
use super::math::{TURN, around, smooth};
use super::{LEVELS, sight};
use crate::planet::Form;
use glam::{Vec2, Vec3};
use rayon::prelude::*;

/// Angles of the eye from the zenith, degrees.
pub(crate) const EYES_DEG: [f32; 2] = [0.0, 60.0];
/// Angles of the sun from the zenith, degrees.
pub(crate) const SUNS_DEG: [f32; 2] = [25.0, 70.0];
/// Turns of the form that the means are of.
const TURNS: u8 = 2;
/// Pixels along a side of the pictures.
const SIDE: usize = 56;
/// Softness of the edge between light and shade on leaves, at the nearest level and at the farthest: coarse levels have
/// one surface where fine ones have leaves of all directions.
pub(crate) const LEAF_SOFT: [f32; 2] = [0.35, 0.8];
/// Share of sunlight that leaves let through to their other side.
pub(crate) const TRANSLUCENT: f32 = 0.25;
/// Way towards the sun, in heights, within the leaves of a crown: `light` already darkens them.
pub(crate) const OWN_LEAVES: f32 = 0.1;
/// Distance from a surface at which it does not shade itself, in heights.
const BIAS: f32 = 0.03;

/// How much a form covers, in squares of its height, and how it looks from afar.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Cover {
    /// Covered area as seen from above.
    pub top: f64,
    /// Covered area as seen from the side.
    pub side: f64,
    /// Mean share of the second colour, as seen from above and from the side.
    pub part: [f64; 2],
    /// Mean share of the sky's light that what is seen has, for both angles of the eye.
    pub sky: [f64; 2],
    /// Mean share of the sun's light, for both angles of the sun: seen from above, aslant from the side of the sun, and
    /// aslant against it.
    pub sun: [[f64; 2]; 3],
}

impl Cover {
    /// The cover of a form's nearest level, and the light of the farthest, which the canopy takes over from; `seed`
    /// already mixes the variant.
    pub(crate) fn new(form: &Form, seed: u32) -> Self {
        let [near, mesh] = super::extremes(form, seed);
        let (top, side) = (sight::look_down(&near, 64), sight::look(&near).side);
        let part = [top.part.into(), side.part.into()];
        let mut out = Self { top: top.cover.into(), side: side.cover.into(), part, ..Self::default() };
        for turn in 0..TURNS {
            let azimuth = TURN * (f32::from(turn) + 0.35) / f32::from(TURNS);
            let eyes = EYES_DEG.map(|from_zenith_deg| View::new(&mesh, direction(from_zenith_deg, azimuth)));
            for (sky, eye) in out.sky.iter_mut().zip(&eyes) {
                *sky += eye.mean(|hit| hit.light * (0.5 + 0.5 * hit.normal.z));
            }
            let opposite = azimuth + 0.5 * TURN;
            let sides = [(&eyes[0], azimuth), (&eyes[1], azimuth), (&eyes[1], opposite)];
            for (k, from_zenith_deg) in SUNS_DEG.into_iter().enumerate() {
                let suns = [azimuth, opposite].map(|azimuth| View::new(&mesh, direction(from_zenith_deg, azimuth)));
                for (sum, (eye, azimuth)) in out.sun.iter_mut().zip(sides) {
                    let sun = &suns[usize::from(azimuth == opposite)];
                    sum[k] += eye.mean(|hit| hit.sunlight(sun, LEAF_SOFT[1]));
                }
            }
        }
        let share = 1.0 / f64::from(TURNS);
        let far = sunlight(&mesh, LEVELS - 1);
        let even = share * evened(sunlight(&near, 0), far, far);
        // From above all levels show the same tops.
        let from = |view: usize| if view == 0 { share } else { even };
        out.sky = std::array::from_fn(|view| out.sky[view] * from(view));
        out.sun = std::array::from_fn(|view| out.sun[view].map(|sum| sum * from(view)));
        out
    }
}

/// Least and greatest factor on the light of a level of detail.
const EVENED: [f64; 2] = [0.6, 1.6];

/// Factors on the light of each level of detail that make all of them equally bright: single leaves shade one another
/// more than the smooth crowns of coarse levels do.
pub(crate) fn level_light(meshes: &[Mesh; LEVELS]) -> [f64; LEVELS] {
    let mut seen = [0.0; LEVELS];
    seen.par_iter_mut().zip(meshes).enumerate().for_each(|(level, (seen, mesh))| *seen = sunlight(mesh, level));
    seen.map(|own| evened(seen[0], own, seen[LEVELS - 1]))
}

/// Factor that leads the mean light of a level to the middle of the nearest and the farthest one.
fn evened(near: f64, own: f64, far: f64) -> f64 {
    if own > 0.0 { ((near * far).sqrt() / own).clamp(EVENED[0], EVENED[1]) } else { 1.0 }
}

/// Mean share of the sun's light on what is seen of a level of detail from aslant, the sun high and low, behind the eye
/// and before it.
fn sunlight(mesh: &Mesh, level: usize) -> f64 {
    let azimuth = 0.35 * TURN;
    let eye = View::new(mesh, direction(EYES_DEG[1], azimuth));
    let of_sun = |from_zenith_deg, azimuth| {
        let sun = View::new(mesh, direction(from_zenith_deg, azimuth));
        eye.mean(|hit| hit.sunlight(&sun, leaf_soft(level)))
    };
    let both = |from_zenith_deg| of_sun(from_zenith_deg, azimuth) + of_sun(from_zenith_deg, azimuth + 0.5 * TURN);
    0.25 * SUNS_DEG.map(both).iter().sum::<f64>()
}

/// Softness of the edge between light and shade on the leaves of a level of detail.
fn leaf_soft(level: usize) -> f32 {
    LEAF_SOFT[0] + (LEAF_SOFT[1] - LEAF_SOFT[0]) * level as f32 / (LEVELS - 1) as f32
}

/// Unit vector at an angle from the zenith and an azimuth.
fn direction(from_zenith_deg: f32, azimuth: f32) -> Vec3 {
    let tilt = around(from_zenith_deg.to_radians());
    around(azimuth) * tilt.y + Vec3::Z * tilt.x
}

/// What a pixel shows of a mesh.
struct Hit {
    position: Vec3,
    normal: Vec3,
    part: f32,
    light: f32,
}

impl Hit {
    /// Share of the sunlight that is reflected to all sides, as in `life.wgsl`. `sun`: the mesh from the sun.
    /// `leaf_soft`: softness of the edge between light and shade on leaves.
    fn sunlight(&self, sun: &View<'_>, leaf_soft: f32) -> f32 {
        if sun.hides(self.position + sun.to_eye * (OWN_LEAVES * self.part + BIAS)) {
            return 0.0;
        }
        let (facing, soft) = (self.normal.dot(sun.to_eye), leaf_soft * self.part);
        let front = ((facing + soft) / (1.0 + soft)).max(0.0) / (1.0 + 0.5 * soft);
        let behind = TRANSLUCENT * self.part * (-facing).max(0.0);
        (front + behind) * smooth(0.0, 0.75, self.light)
    }
}

/// A mesh as it is seen from far away.
struct View<'a> {
    mesh: &'a Mesh,
    to_eye: Vec3,
    right: Vec3,
    /// Pixels for a height.
    scale: f32,
    /// For each pixel, its depth, the triangle and the weights of its corners.
    pixels: Vec<(f32, usize, [f32; 3])>,
}

impl<'a> View<'a> {
    fn new(mesh: &'a Mesh, to_eye: Vec3) -> Self {
        let reach = mesh.vertices.iter().fold(0.1_f32, |r, v| r.max((v.position - MIDDLE).length()));
        let right = to_eye.any_orthonormal_vector();
        let pixels = vec![(f32::MAX, 0, [0.0; 3]); SIDE * SIDE];
        let mut view = Self { mesh, to_eye, right, scale: SIDE as f32 / (2.0 * reach), pixels };
        for (number, triangle) in mesh.triangles.iter().enumerate() {
            let corners = triangle.map(|i| view.place(mesh.vertices[i as usize].position));
            sight::each_pixel(corners, [SIDE; 2], |at, depth, weights| {
                if depth < view.pixels[at].0 {
                    view.pixels[at] = (depth, number, weights);
                }
            });
        }
        view
    }

    /// Position in the picture: x and y in pixels, depth in heights.
    fn place(&self, p: Vec3) -> Vec3 {
        let rel = p - MIDDLE;
        let flat = Vec2::new(rel.dot(self.right), rel.dot(self.to_eye.cross(self.right)));
        (flat * self.scale + 0.5 * SIDE as f32).extend(-rel.dot(self.to_eye))
    }

    /// Whether something is in front of a point.
    fn hides(&self, point: Vec3) -> bool {
        let at = self.place(point);
        let inside = |x: f32| (0.0..SIDE as f32).contains(&x);
        inside(at.x) && inside(at.y) && self.pixels[at.y as usize * SIDE + at.x as usize].0 < at.z - BIAS
    }

    /// Mean over all that is seen above the ground.
    fn mean(&self, value: impl Fn(&Hit) -> f32) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0_f64);
        for &(_, triangle, weights) in self.pixels.iter().filter(|pixel| pixel.0 < f32::MAX) {
            let corners = self.mesh.triangles[triangle].map(|i| &self.mesh.vertices[i as usize]);
            let mut hit = Hit { position: Vec3::ZERO, normal: Vec3::ZERO, part: 0.0, light: 0.0 };
            for (corner, weight) in corners.iter().zip(weights) {
                hit.position += corner.position * weight;
                hit.normal += corner.normal * weight;
                hit.part += corner.part * weight;
                hit.light += corner.light * weight;
            }
            if hit.position.z >= 0.0 {
                hit.normal = hit.normal.normalize_or(Vec3::Z);
                sum += f64::from(value(&hit));
                count += 1.0;
            }
        }
        sum / count.max(1.0)
    }
}

/// Middle of the pictures.
const MIDDLE: Vec3 = Vec3::new(0.0, 0.0, 0.5);
