//! Opening and saving without losing work.

use super::app::{open_file, until};
use super::*;
use tellus::editor::command::{Action, BakeAction};
use tellus::editor::files::dialogs::NoDialogs;
use tellus::planet::{EditPoint, GroundEdit};

#[test]
fn saved_as_and_opened_again_it_is_the_same_planet() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let mut harness = editor(vec![Some(path.clone()), Some(path.clone())]);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let edited = planet(&harness);
    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::S);
    assert!(path.exists());
    assert!(!harness.state().document().is_dirty());
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
    begin_new(&mut harness);
    assert_ne!(planet(&harness), edited);
    send(&mut harness, Command::Open);
    assert_eq!(planet(&harness), edited);
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
}

#[test]
fn unsaved_work_is_never_dropped_without_asking() {
    let mut harness = editor(vec![None]);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let edited = planet(&harness);

    begin_new(&mut harness);
    assert_eq!(planet(&harness), edited, "nothing happens before the answer");
    click(&mut harness, "Cancel");
    assert_eq!(planet(&harness), edited);

    begin_new(&mut harness);
    click(&mut harness, "Save changes");
    assert_eq!(planet(&harness), edited, "the file dialog was cancelled");

    begin_new(&mut harness);
    click(&mut harness, "Discard changes");
    assert_ne!(planet(&harness), edited);
    assert!(!harness.state().document().is_dirty());
}

/// The question comes once, after a file was chosen.
#[test]
fn opening_over_unsaved_work_asks_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("other.ron");
    std::fs::write(&path, "(version: 3, name: \"Other\", radius_km: 900.0)").unwrap();
    let mut harness = editor(vec![Some(path)]);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    send(&mut harness, Command::Open);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("Then other.ron opens").is_some());
    click(&mut harness, "Discard changes");
    harness.run_steps(3);
    assert_eq!(planet(&harness).name, "Other");
    assert!(harness.query_by_label("Discard changes").is_none());
}

#[test]
fn closing_the_window_with_unsaved_work_asks() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let root = harness.ctx.viewport_id();
    harness.input_mut().viewports.entry(root).or_default().events.push(egui::ViewportEvent::Close);
    harness.step();
    let commands = harness.output().viewport_output[&root].commands.clone();
    assert!(commands.contains(&egui::ViewportCommand::CancelClose), "{commands:?}");
    harness.run_steps(2);
    assert!(harness.query_by_label("Save your changes?").is_some());
}

#[test]
fn a_file_that_cannot_be_opened_is_explained_and_nothing_is_lost() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.ron");
    std::fs::write(&path, "(version: 1, radius_km: \"large\")").unwrap();
    let mut harness = editor(vec![Some(path)]);
    let before = planet(&harness);
    send(&mut harness, Command::Open);
    assert!(harness.query_by_label("The planet could not be opened").is_some());
    assert!(harness.query_by_label_contains("radius_km").is_some());
    click(&mut harness, "Dismiss");
    assert_eq!(planet(&harness), before);
}

#[test]
fn unsaved_work_outlives_a_crash() {
    let folder = tempfile::tempdir().unwrap();
    let start = || open_file(None, NoDialogs, folder.path());
    let mut harness = start();
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    let edited = planet(&harness);
    until(&mut harness, "a working copy", |_| folder.path().join("recovery-0.ron").exists());
    // Dropped without eframe's `on_exit`, as in a crash.
    drop(harness);

    let mut harness = start();
    assert_ne!(planet(&harness), edited);
    click(&mut harness, "Recover");
    assert_eq!(planet(&harness), edited);
    assert!(harness.state().document().is_dirty());
}

#[test]
fn a_height_map_is_chosen_undone_saved_and_missed() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let picture = path("maps/heights.png");
    std::fs::create_dir(path("maps")).unwrap();
    let pixels: Vec<u8> = (0..8 * 16).map(|i| 100 + i).collect();
    image::save_buffer(&picture, &pixels, 16, 8, image::ExtendedColorType::L8).unwrap();
    let preset = path("mine.ron");
    let mut harness = editor(vec![Some(picture.clone()), Some(preset.clone()), Some(preset.clone())]);
    let height_m = |harness: &Editor| {
        let planet = (**harness.state().document().planet()).clone();
        tellus::terrain::Terrain::try_new(planet.into()).unwrap().layers_m(glam::DVec3::X)[1]
    };
    let settled = |harness: &mut Editor| {
        until(harness, "the picture is read", |harness| !harness.state().pictures().is_reading());
        harness.run_steps(2);
    };
    click(&mut harness, "Terrain");
    click(&mut harness, "Add layer");
    click(&mut harness, "Height map");
    assert_eq!(height_m(&harness), 0.0);
    click(&mut harness, "Browse…");
    settled(&mut harness);
    let chosen_m = height_m(&harness);
    assert!(chosen_m > 300.0, "{chosen_m}");
    assert_eq!(undo_label(&harness), "Choose picture");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    assert_eq!(height_m(&harness), 0.0);
    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::Z);
    settled(&mut harness);
    assert_eq!(height_m(&harness), chosen_m);

    press(&mut harness, egui::Modifiers::COMMAND | egui::Modifiers::SHIFT, egui::Key::S);
    assert!(!harness.state().document().is_dirty());
    assert!(std::fs::read_to_string(&preset).unwrap().contains("file: \"maps/heights.png\""));
    assert_eq!(height_m(&harness), chosen_m);

    std::fs::rename(&picture, path("away.png")).unwrap();
    begin_new(&mut harness);
    send(&mut harness, Command::Open);
    settled(&mut harness);
    assert_eq!(harness.state().document().path(), Some(preset.as_path()), "it opens without its picture");
    assert!(!harness.state().document().is_dirty());
    assert_eq!(height_m(&harness), 0.0);
    assert!(harness.query_all_by_label_contains("put the picture there").next().is_some());
    std::fs::rename(path("away.png"), &picture).unwrap();
    harness.run_steps(2);
    settled(&mut harness);
    assert_eq!(height_m(&harness), chosen_m, "the file is back");
}

