// Waves of the sea: the plane waves of the eye's place (src/sea), filtered by the size of a pixel.
#include "macro_variation.wgsl"
#include "nearness.wgsl"

// The water at a point and around it, as `Column` of src/sea/column.rs.
struct Column {
    // A point of the calm sea
    at_m: vec3f,
    // Depth there, metres, and its gradient: a tangent towards deeper water
    depth_m: f32,
    deepening: vec3f,
    // Share of the water that ice covers
    ice: f32,
}

// Depth at a point of the calm sea near the point of the column.
fn depth_under(column: Column, calm_m: vec3f) -> f32 {
    return max(column.depth_m + dot(column.deepening, calm_m - column.at_m), 0.0);
}

// Share of water of a temperature that ice covers, for waves: without the noise that shapes floes.
fn ice_on(temperature_c: f32) -> f32 {
    return smoothstep(ICE_FIRST_COLDER_C, ICE_CLOSED_COLDER_C, body.freezing_c - temperature_c);
}

// Variance of the slope of all waves where there is ice: it leaves none of the short ones that are most of it.
fn ice_calmed(variance: f32, ice: f32) -> f32 {
    return mix(min(variance, CALM_SLOPE_VARIANCE), variance, exp(-ICE_DAMPING_M * ice * ice));
}

// A wave over a bed.
struct Shoaled {
    // Factor of its amplitude
    amplitude: f32,
    // Phase that it gained
    turned: f32,
    // Tangential wave vector, radians per metre
    along: vec3f,
    // How much the bed feels it, 0 on deep water to 1
    felt: f32,
}

// As `Column::shoal` of src/sea/column.rs. `k`: wave number on deep water.
fn shoal(along: vec3f, k: f32, depth_m: f32, deepening: vec3f) -> Shoaled {
    let depths = k * depth_m;
    if depths >= WAVE_DEEP { return Shoaled(1.0, 0.0, along, 0.0); }
    let shallow = tanh(max(depths, 1e-5));
    let slower = sqrt(shallow);
    let turned = WAVE_TURN * inverseSqrt(k) * exp(-WAVE_TURN_FALL * depths);
    let local = along - deepening * (WAVE_TURN_FALL * k * turned);
    let shorter = length(local) / k;
    let aligned = dot(local, along) / max(k * k * shorter, 1e-9);
    let lee = mix(WAVE_LEE, 1.0, smoothstep(-0.5, 0.5, aligned));
    let crowded = pow(shorter * slower / WAVE_CROWDED, 4.0);
    let breaking_m = WAVE_BREAKING * depth_m;
    let unbroken = breaking_m / max(length(vec2f(breaking_m, body.wave_deviation_m)), 1e-9);
    let felt = 1.0 - shallow * shallow;
    let grown = inverseSqrt(slower * (2.0 - shallow)) * mix(1.0, unbroken, felt);
    return Shoaled(grown * lee / (1.0 + crowded), turned, local, felt);
}

// Sum of waves at a point.
struct WaveSum {
    height_m: f32,
    // Gradient of the height, a tangent
    slope: vec3f,
    // Variance of the height, and of the slope, of the waves in the sum
    height_variance: f32,
    slope_variance: f32,
    // Convergence of the horizontal displacement of the waves that break: it is greatest at their crests
    steepness: f32,
    // Variance of that
    steepness_variance: f32,
    // Waves that the bed breaks: their sum, and that a quarter of a period later
    bores_m: vec2f,
    // Variance of the height of such waves, in the sum and of all
    bore_variance: vec2f,
}

// Phase difference from one pixel to the next, radians, from which a wave fades into roughness, up to WAVE_LOST
// (Bruneton, Neyret, Holzschuch, Real-time Realistic Ocean Lighting, 2010): the mean stays and nothing shimmers.
const WAVE_SEEN: f32 = 0.6;

// Wave number of the shortest waves whose breaking makes foam, radians per metre: 1.5 m long.
const BREAKING_PER_M: f32 = 4.2;

