//! Meshes of artists: what is read, what is refused, and that places do not depend on them.

use crate::support::glb::{Part, block, document, glb, packed, tree};
use glam::Vec3;
use std::path::Path;
use std::sync::Arc;
use tellus::life::form::{self, LEVELS};
use tellus::life::{Canopies, Model};
use tellus::planet::life::{FileMesh, GameObject};
use tellus::planet::mesh::{MAX_TRIANGLES, MeshData};
use tellus::planet::{Form, Key, Planet, Population, VERSION};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

/// A planet whose only population has this form.
fn planet(form: Form) -> Planet {
    let life = vec![Population { form, height_m: 12.0, per_hectare: 200.0, ..Population::default() }];
    Planet { radius_km: 500.0, life, ..Planet::default() }
}

fn of_file(path: &str) -> Form {
    Form::Mesh(FileMesh { file: path.to_owned().into(), ..FileMesh::default() })
}

/// A population with the mesh of these bytes; or what is wrong with them.
fn read(bytes: &[u8]) -> Result<Population, String> {
    let mut planet = planet(of_file("trees/oak.glb"));
    let fetch = |path: &Path| {
        if path == Path::new("trees/oak.glb") { Ok(bytes.to_vec()) } else { Err(format!("no {}", path.display())) }
    };
    match planet.load_pictures_from(fetch).pop() {
        None => Ok(planet.life.remove(0)),
        Some((path, why)) => {
            assert_eq!(path.to_string(), "life[0].form.file");
            Err(why)
        }
    }
}

fn mesh(population: &Population) -> &Arc<MeshData> {
    let Form::Mesh(form) = &population.form else { panic!("another form") };
    form.file.mesh().unwrap()
}

#[test]
fn a_mesh_is_read_with_its_colours_and_stands_as_high_as_its_population() {
    let population = read(&glb(&tree())).unwrap();
    let data = mesh(&population);
    assert_eq!((data.triangles(), data.nodes.len(), data.has_leaves), (24, 2, true));
    let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-4);
    assert!(close(data.colors[0], [0.3, 0.1, 0.05]) && close(data.colors[1], [0.05, 0.4, 0.1]), "{:?}", data.colors);
    assert_eq!(population.colors(), data.colors);
    let near = Model::nearest(&population, 0);
    let heights = near.vertices.iter().map(|vertex| vertex.position.z);
    assert_eq!(heights.clone().fold(f32::MIN, f32::max), 1.0);
    // What is below the ground stays there: 0.2 of 5.
    assert!((heights.fold(f32::MAX, f32::min) + 0.04).abs() < 1e-5);
    // The front is outside, and z is up: the crown is 3 wide above 2 of 5.
    let mut volume = 0.0;
    for triangle in &near.triangles {
        let [a, b, c] = triangle.map(|at| near.vertices[usize::from(at)]);
        volume += a.position.dot(b.position.cross(c.position)) / 6.0;
        assert!(a.normal.dot((b.position - a.position).cross(c.position - a.position)) > 0.0);
        assert_eq!(a.part == 1.0, a.position.z > 0.39 && a.position.x.abs() > 0.2, "{a:?}");
    }
    assert!((volume - (27.0 + 0.792) / 125.0).abs() < 1e-3, "{volume}");
    let top = near.vertices.iter().find(|vertex| vertex.position.z == 1.0 && vertex.normal.z > 0.9).unwrap();
    let under = near.vertices.iter().find(|vertex| vertex.part == 1.0 && vertex.normal.z < -0.9).unwrap();
    assert!(top.light > 0.95 && under.light < 0.8, "{} {}", top.light, under.light);
}

#[test]
fn nodes_are_variants_about_their_own_places() {
    let at = |x: f32, height: f32| Part { at: [x, 0.0, 3.0], ..block([1.0, height, 1.0], 0.0, [0.5; 3]) };
    let mut population = read(&glb(&[at(0.0, 1.0), at(20.0, 2.0), at(-20.0, 4.0)])).unwrap();
    let widths = |population: &Population| {
        let model = Model::new(population);
        let wide = |mesh: &form::Mesh| mesh.vertices.iter().fold(0.0_f32, |most, v| most.max(v.position.x.abs()));
        let mut widths: Vec<i32> = model.variants.iter().map(|levels| (wide(&levels[0]) * 1000.0) as i32).collect();
        widths.sort_unstable();
        widths
    };
    assert_eq!(widths(&population), [5125; 4]);
    let Form::Mesh(form) = &mut population.form else { panic!("another form") };
    form.variants = true;
    let found = widths(&population);
    assert_eq!(found.iter().collect::<std::collections::BTreeSet<_>>().len(), 3, "{found:?}");
    assert!(found[0] == 125 && found[3] == 500, "{found:?}");
}

