//! Height pictures as stamps. Positions in the picture are those of Lambert's equal-area projection around the middle:
//! the ring of the stamp is the circle that touches the longer side.

use super::path::Arc;
use crate::planet::edits::PictureStamp;
use crate::planet::picture::{Picture, PictureExtent};
use crate::sphere::geo::east_north;
use glam::DVec3;
use std::sync;

/// A height picture, compiled.
#[derive(Clone, Debug)]
pub(super) struct Stamp {
    picture: sync::Arc<Picture>,
    /// Value that leaves the ground as it is.
    level: f64,
    /// Directions to the right and up in the picture, for each copy.
    axes: Vec<[DVec3; 2]>,
}

/// The place of a point in a picture.
#[derive(Clone, Copy, Debug)]
pub(super) struct Stamped<'a> {
    picture: &'a Picture,
    /// Position: x to the right and y up, 1 at the ring.
    x: f64,
    y: f64,
    /// The gradients of the position by the direction.
    by_dir: [DVec3; 2],
    /// The angle that is 1 in the picture.
    radius_rad: f64,
    /// Value over the level.
    pub(super) value: f64,
}

impl Stamp {
    /// The picture of a stamp whose copies have these places. None if it is not loaded.
    pub(super) fn new(stamp: &PictureStamp, places: &[Arc]) -> Option<Self> {
        let picture = stamp.file.picture(PictureExtent::Place)?.clone();
        let axes = |place: &Arc| {
            let (east, north) = east_north(place.a);
            let north = if place.flipped { -north } else { north };
            let (sin, cos) = libm::sincos((stamp.turn_deg + stamp.random_turn_deg * place.turned).to_radians());
            [east * cos - north * sin, north * cos + east * sin]
        };
        Some(Self { picture, level: stamp.level, axes: places.iter().map(axes).collect() })
    }

    /// The right and up directions of a copy.
    pub(super) fn axes(&self, copy: usize) -> &[DVec3; 2] {
        &self.axes[copy]
    }

    /// The picture at a direction, of a copy in the middle of a ring of this radius.
    pub(super) fn at(&self, dir: DVec3, copy: usize, middle: DVec3, radius_rad: f64) -> Stamped<'_> {
        let ring_chord = 2.0 * libm::sin(0.5 * radius_rad.min(std::f64::consts::PI));
        // Twice the squared cosine of half the angle; the point opposite of the middle is beyond the ring.
        let near = (1.0 + dir.dot(middle)).max(1e-9);
        let scale = (2.0 / near).sqrt() / ring_chord;
        let [(x, x_by_dir), (y, y_by_dir)] = self.axes[copy].map(|axis| {
            let along = dir.dot(axis);
            (along * scale, (axis - middle * (0.5 * along / near)) * scale)
        });
        let (value, _) = self.picture.sample(&self.picture.place(DVec3::new(x, y, 0.0)), 0);
        let picture = &*self.picture;
        Stamped { picture, x, y, by_dir: [x_by_dir, y_by_dir], radius_rad, value: value - self.level }
    }
}

impl Stamped<'_> {
    /// The gradient of the value by the direction that points so far apart can show.
    pub(super) fn gradient(&self, spacing_rad: f64) -> DVec3 {
        let level = self.picture.level_for(spacing_rad / self.radius_rad);
        let place = self.picture.place(DVec3::new(self.x, self.y, 0.0));
        let (_, by_place) = self.picture.sample(&place, level);
        self.by_dir[0] * by_place.x + self.by_dir[1] * by_place.y
    }
}
