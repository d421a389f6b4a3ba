//! The list of ground edits baked into a picture; the points of an edit.

use super::app::{self, canvas, click, planet, undo_label, undo_len};
use super::sculpt::{open, small, stroke};
use eframe::egui;
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;
use tellus::planet::edits::{EditPoint, GroundEdit, Raise, Tool};
use tellus::planet::picture::PictureExtent;

#[test]
fn edits_in_the_list_are_baked_into_a_picture_in_one_step_and_undo_brings_them_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("hills.exr");
    let mut small = small();
    let points = |lat_deg: f64| {
        [EditPoint { latitude_deg: lat_deg, longitude_deg: 20.0, ..EditPoint::default() }].into_iter().collect()
    };
    let raise = |name: &str, lat_deg: f64| GroundEdit {
        name: name.to_owned(),
        points: points(lat_deg),
        ..GroundEdit::of(Tool::Raise(Raise { amount_m: 600.0 }))
    };
    small.edits = [raise("hill", 10.0), raise("mound", 50.0), raise("hill two", 11.0)].into_iter().collect();
    let mut harness = app::open_planet_with_answers([1024.0, 640.0], small, vec![Some(file.clone())]);
    app::send(&mut harness, Command::TakeTool(0));
    app::send(&mut harness, Command::PutDownTool);
    let before = planet(&harness).edits;
    harness.get_by_label("Find edits").click();
    harness.run_steps(2);
    harness.get_by_label("Find edits").type_text("hill");
    harness.run_steps(2);
    click(&mut harness, "Bake edits");
    app::until(&mut harness, "the edits are baked", |harness| undo_len(harness) == 1);
    assert_eq!(undo_label(&harness), "Bake 2 edits");
    let after = planet(&harness).edits;
    let names: Vec<&str> = after.iter().map(|edit| edit.name.as_str()).collect();
    assert_eq!(names, ["mound", "Baked: 2 edits"]);
    let Some(Tool::Picture(stamp)) = after.get(1).map(|edit| &edit.tool) else { panic!("{after:?}") };
    // The ground is that of the picture at once.
    assert!(stamp.file.picture(PictureExtent::Place).is_some() && file.is_file());
    assert!((1190.0..=1200.01).contains(&stamp.height_m), "{}", stamp.height_m);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Baked 2 edits into hills.exr").is_some());
    assert_eq!(harness.state().viewport().tab.sculpt.selected, Some(1));
    app::send(&mut harness, Command::Undo);
    assert!(planet(&harness).edits == before);
}

#[test]
fn a_line_tapers_by_its_points_and_a_pen_that_presses_lightly_does_little() {
    let mut harness = open();
    let middle = canvas(&harness).center();
    app::send(&mut harness, Command::TakeTool(0));
    let touch = |force: f32| egui::Event::Touch {
        device_id: egui::TouchDeviceId(1),
        id: egui::TouchId(1),
        phase: egui::TouchPhase::Move,
        pos: middle,
        force: Some(force),
    };
    let button = |pressed| egui::Event::PointerButton {
        pos: middle,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    };
    harness.hover_at(middle);
    harness.run_steps(2);
    [touch(0.25), button(true)].into_iter().for_each(|event| harness.event(event));
    harness.run_steps(2);
    for (step, force) in [(1, 0.5), (2, 0.75), (3, 0.0)] {
        harness.event(touch(force));
        harness.event(egui::Event::PointerMoved(middle + egui::vec2(40.0 * step as f32, 0.0)));
        harness.run_steps(2);
    }
    harness.event(button(false));
    harness.run_steps(3);
    let strengths = |harness: &app::Editor, edit: usize| -> Vec<f64> {
        planet(harness).edits.get(edit).unwrap().points.0.iter().map(|point| point.strength).collect()
    };
    // A pen that is lifted tells no force any more.
    let drawn = strengths(&harness, 0);
    assert!(drawn[0] == 0.5 && drawn.last() == Some(&0.75), "{drawn:?}");
    // A mouse presses fully.
    let below = middle + egui::vec2(0.0, 90.0);
    stroke(&mut harness, below, below + egui::vec2(90.0, 0.0), egui::Modifiers::NONE);
    assert!(strengths(&harness, 1).iter().all(|strength| *strength == 1.0), "{:?}", strengths(&harness, 1));

    app::send(&mut harness, Command::PutDownTool);
    let count = strengths(&harness, 1).len();
    // Below the edge of the window.
    harness.get_by_label(&format!("{count} points")).click_accesskit();
    harness.run_steps(20);
    let before = undo_len(&harness);
    harness.get_by_label("Taper both").click_accesskit();
    harness.run_steps(3);
    assert_eq!(undo_len(&harness), before + 1);
    let tapered = strengths(&harness, 1);
    assert!(tapered[0] == 0.1 && tapered[count - 1] == 0.1 && tapered[count / 2] > 0.8, "{tapered:?}");
    assert!(harness.query_by_label("Width of point 1").is_some());

    // A point that is moved keeps both.
    let points = |harness: &app::Editor| planet(harness).edits.get(1).unwrap().points.0.clone();
    let before = points(&harness);
    let end = below + egui::vec2(90.0, 0.0);
    app::drag(&mut harness, end, end + egui::vec2(0.0, 25.0));
    let after = points(&harness);
    assert_eq!(undo_label(&harness), "Move point of edit");
    let (was, is) = (before[count - 1], after[count - 1]);
    assert!((was.latitude_deg - is.latitude_deg).abs() > 0.5, "{was:?} {is:?}");
    assert_eq!((is.width, is.strength), (was.width, was.strength));
}

