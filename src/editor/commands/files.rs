//! The commands of files: presets, pictures, maps for other programs.

use super::{Menu, Row, ctrl, ctrl_shift, plain};
use crate::editor::command::Command;
use crate::editor::handlers::{baking, open_file, opening, saving};
use crate::editor::state::questions::Goal;
use eframe::egui::Key;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::new(Command::New, "New…", "Choose what a new planet begins as.", |s, _| s.shows.templates ^= true)
            .within(Menu::File, 0)
            .keys([ctrl(Key::N)])
            .taking_typed_value(),
        Row::new(Command::Open, "Open…", "Open a preset.", |s, ctx| opening::pursue(s, ctx, Goal::Open))
            .within(Menu::File, 0)
            .keys([ctrl(Key::O)])
            .taking_typed_value(),
        Row::new(Command::Save, "Save", "Write the planet to its file.", saving::save)
            .within(Menu::File, 1)
            .keys([ctrl(Key::S)])
            .enabled_when(|s| s.document.is_dirty() || s.document.disk_bytes().is_none())
            .taking_typed_value(),
        Row::new(Command::SaveAs, "Save as…", "Write the planet to a file of your choice.", saving::save_as)
            .within(Menu::File, 1)
            .keys([ctrl_shift(Key::S)])
            .taking_typed_value(),
        Row::new(
            Command::Revert,
            "Revert to saved",
            "Go back to what the file holds; undo brings this back.",
            |s, _| {
                open_file::revert(s);
            },
        )
        .within(Menu::File, 1)
        .enabled_when(|s| s.document.is_dirty() && s.document.disk_bytes().is_some())
        .taking_typed_value(),
        Row::new(Command::Photo, "Picture or film…", "Save this view, or a flight over the bookmarks.", |s, _| {
            s.shows.photo ^= true;
        })
        .within(Menu::File, 2)
        .keys([plain(Key::F10)]),
        Row::new(Command::Library, "Library", "Planets and parts to take, and a place to keep your own.", |s, _| {
            s.shows.library ^= true;
            s.shelf.forget();
        })
        .within(Menu::File, 0)
        .keys([ctrl(Key::L)]),
        Row::new(
            Command::Bake,
            "Bake maps and meshes…",
            "Write maps, a mesh or 3D tiles for games and other programs.",
            |s, _| baking::toggle(s),
        )
        .within(Menu::File, 2)
        .keys([ctrl_shift(Key::B)]),
        Row::new(Command::Quit, "Quit", "Close the editor.", |s, ctx| opening::pursue(s, ctx, Goal::Quit))
            .within(Menu::File, 3)
            .keys([ctrl(Key::Q)])
            .taking_typed_value(),
    ]
}
