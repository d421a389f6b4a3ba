// What counting and metering share. `STRIDE` must match src/render/exposure.rs.
#include "math.wgsl"

const BINS: u32 = 128u;
const BINS_PER_EV: f32 = 5.0;
// Luminance of the first bin, in stops; sunlit white ground has 0.
const DARKEST_EV: f32 = -22.0;
const STRIDE: u32 = 4u;
