//! The pipeline that makes a height, for one point, a batch or a tile alike:
//!
//! layer fields -> layers joined -> ground edits -> climate -> biome relief
//!
//! [`Inputs`] tells where the noise comes from. Tiles keep fields from one edit to the next. Queries evaluate a field
//! when the pipeline asks for it, and only where the masks of its layer are not 0: most points need few layers.

use super::Terrain;
use super::climate::{ClimateInputs, MapClimate};
use super::edits::{self, Edits, Painted, Span, Surrounded};
use super::field::Field;
use super::height::{self, Batch, Heights, LayerFields};
use super::landform;
use super::lane::CHUNK;
use super::points::Points;
use super::relief::{self, ReliefFields, Shares};
use glam::DVec3;
use std::cell::RefCell;
use std::sync::Arc;

/// Where the noise of one batch of points comes from.
pub(crate) trait Inputs: LayerFields + relief::Inputs {}
impl<T: LayerFields + relief::Inputs> Inputs for T {}

/// Noise that is there already.
pub(crate) struct Kept<'a> {
    pub(crate) layers: &'a [Option<Arc<Field>>],
    pub(crate) relief: &'a ReliefFields,
    pub(crate) climate: ClimateInputs<'a>,
}

impl LayerFields for Kept<'_> {
    fn prepare(&mut self, _layer: usize, _mask: Option<&[f64]>) {}

    fn field(&self, layer: usize) -> Option<&Field> {
        self.layers.get(layer)?.as_deref()
    }
}

impl relief::Inputs for Kept<'_> {
    fn climate(&mut self) -> ClimateInputs<'_> {
        self.climate
    }

    fn prepare_relief(&mut self, _noise: usize) {}

    fn relief(&self, noise: usize) -> Option<&Field> {
        self.relief.get(noise).map(|(_, field)| &**field)
    }
}

/// Memory of the stages that join layers, used again for every batch.
#[derive(Default)]
pub(crate) struct JoinScratch {
    layers: height::Scratch,
    shares: Shares,
    edits: edits::Near,
}

impl Terrain {
    /// Heights at points, with one gradient for each spacing. `each(layer, heights_m)` is told the heights after each
    /// enabled layer.
    pub(crate) fn join(
        &self,
        points: &Points,
        spacings_rad: &[f64],
        inputs: &mut impl Inputs,
        scratch: &mut JoinScratch,
        heights: &mut Heights,
        each: impl FnMut(usize, &[f64]),
    ) {
        let batch = Batch { stack: &self.stack, simd: self.simd, points, spacings_rad };
        batch.join(inputs, &mut scratch.layers, heights, each);
        if let Some(edits) = &self.edits {
            self.apply_edits(edits, &points.dirs, spacings_rad, heights, &mut scratch.edits);
        }
        if let Some(relief) = &self.relief {
            let near = &mut scratch.edits;
            let is_painted = self.edits.as_ref().is_some_and(|edits| edits.may_paint(&points.dirs, near));
            relief.add(
                heights,
                (points, spacings_rad),
                inputs,
                &mut scratch.shares,
                is_painted,
                self.stack.riverside(),
            );
        }
    }

    /// Changes heights by all edits.
    fn apply_edits(
        &self,
        edits: &Edits,
        dirs: &[DVec3],
        spacings_rad: &[f64],
        heights: &mut Heights,
        near: &mut edits::Near,
    ) {
        let mut ground = |dirs: &[DVec3], begun_m: Option<&[f64]>, span: Span, surrounded: &Surrounded| {
            self.ground_after(edits, dirs, begun_m, (surrounded, span))
        };
        let surrounded = edits.surroundings(dirs, near, &self.memory, &mut ground);
        edits.apply(dirs, spacings_rad, heights, self.stack.limits_m(), near, (&surrounded, Span::default()));
    }

