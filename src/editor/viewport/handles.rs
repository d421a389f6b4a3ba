//! Handles of the selected edit: its points, and the square on its ring that draws its radius and turns a picture. With
//! Ctrl a point moves the whole edit, with Shift it turns and stretches it around its middle.

use super::ring::Ground;
use super::sculpt::tidy_km;
use crate::planet::{EditPoint, GroundEdit, Tool};
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

/// The square that draws the radius: east of the first point; of a picture, at its right edge.
pub(super) fn radius_dir(edit: &GroundEdit, radius_m: f64) -> Option<DVec3> {
    let middle = edit.points.0.first()?.direction();
    let angle_rad = (edit.radius_km * 1000.0 / radius_m).min(3.0);
    let turn_rad = if let Tool::Picture(stamp) = &edit.tool { stamp.turn_deg.to_radians() } else { 0.0 };
    let (east, north) = east_north(middle);
    let right = east * turn_rad.cos() - north * turn_rad.sin();
    Some(middle * angle_rad.cos() + right * angle_rad.sin())
}

/// Lets the square be at a direction: it draws the radius, and turns a picture.
pub(super) fn set_radius_dir(edit: &mut GroundEdit, to: DVec3, radius_m: f64) -> Option<()> {
    let middle = edit.points.0.first()?.direction();
    edit.radius_km = tidy_km(to.angle_between(middle) * radius_m / 1000.0);
    if let Tool::Picture(stamp) = &mut edit.tool {
        let (east, north) = east_north(middle);
        let turn_deg = (-to.dot(north)).atan2(to.dot(east)).to_degrees();
        stamp.turn_deg = (turn_deg * 10.0).round() / 10.0;
    }
    Some(())
}

/// The points of an edit after one of them, where it was in `before`, was dragged.
pub(super) fn dragged(before: &[EditPoint], grabbed: usize, to: DVec3, others: Others) -> Vec<EditPoint> {
    let Some(from) = before.get(grabbed).map(EditPoint::direction) else { return before.to_vec() };
    let placed = |point: &EditPoint, dir: DVec3| {
        let EditPoint { latitude_deg, longitude_deg, .. } = EditPoint::under(dir);
        EditPoint { latitude_deg, longitude_deg, ..*point }
    };
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
    use crate::planet::edits::{EditPoints, PictureStamp};
    use crate::sphere::LatLon;

    #[test]
    fn the_square_draws_the_radius_and_turns_a_picture() {
        let middle = EditPoint::under(LatLon::from_degrees(40.0, 20.0).direction());
        let tool = Tool::Picture(PictureStamp::default());
        let mut edit = GroundEdit { tool, points: EditPoints(vec![middle]), ..GroundEdit::default() };
        let (east, north) = east_north(middle.direction());
        for (heading_deg, away_rad) in [(90.0, 0.02), (100.0, 0.05), (-33.0, 0.1), (0.0, 0.3)] {
            let (sin, cos) = f64::to_radians(heading_deg).sin_cos();
            let to = middle.direction() * f64::cos(away_rad) + (east * sin + north * cos) * f64::sin(away_rad);
            assert_eq!(set_radius_dir(&mut edit, to, 1e6), Some(()));
            assert!((edit.radius_km - 1000.0 * away_rad).abs() < 0.01 * edit.radius_km, "{edit:?}");
            let back = radius_dir(&edit, 1e6).unwrap();
            assert!(back.angle_between(to) < 0.01 * away_rad, "{heading_deg} {edit:?}");
        }
    }

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
