//! Ranks of clouds and veil at directions and times.

use super::cover::{CloudCover, Targets, cover, offset};
use super::ranks::Ranks;
use super::swirl::{Noises, Swirls};
use super::systems::{Climate, Effect, System, alive};
use crate::planet::{Planet, Rotation};
use crate::sphere::spread;
use crate::terrain::Terrain;
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;
use crate::world::EARTH_KM;
use crate::world::weather::Weather;
use glam::DVec3;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Time between two keyframes: cyclones move by less than a texel.
pub(super) const KEYFRAME_SECS: f64 = 3600.0;
/// Directions from which the distribution of the noise is known.
const SAMPLES: usize = 4096;
/// Directions whose target covers make the mean.
const ODDS: usize = 1024;
/// Scale of the weather systems on the Earth, km: the default of the preset.
const EARTH_SCALE_KM: f64 = 2500.0;
/// The finest octave, cells along the radius: a cube map of 512 texels shows it.
const FINEST: f64 = 102.0;
/// How much cyclones add to the veil, of what they add to the clouds.
const OUTFLOW: f64 = 0.5;

/// The clouds of a planet: where they are at any time. Cheap to clone the handle of, immutable.
#[derive(Clone)]
pub struct CloudField {
    swirls: Swirls,
    climate: Climate,
    ranks: [Ranks; 2],
    targets: Targets,
    weather: Option<Arc<Weather>>,
    /// Shares of the sky that clouds and veil cover, and the offsets of their log-odds.
    coverage: [f64; 2],
    offsets: [f64; 2],
    /// Drift about the pole, radians a second.
    drift_rad_s: f64,
    /// Log-odds at directions of equal areas.
    odds: Vec<f64>,
}

/// Ranks at a direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ranked {
    pub(super) low: f32,
    pub(super) veil: f32,
    /// Share of layered cloud: the rest is heaped up.
    pub(super) layered: f32,
}

impl std::fmt::Debug for CloudField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("CloudField")
    }
}

impl CloudField {
    /// The clouds of a terrain's planet, with the weather of its structure if that is solved. Without clouds, a field
    /// whose cover is 0.
    pub fn new(terrain: &Terrain) -> Self {
        Self::with(terrain.planet(), terrain.weather().cloned())
    }

    pub(crate) fn with(planet: &Planet, weather: Option<Arc<Weather>>) -> Self {
        let clouds = planet.clouds.clone().unwrap_or_default();
        let seed = clouds.seed ^ planet.seed.rotate_left(16);
        let cells = (planet.radius_km / clouds.scale_km).min(FINEST);
        let westward = planet.structure.as_ref().is_some_and(|s| s.weather.rotation == Rotation::Westward);
        let scale = clouds.scale_km / EARTH_SCALE_KM * (EARTH_KM / planet.radius_km);
        let climate = Climate { seed, scale, strength: clouds.storms, westward };
        let targets = Targets::new(planet, weather.as_deref());
        let none = Ranks::of(&mut []);
        let mut field = Self {
            swirls: Swirls::new(seed, cells, clouds.curl, FINEST),
            climate,
            ranks: [none.clone(), none],
            odds: spread(ODDS).map(|dir| targets.odds(weather.as_deref(), dir)).collect(),
            targets,
            weather,
            coverage: [f64::NAN; 2],
            offsets: [0.0; 2],
            drift_rad_s: clouds.wind_km_h / 3600.0 / planet.radius_km,
        };
        let coverage = planet.clouds.as_ref().map_or([0.0; 2], |clouds| [clouds.coverage, clouds.veil]);
        field.set_coverage(coverage);
        let (mut low, mut veil) = (Vec::with_capacity(SAMPLES), Vec::with_capacity(SAMPLES));
        let systems = alive(&field.climate, 0.0);
        let dirs: Vec<DVec3> = spread(SAMPLES).collect();
        let mut noise = Box::<Noise>::default();
        for dirs in dirs.chunks(CHUNK) {
            field.values(dirs, 0.0, &systems, &mut noise, |_, value, _| {
                low.push(value.low);
                veil.push(value.veil);
            });
        }
        field.ranks = [Ranks::of(&mut low), Ranks::of(&mut veil)];
        field
    }

