//! Level of detail on the CPU: every LOD cut draws one surface, nothing visible is culled, positions are steady to the
//! millimetre.

use crate::support::dice::Dice;
use crate::support::layered::layered;
use glam::{DVec3, Mat4, Vec3};
use std::collections::HashMap;
use std::sync::Arc;
use std::time::{Duration, Instant};
use tellus::lod::chords::chords;
use tellus::lod::morph::{COARSEST_MORPHING, shifts_m};
use tellus::lod::range::FULL_AT;
use tellus::lod::tile::{TILE_QUADS, TILE_SIDE};
use tellus::lod::{Camera, Culling, Quality, Selection, Tile, Vertex, View, opening};
use tellus::planet::{Fbm, Layer, Planet, Shape, random, shipped};
use tellus::sphere::{Edge, LatLon};
use tellus::terrain::Terrain;
use tellus::tiles::{
    Limits, Surface, add_detail_within, budget_tiles, build_now, build_over, build_within, lowest_radius_m,
};

/// A camera 2 m to three radii above the ground, in any direction.
fn any_view(dice: &mut Dice, terrain: &Terrain, size_px: [u32; 2]) -> View {
    let place = dice.place();
    let radius_m = terrain.planet().radius_m();
    let altitude_m = 2.0 * (1.5 * radius_m).powf(dice.roll());
    let ground_m = radius_m + terrain.height_m(place.direction());
    let (heading, pitch) = (dice.roll() * std::f64::consts::TAU, (dice.roll() - 0.75) * 2.0);
    let camera = Camera::over(place, ground_m + altitude_m, heading, pitch, Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px, quality: Quality::Low }
}

fn rough() -> Planet {
    let shape = Shape::Fbm(Fbm { wavelength_km: 3000.0, octaves: 24, ..Fbm::default() });
    Planet { layers: vec![Layer { amplitude_m: 6000.0, shape, ..Layer::default() }], water: None, ..Planet::default() }
}

/// The position of a vertex relative to the eye, as the shader computes it.
fn drawn_rel_m(vertex: &Vertex, shift_m: f32, eye_planet_m: DVec3) -> Vec3 {
    let high = eye_planet_m.as_vec3();
    let low = (eye_planet_m - high.as_dvec3()).as_vec3();
    let [vertex_high, vertex_low] = [vertex.position_high_m, vertex.position_low_m].map(Vec3::from_array);
    (vertex_high - high) + (vertex_low - low) + shift_m * vertex_high.normalize()
}

/// The vertices that a tile draws on an edge, in order.
fn edge(edge: Edge) -> impl Iterator<Item = usize> {
    (0..TILE_SIDE).map(move |i| match edge {
        Edge::Left => i * TILE_SIDE,
        Edge::Right => i * TILE_SIDE + TILE_QUADS,
        Edge::Bottom => i,
        Edge::Top => TILE_QUADS * TILE_SIDE + i,
    })
}

fn bits(v: Vec3) -> [u32; 3] {
    v.to_array().map(|x| (x + 0.0).to_bits())
}

fn key(vertex: &Vertex) -> [u64; 3] {
    vertex.position_planet_m().to_array().map(|x| (x + 0.0).to_bits())
}

fn surfaces() -> Vec<Surface> {
    let planet = Arc::new(rough());
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let corner = LatLon::from_degrees(35.264_389_682_754_654, 45.0);
    let over = |place: LatLon, altitude_m: f64, pitch: f64, quality| {
        let radius_m = planet.radius_m() + terrain.height_m(place.direction()) + altitude_m;
        let camera = Camera::over(place, radius_m, 0.4, pitch, Camera::DEFAULT_FOV_Y_RAD);
        build_now(&planet, &View { camera, size_px: [320, 200], quality }).unwrap()
    };
    vec![
        over(corner, 1.7, -0.2, Quality::Low),
        over(corner, 300.0, -0.6, Quality::Medium),
        over(LatLon::from_degrees(89.999, 10.0), 20e3, -0.9, Quality::Medium),
        over(LatLon::from_degrees(20.0, 45.0), 2e6, -1.5, Quality::High),
    ]
}

