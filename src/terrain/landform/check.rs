//! What every kind of layer must hold, for the tests of each: exact gradients, no jumps, bounds, the same bits everywhere.

use super::{CHUNK, Chunk, Evaluate, Scratch};
use crate::terrain::field::EXACT;
use crate::terrain::points::Points;
use crate::terrain::simd::Simd;
use glam::DVec3;

/// Values, and gradients where wanted, of a kind at points.
pub(super) fn evaluate(
    kind: &dyn Evaluate,
    simd: Simd,
    dirs: &[DVec3],
    spacings_rad: &[f64],
) -> (Vec<f64>, Vec<DVec3>) {
    let mut scratch = Box::<Scratch>::default();
    let (mut values, mut gradients) = (Vec::new(), Vec::new());
    for dirs in dirs.chunks(CHUNK) {
        let points = Points::new(dirs.to_vec());
        let chunk = Chunk { simd, skewed: [&points.x, &points.y, &points.z], dirs, spacings_rad, seen_only: false };
        scratch.sums.restart(&chunk);
        kind.add_to(&chunk, &mut scratch);
        values.extend_from_slice(&scratch.sums.value[..dirs.len()]);
        if let Some([x, y, z]) = scratch.sums.gradients.first() {
            let at = |i: usize| DVec3::new(f64::from(x[i]), f64::from(y[i]), f64::from(z[i]));
            gradients.extend((0..dirs.len()).map(at));
        }
    }
    (values, gradients)
}

/// Directions all over the sphere, the poles and the axes among them.
pub(super) fn directions(n: u32) -> Vec<DVec3> {
    let spiral = (0..n).map(|i| {
        let (z, lon) = (1.0 - 2.0 * (f64::from(i) + 0.5) / f64::from(n), f64::from(i) * 2.399_963);
        let flat = (1.0 - z * z).sqrt();
        DVec3::new(flat * lon.cos(), flat * lon.sin(), z)
    });
    DVec3::AXES.into_iter().chain(DVec3::AXES.map(|axis| -axis)).chain(spiral).collect()
}

/// Mean and standard deviation of a kind.
pub(super) fn statistics(kind: &dyn Evaluate) -> (f64, f64) {
    let (values, _) = evaluate(kind, Simd::detect(), &directions(20_000), &[]);
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n).sqrt())
}

/// Asserts all of it. `kinks` is the share of places that may have an edge (a crest, a rim), where a difference across it
/// is neither side's slope.
pub(super) fn kind(kind: &dyn Evaluate, kinks: f64) {
    let dirs = directions(4000);
    let (values, gradients) = evaluate(kind, Simd::detect(), &dirs, EXACT);
    let (lo, hi) = kind.bounds();
    assert!(values.iter().all(|v| (lo..=hi).contains(v)), "within its bounds");
    assert!(gradients.iter().all(|g| g.is_finite()));
    for simd in Simd::available() {
        let bits = |values: &[f64]| values.iter().map(|v| v.to_bits()).collect::<Vec<_>>();
        assert_eq!(bits(&evaluate(kind, simd, &dirs, &[]).0), bits(&values), "{}, values alone", simd.name());
        let (same, same_gradients) = evaluate(kind, simd, &dirs, &[0.0, 1e9]);
        assert_eq!(bits(&same), bits(&values), "{}", simd.name());
        assert!(same_gradients == gradients, "{}", simd.name());
        assert_eq!(bits(&evaluate(kind, simd, &dirs, &[1e9]).0), bits(&values), "{}, unseen", simd.name());
    }
    // Steep is the steepest slope there is; over a step a value moves by no more than a little beyond that.
    let steep = dirs.iter().zip(&gradients).map(|(d, g)| (*g - *d * d.dot(*g)).length()).fold(0.0, f64::max);
    let step = 2e-4 / steep;
    let mut off = 0;
    let along: Vec<DVec3> = dirs.iter().map(|d| d.any_orthonormal_vector()).collect();
    let moved =
        |k: f64| -> Vec<DVec3> { dirs.iter().zip(&along).map(|(d, a)| (*d + *a * (step * k)).normalize()).collect() };
    let (ahead, _) = evaluate(kind, Simd::detect(), &moved(1.0), &[]);
    let (behind, _) = evaluate(kind, Simd::detect(), &moved(-1.0), &[]);
    for i in 0..dirs.len() {
        let change = ahead[i] - behind[i];
        assert!(change.abs() < 2.0 * steep * step * 2.0 + 1e-5, "a jump of {change} at {}", dirs[i]);
        off += u32::from((change / (2.0 * step) - gradients[i].dot(along[i])).abs() > 0.02 * steep);
    }
    assert!(f64::from(off) <= kinks * dirs.len() as f64, "{off} gradients of {} are off", dirs.len());
}

/// How many million points a second each instruction set makes, on one core; printed.
pub(super) fn speed(name: &str, kind: &dyn Evaluate) {
    let dirs: Vec<DVec3> = directions(1 << 15);
    for simd in Simd::available() {
        let rate = |spacings_rad: &[f64]| {
            let start = std::time::Instant::now();
            let mut points = 0;
            while start.elapsed().as_secs_f64() < 0.2 {
                std::hint::black_box(evaluate(kind, simd, &dirs, spacings_rad));
                points += dirs.len() * kind.octave_count();
            }
            points as f64 / start.elapsed().as_secs_f64() * 1e-6
        };
        eprintln!("{name} {}: {:.1} M octave samples/s, {:.1} with gradients", simd.name(), rate(&[]), rate(EXACT));
    }
}
