//! Wind over the sea.

use crate::planet::{Planet, Rotation};
use crate::sphere::geo::east_north;
use crate::world::noise::ramp;
use crate::world::weather::Weather;
use glam::DVec3;
use std::f64::consts::{FRAC_2_PI, PI};

/// The fastest wind, by the mean.
const FASTEST: f64 = 4.0;
/// Wind whose direction changes, by the mean of the steady wind.
const VARIABLE: f64 = 0.5;
/// Belts of wind on each hemisphere of a planet without a solved weather: those of the Earth.
const BELTS: f64 = 3.0;

/// The wind at a unit direction by the mean wind: a tangent whose length is 1 in the mean.
pub(crate) fn relative_wind(planet: &Planet, weather: Option<&Weather>, dir: DVec3) -> DVec3 {
    let belts = belts(planet, dir);
    let share = planet.structure.as_ref().map_or(0.0, |structure| structure.weather_share);
    let Some(weather) = weather.filter(|_| share > 0.0) else { return belts };
    let solved = weather.wind_at(dir) / weather.mean_wind_m_s().max(1e-9);
    // Where the mean wind is weak, the wind changes its direction, and still blows.
    let blown = libm::hypot(VARIABLE, solved.length().min(FASTEST)) / libm::hypot(VARIABLE, 1.0);
    let speed = 1.0 + (blown - 1.0) * share;
    // The direction is that of the solved wind, however small its share.
    solved.normalize_or_zero() * speed
}

/// Trade winds, westerlies, polar easterlies: speed 1 everywhere, as the renderer assumes it.
fn belts(planet: &Planet, dir: DVec3) -> DVec3 {
    let (east, north) = east_north(dir);
    let westward = planet.structure.as_ref().is_some_and(|s| s.weather.rotation == Rotation::Westward);
    let latitude = libm::asin(dir.z.clamp(-1.0, 1.0)) * FRAC_2_PI;
    let x = latitude.abs() * BELTS;
    let wave = libm::sin(PI * x);
    let zonal = (-wave - 0.35 * ramp(0.8, 0.0, x)) * if westward { -1.0 } else { 1.0 };
    let meridional = -0.45 * wave * latitude.signum();
    (east * zonal + north * meridional).normalize_or(east)
}
