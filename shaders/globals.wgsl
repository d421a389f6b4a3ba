// What every pass knows of the frame. Must match `Globals` in src/render/globals.rs.
// Lengths in kilometres unless a name says metres; directions in the planet frame.

struct Globals {
    clip_from_rel_m: mat4x4f,
    // xyz: greater part of the eye's position, metres; w: near plane, metres
    eye_high_m: vec4f,
    // xyz: rest of it; w: angle of a pixel, radians
    eye_low_m: vec4f,
    // xyz: eye from the planet's centre; w: radius of the reference sphere
    eye_km: vec4f,
    // xyz: unit vector from the centre to the eye; w: altitude over the reference sphere
    eye_up: vec4f,
    // Ray of a pixel = forward + x right + y up with x, y in -1..1; w: width, height, time in seconds
    ray_right: vec4f,
    ray_up: vec4f,
    ray_forward: vec4f,
    // xyz: to the star; w: its angular radius
    sun_dir: vec4f,
    // rgb; w: radiance factor of its disc
    sun_irradiance: vec4f,
    // Scattering or extinction per km at the reference sphere; w: scale heights, anisotropy, middle of the absorber
    rayleigh: vec4f,
    mie_scattering: vec4f,
    mie_extinction: vec4f,
    absorber: vec4f,
    // x: thickness of the air, 0 for none; y: half width of the absorber; z: steps of a march
    air: vec4f,
    ground_albedo: vec4f,
    // rgb per metre; w: 1 if there is a sea
    water_absorption: vec4f,
    // w: variance of the slope of all waves (Cox and Munk)
    water_color: vec4f,
    // w: freezing temperature
    ice_color: vec4f,
    // x: level over the reference sphere; y: altitude of the eye over the sea; z, w: temperature at equator and poles
    water: vec4f,
    // xyz: wave vector per metre; w: phase at the eye
    waves: array<vec4f, 16>,
    // rgb; w: optical depth from top to bottom
    cloud_color: vec4f,
    // x, y: bottom and top of the layer; z: coverage, 0 for none; w: period of the band that makes puffs
    clouds: vec4f,
    // Bands of the noise that shapes clouds, widest first; xyz: place of the eye, in periods; w: period in km
    cloud_bands: array<vec4f, 6>,
    // x: steps of a march; y: first step in km and z: growth from step to step of a march that begins in the layer
    cloud_march: vec4f,
    // x, y: cosine and sine of the drift about the pole; z: weather cells along the radius; w: curl
    cloud_turn: vec4f,
    // xyz: seed of the weather map
    cloud_seed: vec4u,
    // xyz: place of the eye in each octave of the mottling, in periods; w: period in metres
    mottle: array<vec4f, 7>,
    // xyz: the eye's position modulo 1024 m, for patterns that repeat; w: how much colder it gets with each metre of height
    eye_wrap_m: vec4f,
    // xyz: the eye's position modulo 2^20 m; w: quality of the ground's patterns, 0 (one tap) to 2
    eye_wrap_far_m: vec4f,
    // x: entries of a mixture of biomes, 10; y, z: lowest and highest height, metres; w: exposure factor
    misc: vec4f,
    // x: view (DebugView), y: pixels drawn for one shown, 0 for half; z: the target encodes sRGB itself; w: tone
    modes: vec4u,
    // The eye that the tiles were chosen for, greater part and rest, metres; w of the rest: angle of its pixels, radians
    chosen_eye_high_m: vec4f,
    chosen_eye_low_m: vec4f,
    // xyz: point of the reference sphere under the eye in each octave of the noise at borders, in periods; w: period in metres
    border: array<vec4f, 5>,
    // Of the biome table; x: border jitter in cells; y: 1 for crisp borders; z: 1 while cells are marked
    table: vec4f,
    // Row of the biome table (0 to 1): x + y times the temperature in °C + z times the height over the sea; w: moisture by metre
    climate: vec4f,
    // rgb: white balance of the camera, gains on radiance
    white: vec4f,
}

@group(0) @binding(0) var<uniform> globals: Globals;
@group(0) @binding(1) var clamped: sampler;
@group(0) @binding(2) var repeated: sampler;
