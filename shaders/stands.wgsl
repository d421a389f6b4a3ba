// Stands: groups of objects that are lighter or darker, yellower or bluer than others of their population. Near objects
// and the canopy far away take them from one noise.
#include "luts.wgsl"

// Period of their noise in widths of an object.
const STAND_WIDTHS: f32 = 24.0;

// The period next to a wanted one that divides the wrapped position.
fn wrapping_m(wanted_m: f32) -> f32 { return WRAP_FAR_M / round(WRAP_FAR_M / wanted_m); }

// Stand at a place: a noise of mean 0, about -1 to 1. `width_m`: of an object; `at_m`: the wrapped position;
// `footprint_m`: width of a pixel.
fn stands(width_m: f32, at_m: vec3f, footprint_m: f32) -> f32 {
    let tile_m = wrapping_m(STAND_WIDTHS * width_m);
    let lod = log2(max(footprint_m, 1e-4) * NOISE_TILE_SIDE / tile_m);
    let share = 1.0 - smoothstep(3.0, 5.5, lod);
    if share <= 0.0 { return 0.0; }
    return share * (2.0 * textureSampleLevel(noise_tile, repeated, at_m.yzx / tile_m, max(lod, 0.0)).r - 1.0);
}
