// Constants and ray geometry. Everything that meets a sphere works from the altitude over it, never from |p|^2 - R^2,
// which loses every digit in 32 bits near the ground.

const PI: f32 = 3.14159265;
// Farther than anything.
const NOTHING_KM: f32 = 1e9;

fn saturate1(x: f32) -> f32 { return clamp(x, 0.0, 1.0); }

fn luminance(c: vec3f) -> f32 { return dot(c, vec3f(0.2126, 0.7152, 0.0722)); }

// Near and far distance at which a ray meets a sphere; far < near when it does not.
// `b`: dot(origin from the centre, ray direction); `c`: |origin|^2 - radius^2, which the caller gets as
// (h - h_sphere) * (2R + h + h_sphere) from altitudes.
fn ray_sphere(b: f32, c: f32) -> vec2f {
    let discriminant = b * b - c;
    if discriminant < 0.0 { return vec2f(1.0, -1.0); }
    // The root that does not cancel, and the other from the product of both.
    let q = -b - select(-1.0, 1.0, b >= 0.0) * sqrt(discriminant);
    let other = select(c / q, 0.0, q == 0.0);
    return vec2f(min(q, other), max(q, other));
}

// Altitude after a way `t` from altitude `h` over a sphere of radius `radius` when the cosine to the zenith was `mu`.
fn altitude_along(radius: f32, h: f32, mu: f32, t: f32) -> f32 {
    let r = radius + h;
    let grown = t * (t + 2.0 * r * mu);
    return h + grown / (r + sqrt(max(r * r + grown, 0.0)));
}

// Samples crowd about `middle`, such as the lowest point of a way, where air is densest: t = middle + w|w|.
fn bent(w: f32, middle: f32) -> f32 { return middle + w * abs(w); }

// Integer hash (pcg3d, Jarzynski and Olano, Hash Functions for GPU Rendering, 2020).
fn hash3(p: vec3u) -> vec3u {
    var v = p * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3u(16u));
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return v;
}

fn unit_from_hash(v: vec3u) -> vec3f { return vec3f(v >> vec3u(8u)) * (1.0 / 16777216.0); }
