// The clouds of a gas giant: a point is traced back along jets and eddies to the latitude that its colour comes from.
// src/giant.rs has the bands, the storms and the two tracings that fade into each other.
#include "uniforms.wgsl"
#include "math.wgsl"

// Whether the body is a giant (src/render/variant.rs).
override GIANT: bool = false;

// Colour (rgb) and angular speed of the jets (a) at a latitude. `sine`: of the latitude.
fn band_at(sine: f32) -> vec4f {
    let place = clamp(asin(clamp(sine, -1.0, 1.0)) / PI + 0.5, 0.0, 0.99999) * f32(BAND_ENTRIES - 1u);
    let first = u32(place);
    return mix(body.giant_bands[first], body.giant_bands[first + 1u], place - f32(first));
}

// Value noise from -1 to 1 (w) and its gradient (xyz).
fn flow_noise(p: vec3f, seed: u32) -> vec4f {
    let floored = floor(p);
    let cell = vec3u(vec3i(floored) + 4096) + seed * 7919u;
    let f = p - floored;
    let u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    let du = 30.0 * f * f * (f * (f - 2.0) + 1.0);
    var corners: array<f32, 8>;
    for (var i = 0u; i < 8u; i++) {
        corners[i] = unit_from_hash(hash3(cell + vec3u(i & 1u, (i >> 1u) & 1u, i >> 2u))).x * 2.0 - 1.0;
    }
    let x = vec4f(
        mix(corners[0], corners[1], u.x), mix(corners[2], corners[3], u.x),
        mix(corners[4], corners[5], u.x), mix(corners[6], corners[7], u.x),
    );
    let y = mix(x.xz, x.yw, u.y);
    let along_x = vec4f(
        corners[1] - corners[0], corners[3] - corners[2], corners[5] - corners[4], corners[7] - corners[6],
    );
    let along_xy = mix(along_x.xz, along_x.yw, u.y);
    let gradient = vec3f(
        mix(along_xy.x, along_xy.y, u.z),
        mix(x.y - x.x, x.w - x.z, u.z),
        y.y - y.x,
    ) * du;
    return vec4f(gradient, mix(y.x, y.y, u.z));
}

fn turned_about_axis(p: vec3f, angle: f32) -> vec3f {
    let c = cos(angle);
    let s = sin(angle);
    return vec3f(c * p.x - s * p.y, s * p.x + c * p.y, p.z);
}

// A point moved against the flow of eddies: along the curl of a noise on the sphere, which neither gathers nor spreads.
fn before_eddies(start: vec3f, seed: u32, footprint: f32) -> vec3f {
    var p = start;
    var per_radius = 1.0 / body.giant_eddy_radii;
    // Near the poles there are no jets to hold the eddies: they are small and round.
    let polar = smoothstep(0.82, 0.97, abs(start.z));
    var reach = 0.3 * body.giant_turbulence * body.giant_eddy_radii * mix(1.0, 0.75, polar);
    for (var octave = 0u; octave < 5u; octave++) {
        let seen = 1.0 - smoothstep(0.2, 0.7, footprint * per_radius);
        // Large eddies are stretched along the jets.
        let stretch = vec3f(1.0, 1.0, mix(select(1.8, 3.2, octave < 2u), 1.0, polar));
        let flow = flow_noise(p * per_radius * stretch, seed + octave);
        let along = cross(p, flow.xyz * stretch);
        p = normalize(p + along * (reach * seen));
        // The first size is walked twice: its eddies roll up.
        if octave != 0u {
            per_radius *= 2.1;
            reach *= 0.5;
        }
    }
    return p;
}

// Height of filaments over their width, for shading.
const GIANT_RELIEF: f32 = 0.0025;

struct Deck {
    albedo: vec3f,
    // Height of the cloud tops for shading, in radii, as a gradient in the planet frame
    slope: vec3f,
}

// The deck along one tracing: `age_secs` since its middle.
fn traced(dir: vec3f, age_secs: f32, seed: u32, footprint: f32) -> Deck {
    var place = dir;
    var tint = vec4f(0.0);
    var calm = 1.0;
    // Storms turn what is around them; within, their own colour shows in faint spirals.
    for (var i = 0u; i < body.giant_storm_count; i++) {
        let storm = body.giant_storms[i];
        let east = normalize(vec3f(-storm.center.y, storm.center.x, 1e-6));
        let north = cross(storm.center, east);
        let d = vec2f(dot(place, east) / storm.size, dot(place, north) / (0.55 * storm.size));
        let r2 = dot(d, d);
        if dot(place, storm.center) < 0.0 || r2 > 9.0 { continue; }
        let angle = storm.spin * exp(-0.8 * r2);
        let c = cos(angle);
        let s = sin(angle);
        let turned = vec2f(c * d.x - s * d.y, s * d.x + c * d.y) - d;
        place = normalize(place + east * (turned.x * storm.size) + north * (turned.y * 0.55 * storm.size));
        let core = 1.0 - smoothstep(0.75, 1.1, sqrt(r2));
        let arms = 0.95 + 0.05 * sin(9.0 * sqrt(r2) - atan2(turned.y + d.y, turned.x + d.x + 1e-6));
        tint = mix(tint, vec4f(storm.color * arms, 1.0), core);
        // A pale rim where air sinks around the oval.
        let rim = exp(-10.0 * (sqrt(r2) - 1.25) * (sqrt(r2) - 1.25));
        tint = mix(tint, vec4f(mix(body.giant_bright, storm.color, 0.2), 1.0), 0.3 * rim);
        calm = min(calm, 1.0 - 0.7 * core);
    }
    let turn = -band_at(place.z).a * age_secs;
    let carried = turned_about_axis(place, turn);
    let source = before_eddies(carried, seed, footprint);
    let band = band_at(mix(place.z, source.z, calm));
    // Filaments along the jets: noise drawn out along the latitude, finer and finer.
    var streak = 0.0;
    var slope = vec3f(0.0);
    var amplitude = 0.55;
    var per_radius = 2.4 / body.giant_eddy_radii;
    for (var octave = 0u; octave < 4u; octave++) {
        let seen = 1.0 - smoothstep(0.2, 0.7, footprint * per_radius);
        let stretch = vec3f(0.16, 0.16, 1.0) * per_radius;
        let noise = flow_noise(source * stretch, seed + 31u + octave);
        streak += amplitude * seen * noise.w;
        slope += noise.xyz * stretch * (amplitude * seen);
        amplitude *= 0.62;
        per_radius *= 2.3;
    }
    let filaments = body.giant_filaments * streak;
    var albedo = band.rgb * exp(0.55 * filaments);
    albedo = mix(albedo, body.giant_bright, 0.15 * smoothstep(0.2, 0.7, filaments));
    albedo = mix(albedo, tint.rgb * (1.0 + 0.3 * filaments), tint.a);
    return Deck(clamp(albedo, vec3f(0.0), vec3f(1.0)), slope * body.giant_filaments);
}

// Albedo of the deck in a direction from the centre. `footprint`: width of the pixel in radii.
fn giant_deck(dir: vec3f, footprint: f32) -> Deck {
    var out = Deck(vec3f(0.0), vec3f(0.0));
    for (var i = 0u; i < 2u; i++) {
        let tracing = body.giant_tracings[i];
        let deck = traced(dir, tracing.x, u32(tracing.z), footprint);
        out.albedo += deck.albedo * tracing.y;
        out.slope += deck.slope * tracing.y;
    }
    return out;
}
