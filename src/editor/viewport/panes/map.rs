//! Maps of the whole globe: flat, or around a pole. Colours of the ground with shaded relief, a graticule, the eye, the
//! points of the selected edit. A click flies there.

use crate::bake::{self, Bake, Format, Projection, Region};
use crate::editor::state::surveyor::{Asked, Surveyor};
use crate::lod::Camera;
use crate::planet::GroundEdit;
use crate::planet::edits::EditPoint;
use crate::planet::param::Stage;
use crate::sphere::LatLon;
use crate::sphere::geo::east_north;
use crate::terrain::Terrain;
use eframe::egui::{self, Color32, Pos2, Stroke, pos2, vec2};
use glam::DVec3;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

/// Width of a flat map and side of a polar one, pixels.
const FLAT_PX: u32 = 1024;
const POLAR_PX: u32 = 640;
/// Brightness of ground whose albedo is 1; more is white.
const EXPOSURE: f32 = 2.4;
/// Strength of shaded relief: the brightness changes by this for a slope of the mean. Below the sea it is a share.
const RELIEF: f32 = 0.22;
const UNDER_SEA: f32 = 0.35;
/// Steps of the graticule, degrees.
const GRID_DEG: i32 = 30;
/// Longest stroke of a line, as a share of the map's width.
const LONGEST_STROKE: f32 = 0.4;

/// How a map shows the globe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapKind {
    /// Longitude to the right, latitude upwards.
    Flat,
    /// The northern half around the pole, with true distances from it.
    North,
    /// The southern half.
    South,
}

impl MapKind {
    /// All kinds.
    pub const ALL: [MapKind; 3] = [MapKind::Flat, MapKind::North, MapKind::South];

    /// The name in menus.
    pub fn label(self) -> &'static str {
        match self {
            MapKind::Flat => "Map",
            MapKind::North => "Map of the north",
            MapKind::South => "Map of the south",
        }
    }

    /// Width by height.
    fn aspect(self) -> f32 {
        if self == MapKind::Flat { 2.0 } else { 1.0 }
    }

    /// The place of a direction on the map, 0 to 1 from the left and from the top. None on the other half.
    pub(super) fn place(self, dir_planet: DVec3) -> Option<[f64; 2]> {
        let place = LatLon::from_direction(dir_planet);
        if self == MapKind::Flat {
            return Some([0.5 + place.lon_rad / TAU, 0.5 - place.lat_rad / PI]);
        }
        let away = (FRAC_PI_2 - self.sign() * place.lat_rad) / PI;
        let (sin, cos) = place.lon_rad.sin_cos();
        (away <= 0.5).then_some([0.5 + away * sin, 0.5 + self.sign() * away * cos])
    }

    /// The direction at a place on the map. None beyond the edge.
    pub(super) fn direction(self, [x, y]: [f64; 2]) -> Option<DVec3> {
        if !(0.0..=1.0).contains(&x) || !(0.0..=1.0).contains(&y) {
            return None;
        }
        let (lat_rad, lon_rad) = if self == MapKind::Flat {
            ((0.5 - y) * PI, (x - 0.5) * TAU)
        } else {
            let (right, down) = (x - 0.5, self.sign() * (y - 0.5));
            let away = right.hypot(down);
            if away > 0.5 {
                return None;
            }
            (self.sign() * (FRAC_PI_2 - away * PI), right.atan2(down))
        };
        Some(LatLon { lat_rad, lon_rad }.direction())
    }

    /// 1 for north, -1 for south.
    fn sign(self) -> f64 {
        if self == MapKind::South { -1.0 } else { 1.0 }
    }

    /// The same, as bakes know it.
    fn projection(self, radius_km: f64) -> (Projection, u32) {
        match self {
            MapKind::Flat => (Projection::Equirect, FLAT_PX),
            _ => {
                let lat_deg = 90.0 * self.sign();
                (Projection::Region(Region { lat_deg, lon_deg: 0.0, side_km: PI * radius_km }), POLAR_PX)
            }
        }
    }
}

