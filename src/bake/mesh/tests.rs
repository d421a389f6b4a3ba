//! Meshes of a small planet: their vertices, borders, triangles, skirts, water and textures.

use super::tileset;
use super::*;
use crate::planet::Planet;
use crate::sphere::{LatLon, NodeId};
use glam::{DVec3, Vec3};
use std::collections::{HashMap, HashSet};

const PLANET: &str = r#"(
    version: 3,
    name: "Islet",
    radius_km: 40.0,
    layers: [(name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 12.0, octaves: 4))],
    water: (level_m: -50.0),
)"#;

const REGION: Area = Area::Region(Region { lat_deg: 20.0, lon_deg: -40.0, side_km: 8.0 });

pub(super) fn terrain() -> Terrain {
    Terrain::try_new(Planet::from_text("islet.ron", PLANET).unwrap().into()).unwrap()
}

fn mesh(area: Area, cells: u32) -> MeshBake {
    MeshBake::new(area, cells, MeshFormat::Glb)
}

fn surface<'a>(mesh: &MeshBake, terrain: &'a Terrain, canopies: &'a Canopies) -> Surface<'a> {
    Surface { terrain, water: mesh.water, detail: mesh.detail, canopies }
}

fn patches(mesh: &MeshBake) -> Vec<(Square, Patch)> {
    let (terrain, canopies) = (terrain(), Canopies::default());
    let surface = surface(mesh, &terrain, &canopies);
    let progress = Progress::new(1, &|_| true);
    let squares = Square::all(&mesh.area, terrain.planet().radius_m());
    let patch = |square| {
        let patch = Patch::new(&square, mesh.cells, &surface, &progress);
        (square, patch)
    };
    squares.into_iter().map(patch).collect()
}

fn patch(mesh: &MeshBake) -> (Square, Patch) {
    patches(mesh).swap_remove(0)
}

#[test]
fn vertices_lie_where_the_evaluator_puts_them() {
    let terrain = terrain();
    for area in [Area::Globe, REGION] {
        for water in MeshWater::ALL {
            let mesh = MeshBake { water, ..mesh(area, 12) };
            let mut wet = 0;
            for (square, patch) in patches(&mesh) {
                for (i, vertex) in patch.vertices.iter().enumerate() {
                    let (row, column) = (i / patch.side, i % patch.side);
                    let dir =
                        square.direction(NodeId::side_share(column as u32, 12), NodeId::side_share(row as u32, 12));
                    let sample = terrain.sample(dir);
                    let level_m = sample.water_level_m.filter(|level_m| *level_m > sample.height_m);
                    wet += usize::from(level_m.is_some());
                    let height_m = match water {
                        MeshWater::Surface => level_m.unwrap_or(sample.height_m),
                        _ => sample.height_m,
                    };
                    assert!((vertex.position_m.distance(patch.center_m) - 40_000.0 - height_m).abs() < 1e-6);
                    let apart = vertex.water_radius_m().map(|radius_m| radius_m - 40_000.0);
                    match level_m.filter(|_| water == MeshWater::Apart) {
                        Some(level_m) => assert!(apart.is_some_and(|apart| (apart - level_m).abs() < 1e-6)),
                        None => assert_eq!(apart, None),
                    }
                    assert!((vertex.normal.length() - 1.0).abs() < 1e-5);
                    let tangent = patch.tangent(row, column).as_vec3();
                    assert!((tangent.length() - 1.0).abs() < 1e-5);
                    assert!(vertex.normal.dot(tangent).abs() < 1e-5);
                }
            }
            assert!(wet > 10, "{area:?}: {wet}");
        }
    }
}

#[test]
fn a_globe_has_no_gap_and_no_triangle_that_faces_inwards() {
    let mesh = MeshBake { levels: 3, ..mesh(Area::Globe, 12) };
    for stride in [1, 2, 4] {
        // Each edge of the surface, between positions as they are in the file, is run through once in each direction.
        let mut edges: HashMap<[[u32; 3]; 2], i32> = HashMap::new();
        for (_, patch) in patches(&mesh) {
            let geometry = Geometry::new(&patch, stride, 0.0, 1.0, false);
            for triangle in geometry.triangles() {
                let [a, b, c] = triangle.map(|index| geometry.positions[index as usize]);
                assert!((b - a).cross(c - a).dot(a + b + c) > 0.0);
                for [from, to] in [[a, b], [b, c], [c, a]] {
                    *edges.entry([from, to].map(|p| (p + 0.0).to_array().map(f32::to_bits))).or_default() += 1;
                }
            }
        }
        assert!(!edges.is_empty());
        for ([from, to], count) in &edges {
            assert_eq!((*count, edges.get(&[*to, *from])), (1, Some(&1)), "stride {stride}");
        }
    }
}

