//! Preset files: errors and their messages, saved texts, and that saving loses nothing.

use proptest::prelude::*;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use tellus::planet::param::{Domain, Segment, Value, ValueRef};
use tellus::planet::{LoadError, Planet, Precision, Shape, random, shipped};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name)
}

fn message(text: &str) -> String {
    match Planet::from_text("f.ron", text) {
        Ok(_) => "no error".to_owned(),
        Err(error) => error.to_string(),
    }
}

/// Every parameter of a planet as a line of text.
fn values(planet: &Planet) -> String {
    let mut text = String::new();
    planet.each_value(&mut |path, _, value| match value {
        ValueRef::Choice(choice) => writeln!(text, "{path} = {}", choice.names()[choice.index()]).unwrap(),
        _ => writeln!(text, "{path} = {:?}", value.get()).unwrap(),
    });
    writeln!(text, "biomes.table = {:?}", planet.biomes.table.rows()).unwrap();
    text
}

/// A preset keeps its meaning for ever. Later versions may have more parameters, but those of the old version keep
/// their values, given or default.
#[test]
fn presets_of_old_versions_load_to_the_same_values_for_ever() {
    for name in
        ["preset_v1", "preset_v1_defaults", "preset_v2", "preset_v2_defaults", "preset_v3", "preset_v3_defaults"]
    {
        let planet = Planet::load(fixture(&format!("{name}.ron"))).unwrap_or_else(|error| panic!("{error}"));
        let now = values(&planet);
        // Old versions keep the arithmetic of their heights.
        assert_eq!(planet.precision == Precision::Classic, !name.contains("v3"), "{name}");
        let frozen = std::fs::read_to_string(fixture(&format!("{name}.values.txt"))).unwrap_or_default();
        assert!(!frozen.is_empty(), "no frozen values; they should be:\n{now}");
        for line in frozen.lines() {
            assert!(now.lines().any(|l| l == line), "{name}: `{line}` changed; now\n{now}");
        }
    }
}

/// Version 3 can express every preset of versions 1 and 2.
#[test]
fn presets_of_old_versions_become_presets_of_version_3() {
    // Version 1 had craters of one shape.
    let first = "density: 0.3, power: 0, floor: 0, peak: 0, age: 0, fresh: 0";
    let text = |version: u32, mask: &str, craters: &str| {
        let mask = format!("{mask}(layer: \"B\", from: -0.5, to: 0.75, invert: true)");
        let a = format!("(name: \"A\", blend: Replace, shape: Ridged(gain: 0.4), masks: [{mask}])");
        format!(
            "(version: {version}, layers: [{a}, (name: \"B\", shape: Craters({craters})), (name: \"C\", shape: Fbm())])"
        )
    };
    let old = Planet::from_text("f.ron", &text(1, "", "density: 0.3")).unwrap_or_else(|error| panic!("{error}"));
    let new = Planet::from_text("f.ron", &text(2, "Layer", first)).unwrap_or_else(|error| panic!("{error}"));
    assert_eq!(old, new);
    let now = text(3, "Layer", first).replace("layers", "precision: Classic, layers");
    assert_eq!(old, Planet::from_text("f.ron", &now).unwrap_or_else(|error| panic!("{error}")));
    assert_eq!(Planet::from_text("f.ron", &old.to_text()).unwrap(), old);
    assert!(old.to_text().contains("version: 3,"));
}

