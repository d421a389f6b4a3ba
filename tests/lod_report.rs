//! What views need.
#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]
use std::sync::Arc;
use std::time::Instant;
use tellus::build::build_now;
use tellus::lod::{Camera, Quality, View, opening, Culling};
use tellus::planet::shipped;
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

#[test]
#[ignore = "prints what views need"]
fn report() {
    for shipped in shipped::ALL {
        let name = shipped.file;
        let planet = Arc::new(shipped.load().unwrap());
        let terrain = Terrain::new(planet.clone());
        for (what, lat, lon, alt, pitch) in [("opening", 0.0, 0.0, -1.0, 0.0), ("2m", 35.0, -5.0, 2.0, -5.0), ("2m", 10.0, 60.0, 2.0, 0.0), ("1km", 35.0, -5.0, 1000.0, -10.0)] {
            for quality in Quality::ALL {
                let mut view = opening::opening_view(&planet, [1280, 720], quality);
                if alt > 0.0 {
                    let place = LatLon::from_degrees(lat, lon);
                    let h = terrain.height_m(place.direction()).max(planet.sea_level_m().unwrap_or(-1e9));
                    view.camera = Camera::over(place, planet.radius_m() + h + alt, 0.6, f64::to_radians(pitch), Camera::DEFAULT_FOV_Y_RAD);
                }
                let t = Instant::now();
                let s = build_now(&planet, &view);
                let ms = t.elapsed().as_secs_f64() * 1e3;
                let lowest = tellus::build::lowest_radius_m(&s.terrain);
                let c = Culling::new(&view, lowest);
                let drawn = s.leaves.iter().filter(|l| c.sees(&l.tile)).count();
                println!("{name:10} {what:8} {quality:?} leaves {} drawn {drawn} built {} {ms:.0} ms", s.leaves.len(), s.stats.tiles_built);
            }
        }
    }
}
