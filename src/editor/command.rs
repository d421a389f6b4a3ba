//! Everything a person can tell the editor to do, in one place: label, tooltip, shortcut.
//!
//! Menus, shortcuts and buttons only send a [`Command`]; the application carries it out in one handler.

use eframe::egui::{Key, KeyboardShortcut, Modifiers};

/// A command without arguments.
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
            Command::RandomPlanet => "Start with a planet nobody has seen before.",
            Command::Controls => "How to move around.",
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
            Command::TogglePerformance => const { &[plain(Key::F3)] },
            Command::ToggleFullscreen => const { &[plain(Key::F11)] },
            Command::ToggleTheme => &[],
            Command::RandomPlanet => const { &[ctrl(Key::R)] },
            Command::Controls => const { &[plain(Key::F1)] },
        }
    }

    /// Whether a text field with the focus keeps the shortcut for itself: it has an undo of its own.
    pub fn yields_to_text(self) -> bool {
        matches!(self, Command::Undo | Command::Redo)
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
