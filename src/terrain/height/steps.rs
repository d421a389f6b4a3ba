//! Terraces: steps cut into the height below, and how much of them a spacing shows.
//!
//! On a steep wall steps lie closer together than the points that are shaded. The steps that single points then meet
//! are chance (a wall would look like a string of beads). So in gradients the steps fade into the ground that they
//! were cut from, which has their mean slope. Heights keep the steps.

use super::Steps;
use super::lanes::{CHUNK, Lane, Output, Shaped, joining};
use crate::simd::{Simd, for_each_simd};

/// Adding and subtracting this rounds an f64 below 2^51 to a whole number.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// Points per step at which steps have faded; from twice as many on they show in full.
const LEAST_POINTS: f32 = 2.5;

/// Cuts the height below into steps: `noise` becomes the vector from there to the step, in steps.
///
/// The tread of a step is level at its own height, with a riser half-way to the next: `S(t) - t`, where `t` is the
/// position between two treads and `S` a smoothstep across the riser.
#[inline(always)]
fn cut_body<const SLOPES: bool>(
    n: usize,
    steps: &Steps,
    height: &Lane<f64>,
    noise: &mut Lane<f64>,
    shaped: &mut Shaped,
) {
    let (per_metre, riser) = (1.0 / steps.height_m, 0.5 - 0.4 * steps.sharpness);
    let (start, per_riser) = (0.5 - riser, 0.5 / riser);
    for i in 0..n.min(CHUNK) {
        let place = (height[i] * per_metre + steps.waviness * noise[i]).clamp(-1e12, 1e12);
        let t = place - ((place - 0.5 + ROUNDER) - ROUNDER);
        let s = ((t - start) * per_riser).clamp(0.0, 1.0);
        noise[i] = steps.sharpness * (s * s * (3.0 - 2.0 * s) - t);
        if SLOPES {
            let slope = steps.sharpness * (6.0 * s * (1.0 - s) * per_riser - 1.0);
            shaped.by_noise[i] = slope * steps.waviness;
            shaped.by_height[i] = slope * per_metre;
        }
    }
}
joining!(fn cut(n: usize, steps: &Steps, height: &Lane<f64>, noise: &mut Lane<f64>, shaped: &mut Shaped) = cut_body);

/// The share of steps that points `spacing_rad` apart show, from the gradients of the height below and of the
/// waviness noise at that spacing.
#[inline(always)]
fn seen_body(
    n: usize,
    (steps, spacing_rad): (&Steps, f64),
    dirs: &[Lane<f64>; 3],
    below: &[Lane<f32>; 3],
    noise: &[&[f32]; 3],
    share: &mut Lane<f32>,
) {
    let (per_metre, per_noise) = ((1.0 / steps.height_m) as f32, steps.waviness as f32);
    // Avoids a division by zero: steps are then as wide as the planet.
    let (scale, least) = ((f64::from(LEAST_POINTS) * spacing_rad) as f32, 1e-20);
    let [n0, n1, n2] = noise;
    let n = n.min(n0.len()).min(n1.len()).min(n2.len()).min(CHUNK);
    for i in 0..n {
        let d = [dirs[0][i] as f32, dirs[1][i] as f32, dirs[2][i] as f32];
        let g = [
            below[0][i] * per_metre + n0[i] * per_noise,
            below[1][i] * per_metre + n1[i] * per_noise,
            below[2][i] * per_metre + n2[i] * per_noise,
        ];
        let up = g[0] * d[0] + g[1] * d[1] + g[2] * d[2];
        let t = [g[0] - up * d[0], g[1] - up * d[1], g[2] - up * d[2]];
        let steps_per_rad = (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]).sqrt();
        share[i] = (1.0 / (steps_per_rad * scale + least) - 1.0).clamp(0.0, 1.0);
    }
}
for_each_simd!(pub(super) fn seen(n: usize, how: (&Steps, f64), dirs: &[Lane<f64>; 3], below: &[Lane<f32>; 3], noise: &[&[f32]; 3], share: &mut Lane<f32>) = seen_body);

/// As `lanes::mix`, with this share of the steps.
#[inline(always)]
fn mix_body(n: usize, share: &Lane<f32>, output: &Output, noise: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) {
    for (gradient, noise) in gradient.iter_mut().zip(noise) {
        for (i, d) in noise.iter().enumerate().take(n.min(CHUNK)) {
            let by_height = output.by_height[i] - (1.0 - share[i]) * output.by_steps[i];
            gradient[i] = gradient[i] * by_height + d * (output.by_noise[i] * share[i]);
        }
    }
}
for_each_simd!(pub(super) fn mix(n: usize, share: &Lane<f32>, output: &Output, noise: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) = mix_body);

#[cfg(test)]
mod tests {
    use crate::planet::{Fbm, Layer, Mask, Planet, Shape, SlopeMask, Terraces};
    use crate::terrain::Terrain;
    use glam::DVec3;
    use std::sync::Arc;

