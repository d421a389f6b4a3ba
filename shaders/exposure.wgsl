// Metering: computes from the histogram the exposure that the eye would adapt to, and moves the last exposure towards
// it.
#include "meter.wgsl"

struct Exposure {
    // Factor on radiance, and the same factor in stops
    factor: f32,
    ev: f32,
    // Stops by which the brightest part of the picture exceeds white (tone.wgsl)
    beyond_ev: f32,
    // Stops by which dark parts of the picture are lifted (tone.wgsl)
    fill_ev: f32,
}

@group(0) @binding(0) var<storage, read_write> bins: array<u32, COUNTERS>;
@group(0) @binding(1) var<storage, read_write> exposure: Exposure;
@group(0) @binding(2) var<uniform> step: MeterStep;

// Mean luminance in stops that needs no correction: middle grey in sunlight. All levels below are relative to sunlit
// white ground.
const NORMAL_EV: f32 = -2.5;
// Share of the difference from NORMAL_EV that exposure corrects, for darker means. The first stops are dark ground in
// sunlight (forest stays dark and snow stays white), the next ones dusk, the last ones night.
const DARK_GROUND_EV: f32 = 2.0;
const FOLLOWED_DARK_GROUND: f32 = 0.4;
const NIGHT_EV: f32 = 9.0;
const FOLLOWED_DUSK: f32 = 0.90;
const FOLLOWED_NIGHT: f32 = 0.79;
// Share that exposure corrects for brighter means.
const FOLLOWED_BRIGHT: f32 = 0.1;
// Highlights: the share of counted pixels that are brighter, the level in stops that they may reach after the
// correction, and the share of the excess that exposure takes back. If they stay below that level, exposure closes a
// share of the gap: a small share, or all of it where much of the picture is white, because snow and clouds must look
// white.
const HIGHLIGHTS: f32 = 0.04;
const HIGHLIGHT_EV: f32 = -0.2;
const FOLLOWED_HIGHLIGHT: f32 = 0.75;
// The correction for highlights does not take the mean below this level: the sea around a setting sun.
const DARKEST_MEAN_EV: f32 = -3.4;
// Broader highlights, such as the sky around a low sun, never exceed this level.
const BROAD_HIGHLIGHTS: f32 = 0.12;
const BROAD_HIGHLIGHT_EV: f32 = -0.5;
// The share of the picture, sky or ground, that may be beyond white, and the level of white in stops. Of what is
// brighter, exposure takes back a share, and for the rest the tone curve gets room.
const BEYOND: f32 = 0.02;
const WHITE_EV: f32 = 0.0;
const FOLLOWED_BEYOND: f32 = 0.55;
const MOST_BEYOND_EV: f32 = 5.0;
// What the highlights of the sky take from the exposure, and what of that the ground gets back where there is some:
// the tone curve has room for such a sky.
const GIVEN_BACK: f32 = 0.25;
const GROUND_SHARE: vec2f = vec2f(0.05, 0.3);
// At dusk the glow must keep its colours, whatever the ground: the level in stops that no more than this share of the
// picture exceeds as sky, the share of the excess that exposure takes back, and the corrections for the mean from which
// it is dusk. By day clouds are to be white.
const DUSK_SKY_SHARE: f32 = 0.07;
const DUSK_SKY_EV: f32 = -1.0;
const FOLLOWED_DUSK_SKY: f32 = 0.5;
const DUSK_FROM_EV: vec2f = vec2f(2.0, 4.0);
// Fill: dark ground before a bright sky, such as dust around a low sun, is lifted as by a graduated filter. The level
// in stops below which the median of the ground is lifted, the share of what is lacking, the most stops, and the levels
// of the sky (exceeded by DUSK_SKY_SHARE of the picture) over which it begins.
const FILL_BELOW_EV: f32 = -3.7;
const FOLLOWED_FILL: f32 = 0.9;
const MOST_FILL_EV: f32 = 2.3;
const FILL_SKY_EV: vec2f = vec2f(-3.0, -1.5);
const LIFTED_HIGHLIGHT: f32 = 0.3;
const LIFTED_SNOW: f32 = 1.0;
// Share of white pixels at which the lift changes from that for ground to that for snow.
const SNOW_SHARE: vec2f = vec2f(0.2, 0.45);
const WIDEST_LIFT_EV: f32 = 2.0;
// A bright sky over dark ground keeps its colours: greatest correction in stops for a sky of luminance 1, and its
// growth for each stop less.
const SKY_EV: f32 = 3.8;
const SKY_FOLLOWED: f32 = 0.49;
// At night there are no colours to keep: a greater growth below a luminance in stops.
const NIGHT_SKY_EV: f32 = -12.0;
const NIGHT_SKY_FOLLOWED: f32 = 0.7;
const LEAST_EV: f32 = -4.0;
const MOST_EV: f32 = 14.5;
// Share of pixels taken for glints and the sun itself. The brightest of the rest set the top of the range.
const GLINTS: f32 = 0.003;
// Range in stops below that top, or below sunlit white if the top is brighter. Darker pixels do not count: the night
// side beside a crescent.
const SHADOW_EV: f32 = 7.0;

