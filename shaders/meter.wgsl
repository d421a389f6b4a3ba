// The histograms that histogram.wgsl fills and exposure.wgsl reads.
#include "shared.wgsl"
#include "math.wgsl"

// Index of the counter of white pixels, after the bins.
const WHITE: u32 = METER_BINS;
// Indices of the first bins of two more histograms: of all pixels, and of those that are no sky. Their pixels have the
// whole weight.
const ALL: u32 = METER_BINS + 1u;
const GROUND: u32 = 2u * METER_BINS + 1u;
const COUNTERS: u32 = 3u * METER_BINS + 1u;
// Count of a whole pixel.
const WHOLE: f32 = 16.0;
const BINS_PER_EV: f32 = 5.0;
// Luminance at the lower edge of the first bin, in stops relative to sunlit white ground.
const DARKEST_EV: f32 = -22.0;
