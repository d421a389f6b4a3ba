//! Texture sets of biomes: what is read, what is refused, and that only the look depends on them.

use crate::support::dice::Dice;
use crate::support::png::changed_png;
use crate::support::textures::{even, png, stripes};
use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;
use std::time::Duration;
use tellus::planet::param::Stage;
use tellus::planet::picture::{Budget, MAX_BYTES};
use tellus::planet::sources::Sources;
use tellus::planet::textures::TextureSet;
use tellus::planet::watch::PresetWatch;
use tellus::planet::{FileContent, FileKey, Key, Planet, VERSION};
use tellus::terrain::Revision;

/// Files of a pack: bytes by path.
type Pack = BTreeMap<&'static str, Vec<u8>>;

fn text(file: &str) -> String {
    format!("(version: {VERSION}, biomes: (palette: [(key: 'a', detail: Sand, textures: {file:?})]))")
}

/// A planet whose only biome has this set, and what is wrong with the set.
fn read(file: &str, pack: &Pack) -> (Planet, Option<String>) {
    let mut planet = Planet::from_text("a.ron", &text(file)).unwrap();
    let fetch = |path: &Path| pack.get(path.to_str().unwrap()).cloned().ok_or(format!("no {}", path.display()));
    let problems = planet.load_pictures_from(fetch);
    let problem = problems.into_iter().next().map(|(path, why)| {
        assert_eq!(path.to_string(), "biomes.palette[0].textures");
        why
    });
    (planet, problem)
}

fn set(planet: &Planet) -> &Arc<TextureSet> {
    planet.biomes.palette[0].textures.set().unwrap()
}

/// All pictures of a set of bricks.
fn bricks() -> Pack {
    let edge = |x: u32, y: u32| x % 64 < 4 || y % 32 < 4;
    BTreeMap::from([
        ("t/brick_albedo.png", png([128, 64], |x, y| if edge(x, y) { [90; 3] } else { [180, 90, 60] })),
        ("t/brick_normal.png", png([64; 2], |x, _| [128 + (x % 32) as u8, 128, 240])),
        ("t/brick_rough.png", png([32; 2], |x, y| if edge(2 * x, 2 * y) { [250; 3] } else { [90; 3] })),
        ("t/brick_height.png", png([128, 64], |x, y| if edge(x, y) { [0; 3] } else { [200; 3] })),
        ("t/brick_ao.png", png([128, 64], |x, y| if edge(x, y) { [90; 3] } else { [255; 3] })),
    ])
}

#[test]
fn a_set_is_read_with_all_its_pictures_and_each_of_them_counts() {
    let (whole, problem) = read("t/brick_albedo.png", &bricks());
    assert_eq!(problem, None);
    let mut found = vec![whole.clone()];
    for name in bricks().keys() {
        let mut other = bricks();
        // Another picture of the same mean.
        other.insert(name, png([64; 2], |x, y| if (x / 8 + y / 8).is_multiple_of(2) { [200; 3] } else { [100; 3] }));
        found.push(read("t/brick_albedo.png", &other).0);
        if *name != "t/brick_albedo.png" {
            other.remove(name);
            let (without, problem) = read("t/brick_albedo.png", &other);
            assert_eq!(problem, None, "without {name}");
            found.push(without);
        }
    }
    for (i, planet) in found.iter().enumerate() {
        for other in &found[..i] {
            assert_ne!(planet, other);
            assert_ne!(Key::of_planet(planet), Key::of_planet(other));
            // Only what the ground looks like is made anew.
            let [now, before] = [planet, other].map(|planet| Revision::try_new(Arc::new(planet.clone())).unwrap());
            let changes: Vec<Stage> = now.changes_since(&before).iter().collect();
            assert_eq!(changes, [Stage::Material]);
        }
    }
    assert_eq!(read("t/brick_albedo.png", &bricks()).0, whole);
}

#[test]
fn the_colour_of_a_set_is_the_linear_mean_of_its_picture() {
    let pack = BTreeMap::from([("a.png", png([2, 1], |x, _| if x == 0 { [255, 0, 188] } else { [0, 0, 188] }))]);
    let (planet, problem) = read("a.png", &pack);
    assert_eq!(problem, None);
    let color = set(&planet).color;
    for (found, right) in color.into_iter().zip([0.5, 0.0, 0.5028]) {
        assert!((found - right).abs() < 1e-3, "{color:?}");
    }
    // Grey, interlaced or not.
    for file in ["plain.png", "interlaced.png"] {
        let bytes = std::fs::read(Path::new("tests/fixtures").join(file)).unwrap();
        let (planet, problem) = read("a.png", &BTreeMap::from([("a.png", bytes)]));
        assert_eq!(problem, None, "{file}");
        println!("{file}: {:?}", set(&planet).color);
    }
}

