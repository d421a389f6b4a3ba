// Rings in the plane of the equator: src/rings.rs computes the same on the CPU and names the sources.
#include "uniforms.wgsl"
#include "math.wgsl"

// Value noise along a line, -1 to 1.
fn line_noise(at: f32, octave: u32) -> f32 {
    let cell = u32(at);
    let a = unit_from_hash(hash3(vec3u(cell, octave, body.ring_seed))).x;
    let b = unit_from_hash(hash3(vec3u(cell + 1u, octave, body.ring_seed))).x;
    return 2.0 * mix(a, b, smoothstep(0.0, 1.0, at - f32(cell))) - 1.0;
}

// Colour of the pieces (rgb) and optical depth (a) at a distance from the centre. `footprint_km`: width over which they
// are averaged.
fn ring_at(radius_km: f32, footprint_km: f32) -> vec4f {
    let width_km = body.ring_outer_km - body.ring_inner_km;
    let share = (radius_km - body.ring_inner_km) / width_km;
    let footprint = footprint_km / width_km;
    // Edges are as soft as the footprint.
    let inside = saturate1(0.5 + min(share, 1.0 - share) / clamp(footprint, 1e-6, 0.05));
    if inside <= 0.0 { return vec4f(0.0); }
    // The mean of four places within the footprint: gaps are narrow.
    var ring = vec4f(0.0);
    for (var tap = 0u; tap < 4u; tap++) {
        let at = share + footprint * ((f32(tap) + 0.5) / 4.0 - 0.5);
        let place = clamp(at * f32(RING_ENTRIES) - 0.5, 0.0, f32(RING_ENTRIES) - 1.001);
        let first = u32(place);
        ring += 0.25 * mix(body.ring_profile[first], body.ring_profile[first + 1u], place - f32(first));
    }
    var sum = 0.0;
    var amplitude = 0.62 * body.ringlets;
    var count = body.ringlet_count;
    for (var octave = 0u; octave < body.ringlet_octaves; octave++) {
        let seen = 1.0 - smoothstep(0.25, 1.0, count * footprint);
        sum += amplitude * seen * line_noise(saturate1(share) * count, octave);
        amplitude *= RINGLET_GAIN;
        count *= 2.0;
    }
    ring.a *= max(1.0 + sum, 0.0) * inside;
    return ring;
}

// Share of a sun's light that crosses the rings to the point `at_km`. `towards`: unit vector to the sun.
fn through_rings(at_km: vec3f, towards: vec3f) -> vec3f {
    let path_km = -at_km.z / select(towards.z, 1e-6, abs(towards.z) < 1e-6);
    if path_km <= 0.0 { return vec3f(1.0); }
    let crossing_km = at_km.xy + towards.xy * path_km;
    let radius_km = length(crossing_km);
    // The sun's disc blurs the shadow.
    let blur_km = 2.0 * path_km * active_sun.radius_rad;
    // Over the width of a pixel, the place where the light crosses the rings moves the farther the flatter it falls.
    let from_eye_km = at_km - body.eye_km;
    let slant = max(abs(dot(normalize(from_eye_km), normalize(at_km))), 0.2);
    let pixel_km = length(from_eye_km) * frame.pixel_rad / slant;
    let moved = length(vec2f(1.0, dot(crossing_km, towards.xy) / (max(radius_km, 1e-6) * max(abs(towards.z), 1e-3))));
    return vec3f(exp(-ring_at(radius_km, max(blur_km, pixel_km * moved)).a / max(abs(towards.z), 1e-3)));
}
