//! The way of a camera over bookmarks: through each of them, without a corner.

use crate::lod::Camera;
use crate::lod::pose::{Attitude, Pose};
use crate::planet::Bookmark;
use crate::terrain::Terrain;
use glam::{DQuat, DVec3};

/// Least height of the camera above ground and water between two bookmarks above them, metres.
const CLEARANCE_M: f64 = 1.5;
/// Share of the altitude that the camera keeps over hills between two bookmarks.
const CLEARANCE_SHARE: f64 = 0.4;
/// Altitudes change in proportion above this one, and evenly below it, metres.
const EVEN_M: f64 = 1.0;

/// A view that the path goes through.
#[derive(Clone, Copy)]
struct Key {
    up: DVec3,
    /// Distance of ground or water below from the centre.
    surface_m: f64,
    /// Logarithm of the altitude, or depth if negative.
    lift: f64,
    planet_from_view: DQuat,
    roll_rad: f64,
}

/// The way of a camera: a Catmull-Rom spline through bookmarks, along great circles (Barry and Goldman, A recursive
/// evaluation algorithm for a class of Catmull-Rom splines, 1988). It starts and ends slowly.
pub struct CameraPath {
    keys: Vec<Key>,
    fov_y_rad: f64,
}

impl CameraPath {
    /// The path through bookmarks in their order; none if there is no bookmark.
    pub fn over(terrain: &Terrain, bookmarks: &[Bookmark], fov_y_rad: f64) -> Option<Self> {
        let key = |bookmark: &Bookmark| {
            // Bookmarks are placed over ground and sea; of lakes they know nothing.
            let pose = Pose::of_bookmark(bookmark, |up| sea_or_ground_m(terrain, up));
            let (up, attitude) = (pose.up(), Attitude::of(&pose));
            Key {
                up,
                surface_m: sea_or_ground_m(terrain, up),
                lift: (bookmark.altitude_m / EVEN_M).asinh(),
                planet_from_view: pose.planet_from_view,
                roll_rad: attitude.roll_rad,
            }
        };
        let keys: Vec<Key> = bookmarks.iter().map(key).collect();
        (!keys.is_empty()).then_some(Self { keys, fov_y_rad })
    }

    /// The camera at a share of the time, 0 to 1.
    pub fn camera(&self, terrain: &Terrain, share: f64) -> Camera {
        let share = share.clamp(0.0, 1.0);
        let eased = share * share * (3.0 - 2.0 * share);
        let last = self.keys.len() - 1;
        let at = eased * last as f64;
        let first = (at as usize).min(last.saturating_sub(1));
        let t = at - first as f64;
        let key = |offset: isize| &self.keys[first.saturating_add_signed(offset).min(last)];
        // The path goes on straight beyond its ends.
        let four = [key(-1), key(0), key(1), key(2)];
        let number = |of: fn(&Key) -> f64| spline(four.map(of), t, |a, b, share| a + (b - a) * share);
        let up = spline(four.map(|key| key.up), t, turned_dir).normalize_or(DVec3::Z);
        let rotation = spline(four.map(|key| key.planet_from_view), t, turned);
        let altitude_m = EVEN_M * number(|key| key.lift).sinh();
        let mut radius_m = number(|key| key.surface_m) + altitude_m;
        if key(0).lift > 0.0 && key(1).lift > 0.0 {
            // Never more than the altitude, so that the path goes through its bookmarks.
            let least_m = altitude_m.min(CLEARANCE_M + CLEARANCE_SHARE * altitude_m);
            radius_m = radius_m.max(sea_or_ground_m(terrain, up) + least_m);
        }
        // The horizon leans as the bookmarks say, and not as the turn between them would have it.
        let turned = Pose { position_planet_m: up * radius_m, planet_from_view: rotation.normalize() };
        let attitude = Attitude { roll_rad: number(|key| key.roll_rad), ..Attitude::of(&turned) };
        Pose::new(turned.position_planet_m, &attitude).camera(self.fov_y_rad)
    }
}

/// Distance from the centre to the ground or the sea, whichever is higher.
fn sea_or_ground_m(terrain: &Terrain, dir_planet: DVec3) -> f64 {
    let planet = terrain.planet();
    planet.radius_m() + terrain.height_m(dir_planet).max(planet.sea_level_m().unwrap_or(f64::MIN))
}

/// The value between the second and the third of four, by a way of going from one value to another.
fn spline<T: Copy>(of: [T; 4], t: f64, between: impl Fn(T, T, f64) -> T) -> T {
    let [a, b, c] = [0, 1, 2].map(|i| between(of[i], of[i + 1], t + 1.0 - i as f64));
    let [ab, bc] = [between(a, b, 0.5 * (t + 1.0)), between(b, c, 0.5 * t)];
    between(ab, bc, t)
}

/// A direction on the great circle through two, also beyond them.
fn turned_dir(from: DVec3, to: DVec3, share: f64) -> DVec3 {
    let axis = from.cross(to);
    let angle_rad = libm::atan2(axis.length(), from.dot(to));
    match axis.try_normalize() {
        Some(axis) => DQuat::from_axis_angle(axis, angle_rad * share) * from,
        None => from,
    }
}

