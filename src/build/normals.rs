//! The normal tile of one node: slopes finer than its mesh, from the evaluator's gradients.

use crate::lod::select::spacing_rad;
use crate::lod::tile::{NORMAL_SIDE, NormalTile, TILE_QUADS, slope_basis};
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use glam::DVec3;
use half::f16;
use std::sync::atomic::{AtomicU64, Ordering};

/// Points evaluated at a time: few enough for the fields of all layers to stay in the second-level cache.
const BATCH: usize = 1024;

/// Finds the slopes over a node.
pub(crate) fn make_normal_tile(terrain: &Terrain, id: NodeId) -> NormalTile {
    static NEXT_SERIAL: AtomicU64 = AtomicU64::new(1);
    let quads = NORMAL_SIDE - 1;
    let own_rad = spacing_rad(id.level) * TILE_QUADS as f64 / quads as f64;
    let step = 1.0 / quads as f64;
    let count = NORMAL_SIDE * NORMAL_SIDE;
    let mut texels = Vec::with_capacity(count);
    for start in (0..count).step_by(BATCH) {
        let texel = |i: usize| id.direction((i % NORMAL_SIDE) as f64 * step, (i / NORMAL_SIDE) as f64 * step);
        let dirs: Vec<DVec3> = (start..(start + BATCH).min(count)).map(texel).collect();
        let slopes = terrain.slopes(dirs.clone(), [own_rad, 2.0 * own_rad]);
        texels.extend(dirs.iter().enumerate().map(|(i, dir)| {
            let [east, north] = slope_basis(id.face, *dir);
            let [own, parent] = [slopes[0][i], slopes[1][i]];
            [own.dot(east), own.dot(north), parent.dot(east), parent.dot(north)]
                .map(|slope| f16::from_f64(slope.clamp(-1000.0, 1000.0)))
        }));
    }
    NormalTile { serial: NEXT_SERIAL.fetch_add(1, Ordering::Relaxed), texels }
}
