// Aurora: light that electrons excite in the highest air, in curtains along an oval around each magnetic pole. Green
// and red are oxygen's, the purple lower edge is nitrogen's. The pass adds it to the finished air.
#include "surface.wgsl"
#include "luts.wgsl"

@group(2) @binding(2) var cloud_light: texture_2d<f32>;

// Direction of the northern magnetic pole, 10 degrees from the axis.
const MAGNETIC_POLE: vec3f = vec3f(0.0594, -0.1632, 0.9848);
// Lower edge and top, in heights of the air.
const BOTTOM: f32 = 0.95;
const TOP: f32 = 2.6;
const STEPS: i32 = 48;
// The oval lies this much farther from the pole at midnight than on average, radians (Feldstein 1967).
const MIDNIGHT: f32 = 0.07;
// Half width of a curtain and of the faint glow around the curtains, and distance between curtains, km.
const SHEET_KM: f32 = 7.0;
const GLOW_KM: f32 = 260.0;
const BETWEEN_KM: f32 = 150.0;
// Radiance for each km within a bright curtain: 200 kilorayleigh across it, over a night sky of one.
const BRIGHTNESS: f32 = 4e-5;

const GREEN: vec3f = vec3f(0.22, 1.0, 0.38);
const RED: vec3f = vec3f(1.0, 0.1, 0.22);
const PURPLE: vec3f = vec3f(0.75, 0.25, 1.0);

// Noise on the unit sphere, -1 to 1. `blur`: length over which it is a mean.
fn waver(n: vec3f, count: f32, time: f32, blur: f32) -> vec2f {
    let at = n * count + vec3f(0.31, 0.17, 0.73) * (count + time);
    let lod = max(log2(blur * count * NOISE_TILE_SIDE), 0.0);
    return (textureSampleLevel(noise_tile, repeated, at, lod).rg - 0.5) * 2.0;
}

// Integral of exp(-x^2) from 0, as a hyperbolic tangent (Hendrycks, Gimpel, Gaussian error linear units, 2016).
fn bell_to(x: vec3f) -> vec3f {
    let near = clamp(x, vec3f(-4.0), vec3f(4.0));
    return 0.8862269 * tanh(1.1283792 * near + 0.1009 * near * near * near);
}

// The curtains at a point.
struct Curtains {
    // Distance from the middle of each of three, over its half width, and bell_to of it
    off: vec3f,
    bell: vec3f,
    // Each is bright in parts of the oval alone.
    share: vec3f,
    // Rays: fine folds seen through one another
    rays: f32,
    // The glow around them
    diffuse: f32,
}

// `n`: unit vector from the centre; `blur`: length on the unit sphere over which details are a mean.
fn curtains_at(n: vec3f, blur: f32) -> Curtains {
    let sine = dot(n, MAGNETIC_POLE);
    let flat_n = n - MAGNETIC_POLE * sine;
    let flat_sun = body.suns[0].dir - MAGNETIC_POLE * dot(body.suns[0].dir, MAGNETIC_POLE);
    let midnight = -dot(flat_n, flat_sun) * inverseSqrt(max(dot(flat_n, flat_n) * dot(flat_sun, flat_sun), 1e-6));
    let off_km = (asin(clamp(abs(sine), 0.0, 1.0)) - body.aurora_lat_rad + MIDNIGHT * midnight) * body.radius_km;
    if abs(off_km) > 4.0 * GLOW_KM {
        let far = vec3f(off_km / SHEET_KM);
        return Curtains(far, bell_to(far), vec3f(0.0), 0.0, 0.0);
    }
    // Curtains wind along the oval and fold.
    let time = frame.time_secs;
    let wide = waver(n, 0.9, 4e-5 * time, blur);
    let folds = waver(n, 4.0, 2e-4 * time, blur);
    let fine = waver(n, 19.0, 1e-3 * time, blur);
    let side = vec3f(-1.0, 0.0, 1.0);
    let wind_km = side * (BETWEEN_KM * (1.0 + 0.6 * wide.y)) + 190.0 * wide.x
        + (60.0 + 25.0 * side) * folds.x + 14.0 * fine.x;
    let share = 0.8 + 1.5 * folds.y * (1.0 - 0.4 * side) + 0.9 * side * wide.y - 0.25 * abs(side);
    let rays = saturate1(0.6 + 0.8 * waver(n, 37.0, 3e-3 * time, blur).x);
    let diffuse = 0.03 * exp(-(off_km / GLOW_KM) * (off_km / GLOW_KM)) * (0.7 + 0.6 * wide.y);
    let off = (off_km - wind_km) / SHEET_KM;
    return Curtains(off, bell_to(off), clamp(share, vec3f(0.0), vec3f(1.0)), rays, diffuse);
}

