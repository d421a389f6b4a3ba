//! Biomes as two small textures for `material.wgsl`: the biome of each cell of the biome table (row 0 is the hottest or
//! highest), and a column of parameters for each biome.

use super::gpu;
use super::life::{CANOPY_ROWS, CanopyRows};
use super::patterns::{self, Pattern};
use crate::planet::{Biome, Biomes, Detail, MAX_BIOMES, Steep};
use crate::terrain::biome::{BEACH_SOFT_DEG, SNOW_SOFT_DEG};
use crate::terrain::material;

/// Columns of the parameters: the palette, then the rock that biomes share, the surface rules, and the population whose
/// density is shown.
pub(crate) const ROCK: usize = MAX_BIOMES;
pub(crate) const RULES: usize = MAX_BIOMES + 1;
pub(crate) const SHOWN: usize = MAX_BIOMES + 2;
const COLUMNS: usize = MAX_BIOMES + 3;
/// Rows of a column without its canopy, four numbers each.
const ROWS: usize = 8;
/// Row of the texture layers, and of the number of populations in the canopy.
const LAYERS_ROW: usize = 6;
/// First row of the canopy.
pub(crate) const CANOPY: usize = ROWS;
/// Row that says of a biome whether the shown population stands there, and in its own column whether it is known.
pub(crate) const SHOWN_ROW: usize = ROWS + CANOPY_ROWS;
const ALL_ROWS: usize = SHOWN_ROW + 1;

/// Length in metres by which positions are wrapped before they reach the shaders. Periods of patterns divide it.
pub(crate) const WRAP_M: f64 = 1024.0;
/// Period of a pattern's finer scale as a share of the coarser one. The finer scale is rotated by the angle of a 3-4-5
/// triangle. Its period divides [`WRAP_M`] / [`TURN`], so that the rotated pattern repeats after [`WRAP_M`], too.
const FINE: f64 = 0.31;
const TURN: f64 = 5.0;

/// Cells of the biome table whose ground is highlighted.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MarkedCells {
    columns: usize,
    cells: Vec<bool>,
}

impl MarkedCells {
    /// The cells of a biome table of this size for which `is_marked` (column, row) holds.
    pub fn new(columns: usize, rows: usize, is_marked: impl Fn(usize, usize) -> bool) -> Self {
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        Self { columns, cells: cells.map(|(column, row)| is_marked(column, row)).collect() }
    }

    /// Whether a cell is marked; false outside the biome table.
    pub fn contains(&self, column: usize, row: usize) -> bool {
        column < self.columns && self.cells.get(row * self.columns + column).copied().unwrap_or(false)
    }

    /// Number of marked cells.
    pub fn count(&self) -> usize {
        self.cells.iter().filter(|marked| **marked).count()
    }
}

/// The texels of both textures.
#[derive(PartialEq)]
pub(crate) struct BiomeTexels {
    size_px: [u32; 2],
    /// Index into the palette, then 255 if the cell is marked, else 0. Row by row.
    ids: Vec<[u8; 2]>,
    /// Parameters in the order of [`numbers`] and [`rules`]; then the canopies.
    params: Vec<[f32; 4]>,
}

impl BiomeTexels {
    /// `patterns`: in the order of their texture layers.
    pub(crate) fn new(
        biomes: &Biomes,
        patterns: &[Pattern],
        marked: Option<&MarkedCells>,
        canopies: &CanopyRows,
    ) -> Self {
        let (columns, rows) = (biomes.table.columns().max(1), biomes.table.rows().len().max(1));
        let cells = (0..rows).flat_map(|row| (0..columns).map(move |column| (column, row)));
        let id = |(column, row)| {
            let index = biomes.table.key(column, row).and_then(|key| biomes.index_of(key)).unwrap_or(0);
            [index as u8, if marked.is_some_and(|marked| marked.contains(column, row)) { 255 } else { 0 }]
        };
        let mut params = vec![[0.0; 4]; COLUMNS * ALL_ROWS];
        let mut put = |column: usize, numbers: [[f64; 4]; ROWS]| {
            for (row, numbers) in numbers.into_iter().enumerate() {
                params[row * COLUMNS + column] = numbers.map(|number| number as f32);
            }
        };
        for (column, biome) in biomes.palette.iter().take(MAX_BIOMES).enumerate() {
            put(column, numbers(biome, biomes, patterns));
        }
        put(ROCK, numbers(&shared_rock(biomes), biomes, patterns));
        put(RULES, rules(biomes));
        for (column, biome) in biomes.palette.iter().take(MAX_BIOMES).enumerate() {
            let (count, rows) = canopies.of_biome(biome.key);
            params[LAYERS_ROW * COLUMNS + column][3] = count as f32;
            for (row, numbers) in rows.into_iter().enumerate() {
                params[(CANOPY + row) * COLUMNS + column] = numbers;
            }
            params[SHOWN_ROW * COLUMNS + column][0] = f32::from(canopies.shows_in(biome.key));
        }
        if let Some(rows) = canopies.shown() {
            for (row, numbers) in rows.iter().enumerate() {
                params[(CANOPY + row) * COLUMNS + SHOWN] = *numbers;
            }
            params[SHOWN_ROW * COLUMNS + SHOWN][0] = 1.0;
        }
        Self { size_px: [columns as u32, rows as u32], ids: cells.map(id).collect(), params }
    }
}