/// The maps of a pane, made on another thread.
pub(super) struct Map {
    surveyors: Option<[Surveyor<Arc<egui::ColorImage>>; 3]>,
    ctx: egui::Context,
    /// The texture on screen, and the picture that it holds.
    texture: Option<(MapKind, Arc<egui::ColorImage>, egui::TextureHandle)>,
}

impl Map {
    pub(super) fn new(ctx: &egui::Context) -> Self {
        Self { surveyors: None, ctx: ctx.clone(), texture: None }
    }

    /// Asks for a map, unless it is there.
    pub(super) fn ask(&mut self, kind: MapKind, terrain: &Arc<Terrain>) {
        let ctx = &self.ctx;
        let surveyors = self.surveyors.get_or_insert_with(|| {
            let made: [fn(&Terrain) -> Arc<egui::ColorImage>; 3] = [
                |terrain| picture(MapKind::Flat, terrain).into(),
                |terrain| picture(MapKind::North, terrain).into(),
                |terrain| picture(MapKind::South, terrain).into(),
            ];
            made.map(|survey| {
                let ctx = ctx.clone();
                Surveyor::new(survey, same_map, move || ctx.request_repaint())
            })
        });
        surveyors[kind as usize].ask(terrain);
    }

    /// Shows a map in a rectangle. `eye`: the camera that is marked. Gives the direction that was clicked.
    pub(super) fn show(
        &mut self,
        ui: &mut egui::Ui,
        kind: MapKind,
        rect: egui::Rect,
        response: Option<&egui::Response>,
        eye: Option<&Camera>,
        selected: Option<&GroundEdit>,
    ) -> Option<DVec3> {
        let aspect = kind.aspect();
        let width = rect.width().min(rect.height() * aspect);
        let on = egui::Rect::from_center_size(rect.center(), vec2(width, width / aspect));
        let painter = ui.painter_at(rect);
        if let Some(image) = self.surveyors.as_ref().and_then(|surveyors| surveyors[kind as usize].found())
            && !self.texture.as_ref().is_some_and(|(_, held, _)| Arc::ptr_eq(held, image))
        {
            let data = egui::ImageData::Color(image.clone());
            let texture = ui.ctx().load_texture("map of the globe", data, egui::TextureOptions::LINEAR);
            self.texture = Some((kind, image.clone(), texture));
        }
        match self.texture.as_ref().filter(|(of, ..)| *of == kind) {
            Some((.., texture)) => {
                let uv = egui::Rect::from_min_max(Pos2::ZERO, pos2(1.0, 1.0));
                painter.image(texture.id(), on, uv, Color32::WHITE);
            }
            None => {
                let font = egui::TextStyle::Body.resolve(ui.style());
                painter.text(rect.center(), egui::Align2::CENTER_CENTER, "Drawing the map…", font, Color32::GRAY);
            }
        }
        graticule(&painter, kind, on);
        if let Some(edit) = selected {
            let dirs: Vec<DVec3> = edit.points.0.iter().map(EditPoint::direction).collect();
            marked_line(&painter, kind, on, &dirs, Stroke::new(1.5, Color32::from_rgb(255, 220, 90)));
        }
        if let Some(eye) = eye {
            mark_eye(&painter, kind, on, eye);
        }
        let response = response?;
        let at = response.hover_pos().and_then(|pos| {
            let place = (pos - on.min) / on.size();
            kind.direction([f64::from(place.x), f64::from(place.y)])
        })?;
        let (lat_deg, lon_deg) = LatLon::from_direction(at).to_degrees();
        let font = egui::TextStyle::Small.resolve(ui.style());
        let text = format!("{lat_deg:.1}°, {lon_deg:.1}°");
        painter.text(on.left_bottom() + vec2(6.0, -4.0), egui::Align2::LEFT_BOTTOM, text, font, Color32::WHITE);
        response.clicked().then_some(at)
    }
}

