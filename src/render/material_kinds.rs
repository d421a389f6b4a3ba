//! The patterns of the ground, one function for each [`Detail`]: what a square of it looks like that repeats without a seam.

use super::material_noise::{cells, fractal, lattice, smooth, step};
use crate::planet::Detail;
use std::f32::consts::TAU;

/// Texels along a side of a pattern.
pub(super) const SIDE: usize = 256;

/// What a pattern has at one place.
#[derive(Clone, Copy, Default)]
pub(super) struct Spot {
    /// Height, in shares of the pattern's side.
    pub(super) height: f32,
    /// Colour, to be multiplied with that of the biome.
    pub(super) tint: [f32; 3],
    /// Added to the biome's roughness.
    pub(super) roughness: f32,
    /// Share of the biome's glow.
    pub(super) glow: f32,
}

/// The kinds that have a pattern, in the order of their layers.
pub(super) const KINDS: [Detail; 9] = [
    Detail::Grass,
    Detail::Litter,
    Detail::Sand,
    Detail::Gravel,
    Detail::Rock,
    Detail::Snow,
    Detail::Ice,
    Detail::Mud,
    Detail::Lava,
];

/// The layer of a kind.
pub(super) fn layer(kind: Detail) -> Option<usize> {
    KINDS.iter().position(|known| *known == kind)
}

/// Draws a pattern, row by row.
pub(super) fn draw(kind: Detail) -> Vec<Spot> {
    match kind {
        Detail::None => vec![Spot { tint: [1.0; 3], ..Spot::default() }; SIDE * SIDE],
        Detail::Grass => grass(),
        Detail::Litter => litter(),
        Detail::Sand => each(sand),
        Detail::Gravel => each(gravel),
        Detail::Rock => each(rock),
        Detail::Snow => each(snow),
        Detail::Ice => each(ice),
        Detail::Mud => each(mud),
        Detail::Lava => each(lava),
    }
}

fn each(spot: impl Fn([f32; 2]) -> Spot) -> Vec<Spot> {
    let at = |i: usize| [((i % SIDE) as f32 + 0.5) / SIDE as f32, ((i / SIDE) as f32 + 0.5) / SIDE as f32];
    (0..SIDE * SIDE).map(|i| spot(at(i))).collect()
}

fn grey(light: f32) -> [f32; 3] {
    [light; 3]
}

fn tinted([r, g, b]: [f32; 3], light: f32) -> [f32; 3] {
    [r * light, g * light, b * light]
}

/// A number of each texel's own, -1..1.
fn grain(at: [f32; 2], seed: u32) -> f32 {
    let texel = at.map(|w| (w * SIDE as f32) as i32);
    2.0 * lattice(texel, SIDE as i32, seed)[0] - 1.0
}

/// A place displaced by soft noise, so that nothing is straight.
fn warped(at: [f32; 2], period: i32, by: f32, seed: u32) -> [f32; 2] {
    [at[0] + by * fractal(at, period, 3, seed), at[1] + by * fractal(at, period, 3, seed + 7)]
}

/// Paints over the pattern, without a seam: `spot` sees the place relative to the stroke's middle, in texels, and paints where it
/// is higher than what is there.
fn stamp(canvas: &mut [Spot], center: [f32; 2], reach: f32, spot: impl Fn(f32, f32) -> Option<Spot>) {
    let side = SIDE as i32;
    let range = |c: f32| (c - reach).floor() as i32..=(c + reach).ceil() as i32;
    for y in range(center[1]) {
        for x in range(center[0]) {
            if let Some(new) = spot(x as f32 + 0.5 - center[0], y as f32 + 0.5 - center[1]) {
                let old = &mut canvas[(y.rem_euclid(side) * side + x.rem_euclid(side)) as usize];
                if new.height > old.height {
                    *old = new;
                }
            }
        }
    }
}

/// Numbers of a stroke's own, 0..1.
fn dice(number: i32, seed: u32) -> [f32; 6] {
    let ([a, b, c], [d, e, f]) = (lattice([number, 1], 1 << 20, seed), lattice([number, 2], 1 << 20, seed));
    [a, b, c, d, e, f]
}

