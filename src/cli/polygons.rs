//! Land and water as polygons (RFC 7946) from closed lines of equal height.
//!
//! On the plane of longitude and latitude the globe is a rectangle. Lines that cross the antimeridian are cut there.
//! A cut line goes on along the border of the rectangle, anticlockwise, to the beginning of the next one: what is to
//! the left stays to the left. So a polygon may have edges at longitudes -180 and 180 and, around a pole, at latitudes
//! -90 and 90.

use super::geojson::{lon_lat_deg, parts};
use crate::sphere::LatLon;
use serde_json::{Value, json};

/// Longitude and latitude, degrees.
type Place = [f64; 2];
/// A closed line; the last place is the first.
type Ring = Vec<Place>;

/// The corners of the rectangle, anticlockwise from its right edge on: at 1, 2, 3 and 4 of [`along`].
const CORNERS: [Place; 4] = [[180.0, 90.0], [-180.0, 90.0], [-180.0, -90.0], [180.0, -90.0]];

/// A polygon: around it anticlockwise, then its holes clockwise.
pub(super) struct Polygon(Vec<Ring>);

impl Polygon {
    /// The geometry of the polygon.
    pub(super) fn geometry(&self) -> Value {
        json!({ "type": "Polygon", "coordinates": self.0 })
    }
}

/// Lines that are prepared for both sides.
pub(super) struct Lines {
    /// Closed lines off the antimeridian, and pieces from the antimeridian to the antimeridian.
    rings: Vec<Ring>,
    pieces: Vec<Vec<Place>>,
}

impl Lines {
    /// Closed lines, each with its last point as its first, that do not cross each other.
    pub(super) fn new<'a>(lines: impl Iterator<Item = &'a [LatLon]>) -> Self {
        let mut all = Self { rings: Vec::new(), pieces: Vec::new() };
        for line in lines {
            let mut cut: Vec<Vec<Place>> =
                parts(line).into_iter().map(|part| part.into_iter().map(lon_lat_deg).collect()).collect();
            // The first piece goes on where the last one ends, unless that is on the antimeridian.
            let ends = cut.first().and_then(|part| part.first()).zip(cut.last().and_then(|part| part.last()));
            let is_closed = ends.is_some_and(|(first, last)| first == last && first[0].abs() < 180.0);
            if is_closed && cut.len() > 1 {
                let first = cut.remove(0);
                cut.last_mut().into_iter().for_each(|last| last.extend(&first[1..]));
            }
            match &mut cut[..] {
                [ring] if ring.first() == ring.last() && ring.len() >= 4 => all.rings.push(std::mem::take(ring)),
                _ => all.pieces.extend(cut.into_iter().filter(|piece| is_piece(piece))),
            }
        }
        all
    }

    /// The polygons to the left of the lines, or to their right. `is_all`: whether all of the globe is, where there is
    /// no line.
    pub(super) fn polygons(&self, to_the_left: bool, is_all: bool) -> Vec<Polygon> {
        let turned = |line: &Vec<Place>| match to_the_left {
            true => line.clone(),
            false => line.iter().rev().copied().collect(),
        };
        let mut rings: Vec<Ring> = self.rings.iter().map(turned).collect();
        rings.extend(joined(&self.pieces.iter().map(turned).collect::<Vec<_>>()));
        let (mut around, holes): (Vec<Ring>, Vec<Ring>) = rings.into_iter().partition(|ring| area(ring) > 0.0);
        // A hole that lies in nothing lies in the whole rectangle.
        let is_outside = |hole: &Ring| !around.iter().any(|ring| contains(ring, hole[0]));
        if (around.is_empty() && holes.is_empty() && is_all) || holes.iter().any(is_outside) {
            around.push(vec![CORNERS[3], CORNERS[0], CORNERS[1], CORNERS[2], CORNERS[3]]);
        }
        // The smallest ring around a hole is next to it.
        around.sort_by(|a, b| area(a).total_cmp(&area(b)));
        let mut polygons: Vec<Polygon> = around.into_iter().map(|ring| Polygon(vec![ring])).collect();
        for hole in holes {
            if let Some(polygon) = polygons.iter_mut().find(|polygon| contains(&polygon.0[0], hole[0])) {
                polygon.0.push(hole);
            }
        }
        polygons.reverse();
        polygons
    }
}

/// Whether a piece leads from the antimeridian to the antimeridian.
fn is_piece(piece: &[Place]) -> bool {
    piece.len() >= 2 && [piece[0], piece[piece.len() - 1]].iter().all(|place| place[0].abs() == 180.0)
}

/// How far a place on the left or right edge is along the border: 0 to 4, anticlockwise from the lower right corner.
fn along(place: Place) -> f64 {
    if place[0] > 0.0 { (place[1] + 90.0) / 180.0 } else { 2.0 + (90.0 - place[1]) / 180.0 }
}

