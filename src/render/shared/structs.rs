//! The structs of uniform buffers, declared once for Rust and WGSL.

use super::constants::{
    BAND_ENTRIES, BORDER_OCTAVES, CLOUD_BANDS, CLOUD_LAYERS, MAX_OCCLUDERS, MAX_POINTS, MAX_STORMS, MAX_SUNS,
    RING_CLASSES, RING_ENTRIES, VARIATION_OCTAVES, WAVES,
};
use crate::render::life::SHADOW_MAPS;
use crate::render::wgsl::uniform_struct;
use glam::{Mat4, UVec2, Vec2, Vec3, Vec4};

uniform_struct! {
    /// Uniforms of a frame.
    Frame {
        /// Left upper corner of the picture in its targets, pixels.
        origin_px: Vec2,
        /// Width and height of the picture, pixels.
        size_px: Vec2,
        /// The view axis in the picture: right and up, 0 in a symmetric projection, +-1 at the edges.
        lens_shift: Vec2,
        /// Distance of the near plane. Depth = near_m / distance along the view axis.
        near_m: f32,
        /// Angle of a pixel in the middle of the picture.
        pixel_rad: f32,
        /// Pixels drawn for each pixel shown, in one direction: 2, 1 or 0.5.
        render_scale: f32,
        /// Pixels developed for each pixel drawn, in one direction: 2 for a still picture at render scale 0.5, else 1.
        still_scale: f32,
        /// Number of the frame among those of a still picture, from 1; 0 for other frames.
        still_number: u32,
        /// Offset of the picture within its pixels, drawn pixels right and down.
        still_jitter_px: Vec2,
        /// Added to the noise of marches, 0 to 1: another for each frame.
        noise_shift: f32,
        /// Seconds since time zero.
        time_secs: f32,
        /// Factor on radiance, set by hand.
        exposure: f32,
        /// VIEW_SHADED, ...
        debug_view: u32,
        /// TONE_AGX, ...
        tone: u32,
        /// White balance: gains on radiance.
        white: Vec3,
        /// How much darker the corners are, 0 to 1.
        vignette: f32,
        /// Half extent of the picture by the half diagonal of the whole.
        vignette_extent: Vec2,
        /// From a place in this picture, -1 to 1 along each axis, to that in the whole picture that it is a tile of.
        whole_scale: Vec2,
        whole_offset: Vec2,
        /// Share of the light that the lens scatters.
        bloom: f32,
        /// Steps of a march through the air.
        air_steps: f32,
        /// Quality of the ground's patterns: 0 (one tap of one pattern) to 2.
        pattern_quality: f32,
        /// Biomes in a mixture: MIXTURE_ENTRIES. Loops count to a uniform: software drivers compile an unrolled one for
        /// minutes.
        mixture_entries: u32,
    }
}

uniform_struct! {
    /// A light at infinity.
    Sun {
        /// Unit vector towards it.
        dir: Vec3,
        /// Angular radius of its disc.
        radius_rad: f32,
        /// Irradiance outside the air on a surface that faces it.
        irradiance: Vec3,
        /// Radiance of its disc over its irradiance; 0 for light without a disc.
        disc_gain: f32,
        /// Unit vector from the eye to it.
        seen_dir: Vec3,
        /// Angular radius of its disc, seen from the eye.
        seen_radius_rad: f32,
        /// 1 over its distance from the centre of the body in km; 0 at infinity.
        per_km: f32,
    }
}

uniform_struct! {
    /// A round body that may cover a sun.
    Occluder {
        /// Its centre from the centre of the body that it may shade.
        center_km: Vec3,
        radius_km: f32,
        /// Share of a sun's light that its air bends into its shadow.
        glow: Vec3,
    }
}

uniform_struct! {
    /// A storm of a gas giant.
    Storm {
        /// Unit vector from the centre of the planet to its middle.
        center: Vec3,
        /// Half of its width along the latitude, in radii.
        size: f32,
        color: Vec3,
        /// Turn of its middle, radians.
        spin: f32,
    }
}

