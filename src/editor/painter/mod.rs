//! Painting the biome table, apart from any widget.
//!
//! - [`tools`]: brush, line, rectangle, fill
//! - [`survey`]: the share of land in each cell, found on another thread
//! - [`table_png`]: the table as a picture with one pixel for each cell

/// Whether these keys are the chord with which a click picks a biome in the table, and paints the climate under it on
/// the planet. It is not Alt, with which many desktops move windows.
pub fn is_chord(modifiers: eframe::egui::Modifiers) -> bool {
    modifiers.command
}

pub mod survey;
pub mod table_png;
pub mod tools;
