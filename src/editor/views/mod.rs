//! Views: they read the state and send commands.
//!
//! - [`menus`]: the menu bar
//! - [`status`]: the status bar
//! - [`overlay`]: compass, scale and legend over the picture
//! - [`problems`]: notices and problems
//! - [`prompts`], `differences`, `path_field`, `rename`: questions and messages
//! - [`controls`], [`performance`], [`photo`], [`bake`], [`history`], [`library`], [`variations`], [`templates`],
//!   [`text`], [`place`], [`finder`], [`inspector`]: windows
//! - [`system`]: the bodies of a system, their orbits, the time
//! - [`tour`]: steps for a first look around
//! - [`shortcuts`]: keys and dropped files
//! - [`look`]: colours and spacing

pub mod bake;
pub mod controls;
mod differences;
pub mod finder;
pub mod history;
pub mod inspector;
pub mod library;
pub mod look;
pub mod menus;
pub mod overlay;
mod path_field;
pub mod performance;
pub mod photo;
pub mod place;
pub mod problems;
pub mod prompts;
mod rename;
pub mod shortcuts;
pub mod status;
pub mod system;
pub mod templates;
pub mod text;
pub mod tour;
pub mod variations;
