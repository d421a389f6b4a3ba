// Density of the clouds: the weather map gives the cover, and a tiling noise carves single clouds out of it.
#include "light.wgsl"
#include "cloud_cover.wgsl"

// Rotates a position about the pole: the wind carries the cloud layer.
fn drifted(p: vec3f) -> vec3f {
    let c = body.cloud_drift.x;
    let s = body.cloud_drift.y;
    return vec3f(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
}

// Cover (0 clear, 1 overcast) in a direction from the centre. Cloudiness is distributed evenly over 0..1, so that a
// threshold at 1 - coverage leaves that share of the sky clouded.
fn cover_over(dir: vec3f) -> f32 {
    var weather = textureSampleLevel(weather_map, clamped, drifted(dir), 0.0).r;
    if body.weather_share > 0.0 {
        weather = evenly(weather + textureSampleLevel(weather_map, clamped, dir, 0.0).g);
    }
    const SOFT: f32 = 0.7;
    let cover = saturate1((weather - 1.0 + body.cloud_coverage * (1.0 + SOFT)) / SOFT);
    return cover * cover * (3.0 - 2.0 * cover);
}

// Density (0..1) at a point relative to the eye (km) and at a height in the layer (0..1), where the weather map gives
// `wide_cover`. `footprint`: size in km below which nothing is resolved; finer noise is replaced by its mean, and the
// edge widens.
fn cloud_density(rel: vec3f, wide_cover: f32, height: f32, footprint: f32) -> f32 {
    if wide_cover <= 0.0 { return 0.0; }
    var position = drifted(rel);
    // Bands coarser than a puff bend the cover, so that puffs gather in groups; finer bands carve the puffs.
    var bend = 0.0;
    var carve = 0.5;
    var strength = 1.0;
    var blurred = 1.0;
    for (var i = 0; i < CLOUD_BANDS; i++) {
        let band = body.cloud_bands[i];
        let lod = log2(max(footprint * NOISE_TILE_SIDE / band.period, 1e-6));
        // A band fades out before its tile is small enough on screen for the repetition to show.
        let share = 1.0 - smoothstep(-1.0, 2.0, lod);
        if share <= 0.0 { break; }
        let n = textureSampleLevel(noise_tile, repeated, band.offset + position / band.period, lod);
        if i < CLOUD_PUFF_BAND {
            bend += (n.g - 0.5) * share * (0.9 - 0.1 * f32(i));
        } else {
            carve += (n.r - 0.5) * share * strength;
            strength *= 0.42;
            if i == CLOUD_PUFF_BAND { blurred = 1.0 - share; }
        }
        position = OCTAVE_TURN * position;
    }
    // The bend has no effect where the cover is 0 or 1.
    let cover = saturate1(wide_cover + 4.0 * bend * wide_cover * (1.0 - wide_cover));
    let n = clamp(carve - (1.0 - cover) * 0.55 * max(height - 0.25, 0.0), 0.0, 1.0);
    const WIDTH: f32 = 0.3;
    // Even overcast cloud varies in thickness.
    let bulk = 0.5 + n + 2.0 * bend * cover;
    let sharp = saturate1((n - 1.0 + cover) / WIDTH + cover * cover * cover) * max(bulk, 0.25);
    // Puffs too small to resolve cover a share of the pixel. `mean` is the density with the same mean transmittance.
    let opaque = 1.0 - exp(-body.cloud_optical_depth);
    let mean = -log(1.0 - cover * opaque) / body.cloud_optical_depth;
    return mix(sharp, mean, blurred);
}

// Share of direct sunlight that the cloud layer transmits to a point below or within it. `rel`: point relative to the
// eye, km; `h`: its altitude, km.
fn cloud_shadow(rel: vec3f, h: f32, sun_mu: f32, footprint: f32) -> f32 {
    if body.cloud_coverage <= 0.0 || h >= body.cloud_top_km { return 1.0; }
    let radius = body.radius_km;
    let middle = 0.5 * (body.cloud_bottom_km + body.cloud_top_km);
    let at = max(h, middle);
    let path_km = max(ray_sphere((radius + h) * sun_mu, (h - at) * (2.0 * radius + h + at)).y, 0.0);
    let point = rel + active_sun.dir * path_km;
    let up = normalize(body.eye_km + point);
    let density = cloud_density(point, cover_over(up), 0.5, max(footprint, body.cloud_puff_period_km * 0.02));
    let left = saturate1((body.cloud_top_km - h) / (body.cloud_top_km - body.cloud_bottom_km));
    return exp(-body.cloud_optical_depth * density * left / max(dot(up, active_sun.dir), 0.05));
}

// Two-stream estimate of light under clouds after multiple scattering. x: factor on the sky's irradiance; y: share of
// direct sunlight that arrives as diffuse light.
fn overcast(shadow: f32) -> vec2f {
    let spread = 1.0 / (1.0 + 0.12 * body.cloud_optical_depth);
    return vec2f(mix(mix(spread, 1.0, 0.35), 1.0, shadow), (1.0 - shadow) * spread);
}
