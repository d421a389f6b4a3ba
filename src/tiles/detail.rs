//! The detail texture of one node: slopes and heights finer than its mesh, from the evaluator.

use crate::lod::range::spacing_rad;
use crate::lod::tile::{DETAIL_APRON, DETAIL_IMAGE, DETAIL_SIDE, DetailTile, TILE_QUADS, Tile, slope_basis};
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use crate::terrain::wet::Wet;
use glam::DVec3;
use half::f16;
use std::sync::atomic::{AtomicU64, Ordering};

/// Points evaluated at a time: few enough for the fields of all layers to stay in the second-level cache.
const BATCH: usize = 1024;
/// Greatest slope stored; steeper ground is as good as vertical.
const STEEPEST: f64 = 1000.0;
/// The greatest number of a half float.
const MOST: f64 = 65504.0;

/// One texel.
#[derive(Clone, Copy, Default)]
struct Texel {
    height_m: f64,
    /// Along the two tangents.
    slope: [f64; 2],
    /// Slope of the ground with every octave.
    steepest: f64,
    water: Wet,
}

impl Texel {
    /// The ground with water on it.
    fn under(self, water: Wet) -> Self {
        Self {
            height_m: self.height_m + water.rise_m,
            slope: self.slope.map(|slope| slope * water.slope),
            steepest: self.steepest * water.slope,
            water,
        }
    }
}

/// Computes the detail texture of a tile; None once `wanted`, asked repeatedly, says no.
pub(crate) fn make_detail(terrain: &Terrain, tile: &Tile, wanted: &dyn Fn() -> bool) -> Option<DetailTile> {
    profiling::scope!("detail");
    static NEXT_SERIAL: AtomicU64 = AtomicU64::new(1);
    let own_texels = texels(terrain, tile.id, 1, wanted)?;
    // The parent has every second texel of every second row, with linear interpolation between.
    let parents = texels(terrain, tile.id, 2, wanted)?;
    let base_m = (0.5 * (tile.min_height_m + tile.max_height_m)) as f32;
    let (mut slopes, mut heights) = (Vec::with_capacity(own_texels.len()), Vec::with_capacity(own_texels.len()));
    let half = |value: f64, most: f64| f16::from_f64(value.clamp(-most, most));
    for (i, own) in own_texels.iter().enumerate() {
        let parent = between(&parents, i % DETAIL_IMAGE, i / DETAIL_IMAGE);
        let ([along, across], [parent_along, parent_across]) = (own.slope, parent.slope);
        slopes.push([along, across, parent_along, parent_across].map(|slope| half(slope, STEEPEST)));
        let height_m = own.height_m - f64::from(base_m);
        let greater = half(height_m, MOST);
        let rest = half(height_m - f64::from(greater), MOST);
        heights.push([greater, rest, half(own.slope[0].hypot(own.slope[1]), STEEPEST), half(own.steepest, STEEPEST)]);
    }
    let mut water = Vec::new();
    if terrain.planet().structure.is_some() {
        water.extend(own_texels.iter().enumerate().map(|(i, own)| {
            let parent = between(&parents, i % DETAIL_IMAGE, i / DETAIL_IMAGE).water;
            [own.water.share, own.water.depth_m, parent.share, own.water.wide].map(|value| half(value, MOST))
        }));
    }
    let serial = NEXT_SERIAL.fetch_add(1, Ordering::Relaxed);
    Some(DetailTile { id: tile.id, serial, heights_serial: tile.heights_serial, slopes, base_m, heights, water })
}