#[test]
fn normals_of_a_globe_agree_across_the_borders_of_squares() {
    let mut seen: HashMap<[u32; 3], Vec3> = HashMap::new();
    let mut shared = 0;
    for (_, patch) in patches(&mesh(Area::Globe, 8)) {
        for vertex in &patch.vertices {
            let key = (vertex.position_m.as_vec3() + 0.0).to_array().map(f32::to_bits);
            if let Some(normal) = seen.insert(key, vertex.normal) {
                shared += 1;
                assert_eq!(normal, vertex.normal);
            }
        }
    }
    // 12 edges of 7 inner vertices, and two more at each of 8 corners.
    assert_eq!(shared, 12 * 7 + 8 * 2);
}

#[test]
fn frames_are_those_of_gltf() {
    let radius_m = 40_000.0;
    let at = |area: &Area, lat_deg: f64, lon_deg: f64| {
        let squares = Square::all(area, radius_m);
        squares[0].position_m(LatLon::from_degrees(lat_deg, lon_deg).direction(), 0.0)
    };
    for (lat_deg, lon_deg, axis) in [(90.0, 0.0, DVec3::Y), (0.0, 0.0, DVec3::X), (0.0, 90.0, DVec3::NEG_Z)] {
        assert!(at(&Area::Globe, lat_deg, lon_deg).distance(axis * radius_m) < 1e-6);
    }
    assert!(at(&REGION, 20.0, -40.0).length() < 1e-6);
    let north = at(&REGION, 20.1, -40.0);
    assert!(north.z < -60.0 && north.x.abs() < 1e-6 && north.y < 0.0, "{north}");
    let east = at(&REGION, 20.0, -39.9);
    assert!(east.x > 60.0 && east.z.abs() < 0.1, "{east}");
    let square = &Square::all(&REGION, radius_m)[0];
    assert!(square.center_m().distance(DVec3::new(0.0, -radius_m, 0.0)) < 1e-6);
    // The middle of the upper side of a texture is north.
    let top = square.direction(0.5, 0.0);
    assert!(square.position_m(top, 0.0).z < -3900.0);
}

#[test]
fn skirts_hang_from_the_border_and_face_outwards() {
    let mesh = MeshBake { skirt_m: 100.0, ..mesh(REGION, 8) };
    let (_, patch) = patch(&mesh);
    for stride in [1, 2] {
        let bare = Geometry::new(&patch, stride, 0.0, 1.0, false);
        let skirted = Geometry::new(&patch, stride, 100.0, 1.0, true);
        let border = 4 * 8 / stride;
        assert_eq!(skirted.positions.len(), bare.positions.len() + border);
        assert_eq!(skirted.triangle_count(), bare.triangle_count() + 2 * border);
        let center = patch.center_m.as_vec3();
        let skirt: Vec<_> = skirted.triangles().skip(bare.triangle_count()).collect();
        assert_eq!((skirted.tangents.len(), bare.colors.len()), (skirted.positions.len(), bare.positions.len()));
        let above: HashSet<_> = skirt.iter().flatten().collect();
        assert_eq!(above.len(), 2 * border);
        for triangle in &skirt {
            let [a, b, c] = triangle.map(|index| skirted.positions[index as usize]);
            let middle = (a + b + c) / 3.0;
            let out = Vec3::new(middle.x, 0.0, middle.z);
            assert!((b - a).cross(c - a).dot(out) > 0.0, "{a} {b} {c}");
        }
        for below in &skirted.positions[bare.positions.len()..] {
            let hangs = |from: &Vec3| {
                let drop = from.distance(*below);
                (drop - 100.0).abs() < 0.1 && (from.distance(center) - below.distance(center) - 100.0).abs() < 0.1
            };
            assert!(bare.positions.iter().any(hangs), "{below}");
        }
    }
}