#[test]
fn pictures_are_png_jpeg_or_openexr() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    // Linear colours, in tiles of the layout that the crate chooses.
    let pixels =
        |x: usize, y: usize| if (x + y).is_multiple_of(2) { (0.9_f32, 0.2_f32, 0.0_f32) } else { (0.1, 0.2, 0.5) };
    exr::prelude::write_rgb_file(at("a_col.exr"), 600, 40, pixels).unwrap();
    std::fs::copy("docs/aurel.jpg", at("a_height.jpg")).unwrap();
    std::fs::write(at("a_ao.png"), even(255)).unwrap();
    let load = || FileKey::Textures(at("a_col.exr")).load(&mut Budget::default()).unwrap();
    let color = |content: &FileContent| match content {
        FileContent::Textures(set) => set.color,
        other => panic!("{other:?}"),
    };
    let with = load();
    for (found, right) in color(&with).into_iter().zip([0.5, 0.2, 0.25]) {
        assert!((found - right).abs() < 1e-3, "{:?}", color(&with));
    }
    assert_eq!(with.others(), [at("a_height.jpg"), at("a_ao.png")]);
    std::fs::remove_file(at("a_height.jpg")).unwrap();
    assert_ne!(load(), with);
    // A picture of a planet: neither black nor white.
    std::fs::copy("docs/aurel.jpg", at("b.jpg")).unwrap();
    let content = FileKey::Textures(at("b.jpg")).load(&mut Budget::default()).unwrap();
    assert!(color(&content).iter().all(|part| (0.003..0.5).contains(part)), "{:?}", color(&content));
}

#[test]
fn what_is_wrong_with_a_picture_is_told() {
    let why = |change: &dyn Fn(&mut Pack)| {
        let mut pack = bricks();
        change(&mut pack);
        let (planet, problem) = read("t/brick_albedo.png", &pack);
        assert!(planet.biomes.palette[0].textures.set().is_none());
        problem.unwrap()
    };
    assert_eq!(why(&|pack| drop(pack.remove("t/brick_albedo.png"))), "no t/brick_albedo.png");
    assert_eq!(
        why(&|pack| drop(pack.insert("t/brick_normal.png", b"a normal map".to_vec()))),
        "t/brick_normal.png is neither PNG, JPEG nor OpenEXR; save the picture as one of them"
    );
    assert_eq!(
        why(&|pack| drop(pack.insert("t/brick_ao.png", png([8193, 1], |_, _| [9; 3])))),
        "t/brick_ao.png is 8193 x 1 pixels; use 1 to 8192 along a side"
    );
    let half = |pack: &mut Pack| pack.get_mut("t/brick_albedo.png").unwrap().truncate(90);
    let broken = why(&half);
    assert!(broken.starts_with("t/brick_albedo.png is broken: ") && broken.ends_with("save the picture anew"));
    let not_jpeg = why(&|pack| drop(pack.insert("t/brick_ao.png", vec![0xff, 0xd8, 0xff, 0xe0, 0, 1])));
    assert!(not_jpeg.starts_with("t/brick_ao.png is broken: "), "{not_jpeg}");
}

#[test]
fn changed_pictures_are_read_or_refused() {
    let (mut dice, whole) = (Dice(11), bricks());
    let names: Vec<&str> = whole.keys().copied().collect();
    let mut refused = 0;
    for i in 0..150 {
        let mut pack = whole.clone();
        let name = names[i % names.len()];
        pack.insert(name, changed_png(&whole[name], &mut dice));
        if let (_, Some(why)) = read("t/brick_albedo.png", &pack) {
            assert!(why.starts_with(name) && why.len() < 300, "{why}");
            refused += 1;
        }
    }
    assert!((20..150).contains(&refused), "{refused} of 150 refused");
}

#[test]
fn no_random_planet_has_a_set() {
    assert!((0..100).all(|seed| tellus::planet::random::random(seed).texture_sets().next().is_none()));
}

#[test]
fn sets_share_the_budget_of_pictures() {
    let (planet, _) = read("t/brick_albedo.png", &bricks());
    let key = FileKey::Textures("t/brick_albedo.png".into());
    let folder = tempfile::tempdir().unwrap();
    let left = |planet: &Planet| format!("{:?}", planet.file_budget());
    assert_ne!(left(&planet), left(&Planet::default()));
    assert_eq!(planet.linked_files().count(), 1);
    assert!(matches!(planet.linked_files().next(), Some((found, Some(FileContent::Textures(_)))) if found == key));
    // Files of sets that differ, until there is no room.
    let mut budget = Budget::default();
    let read = (0..).map(|i: u32| {
        let file = folder.path().join(format!("{i}.png"));
        std::fs::write(&file, png([1, 1], |_, _| [(i % 256) as u8, (i / 256) as u8, 9])).unwrap();
        FileKey::Textures(file).load(&mut budget)
    });
    let refused: Vec<_> = read.take_while(Result::is_ok).collect();
    assert!((100..400).contains(&refused.len()), "{} sets in {MAX_BYTES} bytes", refused.len());
    let file = folder.path().join("last.png");
    std::fs::write(&file, png([1, 1], |_, _| [3, 200, 9])).unwrap();
    let why = FileKey::Textures(file).load(&mut budget).unwrap_err();
    assert!(why.contains("last.png finds no room: the planet's pictures and texture sets keep 512 MiB"), "{why}");
}

