//! The list of undo steps.

use super::*;

fn steps(harness: &Editor) -> Vec<String> {
    listed(harness).into_iter().map(|(name, _)| name).collect()
}

/// An editor with three edits, and the planet after each number of steps.
fn edited() -> (Editor, Vec<Planet>) {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    let mut planets = vec![planet(&harness)];
    for radius_km in [1000.0, 2000.0] {
        slide(&mut harness, "Radius of planet", radius_km);
        planets.push(planet(&harness));
    }
    slide(&mut harness, "Settlements of planet", 1.0);
    planets.push(planet(&harness));
    (harness, planets)
}

#[test]
fn the_steps_are_listed_and_a_click_goes_to_one() {
    let (mut harness, planets) = edited();
    send(&mut harness, Command::History);
    let radius = |planet: usize| format!("{} km", planets[planet].radius_km);
    let names = [
        "Step 0: Before all changes".to_owned(),
        format!("Step 1: Change radius {} to {}", radius(0), radius(1)),
        format!("Step 2: Change radius {} to {}", radius(1), radius(2)),
        "Step 3: Change settlements 0 to 1".to_owned(),
    ];
    assert_eq!(steps(&harness), names);
    assert_eq!(chosen(&harness), names[3]);
    harness.check_accessibility();
    for step in [1, 3, 0, 2] {
        click(&mut harness, &names[step]);
        assert_eq!(planet(&harness), planets[step], "step {step}");
        assert_eq!(chosen(&harness), names[step]);
        assert_eq!(steps(&harness), names, "a jump forgets nothing");
    }
    slide(&mut harness, "Radius of planet", 3000.0);
    assert_eq!(steps(&harness).len(), 4, "an edit takes the place of what was undone");
    assert_eq!(chosen(&harness), format!("Step 3: Change radius {} to 3000 km", radius(2)));
}

#[test]
fn the_keys_go_through_the_steps() {
    let (mut harness, planets) = edited();
    let before = pose(&harness);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::H);
    for (keys, step) in [
        (&[egui::Key::ArrowUp, egui::Key::ArrowUp][..], 1),
        (&[egui::Key::End], 3),
        (&[egui::Key::Home], 0),
        (&[egui::Key::ArrowDown], 1),
    ] {
        keys.iter().for_each(|key| press(&mut harness, egui::Modifiers::NONE, *key));
        press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
        assert_eq!(planet(&harness), planets[step], "{keys:?}");
    }
    let height = |pose: tellus::lod::pose::Pose| pose.up();
    assert!(height(pose(&harness)).distance(height(before)) < 1e-9, "the camera has no key of the list");
    escape(&mut harness);
    assert!(steps(&harness).is_empty());
}

#[test]
fn a_random_planet_is_a_step_of_the_list_with_its_name() {
    let mut harness = editor(vec![]);
    let mut planets = vec![planet(&harness)];
    for _ in 0..3 {
        send(&mut harness, Command::RandomPlanet);
        planets.push(planet(&harness));
    }
    send(&mut harness, Command::History);
    let names = steps(&harness);
    assert_eq!(names[2], format!("Step 2: Random planet: {}", planets[2].name));
    for step in [0, 3, 1] {
        click(&mut harness, &names[step]);
        assert_eq!(planet(&harness), planets[step]);
        assert!(harness.query_by_label("Save your changes?").is_none());
    }
}
