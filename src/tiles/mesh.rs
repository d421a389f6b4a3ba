//! The vertices of a tile from its heights, gradients and climate, in chunks over plain arrays.

use super::deviation::find_deviations;
use crate::lod::tile::{TILE_VERTICES, Tile, Vertex};
use crate::simd::for_each_simd;
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use crate::terrain::climate::{ClimateField, MapClimate, SeaLevelClimate};
use crate::terrain::edits::Painted;
use crate::terrain::height::Heights;
use crate::terrain::lane::{CHUNK, Lane};
use glam::DVec3;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};

/// Adding this to an f32 below 2^22 leaves the nearest integer in the low bits.
const ROUNDER_F32: f32 = 12_582_912.0;

/// A number that no other tile has.
pub(super) fn next_serial() -> u64 {
    static NEXT: AtomicU64 = AtomicU64::new(1);
    NEXT.fetch_add(1, Ordering::Relaxed)
}

/// Makes the tile of a node. `dirs`, `heights` (with the gradients at the tile's own spacing and at its parent's) and
/// `climate` are those of its vertices. The caller sets [`Tile::heights_serial`].
pub(super) fn mesh(
    terrain: &Terrain,
    id: NodeId,
    dirs: &[DVec3],
    heights: &Heights,
    climate: &VertexClimate<'_>,
) -> Tile {
    let (simd, planet) = (terrain.simd(), terrain.planet());
    let (radius_m, rules) = (planet.radius_m(), SeaLevelClimate::new(planet));
    let (min_height_m, max_height_m) = heights.range_m(simd);
    let center_planet_m = id.direction(0.5, 0.5) * (radius_m + 0.5 * (min_height_m + max_height_m));

    let mut lanes = Lanes::default();
    let mut vertices = Vec::with_capacity(TILE_VERTICES);
    for range in chunks(dirs.len()) {
        let (dirs, height_m) = (&dirs[range.clone()], &heights.height_m[range.clone()]);
        place(simd, radius_m, center_planet_m, dirs, height_m, &mut lanes);
        for (band, [x, y, z]) in heights.gradients.iter().enumerate().take(2) {
            let gradient = [&x[range.clone()], &y[range.clone()], &z[range.clone()]];
            face(simd, radius_m, dirs, height_m, gradient, &mut lanes.normal_oct[band]);
        }
        let height_m = lanes.height_m;
        climate.chunk(terrain, &rules, dirs, range, &height_m, &mut lanes);
        vertices.extend((0..dirs.len()).map(|i| lanes.vertex(i)));
    }
    let mut tile = Tile {
        id,
        serial: next_serial(),
        heights_serial: 0,
        vertices,
        min_height_m,
        max_height_m,
        center_planet_m,
        bounding_radius_m: lanes.farthest_square.iter().copied().fold(0.0, f64::max).sqrt(),
        blocks: Default::default(),
    };
    find_deviations(&mut tile, radius_m, dirs, &heights.height_m);
    tile
}

/// The same tile with another climate: its heights, and all that follows from them, stay.
pub(super) fn with_climate(tile: &Tile, terrain: &Terrain, dirs: &[DVec3], climate: &VertexClimate<'_>) -> Tile {
    let mut tile = Tile { serial: next_serial(), ..Tile::clone(tile) };
    let (rules, mut lanes) = (SeaLevelClimate::new(terrain.planet()), Lanes::default());
    for range in chunks(dirs.len().min(tile.vertices.len())) {
        let mut height_m = [0.0; CHUNK];
        for (height_m, vertex) in height_m.iter_mut().zip(&tile.vertices[range.clone()]) {
            *height_m = vertex.height_m;
        }
        climate.chunk(terrain, &rules, &dirs[range.clone()], range.clone(), &height_m, &mut lanes);
        for (i, vertex) in tile.vertices[range].iter_mut().enumerate() {
            (vertex.temperature_c, vertex.moisture) = (lanes.temperature_c[i], lanes.moisture[i]);
        }
    }
    tile
}

