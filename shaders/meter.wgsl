// The histogram that counting fills and metering reads.
#include "shared.wgsl"
#include "math.wgsl"

// The counter of white pixels stands after the bins.
const WHITE: u32 = METER_BINS;
const BINS_PER_EV: f32 = 5.0;
// Luminance of the first bin, in stops; sunlit white ground has 0.
const DARKEST_EV: f32 = -22.0;
