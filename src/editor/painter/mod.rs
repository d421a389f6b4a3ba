//! Painting the biome table, apart from any widget.
//!
//! - [`tools`]: brush, line, rectangle, fill: what a gesture makes of a table
//! - [`survey`]: where the planet lies in its table, found on a thread of its own
//! - [`table_png`]: the table as a picture, one pixel for each cell

/// Whether these keys make a click pick a biome in the table, and paint the climate of a place on the planet. Not Alt,
/// with which many desktops move windows.
pub fn is_chord(modifiers: eframe::egui::Modifiers) -> bool {
    modifiers.command
}

pub mod survey;
pub mod table_png;
pub mod tools;
