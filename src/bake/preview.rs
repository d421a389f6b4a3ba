//! A small picture of a map for a person, before it is baked.

use super::format::{Steps, srgb_byte};
use super::maps::{Range, mean_color};
use super::projection::Grid;
use super::strips::{Evaluator, STRIP_PIXELS, Strips};
use super::{Bake, Detail, Format, Map};
use crate::planet::Key;
use crate::terrain::Scratch;
use rayon::prelude::*;
use std::path::PathBuf;

/// A small picture of a map. The faces of a cube stand side by side.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Preview {
    /// The map.
    pub map: Map,
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// sRGB, row by row from the top. Single values are grey from the least (black) to the greatest (white).
    pub pixels: Vec<[u8; 3]>,
    /// The least and the greatest value, in the map's unit.
    pub range: [f64; 2],
}

impl Bake {
    /// The values of a small map, row by row, with its width and height: what [`Bake::preview`] shows.
    #[cfg(feature = "editor")]
    pub(crate) fn map_values(
        &self,
        map: Map,
        width: u32,
        go_on: &(dyn Fn() -> bool + Sync),
    ) -> Option<(Vec<f32>, [u32; 2])> {
        let (values, grid) = self.evaluated(map, width, go_on)?;
        Some((values, [grid.width, grid.height]))
    }

    /// The values of a small map, picture by picture.
    fn evaluated(&self, map: Map, width: u32, go_on: &(dyn Fn() -> bool + Sync)) -> Option<(Vec<f32>, Grid)> {
        let radius_km = self.terrain.planet().radius_km;
        let projection = self.projection.whole();
        let pictures = Grid::new(&projection, width, radius_km).pictures();
        let across = (width / pictures as u32).max(1);
        let small = Bake { maps: vec![map], projection, size: across, detail: Detail::Pixel, ..self.clone() };
        let grid = Grid::new(&small.projection, across, radius_km);
        let evaluator = Evaluator::new(&small);
        let strips = Strips::new(grid, vec![map], Key::of(&()), PathBuf::new(), STRIP_PIXELS);
        let parts: Option<Vec<Vec<f32>>> = (0..strips.count())
            .into_par_iter()
            .map(|number| {
                let values = || strips.values(&strips.strip(number), &evaluator, &mut Scratch::default());
                go_on().then(|| values().swap_remove(0))
            })
            .collect();
        Some((parts?.concat(), strips.grid))
    }

    /// A picture of `map` of about `width` pixels, as it would be baked with [`Detail::Pixel`]. Draft world maps serve.
    ///
    /// The answer is None if `go_on` says no.
    pub fn preview(&self, map: Map, width: u32, go_on: &(dyn Fn() -> bool + Sync)) -> Option<Preview> {
        let planet = self.terrain.planet();
        let (values, grid) = self.evaluated(map, width, go_on)?;
        let pictures = grid.pictures();
        let (width, height) = (grid.width as usize, grid.height as usize);
        let (least, most) = values.iter().fold((f32::MAX, f32::MIN), |(least, most), v| (least.min(*v), most.max(*v)));
        let steps = Steps::new(Format::Png8, map, (least.into(), most.into()), None);
        let color = |values: &[f32]| match (map, map.range(), values) {
            (_, Range::Numbers, [number]) => {
                let biome = planet.biomes.palette.get(*number as usize);
                biome.map_or([0; 3], |biome| mean_color(biome).map(srgb_byte))
            }
            (_, _, &[value]) => [steps.number(value) as u8; 3],
            (.., values) => std::array::from_fn(|k| steps.number(values.get(k).copied().unwrap_or_default()) as u8),
        };
        let mut pixels = Vec::with_capacity(width * height * pictures);
        for row in 0..height {
            for picture in 0..pictures {
                let first = (picture * height + row) * width;
                let of_row = &values[first * map.channels()..(first + width) * map.channels()];
                pixels.extend(of_row.chunks(map.channels()).map(color));
            }
        }
        let size_px = [(width * pictures) as u32, height as u32];
        Some(Preview { map, size_px, pixels, range: [least.into(), most.into()] })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bake::{Projection, Region};
    use crate::planet::shipped;
    use crate::terrain::Terrain;
    use std::sync::Arc;

    fn bake(projection: Projection) -> Bake {
        let terrain = Arc::new(Terrain::try_new(Arc::new(shipped::layered())).unwrap());
        Bake::new(terrain, vec![Map::Height], projection, 64, Format::Png16)
    }

    #[test]
    fn a_preview_has_land_and_sea_and_the_shape_of_its_projection() {
        let region = Projection::Region(Region { lat_deg: 10.0, lon_deg: 20.0, side_km: 500.0 });
        for (projection, size_px) in
            [(Projection::Equirect, [96, 48]), (Projection::Cube, [96, 16]), (region, [96, 96])]
        {
            let bake = bake(projection);
            for map in [Map::Height, Map::Normal, Map::Biome, Map::Albedo] {
                let preview = bake.preview(map, 96, &|| true).unwrap();
                assert_eq!(preview.size_px, size_px, "{projection:?}");
                assert_eq!(preview.pixels.len(), (size_px[0] * size_px[1]) as usize);
                let colors: std::collections::HashSet<_> = preview.pixels.iter().collect();
                assert!(colors.len() > 1, "{projection:?} {map:?}");
            }
            let [low, high] = bake.preview(Map::Height, 96, &|| true).unwrap().range;
            assert!(low < high);
        }
        assert_eq!(bake(Projection::Equirect).preview(Map::Height, 96, &|| false), None);
    }
}
