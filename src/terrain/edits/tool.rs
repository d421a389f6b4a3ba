//! What each tool does to a height. `t` is the distance from the line or the middle in radii; formulas give 0 at the
//! reach of the tool and beyond.

use super::index::Hash;
use super::life::PopulationId;
use super::mask::MaskId;
use super::outline;
use super::paint::Paint;
use super::structural::StructurePaint;
use super::widening::Widening;
use crate::planet::edits::{
    BiomePaint, Canyon, CloudPaint, Coast, Crater, Fault, Flatten, Hydraulic, Island, LifePaint, MaskPaint, Mesa,
    MoisturePaint, PaintMode, PictureStamp, PlacedObject, RainPaint, Raise, Ridge, Road, RockPaint, Roughen, Smooth,
    TemperaturePaint, Terrace, Thermal, UpliftPaint, Volcano, Wall,
};
use crate::planet::picture::PictureExtent;
use crate::planet::{GroundEdit, Tool};

/// Radii to which the ejecta of a crater reach.
const EJECTA: f64 = 2.0;
/// Share of a mesa's flank that is cliff.
const CLIFF: f64 = 0.25;
/// Radius of a central peak, in radii of the crater.
const PEAK: f64 = 0.3;
/// Where the shore of an island begins to blend into the sea floor.
const SHORE: f64 = 0.75;
/// Share of an island's height over which its foot blends into the sea floor.
const FOOT: f64 = 0.05;

/// Log-odds by which a full stroke changes the cover of clouds: all but overcast from a sky that is all but clear.
const CLOUD_ODDS: f64 = 10.0;

/// A point under an edit.
#[derive(Clone, Copy, Debug)]
pub(super) struct At {
    pub(super) ground_m: f64,
    pub(super) t: f64,
    /// Share of the radius without fade.
    pub(super) core: f64,
    /// Noise of rough ground.
    pub(super) noise: f64,
    /// Height of the line of a road, or of smooth ground; the slip of a fault, the share of a coast; of a picture, the
    /// value over its level; the height that gullies add.
    pub(super) line: f64,
    /// 1 on the left side of the line, -1 on the right.
    pub(super) side: f64,
    /// Size of a stamp's copy.
    pub(super) scale: f64,
}

/// The change of a height, with its derivatives.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Change {
    pub(super) change_m: f64,
    pub(super) by_ground: f64,
    pub(super) by_t: f64,
    pub(super) by_noise: f64,
    pub(super) by_line: f64,
    /// By the share of the effect at a point of the line.
    pub(super) by_strength: f64,
}

impl Change {
    /// A share of the change.
    pub(super) fn times(self, strength: f64) -> Self {
        Self {
            change_m: self.change_m * strength,
            by_ground: self.by_ground * strength,
            by_t: self.by_t * strength,
            by_noise: self.by_noise * strength,
            by_line: self.by_line * strength,
            by_strength: self.change_m,
        }
    }
}

/// A tool, compiled.
#[derive(Clone, Copy, Debug)]
pub(super) enum CompiledTool {
    Raise {
        amount_m: f64,
    },
    Flatten {
        height_m: f64,
        strength: f64,
    },
    Roughen {
        amplitude_m: f64,
    },
    Terrace {
        step_m: f64,
        riser: f64,
        strength: f64,
    },
    Crater {
        depth_m: f64,
        rim_m: f64,
        floor: f64,
        peak_m: f64,
    },
    Volcano {
        height_m: f64,
        steepness: f64,
        caldera: f64,
        caldera_m: f64,
    },
    Mesa {
        height_m: f64,
        talus: f64,
    },
    Island {
        sea_m: f64,
        height_m: f64,
        foot_m: f64,
    },
    Picture {
        height_m: f64,
        /// Least and greatest value over the level.
        range: (f64, f64),
    },
    Ridge {
        height_m: f64,
        softness: f64,
    },
    Canyon {
        depth_m: f64,
        floor: f64,
        softness: f64,
    },
    Road {
        strength: f64,
    },
    Smooth {
        strength: f64,
    },
    Hydraulic {
        depth_m: f64,
    },
    Thermal {
        /// Height by which forms may stand out.
        most_m: f64,
        strength: f64,
    },
    Wall {
        height_m: f64,
        top: f64,
    },
    Fault {
        throw_m: f64,
        scarp: f64,
        drop: f64,
    },
    Coast {
        sea_m: f64,
        land_m: f64,
        depth_m: f64,
        flip: bool,
    },
    /// Paint leaves the ground as it is.
    Paint(Paint),
}

