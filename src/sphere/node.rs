//! Addresses of quadtree nodes: a face, a level, and column and row in the grid of that level.

use super::cube::{self, Face};
use glam::DVec3;

/// A node: one of the `2^level` by `2^level` squares of a face. Small, ordered, and the key of every cache.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct NodeId {
    /// 0 is a whole face.
    pub level: u8,
    /// The face it lies on.
    pub face: Face,
    /// Column, growing with `s`.
    pub x: u32,
    /// Row, growing with `t`.
    pub y: u32,
}

/// One side of a node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    /// Towards lower `s`.
    Left,
    /// Towards higher `s`.
    Right,
    /// Towards lower `t`.
    Bottom,
    /// Towards higher `t`.
    Top,
}

impl Edge {
    /// All four. The bit of an edge in a mask is its index here.
    pub const ALL: [Edge; 4] = [Edge::Left, Edge::Right, Edge::Bottom, Edge::Top];

    /// The bit of this edge in a mask of edges.
    pub fn bit(self) -> u8 {
        1 << self as u8
    }
}

impl NodeId {
    /// The finest level: 0.1 m between vertices on a planet of the Earth's size.
    pub const MAX_LEVEL: u8 = 22;

    /// The six whole faces.
    pub fn roots() -> [NodeId; 6] {
        Face::ALL.map(|face| NodeId { level: 0, face, x: 0, y: 0 })
    }

    /// The node that contains this one, `None` for a whole face.
    pub fn parent(self) -> Option<NodeId> {
        (self.level > 0).then(|| NodeId { level: self.level - 1, x: self.x / 2, y: self.y / 2, ..self })
    }

    /// The four quarters: lower left, lower right, upper left, upper right.
    pub fn children(self) -> [NodeId; 4] {
        let child =
            |i: u32| NodeId { level: self.level + 1, x: self.x * 2 + (i & 1), y: self.y * 2 + (i >> 1), ..self };
        [child(0), child(1), child(2), child(3)]
    }

    /// All nodes of a level in this one, at least its own, row by row.
    pub(crate) fn descendants(self, level: u8) -> impl Iterator<Item = NodeId> {
        let deeper = level.saturating_sub(self.level);
        let first = [self.x << deeper, self.y << deeper];
        let side = 1_u32 << deeper;
        (0..side).flat_map(move |y| {
            (0..side).map(move |x| NodeId { level: self.level + deeper, x: first[0] + x, y: first[1] + y, ..self })
        })
    }

    /// Which quarter of its parent this is: 0 or 1 along each axis.
    pub fn quarter(self) -> (usize, usize) {
        ((self.x & 1) as usize, (self.y & 1) as usize)
    }

    /// The width of this node as a share of a node that contains it, and its lower corner there, `u` and `v` from 0
    /// to 1.
    pub fn within(self, other: NodeId) -> [f64; 3] {
        let width = 1.0 / f64::from(1_u32 << (self.level - other.level.min(self.level)));
        [width, f64::from(self.x) * width - f64::from(other.x), f64::from(self.y) * width - f64::from(other.y)]
    }

    /// The `(s, t)` of a point of the node, `u` and `v` from 0 to 1 across it. Exact when they are multiples of a
    /// power of two that is not too small, so that neighbours agree on shared points to the bit.
    pub fn face_coordinates(self, u: f64, v: f64) -> (f64, f64) {
        let scale = 2.0 / f64::from(1_u32 << self.level);
        ((f64::from(self.x) + u) * scale - 1.0, (f64::from(self.y) + v) * scale - 1.0)
    }

    /// The share `number / count` of a side, to a multiple of 2⁻³²: at such shares neighbours agree on shared points to
    /// the bit, whatever the count.
    pub fn side_share(number: u32, count: u32) -> f64 {
        const STEPS: f64 = (1_u64 << 32) as f64;
        (f64::from(number) / f64::from(count) * STEPS).round() / STEPS
    }

    /// Unit vector through a point of the node; see [`NodeId::face_coordinates`].
    pub fn direction(self, u: f64, v: f64) -> DVec3 {
        let (s, t) = self.face_coordinates(u, v);
        cube::direction(self.face, s, t)
    }

    /// The node of a level that contains a direction.
    pub fn containing(dir: DVec3, level: u8) -> NodeId {
        let (face, s, t) = cube::face_point(dir);
        let side = 1_u32 << level;
        let cell = |w: f64| (((w + 1.0) * 0.5 * f64::from(side)).max(0.0) as u32).min(side - 1);
        NodeId { level, face, x: cell(s), y: cell(t) }
    }

