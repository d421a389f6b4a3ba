//! The eframe application: the order of a frame.
//!
//! `logic` turns keys, dropped files, dialogs, changes on disk and the close button into changes of the state, and
//! carries out the commands of the last frame. `ui` shows the views, and makes an undo step of a changed draft.

use super::apply::apply_all;
use super::command::{Action, Command, Commands, RecoverAnswer};
use super::files::crash::{self, Doing};
use super::files::dialogs::{FileDialogs, NativeDialogs};
use super::files::library::Library;
use super::files::recent::Recent;
use super::finder::place::Place;
use super::gesture::Gesture;
use super::handlers::{self, answers, baking, open_file, opening, shooting};
use super::late_input::LateInput;
use super::painter::survey::{Survey, same_survey};
use super::panels::PanelState;
use super::panels::docks::Bench;
use super::panels::layout::Layout;
use super::state::State;
use super::state::bake_settings::BakeSettings;
use super::state::device::DeviceWatch;
use super::state::document::Document;
use super::state::edit_baking::EditBaking;
use super::state::pictures::Pictures;
use super::state::questions::Questions;
use super::state::recovery::Recovery;
use super::state::shooting::PhotoSettings;
use super::state::surveyor::{Surveyor, same_heights};
use super::state::system::OpenSystem;
use super::state::variations::Variations;
use super::viewport::Viewport;
use super::views::bake::BakeWindow;
use super::views::finder::FinderWindow;
use super::views::history::HistoryWindow;
use super::views::library::LibraryWindow;
use super::views::place::PlaceWindow;
use super::views::shortcuts::{self, Keys};
use super::views::system::SystemWindow;
use super::views::text::TextWindow;
use super::views::tour::TourCard;
use super::views::{
    controls, inspector, look, menus, overlay, performance, photo, problems, prompts::Prompts, status, templates,
    variations,
};
use super::widgets::curve_view::{self, CurveView};
use super::widgets::row_view::LockView;
use crate::planet::{Planet, shipped};
use crate::sphere::LatLon;
use crate::terrain::{CurveInputs, MapStore};
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// The keys under which eframe keeps between runs whether the tabs are shown, and where they stand.
const SHOWN_KEY: &str = "tellus_layout";
const LAYOUT_KEY: &str = "tellus_docks";
/// The key of the panes.
const PANES_KEY: &str = "tellus_panes";
/// The key of the memory for tiles.
const CACHE_KEY: &str = "tellus_cache_mib";
/// The key of what was used lately in the finder.
const USED_KEY: &str = "tellus_finder";
/// The key that is there once the editor has run: the tour begins by itself where it is not.
const TOURED_KEY: &str = "tellus_toured";

/// The editor.
pub struct EditorApp {
    state: State,
    /// The commands of this frame, carried out at the start of the next.
    commands: Commands,
    panels: PanelState,
    prompts: Prompts,
    finder: FinderWindow,
    history: HistoryWindow,
    system: SystemWindow,
    place: PlaceWindow,
    text: TextWindow,
    bake: BakeWindow,
    library: LibraryWindow,
    tour: TourCard,
    survey: Surveyor<Survey>,
    curve_inputs: Surveyor<CurveInputs>,
    /// Where solved world maps are kept.
    maps: Option<Arc<MapStore>>,
    /// Whether a field had the focus at the end of the last frame.
    was_typing: bool,
    late_input: LateInput,
    gesture: Gesture,
    title: String,
}

impl EditorApp {
    /// The application, with a preset if one is given. A preset that does not exist yet is a new planet of that name;
    /// a message reports a preset that cannot be loaded. `maps`: where solved world maps are kept.
    pub fn new(cc: &eframe::CreationContext<'_>, path: Option<PathBuf>, maps: Option<Arc<MapStore>>) -> Self {
        Self::with_planet(cc, shipped::default_planet(), path, maps)
    }

