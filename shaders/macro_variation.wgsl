// Macro variation of ground and ice: octaves of a tiling noise with mip levels. The mip level follows the pixel's
// footprint, so structure finer than a pixel gives exactly its mean: no shimmer, and no change of colour with distance.
#include "uniforms.wgsl"
#include "luts.wgsl"

// Height of an octave's bumps, as a share of its period.
const BUMPS: f32 = 0.02;

// Weight of an octave: it fades out before its tile is small enough on screen for the repetition to show.
fn octave_share(lod: f32) -> f32 { return 1.0 - smoothstep(-0.5, 3.0, lod); }

fn octave_at(octave: Octave, position: vec3f, lod: f32) -> f32 {
    return textureSampleLevel(noise_tile, repeated, octave.offset + position / octave.period, lod).g;
}

// Macro variation, about -1 to 1 with mean 0, at a point relative to the eye. `footprint_m`: width of a pixel at the
// point.
fn macro_variation(rel_m: vec3f, footprint_m: f32) -> f32 {
    var sum = 0.0;
    var position = rel_m;
    for (var i = 0u; i < VARIATION_OCTAVES; i++) {
        let octave = body.variation[i];
        let lod = log2(footprint_m * NOISE_TILE_SIDE / octave.period);
        let share = octave_share(lod);
        if share <= 0.0 { break; }
        sum += (octave_at(octave, position, lod) - 0.5) * share;
        position = OCTAVE_TURN * position;
    }
    return clamp(sum * 1.1, -1.0, 1.0);
}

// Slope (rise over run) along two tangents of the small bumps of the macro variation. Central differences over one
// texel to either side: a smaller step would show the edges of texels, and screen-space derivatives would show
// triangles.
fn bumps_at(rel_m: vec3f, footprint_m: f32, tangents: array<vec3f, 2>) -> vec2f {
    var rise = vec2f(0.0);
    var position = rel_m;
    var along = tangents;
    for (var i = 0u; i < VARIATION_OCTAVES; i++) {
        let octave = body.variation[i];
        let lod = log2(footprint_m * NOISE_TILE_SIDE / octave.period);
        let share = octave_share(lod);
        if share <= 0.0 { break; }
        if i >= 4u {
            let step_m = max(octave.period / NOISE_TILE_SIDE, 0.5 * footprint_m);
            for (var axis = 0u; axis < 2u; axis++) {
                let aside = along[axis] * step_m;
                let risen = octave_at(octave, position + aside, lod) - octave_at(octave, position - aside, lod);
                rise[axis] += risen * share * BUMPS * octave.period / (2.0 * step_m);
            }
        }
        position = OCTAVE_TURN * position;
        along = array<vec3f, 2>(OCTAVE_TURN * along[0], OCTAVE_TURN * along[1]);
    }
    return rise;
}

// Broad independent octaves that bend the edges of ice.
fn edge_jitter(rel_m: vec3f, footprint_m: f32) -> f32 {
    var sum = 0.0;
    var position = rel_m;
    for (var i = 0u; i < 5u; i++) {
        let octave = body.variation[i];
        let lod = log2(footprint_m * NOISE_TILE_SIDE / octave.period);
        let share = octave_share(lod);
        if share <= 0.0 { break; }
        if i >= 2u {
            let at = (octave.offset + position / octave.period).yzx;
            sum += (textureSampleLevel(noise_tile, repeated, at, lod).r - 0.5) * share;
        }
        position = OCTAVE_TURN * position;
    }
    return sum;
}
