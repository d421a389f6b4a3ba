// Clouds: marches through spherical shells, the same from below, within and above. Writes the radiance of the clouds
// (without the air in front of them), their transmittance, and their mean distance for air.wgsl.
#include "surface.wgsl"
#include "cloud_model.wgsl"

// Phase function of Henyey and Greenstein, Diffuse radiation in the galaxy, 1941.
fn lobe(cosine: f32, g: f32) -> f32 {
    let base = 1.0 + g * g - 2.0 * g * cosine;
    return (1.0 - g * g) / (4.0 * PI * base * sqrt(base));
}

// Factor on direct light: with it, a closed layer seen from above reflects the share that Lacis and Hansen (A
// parameterization for the absorption of solar radiation, 1974) give for its optical depth.
const BRIGHTNESS: f32 = 1.8;

// Light sent back upwards by a column of an optical depth, over that of a thick layer, of which BRIGHTNESS is.
fn sent_back(depth: f32) -> f32 {
    let turned = 0.13 * depth;
    return 1.087 * turned / (1.0 + turned);
}

// Height of tops over the optical depth of their column, by the layer's thickness.
const RELIEF: f32 = 0.5;
// Sine of the sun's elevation below which slopes of tops are lit as at this sine, and limits of their factor on light.
// A low sun would make every slope black or glaring.
const RELIEF_LEAST_SUN: f32 = 0.15;
const RELIEF_LIMITS: vec2f = vec2f(0.3, 1.5);

// Albedo of the ground over that of the preset, which counts clouds in.
const GROUND_UNDER_CLOUDS: f32 = 0.5;
// How much steps through rain grow, 0 to 1.
const RAIN_BEND: f32 = 0.2;
// Share of the light under clouds that is left where it rains: there the clouds are thicker than their mean.
const RAIN_SHADE: f32 = 0.5;
// Height of cloud tops over the bottom of the layer, by the layer's thickness: closed cover towers.
const TOWER: f32 = 2.0;
// Distances to the sun's side at which tops may cast shade, radians along the ground.
const SHADE_RAD: vec4f = vec4f(0.002, 0.005, 0.01, 0.02);

// Share of sunlight that neighbouring tops leave, from afar, where the march does not resolve them: a short march in
// the cloud map, towards the sun.
fn shade(rel: vec3f, cover: f32, sun_mu: f32, footprint: f32) -> f32 {
    if body.cloud_is_far == 0u || sun_mu < -0.1 || sun_mu > 0.7 { return 1.0; }
    let low = body.cloud_layers[LOW_LAYER];
    let thickness = TOWER * (low.top_km - low.bottom_km);
    var covered = 0.0;
    for (var i = 0; i < 4; i++) {
        let away_km = SHADE_RAD[i] * body.radius_km;
        let there = normalize(body.eye_km + rel + active_sun.dir * away_km);
        // How much higher tops are there than the ray from here to the sun.
        let rise = away_km * max(sun_mu, 0.0) + 0.5 * away_km * SHADE_RAD[i];
        covered = max(covered, saturate1((sky_over(there, footprint).covers[LOW_LAYER] - cover - rise / thickness) * 2.5));
    }
    return 1.0 - 0.8 * covered * (1.0 - smoothstep(0.3, 0.7, sun_mu));
}

// Jitter of a pixel, 0 to 1. Any 3x3 pixels have one value in each ninth, so that their mean (air.wgsl) has no pattern.
fn jitter_of(pixel: vec2f) -> f32 {
    return fract((dot(place_from_axis(pixel), vec2f(3.0, 7.0)) + 0.5) / 9.0 + frame.noise_shift);
}

// Where in its pixel a ray is marched, pixels from the middle. Any 3x3 pixels together have a ray in each ninth, so
// that their mean smooths the edges of clouds: between rays through the middles it would only blur stairs.
fn aside_of(pixel: vec2f) -> vec2f {
    // Clouds that are carried over are those of whole pixels. The frames of a still picture have places of their own.
    // From afar the maps are blurred to pixels already.
    if body.march_block > 1u || frame.still_number > 1u || body.cloud_is_far != 0u { return vec2f(0.0); }
    let place = place_from_axis(pixel);
    return (place.yx - 3.0 * floor(place.yx / 3.0) - 1.0) / 3.0;
}

