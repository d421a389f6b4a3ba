//! Ground that plants cover: grass, steppe, moss, fallen leaves, needles.

use super::canvas::{Heights, Spot, Stroke, between, dice, each, grain, tinted};
use super::noise::{Cell, Cells, Drawn, Fractal, Warp, step};
use std::f32::consts::TAU;

/// One blade from its root to its tip.
struct Blade {
    root: [f32; 2],
    turn_rad: f32,
    length: f32,
    width: f32,
    /// How far the tip bends aside, as a share of the length
    bend: f32,
    color: [f32; 3],
    /// Height of the root and of the tip
    heights: [f32; 2],
}

impl Blade {
    fn draw(&self, canvas: &mut [Spot]) {
        let (sin, cos) = self.turn_rad.sin_cos();
        let half = 0.5 * self.length;
        let middle = [self.root[0] + half * cos, self.root[1] + half * sin];
        // The stroke has room for the bend.
        let half_width = self.width + self.length * self.bend.abs();
        let [low, high] = self.heights;
        Stroke { middle, turn_rad: self.turn_rad, half_length: half, half_width }.draw(canvas, |along, across| {
            let t = 0.5 + 0.5 * along;
            let aside = across * half_width - self.bend * self.length * t * t;
            // A blade narrows from root to tip.
            let width = (self.width * (1.0 - 0.75 * t)).max(0.0012);
            let rib = aside / width;
            (rib.abs() < 1.0).then(|| {
                let light = (0.42 + 0.8 * t) * (1.0 - 0.25 * rib * rib) * if rib < 0.0 { 0.92 } else { 1.06 };
                let height = low + (high - low) * t * (1.25 - 0.45 * t);
                Spot { height, tint: tinted(self.color, light), roughness: -0.12 * t, glow: 0.0 }
            })
        });
    }
}

pub(super) fn grass() -> Vec<Spot> {
    let lumps = Drawn::new(24, 3, 1);
    let mut canvas = each(|at| Spot {
        height: 0.008 * (1.0 + lumps.at(at)),
        tint: tinted([0.80, 0.52, 0.46], 0.62 + 0.2 * lumps.at(at) + 0.12 * grain(at, 2)),
        roughness: 0.05,
        glow: 0.0,
    });
    let (leans, tufts, hues) = (Fractal::new(4, 2, 12), Fractal::new(7, 2, 13), Fractal::new(3, 3, 14));
    for number in 0..9500 {
        let [x, y, turn, long, hue, dry] = dice(number, 11);
        // Blades of a tuft lean together.
        let turn_rad = TAU * (leans.at([x, y]) + 0.22 * (turn - 0.5));
        let tuft = step(-0.5, 0.45, tufts.at([x, y]));
        let dead = dry + 0.2 * hues.at([x, y]) > 0.86;
        let fresh = [0.70 + 0.5 * hue, 1.0, 0.55 + 0.45 * hue];
        let color = tinted(if dead { [1.75, 1.2, 1.1] } else { fresh }, 0.78 + 0.45 * hue);
        let length = (0.022 + 0.052 * long) * (0.5 + 0.5 * tuft);
        Blade {
            root: [x, y],
            turn_rad,
            length,
            width: 0.0026,
            bend: 0.5 * (turn - 0.5),
            color,
            heights: [0.009, 0.011 + 0.017 * (0.6 + 0.4 * tuft) * (0.6 + 0.4 * dry)],
        }
        .draw(&mut canvas);
    }
    canvas
}