fn chunks(points: usize) -> impl Iterator<Item = Range<usize>> {
    (0..points).step_by(CHUNK).map(move |start| start..(start + CHUNK).min(points))
}

/// The inputs of the climate at the vertices of a tile.
pub(super) struct VertexClimate<'a> {
    pub(super) noise: &'a ClimateField,
    /// What world maps say; empty if the climate reads none.
    pub(super) from_maps: &'a [MapClimate],
    /// Paint; empty where there is none.
    pub(super) painted: &'a [Painted],
}

impl VertexClimate<'_> {
    /// `height_m`: the heights of the vertices of the chunk.
    fn chunk(
        &self,
        terrain: &Terrain,
        rules: &SeaLevelClimate,
        dirs: &[DVec3],
        range: Range<usize>,
        height_m: &Lane<f32>,
        lanes: &mut Lanes,
    ) {
        let noise = [&self.noise.temperature[range.clone()], &self.noise.moisture[range.clone()]];
        let from_maps = self.from_maps.get(range.clone()).unwrap_or(&[MapClimate::NONE; CHUNK]);
        weather(terrain.simd(), rules, dirs, noise, from_maps, lanes);
        let painted = self.painted.get(range).unwrap_or_default();
        for (i, paint) in painted.iter().enumerate().filter(|(_, paint)| **paint != Painted::NONE) {
            let at_sea = [lanes.temperature_c[i], lanes.moisture[i]].map(f64::from);
            let rules = terrain.climate_rules();
            let [temperature_c, moisture] = rules.painted_at_sea(at_sea, f64::from(height_m[i]), paint);
            (lanes.temperature_c[i], lanes.moisture[i]) = (temperature_c as f32, moisture as f32);
        }
    }
}

/// The values of a chunk of vertices.
struct Lanes {
    high_m: [Lane<f32>; 3],
    low_m: [Lane<f32>; 3],
    height_m: Lane<f32>,
    temperature_c: Lane<f32>,
    moisture: Lane<f32>,
    /// The tile's own normal and its parent's.
    normal_oct: [[Lane<i16>; 2]; 2],
    /// Square of the greatest distance from the tile's centre, over all chunks so far.
    farthest_square: Lane<f64>,
}

impl Default for Lanes {
    fn default() -> Self {
        Self {
            high_m: [[0.0; CHUNK]; 3],
            low_m: [[0.0; CHUNK]; 3],
            height_m: [0.0; CHUNK],
            temperature_c: [0.0; CHUNK],
            moisture: [0.0; CHUNK],
            normal_oct: [[[0; CHUNK]; 2]; 2],
            farthest_square: [0.0; CHUNK],
        }
    }
}

impl Lanes {
    #[inline(always)]
    fn vertex(&self, i: usize) -> Vertex {
        let three = |[x, y, z]: &[Lane<f32>; 3]| [x[i], y[i], z[i]];
        let normal = |[x, y]: &[Lane<i16>; 2]| [x[i], y[i]];
        Vertex {
            position_high_m: three(&self.high_m),
            height_m: self.height_m[i],
            position_low_m: three(&self.low_m),
            temperature_c: self.temperature_c[i],
            moisture: self.moisture[i],
            normal_oct: normal(&self.normal_oct[0]),
            parent_normal_oct: normal(&self.normal_oct[1]),
            ..Vertex::default()
        }
    }
}

