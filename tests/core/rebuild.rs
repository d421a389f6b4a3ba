//! Rebuilds: which stages each parameter runs, which results are reused, and that every sequence of events ends with
//! what a build from nothing gives.

use crate::support::edits::{every_edit, full_planet, is_idle};
use proptest::prelude::*;
use std::sync::Arc;
use std::sync::mpsc::sync_channel;
use std::time::Duration;
use tellus::lod::{Camera, Quality, Vertex, View};
use tellus::planet::param::{Stage, Stages};
use tellus::planet::{Fbm, Layer, Mask, Planet, Shape};
use tellus::sphere::{LatLon, NodeId};
use tellus::terrain::Revision;
use tellus::tiles::{BuildStats, Builder, BuilderOptions, Surface, build_now};

/// A view of a planet of 1500 km radius; `radii` is the distance from its centre.
fn view(lon_deg: f64, radii: f64) -> View {
    let place = LatLon::from_degrees(20.0, lon_deg);
    let camera = Camera::over(place, 1.5e6 * radii, 0.3, -1.4, Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px: [320, 200], quality: Quality::Low }
}

/// The surface once the builder has finished the request.
fn settled(builder: &Builder) -> Arc<Surface> {
    while !builder.has_all_tiles() {
        std::thread::sleep(Duration::from_millis(1));
    }
    builder.surface().unwrap()
}

fn revision(planet: &Arc<Planet>) -> Revision {
    Revision::try_new(planet.clone()).unwrap()
}

fn ask(builder: &Builder, planet: &Planet, view: &View) -> BuildStats {
    builder.request(&Arc::new(planet.clone()), view).unwrap();
    settled(builder).stats
}

fn bits(surface: &Surface) -> Vec<(NodeId, u8, Vec<Vertex>)> {
    surface.leaves.iter().map(|leaf| (leaf.tile.id, leaf.coarser_edges, leaf.tile.vertices.clone())).collect()
}

#[test]
fn one_builder_serves_several_views_which_share_their_tiles() {
    let planet = Arc::new(full_planet());
    let views = [view(30.0, 1.3), view(32.0, 1.3), view(110.0, 3.0)];
    let alone: Vec<_> = views.iter().map(|view| build_now(&planet, view).unwrap()).collect();
    let builder = Builder::new(|| {});
    // One after the other: two views that meet a tile at the same moment may both build it.
    builder.request_views(&revision(&planet), &views[..1]);
    settled(&builder);
    builder.request_views(&revision(&planet), &views);
    settled(&builder);
    let built = builder.surface_of(1).unwrap().stats.tiles_built;
    for (i, alone) in alone.iter().enumerate() {
        assert!(bits(&builder.surface_of(i).unwrap()) == bits(alone), "view {i}");
    }
    let built_alone = alone[1].stats.tiles_built;
    assert!(built < built_alone / 2, "{built} of {built_alone} tiles");
    assert!(builder.surface_of(3).is_none());
    // An edit reaches every view, and a view that is gone has no surface.
    let mut edited = Planet::clone(&planet);
    edited.layers[0].amplitude_m *= 1.25;
    let edited = Arc::new(edited);
    builder.request_views(&revision(&edited), &views[..2]);
    settled(&builder);
    for (i, view) in views[..2].iter().enumerate() {
        assert!(bits(&builder.surface_of(i).unwrap()) == bits(&build_now(&edited, view).unwrap()), "view {i}");
    }
    assert!(builder.surface_of(2).is_none());
}

#[test]
fn a_view_that_moves_all_the_time_leaves_time_to_the_others() {
    let planet = Arc::new(full_planet());
    let other = view(-60.0, 3.0);
    let builder = Builder::new(|| {});
    let revision = revision(&planet);
    // A new request every few milliseconds: slices of the first view alone could take all the time.
    for step in 0..2000 {
        builder.request_views(&revision, &[view(30.0 + 0.01 * f64::from(step), 1.3), other]);
        std::thread::sleep(Duration::from_millis(2));
        if builder.surface_of(1).is_some() && builder.surface_of(0).is_some() {
            return;
        }
    }
    panic!("a view got no surface");
}

