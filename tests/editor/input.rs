//! Typed numbers, keys, menus, windows.

use super::*;

/// Types into a field that shows a number.
fn enter(harness: &mut Editor, label: &str, text: &str) {
    harness.get_by_role_and_label(Role::SpinButton, label).focus();
    harness.run_steps(2);
    press(harness, egui::Modifiers::COMMAND, egui::Key::A);
    harness.event(egui::Event::Text(text.to_owned()));
    harness.run_steps(1);
    press(harness, egui::Modifiers::NONE, egui::Key::Enter);
}

#[test]
fn a_number_that_is_refused_says_why() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Star");
    let before = planet(&harness).star.latitude_deg;
    for (typed, why) in [
        ("abc", "\"abc\" is not a number; use -90 to 90°"),
        ("5 km", "\"5 km\" is not in °; use -90 to 90°"),
        ("95", "95 is out of range; use -90 to 90°"),
    ] {
        enter(&mut harness, "Latitude of star as a number", typed);
        assert!(harness.query_by_label(why).is_some(), "{typed}");
        assert_eq!(planet(&harness).star.latitude_deg, before, "{typed}");
    }
    enter(&mut harness, "Latitude of star as a number", "45°");
    assert_eq!(planet(&harness).star.latitude_deg, 45.0);
    assert!(harness.query_by_label_contains("out of range").is_none());
    enter(&mut harness, "Season", "100");
    assert!(harness.query_by_label("100 is out of range; use -90 to 90°").is_some());

    click(&mut harness, "Planet");
    enter(&mut harness, "Seed of planet", "1.5");
    assert!(harness.query_by_label_contains("1.5 is not a whole number; use 0 to 4294967295").is_some());
}

#[test]
fn the_dice_stay_where_they_are() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    let dice = |harness: &Editor| harness.get_by_label("Random Seed of planet").rect();
    enter(&mut harness, "Seed of planet", "7");
    let before = dice(&harness);
    enter(&mut harness, "Seed of planet", "4294967295");
    assert_eq!(planet(&harness).seed, u32::MAX);
    assert_eq!(dice(&harness), before);
}

#[test]
fn escape_closes_the_window_on_top() {
    let mut harness = editor(vec![]);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F8);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F1);
    let help = |harness: &Editor| harness.query_by_label("Walk; slower uphill").is_some();
    let performance = |harness: &Editor| harness.query_by_label_contains("times of the next edit").is_some();
    assert!(help(&harness) && performance(&harness));
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    harness.run_steps(20);
    assert!(!help(&harness) && performance(&harness));
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    harness.run_steps(20);
    assert!(!performance(&harness));
}

#[test]
fn escape_ends_a_comparison_once_no_window_is_open() {
    let mut harness = editor(vec![]);
    send(&mut harness, Command::Compare);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F8);
    assert!(harness.state().viewport().compare().is_some());
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(harness.state().viewport().compare().is_some(), "the window closes first");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(harness.state().viewport().compare().is_none());
}

/// A drag with Shift begins at the number that is there, wherever the slider is pressed.
#[test]
fn shift_drags_a_slider_finely() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    let before_km = planet(&harness).radius_km;
    let rect = harness.get_by_role_and_label(Role::Slider, "Radius of planet").rect();
    let (from, modifiers) = (rect.left_center() + egui::vec2(8.0, 0.0), egui::Modifiers::SHIFT);
    let button =
        |pos, pressed| egui::Event::PointerButton { pos, button: egui::PointerButton::Primary, pressed, modifiers };
    harness.event(egui::Event::ModifiersChanged(modifiers));
    harness.hover_at(from);
    harness.run_steps(2);
    harness.event(button(from, true));
    harness.run_steps(2);
    for _ in 0..2 {
        harness.event(egui::Event::PointerMoved(from + egui::vec2(0.5 * rect.width(), 0.0)));
        harness.run_steps(2);
    }
    harness.event(button(from + egui::vec2(0.5 * rect.width(), 0.0), false));
    harness.event(egui::Event::ModifiersChanged(egui::Modifiers::NONE));
    harness.run_steps(3);
    let grown = planet(&harness).radius_km / before_km;
    assert!((1.04..1.06).contains(&grown), "half the slider: {grown}");
}

#[test]
fn escape_ends_typing_before_it_closes_a_window() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F1);
    harness.get_by_role_and_label(Role::TextInput, "Name of planet").focus();
    harness.run_steps(2);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    assert!(harness.query_by_label("Walk; slower uphill").is_some());
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    harness.run_steps(20);
    assert!(harness.query_by_label("Walk; slower uphill").is_none());
}

