//! The bodies of a system around a camera: where they stand in its scene, how they are lit, and which are points.
//!
//! Scene space has the axes of the camera's own body, and its origin at the camera, as the scene of a lone planet.

use super::scene::{Body, BodyId, Point, Projection, Scene, Sun};
use super::shared::MAX_SUNS;
use crate::giant::Bands;
use crate::planet::Planet;
use crate::sphere::LatLon;
use crate::system::light::{StarInSky, angle_at, may_shade, reflected};
use crate::system::{Ephemeris, Light, Pose, System};
use crate::tiles::Surface;
use glam::{DQuat, DVec3};
use std::sync::Arc;

/// Angular radius in pixels from which a body has a surface.
const SURFACE_PX: f64 = 1.0;
/// Least share of a star's disc that is worth a shadow.
const LEAST_COVERED: f64 = 1e-3;
/// Least share of a body's starlight that is worth a light of its own when a neighbour reflects it.
const LEAST_REFLECTED: f64 = 1e-7;
/// Magnitude of the Sun at one astronomical unit.
const SUN_MAGNITUDE: f64 = -26.74;
/// Magnitude beyond which a body is not drawn.
const FAINTEST: f64 = 9.0;

/// A system whose presets are loaded.
///
/// ```
/// use tellus::glam::DVec3;
/// use tellus::render::Worlds;
/// use tellus::system::System;
///
/// let file = std::path::Path::new("systems/hearth.ron");
/// let system = System::load(file)?;
/// let planets = system.load_planets(file)?;
/// let worlds = Worlds::new(system, planets);
/// let [moon, aurel] = ["Pallor", "Aurel"].map(|name| worlds.system().find(name).unwrap_or(0));
/// let around = worlds.around(moon, DVec3::X * 1.75e6, 0.0);
/// println!("Aurel is {:.0} km away", around.place(aurel).0.length() / 1000.0);
/// # assert!((3.5e8..4.1e8).contains(&around.place(aurel).0.length()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Worlds {
    system: System,
    ephemeris: Ephemeris,
    planets: Vec<Option<Arc<Planet>>>,
}

impl Worlds {
    /// A valid system and the planet of each of its bodies, as [`System::load_planets`] gives them.
    pub fn new(system: System, planets: Vec<Option<Arc<Planet>>>) -> Self {
        Self { ephemeris: Ephemeris::new(&system), system, planets }
    }

    /// The system.
    pub fn system(&self) -> &System {
        &self.system
    }

    /// Its motion.
    pub fn ephemeris(&self) -> &Ephemeris {
        &self.ephemeris
    }

    /// The planet of a body as its preset has it; None for stars and points.
    pub fn planet(&self, body: usize) -> Option<&Arc<Planet>> {
        self.planets.get(body)?.as_ref()
    }

    /// Radius of each body, metres; 0 for points.
    pub fn radii_m(&self) -> Vec<f64> {
        (0..self.system.bodies.len()).map(|body| self.radius_m(body)).collect()
    }

    fn radius_m(&self, body: usize) -> f64 {
        match (&self.planets[body], &self.system.bodies[body].light) {
            (Some(planet), _) => planet.radius_m(),
            (None, Some(light)) => light.radius_m(),
            (None, None) => 0.0,
        }
    }

    /// The planet of a body with the star of its preset replaced by that of the system, as it stands at a time. Colour,
    /// brightness and the sun's size in the sky follow; the ground does not change.
    pub fn lit_planet(&self, body: usize, time_secs: f64) -> Option<Planet> {
        let mut planet = (**self.planet(body)?).clone();
        let poses = self.ephemeris.at(time_secs);
        let (brightness, star, light) = self.stars(&poses, poses[body].position_m).into_iter().next()?;
        let distance_m = poses[star].position_m.distance(poses[body].position_m);
        let (lat_deg, lon_deg) = LatLon::from_direction(self.star_dir(body, time_secs)?).to_degrees();
        let of = &mut planet.star;
        // The ranges of a preset hold.
        (of.latitude_deg, of.longitude_deg, of.day_hours) = (lat_deg, lon_deg, 0.0);
        of.brightness = brightness.clamp(0.0, 100.0);
        of.color = light.color();
        of.radius_deg = (light.radius_m() / distance_m).min(1.0).asin().to_degrees().clamp(0.01, 20.0);
        Some(planet)
    }

