//! A horizon tile: how high the ground around stands over each vertex of a node, whichever way one looks.
//!
//! It knows nothing of the star: where the star stands higher than the horizon in its azimuth a place is lit, so that moving
//! it makes nothing anew (Max, Horizon Mapping, 1988). Azimuths are those of the face's own coordinates: 0 towards growing
//! `s`, a quarter turn towards growing `t`, so that all tiles of a face mean the same by them.

use super::tile::TILE_QUADS;
use crate::sphere::cube::C_SQUARED;
use crate::sphere::{Face, NodeId};
use glam::DVec3;
use half::f16;

/// Azimuths in which a horizon is known, evenly around. Between them it is a cubic through the four nearest (Catmull and Rom), so that
/// the shadow of a peak does not shrink while the star moves from one to the next.
pub const AZIMUTHS: usize = 48;
/// Images of a horizon tile: one for each azimuth, and the openness.
pub const HORIZON_IMAGES: usize = AZIMUTHS + 1;
/// Points along the side of what a tile keeps of its parent.
pub const COARSE_SIDE: usize = TILE_QUADS / 2 + 1;

/// The horizon at each vertex of a node.
#[derive(Debug)]
pub struct HorizonTile {
    /// The node.
    pub id: NodeId,
    /// Different for any two ever made: the key under which a renderer keeps its copy.
    pub serial: u64,
    /// [`HORIZON_IMAGES`] images of [`super::tile::TILE_VERTICES`] values. First the sine of the horizon's elevation, an
    /// image for each azimuth. Then the openness: the share of the sky's light on level ground that the ground around lets through, over
    /// what a plane with the slope of the place would.
    pub own: Vec<f16>,
    /// The same as the parent has it, on every second vertex of every second row ([`COARSE_SIDE`] squared values an image).
    pub coarse: Vec<f16>,
    /// Equal for equal grounds: hash of all it was made from.
    pub(crate) key: u64,
    /// For each azimuth and vertex the tangent of the horizon of all that is farther away than the children look for
    /// themselves, and how near that is: vertex spacings over distance. Only where the node is split.
    pub(crate) far: Option<Vec<[f16; 2]>>,
}

impl HorizonTile {
    /// Resident size, for the cache's budget.
    pub(crate) fn bytes(&self) -> usize {
        let far = self.far.as_ref().map_or(0, |far| far.len() * size_of::<[f16; 2]>());
        (self.own.len() + self.coarse.len()) * size_of::<f16>() + far
    }
}

/// A direction along the ground at a place of a face, as a (not normalised) step in the face's coordinates.
///
/// Moving along `towards` moves the point of the cube's face by its part within the face, and the bend of the coordinates
/// (see [`crate::sphere::cube`]) is undone by its derivative.
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
