//! The evaluator and the tiles: exactness, determinism, seams, incremental rebuilds.

use crate::support::dice::directions;
use crate::support::layered::layered;
use glam::DVec3;
use proptest::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use tellus::lod::tile::TILE_SIDE;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{
    Atmosphere, Blend, Craters, Fbm, Layer, LayerMask, Mask, Planet, Precision, Ridged, Shape, SlopeMask, Structure,
    Water,
};
use tellus::simd::Simd;
use tellus::sphere::{Edge, Face, LatLon, NodeId};
use tellus::terrain::{RayLimits, Scratch, Terrain, Wanted};
use tellus::tiles::{Builder, Surface, build_now, build_over};

/// A mask by the noise of another layer.
fn mask(layer: &str, from: f64, to: f64) -> Mask {
    Mask::Layer(LayerMask { layer: layer.to_owned(), from, to, invert: false })
}

/// A planet of version 1, with the landforms, blends and masks of that version.
fn planet() -> Planet {
    let fbm = |wavelength_km, octaves| Shape::Fbm(Fbm { wavelength_km, octaves, gain: 0.5, lacunarity: 2.0 });
    let ridged = Shape::Ridged(Ridged { wavelength_km: 700.0, octaves: 14, ..Ridged::default() });
    let layer = |name: &str, shape, amplitude_m, blend| Layer {
        name: name.to_owned(),
        shape,
        amplitude_m,
        blend,
        ..Layer::default()
    };
    let mountains =
        Layer { masks: vec![mask("continents", 0.0, 0.3)], seed: 5, ..layer("mountains", ridged, 5000.0, Blend::Add) };
    Planet {
        // The precision of presets of versions 1 and 2.
        precision: Precision::Classic,
        layers: vec![
            layer("continents", fbm(5000.0, 12), 3000.0, Blend::Add),
            mountains,
            Layer { bias: 1.0, ..layer("scale", fbm(900.0, 4), 1.0, Blend::Multiply) },
            layer("floor", fbm(2000.0, 3), 800.0, Blend::Max),
            Layer { enabled: false, ..layer("off", fbm(100.0, 3), 800.0, Blend::Replace) },
            layer("craters", Shape::Craters(first_craters()), 3000.0, Blend::Add),
            layer("dust", fbm(30.0, 10), 60.0, Blend::Subtract),
        ],
        water: Some(Water::default()),
        atmosphere: Some(Atmosphere::default()),
        ..Planet::default()
    }
}

/// Craters of version 1.
fn first_craters() -> Craters {
    Craters { power: 0.0, floor: 0.0, peak: 0.0, age: 0.0, fresh: 0.0, ..Craters::default() }
}

fn view(altitude_m: f64, pitch_deg: f64) -> View {
    let place = LatLon::from_degrees(20.0, 30.0);
    let camera = Camera::over(place, 6_371_000.0 + altitude_m, 0.3, pitch_deg.to_radians(), Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px: [640, 400], quality: Quality::Low }
}

/// FNV-1a over the bits of the heights.
fn hash(heights_m: &[f64]) -> u64 {
    heights_m
        .iter()
        .flat_map(|h| h.to_bits().to_le_bytes())
        .fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3))
}

#[test]
fn heights_have_the_same_bits_on_every_instruction_set_and_for_ever() {
    let terrain = Terrain::try_new(Arc::new(planet())).unwrap();
    let dirs = directions(1, 5000);
    for simd in Simd::available() {
        let heights = terrain.clone().with_simd(simd).heights_m(&dirs);
        assert_eq!(
            hash(&heights),
            614_443_386_410_508_539,
            "{}: presets of version 1 keep their exact heights",
            simd.name()
        );
    }
}

