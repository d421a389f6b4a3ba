// Crowns: the single objects of a canopy. Where they are wider than a pixel, the ray to the eye is followed through a
// field of domes that stand on a lattice, each moved within its cell. Light and gaps are those of the dome that it
// meets, as factors on the mean of the canopy; so the mean stays, and crowns that grow too narrow fade into it.

// Pixels across a crown at which it begins to be told from its neighbours, and at which it is drawn whole.
const CROWN_PIXELS: vec2f = vec2f(1.3, 3.0);
// Cosines to the normal of the ground between which single crowns are told: on flatter rays the mean is shown.
const FLATTEST_MU: vec2f = vec2f(0.015, 0.06);
// Grain of narrower crowns: width of a grain in pixels, grains along its tile, and the strength of one crown.
const GRAIN_PIXELS: f32 = 2.5;
const GRAINS_PER_TILE: f32 = 4.0;
const GRAIN: f32 = 0.4;
// Width of the smallest objects that are told apart: the lattice is as exact as 32 bits are.
const LEAST_WIDTH_M: f32 = 1.0;
// Spacing of domes over their width, at the least: denser ones would be hidden.
const LEAST_SPACING: f32 = 0.72;
// Height of a dome over its width.
const DOME_DEPTH: f32 = 1.0;
// Softness of the edge between light and shade on a dome.
const DOME_SOFT: f32 = 0.6;
// Leaves and twigs on domes: period of their noise in widths of a dome, strength of its heights and of its slopes.
const TWIG_WIDTHS: f32 = 1.6;
const TWIGS: vec2f = vec2f(0.45, 1.4);
// Bends of the lattice, so that rows do not show: their period and their size in cells.
const BEND_CELLS: f32 = 48.0;
const BEND: f32 = 1.6;
// Sizes of domes, as factors: the least, and how much larger the largest is. Share of their height that goes with it.
const LEAST_SIZE: f32 = 0.7;
const SIZES: f32 = 0.45;
const HEIGHTS: f32 = 0.7;
// Way of a dome within its cell, in cells.
const JITTER: f32 = 0.65;
// Cosine to the normal of the ground below which rays are taken as steeper: flatter ones would see the highest tops
// alone.
const LEAST_MU: f32 = 0.17;
// Cosine below which rays meet the lit tops more and more. Light of these tops over the mean: the sun behind the eye
// (x), and before it (y).
const FLAT_MU: f32 = 0.55;
const FLAT_TOPS: vec2f = vec2f(0.15, 0.36);
// Depth of the saddles between closed crowns, as a share of the depth of a dome.
const SADDLE: f32 = 0.6;
// Way of the ray from one step to the next, at the most, in cells.
const STEP_CELLS: f32 = 0.4;

// Domes of a population at a pixel.
struct CrownField {
    // Cells on the wrapped length, and their side
    cells: f32,
    cell_m: f32,
    // Of a dome: radius in cells, height of its top, height of the dome alone
    radius: f32,
    height_m: f32,
    depth_m: f32,
    // Share of the cells that have one
    share: f32,
}

// What the ray of a pixel meets.
struct CrownsSeen {
    // How far single crowns are told from their neighbours, 0 to 1
    clear: f32,
    // Share that a crown has of the pixel
    hit: f32,
    // Factors on the mean light of the sun and of the sky
    relief: vec2f,
    // Random number of the crown, 0 to 1
    random: f32,
}

// The dome over a place: height of its surface, 0 without one; place in the dome, in radii; a random number.
fn dome_at(q: vec2f, field: CrownField) -> vec4f {
    var best = vec4f(0.0);
    for (var i = 0; i < 4; i++) {
        let row = floor(q.y - 0.5) + f32(i >> 1u);
        // Rows are shifted against one another.
        let shift = fract(0.7548 * row);
        let cell = vec2f(floor(q.x - shift - 0.5) + f32(i & 1), row);
        let wrapped = cell - field.cells * floor(cell / field.cells);
        let random = unit_from_hash(hash3(vec3u(vec2u(wrapped), u32(field.cells))));
        if random.z >= field.share { continue; }
        let size = LEAST_SIZE + SIZES * fract(random.z * 17.0);
        let away = (q - vec2f(shift, 0.0) - cell - 0.5 - JITTER * (random.xy - 0.5)) / (field.radius * size);
        let inside = 1.0 - dot(away, away);
        if inside <= 0.0 { continue; }
        let height_m = field.height_m * (1.0 - HEIGHTS + HEIGHTS * size) - field.depth_m * size * (1.0 - sqrt(inside));
        if height_m > best.x { best = vec4f(height_m, away, fract(random.z * 101.0)); }
    }
    return best;
}

