//! Asks for a file in the window, where the desktop has no file dialogs: a path to type, and a list of its folder.

use crate::editor::files::dialogs::DialogRequest;
use crate::editor::state::questions::WantedPath;
use eframe::egui;
use std::fs;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};

/// Most names that are listed.
const MOST_LISTED: usize = 200;

/// A path that is being typed.
pub(super) struct PathField {
    request: DialogRequest,
    /// Why there is no dialog.
    why: String,
    typed: String,
    problem: Option<String>,
    listed: Option<(PathBuf, Vec<Entry>)>,
}

#[derive(Clone)]
struct Entry {
    name: String,
    is_folder: bool,
}

impl PathField {
    pub(super) fn new(wanted: &WantedPath) -> Self {
        let (request, why) = (wanted.request.clone(), wanted.why.clone());
        let base = request.folder().cloned().or_else(|| std::env::current_dir().ok()).unwrap_or_default();
        let mut typed = base.join(request.file_name().unwrap_or_default()).display().to_string();
        if request.file_name().is_none() && !typed.ends_with(MAIN_SEPARATOR) {
            typed.push(MAIN_SEPARATOR);
        }
        Self { request, why, typed, problem: None, listed: None }
    }

    /// Whether the field asks for this path.
    pub(super) fn is_for(&self, wanted: &WantedPath) -> bool {
        self.request == wanted.request
    }

    /// The path that was typed: `~` is the home folder, and a relative path counts from the folder of the request.
    fn path(&self) -> PathBuf {
        let typed = self.typed.trim();
        let home = || std::env::home_dir().unwrap_or_default();
        if typed == "~" {
            return home();
        }
        if let Some(rest) = typed.strip_prefix("~/") {
            return home().join(rest);
        }
        let base = self.request.folder().cloned().or_else(|| std::env::current_dir().ok()).unwrap_or_default();
        base.join(typed)
    }

    /// The folder of the typed path, and the begin of a name in it.
    fn folder_and_name(&self) -> (PathBuf, String) {
        let path = self.path();
        match (path.parent(), path.file_name()) {
            (Some(folder), Some(name)) if !self.typed.trim_end().ends_with(['/', MAIN_SEPARATOR]) => {
                (folder.to_owned(), name.to_string_lossy().into_owned())
            }
            _ => (path, String::new()),
        }
    }

    /// The chosen file, or what is wrong with the path.
    fn chosen(&self) -> Result<PathBuf, String> {
        let (path, (folder, name)) = (self.path(), self.folder_and_name());
        if !folder.is_dir() {
            return Err(format!("There is no folder {}.", folder.display()));
        }
        if self.request.is_folder() {
            // A folder that is not there yet is made.
            return if path.is_file() { Err(format!("{} is a file.", path.display())) } else { Ok(path) };
        }
        if name.is_empty() || path.is_dir() {
            return Err(format!("{} is a folder: name a file in it.", path.display()));
        }
        if !self.request.saves() && !path.is_file() {
            return Err(format!("There is no file {}.", path.display()));
        }
        Ok(path)
    }

