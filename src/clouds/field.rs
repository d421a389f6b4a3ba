//! Ranks of the layers of clouds at directions and times.

use super::cover::{CloudCover, Targets, cover, offset};
use super::ranks::Ranks;
use super::swirl::{Noises, Swirls};
use super::systems::{Climate, Effect, System, alive};
use crate::planet::{Clouds, Rotation};
use crate::sphere::spread;
use crate::terrain::edits::{Edits, Near, Subject};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;
use crate::terrain::{Revision, Terrain};
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
/// How much cyclones add to the middle clouds and the veil, of what they add to the low clouds.
const SHIELD: f64 = 0.8;
const OUTFLOW: f64 = 0.5;
/// Low clouds, middle clouds, veil and fog.
pub(crate) const LAYERS: usize = 4;

/// The clouds of a planet: where they are at any time. Cheap to clone the handle of, immutable.
#[derive(Clone)]
pub struct CloudField {
    swirls: Swirls,
    climate: Climate,
    ranks: [Ranks; LAYERS],
    targets: Targets,
    weather: Option<Arc<Weather>>,
    /// Edits that paint clouds.
    paint: Option<Arc<Edits>>,
    /// Shares of the sky that the layers cover, and the offsets of their log-odds.
    coverage: [f64; LAYERS],
    offsets: [f64; LAYERS],
    /// Drift about the pole, radians a second.
    drift_rad_s: f64,
    /// Log-odds of clouds and of fog at directions of equal areas.
    odds: [Vec<f64>; 2],
}

