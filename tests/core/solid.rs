//! Objects that are hit: rays, contacts and sweeps against trunks and boulders, and walkers who go among them.

use parry3d::math::Vector;
use parry3d::query::PointQuery as _;
use parry3d::shape::TriMesh;
use proptest::prelude::*;
use std::sync::{Arc, LazyLock, Mutex};
use tellus::glam::DVec3;
use tellus::life::{HiddenObjects, Instance, Model, ObjectPatch, Surroundings};
use tellus::planet::life::READY_POPULATIONS;
use tellus::planet::{Layer, Planet, Population, Shape, Table};
use tellus::sphere::{LatLon, Tangent, spread};
use tellus::terrain::{Capsule, GroundPatch, RayLimits, Terrain, Walker, WalkerBody};

const RADIUS_M: f64 = 600_000.0;
const SKIN_M: f64 = 0.01;

/// A ready population that stands anywhere, as dense as is wanted.
fn population(name: &str, per_hectare: f64, seed: u32) -> Population {
    let ready = READY_POPULATIONS.iter().find(|ready| ready.name == name).unwrap().population();
    let anywhere = Population { slope_from_deg: 0.0, slope_to_deg: 90.0, ..Population::default() };
    Population {
        form: ready.form.clone(),
        height_m: ready.height_m,
        upright: ready.upright,
        sunk: ready.sunk,
        seed,
        lean_deg: ready.lean_deg,
        height_spread: ready.height_spread,
        per_hectare,
        clumping: 0.0,
        ..anywhere
    }
}

/// Rolling ground with objects.
fn terrain_with(life: Vec<Population>) -> Arc<Terrain> {
    let mut planet = Planet { radius_km: RADIUS_M / 1000.0, life, water: None, ..Planet::default() };
    let fbm = tellus::planet::Fbm { wavelength_km: 3.0, octaves: 9, ..Default::default() };
    planet.layers = vec![Layer { amplitude_m: 60.0, shape: Shape::Fbm(fbm), ..Layer::default() }];
    planet.biomes.table = Table::uniform(planet.biomes.palette[0].key, 4, 3);
    planet.biomes.snow = false;
    Arc::new(Terrain::try_new(Arc::new(planet)).unwrap())
}

/// Six hundred trunks on a hectare, and boulders between them.
fn forest() -> Arc<Terrain> {
    static FOREST: LazyLock<Arc<Terrain>> = LazyLock::new(|| {
        let trees = population("Broadleaf tree", 300.0, 1);
        let conifers = population("Conifer", 300.0, 2);
        terrain_with(vec![trees, conifers, population("Boulder", 60.0, 3)])
    });
    FOREST.clone()
}

fn middle() -> DVec3 {
    LatLon::from_degrees(20.0, 30.0).direction()
}

/// The objects of the forest that all cases of a test share: what they were asked before must not matter.
fn shared() -> std::sync::MutexGuard<'static, ObjectPatch> {
    static PATCH: LazyLock<Mutex<ObjectPatch>> = LazyLock::new(|| Mutex::new(ObjectPatch::new(forest())));
    PATCH.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

