//! Edits in a file beside the preset.

use std::path::{Path, PathBuf};
use std::time::{Duration, SystemTime};
use tellus::planet::edits::{EditPoint, GroundEdit, Raise, Tool};
use tellus::planet::watch::PresetWatch;
use tellus::planet::{Key, Planet};

/// A planet whose preset is longer than a MiB.
pub(crate) fn sculpted(strokes: usize, amount_m: f64) -> Planet {
    let point = |stroke: usize, step: usize| EditPoint {
        latitude_deg: -80.0 + 0.05 * (stroke % 3000) as f64 + 0.01 * step as f64,
        longitude_deg: 0.37 * stroke as f64 % 180.0,
        ..EditPoint::default()
    };
    let stroke = |stroke: usize| GroundEdit {
        name: format!("Stroke {stroke}"),
        tool: Tool::Raise(Raise { amount_m }),
        points: (0..10).map(|step| point(stroke, step)).collect(),
        ..GroundEdit::default()
    };
    Planet { name: "Sculpted".to_owned(), edits: (0..strokes).map(stroke).collect(), ..Planet::default() }
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

/// The edits file that a preset names.
fn named(preset: &Path) -> PathBuf {
    let text = std::fs::read_to_string(preset).unwrap();
    let name = text.split("edits: \"").nth(1).unwrap().split('"').next().unwrap();
    preset.with_file_name(name)
}

fn make_old(file: &Path) {
    let minutes_ago = SystemTime::now() - Duration::from_secs(120);
    std::fs::File::options().write(true).open(file).unwrap().set_modified(minutes_ago).unwrap();
}

#[test]
fn many_edits_go_to_a_file_beside_the_preset_and_come_back() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let planet = sculpted(1500, 100.0);
    assert!(planet.to_text().len() > 1 << 20);
    planet.save(&path).unwrap();
    let edits = named(&path);
    assert_eq!(names(folder.path()), [edits.file_name().unwrap().to_str().unwrap(), "mine.ron"]);
    let preset = std::fs::read_to_string(&path).unwrap();
    assert!(preset.len() < 60_000, "{}", preset.len());
    for read in [Planet::load(&path).unwrap(), Planet::open(&path).unwrap()] {
        assert!(read == planet && Key::of_planet(&read) == Key::of_planet(&planet));
        assert_eq!(read.to_text(), planet.to_text());
    }
    // From a pack, where the edits are asked for by their name.
    let mut asked = Vec::new();
    let packed = Planet::from_pack("mine.ron", &preset, |file| {
        asked.push(file.to_owned());
        std::fs::read(folder.path().join(file)).map_err(|error| error.to_string())
    });
    assert!(packed.unwrap() == planet);
    assert_eq!(asked, [PathBuf::from(edits.file_name().unwrap())]);
    // A text alone has no folder.
    let why = Planet::from_text("text", &preset).unwrap_err().to_string();
    assert!(why.starts_with("text:") && why.contains("edits: the edits are in the file mine.edits-"), "{why}");
    // Few edits are in the preset.
    let few = sculpted(3, 100.0);
    few.save(folder.path().join("few.ron")).unwrap();
    assert_eq!(std::fs::read_to_string(folder.path().join("few.ron")).unwrap(), few.to_text());
}

#[test]
fn edits_files_that_no_preset_names_are_removed_once_they_are_old() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let save = |name: &str, amount_m: f64| {
        sculpted(1500, amount_m).save(at(name)).unwrap();
        named(&at(name))
    };
    let first = save("mine.ron", 100.0);
    assert_eq!(save("mine.ron", 100.0), first, "the same edits, the same file");
    let second = save("mine.ron", 200.0);
    assert!(first.is_file(), "a preset that names it may be on its way");
    // A copy by hand names the second.
    std::fs::copy(at("mine.ron"), at("copy of mine.ron")).unwrap();
    // None is an edits file that a save of this preset has written.
    let others =
        ["mine.edits-photo.ron", "yours.edits-0123456789abcdef.ron", "mine.edits-0123456789abcdef.ron"].map(at);
    others.iter().for_each(|other| std::fs::write(other, "x").unwrap());
    others.iter().chain([&first, &second]).for_each(|file| make_old(file));
    let third = save("mine.ron", 300.0);
    assert!(!first.exists() && second.is_file() && third.is_file() && others.iter().all(|other| other.is_file()));
    assert!(Planet::load(at("copy of mine.ron")).unwrap() == sculpted(1500, 200.0));
    // Few edits need no file.
    make_old(&third);
    sculpted(2, 1.0).save(at("mine.ron")).unwrap();
    assert!(!third.exists() && second.is_file());
}

