//! Tools that change the ground, compiled: one file each.
//!
//! - `raise`, `flatten`, `roughen`, `terrace`: strokes
//! - `smooth`, `thermal`, `hydraulic`: strokes that read the ground around a point
//! - `crater`, `volcano`, `mesa`, `island`, `picture`: stamps
//! - `ridge`, `canyon`, `road`, `wall`, `fault`, `coast`: lines
//!
//! A tool implements [`EditTool`], for its parameters in [`crate::planet::edits`] or for a struct compiled from them;
//! the list below is the only other code here that names it. A formula is written once, over numbers that carry their
//! derivatives. Its values take basic operations, `sqrt` and `libm` alone.

use super::index::Hash;
use super::life::PopulationId;
use super::mask::MaskId;
use super::paint::{CLOUD_ODDS, Paint};
use super::path::Arc;
use super::reading::Reads;
use super::structural::StructurePaint;
use super::widening::Widening;
use crate::planet::edits::PaintMode;
use crate::planet::{GroundEdit, Key, Tool};
use crate::terrain::jet::Jet;
use std::fmt::Debug;
use std::sync;

/// Task of an edit.
#[derive(Clone, Debug)]
pub(super) enum Task {
    /// Change of the ground.
    Ground(sync::Arc<dyn EditTool>),
    /// Paint, which leaves the ground as it is.
    Paint(Paint),
}

/// Lists the tools: `Tool in file`, and paint as `Tool(parameters) => paint`.
macro_rules! tools {
    (
        ground { $($kind:ident in $file:ident,)+ }
        paint { $($paint_kind:ident($params:pat) => $paint:expr,)+ }
    ) => {
        $(mod $file;)+

        impl Task {
            /// Compiles the tool of an edit.
            pub(super) fn new(site: &Site<'_>) -> Self {
                match &site.edit.tool {
                    $(Tool::$kind(params) => Self::Ground(params.compile(site)),)+
                    $(Tool::$paint_kind($params) => Self::Paint($paint),)+
                }
            }
        }
    };
}

tools! {
    ground {
        Raise in raise,
        Flatten in flatten,
        Roughen in roughen,
        Terrace in terrace,
        Smooth in smooth,
        Thermal in thermal,
        Hydraulic in hydraulic,
        Crater in crater,
        Volcano in volcano,
        Mesa in mesa,
        Island in island,
        Picture in picture,
        Ridge in ridge,
        Canyon in canyon,
        Road in road,
        Wall in wall,
        Fault in fault,
        Coast in coast,
    }
    paint {
        Moisture(paint) => Paint::Moisture { value: paint.moisture, sets: paint.mode == PaintMode::Set },
        Temperature(paint) => Paint::Temperature { value_c: paint.temperature_c, sets: paint.mode == PaintMode::Set },
        Biome(paint) => Paint::Biome { key: paint.biome, strength: paint.strength },
        Clouds(paint) => Paint::Clouds { odds: CLOUD_ODDS * paint.amount },
        Uplift(paint) => Paint::Structure(StructurePaint::Uplift, paint.uplift_m),
        Rock(paint) => Paint::Structure(StructurePaint::Rock, paint.hardness),
        Rain(paint) => Paint::Structure(StructurePaint::Rain, paint.rain_mm),
        River(_) => Paint::Course,
        Mask(paint) => Paint::Mask { mask: MaskId::of(&paint.mask), amount: paint.amount },
        Life(paint) => Paint::Life { population: PopulationId::named(&paint.population), density: paint.density },
        Object(object) => Paint::Object {
            population: PopulationId::named(&object.population),
            size: object.size,
            turns_rad: [object.turn_deg, object.random_turn_deg].map(f64::to_radians),
        },
    }
}

impl Task {
    /// The tool that changes the ground. None for paint.
    pub(super) fn tool(&self) -> Option<&dyn EditTool> {
        if let Self::Ground(tool) = self { Some(&**tool) } else { None }
    }

    /// Radii to which it reaches. An object stands at a point.
    pub(super) fn reach(&self) -> f64 {
        match self {
            Self::Ground(tool) => tool.reach(),
            Self::Paint(Paint::Object { .. }) => 1e-6,
            Self::Paint(_) => 1.0,
        }
    }

    /// Adds the tool with all its numbers to a key.
    pub(super) fn hash(&self, hash: &mut Hash) {
        match self {
            Self::Ground(tool) => tool.key().words().into_iter().for_each(|word| hash.add(word)),
            Self::Paint(paint) => paint.hash(hash),
        }
    }
}

/// What every tool implements.
pub(super) trait EditTool: Debug + Send + Sync {
    /// Change of the height in metres at a point within reach; 0 at the reach.
    fn change_m(&self, at: &At) -> Dual;

    /// Change of the bounds of heights in metres. Conservative. `line_m`: least and greatest height of the points.
    fn range(&self, line_m: (f64, f64)) -> Widening;

