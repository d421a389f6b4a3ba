// The air of a gas giant below the tops of its clouds: a haze that goes on into the depth and dims and reddens the
// light. Deep in a thick scattering medium radiance falls exponentially, the faster the more is absorbed
// (van de Hulst, Multiple Light Scattering, 1980, chapter 5); here blue is.
#include "light.wgsl"
#include "stars.wgsl"

// Whether the eye is in the clouds of a giant or just above (src/render/variant.rs).
override IN_GIANT: bool = false;

// Extinction of the haze, and height over which it thins out above the tops.
const FOG_PER_KM: f32 = 0.085;
const FOG_SCALE_KM: f32 = 0.9;
// Depth over which red, green and blue light fall to 1/e. By eye.
const DUSK_KM: vec3f = vec3f(34.0, 20.0, 11.0);
// Reach of the march.
const FOG_REACH_KM: f32 = 140.0;

struct Fog {
    light: vec3f,
    transmittance: vec3f,
    // How far the haze takes the place of the deck of clouds that is seen from above
    share: f32,
}

// Banks of cloud in the haze: density over its mean.
fn fog_banks(at_km: vec3f) -> f32 {
    let wide = smoothstep(0.3, 0.75, sky_noise(at_km / 13.0));
    return 0.12 + wide * (0.5 + 2.2 * smoothstep(0.25, 0.75, sky_noise(at_km / 3.7 + 17.0)));
}

fn giant_fog(dir: vec3f) -> Fog {
    let h = body.eye_altitude_km;
    let mu = dot(dir, body.eye_up);
    var share = 1.0 - smoothstep(0.15, 1.0, h / GIANT_FOG_TOP_KM);
    // Light at the tops: that of a white deck.
    var top = vec3f(0.0);
    var glow = vec3f(0.0);
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, body.eye_km);
        let sun_mu = dot(body.eye_up, active_sun.dir);
        let sunlight = active_sun.irradiance * sun_transmittance(0.0, sun_mu) * max(sun_mu, 0.0);
        top += (sunlight + sky_irradiance(0.0, sun_mu)) / PI;
        // Droplets scatter forwards: around the sun the haze is brighter, as long as its place is known.
        let forward = max(dot(dir, active_sun.dir), 0.0);
        glow += sunlight / PI * (0.5 * pow(forward, 4.0) + 2.0 * pow(forward, 60.0));
    }
    var light = vec3f(0.0);
    var transmittance = 1.0;
    var from_km = 0.0;
    const PARTS: f32 = 14.0;
    let growth = log(1.0 + FOG_REACH_KM / 1.5) / PARTS;
    for (var part = 1.0; part <= PARTS; part += 1.0) {
        let to_km = 1.5 * (exp(growth * part) - 1.0);
        let middle_km = 0.5 * (from_km + to_km);
        let height_km = altitude_along(body.radius_km, h, mu, middle_km);
        let below_km = max(-height_km, 0.0);
        // Banks that are smaller than a part of the march have their mean.
        let at_km = body.eye_km + dir * middle_km;
        let far = saturate1((to_km - from_km) / 22.0);
        let banks = mix(fog_banks(at_km), 1.0, far);
        let density = exp(-max(height_km, 0.0) / FOG_SCALE_KM) * banks;
        let through = exp(-FOG_PER_KM * density * (to_km - from_km));
        let dusk = exp(-below_km / DUSK_KM);
        // Banks above shade it.
        let shaded = mix(1.25 * exp(-0.5 * fog_banks(at_km + body.eye_up * 2.5)), 0.85, far);
        let own = top * dusk * shaded + glow * exp(-below_km / 4.0);
        light += transmittance * (1.0 - through) * own;
        transmittance *= through;
        from_km = to_km;
    }
    return Fog(light * body.giant_fog, vec3f(transmittance), share);
}
