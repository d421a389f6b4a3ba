//! The state of the editor: the document, the picture's camera and settings, questions, notices, open windows.
//!
//! Views read it and send commands; handlers change it. It knows neither.
//!
//! - [`document`], [`history`], [`describe`]: the planet being edited, its file, its undo steps, changes in words
//! - [`questions`]: questions about files
//! - [`open_file`]: the watch over the open file
//! - [`notices`]: notices of the editor
//! - [`device`]: the graphics device
//! - [`pictures`]: height maps, read in the background
//! - [`recovery`]: the working copy
//! - [`job`]: work on a thread of its own; [`bake_settings`], [`baking`]: maps and meshes for other
//!   programs
//! - [`edit_baking`]: ground edits into a height picture
//! - [`shelf`]: what the library shows
//! - [`shooting`]: photographs and films
//! - [`variations`], [`templates`]: planets to choose from: variations of this one, what a new one begins as
//! - [`system`]: the system in whose sky the planet is drawn
//! - [`sheet`], [`thumbnails`]: planets with small pictures; the thread that draws them
//! - [`surveyor`]: figures of a whole planet, found on another thread

pub mod bake_settings;
pub mod baking;
pub mod describe;
pub mod device;
pub mod document;
pub mod edit_baking;
pub mod history;
pub mod job;
pub mod notices;
pub mod open_file;
pub mod pictures;
pub mod questions;
pub mod recovery;
pub mod sheet;
pub mod shelf;
pub mod shooting;
pub mod surveyor;
pub mod system;
pub mod templates;
pub mod thumbnails;
pub mod variations;

use super::command::{PanelAction, Wanted};
use super::files::crash::Doing;
use super::files::dialogs::FileDialogs;
use super::files::recent::Recent;
use super::viewport::Viewport;
use super::viewport::camera::{Cameras, Ground};
use crate::planet::sources::Sources;
use crate::planet::{Planet, Population};
use crate::render::Worlds;
use bake_settings::BakeSettings;
use baking::{BakePreview, Baking};
use device::DeviceWatch;
use document::Document;
use edit_baking::EditBaking;
use eframe::egui;
use notices::Notices;
use open_file::OpenFile;
use pictures::Pictures;
use questions::Questions;
use recovery::{Orphan, Recovery};
use sheet::Sheet;
use shelf::Shelf;
use shooting::{PhotoSettings, Shooting};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;
use system::{OpenSystem, follow};
use variations::Variations;

/// A message about something that went wrong; shown until it is dismissed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What happened.
    pub title: String,
    /// The details.
    pub lines: Vec<String>,
}

impl Message {
    /// A message of some lines.
    pub fn new(title: &str, lines: Vec<String>) -> Self {
        Self { title: title.to_owned(), lines }
    }
}

/// The parts of the window that are shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shows {
    /// The side panel.
    pub panel: bool,
    /// What lies over the picture: compass, scale, legend.
    pub overlay: bool,
    /// The list of keys.
    pub controls: bool,
    /// The times of the last edit.
    pub performance: bool,
    /// Photographs and films.
    pub photo: bool,
    /// The finder.
    pub finder: bool,
    /// The undo steps.
    pub history: bool,
    /// The location to go to.
    pub place: bool,
    /// All that is known of a place.
    pub inspector: bool,
    /// Variations of the planet.
    pub variations: bool,
    /// What a new planet can begin as.
    pub templates: bool,
    /// The text of the preset.
    pub text: bool,
    /// Maps for other programs.
    pub bake: bool,
    /// The library.
    pub library: bool,
    /// The system.
    pub system: bool,
    /// The tour.
    pub tour: bool,
}

impl Shows {
    /// The side panel and the overlay alone.
    pub const PANEL: Shows = Shows {
        panel: true,
        overlay: true,
        controls: false,
        performance: false,
        photo: false,
        finder: false,
        history: false,
        place: false,
        inspector: false,
        variations: false,
        templates: false,
        text: false,
        bake: false,
        library: false,
        system: false,
        tour: false,
    };
}