#[test]
fn one_point_and_a_batch_agree_to_the_bit() {
    let terrain = Terrain::try_new(Arc::new(planet())).unwrap();
    let dirs = directions(1, 700);
    let batch = terrain.heights_m(&dirs);
    for (dir, height_m) in dirs.iter().zip(&batch) {
        assert_eq!(terrain.height_m(*dir).to_bits(), height_m.to_bits());
        assert_eq!(terrain.sample(*dir).height_m.to_bits(), height_m.to_bits());
    }
    let (lo, hi) = terrain.height_bounds_m();
    assert!(batch.iter().all(|h| (lo..=hi).contains(h)));
}

/// Whatever is asked for, alone or in a batch, in fresh or used memory, the answers are the same.
#[test]
fn all_queries_of_a_point_agree() {
    let terrain = Terrain::try_new(Arc::new(layered())).unwrap();
    let dirs = directions(1, 700);
    let samples = terrain.samples(&dirs, Wanted::ALL);
    let (mut heights_m, mut scratch) = (vec![0.0; dirs.len()], Scratch::default());
    terrain.heights_into(&dirs, &mut heights_m, &mut scratch).unwrap();
    let alone = |wanted| terrain.samples(&dirs, wanted);
    let (normals, climates) = (alone(Wanted::HEIGHT.and_normal()), alone(Wanted::HEIGHT.and_climate()));
    let biomes = alone(Wanted::HEIGHT.and_biome().and_water());
    let (banks, curved) = (alone(Wanted::HEIGHT.and_biome().and_bank()), alone(Wanted::HEIGHT.and_curvature()));
    for (i, (dir, sample)) in dirs.iter().zip(&samples).enumerate() {
        assert_eq!(terrain.sample(*dir), *sample);
        assert_eq!(curved[i].curvature.to_bits(), sample.curvature.to_bits());
        let mut level = *sample;
        level.curvature = 0.0;
        assert_eq!(banks[i], level);
        (level.bank_m, level.bank_by_height) = (None, false);
        assert_eq!(biomes[i], level);
        for height_m in [terrain.height_m(*dir), heights_m[i], normals[i].height_m, climates[i].height_m] {
            assert_eq!(height_m.to_bits(), sample.height_m.to_bits());
        }
        assert_eq!((normals[i].normal_planet, normals[i].temperature_c), (sample.normal_planet, 0.0));
        assert_eq!((climates[i].temperature_c, climates[i].slope_rad), (sample.temperature_c, 0.0));
        let layers_m: f64 = terrain.layers_m(*dir).iter().sum();
        assert!((layers_m - sample.height_m).abs() < 1.0, "biome relief alone is in no layer: {layers_m}");
    }
    // None at all.
    terrain.heights_into(&[], &mut [], &mut scratch).unwrap();
}

#[test]
fn normals_match_central_differences() {
    // Smooth enough for a difference over 2 m.
    let mut planet = planet();
    for layer in &mut planet.layers {
        if let Shape::Fbm(Fbm { octaves, .. }) | Shape::Ridged(Ridged { octaves, .. }) = &mut layer.shape {
            *octaves = (*octaves).min(5);
        }
    }
    let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
    let radius_m = terrain.planet().radius_m();
    let mut worst = 0.0_f64;
    for dir in directions(1, 500) {
        let sample = terrain.sample(dir);
        let (a, b) = dir.any_orthonormal_pair();
        let step = 2.0 / radius_m;
        let at = |d: DVec3| d.normalize() * (radius_m + terrain.height_m(d));
        let u = at(dir + a * step) - at(dir - a * step);
        let v = at(dir + b * step) - at(dir - b * step);
        worst = worst.max(u.cross(v).normalize().angle_between(sample.normal_planet));
    }
    assert!(worst < 0.01, "{worst} rad");
}

#[test]
fn what_is_drawn_is_what_is_asked_for() {
    let surface = build_now(&Arc::new(planet()), &view(200_000.0, -50.0)).unwrap();
    for leaf in surface.leaves.iter().step_by(7) {
        let id = leaf.tile.id;
        for (i, vertex) in leaf.tile.vertices.iter().enumerate().step_by(37) {
            let dir = id.direction((i % TILE_SIDE) as f64 / 32.0, (i / TILE_SIDE) as f64 / 32.0);
            assert_eq!(vertex.height_m, surface.terrain.height_m(dir) as f32);
        }
    }
}

