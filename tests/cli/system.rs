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
