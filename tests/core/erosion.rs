//! Erosion as a brush: gullies run down slopes and end on level ground; what stands out crumbles.

use crate::sculpt::{at, beside, edit, planet, terrain};
use std::f64::consts::TAU;
use tellus::planet::Planet;
use tellus::planet::edits::{GroundEdit, Hydraulic, Raise, Smooth, Thermal, Tool, Volcano};
use tellus::terrain::Terrain;

const MIDDLE: [f64; 2] = [20.0, 30.0];

fn around(tool: Tool, radius_km: f64) -> GroundEdit {
    GroundEdit { softness: 0.2, ..edit(tool, radius_km, &[at(MIDDLE[0], MIDDLE[1])]) }
}

/// A cone of 100 km, and gullies on it.
fn carved(gullies: Hydraulic) -> (Terrain, Terrain) {
    let cone = Volcano { height_m: 9000.0, steepness: 1.0, caldera: 0.0, caldera_m: 0.0 };
    let plain = planet(0.0, vec![around(Tool::Volcano(cone), 100.0)]);
    let mut with = plain.clone();
    with.edits.push(around(Tool::Hydraulic(gullies), 120.0));
    (terrain(&plain), terrain(&with))
}

/// What gullies change along a circle around the middle.
fn along(terrains: &(Terrain, Terrain), away_km: f64, count: usize) -> Vec<f64> {
    let dir = |i: usize| beside(&at(MIDDLE[0], MIDDLE[1]), i as f64 / count as f64 * 360.0, away_km);
    (0..count).map(dir).map(|dir| terrains.1.height_m(dir) - terrains.0.height_m(dir)).collect()
}

#[test]
fn gullies_run_down_slopes_keep_crests_and_end_on_level_ground() {
    let gullies = Hydraulic { spacing: 0.05, depth: 2.0, octaves: 1, steepest_deg: 60.0 };
    let terrains = carved(gullies);
    for away_km in [30.0, 50.0] {
        // 6 km apart, as deep as the cone is steep there.
        let steep = 2.0 * 0.09 * (1.0 - away_km / 100.0);
        let depth_m = 0.5 * 2.0 * 6000.0 * steep;
        let across = along(&terrains, away_km, 2000);
        let deepest = across.iter().copied().fold(0.0, f64::min) / depth_m;
        let highest = across.iter().copied().fold(f64::MIN, f64::max) / depth_m;
        assert!((-1.05..-0.8).contains(&deepest) && (-0.05..0.13).contains(&highest), "{deepest} {highest}");
        let is_bed = |change_m: f64| change_m < -0.4 * depth_m;
        let beds = (0..across.len()).filter(|i| is_bed(across[*i]) && !is_bed(across[(i + 1) % across.len()]));
        let (beds, wanted) = (beds.count() as f64, TAU * away_km / 6.0);
        assert!(beds > 0.6 * wanted && beds < 1.4 * wanted, "{beds} {wanted}");
        // Down the slope a gully goes on: half a gully's width changes little, across it changes much.
        let step = |heading_deg: f64, turned_deg: f64, by_km: f64| {
            let center = at(MIDDLE[0], MIDDLE[1]);
            let change = |dir| terrains.1.height_m(dir) - terrains.0.height_m(dir);
            let there = beside(&center, heading_deg + turned_deg, away_km + by_km);
            (change(beside(&center, heading_deg, away_km)) - change(there)).abs()
        };
        let steps =
            |turned_deg: f64, by_km: f64| (0..200).map(|i| step(f64::from(i) * 1.8, turned_deg, by_km)).sum::<f64>();
        let (down, across) = (steps(0.0, 3.0), steps(3.0 / away_km * 360.0 / TAU, 0.0));
        assert!(down * 2.0 < across, "{down} {across}");
    }
    // Beyond the cone the ground is level.
    assert!(along(&terrains, 119.0, 100).iter().all(|change_m| change_m.abs() < 1e-9));
}

