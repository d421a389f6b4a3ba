//! Solid rock and lava.

use super::canvas::{Spot, between, dome, each, grain, grey, tinted};
use super::noise::{Cell, Cells, Drawn, Scattered, Texel, Warp, step};
use std::f32::consts::TAU;

/// Height of a face that is tilted by the random numbers of its cell.
fn lean(own: [f32; 3], [x, y]: [f32; 2]) -> f32 {
    (own[0] - 0.5) * x + (own[1] - 0.5) * y
}

/// Lichen: rosettes that grow where `growth` is high. Share of the texel under it.
fn lichen(at: Texel, growth: &Drawn, rosettes: &Cells) -> f32 {
    let rosette = rosettes.at(at.at);
    let r = rosette.nearest / (0.2 + 0.35 * rosette.own[1]);
    let ring = step(1.0, 0.8, r) * (0.55 + 0.45 * step(0.35, 0.8, r));
    ring * f32::from(rosette.own[0] < 0.5) * step(0.05, 0.4, growth.at(at))
}

pub(super) fn rock() -> Vec<Spot> {
    let (bend, bend_chips) = (Warp::new(3, 0.07, 61), Warp::new(6, 0.05, 63));
    let (slabs, chips, flakes) = (Cells::new(4, 62), Cells::new(11, 64), Cells::new(29, 71));
    let (rough, layers, growth) = (Drawn::new(6, 7, 66), Drawn::new(5, 3, 65), Drawn::new(5, 4, 67));
    let (open, specks) = (Drawn::new(3, 2, 70), Cells::new(34, 68));
    each(|at| {
        let bent = bend.at(at);
        let bent_chips = bend_chips.at(at);
        let (slab, chip, flake) = (slabs.at(bent), chips.at(bent_chips), flakes.at(bent_chips));
        // Some joints gape; most are mere edges between two faces.
        let gape = step(-0.1, 0.6, open.at(at));
        let crack = (1.0 - step(0.0, 0.012 + 0.04 * gape, slab.border())) * (0.35 + 0.65 * gape);
        let split = (1.0 - step(0.0, 0.05, chip.border())) * step(0.45, 0.75, chip.own[2]);
        let strata = (TAU * (7.0 * bent[1] + 2.0 * bent[0] + 0.5 * layers.at(at))).sin();
        let rough = rough.at(at);
        let lichen = lichen(at, &growth, &specks);
        let light = 0.92
            + 0.30 * (slab.own[2] - 0.5)
            + 0.18 * (chip.own[0] - 0.5)
            + 0.10 * (flake.own[0] - 0.5)
            + 0.06 * strata
            + 0.26 * rough;
        let worn = light * (1.0 - 0.5 * crack) * (1.0 - 0.35 * split) * (1.0 + 0.06 * grain(at, 69));
        let color = [1.0 + 0.1 * (slab.own[0] - 0.5), 1.0, 1.0 - 0.08 * (slab.own[1] - 0.5)];
        let patch = [1.16, 1.2, 0.92];
        Spot {
            height: 0.075 * lean(slab.own, slab.from)
                + 0.03 * lean(chip.own, chip.from)
                + 0.010 * lean(flake.own, flake.from)
                + 0.03 * slab.own[2]
                - 0.025 * crack
                - 0.012 * split
                + 0.006 * strata
                + 0.030 * rough
                + 0.001 * lichen,
            tint: std::array::from_fn(|i| worn * (color[i] + (patch[i] - color[i]) * 0.7 * lichen)),
            roughness: 0.1 * lichen - 0.06 * rough,
            glow: 0.0,
        }
    })
}

/// Tops of columns with bubbles.
pub(super) fn basalt() -> Vec<Spot> {
    let (bend, columns, rough) = (Warp::new(8, 0.008, 301), Cells::new(6, 302), Drawn::new(8, 6, 303));
    let (bubbles, small, growth, specks) =
        (Cells::new(44, 304), Cells::new(88, 305), Drawn::new(4, 4, 306), Cells::new(30, 307));
    let stains = Drawn::new(5, 5, 308);
    each(|at| {
        let column = columns.at(bend.at(at));
        let border = column.border();
        let gap = 1.0 - step(0.004, 0.035, border);
        let worn = step(0.0, 0.16, border);
        let hole = |cell: Cell, share: f32, wide: f32| {
            step(wide, 0.4 * wide, cell.nearest) * f32::from(cell.own[0] < share * (0.4 + 0.9 * column.own[1]))
        };
        let pits = (hole(bubbles.at(at.at), 0.3, 0.30) + 0.8 * hole(small.at(at.at), 0.3, 0.32)).min(1.0);
        let lichen = lichen(at, &growth, &specks);
        let light =
            0.95 + 0.35 * (column.own[2] - 0.5) + 0.24 * rough.at(at) + 0.14 * stains.at(at) + 0.05 * grain(at, 309);
        let rust = step(0.15, 0.7, stains.at(at));
        let color = between(between([0.98, 1.0, 1.03], [1.18, 1.0, 0.84], 0.7 * rust), [1.35, 1.3, 1.1], lichen);
        Spot {
            height: 0.035 * column.own[0]
                + 0.09 * lean([column.own[1], column.own[2], 0.0], column.from) / 1.4
                + 0.012 * worn
                - 0.05 * gap
                + 0.010 * rough.at(at)
                - 0.005 * pits,
            tint: tinted(color, light * (1.0 - 0.75 * gap) * (1.0 - 0.5 * pits) * (0.86 + 0.14 * worn)),
            roughness: 0.05 * lichen - 0.05 * worn + 0.04,
            glow: 0.0,
        }
    })
}

