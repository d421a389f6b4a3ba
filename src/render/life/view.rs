//! The objects that a view draws: culled, thinned out by distance, each at the level of detail that its size in the
//! picture needs.

use super::canopy::Among;
use super::material::Material;
use super::{CASCADES, Cascades, LifeModels, canopy};
use crate::life::Model;
use crate::life::form::LEVELS;
use crate::life::scenery::{SceneryCell, SceneryObject};
use crate::life::thinning::Thinning;
use crate::lod::horizon::HorizonTile;
use crate::lod::tile::slope_axis;
use crate::lod::{Culling, Quality, View};
use crate::planet::{Form, Key, Population};
use crate::render::body_tiles::BodyTiles;
use crate::render::horizon_pool;
use crate::render::layer_pool::LayerPlace;
use crate::render::scene::{Body, height_range_m};
use crate::sphere::NodeId;
use glam::DVec3;
use std::collections::HashMap;
use std::ops::Range;

/// An object, as `life_instance.wgsl` describes it.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Instance {
    foot_rel_m: [f32; 3],
    size_m: f32,
    turn: [i16; 4],
    colors: [u8; 8],
    place: [u16; 2],
    layer: u16,
    axis: u16,
    neighbours: u16,
    wider: u8,
    rise: i8,
    material: u8,
    sunk: u8,
    width_cm: u16,
}

/// Instances of one mesh.
pub(super) struct Draw {
    pub(super) model: Key,
    pub(super) variant: usize,
    pub(super) level: usize,
    pub(super) instances: Range<u32>,
}

/// Instances lit over one array of horizon tiles.
pub(super) struct Lit {
    pub(super) array: usize,
    pub(super) instances: Range<u32>,
}

/// The objects of a body in one view.
#[derive(Default)]
pub(crate) struct LifeView {
    pub(super) instances: Vec<Instance>,
    pub(super) draws: Vec<Draw>,
    pub(super) lit: Vec<Lit>,
    /// Objects that cast shadows, and for each cascade what is drawn of them.
    pub(super) casting: Vec<Instance>,
    pub(super) casts: [Vec<Draw>; CASCADES],
    pub(super) buffers: Option<super::pass::Buffers>,
}

/// Variants of a form.
const VARIANTS: usize = Form::VARIANTS as usize;
/// Steps of the codes of an instance: of the areas of neighbours from 0 on, of the octaves of a widening, and of a rise
/// of the ground.
const NEIGHBOURS_STEP: f32 = 1.0 / 4096.0;
const WIDER_STEP: f64 = 1.0 / 64.0;
const RISE_STEP: f64 = 1.0 / 64.0;
/// Finest level of detail that the width of an object alone asks for.
const WIDE_LEVEL: usize = LEVELS - 2;
/// Layer of an object without a horizon tile.
const NO_LAYER: u16 = u16::MAX;

/// Heights in pixels from which levels 0, 1 and 2 of a model are drawn: light meshes are drawn farther away.
fn level_px(quality: Quality, model: Option<&Model>) -> [f64; LEVELS - 1] {
    // The last number is the least height for each square root of the triangles.
    let ([first, second, third], by_triangles) = match quality {
        Quality::Low => ([360.0, 110.0, 24.0], 4.5),
        Quality::Medium => ([220.0, 55.0, 13.0], 2.4),
        Quality::High => ([160.0, 42.0, 11.0], 1.6),
    };
    let meshes = model.and_then(|model| model.variants.first());
    let least = |level: usize, most_px: f64| {
        let triangles = meshes.map_or(f64::INFINITY, |meshes| meshes[level].triangles.len() as f64);
        most_px.min(by_triangles * triangles.sqrt())
    };
    // Long things are seen by their length, too.
    let shorter = 1.0 / model.map_or(1.0, |model| model.seen_size);
    [least(0, first), least(1, second), least(2, third)].map(|px| px * shorter)
}

/// The place of objects on a horizon tile.
struct Shade {
    at: LayerPlace,
    /// Width of the cell as a share of the tile, and its corner there.
    within: [f64; 3],
}

