//! Populations that lie on the ground: fallen wood, stones, ice and crystals.

use super::{Crystal, Form, Population, Stone, Wood, of, soft};

/// A stone: roundness, flatness, stretch; cuts; layers, roughness.
fn stone(shape: [f64; 3], cuts: u32, skin: [f64; 2]) -> Form {
    let [roundness, flatness, stretch] = shape;
    let [layers, roughness] = skin;
    Form::Stone(Stone { roundness, flatness, stretch, cuts, layers, roughness })
}

/// A population that lies on the ground as stones do: turned with the slope, sunk, still.
fn lying(population: Population) -> Population {
    Population {
        upright: 0.2,
        lean_deg: 12.0,
        sunk: 0.15,
        sway: 0.0,
        height_spread: 0.7,
        color_spread: 0.3,
        ..population
    }
}

/// A population of long things, which lie along the ground.
fn flat(population: Population) -> Population {
    Population { upright: 0.0, lean_deg: 0.0, sunk: 0.12, ..lying(population) }
}

pub(super) fn fallen_trunk() -> Population {
    flat(of(
        Form::Wood(Wood { length: 20.0, moss: 0.45, ..Wood::default() }),
        0.5,
        [[0.15, 0.125, 0.1], [0.06, 0.085, 0.025]],
        40.0,
        [0.6, 60.0],
    ))
    .moistures(0.2, 1.0)
}

pub(super) fn twigs() -> Population {
    soft(flat(of(
        Form::Wood(Wood { length: 22.0, pieces: 3, branches: 0.6, flare: 0.0, bend: 0.7, moss: 0.1 }),
        0.04,
        [[0.14, 0.11, 0.085], [0.1, 0.1, 0.05]],
        3000.0,
        [0.5, 8.0],
    )))
    .moistures(0.15, 1.0)
}

pub(super) fn boulder() -> Population {
    lying(of(
        stone([0.5, 0.25, 1.25], 9, [0.0, 0.45]),
        1.6,
        [[0.2, 0.19, 0.17], [0.14, 0.135, 0.115]],
        14.0,
        [0.5, 120.0],
    ))
}

pub(super) fn stones() -> Population {
    soft(lying(of(
        stone([0.95, 0.45, 1.35], 4, [0.0, 0.15]),
        0.25,
        [[0.22, 0.205, 0.18], [0.17, 0.155, 0.14]],
        900.0,
        [0.6, 40.0],
    )))
}

pub(super) fn scree() -> Population {
    lying(
        of(
            stone([0.02, 0.6, 1.7], 11, [0.25, 0.2]),
            0.35,
            [[0.19, 0.18, 0.165], [0.13, 0.12, 0.11]],
            2500.0,
            [0.6, 30.0],
        )
        .slopes(24.0, 48.0),
    )
}

pub(super) fn lava_block() -> Population {
    lying(
        of(
            stone([0.15, 0.15, 1.2], 10, [0.0, 1.0]),
            1.1,
            [[0.035, 0.031, 0.03], [0.075, 0.05, 0.04]],
            80.0,
            [0.7, 90.0],
        )
        .slopes(0.0, 50.0),
    )
}

pub(super) fn ice_block() -> Population {
    lying(
        of(stone([0.05, 0.2, 1.35], 13, [0.1, 0.12]), 1.4, [[0.5, 0.64, 0.72], [0.75, 0.8, 0.84]], 18.0, [0.7, 150.0])
            .temperatures(-200.0, -4.0),
    )
}

pub(super) fn crystals() -> Population {
    Population {
        sway: 0.0,
        upright: 0.5,
        ..of(Form::Crystal(Crystal::default()), 1.0, [[0.16, 0.1, 0.24], [0.55, 0.42, 0.68]], 25.0, [0.8, 60.0])
            .slopes(0.0, 60.0)
    }
}

pub(super) fn regolith_stone() -> Population {
    lying(
        of(stone([0.6, 0.3, 1.15], 6, [0.0, 0.8]), 0.4, [[0.16, 0.15, 0.14], [0.11, 0.105, 0.1]], 260.0, [0.7, 60.0])
            .slopes(0.0, 50.0),
    )
}

pub(super) fn ventifact() -> Population {
    lying(
        of(stone([0.3, 0.4, 1.5], 4, [0.55, 0.12]), 0.7, [[0.3, 0.2, 0.13], [0.22, 0.14, 0.09]], 150.0, [0.6, 80.0])
            .slopes(0.0, 45.0),
    )
}
