// What counting and metering share. `STRIDE` must match src/render/exposure.rs.
#include "math.wgsl"

const BINS: u32 = 128u;
// Number of the counter of white pixels, after the bins.
const WHITE: u32 = BINS;
const BINS_PER_EV: f32 = 5.0;
// Luminance of the first bin, in stops; sunlit white ground has 0.
const DARKEST_EV: f32 = -22.0;
const STRIDE: u32 = 4u;
