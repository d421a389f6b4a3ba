//! One tile from one node: directions, layer fields, height, climate, mesh (see `mesh`). Stages whose inputs did not change are taken
//! from the tile that stood there before.

use super::mesh::mesh;
use crate::lod::select::spacing_rad;
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES, Tile, Vertex};
use crate::planet::param::Stage;
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use crate::terrain::climate::ClimateField;
use crate::terrain::field::Field;
use crate::terrain::height::{self, Heights};
use crate::terrain::landform::Landform;
use crate::terrain::points::Points;
use glam::DVec3;
use std::sync::Arc;

/// What a tile was made from, kept so that an edit re-runs only the stages it makes stale.
#[derive(Debug)]
pub(crate) struct Parts {
    points: Arc<Points>,
    fields: Vec<(Arc<Landform>, Arc<Field>)>,
    heights: Arc<Heights>,
    climate_noises: Option<[Landform; 2]>,
    climate: Arc<ClimateField>,
}

impl Parts {
    /// Resident size, for the cache's budget.
    pub(crate) fn bytes(&self) -> usize {
        let fields: usize = self.fields.iter().map(|(_, field)| field.bytes()).sum();
        fields + TILE_VERTICES * (48 + 8 + 24 + 16 + size_of::<Vertex>())
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
    let points = before.map_or_else(|| Arc::new(Points::new(directions(id))), |(parts, _)| parts.points.clone());
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

    let tile = mesh(terrain, id, &points.dirs, &heights, &climate);
    let fields = terrain
        .stack
        .layers
        .iter()
        .zip(fields)
        .filter_map(|(layer, field)| Some((layer.landform.clone(), field?)))
        .collect();
    (tile, Parts { points, fields, heights, climate_noises, climate }, work)
}

fn directions(id: NodeId) -> Vec<DVec3> {
    let step = 1.0 / TILE_QUADS as f64;
    (0..TILE_VERTICES).map(|i| id.direction((i % TILE_SIDE) as f64 * step, (i / TILE_SIDE) as f64 * step)).collect()
}
