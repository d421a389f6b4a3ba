//! Horizons of grounds whose shadows geometry tells.

use super::*;
use crate::lod::horizon::face_step;
use crate::lod::range::spacing_rad;
use crate::lod::tile::Tile;
use crate::lod::{Camera, Quality};
use crate::planet::Planet;
use crate::sphere::{Edge, LatLon, geo};
use crate::tiles::build_now;
use glam::DVec3;

const RADIUS_M: f64 = 6.371e6;

fn planet() -> Arc<Planet> {
    Arc::new(Planet { radius_km: RADIUS_M * 1e-3, layers: Vec::new(), water: None, ..Planet::default() })
}

fn place() -> LatLon {
    LatLon::from_degrees(12.0, 20.0)
}

/// Straight down onto [`place`] from so high, wide enough for shadows of mountains to stay in the picture.
fn view(altitude_m: f64) -> View {
    let camera = Camera::over(place(), RADIUS_M + altitude_m, 0.0, -1.57, 1.6);
    View { camera, size_px: [800, 800], quality: Quality::Medium }
}

/// The surface of a planet with this ground instead of its own, horizons found.
fn surface_of(view: &View, height_m: impl Fn(DVec3) -> f64) -> Surface {
    let mut surface = build_now(&planet(), view).unwrap();
    for leaf in &mut surface.leaves {
        let mut vertices = leaf.tile.vertices.clone();
        for (i, vertex) in vertices.iter_mut().enumerate() {
            let (x, y) = (i % TILE_SIDE, i / TILE_SIDE);
            let dir = leaf.tile.id.direction(x as f64 / TILE_QUADS as f64, y as f64 / TILE_QUADS as f64);
            vertex.height_m = height_m(dir) as f32;
        }
        let tile = &leaf.tile;
        leaf.tile = Arc::new(Tile { vertices, min_height_m: -10.0, max_height_m: 6000.0, ..*tile_parts(tile) });
    }
    assert!(HorizonFinder::new(&surface, view).find(&mut surface, &|_| None, &|_| {}, &|| true, &|| true));
    surface
}

/// A tile without its vertices.
fn tile_parts(tile: &Tile) -> Box<Tile> {
    Box::new(Tile {
        id: tile.id,
        serial: tile.serial,
        heights_serial: tile.heights_serial,
        vertices: Vec::new(),
        min_height_m: tile.min_height_m,
        max_height_m: tile.max_height_m,
        center_planet_m: tile.center_planet_m,
        bounding_radius_m: tile.bounding_radius_m,
        blocks: tile.blocks,
    })
}

/// Elevation of the horizon of a place towards another, as the shader finds it.
fn elevation_rad(surface: &Surface, dir: DVec3, towards: DVec3) -> f64 {
    let leaf = surface.leaves.iter().find(|leaf| NodeId::containing(dir, leaf.tile.id.level) == leaf.tile.id).unwrap();
    let tile = leaf.horizon.as_ref().unwrap();
    assert_eq!(tile.id, leaf.tile.id);
    let (_, s, t) = crate::sphere::cube::face_point(dir);
    let scale = 0.5 * f64::from(1_u32 << tile.id.level);
    let place = [(s + 1.0) * scale - f64::from(tile.id.x), (t + 1.0) * scale - f64::from(tile.id.y)];
    let [a, b] = face_step(tile.id.face, dir, towards);
    let turn = (b.atan2(a) / std::f64::consts::TAU).rem_euclid(1.0) * AZIMUTHS as f64;
    between(turn, |azimuth| bilinear(&tile.own[azimuth * TILE_VERTICES..], place)).asin()
}

/// The value between the azimuths, as the shader finds it.
fn between(turn: f64, at: impl Fn(usize) -> f64) -> f64 {
    let [a, b, c, d] = [AZIMUTHS - 1, 0, 1, 2].map(|i| at((turn as usize + i) % AZIMUTHS));
    let f = turn.fract();
    let slopes = [0.5 * (c - a), 0.5 * (d - b)];
    let (rest, turned) = (1.0 - f, f * f * (3.0 - 2.0 * f));
    b + (c - b) * turned + f * rest * (slopes[0] * rest - slopes[1] * f)
}

fn bilinear(image: &[f16], place: [f64; 2]) -> f64 {
    let [(x, u), (y, v)] = place.map(|w| {
        let w = w.clamp(0.0, 1.0) * TILE_QUADS as f64;
        let i = (w as usize).min(TILE_QUADS - 1);
        (i, w - i as f64)
    });
    let at = |dx: usize, dy: usize| image[(y + dy) * TILE_SIDE + x + dx].to_f64();
    (at(0, 0) * (1.0 - u) + at(1, 0) * u) * (1.0 - v) + (at(0, 1) * (1.0 - u) + at(1, 1) * u) * v
}

