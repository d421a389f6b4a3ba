//! Edits of what a structure is solved from: uplift, rock, rain, courses of rivers.

use super::sculpt::{at, edit};
use super::water::planet;
use glam::DVec3;
use std::sync::Arc;
use tellus::planet::edits::{EditPoint, GroundEdit, RainPaint, RiverCourse, RockPaint, Tool, UpliftPaint};
use tellus::planet::param::Stage;
use tellus::planet::{Planet, Water};
use tellus::sphere::geo::east_north;
use tellus::sphere::spread;
use tellus::terrain::{Revision, Terrain, Wanted};

fn terrain(edits: Vec<GroundEdit>) -> Terrain {
    Terrain::try_new(Arc::new(Planet { edits: edits.into_iter().collect(), ..planet() })).unwrap()
}

/// The direction at a distance and a heading from a point.
fn beside(point: &EditPoint, heading_deg: f64, away_km: f64) -> DVec3 {
    let (dir, angle_rad) = (point.direction(), away_km / planet().radius_km);
    let (east, north) = east_north(dir);
    let along = east * heading_deg.to_radians().sin() + north * heading_deg.to_radians().cos();
    dir * angle_rad.cos() + along * angle_rad.sin()
}

fn paint(tool: Tool, radius_km: f64, at: &EditPoint) -> GroundEdit {
    GroundEdit { softness: 0.4, ..edit(tool, radius_km, std::slice::from_ref(at)) }
}

