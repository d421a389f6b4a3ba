//! The line through the points of an edit: a smooth curve (cubic Hermite with the tangents of Catmull and Rom 1974),
//! cut into arcs of great circles. Distances are to the nearest arc.

use super::mask::ShareAt;
use crate::planet::{EditPoint, GroundEdit};
use crate::sphere::geo::east_north;
use crate::world::noise::mix;
use glam::DVec3;

/// Most arcs from one point to the next.
const MOST_ARCS: f64 = 16.0;
/// How far an arc may lie from the curve, as a share of the radius of the edit.
const TOLERANCE: f64 = 0.01;
/// Places that are tried for a copy that a mask decides about.
const TRIES: u64 = 64;
/// Numbers of the random numbers of a copy: of further places, and of whether a mask lets it stay.
const MORE: u64 = 100;
const CHANCE: u64 = 1000;

/// An arc of a great circle from `a` to `b`, or a single place.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arc {
    pub(super) a: DVec3,
    pub(super) b: DVec3,
    /// The normal of its plane; zero for a single place.
    normal: DVec3,
    /// At its ends: heights of a road, the slip of a fault, the share of a coast.
    pub(super) values: [f64; 2],
    /// At its ends: the width, as a share of the radius, and the share of the effect.
    pub(super) widths: [f64; 2],
    pub(super) strengths: [f64; 2],
    /// Size of a stamp's copy relative to the stamp.
    pub(super) scale: f64,
    /// By how much a stamp's copy is turned, -1 to 1.
    pub(super) turned: f64,
    /// Whether it is a mirror image.
    pub(super) flipped: bool,
}

/// What an arc is at a point, with the gradients by the direction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Taper {
    /// Share of the radius.
    pub(super) width: f64,
    /// Share of the effect.
    pub(super) strength: f64,
    pub(super) width_by: DVec3,
    pub(super) strength_by: DVec3,
}

/// The place of an arc that is nearest to a point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Foot {
    pub(super) dir: DVec3,
    /// From 0 at the beginning of the arc to 1 at its end.
    pub(super) along: f64,
    /// Whether it lies between the ends.
    pub(super) inside: bool,
}

impl Arc {
    fn new(a: DVec3, b: DVec3, values: [f64; 2]) -> Self {
        // The difference is exact to rounding, so that the normal of a short arc is, too.
        let normal = a.cross(b - a);
        let length = normal.length();
        let normal = if length > 0.0 { normal / length } else { DVec3::ZERO };
        let ([widths, strengths], scale) = ([[1.0; 2]; 2], 1.0);
        Self { a, b, normal, values, widths, strengths, scale, turned: 0.0, flipped: false }
    }

    /// The nearest place to a unit direction: its squared chord, and whether it lies between the ends.
    #[inline]
    pub(super) fn chord2(&self, dir: DVec3) -> (f64, bool) {
        let from_a = dir - self.a;
        if self.is_beside(dir, from_a, self.tangents()) {
            // The sine of the angle to the plane, and its chord without cancellation.
            let off = from_a.dot(self.normal);
            let off2 = off * off;
            return (2.0 * off2 / (1.0 + (1.0 - off2).max(0.0).sqrt()), true);
        }
        (from_a.length_squared().min(dir.distance_squared(self.b)), false)
    }

    /// The order by distance of the nearest place (see [`order_of`]), without branches, roots and divisions.
    /// `tangents`: those of this arc.
    #[inline(always)]
    pub(super) fn order(&self, dir: DVec3, tangents: [DVec3; 2]) -> f64 {
        let from_a = dir - self.a;
        let off = from_a.dot(self.normal);
        let end = from_a.length_squared().min(dir.distance_squared(self.b));
        if self.is_beside(dir, from_a, tangents) { off * off } else { order_of(end) }
    }

    /// The order by distance for arcs that taper: the distance in widths. It is exact, because arcs that are out of
    /// reach are left out where others are near: none of them may come before one within reach.
    pub(super) fn tapered_order(&self, dir: DVec3) -> f64 {
        let [from, to] = self.widths;
        angle_of(self.chord2(dir).0) / (from + (to - from) * self.share(dir))
    }

