//! Handlers: they change the state, as commands and answers ask.
//!
//! - [`opening`]: another document in the place of this one, without losing unsaved work
//! - [`saving`]: the planet into a file
//! - [`answers`]: answers to questions about files, and the close button
//! - [`open_file`]: the open file has changed on disk
//! - [`shooting`]: photographs and films; [`baking`]: maps for other programs
//! - [`edit_baking`]: ground edits into a height picture
//! - [`biome_table`]: import and export of the biome table
//! - [`pictures`]: height maps
//! - [`variations`]: variations of the planet, and locks
//! - [`clipboard`]: parts and layers as text
//! - [`library`]: planets and parts that the user keeps
//! - [`compare`]: a kept planet beside the one that is edited
//! - [`bookmarks`]: views kept in the preset
//! - [`place`]: the flight to a location
//! - [`device`]: the graphics device fails
//! - [`system`]: systems, and the way from body to body
//! - [`window`]: full screen and theme

pub mod answers;
pub mod baking;
pub mod biome_table;
pub mod bookmarks;
pub mod clipboard;
pub mod compare;
pub mod device;
pub mod edit_baking;
pub mod library;
pub mod open_file;
pub mod opening;
pub mod pictures;
pub mod place;
pub mod saving;
pub mod shooting;
pub mod system;
pub mod variations;
pub mod window;
