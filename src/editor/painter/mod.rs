//! Painting the biome table, apart from any widget.
//!
//! - [`tools`]: brush, line, rectangle, fill: what a gesture makes of a table
//! - [`survey`]: where the planet lies in its table, found on a thread of its own
//! - [`table_png`]: the table as a picture, one pixel for each cell

pub mod survey;
pub mod table_png;
pub mod tools;
