//! Life by hand: what strokes clear and plant, and roads and walls on which nothing stands.

use crate::sculpt::{at, edit};
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;
use tellus::life::{Canopies, Instance, ObjectPatch, SceneryCell};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::edits::{EditPoint, GroundEdit, LifePaint, MaskPaint, PlacedObject, Road, Tool, Wall};
use tellus::planet::param::{Stage, Stages};
use tellus::planet::{Biome, Layer, Planet, Population, Shape, Table, Water};
use tellus::sphere::LatLon;
use tellus::terrain::{Capsule, Revision, Terrain};
use tellus::tiles::{Builder, Surface};

const RADIUS_M: f64 = 1_000_000.0;

fn named(name: &str, per_hectare: f64, biomes: &str) -> Population {
    let seed = name.len() as u32;
    let biomes = biomes.to_owned();
    Population {
        name: name.to_owned(),
        per_hectare,
        biomes,
        clumping: 0.0,
        shore_m: 0.5,
        seed,
        ..Population::default()
    }
}

/// Oaks stand everywhere, palms nowhere by rule.
fn two() -> Vec<Population> {
    vec![named("Oak", 300.0, ""), named("Palm", 200.0, "b")]
}

/// Dry level ground of one biome.
fn level(life: Vec<Population>, edits: Vec<GroundEdit>) -> Planet {
    let edits = edits.into_iter().collect();
    let mut planet = Planet { radius_km: RADIUS_M / 1000.0, life, edits, ..Planet::default() };
    (planet.layers, planet.water) = (Vec::new(), None);
    let biome = |key| Biome { key, ..Biome::default() };
    planet.biomes.palette = vec![biome('a'), biome('b')];
    planet.biomes.table = Table::uniform('a', 4, 3);
    (planet.biomes.beach_m, planet.biomes.snow) = (0.0, false);
    planet
}

/// Hills, half of them under a sea.
fn hilly(life: Vec<Population>, edits: Vec<GroundEdit>) -> Planet {
    let shape = Shape::Fbm(tellus::planet::Fbm { wavelength_km: 4.0, octaves: 9, ..Default::default() });
    let layers = vec![Layer { amplitude_m: 60.0, shape, ..Layer::default() }];
    Planet { layers, water: Some(Water::default()), ..level(life, edits) }
}

fn terrain(planet: Planet) -> Terrain {
    Terrain::try_new(Arc::new(planet)).unwrap()
}

/// A stroke of the life tool with a sharp edge.
fn stroke(population: &str, density: f64, radius_m: f64, points: &[EditPoint]) -> GroundEdit {
    let paint = LifePaint { population: population.to_owned(), density };
    GroundEdit { softness: 0.0, ..edit(Tool::Life(paint), radius_m / 1000.0, points) }
}

fn away_m(instance: &Instance, middle: &EditPoint) -> f64 {
    2.0 * (0.5 * (instance.dir_planet - middle.direction()).length()).asin() * RADIUS_M
}

fn count(found: &[Instance], population: u16, middle: &EditPoint, ring_m: [f64; 2]) -> f64 {
    let is_in = |instance: &&Instance| {
        instance.population == population && (ring_m[0]..ring_m[1]).contains(&away_m(instance, middle))
    };
    found.iter().filter(is_in).count() as f64
}

/// Whether a count is that of a density on a ring, within three deviations.
fn is_near(count: f64, per_hectare: f64, ring_m: [f64; 2]) -> bool {
    let wanted = per_hectare * std::f64::consts::PI * (ring_m[1].powi(2) - ring_m[0].powi(2)) / 10_000.0;
    (count - wanted).abs() <= 3.0 * wanted.sqrt()
}

