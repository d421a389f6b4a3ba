//! Ground edits: each tool against its formula, one height for every query and tile, and rebuilds of what they touch.

use crate::stamp::{self, HILLS};
use crate::support::dice::Dice;
use glam::DVec3;
use std::sync::Arc;
use std::time::Duration;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::edits::{
    Canyon, Coast, Crater, EditBlend, EditPoint, EditPoints, Fault, Flatten, GroundEdit, Island, Limit, MaskPaint,
    Mesa, PictureStamp, Raise, Ridge, Road, Terrace, Tool, Volcano, Wall,
};
use tellus::planet::{Fbm, GroundEdits, Layer, Planet, Shape, Water};
use tellus::simd::Simd;
use tellus::sphere::LatLon;
use tellus::terrain::{Terrain, Wanted};
use tellus::tiles::{Builder, Surface, build_now};

pub(crate) fn at(lat_deg: f64, lon_deg: f64) -> EditPoint {
    EditPoint { latitude_deg: lat_deg, longitude_deg: lon_deg, ..EditPoint::default() }
}

pub(crate) fn edit(tool: Tool, radius_km: f64, points: &[EditPoint]) -> GroundEdit {
    GroundEdit { tool, radius_km, points: EditPoints(points.to_vec()), ..GroundEdit::default() }
}

/// A planet of 1000 km radius with a sea; `hills_m` of noise.
pub(crate) fn planet(hills_m: f64, edits: Vec<GroundEdit>) -> Planet {
    let layer = Layer {
        amplitude_m: hills_m,
        shape: Shape::Fbm(Fbm { wavelength_km: 300.0, octaves: 12, ..Fbm::default() }),
        ..Layer::default()
    };
    let mut planet = Planet {
        radius_km: 1000.0,
        layers: vec![layer],
        water: Some(Water { level_m: -50.0, ..Water::default() }),
        edits: edits.into_iter().collect(),
        ..Planet::default()
    };
    let problems = planet.load_pictures_from(|_| Ok(stamp::hills()));
    assert!(problems.is_empty(), "{problems:?}");
    planet
}

pub(crate) fn terrain(planet: &Planet) -> Terrain {
    Terrain::try_new(Arc::new(planet.clone())).unwrap()
}

/// The direction at a distance and a heading from a point, on a planet of 1000 km radius.
pub(crate) fn beside(point: &EditPoint, heading_deg: f64, away_km: f64) -> DVec3 {
    let dir = point.direction();
    let (east, north) = tellus::sphere::geo::east_north(dir);
    let (sin, cos) = heading_deg.to_radians().sin_cos();
    let angle = away_km / 1000.0;
    dir * angle.cos() + (east * sin + north * cos) * angle.sin()
}

/// Every tool with numbers of its own, at places that include a pole, corners and edges of the cube. A painted mask
/// limits some.
pub(crate) fn every_tool() -> Vec<GroundEdit> {
    let places = [(89.99, 20.0), (35.264_39, 45.0), (0.0, 45.0), (-35.26, 135.0), (12.0, -70.0), (-89.9, 0.0)];
    let tools = Tool::all().into_iter().enumerate();
    let stroke = |(lat_deg, lon_deg): (f64, f64)| {
        let paint = Tool::Mask(MaskPaint { mask: "Zone".to_owned(), amount: 0.9 });
        GroundEdit { raggedness: 0.4, ..edit(paint, 90.0, &[at(lat_deg - 2.0 * lat_deg.signum(), lon_deg + 3.0)]) }
    };
    let strokes = places.map(stroke);
    tools
        .map(|(i, tool)| {
            let (lat_deg, lon_deg) = places[i % places.len()];
            let mut points = vec![at(lat_deg, lon_deg)];
            if !tool.is_stamp() {
                points.push(at(lat_deg - 3.0 * lat_deg.signum(), lon_deg + 4.0));
                points.push(at(lat_deg - 7.0 * lat_deg.signum(), lon_deg - 2.0));
            }
            let tool = match tool {
                Tool::Picture(stamp) => Tool::Picture(PictureStamp { file: HILLS.to_owned().into(), ..stamp }),
                tool => tool,
            };
            // Lines taper.
            let (widths, strengths) = ([0.6, 1.3, 0.3], [1.0, 0.4, 0.8]);
            for ((point, width), strength) in points.iter_mut().zip(widths).zip(strengths) {
                (point.width, point.strength) = (width, strength);
            }
            if matches!(tool, Tool::Road(_)) {
                points.iter_mut().zip([200.0, 900.0, -100.0]).for_each(|(point, height_m)| point.height_m = height_m);
            }
            let limit = Limit::ALL[i % 3];
            let raggedness = if i % 2 == 0 { 0.6 } else { 0.0 };
            let mask = if i % 4 > 1 { "Zone".to_owned() } else { String::new() };
            let copies = if i % 4 == 2 { 9 } else { 1 };
            let one = edit(tool, 60.0 + 10.0 * i as f64, &points);
            let name = format!("{i}");
            GroundEdit { limit, raggedness, name, mask, outside_mask: i % 8 > 3, copies, spread_km: 200.0, ..one }
        })
        .chain(strokes)
        .collect()
}

