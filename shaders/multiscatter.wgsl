// Table: light scattered twice or more (Hillaire 2020, section 5.5), by cosine to the star and altitude.
#include "screen.wgsl"
#include "light.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let x = (pixel.xy - 0.5) / 31.0;
    let sun_mu = clamp(x.x * 2.0 - 1.0, -1.0, 1.0);
    let radius = globals.eye_km.w;
    let top = globals.air.x;
    let h = clamp(x.y * top, top * 1e-5, top * 0.9999);
    let sun = vec3f(sqrt(max(0.0, 1.0 - sun_mu * sun_mu)), 0.0, sun_mu);

    const SIDE: u32 = 8u;
    const STEPS: u32 = 20u;
    var second = vec3f(0.0);
    var returned = vec3f(0.0);
    for (var i = 0u; i < SIDE * SIDE; i++) {
        let mu = 1.0 - 2.0 * (f32(i / SIDE) + 0.5) / f32(SIDE);
        let angle = 2.0 * PI * (f32(i % SIDE) + 0.5) / f32(SIDE);
        let flat = sqrt(1.0 - mu * mu);
        let dir = vec3f(flat * cos(angle), flat * sin(angle), mu);
        let b = (radius + h) * mu;
        let ground = ray_sphere(b, h * (2.0 * radius + h));
        let shell = ray_sphere(b, (h - top) * (2.0 * radius + h + top));
        let hits = ground.y > 0.0 && ground.x > 0.0 && ground.y >= ground.x;
        let way = select(shell.y, ground.x, hits);
        var transmittance = vec3f(1.0);
        for (var s = 0u; s < STEPS; s++) {
            let step = way / f32(STEPS);
            let t = (f32(s) + 0.5) * step;
            let height = altitude_along(radius, h, mu, t);
            let air = air_at(height);
            let step_mu = clamp((h * sun_mu + radius * sun_mu + t * dot(dir, sun)) / (radius + height), -1.0, 1.0);
            let scattering = air.rayleigh + air.mie;
            let passed = exp(-air.extinction * step);
            let inside = transmittance * scattering * (1.0 - passed) / max(air.extinction, vec3f(1e-12));
            second += inside * sun_transmittance(height, step_mu) / (4.0 * PI);
            returned += inside;
            transmittance *= passed;
        }
        if hits {
            let up = normalize(vec3f(0.0, 0.0, radius + h) + dir * way);
            let ground_mu = dot(up, sun);
            second += transmittance * sun_transmittance(0.0, ground_mu) * max(ground_mu, 0.0)
                * globals.ground_albedo.rgb / PI;
        }
    }
    let mean = 1.0 / f32(SIDE * SIDE);
    // Each further scattering returns the same share, so the sum is a geometric series.
    let share = min(returned * mean, vec3f(0.999));
    return vec4f(second * mean / (1.0 - share), 1.0);
}
