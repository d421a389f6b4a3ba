//! Lines of equal height over the whole globe, coasts among them: marching squares on the faces of the cube sphere
//! (Maple 2003, "Geometric design and space planning using the marching squares and marching cube algorithms").

use super::Terrain;
use crate::sphere::{LatLon, NodeId};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;

/// Rows of vertices that are evaluated at a time.
const BAND: u32 = 32;
/// Most evaluations that move a crossing from the straight line between two vertices onto the ground between them.
const MOST_REFINEMENTS: usize = 24;
/// Difference of height at which a crossing is on the line.
const NEAR_M: f64 = 0.1;

/// A closed line of equal height. Higher ground lies to its left.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contour {
    /// Its points; the last is the first.
    pub points: Vec<LatLon>,
    /// Its length on the sphere of its height.
    pub length_km: f64,
}

/// A point where a line crosses an edge between two vertices.
struct Crossing {
    /// Directions of the lower and of the higher end, and their heights over the line.
    ends: [DVec3; 2],
    over_m: [f64; 2],
    dir: DVec3,
    /// Height of the ground at `dir` over the line, once it is known.
    found_m: f64,
}

/// The crossings that were found so far, by the edges that they lie on.
#[derive(Default)]
struct Crossings {
    numbers: HashMap<[u64; 6], u32>,
    all: Vec<Crossing>,
    /// The number of the crossing that follows on the line.
    next: Vec<u32>,
}

impl Terrain {
    /// The lines at a height over the reference sphere, the longest first. `cells`: along each side of the six faces;
    /// islands and bays smaller than a cell are left out, and so are valleys of a structure that are too narrow for
    /// cells. Points lie on the ground of that height, to a decimetre.
    pub fn contours(&self, height_m: f64, cells: u32) -> Vec<Contour> {
        profiling::scope!("contours");
        let cells = cells.max(1);
        // Each narrow valley takes milliseconds, and hardly two cells would share one.
        let spacing_rad = std::f64::consts::FRAC_PI_2 / f64::from(cells);
        let spacing_rad = self.river_spacing_rad().map_or(0.0, |coarsest_rad| spacing_rad.min(coarsest_rad));
        let mut crossings = Crossings::default();
        for root in NodeId::roots() {
            let dir = |row: u32, column: u32| {
                root.direction(NodeId::side_share(column, cells), NodeId::side_share(row, cells))
            };
            let mut below: Vec<(DVec3, f64)> = Vec::new();
            for first in (0..=cells).step_by(BAND as usize) {
                let rows = first..(first + BAND).min(cells + 1);
                let dirs: Vec<DVec3> = rows
                    .clone()
                    .flat_map(|row| (0..=cells).map(move |column| (row, column)))
                    .map(|(r, c)| dir(r, c))
                    .collect();
                let over_m = self.heights_spaced_m(&dirs, spacing_rad).into_iter().map(|found_m| found_m - height_m);
                let vertices: Vec<(DVec3, f64)> = dirs.into_iter().zip(over_m).collect();
                for row in vertices.chunks_exact(cells as usize + 1) {
                    for (below, above) in below.windows(2).zip(row.windows(2)) {
                        crossings.add_cell([below[0], below[1], above[1], above[0]]);
                    }
                    below.clear();
                    below.extend_from_slice(row);
                }
            }
        }
        self.refine(&mut crossings.all, height_m, spacing_rad);
        crossings.lines(self.planet().radius_km + height_m / 1000.0)
    }

    /// Moves crossings onto the ground: in turns where a straight line between the ends crosses, and to their middle.
    fn refine(&self, crossings: &mut [Crossing], height_m: f64, spacing_rad: f64) {
        let mut open: Vec<&mut Crossing> = crossings.iter_mut().collect();
        for step in 0..MOST_REFINEMENTS {
            let dirs: Vec<DVec3> = open.iter().map(|crossing| crossing.dir).collect();
            let heights_m = self.heights_spaced_m(&dirs, spacing_rad);
            open.par_iter_mut().zip(heights_m).for_each(|(crossing, found_m)| {
                crossing.found_m = found_m - height_m;
            });
            open.retain(|crossing| crossing.found_m.abs() > NEAR_M);
            for crossing in &mut open {
                let end = usize::from(crossing.found_m >= 0.0);
                (crossing.ends[end], crossing.over_m[end]) = (crossing.dir, crossing.found_m);
                crossing.place(step % 2 == 1);
            }
            if open.is_empty() {
                break;
            }
        }
    }
}

impl Crossing {
    /// Puts the point where a straight line between the ends crosses, or in the middle.
    fn place(&mut self, in_the_middle: bool) {
        let [lower_m, higher_m] = self.over_m;
        let rise_m = higher_m - lower_m;
        let share = if in_the_middle || rise_m <= 0.0 { 0.5 } else { (-lower_m / rise_m).clamp(0.0, 1.0) };
        self.dir = self.ends[0].lerp(self.ends[1], share).normalize();
    }
}

