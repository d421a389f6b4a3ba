//! Sizes and counts that belong to the CPU and the shaders alike.

use crate::giant;
use crate::noise_tile::VARIATION_PERIODS_M;
use crate::rings;
use crate::sea;
use crate::terrain::border;
use glam::{DMat3, DVec3};

/// The most suns of a scene.
pub const MAX_SUNS: usize = 4;
/// The most bodies that shade one body.
pub(crate) const MAX_OCCLUDERS: usize = 4;
/// The most bodies of a scene that are points.
pub const MAX_POINTS: usize = 16;
/// Latitudes at which the bands of a giant are known.
pub(crate) const BAND_ENTRIES: usize = giant::BAND_ENTRIES;
/// Height over the tops of a giant's clouds below which the eye is in their haze.
pub(crate) const FOG_TOP_KM: f64 = 4.0;
/// The most storms of a giant.
pub(crate) const MAX_STORMS: usize = giant::MAX_STORMS;
/// Entries of the profile of rings.
pub(crate) const RING_ENTRIES: usize = rings::PROFILE_ENTRIES;
/// Classes of sizes of the pieces of rings.
pub(crate) const RING_CLASSES: usize = rings::SIZE_CLASSES;
/// The most plane waves of the sea near the eye.
pub(crate) const WAVES: usize = sea::MOST_WAVES;
/// How much higher crests of the sea are than troughs are deep; the least factor on slopes that it leaves.
pub(crate) const WAVE_SKEW: f64 = sea::SKEW;
pub(crate) const LEAST_SKEWED: f64 = sea::LEAST_SKEWED;
/// What the bed and ice do to waves of the sea.
pub(crate) use sea::{BED_REACH_M, BREAKING, CROWDED, DEEP, ICE_COLDER_C, ICE_DAMPING_M, LEE, TURN, TURN_FALL};
/// Phase difference from one pixel to the next, radians, at which a wave has faded into roughness.
pub(crate) const WAVE_LOST: f64 = 1.9;
/// Least share of a wave's phase difference that one of the two pixel steps shows: a wave may run between them, at 45°.
pub(crate) const WAVE_ACROSS: f64 = 0.7;
/// Octaves of the macro variation.
pub(crate) const VARIATION_OCTAVES: usize = VARIATION_PERIODS_M.len();
/// Octaves of the border jitter.
pub(crate) const BORDER_OCTAVES: usize = border::OCTAVES;
/// Layers of clouds through which rays march, lowest first: fog, rain, low clouds, middle clouds.
pub(crate) const CLOUD_LAYERS: usize = 4;
pub(crate) const FOG_LAYER: u32 = 0;
pub(crate) const RAIN_LAYER: u32 = 1;
pub(crate) const LOW_LAYER: u32 = 2;
pub(crate) const MIDDLE_LAYER: u32 = 3;
/// Bands of the noise that shapes low clouds, widest first; each is turned against the one before, so that the repeats
/// of their tile never coincide.
pub(crate) const LOW_BANDS: usize = 6;
/// The band that makes puffs.
pub(crate) const LOW_PUFF_BAND: usize = 3;
/// Bands of middle clouds: groups, puffs and their edges.
pub(crate) const MIDDLE_BANDS: usize = 3;
/// What the lookup of the finest of them is stretched by: cells are narrower along one axis (0.6, -0.48, 0.64), by a
/// factor of 1.9, and so lie in rows across it.
pub(crate) const ROWS: DMat3 = DMat3::from_cols(
    DVec3::new(1.324, -0.2592, 0.3456),
    DVec3::new(-0.2592, 1.20736, -0.27648),
    DVec3::new(0.3456, -0.27648, 1.36864),
);
/// Bands of fog and of rain.
pub(crate) const FOG_BANDS: usize = 2;
pub(crate) const RAIN_BANDS: usize = 1;
/// Bands of all layers: low clouds, middle clouds, fog, rain.
pub(crate) const CLOUD_BANDS: usize = LOW_BANDS + MIDDLE_BANDS + FOG_BANDS + RAIN_BANDS;
/// Biomes in a mixture: four cells of the biome table, each with the biome of its steep ground, beach and snow.
pub(crate) const MIXTURE_ENTRIES: u32 = 10;
/// Bytes of the morphed values of a vertex: vertical shift, and three values.
pub(crate) const SHOWN_BYTES: u64 = 4 * 4;
/// Size of each LUT of the air, texels.
pub(crate) const OPTICAL_DEPTH_SIZE: [u32; 2] = [256, 64];
pub(crate) const MULTISCATTER_SIZE: [u32; 2] = [28, 10];
/// The LUTs by direction have tiles of the multiple-scattering LUT's size: across, one for each elevation; down, one
/// for each group of azimuths, which are the layers.
pub(crate) const TURNS_AT_ONCE: u32 = 3;
/// Elevations and azimuths of the light that a point sees, and of the light that air scatters again.
pub(crate) const SEEN_NODES: [u32; 2] = [9, 3 * TURNS_AT_ONCE];
pub(crate) const GLOW_NODES: [u32; 2] = [11, 2 * TURNS_AT_ONCE];
pub(crate) const IRRADIANCE_SIZE: [u32; 2] = [64, 16];
pub(crate) const SKY_SIZE: [u32; 2] = [64, 20];
/// First column of each of these two in the texture of both, and its size.
pub(crate) const IRRADIANCE_AT: u32 = 32;
pub(crate) const SKY_AT: u32 = IRRADIANCE_AT + IRRADIANCE_SIZE[0];
pub(crate) const SKY_LUT_SIZE: [u32; 2] = [SKY_AT + SKY_SIZE[0], SKY_SIZE[1]];
/// Texels along a face of a cloud map.
pub(crate) const CLOUD_MAP_SIDE: u32 = 512;
/// Mip levels of a cloud map. Coarser ones are not needed: a planet is hardly drawn smaller.
pub(crate) const CLOUD_MAP_LEVELS: u32 = 5;
/// Cells after which the pattern of the greatest floes repeats.
pub(crate) const FLOE_GRID: f64 = 256.0;
/// Variance of the slope of a sea without wind (Cox and Munk 1954).
pub(crate) const CALM_SLOPE_VARIANCE: f64 = 0.003;
/// Bins of the exposure's histogram.
pub(crate) const METER_BINS: u32 = 128;
/// Spacing of counted pixels in each direction, in pixels.
pub(crate) const METER_STRIDE: u32 = 4;
/// Invocations along a side of a workgroup of the histogram.
pub(crate) const METER_GROUP: u32 = 16;
