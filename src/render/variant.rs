//! The variants of the pipelines that draw a body: each leaves out what the body does not need. An `if` on a uniform
//! does not save it: software adapters run both branches, and run the body of a loop once that counts to 0.

use super::nearness::Nearness;
use super::shared::Body;

/// What a pipeline is made for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Variant {
    /// How near the eye is to the body.
    pub(crate) nearness: Nearness,
    /// Whether the body has no rings, no occluders, and no points of light behind it.
    pub(crate) is_alone: bool,
    /// Whether it is a gas giant.
    pub(crate) is_giant: bool,
    /// Whether the eye is near the pieces of its rings.
    pub(crate) is_in_rings: bool,
    /// Whether the eye is in the clouds of the giant or just above.
    pub(crate) is_in_giant: bool,
}

/// Which variants a pass has: its shader has the constants of these.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Varies {
    /// One for all bodies.
    Never,
    /// For bodies that are alone, and for others; for an eye near the pieces of rings, or in the clouds of a giant.
    WithNeighbours,
    /// The same for each nearness.
    WithNearness,
}

impl Variant {
    /// Of most bodies seen from afar: the one that is made first.
    pub(crate) const FIRST: Self =
        Self { nearness: Nearness::Orbit, is_alone: true, is_giant: false, is_in_rings: false, is_in_giant: false };

    /// Of a body with these uniforms.
    pub(crate) fn of(body: &Body, pixel_rad: f32) -> Self {
        Self {
            nearness: Nearness::of(body, pixel_rad),
            is_alone: body.occluder_count == 0 && body.ring_count == 0 && body.point_count == 0,
            is_giant: body.is_giant == 1,
            is_in_rings: body.ring_class_count > 0,
            is_in_giant: body.is_in_giant == 1,
        }
    }

    /// The variant that a pass draws a body with: bodies between which it does not tell share one.
    pub(crate) fn among(self, varies: Varies) -> Self {
        match varies {
            Varies::Never => Self::FIRST,
            Varies::WithNeighbours => Self { nearness: Nearness::Orbit, is_giant: false, ..self },
            Varies::WithNearness => Self { is_giant: false, ..self.of_ground() },
        }
    }

    /// The variant that the ground of a body is drawn with: pieces of rings and the haze of a giant are no part of it.
    pub(crate) fn of_ground(self) -> Self {
        Self { is_in_rings: false, is_in_giant: false, ..self }
    }

    /// The constants of the shaders of such a pass.
    pub(crate) fn constants(self, varies: Varies) -> Vec<(&'static str, f64)> {
        let alone = ("ALONE", f64::from(u8::from(self.is_alone)));
        match varies {
            Varies::Never => Vec::new(),
            Varies::WithNeighbours => {
                let flag = |is_set: bool| f64::from(u8::from(is_set));
                vec![alone, ("RING_PIECES", flag(self.is_in_rings)), ("IN_GIANT", flag(self.is_in_giant))]
            }
            Varies::WithNearness => vec![self.nearness.constant(), alone],
        }
    }

    /// The constants of the shader of the ground.
    pub(crate) fn constants_of_ground(self) -> Vec<(&'static str, f64)> {
        let giant = ("GIANT", f64::from(u8::from(self.is_giant)));
        [self.constants(Varies::WithNearness), vec![giant]].concat()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bodies_share_pipelines_but_where_they_need_another() {
        let of = |body: &Body| Variant::of(body, 0.001);
        let plain = Body { radius_km: 6371.0, eye_altitude_km: 2e4, ..Body::default() };
        let ringed = Body { ring_count: 1, ..plain };
        let giant = Body { is_giant: 1, ..plain };
        assert_eq!(of(&plain), Variant::FIRST);
        assert!(!of(&ringed).is_alone && !of(&Body { occluder_count: 1, ..plain }).is_alone);
        assert!(of(&giant).is_giant && of(&giant).is_alone);
        for varies in [Varies::Never, Varies::WithNeighbours, Varies::WithNearness] {
            assert_eq!(of(&giant).among(varies), of(&plain).among(varies));
            assert_eq!(of(&ringed).among(varies) == of(&plain).among(varies), varies == Varies::Never);
        }
    }
}
