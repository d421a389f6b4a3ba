// Light that the rings scatter towards the eye. Single scattering by a plane layer; src/rings.rs names the sources.
#include "eclipse.wgsl"

// Light of the rings towards the eye, and their transmittance.
struct RingLight {
    light: vec3f,
    transmittance: f32,
    at_km: f32,
}

// Phase functions of large pieces and of dust.
fn ring_lambert(cosine: f32) -> f32 {
    let phase = PI - acos(clamp(cosine, -1.0, 1.0));
    return 8.0 / (3.0 * PI) * (sin(phase) + (PI - phase) * cos(phase)) / (4.0 * PI);
}

fn ring_dust_phase(cosine: f32) -> f32 {
    let g = RING_DUST_FORWARD;
    let base = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
}

fn ring_phase(cosine: f32) -> f32 { return mix(ring_lambert(cosine), ring_dust_phase(cosine), body.ring_dust); }

// Share of the active sun's disc that the planet leaves visible at a point of the rings.
fn over_planet(at_km: vec3f) -> f32 {
    let along = dot(at_km, active_sun.dir);
    if along >= 0.0 { return 1.0; }
    let aside = length(at_km - active_sun.dir * along);
    let blur = max(-along * active_sun.radius_rad, 1e-3);
    return smoothstep(body.radius_km - blur, body.radius_km + blur, aside);
}

// The rings where a ray from the eye meets them before `far` km.
fn rings_along(dir: vec3f, far: f32) -> RingLight {
    var out = RingLight(vec3f(0.0), 1.0, NOTHING_KM);
    let t = -body.eye_km.z / select(dir.z, 1e-7, abs(dir.z) < 1e-7);
    if t <= 0.0 || t >= far { return out; }
    let at = vec3f(body.eye_km.xy + dir.xy * t, 0.0);
    let radius_km = length(at.xy);
    // Change of the distance from the centre over a pixel.
    let outwards = at / max(radius_km, 1e-3);
    let slant = abs(dot(outwards, dir)) / max(abs(dir.z), 1e-4);
    let footprint_km = t * frame.pixel_rad * sqrt(1.0 + slant * slant);
    let ring = ring_at(radius_km, footprint_km);
    if ring.a <= 0.0 { return out; }
    let mu = max(abs(dir.z), 1e-3);
    out.transmittance = exp(-ring.a / mu);
    out.at_km = t;
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, at);
        let mu0 = max(abs(active_sun.dir.z), 1e-3);
        let is_lit = body.eye_km.z * active_sun.dir.z > 0.0;
        var apart = mu - mu0;
        if abs(apart) < 1e-3 { apart = 1e-3; }
        let lit = mu0 / (mu0 + mu) * (1.0 - exp(-ring.a * (1.0 / mu + 1.0 / mu0)));
        let unlit = mu0 / apart * (exp(-ring.a / (mu0 + apart)) - exp(-ring.a / mu0));
        let share = max(select(unlit, lit, is_lit), 0.0) * over_planet(at);
        // The direction of the light is away from the sun.
        let phase = ring_phase(dot(dir, active_sun.dir));
        out.light += active_sun.irradiance * ring.rgb * (RING_ORDERS * share * phase);
    }
    return out;
}
