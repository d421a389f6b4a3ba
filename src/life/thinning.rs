//! Thinning: which share of a population a view draws at a distance, and how wide.
//!
//! Low cover, such as grass, goes on far beyond the distance up to which every object is drawn: with the square of the
//! distance fewer objects stand for all, each as much wider as others are left out, up to [`WIDEST`] times. So each
//! octave of the distance has as many objects, and their area stays. Farther out the canopy takes over, by the share
//! that they leave. All other objects are as wide as they are, and thin out over the last half of their reach.

use super::placement::Placement;
use crate::lod::Quality;
use crate::planet::{Form, Population};

/// Share of its reach up to which the objects of a population hand nothing over to the canopy for being far away.
pub const FULL_SHARE: f64 = 0.5;
/// Widening of an object of low cover, at the most: on flat rays, which hide how it was made, and on steep ones.
pub const WIDEST: [f64; 2] = [6.0, 2.5];
/// Sines of the angles of rays over the ground between which it goes from one to the other.
pub const WIDEST_SINES: [f64; 2] = [0.05, 0.3];
/// Height in pixels times widening of such an object, at the most: nearer ones would be seen as what they are.
pub const WIDEST_PX: f64 = 36.0;
/// Share of its size over which an object grows where it begins to be drawn.
const GROWTH: f64 = 0.12;

/// How the objects of a population thin out with their distance from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Thinning {
    /// Distance beyond which fewer and wider objects stand for all; infinite where each stands for itself.
    pub full_m: f64,
    /// Distance up to which objects are drawn.
    pub reach_m: f64,
}

impl Thinning {
    /// The thinning of a population whose objects would end at a distance if each stood for itself.
    pub(super) fn new(population: &Population, end_m: f64, quality: Quality) -> Self {
        if !is_low_cover(population) {
            return Self { full_m: f64::INFINITY, reach_m: end_m };
        }
        // As shares of that distance: chosen so that a frame has about as many objects as without.
        let [full, reach] = match quality {
            Quality::Low => [0.34, 4.0],
            Quality::Medium => [0.29, 4.0],
            Quality::High => [0.28, 3.0],
        };
        Self { full_m: full * end_m, reach_m: reach * end_m }
    }

    /// Share of the objects that stand for all at a distance, the hand-over to the canopy apart.
    fn left(&self, distance_m: f64) -> f64 {
        (self.full_m / distance_m.max(self.full_m)).powi(2).min(1.0)
    }

    /// Share of the objects that stand for all at a distance or farther away.
    pub(super) fn limit(&self, distance_m: f64) -> f64 {
        if self.full_m.is_finite() { (1.0 + GROWTH) * self.left(distance_m) } else { 1.0 }
    }

    /// Factor on the width of an object at a distance. `height_px`: its height in pixels. `sine`: of the angle of the
    /// ray over the ground.
    pub fn widening(&self, distance_m: f64, height_px: f64, sine: f64) -> f64 {
        if !self.full_m.is_finite() {
            return 1.0;
        }
        let steep = ((sine - WIDEST_SINES[0]) / (WIDEST_SINES[1] - WIDEST_SINES[0])).clamp(0.0, 1.0);
        let widest = WIDEST[0] + (WIDEST[1] - WIDEST[0]) * steep;
        (1.0 / self.left(distance_m)).min(widest).min((WIDEST_PX / height_px).max(1.0))
    }

    /// The greatest factor on the width of an object.
    pub fn widest(&self) -> f64 {
        if self.full_m.is_finite() { WIDEST[0] } else { 1.0 }
    }

    /// Size that an object of a rank has at a distance, as a share of its own: the last ones grow from nothing.
    pub fn grown(&self, rank: f64, distance_m: f64) -> f64 {
        let rank = if self.full_m.is_finite() { rank / self.left(distance_m) } else { rank };
        let share = (1.0 + GROWTH) * self.near(distance_m);
        ((share - rank) / GROWTH).clamp(0.0, 1.0)
    }

    /// Share that the end of the reach leaves.
    fn near(&self, distance_m: f64) -> f64 {
        ((self.reach_m - distance_m) / (self.reach_m * (1.0 - FULL_SHARE))).clamp(0.0, 1.0)
    }
}

/// Sizes of an object within which it is drawn if it stands for itself, and the most objects of a population around
/// the eye.
fn limits(quality: Quality) -> (f64, f64) {
    match quality {
        Quality::Low => (60.0, 8_000.0),
        Quality::Medium => (180.0, 80_000.0),
        Quality::High => (360.0, 300_000.0),
    }
}

/// Distance up to which objects of a population are drawn, apart from others.
fn own_reach_m(placement: &Placement, quality: Quality) -> f64 {
    let (sizes, most) = limits(quality);
    let population = placement.population();
    let by_count_m = (most / (placement.most_per_m2() * std::f64::consts::PI)).sqrt();
    (population.height_m * population.form.seen_size() * sizes).min(by_count_m)
}

