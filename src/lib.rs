//! Tellus: whole planets from one small file.
//!
//! A planet is a preset, a small RON text that an artist shapes in the `tellus` editor. A game loads the same text
//! through this crate and queries the evaluator that made the artist's picture. Heights are bit-identical on every
//! machine. A query has the height of the picture's finest mesh vertices, and between them a height within the
//! screen-space error of the mesh.
//!
//! ```
//! use tellus::planet::Planet;
//! use tellus::sphere::LatLon;
//! use tellus::terrain::Terrain;
//!
//! let planet = Planet::from_text("islet.ron", r#"(
//!     version: 1,
//!     name: "Islet",
//!     radius_km: 40.0,
//!     layers: [(name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 12.0, octaves: 8))],
//!     water: (level_m: -50.0),
//! )"#)?;
//! let terrain = Terrain::try_new(planet.into())?;
//! let place = terrain.sample(LatLon::from_degrees(48.2, 16.4).direction());
//! println!("{:.1} m, {}", place.height_m, terrain.planet().biomes.palette[place.biome].name);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Data flows one way; a module knows only those above it in this list:
//!
//! - [`planet`]: what a planet is: the preset's data, its parameters, loading and saving
//! - [`sphere`]: the globe as six squares; node addresses; latitude and longitude
//! - `world`: world maps: values for the whole globe, such as the distance to the coast
//! - [`terrain`]: what the surface is: [`terrain::Terrain`], the evaluator that everything asks
//! - [`atmosphere`]: the physics of the air: transmittance and radiance along a ray
//! - [`lod`]: which nodes are shown from where
//! - [`tiles`]: tiles from nodes, on all cores, in the background, stage by stage
//! - `render` (feature `render`): draws a planet with wgpu into any texture view of the caller's device
//! - `editor`, `cli` (feature `editor`): the application and the command line
//!
//! Lengths are metres, angles radians, unless a name says otherwise. Frames are named in full (`sun_dir_planet`): the
//! planet frame has its origin in the planet's centre, +Z through the north pole, +X through latitude 0, longitude 0.

/// The vectors of all signatures.
pub use glam;

pub mod atmosphere;
pub mod lod;
pub mod planet;
pub mod sphere;
pub mod terrain;
pub mod tiles;
mod world;

#[cfg(feature = "render")]
pub mod render;

#[cfg(feature = "editor")]
pub mod cli;
#[cfg(feature = "editor")]
pub mod editor;
