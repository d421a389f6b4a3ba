// LUT of light scattered twice or more (Hillaire 2020, section 5.5), by the sun's cosine to the zenith and altitude.
#include "screen.wgsl"
#include "light.wgsl"

// Directions are sampled in rings of equal elevation, as in src/atmosphere/multiscatter.rs. Radiance jumps at the
// horizon, so each side of it has its own Gauss-Legendre nodes between the horizon (0) and the zenith or nadir (1),
// with their weights.
const UPPER: u32 = 7u;
const LOWER: u32 = 5u;
const NODES: array<vec2f, 12> = array<vec2f, 12>(
    vec2f(0.0254460438, 0.0647424831),
    vec2f(0.1292344072, 0.1398526957),
    vec2f(0.2970774243, 0.1909150253),
    vec2f(0.5, 0.2089795918),
    vec2f(0.7029225757, 0.1909150253),
    vec2f(0.8707655928, 0.1398526957),
    vec2f(0.9745539562, 0.0647424831),
    vec2f(0.0469100770, 0.1184634425),
    vec2f(0.2307653449, 0.2393143352),
    vec2f(0.5, 0.2844444444),
    vec2f(0.7692346551, 0.2393143352),
    vec2f(0.9530899230, 0.1184634425),
);
// Points along half of each ring, a quarter of the ring apart; the other half is its mirror image.
const ASIDE: f32 = 0.70710678;
const STEPS: u32 = 14u;

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    set_lut_sun();
    let x = (pixel.xy - 0.5) / (MULTISCATTER_SIZE - 1.0);
    let root = x.x * 2.0 - 1.0;
    let sun_mu = clamp(sign(root) * root * root, -1.0, 1.0);
    let radius = body.radius_km;
    let top = body.air_height_km;
    let h = clamp(x.y * x.y * top, top * 1e-5, top * 0.9999);
    if all_is_dark(h, sun_mu) { return vec4f(0.0, 0.0, 0.0, 1.0); }
    let sun_flat = sqrt(max(0.0, 1.0 - sun_mu * sun_mu));
    let horizon = horizon_cosine(h);

    var second = vec3f(0.0);
    var returned = vec3f(0.0);
    for (var i = 0u; i < UPPER + LOWER; i++) {
        let node = NODES[i];
        let hits = i >= UPPER;
        let span = select(1.0 - horizon, -1.0 - horizon, hits);
        let mu = horizon + span * node.x;
        let share = 0.5 * abs(span) * node.y;
        let b = (radius + h) * mu;
        let shell = ray_sphere(b, (h - top) * (2.0 * radius + h + top));
        let ground = ray_sphere(b, h * (2.0 * radius + h));
        let path_km = select(shell.y, ground.x, hits);
        let middle = clamp(-b, 0.0, path_km);
        let start = -sqrt(middle);
        let step = (sqrt(path_km - middle) - start) / f32(STEPS);
        let ahead = ASIDE * sqrt(1.0 - mu * mu) * sun_flat;
        let cosines = mu * sun_mu + vec2f(ahead, -ahead);
        var transmittance = vec3f(1.0);
        for (var s = 0u; s < STEPS; s++) {
            let w = start + f32(s) * step;
            let length_km = bent(w + step, middle) - bent(w, middle);
            let t = bent(w + 0.5 * step, middle);
            let height = altitude_along(radius, h, mu, t);
            let air = air_at(height);
            let inside = transmittance * (air.rayleigh + air.mie) * shining_length(air.extinction, length_km);
            let mus = clamp(((radius + h) * sun_mu + t * cosines) / (radius + height), vec2f(-1.0), vec2f(1.0));
            let light = sun_transmittance(height, mus.x) + sun_transmittance(height, mus.y);
            second += inside * light * (share / (8.0 * PI));
            returned += inside * share;
            transmittance *= exp(-air.extinction * length_km);
        }
        if hits {
            let mus = clamp(((radius + h) * sun_mu + path_km * cosines) / radius, vec2f(-1.0), vec2f(1.0));
            let light = sun_transmittance(0.0, mus.x) * max(mus.x, 0.0)
                + sun_transmittance(0.0, mus.y) * max(mus.y, 0.0);
            second += transmittance * light * body.ground_albedo * (share / (2.0 * PI));
        }
    }
    // Each further order of scattering returns the same share, so the sum is a geometric series.
    return vec4f(second / (1.0 - min(returned, vec3f(0.999))) * MULTISCATTER_SCALE, 1.0);
}
