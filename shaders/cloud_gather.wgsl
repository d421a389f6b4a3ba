// Clouds of all pixels where one pixel of each block was marched (clouds.wgsl). The others are carried over from the
// frame before: reprojected at the distance of the clouds, and held within the range of the marched pixels around them
// (Salvi, An Excursion in Temporal Supersampling, 2016).
#include "screen.wgsl"

@group(1) @binding(0) var scene_depth: texture_depth_2d;
// Of the marched pixels: clouds.wgsl
@group(1) @binding(1) var marched_light: texture_2d<f32>;
@group(1) @binding(2) var marched_distance: texture_2d<f32>;
// Of the frame before
@group(1) @binding(3) var before_light: texture_2d<f32>;
@group(1) @binding(4) var before_distance: texture_2d<f32>;

// Share of the newest march in a pixel that was marched before: the rest averages the noise of the marches.
const NEWEST: f32 = 0.5;
// Standard deviations of the marched pixels around within which clouds are carried over.
const RANGE: f32 = 1.4;
// Rays that end at distances of a greater ratio have other clouds before them.
const SAME_END: f32 = 1.25;

struct Output {
    @location(0) light: vec4f,
    @location(1) distance: vec4f,
}

// What the marched pixels around a pixel say.
struct Around {
    // Interpolated between them
    light: vec4f,
    // Mean distance of their clouds, km
    at_km: f32,
    mean: vec4f,
    deviation: vec4f,
}

fn around(inside: vec2f, far: f32) -> Around {
    let block = f32(body.march_block);
    let texel = vec2i(inside / block);
    let last = vec2i(ceil(frame.size_px / block)) - 1;
    var out = Around(vec4f(0.0), NOTHING_KM, vec4f(0.0), vec4f(0.0));
    var squares = vec4f(0.0);
    var count = 0.0;
    var weights = 0.0;
    var distance = vec2f(0.0);
    for (var i = 0; i < 9; i++) {
        let at = clamp(texel + vec2i(i % 3 - 1, i / 3 - 1), vec2i(0), last);
        let light = textureLoad(marched_light, at, 0);
        let km = textureLoad(marched_distance, at, 0).xy;
        let away = (vec2f(at) * block + vec2f(body.march_place) + 0.5 - inside) / block;
        var weight = exp(-2.0 * dot(away, away));
        if max(far, km.y) > SAME_END * min(far, km.y) {
            weight *= 1e-4;
        } else {
            out.mean += light;
            squares += light * light;
            count += 1.0;
        }
        out.light += weight * light;
        weights += weight;
        distance += weight * (1.0 - light.a) * vec2f(km.x, 1.0);
    }
    out.light /= weights;
    if distance.y > 1e-6 * weights { out.at_km = distance.x / distance.y; }
    if count > 0.0 {
        out.mean /= count;
        out.deviation = sqrt(max(squares / count - out.mean * out.mean, vec4f(0.0)));
    } else {
        out.mean = out.light;
    }
    return out;
}

// Where the clouds at a distance along a ray were in the frame before. xy: pixel; z: distance in km from the eye then;
// negative where they were not in the picture.
fn pixel_before(dir: vec3f, at_km: f32) -> vec3f {
    let rel_km = dir * min(at_km, 1e6);
    let from_center_km = body.eye_km + rel_km;
    let carried_km = body.cloud_turn_rad * vec3f(-from_center_km.y, from_center_km.x, 0.0);
    let then_m = rel_km * 1000.0 - body.eye_before_rel_m - carried_km * 1000.0;
    let clip = body.before_clip_from_rel_m * vec4f(then_m, 1.0);
    if clip.w <= 0.0 || any(abs(clip.xy) > vec2f(clip.w)) { return vec3f(-1.0); }
    let place = (clip.xy / clip.w * vec2f(0.5, -0.5) + 0.5) * frame.size_px;
    return vec3f(frame.origin_px + place, length(then_m) * 0.001);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Output {
    let ray = pixel_ray(position.xy);
    let ray_length = length(ray);
    let dir = ray / ray_length;
    let far = distance_of(textureLoad(scene_depth, vec2i(position.xy), 0), ray_length);
    let inside = position.xy - frame.origin_px;
    let here = around(inside, far);
    var light = here.light;
    let then = pixel_before(dir, here.at_km);
    if then.z >= 0.0 {
        let was_at = vec2i(then.xy);
        // Ground that was before the clouds has uncovered them.
        let was_hidden = here.at_km < far && textureLoad(before_distance, was_at, 0).y < 0.95 * min(then.z, 1e6);
        if !was_hidden {
            let carried = textureSampleLevel(before_light, clamped, then.xy / vec2f(textureDimensions(before_light)), 0.0);
            let span = RANGE * here.deviation;
            light = clamp(carried, here.mean - span, here.mean + span);
            if all(vec2u(inside) % body.march_block == body.march_place) {
                let newest = textureLoad(marched_light, vec2i(inside / f32(body.march_block)), 0);
                light = mix(light, newest, NEWEST);
            }
        }
    }
    return Output(light, vec4f(here.at_km, far, 0.0, 0.0));
}
