//! What happens at the boundaries of plates: where plates part, meet, and sink.
//!
//! The boundary of two plates is a circle in bent directions, so the distance to it is a formula. Near a junction of
//! three plates the effects of two boundaries are blended.

use super::layout::{Layout, Plate};
use crate::planet::Plates as Params;
use crate::world::EARTH_KM;
use crate::world::noise::{bump, hash, noise, ramp};
use glam::DVec3;

/// Effects of all boundaries at a point. Distances are in km on a planet of the Earth's size.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Edges {
    /// Height by which rock is pushed up, in metres.
    pub(super) uplift_m: f64,
    /// Height added to the ground as it was before rivers: arcs above zero; trenches and rifts below.
    pub(super) ground_m: f64,
    /// The coast lies at most this far inside: the edge of the plate cuts its continent off.
    pub(super) coast_km: f64,
    /// Share of belts of folded rock, 0 to 1.
    pub(super) folded: f64,
    /// Unit tangent along the folds.
    pub(super) fold: DVec3,
    /// How strongly the boundary folds rock, at any distance, 0 to 1.
    pub(super) folds: f64,
    /// Distance to the nearest boundary.
    pub(super) edge_km: f64,
    /// Age of an ocean floor here, in million years.
    pub(super) floor_myr: f64,
}

/// No boundary cuts a continent off.
pub(super) const NO_EDGE_KM: f64 = 4000.0;

/// The oldest ocean floor, in million years.
const OLDEST_MYR: f64 = 180.0;

/// The boundary of a plate with another.
struct Border {
    other: usize,
    km: f64,
    /// Unit tangent that points away from the boundary.
    inward: DVec3,
    /// Speed at which the plates part, in mm a year; below zero where they meet.
    opening: f64,
    shear: f64,
}

/// The boundary of a plate with another, as far as it is the same everywhere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Side {
    other: usize,
    /// The unit direction from the middle of the other plate to that of this one, and how far the boundary is shifted.
    axis: DVec3,
    shift: f64,
    /// The motion of this plate against the other, about a pole.
    pole: DVec3,
}

impl Side {
    /// The sides of a plate. A plate that another covers whole has no boundary with it.
    pub(super) fn all(plates: &[Plate], plate: usize) -> Vec<Side> {
        let mine = &plates[plate];
        let side = |(other, theirs): (usize, &Plate)| {
            let between = mine.center - theirs.center;
            let length = between.length();
            let shift = (mine.weight - theirs.weight) / length;
            let is_side = other != plate && shift.abs() < 1.0;
            is_side.then(|| Side { other, axis: between * (1.0 / length), shift, pole: mine.pole - theirs.pole })
        };
        plates.iter().enumerate().filter_map(side).collect()
    }

    /// Distance from the boundary.
    fn km(&self, bent: DVec3) -> f64 {
        let along = bent.dot(self.axis);
        let mean = 0.5 * (along - self.shift);
        ((along + self.shift) / (1.0 - mean * mean).max(0.05).sqrt() * EARTH_KM).max(0.0)
    }

    fn border(&self, bent: DVec3, km: f64) -> Border {
        let tangent = self.axis - bent * bent.dot(self.axis);
        let inward = tangent * (1.0 / tangent.length().max(1e-9));
        let relative = self.pole.cross(bent);
        let opening = relative.dot(inward) * EARTH_KM;
        let shear = relative.dot(bent.cross(inward)).abs() * EARTH_KM;
        Border { other: self.other, km, inward, opening, shear }
    }
}

impl Layout {
    /// The effects of all boundaries of a plate at a direction, which is given as it is, bent, and bent in the home of
    /// the plate. `along` varies along them, about -1 to 1.
    pub(super) fn edges(&self, params: &Params, plate: usize, place: [DVec3; 3], along: f64) -> Edges {
        const BLEND_KM: f64 = 500.0;
        let [_, bent, _] = place;
        let sides = &self.sides[plate];
        let nearest_km = sides.iter().map(|side| side.km(bent)).fold(f64::MAX, f64::min);
        let nearest_km = if sides.is_empty() { NO_EDGE_KM } else { nearest_km };
        let mut sum = Edges { fold: bent.any_orthonormal_vector(), edge_km: nearest_km, ..Edges::default() };
        let (mut total, mut youngest, mut strongest) = (0.0, 1.0 / (OLDEST_MYR * OLDEST_MYR * OLDEST_MYR), 0.0);
        for side in sides {
            let km = side.km(bent);
            // Too far for a new ocean floor, and for a blend.
            if km >= 9000.0 && km >= nearest_km + BLEND_KM {
                continue;
            }
            let border = side.border(bent, km);
            if border.opening > 0.0 && border.km < 9000.0 {
                let myr = (border.km / (0.5 * border.opening)).max(0.3);
                youngest += 1.0 / (myr * myr * myr);
            }
            let near = 1.0 - (border.km - nearest_km) / BLEND_KM;
            if near <= 0.0 {
                continue;
            }
            let weight = near * near;
            let effect = self.effect(params, plate, place, &border, along);
            total += weight;
            sum.uplift_m += weight * effect.uplift_m;
            sum.ground_m += weight * effect.ground_m;
            sum.coast_km += weight * effect.coast_km;
            sum.folded += weight * effect.folded;
            sum.folds += weight * effect.folds;
            if weight * (0.01 + effect.folded) > strongest {
                strongest = weight * (0.01 + effect.folded);
                sum.fold = effect.fold;
            }
        }
        let share = 1.0 / f64::max(total, 1e-9);
        sum.uplift_m *= share;
        sum.ground_m *= share;
        sum.coast_km = if total > 0.0 { sum.coast_km * share } else { NO_EDGE_KM };
        sum.folded *= share;
        sum.folds *= share;
        sum.floor_myr = 1.0 / libm::cbrt(youngest);
        sum
    }

