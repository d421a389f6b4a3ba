//! What must hold for the ground and the rivers at every point.

use super::block::{BLOCK, Block};
use super::*;
use crate::sphere::spread;
use proptest::prelude::*;
use std::sync::{Arc, OnceLock};

mod synthetic;

const SIDE: usize = 48;

fn drainage() -> &'static Arc<Drainage> {
    static ONCE: OnceLock<Arc<Drainage>> = OnceLock::new();
    ONCE.get_or_init(|| {
        let mut drainage = synthetic::drainage(SIDE, 3, 12);
        synthetic::dam(&mut drainage, [300.0, 9000.0]);
        Arc::new(drainage)
    })
}

fn rivers() -> &'static Rivers {
    static ONCE: OnceLock<Rivers> = OnceLock::new();
    ONCE.get_or_init(|| Rivers::new(drainage().clone(), Some(synthetic::SEA_M), synthetic::RADIUS_KM))
}

/// A spacing at which a number of levels takes part.
fn spacing_rad(levels: usize) -> f64 {
    2.0 / (SIDE * 4_usize.pow(levels as u32 - 1)) as f64 / 4.5
}

fn at(dir: DVec3, levels: usize, cache: &mut Cache) -> RiverPoint {
    let mut out = Vec::new();
    rivers().evaluate(&[dir], true, levels, cache, &mut out);
    out[0]
}

/// Directions on land, most of them high enough to have tributaries.
fn land(count: usize) -> Vec<DVec3> {
    let mut cache = Cache::default();
    spread(count * 8).filter(|dir| at(*dir, 1, &mut cache).height_m > 20.0).take(count).collect()
}

/// The whole block of a level at a direction: that of points close together.
fn block(dir: DVec3, level: usize, cache: &mut Cache) -> Arc<Block> {
    rivers().evaluate(&[dir; 2], true, level + 1, cache, &mut Vec::new());
    cache.current[level].as_ref().map(|(_, block)| block.clone()).unwrap()
}

fn step(dir: DVec3, along: DVec3, by: f64) -> DVec3 {
    (dir + along * by).normalize()
}

#[test]
fn levels_follow_the_spacing() {
    for levels in 1..=LEVELS {
        assert_eq!(rivers().levels_for(spacing_rad(levels), 4.0), levels);
    }
    assert_eq!((rivers().levels_for(0.0, 4.0), rivers().levels_for(1.0, 4.0)), (LEVELS, 0));
}

#[test]
fn beds_never_rise_and_water_stands_above_them() {
    let mut cache = Cache::default();
    let (mut traced, mut steps, mut rises) = (0, 0, 0);
    for cell in (0..drainage().height_m.len()).step_by(7) {
        let trunks = &rivers().trunks;
        let Some(reach) = trunks.reach(trunks.grid.cell(cell as u64)) else { continue };
        for levels in [1, 2, 3] {
            // The pieces of this reach, in order, as the level has them.
            let block = block(reach.from, levels - 1, &mut cache);
            let mut last: Option<(DVec3, f64)> = None;
            for piece in block.pieces().filter(|piece| piece.stream.river == reach.river) {
                let line = &piece.line;
                if last.is_some_and(|(end, _)| end.distance(line.start) > 1e-12) {
                    last = None;
                }
                for k in 0..=4 {
                    let dir = (line.start + line.along * (f64::from(k) * 0.25)).normalize();
                    let point = at(dir, levels, &mut cache);
                    if let Some((_, before)) = last {
                        // A lake's bed may rise to its sill. Where the solver's reaches cross, neither bed can hold.
                        steps += 1;
                        rises += usize::from(point.height_m > before + 1e-3 && point.lake == 0);
                    }
                    if point
                        .river
                        .is_some_and(|river| river.discharge_m3_s > 0.0 && river.distance_m < 0.49 * river.width_m)
                    {
                        assert!(point.rise_m > 0.0, "{point:?}");
                        traced += 1;
                    }
                    last = Some((line.start + line.along, point.height_m));
                }
            }
        }
    }
    assert!(traced > 1000, "{traced}");
    assert!(rises * 2000 <= steps, "{rises} of {steps}");
}

