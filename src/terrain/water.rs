//! Water, wind and rain at points: the sea, and the lakes, rivers and weather of a planet's structure.
//!
//! Layers over the structure end at its rivers. Ground edits may raise the ground above a lake, which keeps its level;
//! a river keeps its depth and follows them. Tiles draw the same water (see `wet`).

use super::Terrain;
use super::landform::coarsest_spacing_rad;
use super::landform::{river_banks, river_points};
use super::query::Sample;
use crate::world::carved::Carved;
use crate::world::grid::cell_at;
use crate::world::rivers::RiverPoint;
use glam::DVec3;

/// Metres from the water for each metre that a shore of a lake or the sea rises.
const SHORE_RUN: f64 = 10.0;

/// A river near a point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct River {
    /// The same from source to mouth for a river that [`Terrain::rivers`] lists; one for each reach of small
    /// tributaries. It holds for the world maps that serve: another number of grids has other ids.
    pub id: u64,
    /// Distance from the point to the centre line.
    pub distance_m: f64,
    /// Width of the water. The point is in the river if it is nearer to the centre line than half of that.
    pub width_m: f64,
    /// Depth of the water in the middle.
    pub depth_m: f64,
    /// Water that flows by in a second.
    pub discharge_m3_s: f64,
    /// Direction of the flow: a unit tangent in the planet frame.
    pub flow_planet: DVec3,
}

impl Terrain {
    /// The greatest distance between points, as an angle, at which the rivers of the solved drainage show. None without
    /// a structure.
    pub(crate) fn river_spacing_rad(&self) -> Option<f64> {
        self.world().carved.map().map(|carved| coarsest_spacing_rad(carved.drainage.side))
    }

    /// Fills in water, wind and rain at unit directions `spacing_rad` apart whose heights are known, and where no map
    /// of the weather serves, the climate.
    pub(super) fn find_water(&self, dirs: &[DVec3], spacing_rad: f64, samples: &mut [Sample]) {
        let world = self.world();
        let sea_m = self.planet().sea_level_m();
        for (sample, &dir) in samples.iter_mut().zip(dirs) {
            sample.water_level_m = sea_m.filter(|sea_m| sample.height_m < *sea_m);
            sample.rain_mm = sample.precipitation_mm;
            if let Some(weather) = world.weather.map() {
                (sample.rain_mm, sample.wind_planet_m_s) = (weather.rain_at(dir), weather.wind_at(dir));
            }
            sample.plate = world.plates.map().and_then(|plates| u16::try_from(plates.layout.plate_under(dir)).ok());
        }
        if let Some(carved) = world.carved.map() {
            river_points(&carved.rivers, dirs, spacing_rad, |points| {
                for ((sample, point), &dir) in samples.iter_mut().zip(points).zip(dirs) {
                    self.add_rivers(carved, dir, point, sample);
                }
            });
        }
    }

    /// Fills in the distance from the nearest water. Water is there already.
    pub(super) fn find_banks(&self, dirs: &[DVec3], spacing_rad: f64, samples: &mut [Sample]) {
        let sea_m = self.planet().sea_level_m();
        let over_m = |sample: &Sample, level_m: f64| (SHORE_RUN * (sample.height_m - level_m)).max(0.0);
        let nearer = |sample: &mut Sample, from_m: f64, by_height: bool| {
            if from_m < sample.bank_m.unwrap_or(f64::INFINITY) {
                (sample.bank_m, sample.bank_by_height) = (Some(from_m), by_height);
            }
        };
        for sample in &mut *samples {
            let from_m = sea_m.map_or(f64::INFINITY, |sea_m| over_m(sample, sea_m));
            nearer(sample, if sample.water_level_m.is_some() { 0.0 } else { from_m }, true);
        }
        let Some(carved) = self.world().carved.map() else { return };
        river_points(&carved.rivers, dirs, spacing_rad, |points| {
            for (sample, point) in samples.iter_mut().zip(points) {
                if let Some(level_m) = point.lake_level_m.map(|level_m| self.stack.bent_m(level_m)) {
                    nearer(sample, over_m(sample, level_m), true);
                }
            }
        });
        let radius_m = self.planet().radius_m();
        river_banks(&carved.rivers, dirs, spacing_rad, |banks_rad| {
            for (sample, bank_rad) in samples.iter_mut().zip(banks_rad) {
                nearer(sample, bank_rad * radius_m, false);
            }
        });
    }

    /// Fills in what rivers and lakes say. The level of the sea is there already.
    fn add_rivers(&self, carved: &Carved, dir: DVec3, point: &RiverPoint, sample: &mut Sample) {
        let bent_m = |height_m: f64| self.stack.bent_m(height_m);
        let lake_m = point.lake_level_m.map(bent_m).filter(|level_m| *level_m > sample.height_m);
        let rise_m =
            if point.rise_m > 0.0 { bent_m(point.height_m + point.rise_m) - bent_m(point.height_m) } else { 0.0 };
        let river_m = Some(sample.height_m + rise_m).filter(|level_m| *level_m > sample.height_m);
        // Water below the level of the sea is the sea's.
        let is_inland = |level_m: &f64| self.planet().sea_level_m().is_none_or(|sea_m| *level_m > sea_m);
        let (lake_m, river_m) = (lake_m.filter(is_inland), river_m.filter(is_inland));
        sample.lake = Some(point.lake).filter(|&lake| lake > 0 && lake_m.is_some());
        sample.water_level_m = match (lake_m, river_m) {
            (Some(lake_m), Some(river_m)) => Some(lake_m.max(river_m)),
            (lake_m, river_m) => lake_m.or(river_m).or(sample.water_level_m),
        };
        sample.basin = carved.basins().of(cell_at(carved.drainage.side, dir));
        // A dry valley carries no water.
        sample.river = point.river.filter(|river| river.discharge_m3_s > 0.0).map(|river| River {
            id: river.id,
            distance_m: river.distance_m,
            width_m: river.width_m,
            depth_m: river.depth_m,
            discharge_m3_s: river.discharge_m3_s,
            flow_planet: river.flow,
        });
    }
}
