// Where clouds are: the weather map gives the cover, a tiling noise carves single clouds out of it.
#include "light.wgsl"

// The layer turns about the pole with the wind.
fn drifted(p: vec3f) -> vec3f {
    let c = globals.cloud_turn.x;
    let s = globals.cloud_turn.y;
    return vec3f(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
}

// Cover (0 clear, 1 closed) over a direction from the centre. The map is spread evenly over 0..1, so a threshold at
// 1 - coverage leaves that share of the sky.
fn cover_over(dir: vec3f) -> f32 {
    let weather = textureSampleLevel(weather_map, clamped, drifted(dir), 0.0).r;
    const SOFT: f32 = 0.4;
    return saturate1((weather - 1.0 + globals.clouds.z * (1.0 + SOFT)) / SOFT);
}

// Density (0..1) where the cover is `cover`, at a point relative to the eye (km) and a height in the layer (0..1).
// `footprint`: size in km below which nothing is resolved; there the noise is its mean and the edge widens instead.
fn cloud_density(rel: vec3f, wide_cover: f32, height: f32, footprint: f32) -> f32 {
    if wide_cover <= 0.0 { return 0.0; }
    let period = globals.clouds.w;
    // Puffs gather in groups, so that their tile does not show. Nothing changes where all or nothing is covered.
    let group_lod = log2(max(footprint * 64.0 / (period * 7.0), 1e-6));
    var cover = wide_cover;
    if group_lod < 6.0 {
        let group = globals.cloud_eye_wide.xyz + drifted(rel).yzx / (period * 7.0);
        let bend = 1.5 * (textureSampleLevel(noise_tile, repeated, group, group_lod).g - 0.5);
        // The tile fades before it is so small that one sees it repeat.
        let strength = 2.0 * (1.0 - smoothstep(0.5, 3.0, group_lod));
        cover = saturate1(cover + bend * cover * (1.0 - cover) * strength);
    }
    let place = globals.cloud_eye.xyz + drifted(rel) / period;
    let lod = log2(max(footprint * 64.0 / period, 1e-6));
    var n = 0.5;
    var blurred = 1.0;
    if lod < 6.0 {
        blurred = smoothstep(0.5, 4.0, lod);
        n = textureSampleLevel(noise_tile, repeated, place, lod).r;
        let fine = lod + 2.32;
        if fine < 5.0 {
            n += 0.45 * (textureSampleLevel(noise_tile, repeated, place * 5.0, fine).r - 0.5);
            if fine < 2.0 {
                n += 0.2 * (textureSampleLevel(noise_tile, repeated, place * 23.0, fine + 2.2).r - 0.5);
            }
        }
    }
    n -= (1.0 - cover) * 0.55 * max(height - 0.25, 0.0);
    n = clamp(n, 0.0, 1.0);
    const WIDTH: f32 = 0.3;
    let sharp = saturate1((n - 1.0 + cover) / WIDTH + cover * cover * cover);
    // Puffs too small to see cover a share of the pixel: the density that lets through as much as they do together.
    let opaque = 1.0 - exp(-globals.cloud_color.w);
    let mean = -log(1.0 - cover * opaque) / globals.cloud_color.w;
    return mix(sharp, mean, blurred);
}

// Share of direct starlight that the layer lets through to a point under (or in) it; the point relative to the eye.
fn cloud_shadow(rel: vec3f, h: f32, sun_mu: f32, footprint: f32) -> f32 {
    if globals.clouds.z <= 0.0 || h >= globals.clouds.y { return 1.0; }
    let radius = globals.eye_km.w;
    let middle = 0.5 * (globals.clouds.x + globals.clouds.y);
    let at = max(h, middle);
    let way = max(ray_sphere((radius + h) * sun_mu, (h - at) * (2.0 * radius + h + at)).y, 0.0);
    let point = rel + globals.sun_dir.xyz * way;
    let up = normalize(globals.eye_km.xyz + point);
    let density = cloud_density(point, cover_over(up), 0.5, max(footprint, globals.clouds.w * 0.02));
    let left = saturate1((globals.clouds.y - h) / (globals.clouds.y - globals.clouds.x));
    return exp(-globals.cloud_color.w * density * left / max(dot(up, globals.sun_dir.xyz), 0.05));
}

// Light that clouds above pass on after many scatterings, as a factor on the sky's irradiance and a share of direct light:
// a two-stream estimate (x: what is left of the sky, y: share of direct light that arrives as skylight).
fn overcast(shadow: f32) -> vec2f {
    let spread = 1.0 / (1.0 + 0.12 * globals.cloud_color.w);
    return vec2f(mix(mix(spread, 1.0, 0.35), 1.0, shadow), (1.0 - shadow) * spread);
}