    /// The same with another planet than the default one where `path` is None: tests open one that is built faster.
    pub fn with_planet(
        cc: &eframe::CreationContext<'_>,
        planet: Planet,
        path: Option<PathBuf>,
        maps: Option<Arc<MapStore>>,
    ) -> Self {
        look::set_up(&cc.egui_ctx);
        let viewport = Viewport::new(&cc.egui_ctx, cc.wgpu_render_state.as_ref(), &planet, maps.clone());
        let mut state = State::new(planet, viewport, Box::new(NativeDialogs::default()));
        let stored = |key: &str| cc.storage.and_then(|storage| storage.get_string(key));
        state.shows.panel = stored(SHOWN_KEY).as_deref() != Some("hidden");
        state.shows.tour = cc.storage.is_some() && stored(TOURED_KEY).is_none() && path.is_none();
        let layout = stored(LAYOUT_KEY).and_then(|text| Layout::from_text(&text)).unwrap_or_default();
        state.viewport.settings.restore_cache(stored(CACHE_KEY).as_deref());
        state.viewport.restore_panes(&stored(PANES_KEY).unwrap_or_default());
        state.adapter = cc.wgpu_render_state.as_ref().map_or_else(String::new, |state| {
            let info = state.adapter.get_info();
            format!("{} ({:?}, {:?})", info.name, info.device_type, info.backend)
        });
        if let Some(path) = path {
            opening::begin_with(&mut state, &cc.egui_ctx, &path);
        }
        let waker = || {
            let ctx = cc.egui_ctx.clone();
            move || ctx.request_repaint()
        };
        Self {
            state,
            commands: Commands::default(),
            panels: PanelState::new(layout, cc.wgpu_render_state.as_ref()),
            prompts: Prompts::default(),
            finder: FinderWindow::with_used(&stored(USED_KEY).unwrap_or_default()),
            history: HistoryWindow::default(),
            system: SystemWindow::default(),
            place: PlaceWindow::default(),
            text: TextWindow::default(),
            bake: BakeWindow::default(),
            library: LibraryWindow::default(),
            tour: TourCard::default(),
            survey: Surveyor::new(Survey::of, same_survey, waker()),
            curve_inputs: Surveyor::new(curve_view::inputs_of, same_heights, waker()),
            maps,
            was_typing: false,
            late_input: LateInput::default(),
            gesture: Gesture::default(),
            title: String::new(),
        }
    }

    /// Replaces the desktop's file dialogs: tests give prepared answers.
    pub fn with_dialogs(mut self, dialogs: Box<dyn FileDialogs>) -> Self {
        self.state.questions = Questions::new(dialogs);
        self
    }

    /// Keeps the working copy in `folder`, and offers the working copies that crashes left there. Other windows see
    /// there which file this one has open. A window that was started without a file opens the last one.
    pub fn with_recovery(mut self, folder: &Path) -> Self {
        self.state.notices.claim_in(folder);
        self.state.recent = Recent::open(folder);
        self.state.shelf.library = Some(Library::new(folder.join("library")));
        self.state.thumbnails_folder = Some(folder.join("pictures"));
        let last = self.state.recent.paths().first().filter(|path| path.is_file()).cloned();
        if let Some(last) = last.filter(|_| self.state.document.path().is_none() && self.state.messages.is_empty()) {
            let ctx = self.state.viewport.ctx().clone();
            opening::begin_with(&mut self.state, &ctx, &last);
        }
        match Recovery::open(folder) {
            Ok((recovery, orphans)) => (self.state.recovery, self.state.orphans) = (Some(recovery), orphans),
            Err(error) => {
                log::warn!("{}: no working copy is kept: {error}", folder.display());
                self.state.notices.unkept = Some(format!("{}: {error}", folder.display()));
            }
        }
        let reports = crash::take_new(folder);
        if let Some(newest) = reports.last() {
            let told = format!("A report of what happened is in {}.", newest.display());
            self.state.report("Tellus stopped at an error the last time", vec![told]);
        }
        self
    }