/// Crystals of feldspar, quartz and mica in rounded sheets.
pub(super) fn granite() -> Vec<Spot> {
    let (bend, sheets, swells) = (Warp::new(2, 0.10, 311), Cells::new(2, 312), Drawn::new(2, 4, 313));
    let (bend_grains, grains) = (Warp::new(80, 0.003, 314), Cells::new(108, 315));
    let (bend_mica, mica) = (Warp::new(120, 0.002, 322), Cells::new(124, 316));
    let (rough, growth, specks, stains) =
        (Drawn::new(20, 4, 317), Drawn::new(4, 4, 318), Cells::new(26, 319), Drawn::new(3, 5, 320));
    each(|at| {
        let sheet = sheets.at(bend.at(at));
        let border = sheet.border();
        // One sheet lies over the next: its rim is a step.
        let crack = 1.0 - step(0.002, 0.010, border);
        let rim = step(0.0, 0.10, border);
        let crystal = grains.at(bend_grains.at(at));
        let black = mica.at(bend_mica.at(at));
        let feldspar = [1.14, 1.03, 0.97];
        let quartz = [0.88, 0.90, 0.92];
        let pale = [1.12, 1.12, 1.10];
        let color = match (crystal.own[0] * 3.0) as u32 {
            0 => feldspar,
            1 => quartz,
            _ => pale,
        };
        let is_mica = step(0.5, 0.38, black.nearest) * f32::from(black.own[0] < 0.3);
        let lichen = lichen(at, &growth, &specks);
        let streak = step(0.1, 0.7, stains.at(at));
        let light = (0.86 + 0.3 * crystal.own[1])
            * (1.0 - 0.72 * is_mica)
            * (1.0 - 0.25 * streak)
            * (1.0 + 0.05 * grain(at, 321));
        Spot {
            height: 0.05 * sheet.own[1] + 0.05 * swells.at(at) + 0.02 * rim - 0.02 * crack
                + 0.0035 * rough.at(at)
                + 0.0012 * crystal.own[2],
            tint: tinted(between(color, [1.0, 1.08, 0.82], 0.75 * lichen), light * (1.0 - 0.4 * crack)),
            roughness: 0.08 * lichen - 0.16 * is_mica,
            glow: 0.0,
        }
    })
}

/// Beds of sand that lie across one another, with honeycombs of weathering.
pub(super) fn sandstone() -> Vec<Spot> {
    let (bend, sets, thin, rough) =
        (Warp::new(2, 0.06, 331), Warp::new(3, 0.03, 332), Drawn::new(6, 5, 333), Drawn::new(40, 3, 334));
    let (hollows, comb, stains) = (Drawn::new(3, 3, 335), Cells::new(22, 336), Drawn::new(3, 4, 337));
    each(|at| {
        let [_, v] = bend.at(at);
        let [su, sv] = sets.at(at);
        // Sets of beds; within a set thin layers lie aslant.
        let set = 4.0 * v;
        let number = set.floor().rem_euclid(4.0);
        let within = set - set.floor();
        let slant = [5.0, -4.0, 6.0, -7.0][number as usize % 4];
        let fine = (TAU * (22.0 * sv + slant * su + 0.35 * thin.at(at))).sin();
        let bed = (TAU * (9.0 * v + 0.2 * thin.at(at))).sin();
        let joint = step(0.06, 0.0, within.min(1.0 - within));
        let cell = comb.at(at.at);
        let weathered = step(0.15, 0.55, hollows.at(at));
        let pit = weathered * step(0.08, 0.3, cell.border());
        let warm = 0.5 + 0.5 * bed + 0.5 * stains.at(at);
        let color = between([1.04, 1.0, 0.94], [1.14, 0.93, 0.80], warm.clamp(0.0, 1.0));
        let light =
            0.95 + 0.10 * fine + 0.12 * bed + 0.10 * stains.at(at) + 0.06 * rough.at(at) + 0.06 * grain(at, 338);
        Spot {
            height: 0.010 * bed + 0.0045 * fine + 0.014 * thin.at(at) - 0.012 * joint - 0.020 * pit
                + 0.0016 * rough.at(at)
                + 0.01 * number * 0.2,
            tint: tinted(color, light * (1.0 - 0.35 * joint) * (1.0 - 0.28 * pit)),
            roughness: 0.05,
            glow: 0.0,
        }
    })
}

