// Mean light of the sky over all azimuths, for LUTs.
#include "light.wgsl"

const MOST_AROUND: u32 = 4u;

// Mean radiance of the sky over all azimuths at a cosine to the zenith (0 to 1), seen from an altitude in km, for unit
// irradiance. One march serves all azimuths. `around`: samples along half of the ring, at most MOST_AROUND; the other
// half is its mirror image.
fn ring_light(h: f32, mu: f32, sun_mu: f32, around: u32, steps: u32) -> vec3f {
    let radius = body.radius_km;
    let top = body.air_height_km;
    let b = (radius + h) * mu;
    let path_km = max(ray_sphere(b, (h - top) * (2.0 * radius + h + top)).y, 0.0);
    let step = sqrt(path_km) / f32(steps);
    let flat = sqrt(max(0.0, 1.0 - mu * mu)) * sqrt(max(0.0, 1.0 - sun_mu * sun_mu));
    // For each sample: its cosine to the sun, and the phase functions of molecules and haze. These change faster around
    // the ring than light does: means of three.
    var cosines: array<f32, MOST_AROUND>;
    var phases: array<vec2f, MOST_AROUND>;
    for (var k = 0u; k < around; k++) {
        for (var e = 0u; e < 3u; e++) {
            let cosine = mu * sun_mu + flat * cos(PI * (f32(k) + (f32(e) + 0.5) / 3.0) / f32(around));
            phases[k] += vec2f(rayleigh_phase(cosine), mie_phase(cosine)) / 3.0;
            if e == 1u { cosines[k] = cosine; }
        }
    }
    // Light scattered before, of each sample. It changes little along the ray: two steps share it.
    var again: array<vec3f, MOST_AROUND>;
    var sum = vec3f(0.0);
    var transmittance = vec3f(1.0);
    // Distance and altitude of the previous step, for the change of the sun's elevation along the step.
    var last_t = 0.0;
    var last_height = h;
    for (var i = 0u; i < steps; i++) {
        let w = f32(i) * step;
        let length_km = bent(w + step, 0.0) - bent(w, 0.0);
        let t = bent(w + 0.5 * step, 0.0);
        let height = altitude_along(radius, h, mu, t);
        let air = air_at(height);
        let t1 = bent(w + step, 0.0);
        let end = altitude_along(radius, h, mu, t1);
        let end_mu = clamp(((radius + h) * mu + t1) / (radius + end), -1.0, 1.0);
        // Of the cosine of the sun to the zenith there: what does not depend on the azimuth, and what does
        let end_mus = vec2f((radius + h) * sun_mu, t1) / (radius + end);
        let horizon = horizon_cosine(height);
        let last_horizon = horizon_cosine(last_height);
        var shine = vec3f(0.0);
        for (var k = 0u; k < around; k++) {
            let cosine = cosines[k];
            let along = vec2f(t, last_t) * cosine + (radius + h) * sun_mu;
            let mus = clamp(along / (radius + vec2f(height, last_height)), vec2f(-1.0), vec2f(1.0));
            let over = mus - vec2f(horizon, last_horizon);
            let visible = disc_share(over.x, select(over.x - over.y, 0.0, i == 0u));
            let direct = air.rayleigh * phases[k].x + air.mie * phases[k].y;
            if i % 2u == 0u {
                let end_sun_mu = clamp(end_mus.x + end_mus.y * cosine, -1.0, 1.0);
                again[k] = scattered_again(end, end_sun_mu, end_mu, cosine);
            }
            let beam = clear_transmittance(height, mus.x) * visible;
            shine += (air.rayleigh + air.mie) * again[k] + direct * beam;
        }
        sum += transmittance * shine * shining_length(air.extinction, length_km);
        transmittance *= exp(-air.extinction * length_km);
        last_t = t;
        last_height = height;
    }
    return sum / f32(around);
}
