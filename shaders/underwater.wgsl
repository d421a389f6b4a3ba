// The view from under the sea: Snell's window, total reflection, light shafts, and water that hides what is far.

// Sines of a critical angle: beyond it the surface mirrors (refractive index 1.333).
const INDEX: f32 = 1.333;
// Steps of the march that gathers light shafts.
const SHAFT_STEPS: u32 = 14u;
// Wave numbers of waves whose light reaches far down, radians per metre: 10 m to 2.5 m long.
const SHAFT_PER_M: vec2f = vec2f(0.6, 2.5);
// Contrast of light shafts; by eye.
const SHAFTS: f32 = 3.0;

// Radiance of deep water in a direction, over that straight down: level water is about three times as bright (Tyler,
// Radiance distribution as a function of depth in an underwater environment, 1960). `sine`: of the direction over the
// horizon.
fn around(sine: f32) -> f32 {
    let down = saturate1(-sine);
    return mix(3.0, 1.0, down * (2.0 - down));
}

// Height of a point of a ray over the calm sea, metres.
fn altitude_over_sea_m(dir: vec3f, distance_km: f32, sine: f32) -> f32 {
    let at_m = distance_km * 1000.0;
    let radius_m = (body.radius_km + body.sea_level_km) * 1000.0;
    return body.eye_over_sea_km * 1000.0 + at_m * sine + at_m * at_m * (1.0 - sine * sine) / (2.0 * radius_m);
}

// The water around the eye.
fn eye_column() -> Column {
    let calm_m = -body.eye_up * body.eye_over_sea_km * 1000.0;
    return Column(calm_m, body.eye_depth_m, body.eye_deepening, body.eye_ice);
}

// Light that comes down through the surface: straight from the suns, and from the sky.
struct Downwelling {
    straight: vec3f,
    sky: vec3f,
    // Unit vector under water towards the first sun
    to_sun: vec3f,
}

fn downwelling_at(up: vec3f) -> Downwelling {
    let h = max(body.sea_level_km, 0.0);
    var out = Downwelling(vec3f(0.0), vec3f(0.0), up);
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, body.eye_km);
        let sun_mu = dot(up, active_sun.dir);
        let clouds = under_clouds(vec3f(0.0), h, sun_mu, 0.01);
        let share = overcast(clouds.straight, clouds.passed);
        let sunlight = active_sun.irradiance * sun_transmittance(h, sun_mu) * max(sun_mu, 0.0);
        out.straight += sunlight * clouds.straight;
        out.sky += sky_irradiance(h, sun_mu) * share.x + sunlight * share.y;
        if i == 0u {
            let flat = active_sun.dir - up * sun_mu;
            let sine = length(flat) / INDEX;
            out.to_sun = normalize(flat / INDEX + up * sqrt(max(1.0 - sine * sine, 0.01)));
        }
    }
    return out;
}

// Radiance of what the surface mirrors into a direction: the bed, where the picture shows it, and water.
fn mirrored_below(dir: vec3f, normal: vec3f, up: vec3f, deep_down: vec3f) -> vec3f {
    let down = reflect(dir, normal);
    let deep = deep_down * around(dot(down, up));
    let clip = body.clip_from_rel_m * vec4f(down * 100.0, 1.0);
    let at = clip.xy / max(clip.w, 1e-6);
    if clip.w <= 0.0 { return deep; }
    let inside = clamp(at, vec2f(-0.99), vec2f(0.99));
    let pixel = vec2i(frame.origin_px + frame.size_px * (vec2f(inside.x, -inside.y) * 0.5 + 0.5));
    let bed_km = surface_distance(pixel, length(down) / max(dot(down, body.view_axis), 1e-3));
    if bed_km >= NOTHING_KM { return deep; }
    let transmittance = exp(-body.water_absorption_per_m * min(bed_km * 1300.0, 1e5));
    // Beyond the lower edge of the picture, the mean of the edge stands for the bed.
    var mean = vec3f(0.0);
    for (var i = 0u; i < 4u; i++) {
        let edge = vec2f((f32(i) + 0.5) / 4.0, 0.97);
        mean += 0.25 * textureLoad(scene_color, vec2i(frame.origin_px + frame.size_px * edge), 0).rgb;
    }
    let beyond = smoothstep(0.7, 0.98, max(abs(at.x), abs(at.y)));
    let bed = mix(textureLoad(scene_color, pixel, 0).rgb, mean, beyond);
    return bed * transmittance + deep * (1.0 - transmittance);
}

