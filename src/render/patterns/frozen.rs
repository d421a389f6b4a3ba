//! Snow and ice.

use super::canvas::{Spot, between, each, grain, tinted};
use super::noise::{Cells, Drawn, Fractal, Texel, Warp, step};
use std::f32::consts::TAU;

/// Powder with soft drifts.
pub(super) fn snow() -> Vec<Spot> {
    let (warp, drifts, cuts, lumps) =
        (Warp::new(2, 0.10, 71), Fractal::new(3, 5, 72), Fractal::new(2, 3, 73), Drawn::new(30, 3, 76));
    each(|at| {
        let [u, v] = warp.at(at);
        let drawn = drifts.at([u, v * 2.0]);
        let crust = step(0.55, 0.95, 1.0 - cuts.at([v, u * 3.0]).abs() * 1.6);
        let grains = grain(at, 74);
        let sparkle = step(0.97, 1.0, grain(at, 75));
        Spot {
            height: 0.018 * drawn + 0.006 * crust + 0.003 * lumps.at(at) + 0.0003 * grains,
            tint: tinted(
                [1.0 - 0.014 * drawn, 1.0, 1.0 + 0.012 * drawn],
                1.0 + 0.05 * drawn + 0.03 * crust + 0.018 * grains + 0.012 * lumps.at(at),
            ),
            roughness: -0.35 * sparkle - 0.1 * crust,
            glow: 0.0,
        }
    })
}

/// Plates of hard snow whose edges the wind has undercut, with powder between.
pub(super) fn crust() -> Vec<Spot> {
    let (bend, plates, cover) = (Warp::new(6, 0.05, 401), Cells::new(5, 402), Drawn::new(3, 4, 403));
    let (scour, lumps, powder) = (Warp::new(5, 0.03, 404), Drawn::new(24, 4, 405), Drawn::new(8, 4, 406));
    each(|at| {
        let plate = plates.at(bend.at(at));
        let [u, v] = scour.at(at);
        let ridges = (TAU * (9.0 * v + 1.0 * u)).sin();
        let eaten = plate.border() - 0.10 * (0.5 - cover.at(at));
        let slab = step(0.0, 0.09, eaten) * f32::from(plate.own[0] > 0.35);
        let rim = step(0.16, 0.02, eaten) * slab;
        let grains = grain(at, 407);
        let light = 0.98 + 0.05 * slab + 0.03 * rim + 0.02 * ridges * slab + 0.03 * powder.at(at) + 0.016 * grains;
        Spot {
            height: 0.013 * slab
                + 0.003 * rim
                + 0.0022 * ridges * slab
                + 0.009 * powder.at(at) * (1.0 - slab)
                + 0.0016 * lumps.at(at),
            tint: tinted([0.995, 1.0, 1.01], light),
            roughness: -0.22 * slab + 0.05,
            glow: 0.0,
        }
    })
}

/// Ridges that the wind has carved, with steep noses against it.
pub(super) fn sastrugi() -> Vec<Spot> {
    let (bend, wobble) = (Warp::new(2, 0.05, 411), Warp::new(8, 0.012, 412));
    let (layers, lumps) = (Fractal::new(2, 4, 413), Drawn::new(26, 4, 414));
    let tongues = [(5, 415), (9, 416), (16, 417)].map(|(period, seed)| (period as f32, Cells::new(period, seed)));
    each(|at| {
        let ([u, v], [wu, wv]) = (bend.at(at), wobble.at(at));
        let (x, y) = (u + wu - at.at[0], v + wv - at.at[1]);
        let mut height = 0.010 * layers.at([x, 3.0 * y]);
        let mut edge = 0.0_f32;
        for (period, cells) in &tongues {
            // Cells are drawn out along the wind: a steep nose, a long tail.
            let cell = cells.at([x, y * 3.0]);
            let [along, aside] = cell.from;
            let nose = step(-0.42, -0.34, along);
            let tail = step(0.62, -0.30, along);
            let flank = (1.0 - (aside / (0.42 - 0.22 * along)).powi(2)).max(0.0);
            let tongue = nose * tail * flank * f32::from(cell.own[0] < 0.75);
            height += 0.06 / period * tongue * (0.5 + cell.own[1]);
            edge = edge.max(nose * (1.0 - nose) * 4.0 * flank);
        }
        let grains = grain(at, 418);
        let light = 0.98 + 2.2 * height.min(0.03) + 0.015 * grains + 0.012 * lumps.at(at) - 0.05 * edge;
        Spot {
            height: height + 0.0012 * lumps.at(at),
            tint: tinted([0.995, 1.0, 1.008], light),
            roughness: -0.12 * step(0.0, 0.02, height),
            glow: 0.0,
        }
    })
}

