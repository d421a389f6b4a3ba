//! One state of a planet, compiled once for all that show or query it, and what changed between two of them: one
//! comparison of content keys, which the tiles, the renderer and the editor share.
//!
//! Stages that tiles keep have keys of compiled content: of landforms, of the layer stack, of climate rules, of the
//! world maps that they read. A renamed layer, a layer that is off or a parameter that nothing reads therefore changes
//! no key. Textures of the renderer have keys of the parameters that declare their stage.

use super::climate::{CompiledClimate, MapKeys, SeaLevelClimate, final_map_keys};
use super::edits::Edits;
use super::height::LayerStack;
use super::landform::Reads;
use super::relief::Relief;
use crate::planet::param::{ParamPath, Stage, Stages, Value};
use crate::planet::{GroundEdits, InvalidPlanet, Key, Planet, Structure};
use crate::world::carved::Carved;
use crate::world::plates::Plates;
use crate::world::weather::Weather;
use crate::world::{Inputs, Slot, StructureInputs};
use std::sync::Arc;
use std::time::Instant;

/// One state of a planet, compiled, and the content keys of what is made from it.
#[derive(Clone, Debug)]
pub struct Revision {
    planet: Arc<Planet>,
    pub(super) compiled: Arc<Compiled>,
    compile_secs: f64,
}

impl Revision {
    /// Compiles a planet. Far cheaper than its terrain: nothing is evaluated.
    ///
    /// # Errors
    /// An invalid planet: every problem it has.
    pub fn try_new(planet: Arc<Planet>) -> Result<Self, InvalidPlanet> {
        Self::try_after(planet, None)
    }

    /// As [`Revision::try_new`], of a planet that was edited: the ground edits that it shares with an earlier revision
    /// are not compiled again. The result is the same as without.
    ///
    /// # Errors
    /// As [`Revision::try_new`].
    pub fn try_after(planet: Arc<Planet>, before: Option<&Revision>) -> Result<Self, InvalidPlanet> {
        if let Some(same) = before.filter(|before| Arc::ptr_eq(&before.planet, &planet) || before.planet == planet) {
            return Ok(Self { planet, ..same.clone() });
        }
        let begun = Instant::now();
        planet.check()?;
        let edits = before.and_then(|before| before.compiled.edits.as_ref());
        let compiled = Arc::new(Compiled::new(&planet, edits));
        Ok(Self { planet, compiled, compile_secs: begun.elapsed().as_secs_f64() })
    }

    /// Whether two revisions share what is compiled: that of equal planets.
    pub(crate) fn is_same(&self, other: &Revision) -> bool {
        Arc::ptr_eq(&self.compiled, &other.compiled)
    }

    /// Time that it took to compile, seconds.
    pub(crate) fn compile_secs(&self) -> f64 {
        self.compile_secs
    }

    /// The ground edits, if any is on.
    pub(crate) fn edits(&self) -> Option<&Arc<Edits>> {
        self.compiled.edits.as_ref()
    }

    /// The planet.
    pub fn planet(&self) -> &Arc<Planet> {
        &self.planet
    }

    /// The content keys.
    pub fn keys(&self) -> &Keys {
        &self.compiled.keys
    }

    /// The stages that must run again to get from an earlier revision to this one.
    pub fn changes_since(&self, before: &Revision) -> Stages {
        self.keys().changes_since(before.keys())
    }
}

/// Content keys of the stages. Equal keys of a stage mean equal results.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Keys {
    /// Of each field that is needed, in ascending order.
    fields: Arc<[Key]>,
    heights: Key,
    climate_noise: Key,
    climate: Key,
    materials: Key,
    cloud_map: Key,
    /// Of painted clouds; None if there are none.
    cloud_paint: Option<Key>,
    optical_depth: Key,
    air_tables: Key,
    life: Key,
    /// Edits of what stands on the ground; None if there are none, or nothing stands there.
    life_edits: Option<Key>,
}