/// Capsule over a place of the forest, at a height above the ground in metres.
fn capsule(terrain: &Terrain, [east_m, north_m, over_m]: [f64; 3], length_m: f64, radius_m: f64) -> Capsule {
    let dir = Tangent::new(middle()).direction(east_m / RADIUS_M, north_m / RADIUS_M);
    let middle_m = dir * (RADIUS_M + terrain.height_m(dir) + over_m);
    let half_m = Tangent::new(dir).planet(DVec3::new(0.6, -0.5, 0.4)).normalize() * (0.5 * length_m);
    Capsule { ends_planet_m: [middle_m - half_m, middle_m + half_m], radius_m }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn a_sweep_stops_at_an_object_and_never_passes_one(
        place in [-80.0..80.0_f64, -80.0..80.0_f64, 0.5..6.0_f64], long_m in 0.0..2.0_f64, radius_m in 0.05..0.6_f64,
        motion in [-1.0..1.0_f64, -1.0..1.0_f64, -0.3..0.3_f64], far_m in 0.1..40.0_f64,
    ) {
        let mut patch = shared();
        let capsule = capsule(&forest(), place, long_m, radius_m);
        let motion_m = Tangent::new(middle()).planet(DVec3::from(motion)).normalize_or(middle()) * far_m;
        let start = patch.contact(&capsule, 1.0);
        prop_assume!(start.is_none_or(|start| start.hit.gap_m > SKIN_M + 1e-3));
        let sweep = patch.sweep(&capsule, motion_m, SKIN_M);
        let share = sweep.map_or(1.0, |sweep| sweep.hit.share);
        if let Some(sweep) = sweep {
            let end = patch.contact(&capsule.moved(motion_m * share), 0.1).unwrap();
            prop_assert!((end.hit.gap_m - SKIN_M).abs() < 2e-4, "{}", end.hit.gap_m);
            prop_assert!((sweep.hit.contact.gap_m - end.hit.gap_m).abs() < 1e-5);
            prop_assert!(sweep.hit.contact.normal_planet.dot(motion_m) < 0.0);
        }
        for step in 0..=40 {
            let here = capsule.moved(motion_m * (share * f64::from(step) / 40.0));
            let gap_m = patch.contact(&here, 0.1).map_or(1.0, |met| met.hit.gap_m);
            prop_assert!(gap_m > SKIN_M - 1e-6, "{step}: {gap_m}");
        }
        // What has stopped may go back.
        let back = patch.sweep(&capsule.moved(motion_m * share), -motion_m * share, SKIN_M);
        prop_assert!(back.is_none_or(|back| back.hit.share > 0.0), "{back:?}");
    }

    #[test]
    fn a_ray_ends_where_a_thin_sweep_does(
        place in [-80.0..80.0_f64, -80.0..80.0_f64, 0.5..9.0_f64],
        way in [-1.0..1.0_f64, -1.0..1.0_f64, -0.5..0.5_f64], to_m in 1.0..60.0_f64,
    ) {
        let mut patch = shared();
        let thin = capsule(&forest(), place, 0.0, 1e-4);
        let dir = Tangent::new(middle()).planet(DVec3::from(way)).normalize_or(middle());
        let origin_m = thin.ends_planet_m[0];
        prop_assume!(patch.contact(&thin, 0.01).is_none());
        let hit = patch.raycast(origin_m, dir * 3.0, &RayLimits::default().to_m(to_m));
        let sweep = patch.sweep(&thin, dir * to_m, 0.0);
        if let Some(met) = hit {
            let hit = met.hit;
            prop_assert!(hit.away_m <= to_m && (hit.point_planet_m - origin_m - dir * hit.away_m).length() < 1e-6);
            prop_assert!((hit.normal_planet.length() - 1.0).abs() < 1e-6 && hit.normal_planet.dot(dir) < 1e-6);
            // The sweep stops a little earlier, or at what the ray passes by a hair.
            let swept = sweep.unwrap();
            prop_assert!(swept.hit.share * to_m < hit.away_m + 1e-6);
            let slant = -hit.normal_planet.dot(dir);
            if slant > 0.1 && swept.object == met.object {
                prop_assert!(hit.away_m - swept.hit.share * to_m < 3e-4 / slant + 1e-5);
            }
        } else if let Some(swept) = sweep {
            let gap_m = swept.hit.contact.point_planet_m.distance(origin_m + dir * (swept.hit.share * to_m));
            prop_assert!(gap_m < 1e-3 && (to_m * (1.0 - swept.hit.share) < 1e-3
                || swept.hit.contact.normal_planet.dot(dir) > -0.2), "{swept:?}");
        }
    }
}

#[test]
fn walkers_go_through_a_forest_and_never_into_a_trunk() {
    let terrain = forest();
    let mut around = Surroundings::new(terrain.clone());
    let body = WalkerBody::on(terrain.planet());
    let start = Tangent::new(middle());
    let (walkers, mut stuck, mut gone_m) = (12, 0, 0.0);
    for number in 0..walkers {
        let angle = f64::from(number) * 2.4;
        let dir = start.direction(3.0 * angle.cos() / RADIUS_M, 3.0 * angle.sin() / RADIUS_M);
        let mut walker = Walker::on_ground(body, &mut around, dir);
        let from_m = walker.feet_planet_m();
        let (mut before_m, mut heading, mut turned_secs) = (from_m, angle, 0);
        for step in 0..3600 {
            let wish_m_s = (start.east_planet * heading.cos() + start.north_planet * heading.sin()) * 1.5;
            walker.step(&mut around, wish_m_s, 1.0 / 60.0);
            let feet_m = walker.feet_planet_m();
            let gap_m = around.objects.contact(&body.capsule_at(feet_m), 0.1).map_or(1.0, |met| met.hit.gap_m);
            assert!(gap_m > 0.2 * SKIN_M, "{number} {step}: {gap_m}");
            assert!(feet_m.length() - RADIUS_M - terrain.height_m(feet_m) > -0.05, "{number} {step}");
            if step % 60 == 59 {
                // One who is caught between two trunks turns for some seconds, as a player would.
                turned_secs -= 1;
                if feet_m.distance(before_m) < 0.3 {
                    (stuck, heading, turned_secs) = (stuck + 1, heading + 1.2, 3);
                } else if turned_secs == 0 {
                    heading = angle;
                }
                before_m = feet_m;
            }
        }
        gone_m += walker.feet_planet_m().distance(from_m);
    }
    // 90 m as the crow flies for one who meets nothing; 720 seconds in all.
    assert!(gone_m / f64::from(walkers) > 65.0 && stuck < 40, "{gone_m} {stuck}");
}

