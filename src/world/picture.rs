//! Pictures of the world maps, for debug views: the six faces of a cube texture.

use super::World;
use super::carved::Carved;
use super::noise::{hash, unit};
use super::plates::Plates;
use super::weather::Weather;
use crate::planet::Key;
use crate::sphere::cube::texture_direction;
use crate::sphere::raster::{Raster, cube_direction, cube_point};
use crate::sphere::spread;
use glam::DVec3;
use rayon::prelude::*;

/// A map that can be shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum MapView {
    /// Plates in their colours, bright where they stand high, with darts along their motion.
    Plates,
    /// Rain, from brown over green and blue to violet, with darts along the wind.
    Rain,
    /// Basins in their colours, with rivers and lakes.
    Rivers,
}

/// The picture of a map.
pub(crate) struct MapPicture {
    /// Texels along the side of a face.
    pub(crate) side: usize,
    /// Linear red, green, blue and alpha of the faces +X, -X, +Y, -Y, +Z and -Z of a cube texture, rows from the top.
    pub(crate) texels: Vec<[u8; 4]>,
}

/// Texels along the side of a face where the map is smooth, and the most for rivers.
const SIDE: usize = 256;
const MOST: usize = 512;
/// Number of darts on the globe.
const DARTS: usize = 500;
/// Half the width of a dart at its tail, and its greatest length, radians.
const DART_HALF_WIDTH: f64 = 0.015;
const DART_LENGTH: f64 = 0.15;
/// Speeds at which a dart is half as long as it can be: of plates in radians a million years, of the wind in m/s.
const PLATE_SPEED: f64 = 0.004;
const WIND_SPEED: f64 = 3.0;
/// Colours of rain: mm a year, and linear red, green and blue.
pub(crate) const RAIN_COLORS: [(f64, [f64; 3]); 5] = [
    (0.0, [0.35, 0.2, 0.08]),
    (500.0, [0.5, 0.42, 0.12]),
    (1100.0, [0.12, 0.4, 0.08]),
    (2200.0, [0.02, 0.22, 0.4]),
    (4500.0, [0.25, 0.05, 0.45]),
];

impl World {
    /// Keys of the maps that a picture shows: equal keys give equal pictures.
    pub(crate) fn picture_key(&self, view: MapView) -> [Option<Key>; 2] {
        match view {
            MapView::Plates => [self.plates.key(), None],
            MapView::Rain => [self.weather.key(), self.carved.key()],
            MapView::Rivers => [self.carved.key(), None],
        }
    }

    /// The picture of a map; None if the planet has no structure, or its map is not solved yet.
    pub(crate) fn picture(&self, view: MapView) -> Option<MapPicture> {
        let (plates, weather, carved) = (self.plates.map()?, self.weather.map(), self.carved.map());
        match view {
            MapView::Plates => Some(plates_picture(plates)),
            MapView::Rain => Some(rain_picture(weather?, carved.map(|carved| &**carved))),
            MapView::Rivers => Some(rivers_picture(carved?)),
        }
    }
}

