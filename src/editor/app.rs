//! The eframe application: its state, and the order of things in a frame.
//!
//! `logic` takes in what came from outside (shortcuts, dropped files, dialogs, the close button) and carries
//! out commands; `ui` shows everything, lets the panels change a draft of the planet, and turns a changed
//! draft into an undo step.

use super::bookmarks::Renaming;
use super::command::Command;
use super::controls;
use super::dialogs::{FileDialogs, NativeDialogs};
use super::disk::DiskState;
use super::document::Document;
use super::files::FileFlow;
use super::handle::Action;
use super::look;
use super::menus;
use super::notices::Notices;
use super::painter::survey::Surveyor;
use super::panels::{Draft, PanelState, Tab, biomes};
use super::performance;
use super::pictures::Pictures;
use super::prompts::{self, Message};
use super::recovery::{Orphan, Recovery};
use super::status;
use super::viewport::{PainterLink, Viewport};
use super::widgets::keys_are_taken;
use crate::planet::{Planet, shipped};
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// Where the layout is kept between runs; documents never are.
const LAYOUT_KEY: &str = "tellus_layout";

/// The editor.
pub struct EditorApp {
    pub(super) document: Document,
    pub(super) viewport: Viewport,
    pub(super) panels: PanelState,
    pub(super) files: FileFlow,
    pub(super) disk: DiskState,
    pub(super) notices: Notices,
    surveyor: Surveyor,
    pub(super) pictures: Pictures,
    pub(super) messages: Vec<Message>,
    pub(super) show_panel: bool,
    pub(super) show_controls: bool,
    pub(super) renaming: Renaming,
    pub(super) show_performance: bool,
    /// What the user asked for in this frame.
    pub(super) actions: Vec<Action>,
    /// Commands that wait until a half-typed value has been taken over.
    pub(super) deferred: Vec<Action>,
    /// What crashed editors left behind and nobody has decided about.
    pub(super) orphans: Vec<Orphan>,
    pub(super) recovery: Option<Recovery>,
    /// Whether a field had the keys at the end of the last frame: Escape takes them from it before anybody sees it.
    was_typing: bool,
    title: String,
    adapter: String,
    frame_start: Instant,
}

