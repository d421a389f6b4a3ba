//! The tour: six steps for a first look around, which can be left at any time. It begins by itself in the first start.

use crate::editor::command::{Action, Command, Commands, Window};
use crate::editor::state::State;
use eframe::egui::{self, Rect};

/// Width of the card, points.
const WIDTH: f32 = 380.0;
/// Height of the text of a step, points.
const TEXT_HEIGHT: f32 = 54.0;

/// What a step is about: it is framed.
#[derive(Clone, Copy)]
enum About {
    Picture,
    Tabs,
    Menus,
}

struct Step {
    about: About,
    title: &'static str,
    text: &'static str,
    /// Commands to try, with their names on the card.
    tries: &'static [(&'static str, Command)],
}

const STEPS: [Step; 6] = [
    Step {
        about: About::Picture,
        title: "A planet of your own",
        text: "Begin from a template, take one from the library, or change the one you see. These six steps show \
               the way; leave them whenever you like.",
        tries: &[("New planet", Command::New), ("Library", Command::Library)],
    },
    Step {
        about: About::Picture,
        title: "Look around",
        text: "Drag to turn the planet, scroll towards a place, double-click to fly there. Walk on the ground, and \
               come back to the orbit.",
        tries: &[
            ("Walk", Command::Move(crate::editor::viewport::camera::Mode::Walk)),
            ("Orbit", Command::Move(crate::editor::viewport::camera::Mode::Orbit)),
        ],
    },
    Step {
        about: About::Tabs,
        title: "Change it",
        text: "Each tab is a part of the planet. Move a slider, and the planet follows at once. Every gesture is one \
               step, and undo goes all the way back. Drag the name of a tab to put it elsewhere.",
        tries: &[("Undo", Command::Undo), ("History", Command::History)],
    },
    Step {
        about: About::Menus,
        title: "Find by name",
        text: "The finder knows every command, planet and parameter by name. It opens the tab and shows the row.",
        tries: &[("Open the finder", Command::Finder)],
    },
    Step {
        about: About::Picture,
        title: "Explore",
        text: "Nine variations surround the planet you see: click one to take it, again and again. A padlock keeps what \
               you like as it is.",
        tries: &[("Variations", Command::Variations)],
    },
    Step {
        about: About::Menus,
        title: "Take it with you",
        text: "A planet is one file, which a game loads. Bake maps and meshes for other programs, take pictures, fly films.",
        tries: &[("Bake maps", Command::Bake), ("Picture or film", Command::Photo), ("All keys", Command::Controls)],
    },
];

/// The card with the steps.
#[derive(Default)]
pub struct TourCard {
    step: usize,
}

/// The layer of the card.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Foreground, id())
}

fn id() -> egui::Id {
    egui::Id::unique("tour")
}

impl TourCard {
    /// Shows the card while the tour goes on.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.tour {
            self.step = 0;
            return;
        }
        let step = &STEPS[self.step.min(STEPS.len() - 1)];
        let picture = state.viewport.rect();
        frame(ctx, about(step.about, picture, ctx.content_rect()));
        let width = WIDTH.min(picture.width() - 16.0).max(220.0);
        let at = picture.center_bottom() - egui::vec2(0.5 * width, 24.0);
        let area = egui::Area::new(id()).order(egui::Order::Foreground).pivot(egui::Align2::LEFT_BOTTOM).fixed_pos(at);
        area.show(ctx, |ui| {
            egui::Frame::window(ui.style()).show(ui, |ui| {
                ui.set_width(width);
                self.card(ui, step, commands);
            });
        });
    }

    fn card(&mut self, ui: &mut egui::Ui, step: &Step, commands: &mut Commands) {
        ui.horizontal(|ui| {
            ui.strong(step.title);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.weak(format!("{} of {}", self.step + 1, STEPS.len()));
            });
        });
        // As high in every step: the buttons stay where they are.
        ui.allocate_ui(egui::vec2(ui.available_width(), TEXT_HEIGHT), |ui| {
            ui.set_min_height(TEXT_HEIGHT);
            ui.add(egui::Label::new(step.text).wrap());
        });
        ui.horizontal_wrapped(|ui| {
            for (label, command) in step.tries {
                if ui.button(*label).clicked() {
                    commands.send(*command);
                }
            }
        });
        ui.separator();
        ui.horizontal(|ui| {
            let last = self.step + 1 == STEPS.len();
            if ui.add_enabled(self.step > 0, egui::Button::new("Back")).clicked() {
                self.step -= 1;
            }
            if ui.button(if last { "Done" } else { "Next" }).clicked() {
                if last {
                    commands.push(Action::Close(Window::Tour));
                } else {
                    self.step += 1;
                }
            }
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                if !last && ui.button("Leave the tour").on_hover_text("Help › Tour brings it back").clicked() {
                    commands.push(Action::Close(Window::Tour));
                }
            });
        });
    }
}

fn about(about: About, picture: Rect, window: Rect) -> Rect {
    match about {
        About::Picture => picture,
        About::Tabs => Rect::from_min_max(picture.right_top(), egui::pos2(window.right(), picture.bottom())),
        About::Menus => Rect::from_min_max(window.min, egui::pos2(window.right(), picture.top())),
    }
}

/// Frames what a step is about.
fn frame(ctx: &egui::Context, rect: Rect) {
    let layer = egui::LayerId::new(egui::Order::Middle, egui::Id::unique("frame of the tour"));
    let color = ctx.style_of(ctx.theme()).visuals.selection.stroke.color;
    ctx.layer_painter(layer).rect_stroke(rect.shrink(1.0), 4.0, (2.0, color), egui::StrokeKind::Inside);
}
