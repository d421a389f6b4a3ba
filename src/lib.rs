//! Tellus: whole planets from one small file.
//!
//! A planet is a preset, a small RON text that an artist shapes in the `tellus` editor. A game loads the same text
//! through this crate and queries the same evaluator that drew the artist's picture. Heights are bit-identical on every
//! machine. The drawn mesh has them at the vertices of its finest tiles; between vertices it stays within the
//! screen-space error.
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
//! let ground = terrain.sample(LatLon::from_degrees(48.2, 16.4).direction());
//! println!("{:.1} m, {}", ground.height_m, terrain.planet().biomes.palette[ground.biome].name);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Data flows one way. A module uses only modules before it in this list:
//!
//! - [`simd`]: instruction sets, chosen at run time
//! - [`sphere`]: the globe as six squares; node addresses; latitude and longitude
//! - `noise_tile`: the noise of patterns on the ground and of clouds, as the renderer samples it
//! - [`planet`]: the preset's data, its parameters, loading and saving
//! - [`system`]: several bodies: orbits, rotation, starlight
//! - `world`: world maps: values for the whole globe, such as the distance to the coast
//! - [`terrain`]: [`terrain::Terrain`], the evaluator of the ground
//! - [`atmosphere`]: the physics of the air: transmittance and radiance along a ray
//! - [`sea`]: waves, and the height of the water at a time
//! - [`clouds`]: where clouds are, at any time
//! - [`rings`]: rings along the radius: optical depth, light, shadow
//! - [`giant`]: bands, jets and storms of gas giants
//! - [`lod`]: which nodes are drawn for a view
//! - [`life`]: plants, stones and other objects on the ground: where they stand, and their meshes
//! - [`tiles`]: tiles from nodes, on all cores, in the background, stage by stage
//! - `made`: what made a file, and whether it is whole: sets of files that are made part by part
//! - `bake` (feature `bake`): maps and meshes of a planet in files
//! - `capi` (feature `capi`): the C interface
//! - `render` (feature `render`): draws a planet with wgpu into any texture view of the caller's device
//! - `film` (feature `render`): photographs and films in files
//! - `editor` (feature `editor`): the application
//! - `cli` (feature `cli`): the command line, which also starts the editor
//!
//! Lengths are metres and angles are radians, unless a name says otherwise. Names state frames (`sun_dir_planet`). The
//! planet frame has its origin in the planet's centre, +Z through the north pole, +X through latitude 0, longitude 0.

/// The vectors of all signatures.
pub use glam;
/// The threads of [`tiles::BuilderOptions::pool`].
pub use rayon;

pub mod atmosphere;
pub mod clouds;
pub mod giant;
pub mod life;
pub mod lod;
#[cfg(any(feature = "bake", feature = "render"))]
mod made;
mod noise_tile;
pub mod planet;
pub mod rings;
pub mod sea;
pub mod simd;
pub mod sphere;
pub mod system;
pub mod terrain;
pub mod tiles;
mod world;

#[cfg(feature = "bake")]
pub mod bake;
#[cfg(any(feature = "capi", test))]
pub mod capi;
#[cfg(feature = "render")]
pub mod film;
#[cfg(feature = "render")]
pub mod render;

// Programs, not parts of one.
#[cfg(feature = "cli")]
#[doc(hidden)]
pub mod cli;
#[cfg(feature = "editor")]
#[doc(hidden)]
pub mod editor;

/// The programs of the guides are compiled and run with the examples of the documentation.
#[cfg(doctest)]
mod guides {
    #[doc = include_str!("../docs/games.md")]
    mod games {}
    #[cfg(feature = "bake")]
    #[doc = include_str!("../docs/baking.md")]
    mod baking {}
    #[cfg(feature = "bake")]
    #[doc = include_str!("../docs/meshes.md")]
    mod meshes {}
    #[cfg(feature = "render")]
    #[doc = include_str!("../docs/systems.md")]
    mod systems {}
    #[doc = include_str!("../README.md")]
    mod readme {}
}
