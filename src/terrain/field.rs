//! Layer fields: a layer's noise and its gradient at a batch of points, before amplitude, blend and masks.
//!
//! Values hold every octave, always: the height that is drawn is the height that is queried. Gradients come in two bands
//! for shading, each octave faded out as its wavelength nears the spacing of the points ([`Bands`]): a tile shows no relief
//! that it cannot carry, and next to it what its parent would show.

use super::craters;
use super::noise::{self, Octave};
use super::points::Points;
use super::simd::{Simd, for_each_simd};
use crate::planet::{Craters, Fbm, Layer, Ridged, Shape};

/// Points worked on at a time: small enough for all arrays to stay in the first-level cache.
const CHUNK: usize = 256;

/// A layer's noise, compiled: everything its values depend on, and nothing else. Equal shapes give equal fields.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct NoiseShape {
    octaves: Vec<Octave>,
    /// Strength of each octave.
    weights: Vec<f32>,
    kind: Kind,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Fbm,
    Ridged { feedback: f32 },
    Craters { density: f32 },
}

impl Kind {
    /// Scale and shift from the sum of octaves to -1..1: ridged octaves sum to 0..1.
    fn stretch(self) -> (f64, f64) {
        if matches!(self, Kind::Ridged { .. }) { (2.0, -1.0) } else { (1.0, 0.0) }
    }
}

/// The spacings (as angles, radians) for which gradients are wanted: a tile's own and its parent's. Zero keeps every octave.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bands {
    pub(crate) own_spacing_rad: f64,
    pub(crate) parent_spacing_rad: f64,
}

impl Bands {
    /// Every octave in full, for queries.
    pub(crate) const EXACT: Bands = Bands { own_spacing_rad: 0.0, parent_spacing_rad: 0.0 };
}

/// Three components, each an array.
pub(crate) type Components = [Vec<f32>; 3];

/// A layer's noise at a batch of points.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Field {
    /// The noise, about -1 to 1.
    pub(crate) value: Vec<f64>,
    /// Gradient by the unit direction, for the tile's own spacing.
    pub(crate) own: Components,
    /// Gradient as the parent would show it.
    pub(crate) parent: Components,
}

impl NoiseShape {
    /// Compiles a layer of a planet of this seed and radius.
    pub(crate) fn of_layer(layer: &Layer, planet_seed: u32, radius_km: f64) -> Self {
        let seed = u64::from(planet_seed) << 32 | u64::from(layer.seed);
        match &layer.shape {
            Shape::Fbm(Fbm { wavelength_km, octaves, gain, lacunarity }) => {
                Self::new(seed, radius_km / wavelength_km, *octaves, *gain, *lacunarity, Kind::Fbm)
            }
            Shape::Ridged(Ridged { wavelength_km, octaves, gain, lacunarity, feedback }) => {
                let kind = Kind::Ridged { feedback: *feedback as f32 };
                Self::new(seed, radius_km / wavelength_km, *octaves, *gain, *lacunarity, kind)
            }
            Shape::Craters(Craters { diameter_km, octaves, gain, lacunarity, density }) => {
                let kind = Kind::Craters { density: *density as f32 };
                // The widest crater is 0.9 cells across.
                Self::new(seed, 0.9 * radius_km / diameter_km, *octaves, *gain, *lacunarity, kind)
            }
        }
    }

    /// Plain fractal noise with gain 0.5 and lacunarity 2.
    pub(crate) fn fbm(seed: u64, frequency: f64, octaves: u32) -> Self {
        Self::new(seed, frequency, octaves, 0.5, 2.0, Kind::Fbm)
    }