#[test]
fn each_mistake_is_told_with_its_place_and_what_would_be_right() {
    let cases = [
        // --- the file as a whole
        ("", "f.ron:1:1: found the end of the text; a preset is written `(version: 3, ...)`"),
        ("hello", "f.ron:1:1: `hello` is not what belongs here; write `Planet(...)` or only `(...)`"),
        ("()", "f.ron:1:1: version: the version is missing; write `version: 3` as the first field"),
        ("(name: \"x\")", "f.ron:1:1: version: the version is missing; write `version: 3` as the first field"),
        ("(version: 0)", "f.ron:1:11: version: there is no version 0; use 3"),
        ("(version: \"1\")", "f.ron:1:11: version: `\"1\"` is not a version; use a whole number, now 3"),
        (
            "(version: 4, novel: 3)",
            "f.ron:1:11: version: this preset has version 4 and was made by a newer Tellus; this one reads up to version 3: update it",
        ),
        ("(version: 3)\n  extra", "f.ron:2:3: `extra` stands behind the planet; remove all behind the last `)`"),
        ("(version: 3, version: 3)", "f.ron:1:14: `version` stands here twice; remove one"),
        ("Moon(version: 3)", "f.ron:1:1: `Moon` is not what belongs here; write `Planet(...)` or only `(...)`"),
        // --- syntax
        (
            "(version: 3, water: Some((level_m: 1)))",
            "f.ron:1:26: water: this `(` is one too many; write `(field: value, ...)`",
        ),
        ("(version: 3", "f.ron:1:12: the text ends too early; a closing bracket or a value is missing"),
        ("(version: 3, /* x", "f.ron:1:18: this comment has no closing `*/`; add it"),
        ("(version: 3 seed: 2)", "f.ron:1:13: `seed` is unexpected; put a comma before it"),
        ("(version: 3, seed 2)", "f.ron:1:19: a colon is missing; write `field: value`"),
        // --- names
        (
            "(\n    version: 3,\n    sead: 2,\n)",
            "f.ron:3:5: sead: there is no field `sead` here; did you mean `seed`? use `version`, \
             `ground_version`, `name`, `seed`, `radius_km`, `precision`, `settlements`, `height_curve`, `star`, \
             `layers`, `edits`, `life`, `climate`, `biomes`, `structure`, `water`, `atmosphere`, `clouds`, \
             `giant`, `rings`, `editor`",
        ),
        (
            "(version: 3, layers: [(), (shape: Fbm(ocataves: 3))])",
            "f.ron:1:39: layers[1].shape.ocataves: there is no field `ocataves` here; did you mean `octaves`? use `wavelength_km`, \
             `octaves`, `gain`, `lacunarity`",
        ),
        (
            "(version: 3, layers: [(shape: fbm())])",
            "f.ron:1:31: layers[0].shape: there is no value `fbm` here; did you mean `Fbm`? use `Fbm`, `Ridged`, `Craters`, \
             `Terraces`, `Billow`, `Damped`, `Warped`, `Continents`, `Dunes`, `Gullies`, `Canyons`, `Cells`, \
             `HeightMap`",
        ),
        (
            "(version: 3, layers: [(blend: Plus)])",
            "f.ron:1:31: layers[0].blend: there is no value `Plus` here; use `Add`, `Subtract`, `Multiply`, `Max`, `Min`, \
             `Replace`, `SmoothMax`, `SmoothMin`",
        ),
        // --- types
        (
            "(version: 3, seed: -1)",
            "f.ron:1:20: seed: `-1` is not what belongs here; use a whole number: 0 to 4294967295",
        ),
        (
            "(version: 3, layers: [(shape: Fbm(octaves: 3.5))])",
            "f.ron:1:44: layers[0].shape.octaves: `3.5` is not what belongs here; use a whole number: 1 to 24",
        ),
        (
            "(version: 3, radius_km: \"6371\")",
            "f.ron:1:25: radius_km: `\"6371\"` is not what belongs here; use a number: 1 to 100000 km",
        ),
        (
            "(version: 3, layers: [(shape: Fbm)])",
            "f.ron:1:31: layers[0].shape: `Fbm` is not what belongs here; use one of `Fbm(...)`, `Ridged(...)`, `Craters(...)`, \
             `Terraces(...)`, `Billow(...)`, `Damped(...)`, `Warped(...)`, `Continents(...)`, `Dunes(...)`, \
             `Gullies(...)`, `Canyons(...)`, `Cells(...)`, `HeightMap(...)`",
        ),
        (
            "(version: 3, layers: [(enabled: yes)])",
            "f.ron:1:33: layers[0].enabled: `yes` is not what belongs here; use `true` or `false`",
        ),
        (
            "(version: 3, name: Moon)",
            "f.ron:1:20: name: `Moon` is not what belongs here; use text in double quotes: `\"text\"`",
        ),
        (
            "(version: 3, biomes: (palette: [(key: \"a\")]))",
            "f.ron:1:39: biomes.palette[0].key: `\"a\"` is not what belongs here; use a letter in single quotes: `'a'`",
        ),
        ("(version: 3, layers: ())", "f.ron:1:22: layers: `(` is not what belongs here; use a list: `[(...), (...)]`"),
        ("(version: 3, water: 3)", "f.ron:1:21: water: `3` is not what belongs here; use `(...)` or `None`"),
        (
            "(version: 3, star: (color: (1, 2)))",
            "f.ron:1:28: star.color: 2 numbers are too few; use three, for red, green and blue",
        ),
        (
            "(version: 3, star: (color: (1, 1, 1, 1)))",
            "f.ron:1:38: star.color: too many numbers; use three, for red, green and blue; decimals have a point: 0.5",
        ),
        (
            "(version: 3, star: (color: (1, x, 1)))",
            "f.ron:1:32: star.color[1]: `x` is not what belongs here; use three numbers, for red, green and blue: \
             `(0.1, 0.2, 0.3)`, 0 to 1 each",
        ),
        // --- ranges, all of them at once
        (
            "(\n version: 3,\n radius_km: 0.5,\n layers: [(name: \"é\", /* ( */ shape: Ridged(octaves: 99, gain: NaN))],\n)",
            "f.ron:3:13: radius_km: 0.5 is out of range; use 1 to 100000 km\n\
             f.ron:4:54: layers[0].shape.octaves: 99 is out of range; use 1 to 24\n\
             f.ron:4:64: layers[0].shape.gain: NaN is not a finite number; use 0.05 to 0.95",
        ),
        (
            "(version: 3, star: (brightness: inf))",
            "f.ron:1:33: star.brightness: inf is not a finite number; use 0 to 100",
        ),
        (
            "(version: 3, water: Some(level_m: 1e9))",
            "f.ron:1:35: water.level_m: 1000000000 is out of range; use -50000 to 50000 m",
        ),
        // --- what belongs together
        (
            "(version: 3, layers: [(name: \"A\"), (name: \"A\")])",
            "f.ron:1:43: layers[1].name: another layer is called \"A\" too; use a name of its own",
        ),
        (
            "(version: 3, layers: [(name: \"A\", masks: [Layer(from: 1, to: 1)])])",
            "f.ron:1:43: layers[0].masks[0].layer: there is no layer called \"\"; there is no other layer: remove the mask \
             or add a layer\n\
             f.ron:1:62: layers[0].masks[0].to: `to` equals `from` (1); use two different numbers",
        ),
        (
            "(version: 3, layers: [(name: \"A\", masks: [Height(from_m: 5, to_m: 5)])])",
            "f.ron:1:67: layers[0].masks[0].to_m: `to_m` equals `from_m` (5); use two different numbers",
        ),
        (
            "(version: 3, layers: [(masks: [Slope(from_deg: -1)])])",
            "f.ron:1:48: layers[0].masks[0].from_deg: -1 is out of range; use 0 to 90°",
        ),
        (
            "(version: 3, layers: [(name: \"A\", masks: [Slope(over_m: 1), Slope(over_m: 2), Slope(over_m: 3), Slope(over_m: 4), \
             Slope(over_m: 5), Slope(over_m: 6), Slope(over_m: 7)])])",
            "f.ron:1:165: layers[0].masks[6].over_m: 7 is one distance too many for this planet's slope masks; use one of the \
             others: 1, 2, 3, 4, 5, 6 m",
        ),
        // --- kinds of mask
        (
            "(version: 3, layers: [(masks: [Hight()])])",
            "f.ron:1:32: layers[0].masks[0]: there is no value `Hight` here; did you mean `Height`? use `Layer`, `Height`, \
             `Slope`, `Latitude`, `Painted`",
        ),
        (
            "(version: 3, layers: [(masks: [Latitude(from: 3)])])",
            "f.ron:1:41: layers[0].masks[0].from: there is no field `from` here; use `from_deg`, `to_deg`, `both`, `invert`",
        ),
        (
            "(version: 3, layers: [(masks: [Slope])])",
            "f.ron:1:32: layers[0].masks[0]: `Slope` is not what belongs here; use one of `Layer(...)`, `Height(...)`, \
             `Slope(...)`, `Latitude(...)`, `Painted(...)`",
        ),
        (
            "(version: 3, layers: [(masks: 3)])",
            "f.ron:1:31: layers[0].masks: `3` is not what belongs here; use a list: `[(...), (...)]`",
        ),
        // --- curves
        (
            "(version: 3, height_curve: [(0, 0)])",
            "f.ron:1:28: height_curve: one point makes no curve; add another, or use `[]` for none",
        ),
        (
            "(version: 3, height_curve: [(0, 0), (10, 5), (10, 7)])",
            "f.ron:1:28: height_curve: point 3 has x 10, the one before it 10; let x grow by at least 1 m from point to point",
        ),
        (
            "(version: 3, layers: [(curve: [(0, 0), (9, 5)])])",
            "f.ron:1:31: layers[0].curve: point 2 has 9, which is out of range; use 2 to 16 points, each from -4 to 4",
        ),
        (
            "(version: 3, layers: [(curve: [(0, 0, 1), (1, 5)])])",
            "f.ron:1:39: layers[0].curve[0]: too many numbers; use two for each point: `(from, to)`; \
             decimals have a point: 0.5",
        ),
        (
            "(version: 3, layers: [(curve: [(0)])])",
            "f.ron:1:32: layers[0].curve[0]: 1 number is too few; use two for each point: `(from, to)`",
        ),
        (
            "(version: 3, layers: [(curve: 3)])",
            "f.ron:1:31: layers[0].curve: `3` is not what belongs here; use a list of points: `[(-1, 0), (1, 2)]`, 2 to 16 points, \
             each from -4 to 4",
        ),
        // --- version 1 stays what it was
        (
            "(version: 1, layers: [(softness_m: 3)])",
            "f.ron:1:24: layers[0].softness_m: there is no field `softness_m` here; use `name`, `enabled`, `seed`, `amplitude_m`, \
             `bias`, `blend`, `shape`, `masks`",
        ),
        (
            "(version: 1, layers: [(blend: SmoothMax)])",
            "f.ron:1:31: layers[0].blend: there is no value `SmoothMax` here; use `Add`, `Subtract`, `Multiply`, `Max`, `Min`, \
             `Replace`",
        ),
        (
            "(version: 3, biomes: (table: [\"aa\", \"aaa\"]))",
            "f.ron:1:37: biomes.table[1]: this row has 3 letters, the first has 2; make all equally long",
        ),
        ("(version: 3, biomes: (table: []))", "f.ron:1:30: biomes.table: the table has 0 rows; use 1 to 64"),
        (
            "(version: 3, biomes: (palette: []))",
            "f.ron:1:22: biomes.table[0]: 'a' is no key of the palette; use one of ``",
        ),
        (
            "(version: 3, biomes: (coldest_c: 40))",
            "f.ron:1:22: biomes.hottest_c: 30 is out of order; use more than `coldest_c` (40)",
        ),
    ];
    let mut wrong = String::new();
    for (text, expected) in cases {
        // An empty palette is a problem in every row of the table; the first is enough here.
        let found: Vec<String> = message(text).lines().take(expected.lines().count()).map(str::to_owned).collect();
        if found.join("\n") != expected {
            writeln!(wrong, "{text}\n  found    {}\n  expected {expected}", found.join("\n")).unwrap();
        }
    }
    assert!(wrong.is_empty(), "{wrong}");
}

