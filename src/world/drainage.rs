//! The drainage of a whole planet as a solver leaves it: ground, receivers, discharge and lakes of the cells of a cube.

/// Drainage over the cells of a cube (see [`super::cells::Cells`]).
#[derive(Clone, Debug, Default)]
pub(crate) struct Drainage {
    /// Cells along the side of a face.
    pub(crate) side: usize,
    /// Ground of each cell, metres.
    pub(crate) height_m: Vec<f32>,
    /// The cell that each cell drains to; the cell itself where flow ends, in the sea or in an endorheic lake.
    pub(crate) receiver: Vec<u32>,
    /// Water that leaves each cell, cubic metres a second.
    pub(crate) discharge_m3_s: Vec<f32>,
    /// The lake that covers each cell, counted from 1; 0 for none.
    pub(crate) lake: Vec<u32>,
    /// All lakes.
    pub(crate) lakes: Vec<Lake>,
    /// Height of the sea's surface, if there is a sea.
    pub(crate) sea_level_m: Option<f64>,
    /// Radius of the planet.
    pub(crate) radius_km: f64,
    /// Seed of the planet.
    pub(crate) seed: u32,
}

/// A lake.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Lake {
    /// Height of its surface.
    pub(crate) level_m: f64,
    /// The cell over which it spills; none if it is endorheic.
    pub(crate) outlet: Option<u32>,
}
