// Water of the sea, of lakes and of rivers: its body, waves, reflection, foam, ice.
#include "cloud_model.wgsl"
#include "waves.wgsl"
#include "floes.wgsl"
#include "visibility.wgsl"

// Mean Fresnel reflectance of a rough sea (Bruneton et al. 2010).
fn fresnel_sea(cosine: f32, variance: f32) -> f32 {
    let sigma = sqrt(variance);
    let grazing = pow(1.0 - saturate1(cosine), 5.0 * exp(-2.69 * sigma));
    return 0.02 + 0.98 * grazing / (1.0 + 22.7 * pow(sigma, 1.5));
}

// Radiance of the sun's glint for unit irradiance: Gaussian slopes (Cox and Munk, 1954) as a Beckmann distribution.
fn glint(n: vec3f, v: vec3f, l: vec3f, variance: f32) -> f32 {
    let n_l = dot(n, l);
    let n_v = max(dot(n, v), 0.03);
    if n_l <= 0.0 { return 0.0; }
    let middle = normalize(l + v);
    let c2 = max(dot(n, middle) * dot(n, middle), 1e-4);
    let slopes = exp(-(1.0 - c2) / (c2 * variance)) / (PI * variance * c2 * c2);
    let fresnel = 0.02 + 0.98 * pow(1.0 - saturate1(dot(v, middle)), 5.0);
    // Waves hide each other at grazing angles (approximation of Smith's term).
    let hidden = 1.0 / (1.0 + variance * (1.0 / max(n_l * n_l, 0.01) + 1.0 / (n_v * n_v)) * 0.25);
    return fresnel * slopes * hidden / (4.0 * n_v);
}

// Water at a pixel.
struct Water {
    rel_km: vec3f,
    // Direction of the view ray
    dir: vec3f,
    // Radiance of the bed without the water
    floor: vec3f,
    // Least and greatest depth in the wet part of the pixel
    depths_m: vec2f,
    temperature_c: f32,
    // Over the surrounding ground, of the first sun and of the sky
    visible: Visibility,
    altitude_km: f32,
    absorption_per_m: vec3f,
    // Light that deep water scatters back
    color: vec3f,
    // Variance of the slope of all waves
    slope_variance: f32,
    // Strength of foam
    foam: f32,
    // Height of the waves at the pixel, metres
    lift_m: f32,
    // 1 in the sea, where ice breaks into floes; 0 where it is closed
    floes: f32,
    // Depth, bed and ice, for waves
    column: Column,
}

// Light that leaves the water: light of the sea bed through the water, and light scattered by the water itself.
fn water_body(water: Water, view_mu: f32, sun_mu: f32, downwelling: vec3f) -> vec3f {
    // Refraction (Snell, refractive index 1.333): paths under water are steeper.
    let path = inverseSqrt(1.0 - (1.0 - view_mu * view_mu) / 1.7769)
        + inverseSqrt(1.0 - (1.0 - sun_mu * sun_mu) / 1.7769);
    let shallow = water.absorption_per_m * min(path * water.depths_m.x, 1e5);
    let deeper = water.absorption_per_m * min(path * (water.depths_m.y - water.depths_m.x), 1e5);
    // Mean over all depths in between.
    let mean = (1.0 - exp(-deeper)) / max(deeper, vec3f(1e-3));
    let transmittance = exp(-shallow) * select(mean, 1.0 - 0.5 * deeper, deeper < vec3f(1e-3));
    return water.floor * transmittance + water.color * downwelling / PI * (1.0 - transmittance);
}

// How gusts and slicks vary the part of the slopes' variance that the wind raises, as the exponent of the noise: glints
// show streaks on photographs from orbit. By eye.
const GUSTS: f32 = 0.5;

fn gusty(variance: f32, noise: f32) -> f32 {
    let raised = max(variance - CALM_SLOPE_VARIANCE, 0.0);
    return min(variance, CALM_SLOPE_VARIANCE) + raised * exp(GUSTS * noise);
}

// Octaves of the macro variation whose patches roughen and smooth the ripples: 5 km to 80 m. Those of gusts and slicks
// seen from afar: 41 km to 640 m.
const RIPPLED: vec2u = vec2u(3u, 5u);
const GUSTY: vec2u = vec2u(2u, 4u);
// Exponent of that noise. By eye.
const RIPPLES: f32 = 0.5;
// The wind draws such patches out: cat's paws, and slicks in the lines of Langmuir's cells, are several times as long
// as wide. So the noise is a mean over points along the wind (line integral convolution: Cabral and Leedom 1993). They
// are a tenth of a period apart, and read a level of detail that has no blobs narrower than that. Low quality has fewer
// points on a shorter way.
const STREAK_POINTS: vec2i = vec2i(3, 5);
const STREAK_STEP: f32 = 0.16;
const STREAK_LOD: f32 = 1.2;
// Standard deviation of the noise over that of the mean.
const STREAK_GAIN: vec2f = vec2f(1.6, 2.0);