/// Bunches of dry blades on bare earth.
pub(super) fn steppe() -> Vec<Spot> {
    let (lumps, crumbs, stains) = (Drawn::new(9, 5, 201), Cells::new(60, 202), Drawn::new(4, 3, 203));
    let mut canvas = each(|at| {
        let crumb = crumbs.at(at.at);
        let inside = (1.0 - crumb.nearest / (0.2 + 0.5 * crumb.own[1])).max(0.0) * f32::from(crumb.own[0] < 0.4);
        let light = 0.86 + 0.2 * lumps.at(at) + 0.14 * stains.at(at) + 0.3 * (crumb.own[2] - 0.4) * inside.sqrt();
        Spot {
            height: 0.006 * (1.0 + lumps.at(at)) + 0.006 * inside.sqrt(),
            tint: tinted([1.02, 0.92, 0.86], light + 0.08 * grain(at, 204)),
            roughness: 0.06,
            glow: 0.0,
        }
    });
    for bunch in 0..46 {
        let [x, y, size, dry, number, _] = dice(bunch, 205);
        let size = 0.35 + 0.65 * size;
        for blade in 0..(60.0 + 130.0 * size * number) as u32 {
            let [out, turn, long, hue, bend, dead] = dice(1000 * (bunch + 1) + blade, 206);
            let turn_rad = TAU * turn;
            let away = 0.022 * size * out.sqrt();
            let base = if dead > 0.25 + 0.5 * dry { [0.82, 1.02, 0.62] } else { [1.32, 1.2, 0.98] };
            Blade {
                root: [x + away * turn_rad.cos(), y + away * turn_rad.sin()],
                turn_rad: turn_rad + 0.9 * (bend - 0.5),
                length: (0.03 + 0.075 * long) * size,
                width: 0.0021,
                bend: 0.6 * (bend - 0.5),
                color: tinted(base, 0.8 + 0.5 * hue),
                heights: [0.016 * size, (0.026 + 0.012 * hue) * size * (1.25 - out)],
            }
            .draw(&mut canvas);
        }
    }
    // Broken blades lie about.
    for number in 0..700 {
        let [x, y, turn, long, hue, _] = dice(number, 207);
        Blade {
            root: [x, y],
            turn_rad: TAU * turn,
            length: 0.012 + 0.03 * long,
            width: 0.0018,
            bend: 0.2 * (hue - 0.5),
            color: tinted([1.35, 1.2, 0.95], 0.85 + 0.4 * hue),
            heights: [0.009, 0.0115],
        }
        .draw(&mut canvas);
    }
    canvas
}

/// Moss in soft swells, with cushions of shoots.
pub(super) fn moss() -> Vec<Spot> {
    let (bend, swells, velvet) = (Warp::new(7, 0.03, 211), Drawn::new(4, 5, 212), Drawn::new(64, 3, 213));
    let (cushions, small) = (Cells::new(6, 214), Cells::new(13, 217));
    let (stars, hues, dry) = (Cells::new(96, 215), Drawn::new(3, 5, 216), Drawn::new(9, 4, 218));
    each(|at| {
        let bent = bend.at(at);
        let (cushion, tuft, star) = (cushions.at(bent), small.at(bent), stars.at(at.at));
        // Cushions are domes of shoots that stand side by side; they grow into one another without an edge.
        let dome = |cell: Cell| {
            (1.0 - (cell.nearest / (0.5 + 0.4 * cell.own[1])).powi(2)).max(0.0) * step(0.0, 0.35, cell.border())
        };
        let (dome, tuft) = (dome(cushion) * cushion.own[0], dome(tuft));
        let shoot = (1.0 - star.nearest / 0.62).max(0.0);
        let hue = 0.9 * hues.at(at) + 0.5 * (cushion.own[2] - 0.5) * dome;
        let color = between([0.90, 1.02, 0.76], [1.20, 1.0, 1.02], (0.5 + 0.7 * hue).clamp(0.0, 1.0));
        let brown = step(0.25, 0.75, dry.at(at) + 0.4 * (star.own[0] - 0.5));
        let light = (0.74 + 0.14 * dome + 0.12 * tuft) * (0.66 + 0.6 * shoot.powf(0.7)) * (0.9 + 0.25 * star.own[1])
            + 0.09 * velvet.at(at)
            + 0.07 * swells.at(at);
        Spot {
            height: 0.016 * swells.at(at) + 0.020 * dome + 0.008 * tuft + 0.0042 * shoot + 0.0010 * velvet.at(at),
            tint: tinted(between(color, [1.35, 0.95, 0.9], 0.55 * brown), light.max(0.1)),
            roughness: 0.06 - 0.05 * shoot,
            glow: 0.0,
        }
    })
}

