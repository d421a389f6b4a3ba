//! The life tab: populations are added, changed, moved and removed, each in one undo step.

use crate::app::{self, Editor, click, planet, send, undo_label};
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;
use tellus::planet::Planet;

fn open() -> Editor {
    let mut harness = app::open_planet([1280.0, 900.0], Planet { life: Vec::new(), ..two_biomes() });
    click(&mut harness, "Life");
    harness
}

/// A planet of two biomes.
fn two_biomes() -> Planet {
    let mut planet = Planet::default();
    let like = planet.biomes.palette[0].clone();
    planet.biomes.palette.push(tellus::planet::Biome { key: 'z', name: "Marsh".to_owned(), ..like });
    planet
}

fn names(harness: &Editor) -> Vec<String> {
    planet(harness).life.iter().map(|population| population.name.clone()).collect()
}

fn add(harness: &mut Editor, name: &str) {
    click(harness, "Add population");
    harness.get_by_label(name).click();
    harness.run_steps(5);
}

#[test]
fn populations_are_added_duplicated_and_removed() {
    let mut harness = open();
    add(&mut harness, "Conifer");
    assert_eq!(
        (names(&harness), undo_label(&harness)),
        (vec!["Conifer".to_owned()], "Add population: conifer".to_owned())
    );
    add(&mut harness, "Birch");
    click(&mut harness, "Duplicate population");
    assert_eq!(names(&harness), ["Conifer", "Birch", "Birch 2"]);
    click(&mut harness, "Population Conifer");
    click(&mut harness, "Remove population");
    assert_eq!(
        (names(&harness), undo_label(&harness)),
        (vec!["Birch".to_owned(), "Birch 2".to_owned()], "Remove population".to_owned())
    );
    click(&mut harness, "Enabled of Birch");
    assert!(!planet(&harness).life[0].enabled);
    send(&mut harness, Command::Undo);
    send(&mut harness, Command::Undo);
    assert_eq!(names(&harness), ["Conifer", "Birch", "Birch 2"]);
}

#[test]
fn biomes_of_a_population_are_clicked() {
    let mut harness = open();
    add(&mut harness, "Conifer");
    click(&mut harness, "Biomes of Conifer: Marsh");
    assert_eq!(planet(&harness).life[0].biomes, "z");
    click(&mut harness, "Biomes of Conifer: Marsh");
    assert_eq!(planet(&harness).life[0].biomes, "");
}