/// Whether two terrains have the same map.
fn same_map(asked: &Asked, terrain: &Terrain) -> bool {
    let changes = terrain.keys().changes_since(&asked.keys);
    // The ground is seen through the water over it.
    !changes.touches_tiles() && !changes.contains(Stage::Material) && asked.planet.water == terrain.planet().water
}

/// The colours of the ground with shaded relief.
fn picture(kind: MapKind, terrain: &Terrain) -> egui::ColorImage {
    let (projection, size) = kind.projection(terrain.planet().radius_km);
    let bake = Bake::new(Arc::new(terrain.clone()), Vec::new(), projection, size, Format::Png8);
    let go_on = || true;
    let values = |map| bake.map_values(map, size, &go_on).unwrap_or_default();
    let (albedo, _) = values(bake::Map::Albedo);
    let (heights_m, [width, height]) = values(bake::Map::Height);
    let [width, height] = [width as usize, height as usize];
    let sea_m = terrain.planet().sea_level_m().map_or(f32::MIN, |sea_m| sea_m as f32);
    // The light comes from the upper left.
    let rise = |column: usize, row: usize| {
        let at = |column: usize, row: usize| heights_m[row * width + column];
        let (left, right) = (column.saturating_sub(1), (column + 1).min(width - 1));
        let (above, below) = (row.saturating_sub(1), (row + 1).min(height - 1));
        at(right, row) - at(left, row) + at(column, below) - at(column, above)
    };
    let all = || (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
    let is_land = |(column, row): &(usize, usize)| heights_m[row * width + column] > sea_m;
    let has_land = all().any(|place| is_land(&place));
    let land = all().filter(|place| !has_land || is_land(place));
    let (sum, count) = land
        .fold((0.0_f64, 1_u32), |(sum, count), (column, row)| (sum + f64::from(rise(column, row).abs()), count + 1));
    let mean_m = (sum / f64::from(count)).max(1e-3) as f32;
    let pixel = |(column, row): (usize, usize)| {
        let at = row * width + column;
        let inside = kind.direction([(column as f64 + 0.5) / width as f64, (row as f64 + 0.5) / height as f64]);
        if inside.is_none() {
            return Color32::TRANSPARENT;
        }
        let share = if heights_m[at] > sea_m { RELIEF } else { RELIEF * UNDER_SEA };
        let light = (1.0 + share * (rise(column, row) / mean_m)).clamp(0.35, 1.7) * EXPOSURE;
        let [r, g, b] = [0, 1, 2].map(|k| bake::srgb_byte(f64::from(albedo[3 * at + k] * light)));
        Color32::from_rgb(r, g, b)
    };
    egui::ColorImage::new([width, height], all().map(pixel).collect())
}

fn on_map(kind: MapKind, on: egui::Rect, dir_planet: DVec3) -> Option<Pos2> {
    let [x, y] = kind.place(dir_planet)?;
    Some(on.min + vec2(x as f32, y as f32) * on.size())
}

/// A line through directions. A stroke over the edge of the map would cross all of it, and is left out.
fn line(painter: &egui::Painter, kind: MapKind, on: egui::Rect, dirs: &[DVec3], stroke: Stroke) {
    let places: Vec<Option<Pos2>> = dirs.iter().map(|dir| on_map(kind, on, *dir)).collect();
    for pair in places.windows(2) {
        if let [Some(a), Some(b)] = *pair
            && a.distance(b) < LONGEST_STROKE * on.width()
        {
            painter.line_segment([a, b], stroke);
        }
    }
}

/// A line with its points.
fn marked_line(painter: &egui::Painter, kind: MapKind, on: egui::Rect, dirs: &[DVec3], stroke: Stroke) {
    line(painter, kind, on, dirs, stroke);
    for at in dirs.iter().filter_map(|dir| on_map(kind, on, *dir)) {
        painter.circle_filled(at, 2.0, stroke.color);
    }
}

fn graticule(painter: &egui::Painter, kind: MapKind, on: egui::Rect) {
    let faint = |is_main: bool| Stroke::new(1.0, Color32::from_white_alpha(if is_main { 60 } else { 26 }));
    let draw = |place: &dyn Fn(f64) -> LatLon, steps: usize, stroke: Stroke| {
        let dirs: Vec<DVec3> = (0..=steps).map(|step| place(step as f64 / steps as f64).direction()).collect();
        line(painter, kind, on, &dirs, stroke);
    };
    for lat_deg in (-90 + GRID_DEG..90).step_by(GRID_DEG as usize) {
        let along = |t: f64| LatLon::from_degrees(f64::from(lat_deg), -179.999 + 359.998 * t);
        draw(&along, 72, faint(lat_deg == 0));
    }
    for lon_deg in (-180..180).step_by(GRID_DEG as usize) {
        let along = |t: f64| LatLon::from_degrees(-89.9 + 179.8 * t, f64::from(lon_deg));
        draw(&along, 24, faint(lon_deg == 0));
    }
}

/// The place under the eye, and the way it looks.
fn mark_eye(painter: &egui::Painter, kind: MapKind, on: egui::Rect, eye: &Camera) {
    let up = eye.position_planet_m.normalize_or(DVec3::Z);
    let Some(at) = on_map(kind, on, up) else { return };
    let color = Color32::from_rgb(255, 90, 70);
    let (_, north) = east_north(up);
    // Straight down, the top of the picture is where it looks.
    let ahead = eye.forward_planet() + 1e-3 * eye.ray_dir_planet(0.0, 0.5, 1.0);
    let ahead = (ahead - up * ahead.dot(up)).normalize_or(north);
    if let Some(towards) = on_map(kind, on, (up + ahead * 0.02).normalize()) {
        let way = (towards - at).normalized();
        if way.length() > 0.5 && towards.distance(at) < 0.2 * on.width() {
            painter.line_segment([at, at + way * 14.0], Stroke::new(2.0, color));
        }
    }
    painter.circle(at, 4.5, color, Stroke::new(1.5, Color32::WHITE));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::spread;

    #[test]
    fn places_on_maps_and_directions_agree() {
        for kind in MapKind::ALL {
            let mut seen = 0;
            for dir in spread(500) {
                let Some(place) = kind.place(dir) else { continue };
                seen += 1;
                assert!(kind.direction(place).unwrap().distance(dir) < 1e-9, "{kind:?} {dir}");
            }
            assert!(seen >= 240, "{kind:?}: {seen}");
        }
        assert_eq!(MapKind::Flat.direction([0.5, 1.2]), None);
        assert_eq!(MapKind::North.direction([0.01, 0.01]), None);
        // North up, east to the right; around the north pole the prime meridian runs down, around the south pole up.
        let place = |kind: MapKind, lat, lon| kind.place(LatLon::from_degrees(lat, lon).direction()).unwrap();
        assert!(place(MapKind::Flat, 80.0, 90.0)[0] > 0.7 && place(MapKind::Flat, 80.0, 90.0)[1] < 0.1);
        assert!(place(MapKind::North, 45.0, 0.0)[1] > 0.6 && place(MapKind::South, -45.0, 0.0)[1] < 0.4);
    }

    #[test]
    fn polar_maps_are_those_that_bakes_make() {
        use crate::sphere::Tangent;
        for (kind, lat) in [(MapKind::North, 90.0), (MapKind::South, -90.0)] {
            let tangent = Tangent::at(LatLon::from_degrees(lat, 0.0));
            for (x, y) in [(0.3, 0.1), (-0.2, 0.25), (0.0, -0.4)] {
                // Right and up from the middle, in sides.
                let dir = tangent.direction(x * PI, y * PI);
                let [at_x, at_y] = kind.place(dir).unwrap();
                assert!(
                    (at_x - 0.5 - x).abs() < 1e-6 && (at_y - 0.5 + y).abs() < 1e-6,
                    "{kind:?} {x} {y}: {at_x} {at_y}"
                );
            }
        }
    }
}