impl LifeView {
    /// Chooses the objects that `view` sees, and uploads what they need.
    pub(crate) fn prepare(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        models: &mut LifeModels,
        tiles: &mut BodyTiles,
        body: &Body<'_>,
        view: &View,
        cascades: Option<&Cascades>,
    ) {
        self.clear();
        let scenery = &body.surface.scenery;
        if scenery.cells.is_empty() {
            return;
        }
        models.upload(device, scenery.models.iter().flatten().map(|model| &**model));
        let chosen = body.frozen.as_ref().unwrap_or(view);
        let lowest_m = body.surface.terrain.planet().radius_m() + height_range_m(body.surface).0;
        let culling = Culling::new(chosen, lowest_m.max(0.0));
        let (horizons, populations) = (Horizons::new(body), populations(body));
        let among = canopy::among(scenery, populations);
        let drawn = Drawn::new(view, cascades);
        let levels_px: Vec<_> = scenery.models.iter().map(|model| level_px(view.quality, model.as_deref())).collect();
        let made = &body.surface.terrain.planet().life;
        // Shadows hide what a level of detail lacks.
        let coarser = usize::from(view.quality == Quality::Low);
        let mut seen = Bins::new(scenery.models.len());
        let mut casting: [Bins; CASCADES] = std::array::from_fn(|_| Bins::new(scenery.models.len()));
        for cell in &scenery.cells {
            let index = usize::from(cell.population);
            let known = populations.get(index).zip(levels_px.get(index));
            let (Some((population, level_px)), Some(Some(model))) = (known, scenery.models.get(index)) else {
                continue;
            };
            let thinning = scenery.thinning(index);
            // The wind moves the tips aside.
            let narrow = model.reach + population.sway;
            let reach = narrow * thinning.widest();
            let is_seen = culling.sees_sphere(cell.center_planet_m, cell.radius_m(reach));
            let casts = cascades.is_some_and(|cascades| cascades.reaches(cell, reach, drawn.eye_m));
            if !(is_seen || casts) {
                continue;
            }
            let shade = horizons.of(cell).filter(|_| is_seen).and_then(|tile| {
                let at = tiles.horizons.place(device, queue, tile.serial, || horizon_pool::texels(tile))?;
                Some(Shade { at, within: within(cell.id, tile.id) })
            });
            let array = shade.as_ref().map_or(0, |shade| shade.at.array);
            let among = among.get(index).copied().unwrap_or_default();
            let seed = made.get(index).map_or(population.seed, |made| made.seed);
            let hidden = body.hidden.map(|hidden| hidden.of_seed(seed)).unwrap_or_default();
            let look = Look { population, shade, axis: axis_code(cell.id), among, thins: thinning.full_m.is_finite() };
            for object in cell.objects.iter().filter(|object| !hidden.holds(object.id)) {
                let Some(shown) = drawn.shown(object, thinning, level_px) else { continue };
                let is_seen = is_seen && culling.sees_sphere(object.foot_planet_m, narrow * shown.wider * shown.size_m);
                let casts_into = |cascade: &usize| casts && drawn.casts(*cascade, &shown);
                if !is_seen && !(0..CASCADES).any(|cascade| casts_into(&cascade)) {
                    continue;
                }
                let instance = look.instance(object, &shown);
                let variant = usize::from(object.variant);
                if is_seen {
                    seen.add(array, (index, variant, shown.level), instance);
                }
                for cascade in (0..CASCADES).filter(casts_into) {
                    let level = (shown.level + cascade + coarser).min(LEVELS - 1);
                    casting[cascade].add(0, (index, variant, level), instance);
                }
            }
        }
        let models: Vec<Option<Key>> =
            scenery.models.iter().map(|model| model.as_ref().map(|model| model.key)).collect();
        self.lit = seen.drain_into(&models, &mut self.instances, &mut self.draws);
        for (draws, bins) in self.casts.iter_mut().zip(casting) {
            bins.drain_into(&models, &mut self.casting, draws);
        }
        super::pass::Buffers::write(&mut self.buffers, device, queue, [&self.instances, &self.casting]);
    }

