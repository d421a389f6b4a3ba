// Light of sun and sky at a point, from the LUTs.
#include "air_model.wgsl"
#include "eclipse.wgsl"
#include "luts.wgsl"

// Optical depth (rgb) and haze (a, km of its density at the reference sphere) along a ray that misses the ground, from
// altitude `h` (km) with cosine `mu` to the zenith.
fn clear_depth(h: f32, mu: f32) -> vec4f {
    let top = body.air_height_km;
    if top <= 0.0 { return vec4f(0.0); }
    var at = vec2f(h, mu);
    if h > top {
        // From outer space, the path starts where the ray enters the air, if it does.
        let b = (body.radius_km + h) * mu;
        let discriminant = b * b - (h - top) * (2.0 * body.radius_km + h + top);
        if b >= 0.0 || discriminant <= 0.0 { return vec4f(0.0); }
        at = vec2f(top, -sqrt(discriminant) / (body.radius_km + top));
    }
    return textureSampleLevel(optical_depth_lut, clamped, depth_uv(at.x, at.y), 0.0);
}

// Transmittance of the air along such a ray.
fn clear_transmittance(h: f32, mu: f32) -> vec3f { return exp(-clear_depth(h, mu).rgb); }

// The same, if light that haze scatters into its forward peak counts as not scattered.
fn beam_transmittance(h: f32, mu: f32) -> vec3f {
    let depth = clear_depth(h, mu);
    return exp(body.mie_scattering_per_km * (haze_peak() * depth.a) - depth.rgb);
}

// Transmittance to the sun, times the share of its disc over the horizon of the smooth planet.
fn sun_transmittance(h: f32, mu: f32) -> vec3f {
    let visible = disc_share(mu - horizon_cosine(h), 0.0);
    if visible <= 0.0 { return vec3f(0.0); }
    return clear_transmittance(h, mu) * visible;
}

// The same, with the light that haze has scattered into its forward peak.
fn sun_beam(h: f32, mu: f32) -> vec3f {
    let visible = disc_share(mu - horizon_cosine(h), 0.0);
    if visible <= 0.0 { return vec3f(0.0); }
    return beam_transmittance(h, mu) * visible;
}

// Whether the sun has set for all air visible from altitude `h` (km). The farthest such air is where a ray that grazes
// the ground leaves the air.
fn all_is_dark(h: f32, sun_mu: f32) -> bool {
    let radius = body.radius_km;
    let dips = acos(radius / (radius + max(h, 0.0))) + 2.0 * acos(radius / (radius + body.air_height_km));
    return asin(sun_mu) < -dips - max(active_sun.radius_rad, 0.0015) - 0.02;
}

// LUTs have most columns around the terminator: where bent_sun has these values, by day and in the planet's shadow, a
// quarter as many as there.
const DAYLIGHT: f32 = 0.1;
const TWILIGHT: f32 = 0.15;

// A cosine of the sun to the zenith, bent by day: the light around a high sun moves with it, so that columns there must
// lie as close in the angle as others.
fn bent_sun(mu: f32) -> f32 { return select(mu / (1.0 + sqrt(max(1.0 - mu, 0.0))), mu, mu < 0.0); }

// Where a cosine of the sun to the zenith lies between the first column of a LUT (0) and the last one (1).
fn unit_of_sun(mu: f32) -> f32 {
    let bend = select(TWILIGHT, DAYLIGHT, mu >= 0.0);
    let bent = bent_sun(mu);
    return 0.5 + 0.5 * (1.0 + bend) * bent / (abs(bent) + bend);
}

// The inverse of unit_of_sun.
fn sun_cosine_at(x: f32) -> f32 {
    let bend = select(TWILIGHT, DAYLIGHT, x >= 0.5);
    let y = (2.0 * x - 1.0) / (1.0 + bend);
    let bent = clamp(bend * y / (1.0 - abs(y)), -1.0, 1.0);
    return select(bent * (2.0 - bent), bent, bent < 0.0);
}

