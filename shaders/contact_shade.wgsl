// Contact shade: the share of the light that what stands close by leaves to a surface, from the depths around its pixel
// (McGuire et al., The Alchemy Screen-Space Ambient Obscurance Algorithm, 2011). It grounds trunks, stones and tufts.
#include "surface.wgsl"

// Radius around a point within which others shade it: metres, and pixels at the most.
const CONTACT_M: f32 = 1.0;
const CONTACT_PIXELS: f32 = 48.0;
// Distances in metres between which the shade fades.
const CONTACT_FAR_M: vec2f = vec2f(40.0, 80.0);
// Depths that are read, and turns of the spiral that they lie on.
const CONTACT_TAPS: i32 = 14;
const CONTACT_TURNS: f32 = 5.0;
// Strength of the shade, and the most of the light that it takes: some comes from the sun past what stands there.
const CONTACT_STRENGTH: f32 = 0.9;
const CONTACT_MOST: f32 = 0.7;
// Height over the surface below which others do not count, as a share of the distance to the eye.
const CONTACT_BIAS: f32 = 0.002;

// Place of a pixel's surface in metres from the eye.
fn seen_place_m(pixel: vec2i) -> vec3f {
    let ray = pixel_ray(vec2f(pixel) + 0.5);
    return ray * min(frame.near_m / max(textureLoad(scene_depth, pixel, 0), 1e-7), 1e4);
}

// Change of the place from a pixel to the next one, on the side where it is smaller: no edge lies there.
fn place_change_m(pixel: vec2i, step: vec2i, place_m: vec3f) -> vec3f {
    let ahead = seen_place_m(pixel + step) - place_m;
    let back = place_m - seen_place_m(pixel - step);
    return select(back, ahead, dot(ahead, ahead) < dot(back, back));
}

// `distance_m`: from the eye to the surface at the pixel.
fn contact_light(pixel: vec2i, distance_m: f32) -> f32 {
    let share = 1.0 - smoothstep(CONTACT_FAR_M.x, CONTACT_FAR_M.y, distance_m);
    if share <= 0.0 || frame.pattern_quality == 0.0 { return 1.0; }
    let place_m = seen_place_m(pixel);
    let across = cross(place_change_m(pixel, vec2i(0, 1), place_m), place_change_m(pixel, vec2i(1, 0), place_m));
    let n = across / max(length(across), 1e-12);
    let facing = select(-n, n, dot(n, place_m) < 0.0);
    let reach = min(CONTACT_M / (distance_m * frame.pixel_rad), CONTACT_PIXELS);
    let reach_m = reach * distance_m * frame.pixel_rad;
    let turn = 6.2832 * gradient_noise(vec2f(pixel));
    let last = vec2i(textureDimensions(scene_depth)) - 1;
    var sum = 0.0;
    for (var i = 0; i < CONTACT_TAPS; i++) {
        let out = (f32(i) + 0.5) / f32(CONTACT_TAPS);
        let angle = turn + 6.2832 * CONTACT_TURNS * out;
        // More of them lie close by, where thin stems stand.
        let at = pixel + vec2i(round(reach * out * sqrt(out) * vec2f(cos(angle), sin(angle))));
        let away = seen_place_m(clamp(at, vec2i(0), last)) - place_m;
        let near = saturate1(1.0 - dot(away, away) / (reach_m * reach_m));
        let over = max(dot(away, facing) - CONTACT_BIAS * distance_m, 0.0);
        sum += near * over * inverseSqrt(dot(away, away) + 1e-6);
    }
    let taken = min(CONTACT_STRENGTH * 2.0 * sum / f32(CONTACT_TAPS), 1.0);
    return 1.0 - share * CONTACT_MOST * taken;
}
