//! The table of commands: for each its name, tooltip, menu, shortcuts, condition and handler.
//!
//! Menus, shortcuts and the list of keys are made from [`COMMANDS`]. A new command is a variant of [`Command`] and a
//! row here, in `files`: files and what is written to them, in `planets`: planets to choose from and to compare with,
//! in `views`: what is shown of the planet, or in `sculpt`: tools that change the ground.

mod files;
mod planets;
mod sculpt;
mod views;

use super::command::{Command, PanelAction};
use super::handlers::{biome_table, bookmarks, window};
use super::state::State;
use super::state::describe::lower_first;
use super::viewport::camera::{Cameras, Mode};
use crate::planet::notes::MAX_BOOKMARKS;
use eframe::egui::{Context, Key, KeyboardShortcut, Modifiers};
use std::sync::LazyLock;

/// A menu of the menu bar.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Menu {
    File,
    Edit,
    View,
    Camera,
    Sculpt,
    Bookmarks,
    Planets,
    Help,
}

impl Menu {
    /// All menus, in the order of the bar.
    pub const ALL: [Menu; 8] =
        [Menu::File, Menu::Edit, Menu::View, Menu::Camera, Menu::Sculpt, Menu::Bookmarks, Menu::Planets, Menu::Help];

    /// The name in the bar.
    pub fn label(self) -> &'static str {
        match self {
            Menu::File => "File",
            Menu::Edit => "Edit",
            Menu::View => "View",
            Menu::Camera => "Camera",
            Menu::Sculpt => "Tools",
            Menu::Bookmarks => "Bookmarks",
            Menu::Planets => "Planets",
            Menu::Help => "Help",
        }
    }
}

type Handler = Box<dyn Fn(&mut State, &Context) + Send + Sync>;
type Test = Box<dyn Fn(&State) -> bool + Send + Sync>;

/// A row of the table.
pub struct Row {
    /// The command.
    pub command: Command,
    /// The menu entry, in sentence case; an ellipsis where a dialog follows.
    pub label: &'static str,
    /// The effect, as a sentence.
    pub tooltip: &'static str,
    /// The menu, and the group of entries in it; a line separates groups.
    pub menu: Option<(Menu, u8)>,
    /// The keys; menus show the first.
    pub shortcuts: Vec<KeyboardShortcut>,
    /// Whether a text field with the focus keeps the shortcut for itself.
    pub yields_to_text: bool,
    /// Whether a value that is being typed is taken over first, so that it is neither lost nor left out of the file.
    pub takes_typed_value: bool,
    enabled: Option<Test>,
    chosen: Option<Test>,
    renamed: Option<fn(&State) -> Option<String>>,
    handler: Handler,
}

impl Row {
    /// Whether the command can be chosen now.
    pub fn is_enabled(&self, state: &State) -> bool {
        self.enabled.as_ref().is_none_or(|enabled| enabled(state))
    }

    /// Whether the setting that the command makes is the current one; None where it makes no lasting setting.
    pub fn is_chosen(&self, state: &State) -> Option<bool> {
        self.chosen.as_ref().map(|chosen| chosen(state))
    }

    /// The menu entry now: that of undo names the step.
    pub fn label_now(&self, state: &State) -> String {
        self.renamed.and_then(|renamed| renamed(state)).unwrap_or_else(|| self.label.to_owned())
    }

    /// Carries the command out.
    pub fn run(&self, state: &mut State, ctx: &Context) {
        (self.handler)(state, ctx);
    }

    fn new(
        command: Command,
        label: &'static str,
        tooltip: &'static str,
        handler: impl Fn(&mut State, &Context) + Send + Sync + 'static,
    ) -> Self {
        Self {
            command,
            label,
            tooltip,
            menu: None,
            shortcuts: Vec::new(),
            yields_to_text: false,
            takes_typed_value: false,
            enabled: None,
            chosen: None,
            renamed: None,
            handler: Box::new(handler),
        }
    }

    fn within(self, menu: Menu, group: u8) -> Self {
        Self { menu: Some((menu, group)), ..self }
    }

    fn keys(self, shortcuts: impl Into<Vec<KeyboardShortcut>>) -> Self {
        Self { shortcuts: shortcuts.into(), ..self }
    }

    fn yielding_to_text(self) -> Self {
        Self { yields_to_text: true, ..self }
    }

