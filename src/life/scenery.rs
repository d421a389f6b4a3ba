//! Scenery: the objects that a view draws, cell by cell, and those of earlier views that serve it.

use super::around::{Needed, needed};
use super::canopy;
use super::form::Cover;
use super::grid::place_in;
use super::model::Model;
use super::placement::{Placement, PlacementScratch};
#[cfg(feature = "render")]
use super::planting_map::{PlantingMap, PlantingMaps};
use super::query::Instance;
use super::soil::{Soil, Soils};
use super::thinning::{Thinning, is_low_cover, thinnings};
use crate::lod::View;
use crate::planet::{Key, MAX_POPULATIONS, Population};
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use glam::{DQuat, DVec3, Quat, Vec3};
use rayon::prelude::*;
use std::collections::{HashMap, HashSet};
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
    /// Place in the node of its cell, 0 to 1.
    pub place: [f32; 2],
    /// Normal of the ground around, over some metres; upwards where that is not known.
    pub ground_planet: Vec3,
}

impl SceneryObject {
    /// How far the ground rises with each metre to the side, as seen from an eye. `rel_m`: from there to the foot.
    pub fn rise_aside(&self, rel_m: DVec3) -> f64 {
        let up = self.foot_planet_m;
        let aside = up.cross(rel_m).normalize_or_zero();
        let ground = self.ground_planet.as_dvec3();
        -ground.dot(aside) / ground.dot(up.normalize_or(DVec3::Z)).max(0.1)
    }
}