impl EditorApp {
    /// The application, with a preset if one is given: one that does not exist yet is a new planet of that name, one
    /// that cannot be loaded is reported in the window.
    pub fn new(cc: &eframe::CreationContext<'_>, path: Option<PathBuf>) -> Self {
        look::set_up(&cc.egui_ctx);
        let panel_hidden = cc.storage.and_then(|storage| storage.get_string(LAYOUT_KEY)).as_deref() == Some("hidden");
        let document = Document::new(default_planet(), None);
        let viewport = Viewport::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), document.planet());
        let adapter = cc.wgpu_render_state.as_ref().map_or_else(String::new, |state| {
            let info = state.adapter.get_info();
            format!("{} ({:?}, {:?})", info.name, info.device_type, info.backend)
        });
        let mut app = Self {
            document,
            viewport,
            panels: PanelState::default(),
            files: FileFlow::new(Box::new(NativeDialogs::default())),
            disk: DiskState::default(),
            notices: Notices::default(),
            surveyor: {
                let ctx = cc.egui_ctx.clone();
                Surveyor::new(move || ctx.request_repaint())
            },
            pictures: Pictures::default(),
            messages: Vec::new(),
            show_panel: !panel_hidden,
            show_controls: false,
            renaming: None,
            show_performance: false,
            actions: Vec::new(),
            deferred: Vec::new(),
            orphans: Vec::new(),
            recovery: None,
            was_typing: false,
            title: String::new(),
            adapter,
            frame_start: Instant::now(),
        };
        if let Some(path) = path {
            app.begin_with(&path);
        }
        app
    }

    /// Replaces the desktop's file dialogs: tests answer for themselves.
    pub fn with_dialogs(mut self, dialogs: Box<dyn FileDialogs>) -> Self {
        self.files = FileFlow::new(dialogs);
        self
    }

    /// Keeps unsaved work in `folder` against a crash, and offers what a crash left there. Notes there which file is
    /// open, too, so that other windows know.
    pub fn with_recovery(mut self, folder: &Path) -> Self {
        self.notices.claims = Some(folder.to_owned());
        match Recovery::open(folder) {
            Ok((recovery, orphans)) => {
                self.recovery = Some(recovery);
                self.orphans = orphans;
            }
            Err(error) => log::warn!("unsaved work is not kept for recovery: {}: {error}", folder.display()),
        }
        self
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.document
    }

    /// The pictures of height maps.
    pub fn pictures(&self) -> &Pictures {
        &self.pictures
    }

    /// The viewport.
    pub fn viewport(&self) -> &Viewport {
        &self.viewport
    }

    /// The viewport, to change how things are looked at.
    pub fn viewport_mut(&mut self) -> &mut Viewport {
        &mut self.viewport
    }

    /// Asks for a command, as a menu would.
    pub fn send(&mut self, command: Command) {
        self.actions.push(Action::Command(command));
    }

    /// The name of the graphics adapter.
    pub fn adapter(&self) -> &str {
        &self.adapter
    }

    fn take_shortcuts(&mut self, ctx: &egui::Context) {
        if self.files.is_asking() || keys_are_taken(ctx) {
            return;
        }
        self.take_escape(ctx);
        // Letters and digits choose biomes while the table has the keys.
        let typing = ctx.text_edit_focused() || biomes::has_keys(ctx);
        for (shortcut, command) in Command::all_shortcuts() {
            if !(typing && command.yields_to_text()) && ctx.input_mut(|input| input.consume_shortcut(&shortcut)) {
                self.send(command);
            }
        }
    }

    /// Escape closes the window on top; first it ends what is being typed.
    fn take_escape(&mut self, ctx: &egui::Context) {
        let open = [(controls::layer(), &mut self.show_controls), (performance::layer(), &mut self.show_performance)];
        let order: Vec<egui::LayerId> = ctx.memory(|memory| memory.layer_ids().collect());
        let height = |layer: &egui::LayerId| order.iter().position(|other| other == layer);
        let top = open.into_iter().filter(|(_, open)| **open).max_by_key(|(layer, _)| height(layer));
        if let Some((_, open)) = top
            && !self.was_typing
            && ctx.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape))
        {
            *open = false;
        }
    }

    fn take_dropped_files(&mut self, ctx: &egui::Context) {
        // The question comes first: what was dropped would put another document below it.
        if self.files.is_asking() {
            return;
        }
        let dropped = ctx.input(|input| input.raw.dropped_files.first().map(|file| file.path().to_owned()));
        if let Some(path) = dropped {
            self.actions.push(Action::OpenPath(path));
        }
    }

    fn update_title(&mut self, ctx: &egui::Context) {
        let title = format!("{} – Tellus", self.document.title());
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    /// Ends the gesture under way when nobody drags, types or holds a key.
    fn settle(&mut self, ctx: &egui::Context) {
        let busy = ctx.input(|i| i.pointer.any_down() || !i.keys_down.is_empty()) || ctx.text_edit_focused();
        if !busy {
            self.document.settle();
        }
    }

    /// Makes an undo step of a changed draft, and starts the clock that stops at its picture.
    pub(super) fn edit(&mut self, planet: Planet, label: Option<String>) {
        let shown_before = self.document.valid_planet().clone();
        self.document.edit(planet, label);
        let shown = self.document.valid_planet();
        if !Arc::ptr_eq(shown, &shown_before) {
            self.viewport.edit_clock.edited(shown, self.frame_start);
        }
    }

    fn show_problems(&self, ui: &mut egui::Ui) {
        let problems = self.document.problems();
        let error = self.viewport.error();
        let pictures = self.pictures.problems();
        let notices = self.standing_notices();
        if problems.is_empty() && pictures.is_empty() && error.is_none() && notices.is_empty() {
            return;
        }
        egui::Panel::top("problems").resizable(false).show(ui, |ui| {
            for notice in notices {
                ui.colored_label(ui.visuals().warn_fg_color, notice);
            }
            let color = ui.visuals().error_fg_color;
            if let Some(error) = error {
                ui.colored_label(color, error);
            }
            if !problems.is_empty() {
                ui.strong("The picture shows the last planet without problems.");
            }
            for (path, message) in problems.iter().take(4) {
                ui.colored_label(color, format!("{path}: {message}"));
            }
            for (path, message) in pictures.iter().take(4) {
                ui.colored_label(
                    ui.visuals().warn_fg_color,
                    format!("{path}: {message}; until then this layer is flat"),
                );
            }
            if problems.len() > 4 {
                ui.weak(format!("… and {} more", problems.len() - 4));
            }
        });
    }
}

