//! Uniforms of the sea, and of rivers and lakes.

use super::{Body, rgb, wrapped};
use crate::lod::Quality;
use crate::planet::{Planet, Water};
use crate::render::shared::{CALM_SLOPE_VARIANCE, FLOE_GRID, Wave};
use crate::sea::{Column, Waves, relative_wind};
use crate::terrain::Terrain;
use glam::{DVec3, Vec3};
use std::f64::consts::TAU;

/// Altitude up to which the surface of the sea is displaced, in standard deviations of its height.
const DISPLACED_UP_TO: f64 = 2000.0;
/// Depth that counts as any greater one, metres.
const DEEPEST_M: f64 = 1e4;
/// Resolution in altitudes of the eye of the waves that are drawn: shorter ones are less than a pixel everywhere.
const LEAST_ANGLE: f64 = 5e-4;

/// Sets the water of a planet. Rivers and lakes of a planet with no sea have the default colours.
pub(super) fn of(out: &mut Body, planet: &Planet) {
    let none = Water::default();
    let water = planet.water.as_ref().unwrap_or(&none);
    // Cox and Munk 1954: variance of the slope, up- and crosswind together.
    let variance = CALM_SLOPE_VARIANCE + 0.00512 * water.wind_m_s;
    out.has_sea = u32::from(planet.water.is_some());
    out.has_rivers = u32::from(planet.structure.is_some());
    out.water_absorption_per_m = rgb(water.absorption_per_m);
    out.water_color = rgb(water.color);
    out.water_glow = rgb(water.glow_color) * water.glow as f32;
    out.wave_slope_variance = variance as f32;
    out.ice_color = rgb(water.ice_color);
    out.freezing_c = water.freezing_c as f32;
    out.sea_level_km = (water.level_m * 1e-3) as f32;
    (out.equator_c, out.pole_c) = (planet.climate.equator_c as f32, planet.climate.pole_c as f32);
}

/// Sets the waves of a planet at a time around an eye.
pub(super) fn from_eye(
    out: &mut Body,
    terrain: &Terrain,
    planet: &Planet,
    eye_m: DVec3,
    (time_secs, quality): (f64, Quality),
) {
    let none = Water::default();
    let water = planet.water.as_ref().unwrap_or(&none);
    let over_m = eye_m.length().max(1.0) - planet.radius_m() - water.level_m;
    out.eye_over_sea_km = (over_m * 1e-3) as f32;
    let up = eye_m.normalize_or(DVec3::Z);
    let weather = terrain.weather().map(|weather| &**weather);
    let waves = Waves::of(planet, weather, up);
    out.sea_wind = match planet.water {
        Some(_) => relative_wind(planet, weather, up).normalize_or_zero().as_vec3(),
        None => Vec3::ZERO,
    };
    let shown = waves.all().iter().filter(|wave| TAU / wave.vector_per_m.length() > LEAST_ANGLE * over_m.abs());
    out.wave_count = 0;
    for (slot, wave) in out.waves.iter_mut().zip(shown) {
        *slot = Wave {
            vector_per_m: wave.vector_per_m.as_vec3(),
            phase: wave.phase_at(eye_m, time_secs) as f32,
            amplitude_m: wave.amplitude_m as f32,
        };
        out.wave_count += 1;
    }
    let is_near = planet.water.is_some() && over_m.abs() < DISPLACED_UP_TO * waves.deviation_m();
    out.wave_steps = match quality {
        _ if !is_near => 0,
        Quality::Low => 0,
        Quality::Medium => 6,
        Quality::High => 12,
    };
    out.wave_deviation_m = waves.deviation_m() as f32;
    let column = if is_near { Column::of(planet, terrain, up) } else { Column::DEEP };
    out.eye_depth_m = column.depth_m.min(DEEPEST_M) as f32;
    out.eye_deepening = column.deepening_planet.as_vec3();
    out.eye_ice = column.ice as f32;
    let surface_m = if out.wave_steps > 0 { waves.surface(up, time_secs, &column).wave_m } else { 0.0 };
    out.eye_is_under = u32::from(planet.water.is_some() && over_m < surface_m);
    out.floes_per_m = if water.floe_m > 0.0 { (1.0 / water.floe_m) as f32 } else { 0.0 };
    out.floe_eye = if water.floe_m > 0.0 {
        (wrapped(eye_m / (water.floe_m * FLOE_GRID)) * FLOE_GRID).as_vec3()
    } else {
        Vec3::ZERO
    };
}
