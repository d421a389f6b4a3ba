//! The layout of plates: where they lie, how they move, and the old cores of continents that they carry.
//!
//! Nothing here depends on a grid: the plate at a direction is a function of the direction and the seed.

use super::by_hand::Moved;
use super::edges::Side;
use crate::planet::{PlateKind, Plates as Params};
use crate::sphere::spread;
use crate::world::EARTH_KM;
use crate::world::noise::{fbm, fbm_row, fbm3, fbm3_row, hash, unit};
use glam::DVec3;
use std::f64::consts::TAU;

/// A plate.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Plate {
    /// Unit direction of the middle, before boundaries are bent.
    pub(crate) center: DVec3,
    /// What is added to the cosine of the angle from the middle when plates compete for a point.
    pub(crate) weight: f64,
    /// Rotation about the Euler pole in radians per million years: the velocity of a point is the cross product of
    /// this vector and its direction.
    pub(crate) pole: DVec3,
    /// Whether it carries a continent.
    pub(crate) is_continental: bool,
    /// Old cores of its continents, at home.
    pub(crate) cratons: Vec<Craton>,
    /// Set by hand.
    pub(super) moved: Option<Moved>,
}

/// The old core of a continent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Craton {
    pub(crate) center: DVec3,
    pub(crate) radius_rad: f64,
}

/// A volcano over a hot spot, or carried away from it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Volcano {
    pub(crate) center: DVec3,
    /// Height above the ground around it, 0 to 1 of the youngest.
    pub(crate) height: f64,
    pub(crate) radius_rad: f64,
}

/// All plates of a planet.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Layout {
    pub(crate) plates: Vec<Plate>,
    pub(crate) volcanoes: Vec<Volcano>,
    /// The boundaries of each plate with the others.
    pub(super) sides: Vec<Vec<Side>>,
    pub(crate) seed: u32,
    /// How far boundaries are bent, in radians.
    bend_rad: f64,
    /// How far coasts are bent, in radians.
    coast_rad: f64,
    /// What is added to the crust so that continents have their share.
    crust_rad: f64,
}

/// A sequence of numbers from 0 to 1.
struct Dice(u32, u32);

impl Dice {
    fn roll(&mut self) -> f64 {
        self.1 = self.1.wrapping_add(1);
        unit(hash(self.0, self.1))
    }

    fn direction(&mut self) -> DVec3 {
        let (z, turn) = (2.0 * self.roll() - 1.0, self.roll() * TAU);
        let flat = (1.0 - z * z).max(0.0).sqrt();
        let (sin, cos) = libm::sincos(turn);
        DVec3::new(flat * cos, flat * sin, z)
    }
}

/// Frequency, octaves and gain of the noise that bends boundaries; frequency and gain of the noise of coasts.
const BEND: (f64, u32, f64) = (1.45, 5, 0.47);
const COAST: (f64, f64) = (2.1, 0.58);

/// Directions from which shares of the globe are counted.
const SURVEY: usize = 3000;

impl Layout {
    /// Lays out the plates of a planet with this seed.
    pub(crate) fn new(params: &Params, planet_seed: u32) -> Self {
        let seed = hash(hash(planet_seed, 0x0050_1A7E), params.seed);
        let mut dice = Dice(seed, 0);
        let count = params.count.max(2) as usize;
        let spacing = (4.0 * std::f64::consts::PI / count as f64).sqrt();
        let mut plates: Vec<Plate> = Vec::with_capacity(count);
        for k in 0..count {
            let center = far_from(&plates, &mut dice);
            let is_large = 3 * k < count;
            let size = dice.roll();
            let weight = if is_large { 0.10 + 0.22 * size } else { -0.14 * size };
            // The motion at the middle, and a turn about the middle.
            let (aim, turn, pace) = (dice.direction(), dice.roll() - 0.5, 0.6 + 0.8 * dice.roll());
            let pole = center.cross(aim).normalize_or(DVec3::Z) + center * turn;
            let pace = if is_large { pace } else { 1.2 * pace };
            plates.push(Plate {
                center,
                weight: weight * params.size_variation * spacing * spacing,
                pole: pole * (pace * params.drift_mm_yr / EARTH_KM),
                is_continental: false,
                cratons: Vec::new(),
                moved: None,
            });
        }
        let mut layout = Self {
            sides: Vec::new(),
            plates,
            volcanoes: Vec::new(),
            seed,
            bend_rad: 0.25 * params.raggedness,
            coast_rad: 0.16 + 0.34 * params.fragments,
            crust_rad: 0.0,
        };
        layout.add_continents(params, &mut dice);
        layout.change(&params.by_hand, spacing);
        layout.sides = (0..layout.plates.len()).map(|plate| Side::all(&layout.plates, plate)).collect();
        layout.add_volcanoes(params, &mut dice);
        layout
    }