// Noise of a range of octaves of the macro variation, drawn out along the wind. Red of the noise tile (x), green (y).
fn streaks(rel_m: vec3f, up: vec3f, footprint_m: f32, octaves: vec2u) -> vec2f {
    var along = body.sea_wind - up * dot(body.sea_wind, up);
    // On the other side of the planet it would have no direction.
    along /= max(length(along), 0.1);
    let is_low = frame.pattern_quality == 0.0;
    let points = select(STREAK_POINTS.y, STREAK_POINTS.x, is_low);
    let gain = select(STREAK_GAIN.y, STREAK_GAIN.x, is_low) / f32(points);
    var position = rel_m;
    var sum = vec2f(0.0);
    for (var i = 0u; i <= octaves.y; i++) {
        let octave = body.variation[i];
        let lod = log2(footprint_m * NOISE_TILE_SIDE / octave.period);
        let share = octave_share(lod);
        if share <= 0.0 { break; }
        if i >= octaves.x {
            let at = octave.offset + position / octave.period;
            var here = vec2f(0.0);
            for (var k = 0; k < points; k++) {
                let aside = (f32(k) - 0.5 * f32(points - 1)) * STREAK_STEP;
                let place = (at + along * aside).zxy;
                here += textureSampleLevel(noise_tile, repeated, place, max(lod, STREAK_LOD)).rg - 0.5;
            }
            sum += here * (share * gain);
        }
        position = OCTAVE_TURN * position;
        along = OCTAVE_TURN * along;
    }
    return sum;
}

// Share of the sea that breaking waves whiten (Monahan and Muircheartaigh 1980), from the variance of the slopes (Cox
// and Munk 1954: 0.003 + 0.00512 times the wind in m/s).
fn whitecaps(variance: f32) -> f32 {
    let wind_m_s = max(variance - CALM_SLOPE_VARIANCE, 0.0) / 0.00512;
    return min(2.95e-6 * pow(wind_m_s, 3.52), 0.12);
}

// Water is not the same everywhere: plankton makes it greener, its absence bluer.
fn tinted(color: vec3f, noise: f32) -> vec3f {
    return color * mix(vec3f(0.9, 0.8, 0.95), vec3f(1.1, 1.3, 1.05), saturate1(0.5 + 0.7 * noise));
}

// Waves at a pixel, as light sees them.
struct Surface {
    normal: vec3f,
    // Variance of the slope of all waves too small to be drawn
    rest: f32,
    // Share that breaking crests whiten, on deep water and at the shore
    foam: f32,
    surf: f32,
}

// Threshold of a normal distribution that a share of it exceeds (Abramowitz and Stegun 1964, 26.2.23 without its last
// terms).
fn exceeded_by(share: f32) -> f32 {
    let t = sqrt(-2.0 * log(clamp(share, 1e-6, 0.5)));
    return t - (2.30753 + 0.27061 * t) / (1.0 + 0.99229 * t + 0.04481 * t * t);
}

// Albedo of fresh foam (Koepke, Effective reflectance of oceanic whitecaps, 1984).
const FOAM_ALBEDO: f32 = 0.55;

// Foam is lace: a share of a surface whitens where a fine noise exceeds it.
fn lace(share: f32, rel_m: vec3f, footprint_m: f32) -> f32 {
    if NEARNESS < FROM_GROUND || share <= 0.0 || footprint_m > 0.4 { return share; }
    let octave = body.variation[VARIATION_OCTAVES - 1];
    let lod = max(log2(footprint_m * NOISE_TILE_SIDE / octave.period), 0.0);
    let at = octave.offset + rel_m / octave.period;
    let coarse = textureSampleLevel(noise_tile, repeated, at, lod).g;
    let fine = textureSampleLevel(noise_tile, repeated, at.yzx * 4.0, lod + 2.0).r;
    let pattern = 0.5 + 1.6 * (mix(coarse, fine, 0.5) - 0.5);
    // A small share would be crumbs all over the water: from near, foam is where waves break.
    let near = share * smoothstep(0.05, 0.3, share);
    let drawn = smoothstep(1.0 - near - 0.4, 1.0 - near + 0.4, pattern) * smoothstep(0.0, 0.02, near);
    return mix(drawn, share, smoothstep(0.1, 0.4, footprint_m));
}