/// Directions around the points of the edits of a planet.
fn around(planet: &Planet, count: usize) -> Vec<DVec3> {
    let mut dice = Dice(7);
    let points: Vec<EditPoint> = planet.edits.iter().flat_map(|edit| edit.points.0.clone()).collect();
    let mut random = |most: f64| dice.roll() * most;
    (0..count).map(|i| beside(&points[i % points.len()], random(360.0), random(220.0))).collect()
}

#[test]
fn each_tool_has_the_height_of_its_formula_in_the_middle_at_the_rim_and_at_the_end() {
    let middle = at(20.0, 30.0);
    let second = at(20.0, 32.0);
    let flat = terrain(&planet(0.0, Vec::new())).height_m(middle.direction());
    assert_eq!(flat, 0.0);
    let heights = |tool: Tool, points: &[EditPoint], softness: f64, shares: &[f64]| -> Vec<f64> {
        let terrain = terrain(&planet(0.0, vec![GroundEdit { softness, ..edit(tool, 40.0, points) }]));
        // Across the line, which runs east.
        shares.iter().map(|share| terrain.height_m(beside(&points[0], 180.0, 40.0 * share))).collect()
    };
    let near = |found: &[f64], wanted: &[f64]| {
        assert_eq!(found.len(), wanted.len());
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-6 * wanted.abs().max(1.0), "{found:?} {wanted:?}");
        }
    };
    let line = [middle, second];
    near(
        &heights(Tool::Raise(Raise { amount_m: 700.0 }), &line, 0.8, &[0.0, 0.2, 0.6, 1.0]),
        &[700.0, 700.0, 350.0, 0.0],
    );
    let flatten = Tool::Flatten(Flatten { height_m: 300.0, strength: 0.5 });
    near(&heights(flatten, &line, 0.5, &[0.0, 0.5, 1.0, 1.2]), &[150.0, 150.0, 0.0, 0.0]);
    let crater = Crater { depth_m: 1000.0, rim_m: 300.0, floor: 0.5, peak_m: 200.0 };
    near(
        &heights(Tool::Crater(crater), &[middle], 0.8, &[0.0, 0.4, 0.75, 1.0, 1.5, 2.0]),
        &[-800.0, -1000.0, 1300.0 * 0.25 - 1000.0, 300.0, 300.0 / 8.0, 0.0],
    );
    let volcano = Volcano { height_m: 3000.0, steepness: 1.0, caldera: 0.2, caldera_m: 500.0 };
    near(
        &heights(Tool::Volcano(volcano), &[middle], 0.8, &[0.0, 0.2, 0.5, 1.0]),
        &[3000.0 * 0.64 - 500.0, 3000.0 * 0.64, 750.0, 0.0],
    );
    let mesa = Mesa { height_m: 600.0, talus: 0.4 };
    near(
        &heights(Tool::Mesa(mesa), &[middle], 0.4, &[0.0, 0.6, 0.7, 0.8, 1.0]),
        &[600.0, 600.0, 240.0 * 0.5625, 60.0, 0.0],
    );
    let island = Island { height_m: 800.0, foot_m: 400.0 };
    near(&heights(Tool::Island(island), &[middle], 0.8, &[0.0, 0.9, 1.0]), &[750.0, 0.0, 0.0]);
    near(&heights(Tool::Ridge(Ridge { height_m: 1500.0 }), &line, 0.0, &[0.0, 0.5, 1.0]), &[1500.0, 375.0, 0.0]);
    let canyon = Canyon { depth_m: 1200.0, floor: 0.2 };
    near(&heights(Tool::Canyon(canyon), &line, 0.0, &[0.0, 0.2, 0.6, 1.0]), &[-1200.0, -1200.0, -900.0, 0.0]);
    let [mut from, mut to] = line;
    (from.height_m, to.height_m) = (250.0, 250.0);
    near(&heights(Tool::Road(Road { strength: 1.0 }), &[from, to], 0.5, &[0.0, 0.5, 1.0]), &[250.0, 250.0, 0.0]);

    let wall = Tool::Wall(Wall { height_m: 90.0, top: 0.5 });
    near(&heights(wall, &line, 0.5, &[0.0, 0.5, 0.75, 1.0]), &[90.0, 90.0, 45.0, 0.0]);

    // Across the middle of a line that runs along the equator: the north is on its left side.
    let along = [at(0.0, 0.0), at(0.0, 4.0), at(0.0, 8.0)];
    let across = |tool: Tool, softness: f64, shares: &[f64]| -> Vec<f64> {
        let terrain = terrain(&planet(0.0, vec![GroundEdit { softness, ..edit(tool, 40.0, &along) }]));
        shares.iter().map(|share| terrain.height_m(beside(&along[1], 0.0, 40.0 * share))).collect()
    };
    let fault = Tool::Fault(Fault { throw_m: 1000.0, scarp: 0.2, drop: 0.25 });
    near(&across(fault, 0.5, &[0.5, 0.0, -0.5, -1.0, 1.0]), &[187.5, 250.0, -62.5, 0.0, 0.0]);
    let coast = Coast { land_m: 80.0, depth_m: 120.0, flip: false };
    near(&across(Tool::Coast(coast), 0.5, &[0.5, 0.0, -0.5, 1.0]), &[-50.0 + 60.0, -50.0, -50.0 - 90.0, 0.0]);

    // Steps, on ground that is not flat.
    let terraced = edit(Tool::Terrace(Terrace { step_m: 100.0, sharpness: 1.0, strength: 1.0 }), 200.0, &[middle]);
    let (before, after) = (terrain(&planet(900.0, Vec::new())), terrain(&planet(900.0, vec![terraced])));
    let mut level = 0;
    for i in 0..400 {
        let dir = beside(&middle, f64::from(i) * 7.3, f64::from(i) * 0.09);
        let (ground_m, height_m) = (before.height_m(dir), after.height_m(dir));
        let step = (ground_m / 100.0).floor() * 100.0;
        assert!(height_m >= step - 1e-6 && height_m <= step + 100.0 + 1e-6, "{ground_m} {height_m}");
        level += usize::from((height_m / 100.0 - (height_m / 100.0).round()).abs() < 1e-9);
    }
    assert!(level > 300, "{level}");
}

