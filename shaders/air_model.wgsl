// Model of the air: density by altitude, phase functions, and the mapping of the optical-depth LUT. Methods: Hillaire,
// A Scalable and Production Ready Sky and Atmosphere Rendering Technique, 2020; LUT mapping: Bruneton and Neyret,
// Precomputed Atmospheric Scattering, 2008.
#include "uniforms.wgsl"
#include "math.wgsl"

struct Air {
    rayleigh: vec3f,
    mie: vec3f,
    extinction: vec3f,
}

// Scattering and extinction per km at an altitude.
fn air_at(h: f32) -> Air {
    let height = max(h, 0.0);
    let rayleigh = body.rayleigh_per_km * exp(-height / body.rayleigh_scale_km);
    let haze = exp(-height / body.mie_scale_km);
    let from_absorber = abs(height - body.absorber_height_km) / body.absorber_width_km;
    let absorber = body.absorber_per_km * max(0.0, 1.0 - from_absorber);
    var air: Air;
    air.rayleigh = rayleigh;
    air.mie = body.mie_scattering_per_km * haze;
    air.extinction = rayleigh + body.mie_extinction_per_km * haze + absorber;
    return air;
}

// Integral of exp(-extinction t) over a segment: the length that contributes light, dimmed by the segment itself. The
// series avoids the cancellation of 1 - exp(-x) in thin air and short segments.
fn shining_length(extinction: vec3f, length_km: f32) -> vec3f {
    let x = extinction * length_km;
    let series = length_km * (1.0 - x * (0.5 - x * (1.0 / 6.0)));
    return select((1.0 - exp(-x)) / extinction, series, x < vec3f(0.03));
}

fn rayleigh_phase(cosine: f32) -> f32 { return 3.0 / (16.0 * PI) * (1.0 + cosine * cosine); }

// Cornette and Shanks, Physically reasonable analytic expression for the single-scattering phase function, 1992.
fn mie_phase(cosine: f32) -> f32 {
    let g = body.mie_anisotropy;
    let g2 = g * g;
    let base = max(1.0 + g2 - 2.0 * g * cosine, 1e-6);
    return 3.0 / (8.0 * PI) * (1.0 - g2) * (1.0 + cosine * cosine) / ((2.0 + g2) * base * sqrt(base));
}

fn texel_from_unit(x: vec2f, size: vec2f) -> vec2f { return (x * (size - 1.0) + 0.5) / size; }

// Texture coordinates in the optical-depth LUT of an altitude and a cosine to the zenith.
fn depth_uv(h_km: f32, mu: f32) -> vec2f {
    let radius = body.radius_km;
    let top = body.air_height_km;
    let h = clamp(h_km, 0.0, top);
    let rho2 = h * (2.0 * radius + h);
    let horizon2 = top * (2.0 * radius + top);
    let r = radius + h;
    let path_km = max(0.0, -r * mu + sqrt(max(r * r * mu * mu + horizon2 - rho2, 0.0)));
    let path_min_km = top - h;
    let path_max_km = sqrt(rho2) + sqrt(horizon2);
    let x = vec2f((path_km - path_min_km) / max(path_max_km - path_min_km, 1e-9), sqrt(rho2 / horizon2));
    return texel_from_unit(saturate(x), OPTICAL_DEPTH_SIZE);
}

// Cosine of the zenith angle of the horizon, seen from an altitude in km.
fn horizon_cosine(h: f32) -> f32 {
    let radius = body.radius_km;
    let height = max(h, 0.0);
    return -sqrt(height * (2.0 * radius + height)) / (radius + height);
}

// Visible share of a sun's disc over the horizon of the smooth planet. `over`: cosine of the disc's centre to the
// zenith minus that of the horizon. `change`: change of `over` along a segment; the result is the mean over the
// segment.
fn disc_share(over: f32, change: f32) -> f32 {
    let half = max(active_sun.radius_rad, 0.0015) + 0.5 * abs(change);
    return smoothstep(-half, half, over);
}