/// The first shipped preset, or the plain defaults.
pub(super) fn default_planet() -> Planet {
    let first = shipped::ALL.first();
    first.and_then(|preset| Planet::from_text(preset.file, preset.text).ok()).unwrap_or_default()
}

impl eframe::App for EditorApp {
    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        profiling::finish_frame!();
        self.frame_start = Instant::now();
        self.viewport.frames.begin(self.frame_start);
        if let Some(state) = frame.wgpu_render_state() {
            let waker = ctx.clone();
            self.viewport.edit_clock.frame_began(&state.device, move || waker.request_repaint());
        }
        self.actions.append(&mut self.deferred);
        self.take_shortcuts(ctx);
        self.take_dropped_files(ctx);
        self.poll_dialogs(ctx);
        self.poll_disk(ctx);
        self.handle_actions(ctx);
        self.poll_claims(ctx);
        self.poll_pictures(ctx);
        self.handle_close_request(ctx);
        self.update_title(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        egui::Panel::top("menus").show(ui, |ui| menus::show(ui, self));
        egui::Panel::bottom("status").show(ui, |ui| status::show(ui, self));
        // The panels come before the picture, so that it shows an edit in the very frame in which it was made.
        if self.show_panel {
            let mut planet = (**self.document.planet()).clone();
            let mut label = None;
            let problems = [self.document.problems(), self.pictures.problems()].concat();
            let (mut browse, mut commands) = (None, Vec::new());
            if self.panels.tab == Tab::Biomes
                && let Some(surface) = self.viewport.surface()
            {
                self.surveyor.ask(&surface.terrain);
            }
            let panel = egui::Panel::right("parts").default_size(376.0).size_range(320.0..=560.0);
            panel.show(ui, |ui| {
                // The panel is as wide as somebody drags it, whatever is in it: what does not fit is cut off, and
                // the panel goes back when it is gone.
                let rect = ui.available_rect_before_wrap();
                ui.advance_cursor_after_rect(rect);
                let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(rect));
                ui.shrink_clip_rect(rect.expand(4.0));
                let under_pointer = self.viewport.under_pointer();
                let (_, lon_deg) = self.viewport.eye(&planet).1.to_degrees();
                let mut draft = Draft {
                    planet: &mut planet,
                    label: None,
                    browse: None,
                    problems: &problems,
                    under_pointer,
                    here: (lon_deg, self.viewport.settings.time_secs),
                    survey: self.surveyor.survey(),
                    commands: Vec::new(),
                };
                self.panels.show(ui, &mut draft);
                label = draft.label;
                browse = draft.browse;
                commands = draft.commands;
            });
            self.edit(planet, label);
            self.actions.extend(commands.into_iter().map(Action::Command));
            self.actions.extend(browse.map(Action::Browse));
        }
        self.viewport.painter = match self.panels.tab {
            Tab::Biomes if self.show_panel => self.panels.biomes.link(),
            _ => PainterLink::default(),
        };
        self.show_problems(ui);
        egui::CentralPanel::no_frame().show(ui, |ui| {
            let mut planet = (**self.document.planet()).clone();
            if let Some(label) = self.viewport.show(ui, self.document.valid_planet(), &mut planet) {
                self.edit(planet, Some(label.to_owned()));
                ctx.request_repaint();
            }
        });
        if let Some((click, under)) = self.viewport.take_click() {
            let mut planet = (**self.document.planet()).clone();
            let label = self.panels.biomes.clicked(&mut planet, click, &under);
            self.edit(planet, label);
            ctx.request_repaint();
        }
        self.was_typing = ctx.text_edit_focused();
        prompts::show(&ctx, self);
        performance::show(&ctx, self);
        self.show_said(&ctx);
        self.settle(&ctx);
        if let Some(wait) = self.recovery.as_mut().and_then(|recovery| recovery.tick(&self.document)) {
            ctx.request_repaint_after(wait);
        }
        if !self.actions.is_empty() || !self.deferred.is_empty() || self.viewport.edit_clock.wants_frame() {
            ctx.request_repaint();
        }
        if self.viewport.frame_meter.interval_secs().is_some() {
            // One more frame after the last movement, to say that all is still.
            ctx.request_repaint_after_secs(0.5);
        }
        self.viewport.frames.end();
    }

    fn on_exit(&mut self) {
        self.drop_claim();
        if let Some(recovery) = &mut self.recovery {
            recovery.close();
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        storage.set_string(LAYOUT_KEY, if self.show_panel { "shown" } else { "hidden" }.to_owned());
    }
}