/// A rise from 0 to 1 with two smooth derivatives (Perlin 2002), and its derivative.
pub(super) fn rise(u: f64) -> (f64, f64) {
    let u = u.clamp(0.0, 1.0);
    (u * u * u * (u * (u * 6.0 - 15.0) + 10.0), 30.0 * u * u * (u - 1.0) * (u - 1.0))
}

/// From 1 within the core to 0 at the radius, and its derivative by `t`.
pub(super) fn falloff(t: f64, core: f64) -> (f64, f64) {
    let width = 1.0 - core;
    let (risen, by_u) = rise((t - core) / width);
    (1.0 - risen, -by_u / width)
}

/// A mix of a dome and a cone, 1 at 0 and 0 at 1, and its derivative.
fn cone(t: f64, steepness: f64) -> (f64, f64) {
    let (dome, dome_by_t) = dome(t);
    let left = (1.0 - t).max(0.0);
    (dome + (left * left - dome) * steepness, dome_by_t + (-2.0 * left - dome_by_t) * steepness)
}

fn dome(t: f64) -> (f64, f64) {
    let left = (1.0 - t * t).max(0.0);
    (left * left, -4.0 * t * left)
}

impl CompiledTool {
    /// `depth_m`: the greatest depth of the gullies of an edit that has some.
    pub(super) fn new(edit: &GroundEdit, sea_m: f64, depth_m: f64) -> Self {
        match edit.tool {
            Tool::Picture(PictureStamp { ref file, height_m, level, .. }) => {
                let (lo, hi) = file.picture(PictureExtent::Place).map_or((level, level), |picture| picture.bounds());
                // The weights of a spline sum to 1 up to rounding.
                let rounding = 1e-9 * (1.0 + lo.abs().max(hi.abs()));
                Self::Picture { height_m, range: ((lo - level).min(0.0) - rounding, (hi - level).max(0.0) + rounding) }
            }
            Tool::Raise(Raise { amount_m }) => Self::Raise { amount_m },
            Tool::Flatten(Flatten { height_m, strength }) => Self::Flatten { height_m, strength },
            Tool::Roughen(Roughen { amplitude_m, .. }) => Self::Roughen { amplitude_m },
            Tool::Terrace(Terrace { step_m, sharpness, strength }) => {
                Self::Terrace { step_m, riser: 1.0 - 0.9 * sharpness, strength }
            }
            Tool::Crater(Crater { depth_m, rim_m, floor, peak_m }) => Self::Crater { depth_m, rim_m, floor, peak_m },
            Tool::Volcano(Volcano { height_m, steepness, caldera, caldera_m }) => {
                Self::Volcano { height_m, steepness, caldera, caldera_m }
            }
            Tool::Mesa(Mesa { height_m, talus }) => Self::Mesa { height_m, talus },
            Tool::Island(Island { height_m, foot_m }) => Self::Island { sea_m, height_m, foot_m },
            Tool::Ridge(Ridge { height_m }) => Self::Ridge { height_m, softness: edit.softness },
            Tool::Canyon(Canyon { depth_m, floor }) => Self::Canyon { depth_m, floor, softness: edit.softness },
            Tool::Road(Road { strength }) => Self::Road { strength },
            Tool::Smooth(Smooth { strength, .. }) => Self::Smooth { strength },
            Tool::Hydraulic(Hydraulic { .. }) => Self::Hydraulic { depth_m },
            Tool::Thermal(Thermal { size, talus_deg, strength }) => {
                let half_m = 0.5 * size * edit.radius_km * 1000.0;
                Self::Thermal { most_m: half_m * libm::tan(talus_deg.to_radians()), strength }
            }
            Tool::Wall(Wall { height_m, top }) => Self::Wall { height_m, top },
            Tool::Fault(Fault { throw_m, scarp, drop }) => Self::Fault { throw_m, scarp, drop },
            Tool::Coast(Coast { land_m, depth_m, flip }) => Self::Coast { sea_m, land_m, depth_m, flip },
            Tool::Moisture(MoisturePaint { mode, moisture }) => {
                Self::Paint(Paint::Moisture { value: moisture, sets: mode == PaintMode::Set })
            }
            Tool::Temperature(TemperaturePaint { mode, temperature_c }) => {
                Self::Paint(Paint::Temperature { value_c: temperature_c, sets: mode == PaintMode::Set })
            }
            Tool::Biome(BiomePaint { biome, strength }) => Self::Paint(Paint::Biome { key: biome, strength }),
            Tool::Uplift(UpliftPaint { uplift_m }) => {
                Self::Paint(Paint::Structure(StructurePaint::Uplift { uplift_m }))
            }
            Tool::Rock(RockPaint { hardness }) => Self::Paint(Paint::Structure(StructurePaint::Rock { hardness })),
            Tool::Rain(RainPaint { rain_mm }) => Self::Paint(Paint::Structure(StructurePaint::Rain { rain_mm })),
            Tool::River(_) => Self::Paint(Paint::Course),
            Tool::Mask(MaskPaint { ref mask, amount }) => Self::Paint(Paint::Mask { mask: MaskId::of(mask), amount }),
            Tool::Life(LifePaint { ref population, density }) => {
                let population = (!population.is_empty()).then(|| PopulationId::of(population));
                Self::Paint(Paint::Life { population, density })
            }
            Tool::Object(PlacedObject { ref population, size, turn_deg, random_turn_deg }) => {
                let population = (!population.is_empty()).then(|| PopulationId::of(population));
                let turns_rad = [turn_deg, random_turn_deg].map(f64::to_radians);
                Self::Paint(Paint::Object { population, size, turns_rad })
            }
            Tool::Clouds(CloudPaint { amount }) => Self::Paint(Paint::Clouds { odds: CLOUD_ODDS * amount }),
        }
    }

