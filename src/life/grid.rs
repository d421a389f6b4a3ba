//! Cells of a population: nodes of the quadtree whose side suits its density, and the candidates in each.

use super::hash::Dice;
use crate::planet::{Planet, Population};
use crate::sphere::{Face, NodeId, cube};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI};

/// Objects of a full cell, about.
const CELL_OBJECTS: f64 = 100.0;
/// Shortest and longest side of a cell in metres.
const SIDE_M: [f64; 2] = [4.0, 2000.0];
/// Share of its square within which a candidate lies, so that neighbours keep apart.
const JITTER: f64 = 0.86;
/// Share by which a sum of angles may be wrong, with room to spare.
const ROUNDING: f64 = 1e-9;
/// Square metres of a hectare.
pub(super) const HECTARE_M2: f64 = 10_000.0;

/// The cells of a population on a planet.
#[derive(Clone, Debug)]
pub(super) struct Grid {
    /// Level of the cells.
    pub(super) level: u8,
    radius_m: f64,
    seed: u64,
    /// Candidates on a square metre: as many as may stand anywhere.
    most_per_m2: f64,
}

/// A candidate: a place where an object may stand. Its direction is [`NodeId::direction`] of its cell and place, which
/// takes longer to find than the rest.
#[derive(Clone, Copy, Debug)]
pub(super) struct Candidate {
    pub(super) id: u64,
    /// Place in the cell, 0 to 1.
    pub(super) place: [f64; 2],
    /// Rank, 0 to 1: it stands if the rank is below the share of the greatest density that suits the place.
    pub(super) rank: f64,
    /// Further random numbers.
    pub(super) dice: Dice,
}

impl Grid {
    pub(super) fn new(planet: &Planet, population: &Population) -> Self {
        let radius_m = planet.radius_m();
        let most_per_m2 = population.per_hectare / HECTARE_M2 * (1.0 + population.clumping);
        let wanted_m = (CELL_OBJECTS / most_per_m2).sqrt().clamp(SIDE_M[0], SIDE_M[1]);
        let mut level = 0;
        let mut side_m = FRAC_PI_2 * radius_m;
        while side_m > wanted_m && level < NodeId::MAX_LEVEL {
            (level, side_m) = (level + 1, 0.5 * side_m);
        }
        let seed = u64::from(planet.seed) << 32 | u64::from(population.seed);
        Self { level, radius_m, seed, most_per_m2 }
    }

    /// The candidates of a cell, in rows.
    pub(super) fn candidates(&self, cell: NodeId) -> impl Iterator<Item = Candidate> {
        let (count, share) = self.count_of(cell);
        let dice = Dice::of_cell(self.seed, cell);
        (0..count * count).map(move |lane| {
            let mut dice = dice.lane(lane);
            let id = dice.id();
            let square = [lane % count, lane / count].map(f64::from);
            let place = square.map(|corner| (corner + 0.5 + JITTER * (dice.next() - 0.5)) / f64::from(count));
            let rank = dice.next() / share;
            Candidate { id, place, rank, dice }
        })
    }

    /// The candidate of an object that is placed by hand. It stands whatever the ground offers.
    pub(super) fn placed(&self, cell: NodeId, dir: DVec3) -> Candidate {
        let dice = Dice::of_place(self.seed, dir);
        Candidate { id: dice.id(), place: place_in(cell, dir), rank: 0.0, dice }
    }

    /// Candidates along a side of a cell, and the share of them that stands where everything suits them.
    fn count_of(&self, cell: NodeId) -> (u32, f64) {
        let wanted = self.most_per_m2 * self.area_m2(cell);
        let count = wanted.sqrt().ceil().clamp(1.0, 512.0);
        (count as u32, (wanted / (count * count)).min(1.0))
    }

    /// Mean area of a cell.
    pub(super) fn mean_cell_m2(&self) -> f64 {
        4.0 * PI * self.radius_m * self.radius_m / (6.0 * f64::from(self.level).exp2().powi(2))
    }

    /// Area of a cell: that of the four-sided figure between its corners.
    fn area_m2(&self, cell: NodeId) -> f64 {
        let corner = |u, v| cell.direction(u, v) * self.radius_m;
        let diagonals = [corner(1.0, 1.0) - corner(0.0, 0.0), corner(0.0, 1.0) - corner(1.0, 0.0)];
        0.5 * diagonals[0].cross(diagonals[1]).length()
    }

