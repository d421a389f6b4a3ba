//! Sculpting: each tool on the planet, the list of edits, undo and redo.

use super::app::{self, canvas, click, planet, undo_label, undo_len};
use super::{press, slide};
use eframe::egui;
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;
use tellus::editor::viewport::layer_view::LayerQuantity;
use tellus::planet::edits::{PictureStamp, Raise, Tool};
use tellus::planet::param::Choice;
use tellus::planet::picture::PictureExtent;
use tellus::planet::{GroundEdits, Layer, Mask, PaintedMask, Planet, Water};

pub(super) fn small() -> Planet {
    Planet { radius_km: 1000.0, water: Some(Water { level_m: -100.0, ..Water::default() }), ..Planet::default() }
}

pub(super) fn open() -> app::Editor {
    let mut harness = app::open_planet_with_picture([1024.0, 640.0], small());
    app::wait_for_picture(&mut harness);
    // Opens the tab.
    app::send(&mut harness, Command::TakeTool(0));
    app::send(&mut harness, Command::PutDownTool);
    harness
}

pub(super) fn stroke(harness: &mut app::Editor, from: egui::Pos2, to: egui::Pos2, modifiers: egui::Modifiers) {
    let button =
        |pos, pressed| egui::Event::PointerButton { pos, button: egui::PointerButton::Primary, pressed, modifiers };
    harness.event(egui::Event::ModifiersChanged(modifiers));
    harness.hover_at(from);
    harness.run_steps(2);
    harness.event(button(from, true));
    harness.run_steps(2);
    for share in [0.25, 0.5, 0.75, 1.0] {
        harness.event(egui::Event::PointerMoved(from + (to - from) * share));
        harness.run_steps(2);
    }
    harness.event(button(to, false));
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::NONE));
    harness.run_steps(3);
}

#[test]
fn every_tool_makes_an_edit_with_a_drag_and_each_is_one_step_that_is_undone_and_redone() {
    let mut harness = open();
    let middle = canvas(&harness).center();
    let eye = harness.state().viewport().eye(&planet(&harness)).1;
    for (number, label) in Tool::LABELS.iter().enumerate() {
        app::send(&mut harness, Command::TakeTool(number));
        let from = middle + egui::vec2(-70.0 + 8.0 * number as f32, -50.0);
        stroke(&mut harness, from, from + egui::vec2(40.0, 60.0), egui::Modifiers::NONE);
        let edits = planet(&harness).edits;
        assert_eq!((edits.len(), undo_len(&harness), undo_label(&harness).as_str()), (number + 1, number + 1, *label));
        let edit = edits.get(number).unwrap();
        assert_eq!(edit.tool.index(), number);
        let count = edit.points.0.len();
        assert!(if edit.tool.is_stamp() { count == 1 && edit.radius_km > 50.0 } else { count > 2 }, "{label} {count}");
    }
    assert_eq!(harness.state().viewport().eye(&planet(&harness)).1, eye, "the planet does not turn");
    let all = planet(&harness).edits;
    for left in (all.len() - 2..all.len()).rev() {
        app::send(&mut harness, Command::Undo);
        assert_eq!(planet(&harness).edits.len(), left);
    }
    for _ in 0..2 {
        app::send(&mut harness, Command::Redo);
    }
    assert!(planet(&harness).edits == all);

    // With Shift the ground is lowered, with Alt the planet turns.
    app::send(&mut harness, Command::TakeTool(0));
    let low = middle + egui::vec2(-60.0, 80.0);
    stroke(&mut harness, low, low + egui::vec2(30.0, 0.0), egui::Modifiers::SHIFT);
    let lowered = planet(&harness).edits.get(all.len()).unwrap().clone();
    assert!(matches!(lowered.tool, Tool::Raise(Raise { amount_m }) if amount_m < 0.0), "{lowered:?}");
    let before = undo_len(&harness);
    let free = middle + egui::vec2(20.0, 100.0);
    stroke(&mut harness, free, free + egui::vec2(30.0, 0.0), egui::Modifiers::ALT);
    assert_eq!(undo_len(&harness), before);
    assert_ne!(harness.state().viewport().eye(&planet(&harness)).1, eye);
}