/// The rock that biomes share, as a biome.
fn shared_rock(biomes: &Biomes) -> Biome {
    Biome {
        color: biomes.cliff_color,
        variation: 0.35,
        roughness: 0.9,
        detail: biomes.cliff_detail,
        detail_m: biomes.cliff_detail_m,
        steep: Steep::Stays,
        ..Biome::default()
    }
}

fn numbers(biome: &Biome, biomes: &Biomes, patterns: &[Pattern]) -> [[f64; 4]; ROWS] {
    let whole = |length: f64, parts: f64, size: f64| length / parts / (length / parts / size).round().max(1.0);
    let size_m = whole(WRAP_M, 1.0, biome.detail_m);
    let patch_m = material::patch_tile_m(biome);
    let layer_of = |wanted: &Pattern| patterns.iter().position(|known| known == wanted);
    // Texture layer, relief and period of the finer scale in metres. Stones of an artist have a size: no finer ones
    // lie within them.
    let shown = |wanted: &Pattern| match layer_of(wanted) {
        Some(layer) => {
            let fine_m = if matches!(wanted, Pattern::Set(_)) { 0.0 } else { whole(WRAP_M, TURN, FINE * size_m) };
            [layer as f64, wanted.relief(), fine_m]
        }
        None => [-1.0, 0.0, 0.0],
    };
    let set = biome.textures.set().map(|set| Pattern::Set(set.clone())).filter(|set| layer_of(set).is_some());
    let own = shown(&set.unwrap_or(Pattern::Kind(biome.detail)));
    let patch = if biome.patch_detail == Detail::None { own } else { shown(&Pattern::Kind(biome.patch_detail)) };
    let cosine = |degrees: f64| degrees.to_radians().cos();
    let [into, from, to] = biomes.steep_rule(biome).map_or([-1.0, 0.0, 0.0], |rule| {
        [rule.into.map_or(ROCK, |index| index) as f64, cosine(rule.from_deg), cosine(rule.to_deg)]
    });
    let four = |[r, g, b]: [f64; 3], w: f64| [r, g, b, w];
    [
        four(biome.color, biome.variation),
        four(biome.patch_color, biome.patches),
        [biome.roughness, biome.specular, patch_m, patterns::bumps(biome.detail)],
        [size_m, biome.detail_strength, biome.flow_m_s, biome.glow],
        four(biome.glow_color, 0.0),
        [into, from, to, 0.0],
        [own[0], patch[0], 0.0, 0.0],
        [own[1], patch[1], own[2], patch[2]],
    ]
}

fn rules(biomes: &Biomes) -> [[f64; 4]; ROWS] {
    let index = |key: Option<char>| key.and_then(|key| biomes.index_of(key)).map_or(-1.0, |index| index as f64);
    let cosine = |degrees: f64| degrees.clamp(0.0, 180.0).to_radians().cos();
    let (beach, snow) = (biomes.beach_steepest_deg, biomes.snow_steepest_deg);
    let mut rules = [[0.0; 4]; ROWS];
    rules[0] = [index((biomes.beach_m > 0.0).then_some(biomes.beach_key)), biomes.beach_m, 0.0, 0.0];
    rules[1] = [index(biomes.snow.then_some(biomes.snow_key)), biomes.snow_below_c, biomes.snow_range_c, 0.0];
    rules[2] = [
        cosine(beach - BEACH_SOFT_DEG),
        cosine(beach + BEACH_SOFT_DEG),
        cosine(snow - SNOW_SOFT_DEG),
        cosine(snow + SNOW_SOFT_DEG),
    ];
    rules
}

/// The textures. They are rewritten in place as long as the biome table keeps its size.
pub(crate) struct BiomeTextures {
    pub(crate) ids: wgpu::TextureView,
    pub(crate) params: wgpu::TextureView,
}

impl BiomeTextures {
    /// Creates textures with these texels.
    pub(crate) fn with(device: &wgpu::Device, queue: &wgpu::Queue, texels: &BiomeTexels) -> Self {
        let make = |size_px, format| {
            let texture = gpu::written_texture(device, "biomes", extent(size_px), format);
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let textures = Self {
            ids: make(texels.size_px, wgpu::TextureFormat::Rg8Unorm),
            params: make([COLUMNS as u32, ALL_ROWS as u32], wgpu::TextureFormat::Rgba32Float),
        };
        textures.write(queue, texels);
        textures
    }

    /// Whether the textures have the size of the texels.
    pub(crate) fn fit(&self, texels: &BiomeTexels) -> bool {
        self.ids.texture().size() == extent(texels.size_px)
    }

    /// Replaces the content of the textures.
    pub(crate) fn write(&self, queue: &wgpu::Queue, texels: &BiomeTexels) {
        let params = (&self.params, [COLUMNS as u32, ALL_ROWS as u32], 16, bytemuck::cast_slice(&texels.params));
        let ids = (&self.ids, texels.size_px, 2, texels.ids.as_flattened());
        for (view, [width, height], texel_bytes, data) in [ids, params] {
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(width * texel_bytes),
                rows_per_image: Some(height),
            };
            queue.write_texture(view.texture().as_image_copy(), data, layout, extent([width, height]));
        }
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}
