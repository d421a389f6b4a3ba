//! Tests of the command line, run as a process, and of the README's promises.
//!
//! - `commands`: answers, messages, exit status
//! - `hostile`: broken and oversized files
//! - `readme`: the README's examples, presets and pictures
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod commands;
#[cfg(unix)]
mod hostile;
mod readme;