/// Heights at some places within a distance.
fn heights_m(terrain: &Terrain, middle: &EditPoint, within_km: f64) -> Vec<f64> {
    const PLACES: u32 = 24;
    let place = |k: u32| beside(middle, f64::from(k) * 137.5, within_km * (f64::from(k) / f64::from(PLACES)).sqrt());
    terrain.heights_m(&(0..PLACES).map(place).collect::<Vec<DVec3>>())
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// A place whose surroundings have heights for which `fits` is true everywhere.
fn place(bare: &Terrain, within_km: f64, fits: impl Fn(f64) -> bool) -> EditPoint {
    let here = |dir: DVec3| EditPoint::under(dir);
    let candidates = spread(2000).map(here).filter(|at| fits(bare.height_m(at.direction())));
    candidates.into_iter().find(|at| heights_m(bare, at, within_km).iter().all(|m| fits(*m))).unwrap()
}

#[test]
fn uplift_makes_land_out_of_the_sea_floor_with_rivers_of_its_own_and_sinks_land() {
    let bare = terrain(Vec::new());
    let sea = place(&bare, 900.0, |m| m < -2500.0);
    let raised = terrain(vec![paint(Tool::Uplift(UpliftPaint { uplift_m: 9000.0 }), 800.0, &sea)]);
    let [before_m, after_m] = [&bare, &raised].map(|terrain| mean(&heights_m(terrain, &sea, 300.0)));
    assert!(before_m < -2500.0 && after_m > 300.0, "{before_m} {after_m}");
    let rivers = raised.rivers(30.0);
    let is_here = |dir: DVec3| dir.dot(sea.direction()) > (800.0 / planet().radius_km).cos();
    let own = rivers.courses.iter().filter(|course| is_here(course.points[0].place.direction())).count();
    assert!(own > 3, "{own} rivers");

    let land = place(&bare, 300.0, |m| m > 150.0);
    let sunk = terrain(vec![paint(Tool::Uplift(UpliftPaint { uplift_m: -4000.0 }), 500.0, &land)]);
    // Far from the sea it is a basin that rivers fill, not a gulf.
    let [before_m, after_m] = [&bare, &sunk].map(|terrain| mean(&heights_m(terrain, &land, 150.0)));
    assert!(after_m < before_m - 100.0, "{before_m} {after_m}");
}

#[test]
fn hard_rock_stands_high_and_rain_falls_where_it_is_painted() {
    let bare = terrain(Vec::new());
    let land = place(&bare, 500.0, |m| m > 250.0);
    let mean_of = |hardness: f64| {
        let painted = terrain(vec![paint(Tool::Rock(RockPaint { hardness }), 800.0, &land)]);
        mean(&heights_m(&painted, &land, 400.0))
    };
    let [soft_m, bare_m, hard_m] = [mean_of(-2.0), mean(&heights_m(&bare, &land, 400.0)), mean_of(2.0)];
    assert!(soft_m < 0.8 * bare_m && hard_m > 1.2 * bare_m, "{soft_m} {bare_m} {hard_m}");

    let wet = terrain(vec![paint(Tool::Rain(RainPaint { rain_mm: 4000.0 }), 1200.0, &land)]);
    let wanted = Wanted::HEIGHT.and_water().and_climate();
    let sample = |terrain: &Terrain| terrain.samples(&[land.direction()], wanted)[0];
    let (before, after) = (sample(&bare), sample(&wet));
    assert!((after.rain_mm - before.rain_mm - 4000.0).abs() < 200.0, "{} {}", before.rain_mm, after.rain_mm);
    assert!(after.moisture > before.moisture);
    // No rain is less than none.
    let dry = terrain(vec![paint(Tool::Rain(RainPaint { rain_mm: -6000.0 }), 1200.0, &land)]);
    assert!((0.0..1.0).contains(&sample(&dry).rain_mm));
}

#[test]
fn a_river_runs_where_its_course_is_drawn() {
    let bare = terrain(Vec::new());
    let land = place(&bare, 350.0, |m| m > 100.0);
    let mut line: Vec<EditPoint> =
        (-3..=3).map(|k| EditPoint::under(beside(&land, 60.0, f64::from(k) * 100.0))).collect();
    // A river does not run up.
    line.sort_by(|a, b| bare.height_m(b.direction()).total_cmp(&bare.height_m(a.direction())));
    let (highest, lowest) = (line[0], line[line.len() - 1]);
    let line: Vec<EditPoint> = (0..=6)
        .map(|k| EditPoint::under(highest.direction().lerp(lowest.direction(), f64::from(k) / 6.0).normalize()))
        .collect();
    let river = RiverCourse { spring_m3_s: 3000.0, cut: 1.0 };
    let drawn = terrain(vec![edit(Tool::River(river), 1.0, &line)]);
    // Cells are some 200 km wide on the coarsest grid: a great river is near each of the points.
    let near = |terrain: &Terrain| {
        let rivers = terrain.rivers(3000.0);
        let points: Vec<DVec3> = rivers.courses.iter().flat_map(|c| &c.points).map(|p| p.place.direction()).collect();
        let is_near = |at: &&EditPoint| points.iter().any(|dir| dir.angle_between(at.direction()) < 1.0 / 32.0);
        line.iter().filter(is_near).count()
    };
    let (found, before) = (near(&drawn), near(&bare));
    assert!(found == line.len() && before < line.len() / 2, "{found}, without the line {before}");
}

#[test]
fn structural_edits_solve_weather_and_rivers_again_and_nothing_without_a_structure() {
    let land = at(20.0, 30.0);
    let uplift = |uplift_m| paint(Tool::Uplift(UpliftPaint { uplift_m }), 300.0, &land);
    let with = |planet: Planet, edits: Vec<GroundEdit>| {
        Revision::try_new(Arc::new(Planet { edits: edits.into_iter().collect(), ..planet })).unwrap()
    };
    let (none, one, two) =
        (with(planet(), vec![]), with(planet(), vec![uplift(1000.0)]), with(planet(), vec![uplift(2000.0)]));
    for (a, b) in [(&none, &one), (&one, &two)] {
        assert!(b.changes_since(a).contains(Stage::Field), "rivers carve other ground");
    }
    let hidden = with(planet(), vec![GroundEdit { enabled: false, ..uplift(1000.0) }]);
    assert!(!hidden.changes_since(&none).contains(Stage::Field));

    let flat = Planet { water: Some(Water::default()), ..Planet::default() };
    let [before, after] = [vec![], vec![uplift(5000.0)]].map(|edits| with(flat.clone(), edits));
    assert!(!after.changes_since(&before).touches_tiles(), "no structure, nothing to answer");
}

#[test]
fn rivers_around_the_planet_again_and_again_are_refused() {
    let round = |times: usize| {
        let points: Vec<EditPoint> = (0..=4 * times).map(|k| at(0.0, -180.0 + 90.0 * (k % 4) as f64)).collect();
        let edits = [edit(Tool::River(RiverCourse::default()), 1.0, &points)].into_iter().collect();
        Planet { edits, ..planet() }.check()
    };
    assert!(round(70).is_ok());
    let error = round(90).unwrap_err().to_string();
    assert!(error.contains("565 radii") && error.contains("at most 500"), "{error}");
}
