// LUT of light that air scatters for a second time or more, by direction, while a slider is held. It takes moments
// alone, where glow.wgsl sums the light from all around.
#include "screen.wgsl"
#include "glow_nodes.wgsl"

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

@fragment
fn fragment(@builtin(position) position: vec4f) -> Turns {
    set_lut_sun();
    let to = to_turns(position);
    var none: Lights;
    if all_is_dark(to.at.x, to.at.y) { return turns_of(none); }
    return turns_of(all_by_moments(to));
}