#[test]
fn buffers_lie_beside_the_document_or_within_it() {
    let (text, bytes) = document(&tree(), Some("my%20tree.bin"));
    let mut planet = planet(of_file("trees/oak.gltf"));
    let problems = planet.load_pictures_from(|path| match path.to_str() {
        Some("trees/oak.gltf") => Ok(text.clone().into_bytes()),
        Some("trees/my tree.bin") => Ok(bytes.clone()),
        other => Err(format!("{other:?}")),
    });
    assert_eq!(problems, []);
    let within = text.replace("my%20tree.bin", &format!("data:application/octet-stream;base64,{}", base64(&bytes)));
    assert_eq!(mesh(&read(within.as_bytes()).unwrap()).nodes, mesh(&planet.life[0]).nodes);
}

fn base64(bytes: &[u8]) -> String {
    let table = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let group = |group: &[u8]| {
        let word = group.iter().chain(&[0; 3]).take(3).fold(0_usize, |word, byte| word << 8 | usize::from(*byte));
        let digits = (0..4).map(|i| if i > group.len() { '=' } else { char::from(table[word >> (18 - 6 * i) & 63]) });
        digits.collect::<String>()
    };
    bytes.chunks(3).map(group).collect()
}

#[test]
fn what_is_no_usable_mesh_is_refused_with_what_would_be_right() {
    let (text, bytes) = document(&tree(), None);
    let changed = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        packed(text.replacen(from, to, 1), &bytes)
    };
    let needing =
        |extension: &str| changed("\"scene\":0", &format!("\"scene\":0,\"extensionsRequired\":[\"{extension}\"]"));
    let infinite = {
        let mut parts = tree();
        parts[0].positions[3][1] = f32::NAN;
        glb(&parts)
    };
    let beside = |uri: &str| document(&tree(), Some(uri)).0.into_bytes();
    let many = {
        let mut part = block([1.0, 1.0, 1.0], 0.0, [0.5; 3]);
        part.triangles = part.triangles.iter().cycle().take(MAX_TRIANGLES / 2 + 1).copied().collect();
        glb(&[part.clone(), part])
    };
    let mut far = tree();
    far[0].positions[0][0] = 1e4;
    let cases: Vec<(Vec<u8>, &str)> = vec![
        (b"solid ascii".to_vec(), "is no glTF 2.0 file; export the mesh as .glb or .gltf"),
        (b"{ \"asset\": 3 }".to_vec(), "is no glTF 2.0 document from line 1, column"),
        (glb(&tree())[..300].to_vec(), "is broken"),
        (changed("\"2.0\"", "\"1.0\""), "is glTF \"1.0\"; export it as glTF 2.0"),
        (needing("KHR_draco_mesh_compression"), "is compressed with Draco; export it without compression"),
        (needing("EXT_meshopt_compression"), "is compressed with meshopt; export it without compression"),
        (needing("XY_fur"), "needs the extension \"XY_fur\", which is not read"),
        (changed("\"mesh\":1", "\"mesh\":7"), "is no valid glTF 2.0: see nodes[1].mesh"),
        (changed("\"byteOffset\":96", "\"byteOffset\":99999"), "lies outside its buffer"),
        (infinite, "has corners that are no finite numbers"),
        (glb(&[block([1.0, 1.0, 1.0], -2.0, [0.5; 3])]), "has nothing above its ground, which is at y = 0"),
        (changed("\"nodes\":[0,1]", "\"nodes\":[]"), "has no triangles in its scene"),
        (glb(&far), "times as far from its foot as it is high; use at most 50 times"),
        (many, "has more than 200000 triangles, the limit of a mesh"),
        (beside("../secret.bin"), "names the file \"../secret.bin\", which is not in its folder"),
        (beside("%2e%2e/secret.bin"), "which is not in its folder"),
        (beside("file:///etc/passwd"), "which is not in its folder"),
        (beside("/etc/passwd"), "which is not in its folder"),
        (beside("gone.bin"), "needs \"gone.bin\" beside it: no trees/gone.bin"),
        (beside("data:text/plain,abc"), "has data that is not in base64"),
    ];
    for (bytes, wanted) in cases {
        let why = read(&bytes).err().unwrap_or_else(|| panic!("{wanted}: it was read"));
        assert!(why.starts_with("trees/oak.glb ") && why.contains(wanted), "{wanted}: {why}");
        assert!(why.len() < 300, "{why}");
    }
}