pub(super) fn litter() -> Vec<Spot> {
    let lumps = Drawn::new(16, 4, 21);
    let mut canvas = each(|at| Spot {
        height: 0.004 * (1.0 + lumps.at(at)),
        tint: tinted([0.8, 0.58, 0.5], 0.5 + 0.15 * lumps.at(at) + 0.16 * grain(at, 22)),
        roughness: 0.05,
        glow: 0.0,
    });
    for number in 0..3600_u32 {
        let [x, y, turn, size, hue, lift] = dice(number, 23);
        let twig = number % 36 == 0;
        let (half_length, half_width) =
            if twig { (0.03 + 0.06 * size, 0.0026) } else { (0.010 + 0.014 * size, 0.0045 + 0.0055 * hue) };
        let color = match (hue * 7.0) as u32 {
            0 => [0.85, 1.12, 0.65],
            1 => [1.65, 1.05, 0.75],
            2 => [1.4, 0.95, 0.78],
            3 => [1.15, 0.92, 0.78],
            4 => [0.98, 1.02, 0.7],
            5 => [1.25, 1.12, 1.0],
            _ => [0.88, 0.9, 0.75],
        };
        let light = 0.45 + 0.8 * lift;
        let stroke = Stroke { middle: [x, y], turn_rad: TAU * turn, half_length, half_width };
        stroke.draw(&mut canvas, |along, across| {
            // A leaf is pointed at both ends, folded along its rib, and curls up at its rim.
            let edge = if twig { 1.0 } else { (1.0 - along * along) * (1.0 - 0.3 * along) };
            let t = across / edge.max(1e-3);
            (t.abs() < 1.0).then(|| {
                let rib = if !twig && t.abs() < 0.14 { 0.78 } else { 1.0 };
                let vein = if twig { 0.0 } else { 0.05 * (TAU * (5.0 * along + 2.0 * t.abs())).sin() };
                let curl = t * t * (0.006 + 0.006 * size) + 0.006 * (turn - 0.5) * along;
                let bow = if twig { 0.010 * (1.0 - t * t) } else { curl };
                let side = if t < 0.0 { 0.93 } else { 1.05 };
                Spot {
                    height: 0.005 + 0.009 * lift + 0.5 * bow,
                    tint: tinted(color, light * side * (rib + vein)),
                    roughness: -0.08,
                    glow: 0.0,
                }
            })
        });
    }
    canvas
}

/// Fallen needles with twigs, cones and moss, as under conifers.
pub(super) fn needles() -> Vec<Spot> {
    let (swells, lumps, mossy, velvet) =
        (Drawn::new(3, 4, 221), Drawn::new(22, 4, 222), Drawn::new(3, 4, 223), Drawn::new(64, 2, 224));
    let mut canvas = each(|at| {
        let moss = step(0.12, 0.5, mossy.at(at));
        let color = between([0.92, 0.72, 0.62], [0.72, 1.22, 0.62], moss);
        Spot {
            height: 0.010 * swells.at(at) + 0.004 * lumps.at(at) + moss * (0.012 + 0.003 * velvet.at(at)),
            tint: tinted(color, 0.55 + 0.16 * lumps.at(at) + 0.2 * moss + (0.1 + 0.25 * moss) * velvet.at(at)),
            roughness: 0.05,
            glow: 0.0,
        }
    });
    let ground = Heights::of(&canvas);
    for number in 0..12_000_u32 {
        let [x, y, turn, long, hue, lift] = dice(number, 225);
        let twig = number % 170 == 0;
        let (half_length, half_width) =
            if twig { (0.04 + 0.09 * long, 0.0028) } else { (0.008 + 0.011 * long, 0.0009) };
        let color = match (hue * 6.0) as u32 {
            0 => [0.75, 1.0, 0.6],
            1 => [1.35, 1.0, 0.85],
            2 => [1.5, 1.0, 0.8],
            3 => [1.2, 1.05, 0.95],
            _ => [1.05, 0.85, 0.75],
        };
        let (low, light) = (ground.at([x, y]), 0.6 + 1.0 * lift);
        let stroke = Stroke { middle: [x, y], turn_rad: TAU * turn, half_length, half_width };
        stroke.draw(&mut canvas, |_, across| {
            (across.abs() < 1.0).then(|| Spot {
                height: low + 0.001 + 0.0035 * lift + if twig { 0.006 * (1.0 - across * across) } else { 0.0 },
                tint: tinted(color, light * if twig { 0.85 - 0.2 * across } else { 1.0 }),
                roughness: -0.05,
                glow: 0.0,
            })
        });
    }
    for number in 0..9 {
        let [x, y, turn, size, hue, _] = dice(number, 226);
        let half_length = 0.022 + 0.014 * size;
        let stroke = Stroke { middle: [x, y], turn_rad: TAU * turn, half_length, half_width: 0.55 * half_length };
        let low = ground.at([x, y]);
        stroke.draw(&mut canvas, |along, across| {
            let egg = (1.0 - along * along) * (1.0 - 0.25 * along);
            let round = egg - across * across;
            (round > 0.0).then(|| {
                // Scales in crossing spirals.
                let scales = (TAU * (4.0 * along + 2.2 * across)).sin() * (TAU * (4.0 * along - 2.2 * across)).sin();
                let light = 0.55 + 0.3 * scales + 0.35 * round + 0.2 * hue;
                let height = low + 0.03 * round.sqrt() + 0.004 * scales;
                Spot { height, tint: tinted([1.35, 0.98, 0.85], light), roughness: 0.0, glow: 0.0 }
            })
        });
    }
    canvas
}
