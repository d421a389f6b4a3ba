//! Biome relief: hummocks, hollows and ripples that biomes add to the height that the layers make.
//!
//! The biome table is blended linearly at the climate of the ground below, so that no biome border makes a cliff.
//! Gradients follow the blend by the height of that ground exactly. They leave out its dependence on latitude,
//! climate noise and the coast distance: two cells of the table lie hundreds of kilometres apart, so that this is
//! less than a millionth of the relief's height per metre. They leave out the fade of painted climate, too.
//!
//! Border jitter does not move the blend. Its noise is a texture with creases between texels: heights made with it
//! would have creases in their normals, and cliffs where its finest octaves cross a cell of the table. So the relief
//! of a biome begins gradually, up to half a cell before or after the border that is drawn.

use super::climate::{ClimateInputs, CompiledClimate, MapClimate, Rules};
use super::edits::Painted;
use super::field::Field;
use super::height::{Heights, LayerFields};
use super::landform::Landform;
use super::noise;
use super::points::Points;
use crate::planet::Planet;
use crate::world::noise::mix;
use glam::DVec3;
use std::sync::Arc;

/// Octaves of each noise.
const OCTAVES: u32 = 4;
/// Keeps the seeds apart from those of layers, whose upper half is the planet's seed, and of the climate.
const SEED: u64 = 0x5EED_0000_0000_0003;

/// Bound of the climate noise. Its weights sum to 1 up to rounding.
const MOST_NOISE: f64 = noise::BOUND * (1.0 + 1e-5);

/// Where the noise for biome relief comes from: kept, or evaluated on demand.
pub(crate) trait Inputs: LayerFields {
    /// The inputs of the climate at the points.
    fn climate(&mut self) -> ClimateInputs<'_>;

    /// Makes sure that the field of one of [`Relief::noises`] is available.
    fn prepare_relief(&mut self, noise: usize);

    /// A field that was prepared.
    fn relief(&self, noise: usize) -> Option<&Field>;
}

/// The biome relief of a planet. Equal ones add equal heights to equal ground.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Relief {
    /// One noise for each feature size.
    noises: Vec<Arc<Landform>>,
    columns: usize,
    rows: usize,
    /// For each cell of the table, row by row, the index of its noise and the height of its relief.
    cells: Vec<(usize, f64)>,
    /// First and last column, first and last row of the cells with relief.
    extent: [(usize, usize); 2],
    rules: Rules,
    climate_noises: Option<[Landform; 2]>,
    has_coast: bool,
    limits_m: (f64, f64),
}

/// The noise fields that a tile keeps, each with its landform as the key.
pub(crate) type ReliefFields = Vec<(Arc<Landform>, Arc<Field>)>;

impl Relief {
    /// `None` if no biome of the table has relief.
    pub(crate) fn new(planet: &Planet, climate: &CompiledClimate, limits_m: (f64, f64)) -> Option<Self> {
        let reliefs = planet.biomes.reliefs()?;
        let (mut sizes, mut cells): (Vec<f64>, _) = (Vec::new(), Vec::new());
        for (height_m, size_m) in &reliefs.cells {
            if *height_m > 0.0 && !sizes.contains(size_m) {
                sizes.push(*size_m);
            }
            cells.push((sizes.iter().position(|known| known == size_m).unwrap_or(0), *height_m));
        }
        let mut extent = [(usize::MAX, 0); 2];
        for (index, _) in cells.iter().enumerate().filter(|(_, (_, height_m))| *height_m > 0.0) {
            for ((least, most), at) in extent.iter_mut().zip([index % reliefs.columns, index / reliefs.columns]) {
                (*least, *most) = (at.min(*least), at.max(*most));
            }
        }
        let noise = |size_m: &f64| {
            // The seed depends on the size alone: relief of other biomes stays as it is when one is added.
            let seed = mix(u64::from(planet.seed) ^ SEED) ^ size_m.to_bits();
            Arc::new(Landform::fbm(seed, planet.radius_m() / size_m, OCTAVES))
        };
        Some(Self {
            noises: sizes.iter().map(noise).collect(),
            columns: reliefs.columns,
            rows: reliefs.rows,
            cells,
            extent,
            rules: Rules::new(planet),
            climate_noises: climate.noises().cloned(),
            has_coast: CompiledClimate::reads_coast(planet),
            limits_m,
        })
    }

    /// Octaves of noise at one point.
    pub(crate) fn octave_count(&self) -> usize {
        self.noises.iter().map(|noise| noise.octave_count()).sum()
    }

    /// The noises.
    pub(crate) fn noises(&self) -> &[Arc<Landform>] {
        &self.noises
    }

    /// Least and greatest height that it adds. Conservative.
    pub(crate) fn bounds_m(&self) -> (f64, f64) {
        let most_m = self.cells.iter().map(|(_, height_m)| *height_m).fold(0.0, f64::max);
        let (lo, hi) = self
            .noises
            .iter()
            .map(|noise| noise.bounds())
            .fold((0.0, 0.0), |(lo, hi): (f64, f64), bounds| (lo.min(bounds.0), hi.max(bounds.1)));
        (lo * most_m * (1.0 + 1e-6), hi * most_m * (1.0 + 1e-6))
    }

