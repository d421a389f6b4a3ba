//! Loose ground: soil, sands, stones, ash, regolith.

use super::canvas::{Heights, Spot, Stroke, between, dice, dome, each, grain, grey, tinted};
use super::noise::{Cell, Cells, Drawn, Scattered, Texel, Warp, step};
use std::f32::consts::TAU;

/// Stones of one size.
fn stones(period: usize, share: f32, seed: u32) -> Scattered {
    Scattered::new(period, share, (1, 0.16), seed)
}

/// Radius of the stone of a cell, in cells.
fn radius_of(stone: &Cell) -> f32 {
    let [size, tone, _] = stone.own;
    0.30 + 0.5 * tone * (1.0 - size)
}

/// The stone at a texel, and how far inside it lies, 0 at the rim to 1.
fn stone_at(stones: &Scattered, at: Texel) -> Option<(Cell, f32)> {
    let stone = stones.at(at)?;
    let radius = radius_of(&stone);
    let inside = (stone.border() / 0.12).min((radius - stone.nearest) / (0.7 * radius));
    (inside > 0.0).then(|| (stone, inside.min(1.0)))
}

/// Crumbs and clods of earth.
pub(super) fn soil() -> Vec<Spot> {
    let (swells, fine, stains) = (Drawn::new(4, 4, 231), Drawn::new(40, 4, 232), Drawn::new(5, 4, 233));
    let clods = [(9, 0.35, 234), (19, 0.5, 235), (37, 0.6, 236), (71, 0.7, 237)]
        .map(|(period, share, seed)| stones(period, share, seed));
    each(|at| {
        let mut height = 0.016 * swells.at(at) + 0.004 * fine.at(at);
        let mut light = 0.82 + 0.16 * fine.at(at) + 0.14 * stains.at(at) + 0.08 * grain(at, 238);
        for stones in &clods {
            if let Some((cell, inside)) = stone_at(stones, at) {
                let dome = dome(inside);
                height += 0.24 * dome / stones.period * (0.5 + cell.own[1]);
                light *= 0.86 + 0.22 * dome * (0.6 + 0.8 * cell.own[2]);
            }
        }
        Spot {
            height,
            tint: tinted(between([1.0; 3], [1.1, 0.96, 0.86], stains.at(at)), light),
            roughness: 0.06,
            glow: 0.0,
        }
    })
}

/// Sand in ripples of the wind.
pub(super) fn sand() -> Vec<Spot> {
    let (warp, strong, lumps) = (Warp::new(3, 0.055, 31), Drawn::new(2, 3, 33), Drawn::new(24, 4, 36));
    let (fork, drifts) = (Warp::new(9, 0.006, 37), Drawn::new(5, 4, 38));
    each(|at| {
        let ([u, v], [_, w]) = (warp.at(at), fork.at(at));
        // Ripples rise gently on the windward side and fall steeply on the leeward side; their strength varies.
        let phase = (11.0 * (v + w - at.at[1]) + 2.0 * u).rem_euclid(1.0);
        let ripple = if phase < 0.68 { step(0.0, 0.68, phase) } else { 1.0 - step(0.68, 1.0, phase) };
        let strength = (0.55 + 0.6 * strong.at(at)).max(0.12);
        let grains = grain(at, 34);
        let dark = step(0.86, 1.0, grain(at, 35));
        // Heavy dark grains gather in the troughs.
        let trough = (1.0 - ripple) * strength;
        let light = 1.0 + 0.16 * (ripple - 0.5) * strength + 0.08 * grains + 0.05 * drifts.at(at)
            - dark * (0.14 + 0.3 * trough);
        Spot {
            height: 0.0105 * ripple * strength + 0.003 * lumps.at(at) + 0.004 * drifts.at(at) + 0.0005 * grains,
            tint: tinted([1.0, 0.985 - 0.02 * trough, 0.96 - 0.04 * trough], light),
            roughness: -0.1 * dark,
            glow: 0.0,
        }
    })
}

