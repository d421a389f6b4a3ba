//! Queries of points that are spread over a planet with rivers.

use std::sync::Arc;
use tellus::glam::DVec3;
use tellus::planet::{Planet, Structure, Water};
use tellus::sphere::spread;
use tellus::terrain::{Detail, Terrain, Wanted};

fn terrain() -> Terrain {
    let structure = Some(Structure { grids: 1, ..Structure::default() });
    Terrain::try_new(Arc::new(Planet { structure, water: Some(Water::default()), ..Planet::default() })).unwrap()
}

/// What was kept of a place changes no answer: neither whole blocks, nor the little that is left of them.
#[test]
fn points_far_apart_keep_their_answers_while_others_are_asked() {
    let terrain = terrain();
    let dirs: Vec<DVec3> = spread(700).collect();
    let samples = terrain.samples(&dirs, Wanted::ALL);
    Terrain::keep_rivers(16 << 20);
    for round in 0..2 {
        assert_eq!(terrain.samples(&dirs, Wanted::ALL), samples, "round {round}");
    }
    // A few metres on, in the same cell and beside it.
    let moved: Vec<DVec3> = dirs.iter().map(|dir| (*dir + dir.any_orthonormal_vector() * 2e-5).normalize()).collect();
    let there = terrain.heights_m(&moved);
    Terrain::keep_rivers(1 << 30);
    assert_eq!(self::terrain().heights_m(&moved), there);
}

#[test]
fn less_detail_leaves_out_what_the_spacing_does_not_show() {
    let terrain = terrain();
    let dirs: Vec<DVec3> = spread(300).collect();
    let all = terrain.heights_m(&dirs);
    assert_eq!(terrain.heights_detailed_m(&dirs, Detail::All), all);
    assert_eq!(terrain.heights_detailed_m(&dirs, Detail::SpacingM(1.0)), all);
    assert_eq!(terrain.heights_detailed_m(&dirs, Detail::SpacingM(f64::NAN)), all);
    let coarse = terrain.heights_detailed_m(&dirs, Detail::SpacingM(100_000.0));
    let apart = |a: &f64, b: &f64| (a - b).abs();
    let most_m = all.iter().zip(&coarse).map(|(a, b)| apart(a, b)).fold(0.0, f64::max);
    assert!((1.0..2000.0).contains(&most_m), "{most_m}");
    let samples = terrain.samples_detailed(&dirs, Wanted::HEIGHT, Detail::SpacingM(100_000.0));
    assert!(samples.iter().zip(&coarse).all(|(sample, height_m)| sample.height_m == *height_m));
}