#[test]
fn odd_but_valid_texts_are_read() {
    for text in [
        "\u{feff}(version: 3)",
        "Planet(version: 3)",
        "(version: 3, water: Some(), atmosphere: None)",
        "(version: 3, water: Some(level_m: 3))",
        "(version: 3, water: (level_m: 3),)\r\n// end",
        "#![enable(implicit_some)]\n(version: 3, layers: [Layer(shape: Fbm(octaves: 3))])",
        "(seed: 3, version: 3)",
    ] {
        assert_eq!(message(text), "no error", "{text}");
    }
}

#[test]
fn what_is_too_large_or_too_deep_is_refused_and_harmless() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("large.ron");
    std::fs::write(&path, format!("(version: 3) // {}", "x".repeat(48 << 20))).unwrap();
    let error = Planet::load(&path).unwrap_err().to_string();
    assert!(error.ends_with("large.ron: the file is longer than 49152 KiB; a preset is much shorter"), "{error}");

    std::fs::write(&path, b"(version: 3,\n name: \"\xff\")").unwrap();
    let error = Planet::load(&path).unwrap_err().to_string();
    assert!(error.ends_with("large.ron:2:9: the text is not UTF-8 from here on; save it as UTF-8"), "{error}");

    for open in ["(", "[", "{", "Some(", "(a:", "/*", "(layers:[", "(layers:[(shape:Fbm("] {
        for start in ["", "(version: 3, name: ", "(version: 3, water: ", "(version: 3, layers: "] {
            let text = format!("{start}{}", open.repeat(100_000));
            assert_ne!(message(&text), "no error");
        }
    }
    let many = format!("(version: 3, layers: [{}])", "(),".repeat(300_000));
    assert_eq!(message(&many), "f.ron:1:22: layers: 300000 layers are too many; use at most 64");
}

