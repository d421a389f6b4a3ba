//! White is white and deep sea is dark: what planets reflect, measured in radiance from orbit.

use crate::support::{debug, frame_of, gpu, preset, surface_of, terrain};
use glam::{DVec3, dvec3};
use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Clouds, Planet, Water};
use tellus::render::DebugView;
use tellus::sphere::{LatLon, spread};

const SIDE_PX: usize = 96;
/// Directions that the eye is over.
const PLACES: [DVec3; 3] = [DVec3::X, DVec3::NEG_Y, dvec3(-0.5, 0.0, 0.87)];

fn luminance(color: [f32; 3]) -> f64 {
    f64::from(0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2])
}

/// What a kind of ground reflects, means over all its pixels.
#[derive(Clone, Copy, Debug, Default)]
struct Reflected {
    pixels: f64,
    /// Of the light that falls on the air above it.
    from_orbit: f64,
    /// Of the light that falls on itself.
    albedo: f64,
}

/// By the name of the biome; "sea" where there is water.
fn reflected(planet: &Arc<Planet>) -> BTreeMap<String, Reflected> {
    reflected_at(planet, &PLACES)
}

/// The same from over the given directions.
fn reflected_at(planet: &Arc<Planet>, places: &[DVec3]) -> BTreeMap<String, Reflected> {
    let terrain = terrain(planet);
    let sunlight = planet.star.brightness * luminance(planet.star.color.map(|channel| channel as f32));
    let fov_rad = 0.6_f64;
    let distance_m = 2.2 * planet.radius_m();
    let mut kinds: BTreeMap<String, Reflected> = BTreeMap::new();
    let mut gpu = gpu();
    for place in places {
        let place = place.normalize();
        // The star stands aside, so that the sea does not mirror it into the eye.
        let sun = (place + 0.9 * place.any_orthonormal_vector()).normalize();
        let camera = Camera::over(LatLon::from_direction(place), distance_m, 0.0, -FRAC_PI_2, fov_rad);
        let view = View { camera, size_px: [SIDE_PX as u32; 2], quality: Quality::Medium };
        let surface = surface_of(planet, &view);
        let shaded = frame_of(&surface, planet, view, sun);
        gpu.draw_only(&shaded, 1);
        let (_, light) = gpu.renderer.radiance().unwrap();
        gpu.draw_only(&debug(frame_of(&surface, planet, view, sun), DebugView::Albedo), 1);
        let (_, albedo) = gpu.renderer.radiance().unwrap();
        for (i, (light, albedo)) in light.into_iter().zip(albedo).enumerate() {
            let at = |n: usize| (n as f64 + 0.5) / SIDE_PX as f64 * 2.0 - 1.0;
            let ray = camera.ray_dir_planet(at(i % SIDE_PX), -at(i / SIDE_PX), 1.0);
            let eye_m = camera.position_planet_m;
            let along_m = -ray.dot(eye_m);
            let inside = along_m * along_m - eye_m.length_squared() + planet.radius_m().powi(2);
            let dir = (eye_m + ray * (along_m - inside.max(0.0).sqrt())).normalize();
            let mu = dir.dot(sun);
            if inside < 0.0 || mu < 0.6 || dir.dot(-ray) < 0.8 || ray.reflect(dir).dot(sun) > 0.75 {
                continue;
            }
            let ground = terrain.sample(dir);
            let wet = planet.sea_level_m().is_some_and(|level_m| ground.height_m < level_m - 200.0);
            let dry = planet.sea_level_m().is_none_or(|level_m| ground.height_m > level_m + 20.0);
            let name = match (wet, dry) {
                (true, _) if ground.temperature_c < 8.0 => continue,
                (true, _) => "sea".to_owned(),
                (_, true) => planet.biomes.palette[ground.biome].name.clone(),
                _ => continue,
            };
            let kind = kinds.entry(name).or_default();
            kind.pixels += 1.0;
            kind.from_orbit += luminance(light) / (mu * sunlight);
            kind.albedo += luminance(albedo);
        }
    }
    for kind in kinds.values_mut() {
        kind.from_orbit /= kind.pixels;
        kind.albedo /= kind.pixels;
    }
    kinds.retain(|_, kind| kind.pixels > 150.0);
    kinds
}

/// Share and rest of an albedo by which the view from orbit may differ: clear air adds light to dark ground and takes
/// some from bright ground.
const MOST_OFF: (f64, f64) = (0.15, 0.045);
/// Its crevasses shade each other.
const SHADED: &str = "Old ice";