    fn new(seed: u64, frequency: f64, octaves: u32, gain: f64, lacunarity: f64, kind: Kind) -> Self {
        // The lattice must stay within what f64 can split; finer octaves would be below a nanometre.
        let frequencies: Vec<f64> = std::iter::successors(Some(frequency), |f| Some(f * lacunarity))
            .take(octaves as usize)
            .take_while(|f| *f < 1e14)
            .collect();
        let gains: Vec<f64> = std::iter::successors(Some(1.0), |a| Some(a * gain)).take(frequencies.len()).collect();
        let total: f64 = gains.iter().sum();
        let octaves = frequencies
            .iter()
            .enumerate()
            .map(|(i, &frequency)| {
                let random = |k: u64| noise::mix(noise::mix(seed).wrapping_add(i as u64 * 4 + k));
                let offset = |k: u64| (random(k) >> 40) as f64 / 4096.0;
                Octave { frequency, offset: [offset(1), offset(2), offset(3)], seed: random(0) as u32 }
            })
            .collect();
        Self { octaves, weights: gains.iter().map(|a| (a / total) as f32).collect(), kind }
    }

    /// How many octaves one point takes.
    pub(crate) fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    /// Lowest and highest value the noise can take.
    pub(crate) fn bounds(&self) -> (f64, f64) {
        match self.kind {
            Kind::Fbm => (-noise::BOUND, noise::BOUND),
            Kind::Ridged { .. } | Kind::Craters { .. } => (-1.0, 1.0),
        }
    }

    /// Share of each octave that points so far apart can carry. A wave of gradient noise is about two lattice cells long; folded
    /// into crests it is half as long.
    fn fades(&self, spacing_rad: f64) -> Vec<f32> {
        let least = if matches!(self.kind, Kind::Ridged { .. }) { 2.2 } else { 1.5 };
        self.octaves
            .iter()
            .map(|octave| {
                let points_per_cell = 1.0 / (octave.frequency * spacing_rad.max(1e-30));
                (points_per_cell / least - 1.0).clamp(0.0, 1.0) as f32
            })
            .collect()
    }

    /// Values and gradients.
    pub(crate) fn field(&self, simd: Simd, points: &Points, bands: Bands) -> Field {
        let n = points.len();
        let (own_fades, parent_fades) = (self.fades(bands.own_spacing_rad), self.fades(bands.parent_spacing_rad));
        let mut field = Field { value: vec![0.0; n], own: zeros(n), parent: zeros(n) };
        let mut state = ChunkState::default();
        for start in (0..n).step_by(CHUNK) {
            let end = (start + CHUNK).min(n);
            state.restart();
            for (i, octave) in self.octaves.iter().enumerate() {
                let strength = Strength { weight: self.weights[i], own: own_fades[i], parent: parent_fades[i] };
                let (x, y, z) = (&points.x[start..end], &points.y[start..end], &points.z[start..end]);
                match self.kind {
                    // An octave too fine for either band needs no gradient, nor do the finer ones that follow it.
                    Kind::Fbm if strength.is_unseen() => fbm_value(simd, x, y, z, octave, strength, &mut state),
                    Kind::Ridged { feedback } if strength.is_unseen() => {
                        ridged_value(simd, x, y, z, octave, strength, feedback, &mut state);
                    }
                    Kind::Fbm => fbm_gradient(simd, x, y, z, octave, strength, &mut state),
                    Kind::Ridged { feedback } => ridged_gradient(simd, x, y, z, octave, strength, feedback, &mut state),
                    Kind::Craters { density } => craters_gradient(simd, x, y, z, octave, strength, density, &mut state),
                }
            }
            let len = end - start;
            let (stretch, shift) = self.kind.stretch();
            for (out, v) in field.value[start..end].iter_mut().zip(&state.value[..len]) {
                *out = v * stretch + shift;
            }
            for axis in 0..3 {
                for (out, g) in field.own[axis][start..end].iter_mut().zip(&state.own[axis][..len]) {
                    *out = g * stretch as f32;
                }
                for (out, g) in field.parent[axis][start..end].iter_mut().zip(&state.parent[axis][..len]) {
                    *out = g * stretch as f32;
                }
            }
        }
        field
    }