// Density below which there is no cloud.
const LEAST_DENSITY: f32 = 0.004;
// Width of what a step resolves, in steps. Low quality has few and long ones: with as much blur they would dissolve
// puffs that are many pixels wide. The mean over the jitter of pixels shows them; less blur is grain.
const BLUR: f32 = 0.45;
const LOW_BLUR: f32 = 0.25;
const RAIN_BLUR: f32 = 0.06;
// Middle clouds are a thin layer of small cells: steps of a ray at a slant are longer than cells are wide.
const MIDDLE_BLUR: f32 = 0.08;
// How much the tone of thin cloud over thick cloud follows the thin one, 0 to 1: decks have a texture of their own.
const DECK_TONE: f32 = 0.8;
// Optical depth of the first part of a step within a cloud: most light comes from it.
const FIRST_PART: f32 = 1.5;
// Limits of the exponent that shortens the first parts of a step.
const SHORTENING: vec2f = vec2f(1.5, 3.0);
// Halvings of a step to find where a ray enters a cloud: at low quality, at the others.
const SEARCH: vec2i = vec2i(2, 3);
// Longest way over which the sky is taken to vary evenly, by its distance. A texel of the cloud maps is another limit.
const SHORT_WAY: f32 = 0.25;

// A ray through a layer.
struct Way {
    dir: vec3f,
    // Sine of the ray over the horizon of the eye
    eye_mu: f32,
    from_km: f32,
    to_km: f32,
    // Way in the layer to its other side, or to the lowest point of a ray that leaves it by the side where it entered
    turn_km: f32,
    layer: u32,
}

// The steps of a ray through a layer.
struct Grid {
    // Distance of bound `i`: base_km + scale_km * (exp2((first + i) * growth) - 1), mixed with even steps
    base_km: f32,
    scale_km: f32,
    growth: f32,
    first: f32,
    // Length and share of even steps
    even_km: f32,
    even_share: f32,
    // Length of a step over its distance plus scale_km, by which the density is blurred
    wanted: f32,
    // Where light reaches the layer
    middle_km: f32,
}

// From within the layer, steps are the same in all directions and grow by a constant ratio. Those that depend on the
// distance to the far end would be longest along the horizon and show as a line there. From outside, the ratio is less
// by a power of two, so that the way has about as many steps in each direction. Bounds are at the same distances in
// neighbouring pixels, wherever these enter the layer: else whole rows of pixels would sample clouds at one distance,
// and show them in stripes.
fn grid_of(layer: CloudLayer, way: Way) -> Grid {
    let span = way.to_km - way.from_km;
    let ratio = log2(layer.stride.y);
    let scale_km = layer.stride.x / (layer.stride.y - 1.0);
    let near = way.turn_km / (way.turn_km + way.from_km + 1e-6);
    let middle_km = mix(0.5 * span, min(scale_km * (exp2(0.4 * layer.steps * ratio) - 1.0), span), near);
    var grid = Grid(0.0, scale_km, ratio, 0.0, 0.0, 0.0, 0.0, way.from_km + middle_km);
    if layer.stride.w > 0.0 {
        grid.even_km = way.turn_km / layer.steps;
        grid.even_share = 1.0;
    } else if way.layer == RAIN_LAYER {
        grid.base_km = way.from_km;
        grid.even_km = span / layer.steps;
        grid.even_share = 1.0 - RAIN_BEND;
    } else {
        let count = mix(layer.steps, log2(1.0 + way.turn_km / scale_km) / ratio, near);
        grid.wanted = log2(1.0 + way.turn_km / (way.from_km + scale_km)) / count;
        grid.growth = ratio * exp2(-max(round(log2(ratio / grid.wanted)), 0.0));
        grid.first = floor(log2(1.0 + way.from_km / scale_km) / grid.growth);
    }
    return grid;
}

fn bound_km(grid: Grid, way: Way, number: f32) -> f32 {
    let grown = grid.base_km + grid.scale_km * (exp2((grid.first + number) * grid.growth) - 1.0);
    let even = way.from_km + number * grid.even_km;
    return min(mix(clamp(grown, way.from_km, way.to_km), even, grid.even_share), way.to_km);
}

fn height_in_layer(way: Way, at_km: f32) -> f32 {
    let bottom = body.cloud_layers[way.layer].bottom_km;
    let altitude_km = altitude_along(body.radius_km, body.eye_altitude_km, way.eye_mu, at_km);
    return saturate1((altitude_km - bottom) / (body.cloud_layers[way.layer].top_km - bottom));
}

