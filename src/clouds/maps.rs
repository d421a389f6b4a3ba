//! Cube maps for the renderer, as WebGPU orders and turns their faces.

use super::field::{CloudField, Ranked};
use crate::planet::Planet;
use crate::sea::relative_wind;
use crate::sphere::cube::texture_direction;
use crate::terrain::edits::Near;
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;
use half::f16;
use rayon::prelude::*;

/// Cells of the grid on which climate and wind of the ground map are evaluated; between them they are linear. The
/// weather is no finer.
const GROUND_CELLS: usize = 128;

/// The texels of six faces, rows from the top.
pub(crate) type Texels = Vec<[f16; 4]>;

/// Ranks at a time, in the frame that drifts with the wind: red low clouds, green the share of layered cloud, blue
/// middle clouds, alpha veil.
pub(crate) struct Keyframe {
    pub(crate) number: i64,
    pub(crate) texels: Texels,
}

/// A keyframe with `side` texels along a face.
pub(crate) fn keyframe(field: &CloudField, number: i64, side: usize) -> Keyframe {
    profiling::scope!("cloud keyframe");
    let systems = field.systems(number);
    let mut texels = vec![[f16::ZERO; 4]; 6 * side * side];
    // Square blocks: few systems reach each.
    let block = side.min(16);
    let rows = texels.par_chunks_mut(block * side).enumerate();
    rows.for_each_init(Box::<Noise>::default, |noise, (band, texels)| {
        let (face, top) = (band * block / side, band * block % side);
        for left in (0..side).step_by(block) {
            let at = |i: usize| (left + i % block, i / block);
            let wide = block.min(side - left);
            let dirs: Vec<_> = (0..block * block)
                .map(|i| {
                    let (x, y) = at(i);
                    texture_direction(face, side, (x.min(left + wide - 1)) as f64 + 0.5, (top + y) as f64 + 0.5)
                })
                .collect();
            let (middle, corner) = (dirs[block * block / 2 + block / 2], dirs[0]);
            let angle_rad = 1.3 * libm::acos(middle.dot(corner).min(1.0)) + 1e-3;
            let near: Vec<_> = systems.iter().filter(|system| system.reaches(middle, angle_rad)).cloned().collect();
            for (start, dirs) in dirs.chunks(CHUNK).enumerate() {
                field.ranked(dirs, number, &near, noise, |i, Ranked { low, middle, veil, layered }| {
                    let (x, y) = at(start * CHUNK + i);
                    if x < side {
                        texels[y * side + x] = [low, layered, middle, veil].map(f16::from_f32);
                    }
                });
            }
        }
    });
    Keyframe { number, texels }
}

/// Values that stay over the ground: red log-odds of the target cover without the offset, green the wind by its mean,
/// blue log-odds of fog without the offset, alpha its rank.
pub(crate) fn ground_map(planet: &Planet, field: &CloudField, side: usize) -> Texels {
    let cells = GROUND_CELLS.min(side);
    let along = cells + 1;
    let values: Vec<[f64; 3]> = (0..6 * along * along)
        .into_par_iter()
        .with_min_len(along)
        .map(|i| {
            let (x, y) = ((i % along) as f64, (i / along % along) as f64);
            let dir = texture_direction(i / (along * along), cells, x, y);
            let wind = relative_wind(planet, field.weather(), dir).length();
            [field.odds(dir), wind, field.fog_odds(dir)]
        })
        .collect();
    let step = cells as f64 / side as f64;
    let smooth = |face: usize, x: usize, y: usize| -> [f64; 3] {
        let [x, y] = [x, y].map(|at| (at as f64 + 0.5) * step);
        let (column, row) = ((x as usize).min(cells - 1), (y as usize).min(cells - 1));
        let at = |dx: usize, dy: usize| values[(face * along + row + dy) * along + column + dx];
        let (u, v) = (x - column as f64, y - row as f64);
        std::array::from_fn(|k| {
            let (top, bottom) = (at(0, 0)[k] * (1.0 - u) + at(1, 0)[k] * u, at(0, 1)[k] * (1.0 - u) + at(1, 1)[k] * u);
            top * (1.0 - v) + bottom * v
        })
    };
    let mut texels = vec![[f16::ZERO; 4]; 6 * side * side];
    texels.par_chunks_mut(side).enumerate().for_each_init(Default::default, |scratch, (row, texels)| {
        let (noise, near): &mut (Box<Noise>, Near) = scratch;
        let (face, y) = (row / side, row % side);
        for (start, texels) in texels.chunks_mut(CHUNK).enumerate() {
            let columns = start * CHUNK..start * CHUNK + texels.len();
            let dirs: Vec<_> =
                columns.clone().map(|x| texture_direction(face, side, x as f64 + 0.5, y as f64 + 0.5)).collect();
            field.fog_ranks(&dirs, noise, |i, rank| texels[i][3] = f16::from_f32(rank));
            for (texel, x) in texels.iter_mut().zip(columns) {
                let [odds, wind, fog_odds] = smooth(face, x, y).map(f16::from_f64);
                texel[..3].copy_from_slice(&[odds, wind, fog_odds]);
            }
            field.painted(&dirs, near, |i, odds| texels[i][0] = f16::from_f64(texels[i][0].to_f64() + odds));
        }
    });
    texels
}
