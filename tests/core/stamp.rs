//! Height pictures as stamps: where each pixel lies, how copies are turned, and files that are missing.

use crate::sculpt::{at, beside, edit, planet, terrain};
use tellus::planet::edits::{GroundEdit, PictureStamp, Tool};
use tellus::planet::{Planet, VERSION};

/// Name of [`hills`].
pub(crate) const HILLS: &str = "hills.png";

/// Width and height of the slope.
const SIZE: [usize; 2] = [96, 64];

fn png(value: impl Fn(f64, f64) -> f64) -> Vec<u8> {
    let [width, height] = SIZE;
    let half = 0.5 * width as f64;
    let place = |i: usize| {
        let (column, row) = ((i % width) as f64 + 0.5, (i / width) as f64 + 0.5);
        ((column - 0.5 * width as f64) / half, (0.5 * height as f64 - row) / half)
    };
    let pixels = (0..width * height).map(place).map(|(x, y)| (value(x, y) * 65535.0 + 0.5) as u16);
    let data: Vec<u8> = pixels.flat_map(u16::to_be_bytes).collect();
    let mut file = Vec::new();
    let mut encoder = png::Encoder::new(&mut file, width as u32, height as u32);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    encoder.write_header().unwrap().write_image_data(&data).unwrap();
    file
}

/// A picture of hills.
pub(crate) fn hills() -> Vec<u8> {
    png(|x, y| 0.5 + 0.2 * (9.0 * x).sin() + 0.2 * (7.0 * y + 3.0 * x).cos())
}

/// A plane, which splines keep as it is.
fn slope(x: f64, y: f64) -> f64 {
    0.5 + 0.3 * x + 0.25 * y
}

fn stamped(stamp: &PictureStamp, more: impl Fn(GroundEdit) -> GroundEdit) -> Planet {
    let stamp = edit(Tool::Picture(stamp.clone()), 40.0, &[at(20.0, 30.0)]);
    let mut planet = planet(0.0, vec![more(GroundEdit { softness: 0.2, ..stamp })]);
    planet.each_picture(|_, file, _| *file = "slope.png".to_owned().into());
    assert!(planet.load_pictures_from(|_| Ok(png(slope))).is_empty());
    planet
}

#[test]
fn pixels_lie_where_the_picture_has_them() {
    for (turn_deg, level, height_m) in [(0.0, 0.0, 1000.0), (30.0, 0.5, 800.0), (-140.0, 1.0, -600.0)] {
        let plain = PictureStamp { turn_deg, level, height_m, ..PictureStamp::default() };
        let terrain = terrain(&stamped(&plain, |edit| edit));
        for (heading_deg, share) in [(0.0, 0.0), (0.0, 0.4), (77.0, 0.6), (200.0, 0.55), (270.0, 0.79)] {
            let found_m = terrain.height_m(beside(&at(20.0, 30.0), heading_deg, 40.0 * share));
            // The picture is turned clockwise, so a heading counts from its top.
            let (sin, cos) = f64::to_radians(heading_deg - turn_deg).sin_cos();
            let wanted_m = height_m * (slope(share * sin, share * cos) - level);
            // Sixteen bits, and the curve of the ground.
            assert!((found_m - wanted_m).abs() < 0.1, "{turn_deg} {heading_deg} {share}: {found_m} {wanted_m}");
        }
        // Beyond the ring nothing changes, and the softness leads there.
        assert_eq!(terrain.height_m(beside(&at(20.0, 30.0), 45.0, 40.1)), 0.0);
        let near_m = terrain.height_m(beside(&at(20.0, 30.0), 45.0, 39.9));
        assert!(near_m != 0.0 && near_m.abs() < 1.0, "{near_m}");
    }
}

#[test]
fn copies_are_turned_at_random_or_not() {
    // The slope at the middle of each copy tells how it is turned.
    let turns = |random_turn_deg: f64| -> Vec<f64> {
        let stamp = PictureStamp { random_turn_deg, ..PictureStamp::default() };
        let planet = stamped(&stamp, |edit| GroundEdit { copies: 40, spread_km: 900.0, smallest: 1.0, ..edit });
        let terrain = terrain(&planet);
        let ground = (0..40_000).map(|i| beside(&at(20.0, 30.0), f64::from(i) * 7.31, f64::from(i) * 0.02));
        let high = ground.filter(|dir| terrain.height_m(*dir) > 100.0).map(|dir| {
            let (east, north) = tellus::sphere::geo::east_north(dir);
            let height_m = |to: glam::DVec3| terrain.height_m((dir + to * 1e-6).normalize());
            (height_m(east) - height_m(-east)).atan2(height_m(north) - height_m(-north)).to_degrees()
        });
        high.collect()
    };
    // Uphill is to the upper right of the picture; fades and overlaps turn the others.
    let uphill_deg = 0.3_f64.atan2(0.25).to_degrees();
    let near = |turns: &[f64]| turns.iter().filter(|turn| (**turn - uphill_deg).abs() < 10.0).count();
    let (still, turned) = (turns(0.0), turns(180.0));
    assert!(still.len() > 500 && turned.len() > 500);
    assert!(near(&still) * 2 > still.len(), "{} of {}", near(&still), still.len());
    assert!(near(&turned) * 4 < turned.len(), "{} of {}", near(&turned), turned.len());
}

#[test]
fn files_are_relative_to_the_preset_and_missing_ones_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let preset = folder.path().join("isle.ron");
    let text = format!(
        "(version: {VERSION}, radius_km: 1000, edits: [\n(tool: Picture(file: \"slope.png\"), points: [(20, 30)]),\n])"
    );
    std::fs::write(&preset, text).unwrap();
    let told = Planet::load(&preset).unwrap_err().to_string();
    assert!(told.contains("isle.ron:2") && told.contains("there is no file"), "{told}");
    std::fs::write(folder.path().join("slope.png"), png(slope)).unwrap();
    let planet = Planet::load(&preset).unwrap();
    let height_m = terrain(&planet).height_m(at(20.0, 30.0).direction());
    assert!((height_m - 750.0).abs() < 0.1, "{height_m}");
    // The content of the picture is part of the planet's hash.
    let key = tellus::planet::Key::of_planet(&planet);
    std::fs::write(folder.path().join("slope.png"), hills()).unwrap();
    assert_ne!(tellus::planet::Key::of_planet(&Planet::load(&preset).unwrap()), key);
    // A wrong file, and one that is too small.
    std::fs::write(folder.path().join("slope.png"), "no picture").unwrap();
    let told = Planet::load(&preset).unwrap_err().to_string();
    assert!(told.contains("is neither PNG nor OpenEXR"), "{told}");
}