uniform_struct! {
    /// Pieces of rings of about one size, in a grid with at most one in each cell (src/rings/pieces.rs).
    RingClass {
        /// The eye in the grid: cells from a whole cell along both sides, and layers above the lower side of the rings.
        eye: Vec3,
        /// Width of a cell.
        cell_m: f32,
        /// Cosine and sine of the angle from the body's axes to those of the grid.
        turn: Vec2,
        /// That whole cell, modulo 2^32.
        first: UVec2,
        /// Height and number of the layers of cells.
        layer_m: f32,
        layers: u32,
        /// Radius of the ball around the largest piece.
        radius_m: f32,
        /// Share of cells with a piece for each unit of optical depth; how it grows with its square.
        chance: f32,
        crowding: f32,
        /// Distance from the eye at which the class has faded; way through the rings that is searched for it.
        reach_m: f32,
        search_m: f32,
        /// Seed of the class.
        seed: u32,
    }
}

uniform_struct! {
    /// A body too small for a surface.
    Point {
        /// Unit vector from the eye to it.
        dir: Vec3,
        /// Brightness in the unit of stars.
        light: Vec3,
    }
}

uniform_struct! {
    /// An octave of a noise that repeats.
    Octave {
        /// The eye in the octave's own frame, in periods, 0 to 1.
        offset: Vec3,
        /// Length after which it repeats, in the unit of the noise's positions.
        period: f32,
    }
}

uniform_struct! {
    /// A plane wave of the sea.
    Wave {
        /// Wave vector, radians per metre.
        vector_per_m: Vec3,
        /// Phase at the eye.
        phase: f32,
        amplitude_m: f32,
    }
}

