// The air in front of the scene, from 2 m over the ground to outer space: one march for each pixel. Composites clouds
// at their distance, and draws stars and the discs of the suns behind everything. Reads the scene and writes a new one.
#include "contact_shade.wgsl"
#include "scattering.wgsl"
#include "stars.wgsl"
#include "ring_pieces.wgsl"
#include "giant_depth.wgsl"

@group(2) @binding(2) var cloud_light: texture_2d<f32>;
@group(2) @binding(3) var cloud_distance: texture_2d<f32>;

// The corona is drawn to this distance, in radii of the star, while the eye sees a smaller share of the disc than this.
const CORONA_RADII: f32 = 12.0;
const GLARE_SHARE: f32 = 0.01;
// Its radiance as a display shows it: photographs of many exposures press four decades of it into two. By eye.
const CORONA_GAIN: f32 = 2.6;
const CORONA_GAMMA: f32 = 0.45;
// How much the air before it dims the corona, for air of radiance 1: the corona has a twentieth at the star's limb, and
// a thousandth of that at three radii.
const CORONA_DIMMED: f32 = 1000.0;

// Radiance of the corona over that at the star's limb, a millionth of the disc's, at a distance from the disc's centre
// in radii (Baumbach, Strahlung, Ergiebigkeit und Elektronendichte der Sonnenkorona, 1937).
fn corona(radii: f32) -> f32 {
    let x = 1.0 / radii;
    return (2.565 * pow(x, 17.0) + 1.425 * pow(x, 7.0) + 0.0532 * pow(x, 2.5)) / 4.0432;
}

// Factor on the corona's radiance: streamers over the star's equator, and thin plumes over its poles, as when the Sun
// is quiet. They narrow outwards (Koutchmy and Livshits, Coronal Streamers, 1992). `aside`: from the disc's centre, in
// radii. The star's axis is taken for upright.
fn streamers(aside: vec3f, radii: f32, number: u32) -> f32 {
    let sun = active_sun.seen_dir;
    let axis = normalize(vec3f(0.0, 0.0, 1.0) - sun * sun.z);
    let angle = atan2(dot(aside, axis), dot(aside, cross(sun, axis)));
    let seed = 2.4 * f32(number);
    let out = saturate1((radii - 1.0) / 1.6);
    // Broad streamers on both sides, of unequal breadth and place.
    let bent_angle = angle + 0.25 * sin(3.0 * angle + 1.0 + seed) + 0.14 * sin(5.0 * angle + 2.0 * seed);
    let equator = cos(bent_angle) * cos(bent_angle);
    let rays = 0.5 + 0.5 * sin(7.0 * bent_angle + 0.9 * sin(4.0 * angle + seed) + 2.6);
    let broad = pow(equator, 0.6 + 1.1 * out) * (0.55 + 0.9 * pow(rays, 1.0 + 1.5 * out));
    let plumes = sin(41.0 * angle + 3.0 * sin(6.0 * angle + seed) + 2.0 * sin(13.0 * angle));
    let fine = plumes * (0.1 + 0.15 * (1.0 - equator));
    return mix(1.0, 0.16 + 1.75 * broad, 0.35 + 0.65 * out) * (1.0 + fine);
}

// Share of the active sun's disc that this body leaves visible to the eye, as a smooth sphere.
fn share_beside_body() -> f32 {
    let sun = active_sun.seen_dir;
    if dot(sun, body.eye_up) >= 0.0 { return 1.0; }
    let apart = angle_of_sine(length(cross(sun, body.eye_up)));
    let radius = angle_of_sine(body.radius_km / (body.radius_km + body.eye_altitude_km));
    return visible_share(active_sun.seen_radius_rad, radius, apart);
}

struct SeenSun {
    // Radiance
    disc: vec3f,
    // In the unit of stars
    corona: vec3f,
}

