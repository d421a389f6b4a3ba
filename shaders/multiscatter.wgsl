// Table: light scattered twice or more (Hillaire 2020, section 5.5), by cosine to the star and altitude.
#include "screen.wgsl"
#include "light.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let x = (pixel.xy - 0.5) / 31.0;
    let root = x.x * 2.0 - 1.0;
    let sun_mu = clamp(sign(root) * root * root, -1.0, 1.0);
    let radius = globals.eye_km.w;
    let top = globals.air.x;
    let h = clamp(x.y * x.y * top, top * 1e-5, top * 0.9999);
    let sun = vec3f(sqrt(max(0.0, 1.0 - sun_mu * sun_mu)), 0.0, sun_mu);

    // Rings of equal height, and points along half of each, the other half being its mirror image.
    const RINGS: u32 = 16u;
    const AROUND: u32 = 4u;
    const STEPS: u32 = 20u;
    const SHARE: f32 = 1.0 / f32(RINGS * AROUND);
    var second = vec3f(0.0);
    var returned = vec3f(0.0);
    for (var i = 0u; i < RINGS; i++) {
        let mu = 1.0 - 2.0 * (f32(i) + 0.5) / f32(RINGS);
        let b = (radius + h) * mu;
        let shell = ray_sphere(b, (h - top) * (2.0 * radius + h + top));
        let ground = ray_sphere(b, h * (2.0 * radius + h));
        let hits = ground.y >= ground.x && ground.x > 0.0;
        let way = select(shell.y, ground.x, hits);
        let middle = clamp(-b, 0.0, way);
        let start = -sqrt(middle);
        let step = (sqrt(way - middle) - start) / f32(STEPS);
        let flat = sqrt(1.0 - mu * mu);
        var transmittance = vec3f(1.0);
        for (var s = 0u; s < STEPS; s++) {
            let w = start + f32(s) * step;
            let length_km = bent(w + step, middle) - bent(w, middle);
            let t = bent(w + 0.5 * step, middle);
            let height = altitude_along(radius, h, mu, t);
            let air = air_at(height);
            let scattering = air.rayleigh + air.mie;
            let inside = transmittance * scattering * shining_length(air.extinction, length_km);
            for (var k = 0u; k < AROUND; k++) {
                let cosine = mu * sun_mu + flat * sun.x * cos(PI * (f32(k) + 0.5) / f32(AROUND));
                let step_mu = clamp(((radius + h) * sun_mu + t * cosine) / (radius + height), -1.0, 1.0);
                second += inside * sun_transmittance(height, step_mu) * (SHARE / (4.0 * PI));
            }
            returned += inside / f32(RINGS);
            transmittance *= exp(-air.extinction * length_km);
        }
        if hits {
            for (var k = 0u; k < AROUND; k++) {
                let cosine = mu * sun_mu + flat * sun.x * cos(PI * (f32(k) + 0.5) / f32(AROUND));
                let ground_mu = clamp(((radius + h) * sun_mu + way * cosine) / radius, -1.0, 1.0);
                second += transmittance * sun_transmittance(0.0, ground_mu) * max(ground_mu, 0.0)
                    * globals.ground_albedo.rgb * (SHARE / PI);
            }
        }
    }
    // Each further scattering returns the same share, so the sum is a geometric series.
    return vec4f(second / (1.0 - min(returned, vec3f(0.999))) * MULTISCATTER_SCALE, 1.0);
}