#[test]
fn a_cleared_disc_is_bare_and_a_planted_one_is_full_within_three_deviations() {
    for middle in [at(20.0, 30.0), at(0.001, 45.0), at(89.9, 10.0)] {
        // The fade of a sharp stroke is a hundredth of its radius.
        let (inside, outside) = ([0.0, 148.0], [150.0, 300.0]);
        let counts = |edits: Vec<GroundEdit>| {
            let found = terrain(level(two(), edits)).instances(middle.direction(), 300.0).unwrap();
            [0, 1].map(|population| [inside, outside].map(|ring_m| count(&found, population, &middle, ring_m)))
        };
        let paint = |population: &str, density: f64| stroke(population, density, 150.0, &[middle]);
        for (edits, [oaks, palms]) in [
            (vec![], [300.0, 0.0]),
            (vec![paint("", 0.0)], [0.0, 0.0]),
            (vec![paint("Oak", 0.0)], [0.0, 0.0]),
            (vec![paint("Palm", 1.0)], [300.0, 200.0]),
            (vec![paint("Palm", 0.5)], [300.0, 100.0]),
            (vec![paint("", 1.0)], [300.0, 200.0]),
            (vec![paint("", 0.25)], [75.0, 50.0]),
            (vec![paint("", 0.0), paint("Palm", 1.0)], [0.0, 200.0]),
            (vec![paint("Palm", 1.0), paint("", 0.0)], [0.0, 0.0]),
        ] {
            let told = format!("{middle:?} {edits:?}");
            let [[oaks_in, oaks_out], [palms_in, palms_out]] = counts(edits);
            assert!(is_near(oaks_in, oaks, inside) && is_near(palms_in, palms, inside), "{oaks_in} {palms_in} {told}");
            assert!(is_near(oaks_out, 300.0, outside) && palms_out == 0.0, "{oaks_out} {palms_out} {told}");
        }
    }
}

#[test]
fn a_soft_stroke_fades_and_so_does_one_that_is_pressed_lightly() {
    let middle = at(20.0, 30.0);
    let soft = GroundEdit { softness: 1.0, ..stroke("", 0.0, 300.0, &[middle]) };
    let found = terrain(level(two(), vec![soft])).instances(middle.direction(), 300.0).unwrap();
    let rings: Vec<f64> = (0..5)
        .map(|i| f64::from(i) * 60.0)
        .map(|from| count(&found, 0, &middle, [from, from + 60.0]) / ((from + 60.0).powi(2) - from.powi(2)))
        .collect();
    assert!(rings.is_sorted() && rings[0] < 0.1 * rings[4], "{rings:?}");
    let light = stroke("", 0.0, 150.0, &[EditPoint { strength: 0.5, ..middle }]);
    let found = terrain(level(two(), vec![light])).instances(middle.direction(), 300.0).unwrap();
    assert!(is_near(count(&found, 0, &middle, [0.0, 148.0]), 150.0, [0.0, 148.0]));
}

/// Cells that are larger than the soil's sample the ground for each candidate.
#[test]
fn sparse_populations_are_cleared_and_planted_too() {
    let middle = at(20.0, 30.0);
    let life = vec![named("Giant", 0.01, ""), named("Needle", 0.02, "b")];
    let edits = vec![stroke("Giant", 0.0, 30_000.0, &[middle]), stroke("Needle", 1.0, 30_000.0, &[middle])];
    let found = terrain(level(life, edits)).instances(middle.direction(), 60_000.0).unwrap();
    let (inside, outside) = ([0.0, 29_600.0], [30_000.0, 60_000.0]);
    assert_eq!(count(&found, 0, &middle, inside), 0.0);
    assert!(is_near(count(&found, 0, &middle, outside), 0.01, outside));
    assert!(is_near(count(&found, 1, &middle, inside), 0.02, inside));
    assert_eq!(count(&found, 1, &middle, outside), 0.0);
}