#[test]
fn tiles_meet_to_the_bit_and_exactly_on_the_coarser_edge() {
    surfaces().iter().for_each(assert_meets);
}

fn assert_meets(surface: &Surface) {
    let Met { skipped, shared, off_px } = meet(surface).unwrap_or_else(|gap| panic!("{gap}"));
    assert!(shared > 500 && skipped > 50, "{shared} {skipped}");
    assert!(off_px < 0.1, "{off_px}");
}

/// How tiles meet.
#[derive(Default)]
pub(crate) struct Met {
    /// Vertices that parent edges omit.
    skipped: usize,
    /// Vertices that neighbours share.
    shared: usize,
    /// Farthest that an omitted vertex lies off the parent edge, in pixels of the picture.
    pub(crate) off_px: f32,
}

/// How all tiles meet their neighbours, or where there is a gap.
pub(crate) fn meet(surface: &Surface) -> Result<Met, String> {
    let seen = Culling::new(&surface.view, lowest_radius_m(&surface.terrain));
    let eye = surface.view.camera.position_planet_m;
    let mut drawn: HashMap<[u64; 3], ([u32; 3], usize)> = HashMap::new();
    let mut met = Met::default();
    let all: Vec<(&Tile, Vec<f32>, u8)> = surface
        .leaves
        .iter()
        .map(|leaf| (&*leaf.tile, shifts_m(&leaf.tile, leaf.finer_edges, eye, &surface.ranges), leaf.coarser_edges))
        .collect();
    for (tile, shifts_m, coarser) in &all {
        for side in Edge::ALL {
            for (n, i) in edge(side).enumerate() {
                let vertex = &tile.vertices[i];
                let place = drawn_rel_m(vertex, shifts_m[i], eye);
                if n % 2 == 1 && coarser & side.bit() != 0 {
                    // Omitted: the parent edge runs through its location.
                    met.skipped += 1;
                    let step = edge(side).nth(1).unwrap() - edge(side).next().unwrap();
                    let [a, b] = [i - step, i + step].map(|i| drawn_rel_m(&tile.vertices[i], shifts_m[i], eye));
                    let chord = (b - a).normalize();
                    let off_m = ((place - a) - chord * (place - a).dot(chord)).length();
                    let pixel_m = place.length() * surface.view.pixel_rad() as f32;
                    // At the coarsest levels the middle of a chord is not where the vertical crosses it. Outside of the
                    // picture, neighbours are as coarse as they may be.
                    if seen.sees_sphere(vertex.position_planet_m(), 0.0) {
                        met.off_px = met.off_px.max(off_m / pixel_m);
                    }
                    continue;
                }
                let (other, times) = drawn.entry(key(vertex)).or_insert((bits(place), 0));
                if *other != bits(place) {
                    return Err(format!(
                        "{:?} {side:?} {n}: {place} and {}",
                        tile.id,
                        Vec3::from_array(other.map(f32::from_bits))
                    ));
                }
                *times += 1;
                met.shared += usize::from(*times > 1);
            }
        }
    }
    // A mesh without gaps: every vertex on an edge is known on its other side.
    match drawn.values().filter(|(_, times)| *times < 2).count() {
        0 => Ok(met),
        alone => Err(format!("{alone} vertices on edges are not known on the other side")),
    }
}

