// Cover of the clouds from the noise of the weather map.

// Noise, distributed evenly over 0..1.
fn evenly(noise: f32) -> f32 {
    return 0.5 + 0.5 * tanh(noise * 1.9);
}
