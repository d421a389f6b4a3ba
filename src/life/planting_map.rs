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
/// Width of a texel of the finest square as a share of the height of the eye over the ground.
const TEXEL_OF_HEIGHT: f64 = 1.0 / 40.0;
/// Least width of a texel.
const LEAST_TEXEL_M: f64 = 1.0;
/// Least step of the middle, in texels of the finest square.
const STEP_TEXELS: f64 = 16.0;
/// Most populations with a channel of their own. Others have that of strokes which paint all populations.
const MOST_NAMED: usize = 7;
/// Texels along a side of a block. A block is evaluated where edits touch it, and again when one of these changes.
const BLOCK: usize = 16;
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
    /// Keys of the edits that touch each block, in the order of channels, squares and rows.
    blocks: Vec<Option<Key>>,
    /// Content key of its site and its channels.
    place: Key,
    /// Content key of its site and of all edits.
    key: Key,
}

/// Where a map lies.
#[derive(Clone, Copy, Debug)]
struct Site {
    middle: DVec3,
    east: DVec3,
    north: DVec3,
    radius_m: f64,
    texel_m: f64,
    levels: u32,
}

/// A block of a map: its channel, its square, its column and its row among blocks.
#[derive(Clone, Copy, Debug)]
struct Block {
    channel: usize,
    level: u32,
    at: [usize; 2],
}

/// Maps of some views.
#[derive(Debug, Default)]
pub(super) struct PlantingMaps(Vec<Arc<PlantingMap>>);

impl PlantingMaps {
    /// The map around an eye; None where no edit changes what stands on the ground.
    pub(super) fn around(&mut self, terrain: &Terrain, eye_m: DVec3) -> Option<Arc<PlantingMap>> {
        let (edits, planet) = (terrain.life_edits()?, terrain.planet());
        if !edits.plants_by_share() || planet.life.iter().all(|population| !population.enabled) {
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
        if let Some(at) = self.0.iter().position(|map| map.key == key) {
            // Maps of views that stand still are kept as well.
            self.0[..=at].rotate_right(1);
            return self.0.first().cloned();
        }
        let populations: Vec<_> = planet.life.iter().map(|population| PopulationId::of(&population.name)).collect();
        let site = Site::new(node.direction(0.5, 0.5), radius_m, texel_m);
        let made = PlantingMap::new(edits, &populations, &site, key, &self.0);
        self.0.truncate(MOST_KEPT - 1);
        self.0.insert(0, Arc::new(made));
        self.0.first().cloned()
    }
}

impl Site {
    fn new(middle: DVec3, radius_m: f64, texel_m: f64) -> Self {
        let (east, north) = geo::east_north(middle);
        let levels = ((2.0 * radius_m / (SIDE as f64 * texel_m)).log2().ceil().max(0.0) as u32 + 1).min(32);
        Self { middle, east, north, radius_m, texel_m, levels }
    }

    /// The direction at a place of a square, in texels from its corner.
    fn dir(&self, level: u32, at: [f64; 2]) -> DVec3 {
        let texel_m = self.texel_m * f64::from(level).exp2();
        let [x, y] = at.map(|at| (at - SIDE as f64 / 2.0) * texel_m / self.radius_m);
        // What lies beyond the limb is not seen.
        (self.middle * (1.0 - x * x - y * y).max(0.0).sqrt() + self.east * x + self.north * y).normalize()
    }
}

impl Block {
    /// All blocks of a map, in order.
    fn all(channels: usize, levels: u32) -> Vec<Self> {
        let along = SIDE / BLOCK;
        let squares = (0..channels).flat_map(|channel| (0..levels).map(move |level| (channel, level)));
        let of = |(channel, level)| {
            (0..along * along).map(move |number| Self { channel, level, at: [number % along, number / along] })
        };
        squares.flat_map(of).collect()
    }

    /// A disc around its places: the middle, and the chord to the edge.
    fn disc(&self, site: &Site) -> (DVec3, f64) {
        let corner = |x: f64, y: f64| {
            site.dir(self.level, [(self.at[0] as f64 + x) * BLOCK as f64, (self.at[1] as f64 + y) * BLOCK as f64])
        };
        let middle = corner(0.5, 0.5);
        let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(x, y)| corner(x, y).distance(middle));
        // The sides bend a little.
        (middle, 1.1 * corners.into_iter().fold(0.0, f64::max))
    }

