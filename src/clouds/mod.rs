//! Clouds of a planet at a time: how much of the sky they cover in each direction.
//!
//! A field of noise, swirled by wind and wound up by cyclones, says where clouds are: its *rank* is evenly distributed
//! over 0 to 1. The climate says how many: the *target cover* of a direction is the share of ranks that are clouded
//! there. So the cover that is asked for is the cover that is there, over the globe and in each zone.
//!
//! Everything is a function of the planet and the time. The renderer uploads the same numbers as cube maps, one
//! keyframe an hour, and blends two of them; [`CloudField::cover`] blends the same two.
//!
//! - `field`: ranks at directions; `swirl`: noise along the wind; `systems`: cyclones at a time
//! - `cover`: target cover, and cover from rank and target
//! - `ranks`: the distribution of a noise; `maps`: cube maps of ranks and targets

mod cover;
mod field;
#[cfg(feature = "render")]
mod maps;
mod ranks;
mod swirl;
mod systems;
#[cfg(test)]
mod tests;

pub use cover::CloudCover;
pub use field::CloudField;
#[cfg(feature = "render")]
pub(crate) use field::{coverages, keyframes};
#[cfg(feature = "render")]
pub(crate) use maps::{Keyframe, Texels, ground_map, keyframe};
