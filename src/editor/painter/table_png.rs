//! The biome table as a PNG: one pixel for each cell, in the colour of its biome. An import takes the nearest colour of
//! the palette.

use crate::planet::{Biomes, Table};
use crate::render::srgb_from_linear;
use image::{ImageFormat, ImageReader, Limits, Rgba, RgbaImage};
use std::io::Cursor;

/// Memory for reading a picture, bytes.
const MOST_BYTES: u64 = 16 << 20;

/// A table read from a picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Imported {
    /// The table. A transparent pixel keeps the biome that had its climate.
    pub table: Table,
    /// Number of pixels with a colour of no biome.
    pub inexact: usize,
}

/// The picture of a table.
///
/// # Errors
/// Why the picture could not be encoded.
pub fn encode(biomes: &Biomes) -> Result<Vec<u8>, String> {
    let (columns, rows) = (biomes.table.columns(), biomes.table.rows().len());
    let picture = RgbaImage::from_fn(columns as u32, rows as u32, |x, y| {
        let index = biomes.table.key(x as usize, y as usize).and_then(|key| biomes.index_of(key));
        let [r, g, b] = index.and_then(|index| biomes.palette.get(index)).map_or([0; 3], |biome| srgb(biome.color));
        Rgba([r, g, b, 255])
    });
    let mut bytes = Cursor::new(Vec::new());
    picture.write_to(&mut bytes, ImageFormat::Png).map_err(|error| error.to_string())?;
    Ok(bytes.into_inner())
}

/// Pairs of biomes that have the same colour, so that a picture cannot tell them apart: their names.
pub fn look_alikes(biomes: &Biomes) -> Vec<(String, String)> {
    let colors: Vec<[u8; 3]> = biomes.palette.iter().map(|biome| srgb(biome.color)).collect();
    let first = |index: usize| colors[..index].iter().position(|color| *color == colors[index]);
    let name = |index: usize| biomes.palette[index].name.clone();
    (0..colors.len()).filter_map(|index| first(index).map(|first| (name(first), name(index)))).collect()
}

/// The table of a picture: a cell for each pixel, over the palette of `biomes`.
///
/// # Errors
/// What is wrong with the picture, and what would be right.
pub fn decode(bytes: &[u8], biomes: &Biomes) -> Result<Imported, String> {
    let mut reader = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png);
    let sides = Table::MIN_SIDE as u32..=Table::MAX_SIDE as u32;
    // The size comes first, so that a huge picture is never decoded.
    let read_size = ImageReader::with_format(Cursor::new(bytes), ImageFormat::Png).into_dimensions();
    let (width, height) = read_size.map_err(|error| format!("this is no PNG that can be read: {error}"))?;
    if !sides.contains(&width) || !sides.contains(&height) {
        return Err(format!(
            "the picture has {width} x {height} pixels; use {} to {} on each side, one pixel for each cell",
            sides.start(),
            sides.end()
        ));
    }
    // Chunks besides the pixels can grow to any size as well.
    let mut limits = Limits::default();
    limits.max_alloc = Some(MOST_BYTES);
    reader.limits(limits);
    let picture = reader.decode().map_err(|error| format!("the picture cannot be read: {error}"))?.to_rgba8();
    let palette: Vec<(char, [u8; 3])> = biomes.palette.iter().map(|biome| (biome.key, srgb(biome.color))).collect();
    let Some(&(first, _)) = palette.first() else {
        return Err("the palette is empty; add a biome first".to_owned());
    };
    let (columns, rows) = (width as usize, height as usize);
    let mut table = Table::uniform(first, columns, rows);
    let mut inexact = 0;
    for (x, y, &Rgba([r, g, b, alpha])) in picture.enumerate_pixels() {
        let (column, row) = (x as usize, y as usize);
        let key = if alpha < 128 {
            let (old_columns, old_rows) = (biomes.table.columns(), biomes.table.rows().len());
            biomes.table.key((2 * column + 1) * old_columns / (2 * columns), (2 * row + 1) * old_rows / (2 * rows))
        } else {
            let nearest = palette
                .iter()
                .map(|&(key, color)| (difference([r, g, b], color), key))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            inexact += usize::from(nearest.is_some_and(|(away, _)| away > 0.0));
            nearest.map(|(_, key)| key)
        };
        table.set_key(column, row, key.unwrap_or(first));
    }
    Ok(Imported { table, inexact })
}

/// The square of the distance of two colours in Oklab (Ottosson, A perceptual color space for image processing, 2020).
fn difference(a: [u8; 3], b: [u8; 3]) -> f64 {
    let oklab = |color: [u8; 3]| {
        let [r, g, b] = color.map(|c| {
            let c = f64::from(c) / 255.0;
            if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        });
        let l = (0.412_221_47 * r + 0.536_332_54 * g + 0.051_445_99 * b).cbrt();
        let m = (0.211_903_5 * r + 0.680_699_55 * g + 0.107_396_96 * b).cbrt();
        let s = (0.088_302_46 * r + 0.281_718_84 * g + 0.629_978_7 * b).cbrt();
        [
            0.210_454_26 * l + 0.793_617_78 * m - 0.004_072_05 * s,
            1.977_998_5 * l - 2.428_592_2 * m + 0.450_593_7 * s,
            0.025_904_04 * l + 0.782_771_77 * m - 0.808_675_77 * s,
        ]
    };
    let (a, b) = (oklab(a), oklab(b));
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum()
}

/// A linear colour as sRGB bytes.
fn srgb(linear: [f64; 3]) -> [u8; 3] {
    linear.map(|channel| (srgb_from_linear(channel) * 255.0).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::STARTING_TABLES;

    #[test]
    fn every_ready_made_table_survives_the_way_through_a_picture() {
        for start in STARTING_TABLES {
            let biomes = start.biomes().unwrap();
            assert_eq!(look_alikes(&biomes), vec![], "{}", start.name);
            let imported = decode(&encode(&biomes).unwrap(), &biomes).unwrap();
            assert_eq!(imported, Imported { table: biomes.table.clone(), inexact: 0 }, "{}", start.name);
        }
    }

    #[test]
    fn strange_colours_go_to_the_nearest_and_are_counted_and_clear_ones_stay() {
        let biomes = STARTING_TABLES[0].biomes().unwrap();
        let mut picture = image::load_from_memory(&encode(&biomes).unwrap()).unwrap().to_rgba8();
        let Rgba([r, g, b, _]) = *picture.get_pixel(3, 3);
        picture.put_pixel(3, 3, Rgba([r.saturating_add(2), g, b, 255]));
        picture.put_pixel(0, 0, Rgba([255, 0, 255, 0]));
        let mut bytes = Cursor::new(Vec::new());
        picture.write_to(&mut bytes, ImageFormat::Png).unwrap();
        let imported = decode(&bytes.into_inner(), &biomes).unwrap();
        assert_eq!(imported, Imported { table: biomes.table.clone(), inexact: 1 });
    }

    #[test]
    fn what_cannot_be_a_table_is_refused_in_words() {
        let biomes = Biomes::default();
        assert!(decode(b"no picture", &biomes).unwrap_err().contains("no PNG"));
        let mut bytes = Cursor::new(Vec::new());
        RgbaImage::new(65, 12).write_to(&mut bytes, ImageFormat::Png).unwrap();
        assert!(decode(&bytes.into_inner(), &biomes).unwrap_err().contains("65 x 12 pixels; use 1 to 64"));
    }
}
