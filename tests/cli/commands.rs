//! The command line, run as a process: answers, messages, exit status.

use crate::LAYERED;
use assert_cmd::Command;
use std::path::{Path, PathBuf};
use tellus::lod::{Camera, opening, scout};
use tellus::planet::Planet;

const AUREL: &str = "planets/aurel.ron";

fn tellus(args: &[&str]) -> Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    // Without the maps of other runs.
    command.env("TELLUS_MAPS", "").current_dir(env!("CARGO_MANIFEST_DIR")).args(args);
    command
}

/// Runs the program. Gives exit status, standard output and standard error.
fn run(args: &[&str]) -> (i32, String, String) {
    let output = tellus(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

fn text_of(path: &Path) -> &str {
    path.to_str().unwrap()
}

fn broken(folder: &tempfile::TempDir) -> PathBuf {
    let path = folder.path().join("broken.ron");
    std::fs::write(&path, "(\n version: 1,\n radius_km: 0,\n layers: [(shape: Fbm(octaves: 99))],\n)").unwrap();
    path
}

#[test]
fn wrong_usage_is_status_2_and_says_what_would_be_right() {
    for (args, part) in [
        (vec!["render"], "--output <OUT.png|OUT.exr>"),
        (vec!["render", LAYERED], "--output <OUT.png|OUT.exr>"),
        (vec!["render", LAYERED, "-o", "x.png", "--size", "0x9"], "each 1 to 32768, such as 1280x720"),
        (vec!["render", LAYERED, "-o", "x.png", "--samples", "40"], "use 1 to 16"),
        (vec!["render", LAYERED, "-o", "x.png", "--ground-seconds", "-1"], "use 0 to 1000000"),
        (vec!["render", LAYERED, "-o", "x.png", "--ground-mib", "8"], "use 16 to 65536, in MiB"),
        (vec!["render", LAYERED, "-o", "x.png", "--white", "500"], "use 2000 to 25000"),
        (vec!["render", LAYERED, "-o", "x.png", "--vignette", "2"], "use 0 to 1"),
        (vec!["render", LAYERED, "-o", "x.png", "--aperture", "1"], "--focus <METRES>"),
        (vec!["render", LAYERED, "-o", "x.png", "--fov", "50", "--focal", "50"], "cannot be used with"),
        (vec!["render", LAYERED, "-o", "x.png", "--lat", "91"], "91 is out of range; use -90 to 90"),
        (vec!["render", LAYERED, "-o", "x.png", "--sun", "5"], "write LAT,LON such as 20,-45"),
        (vec!["render", LAYERED, "-o", "x.png", "--view", "nice"], "possible values: shaded, height"),
        (vec!["render", LAYERED, "-o", "x.png", "--quality", "best"], "possible values: low, medium, high"),
        (vec!["render", LAYERED, "-o", "x.png", "--altitude", "0"], "0 is on the surface; use 0.1 or more"),
        (vec!["film", LAYERED, "-o", "x.png", "--fps", "0"], "0 is out of range; use 1 to 240"),
        (vec!["film", LAYERED, "-o", "x.png", "--seconds", "-1"], "-1 is out of range; use 0 to 3600"),
        (vec!["film", LAYERED, "-o", "x.png", "--seconds", "4000"], "use 0 to 3600"),
        (vec!["check"], "<FILE.ron>"),
        (vec!["sample", LAYERED, "--lat", "1"], "--lon <DEG>"),
        (vec!["new", "-o", "x.ron", "--seed", "x"], "this is not a whole number; use 0 to"),
        (vec!["sample", LAYERED, "--lat", "1e300", "--lon", "0"], "1e300 is out of range; use -90 to 90"),
        (vec!["bench", "--fast"], "unexpected argument"),
        (vec!["--nonsense"], "unexpected argument"),
    ] {
        let (status, out, err) = run(&args);
        assert!(status == 2 && out.is_empty() && err.starts_with("error: ") && err.contains(part), "{args:?}: {err}");
    }
}

#[test]
fn help_and_version_are_no_errors() {
    let (status, out, err) = run(&["--help"]);
    assert!(status == 0 && err.is_empty() && out.contains("render") && out.contains("bench"), "{out}{err}");
    let (status, out, _) = run(&["--version"]);
    assert_eq!((status, out.trim()), (0, concat!("tellus ", env!("CARGO_PKG_VERSION"))));
}

/// A negative number is the value of its option, which says its range.
#[test]
fn negative_values_hear_the_range_of_their_option() {
    let mut asked = 0;
    for command in [
        "render",
        "film",
        "sample",
        "nearest",
        "bake",
        "mesh",
        "tiles",
        "rivers",
        "coasts",
        "instances",
        "sky",
        "system",
        "new",
    ] {
        let (_, help, _) = run(&[command, "--help"]);
        let names = help.lines().filter_map(|line| line.trim_start().strip_prefix("--"));
        let names: Vec<&str> = names
            .filter_map(|line| line.split_once(" <"))
            .filter(|(_, rest)| {
                ["DEG", "METRES", "KILOMETRES", "N", "PIXELS", "SECONDS", "SHARE", "FACTOR", "WxH", "MM"]
                    .iter()
                    .any(|value| rest.starts_with(&format!("{value}>")))
            })
            .map(|(name, _)| name)
            .collect();
        for name in names {
            asked += 1;
            let (status, _, err) = run(&[command, &format!("--{name}"), "-1e300"]);
            let says = err.contains("use ") || err.contains("; write ");
            assert!(status == 2 && says && !err.contains("unexpected argument"), "{command} --{name}: {err}");
            assert!(err.len() < 400, "{command} --{name}: {err}");
        }
    }
    assert!(asked > 40, "{asked}");
}

/// What cannot be printed is an error; a reader who has seen enough is none.
#[cfg(target_os = "linux")]
#[test]
fn output_that_cannot_be_written_is_an_error() {
    for args in [&["--help"][..], &["--version"], &["render", "--help"], &["check", AUREL]] {
        let full = std::fs::File::options().write(true).open("/dev/full").unwrap();
        let mut command = std::process::Command::new(assert_cmd::cargo::cargo_bin!("tellus"));
        command.args(args).current_dir(env!("CARGO_MANIFEST_DIR")).stdout(full);
        let output = command.output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        let is_said = told.starts_with("error: cannot write to standard output: No space left");
        assert!(output.status.code() == Some(1) && is_said, "{args:?}: {:?} {told}", output.status);
    }
}

/// The help states the opening view of the code.
#[test]
fn help_states_the_defaults_of_the_code() {
    let (status, out, _) = run(&["render", "--help"]);
    assert_eq!(status, 0);
    let help = out.split_whitespace().collect::<Vec<_>>().join(" ");
    let fov_deg = Camera::DEFAULT_FOV_Y_RAD.to_degrees();
    for default in [
        format!("[default: {}]", opening::OPENING_LAT_DEG),
        format!("[default: {} east of the star]", opening::OPENING_LON_FROM_STAR_DEG),
        format!("[default: {fov_deg:.0}]"),
    ] {
        assert!(help.contains(&default), "{default}: {help}");
    }
}

#[test]
fn check_names_every_problem_of_every_file() {
    let folder = folder();
    let broken = broken(&folder);
    let file = text_of(&broken);
    let (status, out, err) = run(&["check", file, AUREL]);
    assert_eq!((status, out.as_str()), (1, "planets/aurel.ron: valid\n"));
    assert_eq!(
        err,
        format!(
            "{file}:3:13: radius_km: 0 is out of range; use 1 to 100000 km\n\
             {file}:4:32: layers[0].shape.octaves: 99 is out of range; use 1 to 24\n"
        )
    );
    let (status, out, err) = run(&["check", AUREL]);
    assert_eq!((status, out.as_str(), err.as_str()), (0, "planets/aurel.ron: valid\n", ""));
}

#[test]
fn a_wrong_preset_is_status_1_everywhere() {
    let folder = folder();
    let broken = broken(&folder);
    let output = folder.path().join("out");
    let (file, output) = (text_of(&broken), text_of(&output));
    for args in [
        vec![file],
        vec!["render", file, "-o", output],
        vec!["sample", file, "--lat", "0", "--lon", "0"],
        vec!["new", "-o", &format!("{output}.ron"), "--from", file],
    ] {
        let (status, _, err) = run(&args);
        assert!(status == 1 && err.starts_with(&format!("error: {file}:3:13: radius_km: ")), "{args:?}: {err}");
        assert!(!Path::new(output).exists());
    }
    let (status, _, err) = run(&["sample", "no.ron", "--lat", "0", "--lon", "0"]);
    assert!(status == 1 && err.starts_with("error: no.ron: "), "{err}");
}

#[test]
fn a_new_planet_needs_a_folder_and_a_name_that_ends_in_ron() {
    let folder = folder();
    for (name, part) in
        [("no/such/folder/new.ron", "there is no folder"), ("new.txt", "ends in .ron, such as new.txt.ron")]
    {
        let path = folder.path().join(name);
        let (status, _, err) = run(&[text_of(&path)]);
        assert!(status == 1 && err.contains(part), "{name}: {err}");
    }
    // Without a display the editor cannot open, but the error is not about the file name.
    let path = folder.path().join("new.ron");
    let output = tellus(&[text_of(&path)]).env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").output().unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert!(err.contains("the window could not be opened"), "{err}");
}

#[test]
fn sample_answers_people_and_machines() {
    let (status, out, err) = run(&["sample", LAYERED, "--lat", "-33.5", "--lon", "-70", "--json"]);
    assert_eq!((status, err.as_str()), (0, ""));
    let answer: serde_json::Value = serde_json::from_str(&out).unwrap();
    let planet = Planet::load(Path::new(env!("CARGO_MANIFEST_DIR")).join(LAYERED)).unwrap();
    for key in ["height_m", "slope_deg", "temperature_c", "temperature", "precipitation_mm", "moisture"] {
        assert!(answer[key].is_number(), "{key}: {answer}");
    }
    assert_eq!(answer["normal"].as_array().unwrap().len(), 3);
    assert!(planet.biomes.palette.iter().any(|biome| answer["biome"] == biome.name.as_str()), "{answer}");
    for layer in answer["layers"].as_array().unwrap() {
        assert!(layer["name"].is_string() && layer["height_m"].is_number(), "{layer}");
    }
    let (status, out, _) = run(&["sample", LAYERED, "--lat", "-33.5", "--lon", "-70"]);
    assert!(status == 0 && out.contains("height") && out.contains(" m\n"), "{out}");
}

#[test]
fn sky_says_the_same_by_physics_and_by_shaders() {
    let air = "tests/fixtures/earth_air.ron";
    let ask = |more: &[&str]| {
        let args = ["sky", air, "--sun-zenith", "60", "--view-zenith", "0", "--json"];
        let (status, out, err) = run(&[&args, more].concat());
        assert_eq!(status, 0, "{err}");
        let answer: serde_json::Value = serde_json::from_str(&out).unwrap();
        let rgb = |key: &str| -> [f64; 3] { std::array::from_fn(|i| answer[key][i].as_f64().unwrap()) };
        [rgb("transmittance"), rgb("radiance")]
    };
    let near = |a: [f64; 3], b: [f64; 3], share: f64| a.iter().zip(b).all(|(a, b)| (a - b).abs() <= share * b);
    let [through, radiance] = ask(&[]);
    assert!(near(through, [0.88478, 0.75386, 0.58228], 0.003), "{through:?}");
    // The method is known to be 5% brighter here than path tracing: see the tests of the atmosphere.
    assert!(near(radiance, [0.00459, 0.00992, 0.02376], 0.06), "{radiance:?}");
    let [drawn_through, drawn] = ask(&["--gpu"]);
    assert!(near(drawn_through, through, 0.02) && near(drawn, radiance, 0.02), "{drawn_through:?} {drawn:?}");
    let (status, out, _) = run(&["sky", air, "--sun-zenith", "90", "--view-zenith", "80", "--azimuth", "-30"]);
    assert!(status == 0 && out.contains("transmittance  0.106") && out.contains("radiance"), "{out}");
    let (status, _, err) = run(&["sky", air, "--sun-zenith", "190", "--view-zenith", "0"]);
    assert!(status == 2 && err.contains("use 0 to 180"), "{err}");
}

#[test]
fn new_writes_valid_planets_that_their_seed_repeats() {
    let folder = folder();
    let paths = ["a.ron", "b.ron", "c.ron"].map(|name| folder.path().join(name));
    let [a, b, c] = paths.each_ref().map(|path| text_of(path));
    let read = |path: &str| std::fs::read_to_string(path).unwrap();
    assert_eq!(run(&["new", "-o", a, "--seed", "7"]).0, 0);
    assert_eq!(run(&["new", "-o", b, "--seed", "7"]).0, 0);
    assert_eq!(read(a), read(b));
    assert_eq!(Planet::load(a).unwrap(), scout::random_planet(None, 7));

    assert_eq!(run(&["new", "-o", b, "--seed", "7", "--from", LAYERED, "--force"]).0, 0);
    assert_ne!(read(a), read(b));
    assert_eq!(run(&["check", a, b]).0, 0);

    let (status, out, _) = run(&["new", "-o", c]);
    assert!(status == 0 && out.contains("seed "), "{out}");
    let (status, _, err) = run(&["new", "-o", "no/such/folder/x.ron"]);
    assert!(status == 1 && err.contains("there is no folder"), "{err}");
}

#[test]
fn render_writes_the_same_picture_for_the_same_command() {
    let folder = folder();
    let paths = ["a.png", "b.png"].map(|name| folder.path().join(name));
    for path in &paths {
        let args = [
            "render",
            LAYERED,
            "-o",
            text_of(path),
            "--size",
            "161x90",
            "--lat",
            "-10",
            "--lon",
            "-20",
            "--altitude",
            "3000000",
            "--heading",
            "-30",
            "--pitch",
            "-80",
            "--fov",
            "40",
            "--sun",
            "-5,10",
            "--time",
            "60",
            "--exposure",
            "-0.5",
            "--quality",
            "low",
            "--view",
            "shaded",
        ];
        let (status, _, err) = run(&args);
        assert!(status == 0, "{err}");
    }
    let [a, b] = paths.map(|path| std::fs::read(path).unwrap());
    assert!(a == b, "the same command drew two pictures");
    let picture = image::load_from_memory(&a).unwrap();
    assert_eq!((picture.width(), picture.height()), (161, 90));
}

#[test]
fn render_needs_little_to_be_told_and_cannot_write_everywhere() {
    let folder = folder();
    let path = folder.path().join("a.png");
    let small = ["render", LAYERED, "-o", text_of(&path), "--size", "64x36", "--quality", "low"];
    let (status, _, err) = run(&[&small[..], &["--ground-seconds", "0"]].concat());
    assert!(status == 0 && err.starts_with("warning: the ground is coarser than the picture shows"), "{err}");
    let (status, _, err) = run(&[&small[..], &["--ground-mib", "16"]].concat());
    assert!(status == 0 && err.is_empty(), "{err}");
    let (status, _, err) = run(&small);
    assert!(status == 0, "{err}");
    let (status, _, err) =
        run(&["render", LAYERED, "-o", "no/such/folder/x.png", "--size", "16x9", "--quality", "low"]);
    assert!(status == 1 && err.contains("there is no folder"), "{err}");
}

/// OpenGL draws to too few formats. Whether the machine has it or not, one sentence says what would be right.
#[test]
fn without_a_driver_that_will_do_one_sentence_says_what_to_install() {
    let folder = folder();
    let picture = folder.path().join("picture.png");
    let output = tellus(&["render", "planets/pallor.ron", "--size", "16x9", "-o", text_of(&picture)])
        .env("WGPU_BACKEND", "gl")
        .env_remove("WGPU_ADAPTER_NAME")
        .output()
        .unwrap();
    let err = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(1), "{err}");
    assert!(err.contains("mesa-vulkan-drivers") && !err.contains("renderable") && !picture.exists(), "{err}");
}

#[test]
fn a_gpu_that_is_not_there_is_named() {
    let output = tellus(&["render", LAYERED, "-o", "never.png", "--size", "16x9"])
        .env("WGPU_ADAPTER_NAME", "no such adapter")
        .output()
        .unwrap();
    let err = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(1));
    assert!(err.contains("error: no GPU is called like WGPU_ADAPTER_NAME=no such adapter"), "{err}");
}