// `open_variance`: of the slope of all waves at the place without ice; the waves of the eye's place are scaled to it.
fn water_surface(water: Water, calm_m: vec3f, up: vec3f, open_variance: f32, noise: f32) -> Surface {
    let step_x = pixel_step(calm_m, up, body.pixel_right);
    let step_y = pixel_step(calm_m, up, body.pixel_up);
    var waves = waves_at(calm_m, up, step_x, step_y, water.column);
    // From afar the few waves that are drawn would make a lattice: there they come in groups.
    let groups = mix(1.0, saturate1(0.75 + 1.1 * noise) + 0.1, smoothstep(300.0, 1500.0, length(calm_m)));
    let scale = sqrt(open_variance / max(body.wave_slope_variance, 1e-6)) * groups;
    let variance = ice_calmed(open_variance, water.column.ice);
    waves.slope *= scale;
    waves.slope_variance *= scale * scale;
    let steeper = skewed(waves).y;
    var out: Surface;
    out.normal = normalize(up - waves.slope * steeper);
    out.rest = max(variance - waves.slope_variance, 0.0004);
    // Crests break where they are steepest; of waves that are not drawn, their share is white.
    let white = whitecaps(variance);
    let deviation = sqrt(max(waves.steepness_variance, 1e-8));
    let limit = exceeded_by(max(white * 1.5, 1e-5));
    let patchy = 0.7 * noise;
    let breaking = smoothstep(limit - 0.5, limit + 1.3, waves.steepness / deviation + patchy);
    let drawn = smoothstep(0.1, 0.45, waves.slope_variance / variance);
    out.foam = mix(white, breaking * saturate1(0.75 + noise), drawn);
    out.surf = surf(waves, water.depths_m, noise);
    return out;
}

// Waves that break along the shore: share of foam. Each crest is a bore: a white front, and foam that dissolves behind.
fn surf(waves: WaveSum, depths_m: vec2f, noise: f32) -> f32 {
    let depth_m = max(0.5 * (depths_m.x + depths_m.y), 0.0);
    let breaks_m = clamp(4.5 * body.wave_deviation_m, 0.25, 4.0);
    let zone = 1.0 - smoothstep(0.7 * breaks_m, 1.25 * breaks_m, depth_m * (1.0 + 0.5 * noise));
    if zone <= 0.0 { return 0.0; }
    // 0 at a crest, and on to 1 at the next one behind
    let behind = fract(atan2(-waves.bores_m.y, waves.bores_m.x) / (2.0 * PI));
    let bore = max(exp(-2.8 * behind), smoothstep(0.88, 1.0, behind));
    // The mean height of the crests of a sea is that much greater than its deviation.
    let high = smoothstep(0.0, 0.9, length(waves.bores_m) / sqrt(max(2.0 * waves.bore_variance.x, 1e-8)));
    let drawn = smoothstep(0.2, 0.8, waves.bore_variance.x / max(waves.bore_variance.y, 1e-8));
    return zone * mix(0.3, bore * high, drawn);
}

// Share of sunlight that the waves above concentrate at a depth: 1 in the mean. The curvature of the surface is a lens
// of focal length 4 over the curvature (refractive index 1.333).
//
// `per_m`: least and greatest wave number that counts, radians per metre. Longer waves have too little curvature,
// shorter ones have their focus near the surface. LENS_PER_M: 4 m to 0.8 m long.
const LENS_PER_M: vec2f = vec2f(1.6, 8.0);

fn caustics(calm_m: vec3f, up: vec3f, depth_m: f32, footprint_m: f32, per_m: vec2f) -> f32 {
    if NEARNESS < FROM_GROUND || footprint_m > 0.6 { return 1.0; }
    var bend = 0.0;
    var variance = 0.0;
    for (var i = 0u; i < body.wave_count; i++) {
        let wave = body.waves[i];
        let along = wave.vector_per_m - up * dot(wave.vector_per_m, up);
        let k2 = dot(along, along);
        if k2 < per_m.x * per_m.x { continue; }
        // All later waves are shorter.
        if k2 > per_m.y * per_m.y { break; }
        // Waves much shorter than the depth blur each other.
        let kept = (1.0 - smoothstep(0.6, 1.9, sqrt(k2) * footprint_m)) * exp(-0.004 * k2 * depth_m);
        bend += wave.amplitude_m * kept * k2 * cos(dot(wave.vector_per_m, calm_m) + wave.phase);
        variance += 0.5 * pow(wave.amplitude_m * kept * k2, 2.0);
    }
    let deviation = 0.25 * depth_m * sqrt(variance);
    let sharp = min(1.0, 0.55 / max(deviation, 1e-4));
    let lens = 1.0 - 0.25 * depth_m * sharp * bend;
    let focus = 1.0 / max(abs(lens), 0.18);
    let fades = exp(-depth_m / 25.0) * min(deviation * 4.0, 1.0);
    return mix(1.0, min(focus, 4.0) * 0.78, fades);
}

// The sky is brighter around a low sun than away from it; the LUT has the mean over all azimuths. The mean of the
// factor is 1; by eye.
fn glow_around(cosine: f32, sun_mu: f32) -> f32 {
    let low = 1.0 - saturate1(abs(sun_mu));
    return mix(1.0, 0.65 + 2.24 * pow(max(cosine, 0.0), 6.0), low * low);
}

