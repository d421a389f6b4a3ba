// Tone curves from radiance (1: white ground at noon) to linear display values, 0 to 1. src/render/tone.rs has the same
// curves for the CPU, with their sources.
#include "math.wgsl"

// Factor on exposed radiance of a luminance: dark parts are lifted by some stops, bright ones stay.
// The product rises with the luminance up to a fill of 3 stops.
fn fill(lightness: f32, fill_ev: f32) -> f32 {
    let share = lightness / FILL_HALF;
    return 1.0 + (exp2(fill_ev) - 1.0) / (1.0 + share * share);
}

// Curve from 0 with slope 1 to 1 at infinity; the greater the power, the sharper the bend.
fn bend(x: vec3f, power: f32) -> vec3f { return x / pow(1.0 + pow(x, vec3f(power)), vec3f(1.0 / power)); }

// `beyond_ev`: stops by which highlights exceed white. The curve bends towards white and black the more gently, so that
// they keep their colours, and dark ground before them can be read.
fn agx(radiance: vec3f, beyond_ev: f32) -> vec3f {
    let mixed = AGX_IN * max(radiance, vec3f(0.0));
    let gentle = 1.0 - exp(-AGX_GENTLER * beyond_ev);
    let toe = mix(AGX_TOE, AGX_LONG_TOE, gentle);
    let shoulder = mix(AGX_SHOULDER, AGX_LONG_SHOULDER, gentle);
    let rise = AGX_SLOPE * log2(max(mixed, vec3f(1e-10)) / AGX_PIVOT);
    let dark = AGX_PIVOT_CODE * (1.0 - bend(max(-rise, vec3f(0.0)) / AGX_PIVOT_CODE, toe));
    let light = (1.0 - AGX_PIVOT_CODE) * bend(max(rise, vec3f(0.0)) / (1.0 - AGX_PIVOT_CODE), shoulder);
    // The toe never reaches zero.
    let black = AGX_PIVOT_CODE * (1.0 - bend(vec3f(AGX_BLACK_EV * AGX_SLOPE / AGX_PIVOT_CODE), toe).x);
    let curved = max(dark + light - black, vec3f(0.0));
    // Highlights keep a part of the ratios of their channels: the curve of each by itself would make all of them white.
    let peak = max(mixed.r, max(mixed.g, mixed.b));
    let highest = max(curved.r, max(curved.g, curved.b));
    let ratios = pow(mixed / max(peak, 1e-10), vec3f(1.0 / 2.2));
    let bright = saturate1((highest - AGX_PIVOT_CODE) / (1.0 - AGX_PIVOT_CODE));
    let film = mix(curved, highest * ratios, AGX_KEPT * gentle * bright);
    let grey = dot(film, vec3f(0.2126, 0.7152, 0.0722));
    let code = saturate(AGX_OUT * (grey + AGX_SATURATION * (film - grey)));
    return pow(code, vec3f(2.2));
}

fn neutral(radiance: vec3f) -> vec3f {
    const KNEE: f32 = 0.76;
    const PALING: f32 = 0.15;
    let light = max(radiance, vec3f(0.0));
    let least = min(light.r, min(light.g, light.b));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let raised = light - offset;
    let peak = max(raised.r, max(raised.g, raised.b));
    if peak < KNEE { return raised; }
    let shrunk = 1.0 - (1.0 - KNEE) * (1.0 - KNEE) / (peak + 1.0 - 2.0 * KNEE);
    return mix(vec3f(shrunk), raised * (shrunk / peak), 1.0 / (PALING * (peak - shrunk) + 1.0));
}

fn toned(radiance: vec3f, tone: u32, beyond_ev: f32) -> vec3f {
    switch tone {
        case TONE_AGX: { return agx(radiance, beyond_ev); }
        case TONE_NEUTRAL: { return neutral(radiance); }
        default: { return saturate(radiance); }
    }
}
