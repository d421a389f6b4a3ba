// The mean of the frames of a still scene: each frame has its own place within the pixels, and its own noise in the
// marches. Frames of half as many pixels fill in those between.
#include "screen.wgsl"

@group(1) @binding(0) var frame_light: texture_2d<f32>;
// Square roots of the light of stars
@group(1) @binding(1) var frame_stars: texture_2d<f32>;
// rgb: mean radiance of the frames before; a: sum of their weights
@group(1) @binding(2) var mean_light: texture_2d<f32>;
@group(1) @binding(3) var mean_stars: texture_2d<f32>;

// Fall of the weight of a sample with its squared distance from the middle of the pixel.
const FALL: f32 = 2.3;

struct Output {
    @location(0) light: vec4f,
    @location(1) stars: vec4f,
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Output {
    // The middle of this pixel in the frame, and the sample there.
    let at = position.xy / frame.still_scale + frame.still_jitter_px;
    let size = vec2f(textureDimensions(frame_light));
    let nearest = clamp(floor(at), vec2f(0.0), size - 1.0) + 0.5;
    let off = (at - nearest) * frame.still_scale;
    let weight = exp(-FALL * dot(off, off));
    // Between the samples of a coarse frame light is interpolated; at the samples that makes no difference.
    let read = select(nearest, at, frame.still_scale > 1.0) / size;
    let light = textureSampleLevel(frame_light, clamped, read, 0.0).rgb;
    let stars = textureSampleLevel(frame_stars, clamped, read, 0.0).rgb;
    let pixel = vec2i(position.xy);
    let before = textureLoad(mean_light, pixel, 0);
    // 16 bits hold the sum of the weights of some hundred frames.
    let known = select(before.a, 0.0, frame.still_number == 1u);
    let share = weight / (known + weight);
    let points = select(textureLoad(mean_stars, pixel, 0).rgb, stars, known == 0.0);
    return Output(
        vec4f(mix(select(before.rgb, light, known == 0.0), light, share), known + weight),
        vec4f(mix(points, stars, share), 1.0),
    );
}