#[test]
fn files_that_cannot_be_read_say_why() {
    let folder = tempfile::tempdir().unwrap();
    let error = Planet::load(folder.path()).unwrap_err();
    assert!(matches!(error, LoadError::Read { .. }) && error.to_string().ends_with("is a folder; name a file"));
    let error = Planet::load(folder.path().join("no.ron")).unwrap_err();
    assert!(matches!(error, LoadError::Read { .. }) && error.to_string().contains("no.ron: "), "{error}");
}

#[test]
fn saving_replaces_the_whole_file_or_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.ron");
    let (one, two) = (random::random(1), random::random(2));
    one.save(&path).unwrap();
    assert_eq!(Planet::load(&path).unwrap(), one);
    two.save(&path).unwrap();
    assert_eq!(Planet::load(&path).unwrap(), two);

    let broken = Planet { radius_km: f64::NAN, ..one.clone() };
    let error = broken.save(&path).unwrap_err().to_string();
    assert!(error.ends_with("not saved: radius_km: NaN is not a finite number; use 1 to 100000 km"), "{error}");
    assert_eq!(Planet::load(&path).unwrap(), two);

    let error = one.save(folder.path().join("no/a.ron")).unwrap_err().to_string();
    assert!(error.contains("there is no folder"), "{error}");
    let error = one.save(folder.path()).unwrap_err().to_string();
    assert!(error.contains("is a folder; name a file"), "{error}");

    let mut permissions = std::fs::metadata(&path).unwrap().permissions();
    permissions.set_readonly(true);
    std::fs::set_permissions(&path, permissions).unwrap();
    let error = one.save(&path).unwrap_err().to_string();
    assert!(error.contains("is read-only"), "{error}");
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "something was left behind");
}

