//! One tile from one node: directions, layer fields, height, climate, mesh. Stages whose inputs did not change are taken
//! from the tile that stood there before.

use crate::lod::select::spacing_rad;
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES, Tile, Vertex};
use crate::planet::param::Stage;
use crate::sphere::NodeId;
use crate::terrain::climate::{ClimateField, PointClimate};
use crate::terrain::coast::Coast;
use crate::terrain::field::Field;
use crate::terrain::height::{self, Heights};
use crate::terrain::landform::Landform;
use crate::terrain::points::Points;
use crate::terrain::{Terrain, tangent_slope};
use glam::DVec3;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What a tile was made from, kept so that an edit re-runs only the stages it makes stale.
#[derive(Debug)]
pub(crate) struct Parts {
    fields: Vec<(Arc<Landform>, Arc<Field>)>,
    heights: Arc<Heights>,
    climate_noises: Option<[Landform; 2]>,
    climate: Arc<ClimateField>,
    coast: Option<Arc<Coast>>,
    /// Distance to the sea at each vertex, as an angle.
    inland_rad: Arc<Vec<f64>>,
}

impl Parts {
    /// Resident size, for the cache's budget.
    pub(crate) fn bytes(&self) -> usize {
        let fields: usize = self.fields.iter().map(|(_, field)| field.bytes()).sum();
        fields + TILE_VERTICES * (8 + 24 + 16 + 8 + size_of::<Vertex>())
    }
}

/// What building one tile took.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Work {
    /// Octaves times points that were evaluated.
    pub(crate) octave_samples: usize,
}

/// Builds the tile of a node. `before` holds the parts of the tile that stood there for an earlier planet, and `stale` the
/// first stage in which that planet differs from this one.
pub(crate) fn make_tile(terrain: &Terrain, id: NodeId, before: Option<(&Parts, Stage)>) -> (Tile, Parts, Work) {
    let points = Points::new(directions(id));
    let mut work = Work::default();
    let simd = terrain.simd();

    let own_spacing_rad = spacing_rad(id.level);
    let spacings_rad = [own_spacing_rad, 2.0 * own_spacing_rad];
    let fields: Vec<Option<Arc<Field>>> = terrain
        .stack
        .layers
        .iter()
        .map(|layer| {
            let spacings_rad = layer.spacings_rad(&spacings_rad);
            let kept = before.and_then(|(parts, _)| {
                parts.fields.iter().find(|(landform, field)| *landform == layer.landform && field.has(&spacings_rad))
            });
            match kept {
                Some((_, field)) => Some(field.clone()),
                None if !layer.needed => None,
                None => {
                    work.octave_samples += layer.landform.octave_count() * TILE_VERTICES;
                    Some(Arc::new(Field::new(&layer.landform, simd, &points, &spacings_rad)))
                }
            }
        })
        .collect();

    let heights = match before {
        Some((parts, stale)) if stale > Stage::Height => parts.heights.clone(),
        _ => Arc::new(height::combine(&terrain.stack, simd, &points, &fields, &spacings_rad, |_, _| {})),
    };

    let climate_noises = terrain.climate.noises().cloned();
    let climate = match before {
        Some((parts, _)) if parts.climate_noises == climate_noises => parts.climate.clone(),
        _ => {
            let octaves: usize = climate_noises.iter().flatten().map(Landform::octave_count).sum();
            work.octave_samples += octaves * TILE_VERTICES;
            Arc::new(terrain.climate.field(simd, &points))
        }
    };

    // The shore is another one whenever heights change anywhere, however far from this tile.
    let coast = terrain.climate.coast.clone();
    let inland_rad = match before {
        Some((parts, _)) if same_coast(parts.coast.as_ref(), coast.as_ref()) => parts.inland_rad.clone(),
        _ => Arc::new(terrain.climate.inland_rad(&points.dirs)),
    };

    let tile = mesh(terrain, id, &points, &heights, &climate, &inland_rad);
    let fields = terrain
        .stack
        .layers
        .iter()
        .zip(fields)
        .filter_map(|(layer, field)| Some((layer.landform.clone(), field?)))
        .collect();
    (tile, Parts { fields, heights, climate_noises, climate, coast, inland_rad }, work)
}

fn same_coast(a: Option<&Arc<Coast>>, b: Option<&Arc<Coast>>) -> bool {
    match (a, b) {
        (Some(a), Some(b)) => Arc::ptr_eq(a, b),
        (None, None) => true,
        _ => false,
    }
}

fn directions(id: NodeId) -> Vec<DVec3> {
    let step = 1.0 / TILE_QUADS as f64;
    (0..TILE_VERTICES).map(|i| id.direction((i % TILE_SIDE) as f64 * step, (i / TILE_SIDE) as f64 * step)).collect()
}

fn mesh(
    terrain: &Terrain,
    id: NodeId,
    points: &Points,
    heights: &Heights,
    climate: &ClimateField,
    inland_rad: &[f64],
) -> Tile {
    static NEXT_SERIAL: AtomicU64 = AtomicU64::new(1);
    let planet = terrain.planet();
    let radius_m = planet.radius_m();
    let gradient = |band: usize, i: usize| {
        let [x, y, z] = &heights.gradients[band];
        DVec3::new(f64::from(x[i]), f64::from(y[i]), f64::from(z[i]))
    };
    let mut positions = Vec::with_capacity(TILE_VERTICES);
    let vertices = points
        .dirs
        .iter()
        .enumerate()
        .map(|(i, &dir)| {
            let height_m = heights.height_m[i];
            let position = dir * (radius_m + height_m);
            positions.push(position);
            let normal = |gradient: DVec3| oct_snorm(dir - tangent_slope(dir, gradient, radius_m + height_m));
            let PointClimate { temperature_c, moisture, row, .. } = climate.at(planet, inland_rad, i, dir, height_m);
            let high = position.as_vec3();
            Vertex {
                position_high_m: high.to_array(),
                height_m: height_m as f32,
                position_low_m: (position - high.as_dvec3()).as_vec3().to_array(),
                temperature_c: temperature_c as f32,
                climate_unorm: [unorm(moisture), unorm(row)],
                normal_oct: normal(gradient(0, i)),
                parent_normal_oct: normal(gradient(1, i)),
            }
        })
        .collect();
    let (min_height_m, max_height_m) =
        heights.height_m.iter().fold((f64::MAX, f64::MIN), |(lo, hi), &h| (lo.min(h), hi.max(h)));
    let center_planet_m = id.direction(0.5, 0.5) * (radius_m + 0.5 * (min_height_m + max_height_m));
    let bounding_radius_m = positions.iter().map(|p| p.distance(center_planet_m)).fold(0.0, f64::max);
    Tile {
        id,
        serial: NEXT_SERIAL.fetch_add(1, Ordering::Relaxed),
        vertices,
        min_height_m,
        max_height_m,
        center_planet_m,
        bounding_radius_m,
    }
}

fn unorm(value: f64) -> u16 {
    (value.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16
}

/// A direction on the octahedron, unfolded (Cigolle et al. 2014), as two snorm numbers.
fn oct_snorm(v: DVec3) -> [i16; 2] {
    let v = v / (v.x.abs() + v.y.abs() + v.z.abs());
    let fold = |a: f64, b: f64| (1.0 - b.abs()) * if a < 0.0 { -1.0 } else { 1.0 };
    let (x, y) = if v.z < 0.0 { (fold(v.x, v.y), fold(v.y, v.x)) } else { (v.x, v.y) };
    let snorm = |w: f64| (w.clamp(-1.0, 1.0) * 32767.0).round() as i16;
    [snorm(x), snorm(y)]
}
