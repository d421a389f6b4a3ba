// Hues: how the colour of one object differs from the mean of its population, near and in the canopy far away.

// Spread of the colour of leaves from one object to the next: some are yellower, some bluer.
const HUES: vec3f = vec3f(0.34, 0.10, -0.16);
// Strength of stands (stands.wgsl) in the colour: in its brightness, and in its hue as a share of that spread.
const STANDS: f32 = 0.30;
const STAND_HUES: f32 = 0.6;

// Colour of one object of a mean colour. `hue`: 0.5 for the mean; random numbers go from 0 to 1, stands a little
// beyond. Grey objects have no hue.
fn hue_of_one(mean: vec3f, hue: f32) -> vec3f {
    let most = max(mean.x, max(mean.y, mean.z));
    let colorful = 1.0 - min(mean.x, min(mean.y, mean.z)) / max(most, 1e-6);
    return mean * (1.0 + (2.0 * hue - 1.0) * colorful * HUES);
}
