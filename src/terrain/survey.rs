//! Where a planet lies in its biome table: cell, biome and height at directions spread evenly over the sphere.

use super::climate::{NO_SEA, Rules};
use super::field::EXACT;
use super::points::Points;
use super::{Terrain, height, tangent_slope, unit};
use glam::DVec3;
use std::f64::consts::TAU;

/// The ground of one place, as far as the biome table is concerned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ground {
    /// Height above the reference sphere.
    pub height_m: f64,
    /// Column and row of the biome table.
    pub cell: [usize; 2],
    /// Index into the palette.
    pub biome: usize,
}

/// So many unit directions that stand for equal areas each (Fibonacci lattice; Swinbank and Purser, Fibonacci grids, 2006).
pub fn spread(count: usize) -> impl Iterator<Item = DVec3> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let flat = libm::sqrt(1.0 - z * z);
        let turn = (i as f64 * GOLDEN).fract() * TAU;
        DVec3::new(flat * libm::cos(turn), flat * libm::sin(turn), z)
    })
}

impl Terrain {
    /// What [`Terrain::sample`] says about cell, biome and height, for many directions, on the calling thread alone.
    pub fn grounds(&self, dirs_planet: &[DVec3]) -> Vec<Ground> {
        dirs_planet.chunks(512).flat_map(|dirs| self.grounds_of(dirs)).collect()
    }

    fn grounds_of(&self, dirs: &[DVec3]) -> Vec<Ground> {
        let dirs: Vec<DVec3> = dirs.iter().map(|&dir| unit(dir)).collect();
        let points = Points::new(dirs.clone());
        let fields = self.fields(&points, EXACT);
        let mut heights = height::combine(&self.stack, self.simd, &points, &fields, EXACT, |_, _| {});
        self.raise(&mut heights, &points, EXACT);
        let noise = self.climate.field(self.simd, &points);
        let inland_rad = self.climate.inland_rad(&dirs);
        let rules = Rules::new(&self.planet);
        let radius_m = self.planet.radius_m();
        let ground = |(i, &dir): (usize, &DVec3)| {
            let height_m = heights.height_m[i];
            let gradient = heights.gradients[0].each_ref().map(|component| f64::from(component[i]));
            let slope = tangent_slope(dir, DVec3::from_array(gradient), radius_m + height_m);
            let inland_rad = inland_rad.get(i).copied().unwrap_or(NO_SEA);
            let climate = rules.at(dir.z, height_m, [noise.temperature[i], noise.moisture[i]], inland_rad);
            let (cell, biome) = self.biome_of(dir, &climate, height_m, libm::atan(slope.length()));
            Ground { height_m, cell, biome }
        };
        dirs.iter().enumerate().map(ground).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::shipped;
    use std::sync::Arc;

    #[test]
    fn a_survey_says_what_a_sample_says() {
        let terrain = Terrain::try_new(Arc::new(shipped::default_planet())).unwrap();
        let dirs: Vec<DVec3> = spread(700).collect();
        assert!(dirs.iter().sum::<DVec3>().length() < 1.0, "evenly spread");
        for (ground, &dir) in terrain.grounds(&dirs).iter().zip(&dirs) {
            let sample = terrain.sample(dir);
            let said = Ground { height_m: sample.height_m, cell: sample.cell, biome: sample.biome };
            assert_eq!(*ground, said);
        }
    }
}
