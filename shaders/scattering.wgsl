// March through the air along a ray.
#include "light.wgsl"

// Part of a ray within the air: from, to, in km; to <= from when there is none.
fn way_through_air(h: f32, mu: f32, far: f32) -> vec2f {
    let radius = globals.eye_km.w;
    let top = globals.air.x;
    let shell = ray_sphere((radius + h) * mu, (h - top) * (2.0 * radius + h + top));
    return vec2f(max(shell.x, 0.0), min(shell.y, far));
}

// Samples crowd about `middle`, the lowest point of the way, where the air is densest: t = middle + w|w|.
fn bent(w: f32, middle: f32) -> f32 { return middle + w * abs(w); }

// One stretch of air: what it scatters towards the eye for unit irradiance, per unit of its own extinction.
fn source(h: f32, sun_mu: f32, phase_rayleigh: f32, phase_mie: f32, air: Air) -> vec3f {
    let direct = air.rayleigh * phase_rayleigh + air.mie * phase_mie;
    return direct * sun_transmittance(h, sun_mu) + (air.rayleigh + air.mie) * multiscatter(h, sun_mu);
}

// Radiance that the air alone scatters from a direction, for unit irradiance; `up` at the eye.
fn scattered_from(h: f32, up: vec3f, dir: vec3f, sun: vec3f, steps: f32) -> vec3f {
    let radius = globals.eye_km.w;
    let mu = dot(dir, up);
    let ground = ray_sphere((radius + h) * mu, h * (2.0 * radius + h));
    let far = select(1e9, ground.x, ground.x > 0.0 && ground.y >= ground.x);
    let way = way_through_air(h, mu, far);
    if way.y <= way.x { return vec3f(0.0); }
    let cosine = dot(dir, sun);
    let phase_rayleigh = rayleigh_phase(cosine);
    let phase_mie = mie_phase(cosine);
    let sun_up = dot(sun, up);
    let middle = clamp(-(radius + h) * mu, way.x, way.y);
    let start = -sqrt(middle - way.x);
    let step = (sqrt(way.y - middle) - start) / steps;
    var radiance = vec3f(0.0);
    var transmittance = vec3f(1.0);
    for (var i = 0.0; i < steps; i += 1.0) {
        let w = start + i * step;
        let length = bent(w + step, middle) - bent(w, middle);
        let t = bent(w + 0.5 * step, middle);
        let height = altitude_along(radius, h, mu, t);
        let sun_mu = clamp(((radius + h) * sun_up + t * cosine) / (radius + height), -1.0, 1.0);
        let air = air_at(height);
        let passed = exp(-air.extinction * length);
        let shine = source(height, sun_mu, phase_rayleigh, phase_mie, air);
        radiance += transmittance * shine * (1.0 - passed) / max(air.extinction, vec3f(1e-12));
        transmittance *= passed;
    }
    return radiance;
}