    /// The direction of the brightest star over a body, in its planet frame, at a time; None without stars.
    pub fn star_dir(&self, body: usize, time_secs: f64) -> Option<DVec3> {
        let poses = self.ephemeris.at(time_secs);
        let own = poses.get(body)?;
        let (_, star, _) = *self.stars(&poses, own.position_m).first()?;
        Some(own.system_from_body.inverse() * (poses[star].position_m - own.position_m).normalize_or(DVec3::X))
    }

    /// The stars by their brightness at a place, brightest first.
    fn stars(&self, poses: &[Pose], at_m: DVec3) -> Vec<(f64, usize, &Light)> {
        let bodies = self.system.bodies.iter().enumerate();
        let shining = bodies.filter_map(|(number, body)| Some((number, body.light.as_ref()?)));
        let brightness = |number: usize, light: &Light| light.brightness_at((poses[number].position_m - at_m).length());
        let mut stars: Vec<_> = shining.map(|(number, light)| (brightness(number, light), number, light)).collect();
        stars.sort_by(|a, b| b.0.total_cmp(&a.0));
        stars
    }

    /// The id of a body in scenes. It stays when the camera goes from one body to another, so that tiles and LUTs do.
    pub fn id(body: usize) -> BodyId {
        BodyId(1 + body as u32)
    }

    /// The bodies around a camera at a time. `eye_planet_m`: the camera in the frame of its own body.
    pub fn around(&self, body: usize, eye_planet_m: DVec3, time_secs: f64) -> Around<'_> {
        let poses = self.ephemeris.at(time_secs);
        let own = poses[body];
        let eye_m = own.position_m + own.system_from_body * eye_planet_m;
        Around { worlds: self, body, scene_from_system: own.system_from_body.inverse(), eye_m, eye_planet_m, poses }
    }
}

/// The bodies of a system around a camera.
#[derive(Clone, Debug)]
pub struct Around<'a> {
    worlds: &'a Worlds,
    body: usize,
    scene_from_system: DQuat,
    /// The camera in the frame of the system.
    eye_m: DVec3,
    eye_planet_m: DVec3,
    poses: Vec<Pose>,
}

/// Another body of a system in a scene.
#[derive(Clone)]
pub struct Neighbour {
    /// Its number in the system.
    pub number: usize,
    /// Its id in the scene.
    pub id: BodyId,
    /// Its tiles.
    pub surface: Arc<Surface>,
    /// Its centre, metres from the camera, scene space.
    pub position_m: DVec3,
    /// Turns its frame into scene space.
    pub scene_from_body: DQuat,
}

impl Neighbour {
    /// The body, for a scene.
    pub fn body(&self) -> Body<'_> {
        let mut body = Body::new(self.id, &self.surface, self.position_m);
        body.scene_from_body = self.scene_from_body;
        body
    }
}