/// A new tool fits the view, and Escape puts it down once no window is open.
#[test]
fn a_tool_fits_the_view_and_escape_puts_it_down() {
    let mut harness = open();
    app::send(&mut harness, Command::TakeTool(5));
    app::send(&mut harness, Command::History);
    let brush = |harness: &app::Editor| harness.state().viewport().tab.sculpt.brush.clone();
    let radius_km = brush(&harness).unwrap().radius_km;
    assert!((20.0..=80.0).contains(&radius_km), "{radius_km} km on a planet of 1000 km that fills the picture");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(brush(&harness).is_some(), "the window closes first");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(brush(&harness).is_none());
}

#[test]
fn a_line_grows_click_by_click_until_enter_and_its_points_are_moved_by_hand() {
    let mut harness = open();
    let middle = canvas(&harness).center();
    let tap = |harness: &mut app::Editor, at: egui::Pos2| {
        harness.hover_at(at);
        harness.run_steps(2);
        harness.drag_at(at);
        harness.run_steps(1);
        harness.drop_at(at);
        // Far enough apart that two clicks are no double click.
        harness.run_steps(40);
    };
    click(&mut harness, "Tool Ridge");
    for (x, y) in [(-80.0, 0.0), (0.0, -60.0), (80.0, 10.0)] {
        tap(&mut harness, middle + egui::vec2(x, y));
    }
    let edits = planet(&harness).edits;
    assert_eq!((edits.len(), edits.get(0).unwrap().points.0.len(), undo_len(&harness)), (1, 3, 3));
    harness.key_press(egui::Key::Enter);
    harness.run_steps(3);
    tap(&mut harness, middle + egui::vec2(0.0, 90.0));
    assert_eq!(planet(&harness).edits.len(), 2, "after Enter a click begins another line");

    // Without a tool, points of the selected edit are moved.
    app::send(&mut harness, Command::PutDownTool);
    let before = planet(&harness).edits.get(1).unwrap().points.clone();
    stroke(&mut harness, middle + egui::vec2(0.0, 90.0), middle + egui::vec2(40.0, 60.0), egui::Modifiers::NONE);
    assert_eq!(undo_label(&harness), "Move point of edit");
    assert_ne!(planet(&harness).edits.get(1).unwrap().points, before);
}

#[test]
fn edits_are_listed_found_hidden_changed_moved_and_removed() {
    let mut harness = open();
    let middle = canvas(&harness).center();
    for (tool, x) in [("Tool Crater", -60.0), ("Tool Volcano", 30.0)] {
        click(&mut harness, tool);
        let from = middle + egui::vec2(x, 0.0);
        stroke(&mut harness, from, from + egui::vec2(40.0, 0.0), egui::Modifiers::NONE);
    }
    app::send(&mut harness, Command::PutDownTool);
    assert!(harness.query_by_label("Edit Crater 1").is_some());
    click(&mut harness, "Edit Crater 1");
    click(&mut harness, "Enabled of Crater 1");
    assert_eq!(undo_label(&harness), "Hide Crater 1");
    assert!(!planet(&harness).edits.get(0).unwrap().enabled);
    slide(&mut harness, "Softness of Crater 1", 0.5);
    assert_eq!(undo_label(&harness), "Change softness of Crater 1");
    click(&mut harness, "Move edit down");
    let names = |edits: &GroundEdits| edits.iter().map(|edit| edit.name.clone()).collect::<Vec<_>>();
    assert_eq!(names(&planet(&harness).edits), ["Volcano 2", "Crater 1"]);
    click(&mut harness, "Duplicate edit");
    assert_eq!(planet(&harness).edits.len(), 3);
    click(&mut harness, "Remove edit");
    click(&mut harness, "Remove edit");
    assert_eq!(names(&planet(&harness).edits), ["Volcano 2"]);
    harness.get_by_label("Find edits").click();
    harness.run_steps(2);
    app::type_text(&mut harness, "crat");
    assert!(harness.query_by_label("Edit Volcano 2").is_none());
}