#[test]
fn a_coast_has_one_side_around_a_sharp_tip_and_where_it_is_closed() {
    let coast = Tool::Coast(Coast { land_m: 80.0, depth_m: 120.0, flip: false });
    // A narrow peninsula: land lies between the two ways.
    let tip = at(0.3, 3.0);
    let open = [at(0.0, 0.0), tip, at(0.6, 0.0)];
    // An isle with a corner at its first point, which is its last.
    let closed = [tip, at(0.6, 0.0), at(0.0, 0.0), tip];
    for points in [&open[..], &closed[..]] {
        let edit = GroundEdit { softness: 0.2, ..edit(coast.clone(), 10.0, points) };
        let terrain = terrain(&planet(0.0, vec![edit]));
        // The ends of an open line fade, its middle does not.
        for heading_deg in (0..=180).step_by(5) {
            let height_m = terrain.height_m(beside(&tip, f64::from(heading_deg), 5.0));
            assert!(height_m < -50.0, "{heading_deg}: {height_m}");
        }
        assert!(terrain.height_m(beside(&tip, 270.0, 8.0)) > -50.0);
    }
}

#[test]
fn land_alone_and_sea_floor_alone_change_no_other_ground_and_make_no_cliff() {
    for limit in [Limit::AboveSea, Limit::BelowSea] {
        for amount_m in [900.0, -900.0] {
            let raise = edit(Tool::Raise(Raise { amount_m }), 300.0, &[at(5.0, 5.0)]);
            let plain = planet(2500.0, Vec::new());
            let edited = planet(2500.0, vec![GroundEdit { limit, softness: 0.2, ..raise }]);
            let (before, after) = (terrain(&plain), terrain(&edited));
            let (mut changed, mut kept) = (0, 0);
            for i in 0..2000 {
                let dir = beside(&at(5.0, 5.0), f64::from(i) * 7.3, f64::from(i) * 0.1);
                let (ground_m, height_m) = (before.height_m(dir), after.height_m(dir));
                let over_m = if limit == Limit::AboveSea { ground_m + 50.0 } else { -50.0 - ground_m };
                if over_m <= 0.0 {
                    assert_eq!(ground_m, height_m);
                    kept += 1;
                } else {
                    assert!((height_m - ground_m).abs() <= 900.0_f64.min(3.0 * over_m) + 1e-9, "{over_m} {height_m}");
                    changed += usize::from(height_m != ground_m);
                }
            }
            assert!(changed > 300 && kept > 300, "{changed} {kept}");
        }
    }
}

