//! The patterns of the ground: for each [`Detail`] a function that draws a square texture which tiles without a seam.

use super::material_noise::{Cells, Drawn, Fractal, SIDE, Texel, Warp, hash, step};
use crate::planet::Detail;
use rayon::prelude::*;
use std::f32::consts::TAU;

/// One texel of a pattern.
#[derive(Clone, Copy, Default)]
pub(super) struct Spot {
    /// Height as a share of the pattern's side length.
    pub(super) height: f32,
    /// Factor on the albedo of the biome.
    pub(super) tint: [f32; 3],
    /// Added to the biome's roughness.
    pub(super) roughness: f32,
    /// Share of the biome's glow.
    pub(super) glow: f32,
}

/// The kinds that have a pattern, in the order of their texture layers.
pub(super) const KINDS: [Detail; 10] = [
    Detail::Grass,
    Detail::Litter,
    Detail::Sand,
    Detail::Gravel,
    Detail::Rock,
    Detail::Snow,
    Detail::Ice,
    Detail::Mud,
    Detail::Lava,
    Detail::Regolith,
];

/// Texture layer of a kind.
pub(super) fn layer(kind: Detail) -> Option<usize> {
    KINDS.iter().position(|known| *known == kind)
}

/// Draws a pattern, row by row.
pub(super) fn draw(kind: Detail) -> Vec<Spot> {
    match kind {
        Detail::None => vec![Spot { tint: [1.0; 3], ..Spot::default() }; SIDE * SIDE],
        Detail::Grass => grass(),
        Detail::Litter => litter(),
        Detail::Sand => sand(),
        Detail::Gravel => gravel(),
        Detail::Regolith => regolith(),
        Detail::Rock => rock(),
        Detail::Snow => snow(),
        Detail::Ice => ice(),
        Detail::Mud => mud(),
        Detail::Lava => lava(),
    }
}

fn each(spot: impl Fn(Texel) -> Spot + Sync) -> Vec<Spot> {
    (0..SIDE * SIDE).into_par_iter().with_min_len(16 * SIDE).map(|i| spot(Texel::new(i))).collect()
}

fn grey(light: f32) -> [f32; 3] {
    [light; 3]
}

fn tinted([r, g, b]: [f32; 3], light: f32) -> [f32; 3] {
    [r * light, g * light, b * light]
}

/// Noise of the texel alone, -1..1.
fn grain(texel: Texel, seed: u32) -> f32 {
    2.0 * hash([(texel.index % SIDE) as u32, (texel.index / SIDE) as u32], seed)[0] - 1.0
}

/// Draws a stroke into the pattern, wrapping at the borders. `spot` gets the position relative to the middle of the
/// stroke in texels. Its texel replaces the pattern's where it is higher.
fn stamp(canvas: &mut [Spot], middle: [f32; 2], reach: f32, spot: impl Fn(f32, f32) -> Option<Spot>) {
    let (side, [x0, y0]) = (SIDE as i32, middle.map(|w| w * SIDE as f32));
    let range = |c: f32| (c - reach).floor() as i32..=(c + reach).ceil() as i32;
    for y in range(y0) {
        for x in range(x0) {
            if let Some(new) = spot(x as f32 + 0.5 - x0, y as f32 + 0.5 - y0) {
                let old = &mut canvas[(y.rem_euclid(side) * side + x.rem_euclid(side)) as usize];
                if new.height > old.height {
                    *old = new;
                }
            }
        }
    }
}

/// Random numbers of a stroke, 0..1.
fn dice(number: u32, seed: u32) -> [f32; 6] {
    let ([a, b, c], [d, e, f]) = (hash([number, 1], seed), hash([number, 2], seed));
    [a, b, c, d, e, f]
}