/// Smooth sand with shells and pebbles, and lines that waves have left.
pub(super) fn beach() -> Vec<Spot> {
    let (hollows, lumps, damp) = (Drawn::new(6, 4, 241), Drawn::new(30, 4, 242), Drawn::new(2, 4, 243));
    let (lines, pits) = (Warp::new(3, 0.08, 244), Cells::new(26, 245));
    let mut canvas = each(|at| {
        let grains = grain(at, 246);
        let dark = step(0.88, 1.0, grain(at, 247));
        let wet = step(0.05, 0.6, damp.at(at));
        // Swash lines: a thin rim of grains and foam.
        let phase = (3.0 * lines.at(at)[1]).rem_euclid(1.0);
        let line = step(0.06, 0.0, phase) * step(-0.2, 0.3, hollows.at(at));
        let pit = pits.at(at.at);
        let hole = step(0.16, 0.05, pit.nearest) * f32::from(pit.own[0] < 0.12);
        let light = 1.0 + 0.08 * grains - 0.26 * dark - 0.22 * wet + 0.06 * lumps.at(at) - 0.12 * line - 0.45 * hole;
        Spot {
            height: 0.010 * hollows.at(at) + 0.0022 * lumps.at(at) + 0.0004 * grains + 0.0025 * line - 0.004 * hole,
            tint: tinted(between([1.02, 1.0, 0.96], [1.0, 0.95, 0.88], wet), light),
            roughness: -0.22 * wet,
            glow: 0.0,
        }
    });
    let ground = Heights::of(&canvas);
    for number in 0..420 {
        let [x, y, turn, size, hue, tone] = dice(number, 248);
        let half_length = 0.003 + 0.011 * size * size * size;
        let shell = hue > 0.55;
        let stroke =
            Stroke { middle: [x, y], turn_rad: TAU * turn, half_length, half_width: half_length * (0.55 + 0.4 * tone) };
        let low = ground.at([x, y]);
        stroke.draw(&mut canvas, |along, across| {
            let round = 1.0 - along * along - across * across;
            (round > 0.0).then(|| {
                let ribs = if shell { 0.12 * (TAU * 4.0 * across).sin() } else { 0.0 };
                let color = if shell { [1.35, 1.3, 1.25] } else { [0.86 + 0.3 * hue, 0.84, 0.82] };
                let light = if shell { 1.05 + 0.25 * tone + ribs } else { 0.55 + 0.75 * tone };
                let height = low + half_length * (0.25 + 0.55 * round.sqrt());
                Spot { height, tint: tinted(color, light), roughness: -0.25, glow: 0.0 }
            })
        });
    }
    canvas
}

pub(super) fn gravel() -> Vec<Spot> {
    let (lumps, stains, grit) = (Drawn::new(10, 5, 42), Drawn::new(20, 3, 43), Drawn::new(48, 3, 48));
    // Large stones are rare, small ones lie everywhere.
    let sizes = [(38, 0.6, 44), (21, 0.45, 45), (11, 0.3, 46), (6, 0.22, 47), (70, 0.7, 49)]
        .map(|(period, share, seed)| stones(period, share, seed));
    each(|at| {
        let grains = grain(at, 41);
        let mut spot = Spot {
            height: 0.004 * lumps.at(at) + 0.001 * grains,
            tint: grey(0.74 + 0.14 * grains + 0.12 * stains.at(at)),
            roughness: 0.04,
            glow: 0.0,
        };
        for stones in &sizes {
            let Some((cell, inside)) = stone_at(stones, at) else { continue };
            let [_, tone, warm] = cell.own;
            let dome = inside * (2.0 - inside);
            let height = (0.006 + 0.32 * dome.sqrt() * radius_of(&cell) / stones.period) * 0.8;
            if height > spot.height {
                let light = (0.66 + 0.75 * tone) * (0.74 + 0.26 * dome) * (1.0 + 0.10 * grit.at(at));
                let color = [1.0 + 0.10 * (warm - 0.5), 1.0, 1.0 - 0.16 * (warm - 0.5)];
                spot = Spot { height, tint: tinted(color, light), roughness: -0.08 - 0.1 * tone, glow: 0.0 };
            }
        }
        spot
    })
}