#[test]
fn a_walker_who_is_put_into_a_trunk_stands_beside_it() {
    let terrain = forest();
    let mut around = Surroundings::new(terrain.clone());
    let body = WalkerBody::on(terrain.planet());
    for tree in terrain.instances(middle(), 25.0).unwrap() {
        let mut walker = Walker::on_ground(body, &mut around, tree.dir_planet);
        let gap_m = |around: &mut Surroundings, walker: &Walker| {
            around.objects.contact(&body.capsule_at(walker.feet_planet_m()), 0.1).map_or(1.0, |met| met.hit.gap_m)
        };
        assert!(gap_m(&mut around, &walker) > 0.0, "{tree:?}");
        (0..120).for_each(|_| walker.step(&mut around, DVec3::ZERO, 1.0 / 60.0));
        assert!(gap_m(&mut around, &walker) > 0.0, "{tree:?}");
    }
}

#[test]
fn hidden_objects_are_not_hit_and_the_list_leaves_them_out() {
    let terrain = forest();
    let mut patch = ObjectPatch::new(terrain.clone());
    let (eye, tangent) = (capsule(&terrain, [0.0, 0.0, 1.5], 0.0, 0.3), Tangent::new(middle()));
    let eye_m = eye.ends_planet_m[0];
    let limits = RayLimits::default().to_m(80.0);
    let all = terrain.instances(middle(), 100.0).unwrap();
    for number in 0..40 {
        let (sin, cos) = f64::from(number).sin_cos();
        let dir = tangent.east_planet * cos + tangent.north_planet * sin;
        let Some(first) = patch.raycast(eye_m, dir, &limits) else { continue };
        assert!(all.iter().any(|instance| instance.object() == first.object));
        let swept = patch.sweep(&eye, dir * 80.0, SKIN_M).unwrap();
        let contact = patch.contact(&eye.moved(dir * (80.0 * swept.hit.share)), 0.1).unwrap();
        assert!(patch.hidden_mut().hide(first.object) && !patch.hidden_mut().hide(first.object));
        patch.hidden_mut().extend([swept.object, contact.object]);
        let next = patch.raycast(eye_m, dir, &limits);
        assert!(next.is_none_or(|next| next.object != first.object && next.hit.away_m >= first.hit.away_m));
        assert!(patch.sweep(&eye, dir * 80.0, SKIN_M).is_none_or(|next| next.hit.share >= swept.hit.share));
        assert!(
            patch
                .another()
                .contact(&eye.moved(dir * (80.0 * swept.hit.share)), 5.0)
                .is_none_or(|met| { met.object != contact.object })
        );
    }
    let hidden: HiddenObjects = ron::from_str(&ron::to_string(patch.hidden()).unwrap()).unwrap();
    assert!(hidden == *patch.hidden() && hidden.len() > 20);
    let mut shown = all.clone();
    hidden.retain_shown(&mut shown);
    assert_eq!(shown.len() + hidden.len(), all.len());
    assert!(shown.iter().all(|instance| !hidden.holds(instance.object())));
    hidden.iter().for_each(|object| assert!(patch.hidden_mut().show(object)));
    assert!(patch.hidden().is_empty());
}

#[test]
fn answers_do_not_depend_on_what_was_asked_before() {
    let terrain = forest();
    let mut busy = ObjectPatch::new(terrain.clone()).budget_bytes(60_000);
    let mut backwards = busy.another().budget_bytes(usize::MAX);
    let questions: Vec<(Capsule, DVec3)> = spread(120)
        .enumerate()
        .map(|(number, way)| {
            let place = [40.0 * way.x + number as f64, 90.0 * way.y, 1.0 + way.z.abs()];
            (capsule(&terrain, place, 0.5, 0.3), way * 12.0)
        })
        .collect();
    let ask = |patch: &mut ObjectPatch, (capsule, motion_m): &(Capsule, DVec3)| {
        let ray = patch.raycast(capsule.ends_planet_m[0], *motion_m, &RayLimits::default().to_m(50.0));
        (patch.contact(capsule, 2.0), patch.sweep(capsule, *motion_m, SKIN_M), ray)
    };
    let forwards: Vec<_> = questions.iter().map(|question| ask(&mut busy, question)).collect();
    assert!(busy.resident_bytes() < 200_000, "{}", busy.resident_bytes());
    assert!(forwards.iter().filter(|(contact, ..)| contact.is_some()).count() > 40);
    assert!(forwards.iter().filter(|(_, sweep, ray)| sweep.is_some() && ray.is_some()).count() > 20);
    for (question, answer) in questions.iter().zip(&forwards).rev() {
        assert_eq!(ask(&mut backwards, question), *answer);
    }
    assert!(backwards.resident_bytes() > busy.resident_bytes());
}

