//! Layers and parts through the clipboard, as text.

use super::*;
use tellus::editor::command::{ClipAction, Wanted};
use tellus::planet::{Clouds, snippet};

/// The text that the editor has put into the clipboard.
fn copied(harness: &Editor) -> String {
    let commands = &harness.output().platform_output.commands;
    let text = commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    });
    text.unwrap_or_default()
}

/// Sends an action and gives the text that it copied.
fn copy(harness: &mut Editor, action: ClipAction) -> String {
    harness.state_mut().push(Action::Clip(action));
    harness.step();
    let text = copied(harness);
    harness.run_steps(2);
    text
}

/// Pastes as the desktop does: the text comes in a later frame.
fn paste(harness: &mut Editor, wanted: Wanted, text: &str) {
    harness.state_mut().push(Action::Clip(ClipAction::Ask(wanted)));
    harness.run_steps(2);
    harness.event(egui::Event::Paste(text.to_owned()));
    harness.run_steps(3);
}

#[test]
fn a_layer_goes_to_another_planet() {
    let mut from = editor(vec![]);
    let layer = planet(&from).layers[2].clone();
    let text = copy(&mut from, ClipAction::CopyLayers(vec![2]));
    assert!(text.contains(&layer.name) && text.contains("layers"), "{text}");

    let mut to = app::open_planet([1024.0, 640.0], Planet::default());
    paste(&mut to, Wanted::Layers { after: None }, &text);
    assert_eq!(planet(&to).layers.len(), 1);
    assert_eq!(undo_label(&to), "Paste layer");
    paste(&mut to, Wanted::Layers { after: Some(0) }, &text);
    let names: Vec<String> = planet(&to).layers.iter().map(|layer| layer.name.clone()).collect();
    assert_eq!(names, [layer.name.clone(), format!("{} 2", layer.name)], "names stay unique");

    click(&mut from, "Terrain");
    from.get_by_label(&format!("Layer {}", layer.name)).click_secondary();
    from.run_steps(3);
    click(&mut from, "Cut");
    assert!(planet(&from).layers.iter().all(|other| other.name != layer.name));
}

#[test]
fn the_keys_of_the_desktop_work_over_the_list() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Terrain");
    let before = planet(&harness);
    let row = harness.get_by_label(&format!("Layer {}", before.layers[1].name)).rect().center();
    click(&mut harness, &format!("Layer {}", before.layers[1].name));
    harness.hover_at(row);
    harness.step();
    harness.event(egui::Event::Cut);
    harness.step();
    harness.step();
    let text = copied(&harness);
    harness.run_steps(3);
    assert_eq!(planet(&harness).layers.len(), before.layers.len() - 1);
    harness.event(egui::Event::Paste(text));
    harness.run_steps(3);
    assert_eq!(planet(&harness).layers.len(), before.layers.len());
    // The pasted layer is the selected one: Delete removes it, and undo brings it back.
    let pasted = planet(&harness);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Delete);
    let left: Vec<String> = planet(&harness).layers.iter().map(|layer| layer.name.clone()).collect();
    assert!(left.len() + 1 == before.layers.len() && !left.contains(&before.layers[1].name), "{left:?}");
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::Z);
    assert_eq!(planet(&harness), pasted);
    // Away from the list the keys are no business of it.
    harness.hover_at(egui::pos2(200.0, 300.0));
    harness.step();
    harness.event(egui::Event::Cut);
    harness.run_steps(3);
    assert_eq!(planet(&harness).layers.len(), before.layers.len());
}

#[test]
fn a_part_goes_to_another_planet_and_what_does_not_fit_is_told() {
    let clouds = Clouds { coverage: 0.77, ..Clouds::default() };
    let text = snippet::of_part(&Planet { clouds: Some(clouds.clone()), ..Planet::default() }, "clouds").unwrap();
    let mut harness = editor(vec![]);
    let before = planet(&harness);
    harness.get_by_label("Clouds").click_secondary();
    harness.run_steps(3);
    click(&mut harness, "Paste clouds");
    harness.event(egui::Event::Paste(text));
    harness.run_steps(3);
    assert_eq!(planet(&harness).clouds, Some(clouds));
    assert_eq!(undo_label(&harness), "Paste clouds");

    for (wanted, text, why) in [
        (Wanted::Part("clouds"), "(version: 3, star: ())", "The clipboard holds no clouds"),
        (Wanted::Layers { after: None }, "(version: 3, star: ())", "The clipboard holds no layer"),
        (Wanted::Part("clouds"), "a shopping list", "clipboard:1:1"),
    ] {
        let steps = undo_len(&harness);
        paste(&mut harness, wanted, text);
        assert!(harness.query_by_label_contains(why).is_some(), "{why}");
        click(&mut harness, "Dismiss");
        assert_eq!(undo_len(&harness), steps);
    }
    let whole = copy(&mut harness, ClipAction::CopyPart(""));
    let mut other = app::open_planet([1024.0, 640.0], Planet::default());
    paste(&mut other, Wanted::Part(""), &whole);
    assert_eq!(planet(&other).layers, before.layers);
}