// The active sun's disc, darker and redder towards its limb (linear limb darkening fitted to the Sun). A narrower disc
// than a pixel has less light. Once a body covers the disc its corona shows, compressed to the range that a display
// has; before, the corona is lost in the glare. `number`: the sun's.
fn seen_sun(dir: vec3f, number: u32) -> SeenSun {
    var seen = SeenSun(vec3f(0.0), vec3f(0.0));
    let sun = active_sun.seen_dir;
    let off = length(cross(dir, sun));
    let soft = frame.pixel_rad * 0.7;
    let own = sin(active_sun.seen_radius_rad);
    let radius = max(own, soft);
    let radii = max(off / radius, 1.0);
    if dot(dir, sun) < 0.0 || radii > CORONA_RADII || active_sun.disc_gain <= 0.0 { return seen; }
    let beside_body = share_beside_body();
    let beside_others = luminance(sun_share(body.eye_up * (body.radius_km + body.eye_altitude_km)));
    let share = beside_body * beside_others;
    if share < GLARE_SHARE {
        let end = 1.0 - smoothstep(0.2, 1.0, radii / CORONA_RADII);
        let rays = streamers((dir - sun * dot(dir, sun)) / radius, radii, number);
        let color = active_sun.irradiance / max(luminance(active_sun.irradiance), 1e-9);
        let shown = CORONA_GAIN * pow(corona(radii) * rays, CORONA_GAMMA) * end;
        seen.corona = color * (shown * (1.0 - share / GLARE_SHARE));
    }
    // The soft edge of a covered disc does not reach beyond the body before it. From near the body its ground decides:
    // that of a basin lies below the sphere.
    let is_far = body.eye_altitude_km > body.radius_km;
    if off > radius + soft || beside_others * select(1.0, beside_body, is_far) <= 0.0 { return seen; }
    let full = active_sun.irradiance * active_sun.disc_gain * (own * own / (radius * radius));
    let edge = 1.0 - smoothstep(radius - soft, radius + soft, off);
    let x = saturate1(off / radius);
    let depth = sqrt(1.0 - x * x);
    let limb = 1.0 - vec3f(0.50, 0.58, 0.68) * (1.0 - depth);
    seen.disc = full * limb * edge;
    return seen;
}

// Bodies too small for a surface: points of light, drawn as the stars are.
fn points(dir: vec3f, pixel_rad: f32) -> vec3f {
    var sum = vec3f(0.0);
    if ALONE { return sum; }
    for (var i = 0u; i < body.point_count; i++) {
        let away = length(cross(dir, body.points[i].dir)) / max(pixel_rad, 0.0006);
        if dot(dir, body.points[i].dir) > 0.0 { sum += body.points[i].light * exp(-1.6 * away * away); }
    }
    return sum;
}

struct Clouds {
    // rgb: radiance; a: transmittance
    light: vec4f,
    at_km: f32,
}

// Weights of a row of pixels, from the middle. Sums over every third pixel are equal: the mean has each of the nine
// jitters (clouds.wgsl) with one weight, and so no pattern.
const ROW: vec3f = vec3f(1.0, 1.0, 0.0);
// Where clouds of low quality are hardly wider than its large pixels: equal weights would show them as squares.
const SOFT_ROW: vec3f = vec3f(3.0, 2.0, 1.0) / 3.0;
// Widths of a pixel at the top of the clouds over the tile of puffs between which that sets in.
const SOFT_WIDTHS: vec2f = vec2f(0.003, 0.006);

fn row_of(dir: vec3f) -> vec3f {
    if frame.pattern_quality > 0.0 || body.cloud_is_far != 0u { return ROW; }
    let h = body.eye_altitude_km;
    let top = body.cloud_top_km;
    let hits = ray_sphere((body.radius_km + h) * dot(dir, body.eye_up), (h - top) * (2.0 * body.radius_km + h + top));
    let at_km = select(hits.y, hits.x, h > top);
    let width = at_km * frame.pixel_rad / body.cloud_bands[body.cloud_layers[LOW_LAYER].puff_band].period;
    return mix(ROW, SOFT_ROW, smoothstep(SOFT_WIDTHS.x, SOFT_WIDTHS.y, width));
}

