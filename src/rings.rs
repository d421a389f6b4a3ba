//! Rings: their optical depth and colour along the radius, and how they scatter and dim light.
//!
//! `shaders/planet_rings.wgsl` computes the same on the GPU, from the same entries.
//!
//! The rings are a plane layer so thin that only its optical depth matters. A ray that crosses it at an angle whose
//! sine is mu is dimmed by exp(-depth / mu). Single scattering by a plane layer is exact (Chandrasekhar, Radiative
//! Transfer, 1950, III.12); higher orders are a factor. Near the eye the layer resolves into pieces ([`Pieces`]).

mod pieces;

pub use pieces::{BLOCK_SHARE, FACETS_AT, MOST_CHANCE, Pieces, SIZE_CLASSES, SIZE_RATIO, SizeClass};

use crate::planet::{Planet, Rings};
use crate::terrain::curve_at;

/// Entries of the profile along the width.
pub const PROFILE_ENTRIES: usize = 128;
/// Octaves of the ringlets, each half as wide as the one before.
pub const RINGLET_OCTAVES: u32 = 7;
/// Amplitude of each octave as a share of the one before.
pub const RINGLET_GAIN: f64 = 0.78;
/// Factor for light that is scattered more than once; by eye, for bright ice.
pub const HIGHER_ORDERS: f64 = 1.5;
/// Mean cosine of the phase function of dust (Henyey and Greenstein).
pub const DUST_FORWARD: f64 = 0.82;

/// The profile of three rings with a division: faint, dense, division, medium.
const THREE_RINGS: &[[f64; 2]] = &[
    [0.0, 0.03],
    [0.06, 0.10],
    [0.26, 0.16],
    [0.275, 0.75],
    [0.40, 1.05],
    [0.55, 1.6],
    [0.66, 1.3],
    [0.675, 0.07],
    [0.735, 0.10],
    [0.75, 0.55],
    [0.985, 0.48],
    [1.0, 0.0],
];

/// The rings of a planet along the radius.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Radius of the inner edge, metres.
    pub inner_m: f64,
    /// Radius of the outer edge, metres.
    pub outer_m: f64,
    /// Red, green and blue of the pieces, and optical depth, in the middle of each entry from the inner edge.
    pub entries: Vec<[f64; 4]>,
    /// Contrast of the ringlets, 0 to 1.
    pub ringlets: f64,
    /// The widest ringlets in the whole width.
    pub ringlet_count: f64,
    /// Share of fine dust.
    pub dust: f64,
    /// Seed of the ringlets.
    pub seed: u32,
}

impl Profile {
    /// The profile of a planet; None without rings.
    pub fn new(planet: &Planet) -> Option<Self> {
        let rings = planet.rings.as_ref()?;
        let radius_m = planet.radius_m();
        let seed = planet.seed.wrapping_mul(0x9E37_79B9) ^ rings.seed;
        let clear = gaps(rings, seed);
        let entry = |index: usize| {
            let at = (index as f64 + 0.5) / PROFILE_ENTRIES as f64;
            let curve: &[[f64; 2]] = if rings.profile.is_empty() { THREE_RINGS } else { &rings.profile };
            let kept: f64 = clear.iter().map(|[middle, half]| smooth(((at - middle).abs() - half) / half)).product();
            let density = curve_at(curve, at).max(0.0) * kept;
            let color = |i: usize| rings.inner_color[i] + (rings.outer_color[i] - rings.inner_color[i]) * at;
            [color(0), color(1), color(2), density * rings.optical_depth]
        };
        Some(Self {
            inner_m: radius_m * rings.inner_radii,
            outer_m: radius_m * (rings.inner_radii + rings.width_radii),
            entries: (0..PROFILE_ENTRIES).map(entry).collect(),
            ringlets: rings.ringlets,
            ringlet_count: 1.0 / rings.ringlet_share,
            dust: rings.dust,
            seed,
        })
    }