impl Keys {
    /// The key of the biome textures.
    pub fn materials(&self) -> Key {
        self.materials
    }

    /// The key of the cloud coverage map, without paint.
    pub fn cloud_map(&self) -> Key {
        self.cloud_map
    }

    /// The key of painted clouds; None if there are none.
    pub fn cloud_paint(&self) -> Option<Key> {
        self.cloud_paint
    }

    /// The key of the LUT of optical depth.
    pub fn optical_depth(&self) -> Key {
        self.optical_depth
    }

    /// The key of the LUTs of scattered light and of the light of the sky. It includes the key of optical depth.
    pub fn air_tables(&self) -> Key {
        self.air_tables
    }

    /// The key of the populations. What stands on the ground follows from the ground, the climate and the biomes, too.
    pub fn life(&self) -> Key {
        self.life
    }

    /// The stages whose results differ, and those that read them. [`Stage::Field`] is among them only if a field is
    /// needed that the earlier revision did not need. [`Stage::Uniform`] and [`Stage::Label`] never are: uniforms are
    /// written for each frame, and labels are not drawn.
    pub fn changes_since(&self, before: &Keys) -> Stages {
        let more_fields = self.fields.iter().any(|field| before.fields.binary_search(field).is_err());
        let differs = [
            (Stage::Field, more_fields),
            (Stage::Height, self.heights != before.heights),
            (Stage::ClimateNoise, self.climate_noise != before.climate_noise),
            (Stage::Climate, self.heights != before.heights || self.climate != before.climate),
            (Stage::Life, (self.life, self.life_edits) != (before.life, before.life_edits)),
            (Stage::Material, self.materials != before.materials),
            (Stage::CloudMap, (self.cloud_map, self.cloud_paint) != (before.cloud_map, before.cloud_paint)),
            (Stage::OpticalDepth, self.optical_depth != before.optical_depth),
            (Stage::AirTables, self.air_tables != before.air_tables),
        ];
        differs.into_iter().filter(|(_, differs)| *differs).map(|(stage, _)| stage).collect()
    }
}

/// Content keys of what a tile holds. They differ from the planet's own while world maps of an earlier revision serve.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct TileKeys {
    pub(crate) heights: Key,
    pub(crate) climate: Key,
}

/// Content keys of what tiles are made from, world maps apart.
#[derive(Clone, Debug)]
pub(super) struct TileContent {
    /// The layer stack, and the world maps that it reads.
    stack: Key,
    reads: Reads,
    /// Whether a layer reads a mask that is painted.
    reads_masks: bool,
    /// Biome relief.
    relief: Option<Key>,
    /// Climate at sea level, with its noise.
    climate: Key,
}

impl TileContent {
    /// The keys of tiles that read maps with these keys.
    pub(super) fn keys(&self, maps: MapKeys, plates: Option<Key>) -> TileKeys {
        let [_, weather, carved] = maps;
        let steered = (plates.filter(|_| self.reads.plates), weather.filter(|_| self.reads.weather));
        // Biome relief follows the climate.
        let relief = self.relief.map(|relief| (relief, maps));
        TileKeys { heights: Key::of(&(self.stack, carved, steered, relief)), climate: Key::of(&(self.climate, maps)) }
    }
}

impl TileContent {
    /// The keys of tiles with edits of the ground, paint of masks and paint of the climate of these keys.
    pub(super) fn with_edits(&self, keys: TileKeys, [ground, masks, paint]: [Option<Key>; 3]) -> TileKeys {
        // Biome relief follows the climate.
        let shaping = [ground, masks.filter(|_| self.reads_masks), paint.filter(|_| self.relief.is_some())];
        let changed = |key: Key, by: &dyn std::fmt::Debug| Key::of(&(key, by));
        TileKeys {
            heights: if shaping == [None; 3] { keys.heights } else { changed(keys.heights, &shaping) },
            climate: paint.map_or(keys.climate, |paint| changed(keys.climate, &paint)),
        }
    }
}

