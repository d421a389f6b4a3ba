// Light on objects that stand on the ground: once for each object, at half its height.
#include "cloud_model.wgsl"
#include "horizon.wgsl"
#include "life_instance.wgsl"
#include "stands.wgsl"

struct Span {
    first: u32,
    count: u32,
}

@group(2) @binding(0) var<storage, read> instances: array<Instance>;
@group(2) @binding(1) var<storage, read_write> lights: array<ObjectLight>;
@group(2) @binding(2) var<uniform> span: Span;

// The first tangent axis of a face of the cube, from its code: the axis, and 3 more if it is negative.
fn slope_axis_of(code: u32) -> vec3f {
    let axis = vec3f(vec3u(code % 3u) == vec3u(0u, 1u, 2u));
    return select(axis, -axis, code >= 3u);
}

@compute @workgroup_size(64)
fn compute(@builtin(global_invocation_id) id: vec3u) {
    if id.x >= span.count { return; }
    let index = span.first + id.x;
    let instance = instances[index];
    let foot_up = normalize(body.eye_km + instance.foot_rel_m * 0.001);
    let rel_km = (instance.foot_rel_m + foot_up * (0.5 * instance.size_m)) * 0.001;
    let up = normalize(body.eye_km + rel_km);
    let distance_km = length(rel_km);
    let along = dot(rel_km, body.eye_up) / max(distance_km, 1e-9);
    let altitude_km = max(altitude_along(body.radius_km, body.eye_altitude_km, along, distance_km), 0.0);
    let layer = instance.horizon.y & 0xffffu;
    let slope_axis = slope_axis_of(instance.horizon.y >> 16u);
    let place = unpack2x16unorm(instance.horizon.x);
    let tile = vec4f(select(f32(layer), -1.0, layer == 0xffffu), 1.0, 0.0, 0.0);
    let width_m = max(f32(instance.material >> 16u) * 0.01, 0.05);
    let at_m = body.eye_wrap_far_m + instance.foot_rel_m;
    let footprint_m = distance_km * 1000.0 * frame.pixel_rad;
    let stand = woods(at_m, footprint_m) + of_one_age(width_m, at_m, footprint_m);
    var out = ObjectLight(vec3f(0.0), 1.0, vec3f(0.0), stand);
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, body.eye_km + rel_km);
        let sun_mu = dot(up, active_sun.dir);
        let seen = visibility(tile, slope_axis, place, 0.0, up, altitude_km);
        let sunlight = active_sun.irradiance * sun_transmittance(altitude_km, sun_mu);
        let clouds = under_clouds(rel_km, altitude_km, sun_mu, distance_km * frame.pixel_rad);
        let share = overcast(clouds.straight, clouds.passed);
        let sky = sky_irradiance(altitude_km, sun_mu) * share.x + sunlight * (max(sun_mu, 0.0) * share.y);
        out.sky += sky * seen.sky;
        let direct = sunlight * (clouds.straight * seen.star);
        if i == 0u {
            out.sun = direct;
            out.visible = seen.star;
        } else {
            // Weaker suns light objects from all sides.
            out.sky += direct * (0.5 * max(sun_mu, 0.0));
        }
    }
    lights[index] = out;
}