    /// Cells that touch a disc around a direction, `radius_m` along the sphere, in ascending order.
    pub(super) fn cells_within(&self, dir: DVec3, radius_m: f64) -> Vec<NodeId> {
        self.nodes_within(self.level, dir, radius_m)
    }

    /// Nodes of a level that touch a disc around a direction, `radius_m` along the sphere, in ascending order.
    pub(super) fn nodes_within(&self, level: u8, dir: DVec3, radius_m: f64) -> Vec<NodeId> {
        let reach_rad = radius_m / self.radius_m;
        let mut found = Vec::new();
        let mut open: Vec<NodeId> = NodeId::roots().into();
        while let Some(node) = open.pop() {
            let middle = node.direction(0.5, 0.5);
            let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)].map(|(u, v)| node.direction(u, v));
            let half_rad = corners.map(|corner| angle(middle, corner)).into_iter().fold(0.0, f64::max);
            let away_rad = angle(middle, dir);
            if away_rad > reach_rad + half_rad {
                continue;
            }
            // The sides of a node are great circles, so that no point of it is farther from its middle than a corner.
            if node.level == level || (away_rad + half_rad) * (1.0 + ROUNDING) < reach_rad {
                found.extend(node.descendants(level));
            } else {
                open.extend(node.children());
            }
        }
        found.sort_unstable();
        found
    }

    /// Adds the cells that a cone around a direction covers, and perhaps some more; faster than [`Self::cells_within`].
    /// `share`: sine of the cone's angle.
    pub(super) fn add_cells_under(&self, dir: DVec3, share: f64, found: &mut Vec<NodeId>) {
        let wide = cube::tangent_of(share);
        let side = f64::from(1_u32 << self.level);
        let cell = |w: f64| ((w + 1.0) * 0.5 * side).clamp(0.0, side - 1.0) as u32;
        for face in Face::ALL {
            let Some([s, t]) = cube::part_under(face, dir, wide) else { continue };
            let [columns, rows] = [s, t].map(|w| w.map(cell));
            let nodes = (rows[0]..=rows[1]).flat_map(|y| (columns[0]..=columns[1]).map(move |x| (x, y)));
            found.extend(nodes.map(|(x, y)| NodeId { level: self.level, face, x, y }));
        }
    }
}

/// Place of a direction in a node, 0 to 1.
pub(super) fn place_in(node: NodeId, dir: DVec3) -> [f64; 2] {
    let (_, s, t) = cube::face_point(dir);
    let side = f64::from(1_u32 << node.level);
    let within = |w: f64, corner: u32| ((w + 1.0) * 0.5 * side - f64::from(corner)).clamp(0.0, 1.0);
    [within(s, node.x), within(t, node.y)]
}

/// Angle between unit vectors; precise where it is small.
pub(super) fn angle(a: DVec3, b: DVec3) -> f64 {
    2.0 * libm::asin((0.5 * (a - b).length()).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::spread;

    #[test]
    fn cells_within_a_disc_are_all_that_touch_it_in_order() {
        let planet = Planet { radius_km: 3.0, ..Planet::default() };
        let grid = Grid::new(&planet, &Population { per_hectare: 2.0, ..Population::default() });
        assert!(grid.level > 2, "{}", grid.level);
        for (dir, radius_m) in spread(12).zip([0.0, 10.0, 300.0, 900.0, 2500.0, 9000.0].into_iter().cycle()) {
            let touches = |node: &NodeId| {
                let middle = node.direction(0.5, 0.5);
                let corners = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)];
                let half_rad =
                    corners.map(|(u, v)| angle(middle, node.direction(u, v))).into_iter().fold(0.0, f64::max);
                angle(middle, dir) <= radius_m / 3000.0 + half_rad
            };
            let mut right = Vec::from(NodeId::roots());
            for _ in 0..grid.level {
                right = right.iter().filter(|node| touches(node)).flat_map(|node| node.children()).collect();
            }
            right.retain(touches);
            right.sort_unstable();
            assert_eq!(grid.cells_within(dir, radius_m), right, "{radius_m}");
        }
    }
}
