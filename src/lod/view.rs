//! Camera, picture size and quality of a view.

use crate::sphere::{LatLon, geo};
use glam::{DMat3, DQuat, DVec3};

/// A perspective camera in the planet frame. View space looks along -Z with +Y up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The eye, in metres from the planet's centre.
    pub position_planet_m: DVec3,
    /// Turns view space into the planet frame.
    pub planet_from_view: DQuat,
    /// Vertical opening angle.
    pub fov_y_rad: f64,
}

impl Camera {
    /// Default vertical opening angle: 50°.
    pub const DEFAULT_FOV_Y_RAD: f64 = 50.0 * std::f64::consts::PI / 180.0;

    /// A camera at a position that looks along `forward`, with its top as near to `up` as possible.
    pub fn looking(position_planet_m: DVec3, forward: DVec3, up: DVec3, fov_y_rad: f64) -> Self {
        let back = -forward.normalize();
        let right = up.cross(back);
        let right = if right.length_squared() > 1e-18 { right.normalize() } else { back.any_orthonormal_vector() };
        let planet_from_view = DQuat::from_mat3(&DMat3::from_cols(right, back.cross(right), back)).normalize();
        Self { position_planet_m, planet_from_view, fov_y_rad }
    }

    /// A camera over a location, at `radius_m` from the centre. Heading is clockwise from north; pitch is 0 at the
    /// horizon and -π/2 straight down.
    pub fn over(place: LatLon, radius_m: f64, heading_rad: f64, pitch_rad: f64, fov_y_rad: f64) -> Self {
        let up = place.direction();
        let (east, north) = geo::east_north(up);
        let (sin_h, cos_h) = libm::sincos(heading_rad);
        let (sin_p, cos_p) = libm::sincos(pitch_rad);
        let level = north * cos_h + east * sin_h;
        Self::looking(up * radius_m, level * cos_p + up * sin_p, up * cos_p - level * sin_p, fov_y_rad)
    }

    /// Unit vector into the picture.
    pub fn forward_planet(&self) -> DVec3 {
        self.planet_from_view * DVec3::NEG_Z
    }

    /// Direction in the planet frame through a point of the picture, `x` and `y` from -1 to 1, right and up.
    pub fn ray_dir_planet(&self, x: f64, y: f64, aspect: f64) -> DVec3 {
        let tan = (self.fov_y_rad * 0.5).tan();
        (self.planet_from_view * DVec3::new(x * tan * aspect, y * tan, -1.0)).normalize()
    }
}

/// How well everything is drawn. Quality never changes what is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Quality {
    /// For software adapters: half the resolution, coarse tiles, few steps.
    Low,
    /// For an integrated GPU.
    #[default]
    Medium,
    /// For a strong GPU, and for pictures.
    High,
}

impl Quality {
    /// All qualities, coarsest first.
    pub const ALL: [Quality; 3] = [Quality::Low, Quality::Medium, Quality::High];

    /// Display name.
    pub fn label(self) -> &'static str {
        match self {
            Quality::Low => "Low",
            Quality::Medium => "Medium",
            Quality::High => "High",
        }
    }
}

/// Everything that the LOD cut depends on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// The camera.
    pub camera: Camera,
    /// Width and height of the picture in pixels; never zero.
    pub size_px: [u32; 2],
    /// How fine the tiles are.
    pub quality: Quality,
}

impl View {
    /// Width over height.
    pub fn aspect(&self) -> f64 {
        f64::from(self.size_px[0]) / f64::from(self.size_px[1])
    }

    /// Angle of a pixel in the middle of the picture.
    pub fn pixel_rad(&self) -> f64 {
        2.0 * (self.camera.fov_y_rad * 0.5).tan() / f64::from(self.size_px[1])
    }
}
