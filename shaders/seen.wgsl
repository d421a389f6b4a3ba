// Light that points of the multiple-scattering LUT see from directions all around: a tile for each elevation (across)
// and each third of the azimuths (down), and a layer for each azimuth in it. Square roots of radiance, as in that LUT.
#include "screen.wgsl"
#include "glow_model.wgsl"
#include "skylit.wgsl"

const STEPS: u32 = 7u;

// A point, and a ring of directions from it.
struct Seen {
    // Altitude in km, and cosine of the sun to the zenith
    at: vec2f,
    ring: SeenRing,
    radius: f32,
    moments: vec2f,
}

// A step along the directions of a ring.
struct Step {
    t: f32,
    height: f32,
    mu: f32,
    inside: vec3f,
    air: Air,
}

// Light that a step adds in the direction with a cosine to the sun. The forward peak of haze is part of the beam:
// scattered once more, it counts as scattered once.
fn light_of_step(seen: Seen, step: Step, cosine: f32, rayleigh: f32, mie: f32) -> vec3f {
    let sun_mu =
        clamp(((seen.radius + seen.at.x) * seen.at.y + step.t * cosine) / (seen.radius + step.height), -1.0, 1.0);
    return step.inside * (sun_beam(step.height, sun_mu) * (step.air.rayleigh * rayleigh + step.air.mie * mie)
        + scattered(step.air, scattered_light(step.height, sun_mu), seen.moments, step.mu, cosine));
}

fn light_of_ground(seen: Seen, path_km: f32, cosine: f32) -> vec3f {
    let sun_mu = clamp(((seen.radius + seen.at.x) * seen.at.y + path_km * cosine) / seen.radius, -1.0, 1.0);
    return sunlit_ground(sun_mu) + skylit_ground(sun_mu, true);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Turns {
    set_lut_sun();
    let place = tiled(position);
    let at = point_of_texel(place.pixel);
    var none: Turns;
    let rings = rings_under(at.y);
    if all_is_dark(at.x, at.y) || place.tile.x >= rings.count { return none; }
    let radius = body.radius_km;
    let top = body.air_height_km;
    let ring = seen_ring(at.x, rings, place.tile.x);
    let seen = Seen(at, ring, radius, haze_moments());
    let first = TURNS_AT_ONCE * place.tile.y;
    let turns = vec3f(SEEN_AZIMUTHS[first].x, SEEN_AZIMUTHS[first + 1u].x, SEEN_AZIMUTHS[first + 2u].x);
    let cosines = ring.mu * at.y + flat_of(ring.mu) * flat_of(at.y) * turns;
    let rayleigh = vec3f(rayleigh_phase(cosines.x), rayleigh_phase(cosines.y), rayleigh_phase(cosines.z));
    let mie = vec3f(mie_phase(cosines.x), mie_phase(cosines.y), mie_phase(cosines.z));
    let b = (radius + at.x) * ring.mu;
    let shell = ray_sphere(b, (at.x - top) * (2.0 * radius + at.x + top));
    let path_km = select(shell.y, ray_sphere(b, at.x * (2.0 * radius + at.x)).x, ring.hits);
    let middle = clamp(-b, 0.0, path_km);
    let start = -sqrt(middle);
    let step = (sqrt(path_km - middle) - start) / f32(STEPS);
    var light: Lights;
    var transmittance = vec3f(1.0);
    for (var i = 0u; i < STEPS; i++) {
        let w = start + f32(i) * step;
        let t = bent(w + 0.5 * step, middle);
        let length_km = bent(w + step, middle) - bent(w, middle);
        let height = altitude_along(radius, at.x, ring.mu, t);
        let air = air_at(height);
        let inside = transmittance * shining_length(air.extinction, length_km);
        let here = Step(t, height, (b + t) / (radius + height), inside, air);
        light.first += light_of_step(seen, here, cosines.x, rayleigh.x, mie.x);
        light.second += light_of_step(seen, here, cosines.y, rayleigh.y, mie.y);
        light.third += light_of_step(seen, here, cosines.z, rayleigh.z, mie.z);
        transmittance *= exp(-air.extinction * length_km);
    }
    if ring.hits {
        light.first += transmittance * light_of_ground(seen, path_km, cosines.x);
        light.second += transmittance * light_of_ground(seen, path_km, cosines.y);
        light.third += transmittance * light_of_ground(seen, path_km, cosines.z);
    }
    return Turns(vec4f(root_of(light.first), 1.0), vec4f(root_of(light.second), 1.0), vec4f(root_of(light.third), 1.0));
}