/// The sea reflects about 0.06 (Payne 1972); air and the haze of clear days add up to a half.
#[test]
fn each_ground_reflects_what_its_preset_says() {
    for file in ["aurel.ron", "maren.ron", "cinnabar.ron", "hoarfrost.ron", "pallor.ron"] {
        let clear = Arc::new(Planet { clouds: None, ..preset(file) });
        let kinds = reflected(&clear);
        assert!(kinds.len() > 2, "{file}: {kinds:?}");
        for (name, kind) in kinds.into_iter().filter(|(name, _)| name != SHADED) {
            let off = (kind.from_orbit - kind.albedo).abs();
            let holds = match &*name {
                "sea" => (0.045..0.095).contains(&kind.from_orbit),
                _ => off < MOST_OFF.0 * kind.albedo + MOST_OFF.1,
            };
            assert!(holds, "{file}, {name}: {kind:?}");
        }
    }
}

/// What is known of the Earth's albedos, and the grounds of presets that stand for them: the file, the ground, and the
/// least and greatest albedo. Woodland: in visible light; plants reflect far more in the near infrared.
const KNOWN: [(&str, &str, f64, f64); 3] = [
    ("aurel.ron", "Woodland", 0.06, 0.1),
    ("aurel.ron", "Desert", 0.3, 0.4),
    ("hoarfrost.ron", "Fresh snow", 0.8, 0.8),
];
/// Share by which they may be missed.
const OFF: f64 = 0.15;

/// Zeros of the Legendre polynomial of degree 8, and their weights: nodes of Gauss's quadrature from -1 to 1.
const NODES: [(f64, f64); 4] = [
    (0.183_434_642_495_65, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887),
    (0.796_666_477_413_627, 0.222_381_034_453_374),
    (0.960_289_856_497_536, 0.101_228_536_290_376),
];

/// What a bare sea reflects of even light from the whole sky: the spherical albedo of a globe of that sea, which is the
/// same by reciprocity. The sum of its radiance in all directions, the glint of the star included.
fn even_albedo_of_sea(file: &str) -> f64 {
    let shipped = preset(file);
    let water = shipped.water.clone().map(|water| Water { level_m: 4000.0, ..water });
    let mut planet = Planet { water, star: shipped.star.clone(), ..Planet::default() };
    (planet.layers, planet.structure, planet.atmosphere, planet.clouds) = (Vec::new(), None, None, None);
    (planet.climate.equator_c, planet.climate.pole_c) = (25.0, 25.0);
    let planet = Arc::new(planet);
    let sunlight = planet.star.brightness * luminance(planet.star.color.map(|channel| channel as f32));
    let radius_m = planet.radius_m() + planet.sea_level_m().unwrap();
    let distance_m = 30.0 * radius_m;
    let fov_rad = 2.1 * (radius_m / distance_m).asin();
    let camera = Camera::over(LatLon::from_direction(DVec3::X), distance_m, 0.0, -FRAC_PI_2, fov_rad);
    let view = View { camera, size_px: [SIDE_PX as u32; 2], quality: Quality::High };
    let surface = surface_of(&planet, &view);
    let mut gpu = gpu();
    let mut sum = 0.0;
    for (cosine, weight) in NODES.into_iter().flat_map(|(x, weight)| [(x, weight), (-x, weight)]) {
        let sun = dvec3(cosine, (1.0 - cosine * cosine).sqrt(), 0.0);
        let ([width, height], light) = {
            gpu.draw_only(&frame_of(&surface, &planet, view, sun), 1);
            gpu.renderer.radiance().unwrap()
        };
        // Solid angle of a pixel in the middle of the picture; the picture is narrow.
        let pixel_sr = (2.0 * (0.5 * fov_rad).tan()).powi(2) / f64::from(width * height);
        let radiance_sr = light.into_iter().map(luminance).sum::<f64>() * pixel_sr;
        // White ground under the star has radiance 1, so the light that meets the disc is pi times its area. A globe
        // has equal pictures all around the axis to the star.
        sum += weight * 2.0 * radiance_sr * (distance_m / radius_m).powi(2) / (PI * sunlight);
    }
    sum
}

