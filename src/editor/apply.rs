//! Carries out the actions that views ask for.

use super::command::{
    Action, Answer, Command, Commands, PanelAction, Setting, Shoot, SystemAction, VariationAction, Window,
};
use super::commands;
use super::handlers::{
    answers, baking, bookmarks, clipboard, library, opening, pictures, place, shooting, system, variations,
};
use super::state::State;
use super::state::questions::Goal;
use super::viewport::settings::CACHE_MIB;
use super::widgets::number::{format_number, suffix};
use crate::planet::param::{ParamPath, ValueMut};
use eframe::egui;

/// Carries out the actions of the last frame. Gives those that wait until a typed value has been taken over.
pub fn apply_all(state: &mut State, ctx: &egui::Context, actions: Vec<Action>) -> Commands {
    let mut deferred = Commands::default();
    for action in actions {
        let focused = ctx.memory(egui::Memory::focused);
        if let Some(id) = focused
            && takes_typed_value(&action)
            && ctx.text_edit_focused()
            && !state.questions.has_question()
        {
            ctx.memory_mut(|memory| memory.surrender_focus(id));
            deferred.push(action);
            continue;
        }
        state.doing.note_action(&action);
        apply(state, ctx, action);
    }
    deferred
}

/// Whether a value that is being typed is taken over first, so that it is neither lost nor left out of the file.
fn takes_typed_value(action: &Action) -> bool {
    match action {
        Action::Command(command) => commands::row(*command).is_some_and(|row| row.takes_typed_value),
        // A field of the window is being typed in: its value would be lost.
        Action::System(SystemAction::Edit(..)) => false,
        Action::System(_) | Action::Library(_) | Action::Browse(_) | Action::SetNumber(..) => true,
        Action::OpenPath(_) | Action::OpenShipped(_) | Action::Begin(_) => true,
        Action::Answer(_) | Action::Bookmark(_) | Action::Set(_) | Action::Shoot(_) | Action::Bake(_) => false,
        Action::Panel(PanelAction::Reveal { .. }) | Action::Jump(_) | Action::ToggleLock(_) | Action::Clip(_) => true,
        Action::Variation(action) => matches!(action, VariationAction::Take(_) | VariationAction::UnlockAll),
        Action::Search(_) | Action::Panel(_) | Action::GoToPlace(_) => false,
        Action::DismissMessage | Action::Close(_) | Action::ClearRecent => false,
    }
}

/// Gives a parameter a number, as one undo step, and says so.
fn set_number(state: &mut State, path: &ParamPath, number: f64) {
    let mut planet = (**state.document.planet()).clone();
    let mut said = None;
    planet.each(&mut |at, param, value| {
        if at == path {
            said = Some(format!("{}: {}{}", param.label, format_number(number), suffix(param.unit)));
            match value {
                ValueMut::Number(now) => *now = number,
                ValueMut::Count(now) => *now = number as u32,
                _ => {}
            }
        }
    });
    state.edit(planet, None);
    if let Some(said) = said {
        state.notices.say(said);
    }
}

fn apply(state: &mut State, ctx: &egui::Context, action: Action) {
    match action {
        Action::Command(command) => run(state, ctx, command),
        Action::OpenPath(path) => opening::pursue(state, ctx, Goal::OpenPath(path)),
        Action::OpenShipped(index) => opening::pursue(state, ctx, Goal::OpenShipped(index)),
        Action::Begin(template) => opening::begin(state, ctx, template),
        Action::ClearRecent => state.recent.clear(),
        Action::Browse(path) => pictures::browse(state, ctx, path),
        Action::SetNumber(path, number) => set_number(state, &path, number),
        Action::Search(text) => state.search(Some(text)),
        Action::Panel(asked) => state.ask_panel(asked),
        Action::Variation(action) => variations::act(state, action),
        Action::Clip(action) => clipboard::act(state, ctx, action),
        Action::ToggleLock(path) => variations::toggle_lock(state, &path),
        Action::Jump(steps) => state.jump(ctx, steps),
        Action::GoToPlace(place) => place::go_to(state, place),
        Action::Bookmark(action) => bookmarks::apply(state, action),
        Action::Set(setting) => set(state, setting),
        Action::Answer(Answer::Unsaved(answer)) => answers::unsaved(state, ctx, answer),
        Action::Answer(Answer::Replace(answer)) => answers::replace(state, ctx, answer),
        Action::Answer(Answer::Change(answer)) => answers::change(state, ctx, answer),
        Action::Answer(Answer::Path(path)) => answers::path(state, ctx, path),
        Action::Answer(Answer::Recover(answer)) => opening::recover(state, answer),
        Action::DismissMessage => {
            if !state.messages.is_empty() {
                state.messages.remove(0);
            }
        }
        Action::Close(Window::Controls) => state.shows.controls = false,
        Action::Close(Window::Performance) => state.shows.performance = false,
        Action::Close(Window::Photo) => state.shows.photo = false,
        Action::Close(Window::Finder) => state.search(None),
        Action::Close(Window::History) => state.shows.history = false,
        Action::Close(Window::Place) => state.shows.place = false,
        Action::Close(Window::Inspector) => state.shows.inspector = false,
        Action::Close(Window::Variations) => state.shows.variations = false,
        Action::Close(Window::Templates) => state.shows.templates = false,
        Action::Close(Window::Text) => state.shows.text = false,
        Action::Close(Window::Bake) => state.shows.bake = false,
        Action::Bake(action) => baking::act(state, ctx, action),
        Action::Close(Window::Library) => state.shows.library = false,
        Action::Close(Window::Tour) => state.shows.tour = false,
        Action::Close(Window::System) => state.shows.system = false,
        Action::System(action) => system::act(state, ctx, action),
        Action::Library(action) => library::act(state, ctx, action),
        Action::Shoot(Shoot::Set(photo)) => state.photo = photo,
        Action::Shoot(Shoot::Ask(subject)) => shooting::ask(state, ctx, subject),
        Action::Shoot(Shoot::Cancel) => {
            if let Some(shooting) = &state.shooting {
                shooting.cancel();
            }
        }
    }
}

fn run(state: &mut State, ctx: &egui::Context, command: Command) {
    match commands::row(command) {
        Some(row) => row.run(state, ctx),
        None => log::error!("{command:?} has no row in the table of commands"),
    }
}

fn set(state: &mut State, setting: Setting) {
    let settings = &mut state.viewport.settings;
    match setting {
        Setting::Quality(quality) => settings.quality = quality,
        Setting::Tone(tone) => settings.post.tone = tone,
        Setting::ExposureEv(exposure_ev) => settings.post.exposure_ev = exposure_ev,
        Setting::WhiteK(white_k) => settings.post.white_k = white_k,
        Setting::Vignette(vignette) => settings.post.vignette = vignette,
        Setting::Bloom(bloom) => settings.post.bloom = bloom,
        Setting::AutoExposure(automatic) => settings.auto_exposure = automatic,
        Setting::Refine(refine) => settings.refine = refine,
        Setting::CacheMib(mib) => settings.cache_mib = mib.clamp(*CACHE_MIB.start(), *CACHE_MIB.end()),
        Setting::TimeSecs(time_secs) => settings.time_secs = time_secs,
        Setting::TimeSpeed(time_speed) => settings.time_speed = time_speed,
    }
}
