//! The loops that join layers, each a single step for a chunk of points.
//!
//! Heights are f64. Partial derivatives, which mix the gradients of all bands afterwards, are f32; loops without
//! `SLOPES` leave them out, for queries of heights alone.

use super::{Blend, Edge, MOST_MASKS};

use crate::simd::{Simd, for_each_simd};

/// Points worked on at a time: a whole tile. The loops are bound by memory, and long runs are prefetched.
pub(super) const CHUNK: usize = 1152;

/// One number for each point of a chunk.
pub(super) type Lane<T> = [T; CHUNK];

/// Compiles a loop for each instruction set, with and without slopes; `slopes` selects one at run time.
macro_rules! joining {
    (fn $name:ident($($arg:ident: $type:ty),*) = $body:ident) => {
        #[allow(clippy::too_many_arguments)]
        pub(super) fn $name(simd: Simd, slopes: bool, $($arg: $type),*) {
            for_each_simd!(fn with_slopes($($arg: $type),*) = $body::<true>);
            for_each_simd!(fn without_slopes($($arg: $type),*) = $body::<false>);
            if slopes { with_slopes(simd, $($arg),*) } else { without_slopes(simd, $($arg),*) }
        }
    };
}
pub(super) use joining;

/// A layer's target height before masks, from its noise and the height below.
pub(super) struct Output {
    /// The height that the blend makes.
    pub(super) target: Lane<f64>,
    /// Its derivatives by the height below and by the noise.
    pub(super) by_height: Lane<f32>,
    pub(super) by_noise: Lane<f32>,
    /// The part of the derivative by the height below that comes from terraces.
    pub(super) by_steps: Lane<f32>,
}

/// Derivatives of the reshaped noise by the layer's own noise and by the height below.
pub(super) struct Shaped {
    pub(super) by_noise: Lane<f64>,
    pub(super) by_height: Lane<f64>,
}

/// The product of a layer's masks.
pub(super) struct Masking {
    pub(super) mask: Lane<f64>,
    /// The last mask alone.
    pub(super) step: Lane<f64>,
    /// Derivatives of the product by the source of each mask.
    pub(super) by_source: [Lane<f32>; MOST_MASKS],
}

#[inline(always)]
fn each<const SLOPES: bool>(
    n: usize,
    height: &Lane<f64>,
    noise: &[f64],
    output: &mut Output,
    blend: impl Fn(f64, f64) -> (f64, f64, f64),
) {
    for (i, v) in noise.iter().enumerate().take(n.min(CHUNK)) {
        let (target, by_height, by_noise) = blend(height[i], *v);
        output.target[i] = target;
        if SLOPES {
            output.by_height[i] = by_height as f32;
            output.by_noise[i] = by_noise as f32;
        }
    }
}

/// Blends the noise `v` with the height below.
#[inline(always)]
fn blend_body<const SLOPES: bool>(n: usize, blend: &Blend, height: &Lane<f64>, noise: &[f64], output: &mut Output) {
    let (a, bias) = (blend.amplitude_m, blend.bias);
    // Adding 0 turns -0 into 0: a layer that a mask leaves out could not make the same -0.
    let scaled = |v: f64| (v + bias) * a + 0.0;
    // Polynomial smooth maximum; beyond `soft` apart it is the maximum.
    let soft = blend.softness_m;
    let share = |y: f64, h: f64| (0.5 + 0.5 * (y - h) / soft).clamp(0.0, 1.0);
    use crate::planet::Blend as Kind;
    match blend.kind {
        Kind::Add => each::<SLOPES>(n, height, noise, output, |h, v| (h + scaled(v), 1.0, a)),
        Kind::Subtract => each::<SLOPES>(n, height, noise, output, |h, v| (h - scaled(v), 1.0, -a)),
        Kind::Multiply => each::<SLOPES>(n, height, noise, output, |h, v| (h * (v + bias) + 0.0, v + bias, h)),
        Kind::Replace => each::<SLOPES>(n, height, noise, output, |_, v| (scaled(v), 0.0, a)),
        Kind::Max => each::<SLOPES>(n, height, noise, output, |h, v| {
            let y = scaled(v);
            if y > h { (y, 0.0, a) } else { (h, 1.0, 0.0) }
        }),
        Kind::Min => each::<SLOPES>(n, height, noise, output, |h, v| {
            let y = scaled(v);
            if y < h { (y, 0.0, a) } else { (h, 1.0, 0.0) }
        }),
        Kind::SmoothMax => each::<SLOPES>(n, height, noise, output, |h, v| {
            let y = scaled(v);
            let s = share(y, h);
            (h + (y - h) * s + soft * s * (1.0 - s), 1.0 - s, s * a)
        }),
        Kind::SmoothMin => each::<SLOPES>(n, height, noise, output, |h, v| {
            let y = scaled(v);
            let s = share(h, y);
            (h + (y - h) * s - soft * s * (1.0 - s), 1.0 - s, s * a)
        }),
    }
}
joining!(fn blend(n: usize, blend: &Blend, height: &Lane<f64>, noise: &[f64], output: &mut Output) = blend_body);