fn stops(bin: u32) -> f32 { return DARKEST_EV + (f32(bin) + 0.5) / BINS_PER_EV; }

// Index of the bin that `count` of the counted pixels exceed, at least `first`. `start`: of the histogram.
fn bin_below(count: f32, first: u32, start: u32) -> u32 {
    var over = 0.0;
    var bin = METER_BINS - 1u;
    while bin > first && over + f32(bins[start + bin]) < count {
        over += f32(bins[start + bin]);
        bin--;
    }
    return bin;
}

// Correction in stops for a mean luminance in stops.
fn corrected(mean_ev: f32) -> f32 {
    let off = NORMAL_EV - mean_ev;
    if off < 0.0 { return off * FOLLOWED_BRIGHT; }
    let ground = min(off, DARK_GROUND_EV);
    let dusk = clamp(off - DARK_GROUND_EV, 0.0, NIGHT_EV - DARK_GROUND_EV);
    return ground * FOLLOWED_DARK_GROUND + dusk * FOLLOWED_DUSK + max(off - NIGHT_EV, 0.0) * FOLLOWED_NIGHT;
}

// Level in stops that `count` of the pixels of the sky exceed.
fn sky_exceeded_by(count: f32) -> f32 {
    var over = 0.0;
    var bin = METER_BINS - 1u;
    while bin > 0u {
        over += f32(bins[ALL + bin] - bins[GROUND + bin]);
        if over >= count { break; }
        bin--;
    }
    return stops(bin);
}

// The exposure that the ground alone would have, from the one before highlights limit it; no more than `LEAST_EV` where
// there is hardly any. `counted`: its pixels; `pixels`: all.
fn of_ground(unlimited_ev: f32, counted: f32, pixels: f32) -> f32 {
    let top = stops(bin_below(BEYOND * pixels, 0u, ALL));
    let highlight = stops(bin_below(HIGHLIGHTS * counted, 0u, GROUND));
    let broad = stops(bin_below(BROAD_HIGHLIGHTS * counted, 0u, GROUND));
    let above = max(highlight + unlimited_ev - HIGHLIGHT_EV, 0.0);
    let ev = min(unlimited_ev - FOLLOWED_HIGHLIGHT * above, BROAD_HIGHLIGHT_EV - broad);
    return mix(LEAST_EV, ev, smoothstep(GROUND_SHARE.x, GROUND_SHARE.y, counted / pixels));
}

// Stops by which dark parts are lifted at an exposure, before a sky of a level in stops at that exposure. `counted`:
// pixels of the ground; `pixels`: all.
fn fill_at(ev: f32, sky_ev: f32, counted: f32, pixels: f32) -> f32 {
    let lacking = FILL_BELOW_EV - (stops(bin_below(0.5 * counted, 0u, GROUND)) + ev);
    let sky = smoothstep(FILL_SKY_EV.x, FILL_SKY_EV.y, sky_ev);
    let there = smoothstep(GROUND_SHARE.x, GROUND_SHARE.y, counted / pixels);
    return clamp(FOLLOWED_FILL * lacking, 0.0, MOST_FILL_EV) * sky * there;
}

