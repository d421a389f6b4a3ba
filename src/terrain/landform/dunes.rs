//! Dunes: phasor noise (Tricard et al. 2019), waves that run with the wind.
//!
//! Jittered points in 3D cells each emit a wave `e^iθ` along the wind at the point, which fades with distance. The
//! angle of the complex sum is a phase without seams. A profile over that phase has crests of equal height that fork
//! and end as those of real dunes do. Where the sum is 0 the phase is undefined; dunes fade out before.
//!
//! The points stand in two lattices of cubes, one in the gaps of the other (body-centred), so that they are spread
//! evenly. Reach and jitter are limited so that a wave reaches only the eight cells of its lattice nearest to a
//! point.

mod near;

use super::octaves::series;
use super::places::{CORNERS, Places, neighbour, unit};
use super::scratch::Vectors;
use super::varying::Around;
use super::{Arithmetic, Chunk, Evaluate, JETS, Scratch, Scratch64};
use crate::planet::{self, Key};
use crate::simd::for_each_simd;
use crate::terrain::approx;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::{self, Noise, Octave};
use crate::terrain::scalar::Scalar;
use crate::world::weather::Weather;
use glam::DVec3;
use std::f32::consts::TAU;
use std::sync::{Arc, Weak};

/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.2;
/// Wavelengths per cell: more make longer, straighter crests.
const WAVES: f32 = 2.2;
/// Reach of a wave, in cells.
const REACH: f32 = 0.75;
/// Greatest distance of a point from the centre of its cell along each axis, in cells. REACH + JITTER <= 1.
const JITTER: f32 = 0.25;
/// The squared sum at which dunes have half their height; its mean is about 0.24.
const FAINT: f32 = 0.03;
/// Wavelengths per cell of the noise that bends the crests.
const BENDS: f64 = 3.0;
/// Wind in m/s below which its direction steers dunes less.
const CALM_M_S: f64 = 0.4;
/// Points per wavelength at which dunes show in full.
const LEAST_POINTS: f64 = 4.0;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Dunes {
    sizes: Vec<Size>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
    wind: Wind,
    /// The wind of the planet's weather, if the dunes follow it.
    weather: Option<Solved>,
    profile: Profile,
    /// How far noise bends the crests, in wavelengths.
    waviness: f32,
}

/// Dunes of one size.
#[derive(Clone, Debug, PartialEq)]
struct Size {
    wavelength_rad: f64,
    lattices: [Octave; 2],
    bends: Octave,
    weight: f32,
}

/// The heading that the wind blows to: its east and north components.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Wind {
    east: f32,
    north: f32,
}

impl Wind {
    /// Its direction at a point; 0 at the poles.
    #[inline(always)]
    fn at<S: Scalar>(self, [x, y, z]: [S; 3]) -> [S; 3] {
        let flat = x * x + y * y;
        let part = S::of(1.0) / flat.max(S::of(1e-20)).sqrt();
        let (east, north) = (S::from_f32(self.east) * part, S::from_f32(self.north) * part);
        [-(east * y) - north * (z * x), east * x - north * (z * y), north * flat]
    }
}

/// The wind of a weather. Fields of earlier revisions must not keep it alive, so it is weak.
#[derive(Clone, Debug, Default)]
struct Solved {
    key: Option<Key>,
    weather: Weak<Weather>,
}

impl PartialEq for Solved {
    fn eq(&self, other: &Self) -> bool {
        self.key == other.key
    }
}

/// The wind at the points of a chunk.
#[derive(Clone, Copy)]
enum Winds<'a, S> {
    /// The same heading everywhere.
    Heading(Wind),
    Solved(&'a Vectors<S>),
}

impl Solved {
    /// Writes the direction of the wind at the points of a chunk; shorter where the air is calm, so that dunes grow
    /// longer there instead of turning at once. None without a weather.
    fn find(&self, chunk: &Chunk<'_>, wind: &mut Vectors<f64>) -> Option<()> {
        let weather = self.weather.upgrade()?;
        for (i, dir) in chunk.dirs.iter().enumerate() {
            let speed = weather.wind_at(*dir);
            let along = speed / (speed.length_squared() + CALM_M_S * CALM_M_S).sqrt();
            wind.0.iter_mut().zip(along.to_array()).for_each(|(lane, along)| lane[i] = along);
        }
        Some(())
    }
}

