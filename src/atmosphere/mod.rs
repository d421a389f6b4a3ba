//! The physics of a planet's air in f64: what the shaders are tested against, and what a game may ask.
//!
//! - `medium`: scattering and extinction by altitude, phase functions
//! - `line`: a ray over a sphere, by altitudes
//! - `depth`: optical depth to the top of the air, exact and as a table
//! - `multiscatter`: light that is scattered twice or more, as a table
//! - `scatter`: transmittance to the star and radiance along a ray, by the method of the shaders
//! - [`mod@reference`]: the same radiance by path tracing, slow and without the method's approximation
//!
//! Method: Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique, 2020. Inside, lengths are
//! kilometres, because coefficients are per kilometre; colours are linear RGB; radiance is that for a star of unit
//! irradiance. The ground is the smooth reference sphere.

mod depth;
mod line;
mod medium;
mod multiscatter;
pub mod reference;
mod scatter;

pub use scatter::{Air, SkyRay};