    fn taking_typed_value(self) -> Self {
        Self { takes_typed_value: true, ..self }
    }

    fn enabled_when(self, enabled: impl Fn(&State) -> bool + Send + Sync + 'static) -> Self {
        Self { enabled: Some(Box::new(enabled)), ..self }
    }

    fn chosen_when(self, chosen: impl Fn(&State) -> bool + Send + Sync + 'static) -> Self {
        Self { chosen: Some(Box::new(chosen)), ..self }
    }

    fn renamed(self, renamed: fn(&State) -> Option<String>) -> Self {
        Self { renamed: Some(renamed), ..self }
    }
}

fn plain(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::NONE, key)
}

fn ctrl(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND, key)
}

fn ctrl_shift(key: Key) -> KeyboardShortcut {
    KeyboardShortcut::new(Modifiers::COMMAND | Modifiers::SHIFT, key)
}

/// All commands, in the order of the menus.
pub static COMMANDS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let mut rows = files::rows();
    rows.extend(edit());
    rows.extend(views::rows());
    rows.extend(view_and_help());
    rows.extend(planets::rows());
    rows.extend(Mode::ALL.map(camera_mode));
    rows.extend(camera());
    rows.extend(sculpt::rows());
    rows.extend(bookmarks_and_table());
    rows.extend(GO_TO.iter().enumerate().map(|(index, (label, key))| {
        Row::new(Command::GoTo(index), label, "Fly to this bookmark.", move |state, _| bookmarks::go_to(state, index))
            .keys([ctrl(*key)])
            .enabled_when(move |state| index < state.document.bookmarks().len())
    }));
    rows
});

fn edit() -> Vec<Row> {
    vec![
        Row::new(Command::Undo, "Undo", "Undo the last change.", State::undo)
            .within(Menu::Edit, 0)
            .keys([ctrl(Key::Z)])
            .enabled_when(|s| s.undo_label().is_some())
            .renamed(|s| s.undo_label().map(|step| format!("Undo: {}", lower_first(step))))
            .yielding_to_text(),
        Row::new(Command::Redo, "Redo", "Redo the last undone change.", State::redo)
            .within(Menu::Edit, 0)
            .keys([ctrl_shift(Key::Z), ctrl(Key::Y)])
            .enabled_when(|s| s.redo_label().is_some())
            .renamed(|s| s.redo_label().map(|step| format!("Redo: {}", lower_first(step))))
            .yielding_to_text(),
        Row::new(Command::History, "History", "List the undo steps; a click goes to one.", |s, _| {
            s.shows.history ^= true;
        })
        .within(Menu::Edit, 0)
        .keys([ctrl(Key::H)]),
        Row::new(
            Command::Finder,
            "Find anything…",
            "Find a command, a planet, a bookmark or a parameter by its name.",
            |s, _| s.search((!s.shows.finder).then(String::new)),
        )
        .within(Menu::Edit, 1)
        .keys([ctrl(Key::K), ctrl(Key::P)]),
        Row::new(Command::Filter, "Filter parameters", "Show only the parameters with these words.", |s, _| {
            s.ask_panel(PanelAction::TypeFilter);
        })
        .within(Menu::Edit, 1)
        .keys([ctrl(Key::F)]),
        Row::new(Command::Text, "Preset text", "Show the planet as text, to read and to edit.", |s, _| {
            s.shows.text ^= true;
        })
        .within(Menu::Edit, 1)
        .keys([ctrl(Key::T)])
        .taking_typed_value(),
    ]
}