/// Bits of a vertex's position.
fn position(surface: &Surface, leaf: usize, x: usize, y: usize) -> [u32; 6] {
    let v = &surface.leaves[leaf].tile.vertices[y * TILE_SIDE + x];
    let mut bits = [0; 6];
    for axis in 0..3 {
        bits[axis] = (v.position_high_m[axis] + 0.0).to_bits();
        bits[axis + 3] = (v.position_low_m[axis] + 0.0).to_bits();
    }
    bits
}

#[test]
fn neighbouring_tiles_share_their_edges_to_the_bit_and_leave_no_gap() {
    edges_meet(planet());
}

/// Tiles of different levels show different levels of rivers: their edges are sewn.
#[test]
fn tiles_among_rivers_share_their_edges_to_the_bit() {
    edges_meet(Planet { structure: Some(Structure { grids: 1, ..Structure::default() }), ..planet() });
}

fn edges_meet(planet: Planet) {
    let terrain = Arc::new(Terrain::try_new(Arc::new(planet)).unwrap());
    for (altitude_m, pitch_deg) in [(20_000_000.0, -90.0), (300_000.0, -50.0), (30_000.0, -30.0), (2.0, 0.0)] {
        let surface = build_over(&terrain, &view(altitude_m, pitch_deg));
        // Wherever corners meet they are one point.
        let mut corners: HashMap<[i64; 3], [u32; 6]> = HashMap::new();
        for (index, leaf) in surface.leaves.iter().enumerate() {
            for (x, y) in [(0, 0), (TILE_SIDE - 1, 0), (0, TILE_SIDE - 1), (TILE_SIDE - 1, TILE_SIDE - 1)] {
                let dir = leaf.tile.vertices[y * TILE_SIDE + x].position_planet_m().normalize();
                let place = (dir * 1e9).to_array().map(|w| w.round() as i64);
                let here = position(&surface, index, x, y);
                assert_eq!(*corners.entry(place).or_insert(here), here, "{:?} {x} {y}", leaf.tile.id);
            }
        }
        let level_of: HashMap<NodeId, usize> = surface.leaves.iter().enumerate().map(|(i, l)| (l.tile.id, i)).collect();
        // The leaves cover the sphere exactly once.
        let area: f64 = surface.leaves.iter().map(|l| 0.25_f64.powi(i32::from(l.tile.id.level))).sum();
        assert_eq!(area, 6.0);
        for (index, leaf) in surface.leaves.iter().enumerate() {
            let id = leaf.tile.id;
            for edge in Edge::ALL {
                let across = id.neighbour(edge);
                let coarser = leaf.coarser_edges & edge.bit() != 0;
                let rim: Vec<[u32; 6]> = (0..TILE_SIDE)
                    .step_by(if coarser { 2 } else { 1 })
                    .map(|i| match edge {
                        Edge::Left => position(&surface, index, 0, i),
                        Edge::Right => position(&surface, index, TILE_SIDE - 1, i),
                        Edge::Bottom => position(&surface, index, i, 0),
                        Edge::Top => position(&surface, index, i, TILE_SIDE - 1),
                    })
                    .collect();
                let other = if coarser { across.parent().unwrap() } else { across };
                if let Some(&other) = level_of.get(&other) {
                    let theirs: Vec<[u32; 6]> = (0..TILE_SIDE * TILE_SIDE)
                        .map(|i| position(&surface, other, i % TILE_SIDE, i / TILE_SIDE))
                        .collect();
                    assert!(rim.iter().all(|p| theirs.contains(p)), "{id:?} {edge:?}");
                } else {
                    // The neighbour is finer and stitches the edge; it must be exactly one level finer.
                    assert!(!coarser && across.children().iter().any(|c| level_of.contains_key(c)), "{id:?} {edge:?}");
                }
            }
        }
    }
}

