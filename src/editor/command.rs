//! The messages that views send and handlers carry out: commands, and actions that carry a value.
//!
//! This file knows neither views nor handlers. [`commands`](super::commands) gives each command its name, its shortcut
//! and its handler; [`apply`](super::apply) carries out the actions.

use super::finder::place::Place;
use super::state::bake_settings::BakeSettings;
use super::state::shooting::{PhotoSettings, Subject};
use super::state::templates::Template;
use super::state::variations::Wish;
use super::viewport::camera::Mode;
use super::viewport::panes::PaneLayout;
use super::viewport::travel::Arrival;
use crate::lod::Quality;
use crate::planet::param::ParamPath;
use crate::render::{DebugView, Tone};
use crate::system::System;
use std::path::PathBuf;

/// A command: an action with a menu entry or a shortcut.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Command {
    New,
    Open,
    Save,
    SaveAs,
    /// Go back to what the file holds.
    Revert,
    Photo,
    Quit,
    Undo,
    Redo,
    History,
    Finder,
    /// Type into the filter of the open tab.
    Filter,
    ResetView,
    GoToPlace,
    /// How many views of the planet there are.
    Panes(PaneLayout),
    /// Show or hide all that is known of the place under the pointer.
    Inspect,
    /// Hold the inspected place, or follow the pointer again.
    HoldPlace,
    PlayPause,
    TogglePanel,
    /// Put every tab back into the side panel.
    ResetLayout,
    /// Show or hide the window that bakes maps and meshes.
    Bake,
    /// Show or hide the library.
    Library,
    /// Show or hide the system.
    System,
    /// Begin or leave the tour.
    Tour,
    TogglePerformance,
    ToggleOverlay,
    Text,
    ToggleFullscreen,
    ToggleTheme,
    RandomPlanet,
    Variations,
    /// Keep a copy to compare with.
    Compare,
    /// Exchange the planet and the kept copy.
    SwapCompared,
    Controls,
    Move(Mode),
    LevelView,
    Dive,
    FreezeDetail,
    Show(DebugView),
    AddBookmark,
    /// Fly to the bookmark of this index.
    GoTo(usize),
    ImportTable,
    ExportTable,
    /// Take the tool of this index in hand to sculpt.
    TakeTool(usize),
    PutDownTool,
    /// Measure on the planet, or stop.
    Measure,
    LargerTool,
    SmallerTool,
}

/// A command, or an action that carries a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// See [`Command`].
    Command(Command),
    /// Open a file.
    OpenPath(PathBuf),
    /// Open the shipped preset of this index.
    OpenShipped(usize),
    /// Begin a new planet.
    Begin(Template),
    /// Forget the files that were opened last.
    ClearRecent,
    /// Choose a file for the parameter at this path.
    Browse(ParamPath),
    /// Give the parameter at this path a number.
    SetNumber(ParamPath, f64),
    /// Open the finder with this text.
    Search(String),
    /// Change what the side panel shows.
    Panel(PanelAction),
    /// Choose variations of the planet, or take one.
    Variation(VariationAction),
    /// Copy or paste a part or a layer.
    Clip(ClipAction),
    /// Lock the parameter or the part at this path, or unlock it.
    ToggleLock(ParamPath),
    /// Undo or redo until this number of steps is done.
    Jump(usize),
    /// Fly to a location.
    GoToPlace(Place),
    /// Change a bookmark, or fly to it.
    Bookmark(BookmarkAction),
    /// Take a picture.
    Shoot(Shoot),
    /// Bake maps and meshes for other programs.
    Bake(BakeAction),
    /// Take something out of the library, or keep something in it.
    Library(LibraryAction),
    /// Open a system, or go to a body of it.
    System(SystemAction),
    /// Change a setting of the view.
    Set(Setting),
    /// Answer the question on screen.
    Answer(Answer),
    /// Remove the oldest message.
    DismissMessage,
    /// Close the window that is on top.
    Close(Window),
}