    /// Forgets the objects: the view shows none.
    pub(crate) fn clear(&mut self) {
        self.instances.clear();
        self.draws.clear();
        self.lit.clear();
        self.casting.clear();
        self.casts.iter_mut().for_each(Vec::clear);
    }

    /// Objects that are drawn.
    pub(crate) fn count(&self) -> usize {
        self.instances.len()
    }

    /// Memory of the buffers.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.buffers.as_ref().map_or(0, super::pass::Buffers::resident_bytes)
    }
}

/// The populations of a body: those of the newest planet, whose colours count, if it has as many as the surface.
pub(super) fn populations<'a>(body: &'a Body<'_>) -> &'a [Population] {
    let (newest, made) = (&body.planet().life, &body.surface.terrain.planet().life);
    if newest.len() == made.len() { newest } else { made }
}

/// How objects are drawn in a view.
struct Drawn<'a> {
    eye_m: DVec3,
    pixel_rad: f64,
    cascades: Option<&'a Cascades>,
}

/// An object as a view shows it.
struct Shown {
    rel_m: DVec3,
    size_m: f64,
    /// Factor on its width.
    wider: f64,
    level: usize,
}

impl<'a> Drawn<'a> {
    fn new(view: &View, cascades: Option<&'a Cascades>) -> Self {
        let (eye_m, pixel_rad) = (view.camera.position_planet_m, view.pixel_rad());
        Self { eye_m, pixel_rad, cascades }
    }

    /// How an object is shown; None where it has thinned out. `level_px`: those of its model.
    fn shown(&self, object: &SceneryObject, thinning: Thinning, level_px: &[f64; LEVELS - 1]) -> Option<Shown> {
        let rel_m = object.foot_planet_m - self.eye_m;
        let away_m = rel_m.length();
        let grown = thinning.grown(object.rank.into(), away_m);
        if grown <= 0.0 {
            return None;
        }
        let size_m = f64::from(object.size_m) * grown;
        let pixel_m = away_m.max(0.1) * self.pixel_rad;
        let pixels = size_m / pixel_m;
        let sine = (rel_m.dot(object.foot_planet_m) / (away_m * object.foot_planet_m.length()).max(0.1)).abs();
        let wider = thinning.widening(away_m, f64::from(object.size_m) / pixel_m, sine);
        let level_of = |pixels: f64| level_px.iter().position(|least| pixels > *least).unwrap_or(LEVELS - 1);
        // Wide blades of a coarse level would be seen as such.
        let level = level_of(pixels).min(level_of(pixels * wider).max(WIDE_LEVEL));
        Some(Shown { rel_m, size_m, wider, level })
    }

    /// Whether an object casts a shadow into a cascade.
    fn casts(&self, cascade: usize, shown: &Shown) -> bool {
        self.cascades.is_some_and(|cascades| cascades.takes(cascade, shown.rel_m, shown.size_m))
    }
}

/// Instances by array of horizon tiles, population, variant and level.
struct Bins {
    populations: usize,
    bins: Vec<Vec<Instance>>,
}

impl Bins {
    fn new(populations: usize) -> Self {
        Self { populations, bins: Vec::new() }
    }

    fn add(&mut self, array: usize, (population, variant, level): (usize, usize, usize), instance: Instance) {
        let bin = ((array * self.populations + population) * VARIANTS + variant.min(VARIANTS - 1)) * LEVELS + level;
        if self.bins.len() <= bin {
            self.bins.resize_with(bin + 1, Vec::new);
        }
        self.bins[bin].push(instance);
    }

    /// Puts all instances one after the other. Gives those of each array of horizon tiles.
    fn drain_into(self, models: &[Option<Key>], instances: &mut Vec<Instance>, draws: &mut Vec<Draw>) -> Vec<Lit> {
        let mut lit: Vec<Lit> = Vec::new();
        for (bin, members) in self.bins.into_iter().enumerate().filter(|(_, members)| !members.is_empty()) {
            let (level, mesh) = (bin % LEVELS, bin / LEVELS);
            let (variant, population) = (mesh % VARIANTS, mesh / VARIANTS);
            let array = population / self.populations;
            let Some(model) = models.get(population % self.populations).copied().flatten() else { continue };
            let first = instances.len() as u32;
            instances.extend(members);
            let span = first..instances.len() as u32;
            match lit.last_mut() {
                Some(last) if last.array == array => last.instances.end = span.end,
                _ => lit.push(Lit { array, instances: span.clone() }),
            }
            draws.push(Draw { model, variant, level, instances: span });
        }
        lit
    }
}