uniform_struct! {
    /// Uniforms of a body in a view, in the body's frame.
    Body {
        /// Metres from the eye, in the body's axes, to clip space.
        clip_from_rel_m: Mat4,
        /// The eye from the body's centre: greater part and rest.
        eye_high_m: Vec3,
        /// 1 for the body farthest away: behind it are stars.
        is_backmost: u32,
        /// Of the frame before: metres from its eye to its clip space, and its eye seen from this one.
        before_clip_from_rel_m: Mat4,
        eye_before_rel_m: Vec3,
        /// Angle about the pole by which the wind has carried the clouds since.
        cloud_turn_rad: f32,
        /// Clouds are marched for one pixel of each block: side of the block, and the place of that pixel.
        march_block: u32,
        march_place: UVec2,
        eye_low_m: Vec3,
        /// The eye from the body's centre.
        eye_km: Vec3,
        /// Radius of the reference sphere.
        radius_km: f32,
        /// Unit vector from the centre to the eye.
        eye_up: Vec3,
        /// Height of the eye above the reference sphere.
        eye_altitude_km: f32,
        /// Ray of a pixel = ray_center + x ray_right + y ray_up with x, y from -1 to 1: one unit of it is one unit of
        /// depth.
        ray_right: Vec3,
        ray_up: Vec3,
        ray_center: Vec3,
        /// Unit vector along the view axis.
        view_axis: Vec3,
        /// Change of the ray from a pixel to the next on the right.
        pixel_right: Vec3,
        /// Change of the ray from a pixel to the next above.
        pixel_up: Vec3,
        /// Suns that shine.
        sun_count: u32,
        suns: [Sun; MAX_SUNS],
        /// Bodies that may cover a sun somewhere on this one.
        occluder_count: u32,
        occluders: [Occluder; MAX_OCCLUDERS],
        /// Points of light behind everything: of the farthest body.
        point_count: u32,
        points: [Point; MAX_POINTS],
        /// 1 for a gas giant.
        is_giant: u32,
        /// How far eddies fold the bands; their size in radii of the planet; contrast of the filaments.
        giant_turbulence: f32,
        giant_eddy_radii: f32,
        giant_filaments: f32,
        /// Colour of high white clouds.
        giant_bright: Vec3,
        giant_storm_count: u32,
        giant_storms: [Storm; MAX_STORMS],
        /// For each of two tracings: seconds since its middle, weight, seed of its eddies.
        giant_tracings: [Vec4; 2],
        /// The same for the detail of the tops; its octaves that show, and its longest wave in radii.
        giant_detail: [Vec4; 2],
        giant_octaves: u32,
        giant_detail_radii: f32,
        /// 1 where the eye is in the clouds or just above; their colour there.
        is_in_giant: u32,
        giant_fog: Vec3,
        /// Colour, and angular speed of the jets in radians per second, from the south pole to the north pole.
        giant_bands: [Vec4; BAND_ENTRIES],
        /// 1 with rings.
        ring_count: u32,
        ring_inner_km: f32,
        ring_outer_km: f32,
        /// Contrast of the ringlets, how many of the widest there are, octaves, and seed of their noise.
        ringlets: f32,
        ringlet_count: f32,
        ringlet_octaves: u32,
        ring_seed: u32,
        /// Share of fine dust.
        ring_dust: f32,
        /// Colour and optical depth along the width of the rings.
        ring_profile: [Vec4; RING_ENTRIES],
        /// Classes of pieces that show; 0 where the eye is far.
        ring_class_count: u32,
        ring_classes: [RingClass; RING_CLASSES],
        /// Most cells that a ray crosses in a class; most pieces in its way that it tries; pairs of facets of a piece.
        ring_steps: u32,
        ring_tries: u32,
        ring_facets: u32,
        ring_thickness_m: f32,
        /// Height of the eye over the middle of the rings.
        ring_eye_m: f32,
        /// Optical depth at the eye's distance from the axis, and its change with each metre outwards.
        ring_depth: Vec2,
        /// From the eye's distance from the axis to the inner and the outer edge.
        ring_edges_m: Vec2,
        /// Angular radius that the LUTs of the air were made with.
        lut_sun_radius_rad: f32,
        /// Rayleigh scattering at the reference sphere.
        rayleigh_per_km: Vec3,
        rayleigh_scale_km: f32,
        /// Mie scattering and extinction at the reference sphere.
        mie_scattering_per_km: Vec3,
        mie_scale_km: f32,
        mie_extinction_per_km: Vec3,
        /// Parameter g of the phase function of Cornette and Shanks.
        mie_anisotropy: f32,
        /// Absorption in the middle of the absorber, whose density is a triangle over height.
        absorber_per_km: Vec3,
        absorber_height_km: f32,
        /// Half width of the absorber.
        absorber_width_km: f32,
        /// Thickness of the air; 0 without air.
        air_height_km: f32,
        /// Brightness of the aurora, and its magnetic latitude.
        aurora: f32,
        aurora_lat_rad: f32,
        /// Brightness of the lights of settlements.
        settlements: f32,
        /// Mean albedo of the ground, for multiple scattering.
        ground_albedo: Vec3,
        /// 1 where there is a sea.
        has_sea: u32,
        water_absorption_per_m: Vec3,
        /// Height of the sea above the reference sphere.
        sea_level_km: f32,
        water_color: Vec3,
        /// Height of the eye above the sea.
        eye_over_sea_km: f32,
        ice_color: Vec3,
        freezing_c: f32,
        /// Variance of the slope of all waves (Cox and Munk).
        wave_slope_variance: f32,
        /// Temperature at the level of the sea.
        equator_c: f32,
        pole_c: f32,
        /// Waves that are not 0, longest first.
        wave_count: u32,
        waves: [Wave; WAVES],
        /// Steps of the march to the displaced surface of the sea; 0 where it is not displaced.
        wave_steps: u32,
        /// Standard deviation of the height of all waves.
        wave_deviation_m: f32,
        /// Direction to which the wind at the eye blows over the sea, a unit tangent; 0 without a sea.
        sea_wind: Vec3,
        /// 1 where the eye is under the waves.
        eye_is_under: u32,
        /// Depth of the sea under the eye, its gradient and the share of ice there.
        eye_depth_m: f32,
        eye_deepening: Vec3,
        eye_ice: f32,
        /// Radiance that the sea gives off.
        water_glow: Vec3,
        /// The eye in the grid of the greatest floes, modulo FLOE_GRID cells; 1 over the width of a cell.
        floe_eye: Vec3,
        floes_per_m: f32,
        cloud_color: Vec3,
        /// Layers through which rays march: FOG_LAYER, ...
        cloud_layers: [CloudLayer; CLOUD_LAYERS],
        /// Bands of the noise that shapes clouds, by layer; periods in km.
        cloud_bands: [Octave; CLOUD_BANDS],
        /// Shares of the sky that low clouds, middle clouds, veil and fog cover; 0 without clouds.
        cloud_coverages: Vec4,
        /// Offsets of the log-odds with which the mean covers are those.
        cloud_offsets: Vec4,
        /// Cosine and sine of the drift about the pole.
        cloud_drift: Vec2,
        /// Height of the veil, a thin sheet of ice clouds, and its optical depth.
        veil_km: f32,
        veil_depth: f32,
        /// Height above which there are no low and middle clouds.
        cloud_top_km: f32,
        /// Type of low clouds: -1 heaps, 1 decks.
        cloud_layering: f32,
        /// How far thunderclouds tower over the others, 0 to 1.
        cloud_towers: f32,
        /// 1 where the low clouds are thinner than a pixel.
        cloud_is_far: u32,
        /// Share of the odd keyframe in the cloud maps.
        cloud_odd_share: f32,
        /// The finest mip level of the cloud maps that is there.
        cloud_least_level: f32,
        /// 1 where a solved wind blows over the sea.
        has_wind: u32,
        /// Octaves of the macro variation; periods in metres.
        variation: [Octave; VARIATION_OCTAVES],
        /// The eye's position modulo 1024 m, for patterns that repeat.
        eye_wrap_m: Vec3,
        /// How much colder it gets with each metre of height.
        lapse_c_per_m: f32,
        /// The eye's position modulo 2^20 m.
        eye_wrap_far_m: Vec3,
        /// Of the eye that the tiles were chosen for.
        chosen_pixel_rad: f32,
        /// The eye that the tiles were chosen for: greater part and rest.
        chosen_eye_high_m: Vec3,
        /// How far noise moves the borders between biomes, in cells of the biome table.
        border_jitter_cells: f32,
        chosen_eye_low_m: Vec3,
        /// 1 for crisp borders between biomes.
        crisp_borders: u32,
        /// Octaves of the border jitter at the point of the reference sphere under the eye; periods in metres.
        border: [Octave; BORDER_OCTAVES],
        /// Lowest and highest height of the tiles.
        height_range_m: Vec2,
        /// Row of the biome table, 0 to 1: row_offset + row_per_c temperature in °C + row_per_m height over the sea.
        row_offset: f32,
        row_per_c: f32,
        row_per_m: f32,
        /// Change of moisture with height.
        moisture_per_m: f32,
        /// 1 while cells of the biome table are highlighted.
        marked: u32,
        /// 1 where there are rivers and lakes.
        has_rivers: u32,
        /// Metres from the eye to clip space of each map of shadows.
        shadow_from_rel_m: [Mat4; SHADOW_MAPS],
        /// Light that crowns let through to objects below, as shares of the sun's.
        through_leaves: Vec3,
        /// 1 where objects cast shadows.
        has_shadows: u32,
        /// Width of a texel of each map of shadows.
        shadow_texel_m: Vec3,
        /// 1 where things of a game cast shadows.
        has_casters: u32,
        /// Squares of the planting map; 0 without one.
        planting_levels: u32,
        /// Tangents along the sides of its squares, and the eye's place along them.
        planting_east: Vec3,
        planting_north: Vec3,
        planting_eye_m: Vec2,
        /// Width of a texel of its finest square.
        planting_texel_m: f32,
    }
}