    /// The effect of one boundary. `along` varies along it, about -1 to 1.
    fn effect(&self, params: &Params, plate: usize, place: [DVec3; 3], border: &Border, along: f64) -> Edges {
        let Border { other, km, inward, opening, shear } = *border;
        // Whether there is land at the boundary, on this side and on the other.
        let [dir, bent, home] = place;
        let way = inward * (km / EARTH_KM);
        let at = |plate: usize, home: DVec3| (home - self.way_home(plate, way)).normalize();
        let (my_at, their_at) = (at(plate, home), at(other, self.home(other, dir, bent)));
        let my_coast_rad = self.coast_rad(my_at, 2);
        let their_coast_rad = if their_at == my_at { my_coast_rad } else { self.coast_rad(their_at, 2) };
        let is_land = |plate, at, coast_rad| ramp(-0.03, 0.05, self.even_crust_rad(plate, at) + coast_rad);
        let (mine, theirs) = (is_land(plate, my_at, my_coast_rad), is_land(other, their_at, their_coast_rad));
        let drift = params.drift_mm_yr;
        let (meets, parts) = (ramp(0.06, 0.7, -opening / drift), ramp(0.06, 0.7, opening / drift));
        let slides = ramp(0.2, 1.2, shear / drift) * (1.0 - meets) * (1.0 - parts);
        // Of two plates of one kind, a hash says which one stays above.
        let (low, high) = (plate.min(other) as u32, plate.max(other) as u32);
        let low_is_above = hash(hash(self.seed, low), high) & 1 == 0;
        let above = f64::from(u8::from((plate as u32 == low) == low_is_above));
        let varied = (1.0 + 0.45 * along).clamp(0.3, 1.6);

        // An ocean floor sinks under a continent: a belt behind the coast, a trench before it.
        let coast = meets * mine * (1.0 - theirs);
        let belt = params.belt_km * (0.8 + 0.3 * along).clamp(0.5, 1.3);
        let belt_at = ramp(90.0, 230.0, km)
            * (1.0 - 0.45 * ramp(260.0, 0.7 * belt + 120.0, km))
            * (1.0 - ramp(0.6 * belt + 100.0, belt + 200.0, km));
        let sinks = meets * (theirs * (1.0 - mine) + (1.0 - theirs) * (1.0 - mine) * (1.0 - above));
        // Two continents collide: a range along the boundary, a plateau behind it, a low foreland before it.
        let collision = meets * mine * theirs;
        let plateau = params.plateau_km * (0.75 + 0.5 * along).clamp(0.35, 1.3);
        let range = 1.0 - ramp(110.0, 330.0, km);
        let behind = 0.66 * (1.0 - ramp(plateau, plateau + 420.0, km));
        let before = 1.0 - ramp(20.0, 230.0, km);
        let collided = above * f64::max(range, behind) + (1.0 - above) * before;
        let foreland = collision * (1.0 - above) * bump(330.0, 260.0, km) + coast * bump(belt + 330.0, 260.0, km);
        // An ocean floor sinks under another: an arc of islands.
        let arc = meets * (1.0 - mine) * (1.0 - theirs) * above;
        let mut arc_at = bump(185.0, 130.0, km);
        if arc * arc_at > 0.0 {
            arc_at *= 0.42 + 0.58 * ramp(-0.25, 0.45, noise(bent * 21.0, hash(self.seed, 23)) + 0.4 * along);
        }
        // Two plates part: a rift in a continent, and an ocean once it has opened.
        let rift = parts * mine * theirs;
        let open_km = 520.0 * ramp(0.35, 1.4, opening / drift) * (1.0 + 0.4 * along);
        let opens = parts * (mine + theirs - mine * theirs) * ramp(0.3, 0.5, opening / drift);
        let shoulder = rift * bump(130.0, 120.0, km);
        let sheared = slides * mine * theirs * bump(0.0, 170.0, km);

        let strength = params.mountains_m * varied;
        Edges {
            uplift_m: strength * (0.86 * coast * belt_at + collision * collided + 0.16 * sheared + 0.25 * arc * arc_at)
                + params.rifts_m * 0.9 * shoulder,
            ground_m: params.arcs_m * varied.min(1.2) * arc * arc_at
                - params.trench_m * sinks * bump(35.0, 120.0, km)
                - params.rifts_m * rift * bump(0.0, 75.0, km)
                - 220.0 * foreland,
            coast_km: NO_EDGE_KM
                - coast * (NO_EDGE_KM - (km - 95.0)).max(0.0)
                - (1.0 - coast) * opens * (NO_EDGE_KM - (km - open_km)).max(0.0),
            folded: (coast * belt_at + collision * collided + 0.5 * sheared + arc * arc_at).min(1.0),
            folds: (coast + collision + 0.5 * slides * mine * theirs + arc).min(1.0),
            fold: bent.cross(inward).normalize_or(bent.any_orthonormal_vector()),
            ..Edges::default()
        }
    }
}