/// A window of the editor that a command opens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Window {
    /// The list of keys.
    Controls,
    /// The times of the last edit.
    Performance,
    /// Photographs and films.
    Photo,
    /// The finder.
    Finder,
    /// The undo steps.
    History,
    /// The location to go to.
    Place,
    /// All that is known of a place.
    Inspector,
    /// Variations of the planet.
    Variations,
    /// What a new planet can begin as.
    Templates,
    /// The text of the preset.
    Text,
    /// Maps for other programs.
    Bake,
    /// Planets and parts that the user keeps.
    Library,
    /// The bodies of a system.
    System,
    /// The steps for a first look around.
    Tour,
}

/// A change of what the side panel shows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum PanelAction {
    /// Open the tab of a parameter, scroll to its row and highlight it.
    Reveal {
        /// The path of the parameter.
        path: ParamPath,
        /// Its name: the kind of a landform has the path of the part itself.
        name: &'static str,
    },
    /// Type into the filter of the open tab.
    TypeFilter,
    /// Remove the filter of the open tab.
    ClearFilter,
    /// Put every tab back into the side panel.
    ResetLayout,
    /// Select layers: the first, and their count.
    SelectLayers(usize, usize),
    /// Open the sculpt tab, and change what it has in hand.
    Sculpt(SculptAction),
}

/// A change of the tool in hand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SculptAction {
    /// Take the tool of this index.
    Take(usize),
    /// Take the mask tool, for a painted mask of a layer, both by index.
    PaintMask {
        /// The layer.
        layer: usize,
        /// Its mask.
        mask: usize,
    },
    /// Take the life tool, for the population of this index.
    PaintLife(usize),
    /// Select the edit of this index.
    Select(usize),
    /// Put the tool down, or take it again.
    PutDown,
    /// Measure with drags and clicks, or stop.
    Measure,
    /// Make the brush larger.
    Larger,
    /// Make the brush smaller.
    Smaller,
}

/// A setting of the view, and its new value. Settings are no part of the document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Setting {
    /// How well the picture is drawn.
    Quality(Quality),
    /// The tone curve.
    Tone(Tone),
    /// Exposure in stops.
    ExposureEv(f64),
    /// Colour temperature that is shown white, kelvins.
    WhiteK(f64),
    /// How much darker the corners are, 0 to 1.
    Vignette(f64),
    /// Share of the light that the lens scatters, 0 to 1.
    Bloom(f64),
    /// Whether the exposure follows the picture's brightness.
    AutoExposure(bool),
    /// Whether still pictures get finer.
    Refine(bool),
    /// Seconds since time zero.
    TimeSecs(f64),
    /// Seconds of the planet for each second of the clock.
    TimeSpeed(f64),
    /// Memory for tiles that are kept, MiB.
    CacheMib(u32),
}

/// An action on the variations of the planet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum VariationAction {
    /// Change what varies, and how far.
    Wish(Wish),
    /// Show nine others.
    Again,
    /// Replace the planet by the variation of this number.
    Take(usize),
    /// Take all locks off.
    UnlockAll,
}

/// What is pasted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// This part of a planet; empty: all of it.
    Part(&'static str),
    /// Layers, behind the layer of an index.
    Layers {
        /// The index; None: behind the last one.
        after: Option<usize>,
    },
}

/// An action on the clipboard.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ClipAction {
    /// Copy a part of the planet; empty: all of it.
    CopyPart(&'static str),
    /// Copy the layer of this index.
    CopyLayers(Vec<usize>),
    /// Copy the layer of this index, and remove it.
    CutLayers(Vec<usize>),
    /// Ask the desktop for the text of the clipboard, and paste it.
    Ask(Wanted),
    /// Paste a text.
    Paste(Wanted, String),
    /// Make the planet what the text of a preset says.
    TakeText(String),
}

/// An action on photographs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shoot {
    /// Change the settings.
    Set(PhotoSettings),
    /// Ask for a file.
    Ask(Subject),
    /// Stop what is being taken.
    Cancel,
}

