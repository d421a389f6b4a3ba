//! Everything a person can tell the editor to do, in one place: label, tooltip, shortcut.
//!
//! Menus, shortcuts and buttons only send a [`Command`]; the application carries it out in one handler.

use super::viewport::camera::Mode;
use crate::render::DebugView;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

/// A command. What it acts on is part of it where there are but a few.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Command {
    New,
    Open,
    Save,
    SaveAs,
    Quit,
    Undo,
    Redo,
    ResetView,
    PlayPause,
    TogglePanel,
    TogglePerformance,
    ToggleFullscreen,
    ToggleTheme,
    RandomPlanet,
    Controls,
    Move(Mode),
    LevelView,
    Dive,
    FreezeDetail,
    Show(DebugView),
    AddBookmark,
    GoTo(u8),
    ImportTable,
    ExportTable,
}

const CTRL_SHIFT: Modifiers = Modifiers::COMMAND.plus(Modifiers::SHIFT);

impl Command {
    /// All of them.
    pub const ALL: &'static [Command] = &[
        Command::New,
        Command::Open,
        Command::Save,
        Command::SaveAs,
        Command::Quit,
        Command::Undo,
        Command::Redo,
        Command::ResetView,
        Command::PlayPause,
        Command::TogglePanel,
        Command::TogglePerformance,
        Command::ToggleFullscreen,
        Command::ToggleTheme,
        Command::RandomPlanet,
        Command::Controls,
        Command::Move(Mode::Orbit),
        Command::Move(Mode::Fly),
        Command::Move(Mode::Walk),
        Command::LevelView,
        Command::Dive,
        Command::Show(DebugView::Shaded),
        Command::Show(DebugView::Height),
        Command::Show(DebugView::Normal),
        Command::Show(DebugView::Slope),
        Command::Show(DebugView::Biome),
        Command::Show(DebugView::Temperature),
        Command::Show(DebugView::Moisture),
        Command::Show(DebugView::Lod),
        Command::Show(DebugView::TileBorders),
        Command::Show(DebugView::Wireframe),
        Command::Show(DebugView::Error),
        Command::Show(DebugView::Coverage),
        Command::Show(DebugView::Albedo),
        Command::FreezeDetail,
        Command::AddBookmark,
        Command::GoTo(0),
        Command::GoTo(1),
        Command::GoTo(2),
        Command::GoTo(3),
        Command::GoTo(4),
        Command::GoTo(5),
        Command::GoTo(6),
        Command::GoTo(7),
        Command::GoTo(8),
        Command::ImportTable,
        Command::ExportTable,
    ];

    /// The commands that go to the first bookmarks.
    pub const GO_TO: [Command; 9] = [
        Command::GoTo(0),
        Command::GoTo(1),
        Command::GoTo(2),
        Command::GoTo(3),
        Command::GoTo(4),
        Command::GoTo(5),
        Command::GoTo(6),
        Command::GoTo(7),
        Command::GoTo(8),
    ];

    /// The menu entry, in sentence case; an ellipsis where a dialog follows.
    pub fn label(self) -> &'static str {
        match self {
            Command::New => "New",
            Command::Open => "Open…",
            Command::Save => "Save",
            Command::SaveAs => "Save as…",
            Command::Quit => "Quit",
            Command::Undo => "Undo",
            Command::Redo => "Redo",
            Command::ResetView => "Reset view",
            Command::PlayPause => "Play or pause time",
            Command::TogglePanel => "Show or hide panel",
            Command::TogglePerformance => "Performance",
            Command::ToggleFullscreen => "Full screen",
            Command::ToggleTheme => "Light or dark",
            Command::RandomPlanet => "Random planet",
            Command::Controls => "Controls",
            Command::Move(mode) => mode.label(),
            Command::LevelView => "Level the view",
            Command::Dive => "Go under water",
            Command::FreezeDetail => "Freeze detail",
            Command::Show(view) => view.label(),
            Command::AddBookmark => "Add bookmark",
            Command::ImportTable => "Import biome table…",
            Command::ExportTable => "Export biome table…",
            Command::GoTo(index) => {
                const LABELS: [&str; 9] = [
                    "First bookmark",
                    "Second bookmark",
                    "Third bookmark",
                    "Fourth bookmark",
                    "Fifth bookmark",
                    "Sixth bookmark",
                    "Seventh bookmark",
                    "Eighth bookmark",
                    "Ninth bookmark",
                ];
                LABELS.get(usize::from(index)).copied().unwrap_or("Bookmark")
            }
        }
    }

    /// What it does.
    pub fn tooltip(self) -> &'static str {
        match self {
            Command::New => "Start with the default planet.",
            Command::Open => "Open a preset.",
            Command::Save => "Write the planet to its file.",
            Command::SaveAs => "Write the planet to a file of your choice.",
            Command::Quit => "Close the editor.",
            Command::Undo => "Take the last change back.",
            Command::Redo => "Do again what was taken back.",
            Command::ResetView => "Look at the whole planet from above the equator.",
            Command::PlayPause => "Let the clouds drift and the waves run, or hold them.",
            Command::TogglePanel => "Give the picture the whole window, or bring the panel back.",
            Command::TogglePerformance => "Where the time of the last edit went, what is kept, and the newest frames.",
            Command::ToggleFullscreen => "Use the whole screen, or the window again.",
            Command::ToggleTheme => "Switch between the light and the dark look.",
            Command::RandomPlanet => {
                "Put a planet nobody has seen before in the place of this one; undo brings this one back."
            }
            Command::Controls => "How to move around, and every key.",
            Command::Move(Mode::Orbit) => "Turn the planet and near what you point at.",
            Command::Move(Mode::Fly) => "Fly freely, faster the higher you are.",
            Command::Move(Mode::Walk) => "Stand on the ground and walk.",
            Command::LevelView => "Take the roll out of free flight.",
            Command::Dive => "Walk on the sea floor and fly beneath the waves, or stay above them.",
            Command::FreezeDetail => "Keep the tiles of this view, and fly out to look at them.",
            Command::Show(DebugView::Shaded) => "Show the planet as it is.",
            Command::Show(DebugView::Height) => "Show heights, from the lowest to the highest in the picture.",
            Command::Show(DebugView::Normal) => "Show which way the ground faces.",
            Command::Show(DebugView::Slope) => "Show how steep the ground is, up to 60°.",
            Command::Show(DebugView::Biome) => "Show the colours of the biomes by themselves.",
            Command::Show(DebugView::Temperature) => "Show the temperature, from -40 to 40 °C.",
            Command::Show(DebugView::Moisture) => "Show the moisture, from dry to wet.",
            Command::Show(DebugView::Lod) => "Show the level of each tile.",
            Command::Show(DebugView::TileBorders) => "Show where tiles meet.",
            Command::Show(DebugView::Wireframe) => "Show the edges of the triangles.",
            Command::Show(DebugView::Error) => "Show the vertex spacing: blue 1 pixel, green 4, yellow 16, red 64.",
            Command::Show(DebugView::Coverage) => "Show ground white and all else black.",
            Command::Show(DebugView::Albedo) => "Show the ground's own colour without light.",
            Command::AddBookmark => "Keep this view in the preset.",
            Command::GoTo(_) => "Fly to this bookmark.",
            Command::ImportTable => {
                "Read a PNG, one pixel for each cell; colours go to the nearest of the palette, clear pixels stay."
            }
            Command::ExportTable => "Write the table as a PNG, one pixel for each cell in its biome's colour.",
        }
    }

    /// The keys, the first being the one shown in menus.
    pub fn shortcuts(self) -> &'static [KeyboardShortcut] {
        const fn plain(key: Key) -> KeyboardShortcut {
            KeyboardShortcut::new(Modifiers::NONE, key)
        }
        const fn ctrl(key: Key) -> KeyboardShortcut {
            KeyboardShortcut::new(Modifiers::COMMAND, key)
        }
        const fn ctrl_shift(key: Key) -> KeyboardShortcut {
            KeyboardShortcut::new(CTRL_SHIFT, key)
        }
        match self {
            Command::New => const { &[ctrl(Key::N)] },
            Command::Open => const { &[ctrl(Key::O)] },
            Command::Save => const { &[ctrl(Key::S)] },
            Command::SaveAs => const { &[ctrl_shift(Key::S)] },
            Command::Quit => const { &[ctrl(Key::Q)] },
            Command::Undo => const { &[ctrl(Key::Z)] },
            Command::Redo => const { &[ctrl_shift(Key::Z), ctrl(Key::Y)] },
            Command::ResetView => const { &[ctrl(Key::Num0)] },
            Command::PlayPause => const { &[ctrl(Key::Space)] },
            Command::TogglePanel => const { &[plain(Key::F9)] },
            Command::TogglePerformance => const { &[plain(Key::F8)] },
            Command::ToggleFullscreen => const { &[plain(Key::F11)] },
            Command::ToggleTheme | Command::ImportTable | Command::ExportTable | Command::Show(DebugView::Albedo) => {
                &[]
            }
            Command::RandomPlanet => const { &[ctrl(Key::R)] },
            Command::Controls => const { &[plain(Key::F1), plain(Key::Questionmark)] },
            Command::Move(Mode::Orbit) => const { &[plain(Key::F2)] },
            Command::Move(Mode::Fly) => const { &[plain(Key::F3)] },
            Command::Move(Mode::Walk) => const { &[plain(Key::F4)] },
            Command::LevelView => const { &[plain(Key::X)] },
            Command::Dive => const { &[plain(Key::F7)] },
            Command::FreezeDetail => const { &[plain(Key::F6)] },
            Command::Show(DebugView::Shaded) => const { &[plain(Key::Num1)] },
            Command::Show(DebugView::Height) => const { &[plain(Key::Num2)] },
            Command::Show(DebugView::Normal) => const { &[plain(Key::Num3)] },
            Command::Show(DebugView::Slope) => const { &[plain(Key::Num4)] },
            Command::Show(DebugView::Biome) => const { &[plain(Key::Num5)] },
            Command::Show(DebugView::Temperature) => const { &[plain(Key::Num6)] },
            Command::Show(DebugView::Moisture) => const { &[plain(Key::Num7)] },
            Command::Show(DebugView::Lod) => const { &[plain(Key::Num8)] },
            Command::Show(DebugView::TileBorders) => const { &[plain(Key::Num9)] },
            Command::Show(DebugView::Wireframe) => const { &[plain(Key::Num0)] },
            Command::Show(DebugView::Error) => const { &[plain(Key::Minus)] },
            Command::Show(DebugView::Coverage) => const { &[plain(Key::Equals)] },
            Command::AddBookmark => const { &[ctrl(Key::B)] },
            Command::GoTo(index) => {
                const KEYS: [KeyboardShortcut; 9] = [
                    ctrl(Key::Num1),
                    ctrl(Key::Num2),
                    ctrl(Key::Num3),
                    ctrl(Key::Num4),
                    ctrl(Key::Num5),
                    ctrl(Key::Num6),
                    ctrl(Key::Num7),
                    ctrl(Key::Num8),
                    ctrl(Key::Num9),
                ];
                KEYS.get(usize::from(index)).map_or(&[], std::slice::from_ref)
            }
        }
    }

    /// Whether a text field with the focus keeps the shortcut for itself: it has an undo of its own, and
    /// takes whatever can be typed.
    pub fn yields_to_text(self) -> bool {
        matches!(self, Command::Undo | Command::Redo | Command::Show(_) | Command::LevelView | Command::Controls)
    }

    /// Every shortcut with its command, those with more modifiers first, so that Ctrl+Shift+S is not taken for Ctrl+S.
    pub fn all_shortcuts() -> Vec<(KeyboardShortcut, Command)> {
        let mut all: Vec<_> = Self::ALL
            .iter()
            .flat_map(|&command| command.shortcuts().iter().map(move |&shortcut| (shortcut, command)))
            .collect();
        all.sort_by_key(|(shortcut, _)| !shortcut.modifiers.shift);
        all
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_share_a_shortcut() {
        let all = Command::all_shortcuts();
        for (i, (shortcut, command)) in all.iter().enumerate() {
            for (other, second) in &all[i + 1..] {
                assert!(shortcut != other, "{command:?} and {second:?} both answer to {shortcut:?}");
            }
        }
    }

    #[test]
    fn labels_are_unique_sentence_case_and_explained() {
        for (i, command) in Command::ALL.iter().enumerate() {
            assert!(command.label().starts_with(char::is_uppercase));
            assert!(command.tooltip().ends_with('.'));
            assert!(Command::ALL[i + 1..].iter().all(|other| other.label() != command.label()));
        }
    }
}
