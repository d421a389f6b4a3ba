//! A game server without a renderer: it answers heights and biomes over a local socket for a thousand agents.
//!
//! ```sh
//! cargo run --release --no-default-features --example server                       # planets/aurel.ron
//! cargo run --release --no-default-features --example server -- PLANET.ron         # another planet
//! cargo run --release --no-default-features --example server -- PLANET.ron ADDRESS # serves until it is stopped
//! ```
//!
//! A request is lines of `latitude,longitude` in degrees and an empty line; the answer has `height_m,biome` for each of
//! them in order, and an empty line. Without an address the program serves its own thousand agents, who walk about in
//! bands, checks every answer against the library, and prints how fast it was.

#![allow(clippy::print_stdout)]

use std::error::Error;
use std::io::{self, BufRead, BufReader, BufWriter, Write};
use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::time::{Duration, Instant};
use tellus::glam::DVec3;
use tellus::planet::Planet;
use tellus::sphere::{LatLon, Tangent, spread};
use tellus::terrain::{Sample, Scratch, Terrain, Wanted};

const AGENTS: usize = 1000;
/// Agents that live near each other ask over one connection: neighbours in a batch cost less.
const BANDS: usize = 8;
const TICKS: usize = 20;
const STEP_M: f64 = 2.0;

type Failure = Box<dyn Error + Send + Sync>;

fn main() -> Result<(), Failure> {
    let mut args = std::env::args().skip(1);
    let preset = args.next().unwrap_or_else(|| "planets/aurel.ron".to_owned());
    let terrain = Arc::new(Terrain::try_new(Planet::load(&preset)?.into())?);
    let name = terrain.planet().name.clone();
    if let Some(address) = args.next() {
        let listener = TcpListener::bind(&address)?;
        println!("{name} on {}", listener.local_addr()?);
        return serve(&listener, &terrain);
    }
    let listener = TcpListener::bind("127.0.0.1:0")?;
    let address = listener.local_addr()?;
    let served = Arc::clone(&terrain);
    std::thread::spawn(move || serve(&listener, &served));

    let begun = Instant::now();
    let bands: Vec<_> = spread(BANDS)
        .map(|center| {
            let terrain = Arc::clone(&terrain);
            std::thread::spawn(move || walk(&terrain, TcpStream::connect(address)?, center))
        })
        .collect();
    let mut ticks: Vec<Duration> = Vec::new();
    for band in bands {
        ticks.extend(band.join().map_err(|_| "a band of agents failed")??);
    }
    let secs = begun.elapsed().as_secs_f64();
    ticks.sort();
    println!(
        "{name}: {AGENTS} agents, {TICKS} ticks: {:.0} answers a second, a tick of {} agents in {:.2} ms (median)",
        (AGENTS * TICKS) as f64 / secs,
        AGENTS / BANDS,
        ticks[ticks.len() / 2].as_secs_f64() * 1e3,
    );
    Ok(())
}

/// Answers each connection on a thread of its own.
fn serve(listener: &TcpListener, terrain: &Arc<Terrain>) -> Result<(), Failure> {
    for connection in listener.incoming() {
        let (connection, terrain) = (connection?, Arc::clone(terrain));
        // Requests are small and wait for their answers.
        connection.set_nodelay(true)?;
        std::thread::spawn(move || {
            if let Err(error) = answer(&terrain, &connection) {
                println!("a connection ended: {error}");
            }
        });
    }
    Ok(())
}

/// Most places of a request.
const MOST_PLACES: usize = 100_000;
/// Longest line of a request.
const LONGEST_LINE: u64 = 100;

fn answer(terrain: &Terrain, connection: &TcpStream) -> Result<(), Failure> {
    let (mut requests, mut answers) = (BufReader::new(connection), BufWriter::new(connection));
    let (mut dirs, mut samples, mut scratch) = (Vec::new(), Vec::new(), Scratch::default());
    let mut line = String::new();
    loop {
        line.clear();
        if io::Read::take(&mut requests, LONGEST_LINE).read_line(&mut line)? == 0 {
            return Ok(());
        }
        if let Some(dir) = direction(&line) {
            dirs.push(dir);
            if dirs.len() > MOST_PLACES {
                return Err(format!("a request of more than {MOST_PLACES} places").into());
            }
            continue;
        }
        if !line.trim().is_empty() {
            return Err(format!("{line:?} is no place").into());
        }
        samples.clear();
        samples.resize(dirs.len(), Sample::default());
        terrain.samples_into(&dirs, Wanted::HEIGHT.and_biome(), &mut samples, &mut scratch)?;
        for sample in &samples {
            writeln!(answers, "{},{}", sample.height_m, terrain.planet().biomes.palette[sample.biome].name)?;
        }
        writeln!(answers)?;
        answers.flush()?;
        dirs.clear();
    }
}

fn direction(line: &str) -> Option<DVec3> {
    let (lat, lon) = line.trim().split_once(',')?;
    Some(LatLon::from_degrees(lat.parse().ok()?, lon.parse().ok()?).direction())
}

/// A band of agents walks a number of ticks. The time that each tick took, from the request to the answer.
fn walk(terrain: &Terrain, connection: TcpStream, center: DVec3) -> Result<Vec<Duration>, Failure> {
    connection.set_nodelay(true)?;
    let (mut answers, mut requests) = (BufReader::new(connection.try_clone()?), BufWriter::new(connection));
    let (around, radius_m) = (Tangent::new(center), terrain.planet().radius_m());
    // Agents on a ring of 100 m, each on a way of its own.
    let agents = (0..AGENTS / BANDS).map(|i| {
        let (sin, cos) = (i as f64).sin_cos();
        (DVec3::new(cos, sin, 0.0) * 100.0, DVec3::new(-sin, cos, 0.0) * STEP_M)
    });
    let mut agents: Vec<(DVec3, DVec3)> = agents.collect();
    let (mut ticks, mut line) = (Vec::with_capacity(TICKS), String::new());
    for _ in 0..TICKS {
        let mut places = Vec::with_capacity(agents.len());
        for (place_m, step_m) in &mut agents {
            *place_m += *step_m;
            places.push(LatLon::from_direction(around.direction(place_m.x / radius_m, place_m.y / radius_m)));
        }
        let begun = Instant::now();
        for (lat, lon) in places.iter().map(|place| place.to_degrees()) {
            writeln!(requests, "{lat},{lon}")?;
        }
        writeln!(requests)?;
        requests.flush()?;
        for (place, is_checked) in places.iter().zip((0..50).map(|i| i == 0).cycle()) {
            line.clear();
            answers.read_line(&mut line)?;
            if is_checked {
                let (lat, lon) = place.to_degrees();
                let wanted = terrain.height_m(LatLon::from_degrees(lat, lon).direction());
                let found: f64 = line.split(',').next().unwrap_or_default().parse()?;
                if found.to_bits() != wanted.to_bits() {
                    return Err(format!("the server answers {found} m where the library answers {wanted} m").into());
                }
            }
        }
        answers.read_line(&mut line)?;
        ticks.push(begun.elapsed());
    }
    Ok(ticks)
}