/// Ranks at a direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Ranked {
    pub(super) low: f32,
    pub(super) middle: f32,
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
        Self::with(terrain.revision(), terrain.weather().cloned())
    }

    pub(crate) fn with(revision: &Revision, weather: Option<Arc<Weather>>) -> Self {
        let planet = revision.planet();
        let clouds = planet.clouds.clone().unwrap_or_default();
        let seed = clouds.seed ^ planet.seed.rotate_left(16);
        let cells = (planet.radius_km / clouds.scale_km).min(FINEST);
        let westward = planet.structure.as_ref().is_some_and(|s| s.weather.rotation == Rotation::Westward);
        let scale = clouds.scale_km / EARTH_SCALE_KM * (EARTH_KM / planet.radius_km);
        let climate = Climate { seed, scale, strength: clouds.storms, cyclones: clouds.cyclones, westward };
        let targets = Targets::new(planet, weather.as_deref());
        let none = Ranks::of(&mut []);
        let mut field = Self {
            swirls: Swirls::new(seed, cells, clouds.curl, FINEST, clouds.middle > 0.0),
            climate,
            ranks: std::array::from_fn(|_| none.clone()),
            odds: [
                spread(ODDS).map(|dir| targets.odds(weather.as_deref(), dir)).collect(),
                spread(ODDS).map(|dir| targets.fog_odds(weather.as_deref(), dir)).collect(),
            ],
            targets,
            weather,
            paint: None,
            coverage: [f64::NAN; LAYERS],
            offsets: [0.0; LAYERS],
            drift_rad_s: clouds.wind_km_h / 3600.0 / planet.radius_km,
        };
        field.set_coverage(planet.clouds.as_ref().map_or([0.0; LAYERS], coverages));
        field.set_paint(revision);
        let mut samples: [Vec<f32>; LAYERS] = std::array::from_fn(|_| Vec::with_capacity(SAMPLES));
        let systems = alive(&field.climate, 0.0);
        let dirs: Vec<DVec3> = spread(SAMPLES).collect();
        let mut noise = Box::<Noise>::default();
        for dirs in dirs.chunks(CHUNK) {
            field.values(dirs, 0.0, &systems, &mut noise, |_, value, _| {
                for (layer, value) in [value.low, value.middle, value.veil].into_iter().enumerate() {
                    samples[layer].push(value);
                }
            });
            field.swirls.fog(dirs, &mut noise, |_, value| samples[3].push(value));
        }
        field.ranks = samples.each_mut().map(|samples| Ranks::of(samples));
        field
    }

    /// Clouds over a direction, `time_secs` after time zero: those that are drawn.
    pub fn cover(&self, dir_planet: DVec3, time_secs: f64) -> CloudCover {
        self.covers(&[dir_planet], time_secs).pop().unwrap_or_default()
    }

    /// [`CloudField::cover`] of many directions, on the calling thread.
    pub fn covers(&self, dirs_planet: &[DVec3], time_secs: f64) -> Vec<CloudCover> {
        let (before, share) = keyframes(time_secs);
        let angle = self.drift_rad(time_secs);
        let (s, c) = (libm::sin(angle), libm::cos(angle));
        let systems = [before, before + 1].map(|number| self.systems(number));
        let blend = |a: f32, b: f32| f64::from(a) + (f64::from(b) - f64::from(a)) * share;
        let covered = |k: usize, rank: f64, odds: f64| match self.coverage[k] > 0.0 {
            true => cover(rank, odds + self.offsets[k]),
            false => 0.0,
        };
        let (mut noise, mut near) = (Box::<Noise>::default(), Near::default());
        let mut found = Vec::with_capacity(dirs_planet.len());
        for dirs in dirs_planet.chunks(CHUNK) {
            let dirs: Vec<DVec3> = dirs.iter().map(|&dir| crate::terrain::points::unit(dir)).collect();
            let drifted = |dir: &DVec3| DVec3::new(c * dir.x + s * dir.y, c * dir.y - s * dir.x, dir.z);
            let drifted: Vec<DVec3> = dirs.iter().map(drifted).collect();
            let mut ranks = [[Ranked::default(); CHUNK]; 2];
            for ((ranks, systems), number) in ranks.iter_mut().zip(&systems).zip(before..) {
                self.ranked(&drifted, number, systems, &mut noise, |i, ranked| ranks[i] = ranked);
            }
            let mut painted = [0.0; CHUNK];
            self.painted(&dirs, &mut near, |i, odds| painted[i] += odds);
            let mut fog_ranks = [0.0; CHUNK];
            self.fog_ranks(&dirs, &mut noise, |i, rank| fog_ranks[i] = f64::from(rank));
            for (i, &dir) in dirs.iter().enumerate() {
                let (a, b, odds) = (ranks[0][i], ranks[1][i], self.odds(dir) + painted[i]);
                found.push(CloudCover {
                    low: covered(0, blend(a.low, b.low), odds),
                    middle: covered(1, blend(a.middle, b.middle), odds),
                    veil: covered(2, blend(a.veil, b.veil), odds),
                    fog: covered(3, fog_ranks[i], self.fog_odds(dir)),
                });
            }
        }
        found
    }

    /// Angle by which the wind has carried all clouds to the east.
    pub(crate) fn drift_rad(&self, time_secs: f64) -> f64 {
        (self.drift_rad_s * time_secs).rem_euclid(TAU)
    }

    /// Offsets of the log-odds of the target cover with which the mean covers of the layers are those asked for.
    #[cfg(any(feature = "render", test))]
    pub(crate) fn offsets(&self) -> [f64; LAYERS] {
        self.offsets
    }

    /// Shares of the sky that the layers cover.
    #[cfg(feature = "render")]
    pub(crate) fn coverage(&self) -> [f64; LAYERS] {
        self.coverage
    }

    /// Whether ranks of middle clouds are there.
    #[cfg(feature = "render")]
    pub(crate) fn has_middle(&self) -> bool {
        self.swirls.has_middle()
    }

    /// Other shares of the layers: they decide neither ranks nor log-odds.
    pub(crate) fn set_coverage(&mut self, coverage: [f64; LAYERS]) {
        if self.coverage != coverage {
            let [clouds, fog] = &self.odds;
            self.offsets = std::array::from_fn(|k| offset(if k == 3 { fog } else { clouds }, coverage[k]));
            self.coverage = coverage;
        }
    }

    /// The painted clouds of a planet in the place of those before. They change nothing beyond the strokes.
    pub(crate) fn set_paint(&mut self, revision: &Revision) {
        self.paint = revision.edits().filter(|edits| edits.key(Subject::Clouds).is_some()).cloned();
    }

    /// By how much paint changes the log-odds of the target cover at directions: calls `each` with the number of a
    /// direction and the change.
    pub(super) fn painted(&self, dirs: &[DVec3], near: &mut Near, each: impl FnMut(usize, f64)) {
        if let Some(paint) = &self.paint {
            paint.clouded(dirs, near, each);
        }
    }

    /// Log-odds of the target cover without the offset and without paint.
    pub(super) fn odds(&self, dir: DVec3) -> f64 {
        self.targets.odds(self.weather.as_deref(), dir)
    }

    /// Log-odds of the target cover of fog without the offset.
    pub(super) fn fog_odds(&self, dir: DVec3) -> f64 {
        self.targets.fog_odds(self.weather.as_deref(), dir)
    }

    /// Ranks of fog at up to [`CHUNK`] directions. Fog stays where it is.
    pub(super) fn fog_ranks(&self, dirs: &[DVec3], noise: &mut Noise, mut out: impl FnMut(usize, f32)) {
        self.swirls.fog(dirs, noise, |i, value| out(i, self.ranks[3].rank(value)));
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
            let [low, middle, veil] =
                [(0, value.low), (1, value.middle), (2, value.veil)].map(|(k, value)| self.ranks[k].rank(value));
            out(i, Ranked { low, middle, veil, layered });
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
                let mut effect = Effect::default();
                systems.iter().for_each(|system| system.act(dir, &mut effect));
                effect
            })
            .collect();
        let unwound: Vec<DVec3> =
            dirs.iter().zip(&effects).map(|(dir, effect)| (*dir + effect.moved).normalize()).collect();
        let mut noises = [Noises::default(); CHUNK];
        self.swirls.evaluate(&unwound, days, noise, &mut noises);
        for (i, (effect, mut value)) in effects.iter().zip(noises).enumerate() {
            value.low += effect.extra as f32;
            value.middle += (SHIELD * effect.extra) as f32;
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

/// Shares of the sky that the layers of clouds cover.
pub(crate) fn coverages(clouds: &Clouds) -> [f64; LAYERS] {
    [clouds.coverage, clouds.middle, clouds.veil, clouds.fog]
}

/// The keyframe before a time, and the share of the next one.
pub(crate) fn keyframes(time_secs: f64) -> (i64, f64) {
    let at = time_secs / KEYFRAME_SECS;
    (at.floor() as i64, at - at.floor())
}

fn days_of(number: i64) -> f64 {
    number as f64 * (KEYFRAME_SECS / 86_400.0)
}