/// How objects of each population thin out among all: none are drawn beyond those of a denser population of like size
/// in its biomes, because single trees would stand on a forest that is a canopy already.
pub(super) fn thinnings(placements: &[Placement], quality: Quality) -> Vec<Thinning> {
    let area = |population: &Population| population.per_hectare * population.height_m * population.height_m;
    let hides = |own: &Population, other: &Population| {
        let meets =
            own.biomes.is_empty() || other.biomes.is_empty() || own.biomes.chars().any(|key| other.stands_in(key));
        // One that asks for banks or ridges is not everywhere.
        meets && !other.asks_lie() && area(other) > area(own) && other.height_m > 0.5 * own.height_m
    };
    let own = |placement: &Placement| Thinning::new(placement.population(), own_reach_m(placement, quality), quality);
    let own: Vec<Thinning> = placements.iter().map(own).collect();
    let among_m = |placement: &Placement, own_reach_m: f64| {
        let others = placements.iter().zip(&own);
        let denser = others.filter(|(other, _)| hides(placement.population(), other.population()));
        denser.map(|(_, other)| other.reach_m).fold(own_reach_m, f64::min)
    };
    let among = placements.iter().zip(&own);
    among.map(|(placement, own)| Thinning { reach_m: among_m(placement, own.reach_m), ..*own }).collect()
}

/// Whether objects cover the ground so that fewer and wider ones may stand for all: blades and cushions do, and none
/// that a body hits.
pub(super) fn is_low_cover(population: &Population) -> bool {
    !population.solid && matches!(population.form, Form::Tuft(_) | Form::Cushion(_))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::life::Tuft;

    const QUALITIES: [Quality; 3] = [Quality::Low, Quality::Medium, Quality::High];
    /// Distance at which objects would end that stand for themselves.
    const END_M: f64 = 50.0;
    const RANKS: usize = 40_000;
    const SMALL_PX: f64 = 1.0;

    fn grass() -> Population {
        Population { solid: false, height_m: 0.3, form: Form::Tuft(Tuft::default()), ..Population::default() }
    }

    /// Objects that are drawn at a distance, and their width times height, as shares of those of all.
    fn drawn(thinning: Thinning, distance_m: f64) -> (f64, f64) {
        let sizes = (0..RANKS).map(|i| thinning.grown((i as f64 + 0.5) / RANKS as f64, distance_m));
        let sizes: Vec<f64> = sizes.filter(|size| *size > 0.0).collect();
        let squares: f64 = sizes.iter().map(|size| size * size).sum();
        (sizes.len() as f64 / RANKS as f64, squares * thinning.widening(distance_m, SMALL_PX, 0.0) / RANKS as f64)
    }

    #[test]
    fn a_share_of_the_grass_covers_as_much_as_all_of_it_and_the_canopy_takes_the_rest() {
        for quality in QUALITIES {
            let thinning = Thinning::new(&grass(), END_M, quality);
            assert!(thinning.reach_m > 2.5 * END_M, "{quality:?}: {}", thinning.reach_m);
            for step in 1..200 {
                let distance_m = thinning.reach_m * f64::from(step) / 200.0;
                let (count, area) = drawn(thinning, distance_m);
                let told = format!("{quality:?}, {distance_m} m: {count} of the objects, {area} of the area");
                // What the canopy does not show: `drawn_share` in canopy.wgsl.
                let near = ((1.0 - distance_m / thinning.reach_m) / (1.0 - FULL_SHARE)).min(1.0);
                let left = (thinning.full_m / distance_m.max(thinning.full_m)).powi(2);
                let expected = near * (WIDEST[0] * left).min(1.0);
                assert!((area - expected).abs() < 0.1, "{told}, not {expected}");
                if near >= 1.0 {
                    assert!((area / expected - 1.0).abs() < 0.1, "{told}, not {expected}");
                }
                let is_widest = distance_m > thinning.full_m * WIDEST[0].sqrt();
                assert!(is_widest || near < 1.0 || (area - 1.0).abs() < 0.1, "{told}");
                assert!(count < 1.15 * left + 1e-3, "{told}");
            }
        }
    }

    #[test]
    fn each_object_narrows_and_grows_without_a_jump_while_the_eye_comes_nearer() {
        let thinning = Thinning::new(&grass(), END_M, Quality::Medium);
        for rank in [0.0, 0.001, 0.02, 0.3, 0.999] {
            let (mut before, step_m) = ((0.0, WIDEST[0]), 5e-4 * thinning.reach_m);
            for step in (0..2000).rev() {
                let distance_m = step_m * f64::from(step);
                let now = (thinning.grown(rank, distance_m), thinning.widening(distance_m, SMALL_PX, 0.0));
                assert!(now.0 >= before.0 && now.0 < before.0 + 0.15, "{rank}, {distance_m} m: {before:?}, {now:?}");
                assert!(now.1 <= before.1 && now.1 > 0.9 * before.1, "{rank}, {distance_m} m: {before:?}, {now:?}");
                before = now;
            }
            assert_eq!(before, (1.0, 1.0), "{rank}");
        }
    }

    #[test]
    fn what_is_large_in_the_picture_or_seen_from_above_is_widened_less() {
        let thinning = Thinning::new(&grass(), END_M, Quality::Medium);
        let far_m = 0.5 * thinning.reach_m;
        let widening = |height_px, sine| thinning.widening(far_m, height_px, sine);
        assert_eq!([widening(1.0, 0.0), widening(1.0, 1.0)], WIDEST);
        assert_eq!([12.0, 36.0, 300.0].map(|height_px| widening(height_px, 0.0)), [3.0, 1.0, 1.0]);
    }

    #[test]
    fn trees_and_stones_keep_their_width_and_their_number() {
        for population in [Population::default(), Population { solid: true, ..grass() }] {
            let thinning = Thinning::new(&population, END_M, Quality::Medium);
            assert_eq!((thinning.reach_m, thinning.widest()), (END_M, 1.0));
            assert_eq!((thinning.widening(40.0, SMALL_PX, 0.0), thinning.limit(40.0)), (1.0, 1.0));
            assert_eq!(drawn(thinning, 0.5 * END_M), (1.0, 1.0));
        }
    }
}
