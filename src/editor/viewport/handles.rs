//! Handles of the selected edit: its points, and the square on its ring that draws its radius. With Ctrl a point moves
//! the whole edit, with Shift it turns and stretches it around its middle.

use super::ring::Ground;
use crate::planet::{EditPoint, GroundEdit};
use crate::sphere::geo::east_north;
use eframe::egui::Pos2;
use glam::{DQuat, DVec3};

/// Distance within which the pointer takes hold, in points of the window.
pub(super) const HOLD: f32 = 9.0;

/// What the pointer can take hold of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Handle {
    /// A point, by its number.
    Point(usize),
    /// The radius.
    Radius,
}

/// What a drag of a point does to the other points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Others {
    Stay,
    /// All move alike.
    Move,
    /// All turn and stretch around the middle.
    Turn,
}

/// The handle under a place of the window.
pub(super) fn under(ground: &Ground<'_>, edit: &GroundEdit, pos: Pos2) -> Option<Handle> {
    let away = |dir: DVec3| ground.on_screen(dir).map(|place| place.distance(pos));
    let points = edit.points.0.iter().enumerate().map(|(number, point)| (Handle::Point(number), point.direction()));
    let radius = radius_dir(edit, ground.radius_m()).map(|dir| (Handle::Radius, dir));
    let near = points.chain(radius).filter_map(|(handle, dir)| Some((handle, away(dir)?)));
    near.min_by(|a, b| a.1.total_cmp(&b.1)).filter(|(_, away)| *away <= HOLD).map(|(handle, _)| handle)
}

/// The square that draws the radius: east of the first point.
pub(super) fn radius_dir(edit: &GroundEdit, radius_m: f64) -> Option<DVec3> {
    let middle = edit.points.0.first()?.direction();
    let angle_rad = (edit.radius_km * 1000.0 / radius_m).min(3.0);
    Some(middle * angle_rad.cos() + east_north(middle).0 * angle_rad.sin())
}

/// The points of an edit after one of them, where it was in `before`, was dragged.
pub(super) fn dragged(before: &[EditPoint], grabbed: usize, to: DVec3, others: Others) -> Vec<EditPoint> {
    let Some(from) = before.get(grabbed).map(EditPoint::direction) else { return before.to_vec() };
    let placed = |point: &EditPoint, dir: DVec3| EditPoint { height_m: point.height_m, ..EditPoint::under(dir) };
    let each = |change: &dyn Fn(DVec3) -> DVec3| -> Vec<EditPoint> {
        before.iter().map(|point| placed(point, change(point.direction()))).collect()
    };
    match others {
        Others::Stay => {
            let moved = |(number, point): (usize, &EditPoint)| match number == grabbed {
                true => placed(point, to),
                false => *point,
            };
            before.iter().enumerate().map(moved).collect()
        }
        Others::Move => {
            let turn = DQuat::from_rotation_arc(from, to);
            each(&|dir| turn * dir)
        }
        Others::Turn => {
            let sum: DVec3 = before.iter().map(EditPoint::direction).sum();
            let middle = sum.normalize_or(from);
            let (east, north) = east_north(middle);
            // Heading and angle from the middle.
            let polar = |dir: DVec3| (dir.dot(north).atan2(dir.dot(east)), middle.angle_between(dir));
            let ((old_rad, old_away), (new_rad, new_away)) = (polar(from), polar(to));
            if old_away < 1e-12 {
                return before.to_vec();
            }
            let (turn_rad, stretch) = (new_rad - old_rad, new_away / old_away);
            each(&|dir| {
                let (heading_rad, away_rad) = polar(dir);
                let (sin, cos) = (heading_rad + turn_rad).sin_cos();
                let away_rad = (away_rad * stretch).min(3.0);
                middle * away_rad.cos() + (east * cos + north * sin) * away_rad.sin()
            })
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::LatLon;

    #[test]
    fn edits_move_turn_and_stretch_as_a_whole() {
        let at = |lat_deg: f64, lon_deg: f64| EditPoint {
            height_m: 7.0,
            ..EditPoint::under(LatLon::from_degrees(lat_deg, lon_deg).direction())
        };
        let near = |found: &[EditPoint], wanted: &[EditPoint]| {
            assert_eq!(found.len(), wanted.len());
            for (a, b) in found.iter().zip(wanted) {
                assert!(a.direction().angle_between(b.direction()) < 1e-6, "{found:?}");
                assert_eq!(a.height_m, 7.0);
            }
        };
        let line = [at(0.0, 10.0), at(0.0, 20.0)];
        let to = at(0.0, 30.0).direction();
        near(&dragged(&line, 1, to, Others::Stay), &[at(0.0, 10.0), at(0.0, 30.0)]);
        near(&dragged(&line, 1, to, Others::Move), &[at(0.0, 20.0), at(0.0, 30.0)]);
        near(&dragged(&line, 1, to, Others::Turn), &[at(0.0, 0.0), at(0.0, 30.0)]);
        let north = LatLon::from_degrees(5.0, 15.0).direction();
        near(&dragged(&line, 1, north, Others::Turn), &[at(-5.0, 15.0), at(5.0, 15.0)]);
    }
}
