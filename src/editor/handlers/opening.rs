//! Opening: another document in the place of this one, after a question where unsaved work would be lost.

use crate::editor::command::RecoverAnswer;
use crate::editor::files::dialogs::DialogRequest;
use crate::editor::files::file_names::{PRESET_EXTENSION, has_extension, readable_stem, with_extension};
use crate::editor::handlers::system;
use crate::editor::state::document::Document;
use crate::editor::state::questions::{Asking, Goal, Work};
use crate::editor::state::system::{OpenSystem, Preset};
use crate::editor::state::templates::Template;
use crate::editor::state::{State, recovery};
use crate::editor::widgets::random_seed;
use crate::lod::scout;
use crate::planet::file::read_text;
use crate::planet::picture::folder_of;
use crate::planet::random::Kind;
use crate::planet::{LoadError, Planet, locks, shipped};
use eframe::egui;
use std::path::{Path, PathBuf};

/// Random planets that are tried until one fits what is locked.
const MOST_ROLLS: u64 = 8;

/// Reads the file to start with. A file that does not exist yet gives a new planet of that name.
///
/// # Errors
/// What is wrong with the file, or why no planet can be saved under that name.
pub fn first_document(path: &Path) -> Result<Document, LoadError> {
    match read(path) {
        Err(LoadError::Read { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
            let refused = |why: String| LoadError::Read { path: path.to_owned(), source: std::io::Error::other(why) };
            let folder = folder_of(path);
            if !folder.is_dir() {
                return Err(refused(format!(
                    "there is no folder {}; create it first or name another",
                    folder.display()
                )));
            }
            if !has_extension(path, PRESET_EXTENSION) {
                let name = with_extension(path, PRESET_EXTENSION);
                let name = name.file_name().unwrap_or_default().to_string_lossy();
                return Err(refused(format!(
                    "there is no such file; the file name of a new planet ends in .ron, such as {name}"
                )));
            }
            let planet = Planet { name: readable_stem(path), ..shipped::default_planet() };
            Ok(Document::new(planet, Some(path.to_owned())))
        }
        read => read,
    }
}

/// Reads a document without its height maps: they are read in the background.
fn read(path: &Path) -> Result<Document, LoadError> {
    let text = read_text(path)?;
    let planet = Planet::from_text_of(path, &text)?;
    Ok(Document::opened(planet, path.to_owned(), text))
}

/// Pursues a goal: asks first if unsaved work would be lost.
pub fn pursue(state: &mut State, ctx: &egui::Context, goal: Goal) {
    state.questions.after_save = None;
    // A file is asked for first.
    let stays = matches!(goal, Goal::Open | Goal::BeginSystem | Goal::LeaveSystem | Goal::OpenSystem(_));
    if state.loses_work() && !stays {
        state.questions.unsaved = Some((Work::Planet, goal));
    } else {
        pursue_past_planet(state, ctx, goal);
    }
}

/// Pursues a goal for which unsaved changes of the planet may go: asks first if those of the system would be lost.
pub fn pursue_past_planet(state: &mut State, ctx: &egui::Context, goal: Goal) {
    let ends_system = match &goal {
        Goal::OpenSystem(_) | Goal::BeginSystem | Goal::LeaveSystem | Goal::Quit => true,
        Goal::OpenPath(path) => system::is_system(path),
        Goal::Begin(_) | Goal::Open | Goal::OpenShipped(_) | Goal::Visit(..) => false,
    };
    if ends_system && state.system_is_dirty() {
        state.questions.unsaved = Some((Work::System, goal));
    } else {
        reach(state, ctx, goal);
    }
}

/// A goal that was given up: a system of which no planet is open is closed again.
pub fn give_up(state: &mut State, goal: &Goal) {
    if matches!(goal, Goal::Visit(..)) && state.viewport.body().is_none() {
        system::leave(state);
    }
}

/// Reaches a goal without a question about unsaved work.
pub fn reach(state: &mut State, ctx: &egui::Context, goal: Goal) {
    match goal {
        Goal::Begin(template) => {
            state.replace_document(Document::new(template.planet(random_seed()), None));
            state.shows.templates = false;
        }
        Goal::Open => {
            let folder = state.document.folder();
            state.questions.ask(ctx, Asking::Open, DialogRequest::Open { folder });
        }
        Goal::OpenPath(path) if system::is_system(&path) => system::open_file(state, ctx, &path),
        Goal::OpenPath(path) => open_path(state, &path),
        Goal::OpenShipped(index) => open_shipped(state, index),
        Goal::Visit(body, arrival) => system::visit(state, body, arrival),
        Goal::OpenSystem(index) => system::open_shipped(state, ctx, index),
        Goal::BeginSystem => system::begin(state),
        Goal::LeaveSystem => system::leave(state),
        Goal::Quit => {
            state.questions.may_close = true;
            ctx.send_viewport_cmd(egui::ViewportCommand::Close);
        }
    }
}

/// Opens a preset.
pub(super) fn open_path(state: &mut State, path: &Path) {
    show(state, path, read(path));
}

/// Opens the shipped preset of an index.
pub(super) fn open_shipped(state: &mut State, index: usize) {
    if let Some(preset) = shipped::ALL.get(index) {
        let document = preset.load().map(|planet| Document::new(planet, None));
        show(state, Path::new(preset.file), document);
    }
}

/// Starts with a preset or a system. A preset need not exist yet.
pub fn begin_with(state: &mut State, ctx: &egui::Context, path: &Path) {
    if system::is_system(path) {
        return system::open_file(state, ctx, path);
    }
    show(state, path, first_document(path));
}

/// Shows a document that has been read. If it could not be read, a message says why, and the document stays.
fn show(state: &mut State, path: &Path, document: Result<Document, LoadError>) {
    match document {
        Ok(document) => {
            let note = document.note();
            state.replace_document(document);
            if let Some(note) = note {
                state.report("The ground is not as it was saved", vec![note]);
            }
        }
        Err(error) => state.report("The planet could not be opened", problems(path, &error)),
    }
}

/// Begins a new planet. A random one is an undo step of this document, any other is a document of its own.
pub fn begin(state: &mut State, ctx: &egui::Context, template: Template) {
    match template {
        Template::Random(kind) => {
            state.shows.templates = false;
            roll(state, Some(kind));
        }
        template => pursue(state, ctx, Goal::Begin(template)),
    }
}

/// Replaces the planet by a random one that has what is locked: one undo step.
pub fn roll(state: &mut State, kind: Option<Kind>) {
    let seed = random_seed();
    let here = state.document.valid_planet().clone();
    let mut kept = (0..MOST_ROLLS).map(|roll| locks::keep(&here, &scout::random_planet(kind, seed.wrapping_add(roll))));
    let Some(planet) = kept.find_map(|kept| kept) else {
        state.notices.say("No random planet fits what is locked: unlock something".to_owned());
        return;
    };
    // The name tells the rolls apart in the list of undo steps.
    let label = format!("Random planet: {}", planet.name);
    state.roll(planet, &label);
}

/// Opens the first working copy that a crash left behind, leaves it for the next start, or deletes it.
pub fn recover(state: &mut State, answer: RecoverAnswer) {
    if state.orphans.is_empty() {
        return;
    }
    let orphan = state.orphans.remove(0);
    if answer == RecoverAnswer::Later {
        return;
    }
    let keep = answer == RecoverAnswer::Recover;
    match &state.recovery {
        // Kept until this editor's own working copy takes its place: a second crash loses nothing.
        Some(recovery) if keep => recovery.adopt(&orphan.file),
        _ => recovery::remove_all(&orphan.file),
    }
    recovery::remove(&orphan.file.with_extension("lock"));
    if !keep {
        return;
    }
    let planet_file = orphan.planet.as_ref().and_then(|(_, file)| file.clone());
    if let Some((planet, file)) = orphan.planet {
        state.replace_document(recovered(planet, file));
    }
    if let Some((system, file)) = orphan.system {
        let (open, problems) = OpenSystem::recovered(system, file);
        if !problems.is_empty() {
            state.report("Not all planets of the recovered system can be read", problems);
        }
        let is_open = |body: &usize| match open.preset(*body) {
            Some(Preset::File(path)) => Some(path) == planet_file,
            _ => false,
        };
        let body = (0..open.system().bodies.len()).find(is_open);
        state.viewport.set_system(body.map(|body| (open.worlds.clone(), body)));
        state.shows.system = true;
        state.system = Some(open);
    }
}

/// A document with recovered work: an undo step of its file, if that can be read.
fn recovered(planet: Planet, file: Option<PathBuf>) -> Document {
    let Some((path, mut document)) = file.as_ref().and_then(|path| Some((path, read(path).ok()?))) else {
        return Document::unsaved(planet, file);
    };
    document.edit(planet.moved_to(&folder_of(path)), Some("Recovered work".to_owned()));
    document.settle();
    document
}

fn problems(path: &Path, error: &LoadError) -> Vec<String> {
    match error {
        LoadError::Read { source, .. } => vec![format!("{}: {source}", path.display())],
        LoadError::Invalid { file, problems } => problems
            .iter()
            .map(|problem| {
                let at = if problem.line > 0 { format!(":{}:{}", problem.line, problem.column) } else { String::new() };
                let path = if problem.path.is_empty() { String::new() } else { format!("{}: ", problem.path) };
                format!("{file}{at}: {path}{}", problem.message)
            })
            .collect(),
    }
}
