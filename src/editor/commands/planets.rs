//! The commands of the menu of planets.

use super::{Menu, Row, ctrl, ctrl_shift};
use crate::editor::command::Command;
use crate::editor::handlers::{compare, opening};
use eframe::egui::Key;

pub(super) fn rows() -> Vec<Row> {
    vec![
        Row::new(
            Command::RandomPlanet,
            "Random planet",
            "Replace this planet with a random one; undo brings this one back.",
            |s, _| opening::roll(s, None),
        )
        .within(Menu::Planets, 0)
        .keys([ctrl(Key::R)])
        .taking_typed_value(),
        Row::new(Command::Variations, "Variations", "Show nine variations of this planet, to take one.", |s, _| {
            s.shows.variations ^= true;
        })
        .within(Menu::Planets, 0)
        .keys([ctrl(Key::E)]),
        Row::new(
            Command::System,
            "System",
            "Show the stars, planets and moons around this planet, or choose a system to stand in.",
            |s, _| s.shows.system ^= true,
        )
        .within(Menu::Planets, 0)
        .keys([ctrl_shift(Key::Y)])
        .chosen_when(|s| s.shows.system),
        Row::new(
            Command::Compare,
            "Compare with a copy",
            "Keep a copy of this planet, and see it beside your further edits; or drop it.",
            compare::toggle,
        )
        .within(Menu::Planets, 0)
        .keys([ctrl_shift(Key::E)])
        .chosen_when(|s| s.viewport.compare().is_some()),
        Row::new(
            Command::SwapCompared,
            "Swap with the copy",
            "Go on from the kept copy, and keep this planet instead.",
            |s, _| compare::swap(s),
        )
        .within(Menu::Planets, 0)
        .enabled_when(|s| s.viewport.compare().is_some())
        .taking_typed_value(),
    ]
}
