//! Planting map: what edits make of populations around an eye, and what water, ridges and hollows make of those that
//! ask for them, for what is seen of the canopy from afar.
//!
//! It is a row of squares of texels around one place, on the plane that touches the sphere there, each twice as wide as
//! the one before; the last one covers the whole side of the planet. `planting.wgsl` reads it.

use super::lie_shares::{LieShares, sample_level, tile_of};
use super::suitability::Suitability;
use crate::planet::Key;
use crate::sphere::{NodeId, geo};
use crate::terrain::Terrain;
use crate::terrain::edits::{Edits, Planting, PopulationId, Subject};
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

/// What a channel holds: of which strokes, and of which of the populations that ask for water, ridges and hollows.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Channel {
    name: Option<PopulationId>,
    lie: Option<usize>,
}

/// What maps are made from.
struct Ground<'a> {
    /// Edits that change what stands on the ground.
    edits: Option<&'a Arc<Edits>>,
    /// Names of the populations.
    names: Vec<PopulationId>,
    /// The populations that ask for water, ridges or hollows.
    asking: Vec<usize>,
    lies: &'a LieShares,
    /// Content key of the ground and of what these populations ask; None without any.
    lie: Option<Key>,
}

/// Maps of some views.
#[derive(Debug, Default)]
pub(super) struct PlantingMaps {
    maps: Vec<Arc<PlantingMap>>,
    lies: LieShares,
}

impl PlantingMaps {
    /// The map around an eye, and whether it is that of the terrain as it is; None where neither edits nor water,
    /// ridges and hollows change what stands on the ground. While `keep_going` says no, the last one that is there.
    pub(super) fn around(
        &mut self,
        terrain: &Terrain,
        eye_m: DVec3,
        keep_going: &(dyn Fn() -> bool + Sync),
    ) -> (Option<Arc<PlantingMap>>, bool) {
        let planet = terrain.planet();
        let edits = terrain.life_edits().filter(|edits| edits.plants_by_share());
        let is_on = |index: &usize| planet.life[*index].enabled;
        let asking: Vec<usize> =
            (0..planet.life.len()).filter(|index| is_on(index) && planet.life[*index].asks_lie()).collect();
        let is_bare = (0..planet.life.len()).all(|index| !is_on(&index));
        if is_bare || edits.is_none() && asking.is_empty() {
            return (None, true);
        }
        let (dir, radius_m) = (eye_m.normalize_or(DVec3::Z), planet.radius_m());
        let ground_m = terrain.height_m(dir).max(planet.sea_level_m().unwrap_or(f64::MIN));
        let wanted_m = (eye_m.length() - radius_m - ground_m) * TEXEL_OF_HEIGHT;
        let texel_m = LEAST_TEXEL_M * libm::exp2((wanted_m / LEAST_TEXEL_M).max(1.0).log2().ceil());
        let level = (FRAC_PI_2 * radius_m / (STEP_TEXELS * texel_m)).log2();
        let node = NodeId::containing(dir, level.clamp(0.0, f64::from(NodeId::MAX_LEVEL)) as u8);
        let names: Vec<&str> = planet.life.iter().map(|population| population.name.as_str()).collect();
        let asks: Vec<Suitability> =
            asking.iter().map(|index| Suitability::new(planet, &planet.life[*index])).collect();
        let lie = (!asks.is_empty()).then(|| {
            let rules: Vec<_> = asks.iter().map(|one| one.population.placed()).collect();
            Key::of(&(&asking, rules, NodeId::roots().map(|root| terrain.tile_keys_at(root))))
        });
        let edits_key = edits.map(|edits| edits.key(Subject::Life));
        let key = Key::of(&(edits_key, lie, names, radius_m.to_bits(), texel_m.to_bits(), node));
        if let Some(at) = self.maps.iter().position(|map| map.key == key) {
            // Maps of views that stand still are kept as well.
            self.maps[..=at].rotate_right(1);
            return (self.maps.first().cloned(), true);
        }
        let site = Site::new(node.direction(0.5, 0.5), radius_m, texel_m);
        if !asks.is_empty() && !self.lies.find(terrain, &asks, &site.tiles(), keep_going) {
            // One of other populations would show them in wrong places.
            return (self.maps.first().filter(|map| map.populations.len() == planet.life.len()).cloned(), false);
        }
        let names: Vec<_> = planet.life.iter().map(|population| PopulationId::of(&population.name)).collect();
        let ground = Ground { edits, names, asking, lies: &self.lies, lie };
        let made = PlantingMap::new(&ground, &site, key, &self.maps);
        self.maps.truncate(MOST_KEPT - 1);
        self.maps.insert(0, Arc::new(made));
        (self.maps.first().cloned(), true)
    }
}