#[test]
fn finer_gullies_branch_off_and_add_their_depth() {
    let gullies = |octaves| Hydraulic { spacing: 0.05, depth: 2.0, octaves, steepest_deg: 60.0 };
    let turns = |octaves| {
        let along = along(&carved(gullies(octaves)), 40.0, 4000);
        along.windows(3).filter(|three| (three[1] - three[0]) * (three[2] - three[1]) < 0.0).count()
    };
    let (one, four) = (turns(1), turns(4));
    assert!(four > 2 * one, "{one} {four}");
    // Crests and beds of the largest stay free of the others.
    let deepest_m = |octaves| along(&carved(gullies(octaves)), 40.0, 4000).into_iter().fold(0.0, f64::min);
    let (one_m, four_m) = (deepest_m(1), deepest_m(4));
    assert!(four_m <= one_m && four_m > 1.4 * one_m, "{one_m} {four_m}");
}

#[test]
fn what_stands_out_crumbles_by_the_formula() {
    let on = |tool: Tool| -> Planet { planet(2500.0, vec![around(tool, 100.0)]) };
    let bare = terrain(&planet(2500.0, Vec::new()));
    let smooth = terrain(&on(Tool::Smooth(Smooth { size: 0.25, strength: 1.0 })));
    let thermal = |talus_deg: f64| terrain(&on(Tool::Thermal(Thermal { size: 0.25, talus_deg, strength: 1.0 })));
    let (steep, gentle) = (thermal(50.0), thermal(0.3));
    let most_m = 12_500.0 * 0.3_f64.to_radians().tan();
    let (mut most_over_m, mut kept) = (0.0_f64, 0);
    for i in 0..2000 {
        let dir = beside(&at(MIDDLE[0], MIDDLE[1]), f64::from(i) * 7.3, f64::from(i) * 0.039);
        let (ground_m, smooth_m) = (bare.height_m(dir), smooth.height_m(dir));
        let over_m = ground_m - smooth_m;
        let wanted_m = smooth_m + most_m * (over_m / most_m).tanh();
        assert!((gentle.height_m(dir) - wanted_m).abs() < 1e-6, "{ground_m} {smooth_m} {}", gentle.height_m(dir));
        most_over_m = most_over_m.max(over_m.abs());
        kept += usize::from((steep.height_m(dir) - ground_m).abs() < 0.01 * over_m.abs().max(0.1));
    }
    assert!(most_over_m > 1.5 * most_m, "{most_over_m} {most_m}");
    assert!(kept > 1900, "{kept}");
}

/// Strokes over one another, most of which read the ground that all before them left.
fn pile(strokes: usize) -> Planet {
    let stroke = |i: usize| {
        let tool = match i % 4 {
            0 => Tool::Smooth(Smooth { size: 0.5, strength: 0.1 }),
            1 => Tool::Thermal(Thermal { size: 0.5, strength: 0.1, ..Thermal::default() }),
            2 => Tool::Raise(Raise { amount_m: 5.0 }),
            _ => Tool::Hydraulic(Hydraulic { depth: 0.05, octaves: 2, ..Hydraulic::default() }),
        };
        edit(tool, 4.0, &[at(12.0, -70.0 + 0.001 * i as f64), at(12.1, -69.9), at(12.0, -69.8)])
    };
    planet(900.0, (0..strokes).map(stroke).collect())
}

/// Heights over the pile, asked on a thread that has as much stack as a worker has.
fn over_the_pile(strokes: usize, count: usize) -> Vec<f64> {
    let ask = move || {
        let dirs: Vec<_> = (0..count).map(|i| beside(&at(12.0, -70.0), i as f64 * 31.0, 0.1 * i as f64)).collect();
        terrain(&pile(strokes)).heights_m(&dirs)
    };
    std::thread::Builder::new().stack_size(2 << 20).spawn(ask).unwrap().join().unwrap()
}