    /// Values alone; the same bits as [`NoiseShape::field`] gives.
    pub(crate) fn values(&self, simd: Simd, points: &Points) -> Vec<f64> {
        let n = points.len();
        let mut values = vec![0.0; n];
        let mut state = ChunkState::default();
        for start in (0..n).step_by(CHUNK) {
            let end = (start + CHUNK).min(n);
            state.restart();
            for (i, octave) in self.octaves.iter().enumerate() {
                let strength = Strength { weight: self.weights[i], own: 0.0, parent: 0.0 };
                let (x, y, z) = (&points.x[start..end], &points.y[start..end], &points.z[start..end]);
                match self.kind {
                    Kind::Fbm => fbm_value(simd, x, y, z, octave, strength, &mut state),
                    Kind::Ridged { feedback } => ridged_value(simd, x, y, z, octave, strength, feedback, &mut state),
                    Kind::Craters { density } => craters_gradient(simd, x, y, z, octave, strength, density, &mut state),
                }
            }
            let (stretch, shift) = self.kind.stretch();
            for (out, v) in values[start..end].iter_mut().zip(&state.value[..end - start]) {
                *out = v * stretch + shift;
            }
        }
        values
    }
}

fn zeros(n: usize) -> Components {
    [vec![0.0; n], vec![0.0; n], vec![0.0; n]]
}

/// How much one octave counts: in the value, and in the two gradients.
#[derive(Clone, Copy, Debug)]
struct Strength {
    weight: f32,
    own: f32,
    parent: f32,
}

impl Strength {
    fn is_unseen(self) -> bool {
        self.own == 0.0 && self.parent == 0.0
    }
}

/// Sums of one chunk. Values are summed in f64: it costs little and keeps millimetres of an 8 km mountain.
struct ChunkState {
    value: [f64; CHUNK],
    own: [[f32; CHUNK]; 3],
    parent: [[f32; CHUNK]; 3],
    /// Ridged: how strong the next octave is, and the gradient of that.
    feed: [f32; CHUNK],
    feed_gradient: [[f32; CHUNK]; 3],
}

impl Default for ChunkState {
    fn default() -> Self {
        Self {
            value: [0.0; CHUNK],
            own: [[0.0; CHUNK]; 3],
            parent: [[0.0; CHUNK]; 3],
            feed: [1.0; CHUNK],
            feed_gradient: [[0.0; CHUNK]; 3],
        }
    }
}

impl ChunkState {
    fn restart(&mut self) {
        *self = Self::default();
    }
}

#[inline(always)]
fn fbm_value_body(x: &[f64], y: &[f64], z: &[f64], octave: &Octave, strength: Strength, state: &mut ChunkState) {
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    for i in 0..n {
        let v = noise::value([x[i], y[i], z[i]], octave);
        state.value[i] += f64::from(v * strength.weight);
    }
}
for_each_simd!(fn fbm_value = fbm_value_body(
    x: &[f64], y: &[f64], z: &[f64], octave: &Octave, strength: Strength, state: &mut ChunkState,
));

#[inline(always)]
fn fbm_gradient_body(x: &[f64], y: &[f64], z: &[f64], octave: &Octave, strength: Strength, state: &mut ChunkState) {
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    let slope = strength.weight * octave.frequency as f32;
    let (own, parent) = (slope * strength.own, slope * strength.parent);
    let ChunkState { value, own: [ox, oy, oz], parent: [px, py, pz], .. } = state;
    for i in 0..n {
        let (v, g) = noise::value_gradient([x[i], y[i], z[i]], octave);
        value[i] += f64::from(v * strength.weight);
        ox[i] += g[0] * own;
        oy[i] += g[1] * own;
        oz[i] += g[2] * own;
        px[i] += g[0] * parent;
        py[i] += g[1] * parent;
        pz[i] += g[2] * parent;
    }
}
for_each_simd!(fn fbm_gradient = fbm_gradient_body(
    x: &[f64], y: &[f64], z: &[f64], octave: &Octave, strength: Strength, state: &mut ChunkState,
));

