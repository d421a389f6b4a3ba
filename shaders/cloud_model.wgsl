// Density of the clouds: the cloud maps give the cover, and a tiling noise carves single clouds out of it.
#include "light.wgsl"
#include "nearness.wgsl"

// Rotates a position about the pole: the wind carries the clouds.
fn drifted(p: vec3f) -> vec3f {
    let c = body.cloud_drift.x;
    let s = body.cloud_drift.y;
    return vec3f(c * p.x + s * p.y, c * p.y - s * p.x, p.z);
}

// Shift of look-ups in the cloud maps, periods of a band. More would fold the maps: every cloud would have loops for
// borders.
const SHIFT: f32 = 0.1;

// The cloud maps at a direction from the centre.
struct Sky {
    // Of the layers, 0 clear, 1 overcast: fog, rain, low clouds, middle clouds
    covers: vec4f,
    veil: f32,
    // Share of layered cloud among low clouds; the rest is heaped up
    layered: f32,
    // Height of the tops of low clouds, 0 to 1 in the layer
    top: f32,
}

// Cover where the rank of the noise is `rank` and the target cover has log-odds `odds`: `clouds/cover.rs`.
fn cover_of(rank: vec4f, odds: vec4f) -> vec4f {
    let share = 1.0 / (1.0 + exp(-odds));
    let width = min(share, 1.0 - share);
    return clamp((rank - 1.0 + share + width) / (2.0 * width + 1e-6), vec4f(0.0), vec4f(1.0));
}

// Shift of a look-up in the cloud maps, where their texels show: streaks thinner than a texel would be strings of
// beads.
fn shifted(dir: vec3f, texel_km: f32, footprint: f32) -> vec3f {
    let share = 1.0 - smoothstep(0.3, 1.0, footprint / texel_km);
    if NEARNESS == FROM_ORBIT || share <= 0.0 { return vec3f(0.0); }
    var position = drifted(dir * body.radius_km - body.eye_km);
    var shift = vec3f(0.0);
    for (var i = 0u; i < 2u; i++) {
        let band = body.cloud_bands[i];
        let lod = log2(max(footprint * NOISE_TILE_SIDE / band.period, 1.0));
        let n = textureSampleLevel(noise_tile, repeated, band.offset + position / band.period, lod).rg - 0.5;
        shift += vec3f(n, n.x - n.y) * min(SHIFT * band.period, 2.0 * texel_km);
        position = OCTAVE_TURN * position;
    }
    return shift * (share / body.radius_km);
}

// Tops of decks and of small heaps where thunderclouds tower over them, 0 to 1 in the layer.
const DECK_TOP: f32 = 0.28;
const HEAP_TOP: f32 = 0.4;
// Cover from which heaps grow into thunderclouds, and at which they have grown up.
const GROWING: f32 = 0.6;
const GROWN: f32 = 1.0;
// Cover from which rain falls.
const RAINING: f32 = 0.65;

// Width of a texel of the cloud maps.
fn cloud_texel_km() -> f32 { return 0.5 * PI * body.radius_km / CLOUD_MAP_SIDE; }

fn sky_between(a: Sky, b: Sky, share: f32) -> Sky {
    return Sky(
        mix(a.covers, b.covers, share),
        mix(a.veil, b.veil, share),
        mix(a.layered, b.layered, share),
        mix(a.top, b.top, share),
    );
}