#[test]
fn what_a_coarser_choice_leaves_out_has_not_come_out() {
    // Tiles made for a nearer eye, seen from where fewer would do: the finer ones lie on the triangles of the coarser
    // ones.
    let planet = Arc::new(rough());
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let place = LatLon::from_degrees(20.0, 45.0);
    let view = |altitude_m: f64| {
        let radius_m = planet.radius_m() + terrain.height_m(place.direction()) + altitude_m;
        let camera = Camera::over(place, radius_m, 0.4, -1.2, Camera::DEFAULT_FOV_Y_RAD);
        View { camera, size_px: [320, 200], quality: Quality::Medium }
    };
    let (coarse, fine) = (build_now(&planet, &view(5000.0)).unwrap(), build_now(&planet, &view(2000.0)).unwrap());
    let eye = coarse.view.camera.position_planet_m;
    let seen = Culling::new(&coarse.view, lowest_radius_m(&terrain));
    let shown: HashMap<_, _> = coarse.leaves.iter().map(|leaf| (leaf.tile.id, leaf)).collect();
    let (mut compared, mut moved) = (0, 0.0_f32);
    for leaf in &fine.leaves {
        // Tiles whose parent is drawn from afar.
        let Some(parent) = leaf.tile.id.parent().and_then(|id| shown.get(&id)) else { continue };
        if !seen.sees(&parent.tile) {
            continue;
        }
        let shifts_m = shifts_m(&leaf.tile, leaf.finer_edges, eye, &coarse.ranges);
        for chord in chords(false).iter().filter(|chord| chord.stride == 1) {
            let [v, a, b] = [chord.vertex, chord.younger, chord.elder].map(usize::from);
            let deviation_m = leaf.tile.vertices[v].deviation_m;
            let expected_m = 0.5 * (shifts_m[a] + shifts_m[b]) - deviation_m;
            assert_eq!(shifts_m[v].to_bits(), expected_m.to_bits(), "{:?} {v}", leaf.tile.id);
            compared += 1;
            moved = moved.max(deviation_m.abs());
        }
    }
    assert!(compared > 2000 && moved > 0.1, "{compared} {moved}");
}

#[test]
fn nothing_is_culled_that_a_ray_hits() {
    assert!(cast_rays(20, 10) > 300);
}

#[test]
#[ignore = "long: minutes"]
fn nothing_is_culled_that_any_of_many_rays_hits() {
    assert!(cast_rays(100, 1) > 1000);
}

/// Casts rays at shipped planets and so many random ones; the number of those that hit the ground.
fn cast_rays(randoms: u64, fewer: usize) -> usize {
    let mut dice = Dice(7);
    let mut hits = 0;
    // One grid of rivers is enough: four take seconds to solve.
    let coarse = |mut planet: Planet| {
        planet.structure.iter_mut().for_each(|structure| structure.grids = 1);
        planet
    };
    let randoms = (0..randoms).map(|seed| (coarse(random::random(seed)), 5));
    // Rays among rivers take longer.
    let poses = |planet: &Planet| if planet.structure.is_some() { 10 / fewer.min(5) } else { 120 / fewer };
    let shipped = shipped::ALL.iter().map(|shipped| coarse(shipped.load().unwrap()));
    let planets = shipped.map(|planet| (planet.clone(), poses(&planet))).chain(randoms);
    for (planet, poses) in planets {
        let planet = Arc::new(Planet { water: None, ..planet });
        // Tiles of many sizes.
        let surface = build_now(&planet, &opening::opening_view(&planet, [320, 200], Quality::Low)).unwrap();
        let terrain = &surface.terrain;
        for _ in 0..poses {
            let view = any_view(&mut dice, terrain, [96, 64]);
            let culling = Culling::new(&view, lowest_radius_m(terrain));
            for _ in 0..3 {
                let (x, y) = (dice.roll() * 2.0 - 1.0, dice.roll() * 2.0 - 1.0);
                let dir = view.camera.ray_dir_planet(x, y, view.aspect());
                let eye = view.camera.position_planet_m;
                let Some(away_m) = terrain.raycast(eye, dir) else { continue };
                let hit = (eye + dir * away_m).normalize();
                let holds = |leaf: &&tellus::tiles::Leaf| {
                    tellus::sphere::NodeId::containing(hit, leaf.tile.id.level) == leaf.tile.id
                };
                let leaf = surface.leaves.iter().find(holds).unwrap();
                assert!(culling.sees(&leaf.tile), "{}: {:?} is hit at {hit}", planet.name, leaf.tile.id);
                hits += 1;
            }
        }
    }
    hits
}

