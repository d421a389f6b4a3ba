//! Finding things by what is typed, apart from any widget.
//!
//! - [`fuzzy`]: how well a word fits a text
//! - [`entries`]: everything that can be found: commands, planets, bookmarks, parameters; and the search in it
//! - [`place`]: a location in words and numbers, with an altitude

pub mod entries;
pub mod fuzzy;
pub mod place;