// Scales the dim light of deep twilight into the range of 16-bit floats.
const MULTISCATTER_SCALE: f32 = 1024.0;

// Light at a point, for unit irradiance. It comes from around the sun as by the phase function of Henyey and
// Greenstein, and is brighter or darker upwards and near the zenith or the horizon.
struct Diffuse {
    // Mean radiance over all directions
    mean: vec3f,
    // Mean cosine to the sun of the light around the sun, 0 to 1
    along: f32,
    // Mean squared cosine and mean cosine to the zenith, without the light around the sun
    zenith: vec3f,
    up: f32,
}

// The LUT has square roots of the means. In the planet's shadow, light falls by half from column to column: roots
// between two columns are nearly linear, means are not.
fn light_of_texels(light: vec4f, shape: vec4f) -> Diffuse {
    return Diffuse(light.rgb * light.rgb / MULTISCATTER_SCALE, light.a, shape.rgb, shape.a);
}

// Light that air and ground have scattered at least once.
fn scattered_light(h: f32, sun_mu: f32) -> Diffuse {
    let x = vec2f(unit_of_sun(sun_mu), sqrt(saturate1(h / body.air_height_km)));
    let at = texel_from_unit(x, MULTISCATTER_SIZE);
    return light_of_texels(
        textureSampleLevel(multiscatter_lut, clamped, at, 0, 0.0),
        textureSampleLevel(multiscatter_lut, clamped, at, 1, 0.0),
    );
}

// Square of a cosine, less its mean over all directions.
fn squared(cosine: f32) -> f32 { return cosine * cosine - 1.0 / 3.0; }

// Mean squared cosine of light to the zenith, less that of even light.
fn squared_up(light: Diffuse, sun_mu: f32) -> vec3f {
    return light.zenith + light.along * light.along * squared(sun_mu);
}

// Radiance that air scatters into a ray per km: the moments of the light times those of the phase functions. `moments`:
// of the phase function of haze. `mu` and `cosine`: cosines of the ray to the zenith and to the sun.
fn scattered(air: Air, light: Diffuse, moments: vec2f, mu: f32, cosine: f32) -> vec3f {
    let around = light.along * light.along * squared(cosine);
    let zenith = light.zenith * (1.5 * squared(mu));
    let rayleigh = 0.75 * (around + zenith) + 1.0;
    let peaked = 4.0 * PI * henyey_greenstein(moments.x * light.along, cosine);
    let mie = zenith * (7.5 * moments.y) + (peaked + 3.0 * moments.x * light.up * mu);
    return light.mean * (air.rayleigh * max(rayleigh, vec3f(0.0)) + air.mie * max(mie, vec3f(0.0)));
}

// Where a cosine to the zenith lies between nadir (0) and zenith (1) in the LUT: light changes fastest at the horizon.
fn unit_of_view(mu: f32) -> f32 { return 0.5 + 0.5 * mu; }

// The inverse of unit_of_view.
fn view_cosine_at(unit: f32) -> f32 { return 2.0 * unit - 1.0; }

// Where an azimuth from the sun lies between the sun's (0) and the opposite one (1) in the LUT, by its cosine.
fn unit_of_turn(turn: f32) -> f32 { return pow(max(0.5 - 0.5 * turn, 0.0), 0.6); }

// The inverse of unit_of_turn.
fn turn_at(unit: f32) -> f32 { return 1.0 - 2.0 * pow(unit, 1.0 / 0.6); }