// Radiance of the sky through the surface from below, or of the water that it mirrors.
fn from_below(dir: vec3f, surface_km: f32, up: vec3f, deep: vec3f) -> vec3f {
    let rel_m = dir * surface_km * 1000.0;
    let sine = dot(dir, body.eye_up);
    let lift_m = select(0.0, altitude_over_sea_m(dir, surface_km, sine), body.wave_steps > 0u);
    let calm_m = rel_m - up * lift_m;
    let step_x = pixel_step(calm_m, up, body.pixel_right);
    let step_y = pixel_step(calm_m, up, body.pixel_up);
    let waves = waves_at(calm_m, up, step_x, step_y, eye_column());
    let normal = normalize(up - waves.slope * skewed(waves).y);
    let cosine = max(dot(dir, normal), 0.02);
    let bent = INDEX * INDEX * (1.0 - cosine * cosine);
    // Waves too small to be drawn blur the edge of the window.
    let rest = max(ice_calmed(body.wave_slope_variance, body.eye_ice) - waves.slope_variance, 0.0004);
    let blur = 0.5 * sqrt(rest);
    let window = smoothstep(-blur, blur, 1.0 - bent);
    let mirror = mirrored_below(dir, normal, up, deep);
    var out = mirror;
    if window > 0.0 {
        let out_cosine = sqrt(max(1.0 - bent, 0.003));
        let refracted = normalize(INDEX * dir + (out_cosine - INDEX * cosine) * normal);
        let mu = max(dot(refracted, up), 0.02);
        let h = max(body.sea_level_km, 0.0);
        let fresnel = 0.02 + 0.98 * pow(1.0 - out_cosine, 5.0);
        var light = vec3f(0.0);
        for (var i = 0u; i < body.sun_count; i++) {
            use_sun_at(i, body.eye_km);
            let sun_mu = dot(up, active_sun.dir);
            let clouds = under_clouds(dir * surface_km, h, sun_mu, 0.01);
            let share = overcast(clouds.straight, clouds.passed);
            let sunlight = active_sun.irradiance * sun_transmittance(h, sun_mu);
            light += sky_radiance(mu, sun_mu) * share.x + sunlight * max(sun_mu, 0.0) * share.y / PI;
            // The sun's disc, spread by the small waves.
            let wide = rest * 0.12 + active_sun.radius_rad * active_sun.radius_rad;
            let off = 1.0 - dot(refracted, active_sun.dir);
            light += sunlight * clouds.straight * exp(-2.0 * off / wide) / (PI * wide);
        }
        // Light is spread over a wider angle under water.
        out = mix(mirror, light * (1.0 - fresnel) * INDEX * INDEX * 0.56 + mirror * fresnel, window);
    }
    return out;
}

// Radiance at the eye under water. `scene`: light of the ground; `terrain`, `surface_km`: distances of the ground and
// of the surface, km.
fn underwater(dir: vec3f, scene: vec3f, terrain: f32, surface_km: f32) -> vec3f {
    let up = body.eye_up;
    let lit = downwelling_at(up);
    let eye_depth_m = max(-body.eye_over_sea_km * 1000.0, 0.0);
    let is_surface = surface_km > 0.0 && surface_km < terrain;
    let path_m = min(select(terrain, surface_km, is_surface) * 1000.0, 1e5);
    let sine = dot(dir, up);
    // Absorption, and scattering out of the path: what deep water scatters back over its absorption (Gordon 1975).
    let scattering = body.water_absorption_per_m * body.water_color * 4.0 + vec3f(0.01);
    let extinction = body.water_absorption_per_m + scattering;
    let color = body.water_color / PI;
    // Mean light scattered along the ray. It falls off with depth as the light from above does.
    let total = lit.straight + lit.sky;
    let depth_rate = body.water_absorption_per_m * 1.2;
    let rate = max(extinction - depth_rate * sine, extinction * 0.05);
    let surface_light = exp(-depth_rate * eye_depth_m);
    let gathered = (1.0 - exp(-rate * path_m)) / rate * extinction;
    // Water scatters sunlight forwards: it glows around the sun (Petzold 1972, flattened).
    let glow = 0.8 + 5.0 * pow(max(dot(dir, lit.to_sun), 0.0), 7.0);
    let gathering = lit.straight * glow + lit.sky;
    let deep = color * total * surface_light;
    var light = deep * around(sine) / max(total, vec3f(1e-9)) * gathering * gathered;
    // Light shafts: sunlight that waves focus.
    let shaft_m = min(path_m, 16.0);
    var shafts = vec3f(0.0);
    var plain = vec3f(0.0);
    for (var i = 0u; i < SHAFT_STEPS; i++) {
        let at_m = shaft_m * (f32(i) + 0.5) / f32(SHAFT_STEPS);
        let depth_m = max(eye_depth_m - at_m * sine, 0.05);
        let to_surface_m = depth_m / max(dot(lit.to_sun, up), 0.2);
        let above = dir * at_m + lit.to_sun * to_surface_m;
        let weight = exp(-extinction * at_m - depth_rate * depth_m);
        let calm_m = above - up * (dot(above, up) + body.eye_over_sea_km * 1000.0);
        let focus = caustics(calm_m, up, depth_m, 0.12, SHAFT_PER_M);
        shafts += weight * focus;
        plain += weight;
    }
    let contrast = (shafts - plain) / max(plain, vec3f(1e-6)) * lit.straight * glow / max(gathering, vec3f(1e-9));
    light *= max(1.0 + SHAFTS * contrast * exp(-eye_depth_m / 30.0), vec3f(0.2));
    let transmittance = exp(-extinction * path_m);
    if is_surface {
        return light + from_below(dir, surface_km, up, deep * 0.9) * transmittance;
    }
    if terrain >= NOTHING_KM { return light; }
    // The bed is lit from above, through the water.
    let bed_m = max(eye_depth_m - path_m * sine, 0.0);
    let at_m = dir * path_m;
    let to_surface_m = bed_m / max(dot(lit.to_sun, up), 0.2);
    let above = at_m + lit.to_sun * to_surface_m;
    let focus = caustics(above - up * dot(above, up), up, bed_m, path_m * frame.pixel_rad * 2.0, LENS_PER_M);
    let sun_share = lit.straight / max(total, vec3f(1e-6));
    return light + scene * exp(-depth_rate * bed_m) * mix(vec3f(1.0), vec3f(focus), sun_share) * transmittance;
}