    /// Adds biome relief to heights that the layers made, and to their gradients. `is_painted`: whether the climate
    /// may be painted at one of the points. `riverside`: the place of the field from which the relief stands aside for
    /// rivers.
    pub(crate) fn add(
        &self,
        heights: &mut Heights,
        (points, spacings_rad): (&Points, &[f64]),
        inputs: &mut impl Inputs,
        shares: &mut Shares,
        is_painted: bool,
        riverside: Option<usize>,
    ) {
        let can_reach = |(dir, height_m): (&DVec3, &f64)| self.can_reach(dir.z, *height_m);
        if !is_painted && !points.dirs.iter().zip(&heights.height_m).any(can_reach) {
            return;
        }
        let climate = inputs.climate();
        shares.0.clear();
        shares.0.extend(points.dirs.iter().zip(&heights.height_m).enumerate().map(|(i, (dir, height_m))| {
            let (noise, from_maps, painted) = climate.at(i);
            self.shares(dir.z, *height_m, noise, from_maps, &painted)
        }));
        for noise in 0..self.noises.len() {
            if shares.0.iter().flatten().any(|share| share.noise == noise && share.height_m != 0.0) {
                inputs.prepare_relief(noise);
            }
        }
        if let Some(riverside) = riverside {
            inputs.prepare(riverside, None);
        }
        let inputs = &*inputs;
        let beside = riverside.and_then(|riverside| inputs.field(riverside));
        for (i, shares) in shares.0.iter().enumerate().filter(|(_, shares)| shares.iter().any(|s| s.height_m != 0.0)) {
            let (mut relief_m, mut per_metre) = (0.0, 0.0);
            for share in shares.iter().filter(|share| share.height_m != 0.0) {
                let value = inputs.relief(share.noise).map_or(0.0, |field| field.value[i]);
                relief_m += share.height_m * value;
                per_metre += share.height_by_height * value;
            }
            let t = beside.map_or(1.0, |beside| beside.value[i]);
            let (whole, by_beside) = (t * t * (3.0 - 2.0 * t), (6.0 * t * (1.0 - t) * relief_m) as f32);
            let raised_m = heights.height_m[i] + relief_m * whole;
            heights.height_m[i] = raised_m.clamp(self.limits_m.0, self.limits_m.1);
            let by_ground = (1.0 + per_metre * whole) as f32;
            for (ground, &spacing_rad) in heights.gradients.iter_mut().zip(spacings_rad) {
                let own = shares.map(|share| {
                    let field = inputs.relief(share.noise).filter(|_| share.height_m != 0.0);
                    ((share.height_m * whole) as f32, field.and_then(|field| field.gradient(spacing_rad)))
                });
                let aside = beside.and_then(|beside| beside.gradient(spacing_rad));
                for (axis, component) in ground.iter_mut().enumerate() {
                    let slope = own.iter().filter_map(|(height_m, noise)| Some(height_m * noise.as_ref()?[axis][i]));
                    component[i] = component[i] * by_ground + slope.sum::<f32>();
                    component[i] += aside.map_or(0.0, |aside| by_beside * aside[axis][i]);
                }
            }
        }
    }

    /// Whether a cell with relief is within reach of the climate of a point, for any noise. Where none is, the
    /// climate noise need not be evaluated.
    fn can_reach(&self, sin_lat: f64, height_m: f64) -> bool {
        let [moisture, row] = self.rules.ranges(sin_lat, height_m, MOST_NOISE);
        let along = |low: f64, high: f64, cells: usize| {
            let cell = |at: f64| (at * cells as f64 - 0.5).floor();
            let last = cells.saturating_sub(1);
            (cell(low).max(0.0) as usize, ((cell(high) + 1.0).max(0.0) as usize).min(last))
        };
        let (left, right) = along(moisture.0, moisture.1, self.columns);
        let (top, bottom) = along(1.0 - row.1, 1.0 - row.0, self.rows);
        let [(least_left, most_right), (least_top, most_bottom)] = self.extent;
        left <= most_right && right >= least_left && top <= most_bottom && bottom >= least_top
    }

    /// The four cells around the climate of the ground, with bilinear weights.
    fn shares(
        &self,
        sin_lat: f64,
        height_m: f64,
        noise: [f64; 2],
        from_maps: MapClimate,
        painted: &Painted,
    ) -> [Share; 4] {
        let climate = self.rules.at(sin_lat, height_m, noise, from_maps, painted);
        let [by_moisture, by_row] = self.rules.by_height(height_m, &climate, painted);
        let (x, y) = (climate.moisture * self.columns as f64 - 0.5, (1.0 - climate.row) * self.rows as f64 - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let (u, v) = (x - column, y - row);
        // Cells that the climate moves with each metre of height.
        let (du, dv) = (by_moisture * self.columns as f64, -by_row * self.rows as f64);
        let cell = |dx: i64, dy: i64| {
            let at = |w: f64, d: i64, count: usize| (w as i64 + d).clamp(0, count as i64 - 1) as usize;
            self.cells[at(row, dy, self.rows) * self.columns + at(column, dx, self.columns)]
        };
        [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| {
            let (noise, height_m) = cell(dx, dy);
            let (wu, su) = if dx == 1 { (u, du) } else { (1.0 - u, -du) };
            let (wv, sv) = if dy == 1 { (v, dv) } else { (1.0 - v, -dv) };
            Share { noise, height_m: height_m * wu * wv, height_by_height: height_m * (su * wv + wu * sv) }
        })
    }
}

/// The relief that one cell of the biome table adds at a point.
#[derive(Clone, Copy, Debug)]
struct Share {
    noise: usize,
    /// Height of the relief, weighted by the blend.
    height_m: f64,
    /// Its derivative by the height of the ground below.
    height_by_height: f64,
}

/// The shares of a batch of points, in memory that is reused.
#[derive(Debug, Default)]
pub(crate) struct Shares(Vec<[Share; 4]>);
