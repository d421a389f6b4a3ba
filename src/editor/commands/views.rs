//! Commands that choose what is shown of the planet, and in how many views.

use super::{Menu, Row, plain};
use crate::editor::command::Command;
use crate::editor::viewport::panes::PaneLayout;
use crate::render::DebugView;
use eframe::egui::{Key, KeyboardShortcut, Modifiers};

pub(super) fn rows() -> Vec<Row> {
    DebugView::ALL.into_iter().map(debug_view).chain(PaneLayout::ALL.into_iter().map(panes)).collect()
}

fn panes(layout: PaneLayout) -> Row {
    let (label, tooltip, key) = match layout {
        PaneLayout::One => ("One view", "Give the view with the tools all the room.", Key::Num1),
        PaneLayout::Two => ("Two views", "Show a map, or another view of the planet, beside this one.", Key::Num2),
        PaneLayout::Four => ("Four views", "Show heights, biomes and a map beside the planet.", Key::Num4),
    };
    Row::new(Command::Panes(layout), label, tooltip, move |s, _| s.viewport.set_layout(layout))
        .within(Menu::View, 1)
        .keys([KeyboardShortcut::new(Modifiers::COMMAND | Modifiers::ALT, key)])
        .chosen_when(move |s| s.viewport.layout() == layout)
}

fn debug_view(view: DebugView) -> Row {
    let (tooltip, key) = match view {
        DebugView::Shaded => ("Show the planet in its light.", Some(Key::Num1)),
        DebugView::Height => ("Show heights, from the lowest to the highest in the picture.", Some(Key::Num2)),
        DebugView::Normal => ("Show the normals of the ground.", Some(Key::Num3)),
        DebugView::Slope => ("Show the slope of the ground, up to 60°.", Some(Key::Num4)),
        DebugView::Biome => ("Show the colours of the biomes alone.", Some(Key::Num5)),
        DebugView::Temperature => ("Show the temperature, from -40 to 40 °C.", Some(Key::Num6)),
        DebugView::Moisture => ("Show the moisture, from dry to wet.", Some(Key::Num7)),
        DebugView::Lod => ("Show the level of each tile.", Some(Key::Num8)),
        DebugView::TileBorders => ("Show the borders of the tiles.", Some(Key::Num9)),
        DebugView::Wireframe => ("Show the edges of the triangles.", Some(Key::Num0)),
        DebugView::Error => ("Show the vertex spacing: blue 1 pixel, green 4, yellow 16, red 64.", Some(Key::Minus)),
        DebugView::Coverage => ("Show the ground white and the rest black.", Some(Key::Equals)),
        DebugView::Albedo => ("Show the colour of the ground without light.", None),
        DebugView::Plates => ("Show the plates of the structure. Darts point along their motion.", None),
        DebugView::Rain => ("Show the rain of the structure. Darts point along the wind.", None),
        DebugView::Rivers => ("Show the basins, rivers and lakes of the structure.", None),
        DebugView::Density => ("Show how many objects of the population selected in the Life tab stand where.", None),
    };
    Row::new(Command::Show(view), view.label(), tooltip, move |state, _| state.viewport.settings.debug_view = view)
        .within(Menu::View, 0)
        .keys(key.map(plain).into_iter().collect::<Vec<_>>())
        .chosen_when(move |state| state.viewport.settings.debug_view == view)
        .enabled_when(move |state| match view {
            DebugView::Density => state.shown_population().is_some(),
            _ => !view.needs_structure() || state.document.valid_planet().structure.is_some(),
        })
        .yielding_to_text()
}
