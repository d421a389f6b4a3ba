//! Plates of the crust: heights before erosion, uplift, kinds of rock.
//!
//! The model is kinematic and instant: plates have a place and a motion, and their boundaries have the landforms that
//! such a motion makes in the long run. Nothing is simulated step by step, so that every parameter has its effect at
//! once. Methods and figures: plates as a power diagram with bent boundaries and Euler poles; ocean floors that sink
//! with the square root of their age (Parsons and Sclater 1977); belts, arcs and trenches after Cortial et al. 2019.
//!
//! - `layout`: plates, their motion, cores of continents, hot spots; `by_hand`: plates that are changed by hand
//! - `edges`: what boundaries do to a point; `finer`: the crust on finer grids

mod by_hand;
mod edges;
mod finer;
mod layout;

use super::EARTH_KM;
use super::bytes::{Reader, Writer};
use super::cells::Cells;
use super::map::KeepGoing;
use super::noise::{fbm_row, hash, noise as one_octave, ramp};
use super::once::made;
use crate::planet::Plates as Params;
use crate::sphere::raster::Raster;
use edges::NO_EDGE_KM;
pub(crate) use finer::Rock;
use glam::DVec3;
pub(crate) use layout::Layout;
use rayon::prelude::*;
use std::sync::{Arc, OnceLock};

/// The crust at one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crust {
    /// Height of the ground in metres before anything rises or is carved.
    pub(crate) base_m: f64,
    /// Height in metres by which rock rises while rivers carve.
    pub(crate) uplift_m: f64,
    /// Index of the plate.
    pub(crate) plate: u16,
    /// Unit tangent along the folds of the rock. Its sign means nothing.
    pub(crate) fold: DVec3,
    /// Share of folded rock, 0 to 1.
    pub(crate) folded: f64,
    /// A distance across belts of folded rock, radians: it changes by up to 1 for a step of 1 across the folds, and not
    /// along them. Far from belts it is 0.
    pub(crate) across_rad: f64,
    /// Age of the crust in million years.
    pub(crate) age_myr: f64,
    /// Kind of rock as the logarithm of how easily it is carved, about -1.5 (hard) to 1.5 (soft).
    pub(crate) softness: f64,
}

/// The crust at the cells of a grid.
pub(crate) struct Plates {
    pub(crate) layout: Layout,
    params: Params,
    /// What rivers read of it.
    pub(crate) rock: Rock,
    /// The same on the grid of twice the side.
    finer: OnceLock<Rock>,
    /// Index of the plate.
    pub(crate) plate: Vec<u16>,
    /// Unit tangent along the folds, and the share of folded rock.
    pub(crate) folds: Vec<(DVec3, f64)>,
    /// See [`Crust::across_rad`].
    across_rad: Vec<f32>,
    across: OnceLock<Arc<Across>>,
}

/// [`Crust::across_rad`] at any point.
pub(crate) struct Across {
    pub(crate) raster: Raster<f32>,
    /// Greatest gradient.
    pub(crate) steepest: f64,
}

impl Plates {
    /// Solves the plates at the cells of `side`. None if `keep_going` said no.
    pub(crate) fn solve(params: &Params, planet_seed: u32, side: usize, keep_going: &KeepGoing<'_>) -> Option<Self> {
        let layout = Layout::new(params, planet_seed);
        let all = layout.crust_of(params, side, keep_going)?;
        let across_rad: Vec<f32> = all.iter().map(|crust| crust.across_rad as f32).collect();
        Some(Self {
            across: OnceLock::new(),
            across_rad,
            rock: Rock::new(side, &all),
            plate: all.iter().map(|crust| crust.plate).collect(),
            folds: all.iter().map(|crust| (crust.fold, crust.folded)).collect(),
            params: params.clone(),
            finer: OnceLock::new(),
            layout,
        })
    }

