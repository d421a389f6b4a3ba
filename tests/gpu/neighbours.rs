//! Light between bodies, against geometry: shadows of rings and of moons, rings themselves, reflected light.

use crate::support::{earth, frame_of, gpu, rays, surface_of};
use glam::{DQuat, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Layer, Planet, Rings};
use tellus::render::{Body, BodyId, Metering, Scene, Sun};
use tellus::rings::Profile;
use tellus::sphere::LatLon;
use tellus::system::light::visible_share;
use tellus::tiles::{Surface, build_now};

const SIZE_PX: [u32; 2] = [192, 108];

/// A smooth ball without air.
fn ball(radius_km: f64) -> Planet {
    Planet { radius_km, ..Planet::default() }
}

fn ringed() -> Planet {
    Planet { rings: Some(Rings { gaps: 2, ..Rings::default() }), ..ball(6000.0) }
}

fn scene<'a>(surface: &'a Surface, planet: &Arc<Planet>, camera: Camera, sun_dir: DVec3) -> Scene<'a> {
    frame_of(surface, planet, View { camera, size_px: SIZE_PX, quality: Quality::Medium }, sun_dir)
}

/// Where a ray meets a ball around the origin.
fn hit(eye: DVec3, dir: DVec3, radius_m: f64) -> Option<DVec3> {
    let b = eye.dot(dir);
    let root = b * b - eye.length_squared() + radius_m * radius_m;
    (root > 0.0).then(|| eye + dir * (-b - root.sqrt()))
}