// Mean over the clouds of 3x3 pixels, or with a soft row of 5x5. The march is jittered so that any 3x3 pixels together
// sample the whole ray (see the noise in clouds.wgsl). Pixels whose ground is at another distance are left out. From
// the second frame of a still picture on, the mean over the frames takes its place.
fn clouds_around(pixel: vec2i, dir: vec3f) -> Clouds {
    let first = vec2i(frame.origin_px);
    let last = first + vec2i(frame.size_px) - 1;
    let depth = textureLoad(scene_depth, pixel, 0);
    var light = vec4f(0.0);
    var distance = 0.0;
    var seen = 0.0;
    var weights = 0.0;
    let row = row_of(dir);
    let reach = select(select(1, 2, row.z > 0.0), 0, frame.still_number > 1u);
    let side = 2 * reach + 1;
    for (var i = 0; i < side * side; i++) {
        let at = clamp(pixel + vec2i(i % side, i / side) - reach, first, last);
        let there = textureLoad(scene_depth, at, 0);
        if min(depth, there) * 1.25 < max(depth, there) { continue; }
        let aside = abs(vec2i(i % side, i / side) - reach);
        let weight = row[aside.x] * row[aside.y];
        let clouds = textureLoad(cloud_light, at, 0);
        light += weight * clouds;
        weights += weight;
        if clouds.a < 1.0 {
            distance += weight * (1.0 - clouds.a) * textureLoad(cloud_distance, at, 0).r;
            seen += weight * (1.0 - clouds.a);
        }
    }
    return Clouds(light / weights, select(NOTHING_KM, distance / seen, seen > 1e-5));
}

struct Output {
    // rgb: radiance; a: weight of the pixel for metering
    @location(0) light: vec4f,
    // Square roots of the stars' light. Stars are stored apart because metering must not change them: they are as
    // bright as for an eye adapted to the scene.
    @location(1) stars: vec4f,
}

// Result of a ray, without stars.
struct RayLight {
    light: vec3f,
    // Luminance of the sunlight scattered by the air
    air_only: f32,
    // Transmittance to the background
    transmittance: vec3f,
}

// Airglow comes from a shell: its altitude and its thickness over the height of the air. On the Earth, oxygen shines
// green at 90 to 97 km.
const AIRGLOW_AT: f32 = 0.9;
const AIRGLOW_THICKNESS: f32 = 0.06;
// Light of the shell at the zenith over that of all airglow; from above, its colour over that of the night sky. Chosen
// by eye.
const AIRGLOW_OVERHEAD: f32 = 0.45;
const AIRGLOW_FROM_ABOVE: vec3f = vec3f(0.10, 0.12, 0.065);

// Airglow along a ray over its mean from the ground: that of the shell, which is brighter where the ray crosses it at a
// slant (van Rhijn, 1921), and what air below it scatters. From above, the shell is an arc over the limb. `far`: where
// the ray ends, km; `gaps`: share of light that clouds let through.
fn airglow(dir: vec3f, far: f32, air: AirLight, gaps: f32) -> vec3f {
    let eye = body.radius_km + body.eye_altitude_km;
    let shell = body.radius_km + AIRGLOW_AT * body.air_height_km;
    let width = AIRGLOW_THICKNESS * body.air_height_km;
    let mu = dot(dir, body.eye_up);
    // Distance of the ray from the middle of the planet. It crosses a thin shell at two places, equally far from the
    // one that is nearest to the middle.
    let passes_at = eye * sqrt(max(1.0 - mu * mu, 0.0));
    let squared = (shell - passes_at) * (shell + passes_at);
    let half_way = sqrt(max(squared, 0.0));
    // Beside the shell, the difference has no digits left.
    let softened = sqrt(max(0.5 * (squared + length(vec2f(squared, 2.0 * shell * width))), width * width));
    let outside = max(passes_at - shell, 0.0) / width;
    let slant = shell / softened * exp(-0.5 * outside * outside);
    // Shares of both crossings that are seen.
    let is_above = smoothstep(-width, width, eye - shell);
    let enters = is_above * step(mu, 0.0);
    let leaves = mix(1.0, enters, is_above) * step(half_way - eye * mu, far);
    let color = mix(vec3f(AIRGLOW_OVERHEAD), AIRGLOW_FROM_ABOVE, is_above);
    let scattered = 1.0 - air.to_cloud + gaps * (air.to_cloud - air.transmittance);
    return color * slant * (enters + leaves * gaps * air.transmittance) + scattered;
}

