// For shaders of a game: light and air around a point. Points are relative to the eye in the body's axes; a game turns its own
// positions and normals into them. Radiance and irradiance are in the unit of the scene's targets: 1 is sunlit white ground.
#include "scattering.wgsl"
#include "cloud_model.wgsl"

// Light on a surface that no ground shades.
struct Light {
    // Irradiance by the suns, clouds and the planet's shadow counted in
    sun: vec3f,
    // Irradiance by the sky
    sky: vec3f,
}

// Altitude in km of a point relative to the eye, metres.
fn altitude_of(rel_m: vec3f) -> f32 {
    let rel_km = rel_m * 0.001;
    let distance_km = length(rel_km);
    if distance_km <= 0.0 { return body.eye_altitude_km; }
    return altitude_along(body.radius_km, body.eye_altitude_km, dot(rel_km, body.eye_up) / distance_km, distance_km);
}

// Light on a surface with the normal `n` at a point.
fn light_at(rel_m: vec3f, n: vec3f) -> Light {
    let rel_km = rel_m * 0.001;
    let up = normalize(body.eye_km + rel_km);
    let altitude_km = max(altitude_of(rel_m), 0.0);
    let open = 0.5 + 0.5 * dot(n, up);
    var out = Light(vec3f(0.0), vec3f(0.0));
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun(i);
        let sun_mu = dot(up, active_sun.dir);
        let sunlight = active_sun.irradiance * sun_transmittance(altitude_km, sun_mu);
        let shadow = cloud_shadow(rel_km, altitude_km, sun_mu, 0.001 * length(rel_m) * frame.pixel_rad);
        let share = overcast(shadow);
        out.sun += sunlight * (shadow * max(dot(n, active_sun.dir), 0.0));
        out.sky += (sky_irradiance(altitude_km, sun_mu) * share.x + sunlight * (max(sun_mu, 0.0) * share.y)) * open;
    }
    return out;
}

// The air between the eye and a point: what shows is radiance of the point x transmittance + scattered. The air stage does this for all
// that has depth; what is drawn after it, such as glass, does it by itself.
struct Haze {
    scattered: vec3f,
    transmittance: vec3f,
}

fn haze_before(rel_m: vec3f) -> Haze {
    var out = Haze(vec3f(0.0), vec3f(1.0));
    let distance_km = 0.001 * length(rel_m);
    if body.air_height_km <= 0.0 || distance_km <= 0.0 { return out; }
    let dir = normalize(rel_m);
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun(i);
        let air = air_light(body.eye_altitude_km, body.eye_up, dir, active_sun.dir, distance_km, frame.air_steps, NOTHING_KM, 1.0);
        out.scattered += air.radiance * active_sun.irradiance;
        out.transmittance = air.transmittance;
    }
    return out;
}