fn grass() -> Vec<Spot> {
    let lumps = Drawn::new(20, 1, 1);
    let mut canvas = each(|at| Spot {
        height: 0.01 * (1.0 + lumps.at(at)),
        tint: tinted([0.62, 0.42, 0.40], 0.75 + 0.25 * grain(at, 2)),
        roughness: 0.05,
        glow: 0.0,
    });
    let (leans, tufts) = (Fractal::new(4, 2, 12), Fractal::new(7, 2, 13));
    for number in 0..5200 {
        let [x, y, turn, long, hue, dry] = dice(number, 11);
        // Blades of a tuft lean together.
        let lean = TAU * (leans.at([x, y]) + 0.16 * (turn - 0.5));
        let tuft = step(-0.5, 0.45, tufts.at([x, y]));
        let length = (6.0 + 15.0 * long) * (0.45 + 0.55 * tuft);
        let (sin, cos) = lean.sin_cos();
        let color = if dry > 0.84 { [1.75, 1.15, 1.1] } else { [0.72 + 0.55 * hue, 1.0, 0.55 + 0.5 * hue] };
        let shade = 0.75 + 0.5 * hue;
        stamp(&mut canvas, [x, y], 0.5 * length + 1.0, |dx, dy| {
            let (along, across) = ((dx * cos + dy * sin) / length + 0.5, dy * cos - dx * sin);
            // A blade narrows from root to tip and bends to one side.
            let bent = across - (turn - 0.5) * 5.0 * along * along;
            let width = 1.1 * (1.0 - 0.75 * along);
            let inside = (0.0..1.0).contains(&along) && bent.abs() < width;
            inside.then(|| {
                let light = shade * (0.5 + 0.85 * along) * (1.0 - 0.22 * (bent / width).powi(2));
                let height = (0.012 + 0.06 * along * (1.0 - 0.4 * along)) * (0.6 + 0.4 * tuft);
                Spot { height, tint: tinted(color, light), roughness: -0.12 * along, glow: 0.0 }
            })
        });
    }
    canvas
}

fn litter() -> Vec<Spot> {
    let lumps = Drawn::new(16, 1, 21);
    let mut canvas = each(|at| Spot {
        height: 0.004 * (1.0 + lumps.at(at)),
        tint: tinted([0.75, 0.5, 0.45], 0.55 + 0.2 * grain(at, 22)),
        roughness: 0.05,
        glow: 0.0,
    });
    for number in 0..1500 {
        let [x, y, turn, size, hue, lift] = dice(number, 23);
        let (sin, cos) = (TAU * turn).sin_cos();
        let twig = number % 30 == 0;
        let (length, width) = if twig { (14.0 + 22.0 * size, 1.2) } else { (4.0 + 5.5 * size, 1.9 + 2.3 * hue) };
        let color = match (hue * 6.0) as u32 {
            0 => [0.8, 1.15, 0.6],
            1 => [1.75, 1.05, 0.7],
            2 => [1.4, 0.95, 0.75],
            3 => [1.1, 0.9, 0.75],
            4 => [0.95, 1.05, 0.65],
            _ => [0.85, 0.9, 0.7],
        };
        let light = 0.5 + 0.85 * lift;
        stamp(&mut canvas, [x, y], length + 1.0, |dx, dy| {
            let (along, across) = ((dx * cos + dy * sin) / length, (dy * cos - dx * sin) / width);
            // A leaf is pointed at both ends and folded along its rib.
            let edge = if twig { 1.0 } else { 1.0 - along * along };
            let inside = along.abs() < 1.0 && across.abs() < edge;
            inside.then(|| {
                let fold = 1.0 - across.abs() / edge.max(1e-3);
                let rib = if !twig && across.abs() < 0.16 { 0.85 } else { 1.0 };
                let bow = if twig { 0.012 } else { 0.004 * along * (turn - 0.5) };
                let height = 0.006 + 0.02 * lift + 0.006 * fold + bow;
                Spot { height, tint: tinted(color, light * rib * (0.8 + 0.2 * fold)), roughness: -0.08, glow: 0.0 }
            })
        });
    }
    canvas
}