#[test]
fn the_ground_is_continuous_everywhere() {
    let mut cache = Cache::default();
    let fine = (BLOCK * 4) as f64;
    for dir in land(400) {
        for levels in 1..=LEVELS {
            // To the nearest border of a face, and of cells, buckets and blocks of every level.
            for axis in [DVec3::X, DVec3::Y, DVec3::Z] {
                let side = (SIDE * 4_usize.pow(levels as u32)) as f64 * fine;
                let place = grid::FacePlace::new(dir);
                let border = (place.x * side / fine).round() * fine / side;
                let on = crate::sphere::raster::cube_direction(place.face, 1, border, place.y);
                let edge = crate::sphere::raster::cube_direction(place.face, 1, border.round(), place.y);
                for on in [dir, on, edge] {
                    let [a, b] = [-5e-10, 5e-10].map(|by| at(step(on, axis, by), levels, &mut cache));
                    let gap = (a.height_m - b.height_m).abs();
                    assert!(gap < 1e-2, "{on} {levels}: {} {}", a.height_m, b.height_m);
                }
            }
        }
    }
}

#[test]
fn gradients_match_differences() {
    let mut cache = Cache::default();
    let (mut good, mut all) = (0, 0);
    for dir in land(600) {
        for levels in 1..=LEVELS {
            let gradient = at(dir, levels, &mut cache).gradients[levels];
            assert!(gradient.dot(dir).abs() < 1e-6 * (1.0 + gradient.length()));
            for along in <[DVec3; 2]>::from(dir.any_orthonormal_pair()) {
                let [a, b] = [-1e-8, 1e-8].map(|by| at(step(dir, along, by), levels, &mut cache).height_m);
                let difference = (b - a) / 2e-8;
                let error = (difference - gradient.dot(along)).abs();
                all += 1;
                good += usize::from(error < 2e-3 * (100.0 + gradient.length()));
            }
        }
    }
    // Points next to a crease may straddle it.
    assert!(good * 100 > all * 98, "{good} of {all}");
}

#[test]
fn a_batch_equals_its_points_in_any_order() {
    let dirs: Vec<DVec3> = land(60).into_iter().flat_map(|dir| [dir, step(dir, DVec3::Z, 1e-5)]).collect();
    let (mut together, mut backwards) = (Vec::new(), Vec::new());
    rivers().evaluate(&dirs, true, LEVELS, &mut Cache::default(), &mut together);
    let reversed: Vec<DVec3> = dirs.iter().rev().copied().collect();
    rivers().evaluate(&reversed, true, LEVELS, &mut Cache::default(), &mut backwards);
    backwards.reverse();
    assert_eq!(together, backwards);
    for (dir, point) in dirs.iter().zip(&together).step_by(9) {
        assert_eq!(at(*dir, LEVELS, &mut Cache::default()), *point);
    }
}

#[test]
fn points_close_together_have_the_bits_that_each_has_alone_with_slopes_and_without() {
    let near = |dir: DVec3| (0..70).map(move |k| step(dir, DVec3::new(0.3, -0.8, 0.5), f64::from(k) * 3e-6));
    let without_slopes = |point: RiverPoint| {
        let flat = |jet: Jet| Jet { gradient: DVec3::ZERO, ..jet };
        RiverPoint { gradients: [DVec3::ZERO; LEVELS + 1], layers: point.layers.map(flat), ..point }
    };
    let (mut together, mut flat, mut cache) = (Vec::new(), Vec::new(), Cache::default());
    for dir in land(40).into_iter().chain(spread(20)) {
        let dirs: Vec<DVec3> = near(dir).collect();
        for levels in 0..=LEVELS {
            rivers().evaluate(&dirs, true, levels, &mut cache, &mut together);
            rivers().evaluate(&dirs, false, levels, &mut cache, &mut flat);
            for (k, dir) in dirs.iter().enumerate().step_by(7) {
                assert_eq!(together[k], at(*dir, levels, &mut cache), "{levels} levels at {dir}");
                assert_eq!(flat[k], without_slopes(together[k]), "{levels} levels at {dir}");
            }
        }
    }
}

