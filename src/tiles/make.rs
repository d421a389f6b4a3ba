//! One tile from one node: directions, layer fields, climate noise, heights, climate, mesh (see `mesh`). The result of
//! a stage is taken from the node's tile of an earlier revision if its content key is the same. The climate noise of
//! points that the parent has is taken from the parent.

use super::mesh::{VertexClimate, mesh, with_climate};
use super::stats::Work;
use crate::lod::range::spacing_rad;
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES, Tile};
use crate::planet::param::Stage;
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use crate::terrain::climate::{ClimateField, ClimateInputs, MapClimate, MapKeys};
use crate::terrain::evaluate::Kept;
use crate::terrain::field::Field;
use crate::terrain::height::Heights;
use crate::terrain::kept::KeptFields;
use crate::terrain::landform::Landform;
use crate::terrain::points::Points;
use crate::terrain::relief::{Relief, ReliefFields};
use crate::terrain::revision::TileKeys;
use glam::DVec3;
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// What a tile was made from, the fields of its layers apart; kept so that an edit runs only the stages it makes
/// stale.
#[derive(Clone, Debug)]
pub(crate) struct Parts {
    points: Arc<Points>,
    /// Of the ground and of the water on it.
    heights: Arc<Heights>,
    /// See [`Tile::heights_serial`].
    heights_serial: u64,
    relief_fields: ReliefFields,
    climate_noises: Option<[Landform; 2]>,
    climate: Arc<ClimateField>,
    /// Keys of the maps behind `from_maps`.
    map_keys: MapKeys,
    /// What world maps say about the climate of each vertex.
    from_maps: Arc<Vec<MapClimate>>,
}

impl Parts {
    /// Resident size.
    pub(crate) fn bytes(&self) -> usize {
        let point = size_of::<DVec3>() + 3 * size_of::<f64>();
        let height = size_of::<f64>() + self.heights.gradients.len() * size_of::<[f32; 3]>();
        let climate = 2 * size_of::<f64>() + size_of::<MapClimate>();
        let relief: usize = self.relief_fields.iter().map(|(_, field)| field.bytes()).sum();
        TILE_VERTICES * (point + height + climate) + relief
    }
}

/// What the cache has of a node before its tile is built.
pub(crate) struct Before<'a> {
    /// What the parent's tile was made from, perhaps for an earlier revision.
    pub(crate) parent: Option<&'a Parts>,
    /// What the node's tile was made from.
    pub(crate) parts: Option<&'a Parts>,
    /// The node's tile.
    pub(crate) tile: Option<&'a Tile>,
    /// The content keys of `parts` and `tile`.
    pub(crate) keys: TileKeys,
    /// Fields of this revision's layers and of others.
    pub(crate) fields: &'a KeptFields,
}

/// The fields of a planet's layers; None for those that are not known.
pub(crate) type Fields = Vec<Option<Arc<Field>>>;

