//! A scene: a camera, suns, and the bodies around the camera.
//!
//! Scene space has its origin at the camera; its axes are the caller's. Positions are f64 metres. A body's own frame is
//! the planet frame of [`crate`]: the renderer draws each body in that frame, relative to the eye.

use super::biome_table::MarkedCells;
use super::caster::ShadowCaster;
use super::debug_view::DebugView;
use super::exposure::Metering;
use super::tone::Tone;
use crate::life::HiddenObjects;
use crate::lod::{Camera, Quality, View};
use crate::planet::{Planet, Star};
use crate::system::light::StarInSky;
use crate::terrain::Revision;
use crate::tiles::Surface;
use glam::{DQuat, DVec3, Mat4};
use std::ops::RangeInclusive;
use std::sync::Arc;

/// Key of a body: the renderer keeps the body's tiles and LUTs under it from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct BodyId(pub u32);

/// Key of a view: the renderer keeps the view's targets and its exposure under it from frame to frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct ViewId(pub u32);

/// A star, or light that another body reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sun {
    /// Unit vector towards it, scene space.
    pub dir_scene: DVec3,
    /// Its colour as linear RGB, 1 for white.
    pub color: [f64; 3],
    /// 1: white ground under it overhead has radiance 1.
    pub brightness: f64,
    /// Angular radius of its disc, seen from the camera.
    pub radius_rad: f64,
    /// Its distance from the camera. The direction to it, its brightness and its angular radius are those at the
    /// camera; a body elsewhere has its own. Infinite: the same everywhere.
    pub distance_m: f64,
    /// Whether it is a star, with a disc in the sky. Light that a neighbour reflects has none: the neighbour is seen.
    pub has_disc: bool,
    /// The one body that it lights; None for all.
    pub only: Option<BodyId>,
}

impl Sun {
    /// The star of a preset, in a direction of scene space (of any length).
    pub fn new(star: &Star, dir_scene: DVec3) -> Self {
        Self {
            dir_scene: dir_scene.normalize_or(DVec3::X),
            color: star.color,
            brightness: star.brightness,
            radius_rad: star.radius_deg.to_radians(),
            distance_m: f64::INFINITY,
            has_disc: true,
            only: None,
        }
    }

    /// Its place and size in the sky.
    pub(crate) fn in_sky(&self) -> StarInSky {
        StarInSky { dir: self.dir_scene, distance_m: self.distance_m, radius_rad: self.radius_rad }
    }

    /// The same light at another place: metres from the camera, scene space.
    pub(crate) fn at(&self, position_m: DVec3) -> Self {
        if !self.distance_m.is_finite() {
            return *self;
        }
        let towards = self.dir_scene * self.distance_m - position_m;
        let distance_m = towards.length().max(1.0);
        let ratio = self.distance_m / distance_m;
        Self {
            dir_scene: towards / distance_m,
            brightness: self.brightness * ratio * ratio,
            radius_rad: (self.radius_rad.sin() * ratio).min(1.0).asin(),
            distance_m,
            ..*self
        }
    }
}

/// A body that is too small or too far to have a surface: a point of light behind everything else.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Point {
    /// Unit vector towards it, scene space.
    pub dir_scene: DVec3,
    /// Its light as linear RGB, in the unit of stars: 2 for a bright one.
    pub light: [f64; 3],
}

impl Point {
    /// A point with an apparent magnitude, and a colour whose greatest component is 1.
    pub fn new(dir_scene: DVec3, color: [f64; 3], magnitude: f64) -> Self {
        // As the stars of the sky, which are compressed: a factor of 100 in light is one of 13.
        let brightness = (2.0 * 10_f64.powf(-0.4 * magnitude * 0.56)).clamp(0.0, 12.0);
        Self { dir_scene: dir_scene.normalize_or(DVec3::X), light: color.map(|c| c * brightness) }
    }
}

