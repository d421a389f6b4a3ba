//! Canopy: what a population covers of the ground, for what is seen of it from afar and for queries.

use super::form::Cover;
use super::grid::HECTARE_M2;
use super::model::seed;
use super::suitability::Suitability;
use crate::planet::{Form, Planet, Population};
use crate::terrain::edits::{Edits, Planting, PopulationId};
use crate::terrain::{Sample, Terrain};
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// The cover of a population's form: that of its first variant, since variants differ little.
pub(crate) fn cover(population: &Population) -> Cover {
    Cover::new(&population.form, seed(population, 0))
}

/// Height in metres at which objects begin to count as casting shadows on the ground, and at which all of them do.
const CASTING_M: [f64; 2] = [0.6, 2.0];

/// Area of objects, for each area of ground, over which fallen leaves close: they fall beside the crowns, too.
pub(crate) const LITTER_AREA: f64 = 0.4;
/// Colour of what has fallen as shares of the colour of wood: what rots is darker, and browner.
const LITTER_OF: [f64; 3] = [0.52, 0.41, 0.28];

/// Share of sunlight that leaves let through, over their albedo: leaves are about as bright from behind.
const LET_THROUGH: f64 = 0.72;

/// Share of sunlight that needles let through, over their albedo: boughs lie over one another.
const NEEDLES_LET_THROUGH: f64 = 0.2;

/// Light that the leaves of a population let through to what stands below, as shares of the sun's; none of stones.
fn through_leaves(population: &Population) -> [f64; 3] {
    let has_leaves = match &population.form {
        Form::Tree(tree) => tree.leaves > 0.0,
        Form::Mesh(form) => form.file.mesh().is_some_and(|mesh| mesh.has_leaves),
        form => matches!(form, Form::Conifer(_) | Form::Palm(_) | Form::Tuft(_)),
    };
    let share = if matches!(population.form, Form::Conifer(_)) { NEEDLES_LET_THROUGH } else { LET_THROUGH };
    population.colors()[1].map(|channel| if has_leaves { share * channel } else { 0.0 })
}

/// What a population covers of the ground where everything suits it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CanopyLayer {
    /// Area of its objects as seen from above, for each square metre of ground; more than 1 where they overlap.
    pub(crate) top: f64,
    /// Their area as seen from the side, for each square metre of ground.
    pub(crate) side: f64,
    /// Mean height, metres.
    pub(crate) height_m: f64,
    /// Mean width of an object as seen from above, metres.
    pub(crate) width_m: f64,
    /// Mean colour as seen from above (albedo, linear sRGB).
    pub(crate) color: [f64; 3],
    /// Mean colour as seen from the side.
    pub(crate) side_color: [f64; 3],
    /// Colour of what has fallen from the objects (albedo, linear sRGB), and the share of the ground that it covers
    /// where they close.
    pub(crate) litter: ([f64; 3], f64),
    /// Light that its leaves let through to what stands below, as shares of the sun's.
    pub(crate) through: [f64; 3],
    /// Share of the objects that cast shadows worth telling of: those high enough.
    pub(crate) casting: f64,
    /// Light of what is seen.
    pub(crate) cover: Cover,
}

impl CanopyLayer {
    pub(crate) fn new(population: &Population, cover: &Cover) -> Self {
        // The mean square of heights that are even over their spread.
        let square_m2 = population.height_m.powi(2) * (1.0 + population.height_spread.powi(2) / 3.0);
        let per_m2 = population.per_hectare / HECTARE_M2;
        let shown = 1.0 - population.sunk;
        let [wood_color, leaf_color] = population.colors();
        let color = |part: f64| std::array::from_fn(|c| wood_color[c] + (leaf_color[c] - wood_color[c]) * part);
        Self {
            top: per_m2 * cover.top * square_m2,
            side: per_m2 * cover.side * square_m2 * shown,
            height_m: population.height_m * shown,
            width_m: (4.0 * cover.top * square_m2 / std::f64::consts::PI).sqrt(),
            color: color(cover.part[0]),
            side_color: color(cover.part[1]),
            litter: (std::array::from_fn(|c| LITTER_OF[c] * wood_color[c]), population.litter),
            through: through_leaves(population),
            casting: ((population.height_m - CASTING_M[0]) / (CASTING_M[1] - CASTING_M[0])).clamp(0.0, 1.0),
            cover: *cover,
        }
    }

    /// Share of the ground that the objects cover as seen from above, at a share of their density.
    pub(crate) fn covered(&self, share: f64) -> f64 {
        1.0 - libm::exp(-self.top * share)
    }

    /// Share of the ground between the objects that fallen leaves cover, at a share of their density.
    fn littered(&self, share: f64) -> f64 {
        self.litter.1 * (1.0 - libm::exp(-self.top * share / LITTER_AREA))
    }
}