// `footprint`: size in km below which nothing is resolved.
fn sky_over(dir: vec3f, footprint: f32) -> Sky {
    let texel_km = cloud_texel_km();
    let level = clamp(log2(max(footprint / texel_km, 1e-3)), body.cloud_least_level, CLOUD_MAP_LEVELS - 1.0);
    let shift = shifted(dir, texel_km, footprint);
    let ground = textureSampleLevel(cloud_maps, clamped, dir + shift, 0, body.cloud_least_level);
    let carried = drifted(dir) + shift;
    var ranks = vec4f(0.0);
    if body.cloud_odd_share < 1.0 {
        ranks = textureSampleLevel(cloud_maps, clamped, carried, 1, level) * (1.0 - body.cloud_odd_share);
    }
    if body.cloud_odd_share > 0.0 {
        ranks += textureSampleLevel(cloud_maps, clamped, carried, 2, level) * body.cloud_odd_share;
    }
    let odds = vec4f(ground.rrr, ground.b) + body.cloud_offsets;
    // Low clouds, middle clouds, veil, fog
    let asked = vec4f(body.cloud_coverages > vec4f(0.0));
    let covers = cover_of(vec4f(ranks.rba, ground.a), odds) * asked;
    let kind = body.cloud_layering;
    let layered = mix(ranks.g, step(0.0, kind), abs(kind));
    let thunder = (1.0 - layered) * smoothstep(GROWING, GROWN, covers.x);
    let top = mix(1.0, mix(mix(HEAP_TOP, DECK_TOP, layered), 1.0, thunder), body.cloud_towers);
    // Small rain from decks, showers from thunderclouds.
    let rain = smoothstep(RAINING, 1.0, covers.x);
    return Sky(vec4f(covers.w, rain, covers.xy), covers.z, layered, top);
}

// Logarithm of the ratio of the optical depths of thick and thin columns of one cloud.
const SPREAD: f32 = 2.0;
// Optical depth of columns over that of the layer, at the edge of weather systems and in their middle.
const THIN: f32 = 0.28;
const THICK: f32 = 1.0;
// How the optical depth of columns varies with the cells of a weather system, as the exponent of the noise of bands
// coarser than puffs: from afar, they are the only texture of a closed cover. By eye.
const TONE: f32 = 2.0;
// Levels of detail of a puff between which that sets in: from near, puffs are texture enough.
const TONE_LODS: vec2f = vec2f(-1.5, 0.0);
// Height of the base of anvils in the layer, and heights within which it blurs.
const ANVIL_BASE: f32 = 0.78;
const ANVIL_EDGE: f32 = 0.08;
// Covers at the base of the layer from which anvils begin, and at which they are closed.
const ANVIL_COVERS: vec2f = vec2f(0.35, 0.7);

// Heights of the tops of anvils, for the lowest and the highest noise.
const ANVIL_TOPS: vec2f = vec2f(0.84, 1.08);
// Share of the ground under closed clouds on which rain falls, so that its shafts are seen apart.
const CLOSED_RAIN: f32 = 0.5;
// How far shafts of rain lean back at the ground, in heights of the rain: wind grows with height.
const LEAN: f32 = 0.35;
// Optical depth of shafts over the mean of rain.
const SHAFT: f32 = 5.0;

// Middle clouds that are heaped are fields of cells: shares of the noise that groups them and of that which makes them.
const CELL_GROUPS: f32 = 0.55;
const CELLS: f32 = 0.65;
// How far the seams between cells fill where the cover is closed, against decks.
const CELLS_CLOSED: f32 = 0.3;

// Clouds are thin at their borders: their density rises from 0 without a kink. `x`: distance from the border, 0 to 1.
fn thickened(x: f32) -> f32 { return x * x * (2.0 - x); }
// The distance from the border by which `thickened` shrinks dense clouds.
const SHRUNK: f32 = 0.08;

// A cloud at a point.
struct Cloud {
    // Over that of closed cloud; more where the layer's depth is squeezed into less than its thickness
    density: f32,
    // Optical depth of the column through the point over that of closed cloud
    column: f32,
}

