//! Ground edits: changes of the ground at a place, made by hand. `terrain::edits` evaluates them.
//!
//! - [`GroundEdit`]: one edit: a tool, where it acts, how wide and how soft
//! - `tools`: the tools and their parameters
//! - `points`: the points of an edit on the globe; `images`: its images by symmetry
//! - `list`: the list of edits, cheap to copy
//!
//! Strokes, stamps, splines and paint have one form: a tool along points. A stamp acts around each point alone.

mod images;
mod list;
mod points;
mod tools;

pub use images::MAX_TURNS;
pub use list::GroundEdits;
pub(crate) use list::Shared;
pub use points::{EditPoint, EditPoints};
pub use tools::{
    BiomePaint, Canyon, CloudPaint, Coast, Crater, Fault, Flatten, Hydraulic, Island, LifePaint, MaskPaint, Mesa,
    MoisturePaint, PaintMode, PictureStamp, PlacedObject, RainPaint, Raise, Ridge, RiverCourse, Road, RockPaint,
    Roughen, Smooth, TemperaturePaint, Terrace, Thermal, Tool, UpliftPaint, Volcano, Wall,
};

use super::param::{Domain, ParamPath, Segment, Stage, Unit, choice, count, linear, log, params};

/// Most edits a planet may have.
pub const MAX_EDITS: usize = 20_000;
/// Most points of all edits of a planet: its file can be read again, see `MAX_FILE_BYTES`.
pub const MAX_ALL_POINTS: usize = 500_000;
/// Most points of all edits with copies of stamps and images by symmetry: each takes memory of its own.
pub const MAX_ALL_PLACES: usize = 1_000_000;
/// Height limits of edits go so far, either way.
pub const MOST_LIMIT_M: f64 = 20_000.0;
/// Least and greatest width of an edit at a point, as shares of its radius.
pub const LEAST_WIDTH: f64 = 0.02;
/// See [`LEAST_WIDTH`].
pub const MOST_WIDTH: f64 = 4.0;
/// Most points of one edit.
pub const MAX_EDIT_POINTS: usize = 1000;
/// Greatest length of the courses of all rivers, in radii of the planet.
pub const MOST_COURSES_RADII: f64 = 500.0;
/// Most copies of a stamp around one of its points, and around all of them.
pub const MAX_COPIES: u32 = 1000;
/// See [`MAX_COPIES`].
pub const MAX_ALL_COPIES: usize = 4000;

