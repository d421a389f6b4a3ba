//! Texture sets of biomes: as bright near as far, and seen from near alone.

use crate::materials::{PLACE, albedo_by_byte, ball, grey, middle};
use crate::support::gpu;
use crate::support::textures::{png, stripes};
use std::path::Path;
use tellus::planet::{Biome, Detail, Planet};

/// A bare ball with a texture set of these pictures.
fn covered(biome: Biome, pictures: &[(&str, Vec<u8>)]) -> Planet {
    let mut planet = ball(Biome { textures: "a_color.png".to_owned().into(), ..biome });
    let found = |path: &Path| pictures.iter().find(|(name, _)| Path::new(name) == path);
    let problems = planet.load_pictures_from(|path| found(path).map(|(_, bytes)| bytes.clone()).ok_or(String::new()));
    assert_eq!(problems, []);
    planet
}

/// A biome keeps its colour from orbit to the ground, whatever its textures, and they show up close.
#[test]
fn textures_show_from_near_and_keep_the_colour_of_the_biome() {
    let mut gpu = gpu();
    let planet = covered(Biome { detail_m: 4.0, ..grey(0.25) }, &[("a_color.png", stripes())]);
    let albedo = albedo_by_byte(&mut gpu, PLACE.1);
    let mut mean = |altitude_m: f64| {
        let pixels = middle(&mut gpu, &planet, altitude_m, PLACE.1);
        let light = |pixel: &[u8; 3]| pixel.iter().map(|byte| albedo[usize::from(*byte)]).sum::<f64>() / 3.0;
        let lights: Vec<f64> = pixels.iter().map(light).collect();
        let mean = lights.iter().sum::<f64>() / lights.len() as f64;
        let variance = lights.iter().map(|light| (light - mean).powi(2)).sum::<f64>() / lights.len() as f64;
        (mean, variance.sqrt())
    };
    let [(near, stripes), (far, even)] = [6.0, 2e4].map(&mut mean);
    println!("{near:.4} +- {stripes:.4} from near, {far:.4} +- {even:.4} from orbit");
    assert!((far / 0.25 - 1.0).abs() < 0.03 && (near / far - 1.0).abs() < 0.03, "{near} from near, {far} from orbit");
    assert!(stripes > 0.08 && even < 0.01, "{stripes} from near, {even} from orbit");
}

/// The built-in pattern gives way to the set, is back without it, and a set that changes is drawn anew.
#[test]
fn a_set_takes_the_place_of_the_pattern_and_follows_its_files() {
    let mut gpu = gpu();
    let gravel = Biome { detail: Detail::Gravel, ..grey(0.25) };
    let plain = || png([4; 2], |_, _| [120; 3]);
    let slopes = png([64; 2], |x, _| if x % 8 < 4 { [190, 128, 220] } else { [66, 128, 220] });
    let mut draw = |planet: &Planet| middle(&mut gpu, planet, 3.0, PLACE.1 + 40.0);
    let spread = |pixels: &[[u8; 3]]| {
        let mean = pixels.iter().map(|pixel| f64::from(pixel[1])).sum::<f64>() / pixels.len() as f64;
        (pixels.iter().map(|pixel| (f64::from(pixel[1]) - mean).powi(2)).sum::<f64>() / pixels.len() as f64).sqrt()
    };
    let with_gravel = draw(&ball(gravel.clone()));
    let even = draw(&covered(gravel.clone(), &[("a_color.png", plain())]));
    let tilted = draw(&covered(gravel.clone(), &[("a_color.png", plain()), ("a_normal.png", slopes)]));
    println!("{} with gravel, {} even, {} tilted", spread(&with_gravel), spread(&even), spread(&tilted));
    assert!(spread(&even) < 0.5 * spread(&with_gravel) && spread(&tilted) > 2.0 * spread(&even));
    let missing = Biome { textures: "gone.png".to_owned().into(), ..gravel };
    assert_eq!(draw(&ball(missing)), with_gravel);
}
