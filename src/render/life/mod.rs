//! Objects that stand on the ground, in the opaque stage.
//!
//! - `canopy`: what of them is seen from afar, in the parameters of biomes (`canopy.wgsl`)
//! - `planting`: what edits make of it (`planting.wgsl`)
//! - `models`: meshes on the GPU
//! - `material`: their materials (`life_material.wgsl`)
//! - `view`: which objects a view draws, at which level of detail
//! - `shadow`: their shadows (`life_shadow.wgsl`), and those of a game's things
//! - `form_view`: pictures of single forms (`form_view.wgsl`)
//! - `pass`: their light (`life_light.wgsl`, compute) and their drawing (`life.wgsl`)

mod canopy;
mod form_view;
mod material;
mod models;
mod pass;
mod planting;
mod shadow;
mod view;

pub(crate) use canopy::{CanopyRows, LAYER_ROWS as CANOPY_LAYER_ROWS, LAYERS as CANOPY_LAYERS, ROWS as CANOPY_ROWS};
pub use form_view::{FormCamera, FormMesh, FormTarget, FormView};
pub(crate) use material::Material;
pub(crate) use models::LifeModels;
pub(crate) use pass::{LifePass, LifeTargets};
pub(crate) use planting::PlantingBuffer;
pub(crate) use shadow::{CASCADES, Cascades, SHADOW_MAPS, ShadowMap};
pub(crate) use view::LifeView;