/// One planet of a scene.
#[derive(Clone)]
#[non_exhaustive]
pub struct Body<'a> {
    /// Different for each body of the scene; the same from frame to frame.
    pub id: BodyId,
    /// The planet for everything that is not in the tiles, with its content keys. It may be newer than the surface's.
    pub revision: Revision,
    /// The tiles, built for [`Scene::view_of`] this body.
    pub surface: &'a Surface,
    /// Centre of the body, metres from the camera, scene space.
    pub position_m: DVec3,
    /// Turns the body's frame into scene space.
    pub scene_from_body: DQuat,
    /// The view that the tiles were chosen for, if it is another: tiles are culled and morphed as seen from there.
    pub frozen: Option<View>,
    /// Cells of the biome table whose ground is highlighted. Clouds are left out meanwhile.
    pub marked: Option<Arc<MarkedCells>>,
    /// Objects that are not drawn and cast no shadow: those that the game has felled or taken. Where single objects are
    /// too far to be drawn, they still count for the canopy.
    pub hidden: Option<&'a HiddenObjects>,
    /// Things of the game that cast shadows of the first sun. They are drawn by the game.
    pub casters: Vec<&'a dyn ShadowCaster>,
}

impl<'a> Body<'a> {
    /// A body at a position in scene space, its axes those of the scene. Its planet is the surface's own.
    pub fn new(id: BodyId, surface: &'a Surface, position_m: DVec3) -> Self {
        let (revision, scene_from_body) = (surface.terrain.revision().clone(), DQuat::IDENTITY);
        let (frozen, marked, hidden, casters) = (None, None, None, Vec::new());
        Self { id, revision, surface, position_m, scene_from_body, frozen, marked, hidden, casters }
    }

    /// The planet.
    pub fn planet(&self) -> &Planet {
        self.revision.planet()
    }

    /// The eye in the body's frame, metres from its centre.
    pub fn eye_planet_m(&self) -> DVec3 {
        self.scene_from_body.inverse() * -self.position_m
    }
}

/// A perspective projection as tangents of the angles from the view axis: any off-axis frustum.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Projection {
    /// Left, right, bottom and top edge of the picture at unit distance; left and bottom are negative in a symmetric
    /// one.
    pub tangents: [f64; 4],
    /// Offset of the picture in pixels of [`Scene::size_px`], right and down: for temporal antialiasing.
    pub jitter_px: [f64; 2],
    /// Distance of the near plane. `None`: 0.001 to 1000 m, by the distance of the highest ground, which hides a ship
    /// next to a camera in orbit. A game sets it to the nearest that it draws, such as 0.1 m: reversed depth in
    /// floating point is as precise with any near plane.
    pub near_m: Option<f64>,
}

impl Projection {
    /// A symmetric projection: vertical opening angle, width over height.
    pub fn symmetric(fov_y_rad: f64, aspect: f64) -> Self {
        let tan = (fov_y_rad * 0.5).tan();
        Self::off_axis([-tan * aspect, tan * aspect, -tan, tan])
    }

    /// Any frustum: see [`Projection::tangents`].
    pub fn off_axis(tangents: [f64; 4]) -> Self {
        Self { tangents, jitter_px: [0.0; 2], near_m: None }
    }

    /// Half width and half height at unit distance.
    pub(crate) fn half_extent(&self) -> [f64; 2] {
        let [left, right, bottom, top] = self.tangents;
        [0.5 * (right - left), 0.5 * (top - bottom)]
    }

    /// Centre of the jittered picture at unit distance: right and up. `size_px`: [`Scene::size_px`].
    pub(crate) fn center(&self, size_px: [u32; 2]) -> [f64; 2] {
        let [left, right, bottom, top] = self.tangents;
        let [half_x, half_y] = self.half_extent();
        let step = |half: f64, size: u32| 2.0 * half / f64::from(size.max(1));
        // A picture that moves right shows what lies further left.
        let aside = -self.jitter_px[0] * step(half_x, size_px[0]);
        let up = self.jitter_px[1] * step(half_y, size_px[1]);
        [0.5 * (left + right) + aside, 0.5 * (bottom + top) + up]
    }
}

/// How radiance becomes a picture.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Post {
    /// How the exposure is found.
    pub metering: Metering,
    /// The tone curve.
    pub tone: Tone,
    /// Whether edges are smoothed. Without, each pixel is the tone curve of its own radiance.
    pub smooth_edges: bool,
    /// Exposure in stops, 0 for a sunlit planet. With automatic exposure: a correction to it.
    pub exposure_ev: f64,
    /// Colour temperature of the light that is shown white, kelvins, in [`Post::WHITE_K`]. [`Post::DAYLIGHT_K`] is the
    /// planet's daylight; lower makes the picture bluer, as a camera set to lamps.
    pub white_k: f64,
    /// How much darker the corners are than the middle, 0 to 1.
    pub vignette: f64,
    /// Share of the light that the lens scatters over the picture, 0 to 1: the glow of highlights and of the sun. It
    /// is [`Post::CLEAN_LENS`] for clean glass, and 0.1 for a lens behind mist.
    pub bloom: f64,
}

