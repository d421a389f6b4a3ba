//! Widgets that know parameters but no part of the planet by name.
//!
//! - [`param_row`]: one parameter as a row: label, slider, number, reset
//! - [`params_grid`]: all parameters of a part
//! - [`curve_edit`]: a curve through points
//! - [`icon`]: drawn icons and their buttons
//! - [`number`]: numbers as text, with units

pub mod curve_edit;
pub mod icon;
pub mod number;
pub mod param_row;
pub mod params_grid;

use crate::planet::param::ParamPath;
use eframe::egui;
use std::hash::{BuildHasher, RandomState};

/// A linear colour as egui wants it.
pub fn color32(linear: [f64; 3]) -> egui::Color32 {
    egui::Rgba::from_rgb(linear[0] as f32, linear[1] as f32, linear[2] as f32).into()
}

/// Black or white, whichever is readable on a colour.
pub fn ink_on(color: egui::Color32) -> egui::Color32 {
    if color.intensity() > 0.5 { egui::Color32::BLACK } else { egui::Color32::WHITE }
}

/// A seed nobody chose. The standard library keys its hash maps at random; that is random enough for a landscape.
pub fn random_seed() -> u64 {
    RandomState::new().hash_one(std::time::SystemTime::now().elapsed().ok())
}

/// The first thing wrong with the parameter at `path`, if anything is.
pub fn problem_at<'a>(problems: &'a [(ParamPath, String)], path: &ParamPath) -> Option<&'a str> {
    problems.iter().find(|(at, _)| at == path).map(|(_, message)| message.as_str())
}