/// Broken stones with flat faces, one on another.
pub(super) fn scree() -> Vec<Spot> {
    let (dust, stains, rough) = (Drawn::new(12, 5, 251), Drawn::new(6, 3, 252), Drawn::new(34, 4, 253));
    let sizes = [(80, 0.9, 250), (50, 0.8, 254), (29, 0.6, 255), (17, 0.42, 256), (10, 0.26, 257), (6, 0.14, 258)].map(
        |(period, share, seed)| {
            let blocks = Scattered::new(period, share, (2, 0.05), seed);
            (blocks, Cells::new(2 * period, seed + 20))
        },
    );
    each(|at| {
        let mut spot = Spot {
            height: 0.004 * dust.at(at),
            tint: tinted([1.0, 0.97, 0.94], 0.55 + 0.12 * dust.at(at) + 0.1 * grain(at, 259)),
            roughness: 0.05,
            glow: 0.0,
        };
        for (blocks, facets) in &sizes {
            let Some(cell) = blocks.at(at) else { continue };
            let border = cell.border();
            if border < 0.07 {
                continue;
            }
            // A stone is a block with tilted faces; a finer lattice breaks its top.
            let face = facets.at(blocks.bent(at));
            let lean = |own: [f32; 3], [x, y]: [f32; 2]| (own[1] - 0.5) * x + (own[2] - 0.5) * y;
            let top = 0.26 + 0.34 * cell.own[1] + 0.55 * lean(cell.own, cell.from) + 0.3 * lean(face.own, face.from);
            let rim = step(0.07, 0.20, border);
            let height = (top * (0.35 + 0.65 * rim) + 0.03 * rough.at(at)) * 0.8 / blocks.period;
            if height > spot.height {
                let light = (0.7 + 0.55 * cell.own[2]) * (0.92 + 0.2 * (face.own[0] - 0.5)) * (0.7 + 0.3 * rim)
                    + 0.1 * rough.at(at)
                    + 0.08 * stains.at(at);
                let color = [1.0 + 0.12 * (cell.own[1] - 0.5), 1.0, 1.0 - 0.12 * (cell.own[1] - 0.5)];
                spot = Spot { height, tint: tinted(color, light.max(0.1)), roughness: 0.0, glow: 0.0 };
            }
        }
        spot
    })
}

/// Round stones of a river bed with sand between.
pub(super) fn cobbles() -> Vec<Spot> {
    let (silt, veins, grit, stains) =
        (Drawn::new(14, 5, 261), Drawn::new(9, 4, 262), Drawn::new(50, 3, 263), Drawn::new(26, 3, 264));
    let sizes = [(34, 0.75, 265), (19, 0.7, 266), (10, 0.62, 267), (6, 0.4, 268)]
        .map(|(period, share, seed)| Scattered::new(period, share, (1, 0.10), seed));
    each(|at| {
        let mut spot = Spot {
            height: 0.003 * silt.at(at),
            tint: tinted([1.02, 0.98, 0.92], 0.72 + 0.12 * silt.at(at) + 0.12 * grain(at, 269)),
            roughness: 0.03,
            glow: 0.0,
        };
        for stones in &sizes {
            let Some(cell) = stones.at(at) else { continue };
            let [_, tone, hue] = cell.own;
            let border = cell.border();
            if border < 0.02 {
                continue;
            }
            let inside = ((border - 0.02) / 0.34).min(1.0);
            let dome = dome(inside);
            let height = (0.05 + (0.22 + 0.1 * tone) * dome) / stones.period;
            if height > spot.height {
                let vein = step(0.08, 0.0, (veins.at(at) + 1.2 * (hue - 0.5)).abs()) * f32::from(hue > 0.6);
                let light =
                    (0.62 + 0.55 * tone) * (0.72 + 0.3 * dome) * (1.0 + 0.10 * grit.at(at) + 0.1 * stains.at(at));
                let color = between([1.1, 0.99, 0.9], [0.92, 1.0, 1.08], hue);
                let light = light + 0.45 * vein;
                spot = Spot { height, tint: tinted(color, light), roughness: -0.05, glow: 0.0 };
            }
        }
        spot
    })
}

