//! Ground edits baked into a height picture: hundreds of strokes become one stamp.
//!
//! A pixel holds the height that the edits add there, in the projection of a picture stamp (Lambert's equal-area one).
//! Pictures are sampled as cubic B-splines, so the pixels are the coefficients of the spline that goes through those
//! heights, found by a recursive filter along rows and columns (Unser, Aldroubi and Eden 1993).

use super::BakeError;
use super::format::{Format, Shape, Source, Steps};
use super::maps::Map;
use super::openexr;
use crate::planet::edits::{EditPoint, GroundEdits, PictureStamp, edit_path};
use crate::planet::file::write_atomically_with;
use crate::planet::{GroundEdit, Planet, Tool};
use crate::sphere::geo::east_north;
use crate::terrain::{MapStore, Terrain};
use glam::DVec3;
use rayon::prelude::*;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// Pixels from the middle of the narrowest edit to its end.
const PIXELS_PER_RADIUS: f64 = 24.0;
/// Pixels along a side.
const SIDES: (u32, u32) = (128, 4096);
/// Greatest reach of edits that fit one picture, as an angle and in kilometres.
const MOST_RAD: f64 = 1.2;
const MOST_KM: f64 = 4850.0;
/// The edits end within this share of the ring: a stamp fades at its edge, however hard it is.
const WITHIN: f64 = 0.97;
/// Rows that are evaluated at a time.
const ROWS: usize = 16;
/// Points along a side at which the picture is compared with the edits.
const COMPARED: u32 = 160;
/// The pole of the filter that turns values into coefficients of cubic B-splines, and its gain.
const POLE: f64 = -0.267_949_192_431_122_7;
const GAIN: f64 = 6.0;

/// Ground edits that are to be baked.
#[derive(Clone, Debug)]
pub struct EditBake {
    /// The planet, with all edits of the ground after the last that is baked off.
    with: Arc<Planet>,
    /// The same without the edits that are baked.
    without: Arc<Planet>,
    /// Those edits alone, with the strokes of the mask tool.
    alone: Arc<Terrain>,
    /// The indices of those edits, in order.
    chosen: Vec<usize>,
    place: Place,
}

/// Where the picture lies.
#[derive(Clone, Copy, Debug)]
struct Place {
    middle: DVec3,
    /// Radius of the ring of its stamp.
    radius_rad: f64,
    side_px: u32,
}

/// The picture that edits became.
#[derive(Clone, Debug)]
pub struct BakedEdits {
    /// Coefficients of the spline, row by row from the top; the greatest height is 1.
    values: Vec<f32>,
    side_px: u32,
    /// The stamp without its file.
    stamp: GroundEdit,
    chosen: Vec<usize>,
}

/// How far the ground of a picture is from that of its edits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Deviation {
    /// The greatest difference found, metres.
    pub greatest_m: f64,
    /// The root of the mean square, metres, over the ground that the edits reach.
    pub rms_m: f64,
}

