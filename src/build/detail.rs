//! The detail tile of one node: slopes and heights finer than its mesh, from the evaluator.

use crate::lod::select::spacing_rad;
use crate::lod::tile::{DETAIL_SIDE, DetailTile, TILE_QUADS, Tile, slope_basis};
use crate::terrain::Terrain;
use glam::DVec3;
use half::f16;
use std::sync::atomic::{AtomicU64, Ordering};

/// Points evaluated at a time: few enough for the fields of all layers to stay in the second-level cache.
const BATCH: usize = 1024;
/// Slopes beyond this are as good as vertical.
const STEEPEST: f64 = 1000.0;
/// The greatest number a half float holds.
const MOST: f64 = 65504.0;

/// Finds what a tile's mesh is too coarse to show; nothing if `wanted`, asked again and again, says no.
pub(crate) fn make_detail(terrain: &Terrain, tile: &Tile, wanted: &dyn Fn() -> bool) -> Option<DetailTile> {
    profiling::scope!("detail");
    static NEXT_SERIAL: AtomicU64 = AtomicU64::new(1);
    let id = tile.id;
    let quads = DETAIL_SIDE - 1;
    let own_rad = spacing_rad(id.level) * TILE_QUADS as f64 / quads as f64;
    let place = |i: usize| ((i % DETAIL_SIDE) as f64 / quads as f64, (i / DETAIL_SIDE) as f64 / quads as f64);
    let count = DETAIL_SIDE * DETAIL_SIDE;
    let (mut slopes, mut rise_m) = (Vec::with_capacity(count), Vec::with_capacity(count));
    for start in (0..count).step_by(BATCH) {
        if !wanted() {
            return None;
        }
        let places: Vec<(f64, f64)> = (start..(start + BATCH).min(count)).map(place).collect();
        let dirs: Vec<DVec3> = places.iter().map(|&(u, v)| id.direction(u, v)).collect();
        let seen = terrain.seen_relief(dirs.clone(), [own_rad, 2.0 * own_rad]);
        for (i, dir) in dirs.iter().enumerate() {
            let [east, north] = slope_basis(id.face, *dir);
            let [own, parent] = [seen.slopes[0][i], seen.slopes[1][i]];
            let along = [own.dot(east), own.dot(north), parent.dot(east), parent.dot(north)];
            slopes.push(along.map(|slope| f16::from_f64(slope.clamp(-STEEPEST, STEEPEST))));
            let (u, v) = places[i];
            rise_m.push(f16::from_f64((seen.height_m[i] - tile.mesh_height_m(u, v)).clamp(-MOST, MOST)));
        }
    }
    let serial = NEXT_SERIAL.fetch_add(1, Ordering::Relaxed);
    Some(DetailTile { serial, heights_serial: tile.heights_serial, slopes, rise_m })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::build::build_now;
    use crate::lod::{Quality, opening};
    use crate::planet::shipped;
    use std::sync::Arc;

    /// Neighbours share their borders: the same slopes from either side, whatever face they lie on.
    #[test]
    fn borders_are_shared_and_the_rise_is_small() {
        let planet = Arc::new(shipped::default_planet());
        let surface = build_now(&planet, &opening::opening_view(&planet, [320, 200], Quality::Low));
        let tile = &surface.leaves[surface.leaves.len() / 2].tile;
        let detail = make_detail(&surface.terrain, tile, &|| true).unwrap();
        assert_eq!(detail.slopes.len(), DETAIL_SIDE * DETAIL_SIDE);
        let mut neighbours = 0;
        for edge in crate::sphere::Edge::ALL {
            let id = tile.id.neighbour(edge);
            let Some(other) = surface.leaves.iter().find(|leaf| leaf.tile.id == id) else { continue };
            let other_detail = make_detail(&surface.terrain, &other.tile, &|| true).unwrap();
            let border = |detail: &DetailTile, id: crate::sphere::NodeId| -> Vec<(DVec3, DVec3)> {
                let last = DETAIL_SIDE - 1;
                let texels = (0..DETAIL_SIDE).flat_map(|i| [(i, 0), (i, last), (0, i), (last, i)]);
                texels
                    .map(|(x, y)| {
                        let dir = id.direction(x as f64 / last as f64, y as f64 / last as f64);
                        let [east, north] = slope_basis(id.face, dir);
                        let [u, v, ..] = detail.slopes[y * DETAIL_SIDE + x].map(f64::from);
                        (dir, east * u + north * v)
                    })
                    .collect()
            };
            let theirs = border(&other_detail, other.tile.id);
            let mut shared = 0;
            for (dir, slope) in border(&detail, tile.id) {
                for (_, other) in theirs.iter().filter(|(other, _)| other.distance(dir) < 1e-9) {
                    assert!(slope.distance(*other) < 1e-3 * slope.length().max(0.01), "{slope} {other}");
                    shared += 1;
                }
            }
            assert!(shared >= DETAIL_SIDE, "{shared}");
            neighbours += 1;
        }
        assert!(neighbours > 0, "no neighbour of the same level was compared");
        // On a vertex the mesh is the ground, but for what is too fine to be seen.
        let relief_m = tile.max_height_m - tile.min_height_m;
        let vertex_rise_m = f64::from(detail.rise_m[0].to_f32());
        assert!(vertex_rise_m.abs() < 0.2 * relief_m + 50.0, "{vertex_rise_m} of {relief_m}");
    }
}
