//! Texture sets of biomes in the editor: the row, the mean colour, files that change.

use crate::app::{self, Editor, click, planet, scroll_to, send, undo_label, until};
use crate::textures_of::{png, stripes};
use egui_kittest::kittest::Queryable;
use tellus::editor::command::Command;
use tellus::planet::{Biome, Biomes, Planet, Table};

/// An editor with a planet of one biome with a set.
fn open(file: &std::path::Path) -> Editor {
    let biome = Biome { textures: file.to_string_lossy().into_owned().into(), ..Biome::default() };
    let biomes = Biomes { table: Table::uniform(biome.key, 2, 2), palette: vec![biome], ..Biomes::default() };
    let mut harness = app::open_planet([1280.0, 900.0], Planet { biomes, ..Planet::default() });
    settled(&mut harness);
    harness
}

fn settled(harness: &mut Editor) {
    until(harness, "the textures are read", |harness| {
        let biomes = &harness.state().document().planet().biomes;
        biomes.palette[0].textures.set().is_some() && !harness.state().pictures().is_reading()
    });
    harness.run_steps(2);
}

fn color(harness: &Editor) -> [f64; 3] {
    planet(harness).biomes.palette[0].color
}

#[test]
fn a_biome_takes_the_colour_of_its_textures_and_undo_gives_it_back() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("rock_color.png");
    std::fs::write(&file, png([8; 2], |_, _| [188, 137, 99])).unwrap();
    let mut harness = open(&file);
    let before = color(&harness);
    click(&mut harness, "Biomes");
    scroll_to(&mut harness, "Textures of Ground");
    assert!(harness.query_by_label("Textures of Ground").is_some());
    click(&mut harness, "Take its colour");
    let taken = color(&harness);
    for (found, right) in taken.into_iter().zip([0.5029, 0.2502, 0.1248]) {
        assert!((found - right).abs() < 2e-3, "{taken:?}");
    }
    assert_eq!(undo_label(&harness), "Take colour of textures");
    send(&mut harness, Command::Undo);
    assert_eq!(color(&harness), before);
    assert!(planet(&harness).biomes.palette[0].textures.set().is_some());
}

#[test]
fn a_changed_picture_of_a_set_is_read_again() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("rock_color.png"), stripes()).unwrap();
    std::fs::write(at("rock_height.png"), stripes()).unwrap();
    let mut harness = open(&at("rock_color.png"));
    let set = |harness: &Editor| planet(harness).biomes.palette[0].textures.set().unwrap().clone();
    let first = set(&harness);
    std::fs::write(at("rock_height.png"), png([64; 2], |x, y| [(x * y / 16) as u8; 3])).unwrap();
    until(&mut harness, "the height map is read again", |harness| set(harness) != first);
    std::fs::remove_file(at("rock_color.png")).unwrap();
    until(&mut harness, "it is said", |harness| {
        harness.query_all_by_label_contains("put the picture there or correct the path").next().is_some()
            || !harness.state().pictures().problems().is_empty()
    });
    assert!(harness.state().document().is_dirty() || !harness.state().pictures().problems().is_empty());
}