/// A planet, compiled, before its world maps are known.
#[derive(Debug)]
pub(super) struct Compiled {
    pub(super) stack: LayerStack,
    /// The layers under the structure.
    pub(super) under: Option<Arc<LayerStack>>,
    /// Ground edits.
    pub(super) edits: Option<Arc<Edits>>,
    pub(super) climate: CompiledClimate,
    pub(super) relief: Option<Relief>,
    pub(super) map_inputs: Inputs,
    pub(super) content: TileContent,
    pub(super) keys: Keys,
}

impl Compiled {
    /// Compiles a valid planet after the edits of an earlier revision.
    fn new(planet: &Planet, before: Option<&Arc<Edits>>) -> Self {
        let edits = Edits::new(planet, before);
        let painted = edits.as_ref();
        let (stack, under) = (LayerStack::new(planet, painted), LayerStack::under(planet, painted));
        let climate = CompiledClimate::new(planet);
        let relief = Relief::new(planet, &climate, stack.limits_m());
        let relief_noises = relief.iter().flat_map(Relief::noises).map(|noise| Key::of(&**noise));
        let mut fields: Vec<Key> = stack.field_keys().chain(relief_noises).collect();

        let heights = Key::of(&stack.joined());
        let with_masks = |stack: &LayerStack| match stack.painted_key() {
            None => Key::of(&stack.joined()),
            Some(masks) => Key::of(&(Key::of(&stack.joined()), masks)),
        };
        let map_inputs = Inputs {
            heights: with_masks(&stack),
            under: under.as_ref().map(with_masks),
            sea_level_m: planet.sea_level_m(),
            reads_coast: CompiledClimate::reads_coast(planet),
            structure: structure_inputs(planet),
            sculpted: edits.as_ref().filter(|_| planet.structure.is_some()).and_then(|edits| edits.structure_key()),
            grids: planet.structure.as_ref().map_or(0, |structure| structure.grids as usize),
        };
        let (carved, plates) = (Slot::<Carved>::final_key(&map_inputs), Slot::<Plates>::final_key(&map_inputs));
        let (weather, reads) = (Slot::<Weather>::final_key(&map_inputs), stack.reads());
        fields.extend(carved);
        fields.extend(plates.filter(|_| reads.plates));
        fields.extend(weather.filter(|_| reads.weather));
        fields.sort_unstable();
        let climate_noise = Key::of(&climate.noises());
        let content = TileContent {
            stack: heights,
            reads,
            reads_masks: stack.painted_key().is_some(),
            relief: relief.as_ref().map(Key::of),
            climate: Key::of(&(climate_noise, SeaLevelClimate::new(planet))),
        };
        let tiles = content.keys(final_map_keys(&map_inputs), plates);
        let all = edits.as_ref().map(|edits| [edits.key(), edits.mask_key(), edits.paint_key()]);
        let tiles = content.with_edits(tiles, all.unwrap_or_default());
        let [materials, cloud_map, optical_depth, air_tables, life] = drawn_keys(planet);
        let keys = Keys {
            fields: fields.into(),
            heights: tiles.heights,
            climate_noise,
            climate: tiles.climate,
            materials,
            cloud_map,
            cloud_paint: edits.as_ref().and_then(|edits| edits.cloud_key()),
            optical_depth,
            air_tables,
            life,
            life_edits: edits.as_ref().filter(|_| !planet.life.is_empty()).and_then(|edits| edits.life_key()),
        };
        Self { stack, under: under.map(Arc::new), edits, climate, relief, map_inputs, content, keys }
    }
}

/// What of a planet its structure depends on.
fn structure_inputs(planet: &Planet) -> Option<Arc<StructureInputs>> {
    let Structure { plates, weather, rivers, .. } = planet.structure.clone()?;
    let climate = &planet.climate;
    Some(Arc::new(StructureInputs {
        plates,
        weather,
        rivers,
        seed: planet.seed,
        radius_km: planet.radius_km,
        equator_c: climate.equator_c,
        pole_c: climate.pole_c,
        lapse_c_per_km: climate.lapse_c_per_km,
    }))
}

