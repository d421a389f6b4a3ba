// Single and multiple scattering along a ray through the air.
#include "light.wgsl"

// Range of a ray within the air: start and end in km; end <= start without air.
fn path_through_air(h: f32, mu: f32, far: f32) -> vec2f {
    let radius = body.radius_km;
    let top = body.air_height_km;
    let shell = ray_sphere((radius + h) * mu, (h - top) * (2.0 * radius + h + top));
    return vec2f(max(shell.x, 0.0), min(shell.y, far));
}

struct AirLight {
    // Radiance scattered towards the eye, for unit irradiance
    radiance: vec3f,
    // Transmittance of the whole path, and of the path to the cloud
    transmittance: vec3f,
    to_cloud: vec3f,
}

// Marches a ray up to `far` km. `up`: zenith at the eye. Light of the air behind a cloud at `cloud_at` km is multiplied
// by `cloud_through`.
fn air_light(
    h: f32, up: vec3f, dir: vec3f, sun: vec3f, far: f32, steps: f32, cloud_at: f32, cloud_through: f32,
) -> AirLight {
    var out = AirLight(vec3f(0.0), vec3f(1.0), vec3f(1.0));
    let radius = body.radius_km;
    let mu = dot(dir, up);
    let path_km = path_through_air(h, mu, far);
    if path_km.y <= path_km.x { return out; }
    let cosine = dot(dir, sun);
    let phase_rayleigh = rayleigh_phase(cosine);
    let phase_mie = mie_phase(cosine);
    let sun_up = dot(sun, up);
    let middle = clamp(-(radius + h) * mu, path_km.x, path_km.y);
    let start = -sqrt(middle - path_km.x);
    let step = (sqrt(path_km.y - middle) - start) / steps;
    var last_over = 0.0;
    var again = vec3f(0.0);
    for (var i = 0.0; i < steps; i += 1.0) {
        let w = start + i * step;
        let t0 = bent(w, middle);
        let t1 = bent(w + step, middle);
        let length_km = t1 - t0;
        let t = bent(w + 0.5 * step, middle);
        let height = altitude_along(radius, h, mu, t);
        let sun_mu = clamp(((radius + h) * sun_up + t * cosine) / (radius + height), -1.0, 1.0);
        let air = air_at(height);
        // The planet's shadow begins somewhere within a segment; the mean over the segment avoids bands with few steps.
        let over = sun_mu - horizon_cosine(height);
        let visible = disc_share(over, select(over - last_over, 0.0, i == 0.0));
        last_over = over;
        // Light scattered before changes little along the ray: two steps share that at the end of the first one.
        if u32(i) % 2u == 0u {
            let end = altitude_along(radius, h, mu, t1);
            let cosines = ((radius + h) * vec2f(mu, sun_up) + t1 * vec2f(1.0, cosine)) / (radius + end);
            again = scattered_again(end, clamp(cosines.y, -1.0, 1.0), clamp(cosines.x, -1.0, 1.0), cosine);
        }
        let at_km = up * (radius + h) + dir * t;
        let shares = sun_shares(at_km);
        var shine = (air.rayleigh + air.mie) * again * share_of_sky(at_km, shares, air.extinction, vec2f(1.0, 0.0));
        if visible > 0.0 {
            let direct = air.rayleigh * phase_rayleigh + air.mie * phase_mie;
            shine += direct * clear_transmittance(height, sun_mu) * visible * shares.all;
        }
        let behind = saturate1((t1 - cloud_at) / max(length_km, 1e-6));
        let inside = out.transmittance * shine * shining_length(air.extinction, length_km);
        out.radiance += inside * mix(1.0, cloud_through, behind);
        if cloud_at > t0 {
            out.to_cloud = out.transmittance * exp(-air.extinction * min(cloud_at - t0, length_km));
        }
        out.transmittance *= exp(-air.extinction * length_km);
    }
    return out;
}

// Radiance scattered along a ray to the smooth ground or out into space, without clouds.
fn scattered_from(h: f32, up: vec3f, dir: vec3f, sun: vec3f, steps: f32) -> vec3f {
    let radius = body.radius_km;
    let mu = dot(dir, up);
    let ground = ray_sphere((radius + h) * mu, h * (2.0 * radius + h));
    let far = select(NOTHING_KM, ground.x, mu < 0.0 && ground.x >= 0.0 && ground.y >= ground.x);
    return air_light(h, up, dir, sun, far, steps, NOTHING_KM, 1.0).radiance;
}
