use super::*;
use crate::planet::edits::{CloudPaint, EditPoints};
use crate::planet::{Clouds, EditPoint, GroundEdit, Planet, Tool, shipped};
use crate::simd::Simd;
use crate::sphere::{LatLon, spread};
use crate::terrain::Revision;
use glam::DVec3;

fn field_of(planet: &Planet) -> CloudField {
    CloudField::with(&Revision::try_new(planet.clone().into()).unwrap(), None)
}

fn planet(clouds: Clouds) -> Planet {
    let planet = Planet { clouds: Some(clouds), ..shipped::layered() };
    Planet { structure: None, ..planet }
}

/// The same planet with painted clouds around 20 N 30 E, over 2000 km.
fn painted(planet: &Planet, amount: f64) -> Planet {
    let stroke = GroundEdit {
        tool: Tool::Clouds(CloudPaint { amount }),
        radius_km: 2000.0,
        softness: 0.3,
        points: EditPoints(vec![EditPoint::under(LatLon::from_degrees(20.0, 30.0).direction())]),
        ..GroundEdit::default()
    };
    Planet { edits: vec![stroke].into_iter().collect(), ..planet.clone() }
}

fn mean_cover(field: &CloudField, time_secs: f64, within: impl Fn(DVec3) -> bool) -> f64 {
    let dirs = spread(1500).filter(|dir| within(*dir));
    let covers: Vec<f64> = dirs.map(|dir| field.cover(dir, time_secs).low).collect();
    covers.iter().sum::<f64>() / covers.len() as f64
}

/// The cover that is asked for is the cover that is there, at any time.
#[test]
fn the_sky_is_as_covered_as_asked() {
    for (coverage, storms) in [(0.15, 1.0), (0.4, 0.6), (0.67, 0.0), (0.9, 1.0)] {
        let field = field_of(&planet(Clouds { coverage, storms, ..Clouds::default() }));
        for days in [0.0, 40.3] {
            let mean = mean_cover(&field, days * 86_400.0, |_| true);
            assert!((mean - coverage).abs() < 0.05, "{coverage} {storms} day {days}: {mean}");
        }
    }
}

#[test]
fn nothing_and_everything_are_covered_exactly() {
    for coverage in [0.0, 1.0] {
        let field = field_of(&planet(Clouds { coverage, veil: coverage, ..Clouds::default() }));
        for dir in spread(60) {
            let cover = field.cover(dir, 7000.0);
            assert!((cover.low - coverage).abs() < 1e-3 && (cover.veil - coverage).abs() < 1e-3, "{cover:?}");
        }
    }
}

/// The equator and the storm tracks are cloudier than the subtropics.
#[test]
fn belts_are_where_the_climate_has_them() {
    let mut planet = planet(Clouds { coverage: 0.5, ..Clouds::default() });
    planet.climate.belts = 1.0;
    let field = field_of(&planet);
    let belt = |low_deg: f64, high_deg: f64| {
        let sines = [low_deg, high_deg].map(|deg| deg.to_radians().sin());
        let times = (0..4).map(|i| f64::from(i) * 9.0 * 86_400.0);
        times.map(|time| mean_cover(&field, time, |dir| (sines[0]..sines[1]).contains(&dir.z.abs()))).sum::<f64>() / 4.0
    };
    let (equator, subtropics, tracks) = (belt(0.0, 10.0), belt(20.0, 30.0), belt(45.0, 60.0));
    assert!(equator > subtropics + 0.1 && tracks > subtropics + 0.1, "{equator} {subtropics} {tracks}");
}

