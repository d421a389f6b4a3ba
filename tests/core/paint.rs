//! Ground edits that read the ground around them, that are scattered, and that paint the climate.

use super::sculpt::{at, beside, edit, every_tool, planet, settled, terrain, view};
use crate::support::dice::Dice;
use glam::DVec3;
use std::sync::Arc;
use tellus::planet::Planet;
use tellus::planet::edits::{
    BiomePaint, CloudPaint, GroundEdit, Mesa, MoisturePaint, PaintMode, Raise, Smooth, TemperaturePaint, Tool,
};
use tellus::planet::param::{Stage, Stages};
use tellus::terrain::{Revision, Terrain};
use tellus::tiles::{Builder, Surface, build_now};

#[test]
fn copies_of_a_stamp_lie_within_the_spread_and_small_ones_are_many() {
    let middle = at(20.0, 30.0);
    let mesa = Tool::Mesa(Mesa { height_m: 500.0, talus: 0.0 });
    let scattered =
        GroundEdit { copies: 400, spread_km: 300.0, smallest: 0.25, softness: 0.0, ..edit(mesa, 8.0, &[middle]) };
    let terrain = terrain(&planet(0.0, vec![scattered.clone()]));
    let mut dice = Dice(3);
    let (mut low, mut high) = (0, 0);
    for _ in 0..20_000 {
        let dir = beside(&middle, dice.roll() * 360.0, dice.roll() * 300.0);
        let height_m = terrain.height_m(dir);
        low += usize::from(height_m > 100.0 && height_m < 250.0);
        high += usize::from(height_m > 400.0);
    }
    // Half the size covers a quarter of the ground, and there are four times as many.
    assert!(low > 100 && high > 20, "{low} {high}");
    for i in 0..300 {
        assert_eq!(terrain.height_m(beside(&middle, f64::from(i) * 31.0, 309.0 + f64::from(i))), 0.0);
    }
    let other = GroundEdit { seed: 2, ..scattered.clone() };
    let dirs: Vec<DVec3> = (0..500).map(|i| beside(&middle, f64::from(i) * 7.0, f64::from(i) * 0.5)).collect();
    assert_ne!(terrain.heights_m(&dirs), self::terrain(&planet(0.0, vec![other])).heights_m(&dirs));
    let text =
        "(version: 3, edits: [(tool: Crater(), copies: 1000, points: [(0, 0), (0, 1), (0, 2), (0, 3), (0, 4)])])";
    let message = Planet::from_text("f.ron", text).map(|_| ()).unwrap_err().to_string();
    assert!(
        message.contains("edits[0].copies: 5000 copies around 5 points are too many; use at most 800"),
        "{message}"
    );
}

#[test]
fn smoothing_takes_fine_detail_away_and_keeps_large_slopes_and_hills() {
    let middle = at(20.0, 30.0);
    let hills = planet(900.0, vec![edit(Tool::Raise(Raise { amount_m: 600.0 }), 120.0, &[middle])]);
    let mut smoothed = hills.clone();
    let tool = Tool::Smooth(Smooth { size: 0.5, strength: 1.0 });
    smoothed.edits.push(GroundEdit { softness: 0.3, ..edit(tool, 60.0, &[middle]) });
    let (before, after) = (terrain(&hills), terrain(&smoothed));
    // Second differences over half a kilometre, and how far the ground moved.
    let (mut rough, mut even, mut moved_m) = (0.0, 0.0, 0.0_f64);
    for i in 0..200 {
        let (heading_deg, away_km) = (f64::from(i) * 17.0, f64::from(i) * 0.2);
        let bend = |terrain: &Terrain| {
            let height_m = |off_km: f64| terrain.height_m(beside(&middle, heading_deg, away_km + off_km));
            (height_m(-0.5) - 2.0 * height_m(0.0) + height_m(0.5)).abs()
        };
        (rough, even) = (rough + bend(&before), even + bend(&after));
        let dir = beside(&middle, heading_deg, away_km);
        moved_m = moved_m.max((before.height_m(dir) - after.height_m(dir)).abs());
    }
    assert!(even < 0.1 * rough, "{even} {rough}");
    assert!(moved_m > 1.0 && moved_m < 250.0, "{moved_m}");
    let outside = beside(&middle, 40.0, 61.0);
    assert_eq!(before.height_m(outside), after.height_m(outside));

    // An edit before it shows through, wherever it is changed; one behind it stays sharp.
    let mut first = smoothed.clone();
    first.edits.insert(0, edit(Tool::Raise(Raise { amount_m: 300.0 }), 4.0, &[middle]));
    let mut last = smoothed.clone();
    last.edits.push(edit(Tool::Raise(Raise { amount_m: 300.0 }), 4.0, &[middle]));
    let rise_m = |planet: &Planet| terrain(planet).height_m(middle.direction()) - after.height_m(middle.direction());
    assert!((rise_m(&last) - 300.0).abs() < 1e-9);
    let through_m = rise_m(&first);
    assert!((0.0..100.0).contains(&through_m), "{through_m}");
}