    /// Radii to which it reaches.
    pub(super) fn reach(&self) -> f64 {
        match self {
            Self::Crater { .. } => EJECTA,
            // An object stands at a point.
            Self::Paint(Paint::Object { .. }) => 1e-6,
            _ => 1.0,
        }
    }

    pub(super) fn hash(&self, hash: &mut Hash) {
        let (kind, numbers) = match *self {
            Self::Raise { amount_m } => (0, [amount_m, 0.0, 0.0, 0.0]),
            Self::Flatten { height_m, strength } => (1, [height_m, strength, 0.0, 0.0]),
            Self::Roughen { amplitude_m } => (2, [amplitude_m, 0.0, 0.0, 0.0]),
            Self::Terrace { step_m, riser, strength } => (3, [step_m, riser, strength, 0.0]),
            Self::Crater { depth_m, rim_m, floor, peak_m } => (4, [depth_m, rim_m, floor, peak_m]),
            Self::Volcano { height_m, steepness, caldera, caldera_m } => (5, [height_m, steepness, caldera, caldera_m]),
            Self::Mesa { height_m, talus } => (6, [height_m, talus, 0.0, 0.0]),
            Self::Island { sea_m, height_m, foot_m } => (7, [sea_m, height_m, foot_m, 0.0]),
            Self::Ridge { height_m, softness } => (8, [height_m, softness, 0.0, 0.0]),
            Self::Canyon { depth_m, floor, softness } => (9, [depth_m, floor, softness, 0.0]),
            Self::Road { strength } => (10, [strength, 0.0, 0.0, 0.0]),
            Self::Smooth { strength } => (11, [strength, 0.0, 0.0, 0.0]),
            Self::Wall { height_m, top } => (12, [height_m, top, 0.0, 0.0]),
            Self::Fault { throw_m, scarp, drop } => (13, [throw_m, scarp, drop, 0.0]),
            Self::Coast { sea_m, land_m, depth_m, flip } => (14, [sea_m, land_m, depth_m, f64::from(u8::from(flip))]),
            Self::Hydraulic { depth_m } => (16, [depth_m, 0.0, 0.0, 0.0]),
            Self::Thermal { most_m, strength } => (17, [most_m, strength, 0.0, 0.0]),
            // The pixels are added by the edit.
            Self::Picture { height_m, range: (lo, hi) } => (15, [height_m, lo, hi, 0.0]),
            Self::Paint(Paint::Moisture { value, sets }) => (20, [value, f64::from(u8::from(sets)), 0.0, 0.0]),
            Self::Paint(Paint::Temperature { value_c, sets }) => (21, [value_c, f64::from(u8::from(sets)), 0.0, 0.0]),
            Self::Paint(Paint::Biome { key, strength }) => (22, [strength, f64::from(u32::from(key)), 0.0, 0.0]),
            Self::Paint(Paint::Clouds { odds }) => (23, [odds, 0.0, 0.0, 0.0]),
            Self::Paint(Paint::Structure(StructurePaint::Uplift { uplift_m })) => (24, [uplift_m, 0.0, 0.0, 0.0]),
            Self::Paint(Paint::Structure(StructurePaint::Rock { hardness })) => (25, [hardness, 0.0, 0.0, 0.0]),
            Self::Paint(Paint::Structure(StructurePaint::Rain { rain_mm })) => (26, [rain_mm, 0.0, 0.0, 0.0]),
            Self::Paint(Paint::Course) => (27, [0.0; 4]),
            Self::Paint(Paint::Mask { mask, amount }) => {
                let [high, low] = mask.words();
                hash.add(high);
                hash.add(low);
                (28, [amount, 0.0, 0.0, 0.0])
            }
            Self::Paint(Paint::Life { population, density }) => {
                population.iter().flat_map(|population| population.words()).for_each(|word| hash.add(word));
                (29, [density, 0.0, 0.0, 0.0])
            }
            Self::Paint(Paint::Object { population, size, turns_rad: [turn_rad, random_rad] }) => {
                population.iter().flat_map(|population| population.words()).for_each(|word| hash.add(word));
                (30, [size, turn_rad, random_rad, 0.0])
            }
        };
        hash.add(kind);
        numbers.into_iter().for_each(|number| hash.add_f64(number));
    }

