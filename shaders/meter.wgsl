// The histogram that histogram.wgsl fills and exposure.wgsl reads.
#include "shared.wgsl"
#include "math.wgsl"

// Index of the counter of white pixels, after the bins.
const WHITE: u32 = METER_BINS;
const BINS_PER_EV: f32 = 5.0;
// Luminance at the lower edge of the first bin, in stops relative to sunlit white ground.
const DARKEST_EV: f32 = -22.0;