/// Multiplies the masks so far by the `number`th: a smoothstep of `source`.
#[inline(always)]
fn mask_body<const SLOPES: bool>(n: usize, edge: &Edge, number: usize, source: &[f64], masking: &mut Masking) {
    let span = edge.to - edge.from;
    let (sign, shift) = if edge.invert { (-1.0, 1.0) } else { (1.0, 0.0) };
    let Masking { mask, step, by_source } = masking;
    let (before, own) = by_source.split_at_mut(number.min(MOST_MASKS - 1));
    for (i, x) in source.iter().enumerate().take(n.min(CHUNK)) {
        let t = ((x - edge.from) / span).clamp(0.0, 1.0);
        step[i] = t * t * (3.0 - 2.0 * t) * sign + shift;
        if SLOPES {
            own[0][i] = (6.0 * t * (1.0 - t) / span * sign * mask[i]) as f32;
        }
    }
    if SLOPES {
        for lane in before {
            for i in 0..n.min(CHUNK) {
                lane[i] *= step[i] as f32;
            }
        }
    }
    for i in 0..n.min(CHUNK) {
        mask[i] *= step[i];
    }
}
joining!(fn mask(n: usize, edge: &Edge, number: usize, source: &[f64], masking: &mut Masking) = mask_body);

/// Moves the height from the height below towards the target by the mask; derivatives become those of the result.
#[inline(always)]
fn join_body<const SLOPES: bool>(
    n: usize,
    masks: usize,
    masking: &mut Masking,
    output: &mut Output,
    height: &mut Lane<f64>,
) {
    let Output { target, by_height, by_noise, .. } = output;
    // From here on `target` holds the change.
    let change = target;
    for i in 0..n.min(CHUNK) {
        change[i] -= height[i];
        height[i] += change[i] * masking.mask[i];
    }
    if SLOPES {
        for i in 0..n.min(CHUNK) {
            let mask = masking.mask[i] as f32;
            by_height[i] = by_height[i] * mask + (1.0 - mask);
            by_noise[i] *= mask;
        }
        for lane in masking.by_source.iter_mut().take(masks) {
            for i in 0..n.min(CHUNK) {
                lane[i] *= change[i] as f32;
            }
        }
    }
}
joining!(fn join(n: usize, masks: usize, masking: &mut Masking, output: &mut Output, height: &mut Lane<f64>) = join_body);

/// The gradient of the joined height in one band, from the gradients of the height below and of the noise.
#[inline(always)]
fn mix_body(n: usize, output: &Output, noise: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) {
    for (gradient, noise) in gradient.iter_mut().zip(noise) {
        for (i, d) in noise.iter().enumerate().take(n.min(CHUNK)) {
            gradient[i] = gradient[i] * output.by_height[i] + d * output.by_noise[i];
        }
    }
}
for_each_simd!(pub(super) fn mix(n: usize, output: &Output, noise: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) = mix_body);

/// Adds the gradient of a mask's source times the derivative by it.
#[inline(always)]
fn add_source_body(n: usize, slope: &Lane<f32>, source: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) {
    for (gradient, source) in gradient.iter_mut().zip(source) {
        for (i, d) in source.iter().enumerate().take(n.min(CHUNK)) {
            gradient[i] += d * slope[i];
        }
    }
}
for_each_simd!(pub(super) fn add_source(n: usize, slope: &Lane<f32>, source: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) = add_source_body);

/// Adds the gradient of a noise whose amplitude is the same everywhere.
#[inline(always)]
fn add_scaled_body(n: usize, amplitude_m: f32, noise: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) {
    for (gradient, noise) in gradient.iter_mut().zip(noise) {
        for (i, d) in noise.iter().enumerate().take(n.min(CHUNK)) {
            gradient[i] += d * amplitude_m;
        }
    }
}
for_each_simd!(pub(super) fn add_scaled(n: usize, amplitude_m: f32, noise: &[&[f32]; 3], gradient: &mut [Lane<f32>; 3]) = add_scaled_body);

/// Adds one lane to another.
#[inline(always)]
fn add_body(n: usize, more: &Lane<f32>, sum: &mut Lane<f32>) {
    for i in 0..n.min(CHUNK) {
        sum[i] += more[i];
    }
}
for_each_simd!(pub(super) fn add(n: usize, more: &Lane<f32>, sum: &mut Lane<f32>) = add_body);