#[test]
fn keys_stay_in_the_list_that_is_open() {
    let mut harness = editor(vec![]);
    let before = pose(&harness);
    click(&mut harness, "Planet");
    unfold(&mut harness, "Heights");
    for list in ["Precision of planet", "View"] {
        click(&mut harness, list);
        harness.key_down(egui::Key::D);
        harness.run_steps(5);
        harness.key_up(egui::Key::D);
        press(&mut harness, egui::Modifiers::NONE, egui::Key::Num2);
        press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
        harness.run_steps(3);
        assert_eq!(pose(&harness), before, "{list}");
        assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Shaded, "{list}");
    }
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Num2);
    assert_eq!(harness.state().viewport().settings.debug_view, DebugView::Height, "closed again");
}

#[test]
fn menus_that_do_not_fit_scroll() {
    let mut harness = app::open([800.0, 240.0], vec![]);
    click(&mut harness, "View");
    harness.run_steps(5);
    let reach = |harness: &Editor| harness.get_by_label_contains("Light or dark").rect().bottom();
    assert!(reach(&harness) > 240.0, "the menu is longer than the window");
    harness.get_by_label_contains("Light or dark").scroll_to_me();
    harness.run_steps(40);
    assert!(reach(&harness) <= 240.0, "{}", reach(&harness));
}

#[test]
fn the_panel_is_as_wide_as_it_was_after_every_tab() {
    let mut harness = editor(vec![]);
    let picture = |harness: &Editor| canvas(harness).right();
    click(&mut harness, "Planet");
    harness.run_steps(5);
    let before = picture(&harness);
    for tab in ["Atmosphere", "Water", "Clouds", "Biomes", "Terrain", "Star", "Climate", "Planet"] {
        harness.get_by_role_and_label(Role::Button, tab).click();
        harness.run_steps(10);
        assert_eq!(picture(&harness), before, "{tab}");
        for node in harness.query_all_by_role(Role::SpinButton) {
            assert!(node.rect().right() <= 1024.0, "{tab}: {:?}", node.rect());
        }
    }
}

#[test]
fn a_rule_names_a_biome_that_there_is() {
    let mut harness = editor(vec![]);
    begin_new(&mut harness);
    click(&mut harness, "Biomes");
    click(&mut harness, "Tables");
    click(&mut harness, "Mars");
    let biomes = |harness: &Editor| planet(harness).biomes;
    assert!(biomes(&harness).index_of(biomes(&harness).snow_key).is_none(), "no biome was chosen yet");
    unfold(&mut harness, "Snow");
    scroll_to(&mut harness, "Snow cover of biomes");
    click(&mut harness, "Snow cover of biomes");
    assert!(harness.state().document().problems().is_empty(), "{:?}", harness.state().document().problems());
    assert!(biomes(&harness).index_of(biomes(&harness).snow_key).is_some());
    let steps = undo_len(&harness);
    scroll_to(&mut harness, "Snow biome of biomes");
    click(&mut harness, "Snow biome of biomes");
    let (dust, index) = {
        let biomes = biomes(&harness);
        let index = biomes.palette.iter().position(|biome| biome.name == "Dust").unwrap();
        (biomes.palette[index].key, index)
    };
    let entries: Vec<_> = harness.query_all_by_role_and_label(Role::Button, "Dust").collect();
    entries.last().unwrap().click();
    harness.run_steps(3);
    assert_eq!(biomes(&harness).snow_key, dust);
    assert_eq!(undo_len(&harness), steps + 1);

    // A drag that switches a rule on is one step, with the biome that is chosen for the rule.
    let steps = undo_len(&harness);
    unfold(&mut harness, "Beaches");
    let slider = "Beach height of biomes";
    harness.get_by_role_and_label(Role::Slider, slider).scroll_to_me();
    harness.run_steps(40);
    let rect = harness.get_by_role_and_label(Role::Slider, slider).rect();
    harness.drag_at(rect.left_center() + egui::vec2(4.0, 0.0));
    for step in 1..6 {
        harness.hover_at(rect.left_center() + egui::vec2(10.0 * step as f32, 0.0));
        harness.run_steps(1);
    }
    harness.drop_at(rect.left_center() + egui::vec2(50.0, 0.0));
    harness.run_steps(3);
    assert!(biomes(&harness).beach_m > 0.0 && biomes(&harness).index_of(biomes(&harness).beach_key).is_some());
    assert_eq!((undo_len(&harness), undo_label(&harness)), (steps + 1, "Change beach height of biomes".to_owned()));

    // The rule of a removed biome changes with its cells; undo restores both.
    click_biome(&mut harness, "Dust");
    let before = biomes(&harness);
    let heir = before.palette[usize::from(index == 0)].clone();
    scroll_to(&mut harness, "Remove");
    click(&mut harness, "Remove");
    let entries: Vec<_> = harness.query_all_by_role_and_label(Role::Button, &heir.name).collect();
    entries.last().unwrap().click();
    harness.run_steps(3);
    assert_eq!(biomes(&harness).snow_key, heir.key);
    assert!(harness.state().document().problems().is_empty());
    send(&mut harness, Command::Undo);
    assert_eq!(biomes(&harness), before);
}

