//! Noise at any points of the unit sphere, on one core, against fastnoise-lite on the same points in the same run.

use super::{median, repeat};
use crate::simd::Simd;
use crate::sphere::LatLon;
use crate::terrain::bench::NoiseBench;
use fastnoise_lite::{FastNoiseLite, FractalType, NoiseType};
use glam::DVec3;
use serde_json::{Value, json};
use std::hint::black_box;

const POINTS: usize = 100_000;
pub(super) const OCTAVES: i32 = 8;
/// Cycles along a radius of the coarsest octave.
const FREQUENCY: f32 = 4.0;

/// The `noise` object of the report: the figures of the best instruction set, and of each.
pub(super) fn measure() -> Value {
    let points = points();
    let noise = NoiseBench::new(points.clone());
    let yardstick = fastnoise_lite_mpts(&points);
    let figures = |simd: Simd| {
        let (value, gradient) = own_mpts(&noise, simd);
        let ratio = |mpts: Option<f64>| mpts.zip(yardstick).map(|(own, other)| own / other);
        json!({
            "simd": simd.name(),
            "value_mpts": value,
            "gradient_mpts": gradient,
            "value_ratio": ratio(value),
            "gradient_ratio": ratio(gradient),
        })
    };
    let by_simd: Vec<Value> = Simd::available().into_iter().map(figures).collect();
    let mut report = by_simd.last().cloned().unwrap_or_default();
    report["points"] = json!(POINTS);
    report["octaves"] = json!(OCTAVES);
    report["fastnoise_lite_mpts"] = json!(yardstick);
    report["by_simd"] = json!(by_simd);
    report
}

/// Million points a second of this crate's noise: values, and values with gradients.
fn own_mpts(noise: &NoiseBench, simd: Simd) -> (Option<f64>, Option<f64>) {
    let values = repeat(|| {
        black_box(noise.values(simd));
    });
    let gradients = repeat(|| {
        black_box(noise.gradients(simd));
    });
    (mpts(&values), mpts(&gradients))
}

/// Million points a second of [`OCTAVES`] octaves of fastnoise-lite, on one core.
pub(super) fn fastnoise_lite_mpts(points: &[DVec3]) -> Option<f64> {
    let mut noise = FastNoiseLite::with_seed(1);
    noise.set_noise_type(Some(NoiseType::OpenSimplex2));
    noise.set_fractal_type(Some(FractalType::FBm));
    noise.set_fractal_octaves(Some(OCTAVES));
    noise.set_frequency(Some(FREQUENCY));
    let points: Vec<[f32; 3]> = points.iter().map(|p| p.as_vec3().to_array()).collect();
    let mut values = vec![0.0_f32; points.len()];
    let times_ms = repeat(|| {
        for (value, [x, y, z]) in values.iter_mut().zip(&points) {
            *value = noise.get_noise_3d(*x, *y, *z);
        }
        black_box(&mut values);
    });
    median(&times_ms).map(|ms| points.len() as f64 / ms / 1000.0)
}

/// Million points a second from the times of runs over all points.
fn mpts(times_ms: &[f64]) -> Option<f64> {
    median(times_ms).map(|ms| POINTS as f64 / ms / 1000.0)
}

/// Points spread over the sphere such that neighbours in the list are no neighbours on it.
fn points() -> Vec<DVec3> {
    // The R2 sequence (Roberts): even, and the same in every run.
    (0..POINTS)
        .map(|i| {
            let (u, v) = ((i as f64 * 0.754_877_666_246_692_7).fract(), (i as f64 * 0.569_840_290_998_053_2).fract());
            let lat_rad = libm::asin(2.0 * u - 1.0);
            LatLon { lat_rad, lon_rad: std::f64::consts::TAU * v }.direction()
        })
        .collect()
}
