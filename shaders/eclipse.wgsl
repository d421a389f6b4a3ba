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

// Share of the active sun's light that reaches the point `at_km` from the centre of the body.
fn sun_share(at_km: vec3f) -> vec3f {
    if ALONE { return vec3f(1.0); }
    var share = vec3f(1.0);
    let towards = normalize(active_sun.dir - at_km * active_sun.per_km);
    for (var i = 0u; i < body.occluder_count; i++) {
        let occluder = body.occluders[i];
        let away = occluder.center_km - at_km;
        let distance = length(away);
        if dot(away, towards) <= 0.0 { continue; }
        let apart = angle_of_sine(length(cross(away, towards)) / distance);
        let radius = angle_of_sine(occluder.radius_km / distance);
        share *= mix(occluder.glow, vec3f(1.0), visible_share(active_sun.radius_rad, radius, apart));
    }
    if body.ring_count > 0u { share *= through_rings(at_km, towards); }
    return share;
}

// As `use_sun`, with the light that reaches the point `at_km` from the centre of the body.
fn use_sun_at(index: u32, at_km: vec3f) {
    use_sun(index);
    active_sun.irradiance *= sun_share(at_km);
}
