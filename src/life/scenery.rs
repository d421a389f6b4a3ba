//! Scenery: the objects that a view draws, cell by cell, and those of earlier views that serve it.

use super::canopy;
use super::form::Cover;
use super::grid::angle;
use super::model::Model;
use super::placement::{Placement, PlacementScratch};
#[cfg(feature = "render")]
use super::planting_map::{PlantingMap, PlantingMaps};
use super::query::Instance;
use super::soil::{Soil, Soils};
use crate::lod::{Quality, View};
use crate::planet::{Key, MAX_POPULATIONS, Population};
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use glam::{DQuat, DVec3, Quat};
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;

/// An object as it is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct SceneryObject {
    /// See [`Instance::id`].
    pub id: u64,
    /// Foot of the form, metres from the planet's centre.
    pub foot_planet_m: DVec3,
    /// Turns the form (z up) into the planet frame.
    pub planet_from_form: Quat,
    /// Height of the form, metres.
    pub size_m: f32,
    /// See [`Instance::brightness`].
    pub brightness: f32,
    /// See [`Instance::rank`].
    pub rank: f32,
    /// See [`Instance::variant`].
    pub variant: u8,
    /// Place in the cell, 0 to 1.
    pub place: [f32; 2],
}

/// The objects of a population in a node.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SceneryCell {
    /// Index of the population.
    pub population: u16,
    /// The node.
    pub id: NodeId,
    /// Its objects.
    pub objects: Vec<SceneryObject>,
    /// Middle of a sphere that holds their feet, metres from the planet's centre.
    pub center_planet_m: DVec3,
    /// Radius of that sphere.
    pub feet_radius_m: f64,
    /// Height of the tallest of them.
    pub tallest_m: f64,
    /// Content key of the population, and of what decides about the ground besides its shape.
    rules: Key,
    /// Content key of the shape of the ground, and of the edits that clear and plant it.
    ground: Key,
}

impl SceneryCell {
    /// Radius of a sphere that holds the objects. `reach`: distance from its foot within which an object lies, in
    /// heights.
    pub fn radius_m(&self, reach: f64) -> f64 {
        self.feet_radius_m + reach * self.tallest_m
    }
}

/// The objects that a view draws.
#[derive(Clone, Debug, Default)]
#[non_exhaustive]
pub struct Scenery {
    /// Cells with objects, nearest first.
    pub cells: Vec<Arc<SceneryCell>>,
    /// For each population of the planet, its meshes; None for those that are off, and from afar.
    pub models: Vec<Option<Arc<Model>>>,
    /// For each population of the planet, the distance from the eye up to which its objects are drawn; beyond a half of
    /// it they thin out by rank.
    pub reach_m: Vec<f64>,
    /// For each population of the planet, the cover of its form; None for those that are off.
    pub(crate) covers: Vec<Option<Cover>>,
    /// What edits, water, ridges and hollows make of the populations; None where they change nothing, or not yet.
    #[cfg(feature = "render")]
    pub(crate) planting: Option<Arc<PlantingMap>>,
}

impl Scenery {
    /// Whether two have the same objects, meshes and planting map: those that are kept from one view to the next.
    pub fn is_same(&self, other: &Self) -> bool {
        fn same<T>(a: &[Arc<T>], b: &[Arc<T>]) -> bool {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| Arc::ptr_eq(a, b))
        }
        let models = |of: &Self| of.models.iter().map(|model| model.as_ref().map(Arc::as_ptr)).collect::<Vec<_>>();
        let is_same = same(&self.cells, &other.cells) && models(self) == models(other);
        #[cfg(feature = "render")]
        let is_same = is_same
            && self.planting.as_ref().map(Arc::as_ptr) == other.planting.as_ref().map(Arc::as_ptr)
            && self.covers.iter().map(Option::is_some).eq(other.covers.iter().map(Option::is_some));
        is_same && self.reach_m == other.reach_m
    }
}

/// Share of its reach up to which all objects of a population are drawn.
pub const FULL_SHARE: f64 = 0.5;

/// Share of the objects of a population that are drawn at a distance.
pub fn share_at(distance_m: f64, reach_m: f64) -> f64 {
    ((reach_m - distance_m) / (reach_m * (1.0 - FULL_SHARE))).clamp(0.0, 1.0)
}

/// Heights of an object within which it is drawn, and the most objects of a population around the eye.
fn limits(quality: Quality) -> (f64, f64) {
    match quality {
        Quality::Low => (60.0, 8_000.0),
        Quality::Medium => (180.0, 80_000.0),
        Quality::High => (360.0, 300_000.0),
    }
}