fn click_biome(harness: &mut Editor, name: &str) {
    let label = format!("Biome {name}");
    scroll_to(harness, &label);
    click(harness, &label);
}

#[test]
fn every_sign_of_the_colour_picker_is_in_the_fonts() {
    let harness = editor(vec![]);
    let font = egui::FontId::default();
    assert!(harness.ctx.fonts_mut(|fonts| fonts.has_glyphs(&font, "📋…×•°−–")));
}

#[test]
fn a_number_field_calculates_and_says_what_it_cannot() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Star");
    for (typed, value) in [("3600/240", 15.0), ("2*(10+5)", 30.0), ("-1/4°", -0.25)] {
        enter(&mut harness, "Latitude of star as a number", typed);
        assert_eq!(planet(&harness).star.latitude_deg, value, "{typed}");
    }
    for (typed, why) in
        [("3*", "a number is missing after *"), ("2*50", "100 is out of range"), ("1/0", "not a finite")]
    {
        enter(&mut harness, "Latitude of star as a number", typed);
        assert!(harness.query_by_label_contains(why).is_some(), "{typed}");
        assert_eq!(planet(&harness).star.latitude_deg, -0.25, "{typed}");
    }
}

#[test]
fn a_number_field_takes_units_within_a_calculation_and_changes_of_its_number_and_keeps_what_it_refuses() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Planet");
    let radius_km = |harness: &Editor| planet(harness).radius_km;
    for (typed, value) in [("2*2100 km + 300 m", 4200.3), ("100 mi", 160.93), ("*2", 321.87), ("+=50%", 482.80)] {
        enter(&mut harness, "Radius of planet as a number", typed);
        assert!((radius_km(&harness) - value).abs() < 0.01, "{typed}: {}", radius_km(&harness));
    }
    let before = radius_km(&harness);
    enter(&mut harness, "Radius of planet as a number", "3 km * 2 kmm");
    assert_eq!(radius_km(&harness), before);
    harness.run_steps(3);
    // The text waits, selected: what is typed next takes its place.
    assert!(harness.query_by_label_contains("\"3 km * 2 kmm\"").is_some());
    let field = harness.get_by_label("Radius of planet as a number");
    assert!(field.is_focused() && field.value().as_deref() == Some("3 km * 2 kmm"), "{:?}", field.value());
    harness.event(egui::Event::Text("700".to_owned()));
    harness.run_steps(1);
    assert!(harness.query_by_label_contains("\"3 km * 2 kmm\"").is_none(), "the reason was read");
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    assert_eq!(radius_km(&harness), 700.0);
}

#[test]
fn sliders_and_numbers_have_the_menu_of_their_label() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Star");
    for label in ["Latitude of star", "Latitude of star as a number"] {
        enter(&mut harness, "Latitude of star as a number", "33.5");
        let place = harness.get_by_label(label).rect().center();
        for pressed in [true, false] {
            let button = egui::PointerButton::Secondary;
            harness.event(egui::Event::PointerMoved(place));
            harness.event(egui::Event::PointerButton { pos: place, button, pressed, modifiers: egui::Modifiers::NONE });
            harness.run_steps(2);
        }
        click(&mut harness, "Reset to default");
        assert_eq!(planet(&harness).star.latitude_deg, Planet::default().star.latitude_deg, "{label}");
    }
}