impl EditBake {
    /// A bake of some edits of a planet, given by their indices. Paint, edits of a structure and those that are off
    /// stay as they are. The planet is valid.
    ///
    /// # Errors
    ///
    /// If none of them changes the ground, or if they reach too far for one picture.
    pub fn new(planet: &Arc<Planet>, chosen: impl IntoIterator<Item = usize>) -> Result<Self, BakeError> {
        let asked = |why: String| BakeError::Asked(why);
        let bakes = |index: &usize| planet.edits.get(*index).is_some_and(Self::can_bake);
        let mut chosen: Vec<usize> = chosen.into_iter().filter(bakes).collect();
        chosen.sort_unstable();
        chosen.dedup();
        let Some(&last) = chosen.last() else {
            return Err(asked("none of these edits is on and changes the ground: there is nothing to bake".to_owned()));
        };
        let edits = chosen.iter().filter_map(|index| planet.edits.get(*index));
        let narrowest_km = edits.clone().map(narrowest_km).fold(f64::MAX, f64::min);
        // The mask tool decides where copies lie.
        let strokes = planet.edits.iter().filter(|edit| edit.enabled && matches!(edit.tool, Tool::Mask(_)));
        let own: GroundEdits = edits.chain(strokes).cloned().collect();
        let alone = Planet { layers: Vec::new(), structure: None, edits: own, ..Planet::clone(planet) };
        let alone = Terrain::try_new(Arc::new(alone)).map_err(|error| asked(error.to_string()))?;
        let Some((middle, reach_rad)) = alone.edited_disc() else {
            return Err(asked("these edits change nothing: there is nothing to bake".to_owned()));
        };
        let most_rad = MOST_RAD.min(MOST_KM / planet.radius_km);
        if reach_rad > most_rad {
            let [reach_km, most_km] = [reach_rad, most_rad].map(|angle| (2.0 * angle * planet.radius_km).round());
            return Err(asked(format!(
                "the edits lie {reach_km} km apart, and one picture covers at most {most_km} km; find a part of them in \
                 the list, and bake that"
            )));
        }
        let radius_rad = reach_rad / WITHIN;
        let pixels = 2.0 * radius_rad * planet.radius_km / narrowest_km * PIXELS_PER_RADIUS;
        let side_px = pixels.clamp(f64::from(SIDES.0), f64::from(SIDES.1)).ceil() as u32;
        let ground = |keeps: &dyn Fn(usize) -> bool| {
            // The height that biomes add follows the ground, whatever made it.
            let mut ground = Planet::clone(planet);
            ground.biomes.palette.iter_mut().for_each(|biome| biome.relief_m = 0.0);
            for index in 0..ground.edits.len() {
                let changes = ground.edits.get(index).is_some_and(|edit| edit.enabled && !edit.tool.is_paint());
                if changes
                    && !keeps(index)
                    && let Some(edit) = ground.edits.get_mut(index)
                {
                    edit.enabled = false;
                }
            }
            Arc::new(ground)
        };
        let (with, without) =
            (ground(&|index| index <= last), ground(&|index| index <= last && chosen.binary_search(&index).is_err()));
        let place = Place { middle, radius_rad, side_px };
        Ok(Self { with, without, alone: Arc::new(alone), chosen, place })
    }

    /// Whether an edit can be baked: it is on, and it changes the ground.
    pub fn can_bake(edit: &GroundEdit) -> bool {
        edit.enabled && !edit.tool.is_paint() && !edit.points.0.is_empty()
    }

    /// How many edits are baked.
    pub fn count(&self) -> usize {
        self.chosen.len()
    }

    /// Pixels along a side of the picture.
    pub fn side_px(&self) -> u32 {
        self.place.side_px
    }

    /// Size of a pixel on the ground, metres.
    pub fn pixel_m(&self) -> f64 {
        self.place.pixel_rad() * self.with.radius_m()
    }

