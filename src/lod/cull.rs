//! Culling of tiles by frustum and horizon, with bounding spheres.

use super::View;
use crate::lod::tile::Tile;
use crate::terrain::Terrain;
use glam::DVec3;

/// The visible space of a view; computed once a frame.
#[derive(Clone, Debug)]
pub struct Culling {
    eye: DVec3,
    /// Inward normals of the frustum's four sides; all pass through the eye.
    sides: [DVec3; 4],
    lowest_radius_m: f64,
    /// Angle from the eye's zenith down to where a ray grazes the lowest ground.
    horizon_rad: f64,
}

impl Culling {
    /// `lowest_radius_m`: distance from the centre of the lowest ground or sea.
    pub fn new(view: &View, lowest_radius_m: f64) -> Self {
        Self::widened(view, lowest_radius_m, 1.0)
    }

    /// The same with the tangent of the opening angle multiplied by `factor`, to choose tiles ahead of need.
    pub fn widened(view: &View, lowest_radius_m: f64, factor: f64) -> Self {
        let camera = &view.camera;
        let tan_y = (camera.fov_y_rad * 0.5).tan() * factor;
        let tan_x = tan_y * view.aspect();
        let side = |x: f64, y: f64, reach: f64| camera.planet_from_view * DVec3::new(x, y, -reach).normalize();
        Self {
            eye: camera.position_planet_m,
            sides: [side(1.0, 0.0, tan_x), side(-1.0, 0.0, tan_x), side(0.0, 1.0, tan_y), side(0.0, -1.0, tan_y)],
            lowest_radius_m,
            horizon_rad: horizon_angle_rad(lowest_radius_m, camera.position_planet_m.length()),
        }
    }

    /// Whether any part of a tile may be visible. Conservative: mountains beyond the horizon count as visible.
    pub fn sees(&self, tile: &Tile) -> bool {
        self.sees_sphere(tile.center_planet_m, tile.bounding_radius_m)
    }

    /// Whether any part of a sphere may be visible.
    pub fn sees_sphere(&self, center_planet_m: DVec3, radius_m: f64) -> bool {
        let offset = center_planet_m - self.eye;
        if self.sides.iter().any(|side| side.dot(offset) < -radius_m) {
            return false;
        }
        // Beyond the horizon: even its highest point is below the ray that grazes the lowest ground.
        let distance = center_planet_m.length();
        if distance <= radius_m {
            return true;
        }
        let angle = self.eye.angle_between(center_planet_m);
        let reach = horizon_angle_rad(self.lowest_radius_m, distance + radius_m) + (radius_m / distance).asin();
        angle <= self.horizon_rad + reach
    }
}

/// Distance from the planet's centre of the lowest ground or sea, which hides what is behind it.
pub fn lowest_radius_m(terrain: &Terrain) -> f64 {
    let (planet, lowest_m) = (terrain.planet(), terrain.height_bounds_m().0);
    planet.radius_m() + planet.sea_level_m().map_or(lowest_m, |sea_m| sea_m.max(lowest_m))
}

/// Angle at the centre of the planet between a point at `radius_m` and the point where its line of sight grazes the
/// sphere of `lowest_radius_m`.
fn horizon_angle_rad(lowest_radius_m: f64, radius_m: f64) -> f64 {
    (lowest_radius_m / radius_m).clamp(-1.0, 1.0).acos()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Camera, Quality};
    use crate::sphere::LatLon;

    const EARTH_M: f64 = 6_371_000.0;

    fn view_over_the_sea(pitch_deg: f64) -> View {
        let place = LatLon::from_degrees(0.0, 0.0);
        let camera = Camera::over(place, EARTH_M + 2.0, 90_f64.to_radians(), pitch_deg.to_radians(), 1.0);
        View { camera, size_px: [1280, 720], quality: Quality::Medium }
    }

    #[test]
    fn a_high_peak_is_seen_far_beyond_the_sea_horizon() {
        let culling = Culling::new(&view_over_the_sea(0.0), EARTH_M);
        let at = |km: f64, height_m: f64| {
            LatLon { lat_rad: 0.0, lon_rad: km * 1000.0 / EARTH_M }.direction() * (EARTH_M + height_m)
        };
        assert!(culling.sees_sphere(at(330.0, 8848.0), 1.0), "8,848 m show from 341 km");
        assert!(!culling.sees_sphere(at(345.0, 8848.0), 1.0));
        assert!(culling.sees_sphere(at(4.9, 0.0), 1.0), "the sea's horizon is 5.0 km away");
        assert!(!culling.sees_sphere(at(10.5, 0.0), 1.0));
    }

    #[test]
    fn what_is_behind_is_not_seen() {
        let culling = Culling::new(&view_over_the_sea(0.0), EARTH_M);
        let west = LatLon::from_degrees(0.0, -0.02).direction() * EARTH_M;
        assert!(!culling.sees_sphere(west, 10.0));
        assert!(culling.sees_sphere(west, 5000.0));
    }
}
