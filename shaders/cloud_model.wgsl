// Density of the clouds: the cloud maps give the cover, and a tiling noise carves single clouds out of it.
#include "light.wgsl"
#include "nearness.wgsl"

// Rotates a position about the pole: the wind carries the cloud layer.
fn drifted(p: vec3f) -> vec3f {
    let c = body.cloud_drift.x;
    let s = body.cloud_drift.y;
    return vec3f(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
}

// Shift of look-ups in the cloud maps, texels over the noise.
const SHIFT: f32 = 3.5;

// The cloud maps at a direction from the centre.
struct Sky {
    // 0 clear, 1 overcast
    cover: f32,
    // Share of layered cloud; the rest is heaped up
    layered: f32,
    veil: f32,
}

// Cover where the rank of the noise is `rank` and the target cover has log-odds `odds`: `clouds/cover.rs`.
fn cover_of(rank: f32, odds: f32) -> f32 {
    let share = 1.0 / (1.0 + exp(-odds));
    let width = min(share, 1.0 - share);
    return saturate1((rank - 1.0 + share + width) / (2.0 * width + 1e-6));
}

// Shift of a look-up in the cloud maps, where their texels show: streaks thinner than a texel would be strings of
// beads.
fn shifted(dir: vec3f, texel_km: f32, footprint: f32) -> vec3f {
    let share = 1.0 - smoothstep(0.3, 1.0, footprint / texel_km);
    if NEARNESS == FROM_ORBIT || share <= 0.0 { return vec3f(0.0); }
    let band = body.cloud_bands[1];
    let rel = drifted(dir * body.radius_km - body.eye_km);
    let lod = log2(max(footprint * NOISE_TILE_SIDE / band.period, 1.0));
    let n = textureSampleLevel(noise_tile, repeated, band.offset + rel / band.period, lod).rg - 0.5;
    return vec3f(n, n.x - n.y) * (share * SHIFT * texel_km / body.radius_km);
}

// `footprint`: size in km below which nothing is resolved.
fn sky_over(dir: vec3f, footprint: f32) -> Sky {
    let texel_km = 0.5 * PI * body.radius_km / CLOUD_MAP_SIDE;
    let level = clamp(log2(max(footprint / texel_km, 1e-3)), body.cloud_least_level, CLOUD_MAP_LEVELS - 1.0);
    let odds = textureSampleLevel(cloud_maps, clamped, dir, 0, 0.0).r;
    let carried = drifted(dir) + shifted(dir, texel_km, footprint);
    var ranks = vec4f(0.0);
    if body.cloud_odd_share < 1.0 {
        ranks = textureSampleLevel(cloud_maps, clamped, carried, 1, level) * (1.0 - body.cloud_odd_share);
    }
    if body.cloud_odd_share > 0.0 {
        ranks += textureSampleLevel(cloud_maps, clamped, carried, 2, level) * body.cloud_odd_share;
    }
    var sky = Sky(0.0, ranks.g, 0.0);
    if body.cloud_coverage > 0.0 { sky.cover = cover_of(ranks.r, odds + body.cloud_offset); }
    if body.veil_coverage > 0.0 { sky.veil = cover_of(ranks.a, odds + body.veil_offset); }
    return sky;
}

// Density (0..1) at a point relative to the eye (km) and at a height in the layer (0..1), under the sky of its
// direction. `footprint`: size in km below which nothing is resolved; finer noise is replaced by its mean, and the edge
// widens.
fn cloud_density(rel: vec3f, sky: Sky, height: f32, footprint: f32) -> f32 {
    if sky.cover <= 0.0 { return 0.0; }
    var position = drifted(rel);
    // Bands coarser than a puff bend the cover, so that puffs gather in groups; finer bands carve the puffs.
    var bend = 0.0;
    var carve = 0.5;
    var strength = mix(1.0, 0.45, sky.layered);
    var blurred = 1.0;
    for (var i = 0; i < CLOUD_BANDS; i++) {
        let band = body.cloud_bands[i];
        let lod = log2(max(footprint * NOISE_TILE_SIDE / band.period, 1e-6));
        // A band fades out before its tile is small enough on screen for the repetition to show.
        var share = 1.0 - smoothstep(-1.0, 2.0, lod);
        if share <= 0.0 { break; }
        let n = textureSampleLevel(noise_tile, repeated, band.offset + position / band.period, lod);
        if i < CLOUD_PUFF_BAND {
            // The maps resolve coarser bands.
            share *= 1.0 - smoothstep(0.03, 0.08, band.period / body.radius_km);
            bend += (n.g - 0.5) * share * (0.9 - 0.1 * f32(i)) * mix(1.0, 0.6, sky.layered);
        } else {
            carve += (n.r - 0.5) * share * strength;
            strength *= 0.42;
            if i == CLOUD_PUFF_BAND { blurred = 1.0 - share; }
        }
        position = OCTAVE_TURN * position;
    }
    // The bend has no effect where the cover is 0 or 1.
    let cover = saturate1(sky.cover + 4.0 * bend * sky.cover * (1.0 - sky.cover));
    let n = clamp(carve - (1.0 - cover) * 0.55 * max(height - 0.25, 0.0), 0.0, 1.0);
    let width = mix(0.3, 0.55, sky.layered);
    // Even overcast cloud varies in thickness.
    let bulk = 0.5 + n + 2.0 * bend * cover;
    let sharp = saturate1((n - 1.0 + cover) / width + cover * cover * cover) * max(bulk, 0.25);
    // Puffs too small to resolve cover a share of the pixel. `mean` is the density with the same mean transmittance.
    let opaque = 1.0 - exp(-body.cloud_optical_depth);
    // Of a dense layer no light is left in 32 bits.
    let mean = -log(max(1.0 - cover * opaque, 1e-7)) / body.cloud_optical_depth;
    return mix(sharp, mean, blurred);
}

// Optical depth of the veil where it is closed, and the share of its scattered light that goes on so nearly straight
// that it counts as direct.
const VEIL_DEPTH: f32 = 0.6;
const VEIL_AHEAD: f32 = 0.5;

// Share of direct sunlight that the veil and the cloud layer transmit to a point below or within the layer. `rel`:
// point relative to the eye, km; `h`: its altitude, km.
fn cloud_shadow(rel: vec3f, h: f32, sun_mu: f32, footprint: f32) -> f32 {
    if max(body.cloud_coverage, body.veil_coverage) <= 0.0 || h >= body.cloud_top_km { return 1.0; }
    let radius = body.radius_km;
    let middle = 0.5 * (body.cloud_bottom_km + body.cloud_top_km);
    let at = max(h, middle);
    let path_km = max(ray_sphere((radius + h) * sun_mu, (h - at) * (2.0 * radius + h + at)).y, 0.0);
    let point = rel + active_sun.dir * path_km;
    let up = normalize(body.eye_km + point);
    let sky = sky_over(up, footprint);
    let density = cloud_density(point, sky, 0.5, max(footprint, body.cloud_puff_period_km * 0.02));
    let left = saturate1((body.cloud_top_km - h) / (body.cloud_top_km - body.cloud_bottom_km));
    let depth = body.cloud_optical_depth * density * left + VEIL_DEPTH * (1.0 - VEIL_AHEAD) * sky.veil;
    return exp(-depth / max(dot(up, active_sun.dir), 0.05));
}

// Two-stream estimate of light under clouds after multiple scattering. x: factor on the sky's irradiance; y: share of
// direct sunlight that arrives as diffuse light.
fn overcast(shadow: f32) -> vec2f {
    let spread = 1.0 / (1.0 + 0.12 * body.cloud_optical_depth);
    return vec2f(mix(mix(spread, 1.0, 0.35), 1.0, shadow), (1.0 - shadow) * spread);
}
