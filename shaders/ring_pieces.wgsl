// Rings near the eye: a slab of pieces of ice and rock, which with distance becomes the plane layer of ring_light.wgsl.
// src/rings/pieces.rs has the sizes and their cells. Pieces that a pixel does not resolve, and dust, are a medium of
// the optical depth that they have; the mean light and transmittance are those of the layer at any distance.
#include "ring_light.wgsl"

// Whether the eye is near the pieces (src/render/variant.rs).
override RING_PIECES: bool = false;

// A ray through the slab, in metres from the eye.
struct SlabRay {
    dir: vec3f,
    start_m: f32,
    end_m: f32,
}

// Suns as they light the slab around a ray: irradiance on a surface that faces them, and unit vector to them.
var<private> slab_light: array<vec3f, MAX_SUNS>;
var<private> slab_sun: array<vec3f, MAX_SUNS>;

// Range in metres of a ray between two heights over the middle of the rings, before `far_m`.
fn between_heights(half_m: f32, dir: vec3f, far_m: f32) -> vec2f {
    let slope = select(dir.z, select(1e-7, -1e-7, dir.z < 0.0), abs(dir.z) < 1e-7);
    let a = (-half_m - body.ring_eye_m) / slope;
    let b = (half_m - body.ring_eye_m) / slope;
    return vec2f(max(min(a, b), 0.0), min(max(a, b), far_m));
}

// Optical depth of the whole slab at a place `out_m` farther from the axis than the eye.
fn slab_depth(out_m: f32) -> f32 {
    if out_m < body.ring_edges_m.x || out_m > body.ring_edges_m.y { return 0.0; }
    return max(body.ring_depth.x + body.ring_depth.y * out_m, 0.0);
}

// Share of the optical depth that pieces of a class have; the rest of the class is debris.
fn held_share(sizes: RingClass, depth: f32) -> f32 {
    let share = (1.0 - body.ring_dust) / f32(RING_CLASSES);
    return share * min(RING_MOST_CHANCE / max(sizes.chance * depth, 1e-9), 1.0);
}

// Distances between which a class fades on a ray: it is whole before the first and gone after the second.
fn fade_of(sizes: RingClass, start_m: f32) -> vec2f {
    return vec2f(
        min(0.4 * sizes.reach_m, start_m + 0.4 * sizes.search_m),
        min(sizes.reach_m, start_m + sizes.search_m),
    );
}

// Opacity of the pieces of a class at a distance, and its integral over distances from 0.
fn shown_at(fade: vec2f, t: f32) -> f32 { return saturate1((fade.y - t) / (fade.y - fade.x)); }
fn shown_until(fade: vec2f, t: f32) -> f32 {
    let beyond = clamp(t, fade.x, fade.y) - fade.x;
    return min(t, fade.x) + beyond - 0.5 * beyond * beyond / (fade.y - fade.x);
}

// Optical depth between a point of the slab and a sun. `z_m`: height of the point over the middle.
fn depth_to_sun(depth: f32, z_m: f32, sun: vec3f) -> f32 {
    let above = saturate1(0.5 - select(-1.0, 1.0, sun.z > 0.0) * z_m / body.ring_thickness_m);
    return depth * above / max(abs(sun.z), 1e-3);
}