#[test]
fn a_preset_holds_the_path_alone_and_moves_with_its_textures() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir_all(at("t")).unwrap();
    std::fs::create_dir_all(at("other")).unwrap();
    bricks().iter().for_each(|(name, bytes)| std::fs::write(at(name), bytes).unwrap());
    std::fs::write(at("a.ron"), text("t/brick_albedo.png")).unwrap();
    let planet = Planet::load(at("a.ron")).unwrap();
    assert_eq!(*set(&planet), *set(&read("t/brick_albedo.png", &bricks()).0));
    planet.save(at("other/b.ron")).unwrap();
    let saved = std::fs::read_to_string(at("other/b.ron")).unwrap();
    assert!(saved.contains("textures: \"../t/brick_albedo.png\""), "{saved}");
    assert_eq!(Planet::load(at("other/b.ron")).unwrap(), planet);
    assert!(!Planet::default().to_text().contains("textures"), "a preset without sets does not mention them");
    // Nothing that is written replaces one of the pictures.
    let sources = Sources::of_preset(&at("a.ron"), &planet);
    for name in bricks().keys() {
        assert!(sources.check(&at(name)).unwrap_err().contains("a texture that the planet reads"), "{name}");
    }
    assert_eq!(sources.check(&at("t/brick_disp.png")), Ok(()));
    // Without its pictures the biome has its pattern.
    std::fs::remove_file(at("t/brick_albedo.png")).unwrap();
    let mut without = Planet::load(at("a.ron")).unwrap();
    assert!(without.biomes.palette[0].textures.set().is_none());
    let (path, why) = without.load_pictures().remove(0);
    assert_eq!(path.to_string(), "biomes.palette[0].textures");
    assert!(
        why.starts_with("there is no file ") && why.ends_with("put the picture there or correct the path"),
        "{why}"
    );
    std::fs::create_dir(at("t/brick_albedo.png")).unwrap();
    let why = without.load_pictures().remove(0).1;
    assert!(why.ends_with("brick_albedo.png is a folder; name the colour picture of a set in it"), "{why}");
}

#[test]
fn a_pack_gives_the_pictures_that_it_has() {
    let pack = bricks();
    let mut asked = Vec::new();
    let planet = Planet::from_pack("a.ron", &text("t/brick_albedo.png"), |path| {
        asked.push(path.to_owned());
        pack.get(path.to_str().unwrap()).cloned().ok_or_else(|| "not packed".to_owned())
    });
    assert_eq!(planet.unwrap(), read("t/brick_albedo.png", &pack).0);
    assert_eq!(asked[0], Path::new("t/brick_albedo.png"));
    let empty = Planet::from_pack("a.ron", &text("t/brick_albedo.png"), |_| Err("not packed".to_owned()));
    assert!(empty.unwrap().biomes.palette[0].textures.set().is_none(), "a planet without its textures is one");
}

#[test]
fn two_biomes_share_a_set() {
    let biome = |key: char| format!("(key: '{key}', textures: \"a_col.png\")");
    let text = format!("(version: {VERSION}, biomes: (palette: [{}, {}]))", biome('a'), biome('b'));
    let mut reads = 0;
    let planet = Planet::from_pack("a.ron", &text, |path| {
        reads += usize::from(path == Path::new("a_col.png"));
        if path == Path::new("a_col.png") { Ok(stripes()) } else { Err(String::new()) }
    });
    let planet = planet.unwrap();
    let [a, b] = [0, 1].map(|i| planet.biomes.palette[i].textures.set().unwrap());
    assert!(Arc::ptr_eq(a, b) && reads == 1, "{reads}");
}

#[test]
fn a_game_that_watches_its_preset_hears_of_all_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("a_color.png"), stripes()).unwrap();
    std::fs::write(at("a_rough.png"), even(90)).unwrap();
    std::fs::write(at("a.ron"), text("a_color.png")).unwrap();
    let mut watch = PresetWatch::every(at("a.ron"), Duration::ZERO);
    assert!(watch.poll().is_none());
    let other = png([16; 2], |x, _| [x as u8 * 9; 3]);
    std::fs::write(at("a_rough.png"), other).unwrap();
    assert!(watch.poll().is_none());
    let planet = watch.poll().unwrap().unwrap();
    assert!(planet.biomes.palette[0].textures.set().is_some());
    assert!(watch.poll().is_none());
}