#[test]
fn each_parameter_runs_the_stages_it_declares_and_no_others() {
    let planet = full_planet();
    // Few tiles: there are some hundred edits.
    let view = View { size_px: [144, 90], ..view(30.0, 3.0) };
    let builder = Builder::new(|| {});
    ask(&builder, &planet, &view);
    // The first planet is shown longer than any edit, so that its fields are the most worth keeping.
    std::thread::sleep(Duration::from_millis(1500));
    let edits = every_edit(&planet);
    planet.each_value(&mut |path, _, _| {
        let path = path.to_string();
        assert!(is_idle(&path) || edits.iter().any(|edit| edit.path == path), "{path} has an edit");
    });
    for edit in edits {
        let stats = ask(&builder, &edit.planet, &view);
        let mut declared = edit.declared.within(Stages::OF_TILES);
        // Another kind of mask needs noise only for slopes; a painted one needs none, nor a height map without picture.
        let is_kind = ["masks[0]", "masks[0].mask", ".shape"].iter().any(|end| edit.path.ends_with(end));
        if is_kind {
            declared = declared.within(stats.ran());
        }
        assert_eq!(stats.ran(), declared, "{}", edit.path);
        assert_eq!(stats.tiles_built > 0, !declared.is_empty(), "{}", edit.path);
        let noise = declared.contains(Stage::Field) || declared.contains(Stage::ClimateNoise);
        assert!(is_kind || noise == (stats.octave_samples > 0), "{}", edit.path);

        let undone = ask(&builder, &planet, &view);
        assert_eq!(undone.stage(Stage::Field).runs, 0, "{} undone finds its noise again", edit.path);
    }
}

#[test]
fn an_edit_of_one_layer_evaluates_that_layer_alone() {
    let planet = full_planet();
    let view = view(30.0, 3.0);
    let builder = Builder::new(|| {});
    ask(&builder, &planet, &view);
    for layer in 0..planet.layers.len() {
        let mut edited = planet.clone();
        edited.layers[layer].seed += 100;
        let stats = ask(&builder, &edited, &view);
        assert!(stats.stage(Stage::Field).runs > 0);
        assert_eq!(stats.stage(Stage::Field).runs, stats.stage(Stage::Height).runs);
        ask(&builder, &planet, &view);
    }
}

#[test]
fn layers_that_are_moved_removed_and_brought_back_evaluate_no_noise() {
    let planet = full_planet();
    let view = view(30.0, 3.0);
    let builder = Builder::new(|| {});
    ask(&builder, &planet, &view);

    let mut moved = planet.clone();
    moved.layers.rotate_left(1);
    let mut removed = planet.clone();
    removed.layers.pop();
    let mut doubled = planet.clone();
    doubled.layers.push(Layer { name: "Double".to_owned(), ..planet.layers[0].clone() });
    for edited in [&moved, &planet, &removed, &planet, &doubled, &planet] {
        let stats = ask(&builder, edited, &view);
        assert!(stats.tiles_built > 0);
        assert_eq!(stats.octave_samples, 0);
    }

    let mut renamed = planet.clone();
    renamed.layers[0].name = "Another".to_owned();
    if let Mask::Layer(mask) = &mut renamed.layers[1].masks[0] {
        mask.layer = "Another".to_owned();
    }
    assert_eq!(ask(&builder, &renamed, &view).tiles_built, 0, "a name that its masks follow is a name");

    let mut retyped = planet.clone();
    retyped.layers[0].shape = Shape::Fbm(Fbm { octaves: 2, ..Fbm::default() });
    let stats = ask(&builder, &retyped, &view);
    assert_eq!(stats.stage(Stage::Field).runs, stats.stage(Stage::Height).runs);
}

#[test]
fn after_a_drag_the_undo_finds_the_noise_from_before() {
    let planet = full_planet();
    let view = view(30.0, 3.0);
    let builder = Builder::new(|| {});
    ask(&builder, &planet, &view);
    // The first planet is shown for a while.
    std::thread::sleep(Duration::from_millis(1500));
    let mut memory = Vec::new();
    for step in 1..60 {
        let mut edited = planet.clone();
        edited.layers[0].seed += step;
        ask(&builder, &edited, &view);
        memory.push(builder.memory().used_bytes);
    }
    // The number of tiles varies a little with the mountains.
    let highest = |part: &[usize]| part.iter().copied().max().unwrap();
    assert!(
        highest(&memory[30..]) <= highest(&memory[..30]) * 11 / 10,
        "the longer a drag, the more memory: {memory:?}"
    );
    assert_eq!(ask(&builder, &planet, &view).octave_samples, 0);
}

