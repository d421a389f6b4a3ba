//! Planting map: what edits make of populations around an eye, for what is seen of the canopy from afar.
//!
//! It is a row of squares of texels around one place, on the plane that touches the sphere there, each twice as wide as
//! the one before; the last one covers the whole side of the planet. `planting.wgsl` reads it.

use crate::planet::Key;
use crate::sphere::{NodeId, geo};
use crate::terrain::Terrain;
use crate::terrain::edits::{Edits, Planting, PopulationId};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Texels along a side of a square.
pub(crate) const SIDE: usize = 128;
/// Width of a texel of the finest square: a share of the height of the eye over the ground, and at least so many metres.
const TEXEL_OF_HEIGHT: f64 = 1.0 / 40.0;
const LEAST_TEXEL_M: f64 = 1.0;
/// The middle moves in steps of at least so many texels of the finest square.
const STEP_TEXELS: f64 = 16.0;
/// Most populations with a channel of their own. Others have that of strokes which paint all populations.
const MOST_NAMED: usize = 7;
/// Places along a side of a texel whose mean it is.
const PLACES: usize = 2;
/// Maps that are kept: one for each of some views.
const MOST_KEPT: usize = 4;

/// What edits make of populations around an eye.
#[derive(Debug)]
pub(crate) struct PlantingMap {
    /// Tangents at the middle of all squares, along their sides.
    pub(crate) east: DVec3,
    pub(crate) north: DVec3,
    /// Width of a texel of the finest square.
    pub(crate) texel_m: f64,
    /// Number of squares.
    pub(crate) levels: u32,
    /// For each population of the planet, its channel, and whether strokes may plant it where no rule puts it.
    pub(crate) populations: Vec<(u32, bool)>,
    /// What is kept of a share and what is added, 16 bits each: channel by channel, square by square, row by row.
    pub(crate) texels: Vec<u32>,
    key: Key,
}

/// Maps of some views.
#[derive(Debug, Default)]
pub(super) struct PlantingMaps(Vec<Arc<PlantingMap>>);

impl PlantingMaps {
    /// The map around an eye; None where no edit changes what stands on the ground.
    pub(super) fn around(&mut self, terrain: &Terrain, eye_m: DVec3) -> Option<Arc<PlantingMap>> {
        let (edits, planet) = (terrain.life_edits()?, terrain.planet());
        if planet.life.iter().all(|population| !population.enabled) {
            return None;
        }
        let (dir, radius_m) = (eye_m.normalize_or(DVec3::Z), planet.radius_m());
        let ground_m = terrain.height_m(dir).max(planet.sea_level_m().unwrap_or(f64::MIN));
        let wanted_m = (eye_m.length() - radius_m - ground_m) * TEXEL_OF_HEIGHT;
        let texel_m = LEAST_TEXEL_M * libm::exp2((wanted_m / LEAST_TEXEL_M).max(1.0).log2().ceil());
        let level = (FRAC_PI_2 * radius_m / (STEP_TEXELS * texel_m)).log2();
        let node = NodeId::containing(dir, level.clamp(0.0, f64::from(NodeId::MAX_LEVEL)) as u8);
        let names: Vec<&str> = planet.life.iter().map(|population| population.name.as_str()).collect();
        let key = Key::of(&(edits.life_key(), names, radius_m.to_bits(), texel_m.to_bits(), node));
        if let Some(kept) = self.0.iter().find(|map| map.key == key) {
            return Some(kept.clone());
        }
        let populations: Vec<_> = planet.life.iter().map(|population| PopulationId::of(&population.name)).collect();
        let made = PlantingMap::new(edits, &populations, (node.direction(0.5, 0.5), radius_m, texel_m), key);
        self.0.truncate(MOST_KEPT - 1);
        self.0.insert(0, Arc::new(made));
        self.0.first().cloned()
    }
}

impl PlantingMap {
    fn new(
        edits: &Edits,
        populations: &[PopulationId],
        (middle, radius_m, texel_m): (DVec3, f64, f64),
        key: Key,
    ) -> Self {
        profiling::scope!("planting map");
        let (east, north) = geo::east_north(middle);
        let levels = ((2.0 * radius_m / (SIDE as f64 * texel_m)).log2().ceil().max(0.0) as u32 + 1).min(32);
        let strokes: Vec<(Option<PopulationId>, f64)> = edits.life_strokes().collect();
        // First the channel of strokes that paint all.
        let mut channels = vec![None];
        for name in populations.iter().copied().map(Some) {
            let is_painted = strokes.iter().any(|(of, _)| *of == name);
            if is_painted && !channels.contains(&name) && channels.len() <= MOST_NAMED {
                channels.push(name);
            }
        }
        let number_of = |name: PopulationId| channels.iter().position(|of| *of == Some(name)).unwrap_or(0);
        let is_planted =
            |name: PopulationId| strokes.iter().any(|(of, density)| *density > 0.0 && of.is_none_or(|of| of == name));
        let rows: Vec<(Option<PopulationId>, u32, usize)> = channels
            .iter()
            .flat_map(|name| (0..levels).flat_map(move |level| (0..SIDE).map(move |row| (*name, level, row))))
            .collect();
        let dir_at = |x_m: f64, y_m: f64| {
            let [x, y] = [x_m, y_m].map(|along_m| along_m / radius_m);
            // What lies beyond the limb is not seen.
            (middle * (1.0 - x * x - y * y).max(0.0).sqrt() + east * x + north * y).normalize()
        };
        let row = |(dirs, planted): &mut (Vec<DVec3>, Vec<Planting>), &(name, level, row): &_| {
            let place_m = texel_m * f64::from(level).exp2() / PLACES as f64;
            let along_m = |place: usize| (place as f64 + 0.5 - (SIDE * PLACES / 2) as f64) * place_m;
            dirs.clear();
            for column in 0..SIDE {
                let places = (0..PLACES * PLACES).map(|place| [place % PLACES, place / PLACES]);
                dirs.extend(places.map(|[x, y]| dir_at(along_m(column * PLACES + x), along_m(row * PLACES + y))));
            }
            edits.planted(name, dirs, planted);
            texels_of(planted)
        };
        let made: Vec<[u32; SIDE]> = rows.par_iter().map_init(Default::default, row).collect();
        Self {
            east,
            north,
            texel_m,
            levels,
            populations: populations.iter().map(|name| (number_of(*name) as u32, is_planted(*name))).collect(),
            texels: made.into_flattened(),
            key,
        }
    }
}

/// A row of texels from what edits make at their places; nothing if none is near.
fn texels_of(planted: &[Planting]) -> [u32; SIDE] {
    let packed = |Planting { keep, add }: Planting| {
        let bits = |share: f64| (share.clamp(0.0, 1.0) * 65535.0).round() as u32;
        bits(keep) | bits(add) << 16
    };
    let mut row = [packed(Planting::NONE); SIDE];
    for (texel, places) in row.iter_mut().zip(planted.chunks(PLACES * PLACES)) {
        let mean = |part: fn(&Planting) -> f64| places.iter().map(part).sum::<f64>() / places.len() as f64;
        *texel = packed(Planting { keep: mean(|planting| planting.keep), add: mean(|planting| planting.add) });
    }
    row
}