/// The objects of a population in a node: a cell, or far away a group of them.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct SceneryCell {
    /// Index of the population.
    pub population: u16,
    /// The node.
    pub id: NodeId,
    /// Its objects: those of low rank alone, where fewer and wider ones stand for all.
    pub objects: Vec<SceneryObject>,
    /// Rank below which objects are there.
    limit: f64,
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
    /// For each population of the planet, the distance from the eye beyond which fewer and wider objects stand for all;
    /// infinite where each stands for itself.
    pub full_m: Vec<f64>,
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
        is_same && self.reach_m == other.reach_m && self.full_m == other.full_m
    }
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
            full_m: vec![f64::INFINITY; populations],
            covers: vec![None; populations],
            #[cfg(feature = "render")]
            planting: None,
        };
        let mut is_whole = true;
        if keep_going() {
            self.measure_covers(&placements);
        }
        let thinnings = thinnings(&placements, view.quality);
        for (placement, thinning) in placements.iter().zip(&thinnings) {
            let index = usize::from(placement.index);
            (scenery.reach_m[index], scenery.full_m[index]) = (thinning.reach_m, thinning.full_m);
            scenery.covers[index] = self.covers.get(&Model::key_of(placement.population())).copied();
            is_whole &= scenery.covers[index].is_some();
        }
        let needed = needed(terrain, view, (&placements, &thinnings));
        // From afar, nothing is drawn.
        for placement in placements.iter().filter(|_| !needed.is_empty()) {
            let index = usize::from(placement.index);
            scenery.models[index] = self.model(placement.population(), keep_going());
            is_whole &= scenery.models[index].is_some();
        }
        is_whole &= self.make_lacking(terrain, &needed, keep_going);
        scenery.cells = self.cells_for(&needed);
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

    /// Cells with objects that are kept, nearest first. Where a group of cells is not there yet its cells stand in, and
    /// where a cell is not, its group.
    fn cells_for(&self, needed: &[Needed<'_>]) -> Vec<Arc<SceneryCell>> {
        let (mut cells, mut seen) = (Vec::new(), HashSet::new());
        for needed in needed {
            let mut add = |cell: &Arc<SceneryCell>| {
                if !cell.objects.is_empty() && seen.insert((cell.population, cell.id)) {
                    cells.push(cell.clone());
                }
            };
            if let Some(cell) = self.known_by_rules(needed, needed.id) {
                add(cell);
            } else {
                needed.standing_in().filter_map(|id| self.known_by_rules(needed, id)).for_each(add);
            }
        }
        cells
    }

    fn known(&self, needed: &Needed<'_>) -> Option<&Arc<SceneryCell>> {
        let is_whole = |cell: &&Arc<SceneryCell>| cell.ground == needed.ground && cell.limit >= needed.limit;
        self.known_by_rules(needed, needed.id).filter(is_whole)
    }

    /// A node that is kept, also from the ground before an edit: its objects stand in for those that are not there yet.
    fn known_by_rules(&self, needed: &Needed<'_>, id: NodeId) -> Option<&Arc<SceneryCell>> {
        self.cells.get(&(needed.placement.index, id)).filter(|cell| cell.rules == needed.rules)
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
    /// How objects of a population thin out.
    pub fn thinning(&self, population: usize) -> Thinning {
        let of = |list: &[f64], or: f64| list.get(population).copied().unwrap_or(or);
        Thinning { full_m: of(&self.full_m, f64::INFINITY), reach_m: of(&self.reach_m, 0.0) }
    }

    /// Objects in all cells.
    pub fn object_count(&self) -> usize {
        self.cells.iter().map(|cell| cell.objects.len()).sum()
    }
}

fn make(terrain: &Terrain, needed: &Needed<'_>, soil: Option<&Soil>, memory: &mut PlacementScratch) -> SceneryCell {
    let planet_m = terrain.planet().radius_m();
    let (mut instances, placement) = (Vec::new(), needed.placement);
    let cells: Vec<NodeId> = needed.id.descendants(placement.grid.level).collect();
    placement.place_below(needed.limit, terrain, &cells, soil, memory, &mut instances);
    let is_group = needed.id.level < placement.grid.level;
    let object = |instance: &Instance| {
        let up = instance.dir_planet;
        let ground = soil.filter(|_| is_low_cover(placement.population())).map(|soil| soil.normal(up, planet_m));
        let object = object(instance, planet_m, ground.unwrap_or(up));
        // Candidates know their place in a cell.
        let place = if is_group { place_in(needed.id, up).map(|part| part as f32) } else { object.place };
        SceneryObject { place, ..object }
    };
    let objects: Vec<SceneryObject> = instances.iter().map(object).collect();
    let middle = objects.iter().map(|object| object.foot_planet_m).sum::<DVec3>() / objects.len().max(1) as f64;
    let from_middle = |object: &SceneryObject| object.foot_planet_m.distance(middle);
    let greatest = |of: &dyn Fn(&SceneryObject) -> f64| objects.iter().map(of).fold(0.0, f64::max);
    SceneryCell {
        population: placement.index,
        id: needed.id,
        limit: needed.limit,
        center_planet_m: middle,
        feet_radius_m: greatest(&from_middle),
        tallest_m: greatest(&|object| object.size_m.into()),
        objects,
        rules: needed.rules,
        ground: needed.ground,
    }
}

fn object(instance: &Instance, planet_m: f64, ground_planet: DVec3) -> SceneryObject {
    SceneryObject {
        id: instance.id,
        foot_planet_m: instance.foot_planet_m(planet_m),
        planet_from_form: DQuat::from_mat3(&instance.planet_from_form()).normalize().as_quat(),
        size_m: instance.size_m as f32,
        brightness: instance.brightness as f32,
        rank: instance.rank as f32,
        variant: instance.variant,
        place: instance.place.map(|part| part as f32),
        ground_planet: ground_planet.as_vec3(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Camera, Quality};
    use crate::planet::life::Tuft;
    use crate::planet::{Form, Layer, Planet};
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

    #[test]
    fn far_away_a_view_has_a_part_of_each_list_and_each_object_of_it_is_one_of_the_list() {
        let form = Form::Tuft(Tuft::default());
        let grass = Population { per_hectare: 30_000.0, height_m: 0.4, solid: false, form, ..Population::default() };
        let terrain = terrain(Population { slope_to_deg: 90.0, ..grass }, 100.0);
        let place = LatLon::from_degrees(10.0, 20.0);
        let eye_m = 600_000.0 + terrain.height_m(place.direction()) + 2.0;
        let camera = Camera::over(place, eye_m, 0.0, 0.0, Camera::DEFAULT_FOV_Y_RAD);
        let view = View { camera, size_px: [320, 180], quality: Quality::Medium };
        let mut cache = SceneryCache::default();
        let (scenery, is_whole) = cache.find(&terrain, &view, &|| true);
        let placement = &Placement::all(terrain.planet())[0];
        assert!(is_whole);

        let (mut memory, mut soils) = (PlacementScratch::default(), Soils::default());
        let (mut groups, mut kept, mut all) = (0, 0, 0);
        for cell in &scenery.cells {
            let soil_node = placement.soil_node(cell.id);
            soils.add(&terrain, soil_node.into_iter());
            let (mut placed, planet_m) = (Vec::new(), terrain.planet().radius_m());
            let cells: Vec<NodeId> = cell.id.descendants(placement.grid.level).collect();
            for cell in &cells {
                placement.place(&terrain, &[*cell], soils.get(soil_node), &mut memory, &mut placed);
            }
            let below = placed.iter().filter(|instance| instance.rank < cell.limit);
            let below: Vec<SceneryObject> = below.map(|instance| object(instance, planet_m, DVec3::Z)).collect();
            assert_eq!(below.len(), cell.objects.len(), "{:?}, {}", cell.id, cell.limit);
            for (expected, found) in below.iter().zip(&cell.objects) {
                let expected = SceneryObject { place: found.place, ground_planet: found.ground_planet, ..*expected };
                assert_eq!(expected, *found);
                assert!(found.place.iter().all(|part| (0.0..=1.0).contains(part)), "{found:?}");
            }
            let away_m = cell.center_planet_m.distance(view.camera.position_planet_m) - 2.0 * cell.feet_radius_m;
            assert!(cell.limit >= scenery.thinning(0).limit(away_m).min(1.0), "{away_m} m: {}", cell.limit);
            groups += usize::from(cells.len() > 1);
            (kept, all) = (kept + cell.objects.len(), all + placed.len());
        }
        assert!(groups > 10 && kept > 1000 && 4 * kept < all, "{groups} groups, {kept} objects of {all}");
        assert!(scenery.cells.iter().any(|cell| cell.limit == 1.0));

        // While the eye moves on and nothing is made yet, groups stand in for their cells, and cells for their group.
        let moved = LatLon::from_degrees(10.0 + 90.0 / 600_000.0 * 180.0 / std::f64::consts::PI, 20.0);
        let camera = Camera::over(moved, eye_m, 0.0, 0.0, Camera::DEFAULT_FOV_Y_RAD);
        let (standing_in, is_whole) = cache.find(&terrain, &View { camera, ..view }, &|| false);
        assert!(!is_whole);
        let ids = |scenery: &Scenery, by_m: DVec3, within_m: f64| -> HashSet<u64> {
            let objects = scenery.cells.iter().flat_map(|cell| &cell.objects);
            objects.filter(|one| one.foot_planet_m.distance(by_m) < within_m).map(|one| one.id).collect()
        };
        for by_m in [place, moved].map(|at| at.direction() * (eye_m - 2.0)) {
            let (before, now) = (ids(&scenery, by_m, 30.0), ids(&standing_in, by_m, 30.0));
            assert!(before.len() > 20 && before.is_subset(&now), "{} objects, then {}", before.len(), now.len());
        }
    }
}
