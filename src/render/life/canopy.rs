//! Canopies of biomes in the table of their parameters: what is seen of a population from so far away that its objects
//! are not drawn one by one. `canopy.wgsl` reads it.

use super::material::Material;
use super::view::populations;
use crate::life::Scenery;
use crate::life::canopy::CanopyLayer;
use crate::planet::Population;
use crate::render::scene::Body;
use glam::{DVec3, Vec3};

/// Most populations that count for the canopy of a biome: those that cover most.
pub(crate) const LAYERS: usize = 4;
/// Rows of a population, four numbers each.
pub(crate) const LAYER_ROWS: usize = 10;
/// Rows of a biome.
pub(crate) const ROWS: usize = LAYERS * LAYER_ROWS;
/// Share of its area that counts in the choice of populations of a biome for one that stands in few of its places.
const RARELY: f64 = 0.05;
/// Rows of a population that begin with its slopes, that have the height of the shore, and the channel of the planting
/// map.
const SLOPES: usize = 2;
const SHORE: usize = 4;
const CHANNEL: usize = 8;
/// A slope that no ground has.
const NO_SLOPE_DEG: f32 = 1000.0;

/// The canopy of a population.
#[derive(Clone, Debug, PartialEq)]
struct Layer {
    biomes: String,
    /// Whether strokes may plant it where no rule puts it.
    is_planted: bool,
    height_m: f64,
    area: f64,
    texels: [[f32; 4]; LAYER_ROWS],
}

impl Layer {
    /// The population in a biome where no rule puts it: the range of its slopes is one that no ground has.
    fn where_planted(&self) -> Self {
        let mut own = self.clone();
        [own.texels[SLOPES][0], own.texels[SLOPES][1]] = [NO_SLOPE_DEG; 2];
        own
    }
}

/// The population whose density is shown.
#[derive(Clone, Debug, PartialEq)]
struct Shown {
    biomes: String,
    /// Its rows, without those that tell how it looks.
    texels: [[f32; 4]; LAYER_ROWS],
}

/// The canopies of a planet.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CanopyRows {
    layers: Vec<Layer>,
    shown: Option<Shown>,
}

/// Rows of a population that say where it stands: slopes and moistures, heights and temperatures.
fn rules(population: &Population) -> [[f64; 4]; 2] {
    let Population { slope_from_deg, slope_to_deg, moisture_from, moisture_to, .. } = *population;
    let Population { height_from_m, height_to_m, temperature_from_c, temperature_to_c, .. } = *population;
    [
        [slope_from_deg, slope_to_deg, moisture_from, moisture_to],
        [height_from_m, height_to_m, temperature_from_c, temperature_to_c],
    ]
}

/// Height over the sea from which a population stands; far below it for one that stands in water.
fn shore_m(population: &Population) -> f64 {
    if population.in_water { -1e6 } else { population.shore_m }
}

/// Rows as the shader takes them.
fn texels(rows: [[f64; 4]; LAYER_ROWS]) -> [[f32; 4]; LAYER_ROWS] {
    rows.map(|row| row.map(|number| number as f32))
}

impl CanopyRows {
    /// The canopies of a body's populations, as far as they are known. `shown`: index of the population whose density
    /// is shown.
    pub(crate) fn new(body: &Body<'_>, shown: Option<usize>) -> Self {
        let scenery = &body.surface.scenery;
        let planting = |index: usize, population: &Population| {
            let map = scenery.planting.as_ref().and_then(|map| map.populations.get(index).copied());
            // Until its channel is there one that asks for water, ridges or hollows would be seen everywhere.
            map.or_else(|| (!population.asks_lie()).then_some((0, false)))
        };
        let shown = shown.and_then(|index| {
            let population = populations(body).get(index).filter(|population| population.enabled)?;
            let (channel, _) = planting(index, population)?;
            let mut rows = [[0.0; 4]; LAYER_ROWS];
            rows[SLOPES..SLOPES + 2].copy_from_slice(&rules(population));
            (rows[SHORE][2], rows[CHANNEL][3]) = (shore_m(population), f64::from(channel));
            Some(Shown { biomes: population.biomes.clone(), texels: texels(rows) })
        });
        let layers = layers(scenery, populations(body)).enumerate();
        let layers = layers.filter_map(|(index, (population, layer))| {
            Some((population, layer?, scenery.thinning(index), planting(index, population)?))
        });
        let layers = layers.map(|(population, layer, thinning, (channel, is_planted))| {
            let ([r, g, b], [side_r, side_g, side_b], cover) = (layer.color, layer.side_color, &layer.cover);
            let (fallen, littered) = layer.litter;
            let [ground, climate] = rules(population);
            let rows = [
                [r, g, b, layer.top],
                [layer.side, cover.sky[0], cover.sky[1], thinning.reach_m],
                ground,
                climate,
                [layer.width_m, population.clumping, shore_m(population), layer.casting],
                [cover.sun[0][0], cover.sun[0][1], layer.height_m, f64::from(Material::of(&population.form) as u32)],
                [cover.sun[1][0], cover.sun[1][1], cover.sun[2][0], cover.sun[2][1]],
                [fallen[0], fallen[1], fallen[2], littered],
                [layer.through[0], layer.through[1], layer.through[2], f64::from(channel)],
                [side_r, side_g, side_b, if thinning.full_m.is_finite() { thinning.full_m } else { 0.0 }],
            ];
            Layer {
                biomes: population.biomes.clone(),
                is_planted,
                height_m: layer.height_m,
                area: (layer.top + layer.side) * if population.asks_lie() { RARELY } else { 1.0 },
                texels: texels(rows),
            }
        });
        Self { layers: layers.collect(), shown }
    }