/// Distance up to which objects of a population are drawn, apart from others.
fn own_reach_m(placement: &Placement, quality: Quality) -> f64 {
    let (heights, most) = limits(quality);
    let by_count_m = (most / (placement.most_per_m2() * std::f64::consts::PI)).sqrt();
    (placement.population().height_m * heights).min(by_count_m)
}

/// Distances up to which objects of each population are drawn among all: none beyond a denser population of like size
/// in its biomes, because single trees would stand on a forest that is a canopy already.
fn reaches_m(placements: &[Placement], quality: Quality) -> Vec<f64> {
    let area = |population: &Population| population.per_hectare * population.height_m * population.height_m;
    let hides = |own: &Population, other: &Population| {
        let meets =
            own.biomes.is_empty() || other.biomes.is_empty() || own.biomes.chars().any(|key| other.stands_in(key));
        // One that asks for banks or ridges is not everywhere.
        meets && !other.asks_lie() && area(other) > area(own) && other.height_m > 0.5 * own.height_m
    };
    let own_m: Vec<f64> = placements.iter().map(|placement| own_reach_m(placement, quality)).collect();
    let among_m = |placement: &Placement, own_reach_m: f64| {
        let others = placements.iter().zip(&own_m);
        let denser = others.filter(|(other, _)| hides(placement.population(), other.population()));
        denser.map(|(_, other_m)| *other_m).fold(own_reach_m, f64::min)
    };
    placements.iter().zip(&own_m).map(|(placement, own_m)| among_m(placement, *own_m)).collect()
}

/// Cells and models of earlier views.
#[derive(Debug, Default)]
pub(crate) struct SceneryCache {
    models: HashMap<Key, Arc<Model>>,
    covers: HashMap<Key, Cover>,
    cells: HashMap<(u16, NodeId), Arc<SceneryCell>>,
    #[cfg(feature = "render")]
    planting: PlantingMaps,
}

/// Most objects that the cache keeps.
const MOST_KEPT: usize = 600_000;

/// Share of the height above the ground that counts for the reach: hills may rise towards the eye.
const HEIGHT_COUNTS: f64 = 0.8;

/// A cell that a view needs.
struct Needed<'a> {
    placement: &'a Placement,
    id: NodeId,
    rules: Key,
    ground: Key,
    away_m: f64,
}

impl Needed<'_> {
    fn soil_node(&self) -> Option<NodeId> {
        self.placement.soil_node(self.id)
    }
}

impl SceneryCache {
    /// The scenery around the eye of a view as far as it is kept, and the rest, nearest cells first, while `keep_going`
    /// says yes. Whether all of it is there now.
    pub(crate) fn find(
        &mut self,
        terrain: &Terrain,
        view: &View,
        keep_going: &(dyn Fn() -> bool + Sync),
    ) -> (Scenery, bool) {
        let placements = Placement::all(terrain.planet());
        let populations = terrain.planet().life.len();
        let mut scenery = Scenery {
            cells: Vec::new(),
            models: vec![None; populations],
            reach_m: vec![0.0; populations],
            covers: vec![None; populations],
            #[cfg(feature = "render")]
            planting: None,
        };
        let mut is_whole = true;
        if keep_going() {
            self.measure_covers(&placements);
        }
        let reaches_m = reaches_m(&placements, view.quality);
        for (placement, reach_m) in placements.iter().zip(&reaches_m) {
            let index = usize::from(placement.index);
            scenery.reach_m[index] = *reach_m;
            scenery.covers[index] = self.covers.get(&Model::key_of(placement.population())).copied();
            is_whole &= scenery.covers[index].is_some();
        }
        let needed = needed(terrain, view, (&placements, &reaches_m));
        // From afar, nothing is drawn.
        for placement in placements.iter().filter(|_| !needed.is_empty()) {
            let index = usize::from(placement.index);
            scenery.models[index] = self.model(placement.population(), keep_going());
            is_whole &= scenery.models[index].is_some();
        }
        is_whole &= self.make_lacking(terrain, &needed, keep_going);
        let cells = needed.iter().filter_map(|needed| self.known_by_rules(needed));
        scenery.cells = cells.filter(|cell| !cell.objects.is_empty()).cloned().collect();
        #[cfg(feature = "render")]
        {
            let (planting, is_whole_map) = self.planting.around(terrain, view.camera.position_planet_m, keep_going);
            (scenery.planting, is_whole) = (planting, is_whole && is_whole_map);
        }
        self.trim(&scenery);
        (scenery, is_whole)
    }

