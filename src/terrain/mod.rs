//! The evaluator: from a planet to the height, normal, climate and biome of any point of its surface.
//!
//! - `scalar`, `lane`, `jet`: the numbers of the loops, chunks of them, and numbers with gradients
//! - `approx`: sine, cosine and arctangent for the loops
//! - `noise`: gradient noise of one octave
//! - `landform`: the kinds of layer, one file each
//! - `points`, `field`: a batch of points; the value and gradient of a landform there
//! - `height`: layers joined by amplitude, curves, blends and masks
//! - `climate`: temperature and moisture
//! - `relief`: biome relief
//! - `edits`: ground edits: strokes, stamps and splines
//! - `evaluate`: the pipeline that makes a height from all of these, for queries and tiles
//! - `biome`, `border`: the biome of a point; border jitter
//! - `builder`: terrains that take over what another one has
//! - `query`, `checked`, `raycast`, `contact`, `nearest`: the queries of [`Terrain`]; `sunlight`: the shadow of the
//!   ground at points; `water`: water, wind and rain there; `curvature`: ridges and hollows
//! - `contours`: coasts and other lines of equal height; `chunk`: ground for physics engines; `ground`: ground that is
//!   kept near those who move on it, and a walker
//! - `network`: rivers from source to mouth, lakes, basins; `by_hand`: plates that are changed by hand
//! - `effects`: what one layer does at points; `curve_inputs`: the numbers that curves bend
//! - `kept`: the fields that a tile keeps from one edit to the next
//! - `coarse`: the heights that world maps read
//! - [`revision`]: what changed between two revisions of a planet
//! - `bench`: noise alone, for measuring
//!
//! [`Terrain`] is the public interface. Tiles and queries take the same pipeline, and every query has a finite
//! answer.

mod approx;
pub mod bench;
pub(crate) mod biome;
pub(crate) mod border;
mod builder;
mod by_hand;
mod checked;
mod chunk;
pub(crate) mod climate;
pub(crate) mod coarse;
mod contact;
mod contours;
mod curvature;
mod curve_inputs;
pub(crate) mod edits;
mod effects;
pub(crate) mod evaluate;
pub(crate) mod field;
pub(crate) mod ground;
pub(crate) mod height;
mod jet;
pub(crate) mod kept;
pub(crate) mod landform;
pub(crate) mod lane;
pub(crate) mod material;
mod nearest;
mod network;
pub(crate) mod noise;
pub(crate) mod points;
mod query;
mod raycast;
pub(crate) mod relief;
pub mod revision;
mod scalar;
mod sunlight;
mod water;
pub(crate) mod wet;

use crate::planet::{InvalidPlanet, Planet};
use crate::sphere::NodeId;
pub use crate::world::MapStore;
use crate::world::weather::Weather;
use crate::world::{Inputs, KeepGoing, MapWork, World};
#[cfg(feature = "render")]
use crate::world::{MapPicture, MapView};
pub use builder::TerrainBuilder;
pub use checked::InvalidQuery;
pub use chunk::{Chunk, ChunkGrid};
pub use contact::{Capsule, Contact, Sweep};
pub use contours::Contour;
pub use curve_inputs::{CurveInput, CurveInputs};
pub use effects::LayerEffect;
pub use ground::{GroundPatch, Walkable, Walker, WalkerBody};
pub use height::curve_at;
pub use raycast::RayLimits;

use crate::simd::Simd;
use biome::CompiledBiomes;
use climate::{CompiledClimate, Rules};
use coarse::{CellFields, LayerGround};
pub use curvature::CURVATURE_M;
use edits::{Edits, Memory, Near, Painted};
use glam::DVec3;
use height::LayerStack;
use landform::{Landform, Maps};
pub use material::{GroundMaterial, GroundMaterials};
pub use nearest::{Place, Search};
pub use network::{Basin, Course, CoursePoint, Lake, Mouth, Rivers};
use points::unit;
pub use query::{Detail, Sample, Scratch, Wanted};
use relief::Relief;
pub use revision::Revision;
use revision::{Keys, TileKeys};
use std::f64::consts::PI;
use std::sync::Arc;
pub use water::River;

