//! Colours and spacing: dark by default.

use eframe::egui;

/// Where a window of the editor opens: below the menus and the chips over the picture, in points.
pub const WINDOW_POS: egui::Pos2 = egui::pos2(12.0, 70.0);
/// Size of the smallest text, in points.
const SMALLEST_TEXT: f32 = 11.0;

/// Sets the styles of both themes. The theme of the last run, if any, replaces the dark default.
pub fn set_up(ctx: &egui::Context) {
    ctx.options_mut(|options| {
        options.fallback_theme = egui::Theme::Dark;
        // The default follows egui's own debug assertions, which are off (Cargo.toml).
        options.warn_on_id_clash = cfg!(debug_assertions);
    });
    ctx.all_styles_mut(|style| {
        style.spacing.item_spacing = egui::vec2(6.0, 5.0);
        style.spacing.button_padding = egui::vec2(6.0, 2.0);
        style.spacing.interact_size.y = 20.0;
        style.spacing.slider_rail_height = 4.0;
        style.interaction.tooltip_delay = 0.4;
        style.visuals.slider_trailing_fill = true;
        style.visuals.striped = false;
        style.visuals.window_shadow = egui::Shadow::NONE;
        style.text_styles.insert(egui::TextStyle::Small, egui::FontId::proportional(SMALLEST_TEXT));
    });
    ctx.style_mut_of(egui::Theme::Dark, |style| {
        let visuals = &mut style.visuals;
        visuals.panel_fill = egui::Color32::from_rgb(24, 26, 30);
        visuals.window_fill = egui::Color32::from_rgb(30, 33, 38);
        visuals.extreme_bg_color = egui::Color32::from_rgb(14, 15, 18);
        visuals.selection.bg_fill = egui::Color32::from_rgb(38, 84, 124);
        visuals.widgets.noninteractive.bg_stroke.color = egui::Color32::from_rgb(46, 50, 57);
        visuals.widgets.noninteractive.fg_stroke.color = egui::Color32::from_gray(185);
        visuals.widgets.inactive.fg_stroke.color = egui::Color32::from_gray(205);
        visuals.weak_text_color = Some(egui::Color32::from_gray(146));
        visuals.error_fg_color = egui::Color32::from_rgb(255, 122, 110);
    });
    ctx.style_mut_of(egui::Theme::Light, |style| {
        style.visuals.widgets.noninteractive.fg_stroke.color = egui::Color32::from_gray(60);
        style.visuals.weak_text_color = Some(egui::Color32::from_gray(98));
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Relative luminance of WCAG 2.1.
    fn luminance(color: egui::Color32) -> f64 {
        let [r, g, b] = [color.r(), color.g(), color.b()].map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        0.2126 * r + 0.7152 * g + 0.0722 * b
    }

    #[test]
    fn text_is_large_enough_and_stands_out_in_both_themes() {
        let ctx = egui::Context::default();
        set_up(&ctx);
        for theme in [egui::Theme::Dark, egui::Theme::Light] {
            let style = ctx.style_of(theme);
            let visuals = &style.visuals;
            let smallest = style.text_styles.values().map(|font| font.size).fold(f32::MAX, f32::min);
            assert!(smallest >= 11.0, "{smallest}");
            for text in [visuals.text_color(), visuals.weak_text_color(), visuals.widgets.inactive.text_color()] {
                for ground in [visuals.panel_fill, visuals.window_fill] {
                    let (a, b) = (luminance(text), luminance(ground));
                    let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                    assert!(contrast >= 4.5, "{theme:?}: {text:?} on {ground:?} has {contrast:.1}");
                }
            }
        }
    }
}
