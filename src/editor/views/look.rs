//! Colours and spacing: dark by default.

use eframe::egui;

/// Sets the styles of both themes. The theme of the last run, if any, replaces the dark default.
pub fn set_up(ctx: &egui::Context) {
    ctx.options_mut(|options| options.fallback_theme = egui::Theme::Dark);
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 5.0);
        style.spacing.button_padding = egui::vec2(6.0, 2.0);
        style.spacing.interact_size.y = 20.0;
        style.spacing.slider_rail_height = 4.0;
        style.interaction.tooltip_delay = 0.4;
        style.visuals.slider_trailing_fill = true;
        style.visuals.striped = false;
        style.visuals.window_shadow = egui::Shadow::NONE;
    });
    ctx.style_mut_of(egui::Theme::Dark, |style| {
        let visuals = &mut style.visuals;
        visuals.panel_fill = egui::Color32::from_rgb(24, 26, 30);
        visuals.window_fill = egui::Color32::from_rgb(30, 33, 38);
        visuals.extreme_bg_color = egui::Color32::from_rgb(14, 15, 18);
        visuals.selection.bg_fill = egui::Color32::from_rgb(38, 84, 124);
        visuals.widgets.noninteractive.bg_stroke.color = egui::Color32::from_rgb(46, 50, 57);
    });
}