#[test]
fn a_name_that_got_its_extension_here_replaces_nothing_without_asking() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let other = "somebody else's planet";
    std::fs::write(path("foo.ron"), other).unwrap();
    // The dialog asked about the file `foo`, which does not exist.
    let answers = [path("foo"), path("foo"), path("bar"), path("foo")].map(Some);
    let mut harness = editor(answers.to_vec());
    let read = || std::fs::read_to_string(path("foo.ron")).unwrap();
    send(&mut harness, Command::SaveAs);
    assert!(harness.query_by_label("Replace the file?").is_some());
    click(&mut harness, "Cancel");
    assert_eq!((read().as_str(), harness.state().document().path()), (other, None));

    send(&mut harness, Command::SaveAs);
    click(&mut harness, "Other name…");
    harness.run_steps(3);
    assert_eq!(harness.state().document().path(), Some(path("bar.ron").as_path()));
    assert_eq!(read(), other);

    send(&mut harness, Command::SaveAs);
    click(&mut harness, "Replace");
    assert_eq!(Planet::load(path("foo.ron")).unwrap(), planet(&harness));
    assert!(harness.query_by_label_contains("Saved to").is_some(), "saving says so");
}

#[test]
fn a_table_that_got_its_extension_here_replaces_no_picture_without_asking() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("foo.png"), "a photograph").unwrap();
    let mut harness = editor(vec![Some(path("foo"))]);
    send(&mut harness, Command::ExportTable);
    click(&mut harness, "Cancel");
    assert_eq!(std::fs::read_to_string(path("foo.png")).unwrap(), "a photograph");
}

#[test]
fn a_random_planet_is_a_step_and_never_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let mut harness = editor(vec![Some(path.clone())]);
    send(&mut harness, Command::SaveAs);
    let first = planet(&harness);
    let mut rolled = Vec::new();
    for _ in 0..2 {
        send(&mut harness, Command::RandomPlanet);
        assert!(harness.query_by_label("Save your changes?").is_none());
        rolled.push(planet(&harness));
    }
    assert!(rolled[0] != first && rolled[1] != rolled[0]);
    assert_eq!(harness.state().document().path(), None, "a roll never goes over the file of another planet");
    assert_eq!((undo_len(&harness), undo_label(&harness)), (2, format!("Random planet: {}", rolled[1].name)));
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness), rolled[0]);
    send(&mut harness, Command::Undo);
    assert_eq!(planet(&harness), first);
    assert_eq!(harness.state().document().path(), Some(path.as_path()));
    assert!(!harness.state().document().is_dirty());
    send(&mut harness, Command::Redo);
    assert_eq!(planet(&harness), rolled[0]);
}

#[test]
fn changes_under_a_random_planet_are_asked_about_before_they_are_lost() {
    let folder = tempfile::tempdir().unwrap();
    let paths = ["mine.ron", "rolled.ron"].map(|name| folder.path().join(name));
    let mut harness = editor(paths.clone().map(Some).to_vec());
    send(&mut harness, Command::SaveAs);
    edit_and_save_a_random_planet_over_it(&mut harness);
    assert!(harness.query_by_label_contains("undo brings them back").is_some());
    cancel_and_undo_to_the_edit(&mut harness);
}

fn edit_and_save_a_random_planet_over_it(harness: &mut Editor) {
    click(harness, "Planet");
    slide(harness, "Radius of planet", 2500.0);
    send(harness, Command::RandomPlanet);
    send(harness, Command::Save);
    assert!(!harness.state().document().is_dirty());
    begin_new(harness);
}

fn cancel_and_undo_to_the_edit(harness: &mut Editor) {
    click(harness, "Cancel");
    send(harness, Command::Undo);
    assert_eq!(planet(harness).radius_km, 2500.0);
}