/// The place so far from [`place`] in an azimuth (from north, clockwise).
fn away(distance_m: f64, azimuth_deg: f64) -> DVec3 {
    let up = place().direction();
    let (east, north) = geo::east_north(up);
    let (sin, cos) = libm::sincos(azimuth_deg.to_radians());
    let (far, near) = libm::sincos(distance_m / RADIUS_M);
    up * near + (north * cos + east * sin) * far
}

/// A round mountain over [`place`], 3 km high and 12 km from top to foot, without a corner anywhere.
fn mountain_m(dir: DVec3) -> f64 {
    let r = dir.angle_between(place().direction()) * RADIUS_M / 12e3;
    if r < 1.0 { 3000.0 * (1.0 - r * r) * (1.0 - r * r) } else { 0.0 }
}

/// Where the shadow of that mountain ends while the star stands so high over the place where it ends: by a march in
/// small steps.
fn shadow_end_m(elevation_rad: f64) -> f64 {
    let seen_rad = |distance_m: f64| {
        let own = RADIUS_M;
        let over = |t_m: f64| {
            let radius_m = RADIUS_M + mountain_m(away(distance_m - t_m, 0.0));
            let (sin, cos) = libm::sincos(t_m / RADIUS_M);
            (radius_m * cos - own).atan2(radius_m * sin)
        };
        (1..4000).map(|i| over(f64::from(i) * 25.0)).fold(-1.0, f64::max)
    };
    let (mut near_m, mut far_m) = (12e3, 90e3);
    while far_m - near_m > 10.0 {
        let middle_m = 0.5 * (near_m + far_m);
        if seen_rad(middle_m) > elevation_rad { near_m = middle_m } else { far_m = middle_m }
    }
    near_m
}

#[test]
fn the_shadow_of_a_mountain_is_as_long_as_geometry_says() {
    let view = view(40e3);
    let surface = surface_of(&view, mountain_m);
    let level = surface.leaves.iter().map(|leaf| leaf.tile.id.level).max().unwrap();
    for sun_deg in [5.0_f64, 10.0] {
        let truth_m = shadow_end_m(sun_deg.to_radians());
        // The level that sees the mountain from the end of its shadow.
        let spacing_m = (0..=level).map(|l| spacing_rad(l) * RADIUS_M).find(|s| truth_m >= 16.0 * s).unwrap();
        let mut worst_m = [0.0_f64; 2];
        for azimuth in 0..2 * AZIMUTHS {
            // Half of them in the middle between the azimuths that are kept.
            let dir = libm::sincos(std::f64::consts::TAU * (azimuth as f64 * 0.5) / AZIMUTHS as f64);
            let up = place().direction();
            let (face, s, t) = crate::sphere::cube::face_point(up);
            let step = crate::sphere::cube::direction(face, s + dir.1 * 1e-6, t + dir.0 * 1e-6) - up;
            let (east, north) = geo::east_north(up);
            let azimuth_deg = step.dot(east).atan2(step.dot(north)).to_degrees();
            let lit = |distance_m: f64| {
                let here = away(-distance_m, azimuth_deg);
                elevation_rad(&surface, here, (up - here).normalize()) < sun_deg.to_radians()
            };
            let end_m = (0..9000).map(|i| 12e3 + f64::from(i) * 10.0).find(|m| lit(*m)).unwrap();
            let worst = &mut worst_m[azimuth % 2];
            *worst = worst.max((end_m - truth_m).abs());
        }
        assert!(
            worst_m[0] < 2.0 * spacing_m,
            "{worst_m:?} of {truth_m} at {sun_deg}, {spacing_m} from vertex to vertex"
        );
        assert!(worst_m[1] < 0.05 * truth_m, "{worst_m:?} of {truth_m} at {sun_deg}");
    }
}

#[test]
fn level_ground_is_lit_by_the_lowest_star_and_open_to_all_of_the_sky() {
    for altitude_m in [3e6, 40e3, 2.0] {
        let view = view(altitude_m);
        let surface = surface_of(&view, |_| 0.0);
        let mut tiles = 0;
        for tile in surface.leaves.iter().filter_map(|leaf| leaf.horizon.as_ref()) {
            let (sines, open) = tile.own.split_at(AZIMUTHS * TILE_VERTICES);
            assert!(sines.iter().all(|sine| sine.to_f32() <= 0.0), "level {}", tile.id.level);
            assert!(open.iter().all(|open| open.to_f32() == 1.0));
            tiles += 1;
        }
        assert!(tiles > 6);
    }
}

