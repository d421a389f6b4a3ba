//! Masks of layers that are painted by hand: where their layers act, and what a stroke rebuilds.

use super::sculpt::{at, beside, edit, planet, settled, terrain, view};
use crate::support::dice::Dice;
use glam::DVec3;
use std::sync::Arc;
use tellus::planet::edits::{Flatten, GroundEdit, MaskPaint, Mesa, PaintMode, Raise, Smooth, TemperaturePaint, Tool};
use tellus::planet::param::{Stage, Stages};
use tellus::planet::{Blend, Fbm, Layer, Mask, PaintedMask, Planet, Shape};
use tellus::simd::Simd;
use tellus::terrain::{Revision, Terrain};
use tellus::tiles::{Builder, build_now};

fn paint(mask: &str, amount: f64) -> Tool {
    Tool::Mask(MaskPaint { mask: mask.to_owned(), amount })
}

/// Hills, and over them bumps with these masks.
fn bumpy(masks: Vec<Mask>, edits: Vec<GroundEdit>) -> Planet {
    let shape = Shape::Fbm(Fbm { wavelength_km: 20.0, octaves: 6, ..Fbm::default() });
    let bumps = Layer { name: "Bumps".to_owned(), amplitude_m: 700.0, bias: 1.5, shape, masks, ..Layer::default() };
    let mut planet = planet(900.0, edits);
    planet.layers.push(bumps);
    planet
}

fn painted(mask: &str, invert: bool) -> Mask {
    Mask::Painted(PaintedMask { mask: mask.to_owned(), invert, ..PaintedMask::default() })
}

fn smooth(u: f64) -> f64 {
    u * u * (3.0 - 2.0 * u)
}

#[test]
fn a_layer_acts_as_far_as_its_mask_is_painted() {
    let middle = at(20.0, 30.0);
    let stroke = |mask, amount| edit(paint(mask, amount), 40.0, &[middle]);
    let of = |masks, edits| terrain(&bumpy(masks, edits));
    let (without, all) = (of(vec![painted("Dry", false)], vec![]), of(vec![], vec![]));
    let strokes = vec![stroke("Dry", 0.75), stroke("Wet", 1.0), stroke("Dry", 0.5), stroke("Dry", -0.25)];
    let (with, inverted) =
        (of(vec![painted("Dry", false)], strokes.clone()), of(vec![painted("Dry", true)], strokes.clone()));
    let mut partly = 0;
    for i in 0..60 {
        let share = f64::from(i) / 50.0;
        let dir = beside(&middle, f64::from(i) * 37.0, 40.0 * share);
        // The softness is 0.8: the weight of a stroke falls from 0.2 to 1.
        let u = ((share - 0.2) / 0.8).clamp(0.0, 1.0);
        let weight = 1.0 - u * u * u * (u * (u * 6.0 - 15.0) + 10.0);
        let mut value = 0.75 * weight;
        value += (1.0 - value) * 0.5 * weight;
        value -= value * 0.25 * weight;
        let (bare_m, full_m) = (without.height_m(dir), all.height_m(dir));
        let wanted_m = bare_m + (full_m - bare_m) * smooth(value);
        assert!((with.height_m(dir) - wanted_m).abs() < 1e-5, "{share}: {} {wanted_m}", with.height_m(dir));
        let wanted_m = bare_m + (full_m - bare_m) * (1.0 - smooth(value));
        assert!((inverted.height_m(dir) - wanted_m).abs() < 1e-5, "{share}, inverted");
        partly += usize::from(value > 0.01 && value < 0.9 && (full_m - bare_m).abs() > 100.0);
    }
    assert!(partly > 15, "{partly}");
    // A stroke that is hidden, and an edit of a layer's mask in the file.
    let off = strokes.iter().cloned().map(|stroke| GroundEdit { enabled: false, ..stroke }).collect();
    assert_eq!(of(vec![painted("Dry", false)], off).height_m(middle.direction()), without.height_m(middle.direction()));
    let planet = bumpy(vec![painted("Dry", false)], strokes);
    assert_eq!(Planet::from_text("p.ron", &planet.to_text()).unwrap(), planet);
}