/// Volcanic ash with stones that fell into it, and pits of rain.
pub(super) fn ash() -> Vec<Spot> {
    let (swells, clods, puff) = (Drawn::new(3, 5, 271), Drawn::new(30, 4, 272), Drawn::new(7, 4, 273));
    let (drops, lapilli) = (Cells::new(52, 274), [stones(24, 0.16, 275), stones(50, 0.3, 276)]);
    each(|at| {
        let drop = drops.at(at.at);
        let r = drop.nearest / (0.16 + 0.22 * drop.own[1]);
        let pit = f32::from(drop.own[0] < 0.4) * ((r * r - 1.0).min(0.0) + 0.45 * (-((r - 1.1) / 0.3).powi(2)).exp());
        let mut spot = Spot {
            height: 0.016 * swells.at(at) + 0.0035 * clods.at(at) + 0.003 * pit,
            tint: tinted(
                [1.0, 1.0, 1.02],
                0.97 + 0.1 * puff.at(at) + 0.06 * clods.at(at) + 0.05 * grain(at, 277) + 0.06 * pit,
            ),
            roughness: 0.06,
            glow: 0.0,
        };
        for stones in &lapilli {
            let Some((cell, inside)) = stone_at(stones, at) else { continue };
            let dome = dome(inside);
            spot.height += 0.3 * dome / stones.period;
            let light = (0.5 + 0.6 * cell.own[1]) * (0.85 + 0.3 * grain(at, 278).max(-0.5)) * (0.8 + 0.2 * dome);
            spot.tint = tinted([1.04, 0.98, 0.96], light);
            spot.roughness = 0.0;
        }
        spot
    })
}

/// Powder of a world without air, with small craters.
pub(super) fn regolith() -> Vec<Spot> {
    let (swells, clods, fine) = (Drawn::new(3, 5, 91), Drawn::new(26, 4, 92), Drawn::new(64, 3, 98));
    let sizes = [(34, 0.10, 93), (70, 0.22, 99), (13, 0.03, 89)]
        .map(|(period, share, seed)| Scattered::new(period, share, (2, 0.06), seed));
    // Craters of five sizes, the fewer the larger.
    let craters = [(3, 0.5, 87), (7, 0.45, 94), (13, 0.5, 95), (27, 0.55, 96), (55, 0.6, 88)]
        .map(|(period, share, seed)| Scattered::new(period, share, (1, 0.08), seed));
    each(|at| {
        let grains = grain(at, 97);
        let mut height = 0.010 * swells.at(at) + 0.0022 * clods.at(at) + 0.0009 * fine.at(at) + 0.0003 * grains;
        let mut light = 1.0 + 0.06 * grains + 0.06 * clods.at(at) + 0.06 * fine.at(at);
        for craters in &craters {
            let Some(cell) = craters.at(at) else { continue };
            let [_, width, age] = cell.own;
            // A bowl with a raised rim; old ones are filled.
            let radius = 0.14 + 0.22 * width;
            let r = cell.nearest / radius;
            let fresh = 0.12 + 0.88 * age * age * age;
            let bowl = (r * r - 1.0).min(0.0);
            let rim = (-((r - 1.05) / 0.28).powi(2)).exp();
            height += fresh * radius / craters.period * (0.36 * bowl + 0.11 * rim);
            light += fresh * (0.10 * rim + 0.08 * bowl);
        }
        for stones in &sizes {
            let Some(cell) = stones.at(at) else { continue };
            let [_, width, tone] = cell.own;
            let radius = 0.10 + 0.26 * width * width;
            let inside = 1.0 - cell.nearest / radius;
            if inside > 0.0 {
                height += 0.75 * radius / stones.period * dome(inside);
                light = 0.72 + 0.55 * tone;
            }
        }
        Spot { height, tint: grey(light), roughness: 0.05, glow: 0.0 }
    })
}
