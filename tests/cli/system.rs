//! `tellus system`, and system files in `check` and `render`.

use std::path::Path;

fn run(args: &[&str]) -> (i32, String, String) {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    command.env("TELLUS_MAPS", "").current_dir(env!("CARGO_MANIFEST_DIR")).args(args);
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

const STAR: &str = "(name: \"Sun\", mass_earths: 332946.0, light: ())";

/// A system with these bodies beside a star, and the presets of two small planets.
fn written(folder: &Path, bodies: &str) -> String {
    for name in ["one", "two"] {
        std::fs::write(folder.join(format!("{name}.ron")), "(version: 3, radius_km: 6371.0)").unwrap();
    }
    let path = folder.join("system.ron");
    std::fs::write(&path, format!("(\n    version: 1,\n    bodies: [\n        {STAR},\n{bodies}\n    ],\n)")).unwrap();
    path.to_str().unwrap().to_owned()
}

#[test]
fn bodies_are_listed_with_their_orbits() {
    let (status, out, err) = run(&["system", "systems/hearth.ron", "--time", "86400"]);
    assert_eq!((status, err.as_str()), (0, ""));
    let moon = out.lines().find(|line| line.trim_start().starts_with("Pallor")).unwrap();
    assert!(moon.contains("from Aurel") && moon.contains("period 27.") && moon.contains("Aurel over"), "{moon}");
    assert!(!out.contains("warning"), "{out}");
}

#[test]
fn a_trial_tells_whether_a_system_lasts() {
    let (status, out, _) = run(&["system", "systems/hearth.ron", "--trial", "0.5"]);
    assert!(status == 0 && out.contains("no encounter") && out.contains("energy error at most"), "{out}");
    let folder = tempfile::tempdir().unwrap();
    // A moon far outside the Hill sphere.
    let file = written(
        folder.path(),
        "(name: \"One\", preset: \"one.ron\", parent: \"Sun\", orbit: ()),\n\
         (name: \"Moon\", preset: \"two.ron\", parent: \"One\", mass_earths: 0.01, orbit: (semi_major_km: 2.5e6)),",
    );
    let (status, out, _) = run(&["system", &file, "--trial", "3", "--scheme", "verlet", "--step", "6"]);
    assert!(status == 0 && out.contains("(Hill)") && out.contains("Moon leaves One"), "{out}");
    // A step that does not suit is wrong input, and nothing else is said.
    let (status, out, err) = run(&["system", "systems/hearth.ron", "--trial", "1", "--step", "2000"]);
    assert!(status == 1 && out.is_empty() && err.contains("too long for the orbit of Hoarfrost; use "), "{out}{err}");
    let (status, _, err) = run(&["system", "systems/hearth.ron", "--trial", "1e6"]);
    assert!(status == 1 && err.contains("the orbit of Hoarfrost is short; use at most "), "{err}");
    // The longest Verlet step that is taken loses too much energy on a long ellipse.
    let file = written(
        folder.path(),
        "(name: \"One\", preset: \"one.ron\", parent: \"Sun\", orbit: (eccentricity: 0.9, anomaly_deg: 180.0)),",
    );
    let coarse = ["system", &file, "--trial", "2", "--scheme", "verlet", "--step"];
    let (status, out, err) = run(&[&coarse[..], &["2.1"]].concat());
    assert!(status == 1 && err.contains("error: the trial is not to be trusted: the energy is off by"), "{out}{err}");
    assert!(!out.contains("no encounter") && out.contains("energy error at most"), "{out}");
    let (status, out, err) = run(&["system", &file, "--trial", "2"]);
    assert!(status == 0 && out.contains("no encounter") && err.is_empty(), "{out}{err}");
}

#[test]
fn json_has_positions_and_velocities_in_the_frame_of_the_system() {
    let read = |args: &[&str]| -> serde_json::Value {
        let (status, out, err) = run(args);
        assert_eq!((status, err.as_str()), (0, ""));
        serde_json::from_str(&out).unwrap()
    };
    let found = read(&["system", "systems/hearth.ron", "--time", "86400", "--json"]);
    assert_eq!(found.as_object().unwrap().keys().collect::<Vec<_>>(), ["bodies"]);
    let poses =
        tellus::system::Ephemeris::new(&tellus::system::System::load("systems/hearth.ron").unwrap()).at(86_400.0);
    let bodies = found["bodies"].as_array().unwrap();
    assert_eq!(bodies.len(), poses.len());
    for (body, pose) in bodies.iter().zip(&poses) {
        assert_eq!(body.as_object().unwrap().len(), 4);
        // The reader of JSON may lose the last digit.
        for (name, wanted) in [("position_m", pose.position_m), ("velocity_m_s", pose.velocity)] {
            let found: Vec<f64> = serde_json::from_value(body[name].clone()).unwrap();
            assert_eq!(found.len(), 3);
            let off = found.iter().zip(wanted.to_array()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(off <= 1e-12 * wanted.length(), "{name} {found:?} {wanted}");
        }
    }
    assert_eq!((&bodies[0]["name"], &bodies[0]["parent"]), (&"Hearth".into(), &serde_json::Value::Null));
    assert_eq!((&bodies[3]["name"], &bodies[3]["parent"]), (&"Pallor".into(), &"Aurel".into()));
    let trial = &read(&["system", "systems/hearth.ron", "--trial", "0.2", "--json"])["trial"];
    assert_eq!((&trial["years"], &trial["trusted"], &trial["ending"]), (&0.2.into(), &true.into(), &"whole".into()));
    assert!(trial["energy_error"].as_f64().unwrap() < 1e-12 && trial["bodies"].as_array().unwrap().len() == 8);
}

/// Ctrl+C ends a long trial with what it came to.
#[test]
#[cfg(unix)]
fn a_trial_can_be_stopped() {
    let mut program = std::process::Command::new(assert_cmd::cargo::cargo_bin!("tellus"));
    program.env("TELLUS_MAPS", "").current_dir(env!("CARGO_MANIFEST_DIR"));
    program.args(["system", "systems/hearth.ron", "--trial", "100000", "--json"]).stdout(std::process::Stdio::piped());
    let child = program.spawn().unwrap();
    std::thread::sleep(std::time::Duration::from_secs(4));
    let sent = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(sent.success() && output.status.success(), "{}", output.status);
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(found["trial"]["ending"], "stopped");
}

#[test]
fn bodies_at_one_place_are_refused_where_they_are() {
    let folder = tempfile::tempdir().unwrap();
    let body = |name: &str| format!("(name: \"{name}\", preset: \"one.ron\", parent: \"Sun\", orbit: ()),");
    let file = written(folder.path(), &format!("{}\n{}", body("One"), body("Two")));
    let (status, _, err) = run(&["check", &file]);
    assert!(status == 1 && err.contains("system.ron:6:") && err.contains("`Two` and `One` are at one place"), "{err}");
    // Apart, but not as far as their sizes.
    let moon =
        "(name: \"Moon\", preset: \"two.ron\", parent: \"One\", mass_earths: 0.01, orbit: (semi_major_km: 9000.0)),";
    let file = written(folder.path(), &format!("{}\n{moon}", body("One")));
    let (status, _, err) = run(&["check", &file]);
    assert!(status == 1 && err.contains("9000.000 km apart, and their sizes ask for 12742 km"), "{err}");
}

#[test]
fn what_is_wrong_with_a_system_is_told_with_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let cases = [
        (
            "(name: \"One\", preset: \"one.ron\", parent: \"Son\", orbit: ()),",
            "bodies[1].parent: there is no body `Son`",
        ),
        (
            "(name: \"One\", preset: \"one.ron\", parent: \"Sun\"),",
            "bodies[1].orbit: the orbit around the parent is missing",
        ),
        ("(name: \"Sun\", preset: \"one.ron\", parent: \"Sun\", orbit: ()),", "another body called `Sun`"),
        ("(name: \"One\", preset: \"gone.ron\", parent: \"Sun\", orbit: ()),", "bodies[1].preset: "),
        ("(name: \"One\", preset: \"one.ron\", parent: \"Sun\", orbit: (eccentricity: 1.2)),", "1.2 is out of range"),
        (
            "(name: \"One\", preset: \"one.ron\", parent: \"Sun\", orbit: (semi_major: 1.2)),",
            "did you mean `semi_major_km`?",
        ),
        (
            "(name: \"P\", mass_earths: 0.0, parent: \"Sun\", orbit: ()), (name: \"Q\", preset: \"one.ron\", parent: \"P\", orbit: ()),",
            "`P` has no mass to tell the period",
        ),
    ];
    for (bodies, message) in cases {
        let file = written(folder.path(), bodies);
        let (status, _, err) = run(&["check", &file]);
        assert!(status == 1 && err.contains(message) && err.contains("system.ron:5:"), "{bodies}: {err}");
    }
    let (status, _, err) = run(&["system", "planets/pallor.ron"]);
    assert!(status == 1 && err.contains("not a system file"), "{err}");
    let render = ["render", "systems/hearth.ron", "-o", "x.png", "--body"];
    let (status, _, err) = run(&[&render[..], &["Nobody"]].concat());
    assert!(status == 1 && err.contains("Hearth, Maren, Aurel"), "{err}");
    let (status, _, err) = run(&[&render[..], &["Hearth"]].concat());
    assert!(status == 1 && err.contains("no surface"), "{err}");
}

#[test]
fn shipped_systems_are_valid() {
    let (status, out, err) = run(&["check", "systems/hearth.ron", "systems/twins.ron"]);
    assert_eq!((status, out.matches(": valid").count(), err.as_str()), (0, 2, ""));
}