uniform_struct! {
    /// Uniforms of the morph: the eye, and the distances at which vertices morph.
    MorphEye {
        /// Position in the planet frame, metres: high part and low part.
        high_m: Vec3,
        /// Distance within which a level always shows, in vertex spacings.
        least_spacings: f32,
        low_m: Vec3,
        /// Distance beyond which a level never shows, in vertex spacings.
        most_spacings: f32,
        /// Metres of distance for each metre of expected geometric error.
        reach: f32,
        /// Share of that distance over which a vertex morphs.
        width_share: f32,
    }
}

uniform_struct! {
    /// A layer of clouds.
    CloudLayer {
        bottom_km: f32,
        top_km: f32,
        /// From top to bottom.
        optical_depth: f32,
        /// Steps of a march through it; 0 where there is none.
        steps: f32,
        /// x: first step of a march that begins in the layer, km; y: ratio of each step to the one before; z: parts of
        /// a step within a cloud (1: such steps are neither searched nor parted); w: 1 if steps are even.
        stride: Vec4,
        /// Bands of its noise: the first, the one that makes puffs, and the one after the last.
        first_band: u32,
        puff_band: u32,
        end_band: u32,
    }
}

uniform_struct! {
    /// Uniforms of one metering.
    MeterStep {
        /// Upper left corner of the picture in the texture, pixels.
        origin_px: UVec2,
        /// Width and height of the picture, pixels.
        size_px: UVec2,
        /// Share of the difference to the metered exposure that is closed now.
        share: f32,
        /// Most stops by which the exposure changes now.
        most_ev: f32,
    }
}