#[test]
fn what_is_wrong_with_an_edits_file_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let why = |edits: &str, file: &str| {
        std::fs::write(&path, format!("(\n  version: 3,\n  edits: {edits},\n  name: \"Mine\",\n)")).unwrap();
        std::fs::write(folder.path().join("e.ron"), file).unwrap();
        match Planet::load(&path) {
            Ok(_) => "loaded".to_owned(),
            Err(error) => error.to_string().replace(folder.path().to_str().unwrap(), ""),
        }
    };
    assert_eq!(why("\"e.ron\"", "(version: 3, edits: [(name: \"One\", points: [(1.0, 2.0)])])"), "loaded");
    let missing = why("\"gone.ron\"", "");
    assert!(missing.starts_with("/mine.ron:3:10: edits: gone.ron, which belongs beside the preset: "), "{missing}");
    for outside in ["\"../e.ron\"", "\"/tmp/e.ron\"", "\"e.txt\"", "\"C:e.ron\"", "\".e.ron\"", "\"\""] {
        let why = why(outside, "");
        assert!(why.starts_with("/mine.ron:3:10: edits: \"") && why.contains("is not the name of"), "{outside}: {why}");
    }
    let wrong = why("\"e.ron\"", "(version: 3, edits: [\n  (name: \"One\", radius_km: -1.0)])");
    assert!(wrong.starts_with("e.ron:2:") && wrong.contains("edits[0].radius_km"), "{wrong}");
    let broken = why("\"e.ron\"", "(version: 3, edits: [\n  (name: 3)])");
    assert!(broken.starts_with("e.ron:2:10: edits[0].name"), "{broken}");
    let more = why("\"e.ron\"", "(version: 3,\n edits: [], radius_km: 3.0)");
    assert_eq!(more, "e.ron:2:13: radius_km: a file of edits holds nothing else; move `radius_km` to the preset");
    let further = why("\"e.ron\"", "(version: 3, edits: \"e.ron\")");
    assert!(further.contains("e.ron names a further file"), "{further}");
    // Of the preset, at its place behind the name.
    std::fs::write(&path, "(version: 3, edits: \"e.ron\", radius_km: -1.0)").unwrap();
    std::fs::write(folder.path().join("e.ron"), "(version: 3, edits: [])").unwrap();
    let wrong = Planet::load(&path).unwrap_err().to_string();
    assert!(wrong.contains("mine.ron:1:41: radius_km"), "{wrong}");
}

#[test]
fn a_game_that_watches_a_preset_sees_its_edits_change() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    sculpted(1500, 100.0).save(&path).unwrap();
    let mut watch = PresetWatch::every(&path, Duration::ZERO);
    assert!(watch.poll().is_none());
    let mut news = || (0..2).find_map(|_| watch.poll()).map(Result::unwrap);
    sculpted(1500, 200.0).save(&path).unwrap();
    assert!(news().unwrap() == sculpted(1500, 200.0));
    // By hand, in the edits file alone.
    let edits = named(&path);
    let text = std::fs::read_to_string(&edits).unwrap().replacen("Stroke 7\"", "The seventh\"", 1);
    std::fs::write(&edits, text).unwrap();
    assert_eq!(news().unwrap().edits.get(7).unwrap().name, "The seventh");
    assert!(news().is_none());
}

#[cfg(unix)]
#[test]
fn edits_are_beside_the_preset_and_not_beside_a_link_to_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("planets")).unwrap();
    std::os::unix::fs::symlink("planets/real.ron", at("link.ron")).unwrap();
    let planet = sculpted(1500, 100.0);
    planet.save(at("link.ron")).unwrap();
    assert_eq!(names(folder.path()), ["link.ron", "planets"]);
    assert!(Planet::load(at("link.ron")).unwrap() == planet && Planet::load(at("planets/real.ron")).unwrap() == planet);
    // An edits file that cannot be written leaves the old preset.
    let before = std::fs::read(at("planets/real.ron")).unwrap();
    let other = sculpted(1500, 300.0);
    other.save(at("probe.ron")).unwrap();
    let digits = named(&at("probe.ron")).file_name().unwrap().to_string_lossy().replace("probe", "real");
    std::fs::create_dir(at("planets").join(digits)).unwrap();
    let why = other.save(at("link.ron")).unwrap_err().to_string();
    assert!(why.contains("real.edits-") && why.contains("is a folder"), "{why}");
    assert!(
        std::fs::read(at("planets/real.ron")).unwrap() == before && Planet::load(at("link.ron")).unwrap() == planet
    );
}