/// Distance of a point from an object's mesh, metres.
fn from_mesh_m(mesh: &TriMesh, instance: &Instance, point_m: DVec3) -> f64 {
    let local = instance.planet_from_form().transpose() * (point_m - instance.foot_planet_m(RADIUS_M));
    let local = (local / instance.size_m).as_vec3();
    let at = Vector::new(local.x, local.y, local.z);
    f64::from((mesh.project_local_point(at, false).point - at).length()) * instance.size_m
}

#[test]
fn hulls_of_boulders_deviate_from_their_mesh_by_no_more_than_is_said() {
    for (name, most) in [("Boulder", 0.09), ("Ice block", 0.09), ("Lava block", 0.16), ("Regolith stone", 0.12)] {
        let boulders = population(name, 30.0, 7);
        let meshes: Vec<_> = Model::new(&boulders).variants.into_iter().map(|levels| levels[0].clone()).collect();
        let solid = |mesh: &tellus::life::form::Mesh| {
            let corners = mesh.vertices.iter().map(|v| Vector::new(v.position.x, v.position.y, v.position.z));
            let triangles = mesh.triangles.iter().map(|triangle| triangle.map(u32::from));
            TriMesh::new(corners.collect(), triangles.collect()).unwrap()
        };
        let solids: Vec<TriMesh> = meshes.iter().map(solid).collect();
        let terrain = terrain_with(vec![boulders]);
        let mut patch = ObjectPatch::new(terrain.clone());
        let found = terrain.instances(middle(), 60.0).unwrap();
        let mut hits = 0;
        for instance in &found {
            let (foot_m, turn) = (instance.foot_planet_m(RADIUS_M), instance.planet_from_form());
            for vertex in meshes[usize::from(instance.variant)].vertices.iter().step_by(17) {
                let corner_m = foot_m + turn * (vertex.position.as_dvec3() * instance.size_m);
                let contact = patch.contact(&Capsule::sphere(corner_m, 1e-5), instance.size_m).unwrap();
                if contact.object == instance.object() {
                    let (gap_m, deviation_m) = (contact.hit.gap_m, contact.hit.deviation_m);
                    assert!(gap_m.abs() < deviation_m + 1e-4, "{name}: {gap_m} {deviation_m}");
                    assert!(deviation_m < most * instance.size_m, "{name}: {}", deviation_m / instance.size_m);
                }
            }
            for dir in spread(60).filter(|dir| dir.dot(instance.dir_planet) > 0.0) {
                let origin_m = foot_m + dir * (6.0 * instance.size_m);
                let limits = RayLimits::default().to_m(6.0 * instance.size_m);
                let Some(met) = patch.raycast(origin_m, -dir, &limits) else { continue };
                if met.object == instance.object() {
                    hits += 1;
                    let mesh = &solids[usize::from(instance.variant)];
                    let away_m = from_mesh_m(mesh, instance, met.hit.point_planet_m);
                    assert!(away_m < most * instance.size_m, "{name}: {}", away_m / instance.size_m);
                }
            }
        }
        assert!(hits > 400 && found.len() > 20, "{name}: {hits}");
    }
}