#[test]
fn of_the_new_ground_and_the_old_the_higher_or_the_lower_stays() {
    let flatten = |blend| {
        let flatten = edit(Tool::Flatten(Flatten { height_m: 100.0, strength: 1.0 }), 300.0, &[at(5.0, 5.0)]);
        terrain(&planet(2500.0, vec![GroundEdit { blend, softness: 0.2, ..flatten }]))
    };
    let before = terrain(&planet(2500.0, Vec::new()));
    let [both, raised, lowered] = [EditBlend::Both, EditBlend::Raise, EditBlend::Lower].map(flatten);
    let (mut higher, mut lower) = (0, 0);
    for i in 0..2000 {
        let dir = beside(&at(5.0, 5.0), f64::from(i) * 7.3, f64::from(i) * 0.15);
        let [was_m, both_m, raised_m, lowered_m] =
            [&before, &both, &raised, &lowered].map(|terrain| terrain.height_m(dir));
        assert_eq!((raised_m, lowered_m), (was_m.max(both_m), was_m.min(both_m)));
        higher += usize::from(raised_m > was_m);
        lower += usize::from(lowered_m < was_m);
    }
    assert!(higher > 300 && lower > 300, "{higher} {lower}");
}

#[test]
fn heights_above_and_below_alone_are_changed() {
    let raise = |above_m: f64, below_m: f64| {
        let raise = edit(Tool::Raise(Raise { amount_m: 500.0 }), 300.0, &[at(5.0, 5.0)]);
        terrain(&planet(2500.0, vec![GroundEdit { above_m, below_m, softness: 0.2, ..raise }]))
    };
    let (before, after) = (terrain(&planet(2500.0, Vec::new())), raise(-300.0, 400.0));
    let mut changed = 0;
    for i in 0..2000 {
        let dir = beside(&at(5.0, 5.0), f64::from(i) * 7.3, f64::from(i) * 0.1);
        let (ground_m, height_m) = (before.height_m(dir), after.height_m(dir));
        if ground_m <= -300.0 || ground_m >= 400.0 {
            assert_eq!(ground_m, height_m);
        } else {
            changed += usize::from(height_m > ground_m);
        }
    }
    assert!(changed > 200, "{changed}");
}

#[test]
fn every_query_and_instruction_set_has_the_same_bits_and_normals_follow_the_heights() {
    let planet = planet(400.0, every_tool());
    let (plain, edited) = (terrain(&Planet { edits: GroundEdits::default(), ..planet.clone() }), terrain(&planet));
    let dirs = around(&planet, 3000);
    let heights_m = edited.heights_m(&dirs);
    let slow = edited.clone().with_simd(Simd::Baseline);
    let samples = slow.samples(&dirs, Wanted::default().and_normal());
    let (mut changed, mut off) = (0, 0);
    for ((dir, height_m), sample) in dirs.iter().zip(&heights_m).zip(&samples) {
        assert_eq!(edited.height_m(*dir).to_bits(), height_m.to_bits());
        assert_eq!(sample.height_m.to_bits(), height_m.to_bits());
        if plain.height_m(*dir) == *height_m {
            continue;
        }
        changed += 1;
        // The slope by differences: creases of crests and rims are few.
        let (east, north) = tellus::sphere::geo::east_north(*dir);
        let step = 2e-6;
        let slope = |along: DVec3| {
            let height_m = |by: f64| edited.height_m((*dir + along * by).normalize());
            (height_m(step) - height_m(-step)) / (2.0 * step * (1e6 + height_m(0.0)))
        };
        let by_difference = DVec3::new(-slope(east), -slope(north), 1.0).normalize();
        let normal =
            DVec3::new(sample.normal_planet.dot(east), sample.normal_planet.dot(north), sample.normal_planet.dot(*dir));
        off += usize::from(normal.distance(by_difference) > 0.01);
    }
    assert!(changed > 1000, "{changed}");
    assert!(off * 100 < changed, "{off} of {changed}");
}