fn view_and_help() -> Vec<Row> {
    vec![
        Row::new(
            Command::FreezeDetail,
            "Freeze detail",
            "Keep the tiles of this view, and fly out to look at them.",
            |s, _| s.viewport.settings.freeze_detail ^= true,
        )
        .within(Menu::View, 1)
        .keys([plain(Key::F6)])
        .chosen_when(|s| s.viewport.settings.freeze_detail),
        Row::new(
            Command::TogglePanel,
            "Show or hide panel",
            "Give the picture the whole window, or bring the panel back.",
            |s, _| s.shows.panel ^= true,
        )
        .within(Menu::View, 2)
        .keys([plain(Key::F9)]),
        Row::new(
            Command::ResetLayout,
            "Reset layout",
            "Put every tab back into the panel at the right. Drag the name of a tab to move it.",
            |s, _| s.ask_panel(PanelAction::ResetLayout),
        )
        .within(Menu::View, 2),
        Row::new(Command::ToggleOverlay, "Overlay", "Compass, scale and legend over the picture.", |s, _| {
            s.shows.overlay ^= true;
        })
        .within(Menu::View, 2)
        .keys([plain(Key::F5)])
        .chosen_when(|s| s.shows.overlay),
        Row::new(
            Command::Inspect,
            "Inspector",
            "Show all that is known of the place under the pointer: height, climate, water, clouds, each layer's part.",
            |s, _| s.shows.inspector ^= true,
        )
        .within(Menu::View, 2)
        .keys([plain(Key::I)])
        .chosen_when(|s| s.shows.inspector)
        .yielding_to_text(),
        Row::new(
            Command::HoldPlace,
            "Hold the inspected place",
            "Stay at the inspected place while the pointer moves, or follow the pointer again.",
            |s, _| s.viewport.inspector.toggle_held(),
        )
        .within(Menu::View, 2)
        .keys([KeyboardShortcut::new(Modifiers::SHIFT, Key::I)])
        .enabled_when(|s| s.shows.inspector && s.viewport.inspector.place().is_some())
        .chosen_when(|s| s.viewport.inspector.is_held())
        .yielding_to_text(),
        Row::new(
            Command::TogglePerformance,
            "Performance",
            "Show the times of the last edit, the memory in use, and the newest frames.",
            |s, _| s.shows.performance ^= true,
        )
        .within(Menu::View, 2)
        .keys([plain(Key::F8)]),
        Row::new(
            Command::ToggleFullscreen,
            "Full screen",
            "Use the whole screen, or the window again.",
            window::toggle_fullscreen,
        )
        .within(Menu::View, 2)
        .keys([plain(Key::F11)]),
        Row::new(
            Command::ToggleTheme,
            "Light or dark",
            "Settings: switch between the light and the dark theme.",
            window::toggle_theme,
        )
        .within(Menu::View, 2),
        Row::new(
            Command::PlayPause,
            "Play or pause time",
            "Let the day pass, the clouds drift and the waves run, or pause them.",
            |s, _| s.viewport.settings.playing ^= true,
        )
        .keys([ctrl(Key::Space)]),
        Row::new(Command::Tour, "Tour", "Six steps for a first look around.", |s, _| s.shows.tour ^= true)
            .within(Menu::Help, 0),
        Row::new(Command::Controls, "Controls", "List the keys, and how to move around.", |s, _| {
            s.shows.controls ^= true;
        })
        .within(Menu::Help, 0)
        .keys([plain(Key::F1), plain(Key::Questionmark)])
        .yielding_to_text(),
    ]
}

fn camera() -> Vec<Row> {
    vec![
        Row::new(
            Command::Dive,
            "Go under water",
            "Walk on the sea floor, fly under water and into a giant, or stay above.",
            |s, _| s.move_cameras(|cameras, _| cameras.set_dive(!cameras.dives())),
        )
        .within(Menu::Camera, 1)
        .keys([plain(Key::F7)])
        .chosen_when(|s| s.viewport.cameras().dives()),
        Row::new(Command::LevelView, "Level the view", "Take the roll out of free flight.", |s, _| {
            s.move_cameras(Cameras::level);
        })
        .within(Menu::Camera, 1)
        .keys([plain(Key::X)])
        .enabled_when(|s| s.viewport.cameras().mode() == Mode::Fly)
        .yielding_to_text(),
        Row::new(Command::ResetView, "Reset view", "Look at the whole planet, as when it was opened.", |s, _| {
            s.reset_view();
        })
        .within(Menu::Camera, 1)
        .keys([ctrl(Key::Num0)]),
        Row::new(Command::GoToPlace, "Go to place…", "Fly to a latitude and longitude.", |s, _| {
            s.shows.place ^= true;
        })
        .within(Menu::Camera, 2)
        .keys([ctrl(Key::G)]),
    ]
}