    /// Answers errors of the window's graphics device, and its loss: `restart` starts another editor in the place of
    /// this one, or says why it cannot.
    pub fn watch_device(
        mut self,
        cc: &eframe::CreationContext<'_>,
        restart: impl FnMut() -> Result<(), String> + 'static,
    ) -> Self {
        if let Some(state) = &cc.wgpu_render_state {
            self.state.device = DeviceWatch::new(&state.device, &cc.egui_ctx);
        }
        self.state.restart = Some(Box::new(restart));
        self
    }

    /// Tells crash reports what the user does.
    pub fn tell(mut self, doing: Doing) -> Self {
        doing.note_adapter(&self.state.adapter);
        self.state.doing = doing;
        self
    }

    /// Takes over the unsaved work that an editor left when it lost its graphics device.
    pub fn continue_after_loss(mut self) -> Self {
        opening::recover(&mut self.state, RecoverAnswer::Recover);
        self.state
            .notices
            .say("The graphics device was lost. The editor began anew; your work is as it was.".to_owned());
        self
    }

    /// What went wrong with the graphics device.
    pub fn device(&self) -> &DeviceWatch {
        &self.state.device
    }

    /// The document.
    pub fn document(&self) -> &Document {
        &self.state.document
    }

    /// The open system.
    pub fn system(&self) -> Option<&OpenSystem> {
        self.state.system.as_ref()
    }

    /// The height maps' pictures.
    pub fn pictures(&self) -> &Pictures {
        &self.state.pictures
    }

    /// The viewport.
    pub fn viewport(&self) -> &Viewport {
        &self.state.viewport
    }

    /// What the user wants to bake.
    pub fn bake_settings(&self) -> &BakeSettings {
        &self.state.bake
    }

    /// What the curves of the planet bend, once the row of one was shown.
    pub fn curve_inputs(&self) -> Option<&CurveInputs> {
        self.curve_inputs.found()
    }

    /// Variations of the planet.
    pub fn variations(&self) -> &Variations {
        &self.state.variations
    }

    /// The viewport, to change its settings.
    pub fn viewport_mut(&mut self) -> &mut Viewport {
        &mut self.state.viewport
    }

    /// What a photographer set, to change it.
    pub fn photo_mut(&mut self) -> &mut PhotoSettings {
        &mut self.state.photo
    }

    /// The row of the parameter that was searched for, while it is highlighted.
    pub fn revealed(&self) -> Option<egui::Rect> {
        self.panels.finding.revealed().and_then(|revealed| revealed.rect())
    }

    /// Asks for a command, as a menu does.
    pub fn send(&mut self, command: Command) {
        self.commands.send(command);
    }

    /// Asks for an action, as a view does.
    pub fn push(&mut self, action: Action) {
        self.commands.push(action);
    }

    /// The name of the graphics adapter.
    pub fn adapter(&self) -> &str {
        &self.state.adapter
    }

    fn update_title(&mut self, ctx: &egui::Context) {
        let title = format!("{} – Tellus", self.state.document.title());
        if title != self.title {
            ctx.send_viewport_cmd(egui::ViewportCommand::Title(title.clone()));
            self.title = title;
        }
    }

    fn show_panels(&mut self, ui: &mut egui::Ui) {
        let for_brush = self.state.questions.for_brush.take();
        let (state, panels) = (&self.state, &mut self.panels);
        if let Some(file) = for_brush {
            panels.sculpt.set_picture(state.document.planet(), &file);
        }
        if panels.paints()
            && let Some(surface) = state.viewport.surface()
        {
            self.survey.ask(&surface.terrain);
        }
        let mut planet = (**state.document.planet()).clone();
        let problems = [state.document.problems(), state.pictures.problems()].concat();
        let locks = LockView::of(&planet);
        let curves = CurveView::new(self.curve_inputs.found());
        let (altitude_m, eye) = state.viewport.eye(&planet);
        panels.sculpt.note_altitude(altitude_m);
        panels.sculpt.note_baking(state.edit_baking.as_ref().map(EditBaking::done));
        let mut bench = Bench {
            before: state.document.planet(),
            label: None,
            problems: &problems,
            locks: &locks,
            curves: &curves,
            viewport: &state.viewport,
            survey: self.survey.found(),
            commands: &mut self.commands,
            eye_lon_deg: eye.to_degrees().1,
            time_secs: state.viewport.settings.time_secs,
            stray: state.variations.wish.stray,
            in_system: state.viewport.body().is_some(),
            planet: &mut planet,
        };
        panels.show_docks(ui, &mut bench);
        let (label, population) = (bench.label, panels.population());
        // Not while a point of a curve is dragged: the picture comes first.
        if curves.is_shown()
            && !ui.input(|input| input.pointer.any_down())
            && let Some(surface) = state.viewport.surface()
        {
            self.curve_inputs.ask(&surface.terrain);
        }
        self.commands.extend(locks.take_toggled().map(Action::ToggleLock));
        self.state.viewport.settings.population = population;
        self.state.edit(planet, label);
    }