/// In the mean over time each zone has the cover that its climate asks for.
#[test]
fn each_zone_is_as_covered_as_its_climate_asks() {
    let mut planet = planet(Clouds { coverage: 0.45, storms: 0.0, wind_km_h: 0.0, ..Clouds::default() });
    planet.climate.belts = 1.0;
    let field = field_of(&planet);
    let bounds = [-90.0, -50.0, -20.0, 20.0, 50.0, 90.0_f64].map(|deg| deg.to_radians().sin());
    for zone in bounds.windows(2) {
        let within = |dir: DVec3| (zone[0]..zone[1]).contains(&dir.z);
        let times = (0..6).map(|i| f64::from(i) * 11.0 * 86_400.0);
        let found = times.map(|time| mean_cover(&field, time, within)).sum::<f64>() / 6.0;
        let dirs: Vec<DVec3> = spread(1500).filter(|dir| within(*dir)).collect();
        let targets = dirs.iter().map(|dir| cover::target(field.odds(*dir) + field.offsets()[0]));
        let asked = targets.sum::<f64>() / dirs.len() as f64;
        assert!((found - asked).abs() < 0.05, "{zone:?}: {found} found, {asked} asked");
    }
}

/// Clouds from orbit are of all sizes, as real ones: the number of clouds of greater perimeter falls as a power of the
/// perimeter. Its exponent is 1.26 for real clouds (DeWitt, Garrett and Rees 2024); that of popcorn of one size
/// is 3 and more. Clouds near the finest octave, 4 texels wide, are left out, as in measurements
/// from satellites. A texel is cloudy from a cover of a quarter on, which reflects a sixth of the light.
#[test]
fn clouds_are_of_all_sizes() {
    const SIDE: usize = 384;
    const LEAST: usize = 28;
    let field = field_of(&planet(Clouds { coverage: 0.35, wind_km_h: 0.0, ..Clouds::default() }));
    let mut perimeters: Vec<f64> = Vec::new();
    let times_secs = [0.0, 4e6, 9e6, 12e6, 15e6, 18e6];
    for (face, time_secs) in
        [DVec3::X, DVec3::Y, DVec3::NEG_X, DVec3::NEG_Y, DVec3::X, DVec3::Y].into_iter().zip(times_secs)
    {
        let (east, north) = crate::sphere::geo::east_north(face);
        let at = |i: usize| (i as f64 + 0.5) / SIDE as f64 - 0.5;
        let dir = |i: usize| (face + east * at(i % SIDE) + north * at(i / SIDE)).normalize();
        let mut cloudy: Vec<bool> = (0..SIDE * SIDE).map(|i| field.cover(dir(i), time_secs).low > 0.25).collect();
        let mask = cloudy.clone();
        for start in 0..cloudy.len() {
            if !std::mem::take(&mut cloudy[start]) {
                continue;
            }
            let (mut stack, mut perimeter, mut whole) = (vec![start], 0, true);
            while let Some(i) = stack.pop() {
                let (x, y) = (i % SIDE, i / SIDE);
                if x == 0 || y == 0 || x + 1 == SIDE || y + 1 == SIDE {
                    whole = false;
                    continue;
                }
                for j in [i - 1, i + 1, i - SIDE, i + SIDE] {
                    perimeter += usize::from(!mask[j]);
                    if std::mem::take(&mut cloudy[j]) {
                        stack.push(j);
                    }
                }
            }
            if whole && perimeter >= LEAST {
                perimeters.push(perimeter as f64 / LEAST as f64);
            }
        }
    }
    // Maximum likelihood (Hill 1975). A perimeter is an even number: one less is the middle of what rounds to it.
    let exponent =
        perimeters.len() as f64 / perimeters.iter().map(|p| (p * LEAST as f64 / (LEAST - 1) as f64).ln()).sum::<f64>();
    assert!(perimeters.len() > 100 && (1.16..1.36).contains(&exponent), "{exponent} of {} clouds", perimeters.len());
}

/// Clouds change, but from one minute to the next no cover jumps; a keyframe is no seam in time.
#[test]
fn clouds_change_without_jumps() {
    let field = field_of(&planet(Clouds { storms: 1.0, ..Clouds::default() }));
    let mut changed = 0.0_f64;
    for dir in spread(80) {
        let at = |minutes: f64| field.cover(dir, minutes * 60.0).low;
        for minute in [29.0, 59.5, 60.5] {
            assert!((at(minute) - at(minute + 1.0)).abs() < 0.12, "{dir} {minute}");
        }
        changed += (at(0.0) - at(5.0 * 1440.0)).abs() / 80.0;
    }
    assert!(changed > 0.1, "{changed}");
}

