//! Smooth ground: a quadratic B-spline through the heights at the nodes of a cubic lattice in space. It has no detail
//! finer than the lattice, is the same at every level of detail, and knows neither poles nor the edges of the cube.
//! The height at a node is that of the ground under its direction, as the earlier edits left it.

use super::memory::{Known, Node, Nodes};
use glam::DVec3;

/// Nodes for each size of what is smoothed away.
const NODES: f64 = 2.0;
/// Widest lattice: some nodes around a point of the sphere must lie near it.
const WIDEST: f64 = 0.3;
/// Distance within which smooth ground depends on the ground, in nodes; more than the half diagonal of 3 by 3 by 3.
const REACH: f64 = 3.0;

/// A lattice.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Lattice {
    spacing: f64,
}

/// The nodes around a point, with the weight of each along the axes and its derivative.
struct Around {
    first: Node,
    weights: [[f64; 3]; 3],
    slopes: [[f64; 3]; 3],
}

impl Lattice {
    /// A lattice that smooths away what is smaller than an angle.
    pub(super) fn new(size_rad: f64) -> Self {
        Self { spacing: (size_rad / NODES).min(WIDEST) }
    }

    /// Chord within which smooth ground depends on the ground.
    pub(super) fn reach_rad(&self) -> f64 {
        // On a wide lattice, a node inside the sphere stands for ground farther away.
        self.spacing * REACH * (1.0 + 4.0 * self.spacing)
    }

    fn around(&self, dir: DVec3) -> Around {
        let place = dir / self.spacing;
        let middle = place.round();
        let share = (place - middle).to_array();
        // The three pieces of a quadratic B-spline.
        let weights = share.map(|f| [0.5 * (0.5 - f) * (0.5 - f), 0.75 - f * f, 0.5 * (0.5 + f) * (0.5 + f)]);
        let slopes = share.map(|f| [f - 0.5, -2.0 * f, f + 0.5].map(|slope| slope / self.spacing));
        Around { first: middle.to_array().map(|x| x as i64 - 1), weights, slopes }
    }

    /// The direction of a node. A node in the centre of the planet counts as the north pole.
    pub(super) fn dir(&self, node: Node) -> DVec3 {
        DVec3::from_array(node.map(|x| x as f64)).normalize_or(DVec3::Z)
    }

    /// Adds the nodes around a direction.
    pub(super) fn ask(&self, dir: DVec3, nodes: &mut Nodes) {
        let [x, y, z] = self.around(dir).first;
        for k in 0..3 {
            for j in 0..3 {
                nodes.extend((0..3).map(|i| [x + i, y + j, z + k]));
            }
        }
    }

    /// The smooth height at a direction and its gradient, from the heights of nodes.
    pub(super) fn at(&self, dir: DVec3, known: &Known<f64>) -> (f64, DVec3) {
        let Around { first, weights, slopes } = self.around(dir);
        let (mut height_m, mut gradient) = (0.0, DVec3::ZERO);
        for k in 0..3 {
            for j in 0..3 {
                for i in 0..3 {
                    let node = [first[0] + i as i64, first[1] + j as i64, first[2] + k as i64];
                    let at_node_m = known.get(&node).copied().unwrap_or(0.0);
                    let [w, s] = [&weights, &slopes].map(|of| [of[0][i], of[1][j], of[2][k]]);
                    height_m += w[0] * w[1] * w[2] * at_node_m;
                    gradient += DVec3::new(s[0] * w[1] * w[2], w[0] * s[1] * w[2], w[0] * w[1] * s[2]) * at_node_m;
                }
            }
        }
        (height_m, gradient)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_ground_keeps_slopes_and_has_the_gradient_of_its_heights() {
        let lattice = Lattice::new(0.02);
        let fill = |dir: DVec3, ground: &dyn Fn(DVec3) -> f64| {
            let mut nodes = Nodes::default();
            lattice.ask(dir, &mut nodes);
            nodes.into_iter().map(|node| (node, ground(lattice.dir(node)))).collect::<Known<f64>>()
        };
        let dir = DVec3::new(0.3, -0.5, 0.7).normalize();
        let slope = |dir: DVec3| 1000.0 * dir.x - 300.0 * dir.z;
        let (height_m, _) = lattice.at(dir, &fill(dir, &slope));
        assert!((height_m - slope(dir)).abs() < 1.0, "{height_m} {}", slope(dir));

        let rough = |dir: DVec3| 100.0 * (dir.x * 70.0).sin() * (dir.y * 90.0).cos();
        let along = DVec3::new(0.5, 0.3, 0.0).normalize();
        let at = |by: f64| lattice.at(dir + along * by, &fill(dir + along * by, &rough)).0;
        let (_, gradient) = lattice.at(dir, &fill(dir, &rough));
        let by_difference = (at(1e-6) - at(-1e-6)) / 2e-6;
        assert!((gradient.dot(along) - by_difference).abs() < 1e-3 * by_difference.abs().max(1.0));
    }
}
