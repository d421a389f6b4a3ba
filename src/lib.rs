//! Tellus: whole planets from one small file.

pub mod build;
pub mod lod;
pub mod planet;
pub mod sphere;
pub mod terrain;

#[cfg(feature = "render")]
pub mod render;

#[cfg(feature = "editor")]
pub mod cli;
#[cfg(feature = "editor")]
pub mod editor;
