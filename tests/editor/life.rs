//! The life tab: populations are added, changed, moved and removed, each in one undo step, and painted by hand.

use crate::app::{self, Editor, click, planet, send, undo_label, until};
use crate::glb::{block, glb, tree};
use crate::{press, sculpt};
use eframe::egui;
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;
use tellus::planet::edits::{LifePaint, Tool};
use tellus::planet::life::FileMesh;
use tellus::planet::{Form, Planet, Population};
use tellus::render::DebugView;

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

/// Adds a ready population with a click on its picture.
fn add(harness: &mut Editor, name: &str) {
    if harness.query_by_label(name).is_none() {
        click(harness, "Add population");
    }
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
fn a_ready_population_is_added_with_enter_and_dragged_between_others() {
    let mut harness = open();
    add(&mut harness, "Conifer");
    harness.get_by_label("Birch").focus();
    harness.run_steps(2);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    harness.run_steps(3);
    assert_eq!(names(&harness), ["Conifer", "Birch"]);
    app::drag_row_below(&mut harness, "Palm", "Population Conifer");
    assert_eq!(
        (names(&harness), undo_label(&harness)),
        (to_owned(["Conifer", "Palm", "Birch"]), "Add population: palm".to_owned())
    );
    // Below the rows: to the end.
    let from = harness.get_by_label("Poplar").rect().center();
    let below = harness.get_by_label("Population Birch").rect().center_bottom() + egui::vec2(0.0, 6.0);
    app::drag(&mut harness, from, below);
    assert_eq!(names(&harness), ["Conifer", "Palm", "Birch", "Poplar"]);
    // Dropped where it was taken, it adds nothing.
    app::drag(&mut harness, from, from + egui::vec2(12.0, 0.0));
    assert_eq!(names(&harness).len(), 4);
    send(&mut harness, Command::Undo);
    send(&mut harness, Command::Undo);
    assert_eq!(names(&harness), ["Conifer", "Birch"]);
}

fn to_owned<const N: usize>(names: [&str; N]) -> Vec<String> {
    names.map(str::to_owned).into()
}

#[test]
fn a_ready_population_that_is_dropped_on_the_planet_is_on_in_the_biome_there() {
    let like = two_biomes();
    let mut harness = app::open_planet_with_picture(
        [1024.0, 640.0],
        Planet { biomes: like.biomes, life: Vec::new(), ..sculpt::small() },
    );
    app::wait_for_picture(&mut harness);
    let under = app::point_at_planet(&mut harness);
    click(&mut harness, "Life");
    let (from, middle) = (harness.get_by_label("Conifer").rect().center(), app::canvas(&harness).center());
    app::drag(&mut harness, from, middle);
    app::until(&mut harness, "the population is there", |harness| planet(harness).life.len() == 1);
    let planet = planet(&harness);
    assert_eq!(planet.life[0].biomes, planet.biomes.palette[under.sample.biome].key.to_string());
    assert_eq!(undo_label(&harness), "Add population: conifer");
    // In the sky there is no ground to plant.
    let sky = app::canvas(&harness).left_top() + egui::vec2(6.0, 60.0);
    app::drag(&mut harness, from, sky);
    harness.run_steps(20);
    assert_eq!(names(&harness).len(), 1);
    send(&mut harness, Command::Undo);
    assert!(names(&harness).is_empty());
}

#[test]
fn the_density_of_the_selected_population_is_shown_and_hidden() {
    let named = |name: &str, seed| Population { name: name.to_owned(), seed, ..Population::default() };
    let life = vec![named("Oak", 1), named("Elm", 2)];
    let mut harness = app::open_planet([1280.0, 900.0], Planet { life, ..two_biomes() });
    click(&mut harness, "Life");
    click(&mut harness, "Show density");
    let shown = |harness: &Editor| {
        let settings = &harness.state().viewport().settings;
        (settings.debug_view, settings.population)
    };
    assert_eq!(shown(&harness), (DebugView::Density, 0));
    click(&mut harness, "Population Elm");
    assert_eq!(shown(&harness), (DebugView::Density, 1));
    click(&mut harness, "Show density");
    assert_eq!(shown(&harness).0, DebugView::Shaded);
    // A planet without populations has no density.
    click(&mut harness, "Remove population");
    click(&mut harness, "Remove population");
    assert!(app::is_disabled(&harness, "Show density"));
}

#[test]
fn about_how_many_stand_on_the_planet_is_told_once_it_is_known() {
    let life = vec![Population { name: "Oak".to_owned(), slope_to_deg: 90.0, ..Population::default() }];
    let planet = Planet { life, water: None, layers: Vec::new(), ..two_biomes() };
    let mut harness = app::open_planet([1280.0, 900.0], planet);
    click(&mut harness, "Life");
    let row = harness.get_by_label("Population Oak").rect().center();
    harness.hover_at(row);
    // A sphere of 6371 km has 51 G hectares, and each has 100.
    app::until(&mut harness, "the count", |harness| harness.query_by_label_contains("About 5.1 T objects").is_some());
}

/// The picture shows objects as soon as they are placed, though no tile of the ground is another one.
#[test]
fn objects_that_come_after_the_ground_are_drawn() {
    let life = vec![Population { name: "Oak".to_owned(), slope_to_deg: 90.0, ..Population::default() }];
    let mut harness = app::open_planet_with_picture([640.0, 400.0], Planet { life, ..sculpt::small() });
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::G);
    app::type_text(&mut harness, "12.5 N 45 W @ 100 m");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    app::until(&mut harness, "the camera is at rest", |harness| !harness.state().viewport().is_moving());
    app::wait_for_picture(&mut harness);
    let drawn = |harness: &Editor| harness.state().viewport().stats().objects_drawn;
    let first = drawn(&harness);
    assert!(first > 0);
    click(&mut harness, "Life");
    for wanted in [0, first] {
        click(&mut harness, "Enabled of Oak");
        app::wait_for_picture(&mut harness);
        assert_eq!(drawn(&harness), wanted);
    }
}

#[test]
fn biomes_of_a_population_are_clicked() {
    let mut harness = open();
    add(&mut harness, "Conifer");
    // The parameters need the room.
    click(&mut harness, "Add population");
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
    // A broken file leaves the last mesh in place, with a problem that names it.
    std::fs::write(&file, "no mesh").unwrap();
    until(&mut harness, "the problem is told", |harness| {
        harness.query_all_by_label_contains("is no glTF 2.0 file").next().is_some()
    });
    assert_eq!(triangles(&harness), Some(12));
    std::fs::write(&file, glb(&tree())).unwrap();
    until(&mut harness, "the mesh is read once more", |harness| triangles(harness) == Some(24));
}