impl Site {
    fn new(middle: DVec3, radius_m: f64, texel_m: f64) -> Self {
        let (east, north) = geo::east_north(middle);
        let levels = ((2.0 * radius_m / (SIDE as f64 * texel_m)).log2().ceil().max(0.0) as u32 + 1).min(32);
        Self { middle, east, north, radius_m, texel_m, levels }
    }

    /// The sample of [`LieShares`] at a direction, for a square: about two texels wide at most.
    fn sample(&self, level: u32, dir: DVec3) -> NodeId {
        let apart_m = 2.0 * self.texel_m * f64::from(level).exp2();
        NodeId::containing(dir, sample_level(self.radius_m, apart_m))
    }

    /// The tiles of [`LieShares`] that its texels need, in order.
    fn tiles(&self) -> Vec<NodeId> {
        let texels = (0..self.levels).into_par_iter().flat_map_iter(|level| {
            let mut found: Vec<NodeId> = (0..SIDE * SIDE)
                .map(|number| [number % SIDE, number / SIDE].map(|at| at as f64 + 0.5))
                .map(|at| tile_of(self.sample(level, self.dir(level, at))))
                .collect();
            found.dedup();
            found.sort_unstable();
            found.dedup();
            found
        });
        let mut tiles: Vec<NodeId> = texels.collect();
        tiles.sort_unstable();
        tiles.dedup();
        tiles
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

    /// Its texels: means of what edits make of a population at some places in each, and what water, ridges and hollows
    /// leave of that.
    fn texels(&self, ground: &Ground<'_>, channel: Channel, site: &Site) -> Vec<u32> {
        let mut dirs = Vec::with_capacity(BLOCK * BLOCK * PLACES * PLACES);
        let mut lies = Vec::with_capacity(BLOCK * BLOCK);
        for texel in 0..BLOCK * BLOCK {
            let corner = [texel % BLOCK + self.at[0] * BLOCK, texel / BLOCK + self.at[1] * BLOCK];
            let along = |axis: usize, place: usize| corner[axis] as f64 + (place as f64 + 0.5) / PLACES as f64;
            let places = (0..PLACES * PLACES).map(|place| [along(0, place % PLACES), along(1, place / PLACES)]);
            dirs.extend(places.map(|at| site.dir(self.level, at)));
            lies.push(channel.lie.map_or(1.0, |number| {
                let dir = site.dir(self.level, corner.map(|at| at as f64 + 0.5));
                ground.lies.at(number, site.sample(self.level, dir))
            }));
        }
        let mut planted = Vec::new();
        if let Some(edits) = ground.edits {
            edits.planted(channel.name, &dirs, &mut planted);
        }
        planted.resize(dirs.len(), Planting::NONE);
        let mean = |places: &[Planting], part: fn(&Planting) -> f64| {
            places.iter().map(part).sum::<f64>() / places.len() as f64
        };
        let texel = |(places, lie): (&[Planting], &f64)| {
            packed(Planting {
                keep: lie * mean(places, |planting| planting.keep),
                add: mean(places, |planting| planting.add),
            })
        };
        planted.chunks(PLACES * PLACES).zip(&lies).map(texel).collect()
    }
}

impl Ground<'_> {
    /// The strokes of life.
    fn strokes(&self) -> Vec<(Option<PopulationId>, f64)> {
        self.edits.map(|edits| edits.life_strokes().collect()).unwrap_or_default()
    }