/// The shifts in exact arithmetic.
fn exact_shifts_m(tile: &Tile, surface: &Surface, eye: DVec3) -> Vec<f64> {
    let ranges = &surface.ranges;
    let mut shifts_m = vec![0.0_f64; tile.vertices.len()];
    for chord in chords(false).iter().filter(|chord| chord.stride <= COARSEST_MORPHING) {
        let vertex = &tile.vertices[usize::from(chord.vertex)];
        let level = tile.id.level - (chord.stride.ilog2() as u8).min(tile.id.level);
        let begin_m = ranges.begin_m(level, f64::from(vertex.foreseen_m));
        let away_m = vertex.position_planet_m().distance(eye);
        let share = ((begin_m - away_m) / (begin_m * (1.0 - FULL_AT))).clamp(0.0, 1.0);
        let ends_m = shifts_m[usize::from(chord.younger)] + shifts_m[usize::from(chord.elder)];
        shifts_m[usize::from(chord.vertex)] = 0.5 * ends_m - (1.0 - share) * f64::from(vertex.deviation_m);
    }
    shifts_m
}

#[test]
fn steps_of_a_millimetre_move_every_vertex_as_they_should() {
    let mut planet = rough();
    planet.radius_km = 6371.0;
    let planet = Arc::new(planet);
    let corner = DVec3::ONE.normalize();
    let place = LatLon::from_degrees(corner.z.asin().to_degrees(), 45.0);
    let ground_m = planet.radius_m() + Terrain::try_new(planet.clone()).unwrap().height_m(place.direction());
    let at = |east_m: f64| {
        let mut camera = Camera::over(place, ground_m + 1.7, 0.3, -0.3, Camera::DEFAULT_FOV_Y_RAD);
        camera.position_planet_m += DVec3::new(-1.0, 1.0, 0.0).normalize() * east_m;
        View { camera, size_px: [1280, 720], quality: Quality::Low }
    };
    let surface = build_now(&planet, &at(0.0)).unwrap();
    let tan_y = (at(0.0).camera.fov_y_rad * 0.5).tan();
    let (mut worst_px, mut tested) = (0.0_f64, 0);
    for step in 0..12 {
        let view = at(f64::from(step) * 1e-3);
        let eye = view.camera.position_planet_m;
        let culling = Culling::new(&view, lowest_radius_m(&surface.terrain));
        let turn = view.camera.planet_from_view.inverse();
        let clip_from_view = Mat4::from_cols_array_2d(&[
            [(1.0 / (tan_y * view.aspect())) as f32, 0.0, 0.0, 0.0],
            [0.0, (1.0 / tan_y) as f32, 0.0, 0.0],
            [0.0, 0.0, 0.0, -1.0],
            [0.0, 0.0, 0.05, 0.0],
        ]);
        let clip_from_rel = clip_from_view * Mat4::from_quat(turn.as_quat());
        for leaf in surface.leaves.iter().filter(|leaf| culling.sees(&leaf.tile)) {
            let drawn_m = shifts_m(&leaf.tile, leaf.finer_edges, eye, &surface.ranges);
            let exact_m = exact_shifts_m(&leaf.tile, &surface, eye);
            for (i, vertex) in leaf.tile.vertices.iter().enumerate() {
                let clip = clip_from_rel * drawn_rel_m(vertex, drawn_m[i], eye).extend(1.0);
                let position = vertex.position_planet_m();
                let exact = turn * (position + position.normalize() * exact_m[i] - eye);
                let exact = DVec3::new(exact.x / (tan_y * view.aspect()), exact.y / tan_y, -exact.z);
                // In the picture and beyond the near plane.
                if exact.z < 0.05 || exact.x.abs() > exact.z || exact.y.abs() > exact.z {
                    continue;
                }
                let [x, y] = [clip.x / clip.w, clip.y / clip.w].map(f64::from);
                let off = [(x - exact.x / exact.z) * 640.0, (y - exact.y / exact.z) * 360.0];
                worst_px = worst_px.max(off[0].hypot(off[1]));
                tested += 1;
            }
        }
    }
    assert!(tested > 50_000 && worst_px < 0.1, "{worst_px} px, {tested} vertices");
}