/// Each goes on from the ground that the one before it has found, and that changes no bit: the golden value is that of
/// ground which is evaluated from the layers on.
#[test]
fn many_strokes_that_read_the_ground_lie_over_one_another() {
    let heights_m = over_the_pile(48, 60);
    let hash = heights_m
        .iter()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, height_m| (hash ^ height_m.to_bits()).wrapping_mul(0x0100_0000_01b3));
    assert_eq!(hash, 2_796_058_605_536_454_798, "{heights_m:?}");
}

/// `cargo test --test core -- --ignored --nocapture what_many_strokes`
#[test]
#[ignore = "a report"]
fn report_what_many_strokes_over_one_another_cost() {
    for strokes in [50, 100, 200, 400, 800] {
        let begun = std::time::Instant::now();
        over_the_pile(strokes, 60);
        eprintln!("{strokes} strokes: {:.2} s", begun.elapsed().as_secs_f64());
    }
}

/// A stroke more takes what those before it have found out; all else is as if it had been evaluated alone.
#[test]
fn strokes_that_read_the_ground_know_what_earlier_revisions_found() {
    let stroke = |lon_deg: f64, strength: f64| {
        edit(Tool::Smooth(Smooth { size: 0.3, strength }), 20.0, &[at(12.0, lon_deg), at(12.3, lon_deg + 0.5)])
    };
    let gullies = |lon_deg: f64| edit(Tool::Hydraulic(Hydraulic::default()), 30.0, &[at(12.1, lon_deg)]);
    let dirs: Vec<_> = (0..400).map(|i| beside(&at(12.1, -69.9), f64::from(i) * 31.0, f64::from(i) * 0.15)).collect();
    let mut stepwise = planet(900.0, vec![]);
    let mut seen = Vec::new();
    for step in 0..10 {
        match step {
            0 | 3 | 6 => stepwise.edits.push(stroke(-70.0 + 0.05 * f64::from(step), 0.9)),
            1 | 4 => stepwise.edits.push(gullies(-69.9 - 0.02 * f64::from(step))),
            // Under those that read it, and the ground under all edits.
            2 => stepwise.edits.insert(0, edit(Tool::Volcano(Volcano::default()), 15.0, &[at(12.1, -69.8)])),
            5 => stepwise.edits.get_mut(1).unwrap().radius_km = 25.0,
            7 => stepwise.edits.shift(1, 3),
            8 => stepwise.layers[0].amplitude_m = 1100.0,
            _ => drop(stepwise.edits.remove(2)),
        }
        let found = terrain(&stepwise).heights_m(&dirs);
        // Another planet in between: nothing is kept.
        drop(terrain(&planet(500.0, vec![stroke(-70.0, 1.0)])));
        assert_eq!(terrain(&stepwise).heights_m(&dirs), found, "{step}");
        assert!(!seen.contains(&found), "{step}");
        seen.push(found);
    }
}

/// Lines through the same ground far apart know the same nodes, but what lies between them in order is at one alone.
#[test]
fn what_an_earlier_stroke_knows_of_other_places_is_not_taken_for_the_ground_before_it() {
    let stroke = |seed: u32, points: &[_]| {
        let smooth = Tool::Smooth(Smooth { size: 0.3, strength: 0.5 });
        GroundEdit { seed, ..edit(smooth, 20.0, points) }
    };
    let [here, there] = [at(12.0, -70.0), at(12.0, -50.0)];
    let hill = edit(Tool::Volcano(Volcano::default()), 15.0, &[here]);
    // Seeds count in the keys of smooth ground, and in nothing else.
    let heights_m = |seeds: [u32; 3]| {
        let edits =
            [stroke(seeds[0], &[here]), hill.clone(), stroke(seeds[1], &[there]), stroke(seeds[2], &[here, there])];
        let dirs: Vec<_> = (0..50).map(|i| beside(&here, f64::from(i) * 31.0, f64::from(i) * 0.4)).collect();
        terrain(&planet(900.0, edits.to_vec())).heights_m(&dirs)
    };
    let apart = heights_m([1, 2, 3]);
    assert_eq!(heights_m([1, 1, 1]), apart);
    assert_eq!(heights_m([1, 1, 3]), apart);
}
