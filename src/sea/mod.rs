//! Waves of the sea at a place and a time: the same numbers for the picture and for a boat that floats in it.
//!
//! The waves are plane waves in the planet frame. A place has those that lie in its tangent plane and run with its
//! wind; their heights follow a spectrum of wind and fetch. The renderer draws the waves of the eye's place.
//!
//! - `spectrum`: variance of the waves' slope by wavelength
//! - `wind`: wind over the sea
//! - `column`: the water under a place: what depth, bed and ice do to waves
//! - `waves`: the waves of a place, and the water's height

mod column;
mod spectrum;
mod waves;
mod wind;

pub use column::Column;
#[cfg(feature = "render")]
pub(crate) use column::{BED_REACH_M, BREAKING, CROWDED, DEEP, ICE_COLDER_C, ICE_DAMPING_M, LEE, TURN, TURN_FALL};
#[cfg(feature = "render")]
pub(crate) use waves::{LEAST_SKEWED, MOST_WAVES, SKEW};
pub use waves::{WaterSurface, Waves};
#[cfg(feature = "render")]
pub(crate) use wind::relative_wind;