/// Every `stride`th texel of a node and its apron, row by row. Slopes omit octaves that this spacing cannot show.
fn texels(terrain: &Terrain, id: NodeId, stride: usize, wanted: &dyn Fn() -> bool) -> Option<Vec<Texel>> {
    let quads = (DETAIL_SIDE - 1) / stride;
    let apron = DETAIL_APRON / stride;
    let side = quads + 1 + 2 * apron;
    let spacing_rad = spacing_rad(id.level) * TILE_QUADS as f64 / quads as f64;
    let (spacing_m, sea_m) = (spacing_rad * terrain.planet().radius_m(), terrain.planet().sea_level_m());
    let mut texels = Vec::with_capacity(side * side);
    for start in (0..side * side).step_by(BATCH) {
        if !wanted() {
            return None;
        }
        let range = start..(start + BATCH).min(side * side);
        let along = |texel: usize| (texel as f64 - apron as f64) / quads as f64;
        let place = |i: usize| id.direction(along(i % side), along(i / side));
        let dirs: Vec<DVec3> = range.map(place).collect();
        let relief = terrain.slopes_at(&dirs, &[spacing_rad, 0.0]);
        texels.extend(dirs.iter().enumerate().map(|(i, dir)| {
            let [seen, all] = [0, 1].map(|band| relief.slopes[band][i]);
            let slope = slope_basis(id.face, *dir).map(|tangent| seen.dot(tangent));
            let ground = Texel { height_m: relief.height_m[i], slope, steepest: all.length(), water: Wet::default() };
            match relief.water.get(i) {
                Some(water) => ground.under(water.over(ground.height_m, seen.length() * spacing_m, sea_m)),
                None => ground,
            }
        }));
    }
    Some(texels)
}