/// Folds noise into a crest: (1 - |n|)^2, times what the octave before passed on.
#[inline(always)]
fn ridged_value_body(
    x: &[f64],
    y: &[f64],
    z: &[f64],
    octave: &Octave,
    strength: Strength,
    feedback: f32,
    state: &mut ChunkState,
) {
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    for i in 0..n {
        let fold = (1.0 - noise::value([x[i], y[i], z[i]], octave).abs()).max(0.0);
        let crest = fold * fold * state.feed[i];
        state.value[i] += f64::from(crest * strength.weight);
        state.feed[i] = (crest * feedback).min(1.0);
    }
}
for_each_simd!(fn ridged_value = ridged_value_body(
    x: &[f64], y: &[f64], z: &[f64], octave: &Octave, strength: Strength, feedback: f32, state: &mut ChunkState,
));

#[inline(always)]
fn ridged_gradient_body(
    x: &[f64],
    y: &[f64],
    z: &[f64],
    octave: &Octave,
    strength: Strength,
    feedback: f32,
    state: &mut ChunkState,
) {
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    let frequency = octave.frequency as f32;
    let (own, parent) = (strength.weight * strength.own, strength.weight * strength.parent);
    let ChunkState { value, own: [ox, oy, oz], parent: [px, py, pz], feed, feed_gradient: [fx, fy, fz] } = state;
    for i in 0..n {
        let (v, g) = noise::value_gradient([x[i], y[i], z[i]], octave);
        let fold = (1.0 - v.abs()).max(0.0);
        let square = fold * fold;
        let crest = square * feed[i];
        value[i] += f64::from(crest * strength.weight);
        // d crest = -2 fold sign(v) feed dv + fold^2 dfeed
        let pull = -2.0 * fold * feed[i] * frequency * if v < 0.0 { -1.0 } else { 1.0 };
        let d = [g[0] * pull + square * fx[i], g[1] * pull + square * fy[i], g[2] * pull + square * fz[i]];
        ox[i] += d[0] * own;
        oy[i] += d[1] * own;
        oz[i] += d[2] * own;
        px[i] += d[0] * parent;
        py[i] += d[1] * parent;
        pz[i] += d[2] * parent;
        let next = crest * feedback;
        let passed_on = if next < 1.0 { feedback } else { 0.0 };
        feed[i] = next.min(1.0);
        fx[i] = d[0] * passed_on;
        fy[i] = d[1] * passed_on;
        fz[i] = d[2] * passed_on;
    }
}
for_each_simd!(fn ridged_gradient = ridged_gradient_body(
    x: &[f64], y: &[f64], z: &[f64], octave: &Octave, strength: Strength, feedback: f32, state: &mut ChunkState,
));

#[inline(always)]
fn craters_gradient_body(
    x: &[f64],
    y: &[f64],
    z: &[f64],
    octave: &Octave,
    strength: Strength,
    density: f32,
    state: &mut ChunkState,
) {
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    let slope = strength.weight * octave.frequency as f32;
    let (own, parent) = (slope * strength.own, slope * strength.parent);
    for i in 0..n {
        let unskew = (x[i] + y[i] + z[i]) * (1.0 / 6.0);
        let dir = [(x[i] - unskew) as f32, (y[i] - unskew) as f32, (z[i] - unskew) as f32];
        let (v, g) = craters::value_gradient([x[i], y[i], z[i]], dir, octave, density);
        state.value[i] += f64::from(v * strength.weight);
        for (axis, g) in g.into_iter().enumerate() {
            state.own[axis][i] += g * own;
            state.parent[axis][i] += g * parent;
        }
    }
}
for_each_simd!(fn craters_gradient = craters_gradient_body(
    x: &[f64], y: &[f64], z: &[f64], octave: &Octave, strength: Strength, density: f32, state: &mut ChunkState,
));