    /// Writes what [`Plates::read_from`] needs.
    pub(crate) fn write_to(&self, to: &mut Writer) {
        for values in [&self.rock.base_m, &self.rock.uplift_m, &self.rock.softness] {
            to.f64s(values.iter().copied());
        }
        to.bytes(self.plate.iter().flat_map(|plate| plate.to_le_bytes()));
        to.f64s(self.folds.iter().flat_map(|(along, share)| [along.x, along.y, along.z, *share]));
        to.f32s(self.across_rad.iter().copied());
    }

    /// Plates with these parameters on a grid that was written.
    pub(crate) fn read_from(params: &Params, planet_seed: u32, side: usize, from: &mut Reader<'_>) -> Option<Self> {
        let (layout, count) = (Layout::new(params, planet_seed), 6 * side * side);
        let [base_m, uplift_m, softness] = [from.f64s(count)?, from.f64s(count)?, from.f64s(count)?];
        let plate: Vec<u16> =
            from.bytes(2 * count)?.as_chunks().0.iter().map(|bytes| u16::from_le_bytes(*bytes)).collect();
        let folds = from.f64s(4 * count)?;
        let across_rad = from.f32s(count)?;
        Some(Self {
            across: OnceLock::new(),
            across_rad,
            rock: Rock { side, base_m, uplift_m, softness },
            plate: plate.iter().all(|plate| usize::from(*plate) < layout.plates.len()).then_some(plate)?,
            folds: folds.as_chunks().0.iter().map(|&[x, y, z, share]| (DVec3::new(x, y, z), share)).collect(),
            params: params.clone(),
            finer: OnceLock::new(),
            layout,
        })
    }

    /// [`Crust::across_rad`] as a raster, made when it is first asked for.
    pub(crate) fn across(&self) -> &Arc<Across> {
        /// The greatest gradient by the greatest of those at the cells. The spline is smooth over two cells.
        const BETWEEN: f64 = 1.5;
        made(&self.across, || {
            let side = self.rock.side;
            let raster = Raster::cube(side, self.across_rad.clone());
            let slope = |dir: &DVec3| {
                let (_, gradient) = raster.sample(&raster.place(*dir), 0);
                (gradient - *dir * gradient.dot(*dir)).length()
            };
            let steepest = BETWEEN * Cells::of(side).dirs.iter().map(slope).fold(0.0, f64::max);
            Arc::new(Across { raster, steepest })
        })
    }

    /// What rivers read of the crust on the grid of twice the side. Solved once, when rivers get there: the first
    /// answer must not wait for it. None if `keep_going` said no.
    pub(crate) fn finer(&self, keep_going: &KeepGoing<'_>) -> Option<&Rock> {
        if self.finer.get().is_none() {
            let side = 2 * self.rock.side;
            let rock = Rock::new(side, &self.layout.crust_of(&self.params, side, keep_going)?);
            // Another thread may have been faster: both are equal.
            let _ = self.finer.set(rock);
        }
        self.finer.get()
    }
}

/// Noise at one point of a row.
struct Noise {
    /// How far it moves the coast outwards.
    coast_rad: f64,
    broad: f64,
    hills: f64,
    rises: f64,
    worn: f64,
    /// Along boundaries, about -1 to 1.
    along: f64,
}

impl Layout {
    /// The crust at the cells of a grid.
    fn crust_of(&self, params: &Params, side: usize, keep_going: &KeepGoing<'_>) -> Option<Vec<Crust>> {
        let cells = Cells::of(side);
        let rows = cells.dirs.par_chunks(side).map(|row| keep_going().then(|| self.crusts(params, row)));
        Some(rows.collect::<Option<Vec<_>>>()?.concat())
    }