/// Keys of the parameters that the biome textures, the cloud coverage map, and the LUTs of optical depth and of
/// scattered light read.
fn drawn_keys(planet: &Planet) -> [Key; 5] {
    const STAGES: [Stage; 5] = [Stage::Material, Stage::CloudMap, Stage::OpticalDepth, Stage::AirTables, Stage::Life];
    let mut read: [Vec<(ParamPath, Value)>; 5] = Default::default();
    // Edits have keys of their own, and may be thousands.
    let bare = Planet { edits: GroundEdits::default(), ..planet.clone() };
    bare.each_value(&mut |path, param, value| {
        for (stage, read) in STAGES.iter().zip(&mut read) {
            if param.stages.contains(*stage) {
                read.push((path.clone(), value.get()));
            }
        }
    });
    let [materials, cloud_map, optical_depth, air_tables, life] = &read;
    let sets: Vec<_> = planet.texture_sets().map(|(_, file)| file.set()).collect();
    [
        Key::of(&(materials, &planet.biomes.table, sets)),
        Key::of(cloud_map),
        Key::of(optical_depth),
        Key::of(&(optical_depth, air_tables)),
        Key::of(life),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::shipped;

    #[test]
    fn tiles_have_the_keys_of_the_maps_that_they_were_made_from() {
        let structure = Some(Structure { grids: 1, ..Structure::default() });
        let planet = Planet { structure, ..shipped::layered() };
        let content = Compiled::new(&planet, None).content;
        let map = |n: u32| Some(Key::of(&n));
        let own = content.keys([map(2), map(3), map(1)], map(4));
        assert!(content.relief.is_some());
        for (carved, coast, weather) in [(9, 2, 3), (1, 9, 3), (1, 2, 9)] {
            let other = content.keys([map(coast), map(weather), map(carved)], map(4));
            assert!(other.climate != own.climate && other.heights != own.heights, "{carved} {coast} {weather}");
        }
        let smooth = TileContent { relief: None, ..content.clone() };
        let own = smooth.keys([map(2), map(3), map(1)], map(4));
        let other = smooth.keys([map(2), map(9), map(1)], map(9));
        assert!(other.climate != own.climate && other.heights == own.heights, "heights read no weather");
        let steered = |plates, weather| TileContent { reads: Reads { plates, weather }, ..smooth.clone() };
        for (plates, weather) in [(false, false), (true, false), (false, true)] {
            let content = steered(plates, weather);
            let heights = |weather, plates| content.keys([map(2), map(weather), map(1)], map(plates)).heights;
            assert_eq!(heights(3, 4) != heights(3, 9), plates, "plates");
            assert_eq!(heights(3, 4) != heights(9, 4), weather, "weather");
        }
    }

    #[test]
    fn a_name_and_a_layer_that_is_off_change_nothing() {
        let mut planet = shipped::layered();
        planet.layers.push(crate::planet::Layer { name: "Off".to_owned(), enabled: false, ..Default::default() });
        let revision = |planet: &Planet| Revision::try_new(Arc::new(planet.clone())).unwrap();
        let before = revision(&planet);
        assert_eq!(revision(&planet).changes_since(&before), Stages::NONE);
        let mut edited = planet.clone();
        edited.name.push('!');
        if let Some(off) = edited.layers.last_mut() {
            (off.name, off.seed, off.amplitude_m) = ("Another".to_owned(), 77, 5.0);
        }
        assert_eq!(revision(&edited).changes_since(&before), Stages::NONE);
        edited.layers[0].amplitude_m += 1.0;
        let changes = revision(&edited).changes_since(&before);
        assert_eq!(changes, Stages::of(&[Stage::Height, Stage::Climate]));
        edited.layers[0].seed += 1;
        assert!(revision(&edited).changes_since(&before).contains(Stage::Field));
    }
}