/// What stands at a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Canopy {
    /// Share of the ground that objects cover as seen from above, 0 to 1.
    pub cover: f64,
    /// Mean height of the objects, each counted by what it covers, metres; 0 where nothing stands.
    pub height_m: f64,
}

/// The canopies of a planet: the densities of its populations, and what they cover. The default has none.
#[derive(Clone, Debug, Default)]
pub struct Canopies {
    populations: usize,
    /// Populations that are on, the lowest first.
    layers: Vec<Layer>,
    /// Edits that clear the ground and plant it.
    edits: Option<Arc<Edits>>,
}

/// A population of a planet.
#[derive(Clone, Debug)]
struct Layer {
    population: usize,
    id: PopulationId,
    suitability: Suitability,
    covers: CanopyLayer,
}

impl Canopies {
    /// Measures the forms of a terrain's planet, which takes some milliseconds for each population.
    pub fn new(terrain: &Terrain) -> Self {
        let planet: &Planet = terrain.planet();
        let on: Vec<_> = planet.life.iter().enumerate().filter(|(_, population)| population.enabled).collect();
        let layer = |&(index, population): &(usize, &Population)| Layer {
            population: index,
            id: PopulationId::of(&population.name),
            suitability: Suitability::new(planet, population),
            covers: CanopyLayer::new(population, &cover(population)),
        };
        let mut layers: Vec<Layer> = on.par_iter().map(layer).collect();
        layers.sort_by(|a, b| a.covers.height_m.total_cmp(&b.covers.height_m));
        Self { populations: planet.life.len(), layers, edits: terrain.life_edits().cloned() }
    }

    /// Share of its greatest density that each population has at a direction, whose sample is given, the lowest first.
    fn shares(&self, dir_planet: DVec3, sample: &Sample) -> Vec<f64> {
        let (dirs, mut planted) = ([dir_planet.normalize_or(DVec3::Z)], Vec::new());
        let mut share = |layer: &Layer| {
            let Some(edits) = &self.edits else { return layer.suitability.at(sample) };
            edits.planted(Some(layer.id), &dirs, &mut planted);
            layer.suitability.planted(sample, planted.first().copied().unwrap_or(Planting::NONE))
        };
        self.layers.iter().map(&mut share).collect()
    }

    /// Objects on a hectare at a direction, whose sample is given, for each population of the planet: the mean over its
    /// groups.
    pub fn densities_per_hectare(&self, dir_planet: DVec3, sample: &Sample) -> Vec<f64> {
        let mut densities = vec![0.0; self.populations];
        for (layer, share) in self.layers.iter().zip(self.shares(dir_planet, sample)) {
            densities[layer.population] = share * layer.suitability.population.per_hectare;
        }
        densities
    }

    /// Mean colour (albedo, linear sRGB) of what is seen of a place from far above, with ground of a colour: higher
    /// objects hide lower ones. `sample`: that of the direction.
    pub fn albedo(&self, dir_planet: DVec3, sample: &Sample, ground: [f64; 3]) -> [f64; 3] {
        let shares = self.shares(dir_planet, sample);
        let layers = || self.layers.iter().map(|layer| &layer.covers).zip(&shares);
        let mixed = |below: [f64; 3], above: [f64; 3], share: f64| -> [f64; 3] {
            std::array::from_fn(|c| below[c] + (above[c] - below[c]) * share)
        };
        // What has fallen lies on the ground, in the mean of its colours.
        let (mut bare, mut sum, mut fallen) = (1.0, 0.0, [0.0; 3]);
        for (covers, share) in layers() {
            let littered = covers.littered(*share);
            bare *= 1.0 - littered;
            sum += littered;
            fallen = std::array::from_fn(|c| fallen[c] + littered * covers.litter.0[c]);
        }
        let floor = if sum > 0.0 { mixed(ground, fallen.map(|channel| channel / sum), 1.0 - bare) } else { ground };
        layers().fold(floor, |below, (covers, share)| mixed(below, covers.color, covers.covered(*share)))
    }

    /// What stands at a direction, whose sample is given.
    pub fn at(&self, dir_planet: DVec3, sample: &Sample) -> Canopy {
        let (mut open, mut covered, mut height_m) = (1.0, 0.0, 0.0);
        for (Layer { covers, .. }, share) in self.layers.iter().zip(self.shares(dir_planet, sample)) {
            let cover = covers.covered(share);
            open *= 1.0 - cover;
            covered += cover;
            height_m += cover * covers.height_m;
        }
        Canopy { cover: 1.0 - open, height_m: if covered > 0.0 { height_m / covered } else { 0.0 } }
    }
}