    /// The change of the height at a point within reach.
    pub(super) fn change(&self, at: &At) -> Change {
        let t = at.t;
        let (weight, weight_by_t) = falloff(t, at.core);
        let added = |(height_m, by_t): (f64, f64)| Change {
            change_m: height_m * at.scale,
            by_t: by_t * at.scale,
            ..Change::default()
        };
        // A share of the way to a height.
        let towards = |height_m: f64, strength: f64| Change {
            change_m: (height_m - at.ground_m) * (strength * weight),
            by_ground: -strength * weight,
            by_t: (height_m - at.ground_m) * strength * weight_by_t,
            ..Change::default()
        };
        match *self {
            Self::Raise { amount_m } => added((amount_m * weight, amount_m * weight_by_t)),
            Self::Flatten { height_m, strength } => towards(height_m, strength),
            Self::Roughen { amplitude_m } => Change {
                change_m: amplitude_m * at.noise * weight,
                by_t: amplitude_m * at.noise * weight_by_t,
                by_noise: amplitude_m * weight,
                ..Change::default()
            },
            Self::Terrace { step_m, riser, strength } => {
                let place = at.ground_m / step_m;
                let whole = place.floor();
                let (risen, by_u) = rise((place - whole - 0.5) / riser + 0.5);
                let change = towards((whole + risen) * step_m, strength);
                Change { by_ground: strength * weight * (by_u / riser - 1.0), ..change }
            }
            Self::Crater { depth_m, rim_m, floor, peak_m } => {
                if t >= 1.0 {
                    let left = (EJECTA - t).max(0.0);
                    return added((rim_m * left * left * left, -3.0 * rim_m * left * left));
                }
                let v = ((t - floor) / (1.0 - floor)).max(0.0);
                let (peak, peak_by_u) = rise(t / PEAK);
                added((
                    (depth_m + rim_m) * v * v - depth_m + peak_m * (1.0 - peak),
                    2.0 * (depth_m + rim_m) * v / (1.0 - floor) - peak_m * peak_by_u / PEAK,
                ))
            }
            Self::Volcano { height_m, steepness, caldera, caldera_m } => {
                if t >= caldera {
                    let (cone, by_t) = cone(t, steepness);
                    return added((height_m * cone, height_m * by_t));
                }
                let (edge, _) = cone(caldera, steepness);
                let (dome, by_u) = dome(t / caldera);
                added((height_m * edge - caldera_m * dome, -caldera_m * by_u / caldera))
            }
            Self::Mesa { height_m, talus } => {
                let width = 1.0 - at.core;
                let v = ((t - at.core) / width).max(0.0);
                let ((fallen, by_u), left) = (rise(v / CLIFF), (1.0 - v).max(0.0));
                let slope = -(1.0 - talus) * by_u / CLIFF - if v > 0.0 { 2.0 * talus * left } else { 0.0 };
                added((height_m * ((1.0 - talus) * (1.0 - fallen) + talus * left * left), height_m * slope / width))
            }
            Self::Island { sea_m, height_m, foot_m } => {
                let (top_m, foot_m) = (sea_m + height_m * at.scale, sea_m - foot_m * at.scale);
                let (dome, dome_by_t) = dome(t);
                let size_m = top_m - foot_m;
                let over_m = foot_m + size_m * dome - at.ground_m;
                let soft_m = FOOT * size_m;
                // The greater of the two grounds, with a rounded corner.
                let (rise_m, by_over) = if over_m >= soft_m {
                    (over_m, 1.0)
                } else if over_m > -soft_m {
                    let sum_m = over_m + soft_m;
                    (sum_m * sum_m / (4.0 * soft_m), sum_m / (2.0 * soft_m))
                } else {
                    (0.0, 0.0)
                };
                let (share, share_by_t) = falloff(t, SHORE);
                Change {
                    change_m: rise_m * share,
                    by_ground: -by_over * share,
                    by_t: by_over * size_m * dome_by_t * share + rise_m * share_by_t,
                    ..Change::default()
                }
            }
            Self::Picture { height_m, .. } => {
                let change = added((height_m * at.line * weight, height_m * at.line * weight_by_t));
                Change { by_line: height_m * weight * at.scale, ..change }
            }
            Self::Ridge { height_m, softness } => {
                let (crest, by_t) = cone(t, 1.0 - softness);
                added((height_m * crest, height_m * by_t))
            }
            Self::Canyon { depth_m, floor, softness } => {
                let v = ((t - floor) / (1.0 - floor)).max(0.0);
                let (risen, by_u) = rise(v);
                let wall = softness * risen + (1.0 - softness) * v * v;
                let by_v = softness * by_u + (1.0 - softness) * 2.0 * v;
                added((depth_m * (wall - 1.0), depth_m * by_v / (1.0 - floor)))
            }
            Self::Road { strength } | Self::Smooth { strength } => {
                Change { by_line: strength * weight, ..towards(at.line, strength) }
            }
            Self::Hydraulic { .. } => {
                let change = added((at.line * weight, at.line * weight_by_t));
                Change { by_line: weight, ..change }
            }
            Self::Thermal { most_m, strength } => {
                let over_m = at.ground_m - at.line;
                let left = libm::tanh(over_m / most_m);
                let change = towards(at.line + most_m * left, strength);
                // What stands out by far follows smooth ground alone.
                let by_line = left * left * strength * weight;
                Change { by_ground: -by_line, by_line, ..change }
            }
            Self::Wall { height_m, top } => {
                let (fallen, by_t) = falloff(t, top);
                added((height_m * fallen, height_m * by_t))
            }
            Self::Fault { throw_m, scarp, drop } => {
                let left = (1.0 - t).max(0.0);
                let (risen, by_u) = rise(at.side * t / scarp + 0.5);
                let (height_m, fade) = (throw_m * at.line, left * left);
                Change {
                    change_m: height_m * (risen - drop) * fade,
                    by_t: height_m * (by_u / scarp * at.side * fade - 2.0 * (risen - drop) * left),
                    by_line: throw_m * (risen - drop) * fade,
                    ..Change::default()
                }
            }
            Self::Coast { sea_m, land_m, depth_m, flip } => {
                let left = (1.0 - t).max(0.0);
                let size_m = if (at.side > 0.0) != flip { land_m } else { -depth_m };
                let shore_m = sea_m + size_m * (1.0 - left * left);
                let over_m = shore_m - at.ground_m;
                Change {
                    change_m: over_m * weight * at.line,
                    by_ground: -weight * at.line,
                    by_t: (2.0 * size_m * left * weight + over_m * weight_by_t) * at.line,
                    by_line: over_m * weight,
                    ..Change::default()
                }
            }
            Self::Paint(_) => Change::default(),
        }
    }