/// Old snow that the sun has melted into cups, with dirt on the rims.
pub(super) fn firn() -> Vec<Spot> {
    let (bend, cups, small) = (Warp::new(9, 0.02, 421), Cells::new(7, 422), Cells::new(15, 423));
    let (dirt, lumps, coarse) = (Drawn::new(4, 5, 424), Drawn::new(36, 3, 425), Cells::new(80, 426));
    each(|at| {
        let bent = bend.at(at);
        let (cup, inner) = (cups.at(bent), small.at(bent));
        // A cup is a bowl between sharp rims.
        let bowl = (cup.nearest * cup.nearest).min(1.2);
        let dent = (inner.nearest * inner.nearest).min(1.2);
        let height = 0.042 * bowl + 0.012 * dent + 0.0015 * lumps.at(at);
        let soot = step(0.45, 1.0, bowl) * step(-0.3, 0.6, dirt.at(at)) * (0.6 + 0.4 * grain(at, 427));
        let kernel = coarse.at(at.at);
        let light = 0.96 + 0.06 * bowl + 0.05 * (kernel.own[0] - 0.5) + 0.016 * grain(at, 428);
        Spot {
            height: height + 0.0010 * (1.0 - kernel.nearest).max(0.0),
            tint: between(tinted([0.985, 1.0, 1.015], light), [0.62, 0.58, 0.54], 0.38 * soot.max(0.0)),
            roughness: -0.12 * kernel.own[1],
            glow: 0.0,
        }
    })
}

/// Lines where ice is broken.
fn cracks(period: usize, width: f32, seed: u32) -> impl Fn(Texel) -> f32 {
    let (warp, cells) = (Warp::new(period + 1, 0.22 / period as f32, seed + 3), Cells::new(period, seed));
    move |at: Texel| {
        let cell = cells.at(warp.at(at));
        1.0 - step(0.0, width * (0.4 + cell.own[0]), cell.border())
    }
}

pub(super) fn ice() -> Vec<Spot> {
    let (wide, fine, some) = (cracks(3, 0.030, 81), cracks(8, 0.026, 82), Drawn::new(3, 2, 83));
    let (warp, clouds, foam, waves) =
        (Warp::new(4, 0.16, 84), Fractal::new(4, 6, 85), Drawn::new(40, 3, 86), Drawn::new(3, 4, 87));
    each(|at| {
        let (wide, fine) = (wide(at), fine(at) * step(-0.1, 0.4, some.at(at)));
        let cloudy = step(-0.55, 0.65, clouds.at(warp.at(at)));
        let bubbles = step(0.5, 0.8, foam.at(at)) * cloudy;
        let white = (0.75 * wide + 0.4 * fine + 0.3 * bubbles).min(1.0);
        let light = 0.78 + 0.28 * cloudy + 0.32 * white;
        Spot {
            height: 0.006 * waves.at(at) + 0.003 * cloudy - 0.003 * wide - 0.001 * fine,
            tint: [light * (0.90 + 0.10 * cloudy + 0.06 * white), light, light * (1.04 - 0.04 * cloudy)],
            roughness: 0.22 * cloudy + 0.3 * white - 0.12,
            glow: 0.0,
        }
    })
}

/// Clear ice with white sheets of cracks in its depth, trains of bubbles and holes that dust has melted.
pub(super) fn blue_ice() -> Vec<Spot> {
    let (wide, fine, hair) = (cracks(2, 0.045, 431), cracks(5, 0.022, 432), cracks(13, 0.020, 433));
    let (some, depth, scallops) = (Drawn::new(3, 3, 434), Drawn::new(3, 5, 435), Cells::new(12, 436));
    let (bubbles, holes, clear) = (Cells::new(70, 437), Cells::new(9, 438), Drawn::new(5, 4, 439));
    let bend = Warp::new(10, 0.02, 440);
    each(|at| {
        let shown = some.at(at);
        let (wide, fine) = (wide(at), fine(at) * step(-0.2, 0.3, shown));
        let hair = hair(at) * step(0.0, 0.5, -shown);
        let bubble = bubbles.at(at.at);
        let train = step(0.36, 0.16, bubble.nearest) * f32::from(bubble.own[0] < 0.5) * step(0.05, 0.5, clear.at(at));
        let hole = holes.at(at.at);
        let r = hole.nearest / (0.05 + 0.10 * hole.own[1]);
        let melted = f32::from(hole.own[0] < 0.12) * step(1.0, 0.7, r);
        let cup = scallops.at(bend.at(at));
        let bowl = 1.0 - step(0.0, 0.55, cup.border());
        let white = (0.55 * wide + 0.42 * fine + 0.3 * hair + 0.35 * train).min(1.0);
        let deep = 0.5 - 0.5 * depth.at(at);
        let color = between([0.86, 1.0, 1.06], [1.12, 1.02, 0.96], white);
        let light = 0.86 + 0.22 * (1.0 - deep) + 0.42 * white;
        Spot {
            height: 0.004 * bowl - 0.010 * melted - 0.0015 * fine - 0.003 * wide,
            tint: between(tinted(color, light), [0.5, 0.48, 0.46], 0.75 * melted),
            roughness: 0.3 * white - 0.16,
            glow: 0.0,
        }
    })
}
