// The bed under a point of the sea, from the ground that the picture shows. A ray meets the bed far behind the point
// where it meets the surface, so another pixel shows the bed under that point: the one that looks there.

// Passes of the search for the pixels that look under a point.
const BED_PASSES: u32 = 3u;
// Depth that the first pass looks at, metres: waves feel the bed near the shore.
const FIRST_DEPTH_M: f32 = 3.0;
// Distance of ground where the picture has none, metres.
const NO_BED_M: f32 = 1e5;
// Distance of the ground in those pixels up to which its slope counts, over that of the three points.
const FARTHEST_BED: f32 = 32.0;
// Distance of those pixels that looks at different ground.
const APART_PX: f32 = 8.0;

// A point of the ground in a pixel, relative to the eye, metres.
fn ground_in(pixel: vec2f) -> vec3f {
    let depth = textureLoad(scene_depth, vec2i(pixel), 0);
    return pixel_ray(floor(pixel) + 0.5) * select(NO_BED_M, frame.near_m / depth, depth > 0.0);
}

// Height of a point over the calm sea, metres.
fn over_sea_m(rel_m: vec3f) -> f32 {
    let distance_m = length(rel_m);
    return altitude_over_sea_m(rel_m / distance_m, distance_m * 0.001, dot(rel_m, body.eye_up) / distance_m);
}

// The water under a point of the calm sea. Three points of the bed around it give depth and slope, as `Column::of` of
// src/sea/column.rs. `footprint_m`: longer side of a pixel there.
fn column_under(calm_m: vec3f, up: vec3f, footprint_m: f32, ice: f32) -> Column {
    let east = normalize(cross(select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(up.z) > 0.99), up));
    let north = cross(up, east);
    // Never less than neighbouring pixels.
    let reach_m = max(BED_REACH_M, 1.5 * footprint_m);
    let corners = array<vec3f, 3>(north, -0.866 * east - 0.5 * north, 0.866 * east - 0.5 * north);
    var depth_m = FIRST_DEPTH_M;
    var deepening = vec2f(0.0);
    for (var turn = 0u; turn < BED_PASSES; turn++) {
        var pixels: array<vec2f, 3>;
        var low = vec2f(1e9);
        var high = vec2f(-1e9);
        for (var i = 0u; i < 3u; i++) {
            let clip = body.clip_from_rel_m * vec4f(calm_m + corners[i] * reach_m - up * depth_m, 1.0);
            pixels[i] = (clip.xy / max(clip.w, 1e-3) * vec2f(0.5, -0.5) + 0.5) * frame.size_px;
            low = min(low, pixels[i]);
            high = max(high, pixels[i]);
        }
        // All three move into the picture together, so that they stay apart, but no farther than that needs: near the
        // eye they are so far apart that some would leave through the other side, into the sky.
        let aside = max(-low, vec2f(0.0)) + min(frame.size_px - 1.0 - high, vec2f(0.0));
        var at: array<vec3f, 3>;
        for (var i = 0u; i < 3u; i++) {
            let moved = max(pixels[i] + aside, min(pixels[i], frame.size_px - 1.0 - APART_PX));
            let inside = clamp(min(moved, max(pixels[i], vec2f(APART_PX))), vec2f(0.0), frame.size_px - 1.0);
            let ground_m = ground_in(frame.origin_px + inside);
            let from_m = ground_m - calm_m;
            at[i] = vec3f(dot(from_m, east), dot(from_m, north), -over_sea_m(ground_m));
        }
        // The plane through the three points.
        let a = at[1] - at[0];
        let b = at[2] - at[0];
        let middle = (at[0] + at[1] + at[2]) / 3.0;
        let area = a.x * b.y - a.y * b.x;
        deepening = vec2f(a.z * b.y - b.z * a.y, a.x * b.z - b.x * a.z) / area;
        // Points in a line, and beds as steep as a rock, have no slope that waves follow. The slope of a bed far away
        // tells nothing about the bed here.
        let is_far = length(middle.xy) > FARTHEST_BED * reach_m;
        if is_far || abs(area) < 0.1 * reach_m * reach_m || !(dot(deepening, deepening) < 1.0) { deepening = vec2f(0.0); }
        depth_m = clamp(middle.z - dot(deepening, middle.xy), 0.0, 1e4);
    }
    return Column(calm_m, depth_m, deepening.x * east + deepening.y * north, ice);
}