#[cfg(unix)]
#[test]
fn a_reader_that_goes_away_is_no_failure() {
    use std::process::{Command, Stdio};
    let mut child = Command::new(env!("CARGO_BIN_EXE_tellus"))
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .args(["check", AUREL, AUREL, AUREL])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), b"".as_slice()));
}

/// The camera may be under water, but not under the sea bed.
#[test]
fn a_map_of_a_structure_is_refused_where_there_is_none() {
    let folder = folder();
    let picture = folder.path().join("plates.png");
    let (status, _, err) = run(&["render", LAYERED, "-o", text_of(&picture), "--view", "plates"]);
    assert!(status == 1 && err.contains("no structure") && err.contains("Plates"), "{err}");
    let (status, _, err) = run(&["render", LAYERED, "-o", text_of(&picture), "--view", "density"]);
    assert!(status == 1 && err.contains("nothing stands on the planet"), "{err}");
    let density = ["render", AUREL, "-o", text_of(&picture), "--view", "density", "--population", "Oaks"];
    let (status, _, err) = run(&density);
    assert!(status == 1 && err.contains("there is no population `Oaks`; use one of Rain forest trees,"), "{err}");
    let (status, _, err) = run(&["render", AUREL, "-o", text_of(&picture), "--population", "Reeds"]);
    assert!(status == 1 && err.contains("use it with --view density"), "{err}");
    assert!(!picture.exists());
}