#[cfg(unix)]
#[test]
fn saving_keeps_permissions_and_links() {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    let folder = tempfile::tempdir().unwrap();
    let (path, link) = (folder.path().join("a.ron"), folder.path().join("link.ron"));
    std::fs::write(&path, "old").unwrap();
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).unwrap();
    symlink(&path, &link).unwrap();
    random::random(1).save(&link).unwrap();
    assert!(std::fs::symlink_metadata(&link).unwrap().is_symlink());
    assert_eq!(std::fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
    assert_eq!(Planet::load(&path).unwrap(), random::random(1));
}

#[test]
fn the_saved_text_is_made_to_be_read() {
    let text = shipped::default_planet().to_text();
    for part in [
        "    version: 3,\n",
        "    // Radius of the reference sphere from which heights are measured. (1 to 100000 km)\n    radius_km: 6371.0,\n",
        "        color: (1.0, 0.98, 0.955),\n",
        "            \"dddddaaaawwwjjjj\",\n",
    ] {
        assert!(text.contains(part), "{part:?} is not in\n{text}");
    }
    assert_eq!(text.matches("// Number of octaves; each further one").count(), 1);
    assert!(text.lines().all(|line| line.chars().count() <= 120 && line == line.trim_end()));
}

/// The comments name the values of a choice; these must be the words that the file takes.
#[test]
fn the_values_that_comments_name_can_be_written() {
    let kinds = Shape::NAMES.join(", ");
    for (field, names) in [
        ("layers: [(blend: {})]", "Add, Subtract, Multiply, Max, Min, Replace, SmoothMax, SmoothMin"),
        ("layers: [(shape: {}())]", kinds.as_str()),
        ("biomes: (rows: {})", "Temperature, Elevation"),
    ] {
        for name in names.split(", ") {
            let text = format!("(version: 3, {})", field.replace("{}", name));
            assert_eq!(message(&text), "no error");
            let saved = Planet::from_text("f", &text).unwrap().to_text();
            // A long list is wrapped.
            let saved: Vec<&str> = saved.split_whitespace().filter(|word| *word != "//").collect();
            assert!(saved.join(" ").contains(&format!("({names})")), "{names}");
        }
    }
}

