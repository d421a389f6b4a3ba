// Table: transmittance from an altitude to the top of the air, by cosine to the zenith.
#include "screen.wgsl"
#include "air_model.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let x = (pixel.xy - 0.5) / (TRANSMITTANCE_SIZE - 1.0);
    let radius = globals.eye_km.w;
    let top = globals.air.x;
    // The inverse of transmittance_uv.
    let horizon2 = top * (2.0 * radius + top);
    let rho = x.y * sqrt(horizon2);
    let h = rho * rho / (radius + sqrt(radius * radius + rho * rho));
    let r = radius + h;
    let way_min = top - h;
    let way_max = rho + sqrt(horizon2);
    let way = way_min + x.x * (way_max - way_min);
    var mu = 1.0;
    if way > 0.0 { mu = clamp((horizon2 - rho * rho - way * way) / (2.0 * r * way), -1.0, 1.0); }

    const STEPS: u32 = 40u;
    var depth = vec3f(0.0);
    // Squared steps: dense where the air is.
    for (var i = 0u; i < STEPS; i++) {
        let a = f32(i) / f32(STEPS);
        let b = f32(i + 1u) / f32(STEPS);
        let m = 0.5 * (a + b);
        depth += air_at(altitude_along(radius, h, mu, m * m * way)).extinction * ((b * b - a * a) * way);
    }
    return vec4f(exp(-depth), 1.0);
}