fn blur_of(number: u32) -> f32 {
    // Shafts of rain and cells of middle clouds are narrower than steps: the mean over the jitter of pixels shows them.
    // With less blur, that mean is grain.
    let heaps = select(BLUR, LOW_BLUR, frame.pattern_quality == 0.0);
    return vec4f(heaps, RAIN_BLUR, heaps, MIDDLE_BLUR)[number];
}

// The cloud at a distance along a ray, as steps of a length resolve it.
fn cloud_on(way: Way, at_km: f32, sky: Sky, step_km: f32) -> Cloud {
    let footprint = max(at_km * frame.pixel_rad, step_km * blur_of(way.layer));
    let height = height_in_layer(way, at_km);
    let extent = abs(height_in_layer(way, at_km + step_km) - height);
    return cloud_at(way.layer, way.dir * at_km, sky, height, extent, footprint);
}

struct March {
    light: vec3f,
    transmittance: f32,
    // Weighted sum of distances, and sum of the weights
    distance: f32,
    weight: f32,
    // Share of light from beneath that comes through scattered
    spread: f32,
}

fn march(into: March, way: Way, jitter: f32) -> March {
    var out = into;
    let layer = body.cloud_layers[way.layer];
    let dir = way.dir;
    let bottom = layer.bottom_km;
    let thickness = layer.top_km - bottom;
    let sun = active_sun.dir;
    let grid = grid_of(layer, way);
    let extinction = layer.optical_depth / thickness;

    // Light that reaches the layer at the middle of the segment; it varies little along the ray.
    let middle = dir * grid.middle_km;
    let up = normalize(body.eye_km + middle);
    let sun_mu = dot(up, sun);
    let sunlight = active_sun.irradiance * sun_transmittance(bottom + thickness * 0.7, sun_mu);
    let sky = sky_irradiance(bottom + thickness, sun_mu);
    let from_ground = GROUND_UNDER_CLOUDS * body.ground_albedo * (sunlight * max(sun_mu, 0.0) + sky);
    let cosine = dot(dir, sun);
    let phases = vec3f(
        mix(lobe(cosine, 0.75), lobe(cosine, -0.15), 0.35),
        lobe(cosine, 0.35),
        1.0 / (4.0 * PI),
    );
    let to_sun = 1.0 / max(abs(sun_mu), 0.07);
    let from_above = saturate1(-2.0 * dot(dir, up));
    // Without a kink at the horizon, which would show as a line.
    let not_above = 1.0 - smoothstep(0.0, 0.5, -dot(dir, up));
    // From the side, light escapes from thin layers as well, but their long paths hold more of it.
    let from_side = 1.0 - smoothstep(-0.1, 0.1, dot(dir, up));
    // From above, one sees tops that a low sun only grazes (law of Lommel and Seeliger); the march is too coarse to
    // resolve this.
    let high = max(sun_mu, 0.0) + 0.02;
    let grazed = min(1.6 * high / (high + 0.6 * max(-dot(dir, up), 0.0)), 1.0);

    // Share of light of high orders that diffuses through cloud; the rest falls off exponentially.
    let diffuses = smoothstep(0.1, 0.5, sun_mu);

    let is_fine = frame.pattern_quality > 0.0;
    let halvings = select(SEARCH.x, SEARCH.y, is_fine);
    // At low quality, the sky over a short way lies between those over its ends.
    let span_km = way.to_km - way.from_km;
    let is_short = !is_fine && span_km < min(cloud_texel_km(), SHORT_WAY * way.from_km);
    var first_sky: Sky;
    var last_sky: Sky;
    if is_short {
        first_sky = sky_over(normalize(body.eye_km + dir * way.from_km), way.from_km * frame.pixel_rad);
        last_sky = sky_over(normalize(body.eye_km + dir * way.to_km), way.to_km * frame.pixel_rad);
        if max(first_sky.covers[way.layer], last_sky.covers[way.layer]) <= 0.0 { return out; }
    }
    var before = way.from_km;
    var was_empty = true;
    // A ray that leaves the layer by the side where it entered has twice the way, and the grid up to half as many more.
    let most = layer.steps * select(3.0, 1.0, way.layer == RAIN_LAYER);
    for (var i = 0.0; i < most; i += 1.0) {
        let t0 = bound_km(grid, way, i);
        let t1 = bound_km(grid, way, i + 1.0);
        if t0 >= way.to_km { break; }
        if t1 <= t0 { continue; }
        let t = mix(t0, t1, jitter);
        // Steps at the ends are cut short, and blur no less.
        let step_km = max(t1 - t0, (t + grid.scale_km) * (exp2(grid.wanted) - 1.0));
        var sky_here: Sky;
        if is_short {
            sky_here = sky_between(first_sky, last_sky, (t - way.from_km) / span_km);
        } else {
            sky_here = sky_over(normalize(body.eye_km + dir * t), t * frame.pixel_rad);
        }
        var found = Cloud(0.0, 0.0);
        if sky_here.covers[way.layer] > 0.0 { found = cloud_on(way, t, sky_here, step_km); }
        if found.density <= LEAST_DENSITY {
            before = t;
            was_empty = true;
            continue;
        }
        // Where the ray enters the cloud, unless what is found is the blurred edge of a cloud elsewhere in the step.
        var enter = t0;
        let fine_km = (t1 - t0) / layer.stride.z;
        if was_empty && layer.stride.z > 1.0 && cloud_on(way, t, sky_here, fine_km).density > LEAST_DENSITY {
            var inside = t;
            enter = before;
            for (var k = 0; k < halvings; k++) {
                let middle = 0.5 * (enter + inside);
                let density = cloud_on(way, middle, sky_here, fine_km).density;
                if density > LEAST_DENSITY { inside = middle; } else { enter = middle; }
            }
            enter = mix(enter, inside, jitter);
        }
        was_empty = false;
        // The first parts are the shortest: there the light comes from.
        let first = FIRST_PART / (extinction * found.density * (t1 - enter));
        let shortening = clamp(-log(first) / log(max(layer.stride.z, 2.0)), SHORTENING.x, SHORTENING.y);
        let from_sun = sun_share(body.eye_km + dir * t);
        let cloud_top = select(1.0, sky_here.top, way.layer == LOW_LAYER);
        // Rain falls from closed cloud.
        var sky_above = sky_here;
        if way.layer == RAIN_LAYER { sky_above.covers[LOW_LAYER] = 1.0; }
        // Shares of sunlight and of all light that the layers above leave
        let straight = exp(-depth_over(way.layer, sky_above, to_sun));
        let shaded = select(1.0, RAIN_SHADE, way.layer == RAIN_LAYER);
        let passed_above = shaded * passed_over(way.layer, sky_above);
        let diffuse = sunlight * (max(sun_mu, 0.0) * max(passed_above - straight, 0.0)) + sky * passed_above;
        let below = from_ground * passed_above * let_through_gaps(layer.optical_depth, sky_here.covers[way.layer]);
        // Seen from above, thin cloud over thick cloud is as bright as both together.
        let under = depth_beneath(way.layer, sky_here);
        var part_from = enter;
        for (var k = 0.0; k < layer.stride.z; k += 1.0) {
            let shares = vec2f(k + jitter, k + 1.0) / layer.stride.z;
            let at = enter + (t1 - enter) * pow(shares, vec2f(shortening));
            let length_km = at.y - part_from;
            part_from = at.y;
            var here = at.x;
            var cloud = found;
            if layer.stride.z > 1.0 {
                cloud = cloud_on(way, here, sky_here, length_km);
            } else {
                here = t;
            }
            let density = cloud.density;
            if density <= LEAST_DENSITY { continue; }
            let rel = dir * here;
            let height = height_in_layer(way, here);
            let footprint = max(here * frame.pixel_rad, length_km * blur_of(way.layer));
            // A second density sample towards the sun shapes light and shade. Its distance is at least about a pixel.
            let reach = max(thickness * 0.4, here * frame.pixel_rad * 1.2);
            let ahead_height = saturate1(height + reach * sun_mu / thickness);
            let ahead = cloud_at(way.layer, rel + sun * reach, sky_here, ahead_height, 0.0, footprint);
            let room = max(cloud_top - height, 0.05) * thickness * to_sun;
            let beyond = max(room - reach * 0.5, 0.0);
            let sun_depth = extinction * (density * min(room, reach) * 0.45 + ahead.density * beyond * 0.55);
            // Seen from below or beside, light that was scattered before comes through the cloud above the point.
            let depth_above = layer.optical_depth * cloud.column * saturate1(1.0 - height / cloud_top);
            let depth = max(sun_depth, depth_above * max(sun_mu, 0.0) * not_above);
            // Each further order of scattering has a lower extinction and a more isotropic phase (Wrenninge, Oz: The
            // Great and Volumetric). Light of a high sun diffuses through thick cloud.
            let high_orders = mix(exp(-0.07 * depth), let_through(depth), diffuses);
            let orders = vec3f(exp(-sun_depth), 0.75 * exp(-0.3 * depth), 1.5 * high_orders);
            let direct = straight * dot(phases, orders);
            let ambient = (diffuse * let_through(depth_above) + below * (1.0 - height)) / PI;
            var lit = grazed;
            if way.layer == LOW_LAYER { lit *= shade(rel, sky_here.covers[way.layer], sun_mu, footprint); }
            // Tops that fall off towards the sun are brighter.
            let rise = (ahead.column - cloud.column) * thickness * RELIEF / (reach * max(sun_mu, RELIEF_LEAST_SUN));
            lit *= mix(1.0, clamp(1.0 - rise, RELIEF_LIMITS.x, RELIEF_LIMITS.y), from_above);
            let both = layer.optical_depth * cloud.column + under * mix(1.0, cloud.column, DECK_TONE);
            let thick = sent_back(both);
            let returned = mix(mix(1.0, sqrt(thick), from_side), thick, from_above);
            let shine = body.cloud_color * (sunlight * direct * (BRIGHTNESS * lit) + ambient) * from_sun * returned;
            let passed = exp(-extinction * density * length_km);
            let seen = out.transmittance * (1.0 - passed);
            out.light += seen * shine;
            out.distance += seen * here;
            out.weight += seen;
            let wide = spread_over(here * frame.pixel_rad, bottom);
            out.spread += seen * from_above * wide * let_through(both);
            out.transmittance *= passed;
            if out.transmittance < 0.004 { out.transmittance = 0.0; break; }
        }
        if out.transmittance <= 0.0 { break; }
    }
    return out;
}