    /// Makes the cells that are not kept, in rounds, which keeps the order and can be stopped in between. Whether all
    /// are there now.
    fn make_lacking(
        &mut self,
        terrain: &Terrain,
        needed: &[Needed<'_>],
        keep_going: &(dyn Fn() -> bool + Sync),
    ) -> bool {
        let lacking: Vec<&Needed<'_>> = needed.iter().filter(|needed| self.known(needed).is_none()).collect();
        let mut soils = Soils::default();
        lacking.chunks(32 * rayon::current_num_threads().max(1)).all(|round| {
            if !keep_going() {
                return false;
            }
            soils.add(terrain, round.iter().filter_map(|needed| needed.soil_node()));
            let made = round.par_iter().map_init(PlacementScratch::default, |memory, needed| {
                Arc::new(make(terrain, needed, soils.get(needed.soil_node()), memory))
            });
            let made: Vec<Arc<SceneryCell>> = made.collect();
            self.cells.extend(made.into_iter().map(|cell| ((cell.population, cell.id), cell)));
            true
        })
    }

    fn known(&self, needed: &Needed<'_>) -> Option<&Arc<SceneryCell>> {
        self.known_by_rules(needed).filter(|cell| cell.ground == needed.ground)
    }

    /// A cell that is kept, also from the ground before an edit: its objects stand in for those that are not there yet.
    fn known_by_rules(&self, needed: &Needed<'_>) -> Option<&Arc<SceneryCell>> {
        self.cells.get(&(needed.placement.index, needed.id)).filter(|cell| cell.rules == needed.rules)
    }

    /// Measures the covers of populations that are not kept.
    fn measure_covers(&mut self, placements: &[Placement]) {
        let lacking = placements.iter().map(Placement::population);
        let lacking: Vec<_> = lacking.filter(|one| !self.covers.contains_key(&Model::key_of(one))).collect();
        self.covers.par_extend(lacking.par_iter().map(|one| (Model::key_of(one), canopy::cover(one))));
    }

    /// The model of a population, if it is kept, or one that is made now.
    fn model(&mut self, population: &Population, may_make: bool) -> Option<Arc<Model>> {
        let key = Model::key_of(population);
        if may_make {
            return Some(self.models.entry(key).or_insert_with(|| Arc::new(Model::new(population))).clone());
        }
        self.models.get(&key).cloned()
    }

    /// Forgets cells and models that a view does not need, if there are too many.
    fn trim(&mut self, scenery: &Scenery) {
        // A cell without objects takes room, too.
        let kept: usize = self.cells.values().map(|cell| 4 + cell.objects.len()).sum();
        if kept > MOST_KEPT {
            self.cells = scenery.cells.iter().map(|cell| ((cell.population, cell.id), cell.clone())).collect();
        }
        if self.covers.len() > 64 * MAX_POPULATIONS {
            self.covers.clear();
        }
        if self.models.len() > 2 * MAX_POPULATIONS {
            self.models.retain(|key, _| scenery.models.iter().flatten().any(|model| model.key == *key));
        }
    }
}

impl Scenery {
    /// Objects in all cells.
    pub fn object_count(&self) -> usize {
        self.cells.iter().map(|cell| cell.objects.len()).sum()
    }
}

/// Cells around the eye that a view needs, nearest first: those behind it, too, for shadows, and because it may turn
/// before the next surface is there.
///
/// `placements`, `reaches_m`: all that are on, and how far each is drawn.
fn needed<'a>(terrain: &Terrain, view: &View, (placements, reaches_m): (&'a [Placement], &[f64])) -> Vec<Needed<'a>> {
    let planet = terrain.planet();
    let (eye, planet_m) = (view.camera.position_planet_m, planet.radius_m());
    let farthest_m = reaches_m.iter().copied().fold(0.0, f64::max);
    // From orbit the ground below is not even asked for.
    if eye.length() - planet_m - terrain.height_bounds_m().1 > farthest_m / HEIGHT_COUNTS {
        return Vec::new();
    }
    let dir = eye.normalize_or(DVec3::Z);
    let ground_m = planet_m + terrain.height_m(dir).max(planet.sea_level_m().unwrap_or(f64::MIN));
    let above_m = (eye.length() - ground_m).max(0.0);
    if HEIGHT_COUNTS * above_m > farthest_m {
        return Vec::new();
    }
    // What decides about the ground, the climate and the biomes of a place.
    let site = Key::of(&(&planet.biomes, &planet.climate, planet.sea_level_m(), planet.radius_km, planet.seed));
    let mut needed = Vec::new();
    for (placement, reach_m) in placements.iter().zip(reaches_m) {
        // From above, less of the ground is in reach.
        let flat_m = (reach_m * reach_m - (HEIGHT_COUNTS * above_m).powi(2)).max(0.0).sqrt();
        if flat_m <= 0.0 {
            continue;
        }
        let rules = Key::of(&(site, placement.population().placed()));
        for id in placement.grid.cells_within(dir, flat_m) {
            let ground = Key::of(&(terrain.tile_keys_at(id), placement.edits_key(terrain, id)));
            let away_m = angle(id.direction(0.5, 0.5), dir) * planet_m;
            needed.push(Needed { placement, id, rules, ground, away_m });
        }
    }
    needed.sort_by(|a, b| {
        a.away_m.total_cmp(&b.away_m).then(a.id.cmp(&b.id)).then(a.placement.index.cmp(&b.placement.index))
    });
    needed
}

