// Stands: groups of objects that are lighter or darker, yellower or bluer than others of their population. Near objects
// and the canopy far away take them from one noise.
#include "luts.wgsl"

// Tiles of the noise of woods and regions, metres, and their strengths: those of all populations.
const WOODS_M: vec3f = vec3f(340.0, 1900.0, 10500.0);
const WOODS_SHARES: vec3f = vec3f(0.5, 0.5, 0.4);
// Tile of the noise of objects of one age, in widths of an object and in metres at the least, and its strength. Tufts
// of one kind grow in patches that are as wide as those of bushes.
const AGE_WIDTHS: f32 = 8.0;
const LEAST_AGE_M: f32 = 26.0;
const AGE_SHARE: f32 = 0.45;
// Tile of groves in widths of an object.
const GROVE_WIDTHS: f32 = 24.0;

// The period next to a wanted one that divides the wrapped position.
fn wrapping_m(wanted_m: f32) -> f32 { return WRAP_FAR_M / round(WRAP_FAR_M / wanted_m); }

// Noises of mean 0, -1 to 1, billowy (x) and fractal (y), that tile after `tile_m`; they fade as they become narrower
// than a pixel. `at_m`: the wrapped position; `footprint_m`: width of a pixel.
fn stand_noise(tile_m: f32, at_m: vec3f, footprint_m: f32) -> vec2f {
    let wrapped_m = wrapping_m(tile_m);
    let lod = log2(max(footprint_m, 1e-4) * NOISE_TILE_SIDE / wrapped_m);
    let share = 1.0 - smoothstep(3.0, 5.5, lod);
    if share <= 0.0 { return vec2f(0.0); }
    return share * (2.0 * textureSampleLevel(noise_tile, repeated, at_m.yzx / wrapped_m, max(lod, 0.0)).rg - 1.0);
}

// Stand of all populations at a place: a noise of mean 0, most of it within -1 to 1.
fn woods(at_m: vec3f, footprint_m: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 3; i++) { sum += WOODS_SHARES[i] * stand_noise(WOODS_M[i], at_m, footprint_m).y; }
    return sum;
}

// What objects of one age add to it. `width_m`: of an object.
fn of_one_age(width_m: f32, at_m: vec3f, footprint_m: f32) -> f32 {
    return AGE_SHARE * stand_noise(max(AGE_WIDTHS * width_m, LEAST_AGE_M), at_m, footprint_m).y;
}

// Grove at a place, for objects that stand in groups: a noise of mean 0, -1 to 1.
fn groves(width_m: f32, at_m: vec3f, footprint_m: f32) -> f32 {
    return stand_noise(GROVE_WIDTHS * width_m, at_m, footprint_m).x;
}