#[test]
fn nothing_is_planted_in_water_and_what_may_stand_there_is() {
    let middle = at(20.0, 30.0);
    let reeds = Population { in_water: true, ..named("Reed", 50.0, "b") };
    let life = vec![named("Palm", 300.0, "b"), reeds];
    let terrain = terrain(hilly(life, vec![stroke("", 1.0, 2000.0, &[middle])]));
    let found = terrain.instances(middle.direction(), 2000.0).unwrap();
    let palms: Vec<&Instance> = found.iter().filter(|instance| instance.population == 0).collect();
    assert!(palms.len() > 10_000 && palms.iter().all(|palm| palm.ground_m >= 0.5), "{}", palms.len());
    assert!(is_near(count(&found, 1, &middle, [0.0, 1980.0]), 50.0, [0.0, 1980.0]));
    assert!(found.iter().any(|instance| instance.population == 1 && instance.ground_m < -1.0));
}

/// A line along the equator from 0 to 0.06 degrees, a kilometre.
fn line() -> [EditPoint; 3] {
    let [mut from, mut middle, mut to] = [at(0.0, 0.0), at(0.0, 0.03), at(0.0, 0.06)];
    (from.width, middle.width, to.width) = (1.0, 0.5, 1.5);
    [from, middle, to]
}

/// Width of the line as a share of the radius at a direction; None beyond its ends.
fn width_at(dir: DVec3) -> Option<f64> {
    let lon_deg = dir.y.atan2(dir.x).to_degrees();
    let share = lon_deg / 0.03;
    (0.0..2.0).contains(&share).then_some(if share < 1.0 { 1.0 - 0.5 * share } else { 0.5 + (share - 1.0) })
}

#[test]
fn nothing_stands_on_the_bed_of_a_road_nor_on_the_top_of_a_wall_and_something_right_beside_them() {
    let life = vec![named("Fern", 4000.0, ""), named("Oak", 300.0, "")];
    let road = GroundEdit { softness: 0.4, ..edit(Tool::Road(Road::default()), 0.020, &line()) };
    let wall = edit(Tool::Wall(Wall { height_m: 5.0, top: 0.6 }), 0.020, &line());
    // The bed of the road reaches half-way down its sides.
    for (built, bed) in [(road.clone(), 0.8), (wall, 0.6)] {
        let terrain = terrain(level(life.clone(), vec![built.clone()]));
        let found = terrain.instances(at(0.0, 0.03).direction(), 500.0).unwrap();
        let aside = |instance: &&Instance| {
            let width_m = 20.0 * width_at(instance.dir_planet)?;
            Some((instance.dir_planet.z.asin().abs() * RADIUS_M, width_m))
        };
        let (mut on_bed, mut beside) = (0, 0);
        for (away_m, width_m) in found.iter().filter_map(|instance| aside(&instance)) {
            on_bed += usize::from(away_m < bed * width_m - 0.01);
            beside += usize::from(away_m > bed * width_m + 0.01 && away_m < (bed + 0.15) * width_m);
        }
        assert_eq!(on_bed, 0, "{:?}", built.tool);
        assert!(beside > 500, "{beside} {:?}", built.tool);
        // Edits act in order: a stroke plants what is under it.
        let grown = self::terrain(level(life.clone(), vec![built, stroke("Fern", 1.0, 60.0, &line())]));
        let found = grown.instances(at(0.0, 0.03).direction(), 500.0).unwrap();
        let is_on = |instance: &Instance| instance.dir_planet.z.asin().abs() * RADIUS_M < 3.0;
        assert!(found.iter().any(|instance| is_on(instance) && instance.population == 0));
    }
    let off = GroundEdit { enabled: false, ..road };
    let found = terrain(level(life, vec![off])).instances(at(0.0, 0.03).direction(), 500.0).unwrap();
    assert!(found.iter().any(|instance| instance.dir_planet.z.asin().abs() * RADIUS_M < 3.0));
}

