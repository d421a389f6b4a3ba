//! The life tab: populations of plants, stones and other objects.
//!
//! - `tab`: its parts, and the parameters of the selected population; `list`: the populations
//! - `ready`: ready populations, to click, or to drag into the list or onto the planet
//! - `form_box`: the form of the selected population, which turns; `pictures`: the pictures of forms

mod form_box;
mod list;
mod pictures;
mod ready;
mod tab;

pub use tab::{LifeState, show};