// Noise of a band at a point, a whole number of times finer.
fn veil_noise(band: Octave, at: vec3f, finer: f32, footprint: f32) -> f32 {
    let lod = log2(max(footprint * finer * NOISE_TILE_SIDE / band.period, 1e-6));
    return textureSampleLevel(noise_tile, repeated, finer * (band.offset + at / band.period), lod).g;
}

// Depth of the middle of a veil over the mean where it covers the sky: covers are distributed evenly, so that their
// squares have a third as their mean, and depths keep theirs.
const VEIL_MIDDLE: f32 = 1.5;

struct Sheet {
    light: vec3f,
    transmittance: f32,
    at_km: f32,
}

// The veil where a ray meets it first: a thin sheet of ice, brightest towards the sun.
fn veil(dir: vec3f, mu: f32, far: f32) -> Sheet {
    var out = Sheet(vec3f(0.0), 1.0, 0.0);
    if body.cloud_coverages.z <= 0.0 { return out; }
    let radius = body.radius_km;
    let h = body.eye_altitude_km;
    let sheet = body.veil_km;
    let hits = ray_sphere((radius + h) * mu, (h - sheet) * (2.0 * radius + h + sheet));
    if hits.y < hits.x { return out; }
    let t = select(hits.y, hits.x, h > sheet);
    if t <= 0.0 || t > far { return out; }
    let rel = dir * t;
    let up = normalize(body.eye_km + rel);
    let footprint = t * frame.pixel_rad;
    let cover = sky_over(up, footprint).veil;
    if cover <= 0.0 { return out; }
    // Streaks where the map is too coarse for them; from afar the coarsest of them tear the veil into wisps.
    let carried = drifted(rel);
    let coarse = body.cloud_bands[0];
    let band = body.cloud_bands[1];
    let torn = veil_noise(coarse, carried, 1.0, footprint);
    let streak = veil_noise(band, OCTAVE_TURN * carried, 1.0, footprint);
    let fine = veil_noise(band, OCTAVE_TURN * carried, 4.0, footprint);
    // Most of a veil is thin, most of all towards its borders: the same depth up to there would be a ribbon wherever
    // the wind has drawn the map out.
    let thickness = VEIL_MIDDLE * cover * cover * mix(0.4, 1.6, torn);
    let depth = body.veil_depth * thickness * (0.4 + 0.8 * streak + 0.4 * fine) / max(abs(dot(dir, up)), 0.12);
    let scattered = 1.0 - exp(-depth);
    // From above, half of the light from beneath that the sheet scatters still goes up.
    out.transmittance = 1.0 - scattered * select(1.0, 0.5, h > sheet);
    out.at_km = t;
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, body.eye_km + rel);
        let sun_mu = dot(up, active_sun.dir);
        let sunlight = active_sun.irradiance * sun_transmittance(sheet, sun_mu);
        let cosine = dot(dir, active_sun.dir);
        // From above, a thin sheet sends back less than it lets through.
        let direct = sunlight * (0.5 * lobe(cosine, 0.7) + 1.5 * lobe(cosine, 0.0));
        out.light += scattered * body.cloud_color * (direct + sky_irradiance(sheet, sun_mu) / PI);
    }
    return out;
}