#[test]
fn altitude_goes_below_the_sea() {
    let folder = folder();
    let picture = folder.path().join("deep.png");
    let shot = |lat: &str, lon: &str, altitude: &str| {
        let place = ["--lat", lat, "--lon", lon, "--altitude", altitude, "--size", "32x20", "--quality", "low"];
        run(&[&["render", LAYERED, "-o", text_of(&picture)][..], &place].concat())
    };
    // In the deep sea, below the sea bed, and on land.
    let (status, _, err) = shot("15", "45", "-30");
    assert!(status == 0 && picture.exists(), "{err}");
    let (status, _, err) = shot("15", "45", "-9000");
    assert!(status == 1 && err.contains("m deep there; use -"), "{err}");
    let (status, _, err) = shot("13", "-6", "-5");
    assert!(status == 1 && err.contains("there is no water there; use 0.1 or more"), "{err}");
}

#[test]
fn altitude_goes_into_a_giant_as_far_as_there_is_light() {
    let folder = folder();
    let (preset, picture) = (folder.path().join("giant.ron"), folder.path().join("deep.png"));
    std::fs::write(&preset, "(version: 3, radius_km: 58000.0, giant: ())").unwrap();
    let shot = |altitude: &str| {
        let args = ["render", text_of(&preset), "-o", text_of(&picture), "--size", "32x20", "--quality", "low"];
        run(&[&args[..], &["--altitude", altitude]].concat())
    };
    let (status, _, err) = shot("-300000");
    assert!(status == 0 && picture.exists(), "{err}");
    let (status, _, err) = shot("-300001");
    assert!(status == 2 && err.contains("use -300000 to"), "{err}");
}