#[test]
fn a_view_never_shows_more_triangles_than_its_quality_allows() {
    let place = LatLon::from_degrees(35.0, -5.0);
    let window = [1280, 720];
    let planet = Arc::new(layered());
    let ground_m = Terrain::try_new(planet.clone())
        .unwrap()
        .height_m(place.direction())
        .max(planet.sea_level_m().unwrap_or(f64::MIN));
    for (quality, size_px, altitude_m) in
        [(Quality::High, window, 2.0), (Quality::Low, window, 2.0), (Quality::Medium, [3840, 2160], 2.0)]
    {
        let radius_m = planet.radius_m() + ground_m + altitude_m;
        let camera = Camera::over(place, radius_m, 0.4, -0.1, Camera::DEFAULT_FOV_Y_RAD);
        let view = View { camera, size_px, quality };
        let surface = build_now(&planet, &view).unwrap();
        let culling = Culling::new(&view, lowest_radius_m(&surface.terrain));
        let seen = surface.leaves.iter().filter(|leaf| culling.sees(&leaf.tile)).count();
        let (most, all) = (budget_tiles(quality, size_px), surface.leaves.len());
        let what = format!("{}, {quality:?} {size_px:?} from {altitude_m} m: {seen} of {all}", planet.name);
        assert!(seen <= most && seen > most / 2, "{what}, {most} are allowed");
        assert_meets(&surface);
    }
}

/// A detail texture holds its own level and its parent's. Ground farther than twice its range would need a coarser one,
/// and would change at once when the texture is chosen. In small pictures ranges are shortest.
#[test]
fn ground_is_within_reach_of_its_detail_texture() {
    let place = LatLon::from_degrees(35.0, -5.0);
    let planet = Arc::new(layered());
    let ground_m = planet.radius_m() + Terrain::try_new(planet.clone()).unwrap().height_m(place.direction());
    for altitude_m in [20.0, 120.0, 175.0, 210.0, 260.0, 3000.0] {
        let camera = Camera::over(place, ground_m + altitude_m, 0.5, -0.63, Camera::DEFAULT_FOV_Y_RAD);
        let surface = build_now(&planet, &View { camera, size_px: [480, 320], quality: Quality::Medium }).unwrap();
        assert!(surface.ranges.shaded_spacings < surface.ranges.least_spacings);
        for leaf in surface.leaves.iter().filter(|leaf| leaf.shading_tile.id.level > 0) {
            let away_m = |vertex: &Vertex| vertex.position_planet_m().distance(camera.position_planet_m);
            let farthest_m = leaf.tile.vertices.iter().map(away_m).fold(0.0, f64::max);
            let level = leaf.shading_tile.id.level;
            let reach_m = 2.0 * surface.ranges.shaded_m(level);
            assert!(farthest_m <= reach_m, "{altitude_m} m: {farthest_m} m away, level {level} reaches {reach_m} m");
        }
    }
}

#[test]
fn ground_that_runs_out_of_time_is_coarser_and_without_gaps() {
    let planet = Arc::new(rough());
    let terrain = Arc::new(Terrain::try_new(planet).unwrap());
    let place = LatLon::from_degrees(12.0, 40.0);
    let eye_m = terrain.planet().radius_m() + terrain.height_m(place.direction()) + 100.0;
    let camera = Camera::over(place, eye_m, 0.4, -0.1, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [160, 90], quality: Quality::Low };
    let whole = build_over(&terrain, &view);
    let ids = |surface: &Surface| -> Vec<_> { surface.leaves.iter().map(|leaf| leaf.tile.id).collect() };
    // Shares of the sphere, in faces of the cube.
    let covered =
        |surface: &Surface| surface.leaves.iter().map(|l| 0.25_f64.powi(i32::from(l.tile.id.level))).sum::<f64>();
    for secs in [0.0, 0.02, 3600.0] {
        let limits = Limits { until: Some(Instant::now() + Duration::from_secs_f64(secs)), bytes: None };
        let mut surface = build_within(&terrain, &view, &limits);
        meet(&surface).unwrap();
        assert_eq!(covered(&surface), 6.0);
        assert!(surface.leaves.len() <= whole.leaves.len());
        let has_detail = add_detail_within(&mut surface, &view, &limits);
        match secs {
            0.0 => assert!(!surface.complete && !has_detail && surface.leaves.len() < 100, "{}", surface.leaves.len()),
            3600.0 => assert!(surface.complete && has_detail && ids(&surface) == ids(&whole)),
            _ => {}
        }
    }
}

