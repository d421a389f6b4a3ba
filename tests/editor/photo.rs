//! Photographs and films, and what a photographer sets.

use super::app::{open_with_picture, until};
use super::*;

#[test]
fn what_a_photographer_sets_changes_the_picture() {
    let mut harness = drawn_editor();
    wait_for_picture(&mut harness);
    click(&mut harness, "View");
    for (name, value) in [("White balance", 4000.0), ("Vignette", 0.5), ("Bloom", 0.1)] {
        slide(&mut harness, name, value);
    }
    let post = harness.state().viewport().settings.post;
    assert!((post.white_k - 4000.0).abs() < 150.0, "{post:?}");
    assert!((post.vignette - 0.5).abs() < 0.05 && (post.bloom - 0.1).abs() < 0.01, "{post:?}");
}

/// A picture is taken while the editor goes on, and a file that exists is not replaced without a question.
#[test]
fn a_picture_is_saved_from_the_window() {
    let folder = tempfile::tempdir().unwrap();
    let [path, film] = ["mine.png", "way.png"].map(|name| folder.path().join(name));
    let mut harness = open_with_picture([900.0, 600.0], vec![Some(path.clone()), Some(film.clone())]);
    wait_for_picture(&mut harness);
    press(&mut harness, egui::Modifiers::NONE, egui::Key::F10);
    assert!(harness.query_by_label("Save picture…").is_some());
    harness.state_mut().photo_mut().size_px = [96, 54];
    harness.state_mut().photo_mut().quality = tellus::lod::Quality::Low;
    harness.run_steps(2);
    click(&mut harness, "Save picture…");
    until(&mut harness, "the picture is there", |_| path.exists());
    until(&mut harness, "the picture is told", |harness| harness.query_all_by_label_contains("Saved ").count() > 0);
    let picture = image::open(&path).unwrap();
    assert_eq!((picture.width(), picture.height()), (96, 54));

    // Without a bookmark there is nothing to fly over.
    click(&mut harness, "Save film…");
    assert!(!film.exists() && std::fs::read_dir(folder.path()).unwrap().count() == 1);
    send(&mut harness, Command::AddBookmark);
    (harness.state_mut().photo_mut().film_secs, harness.state_mut().photo_mut().fps) = (0.1, 20);
    harness.run_steps(2);
    std::fs::write(folder.path().join("way-0001.png"), "mine").unwrap();
    click(&mut harness, "Save film…");
    until(&mut harness, "it asks", |harness| harness.query_by_label("Replace").is_some());
    click(&mut harness, "Replace");
    let frames = [1, 2].map(|number| folder.path().join(format!("way-000{number}.png")));
    until(&mut harness, "both frames are there", |_| frames[1].exists());
    assert!(image::open(&frames[0]).is_ok());

    press(&mut harness, egui::Modifiers::NONE, egui::Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label("Save picture…").is_none());
}
