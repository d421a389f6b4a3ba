//! The squares of a mesh on the sphere, and the frame of its vertices.

use super::{Area, Region};
use crate::sphere::{LatLon, NodeId, Tangent};
use glam::DVec3;
use std::f64::consts::FRAC_PI_2;

/// A square of the sphere with its coordinates: `u` to the right and `v` downwards, 0 to 1, as those of its textures.
pub(super) struct Square {
    kind: Kind,
    pub(super) radius_m: f64,
    /// The origin of the frame of the mesh.
    origin_planet_m: DVec3,
}

enum Kind {
    /// A node of the quadtree.
    Node(NodeId),
    /// A region and half the angle of its side.
    Region(Tangent, f64),
}

impl Square {
    /// The squares of an area.
    pub(super) fn all(area: &Area, radius_m: f64) -> Vec<Self> {
        match area {
            Area::Globe => NodeId::roots().map(|root| Self::of_node(root, radius_m, DVec3::ZERO)).into(),
            Area::Region(Region { lat_deg, lon_deg, side_km }) => {
                let tangent = Tangent::at(LatLon::from_degrees(*lat_deg, *lon_deg));
                let kind = Kind::Region(tangent, 500.0 * side_km / radius_m);
                vec![Self { kind, radius_m, origin_planet_m: tangent.up_planet * radius_m }]
            }
        }
    }

    /// The square of a node, about an origin.
    pub(super) fn of_node(node: NodeId, radius_m: f64, origin_planet_m: DVec3) -> Self {
        Self { kind: Kind::Node(node), radius_m, origin_planet_m }
    }

    pub(super) fn name(&self) -> &'static str {
        match &self.kind {
            Kind::Region(..) => "region",
            Kind::Node(node) => node.face.name(),
        }
    }

    /// Unit direction in the planet frame at `u`, `v`.
    pub(super) fn direction(&self, u: f64, v: f64) -> DVec3 {
        match &self.kind {
            Kind::Node(node) => node.direction(u, 1.0 - v),
            Kind::Region(tangent, half_rad) => {
                tangent.direction((2.0 * u - 1.0) * half_rad, (1.0 - 2.0 * v) * half_rad)
            }
        }
    }

    /// Mean angle between points `1 / count` of a side apart.
    pub(super) fn spacing_rad(&self, count: u32) -> f64 {
        let side_rad = match &self.kind {
            Kind::Node(node) => FRAC_PI_2 / f64::from(1_u32 << node.level),
            Kind::Region(_, half_rad) => 2.0 * half_rad,
        };
        side_rad / f64::from(count)
    }

    /// A vector of the planet frame in the frame of the mesh.
    pub(super) fn turned(&self, vector_planet: DVec3) -> DVec3 {
        let (right, ahead, up) = match &self.kind {
            Kind::Node(_) => (vector_planet.x, vector_planet.y, vector_planet.z),
            Kind::Region(tangent, _) => tangent.local(vector_planet).into(),
        };
        DVec3::new(right, up, -ahead)
    }

    /// The centre of the planet in the frame of the mesh, in metres.
    pub(super) fn center_m(&self) -> DVec3 {
        self.position_m(DVec3::Z, -self.radius_m)
    }

    /// A point at a height over the reference sphere, in the frame of the mesh, in metres.
    pub(super) fn position_m(&self, dir_planet: DVec3, height_m: f64) -> DVec3 {
        self.turned(dir_planet * (self.radius_m + height_m) - self.origin_planet_m)
    }
}
