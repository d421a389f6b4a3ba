use super::*;
use crate::lod::opening::OPENING_ALTITUDE_RADII;

const RADIUS_M: f64 = 6_371_000.0;

/// Mountains of 3 km, and basins below a sea.
struct Hills;

impl Hills {
    fn ray_step_m(above_m: f64) -> f64 {
        (above_m * 0.5).max(1.0)
    }
}

impl Ground for Hills {
    fn radius_m(&self) -> f64 {
        RADIUS_M
    }
    fn floor_radius_m(&self, dir: DVec3) -> f64 {
        let wave = |length_m: f64, height_m: f64| {
            let k = RADIUS_M / length_m;
            height_m * libm::sin(dir.x * k) * libm::cos(dir.y * k) * libm::sin(dir.z * k + 1.0)
        };
        RADIUS_M + wave(20_000.0, 3000.0) + wave(300.0, 80.0) + wave(10.0, 1.0)
    }
    fn surface_radius_m(&self, dir: DVec3) -> f64 {
        self.floor_radius_m(dir).max(RADIUS_M)
    }
    fn raycast(&self, origin: DVec3, dir: DVec3) -> Option<f64> {
        let mut t = 0.0;
        for _ in 0..2000 {
            let p = origin + dir * t;
            let above_m = p.length() - self.surface_radius_m(p.normalize());
            if above_m <= 0.0 {
                return Some(t);
            }
            if above_m > 2.0 * MAX_RADII * RADIUS_M {
                return None;
            }
            t += Self::ray_step_m(above_m);
        }
        None
    }
}

/// A linear congruential generator (constants of Numerical Recipes): equal inputs in every run.
struct Dice(u64);

impl Dice {
    fn unit(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
    fn signed(&mut self) -> f64 {
        self.unit() * 2.0 - 1.0
    }
    fn below(&mut self, n: usize) -> usize {
        (self.unit() * n as f64) as usize
    }
    fn controls(&mut self) -> Controls {
        let mut axis = || [0.0, 1.0, -1.0][self.below(3)];
        let (right, up, ahead, roll) = (axis(), axis(), axis(), axis());
        Controls { right, up, ahead, roll, fast: self.below(2) == 0, jump: self.below(4) == 0 }
    }
}

fn above_floor_m(pose: &Pose) -> f64 {
    pose.position_planet_m.length() - Hills.floor_radius_m(pose.up())
}

fn assert_sound(pose: &Pose, after: &str) {
    assert!(pose.position_planet_m.is_finite() && pose.planet_from_view.is_finite(), "{after}: {pose:?}");
    assert!(pose.planet_from_view.is_normalized(), "{after}");
    assert!(above_floor_m(pose) >= CLEARANCE_M - 1e-6, "{after}: {} m above the ground", above_floor_m(pose));
    assert!(pose.position_planet_m.length() <= MAX_RADII * RADIUS_M * 1.001, "{after}");
}

#[test]
fn whatever_one_does_the_eye_is_never_below_the_ground() {
    let mut dice = Dice(7);
    let mut cameras = Cameras::new(RADIUS_M, LatLon::from_degrees(10.0, 20.0));
    for input in 0..1000 {
        let (x, y) = (dice.signed(), dice.signed());
        let what = match dice.below(12) {
            0 => {
                cameras.set_mode(Mode::ALL[dice.below(3)], &Hills);
                "a change of mode"
            }
            1 => {
                cameras.fly_to(x, y, 1.5, &Hills);
                "a double click"
            }
            2 => {
                cameras.grab(x, y, 1.5, &Hills);
                for _ in 0..3 {
                    cameras.drag((dice.signed(), dice.signed()), (dice.signed(), dice.signed()), 1.5, &Hills);
                }
                cameras.release();
                "a drag"
            }
            3 => {
                cameras.zoom(dice.unit() * 8.0 - 1.0, Some((x, y)), 1.5, &Hills);
                "the wheel"
            }
            4 => {
                cameras.look(x, y, &Hills);
                "a look"
            }
            5 => {
                cameras.set_dive(dice.below(2) == 0);
                cameras.keep_above(&Hills);
                "a dive"
            }
            6 => {
                let up = DVec3::new(dice.signed(), dice.signed(), dice.signed()).normalize_or(DVec3::X);
                let attitude =
                    Attitude { ahead: up.any_orthonormal_vector(), pitch_rad: dice.signed(), roll_rad: dice.signed() };
                let radius_m = Hills.surface_radius_m(up) + libm::exp(dice.unit() * 16.0);
                cameras.fly_to_pose(Pose::new(up * radius_m, &attitude), &Hills);
                "a bookmark"
            }
            _ => "keys",
        };
        assert_sound(&cameras.pose(&Hills), what);
        let controls = if what == "keys" { dice.controls() } else { Controls::default() };
        for _ in 0..dice.below(30) {
            cameras.keep_above(&Hills);
            cameras.advance(dice.unit() * 0.1, &controls, &Hills);
            assert_sound(&cameras.pose(&Hills), &format!("input {input}: {what}, in {:?}", cameras.mode()));
        }
    }
}

/// The jump between two poses: the move in shares of the height above the ground, and the rotation.
fn jump(before: &Pose, after: &Pose) -> (f64, f64) {
    let moved_m = before.position_planet_m.distance(after.position_planet_m);
    let turned_rad = before.planet_from_view.angle_between(after.planet_from_view);
    (moved_m / above_floor_m(before).min(above_floor_m(after)), turned_rad)
}

#[test]
fn one_camera_hands_over_to_the_next_without_a_jump() {
    let mut dice = Dice(3);
    for place in [(0.0, 0.0), (47.0, 11.0), (-89.9, 3.0), (90.0, 0.0)] {
        let mut cameras = Cameras::new(RADIUS_M, LatLon::from_degrees(place.0, place.1));
        cameras.keep_above(&Hills);
        for round in 0..60 {
            if cameras.mode() == Mode::Orbit {
                cameras.zoom(dice.unit() * 6.0 - 2.0, None, 1.5, &Hills);
            }
            cameras.look(0.3 * dice.signed(), 0.3 * dice.signed(), &Hills);
            let controls = dice.controls();
            for _ in 0..dice.below(40) {
                cameras.advance(1.0 / 60.0, &controls, &Hills);
            }
            let before = cameras.pose(&Hills);
            let mode = Mode::ALL[dice.below(3)];
            let from = cameras.mode();
            cameras.set_mode(mode, &Hills);
            assert_eq!(cameras.mode(), mode);
            let mut last = cameras.pose(&Hills);
            let (moved, turned) = jump(&before, &last);
            assert!(moved < 1e-4 && turned < 1e-5, "{from:?} to {mode:?} in round {round}: {moved} {turned}");
            // At rest after some seconds, without a jump meanwhile.
            let mut frames = 0;
            while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) && frames < 1200 {
                let now = cameras.pose(&Hills);
                let (moved, turned) = jump(&last, &now);
                assert!(moved < 1.0 && turned < 0.3, "{from:?} to {mode:?}, frame {frames}: {moved} {turned}");
                last = now;
                frames += 1;
            }
            assert!(frames < 1200, "{mode:?} never comes to rest");
        }
    }
}

