//! Import and export of the biome table as a picture.

use super::app::EditorApp;
use super::dialogs::DialogRequest;
use super::files::Asking;
use super::painter::table_png;
use super::prompts::Message;
use crate::planet::file;
use eframe::egui;
use std::path::Path;

/// No picture of a table takes more: what is longer is cut off, and refused as broken.
const MAX_TABLE_BYTES: u64 = 1 << 24;

impl EditorApp {
    /// Asks for the picture to read, or for the file to write.
    pub(super) fn ask_for_table(&mut self, ctx: &egui::Context, import: bool) {
        let folder = self.document.folder();
        if import {
            self.ask(ctx, Asking::ImportTable, DialogRequest::ImportTable { folder });
        } else {
            let file_name = self.document.suggested_file_name().replace(".ron", "-biomes.png");
            self.ask(ctx, Asking::ExportTable, DialogRequest::ExportTable { folder, file_name });
        }
    }

    /// Takes the table of a picture over; says so if colours were not those of the palette.
    pub(super) fn import_table(&mut self, file: &Path) {
        let mut planet = (**self.document.planet()).clone();
        let read = file::read(file, MAX_TABLE_BYTES).map_err(|error| error.to_string());
        match read.and_then(|bytes| table_png::decode(&bytes, &planet.biomes)) {
            Ok(imported) => {
                planet.biomes.table = imported.table;
                self.edit(planet, Some("Import biome table".to_owned()));
                if imported.inexact > 0 {
                    let (pixels, have) = if imported.inexact == 1 { ("pixel", "has") } else { ("pixels", "have") };
                    let line = format!(
                        "{} {pixels} of {} {have} no colour of the palette: the nearest biome was taken.",
                        imported.inexact,
                        file.display()
                    );
                    self.messages.push(Message { title: "Some colours were not exact".to_owned(), lines: vec![line] });
                }
            }
            Err(why) => self.messages.push(Message {
                title: "The biome table could not be imported".to_owned(),
                lines: vec![format!("{}: {why}", file.display())],
            }),
        }
    }

    /// Writes the table as a picture; says so if the picture cannot tell biomes apart.
    pub(super) fn export_table(&mut self, file: &Path) {
        let biomes = &self.document.planet().biomes;
        let written =
            table_png::encode(biomes).and_then(|bytes| std::fs::write(file, bytes).map_err(|error| error.to_string()));
        if let Err(why) = written {
            self.messages.push(Message {
                title: "The biome table could not be exported".to_owned(),
                lines: vec![format!("{}: {why}", file.display())],
            });
            return;
        }
        self.say(format!("Exported to {}", file.display()));
        let lines: Vec<String> = table_png::look_alikes(&self.document.planet().biomes)
            .into_iter()
            .map(|(first, other)| format!("{other} has the colour of {first}: an import makes both {first}."))
            .collect();
        if !lines.is_empty() {
            self.messages.push(Message { title: "Exported, but some biomes look alike".to_owned(), lines });
        }
    }
}