fn bookmarks_and_table() -> Vec<Row> {
    vec![
        Row::new(Command::AddBookmark, "Add bookmark", "Keep this view in the preset.", |s, _| bookmarks::add(s))
            .within(Menu::Bookmarks, 0)
            .keys([ctrl(Key::B)])
            .enabled_when(|s| s.document.bookmarks().len() < MAX_BOOKMARKS),
        Row::new(
            Command::ImportTable,
            "Import biome table…",
            "Read a PNG with one pixel for each cell. Each colour becomes the nearest biome; transparent pixels \
             change nothing.",
            biome_table::ask_for_import,
        ),
        Row::new(
            Command::ExportTable,
            "Export biome table…",
            "Write the table as a PNG with one pixel for each cell, in the colour of its biome.",
            biome_table::ask_for_export,
        ),
    ]
}

/// Names and keys of the commands that fly to the first bookmarks.
const GO_TO: [(&str, Key); 9] = [
    ("First bookmark", Key::Num1),
    ("Second bookmark", Key::Num2),
    ("Third bookmark", Key::Num3),
    ("Fourth bookmark", Key::Num4),
    ("Fifth bookmark", Key::Num5),
    ("Sixth bookmark", Key::Num6),
    ("Seventh bookmark", Key::Num7),
    ("Eighth bookmark", Key::Num8),
    ("Ninth bookmark", Key::Num9),
];

fn camera_mode(mode: Mode) -> Row {
    let (tooltip, key) = match mode {
        Mode::Orbit => ("Orbit the planet; scroll towards the point under the pointer.", Key::F2),
        Mode::Fly => ("Fly freely, faster the higher you are.", Key::F3),
        Mode::Walk => ("Stand on the ground and walk.", Key::F4),
    };
    Row::new(Command::Move(mode), mode.label(), tooltip, move |state, _| {
        // The arrows and the mouse are found; these are not.
        if mode == Mode::Walk && state.viewport.cameras().mode() != Mode::Walk {
            state.notices.say("Walk with W A S D and Shift, drag to look around; F2 orbits, scroll to rise".to_owned());
        }
        state.move_cameras(|cameras, ground| cameras.set_mode(mode, ground));
        state.viewport.take_focus();
    })
    .within(Menu::Camera, 0)
    .keys([plain(key)])
    .chosen_when(move |state| state.viewport.cameras().mode() == mode)
}

/// The row of a command.
pub fn row(command: Command) -> Option<&'static Row> {
    COMMANDS.iter().find(|row| row.command == command)
}

/// The rows of a menu, group after group.
pub fn menu_groups(menu: Menu) -> Vec<Vec<&'static Row>> {
    let mut groups: Vec<Vec<&'static Row>> = Vec::new();
    for row in COMMANDS.iter() {
        if let Some((of, group)) = row.menu
            && of == menu
        {
            let group = usize::from(group);
            if groups.len() <= group {
                groups.resize_with(group + 1, Vec::new);
            }
            groups[group].push(row);
        }
    }
    groups
}

/// Every shortcut with its row. Those with Shift come first: egui takes Ctrl+Shift+S for Ctrl+S too.
pub fn all_shortcuts() -> Vec<(KeyboardShortcut, &'static Row)> {
    let mut all: Vec<_> =
        COMMANDS.iter().flat_map(|row| row.shortcuts.iter().map(move |&shortcut| (shortcut, row))).collect();
    all.sort_by_key(|(shortcut, _)| !shortcut.modifiers.shift);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_two_commands_share_a_shortcut() {
        let all = all_shortcuts();
        for (i, (shortcut, row)) in all.iter().enumerate() {
            for (other, second) in &all[i + 1..] {
                assert!(shortcut != other, "{:?} and {:?} both have {shortcut:?}", row.command, second.command);
            }
        }
    }

    #[test]
    fn commands_and_labels_are_unique_and_explained() {
        for (i, row) in COMMANDS.iter().enumerate() {
            assert!(row.label.starts_with(char::is_uppercase));
            assert!(row.tooltip.ends_with('.'));
            let rest = &COMMANDS[i + 1..];
            assert!(rest.iter().all(|other| other.label != row.label && other.command != row.command));
        }
    }

    #[test]
    fn every_command_has_a_menu_entry_a_shortcut_or_a_button() {
        let buttons = [Command::ImportTable, Command::ExportTable];
        for row in COMMANDS.iter().filter(|row| !buttons.contains(&row.command)) {
            assert!(row.menu.is_some() || !row.shortcuts.is_empty(), "{:?}", row.command);
        }
        assert!(Menu::ALL.iter().all(|menu| menu_groups(*menu).iter().any(|group| !group.is_empty())));
    }
}