/// The state of the editor.
pub struct State {
    /// The planet being edited.
    pub document: Document,
    /// Counts the documents: views that remember something about a document forget it when this changes.
    pub document_number: u64,
    /// The picture: its camera, its settings and its measurements.
    pub viewport: Viewport,
    /// Questions about files.
    pub questions: Questions,
    /// The watch over the open file.
    pub open_file: OpenFile,
    /// Files that were opened or saved last.
    pub recent: Recent,
    /// Notices of the editor.
    pub notices: Notices,
    /// Height maps.
    pub pictures: Pictures,
    /// Messages, the oldest first.
    pub messages: Vec<Message>,
    /// The parts of the window that are shown.
    pub shows: Shows,
    /// The text with which the finder opens.
    pub search: String,
    /// What the side panel is asked to show.
    pub panel_asks: Vec<PanelAction>,
    /// What a photographer set.
    pub photo: PhotoSettings,
    /// The photographs that are being taken.
    pub shooting: Option<Shooting>,
    /// What the library shows.
    pub shelf: Shelf,
    /// Where small pictures are kept between runs; None: nowhere.
    pub thumbnails_folder: Option<PathBuf>,
    /// What the user wants to bake.
    pub bake: BakeSettings,
    /// Whether the user has set the region.
    pub bake_region_is_set: bool,
    /// The small picture of a map.
    pub bake_preview: BakePreview,
    /// What is being baked.
    pub baking: Option<Baking>,
    /// Ground edits that are being baked.
    pub edit_baking: Option<EditBaking>,
    /// Variations of the planet.
    pub variations: Variations,
    /// The planets of [`templates::ALL`]; empty until they have been shown.
    pub templates: Sheet,
    /// The system in whose sky the planet is drawn.
    pub system: Option<OpenSystem>,
    /// What waits for the text of the clipboard.
    pub pasting: Option<Wanted>,
    /// The index of the bookmark whose name is asked for.
    pub renaming: Option<usize>,
    /// Working copies that crashed editors left behind.
    pub orphans: Vec<Orphan>,
    /// The working copy of this editor.
    pub recovery: Option<Recovery>,
    /// The name of the graphics adapter.
    pub adapter: String,
    /// What went wrong with the graphics device.
    pub device: DeviceWatch,
    /// Starts another editor in the place of this one, and says why it cannot.
    pub restart: Option<Box<dyn FnMut() -> Result<(), String>>>,
    /// What a crash report tells.
    pub doing: Doing,
    /// Start of this frame.
    pub frame_start: Instant,
}

impl State {
    /// The population whose density a view shows; None if nothing stands on the planet.
    pub fn shown_population(&self) -> Option<&Population> {
        self.document.valid_planet().life.get(self.viewport.settings.population)
    }

    /// The state at the start: a document that no file holds.
    pub fn new(planet: Planet, viewport: Viewport, dialogs: Box<dyn FileDialogs>) -> Self {
        Self {
            document: Document::new(planet, None),
            document_number: 0,
            viewport,
            questions: Questions::new(dialogs),
            open_file: OpenFile::default(),
            recent: Recent::default(),
            notices: Notices::default(),
            pictures: Pictures::default(),
            messages: Vec::new(),
            shows: Shows::PANEL,
            search: String::new(),
            panel_asks: Vec::new(),
            photo: PhotoSettings::default(),
            shooting: None,
            shelf: Shelf::default(),
            thumbnails_folder: None,
            bake: BakeSettings::default(),
            bake_region_is_set: false,
            bake_preview: BakePreview::default(),
            baking: None,
            edit_baking: None,
            variations: Variations::default(),
            templates: Sheet::default(),
            system: None,
            pasting: None,
            renaming: None,
            orphans: Vec::new(),
            recovery: None,
            adapter: String::new(),
            device: DeviceWatch::default(),
            restart: None,
            doing: Doing::default(),
            frame_start: Instant::now(),
        }
    }

    /// Makes an undo step of a changed planet, and starts the clock that stops at its picture.
    pub fn edit(&mut self, planet: Planet, label: Option<String>) {
        let shown_before = self.document.valid_planet().clone();
        if planet != **self.document.planet() {
            self.note_planet_changed();
        }
        self.document.edit(planet, label);
        if !Arc::ptr_eq(self.document.valid_planet(), &shown_before) {
            self.start_edit_clock();
        }
    }

    /// Replaces the planet: one undo step of its own, whatever came before.
    pub fn step(&mut self, planet: Planet, label: String) {
        self.document.settle();
        self.edit(planet, Some(label));
        self.document.settle();
    }

    /// Goes one undo step back: of the system if it was changed last.
    pub fn undo(&mut self, ctx: &egui::Context) {
        if self.system.as_ref().is_some_and(OpenSystem::takes_undo) {
            return self.change_system(OpenSystem::undo);
        }
        self.document.undo();
        self.start_edit_clock();
        ctx.request_repaint();
    }

    /// Goes one undo step forward: of the system if it was changed last.
    pub fn redo(&mut self, ctx: &egui::Context) {
        if self.system.as_ref().is_some_and(OpenSystem::takes_redo) {
            return self.change_system(OpenSystem::redo);
        }
        self.document.redo();
        self.start_edit_clock();
        ctx.request_repaint();
    }

    /// The name of the step that undo takes.
    pub fn undo_label(&self) -> Option<&str> {
        let of_system = self.system.as_ref().filter(|system| system.takes_undo());
        of_system.map_or(self.document.history().undo_label(), |system| system.history().undo_label())
    }

