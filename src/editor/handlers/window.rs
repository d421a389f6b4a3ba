//! Full screen and theme.

use crate::editor::state::State;
use eframe::egui::{Context, Theme, ViewportCommand};

/// Makes the window fill the screen, or gives it its size back.
pub fn toggle_fullscreen(_: &mut State, ctx: &Context) {
    let fullscreen = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
    ctx.send_viewport_cmd(ViewportCommand::Fullscreen(!fullscreen));
}

/// Switches between the light and the dark theme.
pub fn toggle_theme(_: &mut State, ctx: &Context) {
    ctx.set_theme(if ctx.theme() == Theme::Dark { Theme::Light } else { Theme::Dark });
}