// The cloud at a point relative to the eye (km) and at a height in the layer (0..1), under the sky of its direction.
// `footprint`: size in km below which nothing is resolved; finer noise is replaced by its mean, and the edge widens.
// `extent`: heights over which the density is a mean, so that few steps do not miss a thin anvil.
fn cloud_at(number: u32, rel: vec3f, sky: Sky, height: f32, extent: f32, footprint: f32) -> Cloud {
    var cover = sky.covers[number];
    if cover <= 0.0 { return Cloud(0.0, 0.0); }
    let layered = vec4f(1.0, 0.0, sky.layered, 0.6 * sky.layered)[number];
    var place = rel;
    if number == RAIN_LAYER {
        // Shafts are the same from the cloud down, and lean back.
        let rain = body.cloud_layers[RAIN_LAYER];
        let up = (body.eye_km + rel) / body.radius_km;
        let fallen = 1.0 - height;
        let lean = LEAN * fallen * fallen * vec3f(-up.y, up.x, 0.0);
        place += (lean - height * up) * (rain.top_km - rain.bottom_km);
        cover *= CLOSED_RAIN;
    }
    var position = drifted(place);
    // Bands coarser than a puff bend the cover, so that puffs gather in groups; finer bands carve the puffs.
    var bend = 0.0;
    // Cells are the heaps of the coarser bands.
    var carve = 0.5;
    var cells = 0.0;
    var weight = 0.9;
    let is_middle = number == MIDDLE_LAYER;
    var strength = mix(1.0, 0.45, layered);
    var finer = 0.42;
    if is_middle {
        // Lumps take over where cells are too small to resolve, so that their noise spreads as widely.
        let cell = body.cloud_bands[body.cloud_layers[number].end_band - 1u];
        let lost = smoothstep(-0.5, 2.6, log2(max(footprint * NOISE_TILE_SIDE / cell.period, 1e-6)));
        let lumps = mix(CELL_GROUPS, 1.0, lost);
        strength = mix(lumps, 0.45, layered);
        finer = mix(CELLS / lumps, 0.42, layered);
    }
    var blurred = 1.0;
    var afar = 1.0;
    let end = body.cloud_layers[number].end_band;
    let puff = body.cloud_layers[number].puff_band;
    for (var i = body.cloud_layers[number].first_band; i < end; i++) {
        let band = body.cloud_bands[i];
        let lod = log2(max(footprint * NOISE_TILE_SIDE / band.period, 1e-6));
        // A band fades out before its tile is small enough on screen for the repetition to show.
        var share = 1.0 - smoothstep(-0.5, 2.6, lod);
        if share <= 0.0 { break; }
        let n = textureSampleLevel(noise_tile, repeated, band.offset + position / band.period, lod);
        if i < puff {
            // The maps resolve coarser bands.
            share *= 1.0 - smoothstep(0.03, 0.08, band.period / body.radius_km);
            bend += (n.g - 0.5) * share * weight * mix(1.0, 0.6, layered);
            cells += (n.r - 0.5) * share * weight;
            weight -= 0.1;
        } else {
            carve += (n.r - 0.5) * share * strength;
            strength *= finer;
            if i == puff {
                blurred = 1.0 - share;
                afar = smoothstep(TONE_LODS.x, TONE_LODS.y, lod);
            }
        }
        position = OCTAVE_TURN * position;
        if is_middle && i == puff { position = ROWS * position; }
    }
    // The bend has no effect where the cover is 0 or 1.
    let base = saturate1(cover + 4.0 * bend * cover * (1.0 - cover));
    let depth = body.cloud_layers[number].optical_depth;
    // Low clouds: flat bases, heaps that narrow upwards, anvils over thunderclouds.
    let risen = height / sky.top;
    let reach = 0.5 * max(extent, ANVIL_EDGE);
    let low = max(height - reach, 0.0);
    let high = min(height + reach, 1.0);
    let anvil_top = mix(ANVIL_TOPS.x, ANVIL_TOPS.y, carve);
    let anvil = body.cloud_towers * (1.0 - layered)
        * saturate1((min(high, anvil_top) - max(low, ANVIL_BASE)) / (high - low))
        * smoothstep(ANVIL_COVERS.x, ANVIL_COVERS.y, base);
    var narrowed = 0.55 * max(risen - 0.25, 0.0);
    // Tops of decks and of small heaps are uneven; the ice of an anvil is thin.
    let under = (1.02 + 0.5 * (carve - 0.5) - risen) / (0.17 + extent / sky.top);
    var envelope = max(saturate1(under + 0.5) / sky.top, 0.45 * anvil);
    if is_middle {
        let off = 2.0 * height - 1.0;
        narrowed = 0.6 * off * off;
        envelope = 1.0;
    } else if number == FOG_LAYER {
        narrowed = 0.0;
        // Its top waves.
        envelope = saturate1((0.55 + 0.6 * carve - height) * 3.0);
    } else if number == RAIN_LAYER {
        narrowed = 0.0;
        // It thins out as it falls; light rain does not reach the ground.
        envelope = (0.4 + 0.6 * height) * saturate1(1.5 * height + 2.5 * (carve - 0.25));
    }
    if body.cloud_towers <= 0.0 && number == LOW_LAYER { envelope = 1.0; }
    cover = mix(base, max(base, anvil), f32(number == LOW_LAYER));
    let n = clamp(carve - (1.0 - cover) * narrowed, 0.0, 1.0);
    // Thin layers are wispy: their clouds have no borders.
    let wispy = exp(-0.25 * depth);
    let width = select(mix(mix(0.3, 0.55, layered), 1.2, wispy), 0.3, number == RAIN_LAYER);
    // Even overcast cloud varies in thickness. Optical depths are distributed log-normally (Barker, Wielicki, Parker, A
    // parameterization for computing grid-averaged solar fluxes, 1996).
    let bulk = select(exp(SPREAD * (n - 0.5 + bend * cover)), SHAFT, number == RAIN_LAYER);
    let fills = vec4f(1.0, 0.0, 1.0, mix(CELLS_CLOSED, 1.0, layered))[number];
    let closed = fills * cover * cover * cover + SHRUNK * saturate1(10.0 * cover);
    let sharp = thickened(saturate1((n - 1.0 + cover) / width + closed)) * bulk;
    let column = thickened(saturate1((carve - 1.0 + cover) / width + closed)) * bulk;
    let tone = exp(TONE * afar * (cells + bend));
    // Puffs too small to resolve cover a share of the pixel. `mean` is the density with the same mean transmittance.
    let opaque = 1.0 - exp(-depth);
    // Of a dense layer no light is left in 32 bits.
    let mean = -log(max(1.0 - cover * opaque, 1e-7)) / depth;
    let mapped = sky.covers[number];
    let thickness = mix(THIN, THICK, mapped * mapped);
    return Cloud(mix(sharp, mean, blurred) * envelope, mix(column, 1.0, blurred) * thickness * tone);
}

