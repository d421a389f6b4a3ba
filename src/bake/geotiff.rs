//! Maps as GeoTIFF (OGC 19-008r4), strip by strip, uncompressed: floats of 32 bits, or whole numbers of 16 bits with
//! the scale and offset of GDAL, so that GIS programs show metres.
//!
//! The planet is a sphere of its own radius. Files of 4 GB and more are BigTIFF.

use super::format::{Format, Shape, Source};
use std::io::{self, BufWriter, Seek, Write};
use tiff::TiffError;
use tiff::encoder::colortype::{ColorType, Gray16, Gray32Float, RGB16, RGB32Float};
use tiff::encoder::{TiffEncoder, TiffKind, TiffKindBig, TiffKindStandard, TiffValue};
use tiff::tags::Tag;

/// Bytes of samples up to which offsets of 32 bits suffice, with room for the tags.
const CLASSIC_BYTES: u64 = 4_000_000_000;
/// About so many bytes are a strip.
const STRIP_BYTES: usize = 1 << 20;
/// The XML in which GDAL keeps scale and offset (<https://gdal.org/drivers/raster/gtiff.html>).
const GDAL_METADATA: Tag = Tag::Unknown(42_112);
/// Keys and codes of GeoTIFF, annexes B and C.
const USER_DEFINED: u16 = 32_767;
const DEGREE: u16 = 9102;
const METRE: u16 = 9001;
const AZIMUTHAL_EQUIDISTANT: u16 = 12;

/// Where a picture lies on a planet.
pub(super) struct Place {
    pub(super) ground: Ground,
    pub(super) radius_m: f64,
}

/// How a picture lies on the sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ground {
    /// In no projection of GIS programs.
    Elsewhere,
    /// All of the globe, equirectangular.
    Globe,
    /// On a plane that touches the sphere, azimuthal equidistant.
    Plane {
        lat_deg: f64,
        lon_deg: f64,
        /// The left edge along east and the upper edge along north.
        corner_m: [f64; 2],
        pixel_m: f64,
    },
}

/// Writes a picture.
pub(super) fn write(out: impl Write + Seek, shape: &Shape, place: &Place, rows: &mut dyn Source) -> io::Result<()> {
    let is_deep = shape.format == Format::Tiff16;
    let bytes = shape.row() as u64 * u64::from(shape.height) * if is_deep { 2 } else { 4 };
    let out = BufWriter::new(out);
    if bytes < CLASSIC_BYTES {
        write_as(TiffEncoder::<_, TiffKindStandard>::new_generic(out), shape, place, rows)
    } else {
        write_as(TiffEncoder::<_, TiffKindBig>::new_generic(out), shape, place, rows)
    }
}

fn write_as<W: Write + Seek, K: TiffKind>(
    encoder: Result<TiffEncoder<W, K>, TiffError>,
    shape: &Shape,
    place: &Place,
    rows: &mut dyn Source,
) -> io::Result<()> {
    let encoder = encoder.map_err(plain)?;
    let whole = |value: f32| shape.steps.number(value);
    match (shape.format, shape.channels) {
        (Format::Tiff16, 3) => write_samples::<_, K, RGB16>(encoder, shape, place, rows, whole),
        (Format::Tiff16, _) => write_samples::<_, K, Gray16>(encoder, shape, place, rows, whole),
        (_, 3) => write_samples::<_, K, RGB32Float>(encoder, shape, place, rows, |value| value),
        _ => write_samples::<_, K, Gray32Float>(encoder, shape, place, rows, |value| value),
    }
}

fn write_samples<W: Write + Seek, K: TiffKind, C: ColorType>(
    mut encoder: TiffEncoder<W, K>,
    shape: &Shape,
    place: &Place,
    rows: &mut dyn Source,
    sample: impl Fn(f32) -> C::Inner,
) -> io::Result<()>
where
    [C::Inner]: TiffValue,
{
    let mut image = encoder.new_image::<C>(shape.width, shape.height).map_err(plain)?;
    let high = (STRIP_BYTES / (shape.row() * size_of::<C::Inner>())).max(1) as u32;
    image.rows_per_strip(high).map_err(plain)?;
    for (tag, numbers) in place.numbers(shape) {
        image.encoder().write_tag(tag, &numbers[..]).map_err(plain)?;
    }
    if let Some(keys) = place.keys() {
        image.encoder().write_tag(Tag::GeoKeyDirectoryTag, &keys[..]).map_err(plain)?;
        image.encoder().write_tag(Tag::GeoAsciiParamsTag, CITATION).map_err(plain)?;
    }
    if shape.format == Format::Tiff16 {
        image.encoder().write_tag(GDAL_METADATA, scales(shape).as_str()).map_err(plain)?;
    }
    let mut values = Vec::new();
    let mut top = 0;
    while top < shape.height {
        let count = high.min(shape.height - top);
        rows.read(count, &mut values)?;
        let samples: Vec<C::Inner> = values.iter().map(|&value| sample(value)).collect();
        image.write_strip(&samples).map_err(plain)?;
        top += count;
    }
    image.finish().map_err(plain)
}