    /// Red, green, blue and optical depth at a distance from the centre. `footprint_m`: width over which they are
    /// averaged.
    pub fn at(&self, radius_m: f64, footprint_m: f64) -> [f64; 4] {
        let width_m = self.outer_m - self.inner_m;
        let share = (radius_m - self.inner_m) / width_m;
        if !(0.0..=1.0).contains(&share) {
            return [0.0; 4];
        }
        // The mean of four places within the footprint: gaps are narrow.
        let mut mixed = [0.0; 4];
        for tap in 0..4 {
            let at = share + footprint_m / width_m * ((f64::from(tap) + 0.5) / 4.0 - 0.5);
            let place = (at * PROFILE_ENTRIES as f64 - 0.5).clamp(0.0, (PROFILE_ENTRIES - 1) as f64);
            let first = (place as usize).min(PROFILE_ENTRIES - 2);
            let between = place - first as f64;
            for (i, mean) in mixed.iter_mut().enumerate() {
                *mean += 0.25 * (self.entries[first][i] * (1.0 - between) + self.entries[first + 1][i] * between);
            }
        }
        mixed[3] *= self.ringlet(share, footprint_m / width_m);
        mixed
    }

    /// Factor of the ringlets on the optical depth; its mean is about 1.
    fn ringlet(&self, share: f64, footprint: f64) -> f64 {
        let (mut sum, mut amplitude, mut count) = (0.0, 0.62 * self.ringlets, self.ringlet_count);
        for octave in 0..RINGLET_OCTAVES {
            // Ringlets that are narrower than the footprint have their mean.
            let seen = 1.0 - smooth((count * footprint - 0.25) / 0.75);
            sum += amplitude * seen * self.noise(share * count, octave);
            amplitude *= RINGLET_GAIN;
            count *= 2.0;
        }
        (1.0 + sum).max(0.0)
    }

    /// Value noise along a line, -1 to 1.
    fn noise(&self, at: f64, octave: u32) -> f64 {
        let cell = at.floor();
        let value = |cell: f64| 2.0 * unit_hash(cell as u32, octave, self.seed) - 1.0;
        let (a, b) = (value(cell), value(cell + 1.0));
        a + (b - a) * smooth(at - cell)
    }

    /// Share of the light that crosses the rings at a distance from the centre. `mu`: sine of the angle of the ray to
    /// their plane.
    pub fn transmittance(&self, radius_m: f64, footprint_m: f64, mu: f64) -> f64 {
        libm::exp(-self.at(radius_m, footprint_m)[3] / mu.abs().max(1e-3))
    }

    /// Radiance of the rings for unit irradiance on a surface that faces the light. `mu`, `mu0`: sines of the angles of
    /// view and light to the plane, both positive. `lit`: whether the eye is on the side of the light. `cosine`: of the
    /// angle between the directions from the rings to the eye and of the light; 1 looks into the star.
    pub fn radiance(&self, at: [f64; 4], mu: f64, mu0: f64, lit: bool, cosine: f64) -> [f64; 3] {
        let (depth, mu, mu0) = (at[3], mu.max(1e-3), mu0.max(1e-3));
        let share = if lit {
            mu0 / (mu0 + mu) * (1.0 - libm::exp(-depth * (1.0 / mu + 1.0 / mu0)))
        } else {
            // The limit of equal angles has no other form: they are kept apart.
            let mu = if (mu - mu0).abs() < 1e-3 { mu0 + 1e-3 } else { mu };
            mu0 / (mu - mu0) * (libm::exp(-depth / mu) - libm::exp(-depth / mu0))
        };
        let phase = self.phase(cosine);
        std::array::from_fn(|i| at[i] * HIGHER_ORDERS * share.max(0.0) * phase)
    }

    /// Phase function: its integral over all directions is 1. Large pieces scatter as Lambert spheres, dust forwards.
    pub fn phase(&self, cosine: f64) -> f64 {
        use std::f64::consts::PI;
        let phase_rad = PI - libm::acos(cosine.clamp(-1.0, 1.0));
        let lambert = 8.0 / (3.0 * PI) * (libm::sin(phase_rad) + (PI - phase_rad) * libm::cos(phase_rad)) / (4.0 * PI);
        let g = DUST_FORWARD;
        let base = 1.0 + g * g - 2.0 * g * cosine;
        let dust = (1.0 - g * g) / (4.0 * PI * base * base.sqrt());
        lambert * (1.0 - self.dust) + dust * self.dust
    }
}