#[test]
fn a_part_of_a_painted_place_has_the_objects_that_the_whole_has_there() {
    let middle = at(20.0, 30.0);
    let grass = Population { clumping: 0.5, ..named("Grass", 9000.0, "") };
    let ragged = GroundEdit { softness: 0.6, raggedness: 0.5, ..stroke("", 0.1, 70.0, &[middle, at(20.004, 30.003)]) };
    let road = edit(Tool::Road(Road::default()), 0.012, &[at(19.999, 29.998), at(20.003, 30.004)]);
    let edits = vec![ragged, stroke("Palm", 1.0, 50.0, &[at(20.001, 30.001)]), road];
    let terrain = terrain(hilly([two(), vec![grass]].concat(), edits));
    let whole = terrain.instances(middle.direction(), 150.0).unwrap();
    let corner = at(20.001, 30.001);
    let part = terrain.instances(corner.direction(), 55.0).unwrap();
    let wanted: Vec<_> = whole.iter().filter(|instance| away_m(instance, &corner) <= 55.0).copied().collect();
    assert!(part.len() > 100 && part.iter().any(|instance| instance.population == 1), "{}", part.len());
    assert_eq!(part, wanted);
}

#[test]
fn symmetry_and_a_painted_mask_count_for_strokes_of_life() {
    let middle = at(20.0, 30.0);
    let mask = Tool::Mask(MaskPaint { mask: "Zone".to_owned(), amount: 1.0 });
    let zone = GroundEdit { softness: 0.0, ..edit(mask, 0.1, &[middle]) };
    let clears = GroundEdit { mask: "Zone".to_owned(), mirrored: true, ..stroke("", 0.0, 250.0, &[middle]) };
    let outside = GroundEdit { outside_mask: true, ..clears.clone() };
    let counts = |edits: Vec<GroundEdit>, middle: &EditPoint| {
        let found = terrain(level(two(), edits)).instances(middle.direction(), 300.0).unwrap();
        [[0.0, 98.0], [100.0, 247.0]].map(|ring_m| (count(&found, 0, middle, ring_m), ring_m))
    };
    let [near, ring] = counts(vec![zone.clone(), clears], &middle);
    assert!(near.0 == 0.0 && is_near(ring.0, 300.0, ring.1), "{near:?} {ring:?}");
    let [near, ring] = counts(vec![zone.clone(), outside.clone()], &middle);
    assert!(is_near(near.0, 300.0, near.1) && ring.0 == 0.0, "{near:?} {ring:?}");
    // The image has no mask over it.
    let [near, ring] = counts(vec![zone, outside], &at(-20.0, 30.0));
    assert!(near.0 == 0.0 && ring.0 == 0.0, "{near:?} {ring:?}");
}

#[test]
fn canopies_and_solid_objects_agree_with_what_stands() {
    let middle = at(20.0, 30.0);
    let edits = vec![stroke("Oak", 0.0, 150.0, &[middle]), stroke("Palm", 0.5, 150.0, &[middle])];
    let (bare, painted) = (terrain(level(two(), Vec::new())), Arc::new(terrain(level(two(), edits))));
    let canopies = [Canopies::new(&bare), Canopies::new(&painted)];
    let inside = middle.direction();
    let densities = |canopies: &Canopies, dir: DVec3| canopies.densities_per_hectare(dir, &bare.sample(dir));
    assert_eq!(densities(&canopies[0], inside), [300.0, 0.0]);
    assert_eq!(densities(&canopies[1], inside), [0.0, 100.0]);
    let outside = at(20.0, 30.02).direction();
    assert_eq!(densities(&canopies[1], outside), [300.0, 0.0]);
    let covers = [inside, outside].map(|dir| canopies[1].at(dir, &bare.sample(dir)).cover);
    assert!(covers[0] > 0.0 && covers[0] < covers[1], "{covers:?}");

    // A body at the foot of each tree.
    let (mut before, mut after) = (ObjectPatch::new(Arc::new(bare.clone())), ObjectPatch::new(painted.clone()));
    let foot = |instance: &Instance| {
        Capsule::sphere(instance.foot_planet_m(RADIUS_M) + instance.dir_planet * (0.1 * instance.size_m), 0.3)
    };
    let oaks = bare.instances(inside, 60.0).unwrap();
    assert!(oaks.len() > 200 && oaks.iter().all(|oak| before.contact(&foot(oak), 0.0).is_some()));
    let met = oaks.iter().filter_map(|oak| after.contact(&foot(oak), 0.0));
    assert!(met.into_iter().all(|met| met.object.population(painted.planet()) == Some(1)), "only palms are left");
    let palms = painted.instances(inside, 60.0).unwrap();
    assert!(palms.len() > 50 && palms.iter().all(|palm| after.contact(&foot(palm), 0.0).is_some()));
}