/// A file of any bytes is read or refused; nothing panics, nothing takes long.
#[test]
fn broken_bytes_are_refused() {
    let whole = glb(&tree());
    let mut dice = crate::support::dice::Dice(7);
    for _ in 0..if cfg!(debug_assertions) { 400 } else { 4000 } {
        let mut bytes = whole.clone();
        for _ in 0..3 {
            let at = (dice.roll() * bytes.len() as f64) as usize;
            bytes[at] = (dice.roll() * 256.0) as u8;
        }
        if let Ok(population) = read(&bytes) {
            let near = Model::nearest(&population, 0);
            assert!(near.vertices.iter().all(|vertex| vertex.position.is_finite() && vertex.normal.is_finite()));
        }
    }
}

#[test]
fn places_do_not_depend_on_the_form() {
    let listed = |planet: Planet| {
        let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
        let found = terrain.instances(LatLon::from_degrees(3.0, 4.0).direction(), 200.0).unwrap();
        assert!(found.len() > 100);
        found.iter().map(|one| (one.id, one.base_m.to_bits(), one.size_m.to_bits(), one.variant)).collect::<Vec<_>>()
    };
    let usual = listed(planet(Form::default()));
    let population = read(&glb(&tree())).unwrap();
    assert_eq!(listed(planet(population.form)), usual);
    assert_eq!(listed(planet(of_file("gone.glb"))), usual);
    assert_eq!(listed(planet(Form::Game(GameObject::default()))), usual);
}

#[test]
fn a_stand_in_is_as_wide_as_the_game_says_and_where_a_mesh_is_missing() {
    let wide = |form: Form| {
        let population = Population { form, ..Population::default() };
        let model = Model::new(&population);
        assert_eq!(model.variants.len(), 4);
        for levels in &model.variants {
            for mesh in levels {
                let tops = mesh.vertices.iter().fold([1.0_f32, 0.0], |[low, high], vertex| {
                    [low.min(vertex.position.z), high.max(vertex.position.z)]
                });
                assert!(tops[0].abs() < 1e-3 && (tops[1] - 1.0).abs() < 1e-3, "{tops:?}");
            }
        }
        model.variants[0][0].vertices.iter().fold(0.0_f32, |most, vertex| most.max(vertex.position.truncate().length()))
    };
    for width in [0.05, 0.5, 3.0] {
        let found = wide(Form::Game(GameObject { width, asset: "oak".to_owned() }));
        assert!((2.0 * f64::from(found) - width).abs() < 0.06 * width, "{width}: {found}");
    }
    assert!((wide(of_file("gone.glb")) - 0.15).abs() < 0.01);
}

#[test]
fn queries_and_keys_know_the_mesh() {
    let mut thin = tree();
    thin[1] = Part { alpha: "MASK", ..block([1.0, 3.0, 1.0], 2.0, [0.05, 0.4, 0.1]) };
    let [wide, thin] = [tree(), thin].map(|parts| {
        let mut planet = planet(of_file("oak.glb"));
        assert_eq!(planet.load_pictures_from(|_| Ok(glb(&parts))), []);
        planet
    });
    assert_ne!(Key::of_planet(&wide), Key::of_planet(&thin));
    assert_ne!(wide, thin);
    let cover = |planet: &Planet| {
        let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
        let dir = LatLon::from_degrees(3.0, 4.0).direction();
        Canopies::new(&terrain).at(dir, &terrain.sample(dir)).cover
    };
    let covers = [cover(&wide), cover(&thin)];
    assert!(covers[0] > 2.0 * covers[1] && covers[1] > 0.0, "{covers:?}");
}