    fn show_picture(&mut self, ui: &mut egui::Ui) {
        let state = &mut self.state;
        let commands = &mut self.commands;
        state.viewport.inspector.is_open = state.shows.inspector;
        egui::CentralPanel::no_frame().show(ui, |ui| {
            let mut planet = (**state.document.planet()).clone();
            if let Some(label) = state.viewport.show(ui, state.document.valid_planet(), &mut planet) {
                state.edit(planet, Some(label.to_owned()));
                ui.ctx().request_repaint();
            }
            overlay::show(ui, state.viewport.rect(), state, commands);
        });
        if let Some((lat_deg, lon_deg)) =
            state.viewport.take_chosen().map(|dir| LatLon::from_direction(dir).to_degrees())
        {
            commands.push(Action::GoToPlace(Place { lat_deg, lon_deg, altitude_m: None }));
        }
        if let Some(index) = state.viewport.take_touched_edit() {
            self.panels.sculpt.select(index);
        }
        if let Some(goal) = state.viewport.take_hand_over() {
            let ctx = ui.ctx().clone();
            handlers::system::hand_over(state, &ctx, goal);
            ctx.request_repaint();
        }
        if let Some((click, under)) = state.viewport.take_click() {
            let mut planet = (**state.document.planet()).clone();
            let label = self.panels.clicked(&mut planet, click, &under);
            state.edit(planet, label);
            ui.ctx().request_repaint();
        }
    }

    /// Ends the gesture under way: the next change is a step of its own.
    fn end_gesture(&mut self) {
        self.state.document.settle();
        if let Some(system) = &mut self.state.system {
            system.settle();
        }
    }

    /// Asks for another frame where something goes on without input.
    fn plan_next_frame(&mut self, ctx: &egui::Context) {
        let state = &mut self.state;
        if let Some(wait) =
            state.recovery.as_mut().and_then(|recovery| recovery.tick(&state.document, state.system.as_ref()))
        {
            ctx.request_repaint_after(wait);
        }
        if !self.commands.is_empty() || state.viewport.edit_clock.wants_frame() {
            ctx.request_repaint();
        }
        if state.viewport.frame_meter.interval_secs().is_some() {
            // One more frame after the last movement: in it the status bar says "idle".
            ctx.request_repaint_after_secs(0.5);
        }
    }
}

impl eframe::App for EditorApp {
    fn raw_input_hook(&mut self, ctx: &egui::Context, raw_input: &mut egui::RawInput) {
        if self.late_input.admit(&mut raw_input.events) {
            ctx.request_repaint();
        }
    }

