// Counts how much of the picture is how bright, for automatic exposure. The scene's alpha says how much a pixel counts.
#include "meter.wgsl"

@group(0) @binding(0) var scene: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> bins: array<atomic<u32>, BINS>;

var<workgroup> here: array<atomic<u32>, BINS>;

@compute @workgroup_size(16, 16)
fn compute(@builtin(global_invocation_id) at: vec3u, @builtin(local_invocation_index) index: u32) {
    if index < BINS { atomicStore(&here[index], 0u); }
    workgroupBarrier();
    // One pixel in so many each way is enough.
    let pixel = at.xy * STRIDE + STRIDE / 2u;
    if all(pixel < textureDimensions(scene)) {
        let light = textureLoad(scene, vec2i(pixel), 0);
        let place = (log2(max(luminance(light.rgb), 1e-12)) - DARKEST_EV) * BINS_PER_EV;
        if place >= 0.0 { atomicAdd(&here[min(u32(place), BINS - 1u)], u32(light.a * 16.0)); }
    }
    workgroupBarrier();
    if index < BINS { atomicAdd(&bins[index], atomicLoad(&here[index])); }
}