    const SPACINGS_M: [f64; 5] = [0.0, 50.0, 400.0, 800.0, 3200.0];

    /// The height of a point and its slope at each spacing.
    type Place = (f64, [DVec3; 5]);

    /// Points of a path.
    fn walk(layers: Vec<Layer>) -> Vec<Place> {
        let planet = Planet { layers, ..Planet::default() };
        let (count, radius_m) = (3000, planet.radius_m());
        let dirs: Vec<DVec3> =
            (0..count).map(|i| DVec3::new(0.4, f64::from(i) * 7.0 / radius_m, 0.7).normalize()).collect();
        let spacings = SPACINGS_M.map(|spacing_m| spacing_m / radius_m);
        let relief = Terrain::try_new(Arc::new(planet)).unwrap().slopes_at(&dirs, &spacings);
        let slopes = |i: usize| std::array::from_fn(|band| relief.slopes[band][i]);
        (0..relief.height_m.len()).map(|i| (relief.height_m[i], slopes(i))).collect()
    }

    fn ground() -> Layer {
        let shape = Shape::Fbm(Fbm { wavelength_km: 60.0, octaves: 1, ..Fbm::default() });
        Layer { name: "Ground".to_owned(), amplitude_m: 9000.0, shape, ..Layer::default() }
    }

    /// Steps of 100 m, which are 300 m apart at the steepest.
    fn terraces() -> Layer {
        let shape = Shape::Terraces(Terraces { sharpness: 0.8, waviness: 0.5, wavelength_km: 30.0, octaves: 2 });
        Layer { name: "Steps".to_owned(), amplitude_m: 100.0, shape, ..Layer::default() }
    }

    #[test]
    fn steps_too_fine_to_be_seen_leave_the_slope_of_the_ground_below() {
        let (plain, cut) = (walk(vec![ground()]), walk(vec![ground(), terraces()]));
        let steepest = plain.iter().map(|(_, slopes)| slopes[0].length()).fold(0.0, f64::max);
        assert!(steepest > 0.3, "{steepest}");
        let off = |band: usize, against: &[Place], with: usize| {
            let apart = |(a, b): (&Place, &Place)| a.1[band].distance(b.1[with]);
            cut.iter().zip(against).map(apart).collect::<Vec<_>>()
        };
        let most = |all: Vec<f64>| all.into_iter().fold(0.0, f64::max);
        // Near enough, all steps show; from afar, none. Heights do not depend on the spacing.
        assert!(most(off(0, &plain, 0)) > 1.0 * steepest);
        assert_eq!(most(off(1, &cut, 0)), 0.0);
        let (near, between, far) = (most(off(2, &plain, 2)), most(off(3, &plain, 3)), most(off(4, &plain, 4)));
        assert!(far < between && between < near, "{far} {between} {near}");
        assert!(far < 0.05 * steepest, "{far} of {steepest}");
        // Where steps are finer than the points, none is left; and they fade in without a jump.
        for (at, (plain, cut)) in plain.iter().zip(&cut).enumerate() {
            let per_step = 100.0 / (plain.1[0].length() + 1e-9) / SPACINGS_M[3];
            assert!(per_step > 0.8 || plain.1[3].distance(cut.1[3]) < 1e-5, "{at}: {per_step}");
        }
        let jump = cut.windows(2).map(|pair| pair[0].1[3].distance(pair[1].1[3])).fold(0.0, f64::max);
        assert!(jump < 0.05 * steepest, "{jump} of {steepest}");
    }

    /// Masks make heights, so the gradient that a slope mask reads does not depend on the gradients asked for.
    #[test]
    fn a_mask_by_slope_counts_the_steps_whatever_is_asked() {
        let masks = vec![Mask::Slope(SlopeMask { from_deg: 5.0, to_deg: 20.0, over_m: 3200.0, invert: false })];
        let fbm = Shape::Fbm(Fbm { wavelength_km: 1.0, octaves: 2, ..Fbm::default() });
        let scree = Layer { name: "Scree".to_owned(), amplitude_m: 50.0, shape: fbm, masks, ..Layer::default() };
        let layers = vec![ground(), terraces(), scree];
        let planet = Planet { layers: layers.clone(), ..Planet::default() };
        let radius_m = planet.radius_m();
        let dirs: Vec<DVec3> =
            (0..3000).map(|i| DVec3::new(0.4, f64::from(i) * 7.0 / radius_m, 0.7).normalize()).collect();
        let heights = Terrain::try_new(Arc::new(planet)).unwrap().heights_m(&dirs);
        let asked: Vec<f64> = walk(layers).into_iter().map(|(height_m, _)| height_m).collect();
        assert_eq!(heights, asked);
        let without = walk(vec![ground(), terraces()]);
        assert!(heights.iter().zip(without).any(|(a, (b, _))| (a - b).abs() > 5.0));
    }
}
