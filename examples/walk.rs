//! A crowd walks on a planet: two hundred characters at sixty steps a second on one thread.
//!
//! ```sh
//! cargo run --release --no-default-features --example walk -- planets/aurel.ron 46.0 9.5
//! ```
//!
//! All of them share a patch of ground. Each walks in a direction of its own, over steps and around what is too steep,
//! jumps now and then, and stands still in the end.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::sync::Arc;
use std::time::Instant;
use tellus::glam::DVec3;
use tellus::planet::{Planet, shipped};
use tellus::sphere::{LatLon, Tangent};
use tellus::terrain::{GroundPatch, Terrain, Walker, WalkerBody};

const CROWD: usize = 200;
const RATE_HZ: u32 = 60;
const SECS: u32 = 20;
const PACE_M_S: f64 = 1.5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut args = std::env::args().skip(1);
    let planet = match args.next() {
        Some(path) => Planet::load(path)?,
        None => shipped::default_planet(),
    };
    let (lat_deg, lon_deg) = match (args.next(), args.next()) {
        (Some(lat), Some(lon)) => (lat.parse()?, lon.parse()?),
        _ => (46.0, 9.5),
    };
    let terrain = Arc::new(Terrain::try_new(planet.into())?);
    let place = Tangent::at(LatLon::from_degrees(lat_deg, lon_deg));
    let body = WalkerBody::on(terrain.planet());
    let mut patch = GroundPatch::new(Arc::clone(&terrain));

    // A sunflower of people, each with a way of its own.
    let start = |i: usize| {
        let (sin, cos) = (i as f64 * 2.4).sin_cos();
        let away_rad = 3.0 * (i as f64).sqrt() / terrain.planet().radius_m();
        (place.direction(cos * away_rad, sin * away_rad), place.east_planet * cos + place.north_planet * sin)
    };
    let (dirs, ways): (Vec<DVec3>, Vec<DVec3>) = (0..CROWD).map(start).unzip();
    let mut crowd: Vec<Walker> = dirs.iter().map(|dir| Walker::on_ground(body, &mut patch, *dir)).collect();

    let (begun, mut longest_ms) = (Instant::now(), 0.0_f64);
    for step in 0..SECS * RATE_HZ {
        let tick = Instant::now();
        for (i, (walker, way)) in crowd.iter_mut().zip(&ways).enumerate() {
            if step as usize % 600 == 3 * i {
                walker.jump(2.0);
            }
            walker.step(&mut patch, *way * PACE_M_S, 1.0 / f64::from(RATE_HZ));
        }
        longest_ms = longest_ms.max(tick.elapsed().as_secs_f64() * 1e3);
    }
    let step_us = begun.elapsed().as_secs_f64() * 1e6 / (CROWD as f64 * f64::from(SECS * RATE_HZ));
    println!(
        "{}: {step_us:.1} us a step, the slowest tick of {CROWD} walkers {longest_ms:.1} ms",
        terrain.planet().name
    );
    let on_foot = crowd.iter().filter(|walker| walker.is_standing()).count();
    let walked_m = crowd.iter().zip(&dirs).map(|(walker, dir)| walker.feet_planet_m().normalize().distance(*dir));
    let walked_m = walked_m.sum::<f64>() * terrain.planet().radius_m() / CROWD as f64;
    println!(
        "{on_foot} are on their feet, {walked_m:.1} m from their start in the mean, on {} kB",
        patch.resident_bytes() / 1000
    );
    Ok(())
}
