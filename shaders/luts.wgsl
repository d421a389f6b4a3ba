// LUTs and maps that are reused from frame to frame.

@group(1) @binding(0) var optical_depth_lut: texture_2d<f32>;
// Light that air and ground have scattered, in four layers. 0: rgb square root of the mean over all directions, a mean
// cosine to the sun of the light around the sun. 1: without that light, rgb mean squared cosine to the zenith, a mean
// cosine to the zenith. 2 and 3: the same for light scattered once
@group(1) @binding(1) var multiscatter_lut: texture_2d_array<f32>;
// In the same place, for drawing: light that air scatters for a second time or more, by direction: glow.wgsl
@group(1) @binding(1) var glow_lut: texture_2d_array<f32>;
// Light of the sky, in one layer: sky.wgsl
@group(1) @binding(2) var sky_lut: texture_2d_array<f32>;
// Cube 0: r log-odds of the target cover without the offset, g wind by its mean, b log-odds of fog, a its rank. Cubes 1
// and 2, the even and the odd keyframe: r rank of low clouds, g share of layered cloud, b rank of middle clouds, a rank
// of the veil
@group(1) @binding(3) var cloud_maps: texture_cube_array<f32>;
@group(1) @binding(4) var noise_tile: texture_3d<f32>;
// r: index into the palette; g: 1 if the cell is marked in the editor
@group(1) @binding(5) var biome_ids: texture_2d<f32>;
@group(1) @binding(6) var biome_params: texture_2d<f32>;
@group(1) @binding(7) var material_tint: texture_2d_array<f32>;
@group(1) @binding(8) var material_surface: texture_2d_array<f32>;
@group(1) @binding(9) var border_tile: texture_3d<f32>;
// The world map that a debug view shows
@group(1) @binding(10) var map_picture: texture_cube<f32>;