/// The value that texels of twice the spacing interpolate at a texel.
fn between(wide: &[Texel], x: usize, y: usize) -> Texel {
    const WIDE_SIDE: usize = DETAIL_IMAGE.div_ceil(2);
    let mut mean = Texel::default();
    for (x, y) in [(x / 2, y / 2), (x.div_ceil(2), y / 2), (x / 2, y.div_ceil(2)), (x.div_ceil(2), y.div_ceil(2))] {
        let texel = wide[y * WIDE_SIDE + x];
        mean.height_m += 0.25 * texel.height_m;
        mean.slope[0] += 0.25 * texel.slope[0];
        mean.slope[1] += 0.25 * texel.slope[1];
        mean.water.share += 0.25 * texel.water.share;
    }
    mean
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::tile::normal_of_oct;
    use crate::lod::{Quality, opening};
    use crate::planet::{Planet, shipped};
    use crate::tiles::build_now;
    use std::sync::Arc;

    /// Index of a texel of the node itself.
    fn texel(x: usize, y: usize) -> usize {
        (DETAIL_APRON + y) * DETAIL_IMAGE + DETAIL_APRON + x
    }

    /// Neighbours have equal slopes on their common border, on whatever faces they lie.
    #[test]
    fn borders_are_shared_and_the_rise_is_small() {
        let planet = Arc::new(shipped::layered());
        let surface = build_now(&planet, &opening::opening_view(&planet, [320, 200], Quality::Low)).unwrap();
        let tile = &surface.leaves[surface.leaves.len() / 2].tile;
        let detail = make_detail(&surface.terrain, tile, &|| true).unwrap();
        assert_eq!(detail.slopes.len(), DETAIL_IMAGE * DETAIL_IMAGE);
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
                        let [u, v, ..] = detail.slopes[texel(x, y)].map(f64::from);
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
        // At a vertex it equals the mesh, except for octaves that are too fine to be seen.
        let relief_m = tile.max_height_m - tile.min_height_m;
        let [greater, rest, ..] = detail.heights[texel(0, 0)].map(f64::from);
        let rise_m = f64::from(detail.base_m) + greater + rest - f64::from(tile.vertices[0].height_m);
        assert!(rise_m.abs() < 0.2 * relief_m + 50.0, "{rise_m} of {relief_m}");
    }

    /// A child begins with what its parent shows.
    #[test]
    fn a_child_begins_as_its_parents_quarter() {
        let terrain = Terrain::try_new(Arc::new(shipped::layered())).unwrap();
        let planet = Arc::new(shipped::layered());
        let surface = build_now(&planet, &opening::opening_view(&planet, [320, 200], Quality::Low)).unwrap();
        let tile = &surface.leaves[surface.leaves.len() / 2].tile;
        let parent = texels(&terrain, tile.id, 1, &|| true).unwrap();
        let id = tile.id.children()[3];
        let child = texels(&terrain, id, 2, &|| true).unwrap();
        let offset = (DETAIL_SIDE - 1) / 2;
        let (mut worst, mut steepest) = (0.0_f64, 0.0_f64);
        for (x, y) in (0..DETAIL_SIDE).step_by(2).flat_map(|y| (0..DETAIL_SIDE).step_by(2).map(move |x| (x, y))) {
            let theirs = &parent[texel(offset + x / 2, offset + y / 2)];
            let ours = between(&child, DETAIL_APRON + x, DETAIL_APRON + y);
            assert_eq!(ours.height_m, theirs.height_m, "{x} {y}");
            let (theirs, ours) = (theirs.slope, ours.slope);
            worst = worst.max((theirs[0] - ours[0]).abs().max((theirs[1] - ours[1]).abs()));
            steepest = steepest.max(theirs[0].abs().max(theirs[1].abs()));
        }
        assert!(steepest > 0.05 && worst < 1e-6 * steepest, "{worst} of {steepest}");
    }

    /// Water that a texture shows is water that a query finds, at the same height, and the reverse.
    #[test]
    fn drawn_water_is_queried_water() {
        let planet = shipped::default_planet();
        let structure = planet.structure.map(|structure| crate::planet::Structure { grids: 1, ..structure });
        let terrain = Terrain::try_new(Arc::new(Planet { structure, ..planet })).unwrap();
        let (mut wet, mut dry, mut apart) = (0, 0, 0);
        for course in terrain.rivers(2000.0).courses.iter().step_by(11).take(12) {
            let dir = course.points[course.points.len() / 2].place.direction();
            // Texels far narrower than the river.
            let id = NodeId::containing(dir, 11);
            let Some(texels) = texels(&terrain, id, 1, &|| true) else { unreachable!("wanted") };
            let along = |texel: usize| (texel as f64 - DETAIL_APRON as f64) / (DETAIL_SIDE - 1) as f64;
            for (i, texel) in texels.iter().enumerate().step_by(61) {
                let dir = id.direction(along(i % DETAIL_IMAGE), along(i / DETAIL_IMAGE));
                let sample = terrain.sample(dir);
                let is_inland = |level_m: &f64| Some(*level_m) != terrain.planet().sea_level_m();
                match sample.water_level_m.filter(is_inland) {
                    Some(level_m) => {
                        apart += usize::from(texel.water.share < 0.5);
                        assert!((texel.height_m - level_m).abs() < 0.01, "{} {sample:?}", texel.height_m);
                        wet += 1;
                    }
                    None => {
                        apart += usize::from(texel.water.share > 0.5);
                        assert_eq!(texel.height_m, sample.height_m);
                        dry += 1;
                    }
                }
            }
        }
        assert!(wet > 300 && dry > 300 && apart * 50 < wet + dry, "{wet} wet, {dry} dry, {apart} apart");
    }

    #[test]
    fn normals_of_a_tile_are_read_back() {
        // Smooth: nothing of it is finer than the vertices.
        let text = r#"(version: 3, name: "Islet", radius_km: 40.0,
            layers: [(name: "Hills", amplitude_m: 3000.0, shape: Fbm(wavelength_km: 60.0, octaves: 1))])"#;
        let planet: Arc<Planet> = Planet::from_text("islet.ron", text).unwrap().into();
        let terrain = Terrain::try_new(planet.clone()).unwrap();
        let view = opening::opening_view(&planet, [640, 360], Quality::Low);
        let surface = build_now(&planet, &view).unwrap();
        let vertices = surface.leaves.iter().flat_map(|leaf| leaf.tile.vertices.iter().step_by(29));
        let mut below = 0;
        for vertex in vertices {
            let wanted = terrain.sample(vertex.position_planet_m()).normal_planet;
            let found = normal_of_oct(vertex.normal_oct);
            assert!(found.as_dvec3().distance(wanted) < 1e-3, "{found} {wanted}");
            below += usize::from(found.z < 0.0);
        }
        assert!(below > 100, "{below} are of the lower half");
    }
}
