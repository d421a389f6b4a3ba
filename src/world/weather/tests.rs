use super::*;
use crate::sphere::LatLon;
use glam::DVec3;

const SIDE: usize = 32;

fn solved(params: &Params, height_m: impl Fn(LatLon) -> f64) -> Weather {
    let cells = Cells::of(SIDE);
    let heights_m: Vec<f64> = cells.dirs.iter().map(|dir| height_m(LatLon::from_direction(*dir))).collect();
    Weather::solve(&inputs(params, &heights_m), &|| true).unwrap()
}

fn inputs<'a>(params: &'a Params, heights_m: &'a [f64]) -> Inputs<'a> {
    Inputs {
        params,
        side: SIDE,
        heights_m,
        more_rain_mm: None,
        sea_level_m: Some(0.0),
        equator_c: 28.0,
        pole_c: -26.0,
        lapse_c_per_km: 6.0,
    }
}

/// The mean of values at the cells within some degrees of a location.
fn mean_at(values: &[f64], lat_deg: f64, lon_deg: f64, within_deg: f64) -> f64 {
    let middle: DVec3 = LatLon::from_degrees(lat_deg, lon_deg).direction();
    let cells = Cells::of(SIDE);
    let near = cells.dirs.iter().zip(values).filter(|(dir, _)| dir.dot(middle) > within_deg.to_radians().cos());
    let (sum, count) = near.fold((0.0, 0), |(sum, count), (_, value)| (sum + value, count + 1));
    sum / f64::from(count)
}

/// A continent from 40 degrees west to 40 degrees east, with a range along the meridian `range_deg`.
fn continent(range_deg: f64) -> impl Fn(LatLon) -> f64 {
    move |place| {
        let (lat, lon) = place.to_degrees();
        if lon.abs() > 40.0 || lat.abs() > 65.0 {
            -4000.0
        } else if (lon - range_deg).abs() < 5.0 {
            3500.0
        } else {
            200.0
        }
    }
}

#[test]
fn lee_sides_are_drier_than_windward_ones() {
    let flat = solved(&Params::default(), continent(500.0));
    // At 45 degrees the wind comes from the west.
    let west = solved(&Params::default(), continent(-28.0));
    let (wet, dry) = (mean_at(&west.rain_mm, 47.0, -33.0, 6.0), mean_at(&west.rain_mm, 47.0, -12.0, 6.0));
    assert!(wet > 2.0 * dry, "{wet} {dry}");
    assert!(dry < 0.7 * mean_at(&flat.rain_mm, 47.0, -12.0, 6.0));
    // Trade winds come from the east.
    let east = solved(&Params::default(), continent(28.0));
    let (wet, dry) = (mean_at(&east.rain_mm, 12.0, 33.0, 6.0), mean_at(&east.rain_mm, 12.0, 12.0, 6.0));
    assert!(wet > 1.8 * dry, "{wet} {dry}");
}

#[test]
fn belts_are_those_of_the_earth_and_turn_with_the_rotation() {
    let weather = solved(&Params::default(), |_| -4000.0);
    let east: Vec<f64> = weather.wind_m_s.iter().map(|wind| wind[0]).collect();
    assert!(mean_at(&east, 15.0, 0.0, 8.0) < -2.0 && mean_at(&east, 45.0, 0.0, 8.0) > 2.0);
    assert!(mean_at(&weather.wind_m_s.iter().map(|wind| wind[1]).collect::<Vec<_>>(), 15.0, 0.0, 8.0) < -0.5);
    let rain = |lat: f64| mean_at(&weather.rain_mm, lat, 0.0, 8.0);
    assert!(rain(2.0) > 1.6 * rain(27.0) && rain(48.0) > rain(75.0), "{} {} {}", rain(2.0), rain(27.0), rain(48.0));
    let back = solved(&Params { rotation: crate::planet::Rotation::Westward, ..Params::default() }, |_| -4000.0);
    let east: Vec<f64> = back.wind_m_s.iter().map(|wind| wind[0]).collect();
    assert!(mean_at(&east, 15.0, 0.0, 8.0) > 2.0);
}

#[test]
fn deserts_lie_where_air_sinks_and_inland() {
    let weather = solved(&Params::default(), continent(500.0));
    let rain = |lat: f64, lon: f64| mean_at(&weather.rain_mm, lat, lon, 6.0);
    assert!(rain(2.0, 0.0) > 1.5 * rain(26.0, -20.0), "{} {}", rain(2.0, 0.0), rain(26.0, -20.0));
    assert!(rain(47.0, -35.0) > rain(47.0, 20.0), "{} {}", rain(47.0, -35.0), rain(47.0, 20.0));
    assert!(
        mean_at(&weather.temperature_c, 0.0, 0.0, 6.0) > 20.0
            && mean_at(&weather.temperature_c, 80.0, 0.0, 6.0) < -10.0
    );
}

#[test]
fn equal_bits_on_any_number_of_threads_and_an_end_when_told() {
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| solved(&Params::default(), continent(0.0)))
    };
    let (one, three) = (on(1), on(3));
    assert!(one.rain_mm.iter().zip(&three.rain_mm).all(|(a, b)| a.to_bits() == b.to_bits()));
    let (params, heights_m) = (Params::default(), vec![0.0; 6 * SIDE * SIDE]);
    assert!(Weather::solve(&inputs(&params, &heights_m), &|| false).is_none());
}

/// The edges of the cube do not show.
#[test]
fn rain_is_the_same_along_a_parallel_where_the_ground_is() {
    let is_land = |place: LatLon| (-5.0..35.0).contains(&place.to_degrees().0);
    let weather = solved(&Params::default(), |place| if is_land(place) { 200.0 } else { -4000.0 });
    for lat in [3.0, 12.0, 20.0, 28.0, 48.0] {
        let rain_mm = |i: u32| weather.rain_at(LatLon::from_degrees(lat, f64::from(i) * 2.5).direction());
        let mean_mm = (0..144).map(rain_mm).sum::<f64>() / 144.0;
        let worst = (0..144).map(|i| (rain_mm(i) / mean_mm - 1.0).abs()).fold(0.0, f64::max);
        assert!(worst < 0.09, "{worst} at {lat} degrees north");
    }
}