    /// The numbers of the first texels of its rows.
    fn rows(self, levels: u32) -> impl Iterator<Item = usize> {
        let first = (self.channel * levels as usize + self.level as usize) * SIDE;
        (0..BLOCK).map(move |row| (first + self.at[1] * BLOCK + row) * SIDE + self.at[0] * BLOCK)
    }

    /// Its texels: means of what edits make of a population at some places in each.
    fn texels(&self, edits: &Edits, name: Option<PopulationId>, site: &Site) -> Vec<u32> {
        let mut dirs = Vec::with_capacity(BLOCK * BLOCK * PLACES * PLACES);
        for texel in 0..BLOCK * BLOCK {
            let corner = [texel % BLOCK + self.at[0] * BLOCK, texel / BLOCK + self.at[1] * BLOCK];
            let along = |axis: usize, place: usize| corner[axis] as f64 + (place as f64 + 0.5) / PLACES as f64;
            let places = (0..PLACES * PLACES).map(|place| [along(0, place % PLACES), along(1, place / PLACES)]);
            dirs.extend(places.map(|at| site.dir(self.level, at)));
        }
        let mut planted = Vec::new();
        edits.planted(name, &dirs, &mut planted);
        let mean = |places: &[Planting], part: fn(&Planting) -> f64| {
            places.iter().map(part).sum::<f64>() / places.len() as f64
        };
        let texel = |places: &[Planting]| {
            packed(Planting {
                keep: mean(places, |planting| planting.keep),
                add: mean(places, |planting| planting.add),
            })
        };
        match planted.is_empty() {
            true => vec![packed(Planting::NONE); BLOCK * BLOCK],
            false => planted.chunks(PLACES * PLACES).map(texel).collect(),
        }
    }
}

impl PlantingMap {
    /// `kept`: earlier maps, of which one may have most of the blocks.
    fn new(edits: &Edits, populations: &[PopulationId], site: &Site, key: Key, kept: &[Arc<Self>]) -> Self {
        profiling::scope!("planting map");
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
        let place = Key::of(&(site, &channels));
        let before = kept.iter().find(|map| map.place == place);
        let all = Block::all(channels.len(), site.levels);
        let make = |(number, block): (usize, &Block)| {
            let name = channels[block.channel];
            let key = edits.life_key_in(block.disc(site), name);
            let known = before.filter(|before| before.blocks[number] == key);
            let made = key.filter(|_| known.is_none()).map(|_| block.texels(edits, name, site));
            (key, made)
        };
        let made: Vec<(Option<Key>, Option<Vec<u32>>)> = all.par_iter().enumerate().map(make).collect();
        let count = channels.len() * site.levels as usize * SIDE * SIDE;
        let none = packed(Planting::NONE);
        let mut texels = before.map_or_else(|| vec![none; count], |before| before.texels.clone());
        for (block, (key, made)) in all.iter().zip(&made) {
            for (row, first) in block.rows(site.levels).enumerate() {
                let own = &mut texels[first..first + BLOCK];
                match made {
                    Some(made) => own.copy_from_slice(&made[row * BLOCK..(row + 1) * BLOCK]),
                    None if key.is_none() => own.fill(none),
                    None => {}
                }
            }
        }
        Self {
            east: site.east,
            north: site.north,
            texel_m: site.texel_m,
            levels: site.levels,
            populations: populations.iter().map(|name| (number_of(*name) as u32, is_planted(*name))).collect(),
            texels,
            blocks: made.into_iter().map(|(key, _)| key).collect(),
            place,
            key,
        }
    }
}