impl Dunes {
    /// Whether they follow the wind of the planet's weather.
    pub(super) fn follows_wind(&self) -> bool {
        self.weather.is_some()
    }

    /// The same dunes under this weather.
    pub(super) fn over(&self, weather: Option<(Key, &Arc<Weather>)>) -> Self {
        let solved = weather.map(|(key, weather)| Solved { key: Some(key), weather: Arc::downgrade(weather) });
        Self { weather: Some(solved.unwrap_or_default()), ..self.clone() }
    }

    pub(super) fn new(params: &planet::Dunes, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Dunes { wavelength_km, octaves, gain, lacunarity, wind_deg, follow_wind, asymmetry, waviness } =
            *params;
        let sizes: Vec<Size> = series(seed, radius_km / wavelength_km, octaves, gain, lacunarity)
            .into_iter()
            .map(|wave| {
                let lattice = |frequency: f64, shift: f64, salt: u32| Octave {
                    frequency,
                    offset: wave.octave.offset.map(|offset| offset + shift),
                    seed: noise::scramble(wave.octave.seed.wrapping_add(salt)),
                };
                let frequency = wave.octave.frequency;
                let cells = frequency / f64::from(WAVES);
                Size {
                    wavelength_rad: 1.0 / frequency,
                    lattices: [lattice(cells, 0.0, 1), lattice(cells, 0.5, 2)],
                    bends: lattice(frequency / BENDS, 0.0, 3),
                    weight: wave.weight,
                }
            })
            .collect();
        let (east, north) = libm::sincos(wind_deg.to_radians());
        Self {
            f64_octaves: arithmetic.f64_count(sizes.iter().map(|size| size.weight), REST),
            sizes,
            wind: Wind { east: east as f32, north: north as f32 },
            weather: follow_wind.then(Solved::default),
            profile: Profile::new(asymmetry as f32),
            waviness: waviness as f32,
        }
    }
}

impl Evaluate for Dunes {
    fn octave_count(&self) -> usize {
        self.sizes.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.001, 1.001)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        if self.follows_wind() {
            return self.bounds();
        }
        let around = Around::new(dir_planet, angle_rad);
        self.sizes.iter().fold((-5e-5, 5e-5), |(lo, hi), size| {
            let (low, high) = size.near(around, self).range();
            (lo + low * f64::from(size.weight), hi + high * f64::from(size.weight))
        })
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets, places, wind, in_f64, .. } = scratch;
        let Scratch64 { noise: noise64, jets: jets64, places: places64, wind: wind64, .. } = in_f64;
        let solved = self.weather.as_ref().and_then(|solved| solved.find(chunk, wind64));
        if solved.is_some() {
            for (lane, exact) in wind.0.iter_mut().flatten().zip(wind64.0.iter().flatten()) {
                *lane = *exact as f32;
            }
        }
        let winds = solved.map_or(Winds::Heading(self.wind), |()| Winds::Solved(wind));
        let winds64 = solved.map_or(Winds::Heading(self.wind), |()| Winds::Solved(wind64));
        for (k, size) in self.sizes.iter().enumerate() {
            let fades = chunk.fades(size.wavelength_rad, LEAST_POINTS);
            if chunk.skips(&fades) {
                break;
            }
            let unseen = fades.is_unseen();
            let is_f64 = k < chunk.f64_octaves(self.f64_octaves);
            if is_f64 {
                noise64.values(chunk.simd, chunk.skewed, &size.bends);
                let dunes = self.octave::<f64>(chunk, size, noise64, winds64, places64, jets64);
                sums.add_f64(chunk, &dunes.value, f64::from(size.weight));
                if unseen {
                    continue;
                }
            }
            let evaluate = if unseen {
                noise.values(chunk.simd, chunk.skewed, &size.bends);
                Self::octave::<f32>
            } else {
                noise.gradients(chunk.simd, chunk.skewed, &size.bends);
                Self::octave::<Jet>
            };
            let dunes = evaluate(self, chunk, size, noise, winds, places, jets);
            if is_f64 {
                sums.add_gradients(chunk, &dunes.gradient, size.weight, &fades);
            } else {
                sums.add(chunk, &dunes.value, &dunes.gradient, size.weight, &fades);
            }
        }
    }
}

