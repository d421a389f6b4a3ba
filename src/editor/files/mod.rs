//! Files and the desktop, apart from the document.
//!
//! - [`dialogs`]: file dialogs that never block the window
//! - [`disk`]: whether a file has changed on disk
//! - [`claim`]: whether another window has a file open
//! - [`crash`]: crash reports
//! - [`library`]: planets and parts that the user keeps
//! - [`recent`]: files that were opened or saved last
//! - [`file_names`]: extensions, names for people, equal files

pub mod claim;
pub mod crash;
pub mod dialogs;
pub mod disk;
pub mod file_names;
pub mod library;
pub mod recent;