#[test]
fn parents_and_children_are_kept_while_the_others_are_shown() {
    let planet = full_planet();
    let (far, near) = (view(30.0, 3.0), view(30.0, 1.2));
    let builder = Builder::new(|| {});
    assert!(ask(&builder, &planet, &far).tiles_built > 0);
    let deeper = ask(&builder, &planet, &near);
    let anew = build_now(&Arc::new(planet.clone()), &near).unwrap().stats;
    assert!(deeper.tiles_built > 0 && deeper.tiles_built < anew.tiles_built, "{deeper:?}");
    assert_eq!(ask(&builder, &planet, &far).tiles_built, 0);
    assert_eq!(ask(&builder, &planet, &near).tiles_built, 0);
}

#[test]
fn a_child_takes_the_climates_noise_from_its_parent() {
    let planet = full_planet();
    let surface = build_now(&Arc::new(Planet { layers: Vec::new(), ..planet.clone() }), &view(30.0, 1.5)).unwrap();
    let all = surface.stats.tiles_built * 33 * 33 * 2 * planet.climate.octaves as usize;
    let children = surface.stats.tiles_built - 6;
    let shared = children * 17 * 17 * 2 * planet.climate.octaves as usize;
    assert_eq!(surface.stats.octave_samples, all - shared);
}

#[test]
fn memory_keeps_to_its_budget_whatever_it_is() {
    let planet = full_planet();
    for budget in [0, 8 << 20] {
        let builder = Builder::with_options(BuilderOptions::default().budget_bytes(budget), || {});
        for step in 0..4 {
            let mut edited = planet.clone();
            edited.layers[0].seed = step / 2;
            let view = view(f64::from(step) * 60.0, 1.1);
            ask(&builder, &edited, &view);
            let memory = builder.memory();
            let needed =
                build_now(&Arc::new(edited.clone()), &view).unwrap().stats.tiles_built * 33 * 33 * size_of::<Vertex>();
            assert!(memory.used_bytes <= budget.max(needed), "{memory:?}, {needed} needed");
        }
    }
}

#[test]
fn every_surface_on_the_way_is_whole_and_of_one_planet() {
    let mut planet = full_planet();
    // More work than one slice: coarser surfaces come first.
    for layer in &mut planet.layers {
        if let Shape::Craters(craters) = &mut layer.shape {
            craters.octaves = 20;
        }
    }
    let view = view(30.0, 1.2);
    let builder = Builder::new(|| {});
    let mut seen: Vec<Arc<Surface>> = Vec::new();
    for step in 0..60 {
        // A slider is dragged for a while, then released.
        planet.layers[2].seed = step.min(20);
        builder.request(&Arc::new(planet.clone()), &view).unwrap();
        std::thread::sleep(Duration::from_millis(15));
        seen.extend(builder.surface().filter(|new| !seen.last().is_some_and(|old| Arc::ptr_eq(old, new))));
    }
    settled(&builder);
    seen.extend(builder.surface());
    assert!(seen.iter().any(|surface| !surface.complete), "nothing was ever cut short");
    for surface in &seen {
        let area: f64 = surface.leaves.iter().map(|leaf| 0.25_f64.powi(i32::from(leaf.tile.id.level))).sum();
        assert_eq!(area, 6.0);
        for leaf in &surface.leaves {
            let height_m = surface.terrain.height_m(leaf.tile.id.direction(0.5, 0.5));
            assert_eq!(leaf.tile.vertices[16 * 33 + 16].height_m, height_m as f32);
        }
    }
}

