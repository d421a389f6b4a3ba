//! Parts and layers through the clipboard, as the text of a preset.

use crate::editor::command::{ClipAction, PanelAction, Wanted};
use crate::editor::panels::layer_edit;
use crate::editor::state::State;
use crate::planet::{Layer, Planet, snippet};
use eframe::egui;

/// Name of the clipboard in messages.
const SOURCE: &str = "clipboard";

/// Copies, cuts, or asks for what is to be pasted.
pub fn act(state: &mut State, ctx: &egui::Context, action: ClipAction) {
    let planet = state.document.planet();
    match action {
        ClipAction::CopyPart(part) => {
            if let Some(text) = snippet::of_part(planet, part) {
                ctx.copy_text(text);
                state.notices.say(format!("Copied {}", name_of(part)));
            }
        }
        ClipAction::CopyLayers(indices) => copy_layers(state, ctx, &indices),
        ClipAction::CutLayers(indices) => {
            copy_layers(state, ctx, &indices);
            let mut planet = (**state.document.planet()).clone();
            layer_edit::remove_all(&mut planet, &indices);
            state.step(planet, layer_edit::counted("Cut", indices.len()));
        }
        ClipAction::Ask(wanted) => {
            state.pasting = Some(wanted);
            ctx.send_viewport_cmd(egui::ViewportCommand::RequestPaste);
        }
        ClipAction::Paste(wanted, text) => paste(state, wanted, &text),
        ClipAction::TakeText(text) => match Planet::from_text(SOURCE, &text) {
            Ok(planet) => state.step(planet, "Edit text".to_owned()),
            Err(error) => state.report("The text is no planet", error.to_string().lines().map(str::to_owned).collect()),
        },
    }
}

/// Takes the text of the clipboard if something has asked for it: the desktop gives it in a later frame.
pub fn poll(state: &mut State, ctx: &egui::Context) {
    let Some(wanted) = state.pasting else { return };
    let text = ctx.input(|input| {
        input.events.iter().find_map(|event| match event {
            egui::Event::Paste(text) => Some(text.clone()),
            _ => None,
        })
    });
    if let Some(text) = text {
        state.pasting = None;
        paste(state, wanted, &text);
    }
}

fn copy_layers(state: &mut State, ctx: &egui::Context, indices: &[usize]) {
    let planet = state.document.planet();
    let layers: Vec<Layer> = indices.iter().filter_map(|index| planet.layers.get(*index)).cloned().collect();
    let told = match layers.as_slice() {
        [] => return,
        [layer] => format!("Copied {}", layer.name),
        layers => format!("Copied {} layers", layers.len()),
    };
    ctx.copy_text(snippet::of_layers(&layers));
    state.notices.say(told);
}

fn paste(state: &mut State, wanted: Wanted, text: &str) {
    let refused = |state: &mut State, why: String| state.report("Nothing was pasted", vec![why]);
    let read = match snippet::read(SOURCE, text) {
        Ok(read) => read,
        Err(why) => return refused(state, why),
    };
    let mut planet = (**state.document.planet()).clone();
    let label = match wanted {
        Wanted::Part(part) if read.has(part) => {
            planet.take_part(read.planet(), part);
            format!("Paste {}", name_of(part))
        }
        Wanted::Part(part) => {
            return refused(state, format!("The clipboard holds no {}: copy one first.", name_of(part)));
        }
        Wanted::Layers { after } => {
            let layers = &read.planet().layers;
            if layers.is_empty() {
                return refused(state, "The clipboard holds no layer: copy one first.".to_owned());
            }
            let Some(first) = layer_edit::paste(&mut planet, layers, after) else {
                return refused(state, "The planet has as many layers as it may have.".to_owned());
            };
            state.ask_panel(PanelAction::SelectLayers(first, layers.len()));
            state.notices.say(layer_edit::counted("Pasted", layers.len()));
            layer_edit::counted("Paste", layers.len())
        }
    };
    state.step(planet, label);
}

fn name_of(part: &str) -> &str {
    if part.is_empty() { "planet" } else { part }
}