#[test]
fn an_edit_gets_a_mask_by_name_that_is_painted_and_chosen_from_the_menu() {
    let mut small = small();
    let everywhere = GroundEdit {
        name: "Plateau".to_owned(),
        radius_km: 1500.0,
        softness: 0.1,
        points: [EditPoint { latitude_deg: 10.0, longitude_deg: 20.0, ..EditPoint::default() }].into_iter().collect(),
        ..GroundEdit::of(Tool::Raise(Raise { amount_m: 600.0 }))
    };
    small.edits = [everywhere].into_iter().collect();
    let mut harness = app::open_planet_with_picture([1024.0, 640.0], small);
    app::wait_for_picture(&mut harness);
    app::send(&mut harness, Command::TakeTool(0));
    app::send(&mut harness, Command::PutDownTool);
    click(&mut harness, "Edit Plateau");
    assert!(harness.query_by_label("Paint mask of Plateau").is_none());
    app::unfold(&mut harness, "Acts on");
    app::scroll_to(&mut harness, "Mask of Plateau");
    harness.get_by_label("Mask of Plateau").focus();
    harness.run_steps(2);
    app::type_text(&mut harness, "Zone");
    harness.run_steps(3);
    assert_eq!(planet(&harness).edits.get(0).unwrap().mask, "Zone");
    let highest_m = |harness: &app::Editor| {
        let planet = planet(harness);
        let at = planet.edits.get(1).map(|edit| edit.points.0[0].direction());
        at.map(|dir| tellus::terrain::Terrain::try_new(planet.into()).unwrap().height_m(dir))
    };
    app::scroll_to(&mut harness, "Paint mask of Plateau");
    click(&mut harness, "Paint mask of Plateau");
    let middle = canvas(&harness).center();
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 0.0), egui::Modifiers::NONE);
    assert_eq!(undo_label(&harness), "Mask");
    assert!(highest_m(&harness).unwrap() > 500.0, "{:?}", highest_m(&harness));
    // Shift erases.
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 0.0), egui::Modifiers::SHIFT);
    assert!(highest_m(&harness).unwrap().abs() < 1e-6, "{:?}", highest_m(&harness));

    // The menu has the masks of the planet, and none.
    app::scroll_to(&mut harness, "Edit Plateau");
    click(&mut harness, "Edit Plateau");
    app::scroll_to(&mut harness, "Choose Mask of Plateau");
    click(&mut harness, "Choose Mask of Plateau");
    assert!(harness.query_by_label("Zone").is_some());
    click(&mut harness, "None");
    assert_eq!(planet(&harness).edits.get(0).unwrap().mask, "");
    assert!(highest_m(&harness).unwrap() > 500.0, "{:?}", highest_m(&harness));
}