    /// What the tool does to the bounds of heights. `line_m`: lowest and greatest height of a road.
    pub(super) fn range(&self, line_m: (f64, f64)) -> Widening {
        match *self {
            Self::Raise { amount_m } => Widening::by(-amount_m.min(0.0), amount_m.max(0.0)),
            Self::Flatten { height_m, .. } => Widening::to(height_m, height_m),
            Self::Roughen { amplitude_m } => Widening::by(amplitude_m * outline::MOST, amplitude_m * outline::MOST),
            Self::Terrace { step_m, .. } => Widening::by(step_m, step_m),
            Self::Crater { depth_m, rim_m, peak_m, .. } => Widening::by(depth_m, rim_m + peak_m),
            Self::Volcano { height_m, caldera_m, .. } => Widening::by(caldera_m, height_m),
            Self::Mesa { height_m, .. } | Self::Ridge { height_m, .. } | Self::Wall { height_m, .. } => {
                Widening::by(0.0, height_m)
            }
            Self::Picture { height_m, range: (lo, hi) } => {
                let (a, b) = (height_m * lo, height_m * hi);
                Widening::by(-a.min(b), a.max(b))
            }
            Self::Island { sea_m, height_m, foot_m } => {
                Widening::to(f64::INFINITY, sea_m + height_m).then(Widening::by(0.0, FOOT * (height_m + foot_m)))
            }
            Self::Canyon { depth_m, .. } => Widening::by(depth_m, 0.0),
            // Crests that are not clear rise by an eighth at most.
            Self::Hydraulic { depth_m } => Widening::by(depth_m, 0.125 * depth_m),
            Self::Road { .. } => Widening::to(line_m.0, line_m.1),
            Self::Fault { throw_m, .. } => Widening::by(throw_m.abs(), throw_m.abs()),
            Self::Coast { sea_m, land_m, depth_m, .. } => Widening::to(sea_m - depth_m, sea_m + land_m),
            // Smooth ground is a mean of the ground around; its bounds are those of a larger place.
            Self::Smooth { .. } | Self::Thermal { .. } | Self::Paint(_) => Widening::default(),
        }
    }
}