impl Dunes {
    /// The height of dunes of one size, whose crests the noise bends.
    fn octave<'j, R: Real>(
        &self,
        chunk: &Chunk<'_>,
        size: &Size,
        bends: &Noise<R::S>,
        wind: Winds<'_, R::S>,
        places: &mut Places<R::S>,
        jets: &'j mut [Jets<R::S>; JETS],
    ) -> &'j Jets<R::S> {
        let [re, im, dunes, ..] = jets;
        let (simd, n) = (chunk.simd, chunk.len());
        re.fill(n, R::S::default());
        im.fill(n, R::S::default());
        for octave in &size.lattices {
            places.find(simd, chunk.skewed, octave);
            for corner in CORNERS {
                send::<R>(simd, n, places, corner, octave, wind, re, im);
            }
        }
        pile::<R>(simd, n, re, im, bends, self.waviness, self.profile, dunes);
        dunes
    }
}

/// The wave that the point of one cell emits.
struct Wave<S> {
    /// Vector from the evaluated point to it, in cells.
    to: [S; 3],
    /// Direction of the wind there.
    along: [S; 3],
    /// Its phase there, in turns.
    start: S,
}

/// The wave of one cell around the `i`th point.
#[inline(always)]
fn wave<S: Scalar>(
    places: &Places<S>,
    corner: [i32; 3],
    octave: &Octave,
    wind: impl Fn([S; 3]) -> [S; 3],
    i: usize,
) -> Wave<S> {
    let (low, span) = (S::from_f32(0.5 - JITTER), S::from_f32(2.0 * JITTER));
    let (cell, step) = neighbour(places, corner, i);
    let random = noise::cell_hash(cell, octave.seed);
    let towards = |axis: usize, bits: u32| step[axis] + low + span * unit(bits) - places.fraction[axis][i];
    let to = [towards(0, random), towards(1, random >> 10), towards(2, random >> 20)];
    let cell_rad = S::of(1.0 / octave.frequency);
    let from = |axis: usize| places.dir[axis][i] + to[axis] * cell_rad;
    let along = wind([from(0), from(1), from(2)]);
    Wave { to, along, start: unit(noise::scramble(random)) }
}

/// Adds the waves of one of the eight cells to the real and the imaginary part.
#[inline(always)]
fn send_body<R: Real>(
    n: usize,
    places: &Places<R::S>,
    corner: [i32; 3],
    octave: &Octave,
    wind: Winds<'_, R::S>,
    re: &mut Jets<R::S>,
    im: &mut Jets<R::S>,
) {
    match wind {
        Winds::Heading(wind) => send_along::<R>(n, places, corner, octave, |_, from| wind.at(from), re, im),
        // It varies so slowly that it is the same where the waves come from.
        Winds::Solved(Vectors([x, y, z])) => {
            send_along::<R>(n, places, corner, octave, |i, _| [x[i], y[i], z[i]], re, im);
        }
    }
}

