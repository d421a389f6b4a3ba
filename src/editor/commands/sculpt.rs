//! Commands that take a tool in hand to sculpt the planet, and change its size.

use super::{Menu, Row, plain};
use crate::editor::command::{Command, PanelAction, SculptAction};
use crate::planet::Tool;
use eframe::egui::Key;

/// Names of the commands that take a tool in hand, in the order of [`Tool::all`].
const TOOLS: [(&str, &str); Tool::NAMES.len()] = [
    ("Sculpt: raise or lower", "Raise the ground with drags; with Shift lower it."),
    ("Sculpt: flatten", "Bring the ground to one height."),
    ("Sculpt: roughen", "Add hills and hollows."),
    ("Sculpt: terrace", "Cut level steps."),
    ("Sculpt: crater", "Place craters and impact basins."),
    ("Sculpt: volcano", "Place volcanoes: cones, shields, calderas."),
    ("Sculpt: mesa", "Place table mountains."),
    ("Sculpt: island", "Let land rise out of the sea."),
    ("Sculpt: picture", "Place the ground of a height picture."),
    ("Sculpt: ridge", "Draw a crest, point after point."),
    ("Sculpt: canyon", "Draw a valley with steep walls, point after point."),
    ("Sculpt: road", "Draw a level bed, point after point."),
    ("Sculpt: smooth", "Smooth fine detail away with drags."),
    ("Sculpt: hydraulic erosion", "Carve gullies down the slopes with drags."),
    ("Sculpt: thermal erosion", "Crumble what stands out with drags."),
    ("Sculpt: wall", "Draw a rampart or dam, point after point."),
    ("Sculpt: fault", "Draw a step in the ground, point after point."),
    ("Sculpt: coast", "Draw a coast, point after point: land on the left side."),
    ("Sculpt: moisture", "Paint the climate wetter with drags; with Shift drier."),
    ("Sculpt: temperature", "Paint the climate warmer with drags; with Shift colder."),
    ("Sculpt: biome", "Paint a biome with drags."),
    ("Sculpt: clouds", "Paint clouds with drags; with Shift clear the sky."),
    ("Sculpt: mask of layers", "Paint where layers act with drags; with Shift erase."),
    ("Sculpt: uplift", "Paint how far rock rises while the structure's rivers carve it."),
    ("Sculpt: rock hardness", "Paint how hard the rock is that the structure's rivers carve."),
    ("Sculpt: rain", "Paint rain of the structure's weather: rivers and biomes answer."),
    ("Sculpt: river", "Draw the course of a river, from its spring to its mouth."),
    ("Sculpt: life", "Plant what stands on the ground with drags; with Shift clear it."),
    ("Sculpt: object", "Place single trees, stones and other objects."),
];

pub(super) fn rows() -> Vec<Row> {
    let asks = |command, label, tooltip, action| {
        Row::new(command, label, tooltip, move |state, _| state.ask_panel(PanelAction::Sculpt(action)))
    };
    let tools = TOOLS.iter().enumerate().map(|(tool, (label, tooltip))| {
        asks(Command::TakeTool(tool), label, tooltip, SculptAction::Take(tool)).within(Menu::Sculpt, 0)
    });
    let mut rows: Vec<Row> = tools.collect();
    for (command, label, tooltip, key, action) in [
        (
            Command::PutDownTool,
            "Take or put down tool",
            "Sculpt with drags on the planet, or move the camera with them.",
            Key::B,
            SculptAction::PutDown,
        ),
        (
            Command::Measure,
            "Measure",
            "Measure lengths, areas and profiles with drags and clicks on the planet.",
            Key::J,
            SculptAction::Measure,
        ),
        (Command::LargerTool, "Larger brush", "Make the brush larger.", Key::CloseBracket, SculptAction::Larger),
        (Command::SmallerTool, "Smaller brush", "Make the brush smaller.", Key::OpenBracket, SculptAction::Smaller),
    ] {
        let row = asks(command, label, tooltip, action).within(Menu::Sculpt, 1);
        rows.push(row.keys([plain(key)]).yielding_to_text());
    }
    rows
}
