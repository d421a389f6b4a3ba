// Bloom: light that a lens scatters. bloom_first.wgsl takes what is scattered from the picture, at a quarter of its
// size; bloom_down.wgsl halves that again and again, bloom_up.wgsl adds the levels from the coarsest up, and
// tonemap.wgsl adds the finest to the picture.
#include "screen.wgsl"
#include "math.wgsl"

// A cubic B-spline over four texels along each axis, in four filtered samples. `at`: a corner between four texels.
fn spline(image: texture_2d<f32>, at: vec2f) -> vec3f {
    let texel = 1.0 / vec2f(textureDimensions(image));
    var sum = vec3f(0.0);
    for (var i = 0; i < 4; i++) {
        // The filter weighs the inner texel three times the outer one.
        let aside = vec2f(f32(i % 2), f32(i / 2)) * 1.5 - 0.75;
        sum += textureSampleLevel(image, clamped, (at + aside) * texel, 0.0).rgb;
    }
    return 0.25 * sum;
}

// A level at a place from 0 to 1, magnified without corners: four filtered samples around it.
fn smoothed(image: texture_2d<f32>, place: vec2f) -> vec3f {
    let texel = 1.0 / vec2f(textureDimensions(image));
    var sum = vec3f(0.0);
    for (var i = 0; i < 4; i++) {
        let aside = vec2f(f32(i % 2), f32(i / 2)) - 0.5;
        sum += textureSampleLevel(image, clamped, place + aside * texel, 0.0).rgb;
    }
    return 0.25 * sum;
}
