//! The performance window: the times of the last edit, the memory of the cache, and the newest frames.

use super::look;
use crate::editor::command::{Action, Commands, Setting, Window};
use crate::editor::state::State;
use crate::editor::viewport::frames::FrameTime;
use crate::editor::viewport::settings::CACHE_MIB;
use crate::editor::viewport::timeline::{Step, Timeline};
use crate::editor::widgets::number::megabytes;
use eframe::egui;
use egui::{Color32, Rect, RichText, Sense, Stroke, pos2, vec2};
use std::time::Duration;

/// Width of the bars, in points.
const BAR_WIDTH: f32 = 220.0;
/// Frames in the graph.
const GRAPH_FRAMES: usize = 200;
/// Longest time that a frame should take: the line in the graph.
const FRAME_BAR: Duration = Duration::from_millis(33);

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("performance window")
}

/// Shows the window if it is open.
pub fn show(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let mut open = state.shows.performance;
    let window = egui::Window::new("Performance").id(id()).open(&mut open);
    window.resizable(false).default_pos(look::WINDOW_POS).show(ctx, |ui| {
        match state.viewport.edit_clock.timeline() {
            Some(timeline) => last_edit(ui, timeline),
            None => {
                ui.weak("The times of the next edit appear here.");
            }
        }
        ui.separator();
        memory(ui, state, commands);
        ui.separator();
        frames(ui, state);
    });
    if open != state.shows.performance {
        commands.push(Action::Close(Window::Performance));
    }
}

fn last_edit(ui: &mut egui::Ui, timeline: &Timeline) {
    ui.strong(format!("Last edit: {}", ms(timeline.total.as_secs_f64())));
    let total_secs = timeline.total.as_secs_f64().max(1e-6);
    egui::Grid::new("timeline").num_columns(3).spacing([10.0, 2.0]).show(ui, |ui| {
        for step in &timeline.steps {
            ui.label(step.label);
            bar(ui, step, total_secs);
            ui.label(busy_text(step)).on_hover_text("Time on all threads, and number of runs");
            ui.end_row();
        }
    });
    let build = &timeline.build;
    let samples = build.octave_samples as f64 * 1e-6;
    ui.label(format!(
        "{} tiles rebuilt, {} reused; slices: {}; {samples:.2} million octave samples; {:.1} MB uploaded",
        build.tiles_built,
        timeline.tiles_reused,
        build.slices,
        megabytes(timeline.uploaded_bytes)
    ));
}

/// The bar of a step: brighter the more threads it used.
fn bar(ui: &mut egui::Ui, step: &Step, total_secs: f64) {
    let (rect, response) = ui.allocate_exact_size(vec2(BAR_WIDTH, ui.spacing().interact_size.y * 0.6), Sense::hover());
    let x = |secs: f64| rect.left() + rect.width() * (secs / total_secs).clamp(0.0, 1.0) as f32;
    let (begin, end) = (x(step.begin_secs), x(step.end_secs));
    ui.painter().rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    let threads = step.busy_secs / (step.end_secs - step.begin_secs).max(1e-9);
    let color = ui.visuals().selection.bg_fill.gamma_multiply(0.5 + 0.5 * threads.min(1.0) as f32);
    let filled = Rect::from_min_max(pos2(begin, rect.top()), pos2(end.max(begin + 1.0), rect.bottom()));
    ui.painter().rect_filled(filled, 2.0, color);
    response.on_hover_text(format!("{} to {} after the edit", ms(step.begin_secs), ms(step.end_secs)));
}

fn busy_text(step: &Step) -> String {
    let times = if step.runs > 1 { format!(" · {}×", step.runs) } else { String::new() };
    format!("{}{times}", ms(step.busy_secs))
}

fn memory(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let memory = state.viewport.memory();
    let share = memory.used_bytes as f32 / memory.budget_bytes.max(1) as f32;
    let text = format!("{:.0} of {:.0} MB", megabytes(memory.used_bytes as u64), megabytes(memory.budget_bytes as u64));
    ui.horizontal(|ui| {
        ui.label("Cache");
        ui.add(egui::ProgressBar::new(share.min(1.0)).desired_width(BAR_WIDTH).text(text));
        ui.label(format!("{} tiles, {} horizons, {} layer fields", memory.tiles, memory.horizons, memory.fields));
    });
    ui.horizontal(|ui| {
        let label = ui.label("Memory for tiles");
        let mut mib = state.viewport.settings.cache_mib;
        let slider = egui::Slider::new(&mut mib, CACHE_MIB).logarithmic(true).suffix(" MiB");
        let slider = ui.add(slider).labelled_by(label.id);
        if slider.on_hover_text("More keeps more of where you have been; less leaves more to other programs").changed()
        {
            commands.push(Action::Set(Setting::CacheMib(mib)));
        }
    });
    if let Some(surface) = state.viewport.surface() {
        let horizons = surface.stats.horizons;
        ui.label(format!("Horizons for the newest view: {} made in {}", horizons.tiles, ms(horizons.secs)))
            .on_hover_text("The horizon angles that shade the ground, computed in the background for finished tiles");
    }
    if let Some(runs) = state.viewport.lut_runs() {
        ui.label(format!(
            "Look-up tables made since the start: biomes {}, weather {}, air {}, uniforms {}",
            runs.biomes, runs.weather, runs.air, runs.uniforms
        ));
    }
}

fn frames(ui: &mut egui::Ui, state: &State) {
    let log = &state.viewport.frames;
    let (longest, most) = log.worst(|frame| frame.editor);
    ui.label(format!(
        "Editor's share of the last {} frames: at most {}, 95 in 100 within {}",
        log.frames().len(),
        ms(longest.as_secs_f64()),
        ms(most.as_secs_f64())
    ))
    .on_hover_text("Without egui's painting and the driver's work");
    let (rect, _) = ui.allocate_exact_size(vec2(ui.available_width(), 60.0), Sense::hover());
    let painter = ui.painter_at(rect);
    painter.rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    let height = |time: Duration| rect.height() * (time.as_secs_f32() / (2.0 * FRAME_BAR.as_secs_f32())).min(1.0);
    let width = rect.width() / GRAPH_FRAMES as f32;
    let newest: Vec<&FrameTime> = log.frames().skip(log.frames().len().saturating_sub(GRAPH_FRAMES)).collect();
    for (i, frame) in newest.into_iter().enumerate() {
        let left = rect.left() + i as f32 * width;
        let column = |time: Duration, color: Color32| {
            let top = rect.bottom() - height(time);
            let column = Rect::from_min_max(pos2(left, top), pos2(left + width, rect.bottom()));
            painter.rect_filled(column, 0.0, color);
        };
        column(frame.whole, ui.visuals().faint_bg_color.gamma_multiply(2.0));
        column(frame.editor, ui.visuals().selection.bg_fill);
        column(frame.upload, ui.visuals().warn_fg_color);
    }
    let line = rect.bottom() - height(FRAME_BAR);
    painter.hline(rect.x_range(), line, Stroke::new(1.0, ui.visuals().error_fg_color));
    ui.label(
        RichText::new("Blue: the editor; yellow: uploads; grey: the whole frame; the line is at 33 ms").weak().small(),
    );
}

fn ms(secs: f64) -> String {
    format!("{:.1} ms", secs * 1000.0)
}
