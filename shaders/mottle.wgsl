// Natural unevenness of ground and ice: octaves of a tiling noise with mip levels. The mip level follows the pixel's
// footprint, so that what is finer than a pixel gives exactly its mean: no shimmer, and no change of colour with distance.
#include "globals.wgsl"
#include "tables.wgsl"

// About -1 to 1 with mean 0, at a point relative to the eye; `footprint_m`: width of a pixel there.
fn mottle_at(rel_m: vec3f, footprint_m: f32) -> f32 {
    var sum = 0.0;
    for (var i = 0u; i < 6u; i++) {
        let octave = globals.mottle[i];
        let lod = log2(footprint_m * 64.0 / octave.w);
        if lod > 5.0 { break; }
        let n = textureSampleLevel(noise_tile, repeated, octave.xyz + rel_m / octave.w, lod).g;
        sum += (n - 0.5) * (1.0 - 0.2 * max(lod, 0.0));
    }
    return clamp(sum * 1.6, -1.0, 1.0);
}

// Two broad independent octaves that bend borders between kinds of ground.
fn border_jitter(rel_m: vec3f, footprint_m: f32) -> vec2f {
    var sum = vec2f(0.0);
    for (var i = 1u; i < 4u; i++) {
        let octave = globals.mottle[i];
        let lod = log2(footprint_m * 64.0 / octave.w);
        if lod > 5.0 { break; }
        sum += textureSampleLevel(noise_tile, repeated, octave.yzx - rel_m.yzx / octave.w, lod).rg - 0.5;
    }
    return sum;
}