// Sums the waves at a point of the calm sea. `step_x`, `step_y`: steps to the next pixel along the water, metres.
fn waves_at(calm_m: vec3f, up: vec3f, step_x: vec3f, step_y: vec3f, column: Column) -> WaveSum {
    var out = WaveSum(0.0, vec3f(0.0), 0.0, 0.0, 0.0, 0.0, vec2f(0.0), vec2f(0.0));
    if NEARNESS == FROM_ORBIT { return out; }
    let least_step = min(length(step_x), length(step_y));
    let depth_m = depth_under(column, calm_m);
    let damping_m = ICE_DAMPING_M * column.ice * column.ice;
    for (var i = 0u; i < body.wave_count; i++) {
        let wave = body.waves[i];
        let along = wave.vector_per_m - up * dot(wave.vector_per_m, up);
        let k = length(along);
        // All later waves are shorter.
        if WAVE_ACROSS * k * least_step > WAVE_LOST { break; }
        let shoaled = shoal(along, k, depth_m, column.deepening);
        let all_m = wave.amplitude_m * shoaled.amplitude * exp(-damping_m * k);
        out.bore_variance.y += 0.5 * all_m * all_m * shoaled.felt;
        let turn = max(abs(dot(shoaled.along, step_x)), abs(dot(shoaled.along, step_y)));
        let seen = 1.0 - smoothstep(WAVE_SEEN, WAVE_LOST, turn);
        if seen <= 0.0 { continue; }
        let amplitude_m = all_m * seen;
        let phase = dot(wave.vector_per_m, calm_m) + wave.phase + shoaled.turned;
        let lift_m = amplitude_m * cos(phase);
        let aside_m = amplitude_m * sin(phase);
        let variance = 0.5 * amplitude_m * amplitude_m;
        let k2 = dot(shoaled.along, shoaled.along);
        out.height_m += lift_m;
        out.slope -= shoaled.along * aside_m;
        out.height_variance += variance;
        out.slope_variance += variance * k2;
        out.bores_m += vec2f(lift_m, aside_m) * shoaled.felt;
        out.bore_variance.x += variance * shoaled.felt;
        if k < BREAKING_PER_M {
            out.steepness += lift_m * sqrt(k2);
            out.steepness_variance += variance * k2;
        }
    }
    return out;
}

// Crests are sharp and troughs flat: height in metres and factor of the slope, as `skewed` of src/sea/waves.rs.
fn skewed(waves: WaveSum) -> vec2f {
    let deviation_m = sqrt(waves.height_variance);
    if deviation_m < 1e-4 { return vec2f(0.0, 1.0); }
    let x = waves.height_m / deviation_m;
    let height_m = waves.height_m + WAVE_SKEW * deviation_m * (x * x - 1.0);
    return vec2f(height_m, max(1.0 + 2.0 * WAVE_SKEW * x, LEAST_SKEWED));
}

// Where a ray meets the displaced sea, km; `flat_km` is where it meets the calm sea, a negative number if nowhere.
// `sine`: of the ray over the horizon. Rays start at the eye, above the waves or below.
fn displaced_km(dir: vec3f, flat_km: f32, sine: f32, column: Column) -> f32 {
    if NEARNESS < FROM_GROUND || body.wave_steps == 0u { return flat_km; }
    let reach_m = 4.0 * body.wave_deviation_m;
    let over_m = body.eye_over_sea_km * 1000.0;
    let is_under = body.eye_is_under == 1u;
    // Beyond this distance the displacement is less than a pixel.
    let far_m = min(body.wave_deviation_m * 3.0 / frame.pixel_rad, 4000.0);
    // The ray is in the slab of the waves from `near` to `to`, on a plane: curvature is felt beyond.
    let slope = select(sine, min(sine, -1e-4), !is_under);
    let rise = select(slope, max(sine, 1e-4), is_under);
    let towards = select(-1.0, 1.0, is_under);
    var near_m = (towards * -reach_m - over_m) / rise;
    var to_m = (towards * reach_m - over_m) / rise;
    near_m = max(near_m, 0.0);
    if near_m > far_m || to_m <= 0.0 { return flat_km; }
    to_m = min(to_m, far_m);
    var before = vec2f(near_m, 1.0);
    for (var i = 1u; i <= body.wave_steps; i++) {
        // Steps grow with distance.
        let share = f32(i) / f32(body.wave_steps);
        let at_m = near_m + (to_m - near_m) * share * mix(share, 1.0, 0.5);
        let over = wave_gap(dir, at_m, column) * -towards;
        if over <= 0.0 {
            // Regula falsi between the last two steps.
            var outer = before;
            var inner = vec2f(at_m, over);
            for (var j = 0u; j < 4u; j++) {
                let between = mix(outer.x, inner.x, clamp(outer.y / max(outer.y - inner.y, 1e-6), 0.05, 0.95));
                let gap = wave_gap(dir, between, column) * -towards;
                if gap > 0.0 { outer = vec2f(between, gap); } else { inner = vec2f(between, gap); }
            }
            return mix(outer.x, inner.x, clamp(outer.y / max(outer.y - inner.y, 1e-6), 0.0, 1.0)) * 0.001;
        }
        before = vec2f(at_m, over);
    }
    return select(flat_km, -1.0, to_m < far_m && flat_km < 0.0);
}

// Height of a point of a ray over the waves, metres.
fn wave_gap(dir: vec3f, at_m: f32, column: Column) -> f32 {
    let rel_m = dir * at_m;
    let radius_m = (body.radius_km + body.sea_level_km) * 1000.0;
    let sine = dot(dir, body.eye_up);
    let over_m = body.eye_over_sea_km * 1000.0 + at_m * sine + at_m * at_m * (1.0 - sine * sine) / (2.0 * radius_m);
    let up = normalize(body.eye_up * radius_m + rel_m);
    let step = vec3f(at_m * frame.pixel_rad, 0.0, 0.0);
    let waves = waves_at(rel_m - up * over_m, up, step, step, column);
    return over_m - skewed(waves).x;
}