/// Turns a derivative by the absolute value of the latitude's sine into one by the sine.
#[inline(always)]
fn mirror_body(n: usize, sine: &Lane<f64>, slope: &mut Lane<f32>) {
    for i in 0..n.min(CHUNK) {
        slope[i] = if sine[i] < 0.0 { -slope[i] } else { slope[i] };
    }
}
for_each_simd!(pub(super) fn mirror(n: usize, sine: &Lane<f64>, slope: &mut Lane<f32>) = mirror_body);

/// The chain rule for noise that was reshaped.
#[inline(always)]
fn through_body(n: usize, shaped: &Shaped, output: &mut Output) {
    for i in 0..n.min(CHUNK) {
        output.by_steps[i] = output.by_noise[i] * shaped.by_height[i] as f32;
        output.by_height[i] += output.by_steps[i];
        output.by_noise[i] *= shaped.by_noise[i] as f32;
    }
}
for_each_simd!(pub(super) fn through(n: usize, shaped: &Shaped, output: &mut Output) = through_body);

/// Multiplies the derivatives of reshaped noise by that of one more function.
#[inline(always)]
fn reshape_body(n: usize, derivative: &Lane<f64>, shaped: &mut Shaped) {
    for (i, d) in derivative.iter().enumerate().take(n.min(CHUNK)) {
        shaped.by_noise[i] *= d;
        shaped.by_height[i] *= d;
    }
}
for_each_simd!(pub(super) fn reshape(n: usize, derivative: &Lane<f64>, shaped: &mut Shaped) = reshape_body);

/// The sine of the slope, from the gradient of the height by the unit direction.
#[inline(always)]
fn steepness_body(n: usize, radius_m: f64, dirs: &[Lane<f64>; 3], gradient: &[Lane<f32>; 3], sine: &mut Lane<f64>) {
    let per_square = 1.0 / (radius_m * radius_m);
    let ([x, y, z], [gx, gy, gz]) = (dirs, gradient);
    for i in 0..n.min(CHUNK) {
        let g = [f64::from(gx[i]), f64::from(gy[i]), f64::from(gz[i])];
        let up = g[0] * x[i] + g[1] * y[i] + g[2] * z[i];
        let t = [g[0] - up * x[i], g[1] - up * y[i], g[2] - up * z[i]];
        let square = (t[0] * t[0] + t[1] * t[1] + t[2] * t[2]) * per_square;
        // A gradient that overflowed counts as vertical.
        let square = if square < 1e30 { square } else { 1e30 };
        sine[i] = (square / (1.0 + square)).sqrt();
    }
}
for_each_simd!(pub(super) fn steepness(n: usize, radius_m: f64, dirs: &[Lane<f64>; 3], gradient: &[Lane<f32>; 3], sine: &mut Lane<f64>) = steepness_body);

/// Limits heights; `slope` becomes 0 where a limit holds.
#[inline(always)]
fn limit_body(n: usize, limits_m: (f64, f64), height: &mut Lane<f64>, slope: &mut Lane<f64>) {
    let (lowest, highest) = limits_m;
    for i in 0..n.min(CHUNK) {
        let h = height[i];
        let above = if h >= lowest { h } else { lowest };
        height[i] = if above <= highest { above } else { highest };
        slope[i] = if h >= lowest && h <= highest { slope[i] } else { 0.0 };
    }
}
for_each_simd!(pub(super) fn limit(n: usize, limits_m: (f64, f64), height: &mut Lane<f64>, slope: &mut Lane<f64>) = limit_body);

/// Multiplies a gradient by the slope. Where it overflowed or the slope is 0, the ground counts as level.
#[inline(always)]
fn finish_body(n: usize, slope: &Lane<f64>, gradient: &mut [Lane<f32>; 3]) {
    for lane in gradient {
        for i in 0..n.min(CHUNK) {
            let d = lane[i] * slope[i] as f32;
            lane[i] = if d.abs() < 1e30 { d } else { 0.0 };
        }
    }
}
for_each_simd!(pub(super) fn finish(n: usize, slope: &Lane<f64>, gradient: &mut [Lane<f32>; 3]) = finish_body);

/// Lowest and greatest of some numbers.
#[inline(always)]
fn range_body(values: &[f64], (lowest, greatest): (&mut f64, &mut f64)) {
    // 32 running bounds at once, because a single one would wait for each comparison.
    let (mut lo, mut hi) = ([f64::MAX; 32], [f64::MIN; 32]);
    for some in values.chunks(32) {
        for ((v, lo), hi) in some.iter().zip(&mut lo).zip(&mut hi) {
            *lo = if *v < *lo { *v } else { *lo };
            *hi = if *v > *hi { *v } else { *hi };
        }
    }
    *lowest = lo.into_iter().fold(f64::MAX, f64::min);
    *greatest = hi.into_iter().fold(f64::MIN, f64::max);
}
for_each_simd!(pub(super) fn range(values: &[f64], bounds: (&mut f64, &mut f64)) = range_body);
