//! A program that is killed while it saves leaves the old file or the new one, and nothing beside it but what the next
//! save does not trip over.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tellus::planet::{Planet, random};

/// Tells the program of this test to save again and again to the file of this name.
const SAVES_TO: &str = "TELLUS_TEST_SAVES_TO";
const KILLS: u64 = 200;

/// Of planets whose edits are in a file beside the preset.
const KILLS_WITH_EDITS: u64 = 40;

fn planets() -> [Planet; 2] {
    [random::random(1), random::random(2)]
}

fn sculpted() -> [Planet; 2] {
    [100.0, 200.0].map(|amount_m| crate::beside::sculpted(1200, amount_m))
}

/// What the killed program does; without the variable it is no test.
#[test]
fn saves_until_it_is_killed() {
    let Some(path) = std::env::var_os(SAVES_TO) else { return };
    let is_sculpted = Path::new(&path).ends_with("sculpted.ron");
    let planets = if is_sculpted { sculpted() } else { planets() };
    let begun = Instant::now();
    while begun.elapsed() < Duration::from_secs(20) {
        planets.iter().for_each(|planet| planet.save(&path).unwrap());
    }
}

fn save_and_kill(path: &Path, after: Duration) {
    let mut program = Command::new(std::env::current_exe().unwrap());
    program.args(["--exact", "saving::saves_until_it_is_killed"]).env(SAVES_TO, path);
    let mut running = program.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let before = std::fs::read(path).unwrap();
    // Killed somewhere in a save, not before the first.
    let begun = Instant::now();
    while std::fs::read(path).unwrap() == before && begun.elapsed() < Duration::from_secs(10) {
        std::thread::sleep(Duration::from_micros(200));
    }
    std::thread::sleep(after);
    running.kill().unwrap();
    running.wait().unwrap();
}

#[test]
fn a_killed_save_leaves_the_old_file_or_the_new_one() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("planet.ron");
    let texts = planets().map(|planet| planet.to_text());
    Planet::default().save(&path).unwrap();
    let mut seen = [0; 2];
    for number in 0..KILLS {
        save_and_kill(&path, Duration::from_micros(number * 7919 % 9000));
        let found = std::fs::read_to_string(&path).unwrap();
        let which = texts.iter().position(|text| *text == found);
        seen[which.unwrap_or_else(|| panic!("kill {number}: neither file, {} bytes", found.len()))] += 1;
        // The next round begins with a file that neither save wrote.
        Planet::default().save(&path).unwrap();
    }
    assert!(seen[0] > 20 && seen[1] > 20, "{seen:?}: the moments are not random");
    println!("counted: {KILLS} kills while saving; the file of either planet: {seen:?}");
}

#[test]
fn a_killed_save_leaves_a_preset_with_its_own_edits() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sculpted.ron");
    let planets = sculpted();
    let mut seen = [0; 2];
    for number in 0..KILLS_WITH_EDITS {
        // The next round begins with a file that neither save wrote.
        Planet::default().save(&path).unwrap();
        save_and_kill(&path, Duration::from_micros(number * 7919 % 150_000));
        let found = Planet::load(&path).unwrap_or_else(|error| panic!("kill {number}: {error}"));
        let which = planets.iter().position(|planet| *planet == found);
        seen[which.unwrap_or_else(|| panic!("kill {number}: neither planet"))] += 1;
    }
    assert!(seen.iter().all(|seen| *seen > 3), "{seen:?}: the moments are not random");
    println!("counted: {KILLS_WITH_EDITS} kills while saving two files; either planet: {seen:?}");
}

#[test]
fn unfinished_files_of_killed_writers_are_swept() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let hours_ago = std::time::SystemTime::now() - Duration::from_secs(2 * 3600);
    for (name, is_old) in [
        (".tellus-oLd001.tmp", true),
        (".tellus-new001.tmp", false),
        (".tellus-notes.tmp", true),
        (".other-old001.tmp", true),
    ] {
        std::fs::write(at(name), "half a planet").unwrap();
        if is_old {
            std::fs::File::options().write(true).open(at(name)).unwrap().set_modified(hours_ago).unwrap();
        }
    }
    Planet::default().save(at("planet.ron")).unwrap();
    let mut names: Vec<_> = std::fs::read_dir(folder.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort();
    // A writer may be at work on the new one.
    assert_eq!(names, [".other-old001.tmp", ".tellus-new001.tmp", ".tellus-notes.tmp", "planet.ron"]);
}

#[cfg(unix)]
#[test]
fn a_link_whose_target_is_missing_stays_a_link() {
    use std::os::unix::fs::symlink;
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::create_dir(at("planets")).unwrap();
    symlink("planets/real.ron", at("second.ron")).unwrap();
    symlink("second.ron", at("first.ron")).unwrap();
    Planet::default().save(at("first.ron")).unwrap();
    assert!(std::fs::symlink_metadata(at("first.ron")).unwrap().is_symlink());
    assert!(std::fs::symlink_metadata(at("planets/real.ron")).unwrap().is_file());
    // A folder that is not there is not made.
    symlink("none/real.ron", at("lost.ron")).unwrap();
    let error = Planet::default().save(at("lost.ron")).unwrap_err().to_string();
    assert!(error.contains("there is no folder") && error.contains("none"), "{error}");
    // A circle.
    symlink("b.ron", at("a.ron")).unwrap();
    symlink("a.ron", at("b.ron")).unwrap();
    assert!(Planet::default().save(at("a.ron")).is_err());
}