// Two axes of the planet frame along the ground: those of the face of the cube.
fn lattice_axes(up: vec3f) -> mat2x3f {
    let most = abs(up);
    if most.z >= max(most.x, most.y) { return mat2x3f(1.0, 0.0, 0.0, 0.0, 1.0, 0.0); }
    if most.x >= most.y { return mat2x3f(0.0, 1.0, 0.0, 0.0, 0.0, 1.0); }
    return mat2x3f(0.0, 0.0, 1.0, 1.0, 0.0, 0.0);
}

// Grain of crowns that are too narrow to be told apart: a factor of mean 1 on their light. Its grains are some pixels
// wide; the more crowns one holds, the more they even out.
fn crown_grain(width_m: f32, place: CanopyPlace) -> f32 {
    let octave = log2(max(GRAIN_PIXELS * place.footprint_m / width_m, 1.0));
    let at_m = (body.eye_wrap_far_m + place.rel_m).zxy;
    var grains = vec2f(0.0);
    for (var i = 0; i < 2; i++) {
        let crowns = exp2(floor(octave) + f32(i));
        let tile_m = wrapping_m(GRAINS_PER_TILE * crowns * width_m);
        let lod = max(log2(place.footprint_m * NOISE_TILE_SIDE / tile_m), 0.0);
        grains[i] = (2.0 * textureSampleLevel(noise_tile, repeated, at_m / tile_m, lod).r - 1.0) / crowns;
    }
    return 1.0 + GRAIN * mix(grains.x, grains.y, fract(octave));
}