/// Builds the tile of a node and adds what that took to `work`. Returns the fields of the layers. `keep_going` is
/// asked before each layer; if it says no, there is no tile and only some of the fields. A tile whose heights stay
/// gets only a new climate; it has parts only if it had them before.
pub(crate) fn make_tile(
    terrain: &Terrain,
    id: NodeId,
    before: &Before<'_>,
    work: &mut Work,
    keep_going: &dyn Fn() -> bool,
) -> (Fields, Option<(Tile, Option<Parts>)>) {
    profiling::scope!("tile");
    let own_spacing_rad = spacing_rad(id.level);
    let new_points = || Arc::new(Points::spaced(directions(id), own_spacing_rad));
    let points = before.parts.map_or_else(new_points, |parts| parts.points.clone());
    let simd = terrain.simd();

    let spacings_rad = [own_spacing_rad, 2.0 * own_spacing_rad];
    let layers = &terrain.stack.layers;
    let mut fields: Fields =
        layers.iter().map(|layer| before.fields.find(&layer.landform, &layer.spacings_rad(&spacings_rad))).collect();
    let climate_noises = terrain.climate.noises().cloned();
    let has_same_noises = |parts: &&Parts| parts.climate_noises == climate_noises;
    let climate = match before.parts.filter(has_same_noises) {
        Some(parts) => parts.climate.clone(),
        None => {
            let parent = before.parent.filter(has_same_noises).map(|parts| &*parts.climate);
            let (climate, samples) = work.run(Stage::ClimateNoise, || {
                profiling::scope!("climate noise");
                climate_field(terrain, id, &points, parent)
            });
            work.octave_samples += samples;
            Arc::new(climate)
        }
    };

    // Heights that change anywhere, however far away, make another coast.
    let map_keys = terrain.climate.map_keys();
    let from_maps = match before.parts {
        Some(parts) if parts.map_keys == map_keys => parts.from_maps.clone(),
        _ => Arc::new(terrain.climate.climates_of_maps(&points.dirs)),
    };

    let painted = terrain.painted(&points.dirs);
    let same_heights = before.keys.heights == terrain.tile_keys_at(id).heights;
    if let Some(tile) = before.tile.filter(|_| same_heights) {
        let climate_of = VertexClimate { noise: &climate, from_maps: &from_maps, painted: &painted };
        let tile = work.run(Stage::Climate, || with_climate(tile, terrain, &points.dirs, &climate_of));
        let parts = before.parts.map(|parts| Parts { climate_noises, climate, map_keys, from_maps, ..parts.clone() });
        return (fields, Some((tile, parts)));
    }

    for (layer, slot) in layers.iter().zip(&mut fields) {
        if slot.is_none() && layer.needed {
            if !keep_going() {
                return (fields, None);
            }
            let spacings_rad = layer.spacings_rad(&spacings_rad);
            profiling::scope!("field");
            work.octave_samples += layer.landform.octave_count() * TILE_VERTICES;
            let field = work.run(Stage::Field, || Field::new(&layer.landform, simd, &points, &spacings_rad));
            *slot = Some(Arc::new(field));
        }
    }

    let mut relief_fields: ReliefFields = Vec::new();
    for noise in terrain.relief.iter().flat_map(Relief::noises) {
        let known = before.parts.and_then(|parts| parts.relief_fields.iter().find(|(known, _)| known == noise));
        let field = known.map_or_else(
            || {
                work.octave_samples += noise.octave_count() * TILE_VERTICES;
                work.run(Stage::Field, || Arc::new(Field::new(noise, simd, &points, &spacings_rad)))
            },
            |(_, field)| field.clone(),
        );
        relief_fields.push((noise.clone(), field));
    }

    static NEXT_HEIGHTS: AtomicU64 = AtomicU64::new(1);
    let (heights, heights_serial) = match before.parts {
        Some(parts) if same_heights => (parts.heights.clone(), parts.heights_serial),
        _ => work.run(Stage::Height, || {
            profiling::scope!("height");
            let mut kept = Kept {
                layers: &fields,
                relief: &relief_fields,
                climate: ClimateInputs {
                    noise: [&climate.temperature, &climate.moisture],
                    from_maps: &from_maps,
                    painted: &painted,
                },
            };
            let mut heights = terrain.joined(&points, &spacings_rad, &mut kept);
            heights.flood(&points.dirs, own_spacing_rad, terrain.planet().sea_level_m());
            (Arc::new(heights), NEXT_HEIGHTS.fetch_add(1, Ordering::Relaxed))
        }),
    };

    let tile = work.run(Stage::Climate, || {
        profiling::scope!("mesh");
        let climate = VertexClimate { noise: &climate, from_maps: &from_maps, painted: &painted };
        Tile { heights_serial, ..mesh(terrain, id, &points.dirs, &heights, &climate) }
    });
    let parts = Parts { points, heights, heights_serial, relief_fields, climate_noises, climate, map_keys, from_maps };
    (fields, Some((tile, Some(parts))))
}

fn directions(id: NodeId) -> Vec<DVec3> {
    let step = 1.0 / TILE_QUADS as f64;
    (0..TILE_VERTICES).map(|i| id.direction((i % TILE_SIDE) as f64 * step, (i / TILE_SIDE) as f64 * step)).collect()
}

/// The climate noise at a tile's points, and the octave samples that it took. Every second point of every second row
/// is a point of the parent: its noise is copied if the parent's is known.
fn climate_field(
    terrain: &Terrain,
    id: NodeId,
    points: &Points,
    parent: Option<&ClimateField>,
) -> (ClimateField, usize) {
    let octaves: usize = terrain.climate.noises().into_iter().flatten().map(Landform::octave_count).sum();
    let Some(parent) = parent else {
        return (terrain.climate.field(terrain.simd(), points), octaves * points.len());
    };
    let is_shared = |i: usize| (i % TILE_SIDE).is_multiple_of(2) && (i / TILE_SIDE).is_multiple_of(2);
    let own: Vec<usize> = (0..TILE_VERTICES).filter(|&i| !is_shared(i)).collect();
    let pick = |all: &[f64]| own.iter().map(|&i| all[i]).collect();
    let own_points = Points {
        x: pick(&points.x),
        y: pick(&points.y),
        z: pick(&points.z),
        dirs: own.iter().map(|&i| points.dirs[i]).collect(),
        spacing_rad: points.spacing_rad,
    };
    let found = terrain.climate.field(terrain.simd(), &own_points);
    let (right, upper) = id.quarter();
    let merge = |found: &[f64], parent: &[f64]| {
        let mut found = found.iter();
        (0..TILE_VERTICES)
            .filter_map(|i| {
                let (x, y) = ((i % TILE_SIDE + right * TILE_QUADS) / 2, (i / TILE_SIDE + upper * TILE_QUADS) / 2);
                if is_shared(i) { parent.get(y * TILE_SIDE + x) } else { found.next() }.copied()
            })
            .collect()
    };
    let field = ClimateField {
        temperature: merge(&found.temperature, &parent.temperature),
        moisture: merge(&found.moisture, &parent.moisture),
    };
    (field, octaves * own.len())
}