#[test]
fn a_point_that_stands_alone_has_the_bits_of_its_block() {
    let alone = Rivers::new(drainage().clone(), Some(synthetic::SEA_M), synthetic::RADIUS_KM);
    let (mut answers, mut from_spots) = ([Vec::new(), Vec::new()], 0);
    for (k, dir) in land(300).into_iter().chain(spread(300)).enumerate() {
        let levels = 1 + k % LEVELS;
        let mut cache = Cache::default();
        alone.evaluate(&[dir], true, levels, &mut cache, &mut answers[0]);
        // Numbers of blocks are far smaller than those of spots.
        from_spots += usize::from(cache.current[0].as_ref().is_some_and(|(number, _)| number >> 63 == 1));
        rivers().evaluate(&[dir; 2], true, levels, &mut Cache::default(), &mut answers[1]);
        let expected = answers[1][0];
        assert_eq!(answers[0][0], expected, "{levels} levels at {dir}");
    }
    assert!(from_spots > 400, "{from_spots}");
}

#[test]
fn reaches_do_not_cross() {
    let (mut crossings, mut pairs) = (0, 0);
    let mut cache = Cache::default();
    for dir in land(12) {
        for level in 0..3 {
            let block = block(dir, level, &mut cache);
            for (k, a) in block.lines.iter().enumerate() {
                for b in &block.lines[k + 1..] {
                    let (a0, a1, b0, b1) = (a.start, a.start + a.along, b.start, b.start + b.along);
                    // Pieces that meet at a node touch there.
                    let near = |p: DVec3, q: DVec3| p.distance_squared(q) * a.per_length2 < 0.01;
                    if near(a0, b0) || near(a0, b1) || near(a1, b0) || near(a1, b1) {
                        continue;
                    }
                    let side = |p: DVec3, q: DVec3, r: DVec3| p.cross(q).dot(r);
                    // A tributary ends on its river.
                    let apart = |x: f64, y: f64, scale: f64| x * y < 0.0 && x.abs().min(y.abs()) > 0.02 * scale;
                    let scale = 1.0 / (a.per_length2 * b.per_length2).sqrt();
                    let first = apart(side(a0, a1, b0), side(a0, a1, b1), scale);
                    let second = apart(side(b0, b1, a0), side(b0, b1, a1), scale);
                    crossings += usize::from(first && second);
                }
                pairs += 1;
            }
        }
    }
    assert!(crossings * 300 <= pairs, "{crossings} crossings of {pairs} pieces");
}

#[test]
fn a_river_is_in_the_same_place_at_every_spacing() {
    let mut cache = Cache::default();
    let trunks = &rivers().trunks;
    let mut found = 0;
    for cell in 0..drainage().height_m.len() {
        let Some(reach) = trunks.reach(trunks.grid.cell(cell as u64)) else { continue };
        if reach.discharge_m3_s[0] < 8000.0 {
            continue;
        }
        for levels in 1..=3 {
            // Across the node, where the coarsest level has the river.
            let point = at(reach.from, levels, &mut cache);
            let Some(river) = point.river else { unreachable!("no river near its node") };
            assert!(river.distance_m <= river.width_m.max(spacing_rad(levels) * 6.371e6), "{levels} {river:?}");
            // Between nodes it winds more and more, by less than the points of the coarser level are apart.
            let block = block(reach.from, levels - 1, &mut cache);
            let all = block.pieces().filter(|piece| piece.stream.river == reach.river);
            let middles: Vec<DVec3> = all.map(|piece| piece.line.start + piece.line.along * 0.5).collect();
            for middle in middles.iter().step_by(11) {
                let finer = at(middle.normalize(), levels + 1, &mut cache).river;
                let Some(finer) = finer else { unreachable!("no river where it was") };
                assert!(finer.distance_m <= finer.width_m.max(spacing_rad(levels) * 6.371e6), "{levels} {finer:?}");
                found += 1;
            }
        }
    }
    assert!(found > 30, "{found}");
}