pub(super) fn lava() -> Vec<Spot> {
    let (bend, bend_chips, fold) = (Warp::new(3, 0.09, 101), Warp::new(7, 0.05, 103), Warp::new(4, 0.07, 107));
    let (plates, chips, rough) = (Cells::new(4, 102), Cells::new(10, 104), Drawn::new(12, 6, 106));
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

/// Cold ropes of lava: lobes that overlap, folds across each, cracks along their backs.
pub(super) fn ropes() -> Vec<Spot> {
    let (bend, fold, rough) = (Warp::new(3, 0.10, 341), Warp::new(5, 0.05, 342), Drawn::new(14, 6, 343));
    let (lobes, blisters, sheen) = (Cells::new(3, 344), Cells::new(40, 345), Drawn::new(4, 4, 346));
    each(|at| {
        let lobe = lobes.at(bend.at(at));
        let border = lobe.border();
        let ([x, y], [u, v]) = (lobe.from, fold.at(at));
        let turn_rad = TAU * lobe.own[0];
        let (sin, cos) = turn_rad.sin_cos();
        let (along, aside) = (x * cos + y * sin, y * cos - x * sin);
        // Folds bow where the middle of a lobe ran ahead of its sides.
        let across = 6.5 * (along + 1.3 * aside * aside) + 9.0 * (u - at.at[0] + v - at.at[1]);
        let fold_height = (TAU * across).sin();
        let calm = step(0.0, 0.22, border);
        let ropes = fold_height * calm * step(0.1, 0.6, lobe.own[1]);
        let rough = rough.at(at);
        let blister = blisters.at(at.at);
        let pit = step(0.3, 0.1, blister.nearest) * f32::from(blister.own[0] < 0.25);
        let rim = step(0.0, 0.2, border);
        let gap = 1.0 - step(0.0, 0.035, border + 0.02 * rough);
        let glassy = step(-0.2, 0.6, sheen.at(at));
        let light = 0.92 + 0.3 * (lobe.own[2] - 0.5) + 0.16 * ropes + 0.26 * rough + 0.12 * sheen.at(at);
        let color = between([1.06, 1.0, 0.95], [0.94, 1.0, 1.07], glassy);
        Spot {
            height: 0.05 * dome(rim) + 0.03 * lobe.own[2] + 0.010 * ropes + 0.010 * rough - 0.03 * gap - 0.004 * pit,
            tint: tinted(color, light.max(0.12) * (1.0 - 0.6 * gap) * (1.0 - 0.4 * pit)),
            roughness: -0.22 * glassy * step(-0.2, 0.6, ropes) + 0.04,
            glow: 0.0,
        }
    })
}

/// Clinker: rubble of lava full of holes.
pub(super) fn clinker() -> Vec<Spot> {
    let (rough, stains) = (Drawn::new(9, 7, 351), Drawn::new(4, 4, 352));
    let sizes = [(40, 0.95, 353), (21, 0.85, 354), (11, 0.65, 355), (6, 0.4, 356)]
        .map(|(period, share, seed)| Scattered::new(period, share, (2, 0.22), seed));
    let (holes, spikes) = (Cells::new(64, 357), Drawn::new(48, 3, 358));
    each(|at| {
        let rough = rough.at(at);
        let mut spot = Spot { height: -0.01, tint: grey(0.4 + 0.1 * rough), roughness: 0.06, glow: 0.0 };
        let hole = holes.at(at.at);
        let pit = step(0.4, 0.15, hole.nearest) * f32::from(hole.own[0] < 0.4);
        for lumps in &sizes {
            let Some(cell) = lumps.at(at) else { continue };
            let border = cell.border();
            if border < 0.03 {
                continue;
            }
            let dome = step(0.03, 0.4, border).sqrt();
            let height =
                (0.1 + 0.42 * cell.own[1] * dome + 0.2 * dome) / lumps.period + 0.012 * rough + 0.005 * spikes.at(at)
                    - 0.004 * pit;
            if height > spot.height {
                let red = step(0.2, 0.8, stains.at(at) + cell.own[2] - 0.5);
                let light = (0.6 + 0.6 * cell.own[2]) * (0.75 + 0.25 * dome) + 0.22 * rough + 0.12 * spikes.at(at);
                let color = between([1.0, 1.0, 1.0], [1.3, 0.95, 0.85], 0.8 * red);
                spot = Spot {
                    height,
                    tint: tinted(color, light.max(0.1) * (1.0 - 0.5 * pit)),
                    roughness: 0.06,
                    glow: 0.0,
                };
            }
        }
        spot
    })
}
