//! The physics of a planet's air in f64 on the CPU: the reference for the shaders, and an API for games.
//!
//! - `medium`: scattering and extinction coefficients by altitude; phase functions
//! - `line`: a ray over a sphere, in terms of altitude
//! - `depth`: optical depth to the top of the air, as an integral and as a LUT
//! - `sunlit`: the sunlight that reaches an altitude
//! - `multiscatter`: light that has been scattered, by its moments, as a LUT
//! - `glow`: light that is scattered twice or more, by direction, as a LUT
//! - `scatter`: transmittance to the sun, and radiance along a ray, by the same method as the shaders
//! - [`mod@reference`]: the same radiance by path tracing: slow, without the approximations of the method
//!
//! Method: Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique, 2020. Private code
//! measures lengths in kilometres, because coefficients are per kilometre. Colours are linear RGB. Radiance is for a
//! sun of unit irradiance. The ground is the reference sphere.

mod depth;
mod glow;
mod line;
mod medium;
mod multiscatter;
pub mod reference;
mod scatter;
mod sunlit;

pub use scatter::{Air, SkyRay};