#[test]
fn clouds_are_the_same_on_all_instruction_sets() {
    let field = field_of(&planet(Clouds::default()));
    let covers =
        |field: &CloudField| -> Vec<u64> { spread(40).map(|dir| field.cover(dir, 1e5).low.to_bits()).collect() };
    let expected = covers(&field);
    for simd in Simd::available() {
        assert_eq!(covers(&field.clone().with_simd(simd)), expected, "{simd:?}");
    }
}

/// A texel of the map is the field in its direction, also where cyclones crowd and only those near a block of texels
/// are evaluated.
#[cfg(feature = "render")]
#[test]
fn maps_are_the_field() {
    use crate::sphere::cube::texture_direction;
    use half::f16;
    const SIDE: usize = 64;
    let calm = Clouds { wind_km_h: 0.0, fog: 0.3, ..Clouds::default() };
    let crowded = Clouds { storms: 1.0, cyclones: 96, scale_km: 5000.0, ..calm.clone() };
    let planets = [calm, crowded].map(planet);
    for planet in [painted(&planets[0], 0.2), painted(&planets[1], -0.2)].into_iter().chain(planets) {
        let field = field_of(&planet);
        let frame = keyframe(&field, 3, SIDE);
        let ground = ground_map(&planet, &field, SIDE);
        for i in (0..6 * SIDE * SIDE).step_by(13) {
            let (face, x, y) = (i / (SIDE * SIDE), (i % SIDE) as f64 + 0.5, (i / SIDE % SIDE) as f64 + 0.5);
            let dir = texture_direction(face, SIDE, x, y);
            let drawn = |layer: usize, rank: f16, odds: f16| {
                cover::cover(f64::from(rank.to_f32()), f64::from(odds.to_f32()) + field.offsets()[layer])
            };
            let (low, fog) = (drawn(0, frame.texels[i][0], ground[i][0]), drawn(3, ground[i][3], ground[i][2]));
            let asked = field.cover(dir, 3.0 * field::KEYFRAME_SECS);
            assert!((low - asked.low).abs() < 0.02, "{dir}: {low} {asked:?}");
            assert!((fog - asked.fog).abs() < 0.02, "{dir}: {fog} {asked:?}");
        }
    }
}

/// Paint gathers clouds or clears the sky where it lies, at any time, and changes nothing beyond its radius.
#[test]
fn painted_clouds_stay_over_their_place_and_leave_the_rest_as_it_is() {
    let planet = planet(Clouds { coverage: 0.4, middle: 0.3, ..Clouds::default() });
    let middle = LatLon::from_degrees(20.0, 30.0).direction();
    let away_km = |dir: DVec3| dir.angle_between(middle) * planet.radius_km;
    let (inside, outside): (Vec<DVec3>, Vec<DVec3>) =
        spread(4000).filter(|dir| !(1300.0..2001.0).contains(&away_km(*dir))).partition(|dir| away_km(*dir) < 1300.0);
    assert!(inside.len() > 30 && outside.len() > 3000);
    let plain = field_of(&planet);
    for (amount, low, high) in [(1.0, 0.97, 1.0), (-1.0, 0.0, 0.03)] {
        let field = field_of(&painted(&planet, amount));
        for time_secs in [0.0, 86_400.0 * 3.3] {
            let covers = field.covers(&inside, time_secs);
            let mean = |of: fn(&CloudCover) -> f64| covers.iter().map(of).sum::<f64>() / covers.len() as f64;
            for mean in [mean(|cover| cover.low), mean(|cover| cover.middle)] {
                assert!((low..=high).contains(&mean), "{amount}: {mean}");
            }
            assert_eq!(field.covers(&outside[..300], time_secs), plain.covers(&outside[..300], time_secs));
        }
    }
}
