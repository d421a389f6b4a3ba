// The air in front of everything, from 2 m over the ground to outer space: one march for each pixel. Puts clouds in at
// their distance, and stars and the star's disc behind it all. Reads the scene, writes a new one.
#include "surface.wgsl"
#include "scattering.wgsl"
#include "stars.wgsl"

@group(2) @binding(2) var cloud_light: texture_2d<f32>;
@group(2) @binding(3) var cloud_distance: texture_2d<f32>;

// Disc of the star, darker and redder towards its limb (a linear law fitted to the Sun).
fn sun_disc(dir: vec3f) -> vec3f {
    let sun = globals.sun_dir.xyz;
    let off = length(cross(dir, sun));
    let soft = globals.eye_low_m.w * 0.7;
    let radius = max(sin(globals.sun_dir.w), soft);
    if dot(dir, sun) < 0.0 || off > radius + soft { return vec3f(0.0); }
    let edge = 1.0 - smoothstep(radius - soft, radius + soft, off);
    let x = saturate1(off / radius);
    let depth = sqrt(1.0 - x * x);
    let limb = 1.0 - vec3f(0.50, 0.58, 0.68) * (1.0 - depth);
    return globals.sun_irradiance.rgb * (globals.sun_irradiance.w * edge) * limb;
}

// Glow around the star's disc: light that the lens scatters, as far as the disc is not hidden. It falls to nothing without an edge.
fn glare(dir: vec3f) -> vec3f {
    const REACH: f32 = 1.2;
    let sun = globals.sun_dir.xyz;
    let off = length(dir - sun);
    let inside = saturate1(1.0 - off / REACH);
    if inside <= 0.0 { return vec3f(0.0); }
    let shape = inside * inside * (0.5 * pow(1.0 + off * off * 8000.0, -1.5) + 0.06 * pow(1.0 + off * off * 250.0, -1.5));
    // Where the star stands in the picture; nothing if it is not in it.
    let right = globals.ray_right.xyz;
    let top = globals.ray_up.xyz;
    let depth = dot(sun, globals.ray_forward.xyz);
    if depth <= 0.0 { return vec3f(0.0); }
    let ndc = vec2f(dot(sun, right) / dot(right, right), dot(sun, top) / dot(top, top)) / depth;
    let size = vec2f(globals.ray_right.w, globals.ray_up.w);
    let center = (ndc * vec2f(0.5, -0.5) + 0.5) * size;
    let reach = globals.sun_dir.w / globals.eye_low_m.w * 0.6;
    var open = 0.0;
    for (var i = 0; i < 9; i++) {
        let at = center + vec2f(f32(i % 3 - 1), f32(i / 3 - 1)) * reach;
        if any(at < vec2f(0.0)) || any(at >= size) { continue; }
        let ray = pixel_ray(at);
        let length_at = length(ray);
        if surface_distance(vec2i(at), ray / length_at, length_at) >= NOTHING_KM {
            var through = 1.0;
            if globals.clouds.z > 0.0 { through = textureLoad(cloud_light, vec2i(at), 0).a; }
            open += through / 9.0;
        }
    }
    let way = globals.eye_up.w;
    var clear = vec3f(1.0);
    if way < globals.air.x { clear = sun_transmittance(way, dot(globals.eye_up.xyz, sun)); }
    return globals.sun_irradiance.rgb / PI * clear * (shape * open);
}

struct Clouds {
    // a: what they let through
    light: vec4f,
    at_km: f32,
}