    /// The channels: first that of strokes that paint all, then those of populations that ask for water, ridges and
    /// hollows, then those of populations that strokes name.
    fn channels(&self) -> Vec<Channel> {
        let mut channels = vec![Channel { name: None, lie: None }];
        channels.extend(
            self.asking.iter().enumerate().map(|(lie, at)| Channel { name: Some(self.names[*at]), lie: Some(lie) }),
        );
        let strokes = self.strokes();
        for (index, name) in self.names.iter().enumerate().filter(|(index, _)| !self.asking.contains(index)) {
            let own = Channel { name: Some(*name), lie: None };
            let is_painted = strokes.iter().any(|(of, _)| *of == Some(self.names[index]));
            if is_painted && !channels.contains(&own) {
                channels.push(own);
            }
        }
        channels
    }

    /// The channel of a population, by its index: its own, or that of strokes which paint all.
    fn channel_of(&self, index: usize, channels: &[Channel]) -> usize {
        let lie = self.asking.iter().position(|at| *at == index);
        let own = Channel { name: Some(self.names[index]), lie };
        channels.iter().position(|channel| *channel == own).unwrap_or(0)
    }

    /// The key of a block of a channel; None if all of it is as without edits.
    fn block_key(&self, block: &Block, channel: Channel, site: &Site) -> Option<Key> {
        let by_edits = self.edits.and_then(|edits| edits.life_key_in(block.disc(site), channel.name));
        match channel.lie {
            Some(_) => Some(Key::of(&(by_edits, self.lie))),
            None => by_edits,
        }
    }
}