impl Around<'_> {
    /// A body with its tiles.
    pub fn neighbour(&self, body: usize, surface: Arc<Surface>) -> Neighbour {
        let (position_m, scene_from_body) = self.place(body);
        Neighbour { number: body, id: Worlds::id(body), surface, position_m, scene_from_body }
    }

    /// Centre of a body in scene space, metres from the camera, and the rotation from its frame to scene space.
    pub fn place(&self, body: usize) -> (DVec3, DQuat) {
        if body == self.body {
            // Exact, however far the system reaches.
            return (-self.eye_planet_m, DQuat::IDENTITY);
        }
        let own = self.poses[self.body];
        let pose = self.poses[body];
        let from_own_m = self.scene_from_system * (pose.position_m - own.position_m);
        (from_own_m - self.eye_planet_m, self.scene_from_system * pose.system_from_body)
    }

    /// The bodies that have a surface in a picture, nearest first: the camera's own, those as wide as two pixels, and
    /// those that cover a star of one of these, however small they are.
    pub fn with_surface(&self, projection: &Projection, size_px: [u32; 2]) -> Vec<usize> {
        let pixel_rad = 2.0 * projection.half_extent()[1] / f64::from(size_px[1].max(1));
        let is_wide = |body: usize| {
            body == self.body || self.worlds.radius_m(body) / self.place(body).0.length() > SURFACE_PX * pixel_rad
        };
        let all = (0..self.poses.len()).filter(|body| self.worlds.planets[*body].is_some());
        let (mut bodies, small): (Vec<usize>, Vec<usize>) = all.partition(|body| is_wide(*body));
        let shading: Vec<usize> =
            small.into_iter().filter(|small| bodies.iter().any(|body| self.shades(*small, *body))).collect();
        bodies.extend(shading);
        bodies.sort_by(|a, b| self.place(*a).0.length().total_cmp(&self.place(*b).0.length()));
        bodies
    }

    /// Whether a body takes light worth seeing from a place on another.
    fn shades(&self, body: usize, on: usize) -> bool {
        let own_m = self.poses[on].position_m;
        let (away_m, radius_m) = (self.poses[body].position_m - own_m, self.worlds.radius_m(body));
        self.worlds.stars(&self.poses, own_m).iter().any(|(_, star, light)| {
            let to_star_m = self.poses[*star].position_m - own_m;
            let distance_m = to_star_m.length();
            let radius_rad = (light.radius_m() / distance_m).min(1.0).asin();
            let star = StarInSky { dir: to_star_m / distance_m, distance_m, radius_rad };
            let of_disc = (radius_m / away_m.length() / radius_rad).powi(2);
            of_disc > LEAST_COVERED && may_shade(&star, away_m, radius_m, self.worlds.radius_m(on))
        })
    }

    /// Sets the id of the camera's own body, the lights and the points of a scene: stars, scaled so that the brightest
    /// one has brightness 1, the light that neighbours reflect, and bodies without a surface. `drawn`: the bodies with
    /// one.
    pub fn light(&self, scene: &mut Scene<'_>, drawn: &[usize]) {
        let stars = self.worlds.stars(&self.poses, self.eye_m);
        // An eye adapts to its star: far from it, a day is a day.
        let adapted = 1.0 / stars.first().map_or(1.0, |star| star.0).max(f64::MIN_POSITIVE);
        if let Some(own) = scene.bodies.first_mut() {
            own.id = Worlds::id(self.body);
        }
        scene.suns.clear();
        for (brightness, star, light) in stars.iter().take(MAX_SUNS - 1) {
            let (position_m, _) = self.place(*star);
            let distance_m = position_m.length();
            scene.suns.push(Sun {
                dir_scene: position_m / distance_m,
                color: light.color(),
                brightness: *brightness * adapted,
                radius_rad: (light.radius_m() / distance_m).min(1.0).asin(),
                distance_m,
                has_disc: true,
                only: None,
            });
        }
        let reflected = drawn.iter().filter_map(|body| self.brightest_neighbour(*body));
        scene.suns.extend(reflected.map(|sun| Sun { brightness: sun.brightness * adapted, ..sun }));
        let others = (0..self.poses.len()).filter(|body| !drawn.contains(body));
        // The brightest stars are suns with discs.
        let suns: Vec<usize> = stars.iter().take(MAX_SUNS - 1).map(|star| star.1).collect();
        let others = others.filter(|body| !suns.contains(body));
        let mut points: Vec<(f64, Point)> = others.filter_map(|body| self.point(body)).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        scene.points = points.into_iter().map(|(_, point)| point).collect();
    }

    /// The brightest light that a neighbour reflects to a body.
    fn brightest_neighbour(&self, body: usize) -> Option<Sun> {
        let own = self.poses[body].position_m;
        let neighbours = (0..self.poses.len()).filter(|other| *other != body && self.worlds.planets[*other].is_some());
        let lights = neighbours.filter_map(|other| {
            let (share, color) = self.reflected(other, own)?;
            let dir_scene = self.scene_from_system * (self.poses[other].position_m - own).normalize();
            let radius_rad =
                (self.worlds.radius_m(other) / (self.poses[other].position_m - own).length()).min(1.0).asin();
            Some((
                share,
                Sun {
                    dir_scene,
                    color,
                    brightness: share,
                    radius_rad,
                    distance_m: f64::INFINITY,
                    has_disc: false,
                    only: Some(Worlds::id(body)),
                },
            ))
        });
        let (share, sun) = lights.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let direct = self.worlds.stars(&self.poses, own).first().map_or(0.0, |star| star.0);
        (share > LEAST_REFLECTED * direct).then_some(sun)
    }

    /// Brightness and colour of the light that a body reflects to a place.
    fn reflected(&self, body: usize, at_m: DVec3) -> Option<(f64, [f64; 3])> {
        let planet = self.worlds.planets[body].as_ref()?;
        let center_m = self.poses[body].position_m;
        let (direct, star, light) = self.worlds.stars(&self.poses, center_m).into_iter().next()?;
        let phase_rad = angle_at(center_m, self.poses[star].position_m, at_m);
        let albedo = mean_albedo(planet);
        let strength = albedo.into_iter().fold(0.0, f64::max);
        let share = reflected(strength, planet.radius_m(), (center_m - at_m).length(), phase_rad);
        let star_color = light.color();
        let color = std::array::from_fn(|i| star_color[i] * albedo[i] / strength.max(1e-9));
        Some((share * direct, color))
    }

    /// A body as a point, with its magnitude.
    fn point(&self, body: usize) -> Option<(f64, Point)> {
        let (brightness, color) = match &self.worlds.system.bodies[body].light {
            Some(light) => (light.brightness_at((self.poses[body].position_m - self.eye_m).length()), light.color()),
            None => self.reflected(body, self.eye_m)?,
        };
        let magnitude = SUN_MAGNITUDE - 2.5 * brightness.max(1e-30).log10();
        (magnitude < FAINTEST).then(|| (magnitude, Point::new(self.place(body).0, color, magnitude)))
    }
}

