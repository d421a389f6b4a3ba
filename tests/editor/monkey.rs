//! Random commands, as somebody would send them who tries everything: all can be undone and redone.

use super::*;
use tellus::editor::command::{BookmarkAction, ClipAction, PanelAction, VariationAction, Wanted};
use tellus::planet::param::ParamPath;
use tellus::planet::{random, snippet, validate};

/// Parts that a planet may have, for edits of one part.
const PARTS: [&str; 8] = ["star", "layers", "climate", "biomes", "structure", "water", "atmosphere", "clouds"];

/// Random numbers: an xorshift generator (Marsaglia 2003).
pub(super) struct Dice(pub(super) u64);

impl Dice {
    pub(super) fn below(&mut self, count: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % count.max(1) as u64) as usize
    }
}

/// One action, whether it makes sense now or not.
pub(super) fn action(dice: &mut Dice, planet: &Planet, steps: usize) -> Action {
    let layer = dice.below(planet.layers.len() + 1);
    let part = PARTS[dice.below(PARTS.len())];
    match dice.below(40) {
        0..12 => {
            let varied = random::vary_some(planet, dice.0, 0.4, &|path| path.part() == part);
            Action::Clip(ClipAction::Paste(Wanted::Part(part), snippet::of_part(&varied, part).unwrap_or_default()))
        }
        12..14 => Action::Command(Command::Undo),
        14..19 => Action::Command(Command::Redo),
        19 => Action::Jump((steps + 3).saturating_sub(dice.below(6))),
        20..23 => Action::Variation(VariationAction::Take(dice.below(10))),
        23 => Action::Variation(VariationAction::Again),
        24 => Action::Variation(VariationAction::UnlockAll),
        25 => Action::Command(Command::Variations),
        26 => Action::ToggleLock(ParamPath::default().join(part)),
        27 => {
            let mut paths = Vec::new();
            planet.each_value(&mut |path, _, _| paths.push(path.clone()));
            Action::ToggleLock(paths.swap_remove(dice.below(paths.len())))
        }
        28 => Action::Clip(ClipAction::CutLayers(vec![layer])),
        29..32 => {
            let text = snippet::of_layers(planet.layers.get(layer..).unwrap_or_default().get(..1).unwrap_or_default());
            Action::Clip(ClipAction::Paste(Wanted::Layers { after: Some(layer) }, text))
        }
        32 => Action::Command(Command::AddBookmark),
        33 => Action::Bookmark(BookmarkAction::Delete(dice.below(3))),
        34 => Action::Command(Command::Compare),
        35 => Action::Command(Command::SwapCompared),
        36 => {
            Action::Command([Command::History, Command::Finder, Command::Controls, Command::GoToPlace][dice.below(4)])
        }
        37 => Action::Panel(PanelAction::Reveal { path: ParamPath::default().join(part).join("seed"), name: "seed" }),
        38 => Action::Clip(ClipAction::Paste(Wanted::Part(part), "(version: 3, water: 7)".to_owned())),
        _ => Action::Command(if dice.below(8) == 0 { Command::RandomPlanet } else { Command::Dive }),
    }
}

fn try_everything(seed: u64, count: usize) {
    let mut harness = editor(vec![]);
    let (mut dice, mut changes) = (Dice(seed), 0);
    for number in 0..count {
        let now = planet(&harness);
        let action = action(&mut dice, &now, undo_len(&harness));
        let told = format!("{number}: {action:?}");
        harness.state_mut().push(action);
        harness.step();
        // What is refused is told, and in the way of nothing else.
        while harness.query_by_label("Dismiss").is_some() {
            harness.state_mut().push(Action::DismissMessage);
            harness.step();
        }
        changes += usize::from(planet(&harness) != now);
        let problems = validate::problems(&planet(&harness));
        assert!(problems.is_empty(), "{told}: {problems:?}");
    }
    let last = planet(&harness);
    while harness.state().document().history().redo_label().is_some() {
        harness.state_mut().push(Action::Command(Command::Redo));
        harness.step();
    }
    let mut back = vec![planet(&harness)];
    while undo_len(&harness) > 0 {
        harness.state_mut().push(Action::Command(Command::Undo));
        harness.step();
        back.push(planet(&harness));
    }
    assert!(back.contains(&last));
    assert!(changes > count / 3 && back.len() > 30, "{changes} changes, {} steps", back.len());
    let mut forth = vec![planet(&harness)];
    for _ in 1..back.len() {
        harness.state_mut().push(Action::Command(Command::Redo));
        harness.step();
        forth.push(planet(&harness));
    }
    back.reverse();
    assert_eq!(back.len(), forth.len());
    for (step, (back, forth)) in back.iter().zip(&forth).enumerate() {
        assert_eq!(back, forth, "step {step}");
    }
}

#[test]
fn whatever_is_sent_can_be_undone() {
    try_everything(0x1234_5678, 300);
}

#[test]
#[ignore = "long"]
fn five_thousand_commands_can_be_undone() {
    try_everything(0x9e37_79b9, 5000);
    println!("counted: 5000 commands undone and redone");
}
