//! A game server with a planet: load the preset, query the ground at locations, put objects on it.
//!
//! ```sh
//! cargo run --no-default-features --example query -- planets/aurel.ron
//! ```
//!
//! Needs neither a GPU nor the editor. Heights are those of the editor's mesh: at its vertices to the bit, between
//! them within the screen-space error.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::sync::Arc;
use tellus::planet::{Planet, shipped};
use tellus::sphere::LatLon;
use tellus::terrain::{Scratch, Terrain, Wanted};

fn main() -> Result<(), Box<dyn Error>> {
    let planet = match std::env::args().nth(1) {
        Some(path) => Planet::load(path)?,
        None => shipped::default_planet(),
    };
    let planet = Arc::new(planet);
    // Compiled once, then shared: queries take `&self` and run on any thread.
    let terrain = Terrain::try_new(Arc::clone(&planet))?;

    println!("{}, radius {} km", planet.name, planet.radius_km);
    for (name, lat_deg, lon_deg) in
        [("spawn", 47.4, 8.5), ("equator", 0.0, 100.0), ("north pole", 90.0, 0.0), ("far south", -62.0, -58.0)]
    {
        let up = LatLon::from_degrees(lat_deg, lon_deg).direction();
        let ground = terrain.sample(up);
        let biome = planet.biomes.palette.get(ground.biome).map_or("?", |biome| biome.name.as_str());
        let at_sea = planet.sea_level_m().is_some_and(|sea_m| ground.height_m < sea_m);
        // The position of an object on the ground, in metres from the planet's centre.
        let position_m = up * (planet.radius_m() + ground.height_m);
        println!(
            "{name:>10}: {:8.1} m{}, slope {:4.1}°, {:5.1} °C, {biome}, normal {:.3}, position {position_m:.1}",
            ground.height_m,
            if at_sea { " (under the sea)" } else { "" },
            ground.slope_rad.to_degrees(),
            ground.temperature_c,
            ground.normal_planet,
        );
    }

    // Many points at once, on all cores: a thousand along the equator.
    let around: Vec<_> =
        (0..1000).map(|i| LatLon::from_degrees(0.0, f64::from(i) * 0.36 - 180.0).direction()).collect();
    let samples = terrain.samples(&around, Wanted::HEIGHT.and_climate());
    let highest_m = samples.iter().map(|sample| sample.height_m).fold(f64::MIN, f64::max);
    let hottest_c = samples.iter().map(|sample| sample.temperature_c).fold(f64::MIN, f64::max);
    println!("on the equator: highest ground {highest_m:.1} m, hottest {hottest_c:.1} °C");

    // In a game loop: the caller's own memory, so that no frame allocates.
    let (mut heights_m, mut scratch) = (vec![0.0; around.len()], Scratch::default());
    terrain.heights_into(&around, &mut heights_m, &mut scratch)?;
    let eye_m = around[0] * (planet.radius_m() + heights_m[0].max(planet.sea_level_m().unwrap_or(0.0)) + 50.0);
    if let Some(distance_m) = terrain.raycast_with(eye_m, around[1] - around[0] * 1.01, &mut scratch) {
        println!("a ray from 50 m meets the ground after {distance_m:.1} m");
    }
    Ok(())
}