fn sand() -> Vec<Spot> {
    let (warp, strong, lumps) = (Warp::new(3, 0.055, 31), Drawn::new(2, 3, 33), Drawn::new(24, 3, 36));
    each(|at| {
        let [u, v] = warp.at(at);
        // Ripples rise gently on the windward side and fall steeply on the leeward side; their strength varies.
        let phase = (11.0 * v + 2.0 * u).rem_euclid(1.0);
        let ripple = if phase < 0.68 { step(0.0, 0.68, phase) } else { 1.0 - step(0.68, 1.0, phase) };
        let strength = 0.55 + 0.45 * strong.at(at);
        let grains = grain(at, 34);
        let dark = step(0.86, 1.0, grain(at, 35));
        Spot {
            height: 0.009 * ripple * strength + 0.004 * lumps.at(at) + 0.0006 * grains,
            tint: tinted([1.0, 0.985, 0.96], 1.0 + 0.10 * (ripple - 0.5) * strength + 0.085 * grains - 0.3 * dark),
            roughness: -0.1 * dark,
            glow: 0.0,
        }
    })
}

fn gravel() -> Vec<Spot> {
    let (lumps, stains, grit) = (Drawn::new(10, 4, 42), Drawn::new(20, 3, 43), Drawn::new(48, 2, 48));
    // Large stones are rare, small ones lie everywhere.
    let sizes = [(38, 0.6, 44), (21, 0.45, 45), (11, 0.3, 46), (6, 0.22, 47)].map(|(period, share, seed)| {
        (period as f32, share, Warp::new(period, 0.16 / period as f32, seed + 50), Cells::new(period, seed))
    });
    each(|at| {
        let grains = grain(at, 41);
        let mut spot = Spot {
            height: 0.004 * lumps.at(at) + 0.001 * grains,
            tint: grey(0.78 + 0.16 * grains + 0.12 * stains.at(at)),
            roughness: 0.04,
            glow: 0.0,
        };
        for (period, share, warp, cells) in &sizes {
            let cell = cells.at(warp.at(at));
            let [size, tone, warm] = cell.own;
            if size > *share {
                continue;
            }
            let radius = 0.30 + 0.5 * tone * (1.0 - size);
            if cell.nearest >= radius {
                continue;
            }
            let inside = (cell.border() / 0.12).min((radius - cell.nearest) / (0.7 * radius));
            if inside > 0.0 {
                let dome = inside.min(1.0) * (2.0 - inside.min(1.0));
                let height = (0.006 + 0.32 * dome.sqrt() * radius / period) * 0.8;
                if height > spot.height {
                    let light = (0.66 + 0.75 * tone) * (0.74 + 0.26 * dome) * (1.0 + 0.10 * grit.at(at));
                    let color = [1.0 + 0.10 * (warm - 0.5), 1.0, 1.0 - 0.16 * (warm - 0.5)];
                    spot = Spot { height, tint: tinted(color, light), roughness: -0.08 - 0.1 * tone, glow: 0.0 };
                }
            }
        }
        spot
    })
}

fn regolith() -> Vec<Spot> {
    let (swells, clods, crumbs) = (Drawn::new(3, 4, 91), Drawn::new(26, 3, 92), Cells::new(46, 93));
    // Craters of three sizes, the fewer the larger.
    let sizes = [(4, 0.45, 94), (9, 0.5, 95), (20, 0.55, 96)].map(|(period, share, seed)| {
        (period as f32, share, Warp::new(period, 0.10 / period as f32, seed + 50), Cells::new(period, seed))
    });
    each(|at| {
        let grains = grain(at, 97);
        let mut height = 0.014 * swells.at(at) + 0.0035 * clods.at(at) + 0.0008 * grains;
        let mut light = 1.0 + 0.05 * grains + 0.05 * clods.at(at);
        for (period, share, warp, cells) in &sizes {
            let cell = cells.at(warp.at(at));
            let [rare, width, age] = cell.own;
            if rare > *share {
                continue;
            }
            // A bowl with a raised rim; old ones are filled.
            let radius = 0.14 + 0.2 * width;
            let r = cell.nearest / radius;
            let fresh = 0.25 + 0.75 * age;
            let bowl = (r * r - 1.0).min(0.0);
            let rim = (-((r - 1.05) / 0.28).powi(2)).exp();
            height += fresh * radius / period * (0.30 * bowl + 0.09 * rim);
            light += fresh * (0.06 * rim + 0.05 * bowl);
        }
        let crumb = crumbs.at(at.at);
        let [rare, width, tone] = crumb.own;
        let inside = 1.0 - crumb.nearest / (0.12 + 0.26 * width);
        if rare < 0.16 && inside > 0.0 {
            height += 0.007 * inside.sqrt() * (0.4 + width);
            light *= 0.82 + 0.36 * tone;
        }
        Spot { height, tint: grey(light), roughness: 0.05, glow: 0.0 }
    })
}