// A piece: where the ray enters it in radii of its ball, or -1, and its normal there. A ball from which pairs of
// facets are cut. `rel`: the eye from the centre, in radii.
fn piece_hit(rel: vec3f, dir: vec3f, bits: vec3u) -> vec4f {
    let b = dot(rel, dir);
    let root = b * b - dot(rel, rel) + 1.0;
    if root <= 0.0 { return vec4f(0.0, 0.0, 0.0, -1.0); }
    var enter = -b - sqrt(root);
    var leave = -b + sqrt(root);
    var normal = rel + dir * enter;
    for (var i = 0u; i < body.ring_facets; i++) {
        let h = hash3(bits + vec3u(i, 17u, 5u));
        let u = unit_from_hash(h);
        let flat = sqrt(max(1.0 - (2.0 * u.x - 1.0) * (2.0 * u.x - 1.0), 0.0));
        let axis = vec3f(flat * cos(2.0 * PI * u.y), flat * sin(2.0 * PI * u.y), 2.0 * u.x - 1.0);
        let halves = vec2f(vec2u(h.z & 0xffffu, h.z >> 16u)) / 65536.0;
        let at = mix(vec2f(RING_FACETS_AT.x), vec2f(RING_FACETS_AT.y), halves);
        let slope = dot(dir, axis);
        let along = dot(rel, axis);
        let steep = select(slope, 1e-6, abs(slope) < 1e-6);
        let upper = (at.x - along) / steep;
        let lower = (-at.y - along) / steep;
        let first = min(upper, lower);
        if first > enter {
            enter = first;
            normal = select(axis, -axis, steep > 0.0);
        }
        leave = min(leave, max(upper, lower));
    }
    return vec4f(normal, select(-1.0, enter, enter < leave));
}

// Unevenness of the surface of a piece: a tilt of its normal. `at`: on the piece, in metres.
fn roughened(normal: vec3f, at: vec3f, footprint_m: f32) -> vec3f {
    var tilt = vec3f(0.0);
    var size_m = 2.4;
    for (var octave = 0u; octave < body.ring_facets; octave++) {
        let seen = 1.0 - smoothstep(0.1, 0.4, footprint_m / size_m);
        let p = at * (2.0 * PI / size_m);
        let bent_p = p + 1.3 * sin(p.zxy * 0.7 + f32(octave));
        tilt += sin(bent_p.yzx + 1.7 * sin(bent_p.zxy)) * (0.11 * seen);
        size_m *= 0.43;
    }
    return normalize(normal + tilt);
}

// Radiance of a piece. `vis`: one random number of the piece. Light beyond the first scattering is the mean over all
// sides of a piece, so that the side away from the sun is not black.
fn piece_light(at_z_m: f32, normal: vec3f, dir: vec3f, depth: f32, random: f32, color: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    for (var i = 0u; i < body.sun_count; i++) {
        let through = exp(-depth_to_sun(depth, at_z_m, slab_sun[i]));
        // Pieces stand in the sun or in the shadow of others; a part is in between.
        let shown = mix(through, select(0.0, 1.0, random < through), 0.65);
        let direct = max(dot(normal, slab_sun[i]), 0.0) / PI;
        // The mean of the factor is 1 over the disc of a ball: a hint of its shape.
        let rounded = 0.4 - 0.9 * min(dot(normal, dir), 0.0);
        let around = (RING_ORDERS - 1.0) * ring_lambert(dot(dir, slab_sun[i])) * rounded;
        sum += slab_light[i] * (direct * shown + around * through);
    }
    return sum * color;
}

struct Walked {
    light: vec3f,
    transmittance: f32,
    // Distance of the first piece that hides all behind it, metres
    far_m: f32,
}

