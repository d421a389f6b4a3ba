//! Horizon tiles: the horizon angles and the sky visibility at each vertex of a node.
//!
//! They do not depend on the star: ground is lit where the star is higher than the horizon in its azimuth, so moving
//! the star recomputes nothing (Max, Horizon Mapping, 1988). Azimuths are measured in the coordinates of the face, from
//! 0 towards growing `s` to a quarter turn towards growing `t`, the same for all tiles of a face.

use super::tile::TILE_QUADS;
use crate::sphere::cube::C_SQUARED;
use crate::sphere::{Face, NodeId};
use glam::DVec3;
use half::f16;

/// Number of azimuths, evenly spaced. Between them the horizon is a cubic through the four nearest (Catmull and Rom),
/// so that the shadow of a peak does not shrink while the star moves from one azimuth to the next.
pub const AZIMUTHS: usize = 48;
/// Images of a horizon tile: one for each azimuth, and the sky visibility.
pub const HORIZON_IMAGES: usize = AZIMUTHS + 1;
/// Points along the side of the parent's values in a tile.
pub const COARSE_SIDE: usize = TILE_QUADS / 2 + 1;

/// The horizon angles at each vertex of a node.
#[derive(Debug)]
pub struct HorizonTile {
    /// The node.
    pub id: NodeId,
    /// Unique: the key under which a renderer keeps its copy.
    pub serial: u64,
    /// [`HORIZON_IMAGES`] images of [`super::tile::TILE_VERTICES`] values. First the sine of the elevation of the
    /// horizon, an image for each azimuth. Then the sky visibility: the share of the sky light on level ground that the
    /// surrounding ground lets through, relative to a plane with the local slope.
    pub own: Vec<f16>,
    /// The parent's values, on every second vertex of every second row ([`COARSE_SIDE`] squared values an image).
    pub coarse: Vec<f16>,
    /// Content key of the ground that it was made from.
    pub(crate) key: u64,
    /// For each azimuth and vertex, the tangent of the horizon of all ground that is too far for the children to march
    /// over, and its nearness: vertex spacings over distance. Only if the node is split.
    pub(crate) far: Option<Vec<[f16; 2]>>,
}

impl HorizonTile {
    /// Resident size.
    pub(crate) fn bytes(&self) -> usize {
        let far = self.far.as_ref().map_or(0, |far| far.len() * size_of::<[f16; 2]>());
        (self.own.len() + self.coarse.len()) * size_of::<f16>() + far
    }
}

/// A direction along the ground at a point of a face, as a step (not normalised) in the coordinates of the face.
///
/// A step along `towards` moves the point on the flat face by its part within the face; the derivative of the face's
/// mapping (see [`crate::sphere::cube`]) converts that to coordinates.
pub fn face_step(face: Face, dir_planet: DVec3, towards_planet: DVec3) -> [f64; 2] {
    let (axis, sign) = face.axis();
    let ((s_axis, s_sign), t_axis) = face.tangent_axes();
    let out = dir_planet[axis] * sign as f64;
    let sunk = towards_planet[axis] * sign as f64;
    let step = |axis: usize, sign: f64| {
        let q = dir_planet[axis] * sign / out;
        let bend = 1.0 + C_SQUARED * q * q;
        (towards_planet[axis] * sign - q * sunk) / (bend * bend.sqrt())
    };
    [step(s_axis, s_sign as f64), step(t_axis, 1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_on_the_face_leads_the_way_it_should() {
        for face in Face::ALL {
            let node = NodeId { level: 0, face, x: 0, y: 0 };
            for (u, v) in [(0.5, 0.5), (0.1, 0.8), (0.97, 0.02)] {
                let at = node.direction(u, v);
                for turn in 0..8 {
                    let (b, a) = libm::sincos(f64::from(turn) * 0.7);
                    let towards = node.direction(u + a * 1e-5, v + b * 1e-5) - at;
                    let [s, t] = face_step(face, at, towards.normalize());
                    let off = s.atan2(t) - a.atan2(b);
                    let off = off - (off / std::f64::consts::TAU).round() * std::f64::consts::TAU;
                    assert!(off.abs() < 1e-3, "{face:?} {u} {v} {turn}: {off}");
                }
            }
        }
    }
}
