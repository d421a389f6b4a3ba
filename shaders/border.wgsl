// Location in the biome table for a climate. Noise shifts it (border jitter), so that neither the grid of the table nor
// a line of equal climate shows. Noise, octaves and weights are those of src/terrain/border.rs, evaluated on the
// reference sphere.
#include "uniforms.wgsl"
#include "luts.wgsl"

// Cells of the biome table from one pixel to the next; finer structure is blended. Must be set before the material is
// evaluated.
var<private> cells_per_pixel: vec2f;

// Vector in metres from the point of the reference sphere under the eye to the point under `rel_m`, without
// cancellation.
fn offset_on_sphere_m(rel_m: vec3f) -> vec3f {
    let radius_m = body.radius_km * 1000.0;
    let up = body.eye_up;
    let eye_m = radius_m + body.eye_altitude_km * 1000.0;
    let grown = 2.0 * eye_m * dot(up, rel_m) + dot(rel_m, rel_m);
    let from_center_m = sqrt(max(eye_m * eye_m + grown, 1.0));
    return radius_m / from_center_m * (rel_m - up * (grown / (from_center_m + eye_m)));
}

// Shift of the biome borders in cells. Octaves finer than the footprint fade out; a footprint of 0 keeps all octaves.
fn border_offset(rel_m: vec3f, footprint_m: f32) -> vec2f {
    if body.border_jitter_cells <= 0.0 { return vec2f(0.0); }
    var sum = vec2f(0.0);
    var weight = body.border_jitter_cells;
    var position_m = offset_on_sphere_m(rel_m);
    for (var i = 0u; i < BORDER_OCTAVES; i++) {
        let octave = body.border[i];
        let lod = log2(max(footprint_m, 1e-6) * BORDER_TILE_SIDE / octave.period);
        let share = 1.0 - smoothstep(0.0, 3.0, lod);
        if share <= 0.0 { break; }
        let at = octave.offset + position_m / octave.period;
        sum += weight * share * textureSampleLevel(border_tile, repeated, at, max(lod, 0.0)).rg;
        position_m = OCTAVE_TURN * position_m;
        weight *= BORDER_GAIN;
    }
    return sum;
}

// Location in the biome table, 0 to 1: column and row, the first row at 0. `climate`: moisture and 1 minus the row.
fn table_place(climate: vec2f, rel_m: vec3f, footprint_m: f32) -> vec2f {
    let cells = vec2f(textureDimensions(biome_ids));
    let location = vec2f(climate.x, 1.0 - climate.y) + border_offset(rel_m, footprint_m) / cells;
    return clamp(location, vec2f(0.0), vec2f(1.0) - 0.5 / cells / cells);
}

// Weight of the next cell at the share `f` of the way from the middle of one cell to the middle of the next.
fn border_blend(f: vec2f) -> vec2f {
    if body.crisp_borders == 0u { return f; }
    let width = clamp(cells_per_pixel, vec2f(1e-4), vec2f(1.0));
    return saturate((f - 0.5) / width + 0.5);
}