/// Work without a file counts as much as work with a file.
#[test]
fn a_planet_without_a_file_is_asked_about_before_it_is_lost_under_a_random_one() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = editor(vec![Some(folder.path().join("rolled.ron"))]);
    let name = planet(&harness).name;
    edit_and_save_a_random_planet_over_it(&mut harness);
    assert!(harness.query_by_label("Lose your changes?").is_some());
    assert!(harness.query_by_label_contains(&format!("{name} had unsaved changes")).is_some());
    cancel_and_undo_to_the_edit(&mut harness);
}

#[test]
fn a_planet_that_nobody_touched_is_rolled_over_without_a_question() {
    let folder = tempfile::tempdir().unwrap();
    let mut harness = editor(vec![Some(folder.path().join("rolled.ron"))]);
    send(&mut harness, Command::RandomPlanet);
    send(&mut harness, Command::RandomPlanet);
    send(&mut harness, Command::Save);
    begin_new(&mut harness);
    assert!(harness.query_by_label("Lose your changes?").is_none());
    assert_eq!(harness.state().document().path(), None);
}

/// Edits beyond a MiB are in a file beside the preset: saved, taken for saved, and opened again.
#[test]
fn a_planet_of_many_strokes_is_saved_with_its_edits_beside_it() {
    let point = |number: usize, step: u32| EditPoint {
        latitude_deg: -40.0 + 0.05 * number as f64,
        longitude_deg: 0.3 * f64::from(step),
        ..EditPoint::default()
    };
    let stroke = |number: usize| GroundEdit {
        name: format!("Stroke {number}"),
        points: (0..12).map(|step| point(number, step)).collect(),
        ..GroundEdit::default()
    };
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.ron");
    let many = Planet { edits: (0..1500).map(stroke).collect(), ..Planet::default() };
    many.save(&path).unwrap();
    let mut harness = editor(vec![Some(path.clone()), None]);
    send(&mut harness, Command::Open);
    assert!(planet(&harness) == many && !harness.state().document().is_dirty());
    click(&mut harness, "Planet");
    slide(&mut harness, "Radius of planet", 2500.0);
    assert!(harness.state().document().is_dirty());
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::S);
    assert!(!harness.state().document().is_dirty());
    let saved = std::fs::read_to_string(&path).unwrap();
    assert!(saved.len() < 100_000 && saved.contains("edits: \"mine.edits-"), "{}", saved.len());
    assert!(Planet::load(&path).unwrap() == planet(&harness));
    // The bytes on the disk are known: nobody else has changed them.
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::S);
    assert!(harness.query_by_label_contains("Another program").is_none());
    assert_eq!(std::fs::read_to_string(&path).unwrap(), saved);
    // Another program writes other edits.
    let fewer = Planet { edits: (0..1400).map(stroke).collect(), ..planet(&harness) };
    fewer.save(&path).unwrap();
    until(&mut harness, "the edits are read again", |harness| harness.state().document().planet().edits.len() == 1400);
}

/// Neither a save nor an export replaces a file that the planet is read from, also after a question.
#[test]
fn nothing_that_is_written_replaces_what_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    image::GrayImage::new(16, 8).save(at("height.png")).unwrap();
    let list = "(version: 3, edits: [(tool: Volcano(), points: [(1, 2)])])";
    std::fs::write(at("mine.edits-0123456789abcdef.ron"), list).unwrap();
    let layer = "(name: \"Map\", shape: HeightMap(file: \"height.png\"))";
    let edits = "edits: \"mine.edits-0123456789abcdef.ron\"";
    std::fs::write(at("mine.ron"), format!("(version: 3, radius_km: 100.0, layers: [{layer}], {edits})")).unwrap();
    let read =
        || ["height.png", "mine.edits-0123456789abcdef.ron", "mine.ron"].map(|name| std::fs::read(at(name)).unwrap());
    let before = read();
    let picture = at("height.png");
    let mut harness = editor(vec![
        Some(at("mine.ron")),
        Some(at("mine.edits-0123456789abcdef.ron")),
        Some(picture.clone()),
        Some(folder.path().to_owned()),
    ]);
    send(&mut harness, Command::Open);
    assert_eq!(harness.state().document().path(), Some(at("mine.ron").as_path()));
    let refused = |harness: &mut Editor, command: Command, title: &str| {
        send(harness, command);
        harness.run_steps(3);
        assert!(harness.query_by_label_contains(title).is_some(), "{title}");
        assert!(harness.query_by_label_contains("which would be lost; write to another file").is_some(), "{title}");
        click(harness, "Dismiss");
        assert!(read() == before, "{title}: something has changed");
    };
    refused(&mut harness, Command::SaveAs, "The planet could not be saved");
    refused(&mut harness, Command::ExportTable, "The biome table could not be exported");
    // Its maps would be called as the picture is.
    send(&mut harness, Command::Bake);
    harness.state_mut().push(Action::Bake(BakeAction::Ask));
    harness.run_steps(4);
    assert!(harness.query_by_label_contains("The maps could not be baked").is_some());
    assert!(read() == before && std::fs::read_dir(folder.path()).unwrap().count() == 3);
}
