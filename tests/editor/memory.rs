//! Random clicks, drags, keys and commands: none ends the editor, and its memory levels off.

use super::heap::bytes_in_use;
use super::monkey::{Dice, action};
use super::*;
use std::process::Command as Program;
use std::time::Duration;
use tellus::editor::command::Action;

const EVENTS: usize = 20_000;
/// Events after which everything that fills up once is full.
const WARM_UP: usize = 6000;
/// Events from one look at the heap to the next.
const BLOCK: usize = 2000;
/// The heap of an editor at rest changes by less.
const QUIET_BYTES: usize = 2 << 20;
/// Budget of tiles: the events of the warm-up fill it.
const TILES_MIB: u32 = 64;
/// Greatest heap over that at the end of the warm-up.
const MOST_GROWTH: f64 = 1.05;
/// Tells the program of this test that it is the one whose heap is measured.
const MEASURED: &str = "TELLUS_TEST_MEASURED";
const SIZE: [f32; 2] = [1024.0, 640.0];
const KEYS: [egui::Key; 22] = [
    egui::Key::Escape,
    egui::Key::Escape,
    egui::Key::Tab,
    egui::Key::Enter,
    egui::Key::Space,
    egui::Key::ArrowUp,
    egui::Key::ArrowDown,
    egui::Key::ArrowLeft,
    egui::Key::ArrowRight,
    egui::Key::PageDown,
    egui::Key::Delete,
    egui::Key::Num1,
    egui::Key::Num2,
    egui::Key::A,
    egui::Key::B,
    egui::Key::E,
    egui::Key::F,
    egui::Key::H,
    egui::Key::J,
    egui::Key::K,
    egui::Key::R,
    egui::Key::W,
];

fn place(dice: &mut Dice) -> egui::Pos2 {
    egui::pos2(dice.below(SIZE[0] as usize) as f32, dice.below(SIZE[1] as usize) as f32)
}

/// One random event, as the window gets them.
fn event(harness: &mut Editor, dice: &mut Dice) {
    match dice.below(10) {
        kind @ 0..6 => {
            let (from, to) = (place(dice), place(dice));
            let to = if kind < 4 { from } else { to };
            let button = if dice.below(8) == 0 { egui::PointerButton::Secondary } else { egui::PointerButton::Primary };
            let modifiers = egui::Modifiers::NONE;
            harness.event(egui::Event::PointerMoved(from));
            harness.event(egui::Event::PointerButton { pos: from, button, pressed: true, modifiers });
            harness.step();
            harness.event(egui::Event::PointerMoved(to));
            harness.event(egui::Event::PointerButton { pos: to, button, pressed: false, modifiers });
        }
        6 => {
            let lines = dice.below(9) as f32 - 4.0;
            harness.event(egui::Event::PointerMoved(place(dice)));
            harness.event(egui::Event::MouseWheel {
                unit: egui::MouseWheelUnit::Line,
                delta: egui::vec2(0.0, lines),
                phase: egui::TouchPhase::Move,
                source: egui::MouseWheelSource::Wheel,
                modifiers: egui::Modifiers::NONE,
            });
        }
        7 | 8 => {
            let key = KEYS[dice.below(KEYS.len())];
            harness.key_press(key);
        }
        _ => {
            let now = planet(harness);
            let action = action(dice, &now, undo_len(harness));
            harness.state_mut().push(action);
        }
    }
    harness.step();
}

/// A new document with its ground built, nothing open over it, and the heap at rest.
fn begin_again(harness: &mut Editor) {
    for _ in 0..12 {
        harness.key_press(egui::Key::Escape);
        harness.state_mut().push(Action::DismissMessage);
        harness.step();
    }
    begin_new(harness);
    if let Some(discard) = harness.query_by_label("Discard changes") {
        discard.click_accesskit();
    }
    // Other threads draw thumbnails and solve world maps; their heap goes when they are done.
    let (mut before, mut quiet) = (0, 0);
    for _ in 0..6000 {
        harness.step();
        std::thread::sleep(Duration::from_millis(10));
        let now = bytes_in_use();
        quiet = if now.abs_diff(before) < QUIET_BYTES { quiet + 1 } else { 0 };
        if quiet == 0 {
            before = now;
        }
        if quiet == 200 {
            return;
        }
    }
    panic!("the heap does not come to rest: {}", circumstances(harness));
}

/// What the heap depends on.
fn circumstances(harness: &Editor) -> String {
    let app = harness.state();
    let (settings, memory) = (app.viewport().settings, app.viewport().memory());
    let (tiles_mib, system) = (memory.used_bytes >> 20, app.system().is_some());
    format!(
        "{tiles_mib} MiB of tiles, {:?} quality, {:?}, playing {}, system {system}",
        settings.quality, settings.debug_view, settings.playing
    )
}

/// Sends events. After the warm-up, `looked` is told how many there were, the heap, and what it depends on.
fn send_events(count: usize, seed: u64, mut looked: impl FnMut(usize, usize, String)) {
    let mut harness = editor(vec![]);
    harness.state_mut().viewport_mut().settings.cache_mib = TILES_MIB;
    let mut dice = Dice(seed);
    for number in 1..=count {
        event(&mut harness, &mut dice);
        if number >= WARM_UP && number % BLOCK == 0 {
            begin_again(&mut harness);
            looked(number, bytes_in_use(), circumstances(&harness));
        }
    }
}

#[test]
fn random_events_do_not_end_the_editor() {
    send_events(500, 0x51ed_270b, |_, _, _| {});
}

#[test]
#[ignore = "long"]
fn memory_levels_off_over_twenty_thousand_random_events() {
    if std::env::var_os(MEASURED).is_none() {
        // In a program of its own, whose heap no other test uses.
        let mut alone = Program::new(std::env::current_exe().unwrap());
        let name = "memory::memory_levels_off_over_twenty_thousand_random_events";
        let ended = alone.args(["--exact", name, "--ignored", "--nocapture"]).env(MEASURED, "1").status().unwrap();
        assert!(ended.success());
        return;
    }
    let mut heaps = Vec::new();
    send_events(EVENTS, 0x2545_f491, |number, bytes, circumstances| {
        println!("after {number} events: {} KiB of heap; {circumstances}", bytes >> 10);
        heaps.push(bytes);
    });
    let growth = heaps.iter().fold(0, |most, bytes| most.max(*bytes)) as f64 / heaps[0] as f64;
    println!("counted: {EVENTS} random events of the editor; its greatest heap {growth:.3} of that after {WARM_UP}");
    assert!(growth <= MOST_GROWTH, "{heaps:?}");
}