// The pieces of a class along a ray, in front of `before`.
fn walk_class(sizes: RingClass, ray: SlabRay, before: Walked, color: vec3f) -> Walked {
    var out = Walked(vec3f(0.0), 1.0, before.far_m);
    let range_m = between_heights(0.5 * body.ring_thickness_m + sizes.radius_m, ray.dir, before.far_m);
    let fade = fade_of(sizes, ray.start_m);
    let end_m = min(range_m.y, fade.y);
    let turn = sizes.turn;
    let flat = vec2f(turn.x * ray.dir.x + turn.y * ray.dir.y, turn.x * ray.dir.y - turn.y * ray.dir.x);
    // Cells for each metre of the way.
    let step = vec3f(flat / sizes.cell_m, ray.dir.z / sizes.layer_m);
    let size = vec3f(sizes.cell_m, sizes.cell_m, sizes.layer_m);
    let safe = select(step, vec3f(1e-9), abs(step) < vec3f(1e-9));
    let away = normalize(body.eye_km.xy);
    let outwards = vec2f(turn.x * away.x + turn.y * away.y, turn.x * away.y - turn.y * away.x);
    let top = f32(sizes.layers) - 1.0;
    var t = range_m.x;
    var steps = 0u;
    for (var tries = 0u; tries < body.ring_tries; tries++) {
        var found = false;
        var rel = vec3f(0.0);
        var bits = vec3u(0u);
        var radius_m = 1.0;
        var depth = 0.0;
        // To the next cell whose piece has its ball in the way.
        while !found && t < end_m && steps < body.ring_steps {
            steps++;
            let place = sizes.eye + step * t;
            let layer = clamp(floor(place.z), 0.0, top);
            // Layers are shifted against each other, so that cells never stand in columns (Roberts, The Unreasonable
            // Effectiveness of Quasirandom Sequences, 2018).
            let shift = fract(vec2f(0.7548777, 0.5698403) * layer);
            let shifted = place.xy + shift;
            let cell = floor(shifted);
            let corner = vec3f(cell - shift, layer);
            let key = vec3u(vec2u(vec2i(cell)) + sizes.first, u32(layer) + sizes.seed);
            bits = hash3(key);
            let low = vec3f(bits & vec3u(0xffffu)) / 65536.0;
            let high = vec3f(bits >> vec3u(16u)) / 65536.0;
            radius_m = sizes.radius_m * inverseSqrt(RING_SIZE_SPREAD - low.x * (RING_SIZE_SPREAD - 1.0));
            let margin = min(vec3f(radius_m) / size, vec3f(0.5));
            let center = corner + mix(margin, 1.0 - margin, vec3f(low.y, low.z, high.y));
            rel = (sizes.eye - center) * size;
            depth = slab_depth(-dot(rel.xy, outwards));
            let wanted = min(sizes.chance * depth, RING_MOST_CHANCE);
            let along = dot(rel, vec3f(flat, ray.dir.z));
            let aside = dot(rel, rel) - along * along;
            // An eye within the ball sees no piece.
            found = high.x < wanted * (1.0 - sizes.crowding * wanted) && aside < radius_m * radius_m
                && -along > 0.0 && dot(rel, rel) > radius_m * radius_m;
            // To the next cell, a bit beyond its side.
            let ahead = select(vec3f(0.0), vec3f(1.0), step > vec3f(0.0));
            var leave = (corner + ahead - sizes.eye) / safe;
            // The outer layers have no end above and below.
            if (step.z > 0.0 && layer >= top) || (step.z < 0.0 && layer <= 0.0) { leave.z = NOTHING_KM; }
            t = max(min(min(leave.x, leave.y), leave.z), t) + 1e-3 * sizes.cell_m;
        }
        if !found { break; }
        let hit = piece_hit(rel / radius_m, vec3f(flat, ray.dir.z), bits);
        let at_m = hit.w * radius_m;
        if hit.w <= 0.0 || at_m > before.far_m { continue; }
        let opacity = shown_at(fade, at_m);
        let on_piece = rel + vec3f(flat, ray.dir.z) * at_m;
        var normal = roughened(hit.xyz, on_piece + vec3f(bits >> vec3u(24u)), at_m * frame.pixel_rad);
        normal = vec3f(turn.x * normal.x - turn.y * normal.y, turn.y * normal.x + turn.x * normal.y, normal.z);
        let more = unit_from_hash(hash3(bits));
        let tint = color * mix(0.7, 1.3, more.x);
        let light = piece_light(body.ring_eye_m + ray.dir.z * at_m, normal, ray.dir, depth, more.y, tint);
        out.light += out.transmittance * opacity * light;
        out.transmittance *= 1.0 - opacity;
        if out.transmittance < 0.02 {
            out.far_m = at_m;
            break;
        }
    }
    return out;
}

