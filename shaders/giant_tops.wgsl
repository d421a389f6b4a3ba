// The tops of a giant's clouds from near: heaps of cloud below the size of the bands' filaments, the finer the nearer
// the eye. Like the bands, each of two tracings is carried by the jets for some hours and fades (src/giant.rs).
#include "giant.wgsl"

// Slope that each octave of the heaps adds.
const TOPS_STEEPNESS: f32 = 0.11;

// Gradient (xyz) and height (w) of the heaps in radii. `footprint`: width of a pixel in radii.
fn tops_at(dir: vec3f, footprint: f32) -> vec4f {
    var sum = vec4f(0.0);
    var weights = 1e-6;
    for (var i = 0u; i < 2u; i++) {
        let tracing = body.giant_detail[i];
        let turn = -band_at(dir.z).a * tracing.x;
        let place = turned_about_axis(dir, turn);
        var per_radius = 1.0 / body.giant_detail_radii;
        var heaps = vec4f(0.0);
        for (var octave = 0u; octave < body.giant_octaves; octave++) {
            let seen = 1.0 - smoothstep(0.2, 0.6, footprint * per_radius);
            // The longest are drawn out along the jets; the others are round.
            let stretch = vec3f(1.0, 1.0, select(1.0, 1.7, octave < 2u)) * per_radius;
            let noise = flow_noise(place * stretch, u32(tracing.z) + 211u * octave);
            // Round tops, and hollows between them: folded, with a soft fold that shows no edge from near.
            let fold = sqrt(noise.w * noise.w + 0.012);
            let height = TOPS_STEEPNESS / per_radius * seen;
            heaps += vec4f(noise.xyz * stretch * (noise.w / fold), fold - 0.3) * height;
            per_radius *= GIANT_DETAIL_RATIO;
        }
        sum += vec4f(turned_about_axis(heaps.xyz, -turn), heaps.w) * tracing.y;
        weights += tracing.y * tracing.y;
    }
    // Two patterns that have nothing in common are flatter together than each alone.
    return sum * inverseSqrt(weights);
}

// The deck with its heaps: albedo, and slope of the tops.
fn giant_tops(dir: vec3f, footprint: f32) -> Deck {
    let deck = giant_deck(dir, footprint);
    let tops = tops_at(dir, footprint);
    // High tops are white, hollows show the darker and redder clouds below.
    let high = tops.w / (0.25 * TOPS_STEEPNESS * body.giant_detail_radii);
    let rise = clamp(high, -1.0, 1.0) * min(f32(body.giant_octaves), 1.0);
    var albedo = deck.albedo * exp(rise * vec3f(0.10, 0.16, 0.24));
    albedo = mix(albedo, body.giant_bright, 0.18 * smoothstep(0.35, 1.0, rise));
    let thick = mix(0.6, 1.2, saturate1(luminance(deck.albedo) * 2.0));
    return Deck(clamp(albedo, vec3f(0.0), vec3f(1.0)), tops.xyz * thick - deck.slope * GIANT_RELIEF);
}

// Share of the active sun's light that higher tops let through.
fn tops_in_sun(dir: vec3f, footprint: f32) -> f32 {
    let sun_mu = dot(dir, active_sun.dir);
    let towards = (active_sun.dir - dir * sun_mu) / sqrt(max(1.0 - sun_mu * sun_mu, 1e-4));
    let rise = max(sun_mu, 0.02) / sqrt(max(1.0 - sun_mu * sun_mu, 1e-4));
    let own = tops_at(dir, footprint).w;
    var hidden = 0.0;
    var away = max(3.0 * footprint, 0.04 * body.giant_detail_radii);
    for (var tap = 0u; tap < 2u; tap++) {
        let over = tops_at(normalize(dir + towards * away), max(footprint, 0.3 * away)).w - own - rise * away;
        hidden = max(hidden, smoothstep(-0.25, 0.75, over / (TOPS_STEEPNESS * away)));
        away *= 4.0;
    }
    return 1.0 - 0.8 * hidden;
}