#[test]
fn slopes_follow_the_painted_mask_and_bounds_hold_its_layer() {
    let middle = at(-35.2, 44.0);
    let mut plain = bumpy(vec![painted("Dry", false)], vec![]);
    plain.layers.remove(0);
    // Level ground of the layer: all slopes are those of the mask.
    plain.layers[0] = Layer { amplitude_m: 0.0, ..plain.layers[0].clone() };
    plain.layers.insert(0, Layer { bias: 2.0, blend: Blend::Add, ..level() });
    plain.layers[1] = Layer { bias: -2.0, ..masked_level() };
    for raggedness in [0.0, 0.7] {
        let points = [middle, at(-35.0, 45.5)];
        let stroke = GroundEdit { raggedness, ..edit(paint("Dry", 0.9), 40.0, &points) };
        let painted = Planet { edits: [stroke].into_iter().collect(), ..plain.clone() };
        let terrain = terrain(&painted);
        let mut dice = Dice(11);
        let mut steep = 0;
        for _ in 0..300 {
            let dir = beside(&middle, dice.roll() * 360.0, dice.roll() * 50.0);
            let sample = terrain.sample(dir);
            let (east, north) = tellus::sphere::geo::east_north(dir);
            let slope = |axis: DVec3| {
                let step = 2e-6;
                let height_m = |by: f64| terrain.height_m((dir + axis * by).normalize());
                (height_m(step) - height_m(-step)) / (2.0 * step) / (1e6 + sample.height_m)
            };
            let wanted = (dir - east * slope(east) - north * slope(north)).normalize();
            assert!(wanted.distance(sample.normal_planet) < 2e-3, "{wanted} {}", sample.normal_planet);
            steep += usize::from(wanted.dot(dir) < 0.9995);
            let near = beside(&middle, dice.roll() * 360.0, dice.roll() * 80.0);
            let (lo, hi) = terrain.height_bounds_near_m(near, 0.005);
            let height_m = terrain.height_m((near + east * 0.003).normalize());
            assert!(lo <= height_m && height_m <= hi, "{lo} {height_m} {hi}");
        }
        assert!(steep > 20, "{steep}");
        let (lo, hi) = terrain.height_bounds_near_m(-middle.direction(), 0.01);
        assert!(hi - lo < 1.0, "no stroke is near: {lo} to {hi}");
    }
}

/// A layer without noise.
fn level() -> Layer {
    let shape = Shape::Fbm(Fbm { wavelength_km: 300.0, octaves: 1, ..Fbm::default() });
    Layer {
        name: "Level".to_owned(),
        amplitude_m: 1000.0,
        curve: [[-1.0, 0.0], [1.0, 0.0]].into_iter().collect(),
        shape,
        ..Layer::default()
    }
}

fn masked_level() -> Layer {
    Layer { name: "Cut".to_owned(), masks: vec![painted("Dry", false)], ..level() }
}

#[test]
fn a_stroke_rebuilds_the_tiles_that_it_touches_and_those_that_read_its_ground() {
    let spot = at(12.0, -70.0);
    let smoothed = GroundEdit { softness: 0.3, ..edit(Tool::Smooth(Smooth::default()), 4.0, &[at(12.0, -69.8)]) };
    let plain = bumpy(vec![painted("Dry", false)], vec![smoothed]);
    let view = view(12.0, -70.0, 4e4);
    let builder = Builder::new(|| {});
    settled(&builder, &plain, &view);
    let mut planet = plain.clone();
    for (radius_km, lon_deg) in [(2.0, -70.0), (3.0, -69.72), (1.0, -70.05)] {
        planet.edits.push(edit(paint("Dry", 1.0), radius_km, &[at(spot.latitude_deg, lon_deg)]));
        let surface = settled(&builder, &planet, &view);
        assert!(surface.stats.tiles_built > 0 && surface.stats.tiles_built * 2 < surface.leaves.len());
        let fresh = build_now(&Arc::new(planet.clone()), &view).unwrap();
        let vertices = |surface: &tellus::tiles::Surface| -> Vec<_> {
            surface.leaves.iter().map(|leaf| (leaf.tile.id, leaf.tile.vertices.clone())).collect()
        };
        assert!(vertices(&surface) == vertices(&fresh), "{lon_deg}");
    }
    // Every instruction set, and a mask that nothing paints.
    let dirs: Vec<DVec3> = (0..400).map(|i| beside(&spot, f64::from(i) * 7.0, f64::from(i) * 0.02)).collect();
    let heights = |simd: Simd| Terrain::try_new(Arc::new(planet.clone())).unwrap().with_simd(simd).heights_m(&dirs);
    assert_eq!(heights(Simd::Baseline), heights(Simd::detect()));
    let before = Revision::try_new(Arc::new(planet.clone())).unwrap();
    let mut more = planet.clone();
    more.edits.push(edit(paint("Dry", -0.5), 2.0, &[spot]));
    let changes = Revision::try_new(Arc::new(more)).unwrap().changes_since(&before);
    assert!(changes.contains(Stage::Height));
    assert!(!changes.contains(Stage::Field), "no noise is evaluated");
    // Paint that no layer reads changes nothing.
    let mut unread = bumpy(vec![], vec![]);
    let before = Revision::try_new(Arc::new(unread.clone())).unwrap();
    unread.edits.push(edit(paint("Dry", 1.0), 2.0, &[spot]));
    assert_eq!(Revision::try_new(Arc::new(unread)).unwrap().changes_since(&before), Stages::NONE);
}

