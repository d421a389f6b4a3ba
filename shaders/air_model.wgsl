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

// Density of haze at an altitude, as a share of that at the reference sphere.
fn haze_density(height: f32) -> f32 { return exp(-height / body.mie_scale_km); }

// Scattering and extinction per km at an altitude.
fn air_at(h: f32) -> Air {
    let height = max(h, 0.0);
    let rayleigh = body.rayleigh_per_km * exp(-height / body.rayleigh_scale_km);
    let haze = haze_density(height);
    let from_absorber = abs(height - body.absorber_height_km) / body.absorber_width_km;
    let absorber = body.absorber_per_km * max(0.0, 1.0 - from_absorber);
    var air: Air;
    air.rayleigh = rayleigh;
    air.mie = body.mie_scattering_per_km * haze;
    air.extinction = rayleigh + body.mie_extinction_per_km * haze + absorber;
    return air;
}

// Share of light scattered by haze that is in the forward peak: the fourth moment of the phase function of Henyey and
// Greenstein. Light in the peak counts as not scattered (delta-M method: Wiscombe, The delta-M method, 1977).
fn haze_peak() -> f32 {
    let g = max(body.mie_anisotropy, 0.0);
    return g * g * g * g;
}

// The air with haze that does not scatter its forward peak.
fn without_peak(air: Air) -> Air {
    let peak = air.mie * haze_peak();
    return Air(air.rayleigh, air.mie - peak, air.extinction - peak);
}

// Moments of the Mie phase function: the means of the first two Legendre polynomials of the cosine.
fn haze_moments() -> vec2f {
    let g = body.mie_anisotropy;
    let g2 = g * g;
    let squared = 1.5 / (2.0 + g2) * ((2.0 * g2 + 1.0) / 3.0 + (8.0 * g2 * g2 + 20.0 * g2 + 7.0) / 35.0);
    return vec2f(0.6 * g * (4.0 + g2) / (2.0 + g2), 1.5 * squared - 0.5);
}

// The moments without the forward peak, of what remains.
fn haze_moments_without_peak() -> vec2f {
    let peak = haze_peak();
    return (haze_moments() - peak) / (1.0 - peak);
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

// Phase function of Henyey and Greenstein, Diffuse radiation in the galaxy, 1941. `g`: the mean cosine.
fn henyey_greenstein(g: f32, cosine: f32) -> f32 {
    let base = max(1.0 + g * g - 2.0 * g * cosine, 1e-6);
    return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
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