// Crowns of a population. `covered`: area of all its objects for each area of ground where everything suits them;
// `side`: the same from the side; `density`: share of it.
fn crowns_seen(
    width_m: f32, height_m: f32, covered: f32, side: f32, density: f32, place: CanopyPlace, sun: vec3f,
) -> CrownsSeen {
    let n = place.n;
    let v = place.v;
    let across = width_m / max(place.distance_m * frame.pixel_rad, 1e-6);
    let clear = smoothstep(CROWN_PIXELS.x, CROWN_PIXELS.y, across)
        * smoothstep(LEAST_WIDTH_M, 2.0 * LEAST_WIDTH_M, width_m)
        * smoothstep(FLATTEST_MU.x, FLATTEST_MU.y, dot(n, v));
    var out = CrownsSeen(clear, 0.0, vec2f(1.0), 0.5);
    if clear <= 0.0 { return out; }
    // As many domes as objects, each as wide as one.
    let wanted_m = width_m * max(sqrt(0.25 * PI / max(covered, 1e-4)), LEAST_SPACING);
    let cell_m = wrapping_m(wanted_m);
    let depth_m = min(DOME_DEPTH * width_m, 0.8 * height_m);
    let field = CrownField(round(WRAP_FAR_M / cell_m), cell_m, 0.5 * width_m / cell_m, height_m, depth_m, density);

    let axes = lattice_axes(normalize(body.eye_km + place.rel_m * 0.001));
    let along_x = axes[0] - n * dot(axes[0], n);
    let along_y = axes[1] - n * dot(axes[1], n);
    let at_m = body.eye_wrap_far_m + place.rel_m;
    let bend_m = wrapping_m(BEND_CELLS * cell_m);
    let bent = textureSampleLevel(noise_tile, repeated, at_m.yzx / bend_m, 0.0).r;
    let bent_too = textureSampleLevel(noise_tile, repeated, at_m.zxy / bend_m, 0.0).r;
    let foot = at_m * axes / cell_m + BEND * vec2f(bent, bent_too);
    // Cells that a ray passes while it rises by a metre.
    let mu = max(dot(n, v), LEAST_MU);
    let to_eye = (v - n * dot(n, v)) * axes / (mu * cell_m);
    let is_low = frame.pattern_quality == 0.0;
    let steps = select(10, 5, is_low);
    let top_m = height_m * (1.0 - HEIGHTS + HEIGHTS * (LEAST_SIZE + SIZES));
    let step_m = min(top_m, f32(steps) * STEP_CELLS / max(length(to_eye), 1e-6)) / f32(steps);
    // A flat ray cannot be followed from the tops on: it is where closed crowns meet.
    let saddle_m = (height_m - SADDLE * depth_m) * (1.0 - exp(-2.0 * density * covered));
    var z = min(top_m, saddle_m + f32(steps) * step_m);
    var over_m = -top_m;
    var dome = vec4f(0.0);
    for (var i = 0; i < steps; i++) {
        z -= step_m;
        dome = dome_at(foot + to_eye * z, field);
        if dome.x > max(z, 0.0) { break; }
        over_m = dome.x - z;
    }
    if dome.x <= max(z, 0.0) {
        // The ray is below the tops, or on the ground.
        out.hit = 1.0 - exp(-density * side * max(z / height_m, 0.0) / mu);
        return out;
    }
    out.hit = 1.0;
    let back = saturate1((dome.x - z) / max(dome.x - z - over_m, 1e-4));
    z += step_m * back;
    let found = dome_at(foot + to_eye * z, field);
    if found.x > 0.0 { dome = found; }
    // Domes on a lattice cover more than objects that are spread by chance.
    let tangent = sqrt(max(1.0 - mu * mu, 0.0)) / mu;
    let by_domes = 1.3 * density * PI * field.radius * field.radius + density * side * tangent;
    let by_objects = density * (covered + side * tangent);
    out.hit *= min((1.0 - exp(-by_objects)) / max(1.0 - exp(-by_domes), 1e-4), 1.0);
    let rise = sqrt(max(1.0 - dot(dome.yz, dome.yz), 0.0));
    let steep = 0.5 * width_m / max(depth_m, 1e-3);
    let facing = normalize(along_x * dome.y + along_y * dome.z + n * max(rise * steep, 0.05));
    let mean_facing = 0.7 * normalize(n + 2.0 * v);
    let lit = max(dot(facing, sun) + DOME_SOFT, 0.0) / max(dot(mean_facing, sun) + DOME_SOFT, 0.3);
    // Domes between here and the sun.
    let sun_mu = max(dot(n, sun), 0.05);
    let to_sun = (sun - n * dot(n, sun)) * axes / cell_m;
    var shadow = 0.0;
    for (var i = 1; i <= select(2, 1, is_low); i++) {
        let away_m = 0.45 * width_m * f32(i * i);
        let over = dome_at(foot + to_eye * z + to_sun * away_m, field).x - z - sun_mu * away_m;
        shadow = max(shadow, saturate1(over / (0.15 * width_m)));
    }
    let twigs_m = wrapping_m(TWIG_WIDTHS * width_m);
    let lod = log2(max(place.distance_m * frame.pixel_rad, 1e-4) * NOISE_TILE_SIDE / twigs_m);
    let hit = (at_m + v * (z / mu)).yzx / twigs_m;
    let twig = textureSampleLevel(noise_tile, repeated, hit, max(lod, 0.0)).r;
    let towards_sun = textureSampleLevel(noise_tile, repeated, hit + 0.05 * sun.yzx, max(lod, 0.0)).r;
    let twigs = max((1.0 + TWIGS.x * (2.0 * twig - 1.0)) * (1.0 - TWIGS.y * (towards_sun - twig)), 0.1);
    let open = smoothstep(height_m - 1.6 * depth_m, height_m, z);
    let against = 0.5 - 0.5 * dot(to_eye, to_sun) / max(length(to_eye) * length(to_sun), 1e-6);
    let tops = 1.0 + mix(FLAT_TOPS.x, FLAT_TOPS.y, against) * smoothstep(FLAT_MU, LEAST_MU, mu);
    let tint = twigs * (1.0 + 0.5 * (dome.w - 0.5)) / tops;
    out.random = fract(dome.w * 31.0);
    out.relief = tint * vec2f(lit * (1.0 - 0.75 * shadow) * mix(0.4, 1.12, open), mix(0.45, 1.2, open));
    return out;
}