#[test]
fn a_preset_holds_the_path_alone_and_moves_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("trees")).unwrap();
    std::fs::create_dir_all(at("other")).unwrap();
    std::fs::write(at("trees/oak.glb"), glb(&tree())).unwrap();
    let life = "life: [(form: Mesh(file: \"trees/oak.glb\"))]";
    std::fs::write(at("a.ron"), format!("(version: {VERSION}, {life})")).unwrap();
    let planet = Planet::load(at("a.ron")).unwrap();
    assert_eq!(mesh(&planet.life[0]).triangles(), 24);
    planet.save(at("other/b.ron")).unwrap();
    let text = std::fs::read_to_string(at("other/b.ron")).unwrap();
    assert!(text.contains("file: \"../trees/oak.glb\"") && text.len() < 20_000);
    assert_eq!(Planet::load(at("other/b.ron")).unwrap(), planet);
    // A preset without its mesh opens, and says what is missing where.
    std::fs::remove_file(at("trees/oak.glb")).unwrap();
    let error = Planet::load(at("a.ron")).unwrap_err().to_string();
    assert!(error.contains("a.ron:1:") && error.contains("life[0].form.file: there is no file"), "{error}");
    assert!(error.contains("put the mesh there or correct the path"), "{error}");
    assert!(Planet::open(at("a.ron")).unwrap().missing_files().len() == 1);
}

#[test]
fn a_game_that_watches_its_preset_hears_of_the_mesh_and_its_buffer() {
    use std::time::Duration;
    use tellus::planet::watch::PresetWatch;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let save = |parts: &[Part]| {
        let (text, bytes) = document(parts, Some("oak.bin"));
        std::fs::write(at("oak.gltf"), text).unwrap();
        std::fs::write(at("oak.bin"), bytes).unwrap();
    };
    save(&tree());
    std::fs::write(at("a.ron"), format!("(version: {VERSION}, life: [(form: Mesh(file: \"oak.gltf\"))])")).unwrap();
    let mut watch = PresetWatch::every(at("a.ron"), Duration::ZERO);
    assert!(watch.poll().is_none());
    let mut higher = std::fs::read(at("oak.bin")).unwrap();
    higher.extend([0; 8]);
    std::fs::write(at("oak.bin"), higher).unwrap();
    assert!(watch.poll().is_none());
    assert!(watch.poll().unwrap().is_ok());
    save(&[block([1.0, 1.0, 1.0], 0.0, [0.5; 3])]);
    assert!(watch.poll().is_none());
    assert_eq!(mesh(&watch.poll().unwrap().unwrap().life[0]).triangles(), 12);
}

#[test]
fn levels_of_a_mesh_are_within_their_budgets() {
    // A ball of 2 x 60 x 60 triangles on the ground.
    let side = 60_u16;
    let place = |i: u16, j: u16| {
        let (a, b) = (
            f32::from(i) / f32::from(side) * std::f32::consts::TAU,
            f32::from(j) / f32::from(side) * std::f32::consts::PI,
        );
        Vec3::new(b.sin() * a.cos(), 1.0 - b.cos(), b.sin() * a.sin()).to_array()
    };
    let positions = (0..=side).flat_map(|j| (0..=side).map(move |i| place(i, j))).collect();
    let at = |i: u16, j: u16| j * (side + 1) + i;
    let triangles = (0..side)
        .flat_map(|j| (0..side).map(move |i| (i, j)))
        .flat_map(|(i, j)| [[at(i, j), at(i, j + 1), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i + 1, j)]]);
    let ball = Part { positions, triangles: triangles.collect(), ..block([1.0; 3], 0.0, [0.4; 3]) };
    let model = Model::new(&read(&glb(&[ball])).unwrap());
    let counts: [usize; LEVELS] = std::array::from_fn(|level| model.variants[0][level].triangles.len());
    assert!(counts[0] > 7000 && counts[1] <= 1400 && counts[2] <= 280 && counts[3] <= 56, "{counts:?}");
    assert!(counts[3] >= 12, "{counts:?}");
    assert!(model.level_light.iter().all(|light| (0.7..1.4).contains(light)), "{:?}", model.level_light);
}