#[test]
fn world_maps_are_solved_for_what_they_read_and_never_before_the_first_surface() {
    let planet = full_planet();
    let view = view(30.0, 3.0);
    // After each surface the builder waits for the test to look at it.
    let (bell, surfaces) = sync_channel(0);
    let builder = Builder::new(move || {
        let _ = bell.send(()).and_then(|()| bell.send(()));
    });
    let all_surfaces = |planet: &Planet| {
        builder.request(&Arc::new(planet.clone()), &view).unwrap();
        let mut seen: Vec<Arc<Surface>> = Vec::new();
        // The last surface may be there before the first look; a bell may still be that of the planet before.
        loop {
            surfaces.recv().unwrap();
            seen.extend(builder.surface());
            seen.retain(|surface| surface.terrain.planet().as_ref() == planet);
            surfaces.recv().unwrap();
            if builder.has_all_tiles() && !seen.is_empty() {
                break;
            }
        }
        seen
    };
    let runs = |seen: &[Arc<Surface>]| seen.iter().map(|surface| surface.stats.maps.runs).collect::<Vec<_>>();
    let first = all_surfaces(&planet);
    assert_eq!((runs(&first)[0], runs(&first).last()), (0, Some(&1)), "the first surface does not wait for the map");
    let mut edited = planet.clone();
    edited.climate.sea_moisture = 0.4;
    edited.clouds = None;
    assert_eq!(runs(&all_surfaces(&edited)).last(), Some(&0), "the coast stays where it is");
    edited.layers[0].amplitude_m += 100.0;
    let moved = all_surfaces(&edited);
    assert_eq!((runs(&moved)[0], moved[0].complete), (0, false), "the old map serves until the new one is whole");
    let last = &moved[moved.len() - 1];
    assert_eq!((last.stats.maps.runs, last.complete), (1, true));
    assert!(bits(last) == bits(&build_now(&Arc::new(edited.clone()), &view).unwrap()));
    edited.climate.sea_moisture = 0.0;
    edited.layers[0].amplitude_m += 100.0;
    assert_eq!(runs(&all_surfaces(&edited)).last(), Some(&0), "nothing reads the coast");
    drop(surfaces);
}

/// An event for a builder.
#[derive(Clone, Debug)]
enum Event {
    Edit(usize),
    Undo,
    Redo,
    Look(usize),
    Wait,
    WaitALittle(u64),
}

fn event() -> impl Strategy<Value = Event> {
    prop_oneof![
        6 => any::<prop::sample::Index>().prop_map(|i| Event::Edit(i.index(10_000))),
        2 => Just(Event::Undo),
        1 => Just(Event::Redo),
        2 => (0..5_usize).prop_map(Event::Look),
        2 => Just(Event::Wait),
        2 => (0..40_u64).prop_map(Event::WaitALittle),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn any_sequence_of_events_ends_in_what_a_build_from_nothing_gives(
        events in prop::collection::vec(event(), 1..24),
        budget in prop_oneof![Just(0), Just(3_usize << 20), Just(256_usize << 20)],
    ) {
        let views = [view(30.0, 3.0), view(30.0, 1.2), view(30.0, 1.02), view(110.0, 1.3), view(-60.0, 8.0)];
        let builder = Builder::with_options(BuilderOptions::default().budget_bytes(budget), || {});
        let (mut past, mut future, mut planet, mut view) = (Vec::new(), Vec::new(), full_planet(), views[0]);
        builder.request(&Arc::new(planet.clone()), &view).unwrap();
        for event in events {
            match event {
                Event::Edit(which) => {
                    let mut edits = every_edit(&planet);
                    let edit = edits.swap_remove(which % edits.len());
                    // Another radius would need another view; and edits may add up to an invalid planet.
                    if edit.path != "radius_km" && edit.planet.check().is_ok() {
                        past.push(std::mem::replace(&mut planet, edit.planet));
                        future.clear();
                    }
                }
                Event::Undo => if let Some(before) = past.pop() {
                    future.push(std::mem::replace(&mut planet, before));
                },
                Event::Redo => if let Some(after) = future.pop() {
                    past.push(std::mem::replace(&mut planet, after));
                },
                Event::Look(which) => view = views[which],
                Event::Wait => { settled(&builder); }
                Event::WaitALittle(millis) => std::thread::sleep(Duration::from_millis(millis)),
            }
            builder.request(&Arc::new(planet.clone()), &view).unwrap();
        }
        let planet = Arc::new(planet);
        builder.request(&planet, &view).unwrap();
        prop_assert!(bits(&settled(&builder)) == bits(&build_now(&planet, &view).unwrap()));
    }
}