/// The rings that pieces make with the border.
fn joined(pieces: &[Vec<Place>]) -> Vec<Ring> {
    let mut rings = Vec::new();
    let mut is_used = vec![false; pieces.len()];
    let ends = |piece: &Vec<Place>| (along(piece[0]), along(piece[piece.len() - 1]));
    for first in 0..pieces.len() {
        let (mut ring, mut at) = (Ring::new(), first);
        while !std::mem::replace(&mut is_used[at], true) {
            ring.extend(&pieces[at]);
            let from = ends(&pieces[at]).1;
            // The next beginning along the border: the first of this ring is among them, and closes it.
            let far = |piece: usize| (ends(&pieces[piece]).0 - from).rem_euclid(4.0);
            let open = (0..pieces.len()).filter(|piece| !is_used[*piece] || *piece == first);
            let Some(next) = open.min_by(|a, b| far(*a).total_cmp(&far(*b))) else { break };
            let corners = (1..=8_usize).map(|corner| corner as f64).filter(|corner| *corner > from);
            ring.extend(
                corners
                    .take_while(|corner| *corner < from + far(next))
                    .map(|corner| CORNERS[(corner as usize - 1) % 4]),
            );
            at = next;
        }
        if let Some(start) = ring.first().copied() {
            ring.push(start);
            ring.dedup();
            if ring.len() >= 4 {
                rings.push(ring);
            }
        }
    }
    rings
}

/// Area on the plane of longitude and latitude; positive if the ring goes around it anticlockwise.
fn area(ring: &[Place]) -> f64 {
    0.5 * ring.windows(2).map(|pair| pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1]).sum::<f64>()
}

/// Whether a place is within a ring: a ray to the east crosses it an odd number of times.
fn contains(ring: &[Place], [lon, lat]: Place) -> bool {
    let crosses = |pair: &&[Place]| {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        (y0 > lat) != (y1 > lat) && lon < x0 + (lat - y0) / (y1 - y0) * (x1 - x0)
    };
    ring.windows(2).filter(crosses).count() % 2 == 1
}

#[cfg(test)]
mod tests {
    use super::*;

    fn line(places: &[(f64, f64)]) -> Vec<LatLon> {
        places.iter().chain(&places[..1]).map(|&(lat, lon)| LatLon::from_degrees(lat, lon)).collect()
    }

    /// A square around a place, anticlockwise.
    fn square(lat: f64, lon: f64, half: f64) -> Vec<LatLon> {
        let lon_of = |lon: f64| (lon + 180.0).rem_euclid(360.0) - 180.0;
        let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
        line(&corners.map(|(up, east)| (lat + up * half, lon_of(lon + east * half))))
    }

    fn reversed(mut line: Vec<LatLon>) -> Vec<LatLon> {
        line.reverse();
        line
    }

    /// Land and water, whose areas must make up the rectangle.
    fn sides(lines: &[Vec<LatLon>], is_land: bool) -> [Vec<Polygon>; 2] {
        let lines = Lines::new(lines.iter().map(Vec::as_slice));
        let sides = [lines.polygons(true, is_land), lines.polygons(false, !is_land)];
        let total: f64 = sides.iter().flatten().flat_map(|polygon| &polygon.0).map(|ring| area(ring)).sum();
        assert!((total - 360.0 * 180.0).abs() < 1e-6, "{total}");
        for polygon in sides.iter().flatten() {
            assert!(area(&polygon.0[0]) > 0.0 && polygon.0[1..].iter().all(|hole| area(hole) < 0.0));
            for ring in &polygon.0 {
                assert!(
                    ring.len() >= 4 && ring.first() == ring.last() && ring.windows(2).all(|pair| pair[0] != pair[1])
                );
            }
        }
        sides
    }

    fn counts(sides: &[Vec<Polygon>; 2]) -> [Vec<usize>; 2] {
        sides.each_ref().map(|side| side.iter().map(|polygon| polygon.0.len()).collect())
    }

    #[test]
    fn islands_lakes_and_islands_in_lakes_are_nested() {
        let lines = [
            square(10.0, 20.0, 9.0),
            reversed(square(10.0, 20.0, 5.0)),
            square(10.0, 20.0, 1.0),
            square(-30.0, 0.0, 2.0),
        ];
        // Land: an island with a lake, an island in the lake, another. Water: the sea and the lake with their islands.
        assert_eq!(counts(&sides(&lines, false)), [vec![2, 1, 1], vec![3, 2]]);
    }

    #[test]
    fn lines_over_the_antimeridian_and_around_poles_are_closed_along_the_border() {
        let island = square(10.0, 180.0, 5.0);
        assert_eq!(counts(&sides(std::slice::from_ref(&island), false)), [vec![1, 1], vec![1]]);
        // A cap of land in the north: its coast goes east, with the land to the left.
        let lons = [-170.0, -90.0, 0.0, 90.0, 170.0];
        let cap = line(&lons.map(|lon| (70.0, lon)));
        let found = sides(&[cap.clone(), island], false);
        assert_eq!(counts(&found), [vec![1, 1, 1], vec![1]]);
        let northern = &found[0][0].0[0];
        assert!(northern.contains(&[180.0, 90.0]) && northern.contains(&[-180.0, 90.0]));
        // The same about the south, of water.
        let southern = line(&lons.map(|lon| (-70.0, lon)));
        assert_eq!(counts(&sides(&[cap, reversed(southern.clone())], false)), [vec![1, 1], vec![1]]);
        assert_eq!(counts(&sides(&[southern], true)), [vec![1], vec![1]]);
    }

    #[test]
    fn without_lines_all_is_land_or_water() {
        assert_eq!(counts(&sides(&[], true)), [vec![1], vec![]]);
        assert_eq!(counts(&sides(&[], false)), [vec![], vec![1]]);
        // A lake on a globe of land.
        assert_eq!(counts(&sides(&[reversed(square(0.0, 0.0, 3.0))], true)), [vec![2], vec![1]]);
    }
}