struct Output {
    @location(0) light: vec4f,
    // x: mean distance of the clouds; y: where the ray ends
    @location(1) distance: vec4f,
}

// The middle of the pixel for which a texel marches: of each block of pixels one is marched (cloud_gather.wgsl).
fn marched_pixel(texel: vec2f) -> vec2f {
    if body.march_block == 1u { return texel; }
    let inside = vec2f(body.march_place) + 0.5;
    let last = frame.origin_px + frame.size_px - 0.5;
    return min(frame.origin_px + floor(texel) * f32(body.march_block) + inside, last);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Output {
    let pixel = marched_pixel(position.xy);
    let ray = pixel_ray(pixel + aside_of(pixel));
    let ray_length = length(ray);
    let dir = ray / ray_length;
    let far = surface_distance(vec2i(pixel), ray_length);
    let radius = body.radius_km;
    let h = body.eye_altitude_km;
    let mu = dot(dir, body.eye_up);
    // Ways through the layers in the order of the ray: down from the highest layer, then up from the lowest. x and y:
    // from and to, km; z: turn_km; w: layer.
    var ways: array<vec4f, 2u * CLOUD_LAYERS>;
    var count = 0u;
    for (var i = 0u; i < 2u * CLOUD_LAYERS; i++) {
        let is_down = i < CLOUD_LAYERS;
        let number = select(i - CLOUD_LAYERS, CLOUD_LAYERS - 1u - i, is_down);
        if body.cloud_layers[number].steps <= 0.0 { continue; }
        let bottom = body.cloud_layers[number].bottom_km;
        let top = body.cloud_layers[number].top_km;
        let inner = ray_sphere((radius + h) * mu, (h - bottom) * (2.0 * radius + h + bottom));
        let outer = ray_sphere((radius + h) * mu, (h - top) * (2.0 * radius + h + top));
        // The ray crosses the bottom, and is in the layer again on its way up.
        let rises = inner.y >= inner.x && inner.y > 0.0;
        if outer.y < outer.x || outer.y <= 0.0 || (is_down && rises && inner.x <= 0.0) || (!is_down && !rises) {
            continue;
        }
        let from_km = select(inner.y, max(outer.x, 0.0), is_down);
        let to_km = min(select(outer.y, inner.x, is_down && rises), far);
        if to_km > from_km {
            // A ray that misses the bottom of the layer is lowest where it is level.
            let turn_km = select(outer.y, select(-(radius + h) * mu, inner.x, rises), is_down) - from_km;
            ways[count] = vec4f(from_km, to_km, max(turn_km, 0.01), f32(number));
            count += 1u;
        }
    }
    // Jitter between neighbouring pixels hides the steps, which would show as terraces.
    let jitter = jitter_of(pixel);
    var light = vec3f(0.0);
    var state = March(vec3f(0.0), 1.0, 0.0, 0.0, 0.0);
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun(i);
        state = March(vec3f(0.0), 1.0, 0.0, 0.0, 0.0);
        for (var k = 0u; k < count && state.transmittance > 0.0; k++) {
            state = march(state, Way(dir, mu, ways[k].x, ways[k].y, ways[k].z, u32(ways[k].w)), jitter);
        }
        light += state.light;
    }
    var transmittance = min(state.transmittance + state.spread, 1.0);
    let sheet = veil(dir, mu, far);
    if sheet.transmittance < 1.0 {
        if h > body.veil_km {
            light = sheet.light + sheet.transmittance * light;
        } else {
            light += transmittance * sheet.light;
        }
        let seen = select(transmittance, 1.0, h > body.veil_km) * (1.0 - sheet.transmittance);
        state.distance += seen * sheet.at_km;
        state.weight += seen;
        transmittance *= sheet.transmittance;
    }
    var out: Output;
    out.light = vec4f(min(light, vec3f(60000.0)), transmittance);
    out.distance = vec4f(select(NOTHING_KM, state.distance / state.weight, state.weight > 0.0), far, 0.0, 0.0);
    return out;
}