// The rings along a ray before `far` km.
fn pieces_along(dir: vec3f, far: f32) -> RingLight {
    var out = RingLight(vec3f(0.0), 1.0, NOTHING_KM);
    let range_m = between_heights(0.5 * body.ring_thickness_m, dir, far * 1000.0);
    let wide_m = between_heights(0.5 * body.ring_thickness_m + body.ring_classes[0].radius_m, dir, far * 1000.0);
    if wide_m.y <= wide_m.x { return out; }
    let ray = SlabRay(dir, range_m.x, max(range_m.y, range_m.x));
    // Where most of the light comes from: the suns are the same for the whole ray.
    let free_m = body.ring_thickness_m / max(body.ring_depth.x, 0.05);
    let seen_km = (ray.start_m + min(0.5 * (ray.end_m - ray.start_m), free_m)) * 0.001;
    let at = vec3f(body.eye_km.xy + dir.xy * seen_km, 0.0);
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, at);
        slab_light[i] = active_sun.irradiance * over_planet(at);
        slab_sun[i] = active_sun.dir;
    }
    let near = ring_at(clamp(length(at.xy), body.ring_inner_km, body.ring_outer_km), 0.0);
    // Smaller classes lie before the first piece that hides all.
    var walked = Walked(vec3f(0.0), 1.0, far * 1000.0);
    for (var i = 0u; i < body.ring_class_count; i++) {
        let class_walked = walk_class(body.ring_classes[i], ray, walked, near.rgb);
        walked.light = class_walked.light + class_walked.transmittance * walked.light;
        walked.transmittance *= class_walked.transmittance;
        walked.far_m = class_walked.far_m;
    }
    // The medium before it, in parts that grow with distance.
    const PARTS: f32 = 10.0;
    let end_m = max(min(ray.end_m, walked.far_m), ray.start_m);
    let first_m = 0.6 * body.ring_thickness_m;
    let growth = log(1.0 + (end_m - ray.start_m) / first_m) / PARTS;
    var from_m = ray.start_m;
    var transmittance = 1.0;
    var light = vec3f(0.0);
    for (var part = 1.0; part <= PARTS; part += 1.0) {
        let to_m = ray.start_m + first_m * (exp(growth * part) - 1.0);
        let length_m = to_m - from_m;
        let middle_km = 0.0005 * (from_m + to_m);
        let place = body.eye_km.xy + dir.xy * middle_km;
        let outwards = abs(dot(normalize(place), dir.xy));
        let footprint_km = max(middle_km * frame.pixel_rad, 0.001 * length_m * outwards);
        let ring = ring_at(length(place), footprint_km);
        var shown = 0.0;
        for (var i = 0u; i < body.ring_class_count; i++) {
            let fade = fade_of(body.ring_classes[i], ray.start_m);
            let share = (shown_until(fade, to_m) - shown_until(fade, from_m)) / max(length_m, 1e-6);
            shown += held_share(body.ring_classes[i], ring.a) * saturate1(share);
        }
        let whole = ring.a * length_m / body.ring_thickness_m;
        let own = whole * max(1.0 - shown, 0.0);
        for (var i = 0u; i < body.sun_count; i++) {
            let cosine = dot(dir, slab_sun[i]);
            let phase = body.ring_dust * ring_dust_phase(cosine)
                + max(1.0 - body.ring_dust - shown, 0.0) * ring_lambert(cosine);
            let before = depth_to_sun(ring.a, body.ring_eye_m + dir.z * from_m, slab_sun[i]);
            let after = depth_to_sun(ring.a, body.ring_eye_m + dir.z * to_m, slab_sun[i]) + own;
            let change = after - before;
            var lit = exp(-before) * (1.0 - 0.5 * change);
            if abs(change) > 1e-3 { lit = (exp(-before) - exp(-after)) / change; }
            light += slab_light[i] * ring.rgb * (transmittance * RING_ORDERS * phase * whole * lit);
        }
        transmittance *= exp(-own);
        from_m = to_m;
    }
    out.light = light + transmittance * walked.light;
    out.transmittance = transmittance * walked.transmittance;
    out.at_km = wide_m.x * 0.001;
    return out;
}

// The rings before `far` km.
fn rings_before(dir: vec3f, far: f32) -> RingLight {
    if RING_PIECES { return pieces_along(dir, far); }
    return rings_along(dir, far);
}