// Share of the veil's scattered light that goes on so nearly straight that it counts as direct.
const VEIL_AHEAD: f32 = 0.5;

// Optical depth with the mean transmittance of clouds that cover a share of the sky: gaps let through more than a mean
// depth would.
fn with_gaps(depth: f32, cover: f32) -> f32 { return -log(max(1.0 - cover * (1.0 - exp(-depth)), 1e-7)); }

// Optical depth of the layers over a layer: of a number, from above. `path`: length of rays through a layer over its
// thickness.
fn depth_over(number: u32, sky: Sky, path: f32) -> f32 {
    let low = with_gaps(body.cloud_layers[LOW_LAYER].optical_depth * path, sky.covers[LOW_LAYER]);
    let middle = with_gaps(body.cloud_layers[MIDDLE_LAYER].optical_depth * path, sky.covers[MIDDLE_LAYER]);
    let veil = with_gaps(body.veil_depth * (1.0 - VEIL_AHEAD) * path, sky.veil);
    return veil + select(0.0, middle, number < MIDDLE_LAYER) + select(0.0, low, number < LOW_LAYER);
}

// Mean optical depth of the low clouds under a layer: of a number.
fn depth_beneath(number: u32, sky: Sky) -> f32 {
    let low = body.cloud_layers[LOW_LAYER].optical_depth * sky.covers[LOW_LAYER];
    return select(0.0, low, number == MIDDLE_LAYER);
}

// Share of light that a layer of an optical depth lets through, most of it diffuse: two-stream estimate.
fn let_through(depth: f32) -> f32 { return 1.0 / (1.0 + 0.12 * depth); }

// The same for a layer that covers a share of the sky.
fn let_through_gaps(depth: f32, cover: f32) -> f32 { return 1.0 - cover * (1.0 - let_through(depth)); }

