// Visibility of the sun and of the sky over the surrounding ground, from the horizon angles of horizon tiles
// (src/lod/horizon.rs).
#include "air_model.wgsl"
#include "visibility.wgsl"

// Atlas of images, one for each azimuth and one for the sky visibility. Each texel has the tile's own value (r) and the
// parent's (g).
@group(3) @binding(0) var horizons: texture_2d_array<f32>;

// Azimuth of the sun in the coordinates of the cube face, in steps from one image to the next; see `face_step` in
// src/lod/horizon.rs.
fn star_azimuth(slope_axis: vec3f, up: vec3f) -> f32 {
    let across = abs(slope_axis).zxy;
    let out = cross(slope_axis, across);
    let sun = active_sun.dir;
    let towards = vec3f(dot(sun, slope_axis), dot(sun, across), dot(sun, out));
    let position = vec2f(dot(up, slope_axis), dot(up, across)) / dot(up, out);
    let bend = 1.0 + FACE_BEND * position * position;
    let step = (towards.xy - position * towards.z) / (bend * sqrt(bend));
    // With the sun in the zenith, any azimuth will do.
    let angle = atan2(step.y, step.x + select(0.0, 1e-20, all(step == vec2f(0.0))));
    return fract(angle / (2.0 * PI) + 1.0) * f32(HORIZON_AZIMUTHS);
}

fn horizon_image(position: vec2f, layer: i32, image: u32, far: f32) -> f32 {
    let corner = vec2f(vec2u(image % HORIZON_IMAGES_ALONG, image / HORIZON_IMAGES_ALONG)) * f32(TILE_SIDE);
    let side = f32(TILE_SIDE);
    let texel = (corner + 0.5 + saturate(position) * (side - 1.0)) / (side * f32(HORIZON_IMAGES_ALONG));
    let found = textureSampleLevel(horizons, clamped, texel, layer, 0.0).rg;
    return mix(found.x, found.y, far);
}

// Sine of the horizon's elevation: a cubic through the four nearest azimuths (Catmull and Rom, A class of local
// interpolating splines, 1974). Linear interpolation would cut off the peaks, and shadows would pulsate while the sun
// moves.
fn horizon_sine(position: vec2f, layer: i32, azimuth: f32, far: f32) -> f32 {
    let first = u32(azimuth) + HORIZON_AZIMUTHS - 1u;
    let f = fract(azimuth);
    let outer = f * (1.0 - f) * vec2f(f - 1.0, -f) * 0.5;
    let inner = vec2f(1.0 - f, f) - 2.0 * outer + outer.yx;
    let a = horizon_image(position, layer, first % HORIZON_AZIMUTHS, far);
    let b = horizon_image(position, layer, (first + 1u) % HORIZON_AZIMUTHS, far);
    let c = horizon_image(position, layer, (first + 2u) % HORIZON_AZIMUTHS, far);
    let d = horizon_image(position, layer, (first + 3u) % HORIZON_AZIMUTHS, far);
    return dot(outer, vec2f(a, d)) + dot(inner, vec2f(b, c));
}

// Visibility at `tile_position` (0 to 1) of a tile. `tile`: layer (-1 for none), width of the tile as a share of the
// node that has the horizon tile, and the tile's corner in that node. `tile_far`: share to which the parent has taken
// over. `h`: altitude in km.
fn visibility(tile: vec4f, slope_axis: vec3f, tile_position: vec2f, tile_far: f32, up: vec3f, h: f32) -> Visibility {
    if tile.x < 0.0 { return Visibility(1.0, 1.0); }
    let layer = i32(tile.x);
    let position = tile.zw + tile_position * tile.y;
    let far = select(tile_far, 0.0, tile.y < 1.0);
    let sky = horizon_image(position, layer, HORIZON_AZIMUTHS, far);
    let sun_mu = dot(up, active_sun.dir);
    let plain = disc_share(sun_mu - horizon_cosine(h), 0.0);
    if plain <= 0.0 { return Visibility(0.0, sky); }
    let over = sun_mu - horizon_sine(position, layer, star_azimuth(slope_axis, up), far);
    return Visibility(saturate1(disc_share(over, 0.0) / plain), sky);
}
