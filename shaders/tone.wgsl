// Tone curves from radiance (1: white ground at noon) to linear display values, 0 to 1. src/render/tone.rs has the same
// curves for the CPU, with their sources.
#include "math.wgsl"

// Curve from 0 with slope 1 to 1 at infinity; the greater the power, the sharper the bend.
fn bend(x: vec3f, power: f32) -> vec3f { return x / pow(1.0 + pow(x, vec3f(power)), vec3f(1.0 / power)); }

fn agx(radiance: vec3f) -> vec3f {
    let mixed = AGX_IN * max(radiance, vec3f(0.0));
    let rise = AGX_SLOPE * log2(max(mixed, vec3f(1e-10)) / AGX_PIVOT);
    let dark = AGX_PIVOT_CODE * (1.0 - bend(max(-rise, vec3f(0.0)) / AGX_PIVOT_CODE, AGX_TOE));
    let light = (1.0 - AGX_PIVOT_CODE) * bend(max(rise, vec3f(0.0)) / (1.0 - AGX_PIVOT_CODE), AGX_SHOULDER);
    // The toe never reaches zero; AGX_BLACK is its value at the end of the 16-bit range.
    let film = max(dark + light - AGX_BLACK, vec3f(0.0));
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

fn toned(radiance: vec3f, tone: u32) -> vec3f {
    switch tone {
        case TONE_AGX: { return agx(radiance); }
        case TONE_NEUTRAL: { return neutral(radiance); }
        default: { return saturate(radiance); }
    }
}