#[test]
fn one_lands_on_the_ground_and_walks_on_it() {
    let mut cameras = Cameras::new(RADIUS_M, LatLon::from_degrees(20.0, 30.0));
    cameras.set_mode(Mode::Walk, &Hills);
    let mut frames = 0;
    while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) {
        frames += 1;
    }
    assert!((30..400).contains(&frames), "landed after {frames} frames");
    let eye_m = |cameras: &Cameras| {
        let pose = cameras.pose(&Hills);
        pose.position_planet_m.length() - Hills.surface_radius_m(pose.up())
    };
    assert!((eye_m(&cameras) - walk::EYE_M).abs() < 1e-3, "{}", eye_m(&cameras));
    let start = cameras.pose(&Hills).position_planet_m;
    for _ in 0..600 {
        cameras.advance(1.0 / 60.0, &Controls { ahead: 1.0, fast: true, ..Controls::default() }, &Hills);
        assert!((eye_m(&cameras) - walk::EYE_M).abs() < 0.1, "{}", eye_m(&cameras));
    }
    assert!(start.distance(cameras.pose(&Hills).position_planet_m) > 10.0);
    // And back up, over the same place.
    let up = cameras.pose(&Hills).up();
    cameras.set_mode(Mode::Orbit, &Hills);
    while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) {}
    assert!(cameras.mode() == Mode::Orbit && eye_m(&cameras) > RADIUS_M, "{}", eye_m(&cameras));
    assert!(cameras.pose(&Hills).up().angle_between(up) < 1e-6);
}

