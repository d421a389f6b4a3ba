// Stands: groups of objects that are lighter or darker, yellower or bluer than others of their population. Near objects
// and the canopy far away take them from one noise.
#include "luts.wgsl"

// Tiles of their noise in widths of an object, and the strength of each: trees of one age, woods, whole regions.
const STAND_WIDTHS: vec4f = vec4f(8.0, 42.0, 230.0, 1300.0);
const STAND_SHARES: vec4f = vec4f(0.45, 0.5, 0.5, 0.4);

// The period next to a wanted one that divides the wrapped position.
fn wrapping_m(wanted_m: f32) -> f32 { return WRAP_FAR_M / round(WRAP_FAR_M / wanted_m); }

// Stand at a place: a noise of mean 0, most of it within -1 to 1. `width_m`: of an object; `at_m`: the wrapped
// position; `footprint_m`: width of a pixel. Scales that are narrower than a pixel fade.
fn stands(width_m: f32, at_m: vec3f, footprint_m: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        let tile_m = wrapping_m(STAND_WIDTHS[i] * width_m);
        let lod = log2(max(footprint_m, 1e-4) * NOISE_TILE_SIDE / tile_m);
        let share = STAND_SHARES[i] * (1.0 - smoothstep(3.0, 5.5, lod));
        if share <= 0.0 { continue; }
        sum += share * (2.0 * textureSampleLevel(noise_tile, repeated, at_m.yzx / tile_m, max(lod, 0.0)).g - 1.0);
    }
    return sum;
}
