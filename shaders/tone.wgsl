// Curves from radiance (1: white ground at noon) to what a display shows, linear, 0 to 1. The same in src/render/tone.rs, where
// each is told of.
#include "math.wgsl"

const AGX_LIFT: f32 = 1.45;
const AGX_IN: mat3x3f = mat3x3f(
    vec3f(0.842479062253094, 0.0423282422610123, 0.0423756549057051),
    vec3f(0.0784335999999992, 0.878468636469772, 0.0784336),
    vec3f(0.0792237451477643, 0.0791661274605434, 0.879142973793104)
);
const AGX_OUT: mat3x3f = mat3x3f(
    vec3f(1.19687900512017, -0.0528968517574562, -0.0529716355144438),
    vec3f(-0.0980208811401368, 1.15190312990417, -0.0980434501171241),
    vec3f(-0.0990297440797205, -0.0989611768448433, 1.15107367264116)
);

// A look over it, as its makers have several: between their plain one and their punchy one.
const AGX_CONTRAST: f32 = 1.15;
const AGX_SATURATION: f32 = 1.3;

fn agx(radiance: vec3f) -> vec3f {
    let mixed = AGX_IN * max(radiance * AGX_LIFT, vec3f(0.0));
    let x = saturate((log2(max(mixed, vec3f(1e-10))) + 12.47393) / 16.5);
    let curve = (((((15.5 * x - 40.14) * x + 31.96) * x - 6.868) * x + 0.4298) * x + 0.1191) * x - 0.00232;
    // The curve ends a little below black.
    let film = pow(max(curve, vec3f(0.0)), vec3f(AGX_CONTRAST));
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
        case 0u: { return agx(radiance); }
        case 1u: { return neutral(radiance); }
        default: { return saturate(radiance); }
    }
}