#[test]
fn a_whole_edit_is_moved_turned_and_scaled_by_its_handles() {
    let mut harness = open();
    let middle = canvas(&harness).center();
    let (left, right) = (middle + egui::vec2(-60.0, 20.0), middle + egui::vec2(60.0, 20.0));
    click(&mut harness, "Tool Wall");
    stroke(&mut harness, left, right, egui::Modifiers::NONE);
    app::send(&mut harness, Command::PutDownTool);
    let edit = |harness: &app::Editor| planet(harness).edits.get(0).unwrap().clone();
    let spread = |edit: &tellus::planet::GroundEdit| {
        let points = &edit.points.0;
        points[0].direction().angle_between(points[points.len() - 1].direction())
    };
    let first = edit(&harness);
    stroke(&mut harness, right, right + egui::vec2(0.0, -40.0), egui::Modifiers::COMMAND);
    let moved = edit(&harness);
    assert_eq!(undo_label(&harness), "Move edit");
    assert!((spread(&moved) / spread(&first) - 1.0).abs() < 1e-4 && moved.points.0[0] != first.points.0[0]);
    let grabbed = right + egui::vec2(0.0, -40.0);
    stroke(&mut harness, grabbed, grabbed + egui::vec2(-25.0, -25.0), egui::Modifiers::SHIFT);
    let turned = edit(&harness);
    assert_eq!(undo_label(&harness), "Turn edit");
    assert!(spread(&turned) < 0.95 * spread(&moved) && turned.points.0.len() == moved.points.0.len());
    for before in [&moved, &first] {
        app::send(&mut harness, Command::Undo);
        assert!(edit(&harness) == *before);
    }
}

#[test]
fn ways_are_measured_and_forgotten_without_an_edit() {
    let mut harness = open();
    let middle = canvas(&harness).center();
    app::send(&mut harness, Command::Measure);
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 30.0), egui::Modifiers::NONE);
    assert!(harness.query_by_label_contains("Length ").is_some() && harness.query_by_label_contains("Area ").is_none());
    assert_eq!(undo_len(&harness), 0);
    harness.key_press(egui::Key::Escape);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("Length ").is_none());
    click(&mut harness, "Tool Measure");
    let eye = harness.state().viewport().eye(&planet(&harness)).1;
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 30.0), egui::Modifiers::NONE);
    assert_ne!(harness.state().viewport().eye(&planet(&harness)).1, eye, "without the tool the planet turns");
}

#[test]
fn paint_of_a_biome_follows_its_key() {
    use tellus::editor::state::document::Document;
    use tellus::planet::edits::{BiomePaint, EditPoint, GroundEdit};
    let mut planet = tellus::planet::shipped::default_planet();
    let old = planet.biomes.palette[2].key;
    let mut edit = GroundEdit { tool: Tool::Biome(BiomePaint { biome: old, strength: 1.0 }), ..GroundEdit::default() };
    edit.points.0 = vec![EditPoint::default()];
    planet.edits.push(edit);
    let mut document = Document::new(planet.clone(), None);
    planet.biomes.palette[2].key = '~';
    planet.biomes.replace_key(old, '~');
    document.edit(planet.clone(), None);
    let painted = |document: &Document| match document.planet().edits.get(0).unwrap().tool {
        Tool::Biome(BiomePaint { biome, .. }) => biome,
        _ => '!',
    };
    assert_eq!(painted(&document), '~');
    let first = planet.biomes.palette[0].key;
    planet.biomes.replace_key('~', first);
    planet.biomes.palette.remove(2);
    document.edit(planet, None);
    assert_eq!(painted(&document), first);
    assert!(document.planet().check().is_ok());
}

/// Random edits through the document: undo to the start and redo to the end give the same planets.
#[test]
fn two_thousand_random_changes_are_undone_and_redone_to_the_bit() {
    use tellus::editor::state::document::Document;
    use tellus::planet::edits::{EditPoint, GroundEdit};
    let mut dice = super::dice::Dice(5);
    let mut document = Document::new(small(), None);
    let mut states = vec![document.planet().clone()];
    for number in 0..2000 {
        let mut planet = (**document.planet()).clone();
        let count = planet.edits.len();
        let at = (dice.roll() * count as f64) as usize;
        match (dice.roll() * 5.0) as u32 {
            0 if count > 0 => drop(planet.edits.remove(at)),
            1 if count > 1 => planet.edits.shift(at, count - 1 - at),
            2 if count > 0 => planet.edits.get_mut(at).unwrap().radius_km = 1.0 + dice.roll() * 100.0,
            _ => {
                let tool = Tool::of_kind((dice.roll() * Tool::NAMES.len() as f64) as usize).unwrap();
                let mut edit = GroundEdit { tool, ..GroundEdit::default() };
                edit.points.0 = vec![EditPoint { latitude_deg: dice.roll() * 80.0, ..EditPoint::default() }];
                planet.edits.push(edit);
            }
        }
        document.edit(planet, Some(format!("Change {number}")));
        document.settle();
        if document.planet() != &states[states.len() - 1] {
            states.push(document.planet().clone());
        }
    }
    // The steps beyond the limit of the history are gone.
    let (last, steps) = (states.len() - 1, document.history().undo_len());
    assert!(last > 1500 && steps == 500.min(last), "{last} {steps}");
    for back in 1..=steps {
        document.undo();
        assert!(*document.planet() == states[last - back], "{back} steps back");
    }
    for forth in (0..steps).rev() {
        document.redo();
        assert!(*document.planet() == states[last - forth], "{forth} steps left");
    }
    assert_eq!(document.planet().to_text(), states[last].to_text());
}

