// Nodes of the LUT of light that air scatters for a second time or more.
#include "glow_model.wgsl"

// What a fragment of that LUT draws.
struct ToTurns {
    // Pixel of the multiple-scattering LUT, and its point: altitude in km, cosine of the sun to the zenith
    pixel: vec2f,
    at: vec2f,
    // Cosine to the zenith, and cosines of the azimuths from the sun
    mu: f32,
    turns: vec3f,
    // Share of molecules in all scattering
    by_rayleigh: vec3f,
}

fn to_turns(position: vec4f) -> ToTurns {
    let place = tiled(position);
    let at = point_of_texel(place.pixel);
    let mu = view_cosine_at(f32(place.tile.x) / (GLOW_NODES.x - 1.0));
    let nodes = (f32(TURNS_AT_ONCE * place.tile.y) + vec3f(0.0, 1.0, 2.0)) / (GLOW_NODES.y - 1.0);
    let turns = vec3f(turn_at(nodes.x), turn_at(nodes.y), turn_at(nodes.z));
    let air = air_at(at.x);
    let by_rayleigh = air.rayleigh / max(air.rayleigh + air.mie, vec3f(1e-30));
    return ToTurns(place.pixel.xy, at, mu, turns, by_rayleigh);
}

// The LUT has fourth roots: at night light falls by half from column to column. A straight line between two fourth
// roots has a quarter of the error of one between two values.
fn node_of(light: vec3f) -> vec4f { return vec4f(sqrt(root_of(light)), 1.0); }

fn turns_of(light: Lights) -> Turns { return Turns(node_of(light.first), node_of(light.second), node_of(light.third)); }