fn rock() -> Vec<Spot> {
    let (bend, bend_chips) = (Warp::new(3, 0.07, 61), Warp::new(6, 0.05, 63));
    let (slabs, chips) = (Cells::new(4, 62), Cells::new(11, 64));
    let (rough, layers, growth) = (Drawn::new(6, 6, 66), Drawn::new(5, 3, 65), Drawn::new(5, 4, 67));
    let (open, specks) = (Drawn::new(3, 2, 70), Drawn::new(40, 1, 68));
    let tilt = |own: [f32; 3], [x, y]: [f32; 2]| (own[0] - 0.5) * x + (own[1] - 0.5) * y;
    each(|at| {
        let bent = bend.at(at);
        let (slab, chip) = (slabs.at(bent), chips.at(bend_chips.at(at)));
        // Some joints gape; most are mere edges between two faces.
        let gape = step(-0.1, 0.6, open.at(at));
        let crack = (1.0 - step(0.0, 0.015 + 0.05 * gape, slab.border())) * (0.35 + 0.65 * gape);
        let split = (1.0 - step(0.0, 0.06, chip.border())) * step(0.45, 0.75, chip.own[2]);
        let strata = (TAU * (7.0 * bent[1] + 2.0 * bent[0] + 0.5 * layers.at(at))).sin();
        let rough = rough.at(at);
        let lichen = step(0.25, 0.55, growth.at(at)) * step(-0.3, 0.3, specks.at(at));
        let light = 0.92 + 0.34 * (slab.own[2] - 0.5) + 0.18 * (chip.own[0] - 0.5) + 0.06 * strata + 0.3 * rough;
        let worn = light * (1.0 - 0.5 * crack) * (1.0 - 0.35 * split) * (1.0 + 0.05 * grain(at, 69));
        let color = [1.0 + 0.1 * (slab.own[0] - 0.5), 1.0, 1.0 - 0.08 * (slab.own[1] - 0.5)];
        let patch = [1.12, 1.16, 0.86];
        Spot {
            height: 0.075 * tilt(slab.own, slab.from) + 0.03 * tilt(chip.own, chip.from) + 0.03 * slab.own[2]
                - 0.025 * crack
                - 0.012 * split
                + 0.006 * strata
                + 0.034 * rough,
            tint: std::array::from_fn(|i| worn * (color[i] + (patch[i] - color[i]) * 0.6 * lichen)),
            roughness: 0.1 * lichen - 0.06 * rough,
            glow: 0.0,
        }
    })
}

fn snow() -> Vec<Spot> {
    let (warp, drifts, cuts, lumps) =
        (Warp::new(2, 0.10, 71), Fractal::new(3, 4, 72), Fractal::new(2, 3, 73), Drawn::new(30, 2, 76));
    each(|at| {
        let [u, v] = warp.at(at);
        // Sastrugi: crests carved by the wind and elongated along it.
        let drawn = drifts.at([u, v * 2.0]);
        let crust = step(0.55, 0.95, 1.0 - cuts.at([v, u * 3.0]).abs() * 1.6);
        let grains = grain(at, 74);
        let sparkle = step(0.97, 1.0, grain(at, 75));
        Spot {
            height: 0.018 * drawn + 0.008 * crust + 0.003 * lumps.at(at) + 0.0004 * grains,
            tint: tinted(
                [1.0 - 0.014 * drawn, 1.0, 1.0 + 0.012 * drawn],
                1.0 + 0.05 * drawn + 0.035 * crust + 0.016 * grains,
            ),
            roughness: -0.35 * sparkle - 0.1 * crust,
            glow: 0.0,
        }
    })
}

