//! Land that rivers and lakes keep wet, whatever it rains there: a green strip along a river through a desert.

use super::drainage::Drainage;
use super::noise::ramp;
use crate::sphere::raster::{NearPoints, Raster};
use rayon::prelude::*;

/// Discharge in m³/s at which a floodplain begins to show, and at which it is wettest.
const DISCHARGE_M3_S: [f64; 2] = [60.0, 2500.0];
/// Wetness of the shore of a lake with an outlet, and of one without, which is salty.
const SHORE: [f32; 2] = [0.8, 0.3];
/// Humidity of a floodplain that fills its cells: about that of a forest.
const HUMIDITY: f64 = 0.6;
/// Cells along the side of a face at which a floodplain is as wide as a cell. Wider cells are wet in part.
const SIDE: f64 = 512.0;
/// The texel of land that is wet all over.
const MOST: f64 = 65535.0;
/// A strip of one cell loses this factor to the smoothing of the raster.
const SMOOTHED: f64 = 2.0;

/// How wet rivers and lakes keep the land.
pub(crate) struct Floodplains(Raster<u16>);

impl Floodplains {
    pub(super) fn new(drainage: &Drainage) -> Self {
        let share = (drainage.side as f64 / SIDE).min(1.0) * SMOOTHED;
        let from_to = DISCHARGE_M3_S.map(libm::log10);
        let wet = |cell: usize| {
            if drainage.is_sea[cell] {
                return 0;
            }
            let lake = (drainage.lake[cell] as usize).checked_sub(1).and_then(|lake| drainage.lakes.get(lake));
            let wet = match lake {
                Some(lake) => f64::from(SHORE[usize::from(lake.outlet.is_none())]),
                None => match f64::from(drainage.discharge_m3_s[cell]) {
                    // Most cells.
                    small if small <= DISCHARGE_M3_S[0] => 0.0,
                    discharge_m3_s => ramp(from_to[0], from_to[1], libm::log10(discharge_m3_s)),
                },
            };
            (MOST * (wet * share).min(1.0)) as u16
        };
        let cells = (0..drainage.is_sea.len()).into_par_iter().map(wet).collect();
        Self(Raster::cube(drainage.side, cells))
    }

    /// Raises the humidities of land that rain alone makes at points near each other. See
    /// [`super::weather::Weather::at`]. `memory` may hold anything.
    pub(crate) fn raise(&self, points: &NearPoints, humidity: &mut [f64], memory: &mut Vec<f64>) {
        self.0.values(points, memory);
        for (humidity, wet) in humidity.iter_mut().zip(memory) {
            *humidity = raised(*humidity, *wet);
        }
    }
}

/// A humidity where the land is as wet as a texel of the raster says.
fn raised(humidity: f64, texel: f64) -> f64 {
    humidity + (HUMIDITY - humidity).max(0.0) * (texel / MOST)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::world::cells::Cells;

    #[test]
    fn a_river_wets_a_desert_and_leaves_a_forest_as_it_is() {
        const SIDE: usize = 64;
        let (count, river) = (6 * SIDE * SIDE, 40);
        let is_river = |cell: usize| cell < SIDE * SIDE && cell % SIDE == river;
        let drainage = Drainage {
            side: SIDE,
            is_sea: vec![false; count],
            lake: vec![0; count],
            discharge_m3_s: (0..count).map(|cell| if is_river(cell) { 9000.0 } else { 1.0 }).collect(),
            ..Drainage::default()
        };
        let plains = Floodplains::new(&drainage);
        let dirs = &Cells::of(SIDE).dirs;
        let at = |column: usize, humidity: f64| {
            let (mut points, mut raised) = (NearPoints::default(), [humidity]);
            points.refill(std::iter::once(dirs[30 * SIDE + column]));
            plains.raise(&points, &mut raised, &mut Vec::new());
            raised[0]
        };
        assert!(at(river, 0.1) > 0.14 && at(river, 0.1) < 0.5, "{}", at(river, 0.1));
        assert_eq!((at(river, 0.7), at(river + 5, 0.1)), (0.7, 0.1));
    }
}