// The clouds before a pixel. Neighbouring pixels marched a little apart; any three by three of them together have looked
// everywhere along the way (the noise that sets them apart is made so), those before ground at another distance left out.
fn clouds_around(pixel: vec2i) -> Clouds {
    let last = vec2i(textureDimensions(cloud_light)) - 1;
    let depth = textureLoad(scene_depth, pixel, 0);
    var light = vec4f(0.0);
    var distance = 0.0;
    var seen = 0.0;
    var count = 0.0;
    for (var i = 0; i < 9; i++) {
        let at = clamp(pixel + vec2i(i % 3 - 1, i / 3 - 1), vec2i(0), last);
        let there = textureLoad(scene_depth, at, 0);
        if min(depth, there) * 1.25 < max(depth, there) { continue; }
        let clouds = textureLoad(cloud_light, at, 0);
        light += clouds;
        count += 1.0;
        if clouds.a < 1.0 {
            distance += (1.0 - clouds.a) * textureLoad(cloud_distance, at, 0).r;
            seen += 1.0 - clouds.a;
        }
    }
    return Clouds(light / count, select(NOTHING_KM, distance / seen, seen > 1e-5));
}

struct Seen {
    // a: how much the pixel counts for exposure
    @location(0) light: vec4f,
    // Stars, as square roots: as bright as an eye sees them that is used to the light there is, so exposure does not follow them.
    @location(1) stars: vec4f,
}

// What comes along a ray, but for stars and what the lens does.
struct Along {
    light: vec3f,
    // Luminance of the starlight that the air scatters
    air_only: f32,
    // Of what lies behind
    transmittance: vec3f,
}

// Brightness of the airglow before the sky, 0.4 overhead and 1.4 near the horizon. It is a shell near the top of the air: brighter
// where the ray crosses it at a slant (van Rhijn, 1921), dimmed by the air below it, and not seen from above.
fn airglow(dir: vec3f) -> f32 {
    let below = 1.0 - smoothstep(0.0, globals.air.x, globals.eye_up.w);
    let ratio = globals.eye_km.w / (globals.eye_km.w + 0.9 * globals.air.x);
    let mu = max(dot(dir, globals.eye_up.xyz), 0.0);
    let slant = inverseSqrt(max(1.0 - ratio * ratio * (1.0 - mu * mu), 1e-4));
    return below * 0.45 * min(slant, 5.0) * exp(-0.12 / (mu + 0.06));
}

fn along(dir: vec3f, far: f32, scene: vec3f, clouds: vec4f, cloud_at: f32) -> Along {
    var air = AirLight(vec3f(0.0), vec3f(1.0), vec3f(1.0));
    if globals.air.x > 0.0 {
        air = air_light(globals.eye_up.w, globals.eye_up.xyz, dir, globals.sun_dir.xyz, far, globals.air.z, cloud_at, clouds.a);
    }
    var light = air.radiance * globals.sun_irradiance.rgb;
    let air_only = luminance(light);
    // Before the sky the air glows, before the ground it scatters what reaches it.
    if globals.air.x > 0.0 {
        let glow = select(1.0 - air.transmittance, vec3f(airglow(dir)), far >= NOTHING_KM);
        light += NIGHT_SKY * (NIGHT_AIRGLOW * glow);
    }
    return Along(light + air.to_cloud * clouds.rgb + air.transmittance * clouds.a * scene, air_only, air.transmittance * clouds.a);
}