#[test]
fn water_apart_covers_what_is_wet_and_nothing_far_from_it() {
    let mesh = MeshBake { water: MeshWater::Apart, ..mesh(REGION, 32) };
    let (_, patch) = patch(&mesh);
    let above = |vertex: &patch::Vertex| {
        let up = (vertex.position_m - patch.center_m).normalize();
        vertex.water_radius_m().map(|radius_m| patch.center_m + up * radius_m)
    };
    let wet: Vec<_> = patch.vertices.iter().filter_map(above).collect();
    let water = Geometry::water(&patch, 1, 1.0).unwrap();
    assert!(wet.len() > 20 && wet.len() < water.positions.len(), "{} of {}", wet.len(), water.positions.len());
    assert!(water.positions.len() < patch.vertices.len());
    // A sea is level.
    for position in &water.positions {
        assert!((position.as_dvec3().distance(patch.center_m) - 39_950.0).abs() < 0.01);
    }
    for water_m in wet {
        assert!(water.positions.iter().any(|position| position.distance(water_m.as_vec3()) < 0.01));
    }
    let dry = MeshBake { water: MeshWater::Surface, ..mesh };
    assert!(Geometry::water(&self::patch(&dry).1, 1, 1.0).is_none());
}

#[test]
fn textures_of_normals_turn_the_meshs_normals_into_the_grounds() {
    let mesh = MeshBake { water: MeshWater::None, ..mesh(REGION, 8) };
    let (square, patch) = patch(&mesh);
    let (terrain, canopies) = (terrain(), Canopies::default());
    let surface = surface(&mesh, &terrain, &canopies);
    let textures = Textures::new(&square, 64, &patch, &surface, &Progress::new(1, &|_| true)).unwrap();
    let pixels = |file: &[u8]| {
        let mut reader = png::Decoder::new(std::io::Cursor::new(file)).read_info().unwrap();
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        bytes
    };
    let (normals, roughness) = (pixels(&textures.normal), pixels(&textures.roughness));
    assert_eq!((normals.len(), roughness.len()), (64 * 64 * 3, 64 * 64 * 3));
    let mut differing = 0;
    for (i, texel) in normals.chunks_exact(3).enumerate() {
        let (u, v) = (((i % 64) as f64 + 0.5) / 64.0, ((i / 64) as f64 + 0.5) / 64.0);
        let stored = DVec3::from_array([0, 1, 2].map(|k| f64::from(texel[k]) / 255.0 * 2.0 - 1.0));
        // As a shader does it.
        let (normal, tangent) = patch.between(u, v);
        let (normal, tangent) = (normal.normalize(), tangent.normalize());
        let found = tangent * stored.x + normal.cross(tangent) * stored.y + normal * stored.z;
        let wanted = square.turned(terrain.sample(square.direction(u, v)).normal_planet);
        // Texels of 125 m show all of a planet whose finest wave is 1500 m long.
        assert!(found.normalize().dot(wanted) > 0.9995, "{i}: {found} {wanted}");
        differing += usize::from(normal.dot(wanted) < 0.999);
    }
    assert!(differing > 100, "the mesh alone shows all: {differing}");
    assert!(roughness.chunks_exact(3).all(|texel| texel[0] == 0xff && texel[1] > 0 && texel[2] == 0));
}

#[test]
fn what_cannot_be_made_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.glb");
    let (terrain, whole) = (terrain(), mesh(REGION, 8));
    let far = Area::Region(Region { lat_deg: 0.0, lon_deg: 0.0, side_km: 1e6 });
    for (mesh, words) in [
        (MeshBake { cells: 5000, ..whole.clone() }, "more than 8 million vertices"),
        (MeshBake { cells: 0, ..whole.clone() }, "0 cells"),
        (MeshBake { levels: 5, ..whole.clone() }, "use a multiple of 16"),
        (MeshBake { levels: 0, ..whole.clone() }, "use 1 to 8"),
        (MeshBake { area: far, ..whole.clone() }, "a region of 1000000 km is out of range"),
        (MeshBake { texture_px: Some(20_000), ..whole.clone() }, "use 2 to 11585"),
        (MeshBake { skirt_m: -1.0, ..whole.clone() }, "skirt of -1 m"),
        (MeshBake { skirt_m: 1e12, ..whole.clone() }, "half the planet's radius at most"),
        (MeshBake { skirt_m: 1e12, is_quantized: true, ..whole.clone() }, "the side of a quantized square at most"),
        (MeshBake { scale: 0.0, ..whole.clone() }, "scale of 0"),
    ] {
        let error = mesh.run(&terrain, &path, &|_| true).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    let bare = Planet { water: None, ..Planet::clone(terrain.planet()) };
    let error = MeshBake { water: MeshWater::Apart, ..whole.clone() }.check(&bare).unwrap_err();
    assert!(error.contains("neither a sea nor a structure"), "{error}");
    // Nothing is left of a mesh that was stopped.
    assert_eq!(whole.run(&terrain, &path, &|_| false).unwrap(), Outcome::Stopped);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
}

pub(super) fn tiles(levels: u8) -> Tileset {
    Tileset { cells: 4, ..Tileset::new(levels) }
}