    /// Whether the rules of the shown population put it into a biome.
    pub(crate) fn shows_in(&self, key: char) -> bool {
        self.shown.as_ref().is_some_and(|shown| shown.biomes.is_empty() || shown.biomes.contains(key))
    }

    /// The rows of the shown population; None if there is none, it is off, or its place is not known yet.
    pub(crate) fn shown(&self) -> Option<&[[f32; 4]; LAYER_ROWS]> {
        self.shown.as_ref().map(|shown| &shown.texels)
    }

    /// The populations of a biome that count, the highest first: their number and their rows.
    pub(crate) fn of_biome(&self, key: char) -> (usize, [[f32; 4]; ROWS]) {
        let stands = |layer: &&Layer| layer.biomes.is_empty() || layer.biomes.contains(key);
        let by_area = |layers: &mut Vec<Layer>| {
            let more = |a: &Layer, b: &Layer| b.is_planted.cmp(&a.is_planted).then(b.area.total_cmp(&a.area));
            layers.sort_by(more);
        };
        let mut layers: Vec<Layer> = self.layers.iter().filter(stands).cloned().collect();
        by_area(&mut layers);
        let strangers = self.layers.iter().filter(|layer| !stands(layer) && layer.is_planted);
        let mut strangers: Vec<Layer> = strangers.map(Layer::where_planted).collect();
        by_area(&mut strangers);
        // One that strokes plant is worth more than the one that covers least.
        layers.truncate(if strangers.is_empty() { LAYERS } else { LAYERS - 1 });
        strangers.truncate(LAYERS - layers.len());
        layers.extend(strangers);
        layers.sort_by(|a, b| b.height_m.total_cmp(&a.height_m));
        let mut rows = [[0.0; 4]; ROWS];
        for (to, from) in rows.iter_mut().zip(layers.iter().flat_map(|layer| layer.texels)) {
            *to = from;
        }
        (layers.len(), rows)
    }
}

/// For each population, what it covers, if that is known and the population is on. `populations`: those of the
/// scenery's planet, or of a newer one with as many.
fn layers<'a>(
    scenery: &'a Scenery,
    populations: &'a [Population],
) -> impl Iterator<Item = (&'a Population, Option<CanopyLayer>)> {
    populations.iter().zip(&scenery.covers).map(|(population, cover)| {
        let known = cover.as_ref().filter(|_| population.enabled);
        (population, known.map(|cover| CanopyLayer::new(population, cover)))
    })
}

/// Area of neighbours that shade an object of a population, by the tangent of the sun's angle from the zenith
/// (`neighbours.wgsl`): crowns of one height shade one another from the side only, and the less the more they close.
fn shading(layer: &CanopyLayer) -> f64 {
    layer.casting * layer.side * (-0.5 * layer.top).exp()
}

/// Light that crowns around the eye let through to objects below, as shares of the sun's: the mean of those that are
/// there.
pub(super) fn through_leaves(scenery: &Scenery, populations: &[Population]) -> Vec3 {
    let mut is_there = vec![false; populations.len()];
    for cell in &scenery.cells {
        if let Some(is_there) = is_there.get_mut(usize::from(cell.population)) {
            *is_there = true;
        }
    }
    let there = layers(scenery, populations).zip(is_there).filter(|(_, is_there)| *is_there);
    let casting = there.filter_map(|((_, layer), _)| layer).map(|layer| (layer.top * layer.casting, layer.through));
    let (area, sum) = casting
        .fold((0.0, DVec3::ZERO), |(area, sum), (own, through)| (area + own, sum + own * DVec3::from_array(through)));
    if area > 0.0 { (sum / area).as_vec3() } else { Vec3::ZERO }
}

/// What an object of a population stands among.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Among {
    /// Area of neighbours that shade it, for each area of ground.
    pub(super) neighbours: f32,
    /// Mean width of an object, metres.
    pub(super) width_m: f64,
}

/// For each population, what its objects stand among.
pub(super) fn among(scenery: &Scenery, populations: &[Population]) -> Vec<Among> {
    let of_layer = |layer: CanopyLayer| Among { neighbours: shading(&layer) as f32, width_m: layer.width_m };
    layers(scenery, populations).map(|(_, layer)| layer.map_or_else(Among::default, of_layer)).collect()
}
