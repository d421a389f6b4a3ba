//! The life tab: populations are added, changed, moved and removed, each in one undo step, and painted by hand.

use crate::app::{self, Editor, click, planet, send, undo_label, until};
use crate::glb::{block, glb, tree};
use crate::sculpt;
use eframe::egui;
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;
use tellus::planet::edits::{LifePaint, Tool};
use tellus::planet::life::FileMesh;
use tellus::planet::{Form, Planet, Population};

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

#[test]
fn the_button_of_a_population_takes_the_life_tool_for_it_and_another_is_chosen_by_name() {
    let mut harness = open();
    add(&mut harness, "Conifer");
    add(&mut harness, "Birch");
    click(&mut harness, "Paint Birch");
    let painted = |harness: &Editor| {
        let brush = harness.state().viewport().tab.sculpt.brush.clone().unwrap();
        brush.painted_population().map(str::to_owned)
    };
    assert_eq!(painted(&harness).as_deref(), Some("Birch"));
    for (name, wanted) in [("Conifer", Some("Conifer")), ("All populations", None)] {
        click(&mut harness, "Population of brush");
        harness.get_by_label(name).click();
        harness.run_steps(5);
        assert_eq!(painted(&harness).as_deref(), wanted);
    }
}

#[test]
fn a_drag_plants_a_population_and_with_shift_clears_it_and_strokes_follow_its_name() {
    let population = |name: &str, seed| Population { name: name.to_owned(), seed, ..Population::default() };
    let life = vec![population("Oak", 1), population("Fern", 2)];
    let mut harness = app::open_planet_with_picture([1024.0, 640.0], Planet { life, ..sculpt::small() });
    app::wait_for_picture(&mut harness);
    click(&mut harness, "Life");
    click(&mut harness, "Paint Oak");
    let middle = app::canvas(&harness).center();
    for modifiers in [egui::Modifiers::NONE, egui::Modifiers::SHIFT] {
        sculpt::stroke(&mut harness, middle, middle + egui::vec2(50.0, 30.0), modifiers);
        assert_eq!(undo_label(&harness), "Life");
    }
    let painted = |harness: &Editor| -> Vec<LifePaint> {
        let planet = planet(harness);
        let paint = planet.edits.iter().filter_map(|edit| match &edit.tool {
            Tool::Life(paint) => Some(paint.clone()),
            _ => None,
        });
        paint.collect()
    };
    let of = |name: &str, density| LifePaint { population: name.to_owned(), density };
    assert_eq!(painted(&harness), [of("Oak", 1.0), of("Oak", 0.0)]);
    send(&mut harness, Command::Undo);
    assert_eq!(painted(&harness), [of("Oak", 1.0)]);
    send(&mut harness, Command::Redo);
    assert_eq!(painted(&harness), [of("Oak", 1.0), of("Oak", 0.0)]);

    click(&mut harness, "Life");
    click(&mut harness, "Remove population");
    assert_eq!((names(&harness), painted(&harness)), (vec!["Fern".to_owned()], Vec::new()));
    send(&mut harness, Command::Undo);
    assert_eq!(painted(&harness), [of("Oak", 1.0), of("Oak", 0.0)]);
}

#[test]
fn equal_seeds_are_told_and_what_is_added_has_a_free_one() {
    let named = |name: &str| Population { name: name.to_owned(), ..Population::default() };
    let life = vec![named("Oak"), named("Elm")];
    let mut harness = app::open_planet([1280.0, 900.0], Planet { life, ..two_biomes() });
    click(&mut harness, "Life");
    let is_told = |harness: &Editor| harness.query_by_label_contains("1 is the seed of \"Oak\", too").is_some();
    assert!(!is_told(&harness), "the first one keeps its seed");
    click(&mut harness, "Population Elm");
    assert!(is_told(&harness));
    click(&mut harness, "Duplicate population");
    add(&mut harness, "Birch");
    let seeds: std::collections::HashSet<u32> = planet(&harness).life.iter().map(|one| one.seed).collect();
    assert_eq!((planet(&harness).life.len(), seeds.len()), (4, 3));
}

/// A mesh is chosen by the dialog of files, read, and read again when its file is saved again; undo keeps the newest.
#[test]
fn a_mesh_is_chosen_and_follows_its_file() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("oak.glb");
    std::fs::write(&file, glb(&tree())).unwrap();
    let form = Form::Mesh(FileMesh::default());
    let life = vec![Population { name: "Oak".to_owned(), form, ..Population::default() }];
    let planet = Planet { life, ..Planet::default() };
    let mut harness = app::open_planet_with_answers([1280.0, 1800.0], planet, vec![Some(file.clone())]);
    let triangles = |harness: &Editor| match &harness.state().document().planet().life[0].form {
        Form::Mesh(form) => form.file.mesh().map(|mesh| mesh.triangles()),
        _ => None,
    };
    click(&mut harness, "Life");
    assert_eq!(triangles(&harness), None);
    click(&mut harness, "Browse…");
    assert_eq!(undo_label(&harness), "Choose mesh");
    until(&mut harness, "the mesh is read", |harness| triangles(harness) == Some(24));
    std::fs::write(&file, glb(&[block([1.0, 2.0, 1.0], 0.0, [0.4; 3])])).unwrap();
    until(&mut harness, "the mesh is read again", |harness| triangles(harness) == Some(12));
    send(&mut harness, Command::Undo);
    send(&mut harness, Command::Redo);
    until(&mut harness, "the newest mesh is there", |harness| triangles(harness) == Some(12));
    // What cannot be read is told, and the last mesh stays.
    std::fs::write(&file, "no mesh").unwrap();
    until(&mut harness, "the problem is told", |harness| {
        harness.query_all_by_label_contains("is no glTF 2.0 file").next().is_some()
    });
    assert_eq!(triangles(&harness), Some(12));
    std::fs::write(&file, glb(&tree())).unwrap();
    until(&mut harness, "the mesh is read once more", |harness| triangles(harness) == Some(24));
}
