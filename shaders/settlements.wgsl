// Lights of settlements at night: towns where the land is low, flat, mild and watered, most of all near the sea.
// Patterns finer than a pixel give their mean.
#include "macro_variation.wgsl"

// Mean radiance of settled land; sunlit white ground has 1. (Towns have 10 to 20 cd/m2 of daylight's 10,000.)
const TOWN_LIGHT: f32 = 1.2e-4;
const SODIUM: vec3f = vec3f(1.0, 0.62, 0.26);
const LED: vec3f = vec3f(0.85, 0.92, 1.0);

// Crowds of people gather in towns, towns in cities, cities in regions: a cascade over octaves of the macro variation.
// Each multiplies the light; the mean of the factor is 1.
// The noise is distributed evenly, so that the mean of its sixth power is a seventh.
const CASCADE: u32 = 6u;
// Greatest light at one place, by the mean.
const MOST: f32 = 60.0;

// Light that settlements send up. `slope`: rise over run; `climate`: temperature in °C and moisture; `sun_mu`: cosine
// of the sun to the zenith.
fn settlement_light(
    rel_m: vec3f, footprint_m: f32, over_sea_m: f32, slope: f32, climate: vec2f, sun_mu: f32,
) -> vec3f {
    let night = 1.0 - smoothstep(-0.08, 0.02, sun_mu);
    let mild = smoothstep(-8.0, 6.0, climate.x) * (1.0 - smoothstep(30.0, 38.0, climate.x));
    let low = smoothstep(1.0, 4.0, over_sea_m) * (1.0 - smoothstep(300.0, 1800.0, over_sea_m));
    let even = 1.0 - smoothstep(0.12, 0.45, slope);
    // Underfoot there are no houses to shine: lights belong to land at a distance.
    let away = smoothstep(0.3, 1.5, footprint_m);
    let good = body.settlements * night * away * mild * low * even * smoothstep(0.12, 0.4, climate.y);
    var crowd = 1.0;
    var newest = 1.0;
    var position = rel_m;
    // No pattern is looked up where there is no light: not an `if`, whose branches older drivers both run.
    let count = select(0u, CASCADE, good > 0.0);
    for (var i = 0u; i < count; i++) {
        let at = body.variation[i];
        let lod = log2(max(footprint_m * NOISE_TILE_SIDE / at.period, 1e-6));
        let n = textureSampleLevel(noise_tile, repeated, (at.offset + position / at.period).zxy, max(lod, 0.0)).g;
        newest = mix(1.0, 7.0 * pow(n, 6.0), 1.0 - smoothstep(0.5, 3.0, lod));
        crowd *= newest;
        position = OCTAVE_TURN * position;
    }
    // Lights follow the coast.
    let coast = 0.35 + 2.0 * exp(-max(over_sea_m, 0.0) / 40.0);
    let light = good * crowd * coast / (1.0 + crowd * coast / MOST);
    return mix(SODIUM, LED, saturate1(0.2 * newest)) * (TOWN_LIGHT * light);
}