    /// The name of the step that redo takes.
    pub fn redo_label(&self) -> Option<&str> {
        let of_system = self.system.as_ref().filter(|system| system.takes_redo());
        of_system.map_or(self.document.history().redo_label(), |system| system.history().redo_label())
    }

    /// Changes the open system. The planet stays the body that it is.
    pub fn change_system(&mut self, change: impl FnOnce(&mut OpenSystem)) {
        let Some(system) = &mut self.system else { return };
        let before = Arc::clone(&system.worlds);
        change(system);
        self.follow_system(&before);
    }

    /// Shows the open system after a change. `before`: the bodies that were shown.
    pub fn follow_system(&mut self, before: &Worlds) {
        if let Some((system, body)) = self.system.as_ref().zip(self.viewport.body()) {
            let follows = follow(before.system(), system.worlds.system(), body);
            self.viewport.set_system(follows.map(|body| (system.worlds.clone(), body)));
        }
    }

    /// Whether the system has changes that no file holds.
    pub fn system_is_dirty(&self) -> bool {
        self.system.as_ref().is_some_and(OpenSystem::is_dirty)
    }

    /// Undoes or redoes until this number of steps is done.
    pub fn jump(&mut self, ctx: &egui::Context, steps: usize) {
        self.note_planet_changed();
        self.document.jump(steps);
        self.start_edit_clock();
        ctx.request_repaint();
    }

    /// Opens the finder with a text, or closes it.
    pub fn search(&mut self, text: Option<String>) {
        self.shows.finder = text.is_some();
        self.search = text.unwrap_or_default();
    }

    /// Asks the side panel to show something.
    pub fn ask_panel(&mut self, asked: PanelAction) {
        self.shows.panel |= asked != PanelAction::ClearFilter;
        self.panel_asks.push(asked);
    }

    /// Replaces the planet by the content of its file: one undo step.
    pub fn reload(&mut self, planet: Planet, bytes: Vec<u8>) {
        self.note_planet_changed();
        self.document.reload(planet, bytes);
        self.start_edit_clock();
    }

    /// Replaces the planet by one that no file holds: one undo step.
    pub fn roll(&mut self, planet: Planet, label: &str) {
        self.note_planet_changed();
        self.document.roll(planet, label);
        self.forget_document();
        self.start_edit_clock();
    }

    /// Replaces the document; its undo steps are lost.
    pub fn replace_document(&mut self, document: Document) {
        self.document = document;
        // Another planet is alone until a system is known in which it stands.
        self.viewport.set_system(None);
        self.forget_document();
    }

    /// Drops the questions and the view of the document before.
    fn forget_document(&mut self) {
        self.document_number += 1;
        self.questions.forget();
        (self.renaming, self.pasting) = (None, None);
        self.reset_view();
    }

    /// Looks at the whole planet, as when it was opened.
    pub fn reset_view(&mut self) {
        let planet = self.document.valid_planet().clone();
        self.viewport.reset_view(&planet);
    }

    /// Changes the camera or its mode.
    pub fn move_cameras(&mut self, change: impl FnOnce(&mut Cameras, &dyn Ground)) {
        let planet = self.document.valid_planet().clone();
        self.viewport.move_cameras(&planet, change);
    }

    /// Whether another document in the place of this one would lose unsaved work.
    pub fn loses_work(&self) -> bool {
        self.document.is_dirty() || !self.document.rolled_over().is_empty()
    }

    /// Shows a message.
    pub fn report(&mut self, title: &str, lines: Vec<String>) {
        self.messages.push(Message::new(title, lines));
    }

    /// The files that the planet and the system were read from, their pictures and edits.
    pub fn sources(&self) -> Sources {
        let planet = self.document.planet();
        let mut sources = match self.document.path() {
            Some(path) => Sources::of_preset(path, planet),
            None => Sources::of_planet(planet),
        };
        if let Some(system) = &self.system {
            sources.extend(system.sources());
        }
        sources
    }

    /// Whether one of the files to be written is one that is read, which would be lost. Then it is said.
    pub fn would_lose(&mut self, title: &str, outputs: &[impl AsRef<Path>]) -> bool {
        let sources = self.sources();
        let lost = outputs.iter().find_map(|output| {
            let output = output.as_ref();
            sources.check(output).err().map(|why| format!("{}: {why}", output.display()))
        });
        let is_lost = lost.is_some();
        if let Some(why) = lost {
            self.report(title, vec![why]);
        }
        is_lost
    }

    /// Undo takes steps of the planet from now on, not of the system.
    fn note_planet_changed(&mut self) {
        if let Some(system) = &mut self.system {
            system.was_changed_last = false;
        }
    }

    fn start_edit_clock(&mut self) {
        self.viewport.edit_clock.edited(self.document.valid_planet(), self.frame_start);
    }
}
