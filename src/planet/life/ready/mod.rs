//! Populations to start from, one for each kind of plant and stone; `lying` has those that lie on the ground.

mod lying;

use super::{
    Bulbs, Cactus, Conifer, Crown, Crystal, Cushion, Fans, Form, Mushroom, Palm, Population, Stone, Tendrils, Tree,
    Tuft, Wood,
};

/// A population to start from.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct ReadyPopulation {
    /// Its name.
    pub name: &'static str,
    make: fn() -> Population,
}

impl ReadyPopulation {
    /// The population, in all biomes that its climate suits.
    pub fn population(&self) -> Population {
        Population { name: self.name.to_owned(), ..(self.make)() }
    }

    /// A ready population by its name.
    pub fn named(name: &str) -> Option<Population> {
        READY_POPULATIONS.iter().find(|ready| ready.name == name).map(Self::population)
    }
}

/// A tree of its main parameters, in the order of [`Tree`].
fn tree(crown: Crown, shape: [f64; 3], leaves: [f64; 2], irregular: f64) -> Form {
    let [crown_width, trunk, trunk_width] = shape;
    let [leaves, leaf_size] = leaves;
    Form::Tree(Tree { crown, crown_width, trunk, trunk_width, leaves, leaf_size, irregular })
}

/// A tuft: blades; width, spread and arch; share of seed heads; leaflets.
fn tuft(blades: u32, shape: [f64; 3], head: f64, leaflets: bool) -> Form {
    let [width, spread, arch] = shape;
    Form::Tuft(Tuft { blades, width, spread, arch, head, leaflets })
}

/// Population of a form. `colors`: of wood or stone, and of leaves. `groups`: clumping, and clump size in metres.
fn of(form: Form, height_m: f64, colors: [[f64; 3]; 2], per_hectare: f64, groups: [f64; 2]) -> Population {
    let ([color, leaf_color], [clumping, clump_m]) = (colors, groups);
    Population { form, height_m, color, leaf_color, per_hectare, clumping, clump_m, ..Population::default() }
}

/// A population that no body hits.
fn soft(population: Population) -> Population {
    Population { solid: false, ..population }
}

impl Population {
    fn temperatures(self, temperature_from_c: f64, temperature_to_c: f64) -> Self {
        Self { temperature_from_c, temperature_to_c, ..self }
    }

    fn moistures(self, moisture_from: f64, moisture_to: f64) -> Self {
        Self { moisture_from, moisture_to, ..self }
    }

    fn near_water(self, bank_to_m: f64) -> Self {
        Self { bank_to_m, ..self }
    }

    fn littered(self, litter: f64) -> Self {
        Self { litter, ..self }
    }

    fn slopes(self, slope_from_deg: f64, slope_to_deg: f64) -> Self {
        Self { slope_from_deg, slope_to_deg, ..self }
    }
}