impl PlantingMap {
    /// `kept`: earlier maps, of which one may have most of the blocks.
    fn new(ground: &Ground<'_>, site: &Site, key: Key, kept: &[Arc<Self>]) -> Self {
        profiling::scope!("planting map");
        let (strokes, channels) = (ground.strokes(), ground.channels());
        let is_planted =
            |name: PopulationId| strokes.iter().any(|(of, density)| *density > 0.0 && of.is_none_or(|of| of == name));
        let place = Key::of(&(site, &channels));
        let before = kept.iter().find(|map| map.place == place);
        let all = Block::all(channels.len(), site.levels);
        let make = |(number, block): (usize, &Block)| {
            let channel = channels[block.channel];
            let key = ground.block_key(block, channel, site);
            let known = before.filter(|before| before.blocks[number] == key);
            let made = key.filter(|_| known.is_none()).map(|_| block.texels(ground, channel, site));
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
        let of_population =
            |(index, name): (usize, &PopulationId)| (ground.channel_of(index, &channels) as u32, is_planted(*name));
        Self {
            east: site.east,
            north: site.north,
            texel_m: site.texel_m,
            levels: site.levels,
            populations: ground.names.iter().enumerate().map(of_population).collect(),
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
    use crate::planet::{Layer, Planet, Population, Shape, Tool};
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
        texel_at(map, channel, [place.dot(map.east), place.dot(map.north)])
    }

    fn texel_at(map: &PlantingMap, channel: u32, [x_m, y_m]: [f64; 2]) -> [f64; 2] {
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
            let map = maps.around(&terrain, eye * (radius_m + above_m), &|| true).0.unwrap();
            assert_eq!(map.populations, [(0, true), (1, true)]);
            assert_eq!(map.texels.len(), 2 * map.levels as usize * SIDE * SIDE);
            // A stroke more: other blocks stay.
            let more = self::terrain(&[("", 0.0, 1.0), ("Palm", 0.5, 300.0), ("", 0.25, 0.2), ("Oak", 1.0, 0.1)]);
            let next = maps.around(&more, eye * (radius_m + above_m), &|| true).0.unwrap();
            let afresh = PlantingMaps::default().around(&more, eye * (radius_m + above_m), &|| true).0.unwrap();
            assert!(next.texels == afresh.texels && next.blocks == afresh.blocks);
            let again = maps.around(&terrain, eye * (radius_m + above_m), &|| true).0.unwrap();
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

    /// Pixels know neither water nor ridges: the map must tell of them what objects find.
    #[test]
    fn the_map_tells_what_water_ridges_and_hollows_leave_in_the_mean() {
        let ask = |name: &str, bank_to_m: f64, curvature_from: f64| {
            let asking = Population { bank_to_m, curvature_from, slope_to_deg: 90.0, ..Population::default() };
            Population { name: name.to_owned(), ..asking }
        };
        let life = vec![ask("Any", 10_000.0, -1.0), ask("Ridge", 10_000.0, 0.0), ask("Shore", 200.0, -1.0)];
        let shape = crate::planet::Fbm { wavelength_km: 1.0, octaves: 6, ..Default::default() };
        let hills = Layer { amplitude_m: 120.0, shape: Shape::Fbm(shape), ..Layer::default() };
        let water = Some(crate::planet::Water::default());
        let planet = Planet { life, layers: vec![hills], water, radius_km: 600.0, ..Planet::default() };
        let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
        let (radius_m, eye) = (planet.radius_m(), LatLon::from_degrees(20.0, 30.0).direction());
        let (east, north) = geo::east_north(eye);
        // The greatest differences of means over a patch, and in the mean over its places.
        for (above_m, most_mean, most_single) in [(2.0, 0.01, 0.03), (900.0, 0.04, 0.35)] {
            let mut maps = PlantingMaps::default();
            let (none, is_whole) = maps.around(&terrain, eye * (radius_m + above_m + 200.0), &|| false);
            assert!(none.is_none() && !is_whole, "it was stopped");
            let ground_m = terrain.height_m(eye).max(0.0);
            let map = maps.around(&terrain, eye * (radius_m + ground_m + above_m), &|| true).0.unwrap();
            let channels = [1, 2].map(|population: usize| map.populations[population].0);
            assert_eq!((map.populations[0], channels), ((0, false), [1, 2]));
            let side = 40;
            let places =
                (0..side * side).map(|i| [i % side, i / side].map(|at| 2.4 * (f64::from(at) + 0.5) / 40.0 - 1.2));
            let places: Vec<DVec3> = places
                .map(|[x, y]| (eye * radius_m + (east * x + north * y) * (40.0 * map.texel_m)).normalize())
                .collect();
            let samples = terrain.samples(&places, crate::terrain::Wanted::ALL);
            for (population, channel) in [1, 2].into_iter().zip(channels) {
                let asked = &planet.life[population];
                let pairs =
                    places.iter().zip(&samples).filter(|(_, sample)| sample.height_m > 0.0).map(|(dir, sample)| {
                        let (map_x, map_y) = (dir.dot(map.east) * radius_m, dir.dot(map.north) * radius_m);
                        let wanted = asked.by_bank(sample.bank_m.unwrap()) * asked.by_curvature(sample.curvature);
                        (texel_at(&map, channel, [map_x, map_y])[0], wanted)
                    });
                let pairs: Vec<(f64, f64)> = pairs.collect();
                let count = pairs.len() as f64;
                let mean = |of: &dyn Fn(&(f64, f64)) -> f64| pairs.iter().map(of).sum::<f64>() / count;
                let (told, wanted) = (mean(&|pair| pair.0), mean(&|pair| pair.1));
                let single = mean(&|pair| (pair.0 - pair.1).abs());
                println!("{above_m} {population}: map {told:.3}, places {wanted:.3}, single {single:.3}");
                assert!((told - wanted).abs() < most_mean && single < most_single, "{above_m} {population} {single}");
            }
        }
    }

    #[test]
    fn without_edits_of_life_there_is_no_map() {
        let terrain = terrain(&[]);
        assert!(PlantingMaps::default().around(&terrain, DVec3::X * 7e6, &|| true).0.is_none());
    }
}