// From afar the bright rim of the air is narrower than a pixel: rays across the limb, side by side in the pixel, see what share of it
// there is. `center`: what the pixel's own ray found; `ground`: whether it met any.
fn across_limb(pixel: vec2i, dir: vec3f, ground: bool, scene: vec3f, clouds: vec4f, cloud_at: f32, center: Along) -> Along {
    const RAYS: i32 = 8;
    let radius = globals.eye_km.w;
    let eye = globals.eye_up.w + radius;
    let ahead = -eye * dot(dir, globals.eye_up.xyz);
    let lowest = globals.eye_up.xyz * eye + dir * ahead;
    let height = length(lowest) - radius;
    // From a pixel to the next across the limb, km. Where mountains are wider than that, the limb is not the sphere's.
    let step = globals.eye_low_m.w * ahead;
    if globals.air.x <= 0.0 || ahead <= 0.0 || step < 1.5 || abs(height) > globals.air.x + 2.0 * step || (height < 0.0) != ground { return center; }
    // Within the air the rim is as wide as the air is deep, and a ray down meets the ground long before the limb.
    let outside = smoothstep(globals.air.x, 1.2 * globals.air.x, globals.eye_up.w);
    if outside <= 0.0 || height < -2.0 * step { return center; }
    let outwards = lowest / length(lowest);
    // What the limb hides or shows to the next pixel inwards.
    let towards = vec2f(dot(outwards, globals.ray_right.xyz) / length(globals.ray_right.xyz), -dot(outwards, globals.ray_up.xyz) / length(globals.ray_up.xyz));
    let size = vec2i(textureDimensions(scene_color));
    let inner = clamp(vec2i(floor(vec2f(pixel) + 0.5 - 1.5 * normalize(towards))), vec2i(0), size - 1);
    let surface = select(textureLoad(scene_color, inner, 0).rgb, scene, ground);
    let space = select(scene, NIGHT_BACKGROUND * NIGHT_SKY, ground);
    var sum = Along(vec3f(0.0), 0.0, vec3f(0.0));
    for (var i = 0; i < RAYS; i++) {
        let aside = (f32(i) + 0.5) / f32(RAYS) - 0.5;
        let ray = normalize(dir + outwards * (aside * globals.eye_low_m.w));
        let to_middle = eye * dot(ray, globals.eye_up.xyz);
        let hits = ray_sphere(to_middle, globals.eye_up.w * (2.0 * radius + globals.eye_up.w));
        let meets = hits.y >= hits.x;
        // Over the clouds there are none.
        let over = height + aside * step > globals.clouds.y;
        let seen = along(ray, select(NOTHING_KM, hits.x, meets), select(space, surface, meets), select(clouds, vec4f(0.0, 0.0, 0.0, 1.0), over), select(cloud_at, NOTHING_KM, over));
        sum.light += seen.light / f32(RAYS);
        sum.air_only += seen.air_only / f32(RAYS);
        sum.transmittance += select(seen.transmittance, vec3f(0.0), meets) / f32(RAYS);
    }
    return Along(mix(center.light, sum.light, outside), mix(center.air_only, sum.air_only, outside), mix(center.transmittance, sum.transmittance, outside));
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Seen {
    let pixel = vec2i(position.xy);
    let ray = pixel_ray(position.xy);
    let ray_length = length(ray);
    let dir = ray / ray_length;
    let far = surface_distance(pixel, dir, ray_length);
    let ground = far < NOTHING_KM;
    var scene = textureLoad(scene_color, pixel, 0).rgb;
    if !ground { scene = NIGHT_BACKGROUND * NIGHT_SKY + sun_disc(dir); }
    var clouds = vec4f(0.0, 0.0, 0.0, 1.0);
    var cloud_at = NOTHING_KM;
    if globals.clouds.z > 0.0 {
        let around = clouds_around(pixel);
        clouds = around.light;
        cloud_at = around.at_km;
    }
    let seen = across_limb(pixel, dir, ground, scene, clouds, cloud_at, along(dir, far, scene, clouds, cloud_at));
    let scattered = glare(dir);
    var points = vec3f(0.0);
    // The sky counts a little seen from beneath, from outer space not at all.
    var counts = 1.0;
    if !ground {
        // Stars drown in a bright sky, and at dusk too, when exposure is long.
        let drowned = 1.0 / (1.0 + 1e6 * seen.air_only + 40.0 * luminance(clouds.rgb) + 1e3 * luminance(scattered));
        // As wide as a pixel of the display, not of this picture: as bright at every quality.
        let shown = globals.eye_low_m.w * max(f32(globals.modes.y), 1.0);
        let spread = select(1.0, 0.5, globals.modes.y == 0u);
        points = stars(dir, shown) * (drowned * spread) * seen.transmittance;
        let inside = 1.0 - smoothstep(0.1, 0.5, globals.eye_up.w / max(globals.air.x, 1e-3));
        let sky = seen.air_only + luminance(clouds.rgb) + luminance(NIGHT_SKY);
        counts = 0.3 * inside * saturate1(sky / (sky + luminance(scene)));
    }
    return Seen(vec4f(min(seen.light + scattered, vec3f(60000.0)), counts), vec4f(sqrt(points), 1.0));
}