fn make(terrain: &Terrain, needed: &Needed<'_>, soil: Option<&Soil>, memory: &mut PlacementScratch) -> SceneryCell {
    let planet_m = terrain.planet().radius_m();
    let mut instances = Vec::new();
    needed.placement.place(terrain, &[needed.id], soil, memory, &mut instances);
    let objects: Vec<SceneryObject> = instances.iter().map(|instance| object(instance, planet_m)).collect();
    let middle = objects.iter().map(|object| object.foot_planet_m).sum::<DVec3>() / objects.len().max(1) as f64;
    let from_middle = |object: &SceneryObject| object.foot_planet_m.distance(middle);
    let greatest = |of: &dyn Fn(&SceneryObject) -> f64| objects.iter().map(of).fold(0.0, f64::max);
    SceneryCell {
        population: needed.placement.index,
        id: needed.id,
        center_planet_m: middle,
        feet_radius_m: greatest(&from_middle),
        tallest_m: greatest(&|object| object.size_m.into()),
        objects,
        rules: needed.rules,
        ground: needed.ground,
    }
}

fn object(instance: &Instance, planet_m: f64) -> SceneryObject {
    SceneryObject {
        id: instance.id,
        foot_planet_m: instance.foot_planet_m(planet_m),
        planet_from_form: DQuat::from_mat3(&instance.planet_from_form()).normalize().as_quat(),
        size_m: instance.size_m as f32,
        brightness: instance.brightness as f32,
        rank: instance.rank as f32,
        variant: instance.variant,
        place: instance.place.map(|part| part as f32),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::Camera;
    use crate::planet::{Layer, Planet};
    use crate::sphere::LatLon;

    fn terrain(population: Population, amplitude_m: f64) -> Terrain {
        let layers = vec![Layer { amplitude_m, ..Layer::default() }];
        let planet = Planet { radius_km: 600.0, layers, life: vec![population], ..Planet::default() };
        Terrain::try_new(Arc::new(planet)).unwrap()
    }

    #[test]
    fn after_an_edit_of_the_ground_the_old_objects_stand_in_but_never_those_of_another_population() {
        let trees = Population { slope_to_deg: 90.0, ..Population::default() };
        let before = terrain(trees.clone(), 100.0);
        let place = LatLon::from_degrees(10.0, 20.0);
        let eye_m = 600_000.0 + before.height_m(place.direction()) + 30.0;
        let camera = Camera::over(place, eye_m, 0.0, -0.5, Camera::DEFAULT_FOV_Y_RAD);
        let view = View { camera, size_px: [320, 180], quality: Quality::Low };
        let mut cache = SceneryCache::default();
        let (made, is_whole) = cache.find(&before, &view, &|| true);
        assert!(is_whole && made.object_count() > 100, "{}", made.object_count());

        let (standing_in, is_whole) = cache.find(&terrain(trees.clone(), 101.0), &view, &|| false);
        assert!(!is_whole);
        assert_eq!(standing_in.object_count(), made.object_count());
        let other = Population { seed: 7, ..trees };
        let (others, is_whole) = cache.find(&terrain(other, 100.0), &view, &|| false);
        assert!(!is_whole);
        assert_eq!(others.object_count(), 0);
    }
}