    /// Shows the field. Gives the chosen file, or an inner None if the user cancelled.
    pub(super) fn show(&mut self, ctx: &egui::Context) -> Option<Option<PathBuf>> {
        let modal = egui::Modal::new(egui::Id::unique("path field")).show(ctx, |ui| {
            ui.set_width(520.0_f32.min(ctx.content_rect().width() - 60.0));
            ui.heading(self.request.title());
            ui.add(egui::Label::new(egui::RichText::new(&self.why).weak()).wrap());
            ui.add_space(6.0);
            let label = ui.label(if self.request.is_folder() { "Path of the folder" } else { "Path of the file" });
            let edit = egui::TextEdit::singleline(&mut self.typed).desired_width(f32::INFINITY);
            let field = ui.add(edit).labelled_by(label.id);
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if field.changed() {
                self.problem = None;
            }
            if !field.has_focus() && !ui.input(|input| input.pointer.any_down()) {
                field.request_focus();
            }
            let picked = self.list(ui);
            if let Some(problem) = &self.problem {
                ui.colored_label(ui.visuals().error_fg_color, problem);
            }
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let verb = if self.request.saves() { "Save here" } else { "Open this file" };
                (ui.button(verb).clicked() || entered || picked, ui.button("Cancel").clicked())
            })
            .inner
        });
        let (done, cancelled) = modal.inner;
        if done {
            match self.chosen() {
                Ok(path) => return Some(Some(path)),
                // Enter on a folder opens it.
                Err(_) if self.path().is_dir() && !self.typed.ends_with(MAIN_SEPARATOR) => {
                    self.typed.push(MAIN_SEPARATOR);
                    move_cursor_to_end(ctx);
                }
                Err(problem) => self.problem = Some(problem),
            }
        }
        (cancelled || modal.should_close()).then_some(None)
    }

    /// Lists the names that the typed path may become; a click takes a name. Gives whether a file was double-clicked.
    fn list(&mut self, ui: &mut egui::Ui) -> bool {
        let (folder, begin) = self.folder_and_name();
        if self.listed.as_ref().is_none_or(|(listed, _)| *listed != folder) {
            self.listed = Some((folder.clone(), entries(&folder, self.request.extensions())));
        }
        let entries = self.listed.as_ref().map(|(_, entries)| entries.clone()).unwrap_or_default();
        // A complete name, and a name to save under, do not filter the list.
        let known = entries.iter().any(|entry| entry.name == begin) || self.request.saves();
        let fits = |entry: &&Entry| known || entry.name.to_lowercase().starts_with(&begin.to_lowercase());
        let mut picked = false;
        egui::Frame::group(ui.style()).show(ui, |ui| {
            let room = (ui.ctx().content_rect().height() - 300.0).clamp(60.0, 220.0);
            egui::ScrollArea::vertical().max_height(room).min_scrolled_height(60.0).show(ui, |ui| {
                ui.set_min_width(ui.available_width());
                ui.set_min_height(60.0);
                let up = folder.parent().map(|_| Entry { name: "..".to_owned(), is_folder: true });
                for entry in up.iter().chain(entries.iter().filter(fits)) {
                    let slash = if entry.is_folder { "/" } else { "" };
                    let row = ui.selectable_label(entry.name == begin, format!("{}{slash}", entry.name));
                    if row.clicked() {
                        self.typed = self.taken(&folder, entry);
                        self.problem = None;
                        move_cursor_to_end(ui.ctx());
                    }
                    picked |= row.double_clicked() && !entry.is_folder;
                }
            });
        });
        picked
    }

    /// The path of a clicked name.
    fn taken(&self, folder: &Path, entry: &Entry) -> String {
        let path = match (entry.is_folder, entry.name.as_str()) {
            (true, "..") => folder.parent().unwrap_or(folder).to_owned(),
            (_, name) => folder.join(name),
        };
        let mut text = path.display().to_string();
        if entry.is_folder && !text.ends_with(MAIN_SEPARATOR) {
            text.push(MAIN_SEPARATOR);
        }
        // The name to save under stays when the folder changes.
        if let Some(name) = self.request.file_name().filter(|_| entry.is_folder) {
            text.push_str(name);
        }
        text
    }
}

/// The field keeps the focus; the user types on at the end of the path.
fn move_cursor_to_end(ctx: &egui::Context) {
    if let Some(id) = ctx.memory(egui::Memory::focused)
        && let Some(mut state) = egui::TextEdit::load_state(ctx, id)
    {
        let end = egui::text::CCursor::new(usize::MAX);
        state.cursor.set_char_range(Some(egui::text::CCursorRange::one(end)));
        state.store(ctx, id);
    }
}

/// Folders, then files with these extensions, by name, without hidden ones.
fn entries(folder: &Path, extensions: &[&str]) -> Vec<Entry> {
    let Ok(read) = fs::read_dir(folder) else { return Vec::new() };
    let mut entries: Vec<Entry> = read
        .filter_map(Result::ok)
        .filter_map(|found| {
            let path = found.path();
            let name = found.file_name().to_string_lossy().into_owned();
            let is_folder = path.is_dir();
            let fits = extensions.iter().any(|e| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(e)));
            (!name.starts_with('.') && (is_folder || fits)).then_some(Entry { name, is_folder })
        })
        .collect();
    entries.sort_by_key(|entry| (!entry.is_folder, entry.name.to_lowercase()));
    entries.truncate(MOST_LISTED);
    entries
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::editor::state::questions::Asking;

    fn field_for(request: DialogRequest) -> PathField {
        PathField::new(&WantedPath { asking: Asking::Open, request, why: String::new() })
    }

    #[test]
    fn a_path_is_checked_before_it_is_taken() {
        let folder = tempfile::tempdir().unwrap();
        let base = folder.path().to_owned();
        fs::write(base.join("a.ron"), "").unwrap();
        let open = DialogRequest::Open { folder: Some(base.clone()) };
        let mut field = field_for(open);
        let mut chosen = |typed: &str| {
            field.typed = typed.to_owned();
            field.chosen()
        };
        assert_eq!(chosen("a.ron"), Ok(base.join("a.ron")));
        assert!(chosen("b.ron").unwrap_err().contains("no file"));
        assert!(chosen("x/b.ron").unwrap_err().contains("no folder"));
        assert!(chosen("").unwrap_err().contains("is a folder"));

        let save = DialogRequest::SaveAs { folder: Some(base.clone()), file_name: "new.ron".to_owned() };
        let field = field_for(save);
        assert_eq!(field.chosen(), Ok(base.join("new.ron")), "the name that is offered");
        assert_eq!(entries(&base, &["ron"]).len(), 1);
        assert!(entries(&base, &["png"]).is_empty());
    }
}