// Radiance that air scatters for a second time or more, per scattering coefficient of all air, for unit irradiance.
// `mu` and `cosine`: cosines of the ray to the zenith and to the sun.
fn scattered_again(h: f32, sun_mu: f32, mu: f32, cosine: f32) -> vec3f {
    let across = sqrt(max(0.0, (1.0 - mu * mu) * (1.0 - sun_mu * sun_mu)));
    let turn = clamp((cosine - mu * sun_mu) / max(across, 1e-6), -1.0, 1.0);
    let node = vec2f(unit_of_view(mu), unit_of_turn(turn)) * (GLOW_NODES - 1.0);
    let first = clamp(floor(node), vec2f(0.0), GLOW_NODES - 2.0);
    let part = node - first;
    let x = clamp(vec2f(unit_of_sun(sun_mu), sqrt(saturate1(h / body.air_height_km))), vec2f(0.0), vec2f(1.0));
    let at = x * (MULTISCATTER_SIZE - 1.0) + 0.5;
    let turn_node = u32(first.y);
    let nearer = glow_of_turn(at, first.x, part.x, turn_node);
    let root = mix(nearer, glow_of_turn(at, first.x, part.x, turn_node + 1u), part.y);
    let square = root * root;
    return square * square / MULTISCATTER_SCALE;
}

// Fourth root of that light at a node of the azimuth, between two nodes of the cosine to the zenith. `at`: texel in a
// tile.
fn glow_of_turn(at: vec2f, view: f32, part: f32, turn: u32) -> vec3f {
    let size = vec2f(GLOW_NODES.x, f32(GLOW_HALVES)) * MULTISCATTER_SIZE;
    let uv = (at + vec2f(view, f32(turn / TURNS_AT_ONCE)) * MULTISCATTER_SIZE) / size;
    let layer = i32(turn % TURNS_AT_ONCE);
    return mix(
        textureSampleLevel(glow_lut, clamped, uv, layer, 0.0).rgb,
        textureSampleLevel(glow_lut, clamped, uv + vec2f(1.0 / GLOW_NODES.x, 0.0), layer, 0.0).rgb,
        part,
    );
}

// Radiance of the night sky: mean over stars, dust and airglow. Sunlit white ground has radiance 1. On the Earth,
// twilight is as bright with the sun 7 degrees below the horizon. The dark-adapted eye sees a thousandth of it, but 16
// bits do not resolve that.
const NIGHT_SKY: vec3f = vec3f(0.85e-5, 1.0e-5, 1.3e-5);
// Share of the night sky that is not drawn as stars, and share of airglow, both emitted and scattered by the air.
// Chosen by eye.
const NIGHT_BACKGROUND: f32 = 0.2;
const NIGHT_AIRGLOW: f32 = 0.7;

// Texture coordinates of a part of the LUT of the sky. `first`: its first column.
fn sky_uv(x: vec2f, size: vec2f, first: f32) -> vec2f {
    return (x * (size - 1.0) + vec2f(first, 0.0) + 0.5) / SKY_LUT_SIZE;
}

// Irradiance of the sky on level ground.
fn sky_irradiance(h: f32, mu: f32) -> vec3f {
    // Night light counts once, however many suns there are.
    let night = select(vec3f(0.0), PI * NIGHT_SKY, is_first_sun);
    if body.air_height_km <= 0.0 { return night; }
    let x = vec2f(unit_of_sun(mu), sqrt(saturate1(h / body.air_height_km)));
    let table = textureSampleLevel(sky_lut, clamped, sky_uv(x, IRRADIANCE_SIZE, IRRADIANCE_AT), 0, 0.0).rgb;
    return table * irradiance_of_sky + night;
}

// Radiance of the sky seen from the reference sphere, the mean over all azimuths.
fn sky_radiance(view_mu: f32, sun_mu: f32) -> vec3f {
    let night = select(vec3f(0.0), NIGHT_SKY, is_first_sun);
    if body.air_height_km <= 0.0 { return night; }
    let x = vec2f(unit_of_sun(sun_mu), sqrt(saturate1(view_mu)));
    let table = textureSampleLevel(sky_lut, clamped, sky_uv(x, SKY_SIZE, SKY_AT), 0, 0.0).rgb;
    return table * irradiance_of_sky + night;
}
