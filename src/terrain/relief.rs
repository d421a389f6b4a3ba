//! The relief that biomes have of their own: hummocks, hollows, ripples, added to the height that the layers make.
//!
//! A biome counts as far as the table's linear blend has it at the climate of the ground below, so nothing stands at a border. The
//! blend follows the height of that ground exactly. How it follows latitude, climate noise and the distance from the sea is left out
//! of gradients: over the hundreds of kilometres between two cells of the table, that is less than a millionth of a relief's height
//! for each metre.
//!
//! The noise that moves borders to and fro (`border`) does not move the blend: it is a tile with creases from texel to texel, and heights
//! made with it would have creases in their normals, and cliffs where its finest octaves cross a step of the table. So the relief of a
//! biome begins gently up to half a cell before or after the border that one sees.
//!
//! The arithmetic is the same whatever the instruction set; the noise is the layers' own.

use super::climate::{ClimateField, CompiledClimate, NO_SEA, Rules};
use super::field::{Components, Field};
use super::height::Heights;
use super::landform::Landform;
use super::points::Points;
use super::simd::Simd;
use crate::planet::Planet;
use std::sync::Arc;

/// Octaves of each relief.
const OCTAVES: u32 = 4;
/// Apart from the seeds of layers, whose upper half is the planet's seed, and of the climate.
const SEED: u64 = 0x5EED_0000_0000_0003;

/// The reliefs of a planet's biomes; equal ones make equal heights of equal ground.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Relief {
    /// One noise for each size.
    noises: Vec<Arc<Landform>>,
    columns: usize,
    rows: usize,
    /// For each cell of the table, row by row: which noise, and how high.
    cells: Vec<(usize, f64)>,
    rules: Rules,
    climate_noises: Option<[Landform; 2]>,
    has_coast: bool,
    limits_m: (f64, f64),
}

/// What a tile keeps of the noises: each with the landform that it is of.
pub(crate) type ReliefFields = Vec<(Arc<Landform>, Arc<Field>)>;

impl Relief {
    /// None where no biome of the table has a relief.
    pub(crate) fn new(planet: &Planet, climate: &CompiledClimate, limits_m: (f64, f64)) -> Option<Self> {
        let reliefs = planet.biomes.reliefs()?;
        let (mut sizes, mut cells): (Vec<f64>, _) = (Vec::new(), Vec::new());
        for (height_m, size_m) in &reliefs.cells {
            let known = sizes.iter().position(|known| known == size_m || *height_m <= 0.0);
            cells.push((known.unwrap_or(sizes.len()), *height_m));
            if known.is_none() {
                sizes.push(*size_m);
            }
        }
        let noise = |size_m: &f64| {
            // Of the size alone: another biome's relief, or a new one, leaves this one as it is.
            let seed = super::noise::mix(u64::from(planet.seed) ^ SEED) ^ size_m.to_bits();
            Arc::new(Landform::fbm(seed, planet.radius_m() / size_m, OCTAVES))
        };
        Some(Self {
            noises: sizes.iter().map(noise).collect(),
            columns: reliefs.columns,
            rows: reliefs.rows,
            cells,
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

    /// Least and most that it adds. Conservative.
    pub(crate) fn bounds_m(&self) -> (f64, f64) {
        let most_m = self.cells.iter().map(|(_, height_m)| *height_m).fold(0.0, f64::max);
        let (lo, hi) = self
            .noises
            .iter()
            .map(|noise| noise.bounds())
            .fold((0.0, 0.0), |(lo, hi): (f64, f64), bounds| (lo.min(bounds.0), hi.max(bounds.1)));
        (lo * most_m * (1.0 + 1e-6), hi * most_m * (1.0 + 1e-6))
    }

    /// Adds it to heights that the layers made, and to their gradients. `fields` are those of [`Relief::noises`].
    pub(crate) fn add(
        &self,
        heights: &mut Heights,
        spacings_rad: &[f64],
        points: &Points,
        fields: &[Arc<Field>],
        climate: &ClimateField,
        inland_rad: &[f64],
    ) {
        let gradients: Vec<Vec<&Components>> = spacings_rad
            .iter()
            .map(|spacing_rad| fields.iter().filter_map(|field| field.gradient(*spacing_rad)).collect())
            .collect();
        for (i, dir) in points.dirs.iter().enumerate() {
            let noise = [climate.temperature[i], climate.moisture[i]];
            let inland_rad = inland_rad.get(i).copied().unwrap_or(NO_SEA);
            let shares = self.shares(dir.z, heights.height_m[i], noise, inland_rad);
            let (mut relief_m, mut per_metre) = (0.0, 0.0);
            for share in &shares {
                let value = fields[share.noise].value[i];
                relief_m += share.height_m * value;
                per_metre += share.height_by_height * value;
            }
            let raised_m = heights.height_m[i] + relief_m;
            heights.height_m[i] = raised_m.clamp(self.limits_m.0, self.limits_m.1);
            let by_ground = (1.0 + per_metre) as f32;
            for (ground, noises) in heights.gradients.iter_mut().zip(&gradients) {
                if noises.len() < fields.len() {
                    continue;
                }
                for (axis, component) in ground.iter_mut().enumerate() {
                    let own = shares.iter().map(|share| share.height_m as f32 * noises[share.noise][axis][i]);
                    component[i] = component[i] * by_ground + own.sum::<f32>();
                }
            }
        }
    }

    /// The four cells around the climate of the ground.
    fn shares(&self, sin_lat: f64, height_m: f64, noise: [f64; 2], inland_rad: f64) -> [Share; 4] {
        let climate = self.rules.at(sin_lat, height_m, noise, inland_rad);
        let [by_moisture, by_row] = self.rules.by_height(height_m, &climate);
        let (x, y) = (climate.moisture * self.columns as f64 - 0.5, (1.0 - climate.row) * self.rows as f64 - 0.5);
        let (column, row) = (x.floor(), y.floor());
        let (u, v) = (x - column, y - row);
        // How far across its cell the climate moves with each metre of height.
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

/// What a cell of the table adds.
#[derive(Clone, Copy, Debug)]
struct Share {
    noise: usize,
    height_m: f64,
    /// The same, by the height of the ground below.
    height_by_height: f64,
}

/// The fields of a relief's noises.
pub(crate) fn fields(relief: &Relief, simd: Simd, points: &Points, spacings_rad: &[f64]) -> Vec<Arc<Field>> {
    relief.noises.iter().map(|noise| Arc::new(Field::new(noise, simd, points, spacings_rad))).collect()
}
