//! The kinds of file that a map is baked into, and how its values become their numbers.

use super::maps::{Map, Range};
use std::io;

/// A kind of file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Format {
    /// PNG of 8 bits. Colours are encoded as sRGB.
    Png8,
    /// PNG of 16 bits, linear.
    Png16,
    /// OpenEXR with floats of 32 bits.
    Exr,
    /// OpenEXR with floats of 16 bits.
    Exr16,
    /// Whole numbers of 16 bits, little-endian, row by row from the top, without a header.
    R16,
    /// TIFF with floats of 32 bits; georeferenced, unless it is a face of a cube.
    Tiff,
    /// TIFF of 16 bits; georeferenced, unless it is a face of a cube.
    Tiff16,
    /// KTX2 texture with mip levels, of 16 bits; colours of 8 bits, encoded as sRGB. The faces of a cube are one file.
    Ktx2,
}

impl Format {
    /// All of them.
    pub const ALL: [Format; 8] = [
        Format::Png8,
        Format::Png16,
        Format::Exr,
        Format::Exr16,
        Format::R16,
        Format::Tiff,
        Format::Tiff16,
        Format::Ktx2,
    ];

    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Format::Png8 => "png8",
            Format::Png16 => "png16",
            Format::Exr => "exr",
            Format::Exr16 => "exr16",
            Format::R16 => "r16",
            Format::Tiff => "tiff",
            Format::Tiff16 => "tiff16",
            Format::Ktx2 => "ktx2",
        }
    }

    /// The format of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|format| format.name() == name)
    }

    /// Its name for a person.
    pub fn label(self) -> &'static str {
        match self {
            Format::Png8 => "PNG, 8 bits",
            Format::Png16 => "PNG, 16 bits",
            Format::Exr => "OpenEXR, 32 bits",
            Format::Exr16 => "OpenEXR, 16 bits",
            Format::R16 => "R16, raw 16 bits",
            Format::Tiff => "GeoTIFF, 32 bits",
            Format::Tiff16 => "GeoTIFF, 16 bits",
            Format::Ktx2 => "KTX2 texture with mips",
        }
    }

    /// Bytes of a number without compression.
    pub fn bytes_per_number(self) -> u64 {
        match self {
            Format::Png8 => 1,
            Format::Exr | Format::Tiff => 4,
            _ => 2,
        }
    }

    /// The ending of its files.
    pub fn extension(self) -> &'static str {
        match self {
            Format::Png8 | Format::Png16 => "png",
            Format::Exr | Format::Exr16 => "exr",
            Format::R16 => "r16",
            Format::Tiff | Format::Tiff16 => "tif",
            Format::Ktx2 => "ktx2",
        }
    }

    /// The greatest whole number of a channel of a map; None for floats.
    pub(super) fn top(self, map: Map) -> Option<u16> {
        match self {
            Format::Png8 => Some(0xff),
            Format::Ktx2 if self.is_srgb(map) => Some(0xff),
            Format::Png16 | Format::R16 | Format::Tiff16 | Format::Ktx2 => Some(0xffff),
            Format::Exr | Format::Exr16 | Format::Tiff => None,
        }
    }

    /// Whether it encodes the colours of a map as sRGB.
    pub(super) fn is_srgb(self, map: Map) -> bool {
        matches!(self, Format::Png8 | Format::Ktx2) && map == Map::Albedo
    }
}

/// How values become whole numbers: from `min`, which is 0, to `max`, which is `top`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Steps {
    pub(super) min: f64,
    pub(super) max: f64,
    top: f64,
    is_srgb: bool,
}

impl Steps {
    /// `found`: least and greatest value of the map. For floats `min` and `max` only inform.
    pub(super) fn new(format: Format, map: Map, found: (f64, f64), asked: Option<[f64; 2]>) -> Self {
        let top = f64::from(format.top(map).unwrap_or(u16::MAX));
        let (min, max) = match (map.range(), asked) {
            (Range::Found, Some([min, max])) => (min, max),
            (Range::Found, None) => found,
            (Range::Fixed(min, max), _) => (min, max),
            (Range::Numbers, _) => (0.0, top),
        };
        Self { min, max, top, is_srgb: format.is_srgb(map) }
    }