/// Any valid planet, including the ends of all ranges.
fn any_planet() -> impl Strategy<Value = Planet> {
    (any::<u64>(), any::<u64>(), 0.0..=1.0_f64, "[^\\p{Cc}]{0,64}").prop_map(|(seed, other, strength, name)| {
        let mut planet = random::vary(&random::random(seed), other, strength);
        // Every eighth number of air and clouds at an end of its range: no rule binds several of them.
        let mut dice = other;
        planet.each(&mut |path, param, mut value| {
            dice = dice.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let part = path.segments().first();
            let free = [Segment::Field("clouds"), Segment::Field("atmosphere")].iter().any(|free| part == Some(free));
            if let (true, 0, Domain::Number { min, max, .. }) = (free, dice >> 61, param.domain) {
                value.set(&Value::Number(if (dice >> 60) & 1 == 0 { min } else { max }));
            }
        });
        planet.name = name;
        planet
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn what_is_written_is_what_is_read(planet in any_planet()) {
        let text = planet.to_text();
        let read = Planet::from_text("f.ron", &text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        prop_assert_eq!(&read, &planet);
        prop_assert_eq!(read.to_text(), text);
    }

    #[test]
    fn no_text_is_dangerous(
        seed in 0_u64..8,
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0_usize..3, any::<char>(), 0_usize..24), 1..6),
    ) {
        let mut text: Vec<char> = random::random(seed).to_text().chars().collect();
        for (at, kind, any, telling) in edits {
            let at = at.index(text.len());
            // Half of the inserted characters have a meaning in RON.
            let c = "()[]{},:\"'/*\\#r_.-+019Ne".chars().nth(telling).unwrap_or(any);
            match kind {
                0 => text[at] = c,
                1 => text.insert(at, any),
                _ => { text.drain(at..(at + 1 + telling * 8).min(text.len())); }
            }
            if text.is_empty() {
                text.push(' ');
            }
        }
        let text: String = text.into_iter().collect();
        if let Err(LoadError::Invalid { problems, .. }) = Planet::from_text("f.ron", &text) {
            prop_assert!(!problems.is_empty());
            for problem in problems {
                prop_assert!(problem.line >= 1 && problem.line <= text.lines().count().max(1) + 1, "{}", problem);
            }
        }
    }
}

#[cfg(unix)]
#[test]
fn a_device_is_not_replaced_by_a_file() {
    let error = random::random(1).save("/dev/null").unwrap_err().to_string();
    assert!(error.contains("is a device or a pipe"), "{error}");
    assert!(!std::fs::metadata("/dev/null").unwrap().is_file());
}

#[test]
fn a_rule_that_names_no_biome_is_refused_where_it_stands() {
    let text = "(\n version: 3,\n biomes: (\n  snow_key: 'q', snow: true,\n ),\n)";
    let Err(error @ LoadError::Invalid { .. }) = Planet::from_text("f.ron", text) else { panic!("it was accepted") };
    let expected = "f.ron:4:13: biomes.snow_key: 'q' is no key of the palette; use one of `a`";
    assert_eq!(error.to_string(), expected);
    // A rule that is off loses such a key.
    let planet = Planet::from_text("f.ron", &text.replace("snow: true", "snow: false")).unwrap();
    assert_eq!(planet.biomes.snow_key, Planet::default().biomes.snow_key);
}