/// A texel.
fn packed(Planting { keep, add }: Planting) -> u32 {
    let bits = |share: f64| (share.clamp(0.0, 1.0) * 65535.0).round() as u32;
    bits(keep) | bits(add) << 16
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::edits::{EditPoint, GroundEdit, LifePaint};
    use crate::planet::{Planet, Population, Tool};
    use crate::sphere::LatLon;

    fn terrain(strokes: &[(&str, f64, f64)]) -> Terrain {
        let point = EditPoint { latitude_deg: 20.0, longitude_deg: 30.0, ..EditPoint::default() };
        let stroke = |&(population, density, radius_km): &(&str, f64, f64)| {
            let paint = LifePaint { population: population.to_owned(), density };
            let points = [point].into_iter().collect();
            GroundEdit { tool: Tool::Life(paint), radius_km, softness: 0.0, points, ..GroundEdit::default() }
        };
        let named = |name: &str| Population { name: name.to_owned(), ..Population::default() };
        let (life, edits) = (vec![named("Oak"), named("Palm")], strokes.iter().map(stroke).collect());
        Terrain::try_new(Arc::new(Planet { life, edits, layers: Vec::new(), ..Planet::default() })).unwrap()
    }

    /// What the map says of a population at a distance east of the stroke: the finest square that reaches it.
    fn at(map: &PlantingMap, channel: u32, eye: DVec3, radius_m: f64, east_m: f64) -> [f64; 2] {
        let (east, _) = geo::east_north(eye);
        let place = (eye * radius_m + east * east_m).normalize() * radius_m;
        let [x_m, y_m] = [place.dot(map.east), place.dot(map.north)];
        let half = SIDE as f64 / 2.0;
        let level = (x_m.abs().max(y_m.abs()) / ((half - 1.0) * map.texel_m)).max(1.0).log2().ceil();
        let texel = |along_m: f64| (along_m / (map.texel_m * level.exp2()) + half) as usize;
        let square = channel as usize * map.levels as usize + level as usize;
        let texel = map.texels[(square * SIDE + texel(y_m)) * SIDE + texel(x_m)];
        [texel & 0xffff, texel >> 16].map(|bits| f64::from(bits) / 65535.0)
    }

    #[test]
    fn each_square_tells_what_strokes_make_of_its_places() {
        let terrain = terrain(&[("", 0.0, 1.0), ("Palm", 0.5, 300.0), ("", 0.25, 0.2)]);
        let (radius_m, eye) = (terrain.planet().radius_m(), LatLon::from_degrees(20.0, 30.0).direction());
        for above_m in [2.0, 900.0, 30_000.0, 5e6] {
            let mut maps = PlantingMaps::default();
            let map = maps.around(&terrain, eye * (radius_m + above_m)).unwrap();
            assert_eq!(map.populations, [(0, true), (1, true)]);
            assert_eq!(map.texels.len(), 2 * map.levels as usize * SIDE * SIDE);
            // A stroke more: other blocks stay.
            let more = self::terrain(&[("", 0.0, 1.0), ("Palm", 0.5, 300.0), ("", 0.25, 0.2), ("Oak", 1.0, 0.1)]);
            let next = maps.around(&more, eye * (radius_m + above_m)).unwrap();
            let afresh = PlantingMaps::default().around(&more, eye * (radius_m + above_m)).unwrap();
            assert!(next.texels == afresh.texels && next.blocks == afresh.blocks);
            let again = maps.around(&terrain, eye * (radius_m + above_m)).unwrap();
            assert!(Arc::ptr_eq(&map, &again), "it is kept");
            let (wide_m, mut compared) = (2.0 * map.texel_m, 0);
            for (east_m, oak, palm) in [
                (100.0, [0.0, 0.25], [0.0, 0.25]),
                (600.0, [0.0, 0.0], [0.0, 0.5]),
                (50_000.0, [1.0, 0.0], [0.0, 0.5]),
                (400_000.0, [1.0, 0.0], [1.0, 0.0]),
                (3_000_000.0, [1.0, 0.0], [1.0, 0.0]),
            ] {
                // Texels wider than a stroke are means.
                if [200.0, 1000.0, 300_000.0].iter().any(|edge_m| f64::abs(edge_m - east_m) <= wide_m) {
                    continue;
                }
                compared += 1;
                let found = [0, 1].map(|channel| at(&map, channel, eye, radius_m, east_m));
                let near = |a: [f64; 2], b: [f64; 2]| (0..2).all(|i| (a[i] - b[i]).abs() < 1e-4);
                assert!(near(found[0], oak) && near(found[1], palm), "{above_m} {east_m} {found:?}");
            }
            assert!(compared > 0, "{above_m}");
        }
    }

    #[test]
    fn without_edits_of_life_there_is_no_map() {
        let terrain = terrain(&[]);
        assert!(PlantingMaps::default().around(&terrain, DVec3::X * 7e6).is_none());
    }
}