/// The populations to start from.
pub const READY_POPULATIONS: &[ReadyPopulation] = &[
    ReadyPopulation {
        name: "Broadleaf tree",
        make: || {
            of(
                tree(Crown::Round, [0.66, 0.3, 0.032], [0.95, 0.042], 0.7),
                18.0,
                [[0.18, 0.145, 0.11], [0.123, 0.183, 0.056]],
                260.0,
                [0.35, 90.0],
            )
            .littered(0.85)
            .temperatures(3.0, 32.0)
            .moistures(0.35, 1.0)
        },
    },
    ReadyPopulation {
        name: "Conifer",
        make: || {
            of(
                Form::Conifer(Conifer::default()),
                18.0,
                [[0.16, 0.12, 0.095], [0.074, 0.113, 0.045]],
                450.0,
                [0.35, 120.0],
            )
            .littered(0.8)
            .temperatures(-9.0, 12.0)
            .moistures(0.28, 1.0)
        },
    },
    ReadyPopulation {
        name: "Pine",
        make: || {
            of(
                tree(Crown::Round, [0.62, 0.42, 0.026], [0.8, 0.042], 1.0),
                17.0,
                [[0.24, 0.15, 0.1], [0.091, 0.137, 0.055]],
                220.0,
                [0.4, 100.0],
            )
            .littered(0.8)
            .temperatures(-4.0, 20.0)
            .moistures(0.25, 0.8)
        },
    },
    ReadyPopulation {
        name: "Birch",
        make: || {
            of(
                tree(Crown::Weeping, [0.5, 0.24, 0.026], [0.7, 0.04], 0.5),
                13.0,
                [[0.42, 0.4, 0.36], [0.166, 0.229, 0.069]],
                260.0,
                [0.5, 60.0],
            )
            .littered(0.7)
            .temperatures(-6.0, 14.0)
            .moistures(0.3, 1.0)
        },
    },
    ReadyPopulation {
        name: "Poplar",
        make: || {
            of(
                tree(Crown::Column, [0.27, 0.06, 0.032], [1.0, 0.045], 0.35),
                20.0,
                [[0.2, 0.17, 0.135], [0.126, 0.191, 0.061]],
                120.0,
                [0.6, 80.0],
            )
            .littered(0.7)
            .temperatures(4.0, 26.0)
            .moistures(0.3, 0.9)
        },
    },
    ReadyPopulation {
        name: "Palm",
        make: || {
            of(Form::Palm(Palm::default()), 11.0, [[0.26, 0.22, 0.17], [0.137, 0.209, 0.061]], 120.0, [0.5, 60.0])
                .littered(0.3)
                .temperatures(20.0, 60.0)
                .moistures(0.25, 1.0)
        },
    },
    ReadyPopulation {
        name: "Acacia",
        make: || {
            of(
                tree(Crown::Umbrella, [1.4, 0.36, 0.05], [0.8, 0.05], 0.4),
                8.0,
                [[0.18, 0.15, 0.12], [0.141, 0.186, 0.07]],
                14.0,
                [0.5, 200.0],
            )
            .littered(0.3)
            .temperatures(16.0, 45.0)
            .moistures(0.12, 0.5)
        },
    },
    ReadyPopulation {
        name: "Dead tree",
        make: || Population {
            sway: 0.0,
            ..of(
                tree(Crown::Round, [0.75, 0.22, 0.07], [0.0, 0.05], 0.9),
                9.0,
                [[0.22, 0.2, 0.175], [0.22, 0.2, 0.175]],
                5.0,
                [0.3, 150.0],
            )
            .temperatures(-8.0, 40.0)
        },
    },
    ReadyPopulation {
        name: "Shrub",
        make: || {
            of(
                tree(Crown::Round, [1.25, 0.0, 0.05], [0.85, 0.1], 0.6),
                1.8,
                [[0.17, 0.13, 0.1], [0.128, 0.184, 0.062]],
                140.0,
                [0.6, 30.0],
            )
            .littered(0.4)
            .temperatures(-6.0, 40.0)
            .moistures(0.2, 1.0)
        },
    },
    ReadyPopulation {
        name: "Dry shrub",
        make: || {
            of(
                tree(Crown::Round, [1.6, 0.0, 0.04], [0.3, 0.07], 0.9),
                0.6,
                [[0.24, 0.18, 0.13], [0.13, 0.11, 0.055]],
                320.0,
                [0.5, 25.0],
            )
            .temperatures(0.0, 60.0)
            .moistures(0.05, 0.4)
        },
    },
    ReadyPopulation {
        name: "Grass",
        make: || Population {
            sway: 0.25,
            ..soft(
                of(
                    tuft(24, [0.055, 0.55, 0.5], 0.0, false),
                    0.3,
                    [[0.09, 0.1, 0.035], [0.071, 0.106, 0.031]],
                    60000.0,
                    [0.5, 9.0],
                )
                .temperatures(-4.0, 40.0)
                .moistures(0.2, 1.0),
            )
        },
    },
    ReadyPopulation {
        name: "Tall grass",
        make: || Population {
            sway: 0.25,
            ..soft(
                of(
                    tuft(22, [0.028, 0.35, 0.4], 0.4, false),
                    0.9,
                    [[0.3, 0.24, 0.11], [0.2, 0.19, 0.07]],
                    25000.0,
                    [0.6, 14.0],
                )
                .temperatures(4.0, 45.0)
                .moistures(0.12, 0.7),
            )
        },
    },
    ReadyPopulation {
        name: "Reeds",
        make: || Population {
            sway: 0.25,
            ..soft(
                of(
                    tuft(20, [0.028, 0.14, 0.14], 0.35, false),
                    2.0,
                    [[0.14, 0.09, 0.05], [0.096, 0.128, 0.044]],
                    30000.0,
                    [0.7, 12.0],
                )
                .temperatures(2.0, 40.0)
                .near_water(8.0),
            )
        },
    },
    ReadyPopulation {
        name: "Fern",
        make: || Population {
            sway: 0.25,
            ..soft(
                of(
                    tuft(9, [0.075, 0.7, 1.0], 0.0, true),
                    0.6,
                    [[0.065, 0.088, 0.029], [0.059, 0.091, 0.031]],
                    2500.0,
                    [0.6, 15.0],
                )
                .temperatures(4.0, 32.0)
                .moistures(0.45, 1.0),
            )
        },
    },
    ReadyPopulation {
        name: "Moss cushion",
        make: || Population {
            sway: 0.0,
            ..soft(
                of(
                    Form::Cushion(Cushion { lumps: 11, width: 3.4, lumpiness: 0.6, roughness: 0.4, leaves: 0.7 }),
                    0.12,
                    [[0.039, 0.054, 0.017], [0.089, 0.126, 0.038]],
                    5000.0,
                    [0.7, 8.0],
                )
                .temperatures(-10.0, 24.0)
                .moistures(0.4, 1.0),
            )
        },
    },
    ReadyPopulation {
        name: "Column cactus",
        make: || Population {
            sway: 0.0,
            ..of(Form::Cactus(Cactus::default()), 5.0, [[0.068, 0.098, 0.04], [0.35, 0.31, 0.2]], 30.0, [0.4, 120.0])
                .temperatures(12.0, 60.0)
                .moistures(0.02, 0.3)
        },
    },
    ReadyPopulation {
        name: "Barrel cactus",
        make: || Population {
            sway: 0.0,
            ..of(
                Form::Cactus(Cactus { ribs: 20, groove: 0.25, arms: 0, girth: 0.9, spines: 0.7 }),
                0.7,
                [[0.064, 0.093, 0.039], [0.42, 0.33, 0.17]],
                60.0,
                [0.4, 60.0],
            )
            .temperatures(12.0, 60.0)
            .moistures(0.02, 0.3)
        },
    },
    ReadyPopulation {
        name: "Mushrooms",
        make: || Population {
            sway: 0.0,
            ..soft(
                of(
                    Form::Mushroom(Mushroom::default()),
                    0.15,
                    [[0.5, 0.42, 0.31], [0.26, 0.1, 0.045]],
                    250.0,
                    [0.8, 12.0],
                )
                .temperatures(2.0, 28.0)
                .moistures(0.4, 1.0),
            )
        },
    },
    ReadyPopulation { name: "Fallen trunk", make: lying::fallen_trunk },
    ReadyPopulation { name: "Twigs", make: lying::twigs },
    ReadyPopulation { name: "Boulder", make: lying::boulder },
    ReadyPopulation { name: "Stones", make: lying::stones },
    ReadyPopulation { name: "Scree", make: lying::scree },
    ReadyPopulation { name: "Lava block", make: lying::lava_block },
    ReadyPopulation { name: "Ice block", make: lying::ice_block },
    ReadyPopulation { name: "Crystals", make: lying::crystals },
    ReadyPopulation { name: "Regolith stone", make: lying::regolith_stone },
    ReadyPopulation { name: "Ventifact", make: lying::ventifact },
    ReadyPopulation {
        name: "Alien bulbs",
        make: || of(Form::Bulbs(Bulbs::default()), 3.0, [[0.1, 0.06, 0.14], [0.5, 0.16, 0.22]], 70.0, [0.7, 50.0]),
    },
    ReadyPopulation {
        name: "Alien fans",
        make: || of(Form::Fans(Fans::default()), 2.5, [[0.16, 0.03, 0.12], [0.55, 0.2, 0.12]], 70.0, [0.7, 50.0]),
    },
    ReadyPopulation {
        name: "Alien tendrils",
        make: || {
            of(Form::Tendrils(Tendrils::default()), 3.5, [[0.05, 0.07, 0.12], [0.12, 0.42, 0.36]], 60.0, [0.7, 50.0])
        },
    },
];
