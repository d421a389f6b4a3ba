//! The march outward over a patch: for each vertex of a node, the tangent of the highest elevation of ground in one
//! azimuth. All vertices step together, so that a step is a shift of the grid and the loops run over plain arrays.

use super::patch::Patch;
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES};
use crate::simd::{Simd, for_each_simd};
use crate::sphere::NodeId;

/// One value for each vertex of a node.
pub(super) type PerVertex = Vec<f32>;

/// The metric tensor of the face coordinates at each vertex: squared length of a step, per vertex spacing squared.
pub(super) struct Metric {
    ss: PerVertex,
    st: PerVertex,
    tt: PerVertex,
    radius_m: f32,
}

impl Metric {
    pub(super) fn new(id: NodeId, radius_m: f64) -> Self {
        let step = 1.0 / TILE_QUADS as f64;
        let each = |i: usize| {
            let (u, v) = ((i % TILE_SIDE) as f64 * step, (i / TILE_SIDE) as f64 * step);
            let along = |du: f64, dv: f64| {
                let [a, b] = [-0.5, 0.5].map(|w| id.direction(u + du * w, v + dv * w));
                (b - a) * radius_m
            };
            let (s, t) = (along(step, 0.0), along(0.0, step));
            [s.dot(s), s.dot(t), t.dot(t)].map(|x| x as f32)
        };
        let all: Vec<[f32; 3]> = (0..TILE_VERTICES).map(each).collect();
        let part = |k: usize| all.iter().map(|tensor| tensor[k]).collect();
        Self { ss: part(0), st: part(1), tt: part(2), radius_m: radius_m as f32 }
    }

    /// Metres of a step of one vertex spacing in a direction, and its inverse.
    pub(super) fn along(&self, [s, t]: [f32; 2]) -> Along {
        let square = |i: usize| self.ss[i] * s * s + 2.0 * self.st[i] * s * t + self.tt[i] * t * t;
        let step_m: PerVertex = (0..TILE_VERTICES).map(|i| square(i).max(1e-12).sqrt()).collect();
        let per_m = step_m.iter().map(|m| 1.0 / m).collect();
        Along { step_m, per_m, half_curve: 0.5 / self.radius_m }
    }
}

/// See [`Metric::along`].
pub(super) struct Along {
    pub(super) step_m: PerVertex,
    pub(super) per_m: PerVertex,
    /// Half the curvature of the planet, 1/m.
    half_curve: f32,
}

/// One step of a march.
#[derive(Clone, Copy, Debug)]
pub(super) struct Step {
    /// Distance in vertex spacings.
    pub(super) spacings: f32,
    /// Factor on the elevation above the level; below 1 where the mesh is too coarse to tell ground from its own slope.
    pub(super) weight: f32,
}

/// Raises `tangents` to the elevations over these steps. Where it does, `nearness` becomes the inverse of the distance
/// in vertex spacings.
#[inline(always)]
fn march_body(patch: &Patch, dir: [f32; 2], along: &Along, steps: &[Step], tangents: &mut [f32], nearness: &mut [f32]) {
    let at = |x: i64, y: i64| {
        let (x, y) = (x + patch.margin as i64, y + patch.margin as i64);
        (y * patch.side as i64 + x) as usize
    };
    for step in steps {
        let off = dir.map(|d| d * step.spacings);
        // The last cell stays within the patch.
        let cell = off.map(|o| (o.floor() as i64).min(patch.margin as i64 - 1));
        let [u, v] = [off[0] - cell[0] as f32, off[1] - cell[1] as f32];
        let (inverse, half_curve) = (1.0 / step.spacings, along.half_curve * step.spacings);
        for y in 0..TILE_SIDE {
            let start = at(cell[0], cell[1] + y as i64);
            let lower = &patch.height_m[start..start + TILE_SIDE + 1];
            let upper = &patch.height_m[start + patch.side..start + patch.side + TILE_SIDE + 1];
            let own = &patch.height_m[at(0, y as i64)..at(0, y as i64) + TILE_SIDE];
            let row = y * TILE_SIDE..(y + 1) * TILE_SIDE;
            let (step_m, per_m) = (&along.step_m[row.clone()], &along.per_m[row.clone()]);
            let (tangents, nearness) = (&mut tangents[row.clone()], &mut nearness[row]);
            for x in 0..TILE_SIDE {
                let below = lower[x] + (lower[x + 1] - lower[x]) * u;
                let above = upper[x] + (upper[x + 1] - upper[x]) * u;
                let height_m = below + (above - below) * v;
                let raw = (height_m - own[x]) * per_m[x] * inverse - step_m[x] * half_curve;
                let faded = raw * step.weight;
                let tangent = if raw < faded { raw } else { faded };
                let higher = tangent > tangents[x];
                tangents[x] = if higher { tangent } else { tangents[x] };
                nearness[x] = if higher { inverse } else { nearness[x] };
            }
        }
    }
}
for_each_simd!(pub(super) fn march_with(patch: &Patch, dir: [f32; 2], along: &Along, steps: &[Step], tangents: &mut [f32], nearness: &mut [f32]) = march_body);

/// [`march_with`] the best instruction set of this machine.
pub(super) fn march(
    patch: &Patch,
    dir: [f32; 2],
    along: &Along,
    steps: &[Step],
    tangents: &mut [f32],
    nearness: &mut [f32],
) {
    march_with(Simd::detect(), patch, dir, along, steps, tangents, nearness);
}