#[test]
fn a_colour_is_typed_as_a_code() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Star");
    let type_code = |harness: &mut Editor, code: &str| {
        harness.get_by_label("Code of Colour of star").focus();
        harness.run_steps(2);
        press(harness, egui::Modifiers::COMMAND, egui::Key::A);
        harness.event(egui::Event::Text(code.to_owned()));
        harness.run_steps(1);
        press(harness, egui::Modifiers::NONE, egui::Key::Enter);
    };
    type_code(&mut harness, "#5C3A93");
    let [r, g, b] = planet(&harness).star.color;
    assert!((r - 0.107).abs() < 1e-3 && (g - 0.0423).abs() < 1e-3 && (b - 0.2918).abs() < 1e-3, "{r} {g} {b}");
    let field = harness.get_by_label("Code of Colour of star");
    assert_eq!(field.value().as_deref(), Some("#5C3A93"));
    type_code(&mut harness, "mauve");
    assert!(harness.query_by_label_contains("is no colour").is_some());
    assert_eq!(planet(&harness).star.color, [r, g, b]);
}

#[test]
fn a_value_is_copied_and_pasted_into_another_parameter() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Star");
    let menu = |harness: &mut Editor, label: &str, entry: &str| {
        harness.get_by_label(label).click_secondary();
        harness.run_steps(3);
        click(harness, entry);
    };
    enter(&mut harness, "Longitude of star as a number", "33.5");
    harness.get_by_label("Longitude").click_secondary();
    harness.run_steps(3);
    harness.get_by_label("Copy value").click();
    let copied = (0..3).find_map(|_| {
        harness.step();
        copied(&harness)
    });
    assert_eq!(copied.as_deref(), Some("33.5°"));
    let paste = |harness: &mut Editor, text: &str| {
        menu(harness, "Latitude", "Paste value");
        harness.event(egui::Event::Paste(text.to_owned()));
        harness.run_steps(3);
    };
    paste(&mut harness, "33.5°");
    assert_eq!(planet(&harness).star.latitude_deg, 33.5);
    assert_eq!(undo_label(&harness), "Change latitude of star");
    paste(&mut harness, "seven");
    assert!(harness.query_by_label_contains("\"seven\" is not a number").is_some());
    assert_eq!(planet(&harness).star.latitude_deg, 33.5);
    menu(&mut harness, "Latitude", "Reset to default");
    assert_eq!(planet(&harness).star.latitude_deg, Planet::default().star.latitude_deg);
}

/// The text that was copied in the last frame.
fn copied(harness: &Editor) -> Option<String> {
    harness.output().platform_output.commands.iter().find_map(|command| match command {
        egui::OutputCommand::CopyText(text) => Some(text.clone()),
        _ => None,
    })
}

#[test]
fn a_fine_drag_stays_fine_to_its_end_and_tab_leads_to_the_next_number() {
    let mut harness = editor(vec![]);
    click(&mut harness, "Star");
    enter(&mut harness, "Latitude of star as a number", "20");
    let slider = harness.get_by_label("Latitude of star").rect();
    let place = egui::pos2(slider.left() + 0.5 * slider.width(), slider.center().y);
    let button = |pos, pressed, modifiers| egui::Event::PointerButton {
        pos,
        button: egui::PointerButton::Primary,
        pressed,
        modifiers,
    };
    let step = |harness: &mut Editor, events: Vec<egui::Event>| {
        events.into_iter().for_each(|event| harness.event(event));
        harness.run_steps(1);
    };
    let shift = egui::Modifiers::SHIFT;
    step(&mut harness, vec![egui::Event::ModifiersChanged(shift), egui::Event::PointerMoved(place)]);
    step(&mut harness, vec![button(place, true, shift)]);
    let to = place + egui::vec2(20.0, 0.0);
    step(&mut harness, vec![egui::Event::PointerMoved(place + egui::vec2(10.0, 0.0))]);
    step(&mut harness, vec![egui::Event::PointerMoved(to)]);
    let fine = planet(&harness).star.latitude_deg;
    assert!(fine > 20.0 && fine < 22.0, "{fine}");
    // Shift goes up before the button.
    step(&mut harness, vec![egui::Event::ModifiersChanged(egui::Modifiers::NONE)]);
    step(&mut harness, vec![]);
    step(&mut harness, vec![button(to, false, egui::Modifiers::NONE)]);
    step(&mut harness, vec![]);
    assert_eq!(planet(&harness).star.latitude_deg, fine);

    harness.get_by_role_and_label(Role::SpinButton, "Latitude of star as a number").focus();
    harness.run_steps(2);
    press(&mut harness, egui::Modifiers::COMMAND, egui::Key::A);
    harness.event(egui::Event::Text("31".to_owned()));
    harness.run_steps(1);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Tab);
    harness.event(egui::Event::Text("-7".to_owned()));
    harness.run_steps(1);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::Enter);
    let star = planet(&harness).star;
    assert_eq!((star.latitude_deg, star.longitude_deg), (31.0, -7.0));
}
