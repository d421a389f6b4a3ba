// LUT of the optical depth from an altitude to the top of the air, and of the haze in the way, by cosine to the zenith.
// Optical depth is stored, not transmittance: it is smoother between texels, and 16 bits hold the depth of the deepest
// red sunset.
#include "screen.wgsl"
#include "air_model.wgsl"

@fragment
fn fragment(@builtin(position) pixel: vec4f) -> @location(0) vec4f {
    let x = (pixel.xy - 0.5) / (OPTICAL_DEPTH_SIZE - 1.0);
    let radius = body.radius_km;
    let top = body.air_height_km;
    // The inverse of depth_uv.
    let horizon2 = top * (2.0 * radius + top);
    let rho = x.y * sqrt(horizon2);
    let h = rho * rho / (radius + sqrt(radius * radius + rho * rho));
    let r = radius + h;
    let path_min_km = top - h;
    let path_max_km = rho + sqrt(horizon2);
    let path_km = path_min_km + x.x * (path_max_km - path_min_km);
    var mu = 1.0;
    if path_km > 0.0 { mu = clamp((horizon2 - rho * rho - path_km * path_km) / (2.0 * r * path_km), -1.0, 1.0); }

    // Steps are dense around the lowest point of the path, where the air is densest.
    const STEPS: u32 = 40u;
    let middle = clamp(-r * mu, 0.0, path_km);
    let start = -sqrt(middle);
    let step = (sqrt(path_km - middle) - start) / f32(STEPS);
    // rgb: optical depth; a: haze as km of its density at the reference sphere
    var depth = vec4f(0.0);
    for (var i = 0u; i < STEPS; i++) {
        let w = start + f32(i) * step;
        let length_km = bent(w + step, middle) - bent(w, middle);
        let height = max(altitude_along(radius, h, mu, bent(w + 0.5 * step, middle)), 0.0);
        depth += vec4f(air_at(height).extinction, haze_density(height)) * length_km;
    }
    return min(depth, vec4f(60000.0));
}
