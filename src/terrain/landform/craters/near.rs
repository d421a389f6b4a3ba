//! Bounds of craters near a direction: the profile of each crater that may reach there, between two distances.

use super::{DISH, DISH_DEPTH, FILLED, Mould, PEAK, RADIUS, Size, THICKNESS};
use crate::simd::Simd;
use crate::terrain::landform::places::{Places, neighbour, unit};
use crate::terrain::noise;
use glam::DVec3;

impl Size {
    /// Lowest and highest ground within an angle of a direction.
    pub(super) fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        // A little more for the rounding of f32.
        let reach = angle_rad * self.lattices[0].frequency + 1e-5;
        // Beyond this, craters outside the cells next to the direction's own could reach.
        if reach > 0.4 {
            return (-1.0, 1.0);
        }
        let [x, y, z] = noise::skew(dir_planet.to_array());
        let mut places = Places::<f64>::default();
        let mut sum = (0.0, 0.0);
        for octave in &self.lattices {
            places.find(Simd::detect(), [&[x], &[y], &[z]], octave);
            for step in (0..27).map(|k| [k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1]) {
                let (cell, from) = neighbour(&places, step, 0);
                let random = noise::cell_hash(cell, octave.seed);
                let to = [0, 1, 2]
                    .map(|axis| from[axis] + 0.3 + 0.4 * unit::<f64>(random >> (10 * axis)) - places.fraction[axis][0]);
                let crater = self.crater_near(DVec3::from_array(to), dir_planet, reach, noise::scramble(random));
                sum = (sum.0 + crater.0, sum.1 + crater.1);
            }
        }
        (sum.0.max(-1.0), sum.1.min(1.0))
    }

    /// Bounds of the crater whose centre is at `to` from the direction, in cells, within a `reach` of cells.
    fn crater_near(&self, to: DVec3, dir_planet: DVec3, reach: f64, random: u32) -> (f64, f64) {
        let mould = self.mould;
        if unit::<f32>(random) >= mould.density {
            return (0.0, 0.0);
        }
        let radius = f64::from(mould.radius(random));
        // Points and their directions change together.
        let turn = reach + (to.length() + reach) * reach / self.lattices[0].frequency;
        let off = to.dot(dir_planet);
        let distance = (to - dir_planet * off).length();
        let near = |off: f64| {
            let nearness = (1.0 - off.max(0.0) / f64::from(THICKNESS)).max(0.0);
            nearness * nearness * (3.0 - 2.0 * nearness) * radius / f64::from(RADIUS)
        };
        let depth = (near(off.abs() + turn), near(off.abs() - turn));
        let (from, to) = ((distance - turn).max(0.0) / radius, (distance + turn) / radius);
        let (low, high) = mould.range(from, to, unit(random >> 20));
        let product = |height: f64| (height * depth.0, height * depth.1);
        let ((a, b), (c, d)) = (product(low), product(high));
        (a.min(b), c.max(d))
    }
}

impl Mould {
    /// Lowest and highest [`Mould::profile`] between two distances from the middle, from its parts, each of which is
    /// monotone.
    fn range(self, from: f64, to: f64, random: f32) -> (f64, f64) {
        let [rim, floor, peak, reach] = [self.rim, self.floor, self.peak, self.reach].map(f64::from);
        let bowl = |r: f64| (1.0 + rim) * ((r.min(1.0) - floor) / (1.0 - floor)).max(0.0).powi(2) - 1.0;
        let top = |r: f64| peak * (1.0 - (r / f64::from(PEAK)).powi(2)).max(0.0).powi(2);
        let tail = |r: f64| rim * ((reach - r.max(1.0)) / (reach - 1.0)).max(0.0).powi(2);
        let (mut low, mut high) = (f64::MAX, f64::MIN);
        if from <= 1.0 {
            (low, high) = (bowl(from) + top(to), bowl(to) + top(from));
        }
        if to >= 1.0 {
            (low, high) = (low.min(tail(to)), high.max(tail(from)));
        }
        let age = f64::from(self.age * ((random - self.fresh) / (1.0 - self.fresh).max(1e-6)).max(0.0));
        let dish = |r: f64| -f64::from(DISH_DEPTH) * (1.0 - (r / f64::from(DISH)).powi(2)).max(0.0).powi(2);
        let left = 1.0 - f64::from(FILLED) * age;
        (left * ((1.0 - age) * low + age * dish(from)), left * ((1.0 - age) * high + age * dish(to)))
    }
}