// Radiance of water.
fn water_radiance(water: Water) -> vec3f {
    let rel_km = water.rel_km;
    let dir = water.dir;
    let distance_km = length(rel_km);
    let up = normalize(body.eye_km + rel_km);
    let view_mu = clamp(-dot(up, dir), 0.0, 1.0);
    let footprint_m = distance_km * 1000.0 * frame.pixel_rad / max(sqrt(view_mu), 0.1);
    let h = water.altitude_km;
    let rel_m = rel_km * 1000.0;
    let variation = macro_variation(rel_m, footprint_m);
    let ice = ice_at(water, rel_m, up, footprint_m, variation, edge_jitter(rel_m, footprint_m));
    // Only the first sun determines the path of light down through the water.
    let first_mu = max(dot(up, body.suns[0].dir), 0.0);
    // From near, single waves show the wind.
    let far = smoothstep(5.0, 50.0, distance_km);
    var gust = 0.0;
    if far > 0.0 { gust = streaks(rel_m, up, footprint_m, GUSTY).y * far; }
    let slope_variance = gusty(water.slope_variance, gust);
    var surface = Surface(up, 0.0, 0.0, 0.0);
    var fresnel = 0.0;
    var mirror_mu = 0.0;
    var mirrored = up;
    if ice.share < 1.0 {
        surface = water_surface(water, rel_m - up * water.lift_m, up, slope_variance, variation);
        // Gusts raise ripples in patches: between the waves near the eye and the streaks from afar that is what the sea
        // shows.
        let patched = (1.0 - far) * smoothstep(20.0, 150.0, distance_km * 1000.0);
        if patched > 0.0 {
            let ripples = exp(RIPPLES * streaks(rel_m, up, footprint_m, RIPPLED).x);
            surface.rest = max(surface.rest * mix(1.0, ripples, patched), 0.0004);
        }
        fresnel = fresnel_sea(dot(surface.normal, -dir), surface.rest);
        mirrored = reflect(dir, surface.normal);
        // Rough water reflects a patch of sky above the mirror direction.
        mirror_mu = max(dot(mirrored, up), 0.0) + sqrt(surface.rest) * 0.5;
    }
    var downwelling = vec3f(0.0);
    var direct = vec3f(0.0);
    var mirrored_light = vec3f(0.0);
    var by_fog = 0.0;
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, body.eye_km + rel_km);
        let sun = active_sun.dir;
        let sun_mu = dot(up, sun);
        let sunlight = active_sun.irradiance * sun_transmittance(h, sun_mu);
        let clouds = under_clouds(rel_km, h, sun_mu, footprint_m * 0.001);
        // The sky over a shadow is that of the clouds around: the sea mirrors it.
        let share = overcast(clouds.straight_around, clouds.passed_around);
        // The shadow of the ground is known for the first sun only.
        let shadow = clouds.straight * select(1.0, water.visible.star, i == 0u);
        let diffused = sunlight * max(sun_mu, 0.0) * share.y;
        let straight = sunlight * shadow * max(sun_mu, 0.0);
        by_fog = clouds.returned;
        direct += straight;
        downwelling += straight + sky_irradiance(h, sun_mu) * share.x + diffused;
        if ice.share < 1.0 {
            let sky = sky_radiance(mirror_mu, sun_mu) * glow_around(dot(mirrored, sun), sun_mu) * share.x;
            mirrored_light += (sky + diffused / PI) * fresnel * water.visible.sky;
            mirrored_light += sunlight * shadow * glint(surface.normal, -dir, sun, surface.rest);
        }
    }
    var light = vec3f(0.0);
    if ice.share < 1.0 {
        var here = water;
        here.color = tinted(water.color, variation);
        let depth_m = 0.5 * (water.depths_m.x + water.depths_m.y);
        let lit = dot(direct, vec3f(0.333)) / max(dot(downwelling, vec3f(0.333)), 1e-6);
        if depth_m < 30.0 {
            let calm_m = rel_m - up * water.lift_m;
            here.floor *= mix(1.0, caustics(calm_m, up, depth_m, footprint_m, LENS_PER_M), saturate1(lit));
        }
        light = water_body(here, view_mu, first_mu, downwelling) * (1.0 - fresnel) + mirrored_light;
        let white = saturate1(max(surface.surf, surface.foam) * water.foam);
        light = mix(light, FOAM_ALBEDO * downwelling / PI, lace(white, rel_m, footprint_m));
        light += body.water_glow;
    }
    // Light goes to and fro between ice and fog.
    let white = ice.albedo * downwelling / (PI * (1.0 - ice.share * ice.albedo * by_fog));
    return mix(light, white, ice.share);
}