/// `wind`: its direction for the `i`th point and a wave from a place.
#[inline(always)]
fn send_along<R: Real>(
    n: usize,
    places: &Places<R::S>,
    corner: [i32; 3],
    octave: &Octave,
    wind: impl Fn(usize, [R::S; 3]) -> [R::S; 3],
    re: &mut Jets<R::S>,
    im: &mut Jets<R::S>,
) {
    let of = R::S::of;
    let (one, scale) = (of(1.0), R::S::from_f32);
    let frequency = of(octave.frequency);
    for i in 0..n.min(CHUNK) {
        let Wave { to, along, start } = wave(places, corner, octave, |from| wind(i, from), i);
        let square = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
        let near = (one - square * scale(1.0 / (REACH * REACH))).max(of(0.0));
        let weight = near * near * near;

        let waves = (to[0] * along[0] + to[1] * along[1] + to[2] * along[2]) * scale(WAVES);
        let (sin, cos) = approx::sin_cos(start - waves);
        let fall = near * near * scale(6.0 / (REACH * REACH)) * frequency;
        let turn = weight * scale(TAU * WAVES) * frequency;
        let part = |value: R::S, other: R::S| {
            let slope = |axis: usize| fall * value * to[axis] + turn * other * along[axis];
            R::of(weight * value, [slope(0), slope(1), slope(2)])
        };
        (R::load(re, i) + part(cos, -sin)).store(re, i);
        (R::load(im, i) + part(sin, cos)).store(im, i);
    }
}
for_each_simd!(fn send<R: Real>(n: usize, places: &Places<R::S>, corner: [i32; 3], octave: &Octave, wind: Winds<'_, R::S>, re: &mut Jets<R::S>, im: &mut Jets<R::S>) = send_body);

/// The height of dunes, from the sum of waves and the noise that bends them.
#[inline(always)]
fn pile_body<R: Real>(
    n: usize,
    re: &Jets<R::S>,
    im: &Jets<R::S>,
    bends: &Noise<R::S>,
    waviness: f32,
    profile: Profile,
    dunes: &mut Jets<R::S>,
) {
    for i in 0..n.min(CHUNK) {
        let (re, im) = (R::load(re, i), R::load(im, i));
        let square = re.square() + im.square();
        let strength = square * square.plus(FAINT).recip();
        let phase = approx::atan2(im, re) + R::noise(bends, i).scale(waviness);
        (profile.height(phase) * strength).plus(-1.0).store(dunes, i);
    }
}
for_each_simd!(fn pile<R: Real>(n: usize, re: &Jets<R::S>, im: &Jets<R::S>, bends: &Noise<R::S>, waviness: f32, profile: Profile, dunes: &mut Jets<R::S>) = pile_body);

/// The cross-section of a dune along the wind.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Profile {
    /// Share of the wavelength that faces the wind.
    windward: f32,
    /// Sharpness of the crest on the lee side: at 0 it is as round as the windward side.
    brink: f32,
}

impl Profile {
    fn new(asymmetry: f32) -> Self {
        Self { windward: 0.5 + 0.3 * asymmetry, brink: asymmetry }
    }

    /// The height over the trough, 0 to 2, at a phase in turns: the windward side rises to the crest, the lee falls.
    #[inline(always)]
    fn height<R: Real>(self, phase: R) -> R {
        let (height, slope) = self.section(phase.value());
        phase.chain(height, slope)
    }

    /// The height and its slope.
    #[inline(always)]
    fn section<S: Scalar>(self, turns: S) -> (S, S) {
        let of = S::of;
        let (zero, one, two) = (of(0.0), of(1.0), of(2.0));
        let wrapped = approx::wrap(turns);
        let t = if wrapped < zero { wrapped + one } else { wrapped };
        let up = t < S::from_f32(self.windward);
        let run = S::from_f32(if up { 1.0 / self.windward } else { -1.0 / (1.0 - self.windward) });
        let s = (if up { t * run } else { (t - one) * run }).clamp(zero, one);
        let round = S::from_f32(1.0 - if up { 0.0 } else { self.brink });
        // From round, s^2 (3 - 2 s), to sharp, s^2.
        let height = two * s * s * (one + round * two * (one - s));
        let slope = of(4.0) * s * (one + round * (two - of(3.0) * s));
        (height, slope * run)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Landform;
    use super::super::tests::{directions, gradients};
    use super::*;
    use crate::sphere::geo::east_north;

    /// With the wind the ground rises gently most of the way and falls steeply.
    #[test]
    fn the_lee_is_steep_and_lies_where_the_wind_blows_to() {
        for heading_deg in [0.0, 90.0, 200.0] {
            let params =
                planet::Dunes { wavelength_km: 300.0, octaves: 1, wind_deg: heading_deg, ..Default::default() };
            let dirs = directions(4000);
            let landform = Landform::Dunes(Dunes::new(&params, 7, 6371.0, Arithmetic::Fine));
            let (mut rising, mut steepest_rise, mut steepest_fall) = (0, 0.0_f64, 0.0_f64);
            for (dir, gradient) in dirs.iter().zip(gradients(&landform, &dirs)).filter(|(dir, _)| dir.z.abs() < 0.9) {
                let (east, north) = east_north(*dir);
                let (sin, cos) = f64::to_radians(heading_deg).sin_cos();
                let rise = gradient.dot(east * sin + north * cos);
                rising += u32::from(rise > 0.0);
                steepest_rise = steepest_rise.max(rise);
                steepest_fall = steepest_fall.max(-rise);
            }
            assert!(rising > 2300, "{heading_deg}: {rising}");
            assert!(steepest_fall > 1.5 * steepest_rise, "{heading_deg}: {steepest_fall} {steepest_rise}");
        }
    }
}
