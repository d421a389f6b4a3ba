//! The frustum of a frozen view, drawn as lines over the picture of another view.

use crate::lod::View;
use eframe::egui::{Color32, Painter, Pos2, Rect, Stroke, pos2};
use glam::DVec3;

/// Draws lines from the frozen eye through the corners of its picture, to the reference sphere or the horizon.
pub(super) fn paint(painter: &Painter, rect: Rect, frozen: &View, seen: &View, radius_m: f64) {
    let eye = frozen.camera.position_planet_m;
    let corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)].map(|(x, y)| {
        let dir = frozen.camera.ray_dir_planet(x, y, frozen.aspect());
        eye + dir * reach_m(eye, dir, radius_m)
    });
    let stroke = Stroke::new(1.5, Color32::from_rgb(255, 200, 60));
    for (i, &corner) in corners.iter().enumerate() {
        for [from, to] in [[eye, corner], [corner, corners[(i + 1) % corners.len()]]] {
            if let Some(line) = project(seen, from, to) {
                painter.line_segment(line.map(|point| in_rect(rect, point)), stroke);
            }
        }
    }
}

/// Distance to a sphere about the centre, or as far as its horizon.
fn reach_m(eye: DVec3, dir: DVec3, radius_m: f64) -> f64 {
    let along = -eye.dot(dir);
    let tangent_sq = eye.length_squared() - radius_m * radius_m;
    let discriminant = along * along - tangent_sq;
    // Near the ground the horizon is near too: the least length keeps the frustum visible.
    let horizon_m = tangent_sq.max(0.0).sqrt().max(1e-4 * radius_m);
    if along > 0.0 && discriminant >= 0.0 && tangent_sq > 0.0 { along - discriminant.sqrt() } else { horizon_m }
}

/// The part of a line in front of the eye, as points of the picture from -1 to 1.
pub(super) fn project(view: &View, from: DVec3, to: DVec3) -> Option<[(f64, f64); 2]> {
    let camera = &view.camera;
    let in_view = |point: DVec3| camera.planet_from_view.inverse() * (point - camera.position_planet_m);
    let (mut a, mut b) = (in_view(from), in_view(to));
    // Clipped at a plane just in front of the eye.
    let near_m = 1e-6 * (a.length() + b.length()) + 1e-3;
    if a.z > -near_m && b.z > -near_m {
        return None;
    }
    let cut = |inside: DVec3, outside: DVec3| inside.lerp(outside, (-near_m - inside.z) / (outside.z - inside.z));
    if a.z > -near_m {
        a = cut(b, a);
    } else if b.z > -near_m {
        b = cut(a, b);
    }
    let tan = (camera.fov_y_rad * 0.5).tan();
    Some([a, b].map(|p| (p.x / (-p.z * tan * view.aspect()), p.y / (-p.z * tan))))
}

pub(super) fn in_rect(rect: Rect, (x, y): (f64, f64)) -> Pos2 {
    // Far outside the picture, f32 would lose the direction of the line.
    let (x, y) = (x.clamp(-1e4, 1e4) as f32, y.clamp(-1e4, 1e4) as f32);
    pos2(rect.center().x + x * 0.5 * rect.width(), rect.center().y - y * 0.5 * rect.height())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Camera, Quality};
    use crate::sphere::LatLon;

    fn view(lat_deg: f64, radius_m: f64) -> View {
        let down = -std::f64::consts::FRAC_PI_2;
        let camera = Camera::over(LatLon::from_degrees(lat_deg, 0.0), radius_m, 0.0, down, 0.8);
        View { camera, size_px: [200, 100], quality: Quality::Low }
    }

    #[test]
    fn lines_are_projected_as_rays_are_cast() {
        let view = view(10.0, 3.0);
        let point = |x, y| view.camera.position_planet_m + view.camera.ray_dir_planet(x, y, view.aspect()) * 1.5;
        let [a, b] = project(&view, point(0.3, -0.2), point(-0.7, 0.9)).unwrap();
        assert!((a.0 - 0.3).abs() < 1e-9 && (a.1 + 0.2).abs() < 1e-9, "{a:?}");
        assert!((b.0 + 0.7).abs() < 1e-9 && (b.1 - 0.9).abs() < 1e-9, "{b:?}");
        let behind = view.camera.position_planet_m * 2.0;
        assert!(project(&view, behind, behind * 1.1).is_none());
        let [_, cut] = project(&view, DVec3::ZERO, behind).unwrap();
        assert!(cut.0.is_finite() && cut.1.is_finite());
    }

    #[test]
    fn a_frustum_reaches_to_the_ground_or_the_horizon() {
        let eye = DVec3::X * 2.0;
        assert!((reach_m(eye, DVec3::NEG_X, 1.0) - 1.0).abs() < 1e-12);
        assert!((reach_m(eye, DVec3::Y, 1.0) - 3.0_f64.sqrt()).abs() < 1e-12);
    }
}