fn ice() -> Vec<Spot> {
    let line = |period: usize, width: f32, seed: u32| {
        let (warp, cells) = (Warp::new(period + 1, 0.22 / period as f32, seed + 3), Cells::new(period, seed));
        move |at: Texel| {
            let cell = cells.at(warp.at(at));
            1.0 - step(0.0, width * (0.4 + cell.own[0]), cell.border())
        }
    };
    let (wide, fine, some) = (line(3, 0.035, 81), line(8, 0.03, 82), Drawn::new(3, 2, 83));
    let (warp, clouds, foam, waves) =
        (Warp::new(4, 0.16, 84), Fractal::new(4, 5, 85), Drawn::new(40, 2, 86), Drawn::new(3, 3, 87));
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

fn mud() -> Vec<Spot> {
    let (bend, bend_inner, rough) = (Warp::new(5, 0.05, 91), Warp::new(9, 0.03, 93), Drawn::new(18, 4, 95));
    let (plates, inner) = (Cells::new(5, 92), Cells::new(11, 94));
    each(|at| {
        let (plate, inner) = (plates.at(bend.at(at)), inner.at(bend_inner.at(at)));
        let border = plate.border();
        let gap = 1.0 - step(0.015, 0.075, border);
        let hair = (1.0 - step(0.0, 0.05, inner.border())) * step(0.3, 0.5, plate.own[1]);
        // Plates curl up at their edges as they dry.
        let curl = step(0.35, 0.06, border);
        let rough = rough.at(at);
        let light = 1.0 + 0.16 * (plate.own[0] - 0.5) + 0.10 * curl + 0.10 * rough + 0.04 * grain(at, 96);
        Spot {
            height: 0.022 * (1.0 - gap) + 0.012 * curl * (1.0 - gap) - 0.005 * hair + 0.004 * rough,
            tint: tinted([1.0, 1.0 - 0.03 * gap, 1.0 - 0.06 * gap], light * (1.0 - 0.6 * gap) * (1.0 - 0.25 * hair)),
            roughness: 0.05 - 0.45 * gap,
            glow: 0.0,
        }
    })
}

fn lava() -> Vec<Spot> {
    let (bend, bend_chips, fold) = (Warp::new(3, 0.09, 101), Warp::new(7, 0.05, 103), Warp::new(4, 0.07, 107));
    let (plates, chips, rough) = (Cells::new(4, 102), Cells::new(10, 104), Drawn::new(12, 5, 106));
    each(|at| {
        let (plate, chip) = (plates.at(bend.at(at)), chips.at(bend_chips.at(at)));
        let border = plate.border();
        // Ropes: folds across the flow, bowed on each plate.
        let ([x, y], [u, _]) = (plate.from, fold.at(at));
        let across = 3.4 * (x + 0.9 * y * y) + 5.0 * (u - at.at[0]) + plate.own[0];
        let ropes = (TAU * across).sin() * step(0.02, 0.3, border) * (0.4 + 0.6 * plate.own[1]);
        let rough = rough.at(at);
        let gap = 1.0 - step(0.0, 0.11, border + 0.07 * rough);
        let vein = (1.0 - step(0.0, 0.06, chip.border())) * step(0.5, 0.8, plate.own[2]);
        let hot = (gap + 0.5 * vein).min(1.0);
        let light = 0.9 + 0.35 * (plate.own[0] - 0.5) + 0.2 * ropes + 0.35 * rough;
        Spot {
            height: 0.03 * (1.0 - gap) + 0.007 * ropes + 0.02 * rough - 0.01 * vein + 0.01 * plate.own[1],
            tint: grey(light.max(0.1) * (1.0 - 0.5 * hot)),
            roughness: -0.15 * step(0.2, 0.8, ropes) + 0.05,
            glow: (hot * hot * (0.85 + 0.3 * rough)).clamp(0.0, 1.0),
        }
    })
}