#[test]
fn rings_shade_their_planet_by_their_optical_depth() {
    let mut gpu = gpu();
    let (planet, bare) = (Arc::new(ringed()), Arc::new(ball(6000.0)));
    // In the plane of the rings they are not seen themselves.
    let camera = Camera::over(LatLon::from_degrees(0.0, 0.0), planet.radius_m() * 3.0, 0.0, -FRAC_PI_2, 0.6);
    let sun_dir = DVec3::new(0.8, 0.2, 0.45).normalize();
    let surface = surface_of(&bare, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
    let with = gpu.radiance(&scene(&surface, &planet, camera, sun_dir));
    let without_scene = scene(&surface, &bare, camera, sun_dir);
    let without = gpu.radiance(&without_scene);
    let profile = Profile::new(&planet).unwrap();
    let pixel_rad = 2.0 * (0.5 * camera.fov_y_rad).tan() / f64::from(SIZE_PX[1]);
    let (mut count, mut shaded, mut sum) = (0, 0, 0.0);
    for ((dir, with), without) in rays(&without_scene).iter().zip(&with).zip(&without) {
        let Some(at) = hit(camera.position_planet_m, *dir, planet.radius_m()) else { continue };
        // Where the sun is low, the light of the night sky counts.
        if at.normalize().dot(sun_dir) < 0.2 || at.normalize().dot(camera.position_planet_m.normalize()) < 0.3 {
            continue;
        }
        let path_m = -at.z / sun_dir.z;
        let expected = if path_m > 0.0 {
            let crossing_m = (at + sun_dir * path_m).truncate();
            let radius_m = crossing_m.length();
            let blur_m = 2.0 * path_m * planet.star.radius_deg.to_radians();
            // A pixel is wider than a ringlet.
            let from_eye_m = at - camera.position_planet_m;
            let slant = from_eye_m.normalize().dot(at.normalize()).abs().max(0.2);
            let pixel_m = from_eye_m.length() * pixel_rad / slant;
            let moved = (crossing_m.dot(sun_dir.truncate()) / (radius_m * sun_dir.z)).hypot(1.0);
            profile.transmittance(radius_m, blur_m.max(pixel_m * moved), sun_dir.z)
        } else {
            1.0
        };
        let share = f64::from(with[1] / without[1]);
        (count, sum) = (count + 1, sum + (share - expected).abs());
        shaded += usize::from(expected < 0.7);
        assert!((share - expected).abs() < 0.12, "{share} of {expected} at {at}");
    }
    let mean = sum / f64::from(count);
    assert!(count > 3000 && shaded > 300 && mean < 0.012, "{count} pixels, {shaded} in shadow, mean error {mean}");
}

#[test]
fn rings_scatter_and_dim_as_the_reference_and_have_the_shadow_of_the_planet() {
    let mut gpu = gpu();
    let planet = Arc::new(Planet {
        // Without structure, so that a pixel has one value.
        rings: Some(Rings {
            ringlets: 0.0,
            gaps: 0,
            dust: 0.2,
            profile: vec![[0.0, 1.0], [1.0, 1.0]],
            ..Rings::default()
        }),
        ..ball(6000.0)
    });
    let profile = Profile::new(&planet).unwrap();
    for (lat, sun_dir) in
        [(35.0, DVec3::new(0.7, -0.5, 0.4)), (-30.0, DVec3::new(0.7, -0.5, 0.4)), (20.0, DVec3::new(-0.9, 0.1, 0.3))]
    {
        let sun_dir = sun_dir.normalize();
        let camera = Camera::over(LatLon::from_degrees(lat, 0.0), planet.radius_m() * 6.0, 0.0, -FRAC_PI_2, 0.9);
        let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
        let scene = scene(&surface, &planet, camera, sun_dir);
        let drawn = gpu.radiance(&scene);
        let (mut count, mut dark) = (0, 0);
        for (dir, drawn) in rays(&scene).iter().zip(&drawn) {
            let eye = camera.position_planet_m;
            let at = eye - *dir * (eye.z / dir.z);
            let radii = at.length() / planet.radius_m();
            // Away from edges and from the planet's disc.
            if hit(eye, *dir, planet.radius_m() * 1.02).is_some() || !(1.4..2.1).contains(&radii) {
                continue;
            }
            let along = at.dot(sun_dir);
            let aside = (at - sun_dir * along).length() / planet.radius_m();
            let in_shadow = along < 0.0 && aside < 0.97;
            if along < 0.0 && (0.97..1.03).contains(&aside) {
                continue;
            }
            let light = profile.radiance(
                profile.at(at.length(), 1.0),
                dir.z.abs(),
                sun_dir.z,
                eye.z * sun_dir.z > 0.0,
                dir.dot(sun_dir),
            );
            for channel in 0..3 {
                let expected = if in_shadow { 0.0 } else { light[channel] * PI * planet.star.color[channel] };
                let found = f64::from(drawn[channel]);
                assert!((found - expected).abs() < 0.03 * expected + 1e-4, "{found} instead of {expected} at {radii}");
            }
            count += 1;
            dark += usize::from(in_shadow);
        }
        assert!(count > 300 && dark > 5, "{count} pixels of rings, {dark} in shadow");
    }
}

#[test]
fn a_moons_umbra_and_penumbra_have_the_size_of_geometry() {
    let mut gpu = gpu();
    let (planet, moon) = (Arc::new(ball(6371.0)), Arc::new(ball(1737.0)));
    // The sun is over 0 degrees, the moon in front of it, near enough for an umbra 190 km in radius.
    let moon_m = DVec3::new(3.4e8, 2.0e5, -1.5e5);
    let camera = Camera::over(LatLon::from_degrees(0.0, 0.0), planet.radius_m() + 4e6, 0.0, -FRAC_PI_2, 0.22);
    let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
    let plain = scene(&surface, &planet, camera, DVec3::X);
    let without = gpu.radiance(&plain);
    let mut eclipsed = plain.clone();
    let moon_surface = build_now(&moon, &plain.view_of(moon_m - camera.position_planet_m, DQuat::IDENTITY)).unwrap();
    eclipsed.bodies.push(Body::new(BodyId(7), &moon_surface, moon_m - camera.position_planet_m));
    let with = gpu.radiance(&eclipsed);
    let sun_rad = planet.star.radius_deg.to_radians();
    let share_at = |at: DVec3| {
        let away = moon_m - at;
        let apart = libm::atan2(away.cross(DVec3::X).length(), away.x);
        visible_share(sun_rad, (1.737e6 / away.length()).asin(), apart)
    };
    let (mut umbra, mut found_umbra, mut sum, mut count) = (0.0, 0.0, 0.0, 0);
    for ((dir, with), without) in rays(&plain).iter().zip(&with).zip(&without) {
        let at = hit(camera.position_planet_m, *dir, planet.radius_m()).expect("the ground");
        let (share, expected) = (f64::from(with[1] / without[1]), share_at(at));
        sum += (share - expected).abs();
        count += 1;
        // The area where a twentieth of the light is left.
        umbra += f64::from(u8::from(expected < 0.05));
        found_umbra += f64::from(u8::from(share < 0.05));
        assert!((share - expected).abs() < 0.02, "{share} of {expected} at {at}");
    }
    let mean = sum / f64::from(count);
    // An area within 2 % is a width within 1 %.
    let ratio: f64 = found_umbra / umbra;
    println!("umbra of {umbra} pixels, ratio {ratio}, mean error {mean}");
    assert!(umbra > 500.0 && (ratio.sqrt() - 1.0).abs() < 0.01 && mean < 0.003, "{umbra} {ratio} {mean}");
}

/// In totality the moon is a dark disc in a corona, and no light of the star's soft edge passes by it.
#[test]
fn totality_is_a_dark_disc_in_a_corona() {
    let mut gpu = gpu();
    gpu.post.metering = Metering::Instant;
    let (planet, moon) = (Arc::new(ball(6371.0)), Arc::new(ball(1737.0)));
    let camera = Camera::over(LatLon::from_degrees(0.0, 0.0), planet.radius_m() + 10.0, 0.0, FRAC_PI_2, 0.06);
    let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
    let mut eclipsed = scene(&surface, &planet, camera, DVec3::X);
    let moon_m = DVec3::X * 3.4e8;
    let moon_surface = build_now(&moon, &eclipsed.view_of(moon_m - camera.position_planet_m, DQuat::IDENTITY)).unwrap();
    eclipsed.bodies.push(Body::new(BodyId(7), &moon_surface, moon_m - camera.position_planet_m));
    let brightest = gpu.radiance(&eclipsed).iter().map(|light| light[1]).fold(0.0, f32::max);
    assert!(brightest < 1e-3, "{brightest}");
    let drawn = gpu.draw(&eclipsed);
    // The mean of four pixels at a distance from the middle.
    let at = |away_px: i32| {
        let [x, y] = SIZE_PX.map(|side| side as i32 / 2);
        let around = [(away_px, 0), (-away_px, 0), (0, away_px), (0, -away_px)];
        let green = |(dx, dy): (i32, i32)| u32::from(drawn[((y + dy) * 2 * x + x + dx) as usize * 4 + 1]);
        around.into_iter().map(green).sum::<u32>() / 4
    };
    // The moon's radius is 9.4 pixels, the star's 8.4.
    let shown = [0, 6, 11, 18, 30, 50].map(at);
    println!("{shown:?}");
    assert!(shown[0].max(shown[1]) < 50 && shown[2] > 150, "{shown:?}");
    assert!(shown[2..].windows(2).all(|pair| pair[0] > pair[1]), "{shown:?}");
}

/// The sky of totality is a twilight, lit by the air beyond the shadow: a ten-thousandth to a thousandth of the sky by
/// day, and blue.
#[test]
fn the_sky_of_totality_is_a_twilight() {
    let mut gpu = gpu();
    let (planet, moon) = (Arc::new(Planet { clouds: None, ..earth() }), Arc::new(ball(1737.0)));
    // Beside the star, so that the moon is not in the picture.
    let camera = Camera::over(LatLon::from_degrees(0.0, 0.0), planet.radius_m() + 5000.0, 0.0, 0.9, 0.3);
    let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
    let plain = scene(&surface, &planet, camera, DVec3::X);
    let mut eclipsed = plain.clone();
    let moon_m = DVec3::X * 3.4e8;
    let moon_surface = build_now(&moon, &eclipsed.view_of(moon_m - camera.position_planet_m, DQuat::IDENTITY)).unwrap();
    eclipsed.bodies.push(Body::new(BodyId(7), &moon_surface, moon_m - camera.position_planet_m));
    let night = scene(&surface, &planet, camera, DVec3::NEG_X);
    let [day, totality, night] = [&plain, &eclipsed, &night].map(|scene| {
        let radiance = gpu.radiance(scene);
        let mean = |k: usize| radiance.iter().map(|light| f64::from(light[k])).sum::<f64>() / radiance.len() as f64;
        [mean(0), mean(1), mean(2)]
    });
    let [red, green, blue] = [0, 1, 2].map(|k| (totality[k] - night[k]) / day[k]);
    println!("{red} {green} {blue} of the sky by day");
    assert!(
        (1e-4..1e-3).contains(&green) && red < 3.0 * blue,
        "{red} {green} {blue}: {day:?}, {totality:?}, {night:?}"
    );
}

/// The horizon of low ground lies below that of the sphere: a star between the two is seen.
#[test]
fn a_star_is_seen_over_ground_below_the_sphere() {
    let mut gpu = gpu();
    let layer = Layer { amplitude_m: 10_000.0, bias: -2.0, ..Layer::default() };
    let planet = Arc::new(Planet { layers: vec![layer], ..ball(1000.0) });
    // 5.7 degrees below the horizontal the sphere ends, more than 9 the ground.
    let camera = Camera::over(LatLon::from_degrees(0.0, 0.0), planet.radius_m() + 5e3, 0.0, -0.14, 0.2);
    let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
    let sun_dir = DVec3::new(-libm::sin(0.14), 0.0, libm::cos(0.14));
    let brightest =
        gpu.radiance(&scene(&surface, &planet, camera, sun_dir)).iter().map(|light| light[1]).fold(0.0, f32::max);
    assert!(brightest > 100.0, "{brightest}");
}

/// A star at a distance lights each body from its own side, and more brightly what is nearer.
#[test]
fn a_near_star_lights_each_body_from_where_it_is() {
    let sun = Sun::new(&Planet::default().star, DVec3::X);
    let mut gpu = gpu();
    let planet = Arc::new(ball(1000.0));
    let camera = Camera::over(LatLon::from_degrees(0.0, 0.0), 4e6, 0.0, -FRAC_PI_2, 0.7);
    let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
    let mut far = scene(&surface, &planet, camera, DVec3::X);
    let at_infinity = gpu.radiance(&far);
    // As far behind the camera as the body is before it: a quarter of the light reaches the body.
    far.suns = vec![sun];
    far.suns[0].distance_m = 4e6;
    let near = gpu.radiance(&far);
    let middle = (SIZE_PX[1] / 2 * SIZE_PX[0] + SIZE_PX[0] / 2) as usize;
    let ratio = near[middle][1] / at_infinity[middle][1];
    assert!((ratio - 0.25).abs() < 0.01, "{ratio}");
}