    fn logic(&mut self, ctx: &egui::Context, frame: &mut eframe::Frame) {
        profiling::finish_frame!();
        let state = &mut self.state;
        state.frame_start = Instant::now();
        state.viewport.frames.begin(state.frame_start);
        state.notices.begin_frame(ctx);
        if let Some(render_state) = frame.wgpu_render_state() {
            let waker = ctx.clone();
            state.viewport.edit_clock.frame_began(&render_state.device, move || waker.request_repaint());
        }
        if Gesture::begins(ctx) {
            self.end_gesture();
        }
        let state = &mut self.state;
        let filtered = state.shows.panel && self.panels.finding.filter(self.panels.tab()).is_active();
        shortcuts::take(ctx, state, Keys { was_typing: self.was_typing, filtered }, &mut self.commands);
        answers::poll_dialogs(state, ctx);
        open_file::poll(state, ctx);
        shooting::poll(state);
        baking::poll(state, ctx);
        handlers::edit_baking::poll(state);
        handlers::system::poll(state, ctx);
        handlers::device::poll(state);
        state.doing.note_file(state.document.path());
        self.commands = apply_all(state, ctx, self.commands.take());
        handlers::clipboard::poll(state, ctx);
        handlers::variations::update(state, ctx);
        state.notices.poll(state.document.path(), ctx);
        if let Some(problem) = self.maps.as_ref().and_then(|maps| maps.take_problem()) {
            log::warn!("{problem}");
        }
        state.pictures.poll(&mut state.document, ctx);
        answers::close_request(state, ctx, &mut self.commands);
        self.panels.keep_to_document(state.document_number);
        self.panels.finding.pass_time(ctx.input(|input| f64::from(input.unstable_dt)));
        for asked in state.panel_asks.drain(..) {
            self.panels.take(state.document.planet(), asked);
        }
        self.update_title(ctx);
    }

    fn ui(&mut self, ui: &mut egui::Ui, _frame: &mut eframe::Frame) {
        let ctx = ui.ctx().clone();
        egui::Panel::top("menus").show(ui, |ui| menus::show(ui, &self.state, &mut self.commands));
        egui::Panel::bottom("status").show(ui, |ui| status::show(ui, &self.state));
        // The panels come before the picture, so that it shows an edit in the very frame in which it was made.
        if self.state.shows.panel {
            self.show_panels(ui);
            self.state.viewport.tab = self.panels.tab_link();
        } else {
            self.state.viewport.tab = Default::default();
        }
        problems::show(ui, &self.state);
        self.show_picture(ui);
        self.was_typing = ctx.text_edit_focused();
        self.prompts.show(&ctx, &self.state, &mut self.commands);
        controls::show(&ctx, &self.state, &mut self.commands);
        performance::show(&ctx, &self.state, &mut self.commands);
        photo::show(&ctx, &self.state, &mut self.commands);
        inspector::show(&ctx, &self.state, &mut self.commands);
        self.history.show(&ctx, &self.state, &mut self.commands);
        variations::show(&ctx, &self.state, &mut self.commands);
        templates::show(&ctx, &self.state, &mut self.commands);
        self.text.show(&ctx, &self.state, &mut self.commands);
        self.bake.show(&ctx, &self.state, &mut self.commands);
        self.library.show(&ctx, &self.state, &mut self.commands);
        self.system.show(&ctx, &self.state, &mut self.commands);
        self.tour.show(&ctx, &self.state, &mut self.commands);
        self.place.show(&ctx, &self.state, &mut self.commands);
        self.finder.show(&ctx, &self.state, &mut self.commands);
        problems::show_said(&ctx, &self.state);
        if self.gesture.has_ended(&ctx) {
            self.end_gesture();
        }
        self.plan_next_frame(&ctx);
        self.state.viewport.frames.end();
    }

    fn on_exit(&mut self) {
        self.state.notices.drop_claim();
        if let Some(recovery) = &mut self.state.recovery {
            recovery.close();
        }
    }

    fn save(&mut self, storage: &mut dyn eframe::Storage) {
        storage.set_string(SHOWN_KEY, if self.state.shows.panel { "shown" } else { "hidden" }.to_owned());
        storage.set_string(TOURED_KEY, "yes".to_owned());
        storage.set_string(LAYOUT_KEY, self.panels.layout.to_text());
        storage.set_string(USED_KEY, self.finder.used());
        storage.set_string(CACHE_KEY, self.state.viewport.settings.cache_mib.to_string());
        storage.set_string(PANES_KEY, self.state.viewport.panes_text());
    }
}
