// Constants and ray geometry. Intersections with spheres are computed from the altitude over the sphere, never from
// |p|^2 - R^2, which loses all digits in 32 bits near the ground.

const PI: f32 = 3.14159265;
// Distance of a ray that hits nothing.
const NOTHING_KM: f32 = 1e9;

fn saturate1(x: f32) -> f32 { return clamp(x, 0.0, 1.0); }

fn luminance(c: vec3f) -> f32 { return dot(c, vec3f(0.2126, 0.7152, 0.0722)); }

// Near and far distance at which a ray meets a sphere; far < near without a hit. `b`: dot(origin from the centre, ray
// direction). `c`: |origin|^2 - radius^2, computed by the caller as (h - h_sphere) * (2R + h + h_sphere) from
// altitudes.
fn ray_sphere(b: f32, c: f32) -> vec2f {
    let discriminant = b * b - c;
    if discriminant < 0.0 { return vec2f(1.0, -1.0); }
    // One root without cancellation; the other follows from the product of the roots.
    let q = -b - select(-1.0, 1.0, b >= 0.0) * sqrt(discriminant);
    let other = select(c / q, 0.0, q == 0.0);
    return vec2f(min(q, other), max(q, other));
}

// Altitude at distance `t` along a ray that starts at altitude `h` over a sphere of radius `radius`. `mu`: cosine of
// the ray to the zenith at its start.
fn altitude_along(radius: f32, h: f32, mu: f32, t: f32) -> f32 {
    let r = radius + h;
    let grown = t * (t + 2.0 * r * mu);
    return h + grown / (r + sqrt(max(r * r + grown, 0.0)));
}

// Distance t = middle + w|w|: even steps in w place samples densely around `middle`, such as the lowest point of a ray,
// where the air is densest.
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