    /// Key of all that the change depends on: of what it prints for `Debug`.
    fn key(&self) -> Key {
        Key::of(self)
    }

    /// Radii to which it reaches.
    fn reach(&self) -> f64 {
        1.0
    }

    /// Quantity that [`At::read`] gives, for an edit with these arcs.
    fn reads(&self, _site: &Site<'_>, _arcs: &[Arc]) -> Reads {
        Reads::Nothing
    }

    /// Value of a line with two sides by its place: by the angles to the beginning and to the end, in radians, both
    /// infinite on a closed line, and by the radius. None for a tool whose sides are alike.
    fn value_of_sides(&self) -> Option<fn([f64; 2], f64) -> f64> {
        None
    }

    /// Share of the radius on which nothing stands. None where life stays. `core`: share of the radius without fade.
    fn bare(&self, _core: f64) -> Option<f64> {
        None
    }
}

/// Compilation of the parameters of a tool.
trait Compile {
    /// The tool with all that its formula takes.
    fn compile(&self, site: &Site<'_>) -> sync::Arc<dyn EditTool>;
}

impl<T: EditTool + Clone + 'static> Compile for T {
    fn compile(&self, _site: &Site<'_>) -> sync::Arc<dyn EditTool> {
        sync::Arc::new(self.clone())
    }
}

/// An edit and its planet.
pub(super) struct Site<'a> {
    pub(super) edit: &'a GroundEdit,
    pub(super) radius_m: f64,
    /// Sea level; 0 without a sea.
    pub(super) sea_m: f64,
}

impl Site<'_> {
    /// Radius of the edit as an angle.
    pub(super) fn radius_rad(&self) -> f64 {
        self.edit.radius_km * 1000.0 / self.radius_m
    }
}

/// A number with its derivatives by height of the ground, distance, what is read, and strength.
pub(super) type Dual = Jet<f64, 4>;
pub(super) const BY_GROUND: usize = 0;
pub(super) const BY_T: usize = 1;
pub(super) const BY_READ: usize = 2;
pub(super) const BY_STRENGTH: usize = 3;

/// A point within reach of an edit.
#[derive(Clone, Copy, Debug)]
pub(super) struct At {
    /// Height of the ground in metres, as the edits before left it.
    pub(super) ground_m: Dual,
    /// Distance from the line or from the middle, in radii.
    pub(super) t: Dual,
    /// Share of the radius without fade.
    pub(super) core: f64,
    /// Quantity that the tool reads, see [`Reads`].
    pub(super) read: Dual,
    /// 1 on the left side of the line, -1 on the right.
    pub(super) side: f64,
    /// Size of a stamp's copy, as a share of the stamp.
    pub(super) scale: f64,
}

impl At {
    /// Weight of the edit: 1 in its core, 0 at the radius.
    #[inline]
    pub(super) fn weight(&self) -> Dual {
        falloff(self.t, self.core)
    }

    /// Part of the way from the ground to a height in metres.
    #[inline]
    pub(super) fn towards(&self, height_m: Dual, strength: f64) -> Dual {
        (height_m - self.ground_m) * self.weight().times(strength)
    }
}

/// Smooth step from 0 to 1 with two smooth derivatives (Perlin 2002), with its derivative.
#[inline]
pub(super) fn rise_of(u: f64) -> (f64, f64) {
    let u = u.clamp(0.0, 1.0);
    (u * u * u * (u * (u * 6.0 - 15.0) + 10.0), 30.0 * u * u * (u - 1.0) * (u - 1.0))
}

/// Smooth step from 0 to 1, see [`rise_of`].
#[inline]
pub(super) fn rise<const N: usize>(u: Jet<f64, N>) -> Jet<f64, N> {
    let (risen, by_u) = rise_of(u.v);
    u.chain(risen, by_u)
}

/// Fall from 1 within the core to 0 at the radius.
#[inline]
pub(super) fn falloff<const N: usize>(t: Jet<f64, N>, core: f64) -> Jet<f64, N> {
    rise(t.plus(-core).over(1.0 - core)).rest()
}

/// Dome of height 1 and radius 1.
#[inline]
fn dome(t: Dual) -> Dual {
    let left = (t * t).rest().at_least(0.0);
    left * left
}

/// Mix of a dome and a cone, 1 at 0 and 0 at 1.
#[inline]
fn cone(t: Dual, steepness: f64) -> Dual {
    let (dome, left) = (dome(t), t.rest().at_least(0.0));
    dome + (left * left - dome).times(steepness)
}

/// Distance beyond a level floor as a share of the way from its edge to the radius; 0 on the floor.
#[inline]
fn beyond(t: Dual, floor: f64) -> Dual {
    t.plus(-floor).over(1.0 - floor).at_least(0.0)
}