    /// How far along the arc a direction lies: 0 at its beginning and before it, 1 at its end and beyond.
    #[inline(always)]
    fn share(&self, dir: DVec3) -> f64 {
        let along = self.b - self.a;
        ((dir - self.a).dot(along) / along.length_squared().max(1e-30)).clamp(0.0, 1.0)
    }

    /// Its width and its strength at a direction.
    pub(super) fn taper(&self, dir: DVec3) -> Taper {
        let ([w0, w1], [s0, s1]) = (self.widths, self.strengths);
        if w0 == w1 && s0 == s1 {
            return Taper { width: w0, strength: s0, width_by: DVec3::ZERO, strength_by: DVec3::ZERO };
        }
        let (share, along) = (self.share(dir), self.b - self.a);
        let by_dir = match share > 0.0 && share < 1.0 {
            true => (along - dir * dir.dot(along)) / along.length_squared(),
            false => DVec3::ZERO,
        };
        Taper {
            width: w0 + (w1 - w0) * share,
            strength: s0 + (s1 - s0) * share,
            width_by: by_dir * (w1 - w0),
            strength_by: by_dir * (s1 - s0),
        }
    }

    /// The directions of the arc at its ends.
    #[inline(always)]
    pub(super) fn tangents(&self) -> [DVec3; 2] {
        [self.normal.cross(self.a), self.normal.cross(self.b)]
    }

    /// Whether the nearest place lies between the ends.
    #[inline(always)]
    fn is_beside(&self, dir: DVec3, from_a: DVec3, tangents: [DVec3; 2]) -> bool {
        (from_a.dot(tangents[0]) > 0.0) & ((dir - self.b).dot(tangents[1]) < 0.0)
    }

    /// The nearest place to a unit direction. `inside`: whether it lies between the ends.
    pub(super) fn foot(&self, dir: DVec3, inside: bool) -> Foot {
        if inside {
            let foot = (dir - self.normal * (dir - self.a).dot(self.normal)).normalize();
            let along = ((foot - self.a).length() / (self.b - self.a).length()).min(1.0);
            return Foot { dir: foot, along, inside };
        }
        let is_a = self.is_nearer_to_begin(dir);
        let (foot, along) = if is_a { (self.a, 0.0) } else { (self.b, 1.0) };
        Foot { dir: foot, along, inside }
    }

    /// The direction along the arc at its foot.
    fn tangent(&self, foot: DVec3) -> DVec3 {
        self.normal.cross(foot)
    }

    /// The value at its foot, and its gradient by the direction.
    pub(super) fn value(&self, foot: &Foot) -> (f64, DVec3) {
        let [from, to] = self.values;
        let slope = if foot.inside { (to - from) / self.length_rad().max(1e-15) } else { 0.0 };
        (from + (to - from) * foot.along, self.tangent(foot.dir) * slope)
    }

    /// 1 if a direction is on the left side of the way from its beginning to its end, else -1.
    pub(super) fn side(&self, dir: DVec3) -> f64 {
        if (dir - self.a).dot(self.normal) >= 0.0 { 1.0 } else { -1.0 }
    }

    /// Whether a direction that is not beside it is nearer to its beginning than to its end.
    pub(super) fn is_nearer_to_begin(&self, dir: DVec3) -> bool {
        (dir - self.a).length_squared() <= dir.distance_squared(self.b)
    }

    /// The side at the end that is nearer to a direction, of a line that goes on there with another arc: the mean of
    /// both planes decides (the pseudonormal of Bærentzen and Aanæs 2005).
    pub(super) fn side_at_joint(&self, other: &Self, dir: DVec3) -> f64 {
        let joint = if self.is_nearer_to_begin(dir) { self.a } else { self.b };
        let goes_on = other.a == joint || other.b == joint;
        let normal = if goes_on { self.normal + other.normal } else { self.normal };
        if (dir - joint).dot(normal) >= 0.0 { 1.0 } else { -1.0 }
    }

    /// The tangent at a direction that points to its left side.
    pub(super) fn leftward(&self, dir: DVec3) -> DVec3 {
        (self.normal - dir * dir.dot(self.normal)).normalize_or_zero()
    }

    /// Its length as an angle.
    fn length_rad(&self) -> f64 {
        angle_of((self.b - self.a).length_squared())
    }
}

