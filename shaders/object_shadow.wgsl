// Share of the first sun's light that objects leave at a point.
#include "uniforms.wgsl"

// Share in a cascade: a mean over a few texels, which softens the edge.
fn cascade_light(cascade: i32, clip: vec3f) -> f32 {
    let uv = clip.xy * vec2f(0.5, -0.5) + 0.5;
    let texel = 1.0 / vec2f(textureDimensions(object_shadows));
    var sum = 0.0;
    for (var i = 0; i < 4; i++) {
        let aside = vec2f(f32(i & 1), f32(i >> 1u)) - 0.5;
        sum += textureSampleCompareLevel(object_shadows, compared, uv + 1.2 * aside * texel, cascade, clip.z);
    }
    return 0.25 * sum;
}

// `n`: normal of the surface at the point, which is `rel_m` from the eye.
fn object_light(rel_m: vec3f, n: vec3f) -> f32 {
    if body.has_shadows == 0u { return 1.0; }
    var share = 1.0;
    var open = 1.0;
    for (var cascade = 0; cascade < 2; cascade++) {
        let texel_m = body.shadow_texel_m[cascade];
        let from_rel_m = body.shadow_from_rel_m[cascade];
        // A surface does not shade itself: it is looked at from a little above.
        let at = rel_m + (n + body.suns[0].dir) * (1.3 * texel_m);
        let clip = (from_rel_m * vec4f(at, 1.0)).xyz;
        let edge = max(abs(clip.x), abs(clip.y));
        // The next cascade takes over towards the edge.
        let own = open * (1.0 - smoothstep(0.8, 0.98, edge));
        if own > 0.0 && clip.z > 0.0 && clip.z < 1.0 {
            share += own * (cascade_light(cascade, clip) - 1.0);
            open -= own;
        }
    }
    return share;
}
