// Light of a sun that other bodies and the rings let through.
#include "planet_rings.wgsl"

// Whether the body has no rings, no occluders and no points behind it (src/render/variant.rs): nothing here is needed.
override ALONE: bool = false;

// Sines and angles of small discs: drivers compute asin with few digits.
fn angle_of_sine(sine: f32) -> f32 {
    let x = min(sine, 1.0);
    return select(asin(x), x * (1.0 + x * x / 6.0), x < 0.1);
}

// Half the area of the part of a disc of radius `own` that lies beyond a chord, as src/system/light.rs has it.
fn segment_area(own: f32, other: f32, apart: f32) -> f32 {
    let cosine = clamp((apart * apart + own * own - other * other) / (2.0 * apart * own), -1.0, 1.0);
    return own * own * (acos(cosine) - cosine * sqrt(1.0 - cosine * cosine));
}

// Share of a sun's disc that a round body leaves visible. All angles in radians.
fn visible_share(sun_radius: f32, body_radius: f32, apart: f32) -> f32 {
    if apart >= sun_radius + body_radius { return 1.0; }
    if apart <= body_radius - sun_radius { return 0.0; }
    let ratio = body_radius / sun_radius;
    if apart <= sun_radius - body_radius { return 1.0 - ratio * ratio; }
    let covered = segment_area(sun_radius, body_radius, apart) + segment_area(body_radius, sun_radius, apart);
    return saturate1(1.0 - covered / (PI * sun_radius * sun_radius));
}

// Share of the active sun's light that other bodies let through to the points around one, `aside_km` from it across
// the light: the mean over all sides, nearly.
fn share_beside(at_km: vec3f, towards: vec3f, aside_km: f32) -> vec3f {
    var share = vec3f(1.0);
    for (var i = 0u; i < body.occluder_count; i++) {
        let occluder = body.occluders[i];
        let away = occluder.center_km - at_km;
        let distance = length(away);
        if dot(away, towards) <= 0.0 { continue; }
        let apart = angle_of_sine(length(cross(away, towards)) / distance);
        let radius = angle_of_sine(occluder.radius_km / distance);
        let aside = length(vec2f(apart, aside_km / distance));
        share *= mix(occluder.glow, vec3f(1.0), visible_share(active_sun.radius_rad, radius, aside));
    }
    return share;
}

// Shares of the active sun's light that reach a point.
struct Shares {
    // Past other bodies
    past_bodies: vec3f,
    // Past them and through the rings
    all: vec3f,
}

// Shares at the point `at_km` from the centre of the body.
fn sun_shares(at_km: vec3f) -> Shares {
    if ALONE { return Shares(vec3f(1.0), vec3f(1.0)); }
    let towards = normalize(active_sun.dir - at_km * active_sun.per_km);
    let past_bodies = share_beside(at_km, towards, 0.0);
    if body.ring_count == 0u { return Shares(past_bodies, past_bodies); }
    return Shares(past_bodies, past_bodies * through_rings(at_km, towards));
}

// Share of the active sun's light that reaches the point `at_km` from the centre of the body.
fn sun_share(at_km: vec3f) -> vec3f { return sun_shares(at_km).all; }

// Distances of the air that lights the air in a shadow, km.
const LIT_FROM_KM: array<f32, 4> = array<f32, 4>(30.0, 80.0, 160.0, 320.0);
// Radiance of a clear sky near the horizon over its mean over all directions.
const HORIZON_BRIGHTER: f32 = 3.0;

// Share of the light of the sky around the point `at_km` that is left. The air beyond a shadow scatters light into it,
// so that totality is a twilight (Shaw, Sky brightness and polarization during the 1973 African eclipse, 1975). Air at
// a distance stands as high over the horizon as its scale height is seen from there, and its light is dimmed on its
// way. `shares`: at the point. `extinction`: there, per km; rays climb out of it. `dimness`: what else dims the light
// of air at a distance, as a factor and as one on the height of that air.
fn share_of_sky(at_km: vec3f, shares: Shares, extinction: vec3f, dimness: vec2f) -> vec3f {
    let share = shares.all;
    if ALONE || body.occluder_count == 0u || body.air_height_km <= 0.0 { return share; }
    if min(share.r, min(share.g, share.b)) >= 0.999 { return share; }
    let towards = normalize(active_sun.dir - at_km * active_sun.per_km);
    var last = shares.past_bodies;
    var sum = share;
    for (var i = 0u; i < 4u; i++) {
        let from_km = LIT_FROM_KM[i];
        let beside = share_beside(at_km, towards, from_km);
        let height = body.rayleigh_scale_km / from_km;
        let seen = min(0.5 * HORIZON_BRIGHTER * height, 1.0) * exp(-0.5 * extinction * from_km);
        sum += max(beside - last, vec3f(0.0)) * seen * (dimness.x + dimness.y * height);
        last = beside;
    }
    return sum;
}

// Share of the light of the sky on the ground that has been scattered more than once, and thus comes from farther air.
const SCATTERED_AGAIN: f32 = 0.15;

// As `use_sun`, with the light that reaches the point `at_km` from the centre of the body.
fn use_sun_at(index: u32, at_km: vec3f) {
    use_sun(index);
    let shares = sun_shares(at_km);
    let low = body.rayleigh_per_km + body.mie_extinction_per_km;
    irradiance_of_sky *= share_of_sky(at_km, shares, low, vec2f(SCATTERED_AGAIN, 1.0));
    active_sun.irradiance *= shares.all;
}