@compute @workgroup_size(1)
fn compute() {
    var all = 0.0;
    for (var i = 0u; i < METER_BINS; i++) { all += f32(bins[i]); }
    let brightest = bin_below(GLINTS * all, 0u, 0u);
    let range_top = min(f32(brightest), -DARKEST_EV * BINS_PER_EV);
    let first = u32(max(range_top - SHADOW_EV * BINS_PER_EV, 0.0));
    var counted = 0.0;
    for (var i = first; i < METER_BINS; i++) { counted += f32(bins[i]); }
    // Mean in stops between the tenth and the ninetieth percentile.
    var sum = 0.0;
    var weight = 0.0;
    var passed = 0.0;
    for (var i = first; i < METER_BINS; i++) {
        let here = f32(bins[i]);
        let share = max(min(passed + here, 0.9 * counted) - max(passed, 0.1 * counted), 0.0);
        sum += share * stops(i);
        weight += share;
        passed += here;
    }
    let pixels = WHOLE * f32(step.size_px.x * step.size_px.y) / f32(METER_STRIDE * METER_STRIDE);
    // Pixels of the ground, and the level of the sky.
    var ground = 0.0;
    for (var i = 0u; i < METER_BINS; i++) { ground += f32(bins[GROUND + i]); }
    let sky = sky_exceeded_by(DUSK_SKY_SHARE * pixels);
    let top = stops(bin_below(BEYOND * pixels, 0u, ALL));
    let highlight = stops(bin_below(HIGHLIGHTS * counted, first, 0u));
    let broad = stops(bin_below(BROAD_HIGHLIGHTS * counted, first, 0u));
    var ev = 0.0;
    if weight > 0.0 {
        let mean = sum / weight;
        ev = corrected(mean);
        let unlimited = ev;
        let above = highlight + ev - HIGHLIGHT_EV;
        if above > 0.0 {
            ev = max(ev - FOLLOWED_HIGHLIGHT * above, min(ev, DARKEST_MEAN_EV - mean));
        } else {
            let snow = smoothstep(SNOW_SHARE.x, SNOW_SHARE.y, f32(bins[WHITE]) / counted);
            let share = mix(LIFTED_HIGHLIGHT, LIFTED_SNOW, snow);
            ev += share * min(-above, WIDEST_LIFT_EV);
        }
        ev = min(ev, BROAD_HIGHLIGHT_EV - broad);
        let ground_ev = of_ground(unlimited, ground, pixels);
        ev += GIVEN_BACK * max(ground_ev - ev, 0.0);
        let dusk = smoothstep(DUSK_FROM_EV.x, DUSK_FROM_EV.y, unlimited);
        ev -= dusk * FOLLOWED_DUSK_SKY * max(sky + ev - DUSK_SKY_EV, 0.0);
        ev -= FOLLOWED_BEYOND * max(top + ev - WHITE_EV, 0.0);
        let dark = min(stops(brightest), 0.0);
        let night = min(dark - NIGHT_SKY_EV, 0.0);
        let most = min(MOST_EV, SKY_EV - SKY_FOLLOWED * (dark - night) - NIGHT_SKY_FOLLOWED * night);
        ev = clamp(ev, LEAST_EV, most);
    }
    let beyond_ev = clamp(top + ev - WHITE_EV, 0.0, MOST_BEYOND_EV);
    exposure.beyond_ev += clamp((beyond_ev - exposure.beyond_ev) * step.share, -step.most_ev, step.most_ev);
    let fill_ev = fill_at(ev, sky + ev, ground, pixels);
    exposure.fill_ev += clamp((fill_ev - exposure.fill_ev) * step.share, -step.most_ev, step.most_ev);
    exposure.ev += clamp((ev - exposure.ev) * step.share, -step.most_ev, step.most_ev);
    exposure.factor = exp2(exposure.ev);
    for (var i = 0u; i < COUNTERS; i++) { bins[i] = 0u; }
}