#[test]
fn a_picture_is_chosen_for_the_brush_placed_turned_by_its_handle_and_saved_beside_the_preset() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let pixels: Vec<u8> = (0..16 * 16).map(|i| 100 + (i / 2) as u8).collect();
    image::save_buffer(path("hill.png"), &pixels, 16, 16, image::ExtendedColorType::L8).unwrap();
    let answers = vec![Some(path("hill.png")), Some(path("mine.ron"))];
    let mut harness = app::open_planet_with_answers([1024.0, 640.0], small(), answers);
    app::wait_for_picture(&mut harness);
    let number = Tool::NAMES.iter().position(|name| *name == "Picture").unwrap();
    app::send(&mut harness, Command::TakeTool(number));
    assert!(harness.query_all_by_label_contains("Choose a height picture").next().is_some());
    click(&mut harness, "Browse…");
    harness.run_steps(2);
    assert!(harness.query_all_by_label_contains("Choose a height picture").next().is_none());
    let stamps = |harness: &app::Editor| -> Vec<PictureStamp> {
        let planet = planet(harness);
        let stamps = planet.edits.iter().filter_map(|edit| match &edit.tool {
            Tool::Picture(stamp) => Some(stamp.clone()),
            _ => None,
        });
        stamps.collect()
    };
    let is_loaded = |stamp: &PictureStamp| stamp.file.picture(PictureExtent::Place).is_some();
    let middle = canvas(&harness).center();
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 0.0), egui::Modifiers::NONE);
    app::until(&mut harness, "the picture is read", |harness| stamps(harness).iter().all(is_loaded));
    let highest_m = |harness: &app::Editor| {
        let planet = planet(harness);
        let middle = planet.edits.get(0).unwrap().points.0[0].direction();
        tellus::terrain::Terrain::try_new(planet.into()).unwrap().height_m(middle)
    };
    assert!(highest_m(&harness) > 500.0, "{}", highest_m(&harness));
    // The next one has its pixels at once.
    let aside = middle + egui::vec2(0.0, 120.0);
    stroke(&mut harness, aside, aside + egui::vec2(30.0, 0.0), egui::Modifiers::NONE);
    assert!(stamps(&harness).len() == 2 && stamps(&harness).iter().all(is_loaded));

    // The square at the right edge of the selected one turns it: downwards is a quarter clockwise.
    app::send(&mut harness, Command::PutDownTool);
    stroke(&mut harness, aside + egui::vec2(30.0, 0.0), aside + egui::vec2(0.0, 30.0), egui::Modifiers::NONE);
    let turned = stamps(&harness);
    assert!((turned[1].turn_deg - 90.0).abs() < 25.0 && turned[0].turn_deg == 0.0, "{turned:?}");

    app::send(&mut harness, Command::SaveAs);
    harness.run_steps(3);
    let text = std::fs::read_to_string(path("mine.ron")).unwrap();
    assert_eq!(text.matches("file: \"hill.png\"").count(), 2, "{text}");
    assert_eq!(Planet::load(path("mine.ron")).unwrap().edits.len(), 2);
}

