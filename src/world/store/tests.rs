use super::*;
use crate::planet::{Plates, Rivers, Weather};
use crate::world::carved::Carved;
use crate::world::cells::Cells;
use crate::world::map::StructureInputs;
use crate::world::rivers::{Cache, LEVELS};
use crate::world::{Ground, KeepGoing, MapWork, World};
use std::sync::Arc;

/// A planet with a structure, without layers.
struct Bare(Inputs);

impl Ground for Bare {
    fn inputs(&self) -> &Inputs {
        &self.0
    }
    fn heights_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
        keep_going().then(|| vec![0.0; cells.dirs.len()])
    }
    fn under_m(&self, cells: &Cells, keep_going: &KeepGoing<'_>) -> Option<Vec<f64>> {
        self.heights_m(cells, keep_going)
    }
}

/// A planet whose rivers are solved on so many grids.
fn planet(grids: usize) -> Bare {
    let structure = StructureInputs {
        plates: Plates::default(),
        weather: Weather::default(),
        rivers: Rivers::default(),
        seed: 0,
        radius_km: 6371.0,
        equator_c: 28.0,
        pole_c: -28.0,
        lapse_c_per_km: 6.5,
    };
    let (heights, structure) = (Key::default(), Some(Arc::new(structure)));
    Bare(Inputs { heights, under: None, sea_level_m: Some(0.0), reads_coast: false, structure, sculpted: None, grids })
}

fn solved(store: &Arc<MapStore>, planet: &Bare) -> (World, MapWork) {
    finished(&World { store: Some(store.clone()), ..World::default() }, planet)
}