    /// The crust at a row of directions.
    pub(crate) fn crusts(&self, params: &Params, dirs: &[DVec3]) -> Vec<Crust> {
        let seed = |k: u32| hash(self.seed, k);
        let bent = self.bent_row(dirs);
        let homes = if self.any_moved() {
            let home = |(dir, bent): (&DVec3, &DVec3)| self.home(self.plate_at(*bent), *dir, *bent);
            dirs.iter().zip(&bent).map(home).collect()
        } else {
            bent.clone()
        };
        let coast_rad = self.coast_rad_row(&homes, 6);
        let broad = fbm_row(dirs, 3.1, 3, 0.55, seed(31));
        let hills = fbm_row(dirs, 11.0, 4, 0.55, seed(32));
        let rises = fbm_row(dirs, 2.2, 2, 0.5, seed(33));
        let worn = fbm_row(&homes, 3.4, 1, 1.0, seed(34));
        let [long, short] = [(6.3, 21), (15.0, 22)].map(|(frequency, k)| fbm_row(&bent, frequency, 1, 1.0, seed(k)));
        let at = |i: usize| {
            let noise = Noise {
                coast_rad: coast_rad[i],
                broad: broad[i],
                hills: hills[i],
                rises: rises[i],
                worn: worn[i],
                along: long[i] + 0.5 * short[i],
            };
            self.crust(params, [dirs[i], bent[i], homes[i]], &noise)
        };
        (0..dirs.len()).map(at).collect()
    }

    /// The crust at a direction, which is given as it is, bent, and bent in the home of its plate.
    fn crust(&self, params: &Params, [dir, bent, home]: [DVec3; 3], noise: &Noise) -> Crust {
        let &Noise { coast_rad, broad, hills, .. } = noise;
        let plate = self.plate_at(bent);
        let edges = self.edges(params, plate, [dir, bent, home], noise.along);
        let inside_km = (self.even_crust_rad(plate, home) + coast_rad) * EARTH_KM;
        // A boundary that cuts a continent off makes its coast.
        // The crust reaches under the sea as far as the shelf.
        let coast_km = smooth_min(inside_km - params.shelf_km - 60.0, edges.coast_km, 120.0);
        let cut = ramp(0.0, 300.0, inside_km - edges.coast_km) * f64::from(u8::from(edges.coast_km < NO_EDGE_KM));
        let seed = |k: u32| hash(self.seed, k);

        let floor_m = -floor_depth(params, edges.floor_myr) + 90.0 * hills;
        let shelf_km = params.shelf_km * (1.0 + 0.9 * broad).clamp(0.25, 2.0) * (1.0 - 0.85 * cut);
        let on_slope = ramp(-shelf_km - 230.0 + 90.0 * cut, -shelf_km, coast_km);
        let shelf_m = -150.0 * ramp(0.0, -shelf_km - 20.0, coast_km);
        let low_m = 45.0 * ramp(0.0, 250.0, coast_km) + (100.0 * hills + 170.0 * broad) * ramp(-150.0, 200.0, coast_km);
        let mut base_m = floor_m + (shelf_m + low_m - floor_m) * on_slope + edges.ground_m;

        // Inside continents: gentle rises and basins, old belts between old cores, what boundaries push up.
        let on_land = ramp(-70.0, 60.0, coast_km);
        let (suture_km, core) = self.cores(plate, home);
        let inland = 0.3 * ramp(0.0, 500.0, coast_km) + 0.7 * ramp(150.0, 1700.0, coast_km);
        let rises = (1.0 + 1.5 * noise.rises).clamp(0.12, 2.4);
        let worn = (1.0 - ramp(0.0, 170.0, suture_km)) * ramp(-0.15, 0.45, noise.worn);
        let rough = (1.0 + 0.55 * hills).clamp(0.35, 1.7);
        let mut uplift_m = edges.uplift_m * rough + params.inland_m * inland * rises + 40.0;
        uplift_m += params.old_belts_m * worn * rough * on_land;
        uplift_m *= f64::max(on_land, edges.folded * ramp(-3000.0, -300.0, base_m));

        let (volcano_m, volcanic) = self.volcano_m(params, dir, hills, on_land);
        base_m += volcano_m;

        let folded = edges.folded.max(0.7 * worn * on_land);
        // Folded rock lies in bands of hard and soft along the belt.
        let bands = one_octave(DVec3::new(edges.edge_km / 75.0, suture_km / 75.0, 3.0 * broad), seed(35));
        let softness = 1.9 * bands * folded + 1.1 * broad * (1.0 - folded) - 0.8 * core
            + 0.35 * hills
            + 0.5 * (1.0 - ramp(0.0, 500.0, coast_km))
            + 0.3 * volcanic;
        let land_myr = 400.0 + 2200.0 * core - 300.0 * folded;
        Crust {
            base_m,
            uplift_m,
            plate: plate as u16,
            fold: (edges.fold - dir * edges.fold.dot(dir)).normalize_or(dir.any_orthonormal_vector()),
            folded,
            across_rad: (edges.folds * across_km(edges.edge_km) + 0.7 * worn * on_land * across_km(suture_km))
                / EARTH_KM,
            age_myr: if coast_km > 0.0 { land_myr } else { edges.floor_myr },
            softness: softness.clamp(-1.8, 1.8),
        }
    }

