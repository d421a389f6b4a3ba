//! The surface that a mesh shows, at points: the evaluator's ground, or the water over it.

use super::MeshWater;
use crate::bake::Detail;
use crate::bake::maps::{depth_m, mean_color, through_water};
use crate::bake::progress::Progress;
use crate::life::Canopies;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// Rows of a band, and columns of its blocks. A thread builds the river blocks around the points of one query once:
/// they form a square rather than a row.
pub(super) const BAND: usize = 32;

/// Roughness of still water.
pub(super) const WATER_ROUGHNESS: f64 = 0.1;
/// Opacity of water in a mesh of its own.
pub(super) const WATER_OPACITY: f64 = 0.75;

/// What points of a mesh are computed from.
pub(super) struct Surface<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) water: MeshWater,
    pub(super) detail: Detail,
    pub(super) canopies: &'a Canopies,
}

/// A point of the surface.
#[derive(Clone, Copy)]
pub(super) struct Point {
    pub(super) dir_planet: DVec3,
    /// Height over the reference sphere: of the ground, or of the water where the mesh runs on it.
    pub(super) height_m: f64,
    /// Unit normal with as much detail as points so far apart can show.
    pub(super) normal_planet: DVec3,
    /// Linear sRGB.
    pub(super) color: [f64; 3],
    pub(super) roughness: f64,
    /// Level of the water over the ground, where that is a mesh of its own.
    pub(super) water_level_m: Option<f64>,
}

impl Surface<'_> {
    /// The points of some rows of a grid, row by row, on all cores; at most [`BAND`] rows. Empty if the bake has
    /// stopped.
    pub(super) fn band(
        &self,
        rows: Range<usize>,
        columns: usize,
        direction: &(dyn Fn(usize, usize) -> DVec3 + Sync),
        spacing_rad: f64,
        progress: &Progress<'_>,
    ) -> Vec<Point> {
        let blocks: Vec<_> = (0..columns).step_by(BAND).map(|first| first..(first + BAND).min(columns)).collect();
        let block = |scratch: &mut Scratch, columns: &Range<usize>| {
            if progress.is_stopped() {
                return Vec::new();
            }
            let row = |row: usize| columns.clone().map(move |column| direction(row, column));
            let dirs: Vec<_> = rows.clone().flat_map(row).collect();
            let points = self.points(&dirs, spacing_rad, scratch);
            progress.add(points.len() as u64);
            points
        };
        let blocks: Vec<_> = blocks.par_iter().map_init(Scratch::default, block).collect();
        if progress.is_stopped() {
            return Vec::new();
        }
        let height = rows.len();
        let row = |row: usize| {
            blocks.iter().flat_map(move |block| {
                let width = block.len() / height;
                &block[row * width..][..width]
            })
        };
        (0..height).flat_map(row).copied().collect()
    }

    /// The points at unit directions about `spacing_rad` apart.
    fn points(&self, dirs_planet: &[DVec3], spacing_rad: f64, scratch: &mut Scratch) -> Vec<Point> {
        let detail_rad = match (self.detail, self.terrain.river_spacing_rad()) {
            (Detail::Pixel, Some(coarsest_rad)) => spacing_rad.min(coarsest_rad),
            _ => 0.0,
        };
        let mut samples = vec![Sample::default(); dirs_planet.len()];
        let wanted = Wanted::HEIGHT.and_biome().and_for_life(self.terrain.planet());
        self.terrain.samples_spaced_into(dirs_planet, detail_rad, wanted, &mut samples, scratch);
        // The samples' own normals have all octaves, which points so far apart would show as noise.
        let ground = self.terrain.slopes_at(dirs_planet, &[detail_rad, spacing_rad]);
        let slopes = ground.slopes.last().map_or(&[][..], Vec::as_slice);
        let points = dirs_planet.iter().zip(&samples).zip(slopes);
        points.map(|((&dir, sample), &slope)| self.point(dir, sample, slope)).collect()
    }

    fn point(&self, dir_planet: DVec3, sample: &Sample, slope: DVec3) -> Point {
        let planet = self.terrain.planet();
        let biome = planet.biomes.palette.get(sample.biome);
        let ground = self.canopies.albedo(dir_planet, sample, biome.map_or([0.5; 3], mean_color));
        let mut point = Point {
            dir_planet,
            height_m: sample.height_m,
            normal_planet: (dir_planet - slope).normalize(),
            color: ground,
            roughness: biome.map_or(1.0, |biome| biome.roughness),
            water_level_m: None,
        };
        let level_m = sample.water_level_m.filter(|_| depth_m(sample) > 0.0);
        match (self.water, level_m) {
            (MeshWater::Surface, Some(level_m)) => {
                point.height_m = level_m;
                point.normal_planet = dir_planet;
                point.color = through_water(planet, sample, ground);
                point.roughness = WATER_ROUGHNESS;
            }
            (MeshWater::Apart, level_m) => point.water_level_m = level_m,
            _ => {}
        }
        point
    }
}