impl MapPicture {
    fn new(side: usize, color: impl Fn(DVec3) -> [f64; 3] + Sync) -> Self {
        let byte = |linear: f64| (linear.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
        let direction = |face: usize, x: usize, y: usize| texture_direction(face, side, x as f64 + 0.5, y as f64 + 0.5);
        let texel = |at: usize| {
            let [r, g, b] = color(direction(at / (side * side), at % side, at / side % side)).map(byte);
            [r, g, b, 255]
        };
        Self { side, texels: (0..6 * side * side).into_par_iter().with_min_len(side).map(texel).collect() }
    }
}

/// The cell of a grid at a direction.
fn cell_at(dir: DVec3, side: usize) -> usize {
    let (face, x, y) = cube_point(dir, side);
    let within = |at: f64| (at.max(0.0) as usize).min(side - 1);
    (face * side + within(y)) * side + within(x)
}

fn plates_picture(plates: &Plates) -> MapPicture {
    let Plates { layout, rock, folds, .. } = plates;
    let surface: Vec<f32> = rock.base_m.iter().zip(&rock.uplift_m).map(|(base, rise)| (base + rise) as f32).collect();
    let surface_m = Raster::cube(rock.side, surface);
    let folded = Raster::cube(rock.side, folds.iter().map(|(_, share)| *share as f32).collect());
    let darts = Darts::new(PLATE_SPEED, |dir| layout.plates[layout.plate_under(dir)].pole.cross(dir));
    MapPicture::new(SIDE, |dir| {
        let place = surface_m.place(dir);
        let height = ((surface_m.value(&place, 0) + 6000.0) / 9000.0).clamp(0.0, 1.0);
        let folds = folded.value(&place, 0).clamp(0.0, 1.0);
        let light = 0.06 + 0.5 * height * height + 0.25 * folds;
        darts.over(dir, hue(layout.plate_under(dir) as u32).map(|c| c * light))
    })
}

fn rain_picture(weather: &Weather, carved: Option<&Carved>) -> MapPicture {
    // Makes the rasters before all cores ask for them.
    weather.rain_at(DVec3::X);
    weather.wind_at(DVec3::X);
    let darts = Darts::new(WIND_SPEED, |dir| weather.wind_at(dir));
    MapPicture::new(SIDE, |dir| {
        let rain_mm = weather.rain_at(dir);
        let is_sea = carved.is_some_and(|Carved { drainage, .. }| drainage.is_sea[cell_at(dir, drainage.side)]);
        darts.over(dir, rain_color(rain_mm).map(|c| if is_sea { 0.3 * c } else { c }))
    })
}

fn rivers_picture(carved: &Carved) -> MapPicture {
    let (drainage, basins) = (&carved.drainage, carved.basins());
    MapPicture::new(drainage.side.clamp(SIDE, MOST), |dir| {
        let cell = cell_at(dir, drainage.side);
        if drainage.is_sea[cell] {
            return [0.005, 0.012, 0.03];
        }
        if drainage.lake[cell] != 0 {
            return [0.03, 0.2, 0.55];
        }
        let basin = hue(basins.of(cell).unwrap_or(0)).map(|c| 0.16 * c);
        let discharge_m3_s = f64::from(drainage.discharge_m3_s[cell]).max(1e-3);
        let water = ((libm::log10(discharge_m3_s) - 1.5) / 3.0).clamp(0.0, 1.0);
        mixed(basin, [0.35, 0.75, 1.0], water)
    })
}

/// A colour for a number: equal for equal numbers.
fn hue(number: u32) -> [f64; 3] {
    let turn = unit(hash(0xC0105, number));
    let channel = |k: f64| (((turn + k).fract() * 6.0 - 3.0).abs() - 1.0).clamp(0.0, 1.0);
    [0.0, 2.0 / 3.0, 1.0 / 3.0].map(|k| 0.25 + 0.75 * channel(k))
}

fn mixed(a: [f64; 3], b: [f64; 3], share: f64) -> [f64; 3] {
    std::array::from_fn(|i| a[i] + (b[i] - a[i]) * share)
}

fn rain_color(rain_mm: f64) -> [f64; 3] {
    let next = RAIN_COLORS.iter().position(|(mm, _)| rain_mm < *mm).unwrap_or(RAIN_COLORS.len() - 1).max(1);
    let ((from_mm, from), (to_mm, to)) = (RAIN_COLORS[next - 1], RAIN_COLORS[next]);
    mixed(from, to, ((rain_mm - from_mm) / (to_mm - from_mm)).clamp(0.0, 1.0))
}

/// Triangles on the globe that point along a motion, longer where it is faster: those near each cell of a coarse grid.
struct Darts(Vec<Vec<Dart>>);

/// Cells along the side of the grid of darts.
const DART_CELLS: usize = 8;

#[derive(Clone)]
struct Dart {
    tail: DVec3,
    /// Unit tangent along the motion.
    along: DVec3,
    length: f64,
}

impl Darts {
    /// `motion`: a tangent at a direction; of length `half` it makes a dart of half the greatest length.
    fn new(half: f64, motion: impl Fn(DVec3) -> DVec3 + Sync) -> Self {
        let all: Vec<DVec3> = spread(DARTS).collect();
        let dart = |&tail: &DVec3| {
            let motion = motion(tail);
            let speed = motion.length();
            let length = DART_LENGTH * speed / (speed + half);
            Dart { tail, along: motion.normalize_or_zero(), length }
        };
        let darts: Vec<Dart> = all.par_iter().map(dart).filter(|dart| dart.length >= DART_HALF_WIDTH).collect();
        let near = |middle: DVec3| {
            // Half the diagonal of the widest cell, which lies in the middle of a face.
            let reach = std::f64::consts::SQRT_2 / DART_CELLS as f64 + DART_LENGTH + DART_HALF_WIDTH;
            darts.iter().filter(|dart| dart.tail.distance(middle) < reach).cloned().collect()
        };
        let face_cell = |at: usize| {
            let (face, x, y) = (at / (DART_CELLS * DART_CELLS), at % DART_CELLS, at / DART_CELLS % DART_CELLS);
            cube_direction(face, DART_CELLS, x as f64 + 0.5, y as f64 + 0.5)
        };
        Self((0..6 * DART_CELLS * DART_CELLS).map(|at| near(face_cell(at))).collect())
    }

    /// A colour with the darts over it.
    fn over(&self, dir: DVec3, color: [f64; 3]) -> [f64; 3] {
        let covers = |dart: &Dart| {
            let away = dir - dart.tail;
            let share = away.dot(dart.along) / dart.length;
            let aside = (away - dart.along * away.dot(dart.along)).length();
            (0.0..1.0).contains(&share) && aside < DART_HALF_WIDTH * (1.0 - share)
        };
        if self.0[cell_at(dir, DART_CELLS)].iter().any(covers) { [0.9; 3] } else { color }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Plates as Params;

    #[test]
    fn plates_have_colours_of_their_own_and_darts() {
        let plates = Plates::solve(&Params::default(), 3, 32, &|| true).unwrap();
        let picture = plates_picture(&plates);
        assert_eq!(picture.texels.len(), 6 * picture.side * picture.side);
        let darts = picture.texels.iter().filter(|texel| texel[..3].iter().all(|&c| c == 230)).count();
        let share = darts as f64 / picture.texels.len() as f64;
        assert!((0.005..0.1).contains(&share), "{share}");
        let hues: std::collections::HashSet<_> = (0..15).map(|id| hue(id).map(|c| (c * 100.0) as u8)).collect();
        assert!(hues.len() >= 14, "{hues:?}");
    }

    #[test]
    fn rain_turns_from_brown_to_green_to_blue() {
        let [dry, wet, drenched] = [50.0, 1100.0, 2500.0].map(rain_color);
        assert!(dry[0] > dry[2] && wet[1] > wet[0] && drenched[2] > drenched[1], "{dry:?} {wet:?} {drenched:?}");
        let most = DVec3::from_array(rain_color(9000.0));
        assert!(most.distance(DVec3::from_array(RAIN_COLORS[4].1)) < 1e-12, "{most}");
    }
}