    /// Clouds over a direction, `time_secs` after time zero: those that are drawn.
    pub fn cover(&self, dir_planet: DVec3, time_secs: f64) -> CloudCover {
        let (before, share) = keyframes(time_secs);
        let angle = self.drift_rad(time_secs);
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let dir = crate::terrain::points::unit(dir_planet);
        let drifted = DVec3::new(c * dir.x + s * dir.y, c * dir.y - s * dir.x, dir.z);
        let at = |number: i64| {
            let mut found = Ranked::default();
            self.ranked(&[drifted], number, &self.systems(number), &mut Box::default(), |_, ranked| found = ranked);
            found
        };
        let (a, b) = (at(before), at(before + 1));
        let blend = |a: f32, b: f32| f64::from(a) + (f64::from(b) - f64::from(a)) * share;
        let odds = self.odds(dir);
        let covered = |k: usize, rank: f64| match self.coverage[k] > 0.0 {
            true => cover(rank, odds + self.offsets[k]),
            false => 0.0,
        };
        let (low, veil) = (covered(0, blend(a.low, b.low)), covered(1, blend(a.veil, b.veil)));
        CloudCover { low, veil }
    }

    /// Angle by which the wind has carried all clouds to the east.
    pub(crate) fn drift_rad(&self, time_secs: f64) -> f64 {
        (self.drift_rad_s * time_secs).rem_euclid(TAU)
    }

    /// Offsets of the log-odds of the target cover with which the mean covers of clouds and veil are those asked for.
    #[cfg(any(feature = "render", test))]
    pub(crate) fn offsets(&self) -> [f64; 2] {
        self.offsets
    }

    /// Shares of the sky that clouds and veil cover.
    #[cfg(feature = "render")]
    pub(crate) fn coverage(&self) -> [f64; 2] {
        self.coverage
    }

    /// Other shares of clouds and veil: they decide neither ranks nor log-odds.
    pub(crate) fn set_coverage(&mut self, coverage: [f64; 2]) {
        if self.coverage != coverage {
            self.offsets = coverage.map(|coverage| offset(&self.odds, coverage));
            self.coverage = coverage;
        }
    }

    /// Log-odds of the target cover without the offset.
    pub(super) fn odds(&self, dir: DVec3) -> f64 {
        self.targets.odds(self.weather.as_deref(), dir)
    }

    /// The solved weather, and its share.
    #[cfg(feature = "render")]
    pub(super) fn weather(&self) -> Option<&Weather> {
        self.weather.as_deref()
    }

    /// The systems of a keyframe.
    pub(super) fn systems(&self, number: i64) -> Vec<System> {
        alive(&self.climate, days_of(number))
    }

    /// Ranks of a keyframe at up to [`CHUNK`] directions that the wind has carried. `systems`: those that reach them.
    pub(super) fn ranked(
        &self,
        dirs: &[DVec3],
        number: i64,
        systems: &[System],
        noise: &mut Noise,
        mut out: impl FnMut(usize, Ranked),
    ) {
        self.values(dirs, days_of(number), systems, noise, |i, value, layered| {
            let [low, veil] = [self.ranks[0].rank(value.low), self.ranks[1].rank(value.veil)];
            out(i, Ranked { low, veil, layered });
        });
    }

    fn values(
        &self,
        dirs: &[DVec3],
        days: f64,
        systems: &[System],
        noise: &mut Noise,
        mut out: impl FnMut(usize, Noises, f32),
    ) {
        let effects: Vec<Effect> = dirs
            .iter()
            .map(|&dir| {
                let mut effect = Effect { dir, extra: 0.0, layered: 0.0 };
                systems.iter().for_each(|system| system.act(&mut effect));
                effect
            })
            .collect();
        let unwound: Vec<DVec3> = effects.iter().map(|effect| effect.dir).collect();
        let mut noises = [Noises::default(); CHUNK];
        self.swirls.evaluate(&unwound, days, noise, &mut noises);
        for (i, (effect, mut value)) in effects.iter().zip(noises).enumerate() {
            value.low += effect.extra as f32;
            value.veil += (OUTFLOW * effect.extra.max(-1.0)) as f32;
            // Heaps in the tropics, layers towards the poles and in cyclones.
            let polar = (dirs[i].z * dirs[i].z * 1.6).min(1.0);
            out(i, value, effect.layered.max(0.7 * polar) as f32);
        }
    }

    #[cfg(test)]
    pub(super) fn with_simd(mut self, simd: crate::simd::Simd) -> Self {
        self.swirls = self.swirls.with_simd(simd);
        self
    }
}

/// The keyframe before a time, and the share of the next one.
pub(crate) fn keyframes(time_secs: f64) -> (i64, f64) {
    let at = time_secs / KEYFRAME_SECS;
    (at.floor() as i64, at - at.floor())
}

fn days_of(number: i64) -> f64 {
    number as f64 * (KEYFRAME_SECS / 86_400.0)
}