/// A film has a frame for each moment; frames that are whole and its own stay when it is resumed.
#[test]
fn a_film_is_numbered_frames() {
    let folder = tempfile::tempdir().unwrap();
    let (preset, film) = (folder.path().join("p.ron"), folder.path().join("way.png"));
    let place =
        |name: &str, lat: f64| format!("(name: {name:?}, latitude_deg: {lat:.1}, altitude_m: 9e6, pitch_deg: -90.0)");
    let text = |bookmarks: &str| format!("(version: 3, radius_km: 3000.0, editor: (bookmarks: [{bookmarks}]))");
    std::fs::write(&preset, text(&[place("A", 0.0), place("B", 40.0)].join(", "))).unwrap();
    let args = ["film", text_of(&preset), "-o", text_of(&film), "--size", "48x27", "--quality", "low", "--fps", "3"];
    let (status, out, err) = run(&[&args[..], &["--seconds", "1"]].concat());
    assert!(status == 0 && out.is_empty() && err.is_empty(), "{out}{err}");
    let frames: Vec<PathBuf> = (1..4).map(|n| folder.path().join(format!("way-000{n}.png"))).collect();
    let before: Vec<Vec<u8>> = frames.iter().map(|frame| std::fs::read(frame).unwrap()).collect();
    assert!(before[0] != before[1] && before[1] != before[2]);
    assert!(!folder.path().join("way-0004.png").exists());
    let resume = |more: &[&str]| {
        let (status, out, err) = run(&[&args[..], &["--seconds", "1", "--resume"], more].concat());
        assert!(status == 0 && out.is_empty(), "{out}{err}");
        err
    };
    assert!(resume(&[]).contains("all frames are there already"));
    // Frames that are damaged, cut off, empty, missing, of other content or of another size are drawn again; others
    // stay.
    let written = |frame: &Path| std::fs::metadata(frame).unwrap().modified().unwrap();
    let kept = written(&frames[2]);
    let mut damaged = before[0].clone();
    let middle = damaged.len() / 2;
    damaged[middle] ^= 8;
    for bytes in [&damaged[..], &before[0][..middle], b"", &before[1]] {
        std::fs::write(&frames[0], bytes).unwrap();
        std::fs::remove_file(&frames[1]).unwrap();
        assert_eq!(resume(&[]), "");
        assert!(std::fs::read(&frames[0]).unwrap() == before[0] && std::fs::read(&frames[1]).unwrap() == before[1]);
    }
    assert_eq!(written(&frames[2]), kept);
    assert_eq!(resume(&["--exposure", "1"]), "");
    assert!(std::fs::read(&frames[2]).unwrap() != before[2]);
    assert_eq!(resume(&[]), "");
    assert!(std::fs::read(&frames[2]).unwrap() == before[2]);
    let (status, _, err) = run(&[&args[..], &["--over", "A,C"]].concat());
    assert!(status == 1 && err.contains("there is no bookmark \"C\"; there is: A, B"), "{err}");
    let (status, _, err) = run(&["film", LAYERED, "-o", text_of(&film)]);
    assert!(status == 1 && err.contains("the planet has no bookmarks to fly over"), "{err}");

    // Over a body of a system: its star stands elsewhere.
    let (system, other) = (folder.path().join("s.ron"), folder.path().join("other.png"));
    let bodies = "(name: \"S\", mass_earths: 3e5, light: ()), \
                  (name: \"P\", preset: \"p.ron\", parent: \"S\", mass_earths: 0.1, orbit: (anomaly_deg: 140.0))";
    std::fs::write(&system, format!("(version: 1, name: \"Small\", bodies: [{bodies}])")).unwrap();
    let film = |body| {
        let args = ["film", text_of(&system), "--body", body, "-o", text_of(&other), "--size", "48x27", "--fps", "2"];
        run(&[&args[..], &["--quality", "low", "--seconds", "1"]].concat())
    };
    let (status, _, err) = film("P");
    assert_eq!((status, err.as_str()), (0, ""));
    let first = std::fs::read(folder.path().join("other-0001.png")).unwrap();
    assert!(first != before[0] && folder.path().join("other-0002.png").exists());
    let (status, _, err) = film("Q");
    assert!(status == 1 && err.contains("there is no body \"Q\"; there is: S, P"), "{err}");
}

#[cfg(unix)]
#[test]
fn names_of_files_cannot_command_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("\u{1b}[31mred\u{7}.ron");
    std::fs::write(&path, "(version: 3, radius_km: -1.0)").unwrap();
    for args in [["check"], ["sample"], ["render"]] {
        let more = if args == ["check"] { &[][..] } else { &["--lat", "0", "--lon", "0"] };
        let more = if args == ["render"] { &["-o", "out.png"] } else { more };
        let output = assert_cmd::cargo::cargo_bin_cmd!("tellus").args(args).arg(&path).args(more).output().unwrap();
        let said = [output.stdout, output.stderr].concat();
        assert_eq!(output.status.code(), Some(1));
        assert!(!said.is_empty() && said.iter().all(|&byte| byte >= b' ' || byte == b'\n'), "{said:?}");
        assert!(String::from_utf8(said).unwrap().contains("\\u{1b}[31mred\\u{7}.ron"));
    }
}