fn finished(world: &World, planet: &Bare) -> (World, MapWork) {
    let (mut world, mut work) = (world.serving(&planet.0), MapWork::default());
    while !world.is_final(&planet.0) {
        world = world.step(planet, &|| true, &mut work).unwrap();
    }
    (world, work)
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

fn carved(world: &World) -> &Carved {
    world.carved.map().unwrap()
}

/// Heights at a few places.
fn bits(carved: &Carved) -> Vec<u64> {
    let dirs: Vec<_> = Cells::of(12).dirs.iter().copied().step_by(61).collect();
    let mut points = Vec::new();
    carved.rivers.evaluate(&dirs, true, LEVELS, &mut Cache::default(), &mut points);
    assert!(points.iter().all(|point| point.height_m.is_finite()));
    points.iter().map(|point| point.height_m.to_bits()).collect()
}

#[test]
fn maps_are_solved_once_and_read_the_same_to_the_bit() {
    let folder = tempfile::tempdir().unwrap();
    let store = Arc::new(MapStore::new(folder.path().join("made"), u64::MAX));
    let (first, work) = solved(&store, &planet(1));
    assert_eq!((work.runs, work.reads), (3, 0), "plates, weather, rivers on one grid");
    assert_eq!(files(store.folder()).len(), 3, "the finest of each");
    let read_only = Arc::new(MapStore::read_only(store.folder()));
    let (second, work) = solved(&read_only, &planet(1));
    assert_eq!((work.runs, work.reads), (0, 3));
    assert_eq!(bits(carved(&first)), bits(carved(&second)));
    let [a, b] = [&first, &second].map(|world| &carved(world).drainage);
    assert!(a.height_m == b.height_m && a.receiver == b.receiver && a.discharge_m3_s == b.discharge_m3_s);
    assert!(a.lake == b.lake && a.lakes == b.lakes && a.is_sea == b.is_sea && a.order == b.order && a.seed == b.seed);
    assert!(!a.lakes.is_empty(), "the test planet has lakes");
    let dir = glam::DVec3::new(0.3, 0.5, 0.2).normalize();
    let [a, b] = [&first, &second].map(|world| world.weather.map().unwrap());
    assert_eq!((a.at(dir), a.rain_at(dir), a.wind_at(dir)), (b.at(dir), b.rain_at(dir), b.wind_at(dir)));
    // A finer answer cannot go on from what was read: it is solved from the start, and is the same as without a store.
    let (finer, work) = finished(&second, &planet(2));
    assert_eq!((work.runs, work.reads), (2, 0));
    assert_eq!(bits(carved(&finer)), bits(carved(&finished(&World::default(), &planet(2)).0)));
    assert_eq!(files(store.folder()).len(), 3, "nothing is written to a folder that is only read");
}

#[test]
fn a_damaged_file_counts_as_missing() {
    let folder = tempfile::tempdir().unwrap();
    let store = Arc::new(MapStore::new(folder.path(), u64::MAX));
    let planet = planet(1);
    let (first, _) = solved(&store, &planet);
    let path = files(folder.path()).into_iter().find(|path| path.to_string_lossy().contains("rivers")).unwrap();
    let good = fs::read(&path).unwrap();
    let mut flipped = good.clone();
    *flipped.last_mut().unwrap() ^= 1;
    let mut older = good.clone();
    older[MAGIC.len()] ^= 1;
    for bad in [&good[..good.len() - 1], &good[..20], &[], &flipped, &older] {
        fs::write(&path, bad).unwrap();
        let (again, work) = solved(&store, &planet);
        assert_eq!((work.runs, work.reads), (1, 2));
        assert_eq!(bits(carved(&first)), bits(carved(&again)));
        assert_eq!(fs::read(&path).unwrap(), good, "it is written anew");
    }
}

/// A file may be forged: its checksum is right, its numbers are not.
#[test]
fn forged_numbers_are_refused_or_harmless() {
    let folder = tempfile::tempdir().unwrap();
    let store = Arc::new(MapStore::new(folder.path(), u64::MAX));
    let planet = planet(1);
    solved(&store, &planet);
    let key = Key::of(&"forged");
    let content = |name: &str| {
        let path = files(folder.path()).into_iter().find(|path| path.to_string_lossy().contains(name)).unwrap();
        fs::read(path).unwrap()[HEADER..].to_vec()
    };
    let count = 6 * 64 * 64;
    let good = content("rivers");
    // The seed, a way to the neighbour at the left (of all cells: rings), an unknown way, a height that is no number,
    // each byte of the lists at the end.
    let mut bad: Vec<(usize, Vec<u8>)> = vec![(4, vec![3; count]), (4, vec![77; count]), (4 + count, vec![0xFF; 400])];
    bad.extend((1..200).step_by(3).map(|back| (good.len() - back, vec![0xFF])));
    let mut refused = 0;
    for (at, bytes) in bad {
        let mut forged = vec![0; HEADER];
        forged.extend_from_slice(&good);
        forged[HEADER + at..HEADER + at + bytes.len()].copy_from_slice(&bytes);
        fs::write(store.path("rivers", 64, key), with_header(forged, key)).unwrap();
        match store.read::<Carved>(&planet.0, 64, key) {
            None => refused += 1,
            Some(carved) => drop(bits(&carved)),
        }
    }
    assert!(refused >= 3, "{refused}");
}

/// A file of a hundred bytes that was last used so many hours ago.
fn old(path: &Path, begin: &[u8], hours: u64) {
    let mut bytes = begin.to_vec();
    bytes.resize(100, 0);
    fs::write(path, bytes).unwrap();
    let then = SystemTime::now() - std::time::Duration::from_secs(3600 * hours);
    fs::File::options().write(true).open(path).unwrap().set_modified(then).unwrap();
}

#[test]
fn the_maps_that_were_not_used_for_longest_are_deleted() {
    let folder = tempfile::tempdir().unwrap();
    let store = MapStore::new(folder.path(), 250);
    let [new, older, oldest] = ["new", "older", "oldest"].map(|key| store.path("rivers", 64, Key::of(&key)));
    for (hours, path) in [&new, &older, &oldest].into_iter().enumerate() {
        old(path, &MAGIC, hours as u64 + 1);
    }
    store.trim(250);
    let mut kept = [new.clone(), older];
    kept.sort();
    assert_eq!(files(folder.path()), kept);
    store.trim(10);
    assert_eq!(files(folder.path()), [new], "the newest map stays");
}

/// The folder may be one that its user has named: what the store has not written stays.
#[test]
fn files_of_others_are_not_deleted() {
    let folder = tempfile::tempdir().unwrap();
    let store = MapStore::new(folder.path(), 0);
    let own = |key: &str| store.path("rivers", 64, Key::of(&key));
    old(&own("newest"), &MAGIC, 1);
    // The endings of maps of games; a name like the store's own without its head; its head under another name.
    let others = ["quake.map", "small.map", "a letter.txt", "rivers_64_.map", "rivers_64_12ab.map", "Rivers_64_x.map"];
    for name in others {
        old(&folder.path().join(name), &MAGIC, 9);
    }
    old(&own("of another program"), b"IBSP", 9);
    fs::write(own("empty"), "").unwrap();
    fs::create_dir(own("folder")).unwrap();
    #[cfg(unix)]
    {
        let outside = tempfile::tempdir().unwrap().keep();
        old(&outside.join("map"), &MAGIC, 9);
        std::os::unix::fs::symlink(outside.join("map"), own("link")).unwrap();
    }
    let before = files(folder.path());
    store.trim(0);
    assert_eq!(files(folder.path()), before);
    old(&own("used by nobody"), &MAGIC, 9);
    store.trim(0);
    assert_eq!(files(folder.path()), before, "a map of the store's own goes");
}

#[test]
fn names_of_maps_are_told_from_others() {
    let path = MapStore::new("maps", 0).path("plates", 256, Key::of(&"some"));
    let own = path.file_name().unwrap().to_string_lossy().into_owned();
    assert!(is_own_name(&own));
    for other in [
        own.to_uppercase(),
        own.replace('_', "-"),
        format!("x{own}x"),
        own.replace(".map", "map"),
        own.replace("256", ""),
    ] {
        assert!(!is_own_name(&other), "{other}");
    }
}

/// A link in the folder was put there by somebody else: its target stays as it is.
#[cfg(unix)]
#[test]
fn a_link_in_the_place_of_a_map_is_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let [maps, precious] = ["maps", "precious"].map(|name| folder.path().join(name));
    let store = Arc::new(MapStore::new(&maps, u64::MAX));
    solved(&store, &planet(1));
    let whole = files(&maps);
    for path in &whole {
        fs::remove_file(path).unwrap();
        fs::write(&precious, "precious").unwrap();
        std::os::unix::fs::symlink(&precious, path).unwrap();
    }
    let (_, work) = solved(&store, &planet(1));
    assert_eq!((work.runs, work.reads), (3, 0));
    assert_eq!(fs::read(&precious).unwrap(), b"precious");
    assert!(files(&maps) == whole && whole.iter().all(|path| !path.is_symlink()));
    assert_eq!(store.take_problem(), None);
}