// Share of light that the layers over a layer let through, most of it diffuse.
fn passed_over(number: u32, sky: Sky) -> f32 {
    let low = let_through_gaps(body.cloud_layers[LOW_LAYER].optical_depth, sky.covers[LOW_LAYER]);
    let middle = let_through_gaps(body.cloud_layers[MIDDLE_LAYER].optical_depth, sky.covers[MIDDLE_LAYER]);
    let veil = let_through_gaps(body.veil_depth * (1.0 - VEIL_AHEAD), sky.veil);
    return veil * select(1.0, middle, number < MIDDLE_LAYER) * select(1.0, low, number < LOW_LAYER);
}

// Light that arrives under clouds, as shares of that without them.
struct UnderClouds {
    // Of direct sunlight: what arrives straight
    straight: f32,
    // Of all light: what arrives straight or diffuse
    passed: f32,
    // Means of both over the clouds around
    straight_around: f32,
    passed_around: f32,
    // Of light that the ground sends up: what fog sends back to it, where the pixel is so wide that the ground around
    // counts. Without it fog over snow would be darker than snow.
    returned: f32,
}

const NO_CLOUDS: UnderClouds = UnderClouds(1.0, 1.0, 1.0, 1.0, 0.0);

// Widths of a pixel over the height of a cloud between which it shows the ground in light that the cloud scatters on
// its way: that light comes from as far around as the cloud is high.
const SPREAD_WIDTHS: vec2f = vec2f(0.1, 0.5);

fn spread_over(footprint: f32, height: f32) -> f32 {
    return smoothstep(SPREAD_WIDTHS.x, SPREAD_WIDTHS.y, footprint / max(height, 0.01));
}

// The light of the active sun under clouds. `rel`: point relative to the eye, km; `h`: altitude, km.
fn under_clouds(rel: vec3f, h: f32, sun_mu: f32, footprint: f32) -> UnderClouds {
    if sun_mu < -0.1 || all(body.cloud_coverages <= vec4f(0.0)) || h >= body.cloud_top_km { return NO_CLOUDS; }
    let radius = body.radius_km;
    let low = body.cloud_layers[LOW_LAYER];
    let middle = 0.5 * (low.bottom_km + low.top_km);
    let at = max(h, middle);
    let path_km = max(ray_sphere((radius + h) * sun_mu, (h - at) * (2.0 * radius + h + at)).y, 0.0);
    let point = rel + active_sun.dir * path_km;
    let up = normalize(body.eye_km + point);
    let sky = sky_over(up, footprint);
    let band_km = body.cloud_bands[low.puff_band].period;
    let density = cloud_at(LOW_LAYER, point, sky, 0.5 * sky.top, 0.0, max(footprint, band_km * 0.02)).density;
    let left = saturate1((low.top_km - h) / (low.top_km - low.bottom_km));
    let fog = body.cloud_layers[FOG_LAYER];
    let fog_left = saturate1((fog.top_km - h) / (fog.top_km - fog.bottom_km));
    let path = 1.0 / max(dot(up, active_sun.dir), 0.05);

    let fog_depth = fog.optical_depth * fog_left;
    let others = exp(-depth_over(LOW_LAYER, sky, path) - with_gaps(fog_depth * path, sky.covers[FOG_LAYER]));
    let fog_passes = let_through_gaps(fog_depth, sky.covers[FOG_LAYER]);
    let others_pass = fog_passes * passed_over(LOW_LAYER, sky);
    let cover = sky.covers[LOW_LAYER];
    let depths = low.optical_depth * left * vec2f(density * sky.top, 1.0);
    let through = exp(-depths * path);
    var out: UnderClouds;
    out.straight = through.x * others;
    out.straight_around = (1.0 - cover * (1.0 - through.y)) * others;
    out.passed = let_through_gaps(depths.y, 1.0 - through.x) * others_pass;
    out.passed_around = let_through_gaps(depths.y, cover) * others_pass;
    out.returned = (1.0 - fog_passes) * spread_over(footprint, fog.top_km - h);
    return out;
}

// Light under clouds after multiple scattering. x: factor on the sky's irradiance; y: share of direct sunlight that
// arrives as diffuse light.
fn overcast(straight: f32, passed: f32) -> vec2f { return vec2f(mix(passed, 1.0, 0.35), max(passed - straight, 0.0)); }