/// Payne, Albedo of the sea surface, 1972: 0.061 under an overcast sky, which is as bright in all directions. The share
/// of sunlight depends on its height (0.03 overhead, 0.06 at 30 degrees over the horizon), and most of it is the glint:
/// one look from aside shows less than half of it.
#[test]
fn the_sea_reflects_what_seas_do() {
    for file in ["aurel.ron", "maren.ron", "hoarfrost.ron", "alder.ron", "skerry.ron"] {
        let found = even_albedo_of_sea(file);
        assert!((found / 0.061 - 1.0).abs() < OFF, "{file}: {found}");
    }
}

/// The direction around which most of the ground is of a name.
fn middle_of(planet: &Arc<Planet>, name: &str) -> DVec3 {
    let terrain = terrain(planet);
    let is_there = |dir: &DVec3| {
        let ground = terrain.sample(*dir);
        let is_dry = planet.sea_level_m().is_none_or(|level_m| ground.height_m > level_m + 20.0);
        is_dry && planet.biomes.palette[ground.biome].name == name
    };
    let there: Vec<DVec3> = spread(3000).filter(is_there).collect();
    let near = |dir: &DVec3| there.iter().filter(|other| other.dot(*dir) > 0.98).count();
    *there.iter().max_by_key(|dir| near(dir)).expect("ground of this name")
}

/// Grounds without air reflect what is known of them, whatever the colours of their presets; sunlit thick cloud does,
/// over any ground and through the air.
#[test]
fn woods_deserts_snow_and_cloud_reflect_what_is_known_of_them() {
    let within = |found: f64, least: f64, most: f64| found > least * (1.0 - OFF) && found < most * (1.0 + OFF);
    for (file, name, least, most) in KNOWN {
        let airless = Arc::new(Planet { clouds: None, atmosphere: None, ..preset(file) });
        let kinds = reflected_at(&airless, &[middle_of(&airless, name)]);
        let kind = kinds.get(name).unwrap_or_else(|| panic!("{file}: {name} is not among {kinds:?}"));
        assert!(within(kind.from_orbit, least, most), "{file}, {name}: {kind:?}");
    }
    let maren = preset("maren.ron");
    let clouds = maren.clouds.clone().map(|clouds| Clouds { coverage: 1.0, veil: 0.0, ..clouds });
    for (name, kind) in reflected(&Arc::new(Planet { clouds, ..maren })) {
        assert!(within(kind.from_orbit, 0.6, 0.8), "cloud over {name}: {kind:?}");
    }
}

/// Closed cloud from above reflects what its optical depth says (Lacis and Hansen 1974), over sea and land alike.
#[test]
fn closed_cloud_is_white() {
    let preset = preset("maren.ron");
    for density in [12.0, 48.0] {
        let clouds = preset.clouds.clone().map(|clouds| Clouds { coverage: 1.0, veil: 0.0, density, ..clouds });
        let wanted = 0.13 * density / (1.0 + 0.13 * density);
        for (name, kind) in reflected(&Arc::new(Planet { clouds, ..preset.clone() })) {
            assert!((kind.from_orbit / wanted - 1.0).abs() < 0.15, "{density}, {name}: {kind:?}, wanted {wanted}");
        }
    }
}

/// Thin cloud and fog over snow send back their own light and that of the snow beneath. Without the latter they would
/// be grey patches. Two streams, middle clouds over snow of 0.8: 0.34 + 0.66^2 * 0.8 / (1 - 0.34 * 0.8).
#[test]
fn thin_cloud_over_snow_is_white() {
    let preset = preset("hoarfrost.ron");
    // Low clouds would be thick, but there are none.
    let none =
        Clouds { coverage: 0.0, density: 32.0, veil: 0.0, fog: 0.0, middle: 0.0, ..preset.clouds.clone().unwrap() };
    let snow = |clouds: Option<Clouds>| {
        let planet = Arc::new(Planet { clouds, ..preset.clone() });
        reflected_at(&planet, &[middle_of(&planet, "Fresh snow")])["Fresh snow"].from_orbit
    };
    let clear = snow(None);
    let middle = snow(Some(Clouds { middle: 1.0, middle_density: 4.0, ..none.clone() }));
    // Over the mountains.
    let fog = snow(Some(Clouds { fog: 1.0, fog_density: 6.0, fog_altitude_km: 4.0, ..none }));
    assert!(middle > 0.85 * clear, "{middle} under middle clouds, {clear} without");
    assert!(fog > 0.9 * clear, "{fog} under fog, {clear} without");
}