fn settled(builder: &Builder, planet: &Planet, view: &View) -> Arc<Surface> {
    builder.request(&Arc::new(planet.clone()), view).unwrap();
    while builder.is_busy() {
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    builder.surface().unwrap()
}

/// The objects of a surface by population and node.
fn cells(surface: &Surface) -> HashMap<(u16, tellus::sphere::NodeId), Arc<SceneryCell>> {
    surface.scenery.cells.iter().map(|cell| ((cell.population, cell.id), cell.clone())).collect()
}

#[test]
fn a_stroke_of_life_changes_no_key_of_tiles_and_makes_the_cells_anew_that_it_touches() {
    let planet = hilly(two(), Vec::new());
    let bare = terrain(planet.clone());
    let is_dry = |point: &EditPoint| bare.instances(point.direction(), 59.0).unwrap().len() > 200;
    let middle = (0..200).map(|i| at(20.0, 30.0 + 0.01 * f64::from(i))).find(is_dry).unwrap();
    let ground_m = bare.height_m(middle.direction());
    let place = LatLon::from_degrees(middle.latitude_deg, middle.longitude_deg);
    let camera = Camera::over(place, RADIUS_M + ground_m + 60.0, 0.0, -0.6, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [320, 200], quality: Quality::Low };
    let builder = Builder::new(|| {});
    let before = settled(&builder, &planet, &view);
    let mut painted = planet.clone();
    painted.edits.push(stroke("Oak", 0.0, 60.0, &[middle]));
    let revisions = [&planet, &painted].map(|planet| Revision::try_new(Arc::new(planet.clone())).unwrap());
    assert_eq!(revisions[1].changes_since(&revisions[0]), Stages::of(&[Stage::Life]));

    let after = settled(&builder, &painted, &view);
    assert_eq!(after.stats.tiles_built, 0);
    let same = |a: &Surface, b: &Surface| a.leaves.iter().zip(&b.leaves).all(|(a, b)| Arc::ptr_eq(&a.tile, &b.tile));
    assert!(before.leaves.len() == after.leaves.len() && same(&before, &after));
    let (old, new) = (cells(&before), cells(&after));
    let is_kept = |name| matches!((old.get(name), new.get(name)), (Some(a), Some(b)) if Arc::ptr_eq(a, b));
    let kept = old.keys().filter(|name| is_kept(*name)).count();
    assert!(kept < old.len() && 2 * kept > old.len(), "{kept} of {}", old.len());
    assert!(new.keys().filter(|(population, _)| *population == 1).all(&is_kept), "strokes of oaks move no palm");
    // What is drawn are the objects that queries answer.
    let count = |surface: &Surface| {
        let near = |foot: DVec3| foot.normalize().distance(middle.direction()) * RADIUS_M < 59.0;
        let objects = surface.scenery.cells.iter().flat_map(|cell| &cell.objects);
        objects.filter(|object| near(object.foot_planet_m)).count()
    };
    assert!(count(&before) > 100);
    assert_eq!(count(&after), 0);
    let afresh = settled(&Builder::new(|| {}), &painted, &view);
    let counts = [&after, &afresh].map(|surface| surface.scenery.object_count());
    assert_eq!(counts[0], counts[1]);

    // Undone, the first objects are back.
    let undone = settled(&builder, &planet, &view);
    assert_eq!((undone.stats.tiles_built, undone.scenery.object_count()), (0, before.scenery.object_count()));
}

/// A hand that paints asks for a new planet in every frame, sooner than the one before is done.
#[test]
fn a_stroke_shows_while_the_hand_moves() {
    let middle = at(20.0, 30.0);
    let planet = level(two(), Vec::new());
    let place = LatLon::from_degrees(20.0, 30.0);
    let camera = Camera::over(place, RADIUS_M + 60.0, 0.0, -0.6, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [320, 200], quality: Quality::Low };
    let builder = Builder::new(|| {});
    settled(&builder, &planet, &view);
    let near = |surface: &Surface| {
        let is_near = |foot: DVec3| foot.normalize().distance(middle.direction()) * RADIUS_M < 20.0;
        let objects = surface.scenery.cells.iter().flat_map(|cell| &cell.objects);
        objects.filter(|object| is_near(object.foot_planet_m)).count()
    };
    assert!(near(&builder.surface().unwrap()) > 10);
    let mut painted = planet;
    painted.edits.push(stroke("", 0.0, 30.0, &[middle]));
    for frame in 0..600 {
        if let Some(edit) = painted.edits.get_mut(0) {
            edit.points.0.push(at(20.0, 30.0 + 1e-5 * f64::from(frame)));
        }
        builder.request(&Arc::new(painted.clone()), &view).unwrap();
        std::thread::sleep(std::time::Duration::from_millis(5));
        if near(&builder.surface().unwrap()) == 0 {
            return;
        }
    }
    panic!("the clearing was not seen in 600 frames");
}

#[test]
fn strokes_go_through_text_and_an_unknown_population_is_told() {
    let planet =
        level(two(), vec![stroke("Palm", 0.25, 150.0, &[at(20.0, 30.0)]), stroke("", 0.0, 9.0, &[at(1.0, 2.0)])]);
    let text = planet.to_text();
    assert_eq!(Planet::from_text("f.ron", &text).unwrap(), planet);
    let told = |text: &str| Planet::from_text("f.ron", text).unwrap_err().to_string();
    let message = told(&text.replace("population: \"Palm\"", "population: \"Plam\""));
    let line = text.lines().position(|line| line.contains("population: \"Palm\"")).unwrap() + 1;
    assert!(message.starts_with(&format!("f.ron:{line}:")), "{message}");
    let wanted = "edits[0].tool.population: there is no population called \"Plam\"; use \"Oak\" or \"Palm\", or an \
                  empty text for all";
    assert!(message.contains(wanted), "{message}");
    let message = told(&text.replace("density: 0.25", "density: 1.25"));
    assert!(message.contains("edits[0].tool.density: 1.25 is out of range; use 0 to 1"), "{message}");
    let bare = Planet { life: Vec::new(), ..planet };
    assert!(bare.check().unwrap_err().to_string().contains("add a population"));
}

fn object(population: &str, size: f64, turn_deg: f64, point: EditPoint) -> GroundEdit {
    let population = population.to_owned();
    edit(Tool::Object(PlacedObject { population, size, turn_deg, random_turn_deg: 0.0 }), 0.002, &[point])
}

#[test]
fn single_objects_stand_where_they_are_put_as_high_and_turned_as_asked() {
    let place = at(20.0, 30.0);
    let others = terrain(level(two(), vec![stroke("", 0.0, 100.0, &[place])]));
    assert!(others.instances(place.direction(), 90.0).unwrap().is_empty());
    let north = tellus::sphere::Tangent::new(place.direction()).north_planet;
    for (name, population) in [("Palm", 1), ("", 0)] {
        // Strokes do not clear it, before or after.
        let edits = vec![object(name, 1.5, 90.0, place), stroke("", 0.0, 100.0, &[place])];
        let planet = level(two(), edits);
        let terrain = terrain(planet.clone());
        let found = terrain.instances(place.direction(), 90.0).unwrap();
        let [one] = found[..] else { panic!("{name}: {} objects", found.len()) };
        assert_eq!((one.population, one.dir_planet, one.rank), (population, place.direction(), 0.0));
        assert_eq!((one.ground_m, one.size_m), (terrain.height_m(place.direction()), 15.0));
        assert!(one.planet_from_form().x_axis.dot(north) < -0.9, "clockwise from east is south");
        // Bodies hit it, and it keeps its id where others come and go.
        let terrain = Arc::new(terrain);
        let foot_m = one.foot_planet_m(RADIUS_M) + one.dir_planet * 1.5;
        let met = ObjectPatch::new(terrain).contact(&Capsule::sphere(foot_m, 0.3), 0.0).unwrap();
        assert_eq!(met.object, one.object());
        let mut more = planet;
        more.edits.push(object(name, 1.0, 0.0, at(20.0003, 30.0)));
        let more = self::terrain(more).instances(place.direction(), 90.0).unwrap();
        assert!(more.len() == 2 && more.contains(&one));
    }
}

#[test]
fn objects_are_there_once_in_parts_and_with_copies_and_images() {
    let place = at(0.0, 45.0);
    let grove = GroundEdit { copies: 60, spread_km: 0.2, mirrored: true, ..object("Palm", 1.0, 0.0, at(0.001, 45.0)) };
    let terrain = terrain(level(two(), vec![grove]));
    let palms = |radius_m: f64, point: &EditPoint| -> Vec<Instance> {
        let found = terrain.instances(point.direction(), radius_m).unwrap();
        found.into_iter().filter(|instance| instance.population == 1).collect()
    };
    let whole = palms(300.0, &place);
    assert_eq!(whole.len(), 120);
    let corner = at(0.002, 45.003);
    let wanted: Vec<Instance> = whole.iter().filter(|palm| away_m(palm, &corner) <= 80.0).copied().collect();
    assert!(wanted.len() > 5);
    assert_eq!(palms(80.0, &corner), wanted);
    // Only the cells that hold them are made anew.
    let planets = [level(two(), Vec::new()), level(two(), vec![object("Oak", 1.0, 0.0, place)])];
    let [before, after] = planets.map(|planet| Revision::try_new(Arc::new(planet)).unwrap());
    assert_eq!(after.changes_since(&before), Stages::of(&[Stage::Life]));
}

#[test]
fn placed_objects_that_are_larger_than_any_that_grows_are_hit_all_the_same() {
    let place = at(20.0, 30.0);
    let terrain = Arc::new(terrain(level(vec![named("Palm", 200.0, "b")], vec![object("Palm", 4.0, 0.0, place)])));
    let [one] = terrain.instances(place.direction(), 90.0).unwrap()[..] else { panic!("one object") };
    assert_eq!(one.size_m, 40.0);
    let mut patch = ObjectPatch::new(terrain);
    let over = |height_m: f64| one.foot_planet_m(RADIUS_M) + one.axis_planet * height_m;
    let heights_m: Vec<f64> = (1..80).map(|step| 0.5 * f64::from(step)).collect();
    let is_met = |height_m: &f64| patch.contact(&Capsule::sphere(over(*height_m), 0.3), 0.0).is_some();
    let high_m = heights_m.into_iter().filter(is_met).fold(0.0, f64::max);
    assert!(high_m > 15.0, "the trunk ends at {high_m} m");
    // What flies by at that height meets it, too.
    let aside = one.axis_planet.any_orthonormal_vector();
    let far = Capsule::sphere(over(high_m) + aside * 150.0, 0.3);
    assert!(patch.sweep(&far, aside * -300.0, 0.01).is_some());
}
