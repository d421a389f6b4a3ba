// Histogram of the picture's luminance, for automatic exposure. The scene's alpha is the weight of a pixel.
#include "meter.wgsl"

@group(0) @binding(0) var scene: texture_2d<f32>;
@group(0) @binding(1) var<storage, read_write> bins: array<atomic<u32>, COUNTERS>;
@group(0) @binding(2) var<uniform> step: MeterStep;

// White pixels (sunlit snow and clouds): least luminance, and least ratio of the weakest to the strongest channel.
const WHITE_LUMINANCE: f32 = 0.28;
const WHITE_SHARE: f32 = 0.65;

var<workgroup> here: array<atomic<u32>, COUNTERS>;

@compute @workgroup_size(METER_GROUP, METER_GROUP)
fn compute(@builtin(global_invocation_id) at: vec3u, @builtin(local_invocation_index) index: u32) {
    for (var i = index; i < COUNTERS; i += METER_GROUP * METER_GROUP) { atomicStore(&here[i], 0u); }
    workgroupBarrier();
    // A sparse grid of pixels, METER_STRIDE apart, is enough.
    let pixel = at.xy * METER_STRIDE + METER_STRIDE / 2u;
    if all(pixel < step.size_px) {
        let light = textureLoad(scene, vec2i(step.origin_px + pixel), 0);
        // The strongest channel counts as well, because colours clip when it is too bright, whatever their luminance.
        let strongest = max(light.r, max(light.g, light.b));
        let bright = mix(luminance(light.rgb), strongest, 0.6);
        let bin = (log2(max(bright, 1e-12)) - DARKEST_EV) * BINS_PER_EV;
        let counts = u32(light.a * WHOLE);
        if bin >= 0.0 {
            let number = min(u32(bin), METER_BINS - 1u);
            atomicAdd(&here[number], counts);
            atomicAdd(&here[ALL + number], u32(WHOLE));
            // Only sky has less than the whole weight.
            if light.a >= 1.0 { atomicAdd(&here[GROUND + number], u32(WHOLE)); }
        }
        let weakest = min(light.r, min(light.g, light.b));
        if luminance(light.rgb) > WHITE_LUMINANCE && weakest > WHITE_SHARE * strongest {
            atomicAdd(&here[WHITE], counts);
        }
    }
    workgroupBarrier();
    for (var i = index; i < COUNTERS; i += METER_GROUP * METER_GROUP) { atomicAdd(&bins[i], atomicLoad(&here[i])); }
}