fn ray_light(dir: vec3f, far: f32, scene: vec3f, clouds: vec4f, cloud_at: f32) -> RayLight {
    var air = AirLight(vec3f(0.0), vec3f(1.0), vec3f(1.0));
    var light = vec3f(0.0);
    if body.air_height_km > 0.0 {
        for (var i = 0u; i < body.sun_count; i++) {
            use_sun(i);
            let h = body.eye_altitude_km;
            air = air_light(h, body.eye_up, dir, active_sun.dir, far, frame.air_steps, cloud_at, clouds.a);
            light += air.radiance * active_sun.irradiance;
        }
    }
    let air_only = luminance(light);
    if body.air_height_km > 0.0 { light += NIGHT_SKY * NIGHT_AIRGLOW * airglow(dir, far, air, clouds.a); }
    let through = air.transmittance * clouds.a;
    return RayLight(light + air.to_cloud * clouds.rgb + through * scene, air_only, through);
}

// Antialiases the limb from afar, where the bright rim of the air is narrower than a pixel: the mean of several rays
// side by side across the limb. `center`: result of the pixel's central ray. `far`: where that ray ends, km.
fn across_limb(
    pixel: vec2i, dir: vec3f, far: f32, scene: vec3f, clouds: vec4f, cloud_at: f32, center: RayLight,
) -> RayLight {
    const RAYS: i32 = 8;
    let radius = body.radius_km;
    let eye = body.eye_altitude_km + radius;
    let ahead = -eye * dot(dir, body.eye_up);
    let lowest = body.eye_up * eye + dir * ahead;
    let height = length(lowest) - radius;
    // Distance in km between neighbouring pixels at the limb. Where it is small, mountains span pixels and the limb is
    // not that of the sphere.
    let step = frame.pixel_rad * ahead;
    if body.air_height_km <= 0.0 || ahead <= 0.0 || step < 1.5 { return center; }
    // A nearer body hides the limb. Ground farther away is another body's.
    if far < ahead - 0.5 * radius { return center; }
    let ground = far < ahead + 0.5 * radius;
    if abs(height) > body.air_height_km + 2.0 * step || (height < 0.0) != ground { return center; }
    // From within the air, the rim is as wide as the air is deep, and a ray pointing down meets the ground long before
    // the limb.
    let outside = smoothstep(body.air_height_km, 1.2 * body.air_height_km, body.eye_altitude_km);
    if outside <= 0.0 || height < -2.0 * step { return center; }
    let outwards = lowest / length(lowest);
    // Radiance of the ground from the next pixel inwards, and of the background from the next pixel outwards.
    let towards = vec2f(
        dot(outwards, body.ray_right) / length(body.ray_right),
        -dot(outwards, body.ray_up) / length(body.ray_up),
    );
    let first = vec2i(frame.origin_px);
    let last = first + vec2i(frame.size_px) - 1;
    let inwards = 1.5 * normalize(towards);
    let inner = clamp(vec2i(floor(vec2f(pixel) + 0.5 - inwards)), first, last);
    let outer = clamp(vec2i(floor(vec2f(pixel) + 0.5 + inwards)), first, last);
    let surface = select(textureLoad(scene_color, inner, 0).rgb, scene, ground);
    // Another body may be behind the limb.
    var behind = NIGHT_BACKGROUND * NIGHT_SKY;
    if body.is_backmost == 0u { behind = textureLoad(scene_color, outer, 0).rgb; }
    let space = select(scene, behind, ground);
    var sum = RayLight(vec3f(0.0), 0.0, vec3f(0.0));
    for (var i = 0; i < RAYS; i++) {
        let aside = (f32(i) + 0.5) / f32(RAYS) - 0.5;
        let ray = normalize(dir + outwards * (aside * frame.pixel_rad));
        let to_middle = eye * dot(ray, body.eye_up);
        let hits = ray_sphere(to_middle, body.eye_altitude_km * (2.0 * radius + body.eye_altitude_km));
        let meets = hits.y >= hits.x;
        // Rays above the top of the clouds see none.
        let over = height + aside * step > body.cloud_top_km;
        let ray_far = select(NOTHING_KM, hits.x, meets);
        let ray_clouds = select(clouds, vec4f(0.0, 0.0, 0.0, 1.0), over);
        let ray_scene = select(space, surface, meets);
        let seen = ray_light(ray, ray_far, ray_scene, ray_clouds, select(cloud_at, NOTHING_KM, over));
        sum.light += seen.light / f32(RAYS);
        sum.air_only += seen.air_only / f32(RAYS);
        sum.transmittance += select(seen.transmittance, vec3f(0.0), meets) / f32(RAYS);
    }
    return RayLight(
        mix(center.light, sum.light, outside),
        mix(center.air_only, sum.air_only, outside),
        mix(center.transmittance, sum.transmittance, outside),
    );
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Output {
    let pixel = vec2i(position.xy);
    let ray = pixel_ray(position.xy);
    let ray_length = length(ray);
    let dir = ray / ray_length;
    let far = surface_distance(pixel, ray_length);
    let ground = far < NOTHING_KM;
    var scene = textureLoad(scene_color, pixel, 0).rgb;
    if ground { scene *= contact_light(pixel, far * 1000.0); }
    let starry = !ground && body.is_backmost != 0u;
    var coronas = vec3f(0.0);
    if starry { scene = NIGHT_BACKGROUND * NIGHT_SKY; }
    if starry || (!ALONE && !ground) {
        for (var i = 0u; i < body.sun_count; i++) {
            use_sun(i);
            let sun = seen_sun(dir, i);
            if starry { scene += sun.disc; }
            coronas += sun.corona;
        }
    }
    var clouds = vec4f(0.0, 0.0, 0.0, 1.0);
    var cloud_at = NOTHING_KM;
    if has_clouds() {
        let around = clouds_around(pixel, dir);
        clouds = around.light;
        cloud_at = around.at_km;
    }
    // Rings beyond the air are a part of the scene that it veils.
    var rings = RingLight(vec3f(0.0), 1.0, NOTHING_KM);
    if !ALONE && body.ring_count > 0u { rings = rings_before(dir, far); }
    let shell_km = path_through_air(body.eye_altitude_km, dot(dir, body.eye_up), far);
    let is_behind = shell_km.y > shell_km.x && rings.at_km > shell_km.x;
    if is_behind { scene = scene * rings.transmittance + rings.light; }
    var seen = across_limb(pixel, dir, far, scene, clouds, cloud_at, ray_light(dir, far, scene, clouds, cloud_at));
    if !is_behind { seen.light = seen.light * rings.transmittance + rings.light; }
    seen.transmittance *= rings.transmittance;
    if IN_GIANT {
        let fog = giant_fog(dir);
        // What is below the tops is hidden.
        let behind = select(seen.light, vec3f(0.0), ground);
        seen.light = mix(seen.light, fog.light + fog.transmittance * behind, fog.share);
        seen.air_only += luminance(fog.light) * fog.share;
        seen.transmittance *= mix(vec3f(1.0), fog.transmittance, fog.share);
    }
    // Factor on the stars left by the bodies farther away.
    var star_light = select(vec3f(1.0), vec3f(0.0), ground);
    // Weight of the sky for metering: small from within the air, zero from outer space.
    var weight = 1.0;
    if !ground {
        // Bright sky hides the stars, at dusk as well, when the exposure is long.
        let star_visibility = 1.0 / (1.0 + 1e6 * seen.air_only + 40.0 * luminance(clouds.rgb));
        // Stars are as wide as a pixel of the display, not of this target, so that their brightness does not depend on
        // the render scale.
        let star_width_rad = frame.pixel_rad * max(frame.render_scale, 1.0);
        let spread = select(1.0, 0.5, frame.render_scale < 1.0);
        // The corona is brighter than the sky of totality.
        let corona_visibility = 1.0 / (1.0 + CORONA_DIMMED * seen.air_only);
        let share = luminance(coronas) / (luminance(coronas) + 0.05);
        star_light = mix(star_visibility, corona_visibility, share) * seen.transmittance;
        if starry {
            star_light *= coronas + (stars(dir, star_width_rad) + points(dir, star_width_rad)) * spread;
        }
        let inside = 1.0 - smoothstep(0.1, 0.5, body.eye_altitude_km / max(body.air_height_km, 1e-3));
        let sky = seen.air_only + luminance(clouds.rgb) + luminance(NIGHT_SKY);
        weight = 0.3 * inside * saturate1(sky / (sky + luminance(scene)));
    }
    return Output(vec4f(min(seen.light, vec3f(60000.0)), weight), vec4f(sqrt(star_light), 1.0));
}