/// Middle and half width of each gap, as shares of the width.
fn gaps(rings: &Rings, seed: u32) -> Vec<[f64; 2]> {
    let random = |gap: u32, salt: u32| unit_hash(gap, 100 + salt, seed);
    (0..rings.gaps).map(|gap| [0.08 + 0.88 * random(gap, 0), 0.003 + 0.007 * random(gap, 1).powi(2)]).collect()
}

/// A smooth step from 0 to 1.
pub(crate) fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

/// A hash from 0 to 1: the first component of pcg3d, as `math.wgsl` has it.
fn unit_hash(x: u32, y: u32, z: u32) -> f64 {
    let mut v = [x, y, z].map(|c| c.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    let mix = |v: &mut [u32; 3]| {
        v[0] = v[0].wrapping_add(v[1].wrapping_mul(v[2]));
        v[1] = v[1].wrapping_add(v[2].wrapping_mul(v[0]));
        v[2] = v[2].wrapping_add(v[0].wrapping_mul(v[1]));
    };
    mix(&mut v);
    v = v.map(|c| c ^ (c >> 16));
    mix(&mut v);
    f64::from(v[0] >> 8) / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::STARTING_RINGS;

    fn profile(rings: Rings) -> Profile {
        Profile::new(&Planet { rings: Some(rings), ..Planet::default() }).unwrap()
    }

    #[test]
    fn rings_end_at_their_edges_and_have_the_depth_of_the_profile() {
        let rings = Rings { ringlets: 0.0, gaps: 0, profile: vec![[0.0, 1.0], [1.0, 1.0]], ..Rings::default() };
        let profile = profile(rings.clone());
        let radius_m = Planet::default().radius_m();
        assert_eq!(profile.at(radius_m * 1.2, 1.0)[3], 0.0);
        assert_eq!(profile.at(radius_m * 2.31, 1.0)[3], 0.0);
        let depth = profile.at(radius_m * 1.8, 1.0)[3];
        assert!((depth - rings.optical_depth).abs() < 1e-12, "{depth}");
        let through = profile.transmittance(radius_m * 1.8, 1.0, 0.5);
        assert!((through - (-2.0 * rings.optical_depth).exp()).abs() < 1e-12);
    }

    #[test]
    fn ringlets_have_the_mean_of_their_ring_and_fade_into_it() {
        let profile = profile(Rings { gaps: 0, profile: vec![[0.0, 1.0], [1.0, 1.0]], ..Rings::default() });
        let width_m = profile.outer_m - profile.inner_m;
        let depths: Vec<f64> =
            (0..20_000).map(|i| profile.at(profile.inner_m + width_m * (f64::from(i) + 0.5) / 2e4, 1.0)[3]).collect();
        let mean = depths.iter().sum::<f64>() / 2e4;
        assert!((mean / 1.1 - 1.0).abs() < 0.15, "{mean}");
        let spread = depths.iter().map(|depth| (depth / mean - 1.0).powi(2)).sum::<f64>() / 2e4;
        assert!(spread.sqrt() > 0.15, "{spread}");
        let blurred = profile.at(profile.inner_m + 0.4 * width_m, width_m)[3];
        assert!((blurred - 1.1).abs() < 1e-9, "{blurred}");
    }

    #[test]
    fn scattering_conserves_energy() {
        for starting in STARTING_RINGS {
            let profile = profile(starting.make());
            // Over all directions, the phase function has 1.
            let steps = 20_000;
            let sum: f64 =
                (0..steps).map(|i| profile.phase((f64::from(i) + 0.5) / f64::from(steps) * 2.0 - 1.0)).sum::<f64>()
                    * 4.0
                    * std::f64::consts::PI
                    / f64::from(steps);
            assert!((sum - 1.0).abs() < 0.01, "{}: {sum}", starting.name);
        }
    }

    #[test]
    fn the_unlit_side_is_dark_where_the_rings_are_dense() {
        let profile = profile(Rings::default());
        let light = |depth: f64, lit: bool| profile.radiance([1.0, 1.0, 1.0, depth], 0.5, 0.3, lit, -0.5)[0];
        assert!(light(3.0, true) > light(0.3, true) && light(3.0, false) < light(0.3, false));
        assert!(light(0.0, true) == 0.0 && light(1e-9, false).abs() < 1e-8);
        // Thin rings are as bright from both sides, but for the phase.
        assert!((light(1e-4, true) / light(1e-4, false) - 1.0).abs() < 0.01);
    }
}
