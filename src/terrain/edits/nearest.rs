//! The nearest arc of an edit, for many points at a time.

use super::path::{self, Arc};
use crate::simd::{Simd, for_each_simd};
use glam::DVec3;

/// Points in a vector of the widest instruction set.
const LANES: usize = 8;
/// More than an order by distance loses by rounding.
const ROUNDING: f64 = 1e-9;

/// The nearest arc of an edit to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Nearest {
    /// Squared chord to it.
    pub(super) chord2: f64,
    /// Whether its nearest place lies between its ends.
    pub(super) inside: bool,
    /// Its place among the arcs of the edit.
    pub(super) arc: u32,
}

/// Some points, each axis in its own list, and the nearest arc to each. The memory is used again.
#[derive(Debug, Default)]
pub(super) struct Search {
    count: usize,
    x: Vec<f64>,
    y: Vec<f64>,
    z: Vec<f64>,
    /// Order by distance of the nearest arc, and its place among the arcs of the edit.
    order: Vec<f64>,
    place: Vec<u32>,
}

impl Search {
    /// Takes other points.
    pub(super) fn refill(&mut self, dirs: impl Iterator<Item = DVec3>) {
        let Self { count, x, y, z, .. } = self;
        [&mut *x, &mut *y, &mut *z].into_iter().for_each(Vec::clear);
        for dir in dirs {
            x.push(dir.x);
            y.push(dir.y);
            z.push(dir.z);
        }
        // Whole vectors: each point that is left over would take as long as one.
        *count = x.len();
        let count = x.len().next_multiple_of(LANES);
        for axis in [x, y, z] {
            axis.resize(count, axis.last().copied().unwrap_or(0.0));
        }
    }

    /// The nearest of some arcs, given by their places among all arcs of an edit, to each point within about a squared
    /// chord of one, with the number of the point. The first of several at the same distance.
    /// `tapers`: whether widths count; then all points are given.
    pub(super) fn find(
        &mut self,
        (all, places): (&[Arc], &[u32]),
        tapers: bool,
        within_chord2: f64,
    ) -> impl Iterator<Item = (usize, Nearest)> {
        self.find_with(Simd::detect(), (all, places), tapers, within_chord2)
    }

    fn find_with(
        &mut self,
        simd: Simd,
        (all, places): (&[Arc], &[u32]),
        tapers: bool,
        within_chord2: f64,
    ) -> impl Iterator<Item = (usize, Nearest)> {
        let Self { count, x, y, z, order, place } = self;
        order.clear();
        order.resize(x.len(), f64::MAX);
        place.clear();
        place.resize(x.len(), 0);
        find_simd(simd, all, places, tapers, [x, y, z], order, place);
        let most = if tapers { f64::INFINITY } else { path::order_of(within_chord2) * (1.0 + ROUNDING) };
        let near = order.iter().take(*count).enumerate().filter(move |(_, order)| **order <= most);
        near.map(|(point, _)| {
            let (chord2, inside) = all[place[point] as usize].chord2(DVec3::new(x[point], y[point], z[point]));
            (point, Nearest { chord2, inside, arc: place[point] })
        })
    }
}

#[inline(always)]
fn find_body(all: &[Arc], places: &[u32], tapers: bool, points: [&[f64]; 3], order: &mut [f64], nearest: &mut [u32]) {
    let count = order.len();
    let (Some(x), Some(y), Some(z)) = (points[0].get(..count), points[1].get(..count), points[2].get(..count)) else {
        return;
    };
    let Some(nearest) = nearest.get_mut(..count) else { return };
    for &place in places {
        let Some(arc) = all.get(place as usize) else { continue };
        let tangents = arc.tangents();
        // Apart, so that the usual loop is vectorised.
        if tapers {
            for i in 0..count {
                let new = arc.tapered_order(DVec3::new(x[i], y[i], z[i]));
                let is_nearer = new < order[i];
                order[i] = if is_nearer { new } else { order[i] };
                nearest[i] = if is_nearer { place } else { nearest[i] };
            }
            continue;
        }
        for i in 0..count {
            let new = arc.order(DVec3::new(x[i], y[i], z[i]), tangents);
            let is_nearer = new < order[i];
            order[i] = if is_nearer { new } else { order[i] };
            nearest[i] = if is_nearer { place } else { nearest[i] };
        }
    }
}
for_each_simd!(fn find_simd(all: &[Arc], places: &[u32], tapers: bool, points: [&[f64]; 3], order: &mut [f64], nearest: &mut [u32]) = find_body);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::EditPoint;

    #[test]
    fn all_instruction_sets_find_the_nearest_arc_anywhere_on_the_sphere() {
        let points: Vec<EditPoint> = (0..12)
            .map(|k| EditPoint {
                latitude_deg: 80.0 + f64::from(k % 5),
                longitude_deg: 25.0 * f64::from(k),
                ..EditPoint::default()
            })
            .collect();
        let all = super::super::path::arcs(&points, 0.05);
        let dirs: Vec<DVec3> = crate::sphere::geo::spread(3001).collect();

        let places: Vec<u32> = (0..all.len() as u32).filter(|place| place % 7 != 3).collect();
        let mut search = Search::default();
        search.refill(dirs.iter().copied());
        let expected: Vec<Nearest> =
            search.find_with(Simd::Baseline, (&all, &places), false, 4.0).map(|(_, nearest)| nearest).collect();
        assert_eq!(expected.len(), dirs.len());
        for (dir, found) in dirs.iter().zip(&expected) {
            let least = places.iter().map(|place| all[*place as usize].chord2(*dir).0).fold(f64::MAX, f64::min);
            assert!(places.contains(&found.arc), "{found:?}");
            assert_eq!((found.chord2, found.inside), all[found.arc as usize].chord2(*dir));
            assert!((found.chord2 - least).abs() <= 1e-15, "{found:?} {least}");
        }
        for simd in Simd::available() {
            for within_chord2 in [4.0, 0.7, 0.01] {
                let found: Vec<_> = search.find_with(simd, (&all, &places), false, within_chord2).collect();
                let near = expected.iter().copied().enumerate().filter(|(_, near)| near.chord2 <= within_chord2);
                assert_eq!(found, near.collect::<Vec<_>>(), "{}", simd.name());
            }
        }
    }
}