    /// The distance in km to the line where two old cores of a plate's continent grew together, and how near the
    /// middle of a core the direction lies, 0 to 1.
    fn cores(&self, plate: usize, home: DVec3) -> (f64, f64) {
        let (mut first, mut second) = (f64::MAX, f64::MAX);
        for craton in &self.plates[plate].cratons {
            let away = home.distance(craton.center) - 0.5 * craton.radius_rad;
            if away < first {
                second = std::mem::replace(&mut first, away);
            } else if away < second {
                second = away;
            }
        }
        let suture_km = if second < f64::MAX { 0.5 * (second - first) * EARTH_KM } else { 1e4 };
        (suture_km, 1.0 - ramp(-0.05, 0.12, first))
    }

    /// Height of the volcanoes of hot spots, and the share of volcanic rock.
    fn volcano_m(&self, params: &Params, dir: DVec3, rough: f64, on_land: f64) -> (f64, f64) {
        let (mut most_m, mut swell_m) = (0.0_f64, 0.0_f64);
        for volcano in &self.volcanoes {
            let away = dir.distance_squared(volcano.center);
            let reach = volcano.radius_rad * (1.0 + 0.25 * rough);
            if away < 9.0 * reach * reach {
                let t = 1.0 - away.sqrt() / reach;
                let cone = if t > 0.0 { t * (0.4 + 0.6 * t) } else { 0.0 };
                most_m = most_m.max(cone * volcano.height * params.hot_spots_m);
                swell_m = swell_m.max(ramp(3.0, 0.0, away.sqrt() / reach) * volcano.height * 0.1 * params.hot_spots_m);
            }
        }
        let share = 1.0 - 0.6 * on_land;
        (share * (most_m + swell_m), ramp(0.0, 300.0, most_m))
    }
}

/// A distance across a belt of folds, by the distance from the line where it was pushed together: it rises for some
/// hundred km, then returns to 0.
fn across_km(km: f64) -> f64 {
    let left = (1.0 - km * (1.0 / 2000.0)).max(0.0);
    1.4 * km * (left * left)
}

/// Depth of an ocean floor of an age in million years: it grows with the square root of the age, and ends at 120.
fn floor_depth(params: &Params, age_myr: f64) -> f64 {
    let old = (age_myr / 120.0).min(1.0).sqrt();
    params.ridge_m + (params.ocean_m - params.ridge_m) * old
}

/// The smaller of two numbers, rounded off where they differ by less than `soft`.
fn smooth_min(a: f64, b: f64, soft: f64) -> f64 {
    let near = (1.0 - (a - b).abs() / soft).max(0.0);
    f64::min(a, b) - near * near * (0.25 * soft)
}

#[cfg(test)]
mod tests;