fn plain(error: TiffError) -> io::Error {
    match error {
        TiffError::IoError(error) => error,
        other => io::Error::other(other.to_string()),
    }
}

/// The numbers of a channel run from 0 to 65535 over the range of the map.
fn scales(shape: &Shape) -> String {
    let (offset, scale) = (shape.steps.min, (shape.steps.max - shape.steps.min) / f64::from(u16::MAX));
    let items = (0..shape.channels).map(|k| {
        format!(
            "<Item name=\"OFFSET\" sample=\"{k}\" role=\"offset\">{offset:?}</Item>\
             <Item name=\"SCALE\" sample=\"{k}\" role=\"scale\">{scale:?}</Item>"
        )
    });
    format!("<GDALMetadata>{}</GDALMetadata>", items.collect::<String>())
}

/// Name of the coordinate system.
const CITATION: &str = "Sphere of a Tellus planet|";

impl Place {
    /// The tags that hold numbers: the corner, the size of a pixel, and parameters of the keys.
    fn numbers(&self, shape: &Shape) -> Vec<(Tag, Vec<f64>)> {
        let (pixel, corner) = match self.ground {
            Ground::Elsewhere => return Vec::new(),
            Ground::Globe => {
                let pixel = [360.0 / f64::from(shape.width), 180.0 / f64::from(shape.height)];
                (pixel, [-180.0, 90.0])
            }
            Ground::Plane { corner_m, pixel_m, .. } => ([pixel_m; 2], corner_m),
        };
        let mut parameters = vec![self.radius_m, self.radius_m];
        if let Ground::Plane { lat_deg, lon_deg, .. } = self.ground {
            parameters.extend([lat_deg, lon_deg, 0.0, 0.0]);
        }
        vec![
            (Tag::ModelPixelScaleTag, vec![pixel[0], pixel[1], 0.0]),
            (Tag::ModelTiepointTag, vec![0.0, 0.0, 0.0, corner[0], corner[1], 0.0]),
            (Tag::GeoDoubleParamsTag, parameters),
        ]
    }

    /// The directory of keys: each is a key, the tag with its value (0: here), how many values, and the value or its
    /// index in the tag.
    fn keys(&self) -> Option<Vec<u16>> {
        let double = |key: u16, index: u16| [key, Tag::GeoDoubleParamsTag.to_u16(), 1, index];
        let citation = |key: u16| [key, Tag::GeoAsciiParamsTag.to_u16(), CITATION.len() as u16, 0];
        let here = |key: u16, value: u16| [key, 0, 1, value];
        let (pixel_is_area, is_projected) = (1, matches!(self.ground, Ground::Plane { .. }));
        let mut keys = vec![
            here(1024, if is_projected { 1 } else { 2 }),
            here(1025, pixel_is_area),
            here(2048, USER_DEFINED),
            citation(2049),
            here(2050, USER_DEFINED),
            here(2054, DEGREE),
            here(2056, USER_DEFINED),
            double(2057, 0),
            double(2058, 1),
        ];
        match self.ground {
            Ground::Elsewhere => return None,
            Ground::Globe => {}
            Ground::Plane { .. } => keys.extend([
                here(3072, USER_DEFINED),
                here(3074, USER_DEFINED),
                here(3075, AZIMUTHAL_EQUIDISTANT),
                here(3076, METRE),
                double(3082, 4),
                double(3083, 5),
                double(3088, 3),
                double(3089, 2),
            ]),
        }
        let mut directory = vec![1, 1, 1, keys.len() as u16];
        directory.extend(keys.as_flattened());
        Some(directory)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_sorted_and_counted() {
        let plane = Ground::Plane { lat_deg: 10.0, lon_deg: 20.0, corner_m: [-5e4, 5e4], pixel_m: 10.0 };
        for ground in [Ground::Globe, plane] {
            let keys = Place { ground, radius_m: 1e6 }.keys().unwrap();
            assert_eq!(keys.len(), 4 + 4 * usize::from(keys[3]));
            assert!(keys[4..].chunks(4).is_sorted_by_key(|key| key[0]), "{keys:?}");
        }
        assert!(Place { ground: Ground::Elsewhere, radius_m: 1e6 }.keys().is_none());
    }
}