#[test]
fn the_same_planet_seen_from_many_places_is_one_planet() {
    let terrain = Terrain::try_new(Arc::new(planet())).unwrap();
    for face in Face::ALL {
        for level in [0, 3, 9, 17] {
            let id = NodeId { level, face, x: (1 << level) / 3, y: 0 };
            let child = id.children()[1];
            assert_eq!(
                terrain.height_m(id.direction(0.75, 0.25)).to_bits(),
                terrain.height_m(child.direction(0.5, 0.5)).to_bits()
            );
        }
    }
}

#[test]
fn a_ray_meets_the_ground_where_the_ground_is() {
    let terrain = Terrain::try_new(Arc::new(planet())).unwrap();
    let radius_m = terrain.planet().radius_m();
    for dir in directions(1, 60) {
        let surface_m = radius_m + terrain.height_m(dir).max(0.0);
        let hit = terrain.raycast(dir * (surface_m + 5000.0), -dir).unwrap();
        assert!((hit - 5000.0).abs() < 0.01, "{hit}");
        assert_eq!(terrain.raycast(dir * (radius_m + 50_000.0), dir), None);
    }
}

#[test]
fn a_ray_keeps_its_limits_and_passes_the_sea_if_it_is_told_to() {
    let terrain = Terrain::try_new(Arc::new(planet())).unwrap();
    let (radius_m, sea_m) = (terrain.planet().radius_m(), terrain.planet().sea_level_m().unwrap());
    let (mut scratch, mut wet) = (Scratch::default(), 0);
    for dir in directions(1, 60) {
        let ground_m = terrain.height_m(dir);
        let eye_m = dir * (radius_m + ground_m.max(sea_m) + 5000.0);
        let mut cast = |limits: RayLimits| terrain.raycast_within(eye_m, -dir, &limits, &mut scratch);
        let limits = RayLimits::default;
        assert_eq!(cast(limits()), terrain.raycast(eye_m, -dir));
        assert_eq!(cast(limits().to_m(4999.0)), None);
        assert!(cast(limits().to_m(5001.0)).is_some());
        // A ray that begins below the surface meets it there.
        assert_eq!(cast(limits().from_m(6000.0).to_m(7000.0)), Some(6000.0));
        for wrong in [limits().from_m(2.0).to_m(1.0), limits().from_m(f64::NAN), limits().to_m(f64::NAN)] {
            assert_eq!(cast(wrong), None, "{wrong:?}");
        }
        let bed_m = cast(limits().through_sea()).unwrap();
        assert!((bed_m - (eye_m.length() - radius_m - ground_m)).abs() < 0.01, "{bed_m}");
        wet += usize::from(ground_m < sea_m);
    }
    assert!(wet > 10, "{wet}");
}