/// The ground under paint is the same; the answers of samples are what the vertices show.
#[test]
fn paint_changes_the_climate_of_samples_and_of_tiles_alike_and_no_height() {
    let middle = at(20.0, 30.0);
    let plain = planet(900.0, Vec::new());
    let dir = middle.direction();
    let bare = terrain(&plain).sample(dir);
    let painted = |tool: Tool| {
        let planet = Planet { edits: vec![edit(tool, 80.0, &[middle])].into_iter().collect(), ..plain.clone() };
        let terrain = terrain(&planet);
        let outside = beside(&middle, 100.0, 81.0);
        let before = self::terrain(&plain).sample(outside);
        assert_eq!(terrain.sample(outside), before);
        terrain.sample(dir)
    };
    let warm = TemperaturePaint { mode: PaintMode::Shift, temperature_c: 7.0 };
    let found = painted(Tool::Temperature(warm.clone()));
    assert!((found.temperature_c - bare.temperature_c - 7.0).abs() < 1e-9 && found.height_m == bare.height_m);
    let set = TemperaturePaint { mode: PaintMode::Set, temperature_c: -11.0 };
    assert!((painted(Tool::Temperature(set)).temperature_c + 11.0).abs() < 1e-9);
    let wet = MoisturePaint { mode: PaintMode::Set, moisture: 0.83 };
    assert!((painted(Tool::Moisture(wet.clone())).moisture - 0.83).abs() < 1e-9);

    let mut planet = planet(900.0, every_tool());
    planet.biomes = tellus::planet::shipped::default_planet().biomes;
    let biome = planet.biomes.table.key(planet.biomes.table.columns() - 1, 0).unwrap();
    for (tool, lat_deg) in [
        (Tool::Biome(BiomePaint { biome, strength: 1.0 }), 12.0),
        (Tool::Temperature(warm), 12.4),
        (Tool::Moisture(wet), 11.8),
    ] {
        planet.edits.push(edit(tool, 30.0, &[at(lat_deg, -70.0), at(lat_deg, -69.0)]));
    }
    let view = view(12.0, -70.0, 4e4);
    let builder = Builder::new(|| {});
    let surface = settled(&builder, &planet, &view);
    let (lapse, sea_m) = (planet.climate.lapse_c_per_km, planet.water.as_ref().unwrap().level_m);
    let mut checked = 0;
    for leaf in &surface.leaves {
        for (i, vertex) in leaf.tile.vertices.iter().enumerate().step_by(13) {
            let dir = leaf.tile.id.direction((i % 33) as f64 / 32.0, (i / 33) as f64 / 32.0);
            let sample = surface.terrain.sample(dir);
            let above_km = (f64::from(vertex.height_m) - sea_m).max(0.0) / 1000.0;
            let temperature_c = f64::from(vertex.temperature_c) - lapse * above_km;
            let moisture = f64::from(vertex.moisture) - planet.climate.drying_per_km * above_km;
            assert!((temperature_c - sample.temperature_c).abs() < 1e-3, "{temperature_c} {}", sample.temperature_c);
            assert!((moisture.clamp(0.0, 1.0) - sample.moisture).abs() < 1e-4);
            checked += 1;
        }
    }
    assert!(checked > 1000);
    let index = planet.biomes.index_of(biome).unwrap();
    let first = planet.edits.len() - 3;
    let mut alone = planet.clone();
    (0..2).for_each(|_| drop(alone.edits.remove(first + 1)));
    let sample = terrain(&alone).sample(at(12.0, -69.5).direction());
    assert_eq!(alone.biomes.palette[sample.biome].name, alone.biomes.palette[index].name);

    // Paint runs no height stage without biome relief, and touches few tiles.
    let mut flat = plain.clone();
    settled(&builder, &flat, &view);
    flat.edits.push(edit(Tool::Moisture(MoisturePaint::default()), 2.0, &[at(12.0, -70.0)]));
    let second = settled(&builder, &flat, &view);
    assert!(second.stats.tiles_built > 0 && second.stats.tiles_built * 3 < second.leaves.len());
    assert!(!second.stats.ran().contains(tellus::planet::param::Stage::Height));
    let vertices = |surface: &Surface| -> Vec<_> {
        surface.leaves.iter().map(|leaf| (leaf.tile.id, leaf.tile.vertices.clone())).collect()
    };
    assert!(vertices(&second) == vertices(&build_now(&Arc::new(flat), &view).unwrap()));
}

#[test]
fn painted_clouds_rebuild_no_tile() {
    let clouds = |amount| edit(Tool::Clouds(CloudPaint { amount }), 300.0, &[at(12.0, -70.0)]);
    let planet = planet(900.0, every_tool());
    let view = view(12.0, -70.0, 4e4);
    let builder = Builder::new(|| {});
    settled(&builder, &planet, &view);
    let mut before = Revision::try_new(Arc::new(planet.clone())).unwrap();
    for amount in [1.0, -0.5] {
        let mut painted = planet.clone();
        painted.edits.push(clouds(amount));
        assert_eq!(settled(&builder, &painted, &view).stats.tiles_built, 0);
        let after = Revision::try_new(Arc::new(painted)).unwrap();
        assert_eq!(after.changes_since(&before), Stages::of(&[Stage::CloudMap]));
        before = after;
    }
}