#[test]
fn bounds_hold_everywhere_and_are_narrow_away_from_edits() {
    let planet = planet(400.0, every_tool());
    let (plain, edited) = (terrain(&Planet { edits: GroundEdits::default(), ..planet.clone() }), terrain(&planet));
    let (lo, hi) = edited.height_bounds_m();
    for dir in around(&planet, 600) {
        for angle in [1e-4, 0.01, 0.1] {
            let (near_lo, near_hi) = edited.height_bounds_near_m(dir, angle);
            for other in [dir, beside(&EditPoint::under(dir), 77.0, 999.0 * angle)] {
                let height_m = edited.height_m(other);
                assert!(
                    (near_lo..=near_hi).contains(&height_m) && (lo..=hi).contains(&height_m),
                    "{near_lo} {height_m} {near_hi}"
                );
            }
        }
    }
    let far = tellus::sphere::geo::spread(500);
    let narrower = far.filter(|dir| edited.height_bounds_near_m(*dir, 0.01) == plain.height_bounds_near_m(*dir, 0.01));
    let narrower = narrower.count();
    assert!(narrower > 100, "{narrower}");
}

pub(crate) fn view(lat_deg: f64, lon_deg: f64, altitude_m: f64) -> View {
    let camera =
        Camera::over(LatLon::from_degrees(lat_deg, lon_deg), 1e6 + altitude_m, 0.3, -1.4, Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px: [320, 200], quality: Quality::Low }
}

/// Checks each vertex against the query, and gives how many were checked.
fn check_vertices(surface: &Surface) -> usize {
    let mut checked = 0;
    for leaf in &surface.leaves {
        let id = leaf.tile.id;
        for (i, vertex) in leaf.tile.vertices.iter().enumerate().step_by(7) {
            let dir = id.direction((i % 33) as f64 / 32.0, (i / 33) as f64 / 32.0);
            assert_eq!(vertex.height_m, surface.terrain.height_m(dir) as f32, "{id:?} {i}");
            checked += 1;
        }
    }
    checked
}

#[test]
fn one_stroke_is_the_same_in_queries_and_in_tiles_from_orbit_to_the_ground_over_a_pole_and_a_corner() {
    let planet = Arc::new(planet(400.0, every_tool()));
    for (lat_deg, lon_deg) in [(89.9, 20.0), (35.264_39, 45.0)] {
        let mut finest = Vec::new();
        for altitude_m in [1.5e6, 3e4, 3e3] {
            let surface = build_now(&planet, &view(lat_deg, lon_deg, altitude_m)).unwrap();
            assert!(check_vertices(&surface) > 1000);
            finest.push(surface.leaves.iter().map(|leaf| leaf.tile.id.level).max());
        }
        assert!(finest.windows(2).all(|pair| pair[0] < pair[1]), "{finest:?}");
    }
}

pub(crate) fn settled(builder: &Builder, planet: &Planet, view: &View) -> Arc<Surface> {
    builder.request(&Arc::new(planet.clone()), view).unwrap();
    while !builder.has_all_tiles() {
        std::thread::sleep(Duration::from_millis(1));
    }
    builder.surface().unwrap()
}

#[test]
fn an_edit_rebuilds_the_tiles_it_touches_evaluates_no_noise_and_ends_as_a_build_from_nothing() {
    let mut planet = planet(400.0, every_tool());
    let view = view(12.0, -70.0, 4e4);
    let builder = Builder::new(|| {});
    let first = settled(&builder, &planet, &view);
    let stroke = edit(Tool::Raise(Raise { amount_m: 50.0 }), 2.0, &[at(12.0, -70.0), at(12.05, -70.0)]);
    planet.edits.push(GroundEdit { name: "Small".to_owned(), ..stroke });
    let vertices = |surface: &Surface| -> Vec<_> {
        surface.leaves.iter().map(|leaf| (leaf.tile.id, leaf.tile.vertices.clone())).collect()
    };
    let second = settled(&builder, &planet, &view);
    let (built, all) = (second.stats.tiles_built, first.leaves.len());
    assert!(built > 0 && built * 3 < all, "{built} of {all}");
    assert_eq!(second.stats.octave_samples, 0);
    assert!(vertices(&second) == vertices(&build_now(&Arc::new(planet.clone()), &view).unwrap()));

    // The order of two edits that meet matters, that of others does not; a name never does.
    let last = planet.edits.len() - 1;
    planet.edits.get_mut(last).unwrap().name = "Renamed".to_owned();
    assert_eq!(settled(&builder, &planet, &view).stats.tiles_built, 0);
    planet.edits.remove(last);
    let undone = settled(&builder, &planet, &view);
    assert!(vertices(&undone) == vertices(&first));
}