    /// Evaluates the edits. `go_on` is told the share that is done, and answers whether to go on: None if not.
    ///
    /// # Errors
    ///
    /// If the planet is not valid, or if the edits change no height.
    pub fn run(
        &self,
        store: Option<&Arc<MapStore>>,
        go_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Option<BakedEdits>, BakeError> {
        let load = |planet: &Arc<Planet>| Terrain::load(planet.clone(), store.cloned(), &|_| go_on(0.0));
        let loaded = [&self.with, &self.without].map(load);
        let [Ok(with), Ok(without)] = loaded else {
            let why = loaded.into_iter().filter_map(Result::err).map(|error| error.to_string()).next();
            return Err(BakeError::Asked(why.unwrap_or_default()));
        };
        let (Some(with), Some(without)) = (with, without) else { return Ok(None) };
        let side = self.place.side_px as usize;
        let mut heights_m = vec![0.0_f64; side * side];
        for (number, rows) in heights_m.chunks_mut(ROWS * side).enumerate() {
            if !go_on((number * ROWS) as f64 / side as f64) {
                return Ok(None);
            }
            let pixel = |i: usize| self.place.pixel(i % side, number * ROWS + i / side);
            let dirs: Vec<(usize, DVec3)> =
                (0..rows.len()).into_par_iter().filter_map(|i| Some((i, pixel(i)?))).collect();
            for (i, change_m) in self.changes_m(&dirs, &with, &without) {
                rows[i] = change_m;
            }
        }
        let most_m = heights_m.iter().fold(0.0_f64, |most, height_m| most.max(height_m.abs()));
        if most_m < 1e-3 {
            return Err(BakeError::Asked("these edits change no height: there is nothing to bake".to_owned()));
        }
        find_coefficients(&mut heights_m, side);
        let height_m = most_m.min(20_000.0);
        let values = heights_m.iter().map(|value| (value / height_m) as f32).collect();
        let stamp = GroundEdit {
            name: if self.chosen.len() == 1 {
                "Baked: 1 edit".to_owned()
            } else {
                format!("Baked: {} edits", self.chosen.len())
            },
            radius_km: self.place.radius_rad * self.with.radius_km,
            softness: 0.0,
            points: [EditPoint::under(self.place.middle)].into_iter().collect(),
            ..GroundEdit::of(Tool::Picture(PictureStamp { height_m, ..PictureStamp::default() }))
        };
        Ok(Some(BakedEdits { values, side_px: self.place.side_px, stamp, chosen: self.chosen.clone() }))
    }

    /// The changes of the height at those of some numbered directions that the edits reach.
    fn changes_m(&self, dirs: &[(usize, DVec3)], with: &Terrain, without: &Terrain) -> Vec<(usize, f64)> {
        let reached = dirs.par_chunks(256).flat_map_iter(|dirs| {
            let reached = self.alone.edited(&dirs.iter().map(|(_, dir)| *dir).collect::<Vec<_>>());
            dirs.iter().zip(reached).filter(|(_, reached)| *reached).map(|(dir, _)| *dir).collect::<Vec<_>>()
        });
        let (numbers, dirs): (Vec<usize>, Vec<DVec3>) = reached.collect::<Vec<_>>().into_iter().unzip();
        let [with, without] = [with, without].map(|terrain| terrain.heights_spaced_m(&dirs, self.place.pixel_rad()));
        numbers.into_iter().zip(with.into_iter().zip(without).map(|(with, without)| with - without)).collect()
    }

    /// How far the ground of the picture is from that of the edits, between pixels as well as at them. `file`: the
    /// picture. None if stopped.
    ///
    /// # Errors
    ///
    /// If the picture cannot be read.
    pub fn compare(
        &self,
        baked: &BakedEdits,
        file: &Path,
        store: Option<&Arc<MapStore>>,
        go_on: &(dyn Fn(f64) -> bool + Sync),
    ) -> Result<Option<Deviation>, BakeError> {
        let mut stamped = baked.replace(&self.with, file);
        // Other pictures may be missing.
        let own = edit_path(baked.index());
        let why = stamped.load_pictures().into_iter().find(|(path, _)| path.starts_with(&own));
        if let Some((_, why)) = why {
            return Err(BakeError::file(file, why));
        }
        let load = |planet: Arc<Planet>| {
            let loaded = Terrain::load(planet, store.cloned(), &|_| go_on(1.0));
            loaded.map_err(|error| BakeError::Asked(error.to_string()))
        };
        let (Some(with), Some(stamped)) = (load(self.with.clone())?, load(Arc::new(stamped))?) else {
            return Ok(None);
        };
        let grid = Place { side_px: COMPARED, ..self.place };
        let pixel = |i: u32| grid.pixel((i % COMPARED) as usize, (i / COMPARED) as usize);
        let dirs: Vec<(usize, DVec3)> =
            (0..COMPARED * COMPARED).filter_map(|i| Some((i as usize, pixel(i)?))).collect();
        let (mut greatest_m, mut squares, mut count) = (0.0_f64, 0.0, 0);
        for (_, difference_m) in self.changes_m(&dirs, &with, &stamped) {
            greatest_m = greatest_m.max(difference_m.abs());
            squares += difference_m * difference_m;
            count += 1;
        }
        Ok(Some(Deviation { greatest_m, rms_m: (squares / f64::from(count.max(1))).sqrt() }))
    }
}

/// The radius of an edit where it is narrowest, of its smallest copy.
fn narrowest_km(edit: &GroundEdit) -> f64 {
    let width = edit.points.0.iter().map(|point| point.width).fold(1.0, f64::min);
    edit.radius_km * width * if edit.tool.is_stamp() && edit.copies > 1 { edit.smallest } else { 1.0 }
}

impl Place {
    /// Angle between neighbouring pixels in the middle.
    fn pixel_rad(&self) -> f64 {
        self.ring_chord() * 2.0 / f64::from(self.side_px)
    }

    fn ring_chord(&self) -> f64 {
        2.0 * libm::sin(0.5 * self.radius_rad)
    }