    /// The node of the same level across an edge, on whichever face it lies.
    ///
    /// The method works on the cube's integer grid: in units of half a cell the centre of a node has odd coordinates,
    /// and its face lies at ±2^level. A step over the edge of a face turns the crossing coordinate into the new
    /// face's normal.
    pub fn neighbour(self, edge: Edge) -> NodeId {
        let side = 1_i64 << self.level;
        let (mut x, mut y) = (i64::from(self.x), i64::from(self.y));
        match edge {
            Edge::Left => x -= 1,
            Edge::Right => x += 1,
            Edge::Bottom => y -= 1,
            Edge::Top => y += 1,
        }
        if (0..side).contains(&x) && (0..side).contains(&y) {
            return NodeId { x: x as u32, y: y as u32, ..self };
        }
        let (axis, sign) = self.face.axis();
        let ((s_axis, s_sign), t_axis) = self.face.tangent_axes();
        let mut p = [0_i64; 3];
        // Over the edge: the crossing coordinate is clamped to the edge, and the old normal sinks by half a cell.
        p[axis] = sign * (side - 1);
        p[s_axis] = s_sign * (2 * x + 1 - side).clamp(-side, side);
        p[t_axis] = (2 * y + 1 - side).clamp(-side, side);
        let new_axis = if matches!(edge, Edge::Left | Edge::Right) { s_axis } else { t_axis };
        let face = Face::from_axis(new_axis, p[new_axis] > 0);
        let ((s_axis, s_sign), t_axis) = face.tangent_axes();
        let cell = |w: i64| ((w + side - 1) / 2) as u32;
        NodeId { level: self.level, face, x: cell(p[s_axis] * s_sign), y: cell(p[t_axis]) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn neighbours_share_an_edge_and_know_each_other() {
        for level in 0..5 {
            let side = 1_u32 << level;
            for face in Face::ALL {
                for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
                    let node = NodeId { level, face, x, y };
                    for edge in Edge::ALL {
                        let other = node.neighbour(edge);
                        assert!(
                            Edge::ALL.iter().any(|&back| other.neighbour(back) == node),
                            "{node:?} {edge:?} {other:?}"
                        );
                        let corners = |n: NodeId| {
                            [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)]
                                .map(|(u, v)| n.direction(u, v).to_array().map(|c| (c + 0.0).to_bits()))
                        };
                        let shared = corners(node).iter().filter(|c| corners(other).contains(c)).count();
                        assert!(shared >= 2, "{node:?} {edge:?} {other:?} share {shared} corners");
                    }
                }
            }
        }
    }

    #[test]
    fn neighbours_share_points_whatever_the_count() {
        let bits = |dir: DVec3| dir.to_array().map(|c| (c + 0.0).to_bits());
        for count in [3, 30, 97] {
            for level in [0, 3] {
                let side = 1 << level;
                for node in Face::ALL.map(|face| NodeId { level, face, x: side - 1, y: side / 2 }) {
                    let border = |node: NodeId| -> Vec<[u64; 3]> {
                        let sides = (0..=count).flat_map(|i| {
                            let share = NodeId::side_share(i, count);
                            [(share, 0.0), (share, 1.0), (0.0, share), (1.0, share)]
                        });
                        sides.map(|(u, v)| bits(node.direction(u, v))).collect()
                    };
                    for edge in Edge::ALL {
                        let (here, there) = (border(node), border(node.neighbour(edge)));
                        let shared = here.iter().filter(|point| there.contains(point)).count();
                        assert!(shared > count as usize, "{node:?} {edge:?} share {shared} points of {count}");
                    }
                }
            }
        }
    }

    #[test]
    fn all_24_face_edges_lead_to_another_face() {
        let crossings = NodeId::roots()
            .iter()
            .flat_map(|root| Edge::ALL.map(|edge| (root.face, root.neighbour(edge).face)))
            .filter(|(from, to)| from != to && from.axis().0 != to.axis().0)
            .count();
        assert_eq!(crossings, 24);
    }

    #[test]
    fn a_node_contains_its_centre() {
        for level in [0, 1, 5, NodeId::MAX_LEVEL] {
            for face in Face::ALL {
                let side = 1_u32 << level;
                let node = NodeId { level, face, x: side / 3, y: side - 1 };
                assert_eq!(NodeId::containing(node.direction(0.5, 0.5), level), node);
            }
        }
    }

    #[test]
    fn children_cover_their_parent() {
        let node = NodeId { level: 3, face: Face::NegY, x: 5, y: 2 };
        for child in node.children() {
            assert_eq!(child.parent(), Some(node));
            let (qx, qy) = child.quarter();
            assert_eq!(child.direction(0.0, 0.0), node.direction(qx as f64 * 0.5, qy as f64 * 0.5));
        }
    }
}