/// A number that grows with the distance, by the squared chord: the squared sine up to a right angle.
#[inline(always)]
pub(super) fn order_of(chord2: f64) -> f64 {
    if chord2 < 2.0 { chord2 * (1.0 - 0.25 * chord2) } else { chord2 - 1.0 }
}

/// The angle of a chord by its squared length.
pub(super) fn angle_of(chord2: f64) -> f64 {
    2.0 * libm::asin((0.5 * chord2.sqrt()).min(1.0))
}

/// The unit tangent at a direction that points away from another one; zero where they are the same.
pub(super) fn away(dir: DVec3, from: DVec3) -> DVec3 {
    let apart = dir - from;
    (apart - dir * dir.dot(apart)).normalize_or_zero()
}

/// The places of a stamp and of its copies. A copy lies anywhere within the spread with equal chance, or as dense as
/// the share of a mask; the number of copies above a size falls with its square.
pub(super) fn places(edit: &GroundEdit, radius_m: f64, scatter: Option<ShareAt<'_>>) -> Vec<Arc> {
    let spread_rad = (edit.spread_km * 1000.0 / radius_m).min(std::f64::consts::PI);
    let place = |at: DVec3, point: &EditPoint| {
        let (widths, strengths) = ([point.width; 2], [point.strength; 2]);
        Arc { widths, strengths, ..Arc::new(at, at, [0.0; 2]) }
    };
    if edit.copies <= 1 {
        return edit.points.0.iter().map(|point| place(point.direction(), point)).collect();
    }
    let middles: Vec<DVec3> = edit.points.0.iter().map(EditPoint::direction).collect();
    let copies: Vec<StampCopy> = (0..middles.len())
        .flat_map(|point| (0..edit.copies).map(move |copy| (point, copy)))
        .map(|(point, copy)| StampCopy::new(edit.seed, point, copy))
        .collect();
    let mut at: Vec<Option<DVec3>> = vec![None; copies.len()];
    let mut left: Vec<usize> = (0..copies.len()).collect();
    for number in 0..if scatter.is_some() { TRIES } else { 1 } {
        let tried: Vec<DVec3> =
            left.iter().map(|&i| copies[i].try_within(spread_rad, middles[copies[i].point], number)).collect();
        let shares = scatter.map(|scatter| scatter(&tried));
        let mut place = 0..tried.len();
        left.retain(|&i| {
            let Some(place) = place.next() else { return true };
            let stays = shares.as_ref().is_none_or(|shares| copies[i].random(CHANCE + number) < shares[place]);
            at[i] = stays.then_some(tried[place]);
            !stays
        });
        if left.is_empty() {
            break;
        }
    }
    let lies = |(copy, at): (&StampCopy, Option<DVec3>)| {
        let least = edit.smallest;
        let scale = least / (1.0 - copy.random(3) * (1.0 - least * least)).sqrt();
        Some(Arc { scale, turned: 2.0 * copy.random(4) - 1.0, ..place(at?, &edit.points.0[copy.point]) })
    };
    copies.iter().zip(at).filter_map(lies).collect()
}

/// A copy of a stamp around one of its points.
struct StampCopy {
    point: usize,
    seed: u64,
}

impl StampCopy {
    fn new(seed: u32, point: usize, copy: u32) -> Self {
        Self { point, seed: mix(u64::from(seed) << 32 | u64::from(copy)).wrapping_add(mix(point as u64)) }
    }