#[test]
fn the_solved_heights_hold_at_large_scale() {
    let mut cache = Cache::default();
    let (mut sum, mut relief, mut count) = (0.0, 0.0, 0.0);
    for dir in land(300) {
        // The mean over a cell.
        let (east, north) = dir.any_orthonormal_pair();
        let width = rivers().trunks.grid.width_rad(dir);
        let offset = |k: i32| f64::from(k) * 0.2 * width;
        let points = (-2..=2).flat_map(|x| (-2..=2).map(move |y| (x, y)));
        let mean = points.map(|(x, y)| at(step(dir + east * offset(x), north, offset(y)), 3, &mut cache).height_m);
        let mean = mean.sum::<f64>() / 25.0;
        let place = rivers().rasters[0].place(dir);
        sum += mean - rivers().rasters[0].value(&place, 0);
        relief += rivers().rasters[1].value(&place, 0);
        count += 1.0;
    }
    // Ridges stand above the solved ground, which is that of the rivers.
    let rise = sum / relief;
    assert!((0.5..1.3).contains(&rise), "{rise} times the relief of the cells, which is {}", relief / count);
}

/// No spit of land follows a river into a lake.
#[test]
fn no_land_stands_off_the_shore_of_a_lake() {
    let (drainage, mut cache) = (drainage(), Cache::default());
    let level_m = drainage.lakes[0].level_m;
    let mut points = 0;
    for cell in (0..drainage.lake.len()).filter(|&cell| drainage.lake[cell] != 0) {
        let middle = rivers().trunks.ring(cell).next().map(|(_, dir)| dir).unwrap_or_default();
        let (east, north) = middle.any_orthonormal_pair();
        let by = 0.15 * rivers().trunks.grid.width_rad(middle);
        for (x, y) in (-3..=3).flat_map(|x| (-3..=3).map(move |y| (f64::from(x) * by, f64::from(y) * by))) {
            let dir = (middle + east * x + north * y).normalize();
            let solved = &rivers().rasters[0];
            let is_deep = solved.value(&solved.place(dir), 0) < level_m - shore::SHALLOWS_M;
            let is_off = rivers().lakeside(dir, cell).is_some_and(|side| side.share.value > shore::OFF_SHORE[1]);
            for levels in (0..=LEVELS).filter(|_| is_deep && is_off) {
                let point = at(dir, levels, &mut cache);
                assert!(point.height_m < level_m, "{} above {level_m} at {dir}, {levels} levels", point.height_m);
                points += 1;
            }
        }
    }
    assert!(points > 50, "{points}");
}

/// Coarse tiles and fine ones show the same landscape: no level raises or lowers the ground as a whole.
#[test]
fn levels_that_are_left_out_leave_their_mean() {
    let mut cache = Cache::default();
    let (mut sums, mut relief_m) = ([0.0; LEVELS + 1], 0.0);
    for dir in land(1500) {
        relief_m += rivers().rasters[1].value(&rivers().rasters[1].place(dir), 0);
        for (levels, sum) in sums.iter_mut().enumerate() {
            *sum += at(dir, levels, &mut cache).height_m;
        }
    }
    for levels in 0..LEVELS {
        let rise = (sums[levels + 1] - sums[levels]) / relief_m;
        assert!(rise.abs() < 0.06, "level {levels} adds {rise} times the relief between reaches");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]
    #[test]
    fn bounds_hold_all_points(k in 0_usize..4000, size in 0.0_f64..4.0, turn in 0.0_f64..6.2, away in 0.0_f64..1.0) {
        let mut cache = Cache::default();
        let Some(dir) = spread(4000).nth(k) else { return Ok(()) };
        let angle_rad = 0.3 * libm::pow(10.0, -size);
        let (lo, hi) = rivers().bounds_near(dir, angle_rad);
        let (east, north) = dir.any_orthonormal_pair();
        for ring in 0..12 {
            let (sin, cos) = libm::sincos(turn + f64::from(ring) * 2.4);
            let by = libm::tan(angle_rad) * 0.999 * (away + f64::from(ring) / 12.0).min(1.0);
            let point = at(step(dir, east * cos + north * sin, by), LEVELS - ring as usize % 2, &mut cache);
            prop_assert!(lo <= point.height_m && point.height_m <= hi, "{} not in {lo}..{hi}", point.height_m);
        }
    }
}