impl Post {
    /// The white balance of daylight.
    pub const DAYLIGHT_K: f64 = 6504.0;
    /// The bloom of clean glass.
    pub const CLEAN_LENS: f64 = 0.01;
    /// Range of the white balance.
    pub const WHITE_K: RangeInclusive<f64> = 2000.0..=25_000.0;
}

impl Default for Post {
    fn default() -> Self {
        Self {
            metering: Metering::Manual,
            tone: Tone::default(),
            smooth_edges: true,
            exposure_ev: 0.0,
            white_k: Self::DAYLIGHT_K,
            vignette: 0.0,
            bloom: Self::CLEAN_LENS,
        }
    }
}

/// What a frame takes from the frames of its view before it. Anything but [`Reuse::None`] keeps textures for the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Reuse {
    /// Nothing: equal scenes give equal pictures.
    #[default]
    None,
    /// Nothing, but the next frame may take something from this one.
    Begin,
    /// Clouds: the camera moved or time went on, and all else is as it was. A share of the pixels is marched anew, one
    /// of sixteen from medium quality on and one of four at low quality; the others are carried over by reprojection.
    Moving,
    /// Everything: the scene is that of the frame before, and only the metering may differ. The picture is the mean of
    /// all frames since, each with its own place within the pixels. At low quality it comes to have all pixels.
    Still,
}

/// What is drawn in one frame.
#[derive(Clone)]
#[non_exhaustive]
pub struct Scene<'a> {
    /// The view that this is a frame of.
    pub view_id: ViewId,
    /// Turns view space (-Z ahead, +Y up) into scene space.
    pub scene_from_view: DQuat,
    /// The camera's lens.
    pub projection: Projection,
    /// Width and height of the picture as it is shown, pixels; not zero.
    pub size_px: [u32; 2],
    /// How well the picture is drawn.
    pub quality: Quality,
    /// The lights, brightest first: at most [`super::MAX_SUNS`] for each body.
    pub suns: Vec<Sun>,
    /// Bodies without a surface, brightest first: [`super::MAX_POINTS`] of them are drawn.
    pub points: Vec<Point>,
    /// The planets, in any order.
    pub bodies: Vec<Body<'a>>,
    /// Seconds since time zero: drift of the clouds, waves.
    pub time_secs: f64,
    /// The planets, or a debug view.
    pub debug_view: DebugView,
    /// Index of the population that [`DebugView::Density`] shows, in [`Planet::life`].
    pub population: usize,
    /// Whether cloud maps and the LUTs of the air may be drafts: while a slider is dragged, an answer at once is worth
    /// more.
    pub drafts: bool,
    /// Of a tile of a photograph: the projection of the whole.
    pub(crate) whole: Option<Projection>,
    /// What the frame takes from those before it.
    pub reuse: Reuse,
    /// How radiance becomes a picture.
    pub post: Post,
}

impl<'a> Scene<'a> {
    /// An empty scene, dark.
    pub fn new(scene_from_view: DQuat, projection: Projection, size_px: [u32; 2], quality: Quality) -> Self {
        Self {
            view_id: ViewId::default(),
            scene_from_view,
            projection,
            size_px,
            quality,
            suns: Vec::new(),
            points: Vec::new(),
            bodies: Vec::new(),
            time_secs: 0.0,
            debug_view: DebugView::Shaded,
            population: 0,
            drafts: false,
            whole: None,
            reuse: Reuse::None,
            post: Post::default(),
        }
    }

    /// One planet under its own star; scene space has the planet's axes.
    pub fn of_planet(surface: &'a Surface, view: View, sun_dir_planet: DVec3) -> Self {
        Self::of_revision(surface.terrain.revision().clone(), surface, view, sun_dir_planet)
    }