/// What the objects of a cell look like.
struct Look<'a> {
    population: &'a Population,
    shade: Option<Shade>,
    axis: u16,
    among: Among,
    /// Whether only objects of low rank may be there.
    thins: bool,
}

impl Look<'_> {
    fn instance(&self, object: &SceneryObject, shown: &Shown) -> Instance {
        let root = |color: [f64; 3]| {
            color.map(|part| {
                let bright = part * f64::from(object.brightness);
                (bright.clamp(0.0, 1.0).sqrt() * 255.0).round() as u8
            })
        };
        let population = self.population;
        let [first, second] = population.colors().map(root);
        let sway = (population.sway.clamp(0.0, 0.5) * 510.0).round() as u8;
        // Any number that differs from object to object: ranks do not where only the lowest are there.
        let phase = if self.thins { (object.id >> 32) as u8 } else { (object.rank * 255.0) as u8 };
        let signed = |part: f32| (part.clamp(-1.0, 1.0) * 32767.0).round() as i16;
        let at =
            |part: f32, corner: f64, width: f64| ((corner + f64::from(part) * width).clamp(0.0, 1.0) * 65535.0) as u16;
        let place = self.shade.as_ref().map_or([0; 2], |shade| {
            let [width, x, y] = shade.within;
            [at(object.place[0], x, width), at(object.place[1], y, width)]
        });
        Instance {
            foot_rel_m: shown.rel_m.as_vec3().to_array(),
            size_m: shown.size_m as f32,
            turn: object.planet_from_form.to_array().map(signed),
            colors: [first[0], first[1], first[2], sway, second[0], second[1], second[2], phase],
            place,
            layer: self.shade.as_ref().map_or(NO_LAYER, |shade| shade.at.layer as u16),
            axis: self.axis,
            neighbours: (self.among.neighbours / NEIGHBOURS_STEP).round() as u16,
            wider: (shown.wider.max(1.0).log2() / WIDER_STEP).round() as u8,
            rise: (object.rise_aside(shown.rel_m) / RISE_STEP).round() as i8,
            material: Material::of(&population.form) as u8,
            sunk: (population.sunk.clamp(0.0, 1.0) * 255.0).round() as u8,
            width_cm: (self.among.width_m * 100.0).min(65535.0) as u16,
        }
    }
}

/// The code of the first tangent axis of the face of a node: see `life_light.wgsl`.
fn axis_code(id: NodeId) -> u16 {
    let axis = slope_axis(id.face).to_array();
    let index = axis.iter().position(|part| *part != 0.0).unwrap_or(0);
    index as u16 + if axis[index] < 0.0 { 3 } else { 0 }
}

/// Width of a cell as a share of a node, and its corner there; either may lie within the other.
fn within(cell: NodeId, node: NodeId) -> [f64; 3] {
    if cell.level >= node.level {
        return cell.within(node);
    }
    let [width, x, y] = node.within(cell);
    [1.0 / width, -x / width, -y / width]
}

/// The horizon tiles of a surface, by node.
struct Horizons<'a>(HashMap<NodeId, &'a HorizonTile>);

impl<'a> Horizons<'a> {
    fn new(body: &Body<'a>) -> Self {
        let surface = body.surface;
        let tiles = surface.leaves.iter().filter_map(|leaf| leaf.horizon.as_deref());
        Self(tiles.map(|tile| (tile.id, tile)).collect())
    }

    /// The tile over the middle of a cell.
    fn of(&self, cell: &SceneryCell) -> Option<&'a HorizonTile> {
        let mut node = Some(NodeId::containing(cell.id.direction(0.5, 0.5), NodeId::MAX_LEVEL));
        while let Some(id) = node {
            if let Some(tile) = self.0.get(&id) {
                return Some(tile);
            }
            node = id.parent();
        }
        None
    }
}