/// Positions, each f64 as the sum of two f32.
#[inline(always)]
fn place_body(radius_m: f64, center_m: DVec3, dirs: &[DVec3], height_m: &[f64], lanes: &mut Lanes) {
    let n = dirs.len().min(height_m.len()).min(CHUNK);
    let [hx, hy, hz] = &mut lanes.high_m;
    let [lx, ly, lz] = &mut lanes.low_m;
    for i in 0..n {
        let p = dirs[i] * (radius_m + height_m[i]);
        (hx[i], hy[i], hz[i]) = (p.x as f32, p.y as f32, p.z as f32);
        (lx[i], ly[i], lz[i]) =
            ((p.x - f64::from(hx[i])) as f32, (p.y - f64::from(hy[i])) as f32, (p.z - f64::from(hz[i])) as f32);
        lanes.height_m[i] = height_m[i] as f32;
        let off = p - center_m;
        let square = off.x * off.x + off.y * off.y + off.z * off.z;
        let farthest = lanes.farthest_square[i];
        lanes.farthest_square[i] = if square > farthest { square } else { farthest };
    }
}
for_each_simd!(fn place(radius_m: f64, center_m: DVec3, dirs: &[DVec3], height_m: &[f64], lanes: &mut Lanes) = place_body);

/// Octahedral normals (Cigolle et al. 2014) as two snorm numbers.
#[inline(always)]
fn face_body(radius_m: f64, dirs: &[DVec3], height_m: &[f64], gradient: [&[f32]; 3], normal_oct: &mut [Lane<i16>; 2]) {
    let [gx, gy, gz] = gradient;
    let n = dirs.len().min(height_m.len()).min(gx.len()).min(gy.len()).min(gz.len()).min(CHUNK);
    let (mut x, mut y, mut z, mut outward_m) = ([0.0_f32; CHUNK], [0.0_f32; CHUNK], [0.0_f32; CHUNK], [0.0_f32; CHUNK]);
    for i in 0..n {
        (x[i], y[i], z[i]) = (dirs[i].x as f32, dirs[i].y as f32, dirs[i].z as f32);
        outward_m[i] = (radius_m + height_m[i]) as f32;
    }
    let [oct_x, oct_y] = normal_oct;
    for i in 0..n {
        let d = [x[i], y[i], z[i]];
        let g = [gx[i], gy[i], gz[i]];
        // The direction less the slope: see `tangent_slope`.
        let up = d[0] * g[0] + d[1] * g[1] + d[2] * g[2];
        let scale = 1.0 / outward_m[i];
        let v =
            [d[0] - (g[0] - d[0] * up) * scale, d[1] - (g[1] - d[1] * up) * scale, d[2] - (g[2] - d[2] * up) * scale];
        let shrink = 1.0 / (v[0].abs() + v[1].abs() + v[2].abs());
        let (a, b) = (v[0] * shrink, v[1] * shrink);
        let fold = |a: f32, b: f32| (1.0 - b.abs()) * if a < 0.0 { -1.0 } else { 1.0 };
        let below = v[2] < 0.0;
        let snorm = |w: f32| (w.clamp(-1.0, 1.0) * 32767.0 + ROUNDER_F32).to_bits() as i16;
        oct_x[i] = snorm(if below { fold(a, b) } else { a });
        oct_y[i] = snorm(if below { fold(b, a) } else { b });
    }
}
for_each_simd!(fn face(radius_m: f64, dirs: &[DVec3], height_m: &[f64], gradient: [&[f32]; 3], normal_oct: &mut [Lane<i16>; 2]) = face_body);

/// Temperature and moisture at sea level.
#[inline(always)]
fn weather_body(rules: &SeaLevelClimate, dirs: &[DVec3], noise: [&[f64]; 2], maps: &[MapClimate], lanes: &mut Lanes) {
    let [temperature, moisture] = noise;
    let n = dirs.len().min(temperature.len()).min(moisture.len()).min(maps.len()).min(CHUNK);
    for i in 0..n {
        let [temperature_c, moisture] = rules.at(dirs[i].z, [temperature[i], moisture[i]], maps[i]);
        lanes.temperature_c[i] = temperature_c as f32;
        lanes.moisture[i] = moisture as f32;
    }
}
for_each_simd!(fn weather(rules: &SeaLevelClimate, dirs: &[DVec3], noise: [&[f64]; 2], maps: &[MapClimate], lanes: &mut Lanes) = weather_body);