/// An action on the library. Numbers are indices of the items shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum LibraryAction {
    /// Open a planet as a document of its own; take a part.
    Open(usize),
    /// Take a planet or a part over into the open planet: an undo step.
    Take(usize),
    /// Keep a part of the open planet; empty: all of it.
    Keep(&'static str),
    /// Give an item of the library a name and tags.
    Label(usize, String, Vec<String>),
    /// Move an item out of the library.
    Remove(usize),
}

/// An action on systems.
#[derive(Clone, Debug, PartialEq)]
pub enum SystemAction {
    /// Begin a system around the open planet.
    Begin,
    /// Change the system: an undo step of this name.
    Edit(Box<System>, String),
    /// Add a body about the one of a number.
    Add(usize, NewBody),
    /// Remove a body, and what orbits it.
    Remove(usize),
    /// Lock the orbit and rotation of a body, or unlock them: random orbits leave it as it is.
    Lock(usize),
    /// Put the bodies on random orbits.
    Roll,
    /// Undo the last change of the system.
    Undo,
    /// Redo it.
    Redo,
    /// Save the system.
    Save,
    /// Save it to another file.
    SaveAs,
    /// Run it for some years under the attraction of all its bodies.
    Try(f64),
    /// Stop that.
    StopTrial,
    /// Open the shipped system of this index.
    Open(usize),
    /// Go to the body of this number, or down to its ground: its planet becomes the document.
    Visit(usize, Arrival),
    /// Draw the planet alone.
    Leave,
}

/// A body to add to a system.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NewBody {
    /// The shipped planet of this index.
    Shipped(usize),
    /// The planet that is open.
    Open,
    /// A planet whose file is asked for.
    Ask,
    /// A star.
    Star,
}

/// An action on maps and meshes for other programs.
#[derive(Clone, Debug, PartialEq)]
pub enum BakeAction {
    /// Change what is to be baked.
    Set(Box<BakeSettings>),
    /// Ask for a folder or a file.
    Ask,
    /// Stop the bake that is under way.
    Cancel,
    /// Bake the ground edits of these indices into a height picture.
    Edits(Vec<usize>),
    /// Stop that.
    CancelEdits,
}

/// An action on the bookmark of an index.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum BookmarkAction {
    /// Fly there.
    GoTo(usize),
    /// Ask for another name.
    AskName(usize),
    /// Close the question for a name.
    CancelName,
    /// Give it a name.
    Rename(usize, String),
    /// Replace its view with the view of now.
    Update(usize),
    /// Remove it.
    Delete(usize),
}

/// The answer to a question on screen.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Answer {
    /// What to do with unsaved work.
    Unsaved(UnsavedAnswer),
    /// Whether to replace a file that exists.
    Replace(ReplaceAnswer),
    /// Which planet to keep when the open file has changed on disk.
    Change(ChangeAnswer),
    /// The path typed in the window; None cancels.
    Path(Option<PathBuf>),
    /// What to do with the work that a crash left behind.
    Recover(RecoverAnswer),
}

/// An answer to the question about work that a crash left behind.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum RecoverAnswer {
    Recover,
    /// It stays, and is offered at the next start.
    Later,
    Delete,
}

/// An answer to the question about unsaved work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum UnsavedAnswer {
    Save,
    Discard,
    Cancel,
}

/// An answer to the question whether to replace a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ReplaceAnswer {
    Replace,
    OtherName,
    Cancel,
}

/// An answer to the question about a file that has changed on disk.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ChangeAnswer {
    Reload,
    KeepMine,
    SaveAs,
    Cancel,
}

/// The actions that views ask for in a frame, in order.
#[derive(Debug, Default)]
pub struct Commands(Vec<Action>);

impl Commands {
    /// Asks for a command.
    pub fn send(&mut self, command: Command) {
        self.push(Action::Command(command));
    }

    /// Asks for an action.
    pub fn push(&mut self, action: Action) {
        self.0.push(action);
    }

    /// Takes all actions out.
    pub fn take(&mut self) -> Vec<Action> {
        std::mem::take(&mut self.0)
    }

    /// Whether nothing is asked for.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

impl Extend<Action> for Commands {
    fn extend<T: IntoIterator<Item = Action>>(&mut self, actions: T) {
        self.0.extend(actions);
    }
}