/// Neither a pipe, at which a reader would wait for ever, nor a device, which never ends.
#[cfg(unix)]
#[test]
fn pipes_and_devices_in_the_place_of_maps_count_as_missing() {
    let folder = tempfile::tempdir().unwrap();
    let store = Arc::new(MapStore::new(folder.path(), u64::MAX));
    solved(&store, &planet(1));
    let whole = files(folder.path());
    for path in &whole {
        fs::remove_file(path).unwrap();
    }
    std::os::unix::fs::symlink("/dev/zero", &whole[0]).unwrap();
    for path in &whole[1..] {
        assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    }
    let (_, work) = solved(&store, &planet(1));
    assert_eq!((work.runs, work.reads), (3, 0));
}

#[test]
fn a_folder_that_cannot_be_made_is_told_once() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let store = Arc::new(MapStore::new(file.join("maps"), u64::MAX));
    let (_, work) = solved(&store, &planet(1));
    assert_eq!(work.runs, 3);
    assert!(store.take_problem().is_some_and(|problem| problem.contains("maps")));
    assert!(store.take_problem().is_none());
}

/// If this fails, the solvers answer differently than they did when [`GROUND_VERSION`] was set: increase it, so that
/// maps that are kept on disk are solved anew.
#[test]
fn the_version_is_that_of_the_solvers() {
    let (world, _) = solved(&Arc::new(MapStore::read_only("nowhere")), &planet(1));
    let (mut writer, drainage) = (Writer::default(), &carved(&world).drainage);
    drainage.write(&mut writer);
    assert_eq!((GROUND_VERSION, checksum(&writer.0)), (5, 11_380_867_053_499_869_774));
}