#[test]
fn a_painted_mask_of_a_layer_takes_the_mask_tool_and_strokes_let_the_layer_act() {
    let layer = |masks: Vec<Mask>| Layer { name: "Bumps".to_owned(), bias: 2.0, masks, ..Layer::default() };
    let mask = Mask::Painted(PaintedMask { mask: "Dry".to_owned(), ..PaintedMask::default() });
    let mut harness =
        app::open_planet_with_picture([1024.0, 640.0], Planet { layers: vec![layer(vec![mask])], ..small() });
    app::wait_for_picture(&mut harness);
    click(&mut harness, "Terrain");
    app::scroll_to(&mut harness, "Paint mask 1 of Bumps");
    click(&mut harness, "Paint mask 1 of Bumps");
    app::until(&mut harness, "the mask on the planet", |harness| {
        harness.state().viewport().layer_view().quantity() == Some(LayerQuantity::Mask)
    });
    let middle = canvas(&harness).center();
    let highest_m = |harness: &app::Editor| {
        let planet = planet(harness);
        let at = planet.edits.get(0).map(|edit| edit.points.0[0].direction());
        at.map(|dir| tellus::terrain::Terrain::try_new(planet.into()).unwrap().height_m(dir))
    };
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 0.0), egui::Modifiers::NONE);
    assert!(highest_m(&harness).unwrap() > 500.0, "{:?}", highest_m(&harness));
    assert_eq!(undo_label(&harness), "Mask");
    let names = |harness: &app::Editor| -> Vec<String> {
        let planet = planet(harness);
        let names = planet.edits.iter().filter_map(|edit| match &edit.tool {
            Tool::Mask(paint) => Some(format!("{} {}", paint.mask, paint.amount)),
            _ => None,
        });
        names.collect()
    };
    // Shift erases.
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 0.0), egui::Modifiers::SHIFT);
    assert_eq!(names(&harness), ["Dry 1", "Dry -1"]);
    assert!(highest_m(&harness).unwrap().abs() < 1e-6, "{:?}", highest_m(&harness));
}

#[test]
fn each_stamp_and_each_field_is_a_step_even_if_a_key_was_never_released() {
    let mut harness = open();
    // Its name at the release is another one.
    harness.event(egui::Event::Key {
        key: egui::Key::Plus,
        physical_key: None,
        pressed: true,
        repeat: false,
        modifiers: egui::Modifiers::SHIFT,
    });
    harness.run_steps(2);
    let volcano = Tool::NAMES.iter().position(|name| *name == "Volcano").unwrap();
    app::send(&mut harness, Command::TakeTool(volcano));
    let middle = canvas(&harness).center();
    for (number, by) in [-80.0, 0.0, 80.0].into_iter().enumerate() {
        let place = middle + egui::vec2(by, 30.0);
        for event in [
            egui::Event::PointerMoved(place),
            egui::Event::PointerButton {
                pos: place,
                button: egui::PointerButton::Primary,
                pressed: true,
                modifiers: egui::Modifiers::NONE,
            },
            egui::Event::PointerButton {
                pos: place,
                button: egui::PointerButton::Primary,
                pressed: false,
                modifiers: egui::Modifiers::NONE,
            },
        ] {
            harness.event(event);
        }
        harness.run_steps(3);
        assert_eq!((planet(&harness).edits.len(), undo_len(&harness)), (number + 1, number + 1));
    }
    app::send(&mut harness, Command::PutDownTool);
    slide(&mut harness, "Radius of Volcano 3", 12.0);
    assert_eq!(undo_label(&harness), "Change radius of Volcano 3");
    slide(&mut harness, "Softness of Volcano 3", 0.5);
    assert_eq!((undo_label(&harness).as_str(), undo_len(&harness)), ("Change softness of Volcano 3", 5));
}

#[test]
fn a_drag_ends_where_the_button_is_released_and_one_within_a_frame_is_a_drag() {
    let mut harness = open();
    let crater = Tool::NAMES.iter().position(|name| *name == "Crater").unwrap();
    app::send(&mut harness, Command::TakeTool(crater));
    let middle = canvas(&harness).center();
    let button = |pos, pressed| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers: egui::Modifiers::NONE,
    };
    stroke(&mut harness, middle, middle + egui::vec2(60.0, 0.0), egui::Modifiers::NONE);
    // All of it arrives in one frame. The hook of the editor sorts it, which the harness does not call.
    let aside = middle + egui::vec2(0.0, 10.0);
    let to = aside + egui::vec2(60.0, 0.0);
    let mut waiting = vec![
        egui::Event::PointerMoved(aside),
        button(aside, true),
        egui::Event::PointerMoved(aside + egui::vec2(30.0, 0.0)),
        egui::Event::PointerMoved(to),
        button(to, false),
    ];
    let mut late = tellus::editor::late_input::LateInput::default();
    let mut waits = true;
    while waits {
        waits = late.admit(&mut waiting);
        waiting.drain(..).for_each(|event| harness.event(event));
        harness.run_steps(1);
    }
    harness.run_steps(2);
    let radii: Vec<f64> = planet(&harness).edits.iter().map(|edit| edit.radius_km).collect();
    assert!(radii.len() == 2 && (radii[1] / radii[0] - 1.0).abs() < 0.05, "{radii:?}");
}
