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

// A pixel's footprint on the ground: its longer side as a vector, the width of a tap, and the taps along the longer
// side.
struct Slant {
    long_m: vec3f,
    wide_m: f32,
    taps: u32,
}

// Longer side of a footprint up to which it has several taps: farther away, small bumps are haze.
const SLANT_M: f32 = 8.0;
// Width of one of several taps, by the distance between them: taps that close the gaps would smear the ground before
// the feet into stripes. What the gaps alias is a part of one pixel.
const TAP_WIDTH: f32 = 0.6;

// A footprint with one tap, as wide as the footprint is long.
fn plain_slant(footprint_m: f32) -> Slant { return Slant(vec3f(0.0), footprint_m, 1u); }

// Longer side of a footprint.
fn slant_length_m(slant: Slant) -> f32 { return max(length(slant.long_m), slant.wide_m); }

// Taps along a footprint that is `needed` times as long as wide: several stay sharper than one as wide as it is long.
fn taps_for(needed: f32, most: u32) -> u32 {
    return min(most, select(select(select(8u, 4u, needed < 5.6), 2u, needed < 2.8), 1u, needed < 1.4));
}

// Footprint from the steps to the next pixels, metres.
fn slant_of(rel_x: vec3f, rel_y: vec3f) -> Slant {
    let sides = vec2f(length(rel_x), length(rel_y));
    let long_m = max(max(sides.x, sides.y), 1e-6);
    let short_m = max(min(sides.x, sides.y), 1e-6);
    let is_far = long_m > SLANT_M || frame.pattern_quality == 0.0;
    let taps = taps_for(long_m / short_m, select(2u << u32(frame.pattern_quality), 1u, is_far));
    if taps == 1u { return plain_slant(long_m); }
    return Slant(select(rel_y, rel_x, sides.x > sides.y), max(short_m, TAP_WIDTH * long_m / f32(taps)), taps);
}

// How an octave is read in a footprint: its mip level, its weight, and the taps.
struct OctaveRead {
    lod: f32,
    share: f32,
    taps: u32,
}

fn octave_read(octave: Octave, slant: Slant) -> OctaveRead {
    let texels_per_m = NOISE_TILE_SIDE / octave.period;
    // Broad octaves do not change along the footprint.
    let is_broad = slant.taps > 1u && log2(length(slant.long_m) * texels_per_m) < -0.5;
    let lod = log2(slant.wide_m * texels_per_m);
    return OctaveRead(lod, octave_share(lod), select(slant.taps, 1u, is_broad));
}

// Place of a tap along a footprint, from its middle, as a share of its length.
fn tap_place(tap: u32, taps: u32) -> f32 { return (f32(tap) + 0.5) / f32(taps) - 0.5; }

// Macro variation, about -1 to 1 with mean 0, at a point relative to the eye.
fn slanted_variation(rel_m: vec3f, slant: Slant) -> f32 {
    var sum = 0.0;
    var position = rel_m;
    var long_m = slant.long_m;
    for (var i = 0u; i < VARIATION_OCTAVES; i++) {
        let octave = body.variation[i];
        let read = octave_read(octave, slant);
        if read.share <= 0.0 { break; }
        for (var tap = 0u; tap < read.taps; tap++) {
            let at = position + long_m * tap_place(tap, read.taps);
            sum += (octave_at(octave, at, read.lod) - 0.5) * (read.share / f32(read.taps));
        }
        position = OCTAVE_TURN * position;
        long_m = OCTAVE_TURN * long_m;
    }
    return clamp(sum * 1.1, -1.0, 1.0);
}

// Macro variation with one tap. `footprint_m`: width of a pixel at the point.
fn macro_variation(rel_m: vec3f, footprint_m: f32) -> f32 {
    return slanted_variation(rel_m, plain_slant(footprint_m));
}

// Slope (rise over run) along two tangents of the small bumps of the macro variation. Central differences over one
// texel to either side: a smaller step would show the edges of texels, and screen-space derivatives would show
// triangles.
fn bumps_at(rel_m: vec3f, slant: Slant, tangents: array<vec3f, 2>) -> vec2f {
    var rise = vec2f(0.0);
    var position = rel_m;
    var long_m = slant.long_m;
    var along = tangents;
    for (var i = 0u; i < VARIATION_OCTAVES; i++) {
        let octave = body.variation[i];
        let read = octave_read(octave, slant);
        if read.share <= 0.0 { break; }
        let step_m = max(octave.period / NOISE_TILE_SIDE, 0.5 * slant.wide_m);
        let strength = read.share * BUMPS * octave.period / (2.0 * step_m * f32(read.taps));
        // Two axes at each tap.
        for (var n = 0u; n < 2u * read.taps && i >= 4u; n++) {
            let axis = n & 1u;
            let at = position + long_m * tap_place(n >> 1u, read.taps);
            let aside = along[axis] * step_m;
            rise[axis] += strength * (octave_at(octave, at + aside, read.lod) - octave_at(octave, at - aside, read.lod));
        }
        position = OCTAVE_TURN * position;
        long_m = OCTAVE_TURN * long_m;
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
