//! The program in README.md, section "In a game".

#![allow(clippy::print_stdout)]

use std::error::Error;
use tellus::planet::Planet;
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

fn main() -> Result<(), Box<dyn Error>> {
    let planet = Planet::load("planets/aurel.ron")?;
    let terrain = Terrain::try_new(planet.into())?;
    let ground = terrain.sample(LatLon::from_degrees(48.2, 16.4).direction());
    println!("{:.1} m, {}", ground.height_m, terrain.planet().biomes.palette[ground.biome].name);
    Ok(())
}