fn grass() -> Vec<Spot> {
    let soil = |at| Spot {
        height: 0.01 * (1.0 + smooth(at, 20, 1)),
        tint: tinted([0.62, 0.42, 0.40], 0.75 + 0.25 * grain(at, 2)),
        roughness: 0.05,
        glow: 0.0,
    };
    let mut canvas = each(soil);
    for number in 0..5200 {
        let [x, y, turn, long, hue, dry] = dice(number, 11);
        let place = [x, y];
        // Tufts lean together.
        let lean = TAU * (fractal(place, 4, 2, 12) + 0.16 * (turn - 0.5));
        let tuft = step(-0.5, 0.45, fractal(place, 7, 2, 13));
        let length = (6.0 + 15.0 * long) * (0.45 + 0.55 * tuft);
        let (sin, cos) = lean.sin_cos();
        let color = if dry > 0.84 { [1.75, 1.15, 1.1] } else { [0.72 + 0.55 * hue, 1.0, 0.55 + 0.5 * hue] };
        let shade = 0.75 + 0.5 * hue;
        let center = [x * SIDE as f32, y * SIDE as f32];
        stamp(&mut canvas, center, 0.5 * length + 1.0, |dx, dy| {
            let (along, across) = ((dx * cos + dy * sin) / length + 0.5, dy * cos - dx * sin);
            // From the root to the tip, bent to one side.
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
    let soil = |at| Spot {
        height: 0.004 * (1.0 + smooth(at, 16, 21)),
        tint: tinted([0.75, 0.5, 0.45], 0.55 + 0.2 * grain(at, 22)),
        roughness: 0.05,
        glow: 0.0,
    };
    let mut canvas = each(soil);
    for number in 0..1300 {
        let [x, y, turn, size, hue, lift] = dice(number, 23);
        let (sin, cos) = (TAU * turn).sin_cos();
        let twig = number % 26 == 0;
        let (length, width) = if twig { (18.0 + 26.0 * size, 1.3) } else { (5.0 + 6.0 * size, 2.2 + 2.6 * hue) };
        let color = match (hue * 5.0) as i32 {
            0 => [0.75, 1.1, 0.6],
            1 => [1.9, 1.05, 0.7],
            2 => [1.5, 0.9, 0.75],
            3 => [1.1, 0.85, 0.8],
            _ => [0.9, 0.95, 0.7],
        };
        let light = 0.55 + 0.8 * lift;
        stamp(&mut canvas, [x * SIDE as f32, y * SIDE as f32], length + 1.0, |dx, dy| {
            let (along, across) = ((dx * cos + dy * sin) / length, (dy * cos - dx * sin) / width);
            // A leaf is pointed at both ends, and folded along its rib.
            let edge = if twig { 1.0 } else { 1.0 - along * along };
            let inside = along.abs() < 1.0 && across.abs() < edge;
            inside.then(|| {
                let fold = 1.0 - across.abs() / edge.max(1e-3);
                let rib = if !twig && across.abs() < 0.16 { 0.85 } else { 1.0 };
                let height =
                    0.006 + 0.02 * lift + 0.006 * fold + if twig { 0.012 } else { 0.004 * along * (turn - 0.5) };
                Spot { height, tint: tinted(color, light * rib * (0.8 + 0.2 * fold)), roughness: -0.08, glow: 0.0 }
            })
        });
    }
    canvas
}

fn sand(at: [f32; 2]) -> Spot {
    let [u, v] = warped(at, 3, 0.055, 31);
    // Gentle before the wind and steep behind, stronger here than there.
    let phase = (11.0 * v + u.mul_add(2.0, 0.0)).rem_euclid(1.0);
    let ripple = if phase < 0.68 { step(0.0, 0.68, phase) } else { 1.0 - step(0.68, 1.0, phase) };
    let strength = 0.55 + 0.45 * fractal(at, 2, 3, 33);
    let grains = grain(at, 34);
    let dark = step(0.93, 1.0, lattice(at.map(|w| (w * SIDE as f32) as i32), SIDE as i32, 35)[1]);
    Spot {
        height: 0.009 * ripple * strength + 0.004 * fractal(at, 24, 3, 36) + 0.0006 * grains,
        tint: tinted([1.0, 0.985, 0.96], 1.0 + 0.07 * (ripple - 0.5) * strength + 0.075 * grains - 0.3 * dark),
        roughness: -0.1 * dark,
        glow: 0.0,
    }
}

fn gravel(at: [f32; 2]) -> Spot {
    let grains = grain(at, 41);
    let mut spot = Spot {
        height: 0.004 * fractal(at, 10, 4, 42) + 0.001 * grains,
        tint: grey(0.78 + 0.16 * grains + 0.12 * fractal(at, 20, 3, 43)),
        roughness: 0.04,
        glow: 0.0,
    };
    // Big stones are few, small ones lie everywhere.
    for (period, share, seed) in [(38, 0.6, 44), (21, 0.45, 45), (11, 0.30, 46), (6, 0.22, 47)] {
        let cell = cells(warped(at, period, 0.16 / period as f32, seed + 50), period, seed);
        let [size, tone, warm] = cell.own;
        if size > share {
            continue;
        }
        let radius = 0.30 + 0.5 * tone * (1.0 - size);
        let inside = (cell.border / 0.12).min((radius - cell.nearest) / (0.7 * radius));
        if inside > 0.0 {
            let dome = inside.min(1.0) * (2.0 - inside.min(1.0));
            let height = (0.006 + 0.32 * dome.sqrt() * radius / period as f32) * 0.8;
            if height > spot.height {
                let light = (0.66 + 0.75 * tone) * (0.74 + 0.26 * dome) * (1.0 + 0.10 * fractal(at, 48, 2, seed + 9));
                let color = [1.0 + 0.10 * (warm - 0.5), 1.0, 1.0 - 0.16 * (warm - 0.5)];
                spot = Spot { height, tint: tinted(color, light), roughness: -0.08 - 0.1 * tone, glow: 0.0 };
            }
        }
    }
    spot
}

fn rock(at: [f32; 2]) -> Spot {
    let bent = warped(at, 3, 0.07, 61);
    let (slab, chip) = (cells(bent, 4, 62), cells(warped(at, 6, 0.05, 63), 11, 64));
    let tilt = |own: [f32; 3], [x, y]: [f32; 2]| (own[0] - 0.5) * x + (own[1] - 0.5) * y;
    let crack = 1.0 - step(0.0, 0.05, slab.border);
    let split = (1.0 - step(0.0, 0.06, chip.border)) * step(0.35, 0.65, chip.own[2]);
    let strata = (TAU * (7.0 * bent[1] + 2.0 * bent[0] + 0.5 * fractal(at, 5, 3, 65))).sin();
    let rough = fractal(at, 9, 5, 66);
    let lichen = step(0.25, 0.55, fractal(at, 5, 4, 67)) * step(-0.3, 0.3, fractal(at, 40, 2, 68));
    let light = 0.92 + 0.32 * (slab.own[2] - 0.5) + 0.16 * (chip.own[0] - 0.5) + 0.06 * strata + 0.26 * rough;
    let worn = light * (1.0 - 0.55 * crack) * (1.0 - 0.35 * split) * (1.0 + 0.05 * grain(at, 69));
    let color = [1.0 + 0.1 * (slab.own[0] - 0.5), 1.0, 1.0 - 0.08 * (slab.own[1] - 0.5)];
    let patch = [1.12, 1.16, 0.86];
    Spot {
        height: 0.055 * tilt(slab.own, slab.from) + 0.02 * tilt(chip.own, chip.from) + 0.03 * slab.own[2]
            - 0.035 * crack
            - 0.012 * split
            + 0.006 * strata
            + 0.03 * rough,
        tint: std::array::from_fn(|i| worn * (color[i] + (patch[i] - color[i]) * 0.6 * lichen)),
        roughness: 0.1 * lichen - 0.06 * rough,
        glow: 0.0,
    }
}

fn snow(at: [f32; 2]) -> Spot {
    let [u, v] = warped(at, 2, 0.10, 71);
    // Sastrugi: crests cut by the wind, drawn out along it.
    let drawn = fractal([u, v * 2.0], 3, 4, 72);
    let crest = 1.0 - fractal([v, u * 3.0], 2, 3, 73).abs() * 1.6;
    let crust = step(0.55, 0.95, crest);
    let grains = grain(at, 74);
    let sparkle = step(0.985, 1.0, lattice(at.map(|w| (w * SIDE as f32) as i32), SIDE as i32, 75)[2]);
    Spot {
        height: 0.022 * drawn + 0.014 * crust + 0.003 * fractal(at, 30, 2, 76) + 0.0005 * grains,
        tint: tinted(
            [1.0 - 0.012 * drawn, 1.0, 1.0 + 0.01 * drawn],
            1.0 + 0.045 * drawn + 0.03 * crust + 0.014 * grains,
        ),
        roughness: -0.35 * sparkle - 0.1 * crust,
        glow: 0.0,
    }
}

fn ice(at: [f32; 2]) -> Spot {
    let line = |period: i32, width: f32, seed: u32| {
        let cell = cells(warped(at, period + 1, 0.22 / period as f32, seed + 3), period, seed);
        1.0 - step(0.0, width * (0.4 + cell.own[0]), cell.border)
    };
    let (wide, fine) = (line(3, 0.035, 81), line(8, 0.03, 82) * step(-0.1, 0.4, fractal(at, 3, 2, 83)));
    let cloudy = step(-0.35, 0.5, fractal(warped(at, 3, 0.1, 84), 3, 5, 85));
    let bubbles = step(0.6, 0.85, fractal(at, 40, 2, 86)) * cloudy;
    let white = (0.75 * wide + 0.4 * fine + 0.3 * bubbles).min(1.0);
    let light = 0.80 + 0.26 * cloudy + 0.32 * white;
    Spot {
        height: 0.006 * fractal(at, 3, 3, 87) + 0.003 * cloudy - 0.004 * wide - 0.0015 * fine,
        tint: [light * (0.9 + 0.12 * cloudy + 0.08 * white), light, light * (1.05 - 0.06 * cloudy)],
        roughness: 0.22 * cloudy + 0.3 * white - 0.12,
        glow: 0.0,
    }
}

fn mud(at: [f32; 2]) -> Spot {
    let (plate, inner) = (cells(warped(at, 5, 0.05, 91), 5, 92), cells(warped(at, 9, 0.03, 93), 11, 94));
    let gap = 1.0 - step(0.015, 0.075, plate.border);
    let hair = (1.0 - step(0.0, 0.05, inner.border)) * step(0.3, 0.5, plate.own[1]);
    // Plates curl up at their edges as they dry.
    let curl = step(0.35, 0.06, plate.border);
    let rough = fractal(at, 18, 4, 95);
    let light = 1.0 + 0.16 * (plate.own[0] - 0.5) + 0.10 * curl + 0.10 * rough + 0.04 * grain(at, 96);
    Spot {
        height: 0.022 * (1.0 - gap) + 0.012 * curl * (1.0 - gap) - 0.005 * hair + 0.004 * rough,
        tint: tinted([1.0, 1.0 - 0.03 * gap, 1.0 - 0.06 * gap], light * (1.0 - 0.6 * gap) * (1.0 - 0.25 * hair)),
        roughness: 0.05 - 0.45 * gap,
        glow: 0.0,
    }
}

fn lava(at: [f32; 2]) -> Spot {
    let bent = warped(at, 3, 0.09, 101);
    let (plate, chip) = (cells(bent, 4, 102), cells(warped(at, 7, 0.05, 103), 10, 104));
    // Ropes: folds pushed up across the flow on each plate.
    let ropes = (TAU * (9.0 * plate.nearest + 0.8 * fractal(at, 6, 3, 105))).sin() * step(0.0, 0.4, plate.border);
    let rough = fractal(at, 12, 5, 106);
    let gap = 1.0 - step(0.0, 0.13, plate.border + 0.06 * rough);
    let vein = (1.0 - step(0.0, 0.07, chip.border)) * step(0.45, 0.75, plate.own[2]);
    let hot = (gap + 0.55 * vein).min(1.0);
    let light = 0.9 + 0.3 * (plate.own[0] - 0.5) + 0.22 * ropes + 0.3 * rough;
    Spot {
        height: 0.03 * (1.0 - gap) + 0.012 * ropes + 0.02 * rough - 0.01 * vein + 0.01 * plate.own[1],
        tint: grey(light.max(0.1) * (1.0 - 0.5 * hot)),
        roughness: -0.15 * step(0.2, 0.8, ropes) + 0.05,
        glow: hot * hot * (0.85 + 0.3 * rough),
    }
}