#[test]
fn a_plane_slope_is_as_open_as_its_tilt_says_and_a_pit_is_not() {
    let slope = |dir: DVec3| dir.dot(geo::east_north(place().direction()).0) * RADIUS_M * 0.3;
    let open = |surface: &Surface, dir: DVec3| {
        let leaf =
            surface.leaves.iter().find(|leaf| NodeId::containing(dir, leaf.tile.id.level) == leaf.tile.id).unwrap();
        leaf.horizon.as_ref().unwrap().own[AZIMUTHS * TILE_VERTICES..][TILE_VERTICES / 2].to_f32()
    };
    // So near that tiles have vertices within the pit, however smooth the ground is that they were chosen for.
    let view = view(500.0);
    let up = place().direction();
    assert!(open(&surface_of(&view, slope), up) > 0.97);
    // A bowl 1 km deep and 1 km wide: most of the sky is gone.
    let pit = |dir: DVec3| if dir.angle_between(up) * RADIUS_M < 1000.0 { -1000.0 } else { 0.0 };
    let share = open(&surface_of(&view, pit), up);
    assert!((0.3..0.7).contains(&share), "{share}");
}

#[test]
fn neighbours_of_a_level_agree_on_their_border() {
    let rough = |dir: DVec3| {
        let wave = |k: f64, m: f64| m * libm::sin(dir.x * k) * libm::sin(dir.y * k * 1.1) * libm::sin(dir.z * k + 1.0);
        wave(300.0, 2500.0) + wave(2000.0, 700.0) + wave(9000.0, 120.0)
    };
    // Where a face's edge runs through the picture.
    let corner = LatLon::from_degrees(3.0, 45.0);
    let camera = Camera::over(corner, RADIUS_M + 60e3, 0.0, -1.57, 1.2);
    let view = View { camera, size_px: [800, 800], quality: Quality::Medium };
    let surface = surface_of(&view, rough);
    let tiles: HashMap<NodeId, &HorizonTile> =
        surface.leaves.iter().filter_map(|leaf| Some((leaf.tile.id, leaf.horizon.as_deref()?))).collect();
    let (mut on_face, mut across) = (0, 0);
    for (id, tile) in &tiles {
        let other_id = id.neighbour(Edge::Right);
        let Some(other) = tiles.get(&other_id).filter(|other| other.id == other_id && tile.id == *id) else { continue };
        if other_id.face == id.face {
            for image in 0..HORIZON_IMAGES {
                for y in 0..TILE_SIDE {
                    let at =
                        |tile: &HorizonTile, x: usize| tile.own[image * TILE_VERTICES + y * TILE_SIDE + x].to_f32();
                    let (a, b) = (at(tile, TILE_QUADS), at(other, 0));
                    // The openness knows a slope by one vertex on either side; all else is the same to rounding.
                    assert!((a - b).abs() < 2e-3, "{id:?} {image} {y}: {a} {b}");
                }
            }
            on_face += 1;
        } else {
            for y in 0..TILE_SIDE {
                let dir = id.direction(1.0, y as f64 / TILE_QUADS as f64);
                let (east, north) = geo::east_north(dir);
                let seen = |towards: DVec3, id: NodeId| {
                    let tile = tiles[&id];
                    let [a, b] = face_step(id.face, dir, towards);
                    let turn = (b.atan2(a) / std::f64::consts::TAU).rem_euclid(1.0) * AZIMUTHS as f64;
                    let own_dir = |i: usize| {
                        let (x, y) = (i % TILE_SIDE, i / TILE_SIDE);
                        id.direction(x as f64 / TILE_QUADS as f64, y as f64 / TILE_QUADS as f64)
                    };
                    let i = (0..TILE_VERTICES).find(|i| own_dir(*i).distance(dir) < 1e-12).unwrap();
                    between(turn, |azimuth| tile.own[azimuth * TILE_VERTICES + i].to_f64())
                };
                for towards in [east, north, -east, (north - east).normalize()] {
                    let (a, b) = (seen(towards, *id), seen(towards, other_id));
                    assert!((a - b).abs() < 0.06, "{id:?} {y}: {a} {b}");
                }
            }
            across += 1;
        }
    }
    assert!(on_face > 20 && across > 0, "{on_face} {across}");
}

#[test]
fn equal_grounds_find_their_horizons_again_and_another_does_not() {
    let view = view(40e3);
    let mut surface = surface_of(&view, mountain_m);
    let known: HashMap<NodeId, Arc<HorizonTile>> =
        surface.leaves.iter().filter_map(|leaf| leaf.horizon.clone()).map(|tile| (tile.id, tile)).collect();
    let made = |surface: &mut Surface| {
        let before = surface.stats.horizons.tiles;
        HorizonFinder::new(surface, &view).find(surface, &|id| known.get(&id).cloned(), &|_| {}, &|| true, &|| true);
        surface.stats.horizons.tiles - before
    };
    // Nodes above the leaves are not among the known ones.
    let above = made(&mut surface);
    assert!(above < known.len(), "{above}");
    let mut other = surface_of(&view, |dir| mountain_m(dir) * 1.01);
    assert!(made(&mut other) > above);
}