    /// The direction of the centre of a pixel. None outside of the ring, where the stamp ends.
    fn pixel(&self, column: usize, row: usize) -> Option<DVec3> {
        let at = |i: usize| (2.0 * i as f64 + 1.0) / f64::from(self.side_px) - 1.0;
        let (x, y) = (at(column), -at(row));
        if x * x + y * y > 1.0 {
            return None;
        }
        let (x, y) = (x * self.ring_chord(), y * self.ring_chord());
        let chord2 = x * x + y * y;
        let (east, north) = east_north(self.middle);
        let across = (east * x + north * y) * (1.0 - 0.25 * chord2).max(0.0).sqrt();
        Some((self.middle * (1.0 - 0.5 * chord2) + across).normalize())
    }
}

impl BakedEdits {
    /// Pixels along a side.
    pub fn side_px(&self) -> u32 {
        self.side_px
    }

    /// Writes the picture, OpenEXR of floats of 32 bits: the old file or the new one is there, whatever fails.
    ///
    /// # Errors
    ///
    /// If the file cannot be written.
    pub fn write(&self, file: &Path) -> Result<(), BakeError> {
        let steps = Steps::new(Format::Exr, Map::Height, (0.0, 1.0), None);
        let shape = Shape { width: self.side_px, height: self.side_px, channels: 1, format: Format::Exr, steps };
        let mut write = |out: &mut std::fs::File| openexr::write(out, &shape, &mut Values(&self.values, &shape));
        write_atomically_with(file, None, &mut write).map_err(|error| BakeError::file(file, error))
    }

    /// The planet with the stamp in the place of the edits. `file`: the path of the picture, absolute or relative to
    /// the folder of the preset.
    pub fn replace(&self, planet: &Planet, file: &Path) -> Planet {
        let mut planet = planet.clone();
        let mut stamp = self.stamp.clone();
        if let Tool::Picture(picture) = &mut stamp.tool {
            picture.file = file.to_string_lossy().into_owned().into();
        }
        for index in self.chosen.iter().rev() {
            planet.edits.remove(*index);
        }
        planet.edits.insert(self.index(), stamp);
        planet
    }

    /// The index of the stamp in the planet that it is put into.
    pub fn index(&self) -> usize {
        self.chosen.last().map_or(0, |last| last + 1 - self.chosen.len())
    }
}

/// Rows from the top.
struct Values<'a>(&'a [f32], &'a Shape);

impl Source for Values<'_> {
    fn read(&mut self, rows: u32, values: &mut Vec<f32>) -> io::Result<()> {
        let (now, later) = self.0.split_at((rows as usize * self.1.row()).min(self.0.len()));
        values.clear();
        values.extend_from_slice(now);
        self.0 = later;
        Ok(())
    }
}

/// Turns values into coefficients of the cubic B-spline that goes through them. Beyond the edges is nothing.
fn find_coefficients(values: &mut [f64], side: usize) {
    values.par_chunks_mut(side).for_each(filter);
    let columns: Vec<Vec<f64>> = (0..side)
        .into_par_iter()
        .map(|x| {
            let mut column: Vec<f64> = values.iter().skip(x).step_by(side).copied().collect();
            filter(&mut column);
            column
        })
        .collect();
    values.par_chunks_mut(side).enumerate().for_each(|(y, row)| {
        for (value, column) in row.iter_mut().zip(&columns) {
            *value = column[y];
        }
    });
}

fn filter(line: &mut [f64]) {
    let mut last = 0.0;
    for value in line.iter_mut() {
        last = *value * GAIN + POLE * last;
        *value = last;
    }
    // What the causal filter leaves beyond the edge falls by the pole, step by step.
    let mut next = -last * POLE / (1.0 - POLE * POLE);
    for value in line.iter_mut().rev() {
        next = POLE * (next - *value);
        *value = next;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_spline_of_the_coefficients_goes_through_the_values() {
        let values: Vec<f64> =
            (0..40).map(|i| f64::from((i * 37) % 11) * f64::from(u8::from(i > 2 && i < 37))).collect();
        let mut line = values.clone();
        filter(&mut line);
        let at = |i: isize| usize::try_from(i).ok().and_then(|i| line.get(i)).copied().unwrap_or(0.0);
        for (i, value) in values.iter().enumerate().take(38).skip(2) {
            let i = i as isize;
            let spline = (at(i - 1) + 4.0 * at(i) + at(i + 1)) / 6.0;
            assert!((spline - value).abs() < 1e-9, "{i}: {spline} {value}");
        }
    }
}