#[test]
fn tiles_of_a_level_meet_and_lie_within_their_boxes() {
    let (tileset, terrain) = (tiles(2), terrain());
    let folder = tempfile::tempdir().unwrap();
    assert!(
        matches!(tileset.run(&terrain, folder.path(), &|_| true).unwrap(), Outcome::Done(files) if files.len() == 1 + 6 * 21)
    );
    let json: Value = serde_json::from_slice(&std::fs::read(folder.path().join("tileset.json")).unwrap()).unwrap();
    let mut tiles = Vec::new();
    let mut open = json["root"]["children"].as_array().unwrap().clone();
    while let Some(tile) = open.pop() {
        open.extend(tile["children"].as_array().into_iter().flatten().cloned());
        tiles.push(tile);
    }
    assert_eq!(tiles.len(), 6 * 21);
    let by_uri: HashMap<String, _> =
        tileset.nodes(terrain.planet()).into_iter().map(|node| (tileset::uri(node), node)).collect();
    let numbers =
        |array: &Value| -> Vec<f64> { array.as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect() };
    let mut measured_m: f64 = 0.0;
    for tile in &tiles {
        let uri = tile["content"]["uri"].as_str().unwrap();
        let node = by_uri[uri];
        assert_eq!(tile["geometricError"] == 0.0, tile["children"].is_null());
        let error_m = tile["geometricError"].as_f64().unwrap();
        for child in tile["children"].as_array().into_iter().flatten() {
            assert!(error_m > child["geometricError"].as_f64().unwrap());
            let child = by_uri[child["content"]["uri"].as_str().unwrap()];
            let (own, finer) = (positions_m(&terrain, node, 4), positions_m(&terrain, child, 4));
            let [right, up] = [child.x % 2, child.y % 2].map(|half| half as usize * 2);
            // Between two vertices of the tile lies one of the child.
            for (row, column) in (0..3).flat_map(|row| (0..2).map(move |column| (row, column))) {
                let [from, to] = [column, column + 1].map(|at| own[(row + up) * 5 + at + right]);
                let away_m = finer[row * 2 * 5 + column * 2 + 1].distance(0.5 * (from + to));
                assert!(away_m <= error_m + 1e-6, "{uri}: {away_m} {error_m}");
                measured_m = measured_m.max(away_m / error_m);
            }
        }
        let bytes = std::fs::read(folder.path().join(uri)).unwrap();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let glb: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        let (bounds, origin) = (numbers(&tile["boundingVolume"]["box"]), numbers(&glb["nodes"][0]["translation"]));
        // The first view holds positions: those of the surface, then those of the skirt.
        let floats = bytes[28 + length..].as_chunks().0;
        for (i, vertex) in floats[..(25 + 16) * 3].chunks_exact(3).enumerate() {
            let at = DVec3::from_array([0, 1, 2].map(|k| f64::from(f32::from_le_bytes(vertex[k])) + origin[k]));
            // Readers turn y up to z up.
            let planet_m = DVec3::new(at.x, -at.z, at.y);
            let from_center = planet_m - DVec3::from_slice(&bounds);
            for axis in bounds[3..].chunks_exact(3).map(DVec3::from_slice) {
                let share = from_center.dot(axis) / axis.length_squared();
                assert!(share.abs() <= 1.0, "{uri}: {share}");
            }
            if i < 25 {
                // Directions of neighbours agree to the bit.
                let dir = node.direction((i % 5) as f64 / 4.0, 1.0 - (i / 5) as f64 / 4.0);
                let sample = terrain.sample(dir);
                let wanted_m = dir * (40_000.0 + sample.water_level_m.unwrap_or(sample.height_m));
                assert!(planet_m.distance(wanted_m) < 0.01, "{uri}: {planet_m}, not {wanted_m}");
            }
        }
    }
    assert!(measured_m > 0.7, "no tile comes near its error: {measured_m}");
}

/// The vertices of a tile, row by row from the south.
fn positions_m(terrain: &Terrain, node: NodeId, cells: u32) -> Vec<DVec3> {
    let share = |i: u32| NodeId::side_share(i, cells);
    let dirs = (0..=cells).flat_map(|row| (0..=cells).map(move |column| node.direction(share(column), share(row))));
    dirs.map(|dir| {
        let sample = terrain.sample(dir);
        dir * (40_000.0 + sample.water_level_m.unwrap_or(sample.height_m))
    })
    .collect()
}

