//! Import and export of the biome table as a picture.

use crate::editor::files::dialogs::DialogRequest;
use crate::editor::files::file_names::with_extension;
use crate::editor::painter::table_png;
use crate::editor::state::State;
use crate::editor::state::questions::{Asking, Replace};
use crate::planet::file;
use eframe::egui;
use std::path::Path;

/// Largest picture that is read, in bytes. A table of the most cells takes far less; the rest of a larger file is cut
/// off, and the picture refused.
const MAX_TABLE_BYTES: u64 = 1 << 24;

/// Asks for the picture to read.
pub fn ask_for_import(state: &mut State, ctx: &egui::Context) {
    let folder = state.document.folder();
    state.questions.ask(ctx, Asking::ImportTable, DialogRequest::ImportTable { folder });
}

/// Asks for the file to write.
pub fn ask_for_export(state: &mut State, ctx: &egui::Context) {
    let folder = state.document.folder();
    let file_name = state.document.suggested_file_name().replace(".ron", "-biomes.png");
    state.questions.ask(ctx, Asking::ExportTable, DialogRequest::ExportTable { folder, file_name });
}

/// Takes over the table of a picture. A message says if colours were missing from the palette.
pub fn import(state: &mut State, file: &Path) {
    let mut planet = (**state.document.planet()).clone();
    let read = file::read(file, MAX_TABLE_BYTES).map_err(|error| error.to_string());
    match read.and_then(|bytes| table_png::decode(&bytes, &planet.biomes)) {
        Ok(imported) => {
            planet.biomes.table = imported.table;
            state.edit(planet, Some("Import biome table".to_owned()));
            if imported.inexact > 0 {
                let (pixels, have) = if imported.inexact == 1 { ("pixel", "has") } else { ("pixels", "have") };
                let line = format!(
                    "{} {pixels} of {} {have} no colour of the palette: the nearest biome was taken.",
                    imported.inexact,
                    file.display()
                );
                state.report("Some colours were not exact", vec![line]);
            }
        }
        Err(why) => {
            state.report("The biome table could not be imported", vec![format!("{}: {why}", file.display())]);
        }
    }
}

/// Writes the table to a file that was chosen. `agreed` is the file that the user has agreed to replace, if it exists.
pub fn export_chosen(state: &mut State, file: &Path, agreed: Option<&Path>) {
    let path = with_extension(file, "png");
    if state.would_lose("The biome table could not be exported", &[&path]) {
        return;
    }
    if path.exists() && agreed != Some(&path) {
        state.questions.replace = Some(Replace::Table(path));
    } else {
        export(state, &path);
    }
}

/// Writes the table as a picture. A message says if biomes have the same colour.
pub fn export(state: &mut State, path: &Path) {
    let biomes = &state.document.planet().biomes;
    let written = table_png::encode(biomes).and_then(|bytes| file::write_atomically(path, &bytes));
    if let Err(why) = written {
        state.report("The biome table could not be exported", vec![format!("{}: {why}", path.display())]);
        return;
    }
    let lines: Vec<String> = table_png::look_alikes(biomes)
        .into_iter()
        .map(|(first, other)| format!("{other} has the colour of {first}: an import makes both {first}."))
        .collect();
    state.notices.say(format!("Exported to {}", path.display()));
    if !lines.is_empty() {
        state.report("Exported, but some biomes look alike", lines);
    }
}