// Mean of exp(-x^2) between two points: light of curtains that a step of the march crosses. Steps are longer than
// curtains are wide: samples would show as stripes.
fn crossed(one: Curtains, other: Curtains) -> vec3f {
    let width = other.off - one.off;
    let middle = 0.5 * (one.off + other.off);
    return select((other.bell - one.bell) / width, exp(-middle * middle), abs(width) < vec3f(0.05));
}

// Colour at a height.
fn tint_at(height_km: f32) -> vec3f {
    // The unit of height is 60 km for the Earth.
    let z = (height_km / body.air_height_km - BOTTOM) / 0.6;
    let green = smoothstep(0.0, 0.12, z) * exp(-2.2 * z);
    let red = smoothstep(0.4, 1.3, z) * exp(-0.9 * max(z - 1.0, 0.0));
    let purple = smoothstep(-0.02, 0.05, z) * (1.0 - smoothstep(0.05, 0.3, z));
    return GREEN * green + RED * (0.13 * red) + PURPLE * (0.35 * purple);
}

fn gathered(dir: vec3f, from_km: f32, to_km: f32, jitter: f32) -> vec3f {
    var sum = vec3f(0.0);
    if to_km <= from_km { return sum; }
    let step_km = (to_km - from_km) / f32(STEPS);
    var before: Curtains;
    var before_km = from_km;
    // The first and the last step are parts of one.
    for (var i = 0; i <= STEPS + 1; i++) {
        let at_km = clamp(from_km + (f32(i) - jitter) * step_km, from_km, to_km);
        let p = body.eye_km + dir * at_km;
        let n = normalize(p);
        let here = curtains_at(n, step_km / body.radius_km * length(dir - n * dot(dir, n)));
        if i > 0 {
            let middle = body.eye_km + dir * (0.5 * (at_km + before_km));
            let share = 0.5 * (before.share + here.share);
            let sheets = dot(share, crossed(before, here)) * 0.5 * (before.rays + here.rays);
            let diffuse = 0.5 * (before.diffuse + here.diffuse);
            sum += tint_at(length(middle) - body.radius_km) * ((sheets + diffuse) * (at_km - before_km));
        }
        before = here;
        before_km = at_km;
    }
    return sum;
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let ray = pixel_ray(position.xy);
    let ray_length = length(ray);
    let dir = ray / ray_length;
    let far = surface_distance(pixel, ray_length);
    let h = body.eye_altitude_km;
    let mu = dot(dir, body.eye_up);
    let radius = body.radius_km;
    let bottom = BOTTOM * body.air_height_km;
    let top = TOP * body.air_height_km;
    let inner = ray_sphere((radius + h) * mu, (h - bottom) * (2.0 * radius + h + bottom));
    let outer = ray_sphere((radius + h) * mu, (h - top) * (2.0 * radius + h + top));
    if outer.y < outer.x || outer.y <= 0.0 { return vec4f(0.0); }
    let jitter = gradient_noise(position.xy);
    let enter = max(outer.x, 0.0);
    let crosses = inner.y >= inner.x && inner.y > 0.0;
    var light = vec3f(0.0);
    if crosses && inner.x > 0.0 { light += gathered(dir, enter, min(inner.x, far), jitter); }
    let behind = select(enter, max(inner.y, 0.0), crosses);
    if far > behind { light += gathered(dir, behind, min(outer.y, far), jitter); }
    // Air and clouds below dim it.
    if h < bottom {
        light *= exp(-0.12 / (max(mu, 0.0) + 0.06));
        if has_clouds() { light *= textureLoad(cloud_light, pixel, 0).a; }
    }
    return vec4f(light * (BRIGHTNESS * body.aurora), 0.0);
}
