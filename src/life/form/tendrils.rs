//! Tendrils: strange plants that rise as tapering, twisting spirals and curl at their tips.

use super::build::{Detail, Look, Mesh};
use super::math::{GOLDEN, TURN, around, cos, mix, pow, turn};
use super::random::Random;
use super::tube::{self, Knot};
use crate::planet::life::Tendrils;
use glam::Vec3;

/// Middle line of a tendril with its thickness.
fn path(form: &Tendrils, index: u32, steps: usize, detail: &Detail) -> Vec<Knot> {
    let mut random = Random::new(detail.seed, 30 + index);
    let share = index as f32 / form.tendrils as f32;
    let angle = index as f32 * GOLDEN + random.signed() * 0.3;
    let length = if index == 0 { 1.6 } else { mix(1.2, 0.6, share) * random.range(0.85, 1.15) };
    let lean = form.spread as f32 * mix(0.15, 1.1, pow(share, 0.7)) * random.range(0.75, 1.15);
    let hand = if random.unit() < 0.5 { 1.0 } else { -1.0 };
    let curl = form.curl as f32 * TURN * random.range(0.75, 1.15);
    let twist = form.twist as f32 * TURN * random.range(0.8, 1.2);
    let thick = form.width as f32 * 0.42 * mix(1.0, 0.55, share) * detail.swell();
    let fine = 64;
    let mut at = around(angle) * (0.03 + form.width as f32 * 0.55 * pow(index as f32, 0.5)) - Vec3::Z * 0.08;
    let mut line = vec![at];
    for k in 0..fine {
        let s = (k as f32 + 0.5) / fine as f32;
        let out = around(angle + twist * s);
        // The tip turns faster and faster while its steps shrink: a coil that winds inward.
        let late = ((s - 0.34) / 0.66).max(0.0);
        let bow = lean * (0.35 + 1.1 * s - 0.7 * s * s) + curl * pow(late, 1.8) - 0.25 * lean * late;
        let way = turn(Vec3::Z, Vec3::Z.cross(out), bow);
        let aside = Vec3::Z.cross(out) * (hand * 0.28 * late);
        let step = length / fine as f32 * mix(1.25, 0.45, s);
        at += (way + aside).normalize_or(Vec3::Z) * step;
        line.push(at);
    }
    let knot = |i: usize| {
        // Knots crowd towards the coil.
        let s = pow(i as f32 / steps as f32, 0.85);
        let place = s * fine as f32;
        let k = (place as usize).min(fine - 1);
        let at = line[k] + (line[k + 1] - line[k]) * (place - k as f32);
        let foot = 1.0 + 0.5 * super::math::exp(-s / 0.04);
        let radius = thick * (pow(1.0 - s, 0.75) * 0.94 + 0.06) * foot;
        let light = mix(0.38, 1.0, pow(s, 0.6));
        Knot { at, radius, look: Look { part: pow(s, 1.6), light, sway: pow(s, 1.4) } }
    };
    (0..=steps).map(knot).collect()
}

/// Mesh of a group of tendrils.
pub(super) fn build(form: &Tendrils, detail: &Detail) -> Mesh {
    let mut mesh = Mesh::default();
    let count = form.tendrils.min(detail.pick([12, 12, 8, 3]));
    let each: usize = detail.pick([3990_usize, 695, 138, 28]) / count as usize;
    let sides = match each {
        0..=130 => 3,
        131..=420 => 5,
        421..=900 => 8,
        _ => 10,
    };
    let steps = ((each - sides) / (2 * sides) + 1).clamp(1, 60);
    for i in 0..count {
        let knots = path(form, i, steps, detail);
        let ridge = if sides >= 5 { 0.16 } else { 0.0 };
        // Ridges wind around the tendril.
        tube::fluted(&mut mesh, &knots, sides, |a, s| 1.0 + ridge * cos(2.0 * a + s * 26.0));
    }
    mesh
}
