//! What a game server does with a planet: load its preset, ask for the ground under places, put things on it.
//!
//! ```sh
//! cargo run --no-default-features --example query -- planets/aurel.ron
//! ```
//!
//! Needs neither a GPU nor the editor. The heights are the ones that the editor draws, to the bit.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::sync::Arc;
use tellus::planet::{Planet, shipped};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

fn main() -> Result<(), Box<dyn Error>> {
    let planet = match std::env::args().nth(1) {
        Some(path) => Planet::load(path)?,
        None => shipped::default_planet(),
    };
    let planet = Arc::new(planet);
    // Compiled once, then shared: asking takes `&self` and works from any thread.
    let terrain = Terrain::try_new(Arc::clone(&planet))?;

    println!("{}, radius {} km", planet.name, planet.radius_km);
    for (name, lat_deg, lon_deg) in
        [("spawn", 47.4, 8.5), ("equator", 0.0, 100.0), ("north pole", 90.0, 0.0), ("far south", -62.0, -58.0)]
    {
        let up = LatLon::from_degrees(lat_deg, lon_deg).direction();
        let ground = terrain.sample(up);
        let biome = planet.biomes.palette.get(ground.biome).map_or("?", |biome| biome.name.as_str());
        let at_sea = planet.sea_level_m().is_some_and(|sea_m| ground.height_m < sea_m);
        // Where a thing stands that is put on the ground there, in metres from the planet's centre.
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

    // Many places at once, on all cores: the highest of a thousand places along the equator.
    let around: Vec<_> =
        (0..1000).map(|i| LatLon::from_degrees(0.0, f64::from(i) * 0.36 - 180.0).direction()).collect();
    let highest_m = terrain.heights_m(&around).into_iter().fold(f64::MIN, f64::max);
    println!("highest place looked at on the equator: {highest_m:.1} m");
    Ok(())
}