    /// The direction by which plates and continents are found: bent, so that boundaries are ragged.
    pub(super) fn bent(&self, dir: DVec3) -> DVec3 {
        self.bent_by(dir, fbm3(dir, BEND.0, BEND.1, BEND.2, self.seed))
    }

    /// The same of a row of directions.
    pub(super) fn bent_row(&self, dirs: &[DVec3]) -> Vec<DVec3> {
        let bends = fbm3_row(dirs, BEND.0, BEND.1, BEND.2, self.seed);
        dirs.iter().zip(bends).map(|(dir, bend)| self.bent_by(*dir, bend)).collect()
    }

    fn bent_by(&self, dir: DVec3, bend: DVec3) -> DVec3 {
        let bent = dir + bend * self.bend_rad;
        bent * (1.0 / bent.length())
    }

    /// The plate at a direction.
    pub(crate) fn plate_under(&self, dir: DVec3) -> usize {
        self.plate_at(self.bent(dir))
    }

    /// The plate at a bent direction.
    pub(super) fn plate_at(&self, bent: DVec3) -> usize {
        let mut best = (f64::MIN, 0);
        for (id, plate) in self.plates.iter().enumerate() {
            let score = bent.dot(plate.center) + plate.weight;
            if score > best.0 {
                best = (score, id);
            }
        }
        best.1
    }

    /// How far inside the continents of a plate a bent direction lies, in radians; below zero outside. `home`: the
    /// direction in the home of the plate; `octaves` says how fine the coast is.
    fn crust_rad(&self, plate: usize, home: DVec3, octaves: u32) -> f64 {
        self.even_crust_rad(plate, home) + self.coast_rad(home, octaves)
    }

    /// How far noise moves the coast outwards.
    pub(super) fn coast_rad(&self, home: DVec3, octaves: u32) -> f64 {
        self.coast_rad * fbm(home, COAST.0, octaves, COAST.1, hash(self.seed, 11))
    }

    /// The same of a row of directions.
    pub(super) fn coast_rad_row(&self, homes: &[DVec3], octaves: u32) -> Vec<f64> {
        let mut coast = fbm_row(homes, COAST.0, octaves, COAST.1, hash(self.seed, 11));
        coast.iter_mut().for_each(|coast| *coast *= self.coast_rad);
        coast
    }

    /// The crust without the noise of the coast.
    pub(super) fn even_crust_rad(&self, plate: usize, home: DVec3) -> f64 {
        const SOFT: f64 = 0.16;
        let mut most = -0.6;
        for craton in &self.plates[plate].cratons {
            let (reach, away2) = (craton.radius_rad - most + SOFT, home.distance_squared(craton.center));
            // Too far to raise the maximum.
            if reach <= 0.0 || away2 >= reach * reach {
                continue;
            }
            let inside = craton.radius_rad - away2.sqrt();
            // A smooth maximum (Quilez): continents of one plate join.
            let near = (1.0 - (most - inside).abs() / SOFT).max(0.0);
            most = f64::max(most, inside) + near * near * (0.25 * SOFT);
        }
        most + self.crust_rad
    }

    /// The velocity of a plate at a direction, in radians per million years.
    pub(crate) fn velocity(&self, plate: usize, dir: DVec3) -> DVec3 {
        self.plates[plate].pole.cross(dir)
    }

    fn add_continents(&mut self, params: &Params, dice: &mut Dice) {
        let bent = self.bent_row(&spread(SURVEY).collect::<Vec<DVec3>>());
        let survey: Vec<(usize, DVec3)> = bent.into_iter().map(|bent| (self.plate_at(bent), bent)).collect();
        let share = |plate: usize| survey.iter().filter(|(p, _)| *p == plate).count() as f64 / SURVEY as f64;
        // Large plates first, each by chance, until there is room for the continents.
        let mut order: Vec<(f64, usize)> =
            (0..self.plates.len()).map(|id| (share(id) * (0.35 + dice.roll()), id)).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        let room = (params.continents * 1.75).min(1.0);
        let mut taken = 0.0;
        for (_, id) in order {
            if taken >= room {
                break;
            }
            // A plate that is larger than what is wanted stays an ocean.
            let size = share(id);
            if taken > 0.0 && taken + 0.4 * size > room {
                continue;
            }
            taken += size;
            let mine: Vec<DVec3> = survey.iter().filter(|(p, _)| *p == id).map(|(_, dir)| *dir).collect();
            self.plates[id].is_continental = true;
            self.plates[id].cratons = self.cratons(id, &mine, params.fragments, dice);
        }
        // The level at which continents have their share of the globe. Edits of single plates do not change it.
        let mut inside: Vec<f64> = survey.iter().map(|(plate, bent)| self.crust_rad(*plate, *bent, 4)).collect();
        inside.sort_by(|a, b| b.total_cmp(a));
        let wanted = (params.continents * SURVEY as f64) as usize;
        self.crust_rad = inside.get(wanted.min(SURVEY - 1)).map_or(0.0, |level| -level).clamp(-0.6, 0.45);
        for edit in &params.by_hand {
            let id = edit.plate as usize;
            let is_bare = self.plates.get(id).is_some_and(|plate| plate.cratons.is_empty());
            if is_bare && edit.kind == PlateKind::Continental {
                let mine: Vec<DVec3> = survey.iter().filter(|(p, _)| *p == id).map(|(_, dir)| *dir).collect();
                self.plates[id].cratons =
                    self.cratons(id, &mine, params.fragments, &mut Dice(hash(self.seed, 0x4A4D), edit.plate << 16));
            }
        }
    }

