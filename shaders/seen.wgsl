// Light that points of the multiple-scattering LUT see from directions all around: a tile for each direction. Square
// roots of radiance, as in that LUT.
#include "screen.wgsl"
#include "glow_model.wgsl"
#include "skylit.wgsl"

const STEPS: u32 = 5u;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    let place = tiled(position);
    let at = point_of_texel(place.pixel);
    if all_is_dark(at.x, at.y) || share_of_moments(at.y) >= 1.0 { return vec4f(0.0); }
    let radius = body.radius_km;
    let top = body.air_height_km;
    let ring = seen_ring(at.x, place.tile.y);
    let cosine = ring.mu * at.y + flat_of(ring.mu) * flat_of(at.y) * SEEN_AZIMUTHS[place.tile.x].x;
    let rayleigh = rayleigh_phase(cosine);
    let mie = mie_phase(cosine);
    let moments = haze_moments();
    let b = (radius + at.x) * ring.mu;
    let shell = ray_sphere(b, (at.x - top) * (2.0 * radius + at.x + top));
    let path_km = select(shell.y, ray_sphere(b, at.x * (2.0 * radius + at.x)).x, ring.hits);
    let middle = clamp(-b, 0.0, path_km);
    let start = -sqrt(middle);
    let step = (sqrt(path_km - middle) - start) / f32(STEPS);
    var light = vec3f(0.0);
    var transmittance = vec3f(1.0);
    for (var i = 0u; i < STEPS; i++) {
        let w = start + f32(i) * step;
        let t = bent(w + 0.5 * step, middle);
        let length_km = bent(w + step, middle) - bent(w, middle);
        let height = altitude_along(radius, at.x, ring.mu, t);
        let air = air_at(height);
        let sun_mu = clamp(((radius + at.x) * at.y + t * cosine) / (radius + height), -1.0, 1.0);
        let mu = (b + t) / (radius + height);
        // The forward peak of haze is part of the beam: scattered once more, it counts as scattered once.
        let shine = sun_beam(height, sun_mu) * (air.rayleigh * rayleigh + air.mie * mie)
            + scattered(air, scattered_light(height, sun_mu), moments, mu, cosine);
        light += transmittance * shine * shining_length(air.extinction, length_km);
        transmittance *= exp(-air.extinction * length_km);
    }
    if ring.hits {
        let sun_mu = clamp(((radius + at.x) * at.y + path_km * cosine) / radius, -1.0, 1.0);
        light += transmittance * (sunlit_ground(sun_mu) + skylit_ground(sun_mu, true));
    }
    return vec4f(sqrt(max(light, vec3f(0.0)) * MULTISCATTER_SCALE), 1.0);
}