    /// A random number from 0 to 1.
    fn random(&self, number: u64) -> f64 {
        (mix(self.seed.wrapping_add(number)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// A place within an angle of a direction, one of many. Equal areas have equal chance.
    fn try_within(&self, spread_rad: f64, middle: DVec3, number: u64) -> DVec3 {
        let first = if number == 0 { 1 } else { MORE + 2 * number };
        let cosine = 1.0 - self.random(first) * (1.0 - libm::cos(spread_rad));
        let (sine, turn) = ((1.0 - cosine * cosine).max(0.0).sqrt(), self.random(first + 1) * std::f64::consts::TAU);
        let (east, north) = east_north(middle);
        (middle * cosine + (east * libm::cos(turn) + north * libm::sin(turn)) * sine).normalize()
    }
}

/// The arcs of the curve through points, for an edit of this radius.
pub(super) fn arcs(points: &[EditPoint], radius_rad: f64) -> Vec<Arc> {
    let numbers = |point: &EditPoint| [point.height_m, point.width, point.strength];
    let mut places: Vec<(DVec3, [f64; 3])> = points.iter().map(|point| (point.direction(), numbers(point))).collect();
    places.dedup_by(|a, b| a.0 == b.0);
    let arc = |a: DVec3, b: DVec3, [from, to]: [[f64; 3]; 2]| {
        let [heights_m, widths, strengths] = std::array::from_fn(|i| [from[i], to[i]]);
        Arc { widths, strengths, ..Arc::new(a, b, heights_m) }
    };
    if let [(at, numbers)] = places[..] {
        return vec![arc(at, at, [numbers; 2])];
    }
    let length = |i: usize| places[i].0.distance(places[i + 1].0);
    // The direction of the curve at a point, per length of chord.
    let tangent = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(places.len() - 1));
        let span: f64 = (before..after).map(length).sum();
        (places[after].0 - places[before].0) / span
    };
    let mut arcs = Vec::new();
    for i in 0..places.len().saturating_sub(1) {
        let ((p, from_numbers), (q, to_numbers)) = (places[i], places[i + 1]);
        let (from, to) = (tangent(i) * length(i), tangent(i + 1) * length(i));
        let at = |u: f64| {
            let (u2, u3) = (u * u, u * u * u);
            let curve = p * (2.0 * u3 - 3.0 * u2 + 1.0)
                + from * (u3 - 2.0 * u2 + u)
                + q * (3.0 * u2 - 2.0 * u3)
                + to * (u3 - u2);
            curve.normalize()
        };
        let bend = at(0.5).distance((p + q).normalize());
        let count = (bend / (TOLERANCE * radius_rad)).sqrt().ceil().clamp(1.0, MOST_ARCS) as u32;
        let mut last = p;
        for k in 1..=count {
            let share = |k: u32| f64::from(k) / f64::from(count);
            let next = if k == count { q } else { at(share(k)) };
            let at = |u: f64| std::array::from_fn(|i| from_numbers[i] + (to_numbers[i] - from_numbers[i]) * u);
            arcs.push(arc(last, next, [at(share(k - 1)), at(share(k))]));
            last = next;
        }
    }
    arcs
}

/// Adds the images of arcs by symmetry, each behind the other. `has_sides`: what is on the left of a line stays there
/// in its mirror image.
pub(super) fn add_images(arcs: &mut Vec<Arc>, edit: &GroundEdit, has_sides: bool) {
    let own = arcs.clone();
    for image in edit.images() {
        let begin = arcs.len();
        arcs.extend(own.iter().map(|arc| {
            let ([a, b], [from, to]) = ([arc.a, arc.b].map(|end| image.of(end)), arc.values);
            let new = if has_sides && image.mirrored {
                let around = |[from, to]: [f64; 2]| [to, from];
                let (widths, strengths) = (around(arc.widths), around(arc.strengths));
                Arc { widths, strengths, ..Arc::new(b, a, [to, from]) }
            } else {
                Arc { widths: arc.widths, strengths: arc.strengths, ..Arc::new(a, b, [from, to]) }
            };
            Arc { scale: arc.scale, turned: arc.turned, flipped: image.mirrored, ..new }
        }));
        if has_sides && image.mirrored {
            arcs[begin..].reverse();
        }
    }
}

/// Gives each end of the arcs a value by its place on the line: its distances from the beginning and from the end, as
/// angles. Nothing is at the end of a closed line.
pub(super) fn set_values(arcs: &mut [Arc], value: impl Fn(f64, f64) -> f64) {
    let is_closed = arcs.len() > 1 && arcs.first().map(|arc| arc.a) == arcs.last().map(|arc| arc.b);
    let length_rad: f64 = arcs.iter().map(Arc::length_rad).sum();
    let mut along_rad = 0.0;
    for arc in arcs {
        let next_rad = along_rad + arc.length_rad();
        let at = |along_rad: f64| match is_closed {
            true => value(f64::INFINITY, f64::INFINITY),
            false => value(along_rad, (length_rad - along_rad).max(0.0)),
        };
        arc.values = [at(along_rad), at(next_rad)];
        along_rad = next_rad;
    }
}