/// The compiled evaluator of one planet.
///
/// The same planet has bit-identical heights on every machine, instruction set and number of threads.
#[derive(Clone, Debug)]
pub struct Terrain {
    revision: Revision,
    simd: Simd,
    pub(crate) stack: LayerStack,
    /// The layers under the structure.
    under: Option<Arc<LayerStack>>,
    pub(crate) climate: CompiledClimate,
    /// Ground edits, if any is on.
    edits: Option<Arc<Edits>>,
    /// What edits that read the ground know of it.
    memory: Arc<Memory>,
    /// Biome relief, if any biome has one.
    pub(crate) relief: Option<Relief>,
    rules: Rules,
    biomes: CompiledBiomes,
    height_bounds_m: (f64, f64),
}

impl Terrain {
    /// Compiles a planet.
    ///
    /// # Errors
    /// A planet that was changed to something that no preset may say: all that is wrong with it. One that was loaded
    /// and not changed since is valid.
    pub fn try_new(planet: Arc<Planet>) -> Result<Self, InvalidPlanet> {
        Self::builder(planet).build()
    }

    /// As [`Terrain::try_new`], with world maps from a store where it has them. Those that it lacks are solved, and
    /// written to it.
    ///
    /// `go_on` is asked as [`TerrainBuilder::build_while`] asks it.
    ///
    /// # Errors
    /// As [`Terrain::try_new`].
    pub fn load(
        planet: Arc<Planet>,
        store: Option<Arc<MapStore>>,
        go_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Option<Self>, InvalidPlanet> {
        let mut builder = Self::builder(planet);
        if let Some(store) = store {
            builder = builder.store(store);
        }
        builder.build_while(go_on)
    }

    /// Share of the world maps that is solved, 0 to 1.
    pub(crate) fn map_progress(&self) -> f64 {
        self.world().progress(self.map_inputs())
    }

    /// As [`Terrain::try_new`]: waits for the finest world maps.
    pub(crate) fn try_new_with(
        planet: Arc<Planet>,
        fields: &CellFields,
        work: &mut MapWork,
    ) -> Result<Self, InvalidPlanet> {
        Self::builder(planet).build_with(fields, work)
    }

    /// The terrain of a revision with the world maps of an earlier terrain, which serve until its own are solved, and
    /// with what its edits know of the ground.
    pub(crate) fn draft_after(revision: &Revision, before: &Terrain) -> Self {
        Self::draft(revision, before.world(), before.memory.clone())
    }

    /// The same with these world maps, and with a memory of edits.
    pub(crate) fn draft(revision: &Revision, world: &World, memory: Arc<Memory>) -> Self {
        let (planet, compiled) = (revision.planet(), &revision.compiled);
        let terrain = Self {
            simd: Simd::detect(),
            stack: compiled.stack.clone(),
            under: compiled.under.clone(),
            edits: compiled.edits.clone(),
            memory,
            climate: compiled.climate.clone(),
            relief: compiled.relief.clone(),
            rules: Rules::new(planet),
            biomes: CompiledBiomes::new(planet),
            height_bounds_m: (0.0, 0.0),
            revision: revision.clone(),
        };
        terrain.over(world.serving(&compiled.map_inputs))
    }

    /// The same terrain with these world maps.
    fn over(mut self, world: World) -> Self {
        let carved = world.carved.key().zip(world.carved.map());
        self.stack.set_structure(carved.map(|(key, carved)| (key, &**carved)));
        let plates = world.plates.key().zip(world.plates.map()).map(|(key, plates)| (key, &**plates));
        let weather = world.weather.key().zip(world.weather.map());
        self.stack.set_maps(&Maps { plates, weather });
        if let Some(under) = &mut self.under {
            // The weather is solved over these layers.
            Arc::make_mut(under).set_maps(&Maps { plates, weather: None });
        }
        self.climate.world = world;
        let ground = crate::planet::Key::of(&(self.planet().radius_km, self.tile_keys().heights));
        self.memory = self.edits.as_ref().map(|edits| edits.memory(ground, &self.memory)).unwrap_or_default();
        self.height_bounds_m = self.with_relief(self.with_edits(self.stack.bounds_m(), None));
        self
    }

    /// The revision of the planet that the terrain was compiled from.
    pub fn revision(&self) -> &Revision {
        &self.revision
    }

    /// The content keys of the planet.
    pub fn keys(&self) -> &Keys {
        self.revision.keys()
    }

    fn map_inputs(&self) -> &Inputs {
        &self.revision.compiled.map_inputs
    }

    /// The world maps that serve.
    pub(crate) fn world(&self) -> &World {
        &self.climate.world
    }

    /// The weather of the structure, if it is solved.
    pub(crate) fn weather(&self) -> Option<&Arc<Weather>> {
        self.world().weather.map()
    }

    /// Key of [`Terrain::weather`].
    #[cfg(feature = "render")]
    pub(crate) fn weather_key(&self) -> Option<crate::planet::Key> {
        self.world().weather.key()
    }

    /// The picture of a map of the structure, if it is solved.
    #[cfg(feature = "render")]
    pub(crate) fn map_picture(&self, view: MapView) -> Option<MapPicture> {
        self.world().picture(view)
    }

    /// Keys of the maps that [`Terrain::map_picture`] shows.
    #[cfg(feature = "render")]
    pub(crate) fn map_picture_key(&self, view: MapView) -> [Option<crate::planet::Key>; 2] {
        self.world().picture_key(view)
    }

    /// Whether the world maps that serve are the planet's own, at their finest level.
    pub fn has_final_maps(&self) -> bool {
        self.world().is_final(self.map_inputs())
    }

    /// The same terrain with the next level of its own world maps. None if its maps are final, or if `keep_going` said
    /// no. `fields` keeps layer fields for the next revision.
    pub(crate) fn with_next_map(
        &self,
        fields: &CellFields,
        keep_going: &KeepGoing<'_>,
        work: &mut MapWork,
    ) -> Option<Self> {
        if self.has_final_maps() {
            return None;
        }
        let world = self.world().step(&self.ground(fields), keep_going, work)?;
        Some(self.clone().over(world))
    }

    /// Whether [`Terrain::with_draft_maps`] has something to do.
    pub(crate) fn wants_draft(&self) -> bool {
        self.world().wants_draft(self.map_inputs())
    }

    /// The same terrain with drafts of its own world maps, if those of another planet serve and its own must be
    /// solved.
    pub(crate) fn with_draft_maps(&self, fields: &CellFields, work: &mut MapWork) -> Option<Self> {
        if !self.wants_draft() {
            return None;
        }
        let world = self.world().draft(&self.ground(fields), work)?;
        Some(self.clone().over(world))
    }

    /// The layers as world maps read them.
    fn ground<'a>(&'a self, fields: &'a CellFields) -> LayerGround<'a> {
        let (stack, under, edits) = (&self.stack, self.under.as_deref(), self.edits.as_deref());
        LayerGround { inputs: self.map_inputs(), stack, under, edits, simd: self.simd, fields }
    }

    /// The paint of the climate at points; nothing if there is none at any.
    pub(crate) fn painted(&self, dirs: &[DVec3]) -> Vec<Painted> {
        let mut painted = Vec::new();
        if let Some(edits) = &self.edits {
            edits.painted(dirs, &mut Near::default(), &mut painted);
        }
        painted
    }

    /// The edits that change what stands on the ground. None if none does.
    pub(crate) fn life_edits(&self) -> Option<&Arc<Edits>> {
        self.edits.as_ref().filter(|edits| edits.plants())
    }

    /// Whether edits of the ground reach each of some points.
    #[cfg(feature = "bake")]
    pub(crate) fn edited(&self, dirs: &[DVec3]) -> Vec<bool> {
        self.edits.as_ref().map_or_else(|| vec![false; dirs.len()], |edits| edits.reached(dirs))
    }

    /// A disc that holds all ground that edits reach: its middle and its angle. None if there is none.
    #[cfg(feature = "bake")]
    pub(crate) fn edited_disc(&self) -> Option<(DVec3, f64)> {
        self.edits.as_ref()?.disc()
    }

    /// The rules of the climate.
    pub(crate) fn climate_rules(&self) -> &Rules {
        &self.rules
    }

    /// Content keys of the tile of a node. Edits count where they touch it.
    pub(crate) fn tile_keys_at(&self, id: NodeId) -> TileKeys {
        self.with_edits_near(self.tile_keys(), id)
    }

    /// The same from the keys that all tiles have before edits.
    pub(crate) fn with_edits_near(&self, keys: TileKeys, id: NodeId) -> TileKeys {
        match &self.edits {
            Some(edits) => {
                let near = [edits.key_near(id), edits.mask_key_near(id), edits.paint_key_near(id)];
                self.revision.compiled.content.with_edits(keys, near)
            }
            None => keys,
        }
    }

    /// Content keys of the tiles that the terrain makes, with the world maps that serve, before edits.
    pub(crate) fn tile_keys(&self) -> TileKeys {
        self.revision.compiled.content.keys(self.climate.map_keys(), self.world().plates.key())
    }

    /// The same terrain evaluated with a given instruction set, for tests and benches. The results are the same.
    pub fn with_simd(mut self, simd: Simd) -> Self {
        self.simd = simd.min(Simd::detect());
        self
    }

    /// The planet it was compiled from.
    pub fn planet(&self) -> &Arc<Planet> {
        self.revision.planet()
    }

    /// The instruction set in use.
    pub fn simd(&self) -> Simd {
        self.simd
    }

    /// Lowest and greatest height of the ground. Conservative: no point lies outside.
    pub fn height_bounds_m(&self) -> (f64, f64) {
        self.height_bounds_m
    }

    /// The same within an angle of a direction: narrower, or equal. NaN counts as any angle.
    pub fn height_bounds_near_m(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let angle_rad = if angle_rad.is_nan() { PI } else { angle_rad.abs().min(PI) };
        let dir = unit(dir_planet);
        let wide_rad = self.edits.as_ref().map_or(angle_rad, |edits| edits.reach_rad(dir, angle_rad)).min(PI);
        let bounds_m = self.with_edits(self.stack.bounds_near_m(dir, wide_rad), Some((dir, wide_rad)));
        let ((lo, hi), (lowest, highest)) = (self.with_relief(bounds_m), self.height_bounds_m);
        (lo.max(lowest), hi.min(highest))
    }

    /// Bounds of the height that the layers make, widened by edits near a place or anywhere.
    fn with_edits(&self, bounds_m: (f64, f64), near: Option<(DVec3, f64)>) -> (f64, f64) {
        let Some(edits) = &self.edits else { return bounds_m };
        let ((lo, hi), (lowest, highest)) = (edits.bounds_m(bounds_m, near), self.stack.limits_m());
        (lo.clamp(lowest, highest), hi.clamp(lowest, highest))
    }

    /// Bounds of the height that the layers make, widened by biome relief.
    fn with_relief(&self, (lo, hi): (f64, f64)) -> (f64, f64) {
        let Some(relief) = &self.relief else { return (lo, hi) };
        let ((less, more), (lowest, highest)) = (relief.bounds_m(), self.stack.limits_m());
        ((lo + less).clamp(lowest, highest), (hi + more).clamp(lowest, highest))
    }

    /// How many octaves of noise one point takes at most.
    pub fn octaves_per_point(&self) -> usize {
        let layers: usize = self.stack.layers.iter().filter(|l| l.needed).map(|l| l.landform.octave_count()).sum();
        let climate: usize = self.climate.noises().into_iter().flatten().map(Landform::octave_count).sum();
        layers + climate + self.relief.as_ref().map_or(0, Relief::octave_count)
    }
}