params! {
    /// A change of the ground at a place: a stroke, a stamp or a spline. Edits act in order, after all layers and the
    /// height curve and before biome relief.
    pub struct GroundEdit {
        /// Name of the edit.
        name: String = "Edit".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 48 }, Stage::Label;
        /// Whether the edit changes the ground.
        enabled: bool = true, "Enabled", Unit::None, Domain::Flag, Stage::Height;
        /// Which ground it changes: all, or only land or sea floor. At the sea level it begins gently. Paint ignores
        /// it.
        limit: Limit = Limit::Everywhere, "Acts on", Unit::None, Domain::Choice, Stage::Height;
        /// Whether it may raise ground and lower it: a road that raises only is a dam, one that lowers only a cutting.
        /// Paint ignores it.
        blend: EditBlend = EditBlend::Both, "Blend", Unit::None, Domain::Choice, Stage::Height;
        /// It changes only ground above this height, and begins gently there; at the lowest value, all ground.
        above_m: f64 = -MOST_LIMIT_M, "Only above", Unit::Metres, linear(-MOST_LIMIT_M, MOST_LIMIT_M), Stage::Height;
        /// It changes only ground below this height; at the greatest value, all ground.
        below_m: f64 = MOST_LIMIT_M, "Only below", Unit::Metres, linear(-MOST_LIMIT_M, MOST_LIMIT_M), Stage::Height;
        /// Painted mask that limits it, by its name; empty for none. It acts as far as the mask is painted; of several
        /// copies of a stamp the mask decides where they lie. Rivers and the mask tool ignore it.
        mask: String = String::new(), "Mask", Unit::None, Domain::MaskName { max_chars: 48 }, Stage::Height;
        /// Whether it acts where the mask is not painted.
        outside_mask: bool = false, "Outside the mask", Unit::None, Domain::Flag, Stage::Height;
        /// Distance from its line, or from the middle of a stamp, to where it ends; for a crater, to the rim; for a
        /// river, how far it may stray from its line.
        radius_km: f64 = 50.0, "Radius", Unit::Kilometres, log(0.001, 5000.0), Stage::Height;
        /// Share of the radius over which it fades: 0 is a cliff, 1 fades from the middle on.
        softness: f64 = 0.8, "Softness", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// How ragged its outline is, or how far a river strays: 0 is smooth.
        raggedness: f64 = 0.0, "Raggedness", Unit::None, linear(0.0, 1.0), Stage::Height;
        /// Seed of its outline and roughness.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Height;
        /// Symmetry: how many times the edit is there, turned by equal angles around the axis of the planet.
        turns: u32 = 1, "Turns", Unit::None, count(1, MAX_TURNS), Stage::Height;
        /// Symmetry: whether the edit is also there on the other side of the equator, as in a mirror.
        mirrored: bool = false, "Mirrored", Unit::None, Domain::Flag, Stage::Height;
        /// Of a stamp: how many copies are scattered around each of its points.
        copies: u32 = 1, "Copies", Unit::None, count(1, MAX_COPIES), Stage::Height;
        /// Of a stamp: distance from each point within which its copies lie.
        spread_km: f64 = 0.0, "Spread", Unit::Kilometres, log(0.0, 20_000.0), Stage::Height;
        /// Of a stamp: size of the smallest copy, as a share of the radius and of all heights. Small ones are many, as
        /// craters are: half the size, four times the number.
        smallest: f64 = 0.3, "Smallest", Unit::None, linear(0.05, 1.0), Stage::Height;
    } with {
        /// Tool: what it does to the ground.
        tool: Tool = Tool::default();
        /// Points that it goes through or stands at: (latitude, longitude), then for a road the height in metres, then
        /// for lines that taper the width (share of the radius) and the strength (share of the effect) there.
        points: EditPoints = EditPoints::default();
    }
}

impl GroundEdit {
    /// The name of the painted mask that limits it. None if none does.
    pub fn limiting_mask(&self) -> Option<&str> {
        (self.tool.reads_mask() && !self.mask.is_empty()).then_some(&*self.mask)
    }

    /// Whether a painted mask decides where its copies lie.
    pub fn is_scattered(&self) -> bool {
        self.tool.is_stamp() && self.copies > 1 && self.limiting_mask().is_some()
    }

    /// A new edit with this tool. The outlines of land and of clouds are ragged, and rivers wind.
    pub fn of(tool: Tool) -> Self {
        let raggedness = match tool {
            Tool::Island(_) | Tool::Clouds(_) => 0.5,
            Tool::Mesa(_) => 0.3,
            Tool::Volcano(_) => 0.15,
            Tool::Uplift(_) | Tool::River(_) => 0.6,
            _ => 0.0,
        };
        Self { tool, raggedness, ..Self::default() }
    }
}

choice! {
    /// The ground that an edit changes.
    pub enum Limit {
        /// All ground.
        Everywhere = "All ground",
        /// Ground above the sea.
        AboveSea = "Land only",
        /// Ground below the sea.
        BelowSea = "Sea floor only",
    }
}

choice! {
    /// Which way an edit changes the ground.
    pub enum EditBlend {
        /// Up and down.
        Both = "Raise and lower",
        /// Up alone: of the new ground and the old, the higher.
        Raise = "Raise only",
        /// Down alone: of the new ground and the old, the lower.
        Lower = "Lower only",
    }
}

/// The path of an edit.
pub fn edit_path(index: usize) -> ParamPath {
    ParamPath::from(vec![Segment::Field("edits"), Segment::Index(index)])
}