/// Share of the light that a planet reflects, roughly: the mean of its biome table, its sea and its clouds.
pub fn mean_albedo(planet: &Planet) -> [f64; 3] {
    if let Some(bands) = Bands::new(planet) {
        let count = bands.entries.len() as f64;
        return std::array::from_fn(|i| bands.entries.iter().map(|entry| entry[i]).sum::<f64>() / count);
    }
    let biomes = &planet.biomes;
    let color = |key: char| biomes.palette.iter().find(|biome| biome.key == key).map(|biome| biome.color);
    let cells: Vec<[f64; 3]> = biomes.table.rows().iter().flat_map(|row| row.chars()).filter_map(color).collect();
    let count = cells.len().max(1) as f64;
    let mut albedo: [f64; 3] = std::array::from_fn(|i| cells.iter().map(|cell| cell[i]).sum::<f64>() / count);
    if planet.water.is_some() {
        let sea = [0.05, 0.06, 0.075];
        albedo = std::array::from_fn(|i| 0.4 * albedo[i] + 0.6 * sea[i]);
    }
    if let Some(clouds) = &planet.clouds {
        let covered = 1.0 - (1.0 - clouds.coverage) * (1.0 - 0.7 * clouds.middle) * (1.0 - 0.3 * clouds.veil);
        albedo = std::array::from_fn(|i| albedo[i] * (1.0 - covered) + 0.55 * clouds.color[i] * covered);
    }
    albedo
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::Quality;
    use crate::system::shipped;

    fn worlds(file: &str) -> Worlds {
        let shipped = shipped::ALL.iter().find(|shipped| shipped.file == file).unwrap();
        let system = shipped.load().unwrap();
        let planets = shipped.planets(&system);
        Worlds::new(system, planets)
    }

    fn scene() -> Scene<'static> {
        Scene::new(DQuat::IDENTITY, Projection::symmetric(0.8, 1.5), [1200, 800], Quality::Low)
    }

    #[test]
    fn the_camera_stands_exactly_where_it_stands_on_its_own_body_however_far_out() {
        let mut worlds = worlds("hearth.ron");
        let moon = worlds.system.find("Pallor").unwrap();
        let planet = worlds.system.find("Aurel").unwrap();
        // 40 astronomical units.
        worlds.system.bodies[planet].orbit.as_mut().unwrap().semi_major_km = 5.98e9;
        worlds.ephemeris = Ephemeris::new(&worlds.system);
        let eye_m = DVec3::new(1.740_000_123e6, 0.25, -3.0);
        let step_m = DVec3::new(0.001, 0.0, 0.0);
        let [here, there] = [eye_m, eye_m + step_m].map(|eye_m| worlds.around(moon, eye_m, 1e6));
        assert_eq!(here.place(moon), (-eye_m, DQuat::IDENTITY));
        // A neighbour moves by the step of the camera, not by the grain of the system's frame.
        let moved_m = here.place(planet).0 - there.place(planet).0;
        assert!((moved_m - step_m).length() < 1e-6, "{moved_m}");
        // What the frame of the system gives agrees to its grain.
        let poses = worlds.ephemeris.at(1e6);
        let apart_m = poses[planet].position_m.distance(poses[moon].position_m);
        assert!((here.place(planet).0 + eye_m).length() - apart_m < 0.01);
    }

    #[test]
    fn bodies_have_surfaces_or_are_points_of_the_brightness_of_their_phase() {
        let worlds = worlds("hearth.ron");
        let aurel = worlds.system.find("Aurel").unwrap();
        let around = worlds.around(aurel, DVec3::X * 7e6, 0.0);
        let mut scene = scene();
        let drawn = around.with_surface(&scene.projection, scene.size_px);
        let names: Vec<&str> = drawn.iter().map(|body| worlds.system.bodies[*body].name.as_str()).collect();
        assert_eq!(names, ["Aurel", "Pallor"]);
        around.light(&mut scene, &drawn);
        // The star, and what planet and moon send each other.
        let discs: Vec<bool> = scene.suns.iter().map(|sun| sun.has_disc).collect();
        assert_eq!(discs, [true, false, false]);
        assert!((scene.suns[0].brightness - 1.0).abs() < 1e-12);
        assert!((scene.suns[0].radius_rad.to_degrees() - 0.271).abs() < 0.002);
        let [by_moon, by_planet] = [&scene.suns[1], &scene.suns[2]].map(|sun| sun.brightness);
        assert!((1e-7..1e-5).contains(&by_moon) && (1e-6..3e-4).contains(&by_planet), "{by_moon} {by_planet}");
        // Inner and outer planets and the giant; its moons are too faint.
        assert!((3..=6).contains(&scene.points.len()), "{:?}", scene.points);
        let [brightest, faintest] = [0, scene.points.len() - 1].map(|at| scene.points[at].light[0]);
        assert!(brightest > 2.0 && brightest > 2.0 * faintest, "{brightest} {faintest}");
    }

    /// In a small picture the moon is a point by day. In totality it has a surface, which darkens sun and ground.
    #[test]
    fn an_eclipse_does_not_depend_on_the_size_of_the_picture() {
        let worlds = worlds("hearth.ron");
        let [aurel, pallor] = ["Aurel", "Pallor"].map(|name| worlds.system.find(name).unwrap());
        for (time_secs, eclipsed) in [(176_200_800.0, true), (0.0, false)] {
            let around = worlds.around(aurel, DVec3::X * 6.4e6, time_secs);
            for size_px in [[64, 36], [640, 400]] {
                let drawn = around.with_surface(&Projection::symmetric(1.57, 1.6), size_px);
                assert!(drawn.contains(&aurel) && (!eclipsed || drawn.contains(&pallor)), "{time_secs} {drawn:?}");
            }
            let tiny = around.with_surface(&Projection::symmetric(1.57, 1.6), [64, 36]);
            assert_eq!(tiny.contains(&pallor), eclipsed);
        }
    }

    #[test]
    fn two_suns_stand_where_their_stars_are() {
        let worlds = worlds("twins.ron");
        let planet = worlds.system.find("Sabkha").unwrap();
        let around = worlds.around(planet, DVec3::Z * 6.5e6, 5e5);
        let mut scene = scene();
        let drawn = around.with_surface(&scene.projection, scene.size_px);
        around.light(&mut scene, &drawn);
        let suns: Vec<&Sun> = scene.suns.iter().filter(|sun| sun.has_disc).collect();
        assert_eq!(suns.len(), 2);
        assert!(suns[1].brightness < 0.2 && suns[1].color[2] < suns[0].color[2], "the younger is dim and orange");
        let apart_deg = suns[0].dir_scene.angle_between(suns[1].dir_scene).to_degrees();
        assert!((0.0..7.0).contains(&apart_deg), "{apart_deg}");
        // At the body itself, a sun is where the ephemeris has it.
        let at_body = suns[0].at(around.place(planet).0);
        let poses = worlds.ephemeris.at(5e5);
        let star = worlds.system.find("Elder").unwrap();
        let towards = (poses[star].position_m - poses[planet].position_m).normalize();
        let in_scene = poses[planet].system_from_body.inverse() * towards;
        assert!(at_body.dir_scene.angle_between(in_scene) < 1e-9);
        let lit = worlds.lit_planet(planet, 5e5).unwrap();
        assert!(lit.star.place(0.0).direction().angle_between(in_scene) < 1e-6);
    }
}