#[test]
fn grass_is_not_hit_and_surroundings_answer_for_the_ground_too() {
    let grass = Population { solid: false, ..population("Boulder", 2000.0, 5) };
    let terrain = terrain_with(vec![grass, Population { solid: true, ..population("Grass", 20_000.0, 6) }]);
    let mut around = Surroundings::new(terrain.clone());
    let mut ground = GroundPatch::new(terrain.clone());
    let ball = capsule(&terrain, [3.0, 4.0, 2.0], 0.0, 0.5);
    let (eye_m, down_m) = (ball.ends_planet_m[0], middle() * -5.0);
    assert_eq!(around.objects.contact(&ball, 5.0), None);
    assert_eq!(around.sweep(&ball, down_m, SKIN_M).map(|met| met.hit), ground.sweep(&ball, down_m, SKIN_M));
    assert_eq!(around.contact(&ball, 5.0).map(|met| met.hit), ground.contact(&ball, 5.0));
    let met = around.raycast(eye_m, down_m, &RayLimits::default()).unwrap();
    assert!(met.object.is_none() && (met.hit.away_m - 2.0).abs() < 0.01 && met.hit.normal_planet.dot(middle()) > 0.9);
    assert_eq!(terrain.raycast(eye_m, down_m), Some(met.hit.away_m));
    assert!(around.resident_bytes() >= around.ground.resident_bytes());
    // Over the forest a ray from high up meets what is highest.
    let mut around = Surroundings::new(forest());
    let tree = forest().instances(middle(), 20.0).unwrap()[0];
    let trunk_m = tree.foot_planet_m(RADIUS_M) + tree.axis_planet * (0.04 * tree.size_m);
    let high_m = trunk_m + middle().any_orthonormal_vector() * 9000.0 + middle() * 9000.0;
    let met = around.raycast(high_m, trunk_m - high_m, &RayLimits::default()).unwrap();
    assert!(met.hit.away_m <= high_m.distance(trunk_m) && met.object.is_some(), "{met:?}");
}

#[test]
fn what_is_not_finite_or_far_too_large_meets_nothing() {
    let mut patch = shared();
    let good = capsule(&forest(), [0.0, 0.0, 1.0], 1.0, 0.5);
    for bad in [f64::NAN, f64::INFINITY] {
        assert_eq!(patch.contact(&Capsule::sphere(DVec3::splat(bad), 1.0), 1.0), None);
        assert_eq!(patch.sweep(&good, DVec3::splat(bad), 0.0), None);
        assert_eq!(patch.raycast(DVec3::splat(bad), DVec3::X, &RayLimits::default()), None);
        assert_eq!(patch.raycast(middle() * RADIUS_M, DVec3::splat(bad), &RayLimits::default()), None);
    }
    assert_eq!(patch.contact(&good, f64::NAN), None);
    assert_eq!(patch.sweep(&good, DVec3::ZERO, f64::NAN), None);
    // A motion through the planet has an end, however long it is.
    assert_eq!(patch.sweep(&good.moved(middle() * -40.0), middle() * -1e12, 0.01), None);
    assert_eq!(patch.contact(&Capsule::sphere(DVec3::X * RADIUS_M, 1e9), 0.0), None);
    assert_eq!(patch.raycast(middle() * RADIUS_M, DVec3::ZERO, &RayLimits::default()), None);
    let ended = RayLimits::default().from_m(5.0).to_m(1.0);
    assert_eq!(patch.raycast(good.ends_planet_m[0], middle(), &ended), None);
}

#[test]
fn hidden_objects_stay_hidden_when_populations_move_are_renamed_and_come_back() {
    let kinds = [population("Broadleaf tree", 300.0, 1), population("Boulder", 200.0, 2)];
    let before = terrain_with(kinds.to_vec());
    let hidden: HiddenObjects =
        before.instances(middle(), 40.0).unwrap().iter().step_by(3).map(Instance::object).collect();
    assert!(hidden.len() > 50, "{}", hidden.len());
    // Saved, and read by a newer version of the planet.
    let text = ron::to_string(&hidden).unwrap();
    let first = hidden.iter().next().unwrap();
    assert!(text.starts_with(&format!("[(seed:{},id:{}),", first.seed, first.id)), "{text}");
    let read: HiddenObjects = ron::from_str(&text).unwrap();
    assert!(read == hidden && read.iter().is_sorted());
    let [tree, boulder] = kinds;
    let renamed = Population { name: "Rocks".to_owned(), ..boulder };
    let after = terrain_with(vec![population("Conifer", 100.0, 3), renamed, tree]);
    assert_eq!(read.strangers(after.planet()).count(), 0);
    let mut shown = after.instances(middle(), 40.0).unwrap();
    shown.retain(|instance| instance.seed != 3);
    let (all, places) = (shown.len(), shown.iter().filter(|one| read.holds(one.object())).count());
    read.retain_shown(&mut shown);
    assert_eq!((places, all - shown.len()), (read.len(), read.len()));
    assert_eq!(read.iter().next().unwrap().population(after.planet()), Some(2));
    // A planet without boulders: their hidden objects are told, kept, and hide nothing.
    let without = terrain_with(vec![after.planet().life[2].clone()]);
    let strangers: Vec<_> = read.strangers(without.planet()).collect();
    assert!(!strangers.is_empty() && strangers.iter().all(|object| object.seed == 2));
    assert!(strangers.iter().all(|object| object.population(without.planet()).is_none() && read.holds(*object)));
}