#[test]
fn ground_that_runs_out_of_memory_is_coarser_and_without_gaps() {
    let terrain = Arc::new(Terrain::try_new(Arc::new(rough())).unwrap());
    let place = LatLon::from_degrees(12.0, 40.0);
    let eye_m = terrain.planet().radius_m() + terrain.height_m(place.direction()) + 2.0;
    let camera = Camera::over(place, eye_m, 0.4, -0.1, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [1280, 720], quality: Quality::High };
    let mut tiles_before = 0;
    for mib in [16, 64, 256] {
        let limits = Limits { until: None, bytes: Some(mib << 20) };
        let mut surface = build_within(&terrain, &view, &limits);
        assert!(add_detail_within(&mut surface, &view, &limits) && surface.complete);
        meet(&surface).unwrap();
        let details: HashMap<_, _> = surface
            .leaves
            .iter()
            .filter_map(|leaf| leaf.detail.as_ref())
            .map(|detail| (detail.id, detail.bytes()))
            .collect();
        let tiles: usize = surface.leaves.iter().map(|leaf| size_of_val(&*leaf.tile.vertices)).sum();
        let bytes = tiles + details.values().sum::<usize>();
        assert!(bytes < mib << 20 && bytes > mib << 18, "{bytes} bytes in {mib} MiB");
        assert!(surface.leaves.len() > 2 * tiles_before, "{mib} MiB: {} tiles", surface.leaves.len());
        tiles_before = surface.leaves.len();
    }
}

/// Walls everywhere: even the greatest LOD bias asks for more tiles than the budget has.
#[test]
fn ground_rugged_beyond_measure_stays_within_the_budget() {
    let shape = Shape::Fbm(Fbm { wavelength_km: 2.0, octaves: 18, gain: 0.9, ..Fbm::default() });
    let layers = vec![Layer { amplitude_m: 100_000.0, shape, ..Layer::default() }];
    let planet = Arc::new(Planet { radius_km: 50.0, layers, water: None, ..Planet::default() });
    let place = LatLon::from_degrees(12.0, 40.0);
    let ground_m = Terrain::try_new(planet.clone()).unwrap().height_m(place.direction());
    let camera = Camera::over(place, planet.radius_m() + ground_m + 100.0, 0.4, -0.1, Camera::DEFAULT_FOV_Y_RAD);
    // Pixels set the limit in so small a picture, whatever the quality.
    for quality in [Quality::Low, Quality::High] {
        let view = View { camera, size_px: [160, 90], quality };
        let surface = build_now(&planet, &view).unwrap();
        let lowest_radius_m = lowest_radius_m(&surface.terrain);
        let culling = Culling::new(&view, lowest_radius_m);
        let seen = surface.leaves.iter().filter(|leaf| culling.sees(&leaf.tile)).count();
        let most = budget_tiles(quality, view.size_px);
        assert!(seen <= most && seen > most / 2, "{seen} of {most}");
        let selection = Selection::new(&view, &surface.ranges, lowest_radius_m, None);
        assert!(surface.leaves.iter().any(|leaf| selection.wants_split(&leaf.tile)), "the budget was not the limit");
        // The ground before the eye is not what is left over.
        let finest = surface.leaves.iter().map(|leaf| leaf.tile.id.level).max();
        assert!(finest >= Some(8), "{finest:?}");
        assert_eq!(most, 300);
    }
}