/// The surface once the builder has finished every request.
fn settled(builder: &Builder) -> Arc<Surface> {
    loop {
        if builder.has_all_tiles() {
            return builder.surface().unwrap();
        }
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
}

fn bits(surface: &Surface) -> Vec<(NodeId, u8, Vec<tellus::lod::Vertex>)> {
    surface.leaves.iter().map(|leaf| (leaf.tile.id, leaf.coarser_edges, leaf.tile.vertices.clone())).collect()
}

/// One of a few edits, each of another stage.
fn edit(planet: &mut Planet, which: usize, amount: f64) {
    match which {
        0 => planet.layers[0].amplitude_m = 1000.0 + 4000.0 * amount,
        1 => planet.layers[1].seed = (amount * 9.0) as u32,
        2 => planet.layers.swap(0, 2),
        3 => planet.layers[3].enabled = !planet.layers[3].enabled,
        4 => planet.climate.moisture = amount,
        5 => planet.climate.octaves = 1 + (amount * 5.0) as u32,
        6 => planet.water.as_mut().unwrap().level_m = amount * 500.0,
        7 => planet.water.as_mut().unwrap().color = [amount; 3],
        8 => {
            let slope = SlopeMask { over_m: 1000.0 + 9000.0 * amount, ..SlopeMask::default() };
            planet.layers[2].masks.insert(0, Mask::Slope(slope));
        }
        9 => planet.layers[2].masks.clear(),
        10 => planet.layers[1].masks[0] = mask("continents", amount - 0.9, 0.3),
        _ => {
            planet.layers.remove(planet.layers.len() - 1);
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(6))]
    #[test]
    fn any_sequence_of_edits_ends_in_what_a_rebuild_from_nothing_gives(
        edits in prop::collection::vec((0_usize..12, 0.0..1.0_f64, prop::bool::ANY), 1..6),
    ) {
        let builder = Builder::new(|| {});
        let mut planet = planet();
        let view = view(3_000_000.0, -80.0);
        builder.request(&Arc::new(planet.clone()), &view).unwrap();
        for (which, amount, wait) in edits {
            edit(&mut planet, which, amount);
            builder.request(&Arc::new(planet.clone()), &view).unwrap();
            if wait {
                settled(&builder);
            }
        }
        let planet = Arc::new(planet);
        builder.request(&planet, &view).unwrap();
        prop_assert!(bits(&settled(&builder)) == bits(&build_now(&planet, &view).unwrap()));
    }
}

#[test]
fn edits_rebuild_no_more_than_they_must() {
    let builder = Builder::new(|| {});
    let mut planet = planet();
    let view = view(3_000_000.0, -80.0);
    let ask = |planet: &Planet| {
        builder.request(&Arc::new(planet.clone()), &view).unwrap();
        settled(&builder).stats
    };
    assert!(ask(&planet).octave_samples > 0);
    for (which, tiles, octaves) in
        [(7, false, false), (0, true, false), (10, true, false), (4, true, false), (1, true, true)]
    {
        edit(&mut planet, which, 0.37);
        let stats = ask(&planet);
        assert_eq!((stats.tiles_built > 0, stats.octave_samples > 0), (tiles, octaves), "edit {which}");
    }
}

#[test]
fn a_mask_by_slope_asks_only_the_layers_below_it() {
    let builder = Builder::new(|| {});
    let mut planet = planet();
    let view = view(3_000_000.0, -80.0);
    let octaves_a_tile = |planet: &Planet| {
        builder.request(&Arc::new(planet.clone()), &view).unwrap();
        let stats = settled(&builder).stats;
        stats.octave_samples as f64 / (stats.tiles_built * TILE_SIDE * TILE_SIDE) as f64
    };
    octaves_a_tile(&planet);
    // On the third layer: continents have 12 octaves, mountains 14.
    edit(&mut planet, 8, 0.2);
    assert_eq!(octaves_a_tile(&planet), 26.0);
    // Fields that exist already serve fewer layers.
    edit(&mut planet, 9, 0.0);
    assert_eq!(octaves_a_tile(&planet), 0.0);
    edit(&mut planet, 8, 0.2);
    assert_eq!(octaves_a_tile(&planet), 0.0);
}

#[test]
fn no_valid_planet_is_turned_inside_out() {
    for (radius_km, amplitude_m) in [(1.0, 100_000.0), (1.0, 900.0), (100_000.0, 100_000.0)] {
        let mut planet = Planet { radius_km, ..planet() };
        planet.layers[0].amplitude_m = amplitude_m;
        for i in 0..40 {
            let name = format!("times {i}");
            planet.layers.push(Layer { name, bias: 2.0, blend: Blend::Multiply, ..Layer::default() });
        }
        assert!(tellus::planet::validate::problems(&planet).is_empty());
        let planet = Arc::new(planet);
        let camera = Camera { position_planet_m: DVec3::X * planet.radius_m() * 14.0, ..view(1.0, -90.0).camera };
        let surface = build_now(&planet, &View { camera, ..view(1.0, 0.0) }).unwrap();
        for vertex in surface.leaves.iter().flat_map(|leaf| &leaf.tile.vertices) {
            let position = vertex.position_planet_m();
            assert!(position.is_finite() && position.length() > 0.05 * planet.radius_m());
            assert!(vertex.height_m.is_finite() && vertex.temperature_c.is_finite());
        }
        let sample = surface.terrain.sample(DVec3::new(0.3, -0.2, 0.9));
        assert!(sample.normal_planet.is_finite() && (sample.normal_planet.length() - 1.0).abs() < 1e-9);
    }
}

#[test]
fn a_mask_follows_its_name_to_another_layer() {
    let builder = Builder::new(|| {});
    let view = view(3_000_000.0, -80.0);
    let mut planet = planet();
    builder.request(&Arc::new(planet.clone()), &view).unwrap();
    settled(&builder);
    // Only names change, but the mask on "mountains" now names another layer.
    let name = std::mem::replace(&mut planet.layers[0].name, "floor".to_owned());
    planet.layers[3].name = name;
    let planet = Arc::new(planet);
    builder.request(&planet, &view).unwrap();
    assert!(bits(&settled(&builder)) == bits(&build_now(&planet, &view).unwrap()));
}

/// A planet whose moisture depends on the distance to the coast.
fn moist() -> Planet {
    let mut planet = planet();
    planet.climate.sea_moisture = 0.5;
    planet.climate.sea_reach_km = 2000.0;
    planet
}

#[test]
fn the_sea_makes_its_shores_moister_than_the_inland() {
    let with = Terrain::try_new(Arc::new(moist())).unwrap();
    let without = Terrain::try_new(Arc::new(planet())).unwrap();
    let again = Terrain::try_new(Arc::new(moist())).unwrap();
    let (mut shore, mut inland) = (Vec::new(), Vec::new());
    for dir in directions(1, 4000) {
        let (a, b) = (with.sample(dir), without.sample(dir));
        assert_eq!(a.moisture.to_bits(), again.sample(dir).moisture.to_bits());
        assert_eq!((a.height_m, a.temperature_c), (b.height_m, b.temperature_c));
        assert!((a.precipitation_mm - a.moisture * 3000.0).abs() < 1e-9 && (0.0..=1.0).contains(&a.temperature));
        let gained = a.moisture - b.moisture;
        assert!((0.0..=0.5 + 1e-12).contains(&gained));
        if b.moisture < 0.5 && b.moisture > 0.0 {
            // Ground well below sea level lies in the sea.
            if a.height_m < -200.0 {
                shore.push(gained);
            } else if a.height_m > 1500.0 {
                inland.push(gained);
            }
        }
    }
    let mean = |gains: &[f64]| gains.iter().sum::<f64>() / gains.len() as f64;
    assert!(shore.len() > 50 && inland.len() > 50, "{} {}", shore.len(), inland.len());
    assert!(mean(&shore) > 0.48 && mean(&inland) < 0.42, "{} {}", mean(&shore), mean(&inland));
}

#[test]
fn a_tile_far_from_an_edit_learns_of_a_new_shore() {
    let builder = Builder::new(|| {});
    let view = view(3_000_000.0, -80.0);
    let mut planet = moist();
    builder.request(&Arc::new(planet.clone()), &view).unwrap();
    settled(&builder);
    for step in 0..4 {
        match step {
            0 => planet.layers[0].bias = 0.2,
            1 => planet.water.as_mut().unwrap().level_m = 700.0,
            2 => planet.climate.sea_reach_km = 300.0,
            _ => planet.water = None,
        }
        let planet = Arc::new(planet.clone());
        builder.request(&planet, &view).unwrap();
        assert!(bits(&settled(&builder)) == bits(&build_now(&planet, &view).unwrap()), "step {step}");
    }
}