/// The paint of a stroke of the default softness, at a share of its radius.
fn weight(share: f64) -> f64 {
    let u = ((share - 0.2) / 0.8).clamp(0.0, 1.0);
    1.0 - u * u * u * (u * (u * 6.0 - 15.0) + 10.0)
}

#[test]
fn an_edit_acts_as_far_as_its_mask_is_painted_or_outside() {
    let middle = at(20.0, 30.0);
    let stroke = edit(paint("Zone", 0.8), 40.0, &[middle]);
    let tools = [
        Tool::Raise(Raise { amount_m: 700.0 }),
        Tool::Flatten(Flatten { height_m: 300.0, strength: 1.0 }),
        Tool::Temperature(TemperaturePaint { mode: PaintMode::Shift, temperature_c: 10.0 }),
    ];
    let of = |edits: Vec<GroundEdit>| {
        let terrain = terrain(&planet(600.0, edits));
        move |dir: DVec3| {
            let sample = terrain.sample(dir);
            [sample.height_m, sample.temperature_c]
        }
    };
    for tool in tools {
        // Its own weight is 1 wherever the mask is painted.
        let whole = GroundEdit { softness: 0.0, ..edit(tool, 100.0, &[middle]) };
        let masked = GroundEdit { mask: "Zone".to_owned(), ..whole.clone() };
        let outside = GroundEdit { outside_mask: true, ..masked.clone() };
        let (bare, all) = (of(vec![]), of(vec![whole]));
        // A stroke may come before the edit or behind it.
        let [inside, around] = [(masked.clone(), false), (outside, true)]
            .map(|(edit, is_first)| of(if is_first { vec![stroke.clone(), edit] } else { vec![edit, stroke.clone()] }));
        let unpainted = of(vec![masked]);
        let mut changed = 0;
        for i in 0..60 {
            let share = f64::from(i) / 50.0;
            let dir = beside(&middle, f64::from(i) * 37.0, 40.0 * share);
            let painted = 0.8 * weight(share);
            // Temperatures fall with the height as the ground rises: both are linear in the share.
            let wanted = |share: f64| std::array::from_fn(|k| bare(dir)[k] + (all(dir)[k] - bare(dir)[k]) * share);
            let near = |found: [f64; 2], wanted: [f64; 2]| {
                assert!(found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 1e-6), "{share}: {found:?} {wanted:?}");
            };
            near(inside(dir), wanted(painted));
            near(around(dir), wanted(1.0 - painted));
            assert_eq!(unpainted(dir), bare(dir));
            changed += usize::from(painted > 0.05 && painted < 0.75 && all(dir) != bare(dir));
        }
        assert!(changed > 15, "{changed}");
    }
}