    /// Whether numbers are those of sRGB.
    pub(super) fn is_srgb(&self) -> bool {
        self.is_srgb
    }

    /// The whole number of a value.
    pub(super) fn number(&self, value: f32) -> u16 {
        let width = self.max - self.min;
        let share = if width > 0.0 { (f64::from(value) - self.min) / width } else { 0.0 };
        let share = if self.is_srgb { srgb_from_linear(share) } else { share };
        (share * self.top).round().clamp(0.0, self.top) as u16
    }
}

/// A component of sRGB.
pub(crate) fn srgb_byte(value: f64) -> u8 {
    (srgb_from_linear(value) * 255.0).round() as u8
}

/// IEC 61966-2-1, from 0 to 1. The renderer has the same; this one gives the same bits on every machine.
pub(super) fn srgb_from_linear(value: f64) -> f64 {
    let value = value.clamp(0.0, 1.0);
    if value <= 0.003_130_8 { value * 12.92 } else { 1.055 * libm::pow(value, 1.0 / 2.4) - 0.055 }
}

/// What an encoder must know of a picture.
pub(super) struct Shape {
    pub(super) width: u32,
    pub(super) height: u32,
    pub(super) channels: usize,
    pub(super) format: Format,
    pub(super) steps: Steps,
}

impl Shape {
    /// Numbers of a row.
    pub(super) fn row(&self) -> usize {
        self.width as usize * self.channels
    }
}

/// Gives the values of a picture from the top: those of all channels of a pixel, then those of the next.
pub(super) trait Source {
    /// The next rows, which there must be.
    fn read(&mut self, rows: u32, values: &mut Vec<f32>) -> io::Result<()>;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_reach_from_the_least_value_to_the_greatest() {
        let steps = Steps::new(Format::Png16, Map::Height, (-1000.0, 3000.0), None);
        assert_eq!([-1000.0, 3000.0, 1000.0, 9000.0].map(|m| steps.number(m)), [0, 65_535, 32_768, 65_535]);
        let asked = Steps::new(Format::Png8, Map::Height, (0.0, 1.0), Some([-255.0, 0.0]));
        assert_eq!([-255.0, -1.0, 0.0].map(|m| asked.number(m)), [0, 254, 255]);
        // One height everywhere.
        assert_eq!(Steps::new(Format::Png16, Map::Height, (5.0, 5.0), None).number(5.0), 0);
        // Numbers stay themselves, whatever the range that is asked for.
        for format in [Format::Png8, Format::Png16] {
            let ids = Steps::new(format, Map::Biome, (0.0, 7.0), Some([0.0, 1.0]));
            assert_eq!([0.0, 7.0, 63.0].map(|id| ids.number(id)), [0, 7, 63]);
        }
        let flat = Steps::new(Format::Png8, Map::Normal, (0.0, 0.0), None);
        assert_eq!([-1.0, 0.0, 1.0].map(|n| flat.number(n)), [0, 128, 255]);
    }

    #[test]
    fn colours_of_eight_bits_are_srgb() {
        let eight = Steps::new(Format::Png8, Map::Albedo, (0.0, 1.0), None);
        assert_eq!([0.0, 0.214_041_14, 1.0].map(|c| eight.number(c)), [0, 128, 255]);
        let deep = Steps::new(Format::Png16, Map::Albedo, (0.0, 1.0), None);
        assert_eq!(deep.number(0.5), 32_768);
    }

    #[test]
    fn names_lead_back_to_formats() {
        for format in Format::ALL {
            assert_eq!(Format::named(format.name()), Some(format));
        }
    }
}
