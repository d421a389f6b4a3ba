// Light that air scatters for a second time or more, by moments of the light in the multiple-scattering LUT.
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

// Light that is scattered once more by moments, and what the peak of haze has added to the beam.
fn by_moments(h: f32, sun_mu: f32, by_rayleigh: vec3f, mu: f32, cosine: f32) -> vec3f {
    let light = scattered_light(h, sun_mu);
    let peak = max(sun_beam(h, sun_mu) - sun_transmittance(h, sun_mu), vec3f(0.0));
    var shares = Air(by_rayleigh, 1.0 - by_rayleigh, vec3f(0.0));
    return peak * (shares.rayleigh * rayleigh_phase(cosine) + shares.mie * mie_phase(cosine))
        + scattered(shares, light, haze_moments(), mu, cosine);
}

fn all_by_moments(to: ToTurns) -> Lights {
    let h = to.at.x;
    let sun_mu = to.at.y;
    let cosines = to.mu * sun_mu + flat_of(to.mu) * flat_of(sun_mu) * to.turns;
    return Lights(
        by_moments(h, sun_mu, to.by_rayleigh, to.mu, cosines.x),
        by_moments(h, sun_mu, to.by_rayleigh, to.mu, cosines.y),
        by_moments(h, sun_mu, to.by_rayleigh, to.mu, cosines.z),
    );
}