impl Crossings {
    /// Adds the lines through a cell, whose corners go around it anticlockwise.
    fn add_cell(&mut self, corners: [(DVec3, f64); 4]) {
        let is_high = corners.map(|(_, over_m)| over_m >= 0.0);
        if is_high == [true; 4] || is_high == [false; 4] {
            return;
        }
        let middle_is_high = corners.iter().map(|(_, over_m)| over_m).sum::<f64>() >= 0.0;
        // Around the cell, high ground ends at one side and begins again at another. With high ground to its left a
        // line leads from an end to a beginning: if two corners of each kind face each other, around a low corner if
        // the middle is high, else around a high one.
        for side in 0..4 {
            let next = (side + 1) % 4;
            if !is_high[side] || is_high[next] {
                continue;
            }
            let begins = |side: &usize| !is_high[*side] && is_high[(*side + 1) % 4];
            let around = [1, 2, 3].map(|step| if middle_is_high { (side + step) % 4 } else { (side + 4 - step) % 4 });
            let Some(to) = around.into_iter().find(begins) else { continue };
            let [from, to] = [side, to].map(|side| self.number([corners[side], corners[(side + 1) % 4]]));
            self.next[from as usize] = to;
        }
    }

    /// The number of the crossing on an edge.
    fn number(&mut self, mut ends: [(DVec3, f64); 2]) -> u32 {
        if ends[0].1 >= 0.0 {
            ends.swap(0, 1);
        }
        let [[a, b, c], [d, e, f]] = ends.map(|(dir, _)| dir.to_array().map(|component| (component + 0.0).to_bits()));
        let number = self.all.len() as u32;
        let known = *self.numbers.entry([a, b, c, d, e, f]).or_insert(number);
        if known == number {
            let (dirs, over_m) = (ends.map(|end| end.0), ends.map(|end| end.1));
            let mut crossing = Crossing { ends: dirs, over_m, dir: dirs[0], found_m: 0.0 };
            crossing.place(false);
            self.all.push(crossing);
            self.next.push(number);
        }
        known
    }

    /// The lines that the crossings make.
    fn lines(self, radius_km: f64) -> Vec<Contour> {
        let mut is_drawn = vec![false; self.all.len()];
        let mut lines = Vec::new();
        for first in 0..self.all.len() {
            let (mut dirs, mut at) = (Vec::new(), first);
            while !std::mem::replace(&mut is_drawn[at], true) {
                dirs.push(self.all[at].dir);
                at = self.next[at] as usize;
            }
            if dirs.len() < 3 {
                continue;
            }
            dirs.push(dirs[0]);
            let length: f64 = dirs.windows(2).map(|pair| pair[0].angle_between(pair[1])).sum();
            let points = dirs.into_iter().map(LatLon::from_direction).collect();
            lines.push(Contour { points, length_km: length * radius_km });
        }
        lines.sort_by(|a, b| b.length_km.total_cmp(&a.length_km));
        lines
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;
    use std::f64::consts::TAU;

    fn terrain(layers: &str) -> Terrain {
        let text = format!("(version: 3, name: \"Islet\", radius_km: 40.0, layers: [{layers}])");
        Terrain::try_new(Planet::from_text("islet.ron", &text).unwrap().into()).unwrap()
    }

    const HILLS: &str = "(name: \"Hills\", amplitude_m: 800.0, shape: Fbm(wavelength_km: 12.0, octaves: 6))";

    #[test]
    fn lines_lie_on_the_ground_of_their_height_with_higher_ground_to_the_left() {
        let terrain = terrain(HILLS);
        let lines = terrain.contours(120.0, 64);
        assert!(lines.len() > 10);
        assert!(lines.windows(2).all(|pair| pair[0].length_km >= pair[1].length_km));
        let mut is_left_higher = Vec::new();
        for line in &lines {
            assert_eq!(line.points.first(), line.points.last());
            let dirs: Vec<DVec3> = line.points.iter().map(|point| point.direction()).collect();
            for pair in dirs.windows(2) {
                // A cell is about 1 km wide.
                assert!(pair[0].angle_between(pair[1]) * 40.0 < 2.5);
                assert!((terrain.height_m(pair[0]) - 120.0).abs() < 0.11, "{}", terrain.height_m(pair[0]));
                let middle = pair[0].midpoint(pair[1]);
                let left = middle.cross(pair[1] - pair[0]).normalize_or_zero();
                let [higher_m, lower_m] = [1.0, -1.0].map(|side| terrain.height_m(middle + left * side * 2e-3));
                is_left_higher.push(higher_m > lower_m);
            }
        }
        let share = is_left_higher.iter().filter(|&&is| is).count() as f64 / is_left_higher.len() as f64;
        assert!(share > 0.95, "{share}");
    }

    #[test]
    fn a_line_goes_around_the_globe_over_the_borders_of_faces() {
        // A mask by latitude: ground in the north alone.
        let north = "(name: \"North\", amplitude_m: 100.0, bias: 1.0, shape: Fbm(wavelength_km: 100000.0, octaves: 1), \
                     masks: [Latitude(from_deg: 5.0, to_deg: 25.0, both: false)])";
        let lines = terrain(north).contours(20.0, 30);
        assert_eq!(lines.len(), 1);
        let lats = lines[0].points.iter().map(|point| point.to_degrees().0);
        let (least, most) = lats.fold((f64::MAX, f64::MIN), |(least, most), lat| (least.min(lat), most.max(lat)));
        assert!(most - least < 8.0 && least > 5.0 && most < 25.0, "{least} {most}");
        let around_km = TAU * 40.02 * ((least + most) / 2.0).to_radians().cos();
        assert!((lines[0].length_km / around_km - 1.0).abs() < 0.05, "{} {around_km}", lines[0].length_km);
    }

    #[test]
    fn where_all_ground_is_high_or_low_there_is_no_line() {
        let terrain = terrain(HILLS);
        assert_eq!(terrain.contours(1e6, 16), []);
        assert_eq!(terrain.contours(-1e6, 16), []);
    }
}
