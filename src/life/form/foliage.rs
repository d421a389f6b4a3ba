//! Foliage of trees: twigs with leaves near by, stars of leaves farther away, and dark stars behind both.

use super::build::{Detail, Look, Mesh};
use super::crown::{Canopy, Spot};
use super::leaf::{self, Leaf};
use super::math::{around, mix, smooth};
use super::random::Random;
use crate::planet::life::{Crown, Tree};
use glam::Vec3;

/// Leaves of the nearest level of a tree and of a shrub, at most; each takes two triangles.
const MOST: [usize; 2] = [4700, 1000];

/// Dark stars behind the leaves near by, of a tree and of a shrub; each takes one triangle.
const BACKS: [f32; 2] = [900.0, 460.0];

/// Length of a leaf near by, as a share of a cluster.
const LEAF: f32 = 0.5;

/// What a tree's foliage is made from.
pub(super) struct Foliage<'a> {
    /// Parameters.
    pub form: &'a Tree,
    /// Lobes that the leaves cover.
    pub canopy: &'a Canopy,
    /// Places of clusters.
    pub spots: &'a [Spot],
    /// Seed of the tree.
    pub seed: u32,
}

impl Foliage<'_> {
    /// Drawing of all leaves of a level.
    pub(super) fn draw(&self, mesh: &mut Mesh, detail: &Detail) {
        let leaves = self.form.leaves as f32;
        let before = mesh.triangles.len();
        match detail.level {
            0 => {
                self.backs(mesh, detail, BACKS[self.low()]);
                self.near(mesh);
            }
            1 | 2 => {
                self.backs(mesh, detail, detail.pick([0.0, 130.0, 14.0, 0.0]));
                let spent = mesh.triangles.len() - before;
                let room = leaves.max(0.15) * detail.pick([0.0, 550.0, 105.0, 0.0]);
                self.far(mesh, detail, (room as usize).saturating_sub(spent).max(12));
            }
            _ => self.far(mesh, detail, ((leaves * 56.0) as usize).clamp(12, 22)),
        }
    }

    /// Entry of a table for a tree (0) or a shrub (1).
    fn low(&self) -> usize {
        usize::from(self.canopy.outline.low())
    }

    /// Number of leaves near by that cover the crown once and a bit, and their length.
    fn leaves(&self) -> (usize, f32) {
        let outline = &self.canopy.outline;
        let length = self.form.leaf_size as f32 * LEAF;
        let side = 1.57 * outline.radius * outline.height;
        let area = 0.65 * side + 1.1 * outline.radius * outline.radius;
        let wanted = 7.6 * self.form.leaves as f32 * area / (length * length);
        let most = MOST[self.low()] as f32 * mix(0.85, 1.0, smooth(0.25, 0.7, self.form.leaves as f32));
        (wanted.clamp(40.0, most) as usize, length * (wanted / most).clamp(1.0, 1.7).sqrt())
    }

    /// Dark stars behind the twigs, which stand for the leaves in the shade.
    fn backs(&self, mesh: &mut Mesh, detail: &Detail, most: f32) {
        let outline = &self.canopy.outline;
        let count = most * smooth(0.3, 0.75, self.form.leaves as f32);
        // All stars together cover the shell of the crown about once.
        let shell = 3.2 * outline.radius * (outline.height + 0.6 * outline.radius);
        let size = (shell / count.max(1.0)).sqrt() * detail.pick([0.63, 0.58, 0.42, 0.0]) * detail.swell();
        let deepest = 0.3 * outline.radius.min(0.5 * outline.height);
        for (i, spot) in self.spots.iter().cycle().take(count as usize).enumerate() {
            let mut random = Random::new(self.seed, 9000 + i as u32);
            let face = (spot.normal + random.ball() * 1.1).normalize_or(Vec3::Z);
            let along = face.cross(random.direction()).normalize_or(Vec3::X);
            let across = along.cross(face).normalize_or(around(1.0));
            let size = size * random.range(0.8, 1.25) * mix(1.0, 0.5, spot.hang);
            let at = spot.at - spot.normal * (size * random.range(0.7, 1.8)).min(deepest);
            let light = spot.light * random.range(0.38, 0.62);
            let look = Look { part: random.range(0.9, 1.0), light, sway: sway(at) };
            let one = Leaf { at, along, across, length: size, width: size, normal: spot.normal, look, tip: look };
            let start = mesh.vertices.len();
            leaf::star(mesh, &one, 1, &mut random);
            detail.flatten_part(mesh, start, at);
        }
    }

    /// Twigs with leaves of the nearest level.
    fn near(&self, mesh: &mut Mesh) {
        let (count, length) = self.leaves();
        // Leaves of a sparse crown sit on its branches.
        let cluster = self.form.leaf_size as f32 * mix(0.3, 0.62, smooth(0.3, 0.5, self.form.leaves as f32));
        let (mut left, mut i) = (count, 0);
        while left > 0 {
            let spot = &self.spots[i % self.spots.len()];
            let mut random = Random::new(self.seed, 1000 + i as u32);
            i += 1;
            let blades = (4 + random.whole() as usize % 4).min(left);
            left -= blades;
            // A cluster is a small dome whose leaves hang outward.
            let ball = (random.direction() + spot.normal * 0.55).normalize_or(spot.normal);
            let at = spot.at + ball * (cluster * random.range(0.25, 1.0)) - spot.normal * (cluster * 0.2);
            let outer = ball.dot(spot.normal);
            let free = random.direction();
            let along = ball * 0.75 + free * 0.65 - Vec3::Z * 0.25;
            let along = mix3(along, -Vec3::Z + free * 0.3, spot.hang * 0.85).normalize_or(Vec3::X);
            let face = spot.normal * 0.8 + ball * 0.5 + random.ball() * 0.7 + Vec3::Z * 0.35;
            let across = along.cross(face).normalize_or(around(1.0));
            let light = spot.light * mix(0.55, 1.05, smooth(-0.6, 0.9, outer)) * random.range(0.85, 1.12);
            let sway = sway(at);
            let look = Look { part: random.range(0.84, 0.96), light: light * 0.8, sway };
            let tip = Look { part: random.range(0.92, 1.0), light: light * 1.08, sway: sway + 0.2 };
            let size = length * random.range(0.8, 1.2);
            let normal = spot.normal + ball * 0.45 + random.ball() * 0.3;
            let one = Leaf { at, along, across, length: size, width: size * 0.52, normal, look, tip };
            leaf::twig(mesh, &one, blades, mix(0.95, 0.5, spot.hang), &mut random);
        }
    }

    /// Stars of leaves of the far levels.
    fn far(&self, mesh: &mut Mesh, detail: &Detail, count: usize) {
        let (near, length) = self.leaves();
        // The stars together cover a little less than the leaves that they stand for.
        let area = 0.26 * near as f32 * length * length;
        let each = detail.pick([3, 2, 1, 1]);
        let size = (area * detail.pick([1.0, 0.85, 0.8, 1.0]) / (1.1 * count as f32)).sqrt() * detail.swell();
        // A flat crown is seen from the side as well.
        let tilt = if self.form.crown == Crown::Umbrella { 1.2 } else { 0.6 };
        let (mut left, mut i) = (count, 0);
        while left > 0 {
            let spot = &self.spots[i % self.spots.len()];
            let mut random = Random::new(self.seed, 5000 + i as u32);
            i += 1;
            let triangles = each.min(left);
            left -= triangles;
            let free = random.direction();
            let face = (spot.normal + free * tilt + Vec3::Z * 0.25).normalize_or(Vec3::Z);
            let along = mix3(free.cross(face) - Vec3::Z * 0.4, -Vec3::Z, spot.hang).normalize_or(Vec3::X);
            let across = along.cross(face).normalize_or(around(1.0));
            let size = size * random.range(0.85, 1.2);
            let at = spot.at - spot.normal * (size * 0.3);
            let light = spot.light * random.range(0.85, 1.1);
            let sway = sway(at);
            // The lower side of a cluster is darker.
            let look = Look { part: random.range(0.9, 1.0), light: light * 1.1, sway };
            let tip = Look { part: 0.97, light: light * mix(0.9, 0.7, face.z.abs()), sway: sway + 0.15 };
            let (length, width) = (size * mix(1.0, 1.5, spot.hang), size * mix(1.0, 0.6, spot.hang));
            let normal = spot.normal + random.ball() * 0.2;
            let one = Leaf { at, along, across, length, width, normal, look, tip };
            let start = mesh.vertices.len();
            leaf::star(mesh, &one, triangles, &mut random);
            detail.flatten_part(mesh, start, at);
        }
    }
}

/// Share of the wind's push at a place.
fn sway(at: Vec3) -> f32 {
    let z = at.z.max(0.0);
    0.65 * z * z.sqrt() + 0.1
}

/// Blend of two vectors.
fn mix3(a: Vec3, b: Vec3, t: f32) -> Vec3 {
    a + (b - a) * t
}