    /// As [`Scene::of_planet`], with another revision of the planet for everything that is not in the tiles.
    pub fn of_revision(revision: Revision, surface: &'a Surface, view: View, sun_dir_planet: DVec3) -> Self {
        let projection = Projection::symmetric(view.camera.fov_y_rad, view.aspect());
        let mut scene = Self::new(view.camera.planet_from_view, projection, view.size_px, view.quality);
        scene.suns.push(Sun::new(&revision.planet().star, sun_dir_planet));
        let body = Body::new(BodyId::default(), surface, -view.camera.position_planet_m);
        scene.bodies.push(Body { revision, ..body });
        scene
    }

    /// The population whose density is shown.
    pub(crate) fn shown_population(&self) -> Option<usize> {
        (self.debug_view == DebugView::Density).then_some(self.population)
    }

    /// The lights of a body.
    pub(crate) fn suns_of(&self, id: BodyId) -> impl Iterator<Item = &Sun> {
        self.suns.iter().filter(move |sun| sun.only.is_none_or(|only| only == id))
    }

    /// The camera as a body sees it: the view to build its tiles for. An off-axis picture lies inside the view's
    /// frustum.
    pub fn view_of(&self, position_m: DVec3, scene_from_body: DQuat) -> View {
        let body_from_scene = scene_from_body.inverse();
        let [left, right, bottom, top] = self.projection.tangents;
        let aspect = f64::from(self.size_px[0]) / f64::from(self.size_px[1]);
        let (widest, highest) = (left.abs().max(right.abs()), bottom.abs().max(top.abs()));
        let camera = Camera {
            position_planet_m: body_from_scene * -position_m,
            planet_from_view: body_from_scene * self.scene_from_view,
            fov_y_rad: 2.0 * highest.max(widest / aspect).atan(),
        };
        View { camera, size_px: self.size_px, quality: self.quality }
    }

    /// The matrices of the frame.
    pub fn matrices(&self) -> Matrices {
        let [half_x, half_y] = self.projection.half_extent();
        let [center_x, center_y] = self.projection.center(self.size_px);
        let near_m = self.projection.near_m.unwrap_or_else(|| self.bodies.iter().map(near_m).fold(1000.0, f64::min));
        let clip_from_view = Mat4::from_cols_array_2d(&[
            [(1.0 / half_x) as f32, 0.0, 0.0, 0.0],
            [0.0, (1.0 / half_y) as f32, 0.0, 0.0],
            [(center_x / half_x) as f32, (center_y / half_y) as f32, 0.0, -1.0],
            [0.0, 0.0, near_m as f32, 0.0],
        ]);
        let view_from_scene = Mat4::from_quat(self.scene_from_view.inverse().as_quat());
        Matrices { near_m, clip_from_view, clip_from_scene: clip_from_view * view_from_scene }
    }
}

/// Nearest near plane: walls of 89.9 degrees stand 3 mm beside an eye 2 m above their foot. Depth is reversed and a
/// float, so that a near plane so close costs no precision.
const LEAST_NEAR_M: f64 = 0.001;

/// Near plane for a body: a twentieth of the distance to its highest ground.
fn near_m(body: &Body<'_>) -> f64 {
    let highest_m = body.planet().radius_m() + height_range_m(body.surface).1;
    ((body.position_m.length() - highest_m) * 0.05).clamp(LEAST_NEAR_M, 1000.0)
}

/// Lowest and highest height of all tiles, metres.
pub(crate) fn height_range_m(surface: &Surface) -> (f64, f64) {
    let heights = surface.leaves.iter().map(|leaf| (leaf.tile.min_height_m, leaf.tile.max_height_m));
    heights.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0.0, 0.0))
}

/// Matrices of a frame. Depth is reversed, the far plane at infinity: depth = near plane / distance along the view
/// axis.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Matrices {
    /// Distance of the near plane.
    pub near_m: f64,
    /// View space to clip space, metres.
    pub clip_from_view: Mat4,
    /// Scene space to clip space, metres: its origin is the camera.
    pub clip_from_scene: Mat4,
}

/// A position in metres as the sum of two that 32 bits hold: the greater part and the rest.
pub fn split_position(position_m: DVec3) -> [glam::Vec3; 2] {
    let high = position_m.as_vec3();
    [high, (position_m - high.as_dvec3()).as_vec3()]
}
