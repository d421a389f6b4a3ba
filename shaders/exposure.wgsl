// From the histogram to an exposure that the eye would settle at, and some way from the last exposure towards it.
#include "meter.wgsl"

struct Exposure {
    // Factor on radiance, and the same in stops
    factor: f32,
    ev: f32,
}

@group(0) @binding(0) var<storage, read_write> bins: array<u32, BINS>;
@group(0) @binding(1) var<storage, read_write> exposure: Exposure;
// x: share of the way that is gone now
@group(0) @binding(2) var<uniform> step: vec4f;

// Luminance in stops that suits an exposure of 0, and how far the eye follows what is darker and what is brighter: at night it
// stays darker than by day, and snow stays white.
const NORMAL_EV: f32 = -2.6;
const FOLLOWED_DARK: f32 = 0.78;
// Beyond so many stops less.
const DIM_EV: f32 = 9.0;
const FOLLOWED_DIM: f32 = 0.73;
const FOLLOWED_BRIGHT: f32 = 0.35;
// Beside dark ground a bright sky keeps its colours, and the darker it is the darker it looks: most stops if its luminance were 1, and
// more for each stop less.
const SKY_EV: f32 = 3.8;
const SKY_FOLLOWED: f32 = 0.49;
const LEAST_EV: f32 = -4.0;
const MOST_EV: f32 = 14.5;
// What is so much darker than the brightest does not count, such as the night side beside a crescent.
const SHADOW_EV: f32 = 7.0;

fn stops(bin: u32) -> f32 { return DARKEST_EV + (f32(bin) + 0.5) / BINS_PER_EV; }

@compute @workgroup_size(1)
fn compute() {
    var all = 0.0;
    for (var i = 0u; i < BINS; i++) { all += f32(bins[i]); }
    // The brightest two hundredths are glints and the star itself.
    var over = 0.0;
    var brightest = BINS - 1u;
    while brightest > 0u && over + f32(bins[brightest]) < 0.02 * all {
        over += f32(bins[brightest]);
        brightest--;
    }
    let first = u32(max(f32(brightest) - SHADOW_EV * BINS_PER_EV, 0.0));
    var counted = 0.0;
    for (var i = first; i < BINS; i++) { counted += f32(bins[i]); }
    // Mean of the stops between the tenth and the ninetieth percentile.
    var sum = 0.0;
    var weight = 0.0;
    var passed = 0.0;
    for (var i = first; i < BINS; i++) {
        let here = f32(bins[i]);
        let share = max(min(passed + here, 0.9 * counted) - max(passed, 0.1 * counted), 0.0);
        sum += share * stops(i);
        weight += share;
        passed += here;
    }
    var ev = 0.0;
    if weight > 0.0 {
        let mean = sum / weight;
        let off = NORMAL_EV - mean;
        let darker = min(off, DIM_EV) * FOLLOWED_DARK + max(off - DIM_EV, 0.0) * FOLLOWED_DIM;
        let most = min(MOST_EV, SKY_EV - SKY_FOLLOWED * min(stops(brightest), 0.0));
        ev = clamp(select(darker, off * FOLLOWED_BRIGHT, off < 0.0), LEAST_EV, most);
    }
    exposure.ev = mix(exposure.ev, ev, step.x);
    exposure.factor = exp2(exposure.ev);
    for (var i = 0u; i < BINS; i++) { bins[i] = 0u; }
}
