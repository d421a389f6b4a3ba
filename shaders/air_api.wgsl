// For shaders of a game: light and air at a point. Points are relative to the eye in the body's axes; a game transforms
// its positions and normals into them. Radiance and irradiance have the unit of the scene's targets: 1 is sunlit white
// ground.
#include "scattering.wgsl"
#include "cloud_model.wgsl"
#include "object_shadow.wgsl"

// Irradiance on a surface.
struct Light {
    // From the suns, dimmed by air and clouds and shadowed by the planet
    sun: vec3f,
    // From the sky
    sky: vec3f,
}

// Altitude in km of a point relative to the eye in metres.
fn altitude_of(rel_m: vec3f) -> f32 {
    let rel_km = rel_m * 0.001;
    let distance_km = length(rel_km);
    if distance_km <= 0.0 { return body.eye_altitude_km; }
    return altitude_along(body.radius_km, body.eye_altitude_km, dot(rel_km, body.eye_up) / distance_km, distance_km);
}

// Irradiance at a point on a surface with the normal `n` that neither ground nor things shade.
fn light_at(rel_m: vec3f, n: vec3f) -> Light { return light_through(rel_m, n, vec2f(1.0)); }

// Share of the first sun's light that objects and things of the game leave at a point on a surface with the normal `n`.
fn sun_share_at(rel_m: vec3f, n: vec3f) -> f32 { return object_shade(rel_m, n).sun; }

// Irradiance at a point on a surface with the normal `n`, in the shadows of objects and of things of the game.
// `from_ground`: share of the first sun's light that the ground leaves there, which the game asks for
// (`Terrain::sun_share`, `Surface::sun_share`).
fn shaded_light_at(rel_m: vec3f, n: vec3f, from_ground: f32) -> Light {
    let shade = object_shade(rel_m, n);
    return light_through(rel_m, n, vec2f(from_ground * shade.sun, shade.sky));
}

// The same with shares of the light of the first sun and of the sky.
fn light_through(rel_m: vec3f, n: vec3f, shares: vec2f) -> Light {
    let rel_km = rel_m * 0.001;
    let up = normalize(body.eye_km + rel_km);
    let altitude_km = max(altitude_of(rel_m), 0.0);
    let open = 0.5 + 0.5 * dot(n, up);
    var out = Light(vec3f(0.0), vec3f(0.0));
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, body.eye_km + rel_km);
        let sun_mu = dot(up, active_sun.dir);
        let sunlight = active_sun.irradiance * sun_transmittance(altitude_km, sun_mu);
        let clouds = under_clouds(rel_km, altitude_km, sun_mu, 0.001 * length(rel_m) * frame.pixel_rad);
        let share = overcast(clouds.straight, clouds.passed);
        let sun = sunlight * (clouds.straight * max(dot(n, active_sun.dir), 0.0));
        // Shadows are known for the first sun alone.
        out.sun += sun * select(1.0, shares.x, i == 0u);
        out.sky += (sky_irradiance(altitude_km, sun_mu) * share.x + sunlight * (max(sun_mu, 0.0) * share.y)) * open;
    }
    out.sky *= shares.y;
    return out;
}

// Aerial perspective: radiance seen by the eye = radiance of the point * transmittance + scattered. The air pass
// applies it to everything in the depth buffer; the shader of a thing drawn after the air pass, such as glass, must
// apply it itself.
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
        let air = air_light(
            body.eye_altitude_km, body.eye_up, dir, active_sun.dir, distance_km, frame.air_steps, NOTHING_KM, 1.0,
        );
        out.scattered += air.radiance * active_sun.irradiance;
        out.transmittance = air.transmittance;
    }
    return out;
}
