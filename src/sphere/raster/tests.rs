//! Rasters against the functions that they were made from.

use super::*;
use crate::sphere::spread;

fn at<T: Texel>(raster: &Raster<T>, dir: DVec3, level: usize) -> (f64, DVec3) {
    raster.sample(&raster.place(dir), level)
}

/// Smooth, and different everywhere.
fn pattern(d: DVec3) -> f64 {
    libm::sin(3.0 * d.x + 1.0) + libm::cos(4.0 * d.y * d.z) + d.z * d.x
}

fn globe(height: usize, of: impl Fn(DVec3) -> f64) -> Raster<f32> {
    let texel = |i: usize| {
        let (row, column) = (i / (2 * height), i % (2 * height));
        let (lat, lon) = (0.5 - (row as f64 + 0.5) / height as f64, (column as f64 + 0.5) / height as f64 - 1.0);
        of(crate::sphere::LatLon { lat_rad: lat * PI, lon_rad: lon * PI }.direction()) as f32
    };
    Raster::globe(height, (0..2 * height * height).map(texel).collect())
}

fn cube(side: usize, of: impl Fn(DVec3) -> f64) -> Raster<f32> {
    let texel = |i: usize| {
        let (face, row, column) = (i / (side * side), i / side % side, i % side);
        of(cube_direction(face, side, column as f64 + 0.5, row as f64 + 0.5)) as f32
    };
    Raster::cube(side, (0..6 * side * side).map(texel).collect())
}

/// A number for each texel, unrelated to its neighbours.
fn rough(d: DVec3) -> f64 {
    libm::fabs(libm::sin(1e4 * d.x) * 3e3 + libm::sin(7e3 * d.y + d.z * 9e3) * 2e3) % 1.0
}

#[test]
fn both_kinds_follow_what_they_were_made_of() {
    for (raster, least) in [(globe(128, pattern), 0.005), (cube(64, pattern), 0.005)] {
        let (lo, hi) = raster.bounds();
        for dir in spread(4000).chain([DVec3::Z, DVec3::NEG_Z, DVec3::X, DVec3::ONE.normalize()]) {
            let (value, _) = at(&raster, dir, 0);
            assert!((value - pattern(dir)).abs() < least, "{dir}: {value} {}", pattern(dir));
            assert!((lo..=hi).contains(&value));
            let (coarse, _) = at(&raster, dir, 2);
            assert!((coarse - pattern(dir)).abs() < 0.1, "{dir}: {coarse} {}", pattern(dir));
        }
    }
}

#[test]
fn there_is_no_step_anywhere_however_rough_the_texels() {
    for raster in [globe(32, rough), cube(16, rough)] {
        // Along the date line, through the poles, along edges and through corners of the cube.
        let starts =
            [DVec3::NEG_X, DVec3::Z, DVec3::NEG_Z, DVec3::new(1.0, 1.0, 0.3), DVec3::ONE, DVec3::new(0.2, -1.0, -1.0)];
        for start in starts.map(DVec3::normalize) {
            let (a, b) = start.any_orthonormal_pair();
            for k in 0..400 {
                let along = (a * libm::cos(f64::from(k)) + b * libm::sin(f64::from(k))).normalize();
                let middle = (start + b * (f64::from(k % 20) * 0.01)).normalize();
                let (lo, lo_gradient) = at(&raster, (middle - along * 1e-7).normalize(), 0);
                let (hi, hi_gradient) = at(&raster, (middle + along * 1e-7).normalize(), 0);
                assert!((hi - lo).abs() < 1e-4, "{middle}: {lo} {hi}");
                let tangent = |g: DVec3| g - middle * g.dot(middle);
                let bend = (tangent(hi_gradient) - tangent(lo_gradient)).length();
                assert!(bend < 0.01, "{middle}: {lo_gradient} {hi_gradient}");
            }
        }
    }
}

#[test]
fn gradients_match_central_differences() {
    for raster in [globe(32, rough), cube(16, rough)] {
        let near_pole =
            (0..400).map(|k| DVec3::new(f64::from(k % 20) * 0.01, f64::from(k / 20) * 0.01, 1.0).normalize());
        for dir in spread(4000).chain(near_pole) {
            let (_, gradient) = at(&raster, dir, 0);
            for along in <[DVec3; 2]>::from(dir.any_orthonormal_pair()) {
                let value = |step: f64| at(&raster, (dir + along * step).normalize(), 0).0;
                let difference = (value(1e-6) - value(-1e-6)) / 2e-6;
                assert!((difference - gradient.dot(along)).abs() < 1e-4, "{dir}: {difference} {}", gradient.dot(along));
            }
        }
    }
}

#[test]
fn bounds_near_a_direction_hold_around_it_and_are_tight() {
    for raster in [globe(96, rough), cube(48, rough), globe(96, pattern), cube(48, pattern)] {
        let edges = [DVec3::Z, DVec3::NEG_Z, DVec3::NEG_X, DVec3::new(1.0, 1.0, 0.2), DVec3::ONE];
        let near_edges = spread(200).flat_map(|d| edges.map(|e| e.normalize() + d * 0.03));
        let mut looseness = Vec::new();
        for (k, dir) in spread(2000).chain(near_edges).map(DVec3::normalize).enumerate() {
            let angle_rad = libm::pow(10.0, -0.2 - (k % 37) as f64 * 0.1);
            let (lo, hi) = raster.bounds_near(dir, angle_rad);
            let (a, b) = dir.any_orthonormal_pair();
            let (mut least, mut most) = (f64::MAX, f64::MIN);
            for i in 0..100 {
                let (sin, cos) = libm::sincos(f64::from(i) * 2.4);
                let away = libm::tan(angle_rad * (f64::from(i) / 99.0).sqrt() * 0.999);
                let (value, _) = at(&raster, (dir + (a * cos + b * sin) * away).normalize(), 0);
                assert!(lo <= value && value <= hi, "{value} not in {lo}..{hi} within {angle_rad} of {dir}");
                (least, most) = (least.min(value), most.max(value));
            }
            looseness.push((hi - lo) / (most - least));
        }
        looseness.sort_by(f64::total_cmp);
        assert!(looseness[looseness.len() / 2] < 3.5, "{}", looseness[looseness.len() / 2]);
    }
}

#[test]
fn a_constant_stays_what_it_is() {
    let globe = Raster::globe(30, vec![40_000_u16; 1800]);
    let cube = Raster::cube(9, vec![40_000_u16; 6 * 81]);
    for dir in spread(500) {
        for level in 0..2 {
            assert!((at(&globe, dir, level).0 - 40_000.0).abs() < 1e-9);
            assert!((at(&cube, dir, level).0 - 40_000.0).abs() < 1e-9);
        }
    }
    assert_eq!((globe.level_for(0.0), globe.level_for(0.15), globe.level_for(9.0)), (0, 1, 2));
    let (lo, hi) = globe.bounds();
    assert!(hi - lo < 1e-9 && (lo - 40_000.0).abs() < 1e-9);
}