    /// Places cores of continents in a plate: towards the edge to which it moves, so that one coast is young and
    /// mountainous and the other is old and flat.
    fn cratons(&self, id: usize, mine: &[DVec3], fragments: f64, dice: &mut Dice) -> Vec<Craton> {
        let size = mine.len() as f64 / SURVEY as f64;
        let width = (4.0 * size).sqrt();
        let middle = mine.iter().sum::<DVec3>().normalize_or(DVec3::Z);
        let ahead = self.velocity(id, middle).normalize_or(DVec3::X);
        let want = (2.0 + size * (18.0 + 34.0 * fragments)) as usize;
        let lean = 0.25 + 0.5 * dice.roll();
        let mut left: Vec<(f64, DVec3)> = mine
            .iter()
            .map(|dir| {
                let away = dir.distance(middle) / width;
                (dir.dot(ahead) / width * lean - 0.55 * away + 0.5 * dice.roll(), *dir)
            })
            .collect();
        left.sort_by(|a, b| b.0.total_cmp(&a.0));
        let mut cratons: Vec<Craton> = Vec::new();
        let apart = 0.2 + 0.1 * fragments;
        for (_, dir) in left {
            if cratons.len() < want.min(12) && cratons.iter().all(|other| other.center.distance(dir) > apart) {
                let radius_rad = width * (0.12 + 0.2 * dice.roll()) * (1.15 - 0.5 * fragments);
                cratons.push(Craton { center: dir, radius_rad });
            }
        }
        cratons
    }

    fn add_volcanoes(&mut self, params: &Params, dice: &mut Dice) {
        const STEP_KM: f64 = 210.0;
        for _ in 0..params.hot_spots {
            let spot = dice.direction();
            let plate = self.plate_at(self.bent(spot));
            let pole = self.plates[plate].pole;
            let speed_km = (pole.cross(spot).length() * EARTH_KM).max(5.0);
            let chain = 4 + (dice.roll() * 9.0) as u32;
            let size = 0.55 + 0.45 * dice.roll();
            for k in 0..chain {
                let age_myr = f64::from(k) * STEP_KM / speed_km;
                // The plate has carried an old volcano away, and it has sunk and been worn.
                let carried = rotated(spot, pole, age_myr);
                let aside = DVec3::new(dice.roll() - 0.5, dice.roll() - 0.5, dice.roll() - 0.5) * 0.016;
                let worn = 1.0 - 0.8 * f64::from(k) / f64::from(chain);
                let height = size * worn * (0.75 + 0.25 * dice.roll());
                self.volcanoes.push(Volcano {
                    center: (carried + aside).normalize(),
                    height: if k == 0 { size } else { height },
                    radius_rad: (150.0 + 60.0 * dice.roll()) * (0.6 + 0.4 * size) / EARTH_KM,
                });
            }
        }
    }
}

/// The best of a few random directions: the one farthest from all plates (Mitchell 1991).
fn far_from(plates: &[Plate], dice: &mut Dice) -> DVec3 {
    let mut best = (f64::MIN, DVec3::Z);
    for _ in 0..6 {
        let dir = dice.direction();
        let nearest = plates.iter().map(|plate| plate.center.distance_squared(dir)).fold(4.0, f64::min);
        if nearest > best.0 {
            best = (nearest, dir);
        }
    }
    best.1
}

/// A direction rotated about a pole whose length is an angular speed (Rodrigues' formula).
pub(super) fn rotated(dir: DVec3, pole: DVec3, time: f64) -> DVec3 {
    let speed = pole.length();
    if speed <= 0.0 {
        return dir;
    }
    let axis = pole * (1.0 / speed);
    let (sin, cos) = libm::sincos(speed * time);
    dir * cos + axis.cross(dir) * sin + axis * (axis.dot(dir) * (1.0 - cos))
}