/// A rotation on the shorter way through two, also beyond them.
fn turned(from: DQuat, to: DQuat, share: f64) -> DQuat {
    let way = to * from.inverse();
    let way = if way.w < 0.0 { -way } else { way };
    let sine = way.xyz().length();
    let angle_rad = 2.0 * libm::atan2(sine, way.w);
    match way.xyz().try_normalize() {
        Some(axis) => DQuat::from_axis_angle(axis, angle_rad * share) * from,
        None => from,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Fbm, Layer, Planet, Shape};
    use std::sync::Arc;

    fn bookmark(lat: f64, lon: f64, altitude_m: f64, heading_deg: f64, pitch_deg: f64) -> Bookmark {
        let name = "Here".to_owned();
        Bookmark {
            name,
            latitude_deg: lat,
            longitude_deg: lon,
            altitude_m,
            heading_deg,
            pitch_deg,
            ..Bookmark::default()
        }
    }

    fn terrain() -> Terrain {
        Terrain::try_new(Arc::new(Planet { layers: Vec::new(), ..Planet::default() })).unwrap()
    }

    #[test]
    fn the_path_goes_through_its_bookmarks() {
        let terrain = terrain();
        let bookmarks = [
            bookmark(10.0, 170.0, 5e6, 350.0, -80.0),
            bookmark(12.0, -170.0, 40e3, 20.0, -20.0),
            bookmark(12.5, -169.0, 1.7, 40.0, -2.0),
            bookmark(80.0, -100.0, 300.0, 100.0, 5.0),
        ];
        let path = CameraPath::over(&terrain, &bookmarks, 0.7).unwrap();
        // The share at which the eased time is a third: of the polynomial of the ease.
        for (number, share) in [(0, 0.0), (1, 0.386963143105396), (2, 0.613036856894604), (3, 1.0)] {
            let camera = path.camera(&terrain, share);
            let wanted = Pose::of_bookmark(&bookmarks[number], |up| sea_or_ground_m(&terrain, up));
            let off_m = camera.position_planet_m.distance(wanted.position_planet_m);
            assert!(off_m < 1e-5 * (1.0 + wanted.position_planet_m.length()), "{number}: {off_m} m");
            assert!(camera.planet_from_view.angle_between(wanted.planet_from_view) < 1e-4, "{number}");
        }
    }

    #[test]
    fn nothing_jumps_and_nothing_is_under_the_ground() {
        let terrain = terrain();
        let bookmarks = [
            bookmark(10.0, 0.0, 1e6, 0.0, -60.0),
            bookmark(-30.0, 40.0, 10.0, 90.0, 0.0),
            bookmark(-31.0, 41.0, 20.0, 200.0, 0.0),
        ];
        let path = CameraPath::over(&terrain, &bookmarks, 0.7).unwrap();
        let cameras: Vec<Camera> = (0..=600).map(|n| path.camera(&terrain, f64::from(n) / 600.0)).collect();
        for pair in cameras.windows(2) {
            let turn = pair[0].planet_from_view.angle_between(pair[1].planet_from_view);
            assert!(turn < 0.05, "{turn}");
            let up = pair[1].position_planet_m.normalize();
            let over_m = pair[1].position_planet_m.length() - sea_or_ground_m(&terrain, up);
            assert!(over_m > 5.0, "{over_m}");
            let level = (pair[1].planet_from_view * DVec3::X).dot(up);
            assert!(level.abs() < 1e-6, "{level}");
        }
        assert!(CameraPath::over(&terrain, &[], 0.7).is_none());
        let still = CameraPath::over(&terrain, &bookmarks[..1], 0.7).unwrap();
        assert_eq!(still.camera(&terrain, 0.2), still.camera(&terrain, 0.9));
    }

    /// Mountains stand between two bookmarks in valleys.
    #[test]
    fn the_camera_passes_over_mountains() {
        let shape = Shape::Fbm(Fbm { wavelength_km: 200.0, ..Fbm::default() });
        let layers = vec![Layer { amplitude_m: 4000.0, shape, ..Layer::default() }];
        let terrain = Terrain::try_new(Arc::new(Planet { layers, ..Planet::default() })).unwrap();
        let bookmarks = [bookmark(10.0, 0.0, 40.0, 90.0, 0.0), bookmark(10.0, 8.0, 40.0, 90.0, 0.0)];
        let path = CameraPath::over(&terrain, &bookmarks, 0.7).unwrap();
        let places: Vec<DVec3> =
            (0..=400).map(|n| path.camera(&terrain, f64::from(n) / 400.0).position_planet_m).collect();
        let over_m = |place: &DVec3| place.length() - sea_or_ground_m(&terrain, place.normalize());
        let least_m = places.iter().map(over_m).fold(f64::MAX, f64::min);
        assert!(least_m > CLEARANCE_M + CLEARANCE_SHARE * 40.0 - 1e-3, "{least_m}");
        // Without mountains in the way it would not have to climb.
        let straight = |n: usize| 0.5 * (places[0].length() + places[400].length()) + 200.0 < places[n].length();
        assert!((0..400).any(straight));
    }
}