#[test]
fn edits_are_read_written_and_checked() {
    let planet = planet(400.0, every_tool());
    let text = planet.to_text();
    let mut read = Planet::from_text("f.ron", &text).unwrap();
    assert!(read.load_pictures_from(|_| Ok(stamp::hills())).is_empty());
    assert_eq!(read, planet);
    assert!(!Planet::default().to_text().contains("edits"), "a preset without edits does not mention them");
    let message = |edit: &str| {
        let text = format!("(version: 3, edits: [{edit}])");
        Planet::from_text("f.ron", &text).map(|_| ()).unwrap_err().to_string()
    };
    for (edit, told) in [
        ("()", "f.ron:1:22: edits[0].points: an edit needs a point; use `[(latitude, longitude)]`, or remove the edit"),
        ("(points: [(91, 0)])", "f.ron:1:32: edits[0].points[0]: the latitude 91 is out of range; use -90 to 90°"),
        (
            "(points: [(0, 0), (0, 170)])",
            "f.ron:1:40: edits[0].points[1]: this point is more than 120° from the one before it; add points between them",
        ),
        ("(radius_km: 0, points: [(0, 0)])", "f.ron:1:34: edits[0].radius_km: 0 is out of range; use 0.001 to 5000 km"),
    ] {
        assert_eq!(message(edit), told);
    }
    assert!(message("(points: [(1)])").contains("latitude"), "{}", message("(points: [(1)])"));
    assert!(message("(points: 3)").contains("edits[0].points"), "{}", message("(points: 3)"));
    assert!(message("(tool: Biome(biome: 'z'), points: [(0, 0)])").contains("edits[0].tool.biome: 'z' is no key"));
    assert!(message("(tool: Rise())").contains("Raise"), "{}", message("(tool: Rise())"));
}

/// Changes one after the other end where the same list ends that is compiled from nothing.
#[test]
fn many_changes_end_as_the_list_that_is_compiled_at_once() {
    let mut dice = Dice(23);
    let mut edited = planet(300.0, every_tool());
    let dirs = around(&edited, 300);
    for round in 0..120 {
        let count = edited.edits.len();
        let (at, to) = ((dice.roll() * count as f64) as usize, (dice.roll() * count as f64) as usize);
        match round % 6 {
            0 if count > 12 => drop(edited.edits.remove(at)),
            1 => edited.edits.shift(at, to),
            2 => edited.edits.get_mut(at).unwrap().enabled ^= true,
            3 => edited.edits.get_mut(at).unwrap().radius_km = 5.0 + 200.0 * dice.roll(),
            _ => {
                let mut more = every_tool().swap_remove((dice.roll() * Tool::NAMES.len() as f64) as usize);
                more.radius_km = 3.0 + 60.0 * dice.roll();
                edited.edits.insert(to, more);
            }
        }
        drop(terrain(&edited));
    }
    let step_by_step = terrain(&edited);
    // A planet of another size in between: nothing of the edits is kept.
    drop(terrain(&Planet { radius_km: 900.0, ..edited.clone() }));
    let at_once = terrain(&edited);
    assert_eq!(step_by_step.heights_m(&dirs), at_once.heights_m(&dirs));
    assert!(step_by_step.samples(&dirs, Wanted::ALL) == at_once.samples(&dirs, Wanted::ALL));
    assert!(at_once.revision().changes_since(step_by_step.revision()).is_empty());
    let view = view(12.0, -70.0, 4e4);
    let all = |planet: &Planet| {
        let surface = build_now(&Arc::new(planet.clone()), &view).unwrap();
        surface.leaves.iter().map(|leaf| leaf.tile.vertices.clone()).collect::<Vec<_>>()
    };
    let builder = Builder::new(|| {});
    settled(&builder, &Planet { edits: every_tool().into_iter().collect(), ..edited.clone() }, &view);
    let moved = settled(&builder, &edited, &view);
    assert!(moved.leaves.iter().map(|leaf| leaf.tile.vertices.clone()).collect::<Vec<_>>() == all(&edited));
}