#[test]
fn a_stroke_of_the_mask_of_an_edit_rebuilds_its_own_tiles_alone() {
    let spot = at(12.0, -70.0);
    let raise = edit(Tool::Raise(Raise { amount_m: 300.0 }), 400.0, &[spot]);
    let masked = GroundEdit { mask: "Zone".to_owned(), softness: 0.2, ..raise };
    let first = edit(paint("Zone", 1.0), 3.0, &[at(12.05, -70.0)]);
    let plain = planet(900.0, vec![masked, first]);
    let view = view(12.0, -70.0, 4e4);
    let builder = Builder::new(|| {});
    let before = settled(&builder, &plain, &view);
    for (mask, touches) in [("Zone", true), ("Other", false)] {
        let mut planet = plain.clone();
        planet.edits.push(edit(paint(mask, 1.0), 2.0, &[spot]));
        let surface = settled(&builder, &planet, &view);
        assert!(surface.stats.tiles_built * 3 < surface.leaves.len(), "{}", surface.stats.tiles_built);
        let heights = |surface: &tellus::tiles::Surface| -> Vec<_> {
            surface.leaves.iter().map(|leaf| (leaf.tile.id, leaf.tile.vertices.clone())).collect()
        };
        assert!(heights(&surface) == heights(&build_now(&Arc::new(planet), &view).unwrap()));
        assert_eq!(heights(&surface) != heights(&before), touches);
        settled(&builder, &plain, &view);
    }
}

#[test]
fn copies_of_a_stamp_are_scattered_over_a_mask() {
    let middle = at(20.0, 30.0);
    let mesa = Tool::Mesa(Mesa { height_m: 500.0, talus: 0.0 });
    let scattered = GroundEdit {
        copies: 200,
        spread_km: 400.0,
        smallest: 1.0,
        softness: 0.0,
        mask: "Field".to_owned(),
        ..edit(mesa, 5.0, &[middle])
    };
    // An eighth of the spread: each copy finds a place.
    let field = GroundEdit { softness: 0.0, ..edit(paint("Field", 1.0), 141.0, &[at(20.0, 40.0)]) };
    let [inside, outside, unpainted] = [
        vec![scattered.clone(), field.clone()],
        vec![GroundEdit { outside_mask: true, ..scattered.clone() }, field.clone()],
        vec![scattered.clone()],
    ]
    .map(|edits| terrain(&planet(0.0, edits)));
    let mut dice = Dice(3);
    let [mut within, mut beyond] = [[0, 0]; 2];
    let mut count = [0, 0];
    for _ in 0..30_000 {
        let dir = beside(&middle, dice.roll() * 360.0, 404.0 * dice.roll().sqrt());
        let away_km = dir.angle_between(at(20.0, 40.0).direction()) * 1000.0;
        assert_eq!(unpainted.height_m(dir), 0.0, "nothing is painted");
        if (away_km - 141.0).abs() < 5.5 {
            continue;
        }
        let is_within = away_km < 141.0;
        count[usize::from(is_within)] += 1;
        for (terrain, seen) in [(&inside, &mut within), (&outside, &mut beyond)] {
            seen[usize::from(is_within)] += usize::from(terrain.height_m(dir) > 400.0);
        }
    }
    assert_eq!((within[0], beyond[1]), (0, 0), "copies lie on their side of the mask");
    // 200 discs of 5 km cover 8 % of the disc of 400 km: less where they meet.
    let share = |seen: usize, of: usize| seen as f64 / of as f64;
    let inside_share = share(within[1], count[1]);
    assert!(inside_share > 0.15 && inside_share < 0.3, "{inside_share}");
    let outside_share = share(beyond[0], count[0]);
    assert!(outside_share > 0.02 && outside_share < 0.06, "{outside_share}");

    // Paint that is added step by step ends as paint that is there at once.
    let strokes =
        [field, edit(paint("Field", -1.0), 60.0, &[at(21.0, 39.0)]), edit(paint("Field", 1.0), 70.0, &[middle])];
    let mut stepwise = planet(0.0, vec![scattered]);
    for stroke in strokes {
        stepwise.edits.push(stroke);
        drop(terrain(&stepwise));
    }
    let dirs: Vec<DVec3> = (0..4000).map(|i| beside(&middle, f64::from(i) * 7.0, f64::from(i) * 0.1)).collect();
    let found = terrain(&stepwise).heights_m(&dirs);
    drop(terrain(&Planet { radius_km: 900.0, ..stepwise.clone() }));
    assert_eq!(found, terrain(&stepwise).heights_m(&dirs));
}