    /// Heights at directions after a span of edits. They begin with heights that are known, or with those of the
    /// layers.
    fn ground_after(
        &self,
        edits: &Edits,
        dirs: &[DVec3],
        begun_m: Option<&[f64]>,
        work: (&Surrounded, Span),
    ) -> Vec<f64> {
        thread_local! {
            static SCRATCH: RefCell<Box<BatchScratch>> = RefCell::default();
        }
        SCRATCH.with_borrow_mut(|scratch| {
            let BatchScratch { points, noise, join, heights } = &mut **scratch;
            let mut heights_m = Vec::with_capacity(dirs.len());
            for dirs in dirs.chunks(CHUNK) {
                match begun_m.and_then(|begun_m| begun_m.get(heights_m.len()..heights_m.len() + dirs.len())) {
                    Some(begun_m) => {
                        heights.height_m.clear();
                        heights.height_m.extend_from_slice(begun_m);
                    }
                    None => {
                        points.refill(dirs.iter().copied(), 0.0);
                        noise.restart(self);
                        let points = &*points;
                        let mut inputs = Evaluated { terrain: self, points, spacings_rad: &[], noise };
                        let batch = Batch { stack: &self.stack, simd: self.simd, points, spacings_rad: &[] };
                        batch.join(&mut inputs, &mut join.layers, heights, |_, _| {});
                    }
                }
                edits.apply(dirs, &[], heights, self.stack.limits_m(), &mut join.edits, work);
                heights_m.extend_from_slice(&heights.height_m);
            }
            heights_m
        })
    }

    /// As [`Terrain::join`], in memory that the thread keeps.
    pub(crate) fn joined(&self, points: &Points, spacings_rad: &[f64], inputs: &mut impl Inputs) -> Heights {
        thread_local! {
            static SCRATCH: RefCell<Box<JoinScratch>> = RefCell::default();
        }
        let mut heights = Heights::default();
        SCRATCH.with_borrow_mut(|scratch| self.join(points, spacings_rad, inputs, scratch, &mut heights, |_, _| {}));
        heights
    }

    /// Evaluates points of at most one chunk: the answers are in the scratch.
    pub(crate) fn evaluate(&self, spacings_rad: &[f64], scratch: &mut BatchScratch, each: impl FnMut(usize, &[f64])) {
        let BatchScratch { points, noise, join, heights } = scratch;
        noise.restart(self);
        let mut inputs = Evaluated { terrain: self, points, spacings_rad, noise };
        self.join(points, spacings_rad, &mut inputs, join, heights, each);
    }

    /// As [`Terrain::evaluate`] without gradients, with inputs that pass through `wrap`.
    pub(crate) fn evaluate_through<'a, T: Inputs>(
        &'a self,
        scratch: &'a mut BatchScratch,
        wrap: impl FnOnce(Evaluated<'a>) -> T,
        each: impl FnMut(usize, &[f64]),
    ) {
        let BatchScratch { points, noise, join, heights } = scratch;
        noise.restart(self);
        let points = &*points;
        let mut inputs = wrap(Evaluated { terrain: self, points, spacings_rad: &[], noise });
        self.join(points, &[], &mut inputs, join, heights, each);
    }
}

/// Memory for queries: points, their noise and their heights.
#[derive(Default)]
pub(crate) struct BatchScratch {
    pub(crate) points: Points,
    pub(crate) noise: NoiseScratch,
    join: JoinScratch,
    pub(crate) heights: Heights,
}

/// A field, and whether it belongs to the present batch.
#[derive(Default)]
struct Slot {
    field: Field,
    is_ready: bool,
}

impl Slot {
    /// Whether the field must be evaluated now.
    fn claim(&mut self) -> bool {
        !std::mem::replace(&mut self.is_ready, true)
    }
}

/// The noise of one batch, as far as it was asked for.
#[derive(Default)]
pub(crate) struct NoiseScratch {
    landform: Box<landform::Scratch>,
    layers: Vec<Slot>,
    relief: Vec<Slot>,
    climate: [Slot; 2],
    from_maps: Vec<MapClimate>,
    painted: Vec<Painted>,
    near: edits::Near,
    /// The points of a layer whose mask is 0 elsewhere, and its field there.
    some_points: Points,
    some: Field,
}

