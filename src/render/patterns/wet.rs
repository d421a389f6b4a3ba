//! Clay and salt: ground that water has left.

use super::canvas::{Spot, between, each, grain, tinted};
use super::noise::{Cells, Drawn, Warp, step};
use std::f32::consts::TAU;

/// Plates of dried mud with damp cracks.
pub(super) fn mud() -> Vec<Spot> {
    let (bend, bend_inner, rough) = (Warp::new(5, 0.05, 91), Warp::new(9, 0.03, 93), Drawn::new(18, 5, 95));
    let (plates, inner, stains) = (Cells::new(5, 92), Cells::new(11, 94), Drawn::new(3, 4, 97));
    each(|at| {
        let (plate, inner) = (plates.at(bend.at(at)), inner.at(bend_inner.at(at)));
        let border = plate.border();
        let gap = 1.0 - step(0.012, 0.060, border);
        let hair = (1.0 - step(0.0, 0.05, inner.border())) * step(0.3, 0.5, plate.own[1]);
        // Plates curl up at their edges as they dry.
        let curl = step(0.35, 0.06, border);
        let rough = rough.at(at);
        let light = 1.0
            + 0.16 * (plate.own[0] - 0.5)
            + 0.10 * curl
            + 0.10 * rough
            + 0.06 * stains.at(at)
            + 0.04 * grain(at, 96);
        Spot {
            height: 0.022 * (1.0 - gap) + 0.012 * curl * (1.0 - gap) - 0.005 * hair
                + 0.004 * rough
                + 0.006 * (plate.own[2] - 0.5),
            tint: tinted([1.0, 1.0 - 0.03 * gap, 1.0 - 0.06 * gap], light * (1.0 - 0.6 * gap) * (1.0 - 0.25 * hair)),
            roughness: 0.05 - 0.45 * gap,
            glow: 0.0,
        }
    })
}

/// Wet clay with puddles, runnels and ripples.
pub(super) fn wet_mud() -> Vec<Spot> {
    let (swells, lumps, bend) = (Drawn::new(3, 5, 501), Drawn::new(22, 4, 502), Warp::new(4, 0.05, 503));
    let (runnels, holes) = (Drawn::new(4, 4, 504), Cells::new(34, 505));
    each(|at| {
        let swell = swells.at(at);
        let puddle = step(-0.12, -0.24, swell);
        let shore = step(-0.02, -0.16, swell);
        let runnel = step(0.10, 0.0, runnels.at(at).abs()) * (1.0 - puddle);
        let [u, v] = bend.at(at);
        let ripple = (TAU * (13.0 * v + 3.0 * u)).sin() * (1.0 - shore) * step(0.5, 0.0, swell);
        let hole = holes.at(at.at);
        let r = hole.nearest / 0.16;
        let dug = f32::from(hole.own[0] < 0.14) * (1.0 - puddle);
        let cast = dug * (step(1.9, 1.0, r) - 1.6 * step(0.7, 0.4, r));
        let light = 1.06 - 0.12 * shore - 0.08 * puddle + 0.10 * lumps.at(at) * (1.0 - puddle) + 0.05 * ripple
            - 0.12 * runnel
            + 0.14 * cast
            + 0.04 * grain(at, 506);
        Spot {
            height: 0.022 * swell.max(-0.2)
                + 0.0022 * ripple
                + (0.003 * lumps.at(at) - 0.006 * runnel + 0.005 * cast) * (1.0 - puddle),
            tint: tinted(between([1.02, 1.0, 0.96], [0.94, 1.0, 1.02], puddle), light),
            roughness: 0.02 - 0.22 * shore - 0.2 * puddle - 0.1 * runnel,
            glow: 0.0,
        }
    })
}

/// Polygons of salt between ridges that press one another up.
pub(super) fn salt() -> Vec<Spot> {
    let (bend, cells, inner) = (Warp::new(4, 0.05, 511), Cells::new(4, 512), Cells::new(13, 513));
    let (bend_inner, bloom, grit, stains) =
        (Warp::new(9, 0.03, 514), Drawn::new(9, 5, 515), Drawn::new(50, 3, 516), Drawn::new(3, 4, 517));
    each(|at| {
        let (cell, blister) = (cells.at(bend.at(at)), inner.at(bend_inner.at(at)));
        let border = cell.border();
        let ridge = step(0.10, 0.0, border) * (0.7 + 0.5 * bloom.at(at));
        let split = step(0.022, 0.0, border);
        let dish = step(0.0, 0.35, border);
        let crackle = (1.0 - step(0.0, 0.05, blister.border())) * step(0.35, 0.7, cell.own[1]);
        let damp = step(0.1, 0.7, stains.at(at)) * dish;
        let light = 0.97 + 0.07 * ridge - 0.14 * split + 0.06 * bloom.at(at) + 0.05 * grit.at(at)
            - 0.10 * damp
            - 0.06 * crackle
            + 0.03 * grain(at, 518);
        Spot {
            height: 0.020 * ridge - 0.010 * split - 0.006 * dish
                + 0.003 * bloom.at(at)
                + 0.0014 * grit.at(at)
                + 0.003 * crackle,
            tint: tinted(between([1.0, 1.0, 1.0], [1.02, 0.97, 0.92], damp), light),
            roughness: 0.04 - 0.2 * damp,
            glow: 0.0,
        }
    })
}