#[test]
fn a_region_divides_only_what_is_near_and_always_into_four() {
    let terrain = terrain();
    let planet = terrain.planet();
    let region = Some(Region { lat_deg: 20.0, lon_deg: -40.0, side_km: 4.0 });
    let (whole, part) = (tiles(5).nodes(planet), Tileset { region, ..tiles(5) }.nodes(planet));
    assert_eq!(whole.len(), 6 * 1365);
    assert!(part.len() > 126 && part.len() < 400, "{}", part.len());
    let center = LatLon::from_degrees(20.0, -40.0).direction();
    assert!(part.contains(&NodeId::containing(center, 5)));
    for node in &part {
        assert!(node.parent().is_none_or(|parent| parent.children().iter().all(|child| part.contains(child))));
    }
}

#[test]
fn tiles_that_are_there_are_kept_and_those_of_another_bake_are_not_touched() {
    let (folder, terrain) = (tempfile::tempdir().unwrap(), terrain());
    let asked = std::sync::atomic::AtomicU32::new(0);
    let some = |_| asked.fetch_add(1, std::sync::atomic::Ordering::Relaxed) < 10;
    assert_eq!(tiles(1).run(&terrain, folder.path(), &some).unwrap(), Outcome::Stopped);
    assert!(!folder.path().join("tileset.json").exists());
    let kept = folder.path().join("0/pos_x_0_0.glb");
    tiles(1).run(&terrain, folder.path(), &|_| true).unwrap();
    assert!(
        matches!(tiles(1).run(&terrain, folder.path(), &|_| true).unwrap(), Outcome::Kept(files) if files.len() == 31)
    );
    let written = || std::fs::metadata(&kept).unwrap().modified().unwrap();
    let before = written();
    // No tile, a bit that is another among the vertices, an end that is missing, a tile of the same length, no file.
    let broken = |name: &str| folder.path().join(name);
    let whole = std::fs::read(broken("1/neg_z_1_1.glb")).unwrap();
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 4;
        bytes
    };
    for bytes in
        [b"no tile".to_vec(), flipped(whole.len() - 99), flipped(300), whole[..whole.len() - 4].to_vec(), vec![]]
    {
        std::fs::write(broken("1/neg_z_1_1.glb"), bytes).unwrap();
        std::fs::remove_file(broken("0/neg_x_0_0.glb")).unwrap();
        assert!(matches!(tiles(1).run(&terrain, folder.path(), &|_| true).unwrap(), Outcome::Done(_)));
        assert!(std::fs::read(broken("1/neg_z_1_1.glb")).unwrap() == whole && broken("0/neg_x_0_0.glb").is_file());
    }
    // A whole tile of another place.
    std::fs::copy(broken("1/neg_z_1_0.glb"), broken("1/neg_z_1_1.glb")).unwrap();
    tiles(1).run(&terrain, folder.path(), &|_| true).unwrap();
    assert!(std::fs::read(broken("1/neg_z_1_1.glb")).unwrap() == whole);
    assert_eq!(written(), before);
    let other = Tileset { cells: 6, ..tiles(1) }.run(&terrain, folder.path(), &|_| true).unwrap_err().to_string();
    assert!(other.contains("holds tiles of another bake"), "{other}");
    for (tileset, words) in [
        (Tileset { cells: 0, ..tiles(1) }, "0 cells"),
        (Tileset { cells: 7, ..tiles(1) }, "use even numbers"),
        (Tileset { texture_px: Some(1), ..tiles(1) }, "use 2 to 1024"),
        (Tileset { water: MeshWater::Apart, ..tiles(1) }, "no mesh of the water"),
        (tiles(17), "use 0 to 16"),
        (Tileset { is_implicit: true, ..tiles(11) }, "use 0 to 10, or list the tiles"),
        (tiles(9), "use fewer levels, or a region"),
    ] {
        let error = tileset.run(&terrain, &folder.path().join("none"), &|_| true).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
    assert!(!folder.path().join("none").exists());
}

#[test]
fn a_spacing_becomes_cells_that_can_be_halved() {
    assert_eq!(MeshBake::cells_for(&REGION, 40_000.0, Some(1000.0), 1), 8);
    assert_eq!(MeshBake::cells_for(&REGION, 40_000.0, Some(900.0), 1), 9);
    assert_eq!(MeshBake::cells_for(&REGION, 40_000.0, Some(900.0), 3), 12);
    assert_eq!(MeshBake::cells_for(&REGION, 40_000.0, Some(1e-300), 3) % 4, 0);
    assert_eq!(MeshBake::cells_for(&Area::Globe, 40_000.0, Some(1e9), 4), 8);
    assert_eq!(MeshBake::cells_for(&Area::Globe, 40_000.0, None, 4), MeshBake::CELLS);
}