#[test]
fn one_walks_on_the_sea_floor_or_on_the_sea() {
    // A location under the sea.
    let place = (0..).map(|i| LatLon::from_degrees(0.0, f64::from(i) * 0.01));
    let mut deep = place.filter(|place| Hills.floor_radius_m(place.direction()) < RADIUS_M - 500.0);
    let mut cameras = Cameras::new(RADIUS_M, deep.next().unwrap());
    cameras.set_mode(Mode::Walk, &Hills);
    while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) {}
    let eye = cameras.pose(&Hills);
    assert!((eye.position_planet_m.length() - RADIUS_M - walk::EYE_M).abs() < 1e-3);
    cameras.set_dive(true);
    cameras.keep_above(&Hills);
    while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) {}
    assert!((above_floor_m(&cameras.pose(&Hills)) - walk::EYE_M).abs() < 1e-3, "sunk to the floor");
    cameras.set_dive(false);
    cameras.keep_above(&Hills);
    cameras.advance(1.0 / 60.0, &Controls::default(), &Hills);
    assert!(cameras.pose(&Hills).position_planet_m.length() > RADIUS_M, "back on the sea");
}

#[test]
fn a_double_click_flies_there_in_every_mode_and_any_key_ends_it() {
    for mode in Mode::ALL {
        let mut cameras = Cameras::new(RADIUS_M, LatLon::from_degrees(20.0, 30.0));
        cameras.set_mode(mode, &Hills);
        while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) {}
        if mode == Mode::Walk {
            cameras.look(0.0, -0.3, &Hills);
        }
        let before = cameras.pose(&Hills);
        let ray = before.camera(Camera::DEFAULT_FOV_Y_RAD).ray_dir_planet(0.2, -0.2, 1.5);
        let distance_m = Hills.raycast(before.position_planet_m, ray).unwrap();
        let goal = before.position_planet_m + ray * distance_m;
        cameras.fly_to(0.2, -0.2, 1.5, &Hills);
        assert!(cameras.is_flying_to());
        let mut stopped = cameras.clone();
        for _ in 0..10 {
            stopped.advance(1.0 / 60.0, &Controls::default(), &Hills);
        }
        stopped.advance(1.0 / 60.0, &Controls { ahead: 1.0, ..Controls::default() }, &Hills);
        assert!(!stopped.is_flying_to());
        while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) {}
        assert_eq!(cameras.mode(), mode);
        let now_m = cameras.pose(&Hills).position_planet_m.distance(goal);
        assert!(now_m < 0.5 * distance_m + 4.0, "{mode:?}: {now_m} m away, {distance_m} m before");
    }
}

#[test]
fn a_flight_to_a_pose_ends_in_that_pose() {
    let mut cameras = Cameras::new(RADIUS_M, LatLon::from_degrees(20.0, 30.0));
    let up = LatLon::from_degrees(-40.0, -120.0).direction();
    for roll_rad in [0.0, 0.5] {
        let attitude = Attitude { ahead: up.any_orthonormal_vector(), pitch_rad: -0.3, roll_rad };
        let to = Pose::new(up * (Hills.surface_radius_m(up) + 900.0), &attitude);
        cameras.fly_to_pose(to, &Hills);
        let mut frames = 0;
        while cameras.advance(1.0 / 60.0, &Controls::default(), &Hills) {
            frames += 1;
        }
        let now = cameras.pose(&Hills);
        assert!(now.position_planet_m.distance(to.position_planet_m) < 1e-3);
        assert!(now.planet_from_view.angle_between(to.planet_from_view) < 1e-5);
        assert!((30..300).contains(&frames), "{frames}");
        assert_eq!(cameras.mode(), if roll_rad == 0.0 { Mode::Orbit } else { Mode::Fly });
        cameras = Cameras::new(RADIUS_M, LatLon::from_degrees(20.0, 30.0));
    }
}

#[test]
fn free_flight_is_faster_high_up_and_stops_above_the_ground() {
    let mut cameras = Cameras::new(RADIUS_M, LatLon::from_degrees(20.0, 30.0));
    cameras.set_mode(Mode::Fly, &Hills);
    let height_m = |cameras: &Cameras| {
        let pose = cameras.pose(&Hills);
        pose.position_planet_m.length() - Hills.surface_radius_m(pose.up())
    };
    let start_m = height_m(&cameras);
    assert!(start_m > 0.9 * OPENING_ALTITUDE_RADII * RADIUS_M);
    let ahead = Controls { ahead: 1.0, ..Controls::default() };
    for _ in 0..60 {
        cameras.advance(1.0 / 60.0, &ahead, &Hills);
    }
    assert!(height_m(&cameras) < 0.65 * start_m, "within a second most of the way is gone");
    for _ in 0..3000 {
        cameras.advance(1.0 / 60.0, &ahead, &Hills);
    }
    assert!((fly::CLEARANCE_M - 0.1..2.0).contains(&height_m(&cameras)), "{}", height_m(&cameras));
}