impl NoiseScratch {
    /// Forgets the noise of the last batch, but not its memory.
    fn restart(&mut self, terrain: &Terrain) {
        let reliefs = terrain.relief.as_ref().map_or(0, |relief| relief.noises().len());
        for (slots, count) in [(&mut self.layers, terrain.stack.layers.len()), (&mut self.relief, reliefs)] {
            if slots.len() < count {
                slots.resize_with(count, Slot::default);
            }
        }
        let all = self.layers.iter_mut().chain(&mut self.relief).chain(&mut self.climate);
        all.for_each(|slot| slot.is_ready = false);
    }

    /// The inputs of the climate at the points of the batch.
    pub(crate) fn climate(&mut self, terrain: &Terrain, points: &Points) -> ClimateInputs<'_> {
        let Self { landform, climate, from_maps, painted, near, .. } = self;
        if climate[0].claim() {
            for (k, slot) in climate.iter_mut().enumerate() {
                match terrain.climate.noises() {
                    Some(noises) => slot.field.refill(&noises[k], terrain.simd, points, &[], false, landform),
                    None => slot.field.value.clear(),
                }
            }
            from_maps.clear();
            from_maps.extend(terrain.climate.climates_of_maps(&points.dirs));
            match &terrain.edits {
                Some(edits) => edits.painted(&points.dirs, near, painted),
                None => painted.clear(),
            }
        }
        let [temperature, moisture] = &self.climate;
        ClimateInputs {
            noise: [&temperature.field.value, &moisture.field.value],
            from_maps: &self.from_maps,
            painted: &self.painted,
        }
    }
}

/// Noise that is evaluated when it is asked for.
pub(crate) struct Evaluated<'a> {
    terrain: &'a Terrain,
    points: &'a Points,
    spacings_rad: &'a [f64],
    noise: &'a mut NoiseScratch,
}

/// A field is evaluated at some points alone where that spares at least this share of them.
const SPARED: f64 = 0.2;

impl LayerFields for Evaluated<'_> {
    fn prepare(&mut self, layer: usize, mask: Option<&[f64]>) {
        let NoiseScratch { landform: scratch, layers, some_points, some, .. } = &mut *self.noise;
        let (Some(slot), Some(compiled)) = (layers.get_mut(layer), self.terrain.stack.layers.get(layer)) else {
            return;
        };
        if !slot.claim() {
            return;
        }
        let (simd, spacings_rad) = (self.terrain.simd, compiled.spacings_rad(self.spacings_rad));
        let landform = &*compiled.landform;
        let n = self.points.len();
        // Masks of other layers read the field wherever they are.
        if let Some(mask) = mask.filter(|_| !compiled.masks_others) {
            let is_wanted = |i: usize| mask[i] != 0.0;
            let wanted = (0..n).filter(|&i| is_wanted(i)).count();
            if (wanted as f64) < (1.0 - SPARED) * n as f64 {
                some_points.refill_from(self.points, is_wanted);
                some.refill(landform, simd, some_points, &spacings_rad, false, scratch);
                slot.field.scatter(some, n, is_wanted);
                return;
            }
        }
        slot.field.refill(landform, simd, self.points, &spacings_rad, false, scratch);
    }

    fn field(&self, layer: usize) -> Option<&Field> {
        self.noise.layers.get(layer).filter(|slot| slot.is_ready).map(|slot| &slot.field)
    }
}

impl relief::Inputs for Evaluated<'_> {
    fn climate(&mut self) -> ClimateInputs<'_> {
        self.noise.climate(self.terrain, self.points)
    }

    fn prepare_relief(&mut self, noise: usize) {
        let NoiseScratch { landform: scratch, relief, .. } = &mut *self.noise;
        let landform = self.terrain.relief.as_ref().and_then(|relief| relief.noises().get(noise));
        if let (Some(slot), Some(landform)) = (relief.get_mut(noise), landform)
            && slot.claim()
        {
            slot.field.refill(landform, self.terrain.simd, self.points, self.spacings_rad, false, scratch);
        }
    }

    fn relief(&self, noise: usize) -> Option<&Field> {
        self.noise.relief.get(noise).filter(|slot| slot.is_ready).map(|slot| &slot.field)
    }
}
